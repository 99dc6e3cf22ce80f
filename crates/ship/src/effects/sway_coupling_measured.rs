//! Sway velocity as a regressor, where the record has it.

use super::effect::{Acts, Effect, Manoeuvres, Now, Parameter, Places, Proposal};
use crate::dynamics::Regressor;
use crate::number::Real;

/// c v with the measured sway velocity v, as an equivalent rudder angle; zero where the record has none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SwayCouplingMeasured;

const PARAMETERS: [Parameter; 1] = [Parameter {
    key: "c_v",
    symbol: "c_v",
    unit: "rad s/m",
    neutral: 0.0,
    typical: 0.1,
    lowest: -100.0,
    highest: 100.0,
    odd: false,
}];

impl Effect for SwayCouplingMeasured {
    fn id(&self) -> &'static str {
        "sway_coupling_measured"
    }

    fn form(&self) -> &'static str {
        "measured sway"
    }

    fn equation(&self) -> &'static str {
        "T r' + r = K (δ + δ_r + c_v v)"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        Some(Proposal::of_one(*self, 0.5 * about.rudder / about.sway_square?.sqrt(), 0.0, 1.0))
    }

    fn places(&self) -> Places {
        Places::MOMENT
    }

    fn needs(&self) -> Option<Regressor> {
        Some(Regressor::Sway)
    }
}

impl<R: Real> Acts<R> for SwayCouplingMeasured {
    fn yaw_acceleration(&self, p: &[R], _z: &[R], now: &Now<R>) -> R {
        now.measured.sway.map_or(R::from(0.0), |sway| now.gain * p[0] * sway)
    }
}
