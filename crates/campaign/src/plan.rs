//! Which trials a study runs, in what order, which of them belong to a shard, and when a cell has had enough of them.
//!
//! The order is cell by cell and replicate by replicate. Without a stopping rule a shard is a run of consecutive
//! trials, with one it is a run of whole cells, because a rule looks at all the trials of a cell so far. What a rule
//! sees is fixed by the rows alone, so the same trials are run whatever the number of threads, interruptions and
//! shards.

use scenario::Scenario;

use crate::rows::StudyRow;
use crate::stopping::StopCheck;
use crate::task::{Shard, Task};

/// The trials of a study or a shard of it, handed out in order.
#[derive(Clone)]
pub struct TrialPlan<'a> {
    scenario: &'a Scenario,
    /// First trial of the part.
    first: Task,
    /// Trial after its last.
    end: Task,
    /// Next trial that is not yet handed out.
    next: Task,
    /// What the stopping rule has seen of the cell of `next`.
    verdict: Option<StopCheck>,
}

impl<'a> TrialPlan<'a> {
    /// The plan of a shard, at its beginning.
    pub fn new(scenario: &'a Scenario, shard: Shard) -> Self {
        let cells = scenario.cells.len() as u64;
        let at =
            |trial: u64| Task { cell: (trial / scenario.replicates) as usize, replicate: trial % scenario.replicates };
        let whole = |cell: u64| Task { cell: cell as usize, replicate: 0 };
        let (first, end) = match &scenario.stop {
            None => {
                let trials = shard.part(cells * scenario.replicates);
                (at(trials.start), at(trials.end))
            }
            Some(_) => {
                let cells = shard.part(cells);
                (whole(cells.start), whole(cells.end))
            }
        };
        let verdict = scenario.stop.as_ref().map(|rule| StopCheck::new(rule, scenario.labels()));
        Self { scenario, first, end, next: first, verdict }
    }

    /// Most trials the plan may still hand out.
    pub fn left(&self) -> u64 {
        self.number(self.end) - self.number(self.next.min(self.end))
    }

    /// Most trials of the whole part.
    pub fn most(&self) -> u64 {
        self.number(self.end) - self.number(self.first)
    }

    /// The next trials, at most `most` of them; none when the part is done. Rows of all trials handed out before have
    /// to have been shown to [`TrialPlan::saw`].
    pub fn next(&mut self, most: u64) -> Vec<Task> {
        if let (Some(verdict), Some(rule)) = (&self.verdict, &self.scenario.stop) {
            let looked = self.next.replicate > 0 && self.next.replicate.is_multiple_of(rule.every);
            if looked && verdict.is_met() {
                self.next = Task { cell: self.next.cell + 1, replicate: 0 };
            }
        }
        let mut tasks = Vec::new();
        while (tasks.len() as u64) < most && self.next < self.end {
            tasks.push(self.next);
            self.next = self.after(self.next);
            // The rule looks at the rows so far before it says what comes next; at the end of a cell too.
            if self.scenario.stop.as_ref().is_some_and(|rule| self.next.replicate.is_multiple_of(rule.every)) {
                break;
            }
        }
        tasks
    }

    /// Takes note of a row, in order: of a trial handed out, or stored by an earlier run.
    pub fn saw(&mut self, row: &StudyRow) {
        if let Some(verdict) = &mut self.verdict {
            verdict.see(row);
        }
    }

    fn after(&self, task: Task) -> Task {
        let replicate = task.replicate + 1;
        match replicate < self.scenario.replicates {
            true => Task { replicate, ..task },
            false => Task { cell: task.cell + 1, replicate: 0 },
        }
    }

    /// Hands out a trial again, and all after it.
    pub fn go_back_to(&mut self, task: Task) {
        self.next = task;
    }

    /// Whether a trial belongs to this part.
    pub fn holds(&self, task: Task) -> bool {
        self.first <= task && task < self.end
    }

    fn number(&self, task: Task) -> u64 {
        task.cell as u64 * self.scenario.replicates + task.replicate
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::zig_zag;

    /// 10⁹ trials of `cells` cells, with more keys of the scenario.
    fn large(cells: u64, more: &str) -> Scenario {
        let sweep = format!("linear = {{ from = 0.1, to = 0.2, points = {cells} }}");
        zig_zag(1_000_000_000 / cells, &format!("[[sweep]]\nkey = \"sensor.heading-noise-deg\"\n{sweep}\n{more}"))
    }

    const SHARDS: u64 = 10_000;

    fn plans<'a>(scenario: &'a Scenario, of: u64) -> impl Iterator<Item = TrialPlan<'a>> {
        (1..=of).map(move |number| TrialPlan::new(scenario, Shard { number, of }))
    }

    /// Every trial belongs to one shard: shards begin where the one before ended, the first at the first trial, the
    /// last ends with the last. Bookkeeping only, nothing is run.
    #[test]
    fn a_thousand_million_trials_belong_to_one_of_ten_thousand_shards_each() {
        for cells in [2, 7, 1000] {
            let scenario = large(cells, "");
            let trials = cells * scenario.replicates;
            let mut next = Task { cell: 0, replicate: 0 };
            let mut most = Vec::new();
            for plan in plans(&scenario, SHARDS) {
                assert_eq!(plan.first, next);
                assert!(plan.holds(plan.first) && !plan.holds(plan.end));
                most.push(plan.most());
                next = plan.end;
            }
            assert_eq!(next, Task { cell: cells as usize, replicate: 0 });
            assert_eq!(most.iter().sum::<u64>(), trials);
            assert_eq!(
                most.iter().max().zip(most.iter().min()).map(|(most, least)| most - least),
                Some(u64::from(!trials.is_multiple_of(SHARDS)))
            );
            // The same from the side of a trial, wherever it is.
            let all: Vec<TrialPlan> = plans(&scenario, SHARDS).collect();
            for trial in (0..trials).step_by(10_000_019).chain([trials - 1]) {
                let task =
                    Task { cell: (trial / scenario.replicates) as usize, replicate: trial % scenario.replicates };
                assert_eq!(all.iter().filter(|plan| plan.holds(task)).count(), 1, "{task:?}");
            }
        }
    }

    #[test]
    fn with_a_stopping_rule_shards_are_whole_cells() {
        let rule = "[stop]\nfigure = \"rms-T\"\nmethod = \"srivc\"\nstandard-error = 0.05\n";
        let scenario = large(1000, rule);
        let mut next = Task { cell: 0, replicate: 0 };
        let mut empty = 0;
        for mut plan in plans(&scenario, SHARDS) {
            assert_eq!((plan.first, plan.first.replicate, plan.end.replicate), (next, 0, 0));
            empty += u64::from(plan.most() == 0);
            // More shards than cells: most have nothing to do and say so.
            assert_eq!(plan.next(10).is_empty(), plan.most() == 0);
            next = plan.end;
        }
        assert_eq!((next.cell, empty), (1000, SHARDS - 1000));
    }

    /// Wherever a shard was interrupted, it goes on with the next trial and ends with its last.
    #[test]
    fn every_shard_goes_on_where_it_was() {
        let scenario = large(7, "");
        for mut plan in plans(&scenario, SHARDS) {
            let whole = plan.most();
            let first = plan.first;
            let handed_out = plan.next(3);
            assert_eq!((handed_out[0], handed_out.len() as u64, plan.left()), (first, 3, whole - 3));
            plan.go_back_to(handed_out[1]);
            assert_eq!(plan.left(), whole - 1);
            let before_last = match plan.end.replicate.checked_sub(2) {
                Some(replicate) => Task { replicate, ..plan.end },
                None => Task { cell: plan.end.cell - 1, replicate: scenario.replicates + plan.end.replicate - 2 },
            };
            plan.go_back_to(plan.after(before_last));
            assert_eq!((plan.left(), plan.next(100).len(), plan.left()), (1, 1, 0));
            assert!(plan.next(1).is_empty());
        }
    }
}
