//! Whether the heading carries a narrow band of waves: the likelihood of the residual over frequency, width and
//! strength.

use ship::narrow_band::NarrowBand;

use crate::fit::FittedRecords;
use crate::noise::NoiseColour;
use crate::weights::NoiseLaw;

/// Waves are at least this many times as fast as the fundamental of the manoeuvre; below, a band is structure.
const FASTER: f64 = 5.0;

/// Frequencies, widths and strengths that are tried.
const FREQUENCIES: usize = 30;
const DAMPINGS: [f64; 3] = [0.03, 0.08, 0.2];

/// A wider band is no sea.
const WIDEST: f64 = 0.3;

/// Waves of a smaller share of the mean square are a colour of the sensor.
const SMALLEST_SHARE: f64 = 0.05;
const STRENGTHS: [f64; 4] = [0.6, 2.0, 6.0, 20.0];

/// The waves that explain a residual best beside what wanders under a law; `None` when none can be resolved or helps.
pub fn find(problem: &FittedRecords, residual: &[Vec<f64>], law: &NoiseLaw) -> Option<NarrowBand> {
    let beside = &NoiseColour { waves: None, ..law.colour };
    // −2 log L and whitened sum of squares of the residual under one colour.
    let judge = |colour: &NoiseColour| {
        let weights = problem.weights(&NoiseLaw { colour: *colour, ..NoiseLaw::white(residual.len(), 1.0) });
        let rss = weights.misfit(residual);
        let log_variance: f64 = weights.whiteners.iter().map(|whitener| whitener.log_variance).sum();
        let n = problem.observations() as f64;
        (n * (rss / n).ln() + log_variance, rss)
    };
    let value = |waves: NarrowBand| judge(&NoiseColour { waves: Some(waves), ..*beside }).0;
    let slowest = FASTER * problem.records.iter().map(fundamental).fold(0.0, f64::max);
    let spacing = problem.records.iter().map(|record| record.spacing).fold(0.0, f64::max);
    let fastest = 0.8 * std::f64::consts::PI / spacing;
    if slowest >= fastest {
        return None;
    }
    let mut best: Option<(f64, NarrowBand)> = None;
    let consider = |waves: NarrowBand, best: &mut Option<(f64, NarrowBand)>| {
        let height = value(waves);
        if best.as_ref().is_none_or(|(lowest, _)| height < *lowest) {
            *best = Some((height, waves));
        }
    };
    for k in 0..FREQUENCIES {
        let frequency = slowest * (fastest / slowest).powf(k as f64 / (FREQUENCIES - 1) as f64);
        for damping in DAMPINGS {
            for sd in STRENGTHS {
                consider(NarrowBand { sd, frequency, damping }, &mut best);
            }
        }
    }
    // Downhill along each of the three, in ever smaller steps.
    let mut factor = (fastest / slowest).powf(0.5 / (FREQUENCIES - 1) as f64).max(1.05);
    for _ in 0..7 {
        let (_, centre) = best?;
        for step in [factor, 1.0 / factor] {
            let frequency = (centre.frequency * step).clamp(slowest, fastest);
            consider(NarrowBand { frequency, ..centre }, &mut best);
        }
        let (_, centre) = best?;
        for step in [1.6, 1.0 / 1.6, 1.2, 1.0 / 1.2] {
            consider(NarrowBand { sd: centre.sd * step, ..centre }, &mut best);
            consider(NarrowBand { damping: (centre.damping * step).clamp(0.005, WIDEST), ..centre }, &mut best);
        }
        factor = factor.sqrt();
    }
    let (plain, _) = judge(beside);
    let (height, waves) = best?;
    let (_, rss) = judge(&NoiseColour { waves: Some(waves), ..*beside });
    let all: f64 = residual.iter().flatten().map(|e| e * e).sum();
    let is_sea = waves.damping < WIDEST && waves.sd * waves.sd * rss > SMALLEST_SHARE * all;
    (height < plain && is_sea).then_some(waves)
}

/// Angular frequency of the manoeuvre, rad/s: the rudder changes its side twice a period.
fn fundamental(record: &crate::record::PreparedRecord) -> f64 {
    let rudder = record.rudder.values();
    let largest = rudder.iter().fold(0.0_f64, |most, delta| most.max(delta.abs()));
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
