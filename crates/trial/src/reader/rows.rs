//! The rows of a table, one after the other: cells to SI units, the part and thinning asked for, rows that are left
//! out, and the bound on memory. Only the rows kept are held.

use std::collections::BTreeMap;
use std::ops::Range;

use ship::angle::unwrap_heading;

use super::error::Problem;
use super::layout::{Layout, Meaning};
use super::limits::{MAX_CELLS, MAX_ROWS, is_comment, no_rows, spoken};
use crate::cells::{Cell, Separator, cell};
use crate::channel::Channel;
use crate::hygiene::is_sentinel;
use crate::record::{Columns, Trial};
use crate::sidecar::Sidecar;
use crate::words::shortened;

/// What was counted on the way, for warnings.
#[derive(Debug, Default)]
struct Counts {
    rows: usize,
    no_time: usize,
    no_rudder: usize,
    repeated: usize,
    short: usize,
    decimal_commas: usize,
}

/// The rows kept so far.
pub(super) struct Rows<'a> {
    layout: &'a Layout,
    separator: Separator,
    time_step: Option<f64>,
    part: (f64, f64),
    every: usize,
    /// Places of the columns that are not left out.
    used: Vec<usize>,
    time_place: Option<usize>,
    rudder_place: Option<usize>,
    heading_place: Option<usize>,

    time: Vec<f64>,
    columns: Vec<Vec<f64>>,
    cells: Vec<Range<usize>>,
    row: Vec<f64>,
    /// The last number of every column, as it stands in the file.
    last: Vec<Option<f64>>,
    /// The last row with a time, as it was read.
    before: Option<(f64, Vec<f64>)>,
    last_heading: Option<f64>,
    /// Rows of the part with time and rudder.
    usable: usize,
    /// First and last time in the file.
    span: Option<(f64, f64)>,
    /// How often a column has a number that stands for no reading, and the last such number.
    sentinels: Vec<(usize, f64)>,
    /// Whether such numbers are looked for.
    checked: bool,
    /// Cells with text, by column.
    text: Vec<usize>,
    counts: Counts,
}

/// The columns of the rows kept, and how many rows the file has.
pub(super) struct Kept {
    pub columns: Columns,
    pub rows: usize,
}

impl<'a> Rows<'a> {
    pub fn new(layout: &'a Layout, separator: Separator, sidecar: Option<&Sidecar>) -> Self {
        let used: Vec<usize> = (0..layout.names.len())
            .filter(|&place| matches!(layout.meanings[place], Meaning::Channel(..) | Meaning::Unknown))
            .collect();
        Self {
            layout,
            separator,
            time_step: sidecar.and_then(|sidecar| sidecar.time_step),
            part: sidecar.map_or((f64::NEG_INFINITY, f64::INFINITY), |sidecar| (sidecar.from, sidecar.until)),
            every: sidecar.map_or(1, |sidecar| sidecar.every),
            time_place: layout.time(),
            rudder_place: layout.rudder(),
            heading_place: layout.place(Channel::Heading),
            time: Vec::new(),
            columns: vec![Vec::new(); used.len()],
            used,
            cells: Vec::new(),
            row: vec![f64::NAN; layout.names.len()],
            last: vec![None; layout.names.len()],
            sentinels: vec![(0, 0.0); layout.names.len()],
            checked: sidecar.is_none_or(|sidecar| sidecar.plausibility),
            before: None,
            last_heading: None,
            usable: 0,
            span: None,
            text: vec![0; layout.names.len()],
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

    /// The complaint about a table that is too long, after `consumed` of its `size` bytes.
    pub fn too_many(&self, consumed: u64, size: Option<u64>) -> Problem {
        let limit = self.limit();
        let estimate = size.filter(|&size| consumed > 0 && size > consumed).map(|size| {
            let share = size as f64 / consumed as f64;
            // Two digits: more would claim a precision the estimate does not have.
            let rows = self.kept() as f64 * share;
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
        if let Some(place) = self.heading_place {
            self.unwrap(place);
        }
        if self.rudder_place.is_none_or(|place| self.row[place].is_nan()) {
            self.counts.no_rudder += 1;
            return Ok(());
        }
        self.usable += 1;
        if (self.usable - 1).is_multiple_of(self.every) {
            self.time.push(time);
            for (values, &place) in self.columns.iter_mut().zip(&self.used) {
                values.push(self.row[place]);
            }
        }
        Ok(())
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
                Meaning::Unknown => 1.0,
                Meaning::Ignored => continue,
            };
            let read = cell(text, self.separator);
            self.row[place] = match read {
                Cell::Number(value) | Cell::CommaNumber(value) => {
                    self.counts.decimal_commas += usize::from(matches!(read, Cell::CommaNumber(_)));
                    match meaning {
                        Meaning::Channel(channel, _)
                            if self.checked && is_sentinel(channel, value, self.last[place]) =>
                        {
                            self.sentinels[place] = (self.sentinels[place].0 + 1, value);
                            f64::NAN
                        }
                        _ => {
                            self.last[place] = Some(value);
                            value * factor
                        }
                    }
                }
                Cell::Missing => f64::NAN,
                Cell::Text if meaning == Meaning::Unknown => {
                    self.text[place] += 1;
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

    /// Whether the row comes after the one before; a row that repeats the one before in every value does not.
    fn follows(&mut self, time: f64, number: usize) -> Result<bool, Problem> {
        if let Some((before, row)) = &mut self.before {
            if time < *before {
                return Err(Problem::TimeBackwards { line: number, before: *before, found: time });
            }
            if time == *before {
                let same = row.iter().zip(&self.row).all(|(a, b)| a == b || (a.is_nan() && b.is_nan()));
                if !same {
                    return Err(Problem::TimeRepeats { line: number, time });
                }
                self.counts.repeated += 1;
                return Ok(false);
            }
            *before = time;
            row.copy_from_slice(&self.row);
        } else {
            self.before = Some((time, self.row.clone()));
        }
        Ok(true)
    }

    /// Removes the wrap of the heading before rows are left out: thinning may turn a fast turn into steps beyond 180°.
    fn unwrap(&mut self, place: usize) {
        let heading = self.row[place];
        if heading.is_nan() {
            return;
        }
        let mut pair = [self.last_heading.unwrap_or(heading), heading];
        unwrap_heading(&mut pair);
        self.row[place] = pair[1];
        self.last_heading = Some(pair[1]);
    }

    /// The columns of all rows kept, with warnings; `line` is where the header stands.
    pub fn finish(mut self, line: usize) -> Result<(Kept, Vec<String>), Problem> {
        if self.counts.rows == 0 {
            return Err(no_rows(line));
        }
        self.check_values()?;
        let mut warnings = self.warnings();
        let mut channels = BTreeMap::new();
        let mut unknown = Vec::new();
        for (values, &place) in std::mem::take(&mut self.columns).into_iter().zip(&self.used) {
            let missing = values.iter().all(|value| value.is_nan());
            match self.layout.meanings[place] {
                // A channel nobody needs and nobody recorded is as good as absent.
                Meaning::Channel(..) if missing => {
                    warnings.push(format!(
                        "the column `{}` has no value and is left out",
                        shortened(&self.layout.names[place])
                    ));
                }
                Meaning::Channel(channel, _) => {
                    channels.insert(channel, values);
                }
                _ if missing && self.text[place] > 0 => {}
                _ => unknown.push((self.layout.names[place].clone(), values)),
            }
        }
        if self.layout.order_is_rudder
            && let Some(order) = channels.get(&Channel::RudderOrder)
        {
            let order = order.clone();
            channels.insert(Channel::Rudder, order);
        }
        if !channels.contains_key(&Channel::Speed)
            && let (Some(surge), Some(sway)) = (channels.get(&Channel::Surge), channels.get(&Channel::Sway))
        {
            let speed = surge.iter().zip(sway).map(|(u, v)| u.hypot(*v)).collect();
            channels.insert(Channel::Speed, speed);
        }
        let columns = Columns { time: self.time, channels, unknown };
        Ok((Kept { columns, rows: self.counts.rows }, warnings))
    }

    /// Refuses a part without rows, and needed columns without a value.
    fn check_values(&self) -> Result<(), Problem> {
        let counts = &self.counts;
        let all_missing =
            |place: usize, quantity| Err(Problem::AllMissing { column: self.layout.names[place].clone(), quantity });
        if let Some(place) = self.time_place.filter(|_| counts.no_time == counts.rows) {
            return all_missing(place, "time");
        }
        if self.usable == 0 && counts.no_rudder == 0 {
            let (from_s, until_s) = self.part;
            let (first_s, last_s) = self.span.expect("some row has a time, or all_missing had returned");
            return Err(Problem::EmptyPart { from_s, until_s, first_s, last_s });
        }
        if let Some(place) = self.rudder_place.filter(|_| self.usable == 0) {
            return all_missing(place, spoken(Channel::Rudder));
        }
        let empty = |channel| {
            let place = self.layout.place(channel)?;
            let column = self.used.iter().position(|&used| used == place)?;
            self.columns[column].iter().all(|value| value.is_nan()).then_some(place)
        };
        let has_rate = self.layout.place(Channel::YawRate).is_some() && empty(Channel::YawRate).is_none();
        match empty(Channel::Heading) {
            Some(place) if !has_rate => all_missing(place, spoken(Channel::Heading)),
            None if self.heading_place.is_none() && !has_rate => {
                let place = self.layout.place(Channel::YawRate).expect("a layout without heading has a yaw rate");
                all_missing(place, spoken(Channel::YawRate))
            }
            _ => Ok(()),
        }
    }

    fn warnings(&self) -> Vec<String> {
        let counts = &self.counts;
        let mut warnings = Vec::new();
        let mut count = |number: usize, text: &str| {
            if number > 0 {
                warnings.push(format!("{number} {} {text}", if number == 1 { "row" } else { "rows" }));
            }
        };
        count(counts.no_time, "without time left out");
        count(counts.no_rudder, "without rudder angle left out; between its neighbours the rudder runs straight");
        count(counts.repeated, "left out as exact copies of the row before");
        count(counts.short, "with fewer cells than the header; the last columns were taken as missing there");
        if counts.decimal_commas > 0 {
            warnings.push(format!("{} numbers were read with a decimal comma", counts.decimal_commas));
        }
        for (name, &text) in self.layout.names.iter().zip(&self.text) {
            if text > 0 {
                warnings.push(format!("the column `{}` holds text in {text} rows, taken as missing", shortened(name)));
            }
        }
        for (name, (count, value)) in self.layout.names.iter().zip(&self.sentinels) {
            if *count > 0 {
                let times = if *count == 1 { String::from("once") } else { format!("{count} times") };
                warnings.push(format!("the column `{}` holds {value} {times}, taken as missing", shortened(name)));
            }
        }
        if self.layout.order_is_rudder {
            let name = self.rudder_place.map_or("", |place| &self.layout.names[place]);
            warnings.push(format!(
                "there is no rudder angle; the order `{}` stands for it, so the lag of the steering gear is in the response",
                shortened(name)
            ));
        }
        warnings
    }
}
