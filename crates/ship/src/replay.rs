//! Replay of a recorded rudder through any [`Dynamics`]: deterministic simulation without helmsman, sensors or noise,
//! for use in identification.

use crate::dynamics::{Dynamics, MeasuredChannels, Motion, ShipInput};
use crate::integrate::RungeKutta4;
use crate::signal::Polyline;
use estimation::number::Real;

/// Recorded signals that are the input of a replay; `None` for a channel that is not in the record.
#[derive(Debug, Clone, Copy)]
pub struct RecordedSignals<'a> {
    /// Rudder angle, rad.
    pub rudder: &'a Polyline,
    /// Speed through the water, m/s.
    pub speed: Option<&'a Polyline>,
    /// Sway velocity, m/s.
    pub sway: Option<&'a Polyline>,
    /// Relative wind speed, m/s.
    pub wind_speed: Option<&'a Polyline>,
    /// Direction the relative wind comes from, clockwise from the bow, rad, unwrapped.
    pub wind_from: Option<&'a Polyline>,
    /// Propeller revolutions, 1/s.
    pub propeller_rate: Option<&'a Polyline>,
}

impl<'a> RecordedSignals<'a> {
    /// Record with a rudder only.
    pub fn from_rudder(rudder: &'a Polyline) -> Self {
        Self { rudder, speed: None, sway: None, wind_speed: None, wind_from: None, propeller_rate: None }
    }

    /// Input at time `t` (s) of a ship with this dead time of the rudder (s).
    pub fn input<R: Real>(&self, t: f64, dead_time: R) -> ShipInput<R> {
        let corner = self.rudder.times().partition_point(|&c| c + dead_time.value() <= t);
        let rudder = Ramp::before(self.rudder, corner).at(t, dead_time);
        ShipInput { rudder, disturbance_rudder: 0.0, measured: self.measured(t, corner.saturating_sub(1)) }
    }

    fn measured(&self, t: f64, piece: usize) -> MeasuredChannels {
        let at = |signal: Option<&Polyline>| signal.map(|signal| signal.value_at_with_hint(t, piece));
        MeasuredChannels {
            speed: at(self.speed),
            sway: at(self.sway),
            wind_speed: at(self.wind_speed),
            wind_from: at(self.wind_from),
            propeller_rate: at(self.propeller_rate),
        }
    }

    fn has_channels(&self) -> bool {
        [self.speed, self.sway, self.wind_speed, self.wind_from, self.propeller_rate].iter().any(Option::is_some)
    }
}

/// Linear piece of the rudder signal.
#[derive(Debug, Clone, Copy)]
struct Ramp {
    from: f64,
    value: f64,
    slope: f64,
}

impl Ramp {
    /// Piece that ends at the corner with this index; constant before the first corner and after the last.
    fn before(signal: &Polyline, corner: usize) -> Self {
        let (time, value) = (signal.times(), signal.values());
        match corner {
            0 => Self { from: time[0], value: value[0], slope: 0.0 },
            _ if corner == time.len() => Self { from: time[corner - 1], value: value[corner - 1], slope: 0.0 },
            _ => {
                let slope = (value[corner] - value[corner - 1]) / (time[corner] - time[corner - 1]);
                Self { from: time[corner - 1], value: value[corner - 1], slope }
            }
        }
    }

    /// Acting rudder at time `t` (s) after `dead_time` (s), rad.
    #[inline]
    fn at<R: Real>(&self, t: f64, dead_time: R) -> R {
        (-dead_time + (t - self.from)) * self.slope + self.value
    }
}

/// Replay of `recorded` from `state` at `times[0]` that calls `visit(index, motion)` at every time.
///
/// `times` (s) must increase. Steps end at every output time and at every corner of the rudder signal (shifted by the
/// dead time of the ship), and are no longer than `largest_step` seconds. `state` holds the state at the last time
/// afterwards. A state that overflows is passed to the caller as motion that is not finite.
pub fn replay<D, V>(
    dynamics: &D,
    recorded: &RecordedSignals,
    times: &[f64],
    largest_step: f64,
    state: &mut [f64],
    mut visit: V,
) where
    D: Dynamics + ?Sized,
    V: FnMut(usize, &Motion),
{
    replay_states(
        dynamics,
        recorded,
        times,
        |_, _| largest_step,
        state,
        |index, state, input| {
            visit(index, &dynamics.motion(times[index], state, input));
        },
    );
}

/// [`replay`] for every number type, with the state instead of the motion: calls `visit(index, state, input)` at every
/// time. Steps between two times are no longer than `largest_step(from, to)`, s.
pub fn replay_states<R, D, S, V>(
    dynamics: &D,
    recorded: &RecordedSignals,
    times: &[f64],
    largest_step: S,
    state: &mut [R],
    mut visit: V,
) where
    R: Real,
    D: Dynamics<R> + ?Sized,
    S: Fn(f64, f64) -> f64,
    V: FnMut(usize, &[R], &ShipInput<R>),
{
    let Some(&start) = times.first() else { return };
    let dead_time = dynamics.dead_time();
    let late = dead_time.value();
    let corners = recorded.rudder.times();
    let has_channels = recorded.has_channels();
    let mut solver = RungeKutta4::new(dynamics.dimension());
    let mut corner = corners.partition_point(|&c| c + late <= start);
    let mut ramp = Ramp::before(recorded.rudder, corner);
    // Inputs at the beginning, in the middle and at the end of a step.
    let mut inputs = [ShipInput::default(); 3];
    let act = |input: &mut ShipInput<R>, t: f64, ramp: &Ramp, corner: usize| {
        input.rudder = ramp.at(t, dead_time);
        if has_channels {
            input.measured = recorded.measured(t, corner.saturating_sub(1));
        }
    };
    act(&mut inputs[2], start, &ramp, corner);
    let mut t = start;
    for (index, &until) in times.iter().enumerate() {
        while t < until {
            if corner < corners.len() && corners[corner] + late <= t {
                while corner < corners.len() && corners[corner] + late <= t {
                    corner += 1;
                }
                ramp = Ramp::before(recorded.rudder, corner);
                // The rudder is continuous here; its derivative by the dead time is not.
                inputs[2].rudder = ramp.at(t, dead_time);
            }
            let end = match corners.get(corner) {
                Some(&c) if c + late < until => c + late,
                _ => until,
            };
            let steps = ((end - t) / largest_step(t, end)).ceil().max(1.0);
            let h = (end - t) / steps;
            for k in 0..steps as usize {
                let from = t + k as f64 * h;
                inputs[0] = inputs[2];
                act(&mut inputs[1], from + 0.5 * h, &ramp, corner);
                act(&mut inputs[2], from + h, &ramp, corner);
                solver.step_with(dynamics, from, h, state, &inputs);
                dynamics.update_memory(from + h, state, &inputs[2]);
            }
            t = end;
        }
        visit(index, state, &inputs[2]);
    }
}
