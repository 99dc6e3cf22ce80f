//! Effect written as a line of text: a formula over the signals of a trial, with constants that are fitted.
//!
//! The formula of a user is a yaw moment as equivalent rudder angle, rad: T r' + r = K (δ + δ_r + formula). The
//! properties of its constants follow from evaluation. A formula of the list is a yaw acceleration or the acting
//! rudder; the list declares the properties of its constants.

mod columns;
mod expectation;
mod parse;
mod points;
mod program;
mod properties;

use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use estimation::number::Real;

use super::effect::{
    CandidateEffect, Effect, EffectDescription, EffectEquations, EffectTarget, OperatingPoint, ParameterPrior,
    RecordScales,
};
use crate::dynamics::{MeasuredChannels, RegressorChannel};
use crate::particulars::Dimension;
pub use columns::ColumnFormula;
use expectation::{Expectation, expectations};
pub use parse::FormulaError;
use parse::MAX_FORMULA_CHARS;
use points::{SignalScales, lateral_distance_speed};
use program::{FormulaProgram, FormulaSignal, RECORD_CONSTANTS, RecordConstants};

/// Maximum number of characters in the name of an effect.
const MAX_NAME_CHARS: usize = 40;

/// Cache of formulas by name and text.
type FormulaCache = BTreeMap<(String, String), Arc<Formula>>;

/// Symmetry of a moment when port and starboard are exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MirrorSymmetry {
    /// Odd: it changes its sign, as for a symmetric ship.
    Odd,
    /// Even: it keeps its sign.
    Even,
    /// Neither odd nor even.
    Neither,
}

impl MirrorSymmetry {
    /// Verb phrase for messages.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Odd => "acts equally to port and to starboard",
            Self::Even => "acts to the same side in turns to port and in turns to starboard",
            Self::Neither => "acts differently to port and to starboard",
        }
    }
}

/// Row of the list of effects: an effect written as a formula.
#[derive(Debug, Clone, Copy)]
pub(super) struct ListedFormula {
    /// Description, with the constants in the order in which the formula names them.
    pub(super) description: EffectDescription,
    /// [`EffectTarget::RUDDER`] for the acting rudder, from `delta` alone, rad; [`EffectTarget::MOMENT`] for a yaw
    /// acceleration, rad/s²: `K_over_T` times the moment as equivalent rudder angle.
    pub(super) acts_on: EffectTarget,
    /// Text of the formula, in the language of [`parse`].
    pub(super) formula: &'static str,
    /// Prior of every constant.
    pub(super) prior: ListedPrior,
    /// `true` for a moment of wind, sea or another external cause.
    pub(super) is_weather: bool,
}

/// Prior of the constants in given records: mean, standard deviation and maximum; `None` without a required channel.
pub(super) type ListedPrior = fn(&RecordScales) -> Option<[f64; 3]>;

/// Effect defined by a formula.
#[derive(Debug, Clone)]
pub struct Formula {
    program: FormulaProgram,
    description: EffectDescription,
    acts_on: EffectTarget,
    /// Measured channels that it requires.
    channels: Vec<RegressorChannel>,
    record_constants: RecordConstants,
    /// Row of the list; `None` for the formula of a user.
    listed: Option<ListedFormula>,
    /// Expectations of the constants of a user's formula; empty for a formula of the list.
    expected: Vec<Expectation>,
    /// For every constant, `true` for a size (an amplitude): the moment is a linear function of it, and absent if all
    /// sizes are zero. Constants that are not sizes are shapes. Empty for a formula of the list.
    is_size: Vec<bool>,
}

/// Equality of name, text and record constants.
impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        (self.description, self.record_constants) == (other.description, other.record_constants)
    }
}

impl Formula {
    /// Effect parsed from `name = formula`, optionally followed by expectations of constants, `; k about 5` or `; k
    /// from 1 to 20`.
    ///
    /// Fails with the position and the expected symbols.
    pub fn parse(line: &str) -> Result<Arc<Self>, FormulaError> {
        let error = |at: usize, problem: &str| FormulaError {
            text: line.to_owned(),
            position: at,
            problem: problem.to_owned(),
        };
        let Some((name, formula)) = line.split_once('=') else {
            return Err(error(line.chars().count(), "expected `name = formula`, as in `bank = c * r * abs(v)`"));
        };
        let before = name.chars().count() + 1;
        Self::named(name.trim(), formula.trim()).map_err(|inner| {
            let blanks = formula.chars().take_while(|letter| letter.is_whitespace()).count();
            FormulaError { text: line.to_owned(), position: before + blanks + inner.position, ..inner }
        })
    }

    /// Effect with a name, a formula and the expectations of the constants.
    ///
    /// Fails if [`parse`](Self::parse) fails.
    pub fn named(name: &str, text: &str) -> Result<Arc<Self>, FormulaError> {
        // Descriptions have the lifetime of the program, so each text is described once.
        static CACHE: LazyLock<Mutex<FormulaCache>> = LazyLock::new(Mutex::default);
        let key = (name.to_owned(), text.to_owned());
        let mut cache = CACHE.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(cached) = cache.get(&key) {
            return Ok(Arc::clone(cached));
        }
        let made = Arc::new(Self::made(name, text)?);
        cache.insert(key, Arc::clone(&made));
        Ok(made)
    }

    /// Effect of a row of the list.
    ///
    /// # Panics
    /// If the row cannot be parsed: an error in the list.
    pub(super) fn listed(row: &ListedFormula) -> Self {
        let program = parse::parse(row.formula, false).unwrap_or_else(|error| panic!("{error}"));
        Self { acts_on: row.acts_on, listed: Some(*row), ..Self::from_program(program, row.description) }
    }

    fn from_program(program: FormulaProgram, description: EffectDescription) -> Self {
        Self {
            channels: program.channels(),
            program,
            description,
            acts_on: EffectTarget::MOMENT,
            record_constants: RECORD_CONSTANTS.map(|(_, neutral, _)| neutral),
            listed: None,
            expected: Vec::new(),
            is_size: Vec::new(),
        }
    }

    fn made(name: &str, text: &str) -> Result<Self, FormulaError> {
        let error = |at: usize, problem: String| FormulaError { text: text.to_owned(), position: at, problem };
        let is_name = name.starts_with(|letter: char| letter.is_ascii_alphabetic())
            && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
        if !is_name || name.len() > MAX_NAME_CHARS {
            let name: String = name.chars().take(MAX_NAME_CHARS).collect();
            let expected = format!(
                "`{name}` cannot be the name of an effect: expected letters, digits and _, at most {MAX_NAME_CHARS}"
            );
            return Err(error(0, expected));
        }
        let length = text.chars().count();
        if length > MAX_FORMULA_CHARS {
            return Err(error(MAX_FORMULA_CHARS, format!("{length} characters, expected at most {MAX_FORMULA_CHARS}")));
        }
        let (formula, expectation) = text.split_once(';').unwrap_or((text, ""));
        let program = parse::parse(formula.trim_end(), true)?;
        if program.constants.is_empty() {
            return Err(error(0, String::from("no constant to fit: expected at least one, as in `c * r * abs(v)`")));
        }
        let expected = expectations(expectation, &program.constants)
            .map_err(|problem| error(formula.chars().count() + 1, problem))?;
        let leaked = |text: String| -> &'static str { text.leak() };
        let equation = leaked(format!("T r' + r = K (δ + δ_r + {})", formula.trim()));
        let untitled = EffectDescription { id: "", form: "", equation, parameters: &[] };
        let mut effect = Self { expected, ..Self::from_program(program, untitled) };
        effect.is_size = effect.amplitude_flags();
        if !effect.can_be_absent() {
            let problem = "no value of the constants removes the effect: multiply every term by a constant, as in `c * tanh(k * psi)`";
            return Err(error(0, problem.to_owned()));
        }
        let (id, form) = (leaked(name.to_owned()), leaked(text.to_owned()));
        effect.description =
            EffectDescription { id, form, parameters: effect.derived_parameters().leak(), ..effect.description };
        Ok(effect)
    }

    /// Indices of the record constants ([`RECORD_CONSTANTS`]) that the formula uses.
    fn taken(&self) -> impl Iterator<Item = usize> {
        (0..RECORD_CONSTANTS.len()).filter(|place| self.program.signals.contains(&RECORD_CONSTANTS[*place].0))
    }

    /// Formula for a ship of this length, m.
    #[must_use]
    pub fn with_length(&self, length: f64) -> Self {
        let mut formula = self.clone();
        formula.record_constants[2] = length;
        formula
    }

    /// `true` if, without this measured channel, the formula is zero or one of its signals is constant.
    pub fn is_inactive_without(&self, channel: RegressorChannel) -> bool {
        self.channels.contains(&channel) || channel == RegressorChannel::Speed && self.has(FormulaSignal::SpeedRatio)
    }

    fn has(&self, signal: FormulaSignal) -> bool {
        self.program.signals.contains(&signal)
    }

    /// Speed in the rate of the lateral distance, m/s.
    fn lateral_distance_speed(&self, measured: &MeasuredChannels) -> f64 {
        let [.., speed, is_always] = self.record_constants;
        measured.speed.filter(|_| is_always == 0.0).unwrap_or(speed)
    }
}

impl Effect for Formula {
    fn description(&self) -> EffectDescription {
        self.description
    }

    fn candidate(&self, records: &RecordScales) -> Option<CandidateEffect> {
        let has = |channel| match channel {
            RegressorChannel::Speed => records.approach_speed.is_some(),
            RegressorChannel::Sway => records.approach_speed_for_sway.is_some(),
            RegressorChannel::Wind => records.mean_square_wind_speed.is_some(),
            RegressorChannel::Propeller => records.rms_propeller_rate.is_some(),
        };
        if !self.channels.iter().copied().all(has) {
            return None;
        }
        let SignalScales { speed, length, .. } = SignalScales::from_records(records);
        let is_always = f64::from(u8::from(records.approach_speed.is_none()));
        let record_constants = [speed, records.time_span[0], length, lateral_distance_speed(records), is_always];
        let effect = Self { record_constants, ..self.clone() };
        let priors = match effect.listed {
            None => effect.derived_priors(records)?,
            Some(row) => {
                let [mean, sd, largest] = (row.prior)(records)?;
                let parameters = effect.description.parameters.iter();
                parameters
                    .map(|p| ParameterPrior::normal(p, mean, sd).within([p.lowest, p.highest.min(largest)]))
                    .collect()
            }
        };
        Some(CandidateEffect::new(effect, priors))
    }

    fn acts_on(&self) -> EffectTarget {
        self.acts_on
    }

    fn needs(&self) -> Option<RegressorChannel> {
        self.channels.first().copied()
    }

    fn uses(&self, channel: RegressorChannel) -> bool {
        self.is_inactive_without(channel)
            || channel == RegressorChannel::Speed && self.has(FormulaSignal::LateralDistance)
    }

    /// Two states for a formula with the lateral distance: the distance y, and the initial course ψ₀.
    fn states(&self) -> usize {
        if self.has(FormulaSignal::LateralDistance) { 2 } else { 0 }
    }

    fn constants(&self) -> Vec<(f64, Dimension)> {
        self.taken().map(|place| (self.record_constants[place], RECORD_CONSTANTS[place].2)).collect()
    }

    fn with_constants(&self, constants: &[f64]) -> Option<Arc<dyn Effect>> {
        let places: Vec<usize> = self.taken().collect();
        if places.len() != constants.len() {
            return None;
        }
        let mut effect = self.clone();
        places.into_iter().zip(constants).for_each(|(place, value)| effect.record_constants[place] = *value);
        Some(Arc::new(effect))
    }

    fn is_time_dependent(&self) -> bool {
        self.has(FormulaSignal::Time)
    }

    fn is_environmental(&self) -> bool {
        self.listed.is_some_and(|row| row.is_weather)
    }

    /// `true` with the signal `psi`; the lateral distance is relative to the initial course, so it does not depend on
    /// the absolute heading.
    fn is_heading_dependent(&self) -> bool {
        self.has(FormulaSignal::Heading)
    }
}

impl<R: Real> EffectEquations<R> for Formula {
    fn approach(&self, _p: &[R], now: &OperatingPoint<R>, z: &mut [R]) {
        if let [distance, course] = z {
            (*distance, *course) = (R::from(0.0), now.heading);
        }
    }

    fn rates(&self, _p: &[R], z: &[R], now: &OperatingPoint<R>, _before: R, rate: &mut [R]) {
        let (sin, _) = (now.heading - z[1]).sin_cos();
        (rate[0], rate[1]) = (sin * self.lateral_distance_speed(now.measured), R::from(0.0));
    }

    #[inline]
    fn rudder(&self, p: &[R], _z: &[R], rudder: R) -> R {
        if !self.acts_on.transforms_rudder {
            return rudder;
        }
        self.program.value(p, |_| rudder)
    }

    #[inline]
    fn yaw_acceleration(&self, p: &[R], z: &[R], now: &OperatingPoint<R>) -> R {
        if !self.acts_on.adds_moment || !self.channels.iter().all(|channel| now.measured.has(*channel)) {
            return R::from(0.0);
        }
        self.program.value(p, |signal| signal.at(now, z, &self.record_constants))
    }
}

#[cfg(test)]
mod lateral_distance_tests;
#[cfg(test)]
mod tests;
