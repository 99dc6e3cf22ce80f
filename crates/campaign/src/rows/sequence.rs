//! Whether rows are all there: whole trials in their order, none missing and none twice.

use crate::design::Design;

use super::row::StudyRow;

/// Follows rows from the first to the last trial that a design says is stored.
pub struct Sequence<'a> {
    design: &'a Design,
    cell: usize,
    /// Next replicate of the cell.
    replicate: u64,
    method: usize,
}

impl<'a> Sequence<'a> {
    /// Before the first row.
    pub fn new(design: &'a Design) -> Self {
        let mut this = Self { design, cell: 0, replicate: 0, method: 0 };
        this.enter(0);
        this
    }

    /// Goes to the next cell, from `cell` on, of which trials are stored.
    fn enter(&mut self, cell: usize) {
        let cells = &self.design.cells;
        self.cell = (cell..cells.len()).find(|&cell| !cells[cell].trials.is_empty()).unwrap_or(cells.len());
        self.replicate = cells.get(self.cell).map_or(0, |cell| cell.trials.start);
    }

    /// Takes note of a row. Fails when it is not the next one, and says which was expected.
    pub fn see(&mut self, row: &StudyRow) -> Result<(), String> {
        if (row.cell, row.replicate, row.method) != (self.cell as u64, self.replicate, self.method) {
            let found = format!("trial {} of cell {}", row.replicate, row.cell);
            return Err(match self.expected() {
                Some(expected) => format!("there is {found}, and expected is {expected}"),
                None => format!("there is {found} after the last trial of the study"),
            });
        }
        self.method += 1;
        if self.method == self.design.methods.len() {
            self.method = 0;
            self.replicate += 1;
            if self.replicate == self.design.cells[self.cell].trials.end {
                self.enter(self.cell + 1);
            }
        }
        Ok(())
    }

    /// Fails when rows are missing, and says from which on.
    pub fn finish(&self) -> Result<(), String> {
        match self.expected() {
            Some(expected) => Err(format!("its rows end before {expected}")),
            None => Ok(()),
        }
    }

    fn expected(&self) -> Option<String> {
        let method = self.design.methods.get(self.method)?;
        (self.cell < self.design.cells.len())
            .then(|| format!("trial {} of cell {}, method {}", self.replicate, self.cell, method.label))
    }
}
