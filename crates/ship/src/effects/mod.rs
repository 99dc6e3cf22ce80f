//! Effects a first-order response lacks: rows of formulas in one list, and a file each for those with memory or states.
//!
//! An effect is structure only: its parameters travel beside it as a slice in the order of [`Effect::parameters`]. The
//! same effect simulates an undeclared influence and is a candidate when a residual is traced. With all parameters at
//! their neutral value a model with the effect is the model without it.
//!
//! An effect may act in five places, all optional: it can transform the rudder that acts (with memory), add states,
//! scale damping and gain, add a yaw acceleration, and add to the heading that is seen. To add one: a row of `list.rs`.

mod backlash;
mod effect;
mod file_number;
mod formula;
pub mod instant;
mod list;

mod second_order;
mod speed_loss;
mod steering_lag;
mod transient_disturbance;
mod wave_yaw;

pub use backlash::Backlash;
pub use effect::{
    Acts, Description, Effect, EffectReal, Manoeuvres, Now, Parameter, Places, Prior, Proposal, Scale, SwayCoupling,
};
pub use file_number::{FileNumber, FileRole};
pub use formula::{ColumnFormula, Formula, FormulaError, Sides};
pub use list::{all, listed, meaning};
pub use second_order::SecondOrder;
pub use speed_loss::SpeedLoss;
pub use steering_lag::SteeringLag;
pub use transient_disturbance::TransientDisturbance;
pub use wave_yaw::WaveYaw;

use std::sync::Arc;

use crate::particulars::Dimension;

/// The effect of a line `name = formula`, with `; k about 5` or `; k from 1 to 20` behind it for a constant of which
/// something is known.
///
/// Fails with the place and what was expected there, and for the name of an effect of the list.
pub fn formula(line: &str) -> Result<Arc<Formula>, FormulaError> {
    let formula = Formula::read(line)?;
    if all().iter().any(|effect| effect.id() == formula.id()) {
        let problem = format!("`{}` is on the list of effects; give the formula another name", formula.id());
        return Err(FormulaError { text: line.to_owned(), at: 0, problem });
    }
    Ok(formula)
}

/// The effect with this identifier, form and constants ([`Effect::constants`]); `None` where there is none, or one that
/// has other constants. An identifier that is not on the list is that of a formula, which its form holds.
///
/// A constant whose neutral value is positive is positive: an approach speed (m/s), a rate of the propeller (1/s), a
/// length (m), an edge (s).
pub fn named(id: &str, form: &str, constants: &[f64]) -> Option<Arc<dyn Effect>> {
    let listed: Vec<Arc<dyn Effect>> = all().into_iter().filter(|effect| effect.id() == id).collect();
    let known = match listed.is_empty() {
        true => Formula::named(id, form).ok()?,
        false => listed.into_iter().find(|effect| effect.form() == form)?,
    };
    let neutral = known.constants();
    let can_be =
        |((neutral, _), value): (&(f64, Dimension), &f64)| value.is_finite() && (*value > 0.0 || *neutral == 0.0);
    if neutral.len() != constants.len() || !neutral.iter().zip(constants).all(can_be) {
        return None;
    }
    if constants.is_empty() { Some(known) } else { known.with_constants(constants) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is written down of an effect is enough to have it again.
    #[test]
    fn every_effect_is_found_by_what_is_written_of_it() {
        for effect in all() {
            let constants: Vec<f64> = effect.constants().iter().map(|(constant, _)| constant + 1.5).collect();
            let again = named(effect.id(), effect.form(), &constants).expect("all are known");
            let found: Vec<f64> = again.constants().into_iter().map(|(constant, _)| constant).collect();
            assert_eq!((again.id(), again.form(), found), (effect.id(), effect.form(), constants));
        }
        assert!(
            named("second_order", "", &[1.0]).is_none() && named("speed_loss", "measured speed", &[-1.0]).is_none()
        );
    }
}
