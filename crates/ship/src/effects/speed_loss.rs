//! Speed loss in a turn, which reduces gain and damping of the yaw response.
//!
//! Source: K = K' U/L and T = T' L/U of the prime system (Norrbin 1971).

use std::sync::Arc;

use super::effect::{
    BaseFactors, CandidateEffect, Effect, EffectDescription, EffectEquations, EffectTarget, OperatingPoint, Parameter,
    ParameterPrior, RecordScales,
};
use super::scenario_key::PER_DEGREE_SQUARED;
use crate::dynamics::RegressorChannel;
use crate::particulars::Dimension;
use estimation::number::Real;

/// Speed loss: K ~ U and T ~ 1/U, so a = 1/T ~ U and b = K/T ~ U².
///
/// A propeller at constant revolutions sustains the inflow to the rudder, so the exponent of b can be below two; it is
/// a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SpeedLoss {
    /// Speed ratio q = U/U₀ as a state: q' = (1 − q)/T_u − c r².
    Modelled,
    /// Speed ratio q from the measured speed; 1 if the record has none.
    Measured {
        /// Approach speed U₀, m/s.
        approach_speed: f64,
    },
    /// Damping and rudder inflow from the measured speed and, where available, the measured revolutions n: a ~ 1 + m_a
    /// (q − 1), b ~ (1 + e (q − 1) + e_n (n/n₀ − 1))². e_n is the share of the inflow that the propeller sustains.
    Inflow {
        /// Approach speed U₀, m/s.
        approach_speed: f64,
        /// Revolutions n₀ of the approach, 1/s.
        approach_revolutions: f64,
    },
    /// Rudder inflow from the measured propeller revolutions n: b ~ (n/n₀)^m; unchanged if there are none.
    Propeller {
        /// Revolutions n₀ of the approach, 1/s.
        approach_revolutions: f64,
    },
}

impl SpeedLoss {
    /// Exponents (m_a, m_b) of a rudder in the free stream: K ~ U and T ~ 1/U.
    pub const FREE_STREAM_EXPONENTS: [f64; 2] = [1.0, 2.0];
}

#[rustfmt::skip]
const MODELLED: [Parameter; 3] = [
    Parameter::even(["c_u", "c_u", "s/rad²"], [0.0, 15.0], [0.0, 1e5])
        .with_scenario_key("loss-s-per-deg2", PER_DEGREE_SQUARED, "Rate of loss for a squared yaw rate of 1 deg²/s²."),
    Parameter::even(["T_u", "T_u", "s"], [100.0, 100.0], [1.0, 1e4])
        .with_scenario_key("recovery-s", 1.0, "Time in which the speed comes back."),
    Parameter::even(["m_b", "m_b", "1"], [2.0, 2.0], [0.0, 3.0])
        .with_scenario_key("gain-exponent", 1.0, "Power of the speed in the gain of the rudder.")
        .by_default(SpeedLoss::FREE_STREAM_EXPONENTS[1]),
];
const MEASURED: [Parameter; 2] = [
    Parameter::even(["m_a", "m_a", "1"], [0.0, 1.0], [-1.0, 3.0]),
    Parameter::even(["m_b", "m_b", "1"], [0.0, 2.0], [-1.0, 4.0]),
];

const PROPELLER: [Parameter; 1] = [Parameter::even(["m_n", "m_n", "1"], [0.0, 2.0], [-1.0, 4.0])];
const INFLOW: [Parameter; 3] = [
    Parameter { typical: 1.0, ..MEASURED[0] },
    Parameter { key: "e", symbol: "e", typical: 0.5, lowest: -0.5, highest: 1.5, ..MEASURED[0] },
    Parameter { key: "e_n", symbol: "e_n", typical: 0.5, lowest: -0.5, highest: 1.5, ..MEASURED[0] },
];

/// Minimum speed ratio at which the scaling laws are evaluated, so that a bad trial step of a search stays finite.
const MIN_SPEED_RATIO: f64 = 0.05;

impl Effect for SpeedLoss {
    fn description(&self) -> EffectDescription {
        let (form, equation, parameters): (_, _, &[Parameter]) = match self {
            Self::Modelled => {
                ("modelled speed", "r' = −(q/T) r + (K/T) q^m_b (δ + δ_r), q' = (1 − q)/T_u − c_u r²", &MODELLED)
            }
            Self::Measured { .. } => {
                ("measured speed", "r' = −(q^m_a/T) r + (K/T) q^m_b (δ + δ_r), q = U/U₀", &MEASURED)
            }
            Self::Inflow { .. } => (
                "inflow share",
                "r' = −(1 + m_a (q − 1))/T r + (K/T) (1 + e (q − 1) + e_n (n/n₀ − 1))² (δ + δ_r), q = U/U₀",
                &INFLOW,
            ),
            Self::Propeller { .. } => ("measured propeller", "r' = −r/T + (K/T) (n/n₀)^m_n (δ + δ_r)", &PROPELLER),
        };
        EffectDescription { id: "speed_loss", form, equation, parameters }
    }

    fn constants(&self) -> Vec<(f64, Dimension)> {
        let (speed, rate) = (|value| (value, [-1, 1]), |value| (value, [-1, 0]));
        match *self {
            Self::Modelled => Vec::new(),
            Self::Measured { approach_speed } => vec![speed(approach_speed)],
            Self::Inflow { approach_speed, approach_revolutions } => {
                vec![speed(approach_speed), rate(approach_revolutions)]
            }
            Self::Propeller { approach_revolutions } => vec![rate(approach_revolutions)],
        }
    }

    fn with_constants(&self, constants: &[f64]) -> Option<Arc<dyn Effect>> {
        Some(Arc::new(match (self, constants) {
            (Self::Measured { .. }, &[approach_speed]) => Self::Measured { approach_speed },
            (Self::Inflow { .. }, &[approach_speed, approach_revolutions]) => {
                Self::Inflow { approach_speed, approach_revolutions }
            }
            (Self::Propeller { .. }, &[approach_revolutions]) => Self::Propeller { approach_revolutions },
            _ => return None,
        }))
    }

    /// Priors from hulls: loss c_u U/L of 0 ± 1, recovery time T_u U/L of 7 ± 4; with a measured speed, free-stream
    /// share e of 0.5 ± 0.25.
    fn candidate(&self, records: &RecordScales) -> Option<CandidateEffect> {
        let time = records.ship_length_time;
        let propeller = |mean| match records.rms_propeller_rate {
            Some(_) => ParameterPrior::normal(&INFLOW[2], mean, 0.25),
            None => ParameterPrior::fixed(0.0),
        };
        match self {
            // With a measured speed, the speed loss is not modelled.
            Self::Modelled if records.approach_speed.is_some() => None,
            Self::Modelled => {
                let recovery = ParameterPrior::normal(&MODELLED[1], 7.0 * time, 4.0 * time)
                    .within([time, 2.0 * records.duration.max(time)]);
                let loss = ParameterPrior::normal(&MODELLED[0], 0.0, 1.0 * time);
                Some(CandidateEffect::new(
                    *self,
                    [loss, recovery.as_shape(), ParameterPrior::fixed(Self::FREE_STREAM_EXPONENTS[1])],
                ))
            }
            Self::Measured { .. } => None,
            Self::Inflow { .. } => {
                let inflow = Self::Inflow {
                    approach_speed: records.approach_speed?,
                    approach_revolutions: records.rms_propeller_rate.unwrap_or(1.0),
                };
                let speed =
                    [ParameterPrior::normal(&INFLOW[0], 1.0, 0.3), ParameterPrior::normal(&INFLOW[1], 0.5, 0.25)];
                Some(CandidateEffect::new(inflow, [speed[0], speed[1], propeller(0.5)]))
            }
            Self::Propeller { .. } if records.approach_speed.is_some() => None,
            Self::Propeller { .. } => {
                let prior = ParameterPrior::normal(&PROPELLER[0], Self::FREE_STREAM_EXPONENTS[1], 1.0);
                Some(CandidateEffect::new(
                    Self::Propeller { approach_revolutions: records.rms_propeller_rate? },
                    [prior],
                ))
            }
        }
    }

    fn acts_on(&self) -> EffectTarget {
        EffectTarget::RESPONSE_SCALE
    }

    fn needs(&self) -> Option<RegressorChannel> {
        match self {
            Self::Modelled => None,
            Self::Measured { .. } | Self::Inflow { .. } => Some(RegressorChannel::Speed),
            Self::Propeller { .. } => Some(RegressorChannel::Propeller),
        }
    }

    fn uses(&self, channel: RegressorChannel) -> bool {
        let also = matches!(self, Self::Inflow { .. }) && channel == RegressorChannel::Propeller;
        also || self.needs() == Some(channel)
    }

    fn states(&self) -> usize {
        match self {
            Self::Modelled => 1,
            _ => 0,
        }
    }

    fn min_time_constant(&self, p: &[f64]) -> f64 {
        match self {
            Self::Modelled => p[1],
            _ => f64::INFINITY,
        }
    }
}

impl<R: Real> EffectEquations<R> for SpeedLoss {
    fn approach(&self, _p: &[R], _now: &OperatingPoint<R>, z: &mut [R]) {
        z.fill(R::from(1.0));
    }

    fn rates(&self, p: &[R], z: &[R], now: &OperatingPoint<R>, _before: R, rate: &mut [R]) {
        if let Self::Modelled = self {
            rate[0] = (R::from(1.0) - z[0]) / p[1] - p[0] * now.yaw_rate * now.yaw_rate;
        }
    }

    fn base_factors(&self, p: &[R], z: &[R], now: &OperatingPoint<R>) -> BaseFactors<R> {
        match self {
            Self::Modelled => {
                let q = z[0].at_least(MIN_SPEED_RATIO);
                // The free-stream exponent is not fitted and requires no power function.
                let gain = if p[2] == R::from(Self::FREE_STREAM_EXPONENTS[1]) { q * q } else { q.powf(p[2]) };
                BaseFactors { damping: q, gain }
            }
            Self::Measured { approach_speed } => match now.measured.speed {
                Some(speed) => {
                    let q = R::from((speed / approach_speed).max(MIN_SPEED_RATIO));
                    BaseFactors { damping: q.powf(p[0]), gain: q.powf(p[1]) }
                }
                None => BaseFactors::unity(),
            },
            Self::Inflow { approach_speed, approach_revolutions } => {
                let change = |measured: Option<f64>, base: f64| measured.map_or(0.0, |value| value / base - 1.0);
                let (q, n) = (
                    change(now.measured.speed, *approach_speed),
                    change(now.measured.propeller_rate, *approach_revolutions),
                );
                let flow = (p[1] * q + p[2] * n + 1.0).at_least(MIN_SPEED_RATIO);
                BaseFactors { damping: (p[0] * q + 1.0).at_least(MIN_SPEED_RATIO), gain: flow * flow }
            }
            Self::Propeller { approach_revolutions } => match now.measured.propeller_rate {
                Some(rate) => {
                    let q = R::from((rate / approach_revolutions).max(MIN_SPEED_RATIO));
                    BaseFactors { damping: R::from(1.0), gain: q.powf(p[0]) }
                }
                None => BaseFactors::unity(),
            },
        }
    }
}
