//! The model of all records on some of them alone: what one ship, one scale or one day says of parameters that are told
//! for all.

use trial::Quantity;

use super::left_out::on_others;
use super::parameters::{indices, parameter_covariance, parameters};
use super::result::{Analysis, Fitted};
use crate::index::RecordNumber;

/// The final model fitted to some of the records.
#[derive(Debug, Clone, PartialEq)]
pub struct Apart {
    /// K (1/s) and T (s).
    pub indices: [Quantity; 2],
    /// All parameters, but those that belong to one of the other records.
    pub parameters: Vec<Fitted>,
}

impl Apart {
    /// The parameter that stands here for one of another fit of the same structure; `None` where it belongs to a
    /// record that was not fitted.
    pub fn counterpart(&self, of: &Fitted) -> Option<&Fitted> {
        let is_it = |own: &&Fitted| own.parameter == of.parameter && own.only == of.only;
        self.parameters.iter().find(is_it)
    }

    /// Whether K or T rest on a parameter at an end of its range.
    pub fn ends(&self) -> bool {
        let of_base = |fitted: &&Fitted| ["inverse_T", "K_over_T"].contains(&fitted.parameter.key);
        self.parameters.iter().filter(of_base).any(|fitted| fitted.at_bound)
    }
}

impl Analysis {
    /// The final model with its structure and the colour of its noise kept and its parameters fitted to the records of
    /// these numbers alone, the search beginning from the parameters of all.
    ///
    /// `None` where no record is named, a number is too large or the fit is not finite; a parameter has no standard
    /// deviation where these records do not tell it from the others.
    pub fn apart(&self, records: &[usize]) -> Option<Apart> {
        let count = self.problem.records.len();
        if records.is_empty() || records.iter().any(|&record| record >= count) {
            return None;
        }
        let (mut structure, mut theta) = (self.told.structure.clone(), self.told.fit.theta.clone());
        for left in (0..count).rev().filter(|record| !records.contains(record)) {
            (structure, theta) = on_others(&structure, &theta, RecordNumber(left));
        }
        let kept: Vec<usize> = (0..count).filter(|record| records.contains(record)).collect();
        let problem = self.problem.on(kept.iter().map(|&record| self.problem.records[record].clone()).collect());
        let initial: Vec<[f64; 2]> = kept.iter().map(|&record| self.told.fit.initial[record]).collect();
        let fit = problem.fit(&structure, &theta, &initial, &self.told.fit.colour);
        if !fit.theta.iter().all(|value| value.is_finite()) {
            return None;
        }
        let fitted = (&structure, &fit);
        let covariance = parameter_covariance(&problem, fitted, self.coloured);
        let names: Vec<String> = kept.iter().map(|&record| self.identification[record].name.clone()).collect();
        let parameters = parameters(&problem, fitted, covariance.as_ref(), &names);
        Some(Apart { indices: indices(fitted, covariance.as_ref()).0, parameters })
    }
}

#[cfg(test)]
mod tests {
    use ship::effects::NonlinearDamping;
    use ship::{Particulars, Response};
    use trial::{Scales, Scaling, Trial};

    use super::super::{Settings, trace};
    use super::*;
    use crate::made_up::{BASE, Plan, record, ship};

    const MODEL: Particulars = Particulars { length: 4.0, speed: 1.6 };
    const SHIP: Particulars = Particulars { length: 100.0, speed: 8.0 };

    fn damped(n3: f64) -> Response {
        ship(vec![(std::sync::Arc::new(NonlinearDamping::Cubic), vec![n3])])
    }

    /// Two records of the ship, and two of a model of it with other damping, at the scale of the model.
    fn both(model_n3: f64) -> Vec<Trial> {
        let plan = |rudder_deg, seed| Plan { rudder_deg, seed, ..Plan::default() };
        let large = [plan(10.0, 1), plan(20.0, 2)].map(|plan| record(&damped(80.0), plan).with_particulars(SHIP));
        let small = [plan(10.0, 3), plan(20.0, 4)].map(|plan| {
            let full = record(&damped(model_n3), plan).with_particulars(SHIP);
            full.scaled_to(MODEL).expect("declared")
        });
        large.into_iter().chain(small).collect()
    }

    /// What every parameter of the joint model is judged to be, by its key.
    fn judged(trials: Vec<Trial>) -> Vec<(&'static str, Scaling)> {
        let scales = Scales::among(trials.iter()).expect("declared").expect("two");
        let trials = scales.bring_together(trials);
        let settings = Settings { thorough: false, ..Settings::default() };
        let analysis = trace(&trials, &[], &settings).expect("a base");
        let groups = scales.groups(trials.len());
        let own: Vec<Apart> = groups.iter().map(|(_, records)| analysis.apart(records).expect("a fit")).collect();
        let word = |fitted: &Fitted| {
            let found: Vec<Quantity> =
                own.iter().filter_map(|own| own.counterpart(fitted)).map(|own| own.quantity).collect();
            assert_eq!(found.len(), 2, "{}", fitted.parameter.key);
            (fitted.parameter.key, Scaling::of(&found).1)
        };
        analysis.parameters.iter().map(word).collect()
    }

    #[test]
    fn a_model_that_is_like_the_ship_has_its_terms() {
        let words = judged(both(80.0));
        assert!(words.iter().any(|(key, _)| *key == "n3_over_T"), "{words:?}");
        let others = words.iter().filter(|(key, _)| *key != "rudder_bias");
        assert!(others.clone().all(|(_, word)| *word == Scaling::Scales), "{words:?}");
    }

    #[test]
    fn the_one_term_that_differs_is_named() {
        let words = judged(both(140.0));
        let differing: Vec<_> = words.iter().filter(|(_, word)| *word == Scaling::DoesNotScale).collect();
        assert_eq!(differing, [&("n3_over_T", Scaling::DoesNotScale)], "{words:?}");
    }

    /// The same ship found at the scale of its model has the prime values of the ship.
    #[test]
    fn prime_values_do_not_depend_on_the_scale() {
        let settings = Settings { thorough: false, ..Settings::default() };
        let large = record(&damped(80.0), Plan::default()).with_particulars(SHIP);
        let prime = |trial: Trial| {
            let own = trial.particulars().expect("declared");
            let analysis = trace(&[trial], &[], &settings).expect("a base");
            let all = analysis.parameters.iter();
            all.map(|fitted| (fitted.parameter.key, fitted.prime(own).value)).collect::<Vec<_>>()
        };
        let small = prime(large.scaled_to(MODEL).expect("declared"));
        let large = prime(large);
        assert!((large[0].1 - BASE[0] * 12.5).abs() < 0.05 * BASE[0] * 12.5, "{large:?}");
        for (one, other) in small.iter().zip(&large) {
            assert!(one.0 == other.0 && (one.1 / other.1 - 1.0).abs() < 1e-2, "{small:?} and {large:?}");
        }
    }

    #[test]
    fn records_that_are_not_there_have_no_model() {
        let settings = Settings { thorough: false, ..Settings::default() };
        let analysis = trace(&[record(&damped(80.0), Plan::default())], &[], &settings).expect("a base");
        assert!(analysis.apart(&[]).is_none() && analysis.apart(&[1]).is_none());
        let own = analysis.apart(&[0]).expect("a fit");
        for (one, other) in own.parameters.iter().zip(&analysis.parameters) {
            assert!((one.quantity.value / other.quantity.value - 1.0).abs() < 1e-3, "{one:?} and {other:?}");
        }
    }
}
