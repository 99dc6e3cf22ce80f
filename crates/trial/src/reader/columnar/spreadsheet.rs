//! Excel spreadsheets (.xlsx) as text: a single sheet, with its rows on the line numbers of Excel. Formulas have the
//! values stored with them. Other kinds of spreadsheets are not read.
//!
//! The decoder borrows the file while it reads a sheet; it therefore runs in a separate thread, which waits until
//! its lines are read.
//!
//! Source of the layout: ECMA-376, Office Open XML File Formats, part 1.

use std::io::{Cursor, Read};
use std::sync::mpsc::{SyncSender, sync_channel};

use calamine::{DataRef, Reader, Xlsx, XlsxCellReader, XlsxError};

use super::text::{self, ChunkReader};
use crate::decoder::catch_panic;
use crate::names;
use crate::reader::error::ReadProblem;

/// Maximum number of rows and columns of a sheet (Excel 2007 and later).
const MAX_SIZE: (u32, u32) = (1 << 20, 1 << 14);

/// Number of rows at the beginning of a sheet that are searched for names.
const HEAD_ROWS: u32 = 60;

/// Size of a chunk of text, bytes.
const CHUNK_BYTES: usize = 1 << 16;

/// Day 0 of the two calendars of Excel, counted from 1970-01-01; valid from March 1900.
const DAY_0: [i64; 2] = [-25_569, -24_107];

type Book = Xlsx<Cursor<Vec<u8>>>;
type Cells<'a> = XlsxCellReader<'a, Cursor<Vec<u8>>>;
type Chunk = Result<String, ReadProblem>;

fn damaged(damage: impl ToString) -> ReadProblem {
    ReadProblem::Damaged { format: "a spreadsheet or an archive (ZIP)", damage: damage.to_string() }
}

/// Reader of the sheet with the table as tab-separated text; a thread decodes the rows.
pub fn read_as_text(bytes: Vec<u8>) -> Result<Box<dyn Read>, ReadProblem> {
    let (send, receive) = sync_channel(2);
    let decode = move || {
        let done = catch_panic(|| decode(bytes, &send));
        if let Err(problem) = done.unwrap_or_else(|| Err(damaged("its content contradicts itself"))) {
            // The receiver is dropped if reading was given up.
            let _ = send.send(Err(problem));
        }
    };
    std::thread::Builder::new().name("spreadsheet".to_owned()).spawn(decode).map_err(ReadProblem::from_input)?;
    Ok(Box::new(ChunkReader::new(receive.into_iter())))
}

/// Sends the lines of the sheet with the table.
fn decode(bytes: Vec<u8>, send: &SyncSender<Chunk>) -> Result<(), ReadProblem> {
    let mut book: Book = Xlsx::new(Cursor::new(bytes)).map_err(|error| match error {
        XlsxError::FileNotFound(_) => ReadProblem::Format {
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
        let sheet = read_head(book.worksheet_cells_reader(name).map_err(damaged)?)?;
        if sheet.width.is_some() || head.is_none() {
            let is_table = sheet.width.is_some();
            (chosen, head) = (name, Some(sheet));
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
        // A closed channel ends the work.
        Ok(text.len() < CHUNK_BYTES || send.send(Ok(std::mem::take(&mut text))).is_ok())
    })?;
    text.push('\n');
    let _ = send.send(Ok(text));
    Ok(())
}

/// Head of a sheet, from its first rows.
#[derive(Default)]
struct Head {
    /// Number of cells in the row of names; `None` without such a row.
    width: Option<u32>,
    /// Columns with times of day in their stamps.
    timed: Vec<u32>,
}

fn read_head(cells: Cells) -> Result<Head, ReadProblem> {
    let mut head = Head::default();
    each_row(cells, |row, cells| {
        let is_name = |value: &DataRef| match value {
            DataRef::String(name) => names::column_meaning(name).is_some(),
            DataRef::SharedString(name) => names::column_meaning(name).is_some(),
            _ => false,
        };
        if head.width.is_none() && cells.iter().filter(|(_, value)| is_name(value)).count() >= 2 {
            head.width = cells.last().map(|(column, _)| column + 1);
        }
        for (column, value) in cells {
            if matches!(value, DataRef::DateTime(stamp) if stamp.as_f64().fract() != 0.0) {
                head.timed.push(*column);
            }
        }
        Ok(row < HEAD_ROWS)
    })?;
    Ok(head)
}

/// Passes every row with a cell, and its number, to `take` until that returns `false`.
fn each_row<'a>(
    mut cells: Cells<'a>,
    mut take: impl FnMut(u32, &[(u32, DataRef<'a>)]) -> Result<bool, ReadProblem>,
) -> Result<(), ReadProblem> {
    let (mut row, mut row_cells) = (0, Vec::new());
    while let Some(cell) = cells.next_cell().map_err(damaged)? {
        let (cell_row, column) = cell.get_position();
        let follows = cell_row > row || (cell_row == row && row_cells.last().is_none_or(|&(last, _)| column > last));
        if !follows || cell_row >= MAX_SIZE.0 || column >= MAX_SIZE.1 {
            return Err(damaged(format!("a cell of row {} has no place", u64::from(cell_row) + 1)));
        }
        if cell_row > row {
            if !row_cells.is_empty() && !take(row, &row_cells)? {
                return Ok(());
            }
            row_cells.clear();
            row = cell_row;
        }
        row_cells.push((column, cell.get_value().clone()));
    }
    if !row_cells.is_empty() {
        take(row, &row_cells)?;
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
        let mut put = |content: &str| match content.strip_prefix('#') {
            Some(remark) if *column == 0 => {
                text.push('#');
                text::write_cell(text, remark);
            }
            _ => text::write_cell(text, content),
        };
        match value {
            DataRef::String(content) => put(content),
            DataRef::SharedString(content) => put(content),
            DataRef::DateTimeIso(content) | DataRef::DurationIso(content) => put(content),
            DataRef::Int(value) => text::write_integer(text, *value),
            DataRef::Float(value) => text::write_number(text, *value),
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

/// Writes days since the beginning of the calendar: a time of day below 1, and a date without time if the column
/// contains no times.
fn stamp(text: &mut String, days: f64, is_1904: bool, timed: bool, is_duration: bool) {
    // Days of present dates resolve half a microsecond.
    const TICKS: i64 = 100_000;
    const TICKS_PER_DAY: i64 = 86_400 * TICKS;
    let ticks = (days * TICKS_PER_DAY as f64).round() as i64;
    let nanoseconds = |ticks: i64| ticks * (1_000_000_000 / TICKS);
    if is_duration || (0.0..1.0).contains(&days) {
        return text::write_time_of_day(text, nanoseconds(ticks.clamp(-TICKS_PER_DAY, 1000 * TICKS_PER_DAY)));
    }
    // Excel counts 29 February 1900, which did not exist, as day 60.
    let early = i64::from(!is_1904 && days < 60.0);
    let day = ticks.div_euclid(TICKS_PER_DAY) + DAY_0[usize::from(is_1904)] + early;
    match ticks.rem_euclid(TICKS_PER_DAY) {
        0 if !timed => text::write_date(text, day),
        ticks => text::write_stamp(text, day * 86_400 + ticks / TICKS, nanoseconds(ticks % TICKS), false),
    }
}
