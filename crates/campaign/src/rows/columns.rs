//! The columns of a file of rows: names, units, meanings, and how each is taken out of a row and put back.

use std::borrow::Cow;

use ::trace::Verdict;
use identify::StopReason;

use super::row::{NamedEffect, PredictedFigure, Row, TraceAnswer};

/// A column that every file of rows has.
pub struct Column {
    /// Name in the file; the unit is its end.
    pub name: &'static str,
    /// What it holds.
    pub meaning: &'static str,
    pub(super) access: Access,
}

/// How a column is taken out of a row, and put back.
#[derive(Clone, Copy)]
pub(super) enum Access {
    Count(fn(&Row) -> u64, fn(&mut Row, u64)),
    Number(fn(&Row) -> Option<f64>, fn(&mut Row, f64)),
    Text(fn(&Row) -> Option<Cow<'_, str>>, fn(&mut Row, &str) -> Result<(), String>),
    Method,
}

macro_rules! column {
    ($name:literal, $meaning:literal, $kind:ident($get:expr, $set:expr)) => {
        Column { name: $name, meaning: $meaning, access: Access::$kind($get, $set) }
    };
    ($name:literal, $meaning:literal, count $field:ident) => {
        column!($name, $meaning, Count(|row| row.$field, |row, value| row.$field = value))
    };
    ($name:literal, $meaning:literal, $field:ident) => {
        column!($name, $meaning, Number(|row| row.$field, |row, value| row.$field = Some(value)))
    };
    // One of several numbers that are there together.
    ($name:literal, $meaning:literal, $field:ident[$place:literal]) => {
        column!(
            $name,
            $meaning,
            Number(
                |row| row.$field.map(|numbers| numbers[$place]),
                |row, value| row.$field.get_or_insert([f64::NAN; _])[$place] = value
            )
        )
    };
    ($name:literal, $meaning:literal, traced.$field:ident) => {
        column!(
            $name,
            $meaning,
            Number(|row| row.traced.as_ref()?.$field, |row, value| answer(row).$field = Some(value))
        )
    };
}

/// The columns every file of rows has, in their order. Behind them come one column `axis.NAME` per axis of the design,
/// a number or the label of the point, and one `draw.KEY` per drawn value, in the unit of the key.
pub const COLUMNS: [Column; 22] = [
    column!("cell", "index of the cell in the design, from 0", count cell),
    column!("replicate", "index of the trial in its cell, from 0; every method sees the same trial", count replicate),
    Column { name: "method", meaning: "label of the method", access: Access::Method },
    column!(
        "failure",
        "why the method gave no answer; null when it did",
        Text(|row| Some(row.failure.as_deref()?.into()), set_failure)
    ),
    column!(
        "true_K_per_s",
        "K of the first-order response nearest to the ship, its own where it is first order; null where it has none",
        true_k_per_s
    ),
    column!("true_T_s", "T of that response", true_t_s),
    column!("bound_K_per_s", "Cramér–Rao bound on the standard deviation of K on this trial", bound[0]),
    column!("bound_T_s", "the same of T", bound[1]),
    column!("bound_K_over_T_per_s2", "the same of K/T", bound[2]),
    column!("K_per_s", "K found", k_per_s),
    column!("K_lower95_per_s", "lower end of its 95 % interval; null where the method quotes none", k_ci95_per_s[0]),
    column!("K_upper95_per_s", "upper end", k_ci95_per_s[1]),
    column!("T_s", "T found; negative for a course-unstable answer", t_s),
    column!("T_lower95_s", "lower end of its 95 % interval", t_ci95_s[0]),
    column!("T_upper95_s", "upper end", t_ci95_s[1]),
    column!("delta_r_deg", "rudder bias found", rudder_bias_deg),
    column!("delta_r_lower95_deg", "lower end of its 95 % interval", rudder_bias_ci95_deg[0]),
    column!("delta_r_upper95_deg", "upper end", rudder_bias_ci95_deg[1]),
    column!(
        "heading_rmse_deg",
        "rms error of the heading on the trial itself, its rudder replayed through the answer",
        heading_rmse_deg
    ),
    column!(
        "validation_rmse_deg",
        "the same on the validation manoeuvre, which no method has seen",
        validation_rmse_deg
    ),
    column!(
        "evaluations",
        "model evaluations of the method",
        Number(|row| row.evaluations.map(|count| count as f64), |row, value| row.evaluations = Some(value as u64))
    ),
    column!(
        "stop",
        "why the method stopped: direct, converged, iteration-limit, range-limit",
        Text(|row| row.stop.map(Cow::Borrowed), set_stop)
    ),
];

/// Columns that follow in a study of ships that are a first-order base with effects.
pub const OWN_COLUMNS: [Column; 2] = [
    column!(
        "own_K_per_s",
        "K of the ship's own base, against which a trace is held; null where the ship is first order or a hull",
        own_k_per_s
    ),
    column!("own_T_s", "T of that base", own_t_s),
];

/// Columns that follow in a study with a trace.
pub const TRACE_COLUMNS: [Column; 8] = [
    column!(
        "trace_verdict",
        "clean, traced or unexplained",
        Text(|row| Some(row.traced.as_ref()?.verdict.as_str().into()), set_verdict)
    ),
    column!("trace_named", "effects named, joined by +; empty where none was", Text(named, set_named)),
    column!("trace_groups", "the same, each with its aliases joined by |", Text(groups, set_groups)),
    column!(
        "trace_probabilities",
        "effects with a probability of at least 0.005, each with it behind =, joined by +",
        Text(probabilities, set_probabilities)
    ),
    column!(
        "trace_margin",
        "log evidence for the one missing effect less that for the best other one; null where not one is missing",
        traced.margin
    ),
    column!(
        "trace_expected",
        "likelihood ratio of the truth against the nearest first-order response, on average over the noise",
        traced.expected
    ),
    column!(
        "trace_band_fitted",
        "share of the headings of the trial inside the 95 % band of the traced model; null where there is no band",
        traced.band_fitted
    ),
    column!(
        "trace_band_held_out",
        "the same on the validation manoeuvre, which has no noise: the band is that of the parameters alone",
        traced.band_held_out
    ),
];

/// Columns that follow in a study that predicts manoeuvres.
pub const PREDICT_COLUMNS: [Column; 1] = [column!(
    "predicted",
    "figures of manoeuvres predicted from the answer, joined by +: name=truth|median|lower 90 %|upper 90 %; empty where \
     the answer has no covariance",
    Text(predicted, set_predicted)
)];

fn set_failure(row: &mut Row, text: &str) -> Result<(), String> {
    row.failure = Some(text.into());
    Ok(())
}

fn set_stop(row: &mut Row, word: &str) -> Result<(), String> {
    let known = StopReason::ALL.iter().map(|reason| reason.as_str()).find(|known| *known == word);
    row.stop = Some(known.ok_or_else(|| format!("no method stops because of {word:?}"))?);
    Ok(())
}

/// What a trace said, begun with the first of its columns that is read.
fn answer(row: &mut Row) -> &mut TraceAnswer {
    row.traced.get_or_insert_default()
}

/// A list as one text.
fn joined<T>(all: &[T], one: impl Fn(&T) -> String) -> Cow<'static, str> {
    all.iter().map(one).collect::<Vec<_>>().join("+").into()
}

/// The list in a text; fails where a part of it is none of `what`.
fn list<T>(text: &str, what: &str, one: impl Fn(&str) -> Option<T>) -> Result<Vec<T>, String> {
    let parts = text.split('+').filter(|part| !part.is_empty());
    parts.map(one).collect::<Option<_>>().ok_or_else(|| format!("{text:?} are no {what}"))
}

/// The effects named.
fn named(row: &Row) -> Option<Cow<'_, str>> {
    Some(joined(&row.traced.as_ref()?.named, |effect| effect.id.to_string()))
}

fn set_named(row: &mut Row, text: &str) -> Result<(), String> {
    answer(row).named = list(text, "effects", |id| Some(NamedEffect { id: id.into(), aliases: Vec::new() }))?;
    Ok(())
}

/// The same with the aliases of each.
fn groups(row: &Row) -> Option<Cow<'_, str>> {
    let group = |effect: &NamedEffect| [&[effect.id.clone()], effect.aliases.as_slice()].concat().join("|");
    Some(joined(&row.traced.as_ref()?.named, group))
}

/// The column before has named the effects: these are their aliases.
fn set_groups(row: &mut Row, text: &str) -> Result<(), String> {
    let group = |part: &str| {
        let mut ids = part.split('|').filter(|id| !id.is_empty()).map(Box::from);
        Some(NamedEffect { id: ids.next()?, aliases: ids.collect() })
    };
    let groups = list(text, "groups of effects", group)?;
    let named = &mut answer(row).named;
    if !groups.iter().map(|group| &group.id).eq(named.iter().map(|effect| &effect.id)) {
        return Err(format!("the groups {text:?} are not those of the effects named"));
    }
    *named = groups;
    Ok(())
}

fn probabilities(row: &Row) -> Option<Cow<'_, str>> {
    Some(joined(&row.traced.as_ref()?.probabilities, |(id, probability)| format!("{id}={probability:.3}")))
}

fn set_probabilities(row: &mut Row, text: &str) -> Result<(), String> {
    let one = |part: &str| {
        let (id, number) = part.split_once('=')?;
        Some((Box::from(id), number.parse().ok().filter(|p| (0.0..=1.0).contains(p))?))
    };
    answer(row).probabilities = list(text, "probabilities of effects", one)?;
    Ok(())
}

fn set_verdict(row: &mut Row, word: &str) -> Result<(), String> {
    let known = Verdict::ALL.into_iter().find(|verdict| verdict.as_str() == word);
    answer(row).verdict = known.ok_or_else(|| format!("no trace ends with {word:?}"))?;
    Ok(())
}

fn predicted(row: &Row) -> Option<Cow<'_, str>> {
    let one = |PredictedFigure { name, truth, median, ci90: [low, high] }: &PredictedFigure| {
        format!("{name}={truth}|{median}|{low}|{high}")
    };
    Some(joined(row.predicted.as_ref()?, one))
}

fn set_predicted(row: &mut Row, text: &str) -> Result<(), String> {
    let one = |part: &str| {
        let (name, numbers) = part.split_once('=')?;
        let numbers: Vec<f64> = numbers.split('|').map(str::parse).collect::<Result<_, _>>().ok()?;
        let [truth, median, low, high] = *numbers.as_slice() else { return None };
        Some(PredictedFigure { name: name.into(), truth, median, ci90: [low, high] })
    };
    row.predicted = Some(list(text, "predictions", one)?.into());
    Ok(())
}
