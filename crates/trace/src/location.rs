//! Names held against shapes: an effect of the list is named only where no shape explains the records better in its
//! place, and what is left beside the names is looked at for shapes.

use std::sync::Arc;

use crate::fit::{Effort, FittedRecords, StructureFit};
use crate::full::Full;
use crate::model::{Term, TermName};
use crate::naming::{EffectNaming, named};
use crate::rudder::RudderError;
use crate::settings::Settings;
use crate::shape::{self, ALIKE, BELIEVED, MomentSize, ShapeAnalysis};
use crate::structures::{Structures, by_chance};

/// Probability of a size as far from neutral by chance, above which an effect is not named.
const BY_CHANCE: f64 = 0.05;

/// A white moment of less than so many times the density of the errors of the rudder is these.
const OF_RUDDER: f64 = 4.0;

/// What is named, and what is left beside it.
#[derive(Debug, Clone)]
pub struct Location {
    /// Effects that stand, the most probable first.
    pub named: Vec<EffectNaming>,
    /// Effects in whose place shapes, or a random moment, explain the records better.
    pub displaced: Vec<EffectNaming>,
    /// What the named effects leave; `None` where their parameters cannot be told apart.
    pub shapes: Option<ShapeAnalysis>,
}

impl Location {
    /// The random moment beside the names and shapes; none where errors of the rudders are one as large.
    pub fn moment(&self, errors: &[Option<RudderError>]) -> Option<MomentSize> {
        let moment = self.shapes.as_ref()?.moment?;
        let instrument = errors.iter().flatten().map(|error| error.intensity).fold(0.0, f64::max);
        let is_of_rudder = moment.white.is_some_and(|density| density < OF_RUDDER * instrument);
        (!is_of_rudder).then_some(moment)
    }

    /// Whether shapes are believed.
    pub fn is_located(&self) -> bool {
        self.shapes.as_ref().is_some_and(ShapeAnalysis::is_located)
    }
}

/// What names are found among.
struct NamedStructures<'a> {
    problem: &'a FittedRecords,
    full: &'a Full,
    structures: &'a Structures,
    candidates: &'a [Arc<Term>],
}

/// Holds the probable effects against shapes.
pub fn locate(
    problem: &FittedRecords,
    full: &Full,
    structures: &Structures,
    candidates: &[Arc<Term>],
    settings: &Settings,
) -> Location {
    let among = NamedStructures { problem, full, structures, candidates };
    let is_asked = |effect: &EffectNaming| settings.selection.asks_for(effect.term.0);
    let mut probable = named(structures, settings.probability, &settings.selection);
    probable.retain(|effect| is_asked(effect) || among.is_supported(effect));
    let (asked, open): (Vec<EffectNaming>, Vec<EffectNaming>) = probable.into_iter().partition(is_asked);
    let all = among.shapes(&[asked.as_slice(), &open].concat());
    if open.is_empty() {
        return Location { named: asked, displaced: open, shapes: all };
    }
    // Several names may stand where none is there, each in the place of a part of a shape.
    let none = among.shapes(&asked);
    if is_better(&none, &all) {
        return among.with_names(Location { named: asked, displaced: open, shapes: none });
    }
    let mut stand = Location { named: [asked.as_slice(), &open].concat(), displaced: Vec::new(), shapes: all };
    while let Some(next) = among.without_name(&stand, &none, is_asked) {
        stand = next;
    }
    // Shapes beside names that a random moment replaces are held against that moment as well.
    let [alone, power] = none.as_ref().map_or([f64::INFINITY, 1.0], |own| [own.alone, own.power]);
    if stand.is_located() && power * (alone - height(&stand.shapes)) < 2.0 * BELIEVED {
        return Location { named: asked, displaced: open, shapes: none };
    }
    stand
}

/// Whether what is left without a name is explained better than what is left with it: shapes by more than both are
/// alike, a random law by anything.
fn is_better(without: &Option<ShapeAnalysis>, with: &Option<ShapeAnalysis>) -> bool {
    let is_shape = without.as_ref().is_some_and(ShapeAnalysis::is_located);
    let power = without.as_ref().map_or(1.0, |own| own.power);
    power * (height(with) - height(without)) > if is_shape { 2.0 * ALIKE } else { 0.0 }
}

/// −2 log p of the best explanation.
fn height(shapes: &Option<ShapeAnalysis>) -> f64 {
    shapes.as_ref().map_or(f64::INFINITY, |own| own.best.height)
}

impl NamedStructures<'_> {
    /// Names again what explains the records better beside shapes than these do alone.
    fn with_names(&self, mut stand: Location) -> Location {
        loop {
            let with = (0..stand.displaced.len()).map(|place| {
                let named = [stand.named.as_slice(), &stand.displaced[place..=place]].concat();
                (place, self.shapes(&named))
            });
            let lowest = with.min_by(|(_, one), (_, other)| height(one).total_cmp(&height(other)));
            match lowest.filter(|(_, with)| height(with) < height(&stand.shapes)) {
                Some((place, shapes)) => {
                    let effect = stand.displaced.remove(place);
                    stand.named.push(effect);
                    stand.shapes = shapes;
                }
                None => return stand,
            }
        }
    }

    /// The location without the name that shapes explain best in its place; `None` where they explain none better. What
    /// is left where `none` of the names stands is known.
    fn without_name(
        &self,
        stand: &Location,
        none: &Option<ShapeAnalysis>,
        is_asked: impl Fn(&EffectNaming) -> bool,
    ) -> Option<Location> {
        let open: Vec<usize> = (0..stand.named.len()).filter(|&place| !is_asked(&stand.named[place])).collect();
        let without = open.iter().map(|&place| {
            let mut named = stand.named.clone();
            let effect = named.remove(place);
            let shapes = if open.len() == 1 { none.clone() } else { self.shapes(&named) };
            Location { named, displaced: [stand.displaced.as_slice(), &[effect]].concat(), shapes }
        });
        let lowest = without.min_by(|one, other| height(&one.shapes).total_cmp(&height(&other.shapes)));
        lowest.filter(|next| is_better(&next.shapes, &stand.shapes))
    }

    /// What speaks for an effect beside its probability: the evidence, and a size that is none by chance.
    fn is_supported(&self, effect: &EffectNaming) -> bool {
        let (id, _, only) = effect.term;
        let is_gain = self.structures.support_of(id, only).gain > 0.0 || !effect.aliases.is_empty();
        is_gain && self.chance(effect.term).is_none_or(|chance| chance < BY_CHANCE)
    }

    /// Probability of sizes of a term as far from neutral by chance (χ²), in the most probable structure that has it.
    fn chance(&self, name: TermName) -> Option<f64> {
        let with = |fit: &StructureFit| fit.structure.terms.iter().position(|term| term.name() == name);
        let (fit, place) = self.structures.all.iter().find_map(|own| Some((&own.fit, with(&own.fit)?)))?;
        let (term, range) = (&fit.structure.terms[place], fit.structure.ranges()[place].clone());
        let sizes: Vec<(usize, f64)> = (range.zip(&term.priors).zip(term.neutral()))
            .filter(|((_, prior), _)| prior.is_fitted() && !prior.is_shape)
            .map(|((place, _), neutral)| (place, fit.theta[place] - neutral))
            .collect();
        by_chance(&sizes, &fit.covariance()?)
    }

    /// What some named effects leave.
    fn shapes(&self, named: &[EffectNaming]) -> Option<ShapeAnalysis> {
        let names: Vec<TermName> = named.iter().map(|effect| effect.term).collect();
        shape::analysis(self.problem, &self.fit(&names)?, &self.full.law)
    }

    /// The structure of some terms: as it was weighed, else fitted from where they stand in others. `None` where one is
    /// no candidate.
    fn fit(&self, names: &[TermName]) -> Option<StructureFit> {
        let known = || self.structures.all.iter().map(|own| &own.fit);
        let is_same = |fit: &&StructureFit| {
            let terms = &fit.structure.terms;
            terms.len() == names.len() && terms.iter().all(|term| names.contains(&term.name()))
        };
        if let Some(fit) = known().find(is_same) {
            return Some(fit.clone());
        }
        let near = known().next()?;
        let (mut terms, mut theta) = (Vec::new(), near.theta[..near.structure.base_count()].to_vec());
        let fits = || known().chain([&self.full.fit]);
        // In the order in which the rudder passes through them.
        let mut candidates: Vec<&Arc<Term>> = Vec::new();
        for term in self.full.fit.structure.terms.iter().chain(self.candidates) {
            if names.contains(&term.name()) && candidates.iter().all(|other| other.name() != term.name()) {
                candidates.push(term);
            }
        }
        for term in candidates {
            let place = |fit: &StructureFit| fit.structure.terms.iter().position(|own| own.name() == term.name());
            let values = fits().find_map(|fit| Some(fit.theta[fit.structure.ranges()[place(fit)?].clone()].to_vec()));
            theta.extend(values.unwrap_or_else(|| term.priors.iter().map(|prior| prior.mean).collect()));
            terms.push(Arc::clone(term));
        }
        if terms.len() != names.len() {
            return None;
        }
        let weights = self.problem.weights(&self.full.law);
        let structure = near.structure.of(terms);
        Some(self.problem.fit(&structure, theta, near.initial.clone(), &weights, Effort::FINE))
    }
}
