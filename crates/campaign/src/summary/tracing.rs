//! Summary of traces by cell: missing effects that were named, and wrongly named effects.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::AddAssign;
use std::sync::LazyLock;

use ::trace::TraceVerdict;

use super::judgement::Judgement;
use crate::design::CellFacts;
use crate::rows::{NamedEffect, StudyRow, TraceRow};
use crate::scenario::{HULL_ID, MissingPhysics};
use crate::statistics::{Statistic, wilson_share};

/// Margin in log evidence above which a missing effect should be named; below it another effect explains the trial
/// nearly as well.
pub const MIN_CLEAR_MARGIN: f64 = 10.0;

/// Counts over the traces of one method in one cell.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TraceSummary {
    /// Index of the cell.
    pub cell: usize,
    /// Index of the method, a trace.
    pub method: usize,
    /// Identifiers of the missing effects.
    pub missing_effects: Vec<String>,
    /// Number of trials by judgement, in a study that states the missing physics.
    pub judgements: BTreeMap<Judgement, u64>,
    /// Number of trials.
    pub trials: u64,
    /// Number of trials by verdict, in the order of [`TraceVerdict::ALL`].
    pub verdict_counts: [u64; TraceVerdict::ALL.len()],
    /// Number of trials by named effect.
    pub named_effect_counts: BTreeMap<String, u64>,
    /// Number of trials by effect named as an alias of a missing one.
    pub named_alias_counts: BTreeMap<String, u64>,
    /// Number of trials without any named effect.
    pub nothing_named_count: u64,
    /// Number of trials whose named groups contain every missing effect, or one of the effects that a formula stands
    /// for.
    pub all_named_count: u64,
    /// Number of trials with a named group that contains no missing effect; for a hull, whose missing effects are not
    /// defined, a group of weather effects alone.
    pub falsely_named_count: u64,
    /// Number of trials in which exactly the missing effects were named, or correctly none.
    pub exactly_named_count: u64,
    /// Number of trials with a clear margin for the one missing effect, and number of those that name it.
    pub clearly_separable: [u64; 2],
    /// Mean over the trials of the expected 2 ln Λ (twice the log-likelihood ratio) of the truth against the nearest
    /// first-order response; `None` if no trial has one.
    pub mean_expected_2_ln_lambda: Option<f64>,
    /// Mean coverage of the heading band, on the trial and on the validation manoeuvre; `None` without a band.
    pub band_coverage: [Option<f64>; 2],
    /// Calibration of the probabilities of effects, by the bins between [`CALIBRATION_BIN_EDGES`]; all counts are 0 for
    /// a hull.
    pub calibration: [CalibrationBin; CALIBRATION_BIN_EDGES.len() - 1],
}

/// Edges of the probability bins of a calibration table; a bin includes its lower edge, the last one both.
pub const CALIBRATION_BIN_EDGES: [f64; 9] = [0.0, 0.01, 0.05, 0.2, 0.5, 0.8, 0.95, 0.99, 1.0];

/// Bin of a calibration table.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CalibrationBin {
    /// Number of pairs of effect and trial in the bin.
    pub effect_count: u64,
    /// Number of these pairs with the effect present.
    pub present_count: u64,
    /// Sum of the probabilities.
    pub probability_sum: f64,
}

impl AddAssign for CalibrationBin {
    fn add_assign(&mut self, other: Self) {
        self.effect_count += other.effect_count;
        self.present_count += other.present_count;
        self.probability_sum += other.probability_sum;
    }
}

static EFFECT_IDS: LazyLock<BTreeSet<&'static str>> =
    LazyLock::new(|| ship::effects::all_effects().iter().map(|effect| effect.id()).collect());

static WEATHER_IDS: LazyLock<BTreeSet<&'static str>> = LazyLock::new(|| {
    ship::effects::all_effects().iter().filter(|effect| effect.is_environmental()).map(|effect| effect.id()).collect()
});

/// Identifiers of all effects, each once, sorted.
pub fn effect_ids() -> impl Iterator<Item = &'static str> {
    EFFECT_IDS.iter().copied()
}

impl TraceSummary {
    /// Share of trials in which all missing effects were named; `None` without a missing effect, and for a hull.
    pub fn all_named_trial_share(&self) -> Option<Statistic> {
        if self.missing_effects.is_empty() { None } else { self.share_of(self.all_named_count) }
    }

    /// Share of trials in which exactly the missing effects were named; `None` for a hull.
    pub fn exactly_named_trial_share(&self) -> Option<Statistic> {
        self.share_of(self.exactly_named_count)
    }

    /// Share of trials with a wrongly named group.
    pub fn falsely_named_trial_share(&self) -> Option<Statistic> {
        wilson_share(self.falsely_named_count, self.trials)
    }

    /// Share of the trials; `None` for a hull.
    fn share_of(&self, count: u64) -> Option<Statistic> {
        if self.is_hull() { None } else { wilson_share(count, self.trials) }
    }

    /// Share of trials with a clear margin in which the missing effect was named.
    pub fn clearly_separable_share(&self) -> Option<Statistic> {
        wilson_share(self.clearly_separable[1], self.clearly_separable[0])
    }

    /// `true` for a hull, whose missing effects are not defined.
    pub fn is_hull(&self) -> bool {
        self.missing_effects.iter().any(|id| id == HULL_ID)
    }
}

/// Running counts over the traces of one method in one cell.
#[derive(Debug, Clone)]
pub(super) struct TraceTally {
    summary: TraceSummary,
    physics: Option<MissingPhysics>,
    /// Running means of the expected 2 ln Λ of the truth against the nearest first-order response, and of the coverage
    /// of the two bands.
    means: [RunningMean; 3],
}

/// Running mean: sum and count of the defined values.
#[derive(Debug, Default, Clone, Copy)]
struct RunningMean(f64, u64);

impl RunningMean {
    /// Adds a value, if there is one, and returns the mean of all values so far.
    fn add(&mut self, value: Option<f64>) -> Option<f64> {
        *self = Self(self.0 + value.unwrap_or(0.0), self.1 + u64::from(value.is_some()));
        (self.1 > 0).then(|| self.0 / self.1 as f64)
    }
}

impl TraceTally {
    /// Empty tally for the cell and the method of a row.
    pub(super) fn new(row: &StudyRow, facts: &CellFacts) -> Self {
        let (cell, method, missing) = (row.cell as usize, row.method, facts.missing_effects.clone());
        let summary = TraceSummary { cell, method, missing_effects: missing, ..TraceSummary::default() };
        Self { summary, physics: facts.physics.clone(), means: Default::default() }
    }

    /// Adds the result of a trace.
    pub(super) fn add(&mut self, answer: &TraceRow) {
        let Self { summary, physics, means: [expected, fitted, held_out] } = self;
        summary.trials += 1;
        let judgement = physics.as_ref().map(|physics| Judgement::from_trace_row(answer, physics));
        judgement.into_iter().for_each(|judgement| *summary.judgements.entry(judgement).or_default() += 1);
        let verdict = TraceVerdict::ALL.iter().position(|verdict| *verdict == answer.verdict);
        verdict.into_iter().for_each(|place| summary.verdict_counts[place] += 1);
        summary.nothing_named_count += u64::from(answer.named_effects.is_empty());
        let ids: BTreeSet<&str> = answer.named_effects.iter().map(|effect| &*effect.id).collect();
        ids.into_iter().for_each(|id| *summary.named_effect_counts.entry(id.to_owned()).or_default() += 1);
        let missing = &summary.missing_effects;
        // A formula with the physics of listed effects is matched by them.
        let accepted = match physics {
            Some(MissingPhysics::Listed { effects }) => effects,
            _ => missing,
        };
        let (right, wrong): (Vec<_>, Vec<_>) =
            answer.named_effects.iter().partition(|effect| accepted.iter().any(|id| effect.includes(id)));
        let aliases = right.iter().filter(|effect| missing.iter().all(|id| **id != *effect.id));
        let aliases: BTreeSet<&str> = aliases.map(|effect| &*effect.id).collect();
        aliases.into_iter().for_each(|id| *summary.named_alias_counts.entry(id.to_owned()).or_default() += 1);
        let complete = match physics {
            Some(MissingPhysics::Listed { .. }) => !right.is_empty(),
            _ => missing.iter().all(|id| right.iter().any(|effect| effect.includes(id))),
        };
        let is_weather = |effect: &&NamedEffect| {
            let ids = std::iter::once(&effect.id).chain(&effect.aliases);
            ids.into_iter().all(|id| WEATHER_IDS.contains(&**id))
        };
        summary.falsely_named_count += u64::from(wrong.iter().any(|effect| !summary.is_hull() || is_weather(effect)));
        summary.all_named_count += u64::from(complete && !missing.is_empty());
        summary.exactly_named_count += u64::from(complete && wrong.is_empty());
        if answer.evidence_margin.is_some_and(|margin| margin > MIN_CLEAR_MARGIN) {
            summary.clearly_separable[0] += 1;
            summary.clearly_separable[1] += u64::from(complete);
        }
        let has_truth = !summary.is_hull();
        for id in effect_ids().filter(|_| has_truth) {
            let entry = answer.probabilities.iter().find(|(other, _)| **other == *id);
            let sum = entry.map_or(0.0, |(_, probability)| *probability);
            let bin = CALIBRATION_BIN_EDGES[1..].partition_point(|end| *end <= sum).min(summary.calibration.len() - 1);
            let present = u64::from(summary.missing_effects.iter().any(|missing| missing == id));
            summary.calibration[bin] +=
                CalibrationBin { effect_count: 1, present_count: present, probability_sum: sum };
        }
        summary.mean_expected_2_ln_lambda = expected.add(answer.expected_2_ln_lambda);
        summary.band_coverage =
            [fitted.add(answer.fitted_band_coverage), held_out.add(answer.validation_band_coverage)];
    }

    /// Summary of the counts.
    pub(super) fn summary(&self) -> TraceSummary {
        self.summary.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Summary of traces that name groups of effects if `missing` are missing.
    fn summary(missing: &[&str], trials: &[&[&[&str]]]) -> TraceSummary {
        let missing: Vec<String> = missing.iter().map(|&id| id.to_owned()).collect();
        let mut tally =
            TraceTally::new(&StudyRow::default(), &CellFacts { missing_effects: missing, ..CellFacts::default() });
        let effect = |ids: &&[&str]| NamedEffect {
            id: ids[0].into(),
            aliases: ids[1..].iter().map(|&alias| alias.into()).collect(),
            ..NamedEffect::default()
        };
        for groups in trials {
            tally.add(&TraceRow {
                verdict: TraceVerdict::Traced,
                named_effects: groups.iter().map(effect).collect(),
                probabilities: vec![("wind_moment".into(), 0.97)],
                evidence_margin: Some(30.0),
                expected_2_ln_lambda: Some(4.0),
                fitted_band_coverage: Some(0.9),
                ..TraceRow::default()
            });
        }
        tally.summary()
    }

    #[test]
    fn groups_are_right_when_they_hold_what_is_missing() {
        let trials: [&[&[&str]]; 5] =
            [&[&["a"], &["b"]], &[&["c", "a"], &["b"]], &[&["a"]], &[&["a"], &["b"], &["d"]], &[]];
        let summary = summary(&["a", "b"], &trials);
        assert_eq!(
            (summary.trials, summary.all_named_count, summary.falsely_named_count, summary.nothing_named_count),
            (5, 3, 1, 1)
        );
        assert_eq!((summary.exactly_named_count, summary.clearly_separable), (2, [5, 3]));
        assert_eq!(
            (summary.named_effect_counts["b"], summary.named_effect_counts["c"], summary.named_alias_counts.get("c")),
            (3, 1, Some(&1))
        );
        assert_eq!((summary.mean_expected_2_ln_lambda, summary.band_coverage), (Some(4.0), [Some(0.9), None]));
    }

    /// One effect is present with probability 97 %, the others are absent with probability 0.
    #[test]
    fn effects_are_counted_by_their_probability() {
        let summary = summary(&["wind_moment"], &[&[]]);
        let absent = effect_ids().count() as u64 - 1;
        assert_eq!(
            summary.calibration[0],
            CalibrationBin { effect_count: absent, present_count: 0, probability_sum: 0.0 }
        );
        assert_eq!(summary.calibration[6], CalibrationBin { effect_count: 1, present_count: 1, probability_sum: 0.97 });
        assert_eq!(summary.calibration.iter().map(|range| range.effect_count).sum::<u64>(), absent + 1);
    }

    /// The missing effects of a hull are not defined, but a weather effect is wrong in a calm.
    #[test]
    fn weather_is_wrong_of_a_hull_in_a_calm() {
        let trials: [&[&[&str]]; 4] =
            [&[&["speed_loss"]], &[&["wind_moment", "speed_loss"]], &[&["wind_moment"]], &[&["moment_drift"], &["a"]]];
        let summary = summary(&[HULL_ID], &trials);
        assert_eq!((summary.falsely_named_count, summary.exactly_named_trial_share()), (2, None));
        assert_eq!(summary.falsely_named_trial_share().map(|share| share.value), Some(0.5));
    }

    #[test]
    fn any_name_is_wrong_where_nothing_is_missing() {
        let summary = summary(&[], &[&[], &[&["a"]]]);
        assert_eq!(
            (summary.falsely_named_count, summary.exactly_named_count, summary.all_named_trial_share()),
            (1, 1, None)
        );
    }
}
