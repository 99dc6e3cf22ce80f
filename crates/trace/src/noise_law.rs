//! Noise law of the records, and the whitening of columns under it.

use estimation::column::dot;
use estimation::kalman::whitener::Whitener;

use crate::noise::{CorrelatedNoise, NoiseColour};

/// Noise law: one colour for all records, one variance for each.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseLaw {
    /// Colour, in units of the white noise of a row.
    pub colour: NoiseColour,
    /// Variance of the white noise of a full row of every record, rad².
    pub row_variance: Vec<f64>,
    /// Power of the likelihood of every record: below one if the noise includes a model error, which more rows do not
    /// average out (coarsened posterior; Miller and Dunson 2019).
    pub likelihood_power: Vec<f64>,
}

impl NoiseLaw {
    /// `true` if the law includes a smooth model error.
    pub fn includes_model_error(&self) -> bool {
        matches!(self.colour.correlated, Some((CorrelatedNoise::SmoothError(_), _)))
    }

    /// `true` if the law includes a random yaw moment.
    pub fn is_random_moment(&self) -> bool {
        self.colour.correlated.is_some_and(|(kind, _)| !kind.is_heading_error())
    }

    /// `true` if two laws have the same kind of colour, both or neither waves, and variances within a factor of 1.5.
    pub fn is_alike(&self, other: &Self) -> bool {
        let kind = |law: &Self| (law.colour.correlated.map(|(kind, _)| kind), law.colour.waves.is_some());
        let is_similar = |(a, b): (&f64, &f64)| (a / b).ln().abs() < 0.4;
        kind(self) == kind(other) && self.row_variance.iter().zip(&other.row_variance).all(is_similar)
    }

    /// White noise of one variance (rad²) in all records.
    pub fn white(records: usize, variance: f64) -> Self {
        Self { colour: NoiseColour::WHITE, row_variance: vec![variance; records], likelihood_power: vec![1.0; records] }
    }
}

/// Whitening filters of all records with their scales.
#[derive(Debug, Clone)]
pub struct RecordWhitening {
    /// Whitening filters.
    pub whiteners: Vec<Whitener>,
    /// Scale √(p/σ²) of every record, 1/rad, with the variance σ² of a full row and the power p of the likelihood.
    pub scale: Vec<f64>,
}

impl RecordWhitening {
    /// Whitens columns of one record and multiplies them by its scale.
    pub fn apply(&self, record: usize, columns: &mut [&mut Vec<f64>]) {
        self.whiteners[record].apply(columns);
        let scale = self.scale[record];
        for column in columns {
            column.iter_mut().for_each(|x| *x *= scale);
        }
    }

    /// Applies the transpose of [`apply`](Self::apply) to a column of one record.
    pub fn apply_transposed(&self, record: usize, column: &mut [f64]) {
        self.whiteners[record].apply_transposed(column);
        column.iter_mut().for_each(|x| *x *= self.scale[record]);
    }

    /// Misfit Σ p |W e|²/σ² of a residual.
    pub fn misfit(&self, residual: &[Vec<f64>]) -> f64 {
        let square = |(record, residual): (usize, &Vec<f64>)| {
            let mut white = residual.clone();
            self.apply(record, &mut [&mut white]);
            dot(&white, &white)
        };
        residual.iter().enumerate().map(square).sum()
    }
}
