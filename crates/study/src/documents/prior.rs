//! What is said of earlier trials of a ship beside her records.

use document::earlier_trials::{EarlierTrials, Likeness, PriorCheckEntry, PriorModelEntry};
use document::{Code, Warning};
use report::number::{fixed, significant};
use ship::vessel::prime::meaning;

/// Coefficients that are named in a conflict, and how far they have moved at least, in standard deviations.
const NAMED: usize = 3;
const MOVED: f64 = 1.0;

/// What is said where no hull can be fitted near the models.
const NOT_NEAR: &str = "no hull near it can be replayed over the records";

/// One sentence for screen and page.
pub fn sentence(earlier: &EarlierTrials) -> String {
    let model = |own: &PriorModelEntry| {
        let ship = match own.likeness {
            Likeness::SameShip => String::from("the same ship"),
            Likeness::OtherScale => String::from("a ship of another length"),
            Likeness::OtherHull => format!("a ship of other {}", own.differing.join(", ")),
        };
        format!("{} ({ship}, deviations × {})", own.file, own.factor)
    };
    let models = earlier.models.iter().map(model).collect::<Vec<_>>().join(", ");
    let found = match earlier.hulls.first() {
        None => String::from(NOT_NEAR),
        Some(nearest) if earlier.conflict => format!("the records contradict it ({})", numbers(nearest)),
        Some(nearest) => format!("the records agree with it ({})", numbers(nearest)),
    };
    let has_part = earlier.hulls.iter().any(|own| own.takes_part);
    let no_part = if has_part { "" } else { "; it is not used, other hulls fit better" };
    format!("prior: {models}; {found}{no_part}")
}

/// The warning of a conflict.
pub fn warning(earlier: &EarlierTrials) -> Option<Warning> {
    earlier.conflict.then(|| Code::EarlierTrials.warning(contradiction(earlier)))
}

/// How far the records are from the models, and what to do.
fn contradiction(earlier: &EarlierTrials) -> String {
    let files = earlier.models.iter().map(|own| own.file.as_str()).collect::<Vec<_>>().join(", ");
    let cure = "make sure that it is the same ship in the same condition, or leave --prior out";
    let Some(nearest) = earlier.hulls.first() else { return format!("--prior {files}: {NOT_NEAR}; {cure}") };
    let moved = nearest.moved.iter().filter(|(_, shift)| shift.abs() >= MOVED).take(NAMED);
    let moved = moved.map(|(key, shift)| {
        let means = meaning(key).map_or_else(String::new, |means| format!(" ({means})"));
        format!("{key} by {} sd{means}", fixed(*shift, 1))
    });
    let moved = moved.collect::<Vec<_>>().join(", ");
    let what = if moved.is_empty() { String::new() } else { format!("; farthest from it: {moved}") };
    format!("--prior {files}: the records contradict it ({}){what}; {cure}", numbers(nearest))
}

fn numbers(check: &PriorCheckEntry) -> String {
    let PriorCheckEntry { form, chi_square, degrees_of_freedom, p_value, .. } = check;
    format!("{form}: χ² = {} of {degrees_of_freedom}, p = {}", significant(*chi_square, 3), significant(*p_value, 2))
}
