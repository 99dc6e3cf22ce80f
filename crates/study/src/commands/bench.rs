//! `study bench`: the benchmark on measured and simulated trials. The numbers are made in `campaign::benchmark`; here
//! its tables, figures and files.

use std::env;
use std::path::PathBuf;

use campaign::Observer;
use campaign::benchmark::run::STOPPED;
use campaign::benchmark::{BenchDocument, BenchMethod, BenchTask, Definition, RecordStore};
use campaign::failure::{Failure, OnPath};
use campaign::folder::ResultFolder;
use campaign::scenario::problem::suggestion;
use campaign::scenario::records::DATA;
use clap::Args;
use clap::builder::StringValueParser;
use report::Theme;
use report::number::counted;

use crate::completed::{self, completed};
use crate::documents::{BENCH, folder_for};
use crate::options::{Common, FigureOptions};
use crate::screen::{self, CommandOutput};
use crate::terminal::Terminal;
use crate::views::page_files::{REPORT, write_page};
use crate::views::{bench_page, bench_tables};

/// One row for every answer.
const ROWS: &str = "rows.csv";

/// The leaderboards as one table.
const LEADERBOARD: &str = "leaderboard.csv";

/// Folder with a page for every method.
const METHODS: &str = "methods";

/// Folder inside that of the results for those of a run that was stopped.
const UNFINISHED: &str = "unfinished";

/// What `study bench` is asked to do.
#[derive(Debug, Clone, Args)]
pub struct BenchRequest {
    /// Definition of a benchmark of your own [default: zigzag-bench, which is part of the program]
    #[arg(value_name = "BENCH.toml")]
    pub definition: Option<PathBuf>,
    /// Folder with measured records, at any depth [default: $KEMPF_DATA, or ./data]
    #[arg(long, value_name = "DIR")]
    pub data: Vec<PathBuf>,
    /// Methods that take part [default: all]
    #[arg(long = "method", value_name = "ID", hide_possible_values = true,
        value_parser = completed(StringValueParser::new(), completed::competitors))]
    pub methods: Vec<String>,
    /// Tasks that are set [default: all]
    #[arg(long = "task", value_name = "ID", hide_possible_values = true,
        value_parser = completed(task, completed::tasks))]
    pub tasks: Vec<BenchTask>,
    /// Sets of records that are used [default: all]
    #[arg(long = "set", value_name = "NAME")]
    pub sets: Vec<String>,
    /// How figures are drawn
    #[command(flatten)]
    pub style: FigureOptions,
}

fn task(name: &str) -> Result<BenchTask, String> {
    BenchTask::ALL.into_iter().find(|task| task.id() == name).ok_or_else(|| {
        let known = BenchTask::ALL.map(BenchTask::id);
        format!("there is no such task; {}", suggestion(name, &known))
    })
}

/// Has all methods of a request answer, and those of the caller's `own`. `begin` gets the name of the definition before
/// the first answer.
///
/// Fails when the definition is at fault, when a folder of records cannot be listed, and when nothing can be asked.
pub fn measure(
    request: &BenchRequest,
    seed: Option<u64>,
    own: Vec<BenchMethod>,
    observer: &dyn Observer,
    begin: impl FnOnce(&str) -> Result<(), Failure>,
) -> Result<BenchDocument, Failure> {
    let definition = match &request.definition {
        Some(path) => Definition::read(path, seed)?,
        None => Definition::published(seed)?,
    };
    let definition = definition.only(&request.sets, &request.tasks)?;
    let mut methods = methods(request)?;
    methods.extend(own);
    let store = RecordStore::search(&folders(&request.data), &definition)?;
    let begin = || begin(&definition.identity.name);
    let results = campaign::benchmark::run(&definition, &store, &methods, observer, begin)?;
    if results.cases.is_empty() {
        let reasons: Vec<String> = results.skipped.iter().map(skipped).collect();
        return Err(Failure::input(format!(
            "there is no question to ask:\n  {}\n--data names the folder with the measured records",
            reasons.join("\n  ")
        )));
    }
    Ok(results)
}

/// Runs a benchmark, prints the leaderboards, writes `bench.json`, tables, pages and figures.
///
/// Fails as [`measure`] does, and when the results cannot be written.
pub fn run(request: &BenchRequest, common: &Common) -> Result<(), Failure> {
    let theme = request.style.theme()?;
    let mut held = None;
    let begin = |name: &str| {
        let default = || PathBuf::from("results").join(if request.definition.is_none() { "bench" } else { name });
        held = Some(ResultFolder::make(&folder_for(BENCH, &common.out.clone().unwrap_or_else(default))?)?);
        Ok(())
    };
    let results = measure(request, common.seed, Vec::new(), &Terminal::new("fits", common.quiet), begin)?;
    let folder = held.expect("its place was seen to before the first answer");
    // What a person did not wait for must not take the place of a whole result.
    let is_stopped = results.skipped.iter().any(|one| one.reason == STOPPED);
    let aside = is_stopped.then(|| folder.inside(UNFINISHED)).transpose()?;
    let folder = aside.as_ref().unwrap_or(&folder);
    show(&results, folder, &theme, common)?;
    match is_stopped {
        true => Err(Failure::work(format!("{STOPPED}; what they all have is in {}", folder.path().display()))),
        false => Ok(()),
    }
}

/// Writes the tables, pages and figures of a benchmark and prints the leaderboards.
///
/// Fails when they cannot be written.
pub fn show(results: &BenchDocument, folder: &ResultFolder, theme: &Theme, common: &Common) -> Result<(), Failure> {
    let text = publish(results, folder, theme)?;
    let notes: String = results.skipped.iter().map(|one| format!("skipped: {}\n", skipped(one))).collect();
    let notes = format!("\n{notes}report: {}", folder.path().join(REPORT).display());
    let naming = match results.naming.is_empty() {
        true => String::new(),
        false => format!("\n{}", bench_tables::naming_totals(results).to_text()),
    };
    let head = format!("{}: {}\n", results.definition.name, counted(results.cases.len() as u64, "question"));
    let table = bench_tables::leaderboard(results);
    let output = CommandOutput { words: [&head, &naming], table: &table, notes: &notes, document: &text };
    screen::tell(common, &output, &[] as &[&str])
}

/// Who takes part: the methods of the project, or those of them that are named.
fn methods(request: &BenchRequest) -> Result<Vec<BenchMethod>, Failure> {
    let names = &request.methods;
    let mut methods = BenchMethod::ours();
    let known: Vec<String> = methods.iter().map(|method| method.label().to_owned()).collect();
    if let Some(unknown) = names.iter().find(|name| !known.contains(name)) {
        return Err(Failure::input(format!("--method {unknown}: no such method; {}", suggestion(unknown, &known))));
    }
    methods.retain(|method| names.is_empty() || names.iter().any(|name| name == method.label()));
    Ok(methods)
}

/// Where measured records are looked for.
fn folders(named: &[PathBuf]) -> Vec<PathBuf> {
    match (named, env::var_os(DATA)) {
        ([_, ..], _) => named.to_vec(),
        ([], Some(folder)) if !folder.is_empty() => vec![PathBuf::from(folder)],
        _ => Some(PathBuf::from("data")).filter(|folder| folder.is_dir()).into_iter().collect(),
    }
}

/// A record that was not used, in a line.
pub fn skipped(one: &campaign::benchmark::results::Skipped) -> String {
    format!("{}, {}: {}", one.set, one.record, one.reason)
}

/// Writes everything; what an earlier run left and this one does not make goes away. The text of the document.
fn publish(results: &BenchDocument, folder: &ResultFolder, theme: &Theme) -> Result<String, Failure> {
    let text = results.json().on("describe", &folder.path().join(BENCH))?;
    folder.keep(BENCH, &text)?;
    folder.write(ROWS, bench_tables::rows(results).to_csv())?;
    folder.write(LEADERBOARD, bench_tables::leaderboard_numbers(results).to_csv())?;
    let pages = folder.inside(METHODS)?;
    pages.remove_all(|name| name.ends_with(".md"))?;
    for method in &results.methods {
        pages.write(&format!("{method}.md"), bench_page::of_method(results, method).to_markdown())?;
    }
    write_page(folder, bench_page::page(results), Some(theme)).map(|()| text)
}
