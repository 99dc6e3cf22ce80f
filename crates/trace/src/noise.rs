//! The noise that a fit is judged against: white heading noise, a random yaw moment that has gone through the ship or
//! an error of the compass that wanders, and narrow-band waves, as one linear stochastic system whose Kalman filter
//! makes residual and sensitivities white.
//!
//! Noise is a competitor of every effect. A slow residual may be a missing term or a moment nobody knows the cause of;
//! an effect is only believed when it explains the record better than the best of these random explanations. With the
//! filter the likelihood is exact for the linearised response: −2 log L = n log(RSS/n) + Σ log S + const, where RSS is
//! that of the whitened residual and S the predicted variances in units of σ².
//!
//! Sources: Åström and Källström (1976) for maximum likelihood on ship records; Harvey (1989) for the prediction error
//! decomposition.

use std::sync::OnceLock;

use document::RandomMoment;
use estimation::kalman::{MOST, Step, System, Whitener};
use nalgebra::DMatrix;
use ship::narrow_band::NarrowBand;

use crate::record::PreparedRecord;

/// What wanders beside the white heading noise: a random yaw moment, or an error of the compass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CorrelatedNoise {
    /// r' = −a r + w: the yaw rate of a ship in a white moment wanders.
    White,
    /// r' = −a r + d, d' = −d/τ + w: gusts, whose correlation time τ is this one of [`GUSTS`].
    OrnsteinUhlenbeck(usize),
    /// r' = −a r + d, d' = w: the moment itself wanders.
    Walk,
    /// ε' = −ε/τ + w, added to the heading that is read: a compass whose errors last for a time τ, this one of
    /// [`COMPASS`].
    Compass(usize),
    /// ε'' + 2ε'/τ + ε/τ² = w, added to the heading: a smooth error that lasts for a time τ, this one of [`SMOOTH`].
    /// It is what a model leaves that is not quite that of the ship.
    Smooth(usize),
    /// r' = −a r + d with a smooth d, d'' + 2d'/τ + d/τ² = w (Matérn 3/2): no weather, but a moment of any smooth
    /// course. Its time τ is this one of [`SMOOTH_MOMENTS`].
    SmoothMoment(usize),
}

/// A gain of the filter that changes by less than this share has settled. Which structures are refitted, and with them
/// what is said of a record between two structures, may hang on the last digits: this is the share with which the
/// published traces were made.
const SETTLED: f64 = 1e-9;

/// Correlation times of gusts that are told apart, as shares of the longest record.
pub const GUSTS: [f64; 3] = [0.02, 0.05, 0.12];

/// Correlation times of an error of the compass that are told apart, as shares of the longest record.
pub const COMPASS: [f64; 4] = [0.01, 0.03, 0.06, 0.128];

/// Correlation times of a smooth error that are told apart, as shares of the longest record.
pub const SMOOTH: [f64; 3] = [0.01, 0.03, 0.08];

/// Correlation times of a smooth moment that are told apart, as shares of the longest record.
pub const SMOOTH_MOMENTS: [f64; 4] = [0.03, 0.06, 0.12, 0.25];

impl CorrelatedNoise {
    /// Smooth moments, which are no law of the noise of a record: a moment that one of them describes better than any
    /// law of [`all`](Self::all) is not chance.
    pub fn smooth_moments() -> impl Iterator<Item = Self> {
        (0..SMOOTH_MOMENTS.len()).map(Self::SmoothMoment)
    }

    /// Every kind: random moments, then errors of the heading.
    pub fn all() -> impl Iterator<Item = Self> {
        let gusts = (0..GUSTS.len()).map(Self::OrnsteinUhlenbeck);
        let compass = (0..COMPASS.len()).map(Self::Compass);
        [Self::White, Self::Walk].into_iter().chain(gusts).chain(compass).chain((0..SMOOTH.len()).map(Self::Smooth))
    }

    /// Whether it is an error of the heading, and no moment.
    pub fn is_of_heading(self) -> bool {
        matches!(self, Self::Compass(_) | Self::Smooth(_))
    }

    /// Number of parameters: the level, and the correlation time where there is one.
    pub fn freedom(self) -> usize {
        if matches!(self, Self::White | Self::Walk) { 1 } else { 2 }
    }

    /// Correlation time, s, where the longest record lasts so long; `None` where there is none.
    pub fn correlation(self, longest: f64) -> Option<f64> {
        match self {
            Self::White | Self::Walk => None,
            Self::OrnsteinUhlenbeck(number) => Some(GUSTS[number] * longest),
            Self::Compass(number) => Some(COMPASS[number] * longest),
            Self::Smooth(number) => Some(SMOOTH[number] * longest),
            Self::SmoothMoment(number) => Some(SMOOTH_MOMENTS[number] * longest),
        }
    }

    /// Intensity of w for level 1. Gusts have that of the white moment they are to slow motions.
    pub fn intensity(self, longest: f64) -> f64 {
        let white = 3.0 / longest.powi(3);
        match self {
            Self::White => white,
            Self::OrnsteinUhlenbeck(number) => white / (GUSTS[number] * longest).powi(2),
            Self::Walk => 20.0 / longest.powi(5),
            Self::Compass(number) => 2.0 / (COMPASS[number] * longest),
            Self::Smooth(number) => 4.0 / (SMOOTH[number] * longest).powi(3),
            Self::SmoothMoment(number) => 4.0 / (SMOOTH_MOMENTS[number] * longest).powi(3),
        }
    }

    /// Size of what a level (rad², in heading) is in a record: of a white moment the root of the spectral density of
    /// its yaw acceleration, rad/s² √s; of gusts the standard deviation, rad/s²; of a walk that after one second; of an
    /// error of the compass the standard deviation, rad.
    pub fn size(self, level: f64, longest: f64) -> f64 {
        let square = level * self.intensity(longest);
        match (self, self.correlation(longest)) {
            (Self::Smooth(_) | Self::SmoothMoment(_), _) => level.sqrt(),
            (_, Some(time)) => (0.5 * time * square).sqrt(),
            (_, None) => square.sqrt(),
        }
    }

    /// x' = G x + w on the last state for a ship of the given 1/T, heading first.
    fn generator(self, damping: f64, longest: f64) -> DMatrix<f64> {
        let fading = self.correlation(longest).map_or(0.0, f64::recip);
        match self {
            Self::White => DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, -damping]),
            Self::OrnsteinUhlenbeck(_) | Self::Walk => {
                DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 0.0, 0.0, -damping, 1.0, 0.0, 0.0, -fading])
            }
            Self::Compass(_) => DMatrix::from_element(1, 1, -fading),
            Self::Smooth(_) => DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -fading * fading, -2.0 * fading]),
            Self::SmoothMoment(_) => {
                let rows = [[0.0, 1.0, 0.0, 0.0], [0.0, -damping, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
                let last = [0.0, 0.0, -fading * fading, -2.0 * fading];
                DMatrix::from_row_slice(4, 4, [rows.as_flattened(), &last].concat().as_slice())
            }
        }
    }
}

/// Colour of the noise beside the white heading noise, whose variance is the unit of everything here.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NoiseColour {
    /// What wanders, and the variance of the heading it leaves: of a random moment that at the end of the longest
    /// record of a ship without damping.
    pub wander: Option<(CorrelatedNoise, f64)>,
    /// Waves; `sd` in units of the white noise.
    pub waves: Option<NarrowBand>,
}

impl NoiseColour {
    /// White heading noise alone.
    pub const WHITE: Self = Self { wander: None, waves: None };

    /// Number of parameters beside σ.
    pub fn freedom(&self) -> usize {
        self.wander.map_or(0, |(kind, _)| kind.freedom()) + if self.waves.is_some() { 3 } else { 0 }
    }

    /// The random moment of a record whose white noise has a variance (rad²), as rudder angle of a ship whose |K/T| is
    /// `gain`.
    pub fn moment(&self, variance: f64, longest: f64, gain: f64) -> RandomMoment {
        let Some((kind, level)) = self.wander else { return RandomMoment::None };
        let size = kind.size(level * variance, longest) / gain;
        match (kind, kind.correlation(longest)) {
            (CorrelatedNoise::White, _) => RandomMoment::White { rudder_rad_root_s: size },
            (CorrelatedNoise::Walk, _) => RandomMoment::Walk { rudder_rad_per_root_s: size },
            (CorrelatedNoise::OrnsteinUhlenbeck(_), Some(correlation_s)) => {
                RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad: size, correlation_s }
            }
            _ => RandomMoment::None,
        }
    }
}

/// Transitions of what wanders over every step of a record, for level 1.
#[derive(Debug, Clone)]
struct NoiseTransition {
    states: usize,
    /// Variance of the states at the beginning.
    beginning: [f64; 4],
    /// Every distinct step.
    steps: Vec<Step<MOST>>,
    /// The step before every observed row.
    of_row: Vec<usize>,
}

impl NoiseTransition {
    fn new(kind: CorrelatedNoise, inverse_time: f64, durations: &[f64], longest: f64) -> Self {
        let intensity = kind.intensity(longest);
        let generator = kind.generator(inverse_time, longest);
        let beginning = match (kind, kind.correlation(longest)) {
            (CorrelatedNoise::Smooth(_), Some(time)) => [1.0, time.powi(-2), 0.0, 0.0],
            (CorrelatedNoise::SmoothMoment(_), Some(time)) => [0.0, 0.0, 1.0, time.powi(-2)],
            (CorrelatedNoise::OrnsteinUhlenbeck(_), Some(time)) => [0.0, 0.0, 0.5 * time * intensity, 0.0],
            (_, Some(time)) => [0.5 * time * intensity, 0.0, 0.0, 0.0],
            (_, None) => [0.0; 4],
        };
        let mut known: Vec<f64> = Vec::new();
        let of_row = durations.iter().map(|&h| {
            known.iter().rposition(|&other| (other - h).abs() <= 1e-6 * h).unwrap_or_else(|| {
                known.push(h);
                known.len() - 1
            })
        });
        let of_row = of_row.collect();
        let steps = known.iter().map(|&h| Step::over(&generator, intensity, h)).collect();
        Self { states: generator.nrows(), beginning, steps, of_row }
    }
}

/// What is the same for every intensity of the noise of one record.
#[derive(Debug, Clone)]
pub struct RecordNoise {
    durations: Vec<f64>,
    /// Variance of the white noise of every observed row, in units of that of a full one.
    variances: Vec<f64>,
    longest: f64,
    damping: f64,
    /// What wanders, of every kind that was asked for, smooth moments last.
    drifts: Vec<OnceLock<NoiseTransition>>,
}

impl RecordNoise {
    /// Prepares the observed rows of a record for a ship of the given 1/T; `longest` is the length of the longest
    /// record, s, and a full row is the mean of `full_readings`.
    pub fn new(record: &PreparedRecord, inverse_time: f64, longest: f64, full_readings: usize) -> Self {
        let time = |number: usize| record.time[record.observed[number]];
        let durations = (0..record.observed.len()).map(|k| if k == 0 { 0.0 } else { time(k) - time(k - 1) }).collect();
        let variance = |&row: &usize| full_readings as f64 / record.readings[row] as f64;
        let variances = record.observed.iter().map(variance).collect();
        // A course-unstable ship is steered: what a random moment does is over after a rudder order.
        let damping = inverse_time.max(0.0);
        Self { durations, variances, longest, damping, drifts: Self::kinds().map(|_| OnceLock::new()).collect() }
    }

    /// Every kind of what wanders.
    fn kinds() -> impl Iterator<Item = CorrelatedNoise> {
        CorrelatedNoise::all().chain(CorrelatedNoise::smooth_moments())
    }

    /// The filter that makes noise of this colour white, in units of the white noise of a full row.
    pub fn whitener(&self, colour: &NoiseColour) -> Whitener {
        let (system, states) = self.system(colour);
        system.whitener(states, SETTLED)
    }

    /// Random moment and waves of this colour as one linear system, and the number of its states.
    pub(crate) fn system(&self, colour: &NoiseColour) -> (System<MOST>, usize) {
        let drift = colour.wander.map(|(kind, level)| {
            let place = Self::kinds().position(|other| other == kind).expect("a kind of the list");
            let new = || NoiseTransition::new(kind, self.damping, &self.durations, self.longest);
            (self.drifts[place].get_or_init(new), level)
        });
        let own = drift.map_or(0, |(drift, _)| drift.states);
        let mut initial = [[0.0; MOST]; MOST];
        if let Some((drift, level)) = drift {
            (0..own).for_each(|k| initial[k][k] = level * drift.beginning[k]);
        }
        if let Some(waves) = &colour.waves {
            let [p0, p1] = waves.stationary_sd().map(|sd| sd * sd);
            (initial[own][own], initial[own + 1][own + 1]) = (p0, p1);
        }
        let mut known: Vec<(f64, usize)> = Vec::new();
        let of_row = self.durations.iter().enumerate().map(|(row, &h)| {
            let key = drift.map_or(0, |(drift, _)| drift.of_row[row]);
            let place = known.iter().rposition(|step| step.1 == key && (step.0 - h).abs() <= 1e-6 * h.max(1e-300));
            place.unwrap_or_else(|| {
                known.push((h, key));
                known.len() - 1
            })
        });
        let of_row: Vec<usize> = of_row.collect();
        let nothing = Step { transition: [[0.0; MOST]; MOST], added: [[0.0; MOST]; MOST] };
        let step = |&(h, key): &(f64, usize)| {
            let mut step = drift.map_or(nothing, |(drift, level)| drift.steps[key].scaled(level));
            if let Some(waves) = &colour.waves {
                add_waves(&mut step, own, waves, h);
            }
            step
        };
        let steps = known.iter().map(step).collect();
        let beside = colour.waves.filter(|_| own > 0).map(|_| own);
        let states = own + if colour.waves.is_some() { 2 } else { 0 };
        (System::of_rows(steps, initial, &of_row, &self.variances, beside), states)
    }
}

/// Puts waves into a step over h, as the two states from `own` on.
fn add_waves(step: &mut Step<MOST>, own: usize, waves: &NarrowBand, h: f64) {
    let sea = waves.step(h);
    let (a, b) = (sea.advance([1.0, 0.0], [0.0; 2]), sea.advance([0.0, 1.0], [0.0; 2]));
    let (c, d) = (sea.advance([0.0; 2], [1.0, 0.0]), sea.advance([0.0; 2], [0.0, 1.0]));
    for i in 0..2 {
        (step.transition[own + i][own], step.transition[own + i][own + 1]) = (a[i], b[i]);
        for j in 0..2 {
            step.added[own + i][own + j] = c[i] * c[j] + d[i] * d[j];
        }
    }
}

#[cfg(test)]
mod tests;
