//! Simulates a 10/10 zig-zag of a ship with given K and T, and prints the errors of K and T of every method.

use std::error::Error;

use kempf::prelude::*;

fn main() -> Result<(), Box<dyn Error>> {
    let truth = FirstOrder::from_indices(0.1, 16.3, from_deg(0.5));
    let zig_zag = Manoeuvre::zig_zag(from_deg(10.0), from_deg(10.0)).until_execute(6);
    let mut simulation = Simulation::new(SimulatedShip::from_first_order(truth), zig_zag);
    simulation.gear = SteeringGear::with_rate(from_deg(2.5));
    simulation.sensors.heading_noise = from_deg(0.1);
    let record = simulation.run(&StreamKey { seed: 1957, cell: 0, replicate: 0 })?.trial;

    println!("{:24} {:>8} {:>8}  95 % interval of T [s]", "method", "K error", "T error");
    for settings in registry::default_settings() {
        let method = settings.build()?;
        let estimate = match method.identify(std::slice::from_ref(&record)) {
            Ok(estimate) => estimate,
            Err(error) => {
                println!("{:24} {error}", method.id());
                continue;
            }
        };
        let error = |value: f64, truth: f64| 100.0 * (value / truth - 1.0);
        let (k, t) = (error(estimate.K().value, truth.K()), error(estimate.T().value, truth.T()));
        let interval = estimate.T().ci95.map_or("none".to_owned(), |[low, high]| format!("[{low:.2}, {high:.2}]"));
        println!("{:24} {k:7.2}% {t:7.2}%  {interval}", method.id());
    }
    Ok(())
}
