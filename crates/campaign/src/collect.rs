//! Runner of the trials of a study or a shard. Stored trials are kept; missing trials are computed in parallel and
//! stored as they finish. When all rows are stored, the folder is completed as [`crate::store`] expects it.

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, channel, sync_channel};
use std::thread::Scope;
use std::time::{Duration, Instant};

use rayon::prelude::*;

use crate::block::Block;
use crate::block_store::{self, TrialBlockStore};
use crate::design::Design;
use crate::engine::{self, TrialOutcome, TrialRunner};
use crate::failure::Failure;
use crate::files;
use crate::folder::ResultFolder;
use crate::manifest::{Machine, Manifest};
use crate::observer::Observer;
use crate::plan::{TrialPlan, max_trials, shard_blocks};
use crate::rows::StudyRow;
use crate::scenario::records::DATA_FOLDER_VARIABLE;
use crate::scenario::{DesignCell, Scenario};
use crate::shard::{Shard, TrialId};
use crate::shared_fit;
use crate::showcase;
use crate::store::{self, StoredStudy};
use crate::timings::Timings;
use crate::writer::BlockWriter;

/// Target duration of a batch: long compared with the wait for its last trial, short compared with a second.
const BATCH_TIME: Duration = Duration::from_millis(250);

/// Maximum number of trials in a batch, all of which are held in memory.
const MAX_BATCH: usize = 2048;

/// Runs a scenario into a folder, except for trials that are stored there; returns the stored study.
///
/// Fails if the folder contains another study, if stored rows are of another version of the program and some are
/// missing, and on interruption; stored rows are kept.
pub fn collect(
    scenario: &Scenario,
    folder: &ResultFolder,
    restart: bool,
    observer: &dyn Observer,
) -> Result<StoredStudy, Failure> {
    let run = run(scenario, Shard::WHOLE, folder, restart, observer)?;
    if run.computed == 0 && run.manifest.is_finished() {
        let current = Manifest::new(scenario).with_program_and_machine(&run.manifest);
        if let Ok(stored) = StoredStudy::from_manifest(folder.path(), run.manifest.clone()) {
            let design = stored.design.with_renewed_descriptions(scenario);
            return stored.with_descriptions(current, design, folder);
        }
    }
    finish(scenario, run, folder)
}

/// Runs a shard of a scenario into a folder, which may hold other shards; returns the manifest.
///
/// Fails as [`collect`] does.
pub fn collect_shard(
    scenario: &Scenario,
    shard: Shard,
    folder: &ResultFolder,
    restart: bool,
    observer: &dyn Observer,
) -> Result<Manifest, Failure> {
    Ok(run(scenario, shard, folder, restart, observer)?.manifest)
}

/// Completes a study whose blocks are all in a folder, wherever they were computed; a finished study is only read.
///
/// Fails if blocks are missing; the message names the first.
pub fn complete(folder: &ResultFolder, observer: &dyn Observer) -> Result<StoredStudy, Failure> {
    let manifest = store::required_manifest(folder.path())?;
    if manifest.is_finished() {
        return StoredStudy::read(folder.path());
    }
    let scenario = Scenario::read(&folder.path().join(files::MANIFEST_FILE), None)?;
    check_same_study(&manifest, &Manifest::new(&scenario), folder.path())?;
    let design = Design::from_scenario(&scenario);
    let store = TrialBlockStore::new(folder.path(), &manifest, &design);
    let stored = store.stored_trials(|_| true, "its trials count as missing", observer)?;
    let read = |block: Block| store.reread(block);
    let mut plan = TrialPlan::new(&scenario, Shard::WHOLE, &stored, &read);
    if let Some(TrialId { cell, replicate }) = plan.peek()? {
        let path = store.path(Block::from_trial_id(TrialId { cell, replicate }));
        let problem = format!(
            "trial {replicate} of cell {cell} is not stored; run the study, or the shard that holds it, again, or copy \
             the file here"
        );
        return Err(Failure::in_file(&path, problem));
    }
    let trials = plan.cell_trial_counts;
    finish(&scenario, StudyRun { manifest, trials, computed: 0 }, folder)
}

/// Result of a run of a study or a shard.
struct StudyRun {
    manifest: Manifest,
    /// Number of trials of every cell.
    trials: Vec<u64>,
    /// Number of trials computed in this run.
    computed: u64,
}

/// Computes and stores the missing trials of a shard.
fn run(
    scenario: &Scenario,
    shard: Shard,
    folder: &ResultFolder,
    restart: bool,
    observer: &dyn Observer,
) -> Result<StudyRun, Failure> {
    let manifest = begin(scenario, folder, restart)?;
    let design = Design::from_scenario(scenario);
    let store = TrialBlockStore::new(folder.path(), &manifest, &design);
    let part = shard_blocks(scenario, shard);
    let most = max_trials(scenario, &part);
    if scenario.max_trials() == 0 {
        return Err(no_records(scenario));
    }
    let stored =
        store.stored_trials(|block| part.contains(&block.index(scenario)), "its trials are run again", observer)?;
    let before: u64 = stored.values().sum();
    let read = |block: Block| store.reread(block);
    let mut plan = TrialPlan::new(scenario, shard, &stored, &read);
    if plan.peek()?.is_none() {
        return Ok(StudyRun { manifest, trials: plan.cell_trial_counts, computed: 0 });
    }
    check_same_program(&manifest, &Manifest::new(scenario), folder.path())?;
    if before > 0 {
        observer.note(&format!("resuming after {before} of {most} trials in {}", folder.path().display()));
    }
    warn_of_records(scenario, observer);
    let start = Instant::now();
    let progress = Progress { most, before, folder: folder.path() };
    let computed = run_all(scenario, &mut plan, &store, &progress, observer);
    // Another process may have added the wall time of its shards meanwhile.
    let before = Manifest::read(&folder.path().join(files::MANIFEST_FILE))?.unwrap_or_else(|| manifest.clone());
    let wall_time_s = before.machine.wall_time_s + start.elapsed().as_secs_f64();
    let manifest = Manifest { machine: Machine { wall_time_s, ..manifest.machine }, ..manifest };
    manifest.write(folder)?;
    Ok(StudyRun { manifest, trials: plan.cell_trial_counts, computed: computed? })
}

/// Failure of a study of measured records without any usable record.
fn no_records(scenario: &Scenario) -> Failure {
    let absent = scenario.cells.iter().filter_map(DesignCell::record_set).flat_map(|set| &set.absent_files);
    let lines: Vec<String> = absent.map(|(file, reason)| format!("  {file}: {reason}")).collect();
    let advice = format!("put them beside the scenario, or name their folder in {DATA_FOLDER_VARIABLE}");
    Failure::input(format!("{}: none of its records can be used:\n{}\n{advice}", scenario.name, lines.join("\n")))
}

/// Warns of absent records and passes on the warnings of the reader, each text once.
fn warn_of_records(scenario: &Scenario, observer: &dyn Observer) {
    let mut seen = HashSet::new();
    for set in scenario.cells.iter().filter_map(DesignCell::record_set) {
        let absent = set.absent_files.iter().map(|(file, reason)| format!("{file} is left out: {reason}"));
        let warnings = absent.chain(set.warnings.iter().cloned());
        warnings.filter(|warning| seen.insert(warning.clone())).for_each(|warning| observer.warn(&warning));
    }
}

/// Manifest of the folder of a study before its run; written unless rows of the study are stored there.
fn begin(scenario: &Scenario, folder: &ResultFolder, restart: bool) -> Result<Manifest, Failure> {
    let current = Manifest::new(scenario);
    if !restart && let Some(stored) = store::manifest_of_rows(folder.path())? {
        check_same_study(&stored, &current, folder.path())?;
        return Ok(stored);
    }
    if restart {
        // The manifest is removed first: if the program stops here, the remaining rows belong to no study.
        folder.remove_matching(|name| [files::MANIFEST_FILE, files::LEGACY_ROWS_FILE].contains(&name))?;
        block_store::discard_blocks(folder)?;
    } else if block_store::has_blocks(folder.path())? {
        return Err(Failure::input(format!(
            "{} holds rows of an unknown study, without {}; put it back, give another folder with --out, or --restart \
             to discard them",
            folder.path().display(),
            files::MANIFEST_FILE
        )));
    }
    current.write(folder)?;
    Ok(current)
}

/// Refuses a folder whose rows belong to another study; the message lists the differences.
fn check_same_study(stored: &Manifest, current: &Manifest, folder: &Path) -> Result<(), Failure> {
    let differences = stored.differences(current);
    if differences.is_empty() {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{} holds rows of another study (there: stored, here: requested):\n  {}\n\
         give another folder with --out, or --restart to discard the stored rows",
        folder.display(),
        differences.join("\n  ")
    )))
}

/// Refuses to combine stored rows of another version of the program with new rows.
fn check_same_program(stored: &Manifest, current: &Manifest, folder: &Path) -> Result<(), Failure> {
    let [there, here] = [stored, current].map(Manifest::program_label);
    if there == here {
        return Ok(());
    }
    Err(Failure::input(format!(
        "the rows in {} were computed by another version of this program ({there}; this is {here}), and some are \
         missing; give another folder with --out, or --restart to run the study anew",
        folder.display()
    )))
}

/// Progress of a run, for messages.
struct Progress<'a> {
    /// Maximum number of trials, stored ones included.
    most: u64,
    /// Number of trials stored before the run.
    before: u64,
    folder: &'a Path,
}

/// End of a run of trials.
#[derive(Debug, Clone, PartialEq, Eq)]
enum RunEnd {
    /// All trials were run, or the receiver accepts no more.
    Done,
    /// Stopped on request; no trial is running.
    Interrupted,
    /// Stopped on request, but a running trial does not end.
    Stuck,
}

/// Runs the remaining trials of a plan while another thread writes their rows; returns the number of trials run.
fn run_all(
    scenario: &Scenario,
    plan: &mut TrialPlan,
    store: &TrialBlockStore,
    progress: &Progress,
    observer: &dyn Observer,
) -> Result<u64, Failure> {
    observer.begin(progress.most, progress.before);
    std::thread::scope(|scope| {
        // One batch waits while another is written and a third runs, which bounds memory.
        let (send, receive) = sync_channel::<Vec<TrialOutcome>>(1);
        let mut writer = BlockWriter::new(store, scenario);
        let writer = scope.spawn(move || writer.store(receive));
        let mut computed = 0;
        let take = |outcomes: Vec<TrialOutcome>| {
            computed += outcomes.len() as u64;
            send.send(outcomes).is_ok()
        };
        let end = run_batches(plan, |tasks| watched(scope, scenario, tasks, observer), take);
        drop(send);
        let written = writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        observer.end();
        let stopped = || {
            Failure::interrupted(format!(
                "stopped after {} of {} trials; their rows are kept in {}; to resume, repeat the command without \
                 --restart",
                progress.before + computed,
                progress.most,
                progress.folder.join(files::ROWS_FOLDER).display()
            ))
        };
        match end? {
            RunEnd::Done => written.map(|()| computed),
            RunEnd::Interrupted => written.and_then(|()| Err(stopped())),
            RunEnd::Stuck => {
                let failure = written.err().unwrap_or_else(stopped);
                observer.on_unstoppable_trial(&failure);
                Err(failure)
            }
        }
    })
}

/// Maximum wait for running trials after a request to stop.
const MAX_STOP_WAIT: Duration = Duration::from_millis(200);

/// Interval at which a request to stop is polled.
const STOP_POLL_INTERVAL: Duration = Duration::from_millis(20);

/// Runs batches until the plan is done, a batch is incomplete, or `take` accepts no more.
fn run_batches(
    plan: &mut TrialPlan,
    mut run: impl FnMut(Vec<TrialId>) -> (Vec<TrialOutcome>, RunEnd),
    mut take: impl FnMut(Vec<TrialOutcome>) -> bool,
) -> Result<RunEnd, Failure> {
    let least = (4 * rayon::current_num_threads()).min(MAX_BATCH);
    let mut size = least;
    loop {
        let tasks = plan.next_trials(size as u64)?;
        if tasks.is_empty() {
            return Ok(RunEnd::Done);
        }
        let start = Instant::now();
        let (outcomes, end) = run(tasks);
        outcomes.iter().flat_map(|outcome| &outcome.rows).for_each(|row| plan.add(row));
        if !take(outcomes) || end != RunEnd::Done {
            return Ok(end);
        }
        let wanted = size as f64 * BATCH_TIME.as_secs_f64() / start.elapsed().as_secs_f64().max(1e-6);
        size = (wanted as usize).clamp(least, MAX_BATCH);
    }
}

/// Runner for a batch of tasks, which are in order.
fn runner<'a>(scenario: &'a Scenario, tasks: &[TrialId]) -> TrialRunner<'a> {
    TrialRunner::new(scenario, tasks[0].cell..=tasks[tasks.len() - 1].cell)
}

/// Runs a batch on a separate thread, so that an interruption need not wait for a trial without end. Returns the
/// outcomes up to the first missing one, and how the batch ended.
fn watched<'scope>(
    scope: &'scope Scope<'scope, '_>,
    scenario: &'scope Scenario,
    tasks: Vec<TrialId>,
    observer: &'scope dyn Observer,
) -> (Vec<TrialOutcome>, RunEnd) {
    let mut outcomes: Vec<Option<TrialOutcome>> = tasks.iter().map(|_| None).collect();
    let (send, receive) = channel();
    scope.spawn(move || {
        let runner = runner(scenario, &tasks);
        let run = || {
            shared_fit::fit_groups(scenario, &tasks).into_par_iter().for_each_with(send, |send, unit| {
                if !observer.should_stop() {
                    for (index, outcome) in unit.clone().zip(shared_fit::run_group(&runner, scenario, &tasks[unit])) {
                        // The receiver is dropped after the wait for a trial was given up.
                        let _ = send.send((index, outcome));
                    }
                }
            });
        };
        match observer.threads() {
            Some(threads) => threads.install(run),
            None => run(),
        }
    });
    let mut asked: Option<Instant> = None;
    let is_stuck = loop {
        match receive.recv_timeout(STOP_POLL_INTERVAL) {
            Ok((index, outcome)) => {
                outcomes[index] = Some(outcome);
                observer.advance();
            }
            Err(RecvTimeoutError::Disconnected) => break false,
            Err(RecvTimeoutError::Timeout) if observer.should_stop() => {
                if asked.get_or_insert_with(Instant::now).elapsed() >= MAX_STOP_WAIT {
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
    (outcomes.into_iter().map_while(|outcome| outcome).collect(), end)
}

/// Design and rows, in order, of a small study that is run without a folder.
pub fn collect_in_memory(scenario: &Scenario) -> (Design, Vec<StudyRow>) {
    let mut rows = Vec::new();
    let run = |tasks: Vec<TrialId>| {
        let runner = runner(scenario, &tasks);
        let units = shared_fit::fit_groups(scenario, &tasks).into_par_iter();
        (units.flat_map_iter(|unit| shared_fit::run_group(&runner, scenario, &tasks[unit])).collect(), RunEnd::Done)
    };
    let take = |outcomes: Vec<TrialOutcome>| {
        rows.extend(outcomes.into_iter().flat_map(|outcome| outcome.rows));
        true
    };
    let none = HashMap::new();
    let mut plan = TrialPlan::new(scenario, Shard::WHOLE, &none, &|_| Ok(Vec::new()));
    run_batches(&mut plan, run, take).expect("nothing is read");
    (designed(scenario, &plan.cell_trial_counts), rows)
}

/// Design with the number of trials of every cell, and with the Cramér–Rao bounds of the cells.
fn designed(scenario: &Scenario, trials: &[u64]) -> Design {
    let mut design = Design::from_scenario(scenario);
    design.cells.iter_mut().zip(trials).for_each(|(cell, trials)| cell.stored_replicates = 0..*trials);
    add_bounds(scenario, &mut design);
    design
}

/// Sets the Cramér–Rao bounds of K and T, %², of every cell.
fn add_bounds(scenario: &Scenario, design: &mut Design) {
    let cells = design.cells.par_iter_mut().enumerate();
    cells.for_each(|(cell, facts)| facts.cramer_rao_percent2 = engine::cramer_rao_percent2(scenario, cell));
}

/// Completes the result folder: facts of the cells, showcases, timings, and the manifest last.
fn finish(scenario: &Scenario, run: StudyRun, folder: &ResultFolder) -> Result<StoredStudy, Failure> {
    let design = designed(scenario, &run.trials);
    let shown = if scenario.prose.output.showcase { scenario.cells.len() } else { 0 };
    let showcases = (0..shown).into_par_iter().filter_map(|cell| showcase::from_cell(scenario, cell)).collect();
    let mut timings = Timings::default();
    let store = TrialBlockStore::new(folder.path(), &run.manifest, &design);
    for (block, _) in store.design_blocks() {
        timings.merge(&store.timings(block)?);
    }
    store::finish(folder, run.manifest, design, showcases, &timings)
}
