//! Point of a structure in the shape analysis, and its linearisation there.

use crate::fit::{FittedRecords, StructureFit, prior_deviation, prior_precision};
use crate::law;
use crate::linear::HeadingSensitivities;
use crate::noise::{NoiseColour, RecordNoise};
use crate::noise_law::{NoiseLaw, RecordWhitening};

use super::criterion::LinearisedStructure;
use super::motion::PredictedMotion;

/// Minimum gap, in usual steps between headings, after which heading and yaw rate restart.
const MIN_GAP_STEPS: f64 = 3.5;

/// Maximum number of such gaps per record: the longest ones.
const MAX_GAPS: usize = 4;

/// Structure at a point, with the noise transitions of a ship of its T.
#[derive(Clone)]
pub struct StructurePoint<'a> {
    problem: &'a FittedRecords,
    fit: &'a StructureFit,
    /// Standard deviations of the white noise of the records, rad.
    pub sd: Vec<f64>,
    /// Parameters θ of the structure, in the order of its entries.
    pub theta: Vec<f64>,
    initial: Vec<[f64; 2]>,
    noise: Vec<RecordNoise>,
}

impl<'a> StructurePoint<'a> {
    /// Point of a fit, with the variances of a noise law.
    pub fn new(problem: &'a FittedRecords, fit: &'a StructureFit, law: &NoiseLaw) -> Self {
        let (theta, initial) = (fit.theta.clone(), fit.initial.clone());
        let sd = law.row_variance.iter().map(|variance| variance.sqrt()).collect();
        Self { problem, fit, sd, noise: problem.noise_transitions(theta[0]), theta, initial }
    }

    /// Whitening under a colour.
    pub fn whitening(&self, colour: &NoiseColour) -> RecordWhitening {
        let whiteners = self.noise.iter().map(|noise| noise.whitener(colour)).collect();
        RecordWhitening { whiteners, scale: self.sd.iter().map(|sd| sd.recip()).collect() }
    }

    /// One-step-ahead predicted motions of the records under a colour.
    pub fn motions(&self, colour: &NoiseColour) -> Vec<PredictedMotion<'a>> {
        let structure = &self.fit.structure;
        let residual = self.problem.residual(structure, &self.theta, &self.initial);
        let is_of_moment = colour.correlated.is_some_and(|(kind, _)| !kind.is_heading_error());
        let motion = |number: usize| {
            let (record, initial) = (&self.problem.records[number], self.initial[number]);
            let predicted =
                is_of_moment.then(|| self.noise[number].whitener(colour).predicted_states(&residual[number]));
            PredictedMotion::new(record, number, structure, &self.theta, initial, predicted.as_deref())
        };
        (0..self.problem.records.len()).map(motion).collect()
    }

    /// Number of fitted entries of θ that belong to the base, and to the terms.
    fn counts(&self) -> [usize; 2] {
        let base = self.fit.structure.base_parameter_count();
        let fitted = self.fit.structure.fitted_indices();
        let of_base = fitted.iter().filter(|place| **place < base).count();
        [of_base, fitted.len() - of_base]
    }

    /// Linearisation with base, initial states and restarts after gaps first (integrated), then the parameters of the
    /// terms (penalised).
    pub fn linearised(&self, motions: &[PredictedMotion]) -> LinearisedStructure {
        let structure = &self.fit.structure;
        let mut linear = self.problem.linearise(structure, &self.theta, &self.initial);
        let [of_base, of_terms] = self.counts();
        let gaps: Vec<Vec<[Vec<f64>; 2]>> = motions.iter().map(restarts).collect();
        let states = linear.unknowns - of_terms;
        let integrated = states + 2 * gaps.iter().map(Vec::len).sum::<usize>();
        let mut next = states;
        for ((block, motion), gaps) in linear.blocks.iter_mut().zip(motions).zip(gaps) {
            for (unknown, _) in &mut block.columns {
                *unknown = match *unknown {
                    k if k < of_base => k,
                    k if k < of_base + of_terms => k - of_base + integrated,
                    k => k - of_terms,
                };
            }
            for columns in gaps {
                block.columns.extend((next..).zip(columns));
                next += 2;
            }
            if structure.terms.is_empty() {
                use_predicted_rate(block, motion);
            }
        }
        linear.unknowns = integrated + of_terms;
        let (entries, fitted) = (structure.entries(), structure.fitted_indices());
        let mut prior = vec![(0.0, 0.0); integrated];
        // Deviations of the rudder bias from record to record are expected to be small.
        for (place, prior) in prior.iter_mut().enumerate().take(of_base).skip(ship::response::BASE_PARAMETER_COUNT) {
            let (expected, value) = (entries[fitted[place]].prior, self.theta[fitted[place]]);
            let precision = prior_precision(expected);
            *prior = (precision, prior_deviation(expected, value) / precision.sqrt());
        }
        let neutral: Vec<f64> = structure.terms.iter().flat_map(|term| term.neutral()).collect();
        let size = |&place: &usize| match entries[place].prior.is_shape {
            true => 0.0,
            false => self.theta[place] - neutral[place - structure.base_parameter_count()],
        };
        LinearisedStructure {
            linear,
            integrated,
            prior,
            departures_from_neutral: fitted[of_base..].iter().map(size).collect(),
            min_variance: self.min_variance(),
        }
    }

    /// Lower bound of the white-noise variance of a row relative to the variance of the record, in the record where it
    /// is largest.
    fn min_variance(&self) -> f64 {
        // With a typical gain for this length and speed, so that it is equal for every structure.
        let floors = law::min_noise_variances(self.problem, self.problem.ship_length_time.powi(-2));
        floors.iter().zip(&self.sd).map(|(floor, sd)| floor / (sd * sd)).fold(0.0, f64::max)
    }

    /// Point after a step of all unknowns of [`linearised`](Self::linearised), within their bounds. 1/T decreases by at
    /// most half of its magnitude and increases by at most its magnitude.
    #[must_use]
    pub fn after_step(&self, step: &[f64]) -> Self {
        let mut next = self.clone();
        let [of_base, of_terms] = self.counts();
        let entries = self.fit.structure.entries();
        for (k, place) in self.fit.structure.fitted_indices().into_iter().enumerate() {
            let by = if k < of_base { step[k] } else { step[step.len() - of_terms + k - of_base] };
            let prior = &entries[place].prior;
            next.theta[place] = (self.theta[place] + by).clamp(prior.lowest, prior.highest);
        }
        let (before, size) = (self.theta[0], self.theta[0].abs());
        next.theta[0] = next.theta[0].clamp(before - 0.5 * size, before + size);
        for (number, initial) in next.initial.iter_mut().enumerate() {
            initial.iter_mut().zip(&step[of_base + 2 * number..]).for_each(|(state, by)| *state += by);
        }
        next.noise = self.problem.noise_transitions(next.theta[0]);
        next
    }
}

/// Replaces the sensitivity to 1/T by the response to the moment of the predicted yaw rate, which is exact under any
/// noise.
fn use_predicted_rate(block: &mut HeadingSensitivities, motion: &PredictedMotion) {
    let moment: Vec<f64> = motion.yaw_rate.iter().map(|rate| -rate / motion.base[1]).collect();
    let by_inverse_time = block.columns.iter_mut().find(|(unknown, _)| *unknown == 0);
    by_inverse_time.into_iter().for_each(|(_, column)| *column = motion.heading_response(&moment));
}

/// Columns of a restart of heading and yaw rate after each of the largest gaps.
fn restarts(motion: &PredictedMotion) -> Vec<[Vec<f64>; 2]> {
    let time: Vec<f64> = motion.record.observed_rows.iter().map(|&row| motion.record.time[row]).collect();
    let lengths: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut sorted = lengths.clone();
    sorted.sort_by(f64::total_cmp);
    let Some(usual) = sorted.get(sorted.len() / 2) else { return Vec::new() };
    let mut gaps: Vec<usize> = (0..lengths.len()).filter(|&row| lengths[row] > MIN_GAP_STEPS * usual).collect();
    gaps.sort_by(|&a, &b| lengths[b].total_cmp(&lengths[a]));
    let columns = |&row: &usize| {
        let after = |value: &dyn Fn(f64) -> f64| -> Vec<f64> {
            time.iter().map(|&t| if t < time[row + 1] { 0.0 } else { value(t - time[row + 1]) }).collect()
        };
        [after(&|_| 1.0), after(&|t| motion.rate_response(t))]
    };
    gaps.iter().take(MAX_GAPS).map(columns).collect()
}
