//! Instants of sentences. Epochs begin at sentences with UTC, or at the stamps before sentences; several sentences of
//! an instrument in an epoch are spread evenly over it. Time is never stretched: an epoch longer than usual is
//! filled at the usual pace, and its end stays empty.

use document::{Warning, WarningCode};
use estimation::statistics::upper_median;

use super::log::{NmeaInstrument, NmeaLog};
use super::sentence::NmeaQuantity;
use crate::clock::{Clock, SECONDS_PER_DAY, StampConverter, TimeStamp};
use crate::reader::error::ReadProblem;
use crate::wording::counted;

/// Minimum length of a gap, usual epochs.
const GAP_EPOCHS: f64 = 1.5;

/// Rows of an instrument in an epoch.
#[derive(Debug, Clone, Copy)]
struct Group {
    begin: usize,
    end: usize,
    /// Time of the beginning, s.
    time: f64,
    /// Time to the next epoch, s.
    length: f64,
}

/// Clock at time 0, and warnings of the instants.
type Timing = (Option<Clock>, Vec<Warning>);

/// Instants of a log with stamps before the sentences.
pub(super) fn timing_from_stamps(log: &mut NmeaLog) -> Timing {
    let (mut spread, mut disordered) = (0, 0);
    for instrument in &mut log.instruments {
        let mut latest = f64::NEG_INFINITY;
        for at in instrument.instants.iter_mut().filter(|at| at.is_finite()) {
            if *at < latest {
                *at = f64::NAN;
                disordered += 1;
            } else {
                latest = *at;
            }
        }
        drop_rows(instrument);
        spread += usize::from(spread_stamps(&mut instrument.instants));
    }
    let neighbours = if log.counts.stray_stamps == 1 { "its" } else { "their" };
    let mut warnings: Vec<Warning> = [
        (log.counts.stray_stamps, format!("with a stamp far from {neighbours} neighbours")),
        (disordered, "with an earlier stamp than the sentence before of the same instrument".to_owned()),
        (log.counts.without_stamp, "without a time stamp".to_owned()),
    ]
    .into_iter()
    .filter(|(number, _)| *number > 0)
    .map(|(number, fault)| format!("{} {fault} {} left out", counted(number, "sentence"), is_or_are(number)))
    .map(|text| WarningCode::LeftOut.warning(text))
    .collect();
    if spread > 0 {
        let text = "several sentences of an instrument have the same time stamp; they are spread evenly over the time to \
                    the next stamp";
        warnings.push(WarningCode::SharedStamps.warning(text));
    }
    (log.stamps.clock(), warnings)
}

/// Spreads sentences with the same stamp; `true` if there are any.
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

/// Intervals from each instant to the next (the last interval is repeated), and their median; `None` for fewer
/// than two instants.
fn lengths(times: &[f64]) -> Option<(Vec<f64>, f64)> {
    let mut lengths: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    lengths.push(*lengths.last()?);
    let usual = upper_median(lengths.iter().copied())?;
    Some((lengths, usual))
}

/// Instants of a log whose time is in its sentences.
///
/// Fails without at least two different times, and if they decrease for more than one sentence.
pub(super) fn timing_from_sentences(log: &mut NmeaLog) -> Result<Timing, ReadProblem> {
    let times = |clock: &NmeaInstrument| clock.column(NmeaQuantity::Second).map_or(0, |column| clock.readings(column));
    let rank = |clock: &NmeaInstrument| [b"ZDA", b"RMC", b"GGA", b"GLL"].into_iter().position(|code| clock.sends(code));
    let clocks = log.instruments.iter().filter(|instrument| times(instrument) > 0);
    let none = |clocks| ReadProblem::NoClock { sentences: log.counts.sentences, clocks };
    let driver = clocks.min_by_key(|clock| (std::cmp::Reverse(times(clock)), rank(clock))).ok_or_else(|| none(0))?;
    let (name, driven) = (driver.name.clone(), times(driver));
    let (epochs, mut clock, strayed) = epochs(driver)?;
    let epoch_times: Vec<f64> = epochs.iter().map(|epoch| epoch.time).collect();
    let (lengths, usual) = lengths(&epoch_times).ok_or_else(|| none(epochs.len()))?;
    if clock.day.is_none() {
        clock.day = log.instruments.iter().find_map(|instrument| first_day(instrument, &epochs, clock.second));
    }
    let (mut several, mut before) = (false, 0);
    let mut groups = Vec::new();
    for instrument in &mut log.instruments {
        groups.clear();
        let mut row = instrument.instants.partition_point(|&line| line < epochs[0].line);
        before += row;
        instrument.instants[..row].fill(f64::NAN);
        for (place, epoch) in epochs.iter().enumerate() {
            let begin = row;
            let until = epochs.get(place + 1).map_or(f64::INFINITY, |next| next.line);
            row += instrument.instants[row..].iter().take_while(|&&line| line < until).count();
            if row > begin {
                groups.push(Group { begin, end: row, time: epoch.time, length: lengths[place] });
            }
        }
        several |= spread(&mut instrument.instants, &groups, usual);
        drop_rows(instrument);
    }
    let mut warnings = vec![WarningCode::Clock.warning(format!(
        "the clock is {name} ({driven} times, every {usual:.1} s): each sentence gets the time before it, so heading and \
         rudder may be off by that much{}",
        if several { "; sentences between two times are spread evenly" } else { "" }
    ))];
    if before > 0 {
        let text = format!("{} before the first time {} left out", counted(before, "sentence"), is_or_are(before));
        warnings.push(WarningCode::LeftOut.warning(text));
    }
    if strayed > 0 {
        let text = format!("{} of {name} far from its neighbours left out", counted(strayed, "time"));
        warnings.push(WarningCode::LeftOut.warning(text));
    }
    Ok((Some(clock), warnings))
}

/// Time of the clock, s, with its line.
#[derive(Debug, Clone, Copy)]
struct Epoch {
    line: f64,
    time: f64,
}

/// Strictly increasing times of an instrument, the clock at time 0, and the number of omitted times.
fn epochs(instrument: &NmeaInstrument) -> Result<(Vec<Epoch>, Clock, usize), ReadProblem> {
    let second =
        &instrument.columns[instrument.column(NmeaQuantity::Second).expect("only instruments with times are asked")];
    let days = instrument.column(NmeaQuantity::Day).map(|column| &instrument.columns[column]);
    // Dates are used only if every time has one.
    let dated = days.filter(|days| second.iter().zip(*days).all(|(second, day)| second.is_nan() || day.is_finite()));
    let mut stamps = StampConverter::default();
    let read = |row: usize| {
        let stamp = TimeStamp::new(dated.map(|days| days[row] as i64), second[row]);
        stamps.seconds(stamp).ok().map(|time| Epoch { line: instrument.instants[row], time: rounded(time) })
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
                return Err(ReadProblem::ClockBack {
                    line,
                    before: clock.time_of_day_at(last.time),
                    after: clock.time_of_day_at(epoch.time),
                });
            }
            // The previous time was too late.
            kept.pop();
            if kept.last().is_none_or(|last| last.time < epoch.time) {
                kept.push(epoch);
            }
        }
    }
    Ok((kept, clock, strayed))
}

/// Day at time 0, from the first date of an instrument; `second` is the second of the day at time 0. `None` for an
/// instrument without dates.
fn first_day(instrument: &NmeaInstrument, epochs: &[Epoch], second: f64) -> Option<i64> {
    let (seconds, days) = (instrument.column(NmeaQuantity::Second)?, instrument.column(NmeaQuantity::Day)?);
    let (seconds, days) = (&instrument.columns[seconds], &instrument.columns[days]);
    let row = (0..seconds.len()).find(|&row| seconds[row].is_finite() && days[row].is_finite())?;
    let epoch = epochs.partition_point(|epoch| epoch.line <= instrument.instants[row]).saturating_sub(1);
    let passed = (second + epochs[epoch].time - seconds[row]) / SECONDS_PER_DAY;
    Some(days[row] as i64 - passed.round() as i64)
}

/// Spreads the rows of every group over its epoch; `true` if a group has several rows.
///
/// The k-th of n rows is k/n of the epoch after its beginning; in a gap the rows follow at the usual pace.
fn spread(at: &mut [f64], groups: &[Group], usual: f64) -> bool {
    let normal = groups.iter().filter(|group| group.length <= GAP_EPOCHS * usual);
    let (time, rows) =
        normal.fold((0.0, 0), |(time, rows), group| (time + group.length, rows + group.end - group.begin));
    let pace = if rows > 0 { time / rows as f64 } else { f64::INFINITY };
    let mut several = false;
    for group in groups {
        let rows = group.end - group.begin;
        let even = group.length / rows as f64;
        let step = if group.length <= GAP_EPOCHS * usual { even } else { even.min(pace) };
        for (k, at) in at[group.begin..group.end].iter_mut().enumerate() {
            *at = group.time + k as f64 * step;
        }
        several |= rows > 1;
    }
    several
}

/// Removes the rows without an instant from the table of an instrument.
fn drop_rows(instrument: &mut NmeaInstrument) {
    if instrument.instants.iter().all(|at| at.is_finite()) {
        return;
    }
    for column in &mut instrument.columns {
        let mut at = instrument.instants.iter();
        column.retain(|_| at.next().is_some_and(|at| at.is_finite()));
    }
    instrument.instants.retain(|at| at.is_finite());
}

/// Seconds rounded to the microsecond: finer than the clocks, and without the rounding errors of large numbers.
pub(super) fn rounded(time: f64) -> f64 {
    (time * 1e6).round() / 1e6
}

pub(super) fn is_or_are(number: usize) -> &'static str {
    if number == 1 { "is" } else { "are" }
}
