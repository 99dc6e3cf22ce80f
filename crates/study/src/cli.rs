//! The command line: what a user may ask for, and which part of the study answers. It knows no hydrodynamics.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::LazyLock;

use crate::commands::{
    bench, check, doctor, find, fit, inspect, list, predict, report, run, schema, score, shell, sidecar, simulate,
    trace,
};
use crate::options::{Common, FindRequest, FitRequest, PredictRequest, RunRequest, SimulateRequest, TraceRequest};
use crate::{failures, interrupt, threads};
use campaign::failure::Failure;
use campaign::scenario::problem::suggestion;
use clap::error::ErrorKind;
use clap::{Args, CommandFactory, Parser, Subcommand};
use document::ErrorCode;

/// What `--version` tells.
static VERSION: LazyLock<String> = LazyLock::new(campaign::manifest::version);

/// Ship zig-zag trials: simulate them, identify K and T, benchmark the methods.
#[derive(Debug, Parser)]
#[command(name = "study", version = VERSION.as_str(), args_conflicts_with_subcommands = true, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// Scenario to run: trials, identification, tables, plots
    #[arg(value_name = "SCENARIO.toml")]
    scenario: Option<PathBuf>,
    #[command(flatten)]
    request: RunRequest,
    #[command(flatten)]
    common: Common,
}

/// What is asked of a command, and what may be asked of all.
#[derive(Debug, Args)]
struct With<R: Args> {
    #[command(flatten)]
    request: R,
    #[command(flatten)]
    common: Common,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Identify a record with every (or the named) method: table, plot, fit.json
    Fit(With<FitRequest>),
    /// Close the loop on records: fit, look at what is left, name the effect the model lacks, add it: trace.json,
    /// report, plots
    Trace(With<TraceRequest>),
    /// Predict manoeuvres that were not made from fit.json or trace.json, with intervals: predict.json, report, plots
    Predict(With<PredictRequest>),
    /// List the manoeuvres inside long logs: zig-zags, turning circles, pull-outs, spirals, straight pieces
    Find(With<FindRequest>),
    /// Look at every channel of a log before anything is fitted: source, rate, gaps, steps, sign, scale, lag
    Inspect(With<inspect::InspectRequest>),
    /// Write a first description of the columns of a table, NAME.trial.toml beside it, for a person to check
    Sidecar(With<sidecar::SidecarRequest>),
    /// Write simulated trials in the format `study fit` reads, the truth beside them
    Simulate(With<SimulateRequest>),
    /// Score answers to simulated trials that another program found, beside the methods of the scenario
    Score(With<score::ScoreRequest>),
    /// Run the benchmark on measured and simulated trials: leaderboards, bench.json, report, plots
    Bench(With<bench::BenchRequest>),
    /// Resolve scenario files and run nothing
    Check(With<check::CheckRequest>),
    /// List what scenario files can name
    List(With<list::ListRequest>),
    /// Rebuild tables and plots of a study, a fit, a trace or a prediction from what is stored; nothing is simulated or
    /// fitted; of several studies also one page over them
    Report(With<report::ReportRequest>),
    /// Look at the machine and the terminal: versions, threads, instruction sets, whether files can be written
    Doctor(Common),
    /// Print the JSON schema of a file, for editors and programs
    Schema(With<schema::SchemaRequest>),
    /// Print what a shell has to read to complete commands and options
    Completions(With<shell::CompletionsRequest>),
    /// Write manual pages, one for every command
    Man(With<shell::ManRequest>),
}

impl<R: Args> With<R> {
    /// Runs a command that works on one thread.
    fn answer(&self, run: impl FnOnce(&R, &Common) -> Result<(), Failure>) -> Result<(), Failure> {
        run(&self.request, &self.common)
    }

    /// Runs a command that works on several.
    fn work(&self, run: impl FnOnce(&R, &Common) -> Result<(), Failure>) -> Result<(), Failure> {
        threads::start(&self.common)?;
        run(&self.request, &self.common)
    }
}

/// Runs the program and returns its exit code: 0 done, 1 the work could not be done, 2 the input is wrong, 130
/// Ctrl-C.
pub fn main() -> ExitCode {
    interrupt::of_program();
    let words: Vec<OsString> = std::env::args_os().collect();
    if asks_for_json(&words) {
        failures::tell_programs();
    }
    match parse(&words).and_then(answer) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => ExitCode::from(failures::fail(&failure)),
    }
}

/// Whether the answer is to be JSON, and with it what went wrong, be it in these very words.
fn asks_for_json(words: &[OsString]) -> bool {
    words.windows(2).any(|pair| pair[0] == "--format" && pair[1] == "json")
        || words.iter().any(|word| word == "--format=json")
}

/// What is asked for; help and version are told at once.
fn parse(words: &[OsString]) -> Result<Cli, Failure> {
    if let Some(name) = mistaken_command(words.get(1)) {
        let known: Vec<String> =
            Cli::command().get_subcommands().map(|command| command.get_name().to_owned()).collect();
        let advice = suggestion(&name, &known);
        return Err(Failure::input(format!(
            "there is no command `{name}`, and no scenario file of that name; {advice}"
        ))
        .with_code(ErrorCode::Usage));
    }
    Cli::try_parse_from(words).map_err(|usage| match usage.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            usage.exit()
        }
        _ if failures::is_for_programs() => misused(&usage),
        // By the same way as all other messages: an argument may hold anything.
        _ => Failure::input(usage.render().to_string().trim_end().trim_start_matches("error: ")),
    })
}

/// What is wrong with options, without how the command is used.
pub fn misused(usage: &clap::Error) -> Failure {
    let said = usage.to_string();
    let (said, _) = said.split_once("\n\nUsage:").unwrap_or((&said, ""));
    let (said, _) = said.split_once("\n\nFor more information").unwrap_or((said, ""));
    Failure::input(said.trim().trim_start_matches("error: ")).with_code(ErrorCode::Usage)
}

/// A first argument that is a single word, and neither a command nor the path of anything.
fn mistaken_command(first: Option<&OsString>) -> Option<String> {
    let name = first?.clone().into_string().ok()?;
    let is_word = !name.is_empty() && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '-');
    let is_known = name.starts_with('-') || name == "help" || Cli::command().find_subcommand(&name).is_some();
    (is_word && !is_known && !Path::new(&name).exists()).then_some(name)
}

fn answer(cli: Cli) -> Result<(), Failure> {
    let Some(command) = cli.command else {
        let none = "no scenario is named; try `study scenarios/yukun.toml` or `study --help`";
        let scenario = cli.scenario.ok_or_else(|| Failure::input(none))?;
        threads::start(&cli.common)?;
        return run::run(&scenario, &cli.request, &cli.common);
    };
    match command {
        Command::Fit(own) => own.work(fit::run),
        Command::Trace(own) => own.work(trace::run),
        Command::Predict(own) => own.work(predict::run),
        Command::Simulate(own) => own.work(simulate::run),
        Command::Score(own) => own.work(score::run),
        Command::Bench(own) => own.work(bench::run),
        Command::Report(own) => own.work(report::run),
        Command::Find(own) => own.answer(find::run),
        Command::Inspect(own) => own.answer(inspect::run),
        Command::Sidecar(own) => own.answer(sidecar::run),
        Command::Check(own) => own.answer(check::run),
        Command::List(own) => own.answer(list::run),
        Command::Schema(own) => own.answer(schema::run),
        Command::Completions(own) => own.answer(|own, common| shell::completions(own, Cli::command(), common)),
        Command::Man(own) => own.answer(|own, common| shell::man(own, Cli::command(), common)),
        Command::Doctor(common) => doctor::run(&common),
    }
}
