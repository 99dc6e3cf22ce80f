//! Writers of values as cells of a text, and a reader of the text while it is written.

use std::fmt::Write as _;
use std::io::{self, Read};

use crate::clock;
use crate::reader::error::ReadProblem;

/// Reader of a text that is generated in chunks of lines while it is read.
pub struct ChunkReader<I> {
    chunks: I,
    text: String,
    consumed: usize,
}

impl<I: Iterator<Item = Result<String, ReadProblem>>> ChunkReader<I> {
    pub fn new(chunks: I) -> Self {
        Self { chunks, text: String::new(), consumed: 0 }
    }
}

impl<I: Iterator<Item = Result<String, ReadProblem>>> Read for ChunkReader<I> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        while self.consumed == self.text.len()
            && let Some(chunk) = self.chunks.next()
        {
            (self.text, self.consumed) = (chunk.map_err(io::Error::other)?, 0);
        }
        let count = buffer.len().min(self.text.len() - self.consumed);
        buffer[..count].copy_from_slice(&self.text.as_bytes()[self.consumed..self.consumed + count]);
        self.consumed += count;
        Ok(count)
    }
}

/// Writes a line of cells with its end; `write` gets the index of each cell.
pub fn write_line(text: &mut String, cells: usize, mut write: impl FnMut(&mut String, usize)) {
    for index in 0..cells {
        if index > 0 {
            text.push('\t');
        }
        write(text, index);
    }
    text.push('\n');
}

/// Appends formatted text.
fn put(text: &mut String, written: std::fmt::Arguments) {
    text.write_fmt(written).expect("a string takes all text");
}

/// Writes a number with the minimum number of digits that are read back as the same number; no text for NaN.
pub fn write_number(text: &mut String, value: f64) {
    if !value.is_nan() {
        put(text, format_args!("{value:?}"));
    }
}

/// Writes a number of single precision with the minimum number of digits that are read back as the same number.
pub fn write_single(text: &mut String, value: f32) {
    if !value.is_nan() {
        put(text, format_args!("{value:?}"));
    }
}

/// Writes a whole number.
pub fn write_integer(text: &mut String, value: impl Into<i128>) {
    put(text, format_args!("{}", value.into()));
}

/// Writes `value` · 10^(−`decimals`): as a decimal number, or with an exponent if `decimals` is 0 or 10^`decimals`
/// exceeds 128 bits.
pub fn write_decimal(text: &mut String, value: i128, decimals: u32) {
    let sign = if value < 0 { "-" } else { "" };
    let digits = value.unsigned_abs();
    match 10_u128.checked_pow(decimals) {
        Some(unit) if decimals > 0 => {
            let (whole, part) = (digits / unit, digits % unit);
            put(text, format_args!("{sign}{whole}.{part:0width$}", width = decimals as usize));
        }
        _ => put(text, format_args!("{sign}{digits}e-{decimals}")),
    }
}

/// Writes a day since 1970-01-01.
pub fn write_date(text: &mut String, day: i64) {
    put(text, format_args!("{}", clock::date(day)));
}

/// Writes nanoseconds since midnight as a time of day.
pub fn write_time_of_day(text: &mut String, nanoseconds: i64) {
    let (seconds, part) = (nanoseconds.div_euclid(1_000_000_000), nanoseconds.rem_euclid(1_000_000_000));
    put(text, format_args!("{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60));
    if part > 0 {
        put(text, format_args!(".{part:09}"));
        text.truncate(text.trim_end_matches('0').len());
    }
}

/// Writes date and time of an instant `part` nanoseconds after `seconds` since 1970-01-01.
pub fn write_stamp(text: &mut String, seconds: i64, part: i64, utc: bool) {
    write_date(text, seconds.div_euclid(86_400));
    text.push('T');
    write_time_of_day(text, seconds.rem_euclid(86_400) * 1_000_000_000 + part);
    if utc {
        text.push('Z');
    }
}

/// Writes a text as a cell: control characters become blanks, and a text with a quote or a comment sign is put
/// in quotes.
pub fn write_cell(text: &mut String, content: &str) {
    let quoted = content.contains(['"', '#']);
    if quoted {
        text.push('"');
    }
    for c in content.chars() {
        match c {
            '"' => text.push_str("\"\""),
            c if c.is_control() => text.push(' '),
            c => text.push(c),
        }
    }
    if quoted {
        text.push('"');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(write: impl Fn(&mut String)) -> String {
        let mut text = String::new();
        write(&mut text);
        text
    }

    #[test]
    fn values_are_written_as_a_table_has_them() {
        for value in [0.1 + 0.2, 1e300, -5e-324, 16_777_217.0, f64::MAX] {
            assert_eq!(written(|text| write_number(text, value)).parse::<f64>().ok(), Some(value));
        }
        assert_eq!(written(|text| write_single(text, 0.1)), "0.1");
        assert_eq!(written(|text| write_number(text, f64::NAN)), "");
        assert_eq!(written(|text| write_integer(text, u64::MAX)), "18446744073709551615");
        assert_eq!(written(|text| write_decimal(text, -12_345, 2)), "-123.45");
        assert_eq!(written(|text| write_decimal(text, -5, 3)), "-0.005");
        assert_eq!(written(|text| write_decimal(text, 7, 60)), "7e-60");
        assert_eq!(written(|text| write_date(text, 20_777)), "2026-11-20");
        let at = 20_777 * 86_400 + 14 * 3600 + 3 * 60 + 5;
        assert_eq!(written(|text| write_stamp(text, at, 200_000_000, false)), "2026-11-20T14:03:05.2");
        assert_eq!(written(|text| write_stamp(text, at, 0, true)), "2026-11-20T14:03:05Z");
        assert_eq!(written(|text| write_stamp(text, -1, 1, false)), "1969-12-31T23:59:59.000000001");
        assert_eq!(written(|text| write_stamp(text, 0, 0, false)), "1970-01-01T00:00:00");
        assert_eq!(written(|text| write_cell(text, "a\tb\r\nc")), "a b  c");
        assert_eq!(written(|text| write_cell(text, "# \"x\"")), "\"# \"\"x\"\"\"");
    }
}
