//! Where in a record a moment may have been present for a while, or have set in: boxes of several lengths, or steps,
//! are tried at every place, with the response of the base in closed form, and the best places are handed on as starts
//! of a fit.

use lanes::column::dot;
use nalgebra::{DMatrix, DVector};
use ship::first_order::Transition;

use crate::fit::{Fit, Linearised, Problem};
use crate::structure::Term;

/// Lengths of the boxes as shares of the record.
const LENGTHS: [f64; 4] = [1.0 / 40.0, 1.0 / 20.0, 1.0 / 10.0, 1.0 / 5.0];

/// Places that are handed on.
const STARTS: usize = 2;

/// Lengths of time between steps that are tried, as a share of the record.
const BETWEEN_STEPS: f64 = 1.0 / 80.0;

/// Starts (m, t_c, d) of a passing moment or (m, t₀) of a lasting one on top of a fit, the most promising first.
///
/// `known` are the whitened residual and sensitivities at that fit.
pub fn starts(problem: &Problem, fit: &Fit, known: &Linearised, term: &Term) -> Vec<Vec<f64>> {
    let number = term.only.map_or(0, |only| only.0);
    let record = &problem.records[number];
    let whitener = &known.whiteners[number];
    let columns: Vec<&[f64]> = known.columns.of_record(number).map(|(_, column)| column).collect();
    let residual = &known.white[number];
    let p = columns.len();
    let gram = DMatrix::from_fn(p, p, |i, j| dot(columns[i], columns[j]));
    let ridge = DMatrix::from_fn(p, p, |i, j| if i == j { 1e-10 * gram[(i, i)] + f64::MIN_POSITIVE } else { 0.0 });
    let Some(factor) = (gram + ridge).cholesky() else { return Vec::new() };
    let gradient = DVector::from_fn(p, |i, _| dot(columns[i], residual));
    let explained = factor.solve(&gradient);

    let (a, b) = (fit.theta[0], fit.theta[1]);
    let times: Vec<f64> = record.observed.iter().map(|&row| record.time[row]).collect();
    let (start, duration) = (record.time[0], record.duration());
    let mut found: Vec<(f64, [f64; 3])> = Vec::new();
    let mut column = vec![0.0; times.len()];
    let lasts = term.effect.parameters().len() == 2;
    // Length of a box and the step from one to the next; a lasting moment is a box that outlasts the record.
    let boxes: Vec<[f64; 2]> = match lasts {
        true => vec![[2.0 * duration, BETWEEN_STEPS * duration]],
        false => {
            let lengths = LENGTHS.map(|share| share * duration).into_iter();
            lengths.filter(|&length| length >= term.lowest[2]).map(|length| [length, 0.5 * length]).collect()
        }
    };
    for [length, step] in boxes {
        let (mut from, end) = (start, start + duration - if lasts { 0.0 } else { length });
        while from <= end {
            for (value, &t) in column.iter_mut().zip(&times) {
                *value = b * (step_response(a, t - from) - step_response(a, t - from - length));
            }
            whitener.apply(&mut [&mut column]);
            let cross = DVector::from_fn(p, |i, _| dot(columns[i], &column));
            let own = dot(&column, &column) - cross.dot(&factor.solve(&cross));
            let with = dot(&column, residual) - cross.dot(&explained);
            if own > 1e-9 * dot(&column, &column) {
                let place = if lasts { from } else { from + 0.5 * length };
                found.push((with * with / own, [with / own, place, if lasts { step } else { length }]));
            }
            from += step;
        }
    }
    found.sort_by(|one, other| other.0.total_cmp(&one.0));
    let mut starts: Vec<[f64; 3]> = Vec::new();
    for (_, place) in found {
        // Neighbours lead to the same minimum.
        if starts.iter().all(|other| (other[1] - place[1]).abs() > 0.5 * (other[2] + place[2])) {
            starts.push(place);
        }
        if starts.len() == STARTS {
            break;
        }
    }
    starts.into_iter().map(|start| start[..term.effect.parameters().len()].to_vec()).collect()
}

/// Heading after a unit yaw acceleration has acted for t seconds.
fn step_response(inverse_time: f64, t: f64) -> f64 {
    if t > 0.0 { Transition::new(inverse_time, t).phi2 } else { 0.0 }
}
