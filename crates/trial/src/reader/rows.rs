//! Rows of a table: cells to SI units, part and thinning, omitted rows, and the limit of memory. Only the
//! kept rows are in memory; [`super::table`] makes columns of them.

use std::ops::{Range, RangeInclusive};

use ship::angle::{DEGREE, unwrap_heading};

use super::error::ReadProblem;
use super::layout::{ColumnContent, Layout};
use super::limits::{MAX_CELLS, MAX_ROWS, is_comment};
use crate::cells::{CellContent, Separator, parse_cell};
use crate::channel::Channel;
use crate::cleaning::is_sentinel;
use crate::clock::{StampConverter, StampFault, TimeStamp};
use crate::record::Trial;
use crate::sidecar::Sidecar;
use crate::wording::shortened;

/// Numbers of rows by kind, for warnings.
#[derive(Debug, Default)]
pub(super) struct RowCounts {
    pub rows: usize,
    pub rows_without_time: usize,
    /// Rows with neither rudder nor heading nor yaw rate.
    pub empty_rows: usize,
    pub repeated_rows: usize,
    /// Times out of order with their neighbours, s.
    pub stray_times: Vec<f64>,
    pub short_rows: usize,
    pub decimal_commas: usize,
}

/// State of the last rows, to distinguish a single stray time from a clock that restarts.
#[derive(Debug, Default)]
struct Before {
    /// Time (s) and values of the last row with a time, as read; `None` before the first such row.
    last: Option<(f64, Vec<f64>)>,
    /// Time of the last row but one, s; `None` if there was a single row.
    earlier: Option<f64>,
    /// `true` if the last row was kept.
    kept: bool,
    /// Line and time (s) of a row omitted because its time is before the last time; `None` after a row in order.
    stray: Option<(usize, f64)>,
}

/// Rows kept so far.
pub(super) struct Rows<'a> {
    pub(super) layout: Layout,
    separator: Separator,
    pub(super) sidecar: &'a Sidecar,
    pub(super) part: RangeInclusive<f64>,
    pub(super) every: usize,
    pub(super) time_place: Option<usize>,
    date_place: Option<usize>,
    heading_place: Option<usize>,
    /// Columns of the channels of which a row requires at least one.
    wanted: Vec<usize>,
    pub(super) stamps: Option<StampConverter>,
    /// `true` while no stamp has a fraction of a second.
    pub(super) whole_seconds: bool,
    /// Number of columns that are kept, with the column of time.
    width: usize,

    pub(super) time: Vec<f64>,
    cells: Vec<Range<usize>>,
    row: Vec<f64>,
    before: Before,
    last_heading: Option<f64>,
    /// Number of rows of the part with a time and at least one of the `wanted` columns.
    pub(super) usable_rows: usize,
    /// First and last time in the file, s; `None` before the first.
    pub(super) span: Option<(f64, f64)>,
    pub(super) counts: RowCounts,
}

impl<'a> Rows<'a> {
    pub fn new(layout: Layout, separator: Separator, sidecar: &'a Sidecar) -> Self {
        let main = [layout.rudder_column(), layout.column_of(Channel::Heading), layout.column_of(Channel::YawRate)];
        let mut wanted: Vec<usize> = main.into_iter().flatten().collect();
        if wanted.is_empty() {
            // A table with other channels of a record.
            let is_channel = |&place: &usize| matches!(layout.columns[place].content, ColumnContent::Channel(..));
            wanted.extend((0..layout.columns.len()).filter(is_channel));
        }
        let time_place = layout.time_column();
        let stamped = time_place.is_some_and(|place| layout.columns[place].content == ColumnContent::Stamp);
        Self {
            separator,
            sidecar,
            part: sidecar.used_interval(),
            every: sidecar.part.every.unwrap_or(1),
            time_place,
            date_place: layout.date_column(),
            heading_place: layout.column_of(Channel::Heading),
            wanted,
            stamps: stamped.then(StampConverter::default),
            whole_seconds: true,
            width: 1 + layout.columns.iter().filter(|column| column.content.is_kept()).count(),
            time: Vec::new(),
            cells: Vec::new(),
            row: vec![f64::NAN; layout.columns.len()],
            before: Before::default(),
            last_heading: None,
            usable_rows: 0,
            span: None,
            counts: RowCounts::default(),
            layout,
        }
    }

    /// Checks the number of rows after `consumed` of the `size` bytes of the file.
    ///
    /// Fails beyond [`MAX_ROWS`] and [`MAX_CELLS`], and early if the size of the file predicts far too many rows.
    pub fn check_length(&self, consumed: u64, size: Option<u64>) -> Result<(), ReadProblem> {
        const ESTIMATE_ROWS: usize = 10_000;
        const MIN_EXCESS: f64 = 1.5;
        let kept = self.time.len();
        let limit = MAX_ROWS.min(MAX_CELLS / self.width).max(Trial::MIN_ROWS);
        if kept <= limit && kept != ESTIMATE_ROWS {
            return Ok(());
        }
        let size = size.filter(|&size| consumed > 0 && size > consumed);
        let estimate = size.map(|size| kept as f64 * (size as f64 / consumed as f64));
        let whole = self.part == (f64::NEG_INFINITY..=f64::INFINITY);
        if kept <= limit && !(whole && estimate.is_some_and(|rows| rows > MIN_EXCESS * limit as f64)) {
            return Ok(());
        }
        let estimate = estimate.map(|rows| {
            // Two significant digits, the precision of the estimate.
            let digit = 10f64.powi(rows.log10().floor() as i32 - 1);
            ((rows / digit).round() * digit) as u64
        });
        let times = estimate.map_or(2, |rows| rows / limit as u64 + 1).max(2);
        Err(ReadProblem::TooManyRows { limit, columns: self.width, estimate, every: times * self.every as u64 })
    }

    /// Adds a line: a row, a comment or an empty line.
    ///
    /// Fails for a cell that is neither a number nor a stamp, a wrong number of cells, and a time that runs backwards
    /// or repeats with other values.
    pub fn add(&mut self, line: &str, number: usize) -> Result<(), ReadProblem> {
        if is_comment(line) {
            return Ok(());
        }
        self.separator.split(line, &mut self.cells);
        if self.cells.iter().all(Range::is_empty) {
            return Ok(());
        }
        let index = self.counts.rows;
        self.counts.rows += 1;
        self.parse(line, number)?;
        let time = match (self.sidecar.table.time_step_s, self.time_place) {
            (Some(step), _) => step * index as f64,
            (None, Some(place)) if self.stamps.is_some() => self.stamp(line, number, place)?,
            (None, Some(place)) => self.row[place],
            (None, None) => f64::NAN,
        };
        if time.is_nan() {
            self.counts.rows_without_time += 1;
            return Ok(());
        }
        self.span = Some((self.span.map_or(time, |(first, _)| first), time));
        if !self.part.contains(&time) || !self.follows(time, number)? {
            return Ok(());
        }
        self.before.kept = false;
        if let Some(place) = self.heading_place {
            self.unwrap(place);
        }
        if self.wanted.iter().all(|&place| self.row[place].is_nan()) {
            self.counts.empty_rows += 1;
            return Ok(());
        }
        self.usable_rows += 1;
        // Rows may share a stamp: they are thinned once their instants are known.
        if self.stamps.is_some() || (self.usable_rows - 1).is_multiple_of(self.every) {
            self.before.kept = true;
            self.time.push(time);
            let columns = self.layout.columns.iter_mut().zip(&self.row);
            for (column, &value) in columns.filter(|(column, _)| column.content.is_kept()) {
                column.values.push(value);
            }
        }
        Ok(())
    }

    /// Seconds from the first stamp to the stamp of a row; NaN for an empty cell.
    fn stamp(&mut self, line: &str, number: usize, place: usize) -> Result<f64, ReadProblem> {
        let text = |place: usize| self.cells.get(place).map_or("", |range| &line[range.clone()]);
        let time_cell = text(place);
        let read = TimeStamp::parse(time_cell).and_then(|time| match self.date_place {
            Some(date) => Some(TimeStamp::joined(TimeStamp::parse(text(date))?, time)),
            None => Some(time),
        });
        let value = || shortened(time_cell);
        let no_stamp =
            || ReadProblem::NotAStamp { line: number, column: self.layout.columns[place].name.clone(), value: value() };
        let (Some(stamp), Some(stamps)) = (read, &mut self.stamps) else {
            let missing = parse_cell(time_cell, self.separator) == CellContent::Missing;
            return if missing { Ok(f64::NAN) } else { Err(no_stamp()) };
        };
        self.whole_seconds &= !stamp.has_fraction();
        stamps.seconds(stamp).map_err(|fault| match fault {
            StampFault::AmbiguousDate => ReadProblem::AmbiguousDate { line: number, value: value() },
            StampFault::NoTime => no_stamp(),
        })
    }

    /// Converts the cells of a row to numbers in SI units, into `self.row`.
    fn parse(&mut self, line: &str, number: usize) -> Result<(), ReadProblem> {
        let (cells, expected) = (self.cells.len(), self.layout.cells);
        let surplus = self.cells.get(expected..).is_some_and(|extra| extra.iter().any(|cell| !cell.is_empty()));
        // With blanks between the cells a missing cell cannot be located.
        if surplus || (cells < expected && self.separator == Separator::Blank) {
            return Err(ReadProblem::WrongCellCount { line: number, cells, expected });
        }
        self.counts.short_rows += usize::from(cells < expected);
        let checked = self.sidecar.is_checked();
        for (place, column) in self.layout.columns[..expected].iter_mut().enumerate() {
            let text = self.cells.get(place).map_or("", |range| &line[range.clone()]);
            let (channel, factor) = match column.content {
                ColumnContent::Channel(channel, factor) => (Some(channel), factor),
                ColumnContent::Time(factor) => (None, factor),
                ColumnContent::Latitude | ColumnContent::Longitude => (None, DEGREE),
                ColumnContent::Unknown => (None, 1.0),
                ColumnContent::Stamp | ColumnContent::Date | ColumnContent::Ignored => continue,
            };
            let read = match parse_cell(text, self.separator) {
                CellContent::Text => side(text, channel, self.separator).map_or(CellContent::Text, CellContent::Number),
                read => read,
            };
            if let (CellContent::Text, ColumnContent::Unknown, Some(sign)) = (read, column.content, side_word(text)) {
                column.sides += 1;
                self.row[place] = sign;
                continue;
            }
            self.counts.decimal_commas += usize::from(matches!(read, CellContent::CommaNumber(_)));
            self.row[place] = match read {
                CellContent::Number(value) | CellContent::CommaNumber(value)
                    if checked && channel.is_some_and(|channel| is_sentinel(channel, value, column.last)) =>
                {
                    column.sentinels = (column.sentinels.0 + 1, value);
                    f64::NAN
                }
                CellContent::Number(value) | CellContent::CommaNumber(value) => {
                    column.count(value);
                    (value - column.zero) * factor
                }
                CellContent::Missing => f64::NAN,
                CellContent::Text if column.content == ColumnContent::Unknown => {
                    column.text += 1;
                    f64::NAN
                }
                CellContent::Text => {
                    let (column, value) = (column.name.clone(), shortened(text));
                    return Err(ReadProblem::NotANumber { line: number, column, value });
                }
            };
        }
        self.evaluate_formulas(line);
        Ok(())
    }

    /// Evaluates the columns with formulas.
    fn evaluate_formulas(&mut self, line: &str) {
        let Layout { columns, cells: first, formulas, .. } = &mut self.layout;
        for (column, (place, (formula, sources))) in columns[*first..].iter_mut().zip((*first..).zip(formulas.iter())) {
            let number = |place: &usize| {
                let text = self.cells.get(*place).map_or("", |range| &line[range.clone()]);
                parse_cell(text, self.separator).number().unwrap_or(f64::NAN)
            };
            let value = formula.value(&sources.iter().map(number).collect::<Vec<_>>());
            let ColumnContent::Channel(_, factor) = column.content else { continue };
            if value.is_finite() {
                column.count(value);
            }
            self.row[place] = (value - column.zero) * factor;
        }
    }

    /// `true` for a row later than the last row, or with the same stamp of whole seconds. An exact copy of the last row
    /// and a single row with a stray time give `false`. Fails if time continues from an earlier time.
    fn follows(&mut self, time: f64, number: usize) -> Result<bool, ReadProblem> {
        let may_share = self.stamps.is_some() && self.whole_seconds;
        let Some((last, row)) = &mut self.before.last else {
            self.before.last = Some((time, self.row.clone()));
            return Ok(true);
        };
        if time < *last {
            if let Some((line, time)) = self.before.stray {
                return Err(ReadProblem::TimeBackwards { line, before: *last, time });
            }
            if self.before.earlier.is_none_or(|earlier| time <= earlier) {
                self.counts.stray_times.push(time);
                self.before.stray = Some((number, time));
                return Ok(false);
            }
            // The row follows the last but one: the time of the last row was too late.
            self.counts.stray_times.push(*last);
            if self.before.kept {
                self.time.pop();
                self.layout.columns.iter_mut().for_each(|column| column.values.truncate(self.time.len()));
                self.usable_rows -= 1;
            }
        } else if time == *last && !may_share {
            let same = row.iter().zip(&self.row).all(|(a, b)| a == b || (a.is_nan() && b.is_nan()));
            if !same {
                return Err(ReadProblem::TimeRepeats { line: number, time });
            }
            self.counts.repeated_rows += 1;
            return Ok(false);
        } else {
            self.before.earlier = Some(*last);
        }
        self.before.stray = None;
        *last = time;
        row.copy_from_slice(&self.row);
        Ok(true)
    }

    /// Unwraps the heading before rows are omitted: thinning may turn a fast turn into steps beyond 180°.
    fn unwrap(&mut self, place: usize) {
        let heading = self.row[place];
        if heading.is_nan() {
            return;
        }
        let mut pair = [self.last_heading.unwrap_or(heading), heading];
        if (pair[1] - pair[0]).abs() > std::f64::consts::PI {
            unwrap_heading(&mut pair);
        }
        self.row[place] = pair[1];
        self.last_heading = Some(pair[1]);
    }
}

/// Sign of a word for a side, negative for port; `None` for any other text.
fn side_word(text: &str) -> Option<f64> {
    const PORT: [&str; 8] = ["p", "port", "l", "left", "bb", "backbord", "babord", "bâbord"];
    const STARBOARD: [&str; 10] =
        ["s", "stbd", "starboard", "r", "right", "stb", "sb", "steuerbord", "tribord", "styrbord"];
    let word = text.trim_end_matches('.').to_lowercase();
    let is_side = |side: &[&str]| side.contains(&word.as_str());
    if is_side(&PORT) { Some(-1.0) } else { is_side(&STARBOARD).then_some(1.0) }
}

/// Rudder angle with its side (`P 10.5`, `10.5 S`, `10L`; port is negative), or an angle with its sign of degrees
/// (`10.5°`), in the unit of the cell; `None` for any other text.
fn side(text: &str, channel: Option<Channel>, separator: Separator) -> Option<f64> {
    let plain = text.trim_end_matches(['°', 'º']).trim();
    let (mut number, mut sign) = (plain, 1.0);
    if matches!(channel?, Channel::Rudder | Channel::RudderOrder) {
        let side = |letter: Option<char>| match letter?.to_ascii_uppercase() {
            'P' | 'L' => Some(-1.0),
            'S' | 'R' => Some(1.0),
            _ => None,
        };
        (number, sign) = match (side(plain.chars().next()), side(plain.chars().next_back())) {
            (Some(sign), None) => (&plain[1..], sign),
            (None, Some(sign)) => (&plain[..plain.len() - 1], sign),
            (None, None) => (plain, 1.0),
            (Some(_), Some(_)) => return None,
        };
    }
    let is_marked = number.len() < text.len();
    let value = parse_cell(number.trim().trim_end_matches(['°', 'º']), separator).number()?;
    is_marked.then_some(sign * value)
}
