//! Steady turns: the yaw rate of every rudder angle, on stable and unstable branches, and the loop of a course-unstable
//! ship. Source of the curve: the reverse spiral of Bech (1968), The reverse spiral test as applied to large ships.

use serde::{Deserialize, Serialize};
use ship::angle::to_deg;

use crate::figures::Characteristics;
use crate::mixture::DrawnShip;

/// Number of points to either side of a straight course.
const POINTS: usize = 24;

/// Number of doublings in the search for a rate beyond the maximum rudder, and of halvings to approach it.
const DOUBLINGS: usize = 12;

/// Rudder (rad) against yaw rate (rad/s) of steady turns, in the order of the yaw rate.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SteadyCurve {
    /// Yaw rates, rad/s.
    pub yaw_rate: Vec<f64>,
    /// Rudder of each rate, rad.
    pub rudder: Vec<f64>,
}

/// Instability loop: the part of a steady curve over which the ship is unstable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InstabilityLoop {
    /// Difference of the rudder angles at the ends of the loop, rad.
    pub width: f64,
    /// Difference of the yaw rates of the outer branches at the rudder in the middle of the loop, rad/s.
    pub height: f64,
}

impl SteadyCurve {
    /// Curve of a ship up to `largest` rad of rudder to either side; `timescale` is the timescale of the ship, s. Rates
    /// without a rudder are left out.
    pub fn from_ship(ship: &DrawnShip, largest: f64, timescale: f64) -> Self {
        let steady = |rate: f64| match &ship.hull {
            Some(hull) => hull.steady_rudder(rate),
            None => ship.response.steady_rudder(rate),
        };
        Self::from_turns(steady, largest, timescale)
    }

    fn from_turns(steady: impl Fn(f64) -> Option<f64>, largest: f64, timescale: f64) -> Self {
        let mut curve = Self::default();
        let end = |side: f64| {
            let is_within = |rate: f64| steady(side * rate).is_some_and(|rudder| side * rudder < largest);
            let (mut within, mut beyond) = (0.0, 0.02 / timescale);
            for _ in 0..DOUBLINGS {
                if !is_within(beyond) {
                    break;
                }
                (within, beyond) = (beyond, 2.0 * beyond);
            }
            for _ in 0..DOUBLINGS {
                let middle = 0.5 * (within + beyond);
                if is_within(middle) { within = middle } else { beyond = middle }
            }
            beyond
        };
        let [port, starboard] = [end(-1.0), end(1.0)];
        for point in -(POINTS as i32)..=POINTS as i32 {
            let share = f64::from(point) / POINTS as f64;
            let rate = share * if share < 0.0 { port } else { starboard };
            if let Some(rudder) = steady(rate) {
                curve.yaw_rate.push(rate);
                curve.rudder.push(rudder);
            }
        }
        curve
    }

    /// Yaw rates at which the curve crosses a rudder (rad) upwards, in their order, rad/s.
    fn rates_at(&self, rudder: f64) -> impl DoubleEndedIterator<Item = f64> {
        let pieces = self.rudder.windows(2).zip(self.yaw_rate.windows(2));
        pieces.filter_map(move |(rudders, rates)| {
            let [below, above] = [rudders[0] - rudder, rudders[1] - rudder];
            let crosses = below <= 0.0 && above >= 0.0 && below < above;
            crosses.then(|| rates[0] - below * (rates[1] - rates[0]) / (above - below))
        })
    }

    /// Yaw rate at a rudder (rad) on the outer branch of that side, rad/s; `None` if the curve does not reach this
    /// rudder.
    pub fn outer_branch(&self, rudder: f64) -> Option<f64> {
        let mut rates = self.rates_at(rudder);
        if rudder < 0.0 { rates.next() } else { rates.next_back() }
    }

    /// Loop of a course-unstable ship; `None` for a stable ship.
    pub fn instability(&self) -> Option<InstabilityLoop> {
        let falls = |pair: &[f64]| pair[1] < pair[0];
        let from = self.rudder.windows(2).position(falls)?;
        let until = self.rudder.windows(2).rposition(falls)? + 1;
        let (high, low) = (self.rudder[from], self.rudder[until]);
        let mut rates = self.rates_at(0.5 * (high + low));
        let first = rates.next()?;
        Some(InstabilityLoop { width: high - low, height: rates.next_back().unwrap_or(first) - first })
    }

    /// Characteristics of a spiral up to this rudder, rad.
    pub(crate) fn figures(&self, rudder: f64) -> Characteristics {
        let instability = self.instability();
        let of_loop = |value: fn(InstabilityLoop) -> f64| Some(to_deg(instability.map_or(0.0, value)));
        Characteristics::from([
            ("rate_starboard_deg_s", self.outer_branch(rudder).map(to_deg)),
            ("rate_port_deg_s", self.outer_branch(-rudder).map(to_deg)),
            ("loop_width_deg", of_loop(|unstable| unstable.width)),
            ("loop_height_deg_s", of_loop(|unstable| unstable.height)),
        ])
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use ship::ResponseModel;
    use ship::effects::listed_effect;

    fn curve(inverse_time: f64) -> SteadyCurve {
        let model = ResponseModel::new(vec![listed_effect("nonlinear_damping", "r³")]);
        let ship = model.with_parameters(vec![inverse_time, 6e-3, 0.0, 300.0]);
        SteadyCurve::from_turns(|rate| ship.steady_rudder(rate), 0.3, 12.0)
    }

    /// a r + n r³ = b δ with a < 0: the loop ends at r = √(−a/3n), δ = ∓(2/3)(−a/b) r, and the outer branches cross
    /// amidships at r = ±√(−a/n).
    #[test]
    fn the_loop_of_an_unstable_ship_is_that_of_its_cubic() {
        let curve = curve(-0.02);
        let unstable = curve.instability().expect("unstable");
        let rate = (0.02f64 / 900.0).sqrt();
        let width = 2.0 * (2.0 / 3.0) * 0.02 / 6e-3 * rate;
        assert!((unstable.width / width - 1.0).abs() < 0.02, "{} {width}", unstable.width);
        assert!((unstable.height / (2.0 * (0.02f64 / 300.0).sqrt()) - 1.0).abs() < 0.02, "{}", unstable.height);
    }

    #[test]
    fn a_stable_ship_has_no_loop() {
        let curve = curve(0.06);
        assert_eq!(curve.instability(), None);
        let rate = curve.outer_branch(0.2).expect("within");
        assert!((0.06 * rate + 300.0 * rate.powi(3) - 6e-3 * 0.2).abs() < 2e-5, "{rate}");
        assert!((curve.outer_branch(-0.2).expect("within") + rate).abs() < 1e-12);
        assert_eq!(curve.outer_branch(0.9), None);
    }
}
