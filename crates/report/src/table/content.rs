//! What a table holds, and its cells padded to columns.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::width::{Alignment, align};
use crate::printable::escaped;

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct TableColumn {
    /// What the column holds.
    pub heading: String,
    /// Its unit, without brackets.
    pub unit: Option<String>,
    /// How its cells are aligned.
    pub alignment: Alignment,
    /// Whether its cells are intervals of the column before it, `[low, high]`; other programs read two columns.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub interval: bool,
}

impl TableColumn {
    /// A column of words.
    pub fn text(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), ..Self::default() }
    }

    /// A column of whole numbers.
    pub fn count(heading: impl Into<String>) -> Self {
        Self { alignment: Alignment::Right, ..Self::text(heading) }
    }

    /// A column of numbers with decimals.
    pub fn number(heading: impl Into<String>) -> Self {
        Self { alignment: Alignment::Decimal, ..Self::text(heading) }
    }

    /// The 95 % intervals of the column before.
    pub fn interval() -> Self {
        Self { interval: true, ..Self::text("95 %") }
    }

    /// The same column with a unit.
    pub fn unit(self, unit: impl Into<String>) -> Self {
        Self { unit: Some(unit.into()), ..self }
    }

    /// Heading and unit, as in `K [1/s]`.
    pub(super) fn head(&self) -> String {
        // An interval stands beside the column whose unit it has.
        if self.interval { self.heading.clone() } else { self.named(&self.heading) }
    }

    /// Another heading with the unit of this column.
    pub(super) fn named(&self, heading: &str) -> String {
        self.unit.as_ref().map_or_else(|| heading.to_owned(), |unit| format!("{heading} [{unit}]"))
    }
}

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
    pub fn new(columns: impl Into<Vec<TableColumn>>) -> Self {
        Self { columns: columns.into(), ..Self::default() }
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
