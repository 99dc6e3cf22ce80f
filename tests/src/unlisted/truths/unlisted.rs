//! What is on no list as it is, and what a list holds one of where there are two.

use std::f64::consts::{PI, TAU};

use document::trace::Dependence;
use ship::angle::to_deg;

use super::{A, FIRST_ORDER, Kind, Motion, Times, Truth, moved, steered, turning};

/// Instants at which something changes, s.
const HALF_TIME: f64 = 150.0;
const STEPS: [f64; 2] = [100.0, 200.0];
const SQUALLS: [f64; 2] = [90.0, 210.0];
const WHILE: [f64; 2] = [100.0, 140.0];
const RAMP: [f64; 2] = [100.0, 160.0];

/// Duration of a squall, s.
const SQUALL: f64 = 30.0;

/// Duration of a record, s.
const DURATION: f64 = 300.0;

/// How long the memory of a hysteresis takes to turn, s.
const TURNED: f64 = 0.2;

/// Speed of the ship, m/s.
const SPEED: f64 = 7.0;

const fn depends_on(depends_on: Dependence) -> Kind {
    Kind::Unlisted { depends_on, times: Times::Always }
}

const fn at(instants: &'static [f64]) -> Kind {
    Kind::Unlisted { depends_on: Dependence::Time, times: Times::Instants(instants) }
}

const fn with_periods(from: f64, to: f64) -> Kind {
    Kind::Unlisted { depends_on: Dependence::Time, times: Times::Periods([from, to]) }
}

/// Ships whose moment depends on what they do.
pub const OF_SHIP: [Truth; 6] = [
    Truth {
        name: "bank",
        equation: "T r' + r = K (δ + δ_r + c y), y' = 7 m/s sin ψ, c = 1.5 deg per 100 m",
        kind: depends_on(Dependence::Way),
        rates: |t, x, rudder| aside(x, rudder(t), 0.015 * x.state),
        ..FIRST_ORDER
    },
    Truth {
        name: "bank by the square of the way",
        equation: "T r' + r = K (δ + δ_r + c y²), y' = 7 m/s sin ψ, c = 1.6 deg per (100 m)²",
        kind: depends_on(Dependence::Way),
        rates: |t, x, rudder| aside(x, rudder(t), 1.6e-4 * x.state * x.state),
        ..FIRST_ORDER
    },
    Truth {
        name: "tug on one side",
        equation: "T r' + r = K (δ + δ_r + c max(ψ, 0)), c = 0.24",
        kind: depends_on(Dependence::Heading),
        rates: |t, x, rudder| moved(x, rudder(t), 0.24 * to_deg(x.heading).max(0.0)),
        ..FIRST_ORDER
    },
    Truth {
        name: "moment with ψ³",
        equation: "T r' + r = K (δ + δ_r − c ψ³), c = 2 deg per (10 deg)³",
        kind: depends_on(Dependence::Heading),
        rates: |t, x, rudder| moved(x, rudder(t), -2e-3 * to_deg(x.heading).powi(3)),
        ..FIRST_ORDER
    },
    Truth {
        name: "gradient of a current",
        equation: "T r' + r = K (δ + δ_r + c x ψ), x' = 7 m/s cos ψ, c = 0.08 per km",
        kind: depends_on(Dependence::Heading),
        rates: |t, x, rudder| Motion {
            state: SPEED * x.heading.cos(),
            ..moved(x, rudder(t), 8e-5 * x.state * to_deg(x.heading))
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "hysteresis of K",
        equation: "T r' + r = K ((1 + 0.7 h) δ + δ_r), h = 1 after |δ| has grown, −1 after it has fallen, 0.2 s late",
        kind: depends_on(Dependence::History),
        rates: |t, x, rudder| {
            let growth = rudder(t).abs() - rudder(t - TURNED).abs();
            let turned = if growth.abs() < 1e-9 { 0.0 } else { (growth.signum() - x.state) / TURNED };
            turning(x, steered((1.0 + 0.7 * x.state) * rudder(t)) - A * x.rate, turned)
        },
        ..FIRST_ORDER
    },
];

/// Ships whose moment or response depends on time.
pub const OF_TIME: [Truth; 12] = [
    Truth {
        name: "T that falls by 40 %",
        equation: "T r' + r = K (δ + δ_r), T = 9.8 s after 150 s",
        kind: at(&[HALF_TIME]),
        rates: |t, x, rudder| turning(x, after_half(t, 1.0 / 0.6) * (steered(rudder(t)) - A * x.rate), 0.0),
        ..FIRST_ORDER
    },
    Truth {
        name: "K that grows by 30 %",
        equation: "T r' + r = K (δ + δ_r), K = 0.13 1/s after 150 s",
        kind: at(&[HALF_TIME]),
        rates: |t, x, rudder| turning(x, after_half(t, 1.3) * steered(rudder(t)) - A * x.rate, 0.0),
        ..FIRST_ORDER
    },
    Truth {
        name: "gain of the rudder sensor",
        equation: "T r' + r = K (δ + δ_r), δ recorded as 0.9 δ after 150 s",
        kind: at(&[HALF_TIME]),
        rudder_gain: |t| after_half(t, 0.9),
        ..FIRST_ORDER
    },
    Truth {
        name: "delay of the rudder",
        equation: "T r' + r = K (δ + δ_r), δ(t − 3 s) for δ after 150 s",
        kind: at(&[HALF_TIME]),
        rates: |t, x, rudder| moved(x, rudder(if t < HALF_TIME { t } else { t - 3.0 }), 0.0),
        ..FIRST_ORDER
    },
    Truth {
        name: "two steps of the moment",
        equation: "T r' + r = K (δ + δ_r + m(t)), m = 0, 1 deg after 100 s, −1 deg after 200 s",
        kind: at(&STEPS),
        rates: |t, x, rudder| {
            let step = |at: f64| if t < at { 0.0 } else { 1.0 };
            moved(x, rudder(t), step(STEPS[0]) - 2.0 * step(STEPS[1]))
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "two squalls",
        equation: "T r' + r = K (δ + δ_r + m(t)), m = 3 deg cos² over 30 s about 90 s, −3 deg about 210 s",
        kind: at(&SQUALLS),
        rates: |t, x, rudder| {
            let squall = |centre: f64| {
                let phase = (t - centre) / SQUALL;
                if phase.abs() < 0.5 { (PI * phase).cos().powi(2) } else { 0.0 }
            };
            moved(x, rudder(t), 3.0 * (squall(SQUALLS[0]) - squall(SQUALLS[1])))
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "moment for a while",
        equation: "T r' + r = K (δ + δ_r + m(t)), m = 1.3 deg from 100 to 140 s",
        kind: at(&WHILE),
        rates: |t, x, rudder| moved(x, rudder(t), if (WHILE[0]..WHILE[1]).contains(&t) { 1.3 } else { 0.0 }),
        ..FIRST_ORDER
    },
    Truth {
        name: "ramp of the moment",
        equation: "T r' + r = K (δ + δ_r + m(t)), m rises from 0 to 0.6 deg from 100 to 160 s",
        kind: at(&RAMP),
        rates: |t, x, rudder| moved(x, rudder(t), 0.6 * ((t - RAMP[0]) / (RAMP[1] - RAMP[0])).clamp(0.0, 1.0)),
        ..FIRST_ORDER
    },
    Truth {
        name: "periodic moment",
        equation: "T r' + r = K (δ + δ_r + m sin(2π t/90 s)), m = 1 deg",
        kind: with_periods(90.0, 90.0),
        rates: |t, x, rudder| moved(x, rudder(t), (TAU * t / 90.0).sin()),
        ..FIRST_ORDER
    },
    Truth {
        name: "two swells",
        equation: "T r' + r = K (δ + δ_r + m (sin(2π t/70 s) + 0.7 sin(2π t/40 s))), m = 2.2 deg",
        kind: with_periods(40.0, 70.0),
        rates: |t, x, rudder| moved(x, rudder(t), 2.2 * ((TAU * t / 70.0).sin() + 0.7 * (TAU * t / 40.0).sin())),
        ..FIRST_ORDER
    },
    Truth {
        name: "chirp",
        equation: "T r' + r = K (δ + δ_r + m sin φ), φ'/2π from 1/120 Hz to 1/40 Hz in 300 s, m = 2.3 deg",
        kind: with_periods(40.0, 120.0),
        rates: |t, x, rudder| {
            let turns = t / 120.0 + 0.5 * (1.0 / 40.0 - 1.0 / 120.0) * t * t / DURATION;
            moved(x, rudder(t), 2.3 * (TAU * turns).sin())
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "sawtooth",
        equation: "T r' + r = K (δ + δ_r + m(t)), m from −3 to 3 deg in every 75 s",
        kind: with_periods(75.0, 75.0),
        rates: |t, x, rudder| moved(x, rudder(t), 6.0 * (t / 75.0).fract() - 3.0),
        ..FIRST_ORDER
    },
];

/// One before half of the record, then a share.
fn after_half(t: f64, share: f64) -> f64 {
    if t < HALF_TIME { 1.0 } else { share }
}

/// Rates of a first-order ship whose state is the way to starboard, m, under a rudder (rad) and a moment, deg.
fn aside(x: Motion, rudder: f64, moment_deg: f64) -> Motion {
    Motion { state: SPEED * x.heading.sin(), ..moved(x, rudder, moment_deg) }
}
