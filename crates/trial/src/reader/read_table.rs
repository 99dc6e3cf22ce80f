//! What becomes of the rows of a table when the last one is read: instants of shared stamps, columns by channel,
//! complaints about what is missing, and the list of what was decided.

use std::collections::BTreeMap;

use super::error::Problem;
use super::instants::spread;
use super::layout::Meaning;
use super::limits::no_rows;
use super::limits::spoken;
use super::rows::{Met, Rows};
use crate::channel::Channel;
use crate::clock::{Clock, Stamps};
use crate::record::Columns;
use crate::words::{counted, shortened};

/// A channel whose unit its values have to show.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct UnitlessColumn {
    pub channel: Channel,
    /// Name of its column.
    pub name: String,
    /// Its largest number, without its sign.
    pub largest: f64,
}

/// The columns of a table.
#[derive(Debug)]
pub(super) struct ReadTable {
    pub columns: Columns,
    /// Rows of the file.
    pub rows: usize,
    /// What the clock shows at time 0, where the table has stamps.
    pub clock: Option<Clock>,
    pub open: Vec<UnitlessColumn>,
    /// Name of the column of time where its unit is open.
    pub open_time: Option<String>,
    /// Latitude and longitude, deg.
    pub position: Option<[Vec<f64>; 2]>,
}

impl Rows<'_> {
    /// The columns of all rows kept, with warnings.
    pub fn finish(mut self) -> Result<(ReadTable, Vec<String>), Problem> {
        let layout = self.layout;
        if self.counts.rows == 0 {
            return Err(no_rows(layout.line));
        }
        self.check_values()?;
        let mut warnings = self.warnings();
        let mut columns = std::mem::take(&mut self.columns);
        if self.stamps.is_some() {
            if self.whole_seconds
                && let Some(usual) = spread(&mut self.time)
            {
                warnings.push(format!(
                    "rows share their stamps, {usual} as a rule; they are spread evenly over the time to the next stamp"
                ));
            }
            self.time = std::mem::take(&mut self.time).into_iter().step_by(self.every).collect();
            for values in &mut columns {
                *values = std::mem::take(values).into_iter().step_by(self.every).collect();
            }
        }
        let mut channels = BTreeMap::new();
        let mut unknown = Vec::new();
        let mut open = Vec::new();
        let [mut latitude, mut longitude] = [None, None];
        for (values, &place) in columns.into_iter().zip(&self.used) {
            let missing = values.iter().all(|value| value.is_nan());
            let name = &layout.names[place];
            match layout.meanings[place] {
                // A channel nobody needs and nobody recorded is as good as absent.
                Meaning::Channel(..) if missing => {
                    warnings.push(format!("the column `{}` has no value and is left out", shortened(name)));
                }
                Meaning::Channel(channel, _) => {
                    if layout.open[place] {
                        open.push(UnitlessColumn { channel, name: name.clone(), largest: self.met[place].largest });
                    }
                    channels.insert(channel, values);
                }
                Meaning::Latitude => latitude = Some(values),
                Meaning::Longitude => longitude = Some(values),
                _ if missing && self.met[place].text > 0 => {}
                _ => unknown.push((name.clone(), values)),
            }
        }
        let open_time = self.time_place.filter(|&place| layout.open[place]).map(|place| layout.names[place].clone());
        let kept = ReadTable {
            columns: Columns { time: self.time, channels, unknown },
            rows: self.counts.rows,
            clock: self.stamps.as_ref().and_then(Stamps::clock),
            open,
            open_time,
            position: latitude.zip(longitude).map(|(latitude, longitude)| [latitude, longitude]),
        };
        Ok((kept, warnings))
    }

    /// Refuses a part without rows, and needed columns without a value.
    fn check_values(&self) -> Result<(), Problem> {
        let counts = &self.counts;
        let layout = self.layout;
        let all_missing =
            |place: usize, quantity| Err(Problem::AllMissing { column: layout.names[place].clone(), quantity });
        if let Some(place) = self.time_place.filter(|_| counts.no_time == counts.rows) {
            return all_missing(place, "time");
        }
        if self.usable == 0 && counts.nothing == 0 {
            let (from_s, until_s) = self.part;
            let (first_s, last_s) = self.span.expect("some row has a time, or all_missing had returned");
            return Err(Problem::EmptyPart { from_s, until_s, first_s, last_s });
        }
        let empty = |place: usize| {
            let column = self.used.iter().position(|&used| used == place)?;
            self.columns[column].iter().all(|value| value.is_nan()).then_some(place)
        };
        let empty_channel = |channel| layout.place(channel).and_then(empty);
        if let Some(place) = layout.rudder().and_then(empty) {
            return all_missing(place, spoken(Channel::Rudder));
        }
        let has_rate = layout.place(Channel::YawRate).is_some() && empty_channel(Channel::YawRate).is_none();
        if has_rate {
            return Ok(());
        }
        let heading = empty_channel(Channel::Heading).map(|place| (place, Channel::Heading));
        let rate = empty_channel(Channel::YawRate).filter(|_| layout.place(Channel::Heading).is_none());
        match heading.or(rate.map(|place| (place, Channel::YawRate))) {
            Some((place, channel)) => all_missing(place, spoken(channel)),
            None => Ok(()),
        }
    }

    fn warnings(&self) -> Vec<String> {
        let counts = &self.counts;
        let mut warnings = self.layout.told.clone();
        let mut count = |number: usize, text: &str| {
            if number > 0 {
                warnings.push(format!("{} {text}", counted(number, "row")));
            }
        };
        count(counts.no_time, "without time left out");
        count(counts.nothing, "with neither rudder nor heading nor yaw rate left out");
        count(counts.repeated, "left out as exact copies of the row before");
        count(counts.short, "with fewer cells than the header; the last columns were taken as missing there");
        count(
            counts.astray.len(),
            &format!(
                "left out because the time does not fit the rows around, the first has {} s",
                counts.astray.first().copied().unwrap_or_default()
            ),
        );
        if counts.decimal_commas > 0 {
            warnings.push(format!("{} numbers were read with a decimal comma", counts.decimal_commas));
        }
        let columns = || self.layout.names.iter().map(|name| shortened(name)).zip(&self.met);
        for (name, Met { text, .. }) in columns().filter(|(_, met)| met.text > 0) {
            warnings.push(format!("the column `{name}` holds text in {text} rows, taken as missing"));
        }
        for (name, Met { sentinels: (count, value), .. }) in columns().filter(|(_, met)| met.sentinels.0 > 0) {
            let times = if *count == 1 { String::from("once") } else { format!("{count} times") };
            warnings.push(format!("the column `{name}` holds {value} {times}, taken as missing"));
        }
        warnings
    }
}
