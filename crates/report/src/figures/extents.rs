//! Ends of an axis: over data that must be visible, and over data that may be cut if there is no room.

use estimation::statistics::upper_median;

use crate::axis;

/// Limit of an axis against outliers: a multiple of the median extent from a centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutlierLimit {
    /// Multiple of the median extent.
    pub extent_factor: f64,
    /// Centre of the axis; `None` for the median of the data, which is not supported for a symmetric axis.
    pub centre: Option<f64>,
    /// `true` if the axis is symmetric about the centre.
    pub is_symmetric: bool,
}

/// Data along an axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Extents {
    /// Minimum and maximum of every item that sets the axis.
    pub item_ranges: Vec<(f64, f64)>,
    /// Values that are always visible.
    pub fixed: Vec<f64>,
    /// Values that may widen the axis, each with its maximum share of the range of all other data.
    pub clippable_values: Vec<(f64, f64)>,
}

/// Maximum share of the range by which the ends of intervals may widen an axis.
pub(super) const MAX_INTERVAL_SHARE: f64 = 1.0;

/// Minimum median extent, as a share of the centre: equal values differ by rounding alone.
const LEAST_USUAL: f64 = 1e-3;

/// Minimum room of an interval, as a share of the maximum magnitude: equal values have no range.
const LEAST_ROOM: f64 = 0.2;

/// Minimum lower end of an interval on a logarithmic axis, as a share of the minimum positive value. Lower ends are
/// cut, because they would stretch the axis by decades.
const LOWEST: f64 = 0.5;

/// Maximum upper end of an interval on a logarithmic axis, as a multiple of the maximum value.
const HIGHEST: f64 = 10.0;

impl Extents {
    /// Adds an item that sets the axis.
    pub(super) fn add(&mut self, values: impl IntoIterator<Item = f64>) {
        self.item_ranges.extend(axis::range(values));
    }

    /// Ends of the axis, and whether a clippable value is cut; `None` without data.
    pub(super) fn ends(&self, limit: Option<OutlierLimit>) -> (Option<(f64, f64)>, bool) {
        let within = limit.map_or_else(|| self.item_ranges.clone(), |limit| self.within(limit));
        let flat = |pairs: &[(f64, f64)]| -> Vec<f64> { pairs.iter().flat_map(|(lo, hi)| [*lo, *hi]).collect() };
        let fixed = self.fixed.iter().copied();
        let Some((lo, hi)) = axis::range(flat(&within).into_iter().chain(fixed)) else {
            return (axis::range(self.clippable_values.iter().map(|(value, _)| *value)), false);
        };
        let (mut ends, mut is_cut) = ((lo, hi), false);
        for (value, room) in self.clippable_values.iter().filter(|(value, _)| value.is_finite()) {
            let least = if *room == MAX_INTERVAL_SHARE { LEAST_ROOM * lo.abs().max(hi.abs()) } else { 0.0 };
            let room = match hi > lo || least > 0.0 {
                true => (room * (hi - lo)).max(least),
                false => f64::INFINITY,
            };
            ends = (ends.0.min(value.max(lo - room)), ends.1.max(value.min(hi + room)));
            is_cut |= *value < lo - room || *value > hi + room;
        }
        match limit {
            Some(OutlierLimit { is_symmetric: true, centre, .. }) => {
                let centre = centre.unwrap_or(0.0);
                let half = (ends.0 - centre).abs().max((ends.1 - centre).abs());
                (Some((centre - half, centre + half)), is_cut)
            }
            _ => (Some(ends), is_cut),
        }
    }

    /// Extents within the limit of an axis; an extent partly within it is shortened.
    fn within(&self, OutlierLimit { extent_factor, centre, .. }: OutlierLimit) -> Vec<(f64, f64)> {
        let middles = self.item_ranges.iter().map(|(lo, hi)| 0.5 * (lo + hi));
        let centre = centre.or_else(|| upper_median(middles)).unwrap_or(0.0);
        let extents = self.item_ranges.iter().map(|(lo, hi)| (lo - centre).abs().max((hi - centre).abs()));
        let usual = upper_median(extents.filter(|extent| *extent > 0.0)).unwrap_or(f64::INFINITY);
        let room = extent_factor * usual.max(LEAST_USUAL * centre.abs());
        let (least, most) = (centre - room, centre + room);
        let near = self.item_ranges.iter().filter(|(lo, hi)| *lo <= most && *hi >= least);
        near.map(|(lo, hi)| (lo.max(least), hi.min(most))).collect()
    }

    /// Values that set a logarithmic axis: finite ones from zero on, and ends of intervals within limits.
    pub(super) fn positive(&self) -> Vec<f64> {
        let all = self.item_ranges.iter().flat_map(|(lo, hi)| [*lo, *hi]).chain(self.fixed.iter().copied());
        let mut values: Vec<f64> = all.filter(|value| *value >= 0.0 && value.is_finite()).collect();
        let lowest = values.iter().copied().filter(|value| *value > 0.0).fold(f64::INFINITY, f64::min);
        let highest = values.iter().copied().fold(0.0, f64::max);
        let clippable = self.clippable_values.iter().map(|(value, _)| *value).filter(|value| *value > LOWEST * lowest);
        values.extend(clippable.map(|value| value.min(HIGHEST * highest)).collect::<Vec<f64>>());
        values
    }
}

/// Maximum share of the points on either side that count as outliers.
const FAR: f64 = 0.005;

/// Maximum distance of outliers from the other points on the axis, in ranges of the other points.
const ROOM: f64 = 0.5;

/// Values that set the axis: minimum and maximum, after a few outliers are moved towards the other values. If these are
/// too few to define a range, all values set the axis.
pub(super) fn robust_range(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    let skipped = (FAR * values.len() as f64).ceil() as usize;
    let inner = values.get(skipped..values.len().saturating_sub(skipped)).filter(|inner| inner.len() > 10);
    match inner.and_then(|inner| axis::range(inner.iter().copied())) {
        Some((lo, hi)) => {
            let room = ROOM * (hi - lo);
            vec![values[0].max(lo - room), values[values.len() - 1].min(hi + room)]
        }
        None => values,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wild_does_not_set_an_axis_and_what_is_fixed_does() {
        let mut data = Extents::default();
        [0.1, 0.101, 0.099, 9.0].into_iter().for_each(|value| data.add([value, 1.1 * value]));
        let ends = |data: &Extents, limit| data.ends(limit).0.expect("there are data");
        assert_eq!(ends(&data, None), (0.099, 9.9));
        let limit = OutlierLimit { extent_factor: 4.0, centre: None, is_symmetric: false };
        assert!(ends(&data, Some(limit)).1 < 0.2, "{:?}", ends(&data, Some(limit)));
        data.fixed.push(1.0);
        assert_eq!(ends(&data, Some(limit)).1, 1.0);
        let about = OutlierLimit { centre: Some(0.0), is_symmetric: true, ..limit };
        let (lo, hi) = ends(&data, Some(about));
        assert_eq!(lo, -hi);
    }

    #[test]
    fn clippable_values_widen_an_axis_as_far_as_there_is_room() {
        let mut data = Extents::default();
        data.add([0.0, 10.0]);
        data.clippable_values = vec![(12.0, 0.25)];
        assert_eq!(data.ends(None), (Some((0.0, 12.0)), false));
        data.clippable_values.push((1e9, 0.25));
        assert_eq!(data.ends(None), (Some((0.0, 12.5)), true));
        data.clippable_values = vec![(0.1, 1.0), (1e-9, 1.0), (40.0, 1.0)];
        data.item_ranges = vec![(1.0, 10.0)];
        assert_eq!(data.positive(), [1.0, 10.0, 40.0]);
    }
}
