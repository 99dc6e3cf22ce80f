//! Parameters of a trace without dimension, and what the records of every scale say of them alone.

use ::trace::Analysis;
use ::trace::analysis::{Apart, Fitted};
use rayon::prelude::*;
use ship::Particulars;
use ship::angle::to_deg;
use ship::particulars::prime_unit;
use trial::Quantity;

use super::scale_comparison::{ComparedModel, ComparedTerm, ScalesEntry};
use crate::scales::Together;

/// A parameter without dimension, with its symbol and unit: a plain angle in degrees, all else with radians.
///
/// `None` where it has no dimension as it is.
pub fn prime(fitted: &Fitted, ship: Particulars) -> Option<(String, Quantity, String)> {
    let parameter = fitted.parameter;
    (parameter.dimension() != [0, 0]).then(|| {
        let (quantity, unit) = shown(fitted, fitted.prime(ship), prime_unit(parameter.unit));
        (primed(parameter.symbol), quantity, unit)
    })
}

/// A symbol without dimension: "n₃′/T′" of "n₃/T".
fn primed(symbol: &str) -> String {
    let part = |part: &str| if part == "1" { part.to_owned() } else { format!("{part}′") };
    symbol.split('/').map(part).collect::<Vec<String>>().join("/")
}

/// A rudder angle in degrees; frequencies stay in radians.
fn shown(fitted: &Fitted, quantity: Quantity, unit: String) -> (Quantity, String) {
    match unit == "rad" && fitted.parameter.symbol != "ω₀" {
        true => (quantity.scaled(to_deg(1.0)), String::from("deg")),
        false => (quantity, unit),
    }
}

/// A number whose error is not known where the search for it ended at a bound.
fn told(quantity: Quantity, at_bound: bool) -> Quantity {
    if at_bound { Quantity::bare(quantity.value) } else { quantity }
}

/// The final model on the records of every scale alone, against its parameters from all; `None` where the fitted
/// records have one scale.
pub fn compared(analysis: &Analysis, together: &Together) -> Option<ScalesEntry> {
    ScalesEntry::compared(together, |groups, first| {
        vec![ComparedModel { model: String::from("traced"), terms: terms(analysis, groups, first) }]
    })
}

/// K', T' and every parameter that belongs to all records.
fn terms(analysis: &Analysis, groups: &[(Particulars, Vec<usize>)], first: Particulars) -> Vec<ComparedTerm> {
    let own: Vec<Option<Apart>> = groups.par_iter().map(|(_, records)| analysis.apart(records)).collect();
    let mut terms = Vec::new();
    for (place, symbol, dimension) in [(0, "K′", [-1, 0]), (1, "T′", [1, 0])] {
        let prime = |indices: &[Quantity; 2]| indices[place].scaled(first.prime(dimension));
        let found = own.iter().map(|own| own.as_ref().map(|own| told(prime(&own.indices), own.ends()))).collect();
        terms.push(ComparedTerm::new(symbol, "1", prime(&analysis.indices), found));
    }
    // What belongs to one record is of one scale.
    for fitted in analysis.parameters.iter().filter(|fitted| fitted.only.is_none()) {
        let of = |fitted: &Fitted| {
            prime(fitted, first).unwrap_or_else(|| {
                let (quantity, unit) = shown(fitted, fitted.quantity, prime_unit(fitted.parameter.unit));
                (fitted.parameter.symbol.to_owned(), quantity, unit)
            })
        };
        let (symbol, joint, unit) = of(fitted);
        let counterpart = |own: &Apart| own.counterpart(fitted).map(|own| told(of(own).1, own.at_bound));
        let found = own.iter().map(|own| own.as_ref().and_then(counterpart)).collect();
        terms.push(ComparedTerm::new(symbol, &unit, joint, found));
    }
    terms
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_has_its_prime() {
        assert_eq!(["1/T", "K/T", "n₃/T", "T₂"].map(primed), ["1/T′", "K′/T′", "n₃′/T′", "T₂′"]);
    }
}
