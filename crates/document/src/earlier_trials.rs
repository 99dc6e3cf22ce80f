//! `earlier_trials` of `fit.json` and `trace.json`: the models of earlier trials, and whether the records contradict
//! them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use ship::vessel::prior::HullParticulars;

/// What `--prior` gave.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct EarlierTrials {
    /// The models.
    pub models: Vec<PriorModelEntry>,
    /// The check of every hull that the models have, the nearest to the records first; empty where none near them can
    /// be replayed over the records.
    pub hulls: Vec<PriorCheckEntry>,
    /// Whether the records contradict the models: the nearest hull does, or there is none.
    pub conflict: bool,
}

/// A model of earlier trials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PriorModelEntry {
    /// Its file.
    pub file: String,
    /// The records that are in it: their files by their SHA-256.
    #[serde(default)]
    pub records: BTreeMap<String, String>,
    /// Whether its ship is the `same-ship`, at an `other-scale`, or an `other-hull`: another loading, or a sister.
    pub likeness: Likeness,
    /// What the standard deviations of what its trials told are widened by.
    pub factor: f64,
    /// Particulars in which the ships differ, by their keys.
    pub differing: Vec<String>,
    /// Length of its ship, m.
    pub length_m: f64,
    /// Approach speed of its ship, m/s.
    pub speed_m_s: f64,
}

/// Records against what earlier trials say of a hull: Box (1980).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PriorCheckEntry {
    /// `quadratic`, `cubic` or `mmg`.
    pub form: String,
    /// Square of the shift of the coefficients, in the metric of the covariance before less that after.
    pub chi_square: f64,
    /// Directions of which the records tell something.
    pub degrees_of_freedom: usize,
    /// Probability of so large a square where the models hold.
    pub p_value: f64,
    /// Coefficients of the ship by their keys, with their shift in standard deviations of what was expected; the
    /// farthest first.
    pub moved: Vec<(String, f64)>,
    /// Whether it is near enough to the records, beside other hulls, to be one of the answer.
    pub takes_part: bool,
}

/// How like the ship of earlier trials is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Likeness {
    /// The same ship, as far as her particulars say.
    SameShip,
    /// The same at another length: a model of her, or a sister of another size.
    OtherScale,
    /// A hull of other proportions: another loading, or a sister.
    OtherHull,
}

impl Likeness {
    /// Of the ship of earlier trials to another.
    pub fn of(earlier: &HullParticulars, ship: &HullParticulars) -> Self {
        match (ship.differing(earlier).is_empty(), ship.has_length_of(earlier)) {
            (false, _) => Self::OtherHull,
            (true, true) => Self::SameShip,
            (true, false) => Self::OtherScale,
        }
    }

    /// What standard deviations are widened by. These are judgements, and no figure was tuned with them. 1.5: a hull of
    /// twenty numbers is not the ship, so two trials of one ship differ by more than their errors. 2: rudder and
    /// propeller of a model work in another wake. 3: the formulas carry a difference of loading to a third at best.
    pub fn factor(self) -> f64 {
        match self {
            Self::SameShip => 1.5,
            Self::OtherScale => 2.0,
            Self::OtherHull => 3.0,
        }
    }
}
