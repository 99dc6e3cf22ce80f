//! Zig-zags of many Norrbin ships at once, in lanes: what a sweep over thousands of nonlinear ships could cost, where
//! one ship after the other through [`Simulation`](simulate::Simulation) would take an hour.
//!
//! T r' + r + n₃ r³ = K (δ + δ_r) from rest, by Runge–Kutta of order four with one fixed step for all. It is less than
//! a simulation: the helmsman looks at the compass once a step, so that an execute falls on the first step at or beyond
//! its heading (as a helmsman who reads the display so often), the rudder moves in a straight
//! line within a step, and there is neither weather nor instrument.
//!
//! Source of the ship: Norrbin (1963).
#![expect(non_snake_case, reason = "K and T are the symbols of the field")]

use estimation::lanes::Kernel;

/// Ships side by side.
const LANES: usize = 16;

type Lanes = [f64; LANES];

/// A first-order ship with cubic damping: r' = −r/T − (n₃/T) r³ + (K/T) (δ + δ_r).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Norrbin {
    /// 1/T, 1/s.
    pub inverse_T: f64,
    /// K/T, 1/s².
    pub K_over_T: f64,
    /// n₃/T, s/rad².
    pub cubic: f64,
    /// δ_r, rad.
    pub rudder_bias: f64,
}

/// The zig-zag that all ships make, first to starboard, and how finely it is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Batch {
    /// Rudder angle, rad.
    pub rudder: f64,
    /// Heading at which it is reversed, rad.
    pub heading: f64,
    /// Largest rate of the rudder, rad/s.
    pub rate: f64,
    /// Step of the solver and of the helmsman, s.
    pub step: f64,
    /// Steps in all.
    pub steps: usize,
    /// Steps from row to row of what is kept.
    pub steps_per_row: usize,
}

/// What the ships of a batch did: rows `steps_per_row` steps apart, the state of rest at time 0 included.
#[derive(Debug, Clone, PartialEq)]
pub struct Batched {
    rows: usize,
    row_period: f64,
    ships: usize,
    /// Block after block of [`LANES`] ships, row after row.
    states: Vec<Motions>,
    executes: Vec<Vec<f64>>,
}

/// Heading (rad), yaw rate (rad/s) and rudder (rad) of the ships of one block.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Motions {
    heading: Lanes,
    yaw_rate: Lanes,
    rudder: Lanes,
}

/// One row of one ship.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Time from the first execute, s.
    pub time: f64,
    /// Heading, rad.
    pub heading: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate: f64,
    /// Rudder angle, rad.
    pub rudder: f64,
}

impl Batch {
    /// Takes all ships through the zig-zag.
    pub fn run(&self, ships: &[Norrbin]) -> Batched {
        let rows = self.steps / self.steps_per_row + 1;
        let mut batched = Batched {
            rows,
            row_period: self.step * self.steps_per_row as f64,
            ships: ships.len(),
            states: Vec::with_capacity(rows * ships.len().div_ceil(LANES)),
            executes: vec![vec![0.0]; ships.len().next_multiple_of(LANES)],
        };
        for (block, executes) in ships.chunks(LANES).zip(batched.executes.chunks_mut(LANES)) {
            estimation::lanes::run(Sweep { batch: self, ships: block, states: &mut batched.states, executes });
        }
        batched.executes.truncate(ships.len());
        batched
    }
}

impl Batched {
    /// The rows of one ship in the order of time.
    ///
    /// # Panics
    /// When there is no such ship.
    pub fn rows(&self, ship: usize) -> impl Iterator<Item = Row> + '_ {
        assert!(ship < self.ships, "ship {ship} of {}", self.ships);
        let (block, lane) = (ship / LANES, ship % LANES);
        let states = &self.states[block * self.rows..(block + 1) * self.rows];
        let row = move |(row, motions): (usize, &Motions)| Row {
            time: row as f64 * self.row_period,
            heading: motions.heading[lane],
            yaw_rate: motions.yaw_rate[lane],
            rudder: motions.rudder[lane],
        };
        states.iter().enumerate().map(row)
    }

    /// Times of the executes of one ship, s; the first is at 0.
    ///
    /// # Panics
    /// When there is no such ship.
    pub fn executes(&self, ship: usize) -> &[f64] {
        &self.executes[ship]
    }
}

/// The way of one block of ships.
struct Sweep<'a> {
    batch: &'a Batch,
    ships: &'a [Norrbin],
    states: &'a mut Vec<Motions>,
    executes: &'a mut [Vec<f64>],
}

impl Kernel for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { batch, ships, states, executes } = self;
        let Batch { heading: deviation, step, .. } = *batch;
        let (half, sixth, most) = (0.5 * step, step / 6.0, batch.rate * step);
        // Lanes without a ship repeat the last one.
        let of_ship = |value: fn(&Norrbin) -> f64| -> Lanes {
            std::array::from_fn(|lane| value(&ships[lane.min(ships.len() - 1)]))
        };
        let a = of_ship(|ship| ship.inverse_T);
        let b = of_ship(|ship| ship.K_over_T);
        let c = of_ship(|ship| ship.cubic);
        let steady = of_ship(|ship| ship.K_over_T * ship.rudder_bias);
        let mut now = Motions { heading: [0.0; LANES], yaw_rate: [0.0; LANES], rudder: [0.0; LANES] };
        // Side of the rudder, ±1.
        let mut side = [1.0; LANES];
        states.push(now);
        for taken in 0..batch.steps {
            let mut reversals = 0u32;
            let mut reversed = [false; LANES];
            for lane in 0..LANES {
                reversed[lane] = side[lane] * now.heading[lane] >= deviation;
                side[lane] = if reversed[lane] { -side[lane] } else { side[lane] };
                reversals += u32::from(reversed[lane]);
            }
            if reversals > 0 {
                let time = taken as f64 * step;
                let ships = executes.iter_mut().zip(reversed);
                ships.filter(|(_, reversed)| *reversed).for_each(|(executes, _)| executes.push(time));
            }
            for lane in 0..LANES {
                let (r, delta) = (now.yaw_rate[lane], now.rudder[lane]);
                let wanted = side[lane] * batch.rudder - delta;
                let slow = if wanted > most { most } else { wanted };
                let end = delta + if slow < -most { -most } else { slow };
                let middle = 0.5 * (delta + end);
                let acceleration =
                    |r: f64, delta: f64| (b[lane] * delta + steady[lane]) - r * (a[lane] + c[lane] * (r * r));
                let a1 = acceleration(r, delta);
                let r2 = r + half * a1;
                let a2 = acceleration(r2, middle);
                let r3 = r + half * a2;
                let a3 = acceleration(r3, middle);
                let r4 = r + step * a3;
                let a4 = acceleration(r4, end);
                now.heading[lane] += sixth * ((r + r4) + 2.0 * (r2 + r3));
                now.yaw_rate[lane] = r + sixth * ((a1 + a4) + 2.0 * (a2 + a3));
                now.rudder[lane] = end;
            }
            if (taken + 1) % batch.steps_per_row == 0 {
                states.push(now);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use ship::angle::from_deg;
    use ship::effects::NonlinearDamping;
    use ship::{Response, ResponseModel};
    use simulate::{Helmsman, Manoeuvre, Recording, Simulation, Solver, SteeringGear, StreamKey, Vessel};
    use std::sync::Arc;

    const BATCH: Batch = Batch {
        rudder: 10.0 * ship::angle::DEGREE,
        heading: 10.0 * ship::angle::DEGREE,
        rate: 2.5 * ship::angle::DEGREE,
        step: 0.1,
        steps: 3000,
        steps_per_row: 10,
    };

    /// Ships of which no two are alike; one of them is course-unstable, with a loop that its damping closes.
    fn fleet(count: usize) -> Vec<Norrbin> {
        let ship = |number: usize| {
            let share = number as f64 / count as f64;
            let inverse_T = if number == 3 { -0.01 } else { 1.0 / (10.0 + 30.0 * share) };
            let K_over_T = 0.08 / (10.0 + 30.0 * share);
            Norrbin { inverse_T, K_over_T, cubic: 40.0 + 100.0 * share, rudder_bias: from_deg(share) }
        };
        (0..count).map(ship).collect()
    }

    /// The rudder comes to rest on a step, so both ways have the same corners.
    #[test]
    fn a_batch_is_the_simulation_of_each_ship() {
        let ships = fleet(21);
        let batched = BATCH.run(&ships);
        for (number, ship) in ships.iter().enumerate() {
            let response: Response = ResponseModel::new(vec![Arc::new(NonlinearDamping::Cubic)]).with(vec![
                ship.inverse_T,
                ship.K_over_T,
                ship.rudder_bias,
                ship.cubic,
            ]);
            let manoeuvre = Manoeuvre::zig_zag(BATCH.rudder, BATCH.heading);
            let simulation = Simulation {
                gear: SteeringGear::with_rate(BATCH.rate),
                helmsman: Helmsman { reads_display_every: Some(BATCH.step), ..Helmsman::default() },
                recording: Recording { duration: Some(300.0), ..Recording::default() },
                solver: Solver::RungeKutta(BATCH.step),
                ..Simulation::new(Vessel::response(response), manoeuvre)
            };
            let alone = simulation.run(&StreamKey::default()).expect("a zig-zag");
            let rows: Vec<Row> = batched.rows(number).collect();
            assert_eq!(rows.len(), alone.trial.len());
            let executes = batched.executes(number);
            assert_eq!(executes.len(), alone.truth.executes.len());
            for (ours, theirs) in executes.iter().zip(&alone.truth.executes) {
                assert_abs_diff_eq!(*ours, theirs.time, epsilon = 1e-9);
            }
            for (k, row) in rows.iter().enumerate() {
                assert_abs_diff_eq!(row.time, alone.truth.time[k], epsilon = 1e-9);
                assert_abs_diff_eq!(row.heading, alone.truth.heading[k], epsilon = 1e-9);
                assert_abs_diff_eq!(row.yaw_rate, alone.truth.yaw_rate[k], epsilon = 1e-10);
                assert_abs_diff_eq!(row.rudder, alone.truth.rudder[k], epsilon = 1e-9);
            }
        }
    }

    #[test]
    fn company_does_not_matter() {
        let ships = fleet(21);
        let together = BATCH.run(&ships);
        for (number, ship) in ships.iter().enumerate() {
            let alone = BATCH.run(std::slice::from_ref(ship));
            assert!(together.rows(number).eq(alone.rows(0)));
            assert_eq!(together.executes(number), alone.executes(0));
        }
    }

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        struct Whole<'a>(&'a [Norrbin]);
        impl Kernel for Whole<'_> {
            type Output = (Vec<Motions>, Vec<Vec<f64>>);

            #[inline(always)]
            fn call(self) -> Self::Output {
                let (mut states, mut executes) = (Vec::new(), vec![vec![0.0]; LANES]);
                Sweep { batch: &BATCH, ships: self.0, states: &mut states, executes: &mut executes }.call();
                (states, executes)
            }
        }
        let ships = fleet(LANES);
        let found = estimation::lanes::on_every_set(|| Whole(&ships));
        assert!(found.iter().all(|(_, way)| way == &found[0].1), "sets: {:?}", found.iter().map(|(set, _)| set));
    }
}
