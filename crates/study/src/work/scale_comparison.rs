//! Estimates of every method at each scale alone, compared with the joint estimate.

use document::method::MethodEntry;
use document::scales::{ComparedModel, ComparedTerm, ScalesEntry};
use identify::{Estimate, Identifier, Uncertainty};
use rayon::prelude::*;
use ship::Particulars;
use ship::angle::to_deg;
use trial::scale::compare_scales;
use trial::{Quantity, Trial};

use crate::records::file_and_hash;
use crate::scales::RescaledRecords;

/// Methods in order of preference where a single method represents all. The standard deviations of the first include
/// the uncertainty of the noise.
pub const PREFERRED_METHODS: [&str; 2] = ["maximum-likelihood", "output-error"];

/// A method with its label.
pub type LabelledMethod = (String, Box<dyn Identifier>);

/// Document entry that compares the estimates of every method at each scale alone with its joint estimate; `None` if
/// all fitted records have the same scale.
pub fn scales_entry(
    methods: &[LabelledMethod],
    answers: &[(MethodEntry, Option<Estimate>)],
    together: &RescaledRecords,
) -> Option<ScalesEntry> {
    let scales = together.scales.as_ref()?;
    let (first, groups) = (scales.particulars[0], scales.groups(together.trials.len()));
    let of_group = |records: &[usize]| records.iter().map(|&record| together.trials[record].clone()).collect();
    let trials: Vec<Vec<Trial>> = groups.iter().map(|(_, records)| of_group(records)).collect();
    let estimates_by_scale = |method: &dyn Identifier| -> Vec<Option<Estimate>> {
        trials.par_iter().map(|trials| method.identify(trials).ok()).collect()
    };
    let compared = |((_, method), (entry, joint)): (&LabelledMethod, &(MethodEntry, Option<Estimate>))| {
        let terms = terms(joint.as_ref()?, &estimates_by_scale(method.as_ref()), first);
        Some(ComparedModel { model: entry.method.clone(), terms })
    };
    let files: Vec<&str> = together.trials.iter().map(|trial| file_and_hash(trial).0).collect();
    let all = || methods.par_iter().zip(answers).filter_map(compared).collect();
    (groups.len() > 1).then(|| ScalesEntry::new(&groups, &files, first, all()))
}

/// Comparison of K', T', δ_r, and of 1/T' and K'/T', which are finite for 1/T = 0 as well.
fn terms(joint: &Estimate, by_scale: &[Option<Estimate>], ship: Particulars) -> Vec<ComparedTerm> {
    type Of = fn(&Estimate) -> Quantity;
    let all: [(&str, &str, [i32; 2], Of); 5] = [
        ("K′", "1", [-1, 0], Estimate::K),
        ("T′", "1", [1, 0], Estimate::T),
        ("1/T′", "1", [-1, 0], |estimate| parameter(estimate, 0)),
        ("K′/T′", "1", [-2, 0], |estimate| parameter(estimate, 1)),
        ("δ_r", "deg", [0, 0], |estimate| estimate.rudder_bias().scaled(to_deg(1.0))),
    ];
    let compared = |&(symbol, unit, dimension, quantity_of): &(&str, &str, [i32; 2], Of)| {
        let prime = |estimate: &Estimate| quantity_of(estimate).scaled(ship.prime_factor(dimension));
        let at_scales = by_scale.iter().map(|estimate| estimate.as_ref().map(prime)).collect();
        compared_term([symbol, unit], prime(joint), at_scales)
    };
    all.iter().map(compared).collect()
}

/// Comparison of a term between scales, from its symbol and unit, joint value and value at each scale.
pub fn compared_term([symbol, unit]: [&str; 2], joint: Quantity, at_scales: Vec<Option<Quantity>>) -> ComparedTerm {
    let values: Vec<Quantity> =
        at_scales.iter().map(|value| value.unwrap_or(Quantity::without_uncertainty(f64::NAN))).collect();
    let (difference_sd, verdict) = compare_scales(&values);
    ComparedTerm {
        symbol: symbol.to_owned(),
        unit: unit.to_owned(),
        joint,
        by_scale: at_scales,
        difference_sd,
        verdict,
    }
}

/// 1/T (`place` 0) or K/T (`place` 1) with standard deviation and 95 % interval, if the estimate has a covariance.
fn parameter(estimate: &Estimate, place: usize) -> Quantity {
    let value = [estimate.response.inverse_T, estimate.response.K_over_T][place];
    let Uncertainty::Covariance(covariance) = &estimate.uncertainty else {
        return Quantity::without_uncertainty(value);
    };
    let sd = covariance.matrix[(place, place)].max(0.0).sqrt();
    let reach = covariance.quantile95() * sd;
    Quantity { value, sd: Some(sd), ci95: Some([value - reach, value + reach]) }
}
