//! Statistic over replicates, and shares, with their intervals.

use estimation::statistics::wilson_interval;
use serde::{Deserialize, Serialize};

/// Statistic with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Statistic {
    /// Value of the statistic.
    pub value: f64,
    /// 95 % interval; `None` for a sample that is too small.
    pub ci95: Option<[f64; 2]>,
}

impl Statistic {
    /// Value, and lower and upper end of the interval; `None` if undefined.
    pub fn value_and_ends(figure: Option<Self>) -> [Option<f64>; 3] {
        let ends = figure.and_then(|figure| figure.ci95);
        [figure.map(|figure| figure.value), ends.map(|ends| ends[0]), ends.map(|ends| ends[1])]
    }

    /// Statistic in another unit; `factor` is above zero.
    pub fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, ci95: self.ci95.map(|ends| ends.map(|end| end * factor)) }
    }
}

/// Two-sided 95 % quantile of the standard normal distribution, 1.96.
pub const NORMAL_QUANTILE_95: f64 = 1.959_963_984_540_054;

/// Minimum number of values for an interval: below it no pair of order statistics covers the median with 95 %.
pub const MIN_INTERVAL_VALUES: u64 = 6;

/// Minimum number of values that are summarised by a median and a range; fewer are shown individually.
pub const MIN_SUMMARISED_VALUES: usize = 5;

/// Share of `count` in `cases` with its interval (Wilson 1927); `None` without cases.
pub fn wilson_share(count: u64, cases: u64) -> Option<Statistic> {
    if cases == 0 {
        return None;
    }
    let value = count as f64 / cases as f64;
    Some(Statistic { value, ci95: Some(wilson_interval(value, cases as f64, NORMAL_QUANTILE_95)) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_nothing_there_is_no_share() {
        assert_eq!(wilson_share(0, 0), None);
    }
}
