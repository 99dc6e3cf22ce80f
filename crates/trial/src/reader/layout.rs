//! Layout of a table: the content of every column, determined before the rows are read, from the header, a row of
//! units, the sidecar and the first row.

use std::path::Path;

use document::{Warning, WarningCode};
use ship::effects::ColumnFormula;

use super::error::{ReadError, ReadProblem};
use super::head::Head;
use crate::cells::parse_cell;
use crate::channel::{Channel, Unit};
use crate::clock::TimeStamp;
use crate::names::{ColumnMeaning, column_meaning, meaning_with_unit, quantity_unit_meaning};
use crate::sidecar::{ColumnReference, Sidecar, SidecarProblem};
use crate::wording::shortened;

/// Content of a column.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) enum ColumnContent {
    /// Time; the factor to seconds.
    Time(f64),
    /// Stamps of date and time, or of the time of day.
    Stamp,
    /// Dates that belong to stamps of the time of day.
    Date,
    /// Channel; the factor to SI units, with the scale of the column.
    Channel(Channel, f64),
    /// Latitude, rad.
    Latitude,
    /// Longitude, rad.
    Longitude,
    /// Unknown quantity, kept unchanged.
    #[default]
    Unknown,
    /// Omitted column.
    Ignored,
}

impl ColumnContent {
    /// `true` for a column with kept values.
    pub fn is_kept(self) -> bool {
        !matches!(self, Self::Time(_) | Self::Stamp | Self::Date | Self::Ignored)
    }
}

/// Certainty of the meaning of a column; best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    /// Described by the sidecar.
    Described,
    /// `quantity_unit` name.
    Contract,
    /// Customary name.
    Usual,
    /// Speed over ground in place of the speed.
    Substitute,
}

/// Column of a table: its content, statistics of its cells, and its values in the rows kept.
#[derive(Debug, Default)]
pub(super) struct RawColumn {
    pub name: String,
    pub content: ColumnContent,
    /// `true` for a column without a unit; until the unit is determined, values are in the unit of written files.
    pub is_unitless: bool,
    /// Meaning with its certainty; `None` for an unknown or omitted column.
    claim: Option<(ColumnMeaning, Rank)>,
    /// Factor of the numbers declared by the sidecar, else 1.
    scale: f64,
    /// Number in the file at a value of zero.
    pub zero: f64,
    /// Last number, as in the file; `None` before the first.
    pub last: Option<f64>,
    /// Maximum magnitude of the numbers less `zero`, times `scale`.
    pub largest: f64,
    /// Maximum step between two successive numbers, as in the file.
    pub largest_step: f64,
    /// `true` if all numbers so far are whole.
    pub is_whole: bool,
    /// Number of cells with a side (port, starboard).
    pub sides: usize,
    /// Number of sentinels, and the last sentinel.
    pub sentinels: (usize, f64),
    /// Number of cells with text.
    pub text: usize,
    pub values: Vec<f64>,
}

impl RawColumn {
    fn new(name: &str, claim: Option<(ColumnMeaning, Rank)>) -> Self {
        Self { name: name.to_owned(), claim, scale: 1.0, is_whole: true, ..Self::default() }
    }

    /// Updates the statistics with a number as in the file.
    pub fn count(&mut self, number: f64) {
        self.largest_step = self.largest_step.max((number - self.last.unwrap_or(number)).abs());
        self.is_whole &= number.fract() == 0.0;
        self.last = Some(number);
        self.largest = self.largest.max(((number - self.zero) * self.scale).abs());
    }

    fn claims(&self, wanted: impl Fn(ColumnMeaning) -> bool) -> bool {
        self.claim.is_some_and(|(meaning, _)| wanted(meaning))
    }
}

/// Columns of a table.
#[derive(Debug)]
pub(super) struct Layout {
    pub columns: Vec<RawColumn>,
    /// Number of columns that are cells of a row; the further columns have formulas.
    pub cells: usize,
    /// Formulas of the further columns, each with the indices of the columns that it names.
    pub formulas: Vec<(ColumnFormula, Vec<usize>)>,
    /// `true` if the rudder order replaces a missing rudder angle.
    order_is_rudder: bool,
    /// Line of the names.
    pub line: usize,
    /// Columns recognised by customary names, for a warning.
    pub recognised: Vec<String>,
    /// Warnings of choices between columns.
    pub warnings: Vec<Warning>,
}

impl Layout {
    /// Layout of a table by its head and its sidecar.
    ///
    /// A sidecar precedes the names, and a `quantity_unit` name any other name. Fails if the sidecar describes a
    /// column that is absent, if two columns have the same quantity with equal certainty, if time is absent, and
    /// if the table of a `whole` record has no rudder or neither heading nor yaw rate.
    pub fn new(head: &Head, table: &Path, sidecar: &Sidecar, whole: bool) -> Result<Self, ReadError> {
        let rebuilt = sidecar.table.time_step_s.is_some();
        let column = |(index, name): (usize, &String)| {
            RawColumn::new(name, claim(name, head.unit(index)).filter(|_| sidecar.has_header()))
        };
        let mut layout = Self {
            columns: head.names.iter().enumerate().map(column).collect(),
            cells: head.names.len(),
            formulas: Vec::new(),
            order_is_rudder: false,
            line: head.line,
            recognised: Vec::new(),
            warnings: Vec::new(),
        };
        layout.describe(table, sidecar)?;
        let fault = |problem| ReadError::table(table, problem);
        layout.settle_channels().map_err(fault)?;
        if rebuilt {
            let is_time = |meaning| matches!(meaning, ColumnMeaning::Time(_) | ColumnMeaning::Date);
            let times = layout.columns.iter_mut().filter(|column| column.claims(is_time));
            times.for_each(|column| column.content = ColumnContent::Ignored);
        } else {
            layout.settle_time(head).map_err(fault)?;
        }
        layout.order_is_rudder = layout.column_of(Channel::Rudder).is_none();
        if whole {
            layout.check().map_err(fault)?;
        }
        if layout.time_column().is_none() && !rebuilt {
            let accepted = "t_s (or t_ms or t_min), a column of dates and times, or `time-step-s` in a sidecar".into();
            let (line, columns) = (head.line, layout.names());
            return Err(fault(ReadProblem::NoColumn { line, wanted: "time", accepted, columns }));
        }
        Ok(layout)
    }

    fn names(&self) -> Vec<String> {
        self.columns.iter().map(|column| column.name.clone()).collect()
    }

    fn find(&self, wanted: impl Fn(ColumnContent) -> bool) -> Option<usize> {
        self.columns.iter().position(|column| wanted(column.content))
    }

    /// Index of the column of the rudder angle or, without one, of the rudder order; `None` without either.
    pub fn rudder_column(&self) -> Option<usize> {
        self.column_of(if self.order_is_rudder { Channel::RudderOrder } else { Channel::Rudder })
    }

    /// Index of the column of a channel; `None` without such a column.
    pub fn column_of(&self, wanted: Channel) -> Option<usize> {
        self.find(|content| matches!(content, ColumnContent::Channel(channel, _) if channel == wanted))
    }

    /// Index of the column of time; `None` without such a column.
    pub fn time_column(&self) -> Option<usize> {
        self.find(|content| matches!(content, ColumnContent::Time(_) | ColumnContent::Stamp))
    }

    /// Index of the column of the dates that belong to times of day; `None` without such a column.
    pub fn date_column(&self) -> Option<usize> {
        self.find(|content| content == ColumnContent::Date)
    }

    /// Applies the descriptions of the sidecar, which replace the meaning of the names.
    fn describe(&mut self, table: &Path, sidecar: &Sidecar) -> Result<(), ReadError> {
        let mut seen = vec![false; self.columns.len()];
        // A formula refers to columns of the table, which precede it.
        for described in &sidecar.columns {
            let fault = |problem| Err(ReadError::from(sidecar.error(described.line, problem)));
            let table = table.to_path_buf();
            let index = match &described.which {
                ColumnReference::Index(index) if *index < seen.len() => *index,
                ColumnReference::Index(index) => {
                    return fault(SidecarProblem::IndexBeyond { index: index + 1, table, columns: seen.len() });
                }
                ColumnReference::Name(name) => match self.columns.iter().position(|column| column.name == *name) {
                    Some(index) => index,
                    None => {
                        let (name, header) = (name.clone(), self.names());
                        return fault(SidecarProblem::NameNotFound { name, table, header });
                    }
                },
                ColumnReference::Formula(formula) => {
                    let index = |name: &String| {
                        let index = self.columns[..self.cells].iter().position(|column| column.name == *name);
                        index.ok_or_else(|| name.clone())
                    };
                    match formula.column_names().iter().map(index).collect() {
                        Ok(places) => self.formulas.push((formula.clone(), places)),
                        Err(name) => {
                            let header = self.names();
                            return fault(SidecarProblem::NameNotFound { name, table, header });
                        }
                    }
                    self.columns.push(RawColumn::new("formula", None));
                    seen.push(false);
                    self.columns.len() - 1
                }
            };
            let column = &mut self.columns[index];
            let name = column.name.clone();
            if std::mem::replace(&mut seen[index], true) {
                return fault(SidecarProblem::DescribedTwice { name });
            }
            (column.scale, column.zero) = (described.scale, described.zero);
            match (described.meaning, &mut column.claim) {
                _ if described.ignore => (column.content, column.claim) = (ColumnContent::Ignored, None),
                (Some(meaning), claim) => *claim = Some((meaning, Rank::Described)),
                (None, Some((_, rank))) => *rank = (*rank).min(Rank::Contract),
                (None, None) => return fault(SidecarProblem::UnknownColumnName { name }),
            }
        }
        Ok(())
    }

    /// Assigns to every channel the column whose meaning is the most certain.
    fn settle_channels(&mut self) -> Result<(), ReadProblem> {
        for channel in Channel::ALL {
            let claim = |(index, column): (usize, &RawColumn)| match column.claim? {
                (ColumnMeaning::Channel(claimed, unit), rank) if claimed == channel => Some((rank, index, unit)),
                (ColumnMeaning::SpeedOverGround(unit), _) if channel == Channel::Speed => {
                    Some((Rank::Substitute, index, unit))
                }
                _ => None,
            };
            let mut claims: Vec<_> = self.columns.iter().enumerate().filter_map(claim).collect();
            claims.sort_by_key(|(rank, index, _)| (*rank, *index));
            let Some(&(rank, index, unit)) = claims.first() else { continue };
            if let Some(&(_, rival, _)) = claims.get(1).filter(|(rival, ..)| *rival == rank) {
                let needed = matches!(channel, Channel::Heading | Channel::Rudder | Channel::YawRate);
                if needed || rank <= Rank::Contract {
                    return Err(self.duplicate(channel.quantity(), index, rival));
                }
                let [first, second] = [index, rival].map(|index| shortened(&self.columns[index].name));
                self.warnings.push(WarningCode::Columns.warning(format!(
                    "the columns `{first}` and `{second}` could both be the {}; neither is used: name the right one in a \
                     sidecar",
                    channel.label()
                )));
                continue;
            }
            let factor = unit.unwrap_or(channel.written_unit()).si_factor();
            let content = |scale: f64| ColumnContent::Channel(channel, scale * factor);
            self.settle(index, rank, unit, content);
        }
        for column in &mut self.columns {
            match column.claim {
                Some((ColumnMeaning::Latitude, _)) => column.content = ColumnContent::Latitude,
                Some((ColumnMeaning::Longitude, _)) => column.content = ColumnContent::Longitude,
                _ => {}
            }
        }
        Ok(())
    }

    fn settle(&mut self, index: usize, rank: Rank, unit: Option<Unit>, content: impl Fn(f64) -> ColumnContent) {
        let column = &mut self.columns[index];
        column.content = content(column.scale);
        column.is_unitless = unit.is_none() && column.content != ColumnContent::Stamp;
        if rank >= Rank::Usual {
            self.recognised.push(column.name.clone());
        }
    }

    fn duplicate(&self, quantity: &'static str, first: usize, second: usize) -> ReadProblem {
        let [first, second] = [first, second].map(|index| self.columns[index].name.clone());
        ReadProblem::Duplicate { line: self.line, quantity, first, second }
    }

    /// Chooses the column of time, and its dates.
    fn settle_time(&mut self, head: &Head) -> Result<(), ReadProblem> {
        let cells = head.first_row();
        let first = |index: usize| cells.get(index).copied().unwrap_or_default();
        let is_number = |index: usize| parse_cell(first(index), head.separator).number().is_some();
        let stamp = |index: usize| TimeStamp::parse(first(index));
        let is_whole = |stamp: TimeStamp| stamp.has_date() && stamp.has_time();
        // Order of preference: described or `quantity_unit`, a number with a unit, a stamp with its date, a time of
        // day, a number.
        let candidate = |(index, column): (usize, &RawColumn)| {
            let (meaning, rank) = column.claim?;
            let unit = match meaning {
                ColumnMeaning::Time(unit) => unit,
                ColumnMeaning::Date if stamp(index).is_some_and(|stamp| stamp.has_time()) => None,
                _ => return None,
            };
            let worth = match stamp(index).filter(|_| !is_number(index)) {
                _ if unit.is_some() && rank <= Rank::Contract => 0,
                None if unit.is_some() => 1,
                Some(stamp) if is_whole(stamp) => 2,
                Some(stamp) if stamp.has_time() => 3,
                _ => 4,
            };
            Some((rank, worth, index, unit))
        };
        let mut candidates: Vec<_> = self.columns.iter().enumerate().filter_map(candidate).collect();
        candidates.sort_by_key(|(rank, worth, index, _)| (*rank, *worth, *index));
        if candidates.is_empty() {
            // Some programs write a column of stamps without a name.
            let is_unnamed = |&index: &usize| self.columns[index].claim.is_none() && stamp(index).is_some_and(is_whole);
            let unnamed = (0..self.columns.len()).find(is_unnamed);
            candidates.extend(unnamed.map(|index| (Rank::Usual, 2, index, None)));
        }
        let Some(&(rank, worth, index, unit)) = candidates.first() else { return Ok(()) };
        if let Some(&(_, _, rival, _)) = candidates.get(1).filter(|(r, w, ..)| (*r, *w) == (rank, worth)) {
            return Err(self.duplicate("time", index, rival));
        }
        candidates[1..].iter().for_each(|&(_, _, unused, _)| self.columns[unused].content = ColumnContent::Ignored);
        match stamp(index).filter(|_| !is_number(index)) {
            Some(first) => {
                self.settle(index, rank, unit, |_| ColumnContent::Stamp);
                let dates = self.columns.iter().position(|column| column.claims(|kind| kind == ColumnMeaning::Date));
                if let Some(date) = dates.filter(|&date| !first.has_date() && date != index && stamp(date).is_some()) {
                    self.columns[date].content = ColumnContent::Date;
                }
            }
            None => {
                self.settle(index, rank, unit, |scale| ColumnContent::Time(scale * unit.map_or(1.0, Unit::si_factor)))
            }
        }
        Ok(())
    }

    /// Refuses a table that has no rudder, or neither heading nor yaw rate.
    fn check(&self) -> Result<(), ReadProblem> {
        let line = self.line;
        let missing = |channels: [Channel; 2], wanted| {
            let names = channels.map(|channel| channel.accepted_names());
            Err(ReadProblem::NoColumn { line, wanted, accepted: names.join(" or "), columns: self.names() })
        };
        if self.rudder_column().is_none() {
            return missing([Channel::Rudder, Channel::RudderOrder], "rudder angle");
        }
        if self.column_of(Channel::Heading).is_none() && self.column_of(Channel::YawRate).is_none() {
            let is_course = |column: &&RawColumn| column.claims(|meaning| meaning == ColumnMeaning::CourseOverGround);
            return match self.columns.iter().find(is_course) {
                Some(column) => Err(ReadProblem::CourseOnly { line, column: column.name.clone() }),
                None => missing([Channel::Heading, Channel::YawRate], "heading or the yaw rate"),
            };
        }
        Ok(())
    }
}

/// Meaning of a name with its certainty; a name without a unit has the unit `below` it. `None` for an unknown name, and
/// for a unit that the quantity cannot have.
fn claim(name: &str, below: Option<Unit>) -> Option<(ColumnMeaning, Rank)> {
    let named = column_meaning(name)?;
    let rank = if quantity_unit_meaning(name).is_some() { Rank::Contract } else { Rank::Usual };
    let open = matches!(
        named,
        ColumnMeaning::Time(None) | ColumnMeaning::Channel(_, None) | ColumnMeaning::SpeedOverGround(None)
    );
    let complete = match below.filter(|_| open) {
        Some(unit) => meaning_with_unit(named, unit)?,
        None => named,
    };
    Some((complete, rank))
}
