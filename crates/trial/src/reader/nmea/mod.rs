//! Reader of NMEA 0183 logs: every channel becomes a [`Series`] at the instants of its instrument. Headings, rudder
//! angles and orders, yaw rate, speeds, position, propeller and wind are read; AIS and proprietary sentences are
//! skipped. Time comes from stamps before the sentences, or from the sentences of a GPS or clock. Damaged lines are
//! omitted and counted; a course over ground is never used as a heading. Heading and rudder may be in two files, so
//! their presence is checked later.
//!
//! Source: NMEA 0183 version 4.11, IEC 61162-1.

mod choice;
mod epochs;
mod frame;
mod log;
mod sentence;
mod stamp;
#[cfg(test)]
mod tests;

use std::io::Read;

use document::{Warning, WarningCode};

use self::choice::ChosenInstruments;
use self::epochs::{is_or_are, rounded, timing_from_sentences, timing_from_stamps};
use self::frame::{Line, frame};
use self::log::{LineCounts, NmeaLog};
use self::stamp::PrefixReader;
use super::error::ReadProblem;
use super::lines::Lines;
use super::source::{InstrumentLog, Series};
use crate::clock::{Clock, SECONDS_PER_DAY};
use crate::wording::counted;

/// Number of sentences that decide whether a log has stamps.
const PROBED_SENTENCES: usize = 64;
/// Maximum number of lines searched for these sentences.
const MAX_PROBED_LINES: usize = 1024;

/// `true` for a sentence, with or without a leading stamp.
pub(super) fn is_sentence(line: &str) -> bool {
    let has_address = |sentence: &[u8], letters: usize| {
        sentence.get(letters) == Some(&b',')
            && sentence[..letters].iter().all(|byte| byte.is_ascii_uppercase() || byte.is_ascii_digit())
    };
    let bytes = line.as_bytes();
    let Some(start) = bytes.iter().position(|&byte| matches!(byte, b'$' | b'!')) else { return false };
    let sentence = &bytes[start + 1..];
    let is_proprietary = bytes[start] == b'$'
        && sentence.first() == Some(&b'P')
        && (4..10).any(|letters| has_address(sentence, letters));
    !line.trim_start().starts_with('#') && (has_address(sentence, 5) || is_proprietary)
}

/// Reads a log: a series for each channel, and an [`InstrumentLog`] without columns.
///
/// Fails if more than half of the lines are damaged, if time is absent or decreases, if a date has two
/// readings, and if no sentence contains a used quantity.
pub(super) fn read<R: Read>(mut lines: Lines<R>) -> Result<(Vec<Series>, InstrumentLog), ReadProblem> {
    let (mut begin, mut sentences) = (Vec::new(), 0);
    while sentences < PROBED_SENTENCES
        && begin.len() < MAX_PROBED_LINES
        && let Some(line) = lines.next_line_bytes()?
    {
        sentences += usize::from(matches!(frame(line), Line::Sentence(_)));
        begin.push(line.to_vec());
    }
    let mut log = NmeaLog::new(is_stamped(&begin));
    for (index, line) in begin.iter().enumerate() {
        log.take(line, index + 1)?;
    }
    drop(begin);
    loop {
        // The number is taken before the line is read, because the line borrows the source.
        let number = lines.line_number() + 1;
        let Some(line) = lines.next_line_bytes()? else { break };
        log.take(line, number)?;
    }
    let number = lines.line_number();
    finish(log, number, lines.sha256())
}

/// `true` if at least half of the sentences have a stamp before them.
fn is_stamped(lines: &[Vec<u8>]) -> bool {
    let mut leading = PrefixReader::default();
    let (mut sentences, mut stamps) = (0, 0);
    for line in lines {
        if let Line::Sentence(frame) = frame(line) {
            sentences += 1;
            stamps += usize::from(leading.read(frame.before).0.is_some());
        }
    }
    stamps > 0 && 2 * stamps >= sentences
}

/// Channels of a log that was read to its end.
fn finish(mut log: NmeaLog, lines: usize, sha256: String) -> Result<(Vec<Series>, InstrumentLog), ReadProblem> {
    let counts = log.counts;
    let LineCounts { blank_lines, wrong_checksums: wrong, broken_sentences: broken, .. } = counts;
    let (written, damaged) = (lines - blank_lines, wrong + broken);
    if 2 * damaged > written {
        return Err(ReadProblem::DamagedLog { lines: written, damaged, wrong, broken });
    }
    if log.instruments.is_empty() {
        return Err(if counts.without_stamp > 0 {
            ReadProblem::NoClock { sentences: counts.sentences, clocks: 0 }
        } else {
            ReadProblem::NoReadings { sentences: counts.sentences }
        });
    }
    let (clock, timing) = if log.has_stamps { timing_from_stamps(&mut log) } else { timing_from_sentences(&mut log)? };
    let mut warnings = count_warnings(&counts, lines);
    warnings.extend(timing);
    let ChosenInstruments { mut series, warnings: choices, .. } = ChosenInstruments::from_instruments(&log.instruments);
    warnings.extend(choices);
    if series.is_empty() {
        return Err(ReadProblem::NoReadings { sentences: counts.sentences });
    }
    let clock = begin_at_zero(&mut series, clock);
    Ok((series, InstrumentLog { clock, warnings, rows: lines, sha256, ..InstrumentLog::default() }))
}

/// Shifts times so that the first instant is 0, and returns the clock at that instant.
fn begin_at_zero(series: &mut [Series], clock: Option<Clock>) -> Option<Clock> {
    let first = series.iter().filter_map(|series| series.time.first()).copied().fold(f64::INFINITY, f64::min);
    for series in series {
        series.time.iter_mut().for_each(|time| *time = rounded(*time - first));
    }
    let clock = clock?;
    let second = rounded(clock.second + first);
    let days = (second / SECONDS_PER_DAY).floor();
    Some(Clock {
        day: clock.day.map(|day| day + days as i64),
        second: second - days * SECONDS_PER_DAY,
        utc_offset_min: clock.utc_offset_min,
    })
}

/// Warnings of the omitted lines and of sentences without checksum.
fn count_warnings(counts: &LineCounts, lines: usize) -> Vec<Warning> {
    let LineCounts { text_lines: text, wrong_checksums: wrong, broken_sentences: broken, .. } = *counts;
    let hold = if text == 1 { "holds" } else { "hold" };
    let faults = [
        (wrong, format!("had a wrong checksum and {} left out", is_or_are(wrong))),
        (broken, format!("{} cut short or not text, and left out", is_or_are(broken))),
        (text, format!("{hold} no sentence and {} left out", is_or_are(text))),
    ];
    let faults = faults.into_iter().filter(|(number, _)| *number > 0);
    let texts = faults.map(|(number, fault)| format!("{number} of {} {fault}", counted(lines, "line")));
    let mut warnings: Vec<Warning> = texts.map(|text| WarningCode::LeftOut.warning(text)).collect();
    if counts.without_checksum > 0 {
        let number = counts.without_checksum;
        let (have, them) = if number == 1 { ("has", "it") } else { ("have", "them") };
        let sentences = counted(number, "sentence");
        let text = format!("{sentences} {have} no checksum; damage to {them} cannot be detected");
        warnings.push(WarningCode::NoChecksum.warning(text));
    }
    warnings
}
