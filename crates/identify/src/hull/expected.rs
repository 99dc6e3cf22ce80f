//! What is expected of the coefficients of a hull before its records are seen: what its form or its particulars say,
//! and what earlier trials have told of her, or of a ship like her.
//!
//! An earlier trial left values θ₁ with a covariance C₁; before it μ₁ was expected with the precision Λ₁. What the
//! trial itself told has the precision D₁ = C₁⁻¹ − Λ₁ and the vector h₁ = C₁⁻¹ θ₁ − Λ₁ μ₁. Expected of the next trial
//! are
//!
//! Λ = Λ₀ + Σ D₁/f², Λ μ = Λ₀ μ₀ + Σ (h₁ + D₁ s)/f²
//!
//! with what her own particulars say, μ₀ and Λ₀, counted once however many trials there are; s = μ₀ − μ₁ is the
//! difference that the formulas make of other particulars, and f widens by the likeness of the ships ([`Likeness`]):
//! a power prior (Ibrahim and Chen 2000, doi:10.1214/ss/1009212673) of power 1/f². Where the earlier trial told
//! nothing, the prior is that of the particulars. Coefficients have no dimension, so scale changes none of them at
//! the same Froude number.

use document::earlier_trials::Likeness;
use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};
use ship::vessel::prime::{HullCoefficient, HullForm, is_of_friction, is_of_trial};
use ship::vessel::prior::HullParticulars;

/// Froude numbers that differ by less than this share are alike.
const FROUDE: f64 = 0.1;

/// What an earlier trial told in a direction counts from this share of what was expected before it.
const TOLD: f64 = 1e-6;

/// What is expected of the coefficients of a form: a normal law.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectedHull {
    /// The form.
    pub form: HullForm,
    /// Particulars of the ship that the form is of, where they are known.
    pub particulars: Option<HullParticulars>,
    /// The coefficients, each with its own mean and standard deviation.
    pub coefficients: Vec<HullCoefficient>,
    /// Inverse of the covariance of all.
    pub precision: DMatrix<f64>,
    /// Whether earlier trials are in it.
    pub has_trials: bool,
}

/// A hull that earlier trials left.
#[derive(Debug, Clone, PartialEq)]
pub struct EarlierHull {
    /// Its form, about what its particulars say.
    pub form: HullForm,
    /// Particulars of its ship.
    pub particulars: HullParticulars,
    /// Values of the coefficients.
    pub values: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
}

/// Whether two ships sail at so different Froude numbers, by more than a tenth, that coefficients of one say less of
/// the other: waves and squat are others.
pub fn is_other_froude_number(earlier: &HullParticulars, ship: &HullParticulars) -> bool {
    (earlier.froude_number() / ship.froude_number() - 1.0).abs() > FROUDE
}

impl ExpectedHull {
    /// What a form says by itself.
    pub fn of_form(form: HullForm) -> Self {
        let (coefficients, precision) = (form.coefficients().to_vec(), precision_of(&form));
        Self { form, particulars: None, coefficients, precision, has_trials: false }
    }

    /// The same of all forms that a ship can be fitted with, those with earlier trials after these. What is missing of
    /// her particulars is that of the earlier ships.
    pub fn of_ship(particulars: Option<&HullParticulars>, earlier: &[EarlierHull]) -> Vec<Self> {
        let particulars =
            particulars.map(|own| earlier.iter().fold(*own, |ship, one| ship.filled_from(&one.particulars)));
        let after_trials = |form: HullForm| {
            let mut expected = Self { particulars, ..Self::of_form(form) };
            let same_form = earlier.iter().filter(|own| own.form.as_str() == expected.form.as_str());
            if let Some(ship) = particulars {
                let all: Vec<&EarlierHull> = same_form.collect();
                expected.add(&ship, &all);
            }
            expected
        };
        HullForm::of_ship(particulars.as_ref()).into_iter().map(after_trials).collect()
    }

    /// Expected values.
    pub fn mean(&self) -> DVector<f64> {
        DVector::from_iterator(self.coefficients.len(), self.coefficients.iter().map(|own| own.mean))
    }

    /// Covariance C of the coefficients, and how far they follow those of the one earlier hull that is in them,
    /// G = C (Λ − Λ₀): the identity where its trials told all, 0 where these told nothing. `None` without trials.
    pub fn law(&self) -> Option<[DMatrix<f64>; 2]> {
        let covariance = Cholesky::new(self.precision.clone()).filter(|_| self.has_trials)?.inverse();
        let gain = &covariance * (&self.precision - precision_of(&self.form));
        Some([covariance, gain])
    }

    /// Adds what earlier trials told. What makes no normal law is left out.
    pub(super) fn add(&mut self, ship: &HullParticulars, earlier: &[&EarlierHull]) {
        let mut precision = self.precision.clone();
        let mut vector = &precision * self.mean();
        let mut has_trials = false;
        for own in earlier {
            let Some((told, of_told)) = own.told(self, ship) else { continue };
            precision += told;
            vector += of_told;
            has_trials = true;
        }
        let Some(factor) = Cholesky::new(precision.clone()).filter(|_| has_trials) else { return };
        let (mean, covariance) = (factor.solve(&vector), factor.inverse());
        for (place, own) in self.coefficients.iter_mut().enumerate() {
            (own.mean, own.sd) = (mean[place].clamp(own.ends[0], own.ends[1]), covariance[(place, place)].sqrt());
        }
        (self.precision, self.has_trials) = (precision, true);
    }
}

/// Λ₀.
fn precision_of(form: &HullForm) -> DMatrix<f64> {
    Cholesky::new(form.covariance().clone()).expect("a covariance").inverse()
}

impl EarlierHull {
    /// D/f² and (h + D s)/f² of the trials of this hull, in the places of the coefficients of another ship. `None`
    /// where its covariance is none.
    ///
    /// What belongs to a trial is not told; nor at another scale what depends on friction, but by what is correlated
    /// with it.
    fn told(&self, expected: &ExpectedHull, ship: &HullParticulars) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let likeness = Likeness::of(&self.particulars, ship);
        let before = self.form.coefficients();
        let of_ship = |key: &str| !is_of_trial(key) && (likeness == Likeness::SameShip || !is_of_friction(key));
        let kept: Vec<usize> = (0..before.len()).filter(|&place| of_ship(before[place].key)).collect();
        let count = kept.len();
        // In standard deviations of what was expected before, so that every direction is measured alike: L with L Lᵀ
        // its covariance.
        let of = |matrix: &DMatrix<f64>| DMatrix::from_fn(count, count, |i, j| matrix[(kept[i], kept[j])]);
        let root = Cholesky::new(of(self.form.covariance()))?.l();
        let in_root = |vector: DVector<f64>| root.solve_lower_triangular(&vector);
        let half = root.solve_lower_triangular(&of(&self.covariance))?;
        let after = Cholesky::new(root.solve_lower_triangular(&half.transpose())?)?.inverse();
        let departure = in_root(DVector::from_fn(count, |i, _| self.values[kept[i]] - before[kept[i]].mean))?;
        // h − D μ₁ = C₁⁻¹ (θ₁ − μ₁): what was told of the departure from what was expected.
        let of_departure = &after * departure;
        let eigen = SymmetricEigen::new(after - DMatrix::identity(count, count));
        let mut told = DMatrix::zeros(count, count);
        let mut vector = DVector::zeros(count);
        for (value, direction) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value > TOLD {
                told.ger(*value, &direction, &direction, 1.0);
                vector.axpy(direction.dot(&of_departure), &direction, 1.0);
            }
        }
        // About the other ship the same departure is counted from what her own particulars say: D s + D μ₁ = D μ₀.
        let about = self.carried(expected, ship, before);
        vector += &told * in_root(DVector::from_fn(count, |i, _| about[kept[i]]))?;
        let weight = likeness.factor().powi(-2);
        let vector = root.tr_solve_lower_triangular(&vector)? * weight;
        let half = root.tr_solve_lower_triangular(&told)?;
        let told = root.tr_solve_lower_triangular(&half.transpose())? * weight;
        let size = before.len();
        let (mut matrix, mut all) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for i in 0..count {
            all[kept[i]] = vector[i];
            for j in 0..count {
                matrix[(kept[i], kept[j])] = told[(i, j)];
            }
        }
        Some((matrix, all))
    }

    /// What was expected before the earlier trials, moved by the difference that the formulas make of other
    /// particulars.
    fn carried(&self, expected: &ExpectedHull, ship: &HullParticulars, before: &[HullCoefficient]) -> Vec<f64> {
        // What is known of one ship only is no difference.
        let filled = self.particulars.filled_from(ship);
        let forms = HullForm::of_ship(Some(&filled));
        let of_filled = forms.iter().find(|form| form.as_str() == self.form.as_str()).map(HullForm::coefficients);
        let generic = expected.form.coefficients();
        let moved = |(place, own): (usize, &HullCoefficient)| {
            own.mean + of_filled.as_ref().map_or(0.0, |filled| generic[place].mean - filled[place].mean)
        };
        before.iter().enumerate().map(moved).collect()
    }
}
