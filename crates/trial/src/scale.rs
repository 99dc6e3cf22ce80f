//! Records of similar ships of different length: which have a scale in common, how all are brought to that of
//! the first, and whether a number that was found at each scale is the same in prime units. It fits nothing.

use document::Quantity;
use document::scales::Scaling;
use ship::Particulars;
use thiserror::Error;

use crate::record::Trial;

/// Lengths that differ by no more than this share are those of one ship. Speeds of one ship are no scales: whether K
/// and T follow the speed is for the records to say.
const SAME: f64 = 0.05;

/// Why records cannot be brought to one scale.
#[derive(Debug, Clone, PartialEq, Error)]
#[expect(missing_docs, reason = "the message of a variant says what its fields are")]
pub enum ScaleError {
    /// A record of unknown length and speed among records of several scales.
    #[error(
        "the records are of {scales} scales, and length and speed of {record} are not declared; declare them in its sidecar"
    )]
    Unknown { record: String, scales: usize },
    /// Length or speed are no positive numbers.
    #[error("{record}: length {length} m and speed {speed} m/s have to be positive for a change of scale")]
    NotPositive { record: String, length: f64, speed: f64 },
}

/// The scales of some records, in the order in which they appear.
#[derive(Debug, Clone, PartialEq)]
pub struct Scales {
    /// Length and speed of the first record of every length.
    pub particulars: Vec<Particulars>,
    /// The scale of every record.
    pub of: Vec<usize>,
}

impl Scales {
    /// The scales of records; `None` where all have one, or where it is not declared for enough of them to differ.
    ///
    /// Fails where records differ in scale and one has none.
    pub fn among<'a>(trials: impl Iterator<Item = &'a Trial> + Clone) -> Result<Option<Self>, ScaleError> {
        let near = |one: f64, other: f64| (one - other).abs() <= SAME * other.abs();
        let mut particulars: Vec<Particulars> = Vec::new();
        let mut of = Vec::new();
        for own in trials.clone().map(Trial::particulars) {
            of.push(own.map(|own| {
                let is_of = |known: &Particulars| near(own.length, known.length);
                particulars.iter().position(is_of).unwrap_or_else(|| {
                    particulars.push(own);
                    particulars.len() - 1
                })
            }));
        }
        let scales = particulars.len();
        if scales < 2 {
            return Ok(None);
        }
        for (trial, own) in trials.clone().zip(&of) {
            let record = || trial.name().to_owned();
            match trial.particulars() {
                Some(Particulars { length, speed }) if !(length > 0.0 && speed > 0.0) => {
                    return Err(ScaleError::NotPositive { record: record(), length, speed });
                }
                _ if own.is_none() => return Err(ScaleError::Unknown { record: record(), scales }),
                _ => {}
            }
        }
        Ok(Some(Self { particulars, of: of.into_iter().flatten().collect() }))
    }

    /// Records that are all brought to the scale of the first, each from its own length and speed.
    pub fn bring_together(&self, trials: Vec<Trial>) -> Vec<Trial> {
        let one = |trial: Trial| trial.scaled_to(self.particulars[0]).unwrap_or(trial);
        trials.into_iter().map(one).collect()
    }

    /// Numbers of the first `count` records, one list for every scale that is among them.
    pub fn groups(&self, count: usize) -> Vec<(Particulars, Vec<usize>)> {
        let own = |scale: usize| (0..count.min(self.of.len())).filter(|&record| self.of[record] == scale).collect();
        let all = self.particulars.iter().enumerate().map(|(scale, particulars)| (*particulars, own(scale)));
        all.filter(|(_, records): &(_, Vec<usize>)| !records.is_empty()).collect()
    }
}

/// Standard deviations from which on a difference is no chance: one in 370 of a normal law.
const FAR: f64 = 3.0;

/// A difference of this share of the value has to be visible before "scales" is said.
const TELLING: f64 = 0.25;

/// A number is not known better than this share of it.
const ROUNDING: f64 = 1e-12;

/// Holds numbers without dimension, found independently at different scales, against each other: the largest
/// difference of two, x₂ − x₁ in units of √(s₁² + s₂²), and what it says. The difference is `None` where fewer
/// than two of the numbers have a standard deviation.
pub fn scaling(found: &[Quantity]) -> (Option<f64>, Scaling) {
    let known: Vec<(f64, f64)> = found
        .iter()
        .filter_map(|one| Some((one.value, one.sd?)))
        .filter(|(value, sd)| value.is_finite() && sd.is_finite())
        .collect();
    let mut largest: Option<f64> = None;
    let mut is_telling = known.len() == found.len();
    for (number, one) in known.iter().enumerate() {
        for other in &known[number + 1..] {
            let size = one.0.abs().max(other.0.abs());
            // Records without noise know a number to its rounding and no better.
            let sd = one.1.hypot(other.1).max(ROUNDING * size);
            let difference = (other.0 - one.0) / sd;
            is_telling &= FAR * sd <= TELLING * size;
            if difference.is_finite() && largest.is_none_or(|largest| difference.abs() > largest.abs()) {
                largest = Some(difference);
            }
        }
    }
    let word = match largest {
        Some(difference) if difference.abs() > FAR => Scaling::DoesNotScale,
        Some(_) if is_telling => Scaling::Scales,
        _ => Scaling::CannotBeTold,
    };
    (largest, word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::channel::Channel;
    use crate::record::{Columns, Origin};

    fn record(name: &str, own: Option<(f64, f64)>) -> Trial {
        let time: Vec<f64> = (0..20).map(f64::from).collect();
        let channels = [(Channel::Rudder, vec![0.1; 20]), (Channel::Heading, time.clone())].into();
        let origin = Origin::Measured { file: name.into(), sha256: String::new() };
        let trial = Trial::new(name, origin, Columns { time, channels, unknown: Vec::new() }).expect("a record");
        match own {
            Some((length, speed)) => trial.with_particulars(Particulars { length, speed }),
            None => trial,
        }
    }

    #[test]
    fn records_of_about_one_length_are_of_one_scale() {
        let [a, b] = [record("a", Some((7.0, 1.18))), record("b", Some((320.0, 7.97)))];
        let [c, unknown] = [record("c", Some((7.05, 0.9))), record("u", None)];
        assert_eq!(Scales::among([&a, &c].into_iter()), Ok(None));
        assert_eq!(Scales::among([&a, &unknown].into_iter()), Ok(None));
        let scales = Scales::among([&a, &b, &c].into_iter()).expect("declared").expect("two");
        assert_eq!((scales.of.as_slice(), scales.particulars.len()), ([0, 1, 0].as_slice(), 2));
        let groups: Vec<Vec<usize>> = scales.groups(3).into_iter().map(|(_, records)| records).collect();
        assert_eq!(groups, [vec![0, 2], vec![1]]);
        assert_eq!(scales.groups(1).len(), 1);
        let together = scales.bring_together(vec![a.clone(), b.clone(), c]);
        assert!((together[1].duration() / b.duration() - 7.0 / 1.18 / (320.0 / 7.97)).abs() < 1e-12);
        assert!((together[2].duration() / a.duration() - 7.0 / 1.18 / (7.05 / 0.9)).abs() < 1e-12);
        let error = Scales::among([&a, &b, &unknown].into_iter()).expect_err("no scale").to_string();
        assert!(error.contains("length and speed of u are not declared"), "{error}");
        let still = record("still", Some((7.0, 0.0)));
        assert!(matches!(Scales::among([&b, &still].into_iter()), Err(ScaleError::NotPositive { .. })));
    }

    #[test]
    fn a_difference_is_judged_by_its_error() {
        let of = |value: f64, sd: f64| Quantity::new(value, Some(sd));
        let (difference, word) = scaling(&[of(1.0, 0.03), of(1.05, 0.04)]);
        assert!(word == Scaling::Scales && difference.is_some_and(|d| (d - 1.0).abs() < 1e-9), "{difference:?}");
        assert_eq!(scaling(&[of(1.0, 0.03), of(1.2, 0.04)]).1, Scaling::DoesNotScale);
        assert_eq!(scaling(&[of(1.0, 0.3), of(1.2, 0.4)]).1, Scaling::CannotBeTold);
        assert_eq!(scaling(&[of(1.0, 0.3), Quantity::bare(2.0)]), (None, Scaling::CannotBeTold));
        // One of three without an error: what the others say is said, but not that all agree.
        let three = [of(1.0, 0.01), Quantity::bare(1.0), of(1.01, 0.01)];
        assert_eq!(scaling(&three).1, Scaling::CannotBeTold);
        let (difference, word) = scaling(&[of(1.0, 0.01), of(1.01, 0.01), of(0.9, 0.01)]);
        assert!(difference.is_some_and(|d| (d + 0.11 / 0.01 / 2f64.sqrt()).abs() < 1e-9), "{difference:?}");
        assert_eq!(word, Scaling::DoesNotScale);
    }
}
