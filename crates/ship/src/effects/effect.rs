//! What every effect is: its parameters, where it acts, what it does, and how it is looked for in records.

use std::fmt;
use std::sync::Arc;

use estimation::number::Real;

use super::file_number::{FileNumber, FileRole};
use crate::dynamics::{Measured, Regressor};
use crate::number::Tangent;
use crate::particulars::{self, Dimension};

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
    /// How it stands in a scenario file; `None` where none has it.
    pub file: Option<FileNumber>,
}

impl Parameter {
    /// The unit of a parameter whose dimension is not known: it cannot be brought to another scale.
    pub const NO_UNIT: &'static str = "SI";

    /// A parameter that stays the same when port and starboard are exchanged: key, symbol and unit; neutral and typical
    /// value; smallest and largest.
    pub const fn even(
        [key, symbol, unit]: [&'static str; 3],
        [neutral, typical]: [f64; 2],
        [lowest, highest]: [f64; 2],
    ) -> Self {
        Self { key, symbol, unit, neutral, typical, lowest, highest, odd: false, file: None }
    }

    /// The same for one that changes its sign then.
    pub const fn odd(words: [&'static str; 3], sizes: [f64; 2], ends: [f64; 2]) -> Self {
        Self { odd: true, ..Self::even(words, sizes, ends) }
    }

    /// The same with what a scenario file has for it: a number that cannot be left out, its key and the size of its
    /// unit in SI.
    pub(super) const fn in_file(self, key: &'static str, unit: f64, meaning: &'static str) -> Self {
        Self { file: Some(FileNumber { key, unit, meaning, role: FileRole::Value, default: None }), ..self }
    }

    /// The same in another role.
    pub(super) const fn in_role(self, role: FileRole) -> Self {
        let Some(number) = self.file else { return self };
        Self { file: Some(FileNumber { role, ..number }), ..self }
    }

    /// The same with a number that holds where the file has none.
    pub(super) const fn by_default(self, default: f64) -> Self {
        let Some(number) = self.file else { return self };
        Self { file: Some(FileNumber { default: Some(default), ..number }), ..self }
    }

    /// Whether its dimension is not known.
    pub fn has_no_unit(&self) -> bool {
        self.unit == Self::NO_UNIT
    }

    /// Exponents of second and metre in the unit; angles have none.
    pub fn dimension(&self) -> Dimension {
        particulars::dimension(self.unit)
    }

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

/// What an effect is called, and its parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Description {
    /// Fixed identifier, shared by all forms of the effect.
    pub id: &'static str,
    /// Which form of the effect this is, in words ("r³", "dead time").
    pub form: &'static str,
    /// The equation, for reports.
    pub equation: &'static str,
    /// The parameters, in the order in which their values travel.
    pub parameters: &'static [Parameter],
}

/// Something a first-order response lacks: what it is. What it does is said by [`Acts`].
///
/// `p` is always the effect's own parameters.
pub trait Effect: Acts<f64> + Acts<Tangent> + fmt::Debug + Send + Sync {
    /// What it is called, and its parameters.
    fn description(&self) -> Description;

    /// Fixed identifier, shared by all forms of the effect.
    fn id(&self) -> &'static str {
        self.description().id
    }

    /// Which form of the effect this is, in words ("r³", "dead time").
    fn form(&self) -> &'static str {
        self.description().form
    }

    /// The equation, for reports.
    fn equation(&self) -> &'static str {
        self.description().equation
    }

    /// The parameters, in the order in which their values travel.
    fn parameters(&self) -> &'static [Parameter] {
        self.description().parameters
    }

    /// How its parameters stand in a scenario file; `None` of a form that needs a measured record.
    fn in_file(&self) -> Option<Vec<FileNumber>> {
        self.parameters().iter().map(|parameter| parameter.file).collect()
    }

    /// The measured channel it needs; without it the effect is silent.
    fn needs(&self) -> Option<Regressor> {
        None
    }

    /// Whether it takes a measured channel into account where there is one.
    fn uses(&self, channel: Regressor) -> bool {
        self.needs() == Some(channel)
    }

    /// How it is looked for in records of these manoeuvres; `None` where they cannot hold it, as without its channel.
    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal>;

    /// Where it acts.
    fn places(&self) -> Places;

    /// Number of own states.
    fn states(&self) -> usize {
        0
    }

    /// Numbers it takes from a record and holds fixed (approach speed, first time), each with its dimension: with its
    /// form they say which effect it is.
    fn constants(&self) -> Vec<(f64, Dimension)> {
        Vec::new()
    }

    /// The same effect with as many other numbers; `None` of one that takes none.
    fn with_constants(&self, _constants: &[f64]) -> Option<Arc<dyn Effect>> {
        None
    }

    /// Whether it is a moment that depends on time alone. It then belongs to one record and says nothing of another.
    fn is_of_time(&self) -> bool {
        false
    }

    /// Whether wind, waves or another moment from outside make it, so that a calm is without it.
    fn is_of_weather(&self) -> bool {
        false
    }

    /// Whether one of its parameters is an instant, which has as many places as a record is long.
    fn has_instant(&self) -> bool {
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

/// A number in which effects can be asked what they do.
pub trait EffectReal: Real {
    /// What an effect does, in this kind of number.
    fn acts(effect: &dyn Effect) -> &dyn Acts<Self>;
}

impl EffectReal for f64 {
    #[inline]
    fn acts(effect: &dyn Effect) -> &dyn Acts<Self> {
        effect
    }
}

impl EffectReal for Tangent {
    #[inline]
    fn acts(effect: &dyn Effect) -> &dyn Acts<Self> {
        effect
    }
}

/// The manoeuvres of some records in numbers, from which a proposal follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Manoeuvres {
    /// The time in which the ship sails its length, L/U, s; where these are not known (K/T)^(−1/2) of the base, about
    /// that.
    pub time: f64,
    /// Largest rudder angle, rad.
    pub rudder: f64,
    /// Longest record, s.
    pub duration: f64,
    /// Usual time between rows, s.
    pub spacing: f64,
    /// Approach speed, m/s, where all records have a measured speed.
    pub speed: Option<f64>,
    /// Approach speed, m/s, where all records have a measured sway velocity.
    pub sway: Option<f64>,
    /// Mean square relative wind speed, m²/s², where all records have it.
    pub wind_square: Option<f64>,
    /// Root mean square propeller revolutions, 1/s, where all records have them and they change.
    pub propeller: Option<f64>,
    /// First and last time, s, of the record in which an effect that depends on time would act.
    pub span: [f64; 2],
}

/// What is expected of one parameter of an effect before any record is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Expected value, where a fit starts.
    pub mean: f64,
    /// Standard deviation; infinite for a parameter that may be anything within its range, zero for one that is not
    /// fitted.
    pub sd: f64,
    /// Smallest value.
    pub lowest: f64,
    /// Largest value.
    pub highest: f64,
    /// Whether it only shapes the effect and means nothing once the others are neutral.
    pub is_shape: bool,
    /// The parameter of the same effect that it is counted from: value and prior are those of the difference.
    pub beside: Option<usize>,
}

impl Prior {
    /// A normal law within the physical range of a parameter.
    pub fn normal(parameter: &Parameter, mean: f64, sd: f64) -> Self {
        let Parameter { lowest, highest, .. } = *parameter;
        Self { mean: mean.clamp(lowest, highest), sd, lowest, highest, is_shape: false, beside: None }
    }

    /// Any value of a range, equally likely.
    pub fn uniform([lowest, highest]: [f64; 2]) -> Self {
        let mean = 0.5 * (lowest + highest);
        Self { mean, sd: f64::INFINITY, lowest, highest, is_shape: true, beside: None }
    }

    /// A value that is not fitted.
    pub fn fixed(value: f64) -> Self {
        Self { mean: value, sd: 0.0, lowest: value, highest: value, is_shape: true, beside: None }
    }

    /// The same in another range. A record may set an end beyond the other one: the lowest value holds then.
    #[must_use]
    pub fn within(self, [lowest, highest]: [f64; 2]) -> Self {
        let highest = highest.max(lowest);
        Self { lowest, highest, mean: self.mean.clamp(lowest, highest), ..self }
    }

    /// The same for a parameter that only shapes the effect.
    #[must_use]
    pub fn shape(self) -> Self {
        Self { is_shape: true, ..self }
    }

    /// Whether it is fitted.
    pub fn is_fitted(&self) -> bool {
        self.sd > 0.0
    }
}

/// An effect that records may lack, with its constants from the records.
#[derive(Debug, Clone)]
pub struct Proposal {
    /// The effect.
    pub effect: Arc<dyn Effect>,
    /// What is expected of every parameter.
    pub priors: Vec<Prior>,
}

impl Proposal {
    /// An effect with its priors.
    pub fn new(effect: impl Effect + 'static, priors: impl Into<Vec<Prior>>) -> Self {
        Self { effect: Arc::new(effect), priors: priors.into() }
    }

    /// An effect of one parameter with a normal law about its neutral value.
    pub fn of_one(effect: impl Effect + 'static, sd: f64) -> Self {
        let parameter = &effect.parameters()[0];
        let prior = Prior::normal(parameter, parameter.neutral, sd);
        Self::new(effect, [prior])
    }
}
