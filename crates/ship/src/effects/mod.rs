//! Effects a first-order response lacks, one file each.
//!
//! An effect is structure only: its parameters travel beside it as a slice in the order of [`Effect::parameters`]. The
//! same effect simulates an undeclared influence and is a candidate when a residual is traced. With all parameters at
//! their neutral value a model with the effect is the model without it.
//!
//! An effect may act in five places, all optional: it can transform the rudder that acts (with memory), add states,
//! scale damping and gain, add a yaw acceleration, and add to the heading that is seen. To add one: a file here, one
//! line in [`all`].

mod moment_drift;
mod nonlinear_damping;
mod port_starboard_asymmetry;
mod proposal;
mod rudder_deadband;
mod rudder_saturation;
mod second_order;
mod speed_loss;
mod steering_lag;
mod sway_coupling_measured;
mod transient_disturbance;
mod wave_yaw;
mod wind_moment;

pub use moment_drift::MomentDrift;
pub use nonlinear_damping::NonlinearDamping;
pub use port_starboard_asymmetry::PortStarboardAsymmetry;
pub use proposal::{Manoeuvres, Proposal};
pub use rudder_deadband::RudderDeadband;
pub use rudder_saturation::RudderSaturation;
pub use second_order::SecondOrder;
pub use speed_loss::SpeedLoss;
pub use steering_lag::SteeringLag;
pub use sway_coupling_measured::SwayCouplingMeasured;
pub use transient_disturbance::TransientDisturbance;
pub use wave_yaw::WaveYaw;
pub use wind_moment::WindMoment;

use std::fmt;
use std::sync::Arc;

use crate::dynamics::{Measured, Regressor};
use crate::number::{Real, Tangent};

/// One parameter of an effect or of the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Name in files: letters, digits and underscores.
    pub key: &'static str,
    /// Symbol, as in the equation.
    pub symbol: &'static str,
    /// Unit, in SI and radians.
    pub unit: &'static str,
    /// Value at which the effect is absent (for the others of the same effect: where a search may start).
    pub neutral: f64,
    /// A typical size, for scaling and for tests.
    pub typical: f64,
    /// Smallest physical value.
    pub lowest: f64,
    /// Largest physical value.
    pub highest: f64,
    /// Whether the parameter changes sign when port and starboard are exchanged.
    pub odd: bool,
}

impl Parameter {
    /// Whether a value lies within the physical range.
    pub fn holds(&self, value: f64) -> bool {
        (self.lowest..=self.highest).contains(&value)
    }
}

/// The instant at which an effect is evaluated.
#[derive(Debug, Clone, Copy)]
pub struct Now<'a, R = f64> {
    /// Time, s, on the clock of the record.
    pub t: f64,
    /// Heading ψ, rad.
    pub heading: R,
    /// Yaw rate r, rad/s.
    pub yaw_rate: R,
    /// Rudder that acts after every transformation, without δ_r, rad.
    pub rudder: R,
    /// a = 1/T at approach speed, 1/s.
    pub inverse_time: R,
    /// b = K/T at approach speed, 1/s².
    pub gain: R,
    /// Channels that were measured.
    pub measured: &'a Measured,
}

/// Factors on a = 1/T and b = K/T.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale<R = f64> {
    /// Factor on a.
    pub damping: R,
    /// Factor on b.
    pub gain: R,
}

impl<R: Real> Scale<R> {
    /// Leaves damping and gain as they are.
    pub fn none() -> Self {
        Self { damping: R::from(1.0), gain: R::from(1.0) }
    }
}

/// Time constants of a second-order response, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SwayCoupling<R = f64> {
    /// T₂, s, positive.
    pub second_time: R,
    /// T₃, s.
    pub rudder_time: R,
}

/// Where an effect acts beside its own states; the other places need not be asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Places {
    /// It changes the rudder that acts.
    pub rudder: bool,
    /// It scales damping and gain.
    pub scale: bool,
    /// It adds a yaw acceleration.
    pub moment: bool,
}

impl Places {
    /// In none of these places.
    pub const NONE: Self = Self { rudder: false, scale: false, moment: false };
    /// In the rudder.
    pub const RUDDER: Self = Self { rudder: true, ..Self::NONE };
    /// In damping and gain.
    pub const SCALE: Self = Self { scale: true, ..Self::NONE };
    /// In the yaw acceleration.
    pub const MOMENT: Self = Self { moment: true, ..Self::NONE };
}

/// Something a first-order response lacks: what it is. What it does is said by [`Acts`].
///
/// `p` is always the effect's own parameters.
pub trait Effect: Acts<f64> + Acts<Tangent> + fmt::Debug + Send + Sync {
    /// Fixed identifier, shared by all forms of the effect.
    fn id(&self) -> &'static str;

    /// Which form of the effect this is, in words ("r³", "dead time").
    fn form(&self) -> &'static str;

    /// The equation, for reports.
    fn equation(&self) -> &'static str;

    /// The parameters, in the order in which their values travel.
    fn parameters(&self) -> &'static [Parameter];

    /// The measured channel it needs; without it the effect is silent.
    fn needs(&self) -> Option<Regressor> {
        None
    }

    /// How it is looked for in records of these manoeuvres; `None` where they cannot hold it, as without its channel.
    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal>;

    /// Where it acts.
    fn places(&self) -> Places;

    /// Number of own states.
    fn states(&self) -> usize {
        0
    }

    /// Numbers it takes from a record and holds fixed (approach speed, reference time): with its form they say which
    /// effect it is.
    fn constants(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Whether it is a moment that depends on time alone. It then belongs to one record and says nothing of another.
    fn is_of_time(&self) -> bool {
        false
    }

    /// Whether it depends on the heading, so that a turned record is another one.
    fn sees_heading(&self) -> bool {
        false
    }

    /// Whether it is random: noise on the heading that is seen, and no part of the response.
    fn is_random(&self) -> bool {
        let typical: Vec<f64> = self.parameters().iter().map(|parameter| parameter.typical).collect();
        self.random_heading(&typical).is_some()
    }

    /// Spectrum of a random heading that is added to the one seen; the deterministic part of the response ignores it.
    fn random_heading(&self, _p: &[f64]) -> Option<crate::narrow_band::NarrowBand> {
        None
    }

    /// Shortest time constant the effect brings in, s: what a step has to resolve.
    fn shortest_time(&self, _p: &[f64]) -> f64 {
        f64::INFINITY
    }

    /// Span of time, s, in which steps have to resolve that time; outside of it nothing happens so fast.
    fn fast_span(&self, _p: &[f64]) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }
}

/// What an effect does, written once for every kind of number.
///
/// `p` is always the effect's own parameters, `z` its own states.
pub trait Acts<R: Real> {
    /// Own states on a straight approach.
    fn approach(&self, _p: &[R], _now: &Now<R>, z: &mut [R]) {
        z.fill(R::from(0.0));
    }

    /// Dead time of the rudder, s.
    fn dead_time(&self, _p: &[R]) -> R {
        R::from(0.0)
    }

    /// The rudder that acts, from the one before this effect, rad.
    fn rudder(&self, _p: &[R], _z: &[R], rudder: R) -> R {
        rudder
    }

    /// Rates of own states; `before` is the rudder before this effect, rad.
    fn rates(&self, _p: &[R], _z: &[R], _now: &Now<R>, _before: R, _rate: &mut [R]) {}

    /// Update of memory that is not a differential equation, once a step.
    fn settle(&self, _p: &[R], _z: &mut [R], _before: R) {}

    /// Factors on damping and gain.
    fn scale(&self, _p: &[R], _z: &[R], _now: &Now<R>) -> Scale<R> {
        Scale::none()
    }

    /// Addition to the yaw acceleration, rad/s².
    fn yaw_acceleration(&self, _p: &[R], _z: &[R], _now: &Now<R>) -> R {
        R::from(0.0)
    }

    /// Second time constants, for the one effect that raises the order of the response.
    fn sway_coupling(&self, _p: &[R]) -> Option<SwayCoupling<R>> {
        None
    }
}

/// Every effect in every form, in the order of reports.
///
/// Forms that need a constant of the record have it at a neutral value: approach speed 1 m/s, propeller
/// 1/s, reference time 0.
pub fn all() -> Vec<Arc<dyn Effect>> {
    vec![
        Arc::new(SecondOrder),
        Arc::new(NonlinearDamping::Cubic),
        Arc::new(NonlinearDamping::Quadratic),
        Arc::new(NonlinearDamping::Square),
        Arc::new(WindMoment::Measured),
        Arc::new(WindMoment::Steady),
        Arc::new(SpeedLoss::Modelled),
        Arc::new(SpeedLoss::Measured { approach_speed: 1.0 }),
        Arc::new(SpeedLoss::Propeller { approach_rate: 1.0 }),
        Arc::new(SteeringLag::DeadTime),
        Arc::new(SteeringLag::FirstOrder),
        Arc::new(RudderSaturation),
        Arc::new(RudderDeadband::Backlash),
        Arc::new(RudderDeadband::DeadBand),
        Arc::new(PortStarboardAsymmetry),
        Arc::new(MomentDrift { reference_time: 0.0 }),
        Arc::new(TransientDisturbance),
        Arc::new(WaveYaw),
        Arc::new(SwayCouplingMeasured),
    ]
}
