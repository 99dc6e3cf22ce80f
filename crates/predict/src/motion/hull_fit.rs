//! All coefficients of a hull from records.

use nalgebra::{DMatrix, DVector};
use trial::Trial;

use super::coefficients::{COEFFICIENTS, PlanarCoefficients};
use super::error::{MotionError, positive};
use super::fit::fit;
use super::hull::{HULL_COEFFICIENTS, HullRecord, IdentifiedHull, Spread};
use super::moment::moment;
use super::planar::Planar;
use super::search::GroupedSquares;
use super::windows::{OUTPUTS, WindowedRecord};
use super::yaw::{TYPICAL_YAW, YAW_BOUNDS, YAW_COEFFICIENTS, YAW_SYMBOLS, Yaw};

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
/// Surge and sway are fitted first, by [`fit()`](super::fit::fit()). The yaw equation follows by output error: driven
/// by measured surge, sway and rudder it is integrated over windows of 10 L/U₀ that begin at measured states (all of
/// them smoothed by a parabola within 0.25 L/U₀), and heading and yaw rate are compared, weighed with their standard
/// deviations, which are taken twice from the residuals. With surge and sway measured the equation is damped, also that
/// of a ship that is unstable on a straight course.
///
/// The covariance is that of the jackknife over records when there are three or more and every fit to the others has
/// an answer, (n − 1)/n Σ (θᵢ − θ̄)(θᵢ − θ̄)ᵀ; else that of a sandwich. Field `spread` says which.
///
/// Fails as [`fit()`](super::fit::fit()) does, with [`MotionError::NoDrift`] when no record has both surge and sway,
/// and with [`MotionError::Undetermined`] when the records leave a coefficient of yaw open.
pub fn fit_hull(trials: &[Trial], length: f64) -> Result<IdentifiedHull, MotionError> {
    positive("length", length)?;
    let is_usable = |trial: &&Trial| WindowedRecord::of(trial, length, 1.0).is_some();
    let usable: Vec<Trial> = trials.iter().filter(is_usable).cloned().collect();
    if usable.is_empty() {
        return Err(MotionError::NoDrift { records: trials.len() });
    }
    let whole = HullFit::of(&usable, length, TYPICAL_YAW)?;
    let (covariance, spread) = match jackknife(&usable, length, whole.yaw) {
        Some(covariance) => (covariance, Spread::Records),
        None => (whole.sandwich()?, Spread::Scores),
    };
    let HullFit { planar, yaw, records } = whole;
    let second = length / planar.approach_speed;
    let summary = |(trial, record): (&Trial, &WindowedRecord)| {
        let [heading, yaw_rate, ..] = rms(std::slice::from_ref(record), Some(&planar.coefficients), &yaw);
        HullRecord { name: trial.name().to_owned(), heading, yaw_rate: yaw_rate / second }
    };
    let mut random = moment(&records, &yaw);
    random.correlation_time *= second;
    Ok(IdentifiedHull {
        covariance: (0..HULL_COEFFICIENTS).map(|i| covariance.row(i).iter().copied().collect()).collect(),
        spread,
        moment: random,
        records: usable.iter().zip(&records).map(summary).collect(),
        planar,
        yaw,
    })
}

/// Both fits and the records in units of length and approach speed.
struct HullFit {
    planar: Planar,
    yaw: Yaw,
    records: Vec<WindowedRecord>,
}

impl HullFit {
    fn of(trials: &[Trial], length: f64, start: Yaw) -> Result<Self, MotionError> {
        let planar = fit(trials, length)?;
        let speeds = planar.records.iter().map(|record| record.approach_speed);
        let record = |(trial, speed)| WindowedRecord::of(trial, length, speed).expect("it has surge and sway");
        let records: Vec<WindowedRecord> = trials.iter().zip(speeds).map(record).collect();
        let mut deviations = FIRST;
        let mut at = start.to_array().to_vec();
        for round in 0..=REWEIGHTED {
            at = squares(&records, deviations).minimise(&at)?;
            if round < REWEIGHTED {
                deviations = believed(&records, &yaw_of(&at));
            }
        }
        squares(&records, deviations).inverse(&at, &YAW_SYMBOLS)?;
        Ok(Self { planar, yaw: yaw_of(&at), records })
    }

    /// Block diagonal: that of surge and sway, and A⁻¹ S A⁻¹ of yaw.
    fn sandwich(&self) -> Result<DMatrix<f64>, MotionError> {
        let squares = squares(&self.records, believed(&self.records, &self.yaw));
        let of_yaw = squares.covariance(&self.yaw.to_array(), &YAW_SYMBOLS, false)?;
        let of_planar = DMatrix::from_fn(COEFFICIENTS, COEFFICIENTS, |i, j| self.planar.covariance[i][j]);
        let mut covariance = DMatrix::zeros(HULL_COEFFICIENTS, HULL_COEFFICIENTS);
        covariance.view_mut((0, 0), of_planar.shape()).copy_from(&of_planar);
        covariance.view_mut((COEFFICIENTS, COEFFICIENTS), of_yaw.shape()).copy_from(&of_yaw);
        Ok(covariance)
    }
}

fn yaw_of(at: &[f64]) -> Yaw {
    Yaw::from_array(std::array::from_fn(|i| at[i]))
}

/// Errors of the yaw equation in all windows, driven by measured surge, sway and rudder, over their deviations.
fn squares(records: &[WindowedRecord], deviations: [f64; OUTPUTS]) -> GroupedSquares<'_> {
    let of = |record: &'_ WindowedRecord| 0..record.windows.len();
    let windows: Vec<(usize, usize)> =
        records.iter().enumerate().flat_map(|(index, record)| of(record).map(move |window| (index, window))).collect();
    GroupedSquares {
        groups: vec![(0..YAW_COEFFICIENTS).collect(); windows.len()],
        bounds: YAW_BOUNDS.to_vec(),
        scales: vec![0.1; YAW_COEFFICIENTS],
        residuals: Box::new(move |group, at| {
            let (index, window) = windows[group];
            let mut errors = records[index].errors(window, None, &yaw_of(at));
            errors.column_iter_mut().zip(deviations).for_each(|(mut column, deviation)| column /= deviation);
            errors
        }),
    }
}

/// Root mean squares of the errors in units of L and U₀, output by output.
fn rms(records: &[WindowedRecord], planar: Option<&PlanarCoefficients>, yaw: &Yaw) -> [f64; OUTPUTS] {
    let (mut squares, mut counts) = ([0.0; OUTPUTS], [0.0; OUTPUTS]);
    for record in records {
        for errors in (0..record.windows.len()).map(|window| record.errors(window, planar, yaw)) {
            for (output, column) in errors.column_iter().enumerate() {
                squares[output] += column.norm_squared();
                counts[output] += column.iter().filter(|error| **error != 0.0).count() as f64;
            }
        }
    }
    std::array::from_fn(|i| (squares[i] / f64::max(counts[i], 1.0)).sqrt())
}

/// Deviations of the outputs as the errors show them.
fn believed(records: &[WindowedRecord], yaw: &Yaw) -> [f64; OUTPUTS] {
    rms(records, None, yaw).map(|rms| rms.max(LEAST))
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
        let HullFit { planar, yaw, .. } = HullFit::of(&rest, length, start).ok()?;
        Some(DVector::from_vec([&planar.coefficients.to_array()[..], &yaw.to_array()].concat()))
    };
    let found = (0..count).map(without).collect::<Option<Vec<_>>>()?;
    let mean = found.iter().sum::<DVector<f64>>() / count as f64;
    let spread: DMatrix<f64> = found.iter().map(|one| (one - &mean) * (one - &mean).transpose()).sum();
    Some(spread * ((count - 1) as f64 / count as f64))
}
