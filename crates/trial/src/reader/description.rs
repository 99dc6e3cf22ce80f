//! A first sidecar for a table: what was understood of every column, what was guessed and what was not, for a person to
//! check.

use std::fmt::Write as _;
use std::path::Path;

use super::error::{Problem, ReadError};
use super::head::{self, Found};
use super::input::{self, Content};
use super::lines::Lines;
use crate::cells::{Cell, Separator, cell};
use crate::channel::Channel;
use crate::encoding::Encoding;
use crate::names::{Said, said, with_unit};
use crate::sidecar::Quantity;
use crate::words::shortened;

/// Rows whose values are shown.
const SHOWN: usize = 1000;

/// The text of a sidecar for the table at `path`.
///
/// Fails as reading does up to the header; for sentences, which need none; and for a table in whose first thousand rows
/// no line can be read.
pub fn describe(path: &Path) -> Result<String, ReadError> {
    let fault = |problem| ReadError::table(path, problem);
    let (content, _) = input::open(path).map_err(fault)?;
    let Content::Table(table) = content else { return Err(fault(Problem::NeedsNoSidecar)) };
    let mut lines = Lines::new(table.bytes, Encoding::Utf8);
    let found = head::find(&mut lines, table.is_made.then_some(Separator::Tab), None);
    let Found { head, rows, .. } = match found {
        // A table of numbers alone is described by the places of its columns.
        Err(Problem::NoHeader { .. }) => return headless(path),
        found => found.map_err(fault)?,
    };
    let mut texts: Vec<String> = rows.into_iter().map(|(_, text)| text).collect();
    while texts.len() < SHOWN {
        match lines.next_line().map_err(fault)? {
            Some(text) => texts.push(text.to_owned()),
            None => break,
        }
    }
    let mut text = begin(path, head.separator, true);
    for (place, name) in head.names.iter().enumerate() {
        let range = range(&texts, place, head.separator);
        let unit = head.units.get(place).copied().flatten();
        let said = said(name).map(|said| unit.and_then(|unit| with_unit(said, unit)).unwrap_or(said));
        let _ = writeln!(text, "\n# {range}");
        let name = toml::Value::from(name.as_str());
        match (Quantity::of(name.as_str().unwrap_or_default()), said) {
            (Some(_), _) => {
                let _ = writeln!(text, "# The name of {name} says what it holds; nothing has to be described.");
            }
            (None, Some(Said::Channel(channel, Some(unit)))) => {
                let _ = writeln!(text, "# Understood by its name and unit; check it.");
                let _ = writeln!(text, "[[column]]\nname = {name}\nis = \"{}_{}\"", channel.quantity(), unit.id());
            }
            (None, Some(Said::OverGround(unit))) => {
                let _ = writeln!(
                    text,
                    "# GUESS: a speed over ground; check the unit, or ignore it where there is a current."
                );
                let unit = unit.map_or("kn", |unit| unit.id());
                let _ = writeln!(text, "[[column]]\nname = {name}\nis = \"speed_{unit}\"");
            }
            (None, Some(Said::Channel(channel, None))) => {
                let unit = channel.written_unit().id();
                let _ = writeln!(text, "# GUESS: the unit is not written; {} are possible.", channel.accepted_names());
                let _ = writeln!(text, "[[column]]\nname = {name}\nis = \"{}_{unit}\"", channel.quantity());
            }
            (None, Some(Said::Time(Some(unit)))) => {
                let _ = writeln!(text, "# Understood by its name and unit; check it.");
                let _ = writeln!(text, "[[column]]\nname = {name}\nis = \"t_{}\"", unit.id());
            }
            (None, Some(Said::Time(None))) => {
                let _ = writeln!(
                    text,
                    "# GUESS: time; stamps of date and time need no unit, numbers are taken as seconds."
                );
                let _ = writeln!(text, "[[column]]\nname = {name}\nis = \"t_s\"");
            }
            (None, Some(Said::Date | Said::Latitude | Said::Longitude)) => {
                let _ = writeln!(text, "# {name} is understood by its name; nothing has to be described.");
            }
            (None, Some(Said::Course)) => {
                let _ = writeln!(text, "# {name} is the course over ground, which is no heading; it is not used.");
            }
            (None, None) => {
                let _ = writeln!(text, "# {name} is not understood; where it is needed, say what it holds:");
                let _ = writeln!(text, "# [[column]]\n# name = {name}\n# is = \"rudder_deg\"");
            }
        }
    }
    text.push_str(END);
    Ok(text)
}

/// The sidecar of a table without names.
fn headless(path: &Path) -> Result<String, ReadError> {
    let fault = |problem| ReadError::table(path, problem);
    let (content, _) = input::open(path).map_err(fault)?;
    let Content::Table(table) = content else { return Err(fault(Problem::NeedsNoSidecar)) };
    let mut lines = Lines::new(table.bytes, Encoding::Utf8);
    let mut texts: Vec<String> = Vec::new();
    while texts.len() < SHOWN {
        match lines.next_line().map_err(fault)? {
            Some(text) if super::limits::is_comment(text) || text.trim().is_empty() => {}
            Some(text) => texts.push(text.to_owned()),
            None => break,
        }
    }
    let separator = texts.first().and_then(|line| head::numbers_of(line)).unwrap_or(Separator::Blank);
    let mut ranges = Vec::new();
    separator.split(texts.first().map_or("", String::as_str), &mut ranges);
    let mut text = begin(path, separator, false);
    for place in 0..ranges.len() {
        let range = range(&texts, place, separator);
        let _ = writeln!(text, "\n# {range}\n# Not understood; where it is needed, say what it holds:");
        let _ = writeln!(text, "# [[column]]\n# index = {}\n# is = \"{}\"", place + 1, Channel::Rudder.column_name());
    }
    text.push_str(END);
    Ok(text)
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
            Cell::Number(value) | Cell::CommaNumber(value) => {
                (low, high, numbers) = (low.min(value), high.max(value), numbers + 1);
            }
            Cell::Missing => {}
            Cell::Text => word = word.or_else(|| Some(shortened(text))),
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
        assert!(!sidecar.header && text.contains("# index = 4"), "{text}");
    }
}
