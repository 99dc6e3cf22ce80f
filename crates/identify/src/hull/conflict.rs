//! Whether records contradict what was expected of a hull.
//!
//! If what was expected, N(μ, C₀), is true, the values that a fit finds depart from μ by Δ with the covariance C₀ −
//! C, C that of the fit: the predictive check of Box (1980, doi:10.2307/2982063) in the form that Evans and Moshonov
//! (2006, doi:10.1214/06-BA129) give it for a prior against data. In the directions w that diagonalise both, C₀ → 1,
//! C → λ,
//!
//! χ² = Σ z²/(1 − λ), z = w·Δ, over the directions in which the records tell something, λ < 0.9.
//!
//! It is exact for a linear model with a known error. A hull is neither: read a p of 0.01 as a reason to look.

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};
use ship::vessel::prime::is_of_trial;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::expected::ExpectedHull;

/// Share of the variance of a direction that is left where the records tell too little of it.
const UNTOLD: f64 = 0.9;

/// A p below this is a conflict.
const CONFLICT: f64 = 0.01;

/// The check of what was expected of a hull against its records.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectationCheck {
    /// χ².
    pub chi_square: f64,
    /// Directions that were looked at.
    pub degrees_of_freedom: usize,
    /// Probability of so large a χ² where the expectation holds.
    pub p_value: f64,
    /// Key and departure, in standard deviations of what was expected, of every coefficient of the ship; the farthest
    /// first.
    pub moved: Vec<(&'static str, f64)>,
}

impl ExpectationCheck {
    /// Whether records and expectation contradict each other.
    pub fn is_conflict(&self) -> bool {
        self.p_value < CONFLICT
    }

    /// What a fit found against what was expected of the ship; what belongs to a trial has no part in it. `None`
    /// where the records tell nothing new.
    pub(super) fn of(expected: &ExpectedHull, values: &DVector<f64>, covariance: &DMatrix<f64>) -> Option<Self> {
        let places: Vec<usize> =
            (0..values.len()).filter(|&place| !is_of_trial(expected.coefficients[place].key)).collect();
        let of_ship =
            |matrix: &DMatrix<f64>| DMatrix::from_fn(places.len(), places.len(), |i, j| matrix[(places[i], places[j])]);
        let before = of_ship(&Cholesky::new(expected.precision.clone())?.inverse());
        let root = Cholesky::new(before)?.l();
        let shift = values - expected.mean();
        let shift = root.solve_lower_triangular(&DVector::from_fn(places.len(), |i, _| shift[places[i]]))?;
        let half = root.solve_lower_triangular(&of_ship(covariance))?;
        let eigen = SymmetricEigen::new(root.solve_lower_triangular(&half.transpose())?);
        let told = eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()).filter(|(left, _)| **left < UNTOLD);
        let squares: Vec<f64> = told.map(|(left, own)| own.dot(&shift).powi(2) / (1.0 - left)).collect();
        let chi_square: f64 = squares.iter().sum();
        let law = ChiSquared::new(squares.len() as f64).ok()?;
        let departure = |&place: &usize| {
            let own = &expected.coefficients[place];
            (own.key, (values[place] - own.mean) / own.sd)
        };
        let mut moved: Vec<(&'static str, f64)> = places.iter().map(departure).collect();
        moved.sort_by(|one, other| other.1.abs().total_cmp(&one.1.abs()));
        Some(Self { chi_square, degrees_of_freedom: squares.len(), p_value: law.sf(chi_square), moved })
    }
}
