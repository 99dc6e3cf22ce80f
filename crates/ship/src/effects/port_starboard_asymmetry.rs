//! A rudder gain that differs by side.

use super::effect::{Acts, Effect, Manoeuvres, Parameter, Places, Proposal};
use crate::number::Real;

/// K (δ + a |δ| + δ_r): gain 1 + a to starboard, 1 − a to port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PortStarboardAsymmetry;

const PARAMETERS: [Parameter; 1] = [Parameter {
    key: "a",
    symbol: "a",
    unit: "1",
    neutral: 0.0,
    typical: 0.05,
    lowest: -0.8,
    highest: 0.8,
    odd: true,
}];

impl Effect for PortStarboardAsymmetry {
    fn id(&self) -> &'static str {
        "port_starboard_asymmetry"
    }

    fn form(&self) -> &'static str {
        "gain by side"
    }

    fn equation(&self) -> &'static str {
        "T r' + r = K (δ + a |δ| + δ_r)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn proposal(&self, _about: &Manoeuvres) -> Option<Proposal> {
        Some(Proposal::of_one(*self, 1.0, 0.0, 0.2))
    }

    fn places(&self) -> Places {
        Places::RUDDER
    }
}

impl<R: Real> Acts<R> for PortStarboardAsymmetry {
    fn rudder(&self, p: &[R], _z: &[R], rudder: R) -> R {
        rudder + p[0] * rudder.abs()
    }
}
