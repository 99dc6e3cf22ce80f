//! A channel whose readings come from two sensors in turn.

use crate::cleaning::readings;

/// Correlation of deviations one reading apart below the first and two apart above the second shows two sensors: that
/// of white noise is −0.67 and 0.17.
const CORRELATIONS: [f64; 2] = [-0.75, 0.6];

/// Disagreements below this (rms) are digits and noise, rad.
const LEAST: f64 = 0.006;

/// Fewest readings in which a rhythm is seen.
const FEWEST: usize = 40;

/// Share of the deviations beside a repeated reading from which on a channel is a staircase: written on change, or in
/// coarse steps.
const STAIRCASE: f64 = 0.5;

/// How far the two sensors of a channel are apart (rms), in the unit of the values; `None` where there is one.
///
/// The deviation of a reading from the straight line between its neighbours changes its sign from
/// reading to reading where two smooth signals take turns.
pub(super) fn alternation(time: &[f64], values: &[f64]) -> Option<f64> {
    let (mut deviations, mut beside_repeated) = (Vec::new(), 0.0);
    for ([before, at, after], deviation) in readings::deviations(time, values) {
        let repeats = values[before] == values[at] || values[at] == values[after];
        beside_repeated += if repeats { deviation * deviation } else { 0.0 };
        deviations.push(deviation);
    }
    if deviations.len() < FEWEST {
        return None;
    }
    let product =
        |apart: usize| deviations.iter().zip(&deviations[apart..]).map(|(one, other)| one * other).sum::<f64>();
    let square = product(0);
    if beside_repeated > STAIRCASE * square {
        return None;
    }
    let rms = (square / deviations.len() as f64).sqrt();
    let alternates = product(1) < CORRELATIONS[0] * square && product(2) > CORRELATIONS[1] * square;
    (rms > LEAST && alternates).then_some(rms)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_sensors_are_told_from_noise_and_digits() {
        let time: Vec<f64> = (0..400).map(|k| 0.5 * f64::from(k)).collect();
        let signal = |t: f64| 0.4 * (0.05 * t).sin();
        let of = |value: &dyn Fn(usize, f64) -> f64| -> Vec<f64> {
            time.iter().enumerate().map(|(row, &t)| value(row, t)).collect()
        };
        let late = of(&|row, t| signal(if row % 2 == 0 { t } else { t - 5.0 }));
        let apart = alternation(&time, &late).expect("two sensors");
        assert!((0.02..0.1).contains(&apart), "{apart}");
        let offset = of(&|row, t| signal(t) + if row % 2 == 0 { 0.0 } else { 0.035 });
        assert!(alternation(&time, &offset).is_some());
        let noise = |row: usize| 0.02 * ((row as f64 * 12.9898).sin() * 43758.5453).fract();
        assert_eq!(alternation(&time, &of(&|row, t| signal(t) + noise(row))), None);
        assert_eq!(alternation(&time, &of(&|_, t| (signal(t) / 0.02).round() * 0.02)), None);
        // Held for every other row, as a channel that is written on change.
        assert_eq!(alternation(&time, &of(&|row, _| 0.02 * (row / 2) as f64)), None);
    }
}
