//! Corrections of the rudder before it enters a record: the gaps of a rudder that the logger writes only when it
//! changes are filled, and a sidecar may declare a delay of the rudder, or the column as an order.

use document::{Warning, WarningCode};
use estimation::statistics::median;
use ship::angle::from_deg;

use super::assemble;
use super::source::Series;
use crate::channel::Channel;
use crate::record::Columns;

/// Limits for a rudder that the logger writes only when it changes: minimum number of readings, minimum number of long
/// gaps, and minimum length of a long gap in usual intervals.
const ON_CHANGE: (usize, usize, f64) = (20, 2, 5.0);

/// Minimum change of such a rudder, in at least 95 % of the intervals, as a share of its median change; noise has
/// smaller changes.
const MIN_CHANGE_SHARE: f64 = 0.3;

/// Maximum number of readings added in a gap.
const MAX_HELD_READINGS: f64 = 1000.0;

/// Fills the gaps of a rudder that the logger writes only when it changes: the last value is repeated at the usual
/// sampling period. Returns a warning; `None`, and no change, for any other rudder.
///
/// A rudder is written on change if no reading repeats the previous reading, if at most 5 % of the changes are below
/// [`MIN_CHANGE_SHARE`] of the median change, and if no change over a long gap exceeds twice the maximum change over a
/// shorter interval.
pub(super) fn repeat_held_rudder(columns: &mut Columns) -> Option<Warning> {
    let channel = [Channel::Rudder, Channel::RudderOrder].into_iter().find(|x| columns.channels.contains_key(x))?;
    let values = &columns.channels[&channel];
    let read: Vec<usize> = (0..values.len()).filter(|&row| values[row].is_finite()).collect();
    if read.len() < ON_CHANGE.0 {
        return None;
    }
    let steps = read.windows(2).map(|rows| (columns.time[rows[1]] - columns.time[rows[0]], rows));
    let steps: Vec<(f64, f64)> = steps.map(|(step, rows)| (step, (values[rows[1]] - values[rows[0]]).abs())).collect();
    let usual = median(&mut steps.iter().map(|(step, _)| *step).collect::<Vec<_>>())?;
    let is_rest = |(step, _): &&(f64, f64)| *step > ON_CHANGE.2 * usual;
    let largest = steps.iter().filter(|step| !is_rest(step)).map(|(_, change)| *change).fold(0.0, f64::max);
    let mut changes: Vec<f64> = steps.iter().map(|(_, change)| *change).collect();
    let typical = median(&mut changes)?;
    let small = changes.iter().filter(|change| **change < MIN_CHANGE_SHARE * typical).count();
    let rests: Vec<f64> = steps.iter().filter(is_rest).map(|(_, change)| *change).collect();
    let is_held = rests.len() >= ON_CHANGE.1 && rests.iter().all(|change| *change <= 2.0 * largest);
    let least = changes.iter().copied().fold(f64::INFINITY, f64::min);
    if least == 0.0 || 20 * small > changes.len() || !is_held {
        return None;
    }
    let mut all = assemble::split_columns(std::mem::take(columns), 0.0);
    for series in all.iter_mut().filter(|series| series.channel == channel) {
        let mut held = Series { time: Vec::new(), values: Vec::new(), ..series.clone() };
        for (index, (&time, &value)) in series.time.iter().zip(&series.values).enumerate() {
            held.time.push(time);
            held.values.push(value);
            let pause = series.time.get(index + 1).map_or(0.0, |next| next - time);
            let every = usual.max(pause / MAX_HELD_READINGS);
            let between =
                (1..).map(|step| time + every * f64::from(step)).take_while(|at| *at < time + pause - 0.5 * usual);
            let points: Vec<f64> = between.collect();
            held.values.extend(points.iter().map(|_| value));
            held.time.extend(points);
        }
        *series = held;
    }
    *columns = assemble::merge_series(&all);
    Some(WarningCode::FaultyReadings.warning(format!(
        "the {} is written on change: its empty cells are read as the last value; changes below {:.2}°, too small to be \
         written, are missing",
        channel.label(),
        least.to_degrees(),
    )))
}

/// Columns with every reading of rudder and rudder order `late` seconds earlier.
///
/// The rows are the instants of all readings of heading, yaw rate, rudder and order. A row has NaN in those of the four
/// channels that were not read at its instant; all other channels are interpolated.
pub(super) fn with_earlier_rudder(columns: Columns, late: f64) -> Columns {
    let mut all = assemble::split_columns(columns, 0.0);
    for rudder in all.iter_mut().filter(|series| matches!(series.channel, Channel::Rudder | Channel::RudderOrder)) {
        rudder.time.iter_mut().for_each(|time| *time -= late);
    }
    assemble::merge_series(&all)
}

/// Replaces the rudder angle by that of a gear that follows the order at a rate in deg/s; without an order the column
/// of the rudder counts as the order. `false`, and no change, without both.
pub(super) fn follow_order(columns: &mut Columns, rate: f64) -> bool {
    let Columns { time, channels, .. } = columns;
    let order = channels.get(&Channel::RudderOrder).or_else(|| channels.get(&Channel::Rudder)).cloned();
    let Some(order) = order else { return false };
    channels.insert(Channel::Rudder, following(time, &order, from_deg(rate)));
    channels.entry(Channel::RudderOrder).or_insert(order);
    true
}

/// Angle of a gear that follows an order at a constant rate (rad/s); an order that changes between two rows changes
/// half-way.
fn following(time: &[f64], order: &[f64], rate: f64) -> Vec<f64> {
    let mut last = order.iter().copied().find(|order| order.is_finite()).unwrap_or(f64::NAN);
    let mut angle = last;
    let mut angles = Vec::with_capacity(time.len());
    for row in 0..time.len() {
        let half = if row > 0 { 0.5 * rate * (time[row] - time[row - 1]) } else { 0.0 };
        angle += (last - angle).clamp(-half, half);
        last = if order[row].is_finite() { order[row] } else { last };
        angle += (last - angle).clamp(-half, half);
        angles.push(angle);
    }
    angles
}

#[cfg(test)]
mod tests {
    use ship::angle::to_deg;

    use super::*;

    #[test]
    fn a_late_rudder_is_taken_earlier_and_nothing_is_made_up_over_its_gaps() {
        let time: Vec<f64> = (0..40).map(f64::from).collect();
        let read = |t: &f64| if (10.0..30.0).contains(t) { f64::NAN } else { 2.0 * (t - 2.5) };
        let rudder = time.iter().map(read).collect();
        let channels = [(Channel::Heading, time.clone()), (Channel::Rudder, rudder)].into();
        let mut moved = with_earlier_rudder(Columns { time, channels, unknown_columns: Vec::new() }, 2.5);
        assemble::interpolate_rudder(&mut moved);
        for (t, angle) in moved.time.iter().zip(&moved.channels[&Channel::Rudder]) {
            assert!((angle - 2.0 * t).abs() < 1e-12, "{t} s: {angle}");
            assert!(!(6.5 < *t && *t < 27.5), "{t} s lies in the gap");
        }
        // From the first heading to the last rudder, with unchanged headings.
        assert_eq!((moved.time[0], moved.time[moved.time.len() - 1]), (-2.5, 36.5));
        assert!(moved.time.iter().zip(&moved.channels[&Channel::Heading]).all(|(t, psi)| psi.is_nan() || psi == t));
    }

    #[test]
    fn a_gear_follows_its_order() {
        let time: Vec<f64> = (0..8).map(f64::from).collect();
        let order = [0.0, 10.0, 10.0, 10.0, 10.0, f64::NAN, -10.0, -10.0].map(from_deg);
        let angle = following(&time, &order, from_deg(4.0)).into_iter().map(to_deg);
        let expected = [0.0, 2.0, 6.0, 10.0, 10.0, 10.0, 8.0, 4.0];
        assert!(angle.zip(expected).all(|(angle, expected)| (angle - expected).abs() < 1e-12));
    }
}
