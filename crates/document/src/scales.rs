//! What was found at each scale beside what was found at all of them together, without dimension: which terms scale.

use serde::{Deserialize, Serialize};
use ship::Particulars;

use crate::quantity::Quantity;

/// Whether a number that has no dimension is the same at every scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub enum Scaling {
    /// It is, and a difference of a quarter of it would have been seen.
    #[serde(rename = "scales")]
    Scales,
    /// It is not.
    #[serde(rename = "does not scale")]
    DoesNotScale,
    /// The errors are too large, or not known.
    #[serde(rename = "cannot be told")]
    CannotBeTold,
}

/// One number without dimension at every scale.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ComparedTerm {
    /// Symbol.
    pub symbol: String,
    /// Unit: 1, or an angle.
    pub unit: String,
    /// From the records of all scales.
    pub joint: Quantity,
    /// From those of every scale alone; none where they do not tell it.
    pub own: Vec<Option<Quantity>>,
    /// Largest difference of two scales in units of its standard deviation.
    pub difference_sd: Option<f64>,
    /// `scales`, `does not scale` or `cannot be told`.
    pub verdict: Scaling,
}

/// The terms of one model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ComparedModel {
    /// A method, or `traced`.
    pub model: String,
    /// Its terms.
    pub terms: Vec<ComparedTerm>,
}

/// The records of one scale.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ScaleEntry {
    /// Length, m.
    pub length_m: f64,
    /// Approach speed, m/s.
    pub speed_m_s: f64,
    /// What times are multiplied with to be those of the first scale.
    pub time_factor: f64,
    /// Its fitted records.
    pub files: Vec<String>,
}

/// Everything that is said of records of several scales.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ScalesEntry {
    /// The scales; numbers with a dimension are told at the first.
    pub groups: Vec<ScaleEntry>,
    /// The comparison of every model.
    pub comparisons: Vec<ComparedModel>,
}

impl ScalesEntry {
    /// The scales of these groups of records of these names.
    pub fn new(
        groups: &[(Particulars, Vec<usize>)],
        files: &[&str],
        first: Particulars,
        comparisons: Vec<ComparedModel>,
    ) -> Self {
        let of = |(own, records): &(Particulars, Vec<usize>)| ScaleEntry {
            length_m: own.length,
            speed_m_s: own.speed,
            time_factor: own.factor_to(first, [1, 0]),
            files: records.iter().map(|record| files[*record].to_owned()).collect(),
        };
        Self { groups: groups.iter().map(of).collect(), comparisons }
    }
}
