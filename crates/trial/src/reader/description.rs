//! A first sidecar for a table: what was understood of every column, what was guessed and what was not, for a person to
//! check.

use std::path::Path;

use super::error::{Problem, ReadError};
use super::head;
use super::input::{self, Content};
use super::limits::is_comment;
use super::lines::Lines;
use crate::cells::{Cell, Separator, cell};
use crate::channel::{Channel, Unit};
use crate::encoding::Encoding;
use crate::names::{ColumnMeaning, contract, meaning, with_unit};
use crate::sidecar::Sidecar;
use crate::words::shortened;

/// Rows whose values are shown.
const SHOWN: usize = 1000;

/// The text of a sidecar for the table at `path`; one of numbers alone is described by the places of its columns.
///
/// Fails as reading does up to the header; for sentences, which need none; and for a table in whose first thousand rows
/// no line can be read.
pub fn describe(path: &Path) -> Result<String, ReadError> {
    let fault = |problem| ReadError::table(path, problem);
    let open = || match input::open(path).map_err(fault)? {
        (Content::Table(table), _) => Ok(table),
        (Content::Sentences(_) | Content::Messages(..), _) => Err(fault(Problem::NeedsNoSidecar)),
    };
    let table = open()?;
    let declared = table.is_made.then_some(Separator::Tab);
    let mut lines = Lines::new(table.bytes, Encoding::Utf8);
    let head = match head::find(&mut lines, declared, &Sidecar::default()) {
        Err(Problem::NoHeader { .. }) => {
            lines = Lines::new(open()?.bytes, Encoding::Utf8);
            None
        }
        found => Some(found.map_err(fault)?),
    };
    let read = head.iter().flat_map(|head| &head.rows);
    let mut texts: Vec<String> = read.map(|(_, text)| text.clone()).collect();
    while texts.len() < SHOWN {
        match lines.next_line().map_err(fault)? {
            Some(text) if is_comment(text) || text.trim().is_empty() => {}
            Some(text) => texts.push(text.to_owned()),
            None => break,
        }
    }
    let first = texts.first().map_or("", String::as_str);
    let separator = head.as_ref().map_or_else(|| head::numbers_of(first).unwrap_or(Separator::Blank), |h| h.separator);
    let mut text = begin(path, separator, head.is_some());
    let Some(head) = head else {
        for place in 0..head::split(first, separator).len() {
            let (range, rudder) = (range(&texts, place, separator), Channel::Rudder.column_name());
            text.push_str(&format!("\n# {range}\n# Not understood; where it is needed, say what it holds:\n"));
            text.push_str(&format!("# [[column]]\n# index = {}\n# is = \"{rudder}\"\n", place + 1));
        }
        return Ok(text + END);
    };
    for (place, name) in head.names.iter().enumerate() {
        let said = meaning(name).map(|said| head.unit(place).and_then(|unit| with_unit(said, unit)).unwrap_or(said));
        let quoted = toml::Value::from(name.as_str());
        let (remark, is) = understood(name, &quoted.to_string(), said);
        text.push_str(&format!("\n# {}\n# {remark}\n", range(&texts, place, separator)));
        if let Some(is) = is {
            text.push_str(&format!("[[column]]\nname = {quoted}\nis = \"{is}\"\n"));
        } else if said.is_none() {
            text.push_str(&format!("# [[column]]\n# name = {quoted}\n# is = \"rudder_deg\"\n"));
        }
    }
    Ok(text + END)
}

/// What is to be said of a column by its name, and what it is, where that has to be described.
fn understood(name: &str, quoted: &str, said: Option<ColumnMeaning>) -> (String, Option<String>) {
    let own_words = || "Understood by its name and unit; check it.".to_owned();
    match said {
        _ if contract(name).is_some() => {
            (format!("The name of {quoted} says what it holds; nothing has to be described."), None)
        }
        Some(ColumnMeaning::Channel(channel, Some(unit))) => (own_words(), Some(channel.name_in(unit))),
        Some(ColumnMeaning::OverGround(unit)) => {
            let remark = "GUESS: a speed over ground; check the unit, or ignore it where there is a current.";
            (remark.to_owned(), Some(Channel::Speed.name_in(unit.unwrap_or(Unit::Knot))))
        }
        Some(ColumnMeaning::Channel(channel, None)) => {
            let names = channel.accepted_names();
            (format!("GUESS: the unit is not written; {names} are possible."), Some(channel.column_name()))
        }
        Some(ColumnMeaning::Time(Some(unit))) => (own_words(), Some(format!("t_{}", unit.id()))),
        Some(ColumnMeaning::Time(None)) => {
            let remark = "GUESS: time; stamps of date and time need no unit, numbers are taken as seconds.";
            (remark.to_owned(), Some("t_s".to_owned()))
        }
        Some(ColumnMeaning::Date | ColumnMeaning::Latitude | ColumnMeaning::Longitude) => {
            (format!("{quoted} is understood by its name; nothing has to be described."), None)
        }
        Some(ColumnMeaning::Course) => {
            (format!("{quoted} is the course over ground, which is no heading; it is not used."), None)
        }
        None => (format!("{quoted} is not understood; where it is needed, say what it holds:"), None),
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
        "# What the columns of {file} hold. Check every line; a line that begins with # says nothing to the program.\n\
         # `study list sidecar` lists what can be said, `study list columns` what a column can hold.\n\n\
         # A trial with neither wind nor waves, as in a towing tank:\n# weather = \"none\"\n\n\
         [table]\nseparator = \"{separator}\"\n{header}"
    )
}

const END: &str = "\n# Length and approach speed of the ship, for the IMO criteria:\n# [ship]\n# length-m = 100.0\n# speed-kn = 15.0\n\
                   \n# The part that is used, where it is not the zig-zag that is found:\n# [part]\n# from-s = 0.0\n# until-s = 600.0\n";

/// What a column holds in the first rows, for the eyes of a person.
fn range(rows: &[String], place: usize, separator: Separator) -> String {
    let mut ranges = Vec::new();
    let (mut low, mut high, mut numbers, mut word) = (f64::INFINITY, f64::NEG_INFINITY, 0, None);
    for row in rows {
        separator.split(row, &mut ranges);
        let text = ranges.get(place).map_or("", |range| &row[range.clone()]);
        match cell(text, separator) {
            Cell::Text => word = word.or_else(|| Some(shortened(text))),
            read => {
                if let Some(value) = read.number() {
                    (low, high, numbers) = (low.min(value), high.max(value), numbers + 1);
                }
            }
        }
    }
    let place = place + 1;
    match (numbers, word) {
        (0, None) => format!("Column {place} is empty in the first {} rows.", rows.len()),
        (0, Some(word)) => format!("Column {place} holds text such as `{word}`."),
        (_, _) => format!("Column {place} goes from {low} to {high} in the first {} rows.", rows.len()),
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
        let text = describe(&path).expect("a table");
        let sidecar = Sidecar::parse(&text, Path::new("log.trial.toml")).expect(&text);
        assert_eq!(sidecar.columns.len(), 4, "{text}");
        assert!(text.contains("is = \"rudder_deg\"") && text.contains("GUESS"), "{text}");
        assert!(text.contains("Column 2 goes from 350 to 350.9"), "{text}");
        std::fs::write(&path, rows.replace(";x", "")).expect("written");
        let text = describe(&path).expect("a table");
        let sidecar = Sidecar::parse(&text, Path::new("log.trial.toml")).expect(&text);
        assert!(!sidecar.has_header() && text.contains("# index = 4"), "{text}");
    }
}
