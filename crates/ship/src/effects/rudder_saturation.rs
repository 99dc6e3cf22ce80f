//! A rudder that loses lift at large angles.

use super::effect::{Acts, Effect, Manoeuvres, Parameter, Places, Proposal};
use crate::number::Real;

/// δ_e = δ − c₃ δ³ (stall).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RudderSaturation;

// The highest value keeps δ − c₃ δ³ growing up to 35 deg: c₃ < 1/(3 δ²).
const PARAMETERS: [Parameter; 1] = [Parameter {
    key: "c3",
    symbol: "c₃",
    unit: "1/rad²",
    neutral: 0.0,
    typical: 0.5,
    lowest: -2.0,
    highest: 0.9,
    odd: false,
}];

impl Effect for RudderSaturation {
    fn id(&self) -> &'static str {
        "rudder_saturation"
    }

    fn form(&self) -> &'static str {
        "stall"
    }

    fn equation(&self) -> &'static str {
        "T r' + r = K (δ − c₃ δ³ + δ_r)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    /// Half of sin 2δ, the side force of a rudder whose lift is normal to its blade, is δ − ⅔ δ³; a hull that turns
    /// takes some of the angle away.
    fn proposal(&self, _about: &Manoeuvres) -> Option<Proposal> {
        Some(Proposal::of_one(*self, 0.4))
    }

    fn places(&self) -> Places {
        Places::RUDDER
    }
}

impl<R: Real> Acts<R> for RudderSaturation {
    fn rudder(&self, p: &[R], _z: &[R], rudder: R) -> R {
        rudder - p[0] * rudder * rudder * rudder
    }
}
