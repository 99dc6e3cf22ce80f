//! What the ships of this study are: each a yaw equation written out here. None of them is an effect of the project or
//! shares code with one.

mod listed;
mod unlisted;

use document::trace::Dependence;
use ship::angle::from_deg;

/// 1/T, 1/s: T = 16.3 s.
const A: f64 = 1.0 / 16.3;

/// K/T, 1/s²: K = 0.1 1/s.
const B: f64 = 0.1 / 16.3;

/// Rudder bias δ_r, deg.
const BIAS_DEG: f64 = 0.5;

/// Yaw rate (rad/s), heading (rad), and a state that the truth has beside them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Yaw rate r, rad/s.
    pub rate: f64,
    /// Heading ψ, rad.
    pub heading: f64,
    /// What the truth makes of it: a speed ratio, an angle, a distance.
    pub state: f64,
}

/// When something that is on no list acts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Times {
    /// All the time.
    Always,
    /// Something changes at, or passes about, each of these instants, s.
    Instants(&'static [f64]),
    /// With periods from one to another, s.
    Periods([f64; 2]),
}

/// What the truth is to a trace, and what is right to say of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// Listed physics in another formula.
    Listed {
        /// Identifiers that are right.
        right: &'static [&'static str],
        /// Identifiers that count as an alias.
        alias: &'static [&'static str],
    },
    /// On no list.
    Unlisted {
        /// What the moment depends on.
        depends_on: Dependence,
        /// When it acts.
        times: Times,
    },
    /// A first-order ship: nothing is missing.
    Nothing {
        /// Whether chance turns the ship or its recorded rudder, so that a random moment is right as well.
        disturbed: bool,
    },
}

/// A ship.
#[derive(Debug, Clone, Copy)]
pub struct Truth {
    /// Its name on the page.
    pub name: &'static str,
    /// Its equation.
    pub equation: &'static str,
    /// What it is to a trace.
    pub kind: Kind,
    /// Rudder and heading of its zig-zags, deg: a record each, traced together.
    pub zig_zags_deg: &'static [f64],
    /// Its state on the approach.
    pub approach: f64,
    /// Rates of the motion at a time (s) under a rudder (rad), whose past it may ask for.
    pub rates: fn(f64, Motion, &dyn Fn(f64) -> f64) -> Motion,
    /// The heading that the compass shows, rad.
    pub shown: fn(Motion) -> f64,
    /// Recorded rudder over the rudder at a time, s.
    pub rudder_gain: fn(f64) -> f64,
    /// Standard deviation of the white noise of the recorded rudder, deg.
    pub rudder_noise_deg: f64,
    /// What a random walk of the moment, as a rudder angle, adds in a second: its standard deviation, deg.
    pub walk_deg: f64,
}

/// A first-order ship in a zig-zag 10/10.
const FIRST_ORDER: Truth = Truth {
    name: "first order",
    equation: "T r' + r = K (δ + δ_r)",
    kind: Kind::Nothing { disturbed: false },
    zig_zags_deg: &[10.0],
    approach: 0.0,
    rates: |t, x, rudder| turning(x, steered(rudder(t)) - A * x.rate, 0.0),
    shown: |x| x.heading,
    rudder_gain: |_| 1.0,
    rudder_noise_deg: 0.0,
    walk_deg: 0.0,
};

/// Ships that lack nothing.
const NOTHING: [Truth; 3] = [
    FIRST_ORDER,
    Truth {
        name: "first order, noisy rudder",
        equation: "T r' + r = K (δ + δ_r), white noise of 0.2 deg in the recorded rudder",
        kind: Kind::Nothing { disturbed: true },
        rudder_noise_deg: 0.2,
        ..FIRST_ORDER
    },
    Truth {
        name: "first order, random walk",
        equation: "T r' + r = K (δ + δ_r + m(t)), m a random walk of 0.05 deg/√s",
        kind: Kind::Nothing { disturbed: true },
        walk_deg: 0.05,
        ..FIRST_ORDER
    },
];

/// All ships: other formulas first, then what is on no list, then nothing.
pub fn all() -> Vec<Truth> {
    [&listed::ALL[..], &unlisted::OF_SHIP, &unlisted::OF_TIME, &NOTHING].concat()
}

impl Truth {
    /// The same without chance in the moment and in the recorded rudder.
    pub fn without_chance(self) -> Self {
        Self { rudder_noise_deg: 0.0, walk_deg: 0.0, ..self }
    }
}

/// (K/T) (δ + δ_r), rad/s².
fn steered(rudder: f64) -> f64 {
    B * (rudder + from_deg(BIAS_DEG))
}

/// Rates of a motion with this yaw acceleration, rad/s², and rate of its state.
fn turning(x: Motion, acceleration: f64, state: f64) -> Motion {
    Motion { rate: acceleration, heading: x.rate, state }
}

/// Rates of a first-order ship under a rudder (rad) and a moment that is worth so much of it, deg.
fn moved(x: Motion, rudder: f64, moment_deg: f64) -> Motion {
    turning(x, steered(rudder + from_deg(moment_deg)) - A * x.rate, 0.0)
}
