//! Every one of several records as if it had been held out: base and structures are fitted to the others, weighed by
//! them, and the one left out is replayed. Which structures are in the running, and the noise, are those of all.

use identify::hull::HullEstimate;
use rayon::prelude::*;
use trial::Trial;

use crate::average::AveragedModel;
use crate::base::Base;
use crate::comparison::RecordComparison;
use crate::fit::{Effort, FittedRecords, StructureFit};
use crate::full::Full;
use crate::hulls;
use crate::model::Structure;
use crate::structures::{Structures, WeighedStructure};
use crate::watcher::Watcher;
use crate::weights::NoiseLaw;

/// Structures that take part.
const MOST: usize = 4;

/// Comparisons on every record that its fold has not seen; none at all where it was asked to stop.
pub fn leave_one_out(
    trials: &[Trial],
    problem: &FittedRecords,
    full: &Full,
    structures: &Structures,
    hulls: &[HullEstimate],
    watcher: &dyn Watcher,
) -> Vec<Option<RecordComparison>> {
    watcher.begin_folds(trials.len());
    let fold = |left: usize| -> Option<RecordComparison> {
        let base = Base::of(&without(trials, left)).ok()?;
        let others =
            FittedRecords::new(without(&problem.records, left), base.estimate.response.inverse_T, problem.time);
        let law = NoiseLaw {
            variance: without(&full.law.variance, left),
            power: without(&full.law.power, left),
            ..full.law.clone()
        };
        let weights = others.weights(&law);
        let refitted = structures.all.iter().take(MOST).map(|member| {
            let (structure, theta) = on_others(&member.fit, left);
            others.fit(&structure, theta, without(&member.fit.initial, left), &weights, Effort::FINE)
        });
        let fits: Vec<(f64, StructureFit)> =
            refitted.zip(&structures.all).map(|(fit, member)| (height(&fit, member), fit)).collect();
        let highest = fits.iter().map(|(height, _)| *height).fold(f64::NEG_INFINITY, f64::max);
        let total: f64 = fits.iter().map(|(height, _)| (height - highest).exp()).sum();
        let members: Vec<(f64, &StructureFit)> = fits
            .iter()
            .map(|(height, fit)| ((height - highest).exp() / total, fit))
            .filter(|(weight, _)| *weight > 0.02)
            .collect();
        let hulls = hulls::refitted(hulls, &without(trials, left));
        let unseen = AveragedModel { members: &members, hulls: &hulls, law: &law, known: None, time: problem.time };
        unseen.compared(&trials[left], &base.estimate.response, true).ok()
    };
    let watched = |left: usize| {
        let found = (!watcher.is_asked_to_stop()).then(|| fold(left));
        watcher.end_fold();
        found
    };
    let all: Option<Vec<_>> = (0..trials.len()).into_par_iter().map(watched).collect();
    all.unwrap_or_default()
}

/// Log of evidence and prior odds on the others.
fn height(fit: &StructureFit, member: &WeighedStructure) -> f64 {
    fit.evidence + (member.height - member.fit.evidence)
}

fn without<T: Clone>(all: &[T], left: usize) -> Vec<T> {
    all[..left].iter().chain(&all[left + 1..]).cloned().collect()
}

/// A structure with its parameters on all records but one, without what belongs to that one alone.
fn on_others(fit: &StructureFit, left: usize) -> (Structure, Vec<f64>) {
    let structure = &fit.structure;
    let mut theta = fit.theta[..3].to_vec();
    if structure.records > 2 {
        theta.extend(without(&fit.theta[3..structure.base_count()], left));
    }
    let mut terms = Vec::new();
    for (term, range) in structure.terms.iter().zip(structure.ranges()) {
        if term.only == Some(left) {
            continue;
        }
        theta.extend_from_slice(&fit.theta[range]);
        let mut kept = term.as_ref().clone();
        kept.only = kept.only.map(|own| if own > left { own - 1 } else { own });
        terms.push(kept.into());
    }
    (Structure { records: structure.records - 1, terms, ..*structure }, theta)
}
