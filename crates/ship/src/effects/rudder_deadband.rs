//! Play between the recorded and the acting rudder.

use super::{Effect, Now, Parameter};

/// Backlash or dead band of half-width g.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RudderDeadband {
    /// The acting rudder follows only when the recorded one has taken up the play: it stays within ±g of it.
    Backlash,
    /// Angles below g do not act, larger ones act less g.
    DeadBand,
}

const PARAMETERS: [Parameter; 1] =
    [Parameter { symbol: "g", unit: "rad", neutral: 0.0, typical: 0.012, lowest: 0.0, highest: 0.15, odd: false }];

impl Effect for RudderDeadband {
    fn id(&self) -> &'static str {
        "rudder_deadband"
    }

    fn form(&self) -> &'static str {
        match self {
            Self::Backlash => "backlash",
            Self::DeadBand => "dead band",
        }
    }

    fn equation(&self) -> &'static str {
        match self {
            Self::Backlash => "T r' + r = K (δ_e + δ_r), |δ_e − δ| ≤ g (play)",
            Self::DeadBand => "T r' + r = K (sgn δ max(|δ| − g, 0) + δ_r)",
        }
    }

    fn parameters(&self) -> &'static [Parameter] {
        &PARAMETERS
    }

    fn states(&self) -> usize {
        match self {
            Self::Backlash => 1,
            Self::DeadBand => 0,
        }
    }

    fn approach(&self, _p: &[f64], now: &Now, z: &mut [f64]) {
        z.fill(now.rudder);
    }

    /// While the rudder is monotone the play operator is a clamp of where it was, which is exact within a step.
    fn rudder(&self, p: &[f64], z: &[f64], rudder: f64) -> f64 {
        let g = p[0].max(0.0);
        match self {
            Self::Backlash => z[0].clamp(rudder - g, rudder + g),
            Self::DeadBand => rudder.signum() * (rudder.abs() - g).max(0.0),
        }
    }

    fn rates(&self, _p: &[f64], _z: &[f64], _now: &Now, _before: f64, rate: &mut [f64]) {
        rate.fill(0.0);
    }

    fn settle(&self, p: &[f64], z: &mut [f64], before: f64) {
        if let Self::Backlash = self {
            z[0] = self.rudder(p, z, before);
        }
    }
}
