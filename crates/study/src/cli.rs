//! The command line: what a user may ask for, and which part of the study answers. It knows no hydrodynamics.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueEnum};

use report::Theme;
use report::theme::{DPI, WIDTH_MM};

use crate::failure::{Blame, Failure};
use crate::plan::Shard;
use crate::{check, fit, list, merge, overview, publish, run, screen, trace};

/// Ship zig-zag trials: simulate them, identify K and T, benchmark the methods.
#[derive(Debug, Parser)]
#[command(name = "study", version, args_conflicts_with_subcommands = true, arg_required_else_help = true)]
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

/// How a scenario is run.
#[derive(Debug, Clone, Args)]
pub struct RunRequest {
    /// Run part I of N only, into a folder of its own; `study merge` joins the parts
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// Discard rows of an earlier run in the folder instead of going on with them
    #[arg(long)]
    pub restart: bool,
    /// How figures are drawn
    #[command(flatten)]
    pub style: Style,
}

/// How figures are drawn.
#[derive(Debug, Clone, Copy, Args)]
pub struct Style {
    /// Draw figures for print, MM millimetres wide [default: for a screen]
    #[arg(long, value_name = "MM", value_parser = within(WIDTH_MM), allow_hyphen_values = true)]
    pub paper: Option<f64>,
    /// Resolution of figures for print
    #[arg(long, value_name = "DPI", default_value_t = 600.0, requires = "paper", value_parser = within(DPI), allow_hyphen_values = true)]
    pub dpi: f64,
}

/// Reads a number from `least` to `most`.
fn within([least, most]: [f64; 2]) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.parse().ok().filter(|number| (least..=most).contains(number));
        number.ok_or_else(|| format!("expected a number from {least} to {most}"))
    }
}

impl Style {
    /// The theme of the figures. Fails when no page carries it.
    pub fn theme(&self) -> Result<Theme, Failure> {
        match self.paper {
            None => Ok(Theme::screen()),
            Some(width_mm) => Theme::paper(width_mm, self.dpi).map_err(Failure::input),
        }
    }
}

/// Most threads that can be asked for; no machine has more cores, and the system refuses many more.
const MOST_THREADS: i64 = 1024;

/// Options every command understands.
#[derive(Debug, Clone, Args)]
pub struct Common {
    /// Folder for results [default: `results/SCENARIO`, or `./TRIAL-fit`, `./TRIAL-trace`]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Number of threads [default: all cores]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    pub threads: Option<u16>,
    /// Seed in place of the scenario's
    #[arg(long, value_name = "S", value_parser = seed, allow_hyphen_values = true)]
    pub seed: Option<u64>,
    /// No progress bar and no table; errors and warnings remain
    #[arg(long)]
    pub quiet: bool,
    /// Format of the table on standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("expected a whole number from 0 to {}", u64::MAX))
}

/// Format of tables on standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Aligned columns
    Text,
    /// Markdown
    Markdown,
    /// Comma-separated values
    Csv,
    /// LaTeX with booktabs
    Latex,
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
    /// Close the loop on records: fit, look at what is left, name the effect the model lacks, add it: trace.json, report, plots
    Trace {
        #[command(flatten)]
        request: TraceRequest,
        #[command(flatten)]
        common: Common,
    },
    /// Resolve scenario files and run nothing
    Check {
        /// Scenario files
        #[arg(required = true, value_name = "SCENARIO.toml")]
        scenarios: Vec<PathBuf>,
    },
    /// List what scenario files can name
    List {
        /// What to list
        what: Listed,
        #[command(flatten)]
        common: Common,
    },
    /// Rebuild tables and plots from the stored rows, no simulation
    Report {
        /// Folder of a finished study
        #[arg(value_name = "DIR")]
        folder: PathBuf,
        #[command(flatten)]
        style: Style,
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
    /// Join the shards of one study
    Merge {
        /// Folders written with --shard, all of them, in any order
        #[arg(required = true, value_name = "DIR")]
        folders: Vec<PathBuf>,
        #[command(flatten)]
        style: Style,
        #[command(flatten)]
        common: Common,
    },
}

/// What `study fit` is asked to do.
#[derive(Debug, Clone, Args)]
pub struct FitRequest {
    /// Records of one ship, identified together
    #[arg(required = true, value_name = "TRIAL")]
    pub trials: Vec<PathBuf>,
    /// Records on which the identified responses are replayed; only their initial state is fitted
    #[arg(long, value_name = "TRIAL")]
    pub validate: Vec<PathBuf>,
    /// Methods to use [default: all]
    #[arg(long = "method", value_name = "ID")]
    pub methods: Vec<String>,
    /// Description of the columns of the records (a sidecar), or a folder with a NAME.trial.toml for each
    #[arg(long, value_name = "FILE.toml|DIR")]
    pub columns: Option<PathBuf>,
}

/// What `study trace` is asked to do.
#[derive(Debug, Clone, Args)]
pub struct TraceRequest {
    /// Records of one ship, analysed together
    #[arg(required = true, value_name = "TRIAL")]
    pub trials: Vec<PathBuf>,
    /// Records that are kept from the fit; only their initial state is fitted, and what makes their error worse is not kept
    #[arg(long, value_name = "TRIAL")]
    pub validate: Vec<PathBuf>,
    /// Description of the columns of the records (a sidecar), or a folder with a NAME.trial.toml for each
    #[arg(long, value_name = "FILE.toml|DIR")]
    pub columns: Option<PathBuf>,
    /// Give every record a rudder bias of its own
    #[arg(long)]
    pub own_bias: bool,
    /// Analyse without these columns, as if they had not been recorded: `wind`, `speed`, `propeller`, `sway`
    #[arg(long, value_name = "CHANNEL", value_enum)]
    pub without: Vec<Withheld>,
    /// How figures are drawn
    #[command(flatten)]
    pub style: Style,
}

/// Channels that can be withheld from an analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Withheld {
    /// Wind, relative and true
    Wind,
    /// Speed and surge velocity
    Speed,
    /// Propeller revolutions
    Propeller,
    /// Sway velocity
    Sway,
}

/// What can be listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Listed {
    /// Identification methods
    Identifiers,
    /// Effects a first-order response lacks
    Effects,
    /// Ships
    Ships,
    /// Manoeuvres
    Manoeuvres,
    /// Sensor keys
    Sensors,
}

/// Runs the program and returns its exit code: 0 done, 1 the work could not be done, 2 the input is wrong.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(usage) if usage.use_stderr() => {
            // By the same way as all other messages: an argument may hold anything.
            screen::warn(usage.render().to_string().trim_end());
            return ExitCode::from(Blame::Input.exit_code());
        }
        Err(help) => help.exit(),
    };
    match answer(cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            screen::warn(&failure.to_string());
            ExitCode::from(failure.blame.exit_code())
        }
    }
}

fn answer(cli: Cli) -> Result<(), Failure> {
    match (cli.command, cli.scenario) {
        (None, Some(scenario)) => {
            use_threads(&cli.common)?;
            run::run(&scenario, &cli.request, &cli.common)
        }
        (None, None) => Err(Failure::input("no scenario is named; try `study scenarios/yukun.toml` or `study --help`")),
        (Some(Command::Fit { request, common }), _) => {
            use_threads(&common)?;
            fit::run(&request, &common)
        }
        (Some(Command::Trace { request, common }), _) => {
            use_threads(&common)?;
            trace::run(&request, &common)
        }
        (Some(Command::Check { scenarios }), _) => check::run(&scenarios),
        (Some(Command::List { what, common }), _) => list::run(what, &common),
        (Some(Command::Report { folder, style, common }), _) => {
            use_threads(&common)?;
            publish::report(&folder, &style, &common)
        }
        (Some(Command::Overview { folder, common }), _) => overview::run(&folder, &common),
        (Some(Command::Merge { folders, style, common }), _) => {
            use_threads(&common)?;
            merge::merge(&folders, &style, &common)
        }
    }
}

/// The variable of the environment that says how many threads to start where the command line does not.
const THREADS: &str = "RAYON_NUM_THREADS";

/// How many threads to start on a machine of so many `cores`, and what to say of it, where the `variable` [`THREADS`] is all
/// there is: a number above 0 is meant, anything else is none.
fn threads_of(variable: Option<&str>, cores: usize) -> (usize, Option<String>) {
    let most = MOST_THREADS as usize;
    // Digits alone, so that a number beyond all bounds is one that is too large.
    let digits = variable.filter(|text| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit()));
    match digits.map(|digits| digits.parse().unwrap_or(usize::MAX)) {
        None | Some(0) => (cores.min(most), None),
        Some(asked) if asked <= most => (asked, None),
        Some(_) => {
            let asked = variable.unwrap_or_default();
            (
                most,
                Some(format!(
                    "warning: {THREADS} is {asked}; {most} threads are started, which is the most there can be"
                )),
            )
        }
    }
}

/// Starts the threads of all parallel work.
fn use_threads(common: &Common) -> Result<(), Failure> {
    let threads = match common.threads {
        Some(threads) => usize::from(threads),
        None => {
            let cores = std::thread::available_parallelism().map_or(1, usize::from);
            let (threads, remark) = threads_of(std::env::var(THREADS).ok().as_deref(), cores);
            remark.iter().for_each(|remark| screen::warn(remark));
            threads
        }
    };
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Failure::work(format!("failed to start {threads} threads: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_environment_starts_more_threads_than_can_be_asked_for() {
        let threads = |variable, cores| threads_of(variable, cores).0;
        assert_eq!([None, Some(""), Some("0"), Some("many"), Some("-3")].map(|variable| threads(variable, 8)), [8; 5]);
        assert_eq!((threads(Some("3"), 8), threads(Some("1024"), 8), threads(None, 4000)), (3, 1024, 1024));
        for far in ["1025", "12000", "99999999999999999999999"] {
            let (threads, remark) = threads_of(Some(far), 8);
            let remark = remark.expect("it is said");
            assert!(threads == 1024 && remark.contains(far) && remark.contains("1024"), "{remark}");
        }
    }
}
