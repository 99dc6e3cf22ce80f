//! Content of a table, and its cells padded to columns.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::head::{TableColumn, TableHead};
use super::width::align;
use crate::printable::escaped;

/// Table of columns, and rows of cells. `None` is a missing cell; a row shorter than the columns is filled up with
/// missing cells, and cells beyond the last column are not shown.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Table {
    /// Title of the table, its caption in LaTeX; `None` without a title.
    pub title: Option<String>,
    /// Label in a document, `\label{tab:…}` in LaTeX; `None` without a label.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// Columns from left to right.
    pub columns: Vec<TableColumn>,
    /// Rows from top to bottom.
    pub rows: Vec<Vec<Option<String>>>,
}

impl Table {
    /// Table with the columns of `head`, without rows, title or label.
    pub fn new(head: TableHead) -> Self {
        Self { columns: head.columns, ..Self::default() }
    }

    /// The table with a title.
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self { title: Some(title.into()), ..self }
    }

    /// The table with a label.
    pub fn labelled(self, label: impl Into<String>) -> Self {
        Self { label: Some(label.into()), ..self }
    }

    /// Adds a row; [`crate::number::MISSING`] counts as a missing cell.
    pub fn push<C: Into<String>>(&mut self, cells: impl IntoIterator<Item = C>) {
        let cell = |c: C| Some(c.into()).filter(|text: &String| text != crate::number::MISSING);
        self.rows.push(cells.into_iter().map(cell).collect());
    }

    /// Cells of a row, one per column.
    pub(super) fn cells<'a>(&'a self, row: &'a [Option<String>]) -> impl Iterator<Item = Option<&'a str>> {
        (0..self.columns.len()).map(|i| row.get(i).and_then(Option::as_deref))
    }

    /// Cells of a column from top to bottom.
    pub(super) fn column_cells(&self, column: usize) -> impl Iterator<Item = Option<&str>> {
        self.rows.iter().map(move |row| row.get(column).and_then(Option::as_deref))
    }

    /// Cells padded within their columns so that decimal points are aligned; every column has the width of its widest
    /// cell or heading. The first line is the headings.
    pub(super) fn padded(&self) -> Vec<Vec<String>> {
        let mut lines = vec![Vec::new(); self.rows.len() + 1];
        for (i, column) in self.columns.iter().enumerate() {
            let cells: Vec<Cow<str>> =
                self.column_cells(i).map(|cell| escaped(cell.unwrap_or(crate::number::MISSING))).collect();
            let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
            for (line, cell) in lines.iter_mut().zip(align(&escaped(&column.head()), &cells, column.alignment)) {
                line.push(cell);
            }
        }
        lines
    }
}
