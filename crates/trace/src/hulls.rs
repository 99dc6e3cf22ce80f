//! Hulls of three degrees of freedom beside the structures: what averages them when the records are not first order.

use identify::hull::{self, HullEstimate};
use rayon::prelude::*;
use trial::Trial;

use crate::comparison::RecordComparison;
use crate::remainder::{Remainder, squares};
use crate::settings::Settings;

/// The hulls that the records speak for, about what earlier trials told of the ship, beside what the structures have
/// left of them; none without length and speed. Without earlier trials none where the structures leave nothing but
/// noise.
pub fn fit(
    trials: &[Trial],
    settings: &Settings,
    structures: &[RecordComparison],
    remainder: &Remainder,
) -> Vec<HullEstimate> {
    if !settings.hulls || remainder.holds && settings.earlier.is_empty() {
        return Vec::new();
    }
    let rows: usize = structures.iter().map(|one| one.after.errors.rows).sum();
    hull::members(hull::fit_all(trials, &settings.earlier), (squares(structures)[1] / rows as f64).sqrt())
}

/// The same hulls fitted to other records.
pub fn refitted(hulls: &[HullEstimate], trials: &[Trial]) -> Vec<HullEstimate> {
    hulls.par_iter().filter_map(|own| hull::fit(trials, &own.expected).ok()).collect()
}
