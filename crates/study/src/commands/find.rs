//! `study find`: the manoeuvres inside long logs.

use std::path::PathBuf;

use report::Table;
use report::number::{MISSING, fixed, optional};
use ship::angle::to_deg;
use trial::Log;
use trial::file::called;
use trial::find::FoundManoeuvre;

use crate::documents;
use crate::documents::find::{FindAnswer, LogEntry};
use crate::options::{Common, FindRequest, Format};
use crate::records::{expand, manoeuvres, open};
use crate::screen;
use scenario::failure::Failure;

/// The logs of a request.
///
/// Fails when a folder of them cannot be listed, and when a file is to be joined with several.
fn files(request: &FindRequest) -> Result<Vec<PathBuf>, Failure> {
    let files = expand(&request.logs)?;
    if files.len() > 1 && !request.with_columns.is_empty() {
        return Err(Failure::input(format!("--with-columns is for one log, {} are given; give one", files.len())));
    }
    Ok(files)
}

/// The manoeuvres of every log, for other programs.
///
/// Fails when a log cannot be read.
pub fn found(request: &FindRequest, warnings: &mut Vec<String>) -> Result<FindAnswer, Failure> {
    let one = |file: PathBuf| {
        let log = open(&file, request.columns.as_deref(), &request.with_columns, warnings)?;
        Ok(LogEntry::of(called(&file), &log, &manoeuvres(&log)))
    };
    Ok(FindAnswer { logs: files(request)?.into_iter().map(one).collect::<Result<_, Failure>>()? })
}

/// Prints the manoeuvres of every log.
///
/// Fails when a log cannot be read.
pub fn run(request: &FindRequest, common: &Common) -> Result<(), Failure> {
    let mut warnings = Vec::new();
    if common.format == Format::Json {
        documents::say(&found(request, &mut warnings)?)?;
        screen::warn_of(common, &warnings);
        return Ok(());
    }
    let files = files(request)?;
    for file in &files {
        let log = open(file, request.columns.as_deref(), &request.with_columns, &mut warnings)?;
        let file = called(file);
        let found = manoeuvres(&log);
        if common.is_silent() {
            continue;
        }
        let table = common.format.render(&table(&log, &found));
        if common.format != Format::Text {
            screen::say(table.trim_end())?;
            continue;
        }
        let time = log.time();
        let duration = time.last().zip(time.first()).map_or(0.0, |(last, first)| last - first);
        let day = log.clock().and_then(|clock| clock.date_at(time[0])).map(|day| format!(", {day}"));
        let head =
            format!("{}: {} rows, {} s{}", file.display(), time.len(), fixed(duration, 1), day.unwrap_or_default());
        if found.is_empty() {
            screen::say(&format!("{head}\nno manoeuvre found\n"))?;
            continue;
        }
        let remarked = (1..).zip(&found).filter(|(_, one)| !one.quality.remarks().is_empty());
        let remarks = remarked.map(|(number, one)| format!("{number}: {}\n", one.quality.remarks().join(" ")));
        let remarks: String = remarks.collect();
        screen::say(&format!("{head}\n\n{table}\n{remarks}"))?;
    }
    screen::warn_of(common, &warnings);
    Ok(())
}

fn table(log: &Log, found: &[FoundManoeuvre]) -> Table {
    let mut table = Table::headed(
        ".--trial | manoeuvre | .from [s] | .until [s] | clock | .executes | .rudder [deg] | .heading [deg]",
    );
    for (number, one) in (1..).zip(found) {
        let clock = log.clock().map(|clock| format!("{} to {}", clock.at(one.from), clock.at(one.until)));
        let missing = || MISSING.to_owned();
        let [rudder, heading] = one.angles().map(|angle| optional(angle.map(to_deg), 1));
        table.push([
            number.to_string(),
            one.name(),
            fixed(one.from, 1),
            fixed(one.until, 1),
            clock.unwrap_or_else(missing),
            one.executes.to_string(),
            rudder,
            heading,
        ]);
    }
    table
}
