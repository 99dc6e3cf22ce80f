//! Every record of several identified alone: whether K and T of a first-order response depend on the amplitude.

use document::fit::{SingleRecord, SingleRecords};
use identify::{Estimate, Identifier};
use rayon::prelude::*;
use ship::angle::to_deg;
use trial::{Trial, ZigZag};

/// Mean size of the rudder of a zig-zag, and of its heading at the peaks, rad.
fn amplitudes(trial: &Trial) -> Option<[f64; 2]> {
    let zigzag = ZigZag::of(trial).ok()?;
    let base = zigzag.base_course.heading.value;
    let peaks: Vec<f64> = zigzag.overshoots.iter().map(|one| (one.peak_heading.value - base).abs()).collect();
    let rudders: Vec<f64> = zigzag.executes.iter().map(|one| one.rudder_after.abs()).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    (!peaks.is_empty() && !rudders.is_empty()).then(|| [mean(&rudders), mean(&peaks)])
}

fn alone(trial: &Trial, method: &dyn Identifier) -> Option<SingleRecord> {
    let of = |estimate: Estimate| {
        let [rudder_deg, heading_deg] = amplitudes(trial)?.map(to_deg);
        Some(SingleRecord { rudder_deg, heading_deg, k_per_s: estimate.K(), t_s: estimate.T() })
    };
    method.identify(std::slice::from_ref(trial)).ok().and_then(of).filter(|own| own.k_per_s.value.is_finite())
}

/// Every record alone by the first of some methods, or by the next where that fails for one of them; `None` for less
/// than two zig-zags.
pub fn of_records(trials: &[Trial], methods: &[&dyn Identifier]) -> Option<SingleRecords> {
    let zigzags: Vec<&Trial> = trials.iter().filter(|trial| amplitudes(trial).is_some()).collect();
    let mut best: Option<SingleRecords> = None;
    for method in methods.iter().filter(|_| zigzags.len() > 1) {
        let records: Vec<SingleRecord> = zigzags.par_iter().filter_map(|trial| alone(trial, *method)).collect();
        let complete = records.len() == zigzags.len();
        if best.as_ref().is_none_or(|best| records.len() > best.records.len()) {
            best = Some(SingleRecords { method: method.id().to_owned(), records });
        }
        if complete {
            break;
        }
    }
    best.filter(|best| best.records.len() > 1)
}
