//! A hull of three degrees of freedom whose coefficients are all fitted, ready to be steered.

use serde::{Deserialize, Serialize};
use ship::{Dynamics, Input, Motion};

use super::coefficients::COEFFICIENTS;
use super::error::MotionError;
use super::planar::{Planar, moved};
use super::yaw::{YAW_COEFFICIENTS, Yaw};

/// Number of coefficients of a hull: those of surge and sway, then those of yaw.
pub const HULL_COEFFICIENTS: usize = COEFFICIENTS + YAW_COEFFICIENTS;

/// From what a covariance follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Spread {
    /// The coefficients were given; the covariance is zero.
    Known,
    /// From residuals within the records: a sandwich with the long-run covariance of the scores. Surge and sway on the
    /// one hand and yaw on the other are taken to be independent.
    Scores,
    /// From what changes when one record is left out (jackknife). It holds what differs from record to record because
    /// the equations are too simple, which is more than noise.
    Records,
}

/// What is random in yaw: an Ornstein–Uhlenbeck moment that explains what is left of the yaw equation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RandomYawMoment {
    /// Standard deviation as the rudder angle that has the same moment at approach speed, rad.
    pub deviation: f64,
    /// Time in which its autocorrelation falls to 1/e, s.
    pub correlation_time: f64,
}

/// What is left of the yaw equation in one record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HullRecord {
    /// Name of the record.
    pub name: String,
    /// Root mean square of the heading of the steered hull minus that of the record, in windows of 10 L/U₀ that begin
    /// at measured states, rad.
    pub heading: f64,
    /// The same of the yaw rate, rad/s.
    pub yaw_rate: f64,
}

/// A ship with surge, sway and yaw: coefficients, what is known of them, and what they leave open.
///
/// States ψ (rad), r (rad/s), u and v (m/s). ψ' = r; u' and v' as in
/// PlanarCoefficients, r' as in Yaw. The disturbance of an input is
/// added to the rudder of the yaw equation alone; the force of that rudder in surge and sway is left out. Made by
/// fit_hull or from known coefficients; immutable.
///
/// The equations hold for rudders, speeds and yaw rates like those of the records. A full ship may be unstable on a
/// straight course; replays without a helmsman then drift apart however good the coefficients are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct IdentifiedHull {
    /// Surge and sway, with length and approach speed.
    pub planar: Planar,
    /// Yaw.
    pub yaw: Yaw,
    /// Covariance of all coefficients: those of surge and sway, then those of yaw.
    pub covariance: Vec<Vec<f64>>,
    /// From what the covariance follows.
    pub spread: Spread,
    /// What is random in yaw; zero where the coefficients were given.
    pub moment: RandomYawMoment,
    /// The records of the fit, in their order; none where the coefficients were given.
    pub records: Vec<HullRecord>,
}

impl IdentifiedHull {
    /// A ship with known coefficients.
    pub fn new(planar: Planar, yaw: Yaw) -> Self {
        Self {
            planar,
            yaw: Yaw::from_array(yaw.to_array()),
            covariance: vec![vec![0.0; HULL_COEFFICIENTS]; HULL_COEFFICIENTS],
            spread: Spread::Known,
            moment: RandomYawMoment { deviation: 0.0, correlation_time: 0.0 },
            records: Vec::new(),
        }
    }

    /// The same coefficients on a ship of another length (m) and approach speed (m/s).
    ///
    /// At the same Froude number this is the ship of the model; see [`Planar::scaled_to`]. The correlation time of the
    /// moment scales with L/U₀. Fails with [`MotionError::NotPositive`].
    pub fn scaled_to(&self, length: f64, approach_speed: f64) -> Result<Self, MotionError> {
        let planar = self.planar.scaled_to(length, approach_speed)?;
        let ratio = length / approach_speed * self.planar.approach_speed / self.planar.length;
        let moment = RandomYawMoment { correlation_time: ratio * self.moment.correlation_time, ..self.moment };
        Ok(Self { planar, moment, ..self.clone() })
    }

    /// The same ship with its coefficients changed by so much, those of surge and sway first: a draw from the
    /// covariance. A value of a sign that the equations do not allow is put to the nearest that they do.
    pub fn stepped(&self, step: &[f64]) -> Self {
        let (planar, yaw) = step.split_at(COEFFICIENTS.min(step.len()));
        let yaw = Yaw::from_array(moved(self.yaw.to_array(), yaw));
        Self { planar: self.planar.stepped(planar), yaw, ..self.clone() }
    }

    /// r' in rad/s² at surge u and sway v (m/s), yaw rate r (rad/s), rudder (rad) and a disturbance (rad) beside it.
    pub fn yaw_acceleration(&self, u: f64, v: f64, r: f64, rudder: f64, disturbance: f64) -> f64 {
        let Planar { length, approach_speed: speed, .. } = self.planar;
        let rate = speed / length;
        self.yaw.rate(u / speed, v / speed, r / rate, rudder, disturbance) * rate * rate
    }
}

/// Times L/U₀ over which speed and drift settle in a turn, and steps in each.
const SETTLING: [usize; 2] = [60, 8];

/// Largest rudder that is looked at in a turn, rad.
const LARGEST_RUDDER: f64 = 1.2;

impl IdentifiedHull {
    /// Rudder (rad) at which the hull turns steadily at a yaw rate (rad/s): speed and drift settle while the rudder
    /// keeps the rate (reversed spiral, Bech 1968), so the branch that a spiral test jumps over is found, too. `None`
    /// where no rudder within 1.2 rad does it.
    pub fn steady_rudder(&self, yaw_rate: f64) -> Option<f64> {
        let Planar { length, approach_speed, .. } = self.planar;
        let [lengths, steps] = SETTLING;
        let step = length / approach_speed / steps as f64;
        let (mut u, mut v, mut rudder) = (approach_speed, 0.0, 0.0);
        for _ in 0..lengths * steps {
            // Nearly linear in the rudder.
            for _ in 0..3 {
                let [here, there] =
                    [rudder, rudder + 1e-3].map(|rudder| self.yaw_acceleration(u, v, yaw_rate, rudder, 0.0));
                let slope = (there - here) / 1e-3;
                if slope.abs() < f64::MIN_POSITIVE {
                    return None;
                }
                rudder = (rudder - here / slope).clamp(-LARGEST_RUDDER, LARGEST_RUDDER);
            }
            let [du, dv] = self.planar.rates(u, v, yaw_rate, rudder);
            let (half_u, half_v) = (u + 0.5 * step * du, v + 0.5 * step * dv);
            let [du, dv] = self.planar.rates(half_u, half_v, yaw_rate, rudder);
            (u, v) = (u + step * du, v + step * dv);
        }
        (rudder.abs() < LARGEST_RUDDER && u.is_finite() && v.is_finite()).then_some(rudder)
    }
}

impl Dynamics for IdentifiedHull {
    fn dimension(&self) -> usize {
        4
    }

    /// Straight ahead at approach speed, without drift.
    fn approach(&self, heading: f64, yaw_rate: f64, state: &mut [f64]) {
        state.copy_from_slice(&[heading, yaw_rate, self.planar.approach_speed, 0.0]);
    }

    fn rates(&self, _t: f64, state: &[f64], input: &Input, rate: &mut [f64]) {
        let [r, u, v] = [state[1], state[2], state[3]];
        let [surge, sway] = self.planar.rates(u, v, r, input.rudder);
        rate.copy_from_slice(&[r, self.yaw_acceleration(u, v, r, input.rudder, input.disturbance), surge, sway]);
    }

    fn motion(&self, _t: f64, state: &[f64], input: &Input) -> Motion {
        let [heading, yaw_rate, u, v] = [state[0], state[1], state[2], state[3]];
        let yaw_acceleration = self.yaw_acceleration(u, v, yaw_rate, input.rudder, input.disturbance);
        Motion { heading, yaw_rate, yaw_acceleration, speed: Some(u.hypot(v)), sway: Some(v) }
    }

    /// A fiftieth of the time the ship needs for its own length.
    fn largest_step(&self) -> f64 {
        self.planar.length / self.planar.approach_speed / 50.0
    }
}
