//! Likelihood as a function of 1/T and the noise alone: given these, the heading is linear in all other unknowns, and
//! the size of the compass error follows from the residual.
//!
//! The noise is selected by the restricted likelihood, −2 log L + log det(JᵀJ) with the whitened sensitivities J to all
//! other unknowns: the likelihood of the part that these unknowns cannot fit, which does not underestimate the noise
//! (Patterson and Thompson 1971; Cox and Reid 1987 for unknowns that are not linear).

use std::cell::RefCell;
use std::rc::Rc;

use estimation::column::{dot, gram};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector2};
use ship::first_order::State;

use crate::likelihood::parameters::RUDDER_INDEX;
use crate::likelihood::track::{Coefficients, MotionColumns, Track};
use crate::likelihood::{NoiseParameters, NoiseVector, Schedule, whitener};
use crate::profile::solve2;
use estimation::kalman::Whitener;

/// Number of unknowns that all records share: 1/T, K/T and (K/T) δ_r.
pub(super) const SHARED_PARAMETERS: usize = 3;

/// Maximum number of iterations of the weights of the records of one ship.
const MAX_WEIGHT_ITERATIONS: usize = 20;

/// Relative change of the variances at convergence of the weights.
const WEIGHT_TOLERANCE: f64 = 1e-12;

/// Record with its readings.
#[derive(Debug, Clone)]
pub(super) struct Record {
    pub track: Track,
    pub schedule: Schedule,
    /// First rows after jumps of the compass by a constant.
    pub jumps: Vec<usize>,
    /// Declared standard deviation of the rudder error, rad. It fixes the rudder error of a noise vector, whose entry
    /// then represents the size of the compass error.
    pub declared: Option<f64>,
    /// Columns of the last 1/T: the filters of many noise laws share them.
    last_columns: RefCell<Option<Rc<RecordColumns>>>,
}

/// Columns of the readings of one record for one 1/T.
#[derive(Debug, Clone)]
struct RecordColumns {
    inverse_time: f64,
    /// Columns of the initial state and of the jumps.
    nuisance: Vec<Vec<f64>>,
    /// Responses to rudder and constant, and the readings.
    projected: [Vec<f64>; 3],
    /// Derivatives with respect to 1/T of the responses to the initial yaw rate, rudder and constant.
    tangents: [Vec<f64>; 3],
}

/// Whitened columns of one record, projected off the nuisance columns of its initial state and jumps: the responses to
/// rudder and constant, and the readings.
#[derive(Debug, Clone)]
pub(super) struct WhitenedColumns {
    pub filter: Whitener,
    /// Triangular factor R of the nuisance columns Q R of the initial state and the jumps.
    triangle: DMatrix<f64>,
    pub projected: [Vec<f64>; 3],
    /// Derivatives of [`RecordColumns`], projected off the nuisance columns.
    tangents: [Vec<f64>; 3],
    /// Components of responses and readings along the nuisance columns.
    shares: [Vec<f64>; 3],
}

/// Likelihood contribution of a record at a point.
#[derive(Debug, Clone)]
pub(super) struct RecordAtPoint {
    /// Variance of the compass error, rad².
    pub variance: f64,
    /// Number of readings.
    pub readings: usize,
    /// Heading and yaw rate at the anchor.
    pub anchor: State,
    /// Innovations over √S, rad.
    pub innovations: Vec<f64>,
    /// Contribution to −2 log L, and the additional contribution to the restricted likelihood.
    pub deviance: f64,
    pub determinant: f64,
    /// Products of the sensitivities to 1/T, b and b δ_r.
    pub motion: Matrix3<f64>,
    pub white: WhitenedColumns,
    /// Whitened sensitivity of the readings to 1/T, projected off the nuisance columns.
    pub by_time: Vec<f64>,
}

/// Best fit for one 1/T and one noise law of every record.
#[derive(Debug, Clone)]
pub(super) struct Point {
    pub inverse_time: f64,
    pub vectors: Vec<NoiseVector>,
    /// −2 log L, and −2 log of the restricted likelihood.
    pub deviance: f64,
    pub restricted: f64,
    /// b = K/T, 1/s², and b δ_r, rad/s².
    pub gain: f64,
    pub offset: f64,
    pub parts: Vec<RecordAtPoint>,
}

impl Record {
    pub fn new(track: Track, by_row: bool, declared: Option<f64>) -> Self {
        let schedule = Schedule::new(&track, by_row);
        Self { track, schedule, jumps: Vec::new(), declared, last_columns: RefCell::default() }
    }

    /// Number of readings.
    pub fn len(&self) -> usize {
        self.schedule.readings.len()
    }

    /// `true` if the yaw rate is among the readings.
    pub fn has_gyro(&self) -> bool {
        !self.track.rates.is_empty()
    }

    /// Declared rudder error of a noise vector, rad.
    pub fn declared_rudder_error(&self, vector: &NoiseVector) -> Option<f64> {
        self.declared.filter(|_| vector.rudder)
    }

    /// Number of unknowns of the record alone: initial state and jumps.
    fn nuisance_count(&self) -> usize {
        2 + self.jumps.len()
    }

    /// Regressor of a compass jump: 1 for headings from row `jump` on, 0 before and for yaw rates.
    fn step_at(&self, jump: usize) -> Vec<f64> {
        let heading: Vec<f64> = self.track.observed.iter().map(|&row| f64::from(u8::from(row >= jump))).collect();
        self.schedule.stacked(&heading, &vec![0.0; self.track.rates.len()])
    }

    /// Columns of a ship with this 1/T; the columns of the last 1/T are cached.
    fn columns(&self, inverse_time: f64) -> Rc<RecordColumns> {
        let mut last = self.last_columns.borrow_mut();
        if let Some(columns) = last.as_ref().filter(|columns| columns.is_of(self, inverse_time)) {
            return Rc::clone(columns);
        }
        let columns = Rc::new(RecordColumns::new(self, inverse_time));
        *last = Some(Rc::clone(&columns));
        columns
    }

    /// Columns of a ship with this 1/T, whitened under a noise whose filter may use another 1/T. `None` if a column is
    /// not finite.
    fn white(&self, inverse_time: f64, noise: &NoiseParameters) -> Option<WhitenedColumns> {
        WhitenedColumns::new(&self.columns(inverse_time), whitener(&self.schedule, noise, [0.0; 2]))
    }

    /// Products of the whitened sensitivities to (1/T, b, b δ_r) at given coefficients, with the initial state
    /// eliminated; divided by σ² they are the information of the motion.
    pub fn information(
        &self,
        inverse_time: f64,
        vector: &NoiseVector,
        coefficients: &Coefficients,
    ) -> Option<Matrix3<f64>> {
        let white = self.white(inverse_time, &vector.parameters(inverse_time))?;
        let by_time = white.by_time(coefficients);
        let products = white.motion(&by_time);
        products.iter().all(|value| value.is_finite()).then_some(products)
    }
}

/// Projects a column off a unit column and returns the component.
pub(super) fn project_off(unit: &[f64], column: &mut [f64]) -> f64 {
    let share = dot(unit, column);
    column.iter_mut().zip(unit).for_each(|(x, u)| *x -= share * u);
    share
}

impl RecordColumns {
    fn new(record: &Record, inverse_time: f64) -> Self {
        let Record { track, schedule, jumps, .. } = record;
        let (mut motion, mut by_time) = (MotionColumns::default(), MotionColumns::default());
        track.fill_with_tangents(inverse_time, &mut motion, &mut by_time);
        let ones = schedule.stacked(&vec![1.0; track.len()], &vec![0.0; track.rates.len()]);
        let stacked = |MotionColumns { homogeneous, rudder, constant, rates }: &MotionColumns| {
            [(homogeneous, &rates.homogeneous), (rudder, &rates.rudder), (constant, &rates.constant)]
                .map(|(heading, rate)| schedule.stacked(heading, rate))
        };
        let [homogeneous, rudder, constant] = stacked(&motion);
        let mut nuisance = vec![ones, homogeneous];
        nuisance.extend(jumps.iter().map(|&jump| record.step_at(jump)));
        let projected = [rudder, constant, schedule.stacked(&track.heading, &track.rates)];
        Self { inverse_time, nuisance, projected, tangents: stacked(&by_time) }
    }

    /// `true` if these are the columns of a record for this 1/T.
    fn is_of(&self, record: &Record, inverse_time: f64) -> bool {
        self.inverse_time == inverse_time && self.nuisance.len() == record.nuisance_count()
    }
}

impl WhitenedColumns {
    fn new(columns: &RecordColumns, filter: Whitener) -> Option<Self> {
        let RecordColumns { mut nuisance, mut projected, mut tangents, .. } = columns.clone();
        let (first, jumps) = nuisance.split_at_mut(2);
        let [heading, yaw_rate] = first else { return None };
        let [rudder, constant, readings] = &mut projected;
        let [by_yaw_rate, by_rudder, by_constant] = &mut tangents;
        filter.apply(&mut [heading, yaw_rate, rudder, constant, readings, by_yaw_rate, by_rudder, by_constant]);
        jumps.iter_mut().for_each(|jump| filter.apply(&mut [jump]));
        let count = nuisance.len();
        let mut triangle = DMatrix::zeros(count, count);
        for k in 0..count {
            let (before, column) = nuisance.split_at_mut(k);
            for (j, unit) in before.iter().enumerate() {
                triangle[(j, k)] = project_off(unit, &mut column[0]);
            }
            let length = dot(&column[0], &column[0]).sqrt();
            triangle[(k, k)] = length;
            if length.is_nan() {
                return None;
            }
            // An initial state that decays before the first row is not observable.
            let per = if length > 0.0 { length.recip() } else { 0.0 };
            column[0].iter_mut().for_each(|x| *x *= per);
        }
        let shares = projected.each_mut().map(|column| nuisance.iter().map(|unit| project_off(unit, column)).collect());
        for column in &mut tangents {
            nuisance.iter().for_each(|unit| _ = project_off(unit, column));
        }
        Some(Self { filter, triangle, projected, tangents, shares })
    }

    /// Whitened sensitivity of the readings to 1/T at given coefficients, projected off the nuisance columns.
    fn by_time(&self, Coefficients { anchor, gain, offset }: &Coefficients) -> Vec<f64> {
        let [by_yaw_rate, by_rudder, by_constant] = &self.tangents;
        let steered = by_rudder.iter().zip(by_constant).map(|(g, h)| gain * g + offset * h);
        by_yaw_rate.iter().zip(steered).map(|(f, steered)| anchor.yaw_rate * f + steered).collect()
    }

    /// Products of the sensitivities to 1/T, b and b δ_r.
    fn motion(&self, by_time: &[f64]) -> Matrix3<f64> {
        let [rudder, constant, _] = &self.projected;
        Matrix3::from(gram([by_time, rudder, constant]))
    }

    /// Readings minus the response to the steering.
    fn residual(&self, gain: f64, offset: f64) -> Vec<f64> {
        let [rudder, constant, readings] = &self.projected;
        readings.iter().zip(rudder.iter().zip(constant)).map(|(psi, (g, h))| psi - gain * g - offset * h).collect()
    }

    /// State at the anchor.
    fn start(&self, gain: f64, offset: f64) -> Option<State> {
        let [rudder, constant, readings] = &self.shares;
        let along = (0..readings.len()).map(|k| readings[k] - gain * rudder[k] - offset * constant[k]);
        let mut along = DVector::from_iterator(readings.len(), along);
        // An unobservable initial state is zero.
        let mut triangle = self.triangle.clone();
        for k in 0..triangle.nrows() {
            if triangle[(k, k)] == 0.0 {
                (triangle[(k, k)], along[k]) = (1.0, 0.0);
            }
        }
        let initial = triangle.solve_upper_triangular(&along)?;
        Some(State { heading: initial[0], yaw_rate: initial[1] })
    }
}

/// Quantities that determine the weight of a record.
struct Weight {
    /// Products of the responses to rudder and constant and the readings.
    products: [[f64; 3]; 3],
    readings: f64,
    /// Number of readings minus number of fitted unknowns.
    freedom: f64,
    /// Compass error of a ship with b = 1, rad, if the rudder error is declared.
    tied: Option<f64>,
}

impl Weight {
    /// Weight of a record; `all` is the number of readings of all records.
    fn new(record: &Record, vector: &NoiseVector, white: &WhitenedColumns, all: usize) -> Self {
        let readings = record.len() as f64;
        let fitted = record.nuisance_count() as f64 + SHARED_PARAMETERS as f64 * readings / all as f64;
        let [rudder, constant, measured] = &white.projected;
        Self {
            products: gram([rudder, constant, measured]),
            readings,
            freedom: readings - fitted,
            tied: record.declared_rudder_error(vector).map(|sd| sd / vector.log[RUDDER_INDEX].exp()),
        }
    }

    fn square(&self, b: f64, q: f64) -> f64 {
        let [[gg, gh, gy], [_, hh, hy], [.., yy]] = self.products;
        // The square is bounded below by its rounding error, which remains for a record without noise.
        let rounding = (f64::EPSILON * yy).max(f64::MIN_POSITIVE);
        (yy - 2.0 * (b * gy + q * hy) + b * b * gg + 2.0 * b * q * gh + q * q * hh).max(rounding)
    }

    fn variance(&self, b: f64, q: f64) -> f64 {
        self.tied.map_or(self.square(b, q) / self.freedom, |unit| (b * unit).powi(2))
    }
}

/// Best b and b δ_r over all records, and the variance of the compass error in every record.
fn weigh(weights: &[Weight]) -> Option<(Vector2<f64>, Vec<f64>)> {
    let mut variances = vec![1.0; weights.len()];
    let mut best = Vector2::zeros();
    for _ in 0..MAX_WEIGHT_ITERATIONS {
        let (mut matrix, mut moment) = (Matrix2::zeros(), Vector2::zeros());
        for (Weight { products: [[gg, gh, gy], [_, hh, hy], _], .. }, variance) in weights.iter().zip(&variances) {
            matrix += Matrix2::new(*gg, *gh, *gh, *hh) / *variance;
            moment += Vector2::new(*gy, *hy) / *variance;
        }
        best = solve2(&matrix, &moment)?;
        let mut moved = 0.0_f64;
        for (weight, variance) in weights.iter().zip(&mut variances) {
            let next = weight.variance(best[0], best[1]);
            moved = moved.max((next / *variance - 1.0).abs());
            *variance = next;
        }
        if weights.len() == 1 || moved < WEIGHT_TOLERANCE {
            break;
        }
    }
    Some((best, variances))
}

impl RecordAtPoint {
    /// Contribution of a record at given steering, under a noise vector whose filter may use another 1/T, `filtered`.
    pub fn new(
        record: &Record,
        inverse_time: f64,
        steering: [f64; 2],
        noise: &NoiseVector,
        filtered: f64,
        readings: usize,
    ) -> Option<Self> {
        let white = record.white(inverse_time, &noise.parameters(filtered))?;
        let weight = Weight::new(record, noise, &white, readings);
        let variance = weight.variance(steering[0], steering[1]);
        Self::from_columns(record, steering, white, &weight, variance)
    }

    fn from_columns(
        record: &Record,
        [gain, offset]: [f64; 2],
        white: WhitenedColumns,
        weight: &Weight,
        variance: f64,
    ) -> Option<Self> {
        let constant = (2.0 * std::f64::consts::PI * variance).ln();
        let deviance = weight.readings * constant + weight.square(gain, offset) / variance + white.filter.log_variance;
        let anchor = white.start(gain, offset)?;
        let lengths = white.triangle.diagonal();
        let seen = lengths.iter().filter(|&&length| length > 0.0);
        let determinant = seen.map(|length| (length * length / variance).ln()).sum::<f64>();
        let by_time = white.by_time(&Coefficients { anchor, gain, offset });
        let (motion, innovations) = (white.motion(&by_time), white.residual(gain, offset));
        let readings = record.len();
        Some(Self { variance, readings, anchor, innovations, deviance, determinant, motion, white, by_time })
    }
}

/// Number of readings of all records.
pub(super) fn reading_count(records: &[Record]) -> usize {
    records.iter().map(Record::len).sum()
}

/// Best fit for a given 1/T and a noise vector of every record. `None` if it is not a ship or not finite.
pub(super) fn evaluate(records: &[Record], inverse_time: f64, vectors: &[NoiseVector]) -> Option<Point> {
    let columns =
        |(record, vector): (&Record, &NoiseVector)| record.white(inverse_time, &vector.parameters(inverse_time));
    let columns = records.iter().zip(vectors).map(columns).collect::<Option<Vec<WhitenedColumns>>>()?;
    let all = reading_count(records);
    let weight = |((record, vector), white): ((&Record, &NoiseVector), &WhitenedColumns)| {
        Weight::new(record, vector, white, all)
    };
    let weights: Vec<Weight> = records.iter().zip(vectors).zip(&columns).map(weight).collect();
    let (steering, variances) = weigh(&weights)?;
    let steering: [f64; 2] = steering.into();
    let parts = columns.into_iter().zip(weights.iter().zip(variances)).zip(records);
    let part =
        |((white, (weight, variance)), record)| RecordAtPoint::from_columns(record, steering, white, weight, variance);
    let parts = parts.map(part).collect::<Option<Vec<_>>>()?;
    let deviance = parts.iter().map(|part| part.deviance).sum::<f64>();
    let motion: Matrix3<f64> = parts.iter().map(|part| part.motion / part.variance).sum();
    let determinant = parts.iter().map(|part| part.determinant).sum::<f64>() + motion.determinant().ln();
    let [gain, offset] = steering;
    let restricted = deviance + determinant;
    let ship = gain > 0.0 && restricted.is_finite();
    ship.then(|| Point { inverse_time, vectors: vectors.to_vec(), deviance, restricted, gain, offset, parts })
}
