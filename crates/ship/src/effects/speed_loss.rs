//! Speed that falls in the turn, and with it the gain and the damping of the yaw response.

use super::effect::{Acts, Effect, Manoeuvres, Now, Parameter, Places, Proposal, Scale};
use crate::dynamics::Regressor;
use crate::number::Real;

/// K ~ U and T ~ 1/U, so a = 1/T ~ U and b = K/T ~ U².
///
/// A propeller that keeps its revolutions holds up the flow over the rudder, so the exponent of b may be below two and
/// is a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SpeedLoss {
    /// q = U/U₀ as a state: q' = (1 − q)/T_u − c r².
    Modelled,
    /// q from the measured speed; 1 where the record has none.
    Measured {
        /// Approach speed U₀, m/s.
        approach_speed: f64,
    },
    /// The flow over the rudder from the measured propeller revolutions n: b ~ (n/n₀)^m; as it is where there are none.
    Propeller {
        /// Revolutions n₀ of the approach, 1/s.
        approach_rate: f64,
    },
}

impl SpeedLoss {
    /// Exponents (m_a, m_b) of a ship whose rudder stands in the free stream: K ~ U and T ~ 1/U.
    pub const FREE_STREAM: [f64; 2] = [1.0, 2.0];
}

const MODELLED: [Parameter; 3] = [
    Parameter {
        key: "c_u",
        symbol: "c_u",
        unit: "s/rad²",
        neutral: 0.0,
        typical: 15.0,
        lowest: 0.0,
        highest: 1e5,
        odd: false,
    },
    Parameter {
        key: "T_u",
        symbol: "T_u",
        unit: "s",
        neutral: 100.0,
        typical: 100.0,
        lowest: 1.0,
        highest: 1e4,
        odd: false,
    },
    Parameter {
        key: "m_b",
        symbol: "m_b",
        unit: "1",
        neutral: 2.0,
        typical: 2.0,
        lowest: 0.0,
        highest: 3.0,
        odd: false,
    },
];
const MEASURED: [Parameter; 2] = [
    Parameter {
        key: "m_a",
        symbol: "m_a",
        unit: "1",
        neutral: 0.0,
        typical: 1.0,
        lowest: -1.0,
        highest: 3.0,
        odd: false,
    },
    Parameter {
        key: "m_b",
        symbol: "m_b",
        unit: "1",
        neutral: 0.0,
        typical: 2.0,
        lowest: -1.0,
        highest: 4.0,
        odd: false,
    },
];

const PROPELLER: [Parameter; 1] = [Parameter {
    key: "m_n",
    symbol: "m_n",
    unit: "1",
    neutral: 0.0,
    typical: 2.0,
    lowest: -1.0,
    highest: 4.0,
    odd: false,
}];

/// Speed ratio below which the scaling laws mean nothing; keeps a bad trial step of a search finite.
const SLOWEST: f64 = 0.05;

/// Smallest change of the propeller revolutions, as a share, that makes them worth a look.
const PROPELLER_CHANGE: f64 = 0.05;

impl Effect for SpeedLoss {
    fn id(&self) -> &'static str {
        "speed_loss"
    }

    fn form(&self) -> &'static str {
        match self {
            Self::Modelled => "modelled speed",
            Self::Measured { .. } => "measured speed",
            Self::Propeller { .. } => "measured propeller",
        }
    }

    fn equation(&self) -> &'static str {
        match self {
            Self::Modelled => "r' = −(q/T) r + (K/T) q^m_b (δ + δ_r), q' = (1 − q)/T_u − c_u r²",
            Self::Measured { .. } => "r' = −(q^m_a/T) r + (K/T) q^m_b (δ + δ_r), q = U/U₀",
            Self::Propeller { .. } => "r' = −r/T + (K/T) (n/n₀)^m_n (δ + δ_r)",
        }
    }

    fn parameters(&self) -> &'static [Parameter] {
        match self {
            Self::Modelled => &MODELLED,
            Self::Measured { .. } => &MEASURED,
            Self::Propeller { .. } => &PROPELLER,
        }
    }

    fn constants(&self) -> Vec<f64> {
        match *self {
            Self::Modelled => Vec::new(),
            Self::Measured { approach_speed: constant } | Self::Propeller { approach_rate: constant } => vec![constant],
        }
    }

    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        let Manoeuvres { time, rate, duration, .. } = *about;
        match self {
            // A speed that was measured is not modelled.
            Self::Modelled if about.speed_square.is_some() => None,
            Self::Modelled => {
                let loss = |recovery: f64| 0.2 / (recovery * rate * rate);
                let at = |times: f64, exponent: f64| vec![loss(times * time), times * time, exponent];
                let mut proposal = Proposal::new(*self, at(4.0, 1.0), vec![at(2.0, 2.0), at(8.0, 2.0)], at(4.0, 2.0));
                // The exponent of the rudder force cannot be told from one manoeuvre without a speed: the law of the
                // free stream.
                proposal.held = &[2];
                Some(proposal.within(0, [0.0, loss(0.5 * time)]).within(1, [0.5 * time, 2.0 * duration]))
            }
            Self::Measured { .. } => {
                let measured = Self::Measured { approach_speed: about.speed_square?.sqrt() };
                let scaled = Self::FREE_STREAM.to_vec();
                Some(Proposal::new(measured, vec![1.0, 1.0], vec![vec![0.0, 0.0], scaled.clone()], scaled))
            }
            Self::Propeller { .. } => {
                let [mean, lowest, highest] = about.propeller?;
                let changes = highest - lowest > PROPELLER_CHANGE * mean;
                changes.then(|| Proposal::of_one(Self::Propeller { approach_rate: mean }, 1.0, 0.0, 2.0))
            }
        }
    }

    fn places(&self) -> Places {
        Places::SCALE
    }

    fn needs(&self) -> Option<Regressor> {
        match self {
            Self::Modelled => None,
            Self::Measured { .. } => Some(Regressor::Speed),
            Self::Propeller { .. } => Some(Regressor::Propeller),
        }
    }

    fn states(&self) -> usize {
        match self {
            Self::Modelled => 1,
            Self::Measured { .. } | Self::Propeller { .. } => 0,
        }
    }

    fn shortest_time(&self, p: &[f64]) -> f64 {
        match self {
            Self::Modelled => p[1],
            Self::Measured { .. } | Self::Propeller { .. } => f64::INFINITY,
        }
    }
}

impl<R: Real> Acts<R> for SpeedLoss {
    fn approach(&self, _p: &[R], _now: &Now<R>, z: &mut [R]) {
        z.fill(R::from(1.0));
    }

    fn rates(&self, p: &[R], z: &[R], now: &Now<R>, _before: R, rate: &mut [R]) {
        if let Self::Modelled = self {
            rate[0] = (R::from(1.0) - z[0]) / p[1] - p[0] * now.yaw_rate * now.yaw_rate;
        }
    }

    fn scale(&self, p: &[R], z: &[R], now: &Now<R>) -> Scale<R> {
        match self {
            Self::Modelled => {
                let q = z[0].at_least(SLOWEST);
                Scale { damping: q, gain: q.powf(p[2]) }
            }
            Self::Measured { approach_speed } => match now.measured.speed {
                Some(speed) => {
                    let q = R::from((speed / approach_speed).max(SLOWEST));
                    Scale { damping: q.powf(p[0]), gain: q.powf(p[1]) }
                }
                None => Scale::none(),
            },
            Self::Propeller { approach_rate } => match now.measured.propeller {
                Some(rate) => {
                    let q = R::from((rate / approach_rate).max(SLOWEST));
                    Scale { damping: R::from(1.0), gain: q.powf(p[0]) }
                }
                None => Scale::none(),
            },
        }
    }
}
