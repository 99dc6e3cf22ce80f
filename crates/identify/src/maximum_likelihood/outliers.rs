//! Readings of the compass that belong to no ship: single spikes, sentinels such as −999, and jumps after which the
//! compass is off by a constant.
//!
//! What a fit leaves of the heading moves no faster than the noise. A reading far from its neighbours there is a spike;
//! a level that changes from one reading to the next and stays is a jump. Both are looked for again in the fit without
//! them until nothing changes, so an honest reading that stood beside a spike comes back.

use estimation::column::extremes;
use estimation::statistics::median;

use crate::likelihood::track::Track;

/// Neighbours on either side that a reading is held against: runs of up to three spikes are told from them.
const NEIGHBOURS: usize = 7;

/// Fewest neighbours that make a side.
const FEWEST: usize = 3;

/// Readings on either side of a jump.
const LEVEL: usize = 4;

/// Distance from the neighbours, in robust standard deviations, beyond which a reading is left out: one of 10⁸ normal
/// ones.
const SPIKE: f64 = 6.0;

/// The same for a change of level.
const JUMP: f64 = 8.0;

/// Share of the range of the heading below which neither is looked for: corners of the rudder between rows leave as
/// much.
const SMALLEST: f64 = 2e-3;

/// Share of the grossest new spike that another one has to have to be taken with it.
const GROSS: f64 = 0.3;

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
///
/// A fit that spikes have spoilt leaves more than they: beside those that were `known` when it was made, only the
/// grossest are taken at a time.
pub(super) fn find(whole: &Track, residual: &[f64], known: &[usize]) -> Suspects {
    let (lowest, highest) = extremes(&whole.heading);
    // The range itself may be that of a sentinel.
    let floor = SMALLEST * (highest - lowest).min(std::f64::consts::PI);
    let rows = &whole.observed;
    let mut kept: Vec<usize> = (0..residual.len()).collect();
    let most = (LARGEST_SHARE * residual.len() as f64).ceil() as usize + 1;
    let mut sides = deviations(residual, &kept);
    let one_sided: Vec<f64> = sides.iter().filter_map(|[before, _]| before.map(|side| side.distance)).collect();
    let limit = (SPIKE * NORMAL * middle(&mut magnitudes(&one_sided))).max(floor);
    let mut spikes = Vec::new();
    let mut grossest = 0.0_f64;
    while spikes.len() < most {
        let distances = sides.iter().copied().map(apart).enumerate();
        let far = distances.filter(|(_, distance)| *distance > limit);
        let Some((place, distance)) = far.max_by(|one, other| one.1.total_cmp(&other.1)) else { break };
        let row = rows[kept[place]];
        if !known.contains(&row) {
            if distance < GROSS * grossest {
                break;
            }
            grossest = grossest.max(distance);
        }
        kept.remove(place);
        sides = deviations(residual, &kept);
        spikes.push(row);
    }
    spikes.sort_unstable();
    Suspects { jumps: jumps(residual, &kept, floor).into_iter().map(|number| rows[number]).collect(), spikes }
}

/// A reading held against its neighbours on one side, rad.
#[derive(Debug, Clone, Copy)]
struct Neighbours {
    /// The reading less their median.
    distance: f64,
    /// Median of their distances from their median.
    spread: f64,
}

/// How far a reading stands from both sides, rad: where the level changes it is near to one of them, on a slope it is
/// between them. At an end of the record there is one side, and a slope is told by the spread of the neighbours.
fn apart(sides: [Option<Neighbours>; 2]) -> f64 {
    match sides {
        [Some(before), Some(after)] if before.distance * after.distance > 0.0 => {
            before.distance.abs().min(after.distance.abs())
        }
        [Some(side), None] | [None, Some(side)] if side.distance.abs() > SPIKE * side.spread => side.distance.abs(),
        _ => 0.0,
    }
}

/// Every reading held against its neighbours before and after.
fn deviations(residual: &[f64], kept: &[usize]) -> Vec<[Option<Neighbours>; 2]> {
    let against = |k: usize, side: std::ops::Range<usize>| {
        let mut around: Vec<f64> = side.map(|other| residual[kept[other]]).collect();
        (around.len() >= FEWEST).then(|| {
            let level = middle(&mut around);
            around.iter_mut().for_each(|value| *value = (*value - level).abs());
            Neighbours { distance: residual[kept[k]] - level, spread: middle(&mut around) }
        })
    };
    (0..kept.len())
        .map(|k| {
            [k.saturating_sub(NEIGHBOURS)..k, k + 1..(k + 1 + NEIGHBOURS).min(kept.len())].map(|side| against(k, side))
        })
        .collect()
}

/// Readings from which on the level is another one.
fn jumps(residual: &[f64], kept: &[usize], floor: f64) -> Vec<usize> {
    let level = |range: std::ops::Range<usize>| middle(&mut range.map(|k| residual[kept[k]]).collect::<Vec<f64>>());
    if kept.len() < 4 * LEVEL {
        return Vec::new();
    }
    let places: Vec<usize> = (LEVEL..=kept.len() - LEVEL).collect();
    let changes: Vec<f64> = places.iter().map(|&k| level(k..k + LEVEL) - level(k - LEVEL..k)).collect();
    let limit = (JUMP * NORMAL * middle(&mut magnitudes(&changes))).max(floor);
    let mut found: Vec<usize> = Vec::new();
    let mut order: Vec<usize> = (0..changes.len()).filter(|&k| changes[k].abs() > limit).collect();
    // The steepest of a neighbourhood is where it happened.
    let steep = |k: usize| (residual[kept[places[k]]] - residual[kept[places[k] - 1]]) * changes[k].signum();
    order.sort_by(|&one, &other| (changes[other].abs() + steep(other)).total_cmp(&(changes[one].abs() + steep(one))));
    for k in order {
        if found.iter().all(|&other| other.abs_diff(places[k]) > 2 * LEVEL) {
            found.push(places[k]);
        }
    }
    found.sort_unstable();
    found.into_iter().map(|k| kept[k]).collect()
}

/// Median; zero of nothing.
fn middle(values: &mut [f64]) -> f64 {
    median(values).unwrap_or(0.0)
}

fn magnitudes(values: &[f64]) -> Vec<f64> {
    values.iter().map(|x| x.abs()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Case;

    #[test]
    fn what_stands_alone_is_found_and_nothing_else() {
        let trial = Case { noise_deg: 0.1, ..Case::default() }.trial();
        let track = Track::new(&trial);
        // Noise alone, as a good fit leaves it.
        let truth = Case::default().truth();
        let noise: Vec<f64> = track.heading.iter().zip(&truth.heading).map(|(psi, truth)| psi - truth).collect();
        assert_eq!(find(&track, &noise, &[]), Suspects::default());
        let mut spoilt = noise.clone();
        for (row, by) in [(0, 1.0), (60, -0.05), (100, 4.9), (101, 4.9), (102, 4.9), (270, 0.03)] {
            spoilt[row] += by;
        }
        assert_eq!(find(&track, &spoilt, &[0, 60, 270]).spikes, [0, 60, 100, 101, 102, 270]);
        assert_eq!(find(&track, &spoilt, &[0, 60, 270]).jumps, [0usize; 0]);
        let jumped: Vec<f64> =
            noise.iter().enumerate().map(|(row, x)| x + if row >= 130 { 0.07 } else { 0.0 }).collect();
        assert_eq!(find(&track, &jumped, &[]), Suspects { spikes: vec![], jumps: vec![130] });
    }

    /// A smooth misfit without noise has no outliers, however it begins.
    #[test]
    fn a_slope_is_no_run_of_spikes() {
        let track = Track::new(&Case::default().trial());
        let smooth: Vec<f64> = (0..track.heading.len())
            .map(|k| 0.05 * (-(k as f64) / 6.0).exp() + 0.01 * (k as f64 / 40.0).sin())
            .collect();
        assert_eq!(find(&track, &smooth, &[]).spikes, [0usize; 0]);
    }
}
