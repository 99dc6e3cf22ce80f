//! Messages of NMEA 2000 in the notation of canboat: JSON lines of its `analyzer`, and the plain lines of its input,
//! with bytes in hexadecimal.
//!
//! Source of the fields: canboat, list of parameter groups (`pgn.h`).

use serde_json::Value;

use super::message::{Message, RankedReading};
use crate::channel::Channel;

/// Parameter group number of the rudder.
const RUDDER: u64 = 127_245;
/// Parameter group number of the heading.
const HEADING: u64 = 127_250;
/// Parameter group number of the rate of turn.
const RATE_OF_TURN: u64 = 127_251;
/// Parameter group number of the speed through the water.
const SPEED: u64 = 128_259;
/// Parameter group number of course and speed over ground.
const COURSE_AND_SPEED: u64 = 129_026;

/// `true` for a message, in JSON or plain.
pub(super) fn is_message(line: &str) -> bool {
    let line = line.trim();
    (line.starts_with('{') && line.contains("\"pgn\"")) || plain(line).is_some()
}

/// Reader of canboat lines with the units stated so far.
#[derive(Debug, Default)]
pub(super) struct Canboat {
    /// `true` for angles in radians; `None` until a line states the units.
    pub is_si: Option<bool>,
}

impl Canboat {
    /// Message of a line; `None` for a line without a used quantity.
    pub fn message<'a>(&mut self, line: &'a str) -> Option<Message<'a>> {
        if let Some((stamp, pgn, source, bytes)) = plain(line.trim()) {
            self.is_si = Some(true);
            let instance = u64::from(bytes[0]);
            return with_readings(stamp, source_name(pgn, source, instance), readings_of_bytes(pgn, &bytes));
        }
        let value: Value = serde_json::from_str(line).ok()?;
        if let Some(units) = value["units"].as_str() {
            self.is_si = Some(units == "si");
        }
        // The stamp is borrowed from the line, which outlives the parsed value.
        let stamp =
            value["timestamp"].as_str().and_then(|stamp| line.find(stamp).map(|at| &line[at..at + stamp.len()]))?;
        let (pgn, fields) = (value["pgn"].as_u64()?, &value["fields"]);
        let source = source_name(pgn, value["src"].as_u64()?, number(fields, "Instance").unwrap_or(0.0) as u64);
        with_readings(stamp, source, readings_of_fields(pgn, fields))
    }
}

fn with_readings(stamp: &str, source: String, readings: Vec<RankedReading>) -> Option<Message<'_>> {
    (!readings.is_empty()).then_some(Message { stamp, source, readings })
}

/// Name of a source in messages; a device may send several rudders.
fn source_name(pgn: u64, source: u64, instance: u64) -> String {
    let rudder = if pgn == RUDDER && instance > 0 { format!(", rudder {instance}") } else { String::new() };
    format!("the device at address {source}{rudder}")
}

/// Number in a field of a message; the option -nv of canboat puts it into an object with its name. `None` for a field
/// without a number.
fn number(fields: &Value, name: &str) -> Option<f64> {
    fields[name].as_f64().or_else(|| fields[name]["value"].as_f64())
}

/// Readings in the fields of a message, with angles in degrees or radians as in the log.
fn readings_of_fields(pgn: u64, fields: &Value) -> Vec<RankedReading> {
    let number = |name: &str| number(fields, name);
    let is_true =
        [&fields["Reference"], &fields["Reference"]["name"]].iter().any(|reference| reference.as_str() == Some("True"));
    let readings = match pgn {
        RUDDER => vec![(Channel::Rudder, 0, number("Position")), (Channel::RudderOrder, 0, number("Angle Order"))],
        HEADING => vec![(Channel::Heading, u8::from(!is_true), number("Heading"))],
        RATE_OF_TURN => vec![(Channel::YawRate, 0, number("Rate"))],
        SPEED => vec![(Channel::Speed, 0, number("Speed Water Referenced"))],
        COURSE_AND_SPEED => vec![(Channel::Speed, 1, number("SOG"))],
        _ => Vec::new(),
    };
    readings.into_iter().filter_map(|(channel, class, value)| Some((channel, class, value?))).collect()
}

/// Stamp, parameter group, source and bytes of a plain line: `2026-05-04T09:00:00.000Z,2,127250,3,255,8,ff,…`; `None`
/// for any other line.
fn plain(line: &str) -> Option<(&str, u64, u64, Vec<u8>)> {
    let cells: Vec<&str> = line.split(',').map(str::trim).collect();
    let [stamp, _, pgn, source, _, length, bytes @ ..] = &cells[..] else { return None };
    let bytes: Option<Vec<u8>> = bytes.iter().map(|byte| u8::from_str_radix(byte, 16).ok()).collect();
    let bytes = bytes.filter(|bytes| length.parse().ok() == Some(bytes.len()) && !bytes.is_empty())?;
    let pgn = pgn.parse().ok().filter(|pgn| (59_392..=131_071).contains(pgn))?;
    stamp.contains(':').then_some((*stamp, pgn, source.parse().ok()?, bytes))
}

/// Readings in the bytes of a message, in SI units and radians; the two highest numbers of a field mean "no reading".
fn readings_of_bytes(pgn: u64, bytes: &[u8]) -> Vec<RankedReading> {
    let raw = |from: usize, length: usize| {
        let field = bytes.get(from..from + length)?;
        Some(field.iter().rev().fold(0_u64, |value, byte| value << 8 | u64::from(*byte)))
    };
    let unsigned = |from: usize| raw(from, 2).filter(|value| *value < 0xfffe).map(|value| value as f64);
    let angle = |from: usize| raw(from, 2).map(|value| value as u16 as i16).filter(|value| *value < 0x7ffe);
    let angle = |from: usize| angle(from).map(|value| 1e-4 * f64::from(value));
    let readings = match pgn {
        RUDDER => vec![(Channel::Rudder, 0, angle(4)), (Channel::RudderOrder, 0, angle(2))],
        HEADING => {
            let is_true = bytes.get(7).is_some_and(|reference| reference & 3 == 0);
            vec![(Channel::Heading, u8::from(!is_true), unsigned(1).map(|value| 1e-4 * value))]
        }
        RATE_OF_TURN => {
            let rate = raw(1, 4).map(|value| value as u32 as i32).filter(|value| *value < 0x7fff_fffe);
            vec![(Channel::YawRate, 0, rate.map(|value| 3.125e-8 * f64::from(value)))]
        }
        SPEED => vec![(Channel::Speed, 0, unsigned(1).map(|value| 0.01 * value))],
        COURSE_AND_SPEED => vec![(Channel::Speed, 1, unsigned(4).map(|value| 0.01 * value))],
        _ => Vec::new(),
    };
    readings.into_iter().filter_map(|(channel, class, value)| Some((channel, class, value?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bytes and fields of the same messages give the same readings.
    #[test]
    fn bytes_and_fields_say_the_same() {
        let mut canboat = Canboat::default();
        let mut read = |line: &str| canboat.message(line).map(|message| message.readings).unwrap_or_default();
        let head = "2026-05-04T09:00:00.000Z,2,";
        // 20° of rudder are 3491 parts of 0.1 mrad; 0x7fff means no order.
        assert_eq!(read(&format!("{head}127245,9,255,8,00,ff,ff,7f,a3,0d,ff,ff")), [(Channel::Rudder, 0, 0.3491)]);
        assert_eq!(read(&format!("{head}127250,3,255,8,ff,10,27,ff,7f,ff,7f,fd")), [(Channel::Heading, 1, 1.0)]);
        let rate = read(&format!("{head}127251,3,255,8,ff,00,ca,9a,3b,ff,ff,ff"))[0];
        assert!(rate.0 == Channel::YawRate && (rate.2 - 31.25).abs() < 1e-9);
        let json = |pgn: u64, fields: &str| {
            format!(
                r#"{{"timestamp":"2026-05-04T09:00:00.000Z","prio":2,"src":9,"dst":255,"pgn":{pgn},"fields":{{{fields}}}}}"#
            )
        };
        assert_eq!(read(&json(RUDDER, r#""Instance":0,"Position":-3.5"#)), [(Channel::Rudder, 0, -3.5)]);
        assert_eq!(read(&json(HEADING, r#""Heading":12.5,"Reference":"True""#)), [(Channel::Heading, 0, 12.5)]);
        assert_eq!(read(&json(COURSE_AND_SPEED, r#""COG":12.5,"SOG":4.5"#)), [(Channel::Speed, 1, 4.5)]);
        assert_eq!(read(&json(60_928, "")), []);
        assert!(is_message(&json(HEADING, "")) && !is_message("2026-05-04 09:00:00,2,10.5,3,4,5,6.5"));
    }
}
