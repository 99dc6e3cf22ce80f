//! Steering lag: delay between the recorded and the acting rudder by dead time, first-order lag or clock offset.

use super::effect::{
    CandidateEffect, Effect, EffectDescription, EffectEquations, EffectTarget, OperatingPoint, Parameter,
    ParameterPrior, RecordScales,
};
use estimation::number::Real;

/// Lag of the acting rudder behind the recorded rudder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SteeringLag {
    /// Dead time: δ_e(t) = δ(t − τ); a negative τ is a clock offset, never a steering gear.
    DeadTime,
    /// First-order lag: τ_E δ_e' + δ_e = δ.
    FirstOrder,
}

const DEAD_TIME: [Parameter; 1] =
    [Parameter::even(["tau", "τ", "s"], [0.0, 1.0], [-20.0, 20.0]).with_scenario_key("dead-time-s", 1.0, "Dead time.")];
const FIRST_ORDER: [Parameter; 1] = [Parameter::even(["tau_E", "τ_E", "s"], [0.0, 1.0], [0.0, 30.0])
    .with_scenario_key("first-order-s", 1.0, "Time constant of a first-order lag.")];

/// Minimum lag, s; a shorter lag is below the resolution of any record and is neglected.
const MIN_LAG_S: f64 = 0.02;

impl Effect for SteeringLag {
    fn description(&self) -> EffectDescription {
        let (form, equation, parameters): (_, _, &[Parameter]) = match self {
            Self::DeadTime => ("dead time", "T r' + r = K (δ(t − τ) + δ_r)", &DEAD_TIME),
            Self::FirstOrder => ("first-order lag", "T r' + r = K (δ_e + δ_r), τ_E δ_e' + δ_e = δ", &FIRST_ORDER),
        };
        EffectDescription { id: "steering_lag", form, equation, parameters }
    }

    fn candidate(&self, records: &RecordScales) -> Option<CandidateEffect> {
        let RecordScales { ship_length_time, row_interval, .. } = *records;
        let sd = 0.1 * ship_length_time + 0.2 * row_interval;
        Some(match self {
            Self::DeadTime => {
                let longest = (4.0 * sd).min(DEAD_TIME[0].highest);
                CandidateEffect::new(
                    *self,
                    [ParameterPrior::normal(&DEAD_TIME[0], 0.0, sd).within([-longest, longest])],
                )
            }
            Self::FirstOrder => {
                // A lag below a quarter of the sampling interval is not resolved. If this exceeds the maximum lag,
                // there is no candidate.
                let shortest = Some(MIN_LAG_S.max(0.25 * row_interval)).filter(|lag| *lag < FIRST_ORDER[0].highest)?;
                CandidateEffect::new(
                    *self,
                    [ParameterPrior::normal(&FIRST_ORDER[0], 0.0, sd).within([shortest, FIRST_ORDER[0].highest])],
                )
            }
        })
    }

    fn acts_on(&self) -> EffectTarget {
        match self {
            Self::DeadTime => EffectTarget::NONE,
            Self::FirstOrder => EffectTarget::RUDDER,
        }
    }

    fn states(&self) -> usize {
        match self {
            Self::DeadTime => 0,
            Self::FirstOrder => 1,
        }
    }

    fn min_time_constant(&self, p: &[f64]) -> f64 {
        match self {
            Self::DeadTime => f64::INFINITY,
            Self::FirstOrder => p[0].max(MIN_LAG_S),
        }
    }
}

impl<R: Real> EffectEquations<R> for SteeringLag {
    fn approach(&self, _p: &[R], now: &OperatingPoint<R>, z: &mut [R]) {
        z.fill(now.rudder);
    }

    fn dead_time(&self, p: &[R]) -> R {
        match self {
            Self::DeadTime => p[0],
            Self::FirstOrder => R::from(0.0),
        }
    }

    fn rudder(&self, p: &[R], z: &[R], rudder: R) -> R {
        match self {
            Self::FirstOrder if p[0].value() >= MIN_LAG_S => z[0],
            _ => rudder,
        }
    }

    fn rates(&self, p: &[R], z: &[R], _now: &OperatingPoint<R>, before: R, rate: &mut [R]) {
        if let Self::FirstOrder = self {
            rate[0] = (before - z[0]) / p[0].at_least(MIN_LAG_S);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_with_long_steps_shows_no_first_order_lag() {
        let records = |row_interval: f64| RecordScales {
            ship_length_time: 20.0,
            max_rudder: 0.35,
            duration: 1e5,
            row_interval,
            approach_speed: None,
            approach_speed_for_sway: None,
            mean_square_wind_speed: None,
            rms_propeller_rate: None,
            time_span: [0.0, 1e5],
        };
        for effect in [SteeringLag::DeadTime, SteeringLag::FirstOrder] {
            assert!(effect.candidate(&records(1.0)).is_some());
            let is_dead_time = effect == SteeringLag::DeadTime;
            assert_eq!(effect.candidate(&records(1000.0)).is_some(), is_dead_time);
        }
    }
}
