//! Long tables: a row contains a single quantity by its path, such as `steering.rudderAngle` of Signal K, or by a
//! column name.

use super::message::{Message, RankedReading};
use crate::cells::{Separator, detect_separator, parse_cell};
use crate::channel::Channel;
use crate::names::{ColumnMeaning, column_meaning};

/// Names of the four columns, in small letters.
const COLUMNS: [&[&str]; 4] = [
    &["time", "timestamp", "datetime", "date"],
    &["path", "key", "quantity"],
    &["value"],
    &["source", "$source", "src"],
];

/// Paths of Signal K, whose values are in SI units.
const PATHS: [(&str, Channel, u8); 6] = [
    ("steering.rudderangle", Channel::Rudder, 0),
    ("navigation.headingtrue", Channel::Heading, 0),
    ("navigation.headingmagnetic", Channel::Heading, 1),
    ("navigation.rateofturn", Channel::YawRate, 0),
    ("navigation.speedthroughwater", Channel::Speed, 0),
    ("navigation.speedoverground", Channel::Speed, 1),
];

/// Separator of a long table, and the indices of its columns.
#[derive(Debug, Clone)]
pub(super) struct LongTable {
    separator: Separator,
    time: usize,
    path: usize,
    value: usize,
    /// `None` for a table without a column of sources.
    source: Option<usize>,
}

impl LongTable {
    /// Table with this header; `None` for a table of another kind.
    pub fn from_header(header: &str) -> Option<Self> {
        let is_name = |cell: &str, column: usize| COLUMNS[column].contains(&cell.to_lowercase().as_str());
        let count_names = |cells: &[&str]| cells.iter().filter(|cell| (0..4).any(|k| is_name(cell, k))).count();
        let separator = detect_separator(header, count_names);
        let mut ranges = Vec::new();
        separator.split(header, &mut ranges);
        let index = |column: usize| ranges.iter().position(|range| is_name(&header[range.clone()], column));
        Some(Self { separator, time: index(0)?, path: index(1)?, value: index(2)?, source: index(3) })
    }

    /// Message of a row; `None` for a row without a used quantity.
    pub fn message<'a>(&self, row: &'a str) -> Option<Message<'a>> {
        let mut ranges = Vec::new();
        self.separator.split(row, &mut ranges);
        let text = |index: usize| ranges.get(index).map_or("", |range| &row[range.clone()]);
        let value = parse_cell(text(self.value), self.separator).number()?;
        let readings = vec![reading(text(self.path), value)?];
        let source = self.source.map_or("the table", text);
        Some(Message { stamp: text(self.time), source: source.to_owned(), readings })
    }
}

/// Reading of a path of Signal K, or of a column name with its unit.
fn reading(path: &str, value: f64) -> Option<RankedReading> {
    let small = path.to_lowercase();
    let signal_k =
        PATHS.iter().find(|(suffix, ..)| small.ends_with(suffix)).map(|(_, channel, class)| (*channel, *class, value));
    signal_k.or_else(|| match column_meaning(path)? {
        ColumnMeaning::Channel(channel, Some(unit)) => Some((channel, 0, value * unit.si_factor())),
        ColumnMeaning::SpeedOverGround(Some(unit)) => Some((Channel::Speed, 1, value * unit.si_factor())),
        _ => None,
    })
}
