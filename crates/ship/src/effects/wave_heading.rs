//! Yaw from first-order waves: a random narrow-band heading, added to the observed heading.
//!
//! Source: the wave model of Fossen (2011), Handbook of Marine Craft Hydrodynamics and Motion Control.

use super::effect::{
    CandidateEffect, Effect, EffectDescription, EffectEquations, EffectTarget, Parameter, RecordScales,
};
use crate::angle::DEGREE;
use crate::narrow_band::NarrowBandProcess;
use estimation::number::Real;

/// Wave yaw ξ'' + 2ζω₀ ξ' + ω₀² ξ = w, added to the observed heading; the deterministic response ignores it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WaveHeading;

#[rustfmt::skip]
const PARAMETERS: [Parameter; 3] = [
    Parameter::even(["sigma_w", "σ_w", "rad"], [0.0, 7e-3], [0.0, 0.2])
        .with_scenario_key("sd-deg", DEGREE, "Standard deviation of the heading they add."),
    Parameter::even(["omega0", "ω₀", "rad/s"], [0.6, 0.6], [0.02, 20.0])
        .with_scenario_key("frequency-rad-s", 1.0, "Frequency of encounter."),
    Parameter::even(["zeta", "ζ", "1"], [0.1, 0.1], [0.005, 0.7])
        .with_scenario_key("damping", 1.0, "Relative damping: the smaller, the narrower the band."),
];

impl Effect for WaveHeading {
    fn description(&self) -> EffectDescription {
        EffectDescription {
            id: "wave_yaw",
            form: "narrow band",
            equation: "ψ_seen = ψ + ξ, ξ'' + 2ζω₀ ξ' + ω₀² ξ = white noise",
            parameters: &PARAMETERS,
        }
    }

    /// `None`: wave yaw is not part of the response; it is identified as a part of the noise model.
    fn candidate(&self, _about: &RecordScales) -> Option<CandidateEffect> {
        None
    }

    fn acts_on(&self) -> EffectTarget {
        EffectTarget::NONE
    }

    fn is_environmental(&self) -> bool {
        true
    }

    fn random_heading(&self, p: &[f64]) -> Option<NarrowBandProcess> {
        (p[0] > 0.0).then(|| NarrowBandProcess { sd: p[0], frequency: p[1], damping: p[2] })
    }
}

impl<R: Real> EffectEquations<R> for WaveHeading {}
