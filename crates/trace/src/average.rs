//! Model average: the weighted mean of the replays of several models, or their weighted median if one diverges.
//!
//! Source: Hoeting, Madigan, Raftery and Volinsky (1999), Bayesian model averaging: a tutorial.

use identify::hull::HullEstimate;
use identify::replay::Replay;
use ship::ReplayedShip;

use crate::fit::StructureFit;
use crate::noise_law::NoiseLaw;
use crate::record::PreparedRecord;
use crate::replay_errors::{ReplayDepth, WindowError, full_replay, restarted_headings, root_mean_square};

/// Maximum ratio of the error of a replay to the median error of all members; above it the replay counts as diverged.
const MAX_ERROR_RATIO: f64 = 3.0;

/// Model average: ships with the weights of their replays.
#[derive(Debug)]
pub struct ModelAverage {
    /// Weight and ship of every member; a mean is divided by the sum of the weights.
    pub members: Vec<(f64, Box<dyn ReplayedShip>)>,
}

/// Members of a model average, with the noise law of the records.
pub struct FittedAverage<'a> {
    /// Structures with their posterior weights.
    pub members: &'a [(f64, &'a StructureFit)],
    /// Hulls; each has the same weight as all structures together.
    pub hulls: &'a [HullEstimate],
    /// Noise law of the records.
    pub noise_law: &'a NoiseLaw,
    /// Index of the replayed record among the fitted records; `None` for a record that was not fitted.
    pub fitted_record: Option<usize>,
    /// Ship time L/U, s.
    pub ship_length_time: f64,
}

/// Replay of a model average on one record.
#[derive(Debug, Clone)]
pub struct AverageReplay {
    /// Full replay averaged over the members.
    pub replay: Replay,
    /// Full replay of every member.
    pub member_replays: Vec<Replay>,
    /// Errors of the restarted replays, by duration of the windows.
    pub windows: Vec<WindowError>,
}

impl AverageReplay {
    /// `true` if the replay of a member diverges.
    pub fn is_divergent(&self) -> bool {
        is_divergent(&self.member_replays.iter().map(Replay::rms).collect::<Vec<f64>>())
    }
}

impl FittedAverage<'_> {
    /// Weight of every hull in the average; all structures together have the same weight.
    pub fn hull_weight(&self) -> f64 {
        1.0 / (1 + self.hulls.len()) as f64
    }

    /// Weights of the ships, structures first; their sum is 1.
    pub fn weights(&self) -> impl Iterator<Item = f64> {
        let share = self.hull_weight();
        self.members.iter().map(move |(weight, _)| share * weight).chain(self.hulls.iter().map(move |_| share))
    }

    /// Model average for replays: ship and weight of every structure, then of every hull.
    pub fn average(&self) -> ModelAverage {
        let structure = |(_, fit): &(f64, &StructureFit)| -> Box<dyn ReplayedShip> {
            Box::new(fit.structure.response(self.fitted_record, &fit.theta))
        };
        let hull = |hull: &HullEstimate| -> Box<dyn ReplayedShip> { Box::new(hull.scaled_hull::<f64>()) };
        let ships = self.members.iter().map(structure).chain(self.hulls.iter().map(hull));
        ModelAverage { members: self.weights().zip(ships).collect() }
    }
}

impl ModelAverage {
    /// Average of the replays of all members, each from its best initial state near one of the `starts` (rad, rad/s),
    /// with the errors of the replays restarted in the windows of `depth`. A member without a finite replay is left
    /// out; `None` if no member has one.
    pub fn replay(&self, record: &PreparedRecord, starts: &[[f64; 2]], depth: ReplayDepth) -> Option<AverageReplay> {
        let replays: Vec<(f64, &dyn ReplayedShip, Replay)> = self
            .members
            .iter()
            .filter_map(|(weight, ship)| Some((*weight, ship.as_ref(), full_replay(ship.as_ref(), record, starts)?)))
            .collect();
        let weights: Vec<f64> = replays.iter().map(|(weight, ..)| *weight).collect();
        let errors: Vec<f64> = replays.iter().map(|(.., replay)| replay.rms()).collect();
        let combine = combination(&weights, &errors)?;
        let combined = |signal: fn(&Replay) -> &[f64]| {
            let columns: Vec<&[f64]> = replays.iter().map(|(.., replay)| signal(replay)).collect();
            combine(&columns)
        };
        let [heading, yaw_rate] = [combined(|replay| &replay.heading), combined(|replay| &replay.yaw_rate)];
        let residual = record.heading.iter().zip(&heading).map(|(measured, replayed)| measured - replayed).collect();
        let within = |duration: f64| {
            let all: Option<Vec<Vec<f64>>> = replays
                .iter()
                .map(|(_, ship, replay)| restarted_headings(*ship, record, replay.initial_state(), duration))
                .collect();
            let all = all?;
            let columns: Vec<&[f64]> = all.iter().map(Vec::as_slice).collect();
            let residual = record.heading.iter().zip(combine(&columns)).map(|(measured, mean)| measured - mean);
            root_mean_square(&residual.filter(|residual| residual.is_finite()).collect::<Vec<f64>>())
        };
        let durations = depth.window_durations(&record.time).into_iter();
        let windows = durations.map(|duration| WindowError { duration, heading_rmse: within(duration) }).collect();
        let replay = Replay { time: record.time.clone(), heading, yaw_rate, residual };
        Some(AverageReplay {
            replay,
            member_replays: replays.into_iter().map(|(.., replay)| replay).collect(),
            windows,
        })
    }
}

/// `true` if the maximum error exceeds [`MAX_ERROR_RATIO`] times the median error.
fn is_divergent(errors: &[f64]) -> bool {
    let mut sorted = errors.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() - 1] > MAX_ERROR_RATIO * sorted[sorted.len() / 2]
}

/// Function that combines columns row by row: their weighted mean, or their weighted median if a member diverges by its
/// error; `None` without members.
fn combination<'a>(weights: &'a [f64], errors: &[f64]) -> Option<impl Fn(&[&[f64]]) -> Vec<f64> + use<'a>> {
    if weights.is_empty() {
        return None;
    }
    let is_divergent = is_divergent(errors);
    let total: f64 = weights.iter().sum();
    Some(move |columns: &[&[f64]]| {
        let rows = columns[0].len();
        (0..rows)
            .map(|row| match is_divergent {
                true => median(weights, columns, row, total),
                false => weights.iter().zip(columns).map(|(weight, column)| weight * column[row]).sum::<f64>() / total,
            })
            .collect()
    })
}

/// Weighted median of one row; `total` is the sum of the weights.
fn median(weights: &[f64], columns: &[&[f64]], row: usize, total: f64) -> f64 {
    let mut values: Vec<(f64, f64)> = columns.iter().zip(weights).map(|(draw, weight)| (draw[row], *weight)).collect();
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut sum = 0.0;
    let middle = values.iter().find(|(_, weight)| {
        sum += weight;
        sum >= 0.5 * total
    });
    middle.map_or(f64::NAN, |(value, _)| *value)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Weights 0.5, 0.3 and 0.2: the weighted mean, and the weighted median at half the sum of weights, in any order of
    /// the members.
    #[test]
    fn where_a_member_diverges_a_row_is_the_weighted_median() {
        let columns: [&[f64]; 3] = [&[1.0, 4.0], &[2.0, 2.0], &[90.0, 3.0]];
        let combined = |errors: &[f64]| combination(&[0.5, 0.3, 0.2], errors).expect("members")(&columns);
        let near = |values: Vec<f64>, expected: [f64; 2]| {
            assert!(
                values.iter().zip(expected).all(|(value, expected)| (value - expected).abs() < 1e-12),
                "{values:?}"
            );
        };
        near(combined(&[1.0, 1.0, 2.9]), [19.1, 3.2]);
        near(combined(&[1.0, 1.0, 3.1]), [1.0, 3.0]);
        let skewed = combination(&[0.2, 0.2, 0.6], &[1.0, 1.0, 3.1]).expect("members");
        near(skewed(&columns), [90.0, 3.0]);
        assert!(combination(&[], &[]).is_none());
    }
}
