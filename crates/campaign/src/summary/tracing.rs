//! What traces said, cell by cell: was everything named that was missing, and anything that was not.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::AddAssign;
use std::sync::LazyLock;

use ::trace::Verdict;
use serde::{Deserialize, Serialize};

use super::judgement::Judgement;
use crate::design::CellFacts;
use crate::rows::{NamedEffect, StudyRow, TraceAnswer};
use crate::scenario::{HULL, MissingPhysics};
use crate::statistics::{Statistic, share};

/// Margin in log evidence beyond which the right effect has to be named: below, a rival explains the trial nearly as
/// well.
pub const CLEAR: f64 = 10.0;

/// What traces said in one cell.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TraceSummary {
    /// Index of the cell.
    pub cell: usize,
    /// Index of the method that is the trace.
    pub method: usize,
    /// Identifiers of what was missing.
    pub missing: Vec<String>,
    /// Trials by what their answer is worth, in a study that states what is right to say.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub judged: BTreeMap<Judgement, u64>,
    /// Trials traced.
    pub trials: u64,
    /// Trials with every verdict.
    pub verdicts: [u64; Verdict::ALL.len()],
    /// How often every identifier was named.
    pub named: BTreeMap<String, u64>,
    /// How often every identifier was named for a missing effect that the trial could not tell from it.
    pub aliases: BTreeMap<String, u64>,
    /// Trials in which nothing was named.
    pub silent: u64,
    /// Trials in which every missing effect is in one of the groups named.
    pub complete: u64,
    /// Trials in which a group was named that holds no missing effect; of a hull, of which nobody knows what it lacks,
    /// one of nothing but weather that there is not.
    pub wrong: u64,
    /// Trials in which exactly what is missing was named: all of it and nothing else, or nothing where nothing is.
    pub exact: u64,
    /// Trials in which far more speaks for the one missing effect than for any other, and those of them in which it was
    /// named.
    pub clear: [u64; 2],
    /// Mean expected likelihood ratio.
    pub expected: Option<f64>,
    /// Mean share of the headings inside the band: of the trial, and of the validation manoeuvre.
    pub band: [Option<f64>; 2],
    /// Effects by the probability that was given to them; empty for a hull, of which nobody knows what it lacks.
    pub calibration: [CalibrationBin; CALIBRATION.len() - 1],
}

/// Ends of the bins of probability.
pub const CALIBRATION: [f64; 9] = [0.0, 0.01, 0.05, 0.2, 0.5, 0.8, 0.95, 0.99, 1.0];

/// Effects whose probabilities are in one bin.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct CalibrationBin {
    /// Effects on the list, one for every trial.
    pub effects: u64,
    /// Those of them that were there.
    pub present: u64,
    /// Sum of the probabilities.
    pub sum: f64,
}

impl AddAssign for CalibrationBin {
    fn add_assign(&mut self, other: Self) {
        self.effects += other.effects;
        self.present += other.present;
        self.sum += other.sum;
    }
}

static EFFECT_IDS: LazyLock<BTreeSet<&'static str>> =
    LazyLock::new(|| ship::effects::all().iter().map(|effect| effect.id()).collect());

static WEATHER_IDS: LazyLock<BTreeSet<&'static str>> = LazyLock::new(|| {
    ship::effects::all().iter().filter(|effect| effect.is_of_weather()).map(|effect| effect.id()).collect()
});

/// Identifiers of all effects, each once, sorted.
pub fn effect_ids() -> impl Iterator<Item = &'static str> {
    EFFECT_IDS.iter().copied()
}

impl TraceSummary {
    /// Share of trials in which all that is missing was named.
    pub fn complete_share(&self) -> Option<Statistic> {
        if self.missing.is_empty() { None } else { self.share_of(self.complete) }
    }

    /// Share of trials in which exactly what is missing was named; `None` for a hull.
    pub fn exact_share(&self) -> Option<Statistic> {
        self.share_of(self.exact)
    }

    /// Share of trials in which something was named that is not missing; for a hull an effect of weather.
    pub fn wrong_share(&self) -> Option<Statistic> {
        share(self.wrong, self.trials)
    }

    /// A share of the trials; `None` for a hull, of which nobody knows what it lacks.
    fn share_of(&self, count: u64) -> Option<Statistic> {
        if self.is_hull() { None } else { share(count, self.trials) }
    }

    /// Share of clear trials in which the right effect was named.
    pub fn clear_share(&self) -> Option<Statistic> {
        share(self.clear[1], self.clear[0])
    }

    /// Whether the ship is a hull: nobody knows what it lacks.
    pub fn is_hull(&self) -> bool {
        self.missing.iter().any(|id| id == HULL)
    }
}

/// Counts over the traces of one method in one cell.
#[derive(Debug, Clone)]
pub(super) struct TraceTally {
    summary: TraceSummary,
    physics: Option<MissingPhysics>,
    /// Means of the expected likelihood ratio, and of the coverage of the two bands.
    means: [RunningMean; 3],
}

/// Sum and number of the numbers that there are.
#[derive(Debug, Default, Clone, Copy)]
struct RunningMean(f64, u64);

impl RunningMean {
    /// The mean with one more.
    fn add(&mut self, value: Option<f64>) -> Option<f64> {
        *self = Self(self.0 + value.unwrap_or(0.0), self.1 + u64::from(value.is_some()));
        (self.1 > 0).then(|| self.0 / self.1 as f64)
    }
}

impl TraceTally {
    /// Before any trace, for the cell and the method of a row.
    pub(super) fn new(row: &StudyRow, facts: &CellFacts) -> Self {
        let (cell, method, missing) = (row.cell as usize, row.method, facts.missing.clone());
        let summary = TraceSummary { cell, method, missing, ..TraceSummary::default() };
        Self { summary, physics: facts.physics.clone(), means: Default::default() }
    }

    /// Takes note of an answer.
    pub(super) fn add(&mut self, answer: &TraceAnswer) {
        let Self { summary, physics, means: [expected, fitted, held_out] } = self;
        summary.trials += 1;
        let judgement = physics.as_ref().map(|physics| Judgement::of(answer, physics));
        judgement.into_iter().for_each(|judgement| *summary.judged.entry(judgement).or_default() += 1);
        let verdict = Verdict::ALL.iter().position(|verdict| *verdict == answer.verdict);
        verdict.into_iter().for_each(|place| summary.verdicts[place] += 1);
        summary.silent += u64::from(answer.named.is_empty());
        let ids: BTreeSet<&str> = answer.named.iter().map(|effect| &*effect.id).collect();
        ids.into_iter().for_each(|id| *summary.named.entry(id.to_owned()).or_default() += 1);
        let missing = &summary.missing;
        // Another formula of an effect is that effect.
        let accepted = match physics {
            Some(MissingPhysics::Listed { effects }) => effects,
            _ => missing,
        };
        let (right, wrong): (Vec<_>, Vec<_>) =
            answer.named.iter().partition(|effect| accepted.iter().any(|id| effect.holds(id)));
        let aliases = right.iter().filter(|effect| missing.iter().all(|id| **id != *effect.id));
        let aliases: BTreeSet<&str> = aliases.map(|effect| &*effect.id).collect();
        aliases.into_iter().for_each(|id| *summary.aliases.entry(id.to_owned()).or_default() += 1);
        let complete = match physics {
            Some(MissingPhysics::Listed { .. }) => !right.is_empty(),
            _ => missing.iter().all(|id| right.iter().any(|effect| effect.holds(id))),
        };
        let is_weather = |effect: &&NamedEffect| {
            let ids = std::iter::once(&effect.id).chain(&effect.aliases);
            ids.into_iter().all(|id| WEATHER_IDS.contains(&**id))
        };
        summary.wrong += u64::from(wrong.iter().any(|effect| !summary.is_hull() || is_weather(effect)));
        summary.complete += u64::from(complete && !missing.is_empty());
        summary.exact += u64::from(complete && wrong.is_empty());
        if answer.margin.is_some_and(|margin| margin > CLEAR) {
            summary.clear[0] += 1;
            summary.clear[1] += u64::from(complete);
        }
        let known = !summary.is_hull();
        for id in effect_ids().filter(|_| known) {
            let own = answer.probabilities.iter().find(|(other, _)| **other == *id);
            let sum = own.map_or(0.0, |(_, probability)| *probability);
            let bin = CALIBRATION[1..].partition_point(|end| *end <= sum).min(summary.calibration.len() - 1);
            let present = u64::from(summary.missing.iter().any(|missing| missing == id));
            summary.calibration[bin] += CalibrationBin { effects: 1, present, sum };
        }
        summary.expected = expected.add(answer.expected);
        summary.band = [fitted.add(answer.band_fitted), held_out.add(answer.band_held_out)];
    }

    /// The counts so far.
    pub(super) fn summary(&self) -> TraceSummary {
        self.summary.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The summary of traces that name effects, each with its aliases, where some are missing.
    fn summary(missing: &[&str], trials: &[&[&[&str]]]) -> TraceSummary {
        let missing: Vec<String> = missing.iter().map(|&id| id.to_owned()).collect();
        let mut tally = TraceTally::new(&StudyRow::default(), &CellFacts { missing, ..CellFacts::default() });
        let effect = |ids: &&[&str]| NamedEffect {
            id: ids[0].into(),
            aliases: ids[1..].iter().map(|&alias| alias.into()).collect(),
            ..NamedEffect::default()
        };
        for groups in trials {
            tally.add(&TraceAnswer {
                verdict: Verdict::Traced,
                named: groups.iter().map(effect).collect(),
                probabilities: vec![("wind_moment".into(), 0.97)],
                margin: Some(30.0),
                expected: Some(4.0),
                band_fitted: Some(0.9),
                ..TraceAnswer::default()
            });
        }
        tally.summary()
    }

    #[test]
    fn groups_are_right_when_they_hold_what_is_missing() {
        let trials: [&[&[&str]]; 5] =
            [&[&["a"], &["b"]], &[&["c", "a"], &["b"]], &[&["a"]], &[&["a"], &["b"], &["d"]], &[]];
        let summary = summary(&["a", "b"], &trials);
        assert_eq!((summary.trials, summary.complete, summary.wrong, summary.silent), (5, 3, 1, 1));
        assert_eq!((summary.exact, summary.clear), (2, [5, 3]));
        assert_eq!((summary.named["b"], summary.named["c"], summary.aliases.get("c")), (3, 1, Some(&1)));
        assert_eq!((summary.expected, summary.band), (Some(4.0), [Some(0.9), None]));
    }

    /// Of the effects on the list one is there and was given 97 %, the others are not and were given nothing.
    #[test]
    fn effects_are_counted_by_their_probability() {
        let summary = summary(&["wind_moment"], &[&[]]);
        let others = effect_ids().count() as u64 - 1;
        assert_eq!(summary.calibration[0], CalibrationBin { effects: others, present: 0, sum: 0.0 });
        assert_eq!(summary.calibration[6], CalibrationBin { effects: 1, present: 1, sum: 0.97 });
        assert_eq!(summary.calibration.iter().map(|range| range.effects).sum::<u64>(), others + 1);
    }

    /// What a hull lacks nobody knows, but in a calm it is no weather.
    #[test]
    fn weather_is_wrong_of_a_hull_in_a_calm() {
        let trials: [&[&[&str]]; 4] =
            [&[&["speed_loss"]], &[&["wind_moment", "speed_loss"]], &[&["wind_moment"]], &[&["moment_drift"], &["a"]]];
        let summary = summary(&[HULL], &trials);
        assert_eq!((summary.wrong, summary.exact_share()), (2, None));
        assert_eq!(summary.wrong_share().map(|share| share.value), Some(0.5));
    }

    #[test]
    fn any_name_is_wrong_where_nothing_is_missing() {
        let summary = summary(&[], &[&[], &[&["a"]]]);
        assert_eq!((summary.wrong, summary.exact, summary.complete_share()), (1, 1, None));
    }
}
