//! Residual and sensitivities at one point as linear equations: whitened, extended by columns, solved.

use std::ops::Range;

use lanes::column::dot;
use nalgebra::{DMatrix, DVector};

use crate::noise::Whitener;

/// A column of every record; `None` where its unknown does not act.
pub type Column = Vec<Option<Vec<f64>>>;

/// Residual and sensitivities at one point, record by record.
#[derive(Debug, Clone)]
pub struct Linear {
    pub(super) blocks: Vec<Block>,
    pub(super) unknowns: usize,
}

#[derive(Debug, Clone)]
pub(super) struct Block {
    pub residual: Vec<f64>,
    /// Place of the unknown and its column.
    pub columns: Vec<(usize, Vec<f64>)>,
}

/// Whitened columns of every record, with the products of all pairs.
#[derive(Debug, Clone)]
pub struct Columns {
    blocks: Vec<Vec<(usize, Vec<f64>)>>,
    pub(super) matrix: DMatrix<f64>,
}

impl Columns {
    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.matrix.nrows()
    }

    /// Places of the unknowns that act in one record, with their whitened columns.
    pub fn of_record(&self, record: usize) -> impl Iterator<Item = (usize, &[f64])> {
        self.blocks[record].iter().map(|(place, column)| (*place, column.as_slice()))
    }

    /// Makes room for unknowns at a place and fills it with columns, which are whitened first.
    pub fn insert(&mut self, at: usize, new: &[Column], whiteners: &[Whitener]) {
        let count = new.len();
        self.matrix = std::mem::take(&mut self.matrix).insert_rows(at, count, 0.0).insert_columns(at, count, 0.0);
        for (record, (columns, whitener)) in self.blocks.iter_mut().zip(whiteners).enumerate() {
            let known = columns.len();
            for (place, _) in columns.iter_mut() {
                *place += if *place >= at { count } else { 0 };
            }
            let acting = new.iter().enumerate().filter_map(|(k, column)| Some((at + k, column[record].clone()?)));
            columns.extend(acting);
            whiten_columns(&mut columns[known..], whitener);
            gram(columns, known, &mut self.matrix);
        }
    }

    /// Changes the columns as little as possible so that they tell what a step has done to the whitened residual.
    pub(super) fn learn(&mut self, step: &DVector<f64>, before: &[Vec<f64>], after: &[Vec<f64>]) {
        let weight: Vec<f64> = (0..step.len()).map(|k| step[k] * self.matrix[(k, k)]).collect();
        let length: f64 = weight.iter().zip(step.iter()).map(|(w, s)| w * s).sum();
        if length.is_nan() || length <= 0.0 {
            return;
        }
        self.matrix.fill(0.0);
        for ((columns, before), after) in self.blocks.iter_mut().zip(before).zip(after) {
            let mut missed: Vec<f64> = before.iter().zip(after).map(|(before, after)| before - after).collect();
            for (at, column) in columns.iter() {
                missed.iter_mut().zip(column).for_each(|(missed, c)| *missed -= step[*at] * c);
            }
            for (at, column) in columns.iter_mut() {
                let share = weight[*at] / length;
                column.iter_mut().zip(&missed).for_each(|(c, missed)| *c += share * missed);
            }
            gram(columns, 0, &mut self.matrix);
        }
    }

    /// Normal equations with a whitened residual.
    pub(crate) fn normal(&self, white: &[Vec<f64>]) -> Normal {
        let mut gradient = DVector::zeros(self.unknowns());
        let mut rss = 0.0;
        for (columns, white) in self.blocks.iter().zip(white) {
            for (at, column) in columns {
                gradient[*at] += dot(column, white);
            }
            rss += dot(white, white);
        }
        Normal { matrix: self.matrix.clone(), gradient, rss }
    }

    /// Normal equations of the rows of one of `parts` parts of every record, which are as even as the rows allow.
    pub(crate) fn normal_of_part(&self, white: &[Vec<f64>], part: usize, parts: usize) -> Normal {
        let count = self.unknowns();
        let (mut matrix, mut gradient, mut rss) = (DMatrix::zeros(count, count), DVector::zeros(count), 0.0);
        for (columns, white) in self.blocks.iter().zip(white) {
            let rows = part_of(white.len(), part, parts);
            let own: Vec<(usize, Vec<f64>)> =
                columns.iter().map(|(at, column)| (*at, column[rows.clone()].to_vec())).collect();
            gram(&own, 0, &mut matrix);
            let white = &white[rows];
            own.iter().for_each(|(at, column)| gradient[*at] += dot(column, white));
            rss += dot(white, white);
        }
        Normal { matrix, gradient, rss }
    }

    /// Covariance of the unknowns for unit variance of the whitened residual; `None` when they cannot be told apart.
    pub fn covariance(&self) -> Option<DMatrix<f64>> {
        let scale = scales(&self.matrix);
        let n = self.unknowns();
        let scaled = DMatrix::from_fn(n, n, |i, j| self.matrix[(i, j)] * scale[i] * scale[j]);
        let inverse = scaled.cholesky()?.inverse();
        Some(DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * scale[i] * scale[j]))
    }

    /// Whitened residual times whitened columns, one column an unknown, for every record: the scores of the likelihood.
    pub fn scores(&self, white: &[Vec<f64>]) -> Vec<Vec<Vec<f64>>> {
        let of_record = |(columns, white): (&Vec<(usize, Vec<f64>)>, &Vec<f64>)| {
            let mut scores = vec![vec![0.0; white.len()]; self.unknowns()];
            for (at, column) in columns {
                scores[*at].iter_mut().zip(column.iter().zip(white)).for_each(|(score, (c, e))| *score = c * e);
            }
            scores
        };
        self.blocks.iter().zip(white).map(of_record).collect()
    }
}

/// The rows of one of `parts` parts of a record of `rows` rows.
pub(crate) fn part_of(rows: usize, part: usize, parts: usize) -> Range<usize> {
    rows * part / parts..rows * (part + 1) / parts
}

/// Normal equations of whitened columns.
pub(crate) struct Normal {
    pub matrix: DMatrix<f64>,
    pub gradient: DVector<f64>,
    pub rss: f64,
}

impl Normal {
    /// RSS after the best linear step in the first `unknowns`.
    pub fn projected(&self, unknowns: usize) -> f64 {
        let matrix = self.matrix.view((0, 0), (unknowns, unknowns)).into_owned();
        let gradient = self.gradient.rows(0, unknowns).into_owned();
        let gain = solve(&matrix, &gradient, 0.0).map_or(0.0, |step| step.dot(&gradient));
        (self.rss - gain).max(0.0)
    }
}

impl Linear {
    /// The residual of every record.
    pub fn into_residual(self) -> Vec<Vec<f64>> {
        self.blocks.into_iter().map(|block| block.residual).collect()
    }

    /// The column of an unknown in one record; zeros where it does not act.
    pub fn column(&self, record: usize, place: usize) -> Vec<f64> {
        let Block { residual, columns } = &self.blocks[record];
        let found = columns.iter().find(|(at, _)| *at == place);
        found.map_or_else(|| vec![0.0; residual.len()], |(_, column)| column.clone())
    }

    /// The residual of every record, whitened.
    pub fn whitened_residual(&self, whiteners: &[Whitener]) -> Vec<Vec<f64>> {
        let residual: Vec<Vec<f64>> = self.blocks.iter().map(|block| block.residual.clone()).collect();
        whiten(&residual, whiteners)
    }

    /// Leaves out the columns of some unknowns, which stay in place.
    pub fn without(mut self, unknowns: Range<usize>) -> Self {
        for block in &mut self.blocks {
            block.columns.retain(|(place, _)| !unknowns.contains(place));
        }
        self
    }

    /// The columns, whitened.
    pub fn whitened(&self, whiteners: &[Whitener]) -> Columns {
        let mut matrix = DMatrix::zeros(self.unknowns, self.unknowns);
        let whitened = |(block, whitener): (&Block, &Whitener)| {
            let mut columns = block.columns.clone();
            whiten_columns(&mut columns, whitener);
            gram(&columns, 0, &mut matrix);
            columns
        };
        Columns { blocks: self.blocks.iter().zip(whiteners).map(whitened).collect(), matrix }
    }

    /// RSS after the best linear step under these whiteners.
    pub fn projected(&self, whiteners: &[Whitener]) -> f64 {
        self.whitened(whiteners).normal(&self.whitened_residual(whiteners)).projected(self.unknowns)
    }
}

/// Logarithm of the determinant of normal equations, without unknowns that do not act.
pub(crate) fn log_determinant(matrix: &DMatrix<f64>) -> f64 {
    let scale = scales(matrix);
    let n = matrix.nrows();
    let scaled = DMatrix::from_fn(n, n, |i, j| {
        let own = if i == j { 1e-11 + if scale[i] == 0.0 { 1.0 } else { 0.0 } } else { 0.0 };
        matrix[(i, j)] * scale[i] * scale[j] + own
    });
    let of_scales: f64 = scale.iter().filter(|scale| **scale > 0.0).map(|scale| scale.ln()).sum();
    scaled.cholesky().map_or(0.0, |factor| factor.ln_determinant()) - 2.0 * of_scales
}

/// Σ log S of all records.
pub(crate) fn log_variance(whiteners: &[Whitener]) -> f64 {
    whiteners.iter().map(|whitener| whitener.log_variance).sum()
}

/// Whether a column changes the heading anywhere.
pub(crate) fn acts(column: &Column) -> bool {
    column.iter().flatten().flatten().any(|&x| x != 0.0)
}

/// Whitened copies of a column of every record.
pub(crate) fn whiten(columns: &[Vec<f64>], whiteners: &[Whitener]) -> Vec<Vec<f64>> {
    let mut white = columns.to_vec();
    white.iter_mut().zip(whiteners).for_each(|(column, whitener)| whitener.apply(&mut [column]));
    white
}

fn whiten_columns(columns: &mut [(usize, Vec<f64>)], whitener: &Whitener) {
    let mut all: Vec<&mut Vec<f64>> = columns.iter_mut().map(|(_, column)| column).collect();
    whitener.apply(&mut all);
}

/// Adds the products of all pairs of columns of which the second is not among the first `known`.
fn gram(columns: &[(usize, Vec<f64>)], known: usize, matrix: &mut DMatrix<f64>) {
    for (k, (i, one)) in columns.iter().enumerate().skip(known) {
        for (j, other) in &columns[..=k] {
            let product = dot(one, other);
            matrix[(*i, *j)] += product;
            if i != j {
                matrix[(*j, *i)] += product;
            }
        }
    }
}

/// One over the length of every column; 0 for a column of zeros.
fn scales(matrix: &DMatrix<f64>) -> Vec<f64> {
    (0..matrix.nrows())
        .map(|i| {
            let length = matrix[(i, i)].sqrt();
            if length > 0.0 && length.is_finite() { length.recip() } else { 0.0 }
        })
        .collect()
}

/// Solves the damped normal equations in scaled unknowns. Directions that the record does not see are left alone.
pub(super) fn solve(matrix: &DMatrix<f64>, gradient: &DVector<f64>, damping: f64) -> Option<DVector<f64>> {
    let n = matrix.nrows();
    let scale = scales(matrix);
    // 1e-11 on the diagonal keeps parallel columns solvable and moves no estimate by more than its rounding.
    let scaled = DMatrix::from_fn(n, n, |i, j| {
        let own = if i == j { damping + 1e-11 + if scale[i] == 0.0 { 1.0 } else { 0.0 } } else { 0.0 };
        matrix[(i, j)] * scale[i] * scale[j] + own
    });
    let right = DVector::from_fn(n, |i, _| gradient[i] * scale[i]);
    let step = scaled.cholesky()?.solve(&right);
    let step = DVector::from_fn(n, |i, _| step[i] * scale[i]);
    step.iter().all(|x| x.is_finite()).then_some(step)
}
