//! `study check`: resolve scenario files, run nothing.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::documents;
use crate::documents::answers::{CheckAnswer, CheckedScenario};
use crate::options::{CommonOptions, Format};
use crate::screen;
use campaign::failure::Failure;
use campaign::scenario::Scenario;
use report::number::counted;
use simulate::Assumption;

/// Arguments of `study check`.
#[derive(Debug, Clone, Args)]
pub struct CheckRequest {
    /// Scenario files
    #[arg(required = true, value_name = "SCENARIO.toml")]
    pub scenarios: Vec<PathBuf>,
    /// Print every scenario completely, as TOML; defaults are marked
    #[arg(long)]
    pub resolved: bool,
}

/// Resolves every file and prints one line for each valid one, with a note if its rudder moves instantly; with
/// `resolved` the whole scenario below it. Fails with a message that lists all invalid files.
pub fn run(request: &CheckRequest, common: &CommonOptions) -> Result<(), Failure> {
    let resolved = request.resolved;
    let (mut wrong, mut right) = (Vec::new(), Vec::new());
    for path in &request.scenarios {
        match Scenario::read(path, common.seed) {
            Ok(_) if common.is_silent() => {}
            Ok(scenario) if common.format == Format::Json => right.push(entry(path, &scenario, resolved)),
            Ok(scenario) if resolved => {
                let summary: String = summary(path, &scenario).lines().map(|line| format!("# {line}\n")).collect();
                screen::print_lines(&format!("{summary}\n{}", scenario.resolved()))?;
            }
            Ok(scenario) => screen::print_lines(&summary(path, &scenario))?,
            Err(failure) => wrong.push(failure),
        }
    }
    if common.format == Format::Json {
        documents::print_document(&CheckAnswer { scenarios: right, wrong: wrong.len() })?;
    }
    let mut wrong = wrong.into_iter();
    let Some(first) = wrong.next() else { return Ok(()) };
    let more: String = wrong.map(|failure| format!("\n\n{failure}")).collect();
    Err(Failure { message: format!("{}{more}", first.message), ..first })
}

/// Document entry of a valid scenario.
fn entry(path: &Path, scenario: &Scenario, resolved: bool) -> CheckedScenario {
    CheckedScenario {
        file: path.display().to_string(),
        name: scenario.name.clone(),
        question: scenario.prose.question.trim().to_owned(),
        seed: scenario.seed,
        design_sha256: scenario.design_sha256.clone(),
        replicates: scenario.replicates,
        cells: scenario.cells.iter().map(|cell| cell.labels.clone()).collect(),
        methods: scenario.method_names(),
        assumptions: scenario.influential_defaults().into_iter().map(|(_, sentence)| sentence).collect(),
        resolved: resolved.then(|| scenario.resolved().parse().expect("it has been resolved")),
    }
}

/// Size of a scenario, and a note below it if the rudder moves instantly, which is rarely intended and true of no ship.
fn summary(path: &Path, scenario: &Scenario) -> String {
    let size = format!(
        "{}: {}, {}, {} each",
        path.display(),
        counted(scenario.cells.len() as u64, "cell"),
        counted(scenario.method_labels().count() as u64, "method"),
        counted(scenario.replicates, "trial"),
    );
    let mut defaults = scenario.influential_defaults().into_iter();
    let instant = defaults.find(|(assumption, _)| *assumption == Assumption::InstantRudder);
    size + &instant.map(|(_, note)| format!("\n  note: {note}")).unwrap_or_default()
}
