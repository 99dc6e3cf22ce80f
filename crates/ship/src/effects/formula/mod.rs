//! An effect that is written as a line of text: a name and a formula over the signals of a trial, with constants that
//! are fitted. The formula is the yaw moment as the rudder angle with that moment, rad:
//! T r' + r = K (δ + δ_r + formula).

mod expectation;
mod parse;
mod points;
mod program;

use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use estimation::number::Real;

use super::effect::{Acts, Description, Effect, Manoeuvres, Now, Parameter, Places, Prior, Proposal};
use crate::dynamics::Regressor;
use crate::particulars::{self, Dimension};
use expectation::{Expectation, expectations};
pub use parse::FormulaError;
use parse::LONGEST;
use points::{SignalPoint, SignalSizes};
use program::{FormulaProgram, FormulaSignal};

/// Ends of a constant that was given none.
const ANY: f64 = 1e9;

/// Expected moment over the largest angle of the rudder, where nothing is said of the size of a constant.
const MODERATE: f64 = 0.2;

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

/// A yaw moment as a formula.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    program: FormulaProgram,
    description: Description,
    expected: Vec<Expectation>,
    /// Whether the moment is proportional to a constant: it is absent where all these are zero. The others are shapes.
    is_size: Vec<bool>,
    sides: Sides,
    /// Length of the ship, m, for signals without dimension.
    length: f64,
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
        let program = parse::parse(formula.trim_end())?;
        if program.constants().is_empty() {
            return Err(error(0, String::from("no constant to be fitted: expected one, as in `c * r * abs(v)`")));
        }
        let expected =
            expectations(said, program.constants()).map_err(|problem| error(formula.chars().count() + 1, problem))?;
        let mut own = Self {
            description: Description { id: "", form: "", equation: "", parameters: &[] },
            is_size: vec![false; program.constants().len()],
            sides: Sides::Alike,
            length: 1.0,
            program,
            expected,
        };
        own.is_size = own.sizes();
        let shapes = own.shapes(&SignalSizes::ones());
        let absent = own.with_size(None, &shapes);
        let mut moments = SignalPoint::all(&SignalSizes::ones()).map(|point| own.moment(&absent, &point));
        if !own.is_size.contains(&true) || moments.any(|moment| moment != 0.0) {
            let problem = "no value of the constants takes the effect away: multiply every term with a constant, as in `c * tanh(k * psi)`";
            return Err(error(0, problem.to_owned()));
        }
        own.describe(name, text, &shapes);
        Ok(own)
    }

    /// Which constants the moment is proportional to.
    fn sizes(&self) -> Vec<bool> {
        let count = self.program.constants().len();
        (0..count)
            .map(|own| {
                let value = |size: f64, point: &SignalPoint| {
                    let mut constants: Vec<f64> = (0..count).map(|place| 0.7 + 0.3 * place as f64).collect();
                    constants[own] = size;
                    self.moment(&constants, point)
                };
                SignalPoint::all(&SignalSizes::ones()).all(|point| {
                    let [zero, one, three] = [0.0, 1.0, 3.0].map(|size| value(size, &point));
                    let is_finite = [zero, one, three].iter().all(|value| value.is_finite());
                    is_finite && (three - zero - 3.0 * (one - zero)).abs() <= 1e-9 * (three.abs() + zero.abs() + 1e-12)
                })
            })
            .collect()
    }

    /// Constants that are these shapes, and of the sizes one or none.
    fn with_size(&self, place: Option<usize>, shapes: &[f64]) -> Vec<f64> {
        let of = |(own, shape): (usize, &f64)| match (self.is_size[own], place == Some(own)) {
            (false, _) => *shape,
            (true, is_it) => f64::from(u8::from(is_it)),
        };
        shapes.iter().enumerate().map(of).collect()
    }

    fn describe(&mut self, name: &str, text: &str, shapes: &[f64]) {
        let kept = |words: String| -> &'static str { words.leak() };
        let symmetries: Vec<Option<bool>> = (0..shapes.len()).map(|place| self.symmetry(place, shapes)).collect();
        let of_sizes = |sides: bool| (0..shapes.len()).all(|own| !self.is_size[own] || symmetries[own] == Some(sides));
        self.sides = match (of_sizes(true), of_sizes(false)) {
            (true, _) => Sides::Alike,
            (_, true) => Sides::Same,
            _ => Sides::Differ,
        };
        let units = self.units(shapes);
        let units: Vec<&'static str> = units.into_iter().map(|unit| unit.map_or(Parameter::NO_UNIT, kept)).collect();
        let parameters = (0..self.expected.len()).map(|place| {
            let key = kept(self.program.constants()[place].clone());
            let [lowest, highest] = self.expected[place].ends.unwrap_or([-ANY, ANY]);
            let typical = self.expected[place].about.unwrap_or(if self.is_size[place] { 0.01 } else { shapes[place] });
            let neutral = if self.is_size[place] { 0.0 } else { typical };
            Parameter {
                odd: symmetries[place] == Some(false),
                ..Parameter::even([key, key, units[place]], [neutral, typical], [lowest, highest])
            }
        });
        let parameters: Vec<Parameter> = parameters.collect();
        let formula = text.split(';').next().unwrap_or(text).trim();
        self.description = Description {
            id: kept(name.to_owned()),
            form: kept(text.to_owned()),
            equation: kept(format!("T r' + r = K (δ + δ_r + {formula})")),
            parameters: Box::leak(parameters.into_boxed_slice()),
        };
    }

    /// Whether the part that belongs to a constant changes its sign where port and starboard are exchanged, as a moment
    /// does; `None` where it does neither.
    fn symmetry(&self, place: usize, shapes: &[f64]) -> Option<bool> {
        if !self.is_size[place] {
            return Some(true);
        }
        let constants = self.with_size(Some(place), shapes);
        let agrees = |sign: f64| {
            SignalPoint::all(&SignalSizes::ones()).all(|point| {
                let [one, other] = [&point, &point.mirrored()].map(|point| self.moment(&constants, point));
                (other - sign * one).abs() <= 1e-9 * (one.abs() + other.abs() + 1e-12)
            })
        };
        match (agrees(-1.0), agrees(1.0)) {
            (true, _) => Some(true),
            (_, true) => Some(false),
            _ => None,
        }
    }

    /// Units of the constants, where they follow from the signals: an angle has to come out. Of several shapes
    /// nothing is known.
    fn units(&self, shapes: &[f64]) -> Vec<Option<String>> {
        const POWERS: std::ops::RangeInclusive<i32> = -3..=3;
        let places = 0..shapes.len();
        let shape: Vec<usize> = places.clone().filter(|&place| !self.is_size[place]).collect();
        let of_shapes = POWERS.flat_map(|seconds| POWERS.map(move |metres| [seconds, metres]));
        let tried: Vec<Dimension> = match shape.len() {
            0 => vec![[0, 0]],
            1 => of_shapes.collect(),
            _ => Vec::new(),
        };
        let all = tried.into_iter().find_map(|own| {
            let dimension = |place: usize| {
                if self.is_size[place] { self.dimension_beside(place, shapes, own) } else { Some(own) }
            };
            places.clone().map(dimension).collect::<Option<Vec<Dimension>>>()
        });
        all.map_or_else(
            || vec![None; shapes.len()],
            |all| all.into_iter().map(|own| Some(particulars::unit(own))).collect(),
        )
    }

    /// The dimension of a size, where shapes have this one; `None` where no power of second and metre is its factor.
    fn dimension_beside(&self, place: usize, shapes: &[f64], of_shapes: Dimension) -> Option<Dimension> {
        let power = |second: f64, metre: f64| {
            let mut ratios = SignalPoint::all(&SignalSizes::ones()).filter_map(|point| {
                let value = |point: &SignalPoint, grown: f64| {
                    let grown: Vec<f64> = shapes.iter().map(|shape| shape * grown).collect();
                    self.moment(&self.with_size(Some(place), &grown), point)
                };
                let grown = second.powi(of_shapes[0]) * metre.powi(of_shapes[1]);
                let ratio = value(&SignalPoint { second, metre, ..point }, grown) / value(&point, 1.0);
                ratio.is_finite().then(|| ratio.ln() / (second * metre).ln())
            });
            let first = ratios.next()?;
            let is_one = ratios.all(|other| (other - first).abs() < 1e-9) && (first - first.round()).abs() < 1e-9;
            is_one.then_some(-first.round() as i32)
        };
        Some([power(2.0, 1.0)?, power(1.0, 2.0)?])
    }

    /// What becomes of it where port and starboard are exchanged and its constants stay.
    pub fn sides(&self) -> Sides {
        self.sides
    }

    fn moment(&self, constants: &[f64], point: &SignalPoint) -> f64 {
        self.program.value(constants, |signal| Some(point.of(signal))).unwrap_or(f64::NAN)
    }

    /// Values of the constants where a fit starts: of a shape the expected one, else the one at which the moment begins
    /// to bend.
    fn shapes(&self, scales: &SignalSizes) -> Vec<f64> {
        let mut values: Vec<f64> = self.expected.iter().map(|own| own.about.unwrap_or(1.0)).collect();
        for place in 0..values.len() {
            if self.is_size[place] || self.expected[place].about.is_some() {
                continue;
            }
            let spread = |value: f64| {
                let mut constants = values.clone();
                constants[place] = value;
                let moments = SignalPoint::all(scales).map(|point| self.moment(&constants, &point));
                moments.map(|moment| moment * moment).sum::<f64>().sqrt()
            };
            // How the moment grows with the constant: as a power at first, less where it bends.
            let slope = |value: f64| (spread(1.1 * value) / spread(value)).ln() / 1.1_f64.ln();
            let ladder = (-24..=24).map(|step| 10f64.powf(f64::from(step) / 4.0));
            let first = slope(1e-6);
            let bend = ladder.clone().find(|value| (slope(*value) - first).abs() > 0.5);
            values[place] = bend.filter(|_| first.is_finite()).unwrap_or(1.0);
            if let Some([lowest, highest]) = self.expected[place].ends {
                values[place] = values[place].clamp(lowest, highest);
            }
        }
        values
    }
}

impl Effect for Formula {
    fn description(&self) -> Description {
        self.description
    }

    /// A size is a normal law about zero: the expected one, or that of a moment of a fifth of the largest rudder angle.
    /// A shape is a normal law about its expected value, half as wide.
    fn proposal(&self, about: &Manoeuvres) -> Option<Proposal> {
        let has = |channel| match channel {
            Regressor::Speed => about.speed.is_some(),
            Regressor::Sway => about.sway.is_some(),
            Regressor::Wind => about.wind_square.is_some(),
            Regressor::Propeller => about.propeller.is_some(),
        };
        if !self.channels().all(has) {
            return None;
        }
        let scales = SignalSizes::of(about);
        let own = Self { length: scales.length, ..self.clone() };
        let shapes = own.shapes(&scales);
        let priors = own.parameters().iter().enumerate().map(|(place, parameter)| {
            if !own.is_size[place] {
                return Prior::normal(parameter, shapes[place], 0.5 * shapes[place].abs()).shape();
            }
            let alone = own.with_size(Some(place), &shapes);
            let square = SignalPoint::all(&scales).map(|point| own.moment(&alone, &point).powi(2)).sum::<f64>();
            let usual = MODERATE * about.rudder / (square / SignalPoint::COUNT as f64).sqrt();
            let sd = own.expected[place].about.map_or(usual, f64::abs);
            Prior::normal(parameter, 0.0, sd)
        });
        let priors: Vec<Prior> = priors.collect();
        let is_finite = priors.iter().all(|prior| prior.sd.is_finite() && prior.mean.is_finite());
        is_finite.then(|| Proposal::new(own, priors))
    }

    fn places(&self) -> Places {
        Places::MOMENT
    }

    fn needs(&self) -> Option<Regressor> {
        self.channels().next()
    }

    fn uses(&self, channel: Regressor) -> bool {
        self.channels().any(|own| own == channel)
    }

    fn constants(&self) -> Vec<f64> {
        vec![self.length]
    }

    fn dimension_of_constants(&self) -> Dimension {
        [0, 1]
    }

    fn is_of_time(&self) -> bool {
        self.program.signals().contains(&FormulaSignal::Time)
    }

    fn sees_heading(&self) -> bool {
        self.program.signals().contains(&FormulaSignal::Heading)
    }
}

impl Formula {
    /// The measured channels it needs.
    fn channels(&self) -> impl Iterator<Item = Regressor> {
        let signals = self.program.signals();
        let needs = move |any: &[FormulaSignal]| any.iter().any(|signal| signals.contains(signal));
        [
            (Regressor::Sway, needs(&[FormulaSignal::Sway, FormulaSignal::Surge, FormulaSignal::PrimeSway])),
            (
                Regressor::Speed,
                needs(&[
                    FormulaSignal::Speed,
                    FormulaSignal::Surge,
                    FormulaSignal::PrimeSway,
                    FormulaSignal::PrimeYawRate,
                ]),
            ),
            (Regressor::Wind, needs(&[FormulaSignal::WindSpeed, FormulaSignal::WindAngle])),
            (Regressor::Propeller, needs(&[FormulaSignal::Propeller])),
        ]
        .into_iter()
        .filter_map(|(channel, is_needed)| is_needed.then_some(channel))
    }

    /// The same for a ship of this length, m.
    #[must_use]
    pub fn with_length(&self, length: f64) -> Self {
        Self { length, ..self.clone() }
    }
}

impl<R: Real> Acts<R> for Formula {
    #[inline]
    fn yaw_acceleration(&self, p: &[R], _z: &[R], now: &Now<R>) -> R {
        let moment = self.program.value(p, |signal| signal.at(now, self.length));
        moment.map_or(R::from(0.0), |moment| now.gain * moment)
    }
}

#[cfg(test)]
mod tests;
