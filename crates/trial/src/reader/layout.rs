//! What every column of a table holds, from its header and its sidecar, decided once before the first row is read.

use std::path::Path;

use super::error::{Problem, ReadError};
use crate::channel::Channel;
use crate::sidecar::{Quantity, Sidecar, SidecarProblem, Which};

/// What one column holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Meaning {
    /// Time; the factor to seconds.
    Time(f64),
    /// A channel; the factor to SI units, negative where the sign is changed.
    Channel(Channel, f64),
    /// Carried as it is.
    Unknown,
    /// Left out.
    Ignored,
}

/// The columns of a table.
#[derive(Debug)]
pub(super) struct Layout {
    pub names: Vec<String>,
    pub meanings: Vec<Meaning>,
    /// The ordered rudder angle stands for the rudder angle, because there is no other.
    pub order_is_rudder: bool,
}

impl Layout {
    /// Decides what the columns called `names` hold; `line` is where the names stand.
    ///
    /// A sidecar goes before the names. Fails when it speaks of a column that is not there, when two columns hold one
    /// quantity, and when time, rudder or both heading and yaw rate are absent.
    pub fn new(names: Vec<String>, line: usize, table: &Path, sidecar: Option<&Sidecar>) -> Result<Self, ReadError> {
        let has_header = sidecar.is_none_or(|sidecar| sidecar.header);
        let mut meanings: Vec<Meaning> = names
            .iter()
            .map(|name| if has_header { meaning(Quantity::of(name), false) } else { Meaning::Unknown })
            .collect();
        if let Some(sidecar) = sidecar {
            describe(&names, &mut meanings, table, sidecar)?;
            if sidecar.time_step.is_some() {
                for meaning in meanings.iter_mut().filter(|meaning| matches!(meaning, Meaning::Time(_))) {
                    *meaning = Meaning::Ignored;
                }
            }
        }
        let has = |wanted| meanings.iter().any(|m| matches!(m, Meaning::Channel(channel, _) if *channel == wanted));
        let layout = Self { order_is_rudder: !has(Channel::Rudder), names, meanings };
        layout
            .check(line, sidecar.is_some_and(|sidecar| sidecar.time_step.is_some()))
            .map_err(|p| ReadError::table(table, p))?;
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
        self.meanings.iter().position(|meaning| matches!(meaning, Meaning::Time(_)))
    }

    fn check(&self, line: usize, time_is_rebuilt: bool) -> Result<(), Problem> {
        for (later, meaning) in self.meanings.iter().enumerate() {
            let (earlier, quantity) = match meaning {
                Meaning::Time(_) => (self.time(), "time"),
                Meaning::Channel(channel, _) => (self.place(*channel), channel.quantity()),
                Meaning::Unknown | Meaning::Ignored => continue,
            };
            if let Some(earlier) = earlier.filter(|&earlier| earlier != later) {
                let (first, second) = (self.names[earlier].clone(), self.names[later].clone());
                return Err(Problem::Duplicate { line, quantity, first, second });
            }
        }
        if self.rudder().is_none() {
            let accepted = [Channel::Rudder, Channel::RudderOrder];
            return Err(Problem::no_column(line, &accepted, "rudder angle", &self.names));
        }
        if self.place(Channel::Heading).is_none() && self.place(Channel::YawRate).is_none() {
            let accepted = [Channel::Heading, Channel::YawRate];
            return Err(Problem::no_column(line, &accepted, "heading or the yaw rate", &self.names));
        }
        if self.time().is_none() && !time_is_rebuilt {
            let accepted = "t_s (or t_ms or t_min, or `time-step-s` in a sidecar)".to_owned();
            return Err(Problem::NoColumn { line, wanted: "time", accepted, found: self.names.clone() });
        }
        Ok(())
    }
}

fn meaning(quantity: Option<Quantity>, flip: bool) -> Meaning {
    let sign = if flip { -1.0 } else { 1.0 };
    match quantity {
        Some(Quantity::Time(unit)) => Meaning::Time(sign * unit.to_si()),
        Some(Quantity::Channel(channel, unit)) => Meaning::Channel(channel, sign * unit.to_si()),
        None => Meaning::Unknown,
    }
}

/// Lets the sidecar speak: its words replace the meaning of the names.
fn describe(names: &[String], meanings: &mut [Meaning], table: &Path, sidecar: &Sidecar) -> Result<(), ReadError> {
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
        let own = if sidecar.header { Quantity::of(&names[place]) } else { None };
        let quantity = described.quantity.or(own);
        if described.ignore {
            meanings[place] = Meaning::Ignored;
        } else if quantity.is_none() {
            return fault(SidecarProblem::NameSaysNothing { name: names[place].clone() });
        } else {
            meanings[place] = meaning(quantity, described.flip);
        }
    }
    Ok(())
}
