//! Dynamics of a steered ship: a state vector, its rate of change, and the motion that follows from it.
//!
//! Response models ([`crate::response::Response`]) and hulls ([`crate::vessel`]) both implement [`Dynamics`], so
//! simulation and replay are written once.

use estimation::number::Real;

/// Measured channels other than heading and rudder at one instant; `None` for a channel that is not in the record.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MeasuredChannels {
    /// Speed through the water, m/s.
    pub speed: Option<f64>,
    /// Sway velocity to starboard, m/s.
    pub sway: Option<f64>,
    /// Relative wind speed, m/s.
    pub wind_speed: Option<f64>,
    /// Direction the relative wind comes from, clockwise from the bow, rad.
    pub wind_from: Option<f64>,
    /// Propeller rate of revolution n, 1/s; `None` if not measured.
    pub propeller_rate: Option<f64>,
}

impl MeasuredChannels {
    /// `true` if this channel was measured; for the wind, both its speed and its direction.
    pub fn has(&self, channel: RegressorChannel) -> bool {
        match channel {
            RegressorChannel::Speed => self.speed.is_some(),
            RegressorChannel::Sway => self.sway.is_some(),
            RegressorChannel::Wind => self.wind_speed.is_some() && self.wind_from.is_some(),
            RegressorChannel::Propeller => self.propeller_rate.is_some(),
        }
    }
}

/// Kind of a channel of [`MeasuredChannels`], a possible regressor of an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RegressorChannel {
    /// Speed through the water.
    Speed,
    /// Sway velocity.
    Sway,
    /// Relative wind, speed and direction.
    Wind,
    /// Propeller revolutions.
    Propeller,
}

impl RegressorChannel {
    /// Error message for a record without this channel.
    pub fn missing_message(self) -> &'static str {
        match self {
            Self::Speed => "the records have no speed",
            Self::Sway => "the records have no sway velocity",
            Self::Wind => "the records have no relative wind",
            Self::Propeller => "the records have no propeller revolutions",
        }
    }
}

/// Input of a ship at one instant: rudder, disturbance and measured channels.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ShipInput<R = f64> {
    /// Acting rudder angle after the dead time, rad; positive turns to starboard.
    pub rudder: R,
    /// Yaw disturbance as equivalent rudder angle (same yaw moment at approach speed), rad.
    pub disturbance_rudder: f64,
    /// Measured channels that effects may use as regressors.
    pub measured: MeasuredChannels,
}

/// Motion of a ship at one instant.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Motion {
    /// Heading ψ, rad, clockwise, not wrapped.
    pub heading: f64,
    /// Yaw rate r, rad/s.
    pub yaw_rate: f64,
    /// Yaw acceleration r', rad/s².
    pub yaw_acceleration: f64,
    /// Speed through the water, m/s; `None` if the model has no speed.
    pub speed: Option<f64>,
    /// Sway velocity to starboard, m/s; `None` if the model has no sway.
    pub sway: Option<f64>,
}

/// Equations of motion of a steered ship: x' = f(t, x, input), with the time t in s.
///
/// The first two states are always heading ψ (rad) and yaw rate r (rad/s); further states belong to the implementation.
/// A value of this type is immutable during a run: the state vector holds all memory. Parameters in dual numbers give
/// states in dual numbers.
pub trait Dynamics<R: Real = f64>: Send + Sync {
    /// Number of states, at least 2.
    fn dimension(&self) -> usize;

    /// Writes the state of an approach with this heading (rad) and yaw rate (rad/s), rudder amidships, into `state`
    /// (length [`dimension`](Self::dimension)).
    fn approach(&self, heading: R, yaw_rate: R, state: &mut [R]);

    /// Writes x' into `rate` (both of length [`dimension`](Self::dimension)).
    fn rates(&self, t: f64, state: &[R], input: &ShipInput<R>, rate: &mut [R]);

    /// Update of memory that follows no differential equation (backlash), once at the end of every step.
    ///
    /// The rudder is monotone between two calls: a step ends at every corner of the rudder signal.
    fn update_memory(&self, _t: f64, _state: &mut [R], _input: &ShipInput<R>) {}

    /// Motion at time `t` (s) in this state, with this input.
    fn motion(&self, t: f64, state: &[R], input: &ShipInput<R>) -> Motion;

    /// Dead time from the rudder signal to the acting rudder, s; negative if the clock of the recorded rudder is late.
    fn dead_time(&self) -> R {
        R::from(0.0)
    }

    /// Maximum step, s, at which a fourth-order integrator keeps its accuracy for this system; by default 0.1 s.
    fn largest_step(&self) -> f64 {
        0.1
    }
}
