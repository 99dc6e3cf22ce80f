//! Does the rudder move as a steering gear does, to where it was ordered?

use document::{Code, Warning};
use estimation::statistics::median;
use ship::angle::to_deg;

use super::motion::{changes, extremes};
use crate::channel::Channel;
use crate::record::Trial;

/// Rudders of ships move at 2 to 7°/s; a movement that takes one row and would need more than this is a step, deg/s.
const FASTEST_RUDDER_DEG_S: f64 = 10.0;

/// Way of a rudder from which on it is a movement of the steering gear and no correction, deg.
const STROKE_DEG: f64 = 8.0;

/// Rates of rudders from a slow gear to that of a small model, deg/s; others are a fault of the clock.
const RUDDER_RATES_DEG_S: std::ops::RangeInclusive<f64> = 0.3..=100.0;

/// Share of the movements that are steps where the column is an order.
const STEPS_OF_AN_ORDER: f64 = 0.8;

/// What a step may have beside it: so many times the noise, and at most this share of the movement.
const BESIDE_A_STEP: (f64, f64) = (8.0, 0.1);

/// A rudder that goes no further to the other side is on one side alone, deg.
const ONE_SIDED_DEG: f64 = 1.0;

/// Shares of its largest angle below and above which such a rudder is back at its zero, and laid.
const DIP: [f64; 2] = [0.35, 0.75];

/// Share of all turning that goes to either side where a ship turns to both.
const BOTH_SIDES: f64 = 0.25;

/// How far the recorded angle may be from the order it holds, as a share of the order.
const FEEDBACK_ERROR: f64 = 0.1;

/// Ordered angles are no larger, deg: rudders stop at 35°, some at 45°.
const LARGEST_HELD_DEG: f64 = 46.0;

/// Warnings of a rudder that is none, or one on a wrong scale.
pub(super) fn rudder_movements(trial: &Trial) -> impl Iterator<Item = Warning> {
    let strokes = strokes(trial.time(), trial.rudder());
    let against_order = match trial.channel(Channel::RudderOrder) {
        Some(order) => feedback(trial, order),
        None => steps(&strokes, noise_deg(trial.rudder())),
    };
    [against_order, clock_of_rudder(&strokes), held(trial), unsigned(trial)].into_iter().flatten()
}

/// A rudder that goes to one side alone, time and again, while the ship turns to both.
fn unsigned(trial: &Trial) -> Option<Warning> {
    let rudder = trial.rudder();
    let (low, high) = extremes(rudder.iter().copied());
    let (turns, back) = changes(trial.time(), trial.heading())
        .fold((0.0, 0.0), |(one, other): (f64, f64), (turn, _)| (one + turn.max(0.0), other - turn.min(0.0)));
    let is_one_sided = to_deg(low) > -ONE_SIDED_DEG && to_deg(high) > STROKE_DEG;
    let mut levels: Vec<bool> = rudder
        .iter()
        .filter(|delta| **delta < DIP[0] * high || **delta > DIP[1] * high)
        .map(|delta| *delta > DIP[1] * high)
        .collect();
    levels.dedup();
    (is_one_sided && levels.len() >= 6 && turns.min(back) > BOTH_SIDES * (turns + back)).then(|| {
        Code::RudderSign.warning(format!(
            "the rudder is never negative (from {:.1}° to {:.1}°) while the ship turns to both sides: it has lost its sign, or its zero is at \
             one end; give the side with it, as in `P 10.0` or a column of sides, or write `zero` or `formula` for its column in a \
             sidecar NAME.trial.toml",
            to_deg(low),
            to_deg(high)
        ))
    })
}

/// A rudder that is held where no rudder is, or at a usual order in per cent of its stop.
fn held(trial: &Trial) -> Option<Warning> {
    let held_deg = trial.rudder().windows(3).filter(|rows| rows[0] == rows[1] && rows[1] == rows[2]);
    let held_deg = to_deg(held_deg.fold(0.0, |largest: f64, rows| largest.max(rows[0].abs())));
    let text = if held_deg > LARGEST_HELD_DEG {
        format!(
            "the rudder is held at {held_deg:.0}°, rudders stop at 35 to 45°: it may be in per cent; then K is wrong by the factor \
             between the two, give the angle in degrees"
        )
    } else {
        let order_deg = in_per_cent(held_deg)?;
        format!(
            "the rudder is held at {held_deg:.2}°, which is {order_deg}° in per cent of 35°: if it is in per cent, K is 0.35 of what it \
             should be; give the angle in degrees"
        )
    };
    Some(Code::RudderScale.warning(text))
}

/// The order, deg, that an angle is in per cent of the usual stop at 35°: orders are multiples of 5°.
fn in_per_cent(held_deg: f64) -> Option<f64> {
    let order_deg = 0.35 * held_deg;
    let usual_deg = 5.0 * (order_deg / 5.0).round();
    (usual_deg > 0.0 && (order_deg - usual_deg).abs() < 0.04).then_some(usual_deg)
}

/// A movement of the rudder to one side that a steering gear makes: way, deg, time it took, s, and in how many rows;
/// the largest change between two of them, deg, and its time, s.
struct RudderStroke {
    way_deg: f64,
    took_s: f64,
    rows: usize,
    largest_deg: f64,
    largest_took_s: f64,
}

/// The movements of the rudder over more than [`STROKE_DEG`].
fn strokes(time: &[f64], rudder: &[f64]) -> Vec<RudderStroke> {
    let changes: Vec<f64> = rudder.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut first = 0;
    let runs = changes.chunk_by(|one, next| one * next > 0.0).map(|run| {
        let from = first;
        first += run.len();
        let way_deg = to_deg((rudder[first] - rudder[from]).abs());
        let largest = (from..first).max_by(|one, other| changes[*one].abs().total_cmp(&changes[*other].abs()));
        let row = largest.unwrap_or(from);
        let (largest_deg, largest_took_s) = (to_deg(changes[row].abs()), time[row + 1] - time[row]);
        RudderStroke { way_deg, took_s: time[first] - time[from], rows: run.len(), largest_deg, largest_took_s }
    });
    runs.filter(|stroke| stroke.way_deg >= STROKE_DEG).collect()
}

/// The usual size of a change between two rows, deg: noise, and nothing for a rudder that rests.
fn noise_deg(rudder: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = rudder.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    to_deg(1.4826 * median(&mut sizes).unwrap_or(0.0))
}

/// Steps in place of movements: an order under the name of the angle. Beside a step there may be noise.
fn steps(strokes: &[RudderStroke], noise_deg: f64) -> Option<Warning> {
    let is_step = |stroke: &&RudderStroke| {
        let beside_deg = stroke.way_deg - stroke.largest_deg;
        beside_deg <= (BESIDE_A_STEP.0 * noise_deg).min(BESIDE_A_STEP.1 * stroke.way_deg)
            && stroke.largest_deg > FASTEST_RUDDER_DEG_S * stroke.largest_took_s
    };
    let steps: Vec<&RudderStroke> = strokes.iter().filter(is_step).collect();
    let slowest_deg_s = steps.iter().map(|step| step.largest_deg / step.largest_took_s).fold(f64::INFINITY, f64::min);
    (steps.len() >= 2 && steps.len() as f64 >= STEPS_OF_AN_ORDER * strokes.len() as f64).then(|| {
        Code::RudderOrder.warning(format!(
            "the rudder jumps from one row to the next in {} of {} movements, at {slowest_deg_s:.0}°/s or more, while steering gears \
             move at 2 to 7°/s: it looks like the order in place of the angle, and then T is too long by about half the time of \
             a movement; record the angle, or write `order-rate-deg-s = 2.5`, or what the gear does, under [rudder] in a \
             sidecar NAME.trial.toml",
            steps.len(),
            strokes.len()
        ))
    })
}

/// Movements that take several rows and are those of no steering gear: the unit of the time is wrong.
fn clock_of_rudder(strokes: &[RudderStroke]) -> Option<Warning> {
    let seen = strokes.iter().filter(|stroke| stroke.rows >= 3);
    let mut rates: Vec<f64> = seen.map(|stroke| stroke.way_deg / stroke.took_s).collect();
    let rate = median(&mut rates).filter(|_| rates.len() >= 2)?;
    (!RUDDER_RATES_DEG_S.contains(&rate)).then(|| {
        Code::TimeUnit.warning(format!(
            "the rudder moves at {rate:.2}°/s, steering gears move at 2 to 7°/s: check the unit of the time (t_s, t_ms, t_min; stamps \
             of minutes and seconds are read as hours and minutes)"
        ))
    })
}

/// Rudder over order where both rest: 1 for a feedback that is right.
fn feedback(trial: &Trial, order: &[f64]) -> Option<Warning> {
    let rudder = trial.rudder();
    let rests = |values: &[f64], row: usize| (row.saturating_sub(4)..=row).all(|k| values[k] == values[row]);
    let settled =
        (4..trial.len()).filter(|&row| rests(order, row) && to_deg((rudder[row] - rudder[row - 4]).abs()) < 0.2);
    let (mut cross, mut square, mut rows) = (0.0, 0.0, 0);
    for row in settled.filter(|&row| to_deg(order[row].abs()) > 2.0) {
        cross += rudder[row] * order[row];
        square += order[row] * order[row];
        rows += 1;
    }
    let ratio = cross / square;
    (rows >= 10 && !(1.0 - FEEDBACK_ERROR..=1.0 + FEEDBACK_ERROR).contains(&ratio)).then(|| {
        Code::RudderScale.warning(format!(
            "the recorded rudder comes to {ratio:.2} of its order: if the feedback is not calibrated (or in per cent), K is wrong by \
             that factor; check it against the rudder stops"
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{Columns, Origin};
    use ship::angle::from_deg;

    /// What is said of a rudder that goes to and fro between ±20° at a rate (deg/s), read every `step` s, and of its
    /// order.
    fn told(rate_deg_s: f64, step: f64, scale: f64, with_order: bool) -> String {
        told_of(rate_deg_s, step, with_order, |_, angle| scale * angle)
    }

    /// The same of a rudder that is read through a change, by row and angle, deg.
    fn told_of(rate_deg_s: f64, step: f64, with_order: bool, read: impl Fn(usize, f64) -> f64) -> String {
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
        let origin = Origin::Measured { file: String::new(), sha256: String::new() };
        let trial = Trial::new("run", origin, Columns { time, channels, unknown: Vec::new() }).expect("columns");
        rudder_movements(&trial).map(|warning| warning.text).collect::<Vec<_>>().join("; ")
    }

    #[test]
    fn a_rudder_that_is_none_is_told() {
        for (rate, step) in [(2.5, 1.0), (2.5, 0.1), (15.8, 0.1), (2.5, 10.0)] {
            assert_eq!(told(rate, step, 1.0, false), "", "{rate} deg/s read every {step} s");
        }
        for step in [0.1, 1.0, 2.0] {
            assert!(told(1e9, step, 1.0, false).contains("looks like the order"), "every {step} s");
        }
        // Minutes for seconds, and minutes and seconds for hours and minutes.
        assert!(told(150.0, 1.0 / 60.0, 1.0, false).contains("check the unit of the time"));
        assert!(told(2.5 / 60.0, 60.0, 1.0, false).contains("check the unit of the time"));
        // The order with the noise of a converter, and the angle with it.
        let noise = |rate: f64, step: f64| {
            told_of(rate, step, false, |row, angle| angle + 0.1 * ((row * row) as f64 * 0.618_034).fract())
        };
        assert!([1.0, 0.5].into_iter().all(|step| noise(1e9, step).contains("looks like the order")));
        assert_eq!([noise(2.5, 1.0), noise(5.0, 0.5)].concat(), "");
        let unsigned = |rate: f64| told_of(rate, 1.0, false, |_, angle| angle.abs());
        assert!(unsigned(2.5).contains("is never negative"));
        assert!(told(2.5, 1.0, 0.85, true).contains("comes to 0.85 of its order"));
        assert_eq!(told(2.5, 1.0, 1.02, true), "");
        assert!(told(7.0, 1.0, 57.0 / 20.0, false).contains("per cent"));
        assert!(told(7.0, 1.0, 0.5 / 0.35, false).contains("10° in per cent of 35°"));
    }
}
