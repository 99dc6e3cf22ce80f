//! Which effects are named: those whose probability is high enough, and groups of which one is there.

use crate::model::TermName;
use crate::selection::Selection;
use crate::structures::Structures;

/// Probability below which an effect is no member of a group, and a form no alternative.
const SMALLEST: f64 = 0.05;

/// Most effects of a group.
const LARGEST_GROUP: usize = 3;

/// Share of the doubt about one effect that is left to a group: a group has more chances.
const GROUP: f64 = 0.6;

/// An effect that is named, or a group of which one is there.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectNaming {
    /// Its most probable form.
    pub term: TermName,
    /// The other effects of its group, each in its most probable form.
    pub aliases: Vec<TermName>,
    /// Other forms of it that are probable.
    pub forms: Vec<TermName>,
    /// Probability that it, or one of the group, is there.
    pub probability: f64,
}

impl EffectNaming {
    /// Whether a term is a form of it, or of one of its group.
    pub fn includes(&self, name: &TermName) -> bool {
        let mut group = self.aliases.iter().chain([&self.term]);
        group.any(|member| (member.0, member.2) == (name.0, name.2))
    }
}

/// An effect with the one record in which it acts.
type EffectKey = (&'static str, Option<usize>);

/// The effects that are named, the most probable first; those that were asked for are.
pub fn named(structures: &Structures, threshold: f64, selection: &Selection) -> Vec<EffectNaming> {
    let mut keys: Vec<(EffectKey, f64)> = Vec::new();
    for name in structures.probabilities.keys() {
        let key = (name.0, name.2);
        if keys.iter().all(|(other, _)| *other != key) {
            keys.push((key, structures.of_effect(key.0, key.1)));
        }
    }
    keys.sort_by(|(one, p), (other, q)| q.total_cmp(p).then(one.cmp(other)));
    let is_named = |(key, p): &(EffectKey, f64)| *p >= threshold || selection.asks_for(key.0) && *p > 0.0;
    let (certain, open): (Vec<_>, Vec<_>) = keys.into_iter().partition(is_named);
    let mut all: Vec<EffectNaming> =
        certain.iter().map(|(key, p)| EffectNaming { aliases: Vec::new(), ..one(structures, *key, *p) }).collect();
    let mut open: Vec<EffectKey> = open.into_iter().filter(|(_, p)| *p >= SMALLEST).map(|(key, _)| key).collect();
    while let Some((group, probability)) = group(structures, &open, threshold) {
        open.retain(|key| !group.contains(key));
        let mut named = one(structures, group[0], probability);
        named.aliases = group[1..].iter().map(|key| one(structures, *key, 0.0).term).collect();
        all.push(named);
    }
    all
}

/// An effect in its most probable form.
fn one(structures: &Structures, (id, only): EffectKey, probability: f64) -> EffectNaming {
    let of = |name: &&TermName| name.0 == id && name.2 == only;
    let mut forms: Vec<(TermName, f64)> =
        structures.probabilities.keys().filter(of).map(|name| (*name, structures.probabilities[name])).collect();
    forms.sort_by(|(one, p), (other, q)| q.total_cmp(p).then(one.cmp(other)));
    let others = forms[1..].iter().filter(|(_, p)| *p >= SMALLEST).map(|(name, _)| *name).collect();
    EffectNaming { term: forms[0].0, aliases: Vec::new(), forms: others, probability }
}

/// The smallest group of effects of which one is there, the most probable of them first.
fn group(structures: &Structures, open: &[EffectKey], threshold: f64) -> Option<(Vec<EffectKey>, f64)> {
    let union = |group: &[EffectKey]| structures.of_any(|name| group.contains(&(name.0, name.2)));
    let mut group = vec![*open.first()?];
    while group.len() < LARGEST_GROUP {
        let own = union(&group);
        let with = |key: &EffectKey| union(&[group.as_slice(), &[*key]].concat());
        let others = open.iter().filter(|key| !group.contains(key));
        let next = others.max_by(|one, other| with(one).total_cmp(&with(other)))?;
        let probability = with(next);
        if probability - own < SMALLEST {
            return None;
        }
        group.push(*next);
        if 1.0 - probability <= GROUP * (1.0 - threshold) {
            return Some((group, probability));
        }
    }
    None
}
