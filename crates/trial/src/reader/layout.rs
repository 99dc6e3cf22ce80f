//! What every column of a table holds, from its header, a row of units, its sidecar and its first row, decided once
//! before the rows are read.

use std::path::Path;

use super::error::{Problem, ReadError};
use super::limits::spoken;
use crate::cells::{Cell, Separator, cell};
use crate::channel::{Channel, Unit};
use crate::clock::Stamp;
use crate::names::{ColumnMeaning, contract, meaning, with_unit};
use crate::sidecar::{Sidecar, SidecarProblem, Which};
use crate::words::shortened;

/// What one column holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Meaning {
    /// Time; the factor to seconds.
    Time(f64),
    /// Stamps of date and time, or of the time of day.
    Stamp,
    /// The dates that belong to stamps of the time of day.
    Date,
    /// A channel; the factor to SI units, negative where the sign is changed.
    Channel(Channel, f64),
    /// Latitude, deg.
    Latitude,
    /// Longitude, deg.
    Longitude,
    /// Carried as it is.
    Unknown,
    /// Left out.
    Ignored,
}

/// The head of a table.
#[derive(Debug)]
pub(super) struct Head {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Units below the names, where a row holds them.
    pub units: Vec<Option<Unit>>,
    /// Line of the names.
    pub line: usize,
    /// Cells of the first row.
    pub first: Vec<String>,
    /// What stands between cells.
    pub separator: Separator,
}

/// The columns of a table.
#[derive(Debug)]
pub(super) struct Layout {
    pub names: Vec<String>,
    pub meanings: Vec<Meaning>,
    /// Columns whose unit has to be found from their values; until then they are in the unit files are written in.
    pub open: Vec<bool>,
    /// The ordered rudder angle stands for the rudder angle, because there is no other.
    pub order_is_rudder: bool,
    /// Where the names stand.
    pub line: usize,
    /// Columns that were understood by what people call them, for a warning.
    pub understood: Vec<usize>,
    /// What was decided between columns, one sentence each.
    pub told: Vec<String>,
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

impl Layout {
    /// Decides what the columns hold.
    ///
    /// A sidecar goes before the names, and a name of the contract before any other. Fails when the sidecar speaks of a
    /// column that is not there, when two columns say equally well that they hold one quantity, and when time, or in
    /// the table of a whole record rudder or both heading and yaw rate are absent.
    pub fn new(head: Head, table: &Path, sidecar: Option<&Sidecar>, whole: bool) -> Result<Self, ReadError> {
        let has_header = sidecar.is_none_or(|sidecar| sidecar.header);
        let rebuilt = sidecar.is_some_and(|sidecar| sidecar.time_step.is_some());
        let columns = head.names.len();
        let mut layout = Self {
            meanings: vec![Meaning::Unknown; columns],
            open: vec![false; columns],
            order_is_rudder: false,
            line: head.line,
            understood: Vec::new(),
            told: Vec::new(),
            names: head.names.clone(),
        };
        let mut claims: Vec<Option<(ColumnMeaning, Rank)>> = vec![None; columns];
        if has_header {
            for (place, name) in head.names.iter().enumerate() {
                claims[place] = claim(name, head.units.get(place).copied().flatten());
            }
        }
        let mut signs = vec![1.0; columns];
        if let Some(sidecar) = sidecar {
            describe(&head.names, &mut claims, &mut signs, &mut layout.meanings, table, sidecar)?;
        }
        let fault = |problem| ReadError::table(table, problem);
        layout.settle_channels(&mut claims, &signs).map_err(fault)?;
        if rebuilt {
            let stamps = claims.iter().zip(&mut layout.meanings);
            stamps.filter(|(claim, _)| is_time(claim)).for_each(|(_, meaning)| *meaning = Meaning::Ignored);
        } else {
            layout.settle_time(&claims, &signs, &head).map_err(fault)?;
        }
        layout.order_is_rudder = layout.place(Channel::Rudder).is_none();
        if whole {
            layout.check(&claims).map_err(fault)?;
        }
        if layout.time().is_none() && !rebuilt {
            let accepted =
                "t_s (or t_ms or t_min), a column of dates and times, or `time-step-s` in a sidecar".to_owned();
            let found = head.names;
            return Err(fault(Problem::NoColumn { line: head.line, wanted: "time", accepted, found }));
        }
        Ok(layout)
    }

    /// The column that holds the rudder: the angle, or the order where there is no angle.
    pub fn rudder(&self) -> Option<usize> {
        self.place(if self.order_is_rudder { Channel::RudderOrder } else { Channel::Rudder })
    }

    /// The column that holds a channel.
    pub fn place(&self, wanted: Channel) -> Option<usize> {
        self.meanings.iter().position(|meaning| matches!(meaning, Meaning::Channel(channel, _) if *channel == wanted))
    }

    /// The column that holds time.
    pub fn time(&self) -> Option<usize> {
        self.meanings.iter().position(|meaning| matches!(meaning, Meaning::Time(_) | Meaning::Stamp))
    }

    /// The column that holds the dates of the stamps.
    pub fn date(&self) -> Option<usize> {
        self.meanings.iter().position(|meaning| *meaning == Meaning::Date)
    }

    /// Gives every channel the column that says best that it holds it.
    fn settle_channels(&mut self, claims: &mut [Option<(ColumnMeaning, Rank)>], signs: &[f64]) -> Result<(), Problem> {
        for channel in Channel::ALL {
            let mut of_channel: Vec<(Rank, usize, Option<Unit>)> = claims
                .iter()
                .enumerate()
                .filter_map(|(place, claim)| match (*claim)? {
                    (ColumnMeaning::Channel(found, unit), rank) if found == channel => Some((rank, place, unit)),
                    (ColumnMeaning::OverGround(unit), _) if channel == Channel::Speed => {
                        Some((Rank::Substitute, place, unit))
                    }
                    _ => None,
                })
                .collect();
            of_channel.sort_by_key(|(rank, place, _)| (*rank, *place));
            let Some(&(rank, place, unit)) = of_channel.first() else { continue };
            if let Some(&(_, other, _)) = of_channel.get(1).filter(|(other, ..)| *other == rank) {
                let needed = matches!(channel, Channel::Heading | Channel::Rudder | Channel::YawRate);
                let (first, second) = (self.names[place].clone(), self.names[other].clone());
                if needed || rank <= Rank::Contract {
                    return Err(Problem::Duplicate { line: self.line, quantity: channel.quantity(), first, second });
                }
                self.told.push(format!(
                    "the columns `{}` and `{}` could both be the {}; neither is used, unless a sidecar says which",
                    shortened(&first),
                    shortened(&second),
                    spoken(channel)
                ));
                continue;
            }
            let open = unit.is_none();
            let factor = unit.unwrap_or(channel.written_unit()).to_si();
            self.meanings[place] = Meaning::Channel(channel, signs[place] * factor);
            self.open[place] = open;
            if rank >= Rank::Usual {
                self.understood.push(place);
            }
        }
        for (place, claim) in claims.iter().enumerate() {
            match claim {
                Some((ColumnMeaning::Latitude, _)) => self.meanings[place] = Meaning::Latitude,
                Some((ColumnMeaning::Longitude, _)) => self.meanings[place] = Meaning::Longitude,
                _ => {}
            }
        }
        Ok(())
    }

    /// Finds the column of time, and the dates that belong to it.
    fn settle_time(
        &mut self,
        claims: &[Option<(ColumnMeaning, Rank)>],
        signs: &[f64],
        head: &Head,
    ) -> Result<(), Problem> {
        let first = |place: usize| head.first.get(place).map_or("", String::as_str);
        let stamp = |place: usize| Stamp::parse(first(place));
        let is_number =
            |place: usize| matches!(cell(first(place), head.separator), Cell::Number(_) | Cell::CommaNumber(_));
        // Described or of the contract, then a number with a unit, a stamp with its date, a time of day, a number.
        let mut candidates: Vec<(Rank, u8, usize, Option<Unit>)> = claims
            .iter()
            .enumerate()
            .filter_map(|(place, claim)| {
                let (said, rank) = (*claim)?;
                let unit = match said {
                    ColumnMeaning::Time(unit) => unit,
                    ColumnMeaning::Date if stamp(place).is_some_and(|stamp| stamp.has_time()) => None,
                    _ => return None,
                };
                let worth = match stamp(place).filter(|_| !is_number(place)) {
                    _ if unit.is_some() && rank <= Rank::Contract => 0,
                    None if unit.is_some() => 1,
                    Some(stamp) if stamp.has_date() && stamp.has_time() => 2,
                    Some(stamp) if stamp.has_time() => 3,
                    _ => 4,
                };
                Some((rank, worth, place, unit))
            })
            .collect();
        candidates.sort_by_key(|(rank, worth, place, _)| (*rank, *worth, *place));
        if candidates.is_empty() {
            // Some programs give their column of stamps no name.
            let unnamed = (0..self.names.len()).find(|&place| {
                claims[place].is_none() && stamp(place).is_some_and(|stamp| stamp.has_date() && stamp.has_time())
            });
            candidates.extend(unnamed.map(|place| (Rank::Usual, 2, place, None)));
        }
        let Some(&(rank, worth, place, unit)) = candidates.first() else { return Ok(()) };
        if let Some(&(_, _, other, _)) = candidates.get(1).filter(|(r, w, ..)| (*r, *w) == (rank, worth)) {
            let (first, second) = (self.names[place].clone(), self.names[other].clone());
            return Err(Problem::Duplicate { line: self.line, quantity: "time", first, second });
        }
        candidates[1..].iter().for_each(|&(_, _, other, _)| self.meanings[other] = Meaning::Ignored);
        let is_stamp = !is_number(place) && stamp(place).is_some();
        if is_stamp {
            self.meanings[place] = Meaning::Stamp;
            let dated = stamp(place).is_some_and(|stamp| stamp.has_date());
            let dates = claims.iter().position(|claim| matches!(claim, Some((ColumnMeaning::Date, _))));
            if let Some(date) = dates.filter(|&date| !dated && date != place && stamp(date).is_some()) {
                self.meanings[date] = Meaning::Date;
            }
        } else {
            self.meanings[place] = Meaning::Time(signs[place] * unit.map_or(1.0, Unit::to_si));
            self.open[place] = unit.is_none();
        }
        if rank >= Rank::Usual {
            self.understood.push(place);
        }
        Ok(())
    }

    /// Refuses a table that has no rudder, or neither heading nor yaw rate.
    fn check(&self, claims: &[Option<(ColumnMeaning, Rank)>]) -> Result<(), Problem> {
        let line = self.line;
        if self.rudder().is_none() {
            let accepted = [Channel::Rudder, Channel::RudderOrder];
            return Err(Problem::no_column(line, &accepted, "rudder angle", &self.names));
        }
        if self.place(Channel::Heading).is_none() && self.place(Channel::YawRate).is_none() {
            if let Some(place) = claims.iter().position(|claim| matches!(claim, Some((ColumnMeaning::Course, _)))) {
                return Err(Problem::CourseOnly { line, column: self.names[place].clone() });
            }
            let accepted = [Channel::Heading, Channel::YawRate];
            return Err(Problem::no_column(line, &accepted, "heading or the yaw rate", &self.names));
        }
        Ok(())
    }
}

fn is_time(claim: &Option<(ColumnMeaning, Rank)>) -> bool {
    matches!(claim, Some((ColumnMeaning::Time(_) | ColumnMeaning::Date, _)))
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

/// Lets the sidecar speak: its words replace the meaning of the names.
fn describe(
    names: &[String],
    claims: &mut [Option<(ColumnMeaning, Rank)>],
    signs: &mut [f64],
    meanings: &mut [Meaning],
    table: &Path,
    sidecar: &Sidecar,
) -> Result<(), ReadError> {
    let mut seen = vec![false; names.len()];
    for described in &sidecar.columns {
        let fault = |problem| Err(ReadError::from(sidecar.error(described.line, problem)));
        let place = match &described.which {
            Which::Place(place) if *place < names.len() => *place,
            Which::Place(place) => {
                let (index, columns) = (place + 1, names.len());
                return fault(SidecarProblem::IndexBeyond { index, table: table.to_path_buf(), columns });
            }
            Which::Name(name) => match names.iter().position(|found| found == name) {
                Some(place) => place,
                None => {
                    let (name, found) = (name.clone(), names.to_vec());
                    return fault(SidecarProblem::NameNotFound { name, table: table.to_path_buf(), found });
                }
            },
        };
        if std::mem::replace(&mut seen[place], true) {
            return fault(SidecarProblem::DescribedTwice { name: names[place].clone() });
        }
        signs[place] = if described.flip { -1.0 } else { 1.0 };
        if described.ignore {
            meanings[place] = Meaning::Ignored;
            claims[place] = None;
        } else if let Some(meaning) = described.meaning {
            claims[place] = Some((meaning, Rank::Described));
        } else if let Some((_, rank)) = &mut claims[place] {
            *rank = (*rank).min(Rank::Contract);
        } else {
            return fault(SidecarProblem::NameSaysNothing { name: names[place].clone() });
        }
    }
    Ok(())
}
