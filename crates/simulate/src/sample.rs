//! Sample of a run at one instant, from a propagator to the record.

use ship::Motion;

/// Recordable quantities at one instant, before the instruments.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    /// Time, s.
    pub time: f64,
    /// Motion of the ship, without waves.
    pub motion: Motion,
    /// Heading after the lag of the gyrocompass, rad.
    pub gyro: f64,
    /// Total disturbance as equivalent rudder angle, rad.
    pub disturbance_rudder: f64,
    /// Factor 1 + g on the moment of the wind.
    pub gust_factor: f64,
}
