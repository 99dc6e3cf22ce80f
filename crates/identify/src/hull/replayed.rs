//! Replay of the rudder of a record, or of a part, through a hull.

use estimation::number::Real;
use ship::vessel::prime::PrimeHull;

use super::track::HullTrack;

/// Maximum step of the solver, in L/U₀.
const MAX_STEP_LENGTHS: f64 = 0.08;

/// Replay of a window: rows of states, each (ψ, u, v).
pub(super) struct ReplayedWindow<R> {
    pub rows: Vec<[R; 3]>,
    /// State (u, v, r) at the first row after the window, or at the last row of the record.
    pub end: [R; 3],
}

/// Steps a hull through rows `from..to` from (u, v, r), with a heading of zero at the first of them (Heun).
pub(super) fn replay_rows<R: Real>(
    hull: &PrimeHull<R>,
    track: &HullTrack,
    [from, to]: [usize; 2],
    start: [R; 3],
) -> ReplayedWindow<R> {
    let mut state = start;
    let mut heading = R::from(0.0);
    let mut rows = Vec::with_capacity(to - from);
    rows.push([heading, state[0], state[1]]);
    let last = to.min(track.time.len() - 1);
    for row in from + 1..=last {
        let span = track.time[row] - track.time[row - 1];
        let pieces = (span / MAX_STEP_LENGTHS).ceil().max(1.0);
        let step = span / pieces;
        let between = |values: &[f64], share: f64| values[row - 1] + share * (values[row] - values[row - 1]);
        for piece in 0..pieces as usize {
            let rates = |state: [R; 3], piece: usize| {
                let share = piece as f64 / pieces;
                let rudder = R::from(between(&track.rudder, share));
                let wind = track.wind.as_ref().map_or([0.0; 3], |xyz| xyz.each_ref().map(|axis| between(axis, share)));
                hull.accelerations(state, rudder, between(&track.n_ratio, share), between(&track.moment, share), wind)
            };
            let first = rates(state, piece);
            let ahead: [R; 3] = std::array::from_fn(|i| state[i] + first[i] * step);
            let second = rates(ahead, piece + 1);
            heading = heading + (state[2] + ahead[2]) * (0.5 * step);
            state = std::array::from_fn(|i| state[i] + (first[i] + second[i]) * (0.5 * step));
        }
        if row < to {
            rows.push([heading, state[0], state[1]]);
        }
    }
    ReplayedWindow { rows, end: state }
}
