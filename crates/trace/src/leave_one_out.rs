//! Leave-one-out cross-validation over the fitted records (Stone 1974): base and structures are refitted to the other
//! records and weighed by them, then the omitted record is replayed. The list of structures and the noise law come from
//! all records.

use identify::hull::HullEstimate;
use rayon::prelude::*;
use trial::Trial;

use crate::average::FittedAverage;
use crate::base::FittedBase;
use crate::comparison::RecordComparison;
use crate::fit::{FittedRecords, StoppingRule, StructureFit};
use crate::fold_observer::FoldObserver;
use crate::full::FullModel;
use crate::hulls;
use crate::model::Structure;
use crate::noise_law::NoiseLaw;
use crate::structures::{Structures, WeighedStructure};

/// Maximum number of structures that are refitted.
const MAX_STRUCTURES: usize = 4;

/// Comparison on every record by the fold without it, `None` for a fold without a base or a finite replay; empty if
/// stopped.
pub fn leave_one_out(
    trials: &[Trial],
    problem: &FittedRecords,
    full: &FullModel,
    structures: &Structures,
    hulls: &[HullEstimate],
    observer: &dyn FoldObserver,
) -> Vec<Option<RecordComparison>> {
    observer.begin_folds(trials.len());
    let fold = |omitted: usize| -> Option<RecordComparison> {
        let base = FittedBase::fit(&without(trials, omitted)).ok()?;
        let kept = FittedRecords::new(
            without(&problem.records, omitted),
            base.estimate.response.inverse_T,
            problem.ship_length_time,
        );
        let law = NoiseLaw {
            row_variance: without(&full.noise_law.row_variance, omitted),
            likelihood_power: without(&full.noise_law.likelihood_power, omitted),
            ..full.noise_law.clone()
        };
        let whitening = kept.whitening(&law);
        let refitted = structures.weighed.iter().take(MAX_STRUCTURES).map(|member| {
            let (structure, theta) = without_record(&member.fit, omitted);
            kept.fit(&structure, theta, without(&member.fit.initial, omitted), &whitening, StoppingRule::FINE)
        });
        let fits: Vec<(f64, StructureFit)> =
            refitted.zip(&structures.weighed).map(|(fit, member)| (log_posterior(&fit, member), fit)).collect();
        let highest = fits.iter().map(|(log_posterior, _)| *log_posterior).fold(f64::NEG_INFINITY, f64::max);
        let total: f64 = fits.iter().map(|(log_posterior, _)| (log_posterior - highest).exp()).sum();
        let members: Vec<(f64, &StructureFit)> = fits
            .iter()
            .map(|(log_posterior, fit)| ((log_posterior - highest).exp() / total, fit))
            .filter(|(weight, _)| *weight > 0.02)
            .collect();
        let (hulls, time) = (hulls::refit_hulls(hulls, &without(trials, omitted)), problem.ship_length_time);
        let averaged = FittedAverage {
            members: &members,
            hulls: &hulls,
            noise_law: &law,
            fitted_record: None,
            ship_length_time: time,
        };
        averaged.compare(&trials[omitted], &base.estimate.response, true).ok()
    };
    let watched = |omitted: usize| {
        let comparison = (!observer.should_stop()).then(|| fold(omitted));
        observer.end_fold();
        comparison
    };
    let all: Option<Vec<_>> = (0..trials.len()).into_par_iter().map(watched).collect();
    all.unwrap_or_default()
}

/// Log evidence of a member fitted to the kept records, plus the log prior odds of its terms.
fn log_posterior(fit: &StructureFit, member: &WeighedStructure) -> f64 {
    fit.log_evidence + (member.log_posterior - member.fit.log_evidence)
}

fn without<T: Clone>(all: &[T], omitted: usize) -> Vec<T> {
    all[..omitted].iter().chain(&all[omitted + 1..]).cloned().collect()
}

/// Structure and parameters without one record and the terms that act only in it.
fn without_record(fit: &StructureFit, omitted: usize) -> (Structure, Vec<f64>) {
    let structure = &fit.structure;
    let mut theta = fit.theta[..3].to_vec();
    if structure.record_count > 2 {
        theta.extend(without(&fit.theta[3..structure.base_parameter_count()], omitted));
    }
    let mut terms = Vec::new();
    for (term, range) in structure.terms.iter().zip(structure.term_ranges()) {
        if term.record_index == Some(omitted) {
            continue;
        }
        theta.extend_from_slice(&fit.theta[range]);
        let mut kept = term.as_ref().clone();
        kept.record_index = kept.record_index.map(|index| if index > omitted { index - 1 } else { index });
        terms.push(kept.into());
    }
    (Structure { record_count: structure.record_count - 1, terms, ..*structure }, theta)
}
