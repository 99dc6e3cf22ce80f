//! Text of a logger before a sentence: a time stamp, the name of the port or instrument, or both, bare or in a tag
//! block. The notations of stamps are those of [`crate::clock`]; seconds and milliseconds since 1970 are added here.
//!
//! Source of the tag block: NMEA 0183 version 4.11.

use super::frame::sum;
use crate::clock::{SECONDS_PER_DAY, TimeStamp};

/// Maximum length of the text before a sentence, bytes; a longer text has no stamp.
const MAX_TEXT_BYTES: usize = 120;
/// Maximum number of parts that are read before a sentence; blanks, tabs and marks separate them.
const MAX_WORDS: usize = 8;
/// Maximum number of sources.
const MAX_SOURCES: usize = 64;

/// Reader of the text before sentences, with its state from line to line.
#[derive(Debug, Default)]
pub(super) struct PrefixReader {
    /// Names of sources; the number of a source is its index plus 1, 0 means no source.
    pub sources: Vec<String>,
    /// Range of parts with the last stamp, the same in most lines of a log; `None` without a stamp in the last text.
    window: Option<(usize, usize)>,
    /// Text before the last sentence, with its stamp and source.
    last: String,
    last_reading: (Option<TimeStamp>, u8),
}

impl PrefixReader {
    /// Stamp before a sentence (`None` if absent) and number of the source (0 if absent).
    pub fn read(&mut self, before: &str) -> (Option<TimeStamp>, u8) {
        if before != self.last {
            self.last_reading = self.parse(before);
            self.last.clear();
            self.last.push_str(before);
        }
        self.last_reading
    }

    fn parse(&mut self, before: &str) -> (Option<TimeStamp>, u8) {
        if before.len() > MAX_TEXT_BYTES {
            return (None, 0);
        }
        if let Some((front, block)) = before.split_once('\\') {
            let (stamp, source) = self.tag_block(block.split('\\').next().unwrap_or(""));
            return if stamp.is_some() || front.trim().is_empty() { (stamp, source) } else { self.plain_text(front) };
        }
        self.plain_text(before)
    }

    /// Reads a tag block such as `c:1763647385,s:GP0001*hh`.
    fn tag_block(&mut self, block: &str) -> (Option<TimeStamp>, u8) {
        let content = match block.split_once('*') {
            Some((content, digits)) if u8::from_str_radix(digits, 16) == Ok(sum(content.as_bytes())) => content,
            Some(_) => return (None, 0),
            None => block,
        };
        let value = |key| content.split(',').find_map(|pair| pair.strip_prefix(key));
        (value("c:").and_then(since_1970), self.source(value("s:").unwrap_or("")))
    }

    /// Stamp and source in the plain text before a sentence.
    fn plain_text(&mut self, before: &str) -> (Option<TimeStamp>, u8) {
        let text = before.replace(['"', '\'', '[', ']', '(', ')', '<', '>'], "");
        let all = text.split([' ', '\t', ',', ';', '|']).filter(|word| !word.is_empty());
        let parts = all.take(MAX_WORDS).collect::<Vec<&str>>();
        let begin = |word: &str| word.as_ptr() as usize - text.as_ptr() as usize;
        let read = |(from, until): (usize, usize)| {
            let (first, last) = (parts.get(from)?, parts.get(until - 1)?);
            Some((parse_stamp(&text[begin(first)..begin(last) + last.len()])?, (from, until)))
        };
        let search = || {
            let count = parts.len();
            let windows = (1..=count).rev().flat_map(|length| (0..=count - length).map(move |at| (at, at + length)));
            windows.into_iter().find_map(read)
        };
        let stamp = self.window.and_then(read).or_else(search);
        self.window = stamp.map(|(_, window)| window);
        let taken = self.window.map_or(0..0, |(from, until)| from..until);
        let is_name = |word: &&str| word.starts_with(|c: char| c.is_ascii_alphabetic());
        let remaining = parts.iter().enumerate().filter(|(index, _)| !taken.contains(index));
        let name: Vec<&str> = remaining.map(|(_, word)| word.trim_end_matches(':')).filter(is_name).collect();
        let source = self.source(&name.join(" "));
        (stamp.map(|(stamp, _)| stamp), source)
    }

    /// Number of the source with a name; 0 for an empty name, and for a new name beyond [`MAX_SOURCES`].
    fn source(&mut self, name: &str) -> u8 {
        match self.sources.iter().position(|source| source == name) {
            _ if name.is_empty() => 0,
            Some(index) => index as u8 + 1,
            None if self.sources.len() < MAX_SOURCES => {
                self.sources.push(name.to_owned());
                self.sources.len() as u8
            }
            None => 0,
        }
    }
}

/// Stamp with a time of day in any notation.
fn parse_stamp(text: &str) -> Option<TimeStamp> {
    TimeStamp::parse(text).or_else(|| since_1970(text)).filter(TimeStamp::has_time)
}

/// Stamp from seconds, milliseconds or microseconds since 1970-01-01 UTC, by the number of digits; `None` for any other
/// text.
fn since_1970(text: &str) -> Option<TimeStamp> {
    let (whole, decimals) = text.split_once('.').unwrap_or((text, ""));
    if !whole.bytes().chain(decimals.bytes()).all(|byte| byte.is_ascii_digit()) || decimals.len() > 12 {
        return None;
    }
    // Whole and fraction are separate: together they exceed the digits of a 64-bit number.
    let per_second: u64 = match whole.len() {
        9 | 10 => 1,
        12 | 13 => 1_000,
        15 | 16 => 1_000_000,
        _ => return None,
    };
    let whole: u64 = whole.parse().ok()?;
    let decimals: f64 = format!("0.{decimals}0").parse().ok()?;
    let (seconds, fraction) = (whole / per_second, (whole % per_second) as f64);
    let day = seconds / SECONDS_PER_DAY as u64;
    let second = (seconds % SECONDS_PER_DAY as u64) as f64 + (fraction + decimals) / per_second as f64;
    Some(TimeStamp::new(Some(day as i64), second))
}
