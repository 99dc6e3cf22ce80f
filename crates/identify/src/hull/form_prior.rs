//! Prior of the coefficients of a hull: from its form or its particulars, and from earlier trials of the ship or of a
//! similar ship.
//!
//! An earlier trial gave values θ₁ with a covariance C₁, from a prior of mean μ₁ and precision Λ₁. The information of
//! the trial itself has the precision D₁ = C₁⁻¹ − Λ₁ and the vector h₁ = C₁⁻¹ θ₁ − Λ₁ μ₁. The prior of the next trial
//! is
//!
//! Λ = Λ₀ + Σ D₁/f², Λ μ = Λ₀ μ₀ + Σ (h₁ + D₁ s)/f²
//!
//! with the prior of her particulars, μ₀ and Λ₀, counted once for any number of trials; s = μ₀ − μ₁ is the change of
//! the formulas with the particulars, and f widens by the likeness of the ships ([`Likeness`]): a power prior (Ibrahim
//! and Chen 2000, doi:10.1214/ss/1009212673) of power 1/f². If the earlier trial has no information, the prior of the
//! particulars remains. Coefficients have no dimension, so at equal Froude numbers they do not depend on scale.

use document::earlier_trials::Likeness;
use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};
use ship::vessel::prime::{HullCoefficient, HullModel, is_frictional, is_trial_specific};
use ship::vessel::prior::HullParticulars;

/// Relative tolerance of equal Froude numbers.
const FROUDE_TOLERANCE: f64 = 0.1;

/// Minimum information of an earlier trial in a direction, relative to its prior, that is used.
const MIN_INFORMATION: f64 = 1e-6;

/// Normal prior distribution of the coefficients of one hull form.
#[derive(Debug, Clone, PartialEq)]
pub struct HullFormPrior {
    /// Hull form.
    pub form: HullModel,
    /// Particulars of the ship; `None` if they are not declared.
    pub particulars: Option<HullParticulars>,
    /// Coefficients, each with prior mean and standard deviation.
    pub coefficients: Vec<HullCoefficient>,
    /// Prior precision Λ: the inverse of the prior covariance of all coefficients.
    pub precision: DMatrix<f64>,
    /// `true` if the prior includes earlier trials.
    pub has_earlier_trials: bool,
}

/// Hull estimate from earlier trials.
#[derive(Debug, Clone, PartialEq)]
pub struct EarlierHull {
    /// Form, with the prior of the particulars.
    pub form: HullModel,
    /// Particulars of the ship.
    pub particulars: HullParticulars,
    /// Estimates of the coefficients, dimensionless, in the order of the form.
    pub coefficients: DVector<f64>,
    /// Covariance of the coefficients.
    pub covariance: DMatrix<f64>,
}

/// `true` if the Froude numbers of two ships differ by more than a tenth, so that waves and squat differ and the
/// coefficients carry over less well.
pub fn differs_in_froude_number(earlier: &HullParticulars, ship: &HullParticulars) -> bool {
    (earlier.froude_number() / ship.froude_number() - 1.0).abs() > FROUDE_TOLERANCE
}

impl HullFormPrior {
    /// Prior from the form alone.
    pub fn from_form(form: HullModel) -> Self {
        let (coefficients, precision) = (form.coefficients().to_vec(), precision_of(&form));
        Self { form, particulars: None, coefficients, precision, has_earlier_trials: false }
    }

    /// Priors of all forms that can be fitted to a ship, updated with earlier trials. Missing particulars are taken
    /// from the earlier ships. Without particulars the earlier trials have no effect.
    pub fn candidates(particulars: Option<&HullParticulars>, earlier: &[EarlierHull]) -> Vec<Self> {
        let particulars = particulars
            .map(|declared| earlier.iter().fold(*declared, |ship, trial| ship.with_missing_from(&trial.particulars)));
        let after_trials = |form: HullModel| {
            let mut prior = Self { particulars, ..Self::from_form(form) };
            let same_form = earlier.iter().filter(|hull| hull.form.as_str() == prior.form.as_str());
            if let Some(ship) = particulars {
                let all: Vec<&EarlierHull> = same_form.collect();
                prior.add(&ship, &all);
            }
            prior
        };
        HullModel::candidates(particulars.as_ref()).into_iter().map(after_trials).collect()
    }

    /// Prior means of the coefficients, dimensionless.
    pub fn mean(&self) -> DVector<f64> {
        DVector::from_iterator(self.coefficients.len(), self.coefficients.iter().map(|coefficient| coefficient.mean))
    }

    /// Covariance C of the coefficients, and their gain G = C (Λ − Λ₀) on the coefficients of the earlier hull: the
    /// identity if the trials dominate, 0 if they have no information. `None` without trials.
    pub fn covariance_and_gain(&self) -> Option<[DMatrix<f64>; 2]> {
        let covariance = Cholesky::new(self.precision.clone()).filter(|_| self.has_earlier_trials)?.inverse();
        let gain = &covariance * (&self.precision - precision_of(&self.form));
        Some([covariance, gain])
    }

    /// Adds the information of earlier trials; a hull whose covariance is not positive definite is left out.
    pub(super) fn add(&mut self, ship: &HullParticulars, earlier: &[&EarlierHull]) {
        let mut precision = self.precision.clone();
        let mut vector = &precision * self.mean();
        let mut has_earlier_trials = false;
        for hull in earlier {
            let Some((added_precision, added_vector)) = hull.information(self, ship) else { continue };
            precision += added_precision;
            vector += added_vector;
            has_earlier_trials = true;
        }
        let Some(factor) = Cholesky::new(precision.clone()).filter(|_| has_earlier_trials) else { return };
        let (mean, covariance) = (factor.solve(&vector), factor.inverse());
        for (place, HullCoefficient { mean: value, sd, bounds, .. }) in self.coefficients.iter_mut().enumerate() {
            (*value, *sd) = (mean[place].clamp(bounds[0], bounds[1]), covariance[(place, place)].sqrt());
        }
        (self.precision, self.has_earlier_trials) = (precision, true);
    }
}

/// Prior precision Λ₀ of the coefficients of a form: the inverse of their covariance.
fn precision_of(form: &HullModel) -> DMatrix<f64> {
    Cholesky::new(form.covariance().clone()).expect("a covariance").inverse()
}

impl EarlierHull {
    /// Information of the trials of this hull, D/f² and (h + D s)/f², in the order of the coefficients of another ship.
    /// `None` if its covariance is not positive definite.
    ///
    /// Coefficients of a single trial are left out, as are coefficients of friction at another scale, except through
    /// their correlations.
    fn information(&self, prior: &HullFormPrior, ship: &HullParticulars) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let likeness = Likeness::from_particulars(&self.particulars, ship);
        let before = self.form.coefficients();
        let of_ship = |key: &str| !is_trial_specific(key) && (likeness == Likeness::SameShip || !is_frictional(key));
        let kept: Vec<usize> = (0..before.len()).filter(|&place| of_ship(before[place].key)).collect();
        let count = kept.len();
        // In standard deviations of the prior, so that all directions have equal units: L with L Lᵀ the covariance.
        let kept_block = |matrix: &DMatrix<f64>| DMatrix::from_fn(count, count, |i, j| matrix[(kept[i], kept[j])]);
        let root = Cholesky::new(kept_block(self.form.covariance()))?.l();
        let in_root = |vector: DVector<f64>| root.solve_lower_triangular(&vector);
        let half = root.solve_lower_triangular(&kept_block(&self.covariance))?;
        let after = Cholesky::new(root.solve_lower_triangular(&half.transpose())?)?.inverse();
        let departure = in_root(DVector::from_fn(count, |i, _| self.coefficients[kept[i]] - before[kept[i]].mean))?;
        // h − D μ₁ = C₁⁻¹ (θ₁ − μ₁): the information on the departure from the prior.
        let departure_information = &after * departure;
        let eigen = SymmetricEigen::new(after - DMatrix::identity(count, count));
        let mut precision = DMatrix::zeros(count, count);
        let mut vector = DVector::zeros(count);
        for (value, direction) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value > MIN_INFORMATION {
                precision.ger(*value, &direction, &direction, 1.0);
                vector.axpy(direction.dot(&departure_information), &direction, 1.0);
            }
        }
        // For the other ship the departure counts from the prior of her particulars: D s + D μ₁ = D μ₀.
        let carried = self.carried(prior, ship, before);
        vector += &precision * in_root(DVector::from_fn(count, |i, _| carried[kept[i]]))?;
        let weight = likeness.factor().powi(-2);
        let vector = root.tr_solve_lower_triangular(&vector)? * weight;
        let half = root.tr_solve_lower_triangular(&precision)?;
        let precision = root.tr_solve_lower_triangular(&half.transpose())? * weight;
        let size = before.len();
        let (mut matrix, mut all) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for i in 0..count {
            all[kept[i]] = vector[i];
            for j in 0..count {
                matrix[(kept[i], kept[j])] = precision[(i, j)];
            }
        }
        Some((matrix, all))
    }

    /// Prior means before the earlier trials, moved by the change of the formulas with the particulars.
    fn carried(&self, prior: &HullFormPrior, ship: &HullParticulars, before: &[HullCoefficient]) -> Vec<f64> {
        // A particular that only one ship declares has no effect.
        let filled = self.particulars.with_missing_from(ship);
        let forms = HullModel::candidates(Some(&filled));
        let of_filled = forms.iter().find(|form| form.as_str() == self.form.as_str()).map(HullModel::coefficients);
        let generic = prior.form.coefficients();
        let moved = |(place, coefficient): (usize, &HullCoefficient)| {
            coefficient.mean + of_filled.as_ref().map_or(0.0, |filled| generic[place].mean - filled[place].mean)
        };
        before.iter().enumerate().map(moved).collect()
    }
}
