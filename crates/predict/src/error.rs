//! Why a prediction is refused.

use document::IdentifiedShipError;
use thiserror::Error;

/// Why a prediction is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PredictError {
    /// The ship of the file cannot be made again, or not at another scale.
    #[error(transparent)]
    Ship(#[from] IdentifiedShipError),
    /// A covariance is none.
    #[error("the covariance of the parameters is not positive definite; fit or trace the record again")]
    Covariance,
    /// There is no model.
    #[error("there is no model to predict from")]
    Empty,
    /// The model asks for a channel that nobody predicts.
    #[error(
        "the model uses the measured {channel}, which a trial that was not made does not have; give --length-m, and \
         --speed-kn where the record has no speed, to fit or trace so that a hull is fitted, or trace with --without {option}"
    )]
    Needs {
        /// The channel, in words.
        channel: &'static str,
        /// The channel as it is withheld from a trace.
        option: &'static str,
    },
    /// Hardly any drawn ship comes to the end of a manoeuvre.
    #[error("{kind}: only {made} of {draws} drawn ships complete it; the model does not hold there")]
    Lost {
        /// The manoeuvre.
        kind: String,
        /// Ships that do.
        made: usize,
        /// Ships drawn.
        draws: usize,
    },
}
