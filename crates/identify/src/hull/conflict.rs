//! Check of the prior of a hull against its records.
//!
//! If the prior N(μ, C₀) is true, the fitted values depart from μ by Δ with the covariance C₀ − C, with C the
//! covariance of the fit: the predictive check of Box (1980, doi:10.2307/2982063) in the form that Evans and Moshonov
//! (2006, doi:10.1214/06-BA129) give it for a prior against data. In the directions w that diagonalise both, C₀ → 1, C
//! → λ,
//!
//! χ² = Σ z²/(1 − λ), z = w·Δ, over the directions in which the records add information, λ < 0.9.
//!
//! The check is exact for a linear model with a given noise law. A hull has neither: a p of 0.01 is a reason for
//! inspection.

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};
use ship::vessel::prime::is_trial_specific;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::form_prior::HullFormPrior;

/// Maximum ratio of posterior to prior variance of an informed direction.
const MAX_RATIO: f64 = 0.9;

/// Maximum p value of a conflict.
const CONFLICT_P_VALUE: f64 = 0.01;

/// Result of the check of a prior against records.
#[derive(Debug, Clone, PartialEq)]
pub struct PriorCheck {
    /// χ² of the fitted values against the prior.
    pub chi_square: f64,
    /// Number of directions of the check.
    pub degrees_of_freedom: usize,
    /// Probability of a larger χ² if the prior is true.
    pub p_value: f64,
    /// Key and departure, in standard deviations of the prior, of every coefficient of the ship; the largest first.
    pub shifts: Vec<(&'static str, f64)>,
}

impl PriorCheck {
    /// `true` if the records contradict the prior.
    pub fn is_conflict(&self) -> bool {
        self.p_value < CONFLICT_P_VALUE
    }

    /// Check of fitted values against the prior of the ship, without the coefficients of a single trial. `None` if
    /// the records add no information, or if a covariance is not positive definite.
    pub(super) fn from_fit(prior: &HullFormPrior, values: &DVector<f64>, covariance: &DMatrix<f64>) -> Option<Self> {
        let places: Vec<usize> =
            (0..values.len()).filter(|&place| !is_trial_specific(prior.coefficients[place].key)).collect();
        let of_ship =
            |matrix: &DMatrix<f64>| DMatrix::from_fn(places.len(), places.len(), |i, j| matrix[(places[i], places[j])]);
        let before = of_ship(&Cholesky::new(prior.precision.clone())?.inverse());
        let root = Cholesky::new(before)?.l();
        let shift = values - prior.mean();
        let shift = root.solve_lower_triangular(&DVector::from_fn(places.len(), |i, _| shift[places[i]]))?;
        let half = root.solve_lower_triangular(&of_ship(covariance))?;
        let eigen = SymmetricEigen::new(root.solve_lower_triangular(&half.transpose())?);
        let pairs = eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()).filter(|pair| *pair.0 < MAX_RATIO);
        let squares: Vec<f64> = pairs.map(|(ratio, axis)| axis.dot(&shift).powi(2) / (1.0 - ratio)).collect();
        let chi_square: f64 = squares.iter().sum();
        let law = ChiSquared::new(squares.len() as f64).ok()?;
        let departure = |&place: &usize| {
            let coefficient = &prior.coefficients[place];
            (coefficient.key, (values[place] - coefficient.mean) / coefficient.sd)
        };
        let mut shifts: Vec<(&'static str, f64)> = places.iter().map(departure).collect();
        shifts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        Some(Self { chi_square, degrees_of_freedom: squares.len(), p_value: law.sf(chi_square), shifts })
    }
}
