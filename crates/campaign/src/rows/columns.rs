//! The columns of a file of rows: names, units, meanings, and how each is taken out of a row and put back.

use std::borrow::Cow;
use std::sync::Arc;

use ::trace::analysis::Verdict;
use identify::StopReason;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::schema::types::Type;

use super::row::{Bound, NamedEffect, Row, TraceAnswer};
use crate::design::Design;
use scenario::TRACE;

/// A column that every file of rows has.
pub struct Column {
    /// Name in the file; the unit is its end.
    pub name: &'static str,
    /// What it holds.
    pub meaning: &'static str,
    access: Access,
}

/// How a column is taken out of a row, and put back.
#[derive(Clone, Copy)]
enum Access {
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

/// The columns every file of rows has, in their order. Behind them come one column `axis.NAME` per axis of the design, a
/// number or the label of the point, and one `draw.KEY` per drawn value, in the unit of the key.
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
    let blank = || TraceAnswer { verdict: Verdict::Clean, named: Vec::new(), margin: None, expected: None };
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

/// Columns that follow in a study with a trace.
pub const TRACE_COLUMNS: [Column; 5] = [
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
    number(
        "trace_margin",
        "gain in BIC of the one missing effect over the best other one, each added alone; null where not one is missing",
        |row| row.traced.as_ref()?.margin,
        |row, value| answer(row).margin = Some(value),
    ),
    number(
        "trace_expected",
        "likelihood ratio of the truth against the nearest first-order response, on average over the noise",
        |row| row.traced.as_ref()?.expected,
        |row, value| answer(row).expected = Some(value),
    ),
];

/// Values of one column for several rows.
pub(super) enum Values {
    Counts(Vec<i64>),
    Numbers(Vec<Option<f64>>),
    Texts(Vec<Option<String>>),
}

/// What the rows of one study look like: the fixed columns, its axes and its draws.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    methods: Vec<String>,
    axes: Vec<Axis>,
    draws: Vec<String>,
    /// Whether a ship has a K and T of its own beside the nearest ones.
    owns: bool,
    /// Whether one of the methods is a trace.
    traces: bool,
}

#[derive(Debug, Clone, PartialEq)]
struct Axis {
    name: String,
    points: Points,
}

/// Points of an axis, per cell.
#[derive(Debug, Clone, PartialEq)]
enum Points {
    Numbers(Vec<f64>),
    Labels(Vec<String>),
}

/// Where the values of a column come from.
enum Source<'a> {
    Fixed(&'static Column),
    Axis(&'a Axis),
    Draw(usize),
}

impl Layout {
    /// The layout of a design.
    pub fn of(design: &Design) -> Self {
        let axis = |(index, name): (usize, &String)| {
            let numbers: Option<Vec<f64>> = design.cells.iter().map(|cell| cell.values[index]).collect();
            let labels = || design.cells.iter().map(|cell| cell.labels[index].clone()).collect();
            Axis { name: name.clone(), points: numbers.map_or_else(|| Points::Labels(labels()), Points::Numbers) }
        };
        Self {
            methods: design.methods.iter().map(|method| method.label.clone()).collect(),
            axes: design.axes.iter().enumerate().map(axis).collect(),
            draws: design.draws.clone(),
            owns: design.cells.iter().any(|cell| cell.has_own_indices),
            traces: design.methods.iter().any(|method| method.id == TRACE),
        }
    }

    fn fixed(&self) -> impl Iterator<Item = &'static Column> + use<> {
        let own: &'static [Column] = if self.owns { &OWN_COLUMNS } else { &[] };
        let traces: &'static [Column] = if self.traces { &TRACE_COLUMNS } else { &[] };
        COLUMNS.iter().chain(own).chain(traces)
    }

    /// Names of all columns, in order.
    pub fn names(&self) -> impl Iterator<Item = String> {
        let fixed = self.fixed().map(|column| column.name.to_owned());
        let axes = self.axes.iter().map(|axis| format!("axis.{}", axis.name));
        fixed.chain(axes).chain(self.draws.iter().map(|key| format!("draw.{key}")))
    }

    fn sources(&self) -> impl Iterator<Item = Source<'_>> {
        let axes = self.axes.iter().map(Source::Axis);
        self.fixed().map(Source::Fixed).chain(axes).chain((0..self.draws.len()).map(Source::Draw))
    }

    /// The schema of the file.
    pub(super) fn schema(&self) -> Type {
        let text = (Physical::BYTE_ARRAY, Repetition::OPTIONAL, Some(LogicalType::String));
        let fields = self.sources().zip(self.names()).map(|(source, name)| {
            let (physical, repetition, logical) = match source {
                Source::Fixed(Column { access: Access::Count(..), .. }) => {
                    (Physical::INT64, Repetition::REQUIRED, None)
                }
                Source::Fixed(Column { access: Access::Text(..) | Access::Method, .. })
                | Source::Axis(Axis { points: Points::Labels(_), .. }) => text.clone(),
                _ => (Physical::DOUBLE, Repetition::OPTIONAL, None),
            };
            let field = Type::primitive_type_builder(&name, physical)
                .with_repetition(repetition)
                .with_logical_type(logical)
                .build();
            Arc::new(field.expect("kinds and logical types fit together"))
        });
        Type::group_type_builder("rows").with_fields(fields.collect()).build().expect("a group of columns")
    }

    /// Whether the values of a column repeat so often that a dictionary of them pays: estimates hardly ever do.
    pub(super) fn repeats(name: &str) -> bool {
        let text = ["method", "failure", "stop", "trace_verdict", "trace_named", "trace_groups", "trace_expected"]
            .contains(&name);
        text || ["true_", "own_", "bound_", "axis."].iter().any(|start| name.starts_with(start))
    }

    /// All columns of several rows, in order.
    pub(super) fn take<'a>(&'a self, rows: &'a [Row]) -> impl Iterator<Item = Values> + 'a {
        self.sources().map(move |source| match source {
            Source::Fixed(Column { access, .. }) => match *access {
                Access::Count(get, _) => Values::Counts(rows.iter().map(|row| get(row) as i64).collect()),
                Access::Number(get, _) => Values::Numbers(rows.iter().map(get).collect()),
                Access::Text(get, _) => Values::Texts(rows.iter().map(|row| get(row).map(Cow::into_owned)).collect()),
                Access::Method => {
                    Values::Texts(rows.iter().map(|row| Some(self.methods[row.method].clone())).collect())
                }
            },
            Source::Axis(Axis { points: Points::Numbers(values), .. }) => {
                Values::Numbers(rows.iter().map(|row| Some(values[row.cell as usize])).collect())
            }
            Source::Axis(Axis { points: Points::Labels(labels), .. }) => {
                Values::Texts(rows.iter().map(|row| Some(labels[row.cell as usize].clone())).collect())
            }
            Source::Draw(index) => {
                Values::Numbers(rows.iter().map(|row| row.drawn.as_ref().map(|drawn| drawn[index])).collect())
            }
        })
    }

    /// Rows from the values of all columns, `length` each; the error names a value that no study writes.
    pub(super) fn put(&self, columns: Vec<Values>, length: usize) -> Result<Vec<Row>, String> {
        let mut rows = vec![Row::default(); length];
        let mut drawn = vec![vec![None; self.draws.len()]; length];
        for (source, values) in self.sources().zip(columns) {
            match (source, values) {
                (Source::Fixed(Column { access: Access::Count(_, set), .. }), Values::Counts(values)) => {
                    rows.iter_mut().zip(values).for_each(|(row, value)| set(row, value as u64));
                }
                (Source::Fixed(Column { access: Access::Number(_, set), .. }), Values::Numbers(values)) => {
                    let there = rows.iter_mut().zip(values).filter_map(|(row, value)| Some((row, value?)));
                    there.for_each(|(row, value)| set(row, value));
                }
                (Source::Fixed(Column { access: Access::Text(_, set), .. }), Values::Texts(values)) => {
                    let mut there =
                        rows.iter_mut().zip(&values).filter_map(|(row, value)| Some((row, value.as_ref()?)));
                    there.try_for_each(|(row, value)| set(row, value))?;
                }
                (Source::Fixed(Column { access: Access::Method, .. }), Values::Texts(values)) => {
                    for (row, label) in rows.iter_mut().zip(values) {
                        let known = self.methods.iter().position(|method| Some(method) == label.as_ref());
                        row.method = known.ok_or_else(|| format!("the study has no method {label:?}"))?;
                    }
                }
                (Source::Draw(index), Values::Numbers(values)) => {
                    drawn.iter_mut().zip(values).for_each(|(drawn, value)| drawn[index] = value);
                }
                // Axes follow from the cell; other ones belong to another design.
                (Source::Axis(Axis { points: Points::Numbers(points), name }), Values::Numbers(values)) => {
                    let is_own = |(row, value): (&Row, &Option<f64>)| {
                        points.get(row.cell as usize).map(|point| point.to_bits()) == value.map(f64::to_bits)
                    };
                    all(rows.iter().zip(&values), is_own, name)?;
                }
                (Source::Axis(Axis { points: Points::Labels(points), name }), Values::Texts(values)) => {
                    let is_own =
                        |(row, value): (&Row, &Option<String>)| points.get(row.cell as usize) == value.as_ref();
                    all(rows.iter().zip(&values), is_own, name)?;
                }
                _ => return Err("a column of it has values of another kind".to_owned()),
            }
        }
        if !self.draws.is_empty() {
            for (row, drawn) in rows.iter_mut().zip(drawn) {
                row.drawn = drawn.into_iter().collect::<Option<Vec<f64>>>().map(Arc::from);
            }
        }
        Ok(rows)
    }
}

/// Fails where a row has another point of an axis than its cell.
fn all<T>(mut rows: impl Iterator<Item = T>, is_own: impl Fn(T) -> bool, axis: &str) -> Result<(), String> {
    match rows.all(is_own) {
        true => Ok(()),
        false => Err(format!("a row has another point of the axis {axis:?} than its cell")),
    }
}
