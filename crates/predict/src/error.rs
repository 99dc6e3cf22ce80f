//! Why a prediction is refused.

use thiserror::Error;

/// Why a prediction is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PredictError {
    /// An effect of the model is not known.
    #[error("the effect `{id}` ({form}) is not known; fit or trace the record again with this program")]
    Effect {
        /// Identifier.
        id: String,
        /// Form.
        form: String,
    },
    /// Numbers do not pair up.
    #[error("{what}: expected {expected}, found {found}; fit or trace the record again with this program")]
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there should be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// A parameter is no number, or a length, speed or weight is that of no ship.
    #[error("{key} = {value}: expected a finite number, as a weight 0 or more, as a length or speed what ships have")]
    Value {
        /// The parameter.
        key: &'static str,
        /// What was found.
        value: f64,
    },
    /// A covariance is none.
    #[error("the covariance of the parameters is not positive definite; fit or trace the record again")]
    Covariance,
    /// A hull, by the word for its form, cannot be made again.
    #[error("the hull `{0}` of the file is not one of this program; fit or trace the record again with it")]
    Hull(String),
    /// There is no model.
    #[error("there is no model to predict from")]
    Empty,
    /// A ship of unknown length or speed cannot be scaled.
    #[error(
        "length and speed of the ship are not known, so she cannot be scaled; give them to fit or trace, or here --speed-kn beside \
         --length-m where the model is of that scale"
    )]
    NoParticulars,
    /// A constant of the formula of this effect has no unit that could be scaled.
    #[error(
        "the unit of the constants of the effect {0} is not known, so the ship cannot be scaled; write the formula over rp, \
         vp, delta and psi, which have no dimension"
    )]
    NoUnit(&'static str),
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
