//! What was asked and what was answered: one case for every question on every trial, with the answers of all methods.

use serde::{Deserialize, Serialize};

use crate::benchmark::statistics::ratio;

/// A task.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BenchTask {
    /// Fit a record and replay its rudder on it.
    Identify,
    /// Find K and T of a ship that is first order.
    Indices,
    /// Fit a zig-zag to one side first, replay one to the other.
    OtherSide,
    /// Fit a zig-zag, replay one of another rudder or heading angle.
    OtherAmplitude,
    /// Fit zig-zags, replay a turning circle.
    Circle,
    /// Name the effect that a first-order ship lacks.
    Name,
}

impl BenchTask {
    /// All tasks, in the order of reports.
    pub const ALL: [Self; 6] =
        [Self::Identify, Self::Indices, Self::OtherSide, Self::OtherAmplitude, Self::Circle, Self::Name];

    /// The word used in files and on the command line.
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

    /// What it is, in a few words.
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

    /// What the score is; `None` where an answer is right or wrong.
    pub fn score(self) -> Option<&'static str> {
        match self {
            Self::Indices => Some("larger error of K and T [%]"),
            Self::Name => None,
            _ => Some("rms error of the heading [°]"),
        }
    }
}

/// One question with all answers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BenchCase {
    /// What was asked.
    pub task: BenchTask,
    /// What the case is counted with: the study.
    pub field: String,
    /// Name of the set.
    pub set: String,
    /// Number of a simulated trial in its set.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trial: Option<u64>,
    /// Names of the records that were fitted together.
    pub fitted: Vec<String>,
    /// Name of the record that was scored; none where the ship was asked about.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scored: Option<String>,
    /// The effect that the ship lacks, where it was asked for; none where it lacks nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub missing: Option<String>,
    /// The answers, in the order of methods.
    pub answers: Vec<CaseAnswer>,
}

/// The answer of one method.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CaseAnswer {
    /// Label of the method.
    pub method: String,
    /// Heading error, deg, or the larger error of K and T, %; none where there is none, or where the answer is right or
    /// wrong.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub score: Option<f64>,
    /// K and T found over the true ones, less one, %.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub errors_percent: Option<[f64; 2]>,
    /// Whether the 95 % intervals of K and T hold the truth, where there are intervals.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub holds: Option<[bool; 2]>,
    /// What was made of the effect.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub naming: Option<Naming>,
    /// Effects that were named, each followed by those the records cannot tell from it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub named: Vec<Vec<String>>,
    /// Why there is no answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

/// A set.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Present {
    /// What it is called.
    pub name: String,
    /// Number of its trials.
    pub trials: u64,
    /// Its records.
    pub records: Vec<PresentRecord>,
}

/// A record of a set.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PresentRecord {
    /// What it is called.
    pub name: String,
    /// What the ship did.
    pub manoeuvre: String,
    /// SHA-256 of its file; none of a simulated record.
    pub sha256: Option<String>,
}

/// A record that was not used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Skipped {
    /// Name of the set.
    pub set: String,
    /// Name of the record.
    pub record: String,
    /// Why.
    pub reason: String,
}

/// What a method that names effects said.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Naming {
    /// What is missing, and nothing else; of a ship that lacks nothing, nothing.
    Right,
    /// A group that holds what is missing, under the name of another, and nothing else.
    Alias,
    /// What is missing or a group that holds it, and something else.
    More,
    /// Something else.
    Wrong,
    /// Nothing, though something is missing.
    Nothing,
}

impl Naming {
    /// All of them, the best first.
    pub const ALL: [Self; 5] = [Self::Right, Self::Alias, Self::More, Self::Wrong, Self::Nothing];

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Alias => "among aliases",
            Self::More => "and more",
            Self::Wrong => "wrong",
            Self::Nothing => "nothing",
        }
    }

    /// What the groups that were named are worth where one effect is missing, or none.
    pub fn of(missing: Option<&str>, named: &[Vec<String>]) -> Self {
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
    /// What is drawn together when intervals are made: all cases of one simulated trial, or all in which one measured
    /// record is scored.
    pub fn cluster(&self) -> (&str, String) {
        let own = self.trial.map_or_else(|| self.scored.clone().unwrap_or_default(), |trial| trial.to_string());
        (&self.set, own)
    }

    /// The score of a method over that of another; `None` where one of them was not asked.
    pub fn ratio_of(&self, method: &str, reference: &str) -> Option<f64> {
        Some(ratio(self.score_of(method)?, self.score_of(reference)?))
    }

    /// The score of a method: worse than any where it has no answer, `None` where it was not asked.
    pub fn score_of(&self, method: &str) -> Option<f64> {
        let answer = self.answers.iter().find(|answer| answer.method == method)?;
        Some(answer.score.unwrap_or(f64::INFINITY))
    }
}

/// A number as it is stored: six digits. Boards are made of stored numbers, so that anybody finds the same.
pub fn stored(value: f64) -> f64 {
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
        for (missing, named, said) in [
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
            assert_eq!(Naming::of(missing, &named), said, "{missing:?} {named:?}");
        }
    }

    #[test]
    fn stored_numbers_have_six_digits() {
        assert_eq!([1.234_567_89, -0.0123456789, 0.0].map(stored), [1.23457, -0.0123457, 0.0]);
    }
}
