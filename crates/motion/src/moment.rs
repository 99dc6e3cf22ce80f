//! What is random in yaw.

use crate::course::Course;
use crate::hull::Moment;
use crate::record::smoothed;
use crate::yaw::Yaw;

/// Half width of the window in which the slope of the yaw rate is taken, in units of L/U₀.
const HALF: f64 = 0.25;

/// Standard deviation (rad of rudder) and correlation time (in units of L/U₀) of the moment that the yaw equation
/// lacks.
///
/// Its readings are r' − f(u, v, r, δ) over what the rudder does at that speed, with r' the slope of a parabola through
/// the smoothed yaw rates within 0.25 L/U₀ and all else as measured and smoothed. The deviation is their root mean
/// square; the correlation time is the lag at which their autocorrelation, taken over all records about zero, first
/// falls to 1/e. What is quicker than the window is not seen, and noise of the readings is taken for moment: with noisy
/// yaw rates the deviation is too large and the time too short.
pub(crate) fn moment(courses: &[Course], yaw: &Yaw) -> Moment {
    let left: Vec<Vec<f64>> = courses.iter().map(|course| readings(course, yaw)).collect();
    let (square, count) = left.iter().flatten().fold((0.0, 0), |(sum, n), x| (sum + x * x, n + 1));
    let variance = square / f64::from(count.max(1));
    let longest = left.iter().map(Vec::len).max().unwrap_or(0);
    let correlation = |lag: usize| {
        let pairs = left.iter().flat_map(|own| own.iter().zip(own.iter().skip(lag)));
        let (sum, count) = pairs.fold((0.0, 0), |(sum, n), (x, y)| (sum + x * y, n + 1));
        sum / f64::from(count.max(1)) / variance
    };
    let threshold = (-1.0f64).exp();
    let mut before = 1.0;
    let mut lags = 0.0;
    for lag in 1..longest {
        let now = correlation(lag);
        if !(now > threshold) {
            lags += (before - threshold) / (before - now);
            break;
        }
        (before, lags) = (now, lags + 1.0);
    }
    let correlation_time = if variance > 0.0 { lags * STEP } else { 0.0 };
    Moment { deviation: variance.sqrt(), correlation_time }
}

/// Time between two readings of the moment, L/U₀.
const STEP: f64 = 0.1;

/// The moment as rudder angle, every tenth of L/U₀.
fn readings(course: &Course, yaw: &Yaw) -> Vec<f64> {
    let [_, rate, surge, sway] = &course.states;
    let slope = smoothed(&course.time, rate, HALF).1;
    let mut next = course.time[0];
    let mut found = Vec::new();
    for row in 0..course.time.len() {
        if course.time[row] < next {
            continue;
        }
        next += STEP * ((course.time[row] - next) / STEP).floor() + STEP;
        let of = |disturbance| yaw.rate(surge[row], sway[row], rate[row], course.rudder[row], disturbance);
        found.push((slope[row] - of(0.0)) / (of(1.0) - of(0.0)));
    }
    found
}
