//! All coefficients of a hull from records.

use nalgebra::{DMatrix, DVector};
use trial::Trial;

use super::coefficients::COEFFICIENTS;
use super::course::{OUTPUTS, WindowedRecord};
use super::error::MotionError;
use super::fit::fit;
use super::hull::{HULL_COEFFICIENTS, HullRecord, IdentifiedHull, Spread};
use super::hull_search::Windows;
use super::moment::moment;
use super::planar::Planar;
use super::search::{NormalEquations, Squares, determined, free, minimise, part, sandwich};
use super::yaw::{TYPICAL_YAW, YAW_SYMBOLS, Yaw};

/// Times the weights of the kinds of output are taken anew from their residuals.
const REWEIGHTED: usize = 2;

/// First guess of the residuals in units of L and U₀: heading, yaw rate, surge, sway.
const FIRST: [f64; OUTPUTS] = [0.01, 0.02, 0.01, 0.01];

/// Least residuals that are believed, in the same units.
const LEAST: f64 = 1e-6;

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
pub fn fit_hull(trials: &[Trial], length: f64) -> Result<IdentifiedHull, MotionError> {
    if !(length.is_finite() && length > 0.0) {
        return Err(MotionError::NotPositive { quantity: "length", value: length });
    }
    let usable: Vec<&Trial> = trials.iter().filter(|trial| WindowedRecord::of(trial, length, 1.0).is_some()).collect();
    if usable.is_empty() {
        return Err(MotionError::NoDrift { records: trials.len() });
    }
    let all: Vec<Trial> = usable.into_iter().cloned().collect();
    let whole = HullFit::of(&all, length, TYPICAL_YAW)?;
    let (covariance, spread) = match jackknife(&all, length, whole.yaw) {
        Some(covariance) => (covariance, Spread::Records),
        None => (whole.sandwich()?, Spread::Scores),
    };
    let HullFit { planar, yaw, courses } = &whole;
    let second = length / planar.approach_speed;
    let coefficients = whole.coefficients();
    let record = |(trial, course): (&Trial, &WindowedRecord)| {
        let windows = Windows::new(vec![course], false, [1.0; OUTPUTS]);
        let [heading, yaw_rate, ..] = windows.rms(coefficients.as_slice());
        HullRecord { name: trial.name().to_owned(), heading, yaw_rate: yaw_rate / second }
    };
    let records = all.iter().zip(courses).map(record).collect();
    let mut random = moment(courses, yaw);
    random.correlation_time *= second;
    Ok(IdentifiedHull {
        covariance: (0..HULL_COEFFICIENTS).map(|i| covariance.row(i).iter().copied().collect()).collect(),
        spread,
        moment: random,
        records,
        ..IdentifiedHull::new(planar.clone(), *yaw)
    })
}

/// Both fits and the records in units of length and approach speed.
struct HullFit {
    planar: Planar,
    yaw: Yaw,
    courses: Vec<WindowedRecord>,
}

impl HullFit {
    fn of(trials: &[Trial], length: f64, start: Yaw) -> Result<Self, MotionError> {
        let planar = fit(trials, length)?;
        let speeds = planar.records.iter().map(|record| record.approach_speed);
        let course = |(trial, speed)| WindowedRecord::of(trial, length, speed).expect("it has surge and sway");
        let courses: Vec<WindowedRecord> = trials.iter().zip(speeds).map(course).collect();
        let mut windows = Windows::new(courses.iter().collect(), true, FIRST);
        let mut at = DVector::from_vec([planar.coefficients(), start.to_array().to_vec()].concat());
        for round in 0..=REWEIGHTED {
            at = minimise(&windows, at).map_err(|iterations| MotionError::NoConvergence { iterations })?;
            if round < REWEIGHTED {
                windows.deviations = windows.rms(at.as_slice()).map(|rms| rms.max(LEAST));
            }
        }
        let (normal, free) = of_yaw(&windows, &at);
        determined(&normal, &free, symbol)?;
        let yaw = Yaw::from_array(std::array::from_fn(|i| at[COEFFICIENTS + i]));
        Ok(Self { planar, yaw, courses })
    }

    /// All coefficients.
    fn coefficients(&self) -> DVector<f64> {
        DVector::from_vec([self.planar.coefficients(), self.yaw.to_array().to_vec()].concat())
    }

    /// Block diagonal: that of surge and sway, and A⁻¹ S A⁻¹ of yaw.
    fn sandwich(&self) -> Result<DMatrix<f64>, MotionError> {
        let mut windows = Windows::new(self.courses.iter().collect(), true, [1.0; OUTPUTS]);
        let at = self.coefficients();
        windows.deviations = windows.rms(at.as_slice()).map(|rms| rms.max(LEAST));
        let (normal, free) = of_yaw(&windows, &at);
        let open = MotionError::Undetermined { symbol: YAW_SYMBOLS[0] };
        let inverse = part(&normal, &free).try_inverse().ok_or(open)?;
        let mut covariance = sandwich(&inverse, &windows.long_run(&at, |place| free.contains(&place)), &free);
        let of_planar = DMatrix::from_fn(COEFFICIENTS, COEFFICIENTS, |i, j| self.planar.covariance[i][j]);
        covariance.view_mut((0, 0), (COEFFICIENTS, COEFFICIENTS)).copy_from(&of_planar);
        Ok(covariance)
    }
}

fn symbol(unknown: usize) -> Option<&'static str> {
    YAW_SYMBOLS.get(unknown.checked_sub(COEFFICIENTS)?).copied()
}

/// The normal matrix, and the yaw coefficients that are at no bound.
fn of_yaw(windows: &Windows, at: &DVector<f64>) -> (DMatrix<f64>, Vec<usize>) {
    let NormalEquations { normal, gradient, .. } = windows.local(at);
    let free = free(windows, at, &gradient).into_iter().filter(|i| *i >= COEFFICIENTS).collect();
    (normal, free)
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
        Some(HullFit::of(&rest, length, start).ok()?.coefficients())
    };
    let found = (0..count).map(without).collect::<Option<Vec<_>>>()?;
    let mean = found.iter().sum::<DVector<f64>>() / count as f64;
    let spread: DMatrix<f64> = found.iter().map(|one| (one - &mean) * (one - &mean).transpose()).sum();
    Some(spread * ((count - 1) as f64 / count as f64))
}
