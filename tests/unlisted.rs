//! The ships of `scenarios/unlisted.toml`: what is simulated is the yaw equation that is meant, by an integrator that
//! shares no code with the project.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use campaign::engine;
use campaign::scenario::{DesignCell, Scenario};
use campaign::shard::TrialId;
use ship::angle::{from_deg, to_deg};
use simulate::Truth;

/// 1/T, 1/s, K, 1/s, and δ_r, rad.
const INVERSE_T: f64 = 1.0 / 16.3;
const K: f64 = 0.1;
const BIAS: f64 = 0.5 * PI / 180.0;

/// Steps of integration between two rows.
const STEPS: usize = 10;

/// The motion: yaw rate (rad/s), heading (rad), way to starboard at 1 m/s (m).
type ShipMotion = [f64; 3];

/// A moment as a rudder angle, deg, of a time, s, a motion, and a rudder, rad.
type Moment = fn(f64, ShipMotion, f64) -> f64;

/// A damping n r |r|^(power − 1) that is a share of r at half a degree a second, as a rudder angle, deg.
fn damping(rate: f64, power: f64, share: f64) -> f64 {
    to_deg(-share * rate * (to_deg(rate).abs() / 0.5).powf(power - 1.0) / K)
}

/// A squall of 30 s about an instant.
fn squall(t: f64, centre: f64) -> f64 {
    (PI * ((t - centre) / 30.0).clamp(-0.5, 0.5)).cos().powi(2)
}

/// The ships with a formula.
const SHIPS: [(&str, Moment); 22] = [
    ("damping of power 1.4", |_, [r, ..], _| damping(r, 1.4, 1.0)),
    ("damping of power 2.5", |_, [r, ..], _| damping(r, 2.5, 0.5)),
    ("damping of power 4", |_, [r, ..], _| damping(r, 4.0, 0.3)),
    ("stall as tanh, 10/10 and 20/20", |_, _, rudder| 25.0 * (to_deg(rudder) / 25.0).tanh() - to_deg(rudder)),
    ("wind with a second harmonic", |_, [_, heading, _], _| {
        3.0 * ((heading - PI / 3.0).sin() + 0.4 * (2.0 * heading - TAU / 3.0).sin())
    }),
    ("damping by side", |_, [r, ..], _| if r > 0.0 { to_deg(-0.25 * r / K) } else { 0.0 }),
    ("bank, 1.5° per 100 m", |_, [.., way], _| 1.5 * 7.0 * way / 100.0),
    ("bank by the square of the way", |_, [.., way], _| 1.6 * (7.0 * way / 100.0).powi(2)),
    ("tug on one side", |_, [_, heading, _], _| 0.24 * to_deg(heading).max(0.0)),
    ("moment with ψ³", |_, [_, heading, _], _| -2.0 * (to_deg(heading) / 10.0).powi(3)),
    ("gradient of a current", |t, [_, heading, _], _| 0.08 * 7.0 * t / 1000.0 * to_deg(heading)),
    ("T that falls by 40 %", |t, [r, ..], rudder| {
        to_deg(f64::from(t >= 150.0) * (1.0 / 0.6 - 1.0) * (rudder + BIAS - r / K))
    }),
    ("K that grows by 30 %", |t, _, rudder| 0.3 * f64::from(t >= 150.0) * to_deg(rudder + BIAS)),
    ("rudder recorded 10 % too small", |t, _, rudder| f64::from(t >= 150.0) * to_deg(rudder / 0.9 - rudder)),
    ("two steps of the moment", |t, _, _| f64::from(t >= 100.0) - 2.0 * f64::from(t >= 200.0)),
    ("two squalls", |t, _, _| 3.0 * (squall(t, 90.0) - squall(t, 210.0))),
    ("moment for a while", |t, _, _| 1.3 * f64::from((100.0..140.0).contains(&t))),
    ("ramp of the moment", |t, _, _| 0.6 * ((t - 100.0) / 60.0).clamp(0.0, 1.0)),
    ("periodic moment", |t, _, _| (TAU * t / 90.0).sin()),
    ("two swells", |t, _, _| 2.2 * ((TAU * t / 70.0).sin() + 0.7 * (TAU * t / 40.0).sin())),
    ("chirp", |t, _, _| 2.3 * (TAU * (t / 120.0 + 0.5 * (1.0 / 40.0 - 1.0 / 120.0) * t * t / 300.0)).sin()),
    ("sawtooth", |t, _, _| 6.0 * (t / 75.0).fract() - 3.0),
];

/// The largest error, deg, of the headings of a run beside those of T r' + r = K (δ + δ_r + moment), by the classical
/// method of Runge and Kutta under the rudder of the run, straight between its rows.
fn largest_error_deg(run: &Truth, moment: Moment) -> f64 {
    let mut motion: ShipMotion = [run.yaw_rate[0], run.heading[0], 0.0];
    let mut largest: f64 = 0.0;
    for row in 1..run.time.len() {
        let (start, rudder) = (run.time[row - 1], run.rudder[row - 1]);
        let (duration, travel) = (run.time[row] - start, run.rudder[row] - rudder);
        let rates = |share: f64, [r, heading, way]: ShipMotion| {
            let acting = rudder + share * travel;
            let moment = from_deg(moment(start + share * duration, [r, heading, way], acting));
            [INVERSE_T * (K * (acting + BIAS + moment) - r), r, (heading - run.heading[0]).sin()]
        };
        let h = duration / STEPS as f64;
        for share in (0..STEPS).map(|step| step as f64 / STEPS as f64) {
            let moved = |by: f64, rates: ShipMotion| std::array::from_fn(|place| motion[place] + by * rates[place]);
            let k1 = rates(share, motion);
            let k2 = rates(share + 0.5 / STEPS as f64, moved(0.5 * h, k1));
            let k3 = rates(share + 0.5 / STEPS as f64, moved(0.5 * h, k2));
            let k4 = rates(share + 1.0 / STEPS as f64, moved(h, k3));
            motion = moved(h / 6.0, std::array::from_fn(|place| k1[place] + 2.0 * (k2[place] + k3[place]) + k4[place]));
        }
        largest = largest.max(to_deg(motion[1] - run.heading[row]).abs());
    }
    largest
}

#[test]
fn every_ship_turns_as_its_equation_says() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/unlisted.toml");
    // Rows so near that the rudder is straight between them, and that a moment changes at one.
    let text = std::fs::read_to_string(&path).expect("a scenario").replace("sampling-s = 1.0", "sampling-s = 0.02");
    let scenario = Scenario::parse(&path, "unlisted", text, None).unwrap_or_else(|failure| panic!("{failure}"));
    let is_first = |(_, cell): &(usize, &DesignCell)| cell.values[1] == Some(0.05);
    let (lags, others) = ([String::from("steering_lag")], scenario.cells.iter().enumerate().filter(is_first));
    let formulas = others.filter(|(_, cell)| !cell.missing_effects().is_empty() && cell.missing_effects() != lags);
    let names: Vec<&str> = formulas.clone().map(|(_, cell)| cell.labels[0].as_str()).collect();
    assert_eq!(names, SHIPS.map(|(name, _)| name), "every formula has its equation");
    for ((cell, _), (name, moment)) in formulas.zip(SHIPS) {
        for run in engine::simulate(&scenario, TrialId { cell, replicate: 0 }).expect("records") {
            let error = largest_error_deg(&run.truth, moment);
            assert!(error < 0.01, "{name}: {error} deg");
        }
    }
}
