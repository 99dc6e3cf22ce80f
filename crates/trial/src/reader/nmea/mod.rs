//! A log of NMEA 0183 sentences becomes [`Series`]: every quantity that is used at the instants its instrument
//! sent it. Headings, rudder angles and orders, yaw rate, speeds, position, propeller and wind are read; AIS and the
//! sentences of single makers are passed over. Time comes from stamps before the sentences, or from the sentences of a
//! GPS or clock. What is damaged is left out and counted; a course over ground never stands for a heading. Whether
//! heading and rudder are enough for a record is not decided here: they may lie in two files.

mod choice;
mod epochs;
mod frame;
mod log;
mod sentence;
mod stamp;
#[cfg(test)]
mod tests;

use std::io::Read;

use document::{Code, Warning};

use self::choice::Choice;
use self::epochs::{are, from_sentences, from_stamps, rounded};
use self::frame::{Line, frame};
use self::log::{Counts, NmeaLog};
use self::stamp::Leading;
use super::error::Problem;
use super::lines::Lines;
use super::source::{Log, Series};
use crate::clock::{Clock, DAY};
use crate::words::counted;

/// Sentences that show whether a log has stamps.
const LOOKED_AT: usize = 64;
/// Lines among which they are looked for.
const FIRST_LINES: usize = 1024;

/// Whether a line is a sentence, or carries one behind a leading stamp.
pub(super) fn is_sentence(line: &str) -> bool {
    let address = |rest: &[u8], letters: usize| {
        rest.get(letters) == Some(&b',')
            && rest[..letters].iter().all(|byte| byte.is_ascii_uppercase() || byte.is_ascii_digit())
    };
    let bytes = line.as_bytes();
    let Some(start) = bytes.iter().position(|&byte| matches!(byte, b'$' | b'!')) else { return false };
    let rest = &bytes[start + 1..];
    let of_maker = bytes[start] == b'$' && rest.first() == Some(&b'P') && (4..10).any(|letters| address(rest, letters));
    !line.trim_start().starts_with('#') && (address(rest, 5) || of_maker)
}

/// Reads the whole log: one series for each channel, and a log that has no columns yet.
///
/// Fails where more than half of its lines are damaged, where there is no time or it goes back, where dates may be read
/// in two ways, and where no sentence gives a quantity that is used.
pub(super) fn read<R: Read>(mut lines: Lines<R>) -> Result<(Vec<Series>, Log), Problem> {
    let (mut begin, mut sentences) = (Vec::new(), 0);
    while sentences < LOOKED_AT
        && begin.len() < FIRST_LINES
        && let Some(line) = lines.next_bytes()?
    {
        sentences += usize::from(matches!(frame(line), Line::Sentence(_)));
        begin.push(line.to_vec());
    }
    let mut log = NmeaLog::new(is_stamped(&begin));
    for (place, line) in begin.iter().enumerate() {
        log.take(line, place + 1)?;
    }
    drop(begin);
    loop {
        // The line borrows its source: hence the detour over `number`.
        let number = lines.number() + 1;
        let Some(line) = lines.next_bytes()? else { break };
        log.take(line, number)?;
    }
    let number = lines.number();
    finish(log, number, lines.sha256())
}

/// Whether at least half of the sentences have a stamp before them.
fn is_stamped(lines: &[Vec<u8>]) -> bool {
    let mut leading = Leading::default();
    let (mut sentences, mut stamps) = (0, 0);
    for line in lines {
        if let Line::Sentence(frame) = frame(line) {
            sentences += 1;
            stamps += usize::from(leading.read(frame.before).0.is_some());
        }
    }
    stamps > 0 && 2 * stamps >= sentences
}

/// Makes channels of all that was read.
fn finish(mut log: NmeaLog, lines: usize, sha256: String) -> Result<(Vec<Series>, Log), Problem> {
    let counts = log.counts;
    let written = lines - counts.blank;
    let damaged = counts.wrong + counts.broken;
    if 2 * damaged > written {
        return Err(Problem::DamagedLog { lines: written, damaged, wrong: counts.wrong, broken: counts.broken });
    }
    if log.instruments.is_empty() {
        return Err(if counts.unstamped > 0 {
            Problem::NoClock { sentences: counts.sentences, clocks: 0 }
        } else {
            Problem::NoReadings { sentences: counts.sentences }
        });
    }
    let (clock, timing) = if log.stamped { from_stamps(&mut log) } else { from_sentences(&mut log)? };
    let mut warnings = of_counts(&counts, lines);
    warnings.extend(timing);
    let Choice { mut series, warnings: choices, .. } = Choice::of(&log.instruments);
    warnings.extend(choices);
    if series.is_empty() {
        return Err(Problem::NoReadings { sentences: counts.sentences });
    }
    let clock = begin_at_zero(&mut series, clock);
    Ok((series, Log { clock, warnings, rows: lines, sha256, ..Log::default() }))
}

/// Makes the first instant time 0.
fn begin_at_zero(series: &mut [Series], clock: Option<Clock>) -> Option<Clock> {
    let first = series.iter().filter_map(|series| series.time.first()).copied().fold(f64::INFINITY, f64::min);
    for series in series {
        series.time.iter_mut().for_each(|time| *time = rounded(*time - first));
    }
    let clock = clock?;
    let second = rounded(clock.second + first);
    let days = (second / DAY).floor();
    Some(Clock { day: clock.day.map(|day| day + days as i64), second: second - days * DAY, zone: clock.zone })
}

/// What was left out.
fn of_counts(counts: &Counts, lines: usize) -> Vec<Warning> {
    let hold = if counts.text == 1 { "holds" } else { "hold" };
    let faults = [
        (counts.wrong, format!("had a wrong checksum and {} left out", are(counts.wrong))),
        (counts.broken, format!("{} cut short or not text, and left out", are(counts.broken))),
        (counts.text, format!("{hold} no sentence and {} left out", are(counts.text))),
    ];
    let found = faults.into_iter().filter(|(number, _)| *number > 0);
    let told = found.map(|(number, fault)| format!("{number} of {} {fault}", counted(lines, "line")));
    let mut warnings: Vec<Warning> = told.map(|text| Code::LeftOut.warning(text)).collect();
    if counts.unsummed > 0 {
        let number = counts.unsummed;
        let (have, them) = if number == 1 { ("has", "it") } else { ("have", "them") };
        let sentences = counted(number, "sentence");
        let text = format!("{sentences} {have} no checksum, so damage to {them} would not be seen");
        warnings.push(Code::NoChecksum.warning(text));
    }
    warnings
}
