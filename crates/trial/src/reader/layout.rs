//! What every column of a table holds, from its header, a row of units, its sidecar and its first row, decided once
//! before the rows are read.

use std::path::Path;

use document::{Code, Warning};
use ship::effects::ColumnFormula;

use super::error::{Problem, ReadError};
use super::head::Head;
use crate::cells::cell;
use crate::channel::{Channel, Unit};
use crate::clock::Stamp;
use crate::names::{ColumnMeaning, contract, meaning, with_unit};
use crate::sidecar::{Sidecar, SidecarProblem, Which};
use crate::words::shortened;

/// What one column holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Content {
    /// Time; the factor to seconds.
    Time(f64),
    /// Stamps of date and time, or of the time of day.
    Stamp,
    /// The dates that belong to stamps of the time of day.
    Date,
    /// A channel; the factor to SI units, with the scale of the column.
    Channel(Channel, f64),
    /// Latitude, rad.
    Latitude,
    /// Longitude, rad.
    Longitude,
    /// Carried as it is.
    Unknown,
    /// Left out.
    Ignored,
}

impl Content {
    /// Whether the values of the column are kept.
    pub fn is_kept(self) -> bool {
        !matches!(self, Self::Time(_) | Self::Stamp | Self::Date | Self::Ignored)
    }
}

/// How well a name says what it holds; the lower the better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    /// The sidecar says it.
    Described,
    /// It is a name of the contract.
    Contract,
    /// It is what people call it.
    Usual,
    /// A speed over ground for the speed.
    Substitute,
}

/// One column of a table: what it holds, what was met in it, and its values in the rows kept.
#[derive(Debug)]
pub(super) struct RawColumn {
    pub name: String,
    pub content: Content,
    /// Whether its unit has to be found from its values; until then they are in the unit files are written in.
    pub open: bool,
    claim: Option<(ColumnMeaning, Rank)>,
    scale: f64,
    /// The number at zero.
    pub zero: f64,
    /// The last number, as it stands in the file.
    pub last: Option<f64>,
    /// The largest number, without its sign.
    pub largest: f64,
    /// The longest way between two numbers, and whether all are whole.
    pub largest_step: f64,
    pub is_whole: bool,
    /// Cells with the word for a side.
    pub sides: usize,
    /// How often there was a number that stands for no reading, and the last such number.
    pub sentinels: (usize, f64),
    /// Cells with text.
    pub text: usize,
    pub values: Vec<f64>,
}

impl RawColumn {
    fn new(name: &str, claim: Option<(ColumnMeaning, Rank)>) -> Self {
        Self {
            name: name.to_owned(),
            content: Content::Unknown,
            open: false,
            claim,
            scale: 1.0,
            zero: 0.0,
            last: None,
            largest: 0.0,
            largest_step: 0.0,
            is_whole: true,
            sides: 0,
            sentinels: (0, 0.0),
            text: 0,
            values: Vec::new(),
        }
    }

    /// Takes note of a number as it stands in the file.
    pub fn note(&mut self, number: f64) {
        self.largest_step = self.largest_step.max((number - self.last.unwrap_or(number)).abs());
        self.is_whole &= number.fract() == 0.0;
        self.last = Some(number);
        self.largest = self.largest.max(((number - self.zero) * self.scale).abs());
    }

    fn claims(&self, wanted: impl Fn(ColumnMeaning) -> bool) -> bool {
        self.claim.is_some_and(|(said, _)| wanted(said))
    }
}

/// The columns of a table.
#[derive(Debug)]
pub(super) struct Layout {
    pub columns: Vec<RawColumn>,
    /// How many of them are cells of a row; those behind are worked out.
    pub cells: usize,
    /// What the columns behind are worked out of: the places of the others in the order of the names.
    pub formulas: Vec<(ColumnFormula, Vec<usize>)>,
    /// The ordered rudder angle stands for the rudder angle, because there is no other.
    order_is_rudder: bool,
    /// Where the names stand.
    pub line: usize,
    /// Columns that were understood by what people call them, for a warning.
    pub understood: Vec<String>,
    /// What was decided between columns.
    pub warnings: Vec<Warning>,
}

impl Layout {
    /// Decides what the columns hold.
    ///
    /// A sidecar goes before the names, and a name of the contract before any other. Fails when the sidecar speaks of a
    /// column that is not there, when two columns say equally well that they hold one quantity, and when time, or in
    /// the table of a whole record rudder or both heading and yaw rate are absent.
    pub fn new(head: &Head, table: &Path, sidecar: &Sidecar, whole: bool) -> Result<Self, ReadError> {
        let rebuilt = sidecar.table.time_step_s.is_some();
        let column = |(place, name): (usize, &String)| {
            RawColumn::new(name, claim(name, head.unit(place)).filter(|_| sidecar.has_header()))
        };
        let mut layout = Self {
            columns: head.names.iter().enumerate().map(column).collect(),
            cells: head.names.len(),
            formulas: Vec::new(),
            order_is_rudder: false,
            line: head.line,
            understood: Vec::new(),
            warnings: Vec::new(),
        };
        layout.describe(table, sidecar)?;
        let fault = |problem| ReadError::table(table, problem);
        layout.settle_channels().map_err(fault)?;
        if rebuilt {
            let is_time = |said| matches!(said, ColumnMeaning::Time(_) | ColumnMeaning::Date);
            let times = layout.columns.iter_mut().filter(|column| column.claims(is_time));
            times.for_each(|column| column.content = Content::Ignored);
        } else {
            layout.settle_time(head).map_err(fault)?;
        }
        layout.order_is_rudder = layout.place(Channel::Rudder).is_none();
        if whole {
            layout.check().map_err(fault)?;
        }
        if layout.time().is_none() && !rebuilt {
            let accepted = "t_s (or t_ms or t_min), a column of dates and times, or `time-step-s` in a sidecar".into();
            let (line, found) = (head.line, layout.names());
            return Err(fault(Problem::NoColumn { line, wanted: "time", accepted, found }));
        }
        Ok(layout)
    }

    fn names(&self) -> Vec<String> {
        self.columns.iter().map(|column| column.name.clone()).collect()
    }

    fn find(&self, wanted: impl Fn(Content) -> bool) -> Option<usize> {
        self.columns.iter().position(|column| wanted(column.content))
    }

    /// The column that holds the rudder: the angle, or the order where there is no angle.
    pub fn rudder(&self) -> Option<usize> {
        self.place(if self.order_is_rudder { Channel::RudderOrder } else { Channel::Rudder })
    }

    /// The column that holds a channel.
    pub fn place(&self, wanted: Channel) -> Option<usize> {
        self.find(|content| matches!(content, Content::Channel(channel, _) if channel == wanted))
    }

    /// The column that holds time.
    pub fn time(&self) -> Option<usize> {
        self.find(|content| matches!(content, Content::Time(_) | Content::Stamp))
    }

    /// The column that holds the dates of the stamps.
    pub fn date(&self) -> Option<usize> {
        self.find(|content| content == Content::Date)
    }

    /// Lets the sidecar speak: its words replace the meaning of the names.
    fn describe(&mut self, table: &Path, sidecar: &Sidecar) -> Result<(), ReadError> {
        let mut seen = vec![false; self.columns.len()];
        // A formula names columns of the table: those before it.
        for described in &sidecar.columns {
            let fault = |problem| Err(ReadError::from(sidecar.error(described.line, problem)));
            let table = table.to_path_buf();
            let place = match &described.which {
                Which::Place(place) if *place < seen.len() => *place,
                Which::Place(place) => {
                    return fault(SidecarProblem::IndexBeyond { index: place + 1, table, columns: seen.len() });
                }
                Which::Name(name) => match self.columns.iter().position(|column| column.name == *name) {
                    Some(place) => place,
                    None => {
                        let (name, found) = (name.clone(), self.names());
                        return fault(SidecarProblem::NameNotFound { name, table, found });
                    }
                },
                Which::Formula(formula) => {
                    let place = |name: &String| {
                        let place = self.columns[..self.cells].iter().position(|column| column.name == *name);
                        place.ok_or_else(|| name.clone())
                    };
                    match formula.names().iter().map(place).collect() {
                        Ok(places) => self.formulas.push((formula.clone(), places)),
                        Err(name) => {
                            let found = self.names();
                            return fault(SidecarProblem::NameNotFound { name, table, found });
                        }
                    }
                    self.columns.push(RawColumn::new("formula", None));
                    seen.push(false);
                    self.columns.len() - 1
                }
            };
            let column = &mut self.columns[place];
            let name = column.name.clone();
            if std::mem::replace(&mut seen[place], true) {
                return fault(SidecarProblem::DescribedTwice { name });
            }
            (column.scale, column.zero) = (described.scale, described.zero);
            match (described.meaning, &mut column.claim) {
                _ if described.ignore => (column.content, column.claim) = (Content::Ignored, None),
                (Some(meaning), claim) => *claim = Some((meaning, Rank::Described)),
                (None, Some((_, rank))) => *rank = (*rank).min(Rank::Contract),
                (None, None) => return fault(SidecarProblem::NameSaysNothing { name }),
            }
        }
        Ok(())
    }

    /// Gives every channel the column that says best that it holds it.
    fn settle_channels(&mut self) -> Result<(), Problem> {
        for channel in Channel::ALL {
            let claim = |(place, column): (usize, &RawColumn)| match column.claim? {
                (ColumnMeaning::Channel(found, unit), rank) if found == channel => Some((rank, place, unit)),
                (ColumnMeaning::OverGround(unit), _) if channel == Channel::Speed => {
                    Some((Rank::Substitute, place, unit))
                }
                _ => None,
            };
            let mut claims: Vec<_> = self.columns.iter().enumerate().filter_map(claim).collect();
            claims.sort_by_key(|(rank, place, _)| (*rank, *place));
            let Some(&(rank, place, unit)) = claims.first() else { continue };
            if let Some(&(_, other, _)) = claims.get(1).filter(|(other, ..)| *other == rank) {
                let needed = matches!(channel, Channel::Heading | Channel::Rudder | Channel::YawRate);
                if needed || rank <= Rank::Contract {
                    return Err(self.duplicate(channel.quantity(), place, other));
                }
                let [first, second] = [place, other].map(|place| shortened(&self.columns[place].name));
                self.warnings.push(Code::Columns.warning(format!(
                    "the columns `{first}` and `{second}` could both be the {}; neither is used, unless a sidecar says \
                     which",
                    channel.spoken()
                )));
                continue;
            }
            let factor = unit.unwrap_or(channel.written_unit()).to_si();
            let content = |scale: f64| Content::Channel(channel, scale * factor);
            self.settle(place, rank, unit, content);
        }
        for column in &mut self.columns {
            match column.claim {
                Some((ColumnMeaning::Latitude, _)) => column.content = Content::Latitude,
                Some((ColumnMeaning::Longitude, _)) => column.content = Content::Longitude,
                _ => {}
            }
        }
        Ok(())
    }

    fn settle(&mut self, place: usize, rank: Rank, unit: Option<Unit>, content: impl Fn(f64) -> Content) {
        let column = &mut self.columns[place];
        column.content = content(column.scale);
        column.open = unit.is_none() && column.content != Content::Stamp;
        if rank >= Rank::Usual {
            self.understood.push(column.name.clone());
        }
    }

    fn duplicate(&self, quantity: &'static str, first: usize, second: usize) -> Problem {
        let [first, second] = [first, second].map(|place| self.columns[place].name.clone());
        Problem::Duplicate { line: self.line, quantity, first, second }
    }

    /// Finds the column of time, and the dates that belong to it.
    fn settle_time(&mut self, head: &Head) -> Result<(), Problem> {
        let cells = head.first();
        let first = |place: usize| cells.get(place).copied().unwrap_or_default();
        let is_number = |place: usize| cell(first(place), head.separator).number().is_some();
        let stamp = |place: usize| Stamp::parse(first(place));
        let is_whole = |stamp: Stamp| stamp.has_date() && stamp.has_time();
        // Described or of the contract, then a number with a unit, a stamp with its date, a time of day, a number.
        let candidate = |(place, column): (usize, &RawColumn)| {
            let (said, rank) = column.claim?;
            let unit = match said {
                ColumnMeaning::Time(unit) => unit,
                ColumnMeaning::Date if stamp(place).is_some_and(|stamp| stamp.has_time()) => None,
                _ => return None,
            };
            let worth = match stamp(place).filter(|_| !is_number(place)) {
                _ if unit.is_some() && rank <= Rank::Contract => 0,
                None if unit.is_some() => 1,
                Some(stamp) if is_whole(stamp) => 2,
                Some(stamp) if stamp.has_time() => 3,
                _ => 4,
            };
            Some((rank, worth, place, unit))
        };
        let mut candidates: Vec<_> = self.columns.iter().enumerate().filter_map(candidate).collect();
        candidates.sort_by_key(|(rank, worth, place, _)| (*rank, *worth, *place));
        if candidates.is_empty() {
            // Some programs give their column of stamps no name.
            let is_unnamed = |&place: &usize| self.columns[place].claim.is_none() && stamp(place).is_some_and(is_whole);
            let unnamed = (0..self.columns.len()).find(is_unnamed);
            candidates.extend(unnamed.map(|place| (Rank::Usual, 2, place, None)));
        }
        let Some(&(rank, worth, place, unit)) = candidates.first() else { return Ok(()) };
        if let Some(&(_, _, other, _)) = candidates.get(1).filter(|(r, w, ..)| (*r, *w) == (rank, worth)) {
            return Err(self.duplicate("time", place, other));
        }
        candidates[1..].iter().for_each(|&(_, _, other, _)| self.columns[other].content = Content::Ignored);
        match stamp(place).filter(|_| !is_number(place)) {
            Some(own) => {
                self.settle(place, rank, unit, |_| Content::Stamp);
                let dates = self.columns.iter().position(|column| column.claims(|said| said == ColumnMeaning::Date));
                if let Some(date) = dates.filter(|&date| !own.has_date() && date != place && stamp(date).is_some()) {
                    self.columns[date].content = Content::Date;
                }
            }
            None => self.settle(place, rank, unit, |scale| Content::Time(scale * unit.map_or(1.0, Unit::to_si))),
        }
        Ok(())
    }

    /// Refuses a table that has no rudder, or neither heading nor yaw rate.
    fn check(&self) -> Result<(), Problem> {
        let line = self.line;
        let missing = |channels: [Channel; 2], wanted| {
            let names = channels.map(|channel| channel.accepted_names());
            Err(Problem::NoColumn { line, wanted, accepted: names.join(" or "), found: self.names() })
        };
        if self.rudder().is_none() {
            return missing([Channel::Rudder, Channel::RudderOrder], "rudder angle");
        }
        if self.place(Channel::Heading).is_none() && self.place(Channel::YawRate).is_none() {
            let is_course = |column: &&RawColumn| column.claims(|said| said == ColumnMeaning::Course);
            return match self.columns.iter().find(is_course) {
                Some(column) => Err(Problem::CourseOnly { line, column: column.name.clone() }),
                None => missing([Channel::Heading, Channel::YawRate], "heading or the yaw rate"),
            };
        }
        Ok(())
    }
}

/// What a name says, with the unit below it where it has none of its own.
fn claim(name: &str, below: Option<Unit>) -> Option<(ColumnMeaning, Rank)> {
    let said = meaning(name)?;
    let rank = if contract(name).is_some() { Rank::Contract } else { Rank::Usual };
    let open =
        matches!(said, ColumnMeaning::Time(None) | ColumnMeaning::Channel(_, None) | ColumnMeaning::OverGround(None));
    let said = match below.filter(|_| open) {
        Some(unit) => with_unit(said, unit)?,
        None => said,
    };
    Some((said, rank))
}
