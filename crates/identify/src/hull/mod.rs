//! A hull of three degrees of freedom fitted to records of heading and rudder, about what is expected of it.
//!
//! The rudder that was recorded is replayed through the hull ([`ship::vessel::prime`]), over the whole record and over
//! windows of 3.5 L/U₀; heading and yaw rate at the start are fitted, speed and sway begin as measured (or at approach
//! speed) and run on. Positions give the speed of a record that has none. Minimised is
//!
//! J = 1/n Σ_records (T U₀/L) [ē²/σ² of the whole replay + the same of the windows + of the speed where it was
//! recorded]
//!   + (θ − μ)ᵀ Λ (θ − μ) + ((r L/U − 0.75)/0.25)² + ((−v/(r L) − 0.35)/0.12)² in a turn with 35° of rudder
//!
//! with the standard deviations of [`HullDeviations`], which are those of the form and not of a sensor: no hull of ten
//! or twenty numbers is the ship. They start large and follow what is left of every record, to 1°, 0.2° and 0.1 U₀.
//! A sway velocity is not fitted: logs do not say of which point of the ship it is. Nor is a yaw rate beside the
//! heading. In the whole replay, with a deviation of at least 0.02 U₀/L, it made the heading error on other records of
//! KVLCC2 0.96 ± 0.02 times what it is without, and smaller in 5 of 11 sets.
//!
//! The n records of a ship count as one of their mean length: the error of the form is much the same in all of them.
//! The turn is one that nearly every ship makes; zig-zags say little of it, and a form fitted to them may do anything
//! there.
//!
//! The covariance is the inverse of the second derivatives of J/2, so it holds the error of the form as far as that is
//! another in every ship length of a record. Firm priors are what lets one record tell so many coefficients; without
//! them the fitted hull is unstable as often as not.

mod conflict;
mod error;
mod expected;
mod moment;
mod objective;
mod replayed;
mod track;
mod turn;
mod weighed;

use std::f64::consts::PI;

use estimation::levenberg_marquardt::{End, Rules, minimise};
use estimation::number::Real;
use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;
use ship::Polyline;
use ship::vessel::scaled::ScaledHull;
use trial::Trial;

pub use conflict::ExpectationCheck;
pub use error::HullFitError;
pub use expected::{EarlierHull, ExpectedHull, is_other_froude_number};
pub use moment::FormMoment;
pub use objective::HullDeviations;
use objective::{HullObjective, variances};
pub use track::HullReference;
use track::HullTrack;
pub use weighed::after_earlier;

/// How a search proceeds.
const RULES: Rules = Rules {
    steps: 40,
    damping: 1e-2,
    shrink: 0.2,
    trusted: 0.25,
    grow: 4.0,
    least: [1e-9, 1e-4],
    tries: 14,
    promise: 1e-3,
    enough: [1e-3, 1e-5],
    in_a_row: 2,
};

/// Times the records are believed anew from what is left of them.
const REWEIGHED: usize = 3;

/// What is left of one record.
#[derive(Debug, Clone, PartialEq)]
pub struct HullResidual {
    /// Name of the record.
    pub name: String,
    /// Root mean square heading error of the whole replay, rad.
    pub whole: f64,
    /// The same in windows of 3.5 L/U₀, rad.
    pub window: f64,
    /// Yaw rate with which the whole replay begins, rad/s.
    pub begins_with: f64,
}

/// A hull with what is known of its coefficients.
#[derive(Debug, Clone)]
pub struct HullEstimate {
    /// The form, and what was expected of its coefficients.
    pub expected: ExpectedHull,
    /// Length, speed and propeller that it is measured with.
    pub reference: HullReference,
    /// The coefficients.
    pub values: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
    /// Its records.
    pub records: Vec<HullResidual>,
    /// What the form leaves of them, as a random moment.
    pub moment: FormMoment,
}

/// Fits a hull about what is expected of its coefficients to records of one ship.
///
/// Fails where length or speed of the ship are not known, where a record has fewer than twenty headings, rows or a
/// length that no trial of a ship has or begins near rest, and where no values near the expected ones can be replayed.
pub fn fit(trials: &[Trial], expected: &ExpectedHull) -> Result<HullEstimate, HullFitError> {
    let (reference, tracks) = tracks(trials)?;
    let form = &expected.form;
    let mut problem = HullObjective::new(expected, &tracks);
    let mut at = expected.mean();
    let mut found = minimise(&mut problem, at, &RULES);
    // Each record is believed the more the nearer the hull has come: the way down avoids far minima.
    for _ in 0..REWEIGHED {
        problem.reweigh(found.at.as_slice());
        at = found.at;
        found = minimise(&mut problem, at, &RULES);
    }
    if found.end == End::NotFinite {
        return Err(HullFitError::NoReplay);
    }
    let covariance = Cholesky::new(found.normal.matrix.clone()).map(|factor| factor.inverse());
    let covariance = covariance.ok_or(HullFitError::NoReplay)?;
    let left = problem.left(found.at.as_slice()).unwrap_or_default();
    let residual = |(trial, left): (&Trial, objective::Left)| HullResidual {
        name: trial.name().to_owned(),
        whole: left.whole.sqrt(),
        window: left.window.sqrt(),
        begins_with: left.begins_with / reference.time(),
    };
    let moment = FormMoment::of(&form.with(found.at.as_slice()).ok_or(HullFitError::NoReplay)?, &tracks, &left);
    let moment = FormMoment { correlation_time: moment.correlation_time * reference.time(), ..moment };
    let records = trials.iter().zip(left).map(residual).collect();
    let expected = expected.clone();
    Ok(HullEstimate { expected, reference, values: found.at, covariance, records, moment })
}

/// Why no hull can be fitted to some records of one ship; `None` where one can.
pub fn refusal(trials: &[Trial]) -> Option<HullFitError> {
    tracks(trials).err()
}

/// The records of one ship without dimension, and what they are measured with.
fn tracks(trials: &[Trial]) -> Result<(HullReference, Vec<HullTrack>), HullFitError> {
    let reference = trials.iter().find_map(HullReference::of).ok_or(HullFitError::Particulars)?;
    let tracks = trials.iter().map(|trial| HullTrack::of(trial, &reference)).collect::<Result<_, _>>()?;
    Ok((reference, tracks))
}

/// A hull that leaves this many times what another model leaves takes no part.
const FAR: f64 = 3.0;

/// The hulls of all forms that can be fitted to records of one ship, about what earlier trials told of her.
pub fn fit_all(trials: &[Trial], earlier: &[EarlierHull]) -> Vec<HullEstimate> {
    let expected = ExpectedHull::of_ship(trials.iter().find_map(Trial::hull).as_ref(), earlier);
    expected.par_iter().filter_map(|own| fit(trials, own).ok()).collect()
}

/// Those of some hulls that their records speak for: they leave no more than three times what the best of them leaves
/// of whole records, or another model (`rival`, rad; infinite without one).
pub fn members(found: Vec<HullEstimate>, rival: f64) -> Vec<HullEstimate> {
    let left = |hull: &HullEstimate| hull.mean_square().sqrt();
    let least = found.iter().map(left).fold(rival, f64::min);
    found.into_iter().filter(|hull| left(hull) <= FAR * least).collect()
}

impl HullEstimate {
    /// The hull, ready to be replayed.
    pub fn ship<R: Real>(&self) -> ScaledHull<R> {
        let values: Vec<R> = self.values.iter().map(|&value| R::from(value)).collect();
        let HullReference { length, speed, propeller } = self.reference;
        let hull = self.expected.form.with(&values).expect("it was replayed");
        ScaledHull { hull, length, speed, propeller }
    }

    /// Variance of the heading of the replay of a record over time (s), rad²: by the covariance of the coefficients,
    /// and by what the form has left of the records of the fit. `None` for a record that cannot be replayed, and where
    /// the standard deviation is more than half a turn, which no linear law says.
    pub fn heading_variance(&self, trial: &Trial) -> Option<Polyline> {
        let track = HullTrack::of(trial, &self.reference).ok()?;
        let [time, mut variance] = variances(&self.expected, &track, self.values.as_slice(), &self.covariance)?;
        let left = self.mean_square();
        variance.iter_mut().for_each(|own| *own += left);
        if variance.iter().any(|own| *own > PI * PI) {
            return None;
        }
        Polyline::new(time.into_iter().map(|t| t * track.second).collect(), variance).ok()
    }

    /// The records against what was expected of the ship; `None` where they tell nothing new.
    pub fn check(&self) -> Option<ExpectationCheck> {
        ExpectationCheck::of(&self.expected, &self.values, &self.covariance)
    }

    /// Mean square of what it leaves of whole records, rad².
    pub fn mean_square(&self) -> f64 {
        self.records.iter().map(|record| record.whole * record.whole).sum::<f64>() / self.records.len() as f64
    }
}

#[cfg(test)]
mod earlier_tests;
#[cfg(test)]
mod tests;
