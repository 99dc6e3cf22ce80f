//! Checks of the recorded rudder: sign, scale, unit of the time, and distinction of an order from an angle.

use document::{Warning, WarningCode};
use estimation::statistics::median;
use ship::angle::to_deg;

use super::motion::{changes, extremes};
use crate::channel::Channel;
use crate::record::Trial;

/// Maximum rate of a steering gear over a single row, deg/s; a faster movement is a step. Rudders of ships move at 2 to
/// 7°/s.
const MAX_RUDDER_RATE_DEG_S: f64 = 10.0;

/// Minimum length of a stroke of the steering gear, deg; shorter movements are corrections.
const MIN_STROKE_DEG: f64 = 8.0;

/// Rates of steering gears, from a slow gear to a small model, deg/s; other rates are a fault of the clock.
const RUDDER_RATES_DEG_S: std::ops::RangeInclusive<f64> = 0.3..=100.0;

/// Minimum share of steps among the strokes of an order.
const MIN_STEP_SHARE: f64 = 0.8;

/// Maximum movement next to a step: in standard deviations of the noise, and as a share of the stroke.
const MAX_BESIDE_STEP: (f64, f64) = (8.0, 0.1);

/// Maximum magnitude of the negative angles of a rudder on a single side, deg.
const MAX_OTHER_SIDE_DEG: f64 = 1.0;

/// Shares of its maximum angle below and above which a rudder without sign is amidships and laid.
const AMIDSHIPS_AND_LAID: [f64; 2] = [0.35, 0.75];

/// Minimum share of the turning to either side by a ship that turns to both sides.
const MIN_SIDE_SHARE: f64 = 0.25;

/// Tolerance of the recorded angle at a held order, as a share of the order.
const FEEDBACK_TOLERANCE: f64 = 0.1;

/// Largest plausible held rudder angle, deg: most steering gears stop at 35°, some at 45°.
const MAX_HELD_DEG: f64 = 46.0;

/// Warnings of a rudder that is an order, on a wrong scale, without a sign, or at impossible rates.
pub(super) fn rudder_movements(trial: &Trial) -> impl Iterator<Item = Warning> {
    let strokes = strokes(trial.time(), trial.rudder());
    let against_order = match trial.channel(Channel::RudderOrder) {
        Some(order) => feedback(trial, order),
        None => steps(&strokes, noise_deg(trial.rudder())),
    };
    [against_order, clock_of_rudder(&strokes), held(trial), unsigned(trial)].into_iter().flatten()
}

/// Warning of a rudder without sign: it moves repeatedly to a single side while the ship turns to both sides.
fn unsigned(trial: &Trial) -> Option<Warning> {
    let rudder = trial.rudder();
    let (low, high) = extremes(rudder.iter().copied());
    let [starboard, port] = changes(trial.time(), trial.heading())
        .fold([0.0, 0.0], |sum: [f64; 2], (turn, _)| [sum[0] + turn.max(0.0), sum[1] - turn.min(0.0)]);
    let is_one_sided = to_deg(low) > -MAX_OTHER_SIDE_DEG && to_deg(high) > MIN_STROKE_DEG;
    let mut levels: Vec<bool> = rudder
        .iter()
        .filter(|delta| **delta < AMIDSHIPS_AND_LAID[0] * high || **delta > AMIDSHIPS_AND_LAID[1] * high)
        .map(|delta| *delta > AMIDSHIPS_AND_LAID[1] * high)
        .collect();
    levels.dedup();
    (is_one_sided && levels.len() >= 6 && starboard.min(port) > MIN_SIDE_SHARE * (starboard + port)).then(|| {
        WarningCode::RudderSign.warning(format!(
            "the rudder is never negative (from {:.1}° to {:.1}°) while the ship turns to both sides: it has lost its sign, \
             or its zero is at the end of its scale; record the side with it, as in `P 10.0` or a column of sides, or write \
             `zero` or `formula` for its column in a sidecar NAME.trial.toml",
            to_deg(low),
            to_deg(high)
        ))
    })
}

/// Warning of a rudder in per cent: it is held beyond the stops, or at a usual order in per cent of the stop.
fn held(trial: &Trial) -> Option<Warning> {
    let held_deg = trial.rudder().windows(3).filter(|rows| rows[0] == rows[1] && rows[1] == rows[2]);
    let held_deg = to_deg(held_deg.fold(0.0, |largest: f64, rows| largest.max(rows[0].abs())));
    let text = if held_deg > MAX_HELD_DEG {
        format!(
            "the rudder is held at {held_deg:.0}°, beyond the usual stops of 35 to 45°: if it is in per cent, K is wrong by \
             the factor between the two; record the angle in degrees"
        )
    } else {
        let order_deg = in_per_cent(held_deg)?;
        format!(
            "the rudder is held at {held_deg:.2}°, which is {order_deg}° in per cent of 35°: if it is in per cent, K is too \
             small by a factor of 0.35; record the angle in degrees"
        )
    };
    Some(WarningCode::RudderScale.warning(text))
}

/// Order, deg, of an angle in per cent of the usual stop at 35°; `None` unless the order is a multiple of 5°.
fn in_per_cent(held_deg: f64) -> Option<f64> {
    let order_deg = 0.35 * held_deg;
    let usual_deg = 5.0 * (order_deg / 5.0).round();
    (usual_deg > 0.0 && (order_deg - usual_deg).abs() < 0.04).then_some(usual_deg)
}

/// Stroke of the rudder: a movement to one side.
struct RudderStroke {
    length_deg: f64,
    duration_s: f64,
    /// Number of changes from row to row.
    rows: usize,
    /// Maximum change between two rows.
    largest_deg: f64,
    /// Time between these two rows.
    largest_s: f64,
}

/// Strokes of the rudder of at least [`MIN_STROKE_DEG`].
fn strokes(time: &[f64], rudder: &[f64]) -> Vec<RudderStroke> {
    let changes: Vec<f64> = rudder.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut first = 0;
    let runs = changes.chunk_by(|change, next| change * next > 0.0).map(|run| {
        let from = first;
        first += run.len();
        let length_deg = to_deg((rudder[first] - rudder[from]).abs());
        let largest = (from..first).max_by(|a, b| changes[*a].abs().total_cmp(&changes[*b].abs()));
        let row = largest.unwrap_or(from);
        let (largest_deg, largest_s) = (to_deg(changes[row].abs()), time[row + 1] - time[row]);
        RudderStroke { length_deg, duration_s: time[first] - time[from], rows: run.len(), largest_deg, largest_s }
    });
    runs.filter(|stroke| stroke.length_deg >= MIN_STROKE_DEG).collect()
}

/// Robust size of a change between two rows, deg: the noise of a rudder at rest.
fn noise_deg(rudder: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = rudder.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    to_deg(1.4826 * median(&mut sizes).unwrap_or(0.0))
}

/// Warning of steps in place of strokes: an order under the name of the angle. Noise next to a step is allowed.
fn steps(strokes: &[RudderStroke], noise_deg: f64) -> Option<Warning> {
    let is_step = |stroke: &&RudderStroke| {
        let beside_deg = stroke.length_deg - stroke.largest_deg;
        beside_deg <= (MAX_BESIDE_STEP.0 * noise_deg).min(MAX_BESIDE_STEP.1 * stroke.length_deg)
            && stroke.largest_deg > MAX_RUDDER_RATE_DEG_S * stroke.largest_s
    };
    let steps: Vec<&RudderStroke> = strokes.iter().filter(is_step).collect();
    let slowest_deg_s = steps.iter().map(|step| step.largest_deg / step.largest_s).fold(f64::INFINITY, f64::min);
    (steps.len() >= 2 && steps.len() as f64 >= MIN_STEP_SHARE * strokes.len() as f64).then(|| {
        WarningCode::RudderOrder.warning(format!(
            "the rudder jumps within a row in {} of {} movements, at {slowest_deg_s:.0}°/s or more, while steering gears move \
             at 2 to 7°/s: it looks like the order in place of the angle, which makes T too long by about half the time of a \
             movement; record the angle, or write the rate of the gear (`order-rate-deg-s = 2.5`) under [rudder] in a sidecar \
             NAME.trial.toml",
            steps.len(),
            strokes.len()
        ))
    })
}

/// Warning of strokes over several rows at an impossible rate of a steering gear: the unit of the time is wrong.
fn clock_of_rudder(strokes: &[RudderStroke]) -> Option<Warning> {
    let seen = strokes.iter().filter(|stroke| stroke.rows >= 3);
    let mut rates: Vec<f64> = seen.map(|stroke| stroke.length_deg / stroke.duration_s).collect();
    let rate = median(&mut rates).filter(|_| rates.len() >= 2)?;
    (!RUDDER_RATES_DEG_S.contains(&rate)).then(|| {
        WarningCode::TimeUnit.warning(format!(
            "the rudder moves at {rate:.2}°/s, while steering gears move at 2 to 7°/s: check the unit of the time (t_s, t_ms, \
             t_min; stamps of minutes and seconds are read as hours and minutes)"
        ))
    })
}

/// Warning of a feedback that differs from its order: their ratio at rest is 1 for a calibrated feedback.
fn feedback(trial: &Trial, order: &[f64]) -> Option<Warning> {
    let rudder = trial.rudder();
    let rests = |values: &[f64], row: usize| (row.saturating_sub(4)..=row).all(|k| values[k] == values[row]);
    let settled = (4..trial.len()).filter(|&k| rests(order, k) && to_deg((rudder[k] - rudder[k - 4]).abs()) < 0.2);
    let (mut cross, mut square, mut rows) = (0.0, 0.0, 0);
    for row in settled.filter(|&row| to_deg(order[row].abs()) > 2.0) {
        cross += rudder[row] * order[row];
        square += order[row] * order[row];
        rows += 1;
    }
    let ratio = cross / square;
    (rows >= 10 && !(1.0 - FEEDBACK_TOLERANCE..=1.0 + FEEDBACK_TOLERANCE).contains(&ratio)).then(|| {
        WarningCode::RudderScale.warning(format!(
            "the recorded rudder comes to {ratio:.2} of its order: if the feedback is not calibrated (or in per cent), K is \
             wrong by that factor; check it against the rudder stops"
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{Columns, RecordOrigin};
    use ship::angle::from_deg;

    /// Warnings of a rudder that alternates between ±20° at a rate (deg/s), read every `step` s, and of its order.
    fn warnings(rate_deg_s: f64, step: f64, scale: f64, with_order: bool) -> String {
        warnings_read_by(rate_deg_s, step, with_order, |_, angle| scale * angle)
    }

    /// Warnings of such a rudder that is read through a function of row and angle, deg.
    fn warnings_read_by(rate_deg_s: f64, step: f64, with_order: bool, read: impl Fn(usize, f64) -> f64) -> String {
        let rows = 400;
        let time: Vec<f64> = (0..rows).map(|row| f64::from(row) * step).collect();
        let order = |t: f64| -> f64 { if ((t / (100.0 * step)) as usize).is_multiple_of(2) { 20.0 } else { -20.0 } };
        let mut angle = 0.0;
        let rudder = time.iter().enumerate().map(|(row, &t)| {
            angle += (order(t) - angle).clamp(-rate_deg_s * step, rate_deg_s * step);
            from_deg(read(row, angle))
        });
        let mut channels = std::collections::BTreeMap::from([(Channel::Rudder, rudder.collect::<Vec<f64>>())]);
        channels.insert(Channel::Heading, time.iter().map(|t| 0.1 * (t / (50.0 * step)).sin()).collect());
        if with_order {
            channels.insert(Channel::RudderOrder, time.iter().map(|&t| from_deg(order(t))).collect());
        }
        let origin = RecordOrigin::Measured { file: String::new(), sha256: String::new() };
        let trial =
            Trial::new("run", origin, Columns { time, channels, unknown_columns: Vec::new() }).expect("columns");
        rudder_movements(&trial).map(|warning| warning.text).collect::<Vec<_>>().join("; ")
    }

    #[test]
    fn a_rudder_that_is_none_is_told() {
        for (rate, step) in [(2.5, 1.0), (2.5, 0.1), (15.8, 0.1), (2.5, 10.0)] {
            assert_eq!(warnings(rate, step, 1.0, false), "", "{rate} deg/s read every {step} s");
        }
        for step in [0.1, 1.0, 2.0] {
            assert!(warnings(1e9, step, 1.0, false).contains("looks like the order"), "every {step} s");
        }
        // Minutes for seconds, and minutes and seconds for hours and minutes.
        assert!(warnings(150.0, 1.0 / 60.0, 1.0, false).contains("check the unit of the time"));
        assert!(warnings(2.5 / 60.0, 60.0, 1.0, false).contains("check the unit of the time"));
        // The order with the noise of a converter, and the angle with it.
        let noise = |rate: f64, step: f64| {
            warnings_read_by(rate, step, false, |row, angle| angle + 0.1 * ((row * row) as f64 * 0.618_034).fract())
        };
        assert!([1.0, 0.5].into_iter().all(|step| noise(1e9, step).contains("looks like the order")));
        assert_eq!([noise(2.5, 1.0), noise(5.0, 0.5)].concat(), "");
        let unsigned = |rate: f64| warnings_read_by(rate, 1.0, false, |_, angle| angle.abs());
        assert!(unsigned(2.5).contains("is never negative"));
        assert!(warnings(2.5, 1.0, 0.85, true).contains("comes to 0.85 of its order"));
        assert_eq!(warnings(2.5, 1.0, 1.02, true), "");
        assert!(warnings(7.0, 1.0, 57.0 / 20.0, false).contains("per cent"));
        assert!(warnings(7.0, 1.0, 0.5 / 0.35, false).contains("10° in per cent of 35°"));
    }
}
