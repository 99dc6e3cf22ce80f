//! Is the yaw rate an instrument, or the derivative of the heading?

use crate::record::Trial;

/// Fewest pairs of changes that show it.
const FEWEST: usize = 60;

/// Correlation of changes of the yaw rate and of the derivative of the heading that two instruments do not have.
const SAME: f64 = 0.95;

/// Correlation of neighbouring changes of a derivative below which it is noise and jumps of the heading. Turns of a
/// ship go on, and there two instruments agree.
const NOISY: f64 = -0.2;

/// Whether the yaw rate repeats the noise and the jumps of the heading, as the derivative of it does.
pub(crate) fn is_derivative(trial: &Trial) -> bool {
    if trial.heading_from_yaw_rate() {
        return false;
    }
    let (time, psi) = (trial.time(), trial.heading());
    let Some(rate) = trial.yaw_rate() else { return false };
    // From the row before, to the next one, and over both.
    [[1, 0], [0, 1], [1, 1]].into_iter().any(|[back, on]| {
        let rows = back..time.len().saturating_sub(on);
        let slope = |row: usize| (psi[row + on] - psi[row - back]) / (time[row + on] - time[row - back]);
        let of = |value: &dyn Fn(usize) -> f64| rows.clone().map(value).collect::<Vec<f64>>();
        repeats(&of(&slope), &of(&|row| rate[row]), back + on)
    })
}

/// Whether the changes of a rate are those of a derivative over `rows` rows that is mostly noise.
fn repeats(slopes: &[f64], rates: &[f64], rows: usize) -> bool {
    let changes = |values: &[f64]| values.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<f64>>();
    let [slopes, rates] = [slopes, rates].map(changes);
    let later = slopes.iter().skip(rows);
    let both: Vec<[f64; 3]> =
        slopes.iter().zip(&rates).zip(later).map(|((slope, rate), next)| [*slope, *rate, *next]).collect();
    let read: Vec<[f64; 3]> = both.into_iter().filter(|triple| triple.iter().all(|value| value.is_finite())).collect();
    let sum = |first: usize, second: usize| read.iter().map(|triple| triple[first] * triple[second]).sum::<f64>();
    read.len() >= FEWEST && sum(0, 1) > SAME * (sum(0, 0) * sum(1, 1)).sqrt() && sum(0, 2) < NOISY * sum(0, 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_derivative_repeats_the_noise_of_the_heading_and_a_gyro_does_not() {
        let noise = |row: usize, seed: f64| ((row as f64 * 12.9898 + seed).sin() * 43_758.545_3).fract();
        let heading: Vec<f64> = (0..400).map(|row| 0.1 * (0.05 * row as f64).sin() + 2e-3 * noise(row, 0.0)).collect();
        let slopes: Vec<f64> = (1..399).map(|row| 0.5 * (heading[row + 1] - heading[row - 1])).collect();
        let rounded: Vec<f64> = slopes.iter().map(|slope| (slope * 1e5).round() / 1e5).collect();
        assert!(repeats(&slopes, &rounded, 2));
        let gyro: Vec<f64> = (1..399).map(|row| 0.005 * (0.05 * row as f64).cos() + 2e-3 * noise(row, 7.0)).collect();
        assert!(!repeats(&slopes, &gyro, 2));
        // Without noise both are right.
        let smooth: Vec<f64> = (0..398).map(|row| 0.015 * (0.05 * f64::from(row)).cos()).collect();
        assert!(!repeats(&smooth, &smooth, 2));
    }
}
