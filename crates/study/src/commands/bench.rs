//! `study bench`: the benchmark on measured and simulated trials. Its studies run like any other study, and
//! `campaign::benchmark` computes the scores; this module writes tables, figures and files.

use std::path::PathBuf;
use std::sync::Arc;

use campaign::Observer;
use campaign::benchmark::cases::SkippedRecord;
use campaign::benchmark::{BenchDocument, BenchTask, embedded};
use campaign::collect::collect;
use campaign::failure::{Failure, OnPath};
use campaign::folder::ResultFolder;
use campaign::rows::StudyRow;
use campaign::scenario::Scenario;
use campaign::scenario::name::slug;
use campaign::scenario::problem::suggestion;
use clap::Args;
use clap::builder::StringValueParser;
use identify::Identifier;
use report::Theme;
use report::number::counted;

use crate::completed::{self, completed};
use crate::documents::{BENCH_FILE, folder_for};
use crate::options::{CommonOptions, FigureOptions};
use crate::screen::{self, CommandOutput};
use crate::terminal::Terminal;
use crate::views::page_files::{MARKDOWN_REPORT_FILE, write_page};
use crate::views::{bench_page, bench_tables};

/// Name of the table with one row for every answer.
const ROWS: &str = "answers.csv";

/// Name of the table of all leaderboards.
const LEADERBOARD: &str = "leaderboard.csv";

/// Folder with a page for every method.
const METHODS: &str = "methods";

/// Arguments of `study bench`.
#[derive(Debug, Clone, Args)]
pub struct BenchRequest {
    /// Scenarios of a benchmark of your own [default: those of scenarios/bench, which are part of the program]
    #[arg(value_name = "SCENARIO.toml")]
    pub scenarios: Vec<PathBuf>,
    /// Methods to compare [default: all]
    #[arg(long = "method", value_name = "LABEL", hide_possible_values = true,
        value_parser = completed(StringValueParser::new(), completed::scenario_method_names))]
    pub methods: Vec<String>,
    /// Tasks to score [default: all]
    #[arg(long = "task", value_name = "ID", hide_possible_values = true,
        value_parser = completed(task, completed::task_names))]
    pub tasks: Vec<BenchTask>,
    /// Names of the scenarios to run [default: all]
    #[arg(long = "set", value_name = "NAME")]
    pub sets: Vec<String>,
    /// Discard rows of an earlier run in the folder instead of continuing them
    #[arg(long)]
    pub restart: bool,
    /// How figures are drawn
    #[command(flatten)]
    pub style: FigureOptions,
}

fn task(name: &str) -> Result<BenchTask, String> {
    BenchTask::ALL.into_iter().find(|task| task.id() == name).ok_or_else(|| {
        let ids = BenchTask::ALL.map(BenchTask::id);
        format!("there is no such task; {}", suggestion(name, &ids))
    })
}

/// Methods of the caller, each with its label.
pub type CallerMethods = Vec<(String, Arc<dyn Identifier>)>;

/// Results of a benchmark, after its missing trials have run below `folder`, or below a temporary folder for `None`.
/// `methods_of_caller` run in addition to the methods of the scenarios.
///
/// Fails if a scenario is invalid, if a requested set or method does not exist, or if there is no case to score.
pub fn run_benchmark(
    request: &BenchRequest,
    seed: Option<u64>,
    methods_of_caller: &CallerMethods,
    folder: Option<&ResultFolder>,
    observer: &dyn Observer,
) -> Result<BenchDocument, Failure> {
    let desk = tempfile::tempdir().map_err(|error| Failure::execution(format!("failed to make a folder: {error}")))?;
    let paths = match &request.scenarios[..] {
        [] => embedded::unpack(desk.path())?,
        paths => paths.to_vec(),
    };
    let scenarios = paths.iter().map(|path| Scenario::read(path, seed)).collect::<Result<Vec<Scenario>, _>>()?;
    are_known(&request.sets, scenarios.iter().map(|scenario| scenario.name.as_str()), "--set", "scenario")?;
    are_known(&request.methods, scenarios.iter().flat_map(Scenario::method_labels), "--method", "method")?;
    let (mut studies, mut absent) = (Vec::new(), Vec::new());
    for scenario in scenarios.into_iter().filter(|set| request.sets.is_empty() || request.sets.contains(&set.name)) {
        let Some(mut scenario) = scenario.restricted_to_methods(&request.methods) else { continue };
        for (label, identifier) in methods_of_caller {
            scenario = scenario.with_identifier(label, Arc::clone(identifier))?;
        }
        if scenario.max_trials() == 0 {
            absent.push((scenario, Vec::new()));
            continue;
        }
        let folder = match folder {
            Some(folder) => folder.subfolder(&scenario.name)?,
            None => ResultFolder::make(&desk.path().join("rows").join(&scenario.name))?,
        };
        let mut rows: Vec<StudyRow> = Vec::new();
        collect(&scenario, &folder, request.restart, observer)?.for_each_row(|row| {
            rows.push(row);
            Ok(())
        })?;
        studies.push((scenario, rows));
    }
    studies.extend(absent);
    let results = BenchDocument::from_studies(&studies, &request.tasks);
    if results.cases.is_empty() {
        let reasons: Vec<String> = results.skipped.iter().map(skipped_record_line).collect();
        return Err(Failure::input(format!(
            "there is nothing to score:\n  {}\nset KEMPF_DATA to the folder with the measured records",
            reasons.join("\n  ")
        )));
    }
    Ok(results)
}

/// Fails for an option value that is not among the `names`.
fn are_known<'a>(
    asked: &[String],
    names: impl Iterator<Item = &'a str>,
    option: &str,
    kind: &str,
) -> Result<(), Failure> {
    let names: Vec<&str> = names.collect();
    match asked.iter().find(|word| !names.contains(&word.as_str())) {
        Some(word) => Err(Failure::input(format!("{option} {word}: no such {kind}; {}", suggestion(word, &names)))),
        None => Ok(()),
    }
}

/// Runs a benchmark, prints the leaderboards, writes `bench.json`, tables, pages and figures.
///
/// Fails as [`run_benchmark`] does, or if the results cannot be written.
pub fn run(request: &BenchRequest, common: &CommonOptions) -> Result<(), Failure> {
    let theme = request.style.theme()?;
    let place = common.out.clone().unwrap_or_else(|| PathBuf::from("results/bench"));
    let folder = ResultFolder::make(&folder_for(BENCH_FILE, &place)?)?;
    let results =
        run_benchmark(request, common.seed, &Vec::new(), Some(&folder), &Terminal::new("trials", common.quiet))?;
    write_results(&results, &folder, &theme, common)
}

/// Writes the tables, pages and figures of a benchmark and prints the leaderboards.
///
/// Fails if they cannot be written.
pub fn write_results(
    results: &BenchDocument,
    folder: &ResultFolder,
    theme: &Theme,
    common: &CommonOptions,
) -> Result<(), Failure> {
    let text = write_files(results, folder, theme)?;
    let notes: String =
        results.skipped.iter().map(|record| format!("skipped: {}\n", skipped_record_line(record))).collect();
    let notes = format!("\n{notes}report: {}", folder.path().join(MARKDOWN_REPORT_FILE).display());
    let naming = match results.naming.is_empty() {
        true => String::new(),
        false => format!("\n{}", bench_tables::naming_totals(results).to_text()),
    };
    let head = format!("{}\n", counted(results.cases.len() as u64, "question"));
    let table = bench_tables::joint_leaderboard_table(results);
    let output = CommandOutput { texts_around_table: [&head, &naming], table: &table, notes: &notes, document: &text };
    screen::print_output(common, &output, &[] as &[&str])
}

/// One line on a record that was not used.
pub fn skipped_record_line(record: &SkippedRecord) -> String {
    format!("{}, {}: {}", record.set, record.record, record.reason)
}

/// Writes all files, removes files of an earlier run that this one does not write, and returns the text of the
/// document.
fn write_files(results: &BenchDocument, folder: &ResultFolder, theme: &Theme) -> Result<String, Failure> {
    let text = results.to_json().on("describe", &folder.path().join(BENCH_FILE))?;
    folder.write_synced(BENCH_FILE, &text)?;
    folder.write(ROWS, bench_tables::answer_rows(results).to_csv())?;
    folder.write(LEADERBOARD, bench_tables::leaderboard_numbers(results).to_csv())?;
    let pages = folder.subfolder(METHODS)?;
    pages.remove_matching(|name| name.ends_with(".md"))?;
    for method in &results.methods {
        pages.write(&format!("{}.md", slug(method)), bench_page::method_page(results, method).to_markdown())?;
    }
    write_page(folder, bench_page::page(results), Some(theme)).map(|()| text)
}
