//! `study find`: the manoeuvres inside long logs.

use std::path::{Path, PathBuf};

use document::Warnings;
use report::number::{MISSING, fixed, optional};
use report::{Table, TableHead};
use trial::file::display_path;

use crate::documents;
use crate::documents::find::{FindAnswer, ManoeuvreEntry, SearchedLog};
use crate::documents::log::LogEntry;
use crate::options::{CommonOptions, FindRequest, Format};
use crate::records::{open_log, record_files};
use crate::screen;
use campaign::failure::Failure;

/// The logs of a request.
///
/// Fails if a folder of logs cannot be listed, or if a file is to be joined with several logs.
fn files(request: &FindRequest) -> Result<Vec<PathBuf>, Failure> {
    let files = record_files(&request.logs)?;
    if files.len() > 1 && !request.with_columns.is_empty() {
        return Err(Failure::input(format!("--with-columns is for one log, but {} are given; give one", files.len())));
    }
    Ok(files)
}

/// Manoeuvres of every log, for other programs.
///
/// Fails if a log cannot be read.
pub fn find_answer(request: &FindRequest, warnings: &mut Warnings) -> Result<FindAnswer, Failure> {
    let entry_of = |file: &PathBuf| entry(file, request, warnings);
    let logs = files(request)?.iter().map(entry_of).collect::<Result<_, Failure>>()?;
    Ok(FindAnswer { logs, warnings: warnings.ranked() })
}

fn entry(file: &Path, request: &FindRequest, warnings: &mut Warnings) -> Result<SearchedLog, Failure> {
    let log = open_log(file, request.columns.as_deref(), &request.with_columns, warnings)?;
    Ok(SearchedLog::from_log(display_path(file), &log, &log.detected_manoeuvres()))
}

/// Prints the manoeuvres of every log.
///
/// Fails if a log cannot be read.
pub fn run(request: &FindRequest, common: &CommonOptions) -> Result<(), Failure> {
    let mut warnings = Warnings::default();
    if common.format == Format::Json {
        documents::print_document(&find_answer(request, &mut warnings)?)?;
        screen::print_warnings(common, &warnings.ranked());
        return Ok(());
    }
    for file in &files(request)? {
        let SearchedLog { log, manoeuvres } = entry(file, request, &mut warnings)?;
        let LogEntry { file, rows, duration_s, date } = log;
        if common.is_silent() {
            continue;
        }
        let table = common.format.render(&table(&manoeuvres));
        if common.format != Format::Text {
            screen::print_lines(table.trim_end())?;
            continue;
        }
        let day = date.map_or_else(String::new, |day| format!(", {day}"));
        let head = format!("{file}: {rows} rows, {} s{day}", fixed(duration_s, 1));
        if manoeuvres.is_empty() {
            screen::print_lines(&format!("{head}\nno manoeuvre found\n"))?;
            continue;
        }
        let remarked = manoeuvres.iter().filter(|entry| !entry.remarks.is_empty());
        let remarks: String = remarked.map(|entry| format!("{}: {}\n", entry.trial, entry.remarks.join(" "))).collect();
        screen::print_lines(&format!("{head}\n\n{table}\n{remarks}"))?;
    }
    screen::print_warnings(common, &warnings.ranked());
    Ok(())
}

fn table(manoeuvres: &[ManoeuvreEntry]) -> Table {
    let head = TableHead::default().numbers(["--trial"]).texts(["manoeuvre"]).numbers(["from", "until"]).unit("s");
    let head = head.texts(["clock"]).numbers(["executes"]).numbers(["rudder", "heading"]).unit("deg");
    let mut table = Table::new(head);
    for manoeuvre in manoeuvres {
        let clock = manoeuvre.clock.as_ref().map(|[from, until]| format!("{from} to {until}"));
        table.push([
            manoeuvre.trial.to_string(),
            manoeuvre.kind.clone(),
            fixed(manoeuvre.from_s, 1),
            fixed(manoeuvre.until_s, 1),
            clock.unwrap_or_else(|| MISSING.to_owned()),
            manoeuvre.executes.to_string(),
            optional(manoeuvre.rudder_deg, 1),
            optional(manoeuvre.heading_deg, 1),
        ]);
    }
    table
}
