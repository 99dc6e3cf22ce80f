//! The full model: base and every candidate together, fitted at once, and the noise that it leaves.

use std::sync::Arc;

use rayon::prelude::*;
use ship::FirstOrder;

use crate::base::Base;
use crate::candidates::is_variant;
use crate::fit::{Effort, FittedRecords, StructureFit};
use crate::law::{self, ChosenLaw};
use crate::model::{Structure, Term};
use crate::noise::CorrelatedNoise;
use crate::transient;
use crate::weights::{NoiseLaw, Weights};

/// Standard deviation of the noise of the first fit, as a share of what the base leaves.
const FIRST: f64 = 0.1;

/// The full model of some records.
#[derive(Debug, Clone)]
pub struct Full {
    /// The fit; its terms are the candidates of the same place.
    pub fit: StructureFit,
    /// The noise.
    pub law: NoiseLaw,
    /// How much better waves explain what is left, in −2 log of the likelihood with the price of their parameters.
    pub waves_gain: f64,
}

/// Fits the full model, once for every noise that may be the right one: that of all which stands still in time, that
/// beside moments that come at an instant, where one of these is a random moment that of an error of the heading, and
/// that of a base to which nothing is added. The noise is one of some `kinds`.
pub fn fit(
    problem: &FittedRecords,
    base: &Base,
    candidates: &[Arc<Term>],
    with_waves: bool,
    kinds: &[CorrelatedNoise],
) -> Vec<Full> {
    let (late, known): (Vec<&Arc<Term>>, Vec<&Arc<Term>>) =
        candidates.iter().filter(|one| !is_variant(one.effect.as_ref())).partition(|one| one.effect.has_instant());
    let own = Structure::base(problem.records.len(), problem.time);
    let structure = own.of(known.into_iter().cloned().collect());
    let first = NoiseLaw::white(problem.records.len(), (FIRST * FIRST) * base.mean_square());
    let fit = physics(problem, base, &structure, &problem.weights(&first));
    let ask = |fit: &StructureFit, from: &NoiseLaw, kinds: &[CorrelatedNoise]| {
        law::of(problem, fit, &from.variance, with_waves, kinds)
    };
    let lasting = ask(&fit, &first, kinds);

    // Moments that come at an instant enter where they explain most beside everything else.
    let (mut theta, mut terms) = (fit.theta.clone(), structure.terms.clone());
    let weights = problem.weights(&lasting.law);
    let moments: Vec<&Term> = late.iter().map(|one| one.as_ref()).collect();
    for (candidate, place) in late.iter().zip(transient::places(problem, &fit, &weights, &moments)) {
        if let Some(place) = place {
            theta.extend(place);
            terms.push(Arc::clone(candidate));
        }
    }
    let structure = own.of(terms);
    let of = |law: &NoiseLaw| {
        problem.fit(&structure, theta.clone(), fit.initial.clone(), &problem.weights(law), Effort::COARSE)
    };
    let known_law = lasting.law.clone();
    let whole = of(&known_law);
    let beside = ask(&whole, &lasting.law, kinds);
    let mut laws = vec![beside];
    let of_heading: Vec<CorrelatedNoise> = kinds.iter().copied().filter(|kind| kind.is_of_heading()).collect();
    if !laws[0].law.is_alike(&lasting.law) {
        laws.push(lasting);
    }
    if laws.iter().any(|found| found.law.is_random_moment()) {
        laws.push(ask(&whole, &laws[0].law, &of_heading));
    }
    let fitted = |law: &NoiseLaw| if law.is_alike(&known_law) { whole.clone() } else { of(law) };
    let mut fulls: Vec<Full> = laws
        .into_par_iter()
        .map(|ChosenLaw { law, waves_gain, .. }| Full { fit: fitted(&law), law, waves_gain })
        .collect();
    let nothing = nothing(problem, base, with_waves, kinds);
    if fulls.iter().all(|full| !full.law.is_alike(&nothing.law)) {
        fulls.push(nothing);
    }
    fulls
}

/// The base alone with the noise that it leaves: what the records are if nothing is missing but weather is there.
fn nothing(problem: &FittedRecords, base: &Base, with_waves: bool, kinds: &[CorrelatedNoise]) -> Full {
    let own = Structure::base(problem.records.len(), problem.time);
    let law = NoiseLaw::white(problem.records.len(), base.mean_square());
    let theta = start(&own, &base.estimate.response, std::iter::empty());
    let of = |theta: Vec<f64>, initial: Vec<[f64; 2]>, law: &NoiseLaw| {
        problem.fit(&own, theta, initial, &problem.weights(law), Effort::FINE)
    };
    let fit = of(theta, base.initial(), &law);
    let ChosenLaw { law, waves_gain, .. } = law::of(problem, &fit, &law.variance, with_waves, kinds);
    Full { fit: of(fit.theta, fit.initial, &law), law, waves_gain }
}

/// The full model without moments that come at an instant, from two starts.
fn physics(problem: &FittedRecords, base: &Base, structure: &Structure, weights: &Weights) -> StructureFit {
    let starts: [fn(&Term) -> Vec<f64>; 2] =
        [|term| term.priors.iter().map(|prior| prior.mean).collect(), Term::neutral];
    let fits = starts.par_iter().map(|values| {
        let theta = start(structure, &base.estimate.response, structure.terms.iter().flat_map(|term| values(term)));
        problem.fit(structure, theta, base.initial(), weights, Effort { steps: 4, ..Effort::COARSE })
    });
    let height = |fit: &StructureFit| fit.misfit + fit.penalty;
    let fits: Vec<StructureFit> = fits.collect();
    fits.into_iter().min_by(|one, other| height(one).total_cmp(&height(other))).expect("two starts")
}

/// θ of the base with the values of terms behind it.
pub fn start(structure: &Structure, response: &FirstOrder, of_terms: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut theta = vec![response.inverse_T, response.K_over_T, response.rudder_bias];
    theta.resize(structure.base_count(), 0.0);
    theta.extend(of_terms);
    theta
}
