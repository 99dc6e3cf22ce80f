//! When each sentence was sent. Sentences that carry UTC open epochs, or the stamps before sentences do; several
//! sentences of one instrument in an epoch are spread evenly over it. Time is never stretched: an epoch longer than
//! the others is filled at the usual pace, and the rest of it stays empty.

use document::{Code, Warning};
use estimation::statistics::upper_median;

use super::log::{NmeaInstrument, NmeaLog};
use super::sentence::Slot;
use crate::clock::{Clock, DAY, Stamp, Stamps};
use crate::reader::error::Problem;
use crate::words::counted;

/// An epoch longer than the usual one by this factor is a gap.
const GAP: f64 = 1.5;

/// Rows of one instrument in one epoch.
#[derive(Debug, Clone, Copy)]
struct Group {
    begin: usize,
    end: usize,
    /// Time of its begin, s.
    time: f64,
    /// Time to the next one, s.
    length: f64,
}

/// What the clock shows at time 0, and what was found remarkable of the instants.
type Timing = (Option<Clock>, Vec<Warning>);

/// Gives every sentence its instant where the time is in stamps before the sentences.
pub(super) fn from_stamps(log: &mut NmeaLog) -> Timing {
    let (mut spread, mut disordered) = (0, 0);
    for instrument in &mut log.instruments {
        let mut latest = f64::NEG_INFINITY;
        for at in instrument.at.iter_mut().filter(|at| at.is_finite()) {
            if *at < latest {
                *at = f64::NAN;
                disordered += 1;
            } else {
                latest = *at;
            }
        }
        drop_rows(instrument);
        spread += usize::from(spread_stamps(&mut instrument.at));
    }
    let neighbours = if log.counts.strayed == 1 { "its" } else { "their" };
    let mut warnings: Vec<Warning> = [
        (log.counts.strayed, format!("with a stamp far from {neighbours} neighbours")),
        (disordered, "with an earlier stamp than the one before of the same instrument".to_owned()),
        (log.counts.unstamped, "without a time stamp".to_owned()),
    ]
    .into_iter()
    .filter(|(number, _)| *number > 0)
    .map(|(number, fault)| format!("{} {fault} {} left out", counted(number, "sentence"), are(number)))
    .map(|text| Code::LeftOut.warning(text))
    .collect();
    if spread > 0 {
        let text = "several sentences of one instrument have the same time stamp; they are spread evenly over the time to \
                    the next stamp";
        warnings.push(Code::SharedStamps.warning(text));
    }
    (log.stamps.clock(), warnings)
}

/// Spreads sentences with the same stamp; whether there were such.
fn spread_stamps(at: &mut [f64]) -> bool {
    if at.windows(2).all(|pair| pair[0] < pair[1]) {
        return false;
    }
    let mut begins: Vec<usize> = (0..at.len()).filter(|&row| row == 0 || at[row] != at[row - 1]).collect();
    let times: Vec<f64> = begins.iter().map(|&row| at[row]).collect();
    let Some((lengths, usual)) = lengths(&times) else { return false };
    begins.push(at.len());
    let groups = begins.windows(2).zip(times.into_iter().zip(lengths));
    let groups = groups.map(|(pair, (time, length))| Group { begin: pair[0], end: pair[1], time, length });
    spread(at, &groups.collect::<Vec<_>>(), usual)
}

/// Times from each of some instants to the next, the last as long as the one before, and the usual one; `None` for
/// fewer than two.
fn lengths(times: &[f64]) -> Option<(Vec<f64>, f64)> {
    let mut lengths: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    lengths.push(*lengths.last()?);
    let usual = upper_median(lengths.iter().copied())?;
    Some((lengths, usual))
}

/// Gives every sentence its instant where the time is in some of the sentences.
///
/// Fails without at least two different times, and where they go back for more than one sentence.
pub(super) fn from_sentences(log: &mut NmeaLog) -> Result<Timing, Problem> {
    let times = |own: &NmeaInstrument| own.place(Slot::Second).map_or(0, |place| own.readings(place));
    let rank =
        |own: &NmeaInstrument| [b"ZDA", b"RMC", b"GGA", b"GLL"].into_iter().position(|formatter| own.sends(formatter));
    let clocks = log.instruments.iter().filter(|own| times(own) > 0);
    let none = |clocks| Problem::NoClock { sentences: log.counts.sentences, clocks };
    let driver = clocks.min_by_key(|own| (std::cmp::Reverse(times(own)), rank(own))).ok_or_else(|| none(0))?;
    let (name, driven) = (driver.name.clone(), times(driver));
    let (epochs, mut clock, strayed) = epochs(driver)?;
    let times_of_epochs: Vec<f64> = epochs.iter().map(|epoch| epoch.time).collect();
    let (lengths, usual) = lengths(&times_of_epochs).ok_or_else(|| none(epochs.len()))?;
    if clock.day.is_none() {
        clock.day = log.instruments.iter().find_map(|instrument| first_day(instrument, &epochs, clock.second));
    }
    let (mut several, mut before) = (false, 0);
    let mut groups = Vec::new();
    for instrument in &mut log.instruments {
        groups.clear();
        let mut row = instrument.at.partition_point(|&line| line < epochs[0].line);
        before += row;
        instrument.at[..row].fill(f64::NAN);
        for (place, epoch) in epochs.iter().enumerate() {
            let begin = row;
            let until = epochs.get(place + 1).map_or(f64::INFINITY, |next| next.line);
            row += instrument.at[row..].iter().take_while(|&&line| line < until).count();
            if row > begin {
                groups.push(Group { begin, end: row, time: epoch.time, length: lengths[place] });
            }
        }
        several |= spread(&mut instrument.at, &groups, usual);
        drop_rows(instrument);
    }
    let mut warnings = vec![Code::Clock.warning(format!(
        "the time is that of {name} ({driven} times, every {usual:.1} s): a sentence has the time before it, and heading and \
         rudder may be apart by that much{}",
        if several { ", and sentences between two of them are spread evenly over the time between" } else { "" }
    ))];
    if before > 0 {
        let text = format!("{} before the first time {} left out", counted(before, "sentence"), are(before));
        warnings.push(Code::LeftOut.warning(text));
    }
    if strayed > 0 {
        let text = format!("{} of {name} far from its neighbours left out", counted(strayed, "time"));
        warnings.push(Code::LeftOut.warning(text));
    }
    Ok((Some(clock), warnings))
}

/// One time of the clock.
#[derive(Debug, Clone, Copy)]
struct Epoch {
    line: f64,
    time: f64,
}

/// The times of one instrument, strictly increasing, what the clock shows at time 0, and times that were left out.
fn epochs(instrument: &NmeaInstrument) -> Result<(Vec<Epoch>, Clock, usize), Problem> {
    let second = &instrument.columns[instrument.place(Slot::Second).expect("only instruments with times are asked")];
    let days = instrument.place(Slot::Day).map(|place| &instrument.columns[place]);
    // Dates that are there at times only would be mixed with times of day alone.
    let dated = days.filter(|days| second.iter().zip(*days).all(|(second, day)| second.is_nan() || day.is_finite()));
    let mut stamps = Stamps::default();
    let read = |row: usize| {
        let stamp = Stamp::of(dated.map(|days| days[row] as i64), second[row]);
        stamps.seconds(stamp).ok().map(|time| Epoch { line: instrument.at[row], time: rounded(time) })
    };
    let all: Vec<Epoch> = (0..second.len()).filter(|&row| second[row].is_finite()).filter_map(read).collect();
    let clock = stamps.clock().expect("there is a time, and each has a second");
    let mut kept: Vec<Epoch> = Vec::with_capacity(all.len());
    let mut strayed = 0;
    for (place, &epoch) in all.iter().enumerate() {
        let Some(&last) = kept.last() else {
            kept.push(epoch);
            continue;
        };
        if epoch.time > last.time {
            kept.push(epoch);
        } else if epoch.time < last.time {
            let next = all.get(place + 1);
            strayed += 1;
            if next.is_none_or(|next| next.time >= last.time) {
                continue;
            }
            let ahead = kept.len() == 1 || epoch.time >= kept[kept.len() - 2].time;
            if !ahead || next.is_some_and(|next| next.time < epoch.time) {
                let line = epoch.line as usize;
                return Err(Problem::ClockBack { line, before: clock.at(last.time), found: clock.at(epoch.time) });
            }
            // The one before was ahead of its time.
            kept.pop();
            if kept.last().is_none_or(|last| last.time < epoch.time) {
                kept.push(epoch);
            }
        }
    }
    Ok((kept, clock, strayed))
}

/// The day at time 0, from the first date of an instrument; `second` is what the clock shows then.
fn first_day(instrument: &NmeaInstrument, epochs: &[Epoch], second: f64) -> Option<i64> {
    let (seconds, days) = (instrument.place(Slot::Second)?, instrument.place(Slot::Day)?);
    let (seconds, days) = (&instrument.columns[seconds], &instrument.columns[days]);
    let row = (0..seconds.len()).find(|&row| seconds[row].is_finite() && days[row].is_finite())?;
    let epoch = epochs.partition_point(|epoch| epoch.line <= instrument.at[row]).saturating_sub(1);
    let passed = (second + epochs[epoch].time - seconds[row]) / DAY;
    Some(days[row] as i64 - passed.round() as i64)
}

/// Spreads the rows of every group over it; whether a group had several.
///
/// The k-th of n rows comes k/n of the time to the next group after its begin, and in a group longer than usual no
/// slower than in the others.
fn spread(at: &mut [f64], groups: &[Group], usual: f64) -> bool {
    let normal = groups.iter().filter(|group| group.length <= GAP * usual);
    let (time, rows) =
        normal.fold((0.0, 0), |(time, rows), group| (time + group.length, rows + group.end - group.begin));
    let pace = if rows > 0 { time / rows as f64 } else { f64::INFINITY };
    let mut several = false;
    for group in groups {
        let rows = group.end - group.begin;
        let own = group.length / rows as f64;
        let step = if group.length <= GAP * usual { own } else { own.min(pace) };
        for (k, at) in at[group.begin..group.end].iter_mut().enumerate() {
            *at = group.time + k as f64 * step;
        }
        several |= rows > 1;
    }
    several
}

/// Takes the rows without an instant out of the table of an instrument.
fn drop_rows(instrument: &mut NmeaInstrument) {
    if instrument.at.iter().all(|at| at.is_finite()) {
        return;
    }
    for column in &mut instrument.columns {
        let mut at = instrument.at.iter();
        column.retain(|_| at.next().is_some_and(|at| at.is_finite()));
    }
    instrument.at.retain(|at| at.is_finite());
}

/// Seconds to the microsecond: finer than any clock here, and without what subtracting large numbers leaves.
pub(super) fn rounded(time: f64) -> f64 {
    (time * 1e6).round() / 1e6
}

pub(super) fn are(number: usize) -> &'static str {
    if number == 1 { "is" } else { "are" }
}
