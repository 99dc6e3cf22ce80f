//! Steady turns: the rudder at a given yaw rate, on stable and unstable branches alike.
//!
//! Source: Bech (1968), the reversed spiral test.

use super::Response;
use crate::dynamics::{Dynamics, ShipInput};
use crate::replayable::Replayable;

/// Maximum rudder of the search, rad.
const MAX_RUDDER_RAD: f64 = 1.0;

/// Number of steps of the search to either side of amidships.
const STEPS: usize = 50;

impl Response {
    /// Rudder angle (rad) of a steady turn at `yaw_rate` (rad/s) on heading 0, with settled speed and memory; `None` if
    /// no rudder within 1 rad keeps that rate. Of several (beyond stall), the rudder nearest to amidships, to within
    /// 0.02 rad.
    ///
    /// Because the yaw rate is given and the rudder is the unknown, the unstable branch is included (reversed spiral,
    /// Bech 1968).
    pub fn steady_rudder(&self, yaw_rate: f64) -> Option<f64> {
        let mut memory = Memory { state: vec![0.0; self.dimension()], rate: vec![0.0; self.dimension()] };
        let mut excess = |rudder: f64| self.excess(yaw_rate, rudder, &mut memory);
        let step = MAX_RUDDER_RAD / STEPS as f64;
        let middle = excess(0.0);
        let (mut below, mut above) = (middle, middle);
        for number in 1..=STEPS {
            let [near, far] = [number - 1, number].map(|number| number as f64 * step);
            let (lower, upper) = (excess(-far), excess(far));
            if upper * above <= 0.0 {
                return Some(root([near, far], above, &mut excess));
            }
            if lower * below <= 0.0 {
                return Some(root([-near, -far], below, &mut excess));
            }
            (below, above) = (lower, upper);
        }
        None
    }

    /// Right-hand side f of the response (rad/s²) at a yaw rate (rad/s) and rudder (rad), with settled states; zero in
    /// a steady turn.
    ///
    /// At constant yaw rate and rudder the states of effects settle linearly, so one Newton step per state is exact.
    fn excess(&self, yaw_rate: f64, rudder: f64, memory: &mut Memory) -> f64 {
        let Memory { state, rate } = memory;
        let input = ShipInput { rudder, ..ShipInput::default() };
        self.initialise(0.0, yaw_rate, &input, state);
        let slow = self.coupling.as_ref().map(|(_, place)| *place);
        for place in (2..state.len()).filter(|place| Some(*place) != slow) {
            let step = 1e-4;
            self.rates(0.0, state, &input, rate);
            let here = rate[place];
            state[place] += step;
            self.rates(0.0, state, &input, rate);
            let slope = (rate[place] - here) / step;
            state[place] -= step;
            if slope < 0.0 {
                state[place] -= here / slope;
            }
        }
        self.accelerations(state, &input, &self.instant(0.0, state, &input)).0
    }
}

struct Memory {
    state: Vec<f64>,
    rate: Vec<f64>,
}

/// Root of a function between two arguments, by bisection; `first` is the value of the function at the first argument.
fn root([mut near, mut far]: [f64; 2], first: f64, function: &mut impl FnMut(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (near + far);
        if function(middle) * first > 0.0 {
            near = middle;
        } else {
            far = middle;
        }
    }
    0.5 * (near + far)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::ResponseModel;
    use crate::effects::{Effect, SecondOrder, SpeedLoss, SteeringLag, listed_effect};

    fn ship(inverse_T: f64, effect: Arc<dyn Effect>, parameters: &[f64]) -> Response {
        let mut values = vec![inverse_T, 6e-3, 0.01];
        values.extend_from_slice(parameters);
        ResponseModel::new(vec![effect]).with_parameters(values)
    }

    /// −a r − n r³ + b (δ + δ_r) = 0, re-derived by hand; a < 0 for a course-unstable ship with an unstable loop.
    #[test]
    fn the_steady_curve_holds_its_unstable_branch() {
        for inverse_T in [0.06, -0.02] {
            let ship = ship(inverse_T, listed_effect("nonlinear_damping", "r³"), &[300.0]);
            for rate in [-0.02, -0.004, 0.0, 0.001, 0.01] {
                let by_hand = (inverse_T * rate + 300.0 * rate * rate * rate) / 6e-3 - 0.01;
                let steady = ship.steady_rudder(rate).expect("within a radian");
                assert!((steady - by_hand).abs() < 1e-9, "{inverse_T} {rate}: {steady} {by_hand}");
            }
        }
        assert_eq!(ship(0.06, listed_effect("nonlinear_damping", "r³"), &[300.0]).steady_rudder(1.0), None);
    }

    /// Lag and sway coupling change the approach to a steady turn, not the steady turn.
    #[test]
    fn memory_does_not_change_the_steady_curve() {
        for ship in
            [ship(0.06, Arc::new(SteeringLag::FirstOrder), &[4.0]), ship(0.06, Arc::new(SecondOrder), &[5.0, 12.0])]
        {
            let steady = ship.steady_rudder(0.01).expect("within a radian");
            assert!((steady - (0.06 * 0.01 / 6e-3 - 0.01)).abs() < 1e-9, "{steady}");
        }
    }

    /// q = 1 − c T_u r², and b q^m (δ + δ_r) = a q r.
    #[test]
    fn the_speed_is_that_of_a_long_turn() {
        let ship = ship(0.06, Arc::new(SpeedLoss::Modelled), &[20.0, 100.0, 2.0]);
        let (rate, speed) = (0.01, 1.0 - 20.0 * 100.0 * 1e-4);
        let by_hand = 0.06 * speed * rate / (6e-3 * speed * speed) - 0.01;
        let steady = ship.steady_rudder(rate).expect("within a radian");
        assert!((steady - by_hand).abs() < 1e-9, "{steady} {by_hand}");
    }
}
