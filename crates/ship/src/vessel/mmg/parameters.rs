//! Parameters of an MMG hull, under the names of the literature; structure and units only, values are in
//! [`crate::ships`].
#![expect(non_snake_case, reason = "Yv is a derivative of the force Y, AR an area; names are those of the literature")]

/// A quantity that takes one of two values by the sign of an angle.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BySign {
    /// Value for a positive angle.
    pub positive: f64,
    /// Value for a negative angle.
    pub negative: f64,
}

impl BySign {
    /// The value that holds at this angle.
    pub fn at(&self, angle: f64) -> f64 {
        if angle < 0.0 { self.negative } else { self.positive }
    }

    /// Mean of the two.
    pub fn mean(&self) -> f64 {
        0.5 * (self.positive + self.negative)
    }
}

/// Hull force derivatives in the prime system ½ρLdU² (moment ½ρL²dU²), added masses in ½ρL²d (inertia ½ρL⁴d).
///
/// X' = −R0 + Xvv v'² + Xvr v'r' + Xrr r'² + Xvvvv v'⁴; Y' and N' are the third-order polynomials of their indices.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[expect(missing_docs, reason = "each name is the symbol of a derivative: Yvvr multiplies v'² r' in Y'")]
pub struct HullDerivatives {
    /// Added mass in surge m_x'.
    pub mx: f64,
    /// Added mass in sway m_y'.
    pub my: f64,
    /// Added moment of inertia J_z'.
    pub Jz: f64,
    /// Resistance in straight motion R₀'.
    pub R0: f64,
    pub Xvv: f64,
    pub Xvr: f64,
    pub Xrr: f64,
    pub Xvvvv: f64,
    pub Yv: f64,
    pub Yr: f64,
    pub Yvvv: f64,
    pub Yvvr: f64,
    pub Yvrr: f64,
    pub Yrrr: f64,
    pub Nv: f64,
    pub Nr: f64,
    pub Nvvv: f64,
    pub Nvvr: f64,
    pub Nvrr: f64,
    pub Nrrr: f64,
}

/// How the wake at the propeller fades with the inflow angle β_P = β − x_P' r'.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wake {
    /// 1 − w_P = (1 − w_P0) {1 + [1 − exp(−C1 |β_P|)] (C2 − 1)}, C2 by the sign of β_P (Yasukawa and Yoshimura 2015).
    Exponential {
        /// C1.
        C1: f64,
        /// C2.
        C2: BySign,
    },
    /// w_P = w_P0 exp(−4 β_P²).
    Gaussian,
}

/// Propeller at constant revolutions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Propeller {
    /// Diameter D_P, m.
    pub DP: f64,
    /// Wake fraction in straight motion w_P0.
    pub wP0: f64,
    /// Its change in manoeuvring.
    pub wake: Wake,
    /// Thrust deduction t_P.
    pub tP: f64,
    /// Longitudinal position x_P' = x_P/L, forward of midship.
    pub xP: f64,
    /// Open-water thrust K_T = k0 + k1 J + k2 J².
    pub k: [f64; 3],
}

/// Rudder behind the propeller, and its interaction with the hull.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Rudder {
    /// Area of the movable part A_R, m².
    pub AR: f64,
    /// Share of the rudder height in the propeller stream, η = D_P/H_R.
    pub eta: f64,
    /// Slope of the normal force f_α, 1/rad.
    pub f_alpha: f64,
    /// Wake ratio ε = (1 − w_R)/(1 − w_P).
    pub epsilon: f64,
    /// Propeller acceleration factor κ.
    pub kappa: f64,
    /// Steering resistance deduction t_R.
    pub tR: f64,
    /// Rudder force increase a_H.
    pub aH: f64,
    /// Point of application of the additional force x_H' = x_H/L.
    pub xH: f64,
    /// Longitudinal position x_R' = x_R/L.
    pub xR: f64,
    /// Effective position for the inflow ℓ_R' in β_R = β − ℓ_R' r'.
    pub lR: f64,
    /// Flow straightening γ_R by the sign of β_R.
    pub gammaR: BySign,
}

/// Everything an MMG hull is made of.
///
/// The density of the water is not among it: mass is given by the displaced volume, and every force is proportional to
/// the density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameters {
    /// Length between perpendiculars, m.
    pub Lpp: f64,
    /// Draught d, m.
    pub d: f64,
    /// Displaced volume ∇, m³.
    pub volume: f64,
    /// Centre of gravity x_G forward of midship, m.
    pub xG: f64,
    /// Radius of gyration about the vertical through the centre of gravity, over L (0.25 where nothing is published).
    pub kzz: f64,
    /// Hull.
    pub hull: HullDerivatives,
    /// Propeller.
    pub propeller: Propeller,
    /// Rudder.
    pub rudder: Rudder,
}
