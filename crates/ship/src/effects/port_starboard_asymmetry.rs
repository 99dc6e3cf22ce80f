//! A ship that turns more readily to one side.

use super::effect::{Acts, Effect, Manoeuvres, Now, Parameter, Places, Proposal};
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

const GAIN: [Parameter; 1] = [Parameter {
    key: "a",
    symbol: "a",
    unit: "1",
    neutral: 0.0,
    typical: 0.05,
    lowest: -0.8,
    highest: 0.8,
    odd: true,
}];
const DRIFT: [Parameter; 1] = [Parameter {
    key: "c_r",
    symbol: "c_r",
    unit: "s",
    neutral: 0.0,
    typical: 0.5,
    lowest: -1e3,
    highest: 1e3,
    odd: true,
}];

impl Effect for PortStarboardAsymmetry {
    fn id(&self) -> &'static str {
        "port_starboard_asymmetry"
    }

    fn form(&self) -> &'static str {
        match self {
            Self::Gain => "gain by side",
            Self::Drift => "moment by drift",
        }
    }

    fn equation(&self) -> &'static str {
        match self {
            Self::Gain => "T r' + r = K (δ + a |δ| + δ_r)",
            Self::Drift => "T r' + r = K (δ + c_r |r| + δ_r)",
        }
    }

    fn parameters(&self) -> &'static [Parameter] {
        match self {
            Self::Gain => &GAIN,
            Self::Drift => &DRIFT,
        }
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
