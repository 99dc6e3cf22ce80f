//! Diagnostics of a residual: whiteness, constant variance and spectrum. Values may be missing.
//!
//! Sources: Ljung and Box (1978), Biometrika 65:297-303; Stoffer and Toloi (1992); Lomb (1976), Astrophysics and Space
//! Science 39:447-462; Scargle (1982), Astrophysical Journal 263:835-853; Brown, Durbin and Evans (1975), Journal of
//! the Royal Statistical Society B 37:149-192.

use crate::transform::{Complex, fourier_transform, power_spectrum};
use statrs::distribution::{ChiSquared, ContinuousCDF, Normal};

/// Series of residuals on an even time grid with gaps: values, each with its grid index.
#[derive(Debug, Clone, PartialEq)]
pub struct GappedSeries {
    /// Grid spacing, s: the usual time between values.
    pub spacing: f64,
    /// Grid index of every value; the first is 0.
    steps: Vec<usize>,
    /// Residuals, in the unit of the caller.
    pub values: Vec<f64>,
}

impl GappedSeries {
    /// Series of a residual (NaN where missing) at times in s, whose rows are usually `period` seconds apart.
    ///
    /// The spacing of the grid is the lower quartile of the intervals between values, rounded to a multiple of
    /// `period`.
    pub fn new(time: &[f64], residual: &[f64], period: f64) -> Self {
        let rows: Vec<usize> = (0..time.len()).filter(|&row| residual[row].is_finite()).collect();
        let intervals = || rows.windows(2).map(|pair| (time[pair[1]] - time[pair[0]]) / period);
        let mut sorted: Vec<f64> = intervals().collect();
        // Lower quartile: values may be missing at random, or exist in every tenth row only.
        let quarter = sorted.len() / 4;
        let usual = match sorted.len() {
            0 => 1.0,
            _ => sorted.select_nth_unstable_by(quarter, f64::total_cmp).1.round().max(1.0),
        };
        let mut step = 0_usize;
        let mut steps = Vec::with_capacity(rows.len());
        steps.extend(rows.first().map(|_| 0));
        steps.extend(intervals().map(|interval| {
            step = step.saturating_add(((interval / usual).round() as usize).max(1));
            step
        }));
        Self { spacing: period * usual, steps, values: rows.iter().map(|&row| residual[row]).collect() }
    }

    /// Number of grid points from the first value to the last, both included.
    fn span(&self) -> usize {
        self.steps.last().map_or(0, |last| last.saturating_add(1))
    }
}

/// Result of the whiteness test of Ljung and Box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WhitenessTest {
    /// Lag-1 autocorrelation, pooled over records.
    pub lag1_autocorrelation: f64,
    /// p-value: probability of autocorrelations at least as large in white noise, pooled over records.
    pub p_value: f64,
}

/// Maximum lag of the whiteness test of a long series, in grid steps.
const MAX_LAG: usize = 20;

/// Maximum lag of the whiteness test of `count` residuals, in grid steps: 20, or a quarter of `count` if that is less.
pub fn whiteness_lags(count: usize) -> usize {
    MAX_LAG.min(count / 4)
}

/// Whiteness test of the residuals of several records, pooled.
///
/// Q = n (n + 2) Σ ρ²/(n − k) (Ljung and Box 1978), with ρ = Σ x_i x_j / Σ x² at lag k. With missing values the number
/// of pairs at that lag takes the place of n − k (Stoffer and Toloi 1992). The p-value is 1 without pairs.
pub fn whiteness_test(residuals: &[GappedSeries]) -> WhitenessTest {
    let (mut square, mut cross, mut statistic, mut freedom) = (0.0, 0.0, 0.0, 0.0);
    for residual in residuals {
        let n = residual.values.len();
        let correlations = autocorrelation(residual, whiteness_lags(n));
        let sum_of_squares: f64 = residual.values.iter().map(|e| e * e).sum();
        square += sum_of_squares;
        cross += correlations.iter().find(|rho| rho.lag == 1).map_or(0.0, |rho| rho.coefficient) * sum_of_squares;
        let (n, span) = (n as f64, residual.span() as f64);
        statistic += correlations
            .iter()
            .map(|rho| {
                let share = (span - rho.lag as f64) * n / span;
                n * (n + 2.0) * rho.coefficient * rho.coefficient / (share * share / rho.pair_count as f64)
            })
            .sum::<f64>();
        freedom += correlations.len() as f64;
    }
    let p_value = if freedom > 0.0 { ChiSquared::new(freedom).map_or(1.0, |chi| chi.sf(statistic)) } else { 1.0 };
    WhitenessTest { lag1_autocorrelation: if square > 0.0 { cross / square } else { 0.0 }, p_value }
}

/// Autocorrelation at one lag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Autocorrelation {
    /// Lag, in grid steps.
    pub lag: usize,
    /// Autocorrelation about zero.
    pub coefficient: f64,
    /// Number of pairs of values at this lag.
    pub pair_count: usize,
}

/// Autocorrelations at lags 1, 2, …, `lags`; a lag without a pair of values is left out.
///
/// ρ_k = Σ x_i x_j / Σ x²; with n values on N grid points and m pairs it is multiplied by n (N − k)/(N m), which is 1
/// without gaps.
pub fn autocorrelation(series: &GappedSeries, lags: usize) -> Vec<Autocorrelation> {
    let GappedSeries { steps, values, .. } = series;
    let square: f64 = values.iter().map(|e| e * e).sum();
    let (mut cross, mut pairs) = (vec![0.0; lags], vec![0_usize; lags]);
    for (first, (&from, x)) in steps.iter().zip(values).enumerate() {
        for (&to, y) in steps[first + 1..].iter().zip(&values[first + 1..]).take_while(|(to, _)| **to - from <= lags) {
            cross[to - from - 1] += x * y;
            pairs[to - from - 1] += 1;
        }
    }
    let (n, span) = (values.len() as f64, series.span() as f64);
    (0..lags)
        .filter(|&k| pairs[k] > 0)
        .map(|k| {
            let lag = k + 1;
            let gap_factor = (n * (span - lag as f64)) / (span * pairs[k] as f64);
            let value = if square > 0.0 { cross[k] / square * gap_factor } else { 0.0 };
            Autocorrelation { lag, coefficient: value, pair_count: pairs[k] }
        })
        .collect()
}

/// Line of a periodogram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectralLine {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Share of the mean square about the mean, from 0 to 1.
    pub mean_square_share: f64,
}

/// Maximum number of grid points per value for which a spectrum is computed.
const MAX_POINTS_PER_VALUE: usize = 16;

/// Periodogram: the share of the mean square about the mean at 1, 2, … periods per series, up to the Nyquist frequency
/// of the grid.
///
/// With missing values, the periodogram of Lomb (1976) and Scargle (1982): the share explained by a least-squares sine.
/// On an even grid its sums are Fourier transforms of the values and of the pattern of gaps. Empty for fewer than four
/// values, or for more than 16 grid points per value.
pub fn periodogram(series: &GappedSeries) -> Vec<SpectralLine> {
    let (n, span) = (series.values.len(), series.span());
    if n < 4 || span > MAX_POINTS_PER_VALUE * n {
        return Vec::new();
    }
    let frequency = |k: usize| k as f64 / (span as f64 * series.spacing);
    let line = |k: usize, power: f64, total: f64| SpectralLine {
        frequency: frequency(k),
        mean_square_share: if total > 0.0 { power / total } else { 0.0 },
    };
    if n == span {
        let power = power_spectrum(&mut series.values.clone()).split_off(1);
        let total: f64 = power.iter().sum();
        return power.into_iter().enumerate().map(|(k, power)| line(k + 1, power, total)).collect();
    }
    let mean = series.values.iter().sum::<f64>() / n as f64;
    let (mut values, mut present) = (vec![0.0; span], vec![0.0; span]);
    for (&step, value) in series.steps.iter().zip(&series.values) {
        (values[step], present[step]) = (value - mean, 1.0);
    }
    let total: f64 = values.iter().map(|x| x * x).sum();
    let (sums, window) = (fourier_transform(&mut values), fourier_transform(&mut present));
    (1..sums.len())
        .map(|k| {
            // Σ cos 2ωt − i Σ sin 2ωt; above the Nyquist frequency by symmetry.
            let twice = if 2 * k < window.len() { window[2 * k] } else { window[span - 2 * k].conj() };
            line(k, explained(sums[k], twice, n as f64), total)
        })
        .collect()
}

/// Sum of squares explained by a sine, from Σ x e^(−iωt), Σ e^(−2iωt) and the number of values. At the phase of
/// orthogonal cosine and sine, their squared norms are (n ± |Σ e^(−2iωt)|)/2.
fn explained(sum: Complex<f64>, twice: Complex<f64>, n: f64) -> f64 {
    let length = twice.norm();
    let half_angle = 0.5 * (-twice.im).atan2(twice.re);
    let (sin, cos) = half_angle.sin_cos();
    let (by_cos, by_sin) = (sum.re, -sum.im);
    let part = |product: f64, square: f64| if square > 1e-9 * n { product * product / square } else { 0.0 };
    part(by_cos * cos + by_sin * sin, 0.5 * (n + length)) + part(by_sin * cos - by_cos * sin, 0.5 * (n - length))
}

/// p-value of constant variance: probability that normal numbers of equal variance have a cumulative sum of squares as
/// far from a straight line (CUSUM of squares, Brown, Durbin and Evans 1975), or a single number as large. It is an
/// upper bound (Bonferroni), and 1 if all numbers are zero or any is not finite.
pub fn constant_variance_p_value(numbers: &[f64]) -> f64 {
    let n = numbers.len() as f64;
    let total: f64 = numbers.iter().map(|x| x * x).sum();
    if total <= 0.0 || !total.is_finite() {
        return 1.0;
    }
    let (mut sum, mut deviation, mut largest) = (0.0, 0.0_f64, 0.0_f64);
    for (k, x) in numbers.iter().enumerate() {
        sum += x * x;
        deviation = deviation.max((sum / total - (k + 1) as f64 / n).abs());
        largest = largest.max(x.abs());
    }
    let cusum = kolmogorov(deviation * (0.5 * n).sqrt());
    let outlier = n * 2.0 * Normal::standard().sf(largest / (total / n).sqrt());
    (2.0 * cusum.min(outlier)).min(1.0)
}

/// Survival function of the Kolmogorov distribution: probability that a Brownian bridge leaves the band ±x,
/// 2 Σ (−1)^(k+1) exp(−2 k² x²).
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

    use std::f64::consts::TAU;

    /// Sine with a period of 20 s in rows of 1 s; only rows that are recorded.
    fn sine(recorded: impl Fn(usize) -> bool) -> GappedSeries {
        let time: Vec<f64> = (0..600).map(f64::from).collect();
        let residual: Vec<f64> =
            (0..600).map(|k| if recorded(k) { (TAU * time[k] / 20.0).sin() } else { f64::NAN }).collect();
        GappedSeries::new(&time, &residual, 1.0)
    }

    fn strongest(series: &GappedSeries) -> SpectralLine {
        periodogram(series)
            .into_iter()
            .max_by(|x, y| x.mean_square_share.total_cmp(&y.mean_square_share))
            .expect("lines")
    }

    /// Patterns of missing headings: none, every third, scattered, a third in one piece, all but every fifth.
    fn patterns() -> [fn(usize) -> bool; 5] {
        [|_| true, |k| k % 3 != 1, |k| (k * 7919) % 101 > 33, |k| !(200..400).contains(&k), |k| k % 5 == 0]
    }

    #[test]
    fn a_sine_is_one_line_and_far_from_white_whatever_is_missing() {
        for (number, pattern) in patterns().into_iter().enumerate() {
            let series = sine(pattern);
            let line = strongest(&series);
            assert!((line.frequency - 0.05).abs() < 2e-4 && line.mean_square_share > 0.95, "{number}: {line:?}");
            assert!(whiteness_test(&[series]).p_value < 1e-12, "{number}");
        }
    }

    /// Autocorrelation of a sine: a cosine at the true lag.
    #[test]
    fn lags_are_those_of_the_clock() {
        for (number, pattern) in patterns().into_iter().enumerate() {
            let series = sine(pattern);
            for rho in autocorrelation(&series, 40) {
                let lag = rho.lag as f64 * series.spacing;
                let full = (600.0 - lag) / 600.0;
                assert!((rho.coefficient - full * (TAU * lag / 20.0).cos()).abs() < 0.06, "{number}: {rho:?}");
            }
        }
    }

    /// Without gaps, the periodogram of Lomb and Scargle is the plain periodogram.
    #[test]
    fn a_sine_fitted_to_even_values_is_a_line_of_the_transform() {
        let values: Vec<f64> = (0..50_u32).map(|k| (0.7 * f64::from(k)).sin() + f64::from(k * k % 7) - 3.0).collect();
        let (sums, window) = (fourier_transform(&mut values.clone()), fourier_transform(&mut vec![1.0; 50]));
        for k in 1..13 {
            let plain = 2.0 * sums[k].norm_sqr() / 50.0;
            assert!((explained(sums[k], window[2 * k], 50.0) / plain - 1.0).abs() < 1e-9);
        }
    }

    /// White noise remains white if headings are missing: the statistic has the mean of its distribution.
    #[test]
    fn holes_make_no_colour() {
        let mut generator = ChaCha8Rng::seed_from_u64(5);
        let time: Vec<f64> = (0..300).map(f64::from).collect();
        for pattern in patterns() {
            let p_values: Vec<f64> = (0..40)
                .map(|_| {
                    let mut draw = |k| if pattern(k) { StandardNormal.sample(&mut generator) } else { f64::NAN };
                    let residual: Vec<f64> = (0..300).map(&mut draw).collect();
                    whiteness_test(&[GappedSeries::new(&time, &residual, 1.0)]).p_value
                })
                .collect();
            let mean = p_values.iter().sum::<f64>() / 40.0;
            assert!((0.35..0.65).contains(&mean), "{mean}");
        }
    }

    /// Quantiles of the Kolmogorov distribution as printed by Smirnov (1948).
    #[test]
    fn the_bridge_has_its_tabulated_quantiles() {
        for (x, probability) in [(0.5, 0.963_945), (1.0, 0.270_000), (1.36, 0.049_486), (1.63, 0.009_843)] {
            assert!((kolmogorov(x) - probability).abs() < 1e-5, "{x}: {}", kolmogorov(x));
        }
    }

    /// Normal numbers of one variance fail at the nominal rate; with twice the standard deviation in one half, or with
    /// one value of 8, they do not pass.
    #[test]
    fn uneven_numbers_are_found() {
        let mut generator = ChaCha8Rng::seed_from_u64(3);
        let mut draw = || -> Vec<f64> { (0..300).map(|_| StandardNormal.sample(&mut generator)).collect() };
        let low = (0..400).filter(|_| constant_variance_p_value(&draw()) < 0.05).count();
        assert!(low <= 30, "{low} of 400 below 0.05");
        let (mut louder, mut single) = (draw(), draw());
        louder[150..].iter_mut().for_each(|x| *x *= 2.0);
        single[100] = 8.0;
        assert!(constant_variance_p_value(&louder) < 1e-4 && constant_variance_p_value(&single) < 1e-4);
    }
}
