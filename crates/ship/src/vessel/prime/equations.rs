//! Equations of the nondimensional hulls, and the coefficients of the polynomials.

use estimation::number::Real;

use crate::vessel::mmg::Mmg;

/// Minimum surge, in U₀, at which the equations are evaluated.
const MIN_SURGE: f64 = 0.15;

/// Maximum speed or yaw rate, in U₀ and U₀/L, at which the equations are evaluated: a diverging state stays finite.
pub const MAX_PRIME_SPEED: f64 = 2.0;

/// Minimum inflow to the rudder, in U₀.
const MIN_INFLOW: f64 = 0.05;

/// Coefficient of a polynomial: name in files, symbol and bounds.
#[derive(Debug, Clone, Copy)]
pub(super) struct PolynomialTerm {
    pub key: &'static str,
    pub symbol: &'static str,
    pub bounds: [f64; 2],
}

const fn free(key: &'static str, symbol: &'static str) -> PolynomialTerm {
    PolynomialTerm { key, symbol, bounds: [f64::NEG_INFINITY, f64::INFINITY] }
}

pub(super) const fn bounded(key: &'static str, symbol: &'static str, bounds: [f64; 2]) -> PolynomialTerm {
    PolynomialTerm { key, symbol, bounds }
}

/// Rudder bias δ_r, a coefficient of every form.
pub(super) const BIAS_TERM: PolynomialTerm = free("delta_r", "δ_r");

/// Coefficients of both polynomials.
pub(super) const COMMON_TERMS: [PolynomialTerm; 14] = [
    free("Nv", "N_v"),
    free("Nr", "N_r"),
    bounded("Nd", "N_δ", [0.05, 5.0]),
    free("Yv", "Y_v"),
    free("Yr", "Y_r"),
    free("Yd", "Y_δ"),
    bounded("e", "e", [-0.5, 1.5]),
    free("b", "b"),
    BIAS_TERM,
    bounded("x0", "x₀", [0.005, 0.5]),
    bounded("k", "k", [0.0, 0.9]),
    free("Xvr", "X_vr"),
    free("Xrr", "X_rr"),
    free("Xdd", "X_δδ"),
];

/// Further coefficients of the quadratic polynomial.
pub(super) const QUADRATIC_TERMS: [PolynomialTerm; 4] = [
    bounded("Nrr", "N_rr", [-20.0, 0.5]),
    free("Nvv", "N_vv"),
    bounded("Yvv", "Y_vv", [-20.0, 0.5]),
    free("Yrr", "Y_rr"),
];

/// Third-order hull coefficients N_vvv to Y_vrr, nondimensional, in addition to `COMMON_TERMS`.
pub(super) const CUBIC_TERMS: [PolynomialTerm; 7] = [
    free("Nvvv", "N_vvv"),
    free("Nvvr", "N_vvr"),
    free("Nvrr", "N_vrr"),
    bounded("Nrrr", "N_rrr", [-20.0, 0.5]),
    bounded("Yvvv", "Y_vvv", [-60.0, 1.0]),
    free("Yvvr", "Y_vvr"),
    free("Yvrr", "Y_vrr"),
];

/// Nondimensional hull with its coefficient values.
#[derive(Debug, Clone, PartialEq)]
pub struct PrimeHull<R = f64> {
    /// Hull in a calm.
    pub in_calm: CalmHull<R>,
    /// Wind coefficient Y_w.
    pub windage: R,
}

/// Nondimensional hull in a calm.
#[derive(Debug, Clone, PartialEq)]
pub enum CalmHull<R = f64> {
    /// Values of the quadratic polynomial: the common coefficients, then the further coefficients.
    Quadratic([R; COMMON_TERMS.len() + QUADRATIC_TERMS.len()]),
    /// Values of the cubic polynomial: the common coefficients, then the further coefficients.
    Cubic([R; COMMON_TERMS.len() + CUBIC_TERMS.len()]),
    /// MMG model, and δ_r, rad.
    Mmg(Box<Mmg<R>>, R),
}

impl<R: Real> PrimeHull<R> {
    /// Accelerations (u', v', r') at surge, sway and yaw rate, in units of L and U₀; rudder in rad, propeller rate over
    /// that of the approach (`n_ratio`), yaw disturbance as equivalent rudder angle at approach speed (rad), and wind
    /// per unit of Y_w ([`wind_accelerations`](super::wind_accelerations)).
    #[inline(always)]
    pub fn accelerations(&self, state: [R; 3], rudder: R, n_ratio: f64, disturbance: f64, wind: [f64; 3]) -> [R; 3] {
        let calm = self.in_calm.accelerations(state, rudder, n_ratio, disturbance);
        std::array::from_fn(|axis| calm[axis] + self.windage * wind[axis])
    }
}

impl<R: Real> CalmHull<R> {
    /// Accelerations as in [`PrimeHull::accelerations`], without wind.
    #[inline(always)]
    pub fn accelerations(&self, [u, v, r]: [R; 3], rudder: R, n_ratio: f64, disturbance: f64) -> [R; 3] {
        let [u, v, r] = [limited(u, MIN_SURGE), limited(v, -MAX_PRIME_SPEED), limited(r, -MAX_PRIME_SPEED)];
        match self {
            Self::Mmg(hull, bias) => hull.accelerations([u, v, r], rudder + *bias, n_ratio, disturbance),
            Self::Quadratic(p) => {
                let [surge, sway, yaw] = common(p, [u, v, r], rudder, n_ratio, disturbance);
                let (vv, rr) = (v * v.abs(), r * r.abs());
                [surge, sway + p[16] * vv + p[17] * rr, yaw + p[14] * rr + p[15] * vv]
            }
            Self::Cubic(p) => {
                let [surge, sway, yaw] = common(p, [u, v, r], rudder, n_ratio, disturbance);
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

/// Speed or yaw rate limited to the range of the equations.
#[inline(always)]
fn limited<R: Real>(value: R, least: f64) -> R {
    value.clamped(R::from(least), R::from(MAX_PRIME_SPEED))
}

/// Terms of both polynomials, with coefficients in the order of [`COMMON_TERMS`].
#[inline(always)]
fn common<R: Real>(p: &[R], [u, v, r]: [R; 3], rudder: R, n: f64, disturbance: f64) -> [R; 3] {
    let w = (p[6] * (u - n) + n).at_least(MIN_INFLOW);
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
    /// Hull in another number type, with constant coefficients.
    pub fn to_real<R: Real>(&self) -> PrimeHull<R> {
        let in_calm = match &self.in_calm {
            CalmHull::Quadratic(p) => CalmHull::Quadratic(p.map(R::from)),
            CalmHull::Cubic(p) => CalmHull::Cubic(p.map(R::from)),
            CalmHull::Mmg(hull, bias) => {
                let again = Mmg::at_speed(hull.parameters().to_real(), 1.0).expect("valid coefficients");
                CalmHull::Mmg(Box::new(again), R::from(*bias))
            }
        };
        PrimeHull { in_calm, windage: R::from(self.windage) }
    }
}
