//! Analysis of the records of one ship: a pipeline of stages, each a function of the results before it.
//!
//! rudder noise and outliers → base → full model and noise law → structures → comparison → named effects or shapes →
//! residual analysis → hulls → document

use std::borrow::Cow;
use std::sync::Arc;

use document::HeadingNoise;
use document::trace::AnalysisDocument;
use identify::hull::HullEstimate;
use identify::{Estimate, maximum_likelihood};
use nalgebra::DMatrix;
use rayon::prelude::*;
use ship::{RegressorChannel, Response};
use trial::{Channel, Trial};

use crate::average::{FittedAverage, ModelAverage};
use crate::base::FittedBase;
use crate::candidates;
use crate::comparison::{RecordComparison, ReplayResult, initial_state_guesses, replay_base};
use crate::empirical;
use crate::fit::{FittedRecords, StructureFit};
use crate::fold_observer::{FoldObserver, NoFoldObserver};
use crate::full::{self, FullModel};
use crate::hulls;
use crate::leave_one_out::leave_one_out;
use crate::location::attribute;
use crate::model::Term;
use crate::noise::CorrelatedNoise;
use crate::noise_law::NoiseLaw;
use crate::record::PreparedRecord;
use crate::replay_errors::ReplayDepth;
use crate::report;
use crate::residual_analysis::{Innovations, ResidualAnalysis, heading_error_squares, innovations};
use crate::rudder::{self, RudderNoise};
use crate::selection::{EffectId, Selection};
use crate::settings::{Settings, TraceError};
use crate::shape::{self, ShapeAnalysis};
use crate::structures::{self, Structures};

/// Result of a trace: document, base, weighted structures, noise law and replays.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// Document (`trace.json`).
    pub document: AnalysisDocument,
    /// First-order response (constant K and T) with the least heading error.
    pub base: Estimate,
    /// Comparison of base and structure average on every fitted record.
    pub identification: Vec<RecordComparison>,
    /// Comparison of base and structure average on every held-out record; empty without held-out records.
    pub validation: Vec<RecordComparison>,
    /// Leave-one-out comparison of every fitted record; `None` if the other records give no base or no finite replay.
    /// Empty unless the analysis is thorough, several records are fitted and none is held out; also empty if stopped.
    pub leave_one_out: Vec<Option<RecordComparison>>,
    /// Structures with their probabilities.
    pub structures: Structures,
    /// Full model with the most probable noise law.
    pub full_model: FullModel,
    /// Heading noise under that law, averaged over the records.
    pub heading_noise: HeadingNoise,
    /// Hull models of three degrees of freedom, averaged with the structures; empty if none is fitted.
    pub hulls: Vec<HullEstimate>,
    pub(crate) problem: FittedRecords,
    pub(crate) candidates: Vec<Arc<Term>>,
}

/// Channels kept by `Settings::uses_minimal_channels`.
const COMMON: [Channel; 3] = [Channel::Heading, Channel::Rudder, Channel::YawRate];

/// Records reduced to the channels [`COMMON`].
fn of_heading(trials: &[Trial]) -> Vec<Trial> {
    let is_more = |channel: &Channel| !COMMON.contains(channel);
    let reduced = |trial: &Trial| {
        trial
            .clone()
            .without_channels(&trial.channels().map(|(channel, _)| channel).filter(is_more).collect::<Vec<Channel>>())
    };
    trials.iter().map(reduced).collect()
}

/// Records without compass outliers, and the times (s) of the removed readings.
///
/// Outliers are found by [`maximum_likelihood::spike_times`], record by record; a record for which it fails keeps all
/// readings.
pub fn without_spikes(trials: &[Trial]) -> (Cow<'_, [Trial]>, Vec<Vec<f64>>) {
    let spikes = |trial: &Trial| {
        maximum_likelihood::spike_times(std::slice::from_ref(trial))
            .map_or_else(|_| Vec::new(), |mut all| all.remove(0))
    };
    let readings: Vec<Vec<f64>> = trials.par_iter().map(spikes).collect();
    let kept = match readings.iter().all(Vec::is_empty) {
        true => Cow::Borrowed(trials),
        false => trials.iter().zip(&readings).map(|(trial, out)| trial.clone().without_headings(out)).collect(),
    };
    (kept, readings)
}

/// Checks that every required effect is a candidate; fails with the reason for the first that is not.
fn refuse_lacking(candidates: &[Arc<Term>], selection: &Selection) -> Result<(), TraceError> {
    let is_there = |id: &&EffectId| candidates.iter().any(|term| term.effect.id() == id.as_str());
    let Some(&effect) = selection.required.iter().find(|id| !is_there(id)) else { return Ok(()) };
    let forms: Vec<_> = selection.effects().into_iter().filter(|form| form.id() == effect.as_str()).collect();
    let lacking = forms.iter().find_map(|form| form.needs().map(RegressorChannel::missing_message));
    let reason = match forms.iter().any(|form| form.is_random()) {
        true => "it is a noise law, which every trace tries anyway",
        false => lacking.unwrap_or("the records cannot show it"),
    };
    Err(TraceError::NoCandidate { effect, reason })
}

/// Identifies the effects missing from the first-order model of one ship. `validation` records are only replayed: the
/// model does not depend on them.
///
/// Compass outliers are removed from all records; the document lists those of the fitted records. A rudder with
/// measurement noise is replaced by its piecewise linear estimate. Fails if a setting is out of range, if a requested
/// effect is no candidate, if the base cannot be fitted, or if a replay is not finite.
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
/// # let read = trial::reader::read_from_reader("run.csv".as_ref(), table.as_bytes(), None, None)?;
/// // A zig-zag of a ship with cubic damping.
/// let analysis = kempf_trace::trace(&[read.trial], &[], &kempf_trace::Settings::default())?;
/// assert_eq!(analysis.document.effects[0].id, "nonlinear_damping");
/// let errors = &analysis.identification[0];
/// assert!(errors.average_replay.errors.heading_rmse < 0.5 * errors.base_replay.errors.heading_rmse);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn trace(trials: &[Trial], validation: &[Trial], settings: &Settings) -> Result<Analysis, TraceError> {
    trace_with_observer(trials, validation, settings, &NoFoldObserver)
}

/// [`trace`] with an observer of the leave-one-out folds, which can stop them.
pub fn trace_with_observer(
    trials: &[Trial],
    validation: &[Trial],
    settings: &Settings,
    observer: &dyn FoldObserver,
) -> Result<Analysis, TraceError> {
    settings.check()?;
    if settings.uses_minimal_channels {
        return analyse(&of_heading(trials), &of_heading(validation), settings, observer);
    }
    analyse(trials, validation, settings, observer)
}

fn analyse(
    trials: &[Trial],
    validation: &[Trial],
    settings: &Settings,
    observer: &dyn FoldObserver,
) -> Result<Analysis, TraceError> {
    let (trials, rudder_noises) = rudder::estimate_rudders(trials);
    let (trials, outliers) = without_spikes(&trials);
    let validation = without_spikes(&rudder::estimate_rudders(validation).0).0.into_owned();
    let base = FittedBase::fit(&trials)?;
    let ship_length_time = candidates::ship_length_time(&trials, base.estimate.response.K_over_T);
    let prepared = |trial| PreparedRecord::averaged(trial, ship_length_time);
    let records: Vec<PreparedRecord> = trials.iter().map(prepared).collect();
    let candidates = candidates_of(&records, &trials, ship_length_time, settings)?;
    let problem = FittedRecords::new(records, base.estimate.response.inverse_T, ship_length_time);
    let (full, structures) = weighed(&problem, &base, &candidates, &trials, settings, &rudder_noises);
    let (members, noise_law) = (structures.weighted_members(), &full.noise_law);
    let compare = |hulls: &[_]| compare_fitted(&trials, &base, noise_law, &members, hulls, settings, ship_length_time);
    let (mut identification, mut keeps_base) = compare(&[])?;
    let attribution = attribute(&problem, &full, &structures, &candidates, settings);
    let residual_analysis =
        ResidualAnalysis::new(&problem, &full, &structures, &identification, &trials, &attribution, &rudder_noises);
    let hulls = hulls::fit_supported_hulls(&trials, settings, &identification, &residual_analysis);
    (identification, keeps_base) = if hulls.is_empty() { (identification, keeps_base) } else { compare(&hulls)? };
    let averaged = FittedAverage { members: &members, hulls: &hulls, noise_law, fitted_record: None, ship_length_time };
    let held_out = averaged.compare_all(&validation, &base.estimate.response, settings.is_thorough)?;
    let is_folded = settings.is_thorough && trials.len() > 1 && validation.is_empty();
    let folds = is_folded.then(|| leave_one_out(&trials, &problem, &full, &structures, &hulls, observer));
    let parts = report::TraceParts {
        trials: &trials,
        settings,
        base: &base,
        full_model: &full,
        structures: &structures,
        candidates: &candidates,
        identification: &identification,
        validation: (&validation, &held_out),
        leave_one_out: folds.as_deref().unwrap_or_default(),
        residual_analysis: &residual_analysis,
        attribution: &attribution,
        outlier_times: &outliers,
        rudder_noises: &rudder_noises,
        keeps_base,
        has_hulls: !hulls.is_empty() && !keeps_base,
        fitted_records: &problem,
    };
    Ok(Analysis {
        document: parts.document(),
        heading_noise: HeadingNoise::mean(&parts.heading_noise()).unwrap_or_default(),
        base: base.estimate,
        identification,
        validation: held_out,
        leave_one_out: folds.unwrap_or_default(),
        structures,
        full_model: full,
        hulls,
        problem,
        candidates,
    })
}

/// Full model and weighed structures under the most probable noise law. If all records declare a calm, heading errors
/// replace a random moment if their structures replay the records better.
fn weighed(
    problem: &FittedRecords,
    base: &FittedBase,
    candidates: &[Arc<Term>],
    trials: &[Trial],
    settings: &Settings,
    rudder_noises: &[Option<RudderNoise>],
) -> (FullModel, Structures) {
    let has_waves = candidates::has_waves(trials, &settings.selection);
    let choose = |kinds: &[CorrelatedNoise]| {
        let fulls = full::fit_full_models(problem, base, candidates, has_waves, kinds);
        let fulls = rudder::with_rudder_noise(fulls, problem, base.estimate.response.K_over_T, rudder_noises);
        structures::weigh_structures(problem, fulls, candidates, &settings.selection, settings.rule, base.mean_square())
    };
    let kinds: Vec<CorrelatedNoise> = CorrelatedNoise::all().collect();
    let best = choose(&kinds);
    if !trials.iter().all(Trial::is_calm) || !best.0.noise_law.is_random_moment() {
        return best;
    }
    // In a calm there is no random yaw moment.
    let of_heading: Vec<CorrelatedNoise> = kinds.into_iter().filter(|kind| kind.is_heading_error()).collect();
    let calm = choose(&of_heading);
    if calm.1.ship_mean_square() < best.1.ship_mean_square() { calm } else { best }
}

/// Candidate terms that the selection admits, then the requested number of monomials; fails if a required effect is no
/// candidate.
fn candidates_of(
    records: &[PreparedRecord],
    trials: &[Trial],
    time: f64,
    settings: &Settings,
) -> Result<Vec<Arc<Term>>, TraceError> {
    let mut candidates = candidates::candidate_terms(records, trials, time, &settings.selection);
    refuse_lacking(&candidates, &settings.selection)?;
    candidates.extend(empirical::monomial_terms(records, trials, time).take(settings.monomial_count));
    Ok(candidates)
}

/// Comparisons of base and average on the fitted records, and `true` if the replay of the base is kept.
fn compare_fitted(
    trials: &[Trial],
    base: &FittedBase,
    law: &NoiseLaw,
    members: &[(f64, &StructureFit)],
    hulls: &[HullEstimate],
    &Settings { is_thorough, .. }: &Settings,
    time: f64,
) -> Result<(Vec<RecordComparison>, bool), TraceError> {
    let response = &base.estimate.response;
    let depth = if is_thorough { ReplayDepth::Windows } else { ReplayDepth::Heading };
    let compare = |(number, trial): (usize, &Trial)| {
        let record = PreparedRecord::unaveraged(trial);
        let before = replay_base(trial, &record, response, depth)?;
        let is_base = hulls.is_empty() && members.iter().all(|(_, fit)| fit.structure.terms.is_empty());
        let averaged =
            FittedAverage { members, hulls, noise_law: law, fitted_record: Some(number), ship_length_time: time };
        let mut after = averaged.replay_on(trial, &record, &initial_state_guesses(trial, response), depth)?;
        if is_base {
            // No effect is added: keep the closed-form replay of the base.
            let band = after.band_half_width;
            after = ReplayResult { band_half_width: band, ..before.clone() };
        }
        Ok(RecordComparison { base_replay: before, average_replay: after })
    };
    let all: Result<Vec<RecordComparison>, TraceError> = trials.par_iter().enumerate().map(compare).collect();
    let mut all = all?;
    let keeps_base = keep_nearest(&mut all);
    Ok((all, keeps_base))
}

/// Replaces the replay of the average by the replay of the base if the average has the larger heading error, as under a
/// random moment that no replay can reproduce. `true` if it was replaced.
fn keep_nearest(all: &mut [RecordComparison]) -> bool {
    let [before, after] = heading_error_squares(all);
    let keeps_base = after > before;
    if keeps_base {
        for comparison in all {
            let band = comparison.average_replay.band_half_width.take();
            comparison.average_replay = ReplayResult { band_half_width: band, ..comparison.base_replay.clone() };
        }
    }
    keeps_base
}

/// Structure of the average with weight, response and covariance, without the terms of single records.
#[derive(Debug, Clone)]
pub struct PlausibleStructure {
    /// Probability among the members of the average; the sum over all members is 1.
    pub weight: f64,
    /// Response T r' + r = K (δ + δ_r) with the effects of the structure.
    pub response: Response,
    /// Indices of the fitted parameters among those of the response.
    pub fitted: Vec<usize>,
    /// Covariance of the fitted parameters in this order; `None` if the precision of the fit is singular.
    pub covariance: Option<DMatrix<f64>>,
}

impl Analysis {
    /// Normalised innovations of the most probable structure on every fitted record.
    pub fn innovations(&self) -> Vec<Innovations> {
        let best = self.structures.weighed.first();
        best.map_or_else(Vec::new, |best| innovations(&self.problem, &best.fit.residual, &self.full_model.noise_law))
    }

    /// Shape analysis of the residual of the most probable structure; `None` without a structure, or if its
    /// sensitivities are linearly dependent.
    pub fn shapes(&self) -> Option<ShapeAnalysis> {
        shape::analyse_shapes(&self.problem, &self.structures.weighed.first()?.fit, &self.full_model.noise_law)
    }

    /// Members of the structure average for predictions, the most probable first.
    pub fn plausible_structures(&self) -> Vec<PlausibleStructure> {
        let member = |(weight, fit): (f64, &StructureFit)| {
            let (structure, theta) = fit.structure.for_record(None, &fit.theta);
            let fitted = structure.fitted_indices();
            let covariance = fit.record_covariance(None).map(|kept| {
                // A parameter given relative to another one is converted to its physical value.
                let all = structure.physical_covariance(&structure.expanded_covariance(&kept));
                DMatrix::from_fn(fitted.len(), fitted.len(), |i, j| all[(fitted[i], fitted[j])])
            });
            PlausibleStructure { weight, response: structure.response(None, &theta), fitted, covariance }
        };
        self.structures.weighted_members().into_iter().map(member).collect()
    }

    /// Average of structures and hulls for replays, without the terms of single records.
    pub fn average(&self) -> ModelAverage {
        self.averaged(&self.structures.weighted_members()).average()
    }

    /// Averaged model for a record that was not fitted.
    fn averaged<'a>(&'a self, members: &'a [(f64, &'a StructureFit)]) -> FittedAverage<'a> {
        FittedAverage {
            members,
            hulls: &self.hulls,
            noise_law: &self.full_model.noise_law,
            fitted_record: None,
            ship_length_time: self.problem.ship_length_time,
        }
    }

    /// Response of the most probable structure, without the terms of single records; the base if there is no structure.
    pub fn ship(&self) -> Response {
        let members = self.structures.weighted_members();
        members.first().map_or_else(
            || Response::first_order_ship(self.base.response),
            |(_, fit)| fit.structure.response(None, &fit.theta),
        )
    }

    /// Replay of the average on a noise-free trial, from the best initial state near `start` (rad, rad/s). Its band
    /// covers the errors of parameters and structures only. `None` if no replay is finite.
    pub fn replay_in_calm(&self, trial: &Trial, start: [f64; 2]) -> Option<ReplayResult> {
        let members = self.structures.weighted_members();
        let calm = NoiseLaw::white(1, 1e-16);
        let averaged = FittedAverage { noise_law: &calm, ..self.averaged(&members) };
        averaged.replay_on(trial, &PreparedRecord::unaveraged(trial), &[start], ReplayDepth::Windows).ok()
    }
}
