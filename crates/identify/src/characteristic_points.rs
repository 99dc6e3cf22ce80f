//! Traditional analysis of a zig-zag trial by characteristic points: heading extrema and passages of the base course,
//! put into the equation of motion integrated once.
//!
//! T [r(t) − r(s)] + ψ(t) − ψ(s) = K [∫δ + δ_r (t − s)] from s to t. Between two extrema r = 0 and T drops out, which
//! leaves K and K δ_r; from an extremum to a passage r is large, which gives T. Peaks are not parabolas and the slope
//! comes from few rows, so the method is biased by about half a percent and degrades quickly with noise; it is included
//! as the usual reference.
//!
//! Source of the method: Nomoto (1960), Analysis of Kempf's standard maneuver test and proposed steering quality
//! indices, First Symposium on Ship Maneuverability, DTMB Report 1461. The equations are derived anew.

mod classic;
mod equation_8;
mod points;
mod points_fit;

use document::{Warning, WarningCode};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use ship::angle::from_deg;
use ship::{FirstOrder, ShortNumber};
use trial::Trial;

use crate::error::IdentifyError;
use crate::estimate::{Covariance, Estimate, StopReason, Uncertainty};
use crate::identifier::Identifier;
use crate::samples::Samples;
use crate::settings::{SettingsError, check_condition_limit, require};
use points::{BaseCourseOrigin, TrialPoints};
use points_fit::AnalysedTrial;

/// Variant of the method: which points of the record are used, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Variant {
    /// All extrema, a start at rest and all passages, by least squares.
    #[default]
    LeastSquares,
    /// Three successive extrema and the two passages between them, as in an analysis by hand. Gives no uncertainty.
    ThreePeaks,
    /// Integrated equation at instants one window apart, with heading and yaw rate from local cubics.
    #[serde(rename = "equation-8")]
    Equation8,
    /// Integrated equation at the extrema, referred to the first row, as Ge, Hu, Yin and Sun print it but with the sign
    /// of r(0) corrected. T multiplies only r(0), so a start at rest does not determine it.
    #[serde(rename = "equation-8-vertices")]
    Equation8Vertices,
}

/// Settings of the method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Settings {
    /// Variant of the method: which points of the record are used, and how.
    pub variant: Variant,
    /// Half width of the local fits, s; without it 7 % of half a period (equation 8: 14 %), at least three intervals.
    pub half_width_s: Option<f64>,
    /// Base course, deg; without it the mean heading before the first execute.
    pub base_course_deg: Option<f64>,
    /// `true` if a start at rest counts as an instant with r = 0; true only if the ship kept a straight course.
    pub start_at_rest: bool,
    /// Known rudder bias δ_r, deg; without it δ_r is identified.
    pub rudder_bias_deg: Option<f64>,
    /// Maximum accepted condition number of the equations.
    pub condition_limit: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            variant: Variant::LeastSquares,
            half_width_s: None,
            base_course_deg: None,
            start_at_rest: true,
            rudder_bias_deg: None,
            condition_limit: 1e6,
        }
    }
}

impl Settings {
    /// Method with these settings, which are checked.
    ///
    /// Fails if the half width is not positive, an angle is not finite or the condition limit is not above 1.
    pub fn build(self) -> Result<CharacteristicPoints, SettingsError> {
        if let Some(width) = self.half_width_s {
            require(width > 0.0 && width.is_finite(), "half-width-s", ShortNumber(width), "a positive time")?;
        }
        for (key, angle) in [("base-course-deg", self.base_course_deg), ("rudder-bias-deg", self.rudder_bias_deg)] {
            angle.map_or(Ok(()), |angle| require(angle.is_finite(), key, ShortNumber(angle), "an angle"))?;
        }
        check_condition_limit(self.condition_limit)?;
        Ok(CharacteristicPoints { settings: self })
    }
}

/// Traditional method of characteristic points in several variants.
///
/// The covariance comes from the residuals of few equations, with Student's t for its intervals, and excludes bias.
/// Diagnostics give K and T by side, which shows an asymmetric ship.
///
/// Fails with [`IdentifyError::TooFewPoints`] if the records do not hold three instants with r = 0 (two with a given
/// δ_r) and a passage of the base course, with [`IdentifyError::Singular`] if the selected points do not determine T or
/// δ_r, and with [`IdentifyError::NotAShip`] if K/T is not positive.
#[derive(Debug, Clone, PartialEq)]
pub struct CharacteristicPoints {
    settings: Settings,
}

impl CharacteristicPoints {
    /// Half width of the local fits, as a share of half a zig-zag period. A parabola follows a peak over a shorter time
    /// than a cubic follows the heading, and only equation (8) is sensitive to noise of the yaw rate, its regressor.
    fn width_share(&self) -> f64 {
        match self.settings.variant {
            Variant::LeastSquares | Variant::ThreePeaks => 0.07,
            Variant::Equation8 | Variant::Equation8Vertices => 0.14,
        }
    }
}

impl Identifier for CharacteristicPoints {
    fn id(&self) -> &'static str {
        "characteristic-points"
    }

    fn summary(&self) -> &'static str {
        "heading extrema and passages of the base course in the once-integrated equation (Nomoto 1960)"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        let base = self.settings.base_course_deg.map(from_deg);
        let analysed: Vec<AnalysedTrial> = Samples::from_trials(trials, Trial::MIN_ROWS)?
            .into_iter()
            .map(|samples| {
                let mut points = TrialPoints::find(&samples, base, self.settings.half_width_s, self.width_share());
                if !self.settings.start_at_rest {
                    points.remove_start_at_rest();
                }
                AnalysedTrial { samples, points }
            })
            .collect();
        let bias = self.settings.rudder_bias_deg.map(from_deg);
        let limit = self.settings.condition_limit;
        let fit = match self.settings.variant {
            Variant::LeastSquares => classic::identify(&analysed, bias, limit, false),
            Variant::ThreePeaks => classic::identify(&analysed, bias, limit, true),
            Variant::Equation8 => equation_8::identify_at_spaced_instants(&analysed, bias, limit),
            Variant::Equation8Vertices => equation_8::identify_at_extrema(&analysed, bias, limit),
        }?;
        let [gain, gain_bias, time] = fit.parameters;
        let response = FirstOrder { inverse_T: 1.0 / time, K_over_T: gain / time, rudder_bias: gain_bias / gain };
        if !(response.K_over_T > 0.0 && response.K_over_T.is_finite()) {
            return Err(IdentifyError::NotAShip { inverse_T: response.inverse_T, K_over_T: response.K_over_T });
        }
        let uncertainty = match fit.covariance {
            Ok((matrix, freedom)) => {
                let to_base = to_base(fit.parameters);
                Uncertainty::Covariance(Covariance {
                    matrix: to_base * matrix * to_base.transpose(),
                    degrees_of_freedom: Some(freedom),
                })
            }
            Err(reason) => Uncertainty::None { reason },
        };
        let mut diagnostics = fit.diagnostics;
        let count = |number: fn(&TrialPoints) -> usize| analysed.iter().map(|trial| number(&trial.points) as f64).sum();
        diagnostics.push(("instants_without_yaw_rate", count(|points| points.zero_rate_points.len())));
        diagnostics.push(("passages_of_base_course", count(|points| points.crossings.len())));
        diagnostics.push(("half_width_s", analysed[0].points.fit_half_width));
        Ok(Estimate {
            response,
            uncertainty,
            robust_covariance: None,
            stop: StopReason::Direct,
            evaluations: 1,
            noise: None,
            diagnostics,
            warnings: warnings(trials, &analysed),
        })
    }
}

/// Derivative of (1/T, K/T, δ_r) with respect to (K, K δ_r, T).
fn to_base([gain, gain_bias, time]: [f64; 3]) -> Matrix3<f64> {
    let square = time * time;
    Matrix3::new(0.0, 0.0, -1.0 / square, 1.0 / time, 0.0, -gain / square, -gain_bias / (gain * gain), 1.0 / gain, 0.0)
}

fn warnings(trials: &[Trial], analysed: &[AnalysedTrial]) -> Vec<Warning> {
    let base_course_warning = |(trial, analysed): (&Trial, &AnalysedTrial)| {
        let assumed = match analysed.points.base_course_origin {
            BaseCourseOrigin::Given | BaseCourseOrigin::Approach => return None,
            BaseCourseOrigin::Zero => "heading 0",
            BaseCourseOrigin::Middle => "the middle of its headings",
        };
        Some(WarningCode::Method.warning(format!(
            "{} has no straight approach: {assumed} was taken for the base course; set base-course-deg if you know it",
            trial.title()
        )))
    };
    trials.iter().zip(analysed).filter_map(base_course_warning).collect()
}

#[cfg(test)]
mod tests;
