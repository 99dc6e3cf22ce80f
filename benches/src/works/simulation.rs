//! Simulation of trials.

use rand::RngExt;
use rand_distr::StandardNormal;
use ship::ships;
use simulate::{PreparedSimulation, RngPurpose, SimulatedShip, Simulation, Solver, StreamKey};

use crate::records::{KEY, ROWS, damped_zig_zag, first_order_zig_zag};
use crate::work::{Reach, Work, WorkGroup};

/// Random numbers of a trial, without its simulation: heading noise and gyro noise of every row.
fn bare_draws(key: &StreamKey, rows: usize) -> [Vec<f64>; 2] {
    [RngPurpose::Heading, RngPurpose::YawRate].map(|purpose| {
        let mut rng = key.rng(purpose);
        (0..rows).map(|_| rng.sample(StandardNormal)).collect()
    })
}

/// Benchmarks of trials of one ship, and of many ships at once.
pub fn simulation() -> WorkGroup {
    let mut group = WorkGroup::new(
        "simulate",
        "Simulation",
        "A 10/10 zig-zag of 600 s, 1201 rows, with heading and gyro noise, on one core. Beside it stand its random numbers \
         alone (ChaCha8, standard normal): nothing with that noise can be cheaper. A trial of a study shares the motion of its ship \
         with the other trials of its cell, where chance moves nothing but the instruments; a trial on its own makes it anew, \
         and so do all others.",
    );
    let draws = group.alone(Work::new("bare draws, 2 x 1201", || bare_draws(&KEY, ROWS)), None);
    let simulated = |name: &str, simulation: Simulation| Work::new(name, move || simulation.run(&KEY));
    let closed_form = first_order_zig_zag(ROWS);
    let integrated = Simulation { solver: Solver::RungeKutta(0.1), ..closed_form.clone() };
    let kvlcc2 = ships::find_ship("kvlcc2").expect("a ship of the registry");
    let hull = Simulation { ship: SimulatedShip::from_ship(&kvlcc2), ..closed_form.clone() };
    let prepared = PreparedSimulation::new(closed_form.clone()).expect("a zig-zag");
    let of_a_study = Work::new("first order, trial of a study", move || prepared.run(&KEY));
    group.beside(of_a_study, &draws, Some(Reach::Ratio(1.5)));
    group.beside(simulated("first order, on its own", closed_form), &draws, None);
    group.beside(simulated("first order, Runge-Kutta 0.1 s", integrated), &draws, None);
    group.beside(simulated("cubic damping, Runge-Kutta", damped_zig_zag(ROWS)), &draws, None);
    group.beside(simulated("KVLCC2", hull), &draws, None);
    group
}
