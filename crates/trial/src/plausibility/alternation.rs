//! Detection of a channel whose readings alternate between two sensors.

use crate::cleaning::readings;

/// Bounds of the autocorrelation of the deviations of two sensors: maximum at lag 1, minimum at lag 2. That of white
/// noise is −0.67 and 0.17.
const CORRELATIONS: [f64; 2] = [-0.75, 0.6];

/// Minimum disagreement of two sensors (rms), rad; digits and noise are smaller.
const MIN_DISAGREEMENT: f64 = 0.006;

/// Minimum number of deviations.
const MIN_DEVIATIONS: usize = 40;

/// Maximum share of the sum of squares next to repeated readings; a channel in coarse steps, or written only on change,
/// has a larger share.
const MAX_REPEATED_SHARE: f64 = 0.5;

/// Disagreement of the two sensors of a channel (rms), in the unit of the values; `None` for a single sensor.
///
/// If two smooth signals alternate, the deviation of a reading from the straight line between its neighbours changes
/// its sign at every reading.
pub(super) fn sensor_disagreement(time: &[f64], values: &[f64]) -> Option<f64> {
    let (mut deviations, mut beside_repeated) = (Vec::new(), 0.0);
    for ([before, at, after], deviation) in readings::deviations(time, values) {
        let repeats = values[before] == values[at] || values[at] == values[after];
        beside_repeated += if repeats { deviation * deviation } else { 0.0 };
        deviations.push(deviation);
    }
    if deviations.len() < MIN_DEVIATIONS {
        return None;
    }
    let product =
        |lag: usize| deviations.iter().zip(&deviations[lag..]).map(|(first, second)| first * second).sum::<f64>();
    let square = product(0);
    if beside_repeated > MAX_REPEATED_SHARE * square {
        return None;
    }
    let rms = (square / deviations.len() as f64).sqrt();
    let alternates = product(1) < CORRELATIONS[0] * square && product(2) > CORRELATIONS[1] * square;
    (rms > MIN_DISAGREEMENT && alternates).then_some(rms)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_sensors_are_told_from_noise_and_digits() {
        let time: Vec<f64> = (0..400).map(|k| 0.5 * f64::from(k)).collect();
        let signal = |t: f64| 0.4 * (0.05 * t).sin();
        let values = |value: &dyn Fn(usize, f64) -> f64| -> Vec<f64> {
            time.iter().enumerate().map(|(row, &t)| value(row, t)).collect()
        };
        let late = values(&|row, t| signal(if row % 2 == 0 { t } else { t - 5.0 }));
        let apart = sensor_disagreement(&time, &late).expect("two sensors");
        assert!((0.02..0.1).contains(&apart), "{apart}");
        let offset = values(&|row, t| signal(t) + if row % 2 == 0 { 0.0 } else { 0.035 });
        assert!(sensor_disagreement(&time, &offset).is_some());
        let noise = |row: usize| 0.02 * ((row as f64 * 12.9898).sin() * 43758.5453).fract();
        assert_eq!(sensor_disagreement(&time, &values(&|row, t| signal(t) + noise(row))), None);
        assert_eq!(sensor_disagreement(&time, &values(&|_, t| (signal(t) / 0.02).round() * 0.02)), None);
        // Every value is repeated once, as by a logger that writes a channel only when it changes.
        assert_eq!(sensor_disagreement(&time, &values(&|row, _| 0.02 * (row / 2) as f64)), None);
    }
}
