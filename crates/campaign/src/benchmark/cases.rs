//! Cases of the benchmark: one per task and trial, with the results of all methods.

use serde::{Deserialize, Serialize};

use crate::benchmark::statistics::ratio;

/// Task of the benchmark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BenchTask {
    /// Fit a record and replay its rudder on it.
    Identify,
    /// Identify K and T of a first-order ship.
    Indices,
    /// Fit a zig-zag to one side first, replay one to the opposite side.
    OtherSide,
    /// Fit a zig-zag, replay one of another rudder or heading angle.
    OtherAmplitude,
    /// Fit zig-zags, replay a turning circle.
    Circle,
    /// Name the effect missing from a first-order ship's model.
    Name,
}

impl BenchTask {
    /// All tasks, in the order of reports.
    pub const ALL: [Self; 6] =
        [Self::Identify, Self::Indices, Self::OtherSide, Self::OtherAmplitude, Self::Circle, Self::Name];

    /// Identifier in files and on the command line.
    pub fn id(self) -> &'static str {
        match self {
            Self::Identify => "identify",
            Self::Indices => "indices",
            Self::OtherSide => "other-side",
            Self::OtherAmplitude => "other-amplitude",
            Self::Circle => "circle",
            Self::Name => "name",
        }
    }

    /// Short title for tables and pages.
    pub fn title(self) -> &'static str {
        match self {
            Self::Identify => "replay the fitted record",
            Self::Indices => "find K and T",
            Self::OtherSide => "predict the other side",
            Self::OtherAmplitude => "predict another amplitude",
            Self::Circle => "predict the turning circle",
            Self::Name => "name the missing effect",
        }
    }

    /// Name and unit of the score; `None` if a result is right or wrong.
    pub fn score_label(self) -> Option<&'static str> {
        match self {
            Self::Indices => Some("larger error of K and T [%]"),
            Self::Name => None,
            _ => Some("rms error of the heading [°]"),
        }
    }
}

/// One task on one trial, with the results of all methods.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BenchCase {
    /// Task.
    pub task: BenchTask,
    /// Study under which the case is counted.
    #[serde(rename = "field")]
    pub study: String,
    /// Name of the set.
    pub set: String,
    /// Number of a simulated trial in its set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trial: Option<u64>,
    /// Names of the records that were fitted together.
    pub fitted: Vec<String>,
    /// Name of the scored record; `null` for tasks about the ship itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scored: Option<String>,
    /// Effect to be named; `null` if the first-order model is complete.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub missing: Option<String>,
    /// Results of the methods, in their order.
    pub answers: Vec<CaseAnswer>,
}

/// Result of one method.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CaseAnswer {
    /// Label of the method.
    pub method: String,
    /// Heading error, deg, or the larger relative error of K and T, %; `null` for a failed estimate, and if a result is
    /// right or wrong.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub score: Option<f64>,
    /// Relative errors of K and T, %.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub errors_percent: Option<[f64; 2]>,
    /// `true` if the 95 % intervals contain K and T; `null` without intervals.
    #[serde(rename = "holds", skip_serializing_if = "Option::is_none")]
    pub contains_truth: Option<[bool; 2]>,
    /// Correctness of the effects named.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub naming: Option<Naming>,
    /// Effects named, each followed by its aliases: effects that the records cannot distinguish from it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub named: Vec<Vec<String>>,
    /// Kind of failure, if the method failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

/// Set of trials: one cell of a study.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BenchSet {
    /// Name of the set.
    pub name: String,
    /// Number of trials.
    pub trials: u64,
    /// Records of the set.
    pub records: Vec<BenchRecord>,
}

/// Record of a set.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BenchRecord {
    /// Name of the record.
    pub name: String,
    /// Manoeuvre and angles.
    pub manoeuvre: String,
    /// SHA-256 of the file; `null` for a simulated record.
    pub sha256: Option<String>,
}

/// Record that was not used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Skipped")]
pub struct SkippedRecord {
    /// Name of the set.
    pub set: String,
    /// Name of the record.
    pub record: String,
    /// Reason why the record was not used.
    pub reason: String,
}

/// Correctness of the effects that a method named, compared with the one missing effect, or with none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Naming {
    /// Missing effect alone; no effect if none is missing.
    Right,
    /// One group whose aliases include the missing effect.
    Alias,
    /// Missing effect or its group, and further effects.
    More,
    /// Other effects only.
    Wrong,
    /// No effect, although one is missing.
    Nothing,
}

impl Naming {
    /// All values, best first.
    pub const ALL: [Self; 5] = [Self::Right, Self::Alias, Self::More, Self::Wrong, Self::Nothing];

    /// Label in tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Alias => "among aliases",
            Self::More => "and more",
            Self::Wrong => "wrong",
            Self::Nothing => "nothing",
        }
    }

    /// Correctness of the named groups for the `missing` effect, or for none.
    pub fn from_named_effects(missing: Option<&str>, named: &[Vec<String>]) -> Self {
        let Some(missing) = missing else { return if named.is_empty() { Self::Right } else { Self::Wrong } };
        let holder = named.iter().find(|group| group.iter().any(|id| id == missing));
        match (holder, named.len()) {
            (_, 0) => Self::Nothing,
            (None, _) => Self::Wrong,
            (Some(group), 1) if group[0] == missing => Self::Right,
            (Some(_), 1) => Self::Alias,
            (Some(_), _) => Self::More,
        }
    }
}

impl BenchCase {
    /// Key of the cluster of the bootstrap: the set, with the number of the simulated trial or the name of the scored
    /// measured record.
    pub fn cluster(&self) -> (&str, String) {
        let unit = self.trial.map_or_else(|| self.scored.clone().unwrap_or_default(), |trial| trial.to_string());
        (&self.set, unit)
    }

    /// Ratio of the scores of two methods; `None` if one of them takes no part.
    pub fn score_ratio(&self, method: &str, reference: &str) -> Option<f64> {
        Some(ratio(self.method_score(method)?, self.method_score(reference)?))
    }

    /// Score of a method: infinite if it failed, `None` if it takes no part.
    pub fn method_score(&self, method: &str) -> Option<f64> {
        let answer = self.answers.iter().find(|answer| answer.method == method)?;
        Some(answer.score.unwrap_or(f64::INFINITY))
    }
}

/// Number as stored, with six significant digits. Leaderboards are computed from stored numbers, so that they can be
/// repeated.
pub fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().expect("it was written as a number")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_right_wrong_or_missing() {
        let groups = |named: &[&[&str]]| -> Vec<Vec<String>> {
            named.iter().map(|group| group.iter().map(|id| (*id).to_owned()).collect()).collect()
        };
        for (missing, named, naming) in [
            (Some("a"), groups(&[&["a"]]), Naming::Right),
            (Some("a"), groups(&[&["a", "b"]]), Naming::Right),
            (Some("a"), groups(&[&["b", "a"]]), Naming::Alias),
            (Some("a"), groups(&[&["b", "a"], &["c"]]), Naming::More),
            (Some("a"), groups(&[&["b"], &["a"]]), Naming::More),
            (Some("a"), groups(&[&["b"]]), Naming::Wrong),
            (Some("a"), groups(&[]), Naming::Nothing),
            (None, groups(&[]), Naming::Right),
            (None, groups(&[&["a"]]), Naming::Wrong),
        ] {
            assert_eq!(Naming::from_named_effects(missing, &named), naming, "{missing:?} {named:?}");
        }
    }

    #[test]
    fn stored_numbers_have_six_digits() {
        assert_eq!([1.234_567_89, -0.0123456789, 0.0].map(rounded), [1.23457, -0.0123457, 0.0]);
    }
}
