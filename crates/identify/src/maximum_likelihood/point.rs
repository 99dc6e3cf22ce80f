//! Likelihood as a function of 1/T and the noise alone: given these, the heading is linear in all other unknowns, and
//! the size of the compass error follows from the residual.
//!
//! The noise is selected by the restricted likelihood, −2 log L + log det(JᵀJ) with the whitened sensitivities J to all
//! other unknowns: the likelihood of the part that these unknowns cannot fit, which does not underestimate the noise
//! (Patterson and Thompson 1971; Cox and Reid 1987 for unknowns that are not linear).

use std::array;
use std::cell::RefCell;
use std::rc::Rc;

use estimation::column::{dot, gram};
use estimation::kalman::SensorReading;
use estimation::kalman::whitener::{InterleavedRow, Whitener};
use estimation::rows;
use nalgebra::{DMatrix, DVector, Matrix3};
use ship::first_order::YawState;

use super::weight::{Weight, weigh};
use crate::likelihood::parameters::RUDDER_INDEX;
use crate::likelihood::schedule::COMPASS_SENSOR;
use crate::likelihood::tangents::fill_with_tangents;
use crate::likelihood::track::{MotionCoefficients, MotionColumns, TrialSignals};
use crate::likelihood::{NoiseParameters, NoiseVector, Schedule, whitener};

/// Number of unknowns that all records share: 1/T, K/T and (K/T) δ_r.
pub(super) const SHARED_PARAMETERS: usize = 3;

/// Record with its readings.
#[derive(Debug, Clone)]
pub(super) struct Record {
    pub signals: TrialSignals,
    pub schedule: Schedule,
    /// First rows after jumps of the compass by a constant.
    pub jump_rows: Vec<usize>,
    /// Declared standard deviation of the rudder error, rad. It fixes the rudder error of a noise vector, whose entry
    /// then represents the size of the compass error. `None` if it is not declared or not used.
    pub declared_rudder_sd: Option<f64>,
    /// Columns of the last 1/T: the filters of many noise laws share them.
    last_columns: RefCell<Option<Rc<RecordColumns>>>,
    /// Memory for the whitened rows of two filters.
    white: RefCell<[Vec<InterleavedRow>; 2]>,
}

/// Number of columns of the initial state, which come first.
const INITIAL_STATE: usize = 2;

/// Columns of the readings of one record for one 1/T.
#[derive(Debug, Clone)]
struct RecordColumns {
    /// 1/T, 1/s.
    inverse_T: f64,
    /// At every reading the constant, the response to the initial yaw rate, the responses to rudder and constant, the
    /// reading, and the derivatives of the three responses with respect to 1/T.
    rows: Vec<InterleavedRow>,
    /// Columns of the jumps.
    jumps: Vec<Vec<f64>>,
}

/// Whitened columns of one record, projected off the nuisance columns of its initial state and jumps: the responses to
/// rudder and constant, and the readings.
#[derive(Debug, Clone)]
pub(super) struct WhitenedColumns {
    /// Whitening filter of the record.
    pub filter: Whitener,
    /// Triangular factor R of the nuisance columns Q R of the initial state and the jumps.
    triangle: DMatrix<f64>,
    /// Responses to rudder and constant, and readings, projected off the nuisance columns.
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
    /// Heading (rad) and yaw rate (rad/s) at the anchor.
    pub anchor: YawState,
    /// Innovations over √S, rad.
    pub innovations: Vec<f64>,
    /// Contribution to −2 log L.
    pub deviance: f64,
    /// Additional contribution to −2 log of the restricted likelihood.
    pub log_determinant: f64,
    /// Sums of products of the sensitivities to 1/T, b and b δ_r.
    pub motion: Matrix3<f64>,
    /// Whitened columns.
    pub white: WhitenedColumns,
    /// Whitened sensitivity of the readings to 1/T, projected off the nuisance columns.
    pub by_inverse_T: Vec<f64>,
}

/// Start of a search: 1/T (1/s), and the noise vector of every record.
pub(super) type Start = (f64, Vec<NoiseVector>);

/// Best fit for a given 1/T and given noise of every record.
#[derive(Debug, Clone)]
pub(super) struct Point {
    /// 1/T, 1/s.
    pub inverse_T: f64,
    /// Noise vector of every record.
    pub vectors: Vec<NoiseVector>,
    /// −2 log L.
    pub deviance: f64,
    /// −2 log of the restricted likelihood.
    pub restricted_deviance: f64,
    /// b = K/T, 1/s².
    pub K_over_T: f64,
    /// b δ_r, rad/s².
    pub offset: f64,
    /// Likelihood contributions of the records.
    pub parts: Vec<RecordAtPoint>,
}

impl Record {
    pub fn new(signals: TrialSignals, by_row: bool, declared_rudder_sd: Option<f64>) -> Self {
        let schedule = Schedule::new(&signals, by_row);
        Self {
            signals,
            schedule,
            jump_rows: Vec::new(),
            declared_rudder_sd,
            last_columns: RefCell::default(),
            white: RefCell::default(),
        }
    }

    /// Number of readings.
    pub fn len(&self) -> usize {
        self.schedule.readings.len()
    }

    /// `true` if the yaw rate is among the readings.
    pub fn has_gyro(&self) -> bool {
        !self.signals.yaw_rates.is_empty()
    }

    /// Declared rudder error of a noise vector, rad; `None` without a declared or a fitted rudder error.
    pub fn declared_rudder_error(&self, vector: &NoiseVector) -> Option<f64> {
        self.declared_rudder_sd.filter(|_| vector.has_rudder_error)
    }

    /// Number of unknowns of the record alone: initial state and jumps.
    pub fn nuisance_count(&self) -> usize {
        INITIAL_STATE + self.jump_rows.len()
    }

    /// Regressor of a compass jump: 1 for headings from row `jump` on, 0 before and for yaw rates.
    fn step_at(&self, jump: usize) -> Vec<f64> {
        let heading: Vec<f64> = self.signals.heading_rows.iter().map(|&row| f64::from(u8::from(row >= jump))).collect();
        self.schedule.stacked(&heading, &vec![0.0; self.signals.yaw_rates.len()])
    }

    /// Columns of a ship with this 1/T; the columns of the last 1/T are cached.
    fn columns(&self, inverse_T: f64) -> Rc<RecordColumns> {
        let mut last = self.last_columns.borrow_mut();
        if let Some(columns) = last.as_ref().filter(|columns| columns.is_of(self, inverse_T)) {
            return Rc::clone(columns);
        }
        let columns = Rc::new(RecordColumns::new(self, inverse_T));
        *last = Some(Rc::clone(&columns));
        columns
    }

    /// Whitened columns for every pair of 1/T and noise; the filter of the noise may use another 1/T. `None` for a pair
    /// with a column that is not finite. Two filters advance side by side.
    fn whitened(&self, cases: &[(f64, NoiseParameters)]) -> Vec<Option<WhitenedColumns>> {
        let whitened_pair = |pair: &[(f64, NoiseParameters)]| {
            let case = |(inverse_T, noise): &(f64, NoiseParameters)| {
                (self.columns(*inverse_T), whitener(&self.schedule, noise, [0.0; 2]))
            };
            let cases: Vec<_> = pair.iter().map(case).collect();
            let [white, beside] = &mut *self.white.borrow_mut();
            match &cases[..] {
                [(columns, filter), (other, second)] => {
                    Whitener::apply_pair([filter, second], [&columns.rows, &other.rows], [white, beside]);
                }
                alone => alone.iter().for_each(|(columns, filter)| filter.apply_to_rows(&columns.rows, white)),
            }
            let project = |((columns, filter), white): ((Rc<RecordColumns>, Whitener), &mut Vec<InterleavedRow>)| {
                WhitenedColumns::new(&columns.jumps, filter, white)
            };
            cases.into_iter().zip([white, beside]).map(project).collect::<Vec<_>>()
        };
        cases.chunks(2).flat_map(whitened_pair).collect()
    }

    /// Products of the whitened sensitivities to (1/T, b, b δ_r) at given coefficients, with the initial state
    /// eliminated; divided by σ² they are the information of the motion. `None` if a product is not finite.
    pub fn information(
        &self,
        inverse_T: f64,
        vector: &NoiseVector,
        coefficients: &MotionCoefficients,
    ) -> Option<Matrix3<f64>> {
        let white = self.whitened(&[(inverse_T, vector.parameters(inverse_T))]).pop()??;
        let by_inverse_T = white.by_inverse_T(coefficients);
        let products = white.motion(&by_inverse_T);
        products.iter().all(|value| value.is_finite()).then_some(products)
    }
}

/// Projects a column off a unit column and returns the component.
fn project_off(unit: &[f64], column: &mut [f64]) -> f64 {
    let share = dot(unit, column);
    column.iter_mut().zip(unit).for_each(|(x, u)| *x -= share * u);
    share
}

/// Rows of one instrument: `one`, which is 1 for a heading and 0 for a yaw rate, φ₁, G and H, the reading, and the
/// derivatives of φ₁, G and H with respect to 1/T.
fn instrument_rows(
    one: f64,
    [homogeneous, rudder, constant]: [&[f64]; 3],
    readings: &[f64],
    [by_yaw_rate, by_rudder, by_constant]: [&[f64]; 3],
) -> impl Iterator<Item = InterleavedRow> {
    let motions = homogeneous.iter().zip(rudder).zip(constant).zip(readings);
    let rows = motions.zip(by_yaw_rate).zip(by_rudder).zip(by_constant);
    rows.map(move |((((((f, g), h), y), df), dg), dh)| [one, *f, *g, *h, *y, *df, *dg, *dh])
}

impl RecordColumns {
    fn new(record: &Record, inverse_T: f64) -> Self {
        let Record { signals, schedule, jump_rows: jumps, .. } = record;
        let (mut motion, mut by_inverse_T) = (MotionColumns::default(), MotionColumns::default());
        fill_with_tangents(signals, inverse_T, &mut motion, &mut by_inverse_T);
        let mut headings = instrument_rows(1.0, motion.headings(), &signals.heading, by_inverse_T.headings());
        let mut rates =
            instrument_rows(0.0, motion.rates.yaw_rates(), &signals.yaw_rates, by_inverse_T.rates.yaw_rates());
        let row =
            |reading: &SensorReading| if reading.sensor() == COMPASS_SENSOR { headings.next() } else { rates.next() };
        let mut rows = Vec::with_capacity(record.len());
        rows.extend(schedule.readings.iter().filter_map(row));
        Self { inverse_T, rows, jumps: jumps.iter().map(|&jump| record.step_at(jump)).collect() }
    }

    /// `true` if these are the columns of a record for this 1/T.
    fn is_of(&self, record: &Record, inverse_T: f64) -> bool {
        self.inverse_T == inverse_T && self.jumps.len() == record.jump_rows.len()
    }
}

impl WhitenedColumns {
    /// Projects whitened columns off those of the initial state and of the jumps, which are not whitened yet.
    fn new(jumps: &[Vec<f64>], filter: Whitener, rows: &mut [InterleavedRow]) -> Option<Self> {
        let count = INITIAL_STATE + jumps.len();
        let (mut columns, components) = rows::orthonormalise::<_, INITIAL_STATE, 6>(rows);
        let mut triangle = DMatrix::zeros(count, count);
        for j in 0..INITIAL_STATE {
            (j..INITIAL_STATE).for_each(|k| triangle[(j, k)] = components[j][k]);
        }
        let mut shares: [Vec<f64>; 3] =
            array::from_fn(|place| components.iter().map(|along| along[INITIAL_STATE + place]).collect());
        let lanes = if jumps.is_empty() { 0..0 } else { 0..INITIAL_STATE };
        let mut units: Vec<Vec<f64>> = lanes.map(|lane| rows.iter().map(|row| row[lane]).collect()).collect();
        for (k, jump) in (INITIAL_STATE..).zip(jumps) {
            let mut jump = jump.clone();
            filter.apply(&mut [&mut jump]);
            units.iter().enumerate().for_each(|(j, unit)| triangle[(j, k)] = project_off(unit, &mut jump));
            let length = dot(&jump, &jump).sqrt();
            triangle[(k, k)] = length;
            let per = if length > 0.0 { length.recip() } else { 0.0 };
            jump.iter_mut().for_each(|x| *x *= per);
            for (place, column) in columns.iter_mut().enumerate() {
                let share = project_off(&jump, column);
                shares.get_mut(place).into_iter().for_each(|shares| shares.push(share));
            }
            units.push(jump);
        }
        // An initial state that decays before the first row is not observable: its column has no length.
        if triangle.diagonal().iter().any(|length| length.is_nan()) {
            return None;
        }
        let [rudder, constant, readings, tangents @ ..] = columns;
        Some(Self { filter, triangle, projected: [rudder, constant, readings], tangents, shares })
    }

    /// Whitened sensitivity of the readings to 1/T at given coefficients, projected off the nuisance columns.
    fn by_inverse_T(&self, MotionCoefficients { anchor, K_over_T, offset }: &MotionCoefficients) -> Vec<f64> {
        let [by_yaw_rate, by_rudder, by_constant] = &self.tangents;
        let steered = by_rudder.iter().zip(by_constant).map(|(g, h)| K_over_T * g + offset * h);
        by_yaw_rate.iter().zip(steered).map(|(f, steered)| anchor.yaw_rate * f + steered).collect()
    }

    /// Information XᵀX of (1/T, b, b δ_r), from their whitened and projected sensitivities; that to 1/T is
    /// `by_inverse_T`.
    fn motion(&self, by_inverse_T: &[f64]) -> Matrix3<f64> {
        let [rudder, constant, _] = &self.projected;
        Matrix3::from(gram([by_inverse_T, rudder, constant]))
    }

    /// Whitened readings minus b G and b δ_r H, all projected off the nuisance columns.
    fn residual(&self, K_over_T: f64, offset: f64) -> Vec<f64> {
        let [rudder, constant, readings] = &self.projected;
        readings.iter().zip(rudder.iter().zip(constant)).map(|(psi, (g, h))| psi - K_over_T * g - offset * h).collect()
    }

    /// Heading and yaw rate at the anchor for given b and b δ_r, by back substitution; 0 where they are unobservable.
    fn start(&self, K_over_T: f64, offset: f64) -> Option<YawState> {
        let [rudder, constant, readings] = &self.shares;
        let along = (0..readings.len()).map(|k| readings[k] - K_over_T * rudder[k] - offset * constant[k]);
        let mut along = DVector::from_iterator(readings.len(), along);
        // An unobservable initial state is zero.
        let mut triangle = self.triangle.clone();
        for k in 0..triangle.nrows() {
            if triangle[(k, k)] == 0.0 {
                (triangle[(k, k)], along[k]) = (1.0, 0.0);
            }
        }
        let initial = triangle.solve_upper_triangular(&along)?;
        Some(YawState { heading: initial[0], yaw_rate: initial[1] })
    }
}

/// Weight of a record; `all` is the number of readings of all records.
fn weight(record: &Record, vector: &NoiseVector, white: &WhitenedColumns, all: usize) -> Weight {
    let readings = record.len() as f64;
    let fitted = record.nuisance_count() as f64 + SHARED_PARAMETERS as f64 * readings / all as f64;
    let [rudder, constant, measured] = &white.projected;
    Weight {
        products: gram([rudder, constant, measured]),
        readings,
        degrees_of_freedom: readings - fitted,
        compass_sd_per_gain: record.declared_rudder_error(vector).map(|sd| sd / vector.log_entries[RUDDER_INDEX].exp()),
    }
}

impl RecordAtPoint {
    /// Contributions of a record for the steering (b, b δ_r), for every noise vector with the 1/T of its filter, which
    /// may differ from that of the ship. `readings` is the number over all records. `None` if any is not finite.
    pub fn under(
        record: &Record,
        inverse_T: f64,
        steering: [f64; 2],
        noises: &[(NoiseVector, f64)],
        readings: usize,
    ) -> Option<Vec<Self>> {
        let cases = noises.iter().map(|(noise, filtered)| (inverse_T, noise.parameters(*filtered)));
        let whites = record.whitened(&cases.collect::<Vec<_>>());
        let part = |(white, (noise, _)): (Option<WhitenedColumns>, &(NoiseVector, f64))| {
            let white = white?;
            let weight = weight(record, noise, &white, readings);
            let variance = weight.variance(steering[0], steering[1]);
            Self::from_columns(record, steering, white, &weight, variance)
        };
        whites.into_iter().zip(noises).map(part).collect()
    }

    fn from_columns(
        record: &Record,
        [K_over_T, offset]: [f64; 2],
        white: WhitenedColumns,
        weight: &Weight,
        variance: f64,
    ) -> Option<Self> {
        let constant = (2.0 * std::f64::consts::PI * variance).ln();
        let deviance =
            weight.readings * constant + weight.rss(K_over_T, offset) / variance + white.filter.log_determinant;
        let anchor = white.start(K_over_T, offset)?;
        let lengths = white.triangle.diagonal();
        let seen = lengths.iter().filter(|&&length| length > 0.0);
        let log_determinant = seen.map(|length| (length * length / variance).ln()).sum::<f64>();
        let by_inverse_T = white.by_inverse_T(&MotionCoefficients { anchor, K_over_T, offset });
        let (motion, innovations) = (white.motion(&by_inverse_T), white.residual(K_over_T, offset));
        let readings = record.len();
        Some(Self { variance, readings, anchor, innovations, deviance, log_determinant, motion, white, by_inverse_T })
    }
}

/// Number of readings of all records, of compass and rate gyro.
pub(super) fn reading_count(records: &[Record]) -> usize {
    records.iter().map(Record::len).sum()
}

/// Best fit for every start: a 1/T and a noise vector of every record. `None` for a fit whose K/T is not positive or
/// whose likelihood is not finite.
pub(super) fn evaluate(records: &[Record], starts: &[Start]) -> Vec<Option<Point>> {
    let whitened = |(number, record): (usize, &Record)| {
        let cases = starts.iter().map(|(a, vectors)| (*a, vectors[number].parameters(*a)));
        record.whitened(&cases.collect::<Vec<_>>()).into_iter()
    };
    let mut whitened: Vec<_> = records.iter().enumerate().map(whitened).collect();
    let point = |start: &Start| {
        // Every record has a case for every start.
        let columns: Vec<Option<WhitenedColumns>> = whitened.iter_mut().map(|cases| cases.next()?).collect();
        point(records, start, columns.into_iter().collect::<Option<_>>()?)
    };
    starts.iter().map(point).collect()
}

/// Best b and b δ_r over all records from their whitened columns; `None` unless b is positive and the likelihood
/// finite.
fn point(records: &[Record], (inverse_T, vectors): &Start, columns: Vec<WhitenedColumns>) -> Option<Point> {
    let all = reading_count(records);
    let weights = records.iter().zip(vectors).zip(&columns);
    let weights: Vec<Weight> = weights.map(|((record, vector), white)| weight(record, vector, white, all)).collect();
    let (steering, variances) = weigh(&weights)?;
    let steering: [f64; 2] = steering.into();
    let parts = columns.into_iter().zip(weights.iter().zip(variances)).zip(records);
    let part =
        |((white, (weight, variance)), record)| RecordAtPoint::from_columns(record, steering, white, weight, variance);
    let parts = parts.map(part).collect::<Option<Vec<_>>>()?;
    let deviance = parts.iter().map(|part| part.deviance).sum::<f64>();
    let motion: Matrix3<f64> = parts.iter().map(|part| part.motion / part.variance).sum();
    let determinant = parts.iter().map(|part| part.log_determinant).sum::<f64>() + motion.determinant().ln();
    let [K_over_T, offset] = steering;
    let restricted_deviance = deviance + determinant;
    let ship = K_over_T > 0.0 && restricted_deviance.is_finite();
    ship.then(|| Point {
        inverse_T: *inverse_T,
        vectors: vectors.clone(),
        deviance,
        restricted_deviance,
        K_over_T,
        offset,
        parts,
    })
}
