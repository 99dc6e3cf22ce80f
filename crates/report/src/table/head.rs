//! The columns of a table, from left to right.

use super::content::TableColumn;
use super::width::Alignment;

/// Columns in the making. What is added last can be given a unit.
#[derive(Debug, Clone, Default)]
pub struct TableHead {
    columns: Vec<TableColumn>,
    /// Columns before those that were added last.
    before: usize,
}

impl TableHead {
    fn with<H: Into<String>>(mut self, headings: impl IntoIterator<Item = H>, alignment: Alignment) -> Self {
        self.before = self.columns.len();
        let column = |heading: H| TableColumn { heading: heading.into(), alignment, ..TableColumn::default() };
        self.columns.extend(headings.into_iter().map(column));
        self
    }

    /// Further columns of words.
    #[must_use]
    pub fn texts<H: Into<String>>(self, headings: impl IntoIterator<Item = H>) -> Self {
        self.with(headings, Alignment::Left)
    }

    /// Further columns of whole numbers.
    #[must_use]
    pub fn counts<H: Into<String>>(self, headings: impl IntoIterator<Item = H>) -> Self {
        self.with(headings, Alignment::Right)
    }

    /// Further columns of numbers with decimals.
    #[must_use]
    pub fn numbers<H: Into<String>>(self, headings: impl IntoIterator<Item = H>) -> Self {
        self.with(headings, Alignment::Decimal)
    }

    /// The 95 % intervals of the last column, in its unit.
    #[must_use]
    pub fn interval(mut self) -> Self {
        let unit = self.columns.last().and_then(|column| column.unit.clone());
        self.columns.push(TableColumn { unit, ..TableColumn::interval() });
        self
    }

    /// The unit of the columns that were added last.
    #[must_use]
    pub fn unit(mut self, unit: &str) -> Self {
        self.columns[self.before..].iter_mut().for_each(|column| column.unit = Some(unit.to_owned()));
        self
    }
}

impl From<TableHead> for Vec<TableColumn> {
    fn from(head: TableHead) -> Self {
        head.columns
    }
}
