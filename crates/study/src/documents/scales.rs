//! What was found at each scale beside what was found at all of them together, without dimension: which terms scale.

use serde::{Deserialize, Serialize};
use ship::Particulars;
use trial::{Quantity, Scaling};

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
    pub verdict: String,
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

impl ComparedTerm {
    /// Compares what was found at every scale.
    pub fn new(symbol: impl Into<String>, unit: &str, joint: Quantity, own: Vec<Option<Quantity>>) -> Self {
        let found: Vec<Quantity> = own.iter().map(|own| own.unwrap_or(Quantity::bare(f64::NAN))).collect();
        let (difference_sd, verdict) = Scaling::of(&found);
        let verdict = verdict.as_str().to_owned();
        Self { symbol: symbol.into(), unit: unit.to_owned(), joint, own, difference_sd, verdict }
    }
}

impl ScalesEntry {
    /// The scales of these groups of records of these names.
    pub(crate) fn new(
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
