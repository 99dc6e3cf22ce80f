//! Replay of a recorded rudder through any [`Dynamics`]: the deterministic half of simulation, which
//! identification may use because there is no helmsman, no sensor and no chance in it.

use crate::dynamics::{Dynamics, Input, Measured, Motion};
use crate::integrate::RungeKutta4;
use crate::signal::Polyline;

/// Recorded signals that drive a replay.
#[derive(Debug, Clone, Copy)]
pub struct Recorded<'a> {
    /// Rudder angle, rad.
    pub rudder: &'a Polyline,
    /// Speed through the water, m/s.
    pub speed: Option<&'a Polyline>,
    /// Sway velocity, m/s.
    pub sway: Option<&'a Polyline>,
    /// Relative wind speed, m/s.
    pub wind_speed: Option<&'a Polyline>,
    /// Direction the relative wind comes from, rad, unwrapped.
    pub wind_from: Option<&'a Polyline>,
    /// Propeller revolutions, 1/s.
    pub propeller: Option<&'a Polyline>,
}

impl<'a> Recorded<'a> {
    /// A record that holds nothing but the rudder.
    pub fn rudder(rudder: &'a Polyline) -> Self {
        Self { rudder, speed: None, sway: None, wind_speed: None, wind_from: None, propeller: None }
    }

    /// What acts at time `t` on a ship whose rudder is late by `dead_time`; `piece` is a hint into the rudder signal.
    pub fn input(&self, t: f64, dead_time: f64, piece: usize) -> Input {
        let at = |signal: Option<&Polyline>| signal.map(|signal| signal.at_from(t, piece));
        Input {
            rudder: self.rudder.at_from(t - dead_time, piece),
            disturbance: 0.0,
            measured: Measured {
                speed: at(self.speed),
                sway: at(self.sway),
                wind_speed: at(self.wind_speed),
                wind_from: at(self.wind_from),
                propeller: at(self.propeller),
            },
        }
    }
}

/// Replays `recorded` from `state` at `times[0]` and calls `visit(index, motion)` at every time.
///
/// `times` (s) must increase. Steps end at every output time and at every corner of the rudder signal (shifted by the
/// dead time of the ship), and are no longer than `largest_step` seconds. `state` is left at the last time. A state
/// that overflows is passed on as it is: the caller sees motion that is not finite.
pub fn replay<D, V>(
    dynamics: &D,
    recorded: &Recorded,
    times: &[f64],
    largest_step: f64,
    state: &mut [f64],
    mut visit: V,
) where
    D: Dynamics + ?Sized,
    V: FnMut(usize, &Motion),
{
    let Some(&start) = times.first() else { return };
    let dead_time = dynamics.dead_time();
    let corners = recorded.rudder.times();
    let mut solver = RungeKutta4::new(dynamics.dimension());
    let mut corner = corners.partition_point(|&c| c + dead_time <= start);
    let mut t = start;
    for (index, &until) in times.iter().enumerate() {
        while t < until {
            while corner < corners.len() && corners[corner] + dead_time <= t {
                corner += 1;
            }
            let end = match corners.get(corner) {
                Some(&c) if c + dead_time < until => c + dead_time,
                _ => until,
            };
            let steps = ((end - t) / largest_step).ceil().max(1.0);
            let h = (end - t) / steps;
            let piece = corner.saturating_sub(1);
            for k in 0..steps as usize {
                let from = t + k as f64 * h;
                solver.step(dynamics, from, h, state, |at| recorded.input(at, dead_time, piece));
                dynamics.settle(from + h, state, &recorded.input(from + h, dead_time, piece));
            }
            t = end;
        }
        visit(index, &dynamics.motion(until, state, &recorded.input(until, dead_time, corner.saturating_sub(1))));
    }
}
