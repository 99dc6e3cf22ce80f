//! The path over ground of a ship with known velocities, and the figures of a turning circle.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Positions (north, east; m) from heading (rad), surge and sway (m/s) at increasing times (s), beginning at the
/// origin.
///
/// x' = u cos ψ − v sin ψ, y' = u sin ψ + v cos ψ, by the trapezoidal rule. As many rows as the shortest column has.
pub fn track(time: &[f64], heading: &[f64], surge: &[f64], sway: &[f64]) -> Vec<[f64; 2]> {
    let rows = time.len().min(heading.len()).min(surge.len()).min(sway.len());
    let over_ground = |row: usize| {
        let (sin, cos) = heading[row].sin_cos();
        [surge[row] * cos - sway[row] * sin, surge[row] * sin + sway[row] * cos]
    };
    let mut place = [0.0; 2];
    let mut path = Vec::with_capacity(rows);
    let mut before = [0.0; 2];
    for row in 0..rows {
        let now = over_ground(row);
        if row > 0 {
            let half = 0.5 * (time[row] - time[row - 1]);
            place = [0, 1].map(|axis| place[axis] + half * (before[axis] + now[axis]));
        }
        before = now;
        path.push(place);
    }
    path
}

/// A turn as a time series: columns of equal length, one row per time.
#[derive(Debug, Clone, Copy)]
pub struct Turn<'a> {
    /// Time, s, increasing.
    pub time: &'a [f64],
    /// Heading, rad, not wrapped.
    pub heading: &'a [f64],
    /// Positions north and east, m: measured, or those of [`track`].
    pub track: &'a [[f64; 2]],
    /// Surge velocity, m/s.
    pub surge: &'a [f64],
    /// Sway velocity at the point whose positions are given, m/s, to starboard.
    pub sway: &'a [f64],
    /// Yaw rate, rad/s.
    pub yaw_rate: &'a [f64],
}

/// Figures of a turning circle; `None` for what was not reached.
///
/// Sources: IMO MSC.137(76) (2002); ITTC 7.5-04-02-01.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TurningCircleFigures {
    /// Way in the direction of the approach from the execute to a heading change of 90°, m.
    pub advance: Option<f64>,
    /// Way across, to the side of the turn, from the execute to a heading change of 90°, m.
    pub transfer: Option<f64>,
    /// The same to a heading change of 180°, m.
    pub tactical_diameter: Option<f64>,
    /// Speed in the steady turn over that at the execute.
    pub speed_ratio: Option<f64>,
    /// Drift angle β = atan2(−v, u) in the steady turn at the point whose sway is given, rad.
    pub drift_angle: Option<f64>,
    /// Distance x_P = −v/r of the pivot point ahead of that point in the steady turn, m.
    pub pivot_ahead: Option<f64>,
}

/// Heading change from which a turn counts as steady, rad.
const STEADY: f64 = TAU;

/// Heading change that the steady part has to have, rad: over half a circle a current and waves nearly cancel.
const ENOUGH: f64 = PI;

/// The figures of a turn that was begun at the time `execute` (s).
///
/// The course of the approach is the heading at the execute, the side of the turn that of the last heading. Between two
/// rows the heading runs straight. The steady turn is what follows a heading change of 360° when that is at least half
/// a circle more; the series should end with the turn. All figures are `None` when columns differ in length, a number
/// in time, heading or track is not finite, or the execute lies outside.
pub fn turning_circle(turn: &Turn, execute: f64) -> TurningCircleFigures {
    let none = TurningCircleFigures::default();
    let rows = turn.time.len();
    let lengths = [turn.heading.len(), turn.track.len(), turn.surge.len(), turn.sway.len(), turn.yaw_rate.len()];
    let finite = turn.time.iter().chain(turn.heading).chain(turn.track.iter().flatten()).all(|value| value.is_finite());
    if rows < 2 || lengths != [rows; 5] || !finite || !(turn.time[0] <= execute && execute <= turn.time[rows - 1]) {
        return none;
    }
    let begin = turn.time.partition_point(|time| *time <= execute).clamp(1, rows - 1) - 1;
    let share = (execute - turn.time[begin]) / (turn.time[begin + 1] - turn.time[begin]);
    let between = |from: f64, to: f64, share: f64| from + share * (to - from);
    let at = |values: &[f64]| between(values[begin], values[begin + 1], share);
    let course = at(turn.heading);
    let place =
        |row: usize, share: f64| [0, 1].map(|axis| between(turn.track[row][axis], turn.track[row + 1][axis], share));
    let origin = place(begin, share);
    let side = (turn.heading[rows - 1] - course).signum();
    let change = |row: usize| side * (turn.heading[row] - course);
    let (sin, cos) = course.sin_cos();
    // Ahead of the execute and to the side of the turn, when the heading has changed by an angle.
    let reached = |angle: f64| {
        let row = (begin + 1..rows).find(|&row| change(row) >= angle)?;
        let share = (angle - change(row - 1)) / (change(row) - change(row - 1));
        let now = place(row - 1, share);
        let way = [now[0] - origin[0], now[1] - origin[1]];
        Some([way[0] * cos + way[1] * sin, side * (way[1] * cos - way[0] * sin)])
    };
    let quarter = reached(FRAC_PI_2);
    let steady = (begin..rows).find(|&row| change(row) >= STEADY).filter(|_| change(rows - 1) >= STEADY + ENOUGH);
    let mean = |values: &[f64]| {
        let (sum, count) = values.iter().filter(|value| value.is_finite()).fold((0.0, 0), |(s, n), v| (s + v, n + 1));
        (count > 0).then(|| sum / f64::from(count))
    };
    let means = steady
        .and_then(|row| Some([mean(&turn.surge[row..])?, mean(&turn.sway[row..])?, mean(&turn.yaw_rate[row..])?]));
    let entry = at(turn.surge).hypot(at(turn.sway));
    TurningCircleFigures {
        advance: quarter.map(|way| way[0]),
        transfer: quarter.map(|way| way[1]),
        tactical_diameter: reached(PI).map(|way| way[1]),
        speed_ratio: means.map(|[u, v, _]| u.hypot(v) / entry).filter(|ratio| ratio.is_finite()),
        drift_angle: means.map(|[u, v, _]| (-v).atan2(u)),
        pivot_ahead: means.map(|[_, v, r]| -v / r).filter(|distance| distance.is_finite()),
    }
}
