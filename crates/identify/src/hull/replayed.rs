//! Replay of the rudder of a record, or of a part, through a hull.

use estimation::lanes::{Kernel, run_kernel};
use estimation::number::Real;
use ship::vessel::prime::PrimeHull;

use super::track::HullSignals;

/// Maximum step of the solver, in L/U₀.
const MAX_STEP_LENGTHS: f64 = 0.08;

/// Replay of a window: (ψ, u, v) in every row, ψ in rad, u and v in units of U₀.
pub(super) struct ReplayedWindow<R> {
    pub rows: Vec<[R; 3]>,
    /// State (u, v, r) at the first row after the window, or at the last row of the record.
    pub end: [R; 3],
}

/// Replay of rows `from..to` of a record through a hull, from the state (u, v, r) and a heading of zero in row `from`.
/// Steps by the method of Heun.
#[inline(always)]
pub(super) fn replay_rows<R: Real>(
    hull: &PrimeHull<R>,
    signals: &HullSignals,
    [from, to]: [usize; 2],
    start: [R; 3],
) -> ReplayedWindow<R> {
    let mut state = start;
    let mut heading = R::from(0.0);
    let mut rows = Vec::with_capacity(to - from);
    rows.push([heading, state[0], state[1]]);
    let last = to.min(signals.time.len() - 1);
    for row in from + 1..=last {
        let span = signals.time[row] - signals.time[row - 1];
        let pieces = (span / MAX_STEP_LENGTHS).ceil().max(1.0);
        let step = span / pieces;
        let between = |values: &[f64], share: f64| values[row - 1] + share * (values[row] - values[row - 1]);
        for piece in 0..pieces as usize {
            let mut stages = [state; 2];
            let mut rates = [state; 2];
            for stage in 0..2 {
                let share = (piece + stage) as f64 / pieces;
                let rudder = R::from(between(&signals.rudder, share));
                let wind =
                    signals.wind.as_ref().map_or([0.0; 3], |xyz| xyz.each_ref().map(|axis| between(axis, share)));
                let (n_ratio, moment) = (between(&signals.n_ratio, share), between(&signals.moment, share));
                rates[stage] = hull.accelerations(stages[stage], rudder, n_ratio, moment, wind);
                if stage == 0 {
                    stages[1] = std::array::from_fn(|i| state[i] + rates[0][i] * step);
                }
            }
            heading = heading + (state[2] + stages[1][2]) * (0.5 * step);
            state = std::array::from_fn(|i| state[i] + (rates[0][i] + rates[1][i]) * (0.5 * step));
        }
        if row < to {
            rows.push([heading, state[0], state[1]]);
        }
    }
    ReplayedWindow { rows, end: state }
}

/// [`replay_rows`] in vector arithmetic, for numbers with many derivatives.
pub(super) fn replay_rows_in_lanes<R: Real>(
    hull: &PrimeHull<R>,
    signals: &HullSignals,
    rows: [usize; 2],
    start: [R; 3],
) -> ReplayedWindow<R> {
    run_kernel(RowReplay { hull, signals, rows, start })
}

/// Arguments of [`replay_rows`].
struct RowReplay<'a, R> {
    hull: &'a PrimeHull<R>,
    signals: &'a HullSignals,
    rows: [usize; 2],
    start: [R; 3],
}

impl<R: Real> Kernel for RowReplay<'_, R> {
    type Output = ReplayedWindow<R>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        replay_rows(self.hull, self.signals, self.rows, self.start)
    }
}
