//! Columns of a file of rows: names, units, meanings, and access to the row fields.

use std::borrow::Cow;

use ::trace::TraceVerdict;
use document::trace::Dependence;
use identify::StopReason;
use serde::Deserialize;
use serde::de::value::{Error as UnknownWord, StrDeserializer};

use super::row::{EffectParameterValue, LocatedMoment, NamedEffect, PredictedCharacteristic, StudyRow, TraceRow};

/// Fixed column of a file of rows.
pub struct RowColumn {
    /// Name in the file, ending in the unit.
    pub name: &'static str,
    /// Meaning, for documentation.
    pub meaning: &'static str,
    pub(super) access: Access,
}

/// Getter and setter of a column.
#[derive(Clone, Copy)]
pub(super) enum Access {
    Count(fn(&StudyRow) -> u64, fn(&mut StudyRow, u64)),
    Number(fn(&StudyRow) -> Option<f64>, fn(&mut StudyRow, f64)),
    Text(fn(&StudyRow) -> Option<Cow<'_, str>>, fn(&mut StudyRow, &str) -> Result<(), String>),
    Method,
}

/// Columns with their access to a row: a count, a number, one number of an array, a number of a trace, functions of a
/// text, or the method.
macro_rules! columns {
    ($($name:literal, $meaning:literal => $kind:ident $field:tt;)*) => {
        [$(RowColumn { name: $name, meaning: $meaning, access: access!($kind $field) }),*]
    };
}

macro_rules! access {
    (count($field:ident)) => {
        Access::Count(|row| row.$field, |row, value| row.$field = value)
    };
    (number($field:ident)) => {
        Access::Number(|row| row.$field, |row, value| row.$field = Some(value))
    };
    (number($field:ident, $place:literal)) => {
        Access::Number(
            |row| row.$field.map(|numbers| numbers[$place]),
            |row, value| row.$field.get_or_insert([f64::NAN; _])[$place] = value,
        )
    };
    (traced($field:ident)) => {
        Access::Number(|row| row.traced.as_ref()?.$field, |row, value| answer(row).$field = Some(value))
    };
    (text($get:ident, $set:ident)) => {
        Access::Text($get, $set)
    };
    (method()) => {
        Access::Method
    };
}

/// Columns of every file of rows, in order. They are followed by the further columns that apply to the study, one
/// column `axis.NAME` per axis of the design, a number or the label of the point, and one `draw.KEY` per sampled value,
/// in the unit of the key. For measured records the last columns are `fitted` and `judge`, the names of records.
pub const COMMON_COLUMNS: [RowColumn; 22] = columns! {
    "cell", "index of the cell in the design, from 0" => count(cell);
    "replicate", "index of the trial in its cell, from 0; every method sees the same trial" => count(replicate);
    "method", "label of the method" => method();
    "failure", "why the method gave no answer; null when it did" => text(failure, set_failure);
    "true_K_per_s",
    "K of the first-order response nearest to the ship; null where there is none"
        => number(true_k_per_s);
    "true_T_s", "T of that response" => number(true_t_s);
    "bound_K_per_s", "Cramér–Rao bound on the standard deviation of K on this trial" => number(cramer_rao_sd, 0);
    "bound_T_s", "the same of T" => number(cramer_rao_sd, 1);
    "bound_K_over_T_per_s2", "the same of K/T" => number(cramer_rao_sd, 2);
    "K_per_s", "estimate of K" => number(k_per_s);
    "K_lower95_per_s", "lower end of its 95 % interval; null where the method quotes none" => number(k_ci95_per_s, 0);
    "K_upper95_per_s", "upper end" => number(k_ci95_per_s, 1);
    "T_s", "estimate of T; negative for a course-unstable ship" => number(t_s);
    "T_lower95_s", "lower end of its 95 % interval" => number(t_ci95_s, 0);
    "T_upper95_s", "upper end" => number(t_ci95_s, 1);
    "delta_r_deg", "estimate of the rudder bias" => number(rudder_bias_deg);
    "delta_r_lower95_deg", "lower end of its 95 % interval" => number(rudder_bias_ci95_deg, 0);
    "delta_r_upper95_deg", "upper end" => number(rudder_bias_ci95_deg, 1);
    "heading_rmse_deg", "rms error of the heading on the trial itself, its rudder replayed through the answer"
        => number(heading_rmse_deg);
    "validation_rmse_deg", "the same on the validation manoeuvre, which no method has seen"
        => number(validation_rmse_deg);
    "evaluations", "model evaluations of the method" => number(evaluations);
    "stop", "why the method stopped: direct, converged, iteration-limit, range-limit" => text(stop, set_stop);
};

/// Further columns of a study whose ships are a first-order base with effects.
pub const BASE_COLUMNS: [RowColumn; 2] = columns! {
    "own_K_per_s",
    "K of the ship's own base, with which a trace is compared; null where the ship is first order or a hull"
        => number(base_k_per_s);
    "own_T_s", "T of that base" => number(base_t_s);
};

/// Further columns of a study with a trace.
pub const TRACE_COLUMNS: [RowColumn; 8] = columns! {
    "trace_verdict", "clean, disturbed, traced, located or unexplained" => text(verdict, set_verdict);
    "trace_named", "effects named, joined by +; empty where none was" => text(named, set_named);
    "trace_groups", "the same, each with its aliases joined by |" => text(groups, set_groups);
    "trace_probabilities",
    "effects with a probability of at least 0.005, each followed by = and its probability, joined by +"
        => text(probabilities, set_probabilities);
    "trace_margin",
    "log evidence for the one missing effect less that for the best other one; null where not one is missing"
        => traced(evidence_margin);
    "trace_expected",
    "likelihood ratio of the truth against the nearest first-order response, on average over the noise"
        => traced(expected_2_ln_lambda);
    "trace_band_fitted",
    "share of the headings of the trial inside the 95 % band of the traced model; null where there is no band"
        => traced(fitted_band_coverage);
    "trace_band_held_out",
    "the same on the validation manoeuvre, which has no noise: the band is that of the parameters alone"
        => traced(validation_band_coverage);
};

/// Further columns of a study of measured records.
pub const RECORD_COLUMNS: [RowColumn; 2] = columns! {
    "validation_60_s_rmse_deg",
    "in a study of measured records: rms error of the heading on the held-out record, its replay restarted every 60 s"
        => number(validation_60_s_rmse_deg);
    "trace_sizes",
    "in a study of measured records: parameters of the effects named, joined by + and those of one effect by |: symbol, \
     with a prime where it is without dimension, =value, and ± with its standard deviation where it is fitted"
        => text(sizes, set_sizes);
};

/// Further columns of a study with a trace whose scenario states the missing physics.
pub const LOCATED_COLUMNS: [RowColumn; 2] = columns! {
    "trace_times", "when the effects named act, s, joined by +; – for one that is no matter of time"
        => text(times, set_times);
    "trace_located",
    "moments located, joined by +: what it depends on; the moment in words; since when; until when, s; effects of the \
     list that cannot be told from it, joined by |"
        => text(located, set_located);
};

/// Further columns of a study that predicts manoeuvres.
pub const PREDICT_COLUMNS: [RowColumn; 1] = columns! {
    "predicted",
    "figures of manoeuvres predicted from the answer, joined by +: name=truth|median|lower 90 %|upper 90 %; empty where \
     the answer has no covariance"
        => text(predicted, set_predicted);
};

fn failure(row: &StudyRow) -> Option<Cow<'_, str>> {
    row.failure.as_deref().map(Cow::Borrowed)
}

fn set_failure(row: &mut StudyRow, text: &str) -> Result<(), String> {
    row.failure = Some(text.into());
    Ok(())
}

fn stop(row: &StudyRow) -> Option<Cow<'_, str>> {
    row.stop_reason.map(Cow::Borrowed)
}

fn set_stop(row: &mut StudyRow, word: &str) -> Result<(), String> {
    let id = StopReason::ALL.iter().map(|reason| reason.as_str()).find(|id| *id == word);
    row.stop_reason = Some(id.ok_or_else(|| format!("no method stops because of {word:?}"))?);
    Ok(())
}

/// Trace result of a row, created with its first column.
fn answer(row: &mut StudyRow) -> &mut TraceRow {
    row.traced.get_or_insert_default()
}

/// Text of a list, entries joined by `+`.
fn joined<T>(all: &[T], write: impl Fn(&T) -> String) -> Cow<'static, str> {
    all.iter().map(write).collect::<Vec<_>>().join("+").into()
}

/// Entries of a text joined by `+`, each read by `read`. Fails with a message that names `entries` if one is invalid.
fn list<T>(text: &str, entries: &str, read: impl Fn(&str) -> Option<T>) -> Result<Vec<T>, String> {
    let parts = text.split('+').filter(|part| !part.is_empty());
    parts.map(read).collect::<Option<_>>().ok_or_else(|| format!("{text:?} does not list {entries}"))
}

/// Column of the named effects: identifiers joined by `+`.
fn named(row: &StudyRow) -> Option<Cow<'_, str>> {
    Some(joined(&row.traced.as_ref()?.named_effects, |effect| effect.id.to_string()))
}

fn set_named(row: &mut StudyRow, text: &str) -> Result<(), String> {
    answer(row).named_effects =
        list(text, "effects", |id| Some(NamedEffect { id: id.into(), ..NamedEffect::default() }))?;
    Ok(())
}

/// Column of the named effects with their aliases: `effect|alias`, joined by `+`.
fn groups(row: &StudyRow) -> Option<Cow<'_, str>> {
    let group = |effect: &NamedEffect| [std::slice::from_ref(&effect.id), effect.aliases.as_slice()].concat().join("|");
    Some(joined(&row.traced.as_ref()?.named_effects, group))
}

/// Sets the aliases of the effects that an earlier column has named.
fn set_groups(row: &mut StudyRow, text: &str) -> Result<(), String> {
    let group = |part: &str| {
        let mut ids = part.split('|').filter(|id| !id.is_empty()).map(Box::from);
        Some(NamedEffect { id: ids.next()?, aliases: ids.collect(), ..NamedEffect::default() })
    };
    let groups = list(text, "groups of effects", group)?;
    let named = &mut answer(row).named_effects;
    if !groups.iter().map(|group| &group.id).eq(named.iter().map(|effect| &effect.id)) {
        return Err(format!("the groups {text:?} are not those of the effects named"));
    }
    *named = groups;
    Ok(())
}

/// Column of the parameters of the named effects: `symbol=value±sd`, joined by `|` in an effect and by `+` between
/// them.
fn sizes(row: &StudyRow) -> Option<Cow<'_, str>> {
    let size = |EffectParameterValue { symbol, value, sd }: &EffectParameterValue| {
        format!("{symbol}={value}{}", sd.map_or_else(String::new, |sd| format!("±{sd}")))
    };
    let effect = |effect: &NamedEffect| effect.parameters.iter().map(size).collect::<Vec<_>>().join("|");
    Some(joined(&row.traced.as_ref()?.named_effects, effect))
}

/// Sets the parameters of the effects that an earlier column has named.
fn set_sizes(row: &mut StudyRow, text: &str) -> Result<(), String> {
    let size = |part: &str| {
        let (symbol, number) = part.split_once('=')?;
        let (value, sd) = number.split_once('±').map_or((number, None), |(value, sd)| (value, Some(sd)));
        let sd = sd.map(str::parse).transpose().ok()?;
        Some(EffectParameterValue { symbol: symbol.into(), value: value.parse().ok()?, sd })
    };
    let effect = |part: &str| part.split('|').filter(|size| !size.is_empty()).map(size).collect::<Option<Vec<_>>>();
    let fault = || format!("{text:?} does not list the parameters of the effects named");
    let named = &mut answer(row).named_effects;
    let parts: Vec<&str> = if named.is_empty() { Vec::new() } else { text.split('+').collect() };
    if parts.len() != named.len() {
        return Err(fault());
    }
    for (named, part) in named.iter_mut().zip(parts) {
        named.parameters = effect(part).ok_or_else(fault)?;
    }
    Ok(())
}

/// Text for a missing time.
const NEVER: &str = "–";

fn time(time_s: Option<f64>) -> String {
    time_s.map_or_else(|| NEVER.to_owned(), |time_s| time_s.to_string())
}

/// Time from a text, or the missing time; `None` for any other text.
fn read_time(text: &str) -> Option<Option<f64>> {
    if text == NEVER { Some(None) } else { text.parse().ok().map(Some) }
}

fn times(row: &StudyRow) -> Option<Cow<'_, str>> {
    Some(joined(&row.traced.as_ref()?.named_effects, |effect| time(effect.time_s)))
}

/// Sets the times of the effects that an earlier column has named.
fn set_times(row: &mut StudyRow, text: &str) -> Result<(), String> {
    let times = list(text, "times of effects", read_time)?;
    let named = &mut answer(row).named_effects;
    if named.len() != times.len() {
        return Err(format!("the times {text:?} are not those of the effects named"));
    }
    named.iter_mut().zip(times).for_each(|(effect, time_s)| effect.time_s = time_s);
    Ok(())
}

fn located(row: &StudyRow) -> Option<Cow<'_, str>> {
    let moment = |LocatedMoment { depends_on, form, from_s, until_s, alternatives }: &LocatedMoment| {
        format!("{depends_on};{form};{};{};{}", time(*from_s), time(*until_s), alternatives.join("|"))
    };
    Some(joined(&row.traced.as_ref()?.located_moments, moment))
}

fn set_located(row: &mut StudyRow, text: &str) -> Result<(), String> {
    let moment = |part: &str| {
        let [depends_on, form, from_s, until_s, ids] = part.split(';').collect::<Vec<_>>().try_into().ok()?;
        Some(LocatedMoment {
            depends_on: Dependence::deserialize(StrDeserializer::<UnknownWord>::new(depends_on)).ok()?,
            form: form.into(),
            from_s: read_time(from_s)?,
            until_s: read_time(until_s)?,
            alternatives: ids.split('|').filter(|id| !id.is_empty()).map(Box::from).collect(),
        })
    };
    answer(row).located_moments = list(text, "located moments", moment)?;
    Ok(())
}

fn probabilities(row: &StudyRow) -> Option<Cow<'_, str>> {
    Some(joined(&row.traced.as_ref()?.probabilities, |(id, probability)| format!("{id}={probability:.3}")))
}

fn set_probabilities(row: &mut StudyRow, text: &str) -> Result<(), String> {
    let read = |part: &str| {
        let (id, number) = part.split_once('=')?;
        Some((Box::from(id), number.parse().ok().filter(|p| (0.0..=1.0).contains(p))?))
    };
    answer(row).probabilities = list(text, "probabilities of effects", read)?;
    Ok(())
}

fn verdict(row: &StudyRow) -> Option<Cow<'_, str>> {
    Some(row.traced.as_ref()?.verdict.to_string().into())
}

fn set_verdict(row: &mut StudyRow, word: &str) -> Result<(), String> {
    let verdict = TraceVerdict::deserialize(StrDeserializer::<UnknownWord>::new(word));
    answer(row).verdict = verdict.map_err(|_| format!("no trace ends with {word:?}"))?;
    Ok(())
}

fn predicted(row: &StudyRow) -> Option<Cow<'_, str>> {
    let write = |PredictedCharacteristic { name, truth, median, ci90: [low, high] }: &PredictedCharacteristic| {
        format!("{name}={truth}|{median}|{low}|{high}")
    };
    Some(joined(row.predictions.as_ref()?, write))
}

fn set_predicted(row: &mut StudyRow, text: &str) -> Result<(), String> {
    let read = |part: &str| {
        let (name, numbers) = part.split_once('=')?;
        let numbers: Vec<f64> = numbers.split('|').map(str::parse).collect::<Result<_, _>>().ok()?;
        let [truth, median, low, high] = *numbers.as_slice() else { return None };
        Some(PredictedCharacteristic { name: name.into(), truth, median, ci90: [low, high] })
    };
    row.predictions = Some(list(text, "predictions", read)?.into());
    Ok(())
}
