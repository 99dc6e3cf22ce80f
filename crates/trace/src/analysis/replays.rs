//! Replays and errors of the models before and after, on records that were fitted and on those that were not.

use identify::replay::replay;
use ship::{FirstOrder, Response};
use trial::Trial;

use super::result::{Analysis, Judged, OnRecord};
use super::settings::TraceError;
use super::side::Side;
use crate::band::{self, Elsewhere, Noise};
use crate::fit::{Fit, Problem};
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
    Some(OnRecord { replay, errors, band: None })
}

/// Gives replays of the records that a model was fitted to their bands, under the noise that it was judged by.
pub(super) fn add_bands(problem: &Problem, side: &Side, on_records: &mut [OnRecord]) {
    let spreads = band::of_fitted(problem, &side.structure, &side.fit, &side.noise);
    for (on, spread) in on_records.iter_mut().zip(spreads.into_iter().flatten()) {
        on.band = spread.band(&on.replay.time);
    }
}

/// Models before and after on records that were held out.
pub(super) fn validate(held_out: &[HeldOut], problem: &Problem, sides: &[Side; 2]) -> Result<Vec<Judged>, TraceError> {
    let first = sides[0].first_order();
    let known = sides.each_ref().map(|side| Elsewhere::new(problem, &side.structure, &side.fit, side.noise));
    held_out.iter().map(|held| judged(held, &first, &known, &sides[1].structure)).collect()
}

/// A base and a structure with its parameters on a record that neither was fitted to; `forms` has the moments of time
/// that such a record may have of its own.
pub(super) fn judged(
    held: &HeldOut,
    first: &FirstOrder,
    known: &[Elsewhere; 2],
    forms: &Structure,
) -> Result<Judged, TraceError> {
    let Elsewhere { structure, theta, .. } = known[1];
    let refuse = || TraceError::Replay { trial: held.trial.name().to_owned() };
    let base = Response::first_order_ship(*first);
    let before = on_record(held.trial, &held.record, &base, &held.starts, Some(first), true).ok_or_else(refuse)?;
    let banded = |known: &Elsewhere, on: OnRecord| {
        let band = known.band(held.averaged(known.theta[0]), on.replay.initial(), &on.replay.time);
        OnRecord { band, ..on }
    };
    let before = banded(&known[0], before);
    let after = if structure.is_constant() {
        before.clone()
    } else {
        let mut all = held.starts.clone();
        all.push(before.replay.initial());
        let response = held_out::portable(structure, theta);
        banded(&known[1], on_record(held.trial, &held.record, &response, &all, None, true).ok_or_else(refuse)?)
    };
    let with_own = |(structure, fit): (Structure, Fit)| -> Option<OnRecord> {
        let response = structure.response(RecordNumber(0), &fit.theta);
        let (replay, errors) = held.judge(&response, Some(fit.initial[0]))?;
        let spread = known[1].spread_with_own(held.averaged(theta[0]), &structure, &fit);
        let band = spread.and_then(|spread| spread.band(&replay.time));
        Some(OnRecord { replay, errors, band })
    };
    let own_moment = own_moment::fitted(held, (structure, theta), forms).and_then(with_own);
    Ok(Judged { name: held.trial.name().to_owned(), before, after, own_moment })
}

impl Analysis {
    /// The final model on a further trial, in a calm and perfectly recorded, from the best initial state near `start`:
    /// its band is that of the errors of the parameters alone. `None` when the replay is not finite.
    pub fn in_a_calm(&self, trial: &Trial, start: [f64; 2]) -> Option<OnRecord> {
        let replay = replay_errors::full(&self.ship(), &Record::whole(trial), &[start])?;
        let (errors, initial) = (replay_errors::in_brief(&replay), replay.initial());
        let Side { structure, fit, noise } = &self.told;
        let known = Elsewhere { noise: Noise::NONE, ..Elsewhere::new(&self.problem, structure, fit, *noise) };
        let band = known.band(Record::averaged(trial, fit.theta[0].abs().recip()), initial, &replay.time);
        Some(OnRecord { replay, errors, band })
    }
}
