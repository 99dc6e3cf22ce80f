//! The command line: commands with their options, and the modules that run them. No hydrodynamics here.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::LazyLock;

use crate::commands::{
    bench, check, doctor, find, fit, inspect, list, predict, report, run, schema, score, shell, sidecar, simulate,
    trace,
};
use crate::options::{
    CommonOptions, FindRequest, FitRequest, PredictRequest, RunRequest, SimulateRequest, TraceRequest,
};
use crate::{failures, interrupt, threads};
use campaign::failure::Failure;
use campaign::scenario::problem::suggestion;
use clap::error::ErrorKind;
use clap::{Args, CommandFactory, Parser, Subcommand};
use document::ErrorCode;

/// Text of `--version`.
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
    common: CommonOptions,
}

/// Options of a command together with the options common to all commands.
#[derive(Debug, Args)]
struct With<R: Args> {
    #[command(flatten)]
    request: R,
    #[command(flatten)]
    common: CommonOptions,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Find K and T of a record by six methods, or by the named ones: table, fit.json, report, plots
    Fit(With<FitRequest>),
    /// Find and name the effects that a first-order model lacks: table, trace.json, report, plots
    Trace(With<TraceRequest>),
    /// Predict other manoeuvres from fit.json or trace.json, with intervals: predict.json, report, plots
    Predict(With<PredictRequest>),
    /// List the manoeuvres inside long logs: zig-zags, turning circles, pull-outs, spirals, straight pieces
    Find(With<FindRequest>),
    /// Show every channel of a log before a fit: source, rate, gaps, steps, sign, scale, lag
    Inspect(With<inspect::InspectRequest>),
    /// Write a first description of the columns of a table, NAME.trial.toml next to it; check it before use
    Sidecar(With<sidecar::SidecarRequest>),
    /// Write simulated trials in the format that `study fit` reads, with the true values next to them
    Simulate(With<SimulateRequest>),
    /// Score answers of another program to simulated trials, together with the methods of the scenario
    Score(With<score::ScoreRequest>),
    /// Run the benchmark on measured and simulated trials: leaderboards, bench.json, report, plots
    Bench(With<bench::BenchRequest>),
    /// Check scenario files and count their cells, methods and trials; nothing is run
    Check(With<check::CheckRequest>),
    /// List methods, effects, ships, manoeuvres, sensors, keys, column names and priors
    List(With<list::ListRequest>),
    /// Rebuild tables and plots of a study, a fit, a trace or a prediction from its files, without simulation or fit;
    /// for several studies also one page over them
    Report(With<report::ReportRequest>),
    /// Check the machine and the terminal: version, threads, instruction set, whether files can be written
    Doctor(CommonOptions),
    /// Print the JSON schema of a file, for editors and programs
    Schema(With<schema::SchemaRequest>),
    /// Print the completion script of a shell
    Completions(With<shell::CompletionsRequest>),
    /// Write manual pages, one for every command
    Man(With<shell::ManRequest>),
}

impl<R: Args> With<R> {
    /// Runs a command that works on one thread.
    fn answer(&self, run: impl FnOnce(&R, &CommonOptions) -> Result<(), Failure>) -> Result<(), Failure> {
        run(&self.request, &self.common)
    }

    /// Starts the threads and runs a command that works on them. Fails if the system refuses the threads.
    fn work(&self, run: impl FnOnce(&R, &CommonOptions) -> Result<(), Failure>) -> Result<(), Failure> {
        threads::start_threads(&self.common)?;
        run(&self.request, &self.common)
    }
}

/// Runs the program and returns its exit code: 0 on success, 1 if the work fails, 2 for wrong input, 130 after Ctrl-C.
pub fn main() -> ExitCode {
    interrupt::install_handler();
    let arguments: Vec<OsString> = std::env::args_os().collect();
    if asks_for_json(&arguments) {
        failures::report_failures_as_json();
    }
    match parse(&arguments).and_then(answer) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => ExitCode::from(failures::report_failure(&failure)),
    }
}

/// `true` if the arguments request JSON; errors in the arguments themselves are then JSON, too.
fn asks_for_json(arguments: &[OsString]) -> bool {
    arguments.windows(2).any(|pair| pair[0] == "--format" && pair[1] == "json")
        || arguments.iter().any(|word| word == "--format=json")
}

/// Parsed arguments. A request for help or version prints it and ends the program.
///
/// Fails for an unknown command and for invalid arguments.
fn parse(arguments: &[OsString]) -> Result<Cli, Failure> {
    if let Some(name) = mistaken_command(arguments.get(1)) {
        let commands: Vec<String> =
            Cli::command().get_subcommands().map(|command| command.get_name().to_owned()).collect();
        let advice = suggestion(&name, &commands);
        return Err(Failure::input(format!(
            "there is no command `{name}`, and no scenario file of that name; {advice}"
        ))
        .with_code(ErrorCode::Usage));
    }
    Cli::try_parse_from(arguments).map_err(|usage| match usage.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            usage.exit()
        }
        _ if failures::reports_failures_as_json() => usage_failure(&usage),
        // An argument may hold control characters, which the writer of all other messages escapes.
        _ => Failure::input(usage.render().to_string().trim_end().trim_start_matches("error: ")),
    })
}

/// Failure for a usage error: its message without the usage text.
pub fn usage_failure(usage: &clap::Error) -> Failure {
    let message = usage.to_string();
    let (message, _) = message.split_once("\n\nUsage:").unwrap_or((&message, ""));
    let (message, _) = message.split_once("\n\nFor more information").unwrap_or((message, ""));
    Failure::input(message.trim().trim_start_matches("error: ")).with_code(ErrorCode::Usage)
}

/// First argument if it is a mistyped command: a word that is neither a command nor an existing path; else `None`.
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
        threads::start_threads(&cli.common)?;
        return run::run(&scenario, &cli.request, &cli.common);
    };
    match command {
        Command::Fit(asked) => asked.work(fit::run),
        Command::Trace(asked) => asked.work(trace::run),
        Command::Predict(asked) => asked.work(predict::run),
        Command::Simulate(asked) => asked.work(simulate::run),
        Command::Score(asked) => asked.work(score::run),
        Command::Bench(asked) => asked.work(bench::run),
        Command::Report(asked) => asked.work(report::run),
        Command::Find(asked) => asked.answer(find::run),
        Command::Inspect(asked) => asked.answer(inspect::run),
        Command::Sidecar(asked) => asked.answer(sidecar::run),
        Command::Check(asked) => asked.answer(check::run),
        Command::List(asked) => asked.answer(list::run),
        Command::Schema(asked) => asked.answer(schema::run),
        Command::Completions(asked) => asked.answer(|asked, common| shell::completions(asked, Cli::command(), common)),
        Command::Man(asked) => asked.answer(|asked, common| shell::man(asked, Cli::command(), common)),
        Command::Doctor(common) => doctor::run(&common),
    }
}
