//! Linear indices, straight approach and steady turning of the hulls with three degrees of freedom.

use ship::angle::{KNOT, from_deg, to_deg};
use ship::linear::PrimeSwayYaw;
use ship::ships::{self, kvlcc2, mariner, seiun_like};
use ship::vessel::mmg::Mmg;
use ship::{Particulars, Ship};
use simulate::{Manoeuvre, Side, Simulation, SteeringGear, StreamKey, Vessel};

use super::{Check, INDEPENDENT, Section, Tolerance};

/// Sway-yaw part of the S175 container ship, prime. Source: Son and Nomoto (1982).
const S175: PrimeSwayYaw = PrimeSwayYaw {
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

/// Time after which a turn is steady to far below the last digit, s.
const STEADY: f64 = 3000.0;

fn check(
    id: &str,
    what: String,
    source: &'static str,
    numbers: [f64; 2],
    decimals: usize,
    tolerance: Tolerance,
    unit: &'static str,
) -> Check {
    let [published, ours] = numbers;
    Check { id: format!("hulls/{id}"), what, source, published, decimals, ours, tolerance, unit }
}

/// Half of the last published digit, with a hundredth of it for numbers on the edge.
fn half_digit(decimals: i32) -> Tolerance {
    Tolerance::Absolute(0.51 * 10f64.powi(-decimals))
}

/// The checks: linear indices, revolutions, steady turns.
pub fn section() -> Section {
    let mut checks = linear_indices();
    checks.extend(straight_approach());
    for (ship, turns) in [(mariner::hull(), MARINER_TURNS), (kvlcc2::full_scale(), KVLCC2_TURNS)] {
        for (rudder, rate) in turns {
            let what = format!("{}, steady turn with rudder {rudder} deg: yaw rate", ship.id);
            let numbers = [rate, steady_rate(&ship, rudder)];
            let tolerance = Tolerance::Absolute(1e-3);
            checks.push(check(
                &format!("{}/turn/{rudder}", ship.id),
                what,
                INDEPENDENT,
                numbers,
                3,
                tolerance,
                "deg/s",
            ));
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
    let found = mariner::equations().linearised().indices().expect("the Mariner is course-stable").at(particulars);
    let mut checks = Vec::new();
    let simulator = "Marine Systems Simulator (Fossen), from Chislett and Strøm-Tejsen (1965)";
    for (symbol, ours, rounded, few, exact, many, unit) in [
        ("K", found.K, 0.185, 3, 0.1850, 4, "1/s"),
        ("T1", found.T1, 118.0, 0, 117.98, 2, "s"),
        ("T2", found.T2, 7.8, 1, 7.76, 2, "s"),
        ("T3", found.T3, 18.5, 1, 18.53, 2, "s"),
    ] {
        let what = format!("Mariner, linearised: {symbol}");
        let tolerance = half_digit(few);
        checks.push(check(
            &format!("mariner/rounded/{symbol}"),
            what.clone(),
            simulator,
            [rounded, ours],
            few as usize,
            tolerance,
            unit,
        ));
        checks.push(check(
            &format!("mariner/{symbol}"),
            what,
            INDEPENDENT,
            [exact, ours],
            many,
            half_digit(many as i32),
            unit,
        ));
    }
    let prime = S175.indices().expect("S175 is course-stable");
    for (symbol, published, ours) in
        [("K'", 2.731, prime.K), ("T1'", 4.443, prime.T1), ("T2'", 0.318, prime.T2), ("T3'", 0.789, prime.T3)]
    {
        let what = format!("S175 (Son and Nomoto 1982), linearised: {symbol}");
        checks.push(check(&format!("s175/{symbol}"), what, INDEPENDENT, [published, ours], 3, half_digit(3), ""));
    }
    let at_7 = prime.at(Particulars { length: 175.0, speed: 7.0 });
    for (symbol, published, decimals, ours, unit) in [
        ("K", 0.109, 3, at_7.K, "1/s"),
        ("T1 + T2 − T3", 99.0, 0, at_7.first_order_T(), "s"),
        ("T3", 20.0, 0, at_7.T3, "s"),
    ] {
        let what = format!("S175 at 7 m/s, linearised: {symbol}");
        let tolerance = half_digit(decimals);
        checks.push(check(
            &format!("s175/7-m-s/{symbol}"),
            what,
            INDEPENDENT,
            [published, ours],
            decimals as usize,
            tolerance,
            unit,
        ));
    }
    let particulars = kvlcc2::full_scale().particulars.expect("KVLCC2 has particulars");
    let hull = Mmg::at_speed(kvlcc2::FULL_SCALE, particulars.speed).expect("KVLCC2 balances");
    let found = hull.linearised().indices().expect("KVLCC2 is not exactly neutral").at(particulars);
    checks.push(check(
        "kvlcc2/K-over-T",
        "KVLCC2, linearised: K/T1".into(),
        INDEPENDENT,
        [3.0e-4, found.K / found.T1],
        5,
        half_digit(5),
        "1/s²",
    ));
    checks.push(check(
        "kvlcc2/T",
        "KVLCC2, linearised: size of T1".into(),
        INDEPENDENT,
        [1e5, found.T1.abs()],
        0,
        Tolerance::AtLeast,
        "s",
    ));
    checks
}

fn straight_approach() -> Vec<Check> {
    let hulls = [("kvlcc2", kvlcc2::FULL_SCALE, 15.5, 1.778), ("seiun-like", seiun_like::PARAMETERS, 16.7, 2.438)];
    hulls
        .into_iter()
        .map(|(id, parameters, speed_kn, revolutions)| {
            let hull = Mmg::at_speed(parameters, speed_kn * KNOT).expect("the set balances");
            let what = format!("{id}, straight at {speed_kn} kn: propeller revolutions");
            let numbers = [revolutions, hull.revolutions()];
            check(&format!("{id}/revolutions"), what, INDEPENDENT, numbers, 3, Tolerance::Absolute(1e-3), "1/s")
        })
        .collect()
}

/// Yaw rate, deg/s, at the end of a long turn.
fn steady_rate(ship: &Ship, rudder_deg: f64) -> f64 {
    let side = if rudder_deg < 0.0 { Side::Port } else { Side::Starboard };
    let manoeuvre = Manoeuvre::turning_circle(from_deg(rudder_deg.abs())).to(side).lasting(STEADY);
    let mut simulation = Simulation::new(Vessel::ship(ship), manoeuvre);
    simulation.gear = SteeringGear::with_rate(from_deg(2.32));
    simulation.recording.period = 100.0;
    let truth = simulation.run(&StreamKey::default()).expect("a hull turns").truth;
    to_deg(*truth.yaw_rate.last().expect("a record has rows"))
}

/// The registered ship with this identifier.
pub(super) fn registered(id: &str) -> Ship {
    ships::find(id).expect("a ship of the registry")
}
