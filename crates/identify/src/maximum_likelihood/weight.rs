//! Weights of the records of one ship, by the variance of the compass error of each.

use nalgebra::{Matrix2, Vector2};

use crate::profile::solve2;

/// Maximum number of iterations of the weights of the records of one ship.
const MAX_WEIGHT_ITERATIONS: usize = 20;

/// Maximum relative change of any variance in an iteration at which the weights have converged; without convergence the
/// weights of the last iteration are used.
const WEIGHT_TOLERANCE: f64 = 1e-12;

/// Quantities that determine the weight of a record.
pub(super) struct Weight {
    /// Products of the responses to rudder and constant and the readings.
    pub products: [[f64; 3]; 3],
    /// Number of readings.
    pub readings: f64,
    /// Number of readings minus number of fitted unknowns.
    pub degrees_of_freedom: f64,
    /// Standard deviation of the compass error over b, rad s², if a declared rudder error fixes it; `None` if the
    /// compass error follows from the residual.
    pub compass_sd_per_gain: Option<f64>,
}

impl Weight {
    /// Sum of squares of the whitened residual at b and b δ_r.
    pub fn rss(&self, b: f64, q: f64) -> f64 {
        let [[gg, gh, gy], [_, hh, hy], [.., yy]] = self.products;
        // The square is bounded below by its rounding error, which remains for a record without noise.
        let rounding = (f64::EPSILON * yy).max(f64::MIN_POSITIVE);
        (yy - 2.0 * (b * gy + q * hy) + b * b * gg + 2.0 * b * q * gh + q * q * hh).max(rounding)
    }

    /// Variance of the compass error at b and b δ_r, rad².
    pub fn variance(&self, b: f64, q: f64) -> f64 {
        self.compass_sd_per_gain.map_or(self.rss(b, q) / self.degrees_of_freedom, |unit| (b * unit).powi(2))
    }
}

/// Best b (1/s²) and b δ_r (rad/s²) over all records, and the variance of the compass error in every record, rad²;
/// `None` if the equations are singular.
pub(super) fn weigh(weights: &[Weight]) -> Option<(Vector2<f64>, Vec<f64>)> {
    let mut variances = vec![1.0; weights.len()];
    let mut best = Vector2::zeros();
    for _ in 0..MAX_WEIGHT_ITERATIONS {
        let (mut matrix, mut moment) = (Matrix2::zeros(), Vector2::zeros());
        for (Weight { products: [[gg, gh, gy], [_, hh, hy], _], .. }, variance) in weights.iter().zip(&variances) {
            matrix += Matrix2::new(*gg, *gh, *gh, *hh) / *variance;
            moment += Vector2::new(*gy, *hy) / *variance;
        }
        best = solve2(&matrix, &moment)?;
        let mut moved = 0.0_f64;
        for (weight, variance) in weights.iter().zip(&mut variances) {
            let next = weight.variance(best[0], best[1]);
            moved = moved.max((next / *variance - 1.0).abs());
            *variance = next;
        }
        if weights.len() == 1 || moved < WEIGHT_TOLERANCE {
            break;
        }
    }
    Some((best, variances))
}
