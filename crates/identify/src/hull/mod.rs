//! Hull of three degrees of freedom fitted to records of heading and rudder, with a prior of the coefficients.
//!
//! The recorded rudder is replayed through the hull ([`ship::vessel::prime`]), over the whole record and over windows
//! of 3.5 L/U₀; heading and yaw rate at the start are fitted, speed and sway begin as measured (or at approach speed)
//! and run on. Positions give the speed of a record without a speed. The fit minimises
//!
//! J = 1/n Σ_records (T U₀/L) [ē²/σ² of the whole replay + ē²/σ² of the windows + ē²/σ² of the recorded speed]
//!   + (θ − μ)ᵀ Λ (θ − μ) + ((r L/U − 0.75)/0.25)² + ((−v/(r L) − 0.35)/0.12)² in a turn with 35° of rudder
//!
//! with the duration T of a record, mean squares ē² of its residuals, and the standard deviations σ of
//! [`ResidualDeviations`], which describe the error of the form and not of a sensor: a hull of ten or twenty
//! coefficients only approximates the ship. They start large and follow the residual of every record, down to 1°, 0.2°
//! and 0.1 U₀. A sway velocity is not fitted: logs do not give its point of reference. A recorded yaw rate is not
//! fitted in addition to the heading. A fit to it in the whole replay, with a deviation of at least 0.02 U₀/L, changed
//! the heading error on other records of KVLCC2 by a factor of 0.96 ± 0.02, and reduced the error in 5 of 11 sets.
//!
//! The n records of a ship weigh as much as a single record of their mean length: the error of the form is similar in
//! all records. The turn is typical of nearly every ship; zig-zags hardly determine it, and a form fitted to zig-zags
//! is arbitrary in such a turn.
//!
//! The covariance is the inverse of the second derivatives of J/2, so it includes the error of the form as far as that
//! error is independent from ship length to ship length. Firm priors make so many coefficients identifiable from a
//! single record; without them the fitted hull is often unstable. Sources: Yasukawa and Yoshimura (2015) for the MMG
//! form; output error with priors as in Ljung (1999), System Identification: Theory for the User.

mod conflict;
mod earlier_merge;
mod error;
mod form_prior;
mod moment;
mod objective;
mod replayed;
mod track;
mod turn;

use std::f64::consts::PI;

use estimation::levenberg_marquardt::{SearchEnd, SearchSettings, minimise};
use estimation::number::Real;
use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;
use ship::Polyline;
use ship::vessel::scaled::ScaledHull;
use trial::Trial;

pub use conflict::PriorCheck;
pub use earlier_merge::merge_with_earlier;
pub use error::HullFitError;
pub use form_prior::{EarlierHull, HullFormPrior, differs_in_froude_number};
pub use moment::MisfitMoment;
pub use objective::ResidualDeviations;
use objective::{HullObjective, heading_variances};
pub use track::HullReference;
use track::HullSignals;

/// Rules of the Levenberg-Marquardt search.
const RULES: SearchSettings = SearchSettings {
    max_steps: 40,
    initial_damping: 1e-2,
    damping_shrink: 0.2,
    trust_ratio: 0.25,
    damping_growth: 4.0,
    min_damping: [1e-9, 1e-4],
    max_rejections: 14,
    min_decrease: 1e-3,
    decrease_tolerance: [1e-3, 1e-5],
    max_small_steps: 2,
};

/// Number of rounds in which the deviations follow the residuals.
const REWEIGHTINGS: usize = 3;

/// Residual of a hull fit on one record: heading errors of its replays.
#[derive(Debug, Clone, PartialEq)]
pub struct HullResidual {
    /// Name of the record.
    pub name: String,
    /// Root mean square heading error of the whole replay, rad.
    pub whole_replay_rms: f64,
    /// Root mean square heading error in windows of 3.5 L/U₀, rad.
    pub window_rms: f64,
    /// Yaw rate with which the whole replay begins, rad/s.
    pub initial_yaw_rate: f64,
}

/// Estimated coefficients of a hull of three degrees of freedom, with their covariance.
#[derive(Debug, Clone)]
pub struct HullEstimate {
    /// Hull form with the prior of its coefficients.
    pub prior: HullFormPrior,
    /// Length, speed and propeller rate that make the quantities dimensionless.
    pub reference: HullReference,
    /// Estimates of the coefficients, dimensionless, in the order of `prior.coefficients`.
    pub coefficients: DVector<f64>,
    /// Covariance of the coefficients.
    pub covariance: DMatrix<f64>,
    /// Residuals of the records.
    pub residuals: Vec<HullResidual>,
    /// Model error of the form, as a random yaw moment.
    pub moment: MisfitMoment,
}

/// Fits a hull to records of one ship, with a prior of the coefficients.
///
/// Fails if length or speed of the ship are missing, if a record has fewer than twenty headings, rows too far apart,
/// too long a duration or a start near rest, or if no coefficients near the prior can be replayed.
pub fn fit(trials: &[Trial], prior: &HullFormPrior) -> Result<HullEstimate, HullFitError> {
    let (reference, hull_signals) = hull_signals(trials)?;
    let form = &prior.form;
    let mut problem = HullObjective::new(prior, &hull_signals);
    let mut start = prior.mean();
    let mut search = minimise(&mut problem, start, &RULES);
    // The weight of a record grows as the hull approaches it, which avoids distant minima.
    for _ in 0..REWEIGHTINGS {
        problem.reweigh(search.estimate.as_slice());
        start = search.estimate;
        search = minimise(&mut problem, start, &RULES);
    }
    if search.end == SearchEnd::NotFinite {
        return Err(HullFitError::NoReplay);
    }
    let covariance = Cholesky::new(search.normal_equations.matrix.clone()).map(|factor| factor.inverse());
    let covariance = covariance.ok_or(HullFitError::NoReplay)?;
    let misfits = problem.misfits(search.estimate.as_slice()).unwrap_or_default();
    let residual = |(trial, misfit): (&Trial, objective::Misfit)| HullResidual {
        name: trial.name().to_owned(),
        whole_replay_rms: misfit.whole_heading.sqrt(),
        window_rms: misfit.window_heading.sqrt(),
        initial_yaw_rate: misfit.initial_yaw_rate / reference.ship_length_time(),
    };
    let moment = MisfitMoment::from_misfits(
        &form.with_coefficients(search.estimate.as_slice()).ok_or(HullFitError::NoReplay)?,
        &hull_signals,
        &misfits,
    );
    let moment = MisfitMoment { correlation_time: moment.correlation_time * reference.ship_length_time(), ..moment };
    let residuals = trials.iter().zip(misfits).map(residual).collect();
    let prior = prior.clone();
    Ok(HullEstimate { prior, reference, coefficients: search.estimate, covariance, residuals, moment })
}

/// Reason why no hull can be fitted to these records of one ship; `None` if a fit is possible.
pub fn fit_refusal(trials: &[Trial]) -> Option<HullFitError> {
    hull_signals(trials).err()
}

/// Dimensionless records of one ship, and their reference quantities.
fn hull_signals(trials: &[Trial]) -> Result<(HullReference, Vec<HullSignals>), HullFitError> {
    let reference = trials.iter().find_map(HullReference::from_trial).ok_or(HullFitError::MissingParticulars)?;
    let hull_signals =
        trials.iter().map(|trial| HullSignals::from_trial(trial, &reference)).collect::<Result<_, _>>()?;
    Ok((reference, hull_signals))
}

/// Maximum residual of a supported hull, relative to the smallest residual of all hulls and another model.
const MAX_RESIDUAL_RATIO: f64 = 3.0;

/// Estimates for all forms that can be fitted to records of one ship, with priors from earlier trials; a form whose fit
/// fails is left out.
pub fn fit_all_forms(trials: &[Trial], earlier: &[EarlierHull]) -> Vec<HullEstimate> {
    let priors = HullFormPrior::candidates(trials.iter().find_map(Trial::hull).as_ref(), earlier);
    priors.par_iter().filter_map(|prior| fit(trials, prior).ok()).collect()
}

/// Hulls supported by their records: the residual of whole records is at most three times the smallest residual of all
/// hulls and of another model (`rival`, rad; infinite without another model).
pub fn supported_hulls(hulls: Vec<HullEstimate>, rival: f64) -> Vec<HullEstimate> {
    let residual = |hull: &HullEstimate| hull.mean_square_heading_error().sqrt();
    let smallest = hulls.iter().map(residual).fold(rival, f64::min);
    hulls.into_iter().filter(|hull| residual(hull) <= MAX_RESIDUAL_RATIO * smallest).collect()
}

impl HullEstimate {
    /// Hull with the estimated coefficients at the size and speed of the ship, for replays.
    pub fn scaled_hull<R: Real>(&self) -> ScaledHull<R> {
        let values: Vec<R> = self.coefficients.iter().map(|&value| R::from(value)).collect();
        let HullReference { length, speed, propeller_rate } = self.reference;
        let hull = self.prior.form.with_coefficients(&values).expect("the fit has replayed it");
        ScaledHull { hull, length, speed, propeller_rate }
    }

    /// Variance of the replayed heading of a record over time (s), rad²: from the covariance of the coefficients and
    /// from the mean square residual of the fit. `None` for a record that cannot be replayed, or if the standard
    /// deviation exceeds half a turn, beyond which the linear propagation does not hold.
    pub fn heading_variance(&self, trial: &Trial) -> Option<Polyline> {
        let signals = HullSignals::from_trial(trial, &self.reference).ok()?;
        let [time, mut variance] =
            heading_variances(&self.prior, &signals, self.coefficients.as_slice(), &self.covariance)?;
        let residual = self.mean_square_heading_error();
        variance.iter_mut().for_each(|value| *value += residual);
        if variance.iter().any(|value| *value > PI * PI) {
            return None;
        }
        Polyline::new(time.into_iter().map(|t| t * signals.ship_length_time).collect(), variance).ok()
    }

    /// Check of the prior against the records; `None` if the records add no information.
    pub fn prior_check(&self) -> Option<PriorCheck> {
        PriorCheck::from_fit(&self.prior, &self.coefficients, &self.covariance)
    }

    /// Mean over the records, with equal weights, of the mean square heading error of the whole replay, rad².
    pub fn mean_square_heading_error(&self) -> f64 {
        self.residuals.iter().map(|residual| residual.whole_replay_rms.powi(2)).sum::<f64>()
            / self.residuals.len() as f64
    }
}

#[cfg(test)]
mod earlier_tests;
#[cfg(test)]
mod tests;
