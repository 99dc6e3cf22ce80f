//! Readings of the compass that belong to no ship: single spikes, sentinels such as −999, and jumps after which the
//! compass is off by a constant.
//!
//! What a fit leaves of the heading moves no faster than the noise. A reading far from its neighbours there is a spike;
//! a level that changes from one reading to the next and stays is a jump. Both are looked for again in the fit without
//! them until nothing changes, so an honest reading that stood beside a spike comes back.

use crate::track::Track;

/// Neighbours on either side that a reading is held against: runs of up to three spikes are told from them.
const NEIGHBOURS: usize = 3;

/// Distance from the neighbours, in robust standard deviations, beyond which a reading is left out: one of 10⁸ normal
/// ones.
const SPIKE: f64 = 6.0;

/// The same for a change of level.
const JUMP: f64 = 8.0;

/// Share of the range of the heading below which neither is looked for: corners of the rudder between rows leave as
/// much.
const SMALLEST: f64 = 2e-3;

/// With a larger share of the readings they are no outliers but noise of another law.
pub(super) const LARGEST_SHARE: f64 = 0.1;

/// Standard deviation of normal numbers over the median of their magnitudes.
const NORMAL: f64 = 1.4826;

/// Rows that may be off.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Suspects {
    /// Rows of spikes, increasing.
    pub spikes: Vec<usize>,
    /// First rows after jumps, increasing.
    pub jumps: Vec<usize>,
}

/// Looks for spikes and jumps in what a fit leaves of the headings of a track (rad, one for every reading of the whole
/// track).
pub(super) fn find(whole: &Track, residual: &[f64]) -> Suspects {
    let range = whole.heading.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], &x| [lo.min(x), hi.max(x)]);
    // The range itself may be that of a sentinel.
    let floor = SMALLEST * (range[1] - range[0]).min(std::f64::consts::PI);
    let rows = whole.observed();
    let mut kept: Vec<usize> = (0..residual.len()).collect();
    let most = (LARGEST_SHARE * residual.len() as f64).ceil() as usize + 1;
    let limit = (SPIKE * NORMAL * median(&mut magnitudes(&deviations(residual, &kept)))).max(floor);
    let mut spikes = Vec::new();
    while spikes.len() < most {
        let deviations = deviations(residual, &kept);
        let largest = (0..kept.len()).max_by(|&one, &other| deviations[one].abs().total_cmp(&deviations[other].abs()));
        match largest {
            Some(place) if deviations[place].abs() > limit => spikes.push(rows[kept.remove(place)]),
            _ => break,
        }
    }
    spikes.sort_unstable();
    Suspects { jumps: jumps(residual, &kept, floor).into_iter().map(|number| rows[number]).collect(), spikes }
}

/// Every reading less the median of its neighbours.
fn deviations(residual: &[f64], kept: &[usize]) -> Vec<f64> {
    let mut around = Vec::with_capacity(2 * NEIGHBOURS);
    (0..kept.len())
        .map(|k| {
            around.clear();
            around.extend((k.saturating_sub(NEIGHBOURS)..k).map(|other| residual[kept[other]]));
            around.extend((k + 1..(k + 1 + NEIGHBOURS).min(kept.len())).map(|other| residual[kept[other]]));
            residual[kept[k]] - median(&mut around)
        })
        .collect()
}

/// Readings from which on the level is another one.
fn jumps(residual: &[f64], kept: &[usize], floor: f64) -> Vec<usize> {
    let level = |range: std::ops::Range<usize>| median(&mut range.map(|k| residual[kept[k]]).collect::<Vec<f64>>());
    let width = NEIGHBOURS + 1;
    if kept.len() < 4 * width {
        return Vec::new();
    }
    let places: Vec<usize> = (width..=kept.len() - width).collect();
    let changes: Vec<f64> = places.iter().map(|&k| level(k..k + width) - level(k - width..k)).collect();
    let limit = (JUMP * NORMAL * median(&mut magnitudes(&changes))).max(floor);
    let mut found: Vec<usize> = Vec::new();
    let mut order: Vec<usize> = (0..changes.len()).filter(|&k| changes[k].abs() > limit).collect();
    // The steepest of a neighbourhood is where it happened.
    let steep = |k: usize| (residual[kept[places[k]]] - residual[kept[places[k] - 1]]) * changes[k].signum();
    order.sort_by(|&one, &other| (changes[other].abs() + steep(other)).total_cmp(&(changes[one].abs() + steep(one))));
    for k in order {
        if found.iter().all(|&other| other.abs_diff(places[k]) > 2 * width) {
            found.push(places[k]);
        }
    }
    found.sort_unstable();
    found.into_iter().map(|k| kept[k]).collect()
}

fn magnitudes(values: &[f64]) -> Vec<f64> {
    values.iter().map(|x| x.abs()).collect()
}

/// Median; zero of nothing.
fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() {
        return 0.0;
    }
    let even = values.len().is_multiple_of(2);
    let (below, &mut upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    if even { 0.5 * (upper + below.iter().copied().fold(f64::NEG_INFINITY, f64::max)) } else { upper }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Case;

    #[test]
    fn what_stands_alone_is_found_and_nothing_else() {
        let trial = Case { noise_deg: 0.1, ..Case::default() }.trial();
        let track = Track::unchecked(&trial);
        // Noise alone, as a good fit leaves it.
        let truth = Case::default().truth();
        let noise: Vec<f64> = track.heading.iter().zip(&truth.heading).map(|(psi, truth)| psi - truth).collect();
        assert_eq!(find(&track, &noise), Suspects::default());
        let mut spoilt = noise.clone();
        for (row, by) in [(0, 1.0), (60, -0.05), (100, 4.9), (101, 4.9), (102, 4.9), (270, 0.03)] {
            spoilt[row] += by;
        }
        assert_eq!(find(&track, &spoilt).spikes, [0, 60, 100, 101, 102, 270]);
        assert_eq!(find(&track, &spoilt).jumps, []);
        let jumped: Vec<f64> =
            noise.iter().enumerate().map(|(row, x)| x + if row >= 130 { 0.07 } else { 0.0 }).collect();
        assert_eq!(find(&track, &jumped), Suspects { spikes: vec![], jumps: vec![130] });
    }

    #[test]
    fn medians_are_those_of_the_textbook() {
        assert_eq!(median(&mut []), 0.0);
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 3.0, 2.0]), 2.5);
    }
}
