//! How the likelihood changes at a point: score, information, and what the fitted columns take from the noise.

use std::ops::Range;

use crate::likelihood::differentiated;
use crate::likelihood::filter::SIDE_BY_SIDE;
use crate::likelihood::parameters::RUDDER;
use estimation::column::dot;
use nalgebra::{DMatrix, DVector, Matrix3};

use super::point::{Point, Raw, Record, RecordAtPoint, SHARED, shrink, take_out};

/// Score and information at a point; unknowns are 1/T, b, b δ_r and then the entries of the places, record by
/// record.
pub(super) struct Linearised {
    /// ∂(−log L) by 1/T, and that of the restricted likelihood by the entries; zero for b and b δ_r, which are at
    /// their best.
    pub score: DVector<f64>,
    /// Fisher information, the sizes of the compass errors eliminated.
    pub information: DMatrix<f64>,
    /// Scores of (1/T, b, b δ_r) reading by reading, for every record.
    pub scores: Vec<[Vec<f64>; 3]>,
    /// Σ ∂ log S/∂θ over the readings of every record, by its entries; zero where the compass error is tied.
    pub totals: Vec<DVector<f64>>,
}

/// Score and information at a point.
pub(super) fn linearise(records: &[Record], point: &Point) -> Option<Linearised> {
    let counts: Vec<usize> =
        (records.iter().zip(&point.places)).map(|(record, place)| place.entries(record.has_gyro()).count()).collect();
    let unknowns = SHARED + counts.iter().sum::<usize>();
    let mut all = Linearised {
        score: DVector::zeros(unknowns),
        information: DMatrix::zeros(unknowns, unknowns),
        scores: Vec::with_capacity(records.len()),
        totals: Vec::with_capacity(records.len()),
    };
    let motion: Matrix3<f64> = point.parts.iter().map(|part| part.motion / part.variance).sum();
    let factor = motion.cholesky()?.l().try_inverse()?.transpose();
    let mut first = SHARED;
    for (number, (record, count)) in records.iter().zip(counts).enumerate() {
        all.add(record, point, number, first..first + count, &factor);
        first += count;
    }
    let finite = all.score.iter().chain(all.information.iter()).all(|value: &f64| value.is_finite());
    finite.then_some(all)
}

impl Linearised {
    /// Adds what a record says, whose entries are these of the unknowns; `factor` makes the columns that all records
    /// share orthonormal.
    fn add(&mut self, record: &Record, point: &Point, number: usize, entries: Range<usize>, factor: &Matrix3<f64>) {
        let (part, place) = (&point.parts[number], &point.places[number]);
        let filter = differentiated(&record.schedule, place, point.inverse_time, record.has_gyro());
        let lanes = 1 + entries.len();
        let raw = record.raw(point.inverse_time);
        let mut slopes = filter.slopes(&part.left_over(&raw, point), lanes);
        let tied = record.tied(place).is_some();
        let lane_of = |entry| place.entries(record.has_gyro()).position(|other| other == entry).map(|k| k + 1);
        if let Some(lane) = lane_of(RUDDER).filter(|_| tied) {
            // A smaller compass error makes the same rudder error larger in its units.
            slopes.log_variance[lane].iter_mut().for_each(|by| *by -= 2.0);
        }
        let at: Vec<usize> = std::iter::once(0).chain(entries).collect();
        let (per, logs) = (part.variance.recip(), &slopes.log_variance);
        let columns = self.add_motion(part, slopes.innovation, &at);
        let mut totals = Vec::with_capacity(lanes);
        for (lane, logs) in logs.iter().enumerate() {
            let surprise: f64 = logs.iter().zip(&part.innovations).map(|(by, nu)| by * (1.0 - nu * nu * per)).sum();
            self.score[at[lane]] += dot(&part.innovations, &columns[lane]) * per + 0.5 * surprise;
            totals.push(if tied { 0.0 } else { logs.iter().sum::<f64>() });
        }
        for i in 0..lanes {
            for j in 0..lanes {
                let product = dot(&logs[i], &logs[j]);
                self.information[(at[i], at[j])] += 0.5 * (product - totals[i] * totals[j] / part.readings as f64);
            }
        }
        let fitted = if lanes > 1 { part.fitted(raw, &(*factor * per.sqrt())) } else { Vec::new() };
        for columns in fitted.chunks(SIDE_BY_SIDE) {
            let raw = std::array::from_fn(|k| columns.get(k).map_or(&[][..], |(_, raw)| raw.as_slice()));
            let white = std::array::from_fn(|k| columns.get(k).map_or(&[][..], |(white, _)| white.as_slice()));
            let turned = filter.sensitivity_products(raw, white);
            for lane in 1..lanes {
                let shrunk: f64 = columns.iter().map(|(white, _)| weighted_square(white, &logs[lane])).sum();
                self.score[at[lane]] += turned[lane] - 0.5 * shrunk;
            }
        }
        self.totals.push(DVector::from_row_slice(&totals[1..]));
    }

    /// Adds the information of innovations that change by `columns` with 1/T and the entries, and the scores of the
    /// motion; returns the columns with the fitted ones taken out, and those of b and b δ_r behind them.
    fn add_motion(&mut self, part: &RecordAtPoint, mut columns: Vec<Vec<f64>>, at: &[usize]) -> Vec<Vec<f64>> {
        for column in &mut columns {
            part.white.own.iter().for_each(|unit| _ = take_out(unit, column));
        }
        columns[0].iter_mut().zip(&part.by_time.white).for_each(|(by_noise, by_motion)| *by_noise -= by_motion);
        let minus = |column: &[f64]| column.iter().map(|x| -x).collect::<Vec<f64>>();
        let [rudder, constant, _] = &part.white.rest;
        columns.extend([minus(rudder), minus(constant)]);
        let (all, per): (Vec<usize>, f64) = (at.iter().copied().chain([1, 2]).collect(), part.variance.recip());
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
        self.scores.push([times(&part.by_time.white), times(rudder), times(constant)]);
        columns
    }
}

/// Σ w q².
fn weighted_square(column: &[f64], weights: &[f64]) -> f64 {
    column.iter().zip(weights).map(|(q, w)| q * q * w).sum()
}

/// A column times a factor taken out of another one.
fn less(column: &mut [f64], factor: f64, other: &[f64]) {
    column.iter_mut().zip(other).for_each(|(x, y)| *x -= factor * y);
}

impl RecordAtPoint {
    /// Measured less fitted readings.
    fn left_over(&self, raw: &Raw, point: &Point) -> Vec<f64> {
        let [rudder, constant, readings] = &raw.rest;
        let mut left = readings.clone();
        let start = [self.anchor.heading, self.anchor.yaw_rate];
        let own = start.iter().chain(&self.jumps).zip(&raw.own);
        own.for_each(|(size, column)| less(&mut left, *size, column));
        less(&mut left, point.gain, rudder);
        less(&mut left, point.offset, constant);
        left
    }

    /// All columns that are fitted, orthonormal and white, each with what it was before; `factor` makes those that all
    /// records share so.
    fn fitted(&self, raw: Raw, factor: &Matrix3<f64>) -> Vec<(Vec<f64>, Vec<f64>)> {
        // What made the white columns orthonormal makes the others follow.
        let Raw { mut own, rest: [rudder, constant, _] } = raw;
        for k in 0..own.len() {
            let (before, column) = own.split_at_mut(k);
            for (j, unit) in before.iter().enumerate() {
                less(&mut column[0], self.white.triangle[(j, k)], unit);
            }
            shrink(&mut column[0], self.white.triangle[(k, k)]);
        }
        let mut raw = [self.by_time.raw.clone(), rudder, constant];
        for (column, shares) in raw.iter_mut().zip([&self.by_time.shares, &self.white.shares[0], &self.white.shares[1]])
        {
            own.iter().zip(shares).for_each(|(unit, share)| less(column, *share, unit));
        }
        let [rudder, constant, _] = &self.white.rest;
        let white = [&self.by_time.white, rudder, constant];
        let combined = |[x, y, z]: [&[f64]; 3], k: usize| -> Vec<f64> {
            let [fx, fy, fz] = [0, 1, 2].map(|j| factor[(j, k)]);
            x.iter().zip(y).zip(z).map(|((x, y), z)| fx * x + fy * y + fz * z).collect()
        };
        let shared =
            (0..3).map(|k| (combined(white.map(Vec::as_slice), k), combined(raw.each_ref().map(Vec::as_slice), k)));
        self.white.own.iter().cloned().zip(own).chain(shared).collect()
    }
}
