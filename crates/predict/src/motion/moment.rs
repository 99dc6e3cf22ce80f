//! What is random in yaw.

use super::hull::RandomYawMoment;
use super::record::smoothed;
use super::windows::WindowedRecord;
use super::yaw::Yaw;

/// Half width of the window in which the slope of the yaw rate is taken, in units of L/U₀.
const HALF: f64 = 0.25;

/// Time between two readings of the moment, L/U₀.
const STEP: f64 = 0.1;

/// Standard deviation (rad of rudder) and correlation time (in units of L/U₀) of the moment that the yaw equation
/// lacks.
///
/// Its readings are the slope of a parabola through r − ∫ f(u, v, r, δ) dt within 0.25 L/U₀, over what the rudder does
/// at that speed; r is the yaw rate as it was read, f the equation at smoothed states. The deviation is their root mean
/// square; the correlation time is the lag at which their autocorrelation, taken over all records about zero, first
/// falls to 1/e. What is quicker than the window is not seen, and noise of the readings is taken for moment: with noisy
/// yaw rates the deviation is too large and the time too short.
pub(crate) fn moment(courses: &[WindowedRecord], yaw: &Yaw) -> RandomYawMoment {
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
        if now.is_nan() || now <= threshold {
            lags += (before - threshold) / (before - now);
            break;
        }
        (before, lags) = (now, lags + 1.0);
    }
    let correlation_time = if variance > 0.0 { lags * STEP } else { 0.0 };
    RandomYawMoment { deviation: variance.sqrt(), correlation_time }
}

/// The moment as rudder angle, every tenth of L/U₀.
fn readings(course: &WindowedRecord, yaw: &Yaw) -> Vec<f64> {
    let [_, rate, surge, sway] = &course.states;
    let of = |row: usize, disturbance: f64| yaw.rate(surge[row], sway[row], rate[row], course.rudder[row], disturbance);
    let [_, read, ..] = &course.readings;
    let mut told = 0.0;
    let beside: Vec<f64> = (0..course.time.len())
        .map(|row| {
            if row > 0 {
                told += 0.5 * (of(row - 1, 0.0) + of(row, 0.0)) * (course.time[row] - course.time[row - 1]);
            }
            let now = if read[row].is_finite() { read[row] } else { rate[row] };
            now - told
        })
        .collect();
    let slope = smoothed(&course.time, &beside, HALF).1;
    let mut next = course.time[0];
    let mut found = Vec::new();
    for (row, (time, slope)) in course.time.iter().zip(slope).enumerate() {
        if *time >= next {
            next += STEP * ((time - next) / STEP).floor() + STEP;
            found.push(slope / (of(row, 1.0) - of(row, 0.0)));
        }
    }
    found
}
