//! Decoder of sentences, field by field, in SI units and radians. It reads a single sentence at a time; the instruments
//! are chosen in [`super::choice`].
//!
//! Source: NMEA 0183 version 4.11, IEC 61162-1.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use ship::angle::{DEGREE, KNOT};

use super::frame::{Fields, Number};
use crate::clock::{days_since_1970, full_year, second_of_day};

/// Quantity that an NMEA 0183 sentence carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NmeaQuantity {
    /// True heading, rad, [0, 2π).
    HeadingTrue,
    /// Magnetic heading, rad, [0, 2π).
    HeadingMagnetic,
    /// Magnetic variation, rad, positive to the east.
    Variation,
    /// Yaw rate, rad/s, positive to starboard.
    YawRate,
    /// Starboard or single rudder, rad, positive turns to starboard.
    RudderStarboard,
    /// Port rudder, rad, positive turns to starboard.
    RudderPort,
    /// Rudder order, rad, positive turns to starboard.
    RudderOrder,
    /// Angle of a transducer, rad.
    Transducer,
    /// Speed through the water, m/s.
    SpeedWater,
    /// Speed over ground, m/s.
    SpeedGround,
    /// Surge velocity through the water, m/s.
    SurgeWater,
    /// Sway velocity through the water, m/s, to starboard.
    SwayWater,
    /// Surge velocity over ground, m/s.
    SurgeGround,
    /// Sway velocity over ground, m/s, to starboard.
    SwayGround,
    /// Latitude, rad, north positive.
    Latitude,
    /// Longitude, rad, east positive.
    Longitude,
    /// Second of the day, UTC.
    Second,
    /// Days since 1970-01-01.
    Day,
    /// Revolutions of a shaft or an engine, 1/s.
    Revolutions,
    /// Wind speed, m/s.
    WindSpeed,
    /// Direction from which the wind comes, rad, from the bow or from north.
    WindFrom,
}

/// Maximum number of quantities of a sentence.
pub(super) const MAX_SLOTS: usize = 5;

/// Supported sentence: its formatter, its quantities in the order of [`Row::values`], and its decoder.
type Sentence = (&'static [u8; 3], &'static [NmeaQuantity], fn(&mut Row, &Fields));

const SENTENCES: [Sentence; 19] = {
    use NmeaQuantity::*;
    [
        (b"HDT", &[HeadingTrue], |row, fields| row.take_heading(fields, b"T")),
        (b"HDM", &[HeadingMagnetic], |row, fields| row.take_heading(fields, b"M")),
        (b"THS", &[HeadingTrue], |row, fields| {
            // A: autonomous, E: estimated; manual, simulated and invalid headings are not those of the ship.
            if matches!(fields.field(2), b"A" | b"E") {
                row.take_direction(0, fields.number(1));
            }
        }),
        (b"HDG", &[HeadingMagnetic, Variation], read_hdg),
        (b"ROT", &[YawRate], |row, fields| {
            row.take_valid(fields, 2, &[(0, 1)], -3600.0..=3600.0, DEGREE / 60.0);
        }),
        (b"RSA", &[RudderStarboard, RudderPort], |row, fields| {
            row.take_valid(fields, 2, &[(0, 1)], -90.0..=90.0, DEGREE);
            row.take_valid(fields, 4, &[(1, 3)], -90.0..=90.0, DEGREE);
        }),
        (b"HTC", &[RudderOrder], read_order),
        (b"HTD", &[RudderOrder], read_order),
        (b"VHW", &[HeadingTrue, HeadingMagnetic, SpeedWater], |row, fields| {
            row.take_direction(0, fields.number(1));
            row.take_direction(1, fields.number(3));
            row.take_either(2, (fields.number(5), SPEED, KNOT), (fields.number(7), -185.0..=185.0, KILOMETRE_PER_HOUR));
        }),
        (b"VBW", &[SurgeWater, SwayWater, SurgeGround, SwayGround], |row, fields| {
            row.take_valid(fields, 3, &[(0, 1), (1, 2)], SPEED, KNOT);
            row.take_valid(fields, 6, &[(2, 4), (3, 5)], SPEED, KNOT);
        }),
        (b"VTG", &[SpeedGround], |row, fields| {
            if !fields.is(9, b'N') && fields.is(6, b'N') {
                let kmh = (fields.number(7), 0.0..=185.0, KILOMETRE_PER_HOUR);
                row.take_either(0, (fields.number(5), 0.0..=MAX_SPEED_KN, KNOT), kmh);
            }
        }),
        (b"RMC", &[Second, Day, Latitude, Longitude, SpeedGround], |row, fields| {
            if fields.is(2, b'A') {
                row.take_second(0, fields.field(1));
                let day = date(fields.field(9));
                row.invalid[1] = day.is_none() && !fields.field(9).is_empty();
                row.values[1] = day.unwrap_or(f64::NAN);
                row.take_position(2, fields, 3);
                row.take(4, fields.number(7), 0.0..=MAX_SPEED_KN, KNOT);
            }
        }),
        (b"GGA", &[Second, Latitude, Longitude], |row, fields| {
            // The quality is 0 without a position, and 6 to 8 for a position that is reckoned, entered or simulated.
            if matches!(fields.field(6), b"1" | b"2" | b"3" | b"4" | b"5" | b"9") {
                row.take_second(0, fields.field(1));
                row.take_position(1, fields, 2);
            }
        }),
        (b"GLL", &[Second, Latitude, Longitude], |row, fields| {
            if fields.is(6, b'A') {
                row.take_second(0, fields.field(5));
                row.take_position(1, fields, 1);
            }
        }),
        (b"ZDA", &[Second, Day], |row, fields| {
            row.take_second(0, fields.field(1));
            row.values[1] = day([2, 3, 4].map(|field| fields.number(field))).unwrap_or(f64::NAN);
        }),
        (b"RPM", &[Revolutions], |row, fields| {
            let shaft = fields.field(2).first().copied().unwrap_or(b'0');
            row.instrument_mark = [if fields.is(1, b'E') { b'E' } else { b'S' }, shaft];
            row.take_valid(fields, 5, &[(0, 3)], -10_000.0..=10_000.0, 1.0 / 60.0);
        }),
        (b"MWV", &[WindSpeed, WindFrom], read_mwv),
        (b"MWD", &[WindSpeed, WindFrom], |row, fields| {
            if fields.is(2, b'T') {
                row.take_direction(1, fields.number(1));
            }
            row.take_either(0, (fields.number(7), 0.0..=100.0, 1.0), (fields.number(5), 0.0..=200.0, KNOT));
        }),
        // See `transducers`.
        (XDR, &[Transducer], |_, _| {}),
    ]
};

/// Formatter of transducers.
pub(super) const XDR: &[u8; 3] = b"XDR";

/// Sentence with a formatter; `None` if it is not supported.
pub(super) fn sentence(formatter: &[u8]) -> Option<&'static Sentence> {
    SENTENCES.iter().find(|(name, ..)| *name == formatter)
}

/// Number with its bounds, and its factor to SI units and radians.
type Bounded = (Number, RangeInclusive<f64>, f64);

/// Values of an NMEA 0183 sentence, in the units of its quantities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Row {
    /// Values in the order of the quantities of the sentence; NaN for no reading.
    pub values: [f64; MAX_SLOTS],
    /// `true` for a quantity with an invalid entry.
    pub invalid: [bool; MAX_SLOTS],
    /// Mark of the instrument in a sentence of several: the shaft of RPM with S or E, the reference of MWV, R for
    /// the rudder and O for roll of XDR; 0 otherwise.
    pub instrument_mark: [u8; 2],
}

impl Row {
    pub fn empty() -> Self {
        Self { values: [f64::NAN; MAX_SLOTS], invalid: [false; MAX_SLOTS], instrument_mark: [0; 2] }
    }

    /// Stores a number within bounds, times a factor.
    fn take(&mut self, slot: usize, number: Number, bounds: RangeInclusive<f64>, factor: f64) {
        match number {
            Number::Value(value) if bounds.contains(&value) => self.values[slot] = value * factor,
            Number::Empty => {}
            Number::Value(_) | Number::Invalid => self.invalid[slot] = true,
        }
    }

    /// Stores the first of two numbers, each with its bounds and factor, or the second if the first is empty.
    fn take_either(&mut self, slot: usize, first: Bounded, second: Bounded) {
        let (number, bounds, factor) = if first.0 == Number::Empty { second } else { first };
        self.take(slot, number, bounds, factor);
    }

    /// Stores numbers, each with its slot, if the status field is valid.
    fn take_valid(
        &mut self,
        fields: &Fields,
        status: usize,
        entries: &[(usize, usize)],
        bounds: RangeInclusive<f64>,
        factor: f64,
    ) {
        if fields.is(status, b'A') {
            entries.iter().for_each(|&(slot, field)| self.take(slot, fields.number(field), bounds.clone(), factor));
        }
    }

    /// Stores the heading of HDT or HDM, with the letter of its reference.
    fn take_heading(&mut self, fields: &Fields, reference: &[u8]) {
        if fields.field(2) == reference || fields.field(2).is_empty() {
            self.take_direction(0, fields.number(1));
        }
    }

    /// Stores an angle of [0°, 360°].
    fn take_direction(&mut self, slot: usize, number: Number) {
        self.take(slot, number, HEADING, DEGREE);
        self.values[slot] = wrapped_to_circle(self.values[slot]);
    }

    /// Stores latitude and longitude from four fields; both or neither.
    fn take_position(&mut self, slot: usize, fields: &Fields, first: usize) {
        let mut read = |offset: usize, at: usize, limit: f64, [positive, negative]: [u8; 2]| {
            let Number::Value(value) = fields.number(at) else {
                self.invalid[slot + offset] |= fields.number(at) == Number::Invalid;
                return f64::NAN;
            };
            let degrees = (value / 100.0).floor();
            let minutes = value - 100.0 * degrees;
            let angle = degrees + minutes / 60.0;
            let sign = match fields.field(at + 1) {
                letter if letter == [positive] => 1.0,
                letter if letter == [negative] => -1.0,
                _ => f64::NAN,
            };
            let valid = value >= 0.0 && minutes < 60.0 && angle <= limit && sign.is_finite();
            self.invalid[slot + offset] |= !valid;
            if valid { sign * angle * DEGREE } else { f64::NAN }
        };
        let (latitude, longitude) = (read(0, first, 90.0, *b"NS"), read(1, first + 2, 180.0, *b"EW"));
        if latitude.is_finite() && longitude.is_finite() {
            (self.values[slot], self.values[slot + 1]) = (latitude, longitude);
        }
    }

    fn take_second(&mut self, slot: usize, field: &[u8]) {
        let field = field.trim_ascii();
        let second = second_of_day(field);
        self.invalid[slot] = second.is_none() && !field.is_empty();
        self.values[slot] = second.unwrap_or(f64::NAN);
    }
}

/// Angle reduced to [0, 2π), rad.
pub(super) fn wrapped_to_circle(angle: f64) -> f64 {
    let within = angle.rem_euclid(TAU);
    // A small negative angle rounds up to the full turn.
    if within >= TAU { 0.0 } else { within }
}

/// Bounds of a heading, deg.
const HEADING: RangeInclusive<f64> = 0.0..=360.0;
/// Maximum speed of a ship, kn; instruments write 999 for no reading.
const MAX_SPEED_KN: f64 = 100.0;
/// Bounds of a speed, kn.
const SPEED: RangeInclusive<f64> = -MAX_SPEED_KN..=MAX_SPEED_KN;
/// One kilometre per hour, m/s.
const KILOMETRE_PER_HOUR: f64 = 1.0 / 3.6;

/// Decoder of HTC and HTD: the ordered rudder with its side.
fn read_order(row: &mut Row, fields: &Fields) {
    match fields.field(3) {
        b"R" => row.take(0, fields.number(2), 0.0..=90.0, DEGREE),
        b"L" => row.take(0, fields.number(2), 0.0..=90.0, -DEGREE),
        // Amidships has no side.
        _ if fields.number(2) == Number::Value(0.0) => row.values[0] = 0.0,
        _ => row.invalid[0] = fields.number(2) != Number::Empty,
    }
}

/// Decoder of HDG: sensor, deviation and variation. Sensor and deviation add up to the magnetic heading.
fn read_hdg(row: &mut Row, fields: &Fields) {
    let signed = |at: usize| match (fields.number(at), fields.field(at + 1)) {
        (Number::Value(value), b"E") if (0.0..=180.0).contains(&value) => Ok(value * DEGREE),
        (Number::Value(value), b"W") if (0.0..=180.0).contains(&value) => Ok(-value * DEGREE),
        (Number::Empty, _) => Ok(f64::NAN),
        _ => Err(()),
    };
    row.take(0, fields.number(1), HEADING, DEGREE);
    match signed(2) {
        Ok(deviation) if deviation.is_finite() => row.values[0] = wrapped_to_circle(row.values[0] + deviation),
        Ok(_) => row.values[0] = wrapped_to_circle(row.values[0]),
        Err(()) => (row.values[0], row.invalid[0]) = (f64::NAN, true),
    }
    match signed(4) {
        Ok(variation) => row.values[1] = variation,
        Err(()) => row.invalid[1] = true,
    }
}

/// Decoder of MWV: directions are clockwise from the bow, also for the true wind.
fn read_mwv(row: &mut Row, fields: &Fields) {
    row.instrument_mark = [fields.field(2).first().copied().unwrap_or(0), 0];
    let factor = match fields.field(4) {
        b"K" => KILOMETRE_PER_HOUR,
        b"M" => 1.0,
        b"N" => KNOT,
        // Statute miles an hour: 1609.344 m in 3600 s.
        b"S" => 0.447_04,
        _ => f64::NAN,
    };
    if !fields.is(5, b'A') || !matches!(fields.field(2), b"R" | b"T") {
        return;
    }
    row.take_direction(1, fields.number(1));
    if factor.is_finite() {
        row.take(0, fields.number(3), 0.0..=360.0, factor);
    }
}

/// Angle transducers of XDR for the rudder and for roll, one row each.
pub(super) fn transducers(body: &[u8], mut each: impl FnMut(Row)) {
    let mut fields = body.split(|&byte| byte == b',');
    while let (Some(kind), Some(value), Some(unit), Some(name)) =
        (fields.next(), fields.next(), fields.next(), fields.next())
    {
        let mark = match name.to_ascii_lowercase().as_slice() {
            b"rudder" => b'R',
            b"roll" => b'O',
            _ => continue,
        };
        if kind == b"A" && unit == b"D" {
            let mut row = Row { instrument_mark: [mark, 0], ..Row::empty() };
            row.take(0, super::frame::number(value), -90.0..=90.0, DEGREE);
            each(row);
        }
    }
}

/// Day since 1970-01-01 from `ddmmyy`; `None` for an invalid date.
fn date(field: &[u8]) -> Option<f64> {
    let is_date = field.len() == 6 && field.iter().all(u8::is_ascii_digit);
    let digits: u32 = std::str::from_utf8(field).ok().filter(|_| is_date)?.parse().ok()?;
    Some(days_since_1970(full_year(digits % 100, 2)?, digits / 100 % 100, digits / 10_000)? as f64)
}

/// Day since 1970-01-01 from day, month and year; `None` for an invalid date.
fn day(date: [Number; 3]) -> Option<f64> {
    let [Number::Value(day), Number::Value(month), Number::Value(year)] = date else { return None };
    (day >= 0.0 && month >= 0.0).then(|| days_since_1970(year as i32, month as u32, day as u32))?.map(|day| day as f64)
}
