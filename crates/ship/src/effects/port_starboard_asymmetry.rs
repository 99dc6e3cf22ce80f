//! A ship that turns more readily to one side.

use super::effect::{Acts, Description, Effect, Manoeuvres, Now, Parameter, Places, Proposal};
use estimation::number::Real;

/// Asymmetry of the rudder, or of the hull in a turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PortStarboardAsymmetry {
    /// K (δ + a |δ| + δ_r): gain 1 + a to starboard, 1 − a to port.
    Gain,
    /// K (δ + c_r |r| + δ_r): a moment that is even in the yaw rate, and so in the drift that goes with it. A rudder
    /// whose inflow is straightened differently on either side has it (Yasukawa and Yoshimura 2015, γ_R).
    Drift,
}

const GAIN: [Parameter; 1] = [Parameter::odd(["a", "a", "1"], [0.0, 0.05], [-0.8, 0.8])];
const DRIFT: [Parameter; 1] = [Parameter::odd(["c_r", "c_r", "s"], [0.0, 0.5], [-1e3, 1e3])];

impl Effect for PortStarboardAsymmetry {
    fn description(&self) -> Description {
        let (form, equation, parameters): (_, _, &[Parameter]) = match self {
            Self::Gain => ("gain by side", "T r' + r = K (δ + a |δ| + δ_r)", &GAIN),
            Self::Drift => ("moment by drift", "T r' + r = K (δ + c_r |r| + δ_r)", &DRIFT),
        };
        Description { id: "port_starboard_asymmetry", form, equation, parameters }
    }

    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        Some(match self {
            Self::Gain => Proposal::of_one(*self, 0.12),
            Self::Drift => Proposal::of_one(*self, 0.1 * about.time),
        })
    }

    fn places(&self) -> Places {
        match self {
            Self::Gain => Places::RUDDER,
            Self::Drift => Places::MOMENT,
        }
    }
}

impl<R: Real> Acts<R> for PortStarboardAsymmetry {
    fn rudder(&self, p: &[R], _z: &[R], rudder: R) -> R {
        match self {
            Self::Gain => rudder + p[0] * rudder.abs(),
            Self::Drift => rudder,
        }
    }

    fn yaw_acceleration(&self, p: &[R], _z: &[R], now: &Now<R>) -> R {
        match self {
            Self::Gain => R::from(0.0),
            Self::Drift => now.gain * p[0] * now.yaw_rate.abs(),
        }
    }
}
