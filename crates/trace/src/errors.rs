//! How far a response is from a record: the recorded rudder replayed from the fitted initial state over all of it, and
//! replays restarted every 20 and 60 s. Only initial states are fitted here, never a parameter.

use std::collections::BTreeMap;

use nalgebra::{Matrix2, Vector2};
use ship::Response;
use ship::dynamics::Dynamics;
use ship::replay::{Recorded, replay};
use trial::{Channel, Columns, Trial, ZigZag};

use crate::fit::dot;
use crate::record::Record;
use crate::structure::step;

/// Lengths of the windows after which a replay is restarted, s.
pub const HORIZONS: [f64; 2] = [20.0, 60.0];

/// Fewest headings in a window: two are used up by its initial state.
const FEWEST: usize = 4;

/// Steps of the search for an initial state.
const STEPS: usize = 12;

/// A replay of all rows of a record.
#[derive(Debug, Clone, PartialEq)]
pub struct Replayed {
    /// Time, s.
    pub time: Vec<f64>,
    /// Heading, rad.
    pub heading: Vec<f64>,
    /// Yaw rate, rad/s.
    pub yaw_rate: Vec<f64>,
    /// Measured less replayed heading, rad; NaN where there is none.
    pub residual: Vec<f64>,
    /// Heading (rad) and yaw rate (rad/s) at the first row.
    pub initial: [f64; 2],
}

/// Errors of a response on one record.
#[derive(Debug, Clone, PartialEq)]
pub struct Errors {
    /// Root mean square heading error of the full replay, rad.
    pub heading: f64,
    /// Headings compared.
    pub rows: usize,
    /// Root mean square yaw-rate error of the full replay, rad/s, where the record has a yaw rate.
    pub yaw_rate: Option<f64>,
    /// Mean absolute error of the overshoot angles, rad, where both are a zig-zag.
    pub overshoot: Option<f64>,
    /// Root mean square heading error of replays restarted every so many seconds, rad; `None` when the windows hold too
    /// few headings.
    pub horizon: [Option<f64>; HORIZONS.len()],
}

/// Replays a record whole from the best initial state near one of the `starts`. `None` when no replay is finite.
pub fn full(response: &Response, record: &Record, starts: &[[f64; 2]]) -> Option<Replayed> {
    let rows = 0..record.time.len();
    let (_, start) = starts
        .iter()
        .filter_map(|&start| {
            settle(response, record, rows.clone(), start, None).map(|(square, initial, _)| (square, initial))
        })
        .min_by(|one, other| one.0.total_cmp(&other.0))?;
    let mut state = vec![0.0; response.dimension()];
    enter(response, record, 0, start, None, &mut state);
    let count = record.time.len();
    let mut replayed = Replayed {
        time: record.time.clone(),
        heading: vec![0.0; count],
        yaw_rate: vec![0.0; count],
        residual: vec![0.0; count],
        initial: start,
    };
    run(response, &record.recorded(response), &record.time, record.spacing, &mut state, |row, heading, rate| {
        replayed.heading[row] = heading;
        replayed.yaw_rate[row] = rate;
        replayed.residual[row] = record.heading[row] - heading;
    });
    replayed.heading.iter().all(|psi| psi.is_finite()).then_some(replayed)
}

/// The heading error of a full replay alone.
pub fn in_brief(replayed: &Replayed) -> Errors {
    let residual: Vec<f64> = replayed.residual.iter().copied().filter(|e| e.is_finite()).collect();
    Errors {
        heading: root_mean_square(&residual).unwrap_or(f64::NAN),
        rows: residual.len(),
        yaw_rate: None,
        overshoot: None,
        horizon: [None; HORIZONS.len()],
    }
}

/// Errors of a full replay, with the restarted ones.
pub fn errors(trial: &Trial, record: &Record, response: &Response, replayed: &Replayed) -> Errors {
    let first = trial.observed_rows().next().unwrap_or(0);
    let yaw_rate = trial.yaw_rate().and_then(|measured| {
        let differences: Vec<f64> = measured[first..]
            .iter()
            .zip(&replayed.yaw_rate)
            .map(|(measured, replayed)| measured - replayed)
            .filter(|d| d.is_finite())
            .collect();
        root_mean_square(&differences)
    });
    Errors {
        yaw_rate,
        overshoot: overshoot_error(trial, replayed),
        horizon: HORIZONS.map(|length| restarted(response, record, replayed.initial, length)),
        ..in_brief(replayed)
    }
}

fn root_mean_square(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt())
}

/// The zig-zag of a replayed heading under the rudder of its record.
pub fn replayed_zigzag(trial: &Trial, replayed: &Replayed) -> Option<ZigZag> {
    let first = trial.observed_rows().next().unwrap_or(0);
    let range = first..first + replayed.time.len();
    let channels: BTreeMap<Channel, Vec<f64>> =
        [(Channel::Heading, replayed.heading.clone()), (Channel::Rudder, trial.rudder()[range].to_vec())].into();
    let columns = Columns { time: replayed.time.clone(), channels, unknown: Vec::new() };
    let twin = Trial::new(trial.name(), trial.origin().clone(), columns).ok()?;
    ZigZag::of(&twin).ok()
}

fn overshoot_error(trial: &Trial, replayed: &Replayed) -> Option<f64> {
    let (measured, twin) = (ZigZag::of(trial).ok()?, replayed_zigzag(trial, replayed)?);
    let pairs: Vec<f64> = measured
        .overshoots
        .iter()
        .zip(&twin.overshoots)
        .map(|(one, other)| (one.angle.value - other.angle.value).abs())
        .filter(|d| d.is_finite())
        .collect();
    (!pairs.is_empty()).then(|| pairs.iter().sum::<f64>() / pairs.len() as f64)
}

/// Error of a replay that is restarted every `length` seconds from the best heading and yaw rate of the window; the memory
/// of the effects goes on.
fn restarted(response: &Response, record: &Record, initial: [f64; 2], length: f64) -> Option<f64> {
    let count = record.time.len();
    let mut state = vec![0.0; response.dimension()];
    enter(response, record, 0, initial, None, &mut state);
    let (mut square, mut rows) = (0.0, 0usize);
    let mut from = 0;
    while from < count {
        let end = record.time[from] + length;
        // A last piece that is no whole window belongs to the one before.
        let mut to = record.time.partition_point(|&t| t < end);
        if record.time[count - 1] < end + 0.5 * length {
            to = count;
        }
        // The window ends where the next one begins.
        let until = (to + 1).min(count);
        let seen = (from..to).filter(|&row| record.heading[row].is_finite()).count();
        if seen < FEWEST {
            return None;
        }
        let memory = state.clone();
        let start = [state[0], state[1]];
        let (found, best, _) = settle(response, record, from..to, start, Some(&memory))?;
        square += found;
        rows += seen;
        enter(response, record, from, best, Some(&memory), &mut state);
        let times = &record.time[from..until];
        run(response, &record.recorded(response), times, record.spacing, &mut state, |_, _, _| {});
        if to == count {
            break;
        }
        from = to;
    }
    Some((square / rows as f64).sqrt())
}

fn enter(response: &Response, record: &Record, row: usize, start: [f64; 2], memory: Option<&[f64]>, state: &mut [f64]) {
    match memory {
        Some(memory) => {
            state.copy_from_slice(memory);
            response.restart(start[0], start[1], state);
        }
        None => {
            let input = record.recorded(response).input(record.time[row], response.dead_time(), row);
            response.enter(start[0], start[1], &input, state);
        }
    }
}

fn run(
    response: &Response,
    recorded: &Recorded,
    times: &[f64],
    spacing: f64,
    state: &mut [f64],
    mut visit: impl FnMut(usize, f64, f64),
) {
    replay(response, recorded, times, step(response, spacing), state, |row, motion| {
        visit(row, motion.heading, motion.yaw_rate);
    });
}

/// Heading and yaw rate at the first of some rows that bring the replay nearest to them (Gauss–Newton with halving):
/// sum of squares, the initial state, and the number of headings.
fn settle(
    response: &Response,
    record: &Record,
    rows: std::ops::Range<usize>,
    start: [f64; 2],
    memory: Option<&[f64]>,
) -> Option<(f64, [f64; 2], usize)> {
    let seats: Vec<usize> = rows.clone().filter(|&row| record.heading[row].is_finite()).collect();
    let times = &record.time[rows.clone()];
    let span = (times[times.len() - 1] - times[0]).max(record.spacing);
    let mut state = vec![0.0; response.dimension()];
    let mut residual = |initial: [f64; 2]| -> Vec<f64> {
        enter(response, record, rows.start, initial, memory, &mut state);
        let mut all = vec![0.0; times.len()];
        run(response, &record.recorded(response), times, record.spacing, &mut state, |row, heading, _| {
            all[row] = heading
        });
        seats.iter().map(|&row| record.heading[row] - all[row - rows.start]).collect()
    };
    let size = [1e-6, 1e-6 / span];
    let mut initial = start;
    let mut now = residual(initial);
    let mut square: f64 = now.iter().map(|e| e * e).sum();
    for _ in 0..STEPS {
        let column = |residual: &mut dyn FnMut([f64; 2]) -> Vec<f64>, k: usize| -> Vec<f64> {
            let mut moved = initial;
            moved[k] += size[k];
            residual(moved)
                .iter()
                .zip(&now)
                .map(|(moved, now)| (now - moved) / size[k] * [1.0, 1.0 / span][k])
                .collect()
        };
        let (one, two) = (column(&mut residual, 0), column(&mut residual, 1));
        let cross = dot(&one, &two);
        let matrix = Matrix2::new(dot(&one, &one), cross, cross, dot(&two, &two) + 1e-12 * seats.len() as f64);
        let gradient = Vector2::new(dot(&one, &now), dot(&two, &now));
        let Some(direction) = matrix.lu().solve(&gradient) else { break };
        let mut share = 1.0;
        let mut better = None;
        for _ in 0..10 {
            let next = [initial[0] + share * direction[0], initial[1] + share * direction[1] / span];
            let trial = residual(next);
            let lower: f64 = trial.iter().map(|e| e * e).sum();
            if lower < square {
                better = Some((next, trial, lower));
                break;
            }
            share *= 0.4;
        }
        let Some((next, trial, lower)) = better else { break };
        let gain = square - lower;
        (initial, now, square) = (next, trial, lower);
        if gain < 1e-7 * square {
            break;
        }
    }
    square.is_finite().then_some((square, initial, seats.len()))
}
