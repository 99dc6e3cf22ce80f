//! Priors of the coefficients of an MMG hull from the particulars of a ship: mean and standard deviation of each, from
//! published formulas and typical values.
//!
//! A missing particular is replaced by a typical ratio of ships, whose spread widens the prior: every formula is
//! evaluated at the ratio one standard deviation higher and lower, and half of the difference is added in quadrature.
//!
//! The table of the formulas contains their sources.

mod formulas;
mod likeness;
mod particulars;

pub use self::particulars::{HullParticulars, PARTICULARS, Particular, ParticularsError, USUAL_FROUDE_NUMBER};

pub use self::formulas::CoefficientFormula;
use self::formulas::{FORMULAS, Spread};
use self::particulars::{HullDimensions, RATIOS};
use super::mmg::{BySign, HullDerivatives, MmgParameters, Propeller, Rudder, Wake};

/// Normal prior of one dimensionless coefficient of an MMG hull.
#[derive(Debug, Clone, Copy)]
pub struct CoefficientPrior {
    /// Formula of the mean, with name and source.
    pub formula: &'static CoefficientFormula,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
}

/// Source of the typical ratios.
pub const RATIO_SOURCE: &str = "typical: KVLCC2, KCS, ONRT, Esso Osaka, SEIUN MARU";

/// Assumed value of a particular that was not given.
#[derive(Debug, Clone, PartialEq)]
pub struct AssumedParticular {
    /// Key of the particular.
    pub key: &'static str,
    /// Assumed value, in the unit of the key.
    pub value: f64,
    /// Standard deviation of the value.
    pub sd: f64,
    /// Ratio from which it follows.
    pub formula: String,
}

/// Prior of an MMG hull: its mean, and the spread of its coefficients.
#[derive(Debug, Clone)]
pub struct HullPrior {
    /// Parameters of the mean hull, for [`super::mmg::Mmg::at_speed`].
    pub mean_parameters: MmgParameters,
    /// Priors of the coefficients.
    pub coefficient_priors: Vec<CoefficientPrior>,
    /// Values assumed for particulars that were not given.
    pub assumed_particulars: Vec<AssumedParticular>,
    /// Hulls one standard deviation above and below the mean, in every assumed ratio and in every coefficient by the
    /// error of its formula.
    pub deviated_parameters: Vec<[MmgParameters; 2]>,
}

/// Prior of the hull with these particulars.
///
/// Fails for particulars outside the range of ships, or that contradict each other.
pub fn hull_prior(given: &HullParticulars) -> Result<HullPrior, ParticularsError> {
    given.check()?;
    let typical = RATIOS.map(|ratio| ratio.mean);
    let form = given.complete_dimensions(&typical);
    let shifted: Vec<[HullDimensions; 2]> = RATIOS
        .iter()
        .enumerate()
        .map(|(place, ratio)| {
            [ratio.sd, -ratio.sd].map(|shift| {
                let mut ratios = typical;
                ratios[place] += shift;
                given.complete_dimensions(&ratios)
            })
        })
        .collect();
    let variance = |value: &dyn Fn(&HullDimensions) -> f64| -> f64 {
        shifted.iter().map(|[above, below]| (0.5 * (value(above) - value(below))).powi(2)).sum()
    };
    let parameters = hull(&form);
    let mut deviations: Vec<[MmgParameters; 2]> = shifted.iter().map(|pair| pair.each_ref().map(hull)).collect();
    let coefficient = |formula: &'static CoefficientFormula| {
        let mean = (formula.mean)(&form);
        let sd = match formula.spread {
            Spread::Share(share) => share * mean,
            Spread::Absolute(value) => value,
        };
        deviations.push([sd, -sd].map(|shift| with(parameters, formula, mean + shift)));
        CoefficientPrior { formula, mean, sd: (sd * sd + variance(&formula.mean)).sqrt() }
    };
    let coefficients = FORMULAS.iter().map(coefficient).collect();
    let assumed = PARTICULARS.iter().filter_map(|particular| {
        let dimension = |form: &HullDimensions| particular.of_form.map_or(f64::NAN, |of_form| of_form(form));
        let formula = RATIOS.iter().find(|ratio| ratio.fills == particular.key)?.text();
        let (value, missing) = (dimension(&form), particular.get(given).is_none() && particular.of_form.is_some());
        missing.then(|| AssumedParticular { key: particular.key, value, sd: variance(&dimension).sqrt(), formula })
    });
    Ok(HullPrior {
        mean_parameters: parameters,
        assumed_particulars: assumed.collect(),
        coefficient_priors: coefficients,
        deviated_parameters: deviations,
    })
}

/// Parameters with one coefficient replaced.
fn with(mut parameters: MmgParameters, formula: &CoefficientFormula, value: f64) -> MmgParameters {
    *parameters.coefficient_mut(formula.key).expect("every coefficient has its place") = value;
    parameters
}

/// Hull of these dimensions, by the formulas.
fn hull(form: &HullDimensions) -> MmgParameters {
    FORMULAS.iter().fold(blank(form), |hull, formula| with(hull, formula, (formula.mean)(form)))
}

/// Hull of these dimensions whose coefficients are not set.
fn blank(form: &HullDimensions) -> MmgParameters {
    MmgParameters {
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
        // A propeller higher than the rudder covers it fully.
        rudder: Rudder { AR: form.AR, eta: (form.DP / form.HR).min(1.0), ..Rudder::default() },
    }
}

#[cfg(test)]
mod tests;
