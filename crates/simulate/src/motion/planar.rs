//! Planar motion of one ship: coefficients with length and approach speed.

use thiserror::Error;

use super::coefficients::PlanarCoefficients;

/// Error of an invalid length or speed.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("the {quantity} must be positive and finite, found {value}")]
pub struct MotionError {
    /// Quantity: `length` or `approach speed`.
    quantity: &'static str,
    /// Rejected value, m or m/s.
    value: f64,
}

/// Equations of surge and sway of one ship: coefficients, length and approach speed.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanarModel {
    /// Coefficients of the equations, dimensionless.
    pub coefficients: PlanarCoefficients,
    /// Length of the ship L, m.
    pub length: f64,
    /// Speed of the straight approach U₀, m/s.
    pub approach_speed: f64,
}

impl PlanarModel {
    /// Planar motion of a ship of length `length` (m) and approach speed `approach_speed` (m/s). The coefficients are
    /// clamped to their bounds.
    ///
    /// Fails with [`MotionError`] for a length or speed that is not positive and finite.
    pub fn new(coefficients: PlanarCoefficients, length: f64, approach_speed: f64) -> Result<Self, MotionError> {
        for (quantity, value) in [("length", length), ("approach speed", approach_speed)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(MotionError { quantity, value });
            }
        }
        let coefficients = PlanarCoefficients::clamped_from_array(coefficients.to_array());
        Ok(Self { coefficients, length, approach_speed })
    }

    /// Rates (u', v') in m/s² at surge u and sway v (m/s), yaw rate r (rad/s) and rudder (rad).
    pub fn rates(&self, u: f64, v: f64, r: f64, rudder: f64) -> [f64; 2] {
        let speed = self.approach_speed;
        let unit = speed * speed / self.length;
        let [a, b] = self.coefficients.rates(u / speed, v / speed, r * self.length / speed, rudder);
        [a * unit, b * unit]
    }
}
