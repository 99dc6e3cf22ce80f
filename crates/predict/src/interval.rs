//! Quantiles of samples, and their significant digits.

use estimation::statistics::quantile;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Maximum width of the 90 % interval that sets the decimals, in widths of the 50 % interval; a normal distribution has
/// 2.4.
const MAX_WIDTHS: f64 = 3.0;

/// Median with the 50 % and 90 % intervals of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PredictionInterval {
    /// Median.
    pub median: f64,
    /// Quantiles of 25 and 75 %.
    pub ci50: [f64; 2],
    /// Quantiles of 5 and 95 %.
    pub ci90: [f64; 2],
}

/// Quantiles of 5, 25, 50, 75 and 95 % of the values, which are sorted in place.
///
/// # Panics
/// Without a value.
pub(crate) fn quantiles(values: &mut [f64]) -> [f64; 5] {
    values.sort_unstable_by(f64::total_cmp);
    [0.05, 0.25, 0.5, 0.75, 0.95].map(|share| quantile(values, share))
}

impl PredictionInterval {
    /// Median and intervals of samples, which are sorted in place; `None` without samples.
    pub fn from_samples(values: &mut [f64]) -> Option<Self> {
        let [lowest, low, median, high, highest] = (!values.is_empty()).then(|| quantiles(values))?;
        Some(Self { median, ci50: [low, high], ci90: [lowest, highest] })
    }

    /// Number of decimals that shows two digits of the width of the 90 % interval, at most six. For a skewed
    /// distribution the width is limited to three times that of the 50 % interval, whose digits a long tail would round
    /// away.
    pub fn decimals(&self) -> usize {
        let width = |ends: [f64; 2]| ends[1] - ends[0];
        let width = match MAX_WIDTHS * width(self.ci50) {
            most if most > 0.0 => most.min(width(self.ci90)),
            _ => width(self.ci90),
        };
        let decimals = if width > 0.0 { (1.0 - width.log10().floor()).max(0.0) } else { 2.0 };
        (decimals as usize).min(6)
    }

    /// `true` if a value lies within the 90 % interval.
    pub fn contains_90(&self, value: f64) -> bool {
        (self.ci90[0]..=self.ci90[1]).contains(&value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_numbers() {
        let interval = PredictionInterval::from_samples(&mut [4.0, 0.0, 2.0, 1.0, 3.0]).expect("five");
        assert_eq!((interval.median, interval.ci50), (2.0, [1.0, 3.0]));
        assert!((interval.ci90[0] - 0.2).abs() < 1e-12 && (interval.ci90[1] - 3.8).abs() < 1e-12);
        assert!(interval.contains_90(0.3) && !interval.contains_90(0.1));
        assert_eq!(PredictionInterval::from_samples(&mut []), None);
        let skewed = PredictionInterval { median: 0.4, ci50: [0.2, 1.1], ci90: [0.1, 12.0] };
        assert_eq!((skewed.decimals(), PredictionInterval { ci50: [0.4; 2], ..skewed }.decimals()), (1, 0));
        assert_eq!(PredictionInterval::from_samples(&mut [7.0]).expect("one").ci90, [7.0, 7.0]);
    }
}
