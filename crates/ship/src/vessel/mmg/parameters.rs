//! Parameters of an MMG hull, with the symbols of the literature; values are in [`crate::ships`].
//!
//! Source: Yasukawa and Yoshimura (2015), Journal of Marine Science and Technology 20:37-52.

use estimation::number::Real;

/// Quantity with one value for positive and one for negative angles.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BySign<R = f64> {
    /// Value for a positive angle.
    pub positive: R,
    /// Value for a negative angle.
    pub negative: R,
}

impl<R: Real> BySign<R> {
    /// Value at an angle.
    #[inline(always)]
    pub fn value_at(&self, angle: R) -> R {
        if angle.value() < 0.0 { self.negative } else { self.positive }
    }

    /// Mean of both values.
    pub fn mean(&self) -> R {
        (self.positive + self.negative) * 0.5
    }
}

/// Hull force derivatives in the prime system ½ρLdU² (moment ½ρL²dU²), added masses in ½ρL²d (inertia ½ρL⁴d).
///
/// X' = −R0 + Xvv v'² + Xvr v'r' + Xrr r'² + Xvvvv v'⁴; Y' and N' are the third-order polynomials of their indices.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[expect(missing_docs, reason = "each name is the symbol of a derivative: Yvvr multiplies v'² r' in Y'")]
pub struct HullDerivatives<R = f64> {
    /// Added mass in surge m_x'.
    pub mx: R,
    /// Added mass in sway m_y'.
    pub my: R,
    /// Added moment of inertia J_z'.
    pub Jz: R,
    /// Resistance in straight motion R₀'.
    pub R0: R,
    pub Xvv: R,
    pub Xvr: R,
    pub Xrr: R,
    pub Xvvvv: R,
    pub Yv: R,
    pub Yr: R,
    pub Yvvv: R,
    pub Yvvr: R,
    pub Yvrr: R,
    pub Yrrr: R,
    pub Nv: R,
    pub Nr: R,
    pub Nvvv: R,
    pub Nvvr: R,
    pub Nvrr: R,
    pub Nrrr: R,
}

/// Dependence of the wake at the propeller on the inflow angle β_P = β − x_P' r'.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wake<R = f64> {
    /// Exponential law 1 − w_P = (1 − w_P0) {1 + [1 − exp(−C1 |β_P|)] (C2 − 1)}, C2 by the sign of β_P (Yasukawa and
    /// Yoshimura 2015).
    Exponential {
        /// Decay coefficient C1.
        C1: R,
        /// Asymptotic coefficient C2.
        C2: BySign<R>,
    },
    /// Gaussian law w_P = w_P0 exp(−4 β_P²).
    Gaussian,
}

/// Propeller, with its wake, thrust deduction and open-water characteristic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Propeller<R = f64> {
    /// Diameter D_P, m.
    pub DP: R,
    /// Wake fraction in straight motion w_P0.
    pub wP0: R,
    /// Wake in manoeuvring.
    pub wake: Wake<R>,
    /// Thrust deduction t_P.
    pub tP: R,
    /// Longitudinal position x_P' = x_P/L, forward of midship.
    pub xP: R,
    /// Coefficients k0, k1 and k2 of the open-water thrust K_T = k0 + k1 J + k2 J².
    pub k: [R; 3],
}

/// Rudder behind the propeller, and its interaction with the hull.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Rudder<R = f64> {
    /// Area of the movable part A_R, m².
    pub AR: R,
    /// Share of the rudder height in the propeller stream, η = D_P/H_R.
    pub eta: R,
    /// Slope of the normal force f_α, 1/rad.
    pub f_alpha: R,
    /// Wake ratio ε = (1 − w_R)/(1 − w_P).
    pub epsilon: R,
    /// Propeller acceleration factor κ.
    pub kappa: R,
    /// Steering resistance deduction t_R.
    pub tR: R,
    /// Rudder force increase a_H.
    pub aH: R,
    /// Longitudinal position x_H' = x_H/L of the additional force on the hull, forward of midship.
    pub xH: R,
    /// Longitudinal position x_R' = x_R/L, forward of midship.
    pub xR: R,
    /// Effective position for the inflow ℓ_R' in β_R = β − ℓ_R' r'.
    pub lR: R,
    /// Flow straightening γ_R by the sign of β_R.
    pub gammaR: BySign<R>,
}

/// Parameters of an MMG hull.
///
/// The density of the water drops out: mass is given by the displaced volume, and every force is proportional to the
/// density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MmgParameters<R = f64> {
    /// Length between perpendiculars, m.
    pub Lpp: R,
    /// Draught d, m.
    pub d: R,
    /// Displaced volume ∇, m³.
    pub volume: R,
    /// Centre of gravity x_G forward of midship, m.
    pub xG: R,
    /// Radius of gyration about the vertical through the centre of gravity, over L (0.25 if no value is published).
    pub kzz: R,
    /// Hull.
    pub hull: HullDerivatives<R>,
    /// Propeller.
    pub propeller: Propeller<R>,
    /// Rudder.
    pub rudder: Rudder<R>,
}

/// Conversion of parameters to another number type, as constants.
macro_rules! constants {
    ($name:ident: $($field:ident)* $(, $part:ident = $made:expr)*) => {
        impl $name {
            /// Parameters in another number type, without derivatives.
            pub fn to_real<R: Real>(&self) -> $name<R> {
                $name { $($field: R::from(self.$field),)* $($part: $made(&self.$part)),* }
            }
        }
    };
}

/// [`constants`], with access to the fields by their names in files.
macro_rules! named_constants {
    ($name:ident: $($field:ident)*) => {
        constants!($name: $($field)*);

        impl<R> $name<R> {
            fn coefficient_mut(&mut self, name: &str) -> Option<&mut R> {
                match name {
                    $(stringify!($field) => Some(&mut self.$field),)*
                    _ => None,
                }
            }
        }
    };
}

constants!(BySign: positive negative);
named_constants!(HullDerivatives: mx my Jz R0 Xvv Xvr Xrr Xvvvv Yv Yr Yvvv Yvvr Yvrr Yrrr Nv Nr Nvvv Nvvr Nvrr Nrrr);
constants!(Propeller: DP wP0 tP xP, wake = |wake: &Wake| wake.to_real(), k = |k: &[f64; 3]| k.map(R::from));
constants!(Rudder: AR eta f_alpha epsilon kappa tR aH xH xR lR, gammaR = BySign::to_real);
constants!(MmgParameters: Lpp d volume xG kzz,
    hull = HullDerivatives::to_real, propeller = Propeller::to_real, rudder = Rudder::to_real);

impl Wake {
    fn to_real<R: Real>(self) -> Wake<R> {
        match self {
            Self::Exponential { C1, C2 } => Wake::Exponential { C1: R::from(C1), C2: C2.to_real() },
            Self::Gaussian => Wake::Gaussian,
        }
    }
}

impl MmgParameters {
    /// Hull scaled to length 1.
    #[must_use]
    pub fn at_unit_length(&self) -> Self {
        let L = self.Lpp;
        Self {
            Lpp: 1.0,
            d: self.d / L,
            volume: self.volume / L.powi(3),
            xG: self.xG / L,
            propeller: Propeller { DP: self.propeller.DP / L, ..self.propeller },
            rudder: Rudder { AR: self.rudder.AR / (L * L), ..self.rudder },
            ..*self
        }
    }
}

impl<R> MmgParameters<R> {
    /// Coefficient with this name in files; `None` for an unknown name or a coefficient of another wake law.
    pub fn coefficient_mut(&mut self, name: &str) -> Option<&mut R> {
        let Self { hull, propeller, rudder, kzz, .. } = self;
        Some(match name {
            "kzz" => kzz,
            "wP0" => &mut propeller.wP0,
            "C1" | "C2-starboard" | "C2-port" => match (&mut propeller.wake, name) {
                (Wake::Gaussian, _) => return None,
                (Wake::Exponential { C1, .. }, "C1") => C1,
                (Wake::Exponential { C2, .. }, "C2-starboard") => &mut C2.positive,
                (Wake::Exponential { C2, .. }, _) => &mut C2.negative,
            },
            "tP" => &mut propeller.tP,
            "xP" => &mut propeller.xP,
            "k0" => &mut propeller.k[0],
            "k1" => &mut propeller.k[1],
            "k2" => &mut propeller.k[2],
            "f_alpha" => &mut rudder.f_alpha,
            "epsilon" => &mut rudder.epsilon,
            "kappa" => &mut rudder.kappa,
            "tR" => &mut rudder.tR,
            "aH" => &mut rudder.aH,
            "xH" => &mut rudder.xH,
            "xR" => &mut rudder.xR,
            "lR" => &mut rudder.lR,
            "gammaR-starboard" => &mut rudder.gammaR.positive,
            "gammaR-port" => &mut rudder.gammaR.negative,
            _ => return hull.coefficient_mut(name),
        })
    }
}
