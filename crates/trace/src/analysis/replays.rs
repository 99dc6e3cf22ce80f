//! Replays and errors of the models before and after, on records that were fitted and on those that were not.

use identify::replay::replay;
use ship::{FirstOrder, Response};
use trial::Trial;

use super::result::{Judged, OnRecord};
use super::settings::TraceError;
use crate::fit::Fit;
use crate::held_out::{self, HeldOut};
use crate::index::RecordNumber;
use crate::own_moment;
use crate::record::Record;
use crate::replay_errors;
use crate::structure::Structure;

/// Initial state of a base replay of all rows.
pub(super) fn initial(trial: &Trial, response: &FirstOrder) -> Result<[f64; 2], TraceError> {
    let replay = replay(trial, response).ok_or_else(|| TraceError::Replay { trial: trial.name().to_owned() })?;
    Ok(replay.initial())
}

/// Initial states from which the best is looked for on a record that was not fitted.
pub(super) fn starts(trial: &Trial, response: &FirstOrder) -> Vec<[f64; 2]> {
    let first = trial.observed_rows().next().unwrap_or(0);
    let heading = trial.heading()[first];
    let mut starts = vec![[heading, 0.0]];
    starts.extend(initial(trial, response));
    starts.extend(trial.yaw_rate().map(|rate| rate[first]).filter(|r| r.is_finite()).map(|rate| [heading, rate]));
    starts
}

/// The first-order response of fitted parameters: their base, with the mean of several rudder biases.
pub(super) fn first_order(theta: &[f64], structure: &Structure) -> FirstOrder {
    let biases = &theta[2..structure.base_count()];
    let rudder_bias = biases.iter().sum::<f64>() / biases.len() as f64;
    FirstOrder { inverse_T: theta[0], K_over_T: theta[1], rudder_bias }
}

/// A fitted structure on the records it was fitted to, all rows; `first` where it is a first-order response with one
/// rudder bias.
pub(super) fn on_records(
    trials: &[Trial],
    (structure, fit): (&Structure, &Fit),
    base: &FirstOrder,
    first: Option<&FirstOrder>,
    thorough: bool,
) -> Result<Vec<OnRecord>, TraceError> {
    trials
        .iter()
        .enumerate()
        .map(|(number, trial)| {
            let record = Record::whole(trial);
            let response = match first {
                Some(first) => Response::first_order_ship(*first),
                None => structure.response(RecordNumber(number), &fit.theta),
            };
            let mut all = starts(trial, base);
            all.push(fit.initial[number]);
            on_record(trial, &record, &response, &all, first, thorough)
                .ok_or_else(|| TraceError::Replay { trial: trial.name().to_owned() })
        })
        .collect()
}

/// Replays a response; a first-order one in closed form, which neither sign of T disturbs.
fn on_record(
    trial: &Trial,
    record: &Record,
    response: &Response,
    starts: &[[f64; 2]],
    first: Option<&FirstOrder>,
    thorough: bool,
) -> Option<OnRecord> {
    let replay = match first {
        Some(first) => replay(trial, first)?,
        None => replay_errors::full(response, record, starts)?,
    };
    let errors = if thorough {
        replay_errors::errors(trial, record, response, &replay)
    } else {
        replay_errors::in_brief(&replay)
    };
    Some(OnRecord { replay, errors })
}

/// A base and a fitted structure on records that were held out.
pub(super) fn validate(
    held_out: &[HeldOut],
    first: &FirstOrder,
    (structure, fit): (&Structure, &Fit),
) -> Result<Vec<Judged>, TraceError> {
    held_out.iter().map(|held| judged(held, first, (structure, &fit.theta), structure)).collect()
}

/// A base and a structure with its parameters on a record that neither was fitted to; `forms` has the moments of time
/// that such a record may have of its own.
pub(super) fn judged(
    held: &HeldOut,
    first: &FirstOrder,
    (structure, theta): (&Structure, &[f64]),
    forms: &Structure,
) -> Result<Judged, TraceError> {
    let refuse = || TraceError::Replay { trial: held.trial.name().to_owned() };
    let base = Response::first_order_ship(*first);
    let before = on_record(held.trial, &held.record, &base, &held.starts, Some(first), true).ok_or_else(refuse)?;
    let after = if structure.terms.is_empty() {
        before.clone()
    } else {
        let mut all = held.starts.clone();
        all.push(before.replay.initial());
        let response = held_out::portable(structure, theta);
        on_record(held.trial, &held.record, &response, &all, None, true).ok_or_else(refuse)?
    };
    let own = own_moment::response(held, (structure, theta), forms);
    let own = own.and_then(|(response, near)| held.judge(&response, Some(near)));
    let own_moment = own.map(|(replay, errors)| OnRecord { replay, errors });
    Ok(Judged { name: held.trial.name().to_owned(), before, after, own_moment })
}
