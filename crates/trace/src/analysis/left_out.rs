//! Every one of several records as if it had been held out: base and structure are fitted to the others, and the one
//! left out is replayed.

use identify::Identifier;
use rayon::prelude::*;
use trial::Trial;

use super::replays::{judged, starts};
use super::result::Judged;
use super::side::Side;
use crate::band::Elsewhere;
use crate::fit::Problem;
use crate::held_out::HeldOut;
use crate::index::RecordNumber;
use crate::structure::Structure;

/// Errors before and after on every record that the fit of a fold has not seen. The structure was found on all records
/// and is kept, as is the noise; its parameters are those of the fold. `None` where a fold has no base, or no finite
/// replay.
pub(super) fn leave_one_out(
    trials: &[Trial],
    method: &dyn Identifier,
    problem: &Problem,
    sides: &[Side; 2],
) -> Vec<Option<Judged>> {
    let fold = |left: usize| {
        let first = method.identify(&without(trials, left)).ok()?.response;
        let others = problem.on(without(&problem.records, left));
        let fitted = sides.each_ref().map(|side| {
            let (structure, theta) = on_others(&side.structure, &side.fit.theta, RecordNumber(left));
            let fit = others.fit(&structure, &theta, &without(&side.fit.initial, left), &side.fit.colour);
            (structure, fit)
        });
        let known = [0, 1].map(|k| Elsewhere::new(&others, &fitted[k].0, &fitted[k].1, sides[k].noise));
        let held = HeldOut::new(&trials[left], starts(&trials[left], &first));
        judged(&held, &first, &known, &sides[1].structure).ok()
    };
    (0..trials.len()).into_par_iter().map(fold).collect()
}

fn without<T: Clone>(all: &[T], left: usize) -> Vec<T> {
    all[..left].iter().chain(&all[left + 1..]).cloned().collect()
}

/// A structure with its parameters on all records but one, without what belongs to that one alone.
pub(super) fn on_others(structure: &Structure, theta: &[f64], left: RecordNumber) -> (Structure, Vec<f64>) {
    let (mut kept, mut values) = (structure.clone(), theta.to_vec());
    for place in structure.places().rev().filter(|&place| structure.term(place).only == Some(left)) {
        values = kept.drop_from(&values, place);
        kept = kept.without(place);
    }
    if kept.own_bias {
        values.remove(2 + left.0);
    }
    kept.records -= 1;
    for term in &mut kept.terms {
        term.only = term.only.map(|RecordNumber(own)| RecordNumber(if own > left.0 { own - 1 } else { own }));
    }
    (kept, values)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use ship::effects::{Effect, MomentDrift, NonlinearDamping};

    use super::super::{Analysis, Settings, trace};
    use super::*;
    use crate::made_up::{Plan, record, ship};

    fn records(drift: f64) -> Vec<Trial> {
        let plans = [10.0, 15.0, 20.0].map(|rudder_deg| Plan { rudder_deg, ..Plan::default() });
        let made = plans.iter().enumerate().map(|(number, plan)| {
            let damping: Arc<dyn Effect> = Arc::new(NonlinearDamping::Cubic);
            let own: Arc<dyn Effect> = Arc::new(MomentDrift { reference_time: 0.0 });
            let slope = if number == 1 { drift } else { 0.0 };
            record(&ship(vec![(damping, vec![80.0]), (own, vec![slope])]), *plan)
        });
        made.collect()
    }

    fn heading_deg(judged: &Judged) -> [f64; 2] {
        [&judged.before, &judged.after].map(|on| on.errors.heading.to_degrees())
    }

    fn left_out(analysis: &Analysis) -> Vec<&Judged> {
        analysis.left_out.iter().flatten().collect()
    }

    /// A run that was left out is predicted by the structure to its noise, and by the base as badly as the base does.
    #[test]
    fn a_run_left_out_is_predicted_by_the_others() {
        let trials = records(0.0);
        let analysis = trace(&trials, &[], &Settings::default()).expect("a base");
        let folds = left_out(&analysis);
        assert_eq!(folds.len(), 3);
        for fold in folds {
            let [before, after] = heading_deg(fold);
            assert!(before > 0.3 && after < 0.06, "{before} and {after} deg");
        }
        assert!(trace(&trials[..1], &[], &Settings::default()).expect("a base").left_out.is_empty());
        let validated = trace(&trials[..2], &trials[2..], &Settings::default()).expect("a base");
        assert!(validated.left_out.is_empty());
    }

    /// The drift of the run that is left out is no part of what the others tell, and is estimated there anew.
    #[test]
    fn what_belongs_to_the_run_left_out_goes_with_it() {
        let analysis = trace(&records(7e-5), &[], &Settings::default()).expect("a base");
        assert!(analysis.effects.iter().any(|effect| effect.id == "moment_drift"));
        let folds = left_out(&analysis);
        let own = folds[1].own_moment.as_ref().expect("the structure has a drift").errors.heading.to_degrees();
        assert!(heading_deg(folds[1])[1] > 0.5 && own < 0.06, "{:?} and {own} deg", heading_deg(folds[1]));
        assert!(heading_deg(folds[0])[1] < 0.06);
    }
}
