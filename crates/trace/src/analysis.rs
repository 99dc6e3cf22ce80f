//! The whole analysis of some records of one ship, and its result.

use std::sync::Arc;

use identify::estimate::{Covariance, Quantity};
use identify::{Estimate, Identifier, IdentifyError, output_error};
use nalgebra::{DMatrix, Matrix3};
use rayon::prelude::*;
use ship::narrow_band::NarrowBand;
use ship::{FirstOrder, Response};
use statrs::distribution::{ContinuousCDF, Normal};
use thiserror::Error;
use trial::Trial;

use crate::candidates::{self, Candidate, Sizes};
use crate::diagnostics::{self, Signature, Whiteness};
use crate::errors::{self, Errors, Replayed};
use crate::fit::{Fit, Problem};
use crate::held_out::{self, Comparison, HeldOut};
use crate::monomial::{LIBRARY, Monomial};
use crate::noise::Moment;
use crate::record::Record;
use crate::search::{Evidence, Model, Search, Thresholds, Tried};
use crate::separation::Ground;
use crate::structure::{Structure, Term};

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

/// Initial state of a base replay of all rows.
fn initial(trial: &Trial, response: &FirstOrder) -> Result<[f64; 2], TraceError> {
    let replay = identify::replay::replay(trial, response)
        .ok_or_else(|| TraceError::Replay { trial: trial.name().to_owned() })?;
    Ok([replay.heading[0], replay.yaw_rate[0]])
}

/// Initial states from which the best is looked for on a record that was not fitted.
fn starts(trial: &Trial, response: &FirstOrder) -> Vec<[f64; 2]> {
    let first = trial.observed_rows().next().unwrap_or(0);
    let heading = trial.heading()[first];
    let mut starts = vec![[heading, 0.0]];
    starts.extend(initial(trial, response));
    starts.extend(trial.yaw_rate().map(|rate| rate[first]).filter(|r| r.is_finite()).map(|rate| [heading, rate]));
    starts
}

/// Drops terms that make the error worse where they were not fitted.
fn believed_elsewhere(search: &Search, mut model: Model, held_out: &[HeldOut], refused: &mut Vec<String>) -> Model {
    let mut place = model.structure.terms.len();
    while place > 0 {
        place -= 1;
        let term = &model.structure.terms[place];
        if held_out::is_of_one_record(term.effect.id()) {
            continue;
        }
        let less = search.dropped(&model, place, true);
        let worse = if held_out.is_empty() {
            held_out::is_worse_on_parts(
                search.problem,
                (&less.structure, &less.plain),
                (&model.structure, &model.plain),
            )
            .then(|| String::from("the part of the record that was kept from the fit is predicted worse"))
        } else {
            worse_on_others(held_out, &less, &model)
        };
        if let Some(reason) = worse {
            refused.push(format!("{} ({}) is not kept: {reason}", term.effect.id(), term.effect.form()));
            model = less;
            // What is left may behave differently without it.
            place = model.structure.terms.len();
        }
    }
    model
}

fn worse_on_others(held_out: &[HeldOut], less: &Model, more: &Model) -> Option<String> {
    let all = |model: &Model| -> Option<Vec<Errors>> {
        let response = held_out::portable(&model.structure, &model.plain.theta);
        held_out.iter().map(|record| Some(record.judge(&response)?.1)).collect()
    };
    // A model whose replay is not finite is worse than any other.
    let Some(after) = all(more) else { return Some(String::from("its replay of a held-out record is not finite")) };
    let comparison = Comparison::of(&all(less)?, &after)?;
    comparison.is_worse().then(|| {
        format!(
            "on the held-out records it multiplies the error of the full replay by {:.2} and that of full and restarted \
             replays together by {:.2}",
            comparison.full, comparison.mean
        )
    })
}

/// A term that is believed because it predicts records it was not fitted to.
struct Predicted {
    term: Term,
    evidence: Evidence,
    comparison: Comparison,
}

/// Adds terms whose evidence does not stand against a random moment, but which predict the held-out records: chance does
/// not.
fn predicted_elsewhere(search: &Search, model: &mut Model, held_out: &[HeldOut]) -> Vec<Predicted> {
    let mut predicted = Vec::new();
    let errors = |structure: &Structure, fit: &Fit| -> Option<Vec<Errors>> {
        let response = held_out::portable(structure, &fit.theta);
        held_out.par_iter().map(|record| Some(record.judge(&response)?.1)).collect()
    };
    if held_out.is_empty() || model.judged.colour.moment.is_none() {
        return predicted;
    }
    while model.structure.terms.len() < search.thresholds.most_terms {
        let Some(before) = errors(&model.structure, &model.plain) else { break };
        let tried = search.try_all(model, &model.plain, true);
        let next = tried.into_iter().take(LOOKED_AT).find_map(|tried| {
            let term = search.candidates[tried.place].term.clone();
            if held_out::is_of_one_record(term.effect.id()) || !search.believes(&term, &tried.evidence) {
                return None;
            }
            let comparison = Comparison::of(&before, &errors(&tried.structure, &tried.fit)?)?;
            comparison.is_much_better().then_some((tried, term, comparison))
        });
        let Some((tried, term, comparison)) = next else { break };
        *model = search.adopted(&tried);
        predicted.push(Predicted { term, evidence: tried.evidence, comparison });
        if model.judged.colour.moment.is_none() {
            break;
        }
    }
    predicted
}

/// Candidates, best first, whose prediction is looked at.
const LOOKED_AT: usize = 4;

/// A model on the records it was fitted to, all rows.
fn on_records(
    trials: &[Trial],
    problem: &Problem,
    model: &Model,
    first: &FirstOrder,
    thorough: bool,
) -> Result<Vec<OnRecord>, TraceError> {
    let is_base =
        model.structure.terms.is_empty() && !model.structure.own_bias && problem.records.len() == trials.len();
    trials
        .iter()
        .enumerate()
        .map(|(number, trial)| {
            let record = Record::whole(trial);
            let response = if is_base {
                Response::first_order_ship(*first)
            } else {
                model.structure.response(number, &model.plain.theta)
            };
            let mut all = starts(trial, first);
            all.push(model.plain.initial[number]);
            on_record(trial, &record, &response, &all, is_base.then_some(first), thorough)
                .ok_or_else(|| TraceError::Replay { trial: trial.name().to_owned() })
        })
        .collect()
}

/// Replays a response; a first-order one in closed form, which neither sign of T disturbs.
fn on_record(
    trial: &Trial,
    record: &Record,
    response: &Response,
    starts: &[[f64; 2]],
    first: Option<&FirstOrder>,
    thorough: bool,
) -> Option<OnRecord> {
    let replayed = match first {
        Some(first) => closed_form(trial, record, first)?,
        None => errors::full(response, record, starts)?,
    };
    let errors =
        if thorough { errors::errors(trial, record, response, &replayed) } else { errors::in_brief(&replayed) };
    Some(OnRecord { replayed, errors })
}

fn closed_form(trial: &Trial, record: &Record, first: &FirstOrder) -> Option<Replayed> {
    let replay = identify::replay::replay(trial, first)?;
    let residual = record.heading.iter().zip(&replay.heading).map(|(measured, replayed)| measured - replayed).collect();
    let initial = [replay.heading[0], replay.yaw_rate[0]];
    Some(Replayed { time: replay.time, heading: replay.heading, yaw_rate: replay.yaw_rate, residual, initial })
}

fn validate(held_out: &[HeldOut], base: &Model, model: &Model) -> Result<Vec<Judged>, TraceError> {
    let first = FirstOrder {
        inverse_T: base.plain.theta[0],
        K_over_T: base.plain.theta[1],
        rudder_bias: base.plain.theta[2..].iter().sum::<f64>() / base.plain.theta[2..].len() as f64,
    };
    let after = held_out::portable(&model.structure, &model.plain.theta);
    let unchanged = after.model().effects().is_empty() && model.structure.terms.is_empty();
    held_out
        .iter()
        .map(|held| {
            let refuse = || TraceError::Replay { trial: held.trial.name().to_owned() };
            let response = Response::first_order_ship(first);
            let before =
                on_record(held.trial, &held.record, &response, &held.starts, Some(&first), true).ok_or_else(refuse)?;
            let after = if unchanged {
                before.clone()
            } else {
                let mut all = held.starts.clone();
                all.push(before.replayed.initial);
                on_record(held.trial, &held.record, &after, &all, None, true).ok_or_else(refuse)?
            };
            Ok(Judged { name: held.trial.name().to_owned(), before, after })
        })
        .collect()
}

/// Autocorrelation above which a residual is called coloured.
const COLOURED: f64 = 0.2;

/// Covariance of the fitted parameters of the final model; from the scores where the residual is coloured.
fn parameter_covariance(problem: &Problem, model: &Model, lag1: f64) -> Option<DMatrix<f64>> {
    let fit = &model.plain;
    let whiteners = problem.whiteners(&fit.colour);
    let linear = problem.linear(&model.structure, &fit.theta, &fit.initial, &problem.entries(&model.structure));
    let inverse = linear.covariance(&whiteners)?;
    let observations = problem.observations() as f64;
    let freedom = observations - linear.unknowns() as f64;
    let coloured = model.judged.colour.moment.is_some() || (fit.colour.is_white() && lag1.abs() > COLOURED);
    if !coloured {
        return Some(inverse * (fit.rss / freedom));
    }
    let middle = identify::robust::newey_west(&linear.scores(&whiteners));
    Some(&inverse * middle * &inverse * (observations / freedom))
}

fn parameters(problem: &Problem, model: &Model, covariance: Option<&DMatrix<f64>>, names: &[String]) -> Vec<Value> {
    let mut place = 0;
    problem
        .entries(&model.structure)
        .iter()
        .zip(&model.plain.theta)
        .map(|(entry, &value)| {
            let sd = entry.fitted.then(|| {
                place += 1;
                covariance.map(|covariance| covariance[(place - 1, place - 1)].max(0.0).sqrt())
            });
            Value {
                symbol: entry.symbol.to_owned(),
                unit: entry.unit,
                value,
                sd: sd.flatten().filter(|sd| sd.is_finite()),
                only: entry.only.map(|only| names[only].clone()),
            }
        })
        .collect()
}

fn indices(model: &Model, covariance: Option<&DMatrix<f64>>) -> [Quantity; 3] {
    let theta = &model.plain.theta;
    let response = FirstOrder { inverse_T: theta[0], K_over_T: theta[1], rudder_bias: theta[2] };
    match covariance {
        Some(all) => {
            let matrix = Matrix3::from_fn(|i, j| all[(i, j)]);
            let covariance = Covariance { matrix, degrees_of_freedom: None };
            let (k, t) = covariance.indices(&response);
            let sd = matrix[(2, 2)].max(0.0).sqrt();
            let reach = covariance.quantile95() * sd;
            let ci95 = Some([response.rudder_bias - reach, response.rudder_bias + reach]);
            [k, t, Quantity { value: response.rudder_bias, sd: Some(sd), ci95 }]
        }
        None => {
            [response.K(), response.T(), response.rudder_bias].map(|value| Quantity { value, sd: None, ci95: None })
        }
    }
}

fn randomness(problem: &Problem, model: &Model) -> Randomness {
    let fit = &model.judged;
    let white = (fit.rss / problem.observations() as f64).sqrt();
    Randomness {
        white,
        moment: fit.colour.moment.map(|(kind, _)| kind),
        wander: fit.colour.moment.map_or(0.0, |(_, level)| level.sqrt() * white),
        waves: fit.colour.waves.map(|waves| NarrowBand { sd: waves.sd * white, ..waves }),
    }
}

/// What is said about a finished search.
struct Reporter<'a> {
    search: &'a Search<'a>,
    settings: &'a Settings,
    names: &'a [String],
    start: &'a Model,
    model: &'a Model,
    /// All candidates on the base.
    tried: &'a [Tried],
    /// Terms that are believed for what they predict.
    predicted: &'a [Predicted],
}

impl Reporter<'_> {
    fn only(&self, term: &Term) -> Option<String> {
        term.only.map(|only| self.names[only].clone())
    }

    fn effects(&self, parameters: &[Value]) -> Vec<Traced> {
        let structure = &self.model.structure;
        let tests = self.search.tested(self.model, true);
        let shares = self.shares();
        let mut effects: Vec<Traced> = tests
            .into_par_iter()
            .enumerate()
            .map(|(place, (evidence, less))| {
                let term = &structure.terms[place];
                let stands = self.search.believes(term, &evidence);
                let predicted = self.predicted.iter().find(|predicted| predicted.term.is(term)).filter(|_| !stands);
                let aliases = self.aliases(place, &less, predicted.is_some());
                let (evidence, sentence) = match predicted {
                    Some(predicted) => (predicted.evidence, self.prediction(predicted, shares[place])),
                    None => (evidence, self.sentence(term, &evidence, shares[place], &aliases)),
                };
                Traced {
                    id: term.effect.id(),
                    form: term.effect.form(),
                    equation: term.effect.equation(),
                    only: self.only(term),
                    aliases,
                    parameters: parameters[structure.range(place)].to_vec(),
                    evidence,
                    residual_share: shares[place],
                    sentence,
                }
            })
            .collect();
        effects.extend(self.waves());
        effects
    }

    /// Share of the mean square of the base that every term took away in its turn.
    fn shares(&self) -> Vec<f64> {
        let square = |fit: &Fit| fit.residual.iter().flatten().map(|e| e * e).sum::<f64>();
        let all = square(&self.start.plain);
        let mut model = self.model.clone();
        let mut after = square(&model.plain);
        let mut shares = Vec::new();
        for place in (0..self.model.structure.terms.len()).rev() {
            model = self.search.dropped(&model, place, false);
            let before = if place == 0 { all } else { square(&model.plain) };
            shares.push(((before - after) / all).max(0.0));
            after = before;
        }
        shares.reverse();
        shares
    }

    /// Rivals that explain the records as well as the term at `place` does in its stead, under the same noise. A term that
    /// is believed for what it predicts is compared as it was found, under white noise.
    fn aliases(&self, place: usize, less: &Model, predicted: bool) -> Vec<(&'static str, &'static str)> {
        let own = &self.model.structure.terms[place];
        let with = if predicted { &self.model.plain } else { &self.model.judged };
        let tried;
        let rivals = if less.structure.terms.is_empty() && with.colour == self.start.plain.colour {
            self.tried
        } else {
            // The model without the term, under the noise of the model with it.
            let without =
                self.search.problem.fit(&less.structure, &less.plain.theta, &less.plain.initial, &with.colour);
            tried = self.search.try_all(less, &without, false);
            &tried
        };
        let mut aliases: Vec<(&'static str, &'static str)> = rivals
            .iter()
            .filter(|tried| tried.fit.bic < with.bic + ALIAS)
            .map(|tried| &self.search.candidates[tried.place].term)
            .filter(|rival| !rival.is(own) && !self.model.structure.terms.iter().any(|term| term.is(rival)))
            .map(|rival| (rival.effect.id(), rival.effect.form()))
            .collect();
        aliases.sort_unstable();
        aliases.dedup();
        aliases
    }

    fn sentence(
        &self,
        term: &Term,
        evidence: &Evidence,
        share: f64,
        aliases: &[(&'static str, &'static str)],
    ) -> String {
        let whom = match (&self.model.judged.colour.moment, aliases.is_empty()) {
            (None, true) => "against the best model without it, random moments included",
            (Some(_), true) => "against the best model without it, while a random moment takes what neither explains",
            (_, false) => "against the best model without any of its aliases",
        };
        format!(
            "{} ({}) takes away {:.0} % of the mean square error of the base; BIC falls by {:.0} {whom}",
            term.effect.id(),
            term.effect.form(),
            100.0 * share,
            evidence.gain
        )
    }

    fn prediction(&self, predicted: &Predicted, share: f64) -> String {
        format!(
            "{} ({}) takes away {:.0} % of the mean square error of the base; against a random moment its evidence does not \
             stand, but it multiplies the error on held-out records by {:.2} (full replay) and {:.2} (full and restarted \
             replays together); BIC falls by {:.0} under white noise",
            predicted.term.effect.id(),
            predicted.term.effect.form(),
            100.0 * share,
            predicted.comparison.full,
            predicted.comparison.mean,
            predicted.evidence.gain
        )
    }

    /// Waves as an effect, where they are part of the noise.
    fn waves(&self) -> Option<Traced> {
        let waves = self.model.judged.colour.waves?;
        let white = self.search.problem.variance(&self.model.judged).sqrt();
        let calm = self.search.coloured(self.model, None);
        let evidence = self.search.evidence(&calm.judged, &self.model.judged, 3);
        let effect = ship::effects::WaveYaw;
        let values = [waves.sd * white, waves.frequency, waves.damping];
        let described = ship::effects::Effect::parameters(&effect);
        let parameters = described
            .iter()
            .zip(values)
            .map(|(parameter, value)| Value {
                symbol: parameter.symbol.to_owned(),
                unit: parameter.unit,
                value,
                sd: None,
                only: None,
            })
            .collect();
        Some(Traced {
            id: ship::effects::Effect::id(&effect),
            form: ship::effects::Effect::form(&effect),
            equation: ship::effects::Effect::equation(&effect),
            only: None,
            aliases: Vec::new(),
            parameters,
            evidence,
            residual_share: 0.0,
            sentence: format!(
                "a narrow band at {:.2} rad/s with a standard deviation of {:.2} deg lies on the heading; BIC falls by {:.0}",
                waves.frequency,
                ship::angle::to_deg(waves.sd * white),
                evidence.gain
            ),
        })
    }

    fn candidates(&self, effects: &[Traced]) -> Vec<Considered> {
        let structure = &self.model.structure;
        let judged = self.model.judged.colour.moment.is_some();
        let fit = if judged { &self.model.judged } else { &self.model.plain };
        // On the base itself the first round has told already.
        let last = if structure.terms.is_empty() && !judged {
            self.tried.to_vec()
        } else {
            self.search.try_all(self.model, fit, false)
        };
        let variance = self.search.problem.variance(fit);
        let ground = Ground { problem: self.search.problem, structure, fit, variance };
        let log_n = (self.search.problem.observations() as f64).ln();
        let mut list: Vec<Considered> = self
            .search
            .candidates
            .par_iter()
            .enumerate()
            .map(|(place, candidate)| {
                let term = &candidate.term;
                let alone = self.tried.iter().find(|tried| tried.place == place).map(|tried| tried.evidence.gain);
                let added = structure.terms.iter().any(|own| own.is(term));
                let alias =
                    effects.iter().any(|effect| effect.aliases.contains(&(term.effect.id(), term.effect.form())));
                let evidence = if added {
                    let own = |effect: &&Traced| (effect.id, effect.form) == (term.effect.id(), term.effect.form());
                    effects.iter().find(own).map(|effect| effect.evidence)
                } else {
                    last.iter().find(|tried| tried.place == place).map(|tried| tried.evidence)
                };
                let visibility = (!added && self.settings.thorough).then(|| ground.visibility(candidate));
                let needed = self.settings.thresholds.gain + term.freedom() as f64 * log_n;
                let outcome = match (added, alias, visibility) {
                    (true, ..) => Outcome::Added,
                    (_, true, _) => Outcome::Alias,
                    // What would explain the base alone is seen, even if something else explains it better.
                    (.., Some(visibility)) if visibility < needed && alone.is_none_or(|gain| gain < needed) => {
                        Outcome::NotObservable
                    }
                    _ => Outcome::Rejected,
                };
                Considered {
                    id: term.effect.id(),
                    form: term.effect.form(),
                    only: self.only(term),
                    outcome,
                    evidence,
                    gain_alone: alone,
                    needed: self.search.needed(term),
                    visibility,
                    reason: None,
                }
            })
            .collect();
        list.extend(self.without_channel(&list));
        list.push(self.waves_considered(effects));
        list
    }

    /// Effects that need a channel the records do not have.
    fn without_channel(&self, list: &[Considered]) -> Vec<Considered> {
        [("sway_coupling_measured", "measured sway", "the records have no sway velocity")]
            .into_iter()
            .filter(|(id, ..)| list.iter().all(|other| other.id != *id))
            .map(|(id, form, reason)| Considered {
                id,
                form,
                only: None,
                outcome: Outcome::NotObservable,
                evidence: None,
                gain_alone: None,
                needed: self.settings.thresholds.gain,
                visibility: None,
                reason: Some(reason),
            })
            .collect()
    }

    fn waves_considered(&self, effects: &[Traced]) -> Considered {
        let found = effects.iter().find(|effect| effect.id == "wave_yaw");
        Considered {
            id: "wave_yaw",
            form: "narrow band",
            only: None,
            outcome: if found.is_some() { Outcome::Added } else { Outcome::Rejected },
            evidence: found.map(|effect| effect.evidence),
            gain_alone: None,
            needed: self.settings.thresholds.gain,
            visibility: None,
            reason: if found.is_some() {
                None
            } else {
                Some("no band above five times the frequency of the manoeuvre")
            },
        }
    }

    /// What is left, where a random moment is needed to explain it.
    fn unexplained(&self, trials: &[Trial], after: &[OnRecord]) -> Option<Signature> {
        self.model.judged.colour.moment?;
        let gain = self.model.plain.bic - self.model.judged.bic;
        if gain <= self.settings.thresholds.gain {
            return None;
        }
        let worst = (0..trials.len())
            .max_by(|&one, &other| after[one].errors.heading.total_cmp(&after[other].errors.heading))?;
        let (trial, replayed) = (&trials[worst], &after[worst].replayed);
        let first = trial.observed_rows().next().unwrap_or(0);
        let rudder = &trial.rudder()[first..first + replayed.time.len()];
        Some(diagnostics::signature(
            worst,
            &replayed.time,
            &replayed.residual,
            &replayed.heading,
            rudder,
            trial.sampling_period(),
        ))
    }

    /// The monomial that carries most of what is left, with those that cannot be told from it.
    fn discover(&self, sizes: &Sizes) -> Option<Empirical> {
        let records = &self.search.problem.records;
        let rms = |values: &mut dyn Iterator<Item = f64>| {
            let (square, count) = values.fold((0.0, 0usize), |(sum, n), x| (sum + x * x, n + 1));
            (square / count.max(1) as f64).sqrt().max(1e-9)
        };
        let heading = rms(&mut records.iter().flat_map(|r| r.observed.iter().map(|&row| r.heading[row])));
        let has_speed = records.iter().all(|record| record.speed().is_some());
        let speed = rms(&mut records.iter().filter_map(Record::speed).flat_map(|s| s.values().iter().copied()));
        let size = [sizes.rate, sizes.rudder, heading, speed];
        let library: Vec<Candidate> = (0..LIBRARY.len())
            .filter(|&place| has_speed || LIBRARY[place].of[3] == 0)
            .map(|place| Candidate {
                term: Term {
                    effect: Arc::new(Monomial { place, size }),
                    only: None,
                    held: &[],
                    lowest: vec![-10.0],
                    highest: vec![10.0],
                    scale: vec![0.02],
                    sees_heading: LIBRARY[place].of[2] > 0,
                },
                starts: vec![vec![0.0]],
                large: vec![0.02],
            })
            .collect();
        let search = Search { problem: self.search.problem, candidates: &library, thresholds: self.search.thresholds };
        let tried = search.try_all(self.model, &self.model.judged, false);
        let best = tried.first().filter(|best| search.believes(&library[best.place].term, &best.evidence))?;
        let near = tried.iter().take_while(|tried| tried.fit.bic < best.fit.bic + ALIAS);
        let term = &library[best.place].term;
        let square: f64 = search.adopted(best).plain.residual.iter().flatten().map(|e| e * e).sum();
        Some(Empirical {
            group: near.map(|tried| library[tried.place].term.effect.form()).collect(),
            equation: term.effect.equation(),
            evidence: best.evidence,
            error: (square / self.search.problem.observations() as f64).sqrt(),
        })
    }
}

/// What another trial would tell.
#[derive(Debug, Clone, PartialEq)]
pub struct Prospect {
    /// The manoeuvre.
    pub name: String,
    /// Rivals (the term in the model, the other one) that this trial together with the records would tell apart.
    pub separated: Vec<[String; 2]>,
    /// Rivals it would not.
    pub still_alike: Vec<[String; 2]>,
    /// Effects that the records could not show and this trial would.
    pub revealed: Vec<String>,
    /// Effects that stay hidden.
    pub still_hidden: Vec<String>,
    /// Σ log(1 + expected gain in −2 log L) over all of these: what decides between trials that settle as many.
    pub information: f64,
    /// Mean logarithm of the standard deviations of the parameters, less that of the records alone.
    pub sharpening: Option<f64>,
}

impl Analysis {
    /// The fitted ship, without terms that belong to the weather of one record: what a next trial would be run with.
    pub fn ship(&self) -> Response {
        held_out::portable(&self.model.structure, &self.model.plain.theta)
    }

    /// What each of some planned trials would tell beside the records, best first.
    ///
    /// A planned trial is a record of the fitted ship itself, made by the caller; only its rudder and its times count.
    pub fn prospects(&self, planned: &[(String, Trial)]) -> Vec<Prospect> {
        let now = self.ground(&self.problem, &self.model.structure, &self.model.plain).uncertainty();
        let mut prospects: Vec<Prospect> =
            planned.par_iter().map(|(name, trial)| self.prospect(name, trial, now)).collect();
        let rank = |prospect: &Prospect| prospect.separated.len() + prospect.revealed.len();
        prospects.sort_by(|one, other| {
            let by_information = other.information.total_cmp(&one.information);
            let sharp = |prospect: &Prospect| prospect.sharpening.unwrap_or(0.0);
            rank(other).cmp(&rank(one)).then(by_information).then(sharp(one).total_cmp(&sharp(other)))
        });
        prospects
    }

    fn ground<'a>(&self, problem: &'a Problem, structure: &'a Structure, fit: &'a Fit) -> Ground<'a> {
        Ground { problem, structure, fit, variance: self.problem.variance(&self.model.plain) }
    }

    fn prospect(&self, name: &str, trial: &Trial, now: Option<f64>) -> Prospect {
        let count = self.problem.records.len();
        let mut records = self.problem.records.clone();
        let record = Record::averaged(trial, self.base.response.T().abs());
        let ship = self.ship();
        let rest = vec![[record.heading[record.observed[0]], 0.0]];
        let initial = errors::full(&ship, &record, &rest).map_or(rest[0], |replayed| replayed.initial);
        records.push(record);
        let problem = self.problem.on(records);
        let mut structure = self.model.structure.clone();
        structure.records = count + 1;
        let of_first = |term: &mut Term| {
            if held_out::is_of_one_record(term.effect.id()) && term.only.is_none() {
                term.only = Some(0);
            }
        };
        structure.terms.iter_mut().for_each(of_first);
        let mut fit = self.model.plain.clone();
        if structure.own_bias {
            fit.theta.insert(2 + count, ship.parameters()[2]);
        }
        fit.initial.push(initial);
        let ground = self.ground(&problem, &structure, &fit);
        let log_n = (problem.observations() as f64).ln();
        let mut prospect = Prospect {
            name: name.to_owned(),
            separated: Vec::new(),
            still_alike: Vec::new(),
            revealed: Vec::new(),
            still_hidden: Vec::new(),
            information: 0.0,
            sharpening: ground.uncertainty().zip(now).map(|(then, now)| then - now),
        };
        let label = |id: &str, form: &str| format!("{id} ({form})");
        for (place, (effect, term)) in self.effects.iter().zip(&structure.terms).enumerate() {
            for (id, form) in &effect.aliases {
                let is = |c: &&Candidate| (c.term.effect.id(), c.term.effect.form()) == (*id, *form);
                let Some(rival) = self.candidate_terms.iter().find(is) else { continue };
                let mut rival = rival.clone();
                of_first(&mut rival.term);
                let gain = ground.distance(place, &rival);
                prospect.information += gain.max(0.0).ln_1p();
                let pair = [label(term.effect.id(), term.effect.form()), label(id, form)];
                if gain > 2.0 * ALIAS { prospect.separated.push(pair) } else { prospect.still_alike.push(pair) }
            }
        }
        for hidden in self.candidates.iter().filter(|c| c.outcome == Outcome::NotObservable && c.visibility.is_some()) {
            let is = |c: &&Candidate| (c.term.effect.id(), c.term.effect.form()) == (hidden.id, hidden.form);
            let Some(candidate) = self.candidate_terms.iter().find(is) else { continue };
            let gain = ground.visibility(candidate);
            prospect.information += gain.max(0.0).ln_1p();
            let needed = self.thresholds.gain + candidate.term.freedom() as f64 * log_n;
            let name = label(hidden.id, hidden.form);
            if gain > needed { prospect.revealed.push(name) } else { prospect.still_hidden.push(name) }
        }
        prospect
    }
}
