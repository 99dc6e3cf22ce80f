//! What a fit ends with.

use crate::noise::Colour;

/// A fitted structure.
#[derive(Debug, Clone)]
pub struct Fit {
    /// Parameters, in the order of [`Structure::entries`](crate::structure::Structure::entries).
    pub theta: Vec<f64>,
    /// Initial heading (rad) and yaw rate (rad/s) of every record.
    pub initial: Vec<[f64; 2]>,
    /// Colour of the noise it was fitted under.
    pub colour: Colour,
    /// Measured less replayed heading at the observed rows of every record, rad, not whitened.
    pub residual: Vec<Vec<f64>>,
    /// Sum of squares of the whitened residual, rad².
    pub rss: f64,
    /// −2 log L, up to a constant of the record.
    pub deviance: f64,
    /// Number of fitted parameters, initial states and noise included.
    pub freedom: usize,
    /// What the colour of the noise takes from the price of the unknowns, at most 0.
    pub lost: f64,
    /// −2 log L + freedom · log n + lost (Schwarz 1978).
    pub bic: f64,
}
