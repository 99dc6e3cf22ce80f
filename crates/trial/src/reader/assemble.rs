//! Assembly of channels with different sampling instants into the columns of a record. A row is an instant with a
//! reading of heading, rudder, order or yaw rate; a channel without a reading at this instant is missing in the row.
//! The rudder is interpolated linearly between its readings, as the steering gear moves; so are model inputs such as
//! speed and wind. Gaps are not interpolated.

use document::{Warning, WarningCode};

use super::error::ReadProblem;
use super::source::Series;
use crate::channel::Channel;
use crate::cleaning::interpolate_rows;
use crate::record::Columns;
use crate::wording::counted;
use estimation::statistics::upper_median;

/// Maximum interval between two readings for interpolation, usual intervals.
const MAX_INTERVAL: f64 = 3.0;

/// Maximum share of omitted rows without a warning of a gap.
const MAX_LEFT_OUT_SHARE: f64 = 0.2;

/// Tolerance of equal instants, s.
const TIME_TOLERANCE: f64 = 1e-6;

/// Observed channels: the instants of their readings are the rows.
const OBSERVED: [Channel; 4] = [Channel::Heading, Channel::Rudder, Channel::RudderOrder, Channel::YawRate];

/// Columns of series with different instants; rows are the union of the instants of the observed channels.
pub(super) fn merge_series(series: &[Series]) -> Columns {
    let is_observed = |series: &&Series| OBSERVED.contains(&series.channel);
    let mut time: Vec<f64> = series.iter().filter(is_observed).flat_map(|series| series.time.iter().copied()).collect();
    time.sort_unstable_by(f64::total_cmp);
    time.dedup_by(|later, earlier| *later - *earlier < TIME_TOLERANCE);
    let channels = series.iter().map(|series| (series.channel, at_rows(series, &time))).collect();
    Columns { time, channels, unknown_columns: Vec::new() }
}

/// Values of a channel at the rows: its readings, and those of a model input also interpolated between them.
fn at_rows(series: &Series, time: &[f64]) -> Vec<f64> {
    let mut values = vec![f64::NAN; time.len()];
    if OBSERVED.contains(&series.channel) {
        let mut row = 0;
        for (&instant, &value) in series.time.iter().zip(&series.values) {
            while row + 1 < time.len() && time[row] < instant - TIME_TOLERANCE {
                row += 1;
            }
            if (time[row] - instant).abs() <= TIME_TOLERANCE {
                values[row] = value;
            }
        }
        return values;
    }
    let longest = MAX_INTERVAL * usual_interval(&series.time).unwrap_or(f64::INFINITY);
    let mut next = 0;
    for (value, &instant) in values.iter_mut().zip(time) {
        while next < series.time.len() && series.time[next] < instant {
            next += 1;
        }
        if next < series.time.len() && series.time[next] - instant <= TIME_TOLERANCE {
            *value = series.values[next];
        } else if next > 0 && next < series.time.len() && series.time[next] - series.time[next - 1] <= longest {
            let share = (instant - series.time[next - 1]) / (series.time[next] - series.time[next - 1]);
            let (from, to) = (series.values[next - 1], series.values[next]);
            let change = if is_direction(series.channel) { wrapped(to - from) } else { to - from };
            *value = from + share * change;
        }
    }
    values
}

fn is_direction(channel: Channel) -> bool {
    matches!(channel, Channel::WindRelativeFrom | Channel::WindTrueFrom)
}

/// Angle wrapped to −π to π, rad.
fn wrapped(turn: f64) -> f64 {
    turn - (turn / std::f64::consts::TAU).round() * std::f64::consts::TAU
}

/// Median time between instants, s; `None` for fewer than two instants.
fn usual_interval(time: &[f64]) -> Option<f64> {
    upper_median(time.windows(2).map(|pair| pair[1] - pair[0]))
}

/// Readings of the channels of a table, without its unknown columns; `offset` (s) is added to their times.
pub(super) fn split_columns(columns: Columns, offset: f64) -> Vec<Series> {
    let Columns { time, channels, .. } = columns;
    let readings = |(channel, values): (Channel, Vec<f64>)| {
        let (time, values) = time
            .iter()
            .zip(values)
            .filter(|(_, value)| value.is_finite())
            .map(|(t, value)| (t + offset, value))
            .unzip();
        Series { channel, time, values, source: None }
    };
    channels.into_iter().map(readings).collect()
}

/// Adds channels that were not recorded: the speed from surge and sway, and the rudder order as the rudder angle.
/// Returns a warning if the order replaces the angle, else `None`.
pub(super) fn add_derived_channels(columns: &mut Columns) -> Option<Warning> {
    let channels = &mut columns.channels;
    if !channels.contains_key(&Channel::Speed)
        && let (Some(surge), Some(sway)) = (channels.get(&Channel::Surge), channels.get(&Channel::Sway))
    {
        let speed = surge.iter().zip(sway).map(|(u, v)| u.hypot(*v)).collect();
        channels.insert(Channel::Speed, speed);
    }
    if channels.contains_key(&Channel::Rudder) {
        return None;
    }
    let order = channels.get(&Channel::RudderOrder)?.clone();
    channels.insert(Channel::Rudder, order);
    Some(WarningCode::RudderOrder.warning(
        "there is no rudder angle; the rudder order is used instead, so the lag of the steering gear is part of the response",
    ))
}

/// Interpolates missing rudder angles between two readings without a gap, and omits the rows in gaps. Returns the
/// warning; `None`, and no change, if no angle is missing or fewer than two are recorded.
pub(super) fn interpolate_rudder(columns: &mut Columns) -> Option<Warning> {
    let time = &columns.time;
    let rudder = columns.channels.get_mut(&Channel::Rudder)?;
    let read: Vec<usize> = (0..rudder.len()).filter(|&row| rudder[row].is_finite()).collect();
    if read.len() == rudder.len() || read.is_empty() {
        return None;
    }
    let instants: Vec<f64> = read.iter().map(|&row| time[row]).collect();
    let longest = MAX_INTERVAL * usual_interval(&instants)? + TIME_TOLERANCE;
    let mut filled = 0;
    for pair in read.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        if time[to] - time[from] <= longest {
            interpolate_rows(time, rudder, from, to);
            filled += to - from - 1;
        }
    }
    let keep: Vec<bool> = rudder.iter().map(|delta| delta.is_finite()).collect();
    let left_out = keep.iter().filter(|keep| !**keep).count();
    columns.retain(&keep);
    let notes = [
        (filled, "without rudder angle, which is interpolated between its readings"),
        (left_out, "without rudder angle left out, in a gap of its readings"),
    ];
    let notes = notes.into_iter().filter(|(count, _)| *count > 0);
    let notes = notes.map(|(count, text)| format!("{} {text}", counted(count, "row"))).collect::<Vec<_>>();
    // If many rows are omitted, the movement of the rudder is unknown.
    let code =
        if left_out as f64 > MAX_LEFT_OUT_SHARE * keep.len() as f64 { WarningCode::Gap } else { WarningCode::LeftOut };
    Some(code.warning(notes.join("; ")))
}

/// Refuses channels without rudder or heading, and channels whose readings do not overlap in time.
pub(super) fn check_channels(columns: &Columns) -> Result<(), ReadProblem> {
    let Columns { time, channels, .. } = columns;
    let find = |wanted: [Channel; 2]| wanted.into_iter().find_map(|channel| channels.get(&channel));
    let rudder = find([Channel::Rudder, Channel::RudderOrder]);
    let heading = find([Channel::Heading, Channel::YawRate]);
    let (Some(rudder), Some(heading)) = (rudder, heading) else {
        let wanted = if rudder.is_none() { "rudder angle" } else { "heading and no yaw rate" };
        let channels = channels.keys().map(|&channel| channel.label().to_owned()).collect();
        return Err(ReadProblem::NoChannel { wanted, channels });
    };
    let span = |values: &[f64]| {
        let first = values.iter().position(|value| value.is_finite())?;
        let last = values.iter().rposition(|value| value.is_finite())?;
        Some([time[first], time[last]])
    };
    match (span(rudder), span(heading)) {
        (Some(rudder_s), Some(heading_s)) if rudder_s[0] > heading_s[1] || heading_s[0] > rudder_s[1] => {
            Err(ReadProblem::NoOverlap { rudder_s, heading_s })
        }
        _ => Ok(()),
    }
}

/// First series of each channel, in the order of the files, and the channels of the series that are dropped.
pub(super) fn without_duplicates(all: Vec<Series>) -> (Vec<Series>, Vec<Channel>) {
    let (mut kept, mut dropped): (Vec<Series>, Vec<Channel>) = Default::default();
    for series in all {
        match kept.iter().any(|earlier| earlier.channel == series.channel) {
            true => dropped.push(series.channel),
            false => kept.push(series),
        }
    }
    (kept, dropped)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series_of(channel: Channel, first: f64, step: f64, count: usize, value: impl Fn(f64) -> f64) -> Series {
        let time: Vec<f64> = (0..count).map(|k| first + step * k as f64).collect();
        let values = time.iter().map(|&t| value(t)).collect();
        Series { channel, time, values, source: None }
    }

    #[test]
    fn channels_keep_their_own_instants() {
        let heading = series_of(Channel::Heading, 0.0, 0.5, 21, |t| t);
        let rudder = series_of(Channel::Rudder, 0.2, 1.0, 10, |t| 2.0 * t);
        let speed = series_of(Channel::Speed, -1.0, 2.0, 8, |t| 3.0 * t);
        let mut columns = merge_series(&[heading, rudder, speed]);
        assert_eq!(columns.time[..4], [0.0, 0.2, 0.5, 1.0]);
        let text = interpolate_rudder(&mut columns).expect("rows were filled").text;
        assert!(text.contains("is interpolated between its readings"), "{text}");
        // From the first to the last reading of the rudder.
        assert_eq!((columns.time[0], columns.time[columns.time.len() - 1]), (0.2, 9.2));
        for (row, &t) in columns.time.iter().enumerate() {
            approx::assert_relative_eq!(columns.channels[&Channel::Rudder][row], 2.0 * t, max_relative = 1e-12);
            approx::assert_relative_eq!(columns.channels[&Channel::Speed][row], 3.0 * t, max_relative = 1e-12);
            let psi = columns.channels[&Channel::Heading][row];
            assert!(psi == t || psi.is_nan());
        }
        let read = columns.channels[&Channel::Heading].iter().filter(|psi| psi.is_finite()).count();
        assert_eq!(read, 18);
    }

    #[test]
    fn nothing_is_made_up_over_a_gap() {
        let heading = series_of(Channel::Heading, 0.0, 1.0, 100, |t| t);
        let mut rudder = series_of(Channel::Rudder, 0.0, 1.0, 100, |t| t);
        rudder.time.drain(40..50);
        rudder.values.drain(40..50);
        let mut columns = merge_series(&[heading, rudder]);
        let text = interpolate_rudder(&mut columns).expect("rows were left out").text;
        assert!(text.starts_with("10 rows without rudder angle left out"), "{text}");
        assert_eq!(columns.time.len(), 90);
    }
}
