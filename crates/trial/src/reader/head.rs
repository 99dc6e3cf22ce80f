//! Head of a table: skipped lines, the names of the columns, a row of units below them, and the separator, which is
//! recognised from the lines.

use std::io::Read;

use super::error::ReadProblem;
use super::limits::{is_comment, no_rows_problem};
use super::lines::Lines;
use crate::cells::{CellContent, Separator, detect_separator, parse_cell, unquoted};
use crate::channel::Unit;
use crate::names;
use crate::sidecar::{ColumnReference, Sidecar};
use crate::wording::shortened;

/// Maximum number of lines before the header: some programs state the ship and the trial there.
const MAX_PREAMBLE_LINES: usize = 60;

/// Number of lines read for the head: with a header and units after the maximum preamble, a row is among them.
const HEAD_LINES: usize = MAX_PREAMBLE_LINES + 4;

/// Line with its number.
type NumberedLine = (usize, String);

/// Head of a table, with the rows read with it.
#[derive(Debug)]
pub(super) struct Head {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Units in the row below the names; empty without such a row.
    units: Vec<Option<Unit>>,
    /// Line of the names.
    pub line: usize,
    /// Separator of the cells.
    pub separator: Separator,
    /// First rows with their lines.
    pub rows: Vec<NumberedLine>,
    /// Number of nonempty lines before the names, without those that the sidecar skips.
    pub skipped: usize,
}

impl Head {
    /// Unit in the row below the name of a column; `None` if there is none for it.
    pub fn unit(&self, index: usize) -> Option<Unit> {
        self.units.get(index).copied().flatten()
    }

    /// Cells of the first row.
    pub fn first_row(&self) -> Vec<&str> {
        self.rows.first().map_or_else(Vec::new, |(_, text)| split(text, self.separator))
    }
}

/// First nonempty lines below the first `skipped`, at most [`HEAD_LINES`], and the last comment above them.
fn begin<R: Read>(lines: &mut Lines<R>, skipped: usize) -> Result<(Vec<NumberedLine>, NumberedLine), ReadProblem> {
    while lines.line_number() < skipped && lines.skip()? {}
    let (mut begin, mut comment) = (Vec::new(), NumberedLine::default());
    while begin.len() < HEAD_LINES
        && lines.line_number() >= skipped
        && let Some(text) = lines.next_line()?.map(str::to_owned)
    {
        if is_comment(&text) && begin.is_empty() {
            comment = (lines.line_number(), text.trim_start_matches([' ', '#']).to_owned());
        } else if !is_comment(&text) && !text.trim().is_empty() {
            begin.push((lines.line_number(), text));
        }
    }
    match lines.line_number() {
        0 => Err(ReadProblem::Empty),
        last if begin.is_empty() => Err(no_rows_problem(last)),
        _ => Ok((begin, comment)),
    }
}

/// Head of a table; `declared` is the separator declared by a sidecar.
///
/// Fails for an empty file, a table without lines below the skipped lines, and numbers in place of a header.
pub(super) fn find<R: Read>(
    lines: &mut Lines<R>,
    declared: Option<Separator>,
    sidecar: &Sidecar,
) -> Result<Head, ReadProblem> {
    let skipped = sidecar.table.skip_lines;
    let (mut begin, (comment_line, comment)) = begin(lines, skipped)?;
    let (line, text) = &begin[0];
    let numbers = separator_of_numbers(text);
    let count_names = |cells: &[&str]| cells.iter().filter(|name| has_meaning(name, sidecar)).count();
    let has_names = |line: &str, separator: Separator| count_names(&split(line, separator)) >= 2;
    // Two names are sufficient: with blanks, `Time UTC` between tabs would count as two.
    let separator_of =
        |line: &str| declared.unwrap_or_else(|| detect_separator(line, |cells| count_names(cells).min(2)));
    let names_of = |line: &str, separator| split(line, separator).into_iter().map(unquoted).collect();
    let without_units =
        |line, names, separator| Head { names, units: Vec::new(), line, separator, rows: Vec::new(), skipped: 0 };
    let (head, first) = if !sidecar.has_header() {
        let separator = declared.or(numbers).unwrap_or(Separator::Blank);
        let names = (1..=split(text, separator).len()).map(|number| format!("column_{number}")).collect();
        (without_units(*line, names, separator), 0)
    } else if let Some(separator) = numbers {
        // The rows begin in the first line. Some programs write the names in the comment above.
        let name_separator = separator_of(&comment);
        if !has_names(&comment, name_separator) {
            return Err(ReadProblem::NoHeader { line: *line, text: shortened(text) });
        }
        (without_units(comment_line, names_of(&comment, name_separator), declared.unwrap_or(separator)), 0)
    } else {
        let first_separator = separator_of(text);
        let by_index = sidecar.columns.iter().any(|column| matches!(column.which, ColumnReference::Index(_)));
        let later = || {
            let candidates = begin.iter().enumerate().skip(1).take(MAX_PREAMBLE_LINES);
            let mut separated = candidates.map(|(index, (_, text))| (index, text, separator_of(text)));
            separated.find(|(_, text, separator)| has_names(text, *separator))
        };
        let is_header = has_names(text, first_separator) || skipped > 0 || by_index;
        let (skipped, text, separator) = if is_header { None } else { later() }.unwrap_or((0, text, first_separator));
        let below = begin.get(skipped + 1).and_then(|(_, text)| units_of(&split(text, separator), separator));
        let first = skipped + 1 + usize::from(below.is_some());
        let head = without_units(begin[skipped].0, names_of(text, separator), separator);
        (Head { skipped, units: below.unwrap_or_default(), ..head }, first)
    };
    Ok(Head { rows: begin.split_off(first.min(begin.len())), ..head })
}

/// Units of a row of units; `None` for a row of values.
fn units_of(cells: &[&str], separator: Separator) -> Option<Vec<Option<Unit>>> {
    let filled = cells.iter().filter(|text| !text.is_empty()).count();
    let units: Vec<Option<Unit>> = cells.iter().map(|text| names::parse_unit(text)).collect();
    let is_value = |text: &&str| parse_cell(text, separator).number().is_some();
    let count = units.iter().flatten().count();
    (count > 0 && 2 * count >= filled && !cells.iter().any(is_value)).then_some(units)
}

/// Separator of a line of numbers: the separator with the most cells; `None` for a line with text.
pub(super) fn separator_of_numbers(line: &str) -> Option<Separator> {
    let count = |separator: Separator| {
        let cells = split(line, separator);
        let all = cells.iter().all(|text| parse_cell(text, separator) != CellContent::Text);
        if all { cells.len() } else { 0 }
    };
    // Ties go to the earlier separator, so the search runs from the last.
    let best = Separator::ALL.into_iter().rev().max_by_key(|&separator| count(separator))?;
    (count(best) > 0).then_some(best)
}

/// `true` for a name with a meaning, or a name described in the sidecar.
fn has_meaning(name: &str, sidecar: &Sidecar) -> bool {
    let is_described = || sidecar.columns.iter().any(|column| column.which == ColumnReference::Name(name.to_owned()));
    names::column_meaning(name).is_some() || is_described()
}

pub(super) fn split(line: &str, separator: Separator) -> Vec<&str> {
    let mut ranges = Vec::new();
    separator.split(line, &mut ranges);
    ranges.into_iter().map(|range| &line[range]).collect()
}
