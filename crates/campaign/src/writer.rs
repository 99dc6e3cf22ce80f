//! Trials as they come, stored block by block.

use std::ops::Range;
use std::time::{Duration, Instant};

use crate::block::Block;
use crate::blocks::BlockStore;
use crate::engine::TrialOutcome;
use crate::failure::Failure;
use crate::rows::StudyRow;
use crate::scenario::Scenario;
use crate::task::Task;
use crate::timings::Timings;

/// A block that is not whole is stored when its first new row is so old, so that little is lost to a kill,
const MIN_AGE: Duration = Duration::from_millis(250);
/// or, later, when that age is this share of the time of the run, so that a block of long trials is not written often.
const AGE_SHARE: f64 = 0.01;

/// Gathers the rows of a block and stores them when it is whole, and now and then before.
pub struct BlockWriter<'a> {
    store: &'a BlockStore<'a>,
    scenario: &'a Scenario,
    /// The block under way.
    block: Option<Block>,
    rows: Vec<StudyRow>,
    timings: Timings,
    /// Since when there are rows that are not stored.
    since: Option<Instant>,
}

impl<'a> BlockWriter<'a> {
    /// Of a scenario, into a store of its blocks.
    pub fn new(store: &'a BlockStore<'a>, scenario: &'a Scenario) -> Self {
        Self { store, scenario, block: None, rows: Vec::new(), timings: Timings::default(), since: None }
    }

    /// Stores trials as they come, in order, until there are no more.
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

    /// Replicates of a block.
    fn range(&self, block: Block) -> Range<u64> {
        block.range(self.scenario.trials_of(block.cell))
    }

    fn add(&mut self, outcome: TrialOutcome) -> Result<(), Failure> {
        let Some(row) = outcome.rows.first() else { return Ok(()) };
        let task = Task { cell: row.cell as usize, replicate: row.replicate };
        let block = Block::of(task);
        let all = self.range(block);
        if self.block != Some(block) {
            // Of one that was begun before, the first rows are stored.
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

    /// Stores what there is of the block under way.
    fn write(&mut self) -> Result<(), Failure> {
        let Some(block) = self.block.filter(|_| self.since.take().is_some()) else { return Ok(()) };
        // Another program may have more of it.
        let is_whole = self.rows.last().is_some_and(|row| row.replicate + 1 == self.range(block).end);
        if !is_whole && self.store.read(block)?.is_ok_and(|rows| rows.len() > self.rows.len()) {
            return Ok(());
        }
        self.store.write(block, &self.rows, &self.timings)
    }
}
