//! Residual and sensitivities at one point as linear equations: whitened, extended by columns, solved.

use nalgebra::{DMatrix, DVector};

use crate::noise::Whitener;

/// Residual and sensitivities at one point, record by record.
#[derive(Debug, Clone)]
pub struct Linear {
    pub(super) blocks: Vec<Block>,
    pub(super) unknowns: usize,
    /// Replays that were needed.
    pub(super) replays: usize,
}

#[derive(Debug, Clone)]
pub(super) struct Block {
    pub residual: Vec<f64>,
    /// Place of the unknown and its column.
    pub columns: Vec<(usize, Vec<f64>)>,
}

/// Whitened columns of every record.
pub(super) struct Columns {
    blocks: Vec<Vec<(usize, Vec<f64>)>>,
    pub matrix: DMatrix<f64>,
}

impl Columns {
    /// Changes the columns as little as possible so that they tell what a step has done to the residual.
    pub(super) fn learn(
        &mut self,
        step: &DVector<f64>,
        before: &[Vec<f64>],
        after: &[Vec<f64>],
        whiteners: &[Whitener],
    ) {
        let weight: Vec<f64> = (0..step.len()).map(|k| step[k] * self.matrix[(k, k)]).collect();
        let length: f64 = weight.iter().zip(step.iter()).map(|(w, s)| w * s).sum();
        if length.is_nan() || length <= 0.0 {
            return;
        }
        self.matrix.fill(0.0);
        for (((columns, before), after), whitener) in self.blocks.iter_mut().zip(before).zip(after).zip(whiteners) {
            let mut missed: Vec<f64> = before.iter().zip(after).map(|(before, after)| before - after).collect();
            whitener.apply(&mut missed);
            for (at, column) in columns.iter() {
                missed.iter_mut().zip(column).for_each(|(missed, c)| *missed -= step[*at] * c);
            }
            for (at, column) in columns.iter_mut() {
                let share = weight[*at] / length;
                column.iter_mut().zip(&missed).for_each(|(c, missed)| *c += share * missed);
            }
            gram(columns, &mut self.matrix);
        }
    }

    /// Normal equations with a residual, which is not whitened yet.
    pub(super) fn normal(&self, residual: &[Vec<f64>], whiteners: &[Whitener]) -> Normal {
        let mut gradient = DVector::zeros(self.matrix.nrows());
        let (mut rss, mut log_variance) = (0.0, 0.0);
        for ((columns, residual), whitener) in self.blocks.iter().zip(residual).zip(whiteners) {
            let mut residual = residual.clone();
            whitener.apply(&mut residual);
            for (at, column) in columns {
                gradient[*at] += dot(column, &residual);
            }
            rss += dot(&residual, &residual);
            log_variance += whitener.log_variance;
        }
        Normal { matrix: self.matrix.clone(), gradient, rss, log_variance }
    }
}

/// Normal equations of whitened columns.
pub(super) struct Normal {
    pub matrix: DMatrix<f64>,
    pub gradient: DVector<f64>,
    rss: f64,
    log_variance: f64,
}

impl Linear {
    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Adds columns that belong to one more unknown, one per record.
    pub fn push(&mut self, columns: Vec<Option<Vec<f64>>>) {
        let place = self.unknowns;
        self.unknowns += 1;
        for (block, column) in self.blocks.iter_mut().zip(columns) {
            if let Some(column) = column {
                block.columns.push((place, column));
            }
        }
    }

    /// Makes room for unknowns at a place and fills it with columns, one per record each.
    pub fn insert(&mut self, at: usize, new: Vec<Vec<Option<Vec<f64>>>>) {
        let count = new.len();
        for block in &mut self.blocks {
            for (place, _) in &mut block.columns {
                *place += if *place >= at { count } else { 0 };
            }
        }
        for (k, columns) in new.into_iter().enumerate() {
            for (block, column) in self.blocks.iter_mut().zip(columns) {
                block.columns.extend(column.map(|column| (at + k, column)));
            }
        }
        self.unknowns += count;
    }

    /// Leaves out the columns of some unknowns, which stay in place.
    pub fn without(mut self, unknowns: std::ops::Range<usize>) -> Self {
        for block in &mut self.blocks {
            block.columns.retain(|(place, _)| !unknowns.contains(place));
        }
        self
    }

    /// Replaces the residual of every record.
    pub fn with_residual(mut self, residual: Vec<Vec<f64>>) -> Self {
        for (block, residual) in self.blocks.iter_mut().zip(residual) {
            block.residual = residual;
        }
        self
    }

    /// Whitened columns and residual of one record.
    pub fn whitened_block(&self, record: usize, whitener: &Whitener) -> Option<(Vec<Vec<f64>>, Vec<f64>)> {
        let block = self.blocks.get(record)?;
        let white = |column: &[f64]| {
            let mut column = column.to_vec();
            whitener.apply(&mut column);
            column
        };
        Some((block.columns.iter().map(|(_, column)| white(column)).collect(), white(&block.residual)))
    }

    pub(super) fn whitened(&self, whiteners: &[Whitener]) -> Columns {
        let n = self.unknowns;
        let mut matrix = DMatrix::zeros(n, n);
        let blocks: Vec<Vec<(usize, Vec<f64>)>> = self
            .blocks
            .iter()
            .zip(whiteners)
            .map(|(block, whitener)| {
                let white = |(at, column): &(usize, Vec<f64>)| {
                    let mut column = column.clone();
                    whitener.apply(&mut column);
                    (*at, column)
                };
                let columns: Vec<(usize, Vec<f64>)> = block.columns.iter().map(white).collect();
                gram(&columns, &mut matrix);
                columns
            })
            .collect();
        Columns { blocks, matrix }
    }

    pub(super) fn normal(&self, whiteners: &[Whitener]) -> Normal {
        let residual: Vec<Vec<f64>> = self.blocks.iter().map(|block| block.residual.clone()).collect();
        self.whitened(whiteners).normal(&residual, whiteners)
    }

    /// RSS after the best linear step under these whiteners, and Σ log S.
    pub fn projected(&self, whiteners: &[Whitener]) -> (f64, f64) {
        let normal = self.normal(whiteners);
        let gain = solve(&normal.matrix, &normal.gradient, 0.0).map_or(0.0, |step| step.dot(&normal.gradient));
        ((normal.rss - gain).max(0.0), normal.log_variance)
    }

    /// RSS left by every leading set of unknowns: with none, and with the first `from`, `from + 1`, … all of them.
    pub fn explained(&self, whiteners: &[Whitener], from: usize) -> (f64, f64) {
        let normal = self.normal(whiteners);
        let part = |n: usize| {
            let matrix = normal.matrix.view((0, 0), (n, n)).into_owned();
            let gradient = normal.gradient.rows(0, n).into_owned();
            let gain = solve(&matrix, &gradient, 0.0).map_or(0.0, |step| step.dot(&gradient));
            (normal.rss - gain).max(0.0)
        };
        (part(from), part(self.unknowns))
    }

    /// Covariance of the unknowns for unit variance of the whitened residual; `None` when they cannot be told apart.
    pub fn covariance(&self, whiteners: &[Whitener]) -> Option<DMatrix<f64>> {
        let normal = self.normal(whiteners);
        let scale = scales(&normal.matrix);
        let n = self.unknowns;
        let scaled = DMatrix::from_fn(n, n, |i, j| normal.matrix[(i, j)] * scale[i] * scale[j]);
        let inverse = scaled.cholesky()?.inverse();
        Some(DMatrix::from_fn(n, n, |i, j| inverse[(i, j)] * scale[i] * scale[j]))
    }

    /// Whitened residual times whitened columns, one column an unknown, for every record: the scores of the likelihood.
    pub fn scores(&self, whiteners: &[Whitener]) -> Vec<Vec<Vec<f64>>> {
        let of_block = |(block, whitener): (&Block, &Whitener)| {
            let mut residual = block.residual.clone();
            whitener.apply(&mut residual);
            let mut scores = vec![vec![0.0; residual.len()]; self.unknowns];
            for (at, column) in &block.columns {
                scores[*at].copy_from_slice(column);
                whitener.apply(&mut scores[*at]);
                scores[*at].iter_mut().zip(&residual).for_each(|(score, e)| *score *= e);
            }
            scores
        };
        self.blocks.iter().zip(whiteners).map(of_block).collect()
    }
}

/// Adds the products of all pairs of columns.
fn gram(columns: &[(usize, Vec<f64>)], matrix: &mut DMatrix<f64>) {
    for (k, (i, one)) in columns.iter().enumerate() {
        for (j, other) in &columns[..=k] {
            let product = dot(one, other);
            matrix[(*i, *j)] += product;
            if i != j {
                matrix[(*j, *i)] += product;
            }
        }
    }
}

pub(crate) fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(x, y)| x * y).sum()
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
    // A hair on the diagonal keeps parallel columns solvable; it moves no estimate by more than its rounding.
    let scaled = DMatrix::from_fn(n, n, |i, j| {
        let own = if i == j { damping + 1e-11 + if scale[i] == 0.0 { 1.0 } else { 0.0 } } else { 0.0 };
        matrix[(i, j)] * scale[i] * scale[j] + own
    });
    let right = DVector::from_fn(n, |i, _| gradient[i] * scale[i]);
    let step = scaled.cholesky()?.solve(&right);
    let step = DVector::from_fn(n, |i, _| step[i] * scale[i]);
    step.iter().all(|x| x.is_finite()).then_some(step)
}
