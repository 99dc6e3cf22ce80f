//! The rows of a table, one after the other: cells to SI units, the part and thinning asked for, rows that are left
//! out, and the bound on memory. Only the rows kept are held; what becomes of them is in [`super::read_table`].

use std::ops::Range;

use ship::angle::unwrap_heading;

use super::error::Problem;
use super::layout::{Layout, Meaning};
use super::limits::{MAX_CELLS, MAX_ROWS, is_comment};
use crate::cells::{Cell, Separator, cell};
use crate::channel::Channel;
use crate::cleaning::is_sentinel;
use crate::clock::{Stamp, StampFault, Stamps};
use crate::record::Trial;
use crate::sidecar::Sidecar;
use crate::words::shortened;

/// What was counted on the way, for warnings.
#[derive(Debug, Default)]
pub(super) struct Counts {
    pub rows: usize,
    pub no_time: usize,
    /// Rows with neither rudder nor heading nor yaw rate.
    pub nothing: usize,
    pub repeated: usize,
    /// Times that do not fit those around them.
    pub astray: Vec<f64>,
    pub short: usize,
    pub decimal_commas: usize,
}

/// What was met in one column.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Met {
    /// The last number, as it stands in the file.
    last: Option<f64>,
    /// The largest number, without its sign.
    pub largest: f64,
    /// How often there was a number that stands for no reading, and the last such number.
    pub sentinels: (usize, f64),
    /// Cells with text.
    pub text: usize,
}

/// The last rows, to tell one that does not follow from one after which time starts anew.
#[derive(Debug, Default)]
struct Before {
    /// The last row with a time, as it was read.
    last: Option<(f64, Vec<f64>)>,
    /// Time of the row before that.
    earlier: Option<f64>,
    /// Whether the last row was kept.
    kept: bool,
    /// A row left out because its time is before that of the last one: its line and time.
    astray: Option<(usize, f64)>,
}

/// The rows kept so far.
pub(super) struct Rows<'a> {
    pub(super) layout: &'a Layout,
    separator: Separator,
    time_step: Option<f64>,
    pub(super) part: (f64, f64),
    pub(super) every: usize,
    /// Places of the columns that are not left out.
    pub(super) used: Vec<usize>,
    pub(super) time_place: Option<usize>,
    date_place: Option<usize>,
    heading_place: Option<usize>,
    /// Places of the channels of which a row has to have one.
    wanted: Vec<usize>,
    pub(super) stamps: Option<Stamps>,
    /// Whether no stamp has had a fraction of a second so far.
    pub(super) whole_seconds: bool,

    pub(super) time: Vec<f64>,
    pub(super) columns: Vec<Vec<f64>>,
    cells: Vec<Range<usize>>,
    row: Vec<f64>,
    /// What was met in every column.
    pub(super) met: Vec<Met>,
    before: Before,
    last_heading: Option<f64>,
    /// Rows of the part with time and one of the wanted channels.
    pub(super) usable: usize,
    /// First and last time in the file.
    pub(super) span: Option<(f64, f64)>,
    /// Whether such numbers are looked for.
    checked: bool,
    pub(super) counts: Counts,
}

impl<'a> Rows<'a> {
    pub fn new(layout: &'a Layout, separator: Separator, sidecar: Option<&Sidecar>) -> Self {
        let columns = layout.names.len();
        let places = |is_one: fn(&Meaning) -> bool| -> Vec<usize> {
            (0..columns).filter(|&place| is_one(&layout.meanings[place])).collect()
        };
        let used =
            places(|meaning| !matches!(meaning, Meaning::Time(_) | Meaning::Stamp | Meaning::Date | Meaning::Ignored));
        let main = [layout.rudder(), layout.place(Channel::Heading), layout.place(Channel::YawRate)];
        let main: Vec<usize> = main.into_iter().flatten().collect();
        // A table that holds some other channel of a record only.
        let wanted = if main.is_empty() { places(|meaning| matches!(meaning, Meaning::Channel(..))) } else { main };
        let time_place = layout.time();
        let stamped = time_place.is_some_and(|place| layout.meanings[place] == Meaning::Stamp);
        Self {
            layout,
            separator,
            time_step: sidecar.and_then(|sidecar| sidecar.time_step),
            part: sidecar.map_or((f64::NEG_INFINITY, f64::INFINITY), |sidecar| (sidecar.from, sidecar.until)),
            every: sidecar.map_or(1, |sidecar| sidecar.every),
            time_place,
            date_place: layout.date(),
            heading_place: layout.place(Channel::Heading),
            wanted,
            stamps: stamped.then(Stamps::default),
            whole_seconds: true,
            time: Vec::new(),
            columns: vec![Vec::new(); used.len()],
            used,
            cells: Vec::new(),
            row: vec![f64::NAN; columns],
            met: vec![Met::default(); columns],
            checked: sidecar.is_none_or(|sidecar| sidecar.plausibility),
            before: Before::default(),
            last_heading: None,
            usable: 0,
            span: None,
            counts: Counts::default(),
        }
    }

    /// Rows kept so far.
    pub fn kept(&self) -> usize {
        self.time.len()
    }

    /// Rows that may be kept, so that the table stays within [`MAX_ROWS`] and [`MAX_CELLS`].
    pub fn limit(&self) -> usize {
        MAX_ROWS.min(MAX_CELLS / (self.used.len() + 1)).max(Trial::FEWEST_ROWS)
    }

    /// Rows of the whole file by its size, after `consumed` of its bytes.
    fn estimate(&self, consumed: u64, size: Option<u64>) -> Option<f64> {
        let size = size.filter(|&size| consumed > 0 && size > consumed)?;
        Some(self.kept() as f64 * (size as f64 / consumed as f64))
    }

    /// Whether the size of the file says early that it is far too long, so that nobody has to wait for it.
    pub fn will_be_too_many(&self, consumed: u64, size: Option<u64>) -> bool {
        const EARLY: usize = 10_000;
        const FAR: f64 = 1.5;
        let whole = self.part.0 == f64::NEG_INFINITY && self.part.1 == f64::INFINITY;
        self.kept() == EARLY
            && whole
            && self.estimate(consumed, size).is_some_and(|rows| rows > FAR * self.limit() as f64)
    }

    /// The complaint about a table that is too long, after `consumed` of its `size` bytes.
    pub fn too_many(&self, consumed: u64, size: Option<u64>) -> Problem {
        let limit = self.limit();
        let estimate = self.estimate(consumed, size).map(|rows| {
            // Two digits: more would claim a precision the estimate does not have.
            let digit = 10f64.powi(rows.log10().floor() as i32 - 1);
            ((rows / digit).round() * digit) as u64
        });
        let times = estimate.map_or(2, |rows| rows / limit as u64 + 1).max(2);
        Problem::TooManyRows { limit, columns: self.used.len() + 1, estimate, every: times * self.every as u64 }
    }

    /// Takes one line: a row, a comment or nothing.
    pub fn add(&mut self, line: &str, number: usize) -> Result<(), Problem> {
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
        let time = match (self.time_step, self.time_place) {
            (Some(step), _) => step * index as f64,
            (None, Some(place)) if self.stamps.is_some() => self.stamp(line, number, place)?,
            (None, Some(place)) => self.row[place],
            (None, None) => f64::NAN,
        };
        if time.is_nan() {
            self.counts.no_time += 1;
            return Ok(());
        }
        self.span = Some((self.span.map_or(time, |(first, _)| first), time));
        if time < self.part.0 || time > self.part.1 || !self.follows(time, number)? {
            return Ok(());
        }
        self.before.kept = false;
        if let Some(place) = self.heading_place {
            self.unwrap(place);
        }
        if self.wanted.iter().all(|&place| self.row[place].is_nan()) {
            self.counts.nothing += 1;
            return Ok(());
        }
        self.usable += 1;
        // Rows may share a stamp: which of them is used is decided when their instants are known.
        if self.stamps.is_some() || (self.usable - 1).is_multiple_of(self.every) {
            self.before.kept = true;
            self.time.push(time);
            for (values, &place) in self.columns.iter_mut().zip(&self.used) {
                values.push(self.row[place]);
            }
        }
        Ok(())
    }

    /// Seconds of the stamp of a row since the first one; NaN for an empty cell.
    fn stamp(&mut self, line: &str, number: usize, place: usize) -> Result<f64, Problem> {
        let text = |place: usize| self.cells.get(place).map_or("", |range| &line[range.clone()]);
        let own = text(place);
        let read = Stamp::parse(own).and_then(|time| match self.date_place {
            Some(date) => Some(Stamp::joined(Stamp::parse(text(date))?, time)),
            None => Some(time),
        });
        let value = || shortened(own);
        let no_stamp = || Problem::NotAStamp { line: number, column: self.layout.names[place].clone(), value: value() };
        let (Some(stamp), Some(stamps)) = (read, &mut self.stamps) else {
            let missing = cell(own, self.separator) == Cell::Missing;
            return if missing { Ok(f64::NAN) } else { Err(no_stamp()) };
        };
        self.whole_seconds &= !stamp.has_fraction();
        stamps.seconds(stamp).map_err(|fault| match fault {
            StampFault::EitherMonth => Problem::EitherMonth { line: number, value: value() },
            StampFault::NoTime => no_stamp(),
        })
    }

    /// Cells to numbers in SI units, into `self.row`.
    fn parse(&mut self, line: &str, number: usize) -> Result<(), Problem> {
        let expected = self.layout.names.len();
        let found = self.cells.len();
        let surplus = self.cells.get(expected..).is_some_and(|rest| rest.iter().any(|cell| !cell.is_empty()));
        // With blanks between the cells nobody can tell which one is missing.
        if surplus || (found < expected && self.separator == Separator::Blank) {
            return Err(Problem::Cells { line: number, found, expected });
        }
        self.counts.short += usize::from(found < expected);
        for place in 0..expected {
            let text = self.cells.get(place).map_or("", |range| &line[range.clone()]);
            let meaning = self.layout.meanings[place];
            let factor = match meaning {
                Meaning::Time(factor) | Meaning::Channel(_, factor) => factor,
                Meaning::Unknown | Meaning::Latitude | Meaning::Longitude => 1.0,
                Meaning::Stamp | Meaning::Date | Meaning::Ignored => continue,
            };
            let read = match cell(text, self.separator) {
                Cell::Text => side(text, meaning, self.separator).map_or(Cell::Text, Cell::Number),
                read => read,
            };
            let met = &mut self.met[place];
            self.row[place] = match read {
                Cell::Number(value) | Cell::CommaNumber(value) => {
                    self.counts.decimal_commas += usize::from(matches!(read, Cell::CommaNumber(_)));
                    match meaning {
                        Meaning::Channel(channel, _) if self.checked && is_sentinel(channel, value, met.last) => {
                            met.sentinels = (met.sentinels.0 + 1, value);
                            f64::NAN
                        }
                        _ => {
                            met.last = Some(value);
                            met.largest = met.largest.max(value.abs());
                            value * factor
                        }
                    }
                }
                Cell::Missing => f64::NAN,
                Cell::Text if meaning == Meaning::Unknown => {
                    met.text += 1;
                    f64::NAN
                }
                Cell::Text => {
                    let (column, value) = (self.layout.names[place].clone(), shortened(text));
                    return Err(Problem::NotANumber { line: number, column, value });
                }
            };
        }
        Ok(())
    }

    /// Whether the row comes after the one before. A row that repeats the one before in every value does not, nor does
    /// a single row whose time does not fit those around it; where time goes on from an earlier one it is an error.
    fn follows(&mut self, time: f64, number: usize) -> Result<bool, Problem> {
        let may_share = self.stamps.is_some() && self.whole_seconds;
        let Some((last, row)) = &mut self.before.last else {
            self.before.last = Some((time, self.row.clone()));
            return Ok(true);
        };
        if time < *last {
            if let Some((line, found)) = self.before.astray {
                return Err(Problem::TimeBackwards { line, before: *last, found });
            }
            if self.before.earlier.is_none_or(|earlier| time <= earlier) {
                self.counts.astray.push(time);
                self.before.astray = Some((number, time));
                return Ok(false);
            }
            // It fits the row but one before: the row before was ahead of time.
            self.counts.astray.push(*last);
            if self.before.kept {
                self.time.pop();
                self.columns.iter_mut().for_each(|values| values.truncate(self.time.len()));
                self.usable -= 1;
            }
        } else if time == *last && !may_share {
            let same = row.iter().zip(&self.row).all(|(a, b)| a == b || (a.is_nan() && b.is_nan()));
            if !same {
                return Err(Problem::TimeRepeats { line: number, time });
            }
            self.counts.repeated += 1;
            return Ok(false);
        } else {
            self.before.earlier = Some(*last);
        }
        self.before.astray = None;
        *last = time;
        row.copy_from_slice(&self.row);
        Ok(true)
    }

    /// Removes the wrap of the heading before rows are left out: thinning may turn a fast turn into steps beyond 180°.
    fn unwrap(&mut self, place: usize) {
        let heading = self.row[place];
        if heading.is_nan() {
            return;
        }
        if let Some(last) = self.last_heading.filter(|last| (heading - last).abs() > std::f64::consts::PI) {
            let mut pair = [last, heading];
            unwrap_heading(&mut pair);
            self.row[place] = pair[1];
        }
        self.last_heading = Some(self.row[place]);
    }
}

/// A rudder angle with its side (`P 10.5`, `10.5 S`, `10L`; port is negative), or an angle with its sign (`10.5°`).
fn side(text: &str, meaning: Meaning, separator: Separator) -> Option<f64> {
    let Meaning::Channel(channel, _) = meaning else { return None };
    let plain = text.trim_end_matches(['°', 'º']).trim();
    let (number, sign) = match channel {
        Channel::Rudder | Channel::RudderOrder => {
            let letter = |c: char| match c.to_ascii_uppercase() {
                'P' | 'L' => Some(-1.0),
                'S' | 'R' => Some(1.0),
                _ => None,
            };
            let begin = plain.chars().next().and_then(letter);
            let end = plain.chars().next_back().and_then(letter);
            match (begin, end) {
                (Some(sign), None) => (&plain[1..], sign),
                (None, Some(sign)) => (&plain[..plain.len() - 1], sign),
                (None, None) => (plain, 1.0),
                (Some(_), Some(_)) => return None,
            }
        }
        _ => (plain, 1.0),
    };
    let is_marked = number.len() < text.len();
    match cell(number.trim().trim_end_matches(['°', 'º']), separator) {
        Cell::Number(value) | Cell::CommaNumber(value) if is_marked => Some(sign * value),
        _ => None,
    }
}
