//! A hull without dimension, at the size and speed of a ship: what is steered and replayed.

use estimation::number::Real;

use super::prime::PrimeHull;
use crate::dynamics::{Dynamics, Input, Motion, Regressor};
use crate::number::Tangent;
use crate::replayable::{Pace, Replayable, ReplayedShip};

/// Steps in the time L/U₀.
const STEPS: f64 = 25.0;

/// A hull of three degrees of freedom: states ψ (rad), r (rad/s), u and v (m/s).
///
/// ψ' = r; (u', v', r') are those of the [`PrimeHull`], which sees the propeller where it was recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct ScaledHull<R = f64> {
    /// The hull.
    pub hull: PrimeHull<R>,
    /// Length L, m.
    pub length: f64,
    /// Approach speed U₀, m/s.
    pub speed: f64,
    /// Rate of the propeller at that speed, 1/s, where it is known.
    pub propeller: Option<f64>,
}

impl<R: Real> Dynamics<R> for ScaledHull<R> {
    fn dimension(&self) -> usize {
        4
    }

    /// Straight ahead at approach speed, without drift.
    fn approach(&self, heading: R, yaw_rate: R, state: &mut [R]) {
        state.copy_from_slice(&[heading, yaw_rate, R::from(self.speed), R::from(0.0)]);
    }

    fn rates(&self, _t: f64, state: &[R], input: &Input<R>, rate: &mut [R]) {
        let Self { length, speed, .. } = *self;
        let turning = input.measured.propeller.zip(self.propeller).map_or(1.0, |(now, approach)| now / approach);
        let prime = [state[2] / speed, state[3] / speed, state[1] * (length / speed)];
        let [surge, sway, yaw] = self.hull.accelerations(prime, input.rudder, turning, input.disturbance);
        let unit = speed * speed / length;
        rate.copy_from_slice(&[state[1], yaw * (unit / length), surge * unit, sway * unit]);
    }

    fn motion(&self, t: f64, state: &[R], input: &Input<R>) -> Motion {
        let mut rate = [R::from(0.0); 4];
        self.rates(t, state, input, &mut rate);
        let [heading, yaw_rate, surge, sway] = [0, 1, 2, 3].map(|place| state[place].value());
        let yaw_acceleration = rate[1].value();
        Motion { heading, yaw_rate, yaw_acceleration, speed: Some(surge.hypot(sway)), sway: Some(sway) }
    }

    fn largest_step(&self) -> f64 {
        self.length / self.speed / STEPS
    }
}

impl<R: Real> Replayable<R> for ScaledHull<R> {
    /// Surge and sway are those measured, or those of the approach.
    fn enter(&self, heading: R, yaw_rate: R, input: &Input<R>, state: &mut [R]) {
        let sway = input.measured.sway.unwrap_or(0.0);
        let surge = input.measured.speed.map_or(self.speed, |speed| (speed * speed - sway * sway).max(0.0).sqrt());
        state.copy_from_slice(&[heading, yaw_rate, R::from(surge), R::from(sway)]);
    }

    fn restart(&self, heading: R, yaw_rate: R, state: &mut [R]) {
        (state[0], state[1]) = (heading, yaw_rate);
    }

    fn needs(&self, channel: Regressor) -> bool {
        channel != Regressor::Wind
    }

    fn pace(&self) -> Pace {
        Pace::always(self.length / self.speed / STEPS)
    }
}

impl ReplayedShip for ScaledHull {
    fn tangent(&self) -> Box<dyn Replayable<Tangent>> {
        let hull = self.hull.constant();
        Box::new(ScaledHull { hull, length: self.length, speed: self.speed, propeller: self.propeller })
    }
}
