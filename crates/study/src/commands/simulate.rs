//! `study simulate`: the trials of a scenario as records that `study fit` reads, with the true values of each, and in a
//! folder a list of the records that `study score` reads.

use std::path::Path;

use campaign::failure::{Failure, OnPath};
use campaign::folder::ResultFolder;
use campaign::outside_estimates::{TRIALS_FILE, TrialsDocument, numbered_record_name, record_name};
use campaign::scenario::Scenario;
use campaign::shard::TrialId;
use indicatif::ParallelProgressIterator;
use rayon::prelude::*;
use report::{Table, TableHead};

use super::reply;
use crate::documents::answers::SimulateAnswer;
use crate::options::{CommonOptions, SimulateRequest};
use crate::progress;
use crate::views::page_files::run_all_in_parallel;
use crate::work::simulate::{RecordFiles, requested_trials, simulate_record_files};

/// Simulates the requested trials and writes them, with the true values of each.
///
/// Fails if no such cell or trial exists, if several records are to become one file, or at the first trial that cannot
/// be simulated.
pub fn run(request: &SimulateRequest, common: &CommonOptions) -> Result<(), Failure> {
    let scenario = Scenario::read(&request.scenario, common.seed)?;
    let Some(out) = &common.out else {
        return Err(Failure::input("no output is given; add --out FILE.csv or --out DIR"));
    };
    let tasks = requested_trials(&scenario, request)?;
    let count: u64 = tasks.iter().map(|task| scenario.cells[task.cell].record_count() as u64).sum();
    let is_file = out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
    let (folder, names) = match (is_file, count) {
        (true, 1) => {
            let parent = out.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
            (ResultFolder::make(parent)?, vec![campaign::scenario::name::study_name(out)?])
        }
        (true, several) => {
            let cure = if tasks.len() == 1 { "" } else { ", or one trial with --cell and --replicate" };
            let problem = format!("--out {} is one file, and {several} records are asked for", out.display());
            return Err(Failure::input(format!("{problem}; name a folder{cure}")));
        }
        (false, _) => (ResultFolder::make(out)?, tasks.iter().map(|task| record_name(&scenario, *task)).collect()),
    };
    let bar = progress::bar("records", tasks.len() as u64, common.quiet);
    let work = tasks.par_iter().zip(&names).progress_with(bar);
    run_all_in_parallel(work.map(|(task, name)| write(&scenario, *task, name, &folder)))?;
    if !is_file {
        list(&scenario, &tasks, &names, &folder)?;
    }
    let file = |name: &String| folder.path().join(format!("{name}.csv")).display().to_string();
    let line = match (names.as_slice(), count) {
        ([name], 1) => file(name),
        _ => format!("{count} records in {}", folder.path().display()),
    };
    let files: Vec<String> = names.iter().map(file).collect();
    reply(common, &SimulateAnswer { records: count, files }, &line)
}

/// Writes the list that assigns records to trials, with all data needed to simulate the trials again.
fn list(scenario: &Scenario, tasks: &[TrialId], names: &[String], folder: &ResultFolder) -> Result<(), Failure> {
    let mut table = Table::new(TableHead::default().texts(["record", "cell", "label", "replicate", "also"]));
    for (task, name) in tasks.iter().zip(names) {
        let file = |number: usize| format!("{}.csv", numbered_record_name(name, number));
        let cell = &scenario.cells[task.cell];
        let also: Vec<String> = (1..cell.record_count()).map(file).collect();
        let (number, replicate) = (task.cell.to_string(), task.replicate.to_string());
        table.push([file(0), number, cell.title(), replicate, also.join(" ")]);
    }
    folder.write("trials.csv", table.to_csv())?;
    let text = toml::to_string(&TrialsDocument::from_scenario(scenario)).on("describe the trials in", folder.path())?;
    folder.write(TRIALS_FILE, format!("{SCORE}{text}"))
}

/// Comment on the first line of the description of the trials.
const SCORE: &str = "# `study score ANSWERS.csv` scores answers to these trials that lie beside this file.\n";

/// Writes the records of a trial, the sidecar of each record that needs one, and the true values.
fn write(scenario: &Scenario, task: TrialId, name: &str, folder: &ResultFolder) -> Result<(), Failure> {
    for RecordFiles { name, record_csv, sidecar_toml, truth_json } in simulate_record_files(scenario, task, name)? {
        folder.write(&format!("{name}.csv"), record_csv)?;
        if let Some(sidecar) = sidecar_toml {
            folder.write(&format!("{name}.trial.toml"), sidecar)?;
        }
        folder.write(&format!("{name}.truth.json"), truth_json)?;
    }
    Ok(())
}
