//! Writer that stores trials block by block as they finish.

use std::ops::Range;
use std::time::{Duration, Instant};

use crate::block::Block;
use crate::block_store::TrialBlockStore;
use crate::engine::TrialOutcome;
use crate::failure::Failure;
use crate::rows::StudyRow;
use crate::scenario::Scenario;
use crate::shard::TrialId;
use crate::timings::Timings;

/// Minimum age of the first unsaved row at which an incomplete block is stored, which limits the loss if the program is
/// killed.
const MIN_AGE: Duration = Duration::from_millis(250);
/// Minimum age as a share of the run time, used if it is larger: blocks of long trials are written rarely.
const AGE_SHARE: f64 = 0.01;

/// Writer of the current block; it stores a block on completion, and at intervals before.
pub struct BlockWriter<'a> {
    store: &'a TrialBlockStore<'a>,
    scenario: &'a Scenario,
    /// Current block; `None` before the first trial.
    block: Option<Block>,
    rows: Vec<StudyRow>,
    timings: Timings,
    /// Time of the first unsaved row; `None` if all rows are stored.
    since: Option<Instant>,
}

impl<'a> BlockWriter<'a> {
    /// Writer of a scenario into a store of its blocks.
    pub fn new(store: &'a TrialBlockStore<'a>, scenario: &'a Scenario) -> Self {
        Self { store, scenario, block: None, rows: Vec::new(), timings: Timings::default(), since: None }
    }

    /// Stores trials, which arrive in order, until the last one.
    pub fn store(&mut self, outcomes: impl IntoIterator<Item = Vec<TrialOutcome>>) -> Result<(), Failure> {
        let start = Instant::now();
        for outcomes in outcomes {
            outcomes.into_iter().try_for_each(|outcome| self.add(outcome))?;
            let age = MIN_AGE.max(start.elapsed().mul_f64(AGE_SHARE));
            if self.since.is_some_and(|since| since.elapsed() >= age) {
                self.write()?;
            }
        }
        self.write()
    }

    /// Replicates of a block of the scenario.
    fn range(&self, block: Block) -> Range<u64> {
        block.replicate_range(self.scenario.max_cell_trials(block.cell))
    }

    fn add(&mut self, outcome: TrialOutcome) -> Result<(), Failure> {
        let Some(row) = outcome.rows.first() else { return Ok(()) };
        let task = TrialId { cell: row.cell as usize, replicate: row.replicate };
        let block = Block::from_trial_id(task);
        let all = self.range(block);
        if self.block != Some(block) {
            // The first rows of a block begun earlier are already stored.
            let is_new = task.replicate == all.start;
            self.rows = if is_new { Vec::new() } else { self.store.reread(block)? };
            self.timings = if is_new { Timings::default() } else { self.store.timings(block)? };
            self.block = Some(block);
        }
        self.rows.extend(outcome.rows);
        self.timings.add(&outcome.timing);
        self.since.get_or_insert_with(Instant::now);
        if task.replicate + 1 == all.end { self.write() } else { Ok(()) }
    }

    /// Stores the current block as far as it is computed.
    fn write(&mut self) -> Result<(), Failure> {
        let Some(block) = self.block.filter(|_| self.since.take().is_some()) else { return Ok(()) };
        // Another program may have stored more rows of the block.
        let is_whole = self.rows.last().is_some_and(|row| row.replicate + 1 == self.range(block).end);
        if !is_whole && self.store.read(block)?.is_ok_and(|rows| rows.len() > self.rows.len()) {
            return Ok(());
        }
        self.store.write(block, &self.rows, &self.timings)
    }
}
