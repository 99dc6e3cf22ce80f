//! The middle of a few values.

/// Median; the mean of the two middle values where their number is even, so that a mirrored set has the mirrored
/// median. Found in linear time.
///
/// `None` for an empty set. The values are reordered and must be finite.
pub fn median(values: &mut [f64]) -> Option<f64> {
    let even = values.len().is_multiple_of(2);
    let middle = values.len() / 2;
    let (below, &mut upper, _) = (!values.is_empty()).then(|| values.select_nth_unstable_by(middle, f64::total_cmp))?;
    let lower = below.iter().copied().max_by(f64::total_cmp).filter(|_| even);
    Some(lower.map_or(upper, |lower| 0.5 * (lower + upper)))
}

/// The middle value, the upper of two where their number is even; found in linear time, for very many values.
///
/// `None` for an empty set. The values are reordered.
pub fn upper_median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_a_mirrored_set_is_mirrored() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0, 7.0]), Some(2.5));
        assert_eq!(median(&mut [-3.0, -1.0, -2.0, -7.0]), Some(-2.5));
        assert_eq!(median(&mut []), None);
        assert_eq!([upper_median(&mut [3.0, 1.0, 2.0, 7.0]), upper_median(&mut [])], [Some(3.0), None]);
    }
}
