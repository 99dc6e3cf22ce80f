//! What the rows of one study look like: the fixed columns, its axes and its draws, and how rows become columns and
//! back.

use std::borrow::Cow;
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::schema::types::Type;
use scenario::TRACE;

use super::columns::{Access, COLUMNS, Column, OWN_COLUMNS, PREDICT_COLUMNS, TRACE_COLUMNS};
use super::row::Row;
use crate::design::Design;

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
    /// Whether manoeuvres are predicted.
    predicts: bool,
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
            predicts: design.predicts,
        }
    }

    fn fixed(&self) -> impl Iterator<Item = &'static Column> + use<> {
        let own: &'static [Column] = if self.owns { &OWN_COLUMNS } else { &[] };
        let traces: &'static [Column] = if self.traces { &TRACE_COLUMNS } else { &[] };
        let predicts: &'static [Column] = if self.predicts { &PREDICT_COLUMNS } else { &[] };
        COLUMNS.iter().chain(own).chain(traces).chain(predicts)
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
