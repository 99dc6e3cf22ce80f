//! Running the trials of a study into its folder: what is there already is checked and kept, the rest is run in
//! parallel and stored as it comes, and in the end everything is where [`crate::store`] expects it.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, channel, sync_channel};
use std::thread::Scope;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use scenario::Scenario;

use crate::design::Design;
use crate::disk;
use crate::engine::{self, TrialOutcome, TrialRunner};
use crate::files;
use crate::folder::ResultFolder;
use crate::manifest::Manifest;
use crate::observer::Observer;
use crate::outside::RunningEstimators;
use crate::plan::TrialPlan;
use crate::rows::{RowLayout, StudyRow};
use crate::showcase;
use crate::sources;
use crate::store::{self, StoredStudy};
use crate::task::{Shard, Task};
use crate::unfinished::{self, Unfinished};
use scenario::failure::{Failure, OnPath};

/// Time a batch of trials should take: long beside the wait for its last trial, short beside a second.
const BATCH_TIME: Duration = Duration::from_millis(250);

/// Most trials of a batch: they are in memory.
const MOST_BATCH: usize = 2048;

/// Stored trials that are run again before a study goes on, to see that this program computes the same.
const SPOT_CHECKS: usize = 32;

/// Runs a shard of a scenario into a folder, or what is missing of it; returns what is stored.
///
/// Fails when the folder holds another study, when its rows are not what this program computes, and when it is
/// interrupted; what was stored stays.
pub fn collect(
    scenario: &Scenario,
    shard: Shard,
    folder: &ResultFolder,
    restart: bool,
    observer: &dyn Observer,
) -> Result<StoredStudy, Failure> {
    let manifest = Manifest::new(scenario, shard);
    if restart {
        discard(folder, observer)?;
    }
    let keep = || sources::keep(scenario, folder);
    if let Some(stored) = store::manifest_of_rows(folder.path())? {
        is_same(&stored, &manifest, folder.path(), ANOTHER_FOLDER)?;
        keep()?;
        let outside = RunningEstimators::begin(scenario, folder, observer)?;
        let stored = look_again(scenario, manifest, folder, observer);
        outside.tell(observer);
        return stored;
    }
    let design = Design::of(scenario);
    let layout = RowLayout::of(&design);
    let rows = folder.path().join(files::ROWS);
    if let Some(stored) = unfinished::manifest_in(folder.path())? {
        is_same(&stored, &manifest, folder.path(), ANOTHER_FOLDER)?;
    } else if disk::is_there(&rows).on("look for", &rows)? {
        return Err(Failure::input(format!(
            "{} holds rows of an unknown study, without {}; give another folder with --out, or --restart to discard them",
            folder.path().display(),
            files::MANIFEST
        )));
    }
    keep()?;
    let outside = RunningEstimators::begin(scenario, folder, observer)?;
    let mut plan = TrialPlan::new(scenario, shard);
    let mut unfinished = Unfinished::open(folder, manifest, &design, &layout, observer)?;
    let mut spots = SpotCheck::new(scenario, folder.path());
    unfinished.resume(&mut plan, |row| spots.see(row))?;
    spots.finish()?;
    let resumed = plan.most() - plan.left();
    if resumed > 0 {
        observer.note(&format!("going on after {resumed} of {} trials in {}", plan.most(), folder.path().display()));
    }
    run_all(scenario, &outside, &mut plan, &mut unfinished, folder.path(), observer)?;
    finish(scenario, &plan, unfinished, folder)
}

/// A finished study that is run again: its rows are looked at, and its words may have changed.
fn look_again(
    scenario: &Scenario,
    manifest: Manifest,
    folder: &ResultFolder,
    observer: &dyn Observer,
) -> Result<StoredStudy, Failure> {
    let study = StoredStudy::held(folder)?;
    let mut spots = SpotCheck::new(scenario, folder.path());
    study.rows(|row| spots.see(row))?;
    spots.finish()?;
    let stored = &study.manifest;
    // What a kill in the last moment left.
    unfinished::discard(folder, observer)?;
    let told = Manifest {
        machine: stored.machine.clone(),
        git_revision: stored.git_revision.clone(),
        git_dirty: stored.git_dirty,
        ..manifest
    };
    let design = study.design.told_by(scenario);
    study.told_again(told, design, folder)
}

/// Everything of a study in a folder, thrown away on request.
fn discard(folder: &ResultFolder, observer: &dyn Observer) -> Result<(), Failure> {
    unfinished::discard(folder, observer)?;
    let rows = folder.path().join(files::ROWS);
    disk::remove_if_there(&rows).on("remove", &rows)
}

/// What helps where a study is to be run in a folder with rows of another one.
const ANOTHER_FOLDER: &str = "give another folder with --out, or --restart to discard what is there";

/// Refuses a folder whose rows belong to another study, and says what differs and what helps.
pub fn is_same(stored: &Manifest, own: &Manifest, folder: &Path, cure: &str) -> Result<(), Failure> {
    let differences = stored.differences(own);
    if differences.is_empty() {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{} holds rows of another study (there: what is stored, here: what is asked for):\n  {}\n{cure}",
        folder.display(),
        differences.join("\n  ")
    )))
}

/// How a run of trials ended.
#[derive(Debug, Clone, PartialEq, Eq)]
enum RunEnd {
    /// All were run, or nobody takes more.
    Done,
    /// It was asked to stop, and no trial is under way.
    Interrupted,
    /// It was asked to stop, and a trial under way does not end.
    Stuck,
    /// No trial can be run here and now, and why.
    Trouble(String),
}

/// Runs what is left of a plan; rows go to a writer of their own while the next trials run.
fn run_all(
    scenario: &Scenario,
    outside: &RunningEstimators,
    plan: &mut TrialPlan,
    unfinished: &mut Unfinished,
    folder: &Path,
    observer: &dyn Observer,
) -> Result<(), Failure> {
    observer.begin(plan.most(), plan.most() - plan.left());
    std::thread::scope(|scope| {
        // One batch may wait while one is written and one runs: memory stays what it is.
        let (send, receive) = sync_channel::<Vec<TrialOutcome>>(1);
        let writer = scope.spawn(move || unfinished.store(receive));
        let take = |outcomes| send.send(outcomes).is_ok();
        let run = |tasks| {
            let outcomes = watched(scope, scenario, tasks, observer);
            outside.tell(observer);
            outcomes
        };
        let end = run_batches(plan, run, take);
        drop(send);
        let written = writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        observer.end();
        let stopped = |why: &str| {
            Failure::work(format!(
                "{why}stopped after {} of {} trials; their rows are kept in {}, and the same command goes on from there, without --restart",
                plan.most() - plan.left(),
                plan.most(),
                folder.join(unfinished::NAME).display()
            ))
        };
        match end {
            RunEnd::Done => written,
            RunEnd::Interrupted => written.and_then(|()| Err(stopped(""))),
            RunEnd::Trouble(why) => {
                let advice = "check that it may be executed, and the limits on open files and processes (`ulimit -a`)";
                written.and_then(|()| Err(stopped(&format!("{why}; {advice}; "))))
            }
            RunEnd::Stuck => {
                let failure = written.err().unwrap_or_else(|| stopped(""));
                observer.give_up(&failure);
                Err(failure)
            }
        }
    })
}

/// Time after which a trial that is under way when the study is asked to stop is not waited for any more.
const PATIENCE: Duration = Duration::from_millis(200);

/// Time between two looks whether the study is asked to stop.
const LOOK: Duration = Duration::from_millis(20);

/// Runs batch after batch by `run` until the plan is done, a batch is not whole, or `take` wants no more.
fn run_batches(
    plan: &mut TrialPlan,
    mut run: impl FnMut(Vec<Task>) -> (Vec<TrialOutcome>, RunEnd),
    mut take: impl FnMut(Vec<TrialOutcome>) -> bool,
) -> RunEnd {
    let least = (4 * rayon::current_num_threads()).min(MOST_BATCH);
    let mut size = least;
    loop {
        let tasks = plan.next(size as u64);
        if tasks.is_empty() {
            return RunEnd::Done;
        }
        let start = Instant::now();
        let (outcomes, end) = run(tasks.clone());
        outcomes.iter().flat_map(|outcome| &outcome.rows).for_each(|row| plan.saw(row));
        if let Some(&next) = tasks.get(outcomes.len()) {
            plan.go_back_to(next);
        }
        if !take(outcomes) || end != RunEnd::Done {
            return end;
        }
        let wanted = size as f64 * BATCH_TIME.as_secs_f64() / start.elapsed().as_secs_f64().max(1e-6);
        size = (wanted as usize).clamp(least, MOST_BATCH);
    }
}

/// What runs tasks, which come in order.
fn runner<'a>(scenario: &'a Scenario, tasks: &[Task]) -> TrialRunner<'a> {
    TrialRunner::new(scenario, tasks[0].cell..=tasks[tasks.len() - 1].cell)
}

/// Runs a batch on a thread of its own, so that an interruption need not wait for a trial that does not end. Returns
/// the outcomes up to the first that is missing.
fn watched<'scope>(
    scope: &'scope Scope<'scope, '_>,
    scenario: &'scope Scenario,
    tasks: Vec<Task>,
    observer: &'scope dyn Observer,
) -> (Vec<TrialOutcome>, RunEnd) {
    let mut outcomes: Vec<Option<TrialOutcome>> = tasks.iter().map(|_| None).collect();
    let (send, receive) = channel();
    scope.spawn(move || {
        let runner = runner(scenario, &tasks);
        let run = || {
            tasks.par_iter().enumerate().for_each_with(send, |send, (index, &task)| {
                if observer.is_asked_to_stop() || runner.trouble().is_some() {
                    return;
                }
                let outcome = runner.run(task);
                let outcome = runner.trouble().map_or(Ok((index, outcome)), |trouble| Err(trouble.to_owned()));
                // Nobody receives any more when the wait for a trial was given up.
                let _ = send.send(outcome);
            });
        };
        match observer.threads() {
            Some(threads) => threads.install(run),
            None => run(),
        }
    });
    let mut asked: Option<Instant> = None;
    let mut trouble = None;
    let is_stuck = loop {
        match receive.recv_timeout(LOOK) {
            Ok(Ok((index, outcome))) => {
                outcomes[index] = Some(outcome);
                observer.advance();
            }
            Ok(Err(why)) => trouble = Some(RunEnd::Trouble(why)),
            Err(RecvTimeoutError::Disconnected) => break false,
            Err(RecvTimeoutError::Timeout) if observer.is_asked_to_stop() => {
                if asked.get_or_insert_with(Instant::now).elapsed() >= PATIENCE {
                    break true;
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
    };
    let is_whole = outcomes.iter().all(Option::is_some);
    let end = match (is_stuck, is_whole) {
        (true, _) => RunEnd::Stuck,
        (false, false) => RunEnd::Interrupted,
        (false, true) => RunEnd::Done,
    };
    (outcomes.into_iter().map_while(|outcome| outcome).collect(), trouble.unwrap_or(end))
}

/// All rows of a small study, in their order, without a folder; and its design.
pub fn in_memory(scenario: &Scenario) -> (Design, Vec<StudyRow>) {
    let mut rows = Vec::new();
    let run = |tasks: Vec<Task>| {
        let runner = runner(scenario, &tasks);
        (tasks.par_iter().map(|&task| runner.run(task)).collect(), RunEnd::Done)
    };
    let take = |outcomes: Vec<TrialOutcome>| {
        rows.extend(outcomes.into_iter().flat_map(|outcome| outcome.rows));
        true
    };
    run_batches(&mut TrialPlan::new(scenario, Shard::WHOLE), run, take);
    let mut design = Design::of(scenario);
    rows.iter().for_each(|row: &StudyRow| design.cells[row.cell as usize].trials.end = row.replicate + 1);
    add_bounds(scenario, &mut design, |_| true);
    (design, rows)
}

/// Adds the Cramér–Rao bounds of some cells.
fn add_bounds(scenario: &Scenario, design: &mut Design, is_wanted: impl Fn(usize) -> bool + Sync) {
    let wanted = design.cells.par_iter_mut().enumerate().filter(|(cell, _)| is_wanted(*cell));
    wanted.for_each(|(cell, facts)| facts.bound_percent2 = engine::bound_percent2(scenario, cell));
}

/// Makes the result folder whole: rows, facts of the cells, showcases, times, and the manifest last.
fn finish(
    scenario: &Scenario,
    plan: &TrialPlan,
    unfinished: Unfinished,
    folder: &ResultFolder,
) -> Result<StoredStudy, Failure> {
    let rows_sha256 = unfinished.join(folder)?;
    let own = |cell: usize| plan.holds(Task { cell, replicate: 0 });
    let mut design = unfinished.design.clone();
    add_bounds(scenario, &mut design, own);
    let shown = if scenario.words.output.showcase { scenario.cells.len() } else { 0 };
    let shown = (0..shown).into_par_iter().filter(|&cell| own(cell));
    let showcases: Vec<_> = shown.filter_map(|cell| showcase::of_cell(scenario, cell)).collect();
    let stored = store::finish(folder, &unfinished.manifest, rows_sha256, design, showcases, &unfinished.timings)?;
    unfinished.remove()?;
    Ok(stored)
}

/// Runs some of the stored trials again: rows of a program that computes something else must not be mixed with new
/// ones.
struct SpotCheck<'a> {
    scenario: &'a Scenario,
    folder: &'a Path,
    every: usize,
    kept: BTreeMap<Task, Vec<StudyRow>>,
}

impl<'a> SpotCheck<'a> {
    fn new(scenario: &'a Scenario, folder: &'a Path) -> Self {
        let every = scenario.cells.len().div_ceil(SPOT_CHECKS);
        Self { scenario, folder, every, kept: BTreeMap::new() }
    }

    /// Keeps the first trial of some cells.
    fn see(&mut self, row: StudyRow) -> Result<(), Failure> {
        let task = Task { cell: row.cell as usize, replicate: row.replicate };
        if task.cell.is_multiple_of(self.every) && (task.replicate == 0 || self.kept.is_empty())
            || self.kept.contains_key(&task)
        {
            self.kept.entry(task).or_default().push(row);
        }
        Ok(())
    }

    fn finish(self) -> Result<(), Failure> {
        let differs = self.kept.par_iter().find_first(|(task, rows)| {
            TrialRunner::new(self.scenario, task.cell..=task.cell).run(**task).rows != **rows
        });
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
