//! A hull without dimension whose coefficients are to be found: surge, sway and yaw in units of L and U₀, three forms.
//!
//! Lengths in L, speeds in the approach speed U₀, times in L/U₀; n is the rate of the propeller over that of the
//! approach, δ the rudder, positive to starboard. Two forms are polynomials that name no part of the ship:
//!
//! r' = N_v u v + N_r u r + N_δ q δ_e + … v' = Y_v u v + Y_r u r + Y_δ q δ_e + …
//! u' = x₀ [(n² − k n u)/(1 − k) − u|u|] + X_vr v r + X_rr r² − X_δδ q δ_e²
//!
//! with the inflow to the rudder w = e u + (1 − e) n, q = w², and δ_e = δ + δ_r − b |r|/w (b: flow straightening that
//! differs by side). What stands for "…" is N_rr r|r| + N_vv v|v| and Y_rr r|r| + Y_vv v|v| in the quadratic form, and
//! terms of third order over u in the cubic one. The third form is the MMG model with its hull, propeller and rudder.
//!
//! Every form has Y_w, by which a measured wind acts on it.
//!
//! What is expected of the polynomials follows from what is expected of the MMG model.

mod equations;
mod nearest;
mod wind;

use estimation::number::Real;
use nalgebra::{DMatrix, DVector};

use self::equations::{BIAS, COMMON, CUBIC, PolynomialTerm, QUADRATIC};
pub use self::equations::{CalmHull, FASTEST, PrimeHull};
pub use self::wind::wind_accelerations;
use super::mmg::{Mmg, Parameters};
use super::prior::{HullParticulars, HullPrior, priors};

/// A coefficient, with what is expected of it before a record is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HullCoefficient {
    /// Name in files.
    pub key: &'static str,
    /// Symbol.
    pub symbol: &'static str,
    /// Expected value.
    pub mean: f64,
    /// Standard deviation of that.
    pub sd: f64,
    /// Smallest and largest value.
    pub ends: [f64; 2],
}

/// Standard deviation of δ_r, rad: 1.7°.
const RUDDER_BIAS: f64 = 0.03;

/// Coefficients of the MMG model that records of rudder and heading can tell something of; the others stay as expected.
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

/// Smallest and largest value of a free coefficient of the MMG model: beyond, there is no ship.
fn ends_of(key: &str) -> [f64; 2] {
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

/// What a departure of a coefficient from the expected value can mean, in words; `None` where nothing is to be said.
pub fn meaning(key: &str) -> Option<&'static str> {
    Some(match key {
        "delta_r" => "a bent rudder, a rudder whose zero is off, or a bank on one side",
        "b" | "gammaR-starboard" | "gammaR-port" => "a rudder whose inflow differs by side",
        "R0" | "x0" => "fouling, or another draught",
        "k" | "wP0" => "another wake: fouling, trim or shallow water",
        "epsilon" | "e" | "Nd" | "aH" => "a rudder of another force: damaged, fouled, or of another size",
        "Nv" | "Nr" | "lR" => "trim, or shallow water",
        "Yv" | "Yr" | "my" => "another draught, or shallow water",
        "Yw" => "another area above water: freeboard, deck cargo, or another draught",
        _ => return None,
    })
}

/// Whether a coefficient of a polynomial is the negative one in the mirror.
fn is_of_side(key: &str) -> bool {
    matches!(key, "b" | "delta_r")
}

/// Whether a coefficient belongs to a trial and not to the ship, which has another in the next one.
pub fn is_of_trial(key: &str) -> bool {
    key == BIAS.key
}

/// Whether a coefficient says what the wind does.
pub fn is_of_wind(key: &str) -> bool {
    key == wind::WINDAGE.key
}

/// Whether a coefficient depends on friction, which is another at another scale: resistance and wake (Reynolds).
pub fn is_of_friction(key: &str) -> bool {
    matches!(key, "x0" | "k" | "R0" | "wP0")
}

/// The equations of a form.
#[derive(Debug, Clone, PartialEq)]
enum FormEquations {
    /// Terms of second order.
    Quadratic,
    /// Terms of third order.
    Cubic,
    /// Hull, propeller and rudder of the MMG model about these parameters, without dimension (length 1).
    Mmg(Box<Parameters>),
}

/// What a hull is made of, and what is expected of its coefficients: a normal law.
#[derive(Debug, Clone, PartialEq)]
pub struct HullForm {
    equations: FormEquations,
    coefficients: Vec<HullCoefficient>,
    covariance: DMatrix<f64>,
}

impl HullForm {
    /// The forms that a ship can be fitted with, about what her particulars say: the two polynomials, and the MMG model
    /// where these are known. Without them the polynomials are those of any ship.
    pub fn of_ship(particulars: Option<&HullParticulars>) -> Vec<Self> {
        let own = particulars.and_then(|own| priors(own).ok());
        let polynomials = own.as_ref().and_then(Self::polynomials).unwrap_or_else(|| {
            // Of any ship at a usual Froude number: the forms have no dimension.
            let any = priors(&HullParticulars { length: 100.0, speed: 6.0, ..HullParticulars::default() });
            Self::polynomials(&any.expect("a ship")).expect("a ship")
        });
        polynomials.into_iter().chain(own.as_ref().map(Self::mmg)).collect()
    }

    /// The two polynomials about what the particulars of a ship say; `None` where these make no ship. A ship and her
    /// mirror image are as probable, so what differs by side is expected to be 0.
    fn polynomials(prior: &HullPrior) -> Option<[Self; 2]> {
        let [quadratic, cubic] = nearest::polynomials(prior)?;
        let form = |equations, terms: &[PolynomialTerm], (mut values, mut covariance): (DVector<f64>, DMatrix<f64>)| {
            let terms = [&COMMON[..], terms].concat();
            for place in (0..terms.len()).filter(|&place| is_of_side(terms[place].key)) {
                let own = if terms[place].key == BIAS.key { RUDDER_BIAS } else { 0.0 };
                let variance = covariance[(place, place)] + values[place] * values[place] + own * own;
                covariance.row_mut(place).fill(0.0);
                covariance.column_mut(place).fill(0.0);
                (values[place], covariance[(place, place)]) = (0.0, variance);
            }
            let is_law = values.iter().all(|value| value.is_finite()) && covariance.clone().cholesky().is_some();
            let coefficient =
                |(place, PolynomialTerm { key, symbol, ends }): (usize, &PolynomialTerm)| HullCoefficient {
                    key,
                    symbol,
                    mean: values[place].clamp(ends[0], ends[1]),
                    sd: covariance[(place, place)].sqrt(),
                    ends: *ends,
                };
            let coefficients = terms.iter().enumerate().map(coefficient).collect();
            is_law.then(|| Self { equations, coefficients, covariance }.with_windage(prior))
        };
        Some([form(FormEquations::Quadratic, &QUADRATIC, quadratic)?, form(FormEquations::Cubic, &CUBIC, cubic)?])
    }

    /// The MMG model about what the particulars of a ship say.
    pub fn mmg(prior: &HullPrior) -> Self {
        let of = |key: &&str| prior.coefficients.iter().find(|own| own.formula.key == *key);
        let free = FREE.iter().filter_map(of).map(|own| HullCoefficient {
            key: own.formula.key,
            symbol: own.formula.symbol,
            mean: own.mean,
            sd: own.sd,
            ends: ends_of(own.formula.key),
        });
        let PolynomialTerm { key, symbol, ends } = BIAS;
        let bias = HullCoefficient { key, symbol, mean: 0.0, sd: RUDDER_BIAS, ends };
        let coefficients: Vec<HullCoefficient> = free.chain([bias]).collect();
        let variances = DVector::from_iterator(coefficients.len(), coefficients.iter().map(|own| own.sd * own.sd));
        let equations = FormEquations::Mmg(Box::new(prior.parameters.of_length_one()));
        Self { equations, coefficients, covariance: DMatrix::from_diagonal(&variances) }.with_windage(prior)
    }

    /// The same with Y_w as its last coefficient.
    fn with_windage(mut self, prior: &HullPrior) -> Self {
        let PolynomialTerm { key, symbol, ends } = wind::WINDAGE;
        let ([mean, sd], calm) = (wind::windage(&prior.parameters), self.coefficients.len());
        self.covariance = self.covariance.resize(calm + 1, calm + 1, 0.0);
        self.covariance[(calm, calm)] = sd * sd;
        self.coefficients.push(HullCoefficient { key, symbol, mean, sd, ends });
        self
    }

    /// Its coefficients, in the order in which their values travel.
    pub fn coefficients(&self) -> &[HullCoefficient] {
        &self.coefficients
    }

    /// Covariance of what is expected of them.
    pub fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// The word used in files.
    pub fn as_str(&self) -> &'static str {
        match self.equations {
            FormEquations::Quadratic => "quadratic",
            FormEquations::Cubic => "cubic",
            FormEquations::Mmg(_) => "mmg",
        }
    }

    /// The hull with these values of its coefficients; `None` where they make no ship.
    pub fn with<R: Real>(&self, values: &[R]) -> Option<PrimeHull<R>> {
        let (&windage, values) = values.split_last()?;
        let in_calm = match &self.equations {
            FormEquations::Quadratic => CalmHull::Quadratic(values.try_into().ok()?),
            FormEquations::Cubic => CalmHull::Cubic(values.try_into().ok()?),
            FormEquations::Mmg(about) => {
                let mut parameters = about.constant::<R>();
                let (bias, free) = values.split_last()?;
                for (coefficient, value) in self.coefficients.iter().zip(free) {
                    *parameters.named(coefficient.key)? = *value;
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

    /// Whatever particulars are accepted, what is expected of every form is a normal law whose mean is a ship.
    #[test]
    fn every_ship_has_an_expected_hull_of_every_form() {
        let any = HullParticulars { length: 100.0, speed: 6.0, ..HullParticulars::default() };
        let mut own = vec![any];
        for (beam, draught) in [(8.4, 7.0), (8.4, 1.1), (45.0, 37.0), (45.0, 6.0), (15.0, 5.0)] {
            for block in [0.31, 0.6, 0.99] {
                let form = HullParticulars { beam: Some(beam), draught: Some(draught), ..any };
                own.push(HullParticulars { block_coefficient: Some(block), ..form });
                let area = |share: f64| Some(share * draught * 100.0);
                own.extend([0.0051, 0.099].map(|share| HullParticulars { rudder_area: area(share), ..form }));
            }
        }
        for ship in own {
            for form in HullForm::of_ship(Some(&ship)) {
                let means: Vec<f64> = form.coefficients().iter().map(|own| own.mean).collect();
                let name = form.as_str();
                assert!(form.covariance().clone().cholesky().is_some(), "{name} {ship:?}");
                let rates = form.with(&means).map(|hull| hull.accelerations([1.0, 0.0, 0.1], 0.3, 1.0, 0.0, [0.0; 3]));
                assert!(name == "mmg" || rates.expect("a ship").iter().all(|rate| rate.is_finite()), "{name} {ship:?}");
            }
        }
    }
}
