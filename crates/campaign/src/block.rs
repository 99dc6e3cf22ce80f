//! Blocks: the units in which the trials of a study are computed, stored and divided into shards.

use std::fmt;
use std::ops::Range;

use crate::scenario::Scenario;
use crate::shard::TrialId;

/// Block: consecutive replicates of one cell, stored as one file of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Block {
    /// Index of the cell.
    pub cell: usize,
    /// Index of the block in its cell.
    pub number: u64,
}

impl Block {
    /// Replicates per block; the last block of a cell may have fewer.
    pub const REPLICATES: u64 = 256;

    /// Number of blocks of a cell with `replicates` replicates.
    pub fn count_in_cell(replicates: u64) -> u64 {
        replicates.div_ceil(Self::REPLICATES)
    }

    /// Number of blocks of a scenario.
    pub fn count(scenario: &Scenario) -> u64 {
        scenario.cells.len() as u64 * Self::count_in_cell(scenario.replicates)
    }

    /// Block at index `place` among all blocks of a scenario, counted cell by cell from 0.
    pub fn from_index(place: u64, scenario: &Scenario) -> Self {
        let of_cell = Self::count_in_cell(scenario.replicates);
        Self { cell: (place / of_cell) as usize, number: place % of_cell }
    }

    /// Index among all blocks of a scenario, the inverse of [`Block::from_index`].
    pub fn index(self, scenario: &Scenario) -> u64 {
        self.cell as u64 * Self::count_in_cell(scenario.replicates) + self.number
    }

    /// Block of a trial.
    pub fn from_trial_id(task: TrialId) -> Self {
        Self { cell: task.cell, number: task.replicate / Self::REPLICATES }
    }

    /// Indices of the replicates of the block in a cell with `replicates` replicates; empty for a block beyond them.
    pub fn replicate_range(self, replicates: u64) -> Range<u64> {
        let start = self.number * Self::REPLICATES;
        start..replicates.min(start + Self::REPLICATES)
    }
}

/// Stem of the file name: `CELL-NUMBER`, each with at least four digits.
impl fmt::Display for Block {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04}-{:04}", self.cell, self.number)
    }
}
