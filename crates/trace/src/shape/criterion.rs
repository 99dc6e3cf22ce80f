//! Criterion of a linearised structure under one noise law, with the columns of shapes appended.
//!
//! −2 log p = (n − p) log s² + RSS/s² − (n − p) + Σ log S + log det(XᵀV⁻¹X) − Σ log |x|² + Σ penalties, with
//! s² = RSS/(n − p) or its lower bound. X has the columns x of the p integrated unknowns: base, initial states and
//! restarts behind gaps; |x| is the norm under white noise. The penalty of a coefficient of an effect or a shape is
//! max(log n, log(1 + t²)) + 1 with its sequential t value. The penalty of a shape is twice the logarithm of the
//! product of the numbers of places (or forms), records and classes among which it was chosen; that of a law is log n
//! per parameter.
//!
//! Sources: Schwarz (1978); Harvey (1989) for the marginal likelihood with the regression integrated out.

use estimation::column::dot;

use crate::linear::{HeadingSensitivities, Linearisation};
use crate::noise_law::RecordWhitening;

/// Minimum share of the square of a usable column that is linearly independent of the columns before.
const MIN_INDEPENDENT_SHARE: f64 = 1e-7;

/// Heading response to one coefficient by record, rad per rad of rudder.
pub type HeadingColumn = Vec<(usize, Vec<f64>)>;

/// Residual and sensitivities of a structure; integrated unknowns come first.
#[derive(Debug, Clone)]
pub struct LinearisedStructure {
    /// Heading residual and its sensitivities to the unknowns, by record.
    pub linear: Linearisation,
    /// Number of integrated unknowns; the coefficients after them are penalised.
    pub integrated: usize,
    /// Prior precision of the integrated unknowns and their offset from the prior mean.
    pub prior: Vec<(f64, f64)>,
    /// Distance of the penalised coefficients from neutral.
    pub departures_from_neutral: Vec<f64>,
    /// Lower bound of the white-noise variance of a row, in units of the variance of the whitening.
    pub min_variance: f64,
}

impl LinearisedStructure {
    /// Squares of the columns of the integrated unknowns under white noise, plus their prior precision.
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

/// Linearised structure, whitened and factorised under one noise law.
#[derive(Debug, Clone)]
pub struct WhitenedStructure {
    blocks: Vec<HeadingSensitivities>,
    /// Rows of the lower Cholesky factor L of the products of all columns.
    factor: Vec<Vec<f64>>,
    /// L⁻¹ times the gradient.
    solution: Vec<f64>,
    /// Sequential t values of the penalised coefficients, times s.
    t_values: Vec<f64>,
    /// Residual sum of squares.
    square: f64,
    /// Part of the criterion independent of the shapes: Σ log S + log det(XᵀV⁻¹X) − Σ log |x|² + penalty of the law.
    fixed: f64,
    /// Degrees of freedom n − p.
    freedom: f64,
    /// log n.
    log_n: f64,
    /// Lower bound of s².
    min_variance: f64,
}

/// Products of appended columns with the columns of a structure, with each other, and with its residual.
#[derive(Debug, Clone)]
pub struct GramProducts {
    /// Rows of the factor for the columns of the structure, by appended column; further products may follow.
    pub cross: Vec<Vec<f64>>,
    /// Number of entries of every row that belong to the factor.
    factored: usize,
    /// Products with each other.
    gram: Vec<Vec<f64>>,
    /// Products with the residual.
    gradient: Vec<f64>,
}

/// Scalar product of two columns.
pub fn product(a: &HeadingColumn, b: &HeadingColumn) -> f64 {
    let pairs = a.iter().flat_map(|(record, values)| {
        b.iter().filter(move |(other, _)| other == record).map(move |(_, column)| dot(column, values))
    });
    pairs.sum()
}

/// Rows of factor and solution for appended columns.
struct Extension {
    factor: Vec<Vec<f64>>,
    solution: Vec<f64>,
}

impl WhitenedStructure {
    /// Structure under a law with `law_parameter_count` parameters; `None` if its columns are dependent.
    pub fn new(
        structure: &LinearisedStructure,
        whitening: &RecordWhitening,
        law_parameter_count: usize,
    ) -> Option<Self> {
        let blocks = structure.linear.blocks.iter().enumerate();
        let blocks: Vec<HeadingSensitivities> =
            blocks.map(|(record, block)| block.whitened(record, whitening)).collect();
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
        for (k, &(precision, offset)) in structure.prior.iter().enumerate() {
            matrix[k][k] += precision;
            gradient[k] -= precision * offset;
            square += precision * offset * offset;
        }
        let factor = factor(&matrix, &[], 0)?;
        let solution = solve(&factor, &gradient, &[]);
        let rows = structure.rows() as f64;
        let (freedom, log_n) = (rows - structure.integrated as f64, rows.ln());
        let records = whitening.whiteners.iter().zip(&whitening.scale).zip(&blocks);
        let log_variance: f64 = records
            .map(|((whitener, scale), block)| whitener.log_determinant - 2.0 * block.residual.len() as f64 * scale.ln())
            .sum();
        let squares = structure.squares(&whitening.scale);
        let volume: f64 = (0..structure.integrated).map(|k| 2.0 * factor[k][k].ln() - squares[k].ln()).sum();
        let fixed = log_variance + volume + law_parameter_count as f64 * log_n;
        let (t_values, min_variance) = (Vec::new(), structure.min_variance);
        square -= dot(&solution, &solution);
        let mut all = Self { blocks, factor, solution, t_values, square, fixed, freedom, log_n, min_variance };
        all.t_values = (structure.integrated..count)
            .map(|k| {
                let sizes = structure.departures_from_neutral.iter().enumerate().skip(k - structure.integrated);
                let away: f64 = sizes.map(|(j, size)| all.factor[structure.integrated + j][k] * size).sum();
                all.solution[k] + away
            })
            .collect();
        Some(all)
    }

    /// Criterion −2 log p + penalties.
    pub fn criterion(&self) -> f64 {
        self.criterion_after(&[], self.square)
    }

    /// Criterion with appended t values and the residual sum of squares after them.
    fn criterion_after(&self, appended: &[f64], square: f64) -> f64 {
        let variance = (square / self.freedom).max(self.min_variance);
        let penalty = |c: &f64| self.log_n.max((c * c / variance).ln_1p()) + 1.0;
        let misfit = square / variance - self.freedom;
        let penalties: f64 = self.t_values.iter().chain(appended).map(penalty).sum();
        self.freedom * variance.ln() + misfit + self.fixed + penalties
    }

    /// Criterion with whitened columns appended; infinite if they are linearly dependent.
    pub fn criterion_with(&self, columns: &[HeadingColumn]) -> f64 {
        self.criterion_with_products(&self.products(columns))
    }

    /// Residual sum of squares with columns appended, from their components `solution`; at least 10⁻⁹ of that without.
    fn square_with(&self, solution: &[f64]) -> f64 {
        (self.square - dot(solution, solution)).max(1e-9 * self.square)
    }

    /// Structure with whitened columns appended; `None` if they are linearly dependent.
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
        next.t_values.extend_from_slice(&extension.solution);
        next.solution.extend(extension.solution);
        Some(next)
    }

    /// Products of whitened columns with the structure, with each other, and with the residual.
    pub fn products(&self, columns: &[HeadingColumn]) -> GramProducts {
        let factored = self.factor.len();
        let mut all = GramProducts { cross: Vec::new(), factored, gram: Vec::new(), gradient: Vec::new() };
        for (k, column) in columns.iter().enumerate() {
            let (mut cross, mut gradient) = (vec![0.0; factored], 0.0);
            for (record, values) in column {
                let block = &self.blocks[*record];
                block.columns.iter().for_each(|(unknown, column)| cross[*unknown] += dot(column, values));
                gradient += dot(&block.residual, values);
            }
            for (j, row) in self.factor.iter().enumerate() {
                cross[j] = (cross[j] - dot(&cross[..j], &row[..j])) / row[j];
            }
            all.cross.push(cross);
            all.gradient.push(gradient);
            all.gram.push(columns[..=k].iter().map(|other| product(column, other)).collect());
        }
        all
    }

    /// Criterion with columns of these products appended; infinite if they are linearly dependent.
    pub fn criterion_with_products(&self, products: &GramProducts) -> f64 {
        let Some(Extension { solution, .. }) = self.extension(products) else { return f64::INFINITY };
        self.criterion_after(&solution, self.square_with(&solution))
    }

    /// Rows of factor and solution for appended columns; `None` if they are linearly dependent.
    fn extension(&self, products: &GramProducts) -> Option<Extension> {
        let rows = products.cross.iter().zip(&products.gram).map(|(cross, gram)| [cross.as_slice(), gram].concat());
        let factor = factor(&rows.collect::<Vec<_>>(), &self.factor, products.factored)?;
        let solution = solve(&factor, &products.gradient, &self.solution);
        Some(Extension { factor, solution })
    }

    /// Gauss–Newton step of all unknowns.
    pub fn gauss_newton_step(&self) -> Vec<f64> {
        let count = self.factor.len();
        let mut step = self.solution.clone();
        for k in (0..count).rev() {
            step[k] /= self.factor[k][k];
            let moved = step[k];
            (0..k).for_each(|j| step[j] -= self.factor[k][j] * moved);
        }
        step
    }

    /// Standard deviation of the white noise of a row, in units of the standard deviation of the whitening.
    pub fn sd(&self) -> f64 {
        (self.square / self.freedom).sqrt()
    }

    /// Innovations of the heading over their standard deviation, dimensionless, after the step: a list for every
    /// record, a value for every observed row.
    pub fn innovations(&self) -> Vec<Vec<f64>> {
        let (step, sd) = (self.gauss_newton_step(), self.sd());
        let normalised = |block: &HeadingSensitivities| {
            let mut residual = block.residual.clone();
            for (unknown, column) in &block.columns {
                residual.iter_mut().zip(column).for_each(|(e, x)| *e -= step[*unknown] * x);
            }
            residual.iter_mut().for_each(|e| *e /= sd);
            residual
        };
        self.blocks.iter().map(normalised).collect()
    }
}

/// Rows of the lower Cholesky factor of a symmetric matrix after the rows `leading`; the first `factored` entries of
/// every row are of the factor already. `None` if it is singular.
fn factor(matrix: &[Vec<f64>], leading: &[Vec<f64>], factored: usize) -> Option<Vec<Vec<f64>>> {
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(matrix.len());
    for (k, source) in matrix.iter().enumerate() {
        let here = leading.len() + k;
        let mut row = vec![0.0; here + 1];
        row[..factored].copy_from_slice(&source[..factored]);
        for j in factored..here {
            let other = if j < leading.len() { &leading[j] } else { &rows[j - leading.len()] };
            row[j] = (source[j] - dot(&row[..j], &other[..j])) / other[j];
        }
        let square = source[here] - dot(&row[..here], &row[..here]);
        if !(square > MIN_INDEPENDENT_SHARE * source[here] && square > 0.0) {
            return None;
        }
        row[here] = square.sqrt();
        rows.push(row);
    }
    Some(rows)
}

/// L⁻¹ times a right side in the rows of a lower factor after the rows of the solution `leading`.
fn solve(factor: &[Vec<f64>], right: &[f64], leading: &[f64]) -> Vec<f64> {
    let count = leading.len();
    let mut solution: Vec<f64> = Vec::with_capacity(right.len());
    for (k, row) in factor.iter().enumerate() {
        let before = dot(&row[..count], leading) + dot(&row[count..count + k], &solution);
        solution.push((right[k] - before) / row[count + k]);
    }
    solution
}
