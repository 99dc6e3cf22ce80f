//! Interface of an effect: its description, its equations, and its prior in given records.

use std::fmt;
use std::sync::Arc;

use estimation::number::Real;

use super::scenario_key::{NumberConversion, ScenarioKey};
use crate::dynamics::{MeasuredChannels, RegressorChannel};
use crate::number::Tangent;
use crate::particulars::{self, Dimension};

/// Parameter of an effect or of the base model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Name in files: letters, digits and underscores.
    pub key: &'static str,
    /// Symbol, as in the equation.
    pub symbol: &'static str,
    /// Unit, in SI and radians.
    pub unit: &'static str,
    /// Neutral value, at which the effect is absent; for a shape parameter, the start value of a search.
    pub neutral: f64,
    /// Typical value, for scaling and for tests.
    pub typical: f64,
    /// Minimum physical value.
    pub lowest: f64,
    /// Maximum physical value.
    pub highest: f64,
    /// `true` if the parameter changes sign when port and starboard are exchanged.
    pub is_odd: bool,
    /// Key in a scenario file; `None` for a parameter that no scenario has.
    pub scenario_key: Option<ScenarioKey>,
}

impl Parameter {
    /// Unit of a parameter of unknown dimension, which cannot be scaled to another ship.
    pub const NO_UNIT: &'static str = "SI";

    /// Parameter that keeps its sign when port and starboard are exchanged, from key, symbol and unit, neutral and
    /// typical value, minimum and maximum.
    pub const fn even(
        [key, symbol, unit]: [&'static str; 3],
        [neutral, typical]: [f64; 2],
        [lowest, highest]: [f64; 2],
    ) -> Self {
        Self { key, symbol, unit, neutral, typical, lowest, highest, is_odd: false, scenario_key: None }
    }

    /// Parameter that changes its sign when port and starboard are exchanged.
    pub const fn odd(names: [&'static str; 3], values: [f64; 2], range: [f64; 2]) -> Self {
        Self { is_odd: true, ..Self::even(names, values, range) }
    }

    /// Parameter that a scenario file must give: `unit` is the size of the unit of its key in SI, `meaning` its text in
    /// the reference of keys.
    pub(super) const fn with_scenario_key(self, key: &'static str, unit: f64, meaning: &'static str) -> Self {
        Self {
            scenario_key: Some(ScenarioKey { key, unit, meaning, conversion: NumberConversion::Value, default: None }),
            ..self
        }
    }

    /// Parameter with another conversion from the scenario file; unchanged if no scenario has it.
    pub(super) const fn with_conversion(self, conversion: NumberConversion) -> Self {
        let Some(number) = self.scenario_key else { return self };
        Self { scenario_key: Some(ScenarioKey { conversion, ..number }), ..self }
    }

    /// Parameter with a default in the scenario file, in the unit of its key; unchanged if no scenario has it.
    pub(super) const fn by_default(self, default: f64) -> Self {
        let Some(number) = self.scenario_key else { return self };
        Self { scenario_key: Some(ScenarioKey { default: Some(default), ..number }), ..self }
    }

    /// `true` if the dimension of the parameter is unknown.
    pub fn has_no_unit(&self) -> bool {
        self.unit == Self::NO_UNIT
    }

    /// Exponents of second and metre in the unit; angles have none.
    pub fn dimension(&self) -> Dimension {
        particulars::unit_dimension(self.unit)
    }

    /// `true` if a value lies within the physical range.
    pub fn is_in_range(&self, value: f64) -> bool {
        (self.lowest..=self.highest).contains(&value)
    }
}

/// Operating point at which an effect is evaluated.
#[derive(Debug, Clone, Copy)]
pub struct OperatingPoint<'a, R = f64> {
    /// Time, s, on the clock of the record.
    pub t: f64,
    /// Heading ψ, rad.
    pub heading: R,
    /// Yaw rate r, rad/s.
    pub yaw_rate: R,
    /// Acting rudder after every transformation, without δ_r, rad.
    pub rudder: R,
    /// a = 1/T at approach speed, 1/s.
    pub inverse_T: R,
    /// b = K/T at approach speed, 1/s².
    pub K_over_T: R,
    /// Measured channels.
    pub measured: &'a MeasuredChannels,
}

/// Factors on a = 1/T and b = K/T.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseFactors<R = f64> {
    /// Factor on the damping a = 1/T.
    pub damping: R,
    /// Factor on the gain b = K/T.
    pub gain: R,
}

impl<R: Real> BaseFactors<R> {
    /// Factors equal to one.
    pub fn unity() -> Self {
        Self { damping: R::from(1.0), gain: R::from(1.0) }
    }
}

/// Time constants T₂ and T₃ of a second-order response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecondOrderTimeConstants<R = f64> {
    /// T₂, s, positive.
    pub T2: R,
    /// T₃, s.
    pub T3: R,
}

/// Quantities on which an effect acts, in addition to its states; equations of other quantities are not evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EffectTarget {
    /// `true` if the effect transforms the acting rudder.
    pub transforms_rudder: bool,
    /// `true` if the effect scales damping and gain.
    pub scales_response: bool,
    /// `true` if the effect adds a yaw acceleration.
    pub adds_moment: bool,
}

impl EffectTarget {
    /// No quantity.
    pub const NONE: Self = Self { transforms_rudder: false, scales_response: false, adds_moment: false };
    /// Acting rudder.
    pub const RUDDER: Self = Self { transforms_rudder: true, ..Self::NONE };
    /// Damping and gain.
    pub const RESPONSE_SCALE: Self = Self { scales_response: true, ..Self::NONE };
    /// Yaw acceleration.
    pub const MOMENT: Self = Self { adds_moment: true, ..Self::NONE };
}

/// Description of an effect: identifier, form, equation and parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EffectDescription {
    /// Identifier, shared by all forms of the effect; fixed in files.
    pub id: &'static str,
    /// Form of the effect ("r³", "dead time"); fixed in files.
    pub form: &'static str,
    /// Equation for reports.
    pub equation: &'static str,
    /// Parameters, in the order of their values.
    pub parameters: &'static [Parameter],
}

/// Effect that a first-order response lacks. Its equations are in [`EffectEquations`].
///
/// `p` has the values of the parameters, in the order of [`parameters`](Self::parameters).
pub trait Effect: EffectEquations<f64> + EffectEquations<Tangent> + fmt::Debug + Send + Sync {
    /// Description: identifier, form, equation and parameters.
    fn description(&self) -> EffectDescription;

    /// Identifier, shared by all forms of the effect; fixed in files.
    fn id(&self) -> &'static str {
        self.description().id
    }

    /// Form of the effect ("r³", "dead time"); fixed in files.
    fn form(&self) -> &'static str {
        self.description().form
    }

    /// Equation for reports.
    fn equation(&self) -> &'static str {
        self.description().equation
    }

    /// Parameters, in the order of their values.
    fn parameters(&self) -> &'static [Parameter] {
        self.description().parameters
    }

    /// Keys of the parameters in a scenario file; `None` for a form that no scenario can declare.
    fn scenario_keys(&self) -> Option<Vec<ScenarioKey>> {
        self.parameters().iter().map(|parameter| parameter.scenario_key).collect()
    }

    /// Measured channel that the effect requires; without this channel the effect is zero. `None` if it requires no
    /// channel.
    fn needs(&self) -> Option<RegressorChannel> {
        None
    }

    /// `true` if the effect uses this channel when it is measured.
    fn uses(&self, channel: RegressorChannel) -> bool {
        self.needs() == Some(channel)
    }

    /// Candidate effect with its priors in these records; `None` if they do not identify it, e.g. without its channel.
    fn candidate(&self, records: &RecordScales) -> Option<CandidateEffect>;

    /// Quantities on which the effect acts.
    fn acts_on(&self) -> EffectTarget;

    /// Number of states of the effect.
    fn states(&self) -> usize {
        0
    }

    /// Fixed constants from a record (approach speed, first time), each with its dimension; together with identifier
    /// and form they define the effect.
    fn constants(&self) -> Vec<(f64, Dimension)> {
        Vec::new()
    }

    /// This effect with these values of its [`constants`](Self::constants), in their order; `None` if their number
    /// differs, and by default, for an effect without constants.
    fn with_constants(&self, _constants: &[f64]) -> Option<Arc<dyn Effect>> {
        None
    }

    /// `true` for a moment that depends explicitly on time; it then belongs to one record and does not apply to other
    /// records.
    fn is_time_dependent(&self) -> bool {
        false
    }

    /// `true` for an effect of wind, waves or another external moment, which is absent in a calm.
    fn is_environmental(&self) -> bool {
        false
    }

    /// `true` if a parameter is a time on the clock of the record.
    fn has_instant(&self) -> bool {
        false
    }

    /// `true` if the effect depends on the absolute heading, so that a rotated record gives another response.
    fn is_heading_dependent(&self) -> bool {
        false
    }

    /// `true` if the effect is random: noise on the observed heading, and no part of the response.
    fn is_random(&self) -> bool {
        let typical: Vec<f64> = self.parameters().iter().map(|parameter| parameter.typical).collect();
        self.random_heading(&typical).is_some()
    }

    /// Narrow-band random heading that is added to the observed heading; the deterministic response ignores it. `None`
    /// for an effect that is not random, or with a standard deviation of zero.
    fn random_heading(&self, _p: &[f64]) -> Option<crate::narrow_band::NarrowBandProcess> {
        None
    }

    /// Shortest time constant of the effect, s, which steps must resolve; infinite for an algebraic effect.
    fn min_time_constant(&self, _p: &[f64]) -> f64 {
        f64::INFINITY
    }

    /// First and last time, s, between which steps must resolve [`min_time_constant`](Self::min_time_constant); by
    /// default all times.
    fn fast_span(&self, _p: &[f64]) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }
}

/// Equations of an effect, for every number type.
///
/// `p` has the values of the parameters, `z` the states of the effect, `now` the operating point.
pub trait EffectEquations<R: Real> {
    /// Writes the states on a straight approach into `z`; by default zeros.
    fn approach(&self, _p: &[R], _now: &OperatingPoint<R>, z: &mut [R]) {
        z.fill(R::from(0.0));
    }

    /// Dead time of the rudder, s.
    fn dead_time(&self, _p: &[R]) -> R {
        R::from(0.0)
    }

    /// Acting rudder after this effect, from the rudder before it, rad.
    fn rudder(&self, _p: &[R], _z: &[R], rudder: R) -> R {
        rudder
    }

    /// Writes the rates of the states into `rate`; `before` is the rudder before this effect, rad.
    fn rates(&self, _p: &[R], _z: &[R], _now: &OperatingPoint<R>, _before: R, _rate: &mut [R]) {}

    /// Update of memory that follows no differential equation (backlash), once at the end of every step; `before` is
    /// the rudder before this effect, rad.
    fn update_memory(&self, _p: &[R], _z: &mut [R], _before: R) {}

    /// Factors on damping and gain.
    fn base_factors(&self, _p: &[R], _z: &[R], _now: &OperatingPoint<R>) -> BaseFactors<R> {
        BaseFactors::unity()
    }

    /// Addition to the yaw acceleration, rad/s².
    fn yaw_acceleration(&self, _p: &[R], _z: &[R], _now: &OperatingPoint<R>) -> R {
        R::from(0.0)
    }

    /// Time constants T₂ and T₃; `None` except for the effect that makes the response second-order.
    fn second_order_time_constants(&self, _p: &[R]) -> Option<SecondOrderTimeConstants<R>> {
        None
    }
}

/// Number type in which the equations of effects can be evaluated.
pub trait EffectReal: Real {
    /// Equations of an effect in this number type.
    fn effect_equations(effect: &dyn Effect) -> &dyn EffectEquations<Self>;
}

impl EffectReal for f64 {
    #[inline]
    fn effect_equations(effect: &dyn Effect) -> &dyn EffectEquations<Self> {
        effect
    }
}

impl EffectReal for Tangent {
    #[inline]
    fn effect_equations(effect: &dyn Effect) -> &dyn EffectEquations<Self> {
        effect
    }
}

/// Scales of the manoeuvres in given records, from which priors follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordScales {
    /// Ship-length time L/U, s; if length or speed is unknown, (K/T)^(−1/2) of the base, which is of the same order.
    pub ship_length_time: f64,
    /// Maximum rudder angle of all records, rad; at least 0.001 rad.
    pub max_rudder: f64,
    /// Duration of the longest record, s.
    pub duration: f64,
    /// Longest usual time between two rows of a record, s.
    pub row_interval: f64,
    /// Approach speed, m/s, for effects of the measured speed; `None` unless all records have it.
    pub approach_speed: Option<f64>,
    /// Approach speed, m/s, for effects of the measured sway velocity; `None` unless all records have it.
    pub approach_speed_for_sway: Option<f64>,
    /// Mean square of the relative wind speed, m²/s²; `None` unless all records have it.
    pub mean_square_wind_speed: Option<f64>,
    /// Root mean square of the propeller revolutions, 1/s; `None` unless all records have them and they change.
    pub rms_propeller_rate: Option<f64>,
    /// First and last time, s, of the record in which an effect that depends on time would act.
    pub time_span: [f64; 2],
}

/// Prior of one parameter of an effect: a normal or a uniform distribution on a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParameterPrior {
    /// Prior mean, the start of a fit.
    pub mean: f64,
    /// Standard deviation; infinite for a uniform distribution on the range, zero for a parameter that is not fitted.
    pub sd: f64,
    /// Minimum value.
    pub lowest: f64,
    /// Maximum value.
    pub highest: f64,
    /// `true` for a shape parameter, which has no meaning if the amplitudes are neutral.
    pub is_shape: bool,
    /// Index of the parameter that is subtracted: the fitted value and its prior are those of the difference. `None`
    /// for a parameter that is fitted directly.
    pub reference_parameter: Option<usize>,
}

impl ParameterPrior {
    /// Normal prior truncated to the physical range of a parameter.
    pub fn normal(parameter: &Parameter, mean: f64, sd: f64) -> Self {
        let Parameter { lowest, highest, .. } = *parameter;
        Self { mean: mean.clamp(lowest, highest), sd, lowest, highest, is_shape: false, reference_parameter: None }
    }

    /// Uniform prior on a range, for a shape parameter.
    pub fn uniform([lowest, highest]: [f64; 2]) -> Self {
        let mean = 0.5 * (lowest + highest);
        Self { mean, sd: f64::INFINITY, lowest, highest, is_shape: true, reference_parameter: None }
    }

    /// Prior of a parameter that is not fitted and keeps this value.
    pub fn fixed(value: f64) -> Self {
        Self { mean: value, sd: 0.0, lowest: value, highest: value, is_shape: true, reference_parameter: None }
    }

    /// Prior truncated to another range. If the upper end lies below the lower end, only the lower end is possible.
    #[must_use]
    pub fn within(self, [lowest, highest]: [f64; 2]) -> Self {
        let highest = highest.max(lowest);
        Self { lowest, highest, mean: self.mean.clamp(lowest, highest), ..self }
    }

    /// Prior of a shape parameter.
    #[must_use]
    pub fn as_shape(self) -> Self {
        Self { is_shape: true, ..self }
    }

    /// `true` if the parameter is fitted.
    pub fn is_fitted(&self) -> bool {
        self.sd > 0.0
    }
}

/// Candidate effect with its constants from the records, and its priors.
#[derive(Debug, Clone)]
pub struct CandidateEffect {
    /// Effect.
    pub effect: Arc<dyn Effect>,
    /// Prior of every parameter.
    pub priors: Vec<ParameterPrior>,
}

impl CandidateEffect {
    /// Effect with its priors.
    pub fn new(effect: impl Effect + 'static, priors: impl Into<Vec<ParameterPrior>>) -> Self {
        Self { effect: Arc::new(effect), priors: priors.into() }
    }

    /// Effect with one parameter, and a normal prior about its neutral value; `sd` in the unit of the parameter.
    pub fn with_normal_prior(effect: impl Effect + 'static, sd: f64) -> Self {
        let parameter = &effect.parameters()[0];
        let prior = ParameterPrior::normal(parameter, parameter.neutral, sd);
        Self::new(effect, [prior])
    }
}
