//! Why there is no ship with the given numbers.

use thiserror::Error;

/// A length or speed that no ship has.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("a {quantity} must be a positive number, found {value}")]
pub struct MotionError {
    /// `length` or `approach speed`.
    quantity: &'static str,
    /// The value.
    value: f64,
}

/// Fails for what is no length or speed of a ship.
pub(crate) fn positive(quantity: &'static str, value: f64) -> Result<(), MotionError> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(MotionError { quantity, value }) }
}
