//! What nearly every ship does with her rudder hard over: a zig-zag says little of it, and a fitted form may do
//! anything.

use estimation::number::Real;
use ship::angle::DEGREE;
use ship::vessel::prime::PrimeHull;

use super::replayed::replayed;
use super::track::HullTrack;

/// Rudder, rad, and how long it is held, in L/U₀: two circles, after which a turn is steady or runs away.
const HARD_OVER: f64 = 35.0 * DEGREE;
const HELD: f64 = 24.0;

/// Mean and standard deviation of r L/U in the turn.
///
/// Ships have tactical diameters of 2.5 L to 5 L, which is the limit of IMO MSC.137(76), and steady turns of about 0.8
/// of that: r L/U of 0.5 to 1.0. The hulls of this project lie between 0.29 (Mariner) and 1.14 (SEIUN-like, in part
/// estimated), so half of that range is the standard deviation.
const CURVATURE: [f64; 2] = [0.75, 0.25];

/// Mean and standard deviation of −v/r in the turn, L: how far ahead of midship the pivot point lies.
///
/// Shiphandlers have it a quarter to a third of the length behind the stem, 0.17 L to 0.25 L ahead of midship; the
/// five hulls of this project turn about points 0.24 L (SEIUN-like) to 0.42 L (Mariner) ahead.
const PIVOT: [f64; 2] = [0.35, 0.12];

/// A rudder that is put over to either side and held.
#[derive(Debug, Clone)]
pub(super) struct HardTurn([HullTrack; 2]);

impl HardTurn {
    pub fn new() -> Self {
        Self([HARD_OVER, -HARD_OVER].map(|rudder| HullTrack::of_rudder(rudder, HELD)))
    }

    /// How far r L/U and the pivot point, means of both sides, are from what is expected, in standard deviations of
    /// that.
    pub fn departures<R: Real>(&self, hull: &PrimeHull<R>) -> [R; 2] {
        let [starboard, port] = self.0.each_ref().map(|track| {
            let [u, v, r] = replayed(hull, track, track.whole, [1.0, 0.0, 0.0].map(R::from)).end;
            [r / u.hypot(v), -v / r]
        });
        let mean = [(starboard[0] - port[0]) * 0.5, (starboard[1] + port[1]) * 0.5];
        let departure = |own: R, [expected, sd]: [f64; 2]| (own - expected) * (1.0 / sd);
        [departure(mean[0], CURVATURE), departure(mean[1], PIVOT)]
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
        let found: Vec<(String, [f64; 2])> = ship::ships::all().iter().filter_map(steady).collect();
        assert!(found.len() > 3);
        let departs = |own: f64, [mean, sd]: [f64; 2]| (own - mean).abs() > 2.5 * sd;
        for (name, own) in found {
            assert!(!departs(own[0], CURVATURE) && !departs(own[1], PIVOT), "{name}: {own:?}");
        }
        for form in HullForm::of_ship(None) {
            let values: Vec<f64> = form.coefficients().iter().map(|own| own.mean).collect();
            let departures = HardTurn::new().departures(&form.with(&values).expect("a ship"));
            assert!(departures.iter().all(|own| own.abs() < 2.5), "{}: {departures:?}", form.as_str());
        }
    }

    /// r L/U of a hull in the steady turn, and its pivot point ahead of midship in L.
    fn steady(ship: &Ship) -> Option<(String, [f64; 2])> {
        let (Model::Hull(hull), Some(own)) = (&ship.model, ship.particulars) else { return None };
        let step = 0.02 * own.length / own.speed;
        let mut state = vec![0.0; hull.dimension()];
        hull.approach(0.0, 0.0, &mut state);
        let mut solver = RungeKutta4::new(hull.dimension());
        for row in 0..600 {
            let input = |_: f64| Input { rudder: HARD_OVER, ..Input::default() };
            solver.step(hull.as_ref(), f64::from(row) * step, step, &mut state, input);
        }
        let [rate, surge, sway] = [1, 2, 3].map(|place| state[place]);
        Some((ship.name.to_string(), [rate * own.length / surge.hypot(sway), -sway / (rate * own.length)]))
    }
}
