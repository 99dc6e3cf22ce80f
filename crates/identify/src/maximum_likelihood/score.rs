//! Score and information of the likelihood at a point. Derivatives with respect to the noise come from finite
//! differences: there are few entries, and a filter with derivatives would cost about as much as a second filter.

use std::ops::Range;

use crate::likelihood::{NoiseVector, parameters::RUDDER_INDEX};
use estimation::column::dot;
use nalgebra::{DMatrix, DVector, Matrix3};
use trial::noise_model::MomentKind;

use super::point::{Point, Record, RecordAtPoint, SHARED_PARAMETERS, reading_count};

/// Step of a logarithm, and of 1/T as a share of |1/T| plus the reciprocal of the duration of the record: wide enough
/// for the digits of the likelihood, and far below the uncertainty of the noise.
const DIFFERENCE: f64 = 1e-4;

/// Score and information at a point; unknowns are 1/T, b, b δ_r and then the entries of the noise vectors, record by
/// record.
pub(super) struct ScoreAndInformation {
    /// Derivative of −log L with respect to 1/T, and of the restricted likelihood with respect to the entries; zero for
    /// b and b δ_r, which are at their optimum.
    pub gradient: DVector<f64>,
    /// Fisher information, the sizes of the compass errors eliminated.
    pub information: DMatrix<f64>,
    /// Derivatives of log L through the response with respect to (1/T, b, b δ_r), times the variance of the compass
    /// error: one column by reading for each parameter, for every record.
    pub scores: Vec<[Vec<f64>; 3]>,
    /// Σ ∂ log S/∂θ over the readings of every record, by its entries; zero if the compass error is tied.
    pub log_variance_slopes: Vec<DVector<f64>>,
}

/// Score and information at a point; `None` if they are not finite.
pub(super) fn score_and_information(records: &[Record], point: &Point) -> Option<ScoreAndInformation> {
    let count = |(record, vector): (&Record, &NoiseVector)| vector.active_entries(record.has_gyro()).count();
    let counts: Vec<usize> = records.iter().zip(&point.vectors).map(count).collect();
    let unknowns = SHARED_PARAMETERS + counts.iter().sum::<usize>();
    let mut all = ScoreAndInformation {
        gradient: DVector::zeros(unknowns),
        information: DMatrix::zeros(unknowns, unknowns),
        scores: Vec::with_capacity(records.len()),
        log_variance_slopes: Vec::with_capacity(records.len()),
    };
    let mut first = SHARED_PARAMETERS;
    for (number, count) in counts.into_iter().enumerate() {
        all.add(records, point, number, first..first + count)?;
        first += count;
    }
    let finite = all.gradient.iter().chain(all.information.iter()).all(|value: &f64| value.is_finite());
    finite.then_some(all)
}

/// Derivatives of the innovations over √S and of log S of every reading with respect to 1/T or an entry of the noise.
struct Slope {
    innovation: Vec<f64>,
    log_variance: Vec<f64>,
    /// Derivatives of −log L and of the restricted likelihood.
    gradient: [f64; 2],
    /// Derivative of the logarithm of the variance of the compass error, if it is tied to an entry.
    tied: f64,
}

impl Slope {
    /// Difference quotient for a record under a noise that differs by `by`; `motion` is the information of all records.
    fn new(here: &RecordAtPoint, there: &RecordAtPoint, by: f64, motion: &Matrix3<f64>) -> Self {
        let logs = there.white.filter.log_variances().zip(here.white.filter.log_variances());
        let log_variance: Vec<f64> = logs.map(|(there, here)| (there - here) / by).collect();
        let pairs = there.innovations.iter().zip(&here.innovations).zip(&log_variance);
        let innovation = pairs.map(|((there, here), log)| (there - here) / by + 0.5 * here * log).collect();
        let deviance = there.deviance - here.deviance;
        let moved = motion - here.motion / here.variance + there.motion / there.variance;
        let determinant =
            there.log_determinant - here.log_determinant + (moved.determinant() / motion.determinant()).ln();
        let gradient = [deviance, deviance + determinant].map(|change| 0.5 * change / by);
        Self { innovation, log_variance, gradient, tied: (there.variance / here.variance).ln() / by }
    }
}

impl ScoreAndInformation {
    /// Adds the contribution of a record, whose noise entries have these indices among the unknowns. `None` if it is
    /// not finite.
    fn add(&mut self, records: &[Record], point: &Point, number: usize, entries: Range<usize>) -> Option<()> {
        let (record, part, vector) = (&records[number], &point.parts[number], &point.vectors[number]);
        let (all, a, steering) = (reading_count(records), point.inverse_T, [point.K_over_T, point.offset]);
        let motion: Matrix3<f64> = point.parts.iter().map(|part| part.motion / part.variance).sum();
        let is_tied = record.declared_rudder_error(vector).is_some();
        // A moment and a rudder error depend on the response of the ship.
        let by_ship = (vector.moment != MomentKind::None || vector.has_rudder_error)
            .then(|| DIFFERENCE * (a.abs() + record.signals.duration().recip()));
        let active: Vec<usize> = vector.active_entries(record.has_gyro()).collect();
        let moved = active.iter().map(|&entry| {
            let mut moved = *vector;
            moved.log_entries[entry] += DIFFERENCE;
            (moved, a)
        });
        let noises: Vec<(NoiseVector, f64)> = by_ship.map(|by| (*vector, a + by)).into_iter().chain(moved).collect();
        let mut there = RecordAtPoint::under(record, a, steering, &noises, all)?.into_iter();
        let none = || vec![0.0; part.readings];
        let mut slopes = vec![match by_ship {
            Some(by) => Slope::new(part, &there.next()?, by, &motion),
            None => Slope { innovation: none(), log_variance: none(), gradient: [0.0; 2], tied: 0.0 },
        }];
        for (entry, there) in active.into_iter().zip(there) {
            let mut slope = Slope::new(part, &there, DIFFERENCE, &motion);
            if is_tied && entry == RUDDER_INDEX {
                // A smaller compass error makes a given rudder error larger in its units.
                slope.log_variance.iter_mut().for_each(|by| *by += slope.tied);
            }
            slopes.push(slope);
        }
        let at: Vec<usize> = std::iter::once(0).chain(entries).collect();
        self.gradient[0] += slopes[0].gradient[0];
        slopes.iter().zip(&at).skip(1).for_each(|(slope, &at)| self.gradient[at] += slope.gradient[1]);
        let sum = |slope: &Slope| if is_tied { 0.0 } else { slope.log_variance.iter().sum::<f64>() };
        let totals: Vec<f64> = slopes.iter().map(sum).collect();
        for (i, left) in slopes.iter().enumerate() {
            for (j, right) in slopes.iter().enumerate() {
                let product = dot(&left.log_variance, &right.log_variance);
                self.information[(at[i], at[j])] += 0.5 * (product - totals[i] * totals[j] / part.readings as f64);
            }
        }
        self.log_variance_slopes.push(DVector::from_row_slice(&totals[1..]));
        self.add_motion(part, slopes.into_iter().map(|slope| slope.innovation).collect(), &at);
        Some(())
    }

    /// Adds the information of innovations that change by `columns` with 1/T and the entries, and the scores of the
    /// motion.
    fn add_motion(&mut self, part: &RecordAtPoint, mut columns: Vec<Vec<f64>>, at: &[usize]) {
        let per = part.variance.recip();
        self.gradient[0] -= dot(&part.innovations, &part.by_inverse_T) * per;
        columns[0].iter_mut().zip(&part.by_inverse_T).for_each(|(by_noise, by_motion)| *by_noise -= by_motion);
        let minus = |column: &[f64]| column.iter().map(|x| -x).collect::<Vec<f64>>();
        let [rudder, constant, _] = &part.white.projected;
        columns.extend([minus(rudder), minus(constant)]);
        let all: Vec<usize> = at.iter().copied().chain([1, 2]).collect();
        for (i, &row) in all.iter().enumerate() {
            for (j, &column) in all.iter().enumerate().take(i + 1) {
                let product = dot(&columns[i], &columns[j]) * per;
                self.information[(row, column)] += product;
                if i != j {
                    self.information[(column, row)] += product;
                }
            }
        }
        let times = |column: &[f64]| column.iter().zip(&part.innovations).map(|(x, nu)| x * nu).collect::<Vec<f64>>();
        self.scores.push([times(&part.by_inverse_T), times(rudder), times(constant)]);
    }
}
