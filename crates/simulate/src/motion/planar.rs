//! Coefficients together with the ship they are used on.

use thiserror::Error;

use super::coefficients::PlanarCoefficients;

/// A length or speed that no ship has.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("a {quantity} must be a positive number, found {value}")]
pub struct MotionError {
    /// `length` or `approach speed`.
    quantity: &'static str,
    /// The value.
    value: f64,
}

/// Speed and drift of one ship.
#[derive(Debug, Clone, PartialEq)]
pub struct Planar {
    /// The coefficients of the equations, dimensionless.
    pub coefficients: PlanarCoefficients,
    /// Length of the ship L, m.
    pub length: f64,
    /// Speed of the straight approach U₀, m/s.
    pub approach_speed: f64,
}

impl Planar {
    /// A ship of length `length` (m) and approach speed `approach_speed` (m/s).
    ///
    /// Fails with [`MotionError`] for what is no length or speed.
    pub fn new(coefficients: PlanarCoefficients, length: f64, approach_speed: f64) -> Result<Self, MotionError> {
        for (quantity, value) in [("length", length), ("approach speed", approach_speed)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(MotionError { quantity, value });
            }
        }
        Ok(Self { coefficients: PlanarCoefficients::from_array(coefficients.to_array()), length, approach_speed })
    }

    /// (u', v') in m/s² at surge u and sway v (m/s), yaw rate r (rad/s) and rudder (rad).
    pub fn rates(&self, u: f64, v: f64, r: f64, rudder: f64) -> [f64; 2] {
        let speed = self.approach_speed;
        let unit = speed * speed / self.length;
        let [a, b] = self.coefficients.rates(u / speed, v / speed, r * self.length / speed, rudder);
        [a * unit, b * unit]
    }
}
