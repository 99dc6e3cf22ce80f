//! Track over ground from velocities, and the characteristics of a turning circle.
//!
//! Sources: IMO MSC.137(76) (2002); ITTC 7.5-04-02-01.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Track: positions (north, east; m) from heading (rad), surge and sway (m/s) at increasing times (s), from the origin.
///
/// x' = u cos ψ − v sin ψ, y' = u sin ψ + v cos ψ, by the trapezoidal rule. Rows beyond the shortest column are
/// dropped.
pub fn dead_reckoning(time: &[f64], heading: &[f64], velocity: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let over_ground = |(heading, [surge, sway]): (&f64, &[f64; 2])| {
        let (sin, cos) = heading.sin_cos();
        [surge * cos - sway * sin, surge * sin + sway * cos]
    };
    let ways: Vec<[f64; 2]> = heading.iter().zip(velocity).map(over_ground).collect();
    let mut place = [0.0; 2];
    let step = |row: usize| {
        if row > 0 {
            let half = 0.5 * (time[row] - time[row - 1]);
            place = [0, 1].map(|axis| place[axis] + half * (ways[row - 1][axis] + ways[row][axis]));
        }
        place
    };
    (0..ways.len().min(time.len())).map(step).collect()
}

/// First crossing of a level after row `first`: the row before, and the share of the interval to the next row; `None`
/// without a crossing.
pub(crate) fn first_crossing(
    value: impl Fn(usize) -> f64,
    first: usize,
    rows: usize,
    level: f64,
) -> Option<(usize, f64)> {
    let row = (first + 1..rows).find(|&row| value(row) >= level)?;
    Some((row - 1, (level - value(row - 1)) / (value(row) - value(row - 1))))
}

/// Characteristics of a turning circle; `None` for a characteristic that was not reached.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TurningCircleCharacteristics {
    /// Advance, m: distance in the direction of the approach from the execute to a heading change of 90°.
    pub advance: Option<f64>,
    /// Transfer, m: distance across the approach, to the side of the turn, from the execute to a heading change of 90°.
    pub transfer: Option<f64>,
    /// Tactical diameter, m: distance across the approach from the execute to a heading change of 180°.
    pub tactical_diameter: Option<f64>,
    /// Ratio of the speed in the steady turn to the speed at the execute.
    pub speed_ratio: Option<f64>,
    /// Drift angle β = atan2(−v, u) in the steady turn at the reference point of the sway, rad.
    pub drift_angle: Option<f64>,
    /// Distance x_P = −v/r of the pivot point ahead of the reference point in the steady turn, m.
    pub pivot_ahead: Option<f64>,
}

/// Heading change after which a turn is taken as steady, rad.
const STEADY: f64 = TAU;

/// Minimum heading change of the steady part, rad; over half a circle a current and waves nearly cancel.
const MIN_STEADY_CHANGE: f64 = PI;

/// Characteristics of a turn with the execute at `execute` s, from times (s, increasing), headings (rad, not wrapped),
/// positions (m, north and east: measured, or of [`dead_reckoning`]; empty if unknown), surge and sway at the same
/// point (m/s), and yaw rates (rad/s).
///
/// The course of the approach is the heading at the execute; the last heading determines the side of the turn. The
/// heading is interpolated linearly between rows. The steady turn is the part after a heading change of 360°, if it
/// turns by at least half a circle more; the series should end with the turn. All characteristics are `None` if columns
/// differ in length or have fewer than two rows, a number in time, heading or track is not finite, or the execute is
/// outside the series.
pub fn turning_circle(
    [time, heading, yaw_rate]: [&[f64]; 3],
    [track, velocity]: [&[[f64; 2]]; 2],
    execute: f64,
) -> TurningCircleCharacteristics {
    let none = TurningCircleCharacteristics::default();
    let rows = time.len();
    let has_track = !track.is_empty();
    let lengths = [heading.len(), if has_track { track.len() } else { rows }, velocity.len(), yaw_rate.len()];
    let finite = time.iter().chain(heading).chain(track.iter().flatten()).all(|value| value.is_finite());
    if rows < 2 || lengths != [rows; 4] || !finite || !(time[0] <= execute && execute <= time[rows - 1]) {
        return none;
    }
    let begin = time.partition_point(|time| *time <= execute).clamp(1, rows - 1) - 1;
    let share = (execute - time[begin]) / (time[begin + 1] - time[begin]);
    let between = |from: f64, to: f64, share: f64| from + share * (to - from);
    let course = between(heading[begin], heading[begin + 1], share);
    let at = |columns: &[[f64; 2]], row: usize, share: f64| {
        [0, 1].map(|axis| between(columns[row][axis], columns[row + 1][axis], share))
    };
    let origin = has_track.then(|| at(track, begin, share));
    let side = (heading[rows - 1] - course).signum();
    let change = |row: usize| side * (heading[row] - course);
    let (sin, cos) = course.sin_cos();
    // Distance ahead of the execute and to the side of the turn, at a heading change of an angle.
    let way = |angle: f64| {
        let (origin, (row, share)) = (origin?, first_crossing(change, begin, rows, angle)?);
        let now = at(track, row, share);
        let way = [now[0] - origin[0], now[1] - origin[1]];
        Some([way[0] * cos + way[1] * sin, side * (way[1] * cos - way[0] * sin)])
    };
    let quarter = way(FRAC_PI_2);
    let steady =
        (begin..rows).find(|&row| change(row) >= STEADY).filter(|_| change(rows - 1) >= STEADY + MIN_STEADY_CHANGE);
    let mean = |values: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = values.filter(|value| value.is_finite()).fold((0.0, 0), |(s, n), v| (s + v, n + 1));
        (count > 0).then(|| sum / f64::from(count))
    };
    let means = steady.and_then(|row| {
        let [surge, sway] = [0, 1].map(|axis| mean(&mut velocity[row..].iter().map(|v| v[axis])));
        Some([surge?, sway?, mean(&mut yaw_rate[row..].iter().copied())?])
    });
    let [surge, sway] = at(velocity, begin, share);
    TurningCircleCharacteristics {
        advance: quarter.map(|way| way[0]),
        transfer: quarter.map(|way| way[1]),
        tactical_diameter: way(PI).map(|way| way[1]),
        speed_ratio: means.map(|[u, v, _]| u.hypot(v) / surge.hypot(sway)).filter(|ratio| ratio.is_finite()),
        drift_angle: means.map(|[u, v, _]| (-v).atan2(u)),
        pivot_ahead: means.map(|[_, v, r]| -v / r).filter(|distance| distance.is_finite()),
    }
}
