//! Stamps of date and time as written by loggers and spreadsheets, and the seconds between them. The notations and the
//! calendar are here; time columns are chosen in [`crate::reader`].
//!
//! Calendar: `chrono`. No library reads all these notations: jiff and chrono read ISO 8601 and one given
//! notation at a time, no decimal commas, and no date whose month is determined later in the file.

use chrono::NaiveDate;

/// Seconds of a day.
pub const SECONDS_PER_DAY: f64 = 86_400.0;

/// Date of a stamp.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Date {
    /// Days since 1970-01-01 (Gregorian).
    Day(i64),
    /// Two numbers up to 31 and a year; later dates of the file determine which number is the month.
    Either { first: u32, second: u32, year: i32 },
}

impl Date {
    /// Day since 1970-01-01, with the first or the second of two numbers as the month; `None` for an invalid date.
    fn day(self, month_first: bool) -> Option<i64> {
        match self {
            Date::Day(day) => Some(day),
            Date::Either { first, second, year } if month_first => days_since_1970(year, first, second),
            Date::Either { first, second, year } => days_since_1970(year, second, first),
        }
    }
}

/// Date, time of day or both, as a log states them, with the time zone if stated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeStamp {
    /// `None` for a time of day alone.
    date: Option<Date>,
    /// Second of the day; `None` for a date alone.
    second: Option<f64>,
    /// Minutes by which the local time is ahead of UTC; `None` without a stated zone.
    utc_offset_min: Option<i32>,
    /// `true` if the seconds have a nonzero fraction.
    fraction: bool,
}

/// Days from 1970-01-01 to a date of the Gregorian calendar; `None` for an invalid date.
pub fn days_since_1970(year: i32, month: u32, day: u32) -> Option<i64> {
    NaiveDate::from_ymd_opt(year, month, day).map(|date| i64::from(date.to_epoch_days()))
}

/// Date of a day since 1970-01-01: `2026-11-20`. A day beyond the calendar, as in damaged files, gives the last date.
pub fn date(day: i64) -> impl std::fmt::Display {
    i32::try_from(day).ok().and_then(NaiveDate::from_epoch_days).unwrap_or(NaiveDate::MAX)
}

/// Date of a text such as `2026-11-20`, as written by [`date`]; `None` for any other text.
pub fn parse_date(text: &str) -> Option<String> {
    text.trim().parse::<NaiveDate>().ok().map(|day| day.to_string())
}

/// Cursor over the characters of a stamp.
struct Scan<'a> {
    tail: &'a [u8],
}

impl Scan<'_> {
    fn eat(&mut self, wanted: &[u8]) -> Option<u8> {
        let first = *self.tail.first()?;
        wanted.contains(&first).then(|| {
            self.tail = &self.tail[1..];
            first
        })
    }

    fn blanks(&mut self) {
        while self.eat(b" \t").is_some() {}
    }

    /// Number of up to nine digits, and its count of digits.
    fn number(&mut self) -> Option<(u32, usize)> {
        let digits = self.tail.iter().take(10).take_while(|byte| byte.is_ascii_digit()).count();
        if digits == 0 || digits > 9 {
            return None;
        }
        let value = self.tail[..digits].iter().fold(0, |sum, digit| 10 * sum + u32::from(digit - b'0'));
        self.tail = &self.tail[digits..];
        Some((value, digits))
    }

    /// Month from the first three letters of its English name.
    fn month(&mut self) -> Option<u32> {
        const MONTHS: [&[u8]; 12] =
            [b"jan", b"feb", b"mar", b"apr", b"may", b"jun", b"jul", b"aug", b"sep", b"oct", b"nov", b"dec"];
        let letters = self.tail.iter().take_while(|byte| byte.is_ascii_alphabetic()).count();
        let name = self.tail.get(..3)?;
        let place = MONTHS.iter().position(|month| name.eq_ignore_ascii_case(month))?;
        self.tail = &self.tail[letters..];
        Some(place as u32 + 1)
    }

    fn word(&mut self, word: &[u8]) -> bool {
        let is_next = self.tail.get(..word.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(word));
        if is_next {
            self.tail = &self.tail[word.len()..];
        }
        is_next
    }
}

/// Year from four digits, or from two for the years 1970 to 2069; `None` for another number of digits.
pub(crate) fn full_year(year: u32, digits: usize) -> Option<i32> {
    match digits {
        4 => Some(year as i32),
        2 => Some(if year < 70 { 2000 } else { 1900 } + year as i32),
        _ => None,
    }
}

fn read_date(scan: &mut Scan) -> Option<Date> {
    if let Some(month) = scan.month() {
        scan.blanks();
        let (day, _) = scan.number()?;
        while scan.eat(b", ").is_some() {}
        let (year, digits) = scan.number()?;
        return days_since_1970(full_year(year, digits)?, month, day).map(Date::Day);
    }
    let (first, digits) = scan.number()?;
    if digits == 8 {
        return days_since_1970((first / 10_000) as i32, first / 100 % 100, first % 100).map(Date::Day);
    }
    let mark = scan.eat(b"-/. ")?;
    if let Some(month) = scan.month() {
        scan.eat(b"-/. ,")?;
        let (year, digits) = scan.number()?;
        return days_since_1970(full_year(year, digits)?, month, first).map(Date::Day);
    }
    let (second, _) = scan.number()?;
    scan.eat(&[mark])?;
    let (third, last) = scan.number()?;
    if digits == 4 {
        return days_since_1970(first as i32, second, third).map(Date::Day);
    }
    let year = full_year(third, last)?;
    if mark == b'.' {
        return days_since_1970(year, second, first).map(Date::Day);
    }
    let possible = days_since_1970(year, second, first).or(days_since_1970(year, first, second));
    possible.map(|_| Date::Either { first, second, year })
}

/// Second of the day, and `true` if it has a nonzero fraction.
fn read_time(scan: &mut Scan) -> Option<(f64, bool)> {
    let (first, digits) = scan.number()?;
    let (hour, minute, second) = match digits {
        6 => (first / 10_000, first / 100 % 100, first % 100),
        1 | 2 => {
            scan.eat(b":h")?;
            let (minute, _) = scan.number()?;
            let second = if scan.eat(b":m").is_some() { scan.number()?.0 } else { 0 };
            (first, minute, second)
        }
        _ => return None,
    };
    let mut fraction = 0.0;
    if scan.eat(b".,").is_some() {
        let (value, digits) = scan.number()?;
        fraction = f64::from(value) / 10f64.powi(digits as i32);
    }
    scan.blanks();
    let hour = if scan.word(b"pm") || scan.word(b"p.m.") {
        hour % 12 + 12
    } else if scan.word(b"am") || scan.word(b"a.m.") {
        hour % 12
    } else {
        hour
    };
    // A leap second is second 60.
    let valid = hour < 24 && minute < 60 && second <= 60;
    valid.then(|| (f64::from(hour * 3600 + minute * 60 + second) + fraction, fraction > 0.0))
}

/// Second of the day from `hhmmss` or `hhmmss.ss`; `None` for any other text.
pub(crate) fn second_of_day(digits: &[u8]) -> Option<f64> {
    let mut scan = Scan { tail: digits.strip_suffix(b".").unwrap_or(digits) };
    let (second, _) = read_time(&mut scan).filter(|_| digits.iter().take(6).all(u8::is_ascii_digit))?;
    scan.tail.is_empty().then_some(second)
}

/// Minutes ahead of UTC, as `Z`, `UTC`, `+01:00`, `+0100` or `+01`.
fn read_zone(scan: &mut Scan) -> Option<i32> {
    if scan.word(b"utc") || scan.word(b"gmt") || scan.word(b"z") {
        return Some(0);
    }
    let sign = if scan.eat(b"+-")? == b'-' { -1 } else { 1 };
    let (value, digits) = scan.number()?;
    let minutes = match digits {
        4 => value / 100 * 60 + value % 100,
        1 | 2 => 60 * value + if scan.eat(b":").is_some() { scan.number()?.0 } else { 0 },
        _ => return None,
    };
    (minutes <= 15 * 60).then_some(sign * minutes as i32)
}

impl TimeStamp {
    /// Stamp of a text: ISO 8601 (`2026-11-20T14:03:05.2Z`, a blank for the T, `/` for the hyphens), `20.11.2026
    /// 14:03:05`, `11/20/2026 2:03:05 PM`, `20-Nov-2026 14:03:05`, or a date or a time of day alone.
    ///
    /// `None` for any other text, including a single number.
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim().as_bytes();
        let mut scan = Scan { tail: text };
        let clock_alone = text.iter().take(3).any(|byte| matches!(byte, b':' | b'h'));
        let date = if clock_alone { None } else { Some(read_date(&mut scan)?) };
        let mut stamp = Self { date, second: None, utc_offset_min: None, fraction: false };
        if date.is_some() {
            if scan.tail.is_empty() {
                // Eight digits may be a number instead.
                return text.iter().any(|byte| !byte.is_ascii_digit()).then_some(stamp);
            }
            scan.eat(b"Tt ,_-;")?;
            scan.blanks();
        }
        let (second, fraction) = read_time(&mut scan)?;
        (stamp.second, stamp.fraction) = (Some(second), fraction);
        scan.blanks();
        if !scan.tail.is_empty() {
            stamp.utc_offset_min = Some(read_zone(&mut scan)?);
        }
        scan.tail.is_empty().then_some(stamp)
    }

    /// Stamp with the date of a stamp, and the time of day and zone of another.
    pub fn joined(date: Self, time: Self) -> Self {
        Self { date: date.date, ..time }
    }

    /// Stamp from a day since 1970-01-01 (`None` without a date) and a second of the day (UTC).
    pub fn new(day: Option<i64>, second: f64) -> Self {
        let fraction = second.fract() != 0.0;
        Self { date: day.map(Date::Day), second: Some(second), utc_offset_min: Some(0), fraction }
    }

    /// `true` if there is a time of day.
    pub fn has_time(&self) -> bool {
        self.second.is_some()
    }

    /// `true` if there is a date.
    pub fn has_date(&self) -> bool {
        self.date.is_some()
    }

    /// `true` if the seconds have a nonzero fraction.
    pub fn has_fraction(&self) -> bool {
        self.fraction
    }
}

/// Clock of the ship at time 0 of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    /// Days since 1970-01-01; `None` if the file has times of day alone, or does not determine the month.
    pub day: Option<i64>,
    /// Second of the day.
    pub second: f64,
    /// Minutes by which the clock is ahead of UTC; `None` without a stated zone.
    pub utc_offset_min: Option<i32>,
}

impl Clock {
    /// Time of day at time `t` (s) of the record: `14:03:05`.
    pub fn time_of_day_at(&self, t: f64) -> String {
        let second = (self.second + t).rem_euclid(SECONDS_PER_DAY).floor() as u32;
        format!("{:02}:{:02}:{:02}", second / 3600, second / 60 % 60, second % 60)
    }

    /// Date at time `t` (s) of the record: `2026-11-20`; `None` for a clock without a date.
    pub fn date_at(&self, t: f64) -> Option<String> {
        Some(date(self.day? + ((self.second + t) / SECONDS_PER_DAY).floor() as i64).to_string())
    }

    /// Time (s) of the record at a stamp; a time of day alone means the first such time at or after time 0. `None`
    /// without a time of day, for an ambiguous date, or for a date on a clock without one.
    pub fn record_time(&self, stamp: &TimeStamp) -> Option<f64> {
        let shift =
            self.utc_offset_min.zip(stamp.utc_offset_min).map_or(0.0, |(clock, stamp)| f64::from(clock - stamp) * 60.0);
        let second = stamp.second? + shift - self.second;
        match stamp.date {
            None => Some(second.rem_euclid(SECONDS_PER_DAY)),
            Some(Date::Day(day)) => Some((day - self.day?) as f64 * SECONDS_PER_DAY + second),
            Some(Date::Either { .. }) => None,
        }
    }
}

/// Reason why a stamp has no time on the clock of its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StampFault {
    /// Stamp without a time of day.
    NoTime,
    /// The date changes and either number may be the month, or the date is invalid with the month of earlier dates.
    AmbiguousDate,
}

/// Converter of the time stamps of one file to seconds since its first stamp.
#[derive(Debug, Clone, Default)]
pub struct StampConverter {
    /// First stamp; `None` before it.
    first: Option<TimeStamp>,
    /// Last date, and its days after the first date; `None` before a date was read.
    last: Option<(Date, i64)>,
    /// Time of day of the last stamp without a date, s.
    last_second: f64,
    /// Number of midnights passed, for stamps without a date.
    midnights: i64,
    /// `true` if the first of two numbers is the month; `None` until a date determines it.
    month_first: Option<bool>,
}

impl StampConverter {
    /// Seconds from the first stamp to this stamp.
    ///
    /// A time of day that decreases by more than half a day has passed midnight. A date such as 03/04/2026 is kept in
    /// both readings until a date determines the month: by a number above 12, or by a step of a day to the next date.
    /// Fails with [`StampFault`] for a stamp without a time of day, and for a date whose month is not determined.
    pub fn seconds(&mut self, stamp: TimeStamp) -> Result<f64, StampFault> {
        let second = stamp.second.ok_or(StampFault::NoTime)?;
        let first = *self.first.get_or_insert(stamp);
        let day = match (stamp.date, first.date) {
            (Some(date), Some(begin)) => self.day(begin, date)?,
            _ => {
                self.midnights += i64::from(self.last_second - second > 0.5 * SECONDS_PER_DAY);
                self.midnights -= i64::from(second - self.last_second > 0.5 * SECONDS_PER_DAY && self.midnights > 0);
                self.last_second = second;
                self.midnights
            }
        };
        let zone = match (stamp.utc_offset_min, first.utc_offset_min) {
            (Some(minutes), Some(begin)) => 60.0 * f64::from(begin - minutes),
            _ => 0.0,
        };
        Ok(day as f64 * SECONDS_PER_DAY + second - first.second.unwrap_or(0.0) + zone)
    }

    /// Days from the first date to another date.
    fn day(&mut self, begin: Date, date: Date) -> Result<i64, StampFault> {
        if let Some((last, day)) = self.last
            && last == date
        {
            return Ok(day);
        }
        let after = |month_first: bool| Some(date.day(month_first)? - begin.day(month_first)?);
        let (day_first, month_first) = (after(false), after(true));
        let next = self.last.map_or(0, |(_, day)| day) + 1;
        let day = if date == begin {
            Some(0)
        } else {
            self.month_first = match (self.month_first, day_first, month_first) {
                (Some(month_first), ..) => Some(month_first),
                (None, Some(_), None) => Some(false),
                (None, None, Some(_)) => Some(true),
                (None, Some(day), Some(month)) if day != month => match (day == next, month == next) {
                    (true, false) => Some(false),
                    (false, true) => Some(true),
                    _ => return Err(StampFault::AmbiguousDate),
                },
                (None, ..) => None,
            };
            if self.month_first == Some(true) { month_first } else { day_first }
        };
        let day = day.ok_or(StampFault::AmbiguousDate)?;
        self.last = Some((date, day));
        Ok(day)
    }

    /// Clock at the first stamp; `None` before the first stamp.
    pub fn clock(&self) -> Option<Clock> {
        let first = self.first?;
        let day = first.date.and_then(|date| match (self.month_first, date.day(false), date.day(true)) {
            (Some(true), _, month_first) => month_first,
            (Some(false), day_first, _) => day_first,
            (None, day_first, month_first) if day_first == month_first => day_first,
            (None, Some(day), None) | (None, None, Some(day)) => Some(day),
            (None, ..) => None,
        });
        Some(Clock { day, second: first.second?, utc_offset_min: first.utc_offset_min })
    }
}

#[cfg(test)]
mod tests;
