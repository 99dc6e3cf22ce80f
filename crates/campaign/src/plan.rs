//! The plan of a study: trials to run, their order, and the end of a cell.
//!
//! The order is cell by cell and replicate by replicate. A shard is a range of consecutive blocks, or of whole cells
//! under a stopping rule. The rule is evaluated after complete blocks in order, so the same trials are run for any
//! number of threads, interruptions and shards.

use std::collections::HashMap;
use std::ops::Range;

use crate::block::Block;
use crate::failure::Failure;
use crate::rows::StudyRow;
use crate::scenario::Scenario;
use crate::shard::{Shard, TrialId};
use crate::stopping::StopCheck;

/// Reader of the stored rows of a block.
type BlockReader<'a> = dyn Fn(Block) -> Result<Vec<StudyRow>, Failure> + 'a;

/// Missing trials of a study or a shard, issued in order.
pub struct TrialPlan<'a> {
    scenario: &'a Scenario,
    /// Number of stored trials by block, from its first trial on.
    stored: &'a HashMap<Block, u64>,
    read: &'a BlockReader<'a>,
    /// Indices of the blocks not yet begun.
    blocks: Range<u64>,
    cell: usize,
    /// Replicates of the current block not yet issued.
    open: Range<u64>,
    /// State of the stopping rule in the current cell.
    rule: Option<StopCheck>,
    /// Number of trials of every cell so far.
    pub cell_trial_counts: Vec<u64>,
}

/// Indices of the blocks of a shard.
pub fn shard_blocks(scenario: &Scenario, shard: Shard) -> Range<u64> {
    let of_cell = Block::count_in_cell(scenario.replicates);
    if scenario.stop.is_none() {
        return shard.item_range(Block::count(scenario));
    }
    let cells = shard.item_range(scenario.cells.len() as u64);
    cells.start * of_cell..cells.end * of_cell
}

/// Maximum number of trials in a range of blocks.
pub fn max_trials(scenario: &Scenario, blocks: &Range<u64>) -> u64 {
    let of_cell = Block::count_in_cell(scenario.replicates);
    if scenario.cells.iter().any(|cell| cell.record_set().is_some()) {
        let trials = |place| {
            let block = Block::from_index(place, scenario);
            block.replicate_range(scenario.max_cell_trials(block.cell)).count() as u64
        };
        return blocks.clone().map(trials).sum();
    }
    let before = |place: u64| {
        place / of_cell * scenario.replicates + (place % of_cell * Block::REPLICATES).min(scenario.replicates)
    };
    before(blocks.end) - before(blocks.start)
}

impl<'a> TrialPlan<'a> {
    /// Plan of a shard with `stored` trials; `read` returns the rows of a stored block.
    pub fn new(
        scenario: &'a Scenario,
        shard: Shard,
        stored: &'a HashMap<Block, u64>,
        read: &'a BlockReader<'a>,
    ) -> Self {
        Self {
            scenario,
            stored,
            read,
            blocks: shard_blocks(scenario, shard),
            cell: 0,
            open: 0..0,
            rule: scenario.stop.as_ref().map(|rule| StopCheck::new(rule, scenario.method_labels())),
            cell_trial_counts: vec![0; scenario.cells.len()],
        }
    }

    /// Next trial, without issuing it; `None` if the shard is done.
    pub fn peek(&mut self) -> Result<Option<TrialId>, Failure> {
        let is_left = !self.open.is_empty() || self.begin()?;
        Ok(is_left.then_some(TrialId { cell: self.cell, replicate: self.open.start }))
    }

    /// Next trials, at most `most`, except that a block of measured records is issued as a whole; empty if the shard is
    /// done. The rows of all trials issued before must have been passed to [`TrialPlan::add`].
    pub fn next_trials(&mut self, most: u64) -> Result<Vec<TrialId>, Failure> {
        let mut tasks = Vec::new();
        loop {
            let open = self.open.end.saturating_sub(self.open.start);
            // Trials of measured records share fits: a block is issued as a whole.
            let is_shared = self.scenario.cells[self.cell].record_set().is_some();
            let count = if is_shared { open } else { open.min(most.saturating_sub(tasks.len() as u64)) };
            let taken = self.open.start..self.open.start + count;
            tasks.extend(taken.map(|replicate| TrialId { cell: self.cell, replicate }));
            self.open.start += count;
            // The rule requires all rows of a block before the next block is decided.
            let is_enough = tasks.len() as u64 >= most || self.rule.is_some() && !tasks.is_empty();
            if is_enough || !self.begin()? {
                return Ok(tasks);
            }
        }
    }

    /// Begins the next block with missing trials; `false` if no such block is left.
    fn begin(&mut self) -> Result<bool, Failure> {
        while let Some(place) = self.blocks.next() {
            let block = Block::from_index(place, self.scenario);
            if block.number > 0 && self.rule.as_ref().is_some_and(StopCheck::is_met) {
                continue;
            }
            let all = block.replicate_range(self.scenario.max_cell_trials(block.cell));
            if all.is_empty() {
                continue;
            }
            let stored = self.stored.get(&block).copied().unwrap_or(0);
            if stored > 0 && self.rule.is_some() {
                (self.read)(block)?.iter().for_each(|row| self.add(row));
            }
            self.cell_trial_counts[block.cell] = all.end;
            (self.cell, self.open) = (block.cell, all.start + stored..all.end);
            if !self.open.is_empty() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Adds a row, in order, to the stopping rule.
    pub fn add(&mut self, row: &StudyRow) {
        if let Some(rule) = &mut self.rule {
            rule.add(row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::zig_zag;

    fn swept(cells: u64, replicates: u64, more: &str) -> Scenario {
        let sweep = format!("linear = {{ from = 0.1, to = 0.2, points = {cells} }}");
        zig_zag(replicates, &format!("[[sweep]]\nkey = \"sensor.heading-noise-deg\"\n{sweep}\n{more}"))
    }

    const RULE: &str = "[stop]\nfigure = \"rms-T\"\nmethod = \"srivc\"\nstandard-error = 0.05\n";

    fn none(_: Block) -> Result<Vec<StudyRow>, Failure> {
        Ok(Vec::new())
    }

    /// A shard begins at the end of the previous one, the first at the first block, and the last ends at the last
    /// block.
    #[test]
    fn a_thousand_million_trials_belong_to_one_of_ten_thousand_shards_each() {
        const SHARDS: u64 = 10_000;
        for (cells, rule) in [(2, ""), (7, ""), (1000, ""), (1000, RULE)] {
            let scenario = swept(cells, 1_000_000_000 / cells, rule);
            let parts: Vec<Range<u64>> =
                (1..=SHARDS).map(|number| shard_blocks(&scenario, Shard { number, count: SHARDS })).collect();
            assert!(parts[0].start == 0 && parts.windows(2).all(|pair| pair[0].end == pair[1].start));
            assert_eq!(parts[parts.len() - 1].end, Block::count(&scenario));
            let trials: u64 = parts.iter().map(|part| max_trials(&scenario, part)).sum();
            assert_eq!(trials, cells * scenario.replicates);
            let of_cell = Block::count_in_cell(scenario.replicates);
            assert!(rule.is_empty() || parts.iter().all(|part| part.start % of_cell == 0));
        }
    }

    #[test]
    fn what_is_stored_is_not_handed_out() {
        let scenario = swept(2, 600, "");
        let block = |cell, number| Block { cell, number };
        let stored = HashMap::from([(block(0, 0), 256), (block(0, 2), 88), (block(1, 1), 10)]);
        let mut plan = TrialPlan::new(&scenario, Shard::WHOLE, &stored, &none);
        assert_eq!(plan.peek().expect("nothing is read"), Some(TrialId { cell: 0, replicate: 256 }));
        let mut tasks = Vec::new();
        loop {
            let next = plan.next_trials(100).expect("nothing is read");
            if next.is_empty() {
                break;
            }
            tasks.extend(next);
        }
        let of = |cell: usize, replicates: Range<u64>| replicates.map(move |replicate| TrialId { cell, replicate });
        let expected = of(0, 256..512).chain(of(1, 0..256)).chain(of(1, 266..600));
        assert_eq!(tasks, expected.collect::<Vec<_>>());
        assert_eq!(plan.cell_trial_counts, [600, 600]);
        assert_eq!(plan.peek().expect("nothing is read"), None);
    }

    #[test]
    fn a_rule_sees_a_block_before_the_next_is_handed_out() {
        let scenario = swept(2, 600, &RULE.replace("0.05", "1e9"));
        let stored = HashMap::from([(Block { cell: 1, number: 0 }, 256)]);
        let row = |cell: u64, replicate: u64| StudyRow {
            cell,
            replicate,
            true_t_s: Some(1.0),
            t_s: Some(1.0 + 0.01 * (replicate % 7) as f64),
            ..StudyRow::default()
        };
        let read = |block: Block| Ok((0..256).map(|replicate| row(block.cell as u64, replicate)).collect());
        let mut plan = TrialPlan::new(&scenario, Shard::WHOLE, &stored, &read);
        let first = plan.next_trials(1000).expect("readable");
        assert_eq!((first.len(), first[255]), (256, TrialId { cell: 0, replicate: 255 }));
        first.iter().for_each(|task| plan.add(&row(0, task.replicate)));
        // The rule is met after one block of the first cell; that of the second is stored.
        let next = plan.next_trials(1000).expect("readable");
        assert_eq!((next, plan.cell_trial_counts.as_slice()), (Vec::new(), [256, 256].as_slice()));
    }
}
