//! Physics that a trace knows, in another formula.

use ship::angle::from_deg;

use super::{A, FIRST_ORDER, Kind, Truth, steered, turning};

const DAMPING: Kind = Kind::Listed { right: &["nonlinear_damping"], alias: &[] };
const LATE: Kind = Kind::Listed { right: &["steering_lag", "second_order"], alias: &[] };

/// Yaw rate at which the share of a nonlinear damping is given, deg/s.
const RATE_DEG: f64 = 0.5;

/// The ships.
pub const ALL: [Truth; 9] = [
    Truth {
        name: "damping of power 1.4",
        equation: "T r' + r + n r |r|^0.4 = K (δ + δ_r), n r |r|^0.4 = r at 0.5 deg/s; a 20/20",
        kind: DAMPING,
        zig_zags_deg: &[20.0],
        rates: |t, x, rudder| turning(x, steered(rudder(t)) - A * (x.rate + power(x.rate, 1.4, 1.0)), 0.0),
        ..FIRST_ORDER
    },
    Truth {
        name: "damping of power 2.5",
        equation: "T r' + r + n r |r|^1.5 = K (δ + δ_r), n r |r|^1.5 = 0.5 r at 0.5 deg/s",
        kind: DAMPING,
        rates: |t, x, rudder| turning(x, steered(rudder(t)) - A * (x.rate + power(x.rate, 2.5, 0.5)), 0.0),
        ..FIRST_ORDER
    },
    Truth {
        name: "damping of power 4",
        equation: "T r' + r + n r |r|³ = K (δ + δ_r), n r |r|³ = 0.3 r at 0.5 deg/s",
        kind: DAMPING,
        rates: |t, x, rudder| turning(x, steered(rudder(t)) - A * (x.rate + power(x.rate, 4.0, 0.3)), 0.0),
        ..FIRST_ORDER
    },
    Truth {
        name: "stall as tanh",
        equation: "T r' + r = K (δ_s tanh(δ/δ_s) + δ_r), δ_s = 25 deg; a 10/10 and a 20/20 together",
        kind: Kind::Listed { right: &["rudder_saturation"], alias: &[] },
        zig_zags_deg: &[10.0, 20.0],
        rates: |t, x, rudder| {
            let stall = from_deg(25.0);
            turning(x, steered(stall * (rudder(t) / stall).tanh()) - A * x.rate, 0.0)
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "wind with a second harmonic",
        equation: "T r' + r = K (δ + δ_r + w (sin(ψ − β) + 0.4 sin 2(ψ − β))), w = 3 deg, β = 60 deg",
        kind: Kind::Listed { right: &["wind_moment"], alias: &[] },
        rates: |t, x, rudder| {
            let off = x.heading - from_deg(60.0);
            let wind = from_deg(3.0) * (off.sin() + 0.4 * (2.0 * off).sin());
            turning(x, steered(rudder(t) + wind) - A * x.rate, 0.0)
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "speed loss by its square",
        equation: "r' = −(q/T) r + (K/T) q² (δ + δ_r), q' = (1 − q²)/T_u − c r², T_u = 60 s, c = 40 s/rad²",
        kind: Kind::Listed { right: &["speed_loss"], alias: &["nonlinear_damping"] },
        approach: 1.0,
        rates: |t, x, rudder| {
            let q = x.state;
            turning(x, q * q * steered(rudder(t)) - A * q * x.rate, (1.0 - q * q) / 60.0 - 40.0 * x.rate * x.rate)
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "dead time and lag",
        equation: "T r' + r = K (δ_e + δ_r), 1 s δ_e' + δ_e = δ(t − 0.5 s)",
        kind: LATE,
        rates: |t, x, rudder| turning(x, steered(x.state) - A * x.rate, rudder(t - 0.5) - x.state),
        ..FIRST_ORDER
    },
    Truth {
        name: "damping by side",
        equation: "T r' + (1 + 0.25 [r > 0]) r = K (δ + δ_r)",
        kind: Kind::Listed { right: &["port_starboard_asymmetry", "nonlinear_damping"], alias: &[] },
        rates: |t, x, rudder| {
            let share = if x.rate > 0.0 { 1.25 } else { 1.0 };
            turning(x, steered(rudder(t)) - A * share * x.rate, 0.0)
        },
        ..FIRST_ORDER
    },
    Truth {
        name: "lag of the compass",
        equation: "T r' + r = K (δ + δ_r), 1.5 s ψ_shown' + ψ_shown = ψ",
        kind: LATE,
        rates: |t, x, rudder| turning(x, steered(rudder(t)) - A * x.rate, (x.heading - x.state) / 1.5),
        shown: |x| x.state,
        ..FIRST_ORDER
    },
];

/// A damping n r |r|^(power − 1) that is `share` times r at half a degree a second, rad/s.
fn power(rate: f64, power: f64, share: f64) -> f64 {
    share * rate * (rate.abs() / from_deg(RATE_DEG)).powf(power - 1.0)
}
