//! Faults of an instrument: a noisy channel that is clipped at the end of its scale or frozen, and a channel in coarse
//! steps.

use std::ops::Range;

use document::{Warning, WarningCode};

use super::extremes;
use crate::channel::Channel;
use crate::record::Trial;
use crate::wording::{counted, rounded_to_thousandth, shortened};
use crate::zigzag::quantum;

/// Minimum number of rows with one value that noise does not repeat.
const MIN_STILL_ROWS: usize = 20;

/// Maximum probability that noise repeats a value over as many rows somewhere in the record.
const MAX_CHANCE: f64 = 1e-6;

/// Minimum share and number of immediate reversals by more than a digit in a noisy channel. A helmsman
/// reverses later, and a channel between two digits reverses by a digit.
const MIN_NOISY: (f64, usize) = (0.08, 10);

/// Minimum noise of a noisy channel, deg.
const MIN_NOISE_DEG: f64 = 0.03;

/// Minimum step of a coarse scale, deg; usual digits of rudder and heading are finer.
const MIN_COARSE_STEP_DEG: f64 = 1.5;

/// Minimum number of changes to the next value of a coarse scale, and their minimum share: an order has larger changes.
const MIN_NEXT: (usize, f64) = (8, 0.6);

/// Minimum number of values of a coarse scale: an order has three values.
const MIN_VALUES: usize = 5;

/// Minimum number of pauses within movements, and their minimum share of the changes: a rudder of constant rate, read
/// evenly, changes in every row.
const MIN_PAUSES: (usize, f64) = (3, 0.06);

/// Warnings of channels that are clipped, frozen or coarse; `columns` are their names in the file.
pub(crate) fn reading_warnings(trial: &Trial, columns: &[(Channel, String)]) -> Vec<Warning> {
    let angles = [Channel::Rudder, Channel::Heading];
    let warnings = angles.into_iter().flat_map(|channel| {
        let values = if channel == Channel::Rudder { trial.rudder() } else { trial.heading() };
        let name = columns.iter().find(|(named, _)| *named == channel);
        let name = name.map_or_else(String::new, |(_, name)| format!(" (column `{}`)", shortened(name)));
        let spoken = format!("the {}{name}", channel.label());
        let texts = [still(trial.time(), values, &spoken), coarse(values, &spoken)];
        texts.into_iter().flatten().map(|text| WarningCode::FaultyReadings.warning(text))
    });
    warnings.collect()
}

/// Runs of at least [`MIN_STILL_ROWS`] rows with the same value.
fn runs(values: &[f64]) -> Vec<Range<usize>> {
    let mut first = 0;
    let runs = values.chunk_by(|before, next| before == next).map(|run| {
        let rows = first..first + run.len();
        first = rows.end;
        rows
    });
    runs.filter(|run| run.len() >= MIN_STILL_ROWS).collect()
}

/// Last decimal of the larger half of the values, rad; numbers with a fixed count of significant digits have finer
/// decimals near zero. 0 for decimals finer than a thousandth of a degree.
fn digit(values: &[f64]) -> f64 {
    let half = 0.5 * values.iter().copied().filter(|x| x.is_finite()).fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let large: Vec<f64> = values.iter().filter(|value| value.abs() >= half).map(|value| value.to_degrees()).collect();
    let is_decimal = |digit: &f64| large.iter().all(|value| (value / digit - (value / digit).round()).abs() < 1e-3);
    [1.0, 0.1, 0.01, 1e-3].into_iter().find(is_decimal).map_or(0.0, f64::to_radians)
}

/// Message for a noisy channel that is clipped or frozen for a time; `None` for any other channel.
fn still(time: &[f64], values: &[f64], spoken: &str) -> Option<String> {
    let mut still = runs(values);
    let least = (1.5 * digit(values)).max(MIN_NOISE_DEG.to_radians());
    let is_still = |row: usize| still.iter().any(|run| run.contains(&row));
    let (mut rows, mut equal, mut turned) = (0, 0, 0);
    for row in (1..values.len().saturating_sub(1)).filter(|&row| !is_still(row)) {
        let [before, after] = [values[row] - values[row - 1], values[row + 1] - values[row]];
        rows += usize::from((before + after).is_finite());
        equal += usize::from(before == 0.0);
        turned += usize::from(before * after < 0.0 && before.abs().max(after.abs()) > least);
    }
    if turned < MIN_NOISY.1 || (turned as f64) < MIN_NOISY.0 * rows as f64 {
        return None;
    }
    // Coarse digits repeat values by chance.
    let again = (equal as f64 / rows as f64).max(0.01);
    let longest = (MAX_CHANCE / values.len() as f64).ln() / again.ln();
    still.retain(|run| run.len() as f64 > longest);
    let first = still.first()?.clone();
    let (low, high) = extremes(values.iter().copied());
    let at_end = |run: &&Range<usize>| values[run.start] == low || values[run.start] == high;
    let ends: Vec<&Range<usize>> = still.iter().filter(at_end).collect();
    let shown = |run: &Range<usize>| rounded_to_thousandth(values[run.start].to_degrees());
    if ends.len() >= 2 {
        let rows = ends.iter().map(|run| run.len()).sum::<usize>();
        let from = ends[0];
        let after = ends.iter().find(|run| values[run.start] != values[from.start]);
        let after = after.map_or_else(String::new, |run| format!(" and {}°", shown(run)));
        return Some(format!(
            "{spoken} stands at exactly {}°{after} in {rows} rows, first from t = {} s, while its other readings are noisy: \
             it is clipped at the end of its scale, which makes K too large; correct the range of the sensor or the logger, \
             or use the rudder order instead (`is = \"rudder_order_deg\"` for its column, in a sidecar NAME.trial.toml)",
            shown(from),
            rounded_to_thousandth(time[from.start]),
        ));
    }
    Some(format!(
        "{spoken} is frozen at {}° from t = {} s to {} s ({}), while it is noisy before and after, which makes K and T \
         wrong; use the part without it (--from, --until), or the rudder order instead",
        shown(&first),
        rounded_to_thousandth(time[first.start]),
        rounded_to_thousandth(time[first.end - 1]),
        counted(first.len(), "row"),
    ))
}

/// Message for a channel in coarse steps; `None` for any other channel.
fn coarse(values: &[f64], spoken: &str) -> Option<String> {
    let step = quantum(values);
    let step_deg = step.to_degrees();
    let first = *values.iter().find(|value| value.is_finite())?;
    let multiple = |value: f64| (value - first) / step;
    let on_scale = |value: f64| (multiple(value) - multiple(value).round()).abs() < 1e-3;
    let mut read: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    if step_deg < MIN_COARSE_STEP_DEG || !read.iter().all(|&value| on_scale(value)) {
        return None;
    }
    let changes: Vec<f64> = read.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > 0.0).collect();
    let next = changes.iter().filter(|change| **change < 1.5 * step).count();
    let goes_on = |rows: &&[f64]| rows[1] == rows[2] && (rows[1] - rows[0]) * (rows[3] - rows[2]) > 0.0;
    let pauses = read.windows(4).filter(goes_on).count();
    read.sort_unstable_by(f64::total_cmp);
    read.dedup_by(|before, after| (*before - *after).abs() < 0.5 * step);
    let is_scale = read.len() >= MIN_VALUES
        && next >= MIN_NEXT.0
        && pauses >= MIN_PAUSES.0
        && pauses as f64 >= MIN_PAUSES.1 * changes.len() as f64;
    (is_scale && next as f64 >= MIN_NEXT.1 * changes.len() as f64).then(|| {
        format!(
            "{spoken} comes in steps of {}°: it is rounded, and a reading may be wrong by half a step; record a decimal",
            rounded_to_thousandth(step_deg)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rudder between two holds at 2.5°/s, one row a second, with `noise` of its sensor in tenths of a degree.
    fn rudder(noise: bool, change: impl Fn(usize, f64) -> f64) -> Vec<f64> {
        let mut angle: f64 = 0.0;
        let angles = (0..600_usize).map(|row| {
            let order = if row < 60 { 0.0 } else { [20.0, -20.0][row / 100 % 2] };
            angle += (order - angle).clamp(-2.5, 2.5);
            let draw = ((row * row) as f64 * 0.618_034).fract() - 0.5;
            let read = if noise { angle + 0.5 * draw } else { angle };
            change(row, (10.0 * read).round() / 10.0).to_radians()
        });
        angles.collect()
    }

    fn text_of(values: &[f64]) -> String {
        let time: Vec<f64> = (0..values.len()).map(|row| row as f64).collect();
        [still(&time, values, "the rudder"), coarse(values, "the rudder")].into_iter().flatten().collect()
    }

    #[test]
    fn an_instrument_that_stands_still_is_told_beside_noise_alone() {
        let clipped = |_: usize, angle: f64| angle.clamp(-15.0, 15.0);
        assert!(text_of(&rudder(true, clipped)).contains("stands at exactly"));
        let frozen = |row: usize, angle: f64| if (230..290).contains(&row) { -20.1 } else { angle };
        let text = text_of(&rudder(true, frozen));
        assert!(text.contains("is frozen at -20.1° from t = 230 s to 289 s (60 rows)"), "{text}");
        // Holds without noise, whole degrees, a rudder at its stop.
        for (noise, change) in [(true, None), (false, None), (false, Some(15.0)), (true, Some(1e9))] {
            let of = |_: usize, angle: f64| match change {
                Some(1e9) => angle.round(),
                Some(stop) => angle.clamp(-stop, stop),
                None => angle,
            };
            assert_eq!(text_of(&rudder(noise, of)), "", "{noise} {change:?}");
        }
    }

    #[test]
    fn coarse_steps_are_told_and_an_order_is_none() {
        let steps = |of: f64| move |_: usize, angle: f64| (angle / of).round() * of;
        assert!(text_of(&rudder(false, steps(5.0))).contains("comes in steps of 5°"));
        assert_eq!(text_of(&rudder(false, steps(1.0))), "");
        assert_eq!(text_of(&rudder(false, |_, angle| if angle.abs() < 19.0 { 0.0 } else { angle })), "");
    }
}
