//! Effects a first-order response lacks, one file each.
//!
//! An effect is structure only: its parameters travel beside it as a slice in the order of [`Effect::parameters`]. The
//! same effect simulates an undeclared influence and is a candidate when a residual is traced. With all parameters at
//! their neutral value a model with the effect is the model without it.
//!
//! An effect may act in five places, all optional: it can transform the rudder that acts (with memory), add states,
//! scale damping and gain, add a yaw acceleration, and add to the heading that is seen. To add one: a file here, one
//! line in [`all`].

mod effect;
mod formula;
pub mod instant;
mod moment_drift;
mod nonlinear_damping;
mod port_starboard_asymmetry;
mod rudder_deadband;
mod rudder_saturation;
mod second_order;
mod speed_loss;
mod steering_lag;
mod sway_coupling_measured;
mod transient_disturbance;
mod wave_yaw;
mod wind_moment;

pub use effect::{
    Acts, Description, Effect, EffectReal, Manoeuvres, Now, Parameter, Places, Prior, Proposal, Scale, SwayCoupling,
};
pub use formula::{Formula, FormulaError, Sides};
pub use moment_drift::MomentDrift;
pub use nonlinear_damping::NonlinearDamping;
pub use port_starboard_asymmetry::PortStarboardAsymmetry;
pub use rudder_deadband::RudderDeadband;
pub use rudder_saturation::RudderSaturation;
pub use second_order::SecondOrder;
pub use speed_loss::SpeedLoss;
pub use steering_lag::SteeringLag;
pub use sway_coupling_measured::SwayCouplingMeasured;
pub use transient_disturbance::TransientDisturbance;
pub use wave_yaw::WaveYaw;
pub use wind_moment::WindMoment;

use std::sync::Arc;

/// Every effect in every form, in the order of reports.
///
/// Forms that need a constant of the record have it at a neutral value: approach speed 1 m/s, propeller
/// 1/s, reference time 0, edge of a lasting moment 1 s.
pub fn all() -> Vec<Arc<dyn Effect>> {
    vec![
        Arc::new(SecondOrder),
        Arc::new(NonlinearDamping::Cubic),
        Arc::new(NonlinearDamping::Quadratic),
        Arc::new(NonlinearDamping::Square),
        Arc::new(WindMoment::Measured),
        Arc::new(WindMoment::Steady),
        Arc::new(SpeedLoss::Modelled),
        Arc::new(SpeedLoss::Measured { approach_speed: 1.0 }),
        Arc::new(SpeedLoss::Inflow { approach_speed: 1.0, approach_rate: 1.0 }),
        Arc::new(SpeedLoss::Propeller { approach_rate: 1.0 }),
        Arc::new(SteeringLag::DeadTime),
        Arc::new(SteeringLag::FirstOrder),
        Arc::new(RudderSaturation),
        Arc::new(RudderDeadband::Backlash),
        Arc::new(RudderDeadband::DeadBand),
        Arc::new(PortStarboardAsymmetry::Gain),
        Arc::new(PortStarboardAsymmetry::Drift),
        Arc::new(MomentDrift { reference_time: 0.0 }),
        Arc::new(TransientDisturbance::Passing),
        Arc::new(TransientDisturbance::Lasting { edge: 1.0 }),
        Arc::new(WaveYaw),
        Arc::new(SwayCouplingMeasured { approach_speed: 1.0 }),
    ]
}

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
/// has other constants.
///
/// Any other identifier is that of a formula, which its form holds, for a ship of a length (m).
///
/// Constants are positive: an approach speed (m/s), a rate of the propeller (1/s), an edge (s); a reference time (s)
/// may be any.
pub fn named(id: &str, form: &str, constants: &[f64]) -> Option<Arc<dyn Effect>> {
    let Some(known) = all().into_iter().find(|effect| effect.id() == id && effect.form() == form) else {
        let &[length] = constants else { return None };
        return Some(Arc::new(Formula::named(id, form).ok()?.with_length(length)));
    };
    let holds = constants.iter().all(|constant| constant.is_finite()) && constants.len() == known.constants().len();
    if !holds {
        return None;
    }
    let positive = |constant: &f64| (*constant > 0.0).then_some(*constant);
    Some(match (id, constants) {
        (_, []) => known,
        ("speed_loss", [speed, rate]) => {
            Arc::new(SpeedLoss::Inflow { approach_speed: positive(speed)?, approach_rate: positive(rate)? })
        }
        ("speed_loss", [constant]) if known.needs() == Some(crate::dynamics::Regressor::Speed) => {
            Arc::new(SpeedLoss::Measured { approach_speed: positive(constant)? })
        }
        ("speed_loss", [constant]) => Arc::new(SpeedLoss::Propeller { approach_rate: positive(constant)? }),
        ("sway_coupling_measured", [speed]) => Arc::new(SwayCouplingMeasured { approach_speed: positive(speed)? }),
        ("moment_drift", [constant]) => Arc::new(MomentDrift { reference_time: *constant }),
        ("transient_disturbance", [constant]) => Arc::new(TransientDisturbance::Lasting { edge: positive(constant)? }),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is written down of an effect is enough to have it again.
    #[test]
    fn every_effect_is_found_by_what_is_written_of_it() {
        for effect in all() {
            let constants: Vec<f64> = effect.constants().iter().map(|constant| constant + 1.5).collect();
            let again = named(effect.id(), effect.form(), &constants).expect("all are known");
            assert_eq!((again.id(), again.form(), again.constants()), (effect.id(), effect.form(), constants));
        }
        assert!(
            named("second_order", "", &[1.0]).is_none() && named("speed_loss", "measured speed", &[-1.0]).is_none()
        );
    }
}
