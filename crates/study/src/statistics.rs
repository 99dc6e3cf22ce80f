//! Figures over replicates, each with its own Monte-Carlo uncertainty.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// A figure with a 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// The figure.
    pub value: f64,
    /// Its 95 % interval, where the sample is large enough for one.
    pub ci95: Option<[f64; 2]>,
}

/// Resamples of a bootstrap: enough for the 2.5 and 97.5 % points to two digits.
const RESAMPLES: usize = 1000;

/// Two-sided 95 % quantile of the standard normal distribution.
const Z95: f64 = 1.959_963_984_540_054;

/// Median with the distribution-free interval of order statistics.
///
/// `None` for an empty sample; no interval below six values, where none reaches 95 %.
/// Source: Thompson (1936), in the normal approximation of the binomial.
pub fn median(sample: &[f64]) -> Option<Figure> {
    let sorted = sorted(sample);
    let value = quantile_sorted(&sorted, 0.5)?;
    let n = sorted.len();
    let reach = 0.5 * Z95 * (n as f64).sqrt();
    let low = (0.5 * n as f64 - reach).floor();
    let ci95 = (n >= 6 && low >= 0.0).then(|| [sorted[low as usize], sorted[n - 1 - low as usize]]);
    Some(Figure { value, ci95 })
}

/// Root mean square with a percentile bootstrap interval (Efron 1979); deterministic.
pub fn rms(sample: &[f64]) -> Option<Figure> {
    bootstrap(sample, |values| (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt())
}

/// Standard deviation with a percentile bootstrap interval; `None` below two values.
pub fn standard_deviation(sample: &[f64]) -> Option<Figure> {
    if sample.len() < 2 {
        return None;
    }
    bootstrap(sample, |values| {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt()
    })
}

/// A share with Wilson's interval (1927); `None` of nothing.
pub fn share(count: usize, of: usize) -> Option<Figure> {
    if of == 0 {
        return None;
    }
    let (n, z2) = (of as f64, Z95 * Z95);
    let p = count as f64 / n;
    let centre = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
    let reach = Z95 / (1.0 + z2 / n) * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
    Some(Figure { value: p, ci95: Some([(centre - reach).max(0.0), (centre + reach).min(1.0)]) })
}

fn bootstrap(sample: &[f64], statistic: impl Fn(&[f64]) -> f64) -> Option<Figure> {
    if sample.is_empty() {
        return None;
    }
    let value = statistic(sample);
    if sample.len() < 6 {
        return Some(Figure { value, ci95: None });
    }
    // A fixed seed: the same rows give the same interval.
    let mut generator = ChaCha8Rng::seed_from_u64(1979);
    let mut resample = vec![0.0; sample.len()];
    let mut statistics: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            resample.iter_mut().for_each(|x| *x = sample[generator.random_range(0..sample.len())]);
            statistic(&resample)
        })
        .collect();
    statistics.sort_by(f64::total_cmp);
    let end = |p| quantile_sorted(&statistics, p);
    Some(Figure { value, ci95: end(0.025).zip(end(0.975)).map(|(lo, hi)| [lo, hi]) })
}

fn sorted(sample: &[f64]) -> Vec<f64> {
    let mut sorted = sample.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// Quantile by linear interpolation between order statistics (Hyndman and Fan 1996, type 7).
fn quantile_sorted(sorted: &[f64], p: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let place = p * last as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(last);
    Some(sorted[below] + (place - below as f64) * (sorted[above] - sorted[below]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_samples() {
        let sample: Vec<f64> = (1..=101).map(f64::from).collect();
        let middle = median(&sample).expect("not empty");
        assert_eq!(middle.value, 51.0);
        // Ranks of the exact binomial interval for n = 101: 41 and 61.
        assert_eq!(middle.ci95, Some([41.0, 61.0]));
        assert_eq!(median(&[]), None);
        assert_eq!(rms(&[3.0, -3.0, 3.0]).map(|figure| figure.value), Some(3.0));
        // Wilson's interval for 8 of 10.
        let [lo, hi] = share(8, 10).and_then(|figure| figure.ci95).expect("not empty");
        assert!((lo - 0.490).abs() < 1e-3 && (hi - 0.943).abs() < 1e-3);
    }

    #[test]
    fn the_bootstrap_repeats_and_covers() {
        let sample: Vec<f64> = (0..200).map(|k| ((k * 37 % 200) as f64 / 100.0 - 1.0) * 1.7).collect();
        let first = standard_deviation(&sample).expect("enough");
        assert_eq!(Some(first), standard_deviation(&sample));
        let [lo, hi] = first.ci95.expect("enough");
        assert!(lo < first.value && first.value < hi && (hi - lo) < 0.3 * first.value);
    }
}
