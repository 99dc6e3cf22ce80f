//! Why speed and drift cannot be told.

use thiserror::Error;

/// Why there is no fit, or no model with the given numbers.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MotionError {
    /// There is nothing to fit.
    #[error("{records} records and none has a speed, a surge or sway velocity, or positions")]
    NoOutput {
        /// Number of records.
        records: usize,
    },
    /// The ship keeps its heading in all records.
    #[error(
        "nothing turns: the heading changes by {:.1}° at most, and {:.0}° are needed",
        found.to_degrees(),
        needed.to_degrees()
    )]
    NotExcited {
        /// Largest range of the heading in a record, rad.
        found: f64,
        /// Range needed, rad.
        needed: f64,
    },
    /// The records leave a combination of coefficients open.
    #[error("the records do not determine {symbol}: no residual changes with it")]
    Undetermined {
        /// The coefficient that weighs most in what is open.
        symbol: &'static str,
    },
    /// The search did not end.
    #[error("the search did not converge in {iterations} iterations")]
    NoConvergence {
        /// Iterations made.
        iterations: usize,
    },
    /// The approach speed of a record cannot be told.
    #[error("record {record} has no approach speed: none is declared, and nothing shows it before the rudder moves")]
    NoApproachSpeed {
        /// Name of the record.
        record: String,
    },
    /// A length or speed that no ship has.
    #[error("a {quantity} must be a positive number, found {value}")]
    NotPositive {
        /// `length` or `approach speed`.
        quantity: &'static str,
        /// The value.
        value: f64,
    },
}

/// Fails with [`MotionError::NotPositive`] for what is no length or speed of a ship.
pub(crate) fn positive(quantity: &'static str, value: f64) -> Result<(), MotionError> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(MotionError::NotPositive { quantity, value }) }
}
