//! The law of the noise, and what makes columns of a record white under it.

use estimation::column::dot;
use estimation::kalman::Whitener;

use crate::noise::{CorrelatedNoise, NoiseColour};

/// The law of the noise: one colour for all records, a size for each.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseLaw {
    /// Colour, in units of the white noise of a row.
    pub colour: NoiseColour,
    /// Variance of the white noise of a full row of every record, rad².
    pub variance: Vec<f64>,
    /// Power to which the likelihood of every record is raised: below one where the noise holds the error of a model,
    /// which more rows do not average out (coarsened posterior; Miller and Dunson 2019).
    pub power: Vec<f64>,
}

impl NoiseLaw {
    /// Whether it holds a smooth error of a model that is not quite that of the ship.
    pub fn is_of_model(&self) -> bool {
        matches!(self.colour.wander, Some((CorrelatedNoise::Smooth(_), _)))
    }

    /// Whether it holds a random moment.
    pub fn is_random_moment(&self) -> bool {
        self.colour.wander.is_some_and(|(kind, _)| !kind.is_of_heading())
    }

    /// Whether two laws are of one kind and about of one size.
    pub fn is_alike(&self, other: &Self) -> bool {
        let kind = |law: &Self| (law.colour.wander.map(|(kind, _)| kind), law.colour.waves.is_some());
        let size = |(one, two): (&f64, &f64)| (one / two).ln().abs() < 0.4;
        kind(self) == kind(other) && self.variance.iter().zip(&other.variance).all(size)
    }

    /// White noise of one variance, rad².
    pub fn white(records: usize, variance: f64) -> Self {
        Self { colour: NoiseColour::WHITE, variance: vec![variance; records], power: vec![1.0; records] }
    }
}

/// Filters of all records, and one over the standard deviation of their rows.
#[derive(Debug, Clone)]
pub struct Weights {
    /// Filters.
    pub whiteners: Vec<Whitener>,
    /// One over the standard deviation of the noise of a row, 1/rad.
    pub scale: Vec<f64>,
}

impl Weights {
    /// Makes columns of one record white and of unit variance.
    pub fn apply(&self, record: usize, columns: &mut [&mut Vec<f64>]) {
        self.whiteners[record].apply(columns);
        let scale = self.scale[record];
        columns.iter_mut().flat_map(|column| column.iter_mut()).for_each(|x| *x *= scale);
    }

    /// Applies the transpose of [`apply`](Self::apply) to a column of one record.
    pub fn apply_transposed(&self, record: usize, column: &mut [f64]) {
        self.whiteners[record].apply_transposed(column);
        column.iter_mut().for_each(|x| *x *= self.scale[record]);
    }

    /// Σ |W e|²/σ² of a residual.
    pub fn misfit(&self, residual: &[Vec<f64>]) -> f64 {
        let of = |(record, residual): (usize, &Vec<f64>)| {
            let mut white = residual.clone();
            self.apply(record, &mut [&mut white]);
            dot(&white, &white)
        };
        residual.iter().enumerate().map(of).sum()
    }
}
