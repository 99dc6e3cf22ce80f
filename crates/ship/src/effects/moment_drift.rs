//! A slow trend of the yaw moment over the record.

use super::effect::{Acts, Description, Effect, Manoeuvres, Now, Parameter, Places, Proposal};
use estimation::number::Real;

/// m (t − t₀) as an equivalent rudder angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MomentDrift {
    /// Instant t₀ at which the trend is zero, s; the start of a record keeps the trend apart from δ_r.
    pub reference_time: f64,
}

const PARAMETERS: [Parameter; 1] = [Parameter::odd(["m", "m", "rad/s"], [0.0, 7e-5], [-0.01, 0.01])];

impl Effect for MomentDrift {
    fn description(&self) -> Description {
        Description {
            id: "moment_drift",
            form: "linear trend",
            equation: "T r' + r = K (δ + δ_r + m (t − t₀))",
            parameters: &PARAMETERS,
        }
    }

    fn constants(&self) -> Vec<f64> {
        vec![self.reference_time]
    }

    fn is_of_time(&self) -> bool {
        true
    }

    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        Some(Proposal::of_one(Self { reference_time: about.span[0] }, 0.02 / about.duration))
    }

    fn places(&self) -> Places {
        Places::MOMENT
    }
}

impl<R: Real> Acts<R> for MomentDrift {
    fn yaw_acceleration(&self, p: &[R], _z: &[R], now: &Now<R>) -> R {
        now.gain * p[0] * (now.t - self.reference_time)
    }
}
