//! Method `output-error`: maximum likelihood for white heading noise, by simulation with the recorded rudder.
//!
//! The unknowns are 1/T, b = K/T and b δ_r, common to all trials, and heading and yaw rate at one end of every trial.
//! For a given 1/T the heading is linear in the others; 1/T alone is searched. The profiled sum of squares is scanned
//! over both signs of 1/T. Every local minimum is refined by variable projection with exact sensitivities (Golub and
//! Pereyra 1973; Kaufman 1975), first on a part of the rows; unless it is far above the lowest, then on all rows. The
//! lowest minimum is the estimate. It is the global minimum, unless the valley of the global minimum lies between two
//! points of the scan. Source of the method: Ljung (1999), System Identification: Theory for the User, chapter 7.

use document::WarningCode;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use ship::angle::to_deg;
use ship::{FirstOrder, ShortNumber};
use trial::Trial;

use crate::error::IdentifyError;
use crate::estimate::{Covariance, Estimate, StopReason};
use crate::identifier::Identifier;
use crate::likelihood::track::TrialSignals;
use crate::profile::{GaussNewtonStep, Profile, invert};
use crate::robust;
use crate::samples::checked_signals;
use crate::scan::{self, FitAtInverseT};
use crate::settings::{SettingsError, check_iterations, require};

/// Settings of the method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Settings {
    /// Number of points of the scan per decade of |1/T|, for each sign.
    pub grid_per_decade: usize,
    /// Minimum |T| searched, s; half a sampling period if omitted.
    pub smallest_time_constant_s: Option<f64>,
    /// Maximum number of steps in the refinement of a minimum.
    pub iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self { grid_per_decade: 8, smallest_time_constant_s: None, iterations: 50 }
    }
}

impl Settings {
    /// Method with these settings, which are checked.
    ///
    /// Fails if points per decade or iterations are outside 1 to 1000, or the minimum |T| is outside 1e-6 to 1e6 s.
    pub fn build(self) -> Result<OutputError, SettingsError> {
        let per_decade = self.grid_per_decade;
        require((1..=MAX_POINTS_PER_DECADE).contains(&per_decade), "grid-per-decade", per_decade, "1 to 1000")?;
        check_iterations("iterations", self.iterations)?;
        if let Some(smallest) = self.smallest_time_constant_s {
            let holds = TIME_CONSTANTS.contains(&smallest);
            require(holds, "smallest-time-constant-s", ShortNumber(smallest), "a time of 1e-6 to 1e6 s")?;
        }
        Ok(OutputError { settings: self })
    }
}

/// Method of maximum likelihood by simulation, global in 1/T.
///
/// Fails with [`IdentifyError::NotAShip`] if the best fit has K/T ≤ 0 and no fit with a positive K/T is a minimum
/// inside the range of 1/T, with [`IdentifyError::Singular`] if the record does not separate 1/T, K/T and δ_r, and with
/// [`IdentifyError::NoRudderEffect`] if K/T is less than two standard deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputError {
    settings: Settings,
}

/// Maximum number of points of the scan per decade; a finer scan finds no further local minimum.
const MAX_POINTS_PER_DECADE: usize = 1000;

/// Accepted values of `smallest-time-constant-s`, s.
const TIME_CONSTANTS: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

/// Minimum |1/T| of the scan, in units of one over the length of the record: below it the response is
/// indistinguishable from a neutrally stable response.
const MIN_INVERSE_TIME_RECORDS: f64 = 0.02;

/// Stopping rules of a refinement.
struct Goal {
    /// Step, relative to 1/T, at convergence.
    tolerance: f64,
    /// Maximum number of steps.
    iterations: usize,
    /// Sum of squares, rad², above which the refinement of a local minimum ends.
    bar: f64,
}

/// Relative distance from the end of the scan within which 1/T counts as at its bound.
const BOUND_TOLERANCE: f64 = 1e-6;

/// Relative step at convergence of the refinement.
const TOLERANCE: f64 = 1e-10;

/// Goal of a search over a part of the rows. The minimum lies within a fraction of a standard deviation of the minimum
/// of all rows, so more digits are useless; a valley that needs more steps has a large residual and is not the lowest.
const COARSE: Goal = Goal { tolerance: 1e-3, iterations: 8, bar: f64::INFINITY };

/// Maximum sum of squares over a part of the rows, relative to the lowest, of a valley that is refined on all rows.
const MAX_RSS_RATIO: f64 = 10.0;

/// Minimum number of steps before a valley may be dropped.
const MIN_STEPS: usize = 2;

/// Safety factor on the predicted decrease of a step, which assumes a parabola.
const DECREASE_MARGIN: f64 = 4.0;

/// Maximum predicted decrease, relative to the sum of squares, that is treated as rounding.
const ROUNDING: f64 = 1e-14;

/// Maximum number of halvings; a step without decrease then counts as rounding.
const MAX_HALVINGS: usize = 12;

/// Number of unknowns that all trials share: 1/T, K/T, δ_r.
const SHARED_PARAMETERS: usize = 3;

/// Maximum condition number of the scaled Jacobian: above it the record does not separate 1/T, K/T and δ_r.
pub(crate) const MAX_CONDITION: f64 = 1e6;

/// Minimum number of headings of a trial.
pub(crate) const MIN_ROWS: usize = 12;

/// Maximum number of rows of every trial in the scan.
const SCANNED_ROWS: usize = 200;

/// Minimum K/T, in standard deviations: below it the record shows no effect of the rudder and δ_r is undefined.
pub(crate) const MIN_GAIN_DEVIATIONS: f64 = 2.0;

/// Refined minimum of the profiled sum of squares.
struct PolishedMinimum {
    /// 1/T, 1/s.
    inverse_T: f64,
    /// Sum of squares, rad².
    rss: f64,
    stop: StopReason,
    iterations: usize,
}

impl OutputError {
    /// Values of 1/T to scan, in increasing order: logarithmic for both signs, and zero.
    fn grid(&self, trial_signals: &[TrialSignals], finest: f64) -> Vec<f64> {
        let longest = trial_signals.iter().map(TrialSignals::duration).fold(0.0, f64::max);
        let slowest = MIN_INVERSE_TIME_RECORDS / longest;
        let fastest = self.settings.smallest_time_constant_s.unwrap_or(0.5 * finest).recip().max(10.0 * slowest);
        let decades = (fastest / slowest).log10();
        let points = (decades * self.settings.grid_per_decade as f64).ceil() as usize;
        let positive = (0..=points).map(|k| slowest * 10f64.powf(decades * k as f64 / points as f64));
        let mut grid: Vec<f64> = positive.clone().map(|a| -a).collect();
        grid.reverse();
        grid.push(0.0);
        grid.extend(positive);
        grid
    }

    /// Goal of the last refinement, on all rows: the full tolerance, and no bar.
    fn goal(&self) -> Goal {
        Goal { tolerance: TOLERANCE, iterations: self.settings.iterations, bar: f64::INFINITY }
    }

    /// Variable projection from a 1/T, `start`, with step halving; it never leaves a lower point for a higher point.
    /// `resolution` (1/s) is added to |1/T| in the tolerance. `None` if a value is not finite or b is not positive.
    ///
    /// Ends when a step is below the tolerance, its predicted decrease is below the rounding of the sum of squares, or
    /// the valley cannot fall below the bar.
    fn polish(&self, profile: &mut Profile, start: f64, resolution: f64, goal: &Goal) -> Option<PolishedMinimum> {
        let mut inverse_T = start;
        let mut rss = profile.residual_sum_of_squares_at(inverse_T)?;
        for iterations in 1..=goal.iterations {
            let converged = PolishedMinimum { inverse_T, rss, stop: StopReason::Converged, iterations };
            let GaussNewtonStep { change: mut step, predicted_decrease: decrease } =
                profile.gauss_newton_step(inverse_T);
            let hopeless = iterations > MIN_STEPS && rss - DECREASE_MARGIN * decrease > goal.bar;
            if step.abs() <= goal.tolerance * (inverse_T.abs() + resolution) || hopeless {
                return Some(converged);
            }
            if decrease <= ROUNDING * rss {
                // The score is more exact than the sum of squares: the step is accepted even if the sum does not
                // decrease.
                let last = profile.residual_sum_of_squares_at(inverse_T + step);
                return last.map(|rss| PolishedMinimum { inverse_T: inverse_T + step, rss, ..converged });
            }
            let lower = (0..MAX_HALVINGS).find_map(|_| {
                let lower = profile.residual_sum_of_squares_at(inverse_T + step).filter(|&lower| lower < rss);
                if lower.is_none() {
                    step *= 0.5;
                }
                lower
            });
            // No step decreases it any further: a minimum to rounding.
            let Some(lower) = lower else { return Some(converged) };
            (inverse_T, rss) = (inverse_T + step, lower);
        }
        Some(PolishedMinimum { inverse_T, rss, stop: StopReason::IterationLimit, iterations: goal.iterations })
    }
}

impl Identifier for OutputError {
    fn id(&self) -> &'static str {
        "output-error"
    }

    fn summary(&self) -> &'static str {
        "maximum likelihood by simulation with the recorded rudder, global in both signs of T"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        if trials.is_empty() {
            return Err(IdentifyError::NoTrial);
        }
        let trial_signals =
            trials.iter().map(|trial| checked_signals(trial, MIN_ROWS)).collect::<Result<Vec<_>, IdentifyError>>()?;
        self.fit(trial_signals, trials.iter().map(Trial::sampling_period).fold(f64::INFINITY, f64::min))
    }
}

impl OutputError {
    /// Estimate from the signals of trials; `finest` is their minimum sampling period, s, which sets the minimum |T| of
    /// the scan unless a setting gives it. Fails as [`OutputError`] does.
    pub(crate) fn fit(&self, trial_signals: Vec<TrialSignals>, finest: f64) -> Result<Estimate, IdentifyError> {
        let grid = self.grid(&trial_signals, finest);
        let resolution =
            grid[grid.len() - 1].min(1.0 / trial_signals.iter().map(TrialSignals::duration).fold(0.0, f64::max));
        // The scan and the first refinement only locate the valleys, for which a part of the rows suffices; the last
        // refinement uses all rows.
        let thinned: Vec<TrialSignals> = trial_signals.iter().map(|signals| signals.thinned(SCANNED_ROWS)).collect();
        let scan = RangeScan { fits: scan::scan_inverse_T(&thinned, &grid), grid };
        let (mut coarse, mut profile) = (Profile::new(thinned), Profile::new(trial_signals));
        let valleys = scan.valleys();
        let mut bar = f64::INFINITY;
        let mut best: Option<PolishedMinimum> = None;
        for &start in &valleys {
            let place = self.polish(&mut coarse, start, resolution, &Goal { bar, ..COARSE });
            if place.as_ref().is_some_and(|place| place.rss > bar) {
                continue;
            }
            bar = place.as_ref().map_or(bar, |place| bar.min(MAX_RSS_RATIO * place.rss));
            let start = place.map_or(start, |place| place.inverse_T);
            if let Some(minimum) = self.polish(&mut profile, start, resolution, &self.goal())
                && best.as_ref().is_none_or(|best| minimum.rss < best.rss)
            {
                best = Some(minimum);
            }
        }
        let minimum = best.ok_or_else(|| scan.refusal(f64::INFINITY))?;
        let mut estimate = scan.estimate(profile, minimum)?;
        estimate.evaluations += coarse.evaluations;
        estimate.diagnostics.insert(LOCAL_MINIMA, ("local_minima", valleys.len() as f64));
        Ok(estimate)
    }
}

/// Index of the number of local minima among the diagnostics.
const LOCAL_MINIMA: usize = 4;

/// Best fits over the range of 1/T.
struct RangeScan {
    /// 1/T, 1/s, increasing.
    grid: Vec<f64>,
    fits: Vec<Option<FitAtInverseT>>,
}

impl RangeScan {
    /// Local minima in 1/T of a ship that turns to the side of the rudder, the deepest first, because it sets the
    /// maximum for later minima.
    fn valleys(&self) -> Vec<f64> {
        let height = |k: usize| {
            let ship = self.fits.get(k).copied().flatten().filter(|fit| fit.K_over_T > 0.0);
            ship.map_or(f64::INFINITY, |fit| fit.rss)
        };
        let last = self.grid.len() - 1;
        let valleys = (0..=last).filter(|&k| {
            height(k).is_finite() && (k == 0 || height(k - 1) >= height(k)) && (k == last || height(k + 1) >= height(k))
        });
        let mut valleys: Vec<usize> = valleys.collect();
        valleys.sort_by(|&a, &b| height(a).total_cmp(&height(b)));
        valleys.into_iter().map(|k| self.grid[k]).collect()
    }

    /// Reason for no estimate: the best fit of the scan, over both signs of K/T, is not a ship; or the columns are
    /// parallel.
    fn refusal(&self, condition: f64) -> IdentifyError {
        let fits = self.grid.iter().zip(&self.fits).filter_map(|(&a, fit)| fit.map(|fit| (a, fit)));
        match fits.min_by(|(_, a), (_, b)| a.rss.total_cmp(&b.rss)) {
            Some((inverse_T, FitAtInverseT { K_over_T, .. })) if K_over_T <= 0.0 => {
                IdentifyError::NotAShip { inverse_T, K_over_T }
            }
            _ => IdentifyError::Singular { condition, limit: MAX_CONDITION },
        }
    }

    /// Estimate at a minimum.
    fn estimate(&self, mut profile: Profile, minimum: PolishedMinimum) -> Result<Estimate, IdentifyError> {
        let PolishedMinimum { inverse_T, rss, stop, iterations } = minimum;
        profile.residual_sum_of_squares_at(inverse_T);
        let (K_over_T, offset) = profile.K_over_T_and_offset();
        let response = FirstOrder { inverse_T, K_over_T, rudder_bias: offset / K_over_T };
        // A minimum may leave the range during the refinement, or stop at its edge.
        let fastest = self.grid[self.grid.len() - 1];
        let at_bound = inverse_T.abs() >= fastest * (1.0 - BOUND_TOLERANCE);
        // A rudder of the wrong sign looks like a course-unstable ship with a vanishing T.
        if at_bound && let refused @ IdentifyError::NotAShip { .. } = self.refusal(f64::INFINITY) {
            return Err(refused);
        }
        let information = profile.information(inverse_T);
        let observations = profile.heading_count();
        let freedom = observations as f64 - (SHARED_PARAMETERS + 2 * profile.trial_count()) as f64;
        // The best fit with b > 0 of a ship that turns the wrong way hardly depends on the rudder.
        let (inverse, condition) = invert(&information, MAX_CONDITION).map_err(|condition| self.refusal(condition))?;
        let white = response_covariance(&(inverse * (rss / freedom)), &response, freedom);
        let sd = white.matrix[(1, 1)].sqrt();
        if K_over_T < MIN_GAIN_DEVIATIONS * sd {
            return Err(IdentifyError::NoRudderEffect { K_over_T, sd });
        }
        let lag1 = robust::lag1_autocorrelation(profile.residuals());
        let (evaluations, total) = (profile.evaluations, profile.total_sum_of_squares());
        // The factor corrects for the degrees of freedom of the fit, as in the variance above.
        let long_run = robust::newey_west_three(&profile.into_scores()) * (observations as f64 / freedom);
        let robust_covariance = response_covariance(&(inverse * long_run * inverse), &response, freedom);
        let (uncertainty, warning) = robust::reported_covariance(white, &robust_covariance, lag1, observations);
        let mut warnings = Vec::from_iter(warning);
        warnings.extend(response.is_course_unstable().then(|| WarningCode::CourseUnstable.warning(UNSTABLE_WARNING)));
        if at_bound {
            let (time, end) = (ShortNumber(response.T()), ShortNumber(1.0 / fastest));
            let text = format!("T = {time} s lies at or beyond the limit of the search, ±{end} s");
            warnings.push(WarningCode::AtBound.warning(text));
        }
        Ok(Estimate {
            response,
            uncertainty,
            robust_covariance: Some(robust_covariance),
            stop: if at_bound { StopReason::RangeLimit } else { stop },
            evaluations: self.grid.len() + evaluations,
            noise: None,
            diagnostics: vec![
                ("heading_rmse_deg", to_deg((rss / observations as f64).sqrt())),
                ("r_squared", 1.0 - rss / total),
                ("condition", condition),
                ("iterations", iterations as f64),
                ("lag1_autocorrelation", lag1),
                ("degrees_of_freedom", freedom),
            ],
            warnings,
        })
    }
}

/// Warning text for a negative 1/T.
pub(crate) const UNSTABLE_WARNING: &str = "course-unstable: 1/T is negative, K and T are negative";

/// Covariance of (1/T, K/T, δ_r) from the covariance of (1/T, b, b δ_r).
pub(crate) fn response_covariance(linear_covariance: &Matrix3<f64>, response: &FirstOrder, freedom: f64) -> Covariance {
    let b = response.K_over_T;
    let jacobian = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -response.rudder_bias / b, 1.0 / b);
    Covariance { matrix: jacobian * linear_covariance * jacobian.transpose(), degrees_of_freedom: Some(freedom) }
}

#[cfg(test)]
mod tests;
