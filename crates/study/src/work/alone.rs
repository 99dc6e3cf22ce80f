//! Every record of several identified alone: whether K and T of a first-order response depend on the amplitude.

use identify::{Estimate, Identifier};
use rayon::prelude::*;
use trial::{Quantity, Trial, ZigZag};

/// K and T of one zig-zag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alone {
    /// Mean size of the rudder between its executes, and of the heading at the peaks from the base course, rad.
    pub amplitudes: [f64; 2],
    /// K, 1/s.
    pub k: Quantity,
    /// T, s.
    pub t: Quantity,
}

/// Every zig-zag of some records alone, with the method that was used.
#[derive(Debug, Clone, PartialEq)]
pub struct Amplitudes {
    /// Identifier of the method.
    pub method: &'static str,
    /// The records that are zig-zags and could be identified.
    pub records: Vec<Alone>,
}

/// Mean size of the rudder of a zig-zag, and of its heading at the peaks, rad.
fn amplitudes(trial: &Trial) -> Option<[f64; 2]> {
    let zigzag = ZigZag::of(trial).ok()?;
    let base = zigzag.base_course.heading.value;
    let peaks: Vec<f64> = zigzag.overshoots.iter().map(|one| (one.peak_heading.value - base).abs()).collect();
    let rudders: Vec<f64> = zigzag.executes.iter().map(|one| one.rudder_after.abs()).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    (!peaks.is_empty() && !rudders.is_empty()).then(|| [mean(&rudders), mean(&peaks)])
}

fn alone(trial: &Trial, method: &dyn Identifier) -> Option<Alone> {
    let of = |estimate: Estimate| Some(Alone { amplitudes: amplitudes(trial)?, k: estimate.K(), t: estimate.T() });
    method.identify(std::slice::from_ref(trial)).ok().and_then(of).filter(|own| own.k.value.is_finite())
}

/// Every record alone by the first of some methods, or by the next where that fails for one of them; `None` for less
/// than two zig-zags.
pub fn of_records(trials: &[Trial], methods: &[&dyn Identifier]) -> Option<Amplitudes> {
    let zigzags: Vec<&Trial> = trials.iter().filter(|trial| amplitudes(trial).is_some()).collect();
    let mut best: Option<Amplitudes> = None;
    for method in methods.iter().filter(|_| zigzags.len() > 1) {
        let records: Vec<Alone> = zigzags.par_iter().filter_map(|trial| alone(trial, *method)).collect();
        let complete = records.len() == zigzags.len();
        if best.as_ref().is_none_or(|best| records.len() > best.records.len()) {
            best = Some(Amplitudes { method: method.id(), records });
        }
        if complete {
            break;
        }
    }
    best.filter(|best| best.records.len() > 1)
}
