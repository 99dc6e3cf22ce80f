//! What is left beside the effects that are named.

use std::fmt;

use serde::{Deserialize, Serialize};

/// What a moment depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Dependence {
    /// Time.
    Time,
    /// The heading.
    Heading,
    /// The way to one side of the first course.
    #[serde(rename = "way to one side")]
    Way,
    /// The yaw rate.
    #[serde(rename = "yaw rate")]
    YawRate,
    /// The rudder.
    Rudder,
    /// What rudder and yaw rate were before.
    #[serde(rename = "history of the rudder")]
    History,
}

/// The words in files.
impl fmt::Display for Dependence {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        self.serialize(out)
    }
}

/// What is left.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct UnexplainedEntry {
    /// Whether it is neither chance nor of a shape that was looked for.
    pub present: bool,
    /// Where it is, where it is more than noise.
    pub signature: Option<String>,
}

/// A random moment beside what is named and located.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct DisturbanceEntry {
    /// Its size as a rudder angle: the root mean square over the longest record.
    pub rudder_deg: f64,
    /// Share of the square of the heading error that it carries.
    pub heading_error_share: f64,
}

/// A moment that is no effect of the list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct LocatedEntry {
    /// What it depends on: `time`, `heading`, `way to one side`, `yaw rate`, `rudder` or `history of the rudder`.
    #[schemars(with = "String")]
    pub depends_on: Dependence,
    /// The moment in words.
    pub form: String,
    /// The one record in which it acts.
    pub only: Option<String>,
    /// Since when, where it is a matter of instants.
    pub from_s: Option<f64>,
    /// Until when.
    pub until_s: Option<f64>,
    /// How much worse the records are explained without it, by any random moment as well.
    pub nats: f64,
    /// Rudder angle that its root mean square is worth.
    pub rudder_deg: f64,
    /// What the records cannot tell from it: other moments, and effects of the list.
    pub alternatives: Vec<String>,
    /// The moment as an effect that a trace can be asked for, where a formula says it.
    pub formula: Option<String>,
}
