//! Whether a noise model holds: what is new in every heading, given those before it, has to be white, of one variance,
//! and without a single surprise.

use statrs::distribution::{ContinuousCDF, Normal};

use crate::diagnostics::{self, Series};
use crate::fit::Problem;
use crate::weights::Law;

/// Probability below which innovations are not those of the noise model.
const IMPROBABLE: f64 = 1e-4;

/// How well the innovations of a fit agree with its noise model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Innovations {
    /// Probability of autocorrelations as large in white innovations (Ljung and Box 1978).
    pub white: f64,
    /// Probability that innovations of one variance are spread as unevenly over time, or have one as large.
    pub even: f64,
}

impl Innovations {
    /// Those of a residual (rad) of every record under a law.
    pub fn of(problem: &Problem, residual: &[Vec<f64>], law: &Law) -> Self {
        let weights = problem.weights(law);
        let white: Vec<Vec<f64>> = residual
            .iter()
            .cloned()
            .enumerate()
            .map(|(record, mut residual)| {
                weights.apply(record, &mut [&mut residual]);
                residual
            })
            .collect();
        let series: Vec<Series> = problem
            .records
            .iter()
            .zip(&white)
            .map(|(record, white)| {
                let time: Vec<f64> = record.observed.iter().map(|&row| record.time[row]).collect();
                Series::new(&time, white, record.spacing)
            })
            .collect();
        let even = white.iter().map(|white| even(white)).fold(1.0, f64::min) * white.len() as f64;
        Self { white: diagnostics::whiteness(&series).p_value, even: even.min(1.0) }
    }

    /// Whether the noise model holds.
    pub fn agree(&self) -> bool {
        self.white.min(self.even) > IMPROBABLE
    }
}

/// Probability that normal numbers of one variance have sums of squares that stray as far from a straight line (Brown,
/// Durbin and Evans 1975), or one number as large among them.
fn even(numbers: &[f64]) -> f64 {
    let n = numbers.len() as f64;
    let total: f64 = numbers.iter().map(|x| x * x).sum();
    if total <= 0.0 || !total.is_finite() {
        return 1.0;
    }
    let (mut sum, mut strays, mut largest) = (0.0, 0.0_f64, 0.0_f64);
    for (k, x) in numbers.iter().enumerate() {
        sum += x * x;
        strays = strays.max((sum / total - (k + 1) as f64 / n).abs());
        largest = largest.max(x.abs());
    }
    let stray = kolmogorov(strays * (0.5 * n).sqrt());
    let single = n * 2.0 * Normal::standard().sf(largest / (total / n).sqrt());
    (2.0 * stray.min(single)).min(1.0)
}

/// Probability that a Brownian bridge strays further than x anywhere: 2 Σ (−1)^(k+1) exp(−2 k² x²).
fn kolmogorov(x: f64) -> f64 {
    if x < 0.3 {
        return 1.0;
    }
    let term = |k: i32| f64::from(1 - 2 * ((k + 1) % 2)) * (-2.0 * (f64::from(k) * x).powi(2)).exp();
    (2.0 * (1..=20).map(term).sum::<f64>()).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use rand::{SeedableRng, rngs::ChaCha8Rng};
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    /// Quantiles of the Kolmogorov distribution as printed by Smirnov (1948).
    #[test]
    fn the_bridge_has_its_tabulated_quantiles() {
        for (x, probability) in [(0.5, 0.963_945), (1.0, 0.270_000), (1.36, 0.049_486), (1.63, 0.009_843)] {
            assert!((kolmogorov(x) - probability).abs() < 1e-5, "{x}: {}", kolmogorov(x));
        }
    }

    /// Normal numbers of one variance fail as often as they may; with a louder half or one of eight they do not pass.
    #[test]
    fn uneven_numbers_are_found() {
        let mut generator = ChaCha8Rng::seed_from_u64(3);
        let mut draw = || -> Vec<f64> { (0..300).map(|_| StandardNormal.sample(&mut generator)).collect() };
        let low = (0..400).filter(|_| even(&draw()) < 0.05).count();
        assert!(low <= 30, "{low} of 400 below 0.05");
        let (mut louder, mut single) = (draw(), draw());
        louder[150..].iter_mut().for_each(|x| *x *= 2.0);
        single[100] = 8.0;
        assert!(even(&louder) < IMPROBABLE && even(&single) < IMPROBABLE);
    }
}
