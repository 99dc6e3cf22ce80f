//! Simulated trials as records that other commands read, each with its true values.

use campaign::engine;
use campaign::failure::Failure;
use campaign::outside_estimates::numbered_record_name;
use campaign::scenario::Scenario;
use campaign::scenario::problem::suggestion;
use campaign::shard::TrialId;
use simulate::SimulatedTrial;

use crate::documents::truth::truth_document;
use crate::options::{Replicates, SimulateRequest};

/// Maximum number of trials of one call; more are a study, which stores its trials as rows.
const MAX_RECORDS: u64 = 100_000;

/// Requested trials, in their order.
///
/// Fails if the trials are measured records, if no such cell or trial exists, or if there are too many trials.
pub fn requested_trials(scenario: &Scenario, request: &SimulateRequest) -> Result<Vec<TrialId>, Failure> {
    if scenario.cells.iter().any(|cell| cell.record_set().is_some()) {
        let problem = "its trials are measured records, and nothing is simulated; give a scenario with a ship";
        return Err(Failure::in_file(&request.scenario, problem));
    }
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
    if count > MAX_RECORDS {
        return Err(Failure::input(format!(
            "{count} records would be written, expected at most {MAX_RECORDS}; name a cell with --cell or a trial with --replicate"
        )));
    }
    Ok(cells.flat_map(|cell| replicates.clone().map(move |replicate| TrialId { cell, replicate })).collect())
}

/// Files of a simulated record.
pub struct RecordFiles {
    /// Name of the record.
    pub name: String,
    /// The record, as CSV.
    pub record_csv: Vec<u8>,
    /// Its sidecar, with the declared calm, length and speed of the ship and noise of the instruments, which the CSV
    /// does not hold; `None` without any of these.
    pub sidecar_toml: Option<String>,
    /// Its true values, as JSON.
    pub truth_json: String,
}

/// Records of one trial; the first has the name `name`, further ones of the same ship are numbered.
///
/// Fails if the trial cannot be simulated.
pub fn simulate_record_files(scenario: &Scenario, task: TrialId, name: &str) -> Result<Vec<RecordFiles>, Failure> {
    let refuse = |error: String| {
        Failure::execution(format!(
            "trial {} of cell {} of {} cannot be made: {error}",
            task.replicate, task.cell, scenario.name
        ))
    };
    let simulated = engine::simulate(scenario, task).map_err(refuse)?;
    let truths = engine::true_responses(scenario, task).map_err(refuse)?;
    let files = |(number, simulated): (usize, &SimulatedTrial)| {
        let mut record_csv = Vec::new();
        trial::write_csv(&simulated.trial, &mut record_csv).map_err(|error| error.to_string())?;
        let truth = truth_document(scenario, task, simulated, truths)?;
        let truth_json = serde_json::to_string(&truth).map_err(|error| error.to_string())? + "\n";
        let sidecar_toml = trial::writer::sidecar_toml(&simulated.trial);
        Ok(RecordFiles { name: numbered_record_name(name, number), record_csv, sidecar_toml, truth_json })
    };
    simulated.iter().enumerate().map(files).collect::<Result<_, String>>().map_err(refuse)
}
