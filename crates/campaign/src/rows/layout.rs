//! Row layout of one study: its fixed columns, axes and sampled values, and the conversion between rows and columns.

use std::borrow::Cow;
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::schema::types::TypePtr;

use super::columns::{
    Access, BASE_COLUMNS, COMMON_COLUMNS, LOCATED_COLUMNS, PREDICT_COLUMNS, RECORD_COLUMNS, RowColumn, TRACE_COLUMNS,
};
use super::row::StudyRow;
use crate::design::{Design, TrialRecords};
use crate::parquet_table::{self, ColumnValues};
use crate::scenario::TRACE_ID;

/// Row layout of one study: fixed columns, axes, sampled values and records.
pub struct RowLayout {
    methods: Vec<String>,
    fixed: Vec<&'static RowColumn>,
    /// Names of the axes, each with the points of the cells.
    axes: Vec<(String, ColumnValues)>,
    /// Records of every trial, by cell, in a study of measured records; `None` for simulated trials.
    records: Option<Vec<Vec<TrialRecords>>>,
    draws: Vec<String>,
}

/// Source of the values of a column.
enum ColumnSource<'a> {
    Fixed(&'static RowColumn),
    Axis(&'a str, &'a ColumnValues),
    Record(fn(&TrialRecords) -> Option<&str>, &'a [Vec<TrialRecords>]),
    Draw(usize),
}

impl RowLayout {
    /// Layout of a design.
    pub fn from_design(design: &Design) -> Self {
        let axis = |(index, name): (usize, &String)| {
            let numbers: Vec<Option<f64>> = design.cells.iter().map(|cell| cell.values[index]).collect();
            let labels = || design.cells.iter().map(|cell| Some(cell.labels[index].clone())).collect();
            let is_number = numbers.iter().all(Option::is_some);
            (name.clone(), if is_number { ColumnValues::Numbers(numbers) } else { ColumnValues::Texts(labels()) })
        };
        let is_traced = design.methods.iter().any(|method| method.id == TRACE_ID);
        let groups = [
            (true, COMMON_COLUMNS.as_slice()),
            (design.cells.iter().any(|cell| cell.is_base_with_effects), &BASE_COLUMNS),
            (is_traced, &TRACE_COLUMNS),
            (is_traced && design.cells.iter().any(|cell| cell.physics.is_some()), &LOCATED_COLUMNS),
            (design.is_measured(), &RECORD_COLUMNS),
            (design.predicts, &PREDICT_COLUMNS),
        ];
        Self {
            methods: design.methods.iter().map(|method| method.label.clone()).collect(),
            fixed: groups.into_iter().filter(|(is_there, _)| *is_there).flat_map(|(_, columns)| columns).collect(),
            axes: design.axes.iter().enumerate().map(axis).collect(),
            draws: design.drawn_keys.clone(),
            records: design.is_measured().then(|| design.cells.iter().map(|cell| cell.records.clone()).collect()),
        }
    }

    /// Number of methods.
    pub fn method_count(&self) -> usize {
        self.methods.len()
    }

    /// All columns in order, as name and source.
    fn columns(&self) -> impl Iterator<Item = (String, ColumnSource<'_>)> {
        let fixed = self.fixed.iter().map(|&column| (column.name.to_owned(), ColumnSource::Fixed(column)));
        let axes = self.axes.iter().map(|(name, points)| (format!("axis.{name}"), ColumnSource::Axis(name, points)));
        let draws = self.draws.iter().enumerate().map(|(at, key)| (format!("draw.{key}"), ColumnSource::Draw(at)));
        let records = self.records.iter().flat_map(|records| {
            let fitted: fn(&TrialRecords) -> Option<&str> = |record| Some(record.fitted.as_str());
            let validation: fn(&TrialRecords) -> Option<&str> = |record| record.validation.as_deref();
            [("fitted", fitted), ("judge", validation)]
                .map(|(name, of)| (name.to_owned(), ColumnSource::Record(of, records.as_slice())))
        });
        fixed.chain(axes).chain(draws).chain(records)
    }

    /// Names of all columns, in order.
    pub fn names(&self) -> impl Iterator<Item = String> {
        self.columns().map(|(name, _)| name)
    }

    /// Parquet schema of the file.
    pub(super) fn schema(&self) -> TypePtr {
        let fields = self.columns().map(|(name, source)| {
            let (physical, repetition, logical) = match source {
                ColumnSource::Fixed(RowColumn { access: Access::Count(..), .. }) => {
                    (Physical::INT64, Repetition::REQUIRED, None)
                }
                ColumnSource::Fixed(RowColumn { access: Access::Text(..) | Access::Method, .. })
                | ColumnSource::Axis(_, ColumnValues::Texts(_))
                | ColumnSource::Record(..) => (Physical::BYTE_ARRAY, Repetition::OPTIONAL, Some(LogicalType::String)),
                _ => (Physical::DOUBLE, Repetition::OPTIONAL, None),
            };
            parquet_table::field(&name, physical, repetition, logical)
        });
        parquet_table::schema(fields.collect())
    }

    /// `true` if the values of a column repeat often enough for dictionary encoding, unlike estimates.
    pub(super) fn is_dictionary_encoded(name: &str) -> bool {
        let text = [
            "method",
            "failure",
            "stop",
            "trace_verdict",
            "trace_named",
            "trace_groups",
            "trace_times",
            "trace_located",
            "trace_expected",
            "fitted",
            "judge",
        ]
        .contains(&name);
        text || ["true_", "own_", "bound_", "axis."].iter().any(|start| name.starts_with(start))
    }

    /// Columns of rows, in order.
    pub(super) fn value_columns<'a>(&'a self, rows: &'a [StudyRow]) -> impl Iterator<Item = ColumnValues> + 'a {
        self.columns().map(move |(_, source)| match source {
            ColumnSource::Fixed(RowColumn { access, .. }) => match *access {
                Access::Count(get, _) => ColumnValues::Counts(rows.iter().map(|row| Some(get(row) as i64)).collect()),
                Access::Number(get, _) => ColumnValues::Numbers(rows.iter().map(get).collect()),
                Access::Text(get, _) => {
                    ColumnValues::Texts(rows.iter().map(|row| get(row).map(Cow::into_owned)).collect())
                }
                Access::Method => {
                    ColumnValues::Texts(rows.iter().map(|row| Some(self.methods[row.method].clone())).collect())
                }
            },
            ColumnSource::Axis(_, points) => points.for_rows(rows),
            ColumnSource::Record(of, records) => record_names(of, records, rows),
            ColumnSource::Draw(index) => ColumnValues::Numbers(
                rows.iter().map(|row| row.drawn_values.as_ref().map(|drawn| drawn[index])).collect(),
            ),
        })
    }

    /// Rows from all columns, each of `length` values. Fails for a value that the design does not allow, and names it.
    pub(super) fn rows_from(&self, columns: Vec<ColumnValues>, length: usize) -> Result<Vec<StudyRow>, String> {
        let mut rows = vec![StudyRow::default(); length];
        let mut drawn = vec![vec![None; self.draws.len()]; length];
        for ((_, source), values) in self.columns().zip(columns) {
            match (source, values) {
                (
                    ColumnSource::Fixed(RowColumn { access: Access::Count(_, set), .. }),
                    ColumnValues::Counts(values),
                ) => {
                    present(&mut rows, values).for_each(|(row, value)| set(row, value as u64));
                }
                (
                    ColumnSource::Fixed(RowColumn { access: Access::Number(_, set), .. }),
                    ColumnValues::Numbers(values),
                ) => {
                    present(&mut rows, values).for_each(|(row, value)| set(row, value));
                }
                (ColumnSource::Fixed(RowColumn { access: Access::Text(_, set), .. }), ColumnValues::Texts(values)) => {
                    present(&mut rows, values).try_for_each(|(row, value)| set(row, &value))?;
                }
                (ColumnSource::Fixed(RowColumn { access: Access::Method, .. }), ColumnValues::Texts(values)) => {
                    for (row, label) in rows.iter_mut().zip(values) {
                        let index = self.methods.iter().position(|method| Some(method) == label.as_ref());
                        row.method = index.ok_or_else(|| format!("the study has no method {label:?}"))?;
                    }
                }
                (ColumnSource::Draw(index), ColumnValues::Numbers(values)) => {
                    drawn.iter_mut().zip(values).for_each(|(drawn, value)| drawn[index] = value);
                }
                // Axes and records follow from cell and replicate; other values belong to another design.
                (ColumnSource::Axis(_, points), values) if points.for_rows(&rows) == values => {}
                (ColumnSource::Record(of, records), values) if record_names(of, records, &rows) == values => {}
                (ColumnSource::Record(..), _) => return Err("a row names other records than its trial has".to_owned()),
                (ColumnSource::Axis(name, _), _) => {
                    return Err(format!("a row has a point of the axis {name:?} that is not that of its cell"));
                }
                _ => return Err("a column has values of the wrong type".to_owned()),
            }
        }
        if !self.draws.is_empty() {
            for (row, drawn) in rows.iter_mut().zip(drawn) {
                row.drawn_values = drawn.into_iter().collect::<Option<Vec<f64>>>().map(Arc::from);
            }
        }
        Ok(rows)
    }
}

/// Column of record names, one per row; `None` for a trial outside the design.
fn record_names(
    get: fn(&TrialRecords) -> Option<&str>,
    records: &[Vec<TrialRecords>],
    rows: &[StudyRow],
) -> ColumnValues {
    let name = |row: &StudyRow| get(records.get(row.cell as usize)?.get(row.replicate as usize)?).map(str::to_owned);
    ColumnValues::Texts(rows.iter().map(name).collect())
}

/// Rows that have a value, each with its value.
fn present<T>(rows: &mut [StudyRow], values: Vec<Option<T>>) -> impl Iterator<Item = (&mut StudyRow, T)> {
    rows.iter_mut().zip(values).filter_map(|(row, value)| Some((row, value?)))
}

impl ColumnValues {
    /// Appends an injective encoding of the values to `bytes`.
    pub(super) fn write_to(&self, bytes: &mut Vec<u8>) {
        fn all<T>(values: &[Option<T>], bytes: &mut Vec<u8>, mut write: impl FnMut(&T, &mut Vec<u8>)) {
            for value in values {
                bytes.push(u8::from(value.is_some()));
                value.iter().for_each(|value| write(value, bytes));
            }
        }
        match self {
            Self::Counts(values) => all(values, bytes, |count, bytes| bytes.extend(count.to_le_bytes())),
            Self::Numbers(values) => all(values, bytes, |number, bytes| bytes.extend(number.to_bits().to_le_bytes())),
            Self::Texts(values) => all(values, bytes, |text, bytes| {
                bytes.extend((text.len() as u64).to_le_bytes());
                bytes.extend(text.as_bytes());
            }),
        }
    }

    /// Values by row, from values by cell; `None` for a missing cell.
    fn for_rows(&self, rows: &[StudyRow]) -> Self {
        fn of<T: Clone>(values: &[Option<T>], rows: &[StudyRow]) -> Vec<Option<T>> {
            rows.iter().map(|row| values.get(row.cell as usize)?.clone()).collect()
        }
        match self {
            Self::Counts(values) => Self::Counts(of(values, rows)),
            Self::Numbers(values) => Self::Numbers(of(values, rows)),
            Self::Texts(values) => Self::Texts(of(values, rows)),
        }
    }
}
