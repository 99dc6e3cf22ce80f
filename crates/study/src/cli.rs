//! The command line: what a user may ask for, and which part of the study answers. It knows no hydrodynamics.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::LazyLock;

use crate::bench_options::BenchRequest;
use crate::commands::{
    bench, check, doctor, find, fit, list, merge, overview, predict, report, run, schema, score, shell, sidecar,
    simulate, trace,
};
use crate::options::{
    Common, Described, FindRequest, FitRequest, Listed, PredictRequest, RunRequest, SimulateRequest, StudyStyle,
    TraceRequest,
};
use crate::{screen, threads};
use clap::{CommandFactory, Parser, Subcommand};
use clap_complete::Shell;
use scenario::failure::{Blame, Failure};
use scenario::problem::suggestion;

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

#[derive(Debug, Subcommand)]
enum Command {
    /// Identify a record with every (or the named) method: table, plot, fit.json
    Fit {
        #[command(flatten)]
        request: FitRequest,
        #[command(flatten)]
        common: Common,
    },
    /// Close the loop on records: fit, look at what is left, name the effect the model lacks, add it: trace.json,
    /// report, plots
    Trace {
        #[command(flatten)]
        request: TraceRequest,
        #[command(flatten)]
        common: Common,
    },
    /// Predict manoeuvres that were not made from fit.json or trace.json, with intervals: predict.json, report, plots
    Predict {
        #[command(flatten)]
        request: PredictRequest,
        #[command(flatten)]
        common: Common,
    },
    /// List the manoeuvres inside long logs: zig-zags, turning circles, pull-outs, spirals, straight pieces
    Find {
        #[command(flatten)]
        request: FindRequest,
        #[command(flatten)]
        common: Common,
    },
    /// Write a first description of the columns of a table, NAME.trial.toml beside it, for a person to check
    Sidecar {
        /// The table
        #[arg(value_name = "LOG")]
        log: PathBuf,
        #[command(flatten)]
        common: Common,
    },
    /// Write simulated trials in the format `study fit` reads, the truth beside them
    Simulate {
        #[command(flatten)]
        request: SimulateRequest,
        #[command(flatten)]
        common: Common,
    },
    /// Score answers to simulated trials that another program found, beside the methods of the scenario
    Score {
        #[command(flatten)]
        request: score::ScoreRequest,
        #[command(flatten)]
        common: Common,
    },
    /// Run the benchmark on measured and simulated trials: leaderboards, bench.json, report, plots
    Bench {
        #[command(flatten)]
        request: BenchRequest,
        #[command(flatten)]
        common: Common,
    },
    /// Resolve scenario files and run nothing
    Check {
        /// Scenario files
        #[arg(required = true, value_name = "SCENARIO.toml")]
        scenarios: Vec<PathBuf>,
        /// Print every scenario with nothing left out, as TOML; defaults are marked
        #[arg(long)]
        resolved: bool,
        #[command(flatten)]
        common: Common,
    },
    /// List what scenario files can name
    List {
        /// What to list
        what: Listed,
        #[command(flatten)]
        common: Common,
    },
    /// Rebuild tables and plots of a study, a fit, a trace or a prediction from what is stored; nothing is simulated or
    /// fitted
    Report {
        /// Folder of a finished study, a fit, a trace or a prediction
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        /// Show report.html in a browser
        #[arg(long)]
        open: bool,
        #[command(flatten)]
        style: StudyStyle,
        #[command(flatten)]
        common: Common,
    },
    /// Write one page over all published studies of a folder
    Overview {
        /// Folder that holds the folders of studies
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        #[command(flatten)]
        common: Common,
    },
    /// Look at the machine and the terminal: versions, threads, instruction sets, whether files can be written
    Doctor {
        #[command(flatten)]
        common: Common,
    },
    /// Print the JSON schema of a file, for editors and programs
    Schema {
        /// Which file
        what: Described,
        #[command(flatten)]
        common: Common,
    },
    /// Print what a shell has to read to complete commands and options
    Completions {
        /// The shell
        shell: Shell,
        #[command(flatten)]
        common: Common,
    },
    /// Write manual pages, one for every command
    Man {
        /// Folder for the pages, such as ~/.local/share/man/man1
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        #[command(flatten)]
        common: Common,
    },
    /// Join the shards of one study
    Merge {
        /// Folders written with --shard, all of them, in any order
        #[arg(required = true, value_name = "DIR")]
        folders: Vec<PathBuf>,
        #[command(flatten)]
        style: StudyStyle,
        #[command(flatten)]
        common: Common,
    },
}

/// Runs the program and returns its exit code: 0 done, 1 the work could not be done, 2 the input is wrong.
pub fn main() -> ExitCode {
    if let Some(name) = mistaken_command(std::env::args_os().nth(1)) {
        let known: Vec<String> =
            Cli::command().get_subcommands().map(|command| command.get_name().to_owned()).collect();
        let advice = suggestion(&name, &known);
        screen::warn(&format!("error: there is no command `{name}`, and no scenario file of that name; {advice}"));
        return ExitCode::from(screen::exit_code(Blame::Input));
    }
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(usage) if usage.use_stderr() => {
            // By the same way as all other messages: an argument may hold anything.
            screen::warn(usage.render().to_string().trim_end());
            return ExitCode::from(screen::exit_code(Blame::Input));
        }
        Err(help) => help.exit(),
    };
    match answer(cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            screen::warn(&failure.to_string());
            ExitCode::from(screen::exit_code(failure.blame))
        }
    }
}

/// A first argument that is a single word, and neither a command nor the path of anything.
fn mistaken_command(first: Option<OsString>) -> Option<String> {
    let name = first?.into_string().ok()?;
    let is_word = !name.is_empty() && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '-');
    let is_known = name.starts_with('-') || name == "help" || Cli::command().find_subcommand(&name).is_some();
    (is_word && !is_known && !Path::new(&name).exists()).then_some(name)
}

fn answer(cli: Cli) -> Result<(), Failure> {
    match (cli.command, cli.scenario) {
        (None, Some(scenario)) => {
            threads::start(&cli.common)?;
            run::run(&scenario, &cli.request, &cli.common)
        }
        (None, None) => Err(Failure::input("no scenario is named; try `study scenarios/yukun.toml` or `study --help`")),
        (Some(Command::Fit { request, common }), _) => {
            threads::start(&common)?;
            fit::run(&request, &common)
        }
        (Some(Command::Trace { request, common }), _) => {
            threads::start(&common)?;
            trace::run(&request, &common)
        }
        (Some(Command::Predict { request, common }), _) => {
            threads::start(&common)?;
            predict::run(&request, &common)
        }
        (Some(Command::Sidecar { log, common }), _) => sidecar::run(&log, &common),
        (Some(Command::Find { request, common }), _) => find::run(&request, &common),
        (Some(Command::Simulate { request, common }), _) => {
            threads::start(&common)?;
            simulate::run(&request, &common)
        }
        (Some(Command::Score { request, common }), _) => {
            threads::start(&common)?;
            score::run(&request, &common)
        }
        (Some(Command::Bench { request, common }), _) => {
            threads::start(&common)?;
            bench::run(&request, &common)
        }
        (Some(Command::Check { scenarios, resolved, common }), _) => check::run(&scenarios, resolved, &common),
        (Some(Command::List { what, common }), _) => list::run(what, &common),
        (Some(Command::Report { folder, open, style, common }), _) => {
            threads::start(&common)?;
            report::run(&folder, open, &style, &common)
        }
        (Some(Command::Doctor { common }), _) => doctor::run(&common),
        (Some(Command::Schema { what, common }), _) => schema::run(what, &common),
        (Some(Command::Completions { shell, common }), _) => shell::completions(shell, Cli::command(), &common),
        (Some(Command::Man { folder, common }), _) => shell::man(&folder, Cli::command(), &common),
        (Some(Command::Overview { folder, common }), _) => overview::run(&folder, &common),
        (Some(Command::Merge { folders, style, common }), _) => {
            threads::start(&common)?;
            merge::run(&folders, &style, &common)
        }
    }
}
