//! A figure over replicates with its interval, and the interval of a share.

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
pub(super) const FEWEST: u64 = 6;

/// A share with Wilson's interval (1927); `None` of nothing.
pub fn share(count: u64, of: u64) -> Option<Statistic> {
    if of == 0 {
        return None;
    }
    let (n, z2) = (of as f64, Z95 * Z95);
    let p = count as f64 / n;
    let centre = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
    let reach = Z95 / (1.0 + z2 / n) * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
    Some(Statistic { value: p, ci95: Some([(centre - reach).max(0.0), (centre + reach).min(1.0)]) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_have_the_interval_of_wilson() {
        let [lo, hi] = share(8, 10).and_then(|figure| figure.ci95).expect("not empty");
        assert!((lo - 0.490).abs() < 1e-3 && (hi - 0.943).abs() < 1e-3);
        assert_eq!(share(0, 0), None);
    }
}
