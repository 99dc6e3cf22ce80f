//! The head of a table: lines that are passed over, the names of the columns, a row of units below them, and the
//! separator, recognised from the lines themselves.

use std::io::Read;

use super::error::Problem;
use super::limits::{is_comment, no_rows};
use super::lines::Lines;
use crate::cells::{Cell, Separator, cell, recognise, unquoted};
use crate::channel::Unit;
use crate::names;
use crate::sidecar::{Sidecar, Which};
use crate::words::shortened;

/// Most lines before the header: programs write the ship and the trial there.
const MOST_BEFORE: usize = 60;

/// Lines with something in them that are looked at: with a header and its units after as many others, a row is among
/// them.
const LOOKED_AT: usize = MOST_BEFORE + 4;

/// A line with its number.
type NumberedLine = (usize, String);

/// The head of a table, and the rows that had to be read to find it.
#[derive(Debug)]
pub(super) struct Head {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Units below the names, where a row holds them.
    units: Vec<Option<Unit>>,
    /// Line of the names.
    pub line: usize,
    /// What stands between cells.
    pub separator: Separator,
    /// The first rows with their lines.
    pub rows: Vec<NumberedLine>,
    /// Lines passed over before the names.
    pub passed: usize,
}

impl Head {
    /// The unit below the name of a column.
    pub fn unit(&self, place: usize) -> Option<Unit> {
        self.units.get(place).copied().flatten()
    }

    /// Cells of the first row.
    pub fn first(&self) -> Vec<&str> {
        self.rows.first().map_or_else(Vec::new, |(_, text)| split(text, self.separator))
    }
}

/// Reads the lines with something in them below the first `skipped`, and the comment above the first of them.
fn begin<R: Read>(lines: &mut Lines<R>, skipped: usize) -> Result<(Vec<NumberedLine>, NumberedLine), Problem> {
    while lines.number() < skipped && lines.skip()? {}
    let (mut begin, mut comment) = (Vec::new(), NumberedLine::default());
    while begin.len() < LOOKED_AT
        && lines.number() >= skipped
        && let Some(text) = lines.next_line()?.map(str::to_owned)
    {
        if is_comment(&text) && begin.is_empty() {
            comment = (lines.number(), text.trim_start_matches([' ', '#']).to_owned());
        } else if !is_comment(&text) && !text.trim().is_empty() {
            begin.push((lines.number(), text));
        }
    }
    match lines.number() {
        0 => Err(Problem::Empty),
        last if begin.is_empty() => Err(no_rows(last)),
        _ => Ok((begin, comment)),
    }
}

/// Reads up to the first row; `declared` is the separator where it is known.
pub(super) fn find<R: Read>(
    lines: &mut Lines<R>,
    declared: Option<Separator>,
    sidecar: &Sidecar,
) -> Result<Head, Problem> {
    let skipped = sidecar.table.skip_lines;
    let (mut begin, (of_comment, comment)) = begin(lines, skipped)?;
    let (line, text) = &begin[0];
    let numbers = numbers_of(text);
    let known = |cells: &[&str]| cells.iter().filter(|name| is_known(name, sidecar)).count();
    let has_names = |line: &str, separator: Separator| known(&split(line, separator)) >= 2;
    // Two names are enough: of `Time UTC` between tabs, blanks would make two.
    let separator_of = |line: &str| declared.unwrap_or_else(|| recognise(line, |cells| known(cells).min(2)));
    let names_of = |line: &str, separator| split(line, separator).into_iter().map(unquoted).collect();
    let without_units =
        |line, names, separator| Head { names, units: Vec::new(), line, separator, rows: Vec::new(), passed: 0 };
    let (head, first) = if !sidecar.has_header() {
        let separator = declared.or(numbers).unwrap_or(Separator::Blank);
        let names = (1..=split(text, separator).len()).map(|place| format!("column_{place}")).collect();
        (without_units(*line, names, separator), 0)
    } else if let Some(separator) = numbers {
        // Rows from the first line on. Some programs write the names into the comment above.
        let of_names = separator_of(&comment);
        if !has_names(&comment, of_names) {
            return Err(Problem::NoHeader { line: *line, found: shortened(text) });
        }
        (without_units(of_comment, names_of(&comment, of_names), declared.unwrap_or(separator)), 0)
    } else {
        let own = separator_of(text);
        let by_place = sidecar.columns.iter().any(|column| matches!(column.which, Which::Place(_)));
        let later = || {
            let others = begin.iter().enumerate().skip(1).take(MOST_BEFORE);
            let mut separated = others.map(|(place, (_, text))| (place, text, separator_of(text)));
            separated.find(|(_, text, separator)| has_names(text, *separator))
        };
        let is_header = has_names(text, own) || skipped > 0 || by_place;
        let (passed, text, separator) = if is_header { None } else { later() }.unwrap_or((0, text, own));
        let below = begin.get(passed + 1).and_then(|(_, text)| units_of(&split(text, separator), separator));
        let first = passed + 1 + usize::from(below.is_some());
        let head = without_units(begin[passed].0, names_of(text, separator), separator);
        (Head { passed, units: below.unwrap_or_default(), ..head }, first)
    };
    Ok(Head { rows: begin.split_off(first.min(begin.len())), ..head })
}

/// The units of a row that holds nothing else; `None` for a row of values.
fn units_of(cells: &[&str], separator: Separator) -> Option<Vec<Option<Unit>>> {
    let filled = cells.iter().filter(|text| !text.is_empty()).count();
    let units: Vec<Option<Unit>> = cells.iter().map(|text| names::unit(text)).collect();
    let is_value = |text: &&str| cell(text, separator).number().is_some();
    let count = units.iter().flatten().count();
    (count > 0 && 2 * count >= filled && !cells.iter().any(is_value)).then_some(units)
}

/// The separator between the cells of a line that holds numbers alone; the one with the most cells.
pub(super) fn numbers_of(line: &str) -> Option<Separator> {
    let count = |separator: Separator| {
        let cells = split(line, separator);
        let all = cells.iter().all(|text| cell(text, separator) != Cell::Text);
        if all { cells.len() } else { 0 }
    };
    // The earlier separator wins a tie, so the search runs from the last.
    let best = Separator::ALL.into_iter().rev().max_by_key(|&separator| count(separator))?;
    (count(best) > 0).then_some(best)
}

/// Whether a name in a header means something: to the reader or to the sidecar.
fn is_known(name: &str, sidecar: &Sidecar) -> bool {
    let is_described = || sidecar.columns.iter().any(|column| column.which == Which::Name(name.to_owned()));
    names::meaning(name).is_some() || is_described()
}

pub(super) fn split(line: &str, separator: Separator) -> Vec<&str> {
    let mut ranges = Vec::new();
    separator.split(line, &mut ranges);
    ranges.into_iter().map(|range| &line[range]).collect()
}
