//! Sway coupling: the second time constant and the zero of the second-order response.
//!
//! Source: Nomoto, Taguchi, Honda and Hirano (1957), On the steering qualities of ships.

use super::effect::{
    CandidateEffect, Effect, EffectDescription, EffectEquations, EffectTarget, Parameter, ParameterPrior, RecordScales,
    SecondOrderTimeConstants,
};
use estimation::number::Real;

/// Second-order response T₁T₂ r'' + (T₁+T₂) r' + r = K (δ + δ_r) + K T₃ δ', with T₁ = 1/a of the base.
///
/// The effect vanishes at T₂ = T₃, at which zero and pole cancel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SecondOrder;

#[rustfmt::skip]
const PARAMETERS: [Parameter; 2] = [
    Parameter::even(["T2", "T₂", "s"], [1.0, 2.5], [0.02, 600.0])
        .with_scenario_key("T2-s", 1.0, "Smaller time constant T2."),
    Parameter::even(["T3", "T₃", "s"], [1.0, 6.2], [-600.0, 2000.0])
        .with_scenario_key("T3-s", 1.0, "Time constant T3 of the rudder rate."),
];

impl Effect for SecondOrder {
    fn description(&self) -> EffectDescription {
        EffectDescription {
            id: "second_order",
            form: "sway coupling",
            equation: "T₁T₂ r'' + (T₁+T₂) r' + r = K (δ + δ_r) + K T₃ δ'",
            parameters: &PARAMETERS,
        }
    }

    /// Priors of T₂ and of T₃ − T₂, which is the amplitude: T₂U/L of hulls is 0.1 to 0.5 and T₃U/L 0.3 to 1.
    fn candidate(&self, records: &RecordScales) -> Option<CandidateEffect> {
        let time = records.ship_length_time;
        let shortest = PARAMETERS[0].lowest.max(0.1 * records.row_interval).max(0.04 * time);
        let second =
            ParameterPrior::normal(&PARAMETERS[0], 0.3 * time, 0.2 * time).within([shortest, 2.0 * time]).as_shape();
        let lead = ParameterPrior::normal(&PARAMETERS[1], 0.0, 0.4 * time);
        Some(CandidateEffect::new(*self, [second, ParameterPrior { reference_parameter: Some(0), ..lead }]))
    }

    fn acts_on(&self) -> EffectTarget {
        EffectTarget::NONE
    }

    /// One state, s of [`crate::response`], which the response integrates.
    fn states(&self) -> usize {
        1
    }

    fn min_time_constant(&self, p: &[f64]) -> f64 {
        p[0]
    }
}

impl<R: Real> EffectEquations<R> for SecondOrder {
    fn second_order_time_constants(&self, p: &[R]) -> Option<SecondOrderTimeConstants<R>> {
        Some(SecondOrderTimeConstants { T2: p[0], T3: p[1] })
    }
}
