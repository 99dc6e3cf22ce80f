//! A hull that is fitted already, and what earlier trials told of her, weighed together without a new fit.

use nalgebra::Cholesky;
use ship::vessel::prime::HullForm;

use super::conflict::ExpectationCheck;
use super::expected::{EarlierHull, ExpectedHull};

/// The hull that trials left weighed together with what earlier trials told, which it has not seen, and whether the two
/// contradict each other; `None` where the earlier ones tell nothing of its form.
///
/// Λ = C⁻¹ + Σ D₁/f², Λ θ = C⁻¹ θ̂ + Σ (h₁ + D₁ s)/f², with D₁, h₁, s and f as in [`ExpectedHull`]. Both are taken for
/// normal laws: where they are far apart, a fit about the earlier trials is better.
pub fn after_earlier(own: &EarlierHull, earlier: &[EarlierHull]) -> Option<(EarlierHull, Option<ExpectationCheck>)> {
    let is_own_form = |form: &HullForm| form.as_str() == own.form.as_str();
    let mut coefficients = own.form.coefficients().to_vec();
    for (place, known) in coefficients.iter_mut().enumerate() {
        (known.mean, known.sd) = (own.values[place], own.covariance[(place, place)].sqrt());
    }
    let precision = Cholesky::new(own.covariance.clone())?.inverse();
    let (form, particulars) = (own.form.clone(), Some(own.particulars));
    let mut both = ExpectedHull { form, particulars, coefficients, precision, has_trials: false };
    let of_form: Vec<&EarlierHull> = earlier.iter().filter(|one| is_own_form(&one.form)).collect();
    both.add(&own.particulars, &of_form);
    let [covariance, _] = both.law()?;
    let after = EarlierHull { values: both.mean(), covariance, ..own.clone() };
    let before = ExpectedHull::of_ship(Some(&own.particulars), earlier).into_iter().find(|one| is_own_form(&one.form));
    let check = before.and_then(|before| ExpectationCheck::of(&before, &after.values, &after.covariance));
    Some((after, check))
}
