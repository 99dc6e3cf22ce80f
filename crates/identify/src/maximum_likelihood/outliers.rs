//! Outliers of the compass: single spikes, sentinels such as −999, and jumps after which the compass is off by a
//! constant.
//!
//! The residual of a fit changes no faster than the noise. A reading far from its neighbours is a spike; a level that
//! changes from one reading to the next and stays is a jump. The search is repeated on the fit without the outliers
//! until they no longer change, so that a good reading next to a spike is restored. Source of the robust scale: the
//! median absolute deviation, Hampel (1974), The influence curve and its role in robust estimation, Journal of the
//! American Statistical Association 69, 383–393.

use estimation::column::extremes;
use estimation::statistics::median;

use crate::likelihood::track::TrialSignals;

/// Number of neighbours on either side for the comparison of a reading: enough to detect runs of up to three spikes.
const NEIGHBOURS: usize = 7;

/// Minimum number of neighbours on a side.
const MIN_NEIGHBOURS: usize = 3;

/// Number of readings on either side of a jump.
const SIDE: usize = 4;

/// Maximum distance from the neighbours, in robust standard deviations (SDs), of a kept reading: exceeded by about one
/// in 10⁸ normal readings.
const SPIKE_SDS: f64 = 6.0;

/// Minimum change of level of a jump, in robust standard deviations.
const JUMP_SDS: f64 = 8.0;

/// Minimum outlier, as a share of the heading range: corners of the rudder between rows leave smaller residuals.
const MIN_OUTLIER_SHARE: f64 = 2e-3;

/// Minimum spike, relative to the largest new spike, that is removed in the same round.
const MIN_GROSS_SHARE: f64 = 0.3;

/// Maximum share of outliers: a larger share is noise of another law.
pub(super) const MAX_OUTLIER_SHARE: f64 = 0.1;

/// Ratio of the standard deviation of normal numbers to the median of their magnitudes.
const NORMAL: f64 = 1.4826;

/// Rows suspected as outliers.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Suspects {
    /// Rows of spikes, increasing.
    pub spike_rows: Vec<usize>,
    /// First rows after jumps, increasing.
    pub jump_rows: Vec<usize>,
}

/// Finds spikes and jumps in the heading residual of a fit (rad, a value for every heading of the whole record).
///
/// Spikes spoil the fit and so enlarge other residuals: in addition to the spikes `excluded` from the fit only the
/// largest are selected in a round.
pub(super) fn find_suspects(whole: &TrialSignals, residual: &[f64], excluded: &[usize]) -> Suspects {
    let (lowest, highest) = extremes(&whole.heading);
    // The range may include a sentinel.
    let floor = MIN_OUTLIER_SHARE * (highest - lowest).min(std::f64::consts::PI);
    let rows = &whole.heading_rows;
    let mut kept: Vec<usize> = (0..residual.len()).collect();
    let max_spikes = (MAX_OUTLIER_SHARE * residual.len() as f64).ceil() as usize + 1;
    let mut sides = deviations(residual, &kept);
    let from_one_side: Vec<f64> = sides.iter().filter_map(|[before, _]| before.map(|side| side.distance)).collect();
    let limit = (SPIKE_SDS * NORMAL * middle(&mut magnitudes(&from_one_side))).max(floor);
    let mut spikes = Vec::new();
    let mut grossest = 0.0_f64;
    while spikes.len() < max_spikes {
        let distances = sides.iter().copied().map(isolation).enumerate();
        let far = distances.filter(|(_, distance)| *distance > limit);
        let Some((place, distance)) = far.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        let row = rows[kept[place]];
        if !excluded.contains(&row) {
            if distance < MIN_GROSS_SHARE * grossest {
                break;
            }
            grossest = grossest.max(distance);
        }
        kept.remove(place);
        sides = deviations(residual, &kept);
        spikes.push(row);
    }
    spikes.sort_unstable();
    Suspects {
        jump_rows: jumps(residual, &kept, floor).into_iter().map(|number| rows[number]).collect(),
        spike_rows: spikes,
    }
}

/// Comparison of a reading with its neighbours on one side, rad.
#[derive(Debug, Clone, Copy)]
struct Neighbours {
    /// Reading minus the median of the neighbours, rad.
    distance: f64,
    /// Median distance of the neighbours from their median, rad; 0 for a reading with neighbours on both sides.
    spread: f64,
}

/// Distance of a reading from both sides, rad: at a change of level it is near one side, on a slope it lies between
/// both sides. At an end of the record there is a single side, and the spread of the neighbours shows a slope.
fn isolation(sides: [Option<Neighbours>; 2]) -> f64 {
    match sides {
        [Some(before), Some(after)] if before.distance * after.distance > 0.0 => {
            before.distance.abs().min(after.distance.abs())
        }
        [Some(side), None] | [None, Some(side)] if side.distance.abs() > SPIKE_SDS * side.spread => side.distance.abs(),
        _ => 0.0,
    }
}

/// Distance of every kept reading from the median of its neighbours: of those before, and of those after.
fn deviations(residual: &[f64], kept: &[usize]) -> Vec<[Option<Neighbours>; 2]> {
    let values: Vec<f64> = kept.iter().map(|&place| residual[place]).collect();
    let rows = values.len();
    let level = |side: &[f64]| -> Option<f64> {
        let mut neighbours = [0.0; NEIGHBOURS];
        let around = &mut neighbours[..side.len()];
        around.copy_from_slice(side);
        (side.len() >= MIN_NEIGHBOURS).then(|| middle(around))
    };
    // The neighbours after a reading are those before a later reading; the last rows have fewer after them.
    let before: Vec<Option<f64>> = (0..=rows).map(|k| level(&values[k.saturating_sub(NEIGHBOURS)..k])).collect();
    let after = |k: usize| match k + 1 + NEIGHBOURS {
        end if end <= rows => before[end],
        _ => level(&values[k + 1..]),
    };
    let spread = |side: &[f64], level: f64| {
        let mut distances: Vec<f64> = side.iter().map(|value| (value - level).abs()).collect();
        middle(&mut distances)
    };
    let sides = |k: usize| {
        let (left, right) = (before[k], after(k));
        // Only the single side of a reading at an end is asked for its spread.
        let alone = left.is_none() || right.is_none();
        let ranges = [k.saturating_sub(NEIGHBOURS)..k, k + 1..(k + 1 + NEIGHBOURS).min(rows)];
        let [left, right] = [(left, &ranges[0]), (right, &ranges[1])].map(|(level, range)| {
            level.map(|level| Neighbours {
                distance: values[k] - level,
                spread: if alone { spread(&values[range.clone()], level) } else { 0.0 },
            })
        });
        [left, right]
    };
    (0..rows).map(sides).collect()
}

/// Indices of the first reading after each change of level, ascending; `floor` is the least limit of a change.
fn jumps(residual: &[f64], kept: &[usize], floor: f64) -> Vec<usize> {
    if kept.len() < 4 * SIDE {
        return Vec::new();
    }
    // Median of every run of readings, by its first reading.
    let runs = (0..=kept.len() - SIDE).map(|k| std::array::from_fn::<f64, SIDE, _>(|side| residual[kept[k + side]]));
    let levels: Vec<f64> = runs.map(|mut run| middle(&mut run)).collect();
    let places: Vec<usize> = (SIDE..levels.len()).collect();
    let changes: Vec<f64> = places.iter().map(|&k| levels[k] - levels[k - SIDE]).collect();
    let limit = (JUMP_SDS * NORMAL * middle(&mut magnitudes(&changes))).max(floor);
    let mut accepted: Vec<usize> = Vec::new();
    let mut order: Vec<usize> = (0..changes.len()).filter(|&k| changes[k].abs() > limit).collect();
    // The jump is at the steepest reading of a neighbourhood.
    let steep = |k: usize| (residual[kept[places[k]]] - residual[kept[places[k] - 1]]) * changes[k].signum();
    order.sort_by(|&a, &b| (changes[b].abs() + steep(b)).total_cmp(&(changes[a].abs() + steep(a))));
    for k in order {
        if accepted.iter().all(|&jump| jump.abs_diff(places[k]) > 2 * SIDE) {
            accepted.push(places[k]);
        }
    }
    accepted.sort_unstable();
    accepted.into_iter().map(|k| kept[k]).collect()
}

/// Median; zero without values.
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
    fn isolated_readings_are_found_and_no_others() {
        let trial = Case { noise_deg: 0.1, ..Case::default() }.trial();
        let signals = TrialSignals::new(&trial);
        // Noise alone, as in the residual of a good fit.
        let truth = Case::default().truth();
        let noise: Vec<f64> = signals.heading.iter().zip(&truth.heading).map(|(psi, truth)| psi - truth).collect();
        assert_eq!(find_suspects(&signals, &noise, &[]), Suspects::default());
        let mut spoilt = noise.clone();
        for (row, by) in [(0, 1.0), (60, -0.05), (100, 4.9), (101, 4.9), (102, 4.9), (270, 0.03)] {
            spoilt[row] += by;
        }
        assert_eq!(find_suspects(&signals, &spoilt, &[0, 60, 270]).spike_rows, [0, 60, 100, 101, 102, 270]);
        assert_eq!(find_suspects(&signals, &spoilt, &[0, 60, 270]).jump_rows, [0usize; 0]);
        let jumped: Vec<f64> =
            noise.iter().enumerate().map(|(row, x)| x + if row >= 130 { 0.07 } else { 0.0 }).collect();
        assert_eq!(find_suspects(&signals, &jumped, &[]), Suspects { spike_rows: vec![], jump_rows: vec![130] });
    }

    /// A smooth misfit without noise has no outliers, whatever its beginning.
    #[test]
    fn a_slope_is_not_a_run_of_spikes() {
        let signals = TrialSignals::new(&Case::default().trial());
        let smooth: Vec<f64> = (0..signals.heading.len())
            .map(|k| 0.05 * (-(k as f64) / 6.0).exp() + 0.01 * (k as f64 / 40.0).sin())
            .collect();
        assert_eq!(find_suspects(&signals, &smooth, &[]).spike_rows, [0usize; 0]);
    }
}
