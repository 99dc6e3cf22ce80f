//! Every record identified alone, to show whether K and T of a first-order response depend on the amplitude.

use document::single_records::{SingleRecord, SingleRecords, ZigZagAmplitude};
use identify::Identifier;
use rayon::prelude::*;
use ship::angle::to_deg;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use trial::{Quantity, Trial, ZigZag};

use crate::records::unique_names;

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

/// Mean rudder angle of the executes, and mean peak of the heading about the base course; `None` without a zig-zag.
fn amplitude(trial: &Trial) -> Option<ZigZagAmplitude> {
    let zigzag = ZigZag::from_trial(trial).ok()?;
    let base = zigzag.base_course.heading.value;
    let peaks = zigzag.overshoots.iter().map(|overshoot| (overshoot.peak_heading.value - base).abs());
    let rudders = zigzag.executes.iter().map(|execute| execute.rudder_after.abs());
    Some(ZigZagAmplitude { rudder_deg: to_deg(mean(rudders)?), heading_deg: to_deg(mean(peaks)?) })
}

/// Zig-zag among the records: the record, its name and its amplitude.
struct RecordedZigZag<'a> {
    trial: &'a Trial,
    name: String,
    amplitude: ZigZagAmplitude,
}

impl RecordedZigZag<'_> {
    fn single_record(&self, method: &dyn Identifier) -> Option<SingleRecord> {
        let estimate = method.identify(std::slice::from_ref(self.trial)).ok()?;
        let (record, amplitude) = (self.name.clone(), self.amplitude);
        let single = SingleRecord { record, amplitude, k_per_s: estimate.K(), t_s: estimate.T() };
        Some(single).filter(|single| single.k_per_s.value.is_finite())
    }
}

/// All zig-zags among some records, each with its name and amplitude.
pub struct RecordedZigZags<'a>(Vec<RecordedZigZag<'a>>);

impl<'a> RecordedZigZags<'a> {
    /// Zig-zags among the records; all other records are left out.
    pub fn from_trials(trials: &'a [Trial]) -> Self {
        let named = trials.iter().zip(unique_names(trials.iter().map(Trial::name)));
        Self(
            named
                .filter_map(|(trial, name)| Some(RecordedZigZag { trial, name, amplitude: amplitude(trial)? }))
                .collect(),
        )
    }

    /// Mean amplitude; `None` without a zig-zag.
    pub fn mean_amplitude(&self) -> Option<ZigZagAmplitude> {
        Some(ZigZagAmplitude {
            rudder_deg: mean(self.0.iter().map(|zigzag| zigzag.amplitude.rudder_deg))?,
            heading_deg: mean(self.0.iter().map(|zigzag| zigzag.amplitude.heading_deg))?,
        })
    }

    /// Estimates of every record alone by one method: the first that identifies all records, else the one that
    /// identifies most; `None` for fewer than two estimates.
    pub fn single_records(&self, methods: &[&dyn Identifier]) -> Option<SingleRecords> {
        let zigzags = &self.0;
        let mut best: Option<SingleRecords> = None;
        for method in methods.iter().filter(|_| zigzags.len() > 1) {
            let records: Vec<SingleRecord> =
                zigzags.par_iter().filter_map(|zigzag| zigzag.single_record(*method)).collect();
            let complete = records.len() == zigzags.len();
            if best.as_ref().is_none_or(|best| records.len() > best.records.len()) {
                let agree = agree(&records);
                best = Some(SingleRecords { method: method.id().to_owned(), records, is_consistent: agree });
            }
            if complete {
                break;
            }
        }
        best.filter(|best| best.records.len() > 1)
    }
}

/// Significance level of the difference between records.
const SIGNIFICANCE: f64 = 0.05;

/// `true` if K and T of some records agree: the sum of their squared distances from the weighted means, in standard
/// deviations, is χ² with 2 (n − 1) degrees of freedom, tested at [`SIGNIFICANCE`] without the correlation of K and T.
/// `None` if an estimate has no standard deviation.
fn agree(records: &[SingleRecord]) -> Option<bool> {
    let deviation = |pick: fn(&SingleRecord) -> Quantity| -> Option<f64> {
        let all = records.iter().map(|fit| Some((pick(fit).value, pick(fit).sd.filter(|sd| *sd > 0.0)?.powi(-2))));
        let all: Vec<(f64, f64)> = all.collect::<Option<_>>()?;
        let weight: f64 = all.iter().map(|(_, weight)| weight).sum();
        let middle = all.iter().map(|(value, weight)| value * weight).sum::<f64>() / weight;
        Some(all.iter().map(|(value, weight)| weight * (value - middle).powi(2)).sum())
    };
    let sum = deviation(|record| record.k_per_s)? + deviation(|record| record.t_s)?;
    let chance = ChiSquared::new(2.0 * (records.len() as f64 - 1.0)).ok()?;
    Some(chance.sf(sum) >= SIGNIFICANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two values one standard deviation from their mean each, of K and of T: χ²₂ = 4, probability exp(−2) = 0.135; two
    /// standard deviations: χ²₂ = 16, exp(−8).
    #[test]
    fn records_agree_as_far_as_chance_goes() {
        let record = |k: f64, t: f64, sd: Option<f64>| SingleRecord {
            record: String::new(),
            amplitude: ZigZagAmplitude { rudder_deg: 10.0, heading_deg: 14.0 },
            k_per_s: Quantity { sd, ..Quantity::without_uncertainty(k) },
            t_s: Quantity { sd, ..Quantity::without_uncertainty(t) },
        };
        let pair = |apart: f64| agree(&[record(1.0, 2.0, Some(0.1)), record(1.0 + apart, 2.0 + apart, Some(0.1))]);
        assert_eq!((pair(0.2), pair(0.24), pair(0.25), pair(0.4)), (Some(true), Some(true), Some(false), Some(false)));
        assert_eq!(agree(&[record(1.0, 2.0, None), record(1.0, 2.0, Some(0.1))]), None);
    }
}
