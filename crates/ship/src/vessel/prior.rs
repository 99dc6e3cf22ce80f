//! What the particulars of a ship say about the coefficients of her MMG hull before she is steered: a mean and a
//! standard deviation of each, from published formulas and typical values.
//!
//! A particular that is missing is filled in by the ratio that is typical of ships, and the spread of that ratio widens
//! the prior: every formula is evaluated at the ratio a standard deviation higher and lower, half of the difference is
//! added in quadrature.

mod formulas;
mod likeness;
mod particulars;

pub use self::particulars::{HullParticulars, PARTICULARS, Particular, ParticularsError, USUAL_FROUDE_NUMBER};

pub use self::formulas::Formula;
use self::formulas::{FORMULAS, Spread};
use self::particulars::{HullDimensions, RATIOS};
use super::mmg::{BySign, HullDerivatives, Parameters, Propeller, Rudder, Wake};

/// The prior of one coefficient.
#[derive(Debug, Clone, Copy)]
pub struct Coefficient {
    /// What it is called, and where it comes from.
    pub formula: &'static Formula,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
}

/// Source of every ratio that fills in a particular.
pub const SOURCE_OF_RATIOS: &str = "typical: KVLCC2, KCS, ONRT, Esso Osaka, SEIUN MARU";

/// A particular that was not given.
#[derive(Debug, Clone, PartialEq)]
pub struct Assumed {
    /// Which one.
    pub key: &'static str,
    /// What stands for it, in the unit of the key.
    pub value: f64,
    /// Standard deviation of that.
    pub sd: f64,
    /// The ratio it follows from.
    pub formula: String,
}

/// The prior of a hull.
#[derive(Debug, Clone)]
pub struct HullPrior {
    /// The hull with the mean of every coefficient; [`super::mmg::Mmg::at_speed`] makes it sail.
    pub parameters: Parameters,
    /// The prior of every coefficient.
    pub coefficients: Vec<Coefficient>,
    /// What was filled in.
    pub assumed: Vec<Assumed>,
    /// Hulls a standard deviation above and below the mean: in every ratio that may be filled in, and in every
    /// coefficient by the error of its formula.
    pub deviations: Vec<[Parameters; 2]>,
}

/// The prior of the hull with these particulars.
///
/// Fails for particulars that no ship has, or that contradict each other.
pub fn priors(given: &HullParticulars) -> Result<HullPrior, ParticularsError> {
    given.check()?;
    let typical = RATIOS.map(|ratio| ratio.mean);
    let form = given.form(&typical);
    let shifted: Vec<[HullDimensions; 2]> = RATIOS
        .iter()
        .enumerate()
        .map(|(place, ratio)| {
            [ratio.sd, -ratio.sd].map(|shift| {
                let mut ratios = typical;
                ratios[place] += shift;
                given.form(&ratios)
            })
        })
        .collect();
    let spread = |of: &dyn Fn(&HullDimensions) -> f64| -> f64 {
        shifted.iter().map(|[above, below]| (0.5 * (of(above) - of(below))).powi(2)).sum()
    };
    let parameters = hull(&form);
    let mut deviations: Vec<[Parameters; 2]> = shifted.iter().map(|pair| pair.each_ref().map(hull)).collect();
    let coefficient = |formula: &'static Formula| {
        let mean = (formula.of)(&form);
        let own = match formula.spread {
            Spread::Share(share) => share * mean,
            Spread::Absolute(sd) => sd,
        };
        deviations.push([own, -own].map(|shift| with(parameters, formula, mean + shift)));
        Coefficient { formula, mean, sd: (own * own + spread(&formula.of)).sqrt() }
    };
    let coefficients = FORMULAS.iter().map(coefficient).collect();
    let assumed = PARTICULARS.iter().filter_map(|particular| {
        let of = |form: &HullDimensions| particular.of_form.map_or(f64::NAN, |of| of(form));
        let formula = RATIOS.iter().find(|ratio| ratio.fills == particular.key)?.text();
        let missing = particular.get(given).is_none() && particular.of_form.is_some();
        missing.then(|| Assumed { key: particular.key, value: of(&form), sd: spread(&of).sqrt(), formula })
    });
    Ok(HullPrior { parameters, assumed: assumed.collect(), coefficients, deviations })
}

/// Parameters with another value of one coefficient.
fn with(mut parameters: Parameters, formula: &Formula, value: f64) -> Parameters {
    *parameters.named(formula.key).expect("every coefficient has its place") = value;
    parameters
}

/// The hull of these dimensions, by the formulas.
fn hull(form: &HullDimensions) -> Parameters {
    FORMULAS.iter().fold(blank(form), |hull, formula| with(hull, formula, (formula.of)(form)))
}

/// The dimensions of a hull; its coefficients are still to be set.
fn blank(form: &HullDimensions) -> Parameters {
    Parameters {
        Lpp: form.L,
        d: form.d,
        volume: form.Cb * form.L * form.B * form.d,
        xG: form.xG,
        kzz: 0.0,
        hull: HullDerivatives::default(),
        propeller: Propeller {
            DP: form.DP,
            wP0: 0.0,
            wake: Wake::Exponential { C1: 0.0, C2: BySign::default() },
            tP: 0.0,
            xP: 0.0,
            k: [0.0; 3],
        },
        // A propeller that is higher than the rudder covers all of it.
        rudder: Rudder { AR: form.AR, eta: (form.DP / form.HR).min(1.0), ..Rudder::default() },
    }
}

#[cfg(test)]
mod tests;
