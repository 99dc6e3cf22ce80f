//! `earlier_trials` of `fit.json` and `trace.json`: the models of earlier trials, and whether the records contradict
//! them.

use std::collections::BTreeMap;

use document::{Code, Warning};
use identify::hull::ExpectationCheck;
use report::number::{fixed, significant};
use serde::{Deserialize, Serialize};
use ship::vessel::prime::meaning;

/// Coefficients that are named in a conflict, and how far they have moved at least, in standard deviations.
const NAMED: usize = 3;
const MOVED: f64 = 1.0;

/// What is said where no hull can be fitted near the models.
const NOT_NEAR: &str = "no hull near it can be replayed over the records";

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
    pub likeness: String,
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

impl PriorCheckEntry {
    /// Of the hull of a form.
    pub fn of(form: &str, check: &ExpectationCheck, takes_part: bool) -> Self {
        Self {
            form: form.to_owned(),
            chi_square: check.chi_square,
            degrees_of_freedom: check.degrees_of_freedom,
            p_value: check.p_value,
            moved: check.moved.iter().map(|(key, shift)| ((*key).to_owned(), *shift)).collect(),
            takes_part,
        }
    }

    fn numbers(&self) -> String {
        let Self { form, chi_square, degrees_of_freedom, p_value, .. } = self;
        format!(
            "{form}: χ² = {} of {degrees_of_freedom}, p = {}",
            significant(*chi_square, 3),
            significant(*p_value, 2)
        )
    }
}

impl EarlierTrials {
    /// One sentence for screen and page.
    pub fn sentence(&self) -> String {
        let model = |own: &PriorModelEntry| {
            let ship = match own.likeness.as_str() {
                "same-ship" => String::from("the same ship"),
                "other-scale" => String::from("a ship of another length"),
                _ => format!("a ship of other {}", own.differing.join(", ")),
            };
            format!("{} ({ship}, deviations × {})", own.file, own.factor)
        };
        let models = self.models.iter().map(model).collect::<Vec<_>>().join(", ");
        let found = match self.hulls.first() {
            None => String::from(NOT_NEAR),
            Some(nearest) if self.conflict => format!("the records contradict it ({})", nearest.numbers()),
            Some(nearest) => format!("the records agree with it ({})", nearest.numbers()),
        };
        let has_part = self.hulls.iter().any(|own| own.takes_part);
        let no_part = if has_part { "" } else { "; it is not used, other hulls fit better" };
        format!("prior: {models}; {found}{no_part}")
    }

    /// The warning of a conflict.
    pub fn warning(&self) -> Option<Warning> {
        self.conflict.then(|| Code::EarlierTrials.warning(self.contradiction()))
    }

    /// How far the records are from the models, and what to do.
    fn contradiction(&self) -> String {
        let files = self.models.iter().map(|own| own.file.as_str()).collect::<Vec<_>>().join(", ");
        let cure = "make sure that it is the same ship in the same condition, or leave --prior out";
        let Some(nearest) = self.hulls.first() else { return format!("--prior {files}: {NOT_NEAR}; {cure}") };
        let moved = nearest.moved.iter().filter(|(_, shift)| shift.abs() >= MOVED).take(NAMED);
        let moved = moved.map(|(key, shift)| {
            let means = meaning(key).map_or_else(String::new, |means| format!(" ({means})"));
            format!("{key} by {} sd{means}", fixed(*shift, 1))
        });
        let moved = moved.collect::<Vec<_>>().join(", ");
        let what = if moved.is_empty() { String::new() } else { format!("; farthest from it: {moved}") };
        format!("--prior {files}: the records contradict it ({}){what}; {cure}", nearest.numbers())
    }
}
