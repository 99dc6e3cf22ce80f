//! Nondimensional hull at the size and speed of a ship, for simulation and replay.

use estimation::number::{Dual, Real};
use nalgebra::{Matrix3, Vector3};

use super::prime::{PrimeHull, wind_accelerations};
use crate::dynamics::{Dynamics, Motion, RegressorChannel, ShipInput};
use crate::number::Tangent;
use crate::replayable::{Replayable, ReplayedShip, ResolvedTimeConstants};

/// Number of steps in the ship-length time L/U₀.
const STEPS: f64 = 25.0;

/// Nondimensional hull at the size and speed of a ship, with the states ψ (rad), r (rad/s), u and v (m/s).
///
/// ψ' = r; (u', v', r') follow from the [`PrimeHull`], with the propeller rate and the relative wind, if recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct ScaledHull<R = f64> {
    /// Nondimensional hull.
    pub hull: PrimeHull<R>,
    /// Length L, m.
    pub length: f64,
    /// Approach speed U₀, m/s.
    pub speed: f64,
    /// Propeller rate at that speed, 1/s; `None` if it is unknown.
    pub propeller_rate: Option<f64>,
}

impl<R: Real> Dynamics<R> for ScaledHull<R> {
    fn dimension(&self) -> usize {
        4
    }

    /// Straight ahead at approach speed, without drift.
    fn approach(&self, heading: R, yaw_rate: R, state: &mut [R]) {
        state.copy_from_slice(&[heading, yaw_rate, R::from(self.speed), R::from(0.0)]);
    }

    fn rates(&self, _t: f64, state: &[R], input: &ShipInput<R>, rate: &mut [R]) {
        let Self { length, speed, .. } = *self;
        let measured = &input.measured;
        let wind = measured
            .wind_speed
            .zip(measured.wind_from)
            .map_or([0.0; 3], |(wind, from)| wind_accelerations(wind / speed, from));
        let turning = measured.propeller_rate.zip(self.propeller_rate).map_or(1.0, |(now, approach)| now / approach);
        let prime = [state[2] / speed, state[3] / speed, state[1] * (length / speed)];
        let [surge, sway, yaw] = self.hull.accelerations(prime, input.rudder, turning, input.disturbance_rudder, wind);
        let unit = speed * speed / length;
        rate.copy_from_slice(&[state[1], yaw * (unit / length), surge * unit, sway * unit]);
    }

    fn motion(&self, t: f64, state: &[R], input: &ShipInput<R>) -> Motion {
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
    /// Initial state with measured surge and sway, or with surge and sway of the approach.
    fn initialise(&self, heading: R, yaw_rate: R, input: &ShipInput<R>, state: &mut [R]) {
        let sway = input.measured.sway.unwrap_or(0.0);
        let surge = input.measured.speed.map_or(self.speed, |speed| (speed * speed - sway * sway).max(0.0).sqrt());
        state.copy_from_slice(&[heading, yaw_rate, R::from(surge), R::from(sway)]);
    }

    fn reset_motion(&self, heading: R, yaw_rate: R, state: &mut [R]) {
        (state[0], state[1]) = (heading, yaw_rate);
    }

    fn needs(&self, _channel: RegressorChannel) -> bool {
        true
    }

    fn time_constants(&self) -> ResolvedTimeConstants {
        ResolvedTimeConstants::at_all_times(self.length / self.speed / STEPS)
    }
}

/// Maximum number of steps of the search for a steady turn.
const MAX_STEPS: usize = 60;

/// First step of the search, in L/U₀.
const FIRST_STEP: f64 = 0.5;

/// Growth factor of the step.
const STEP_GROWTH: f64 = 1.5;

/// Tolerance of the accelerations in a steady turn, in units of L and U₀.
const ACCELERATION_TOLERANCE: f64 = 1e-10;

/// Maximum rudder of a steady turn, rad.
const MAX_RUDDER_RAD: f64 = 1.2;

impl ScaledHull {
    /// Rudder (rad) of a steady turn at a yaw rate (rad/s): speed and drift settle while the rudder keeps the rate
    /// (reversed spiral, Bech 1968), which also finds the unstable branch. `None` if no rudder within 1.2 rad keeps it,
    /// or if the search does not converge.
    ///
    /// Implicit Euler steps of growing length, which become Newton steps (pseudo-transient continuation).
    pub fn steady_rudder(&self, yaw_rate: f64) -> Option<f64> {
        let hull = self.hull.to_real::<Dual<3>>();
        let rate = yaw_rate * self.length / self.speed;
        let mut at = Vector3::new(1.0, 0.0, 0.0);
        let mut step = FIRST_STEP;
        for _ in 0..MAX_STEPS {
            let [u, v, rudder] = [0, 1, 2].map(|place| Dual::variable(at[place], place, 1.0));
            let accelerations = hull.accelerations([u, v, Dual::from(rate)], rudder, 1.0, 0.0, [0.0; 3]);
            let mut matrix = Matrix3::from_fn(|row, column| -accelerations[row].derivatives[column]);
            matrix[(0, 0)] += step.recip();
            matrix[(1, 1)] += step.recip();
            let residual = Vector3::from(accelerations.map(|dual| dual.value));
            if residual.amax() < ACCELERATION_TOLERANCE {
                return (at[2].abs() < MAX_RUDDER_RAD).then_some(at[2]);
            }
            at += matrix.lu().solve(&residual)?;
            at[2] = at[2].clamp(-MAX_RUDDER_RAD, MAX_RUDDER_RAD);
            step *= STEP_GROWTH;
        }
        None
    }
}

impl ReplayedShip for ScaledHull {
    fn tangent(&self) -> Box<dyn Replayable<Tangent>> {
        let hull = self.hull.to_real();
        Box::new(ScaledHull { hull, length: self.length, speed: self.speed, propeller_rate: self.propeller_rate })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angle::from_deg;
    use crate::integrate::RungeKutta4;
    use crate::ships::kvlcc2;
    use crate::vessel::mmg::Mmg;
    use crate::vessel::prime::{CalmHull, HullModel};

    fn scaled(hull: PrimeHull) -> ScaledHull {
        ScaledHull { hull, length: 320.0, speed: 7.97, propeller_rate: None }
    }

    /// Mean hull of the prior, and KVLCC2.
    fn hulls() -> [ScaledHull; 2] {
        let form = &HullModel::candidates(None)[0];
        let means: Vec<f64> = form.coefficients().iter().map(|coefficient| coefficient.mean).collect();
        let quadratic = form.with_coefficients(&means).expect("a ship");
        let mmg = Mmg::at_speed(kvlcc2::FULL_SCALE.at_unit_length(), 1.0).expect("a ship");
        let mmg = PrimeHull { in_calm: CalmHull::Mmg(Box::new(mmg), 0.0), windage: 0.0 };
        [quadratic, mmg].map(scaled)
    }

    /// Released at its steady rudder, a ship settles at the yaw rate of that rudder.
    #[test]
    fn a_steady_turn_is_where_the_hull_settles() {
        for (hull, side) in hulls().into_iter().zip([1.0, -1.0]) {
            let rate = side * from_deg(0.5);
            let rudder = hull.steady_rudder(rate).expect("a turn");
            let mut state = [0.0; 4];
            hull.approach(0.0, 0.0, &mut state);
            let mut solver = RungeKutta4::new(4);
            for row in 0..4000 {
                solver.step(&hull, f64::from(row), 1.0, &mut state, |_| ShipInput { rudder, ..ShipInput::default() });
            }
            assert!((state[1] / rate - 1.0).abs() < 1e-4, "{} {rate} at {rudder}", state[1]);
        }
    }

    #[test]
    fn a_turn_that_no_rudder_makes_is_none() {
        let [hull, _] = hulls();
        assert_eq!(hull.steady_rudder(from_deg(8.0)), None);
        assert!(hull.steady_rudder(0.0).expect("straight ahead").abs() < 1e-9);
    }
}
