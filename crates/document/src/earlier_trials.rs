//! `earlier_trials` of `fit.json` and `trace.json`: models of earlier trials used as priors, and their prior-data
//! conflict (Box 1980).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use ship::vessel::prior::HullParticulars;

/// Earlier trials of `--prior`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct EarlierTrials {
    /// Models of earlier trials.
    pub models: Vec<PriorModelEntry>,
    /// Check of every hull of the models, the nearest to the records first; empty if none can be replayed on the
    /// records.
    pub hulls: Vec<PriorCheckEntry>,
    /// `true` if the records contradict the models: they contradict the nearest hull, or there is no hull.
    pub conflict: bool,
}

/// Model of earlier trials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PriorModelEntry {
    /// File of the model.
    pub file: String,
    /// Records of the model: file names by SHA-256.
    #[serde(default)]
    pub records: BTreeMap<String, String>,
    /// Likeness of the ship: `same-ship`, `other-scale`, or `other-hull` (another loading, or a sister).
    pub likeness: Likeness,
    /// Factor by which the standard deviations of the estimates are widened.
    pub factor: f64,
    /// Keys of the particulars in which the ships differ.
    pub differing: Vec<String>,
    /// Length of the ship, m.
    pub length_m: f64,
    /// Approach speed of the ship, m/s.
    pub speed_m_s: f64,
}

/// Check of the records against the prior of a hull (Box 1980).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PriorCheckEntry {
    /// `quadratic`, `cubic` or `mmg`.
    pub form: String,
    /// χ²: squared shift of the coefficients, in the metric of prior covariance minus posterior covariance.
    pub chi_square: f64,
    /// Number of directions informed by the records.
    pub degrees_of_freedom: usize,
    /// Probability of a χ² at least as large if the models are right.
    pub p_value: f64,
    /// Coefficients by their keys with their shift in prior standard deviations, the largest magnitude first.
    #[serde(rename = "moved")]
    pub shifts: Vec<(String, f64)>,
    /// `true` if the hull is a member of the result.
    pub takes_part: bool,
}

/// Likeness of the ship of earlier trials to the ship of the records.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Likeness {
    /// Same ship, by her particulars.
    SameShip,
    /// Same proportions at another length: a model of her, or a sister of another size.
    OtherScale,
    /// Other proportions: another loading, or a sister.
    OtherHull,
}

impl Likeness {
    /// Likeness of the ship of earlier trials (`earlier`) to the ship of the records (`ship`).
    pub fn from_particulars(earlier: &HullParticulars, ship: &HullParticulars) -> Self {
        match (ship.differing_keys(earlier).is_empty(), ship.has_equal_length(earlier)) {
            (false, _) => Self::OtherHull,
            (true, true) => Self::SameShip,
            (true, false) => Self::OtherScale,
        }
    }

    /// Factor by which the standard deviations of the estimates of earlier trials are multiplied. The values are
    /// judgements, not tuned on results.
    ///
    /// 1.5 for the same ship: a hull model of twenty coefficients is an approximation, so its estimates from two trials
    /// of one ship differ by more than their errors. 2 for another scale: rudder and propeller of a ship model work in
    /// another wake. 3 for another hull: empirical formulas predict at best a third of the difference between two
    /// loadings.
    pub fn factor(self) -> f64 {
        match self {
            Self::SameShip => 1.5,
            Self::OtherScale => 2.0,
            Self::OtherHull => 3.0,
        }
    }
}
