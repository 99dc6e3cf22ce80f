//! Nondimensional hulls whose coefficients are identified: surge, sway and yaw in units of L and U₀, in three forms.
//!
//! Lengths in L, speeds in the approach speed U₀, times in L/U₀; n is the propeller rate relative to the approach, δ
//! the rudder angle, positive to starboard. Two forms are polynomials of the whole ship:
//!
//! r' = N_v u v + N_r u r + N_δ q δ_e + …
//!
//! v' = Y_v u v + Y_r u r + Y_δ q δ_e + …
//!
//! u' = x₀ [(n² − k n u)/(1 − k) − u|u|] + X_vr v r + X_rr r² − X_δδ q δ_e²
//!
//! with the rudder inflow w = e u + (1 − e) n, q = w², and δ_e = δ + δ_r − b |r|/w (b: flow straightening that differs
//! by side). "…" denotes N_rr r|r| + N_vv v|v| and Y_rr r|r| + Y_vv v|v| in the quadratic form, and terms of third
//! order over u in the cubic form. The third form is the MMG model with hull, propeller and rudder.
//!
//! Every form has a wind coefficient Y_w. The priors of the polynomials follow from the priors of the MMG model.
//!
//! Sources: Abkowitz (1964) and Norrbin (1971) for the polynomials; Yasukawa and Yoshimura (2015) for the MMG model.

mod equations;
mod nearest;
mod wind;

use estimation::number::Real;
use nalgebra::{DMatrix, DVector};

use self::equations::{BIAS_TERM, COMMON_TERMS, CUBIC_TERMS, PolynomialTerm, QUADRATIC_TERMS};
pub use self::equations::{CalmHull, MAX_PRIME_SPEED, PrimeHull};
pub use self::wind::wind_accelerations;
use super::mmg::{Mmg, MmgParameters};
use super::prior::{HullParticulars, HullPrior, hull_prior};

/// Coefficient of a hull model with its normal prior; dimensionless (prime system), δ_r in rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HullCoefficient {
    /// Name in files.
    pub key: &'static str,
    /// Symbol in formulas and tables.
    pub symbol: &'static str,
    /// Prior mean.
    pub mean: f64,
    /// Prior standard deviation.
    pub sd: f64,
    /// Minimum and maximum valid value; infinite without a bound.
    pub bounds: [f64; 2],
}

/// Prior standard deviation of δ_r, rad: 1.7°.
const RUDDER_BIAS_SD_RAD: f64 = 0.03;

/// Coefficients of the MMG model that are fitted to records of rudder and heading; other coefficients keep their prior
/// mean.
const FREE: [&str; 23] = [
    "Nv",
    "Nr",
    "Yv",
    "Yr",
    "epsilon",
    "my",
    "Jz",
    "R0",
    "Xvr",
    "Xrr",
    "Yvvv",
    "Yvvr",
    "Yvrr",
    "Yrrr",
    "Nvvv",
    "Nvvr",
    "Nvrr",
    "Nrrr",
    "wP0",
    "aH",
    "lR",
    "gammaR-starboard",
    "gammaR-port",
];

/// Bounds, lower and upper, of a free coefficient of the MMG model; infinite without a bound.
fn bounds_of(key: &str) -> [f64; 2] {
    match key {
        "R0" => [0.002, 0.2],
        "wP0" => [0.0, 0.8],
        "epsilon" => [0.3, 3.0],
        "my" | "Jz" => [0.0, 2.0],
        "gammaR-starboard" | "gammaR-port" => [0.0, 1.5],
        "Yvvv" | "Nrrr" => [-20.0, 0.02],
        _ => [f64::NEG_INFINITY, f64::INFINITY],
    }
}

/// Possible physical cause of a departure of a coefficient from its prior mean, for messages; `None` if no cause is
/// known.
pub fn departure_cause(key: &str) -> Option<&'static str> {
    Some(match key {
        "delta_r" => "a bent rudder, a zero error of the rudder angle, or a bank on one side",
        "b" | "gammaR-starboard" | "gammaR-port" => "a rudder inflow that differs between port and starboard",
        "R0" | "x0" => "fouling, or a different draught",
        "k" | "wP0" => "a different wake: fouling, trim or shallow water",
        "epsilon" | "e" | "Nd" | "aH" => "a different rudder force: damage, fouling, or another size of the rudder",
        "Nv" | "Nr" | "lR" => "trim, or shallow water",
        "Yv" | "Yr" | "my" => "a different draught, or shallow water",
        "Yw" => "a different area above water: freeboard, deck cargo, or draught",
        _ => return None,
    })
}

/// `true` if a coefficient of a polynomial changes sign when port and starboard are exchanged.
fn is_of_side(key: &str) -> bool {
    matches!(key, "b" | "delta_r")
}

/// `true` if a coefficient belongs to the trial and not to the ship, such as δ_r: every trial has a separate value.
pub fn is_trial_specific(key: &str) -> bool {
    key == BIAS_TERM.key
}

/// `true` for the coefficient of the wind.
pub fn is_wind_coefficient(key: &str) -> bool {
    key == wind::WIND_COEFFICIENT.key
}

/// `true` if a coefficient depends on friction (resistance and wake) and therefore on the scale (Reynolds number).
pub fn is_frictional(key: &str) -> bool {
    matches!(key, "x0" | "k" | "R0" | "wP0")
}

/// Equations of a [`HullModel`].
#[derive(Debug, Clone, PartialEq)]
enum FormEquations {
    /// Polynomial of second order.
    Quadratic,
    /// Polynomial of third order.
    Cubic,
    /// MMG model about these parameters, nondimensional (length 1).
    Mmg(Box<MmgParameters>),
}

/// Model of a hull: equations of one form (quadratic, cubic or MMG), with the normal prior of the coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct HullModel {
    equations: FormEquations,
    coefficients: Vec<HullCoefficient>,
    covariance: DMatrix<f64>,
}

impl HullModel {
    /// Candidate forms for a ship, with priors from the particulars: the two polynomials, and the MMG model. Without
    /// particulars, or with particulars outside the range of ships, only the polynomials with the priors of any ship.
    pub fn candidates(particulars: Option<&HullParticulars>) -> Vec<Self> {
        let prior = particulars.and_then(|particulars| hull_prior(particulars).ok());
        let polynomials = prior.as_ref().and_then(Self::polynomials).unwrap_or_else(|| {
            // Any ship at a usual Froude number, because the forms are nondimensional.
            let any = hull_prior(&HullParticulars { length: 100.0, speed: 6.0, ..HullParticulars::default() });
            Self::polynomials(&any.expect("a ship")).expect("a ship")
        });
        polynomials.into_iter().chain(prior.as_ref().map(Self::mmg)).collect()
    }

    /// The two polynomials with priors from the particulars; `None` if these are not valid for a ship. A ship and
    /// its mirror image are equally probable, so coefficients of asymmetry have prior mean 0.
    fn polynomials(prior: &HullPrior) -> Option<[Self; 2]> {
        let [quadratic, cubic] = nearest::polynomial_priors(prior)?;
        let form = |equations, terms: &[PolynomialTerm], (mut values, mut covariance): (DVector<f64>, DMatrix<f64>)| {
            let terms = [&COMMON_TERMS[..], terms].concat();
            for place in (0..terms.len()).filter(|&place| is_of_side(terms[place].key)) {
                let extra_sd = if terms[place].key == BIAS_TERM.key { RUDDER_BIAS_SD_RAD } else { 0.0 };
                let variance = covariance[(place, place)] + values[place] * values[place] + extra_sd * extra_sd;
                covariance.row_mut(place).fill(0.0);
                covariance.column_mut(place).fill(0.0);
                (values[place], covariance[(place, place)]) = (0.0, variance);
            }
            let is_valid = values.iter().all(|value| value.is_finite()) && covariance.clone().cholesky().is_some();
            let coefficient =
                |(place, PolynomialTerm { key, symbol, bounds }): (usize, &PolynomialTerm)| HullCoefficient {
                    key,
                    symbol,
                    mean: values[place].clamp(bounds[0], bounds[1]),
                    sd: covariance[(place, place)].sqrt(),
                    bounds: *bounds,
                };
            let coefficients = terms.iter().enumerate().map(coefficient).collect();
            is_valid.then(|| Self { equations, coefficients, covariance }.with_windage(prior))
        };
        let quadratic = form(FormEquations::Quadratic, &QUADRATIC_TERMS, quadratic)?;
        Some([quadratic, form(FormEquations::Cubic, &CUBIC_TERMS, cubic)?])
    }

    /// MMG form with the priors of its coefficients.
    pub fn mmg(prior: &HullPrior) -> Self {
        let by_key = |key: &&str| prior.coefficient_priors.iter().find(|coefficient| coefficient.formula.key == *key);
        let free = FREE.iter().filter_map(by_key).map(|coefficient| HullCoefficient {
            key: coefficient.formula.key,
            symbol: coefficient.formula.symbol,
            mean: coefficient.mean,
            sd: coefficient.sd,
            bounds: bounds_of(coefficient.formula.key),
        });
        let PolynomialTerm { key, symbol, bounds } = BIAS_TERM;
        let bias = HullCoefficient { key, symbol, mean: 0.0, sd: RUDDER_BIAS_SD_RAD, bounds };
        let coefficients: Vec<HullCoefficient> = free.chain([bias]).collect();
        let variances =
            DVector::from_iterator(coefficients.len(), coefficients.iter().map(|prior| prior.sd * prior.sd));
        let equations = FormEquations::Mmg(Box::new(prior.mean_parameters.at_unit_length()));
        Self { equations, coefficients, covariance: DMatrix::from_diagonal(&variances) }.with_windage(prior)
    }

    /// Form with the wind coefficient Y_w appended.
    fn with_windage(mut self, prior: &HullPrior) -> Self {
        let PolynomialTerm { key, symbol, bounds } = wind::WIND_COEFFICIENT;
        let ([mean, sd], calm) = (wind::wind_coefficient_prior(&prior.mean_parameters), self.coefficients.len());
        self.covariance = self.covariance.resize(calm + 1, calm + 1, 0.0);
        self.covariance[(calm, calm)] = sd * sd;
        self.coefficients.push(HullCoefficient { key, symbol, mean, sd, bounds });
        self
    }

    /// Coefficients, in the order of their values.
    pub fn coefficients(&self) -> &[HullCoefficient] {
        &self.coefficients
    }

    /// Prior covariance of the coefficients, in their order.
    pub fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// Name in files.
    pub fn as_str(&self) -> &'static str {
        match self.equations {
            FormEquations::Quadratic => "quadratic",
            FormEquations::Cubic => "cubic",
            FormEquations::Mmg(_) => "mmg",
        }
    }

    /// Hull with these coefficient values, in the order of [`coefficients`](Self::coefficients); `None` if their number
    /// is wrong or they are not valid for a ship.
    pub fn with_coefficients<R: Real>(&self, values: &[R]) -> Option<PrimeHull<R>> {
        let (&windage, values) = values.split_last()?;
        let in_calm = match &self.equations {
            FormEquations::Quadratic => CalmHull::Quadratic(values.try_into().ok()?),
            FormEquations::Cubic => CalmHull::Cubic(values.try_into().ok()?),
            FormEquations::Mmg(about) => {
                let mut parameters = about.to_real::<R>();
                let (bias, free) = values.split_last()?;
                for (coefficient, value) in self.coefficients.iter().zip(free) {
                    *parameters.coefficient_mut(coefficient.key)? = *value;
                }
                CalmHull::Mmg(Box::new(Mmg::at_speed(parameters, 1.0).ok()?), *bias)
            }
        };
        Some(PrimeHull { in_calm, windage })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Prior of every form for all accepted particulars: a normal distribution whose mean is a valid ship.
    #[test]
    fn every_ship_has_an_expected_hull_of_every_form() {
        let any = HullParticulars { length: 100.0, speed: 6.0, ..HullParticulars::default() };
        let mut ships = vec![any];
        for (beam, draught) in [(8.4, 7.0), (8.4, 1.1), (45.0, 37.0), (45.0, 6.0), (15.0, 5.0)] {
            for block in [0.31, 0.6, 0.99] {
                let form = HullParticulars { beam: Some(beam), draught: Some(draught), ..any };
                ships.push(HullParticulars { block_coefficient: Some(block), ..form });
                let area = |share: f64| Some(share * draught * 100.0);
                ships.extend([0.0051, 0.099].map(|share| HullParticulars { rudder_area: area(share), ..form }));
            }
        }
        for ship in ships {
            for form in HullModel::candidates(Some(&ship)) {
                let means: Vec<f64> = form.coefficients().iter().map(|coefficient| coefficient.mean).collect();
                let name = form.as_str();
                assert!(form.covariance().clone().cholesky().is_some(), "{name} {ship:?}");
                let rates = form
                    .with_coefficients(&means)
                    .map(|hull| hull.accelerations([1.0, 0.0, 0.1], 0.3, 1.0, 0.0, [0.0; 3]));
                assert!(name == "mmg" || rates.expect("a ship").iter().all(|rate| rate.is_finite()), "{name} {ship:?}");
            }
        }
    }
}
