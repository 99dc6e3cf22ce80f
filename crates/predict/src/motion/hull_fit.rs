//! All coefficients of a hull from records.

use nalgebra::{DMatrix, DVector};
use trial::Trial;

use super::coefficients::COEFFICIENTS;
use super::course::{Course, OUTPUTS};
use super::covariance::newey_west;
use super::error::MotionError;
use super::fit::fit;
use super::hull::{HULL_COEFFICIENTS, Hull, HullRecord, Spread};
use super::hull_search::Windows;
use super::moment::moment;
use super::planar::Planar;
use super::search::{Local, Squares, free, minimise, part};
use super::yaw::{TYPICAL_YAW, YAW_SYMBOLS, Yaw};

/// Times the weights of the kinds of output are taken anew from their residuals.
const REWEIGHTED: usize = 2;

/// First guess of the residuals in units of L and U₀: heading, yaw rate, surge, sway.
const FIRST: [f64; OUTPUTS] = [0.01, 0.02, 0.01, 0.01];

/// Least residuals that are believed, in the same units.
const LEAST: f64 = 1e-6;

/// Least eigenvalue of the normal matrix with a diagonal of ones.
const OPEN: f64 = 1e-11;

/// Records from which their differences tell how well coefficients are known.
const JACKKNIFE: usize = 3;

/// Fits surge, sway and yaw to records of a ship of length `length` (m) that have rudder, heading or yaw rate, surge
/// and sway; others are left out.
///
/// Surge and sway are fitted first, by [`fit()`](super::fit::fit()). The yaw equation follows by output error: driven by
/// measured surge, sway and rudder it is integrated over windows of 10 L/U₀ that begin at measured states (all of them
/// smoothed by a parabola within 0.25 L/U₀), and heading and yaw rate are compared, weighed with their standard
/// deviations, which are taken twice from the residuals. With surge and sway measured the equation is damped, also
/// that of a ship that is unstable on a straight course.
///
/// The covariance is that of the jackknife over records when there are three or more and every fit to the others has
/// an answer, (n − 1)/n Σ (θᵢ − θ̄)(θᵢ − θ̄)ᵀ; else that of a sandwich. Field `spread` says which.
///
/// Fails as [`fit()`](super::fit::fit()) does, with [`MotionError::NoDrift`] when no record has both surge and sway, and
/// with [`MotionError::Undetermined`] when the records leave a coefficient of yaw open.
pub fn fit_hull(trials: &[Trial], length: f64) -> Result<Hull, MotionError> {
    if !(length.is_finite() && length > 0.0) {
        return Err(MotionError::NotPositive { quantity: "length", value: length });
    }
    let usable: Vec<&Trial> = trials.iter().filter(|trial| Course::of(trial, length, 1.0).is_some()).collect();
    if usable.is_empty() {
        return Err(MotionError::NoDrift { records: trials.len() });
    }
    let all: Vec<Trial> = usable.into_iter().cloned().collect();
    let whole = Fitted::of(&all, length, TYPICAL_YAW)?;
    let (covariance, spread) = match jackknife(&all, length, whole.yaw) {
        Some(covariance) => (covariance, Spread::Records),
        None => (whole.sandwich()?, Spread::Scores),
    };
    let Fitted { planar, yaw, courses } = &whole;
    let second = length / planar.approach_speed;
    let coefficients = [planar.coefficients(), yaw.to_array().to_vec()].concat();
    let record = |(trial, course): (&Trial, &Course)| {
        let windows = Windows { courses: vec![course], driven: false, deviations: [1.0; OUTPUTS] };
        let [heading, yaw_rate, ..] = windows.rms(&coefficients);
        HullRecord { name: trial.name().to_owned(), heading, yaw_rate: yaw_rate / second }
    };
    let records = all.iter().zip(courses).map(record).collect();
    let mut random = moment(courses, yaw);
    random.correlation_time *= second;
    Ok(Hull {
        covariance: (0..HULL_COEFFICIENTS).map(|i| covariance.row(i).iter().copied().collect()).collect(),
        spread,
        moment: random,
        records,
        ..Hull::new(planar.clone(), *yaw)
    })
}

/// Both fits and the records in units of length and approach speed.
struct Fitted {
    planar: Planar,
    yaw: Yaw,
    courses: Vec<Course>,
}

impl Fitted {
    fn of(trials: &[Trial], length: f64, start: Yaw) -> Result<Self, MotionError> {
        let planar = fit(trials, length)?;
        let speeds = planar.records.iter().map(|record| record.approach_speed);
        let course = |(trial, speed)| Course::of(trial, length, speed).expect("it has surge and sway");
        let courses: Vec<Course> = trials.iter().zip(speeds).map(course).collect();
        let mut windows = Windows { courses: courses.iter().collect(), driven: true, deviations: FIRST };
        let mut at = DVector::from_vec([planar.coefficients(), start.to_array().to_vec()].concat());
        for round in 0..=REWEIGHTED {
            at = minimise(&windows, at).map_err(|iterations| MotionError::NoConvergence { iterations })?;
            if round < REWEIGHTED {
                windows.deviations = windows.rms(at.as_slice()).map(|rms| rms.max(LEAST));
            }
        }
        windows.check(&at)?;
        let yaw = Yaw::from_array(std::array::from_fn(|i| at[COEFFICIENTS + i]));
        Ok(Self { planar, yaw, courses })
    }

    /// Block diagonal: that of surge and sway, and A⁻¹ S A⁻¹ of yaw.
    fn sandwich(&self) -> Result<DMatrix<f64>, MotionError> {
        let mut windows = Windows { courses: self.courses.iter().collect(), driven: true, deviations: [1.0; OUTPUTS] };
        let at = DVector::from_vec([self.planar.coefficients(), self.yaw.to_array().to_vec()].concat());
        windows.deviations = windows.rms(at.as_slice()).map(|rms| rms.max(LEAST));
        let Local { normal, gradient, .. } = windows.local(&at);
        let free: Vec<usize> = free(&windows, &at, &gradient).into_iter().filter(|i| *i >= COEFFICIENTS).collect();
        let mut middle = DMatrix::zeros(HULL_COEFFICIENTS, HULL_COEFFICIENTS);
        for place in windows.places() {
            let (residuals, slopes) = windows.derivatives(place, at.as_slice());
            let score = |i: &usize| -> Vec<f64> {
                let products = residuals.iter().zip(&slopes[*i]).map(|(r, s)| r * s).collect::<Vec<_>>();
                products.chunks(2).map(|row| row.iter().sum()).collect()
            };
            let long_run = newey_west(&free.iter().map(score).collect::<Vec<_>>());
            for (i, &row) in free.iter().enumerate() {
                for (j, &column) in free.iter().enumerate() {
                    middle[(row, column)] += long_run[(i, j)];
                }
            }
        }
        let open = MotionError::Undetermined { symbol: YAW_SYMBOLS[0] };
        let inverse = part(&normal, &free).try_inverse().ok_or(open)?;
        let own = &inverse * part(&middle, &free) * &inverse;
        let mut covariance = DMatrix::zeros(HULL_COEFFICIENTS, HULL_COEFFICIENTS);
        for i in 0..COEFFICIENTS {
            for j in 0..COEFFICIENTS {
                covariance[(i, j)] = self.planar.covariance[i][j];
            }
        }
        for (i, &row) in free.iter().enumerate() {
            for (j, &column) in free.iter().enumerate() {
                covariance[(row, column)] = 0.5 * (own[(i, j)] + own[(j, i)]);
            }
        }
        Ok(covariance)
    }
}

impl Windows<'_> {
    /// Fails when the yaw coefficients are not told.
    fn check(&self, at: &DVector<f64>) -> Result<(), MotionError> {
        let Local { normal, gradient, .. } = self.local(at);
        let free: Vec<usize> = free(self, at, &gradient).into_iter().filter(|i| *i >= COEFFICIENTS).collect();
        let symbol = |i: usize| YAW_SYMBOLS[free[i] - COEFFICIENTS];
        let scale: Vec<f64> = free.iter().map(|&i| normal[(i, i)].sqrt()).collect();
        if let Some(open) = scale.iter().position(|scale| scale.is_nan() || *scale <= 0.0) {
            return Err(MotionError::Undetermined { symbol: symbol(open) });
        }
        let unit = DMatrix::from_fn(free.len(), free.len(), |i, j| normal[(free[i], free[j])] / (scale[i] * scale[j]));
        let eigen = unit.symmetric_eigen();
        let (least, value) = eigen.eigenvalues.argmin();
        if value.is_nan() || value < OPEN {
            let weighs = eigen.eigenvectors.column(least).iamax();
            return Err(MotionError::Undetermined { symbol: symbol(weighs) });
        }
        Ok(())
    }
}

/// (n − 1)/n Σ (θᵢ − θ̄)(θᵢ − θ̄)ᵀ over the fits to all records but one; `None` with too few records or where one of
/// the fits has no answer.
fn jackknife(trials: &[Trial], length: f64, start: Yaw) -> Option<DMatrix<f64>> {
    let count = trials.len();
    if count < JACKKNIFE {
        return None;
    }
    let without = |left_out: usize| {
        let mut rest = trials.to_vec();
        rest.remove(left_out);
        let found = Fitted::of(&rest, length, start).ok()?;
        Some(DVector::from_vec([found.planar.coefficients(), found.yaw.to_array().to_vec()].concat()))
    };
    let found = (0..count).map(without).collect::<Option<Vec<_>>>()?;
    let mean = found.iter().sum::<DVector<f64>>() / count as f64;
    let spread: DMatrix<f64> = found.iter().map(|one| (one - &mean) * (one - &mean).transpose()).sum();
    Some(spread * ((count - 1) as f64 / count as f64))
}
