//! A hull with a helmsman: zig-zags and turns for tests.

use ship::integrate::RungeKutta4;
use ship::{Dynamics, Input};

use crate::motion::IdentifiedHull;

/// How the rudder is moved.
pub(super) enum Helm {
    /// To one angle (rad).
    Turn(f64),
    /// A zig-zag: first rudder angle (rad) and heading change (rad) at which it is put over.
    ZigZag(f64, f64),
}

/// One instant of a steered run.
pub(super) struct Row {
    /// s.
    pub time: f64,
    /// rad.
    pub rudder: f64,
    /// Heading, yaw rate, surge, sway.
    pub state: [f64; 4],
}

/// A straight approach, then the helm, with the rudder moved at `rate` (rad/s), for `duration` seconds.
pub(super) fn steer(hull: &IdentifiedHull, helm: &Helm, rate: f64, duration: f64) -> Vec<Row> {
    let mut state = [0.0; 4];
    hull.approach(0.0, 0.0, &mut state);
    let mut solver = RungeKutta4::new(4);
    let step = hull.largest_step().min(0.5);
    let mut target = match helm {
        Helm::Turn(angle) | Helm::ZigZag(angle, _) => *angle,
    };
    let (mut rudder, mut rows) = (0.0f64, vec![Row { time: 0.0, rudder: 0.0, state }]);
    for index in 0..(duration / step) as usize {
        let t = index as f64 * step;
        let next = rudder + (target - rudder).clamp(-rate * step, rate * step);
        let at = |now: f64| Input { rudder: rudder + (next - rudder) * (now - t) / step, ..Input::default() };
        solver.step(hull, t, step, &mut state, at);
        rudder = next;
        if let Helm::ZigZag(_, change) = helm
            && target.signum() * state[0] >= *change
        {
            target = -target;
        }
        rows.push(Row { time: t + step, rudder, state });
    }
    rows
}

/// Overshoots of a zig-zag, rad, one after the other: what the heading turns beyond the change at which the rudder was
/// put over.
pub(super) fn overshoots(rows: &[Row], change: f64) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::new();
    let mut side = 0.0;
    for pair in rows.windows(2) {
        let [before, now] = [pair[0].state, pair[1].state];
        let turns = before[1] * now[1] <= 0.0 && before[0] * before[1] > 0.0;
        if turns && now[0].abs() > change && now[0].signum() != side {
            side = now[0].signum();
            found.push(now[0].abs() - change);
        }
    }
    found
}
