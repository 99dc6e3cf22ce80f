//! A hull of three degrees of freedom as files hold it.

use std::collections::BTreeMap;

use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::vessel::prime::{HullCoefficient, HullForm, is_of_trial};
use ship::vessel::prior::{HullParticulars, PARTICULARS, Particular};

use crate::error::IdentifiedShipError;

/// A coefficient of a hull beside what was expected of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StoredCoefficient {
    /// Name.
    pub key: String,
    /// Symbol.
    pub symbol: String,
    /// Value.
    pub value: f64,
    /// What was expected before the records were seen.
    pub expected: f64,
    /// Standard deviation of that.
    pub expected_sd: f64,
}

impl StoredCoefficient {
    /// How far it is from what was expected, in standard deviations of that.
    pub fn departure(&self) -> f64 {
        (self.value - self.expected) / self.expected_sd
    }
}

/// What is random in yaw: an Ornstein–Uhlenbeck moment that stands for what the form gets wrong.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RandomYawMoment {
    /// Standard deviation as the rudder angle that has the same moment at approach speed, rad.
    pub deviation_rudder_rad: f64,
    /// Time in which its autocorrelation falls to 1/e, s.
    pub correlation_s: f64,
}

/// A hull of three degrees of freedom with what is known of its coefficients, which have no dimension.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StoredHull {
    /// `quadratic`, `cubic` or `mmg`.
    pub form: String,
    /// Weight among the hulls of the file.
    pub weight: f64,
    /// Length of the ship, m.
    pub length_m: f64,
    /// Approach speed, m/s.
    pub speed_m_s: f64,
    /// Rate of the propeller on the approach, 1/s, where it was recorded.
    pub propeller_per_s: Option<f64>,
    /// Particulars of the ship of the records by their keys, which say what is expected of the form; at the scale of
    /// the records, whatever the scale of this hull.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub particulars: BTreeMap<String, f64>,
    /// Its coefficients.
    pub coefficients: Vec<StoredCoefficient>,
    /// Their covariance, by rows.
    pub covariance: Vec<Vec<f64>>,
    /// What the form leaves of the records.
    pub moment: RandomYawMoment,
    /// Root mean square of what its replays of records begin with beyond the yaw rate of the straight approach, rad/s:
    /// an error of the form in the first seconds of a manoeuvre. 0 where no record begins straight.
    #[serde(default)]
    pub beginning_yaw_rate_rad_s: f64,
    /// Of a hull at another loading the one of the trials; not written to a file.
    #[serde(skip)]
    pub from: Option<TrialHull>,
}

/// The hull that trials left, with which that at another loading varies.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialHull {
    /// The hull.
    pub hull: Box<StoredHull>,
    /// G, how far the coefficients at the other loading follow those of the hull.
    pub gain: DMatrix<f64>,
    /// Covariance of what the hull does not tell of them.
    pub rest: Vec<Vec<f64>>,
}

/// Particulars by their keys, as a hull has them.
pub fn by_keys(particulars: &HullParticulars) -> BTreeMap<String, f64> {
    PARTICULARS.iter().filter_map(|own| Some((own.key.to_owned(), own.get(particulars)?))).collect()
}

/// A matrix by its rows.
pub fn rows_of(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

impl StoredHull {
    /// The form, made again; fails for one that this program does not know, and for other coefficients than its own.
    pub fn form(&self) -> Result<HullForm, IdentifiedShipError> {
        let refused = || self.refused();
        let forms = HullForm::of_ship(Some(&self.particulars()?));
        let form = forms.into_iter().find(|form| form.as_str() == self.form).ok_or_else(refused)?;
        let own = form.coefficients();
        let are_same = own.iter().map(|own| own.key).eq(self.coefficients.iter().map(|own| own.key.as_str()));
        if are_same { Ok(form) } else { Err(refused()) }
    }

    /// The particulars that it is made from; fails for a key that this program does not know.
    pub fn particulars(&self) -> Result<HullParticulars, IdentifiedShipError> {
        let mut particulars = HullParticulars::default();
        for (key, value) in &self.particulars {
            Particular::named(key).ok_or_else(|| self.refused())?.set(&mut particulars, *value);
        }
        Ok(particulars)
    }

    /// That no hull of this program is made from it.
    pub fn refused(&self) -> IdentifiedShipError {
        IdentifiedShipError::Hull(self.form.clone())
    }

    /// The values of the coefficients.
    pub fn values(&self) -> Vec<f64> {
        self.coefficients.iter().map(|own| own.value).collect()
    }

    /// The same coefficients on a ship of another length (m) and approach speed (m/s): at the same Froude number the
    /// ship of the model.
    #[must_use]
    pub fn scaled_to(&self, length: f64, speed: f64) -> Self {
        let second = length / speed * self.speed_m_s / self.length_m;
        let moment = RandomYawMoment { correlation_s: self.moment.correlation_s * second, ..self.moment };
        let propeller_per_s = self.propeller_per_s.map(|rate| rate / second);
        let beginning_yaw_rate_rad_s = self.beginning_yaw_rate_rad_s / second;
        Self { length_m: length, speed_m_s: speed, propeller_per_s, moment, beginning_yaw_rate_rad_s, ..self.clone() }
    }

    /// The hull at another loading and at its approach speed: `expected` of its coefficients after the trials that left
    /// this hull, their covariance C, and G, how far they follow those of this hull.
    ///
    /// θ = μ + G (θ₁ − θ̂₁) + e, Cov e = C − G C₁ Gᵀ: both hulls are of one trial, and what that has wrong is wrong in
    /// both. δ_r is that of the trial, value and error: ship, sensor and side of the propeller are the same. So are the
    /// random moment as a rudder angle, which stands for the form, and its time in L/U₀. The rate of the propeller
    /// is not known.
    #[must_use]
    pub fn at_loading(
        &self,
        ship: &HullParticulars,
        expected: &[HullCoefficient],
        [mut covariance, mut gain]: [DMatrix<f64>; 2],
    ) -> Self {
        let size = expected.len();
        let own = DMatrix::from_fn(size, size, |row, column| self.covariance[row][column]);
        let of_trial: Vec<usize> = (0..size).filter(|&place| is_of_trial(expected[place].key)).collect();
        for &place in &of_trial {
            gain.row_mut(place).fill(0.0);
            gain.column_mut(place).fill(0.0);
            gain[(place, place)] = 1.0;
        }
        let common = &gain * own * gain.transpose();
        covariance -= &common;
        for &place in &of_trial {
            covariance.row_mut(place).fill(0.0);
            covariance.column_mut(place).fill(0.0);
        }
        let coefficient = |(place, own): (usize, &HullCoefficient)| StoredCoefficient {
            key: own.key.to_owned(),
            symbol: own.symbol.to_owned(),
            value: if is_of_trial(own.key) { self.coefficients[place].value } else { own.mean },
            expected: own.mean,
            expected_sd: own.sd,
        };
        Self {
            propeller_per_s: None,
            particulars: by_keys(ship),
            coefficients: expected.iter().enumerate().map(coefficient).collect(),
            covariance: rows_of(&(common + &covariance)),
            from: Some(TrialHull { hull: Box::new(self.clone()), gain, rest: rows_of(&covariance) }),
            ..self.scaled_to(self.length_m, ship.speed)
        }
    }

    /// Whether this hull is taken from another one, at whatever scale.
    pub fn is_from(&self, other: &Self) -> bool {
        let is_same = |own: &Self| own.coefficients == other.coefficients && own.covariance == other.covariance;
        self.from.as_ref().is_some_and(|from| is_same(&from.hull))
    }
}
