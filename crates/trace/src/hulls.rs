//! Hulls of three degrees of freedom beside the structures: what averages them when the records are not first order.

use identify::hull::{self, HullEstimate};
use rayon::prelude::*;
use ship::vessel::prime::HullForm;
use ship::vessel::prior::priors;
use trial::Trial;

use crate::comparison::RecordComparison;
use crate::remainder::squares;

/// A hull that leaves this many times what the structures or another hull leave takes no part.
const FAR: f64 = 3.0;

/// The hulls that the records speak for, beside what the structures have left of them; none without length and speed.
pub fn fit(trials: &[Trial], structures: &[RecordComparison]) -> Vec<HullEstimate> {
    let mut forms = vec![HullForm::Quadratic, HullForm::Cubic];
    forms.extend(
        trials.iter().find_map(Trial::hull).and_then(|own| priors(&own).ok()).map(|prior| HullForm::mmg(&prior)),
    );
    let fitted = |form: &HullForm| hull::fit(trials, form, &form.coefficients()).ok();
    let found: Vec<HullEstimate> = forms.par_iter().filter_map(fitted).collect();
    let rows: usize = structures.iter().map(|one| one.after.errors.rows).sum();
    let of_structures = (squares(structures)[1] / rows as f64).sqrt();
    let left = |hull: &HullEstimate| hull.mean_square().sqrt();
    let least = found.iter().map(left).fold(of_structures, f64::min);
    found.into_iter().filter(|hull| left(hull) <= FAR * least).collect()
}

/// The same hulls fitted to other records.
pub fn refitted(hulls: &[HullEstimate], trials: &[Trial]) -> Vec<HullEstimate> {
    hulls.par_iter().filter_map(|own| hull::fit(trials, &own.form, &own.expected).ok()).collect()
}
