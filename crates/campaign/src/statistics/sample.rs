//! Sample of any size in bounded memory: exact values up to some thousands, then counts in bins of constant relative
//! width (Masson, Rim and Lee 2019, "DDSketch").

use std::collections::BTreeMap;

use super::statistic::{MIN_INTERVAL_VALUES, NORMAL_QUANTILE_95, Statistic};

/// Maximum number of exact values.
const MAX_EXACT_VALUES: usize = 8192;

/// Relative accuracy of a binned value.
const ACCURACY: f64 = 1e-3;

/// Absolute value below which a binned value counts as zero.
const ZERO: f64 = 1e-12;

/// Maximum extent of a density beyond the quartiles, in interquartile ranges.
const TAILS: f64 = 3.0;

/// Sample of finite values: exact up to `MAX_EXACT_VALUES`, then counts in bins of relative accuracy `ACCURACY`.
#[derive(Debug, Clone, Default)]
pub struct ErrorSample {
    exact: Vec<f64>,
    /// Counts by bin, in the order of the values; empty if all are exact.
    bins: BTreeMap<i32, u64>,
}

impl ErrorSample {
    /// Adds a value unless it is not finite.
    pub fn add(&mut self, value: f64) {
        if !value.is_finite() {
            return;
        }
        if self.bins.is_empty() && self.exact.len() < MAX_EXACT_VALUES {
            self.exact.push(value);
            return;
        }
        for value in self.exact.drain(..).chain([value]) {
            *self.bins.entry(bin(value)).or_default() += 1;
        }
    }

    /// Values in ascending order; a binned value has a relative error of at most 0.1 %.
    pub fn ordered(&self) -> OrderedSample {
        if self.bins.is_empty() {
            return OrderedSample::from_counts(self.exact.iter().map(|&value| (value, 1)).collect());
        }
        OrderedSample::from_counts(self.bins.iter().map(|(&bin, &count)| (value_of(bin), count)).collect())
    }
}

/// Offset of bin numbers from the exponent k: bin 0 is zero, bin ±(1 + k + OFFSET) contains |x| in (γᵏ⁻¹, γᵏ].
const OFFSET: i32 = 1 << 20;

fn growth() -> f64 {
    (1.0 + ACCURACY) / (1.0 - ACCURACY)
}

fn bin(value: f64) -> i32 {
    let size = value.abs();
    if size < ZERO {
        return 0;
    }
    let place = 1 + OFFSET + (size.ln() / growth().ln()).ceil() as i32;
    if value < 0.0 { -place } else { place }
}

fn value_of(bin: i32) -> f64 {
    if bin == 0 {
        return 0.0;
    }
    let size = 2.0 * growth().powi(bin.abs() - 1 - OFFSET) / (growth() + 1.0);
    if bin < 0 { -size } else { size }
}

/// Sample in ascending order, as values with cumulative counts.
#[derive(Debug, Clone, PartialEq)]
pub struct OrderedSample {
    values: Vec<f64>,
    /// Cumulative counts.
    up_to: Vec<u64>,
}

impl OrderedSample {
    fn from_counts(mut counted: Vec<(f64, u64)>) -> Self {
        counted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut total = 0;
        let up_to = counted.iter().map(|&(_, count)| {
            total += count;
            total
        });
        let up_to = up_to.collect();
        Self { values: counted.into_iter().map(|(value, _)| value).collect(), up_to }
    }

    /// Number of values.
    pub fn len(&self) -> u64 {
        self.up_to.last().copied().unwrap_or(0)
    }

    /// `true` if there are no values.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    fn counted(&self) -> impl Iterator<Item = (f64, u64)> {
        let before = std::iter::once(0).chain(self.up_to.iter().copied());
        self.values.iter().copied().zip(self.up_to.iter().zip(before).map(|(up_to, before)| up_to - before))
    }

    /// Value at a rank, from 0.
    fn at(&self, rank: u64) -> f64 {
        self.values[self.up_to.partition_point(|&up_to| up_to <= rank)]
    }

    /// p-quantile (p from 0 to 1) by linear interpolation between order statistics (Hyndman and Fan 1996, type 7);
    /// `None` without values.
    pub fn quantile(&self, p: f64) -> Option<f64> {
        let last = self.len().checked_sub(1)?;
        let place = p * last as f64;
        let below = place.floor() as u64;
        let (low, high) = (self.at(below), self.at((below + 1).min(last)));
        Some(low + (place - below as f64) * (high - low))
    }

    /// p-quantile (p from 0 to 1) with its distribution-free 95 % interval (Thompson 1936, normal approximation of the
    /// binomial); no interval if the sample is too small for it.
    pub fn quantile_statistic(&self, p: f64) -> Option<Statistic> {
        let value = self.quantile(p)?;
        let n = self.len() as f64;
        let reach = NORMAL_QUANTILE_95 * (n * p * (1.0 - p)).sqrt();
        let (low, high) = ((n * p - reach).floor(), (n * p + reach).ceil() - 1.0);
        let ci95 = (self.len() >= MIN_INTERVAL_VALUES && low >= 0.0 && high < n)
            .then(|| [self.at(low as u64), self.at(high as u64)]);
        Some(Statistic { value, ci95 })
    }

    /// Absolute deviations from a centre.
    pub fn absolute_deviations(&self, centre: f64) -> Self {
        Self::from_counts(self.counted().map(|(value, count)| ((value - centre).abs(), count)).collect())
    }

    /// Median absolute deviation from the median, not scaled to a standard deviation; `None` without values.
    pub fn mad(&self) -> Option<Statistic> {
        self.absolute_deviations(self.quantile(0.5)?).quantile_statistic(0.5)
    }

    /// Pairs of abscissa and Gaussian kernel density, at `points` abscissae. They span the middle 98 % and two
    /// bandwidths on either side, at most three interquartile ranges beyond the quartiles, so that heavy tails do not
    /// spread the abscissae too far for the kernel. Bandwidth of Silverman (1986, eq. 3.31). Empty for fewer than ten
    /// values, for equal quartiles, and for fewer than two points.
    pub fn density(&self, points: usize) -> Vec<(f64, f64)> {
        let quantiles = [0.01, 0.25, 0.75, 0.99].map(|p| self.quantile(p).unwrap_or(0.0));
        let n = self.len() as f64;
        // A normal distribution has an interquartile range of 1.349 standard deviations; this is robust to heavy tails.
        let spread = (quantiles[2] - quantiles[1]) / 1.349;
        if self.len() < 10 || spread <= 0.0 || points < 2 {
            return Vec::new();
        }
        let bandwidth = 0.9 * spread * n.powf(-0.2);
        let reach = TAILS * (quantiles[2] - quantiles[1]);
        let from = (quantiles[0] - 2.0 * bandwidth).max(quantiles[1] - reach);
        let to = (quantiles[3] + 2.0 * bandwidth).min(quantiles[2] + reach);
        let norm = 1.0 / (n * bandwidth * (2.0 * std::f64::consts::PI).sqrt());
        (0..points)
            .map(|k| {
                let x = from + (to - from) * k as f64 / (points - 1) as f64;
                let kernel = |value: f64| (-0.5 * ((x - value) / bandwidth).powi(2)).exp();
                (x, norm * self.counted().map(|(value, count)| count as f64 * kernel(value)).sum::<f64>())
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::distribution::{ContinuousCDF, Normal};

    fn sample(values: impl IntoIterator<Item = f64>) -> OrderedSample {
        let mut sample = ErrorSample::default();
        values.into_iter().for_each(|value| sample.add(value));
        sample.ordered()
    }

    /// Quantiles of a normal distribution: a deterministic sample.
    fn normal(n: usize) -> impl Iterator<Item = f64> {
        let law = Normal::standard();
        (0..n).map(move |k| law.inverse_cdf((k as f64 + 0.5) / n as f64))
    }

    #[test]
    fn small_samples_are_exact() {
        let ordered = sample((1..=101).rev().map(f64::from));
        // Ranks of the exact binomial interval for n = 101: 41 and 61.
        assert_eq!(ordered.quantile_statistic(0.5), Some(Statistic { value: 51.0, ci95: Some([41.0, 61.0]) }));
        assert_eq!(ordered.mad().map(|figure| figure.value), Some(25.0));
        assert_eq!(ordered.quantile(0.125), Some(13.5));
        assert_eq!(sample([]).quantile_statistic(0.5), None);
        assert_eq!(sample([1.0, f64::NAN, f64::INFINITY]).len(), 1);
        assert_eq!(
            sample([1.0, 2.0, 3.0]).quantile_statistic(0.5).and_then(|figure| figure.ci95),
            None,
            "too few for an interval"
        );
    }

    #[test]
    fn large_samples_are_within_the_accuracy_of_a_bin() {
        let n = 100_000;
        let (ordered, law) = (sample(normal(n).map(|x| 3.0 * x - 0.5)), Normal::standard());
        assert_eq!(ordered.len(), n as u64);
        assert!(ordered.values.len() < 20_000, "{} bins", ordered.values.len());
        for p in [0.001, 0.025, 0.25, 0.75, 0.975, 0.999] {
            let (actual, expected) = (ordered.quantile(p).expect("not empty"), 3.0 * law.inverse_cdf(p) - 0.5);
            assert!((actual / expected - 1.0).abs() < 2.0 * ACCURACY, "{p}: {actual} for {expected}");
        }
        // Φ⁻¹(0.75) standard deviations.
        assert!((ordered.mad().expect("not empty").value / (3.0 * 0.674_489_75) - 1.0).abs() < 2.0 * ACCURACY);
    }

    #[test]
    fn a_density_has_the_area_and_height_of_its_law() {
        let density = sample(normal(4000)).density(200);
        let step = density[1].0 - density[0].0;
        let area: f64 = density.iter().map(|(_, height)| height * step).sum();
        assert!((area - 0.985).abs() < 0.01, "{area}");
        let peak = density.iter().map(|(_, height)| *height).fold(0.0, f64::max);
        assert!((peak * (2.0 * std::f64::consts::PI).sqrt() - 1.0).abs() < 0.03, "{peak}");
        assert!(sample([1.0; 50]).density(20).is_empty());
    }
}
