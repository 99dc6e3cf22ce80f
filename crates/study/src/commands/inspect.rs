//! `study inspect`: content of a log, channel by channel, before a fit.

use std::path::PathBuf;

use clap::Args;
use document::{Warning, WarningCode, Warnings};
use report::number::{MISSING, fixed, optional, significant};
use report::{Table, TableHead};
use trial::file::display_path;
use trial::{InstrumentLog, ReadError};

use crate::documents;
use crate::documents::inspect::{ChannelEntry, InspectAnswer};
use crate::documents::log::LogEntry;
use crate::options::CommonOptions;
use crate::records::{open_log, warning_source};
use crate::screen::{self, CommandOutput};
use campaign::failure::Failure;

/// Arguments of `study inspect`.
#[derive(Debug, Clone, Args)]
pub struct InspectRequest {
    /// The log
    #[arg(value_name = "LOG")]
    pub log: PathBuf,
    /// Description of the columns of the log (a sidecar), or a folder with a NAME.trial.toml for it
    #[arg(long, value_name = "FILE.toml|DIR")]
    pub columns: Option<PathBuf>,
    /// Another file of the log, for example with its rudder; joined by time
    #[arg(long, value_name = "FILE")]
    pub with_columns: Vec<PathBuf>,
}

/// Prints every channel of the log and the warnings of the reader. A log that contradicts itself is still shown.
///
/// Fails if the log cannot be read.
pub fn run(request: &InspectRequest, common: &CommonOptions) -> Result<(), Failure> {
    let mut warnings = Warnings::default();
    let log = open_log(&request.log, request.columns.as_deref(), &request.with_columns, &mut warnings)?;
    let file = display_path(&request.log);
    warnings.extend(warning_source(file).attach_to(doubts(log.clone())));
    let answer = InspectAnswer::from_log(file, &log, warnings.ranked());
    let LogEntry { file, rows, duration_s, .. } = &answer.log;
    let before = format!("{file}: {rows} rows, {} s\n", fixed(*duration_s, 1));
    let text = documents::answer_text(&answer)?;
    let output = CommandOutput {
        texts_around_table: [&before, ""],
        table: &table(&answer.channels),
        notes: "",
        document: &text,
    };
    screen::print_output(common, &output, &answer.warnings)
}

/// Warnings of the log when it is read as a single record; if it cannot be read so, a single warning with the reason.
fn doubts(log: InstrumentLog) -> Vec<Warning> {
    let refused =
        |problem: String| vec![WarningCode::Implausible.warning(format!("not usable as one record: {problem}"))];
    match log.into_trial(None) {
        Ok(read) => read.warnings,
        Err(ReadError::Table { problem, .. }) => refused(problem.to_string()),
        Err(other) => refused(other.to_string()),
    }
}

fn table(channels: &[ChannelEntry]) -> Table {
    let head = TableHead::default().texts(["channel", "source"]).numbers(["readings"]);
    let head = head.numbers(["every", "longest gap", "from"]).unit("s").numbers(["lowest", "highest", "step"]);
    let head = head.texts(["unit"]).numbers(["crossings of north"]).texts(["positive turns to", "compared with"]);
    let mut table = Table::new(head.numbers(["scale"]).numbers(["lag"]).unit("s"));
    let text = |text: &Option<String>| text.clone().unwrap_or_else(|| MISSING.to_owned());
    let three = |value: Option<f64>| significant(value.unwrap_or(f64::NAN), 3);
    for entry in channels {
        table.push([
            entry.channel.clone(),
            text(&entry.source),
            entry.readings.to_string(),
            three(entry.interval_s),
            three(entry.longest_gap_s),
            optional(entry.longest_gap_from_s, 1),
            fixed(entry.lowest, 2),
            fixed(entry.highest, 2),
            significant(entry.step.unwrap_or(f64::NAN), 2),
            entry.unit.replace("_s", "/s"),
            entry.wraps.map_or_else(|| MISSING.to_owned(), |wraps| wraps.to_string()),
            text(&entry.turns_to),
            text(&entry.reference),
            three(entry.scale),
            optional(entry.lag_s, 2),
        ]);
    }
    table
}
