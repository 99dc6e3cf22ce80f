//! Sentences on the agreement of earlier trials of a ship (`--prior`) with the records.

use document::earlier_trials::{EarlierTrials, Likeness, PriorCheckEntry, PriorModelEntry};
use document::{Warning, WarningCode};
use report::number::{fixed, significant};
use ship::vessel::prime::departure_cause;

/// Maximum number of coefficients named in a conflict.
const MAX_NAMED: usize = 3;

/// Minimum shift of a coefficient named in a conflict, in standard deviations.
const MIN_SHIFT_SD: f64 = 1.0;

/// Message if no hull near the models can be fitted.
const NOT_NEAR: &str = "no hull close to it reproduces the records";

/// Sentence on the models of earlier trials and on whether the records agree with them, for screen and page.
pub fn earlier_trials_sentence(earlier: &EarlierTrials) -> String {
    let model = |model: &PriorModelEntry| {
        let ship = match model.likeness {
            Likeness::SameShip => String::from("the same ship"),
            Likeness::OtherScale => String::from("a ship of another length"),
            Likeness::OtherHull => format!("a ship with another {}", model.differing.join(", ")),
        };
        format!("{} ({ship}, standard deviations × {})", model.file, model.factor)
    };
    let models = earlier.models.iter().map(model).collect::<Vec<_>>().join(", ");
    let agreement = match earlier.hulls.first() {
        None => String::from(NOT_NEAR),
        Some(nearest) if earlier.conflict => format!("the records contradict it ({})", numbers(nearest)),
        Some(nearest) => format!("the records agree with it ({})", numbers(nearest)),
    };
    let has_part = earlier.hulls.iter().any(|hull| hull.takes_part);
    let no_part = if has_part { "" } else { "; it is not used, because other hulls fit better" };
    format!("prior: {models}; {agreement}{no_part}")
}

/// Warning of a conflict between records and models; `None` if they agree.
pub fn contradiction_warning(earlier: &EarlierTrials) -> Option<Warning> {
    earlier.conflict.then(|| WarningCode::EarlierTrials.warning(contradiction(earlier)))
}

/// Text of the warning: the conflict, the coefficients with the largest shifts, and the remedy.
fn contradiction(earlier: &EarlierTrials) -> String {
    let files = earlier.models.iter().map(|model| model.file.as_str()).collect::<Vec<_>>().join(", ");
    let cure = "make sure that it is the same ship in the same condition, or leave --prior out";
    let Some(nearest) = earlier.hulls.first() else { return format!("--prior {files}: {NOT_NEAR}; {cure}") };
    let moved = nearest.shifts.iter().filter(|(_, shift)| shift.abs() >= MIN_SHIFT_SD).take(MAX_NAMED);
    let moved = moved.map(|(key, shift)| {
        let means = departure_cause(key).map_or_else(String::new, |means| format!(" ({means})"));
        format!("{key} by {} standard deviations{means}", fixed(*shift, 1))
    });
    let moved = moved.collect::<Vec<_>>().join(", ");
    let farthest = if moved.is_empty() { String::new() } else { format!("; farthest off: {moved}") };
    format!("--prior {files}: the records contradict it ({}){farthest}; {cure}", numbers(nearest))
}

fn numbers(check: &PriorCheckEntry) -> String {
    let PriorCheckEntry { form, p_value, .. } = check;
    format!("hull {form}, p = {}", significant(*p_value, 2))
}
