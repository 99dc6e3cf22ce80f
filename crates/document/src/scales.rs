//! Comparison of dimensionless terms between scales: estimates at each scale and at all scales together.

use serde::{Deserialize, Serialize};
use ship::Particulars;

use crate::quantity::Quantity;

/// Constancy of a dimensionless term across scales.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(rename = "Scaling")]
pub enum ScalingVerdict {
    /// Equal, and a difference of a quarter would have been significant.
    #[serde(rename = "scales")]
    Scales,
    /// Different.
    #[serde(rename = "does not scale")]
    DoesNotScale,
    /// Undecided: the errors are too large or unknown.
    #[serde(rename = "cannot be told")]
    Undecided,
}

/// Dimensionless term at every scale.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ComparedTerm {
    /// Symbol.
    pub symbol: String,
    /// Unit: 1, or an angle.
    pub unit: String,
    /// Estimate from the records of all scales.
    pub joint: Quantity,
    /// Estimate from the records of each scale alone; `null` where they do not determine the term.
    #[serde(rename = "own")]
    pub by_scale: Vec<Option<Quantity>>,
    /// Maximum difference between two scales in units of its standard deviation.
    pub difference_sd: Option<f64>,
    /// `scales`, `does not scale` or `cannot be told`.
    pub verdict: ScalingVerdict,
}

/// Compared terms of one model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ComparedModel {
    /// Method, or `traced`.
    pub model: String,
    /// Terms.
    pub terms: Vec<ComparedTerm>,
}

/// Records of one scale.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ScaleEntry {
    /// Length, m.
    pub length_m: f64,
    /// Approach speed, m/s.
    pub speed_m_s: f64,
    /// Factor that converts times to the first scale.
    pub time_factor: f64,
    /// Files of the fitted records.
    pub files: Vec<String>,
}

/// Comparison of records of several scales.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ScalesEntry {
    /// Scales; dimensional numbers refer to the first.
    pub groups: Vec<ScaleEntry>,
    /// Compared terms of every model.
    pub comparisons: Vec<ComparedModel>,
}

impl ScalesEntry {
    /// Comparison of groups of records, each with its particulars and the indices of its records in `files`; `first`
    /// are the particulars of the first scale.
    pub fn new(
        groups: &[(Particulars, Vec<usize>)],
        files: &[&str],
        first: Particulars,
        comparisons: Vec<ComparedModel>,
    ) -> Self {
        let entry = |(ship, records): &(Particulars, Vec<usize>)| ScaleEntry {
            length_m: ship.length,
            speed_m_s: ship.speed,
            time_factor: ship.similarity_factor_to(first, [1, 0]),
            files: records.iter().map(|record| files[*record].to_owned()).collect(),
        };
        Self { groups: groups.iter().map(entry).collect(), comparisons }
    }
}
