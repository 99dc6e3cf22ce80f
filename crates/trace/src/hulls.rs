//! Hull models of three degrees of freedom, averaged with the structures if the residual is more than noise or earlier
//! trials are given.

use identify::hull::{self, HullEstimate};
use rayon::prelude::*;
use trial::Trial;

use crate::comparison::RecordComparison;
use crate::residual_analysis::{ResidualAnalysis, heading_error_squares};
use crate::settings::Settings;

/// Hulls supported by the records, with earlier trials as priors: their residual is at most three times the smallest of
/// all hulls and of the structure average. Empty if hulls are not requested, and without length and speed of the ship;
/// without earlier trials also if the structures leave only noise.
pub fn fit_supported_hulls(
    trials: &[Trial],
    settings: &Settings,
    comparisons: &[RecordComparison],
    residual_analysis: &ResidualAnalysis,
) -> Vec<HullEstimate> {
    if !settings.fits_hulls || residual_analysis.is_noise && settings.earlier_hulls.is_empty() {
        return Vec::new();
    }
    let rows: usize = comparisons.iter().map(|comparison| comparison.average_replay.errors.heading_count).sum();
    hull::supported_hulls(
        hull::fit_all_forms(trials, &settings.earlier_hulls),
        (heading_error_squares(comparisons)[1] / rows as f64).sqrt(),
    )
}

/// Hulls refitted to other records under the same priors.
pub fn refit_hulls(hulls: &[HullEstimate], trials: &[Trial]) -> Vec<HullEstimate> {
    hulls.par_iter().filter_map(|hull| hull::fit(trials, &hull.prior).ok()).collect()
}
