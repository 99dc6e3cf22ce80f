//! Gaps of a record. A method that differentiates, integrates or averages the heading must not do so across a long
//! interval without headings; [`gap_free_ranges`] gives the parts without a gap.

use std::ops::Range;

/// Maximum interval that is not a gap, in mean intervals, if no setting gives the maximum.
const GAP_INTERVALS: f64 = 5.0;

/// Maximum interval, s, that is not a gap: the setting, or five mean intervals of the record; infinite with fewer than
/// two times.
pub fn gap_threshold(setting_s: Option<f64>, time: &[f64]) -> f64 {
    setting_s.unwrap_or_else(|| match time {
        [first, .., last] => GAP_INTERVALS * (last - first) / (time.len() - 1) as f64,
        _ => f64::INFINITY,
    })
}

/// Ranges of rows between gaps, in order; `time` (s) increases, and an interval above `longest_gap` (s) is a gap.
pub fn gap_free_ranges(time: &[f64], longest_gap: f64) -> impl Iterator<Item = Range<usize>> {
    let mut from = 0;
    std::iter::from_fn(move || {
        let start = from;
        let tail = time.get(start..).filter(|times| !times.is_empty())?;
        let length = tail.windows(2).position(|pair| pair[1] - pair[0] > longest_gap).map_or(tail.len(), |k| k + 1);
        from = start + length;
        Some(start..from)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_belongs_to_a_piece() {
        let time = [0.0, 1.0, 2.0, 9.0, 10.0, 30.0];
        assert_eq!(gap_free_ranges(&time, 3.0).collect::<Vec<_>>(), [0..3, 3..5, 5..6]);
        assert!(gap_free_ranges(&time, 50.0).eq(std::iter::once(0..6)));
        assert_eq!(gap_free_ranges(&[], 3.0).count(), 0);
    }

    #[test]
    fn a_gap_is_five_mean_intervals_unless_set() {
        assert_eq!(gap_threshold(None, &[0.0, 0.5, 1.0]), 2.5);
        assert_eq!(gap_threshold(Some(7.0), &[0.0, 0.5, 1.0]), 7.0);
        assert_eq!(gap_threshold(None, &[0.0]), f64::INFINITY);
    }
}
