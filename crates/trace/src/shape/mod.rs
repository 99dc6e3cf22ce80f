//! Structure against chance: whether what a structure leaves of the records is a moment of a shape, a random moment, or
//! the noise of the instruments.
//!
//! A random moment can follow almost any heading, so a shape is held against every random law with the law found anew
//! beside the shape: G = ½ (h₀ − h), in nats, with −2 log p of the best law without the shapes and with them.

mod conditioned;
mod dictionary;
mod laws;
mod motion;
mod search;

use rayon::prelude::*;

use crate::fit::{FittedRecords, StructureFit, curvature, deviation};
use crate::linear::{HeadingSensitivities, Linear};
use crate::noise::{NoiseColour, RecordNoise};
use crate::record::PreparedRecord;
use crate::weights::{NoiseLaw, Weights};
use conditioned::{Conditioned, LinearisedStructure};
use laws::RandomLaw;
use motion::Motion;
use search::Search;

pub use dictionary::{Dependence, Shape};
pub use search::{Candidate, Explanation};

/// Gain in nats from which a shape is believed.
pub const BELIEVED: f64 = 4.0;

/// Within so many nats two explanations are alike.
pub const ALIKE: f64 = 3.0;

/// How often the response of the ship is found anew under the best law.
const ROUNDS: usize = 3;

/// A change of 1/T by less than this share ends that.
const SETTLED: f64 = 0.02;

/// A gap of more than so many usual steps between headings, and the gaps of a record that are bridged: the heading and
/// the yaw rate begin anew behind them.
const GAP: f64 = 3.5;
const MOST_GAPS: usize = 4;

/// The unit of the lags as a share of T.
const UNIT: f64 = 1.0 / 16.0;

/// What was found in what a structure leaves.
#[derive(Debug, Clone)]
pub struct Found {
    pub best: Explanation,
    pub tried: Vec<Explanation>,
    /// −2 log p of the structure alone, and its law.
    pub alone: f64,
    pub law: RandomLaw,
    pub gain: f64,
    pub smooth: f64,
    pub coefficients: Vec<Vec<f64>>,
}

/// A structure with its noise, as it is linearised.
struct Point<'a> {
    problem: &'a FittedRecords,
    fit: &'a StructureFit,
    law: &'a NoiseLaw,
    theta: Vec<f64>,
    initial: Vec<[f64; 2]>,
    noise: Vec<RecordNoise>,
}

impl<'a> Point<'a> {
    fn new(problem: &'a FittedRecords, fit: &'a StructureFit, law: &'a NoiseLaw) -> Self {
        let (theta, initial) = (fit.theta.clone(), fit.initial.clone());
        Self { problem, fit, law, noise: Self::noise(problem, theta[0]), theta, initial }
    }

    fn noise(problem: &FittedRecords, inverse_time: f64) -> Vec<RecordNoise> {
        let full = problem.records.iter().map(|record| record.full_readings).max().unwrap_or(1);
        let of = |record| RecordNoise::new(record, inverse_time, problem.longest(), full);
        problem.records.iter().map(of).collect()
    }

    /// What makes columns white under a colour.
    fn weights(&self, colour: &NoiseColour) -> Weights {
        let whiteners = self.noise.iter().map(|noise| noise.whitener(colour)).collect();
        Weights { whiteners, scale: self.law.variance.iter().map(|variance| variance.sqrt().recip()).collect() }
    }

    fn motions(&self, colour: &NoiseColour) -> Vec<Motion<'a>> {
        let residual = self.problem.residual(&self.fit.structure, &self.theta, &self.initial);
        let of = |(number, record): (usize, &'a PreparedRecord)| {
            let at = (self.theta.as_slice(), self.initial[number]);
            Motion::new(
                (record, number),
                &self.fit.structure,
                at,
                (&self.noise[number], colour),
                &residual[number],
            )
        };
        self.problem.records.iter().enumerate().map(of).collect()
    }

    /// Residual and columns: base, deviations, initial states and gaps first, the parameters of the terms behind them.
    fn linearised(&self, motions: &[Motion]) -> LinearisedStructure {
        let structure = &self.fit.structure;
        let mut linear = self.problem.linear(structure, &self.theta, &self.initial);
        if structure.terms.is_empty() {
            // Exact for a linear response under any noise: the answer to the moment that another 1/T is.
            for (block, motion) in linear.blocks.iter_mut().zip(motions) {
                let moment: Vec<f64> = motion.rate.iter().map(|rate| -rate / motion.base[1]).collect();
                let own = block.columns.iter_mut().find(|(unknown, _)| *unknown == 0);
                own.into_iter().for_each(|(_, column)| *column = motion.answer(&moment));
            }
        }
        let (entries, fitted) = (structure.entries(), structure.fitted());
        let paying = fitted.iter().filter(|place| **place >= structure.base_count()).count();
        let of_base = fitted.len() - paying;
        let mut integrated = linear.unknowns - paying;
        for block in &mut linear.blocks {
            for (unknown, _) in &mut block.columns {
                *unknown = match *unknown {
                    k if k < of_base => k,
                    k if k < fitted.len() => k + (linear.unknowns - fitted.len()),
                    k => k - paying,
                };
            }
        }
        for (block, motion) in linear.blocks.iter_mut().zip(motions) {
            bridge(block, motion, &mut integrated, paying);
        }
        linear.unknowns = integrated + paying;
        let mut prior = vec![(0.0, 0.0); integrated];
        // Deviations of the rudder bias from record to record are expected to be small.
        for (k, &place) in fitted[..of_base].iter().enumerate().skip(3) {
            let precision = curvature(entries[place].prior);
            prior[k] = (precision, deviation(entries[place].prior, self.theta[place]) / precision.sqrt());
        }
        let neutral: Vec<f64> = structure.terms.iter().flat_map(|term| term.neutral()).collect();
        let size = |&place: &usize| {
            let is_shape = entries[place].prior.is_shape;
            if is_shape { 0.0 } else { self.theta[place] - neutral[place - structure.base_count()] }
        };
        LinearisedStructure { linear, integrated, prior, sizes: fitted[of_base..].iter().map(size).collect() }
    }

    /// Moves all unknowns; how far 1/T has moved, as a share.
    fn advance(&mut self, step: &[f64]) -> f64 {
        let structure = &self.fit.structure;
        let (entries, fitted) = (structure.entries(), structure.fitted());
        let paying = fitted.iter().filter(|place| **place >= structure.base_count()).count();
        let of_base = fitted.len() - paying;
        let before = self.theta[0];
        let behind = step.len() - paying;
        for (k, &place) in fitted.iter().enumerate() {
            let by = if k < of_base { step[k] } else { step[behind + k - of_base] };
            let prior = &entries[place].prior;
            self.theta[place] = (self.theta[place] + by).clamp(prior.lowest, prior.highest);
        }
        let size = before.abs().max(1e-6);
        self.theta[0] = self.theta[0].clamp(before - 0.5 * size, before + size);
        for (number, initial) in self.initial.iter_mut().enumerate() {
            (0..2).for_each(|k| initial[k] += step[of_base + 2 * number + k]);
        }
        self.noise = Self::noise(self.problem, self.theta[0]);
        (self.theta[0] - before).abs() / size
    }
}

/// Lets heading and yaw rate begin anew behind gaps.
fn bridge(block: &mut HeadingSensitivities, motion: &Motion, integrated: &mut usize, paying: usize) {
    let time: Vec<f64> = motion.record.observed.iter().map(|&row| motion.record.time[row]).collect();
    let mut lengths: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let all = lengths.clone();
    lengths.sort_by(f64::total_cmp);
    let usual = lengths.get(lengths.len() / 2).copied().unwrap_or(f64::INFINITY);
    let mut gaps: Vec<usize> = (0..all.len()).filter(|&row| all[row] > GAP * usual).collect();
    gaps.sort_by(|&one, &other| all[other].total_cmp(&all[one]));
    for &row in gaps.iter().take(MOST_GAPS) {
        let from = time[row + 1];
        let after = |value: &dyn Fn(f64) -> f64| -> Vec<f64> {
            time.iter().map(|&t| if t < from { 0.0 } else { value(t - from) }).collect()
        };
        let columns = [after(&|_| 1.0), after(&|t| ship::first_order::Transition::new(motion.base[0], t).phi1)];
        // The parameters of terms stand behind.
        block.columns.iter_mut().filter(|(unknown, _)| *unknown >= *integrated).for_each(|(unknown, _)| *unknown += 2);
        block.columns.extend((*integrated..).zip(columns));
        *integrated += 2;
        let _ = paying;
    }
}

/// Looks for shapes in what a fit leaves, beside `law`, whose waves and sizes are known.
pub fn find(problem: &FittedRecords, fit: &StructureFit, law: &NoiseLaw) -> Option<Found> {
    let mut point = Point::new(problem, fit, law);
    let longest = problem.longest();
    let spacing = problem.records.iter().map(|record| record.spacing).fold(f64::INFINITY, f64::min);
    let mut colour = law.colour;
    let mut round = 0;
    loop {
        let gain = point.theta[1].abs();
        let laws = laws::all(gain, longest, spacing, law.colour.waves);
        let weights: Vec<Weights> = laws.par_iter().map(|law| point.weights(&law.colour)).collect();
        let motions = point.motions(&colour);
        let linearised = point.linearised(&motions);
        let under = |laws: &[RandomLaw], weights: &[Weights]| -> Vec<Option<Conditioned>> {
            let both = laws.par_iter().zip(weights);
            both.map(|(law, weights)| Conditioned::new(&linearised, weights, law.freedom)).collect()
        };
        let structure = under(&laws, &weights);
        let search = Search { motions, laws: &laws, weights: &weights, structure };
        let (alone, best) = search.alone();
        let chosen = search.structure[best].as_ref()?;
        if round < ROUNDS {
            round += 1;
            let step = chosen.step();
            let moved = point.advance(&step);
            let same = colour == laws[best].colour;
            colour = laws[best].colour;
            if !(moved < SETTLED && same) {
                continue;
            }
            round = ROUNDS;
            continue;
        }
        let smooth = match law.colour.waves {
            None => {
                let laws = laws::smooth(gain, longest);
                let weights: Vec<Weights> = laws.par_iter().map(|law| point.weights(&law.colour)).collect();
                let heights = under(&laws, &weights);
                heights.iter().flatten().map(Conditioned::height).fold(f64::INFINITY, f64::min)
            }
            Some(_) => f64::INFINITY,
        };
        let unit = UNIT / point.theta[0].max(1e-3);
        let (explanation, tried) = search.explain(unit);
        let coefficients = search.coefficients(&explanation);
        return Some(Found {
            gain: 0.5 * (alone - explanation.height),
            best: explanation,
            tried,
            alone,
            law: laws[best],
            smooth: 0.5 * (alone - smooth),
            coefficients,
        });
    }
}

#[allow(dead_code)]
fn unused(_: &Linear) {}
