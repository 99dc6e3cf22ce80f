//! What a logger wrote before a sentence: a time stamp, the name of the port or instrument, or both, bare or in a tag
//! block. The notations of stamps are those of [`crate::clock`]; seconds and milliseconds since 1970 are added here.

use super::frame::sum;
use crate::clock::{DAY, Stamp};

/// Bytes before a sentence that are looked at.
const LONGEST: usize = 120;
/// Words before a sentence that are looked at.
const WORDS: usize = 8;
/// Most names of sources that are told apart.
const SOURCES: usize = 64;

/// Reads what stands before sentences, and keeps what it needs from line to line.
#[derive(Debug, Default)]
pub(super) struct Leading {
    /// Names of sources; the number of a source is its place here and one more, 0 where there is none.
    pub sources: Vec<String>,
    /// The words that made the stamp before: most lines of a log look alike.
    window: Option<(usize, usize)>,
    /// What stood before the last sentence, and what was found in it.
    last: String,
    found: (Option<Stamp>, u8),
}

impl Leading {
    /// The stamp before a sentence and the number of its source.
    pub fn read(&mut self, before: &str) -> (Option<Stamp>, u8) {
        if before != self.last {
            self.found = self.look(before);
            self.last.clear();
            self.last.push_str(before);
        }
        self.found
    }

    fn look(&mut self, before: &str) -> (Option<Stamp>, u8) {
        if before.len() > LONGEST {
            return (None, 0);
        }
        if let Some((front, block)) = before.split_once('\\') {
            let (stamp, source) = self.tag_block(block.split('\\').next().unwrap_or(""));
            return if stamp.is_some() || front.trim().is_empty() { (stamp, source) } else { self.words(front) };
        }
        self.words(before)
    }

    /// `c:1763647385,s:GP0001*hh`
    fn tag_block(&mut self, block: &str) -> (Option<Stamp>, u8) {
        let content = match block.split_once('*') {
            Some((content, digits)) if u8::from_str_radix(digits, 16) == Ok(sum(content.as_bytes())) => content,
            Some(_) => return (None, 0),
            None => block,
        };
        let value = |key| content.split(',').find_map(|pair| pair.strip_prefix(key));
        (value("c:").and_then(since_1970), self.source(value("s:").unwrap_or("")))
    }

    /// Words with a stamp among them, and the name of a source.
    fn words(&mut self, before: &str) -> (Option<Stamp>, u8) {
        let text = before.replace(['"', '\'', '[', ']', '(', ')', '<', '>'], "");
        let words: Vec<&str> =
            text.split([' ', '\t', ',', ';', '|']).filter(|word| !word.is_empty()).take(WORDS).collect();
        let begin = |word: &str| word.as_ptr() as usize - text.as_ptr() as usize;
        let read = |(from, until): (usize, usize)| {
            let (first, last) = (words.get(from)?, words.get(until - 1)?);
            Some((parse(&text[begin(first)..begin(last) + last.len()])?, (from, until)))
        };
        let search = || {
            let count = words.len();
            let windows = (1..=count).rev().flat_map(|length| (0..=count - length).map(move |at| (at, at + length)));
            windows.into_iter().find_map(read)
        };
        let found = self.window.and_then(read).or_else(search);
        self.window = found.map(|(_, window)| window);
        let taken = self.window.map_or(0..0, |(from, until)| from..until);
        let is_name = |word: &&str| word.starts_with(|c: char| c.is_ascii_alphabetic());
        let others = words.iter().enumerate().filter(|(place, _)| !taken.contains(place));
        let name: Vec<&str> = others.map(|(_, word)| word.trim_end_matches(':')).filter(is_name).collect();
        let source = self.source(&name.join(" "));
        (found.map(|(stamp, _)| stamp), source)
    }

    /// The number of the source that is named.
    fn source(&mut self, name: &str) -> u8 {
        let known = self.sources.iter().position(|source| source == name);
        match known {
            _ if name.is_empty() => 0,
            Some(place) => place as u8 + 1,
            None if self.sources.len() < SOURCES => {
                self.sources.push(name.to_owned());
                self.sources.len() as u8
            }
            None => 0,
        }
    }
}

/// A stamp with a time of day in any notation.
fn parse(text: &str) -> Option<Stamp> {
    Stamp::parse(text).or_else(|| since_1970(text)).filter(Stamp::has_time)
}

/// A stamp from seconds, milliseconds or microseconds since 1970-01-01 UTC; their digits tell them apart.
fn since_1970(text: &str) -> Option<Stamp> {
    let (whole, decimals) = text.split_once('.').unwrap_or((text, ""));
    if !whole.bytes().chain(decimals.bytes()).all(|byte| byte.is_ascii_digit()) || decimals.len() > 12 {
        return None;
    }
    // Whole and fraction apart: together they have more digits than a number of 64 bits holds.
    let per_second: u64 = match whole.len() {
        9 | 10 => 1,
        12 | 13 => 1_000,
        15 | 16 => 1_000_000,
        _ => return None,
    };
    let whole: u64 = whole.parse().ok()?;
    let decimals: f64 = format!("0.{decimals}0").parse().ok()?;
    let (seconds, rest) = (whole / per_second, (whole % per_second) as f64);
    let day = seconds / DAY as u64;
    let second = (seconds % DAY as u64) as f64 + (rest + decimals) / per_second as f64;
    Some(Stamp::of(Some(day as i64), second))
}
