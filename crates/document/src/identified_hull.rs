//! Hull model of three degrees of freedom in a file.

use std::collections::BTreeMap;

use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::vessel::prime::{HullCoefficient, HullModel, is_trial_specific};
use ship::vessel::prior::{HullParticulars, PARTICULARS, Particular};

use crate::error::IdentifiedShipError;

/// Coefficient of a hull with its prior.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct IdentifiedCoefficient {
    /// Key of the coefficient in files, such as `Xvv`.
    pub key: String,
    /// Symbol.
    pub symbol: String,
    /// Estimate, dimensionless.
    pub value: f64,
    /// Prior mean.
    pub expected: f64,
    /// Prior standard deviation.
    pub expected_sd: f64,
}

impl IdentifiedCoefficient {
    /// Signed distance of the estimate from the prior mean, in prior standard deviations.
    pub fn departure_from_prior(&self) -> f64 {
        (self.value - self.expected) / self.expected_sd
    }
}

/// Random yaw moment (Ornstein–Uhlenbeck) that represents the model error of the hull.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RandomYawMoment {
    /// Standard deviation as the rudder angle with the same moment at approach speed, rad.
    #[serde(rename = "deviation_rudder_rad")]
    pub sd_rudder_rad: f64,
    /// Correlation time, s: the autocorrelation falls to 1/e.
    pub correlation_s: f64,
}

/// Hull model of three degrees of freedom with the estimate of the dimensionless coefficients.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct IdentifiedHull {
    /// Form: `quadratic`, `cubic` or `mmg`.
    pub form: String,
    /// Weight among the hulls of the file.
    pub weight: f64,
    /// Length of the ship, m.
    pub length_m: f64,
    /// Approach speed, m/s.
    pub speed_m_s: f64,
    /// Propeller rate on the approach, 1/s, if recorded.
    pub propeller_per_s: Option<f64>,
    /// Particulars of the ship of the records by their keys, from which the priors follow; always at the scale of the
    /// records.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub particulars: BTreeMap<String, f64>,
    /// Coefficients.
    pub coefficients: Vec<IdentifiedCoefficient>,
    /// Covariance of the coefficients, by rows.
    pub covariance: Vec<Vec<f64>>,
    /// Random moment of the model error.
    #[serde(rename = "moment")]
    pub model_error_moment: RandomYawMoment,
    /// Root mean square of the initial yaw rate of its replays minus that of the straight approach, rad/s: an error of
    /// the form in the first seconds of a manoeuvre. 0 if no record begins straight.
    #[serde(default)]
    pub beginning_yaw_rate_rad_s: f64,
    /// Hull of the trials, for a hull at another loading; not written to a file.
    #[serde(skip)]
    pub trial_hull: Option<TrialHull>,
}

/// Hull of the trials, with the regression of a hull at another loading on it.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialHull {
    /// Hull of the trials.
    pub hull: Box<IdentifiedHull>,
    /// Gain G of the coefficients at the other loading with respect to those of the hull.
    pub gain: DMatrix<f64>,
    /// Covariance of the coefficients at the other loading given those of the hull, by rows.
    pub conditional_covariance: Vec<Vec<f64>>,
}

/// Particulars of a hull by their keys; unknown particulars are omitted.
pub fn keyed_particulars(particulars: &HullParticulars) -> BTreeMap<String, f64> {
    PARTICULARS.iter().filter_map(|item| Some((item.key.to_owned(), item.get(particulars)?))).collect()
}

/// Rows of a matrix.
pub fn matrix_rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

impl IdentifiedHull {
    /// Hull form. Fails for an unknown form or particular, and if the coefficients are not those of the form.
    pub fn form(&self) -> Result<HullModel, IdentifiedShipError> {
        let refused = || self.unknown_model_error();
        let forms = HullModel::candidates(Some(&self.particulars()?));
        let form = forms.into_iter().find(|form| form.as_str() == self.form).ok_or_else(refused)?;
        let keys = self.coefficients.iter().map(|stored| stored.key.as_str());
        let are_same = form.coefficients().iter().map(|coefficient| coefficient.key).eq(keys);
        if are_same { Ok(form) } else { Err(refused()) }
    }

    /// Particulars of the ship of the records. Fails for an unknown key.
    pub fn particulars(&self) -> Result<HullParticulars, IdentifiedShipError> {
        let mut particulars = HullParticulars::default();
        for (key, value) in &self.particulars {
            Particular::find(key).ok_or_else(|| self.unknown_model_error())?.set(&mut particulars, *value);
        }
        Ok(particulars)
    }

    /// Error of a form or coefficients unknown to this program, with the form of this hull.
    pub fn unknown_model_error(&self) -> IdentifiedShipError {
        IdentifiedShipError::Hull(self.form.clone())
    }

    /// Estimates of the coefficients, dimensionless, in the order of the form.
    pub fn values(&self) -> Vec<f64> {
        self.coefficients.iter().map(|coefficient| coefficient.value).collect()
    }

    /// Hull with the same coefficients on a ship of another length (m) and approach speed (m/s).
    #[must_use]
    pub fn scaled_to(&self, length: f64, speed: f64) -> Self {
        let second = length / speed * self.speed_m_s / self.length_m;
        let propeller_per_s = self.propeller_per_s.map(|rate| rate / second);
        let mut scaled = Self { length_m: length, speed_m_s: speed, propeller_per_s, ..self.clone() };
        scaled.model_error_moment.correlation_s *= second;
        scaled.beginning_yaw_rate_rad_s /= second;
        scaled
    }

    /// Hull at another loading and its approach speed, from the `expected` coefficients μ given the trials of this
    /// hull, their covariance C and their gain G with respect to the coefficients of this hull.
    ///
    /// The coefficients are θ = μ + G (θ₁ − θ̂₁) + e with Cov e = C − G C₁ Gᵀ. Here θ₁ are the true coefficients of
    /// this hull, θ̂₁ their estimate and C₁ its covariance, so both hulls share the errors of the trial. Value and
    /// error of δ_r are those of the trial, because ship, sensor and side of the propeller are unchanged. The random
    /// moment represents the error of the form: as a rudder angle, and with its correlation time in L/U₀, it stays the
    /// same. The propeller rate is unknown.
    #[must_use]
    pub fn at_loading(
        &self,
        ship: &HullParticulars,
        expected: &[HullCoefficient],
        [mut covariance, mut gain]: [DMatrix<f64>; 2],
    ) -> Self {
        let size = expected.len();
        let trial = DMatrix::from_fn(size, size, |row, column| self.covariance[row][column]);
        let of_trial: Vec<usize> = (0..size).filter(|&place| is_trial_specific(expected[place].key)).collect();
        for &place in &of_trial {
            gain.row_mut(place).fill(0.0);
            gain.column_mut(place).fill(0.0);
            gain[(place, place)] = 1.0;
        }
        let common = &gain * trial * gain.transpose();
        covariance -= &common;
        for &place in &of_trial {
            covariance.row_mut(place).fill(0.0);
            covariance.column_mut(place).fill(0.0);
        }
        let coefficient = |(place, prior): (usize, &HullCoefficient)| IdentifiedCoefficient {
            key: prior.key.to_owned(),
            symbol: prior.symbol.to_owned(),
            value: if is_trial_specific(prior.key) { self.coefficients[place].value } else { prior.mean },
            expected: prior.mean,
            expected_sd: prior.sd,
        };
        Self {
            propeller_per_s: None,
            particulars: keyed_particulars(ship),
            coefficients: expected.iter().enumerate().map(coefficient).collect(),
            covariance: matrix_rows(&(common + &covariance)),
            trial_hull: Some(TrialHull {
                hull: Box::new(self.clone()),
                gain,
                conditional_covariance: matrix_rows(&covariance),
            }),
            ..self.scaled_to(self.length_m, ship.speed)
        }
    }

    /// `true` if this hull at another loading was derived from the trials of `other`, at any scale.
    pub fn is_derived_from(&self, other: &Self) -> bool {
        let is_same = |hull: &Self| hull.coefficients == other.coefficients && hull.covariance == other.covariance;
        self.trial_hull.as_ref().is_some_and(|from| is_same(&from.hull))
    }
}
