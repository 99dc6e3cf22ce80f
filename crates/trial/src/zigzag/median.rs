//! The middle of a few values.

/// Median; the mean of the two middle values where their number is even, so that a mirrored set has the mirrored
/// median.
///
/// `None` for an empty set. The values are reordered and must be finite.
pub fn median(values: &mut [f64]) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len() / 2;
    Some(if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) })
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
