//! Columns of a table, from left to right.

use serde::{Deserialize, Serialize};

use super::width::Alignment;

/// Column of a table.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct TableColumn {
    /// Heading of the column.
    pub heading: String,
    /// Unit of the column, without brackets; `None` without a unit.
    pub unit: Option<String>,
    /// Alignment of the cells.
    pub alignment: Alignment,
    /// `true` if the cells are intervals `[low, high]` of the column before; in CSV and JSON they are two columns.
    #[serde(default, skip_serializing_if = "std::ops::Not::not", rename = "interval")]
    pub is_interval: bool,
}

impl TableColumn {
    /// Heading and unit, as in `K [1/s]`.
    pub(super) fn head(&self) -> String {
        // An interval is next to the column whose unit it has.
        if self.is_interval { self.heading.clone() } else { self.named(&self.heading) }
    }

    /// Another heading with the unit of this column.
    pub(super) fn named(&self, heading: &str) -> String {
        self.unit.as_ref().map_or_else(|| heading.to_owned(), |unit| format!("{heading} [{unit}]"))
    }
}

/// Builder of the columns of a table; a unit applies to the columns that were added last.
#[derive(Debug, Clone, Default)]
pub struct TableHead {
    pub(super) columns: Vec<TableColumn>,
    /// Number of columns before those that were added last.
    before: usize,
}

impl TableHead {
    fn with<H: Into<String>>(mut self, headings: impl IntoIterator<Item = H>, alignment: Alignment) -> Self {
        self.before = self.columns.len();
        let column = |heading: H| TableColumn { heading: heading.into(), alignment, ..TableColumn::default() };
        self.columns.extend(headings.into_iter().map(column));
        self
    }

    /// Adds columns of texts.
    #[must_use]
    pub fn texts<H: Into<String>>(self, headings: impl IntoIterator<Item = H>) -> Self {
        self.with(headings, Alignment::Left)
    }

    /// Adds columns of whole numbers.
    #[must_use]
    pub fn counts<H: Into<String>>(self, headings: impl IntoIterator<Item = H>) -> Self {
        self.with(headings, Alignment::Right)
    }

    /// Adds columns of numbers with decimals.
    #[must_use]
    pub fn numbers<H: Into<String>>(self, headings: impl IntoIterator<Item = H>) -> Self {
        self.with(headings, Alignment::Decimal)
    }

    /// Adds a column of 95 % intervals of the last column, in its unit.
    #[must_use]
    pub fn interval95(mut self) -> Self {
        let unit = self.columns.last().and_then(|column| column.unit.clone());
        self.columns.push(TableColumn {
            heading: "95 %".to_owned(),
            unit,
            is_interval: true,
            ..TableColumn::default()
        });
        self
    }

    /// Sets the unit of the columns that were added last.
    #[must_use]
    pub fn unit(mut self, unit: &str) -> Self {
        self.columns[self.before..].iter_mut().for_each(|column| column.unit = Some(unit.to_owned()));
        self
    }
}
