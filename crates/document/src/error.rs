//! Why an identified ship is refused.

use thiserror::Error;

/// Why an identified ship is refused.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum IdentifiedShipError {
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
    /// A hull, by the word for its form, cannot be made again.
    #[error("the hull `{0}` of the file is not one of this program; fit or trace the record again with it")]
    Hull(String),
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
}
