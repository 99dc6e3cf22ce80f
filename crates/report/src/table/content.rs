//! What a table holds, and its cells padded to columns.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::head::{TableColumn, TableHead};
use super::width::align;
use crate::printable::escaped;

/// A table: columns, and rows of cells. `None` is a missing cell; a row shorter than the columns is filled up with
/// missing cells and what is beyond the last column is not shown.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Table {
    /// Title or caption.
    pub title: Option<String>,
    /// What a document calls it: `\label{tab:…}` in LaTeX.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// The columns from left to right.
    pub columns: Vec<TableColumn>,
    /// The rows from top to bottom.
    pub rows: Vec<Vec<Option<String>>>,
}

impl Table {
    /// An empty table.
    pub fn new(head: TableHead) -> Self {
        Self { columns: head.columns, ..Self::default() }
    }

    /// The same table with a title.
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self { title: Some(title.into()), ..self }
    }

    /// The same table with a label.
    pub fn labelled(self, label: impl Into<String>) -> Self {
        Self { label: Some(label.into()), ..self }
    }

    /// Adds a row; [`crate::number::MISSING`] counts as a missing cell.
    pub fn push<C: Into<String>>(&mut self, cells: impl IntoIterator<Item = C>) {
        let cell = |c: C| Some(c.into()).filter(|text: &String| text != crate::number::MISSING);
        self.rows.push(cells.into_iter().map(cell).collect());
    }

    /// The cells of a row under the columns.
    pub(super) fn cells<'a>(&'a self, row: &'a [Option<String>]) -> impl Iterator<Item = Option<&'a str>> {
        (0..self.columns.len()).map(|i| row.get(i).and_then(Option::as_deref))
    }

    /// The cells of a column from top to bottom.
    pub(super) fn cells_of(&self, column: usize) -> impl Iterator<Item = Option<&str>> {
        self.rows.iter().map(move |row| row.get(column).and_then(Option::as_deref))
    }

    /// Every cell padded within its column so that decimal points stand below each other; columns of width of their
    /// widest cell or heading. The first line is the headings.
    pub(super) fn padded(&self) -> Vec<Vec<String>> {
        let mut lines = vec![Vec::new(); self.rows.len() + 1];
        for (i, column) in self.columns.iter().enumerate() {
            let cells: Vec<Cow<str>> =
                self.cells_of(i).map(|cell| escaped(cell.unwrap_or(crate::number::MISSING))).collect();
            let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
            for (line, cell) in lines.iter_mut().zip(align(&escaped(&column.head()), &cells, column.alignment)) {
                line.push(cell);
            }
        }
        lines
    }
}
