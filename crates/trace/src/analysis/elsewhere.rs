//! What records that were not fitted say of a term: it is dropped when it predicts them worse, and believed when it
//! predicts them much better.

use crate::held_out::{self, Comparison, HeldOut};
use crate::index::TermPlace;
use crate::search::{Evidence, Model, Search};
use crate::structure::Term;

/// Drops terms that make the error worse where they were not fitted.
pub(super) fn believed_elsewhere(
    search: &Search,
    mut model: Model,
    held_out: &[HeldOut],
    refused: &mut Vec<String>,
) -> Model {
    let mut rest = model.structure.terms.len();
    while rest > 0 {
        rest -= 1;
        let place = TermPlace(rest);
        let term = model.structure.term(place);
        if term.effect.is_of_time() || search.wanted.keeps(term) {
            continue;
        }
        let less = search.dropped(&model, place, true);
        let worse = if held_out.is_empty() {
            let random = model.judged.colour.wander.is_some();
            let of = |model: &Model| if random { model.judged.clone() } else { model.plain.clone() };
            let (one, other) = (of(&less), of(&model));
            held_out::is_worse_on_parts(search.problem, (&less.structure, &one), (&model.structure, &other))
                .then(|| String::from("the part of the record that was kept from the fit is predicted worse"))
        } else {
            worse_on_others(held_out, &less, &model)
        };
        if let Some(reason) = worse {
            refused.push(format!("{} ({}) is not kept: {reason}", term.effect.id(), term.effect.form()));
            model = less;
            // What is left may behave differently without it.
            rest = model.structure.terms.len();
        }
    }
    model
}

/// Why a model is no better than a simpler one on records that neither was fitted to.
pub(super) fn worse_on_others(held_out: &[HeldOut], less: &Model, more: &Model) -> Option<String> {
    if held_out.is_empty() {
        return None;
    }
    let errors = |model: &Model| held_out::errors(held_out, &model.structure, &model.plain);
    // A model whose replay is not finite is worse than any other.
    let Some(after) = errors(more) else { return Some(String::from("its replay of a held-out record is not finite")) };
    let comparison = Comparison::of(&errors(less)?, &after)?;
    comparison.is_worse().then(|| {
        format!(
            "on the held-out records it multiplies the error of the full replay by {:.2} and that of full and restarted \
             replays together by {:.2}",
            comparison.full, comparison.mean
        )
    })
}

/// A term that is believed because it predicts records it was not fitted to.
pub(super) struct Predicted {
    pub term: Term,
    pub evidence: Evidence,
    pub comparison: Comparison,
}

/// Adds terms whose evidence does not stand against a random moment, but which predict the held-out records: chance
/// does not.
pub(super) fn predicted_elsewhere(search: &Search, model: &mut Model, held_out: &[HeldOut]) -> Vec<Predicted> {
    let mut predicted = Vec::new();
    if held_out.is_empty() || model.judged.colour.wander.is_none() || !search.wanted.search {
        return predicted;
    }
    while model.structure.terms.len() < search.thresholds.most_effects {
        let Some(before) = held_out::errors(held_out, &model.structure, &model.plain) else { break };
        let tried = search.try_all(model, &model.plain, true);
        let next = tried.into_iter().take(LOOKED_AT).find_map(|tried| {
            let term = search.candidate(tried.candidate).term.clone();
            if term.effect.is_of_time() || !search.believes(&term, &tried.evidence) {
                return None;
            }
            let after = held_out::errors(held_out, &tried.structure, &tried.fit)?;
            let comparison = Comparison::of(&before, &after)?;
            comparison.is_much_better().then_some((tried, term, comparison))
        });
        let Some((tried, term, comparison)) = next else { break };
        *model = search.adopted(&tried);
        predicted.push(Predicted { term, evidence: tried.evidence, comparison });
        if model.judged.colour.wander.is_none() {
            break;
        }
    }
    predicted
}

/// Candidates, best first, whose prediction is looked at.
const LOOKED_AT: usize = 4;
