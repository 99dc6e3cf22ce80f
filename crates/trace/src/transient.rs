//! Start values of moments with an instant: boxes of several durations, or steps, are tried at all times of a record.
//! Their closed-form heading response of the base is orthogonalised to all unknowns of the full model (score test; Rao
//! 1948).

use estimation::column::dot;
use nalgebra::{Cholesky, DVector, Dyn};
use ship::first_order::FirstOrderTransition;

use crate::fit::{FittedRecords, StructureFit, normal_equations};
use crate::linear::Linearisation;
use crate::model::Term;
use crate::noise_law::RecordWhitening;

/// Durations of the boxes as shares of the record.
const DURATION_SHARES: [f64; 4] = [1.0 / 40.0, 1.0 / 20.0, 1.0 / 10.0, 1.0 / 5.0];

/// Spacing of the steps that are tried, as a share of the record.
const STEP_SPACING: f64 = 1.0 / 80.0;

/// Best start values of moments in addition to a fit: (m, t_c, d) of a transient moment and (m, t₀) of a step, m in rad
/// of rudder and times in s; `None` if the precision of the fit is singular, or if the record is too short.
pub fn start_values(
    problem: &FittedRecords,
    fit: &StructureFit,
    whitening: &RecordWhitening,
    terms: &[&Term],
) -> Vec<Option<Vec<f64>>> {
    let linear = problem.linearise(&fit.structure, &fit.theta, &fit.initial);
    let normal = normal_equations(&linear, &fit.structure, &fit.theta, whitening);
    let Some(factor) = normal.matrix.clone().cholesky() else { return vec![None; terms.len()] };
    let explained = factor.solve(&normal.right_hand_side);
    terms.iter().map(|term| place(problem, fit, whitening, term, &linear, &factor, &explained)).collect()
}

/// Best start values of one moment in addition to a linearised fit, whose Gauss–Newton step is `explained`.
fn place(
    problem: &FittedRecords,
    fit: &StructureFit,
    whitening: &RecordWhitening,
    term: &Term,
    linear: &Linearisation,
    factor: &Cholesky<f64, Dyn>,
    explained: &DVector<f64>,
) -> Option<Vec<f64>> {
    let number = term.record_index.unwrap_or(0);
    let record = &problem.records[number];
    let block = linear.blocks[number].whitened(number, whitening);
    let (a, b) = (fit.theta[0], fit.theta[1]);
    let times: Vec<f64> = record.observed_rows.iter().map(|&row| record.time[row]).collect();
    let (start, duration) = (record.time[0], record.duration());
    let lasts = term.priors.len() == 2;
    let boxes: Vec<[f64; 2]> = match lasts {
        // A step is a box that outlasts the record.
        true => vec![[2.0 * duration, STEP_SPACING * duration]],
        false => DURATION_SHARES
            .map(|share| share * duration)
            .into_iter()
            .filter(|&box_duration| box_duration >= term.priors[2].lowest)
            .map(|box_duration| [box_duration, 0.5 * box_duration])
            .collect(),
    };
    let mut best: Option<(f64, Vec<f64>)> = None;
    for [box_duration, step] in boxes {
        let last = start + duration - if lasts { 0.0 } else { box_duration };
        let places = ((last - start) / step) as usize;
        for from in (0..=places).map(|k| start + step * k as f64) {
            let mut column: Vec<f64> = times
                .iter()
                .map(|t| b * (step_response(a, t - from) - step_response(a, t - from - box_duration)))
                .collect();
            whitening.apply(number, &mut [&mut column]);
            let mut cross = DVector::zeros(linear.unknowns);
            block.products(&column, &mut cross);
            let prior = term.priors[0].sd.powi(-2);
            let square = dot(&column, &column) - cross.dot(&factor.solve(&cross)) + prior;
            let product = dot(&column, &block.residual) - cross.dot(explained);
            let gain = product * product / square;
            if best.as_ref().is_none_or(|(largest, _)| gain > *largest) {
                let middle = if lasts { from } else { from + 0.5 * box_duration };
                best = Some((gain, [product / square, middle, box_duration][..term.priors.len()].to_vec()));
            }
        }
    }
    let inside = |(value, prior): (f64, &ship::effects::ParameterPrior)| value.clamp(prior.lowest, prior.highest);
    best.map(|(_, place)| place.into_iter().zip(&term.priors).map(inside).collect())
}

/// Heading (rad) of a first-order ship after a unit yaw acceleration (1 rad/s²) for t seconds.
fn step_response(inverse_time: f64, t: f64) -> f64 {
    if t > 0.0 { FirstOrderTransition::new(inverse_time, t).phi2 } else { 0.0 }
}
