//! An effect that is written as a line of text: a formula over the signals of a trial, with constants that are fitted.
//!
//! The formula of a user is the yaw moment as the rudder angle with that moment, rad: T r' + r = K (δ + δ_r + formula).
//! What there is to say of its constants is found by evaluating it. A formula of the list is described, and is a yaw
//! acceleration or the rudder that acts.

mod columns;
mod expectation;
mod found;
mod parse;
mod points;
mod program;

use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use estimation::number::Real;

use super::effect::{Acts, Description, Effect, Manoeuvres, Now, Places, Prior, Proposal};
use crate::dynamics::{Measured, Regressor};
use crate::particulars::Dimension;
pub use columns::ColumnFormula;
use expectation::{Expectation, expectations};
pub use parse::FormulaError;
use parse::LONGEST;
use points::{SignalSizes, way_speed};
use program::{FormulaProgram, FormulaSignal, OF_RECORD, OfRecord};

/// Longest name of an effect, characters.
const LONGEST_NAME: usize = 40;

/// Formulas by name and text.
type KnownFormulas = BTreeMap<(String, String), Arc<Formula>>;

/// What becomes of a moment where port and starboard are exchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// It changes its sign, as that of a ship with two equal sides does.
    Alike,
    /// It stays as it is.
    Same,
    /// Neither.
    Differ,
}

impl Sides {
    /// What such a moment does, in words.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Alike => "acts to port as to starboard",
            Self::Same => "acts to the same side in turns to port and to starboard",
            Self::Differ => "acts differently to port and to starboard",
        }
    }
}

/// A formula of the list.
#[derive(Debug, Clone, Copy)]
pub(super) struct ListedFormula {
    /// What it is called, its equation for people, and its constants in the order in which the formula names them.
    pub(super) description: Description,
    /// [`Places::RUDDER`] of the angle that acts, from `delta` alone, rad; [`Places::MOMENT`] of a yaw acceleration,
    /// rad/s², which is `K_over_T` times the moment as an angle of the rudder.
    pub(super) acts: Places,
    /// The formula; [`parse`] has the language.
    pub(super) formula: &'static str,
    /// What is expected of every constant.
    pub(super) prior: ListedPrior,
    /// Whether it is a moment of the weather.
    pub(super) of_weather: bool,
}

/// Mean, standard deviation and largest value of every constant in records of some manoeuvres.
pub(super) type ListedPrior = fn(&Manoeuvres) -> Option<[f64; 3]>;

/// An effect as a formula.
#[derive(Debug, Clone)]
pub struct Formula {
    program: FormulaProgram,
    description: Description,
    acts: Places,
    /// The measured channels that it needs.
    channels: Vec<Regressor>,
    of_record: OfRecord,
    /// Its row, of a formula of the list.
    listed: Option<ListedFormula>,
    /// What is said of every constant behind the formula of a user.
    expected: Vec<Expectation>,
    /// Whether its moment is proportional to a constant: it is absent where all these are zero. The others are shapes.
    is_size: Vec<bool>,
}

/// A formula is its name, its text and the numbers it takes from a record.
impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        (self.description, self.of_record) == (other.description, other.of_record)
    }
}

impl Formula {
    /// Reads `name = formula`, with `; k about 5` or `; k from 1 to 20` behind it for a constant of which something is
    /// known.
    ///
    /// Fails with the place and what was expected there.
    pub fn read(line: &str) -> Result<Arc<Self>, FormulaError> {
        let error = |at: usize, problem: &str| FormulaError { text: line.to_owned(), at, problem: problem.to_owned() };
        let Some((name, formula)) = line.split_once('=') else {
            return Err(error(line.chars().count(), "expected `name = formula`, as in `bank = c * r * abs(v)`"));
        };
        let before = name.chars().count() + 1;
        Self::named(name.trim(), formula.trim()).map_err(|own| {
            let blanks = formula.chars().take_while(|letter| letter.is_whitespace()).count();
            FormulaError { text: line.to_owned(), at: before + blanks + own.at, ..own }
        })
    }

    /// The effect of a name with a formula and what is known of its constants.
    ///
    /// Fails as [`read`](Self::read) does.
    pub fn named(name: &str, text: &str) -> Result<Arc<Self>, FormulaError> {
        // Descriptions last as long as the program, so each text is described once.
        static KNOWN: LazyLock<Mutex<KnownFormulas>> = LazyLock::new(Mutex::default);
        let key = (name.to_owned(), text.to_owned());
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known.get(&key) {
            return Ok(Arc::clone(found));
        }
        let made = Arc::new(Self::made(name, text)?);
        known.insert(key, Arc::clone(&made));
        Ok(made)
    }

    /// The effect of a row of the list.
    ///
    /// # Panics
    /// When the row is no formula: a mistake of the list.
    pub(super) fn listed(row: &ListedFormula) -> Self {
        let program = parse::parse(row.formula, false).unwrap_or_else(|error| panic!("{error}"));
        Self { acts: row.acts, listed: Some(*row), ..Self::of(program, row.description) }
    }

    fn of(program: FormulaProgram, description: Description) -> Self {
        Self {
            channels: program.channels(),
            program,
            description,
            acts: Places::MOMENT,
            of_record: OF_RECORD.map(|(_, neutral, _)| neutral),
            listed: None,
            expected: Vec::new(),
            is_size: Vec::new(),
        }
    }

    fn made(name: &str, text: &str) -> Result<Self, FormulaError> {
        let error = |at: usize, problem: String| FormulaError { text: text.to_owned(), at, problem };
        let is_name = name.starts_with(|letter: char| letter.is_ascii_alphabetic())
            && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
        if !is_name || name.len() > LONGEST_NAME {
            let name: String = name.chars().take(LONGEST_NAME).collect();
            let expected = format!(
                "`{name}` cannot be the name of an effect: expected letters, digits and _, at most {LONGEST_NAME}"
            );
            return Err(error(0, expected));
        }
        let found = text.chars().count();
        if found > LONGEST {
            return Err(error(LONGEST, format!("{found} characters, expected at most {LONGEST}")));
        }
        let (formula, said) = text.split_once(';').unwrap_or((text, ""));
        let program = parse::parse(formula.trim_end(), true)?;
        if program.constants.is_empty() {
            return Err(error(0, String::from("no constant to be fitted: expected one, as in `c * r * abs(v)`")));
        }
        let expected =
            expectations(said, &program.constants).map_err(|problem| error(formula.chars().count() + 1, problem))?;
        let kept = |words: String| -> &'static str { words.leak() };
        let equation = kept(format!("T r' + r = K (δ + δ_r + {})", formula.trim()));
        let none = Description { id: "", form: "", equation, parameters: &[] };
        let mut own = Self { expected, ..Self::of(program, none) };
        own.is_size = own.sizes();
        if !own.can_be_absent() {
            let problem = "no value of the constants takes the effect away: multiply every term with a constant, as in `c * tanh(k * psi)`";
            return Err(error(0, problem.to_owned()));
        }
        let (id, form) = (kept(name.to_owned()), kept(text.to_owned()));
        own.description = Description { id, form, parameters: own.found_parameters().leak(), ..own.description };
        Ok(own)
    }

    /// Numbers of [`OF_RECORD`] that it takes, by their places.
    fn taken(&self) -> impl Iterator<Item = usize> {
        (0..OF_RECORD.len()).filter(|place| self.program.signals.contains(&OF_RECORD[*place].0))
    }

    /// The same for a ship of this length, m.
    #[must_use]
    pub fn with_length(&self, length: f64) -> Self {
        let mut formula = self.clone();
        formula.of_record[2] = length;
        formula
    }

    /// Whether it says nothing, or nothing of its own, of ships that lack a channel.
    pub fn is_idle_without(&self, channel: Regressor) -> bool {
        self.channels.contains(&channel) || channel == Regressor::Speed && self.has(FormulaSignal::SpeedRatio)
    }

    fn has(&self, signal: FormulaSignal) -> bool {
        self.program.signals.contains(&signal)
    }

    /// Speed by which the lateral way grows, m/s.
    fn way_speed(&self, measured: &Measured) -> f64 {
        let [.., speed, is_always] = self.of_record;
        measured.speed.filter(|_| is_always == 0.0).unwrap_or(speed)
    }
}

impl Effect for Formula {
    fn description(&self) -> Description {
        self.description
    }

    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        let has = |channel| match channel {
            Regressor::Speed => about.speed.is_some(),
            Regressor::Sway => about.sway.is_some(),
            Regressor::Wind => about.wind_square.is_some(),
            Regressor::Propeller => about.propeller.is_some(),
        };
        if !self.channels.iter().copied().all(has) {
            return None;
        }
        let SignalSizes { speed, length, .. } = SignalSizes::of(about);
        let is_always = f64::from(u8::from(about.speed.is_none()));
        let of_record = [speed, about.span[0], length, way_speed(about), is_always];
        let own = Self { of_record, ..self.clone() };
        let priors = match own.listed {
            None => own.found_priors(about)?,
            Some(row) => {
                let [mean, sd, largest] = (row.prior)(about)?;
                let parameters = own.description.parameters.iter();
                parameters
                    .map(|own| Prior::normal(own, mean, sd).within([own.lowest, own.highest.min(largest)]))
                    .collect()
            }
        };
        Some(Proposal::new(own, priors))
    }

    fn places(&self) -> Places {
        self.acts
    }

    fn needs(&self) -> Option<Regressor> {
        self.channels.first().copied()
    }

    fn uses(&self, channel: Regressor) -> bool {
        self.is_idle_without(channel) || channel == Regressor::Speed && self.has(FormulaSignal::LateralWay)
    }

    /// The lateral way, and the course ψ₀ from which it goes.
    fn states(&self) -> usize {
        if self.has(FormulaSignal::LateralWay) { 2 } else { 0 }
    }

    fn constants(&self) -> Vec<(f64, Dimension)> {
        self.taken().map(|place| (self.of_record[place], OF_RECORD[place].2)).collect()
    }

    fn with_constants(&self, constants: &[f64]) -> Option<Arc<dyn Effect>> {
        let mut own = self.clone();
        self.taken().zip(constants).for_each(|(place, value)| own.of_record[place] = *value);
        Some(Arc::new(own))
    }

    fn is_of_time(&self) -> bool {
        self.has(FormulaSignal::Time)
    }

    fn is_of_weather(&self) -> bool {
        self.listed.is_some_and(|row| row.of_weather)
    }

    /// A lateral way turns with the record.
    fn sees_heading(&self) -> bool {
        self.has(FormulaSignal::Heading)
    }
}

impl<R: Real> Acts<R> for Formula {
    fn approach(&self, _p: &[R], now: &Now<R>, z: &mut [R]) {
        if let [way, course] = z {
            (*way, *course) = (R::from(0.0), now.heading);
        }
    }

    fn rates(&self, _p: &[R], z: &[R], now: &Now<R>, _before: R, rate: &mut [R]) {
        let (sin, _) = (now.heading - z[1]).sin_cos();
        (rate[0], rate[1]) = (sin * self.way_speed(now.measured), R::from(0.0));
    }

    #[inline]
    fn rudder(&self, p: &[R], _z: &[R], rudder: R) -> R {
        if !self.acts.rudder {
            return rudder;
        }
        self.program.value(p, |_| rudder)
    }

    #[inline]
    fn yaw_acceleration(&self, p: &[R], z: &[R], now: &Now<R>) -> R {
        if !self.acts.moment || !self.channels.iter().all(|channel| now.measured.has(*channel)) {
            return R::from(0.0);
        }
        self.program.value(p, |signal| signal.at(now, z, &self.of_record))
    }
}

#[cfg(test)]
mod lateral_way_tests;
#[cfg(test)]
mod tests;
