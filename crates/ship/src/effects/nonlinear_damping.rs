//! Damping that grows with the yaw rate: the terms of Norrbin and Bech.

use super::effect::{Acts, Description, Effect, Manoeuvres, Now, Parameter, Places, Proposal};
use estimation::number::Real;

/// One nonlinear term of the yaw damping; the parameter is its coefficient divided by T, which stays regular when
/// 1/T passes through zero.
///
/// Sources: Norrbin (1963) for r|r| and r³; Bech (1968) for the full polynomial T₁T₂ r'' + (T₁+T₂) r' + K H(r) = K (δ +
/// T₃ δ'), H = b₃r³ + b₂r² + b₁r + b₀, which is the second-order effect with [`Cubic`](Self::Cubic) = K b₃/T,
/// [`Square`](Self::Square) = K b₂/T, 1/T times K b₁ and δ_r = −b₀.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NonlinearDamping {
    /// r' = … − (n₃/T) r³.
    Cubic,
    /// r' = … − (n₂/T) r|r|.
    Quadratic,
    /// r' = … − (b₂K/T) r²: damping that differs by side.
    Square,
}

const CUBIC: [Parameter; 1] = [Parameter::even(["n3_over_T", "n₃/T", "s/rad²"], [0.0, 40.0], [0.0, 1e7])];
const QUADRATIC: [Parameter; 1] = [Parameter::even(["n2_over_T", "n₂/T", "1/rad"], [0.0, 0.7], [0.0, 1e4])];
const SQUARE: [Parameter; 1] = [Parameter::odd(["n11_over_T", "n₁₁/T", "1/rad"], [0.0, 0.2], [-1e3, 1e3])];

impl Effect for NonlinearDamping {
    fn description(&self) -> Description {
        let (form, equation, parameters): (_, _, &[Parameter]) = match self {
            Self::Cubic => ("r³", "T r' + r + n₃ r³ = K (δ + δ_r)", &CUBIC),
            Self::Quadratic => ("r|r|", "T r' + r + n₂ r|r| = K (δ + δ_r)", &QUADRATIC),
            Self::Square => ("r²", "T r' + r + n₁₁ r² = K (δ + δ_r)", &SQUARE),
        };
        Description { id: "nonlinear_damping", form, equation, parameters }
    }

    /// Without dimension: r³ within 8, r|r| within 1.2, r² within 0.4.
    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        Some(Proposal::of_one(
            *self,
            match self {
                Self::Cubic => 8.0 * about.time,
                Self::Quadratic => 1.2,
                Self::Square => 0.4,
            },
        ))
    }

    fn places(&self) -> Places {
        Places::MOMENT
    }
}

impl<R: Real> Acts<R> for NonlinearDamping {
    fn yaw_acceleration(&self, p: &[R], _z: &[R], now: &Now<R>) -> R {
        let r = now.yaw_rate;
        match self {
            Self::Cubic => -p[0] * r * r * r,
            Self::Quadratic => -p[0] * r * r.abs(),
            Self::Square => -p[0] * r * r,
        }
    }
}
