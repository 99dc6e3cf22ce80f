//! Who takes part in a benchmark: methods that identify, a trace, and a floor below which nobody should be.

use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

use ::trace::Analysis;
use ::trace::record::PreparedRecord;
use document::trace::EffectEntry;
use identify::replay::{Replay, replay};
use identify::{Estimate, Identifier, registry};
use simulate::StreamKey;
use trial::{Channel, Quantity, Trial};

use crate::engine::failure;
use crate::failure::Failure;
use crate::scenario::{TRACE, name};
use crate::statistics::{Moments, distinct};

/// Label of the method that takes every ship to go straight on.
pub const STRAIGHT_ON: &str = "straight-on";

/// Label of the trace that is shown what every other method is shown.
pub const TRACE_OF_HEADING: &str = "trace-of-heading";

/// What every method reads. A trace also uses speed, sway, propeller and wind where they were recorded, those of the
/// record that is scored among them.
const COMMON: [Channel; 3] = [Channel::Heading, Channel::Rudder, Channel::YawRate];

/// A method with its label.
pub struct BenchMethod {
    label: String,
    procedure: BenchProcedure,
}

enum BenchProcedure {
    Identify(Arc<dyn Identifier>),
    Trace { of_heading: bool },
    StraightOn,
}

/// What a method made of some records.
pub enum BenchModel {
    /// A first-order response.
    Response(Box<Estimate>),
    /// A response with what it was found to lack.
    Traced(Box<Analysis>),
    /// A ship that keeps its heading.
    StraightOn,
}

/// Why a method has no answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Failed {
    /// In a word.
    pub kind: String,
    /// In a sentence.
    pub reason: String,
}

impl Failed {
    pub(super) fn of(kind: &str, reason: &dyn fmt::Display) -> Self {
        Self { kind: kind.to_owned(), reason: reason.to_string() }
    }
}

impl BenchMethod {
    /// A method of anybody's under a label.
    pub fn new(label: impl Into<String>, identifier: Arc<dyn Identifier>) -> Self {
        Self { label: label.into(), procedure: BenchProcedure::Identify(identifier) }
    }

    /// The methods of the project, in the order of reports: those that identify a first-order response, the trace with
    /// all that was recorded and with what others read, and as a floor a ship that keeps its heading.
    pub fn ours() -> Vec<Self> {
        let own = |settings: &identify::IdentifierSettings| {
            let method = settings.build().expect("default settings are valid");
            Self::new(method.id(), method.into())
        };
        let mut methods: Vec<Self> = registry::defaults().iter().map(own).collect();
        let others = [
            (TRACE, BenchProcedure::Trace { of_heading: false }),
            (TRACE_OF_HEADING, BenchProcedure::Trace { of_heading: true }),
            (STRAIGHT_ON, BenchProcedure::StraightOn),
        ];
        methods.extend(others.map(|(label, procedure)| Self { label: label.into(), procedure }));
        methods
    }

    /// Its label.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// One line on what it does.
    pub fn summary(&self) -> &str {
        match &self.procedure {
            BenchProcedure::Identify(identifier) => identifier.summary(),
            BenchProcedure::Trace { of_heading: false } => {
                "a first-order response with every effect that is found missing; it reads speed, sway and wind too, those of \
                 the record that is scored among them"
            }
            BenchProcedure::Trace { of_heading: true } => {
                "the same from heading, yaw rate and rudder alone, as all others"
            }
            BenchProcedure::StraightOn => "a ship that keeps its heading: the floor",
        }
    }

    /// Whether it says K and T of a ship.
    pub fn has_indices(&self) -> bool {
        !matches!(self.procedure, BenchProcedure::StraightOn)
    }

    /// Whether it names what a first-order response lacks.
    pub fn names_effects(&self) -> bool {
        matches!(self.procedure, BenchProcedure::Trace { .. })
    }

    /// Makes a model of all records together; `key` is that of its own chance.
    pub fn fit(&self, trials: &[Trial], key: &StreamKey) -> Result<BenchModel, Failed> {
        match &self.procedure {
            BenchProcedure::StraightOn => Ok(BenchModel::StraightOn),
            BenchProcedure::Identify(identifier) => {
                let estimate = crate::scenario::identify(identifier.as_ref(), trials, key);
                let estimate = estimate.map_err(|error| Failed::of(error.kind(), &error))?;
                Ok(BenchModel::Response(Box::new(estimate)))
            }
            BenchProcedure::Trace { of_heading } => {
                let shown: Cow<[Trial]> = match of_heading {
                    true => trials.iter().map(of_common).collect(),
                    false => trials.into(),
                };
                let settings = ::trace::Settings { thorough: false, ..::trace::Settings::default() };
                ::trace::trace(&shown, &[], &settings)
                    .map(|analysis| BenchModel::Traced(Box::new(analysis)))
                    .map_err(|error| Failed::of(failure(&error), &error))
            }
        }
    }
}

/// A record without what some methods do not read.
fn of_common(trial: &Trial) -> Trial {
    let more = trial.channels().map(|(channel, _)| channel).filter(|channel| !COMMON.contains(channel));
    trial.clone().without(&more.collect::<Vec<Channel>>())
}

/// Checks that methods can be told apart.
pub fn check_labels(methods: &[BenchMethod]) -> Result<(), Failure> {
    for (place, method) in methods.iter().enumerate() {
        let label = &method.label;
        name::file(label)
            .map_err(|unfit| Failure::input(format!("a method is called {}; {unfit}", name::shown(label))))?;
        // Names of files are the same in capitals on some systems.
        if methods[..place].iter().any(|other| other.label.to_lowercase() == label.to_lowercase()) {
            return Err(Failure::input(format!("two methods are called {label:?}; give one a label of its own")));
        }
    }
    Ok(())
}

impl BenchModel {
    /// Root mean square heading error, rad, of the rudder of a record replayed; only the initial state is fitted.
    /// `fitted` is the number of the record among those of the fit, where it is one. `None` when the replay is not
    /// finite.
    pub fn heading_error(&self, trial: &Trial, fitted: Option<usize>) -> Option<f64> {
        let error = match (self, fitted) {
            (Self::StraightOn, _) => {
                let mut moments = Moments::default();
                trial.observed_rows().for_each(|row| moments.add(trial.heading()[row]));
                (moments.second / moments.count).sqrt()
            }
            (Self::Response(estimate), _) => replay(trial, &estimate.response)?.rms(),
            (Self::Traced(analysis), Some(number)) => {
                error_on(trial, &analysis.identification.get(number)?.after.replay)
            }
            (Self::Traced(analysis), None) => {
                analysis.average().replay(&PreparedRecord::whole(trial), &starts(trial), false)?.replay.rms()
            }
        };
        error.is_finite().then_some(error)
    }

    /// K (1/s) and T (s) with what is known of their errors.
    pub fn indices(&self) -> Option<[Quantity; 2]> {
        match self {
            Self::Response(estimate) => Some([estimate.K(), estimate.T()]),
            Self::Traced(analysis) => {
                let indices = &analysis.document.model.indices;
                Some([indices.K_per_s, indices.T_s])
            }
            Self::StraightOn => None,
        }
    }

    /// The effects it names, the most probable first, each followed by those that the records cannot tell from it.
    pub fn named(&self) -> Option<Vec<Vec<String>>> {
        let Self::Traced(analysis) = self else { return None };
        let group = |effect: &EffectEntry| distinct(std::iter::once(&effect.id).chain(&effect.aliases).cloned());
        Some(analysis.document.effects.iter().map(group).collect())
    }
}

/// Root mean square of what is between all headings of a record and a replay of it. A trace leaves readings out that
/// belong to no ship; here they count, as they do for everybody else.
fn error_on(trial: &Trial, replay: &Replay) -> f64 {
    let first = trial.time().partition_point(|&time| time < replay.time[0]);
    let rows = trial.heading()[first..].iter().zip(&replay.heading).filter(|(measured, _)| measured.is_finite());
    let square: f64 = rows.clone().map(|(measured, replayed)| (measured - replayed).powi(2)).sum();
    (square / rows.count() as f64).sqrt()
}

/// Initial states near which the best is looked for: with no yaw rate, and with the one that was measured.
fn starts(trial: &Trial) -> Vec<[f64; 2]> {
    let Some(first) = trial.observed_rows().next() else { return Vec::new() };
    let heading = trial.heading()[first];
    let rate = trial.yaw_rate().map(|rate| rate[first]).filter(|rate| rate.is_finite());
    [Some(0.0), rate].into_iter().flatten().map(|rate| [heading, rate]).collect()
}
