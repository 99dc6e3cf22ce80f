//! Sway velocity as a regressor, where the record has it.

use super::effect::{Acts, Description, Effect, Manoeuvres, Now, Parameter, Places, Prior, Proposal};
use crate::dynamics::Regressor;
use estimation::number::Real;

/// c_v q v with the measured sway velocity v, as an equivalent rudder angle; zero where the record has none. The moment
/// of a drifting hull is N_v u v, so it falls with the measured speed: q = U/U₀, 1 where the record has no speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SwayCouplingMeasured {
    /// Approach speed U₀, m/s.
    pub approach_speed: f64,
}

const PARAMETERS: [Parameter; 1] = [Parameter::even(["c_v", "c_v", "rad s/m"], [0.0, 0.1], [-100.0, 100.0])];

impl Effect for SwayCouplingMeasured {
    fn description(&self) -> Description {
        Description {
            id: "sway_coupling_measured",
            form: "measured sway",
            equation: "T r' + r = K (δ + δ_r + c_v q v), q = U/U₀",
            parameters: &PARAMETERS,
        }
    }

    /// N_v/N_δ of hulls is −3 ± 1.5 without dimension.
    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        let speed = about.sway?;
        let prior = Prior::normal(&PARAMETERS[0], -3.0 / speed, 1.5 / speed);
        Some(Proposal::new(Self { approach_speed: speed }, [prior]))
    }

    fn places(&self) -> Places {
        Places::MOMENT
    }

    fn needs(&self) -> Option<Regressor> {
        Some(Regressor::Sway)
    }

    fn uses(&self, channel: Regressor) -> bool {
        matches!(channel, Regressor::Sway | Regressor::Speed)
    }

    fn constants(&self) -> Vec<f64> {
        vec![self.approach_speed]
    }
}

impl<R: Real> Acts<R> for SwayCouplingMeasured {
    fn yaw_acceleration(&self, p: &[R], _z: &[R], now: &Now<R>) -> R {
        let speed = now.measured.speed.map_or(1.0, |speed| speed / self.approach_speed);
        now.measured.sway.map_or(R::from(0.0), |sway| now.gain * p[0] * (speed * sway))
    }
}
