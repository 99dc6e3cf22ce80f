//! Play between the recorded and the acting rudder.

use super::effect::{Acts, Description, Effect, Manoeuvres, Now, Parameter, Places, Prior, Proposal};
use estimation::number::Real;

/// Backlash or dead band of half-width g.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RudderDeadband {
    /// The acting rudder follows only when the recorded one has taken up the play: it stays within ±g of it.
    Backlash,
    /// Angles below g do not act, larger ones act less g.
    DeadBand,
}

const PARAMETERS: [Parameter; 1] = [Parameter::even(["g", "g", "rad"], [0.0, 0.012], [0.0, 0.15])];

impl Effect for RudderDeadband {
    fn description(&self) -> Description {
        let (form, equation, parameters): (_, _, &[Parameter]) = match self {
            Self::Backlash => ("backlash", "T r' + r = K (δ_e + δ_r), |δ_e − δ| ≤ g (play)", &PARAMETERS),
            Self::DeadBand => ("dead band", "T r' + r = K (sgn δ max(|δ| − g, 0) + δ_r)", &PARAMETERS),
        };
        Description { id: "rudder_deadband", form, equation, parameters }
    }

    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        let largest = (0.5 * about.rudder).min(PARAMETERS[0].highest);
        let prior = Prior::normal(&PARAMETERS[0], 0.0, 0.12 * about.rudder);
        Some(Proposal::new(*self, [prior.within([0.0, largest])]))
    }

    fn places(&self) -> Places {
        Places::RUDDER
    }

    fn states(&self) -> usize {
        match self {
            Self::Backlash => 1,
            Self::DeadBand => 0,
        }
    }
}

impl<R: Real> Acts<R> for RudderDeadband {
    fn approach(&self, _p: &[R], now: &Now<R>, z: &mut [R]) {
        z.fill(now.rudder);
    }

    /// While the rudder is monotone the play operator is a clamp of where it was, which is exact within a step.
    fn rudder(&self, p: &[R], z: &[R], rudder: R) -> R {
        let g = p[0].at_least(0.0);
        match self {
            Self::Backlash => z[0].between(rudder - g, rudder + g),
            Self::DeadBand => (rudder.abs() - g).at_least(0.0) * rudder.value().signum(),
        }
    }

    fn rates(&self, _p: &[R], _z: &[R], _now: &Now<R>, _before: R, rate: &mut [R]) {
        rate.fill(R::from(0.0));
    }

    fn settle(&self, p: &[R], z: &mut [R], before: R) {
        if let Self::Backlash = self {
            z[0] = self.rudder(p, z, before);
        }
    }
}
