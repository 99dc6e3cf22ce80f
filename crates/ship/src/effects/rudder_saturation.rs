//! A rudder that loses lift at large angles.

use super::effect::{Acts, Description, Effect, Manoeuvres, Parameter, Places, Prior, Proposal};
use estimation::number::Real;

/// δ_e = δ − c₃ δ³ (stall).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RudderSaturation;

const PARAMETERS: [Parameter; 1] = [Parameter::even(["c3", "c₃", "1/rad²"], [0.0, 0.5], [-2.0, 5.0])];

impl Effect for RudderSaturation {
    fn description(&self) -> Description {
        Description {
            id: "rudder_saturation",
            form: "stall",
            equation: "T r' + r = K (δ − c₃ δ³ + δ_r)",
            parameters: &PARAMETERS,
        }
    }

    /// Half of sin 2δ, the side force of a rudder whose lift is normal to its blade, is δ − ⅔ δ³; a hull that turns
    /// takes some of the angle away.
    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        // A larger rudder has the larger effect as far as the records go: c₃ < 1/(3 δ²).
        let largest = (about.rudder * about.rudder * 3.0).recip().min(PARAMETERS[0].highest);
        let prior = Prior::normal(&PARAMETERS[0], 0.0, 0.4);
        Some(Proposal::new(*self, [prior.within([PARAMETERS[0].lowest, largest])]))
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
