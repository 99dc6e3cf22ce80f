//! Yaw from first-order waves: random, narrow-banded, added to the heading that is seen.

use super::effect::{Acts, Effect, Manoeuvres, Parameter, Places, Proposal};
use crate::narrow_band::NarrowBand;
use estimation::number::Real;

/// ξ'' + 2ζω₀ ξ' + ω₀² ξ = w added to the heading. The deterministic response knows nothing of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WaveYaw;

const PARAMETERS: [Parameter; 3] = [
    Parameter {
        key: "sigma_w",
        symbol: "σ_w",
        unit: "rad",
        neutral: 0.0,
        typical: 7e-3,
        lowest: 0.0,
        highest: 0.2,
        odd: false,
    },
    Parameter {
        key: "omega0",
        symbol: "ω₀",
        unit: "rad/s",
        neutral: 0.6,
        typical: 0.6,
        lowest: 0.02,
        highest: 20.0,
        odd: false,
    },
    Parameter {
        key: "zeta",
        symbol: "ζ",
        unit: "1",
        neutral: 0.1,
        typical: 0.1,
        lowest: 0.005,
        highest: 0.7,
        odd: false,
    },
];

impl Effect for WaveYaw {
    fn id(&self) -> &'static str {
        "wave_yaw"
    }

    fn form(&self) -> &'static str {
        "narrow band"
    }

    fn equation(&self) -> &'static str {
        "ψ_seen = ψ + ξ, ξ'' + 2ζω₀ ξ' + ω₀² ξ = white noise"
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    /// It is no response: it is looked for among the colours of the noise.
    fn proposal(&self, _about: &Manoeuvres) -> Option<Proposal> {
        None
    }

    fn places(&self) -> Places {
        Places::NONE
    }

    fn random_heading(&self, p: &[f64]) -> Option<NarrowBand> {
        (p[0] > 0.0).then(|| NarrowBand { sd: p[0], frequency: p[1], damping: p[2] })
    }
}

impl<R: Real> Acts<R> for WaveYaw {}
