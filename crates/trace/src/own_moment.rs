//! A moment that depends on time alone belongs to the weather of one record. On a record that was not fitted it is
//! estimated again, with the initial state and nothing else: the ship stays what it was.

use crate::candidates::{Candidate, Sizes};
use crate::fit::{Fit, Linearised, Problem};
use crate::held_out::{self, HeldOut};
use crate::noise::Colour;
use crate::structure::{Structure, Term};
use crate::transient;

/// What is portable of a structure on a held-out record, the ship being known, with a moment of the record's own fitted
/// as its last term: of the moments among the terms `of` a structure, the one of lowest BIC. `None` when there are
/// none, or when no fit is finite.
pub fn fitted(held: &HeldOut, (structure, theta): (&Structure, &[f64]), of: &Structure) -> Option<(Structure, Fit)> {
    let mut forms: Vec<&Term> = Vec::new();
    for term in of.terms.iter().filter(|term| term.effect.is_of_time()) {
        if forms.iter().all(|form| form.effect.form() != term.effect.form()) {
            forms.push(term);
        }
    }
    forms.first()?;
    let (mut ship, values) = held_out::portable_structure(structure, theta);
    ship.ship_known = true;
    let problem = Problem::new(vec![held.averaged(values[0])], values[0], values[1]);
    let from = |initial: &[f64; 2]| problem.fit(&ship, &values, &[*initial], &Colour::WHITE);
    let plain = best(held.starts.iter().map(from))?;
    let sizes = Sizes::of(&problem.records, values[0], &problem.replay(&ship, &values, &plain.initial));
    let about = sizes.manoeuvres(&problem.records, &problem.records[0]);
    let known = Linearised::new(&problem, &ship, &plain);
    let with_form = |form: &Term| -> Option<(Structure, Fit)> {
        let Candidate { term, starts, .. } = Candidate::new(form.effect.proposal(&about)?, None);
        let looked_for = if starts.is_empty() { transient::starts(&problem, &plain, &known, &term) } else { starts };
        let with = ship.with(term);
        let fit = |start: &Vec<f64>| {
            let theta = [plain.theta.as_slice(), start].concat();
            problem.fit(&with, &theta, &plain.initial, &Colour::WHITE)
        };
        let fit = best(looked_for.iter().map(fit))?;
        Some((with, fit))
    };
    forms.into_iter().filter_map(with_form).min_by(|one, other| one.1.bic.total_cmp(&other.1.bic))
}

/// The fit of lowest deviance, if it is finite.
fn best(fits: impl Iterator<Item = Fit>) -> Option<Fit> {
    let finite = fits.filter(|fit| fit.deviance.is_finite());
    finite.min_by(|one, other| one.deviance.total_cmp(&other.deviance))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use ship::effects::{Effect, MomentDrift, TransientDisturbance};

    use super::*;
    use crate::index::RecordNumber;
    use crate::made_up::{BASE, Plan, record, ship};
    use crate::record::Record;

    /// Fitted on a record with one drift and replayed on a record with another: the drift of the second is found, and
    /// the ship is not touched.
    #[test]
    fn a_held_out_record_has_a_moment_of_its_own() {
        let moments: [(Arc<dyn Effect>, Vec<f64>, f64); 2] = [
            (Arc::new(MomentDrift { reference_time: 0.0 }), vec![-7e-5], 3e-5),
            (Arc::new(TransientDisturbance::Passing), vec![0.04, 150.0, 30.0], -0.03),
        ];
        for (effect, values, first) in moments {
            let trial = record(&ship(vec![(Arc::clone(&effect), values)]), Plan::default());
            let held = HeldOut::new(&trial, vec![[0.0; 2]]);
            let about = Sizes { time: 16.3, rate: 0.01, rudder: 0.17, duration: 300.0, spacing: 1.0 };
            let records = [Record::whole(&trial)];
            let proposal = effect.proposal(&about.manoeuvres(&records, &records[0])).expect("it needs no channel");
            let mut theta = BASE.to_vec();
            theta.extend(proposal.large.iter().map(|large| large * first));
            let structure = Structure::base(1, false).with(Candidate::new(proposal, None).term);
            let plain = held.judge(&held_out::portable(&structure, &theta), None).expect("finite").1.heading;
            let (with, fit) = fitted(&held, (&structure, &theta), &structure).expect("it has a moment of time");
            let own = with.response(RecordNumber(0), &fit.theta);
            let with = held.judge(&own, Some(fit.initial[0])).expect("finite").1.heading;
            assert!(with < 0.1 * plain && with.to_degrees() < 0.06, "{}: {plain}, {with}", effect.id());
            assert_eq!(own.parameters()[..3], BASE);
            let base = Structure::base(1, false);
            assert!(fitted(&held, (&base, &BASE), &base).is_none());
        }
    }
}
