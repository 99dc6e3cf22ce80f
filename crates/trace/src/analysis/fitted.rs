//! What the fitted records themselves say of a model: it has no larger heading error than the base.

use ship::angle::to_deg;

use super::result::OnRecord;
use super::settings::TraceError;
use crate::search::{Model, Search};

/// Root mean square heading error over all records, rad.
pub(super) fn heading_error(records: &[OnRecord]) -> f64 {
    let square: f64 = records.iter().map(|on| on.errors.heading.powi(2) * on.errors.rows as f64).sum();
    let rows: usize = records.iter().map(|on| on.errors.rows).sum();
    (square / rows as f64).sqrt()
}

/// A model with its replays of the fitted records, without terms that make the heading error there larger than
/// `before`.
///
/// The likelihood that chose a term is that of averaged rows under coloured noise, and the search for its parameters is
/// local: nothing else makes sure that the error of a replay of all rows falls. The term without which it is smallest
/// goes first.
pub(super) fn no_larger_error(
    search: &Search,
    mut model: Model,
    before: &[OnRecord],
    replay: impl Fn(&Model) -> Result<Vec<OnRecord>, TraceError>,
    refused: &mut Vec<String>,
) -> (Model, Vec<OnRecord>) {
    let limit = heading_error(before);
    // A replay that is not finite has no error: none is larger.
    let judged = |model: &Model| {
        let after = if model.structure.is_constant() { Ok(before.to_vec()) } else { replay(model) };
        let error = after.as_ref().map_or(f64::INFINITY, |after| heading_error(after));
        (error, after.unwrap_or_default())
    };
    let (mut error, mut after) = judged(&model);
    while error.is_nan() || error > limit {
        let without = |place| {
            let less = search.dropped(&model, place, true);
            (place, judged(&less), less)
        };
        let found = model.structure.places().filter(|&place| !search.wanted.keeps(model.structure.term(place)));
        let all = found.map(without);
        let Some((place, (smaller, replays), less)) = all.min_by(|one, other| one.1.0.total_cmp(&other.1.0)) else {
            break;
        };
        let effect = &model.structure.term(place).effect;
        let with = if error.is_finite() {
            format!("the heading error on the fitted records is {:.3} deg", to_deg(error))
        } else {
            String::from("the replay of a fitted record is not finite")
        };
        let (id, form) = (effect.id(), effect.form());
        refused.push(format!("{id} ({form}) is not kept: with it {with}, of the base alone {:.3} deg", to_deg(limit)));
        (model, error, after) = (less, smaller, replays);
    }
    (model, after)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use ship::effects::NonlinearDamping;

    use super::*;
    use crate::candidates::{self, Sizes};
    use crate::fit::Problem;
    use crate::made_up::{BASE, Plan, record, ship};
    use crate::record::Record;
    use crate::replay_errors::Errors;
    use crate::search::Thresholds;
    use crate::structure::Structure;
    use identify::replay::Replay;

    fn replayed(heading: f64) -> Vec<OnRecord> {
        let replay = Replay { time: Vec::new(), heading: Vec::new(), yaw_rate: Vec::new(), residual: Vec::new() };
        let errors = Errors { heading, rows: 100, yaw_rate: None, overshoot: None, horizon: [None; 2] };
        vec![OnRecord { replay, errors, band: None }]
    }

    /// Whatever a replay says, the heading error after is not larger than before; the term that is at fault goes and is
    /// named.
    #[test]
    fn a_term_that_makes_the_error_larger_is_not_adopted() {
        let truth = ship(vec![(Arc::new(NonlinearDamping::Cubic), vec![80.0])]);
        let problem = Problem::new(vec![Record::whole(&record(&truth, Plan::default()))], BASE[0], BASE[1]);
        let headings = problem.replay(&Structure::base(1, false), &BASE, &[[0.0; 2]]);
        let candidates = candidates::all(&problem.records, &Sizes::of(&problem.records, BASE[0], &headings));
        let thresholds = Thresholds::default();
        let search = Search::new(&problem, &candidates, thresholds);
        let base = search.base(Structure::base(1, false), &BASE, &[[0.0; 2]]);
        let damped = search.run(&base, &search.try_all(&base, &base.plain, false));
        let place = candidates.iter().position(|one| one.term.effect.id() == "moment_drift").expect("listed");
        let mut both = damped.clone();
        both.structure = both.structure.with(candidates[place].term.clone());
        both.plain.theta.push(0.0);

        let before = replayed(0.003);
        let has_drift = |model: &Model| model.structure.terms.iter().any(|term| term.effect.id() == "moment_drift");
        let adopted = |model: &Model, error: fn(bool) -> Option<f64>| {
            let mut refused = Vec::new();
            let replay = |model: &Model| {
                let failed = || TraceError::Replay { trial: String::from("made up") };
                error(has_drift(model)).map(replayed).ok_or_else(failed)
            };
            let (model, after) = no_larger_error(&search, model.clone(), &before, replay, &mut refused);
            (model.structure.terms.len(), after[0].errors.heading, refused)
        };
        assert_eq!(adopted(&damped, |_| Some(0.001)), (1, 0.001, Vec::new()));
        let (terms, error, refused) = adopted(&both, |drift| Some(if drift { 0.0626 } else { 0.001 }));
        assert_eq!((terms, error), (1, 0.001));
        assert_eq!(
            refused,
            [
                "moment_drift (linear trend) is not kept: with it the heading error on the fitted records is 3.587 deg, of the \
              base alone 0.172 deg"
            ]
        );
        let (terms, error, refused) = adopted(&both, |_| Some(0.0626));
        assert_eq!((terms, error, refused.len()), (0, 0.003, 2));
        let (terms, error, refused) = adopted(&damped, |_| None);
        assert_eq!((terms, error), (0, 0.003));
        assert!(refused[0].contains("not finite"), "{refused:?}");
    }
}
