//! Options and arguments of the commands. Longer than most: each option is declared once. Declarations only.

use std::path::PathBuf;
use std::str::FromStr;
use std::sync::Arc;

use crate::completed::{self, completed};
use crate::formula_options::{Formulas, formula, read_formulas};
pub use crate::ship_options::{ScaleOptions, ShipOptions, TrialOptions};
pub use crate::style_options::{FigureChoice, FigureOptions, PageFigureOptions, PageFigures, StudyFigureOptions};
use ::trace::{EffectId, Selection, WeightingRule};
use campaign::failure::Failure;
use campaign::scenario::problem::suggestion;
use campaign::shard::Shard;
use clap::builder::StringValueParser;
use clap::{Args, ValueEnum};
use report::Table;
use ship::effects::Formula;
use trial::Manoeuvre;
use trial::clock::TimeStamp;

/// Options for the run of a scenario.
#[derive(Debug, Clone, Args)]
pub struct RunRequest {
    /// Run only part I of N; give all parts one folder, or copy them into one, and let `study report` make the page
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// Discard rows of an earlier run in the folder instead of continuing them
    #[arg(long)]
    pub restart: bool,
    /// How figures are drawn, and which
    #[command(flatten)]
    pub style: StudyFigureOptions,
}

/// Maximum number of threads, also on a machine with more cores; the system refuses many more.
pub const MAX_THREADS: i64 = 1024;

/// Options of every command.
#[derive(Debug, Clone, Args)]
pub struct CommonOptions {
    /// Folder for results [default: `results/SCENARIO`, `./TRIAL-fit`, `./TRIAL-trace`, `./MODEL-predict`]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Number of threads [default: all cores]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MAX_THREADS))]
    pub threads: Option<u16>,
    /// Seed of the simulation or of samples, in place of the scenario's
    #[arg(long, value_name = "S", value_parser = seed, allow_hyphen_values = true)]
    pub seed: Option<u64>,
    /// No progress bar, table, note or warning; only errors and the output that --format requests
    #[arg(long)]
    pub quiet: bool,
    /// Format of standard output
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

impl CommonOptions {
    /// `true` if standard output stays empty; a requested format is written even with `--quiet`.
    pub fn is_silent(&self) -> bool {
        self.quiet && self.format == Format::Text
    }
}

fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("expected a whole number from 0 to {}", u64::MAX))
}

/// Format of standard output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Words and aligned columns, for people
    Text,
    /// Markdown
    Markdown,
    /// Comma-separated values
    Csv,
    /// LaTeX with booktabs and siunitx
    Latex,
    /// One JSON document, for programs
    Json,
}

impl Format {
    /// Text of a table in this format.
    pub fn render(self, table: &Table) -> String {
        match self {
            Self::Text => table.to_text(),
            Self::Markdown => table.to_markdown(),
            Self::Csv => table.to_csv(),
            Self::Latex => table.to_latex(),
            Self::Json => table.to_json(),
        }
    }
}

/// Options for reading records: columns, part of the record, particulars of the ship.
#[derive(Debug, Clone, Default, Args)]
pub struct ReadingOptions {
    /// Description of the columns of the records (a sidecar), or a folder with a NAME.trial.toml for each
    #[arg(long, value_name = "FILE.toml|DIR")]
    pub columns: Option<PathBuf>,
    /// Another file of the same record, for example with its rudder; joined by time
    #[arg(long, value_name = "FILE")]
    pub with_columns: Vec<PathBuf>,
    /// Use the manoeuvre with this number in `study find` [default: the zig-zag, if there is one]
    #[arg(long, value_name = "N", conflicts_with_all = ["from", "until"])]
    pub trial: Option<usize>,
    /// Use the record from this time on: seconds on its clock (0 is its beginning), or a time of day such as 14:03:05
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub from: Option<TimePoint>,
    /// Use the record until this time
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub until: Option<TimePoint>,
    /// Known particulars of the ship
    #[command(flatten)]
    pub ship: ShipOptions,
    /// Known particulars of the trial
    #[command(flatten)]
    pub trial_particulars: TrialOptions,
}

/// Options for samples of an estimate as a file.
#[derive(Debug, Clone, Args)]
pub struct SampleFileOptions {
    /// Also write samples of K, T and all other parameters from their covariance, one row each, as draws.parquet; their
    /// seed is --seed, or 0 without it
    #[arg(long)]
    pub draws_file: bool,
    /// Samples of every estimate in that file
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(DRAWS))]
    pub draws: u32,
}

/// Time in a record, as given on the command line.
#[derive(Debug, Clone, PartialEq)]
pub enum TimePoint {
    /// Seconds on the clock of the record.
    Seconds(f64),
    /// Reading of the ship's clock, and the text that was given for it.
    Clock(TimeStamp, String),
}

impl FromStr for TimePoint {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(seconds) = text.parse().ok().filter(|seconds: &f64| seconds.is_finite()) {
            return Ok(Self::Seconds(seconds));
        }
        let stamp = TimeStamp::parse(text).filter(TimeStamp::has_time);
        stamp
            .map(|stamp| Self::Clock(stamp, text.to_owned()))
            .ok_or_else(|| "expected seconds, or a time such as 14:03:05 or 2026-11-20T14:03:05".to_owned())
    }
}

/// Arguments of `study find`.
#[derive(Debug, Clone, Args)]
pub struct FindRequest {
    /// Logs to search for manoeuvres; a folder means all its records
    #[arg(required = true, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    /// Description of the columns of the logs (a sidecar), or a folder with a NAME.trial.toml for each
    #[arg(long, value_name = "FILE.toml|DIR")]
    pub columns: Option<PathBuf>,
    /// Another file of the same log, for example with its rudder; joined by time
    #[arg(long, value_name = "FILE")]
    pub with_columns: Vec<PathBuf>,
}

/// Arguments of `study fit`.
#[derive(Debug, Clone, Args)]
pub struct FitRequest {
    /// Records of one ship, identified together; a folder means all its records
    #[arg(required = true, value_name = "TRIAL")]
    pub trials: Vec<PathBuf>,
    /// Fit every record alone and print one row for each (with --format json one line of JSON), also for a record that
    /// cannot be read; no file is written
    #[arg(long, conflicts_with_all = ["validate", "priors", "with_columns", "trial", "from", "until", "out",
        "draws_file"])]
    pub each: bool,
    /// Records on which the identified responses are replayed; only their initial state is fitted
    #[arg(long, value_name = "TRIAL")]
    pub validate: Vec<PathBuf>,
    /// Method to use, or `all`; can be given several times [default: all but fourier-published and srivc]
    #[arg(long = "method", value_name = "ID|all", hide_possible_values = true,
        value_parser = completed(StringValueParser::new(), completed::method_names_or_all))]
    pub methods: Vec<String>,
    /// fit.json or trace.json of earlier trials of the same ship, a sister ship or a scale model: its hull, with wider
    /// errors, is the prior of this analysis; can be given several times
    #[arg(long = "prior", value_name = "MODEL.json")]
    pub priors: Vec<PathBuf>,
    /// How the records are read
    #[command(flatten)]
    pub reading: ReadingOptions,
    /// Samples of the estimates
    #[command(flatten)]
    pub draws: SampleFileOptions,
    /// How figures are drawn, and whether they are drawn
    #[command(flatten)]
    pub style: PageFigureOptions,
}

/// Arguments of `study simulate`.
#[derive(Debug, Clone, Args)]
pub struct SimulateRequest {
    /// Scenario whose trials are written
    #[arg(value_name = "SCENARIO.toml")]
    pub scenario: PathBuf,
    /// Labels of the one cell to simulate, joined by commas [default: every cell]
    #[arg(long, value_name = "LABEL")]
    pub cell: Option<String>,
    /// Number of the trial in its cell, from 0, or `all`
    #[arg(long, value_name = "N|all", default_value = "0")]
    pub replicate: Replicates,
}

/// Selection of trials in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Replicates {
    /// All trials of the cell.
    All,
    /// The trial with this number.
    One(u64),
}

impl FromStr for Replicates {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "all" => Ok(Self::All),
            text => text.parse().map(Self::One).map_err(|_| "expected a whole number from 0, or `all`".to_owned()),
        }
    }
}

/// Arguments of `study trace`.
#[derive(Debug, Clone, Args)]
pub struct TraceRequest {
    /// Records of one ship, analysed together; a folder means all its records
    #[arg(required = true, value_name = "TRIAL")]
    pub trials: Vec<PathBuf>,
    /// Held-out records that validate the result: only their initial state is fitted
    #[arg(long, value_name = "TRIAL")]
    pub validate: Vec<PathBuf>,
    /// How the records are read
    #[command(flatten)]
    pub reading: ReadingOptions,
    /// Analyse without these columns, as if they had not been recorded: `wind`, `speed`, `propeller`, `sway`
    #[arg(long, value_name = "CHANNEL", value_enum)]
    pub without: Vec<WithheldChannel>,
    /// Effects that are always in the model, by their ids in `study list effects` or their names in `--effect`
    #[arg(long, value_name = "ID,…", value_delimiter = ',', hide_possible_values = true,
        value_parser = completed(StringValueParser::new(), completed::effect_ids))]
    pub with: Vec<String>,
    /// Use exactly these effects, without a search
    #[arg(long, value_name = "ID,…", value_delimiter = ',', conflicts_with_all = ["with", "without_effect"],
        hide_possible_values = true, value_parser = completed(StringValueParser::new(), completed::effect_ids))]
    pub only: Vec<String>,
    /// Effects to leave out of the search
    #[arg(long, value_name = "ID,…", value_delimiter = ',', hide_possible_values = true,
        value_parser = completed(StringValueParser::new(), completed::effect_ids))]
    pub without_effect: Vec<String>,
    /// A candidate effect as a formula for a yaw moment, in rudder angle, such as `bank = c * tanh(k * psi)`; can be
    /// given several times
    #[arg(long, value_name = "NAME = FORMULA", value_parser = formula)]
    pub effect: Vec<Arc<Formula>>,
    /// Candidate effects from a file, `effects = ["NAME = FORMULA", …]`
    #[arg(long, value_name = "FILE.toml", value_parser = read_formulas)]
    pub effects: Option<Formulas>,
    /// Fit no hulls of three degrees of freedom; they are fitted if length and speed of the ship are known and the
    /// effects leave more than noise
    #[arg(long)]
    pub without_hull: bool,
    /// fit.json or trace.json of earlier trials of the same ship, a sister ship or a scale model: its hull, with wider
    /// errors, is the prior of this analysis; can be given several times
    #[arg(long = "prior", value_name = "MODEL.json", conflicts_with = "without_hull")]
    pub priors: Vec<PathBuf>,
    /// How models are weighted: `posterior`, by their likelihood under the priors of the coefficients, or `bic`
    #[arg(long, value_name = "NAME", default_value = WeightingRule::default().as_str(), hide_possible_values = true,
        value_parser = completed(rule, completed::rule_names))]
    pub rule: WeightingRule,
    /// Samples of the model
    #[command(flatten)]
    pub draws: SampleFileOptions,
    /// How figures are drawn, and whether they are drawn
    #[command(flatten)]
    pub style: PageFigureOptions,
}

impl TraceRequest {
    /// Effects that are required, excluded or added as formulas.
    ///
    /// Fails if a name is that of neither a listed effect nor a formula.
    pub fn selection(&self) -> Result<Selection, Failure> {
        let of_file = self.effects.iter().flat_map(|formulas| formulas.all());
        let formulas: Vec<Arc<Formula>> = self.effect.iter().chain(of_file).cloned().collect();
        let selection = Selection { formulas, ..Selection::default() };
        let named = |option: &str, names: &[String]| -> Result<Vec<EffectId>, Failure> {
            names.iter().map(|name| effect(option, name, &selection)).collect()
        };
        let (with, without) = (named("with", &self.with)?, named("without-effect", &self.without_effect)?);
        let mut only = named("only", &self.only)?;
        if only.is_empty() {
            return Ok(Selection { required: with, excluded: without, ..selection });
        }
        let typed = selection.formulas.iter().map(|formula| EffectId::from_formula(formula));
        let more: Vec<EffectId> = typed.filter(|id| !only.contains(id)).collect();
        only.extend(more);
        Ok(Selection { formulas: selection.formulas, ..Selection::only(only) })
    }
}

fn rule(name: &str) -> Result<WeightingRule, String> {
    let names = WeightingRule::ALL.map(WeightingRule::as_str);
    WeightingRule::ALL.into_iter().find(|rule| rule.as_str() == name).ok_or_else(|| suggestion(name, &names))
}

/// Effect of this name. Fails if there is none; the message names the `option` in which it was given.
fn effect(option: &str, name: &str, selection: &Selection) -> Result<EffectId, Failure> {
    selection.find(name).ok_or_else(|| {
        let ids: Vec<&str> = selection.ids().into_iter().map(EffectId::as_str).collect();
        Failure::input(format!("--{option}: there is no effect `{name}`; {}", suggestion(name, &ids)))
    })
}

/// Channels that can be withheld from an analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum WithheldChannel {
    /// Wind, relative and true
    Wind,
    /// Speed and surge velocity
    Speed,
    /// Propeller revolutions
    Propeller,
    /// Sway velocity
    Sway,
}

/// Range of the number of samples.
const DRAWS: std::ops::RangeInclusive<i64> = 50..=100_000;

/// Arguments of `study predict`.
#[derive(Debug, Clone, Args)]
pub struct PredictRequest {
    /// fit.json or trace.json of one ship; several are mixed with equal weights
    #[arg(required = true, value_name = "MODEL.json")]
    pub models: Vec<PathBuf>,
    /// Manoeuvre to predict: zig-zag:10/10, initial-turning:10, turning-circle:35, pull-out:20, spiral:15, williamson;
    /// a negative rudder begins to port [default: those of the IMO criteria, unless a record is replayed]
    #[arg(long = "manoeuvre", value_name = "KIND", allow_hyphen_values = true)]
    pub manoeuvres: Vec<Manoeuvre>,
    /// Record to compare with the prediction for its rudder; no parameter is fitted to it
    #[arg(long = "replay", value_name = "RECORD")]
    pub replays: Vec<PathBuf>,
    /// Circle of 720° or more whose current is removed from the tracks of all replayed turns [default: each turn's own
    /// current, if it turns that far]
    #[arg(long, value_name = "RECORD", requires = "replays")]
    pub current_from: Option<PathBuf>,
    /// fit.json or trace.json of earlier trials of the same ship, a sister ship or a scale model, which are not in
    /// MODEL.json: combines their hulls, with wider errors, with those of MODEL.json; can be given several times
    #[arg(long = "prior", value_name = "EARLIER.json", conflicts_with = "ballast")]
    pub priors: Vec<PathBuf>,
    /// Model of the same ship in the loading of the --replay trial: corrects the measured values to the loading of
    /// MODEL.json, R = T F/B (MSC/Circ.1053, 3.4.1.2)
    #[arg(long, value_name = "BALLAST.json")]
    pub ballast: Vec<PathBuf>,
    /// Convert the hulls of MODEL.json to another loading, given by the tables `ship` and `form` as in a sidecar, with
    /// the formulas of `study list priors` and wider intervals
    #[arg(long, value_name = "LOAD.toml")]
    pub load: Option<PathBuf>,
    /// Also fill in the form of MSC/Circ.1053, appendix 6, as trial-form.md: its manoeuvres to both sides, measured
    /// values if a --replay record is that trial
    #[arg(long)]
    pub form: bool,
    /// Method whose estimate in fit.json is used [default: that of the verdict, or the next with a covariance]
    #[arg(long, value_name = "ID", hide_possible_values = true,
        value_parser = completed(StringValueParser::new(), completed::method_names))]
    pub method: Option<String>,
    /// Predict for calm weather, without the random yaw moment and the steady wind of the records
    #[arg(long)]
    pub calm: bool,
    /// Number of ships to sample
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(DRAWS))]
    pub draws: u32,
    /// Also write draws.parquet: one row per sampled ship, with its parameters and characteristics
    #[arg(long)]
    pub draws_file: bool,
    /// Description of the columns of the records (a sidecar), or a folder with a NAME.trial.toml for each; its ship
    /// sets the scale of the prediction, unless --length-m is given
    #[arg(long, value_name = "FILE.toml|DIR")]
    pub columns: Option<PathBuf>,
    /// Scale of the prediction: another length scales the ship by Froude
    #[command(flatten)]
    pub scale: ScaleOptions,
    /// How figures are drawn, and whether they are drawn
    #[command(flatten)]
    pub style: PageFigureOptions,
}

impl PredictRequest {
    /// Options for reading records.
    pub fn reading(&self) -> ReadingOptions {
        let ship = ShipOptions { scale: self.scale.clone(), ..ShipOptions::default() };
        ReadingOptions { columns: self.columns.clone(), ship, ..ReadingOptions::default() }
    }
}

/// Files that have a JSON schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SchemaSubject {
    /// Scenario of a study
    Scenario,
    /// Sidecar of a record
    Sidecar,
    /// fit.json
    Fit,
    /// trace.json
    Trace,
    /// predict.json
    Predict,
    /// manifest.toml
    Manifest,
    /// bench.json
    Bench,
    /// curves.json of a fit
    FitCurves,
    /// cells.json of a study
    Cells,
    /// showcase.json of a study
    Showcase,
    /// Style of figures
    Style,
    /// trials.toml, next to simulated records
    Trials,
    /// NAME.truth.json, next to a simulated record
    Truth,
    /// JSON output of a study, `report` and `score`
    Study,
    /// JSON output of a shard of a study
    Shard,
    /// JSON output of `find`
    Find,
    /// JSON output of `inspect`
    Inspect,
    /// JSON output of `check`
    Check,
    /// JSON output of `list`
    List,
    /// JSON output of `simulate`
    Simulate,
    /// JSON output of `sidecar`
    SidecarAnswer,
    /// A line of `fit --each`
    FitEach,
    /// Error document of every command, on standard error
    Error,
}

/// Lists of `study list`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ListSubject {
    /// Identification methods with their settings
    Identifiers,
    /// Effects that a first-order response may lack
    Effects,
    /// Ships
    Ships,
    /// Manoeuvres
    Manoeuvres,
    /// Sensor keys
    Sensors,
    /// Every key of a scenario
    Keys,
    /// Names of columns of a record
    Columns,
    /// Keys of a sidecar
    Sidecar,
    /// Priors of the coefficients of an MMG hull from the particulars of the ship
    Priors,
}
