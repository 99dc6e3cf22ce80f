//! What nearly every ship does with her rudder hard over: a zig-zag says little of it, and a fitted form may do
//! anything.

use estimation::number::Real;
use ship::angle::DEGREE;
use ship::vessel::prime::PrimeHull;

use super::replayed::replayed;
use super::track::HullTrack;

/// Rudder, rad, and how long it is held, in L/U₀.
const HARD_OVER: f64 = 35.0 * DEGREE;
const HELD: f64 = 12.0;

/// Mean and standard deviation of r L/U in the turn.
///
/// Ships have tactical diameters of 2.5 L to 5 L, which is the limit of IMO MSC.137(76), and about the same diameter
/// 2 U/r in the steady turn: r L/U of 0.4 to 0.8. The hulls of this project lie between 0.29 (Mariner) and 1.14
/// (SEIUN-like, in part estimated), so the interval is twice as wide.
const EXPECTED: [f64; 2] = [0.65, 0.2];

/// A rudder that is put over to either side and held.
#[derive(Debug, Clone)]
pub(super) struct HardTurn([HullTrack; 2]);

impl HardTurn {
    pub fn new() -> Self {
        Self([HARD_OVER, -HARD_OVER].map(|rudder| HullTrack::of_rudder(rudder, HELD)))
    }

    /// How far r L/U, the mean of both sides, is from what is expected, in standard deviations of that.
    pub fn departure<R: Real>(&self, hull: &PrimeHull<R>) -> R {
        let [mean, sd] = EXPECTED;
        (self.curvature(hull) - mean) * (1.0 / sd)
    }

    fn curvature<R: Real>(&self, hull: &PrimeHull<R>) -> R {
        let [starboard, port] = self.0.each_ref().map(|track| {
            let [u, v, r] = replayed(hull, track, track.whole, [1.0, 0.0, 0.0].map(R::from)).end;
            r / u.hypot(v)
        });
        (starboard - port) * 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ship::Input;
    use ship::integrate::RungeKutta4;
    use ship::ships::{Model, Ship};
    use ship::vessel::prime::HullForm;

    /// Published hulls turn as is expected, to within 2.5 standard deviations; so do the forms before any record.
    #[test]
    fn hulls_turn_as_ships_do() {
        let [mean, sd] = EXPECTED;
        let found: Vec<(String, f64)> = ship::ships::all().iter().filter_map(steady).collect();
        assert!(found.len() > 3);
        for (name, found) in found {
            assert!((found - mean).abs() < 2.5 * sd, "{name}: {found}");
        }
        for form in HullForm::of_ship(None) {
            let values: Vec<f64> = form.coefficients().iter().map(|own| own.mean).collect();
            let departure = HardTurn::new().departure(&form.with(&values).expect("a ship"));
            assert!(departure.abs() < 2.5, "{}: {departure}", form.as_str());
        }
    }

    /// r L/U of a hull in the steady turn.
    fn steady(ship: &Ship) -> Option<(String, f64)> {
        let (Model::Hull(hull), Some(own)) = (&ship.model, ship.particulars) else { return None };
        let step = 0.02 * own.length / own.speed;
        let mut state = vec![0.0; hull.dimension()];
        hull.approach(0.0, 0.0, &mut state);
        let mut solver = RungeKutta4::new(hull.dimension());
        for row in 0..600 {
            let input = |_: f64| Input { rudder: HARD_OVER, ..Input::default() };
            solver.step(hull.as_ref(), f64::from(row) * step, step, &mut state, input);
        }
        Some((ship.name.to_string(), state[1] * own.length / f64::hypot(state[2], state[3])))
    }
}
