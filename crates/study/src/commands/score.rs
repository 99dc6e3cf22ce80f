//! `study score`: answers of an outside program, scored as further methods of the scenario of the trials.

use std::path::PathBuf;

use campaign::collect::collect;
use campaign::failure::Failure;
use campaign::folder::ResultFolder;
use campaign::outside_estimates::{self, TRIALS_FILE, TrialsDocument};
use campaign::scenario::Scenario;
use campaign::scenario::name;
use campaign::shard::default_result_folder;
use clap::Args;
use trial::file::{self, FileKind};

use crate::options::{CommonOptions, StudyFigureOptions};
use crate::terminal::Terminal;
use crate::views::publish::write_results;

/// Arguments of `study score`.
#[derive(Debug, Clone, Args)]
pub struct ScoreRequest {
    /// Answers to trials that `study simulate` wrote, with the columns record (or cell and replicate), K_per_s, T_s;
    /// optional: delta_r_deg, K_sd_per_s, T_sd_s, delta_r_sd_deg, failed; for several methods: method
    #[arg(value_name = "ANSWERS.csv")]
    pub answers: PathBuf,
    /// Scenario of the trials [default: that in trials.toml next to the answers]
    #[arg(long, value_name = "SCENARIO.toml")]
    pub scenario: Option<PathBuf>,
    /// Name of the method if the table has no column `method` [default: the name of the file]
    #[arg(long, value_name = "NAME")]
    pub label: Option<String>,
    /// Discard rows of an earlier run in the folder instead of continuing them
    #[arg(long)]
    pub restart: bool,
    /// How figures are drawn, and which
    #[command(flatten)]
    pub style: StudyFigureOptions,
}

/// Kind of file that describes trials, with its maximum size.
const LIST: FileKind = FileKind { name: "a description of trials", max_bytes: 1 << 22 };

/// Runs the methods of the scenario on its trials, adds the answers, and publishes all as `study SCENARIO` does.
///
/// Fails if the answers belong to trials other than those of the scenario.
pub fn run(request: &ScoreRequest, common: &CommonOptions) -> Result<(), Failure> {
    let scenario = scenario_of(request, common)?;
    let theme = request.style.style.theme()?;
    let terminal = Terminal::new("trials", common.quiet);
    let label = request.label.clone().map_or_else(|| name::study_name(&request.answers), Ok)?;
    let place = default_result_folder(&format!("{}-score", scenario.name));
    let answers = outside_estimates::read(&request.answers, &scenario, &terminal)?.into_iter();
    let add = |scenario: Scenario, (method, answers): (Option<String>, _)| {
        scenario.with_outside_estimates(method.as_deref().unwrap_or(&label), answers)
    };
    let scenario = answers.into_iter().try_fold(scenario, add)?;
    let folder = ResultFolder::make(common.out.as_deref().unwrap_or(&place))?;
    let stored = collect(&scenario, &folder, request.restart, &terminal)?;
    write_results(&stored, &folder, &theme, request.style.figures, common)
}

/// Scenario of the answers, with the seed of their trials.
///
/// Fails if no scenario is given or found next to the answers, or if it is not that of the trials.
fn scenario_of(request: &ScoreRequest, common: &CommonOptions) -> Result<Scenario, Failure> {
    let beside = request.answers.with_file_name(TRIALS_FILE);
    let scenario = match &request.scenario {
        Some(named) => named,
        None if beside.is_file() => &beside,
        None => {
            return Err(Failure::input(format!(
                "no scenario is given, and there is no {}; add --scenario SCENARIO.toml, or put the answers beside the trials",
                beside.display()
            )));
        }
    };
    if !beside.is_file() {
        return Scenario::read(scenario, common.seed);
    }
    let text = file::read_text(&beside, LIST).map_err(|error| Failure::in_file(&beside, error))?;
    let trials: TrialsDocument = toml::from_str(&text).map_err(|error| {
        Failure::in_file(&beside, format!("{}; expected what `study simulate` wrote", error.message()))
    })?;
    let scenario = Scenario::read(scenario, Some(common.seed.unwrap_or(trials.seed)))?;
    if (&scenario.design_sha256, scenario.seed) == (&trials.design_sha256, trials.seed) {
        return Ok(scenario);
    }
    Err(Failure::input(format!(
        "the trials beside {} are not those of the scenario: it was changed, has another seed, or lacks files beside it; give the \
         scenario they were simulated with (--scenario), or simulate them again",
        request.answers.display()
    )))
}
