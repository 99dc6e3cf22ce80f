//! Detection of narrow-band waves in the heading: likelihood of the residual over frequency, damping and size.

use ship::narrow_band::NarrowBandProcess;

use crate::fit::FittedRecords;
use crate::noise::NoiseColour;
use crate::noise_law::NoiseLaw;

/// Minimum frequency of waves over the fundamental of the manoeuvre; a lower band is treated as model structure.
const MIN_FREQUENCY_RATIO: f64 = 5.0;

/// Number of frequencies that are tried.
const FREQUENCIES: usize = 30;

/// Damping ratios that are tried.
const DAMPINGS: [f64; 3] = [0.03, 0.08, 0.2];

/// Maximum damping ratio of waves.
const MAX_DAMPING: f64 = 0.3;

/// Minimum share of waves in the mean square residual; a smaller share is treated as sensor colour.
const MIN_SHARE: f64 = 0.05;

/// Standard deviations of the waves over that of the white noise that are tried.
const STRENGTHS: [f64; 4] = [0.6, 2.0, 6.0, 20.0];

/// Waves of maximum likelihood in addition to the correlated noise of a law; `None` if the rows are too far apart, if
/// waves do not increase the likelihood, or if they have the maximum damping or less than the minimum share.
pub fn estimate_waves(problem: &FittedRecords, residual: &[Vec<f64>], law: &NoiseLaw) -> Option<NarrowBandProcess> {
    let beside = &NoiseColour { waves: None, ..law.colour };
    // −2 log L and whitened sum of squares of the residual under one colour.
    let evaluate = |colour: &NoiseColour| {
        let whitening = problem.whitening(&NoiseLaw { colour: *colour, ..NoiseLaw::white(residual.len(), 1.0) });
        let rss = whitening.misfit(residual);
        let log_variance: f64 = whitening.whiteners.iter().map(|whitener| whitener.log_determinant).sum();
        let n = problem.heading_count() as f64;
        (n * (rss / n).ln() + log_variance, rss)
    };
    let value = |waves: NarrowBandProcess| evaluate(&NoiseColour { waves: Some(waves), ..*beside }).0;
    let slowest = MIN_FREQUENCY_RATIO * problem.records.iter().map(fundamental).fold(0.0, f64::max);
    let spacing = problem.records.iter().map(|record| record.spacing).fold(0.0, f64::max);
    let fastest = 0.8 * std::f64::consts::PI / spacing;
    if slowest >= fastest {
        return None;
    }
    let mut best: Option<(f64, NarrowBandProcess)> = None;
    let consider = |waves: NarrowBandProcess, best: &mut Option<(f64, NarrowBandProcess)>| {
        let deviance = value(waves);
        if best.as_ref().is_none_or(|(lowest, _)| deviance < *lowest) {
            *best = Some((deviance, waves));
        }
    };
    for k in 0..FREQUENCIES {
        let frequency = slowest * (fastest / slowest).powf(k as f64 / (FREQUENCIES - 1) as f64);
        for damping in DAMPINGS {
            for sd in STRENGTHS {
                consider(NarrowBandProcess { sd, frequency, damping }, &mut best);
            }
        }
    }
    // Coordinate descent with decreasing steps.
    let mut factor = (fastest / slowest).powf(0.5 / (FREQUENCIES - 1) as f64).max(1.05);
    for _ in 0..7 {
        let (_, centre) = best?;
        for step in [factor, 1.0 / factor] {
            let frequency = (centre.frequency * step).clamp(slowest, fastest);
            consider(NarrowBandProcess { frequency, ..centre }, &mut best);
        }
        let (_, centre) = best?;
        for step in [1.6, 1.0 / 1.6, 1.2, 1.0 / 1.2] {
            consider(NarrowBandProcess { sd: centre.sd * step, ..centre }, &mut best);
            consider(
                NarrowBandProcess { damping: (centre.damping * step).clamp(0.005, MAX_DAMPING), ..centre },
                &mut best,
            );
        }
        factor = factor.sqrt();
    }
    let (plain, _) = evaluate(beside);
    let (deviance, waves) = best?;
    let (_, rss) = evaluate(&NoiseColour { waves: Some(waves), ..*beside });
    let all: f64 = residual.iter().flatten().map(|e| e * e).sum();
    let is_sea = waves.damping < MAX_DAMPING && waves.sd * waves.sd * rss > MIN_SHARE * all;
    (deviance < plain && is_sea).then_some(waves)
}

/// Fundamental angular frequency of the manoeuvre, rad/s: the rudder changes side twice per period.
fn fundamental(record: &crate::record::PreparedRecord) -> f64 {
    let rudder = record.rudder.values();
    let largest = rudder.iter().fold(0.0_f64, |largest, delta| largest.max(delta.abs()));
    let mut side = 0.0;
    let mut changes = 0usize;
    for &delta in rudder.iter().filter(|delta| delta.abs() > 0.3 * largest) {
        if side * delta < 0.0 {
            changes += 1;
        }
        side = delta.signum();
    }
    std::f64::consts::PI * (changes.max(1) as f64) / record.duration()
}
