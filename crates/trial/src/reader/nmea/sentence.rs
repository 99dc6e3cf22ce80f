//! What each sentence says, field by field (NMEA 0183 version 4.11, IEC 61162-1), in SI units and radians. It looks at
//! one sentence at a time; which of them is used is decided in [`super::choice`].

use std::f64::consts::TAU;

use ship::angle::{DEGREE, KNOT};

use super::frame::{Fields, Number};
use crate::clock::days;

/// A sentence that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Hdt,
    Ths,
    Hdg,
    Hdm,
    Rot,
    Rsa,
    Htc,
    Vhw,
    Vbw,
    Vtg,
    Rmc,
    Gga,
    Gll,
    Zda,
    Rpm,
    Mwv,
    Mwd,
    Xdr,
}

/// A quantity in a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Slot {
    /// rad, [0, 2π).
    HeadingTrue,
    /// rad, [0, 2π).
    HeadingMagnetic,
    /// rad, positive to the east.
    Variation,
    /// rad/s, positive to starboard.
    YawRate,
    /// Starboard or single rudder, rad, positive turns to starboard.
    RudderStarboard,
    /// rad, positive turns to starboard.
    RudderPort,
    /// rad, positive turns to starboard.
    RudderOrder,
    /// Of an angle transducer, rad.
    Transducer,
    /// m/s.
    SpeedWater,
    /// m/s.
    SpeedGround,
    /// m/s.
    SurgeWater,
    /// m/s, to starboard.
    SwayWater,
    /// m/s.
    SurgeGround,
    /// m/s, to starboard.
    SwayGround,
    /// rad, north positive.
    Latitude,
    /// rad, east positive.
    Longitude,
    /// Second of the day, UTC.
    Second,
    /// Days since 1970-01-01.
    Day,
    /// 1/s.
    Revolutions,
    /// m/s.
    WindSpeed,
    /// rad, from the bow or from north.
    WindFrom,
}

/// Most quantities of one sentence.
pub(super) const MOST_SLOTS: usize = 5;

/// A sentence with its formatters and quantities.
type Sentence = (Kind, &'static [&'static [u8]], &'static [Slot]);

/// The sentences that are read: formatters, and quantities in the order of [`Row::values`].
const SENTENCES: [Sentence; 18] = {
    use Slot::*;
    [
        (Kind::Hdt, &[b"HDT"], &[HeadingTrue]),
        (Kind::Ths, &[b"THS"], &[HeadingTrue]),
        (Kind::Hdg, &[b"HDG"], &[HeadingMagnetic, Variation]),
        (Kind::Hdm, &[b"HDM"], &[HeadingMagnetic]),
        (Kind::Rot, &[b"ROT"], &[YawRate]),
        (Kind::Rsa, &[b"RSA"], &[RudderStarboard, RudderPort]),
        (Kind::Htc, &[b"HTC", b"HTD"], &[RudderOrder]),
        (Kind::Vhw, &[b"VHW"], &[HeadingTrue, HeadingMagnetic, SpeedWater]),
        (Kind::Vbw, &[b"VBW"], &[SurgeWater, SwayWater, SurgeGround, SwayGround]),
        (Kind::Vtg, &[b"VTG"], &[SpeedGround]),
        (Kind::Rmc, &[b"RMC"], &[Second, Day, Latitude, Longitude, SpeedGround]),
        (Kind::Gga, &[b"GGA"], &[Second, Latitude, Longitude]),
        (Kind::Gll, &[b"GLL"], &[Second, Latitude, Longitude]),
        (Kind::Zda, &[b"ZDA"], &[Second, Day]),
        (Kind::Rpm, &[b"RPM"], &[Revolutions]),
        (Kind::Mwv, &[b"MWV"], &[WindSpeed, WindFrom]),
        (Kind::Mwd, &[b"MWD"], &[WindSpeed, WindFrom]),
        (Kind::Xdr, &[b"XDR"], &[Transducer]),
    ]
};

impl Kind {
    /// The sentence with this formatter.
    pub fn of(formatter: &[u8]) -> Option<Self> {
        SENTENCES.iter().find(|(_, formatters, _)| formatters.contains(&formatter)).map(|(kind, ..)| *kind)
    }

    /// Its quantities, in the order of [`Row::values`].
    pub fn slots(self) -> &'static [Slot] {
        SENTENCES[self as usize].2
    }
}

/// A number with its bounds, and its factor to SI units and radians.
type Bounded = (Number, (f64, f64), f64);

/// What one sentence says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Row {
    /// In the order of [`Kind::slots`]; NaN where nothing was read.
    pub values: [f64; MOST_SLOTS],
    /// Places with something that cannot be.
    pub odd: [bool; MOST_SLOTS],
    /// What tells instruments behind one sentence apart: the shaft of RPM with S or E, the reference of MWV, R for the
    /// rudder and O for roll of XDR; 0 otherwise.
    pub part: [u8; 2],
}

impl Row {
    pub fn empty() -> Self {
        Self { values: [f64::NAN; MOST_SLOTS], odd: [false; MOST_SLOTS], part: [0; 2] }
    }

    /// Takes a number within bounds, times a factor.
    fn take(&mut self, place: usize, number: Number, (least, most): (f64, f64), factor: f64) {
        match number {
            Number::Of(value) if (least..=most).contains(&value) => self.values[place] = value * factor,
            Number::Empty => {}
            Number::Of(_) | Number::Not => self.odd[place] = true,
        }
    }

    /// Takes the first of two numbers, each with its bounds and factor, or the second where there is none.
    fn take_either(&mut self, place: usize, one: Bounded, other: Bounded) {
        let (number, bounds, factor) = if one.0 == Number::Empty { other } else { one };
        self.take(place, number, bounds, factor);
    }

    /// Takes an angle of [0°, 360°].
    fn take_direction(&mut self, place: usize, number: Number) {
        self.take(place, number, (0.0, 360.0), DEGREE);
        self.values[place] = turned(self.values[place]);
    }

    /// Takes latitude and longitude from four fields; both or none.
    fn take_position(&mut self, place: usize, fields: &Fields, first: usize) {
        let mut read = |offset: usize, at: usize, limit: f64, [positive, negative]: [u8; 2]| {
            let Number::Of(value) = fields.number(at) else {
                self.odd[place + offset] |= fields.number(at) == Number::Not;
                return f64::NAN;
            };
            let degrees = (value / 100.0).floor();
            let minutes = value - 100.0 * degrees;
            let angle = degrees + minutes / 60.0;
            let sign = match fields.at(at + 1) {
                letter if letter == [positive] => 1.0,
                letter if letter == [negative] => -1.0,
                _ => f64::NAN,
            };
            let valid = value >= 0.0 && minutes < 60.0 && angle <= limit && sign.is_finite();
            self.odd[place + offset] |= !valid;
            if valid { sign * angle * DEGREE } else { f64::NAN }
        };
        let (latitude, longitude) = (read(0, first, 90.0, *b"NS"), read(1, first + 2, 180.0, *b"EW"));
        if latitude.is_finite() && longitude.is_finite() {
            (self.values[place], self.values[place + 1]) = (latitude, longitude);
        }
    }

    fn take_second(&mut self, place: usize, field: &[u8]) {
        let second = second_of_day(field);
        self.odd[place] = second.is_none() && !field.trim_ascii().is_empty();
        self.values[place] = second.unwrap_or(f64::NAN);
    }
}

/// An angle within [0, 2π).
pub(super) fn turned(angle: f64) -> f64 {
    let within = angle.rem_euclid(TAU);
    // A small negative angle rounds up to the full turn.
    if within >= TAU { 0.0 } else { within }
}

const HEADING: (f64, f64) = (0.0, 360.0);
/// Knots; nothing that steers is faster, and instruments write 999 for no reading.
const SPEED: (f64, f64) = (-100.0, 100.0);

/// Reads a sentence; of XDR, see [`transducers`].
pub(super) fn read(kind: Kind, fields: &Fields) -> Row {
    let mut row = Row::empty();
    match kind {
        Kind::Hdt if matches!(fields.at(2), b"T" | b"") => row.take_direction(0, fields.number(1)),
        Kind::Hdm if matches!(fields.at(2), b"M" | b"") => row.take_direction(0, fields.number(1)),
        // A: autonomous, E: estimated; manual, simulated and invalid headings are none of this ship.
        Kind::Ths if matches!(fields.at(2), b"A" | b"E") => row.take_direction(0, fields.number(1)),
        Kind::Hdg => read_hdg(&mut row, fields),
        Kind::Rot if fields.is(2, b'A') => row.take(0, fields.number(1), (-3600.0, 3600.0), DEGREE / 60.0),
        Kind::Rsa => {
            for (place, field) in [(0, 1), (1, 3)] {
                if fields.is(field + 1, b'A') {
                    row.take(place, fields.number(field), (-90.0, 90.0), DEGREE);
                }
            }
        }
        Kind::Htc => match fields.at(3) {
            b"R" => row.take(0, fields.number(2), (0.0, 90.0), DEGREE),
            b"L" => row.take(0, fields.number(2), (0.0, 90.0), -DEGREE),
            // Midships has no side.
            _ if fields.number(2) == Number::Of(0.0) => row.values[0] = 0.0,
            _ => row.odd[0] = fields.number(2) != Number::Empty,
        },
        Kind::Vhw => {
            row.take_direction(0, fields.number(1));
            row.take_direction(1, fields.number(3));
            row.take_either(2, (fields.number(5), SPEED, KNOT), (fields.number(7), (-185.0, 185.0), 1.0 / 3.6));
        }
        Kind::Vbw => {
            for (place, field, status) in [(0, 1, 3), (1, 2, 3), (2, 4, 6), (3, 5, 6)] {
                if fields.is(status, b'A') {
                    row.take(place, fields.number(field), SPEED, KNOT);
                }
            }
        }
        Kind::Vtg if !fields.is(9, b'N') && fields.is(6, b'N') => {
            let kmh = (fields.number(7), (0.0, 185.0), 1.0 / 3.6);
            row.take_either(0, (fields.number(5), (0.0, SPEED.1), KNOT), kmh);
        }
        Kind::Rmc if fields.is(2, b'A') => {
            row.take_second(0, fields.at(1));
            let day = date(fields.at(9));
            row.odd[1] = day.is_none() && !fields.at(9).is_empty();
            row.values[1] = day.unwrap_or(f64::NAN);
            row.take_position(2, fields, 3);
            row.take(4, fields.number(7), (0.0, SPEED.1), KNOT);
        }
        // The quality is 0 where there is no position, 6 to 8 where it is reckoned, entered or simulated.
        Kind::Gga if matches!(fields.at(6), b"1" | b"2" | b"3" | b"4" | b"5" | b"9") => {
            row.take_second(0, fields.at(1));
            row.take_position(1, fields, 2);
        }
        Kind::Gll if fields.is(6, b'A') => {
            row.take_second(0, fields.at(5));
            row.take_position(1, fields, 1);
        }
        Kind::Zda => {
            row.take_second(0, fields.at(1));
            row.values[1] = day(fields.number(2), fields.number(3), fields.number(4)).unwrap_or(f64::NAN);
        }
        Kind::Rpm => {
            let shaft = fields.at(2).first().copied().unwrap_or(b'0');
            row.part = [if fields.is(1, b'E') { b'E' } else { b'S' }, shaft];
            if fields.is(5, b'A') {
                row.take(0, fields.number(3), (-10_000.0, 10_000.0), 1.0 / 60.0);
            }
        }
        Kind::Mwv => read_mwv(&mut row, fields),
        Kind::Mwd => {
            if fields.is(2, b'T') {
                row.take_direction(1, fields.number(1));
            }
            row.take_either(0, (fields.number(7), (0.0, 100.0), 1.0), (fields.number(5), (0.0, 200.0), KNOT));
        }
        _ => {}
    }
    row
}

/// HDG: sensor, deviation and variation. What the compass shows and the deviation make the magnetic heading.
fn read_hdg(row: &mut Row, fields: &Fields) {
    let signed = |at: usize| match (fields.number(at), fields.at(at + 1)) {
        (Number::Of(value), b"E") if (0.0..=180.0).contains(&value) => Ok(value * DEGREE),
        (Number::Of(value), b"W") if (0.0..=180.0).contains(&value) => Ok(-value * DEGREE),
        (Number::Empty, _) => Ok(f64::NAN),
        _ => Err(()),
    };
    row.take(0, fields.number(1), HEADING, DEGREE);
    match signed(2) {
        Ok(deviation) if deviation.is_finite() => row.values[0] = turned(row.values[0] + deviation),
        Ok(_) => row.values[0] = turned(row.values[0]),
        Err(()) => (row.values[0], row.odd[0]) = (f64::NAN, true),
    }
    match signed(4) {
        Ok(variation) => row.values[1] = variation,
        Err(()) => row.odd[1] = true,
    }
}

/// MWV: both directions are clockwise from the bow, the one of the true wind too.
fn read_mwv(row: &mut Row, fields: &Fields) {
    row.part = [fields.at(2).first().copied().unwrap_or(0), 0];
    let factor = match fields.at(4) {
        b"K" => 1.0 / 3.6,
        b"M" => 1.0,
        b"N" => KNOT,
        // Statute miles an hour: 1609.344 m in 3600 s.
        b"S" => 0.447_04,
        _ => f64::NAN,
    };
    if !fields.is(5, b'A') || !matches!(fields.at(2), b"R" | b"T") {
        return;
    }
    row.take_direction(1, fields.number(1));
    if factor.is_finite() {
        row.take(0, fields.number(3), (0.0, 360.0), factor);
    }
}

/// The angle transducers of XDR for the rudder and for roll, one row each.
pub(super) fn transducers(body: &[u8], mut each: impl FnMut(Row)) {
    let mut fields = body.split(|&byte| byte == b',');
    while let (Some(of), Some(value), Some(unit), Some(name)) =
        (fields.next(), fields.next(), fields.next(), fields.next())
    {
        let part = if name.eq_ignore_ascii_case(b"rudder") {
            b'R'
        } else if name.eq_ignore_ascii_case(b"roll") {
            b'O'
        } else {
            continue;
        };
        if of == b"A" && unit == b"D" {
            let mut row = Row { part: [part, 0], ..Row::empty() };
            row.take(0, super::frame::number(value), (-90.0, 90.0), DEGREE);
            each(row);
        }
    }
}

/// The value of two digits.
fn two(digits: &[u8]) -> Option<u32> {
    match digits {
        [tens @ b'0'..=b'9', ones @ b'0'..=b'9'] => Some(u32::from(10 * (tens - b'0') + ones - b'0')),
        _ => None,
    }
}

/// Second of the day from `hhmmss.ss`.
fn second_of_day(field: &[u8]) -> Option<f64> {
    let field = field.trim_ascii();
    let (hour, minute) = (two(field.get(..2)?)?, two(field.get(2..4)?)?);
    two(field.get(4..6)?)?;
    if field.get(6).is_some_and(|&byte| byte != b'.') {
        return None;
    }
    let Number::Of(second) = super::frame::number(&field[4..]) else { return None };
    // A leap second is the 60th.
    (hour < 24 && minute < 60 && second < 61.0).then(|| f64::from(3600 * hour + 60 * minute) + second)
}

/// The day of `ddmmyy`.
fn date(field: &[u8]) -> Option<f64> {
    let [day, month, year] = [field.get(..2)?, field.get(2..4)?, field.get(4..)?].map(two);
    let year = year? as i32;
    Some(days(if year < 70 { 2000 } else { 1900 } + year, month?, day?)? as f64)
}

/// The day of three numbers.
fn day(day: Number, month: Number, year: Number) -> Option<f64> {
    match (day, month, year) {
        (Number::Of(day), Number::Of(month), Number::Of(year)) if day >= 0.0 && month >= 0.0 => {
            Some(days(year as i32, month as u32, day as u32)? as f64)
        }
        _ => None,
    }
}
