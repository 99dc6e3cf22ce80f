//! What the ships of this study are: each a yaw equation written out here. None of them is an effect of the project or
//! shares code with one.

use ship::angle::from_deg;

/// 1/T, 1/s: T = 16.3 s.
const A: f64 = 1.0 / 16.3;

/// K/T, 1/s²: K = 0.1 1/s.
const B: f64 = 0.1 / 16.3;

/// Rudder bias δ_r, deg.
const BIAS_DEG: f64 = 0.5;

/// Yaw rate at which the share of a nonlinear damping is told, deg/s.
const RATE_DEG: f64 = 0.5;

/// Instants at which something changes, s.
const HALF_TIME: f64 = 150.0;
const STEPS: [f64; 2] = [100.0, 200.0];
const SQUALLS: [f64; 2] = [90.0, 210.0];

/// Duration of a squall, s.
const SQUALL: f64 = 30.0;

/// Period of the periodic moment, s.
const PERIOD: f64 = 90.0;

/// Yaw rate (rad/s), heading (rad), and a state that is each truth's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Yaw rate r, rad/s.
    pub rate: f64,
    /// Heading ψ, rad.
    pub heading: f64,
    /// What the truth makes of it: a speed ratio, an angle, a distance.
    pub own: f64,
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
        /// Instants, s, at which something changes; empty where nothing does.
        changes: &'static [f64],
    },
    /// A first-order ship: nothing is missing.
    Nothing,
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
    /// Dead time of the rudder, s.
    pub dead_time: f64,
    /// Its own state on the approach.
    pub approach: f64,
    /// Rates of the motion at a time (s) under a rudder (rad).
    pub rates: fn(f64, Motion, f64) -> Motion,
    /// The heading that the compass shows, rad.
    pub shown: fn(Motion) -> f64,
}

/// A first-order ship in a zig-zag 10/10.
const FIRST_ORDER: Truth = Truth {
    name: "first order",
    equation: "T r' + r = K (δ + δ_r)",
    kind: Kind::Nothing,
    zig_zags_deg: &[10.0],
    dead_time: 0.0,
    approach: 0.0,
    rates: |_, x, rudder| turning(x, steered(rudder) - A * x.rate, 0.0),
    shown: |x| x.heading,
};

const DAMPING: Kind = Kind::Listed { right: &["nonlinear_damping"], alias: &[] };
const LATE: Kind = Kind::Listed { right: &["steering_lag", "second_order"], alias: &[] };

/// All ships: other formulas first, then what is on no list, then nothing.
pub const ALL: [Truth; 16] = [
    Truth {
        name: "damping of power 1.4",
        equation: "T r' + r + n r |r|^0.4 = K (δ + δ_r), n r |r|^0.4 = r at 0.5 deg/s; a 20/20",
        kind: DAMPING,
        zig_zags_deg: &[20.0],
        rates: |_, x, rudder| turning(x, steered(rudder) - A * (x.rate + power(x.rate, 1.4, 1.0)), 0.0),
        ..FIRST_ORDER
    },
    Truth {
        name: "damping of power 2.5",
        equation: "T r' + r + n r |r|^1.5 = K (δ + δ_r), n r |r|^1.5 = 0.5 r at 0.5 deg/s",
        kind: DAMPING,
        rates: |_, x, rudder| turning(x, steered(rudder) - A * (x.rate + power(x.rate, 2.5, 0.5)), 0.0),
        ..FIRST_ORDER
    },
    Truth {
        name: "damping of power 4",
        equation: "T r' + r + n r |r|³ = K (δ + δ_r), n r |r|³ = 0.3 r at 0.5 deg/s",
        kind: DAMPING,
        rates: |_, x, rudder| turning(x, steered(rudder) - A * (x.rate + power(x.rate, 4.0, 0.3)), 0.0),
        ..FIRST_ORDER
    },
    Truth {
        name: "stall as tanh",
        equation: "T r' + r = K (δ_s tanh(δ/δ_s) + δ_r), δ_s = 25 deg; a 10/10 and a 20/20 together",
        kind: Kind::Listed { right: &["rudder_saturation"], alias: &[] },
        zig_zags_deg: &[10.0, 20.0],
        rates: |_, x, rudder| {
            let stall = from_deg(25.0);
            turning(x, steered(stall * (rudder / stall).tanh()) - A * x.rate, 0.0)
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "wind with a second harmonic",
        equation: "T r' + r = K (δ + δ_r + w (sin(ψ − β) + 0.4 sin 2(ψ − β))), w = 3 deg, β = 60 deg",
        kind: Kind::Listed { right: &["wind_moment"], alias: &[] },
        rates: |_, x, rudder| {
            let off = x.heading - from_deg(60.0);
            let wind = from_deg(3.0) * (off.sin() + 0.4 * (2.0 * off).sin());
            turning(x, steered(rudder + wind) - A * x.rate, 0.0)
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "speed loss by its square",
        equation: "r' = −(q/T) r + (K/T) q² (δ + δ_r), q' = (1 − q²)/T_u − c r², T_u = 60 s, c = 40 s/rad²",
        kind: Kind::Listed { right: &["speed_loss"], alias: &["nonlinear_damping"] },
        approach: 1.0,
        rates: |_, x, rudder| {
            let q = x.own;
            turning(x, q * q * steered(rudder) - A * q * x.rate, (1.0 - q * q) / 60.0 - 40.0 * x.rate * x.rate)
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "dead time and lag",
        equation: "T r' + r = K (δ_e + δ_r), 1 s δ_e' + δ_e = δ(t − 0.5 s)",
        kind: LATE,
        dead_time: 0.5,
        rates: |_, x, rudder| turning(x, steered(x.own) - A * x.rate, rudder - x.own),
        ..FIRST_ORDER
    },
    Truth {
        name: "damping by side",
        equation: "T r' + (1 + 0.25 [r > 0]) r = K (δ + δ_r)",
        kind: Kind::Listed { right: &["port_starboard_asymmetry", "nonlinear_damping"], alias: &[] },
        rates: |_, x, rudder| {
            let share = if x.rate > 0.0 { 1.25 } else { 1.0 };
            turning(x, steered(rudder) - A * share * x.rate, 0.0)
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "lag of the compass",
        equation: "T r' + r = K (δ + δ_r), 1.5 s ψ_shown' + ψ_shown = ψ",
        kind: LATE,
        rates: |_, x, rudder| turning(x, steered(rudder) - A * x.rate, (x.heading - x.own) / 1.5),
        shown: |x| x.own,
        ..FIRST_ORDER
    },
    Truth {
        name: "bank",
        equation: "T r' + r = K (δ + δ_r + c y), y' = 7 m/s sin ψ, c = 1.5 deg per 100 m",
        kind: Kind::Unlisted { changes: &[] },
        rates: |_, x, rudder| {
            let bank = from_deg(0.015) * x.own;
            turning(x, steered(rudder + bank) - A * x.rate, 7.0 * x.heading.sin())
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "T that falls by 40 %",
        equation: "T r' + r = K (δ + δ_r), T = 9.8 s after 150 s",
        kind: Kind::Unlisted { changes: &[HALF_TIME] },
        rates: |t, x, rudder| {
            let share = if t < HALF_TIME { 1.0 } else { 1.0 / 0.6 };
            turning(x, share * (steered(rudder) - A * x.rate), 0.0)
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "K that grows by 30 %",
        equation: "T r' + r = K (δ + δ_r), K = 0.13 1/s after 150 s",
        kind: Kind::Unlisted { changes: &[HALF_TIME] },
        rates: |t, x, rudder| {
            let share = if t < HALF_TIME { 1.0 } else { 1.3 };
            turning(x, share * steered(rudder) - A * x.rate, 0.0)
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "two steps of the moment",
        equation: "T r' + r = K (δ + δ_r + m(t)), m = 0, 1 deg after 100 s, −1 deg after 200 s",
        kind: Kind::Unlisted { changes: &STEPS },
        rates: |t, x, rudder| {
            let moment_deg = if t < STEPS[0] {
                0.0
            } else if t < STEPS[1] {
                1.0
            } else {
                -1.0
            };
            turning(x, steered(rudder + from_deg(moment_deg)) - A * x.rate, 0.0)
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "two squalls",
        equation: "T r' + r = K (δ + δ_r + m(t)), m = 3 deg cos² over 30 s about 90 s, −3 deg about 210 s",
        kind: Kind::Unlisted { changes: &SQUALLS },
        rates: |t, x, rudder| {
            let squall = |centre: f64| {
                let phase = (t - centre) / SQUALL;
                if phase.abs() < 0.5 { (std::f64::consts::PI * phase).cos().powi(2) } else { 0.0 }
            };
            let moment = from_deg(3.0) * (squall(SQUALLS[0]) - squall(SQUALLS[1]));
            turning(x, steered(rudder + moment) - A * x.rate, 0.0)
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "periodic moment",
        equation: "T r' + r = K (δ + δ_r + m sin(2π t/90 s)), m = 1 deg",
        kind: Kind::Unlisted { changes: &[] },
        rates: |t, x, rudder| {
            let moment = from_deg(1.0) * (std::f64::consts::TAU * t / PERIOD).sin();
            turning(x, steered(rudder + moment) - A * x.rate, 0.0)
        },
        ..FIRST_ORDER
    },
    FIRST_ORDER,
];

/// (K/T) (δ + δ_r), rad/s².
fn steered(rudder: f64) -> f64 {
    B * (rudder + from_deg(BIAS_DEG))
}

/// A damping n r |r|^(power − 1) that is `share` times r at half a degree a second, rad/s.
fn power(rate: f64, power: f64, share: f64) -> f64 {
    share * rate * (rate.abs() / from_deg(RATE_DEG)).powf(power - 1.0)
}

/// Rates of a motion with this yaw acceleration, rad/s², and rate of its own state.
fn turning(x: Motion, acceleration: f64, own: f64) -> Motion {
    Motion { rate: acceleration, heading: x.rate, own }
}
