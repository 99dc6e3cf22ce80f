//! Abkowitz model: one Taylor series for the forces on hull, propeller and rudder together.
//!
//! Prime system ½ρL²U² with the instantaneous speed U: surge perturbation u' = (u − U₀)/U, sway v' = v/U, yaw r' = r
//! L/U. Series: Chislett and Strøm-Tejsen (1965); its centrifugal terms are inside the derivatives (Yr holds −m', Xrv
//! holds m'), so mass appears on the left only.
//!
//! The rudder of the source is positive to port. Its sign is changed here only; [`Abkowitz::new`] takes the
//! coefficients as printed.
//!
//! Sources: Abkowitz (1964); Chislett and Strøm-Tejsen (1965).

use super::{Hull, MIN_SPEED_SHARE};
use crate::dynamics::ShipInput;
use crate::linear::PrimeSwayYawMatrices;
use crate::particulars::Particulars;

/// Derivatives as printed in the source: prime, rudder positive to port, radians.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "each name is the symbol of a derivative: Yvvr multiplies v'² r' in Y")]
pub struct AbkowitzDerivatives {
    /// Mass m'.
    pub m: f64,
    /// Moment of inertia I_z' about midship.
    pub Iz: f64,
    /// Centre of gravity x_G' forward of midship.
    pub xG: f64,
    pub Xudot: f64,
    pub Yvdot: f64,
    pub Yrdot: f64,
    pub Nvdot: f64,
    pub Nrdot: f64,
    pub Xu: f64,
    pub Xuu: f64,
    pub Xuuu: f64,
    pub Xvv: f64,
    pub Xrr: f64,
    pub Xdd: f64,
    pub Xudd: f64,
    pub Xrv: f64,
    pub Xvd: f64,
    pub Xuvd: f64,
    pub Y: LateralDerivatives,
    pub N: LateralDerivatives,
}

/// Derivatives of the sway force or of the yaw moment, with the same terms for either.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "each name is the index of a derivative: vvr multiplies v'² r'")]
pub struct LateralDerivatives {
    pub v: f64,
    pub r: f64,
    pub vvv: f64,
    pub vvr: f64,
    pub vu: f64,
    pub ru: f64,
    pub d: f64,
    pub ddd: f64,
    pub ud: f64,
    pub uud: f64,
    pub vdd: f64,
    pub vvd: f64,
    /// Constant force or moment of a single propeller; with `zero_u` and `zero_uu` the asymmetry of the ship.
    pub zero: f64,
    pub zero_u: f64,
    pub zero_uu: f64,
}

impl LateralDerivatives {
    fn at(&self, u: f64, v: f64, r: f64, d: f64) -> f64 {
        self.v * v
            + self.r * r
            + self.vvv * v * v * v
            + self.vvr * v * v * r
            + self.vu * v * u
            + self.ru * r * u
            + d * (self.d + self.ud * u + self.uud * u * u + self.ddd * d * d + self.vdd * v * d + self.vvd * v * v)
            + self.zero
            + self.zero_u * u
            + self.zero_uu * u * u
    }
}

/// Hull described by a single polynomial in u', v', r' and δ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Abkowitz {
    particulars: Particulars,
    derivatives: AbkowitzDerivatives,
}

impl Abkowitz {
    /// Hull of this length whose derivatives were measured at this approach speed.
    pub fn new(particulars: Particulars, derivatives: AbkowitzDerivatives) -> Self {
        Self { particulars, derivatives }
    }

    /// Linear equations of sway and yaw, rudder positive to starboard.
    pub fn linearised(&self) -> PrimeSwayYawMatrices {
        let p = &self.derivatives;
        PrimeSwayYawMatrices { M: self.mass(), N: [[-p.Y.v, -p.Y.r], [-p.N.v, -p.N.r]], b: [-p.Y.d, -p.N.d] }
    }

    fn mass(&self) -> [[f64; 2]; 2] {
        let p = &self.derivatives;
        [[p.m - p.Yvdot, p.m * p.xG - p.Yrdot], [p.m * p.xG - p.Nvdot, p.Iz - p.Nrdot]]
    }
}

impl Hull for Abkowitz {
    fn particulars(&self) -> Particulars {
        self.particulars
    }

    /// Accelerations from m' a' = F'(u', v', r', δ), a = a' U²/L (r' by U²/L²).
    ///
    /// The disturbance adds the yaw moment N_δ δ at approach speed. The polynomial was fitted near the approach speed.
    fn acceleration(&self, [surge, sway, yaw]: [f64; 3], input: &ShipInput) -> [f64; 3] {
        let p = &self.derivatives;
        let Particulars { length: L, speed: U0 } = self.particulars;
        let U = surge.hypot(sway).max(MIN_SPEED_SHARE * U0);
        let (u, v, r) = ((surge - U0) / U, sway / U, yaw * L / U);
        let d = -input.rudder;

        let X = u * (p.Xu + p.Xuu * u + p.Xuuu * u * u)
            + p.Xvv * v * v
            + p.Xrr * r * r
            + p.Xrv * r * v
            + d * (p.Xdd * d + p.Xudd * u * d + p.Xvd * v + p.Xuvd * u * v);
        let Y = p.Y.at(u, v, r, d);
        let N = p.N.at(u, v, r, d) - p.N.d * input.disturbance_rudder * (U0 / U) * (U0 / U);

        let [[m11, m12], [m21, m22]] = self.mass();
        let det = m11 * m22 - m12 * m21;
        let unit = U * U / L;
        [X / (p.m - p.Xudot) * unit, (m22 * Y - m12 * N) / det * unit, (m11 * N - m21 * Y) / det * unit / L]
    }
}
