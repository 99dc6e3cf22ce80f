//! Prior of the steady turn with the rudder hard over: a zig-zag hardly determines it, and without this prior a fitted
//! form is arbitrary there.

use estimation::number::Real;
use ship::angle::DEGREE;
use ship::vessel::prime::PrimeHull;

use super::replayed::replay_rows;
use super::track::HullSignals;

/// Rudder angle of the turn, rad.
const RUDDER_RAD: f64 = 35.0 * DEGREE;

/// Time for which the rudder is held, in L/U₀: two circles, after which a turn is steady or diverges.
const DURATION_LENGTHS: f64 = 24.0;

/// Mean and standard deviation of r L/U in the turn.
///
/// Ships have tactical diameters of 2.5 L to 5 L (the limit of IMO MSC.137(76)), and steady turns of about 0.8 of that:
/// r L/U of 0.5 to 1.0. The published hulls of the `ship` crate lie between 0.29 (Mariner) and 1.14 (SEIUN-like, in
/// part estimated), so the standard deviation is half the width of the range of ships.
const CURVATURE: [f64; 2] = [0.75, 0.25];

/// Mean and standard deviation of −v/r in the turn, L: the distance of the pivot point ahead of midship.
///
/// Shiphandlers place it a quarter to a third of the length abaft the stem, 0.17 L to 0.25 L ahead of midship; the five
/// published hulls of the `ship` crate turn about points 0.24 L (SEIUN-like) to 0.42 L (Mariner) ahead.
const PIVOT: [f64; 2] = [0.35, 0.12];

/// Turns with the rudder put over to either side and held.
#[derive(Debug, Clone)]
pub(super) struct HardTurn([HullSignals; 2]);

impl HardTurn {
    pub fn new() -> Self {
        Self([RUDDER_RAD, -RUDDER_RAD].map(|rudder| HullSignals::from_held_rudder(rudder, DURATION_LENGTHS)))
    }

    /// Departures of r L/U and of the pivot point, means of both sides, from their prior, in standard deviations.
    pub fn departures<R: Real>(&self, hull: &PrimeHull<R>) -> [R; 2] {
        let [starboard, port] = self.0.each_ref().map(|signals| {
            let [u, v, r] = replay_rows(hull, signals, signals.whole_record, [1.0, 0.0, 0.0].map(R::from)).end;
            [r / u.hypot(v), -v / r]
        });
        let mean = [(starboard[0] - port[0]) * 0.5, (starboard[1] + port[1]) * 0.5];
        let departure = |value: R, [expected, sd]: [f64; 2]| (value - expected) * (1.0 / sd);
        [departure(mean[0], CURVATURE), departure(mean[1], PIVOT)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ship::ShipInput;
    use ship::integrate::RungeKutta4;
    use ship::ships::{Ship, ShipModel};
    use ship::vessel::prime::HullModel;

    /// Published hulls turn as expected within 2.5 standard deviations, as do the forms before any record.
    #[test]
    fn hulls_turn_as_ships_do() {
        let turns: Vec<(String, [f64; 2])> = ship::ships::all_ships().iter().filter_map(steady).collect();
        assert!(turns.len() > 3);
        let departs = |value: f64, [mean, sd]: [f64; 2]| (value - mean).abs() > 2.5 * sd;
        for (name, figures) in turns {
            assert!(!departs(figures[0], CURVATURE) && !departs(figures[1], PIVOT), "{name}: {figures:?}");
        }
        for form in HullModel::candidates(None) {
            let values: Vec<f64> = form.coefficients().iter().map(|coefficient| coefficient.mean).collect();
            let departures = HardTurn::new().departures(&form.with_coefficients(&values).expect("a ship"));
            assert!(departures.iter().all(|departure| departure.abs() < 2.5), "{}: {departures:?}", form.as_str());
        }
    }

    /// Dimensionless yaw rate r L/U of a hull in the steady turn, and the pivot point ahead of midship, L.
    fn steady(ship: &Ship) -> Option<(String, [f64; 2])> {
        let (ShipModel::Hull(hull), Some(scale)) = (&ship.model, ship.particulars) else { return None };
        let step = 0.02 * scale.length / scale.speed;
        let mut state = vec![0.0; hull.dimension()];
        hull.approach(0.0, 0.0, &mut state);
        let mut solver = RungeKutta4::new(hull.dimension());
        for row in 0..600 {
            let input = |_: f64| ShipInput { rudder: RUDDER_RAD, ..ShipInput::default() };
            solver.step(hull.as_ref(), f64::from(row) * step, step, &mut state, input);
        }
        let [rate, surge, sway] = [1, 2, 3].map(|place| state[place]);
        Some((ship.name.to_string(), [rate * scale.length / surge.hypot(sway), -sway / (rate * scale.length)]))
    }
}
