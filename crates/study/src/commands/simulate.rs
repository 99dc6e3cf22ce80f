//! `study simulate`: the trials of a scenario as records that `study fit` reads, with the truth beside each.

use std::path::{Path, PathBuf};

use campaign::engine::{self, Truths};
use campaign::folder::ResultFolder;
use campaign::task::Task;
use indicatif::ParallelProgressIterator;
use rayon::prelude::*;
use scenario::Scenario;
use scenario::failure::{Failure, OnPath};
use scenario::problem::suggestion;
use simulate::Simulated;

use crate::options::{Common, Replicates, SimulateRequest};
use crate::views::picture::{first_failure, slug};
use crate::views::truth_file::TruthFile;
use crate::{progress, screen};

/// Most records that one call writes: more are a study, which keeps them as rows.
const MOST_RECORDS: u64 = 100_000;

/// Simulates the trials that are asked for and writes them, with the truth of each.
///
/// Fails when no such cell or trial is there, when several records are to become one file, and with the first trial
/// that cannot be made.
pub fn run(request: &SimulateRequest, common: &Common) -> Result<(), Failure> {
    let scenario = Scenario::read(&request.scenario, common.seed)?;
    let Some(out) = &common.out else {
        return Err(Failure::input("no place for the records is given; add --out FILE.csv or --out DIR"));
    };
    let tasks = tasks(&scenario, request)?;
    let records: u64 = tasks.iter().map(|task| scenario.cells[task.cell].records() as u64).sum();
    let is_file = out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
    let (folder, names) = match (is_file, records) {
        (true, 1) => {
            let parent = out.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
            (ResultFolder::shared(parent)?, vec![scenario::name::of_file(out)?])
        }
        (true, several) => {
            return Err(Failure::input(format!(
                "--out {} is one file, and {several} records are asked for; name a folder, or one trial with --cell and \
                 --replicate",
                out.display()
            )));
        }
        (false, _) => (ResultFolder::hold(out)?, tasks.iter().map(|task| name_of(&scenario, *task)).collect()),
    };
    first_failure(
        tasks
            .par_iter()
            .zip(&names)
            .progress_with(progress::of("records", tasks.len() as u64, common.quiet))
            .map(|(task, name)| write(&scenario, *task, name, &folder)),
    )?;
    if common.quiet {
        return Ok(());
    }
    match (names.as_slice(), records) {
        ([name], 1) => screen::say(&format!("{}", folder.path().join(format!("{name}.csv")).display())),
        _ => screen::say(&format!("{records} records in {}", folder.path().display())),
    }
}

/// The trials that are asked for, in their order.
fn tasks(scenario: &Scenario, request: &SimulateRequest) -> Result<Vec<Task>, Failure> {
    let titles: Vec<String> = scenario.cells.iter().map(|cell| cell.title()).collect();
    let cells = match &request.cell {
        None => 0..titles.len(),
        Some(label) => {
            let cell = titles.iter().position(|title| title == label).ok_or_else(|| {
                let advice = match titles.as_slice() {
                    [only] if only.is_empty() => {
                        "leave --cell out: the scenario has one cell, without a label".to_owned()
                    }
                    titles => suggestion(label, &titles[..titles.len().min(20)]),
                };
                Failure::input(format!("--cell {label:?}: {} has no such cell; {advice}", request.scenario.display()))
            })?;
            cell..cell + 1
        }
    };
    let replicates = match request.replicate {
        Replicates::All => 0..scenario.replicates,
        Replicates::One(number) if number < scenario.replicates => number..number + 1,
        Replicates::One(number) => {
            return Err(Failure::input(format!(
                "--replicate {number}: {} has {} trials in a cell, which are counted from 0",
                request.scenario.display(),
                scenario.replicates
            )));
        }
    };
    let count = (cells.len() as u64).saturating_mul(replicates.end - replicates.start);
    if count > MOST_RECORDS {
        return Err(Failure::input(format!(
            "{count} records are asked for; expected at most {MOST_RECORDS}; name a cell with --cell or a trial with --replicate"
        )));
    }
    Ok(cells.flat_map(|cell| replicates.clone().map(move |replicate| Task { cell, replicate })).collect())
}

/// What the record of a trial is called in a folder: scenario, cell and number, as far as there are several.
fn name_of(scenario: &Scenario, task: Task) -> String {
    let mut name = scenario.name.clone();
    if scenario.cells.len() > 1 {
        name += &format!("-{:0width$}", task.cell, width = (scenario.cells.len() - 1).to_string().len());
        let title = slug(&scenario.cells[task.cell].title());
        if !title.is_empty() {
            name += &format!("-{title}");
        }
    }
    if scenario.replicates > 1 {
        name += &format!("-{:0width$}", task.replicate, width = (scenario.replicates - 1).to_string().len());
    }
    name
}

/// Writes the records of a trial, the sidecar of each where the ship has a length, and its truth.
fn write(scenario: &Scenario, task: Task, name: &str, folder: &ResultFolder) -> Result<(), Failure> {
    let refuse = |error: String| {
        Failure::work(format!(
            "trial {} of cell {} of {} cannot be made: {error}",
            task.replicate, task.cell, scenario.name
        ))
    };
    let records: Vec<Simulated> = engine::simulate(scenario, task).map_err(refuse)?;
    let truths: Truths = engine::truths(scenario, task).map_err(refuse)?;
    for (number, simulated) in records.iter().enumerate() {
        let name = if number == 0 { name.to_owned() } else { format!("{name}-also-{number}") };
        let truth = TruthFile::of(scenario, task, simulated, truths).map_err(refuse)?;
        write_record(simulated, &truth, &name, folder)?;
    }
    Ok(())
}

fn write_record(simulated: &Simulated, truth: &TruthFile, name: &str, folder: &ResultFolder) -> Result<(), Failure> {
    let path: PathBuf = folder.path().join(format!("{name}.csv"));
    let mut table = Vec::new();
    trial::write_csv(&simulated.trial, &mut table).on("write", &path)?;
    folder.write(&format!("{name}.csv"), table)?;
    if let Some(particulars) = simulated.trial.particulars() {
        let sidecar = format!("[ship]\nlength-m = {:?}\nspeed-m-s = {:?}\n", particulars.length, particulars.speed);
        folder.write(&format!("{name}.trial.toml"), sidecar)?;
    }
    let text = serde_json::to_string(truth).on("describe", &path)?;
    folder.write(&format!("{name}.truth.json"), text + "\n")
}
