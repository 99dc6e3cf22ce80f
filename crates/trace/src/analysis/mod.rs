//! The whole analysis of some records of one ship, and its result.

mod apart;
mod base;
mod elsewhere;
mod fitted;
mod left_out;
mod missing;
mod parameters;
mod plausible;
mod prospects;
mod replays;
mod reporter;
mod result;
mod settings;
mod side;
mod steps;
#[cfg(test)]
mod tests;
mod told;

use std::borrow::Cow;

use identify::{Identifier, maximum_likelihood, output_error};
use rayon::prelude::*;
use ship::{Regressor, effects};
use trial::Trial;

use crate::candidates::{self, Candidate, Sizes};
use crate::change;
use crate::diagnostics::{self, Series};
use crate::fit::Problem;
use crate::held_out::HeldOut;
use crate::monomial;
use crate::record::Record;
use crate::search::{Model, NotFitted, Search};
use crate::structure::{Structure, Term};

use base::better_base;
use elsewhere::{believed_elsewhere, predicted_elsewhere};
use fitted::no_larger_error;
use left_out::leave_one_out;
use parameters::{indices, parameter_covariance, parameters, randomness, runner_up};
use replays::{initial, on_records, starts, validate};
use reporter::Reporter;

pub use apart::Apart;
pub use plausible::Plausible;
pub use prospects::Prospect;
pub use result::{
    Analysis, Considered, Empirical, Fitted, Judged, OnRecord, Outcome, Randomness, RunnerUp, Traced, Verdict,
};
pub use settings::{Settings, TraceError};
pub use steps::{Step, StepOnRecord};
use told::Told;

/// Times, s, of the readings of every record's compass that belong to no ship. A record that cannot be looked at has
/// none.
fn spikes(trials: &[Trial]) -> Vec<Vec<f64>> {
    let one = |trial: &Trial| {
        maximum_likelihood::spikes(std::slice::from_ref(trial)).map_or_else(|_| Vec::new(), |mut all| all.remove(0))
    };
    trials.par_iter().map(one).collect()
}

/// The records without some readings of their compass.
fn without<'a>(trials: &'a [Trial], readings: &[Vec<f64>]) -> Cow<'a, [Trial]> {
    match readings.iter().all(Vec::is_empty) {
        true => Cow::Borrowed(trials),
        false => trials.iter().zip(readings).map(|(trial, out)| trial.clone().without_readings(out)).collect(),
    }
}

/// Why an effect that was asked for is not in the model.
fn cannot_be_held(NotFitted(effect): NotFitted) -> TraceError {
    let forms: Vec<_> = effects::all().into_iter().filter(|form| form.id() == effect.as_str()).collect();
    let lacking = forms.iter().find_map(|form| form.needs().map(Regressor::lacking));
    let random = forms.iter().any(|form| form.is_random());
    let reason = match random {
        true => "the heading shows no narrow band that is faster than the manoeuvre",
        false => lacking.unwrap_or("the records leave no place for it"),
    };
    TraceError::Asked { effect, reason }
}

/// Whether a model of nothing but moments that come or go explains a record worse than a ship that changes.
fn change_is_better(search: &Search, base: &Model, model: &Model, sizes: &Sizes) -> bool {
    let comes_or_goes = |term: &Term| term.effect.has_instant() && !search.wanted.keeps(term);
    if model.structure.terms.is_empty() || !model.structure.terms.iter().all(comes_or_goes) {
        return false;
    }
    let library: Vec<Candidate> = change::candidate(&search.problem.records, sizes).into_iter().collect();
    let nameless = Search::new(search.problem, &library, search.thresholds);
    let tried = nameless.try_all(base, &base.plain, false);
    tried.iter().any(|tried| nameless.adopted(tried).judged.bic < model.judged.bic)
}

/// Analyses records of one ship.
///
/// The base comes from `output-error`, which is global in 1/T. `validation` records are replayed only; what makes their
/// error worse is not kept. Readings of the compass that belong to no ship are left out of all records, and listed.
/// Fails when a setting is out of its range and when the base cannot be fitted or replayed.
///
/// ```
/// # let mut table = String::from("t_s,heading_deg,rudder_deg\n");
/// # let (mut psi, mut r, mut delta, mut order) = (0.0_f64, 0.0_f64, 0.0_f64, 1.0_f64);
/// # for t in 0..300 {
/// #     table += &format!("{t},{psi},{delta}\n");
/// #     let next = (delta + 5.0 * order).clamp(-20.0, 20.0);
/// #     for k in 0..100 {
/// #         r += 0.01 * (0.1 * (delta + 0.01 * f64::from(k) * (next - delta)) - r - 0.5 * r * r * r) / 16.0;
/// #         psi += 0.01 * r;
/// #     }
/// #     order = if psi * order > 20.0 { -order } else { order };
/// #     delta = next;
/// # }
/// # let read = trial::reader::read_bytes("run.csv".as_ref(), table.as_bytes(), None, None)?;
/// // A zig-zag of a ship whose damping grows with the cube of its yaw rate.
/// let analysis = kempf_trace::trace(&[read.trial], &[], &kempf_trace::Settings::default())?;
/// assert_eq!(analysis.effects[0].id, "nonlinear_damping");
/// let errors = &analysis.identification[0];
/// assert!(errors.after.errors.heading < 0.5 * errors.before.errors.heading);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn trace(trials: &[Trial], validation: &[Trial], settings: &Settings) -> Result<Analysis, TraceError> {
    settings.thresholds.check()?;
    settings.wanted.check()?;
    let [outliers, outliers_elsewhere] = [trials, validation].map(spikes);
    let (trials, validation) = (without(trials, &outliers), without(validation, &outliers_elsewhere));
    let (trials, validation) = (&*trials, &*validation);
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
    let mut candidate_terms = candidates::all(&problem.records, &sizes);
    candidate_terms.retain(|candidate| settings.wanted.allows(candidate.term.effect.id()));
    candidate_terms.extend(monomial::candidates(&problem.records, &sizes, monomial::all()).take(settings.monomials));
    let mut search = Search::new(&problem, &candidate_terms, settings.thresholds);
    search.wanted = settings.wanted.clone();

    let constant = search.base(structure, &theta, &initial);
    let held_out: Vec<HeldOut> = validation.iter().map(|trial| HeldOut::new(trial, starts(trial, &first))).collect();
    let start = better_base(&search, &constant, &held_out);
    let tried = search.try_all(&start, &start.plain, false);
    let mut model = search.with_asked(&start).map_err(cannot_be_held)?;
    if settings.wanted.search {
        model = match model.structure.terms.is_empty() {
            true => search.decide(settings.rule, &start, search.run(&start, &tried)),
            false => {
                let found = search.run(&model, &search.try_all(&model, &model.plain, false));
                search.decide(settings.rule, &model, found)
            }
        };
    }

    let mut refused = Vec::new();
    if settings.wanted.search && change_is_better(&search, &start, &model, &sizes) {
        refused.push(String::from(
            "moments that come or go are not kept: a ship that is another one from an instant on explains the record better",
        ));
        model = start.clone();
    }

    model = believed_elsewhere(&search, model, &held_out, &mut refused);
    let predicted = predicted_elsewhere(&search, &mut model, &held_out);

    // Replays of what is nearest to the records, whatever the noise: no first-order response makes "before" smaller.
    let nearest = |model: &Model| {
        let closed = model.structure.is_first_order().then_some(&first);
        on_records(trials, (&model.structure, &model.plain), &first, closed, settings.thorough)
    };
    let before: Vec<OnRecord> = nearest(&constant)?;
    let (model, after) = no_larger_error(&search, model, &before, nearest, &mut refused);
    let told = Told::new(trials, &problem, [&constant, &model], &first, [before, after], settings.thorough)?;
    let names: Vec<String> = trials.iter().map(|trial| trial.name().to_owned()).collect();
    let judged = |names: Vec<String>, before: Vec<OnRecord>, after: Vec<OnRecord>| -> Vec<Judged> {
        let pairs = names.into_iter().zip(before.into_iter().zip(after));
        pairs.map(|(name, (before, after))| Judged { name, before, after, own_moment: None }).collect()
    };
    let series =
        |(on, trial): (&OnRecord, &Trial)| Series::new(&on.replay.time, &on.replay.residual, trial.sampling_period());
    let residuals = |all: &[OnRecord]| -> Vec<Series> { all.iter().zip(trials).map(series).collect() };
    let whiteness = [diagnostics::whiteness(&residuals(&told.before)), diagnostics::whiteness(&residuals(&told.after))];
    let elsewhere = if held_out.is_empty() { Vec::new() } else { validate(&held_out, &problem, &told.sides)? };
    let folds = settings.thorough && trials.len() > 1 && validation.is_empty();
    let left_out = if folds { leave_one_out(trials, &method, &problem, &told.sides) } else { Vec::new() };

    let fitted = told.fitted();
    let coloured = told.is_coloured(whiteness[1].lag1);
    let covariance = parameter_covariance(&problem, fitted, coloured);
    let parameters = parameters(&problem, fitted, covariance.as_ref(), &names);
    let (indices, rudder_bias) = indices(fitted, covariance.as_ref());
    let way = steps::way(&search, &start, &model);
    let report = Reporter {
        search: &search,
        settings,
        names: &names,
        start: &start,
        model: &model,
        way: &way,
        tried: &tried,
        predicted: &predicted,
    };
    let mut effects = report.effects(&parameters);
    let mut candidates = report.candidates(&effects);
    let weights = report.weigh(&mut effects, &mut candidates);
    let rivals = plausible::rivals(&search, &weights);
    let nameless = if told.random { report.nameless(&sizes) } else { None };
    let unexplained = match report.is_unexplained(&told, nameless.as_ref()) {
        true => report.signature(trials, &told.after),
        false => None,
    };
    let empirical = nameless.filter(|_| unexplained.is_some());
    let verdict = match (&unexplained, effects.is_empty()) {
        (Some(_), _) => Verdict::Unexplained,
        (None, true) => Verdict::Clean,
        (None, false) => Verdict::Traced,
    };
    let open = told.random.then(|| runner_up(&problem, &candidates, &candidate_terms)).flatten();
    let randomness = randomness(&problem, &model, &told, open);
    let Told { sides: [_, after_side], before, after, .. } = told;
    let identification = judged(names, before, after);
    Ok(Analysis {
        base,
        indices,
        rudder_bias,
        parameters,
        verdict,
        effects,
        steps: steps::steps(&way, &problem.records, &held_out),
        candidates,
        weights,
        unexplained,
        empirical,
        randomness,
        identification,
        validation: elsewhere,
        left_out,
        whiteness,
        refused,
        outliers: outliers.into_iter().chain(outliers_elsewhere).collect(),
        thresholds: settings.thresholds,
        tried,
        constant,
        start,
        candidate_terms,
        model,
        told: after_side,
        rivals,
        coloured,
        problem,
    })
}
