//! The head of a table: lines that are passed over, the names of the columns, a row of units below them, and the
//! separator, recognised from the lines themselves.

use std::io::Read;

use super::error::Problem;
use super::layout::Head;
use super::limits::{is_comment, no_rows};
use super::lines::Lines;
use crate::cells::{Cell, Separator, cell, recognise, unquoted};
use crate::channel::Unit;
use crate::names;
use crate::sidecar::{Sidecar, Which};
use crate::words::shortened;

/// Most lines before the header: programs write the ship and the trial there.
const MOST_BEFORE: usize = 60;

/// The head of a table, and the rows that had to be read to find it, with their lines.
pub(super) struct Found {
    pub head: Head,
    pub rows: Vec<(usize, String)>,
    /// Lines passed over before the names.
    pub passed: usize,
}

/// Lines with something in them, from those read already or from the file.
struct Ahead<'a, R> {
    lines: &'a mut Lines<R>,
    pending: std::collections::VecDeque<(usize, String)>,
    /// The last comment.
    comment: Option<(usize, String)>,
}

impl<R: Read> Ahead<'_, R> {
    fn next(&mut self) -> Result<Option<(usize, String)>, Problem> {
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
}

impl<R> Ahead<'_, R> {
    /// The first row, and the lines after it that were read already.
    fn rows(&mut self, first: (usize, String)) -> Vec<(usize, String)> {
        std::iter::once(first).chain(self.pending.drain(..)).collect()
    }
}

/// Reads up to the first row; `declared` is the separator where it is known.
pub(super) fn find<R: Read>(
    lines: &mut Lines<R>,
    declared: Option<Separator>,
    sidecar: Option<&Sidecar>,
) -> Result<Found, Problem> {
    let skipped = sidecar.map_or(0, |sidecar| sidecar.skip_lines);
    let mut ahead = Ahead { lines, pending: Default::default(), comment: None };
    while ahead.lines.number() < skipped {
        if !ahead.lines.skip()? {
            return Err(if ahead.lines.number() == 0 { Problem::Empty } else { no_rows(ahead.lines.number()) });
        }
    }
    let Some((mut line, mut names)) = ahead.next()? else {
        let last = ahead.lines.number();
        return Err(if last == 0 { Problem::Empty } else { no_rows(last) });
    };
    let numbers = numbers_of(&names);
    if sidecar.is_some_and(|sidecar| !sidecar.header) {
        let separator = declared.or(numbers).unwrap_or(Separator::Blank);
        let first = owned(&names, separator);
        let columns = (1..=first.len()).map(|place| format!("column_{place}")).collect();
        let head = Head { names: columns, units: Vec::new(), line, first, separator };
        return Ok(Found { head, rows: ahead.rows((line, names)), passed: 0 });
    }
    let known = |cells: &[&str]| cells.iter().filter(|name| is_known(name, sidecar)).count();
    let known_of = |line: &str, separator: Separator| known(&split(line, separator));
    if let Some(separator) = numbers {
        // Rows from the first line on. Some programs write the names into the comment above.
        let separator = declared.unwrap_or(separator);
        if let Some((of_comment, comment)) = ahead.comment.take() {
            let of_names = declared.unwrap_or_else(|| recognise(&comment, |cells| known(cells).min(2)));
            if known_of(&comment, of_names) >= 2 {
                let columns = split(&comment, of_names).into_iter().map(unquoted).collect();
                let first = owned(&names, separator);
                let head = Head { names: columns, units: Vec::new(), line: of_comment, first, separator };
                return Ok(Found { head, rows: ahead.rows((line, names)), passed: 0 });
            }
        }
        return Err(Problem::NoHeader { line, found: shortened(&names) });
    }
    // Two names are enough: of `Time UTC` between tabs, blanks would make two.
    let separator_of = |line: &str| declared.unwrap_or_else(|| recognise(line, |cells| known(cells).min(2)));
    let mut separator = separator_of(&names);
    let mut passed = 0;
    let by_place = |sidecar: &Sidecar| sidecar.columns.iter().any(|column| matches!(column.which, Which::Place(_)));
    if known_of(&names, separator) < 2 && skipped == 0 && !sidecar.is_some_and(by_place) {
        let mut read = Vec::new();
        let mut header = None;
        while let Some((number, text)) = ahead.next()? {
            let own = separator_of(&text);
            let is_header = known_of(&text, own) >= 2;
            read.push((number, text));
            if is_header {
                header = Some(own);
                break;
            }
            if read.len() == MOST_BEFORE {
                break;
            }
        }
        if let Some(own) = header {
            (line, names) = read.pop().expect("the header was the last line read");
            separator = own;
            passed = read.len() + 1;
        } else {
            read.extend(std::mem::take(&mut ahead.pending));
            ahead.pending = read.into();
        }
    }
    let columns: Vec<String> = split(&names, separator).into_iter().map(unquoted).collect();
    let mut units = Vec::new();
    let mut next = ahead.next()?;
    if let Some((_, text)) = &next
        && let Some(row) = units_of(&split(text, separator), separator)
    {
        units = row;
        next = ahead.next()?;
    }
    let first = next.as_ref().map_or_else(Vec::new, |(_, text)| owned(text, separator));
    let rows = next.map_or_else(Vec::new, |first| ahead.rows(first));
    Ok(Found { head: Head { names: columns, units, line, first, separator }, rows, passed })
}

/// The units of a row that holds nothing else; `None` for a row of values.
fn units_of(cells: &[&str], separator: Separator) -> Option<Vec<Option<Unit>>> {
    let filled = cells.iter().filter(|text| !text.is_empty()).count();
    let units: Vec<Option<Unit>> = cells.iter().map(|text| names::unit(text)).collect();
    let is_value = |text: &&str| matches!(cell(text, separator), Cell::Number(_) | Cell::CommaNumber(_));
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
fn is_known(name: &str, sidecar: Option<&Sidecar>) -> bool {
    let described = |sidecar: &Sidecar| {
        sidecar.columns.iter().any(|column| matches!(&column.which, Which::Name(found) if found == name))
    };
    names::meaning(name).is_some() || sidecar.is_some_and(described)
}

pub(super) fn split(line: &str, separator: Separator) -> Vec<&str> {
    let mut ranges = Vec::new();
    separator.split(line, &mut ranges);
    ranges.into_iter().map(|range| &line[range]).collect()
}

fn owned(line: &str, separator: Separator) -> Vec<String> {
    split(line, separator).into_iter().map(str::to_owned).collect()
}
