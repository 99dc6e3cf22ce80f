//! The head of a table: lines that are passed over, the names of the columns, a row of units below them, and the
//! separator, recognised from the lines themselves.

use std::collections::VecDeque;
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

/// The head of a table, and the rows that had to be read to find it.
#[derive(Debug)]
pub(super) struct Head {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Units below the names, where a row holds them.
    units: Vec<Option<Unit>>,
    /// Line of the names.
    pub line: usize,
    /// Cells of the first row.
    pub first: Vec<String>,
    /// What stands between cells.
    pub separator: Separator,
    /// The first rows with their lines.
    pub rows: VecDeque<NumberedLine>,
    /// Lines passed over before the names.
    pub passed: usize,
}

impl Head {
    /// The unit below the name of a column.
    pub fn unit(&self, place: usize) -> Option<Unit> {
        self.units.get(place).copied().flatten()
    }
}

/// A line with its number.
type NumberedLine = (usize, String);

/// Lines with something in them, from those read already or from the file.
struct Ahead<'a, R> {
    lines: &'a mut Lines<R>,
    pending: VecDeque<NumberedLine>,
    /// The last comment.
    comment: Option<NumberedLine>,
}

impl<R: Read> Ahead<'_, R> {
    fn next(&mut self) -> Result<Option<NumberedLine>, Problem> {
        loop {
            let (number, text) = match self.pending.pop_front() {
                Some(line) => line,
                None => match self.lines.next_line()?.map(str::to_owned) {
                    Some(text) => (self.lines.number(), text),
                    None => return Ok(None),
                },
            };
            if is_comment(&text) {
                self.comment = Some((number, text.trim_start_matches([' ', '#']).to_owned()));
            } else if !text.trim().is_empty() {
                return Ok(Some((number, text)));
            }
        }
    }

    /// The problem of a file that ends before its first row.
    fn at_end(&self) -> Problem {
        match self.lines.number() {
            0 => Problem::Empty,
            last => no_rows(last),
        }
    }

    /// A head with these names; `first` is the first row.
    fn head(mut self, line: usize, names: Vec<String>, separator: Separator, first: Option<NumberedLine>) -> Head {
        let cells = first.as_ref().map_or_else(Vec::new, |(_, text)| owned(text, separator));
        first.into_iter().for_each(|first| self.pending.push_front(first));
        Head { names, units: Vec::new(), line, first: cells, separator, rows: self.pending, passed: 0 }
    }

    /// Looks for a line with two known names among the next; its separator by `separator_of`. The lines before it are
    /// passed over; where there is none they come again.
    fn search(
        &mut self,
        separator_of: impl Fn(&str) -> Separator,
        is_header: impl Fn(&str, Separator) -> bool,
    ) -> Result<Option<(NumberedLine, Separator, usize)>, Problem> {
        let mut read = VecDeque::new();
        while read.len() < MOST_BEFORE
            && let Some((number, text)) = self.next()?
        {
            let separator = separator_of(&text);
            if is_header(&text, separator) {
                return Ok(Some(((number, text), separator, read.len() + 1)));
            }
            read.push_back((number, text));
        }
        read.append(&mut self.pending);
        self.pending = read;
        Ok(None)
    }
}

/// Reads up to the first row; `declared` is the separator where it is known.
pub(super) fn find<R: Read>(
    lines: &mut Lines<R>,
    declared: Option<Separator>,
    sidecar: &Sidecar,
) -> Result<Head, Problem> {
    let skipped = sidecar.table.skip_lines;
    let mut ahead = Ahead { lines, pending: VecDeque::new(), comment: None };
    while ahead.lines.number() < skipped {
        if !ahead.lines.skip()? {
            return Err(ahead.at_end());
        }
    }
    let Some((line, text)) = ahead.next()? else { return Err(ahead.at_end()) };
    let numbers = numbers_of(&text);
    if !sidecar.has_header() {
        let separator = declared.or(numbers).unwrap_or(Separator::Blank);
        let names = (1..=split(&text, separator).len()).map(|place| format!("column_{place}")).collect();
        return Ok(ahead.head(line, names, separator, Some((line, text))));
    }
    let known = |cells: &[&str]| cells.iter().filter(|name| is_known(name, sidecar)).count();
    let has_names = |line: &str, separator: Separator| known(&split(line, separator)) >= 2;
    // Two names are enough: of `Time UTC` between tabs, blanks would make two.
    let separator_of = |line: &str| declared.unwrap_or_else(|| recognise(line, |cells| known(cells).min(2)));
    let names_of = |line: &str, separator| split(line, separator).into_iter().map(unquoted).collect();
    if let Some(separator) = numbers {
        // Rows from the first line on. Some programs write the names into the comment above.
        let (of_comment, comment) = ahead.comment.take().unwrap_or_default();
        let of_names = separator_of(&comment);
        if has_names(&comment, of_names) {
            let names = names_of(&comment, of_names);
            return Ok(ahead.head(of_comment, names, declared.unwrap_or(separator), Some((line, text))));
        }
        return Err(Problem::NoHeader { line, found: shortened(&text) });
    }
    let own = separator_of(&text);
    let by_place = sidecar.columns.iter().any(|column| matches!(column.which, Which::Place(_)));
    let is_header = has_names(&text, own) || skipped > 0 || by_place;
    let later = if is_header { None } else { ahead.search(separator_of, has_names)? };
    let ((line, text), separator, passed) = later.unwrap_or(((line, text), own, 0));
    let names = names_of(&text, separator);
    let mut first = ahead.next()?;
    let units = first.as_ref().and_then(|(_, text)| units_of(&split(text, separator), separator));
    if units.is_some() {
        first = ahead.next()?;
    }
    Ok(Head { passed, units: units.unwrap_or_default(), ..ahead.head(line, names, separator, first) })
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

fn owned(line: &str, separator: Separator) -> Vec<String> {
    split(line, separator).into_iter().map(str::to_owned).collect()
}
