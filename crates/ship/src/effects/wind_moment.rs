//! A yaw moment that depends on heading: steady wind, or the wind the record has measured.

use super::effect::{Acts, Description, Effect, Manoeuvres, Now, Parameter, Places, Prior, Proposal};
use crate::dynamics::Regressor;
use estimation::number::Real;

/// Wind as the rudder angle with the same yaw moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WindMoment {
    /// w_c cos 2ψ + w_s sin 2ψ, which is w sin 2(ψ_w − ψ): steady wind of unknown strength and direction.
    Steady,
    /// c U_rel² sin γ_rel from the measured relative wind; zero where the record has none.
    Measured,
}

const STEADY: [Parameter; 2] = [
    Parameter::odd(["w_c", "w_c", "rad"], [0.0, 0.02], [-0.6, 0.6]),
    Parameter::even(["w_s", "w_s", "rad"], [0.0, 0.02], [-0.6, 0.6]),
];
const MEASURED: [Parameter; 1] = [Parameter::even(["c_w", "c_w", "rad s²/m²"], [0.0, 0.01], [-10.0, 10.0])];

/// Moment of a moderate wind as an angle of the rudder, rad.
const MODERATE: f64 = 0.025;

impl Effect for WindMoment {
    fn description(&self) -> Description {
        let (form, equation, parameters): (_, _, &[Parameter]) = match self {
            Self::Steady => ("steady wind", "T r' + r = K (δ + δ_r + w_c cos 2ψ + w_s sin 2ψ)", &STEADY),
            Self::Measured => ("measured wind", "T r' + r = K (δ + δ_r + c_w U_rel² sin γ_rel)", &MEASURED),
        };
        Description { id: "wind_moment", form, equation, parameters }
    }

    fn sees_heading(&self) -> bool {
        *self == Self::Steady
    }

    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        match self {
            Self::Steady => {
                Some(Proposal::new(*self, STEADY.each_ref().map(|parameter| Prior::normal(parameter, 0.0, MODERATE))))
            }
            Self::Measured => Some(Proposal::of_one(*self, 2.0 * MODERATE / about.wind_square?)),
        }
    }

    fn places(&self) -> Places {
        Places::MOMENT
    }

    fn needs(&self) -> Option<Regressor> {
        (*self == Self::Measured).then_some(Regressor::Wind)
    }
}

impl<R: Real> Acts<R> for WindMoment {
    fn yaw_acceleration(&self, p: &[R], _z: &[R], now: &Now<R>) -> R {
        match self {
            Self::Steady => {
                let (sin, cos) = (now.heading * 2.0).sin_cos();
                now.gain * (p[0] * cos + p[1] * sin)
            }
            Self::Measured => match (now.measured.wind_speed, now.measured.wind_from) {
                (Some(speed), Some(from)) => now.gain * p[0] * speed * speed * from.sin(),
                _ => R::from(0.0),
            },
        }
    }
}
