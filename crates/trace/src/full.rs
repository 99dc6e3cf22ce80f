//! Full model: base and all candidates fitted jointly, and the noise law of the residual.

use std::sync::Arc;

use rayon::prelude::*;
use ship::FirstOrder;

use crate::base::FittedBase;
use crate::candidates::is_alternative;
use crate::fit::{FittedRecords, StoppingRule, StructureFit};
use crate::law::{self, EstimatedNoiseLaw};
use crate::model::{Structure, Term};
use crate::noise::CorrelatedNoise;
use crate::noise_law::{NoiseLaw, RecordWhitening};
use crate::transient;

/// Noise standard deviation of the first fit over the root mean square residual of the base.
const FIRST_NOISE_RATIO: f64 = 0.1;

/// Full model: base and all candidate effects fitted jointly, with the noise law of the residual.
#[derive(Debug, Clone)]
pub struct FullModel {
    /// Fit of base and candidates.
    pub fit: StructureFit,
    /// Noise law of the residual.
    pub noise_law: NoiseLaw,
    /// Decrease of the criterion −2 log p + penalty by waves in the noise law; 0 without waves.
    pub waves_gain: f64,
}

/// Full models under every plausible noise law of the given `kinds`.
///
/// Up to four laws are estimated. Law 1 describes the residual of the candidates without an instant, and law 2 that of
/// all candidates. Law 3 describes the latter by heading errors alone; it is added if law 1 or 2 is a random moment.
/// Law 4 describes the residual of the base alone, and its model has no candidates. Laws 1 and 4 are left out if they
/// are like another law.
pub fn fit_full_models(
    problem: &FittedRecords,
    base: &FittedBase,
    candidates: &[Arc<Term>],
    with_waves: bool,
    kinds: &[CorrelatedNoise],
) -> Vec<FullModel> {
    let kept = candidates.iter().filter(|term| !is_alternative(term.effect.as_ref()));
    let (transient, stationary): (Vec<&Arc<Term>>, Vec<&Arc<Term>>) = kept.partition(|term| term.effect.has_instant());
    let base_structure = Structure::base(problem.records.len(), problem.ship_length_time);
    let structure = base_structure.with_terms(stationary.into_iter().cloned().collect());
    let first = NoiseLaw::white(problem.records.len(), (FIRST_NOISE_RATIO * FIRST_NOISE_RATIO) * base.mean_square());
    let fit = fit_stationary(problem, base, &structure, &problem.whitening(&first));
    let estimate_law = |fit: &StructureFit, from: &NoiseLaw, kinds: &[CorrelatedNoise]| {
        law::estimate_noise_law(problem, fit, &from.row_variance, with_waves, kinds)
    };
    let stationary = estimate_law(&fit, &first, kinds);

    // Moments with an instant start where they reduce the misfit most in addition to all other terms.
    let (mut theta, mut terms) = (fit.theta.clone(), structure.terms.clone());
    let whitening = problem.whitening(&stationary.noise_law);
    let moments: Vec<&Term> = transient.iter().map(|term| term.as_ref()).collect();
    for (candidate, place) in transient.iter().zip(transient::start_values(problem, &fit, &whitening, &moments)) {
        if let Some(place) = place {
            theta.extend(place);
            terms.push(Arc::clone(candidate));
        }
    }
    let structure = base_structure.with_terms(terms);
    let refit = |law: &NoiseLaw| {
        problem.fit(&structure, theta.clone(), fit.initial.clone(), &problem.whitening(law), StoppingRule::COARSE)
    };
    let stationary_law = stationary.noise_law.clone();
    let whole = refit(&stationary_law);
    let mut laws = vec![estimate_law(&whole, &stationary_law, kinds)];
    let of_heading: Vec<CorrelatedNoise> = kinds.iter().copied().filter(|kind| kind.is_heading_error()).collect();
    if !laws[0].noise_law.is_alike(&stationary_law) {
        laws.push(stationary);
    }
    if laws.iter().any(|chosen| chosen.noise_law.is_random_moment()) {
        laws.push(estimate_law(&whole, &laws[0].noise_law, &of_heading));
    }
    let fitted = |law: &NoiseLaw| if law.is_alike(&stationary_law) { whole.clone() } else { refit(law) };
    let mut fulls: Vec<FullModel> = laws
        .into_par_iter()
        .map(|EstimatedNoiseLaw { noise_law: law, waves_gain, .. }| FullModel {
            fit: fitted(&law),
            noise_law: law,
            waves_gain,
        })
        .collect();
    let base_only = base_only(problem, base, with_waves, kinds);
    if fulls.iter().all(|full| !full.noise_law.is_alike(&base_only.noise_law)) {
        fulls.push(base_only);
    }
    fulls
}

/// Base without candidates and the noise law of its residual, as if all misfit were noise.
fn base_only(problem: &FittedRecords, base: &FittedBase, with_waves: bool, kinds: &[CorrelatedNoise]) -> FullModel {
    let structure = Structure::base(problem.records.len(), problem.ship_length_time);
    let law = NoiseLaw::white(problem.records.len(), base.mean_square());
    let theta = start_point(&structure, &base.estimate.response, std::iter::empty());
    let refit = |theta: Vec<f64>, initial: Vec<[f64; 2]>, law: &NoiseLaw| {
        problem.fit(&structure, theta, initial, &problem.whitening(law), StoppingRule::FINE)
    };
    let fit = refit(theta, base.initial(), &law);
    let EstimatedNoiseLaw { noise_law: law, waves_gain, .. } =
        law::estimate_noise_law(problem, &fit, &law.row_variance, with_waves, kinds);
    FullModel { fit: refit(fit.theta, fit.initial, &law), noise_law: law, waves_gain }
}

/// Fit of base and candidates without an instant: the better fit from two starts, prior means and neutral values.
fn fit_stationary(
    problem: &FittedRecords,
    base: &FittedBase,
    structure: &Structure,
    whitening: &RecordWhitening,
) -> StructureFit {
    let starts: [fn(&Term) -> Vec<f64>; 2] =
        [|term| term.priors.iter().map(|prior| prior.mean).collect(), Term::neutral];
    let fits = starts.par_iter().map(|values| {
        let theta =
            start_point(structure, &base.estimate.response, structure.terms.iter().flat_map(|term| values(term)));
        problem.fit(structure, theta, base.initial(), whitening, StoppingRule { max_steps: 4, ..StoppingRule::COARSE })
    });
    let objective = |fit: &StructureFit| fit.misfit + fit.prior_penalty;
    let fits: Vec<StructureFit> = fits.collect();
    fits.into_iter().min_by(|a, b| objective(a).total_cmp(&objective(b))).expect("two starts")
}

/// Start point θ: parameters of the base, zero deviations of the rudder bias, then the values of the terms.
pub fn start_point(structure: &Structure, response: &FirstOrder, of_terms: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut theta = vec![response.inverse_T, response.K_over_T, response.rudder_bias];
    theta.resize(structure.base_parameter_count(), 0.0);
    theta.extend(of_terms);
    theta
}
