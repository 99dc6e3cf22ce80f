//! What a logger wrote before a sentence: a time stamp, the name of the port or instrument, or both, bare or in a tag
//! block. The notations of stamps are those of [`crate::clock`]; seconds and milliseconds since 1970 are added here.

use std::ops::Range;

use super::frame::{Number, number, sum};
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
    text: String,
    name: String,
    /// The words that made the stamp before: most lines of a log look alike.
    window: Option<(usize, usize)>,
    last: String,
    found: (Option<Stamp>, u8),
    /// Bytes before and behind the stamp in `last`.
    around: Option<(usize, usize)>,
}

impl Leading {
    /// The stamp before a sentence and the number of its source.
    pub fn read(&mut self, before: &str) -> (Option<Stamp>, u8) {
        if before == self.last {
            return self.found;
        }
        match self.alike(before) {
            Some(stamp) => self.found.0 = Some(stamp),
            None => self.found = self.look(before),
        }
        self.last.clear();
        self.last.push_str(before);
        self.found
    }

    /// The stamp where all around it is as it was in the line before.
    fn alike(&self, before: &str) -> Option<Stamp> {
        let (front, behind) = self.around?;
        let until = before.len().checked_sub(behind)?;
        let same = before.get(..front)? == self.last.get(..front)?
            && before.get(until..)? == self.last.get(self.last.len() - behind..)?;
        parse(before.get(front..until)?).filter(|_| same)
    }

    fn look(&mut self, before: &str) -> (Option<Stamp>, u8) {
        self.around = None;
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
        let stamp = value("c:").and_then(since_1970);
        self.name.clear();
        self.name.push_str(value("s:").unwrap_or(""));
        (stamp, self.source())
    }

    /// Words with a stamp among them, and the name of a source.
    fn words(&mut self, before: &str) -> (Option<Stamp>, u8) {
        self.text.clear();
        self.text.extend(before.chars().filter(|c| !matches!(c, '"' | '\'' | '[' | ']' | '(' | ')' | '<' | '>')));
        let mut words: [Range<usize>; WORDS] = Default::default();
        let mut count = 0;
        let mut begin = None;
        for (at, byte) in self.text.bytes().chain([b' ']).enumerate() {
            let parts = matches!(byte, b' ' | b'\t' | b',' | b';' | b'|');
            match begin {
                None if !parts => begin = Some(at),
                Some(from) if parts && count < WORDS => {
                    words[count] = from..at;
                    (begin, count) = (None, count + 1);
                }
                _ => {}
            }
        }
        let words = &words[..count];
        let read = |&(from, until): &(usize, usize)| {
            let (first, last) = (words.get(from)?, words.get(until - 1)?);
            parse(&self.text[first.start..last.end]).map(|stamp| (stamp, (from, until)))
        };
        let search = || {
            let windows = (1..=count).rev().flat_map(|length| (0..=count - length).map(move |at| (at, at + length)));
            windows.into_iter().find_map(|window| read(&window))
        };
        let found = self.window.as_ref().and_then(read).or_else(search);
        let (stamp, taken) = found.map_or((None, (0, 0)), |(stamp, window)| (Some(stamp), window));
        self.name.clear();
        for (place, word) in words.iter().enumerate() {
            let word = self.text[word.clone()].trim_end_matches(':');
            if !(taken.0..taken.1).contains(&place) && word.starts_with(|c: char| c.is_ascii_alphabetic()) {
                if !self.name.is_empty() {
                    self.name.push(' ');
                }
                self.name.push_str(word);
            }
        }
        self.window = stamp.map(|_| taken);
        if stamp.is_some() {
            let text = &self.text[words[taken.0].start..words[taken.1 - 1].end];
            self.around = before.find(text).map(|front| (front, before.len() - front - text.len()));
        }
        (stamp, self.source())
    }

    /// The number of the source that is named.
    fn source(&mut self) -> u8 {
        if self.name.is_empty() {
            return 0;
        }
        let known = self.sources.iter().position(|source| *source == self.name);
        match known {
            Some(place) => place as u8 + 1,
            None if self.sources.len() < SOURCES => {
                self.sources.push(self.name.clone());
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
    let decimals = if decimals.is_empty() { 0.0 } else { fraction(decimals)? };
    let (seconds, rest) = (whole / per_second, (whole % per_second) as f64);
    let day = seconds / DAY as u64;
    let second = (seconds % DAY as u64) as f64 + (rest + decimals) / per_second as f64;
    Some(Stamp::of(Some(day as i64), second))
}

fn fraction(decimals: &str) -> Option<f64> {
    match number(decimals.as_bytes()) {
        Number::Of(value) => Some(value / 10f64.powi(decimals.len() as i32)),
        _ => None,
    }
}
