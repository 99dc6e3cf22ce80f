//! Missing moment as a smooth function of one channel, with a simultaneous band.
//!
//! m(t) = f(x(t)) + walk, with f a cubic spline of two inner knots at the thirds of the range of the channel x. Its
//! coefficients are estimated by generalised least squares on the headings: the heading response to every spline is
//! whitened by the same filter as the record. The walk absorbs the remaining moment; its intensity is the maximum
//! likelihood estimate given f. The correlation of neighbouring rows is thus accounted for. The initial value of the
//! walk is free, so f is determined up to a constant: the mean over the rows is zero.
//!
//! The band is a Scheffé band (1953): f(x) ± √(χ²₀.₉₅(p)) · se(x), which holds for all x at once.

use estimation::column::dot;
use estimation::minimum::golden_section_minimum;
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::smoother::{HeadingRows, MomentFilter, MomentRows, STATES};
use crate::law::MIN_HEADING_SD_RAD;

/// Inner knots of the spline, on a range from −1 to 1.
const KNOTS: [f64; 2] = [-1.0 / 3.0, 1.0 / 3.0];

/// Number of coefficients of a curve without its constant.
const COEFFICIENTS: usize = 3 + KNOTS.len();

/// Number of points of a curve.
const POINTS: usize = 61;

/// Minimum range of a channel, relative to its maximum magnitude.
const MIN_RELATIVE_RANGE: f64 = 5e-3;

/// Minimum pivot of the normalised normal equations for which the rows determine the curve.
const MIN_PIVOT: f64 = 1e-10;

/// Bounds of the level of the walk: heading variance over σ² at the end of the record for a ship without damping.
const LEVELS: [f64; 2] = [1e-3, 1e13];

/// Number of intervals of the grid of levels.
const GRID: usize = 12;

/// Maximum likelihood estimate of log λ (λ in 1/s), for a ship with K/T = `gain` (1/s²); `value` is −2 log L of a
/// filter.
pub(super) fn maximum_likelihood_level(
    rows: &MomentRows,
    gain: f64,
    value: impl Fn(&MomentFilter) -> Option<f64>,
) -> f64 {
    let duration = rows.time[rows.count() - 1] - rows.time[0];
    let unit = 20.0 / (duration.powi(5) * gain * gain);
    let [low, high] = LEVELS.map(|level| (level * unit).ln());
    golden_section_minimum(low, high, GRID, |log| value(&rows.filter(log.exp())).unwrap_or(f64::INFINITY)).0
}

/// Deviance −2 log L = n ln(s²/n + σ₀²) + log det S, up to a constant: s² is the whitened residual sum of squares
/// `square`, n the number of rows without those of the initial state, and σ₀ [`MIN_HEADING_SD_RAD`].
pub(super) fn deviance(square: f64, filter: &MomentFilter, rows: usize) -> f64 {
    let n = (rows - STATES) as f64;
    n * (square / n + MIN_HEADING_SD_RAD * MIN_HEADING_SD_RAD).ln() + filter.log_determinant()
}

/// Estimate of σ² (rad²) from a whitened sum of squares after a fit of `coefficients`.
pub(super) fn variance(square: f64, rows: usize, coefficients: usize) -> f64 {
    square / (rows - STATES - coefficients) as f64 + MIN_HEADING_SD_RAD * MIN_HEADING_SD_RAD
}

/// Minimum number of rows for a curve.
pub(super) const MIN_ROWS: usize = 4 * (STATES + COEFFICIENTS);

/// Spline basis on the range of a channel, each spline with mean zero over the rows.
struct SplineBasis {
    middle: f64,
    half: f64,
    means: [f64; COEFFICIENTS],
}

impl SplineBasis {
    fn new(x: &[f64]) -> Option<Self> {
        let (low, high) = x.iter().fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x)));
        let largest = low.abs().max(high.abs());
        let varies = high - low > MIN_RELATIVE_RANGE * largest;
        let mut basis = Self { middle: 0.5 * (low + high), half: 0.5 * (high - low), means: [0.0; COEFFICIENTS] };
        let mut sums = [0.0; COEFFICIENTS];
        for &x in x {
            sums.iter_mut().zip(basis.at(x)).for_each(|(sum, value)| *sum += value);
        }
        basis.means = sums.map(|sum| sum / x.len() as f64);
        varies.then_some(basis)
    }

    fn at(&self, x: f64) -> [f64; COEFFICIENTS] {
        let z = (x - self.middle) / self.half;
        let [first, second] = KNOTS.map(|knot| (z - knot).max(0.0).powi(3));
        let values = [z, z * z, z * z * z, first, second];
        std::array::from_fn(|k| values[k] - self.means[k])
    }

    fn grid(&self) -> Vec<f64> {
        let share = |k: usize| 2.0 * k as f64 / (POINTS - 1) as f64 - 1.0;
        (0..POINTS).map(|k| self.middle + share(k) * self.half).collect()
    }
}

/// Normal equations of the coefficients of a curve under one filter.
struct CurveEquations {
    columns: Vec<Vec<f64>>,
    inverse: DMatrix<f64>,
}

impl CurveEquations {
    fn new(filter: &MomentFilter, splines: &[HeadingRows]) -> Option<Self> {
        let columns: Vec<Vec<f64>> = splines.iter().map(|spline| filter.whitened(spline)).collect();
        let matrix = DMatrix::from_fn(COEFFICIENTS, COEFFICIENTS, |i, j| dot(&columns[i], &columns[j]));
        let scale = DVector::from_fn(COEFFICIENTS, |i, _| matrix[(i, i)].sqrt().recip());
        let scaled = DMatrix::from_fn(COEFFICIENTS, COEFFICIENTS, |i, j| matrix[(i, j)] * scale[i] * scale[j]);
        let factor = scaled.cholesky().filter(|factor| factor.l_dirty().diagonal().min().powi(2) > MIN_PIVOT)?;
        let inverse = factor.inverse();
        let inverse = DMatrix::from_fn(COEFFICIENTS, COEFFICIENTS, |i, j| inverse[(i, j)] * scale[i] * scale[j]);
        Some(Self { columns, inverse })
    }

    /// Least-squares coefficients of the curve for a `whitened` heading, and the residual sum of squares.
    fn solve(&self, whitened: &[f64]) -> (DVector<f64>, f64) {
        let side = DVector::from_iterator(COEFFICIENTS, self.columns.iter().map(|column| dot(column, whitened)));
        let coefficients = &self.inverse * &side;
        let square = dot(whitened, whitened) - side.dot(&coefficients);
        (coefficients, square.max(0.0))
    }
}

/// Missing moment as a function of one channel, with its band.
#[derive(Debug, Clone, PartialEq)]
pub struct MomentCurve {
    /// Values of the channel over the range of the record, SI units and rad.
    pub channel_values: Vec<f64>,
    /// Moment, rad of rudder, with mean zero over the rows of the record.
    pub moment: Vec<f64>,
    /// Half-width of the simultaneous 95 % band, rad of rudder.
    pub half_width: Vec<f64>,
    /// Curves of the explanations, in their order, estimated likewise from their heading responses, rad of rudder.
    pub explanations: Vec<Vec<f64>>,
    /// Variance per second of the remaining walk, rad² of rudder per s.
    pub walk_intensity: f64,
    /// Deviance −2 log L with the curve, up to a constant of the record.
    pub deviance: f64,
}

impl MomentCurve {
    /// Curve of a record against a channel, with the curves of explanations from their heading responses relative to
    /// the base (rad), for a ship with K/T = `gain` (1/s²). `None` if the channel does not vary or the rows do not
    /// determine the curve.
    pub(super) fn new(
        rows: &MomentRows,
        gain: f64,
        record: &HeadingRows,
        x: &[f64],
        explanations: &[HeadingRows],
    ) -> Option<Self> {
        let count = rows.count();
        let basis = SplineBasis::new(x).filter(|_| count >= MIN_ROWS)?;
        let values: Vec<[f64; COEFFICIENTS]> = x.iter().map(|&x| basis.at(x)).collect();
        // The record contains the response to the moment; as an input of the filter it has the opposite sign.
        let spline = |k: usize| {
            let moment: Vec<f64> = values.iter().map(|values| -values[k]).collect();
            HeadingRows { heading: vec![0.0; count], forced: rows.moment_response(&moment) }
        };
        let splines: Vec<HeadingRows> = (0..COEFFICIENTS).map(spline).collect();
        let value = |filter: &MomentFilter| {
            let (_, square) = CurveEquations::new(filter, &splines)?.solve(&filter.whitened(record));
            Some(deviance(square, filter, count))
        };
        let intensity = maximum_likelihood_level(rows, gain, value).exp();
        let filter = rows.filter(intensity);
        let normal = CurveEquations::new(&filter, &splines)?;
        let (coefficients, square) = normal.solve(&filter.whitened(record));
        let variance = variance(square, count, COEFFICIENTS);
        let width = ChiSquared::new(COEFFICIENTS as f64).ok()?.inverse_cdf(0.95).sqrt();
        let along = |coefficients: &DVector<f64>, values: &[f64; COEFFICIENTS]| dot(coefficients.as_slice(), values);
        let grid = basis.grid();
        let of_grid: Vec<[f64; COEFFICIENTS]> = grid.iter().map(|&x| basis.at(x)).collect();
        let half_width = |values: &[f64; COEFFICIENTS]| {
            let values = DVector::from_row_slice(values);
            width * (variance * values.dot(&(&normal.inverse * &values))).max(0.0).sqrt()
        };
        let other = |column: &HeadingRows| {
            let (coefficients, _) = normal.solve(&filter.whitened(column));
            of_grid.iter().map(|values| along(&coefficients, values)).collect()
        };
        Some(Self {
            moment: of_grid.iter().map(|values| along(&coefficients, values)).collect(),
            half_width: of_grid.iter().map(half_width).collect(),
            explanations: explanations.iter().map(other).collect(),
            walk_intensity: intensity * variance,
            deviance: deviance(square, &filter, count),
            channel_values: grid,
        })
    }

    /// `true` if another curve lies inside the band everywhere.
    pub fn contains(&self, other: &[f64]) -> bool {
        let rows = self.moment.iter().zip(&self.half_width).zip(other);
        rows.fold(true, |all, ((moment, half), other)| all && (moment - other).abs() <= *half)
    }

    /// `true` if zero lies inside the band everywhere.
    pub fn contains_zero(&self) -> bool {
        self.contains(&[0.0; POINTS])
    }
}
