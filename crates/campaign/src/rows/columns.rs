//! The columns of a file of rows: names, units, meanings, and how each is taken out of a row and put back.

use std::borrow::Cow;

use ::trace::Verdict;
use identify::StopReason;

use super::row::{Bound, Foretold, NamedEffect, Row, TraceAnswer};

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

const fn count(name: &'static str, meaning: &'static str, get: fn(&Row) -> u64, set: fn(&mut Row, u64)) -> Column {
    Column { name, meaning, access: Access::Count(get, set) }
}

const fn number(
    name: &'static str,
    meaning: &'static str,
    get: fn(&Row) -> Option<f64>,
    set: fn(&mut Row, f64),
) -> Column {
    Column { name, meaning, access: Access::Number(get, set) }
}

const NO_BOUND: Bound = Bound { k_per_s: f64::NAN, t_s: f64::NAN, k_over_t_per_s2: f64::NAN };
const NO_ENDS: [f64; 2] = [f64::NAN; 2];

/// The columns every file of rows has, in their order. Behind them come one column `axis.NAME` per axis of the design,
/// a number or the label of the point, and one `draw.KEY` per drawn value, in the unit of the key.
pub const COLUMNS: [Column; 22] = [
    count("cell", "index of the cell in the design, from 0", |row| row.cell, |row, value| row.cell = value),
    count(
        "replicate",
        "index of the trial in its cell, from 0; every method sees the same trial",
        |row| row.replicate,
        |row, value| row.replicate = value,
    ),
    Column { name: "method", meaning: "label of the method", access: Access::Method },
    Column {
        name: "failure",
        meaning: "why the method gave no answer; null when it did",
        access: Access::Text(
            |row| row.failure.as_deref().map(Cow::Borrowed),
            |row, text| {
                row.failure = Some(text.into());
                Ok(())
            },
        ),
    },
    number(
        "true_K_per_s",
        "K of the first-order response nearest to the ship, its own where it is first order; null where it has none",
        |row| row.true_k_per_s,
        |row, value| row.true_k_per_s = Some(value),
    ),
    number("true_T_s", "T of that response", |row| row.true_t_s, |row, value| row.true_t_s = Some(value)),
    number(
        "bound_K_per_s",
        "Cramér–Rao bound on the standard deviation of K on this trial",
        |row| row.bound.map(|bound| bound.k_per_s),
        |row, value| row.bound.get_or_insert(NO_BOUND).k_per_s = value,
    ),
    number(
        "bound_T_s",
        "the same of T",
        |row| row.bound.map(|bound| bound.t_s),
        |row, value| row.bound.get_or_insert(NO_BOUND).t_s = value,
    ),
    number(
        "bound_K_over_T_per_s2",
        "the same of K/T",
        |row| row.bound.map(|bound| bound.k_over_t_per_s2),
        |row, value| row.bound.get_or_insert(NO_BOUND).k_over_t_per_s2 = value,
    ),
    number("K_per_s", "K found", |row| row.k_per_s, |row, value| row.k_per_s = Some(value)),
    number(
        "K_lower95_per_s",
        "lower end of its 95 % interval; null where the method quotes none",
        |row| row.k_ci95_per_s.map(|ends| ends[0]),
        |row, value| row.k_ci95_per_s.get_or_insert(NO_ENDS)[0] = value,
    ),
    number(
        "K_upper95_per_s",
        "upper end",
        |row| row.k_ci95_per_s.map(|ends| ends[1]),
        |row, value| row.k_ci95_per_s.get_or_insert(NO_ENDS)[1] = value,
    ),
    number("T_s", "T found; negative for a course-unstable answer", |row| row.t_s, |row, value| row.t_s = Some(value)),
    number(
        "T_lower95_s",
        "lower end of its 95 % interval",
        |row| row.t_ci95_s.map(|ends| ends[0]),
        |row, value| row.t_ci95_s.get_or_insert(NO_ENDS)[0] = value,
    ),
    number(
        "T_upper95_s",
        "upper end",
        |row| row.t_ci95_s.map(|ends| ends[1]),
        |row, value| row.t_ci95_s.get_or_insert(NO_ENDS)[1] = value,
    ),
    number(
        "delta_r_deg",
        "rudder bias found",
        |row| row.rudder_bias_deg,
        |row, value| row.rudder_bias_deg = Some(value),
    ),
    number(
        "delta_r_lower95_deg",
        "lower end of its 95 % interval",
        |row| row.rudder_bias_ci95_deg.map(|ends| ends[0]),
        |row, value| row.rudder_bias_ci95_deg.get_or_insert(NO_ENDS)[0] = value,
    ),
    number(
        "delta_r_upper95_deg",
        "upper end",
        |row| row.rudder_bias_ci95_deg.map(|ends| ends[1]),
        |row, value| row.rudder_bias_ci95_deg.get_or_insert(NO_ENDS)[1] = value,
    ),
    number(
        "heading_rmse_deg",
        "rms error of the heading on the trial itself, its rudder replayed through the answer",
        |row| row.heading_rmse_deg,
        |row, value| row.heading_rmse_deg = Some(value),
    ),
    number(
        "validation_rmse_deg",
        "the same on the validation manoeuvre, which no method has seen",
        |row| row.validation_rmse_deg,
        |row, value| row.validation_rmse_deg = Some(value),
    ),
    number(
        "evaluations",
        "model evaluations of the method",
        |row| row.evaluations.map(|count| count as f64),
        |row, value| row.evaluations = Some(value as u64),
    ),
    Column {
        name: "stop",
        meaning: "why the method stopped: direct, converged, iteration-limit, range-limit",
        access: Access::Text(
            |row| row.stop.map(Cow::Borrowed),
            |row, word| {
                let known = StopReason::ALL.iter().map(|reason| reason.as_str()).find(|known| *known == word);
                row.stop = Some(known.ok_or_else(|| format!("no method stops because of {word:?}"))?);
                Ok(())
            },
        ),
    },
];

/// What a trace said, begun with the first of its columns that is read.
fn answer(row: &mut Row) -> &mut TraceAnswer {
    let blank = || TraceAnswer {
        verdict: Verdict::Clean,
        named: Vec::new(),
        probabilities: Vec::new(),
        margin: None,
        expected: None,
        band_fitted: None,
        band_held_out: None,
    };
    row.traced.get_or_insert_with(|| Box::new(blank()))
}

/// Effects one after the other, as their column has them.
const BETWEEN_EFFECTS: &str = "+";

/// An effect and its aliases, as their column has them.
const BETWEEN_ALIASES: &str = "|";

fn parts<'a>(text: &'a str, between: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(between).filter(|part| !part.is_empty())
}

/// The effects named, joined.
fn named(row: &Row) -> Option<Cow<'_, str>> {
    let ids: Vec<&str> = row.traced.as_ref()?.named.iter().map(|effect| &*effect.id).collect();
    Some(ids.join(BETWEEN_EFFECTS).into())
}

/// The same with the aliases of each.
fn groups(row: &Row) -> Option<Cow<'_, str>> {
    let group = |effect: &NamedEffect| {
        let ids = std::iter::once(&effect.id).chain(&effect.aliases).map(|id| &**id);
        ids.collect::<Vec<_>>().join(BETWEEN_ALIASES)
    };
    let groups: Vec<String> = row.traced.as_ref()?.named.iter().map(group).collect();
    Some(groups.join(BETWEEN_EFFECTS).into())
}

fn set_named(row: &mut Row, text: &str) -> Result<(), String> {
    let effect = |id: &str| NamedEffect { id: id.into(), aliases: Vec::new() };
    answer(row).named = parts(text, BETWEEN_EFFECTS).map(effect).collect();
    Ok(())
}

/// The column before has named the effects: these are their aliases.
fn set_groups(row: &mut Row, text: &str) -> Result<(), String> {
    let refuse = || format!("the groups {text:?} are not those of the effects named");
    let named = &mut answer(row).named;
    if parts(text, BETWEEN_EFFECTS).count() != named.len() {
        return Err(refuse());
    }
    for (effect, group) in named.iter_mut().zip(parts(text, BETWEEN_EFFECTS)) {
        let mut ids = parts(group, BETWEEN_ALIASES);
        if ids.next() != Some(&effect.id) {
            return Err(refuse());
        }
        effect.aliases = ids.map(Box::from).collect();
    }
    Ok(())
}

/// Between an effect and its probability.
const BETWEEN_NUMBERS: &str = "=";

fn probabilities(row: &Row) -> Option<Cow<'_, str>> {
    let all = row.traced.as_ref()?.probabilities.iter();
    let parts: Vec<String> = all.map(|(id, probability)| format!("{id}{BETWEEN_NUMBERS}{probability:.3}")).collect();
    Some(parts.join(BETWEEN_EFFECTS).into())
}

fn set_probabilities(row: &mut Row, text: &str) -> Result<(), String> {
    let one = |part: &str| {
        let (id, number) = part.split_once(BETWEEN_NUMBERS)?;
        Some((Box::from(id), number.parse().ok().filter(|p| (0.0..=1.0).contains(p))?))
    };
    let all: Option<Vec<(Box<str>, f64)>> = parts(text, BETWEEN_EFFECTS).map(one).collect();
    answer(row).probabilities = all.ok_or_else(|| format!("{text:?} are no probabilities of effects"))?;
    Ok(())
}

/// Between the numbers of a prediction.
const BETWEEN_ENDS: &str = "|";

fn predicted(row: &Row) -> Option<Cow<'_, str>> {
    let one = |figure: &Foretold| {
        let [low, high] = figure.ci90;
        let numbers = [figure.truth, figure.median, low, high].map(|number| number.to_string());
        format!("{}{BETWEEN_NUMBERS}{}", figure.name, numbers.join(BETWEEN_ENDS))
    };
    let all: Vec<String> = row.predicted.as_ref()?.iter().map(one).collect();
    Some(all.join(BETWEEN_EFFECTS).into())
}

fn set_predicted(row: &mut Row, text: &str) -> Result<(), String> {
    let one = |part: &str| {
        let (name, numbers) = part.split_once(BETWEEN_NUMBERS)?;
        let numbers: Vec<f64> = numbers.split(BETWEEN_ENDS).map(str::parse).collect::<Result<_, _>>().ok()?;
        let &[truth, median, low, high] = numbers.as_slice() else { return None };
        Some(Foretold { name: name.into(), truth, median, ci90: [low, high] })
    };
    let all: Option<Box<[Foretold]>> = parts(text, BETWEEN_EFFECTS).map(one).collect();
    row.predicted = Some(all.ok_or_else(|| format!("{text:?} are no predictions"))?);
    Ok(())
}

fn set_verdict(row: &mut Row, word: &str) -> Result<(), String> {
    let known = Verdict::ALL.into_iter().find(|verdict| verdict.as_str() == word);
    answer(row).verdict = known.ok_or_else(|| format!("no trace ends with {word:?}"))?;
    Ok(())
}

/// Columns that follow in a study of ships that are a first-order base with effects.
pub const OWN_COLUMNS: [Column; 2] = [
    number(
        "own_K_per_s",
        "K of the ship's own base, against which a trace is held; null where the ship is first order or a hull",
        |row| row.own_k_per_s,
        |row, value| row.own_k_per_s = Some(value),
    ),
    number("own_T_s", "T of that base", |row| row.own_t_s, |row, value| row.own_t_s = Some(value)),
];

/// Columns that follow in a study that predicts manoeuvres.
pub const PREDICT_COLUMNS: [Column; 1] = [Column {
    name: "predicted",
    meaning: "figures of manoeuvres predicted from the answer, joined by +: name=truth|median|lower 90 %|upper 90 %; empty \
              where the answer has no covariance",
    access: Access::Text(predicted, set_predicted),
}];

/// Columns that follow in a study with a trace.
pub const TRACE_COLUMNS: [Column; 8] = [
    Column {
        name: "trace_verdict",
        meaning: "clean, traced or unexplained",
        access: Access::Text(|row| Some(row.traced.as_ref()?.verdict.as_str().into()), set_verdict),
    },
    Column {
        name: "trace_named",
        meaning: "effects named, joined by +; empty where none was",
        access: Access::Text(named, set_named),
    },
    Column {
        name: "trace_groups",
        meaning: "the same, each with its aliases joined by |",
        access: Access::Text(groups, set_groups),
    },
    Column {
        name: "trace_probabilities",
        meaning: "effects with a probability of at least 0.005, each with it behind =, joined by +",
        access: Access::Text(probabilities, set_probabilities),
    },
    number(
        "trace_margin",
        "log evidence for the one missing effect less that for the best other one; null where not one is missing",
        |row| row.traced.as_ref()?.margin,
        |row, value| answer(row).margin = Some(value),
    ),
    number(
        "trace_expected",
        "likelihood ratio of the truth against the nearest first-order response, on average over the noise",
        |row| row.traced.as_ref()?.expected,
        |row, value| answer(row).expected = Some(value),
    ),
    number(
        "trace_band_fitted",
        "share of the headings of the trial inside the 95 % band of the traced model; null where there is no band",
        |row| row.traced.as_ref()?.band_fitted,
        |row, value| answer(row).band_fitted = Some(value),
    ),
    number(
        "trace_band_held_out",
        "the same on the validation manoeuvre, which has no noise: the band is that of the parameters alone",
        |row| row.traced.as_ref()?.band_held_out,
        |row, value| answer(row).band_held_out = Some(value),
    ),
];
