//! Reasons why a prediction is refused.

use document::IdentifiedShipError;
use thiserror::Error;

/// Reason why a prediction is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PredictError {
    /// The ship of the file cannot be restored, or cannot be scaled.
    #[error(transparent)]
    Ship(#[from] IdentifiedShipError),
    /// The covariance of the parameters is not positive definite.
    #[error("the covariance of the parameters is not positive definite; fit or trace the record again")]
    Covariance,
    /// No model is given, or the first model has no timescale: L/U is unknown and K/T is not positive.
    #[error("there is no model to predict from")]
    Empty,
    /// The model needs a channel that is not predicted.
    #[error(
        "the model uses the measured {channel}, which a trial that was not made does not have; give --length-m, and \
         --speed-kn where the record has no speed, to fit or trace so that a hull is fitted, or trace with --without {option}"
    )]
    MissingChannel {
        /// Name of the channel.
        channel: &'static str,
        /// Effect for the option `--without` of a trace.
        option: &'static str,
    },
    /// Too few drawn ships complete a manoeuvre.
    #[error("{manoeuvre}: only {completed} of {draws} drawn ships complete it; the model is not valid there")]
    TooFewCompleted {
        /// Manoeuvre, as text.
        manoeuvre: String,
        /// Number of drawn ships that complete it.
        completed: usize,
        /// Number of drawn ships.
        draws: usize,
    },
}
