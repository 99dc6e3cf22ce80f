//! Reader of a table, from its first line to its columns: after the last row come the instants of shared stamps, the
//! columns by channel, errors of missing values, and the warnings.

use std::collections::BTreeMap;
use std::path::Path;

use document::{Warning, WarningCode};

use super::counts;
use super::error::{ReadError, ReadProblem};
use super::head;
use super::input::Text;
use super::instants::spread_shared_stamps;
use super::layout::{ColumnContent, Layout, RawColumn};
use super::limits::no_rows_problem;
use super::lines::Lines;
use super::position::plane_positions;
use super::rows::Rows;
use super::rudder;
use super::source::InstrumentLog;
use super::units::{self, UnitlessColumn};
use crate::cells::Separator;
use crate::channel::Channel;
use crate::cleaning;
use crate::clock::StampConverter;
use crate::encoding::Encoding;
use crate::record::Columns;
use crate::sidecar::Sidecar;
use crate::wording::{counted, listed, rounded_to_thousandth, shortened};

/// Log of a table; a `whole` record requires rudder and heading.
///
/// Fails for a table without a header, rows or a required column, and for invalid cells, times and units.
pub(super) fn read(
    path: &Path,
    input: Text,
    size: Option<u64>,
    sidecar: &Sidecar,
    whole: bool,
) -> Result<InstrumentLog, ReadError> {
    let fault = |problem| ReadError::table(path, problem);
    // A generated text has tabs between its cells and is UTF-8, independently of a sidecar.
    let (separator, encoding) = match input.is_generated {
        true => (Some(Separator::Tab), Encoding::Utf8),
        false => (sidecar.table.separator, sidecar.table.encoding),
    };
    let mut lines = Lines::new(input.bytes, encoding);
    let head = head::find(&mut lines, separator, sidecar).map_err(fault)?;
    let layout = Layout::new(&head, path, sidecar, whole)?;
    let mut rows = Rows::new(layout, head.separator, sidecar);
    for (number, text) in head.rows {
        rows.add(&text, number).map_err(fault)?;
    }
    loop {
        // The number is taken before the line is read, because the line borrows the source.
        let (number, consumed) = (lines.line_number() + 1, lines.consumed_bytes());
        let Some(text) = lines.next_line().map_err(fault)? else { break };
        rows.add(text, number).map_err(fault)?;
        rows.check_length(consumed, size).map_err(fault)?;
    }
    let mut log = rows.finish(head.skipped).map_err(fault)?;
    log.sha256 = lines.sha256();
    if sidecar.is_checked() {
        log.warnings.extend(rudder::repeat_held_rudder(&mut log.columns));
        log.warnings.extend(cleaning::clean(&mut log.columns, &mut log.rejected));
    }
    Ok(log)
}

impl Rows<'_> {
    /// Log with the columns of all rows kept; `skipped` lines were before the names.
    fn finish(mut self, skipped: usize) -> Result<InstrumentLog, ReadProblem> {
        let line = self.layout.line;
        if self.counts.rows == 0 {
            return Err(no_rows_problem(line));
        }
        self.check_values()?;
        let mut warnings = self.warnings();
        if self.stamps.is_some() {
            warnings.extend(self.spread_stamps());
        }
        if self.sidecar.is_checked() {
            self.check_numbers()?;
            warnings.extend(counts::apply_side_column(&mut self.layout.columns));
        }
        let Layout { columns, recognised, .. } = self.layout;
        let open_time = self.time_place.map(|place| &columns[place]).filter(|column| column.is_unitless);
        let open_time = open_time.map(|column| column.name.clone());
        let (mut channels, mut unknown, mut open, mut names) = (BTreeMap::new(), Vec::new(), Vec::new(), Vec::new());
        let [mut latitude, mut longitude] = [None, None];
        for column in columns.into_iter().filter(|column| column.content.is_kept()) {
            let RawColumn { name, content, values, largest, .. } = column;
            let missing = values.iter().all(|value| value.is_nan());
            match content {
                // A channel without values counts as absent.
                ColumnContent::Channel(..) if missing => {
                    let text = format!("the column `{}` has no value and is left out", shortened(&name));
                    warnings.push(WarningCode::LeftOut.warning(text));
                }
                ColumnContent::Channel(channel, _) => {
                    channels.insert(channel, values);
                    names.push((channel, name.clone()));
                    open.extend(column.is_unitless.then_some(UnitlessColumn { channel, name, largest }));
                }
                ColumnContent::Latitude => latitude = Some(values),
                ColumnContent::Longitude => longitude = Some(values),
                _ if missing && column.text > 0 => {}
                _ => unknown.push((name, values)),
            }
        }
        let positions =
            latitude.zip(longitude).and_then(|(latitude, longitude)| plane_positions(&latitude, &longitude));
        for (channel, values) in positions.into_iter().flatten() {
            channels.entry(channel).or_insert(values);
        }
        let clock = self.stamps.as_ref().and_then(StampConverter::clock);
        let columns = Columns { time: self.time, channels, unknown_columns: unknown };
        let mut log = InstrumentLog { columns, clock, rows: self.counts.rows, names, ..InstrumentLog::default() };
        let decided = units::infer_units(&mut log, open, open_time, line)?;
        if skipped > 0 {
            let text = format!("{} before the header skipped", counted(skipped, "line"));
            log.warnings.push(WarningCode::Notation.warning(text));
        }
        if !recognised.is_empty() {
            let text = format!("columns recognised by their names: {}", listed(&recognised));
            log.warnings.push(WarningCode::Columns.warning(text));
        }
        log.warnings.extend(decided.into_iter().chain(warnings));
        Ok(log)
    }

    /// Refuses numbers that cannot be angles or times in the unit of their column.
    fn check_numbers(&self) -> Result<(), ReadProblem> {
        let Layout { columns, line, .. } = &self.layout;
        let time = self.time_place.map(|place| &columns[place]);
        if let Some(time) = time.filter(|time| !time.is_unitless && time.content == ColumnContent::Time(1.0)) {
            counts::check_time(&time.name, self.time.first().copied().unwrap_or_default(), *line)?;
        }
        counts::check_angles(columns, *line)
    }

    /// Spreads rows that share a stamp, and thins the rows; with a warning of shared stamps.
    fn spread_stamps(&mut self) -> Option<Warning> {
        let usual = if self.whole_seconds { spread_shared_stamps(&mut self.time) } else { None };
        let thin = |values: &mut Vec<f64>| {
            *values = std::mem::take(values).into_iter().step_by(self.every).collect();
        };
        thin(&mut self.time);
        self.layout.columns.iter_mut().for_each(|column| thin(&mut column.values));
        usual.map(|usual| {
            WarningCode::SharedStamps.warning(format!(
                "rows share their time stamps, usually {usual} per stamp; they are spread evenly up to the next stamp"
            ))
        })
    }

    /// Refuses a part without rows, and required columns without a value.
    fn check_values(&self) -> Result<(), ReadProblem> {
        let (counts, layout) = (&self.counts, &self.layout);
        let all_missing = |place: usize, quantity| {
            Err(ReadProblem::AllMissing { column: layout.columns[place].name.clone(), quantity })
        };
        if let Some(place) = self.time_place.filter(|_| counts.rows_without_time == counts.rows) {
            return all_missing(place, "time");
        }
        if self.usable_rows == 0 && counts.empty_rows == 0 {
            let (&from_s, &until_s) = (self.part.start(), self.part.end());
            let (first_s, last_s) = self.span.expect("some row has a time, or all_missing had returned");
            return Err(ReadProblem::EmptyPart { from_s, until_s, first_s, last_s });
        }
        let is_empty = |place: &usize| layout.columns[*place].values.iter().all(|value| value.is_nan());
        if let Some(place) = layout.rudder_column().filter(is_empty) {
            return all_missing(place, Channel::Rudder.label());
        }
        let [heading, rate] = [Channel::Heading, Channel::YawRate].map(|channel| layout.column_of(channel));
        match (heading, rate) {
            (_, Some(rate)) if !is_empty(&rate) => Ok(()),
            (Some(heading), _) if is_empty(&heading) => all_missing(heading, Channel::Heading.label()),
            (None, Some(rate)) => all_missing(rate, Channel::YawRate.label()),
            _ => Ok(()),
        }
    }

    fn warnings(&mut self) -> Vec<Warning> {
        let counts = &self.counts;
        let mut warnings = std::mem::take(&mut self.layout.warnings);
        let mut count = |number: usize, code: WarningCode, text: &str| {
            warnings.extend((number > 0).then(|| code.warning(format!("{} {text}", counted(number, "row")))));
        };
        count(counts.rows_without_time, WarningCode::LeftOut, "without time left out");
        count(counts.empty_rows, WarningCode::LeftOut, "with neither rudder nor heading nor yaw rate left out");
        count(counts.repeated_rows, WarningCode::LeftOut, "left out as exact copies of the row before");
        let short = "with fewer cells than the header; their last columns are taken as missing";
        count(counts.short_rows, WarningCode::MissingValues, short);
        let first = rounded_to_thousandth(counts.stray_times.first().copied().unwrap_or_default());
        let astray = format!("left out, because the time does not fit its neighbours; the first is at {first} s");
        count(counts.stray_times.len(), WarningCode::LeftOut, &astray);
        if counts.decimal_commas > 0 {
            let text = format!("{} read with a decimal comma", counted(counts.decimal_commas, "number"));
            warnings.push(WarningCode::Notation.warning(text));
        }
        let columns = || self.layout.columns.iter().map(|column| (shortened(&column.name), column));
        for (name, RawColumn { text, .. }) in columns().filter(|(_, column)| column.text > 0) {
            let text = format!("the column `{name}` holds text in {}, taken as missing", counted(*text, "row"));
            warnings.push(WarningCode::MissingValues.warning(text));
        }
        for (name, RawColumn { sentinels: (count, value), .. }) in
            columns().filter(|(_, column)| column.sentinels.0 > 0)
        {
            let times = if *count == 1 { String::from("once") } else { format!("{count} times") };
            let text = format!("the column `{name}` holds {value} {times}, taken as missing");
            warnings.push(WarningCode::MissingValues.warning(text));
        }
        warnings
    }
}
