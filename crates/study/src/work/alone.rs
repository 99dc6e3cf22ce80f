//! Every record of several identified alone, and zig-zags of a fitted model identified as if they were records: whether
//! K and T of a first-order response depend on the amplitude.

use ::trace::Analysis;
use identify::{Estimate, Identifier, output_error};
use rayon::prelude::*;
use ship::angle::{from_deg, to_deg};
use simulate::manoeuvre::{ZigZag as Order, ZigZagEnd};
use simulate::{Manoeuvre, Side};
use trial::{Trial, ZigZag};

use super::planned;
use crate::views::index_figures::{Alone, Amplitudes};

/// Rudder and heading of the zig-zags of a model, deg.
const SAILED: [f64; 10] = [5.0, 7.5, 10.0, 12.5, 15.0, 17.5, 20.0, 25.0, 30.0, 35.0];

/// Executes of each.
const EXECUTES: usize = 5;

/// A model is sailed up to so many times the largest rudder of the records.
const BEYOND: f64 = 1.05;

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
            best = Some(Amplitudes { method: method.id(), records, model: Vec::new() });
        }
        if complete {
            break;
        }
    }
    best.filter(|best| best.records.len() > 1)
}

/// The same by the method that gives an analysis its base, with zig-zags that the fitted model was steered through. A
/// model that follows a measured quantity, such as the speed, cannot be steered without it.
pub fn of_analysis(analysis: &Analysis, trials: &[Trial]) -> Option<Amplitudes> {
    let method = output_error::Settings::default().build().expect("default settings are valid");
    let mut all = of_records(trials, &[&method])?;
    if analysis.ship().model().effects().iter().any(|effect| effect.needs().is_some()) {
        return Some(all);
    }
    let rudders = trials.iter().flat_map(|trial| trial.rudder());
    let largest = to_deg(rudders.fold(0.0, |largest: f64, rudder| largest.max(rudder.abs())));
    let sail = |angle: &f64| {
        let order = Order {
            rudder: from_deg(*angle),
            heading: from_deg(*angle),
            first: Side::Starboard,
            end: ZigZagEnd::Executes(EXECUTES),
        };
        alone(&planned::sailed(analysis, trials, Manoeuvre::ZigZag(order))?, &method)
    };
    let angles: Vec<f64> = SAILED.into_iter().filter(|angle| *angle <= BEYOND * largest).collect();
    all.model = angles.par_iter().filter_map(sail).collect();
    all.model.sort_by(|one, other| one.amplitudes[0].total_cmp(&other.amplitudes[0]));
    Some(all)
}
