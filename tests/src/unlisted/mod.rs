//! What a trace says when the truth is the same physics in another formula, or something that is on no list.
//!
//! Ships are written out here ([`truths`]), steered through zig-zags in plain code ([`records`]), traced, and what the
//! trace says is held against the truth ([`judged`]). The page of it is [`page`].

pub mod chart;
pub mod judged;
pub mod page;
pub mod records;
pub mod truths;

use identify::{Identifier, output_error};
use rayon::prelude::*;
use ship::angle::from_deg;
use simulate::StreamKey;
use trace::Settings;

use judged::{Answer, Judgement};
use truths::Truth;

/// Seed of the study.
const SEED: u64 = 10;

/// Standard deviations of the heading noise, deg.
pub const NOISES_DEG: [f64; 2] = [0.05, 0.1];

/// Trials of a ship at one noise.
pub const REPLICATES: u64 = 8;

/// One trial of one ship.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// Place of the ship in the list that was traced.
    pub ship: usize,
    /// Standard deviation of the heading noise, deg.
    pub noise_deg: f64,
    /// Number of the trial.
    pub replicate: u64,
    /// Likelihood ratio of the truth against the nearest first-order response, on average over the noise.
    pub ratio: f64,
    /// What the trace said; `None` where there is none.
    pub answer: Option<Answer>,
    /// What that is.
    pub judgement: Judgement,
}

/// Traces so many trials of every ship at every noise (deg): ship by ship, noise by noise, whatever the threads.
pub fn run(truths: &[Truth], noises_deg: &[f64], replicates: u64) -> Vec<Outcome> {
    let squares: Vec<f64> = truths.par_iter().map(square_to_first_order).collect();
    let of_ship = |ship| noises_deg.iter().map(move |&noise_deg| (ship, noise_deg));
    let cells: Vec<(usize, f64)> = (0..truths.len()).flat_map(of_ship).collect();
    let of_cell = |(cell, (ship, noise_deg))| {
        (0..replicates).map(move |replicate| (ship, noise_deg, StreamKey { seed: SEED, cell, replicate }))
    };
    let all: Vec<(usize, f64, StreamKey)> = (0..).zip(cells).flat_map(of_cell).collect();
    let settings = Settings { thorough: false, ..Settings::default() };
    let traced = |(ship, noise_deg, key): (usize, f64, StreamKey)| {
        let truth = &truths[ship];
        let analysis = trace::trace(&records::of(truth, noise_deg, key), &[], &settings);
        let answer = analysis.ok().map(|analysis| Answer::of(&analysis));
        let judgement = answer.as_ref().map_or(Judgement::Failed, |answer| answer.judged(&truth.kind));
        let ratio = squares[ship] / from_deg(noise_deg).powi(2);
        Outcome { ship, noise_deg, replicate: key.replicate, ratio, answer, judgement }
    };
    all.into_par_iter().map(traced).collect()
}

/// Sum of squares, rad², by which the nearest first-order response misses the records of a ship without noise and
/// chance.
///
/// # Panics
/// When the ship has no base: a mistake of this study.
pub fn square_to_first_order(truth: &Truth) -> f64 {
    let records = records::of(&truth.without_chance(), 0.0, StreamKey::default());
    let method = output_error::Settings::default().build().expect("default settings are valid");
    let base = method.identify(&records).expect("a zig-zag has a base");
    let rms = base.diagnostic("heading_rmse_deg").expect("it is reported");
    (records.len() * records::ROWS) as f64 * from_deg(rms).powi(2)
}
