//! Effects that a first-order response lacks: formulas in one list, and a file for each effect with memory or states.
//!
//! An effect is structure only; its parameter values are a separate slice in the order of [`Effect::parameters`]. The
//! same effect acts in a simulation and is a candidate explanation of a residual. With all parameters at their neutral
//! values, a model with the effect equals the model without it.
//!
//! An effect can transform the acting rudder (with memory), add states, scale damping and gain, add a yaw acceleration,
//! and add to the observed heading; all are optional. To add an effect, add a row to `list.rs`.
//!
//! The sources of an effect are given with its equation.

mod backlash;
mod effect;
mod formula;
pub mod instant;
mod list;
mod scenario_key;

mod second_order;
mod speed_loss;
mod steering_lag;
mod transient_disturbance;
mod wave_heading;

pub use backlash::Backlash;
pub use effect::{
    BaseFactors, CandidateEffect, Effect, EffectDescription, EffectEquations, EffectReal, EffectTarget, OperatingPoint,
    Parameter, ParameterPrior, RecordScales, SecondOrderTimeConstants,
};
pub use formula::{ColumnFormula, Formula, FormulaError, MirrorSymmetry};
pub use list::{all_effects, effect_meaning, listed_effect};
pub use scenario_key::{NumberConversion, ScenarioKey};
pub use second_order::SecondOrder;
pub use speed_loss::SpeedLoss;
pub use steering_lag::SteeringLag;
pub use transient_disturbance::TransientDisturbance;
pub use wave_heading::WaveHeading;

use std::sync::Arc;

use crate::particulars::Dimension;

/// Effect of a line `name = formula`, optionally followed by expectations of constants, `; k about 5` or
/// `; k from 1 to 20`.
///
/// Fails with the position and the expected symbols, and for the name of an effect of the list.
pub fn parse_formula(line: &str) -> Result<Arc<Formula>, FormulaError> {
    let formula = Formula::parse(line)?;
    if all_effects().iter().any(|effect| effect.id() == formula.id()) {
        let problem = format!("`{}` is on the list of effects; give the formula another name", formula.id());
        return Err(FormulaError { text: line.to_owned(), position: 0, problem });
    }
    Ok(formula)
}

/// Effect with this identifier and form, with neutral constants; `None` if there is no such effect. An identifier that
/// is not on the list belongs to a formula, whose text is the form.
pub fn effect_form(id: &str, form: &str) -> Option<Arc<dyn Effect>> {
    let listed: Vec<Arc<dyn Effect>> = all_effects().into_iter().filter(|effect| effect.id() == id).collect();
    match listed.is_empty() {
        true => Some(Formula::named(id, form).ok()?),
        false => listed.into_iter().find(|effect| effect.form() == form),
    }
}

/// Effect with this identifier, form and constants ([`Effect::constants`]); `None` if there is no such effect, or if
/// the number of constants differs.
///
/// A constant with a positive neutral value must be positive: an approach speed (m/s), a propeller rate (1/s), a length
/// (m), an edge (s).
pub fn find_effect(id: &str, form: &str, constants: &[f64]) -> Option<Arc<dyn Effect>> {
    let effect = effect_form(id, form)?;
    let neutral = effect.constants();
    let can_be =
        |((neutral, _), value): (&(f64, Dimension), &f64)| value.is_finite() && (*value > 0.0 || *neutral == 0.0);
    if neutral.len() != constants.len() || !neutral.iter().zip(constants).all(can_be) {
        return None;
    }
    if constants.is_empty() { Some(effect) } else { effect.with_constants(constants) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Round trip: identifier, form and constants restore an effect.
    #[test]
    fn every_effect_is_found_by_what_is_written_of_it() {
        for effect in all_effects() {
            let constants: Vec<f64> = effect.constants().iter().map(|(constant, _)| constant + 1.5).collect();
            let again = find_effect(effect.id(), effect.form(), &constants).expect("all are known");
            let read_back: Vec<f64> = again.constants().into_iter().map(|(constant, _)| constant).collect();
            assert_eq!((again.id(), again.form(), read_back), (effect.id(), effect.form(), constants));
        }
        assert!(
            find_effect("second_order", "", &[1.0]).is_none()
                && find_effect("speed_loss", "measured speed", &[-1.0]).is_none()
        );
    }

    #[test]
    fn an_identifier_on_no_list_is_that_of_a_formula() {
        let own = effect_form("bank", "c * v").expect("a formula");
        assert!(own.uses(crate::RegressorChannel::Sway) && !own.uses(crate::RegressorChannel::Wind));
        assert!(effect_form("second_order", "c * v").is_none() && effect_form("bank", "c *").is_none());
    }
}
