//! The whole analysis of some records of one ship, and its result.

mod elsewhere;
mod parameters;
mod prospects;
mod replays;
mod reporter;

use identify::estimate::Quantity;
use identify::{Estimate, Identifier, IdentifyError, output_error};
use ship::narrow_band::NarrowBand;
use statrs::distribution::{ContinuousCDF, Normal};
use thiserror::Error;
use trial::Trial;

use crate::candidates::{self, Candidate, Sizes};
use crate::diagnostics::{self, Signature, Whiteness};
use crate::errors::{Errors, Replayed};
use crate::fit::Problem;
use crate::held_out::HeldOut;
use crate::noise::Moment;
use crate::record::Record;
use crate::search::{Evidence, Model, Search, Thresholds};
use crate::structure::Structure;

use elsewhere::{believed_elsewhere, predicted_elsewhere};
use parameters::{indices, parameter_covariance, parameters, randomness};
pub use prospects::Prospect;
use replays::{initial, on_records, starts, validate};
use reporter::Reporter;

/// Settings of an analysis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// What it takes to believe an effect.
    pub thresholds: Thresholds,
    /// Whether every record has a rudder bias of its own.
    pub own_bias: bool,
    /// Whether terms without a name are proposed for what no effect carries.
    pub discovery: bool,
    /// Whether errors of restarted replays, overshoots and separations are computed; a benchmark may leave them out.
    pub thorough: bool,
}

impl Default for Settings {
    fn default() -> Self {
        let thresholds = Thresholds { gain: 10.0, false_discovery: 0.01, most_terms: 4 };
        Self { thresholds, own_bias: false, discovery: true, thorough: true }
    }
}

/// Why there is no analysis.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TraceError {
    /// The base cannot be fitted.
    #[error(transparent)]
    Base(#[from] IdentifyError),
    /// The base cannot be replayed.
    #[error("{trial} cannot be replayed through the base model: its response leaves the range of numbers")]
    Replay {
        /// Name of the trial.
        trial: String,
    },
}

/// What the analysis says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing is missing.
    Clean,
    /// What is missing has a name, and what is left is noise.
    Traced,
    /// Structure is left that no candidate carries.
    Unexplained,
}

impl Verdict {
    /// The word used in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Clean => "clean",
            Self::Traced => "traced",
            Self::Unexplained => "unexplained",
        }
    }
}

/// What became of a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It is part of the model.
    Added,
    /// The records cannot tell it from one that is.
    Alias,
    /// The records speak against it, or do not need it.
    Rejected,
    /// The records could not show it.
    NotObservable,
}

impl Outcome {
    /// The word used in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Added => "added",
            Self::Alias => "alias",
            Self::Rejected => "rejected",
            Self::NotObservable => "not_observable",
        }
    }
}

/// A parameter with its error.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    /// Symbol.
    pub symbol: String,
    /// Unit, SI and rad.
    pub unit: &'static str,
    /// Value.
    pub value: f64,
    /// Standard deviation; `None` when it is not determined or was not fitted.
    pub sd: Option<f64>,
    /// Name of the one record it belongs to.
    pub only: Option<String>,
}

impl Value {
    /// 95 % interval, for a normal error.
    pub fn ci95(&self) -> Option<[f64; 2]> {
        let reach = Normal::standard().inverse_cdf(0.975) * self.sd?;
        Some([self.value - reach, self.value + reach])
    }
}

/// An effect that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Traced {
    /// Identifier.
    pub id: &'static str,
    /// Form.
    pub form: &'static str,
    /// Equation.
    pub equation: &'static str,
    /// Name of the one record in which it acts.
    pub only: Option<String>,
    /// Effects that these records cannot tell from it: identifier and form.
    pub aliases: Vec<(&'static str, &'static str)>,
    /// Its parameters.
    pub parameters: Vec<Value>,
    /// How much it explains, against the best model without it.
    pub evidence: Evidence,
    /// Share of the mean square of the residual of the base that it took away when it was added.
    pub residual_share: f64,
    /// One sentence on it.
    pub sentence: String,
}

/// A candidate and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Considered {
    /// Identifier.
    pub id: &'static str,
    /// Form.
    pub form: &'static str,
    /// Name of the one record in which it would act.
    pub only: Option<String>,
    /// What became of it.
    pub outcome: Outcome,
    /// Evidence on top of the final model (for an added one: of its removal). `None` when the records lack its channel.
    pub evidence: Option<Evidence>,
    /// Gain in BIC when it is added to the base alone, under white noise.
    pub gain_alone: Option<f64>,
    /// Gain in BIC it needs to be believed.
    pub needed: f64,
    /// Expected gain in −2 log L if it were as large as it can be expected.
    pub visibility: Option<f64>,
    /// Why, in words, where a number does not say it.
    pub reason: Option<&'static str>,
}

/// A monomial that carries what no named effect does.
#[derive(Debug, Clone, PartialEq)]
pub struct Empirical {
    /// The best, and those that these records cannot tell from it.
    pub group: Vec<&'static str>,
    /// Equation of the best.
    pub equation: &'static str,
    /// Its evidence.
    pub evidence: Evidence,
    /// Root mean square heading error with it, rad.
    pub error: f64,
}

/// Random part of the records, as the final model sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Randomness {
    /// Standard deviation of white heading noise, rad.
    pub white: f64,
    /// Random yaw moment, where one is needed.
    pub moment: Option<Moment>,
    /// Standard deviation of the heading that the moment alone would leave at the end of the longest record of a ship
    /// without damping, rad.
    pub wander: f64,
    /// Waves; `sd` in rad.
    pub waves: Option<NarrowBand>,
}

/// A model on one record.
#[derive(Debug, Clone, PartialEq)]
pub struct OnRecord {
    /// Replay.
    pub replayed: Replayed,
    /// Errors.
    pub errors: Errors,
}

/// One record with the models before and after.
#[derive(Debug, Clone)]
pub struct Judged {
    /// Name.
    pub name: String,
    /// Base model.
    pub before: OnRecord,
    /// Final model.
    pub after: OnRecord,
}

/// The result.
pub struct Analysis {
    /// The base, fitted alone: the best there is.
    pub base: Estimate,
    /// Base indices K (1/s), T (s) and δ_r (rad) of the final model.
    pub indices: [Quantity; 3],
    /// All parameters of the final model.
    pub parameters: Vec<Value>,
    /// The verdict.
    pub verdict: Verdict,
    /// What was found, in the order of discovery.
    pub effects: Vec<Traced>,
    /// All candidates.
    pub candidates: Vec<Considered>,
    /// What is left, where structure is.
    pub unexplained: Option<Signature>,
    /// A proposal for it.
    pub empirical: Option<Empirical>,
    /// Random part.
    pub randomness: Randomness,
    /// Records that were fitted.
    pub identification: Vec<Judged>,
    /// Records that were not.
    pub validation: Vec<Judged>,
    /// Whiteness of the residual before and after.
    pub whiteness: [Whiteness; 2],
    /// Terms that explained the records but made the error elsewhere worse, with the sentence that says so.
    pub refused: Vec<String>,
    /// The thresholds it was judged by.
    pub thresholds: Thresholds,
    problem: Problem,
    candidate_terms: Vec<Candidate>,
    model: Model,
}

/// Gain in BIC below which two rivals cannot be told apart.
const ALIAS: f64 = 10.0;

/// Analyses records of one ship.
///
/// The base comes from `output-error`, which is global in 1/T. `validation` records are replayed only; what makes their error
/// worse is not kept. Fails when the base cannot be fitted.
pub fn trace(trials: &[Trial], validation: &[Trial], settings: &Settings) -> Result<Analysis, TraceError> {
    let method = output_error::Settings::default().build().expect("default settings are valid");
    let base = method.identify(trials)?;
    let first = base.response;
    let initial: Vec<[f64; 2]> = trials.iter().map(|trial| initial(trial, &first)).collect::<Result<_, _>>()?;
    let records: Vec<Record> = trials.iter().map(|trial| Record::averaged(trial, first.T().abs())).collect();
    let problem = Problem::new(records, first.inverse_T, first.K_over_T);
    let structure = Structure::base(trials.len(), settings.own_bias);
    let mut theta = vec![first.inverse_T, first.K_over_T];
    theta.extend(std::iter::repeat_n(first.rudder_bias, structure.base_count() - 2));
    let headings = problem.replay(&structure, &theta, &initial);
    let sizes = Sizes::of(&problem.records, first.inverse_T, &headings);
    let candidate_terms = candidates::all(&problem.records, &sizes);
    let search = Search { problem: &problem, candidates: &candidate_terms, thresholds: settings.thresholds };

    let start = search.base(structure, &theta, &initial);
    let tried = search.try_all(&start, &start.plain, false);
    let mut model = search.run(&start, &tried);

    let held_out: Vec<HeldOut> = validation.iter().map(|trial| HeldOut::new(trial, starts(trial, &first))).collect();
    let mut refused = Vec::new();
    model = believed_elsewhere(&search, model, &held_out, &mut refused);
    let predicted = predicted_elsewhere(&search, &mut model, &held_out);

    let before: Vec<OnRecord> = on_records(trials, &problem, &start, &first, settings.thorough)?;
    let after = if model.structure.terms.is_empty() && !settings.own_bias {
        before.clone()
    } else {
        on_records(trials, &problem, &model, &first, settings.thorough)?
    };
    let names: Vec<String> = trials.iter().map(|trial| trial.name().to_owned()).collect();
    let judged = |names: Vec<String>, before: Vec<OnRecord>, after: Vec<OnRecord>| -> Vec<Judged> {
        let pairs = names.into_iter().zip(before.into_iter().zip(after));
        pairs.map(|(name, (before, after))| Judged { name, before, after }).collect()
    };
    let residuals = |all: &[OnRecord]| -> Vec<Vec<f64>> { all.iter().map(|on| on.replayed.residual.clone()).collect() };
    let whiteness = [diagnostics::whiteness(&residuals(&before)), diagnostics::whiteness(&residuals(&after))];
    let elsewhere = validate(&held_out, &start, &model)?;

    let covariance = parameter_covariance(&problem, &model, whiteness[1].lag1);
    let parameters = parameters(&problem, &model, covariance.as_ref(), &names);
    let indices = indices(&model, covariance.as_ref());
    let report = Reporter {
        search: &search,
        settings,
        names: &names,
        start: &start,
        model: &model,
        tried: &tried,
        predicted: &predicted,
    };
    let effects = report.effects(&parameters);
    let candidates = report.candidates(&effects);
    let unexplained = report.unexplained(trials, &after);
    let empirical = match &unexplained {
        Some(_) if settings.discovery => report.discover(&sizes),
        _ => None,
    };
    let verdict = match (&unexplained, effects.is_empty()) {
        (Some(_), _) => Verdict::Unexplained,
        (None, true) => Verdict::Clean,
        (None, false) => Verdict::Traced,
    };
    let randomness = randomness(&problem, &model);
    let identification = judged(names, before, after);
    Ok(Analysis {
        base,
        indices,
        parameters,
        verdict,
        effects,
        candidates,
        unexplained,
        empirical,
        randomness,
        identification,
        validation: elsewhere,
        whiteness,
        refused,
        thresholds: settings.thresholds,
        candidate_terms,
        model,
        problem,
    })
}
