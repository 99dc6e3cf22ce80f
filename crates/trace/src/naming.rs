//! Named effects: effects above the probability threshold, and groups whose joint probability is above it.

use crate::model::TermName;
use crate::selection::Selection;
use crate::structures::Structures;

/// Minimum probability of a member of a group and of an alternative form; also the minimum increase of the probability
/// of a group by a further member.
const MIN_PROBABILITY: f64 = 0.05;

/// Maximum number of effects in a group.
const MAX_GROUP_SIZE: usize = 3;

/// Maximum of 1 − probability for a group, relative to that for a single effect: a group is more often right by chance.
const GROUP_DOUBT_RATIO: f64 = 0.6;

/// Named effect, or group of effects that the records cannot separate, with its probability.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectNaming {
    /// Most probable form of the effect.
    pub term: TermName,
    /// Other effects of the group, each in its most probable form.
    pub aliases: Vec<TermName>,
    /// Other probable forms of the effect.
    pub forms: Vec<TermName>,
    /// Probability that the effect, or at least one of the group, is present.
    pub probability: f64,
}

impl EffectNaming {
    /// `true` if a term is a form of the effect or of one of the group.
    pub fn includes(&self, name: &TermName) -> bool {
        let mut group = self.aliases.iter().chain([&self.term]);
        group.any(|member| (member.0, member.2) == (name.0, name.2))
    }
}

/// Identifier of an effect with the index of its record; `None` for all records.
type EffectKey = (&'static str, Option<usize>);

/// Named effects: single effects that are above the threshold or required, the most probable first, then groups.
pub fn named_effects(structures: &Structures, threshold: f64, selection: &Selection) -> Vec<EffectNaming> {
    let mut keys: Vec<(EffectKey, f64)> = Vec::new();
    for name in structures.probabilities.keys() {
        let key = (name.0, name.2);
        if keys.iter().all(|(other, _)| *other != key) {
            keys.push((key, structures.effect_probability(key.0, key.1)));
        }
    }
    keys.sort_by(|(a, p), (b, q)| q.total_cmp(p).then(a.cmp(b)));
    let is_named = |(key, p): &(EffectKey, f64)| *p >= threshold || selection.requires(key.0) && *p > 0.0;
    let (certain, open): (Vec<_>, Vec<_>) = keys.into_iter().partition(is_named);
    let mut all: Vec<EffectNaming> = certain.iter().map(|(key, p)| named_effect(structures, *key, *p)).collect();
    let mut open: Vec<EffectKey> =
        open.into_iter().filter(|(_, p)| *p >= MIN_PROBABILITY).map(|(key, _)| key).collect();
    while let Some((group, probability)) = group(structures, &open, threshold) {
        open.retain(|key| !group.contains(key));
        let mut named = named_effect(structures, group[0], probability);
        named.aliases = group[1..].iter().map(|key| named_effect(structures, *key, 0.0).term).collect();
        all.push(named);
    }
    all
}

/// Naming of an effect: its most probable form, the other forms of at least [`MIN_PROBABILITY`], and no aliases.
fn named_effect(structures: &Structures, (id, record): EffectKey, probability: f64) -> EffectNaming {
    let is_form = |name: &&TermName| name.0 == id && name.2 == record;
    let mut forms: Vec<(TermName, f64)> =
        structures.probabilities.keys().filter(is_form).map(|name| (*name, structures.probabilities[name])).collect();
    forms.sort_by(|(a, p), (b, q)| q.total_cmp(p).then(a.cmp(b)));
    let alternatives = forms[1..].iter().filter(|(_, p)| *p >= MIN_PROBABILITY).map(|(name, _)| *name).collect();
    EffectNaming { term: forms[0].0, aliases: Vec::new(), forms: alternatives, probability }
}

/// Group of effects whose joint probability suffices, by forward selection from the most probable effect; `None` if no
/// group of at most [`MAX_GROUP_SIZE`] effects is found.
fn group(structures: &Structures, open: &[EffectKey], threshold: f64) -> Option<(Vec<EffectKey>, f64)> {
    let union = |group: &[EffectKey]| structures.inclusion_probability(|name| group.contains(&(name.0, name.2)));
    let mut group = vec![*open.first()?];
    while group.len() < MAX_GROUP_SIZE {
        let before = union(&group);
        let with = |key: &EffectKey| union(&[group.as_slice(), &[*key]].concat());
        let outside = open.iter().filter(|key| !group.contains(key));
        let next = outside.max_by(|a, b| with(a).total_cmp(&with(b)))?;
        let probability = with(next);
        if probability - before < MIN_PROBABILITY {
            return None;
        }
        group.push(*next);
        if 1.0 - probability <= GROUP_DOUBT_RATIO * (1.0 - threshold) {
            return Some((group, probability));
        }
    }
    None
}
