//! Running the trials of a study into its folder: what is there already is checked and kept, the rest is run in parallel and
//! stored as it comes, and in the end everything is where [`crate::store`] expects it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::mpsc::sync_channel;
use std::time::{Duration, Instant};

use indicatif::ProgressBar;
use rayon::prelude::*;

use crate::engine::{self, Bench, Outcome};
use crate::failure::{Failure, OnPath};
use crate::interrupt::Listener;
use crate::manifest::Manifest;
use crate::plan::{Plan, Shard, Task};
use crate::progress;
use crate::rows::{Layout, Reader, Row};
use crate::scenario::Scenario;
use crate::screen;
use crate::showcase;
use crate::store::{self, CellFacts, Design};
use crate::unfinished::{self, Unfinished};

/// Time a batch of trials should take: long beside the wait for its last trial, short beside a second.
const BATCH_TIME: Duration = Duration::from_millis(250);

/// Most trials of a batch: they are in memory.
const MOST_BATCH: usize = 2048;

/// Stored trials that are run again before a study goes on, to see that this program computes the same.
const SPOT_CHECKS: usize = 32;

/// Runs a shard of a scenario into a folder, or what is missing of it.
///
/// Fails when the folder holds another study, when its rows are not what this program computes, and when it is interrupted;
/// what was stored stays.
pub fn collect(scenario: &Scenario, shard: Shard, folder: &Path, restart: bool, quiet: bool) -> Result<(), Failure> {
    let manifest = Manifest::new(scenario, shard);
    if restart {
        discard(folder)?;
    }
    let design = design(scenario);
    let layout = Layout::of(&design);
    if let Some(stored) = store::manifest_of_rows(folder)? {
        is_same(&stored, &manifest, folder)?;
        let mut spots = SpotCheck::new(scenario, folder);
        Reader::open(&folder.join(store::ROWS), &layout)?.for_each(|row| spots.see(row))?;
        spots.finish()?;
        // Words may have changed; numbers may not.
        let known = store::read_design(folder)?;
        store::write_design(folder, &Design { cells: known.cells, ..design })?;
        return Manifest { machine: stored.machine, git_revision: stored.git_revision, ..manifest }
            .write(&folder.join(store::MANIFEST));
    }
    if let Some(stored) = Unfinished::manifest_in(folder)? {
        is_same(&stored, &manifest, folder)?;
    } else if folder.join(store::ROWS).exists() {
        return Err(Failure::input(format!(
            "{} holds rows of an unknown study, without {}; give another folder with --out, or --restart to discard them",
            folder.display(),
            store::MANIFEST
        )));
    }
    let mut plan = Plan::new(scenario, shard);
    let mut unfinished = Unfinished::open(folder, manifest, &design, &layout)?;
    let mut spots = SpotCheck::new(scenario, folder);
    unfinished.resume(&mut plan, |row| spots.see(row))?;
    spots.finish()?;
    let resumed = plan.most() - plan.left();
    if resumed > 0 && !quiet {
        screen::warn(&format!("going on after {resumed} of {} trials in {}", plan.most(), folder.display()));
    }
    run_all(scenario, &mut plan, &mut unfinished, quiet).map_err(|failure| match failure {
        Stopped::Failed(failure) => failure,
        Stopped::Interrupted { done } => Failure::work(format!(
            "stopped after {done} of {} trials; their rows are kept in {}, and the same command goes on from there",
            plan.most(),
            folder.join(unfinished::NAME).display()
        )),
    })?;
    finish(scenario, &plan, unfinished, &design, folder)
}

/// Everything of a study in a folder, thrown away on request.
fn discard(folder: &Path) -> Result<(), Failure> {
    unfinished::discard(folder)?;
    let rows = folder.join(store::ROWS);
    if rows.exists() { fs::remove_file(&rows).on("remove", &rows) } else { Ok(()) }
}

/// The design without what takes trials to know.
fn design(scenario: &Scenario) -> Design {
    let bare = |cell: &crate::scenario::Cell| CellFacts {
        labels: cell.labels.clone(),
        values: cell.values.clone(),
        missing: cell.missing(),
        bound_percent2: None,
    };
    Design {
        question: scenario.question.clone(),
        analysis: scenario.analysis.clone(),
        finding: scenario.finding.clone(),
        figure: scenario.figure.clone(),
        detail: scenario.detail.clone(),
        axes: scenario.axes.iter().map(|axis| axis.name.clone()).collect(),
        methods: scenario.method_names(),
        draws: scenario.draws.clone(),
        cells: scenario.cells.iter().map(bare).collect(),
    }
}

/// Refuses a folder whose rows belong to another study, and says what differs.
pub fn is_same(stored: &Manifest, own: &Manifest, folder: &Path) -> Result<(), Failure> {
    let differences = stored.differences(own);
    if differences.is_empty() {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{} holds rows of another study (there: what is stored, here: what is asked for):\n  {}\ngive another folder with \
         --out, or --restart to discard what is there",
        folder.display(),
        differences.join("\n  ")
    )))
}

enum Stopped {
    Failed(Failure),
    Interrupted { done: u64 },
}

/// Runs what is left of a plan; rows go to a writer of their own while the next trials run.
fn run_all(scenario: &Scenario, plan: &mut Plan, unfinished: &mut Unfinished, quiet: bool) -> Result<(), Stopped> {
    let listener = Listener::new();
    let bar = progress::bar(plan.most(), plan.most() - plan.left(), quiet);
    let interrupted = std::thread::scope(|scope| {
        // One batch may wait while one is written and one runs: memory stays what it is.
        let (send, receive) = sync_channel::<Vec<Outcome>>(1);
        let writer = scope.spawn(move || unfinished.store(receive));
        let take = |outcomes| send.send(outcomes).is_ok();
        let interrupted = run_batches(scenario, plan, || listener.is_asked(), take, &bar);
        drop(send);
        let written = writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        written.map(|()| interrupted)
    });
    bar.finish();
    match interrupted {
        Err(failure) => Err(Stopped::Failed(failure)),
        Ok(true) => Err(Stopped::Interrupted { done: plan.most() - plan.left() }),
        Ok(false) => Ok(()),
    }
}

/// Runs batch after batch until the plan is done, `is_asked` to stop, or `take` wants no more. Returns whether it was asked.
fn run_batches(
    scenario: &Scenario,
    plan: &mut Plan,
    is_asked: impl Fn() -> bool + Sync,
    mut take: impl FnMut(Vec<Outcome>) -> bool,
    bar: &ProgressBar,
) -> bool {
    let mut size = 4 * rayon::current_num_threads();
    loop {
        let tasks = plan.next(size as u64);
        let (Some(first), Some(last)) = (tasks.first().copied(), tasks.last().copied()) else { return false };
        let bench = Bench::new(scenario, first.cell..=last.cell);
        let start = Instant::now();
        let outcomes: Vec<Option<Outcome>> = tasks
            .par_iter()
            .map(|&task| {
                let outcome = (!is_asked()).then(|| bench.run(task));
                bar.inc(1);
                outcome
            })
            .collect();
        // Rows are kept in order, so an interruption keeps them up to the first that is missing.
        let outcomes: Vec<Outcome> = outcomes.into_iter().map_while(|outcome| outcome).collect();
        let interrupted = outcomes.len() < tasks.len();
        outcomes.iter().flat_map(|outcome| &outcome.rows).for_each(|row| plan.saw(row));
        if interrupted {
            plan.go_back_to(tasks[outcomes.len()]);
        }
        if !take(outcomes) || interrupted {
            return interrupted;
        }
        let wanted = size as f64 * BATCH_TIME.as_secs_f64() / start.elapsed().as_secs_f64().max(1e-6);
        size = (wanted as usize).clamp(4 * rayon::current_num_threads(), MOST_BATCH);
    }
}

/// All rows of a small study, in their order, without a folder; and its design.
pub fn in_memory(scenario: &Scenario) -> (Design, Vec<Row>) {
    let mut plan = Plan::new(scenario, Shard::WHOLE);
    let mut rows = Vec::new();
    let take = |outcomes: Vec<Outcome>| {
        rows.extend(outcomes.into_iter().flat_map(|outcome| outcome.rows));
        true
    };
    run_batches(scenario, &mut plan, || false, take, &ProgressBar::hidden());
    let cells = (0..scenario.cells.len()).into_par_iter().map(|cell| engine::facts(scenario, cell)).collect();
    (Design { cells, ..design(scenario) }, rows)
}

/// Makes the result folder whole: rows, facts of the cells, showcases, times, and the manifest last.
fn finish(
    scenario: &Scenario,
    plan: &Plan,
    unfinished: Unfinished,
    design: &Design,
    folder: &Path,
) -> Result<(), Failure> {
    unfinished.join(&folder.join(store::ROWS))?;
    let own = |cell: usize| plan.holds(Task { cell, replicate: 0 });
    let facts = |cell: usize| match own(cell) {
        true => engine::facts(scenario, cell),
        false => design.cells[cell].clone(),
    };
    let cells = (0..scenario.cells.len()).into_par_iter().map(facts).collect();
    store::write_design(folder, &Design { cells, ..design.clone() })?;
    let shown = if scenario.showcase { scenario.cells.len() } else { 0 };
    let showcases: Vec<_> = (0..shown)
        .into_par_iter()
        .filter(|&cell| own(cell))
        .filter_map(|cell| showcase::of_cell(scenario, cell))
        .collect();
    store::write_showcases(folder, &showcases)?;
    unfinished.timings().write(&folder.join(store::TIMINGS), design)?;
    unfinished.manifest().write(&folder.join(store::MANIFEST))?;
    unfinished.remove()
}

/// Runs some of the stored trials again: rows of a program that computes something else must not be mixed with new ones.
struct SpotCheck<'a> {
    scenario: &'a Scenario,
    folder: &'a Path,
    every: usize,
    kept: BTreeMap<Task, Vec<Row>>,
}

impl<'a> SpotCheck<'a> {
    fn new(scenario: &'a Scenario, folder: &'a Path) -> Self {
        let every = scenario.cells.len().div_ceil(SPOT_CHECKS);
        Self { scenario, folder, every, kept: BTreeMap::new() }
    }

    /// Keeps the first trial of some cells.
    fn see(&mut self, row: Row) -> Result<(), Failure> {
        let task = Task { cell: row.cell as usize, replicate: row.replicate };
        if task.cell.is_multiple_of(self.every) && (task.replicate == 0 || self.kept.is_empty())
            || self.kept.contains_key(&task)
        {
            self.kept.entry(task).or_default().push(row);
        }
        Ok(())
    }

    fn finish(self) -> Result<(), Failure> {
        let differs = self
            .kept
            .par_iter()
            .find_first(|(task, rows)| Bench::new(self.scenario, task.cell..=task.cell).run(**task).rows != **rows);
        let Some((task, _)) = differs else { return Ok(()) };
        Err(Failure::input(format!(
            "the rows in {} are not what this program computes (trial {} of cell {} differs): they were made by another version \
             of it; give another folder with --out, or --restart to run the study anew",
            self.folder.display(),
            task.replicate,
            task.cell
        )))
    }
}
