//! Errors of identified ships in files.

use thiserror::Error;

/// Error of an identified ship in a file.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum IdentifiedShipError {
    /// Unknown effect of the model.
    #[error("unknown effect `{id}` ({form}); fit or trace the record again with this program")]
    Effect {
        /// Identifier of the effect.
        id: String,
        /// Form of the effect.
        form: String,
    },
    /// List of an unexpected length, or index beyond the end of a list.
    #[error("{list}: expected {expected}, found {length}; fit or trace the record again with this program")]
    Count {
        /// Name of the list.
        list: &'static str,
        /// Expected length.
        expected: usize,
        /// Length in the file; for an index, the length that it requires.
        length: usize,
    },
    /// Parameter that is not finite, or length, speed or weight out of range.
    #[error("{key} = {value}: expected a finite number (a weight of at least 0, a length or speed of a ship)")]
    Value {
        /// Key of the number.
        key: &'static str,
        /// Value in the file.
        value: f64,
    },
    /// Hull with a form or coefficients unknown to this program: the form in the file.
    #[error(
        "the hull model `{0}` has a form or coefficients that this program does not have; fit or trace the record again"
    )]
    Hull(String),
    /// Ship of unknown length or speed, which cannot be scaled.
    #[error(
        "the ship cannot be scaled, because her length and speed are unknown; give them to `study fit` or `study \
         trace`, or --length-m and --speed-kn here if the model has that scale"
    )]
    NoParticulars,
    /// Formula with a constant of unknown unit, which cannot be scaled: its identifier.
    #[error(
        "the ship cannot be scaled, because the constants of the effect {0} have unknown units; write its formula with \
         the dimensionless rp, vp, delta and psi"
    )]
    NoUnit(&'static str),
}
