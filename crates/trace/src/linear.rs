//! Linearisation of the headings: residual and sensitivities of the records, and their normal equations.

use estimation::column::dot;
use estimation::levenberg_marquardt::NormalEquations;
use nalgebra::DVector;
use rayon::prelude::*;
use ship::TANGENT_DERIVATIVES;
use ship::Tangent;

use crate::model::{Structure, replay_headings};
use crate::noise_law::RecordWhitening;
use crate::record::PreparedRecord;

/// Heading residual and sensitivities of one record.
#[derive(Debug, Clone)]
pub struct HeadingSensitivities {
    /// Residual (measured minus replayed heading), rad.
    pub residual: Vec<f64>,
    /// Index of every unknown that acts in the record, with the derivative of the heading with respect to it.
    pub columns: Vec<(usize, Vec<f64>)>,
}

impl HeadingSensitivities {
    /// Whitened residual and columns.
    pub fn whitened(&self, record: usize, whitening: &RecordWhitening) -> Self {
        let mut white = self.clone();
        let mut all: Vec<&mut Vec<f64>> = white.columns.iter_mut().map(|(_, column)| column).collect();
        all.push(&mut white.residual);
        whitening.apply(record, &mut all);
        white
    }

    /// Adds the products of the columns with another column to `sums`, by unknown.
    pub fn products(&self, column: &[f64], sums: &mut DVector<f64>) {
        self.columns.iter().for_each(|(unknown, values)| sums[*unknown] += dot(values, column));
    }
}

/// Heading residual of record `number` and its sensitivities, from replays with forward derivatives (Griewank and
/// Walther 2008). A variable is given by the index of its unknown and its index in (θ, initial state).
pub fn heading_sensitivities(
    structure: &Structure,
    record: &PreparedRecord,
    number: usize,
    theta: &[f64],
    initial: [f64; 2],
    variables: &[(usize, usize)],
) -> HeadingSensitivities {
    let rows = record.observed_rows.len();
    let constant: Vec<Tangent> = theta.iter().chain(&initial).map(|&value| Tangent::from(value)).collect();
    let pass = |variables: &[(usize, usize)]| {
        let mut point = constant.clone();
        for (direction, &(_, place)) in variables.iter().enumerate() {
            point[place] = Tangent::variable(point[place].value, direction, 1.0);
        }
        let (theta, initial) = point.split_at(theta.len());
        let response = structure.response(Some(number), theta);
        let (mut residual, mut columns) = (vec![0.0; rows], vec![vec![0.0; rows]; variables.len()]);
        replay_headings(&response, record, [initial[0], initial[1]], |row, heading| {
            residual[row] = record.heading[record.observed_rows[row]] - heading.value;
            columns.iter_mut().zip(heading.derivatives).for_each(|(column, by)| column[row] = by);
        });
        (residual, columns)
    };
    let passes: Vec<_> = variables.par_chunks(TANGENT_DERIVATIVES).map(pass).collect();
    let residual = passes[0].0.clone();
    let columns = passes.into_iter().flat_map(|(_, columns)| columns);
    HeadingSensitivities { residual, columns: variables.iter().map(|(unknown, _)| *unknown).zip(columns).collect() }
}

/// Heading residual and sensitivities of all records.
#[derive(Debug, Clone)]
pub struct Linearisation {
    /// One block per record.
    pub blocks: Vec<HeadingSensitivities>,
    /// Number of unknowns.
    pub unknowns: usize,
}

impl Linearisation {
    /// Normal equations under a whitening, and the sum of squared whitened residuals of every record.
    pub fn normal_equations(&self, whitening: &RecordWhitening) -> (NormalEquations, Vec<f64>) {
        let (mut normal, mut squares) = (NormalEquations::zeros(self.unknowns), Vec::with_capacity(self.blocks.len()));
        for (record, block) in self.blocks.iter().enumerate() {
            let HeadingSensitivities { residual, columns } = block.whitened(record, whitening);
            for (k, (i, column)) in columns.iter().enumerate() {
                for (j, other) in &columns[..=k] {
                    let product = dot(column, other);
                    normal.matrix[(*i, *j)] += product;
                    if i != j {
                        normal.matrix[(*j, *i)] += product;
                    }
                }
                normal.right_hand_side[*i] += dot(column, &residual);
            }
            squares.push(dot(&residual, &residual));
        }
        (normal, squares)
    }
}
