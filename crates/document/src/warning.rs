//! Warnings: what a reader should know beside the numbers.

use serde::{Deserialize, Serialize};

/// How much a warning costs; the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// K, T or a prediction may be wrong.
    Doubt,
    /// A choice was made that a key can change.
    Choice,
    /// A fault was mended, and costs nothing.
    Mended,
}

/// Where a warning comes from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Source {
    /// A record, by its name.
    Record(String),
    /// A method, by its identifier.
    Method(String),
    /// The whole of the records, or the study.
    Study,
}

/// A warning.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Warning {
    /// How much it costs.
    pub severity: Severity,
    /// Where it comes from.
    pub source: Source,
    /// What it says.
    pub text: String,
}
