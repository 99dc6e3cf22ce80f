//! Medians, quantiles and intervals of proportions.
//!
//! Sources: Hyndman and Fan (1996), The American Statistician 50:361-365; Wilson (1927), Journal of the American
//! Statistical Association 22:209-212.

/// Maximum number of values that are sorted for their median; for more values a selection is faster.
const MAX_SORTED: usize = 16;

/// Median; for an even number of values the mean of the two middle values, so that the median of a mirrored set is
/// mirrored.
///
/// `None` for an empty set. Linear time; the values are reordered and must not be NaN.
pub fn median(values: &mut [f64]) -> Option<f64> {
    let even = values.len().is_multiple_of(2);
    let middle = values.len() / 2;
    if (1..=MAX_SORTED).contains(&values.len()) {
        values.sort_unstable_by(f64::total_cmp);
        return Some(if even { 0.5 * (values[middle - 1] + values[middle]) } else { values[middle] });
    }
    let (below, &mut upper, _) = (!values.is_empty()).then(|| values.select_nth_unstable_by(middle, f64::total_cmp))?;
    let lower = below.iter().copied().max_by(f64::total_cmp).filter(|_| even);
    Some(lower.map_or(upper, |lower| 0.5 * (lower + upper)))
}

/// Upper median of the finite values: for an even number of values the upper of the two middle values.
///
/// `None` without a finite value. Linear time, suitable for very many values.
pub fn upper_median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Quantile by linear interpolation between order statistics (Hyndman and Fan 1996, type 7).
///
/// `sorted` ascends and may contain infinities; `share` is from 0 to 1. NaN for an empty set.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = share * last as f64;
    let below = place.floor() as usize;
    let (low, high) = (sorted[below], sorted[(below + 1).min(last)]);
    let part = place - below as f64;
    if part == 0.0 || low == high { low } else { low + part * (high - low) }
}

/// Score interval of a proportion `share`, from 0 to 1, observed in `cases` independent cases (Wilson 1927); `quantile`
/// is the quantile of the standard normal distribution, 1.96 for 95 %. [0, 1] if there are no cases.
pub fn wilson_interval(share: f64, cases: f64, quantile: f64) -> [f64; 2] {
    if cases <= 0.0 {
        return [0.0, 1.0];
    }
    let z2 = quantile * quantile;
    let centre = (share + z2 / (2.0 * cases)) / (1.0 + z2 / cases);
    let reach = quantile / (1.0 + z2 / cases) * (share * (1.0 - share) / cases + z2 / (4.0 * cases * cases)).sqrt();
    [(centre - reach).max(0.0), (centre + reach).min(1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_a_mirrored_set_is_mirrored() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0, 7.0]), Some(2.5));
        assert_eq!(median(&mut [-3.0, -1.0, -2.0, -7.0]), Some(-2.5));
        assert_eq!(median(&mut []), None);
        assert_eq!([upper_median([3.0, f64::NAN, 1.0, 2.0, 7.0]), upper_median([])], [Some(3.0), None]);
    }

    #[test]
    fn shares_have_the_interval_of_wilson() {
        let [low, high] = wilson_interval(0.8, 10.0, 1.96);
        assert!((low - 0.490).abs() < 1e-3 && (high - 0.943).abs() < 1e-3);
        assert_eq!(wilson_interval(0.0, 0.0, 1.96), [0.0, 1.0]);
    }

    #[test]
    fn quantiles_are_those_of_the_numbers() {
        let five = [0.0, 1.0, 2.0, 3.0, 4.0];
        assert_eq!([0.0, 0.25, 0.5, 1.0].map(|share| quantile(&five, share)), [0.0, 1.0, 2.0, 4.0]);
        assert!((quantile(&five, 0.05) - 0.2).abs() < 1e-12);
        assert_eq!(quantile(&[1.0, f64::INFINITY], 0.0), 1.0);
        assert_eq!(quantile(&[f64::INFINITY; 2], 0.5), f64::INFINITY);
        assert!(quantile(&[], 0.5).is_nan());
    }
}
