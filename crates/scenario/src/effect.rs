//! Effects of a scenario: from degrees and seconds to the parameters of [`ship::effects`], each checked against the
//! range its effect declares.

use std::sync::Arc;

use ship::angle::{DEGREE, from_deg};
use ship::effects::{
    Effect, MomentDrift, NonlinearDamping, PortStarboardAsymmetry, RudderDeadband, RudderSaturation, SecondOrder,
    SpeedLoss, SteeringLag, TransientDisturbance, WaveYaw, WindMoment,
};
use ship::ships::Model;
use ship::{ResponseModel, Ship, Shown};
use simulate::disturbance::WaveSpectrum;
use trial::degrees::written_deg;

use crate::limits;
use crate::problem::{KeyPath, ScenarioProblem};
use crate::wire::*;

/// The keys a scenario has for an effect in one of its forms; `None` for a form that needs a measured record.
pub fn keys(effect: &dyn Effect) -> Option<&'static str> {
    Some(match (effect.id(), effect.parameters().first()?.symbol) {
        ("second_order", _) => "T2-s, T3-s",
        ("nonlinear_damping", "n₃/T") => "n3-s2-per-deg2",
        ("nonlinear_damping", "n₂/T") => "n2-s-per-deg",
        ("nonlinear_damping", _) => "n11-s-per-deg",
        ("wind_moment", "w_c") => "rudder-deg, from-deg",
        ("speed_loss", "c_u") => "loss-s-per-deg2, recovery-s, gain-exponent",
        ("steering_lag", "τ") => "dead-time-s",
        ("steering_lag", _) => "first-order-s",
        ("rudder_saturation", _) => "c3-per-deg2",
        ("rudder_deadband", _) if effect.form() == RudderDeadband::Backlash.form() => "backlash-deg",
        ("rudder_deadband", _) => "dead-band-deg",
        ("port_starboard_asymmetry", "a") => "gain-share",
        ("port_starboard_asymmetry", _) => "moment-by-drift-s",
        ("moment_drift", _) => "rudder-deg-per-s",
        ("transient_disturbance", _) if effect.parameters().len() == 3 => "rudder-deg, centre-s, duration-s",
        ("wave_yaw", _) => "sd-deg, frequency-rad-s, damping",
        _ => return None,
    })
}

/// The ship with effects added to its response.
///
/// Fails for a hull, whose equations hold such effects already, for a second-order effect on a ship that has one, and
/// for a parameter outside its range.
pub fn added(ship: Ship, wire: &[EffectWire]) -> Result<Ship, ScenarioProblem> {
    if wire.is_empty() {
        return Ok(ship);
    }
    limits::entries("effect", wire.len(), limits::MOST_EFFECTS)?;
    let list = KeyPath::dotted("effect");
    let Model::Response(response) = &ship.model else {
        return Err(ScenarioProblem::name(
            list,
            format!("an effect is added to `{}`, a hull with its own equations", ship.id),
            "effects belong to response models",
            "leave the effects out, or use a response ship such as yukun, first-order or second-order",
        ));
    };
    let inverse_time = response.parameters()[0];
    let mut effects = response.model().effects().to_vec();
    let mut parameters = response.parameters().to_vec();
    for (index, wire) in wire.iter().enumerate() {
        let (effect, settings) = of(wire, inverse_time);
        let key = list.child(index).child(effect.id());
        if effect.id() == "second_order" && effects.iter().any(|other| other.id() == effect.id()) {
            return Err(ScenarioProblem::name(
                key,
                format!("the ship `{}` is of second order already", ship.id),
                "expected at most one such effect",
                "leave it out, or use a first-order ship",
            ));
        }
        for (description, setting) in effect.parameters().iter().zip(&settings) {
            if !description.holds(setting.value) {
                let key = key.child(setting.key);
                let mut ends =
                    [description.lowest, description.highest].map(|end| Shown::rounded(end / setting.unit, 4));
                // Divided by the T of a course-unstable ship, the lower end becomes the upper.
                ends.sort_by(|one, other| one.0.total_cmp(&other.0));
                return Err(ScenarioProblem::value(
                    key.clone(),
                    format!("`{key}` is {}", Shown(setting.written)),
                    format!("expected a number from {} to {}", ends[0], ends[1]),
                    format!("change the value; the effect is {}", effect.equation()),
                ));
            }
        }
        effects.push(effect);
        parameters.extend(settings.iter().map(|setting| setting.value));
    }
    let model = Model::Response(ResponseModel::new(effects).with(parameters));
    Ok(Ship { model, ..ship })
}

/// One parameter and the key it comes from.
struct EffectNumber {
    /// Value, SI and rad.
    value: f64,
    /// Key below the effect.
    key: &'static str,
    /// The number behind the key.
    written: f64,
    /// The unit of that number in SI.
    unit: f64,
}

fn setting(key: &'static str, written: f64, unit: f64) -> EffectNumber {
    EffectNumber { value: written * unit, key, written, unit }
}

/// The effect and its parameters; nonlinear damping is written for T r' + r and stored for r', divided by T.
fn of(wire: &EffectWire, inverse_time: f64) -> (Arc<dyn Effect>, Vec<EffectNumber>) {
    let per_degree = 1.0 / DEGREE;
    match *wire {
        EffectWire::SecondOrder(SwayCouplingWire { T2_s, T3_s }) => {
            (Arc::new(SecondOrder), vec![setting("T2-s", T2_s, 1.0), setting("T3-s", T3_s, 1.0)])
        }
        EffectWire::NonlinearDamping(DampingWire::Cubic(n3)) => (
            Arc::new(NonlinearDamping::Cubic),
            vec![setting("n3-s2-per-deg2", n3, per_degree * per_degree * inverse_time)],
        ),
        EffectWire::NonlinearDamping(DampingWire::Quadratic(n2)) => {
            (Arc::new(NonlinearDamping::Quadratic), vec![setting("n2-s-per-deg", n2, per_degree * inverse_time)])
        }
        EffectWire::NonlinearDamping(DampingWire::Square(n11)) => {
            (Arc::new(NonlinearDamping::Square), vec![setting("n11-s-per-deg", n11, per_degree * inverse_time)])
        }
        EffectWire::WindMoment(WindMomentWire { rudder_deg, from_deg: from }) => {
            let twice = 2.0 * from_deg(from);
            let component = |share: f64| match from.is_finite() {
                true => {
                    EffectNumber { value: from_deg(rudder_deg) * share, ..setting("rudder-deg", rudder_deg, DEGREE) }
                }
                false => setting("from-deg", from, DEGREE),
            };
            (Arc::new(WindMoment::Steady), vec![component(twice.sin()), component(-twice.cos())])
        }
        EffectWire::SpeedLoss(SpeedLossWire { loss_s_per_deg2, recovery_s, gain_exponent }) => (
            Arc::new(SpeedLoss::Modelled),
            vec![
                setting("loss-s-per-deg2", loss_s_per_deg2, per_degree * per_degree),
                setting("recovery-s", recovery_s, 1.0),
                setting("gain-exponent", gain_exponent, 1.0),
            ],
        ),
        EffectWire::SteeringLag(LagWire::DeadTimeS(time)) => {
            (Arc::new(SteeringLag::DeadTime), vec![setting("dead-time-s", time, 1.0)])
        }
        EffectWire::SteeringLag(LagWire::FirstOrderS(time)) => {
            (Arc::new(SteeringLag::FirstOrder), vec![setting("first-order-s", time, 1.0)])
        }
        EffectWire::RudderSaturation(SaturationWire { c3_per_deg2 }) => {
            (Arc::new(RudderSaturation), vec![setting("c3-per-deg2", c3_per_deg2, per_degree * per_degree)])
        }
        EffectWire::RudderDeadband(DeadBandWire::BacklashDeg(width)) => {
            (Arc::new(RudderDeadband::Backlash), vec![setting("backlash-deg", width, DEGREE)])
        }
        EffectWire::RudderDeadband(DeadBandWire::DeadBandDeg(width)) => {
            (Arc::new(RudderDeadband::DeadBand), vec![setting("dead-band-deg", width, DEGREE)])
        }
        EffectWire::PortStarboardAsymmetry(AsymmetryWire::GainShare(share)) => {
            (Arc::new(PortStarboardAsymmetry::Gain), vec![setting("gain-share", share, 1.0)])
        }
        EffectWire::PortStarboardAsymmetry(AsymmetryWire::MomentByDriftS(time)) => {
            (Arc::new(PortStarboardAsymmetry::Drift), vec![setting("moment-by-drift-s", time, 1.0)])
        }
        EffectWire::MomentDrift(DriftWire { rudder_deg_per_s }) => {
            (Arc::new(MomentDrift { reference_time: 0.0 }), vec![setting("rudder-deg-per-s", rudder_deg_per_s, DEGREE)])
        }
        EffectWire::TransientDisturbance(TransientWire { rudder_deg, centre_s, duration_s }) => (
            Arc::new(TransientDisturbance::Passing),
            vec![
                setting("rudder-deg", rudder_deg, DEGREE),
                setting("centre-s", centre_s, 1.0),
                setting("duration-s", duration_s, 1.0),
            ],
        ),
        EffectWire::WaveYaw(WaveSpectrum { sd, frequency, damping }) => (
            Arc::new(WaveYaw),
            vec![
                EffectNumber { value: sd, key: "sd-deg", written: written_deg(sd), unit: DEGREE },
                setting("frequency-rad-s", frequency, 1.0),
                setting("damping", damping, 1.0),
            ],
        ),
    }
}
