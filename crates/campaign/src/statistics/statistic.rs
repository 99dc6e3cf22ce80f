//! A figure over replicates with its interval, and the interval of a share.

use estimation::statistics::wilson;
use serde::{Deserialize, Serialize};

/// A figure with a 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Statistic {
    /// The figure.
    pub value: f64,
    /// Its 95 % interval, where the sample is large enough for one.
    pub ci95: Option<[f64; 2]>,
}

impl Statistic {
    /// The figure and the ends of its interval, as far as there are any.
    pub fn flat(figure: Option<Self>) -> [Option<f64>; 3] {
        let ends = figure.and_then(|figure| figure.ci95);
        [figure.map(|figure| figure.value), ends.map(|ends| ends[0]), ends.map(|ends| ends[1])]
    }

    /// The figure in another unit; `factor` is above zero.
    pub fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, ci95: self.ci95.map(|ends| ends.map(|end| end * factor)) }
    }
}

/// Two-sided 95 % quantile of the standard normal distribution.
pub const Z95: f64 = 1.959_963_984_540_054;

/// Fewest values of which an interval is given: no pair of order statistics of fewer covers the median in 95 %.
pub const FEWEST: u64 = 6;

/// Values from which a median or a range stands for them; fewer are shown one by one.
pub const MIN_SUMMARISED: usize = 5;

/// A share with Wilson's interval (1927); `None` of nothing.
pub fn share(count: u64, of: u64) -> Option<Statistic> {
    if of == 0 {
        return None;
    }
    let value = count as f64 / of as f64;
    Some(Statistic { value, ci95: Some(wilson(value, of as f64, Z95)) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_nothing_there_is_no_share() {
        assert_eq!(share(0, 0), None);
    }
}
