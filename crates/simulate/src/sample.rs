//! What there is to be seen at one instant of a run: made by a propagator, taken by a record.

use ship::Motion;

/// Everything that can be recorded at one instant, before any instrument.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    /// Time, s.
    pub time: f64,
    /// Motion of the ship, without waves.
    pub motion: Motion,
    /// Heading after the lag of the gyrocompass, rad.
    pub gyro: f64,
    /// Total disturbance as equivalent rudder angle, rad.
    pub disturbance: f64,
    /// Factor 1 + g on the moment of the wind.
    pub gust: f64,
}
