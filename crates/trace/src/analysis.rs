//! The whole analysis of some records of one ship: a pipeline of stages, each a function of what the last one made.
//!
//! prepare → base → full fit → noise → structures → names held against shapes → comparison → document

use std::borrow::Cow;
use std::sync::Arc;

use document::HeadingNoise;
use document::trace::Document;
use identify::hull::HullEstimate;
use identify::{Estimate, maximum_likelihood};
use nalgebra::DMatrix;
use rayon::prelude::*;
use ship::{Regressor, Response};
use trial::{Channel, Trial};

use crate::average::{Average, AveragedModel};
use crate::base::Base;
use crate::candidates;
use crate::comparison::{RecordComparison, ReplayResult, before, starts};
use crate::empirical;
use crate::fit::{FittedRecords, StructureFit};
use crate::full::{self, Full};
use crate::hulls;
use crate::leave_one_out::leave_one_out;
use crate::location::locate;
use crate::model::Term;
use crate::noise::CorrelatedNoise;
use crate::record::PreparedRecord;
use crate::remainder::{Innovations, Remainder, innovations, squares};
use crate::replay_errors::ReplayDepth;
use crate::report;
use crate::rudder::{self, RudderError};
use crate::selection::{EffectId, Selection};
use crate::settings::{Settings, TraceError};
use crate::shape::{self, ShapeAnalysis};
use crate::structures::{self, Structures};
use crate::watcher::{NoWatcher, Watcher};
use crate::weights::NoiseLaw;

/// The result: what is said of the records, and what it was said from.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// What is said.
    pub document: Document,
    /// The base of constant K and T: no first-order response is nearer to the records.
    pub base: Estimate,
    /// Records that were fitted.
    pub identification: Vec<RecordComparison>,
    /// Records that were not.
    pub validation: Vec<RecordComparison>,
    /// Each of several records as if it had been held out, where none was. `None` where the others have no base or no
    /// finite replay.
    pub left_out: Vec<Option<RecordComparison>>,
    /// The structures with their probabilities.
    pub structures: Structures,
    /// The full model and the noise that it leaves.
    pub full: Full,
    /// That noise, its sizes being means over the records.
    pub noise: HeadingNoise,
    /// Hulls of three degrees of freedom that stand beside the structures.
    pub hulls: Vec<HullEstimate>,
    pub(crate) problem: FittedRecords,
    pub(crate) candidates: Vec<Arc<Term>>,
}

/// Channels of a trace of heading and rudder alone.
const COMMON: [Channel; 3] = [Channel::Heading, Channel::Rudder, Channel::YawRate];

/// Records without channels that some methods do not read.
fn of_heading(trials: &[Trial]) -> Vec<Trial> {
    let is_more = |channel: &Channel| !COMMON.contains(channel);
    let of = |trial: &Trial| {
        trial.clone().without(&trial.channels().map(|(channel, _)| channel).filter(is_more).collect::<Vec<Channel>>())
    };
    trials.iter().map(of).collect()
}

/// Records without the readings of their compass that belong to no ship, and the times, s, of these.
pub fn without_spikes(trials: &[Trial]) -> (Cow<'_, [Trial]>, Vec<Vec<f64>>) {
    let of = |trial: &Trial| {
        maximum_likelihood::spikes(std::slice::from_ref(trial)).map_or_else(|_| Vec::new(), |mut all| all.remove(0))
    };
    let readings: Vec<Vec<f64>> = trials.par_iter().map(of).collect();
    let kept = match readings.iter().all(Vec::is_empty) {
        true => Cow::Borrowed(trials),
        false => trials.iter().zip(&readings).map(|(trial, out)| trial.clone().without_readings(out)).collect(),
    };
    (kept, readings)
}

/// Why an effect that was asked for cannot be in the model.
fn refuse_lacking(candidates: &[Arc<Term>], selection: &Selection) -> Result<(), TraceError> {
    let is_there = |id: &&EffectId| candidates.iter().any(|one| one.effect.id() == id.as_str());
    let Some(&effect) = selection.with.iter().find(|id| !is_there(id)) else { return Ok(()) };
    let forms: Vec<_> = selection.effects().into_iter().filter(|form| form.id() == effect.as_str()).collect();
    let lacking = forms.iter().find_map(|form| form.needs().map(Regressor::lacking));
    let reason = match forms.iter().any(|form| form.is_random()) {
        true => "it is a kind of noise, which is looked for in every record",
        false => lacking.unwrap_or("the records leave no place for it"),
    };
    Err(TraceError::Asked { effect, reason })
}

/// Analyses records of one ship. `validation` records only judge: nothing else depends on them.
///
/// Readings of the compass that belong to no ship are left out of all records, and listed; a rudder with errors of its
/// instrument is replaced by the one behind its readings. Fails when a setting is out of its range, when an effect that
/// was asked for cannot be in the model, and when the base cannot be fitted or replayed.
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
/// assert_eq!(analysis.document.effects[0].id, "nonlinear_damping");
/// let errors = &analysis.identification[0];
/// assert!(errors.after.errors.heading < 0.5 * errors.before.errors.heading);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn trace(trials: &[Trial], validation: &[Trial], settings: &Settings) -> Result<Analysis, TraceError> {
    watched(trials, validation, settings, &NoWatcher)
}

/// The same as [`trace`] while somebody watches.
pub fn watched(
    trials: &[Trial],
    validation: &[Trial],
    settings: &Settings,
    watcher: &dyn Watcher,
) -> Result<Analysis, TraceError> {
    settings.check()?;
    if settings.heading_alone {
        return analysed(&of_heading(trials), &of_heading(validation), settings, watcher);
    }
    analysed(trials, validation, settings, watcher)
}

fn analysed(
    trials: &[Trial],
    validation: &[Trial],
    settings: &Settings,
    watcher: &dyn Watcher,
) -> Result<Analysis, TraceError> {
    let (trials, rudder_errors) = rudder::without_noise(trials);
    let (trials, outliers) = without_spikes(&trials);
    let validation = without_spikes(&rudder::without_noise(validation).0).0.into_owned();
    let base = Base::of(&trials)?;
    let response = base.estimate.response;
    let time = candidates::ship_time(&trials, response.K_over_T);
    let records: Vec<PreparedRecord> = trials.iter().map(|trial| PreparedRecord::averaged(trial, time)).collect();
    let candidates = candidates_of(&records, &trials, time, settings)?;
    let problem = FittedRecords::new(records, response.inverse_T, time);
    let (full, structures) = weighed(&problem, &base, &candidates, &trials, settings, &rudder_errors);
    let members = structures.members();
    let fit = |hulls: &[HullEstimate]| fitted(&trials, &base, &full.law, &members, hulls, settings, time);
    let (mut identification, mut no_nearer) = fit(&[])?;
    let location = locate(&problem, &full, &structures, &candidates, settings);
    let remainder = Remainder::new(&problem, &full, &structures, &identification, &trials, &location, &rudder_errors);
    let hulls = hulls::fit(&trials, settings, &identification, &remainder);
    (identification, no_nearer) = if hulls.is_empty() { (identification, no_nearer) } else { fit(&hulls)? };
    let unseen = AveragedModel { members: &members, hulls: &hulls, law: &full.law, known: None, time };
    let judged = unseen.all_compared(&validation, &response, settings.thorough)?;
    let is_folded = settings.thorough && trials.len() > 1 && validation.is_empty();
    let folds = || leave_one_out(&trials, &problem, &full, &structures, &hulls, watcher);
    let left_out = if is_folded { folds() } else { Vec::new() };
    let parts = report::TraceParts {
        trials: &trials,
        settings,
        base: &base,
        full: &full,
        structures: &structures,
        candidates: &candidates,
        identification: &identification,
        validation: (&validation, &judged),
        left_out: &left_out,
        remainder: &remainder,
        location: &location,
        outliers: &outliers,
        rudder_errors: &rudder_errors,
        no_nearer,
        problem: &problem,
    };
    Ok(Analysis {
        document: parts.document(),
        noise: HeadingNoise::mean(&parts.heading_noise()).unwrap_or_default(),
        base: base.estimate,
        identification,
        validation: judged,
        left_out,
        structures,
        full,
        hulls,
        problem,
        candidates,
    })
}

/// The full model and the structures under the noise that explains the records best.
fn weighed(
    problem: &FittedRecords,
    base: &Base,
    candidates: &[Arc<Term>],
    trials: &[Trial],
    settings: &Settings,
    rudder_errors: &[Option<RudderError>],
) -> (Full, Structures) {
    let has_waves = candidates::has_waves(trials, &settings.selection);
    let under = |kinds: &[CorrelatedNoise]| {
        let fulls = full::fit(problem, base, candidates, has_waves, kinds);
        let fulls = rudder::beside(fulls, problem, base.estimate.response.K_over_T, rudder_errors);
        structures::choose(problem, fulls, candidates, &settings.selection, settings.rule, base.mean_square())
    };
    let kinds: Vec<CorrelatedNoise> = CorrelatedNoise::all().collect();
    let best = under(&kinds);
    if !trials.iter().all(Trial::is_calm) || !best.0.law.is_random_moment() {
        return best;
    }
    // In a calm nothing turns the ship at random: a ship that replays the records nearer is believed.
    let of_heading: Vec<CorrelatedNoise> = kinds.into_iter().filter(|kind| kind.is_of_heading()).collect();
    let other = under(&of_heading);
    if other.1.mean_square_of_ship() < best.1.mean_square_of_ship() { other } else { best }
}

/// The candidates of a request; fails where one that was asked for cannot be among them.
fn candidates_of(
    records: &[PreparedRecord],
    trials: &[Trial],
    time: f64,
    settings: &Settings,
) -> Result<Vec<Arc<Term>>, TraceError> {
    let mut candidates = candidates::all(records, trials, time, &settings.selection);
    refuse_lacking(&candidates, &settings.selection)?;
    candidates.extend(empirical::candidates(records, trials, time).take(settings.monomials));
    Ok(candidates)
}

/// Base and average on the records that were fitted, and whether the base is kept as no farther from them.
fn fitted(
    trials: &[Trial],
    base: &Base,
    law: &NoiseLaw,
    members: &[(f64, &StructureFit)],
    hulls: &[HullEstimate],
    &Settings { thorough, .. }: &Settings,
    time: f64,
) -> Result<(Vec<RecordComparison>, bool), TraceError> {
    let response = &base.estimate.response;
    let depth = if thorough { ReplayDepth::Windows } else { ReplayDepth::Heading };
    let of = |(number, trial): (usize, &Trial)| {
        let record = PreparedRecord::whole(trial);
        let before = before(trial, &record, response, depth)?;
        let is_base = hulls.is_empty() && members.iter().all(|(_, fit)| fit.structure.terms.is_empty());
        let after = AveragedModel { members, hulls, law, known: Some(number), time };
        let mut after = after.on(trial, &record, &starts(trial, response), depth)?;
        if is_base {
            // Nothing is added: the base stays what it is.
            let band = after.band;
            after = ReplayResult { band, ..before.clone() };
        }
        Ok(RecordComparison { before, after })
    };
    let all: Result<Vec<RecordComparison>, TraceError> = trials.par_iter().enumerate().map(of).collect();
    let mut all = all?;
    let no_nearer = keep_nearest(&mut all);
    Ok((all, no_nearer))
}

/// Where the average is no nearer to the fitted records than the base, the replay stays that of the base: a random
/// moment describes the records, which no replay foresees. Whether that is so.
fn keep_nearest(all: &mut [RecordComparison]) -> bool {
    let [before, after] = squares(all);
    let no_nearer = after > before;
    if no_nearer {
        for one in all {
            let band = one.after.band.take();
            one.after = ReplayResult { band, ..one.before.clone() };
        }
    }
    no_nearer
}

/// A structure that the records cannot tell from the best, as a prediction takes it: without what is of one record.
#[derive(Debug, Clone)]
pub struct Plausible {
    /// Probability among these.
    pub weight: f64,
    /// The ship.
    pub response: Response,
    /// Places among its parameters of those that were fitted.
    pub fitted: Vec<usize>,
    /// Covariance of these; `None` where the records do not tell them apart.
    pub covariance: Option<DMatrix<f64>>,
}

impl Analysis {
    /// Innovations of the most probable structure on every fitted record.
    pub fn innovations(&self) -> Vec<Innovations> {
        let best = self.structures.all.first();
        best.map_or_else(Vec::new, |best| innovations(&self.problem, &best.fit.residual, &self.full.law))
    }

    /// Moments of a shape in what the most probable structure leaves, against every random law; `None` where its
    /// parameters cannot be told apart.
    pub fn shapes(&self) -> Option<ShapeAnalysis> {
        shape::analysis(&self.problem, &self.structures.all.first()?.fit, &self.full.law)
    }

    /// The members of the average as predictions take them.
    pub fn plausible(&self) -> Vec<Plausible> {
        let of = |(weight, fit): (f64, &StructureFit)| {
            let (structure, theta) = fit.structure.alone(None, &fit.theta);
            let fitted = structure.fitted();
            let covariance = fit.kept_covariance(None).map(|kept| {
                // What is counted from another parameter has the sum of both.
                let all = structure.physical_covariance(&structure.spread(&kept));
                DMatrix::from_fn(fitted.len(), fitted.len(), |i, j| all[(fitted[i], fitted[j])])
            });
            Plausible { weight, response: structure.response(None, &theta), fitted, covariance }
        };
        self.structures.members().into_iter().map(of).collect()
    }

    /// The ship of every member of the average, without what belongs to the weather of one record.
    pub fn average(&self) -> Average {
        self.unseen(&self.structures.members()).average()
    }

    /// The average on a record that was not fitted.
    fn unseen<'a>(&'a self, members: &'a [(f64, &'a StructureFit)]) -> AveragedModel<'a> {
        AveragedModel { members, hulls: &self.hulls, law: &self.full.law, known: None, time: self.problem.time }
    }

    /// The ship of the most probable structure.
    pub fn ship(&self) -> Response {
        let members = self.structures.members();
        members.first().map_or_else(
            || Response::first_order_ship(self.base.response),
            |(_, fit)| fit.structure.response(None, &fit.theta),
        )
    }

    /// The average on a further trial, in a calm and perfectly recorded, from the best initial state near `start`: its
    /// band is that of the errors of parameters and structures alone. `None` when no replay is finite.
    pub fn in_a_calm(&self, trial: &Trial, start: [f64; 2]) -> Option<ReplayResult> {
        let members = self.structures.members();
        let calm = NoiseLaw::white(1, 1e-16);
        let after = AveragedModel { law: &calm, ..self.unseen(&members) };
        after.on(trial, &PreparedRecord::whole(trial), &[start], ReplayDepth::Windows).ok()
    }
}
