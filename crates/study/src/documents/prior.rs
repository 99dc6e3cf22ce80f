//! `earlier_trials` of `fit.json` and `trace.json`: the models of earlier trials, and whether the records contradict
//! them.

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
                _ => format!("a ship of another {}", own.differing.join(", ")),
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
        let no_part = if has_part { "" } else { "; it has no part in the answer, other hulls are nearer" };
        format!("prior: {models}; {found}{no_part}")
    }

    /// The warning of a conflict.
    pub fn warning(&self) -> Option<String> {
        self.conflict.then_some(())?;
        let files = self.models.iter().map(|own| own.file.as_str()).collect::<Vec<_>>().join(", ");
        let cure = "make sure that it is the same ship in the same condition, or leave it out";
        let Some(nearest) = self.hulls.first() else { return Some(format!("--prior {files}: {NOT_NEAR}; {cure}")) };
        let moved = nearest.moved.iter().filter(|(_, shift)| shift.abs() >= MOVED).take(NAMED);
        let moved = moved.map(|(key, shift)| {
            let means = meaning(key).map_or_else(String::new, |means| format!(" ({means})"));
            format!("{key} by {} sd{means}", fixed(*shift, 1))
        });
        let moved = moved.collect::<Vec<_>>().join(", ");
        let what = if moved.is_empty() { String::new() } else { format!("; farthest from it: {moved}") };
        Some(format!("--prior {files}: the records contradict it ({}){what}; {cure}", nearest.numbers()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(p_value: f64) -> EarlierTrials {
        let check = ExpectationCheck {
            chi_square: 41.3,
            degrees_of_freedom: 9,
            p_value,
            moved: vec![("Nv", -4.25), ("Nvv", 2.0), ("b", 0.5)],
        };
        let model = PriorModelEntry {
            file: "fit.json".into(),
            likeness: "other-hull".into(),
            factor: 3.0,
            differing: vec!["draught-m".into()],
            length_m: 320.0,
            speed_m_s: 7.97,
        };
        let conflict = check.is_conflict();
        EarlierTrials { models: vec![model], hulls: vec![PriorCheckEntry::of("mmg", &check, true)], conflict }
    }

    #[test]
    fn a_conflict_is_one_warning_with_what_moved() {
        let warning = entry(4.4e-6).warning().expect("a conflict");
        let expected = "--prior fit.json: the records contradict it (mmg: χ² = 41.3 of 9, p = 4.4×10⁻⁶); farthest from it: \
                        Nv by −4.2 sd (trim, or shallow water), Nvv by 2.0 sd; make sure";
        assert!(warning.replace('-', "−").starts_with(&expected.replace('-', "−")), "{warning}");
        assert_eq!(entry(0.3).warning(), None);
    }

    #[test]
    fn the_sentence_says_whose_model_it_is() {
        let sentence = entry(0.3).sentence();
        assert!(
            sentence.starts_with("prior: fit.json (a ship of another draught-m, deviations × 3); the records agree")
        );
        let without = EarlierTrials { hulls: Vec::new(), conflict: true, ..entry(0.3) };
        assert!(without.sentence().contains("it has no part in the answer"));
        assert!(without.warning().expect("a conflict").starts_with("--prior fit.json: no hull near it"));
    }
}
