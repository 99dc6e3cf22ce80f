//! Logs of messages, each with its stamp, its source and one or a few quantities: NMEA 2000 in the notation of canboat
//! (JSON lines, or plain lines of hexadecimal bytes), and long tables of time, path, value and source as exported by
//! Signal K. Every channel comes from a single source, which a warning names.

mod can;
mod canboat;
mod message;
mod table;

use std::collections::BTreeMap;
use std::io::Read;

use document::{Warning, WarningCode};
use ship::angle::DEGREE;

use super::error::ReadProblem;
use super::limits::MAX_CELLS;
use super::lines::Lines;
use super::source::{InstrumentLog, Series};
use crate::channel::Channel;
use crate::clock::{Clock, SECONDS_PER_DAY, StampConverter, StampFault, TimeStamp};
use crate::wording::{counted, shortened};
use canboat::Canboat;
use message::Message;
use table::LongTable;

/// Maximum number of readings of a sparse source, as a share of the readings of the busiest source.
const SPARSE_SHARE: f64 = 0.2;

/// Maximum rudder angle and maximum heading of a log in radians if no line states the unit, rad.
const MAX_RAD: [f64; 2] = [0.8, std::f64::consts::TAU + 0.01];

pub(super) use can::{is_log as is_can_log, is_python_can};

/// Format of the lines of a log of messages.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum MessageFormat {
    /// NMEA 2000 messages in the notation of canboat.
    Canboat,
    /// Table of time, path, value and source with a single value per line, as exported by Signal K.
    Long,
}

/// Format of a log of messages, from its first lines; `None` for other files.
pub(super) fn format<'a>(lines: impl Iterator<Item = &'a str> + Clone) -> Option<MessageFormat> {
    if lines.clone().any(canboat::is_message) {
        return Some(MessageFormat::Canboat);
    }
    lines.map(str::trim).find(|line| !line.is_empty()).and_then(LongTable::from_header).map(|_| MessageFormat::Long)
}

/// Channel of a source; a lower `class` is a better quantity for the channel.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct MessageSource {
    channel: Channel,
    class: u8,
    name: String,
}

/// Readings so far, by source.
#[derive(Default)]
struct MessageLog {
    stamps: StampConverter,
    sources: BTreeMap<MessageSource, Series>,
    messages: usize,
    readings: usize,
    unread: usize,
}

impl MessageLog {
    fn take(&mut self, message: &Message, line: usize) -> Result<(), ReadProblem> {
        let text = message.stamp;
        // Older versions of canboat write 2011-11-24-22:42:04.388.
        let joined = text.get(10..11).filter(|mark| *mark == "-").map(|_| format!("{}T{}", &text[..10], &text[11..]));
        let stamp = TimeStamp::parse(joined.as_deref().unwrap_or(text)).filter(TimeStamp::has_time);
        let value = || shortened(text);
        let stamp = stamp.ok_or_else(|| ReadProblem::NotAStamp { line, column: "timestamp".into(), value: value() })?;
        let at = self.stamps.seconds(stamp).map_err(|fault| match fault {
            StampFault::AmbiguousDate => ReadProblem::AmbiguousDate { line, value: value() },
            StampFault::NoTime => ReadProblem::NotAStamp { line, column: "timestamp".into(), value: value() },
        })?;
        self.messages += 1;
        for &(channel, class, value) in &message.readings {
            let source = MessageSource { channel, class, name: message.source.clone() };
            let name = Some(message.source.clone());
            let empty = || Series { channel, time: Vec::new(), values: Vec::new(), source: name };
            let signal = self.sources.entry(source).or_insert_with(empty);
            if value.is_finite() && signal.time.last().is_none_or(|last| at > *last) {
                signal.time.push(at);
                signal.values.push(value);
                self.readings += 1;
            }
        }
        if self.readings > MAX_CELLS {
            return Err(ReadProblem::TooManyReadings { line, limit: MAX_CELLS });
        }
        Ok(())
    }

    /// Series of the best source of every channel, with warnings of the choice.
    fn choice(self) -> (Vec<Series>, Vec<Warning>) {
        let (mut series, mut warnings) = (Vec::new(), Vec::new());
        for channel in Channel::ALL {
            let is_offer =
                |(source, signal): &(&MessageSource, &Series)| source.channel == channel && !signal.time.is_empty();
            let mut offers: Vec<_> = self.sources.iter().filter(is_offer).collect();
            let most = offers.iter().map(|(_, signal)| signal.time.len()).max().unwrap_or(0);
            offers.sort_by_key(|(source, signal)| {
                let readings = signal.time.len();
                ((readings as f64) < SPARSE_SHARE * most as f64, source.class, usize::MAX - readings)
            });
            let Some(&(MessageSource { class, name, .. }, signal)) = offers.first() else { continue };
            let kind = match (channel, class) {
                (Channel::Heading, 1) => "magnetic heading",
                (Channel::Speed, 0) => "speed through the water",
                (Channel::Speed, _) => "speed over ground",
                (channel, _) => channel.label(),
            };
            let unused_sources: Vec<String> =
                offers[1..].iter().map(|(source, signal)| format!("{} ({})", source.name, signal.time.len())).collect();
            let unused = if unused_sources.is_empty() {
                String::new()
            } else {
                format!("; not used: {}", unused_sources.join(", "))
            };
            let text = format!("{kind} from {name} ({}){unused}", counted(signal.time.len(), "reading"));
            warnings.push(WarningCode::Instrument.warning(text));
            if (channel, *class) == (Channel::Heading, 1) {
                let text = "the heading is magnetic; changes of heading are correct, its zero is not true north";
                warnings.push(WarningCode::OtherReference.warning(text));
            }
            series.push(signal.clone());
        }
        (series, warnings)
    }
}

/// Reads a log: a series for each channel, and an [`InstrumentLog`] without columns.
///
/// Fails for an invalid stamp, for too many readings, and if no message contains a used quantity.
pub(super) fn read<R: Read>(
    mut lines: Lines<R>,
    format: &MessageFormat,
) -> Result<(Vec<Series>, InstrumentLog), ReadProblem> {
    let mut log = MessageLog::default();
    let (mut canboat, mut table) = (Canboat::default(), None);
    while let Some(text) = lines.next_line()?.map(str::to_owned) {
        let number = lines.line_number();
        if text.trim().is_empty() {
            continue;
        }
        let message = match (format, &mut table) {
            (MessageFormat::Canboat, _) => canboat.message(&text),
            (MessageFormat::Long, Some(table)) => LongTable::message(table, &text),
            (MessageFormat::Long, table) => {
                *table = LongTable::from_header(&text);
                continue;
            }
        };
        match message {
            Some(message) => log.take(&message, number)?,
            None => log.unread += 1,
        }
    }
    let (rows, unread, messages) = (lines.line_number(), log.unread, log.messages);
    let clock = log.stamps.clock();
    let (mut series, mut warnings) = log.choice();
    if series.is_empty() {
        return Err(ReadProblem::NoReadings { sentences: messages });
    }
    if *format == MessageFormat::Canboat {
        warnings.extend(in_radians(&mut series, canboat.is_si));
    }
    if unread > 0 {
        let text = format!("{} of {} hold no quantity that is used", counted(unread, "line"), counted(rows, "line"));
        warnings.push(WarningCode::LeftOut.warning(text));
    }
    let clock = begin_at_zero(&mut series, clock);
    Ok((series, InstrumentLog { clock, warnings, rows, sha256: lines.sha256(), ..InstrumentLog::default() }))
}

/// Converts angles to radians: canboat writes degrees, or radians with an option. If no line states the unit (`is_si`
/// is `None`), the maximum rudder and heading determine it; this decision is returned as a warning.
fn in_radians(series: &mut [Series], is_si: Option<bool>) -> Option<Warning> {
    let largest = |channel: Channel| {
        let signal = series.iter().find(|signal| signal.channel == channel);
        signal.map_or(0.0, |signal| signal.values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs())))
    };
    let seems_si = largest(Channel::Rudder) <= MAX_RAD[0] && largest(Channel::Heading) <= MAX_RAD[1];
    if !is_si.unwrap_or(seems_si) {
        let is_angle = |signal: &&mut Series| signal.channel.is_angle();
        series.iter_mut().filter(is_angle).flat_map(|signal| &mut signal.values).for_each(|value| *value *= DEGREE);
    }
    let unit = if seems_si { "radians" } else { "degrees" };
    is_si.is_none().then(|| {
        WarningCode::AssumedUnit.warning(format!("angles are read as {unit}, the only unit that fits their values"))
    })
}

/// Shifts times so that the first instant is 0, and returns the clock at that instant.
fn begin_at_zero(series: &mut [Series], clock: Option<Clock>) -> Option<Clock> {
    let first = series.iter().filter_map(|signal| signal.time.first()).copied().fold(f64::INFINITY, f64::min);
    let rounded = |time: f64| (time * 1e6).round() / 1e6;
    series.iter_mut().flat_map(|signal| &mut signal.time).for_each(|time| *time = rounded(*time - first));
    let clock = clock?;
    let second = clock.second + first;
    let days = (second / SECONDS_PER_DAY).floor();
    Some(Clock { day: clock.day.map(|day| day + days as i64), second: second - days * SECONDS_PER_DAY, ..clock })
}
