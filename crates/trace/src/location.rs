//! Selection between named effects and shapes: an effect that is not required is named only if no shape explains the
//! records better in its place; the residual of the named effects is then searched for shapes.

use std::sync::Arc;

use crate::fit::{FittedRecords, StoppingRule, StructureFit};
use crate::full::FullModel;
use crate::model::{Term, TermName};
use crate::naming::{EffectNaming, named_effects};
use crate::rudder::RudderNoise;
use crate::settings::Settings;
use crate::shape::{self, MAX_EQUIVALENT_GAIN_NATS, MIN_GAIN_NATS, MomentSize, ShapeAnalysis};
use crate::structures::{Structures, chi_square_p_value};

/// Maximum p value (χ²) of a named effect.
const MAX_P_VALUE: f64 = 0.05;

/// Minimum ratio of the density of a white moment to the density of the rudder noise; below it the moment is the rudder
/// noise.
const MIN_DENSITY_RATIO: f64 = 4.0;

/// Named effects, displaced effects, and the shape analysis of the residual.
#[derive(Debug, Clone)]
pub struct Attribution {
    /// Named effects, required effects first.
    pub named_effects: Vec<EffectNaming>,
    /// Effects dropped because shapes or a random moment explain the records better in their place.
    pub displaced_effects: Vec<EffectNaming>,
    /// Shape analysis of the residual of the named effects; `None` if their covariance is singular.
    pub shapes: Option<ShapeAnalysis>,
}

impl Attribution {
    /// Random moment in addition to named effects and shapes; `None` without one, or if the rudder noise explains it.
    pub fn unexplained_random_moment(&self, errors: &[Option<RudderNoise>]) -> Option<MomentSize> {
        let moment = self.shapes.as_ref()?.random_moment?;
        let instrument = errors.iter().flatten().map(|error| error.intensity).fold(0.0, f64::max);
        let is_of_rudder = moment.white_density.is_some_and(|density| density < MIN_DENSITY_RATIO * instrument);
        (!is_of_rudder).then_some(moment)
    }

    /// `true` if the gain of the shapes is significant.
    pub fn has_significant_shapes(&self) -> bool {
        self.shapes.as_ref().is_some_and(ShapeAnalysis::has_significant_shapes)
    }
}

/// Structures for the subsets of named effects.
struct NamedStructures<'a> {
    problem: &'a FittedRecords,
    full: &'a FullModel,
    structures: &'a Structures,
    candidates: &'a [Arc<Term>],
}

/// Named effects, displaced effects and shapes: of the probable effects, those that shapes or a random moment replace
/// with a better criterion are dropped. Required effects stay.
pub fn attribute(
    problem: &FittedRecords,
    full: &FullModel,
    structures: &Structures,
    candidates: &[Arc<Term>],
    settings: &Settings,
) -> Attribution {
    let named_structures = NamedStructures { problem, full, structures, candidates };
    let is_asked = |effect: &EffectNaming| settings.selection.requires(effect.term.0);
    let mut probable = named_effects(structures, settings.min_probability, &settings.selection);
    probable.retain(|effect| is_asked(effect) || named_structures.is_supported(effect));
    let (asked, open): (Vec<EffectNaming>, Vec<EffectNaming>) = probable.into_iter().partition(is_asked);
    let all = named_structures.shapes(&[asked.as_slice(), &open].concat());
    if open.is_empty() {
        return Attribution { named_effects: asked, displaced_effects: open, shapes: all };
    }
    // Several effects together can imitate one shape, so the shapes without these effects are compared first.
    let none = named_structures.shapes(&asked);
    if is_better(&none, &all) {
        return named_structures.with_names(Attribution {
            named_effects: asked,
            displaced_effects: open,
            shapes: none,
        });
    }
    let mut current =
        Attribution { named_effects: [asked.as_slice(), &open].concat(), displaced_effects: Vec::new(), shapes: all };
    while let Some(next) = named_structures.without_name(&current, &none, is_asked) {
        current = next;
    }
    // Named effects with shapes must also explain more than a random moment without either.
    let [random, power] =
        none.as_ref().map_or([f64::INFINITY, 1.0], |shapes| [shapes.random_criterion, shapes.likelihood_power]);
    if current.has_significant_shapes() && power * (random - criterion(&current.shapes)) < 2.0 * MIN_GAIN_NATS {
        return Attribution { named_effects: asked, displaced_effects: open, shapes: none };
    }
    current
}

/// `true` if the residual without an effect is explained better than with it: by shapes with a gain above
/// [`MAX_EQUIVALENT_GAIN_NATS`], by a random law with any gain.
fn is_better(without: &Option<ShapeAnalysis>, with: &Option<ShapeAnalysis>) -> bool {
    let is_shape = without.as_ref().is_some_and(ShapeAnalysis::has_significant_shapes);
    let power = without.as_ref().map_or(1.0, |shapes| shapes.likelihood_power);
    power * (criterion(with) - criterion(without)) > if is_shape { 2.0 * MAX_EQUIVALENT_GAIN_NATS } else { 0.0 }
}

/// Criterion −2 log p + penalties of the best explanation by shapes; infinite without a shape analysis.
fn criterion(shapes: &Option<ShapeAnalysis>) -> f64 {
    shapes.as_ref().map_or(f64::INFINITY, |shapes| shapes.best_explanation.criterion)
}

impl NamedStructures<'_> {
    /// Adds dropped effects again as long as they improve the criterion in addition to the shapes.
    fn with_names(&self, mut current: Attribution) -> Attribution {
        loop {
            let with = (0..current.displaced_effects.len()).map(|place| {
                let named = [current.named_effects.as_slice(), &current.displaced_effects[place..=place]].concat();
                (place, self.shapes(&named))
            });
            let lowest = with.min_by(|(_, a), (_, b)| criterion(a).total_cmp(&criterion(b)));
            match lowest.filter(|(_, with)| criterion(with) < criterion(&current.shapes)) {
                Some((place, shapes)) => {
                    let effect = current.displaced_effects.remove(place);
                    current.named_effects.push(effect);
                    current.shapes = shapes;
                }
                None => return current,
            }
        }
    }

    /// Attribution without the effect that shapes replace best; `None` if they replace none. `none` is the shape
    /// analysis without any of the open effects.
    fn without_name(
        &self,
        current: &Attribution,
        none: &Option<ShapeAnalysis>,
        is_asked: impl Fn(&EffectNaming) -> bool,
    ) -> Option<Attribution> {
        let open: Vec<usize> =
            (0..current.named_effects.len()).filter(|&place| !is_asked(&current.named_effects[place])).collect();
        let without = open.iter().map(|&place| {
            let mut named = current.named_effects.clone();
            let effect = named.remove(place);
            let shapes = if open.len() == 1 { none.clone() } else { self.shapes(&named) };
            Attribution {
                named_effects: named,
                displaced_effects: [current.displaced_effects.as_slice(), &[effect]].concat(),
                shapes,
            }
        });
        let lowest = without.min_by(|a, b| criterion(&a.shapes).total_cmp(&criterion(&b.shapes)));
        lowest.filter(|next| is_better(&next.shapes, &current.shapes))
    }

    /// `true` if an effect improves the evidence (not required of a group) with coefficients significant at
    /// [`MAX_P_VALUE`].
    fn is_supported(&self, effect: &EffectNaming) -> bool {
        let (id, _, record) = effect.term;
        let is_gain = self.structures.effect_evidence(id, record).log_ratio > 0.0 || !effect.aliases.is_empty();
        is_gain && self.p_value(effect.term).is_none_or(|p_value| p_value < MAX_P_VALUE)
    }

    /// p value (χ²) of the coefficients of a term in the most probable structure that has it; `None` without such a
    /// structure, without a fitted coefficient, or if the covariance is singular.
    fn p_value(&self, name: TermName) -> Option<f64> {
        let with = |fit: &StructureFit| fit.structure.terms.iter().position(|term| term.name() == name);
        let (fit, place) =
            self.structures.weighed.iter().find_map(|weighed| Some((&weighed.fit, with(&weighed.fit)?)))?;
        let (term, range) = (&fit.structure.terms[place], fit.structure.term_ranges()[place].clone());
        let sizes: Vec<(usize, f64)> = (range.zip(&term.priors).zip(term.neutral()))
            .filter(|((_, prior), _)| prior.is_fitted() && !prior.is_shape)
            .map(|((place, _), neutral)| (place, fit.theta[place] - neutral))
            .collect();
        chi_square_p_value(&sizes, &fit.covariance()?)
    }

    /// Shape analysis of the residual of the named effects.
    fn shapes(&self, named: &[EffectNaming]) -> Option<ShapeAnalysis> {
        let names: Vec<TermName> = named.iter().map(|effect| effect.term).collect();
        shape::analyse_shapes(self.problem, &self.fit(&names)?, &self.full.noise_law)
    }

    /// Fit of the structure with these terms: weighed before, or a new fit from their values in other structures.
    /// `None` if a term is no candidate.
    fn fit(&self, names: &[TermName]) -> Option<StructureFit> {
        let weighed = || self.structures.weighed.iter().map(|weighed| &weighed.fit);
        let is_same = |fit: &&StructureFit| {
            let terms = &fit.structure.terms;
            terms.len() == names.len() && terms.iter().all(|term| names.contains(&term.name()))
        };
        if let Some(fit) = weighed().find(is_same) {
            return Some(fit.clone());
        }
        let best = weighed().next()?;
        let (mut terms, mut theta) = (Vec::new(), best.theta[..best.structure.base_parameter_count()].to_vec());
        let fits = || weighed().chain([&self.full.fit]);
        // In the order in which the rudder passes through them.
        let mut candidates: Vec<&Arc<Term>> = Vec::new();
        for term in self.full.fit.structure.terms.iter().chain(self.candidates) {
            if names.contains(&term.name()) && candidates.iter().all(|other| other.name() != term.name()) {
                candidates.push(term);
            }
        }
        for term in candidates {
            let place = |fit: &StructureFit| fit.structure.terms.iter().position(|other| other.name() == term.name());
            let values =
                fits().find_map(|fit| Some(fit.theta[fit.structure.term_ranges()[place(fit)?].clone()].to_vec()));
            theta.extend(values.unwrap_or_else(|| term.priors.iter().map(|prior| prior.mean).collect()));
            terms.push(Arc::clone(term));
        }
        if terms.len() != names.len() {
            return None;
        }
        let whitening = self.problem.whitening(&self.full.noise_law);
        let structure = best.structure.with_terms(terms);
        Some(self.problem.fit(&structure, theta, best.initial.clone(), &whitening, StoppingRule::FINE))
    }
}
