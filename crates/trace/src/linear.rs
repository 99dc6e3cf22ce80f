//! Residual and sensitivities of the records, and their normal equations.

use estimation::column::dot;
use estimation::levenberg_marquardt::Normal;
use nalgebra::DVector;
use rayon::prelude::*;
use ship::DIRECTIONS;
use ship::Tangent;

use crate::model::{Structure, headings};
use crate::record::PreparedRecord;
use crate::weights::Weights;

/// Residual and sensitivities of one record.
#[derive(Debug, Clone)]
pub struct HeadingSensitivities {
    /// Measured less replayed heading, rad.
    pub residual: Vec<f64>,
    /// Unknowns that act, each with the change of the heading.
    pub columns: Vec<(usize, Vec<f64>)>,
}

impl HeadingSensitivities {
    /// The same, made white and of unit variance.
    pub fn white(&self, record: usize, weights: &Weights) -> Self {
        let mut white = self.clone();
        let mut all: Vec<&mut Vec<f64>> = white.columns.iter_mut().map(|(_, column)| column).collect();
        all.push(&mut white.residual);
        weights.apply(record, &mut all);
        white
    }

    /// Products of its columns with another one, by unknown.
    pub fn products(&self, column: &[f64], sums: &mut DVector<f64>) {
        self.columns.iter().for_each(|(unknown, own)| sums[*unknown] += dot(own, column));
    }
}

/// Replays one record with derivatives by some variables: their unknown, and their place in θ and behind it.
pub fn tangents(
    structure: &Structure,
    record: &PreparedRecord,
    number: usize,
    theta: &[f64],
    initial: [f64; 2],
    variables: &[(usize, usize)],
) -> HeadingSensitivities {
    let rows = record.observed.len();
    let constant: Vec<Tangent> = theta.iter().chain(&initial).map(|&value| Tangent::from(value)).collect();
    let pass = |variables: &[(usize, usize)]| {
        let mut point = constant.clone();
        for (direction, &(_, place)) in variables.iter().enumerate() {
            point[place] = Tangent::variable(point[place].value, direction, 1.0);
        }
        let (theta, initial) = point.split_at(theta.len());
        let response = structure.response(Some(number), theta);
        let (mut residual, mut columns) = (vec![0.0; rows], vec![vec![0.0; rows]; variables.len()]);
        headings(&response, record, [initial[0], initial[1]], |row, heading| {
            residual[row] = record.heading[record.observed[row]] - heading.value;
            columns.iter_mut().zip(heading.by).for_each(|(column, by)| column[row] = by);
        });
        (residual, columns)
    };
    let passes: Vec<_> = variables.par_chunks(DIRECTIONS).map(pass).collect();
    let residual = passes[0].0.clone();
    let columns = passes.into_iter().flat_map(|(_, columns)| columns);
    HeadingSensitivities { residual, columns: variables.iter().map(|(unknown, _)| *unknown).zip(columns).collect() }
}

/// Residual and sensitivities of all records.
#[derive(Debug, Clone)]
pub struct Linear {
    /// One block a record.
    pub blocks: Vec<HeadingSensitivities>,
    /// Number of unknowns.
    pub unknowns: usize,
}

impl Linear {
    /// Normal equations under weights, and |e|² of every record.
    pub fn normal(&self, weights: &Weights) -> (Normal, Vec<f64>) {
        let (mut normal, mut squares) = (Normal::zeros(self.unknowns), Vec::with_capacity(self.blocks.len()));
        for (record, block) in self.blocks.iter().enumerate() {
            let HeadingSensitivities { residual, columns } = block.white(record, weights);
            for (k, (i, one)) in columns.iter().enumerate() {
                for (j, other) in &columns[..=k] {
                    let product = dot(one, other);
                    normal.matrix[(*i, *j)] += product;
                    if i != j {
                        normal.matrix[(*j, *i)] += product;
                    }
                }
                normal.gradient[*i] += dot(one, &residual);
            }
            squares.push(dot(&residual, &residual));
        }
        (normal, squares)
    }
}
