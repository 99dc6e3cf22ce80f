//! Detection of a yaw rate that is the derivative of the recorded heading and not the reading of an instrument.

use crate::record::Trial;

/// Minimum number of changes.
const MIN_CHANGES: usize = 60;

/// Minimum correlation of the changes of the yaw rate and of the derivative of the heading; that of two instruments is
/// lower.
const MIN_CORRELATION: f64 = 0.95;

/// Maximum correlation between successive changes of a derivative that consists of noise and jumps of the heading. The
/// turns of a ship are smooth, and two instruments agree on them.
const MAX_AUTOCORRELATION: f64 = -0.2;

/// `true` if the yaw rate repeats the noise and the jumps of the heading, as its derivative does.
pub(crate) fn is_derivative(trial: &Trial) -> bool {
    if trial.is_heading_integrated() {
        return false;
    }
    let (time, psi) = (trial.time(), trial.heading());
    let Some(rate) = trial.yaw_rate() else { return false };
    // Backward, forward and central differences.
    [[1, 0], [0, 1], [1, 1]].into_iter().any(|[back, forward]| {
        let rows = back..time.len().saturating_sub(forward);
        let slope = |row: usize| (psi[row + forward] - psi[row - back]) / (time[row + forward] - time[row - back]);
        let values = |value: &dyn Fn(usize) -> f64| rows.clone().map(value).collect::<Vec<f64>>();
        repeats(&values(&slope), &values(&|row| rate[row]), back + forward)
    })
}

/// `true` if the changes of a rate follow the changes of a difference quotient over `rows` rows that is mostly noise.
fn repeats(slopes: &[f64], rates: &[f64], rows: usize) -> bool {
    let changes = |values: &[f64]| values.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<f64>>();
    let [slopes, rates] = [slopes, rates].map(changes);
    let later = slopes.iter().skip(rows);
    let both: Vec<[f64; 3]> =
        slopes.iter().zip(&rates).zip(later).map(|((slope, rate), next)| [*slope, *rate, *next]).collect();
    let finite: Vec<[f64; 3]> = both.into_iter().filter(|triple| triple.iter().all(|x| x.is_finite())).collect();
    let sum = |first: usize, second: usize| finite.iter().map(|triple| triple[first] * triple[second]).sum::<f64>();
    let is_correlated = sum(0, 1) > MIN_CORRELATION * (sum(0, 0) * sum(1, 1)).sqrt();
    finite.len() >= MIN_CHANGES && is_correlated && sum(0, 2) < MAX_AUTOCORRELATION * sum(0, 0)
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
        // Without noise the derivative and the reading are equal.
        let smooth: Vec<f64> = (0..398).map(|row| 0.015 * (0.05 * f64::from(row)).cos()).collect();
        assert!(!repeats(&smooth, &smooth, 2));
    }
}
