//! Scales of records of similar ships of different length: groups of equal scale, conversion to the scale of the first
//! record, and a comparison of dimensionless estimates between scales.
//!
//! Source: Froude (1868) for V ~ √L; the prime system for any speed.

use document::Quantity;
use document::scales::ScalingVerdict;
use ship::Particulars;
use thiserror::Error;

use crate::record::Trial;

/// Tolerance of equal lengths, as a share. Different speeds of the same ship are not different scales: the records
/// determine whether K and T follow the speed.
const LENGTH_TOLERANCE: f64 = 0.05;

/// Error of records without a common scale.
#[derive(Debug, Clone, PartialEq, Error)]
#[expect(missing_docs, reason = "the message of a variant says what its fields are")]
pub enum ScaleError {
    /// Record of unknown length and speed among records of several scales.
    #[error(
        "the records have {scales} scales, but length and speed of {record} are not declared; declare them in its sidecar"
    )]
    Unknown { record: String, scales: usize },
    /// Length or speed is not positive.
    #[error("{record}: length {length} m and speed {speed} m/s have to be positive for a change of scale")]
    NotPositive { record: String, length: f64, speed: f64 },
}

/// Scales of records, in the order of their occurrence.
#[derive(Debug, Clone, PartialEq)]
pub struct ShipScales {
    /// Length and speed of the first record of every length.
    pub particulars: Vec<Particulars>,
    /// Index of the scale of every record.
    pub scale_indices: Vec<usize>,
}

impl ShipScales {
    /// Scales of records; `None` if the declared scales do not differ.
    ///
    /// Fails if records differ in scale and a record does not declare its scale.
    pub fn from_trials<'a>(trials: impl Iterator<Item = &'a Trial> + Clone) -> Result<Option<Self>, ScaleError> {
        let mut particulars: Vec<Particulars> = Vec::new();
        let mut indices = Vec::new();
        for declared in trials.clone().map(Trial::particulars) {
            indices.push(declared.map(|ship| {
                let is_scale =
                    |first: &Particulars| (ship.length - first.length).abs() <= LENGTH_TOLERANCE * first.length.abs();
                particulars.iter().position(is_scale).unwrap_or_else(|| {
                    particulars.push(ship);
                    particulars.len() - 1
                })
            }));
        }
        let scales = particulars.len();
        if scales < 2 {
            return Ok(None);
        }
        for (trial, scale) in trials.clone().zip(&indices) {
            let record = || trial.name().to_owned();
            match trial.particulars() {
                Some(Particulars { length, speed }) if !(length > 0.0 && speed > 0.0) => {
                    return Err(ScaleError::NotPositive { record: record(), length, speed });
                }
                _ if scale.is_none() => return Err(ScaleError::Unknown { record: record(), scales }),
                _ => {}
            }
        }
        Ok(Some(Self { particulars, scale_indices: indices.into_iter().flatten().collect() }))
    }

    /// Records converted to the scale of the first, each from its declared length and speed; without these, unchanged.
    pub fn to_first_scale(&self, trials: Vec<Trial>) -> Vec<Trial> {
        let scaled = |trial: Trial| trial.scaled_to(self.particulars[0]).unwrap_or(trial);
        trials.into_iter().map(scaled).collect()
    }

    /// Length and speed of every scale, with the indices of its records among the first `count`.
    pub fn groups(&self, count: usize) -> Vec<(Particulars, Vec<usize>)> {
        let records = |scale: usize| {
            (0..count.min(self.scale_indices.len())).filter(|&record| self.scale_indices[record] == scale).collect()
        };
        let all = self.particulars.iter().enumerate().map(|(scale, particulars)| (*particulars, records(scale)));
        all.filter(|(_, records): &(_, Vec<usize>)| !records.is_empty()).collect()
    }
}

/// Minimum significant difference, standard deviations: a normal variate exceeds it with a probability of 1/370.
const SIGNIFICANT_SDS: f64 = 3.0;

/// Difference, as a share of the value, that must be significant before a number is accepted as independent of scale.
const RESOLVED_SHARE: f64 = 0.25;

/// Minimum relative standard deviation: the rounding of the arithmetic.
const ROUNDING: f64 = 1e-12;

/// Comparison of independent dimensionless estimates at different scales: the difference of two, x₂ − x₁ in units of
/// √(s₁² + s₂²), with the maximum magnitude, and its verdict. The difference is `None` if fewer than two estimates have
/// a standard deviation.
pub fn compare_scales(estimates: &[Quantity]) -> (Option<f64>, ScalingVerdict) {
    let with_sd: Vec<(f64, f64)> = estimates
        .iter()
        .filter_map(|estimate| Some((estimate.value, estimate.sd?)))
        .filter(|(value, sd)| value.is_finite() && sd.is_finite())
        .collect();
    let mut largest: Option<f64> = None;
    let mut is_resolved = with_sd.len() == estimates.len();
    for (number, first) in with_sd.iter().enumerate() {
        for second in &with_sd[number + 1..] {
            let size = first.0.abs().max(second.0.abs());
            // Records without noise give an estimate to its rounding.
            let sd = first.1.hypot(second.1).max(ROUNDING * size);
            let difference = (second.0 - first.0) / sd;
            is_resolved &= SIGNIFICANT_SDS * sd <= RESOLVED_SHARE * size;
            if difference.is_finite() && largest.is_none_or(|largest| difference.abs() > largest.abs()) {
                largest = Some(difference);
            }
        }
    }
    let word = match largest {
        Some(difference) if difference.abs() > SIGNIFICANT_SDS => ScalingVerdict::DoesNotScale,
        Some(_) if is_resolved => ScalingVerdict::Scales,
        _ => ScalingVerdict::Undecided,
    };
    (largest, word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::channel::Channel;
    use crate::record::{Columns, RecordOrigin};

    fn record(name: &str, scale: Option<(f64, f64)>) -> Trial {
        let time: Vec<f64> = (0..20).map(f64::from).collect();
        let channels = [(Channel::Rudder, vec![0.1; 20]), (Channel::Heading, time.clone())].into();
        let origin = RecordOrigin::Measured { file: name.into(), sha256: String::new() };
        let trial =
            Trial::new(name, origin, Columns { time, channels, unknown_columns: Vec::new() }).expect("a record");
        match scale {
            Some((length, speed)) => trial.with_particulars(Particulars { length, speed }),
            None => trial,
        }
    }

    #[test]
    fn records_of_about_one_length_are_of_one_scale() {
        let [a, b] = [record("a", Some((7.0, 1.18))), record("b", Some((320.0, 7.97)))];
        let [c, unknown] = [record("c", Some((7.05, 0.9))), record("u", None)];
        assert_eq!(ShipScales::from_trials([&a, &c].into_iter()), Ok(None));
        assert_eq!(ShipScales::from_trials([&a, &unknown].into_iter()), Ok(None));
        let scales = ShipScales::from_trials([&a, &b, &c].into_iter()).expect("declared").expect("two");
        assert_eq!((scales.scale_indices.as_slice(), scales.particulars.len()), ([0, 1, 0].as_slice(), 2));
        let groups: Vec<Vec<usize>> = scales.groups(3).into_iter().map(|(_, records)| records).collect();
        assert_eq!(groups, [vec![0, 2], vec![1]]);
        assert_eq!(scales.groups(1).len(), 1);
        let together = scales.to_first_scale(vec![a.clone(), b.clone(), c]);
        assert!((together[1].duration() / b.duration() - 7.0 / 1.18 / (320.0 / 7.97)).abs() < 1e-12);
        assert!((together[2].duration() / a.duration() - 7.0 / 1.18 / (7.05 / 0.9)).abs() < 1e-12);
        let error = ShipScales::from_trials([&a, &b, &unknown].into_iter()).expect_err("no scale").to_string();
        assert!(error.contains("length and speed of u are not declared"), "{error}");
        let still = record("still", Some((7.0, 0.0)));
        assert!(matches!(ShipScales::from_trials([&b, &still].into_iter()), Err(ScaleError::NotPositive { .. })));
    }

    #[test]
    fn a_difference_is_judged_by_its_error() {
        let of = |value: f64, sd: f64| Quantity::new(value, Some(sd));
        let (difference, word) = compare_scales(&[of(1.0, 0.03), of(1.05, 0.04)]);
        assert!(word == ScalingVerdict::Scales && difference.is_some_and(|d| (d - 1.0).abs() < 1e-9), "{difference:?}");
        assert_eq!(compare_scales(&[of(1.0, 0.03), of(1.2, 0.04)]).1, ScalingVerdict::DoesNotScale);
        assert_eq!(compare_scales(&[of(1.0, 0.3), of(1.2, 0.4)]).1, ScalingVerdict::Undecided);
        assert_eq!(
            compare_scales(&[of(1.0, 0.3), Quantity::without_uncertainty(2.0)]),
            (None, ScalingVerdict::Undecided)
        );
        // An estimate without a standard deviation is ignored, but excludes the verdict that all three agree.
        let three = [of(1.0, 0.01), Quantity::without_uncertainty(1.0), of(1.01, 0.01)];
        assert_eq!(compare_scales(&three).1, ScalingVerdict::Undecided);
        let (difference, word) = compare_scales(&[of(1.0, 0.01), of(1.01, 0.01), of(0.9, 0.01)]);
        assert!(difference.is_some_and(|d| (d + 0.11 / 0.01 / 2f64.sqrt()).abs() < 1e-9), "{difference:?}");
        assert_eq!(word, ScalingVerdict::DoesNotScale);
    }
}
