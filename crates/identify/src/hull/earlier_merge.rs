//! Combination of a fitted hull with the information of earlier trials, without a new fit.

use nalgebra::Cholesky;
use ship::vessel::prime::HullModel;

use super::conflict::PriorCheck;
use super::form_prior::{EarlierHull, HullFormPrior};

/// Fitted hull updated with earlier trials that its fit did not include, and the check of the update against the prior
/// from these trials. `None` if the earlier trials have no information on its form; the check is `None` if the fitted
/// hull adds no information to that prior.
///
/// Λ = C⁻¹ + Σ D₁/f², Λ θ = C⁻¹ θ̂ + Σ (h₁ + D₁ s)/f², with D₁, h₁, s and f as in `form_prior`. Both are treated
/// as normal laws: if they are far apart, a fit with the earlier trials as prior is better.
pub fn merge_with_earlier(fitted: &EarlierHull, earlier: &[EarlierHull]) -> Option<(EarlierHull, Option<PriorCheck>)> {
    let is_same_form = |form: &HullModel| form.as_str() == fitted.form.as_str();
    let mut coefficients = fitted.form.coefficients().to_vec();
    for (place, coefficient) in coefficients.iter_mut().enumerate() {
        (coefficient.mean, coefficient.sd) = (fitted.coefficients[place], fitted.covariance[(place, place)].sqrt());
    }
    let precision = Cholesky::new(fitted.covariance.clone())?.inverse();
    let (form, particulars) = (fitted.form.clone(), Some(fitted.particulars));
    let mut both = HullFormPrior { form, particulars, coefficients, precision, has_earlier_trials: false };
    let of_form: Vec<&EarlierHull> = earlier.iter().filter(|hull| is_same_form(&hull.form)).collect();
    both.add(&fitted.particulars, &of_form);
    let [covariance, _] = both.covariance_and_gain()?;
    let after = EarlierHull { coefficients: both.mean(), covariance, ..fitted.clone() };
    let before =
        HullFormPrior::candidates(Some(&fitted.particulars), earlier).into_iter().find(|p| is_same_form(&p.form));
    let check = before.and_then(|before| PriorCheck::from_fit(&before, &after.coefficients, &after.covariance));
    Some((after, check))
}
