//! Excel spreadsheets (.xlsx) as text: one sheet, its rows on the lines they have in Excel. Formulas are what they
//! gave when the file was written. Other kinds of spreadsheets are not read.
//!
//! The decoder keeps hold of the file while it goes through a sheet, so it has a thread of its own, which waits where
//! its lines are not read.

use std::io::{Cursor, Read};
use std::sync::mpsc::{SyncSender, sync_channel};

use calamine::{DataRef, Reader, Xlsx, XlsxCellReader, XlsxError};

use super::text::{self, Written};
use crate::decoder::guarded;
use crate::names;
use crate::reader::error::Problem;

/// Most rows and columns of a sheet (Excel 2007 and later).
const LARGEST: (u32, u32) = (1 << 20, 1 << 14);

/// Rows at the begin of a sheet in which names are looked for.
const LOOKED_AT: u32 = 60;

/// Bytes handed on at a time.
const CHUNK: usize = 1 << 16;

/// Days from 1970-01-01 back to day 0 of the two calendars of Excel, those before March 1900 aside.
const DAY_0: [i64; 2] = [-25_569, -24_107];

type Book = Xlsx<Cursor<Vec<u8>>>;
type Cells<'a> = XlsxCellReader<'a, Cursor<Vec<u8>>>;
type Chunk = Result<String, Problem>;

fn damaged(found: impl ToString) -> Problem {
    Problem::Damaged { format: "a spreadsheet or an archive (ZIP)", found: found.to_string() }
}

/// The text of a file.
pub fn text(bytes: Vec<u8>) -> Result<Box<dyn Read>, Problem> {
    let (send, receive) = sync_channel(2);
    let decode = move || {
        let done = guarded(|| decode(bytes, &send));
        if let Err(problem) = done.unwrap_or_else(|| Err(damaged("what it holds contradicts itself"))) {
            // Nobody waits for it where the file was given up.
            let _ = send.send(Err(problem));
        }
    };
    std::thread::Builder::new().name("spreadsheet".to_owned()).spawn(decode).map_err(Problem::of_input)?;
    Ok(Box::new(Written::new(receive.into_iter())))
}

/// Hands on the lines of the sheet with the table.
fn decode(bytes: Vec<u8>, send: &SyncSender<Chunk>) -> Result<(), Problem> {
    let mut book: Book = Xlsx::new(Cursor::new(bytes)).map_err(|error| match error {
        XlsxError::FileNotFound(_) => Problem::Format {
            format: "an archive (ZIP) without the parts of an Excel workbook",
            cure: "export the table as CSV",
        },
        error => damaged(error),
    })?;
    let is_1904 = book.has_1904_epoch();
    let names = book.sheet_names();
    let Some(first) = names.first() else { return Err(damaged("it has no sheet")) };
    let (mut chosen, mut head) = (first, None);
    for name in &names {
        let found = look(book.worksheet_cells_reader(name).map_err(damaged)?)?;
        if found.width.is_some() || head.is_none() {
            let is_table = found.width.is_some();
            (chosen, head) = (name, Some(found));
            if is_table {
                break;
            }
        }
    }
    let head = head.unwrap_or_default();
    let mut text = String::new();
    let mut line = 0;
    each_row(book.worksheet_cells_reader(chosen).map_err(damaged)?, |row, cells| {
        while line < row {
            text.push('\n');
            line += 1;
        }
        write_row(&mut text, cells, &head, is_1904);
        // A full channel that nobody reads any more ends the work.
        Ok(text.len() < CHUNK || send.send(Ok(std::mem::take(&mut text))).is_ok())
    })?;
    text.push('\n');
    let _ = send.send(Ok(text));
    Ok(())
}

/// What the first rows of a sheet show.
#[derive(Default)]
struct Head {
    /// Cells of the row with the names, where there is one.
    width: Option<u32>,
    /// Columns with times of day in their stamps.
    timed: Vec<u32>,
}

fn look(cells: Cells) -> Result<Head, Problem> {
    let mut head = Head::default();
    each_row(cells, |row, cells| {
        let said = |value: &DataRef| match value {
            DataRef::String(name) => names::meaning(name).is_some(),
            DataRef::SharedString(name) => names::meaning(name).is_some(),
            _ => false,
        };
        if head.width.is_none() && cells.iter().filter(|(_, value)| said(value)).count() >= 2 {
            head.width = cells.last().map(|(column, _)| column + 1);
        }
        for (column, value) in cells {
            if matches!(value, DataRef::DateTime(stamp) if stamp.as_f64().fract() != 0.0) {
                head.timed.push(*column);
            }
        }
        Ok(row < LOOKED_AT)
    })?;
    Ok(head)
}

/// Hands every row with something in it to `take`, with its place, as long as that says so.
fn each_row<'a>(
    mut cells: Cells<'a>,
    mut take: impl FnMut(u32, &[(u32, DataRef<'a>)]) -> Result<bool, Problem>,
) -> Result<(), Problem> {
    let (mut row, mut own) = (0, Vec::new());
    while let Some(cell) = cells.next_cell().map_err(damaged)? {
        let (of_row, column) = cell.get_position();
        let follows = of_row > row || (of_row == row && own.last().is_none_or(|&(last, _)| column > last));
        if !follows || of_row >= LARGEST.0 || column >= LARGEST.1 {
            return Err(damaged(format!("a cell of row {} has no place", u64::from(of_row) + 1)));
        }
        if of_row > row {
            if !own.is_empty() && !take(row, &own)? {
                return Ok(());
            }
            own.clear();
            row = of_row;
        }
        own.push((column, cell.get_value().clone()));
    }
    if !own.is_empty() {
        take(row, &own)?;
    }
    Ok(())
}

/// Writes a row without its end.
fn write_row(text: &mut String, cells: &[(u32, DataRef)], head: &Head, is_1904: bool) {
    let mut at = 0;
    for (column, value) in cells {
        while at < *column {
            text.push('\t');
            at += 1;
        }
        let mut put = |words: &str| match words.strip_prefix('#') {
            Some(remark) if *column == 0 => {
                text.push('#');
                text::words(text, remark);
            }
            _ => text::words(text, words),
        };
        match value {
            DataRef::String(words) => put(words),
            DataRef::SharedString(words) => put(words),
            DataRef::DateTimeIso(words) | DataRef::DurationIso(words) => put(words),
            DataRef::Int(value) => text::whole(text, *value),
            DataRef::Float(value) => text::number(text, *value),
            DataRef::Bool(value) => text.push(if *value { '1' } else { '0' }),
            DataRef::DateTime(value) => {
                let timed = head.timed.contains(column);
                stamp(text, value.as_f64(), is_1904, timed, value.is_duration());
            }
            DataRef::Error(_) | DataRef::Empty => {}
        }
    }
    for _ in at + 1..head.width.unwrap_or(0) {
        text.push('\t');
    }
}

/// Writes days since the begin of the calendar: a time of day below one, and a date without its time where the column
/// has none.
fn stamp(text: &mut String, days: f64, is_1904: bool, timed: bool, is_duration: bool) {
    // The numbers of our years are known to half a microsecond.
    const TICKS: i64 = 100_000;
    const OF_DAY: i64 = 86_400 * TICKS;
    let ticks = (days * OF_DAY as f64).round() as i64;
    let nanoseconds = |ticks: i64| ticks * (1_000_000_000 / TICKS);
    if is_duration || (0.0..1.0).contains(&days) {
        return text::time_of_day(text, nanoseconds(ticks.clamp(-OF_DAY, 1000 * OF_DAY)));
    }
    // Excel believes in 29 February 1900, day 60.
    let early = i64::from(!is_1904 && days < 60.0);
    let day = ticks.div_euclid(OF_DAY) + DAY_0[usize::from(is_1904)] + early;
    match ticks.rem_euclid(OF_DAY) {
        0 if !timed => text::day(text, day),
        of_day => text::stamp(text, day * 86_400 + of_day / TICKS, nanoseconds(of_day % TICKS), false),
    }
}
