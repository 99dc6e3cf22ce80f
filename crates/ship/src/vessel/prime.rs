//! A hull without dimension whose coefficients are to be found: surge, sway and yaw in units of L and U₀, three forms.
//!
//! Lengths in L, speeds in the approach speed U₀, times in L/U₀; n is the rate of the propeller over that of the
//! approach, δ the rudder, positive to starboard. Two forms are polynomials that name no part of the ship:
//!
//! r' = N_v u v + N_r u r + N_δ q δ_e + … v' = Y_v u v + Y_r u r + Y_δ q δ_e + …
//! u' = x₀ [(n² − k n u)/(1 − k) − u|u|] + X_vr v r + X_rr r² − X_δδ q δ_e²
//!
//! with the inflow to the rudder w = e u + (1 − e) n, q = w², and δ_e = δ + δ_r − b |r|/w (b: flow straightening that
//! differs by side). What stands for "…" is N_rr r|r| + N_vv v|v| and Y_rr r|r| + Y_vv v|v| in the quadratic form, and
//! terms of third order over u in the cubic one. The third form is the MMG model with its hull, propeller and rudder.
//!
//! Priors of the two polynomials are those that an independent fit to models of tankers was made with; no test holds
//! them to other ships.

use estimation::number::Real;

use super::mmg::{Mmg, Parameters};
use super::prior::{HullParticulars, HullPrior, priors};

/// Least surge, in U₀, at which the equations are evaluated: below, the ship has all but stopped.
const LEAST_SURGE: f64 = 0.15;

/// Largest speed or yaw rate, in U₀ and U₀/L: no ship is as fast, and what runs away stays finite.
pub const FASTEST: f64 = 2.0;

/// Least inflow to the rudder, in U₀.
const LEAST_INFLOW: f64 = 0.05;

/// A coefficient, with what is expected of it before a record is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HullCoefficient {
    /// Name in files.
    pub key: &'static str,
    /// Symbol.
    pub symbol: &'static str,
    /// Expected value.
    pub mean: f64,
    /// Standard deviation of that.
    pub sd: f64,
    /// Smallest and largest value.
    pub ends: [f64; 2],
}

const fn normal(key: &'static str, symbol: &'static str, mean: f64, sd: f64) -> HullCoefficient {
    HullCoefficient { key, symbol, mean, sd, ends: [f64::NEG_INFINITY, f64::INFINITY] }
}

const fn within(key: &'static str, symbol: &'static str, [mean, sd]: [f64; 2], ends: [f64; 2]) -> HullCoefficient {
    HullCoefficient { key, symbol, mean, sd, ends }
}

/// Standard deviation of δ_r, rad: 1.7°.
const RUDDER_BIAS: f64 = 0.03;

/// δ_r, which every form has.
const BIAS: HullCoefficient = normal("delta_r", "δ_r", 0.0, RUDDER_BIAS);

/// Coefficients that both polynomials have.
const COMMON: [HullCoefficient; 14] = [
    normal("Nv", "N_v", -3.0, 1.2),
    normal("Nr", "N_r", -1.6, 0.5),
    within("Nd", "N_δ", [0.9, 0.3], [0.05, 5.0]),
    normal("Yv", "Y_v", -0.6, 0.2),
    normal("Yr", "Y_r", -0.4, 0.15),
    normal("Yd", "Y_δ", -0.12, 0.05),
    within("e", "e", [0.5, 0.25], [-0.5, 1.5]),
    normal("b", "b", 0.0, 0.1),
    BIAS,
    within("x0", "x₀", [0.07, 0.03], [0.005, 0.5]),
    within("k", "k", [0.5, 0.1], [0.0, 0.9]),
    normal("Xvr", "X_vr", 1.64, 0.3),
    normal("Xrr", "X_rr", 0.07, 0.05),
    normal("Xdd", "X_δδ", 0.07, 0.04),
];

const QUADRATIC: [HullCoefficient; 4] = [
    within("Nrr", "N_rr", [-0.5, 1.0], [-20.0, 0.5]),
    normal("Nvv", "N_vv", 0.0, 2.0),
    within("Yvv", "Y_vv", [-0.6, 0.6], [-20.0, 0.5]),
    normal("Yrr", "Y_rr", 0.0, 0.3),
];

const CUBIC: [HullCoefficient; 7] = [
    normal("Nvvv", "N_vvv", 0.0, 20.0),
    normal("Nvvr", "N_vvr", 0.0, 10.0),
    normal("Nvrr", "N_vrr", 0.0, 3.0),
    within("Nrrr", "N_rrr", [-1.0, 1.5], [-20.0, 0.5]),
    within("Yvvv", "Y_vvv", [-4.0, 4.0], [-60.0, 1.0]),
    normal("Yvvr", "Y_vvr", 0.0, 2.0),
    normal("Yvrr", "Y_vrr", -0.8, 0.8),
];

/// Coefficients of the MMG model that records of rudder and heading can tell something of; the others stay as expected.
const FREE: [&str; 23] = [
    "Nv",
    "Nr",
    "Yv",
    "Yr",
    "epsilon",
    "my",
    "Jz",
    "R0",
    "Xvr",
    "Xrr",
    "Yvvv",
    "Yvvr",
    "Yvrr",
    "Yrrr",
    "Nvvv",
    "Nvvr",
    "Nvrr",
    "Nrrr",
    "wP0",
    "aH",
    "lR",
    "gammaR-starboard",
    "gammaR-port",
];

/// Smallest and largest value of a free coefficient of the MMG model: beyond, there is no ship.
fn ends_of(key: &str) -> [f64; 2] {
    match key {
        "R0" => [0.002, 0.2],
        "wP0" => [0.0, 0.8],
        "epsilon" => [0.3, 3.0],
        "my" | "Jz" => [0.0, 2.0],
        "gammaR-starboard" | "gammaR-port" => [0.0, 1.5],
        "Yvvv" | "Nrrr" => [-20.0, 0.02],
        _ => [f64::NEG_INFINITY, f64::INFINITY],
    }
}

/// What a departure of a coefficient from the expected value can mean, in words; `None` where nothing is to be said.
pub fn meaning(key: &str) -> Option<&'static str> {
    Some(match key {
        "delta_r" => "a bent rudder, a rudder whose zero is off, or a bank on one side",
        "b" | "gammaR-starboard" | "gammaR-port" => "a rudder whose inflow differs by side",
        "R0" | "x0" => "fouling, or another draught",
        "k" | "wP0" => "another wake: fouling, trim or shallow water",
        "epsilon" | "e" | "Nd" | "aH" => "a rudder of another force: damaged, fouled, or of another size",
        "Nv" | "Nr" | "lR" => "trim, or shallow water",
        "Yv" | "Yr" | "my" => "another draught, or shallow water",
        _ => return None,
    })
}

/// Whether a coefficient belongs to a trial and not to the ship, which has another in the next one.
pub fn is_of_trial(key: &str) -> bool {
    key == BIAS.key
}

/// Whether a coefficient depends on friction, which is another at another scale: resistance and wake (Reynolds).
pub fn is_of_friction(key: &str) -> bool {
    matches!(key, "x0" | "k" | "R0" | "wP0")
}

/// What a hull is made of.
#[derive(Debug, Clone, PartialEq)]
pub enum HullForm {
    /// Terms of second order.
    Quadratic,
    /// Terms of third order.
    Cubic,
    /// Hull, propeller and rudder of the MMG model about these parameters, without dimension (length 1); the
    /// coefficients are those that are free.
    Mmg(Box<Parameters>, Vec<HullCoefficient>),
}

impl HullForm {
    /// The forms that a ship can be fitted with: the two polynomials, and the MMG model about what her particulars say.
    pub fn of_ship(particulars: Option<&HullParticulars>) -> Vec<Self> {
        let mmg = particulars.and_then(|own| priors(own).ok()).map(|prior| Self::mmg(&prior));
        [Self::Quadratic, Self::Cubic].into_iter().chain(mmg).collect()
    }

    /// The MMG model about what the particulars of a ship say.
    pub fn mmg(prior: &HullPrior) -> Self {
        let of = |key: &&str| prior.coefficients.iter().find(|own| own.formula.key == *key);
        let free = FREE.iter().filter_map(of).map(|own| HullCoefficient {
            key: own.formula.key,
            symbol: own.formula.symbol,
            mean: own.mean,
            sd: own.sd,
            ends: ends_of(own.formula.key),
        });
        Self::Mmg(Box::new(prior.parameters.of_length_one()), free.collect())
    }

    /// Its coefficients, in the order in which their values travel.
    pub fn coefficients(&self) -> Vec<HullCoefficient> {
        match self {
            Self::Quadratic => [&COMMON[..], &QUADRATIC].concat(),
            Self::Cubic => [&COMMON[..], &CUBIC].concat(),
            Self::Mmg(_, free) => [&free[..], &[BIAS]].concat(),
        }
    }

    /// The word used in files.
    pub fn as_str(&self) -> &'static str {
        match self {
            Self::Quadratic => "quadratic",
            Self::Cubic => "cubic",
            Self::Mmg(..) => "mmg",
        }
    }

    /// The hull with these values of its coefficients; `None` where they make no ship.
    pub fn with<R: Real>(&self, values: &[R]) -> Option<PrimeHull<R>> {
        Some(match self {
            Self::Quadratic => PrimeHull::Quadratic(values.try_into().ok()?),
            Self::Cubic => PrimeHull::Cubic(values.try_into().ok()?),
            Self::Mmg(about, free) => {
                let mut parameters = about.constant::<R>();
                for (coefficient, value) in free.iter().zip(values) {
                    *parameters.named(coefficient.key)? = *value;
                }
                PrimeHull::Mmg(Box::new(Mmg::at_speed(parameters, 1.0).ok()?), *values.last()?)
            }
        })
    }
}

/// A hull ready to be asked for its accelerations.
#[derive(Debug, Clone, PartialEq)]
pub enum PrimeHull<R = f64> {
    /// Of second order.
    Quadratic([R; COMMON.len() + QUADRATIC.len()]),
    /// Of third order.
    Cubic([R; COMMON.len() + CUBIC.len()]),
    /// MMG, and δ_r.
    Mmg(Box<Mmg<R>>, R),
}

impl<R: Real> PrimeHull<R> {
    /// (u', v', r') at surge, sway and yaw rate, rudder (rad), rate of the propeller over that of the approach, and a
    /// yaw moment as rudder angle at approach speed (rad).
    #[inline]
    pub fn accelerations(&self, [u, v, r]: [R; 3], rudder: R, turning: f64, disturbance: f64) -> [R; 3] {
        let [u, v, r] = [of_ship(u, LEAST_SURGE), of_ship(v, -FASTEST), of_ship(r, -FASTEST)];
        match self {
            Self::Mmg(hull, bias) => hull.accelerations([u, v, r], rudder + *bias, turning, disturbance),
            Self::Quadratic(p) => {
                let [surge, sway, yaw] = common(p, [u, v, r], rudder, turning, disturbance);
                let (vv, rr) = (v * v.abs(), r * r.abs());
                [surge, sway + p[16] * vv + p[17] * rr, yaw + p[14] * rr + p[15] * vv]
            }
            Self::Cubic(p) => {
                let [surge, sway, yaw] = common(p, [u, v, r], rudder, turning, disturbance);
                let (vv, vr, rr) = (v * v / u, v * r / u, r * r / u);
                [
                    surge,
                    sway + p[18] * vv * v + p[19] * vr * v + p[20] * vr * r,
                    yaw + p[14] * vv * v + p[15] * vr * v + p[16] * vr * r + p[17] * rr * r,
                ]
            }
        }
    }
}

/// A speed or yaw rate of a ship.
#[inline]
fn of_ship<R: Real>(value: R, least: f64) -> R {
    value.between(R::from(least), R::from(FASTEST))
}

/// What both polynomials have, with their coefficients in the order of [`COMMON`].
#[inline]
fn common<R: Real>(p: &[R], [u, v, r]: [R; 3], rudder: R, n: f64, disturbance: f64) -> [R; 3] {
    let w = (p[6] * (u - n) + n).at_least(LEAST_INFLOW);
    let angle = p[8] + rudder - p[7] * r.abs() / w;
    let force = w * w * angle;
    let thrust = -(p[10] * n) * u + n * n;
    [
        p[9] * (thrust / (-p[10] + 1.0) - u * u) + p[11] * v * r + p[12] * r * r - p[13] * force * angle,
        p[3] * u * v + p[4] * u * r + p[5] * force,
        p[0] * u * v + p[1] * u * r + p[2] * (force + disturbance),
    ]
}

impl PrimeHull {
    /// The same without derivatives, as yet.
    pub fn constant<R: Real>(&self) -> PrimeHull<R> {
        match self {
            Self::Quadratic(p) => PrimeHull::Quadratic(p.map(R::from)),
            Self::Cubic(p) => PrimeHull::Cubic(p.map(R::from)),
            Self::Mmg(hull, bias) => {
                let again = Mmg::at_speed(hull.parameters().constant(), 1.0).expect("it made a ship");
                PrimeHull::Mmg(Box::new(again), R::from(*bias))
            }
        }
    }
}
