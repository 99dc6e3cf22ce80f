//! The likelihood as a function of 1/T and the noise alone: given these, the heading is linear in everything else, and
//! the size of the compass error follows from what is left.
//!
//! The noise is judged by the restricted likelihood, −2 log L + log det(JᵀJ) with the whitened sensitivities J by all
//! other unknowns: the likelihood of what these cannot move, which does not take the noise for smaller because some of
//! it was fitted (Patterson and Thompson 1971; Cox and Reid 1987 for unknowns that are not linear).

use estimation::column::{dot, gram};
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector2};
use ship::first_order::State;

use crate::likelihood::parameters::RUDDER;
use crate::likelihood::track::{Coefficients, MotionColumns, Track};
use crate::likelihood::{NoiseParameters, NoiseVector, Schedule, whitener};
use crate::profile::solve2;
use estimation::kalman::Whitener;

/// Unknowns that all records share: 1/T, K/T and (K/T) δ_r.
pub(super) const SHARED: usize = 3;

/// Rounds in which records of one ship settle how much each of them counts.
const WEIGHINGS: usize = 20;

/// Relative change of the variances below which they have.
const WEIGHED: f64 = 1e-12;

/// One record with its readings.
#[derive(Debug, Clone)]
pub(super) struct Record {
    pub track: Track,
    pub schedule: Schedule,
    /// Rows from which on the compass is off by a constant.
    pub jumps: Vec<usize>,
    /// Declared standard deviation of the rudder error, rad. Where a place has a rudder error it is this one, and its
    /// entry stands for the size of the compass error.
    pub declared: Option<f64>,
}

/// White columns of one record: motions of its own start and jumps, orthonormal; and responses to rudder and constant,
/// and the readings, the own ones taken out of them.
#[derive(Debug, Clone)]
pub(super) struct White {
    pub filter: Whitener,
    pub own: Vec<Vec<f64>>,
    /// Leads from the orthonormal columns back to those of the start and the jumps.
    triangle: DMatrix<f64>,
    pub rest: [Vec<f64>; 3],
    /// Parts of the others along the own columns.
    shares: [Vec<f64>; 3],
}

/// What a record says at a point.
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
    /// What it adds to −2 log L, and beside it to the restricted one.
    pub deviance: f64,
    pub determinant: f64,
    /// Products of what changes with 1/T, b and b δ_r.
    pub motion: Matrix3<f64>,
    pub white: White,
    /// How the readings change with 1/T: white, the own columns taken out.
    pub by_time: Vec<f64>,
}

/// The best fit for one 1/T and one noise of every record.
#[derive(Debug, Clone)]
pub(super) struct Point {
    pub inverse_time: f64,
    pub places: Vec<NoiseVector>,
    /// −2 log L, and the same of the restricted likelihood.
    pub deviance: f64,
    pub restricted: f64,
    /// b = K/T, 1/s², and b δ_r, rad/s².
    pub gain: f64,
    pub offset: f64,
    pub parts: Vec<RecordAtPoint>,
}

impl Record {
    pub fn new(track: Track, by_row: bool) -> Self {
        let schedule = Schedule::new(&track, by_row);
        Self { track, schedule, jumps: Vec::new(), declared: None }
    }

    /// Number of readings.
    pub fn len(&self) -> usize {
        self.schedule.readings.len()
    }

    /// Whether the yaw rate is among the readings.
    pub fn has_gyro(&self) -> bool {
        !self.track.rates.is_empty()
    }

    /// Declared rudder error of a place, rad.
    pub fn tied(&self, place: &NoiseVector) -> Option<f64> {
        self.declared.filter(|_| place.rudder)
    }

    /// Unknowns of the record alone.
    fn own(&self) -> usize {
        2 + self.jumps.len()
    }

    /// One from a row on in headings, zero in yaw rates.
    fn step_at(&self, jump: usize) -> Vec<f64> {
        let heading: Vec<f64> = self.track.observed.iter().map(|&row| f64::from(u8::from(row >= jump))).collect();
        self.schedule.stacked(&heading, &vec![0.0; self.track.rates.len()])
    }

    /// The columns of a ship with this 1/T made white under a noise, whose filter may take another 1/T. `None` when a
    /// column is not finite.
    fn white(&self, inverse_time: f64, noise: &NoiseParameters) -> Option<White> {
        let mut columns = MotionColumns::default();
        self.track.fill(inverse_time, &mut columns);
        let MotionColumns { homogeneous, rudder, constant, rates } = &columns;
        let ones = self.schedule.stacked(&vec![1.0; homogeneous.len()], &vec![0.0; self.track.rates.len()]);
        let mut own = vec![ones, self.schedule.stacked(homogeneous, &rates.homogeneous)];
        own.extend(self.jumps.iter().map(|&jump| self.step_at(jump)));
        let rest = [
            self.schedule.stacked(rudder, &rates.rudder),
            self.schedule.stacked(constant, &rates.constant),
            self.schedule.stacked(&self.track.heading, &self.track.rates),
        ];
        White::new(own, rest, whitener(&self.schedule, noise, [0.0; 2]))
    }

    /// How the readings change with 1/T at known coefficients: white, the own columns taken out.
    fn by_time(&self, white: &White, inverse_time: f64, coefficients: &Coefficients) -> Vec<f64> {
        let (mut by_heading, mut by_rate) = (Vec::new(), Vec::new());
        self.track.sensitivities(inverse_time, coefficients, [&mut by_heading, &mut by_rate]);
        let mut column = self.schedule.stacked(&by_heading, &by_rate);
        white.filter.apply(&mut [&mut column]);
        white.own.iter().for_each(|unit| _ = take_out(unit, &mut column));
        column
    }

    /// Products of the whitened sensitivities by (1/T, b, b δ_r) at known coefficients, the start eliminated; over σ²
    /// they are the information of the motion.
    pub fn information(
        &self,
        inverse_time: f64,
        place: &NoiseVector,
        coefficients: &Coefficients,
    ) -> Option<Matrix3<f64>> {
        let white = self.white(inverse_time, &place.parameters(inverse_time))?;
        let by_time = self.by_time(&white, inverse_time, coefficients);
        let products = white.motion(&by_time);
        products.iter().all(|value| value.is_finite()).then_some(products)
    }
}

/// Takes a unit column out of another one and returns its part along it.
pub(super) fn take_out(unit: &[f64], column: &mut [f64]) -> f64 {
    let share = dot(unit, column);
    column.iter_mut().zip(unit).for_each(|(x, u)| *x -= share * u);
    share
}

impl White {
    fn new(mut own: Vec<Vec<f64>>, mut rest: [Vec<f64>; 3], filter: Whitener) -> Option<Self> {
        let (first, jumps) = own.split_at_mut(2);
        let [one, two] = first else { return None };
        let [three, four, five] = &mut rest;
        filter.apply(&mut [one, two, three, four, five]);
        jumps.iter_mut().for_each(|jump| filter.apply(&mut [jump]));
        let count = own.len();
        let mut triangle = DMatrix::zeros(count, count);
        for k in 0..count {
            let (before, column) = own.split_at_mut(k);
            for (j, unit) in before.iter().enumerate() {
                triangle[(j, k)] = take_out(unit, &mut column[0]);
            }
            let length = dot(&column[0], &column[0]).sqrt();
            triangle[(k, k)] = length;
            if length.is_nan() {
                return None;
            }
            // A start that is over before the first row is not seen.
            let per = if length > 0.0 { length.recip() } else { 0.0 };
            column[0].iter_mut().for_each(|x| *x *= per);
        }
        let shares = rest.each_mut().map(|column| own.iter().map(|unit| take_out(unit, column)).collect());
        Some(Self { filter, own, triangle, rest, shares })
    }

    /// Products of what changes with 1/T, b and b δ_r.
    fn motion(&self, by_time: &[f64]) -> Matrix3<f64> {
        let [rudder, constant, _] = &self.rest;
        Matrix3::from(gram([by_time, rudder, constant]))
    }

    /// Readings less what steering explains.
    fn residual(&self, gain: f64, offset: f64) -> Vec<f64> {
        let [rudder, constant, readings] = &self.rest;
        readings.iter().zip(rudder.iter().zip(constant)).map(|(psi, (g, h))| psi - gain * g - offset * h).collect()
    }

    /// State at the anchor.
    fn start(&self, gain: f64, offset: f64) -> Option<State> {
        let [rudder, constant, readings] = &self.shares;
        let along = (0..readings.len()).map(|k| readings[k] - gain * rudder[k] - offset * constant[k]);
        let mut along = DVector::from_iterator(readings.len(), along);
        // An unseen start is none.
        let mut triangle = self.triangle.clone();
        for k in 0..triangle.nrows() {
            if triangle[(k, k)] == 0.0 {
                (triangle[(k, k)], along[k]) = (1.0, 0.0);
            }
        }
        let found = triangle.solve_upper_triangular(&along)?;
        Some(State { heading: found[0], yaw_rate: found[1] })
    }
}

/// What decides how much a record counts.
struct Weight {
    /// Products of the responses to rudder and constant and the readings.
    products: [[f64; 3]; 3],
    readings: f64,
    /// Readings less the unknowns that are fitted to them.
    freedom: f64,
    /// Compass error of a ship with b = 1, rad, where the rudder error is declared.
    tied: Option<f64>,
}

impl Weight {
    /// That of a record among so many readings of `all`.
    fn new(record: &Record, place: &NoiseVector, white: &White, all: usize) -> Self {
        let readings = record.len() as f64;
        let fitted = record.own() as f64 + SHARED as f64 * readings / all as f64;
        let [rudder, constant, measured] = &white.rest;
        Self {
            products: gram([rudder, constant, measured]),
            readings,
            freedom: readings - fitted,
            tied: record.tied(place).map(|sd| sd / place.log[RUDDER].exp()),
        }
    }

    fn square(&self, b: f64, q: f64) -> f64 {
        let [[gg, gh, gy], [_, hh, hy], [.., yy]] = self.products;
        // Products know no square below their rounding: a record without noise keeps that much.
        let rounding = (f64::EPSILON * yy).max(f64::MIN_POSITIVE);
        (yy - 2.0 * (b * gy + q * hy) + b * b * gg + 2.0 * b * q * gh + q * q * hh).max(rounding)
    }

    fn variance(&self, b: f64, q: f64) -> f64 {
        self.tied.map_or(self.square(b, q) / self.freedom, |unit| (b * unit).powi(2))
    }
}

/// The best b and b δ_r over all records, and the variance of the compass error in every record.
fn weigh(weights: &[Weight]) -> Option<(Vector2<f64>, Vec<f64>)> {
    let mut variances = vec![1.0; weights.len()];
    let mut best = Vector2::zeros();
    for _ in 0..WEIGHINGS {
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
        if weights.len() == 1 || moved < WEIGHED {
            break;
        }
    }
    Some((best, variances))
}

impl RecordAtPoint {
    /// What a record says at known steering, under the noise of a place whose filter may take another 1/T, `filtered`.
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
        Self::of(record, inverse_time, steering, white, &weight, variance)
    }

    fn of(
        record: &Record,
        inverse_time: f64,
        [gain, offset]: [f64; 2],
        white: White,
        weight: &Weight,
        variance: f64,
    ) -> Option<Self> {
        let constant = (2.0 * std::f64::consts::PI * variance).ln();
        let deviance = weight.readings * constant + weight.square(gain, offset) / variance + white.filter.log_variance;
        let anchor = white.start(gain, offset)?;
        let lengths = white.triangle.diagonal();
        let seen = lengths.iter().filter(|&&length| length > 0.0);
        let determinant = seen.map(|length| (length * length / variance).ln()).sum::<f64>();
        let by_time = record.by_time(&white, inverse_time, &Coefficients { anchor, gain, offset });
        let (motion, innovations) = (white.motion(&by_time), white.residual(gain, offset));
        let readings = record.len();
        Some(Self { variance, readings, anchor, innovations, deviance, determinant, motion, white, by_time })
    }
}

/// Readings of all records.
pub(super) fn readings(records: &[Record]) -> usize {
    records.iter().map(Record::len).sum()
}

/// The best fit for one 1/T and these places, one a record. `None` when it is no ship or not finite.
pub(super) fn evaluate(records: &[Record], inverse_time: f64, places: &[NoiseVector]) -> Option<Point> {
    let columns =
        |(record, place): (&Record, &NoiseVector)| record.white(inverse_time, &place.parameters(inverse_time));
    let columns = records.iter().zip(places).map(columns).collect::<Option<Vec<White>>>()?;
    let all = readings(records);
    let weight = |((record, place), white): ((&Record, &NoiseVector), &White)| Weight::new(record, place, white, all);
    let weights: Vec<Weight> = records.iter().zip(places).zip(&columns).map(weight).collect();
    let (steering, variances) = weigh(&weights)?;
    let steering: [f64; 2] = steering.into();
    let parts = columns.into_iter().zip(weights.iter().zip(variances)).zip(records);
    let part = |((white, (weight, variance)), record)| {
        RecordAtPoint::of(record, inverse_time, steering, white, weight, variance)
    };
    let parts = parts.map(part).collect::<Option<Vec<_>>>()?;
    let deviance = parts.iter().map(|part| part.deviance).sum::<f64>();
    let motion: Matrix3<f64> = parts.iter().map(|part| part.motion / part.variance).sum();
    let determinant = parts.iter().map(|part| part.determinant).sum::<f64>() + motion.determinant().ln();
    let [gain, offset] = steering;
    let restricted = deviance + determinant;
    let ship = gain > 0.0 && restricted.is_finite();
    ship.then(|| Point { inverse_time, places: places.to_vec(), deviance, restricted, gain, offset, parts })
}
