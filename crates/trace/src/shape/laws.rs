//! Random laws that compete with the shapes: white heading noise alone, or together with a random moment, a correlated
//! compass error or waves.
//!
//! The size of a moment is its rudder angle over the standard deviation of the white heading noise, both in rad.

use ship::narrow_band::NarrowBandProcess;

use crate::noise::{COMPASS_CORRELATION_SHARES, CorrelatedNoise, GUST_CORRELATION_SHARES, NoiseColour};

/// Periods of the waves, s.
const WAVE_PERIODS: [f64; 4] = [5.0, 7.0, 9.0, 12.0];

/// Damping ratio of the waves.
const WAVE_DAMPING: f64 = 0.1;

/// Sizes of the waves: standard deviation of their heading error over that of the white noise.
const WAVE_SIZES: [f64; 4] = [0.3, 1.0, 3.0, 10.0];

/// Minimum number of rows per period of waves.
const MIN_ROWS_PER_WAVE: f64 = 2.5;

/// Random law with its size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RandomLaw {
    /// Colour, in units of the white noise of a row.
    pub colour: NoiseColour,
    /// Number of parameters besides the white noise.
    pub parameter_count: usize,
    /// Size over the standard deviation of the white noise: rudder angle of a moment, or heading error.
    pub size: f64,
}

impl RandomLaw {
    /// Law of white noise alone, or with the `waves` of the noise law; it has no further parameter.
    fn white(waves: Option<NarrowBandProcess>) -> Self {
        let colour = NoiseColour { correlated: None, waves };
        Self { colour, parameter_count: 0, size: 0.0 }
    }

    /// Correlated noise of a size, for a ship of this K/T (1/s²) and a longest record of `longest` seconds.
    pub fn correlated(
        kind: CorrelatedNoise,
        size: f64,
        gain: f64,
        longest: f64,
        waves: Option<NarrowBandProcess>,
    ) -> Self {
        let moment = (gain * size).powi(2);
        let level = match (kind, kind.correlation_time(longest)) {
            (CorrelatedNoise::OrnsteinUhlenbeck(_), Some(time)) => 2.0 * moment / time / kind.intensity(longest),
            (CorrelatedNoise::WhiteMoment | CorrelatedNoise::WalkMoment, _) => moment / kind.intensity(longest),
            (CorrelatedNoise::SmoothMoment(_), _) => moment,
            _ => size * size,
        };
        let colour = NoiseColour { correlated: Some((kind, level)), waves };
        Self { colour, parameter_count: kind.parameter_count(), size }
    }

    /// `true` if it includes a random moment.
    pub fn is_moment(&self) -> bool {
        self.colour.correlated.is_some_and(|(kind, _)| !kind.is_heading_error())
    }
}

/// Sizes 10^`from` to 10^`to`, each 10^`step` times the one before.
fn decades(from: f64, to: f64, step: f64) -> impl Iterator<Item = f64> + Clone {
    let count = ((to - from) / step).round() as usize;
    (0..=count).map(move |k| 10f64.powf(from + step * k as f64))
}

/// All random laws for a ship of this K/T (1/s²), a longest record of `longest` seconds and rows `spacing` seconds
/// apart. With `waves` of the noise law, no other waves are tried.
pub fn random_laws(gain: f64, longest: f64, spacing: f64, waves: Option<NarrowBandProcess>) -> Vec<RandomLaw> {
    let with_sizes = |kind, sizes: &mut dyn Iterator<Item = f64>| -> Vec<RandomLaw> {
        sizes.map(|size| RandomLaw::correlated(kind, size, gain, longest, waves)).collect()
    };
    let mut laws = vec![RandomLaw::white(waves)];
    laws.extend(with_sizes(CorrelatedNoise::WhiteMoment, &mut decades(-1.0, 2.0, 0.5)));
    laws.extend(with_sizes(CorrelatedNoise::WalkMoment, &mut decades(-2.0, 2.0, 0.25)));
    for number in 0..GUST_CORRELATION_SHARES.len() {
        laws.extend(with_sizes(CorrelatedNoise::OrnsteinUhlenbeck(number), &mut decades(-0.5, 2.0, 0.5)));
    }
    for number in 0..COMPASS_CORRELATION_SHARES.len() {
        laws.extend(with_sizes(CorrelatedNoise::CompassError(number), &mut decades(-1.0, 1.5, 0.5)));
    }
    if waves.is_none() {
        for period in WAVE_PERIODS.into_iter().filter(|period| *period > MIN_ROWS_PER_WAVE * spacing) {
            laws.extend(WAVE_SIZES.map(|sd| {
                let frequency = std::f64::consts::TAU / period;
                let sea = NarrowBandProcess { sd, frequency, damping: WAVE_DAMPING };
                let colour = NoiseColour { correlated: None, waves: Some(sea) };
                RandomLaw { colour, parameter_count: colour.parameter_count(), size: sd }
            }));
        }
    }
    laws
}

/// Smooth moments of unknown shape, which compete with all random laws.
pub fn smooth_moment_laws(gain: f64, longest: f64) -> Vec<RandomLaw> {
    let laws = |kind| decades(-1.0, 2.5, 0.5).map(move |size| RandomLaw::correlated(kind, size, gain, longest, None));
    CorrelatedNoise::smooth_moments().flat_map(laws).collect()
}

/// Indices of the laws under which all shapes are screened: white noise, the law `best` without shapes and weaker laws
/// of its kind by half decades, walks by decades, and one compass error.
pub fn screening_law_indices(laws: &[RandomLaw], best: usize) -> Vec<usize> {
    let kind = |law: &RandomLaw| law.colour.correlated.map(|(kind, _)| kind);
    let is_step_below = |size: f64, weaker: f64, step: f64| {
        let count = (size / weaker).log10() / step;
        count > -0.01 && (count - count.round()).abs() < 0.01
    };
    let is_screened = |(place, law): (usize, &RandomLaw)| {
        let is_weaker = law.size > 0.0
            && kind(law) == kind(&laws[best])
            && law.colour.waves.map(|sea| sea.frequency) == laws[best].colour.waves.map(|sea| sea.frequency)
            && is_step_below(laws[best].size, law.size, 0.5);
        let is_walk = kind(law) == Some(CorrelatedNoise::WalkMoment) && is_step_below(1e9, law.size, 1.0);
        let is_compass = kind(law) == Some(CorrelatedNoise::CompassError(1)) && (law.size - 1.0).abs() < 0.01;
        (place == 0 || place == best || is_weaker || is_walk || is_compass).then_some(place)
    };
    laws.iter().enumerate().filter_map(is_screened).collect()
}
