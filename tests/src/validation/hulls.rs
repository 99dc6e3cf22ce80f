//! Linear indices, straight approach and steady turning of the hulls with three degrees of freedom.

use ship::angle::{KNOT, from_deg, to_deg};
use ship::linear::PrimeSwayYawMatrices;
use ship::ships::{self, kvlcc2, mariner, seiun_like};
use ship::vessel::mmg::Mmg;
use ship::{Particulars, Ship};
use simulate::{Manoeuvre, Side, SimulatedShip, Simulation, SteeringGear, StreamKey};

use super::{Check, Section, Tolerance};

/// Sway-yaw part of the S175 container ship, prime. Source: Son and Nomoto (1982).
const S175: PrimeSwayYawMatrices = PrimeSwayYawMatrices {
    M: [[0.01497, 0.000_352_5], [0.000_352_5, 0.000_875]],
    N: [[0.012_035, 0.005_22], [0.003_843_6, 0.002_43]],
    b: [-0.002_578, 0.001_26],
};

/// Rudder (deg, starboard positive) and steady yaw rate (deg/s).
const MARINER_TURNS: [(f64, f64); 10] = [
    (1., 0.258),
    (2., 0.317),
    (5., 0.423),
    (10., 0.514),
    (20., 0.594),
    (35., 0.620),
    (-5., -0.346),
    (-10., -0.472),
    (-20., -0.570),
    (-35., -0.601),
];
const KVLCC2_TURNS: [(f64, f64); 10] = [
    (1., 0.111),
    (2., 0.165),
    (5., 0.251),
    (10., 0.327),
    (20., 0.413),
    (35., 0.478),
    (-5., -0.314),
    (-10., -0.372),
    (-20., -0.441),
    (-35., -0.493),
];
const TANKER_TURNS: [(f64, f64); 8] = [
    (5., 0.310),
    (10., 0.364),
    (20., 0.411),
    (35., 0.461),
    (-5., -0.339),
    (-10., -0.380),
    (-20., -0.424),
    (-35., -0.477),
];
const S175_TURNS: [(f64, f64); 4] = [(5., 0.315), (10., 0.428), (20., 0.538), (-35., -0.595)];

/// Time, s, after which a turn is steady to well within the last digit.
const STEADY: f64 = 3000.0;

/// Half of the last published digit, plus a hundredth of it for numbers at the limit.
fn half_digit(decimals: i32) -> Tolerance {
    Tolerance::Absolute(0.51 * 10f64.powi(-decimals))
}

/// Checks of linear indices, revolutions and steady turns.
pub fn section() -> Section {
    let mut checks = linear_indices();
    checks.extend(straight_approach());
    let all: [(&str, &[(f64, f64)]); 4] =
        [("mariner", &MARINER_TURNS), ("kvlcc2", &KVLCC2_TURNS), ("tanker", &TANKER_TURNS), ("s175", &S175_TURNS)];
    for (id, turns) in all {
        let ship = registered(id);
        for &(rudder, rate) in turns {
            let what = format!("{}, steady turn with rudder {rudder} deg: yaw rate", ship.id);
            let (id, ours) = (format!("hulls/{}/turn/{rudder}", ship.id), steady_rate(&ship, rudder));
            checks.push(Check::new(id, what, (rate, 3), ours, Tolerance::Absolute(1e-3), "deg/s"));
        }
    }
    Section {
        title: "Hulls: linear indices and steady turning",
        method: "Linear indices follow from the derivatives by eliminating the sway velocity; steady turns are simulated for 3000 s. \
            Tolerance half a unit of the last digit for indices, one unit for turns and revolutions (a knot of 0.5144 m/s instead \
            of 1852 m an hour moves the fourth digit). Of the rounded indices in the Marine Systems Simulator T2 is 7.8 for 7.76.",
        checks,
    }
}

#[expect(clippy::approx_constant, reason = "T2' of the S175 happens to be near 1/π")]
fn linear_indices() -> Vec<Check> {
    let particulars = mariner::hull().particulars.expect("the Mariner has particulars");
    let found =
        mariner::hull_model().linearised().indices().expect("the Mariner is course-stable").to_dimensional(particulars);
    let mut checks = Vec::new();
    let simulator = "Marine Systems Simulator (Fossen), from Chislett and Strøm-Tejsen (1965)";
    let mut push = |id: &str, what: &str, published, decimals: usize, ours, unit| {
        let tolerance = half_digit(decimals as i32);
        checks.push(Check::new(format!("hulls/{id}"), what, (published, decimals), ours, tolerance, unit));
    };
    for (symbol, ours, exact, decimals, unit) in [
        ("K", found.K, 0.1850, 4, "1/s"),
        ("T1", found.T1, 117.98, 2, "s"),
        ("T2", found.T2, 7.76, 2, "s"),
        ("T3", found.T3, 18.53, 2, "s"),
    ] {
        push(&format!("mariner/{symbol}"), &format!("Mariner, linearised: {symbol}"), exact, decimals, ours, unit);
    }
    let prime = S175.indices().expect("S175 is course-stable");
    for (symbol, published, ours) in
        [("K'", 2.731, prime.K), ("T1'", 4.443, prime.T1), ("T2'", 0.318, prime.T2), ("T3'", 0.789, prime.T3)]
    {
        let what = format!("S175 (Son and Nomoto 1982), linearised: {symbol}");
        push(&format!("s175/{symbol}"), &what, published, 3, ours, "");
    }
    let at_7 = prime.to_dimensional(Particulars { length: 175.0, speed: 7.0 });
    for (symbol, published, decimals, ours, unit) in [
        ("K", 0.109, 3, at_7.K, "1/s"),
        ("T1 + T2 − T3", 99.0, 0, at_7.first_order_T(), "s"),
        ("T3", 20.0, 0, at_7.T3, "s"),
    ] {
        let what = format!("S175 at 7 m/s, linearised: {symbol}");
        push(&format!("s175/7-m-s/{symbol}"), &what, published, decimals, ours, unit);
    }
    let particulars = kvlcc2::full_scale().particulars.expect("KVLCC2 has particulars");
    let hull = Mmg::at_speed(kvlcc2::FULL_SCALE, particulars.speed).expect("KVLCC2 balances");
    let tanker = hull.linearised().indices().expect("KVLCC2 is not exactly neutral").to_dimensional(particulars);
    push("kvlcc2/K-over-T", "KVLCC2, linearised: K/T1", 3.0e-4, 5, tanker.K / tanker.T1, "1/s²");
    let what = "KVLCC2, linearised: size of T1";
    checks.push(Check::new("hulls/kvlcc2/T", what, (1e5, 0), tanker.T1.abs(), Tolerance::AtLeast, "s"));
    for (symbol, ours, rounded, decimals, unit) in [
        ("K", found.K, 0.185, 3, "1/s"),
        ("T1", found.T1, 118.0, 0, "s"),
        ("T2", found.T2, 7.8, 1, "s"),
        ("T3", found.T3, 18.5, 1, "s"),
    ] {
        let (id, what) = (format!("hulls/mariner/rounded/{symbol}"), format!("Mariner, linearised: {symbol}"));
        let tolerance = half_digit(decimals as i32);
        checks.push(Check::new(id, what, (rounded, decimals), ours, tolerance, unit).from(simulator));
    }
    checks
}

fn straight_approach() -> impl Iterator<Item = Check> {
    let hulls = [("kvlcc2", kvlcc2::FULL_SCALE, 15.5, 1.778), ("seiun-like", seiun_like::PARAMETERS, 16.7, 2.438)];
    hulls.into_iter().map(|(id, parameters, speed_kn, revolutions)| {
        let hull = Mmg::at_speed(parameters, speed_kn * KNOT).expect("the set balances");
        let what = format!("{id}, straight at {speed_kn} kn: propeller revolutions");
        let (id, ours) = (format!("hulls/{id}/revolutions"), hull.revolutions());
        Check::new(id, what, (revolutions, 3), ours, Tolerance::Absolute(1e-3), "1/s")
    })
}

/// Yaw rate, deg/s, at the end of a long turn.
fn steady_rate(ship: &Ship, rudder_deg: f64) -> f64 {
    let side = if rudder_deg < 0.0 { Side::Port } else { Side::Starboard };
    let manoeuvre = Manoeuvre::turning_circle(from_deg(rudder_deg.abs())).with_first_side(side).lasting(STEADY);
    let mut simulation = Simulation::new(SimulatedShip::from_ship(ship), manoeuvre);
    simulation.gear = SteeringGear::with_rate(from_deg(2.32));
    simulation.recording.sampling_period = 100.0;
    let truth = simulation.run(&StreamKey::default()).expect("a hull turns").truth;
    to_deg(*truth.yaw_rate.last().expect("a record has rows"))
}

/// Ship of the registry with this identifier.
pub(super) fn registered(id: &str) -> Ship {
    ships::find_ship(id).expect("a ship of the registry")
}
