//! Zig-zags of many nonlinear ships, T r' + r + n₃ r³ = K δ (Norrbin), by Runge–Kutta of order four with a fixed step
//! and a rudder of limited rate: one ship after the other, the plainest way to do it, which batches are held against.
#![expect(non_snake_case, reason = "K_over_T is a ratio of two indices")]

use ship::angle::from_deg;

use crate::batch::{Batch, Norrbin};
use crate::records::{K, PERIOD, ROWS, T};
use crate::work::{Group, Reach, Work};

/// Ships in a batch.
pub const SHIPS: usize = 64;

/// Steps of a trial.
pub const STEPS: usize = ROWS - 1;

/// Rudder and heading of the zig-zag, deg.
pub const ANGLE_DEG: f64 = 10.0;

/// Rate of the rudder, deg/s.
pub const RUDDER_RATE_DEG_S: f64 = 2.5;

/// Time a batch may take, s per step and ship.
const REACH: f64 = 3e-9;

/// Ships around the one of [`crate::records`], no two alike, so that executes come at different times.
pub fn ships(count: usize) -> Vec<Norrbin> {
    let ship = |number: usize| {
        let share = number as f64 / count as f64 - 0.5;
        let inverse_T = 1.0 / (T * (1.0 + 0.4 * share));
        Norrbin {
            inverse_T,
            K_over_T: K * (1.0 - 0.3 * share) * inverse_T,
            cubic: 40.0 * (1.0 + share),
            rudder_bias: 0.0,
        }
    };
    (0..count).map(ship).collect()
}

/// Heading, rad, of one ship after a zig-zag of `steps` steps of `step` s.
pub fn heading_after(ship: &Norrbin, steps: usize, step: f64) -> f64 {
    let (angle, most) = (from_deg(ANGLE_DEG), from_deg(RUDDER_RATE_DEG_S) * step);
    let (mut heading, mut rate, mut rudder, mut order) = (0.0, 0.0, 0.0_f64, angle);
    let acceleration =
        |rate: f64, rudder: f64| ship.K_over_T * rudder - ship.inverse_T * rate - ship.cubic * rate * rate * rate;
    let half = 0.5 * step;
    for _ in 0..steps {
        if heading * order.signum() >= angle {
            order = -order;
        }
        let end = rudder + (order - rudder).clamp(-most, most);
        let middle = 0.5 * (rudder + end);
        let a1 = acceleration(rate, rudder);
        let r2 = rate + half * a1;
        let a2 = acceleration(r2, middle);
        let r3 = rate + half * a2;
        let a3 = acceleration(r3, middle);
        let r4 = rate + step * a3;
        let a4 = acceleration(r4, end);
        heading += step / 6.0 * (rate + 2.0 * (r2 + r3) + r4);
        rate += step / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
        rudder = end;
    }
    heading
}

/// The rows of this module: a batch beside one ship after the other.
pub fn add_rows(group: &mut Group) {
    let fleet = ships(SHIPS);
    let scalar = Work::new(format!("Norrbin, RK4, {SHIPS} ships in turn"), move || {
        fleet.iter().map(|ship| heading_after(ship, STEPS, PERIOD)).sum::<f64>()
    });
    let scalar = group.alone(scalar.of_units(SHIPS * STEPS), None);
    let fleet = ships(SHIPS);
    let batch = Work::new(format!("Norrbin, batch of {SHIPS}"), move || zig_zag(PERIOD).run(&fleet));
    group.beside(batch.of_units(SHIPS * STEPS), &scalar, Some(Reach::Time(REACH)));
}

/// The same zig-zag for a batch, every step kept.
fn zig_zag(step: f64) -> Batch {
    let angle = from_deg(ANGLE_DEG);
    let rate = from_deg(RUDDER_RATE_DEG_S);
    Batch { rudder: angle, heading: angle, rate, step, steps: STEPS, steps_per_row: 1 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::records::record;
    use ship::effects::NonlinearDamping;
    use ship::{Response, ResponseModel};
    use simulate::{Simulation, Vessel};
    use std::sync::Arc;

    /// The batch does what one ship after the other does.
    #[test]
    fn agrees_with_the_batch() {
        let fleet = ships(SHIPS);
        let batched = zig_zag(PERIOD).run(&fleet);
        for (number, ship) in fleet.iter().enumerate() {
            let heading = batched.rows(number).last().expect("rows").heading;
            assert!((heading - heading_after(ship, STEPS, PERIOD)).abs() < 1e-9, "ship {number}");
        }
    }

    /// The plain integration is the ship of the simulator: where no execute falls between two steps the headings agree.
    #[test]
    fn agrees_with_the_simulator() {
        let ship = ships(1)[0];
        let response: Response = ResponseModel::new(vec![Arc::new(NonlinearDamping::Cubic)]).with(vec![
            ship.inverse_T,
            ship.K_over_T,
            0.0,
            ship.cubic,
        ]);
        let simulation = crate::records::first_order_zig_zag(31);
        let sensors = simulate::Sensors::default();
        let trial = record(&Simulation { vessel: Vessel::response(response), sensors, ..simulation });
        for steps in [10, 20, 30] {
            let (own, theirs) = (heading_after(&ship, steps, PERIOD), trial.heading()[steps]);
            assert!((own - theirs).abs() < 1e-6, "{steps} steps: {own} and {theirs} rad");
        }
    }
}
