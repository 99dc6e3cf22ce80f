//! What the fitted records themselves say of a model: it has no larger heading error than the base.

use ship::angle::to_deg;

use super::result::OnRecord;
use super::settings::TraceError;
use crate::search::{Model, Search};

/// Root mean square heading error over all records, rad.
fn heading_error(records: &[OnRecord]) -> f64 {
    let square: f64 = records.iter().map(|on| on.errors.heading.powi(2) * on.errors.rows as f64).sum();
    let rows: usize = records.iter().map(|on| on.errors.rows).sum();
    (square / rows as f64).sqrt()
}

/// A model with its replays of the fitted records, without terms that make the heading error there larger than `before`.
///
/// The likelihood that chose a term is that of averaged rows under coloured noise, and the search for its parameters is local:
/// nothing else makes sure that the error of a replay of all rows falls. The term without which it is smallest goes first.
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
        let after = if model.structure.terms.is_empty() { Ok(before.to_vec()) } else { replay(model) };
        let error = after.as_ref().map_or(f64::INFINITY, |after| heading_error(after));
        (error, after.unwrap_or_default())
    };
    let (mut error, mut after) = judged(&model);
    while !(error <= limit) {
        let without = |place| {
            let less = search.dropped(&model, place, true);
            (place, judged(&less), less)
        };
        let all = (0..model.structure.terms.len()).map(without);
        let Some((place, (smaller, replays), less)) = all.min_by(|one, other| one.1.0.total_cmp(&other.1.0)) else {
            break;
        };
        let effect = &model.structure.terms[place].effect;
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
