//! Corrected Fourier method: heading and rudder on the same basis, least squares over all interior samples.
//!
//! A truncated series is a filter. In the published form it acts on the heading and not on the rudder, so the two sides
//! of T r' + r = K (δ + δ_r) are filtered differently and K and T are too low at any noise. Here the rudder is
//! projected on the same basis first: both sides are filtered alike and the bias vanishes. The fundamental follows from
//! the length of the record and the zig-zag period, not from the best fit; the number of harmonics from the noise; and
//! all samples are used instead of triples. A small truncation bias (some 0.5 %) remains and, with much noise, the
//! attenuation of a regression on a noisy yaw rate. The reported covariance counts the whole residual of the heading as
//! white noise, truncation included, so that it is not overconfident for a quiet record.
//!
//! Neighbouring rows of a record of more than 50 000 rows are averaged, rudder and heading alike: the equation is
//! linear, so the averages satisfy it, and a period of the shortest possible harmonic still has some 400 rows or more.
//! The noise is then the noise of the means.
//!
//! Extends: Ge, Hu, Yin and Sun, Identification of Ship Maneuverability Indexes by Fourier Method. Order of the series
//! by generalised cross-validation (Golub, Heath and Wahba 1979).

use document::WarningCode;
use serde::{Deserialize, Serialize};
use ship::ShortNumber;
use ship::angle::to_deg;
use std::f64::consts::TAU;
use std::ops::Range;
use trial::Trial;

use crate::error::IdentifyError;
use crate::estimate::{Covariance, Estimate, StopReason, Uncertainty};
use crate::fourier::basis::NestedBases;
use crate::fourier::fundamental::zero_crossing_period;
use crate::fourier::regression::{RegressionEquations, RegressionForm, white_variance};
use crate::fourier::{self, FittedSeries, FourierSeries, Fundamental, MAX_HARMONICS, MAX_TRUSTED_CONDITION};
use crate::gaps::{gap_free_ranges, gap_threshold};
use crate::identifier::Identifier;
use crate::samples::Samples;
use crate::settings::{SettingsError, require};

/// Minimum number of observed rows of a trial.
const MIN_ROWS: usize = 20;

/// Maximum number of rows of a trial without averaging.
const MAX_ROWS: usize = 50_000;

/// Minimum frequency of the highest harmonic, in units of the zig-zag frequency: a zig-zag has no harmonic between the
/// first and the third.
const MIN_REACH: f64 = 3.0;

/// Share of the record without equations at each end, where the series is inaccurate.
const TRIM_SHARE: f64 = 0.05;

/// Number of harmonics in the search for w if the order is chosen later.
const SEARCH_HARMONICS: usize = 8;

/// Minimum share of white noise in the residual variance; below it truncation dominates.
const MIN_WHITE_SHARE: f64 = 0.5;

/// Rule for the number of harmonics.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Order {
    /// Given number of harmonics.
    Fixed(usize),
    /// Least generalised cross-validation score, n RSS/(n − p)², p = 2N + 1.
    Gcv {
        /// Maximum frequency of the highest harmonic, in units of the zig-zag frequency.
        reach: f64,
    },
}

/// Rudder that enters the equations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RudderTreatment {
    /// Projected on the basis of the heading.
    #[default]
    Projected,
    /// As recorded: shows the bias that the projection removes.
    Recorded,
}

/// Settings of the method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Settings {
    /// Rule for the choice of w.
    pub fundamental: Fundamental,
    /// Rule for the number of harmonics.
    pub harmonics: Order,
    /// Rudder in the equations.
    pub rudder: RudderTreatment,
    /// Left side of the regression.
    pub response: RegressionForm,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            fundamental: Fundamental::RecordAndPeriods(0.5),
            harmonics: Order::Gcv { reach: 4.0 },
            rudder: RudderTreatment::Projected,
            response: RegressionForm::YawAcceleration,
        }
    }
}

impl Settings {
    /// Method with these settings, which are checked.
    ///
    /// Fails if a number of harmonics is outside 1 to 64, a reach outside 1.5 to 50, or the rule for w is not valid.
    pub fn build(self) -> Result<FourierProjected, SettingsError> {
        match self.harmonics {
            Order::Fixed(fixed) => require((1..=MAX_HARMONICS).contains(&fixed), "harmonics.fixed", fixed, "1 to 64"),
            Order::Gcv { reach } => {
                require((1.5..=50.0).contains(&reach), "harmonics.reach", ShortNumber(reach), "1.5 to 50")
            }
        }?;
        self.fundamental.check()?;
        Ok(FourierProjected { settings: self, max_rows: MAX_ROWS })
    }
}

/// Fourier method with the rudder projected on the basis of the heading.
///
/// Fails with [`IdentifyError::TooFewPoints`] if a record has more zig-zags than the longest series can follow, some
/// twenty, with [`IdentifyError::Singular`] if the basis or the equations are ill-conditioned, and with
/// [`IdentifyError::NotAShip`] if K/T is not positive.
#[derive(Debug, Clone, PartialEq)]
pub struct FourierProjected {
    settings: Settings,
    /// Maximum number of rows of a trial without averaging.
    max_rows: usize,
}

/// Heading and rudder of one trial as Fourier curves of one basis, for a plot.
#[derive(Debug, Clone)]
pub struct FourierCurves {
    /// Heading curve.
    pub heading: FittedSeries,
    /// Rudder curve; [`FourierSeries::heading_at`] gives the projected rudder angle, rad.
    pub rudder: FourierSeries,
    /// First and last instant of the curves, s from the first observed row.
    pub window: [f64; 2],
}

/// Rows of a trial: time (s), heading and rudder (rad).
struct SeriesRows {
    time: Vec<f64>,
    heading: Vec<f64>,
    rudder: Vec<f64>,
}

impl SeriesRows {
    fn from_samples(samples: Samples) -> Self {
        let Samples { time, heading, rudder, .. } = samples;
        Self { time, heading, rudder }
    }

    /// Rows averaged to at most about `max_rows`: means of neighbours, but not across gaps.
    fn averaged(self, max_rows: usize) -> Self {
        let group = self.time.len().div_ceil(max_rows);
        if group == 1 {
            return self;
        }
        let pieces = gap_free_ranges(&self.time, gap_threshold(None, &self.time));
        let groups: Vec<Range<usize>> = pieces
            .flat_map(|piece| piece.clone().step_by(group).map(move |from| from..piece.end.min(from + group)))
            .collect();
        let means = |values: &[f64]| -> Vec<f64> {
            groups.iter().map(|rows| values[rows.clone()].iter().sum::<f64>() / rows.len() as f64).collect()
        };
        Self { time: means(&self.time), heading: means(&self.heading), rudder: means(&self.rudder) }
    }
}

/// Variances of the residual of a heading fit.
struct ResidualVariance {
    /// Variance of the white part, rad².
    white: f64,
    /// Variance of the residual, rad².
    residual: f64,
}

impl FourierProjected {
    /// Curves of one trial; time runs from the first observed row.
    ///
    /// Fails as [`Identifier::identify`] does for a record that cannot be fitted.
    pub fn curves(&self, trial: &Trial) -> Result<FourierCurves, IdentifyError> {
        let part = SeriesRows::from_samples(Samples::new(trial, MIN_ROWS)?).averaged(self.max_rows);
        let heading = self.fit(&part)?;
        let rudder = heading.basis.fourier_series(&heading.basis.project(&part.rudder));
        Ok(FourierCurves { heading, rudder, window: [part.time[0], part.time[part.time.len() - 1]] })
    }

    fn fit(&self, part: &SeriesRows) -> Result<FittedSeries, IdentifyError> {
        let SeriesRows { time, heading, .. } = part;
        let fundamental = &self.settings.fundamental;
        let reach = match self.settings.harmonics {
            Order::Fixed(harmonics) => return accept(fourier::fit(time, heading, harmonics, fundamental)?),
            Order::Gcv { reach } => reach,
        };
        let choice = fundamental.choose(time, heading, SEARCH_HARMONICS.min((time.len() - 2) / 2))?;
        let zigzag = TAU / zero_crossing_period(time, heading)?;
        let needed = (reach.min(MIN_REACH) * zigzag / choice.fundamental).ceil() as usize;
        if needed > MAX_HARMONICS {
            let kind = "harmonics to follow the many zig-zags of this record (give shorter records)";
            return Err(IdentifyError::TooFewPoints { kind, needed, count: MAX_HARMONICS });
        }
        // The series must at least reach the zig-zag frequency, with fewer coefficients than half the rows.
        let lowest = ((zigzag / choice.fundamental).ceil() as usize).max(1);
        let highest = ((reach * zigzag / choice.fundamental).floor() as usize)
            .min(MAX_HARMONICS)
            .min((time.len() / 2 - 1) / 2)
            .max(1);
        let series = NestedBases::new(time, choice.fundamental, highest)?;
        let rows = time.len() as f64;
        let rss = series.rss(heading);
        let harmonics = (lowest.min(highest)..=highest)
            .min_by(|&p, &q| gcv(rows, rss[p], p as f64).total_cmp(&gcv(rows, rss[q], q as f64)))
            .expect("the range holds at least its end");
        let basis = series.basis(harmonics);
        let projection = basis.project(heading);
        let curve = basis.fourier_series(&projection);
        accept(FittedSeries { curve, basis, projection, stop: choice.stop, evaluations: choice.evaluations + 1 })
    }

    /// Adds the equations of one trial and returns the variances of the residual.
    fn add(&self, part: &SeriesRows, fitted: &FittedSeries, equations: &mut RegressionEquations) -> ResidualVariance {
        let SeriesRows { time, heading, rudder } = part;
        let residual = &fitted.projection.residual;
        let coefficients = 2 * fitted.basis.harmonics() + 1;
        let squares: f64 = residual.iter().map(|e| e * e).sum();
        let noise = ResidualVariance {
            white: white_variance(time, residual),
            residual: squares / (heading.len() - coefficients) as f64,
        };
        let trim = TRIM_SHARE * (time[time.len() - 1] - time[0]);
        let from = time.partition_point(|&t| t < time[0] + trim);
        let to = time.partition_point(|&t| t <= time[time.len() - 1] - trim);
        let rudder = match self.settings.rudder {
            RudderTreatment::Recorded => rudder,
            RudderTreatment::Projected => &fitted.basis.values(&fitted.basis.project(rudder).coefficients),
        };
        equations.add(&fitted.basis, &fitted.projection, from..to, rudder, noise.residual.max(noise.white));
        noise
    }
}

impl Identifier for FourierProjected {
    fn id(&self) -> &'static str {
        "fourier-projected"
    }

    fn summary(&self) -> &'static str {
        "heading and rudder on one Fourier basis, least squares over all interior samples"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        let mut equations = RegressionEquations::default();
        let (mut fits, mut noises, mut freedom) = (Vec::new(), Vec::new(), 0.0);
        for samples in Samples::from_trials(trials, MIN_ROWS)? {
            let part = SeriesRows::from_samples(samples).averaged(self.max_rows);
            let fitted = self.fit(&part)?;
            noises.push(self.add(&part, &fitted, &mut equations));
            freedom += part.time.len() as f64 - (2 * fitted.basis.harmonics() + 1) as f64;
            fits.push(fitted);
        }
        let solution = equations.solve(self.settings.response, MAX_TRUSTED_CONDITION)?;
        let mut diagnostics = fourier::diagnostics(&fits);
        let worst = |variance: fn(&ResidualVariance) -> f64| {
            to_deg(noises.iter().fold(0.0f64, |most, noise| most.max(variance(noise))).sqrt())
        };
        diagnostics.extend([
            ("equations", equations.len() as f64),
            ("equations_condition", solution.condition),
            ("residual_sd_deg", worst(|noise| noise.residual)),
            ("white_noise_sd_deg", worst(|noise| noise.white)),
        ]);
        let mut warnings = fourier::warnings(&fits);
        for (trial, noise) in trials.iter().zip(&noises) {
            if noise.white < MIN_WHITE_SHARE * noise.residual {
                warnings.push(WarningCode::ColouredResidual.warning(format!(
                    "{}: the residual of the heading fit ({:.3} deg) is mostly not white noise ({:.3} deg) but truncation of \
                     the series or a disturbance; the intervals count all of it as noise",
                    trial.title(),
                    to_deg(noise.residual.sqrt()),
                    to_deg(noise.white.sqrt()),
                )));
            }
        }
        let matrix = solution.covariance;
        Ok(Estimate {
            response: solution.response,
            uncertainty: Uncertainty::Covariance(Covariance { matrix, degrees_of_freedom: Some(freedom) }),
            robust_covariance: None,
            stop: fits.iter().map(|fit| fit.stop).max().unwrap_or(StopReason::Direct),
            evaluations: fits.iter().map(|fit| fit.evaluations).sum::<usize>() + 1,
            noise: None,
            diagnostics,
            warnings,
        })
    }
}

/// Generalised cross-validation score of a series with `harmonics` harmonics on `rows` values.
fn gcv(rows: f64, rss: f64, harmonics: f64) -> f64 {
    rows * rss / (rows - 2.0 * harmonics - 1.0).powi(2)
}

/// Fitted series with a well-conditioned basis. Fails with [`IdentifyError::Singular`] above a condition number of
/// [`MAX_TRUSTED_CONDITION`], where the coefficients cancel each other.
fn accept(fitted: FittedSeries) -> Result<FittedSeries, IdentifyError> {
    let (condition, limit) = (fitted.curve.condition, MAX_TRUSTED_CONDITION);
    if condition <= limit { Ok(fitted) } else { Err(IdentifyError::Singular { condition, limit }) }
}

#[cfg(test)]
mod tests;
