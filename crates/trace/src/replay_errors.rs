//! Replay errors of a response on a record: the recorded rudder replayed from the fitted initial state over the whole
//! record, and replays restarted at fixed intervals. Only initial states are fitted here, never a parameter.

use std::collections::BTreeMap;
use std::ops::Range;

use estimation::column::dot;
use identify::replay::Replay;
use nalgebra::{Matrix2, Vector2};
use ship::replay::replay_states;
use ship::{Real, Replayable, ReplayedShip, Tangent};
use trial::zigzag::Overshoot;
use trial::{Channel, Columns, Trial, ZigZag};

use crate::model::solver_step;
use crate::record::PreparedRecord;

/// Solver steps per minimum time constant: the heading is then exact to 10⁻⁵ of the response.
const SOLVER_STEPS: f64 = 4.0;

/// Window durations of the restarted replays on every record, s.
pub const HORIZONS_S: [f64; 2] = [20.0, 60.0];

/// Minimum window of [`ReplayDepth::Growth`], s; every further window is twice as long.
const MIN_WINDOW_S: f64 = 5.0;

/// Minimum last piece, as a share of a window; a shorter piece is joined to the window before.
const MIN_LAST_PIECE: f64 = 0.5;

/// Minimum number of headings in a window: two are used up by its initial state.
const MIN_HEADINGS: usize = 4;

/// Maximum number of Gauss–Newton steps for an initial state.
const MAX_STEPS: usize = 12;

/// Maximum number of step lengths tried in a Gauss–Newton step.
const MAX_STEP_LENGTHS: i32 = 10;

/// Tolerance of equal initial states: of the heading, and of the yaw rate times the duration, rad.
const STATE_TOLERANCE: f64 = 1e-6;

/// Minimum predicted relative decrease of the sum of squares; below it the search ends.
const MIN_DECREASE: f64 = 1e-7;

/// Root mean square heading errors with a fitted moment of the record, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MomentErrors {
    /// Error with a rudder bias, rad.
    pub with_bias: f64,
    /// Error with a piecewise linear moment of five knots, rad.
    pub with_slow_moment: f64,
}

/// Error of replays restarted after every window of one duration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WindowError {
    /// Duration of the windows, s.
    pub duration: f64,
    /// Root mean square heading error, rad; `None` if a window holds too few headings or has no finite replay.
    pub heading_rmse: Option<f64>,
}

/// Replay errors of a response on one record.
#[derive(Debug, Clone, PartialEq)]
pub struct ReplayErrors {
    /// Root mean square heading error of the full replay, rad.
    pub heading_rmse: f64,
    /// Number of headings compared.
    pub heading_count: usize,
    /// Root mean square yaw-rate error of the full replay, rad/s; `None` without a measured yaw rate, and at
    /// [`ReplayDepth::Heading`].
    pub yaw_rate_rmse: Option<f64>,
    /// Mean absolute error of the overshoot angles, rad; `None` unless record and replay are zig-zags, and at
    /// [`ReplayDepth::Heading`].
    pub overshoot_error: Option<f64>,
    /// Errors of the restarted replays, by duration of the windows.
    pub windows: Vec<WindowError>,
    /// Heading errors after a moment is fitted to this record in addition to its initial state; `None` except in a
    /// thorough comparison on a held-out record.
    pub fitted_moment_errors: Option<MomentErrors>,
}

impl ReplayErrors {
    /// Root mean square heading error of replays restarted every `duration` seconds, rad; `None` without such replays.
    pub fn restarted_heading_rmse(&self, duration: f64) -> Option<f64> {
        self.windows.iter().find(|window| window.duration == duration)?.heading_rmse
    }
}

/// Extent of the comparison of a replay.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReplayDepth {
    /// Heading of the full replay.
    Heading,
    /// Heading, yaw rate and overshoots of the full replay, and replays restarted after each of [`HORIZONS_S`].
    Windows,
    /// All of these, and replays restarted after 5, 10, 20 s and so on, as long as the record holds several windows.
    Growth,
}

impl ReplayDepth {
    /// Window durations (s) for a record with rows at these times (s), ascending.
    pub fn window_durations(self, time: &[f64]) -> Vec<f64> {
        let doubled = std::iter::successors(Some(MIN_WINDOW_S), |duration| Some(2.0 * duration));
        let mut durations: Vec<f64> = match self {
            Self::Heading => Vec::new(),
            Self::Windows => HORIZONS_S.into(),
            Self::Growth => {
                doubled.take_while(|duration| has_several_windows(*duration, time)).chain(HORIZONS_S).collect()
            }
        };
        durations.sort_by(f64::total_cmp);
        durations.dedup();
        durations
    }
}

/// `true` if a record with rows at these times holds more than one window of this duration, s.
pub fn has_several_windows(window: f64, time: &[f64]) -> bool {
    (1.0 + MIN_LAST_PIECE) * window <= duration(time)
}

/// Duration from the first to the last time, s; 0 without times.
pub fn duration(time: &[f64]) -> f64 {
    time.last().zip(time.first()).map_or(0.0, |(last, first)| last - first)
}

/// Full replay of a record from the best initial state near one of the `starts`; `None` if no replay is finite.
pub fn full_replay(ship: &dyn ReplayedShip, record: &PreparedRecord, starts: &[[f64; 2]]) -> Option<Replay> {
    let rows = 0..record.time.len();
    let mut minima: Vec<(f64, [f64; 2])> = Vec::new();
    for &start in starts {
        let visited: Vec<[f64; 2]> = minima.iter().map(|(_, initial)| *initial).collect();
        minima.extend(fit_initial_state(ship, record, rows.clone(), start, None, &visited));
    }
    let (_, start) = minima.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let mut state = vec![0.0; ship.dimension()];
    enter(ship, record, 0, start, None, &mut state);
    let count = record.time.len();
    let mut replayed = Replay {
        time: record.time.clone(),
        heading: vec![0.0; count],
        yaw_rate: vec![0.0; count],
        residual: vec![0.0; count],
    };
    run(ship, record, rows, &mut state, |row, heading, rate| {
        replayed.heading[row] = heading;
        replayed.yaw_rate[row] = rate;
        replayed.residual[row] = record.heading[row] - heading;
    });
    replayed.heading.iter().all(|psi| psi.is_finite()).then_some(replayed)
}

/// Root mean square; `None` without values.
pub fn root_mean_square(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt())
}

/// Zig-zag characteristics of a replayed heading under the recorded rudder; `None` if it is no zig-zag.
pub fn replayed_zigzag(trial: &Trial, replayed: &Replay) -> Option<ZigZag> {
    let first = trial.observed_rows().next().unwrap_or(0);
    let range = first..first + replayed.time.len();
    let channels: BTreeMap<Channel, Vec<f64>> =
        [(Channel::Heading, replayed.heading.clone()), (Channel::Rudder, trial.rudder()[range].to_vec())].into();
    let columns = Columns { time: replayed.time.clone(), channels, unknown_columns: Vec::new() };
    let twin = Trial::new(trial.name(), trial.origin().clone(), columns).ok()?;
    ZigZag::from_trial(&twin).ok()
}

/// Mean absolute error of the overshoot angles of a replay, rad; `None` unless record and replay are zig-zags with a
/// common overshoot.
pub fn overshoot_error(trial: &Trial, replayed: &Replay) -> Option<f64> {
    let (measured, twin) = (ZigZag::from_trial(trial).ok()?, replayed_zigzag(trial, replayed)?);
    // Record and replay have the executes of the recorded rudder; a peak may be missing in one of them.
    let time = |zigzag: &ZigZag, overshoot: &Overshoot| zigzag.executes[overshoot.execute].time.value;
    let replayed = |overshoot: &Overshoot| {
        let execute = time(&measured, overshoot);
        twin.overshoots.iter().find(|other| (time(&twin, other) - execute).abs() < trial.sampling_period())
    };
    let pairs: Vec<f64> = measured
        .overshoots
        .iter()
        .filter_map(|overshoot| Some((overshoot.angle.value - replayed(overshoot)?.angle.value).abs()))
        .filter(|d| d.is_finite())
        .collect();
    (!pairs.is_empty()).then(|| pairs.iter().sum::<f64>() / pairs.len() as f64)
}

/// Headings (rad) of a replay restarted every `duration` seconds from the best initial heading and yaw rate of each
/// window; other states continue. `None` if a window holds too few headings or has no finite replay.
pub fn restarted_headings(
    ship: &dyn ReplayedShip,
    record: &PreparedRecord,
    initial: [f64; 2],
    duration: f64,
) -> Option<Vec<f64>> {
    let count = record.time.len();
    let mut state = vec![0.0; ship.dimension()];
    enter(ship, record, 0, initial, None, &mut state);
    let mut headings = vec![0.0; count];
    let mut from = 0;
    while from < count {
        let end = record.time[from] + duration;
        let mut to = record.time.partition_point(|&t| t < end);
        if record.time[count - 1] < end + MIN_LAST_PIECE * duration {
            to = count;
        }
        // The window ends at the first row of the next window.
        let until = (to + 1).min(count);
        if (from..to).filter(|&row| record.heading[row].is_finite()).count() < MIN_HEADINGS {
            return None;
        }
        let memory = state.clone();
        let start = [state[0], state[1]];
        let (_, best) = fit_initial_state(ship, record, from..to, start, Some(&memory), &[])?;
        enter(ship, record, from, best, Some(&memory), &mut state);
        run(ship, record, from..until, &mut state, |row, heading, _| {
            if row < to {
                headings[row] = heading;
            }
        });
        if to == count {
            break;
        }
        from = to;
    }
    Some(headings)
}

/// Sets the state at a row to heading and yaw rate `start`, with effect states at rest or from `memory`.
fn enter<R: Real>(
    ship: &(impl Replayable<R> + ?Sized),
    record: &PreparedRecord,
    row: usize,
    start: [R; 2],
    memory: Option<&[f64]>,
    state: &mut [R],
) {
    match memory {
        Some(memory) => {
            state.iter_mut().zip(memory).for_each(|(x, &memory)| *x = R::from(memory));
            ship.reset_motion(start[0], start[1], state);
        }
        None => {
            let input = record.replay_signals(ship).input(record.time[row], ship.dead_time());
            ship.initialise(start[0], start[1], &input, state);
        }
    }
}

/// Replays some rows of a record and calls `visit` with row, heading and yaw rate.
fn run<R: Real>(
    ship: &(impl Replayable<R> + ?Sized),
    record: &PreparedRecord,
    rows: Range<usize>,
    state: &mut [R],
    mut visit: impl FnMut(usize, R, R),
) {
    let step = solver_step(ship, record.spacing, SOLVER_STEPS);
    let times = &record.time[rows.clone()];
    replay_states(ship, &record.replay_signals(ship), times, step, state, |row, state, _| {
        visit(rows.start + row, state[0], state[1]);
    });
}

/// Residual of a row range for an initial state, and its sensitivities to the initial heading and to the initial yaw
/// rate times the duration.
struct InitialStateFit {
    initial: [f64; 2],
    residual: Vec<f64>,
    by: [Vec<f64>; 2],
    square: f64,
}

/// Least-squares initial heading and yaw rate of a row range (Gauss–Newton with damped steps), preceded by the sum of
/// squares; `None` if it is not finite, or if the search reaches a state already `visited`.
fn fit_initial_state(
    ship: &dyn ReplayedShip,
    record: &PreparedRecord,
    rows: Range<usize>,
    start: [f64; 2],
    memory: Option<&[f64]>,
    visited: &[[f64; 2]],
) -> Option<(f64, [f64; 2])> {
    let ship = ship.tangent();
    let ship = ship.as_ref();
    let span = (record.time[rows.end - 1] - record.time[rows.start]).max(record.spacing);
    let mut state = vec![Tangent::default(); ship.dimension()];
    let mut at = |initial: [f64; 2]| {
        let variables = [Tangent::variable(initial[0], 0, 1.0), Tangent::variable(initial[1], 1, 1.0)];
        enter(ship, record, rows.start, variables, memory, &mut state);
        let (mut residual, mut by) = (Vec::with_capacity(rows.len()), [(); 2].map(|()| Vec::with_capacity(rows.len())));
        run(ship, record, rows.clone(), &mut state, |row, heading, _| {
            if record.heading[row].is_finite() {
                residual.push(record.heading[row] - heading.value);
                by[0].push(heading.derivatives[0]);
                by[1].push(heading.derivatives[1] / span);
            }
        });
        InitialStateFit { initial, square: dot(&residual, &residual), residual, by }
    };
    let mut now = at(start);
    for _ in 0..MAX_STEPS {
        let [heading, rate] = &now.by;
        let (cross, count) = (dot(heading, rate), now.residual.len());
        let matrix = Matrix2::new(dot(heading, heading), cross, cross, dot(rate, rate) + 1e-12 * count as f64);
        let gradient = Vector2::new(dot(heading, &now.residual), dot(rate, &now.residual));
        let Some(direction) = matrix.lu().solve(&gradient) else { break };
        if direction.dot(&gradient) < MIN_DECREASE * now.square {
            break;
        }
        let ahead = [now.initial[0] + direction[0], now.initial[1] + direction[1] / span];
        let distance = |state: &[f64; 2]| (state[0] - ahead[0]).abs().max((state[1] - ahead[1]).abs() * span);
        if visited.iter().any(|state| distance(state) < STATE_TOLERANCE) {
            return None;
        }
        let shares = (0..MAX_STEP_LENGTHS).map(|k| 0.4_f64.powi(k));
        let next = shares
            .map(|share| at([now.initial[0] + share * direction[0], now.initial[1] + share * direction[1] / span]))
            .find(|next| next.square < now.square);
        let Some(next) = next else { break };
        now = next;
    }
    now.square.is_finite().then_some((now.square, now.initial))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{TrialPlan, record, ship};

    #[test]
    fn the_ship_of_a_record_is_on_it_in_every_window() {
        let base = ship(Vec::new());
        let trial = record(&base, TrialPlan { noise_deg: 0.0, ..TrialPlan::default() });
        for duration in HORIZONS_S {
            let headings =
                restarted_headings(&base, &PreparedRecord::unaveraged(&trial), [0.0, 0.0], duration).expect("a replay");
            let errors = headings.iter().zip(trial.heading()).map(|(replayed, psi)| (replayed - psi).abs());
            let largest = errors.fold(0.0, f64::max);
            assert!(headings.len() == trial.len() && largest < 1e-5, "{duration} s: {largest}");
        }
    }
}
