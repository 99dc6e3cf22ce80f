//! A linearised structure under one law of the noise, and what shapes behind its unknowns explain.
//!
//! −2 log p = (n − p) log s² + RSS/s² − (n − p) + Σ log S + log det(XᵀV⁻¹X) + Σ price, with s² = RSS/(n − p), or the
//! least that noise can be, and the p unknowns X that are integrated out: base, initial states and what is beside them.
//! The coefficient of an effect or a shape pays max(log n, log(1 + t²)) + 1 with its t value behind those before it, a
//! shape the logarithm of the places and forms that were tried, a law log n for each of its parameters.

use estimation::column::dot;

use crate::linear::{HeadingSensitivities, Linear};
use crate::weights::Weights;

/// A share of its own square below which a column is one of the others.
const DEPENDENT: f64 = 1e-7;

/// The change of the headings for one coefficient, rad for rad, by record.
pub type HeadingColumn = Vec<(usize, Vec<f64>)>;

/// Residual and sensitivities of a structure, its unknowns in the order in which they are taken.
#[derive(Debug, Clone)]
pub struct LinearisedStructure {
    /// Residual and columns.
    pub linear: Linear,
    /// Unknowns that are integrated out; those behind them pay.
    pub integrated: usize,
    /// Precision of what is expected of the unknowns, and where they stand beside it.
    pub prior: Vec<(f64, f64)>,
    /// How far the unknowns that pay are from neutral.
    pub sizes: Vec<f64>,
    /// Least variance of the white noise of a row, in units of that of the weights: what no compass reads and no
    /// recorded rudder tells.
    pub least: f64,
}

impl LinearisedStructure {
    /// Squares of the unknowns that are integrated out, under white noise, with what is expected of them.
    fn squares(&self, scale: &[f64]) -> Vec<f64> {
        let mut squares: Vec<f64> = self.prior.iter().map(|(precision, _)| *precision).collect();
        for (block, scale) in self.linear.blocks.iter().zip(scale) {
            for (unknown, column) in block.columns.iter().filter(|(unknown, _)| *unknown < self.integrated) {
                squares[*unknown] += scale * scale * dot(column, column);
            }
        }
        squares
    }

    /// Number of headings.
    pub fn rows(&self) -> usize {
        self.linear.blocks.iter().map(|block| block.residual.len()).sum()
    }
}

/// The same under a law.
#[derive(Debug, Clone)]
pub struct Conditioned {
    blocks: Vec<HeadingSensitivities>,
    /// Rows of the lower factor of the products of all columns, and its solution for the residual.
    factor: Vec<Vec<f64>>,
    solution: Vec<f64>,
    /// What every coefficient that pays stands at, in its standard deviations times s.
    paid: Vec<f64>,
    /// RSS of the whitened residual.
    square: f64,
    /// What does not depend on the shapes: Σ log S, log det, and the price of the law.
    fixed: f64,
    /// n − p and log n.
    freedom: f64,
    log_n: f64,
    /// Least s².
    least: f64,
}

/// Products of columns behind the unknowns of a structure: with these, with each other, and with the residual.
#[derive(Debug, Clone)]
pub struct ColumnProducts {
    /// With the unknowns, column by column.
    pub cross: Vec<Vec<f64>>,
    gram: Vec<Vec<f64>>,
    gradient: Vec<f64>,
}

/// Product of two columns.
pub fn product(one: &HeadingColumn, other: &HeadingColumn) -> f64 {
    let pairs = one.iter().flat_map(|(record, values)| {
        other.iter().filter(move |(own, _)| own == record).map(move |(_, own)| dot(own, values))
    });
    pairs.sum()
}

/// What shapes add to a [`Conditioned`].
struct Extension {
    factor: Vec<Vec<f64>>,
    solution: Vec<f64>,
}

impl Conditioned {
    /// A structure under a law of so many parameters; `None` where its unknowns cannot be told apart.
    pub fn new(structure: &LinearisedStructure, weights: &Weights, law_freedom: usize) -> Option<Self> {
        let blocks = structure.linear.blocks.iter().enumerate();
        let blocks: Vec<HeadingSensitivities> = blocks.map(|(record, block)| block.white(record, weights)).collect();
        let count = structure.linear.unknowns;
        let (mut matrix, mut gradient, mut square) = (vec![vec![0.0; count]; count], vec![0.0; count], 0.0);
        for block in &blocks {
            for (k, (i, column)) in block.columns.iter().enumerate() {
                for (j, other) in &block.columns[..=k] {
                    matrix[(*i).max(*j)][(*i).min(*j)] += dot(column, other);
                }
                gradient[*i] += dot(column, &block.residual);
            }
            square += dot(&block.residual, &block.residual);
        }
        for (k, &(precision, beside)) in structure.prior.iter().enumerate() {
            matrix[k][k] += precision;
            gradient[k] -= precision * beside;
            square += precision * beside * beside;
        }
        let factor = factor(&matrix, &[])?;
        let solution = solved(&factor, &gradient, &[]);
        let rows = structure.rows() as f64;
        let (freedom, log_n) = (rows - structure.integrated as f64, rows.ln());
        let weights_rows = weights.whiteners.iter().zip(&weights.scale).zip(&blocks);
        let log_variance: f64 = weights_rows
            .map(|((own, scale), block)| own.log_variance - 2.0 * block.residual.len() as f64 * scale.ln())
            .sum();
        let squares = structure.squares(&weights.scale);
        let volume: f64 = (0..structure.integrated).map(|k| 2.0 * factor[k][k].ln() - squares[k].ln()).sum();
        let fixed = log_variance + volume + law_freedom as f64 * log_n;
        let (paid, least) = (Vec::new(), structure.least);
        square -= dot(&solution, &solution);
        let mut all = Self { blocks, factor, solution, paid, square, fixed, freedom, log_n, least };
        all.paid = (structure.integrated..count)
            .map(|k| {
                let sizes = structure.sizes.iter().enumerate().skip(k - structure.integrated);
                let away: f64 = sizes.map(|(j, size)| all.factor[structure.integrated + j][k] * size).sum();
                all.solution[k] + away
            })
            .collect();
        Some(all)
    }

    /// −2 log p.
    pub fn height(&self) -> f64 {
        self.height_with(&[], self.square)
    }

    /// The same with coefficients behind it that leave a square.
    fn height_with(&self, behind: &[f64], square: f64) -> f64 {
        let variance = (square / self.freedom).max(self.least);
        let price = |c: &f64| self.log_n.max((c * c / variance).ln_1p()) + 1.0;
        let misfit = square / variance - self.freedom;
        let prices: f64 = self.paid.iter().chain(behind).map(price).sum();
        self.freedom * variance.ln() + misfit + self.fixed + prices
    }

    /// −2 log p with white columns behind it; infinite where they are some of those before.
    pub fn height_of(&self, columns: &[HeadingColumn]) -> f64 {
        self.height_of_products(&self.products(columns))
    }

    fn square_with(&self, solution: &[f64]) -> f64 {
        (self.square - dot(solution, solution)).max(1e-9 * self.square)
    }

    /// The structure with white columns behind it.
    pub fn extended(&self, columns: &[HeadingColumn]) -> Option<Self> {
        let extension = self.extension(&self.products(columns))?;
        let mut next = self.clone();
        for (k, column) in columns.iter().enumerate() {
            for (record, values) in column {
                next.blocks[*record].columns.push((self.factor.len() + k, values.clone()));
            }
        }
        next.square = self.square_with(&extension.solution);
        next.factor.extend(extension.factor);
        next.paid.extend_from_slice(&extension.solution);
        next.solution.extend(extension.solution);
        Some(next)
    }

    /// Products of white columns with the unknowns, with each other, and with the residual.
    pub fn products(&self, columns: &[HeadingColumn]) -> ColumnProducts {
        let count = self.factor.len();
        let mut all = ColumnProducts { cross: Vec::new(), gram: Vec::new(), gradient: Vec::new() };
        for (k, column) in columns.iter().enumerate() {
            let (mut cross, mut with) = (vec![0.0; count], 0.0);
            for (record, values) in column {
                let block = &self.blocks[*record];
                block.columns.iter().for_each(|(unknown, own)| cross[*unknown] += dot(own, values));
                with += dot(&block.residual, values);
            }
            all.cross.push(cross);
            all.gradient.push(with);
            all.gram.push(columns[..=k].iter().map(|other| product(column, other)).collect());
        }
        all
    }

    /// −2 log p with columns of these products behind it; infinite where they are some of those before.
    pub fn height_of_products(&self, products: &ColumnProducts) -> f64 {
        let extension = self.extension(products);
        extension.map_or(f64::INFINITY, |own| self.height_with(&own.solution, self.square_with(&own.solution)))
    }

    /// Rows of the factor, and of its solution, for columns behind all others.
    fn extension(&self, products: &ColumnProducts) -> Option<Extension> {
        let rows = products.cross.iter().zip(&products.gram).map(|(cross, gram)| [cross.as_slice(), gram].concat());
        let factor = factor(&rows.collect::<Vec<_>>(), &self.factor)?;
        let solution = solved(&factor, &products.gradient, &self.solution);
        Some(Extension { factor, solution })
    }

    /// The step of all unknowns from where they stand.
    pub fn step(&self) -> Vec<f64> {
        let count = self.factor.len();
        let mut step = self.solution.clone();
        for k in (0..count).rev() {
            step[k] /= self.factor[k][k];
            let moved = step[k];
            (0..k).for_each(|j| step[j] -= self.factor[k][j] * moved);
        }
        step
    }

    /// Standard deviation of the white noise of a row, in units of that of the weights.
    pub fn sd(&self) -> f64 {
        (self.square / self.freedom).sqrt()
    }

    /// What is new in every heading of the records, over its standard deviation.
    pub fn innovations(&self) -> Vec<Vec<f64>> {
        let (step, sd) = (self.step(), self.sd());
        let of = |block: &HeadingSensitivities| {
            let mut left = block.residual.clone();
            for (unknown, column) in &block.columns {
                left.iter_mut().zip(column).for_each(|(e, x)| *e -= step[*unknown] * x);
            }
            left.iter_mut().for_each(|e| *e /= sd);
            left
        };
        self.blocks.iter().map(of).collect()
    }
}

/// Rows of the lower factor of a symmetric matrix behind those of a `known` part; `None` where it is singular.
fn factor(matrix: &[Vec<f64>], known: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(matrix.len());
    for (k, source) in matrix.iter().enumerate() {
        let here = known.len() + k;
        let mut row = vec![0.0; here + 1];
        for j in 0..here {
            let other = if j < known.len() { &known[j] } else { &rows[j - known.len()] };
            row[j] = (source[j] - dot(&row[..j], &other[..j])) / other[j];
        }
        let left = source[here] - dot(&row[..here], &row[..here]);
        if !(left > DEPENDENT * source[here] && left > 0.0) {
            return None;
        }
        row[here] = left.sqrt();
        rows.push(row);
    }
    Some(rows)
}

/// L⁻¹ of a right side in the rows of a lower factor behind those of a `known` solution.
fn solved(factor: &[Vec<f64>], right: &[f64], known: &[f64]) -> Vec<f64> {
    let count = known.len();
    let mut solution: Vec<f64> = Vec::with_capacity(right.len());
    for (k, row) in factor.iter().enumerate() {
        let before = dot(&row[..count], known) + dot(&row[count..count + k], &solution);
        solution.push((right[k] - before) / row[count + k]);
    }
    solution
}
