//! Backlash (play) between the recorded and the acting rudder.
//!
//! Source: the play operator of Krasnosel'skii and Pokrovskii (1989), Systems with Hysteresis.

use super::effect::{
    CandidateEffect, Effect, EffectDescription, EffectEquations, EffectTarget, OperatingPoint, Parameter,
    ParameterPrior, RecordScales,
};
use crate::angle::DEGREE;
use estimation::number::Real;

/// Backlash of half-width g: the acting rudder stays within ±g of the recorded rudder and moves only after the play is
/// used up. The second form of the effect, a dead band, is a row of the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Backlash;

impl Backlash {
    /// Half-width g, rad.
    pub(super) const HALF_WIDTH: Parameter = Parameter::even(["g", "g", "rad"], [0.0, 0.012], [0.0, 0.15]);

    /// Prior mean, standard deviation and maximum of g, rad.
    pub(super) fn prior(records: &RecordScales) -> [f64; 3] {
        [0.0, 0.12 * records.max_rudder, 0.5 * records.max_rudder]
    }
}

impl Effect for Backlash {
    fn description(&self) -> EffectDescription {
        EffectDescription {
            id: "rudder_deadband",
            form: "backlash",
            equation: "T r' + r = K (δ_e + δ_r), |δ_e − δ| ≤ g (play)",
            parameters: &const {
                [Self::HALF_WIDTH.with_scenario_key("backlash-deg", DEGREE, "Half of the width of a backlash.")]
            },
        }
    }

    fn candidate(&self, records: &RecordScales) -> Option<CandidateEffect> {
        let ([mean, sd, largest], g) = (Self::prior(records), Self::HALF_WIDTH);
        Some(CandidateEffect::new(*self, [ParameterPrior::normal(&g, mean, sd).within([0.0, largest.min(g.highest)])]))
    }

    fn acts_on(&self) -> EffectTarget {
        EffectTarget::RUDDER
    }

    fn states(&self) -> usize {
        1
    }
}

impl<R: Real> EffectEquations<R> for Backlash {
    fn approach(&self, _p: &[R], now: &OperatingPoint<R>, z: &mut [R]) {
        z.fill(now.rudder);
    }

    /// Play operator: for a monotone rudder, the previous angle clamped to [δ − g, δ + g]; exact within a step.
    fn rudder(&self, p: &[R], z: &[R], rudder: R) -> R {
        let g = p[0].at_least(0.0);
        z[0].clamped(rudder - g, rudder + g)
    }

    fn rates(&self, _p: &[R], _z: &[R], _now: &OperatingPoint<R>, _before: R, rate: &mut [R]) {
        rate.fill(R::from(0.0));
    }

    fn update_memory(&self, p: &[R], z: &mut [R], before: R) {
        z[0] = self.rudder(p, z, before);
    }
}
