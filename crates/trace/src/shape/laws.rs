//! The random laws against which a shape is held: white heading noise alone, beside a random moment of any size, beside
//! an error of the compass that lasts, or beside waves.
//!
//! The size of a moment is counted in rudder angle over the standard deviation of a heading, both in the same unit.

use ship::narrow_band::NarrowBand;

use crate::noise::{COMPASS, CorrelatedNoise, GUSTS, NoiseColour};

/// Periods of waves that are told apart, s, their damping and sizes.
const WAVE_PERIODS: [f64; 4] = [5.0, 7.0, 9.0, 12.0];
const WAVE_DAMPING: f64 = 0.1;
const WAVE_SIZES: [f64; 4] = [0.3, 1.0, 3.0, 10.0];

/// Fewest rows in a period of waves.
const ROWS_PER_WAVE: f64 = 2.5;

/// A law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RandomLaw {
    /// Its colour, in units of the white noise of a row.
    pub colour: NoiseColour,
    /// Number of its parameters beside the white noise.
    pub freedom: usize,
    /// Its size: of a moment in rudder angle over the standard deviation of the white noise, of a heading error over
    /// it.
    pub size: f64,
}

impl RandomLaw {
    /// White noise, beside the waves that a record is known to hold.
    fn white(waves: Option<NarrowBand>) -> Self {
        let colour = NoiseColour { wander: None, waves };
        Self { colour, freedom: 0, size: 0.0 }
    }

    /// A kind of what wanders at a size, for a ship of the given K/T (1/s²) and records of which the longest lasts so
    /// many seconds.
    pub fn of(kind: CorrelatedNoise, size: f64, gain: f64, longest: f64, waves: Option<NarrowBand>) -> Self {
        let moment = (gain * size).powi(2);
        let level = match (kind, kind.correlation(longest)) {
            (CorrelatedNoise::OrnsteinUhlenbeck(_), Some(time)) => 2.0 * moment / time / kind.intensity(longest),
            (CorrelatedNoise::White | CorrelatedNoise::Walk, _) => moment / kind.intensity(longest),
            (CorrelatedNoise::SmoothMoment(_), _) => moment,
            _ => size * size,
        };
        let colour = NoiseColour { wander: Some((kind, level)), waves };
        Self { colour, freedom: kind.freedom(), size }
    }

    /// Whether a random moment is part of it.
    pub fn is_moment(&self) -> bool {
        self.colour.wander.is_some_and(|(kind, _)| !kind.is_of_heading())
    }
}

/// Powers of ten from one to another.
fn decades(from: f64, to: f64, step: f64) -> impl Iterator<Item = f64> + Clone {
    let count = ((to - from) / step).round() as usize;
    (0..=count).map(move |k| 10f64.powf(from + step * k as f64))
}

/// Every law for a ship of the given K/T (1/s²), on records of which the longest lasts so many seconds, with rows so
/// many seconds apart; `waves` are those that the records are known to hold, beside which no others are looked for.
pub fn all(gain: f64, longest: f64, spacing: f64, waves: Option<NarrowBand>) -> Vec<RandomLaw> {
    let of = |kind, sizes: &mut dyn Iterator<Item = f64>| -> Vec<RandomLaw> {
        sizes.map(|size| RandomLaw::of(kind, size, gain, longest, waves)).collect()
    };
    let mut laws = vec![RandomLaw::white(waves)];
    laws.extend(of(CorrelatedNoise::White, &mut decades(-1.0, 2.0, 0.5)));
    laws.extend(of(CorrelatedNoise::Walk, &mut decades(-2.0, 2.0, 0.25)));
    for number in 0..GUSTS.len() {
        laws.extend(of(CorrelatedNoise::OrnsteinUhlenbeck(number), &mut decades(-0.5, 2.0, 0.5)));
    }
    for number in 0..COMPASS.len() {
        laws.extend(of(CorrelatedNoise::Compass(number), &mut decades(-1.0, 1.5, 0.5)));
    }
    if waves.is_none() {
        for period in WAVE_PERIODS.into_iter().filter(|period| *period > ROWS_PER_WAVE * spacing) {
            laws.extend(WAVE_SIZES.map(|sd| {
                let frequency = std::f64::consts::TAU / period;
                let sea = NarrowBand { sd, frequency, damping: WAVE_DAMPING };
                let colour = NoiseColour { wander: None, waves: Some(sea) };
                RandomLaw { colour, freedom: colour.freedom(), size: sd }
            }));
        }
    }
    laws
}

/// Smooth moments, against which all random laws are held.
pub fn smooth(gain: f64, longest: f64) -> Vec<RandomLaw> {
    let of = |kind| decades(-1.0, 2.5, 0.5).map(move |size| RandomLaw::of(kind, size, gain, longest, None));
    CorrelatedNoise::smooth_moments().flat_map(of).collect()
}

/// The places of the laws under which all shapes are tried, beside the best one for none: white noise, the kind of that
/// law at sizes that fall by half decades, walks by decades, and one error of the compass.
pub fn tried(laws: &[RandomLaw], best: usize) -> Vec<usize> {
    let kind = |law: &RandomLaw| law.colour.wander.map(|(kind, _)| kind);
    let steps = |one: f64, other: f64, step: f64| {
        let count = (one / other).log10() / step;
        count > -0.01 && (count - count.round()).abs() < 0.01
    };
    let is_tried = |(place, law): (usize, &RandomLaw)| {
        let is_weaker = law.size > 0.0
            && kind(law) == kind(&laws[best])
            && law.colour.waves.map(|sea| sea.frequency) == laws[best].colour.waves.map(|sea| sea.frequency)
            && steps(laws[best].size, law.size, 0.5);
        let is_walk = kind(law) == Some(CorrelatedNoise::Walk) && steps(1e9, law.size, 1.0);
        let is_compass = kind(law) == Some(CorrelatedNoise::Compass(1)) && (law.size - 1.0).abs() < 0.01;
        (place == 0 || place == best || is_weaker || is_walk || is_compass).then_some(place)
    };
    laws.iter().enumerate().filter_map(is_tried).collect()
}
