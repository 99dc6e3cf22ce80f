//! Draft of a sidecar for a table: every column with its meaning, guessed or certain, for the user to check.

use std::path::Path;

use super::error::{ReadError, ReadProblem};
use super::head;
use super::input::{self, FileContent};
use super::limits::is_comment;
use super::lines::Lines;
use crate::cells::{CellContent, Separator, parse_cell};
use crate::channel::{Channel, Unit};
use crate::encoding::Encoding;
use crate::names::{ColumnMeaning, column_meaning, meaning_with_unit, quantity_unit_meaning};
use crate::sidecar::Sidecar;
use crate::wording::shortened;

/// Number of rows whose values are summarised.
const SUMMARISED_ROWS: usize = 1000;

/// Text of the draft of a sidecar for the table at `path`; columns without names are described by their index.
///
/// Fails as the reader does up to the header; for sentences, which require no sidecar; and for a line within the first
/// thousand rows that cannot be read.
pub fn draft_sidecar(path: &Path) -> Result<String, ReadError> {
    let fault = |problem| ReadError::table(path, problem);
    let open = || match input::open(path).map_err(fault)? {
        (FileContent::Table(table), _) => Ok(table),
        (FileContent::Sentences(_) | FileContent::Messages(..), _) => Err(fault(ReadProblem::NeedsNoSidecar)),
    };
    let table = open()?;
    let declared = table.is_generated.then_some(Separator::Tab);
    let mut lines = Lines::new(table.bytes, Encoding::Utf8);
    let head = match head::find(&mut lines, declared, &Sidecar::default()) {
        Err(ReadProblem::NoHeader { .. }) => {
            lines = Lines::new(open()?.bytes, Encoding::Utf8);
            None
        }
        head => Some(head.map_err(fault)?),
    };
    let read = head.iter().flat_map(|head| &head.rows);
    let mut texts: Vec<String> = read.map(|(_, text)| text.clone()).collect();
    while texts.len() < SUMMARISED_ROWS {
        match lines.next_line().map_err(fault)? {
            Some(text) if is_comment(text) || text.trim().is_empty() => {}
            Some(text) => texts.push(text.to_owned()),
            None => break,
        }
    }
    let first = texts.first().map_or("", String::as_str);
    let numbers = || head::separator_of_numbers(first).unwrap_or(Separator::Blank);
    let separator = head.as_ref().map_or_else(numbers, |head| head.separator);
    let mut text = begin(path, separator, head.is_some());
    let Some(head) = head else {
        for index in 0..head::split(first, separator).len() {
            let (summary, rudder) = (summary(&texts, index, separator), Channel::Rudder.column_name());
            text.push_str(&format!("\n# {summary}\n# Not recognised; if the column is needed, say what it holds:\n"));
            text.push_str(&format!("# [[column]]\n# index = {}\n# is = \"{rudder}\"\n", index + 1));
        }
        return Ok(text + END);
    };
    for (index, name) in head.names.iter().enumerate() {
        let meaning =
            column_meaning(name).map(|m| head.unit(index).and_then(|unit| meaning_with_unit(m, unit)).unwrap_or(m));
        let quoted = toml::Value::from(name.as_str());
        let (remark, is) = description(name, &quoted.to_string(), meaning);
        text.push_str(&format!("\n# {}\n# {remark}\n", summary(&texts, index, separator)));
        if let Some(is) = is {
            text.push_str(&format!("[[column]]\nname = {quoted}\nis = \"{is}\"\n"));
        } else if meaning.is_none() {
            text.push_str(&format!("# [[column]]\n# name = {quoted}\n# is = \"rudder_deg\"\n"));
        }
    }
    Ok(text + END)
}

/// Remark on a column, and the value of its key `is` if the sidecar must describe it.
fn description(name: &str, quoted: &str, meaning: Option<ColumnMeaning>) -> (String, Option<String>) {
    let recognised = || "Recognised by its name and unit; check it.".to_owned();
    match meaning {
        _ if quantity_unit_meaning(name).is_some() => {
            (format!("The name {quoted} states quantity and unit; no description is needed."), None)
        }
        Some(ColumnMeaning::Channel(channel, Some(unit))) => (recognised(), Some(channel.name_in(unit))),
        Some(ColumnMeaning::SpeedOverGround(unit)) => {
            let remark = "GUESS: a speed over ground; check the unit, or ignore the column if there is a current.";
            (remark.to_owned(), Some(Channel::Speed.name_in(unit.unwrap_or(Unit::Knot))))
        }
        Some(ColumnMeaning::Channel(channel, None)) => {
            let names = channel.accepted_names();
            (format!("GUESS: the name has no unit; {names} are possible."), Some(channel.column_name()))
        }
        Some(ColumnMeaning::Time(Some(unit))) => (recognised(), Some(format!("t_{}", unit.id()))),
        Some(ColumnMeaning::Time(None)) => {
            let remark = "GUESS: time; stamps of date and time need no unit, numbers are taken as seconds.";
            (remark.to_owned(), Some("t_s".to_owned()))
        }
        Some(ColumnMeaning::Date | ColumnMeaning::Latitude | ColumnMeaning::Longitude) => {
            (format!("{quoted} is recognised by its name; no description is needed."), None)
        }
        Some(ColumnMeaning::CourseOverGround) => {
            (format!("{quoted} is the course over ground, not the heading; it is not used."), None)
        }
        None => (format!("{quoted} is not recognised; if the column is needed, say what it holds:"), None),
    }
}

fn begin(path: &Path, separator: Separator, header: bool) -> String {
    let separator = match separator {
        Separator::Tab => "tab",
        Separator::Semicolon => "semicolon",
        Separator::Comma => "comma",
        Separator::Blank => "blank",
    };
    let file = path.file_name().map_or_else(String::new, |name| shortened(&name.to_string_lossy()));
    let header = if header { "" } else { "header = false\n" };
    format!(
        "# Columns of {file}. Check every line; lines that begin with # are ignored.\n\
         # `study list sidecar` lists the keys of this file, `study list columns` the quantities of a column.\n\n\
         # A trial with neither wind nor waves, as in a towing tank:\n# weather = \"none\"\n\n\
         [table]\nseparator = \"{separator}\"\n{header}"
    )
}

const END: &str = "\n# Length and approach speed of the ship, for the IMO criteria:\n# [ship]\n# length-m = 100.0\n# speed-kn = 15.0\n\
                   \n# Part of the log, if the detected zig-zag is not the right one:\n# [part]\n# from-s = 0.0\n# until-s = 600.0\n";

/// Sentence on the content of a column in the first rows.
fn summary(rows: &[String], index: usize, separator: Separator) -> String {
    let mut ranges = Vec::new();
    let (mut low, mut high, mut numbers, mut word) = (f64::INFINITY, f64::NEG_INFINITY, 0, None);
    for row in rows {
        separator.split(row, &mut ranges);
        let text = ranges.get(index).map_or("", |range| &row[range.clone()]);
        match parse_cell(text, separator) {
            CellContent::Text => word = word.or_else(|| Some(shortened(text))),
            read => {
                if let Some(value) = read.number() {
                    (low, high, numbers) = (low.min(value), high.max(value), numbers + 1);
                }
            }
        }
    }
    let column = index + 1;
    match (numbers, word) {
        (0, None) => format!("Column {column} is empty in the first {} rows.", rows.len()),
        (0, Some(word)) => format!("Column {column} holds text such as `{word}`."),
        (_, _) => format!("Column {column} goes from {low} to {high} in the first {} rows.", rows.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sidecar::Sidecar;

    #[test]
    fn what_is_written_is_a_sidecar() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("log.csv");
        let rows: String = (0..40).map(|t| format!("{t};350,{t};10;1,5;x\n")).collect();
        std::fs::write(&path, format!("Zeit [s];Heading;Ruderlage (Grad);SOG;\"my \\\\ load\"\n{rows}"))
            .expect("written");
        let text = draft_sidecar(&path).expect("a table");
        let sidecar = Sidecar::parse(&text, Path::new("log.trial.toml")).expect(&text);
        assert_eq!(sidecar.columns.len(), 4, "{text}");
        assert!(text.contains("is = \"rudder_deg\"") && text.contains("GUESS"), "{text}");
        assert!(text.contains("Column 2 goes from 350 to 350.9"), "{text}");
        std::fs::write(&path, rows.replace(";x", "")).expect("written");
        let text = draft_sidecar(&path).expect("a table");
        let sidecar = Sidecar::parse(&text, Path::new("log.trial.toml")).expect(&text);
        assert!(!sidecar.has_header() && text.contains("# index = 4"), "{text}");
    }
}
