//! Next trials that could be run with the fitted ship: standard manoeuvres, simulated without noise.

use ::trace::Analysis;
use ship::angle::{from_deg, to_deg};
use simulate::{Manoeuvre, Side, SimulatedShip, Simulation, SteeringGear, StreamKey};
use trial::Trial;

/// Candidate zig-zags: rudder angle and heading angle, deg. Each is planned with the first execute to either side.
const ZIGZAGS: [[f64; 2]; 6] = [[5.0, 5.0], [10.0, 10.0], [10.0, 20.0], [20.0, 10.0], [20.0, 20.0], [30.0, 30.0]];

/// Number of executes of a planned zig-zag.
const EXECUTES: usize = 5;

/// Range of rudder rates of a steering gear, deg/s; outside it a recorded rudder does not determine its gear.
const GEAR_RATES_DEG_S: [f64; 2] = [1.0, 20.0];

/// Maximum duration of a planned trial, in durations of the longest record.
const MAX_DURATIONS: f64 = 3.0;

/// Manoeuvres that the fitted ship completes, each with its name and its simulated record. Sampling and rudder rate are
/// those of the first record.
pub fn planned_trials(analysis: &Analysis, records: &[Trial]) -> Vec<(String, Trial)> {
    let longest = records.iter().map(Trial::duration).fold(0.0, f64::max);
    let zigzags = ZIGZAGS.into_iter().flat_map(|[rudder, heading]| {
        [(Side::Starboard, ""), (Side::Port, ", first execute to port")].map(|(first, suffix)| {
            let zigzag =
                Manoeuvre::zig_zag(from_deg(rudder), from_deg(heading)).with_first_side(first).until_execute(EXECUTES);
            (format!("{rudder:.0}/{heading:.0} zig-zag{suffix}"), zigzag)
        })
    });
    let turn = Manoeuvre::turning_circle(from_deg(35.0)).lasting(0.5 * longest);
    let pull_out = Manoeuvre::PullOut {
        rudder: from_deg(20.0),
        side: Side::Starboard,
        hold: 0.4 * longest,
        duration: 0.4 * longest,
    };
    let turn = (String::from("35° turning circle"), turn);
    let pull_out = (String::from("pull-out after 20° of rudder"), pull_out);
    zigzags
        .chain([turn, pull_out])
        .filter_map(|(name, manoeuvre)| Some((name, sailed(analysis, records, manoeuvre)?)))
        .collect()
}

/// Simulated record of the fitted ship in one manoeuvre, with the sampling and the rudder rate of the first record;
/// `None` if it does not complete the manoeuvre.
fn sailed(analysis: &Analysis, records: &[Trial], manoeuvre: Manoeuvre) -> Option<Trial> {
    let longest = records.iter().map(Trial::duration).fold(0.0, f64::max);
    let mut simulation = Simulation::new(SimulatedShip::from_response(analysis.ship()), manoeuvre);
    simulation.gear = SteeringGear::with_rate(rudder_rate(&records[0]));
    simulation.recording.sampling_period = records[0].sampling_period();
    simulation.longest_wait = MAX_DURATIONS * longest;
    let trial = simulation.run(&StreamKey { seed: 0, cell: 0, replicate: 0 }).ok()?.trial;
    let is_manoeuvre = trial.duration() <= MAX_DURATIONS * longest && trial.heading().iter().all(|psi| psi.abs() < 1e3);
    is_manoeuvre.then_some(trial)
}

/// Rudder rate of a record, rad/s: the 98 % quantile between rows, within the usual rates of steering gears.
fn rudder_rate(record: &Trial) -> f64 {
    let (time, rudder) = (record.time(), record.rudder());
    let mut rates: Vec<f64> =
        (1..record.len()).map(|row| ((rudder[row] - rudder[row - 1]) / (time[row] - time[row - 1])).abs()).collect();
    rates.sort_by(f64::total_cmp);
    let high = rates[(rates.len() - 1) * 98 / 100];
    let [slowest, fastest] = GEAR_RATES_DEG_S;
    from_deg(to_deg(high).clamp(slowest, fastest))
}
