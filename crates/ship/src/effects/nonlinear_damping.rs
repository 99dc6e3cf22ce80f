//! Damping that grows with the yaw rate: the terms of Norrbin and Bech.

use super::effect::{Acts, Effect, Manoeuvres, Now, Parameter, Places, Proposal};
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

const CUBIC: [Parameter; 1] = [Parameter {
    key: "n3_over_T",
    symbol: "n₃/T",
    unit: "s/rad²",
    neutral: 0.0,
    typical: 40.0,
    lowest: 0.0,
    highest: 1e7,
    odd: false,
}];
const QUADRATIC: [Parameter; 1] = [Parameter {
    key: "n2_over_T",
    symbol: "n₂/T",
    unit: "1/rad",
    neutral: 0.0,
    typical: 0.7,
    lowest: 0.0,
    highest: 1e4,
    odd: false,
}];
const SQUARE: [Parameter; 1] = [Parameter {
    key: "n11_over_T",
    symbol: "n₁₁/T",
    unit: "1/rad",
    neutral: 0.0,
    typical: 0.2,
    lowest: -1e3,
    highest: 1e3,
    odd: true,
}];

impl Effect for NonlinearDamping {
    fn id(&self) -> &'static str {
        "nonlinear_damping"
    }

    fn form(&self) -> &'static str {
        match self {
            Self::Cubic => "r³",
            Self::Quadratic => "r|r|",
            Self::Square => "r²",
        }
    }

    fn equation(&self) -> &'static str {
        match self {
            Self::Cubic => "T r' + r + n₃ r³ = K (δ + δ_r)",
            Self::Quadratic => "T r' + r + n₂ r|r| = K (δ + δ_r)",
            Self::Square => "T r' + r + n₁₁ r² = K (δ + δ_r)",
        }
    }

    fn parameters(&self) -> &'static [Parameter] {
        match self {
            Self::Cubic => &CUBIC,
            Self::Quadratic => &QUADRATIC,
            Self::Square => &SQUARE,
        }
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
