//! Noise laws of the heading: white noise, plus a correlated part (a random yaw moment through the ship, or a slow
//! error of the heading), plus narrow-band waves. Each is one linear stochastic system whose Kalman filter whitens
//! residual and sensitivities.
//!
//! Noise competes with every effect: a slow residual may be a missing term or a random moment, and an effect is
//! accepted only if it explains the record better than the best noise law. With the filter the likelihood is exact for
//! the linearised response: −2 log L = n log(RSS/n) + Σ log S + const, with RSS of the whitened residual and the
//! predicted variances S in units of σ².
//!
//! Sources: Åström and Källström (1976) for maximum likelihood on ship records; Harvey (1989) for the prediction error
//! decomposition.

use std::sync::OnceLock;

use document::RandomMoment;
use estimation::kalman::whitener::Whitener;
use estimation::kalman::{LinearStep, LinearSystem, MAX_STATES};
use nalgebra::DMatrix;
use ship::narrow_band::NarrowBandProcess;

use crate::record::PreparedRecord;

/// Correlated noise in addition to the white heading noise: a random yaw moment, or an error of the heading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CorrelatedNoise {
    /// White yaw moment: r' = −a r + w.
    WhiteMoment,
    /// Gusts: r' = −a r + d, d' = −d/τ + w, with τ by its index in [`GUST_CORRELATION_SHARES`].
    OrnsteinUhlenbeck(usize),
    /// Random-walk moment: r' = −a r + d, d' = w.
    WalkMoment,
    /// Compass error ε added to the heading: ε' = −ε/τ + w, with τ by its index in [`COMPASS_CORRELATION_SHARES`].
    CompassError(usize),
    /// Smooth model error ε added to the heading: ε'' + 2ε'/τ + ε/τ² = w, with τ by its index in
    /// [`SMOOTH_ERROR_CORRELATION_SHARES`].
    SmoothError(usize),
    /// Smooth moment of unknown shape (Matérn 3/2): r' = −a r + d, d'' + 2d'/τ + d/τ² = w, with τ by its index in
    /// [`SMOOTH_MOMENT_CORRELATION_SHARES`].
    SmoothMoment(usize),
}

/// Maximum relative change of a stationary Kalman gain. Published traces were computed with this value; near a tie, the
/// choice of structures can depend on the last digits.
const GAIN_TOLERANCE: f64 = 1e-9;

/// Correlation times of gusts, as shares of the longest record.
pub const GUST_CORRELATION_SHARES: [f64; 3] = [0.02, 0.05, 0.12];

/// Correlation times of compass errors, as shares of the longest record.
pub const COMPASS_CORRELATION_SHARES: [f64; 4] = [0.01, 0.03, 0.06, 0.128];

/// Correlation times of smooth model errors, as shares of the longest record.
pub const SMOOTH_ERROR_CORRELATION_SHARES: [f64; 3] = [0.01, 0.03, 0.08];

/// Correlation times of smooth moments, as shares of the longest record.
pub const SMOOTH_MOMENT_CORRELATION_SHARES: [f64; 4] = [0.03, 0.06, 0.12, 0.25];

impl CorrelatedNoise {
    /// Smooth moments. They are no noise laws: a residual that one of them describes better than any of
    /// [`all`](Self::all) is not random.
    pub fn smooth_moments() -> impl Iterator<Item = Self> {
        (0..SMOOTH_MOMENT_CORRELATION_SHARES.len()).map(Self::SmoothMoment)
    }

    /// Noise laws: white moment, walk and gusts, then compass errors and smooth model errors. The
    /// [`smooth_moments`](Self::smooth_moments) are not among them.
    pub fn all() -> impl Iterator<Item = Self> {
        let gusts = (0..GUST_CORRELATION_SHARES.len()).map(Self::OrnsteinUhlenbeck);
        let compass = (0..COMPASS_CORRELATION_SHARES.len()).map(Self::CompassError);
        [Self::WhiteMoment, Self::WalkMoment]
            .into_iter()
            .chain(gusts)
            .chain(compass)
            .chain((0..SMOOTH_ERROR_CORRELATION_SHARES.len()).map(Self::SmoothError))
    }

    /// `true` for an error of the heading, `false` for a yaw moment.
    pub fn is_heading_error(self) -> bool {
        matches!(self, Self::CompassError(_) | Self::SmoothError(_))
    }

    /// Number of parameters: the level, and the correlation time of coloured noise.
    pub fn parameter_count(self) -> usize {
        if matches!(self, Self::WhiteMoment | Self::WalkMoment) { 1 } else { 2 }
    }

    /// Correlation time (s) for a longest record of `longest` seconds; `None` for a white moment and a walk.
    pub fn correlation_time(self, longest: f64) -> Option<f64> {
        match self {
            Self::WhiteMoment | Self::WalkMoment => None,
            Self::OrnsteinUhlenbeck(number) => Some(GUST_CORRELATION_SHARES[number] * longest),
            Self::CompassError(number) => Some(COMPASS_CORRELATION_SHARES[number] * longest),
            Self::SmoothError(number) => Some(SMOOTH_ERROR_CORRELATION_SHARES[number] * longest),
            Self::SmoothMoment(number) => Some(SMOOTH_MOMENT_CORRELATION_SHARES[number] * longest),
        }
    }

    /// Spectral density of w for level 1, with a longest record of `longest` seconds; the density of gusts at low
    /// frequency is that of a white moment.
    pub fn intensity(self, longest: f64) -> f64 {
        let white = 3.0 / longest.powi(3);
        match self {
            Self::WhiteMoment => white,
            Self::OrnsteinUhlenbeck(number) => white / (GUST_CORRELATION_SHARES[number] * longest).powi(2),
            Self::WalkMoment => 20.0 / longest.powi(5),
            Self::CompassError(number) => 2.0 / (COMPASS_CORRELATION_SHARES[number] * longest),
            Self::SmoothError(number) => 4.0 / (SMOOTH_ERROR_CORRELATION_SHARES[number] * longest).powi(3),
            Self::SmoothMoment(number) => 4.0 / (SMOOTH_MOMENT_CORRELATION_SHARES[number] * longest).powi(3),
        }
    }

    /// Size for a level ([`NoiseColour::correlated`]): for a white moment the root of the spectral density of its yaw
    /// acceleration, rad/s² √s; for gusts and a smooth moment the standard deviation, rad/s²; for a walk the standard
    /// deviation of its change in one second, rad/s²; for an error of the heading the standard deviation, rad.
    pub fn size(self, level: f64, longest: f64) -> f64 {
        let square = level * self.intensity(longest);
        match (self, self.correlation_time(longest)) {
            (Self::SmoothError(_) | Self::SmoothMoment(_), _) => level.sqrt(),
            (_, Some(time)) => (0.5 * time * square).sqrt(),
            (_, None) => square.sqrt(),
        }
    }

    /// Matrix G of x' = G x + w (w on the last state; heading first) for a ship of this 1/T, 1/s.
    fn generator(self, damping: f64, longest: f64) -> DMatrix<f64> {
        let fading = self.correlation_time(longest).map_or(0.0, f64::recip);
        match self {
            Self::WhiteMoment => DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, -damping]),
            Self::OrnsteinUhlenbeck(_) | Self::WalkMoment => {
                DMatrix::from_row_slice(3, 3, &[0.0, 1.0, 0.0, 0.0, -damping, 1.0, 0.0, 0.0, -fading])
            }
            Self::CompassError(_) => DMatrix::from_element(1, 1, -fading),
            Self::SmoothError(_) => DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -fading * fading, -2.0 * fading]),
            Self::SmoothMoment(_) => {
                let rows = [[0.0, 1.0, 0.0, 0.0], [0.0, -damping, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
                let last = [0.0, 0.0, -fading * fading, -2.0 * fading];
                DMatrix::from_row_slice(4, 4, [rows.as_flattened(), &last].concat().as_slice())
            }
        }
    }
}

/// Coloured part of the noise, in units of the variance of the white heading noise.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NoiseColour {
    /// Correlated noise and its level; `None` without correlated noise. The level of an error of the heading is its
    /// variance. That of a random moment is the heading variance at the end of the longest record for a ship without
    /// damping, for gusts as if they were white. That of a smooth moment is the variance of its yaw acceleration.
    pub correlated: Option<(CorrelatedNoise, f64)>,
    /// Waves with `sd` in units of the white noise; `None` without waves.
    pub waves: Option<NarrowBandProcess>,
}

impl NoiseColour {
    /// White heading noise alone.
    pub const WHITE: Self = Self { correlated: None, waves: None };

    /// Number of parameters besides σ.
    pub fn parameter_count(&self) -> usize {
        self.correlated.map_or(0, |(kind, _)| kind.parameter_count()) + if self.waves.is_some() { 3 } else { 0 }
    }

    /// Random moment of a record with white noise of this variance (rad²), as rudder angle for |K/T| = `gain` (1/s²)
    /// and a longest record of `longest` seconds; [`RandomMoment::None`] for a heading error or a smooth moment.
    pub fn moment(&self, variance: f64, longest: f64, gain: f64) -> RandomMoment {
        let Some((kind, level)) = self.correlated else { return RandomMoment::None };
        let size = kind.size(level * variance, longest) / gain;
        match (kind, kind.correlation_time(longest)) {
            (CorrelatedNoise::WhiteMoment, _) => RandomMoment::White { rudder_rad_root_s: size },
            (CorrelatedNoise::WalkMoment, _) => RandomMoment::Walk { rudder_rad_per_root_s: size },
            (CorrelatedNoise::OrnsteinUhlenbeck(_), Some(correlation_s)) => {
                RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad: size, correlation_s }
            }
            _ => RandomMoment::None,
        }
    }
}

/// Transitions of the correlated noise over the time steps of a record, for level 1.
#[derive(Debug, Clone)]
struct NoiseTransition {
    states: usize,
    /// Initial variances of the states.
    initial: [f64; 4],
    /// Distinct time steps.
    steps: Vec<LinearStep<MAX_STATES>>,
    /// Index of the step before every observed row.
    of_row: Vec<usize>,
}

impl NoiseTransition {
    fn new(kind: CorrelatedNoise, inverse_time: f64, durations: &[f64], longest: f64) -> Self {
        let intensity = kind.intensity(longest);
        let generator = kind.generator(inverse_time, longest);
        let initial = match (kind, kind.correlation_time(longest)) {
            (CorrelatedNoise::SmoothError(_), Some(time)) => [1.0, time.powi(-2), 0.0, 0.0],
            (CorrelatedNoise::SmoothMoment(_), Some(time)) => [0.0, 0.0, 1.0, time.powi(-2)],
            (CorrelatedNoise::OrnsteinUhlenbeck(_), Some(time)) => [0.0, 0.0, 0.5 * time * intensity, 0.0],
            (_, Some(time)) => [0.5 * time * intensity, 0.0, 0.0, 0.0],
            (_, None) => [0.0; 4],
        };
        let mut distinct: Vec<f64> = Vec::new();
        let of_row = durations.iter().map(|&h| {
            distinct.iter().rposition(|&other| (other - h).abs() <= 1e-6 * h).unwrap_or_else(|| {
                distinct.push(h);
                distinct.len() - 1
            })
        });
        let of_row = of_row.collect();
        let steps = distinct.iter().map(|&h| LinearStep::from_generator(&generator, intensity, h)).collect();
        Self { states: generator.nrows(), initial, steps, of_row }
    }
}

/// Noise transitions of one record, cached for every kind and independent of the level.
#[derive(Debug, Clone)]
pub struct RecordNoise {
    durations: Vec<f64>,
    /// Variance of the white noise of every observed row, in units of the variance of a full row.
    variances: Vec<f64>,
    longest: f64,
    damping: f64,
    /// Transitions of every kind used so far, smooth moments last.
    transitions: Vec<OnceLock<NoiseTransition>>,
}

impl RecordNoise {
    /// Prepares the observed rows of a record for a ship of this 1/T (1/s); `longest` is the duration of the longest
    /// record (s), and a full row is the mean of `full_readings` readings.
    pub fn new(record: &PreparedRecord, inverse_time: f64, longest: f64, full_readings: usize) -> Self {
        let time = |number: usize| record.time[record.observed_rows[number]];
        let durations =
            (0..record.observed_rows.len()).map(|k| if k == 0 { 0.0 } else { time(k) - time(k - 1) }).collect();
        let variance = |&row: &usize| full_readings as f64 / record.row_readings[row] as f64;
        let variances = record.observed_rows.iter().map(variance).collect();
        // A course-unstable ship is steered back, so a random moment acts as on a neutrally stable ship.
        let damping = inverse_time.max(0.0);
        Self { durations, variances, longest, damping, transitions: Self::kinds().map(|_| OnceLock::new()).collect() }
    }

    /// Every kind of correlated noise, smooth moments last.
    fn kinds() -> impl Iterator<Item = CorrelatedNoise> {
        CorrelatedNoise::all().chain(CorrelatedNoise::smooth_moments())
    }

    /// Whitening filter for this colour, in units of the white noise of a full row.
    pub fn whitener(&self, colour: &NoiseColour) -> Whitener {
        let (system, states) = self.system(colour);
        system.whitener(states, GAIN_TOLERANCE)
    }

    /// Linear system of correlated noise and waves of this colour, and its number of states.
    pub(crate) fn system(&self, colour: &NoiseColour) -> (LinearSystem<MAX_STATES>, usize) {
        let correlated = colour.correlated.map(|(kind, level)| {
            let place = Self::kinds().position(|other| other == kind).expect("a kind of the list");
            let new = || NoiseTransition::new(kind, self.damping, &self.durations, self.longest);
            (self.transitions[place].get_or_init(new), level)
        });
        let first_wave = correlated.map_or(0, |(transition, _)| transition.states);
        let mut initial = [[0.0; MAX_STATES]; MAX_STATES];
        if let Some((transition, level)) = correlated {
            (0..first_wave).for_each(|k| initial[k][k] = level * transition.initial[k]);
        }
        if let Some(waves) = &colour.waves {
            let [p0, p1] = waves.stationary_sd().map(|sd| sd * sd);
            (initial[first_wave][first_wave], initial[first_wave + 1][first_wave + 1]) = (p0, p1);
        }
        let mut distinct: Vec<(f64, usize)> = Vec::new();
        let of_row = self.durations.iter().enumerate().map(|(row, &h)| {
            let key = correlated.map_or(0, |(transition, _)| transition.of_row[row]);
            let place = distinct.iter().rposition(|step| step.1 == key && (step.0 - h).abs() <= 1e-6 * h.max(1e-300));
            place.unwrap_or_else(|| {
                distinct.push((h, key));
                distinct.len() - 1
            })
        });
        let of_row: Vec<usize> = of_row.collect();
        let still =
            LinearStep { transition: [[0.0; MAX_STATES]; MAX_STATES], process_noise: [[0.0; MAX_STATES]; MAX_STATES] };
        let step = |&(h, key): &(f64, usize)| {
            let mut step =
                correlated.map_or(still, |(transition, level)| transition.steps[key].with_scaled_noise(level));
            if let Some(waves) = &colour.waves {
                add_waves(&mut step, first_wave, waves, h);
            }
            step
        };
        let steps = distinct.iter().map(step).collect();
        let second_output = colour.waves.filter(|_| first_wave > 0).map(|_| first_wave);
        let states = first_wave + if colour.waves.is_some() { 2 } else { 0 };
        (LinearSystem::from_rows(steps, initial, &of_row, &self.variances, second_output), states)
    }
}

/// Adds waves to a step over h, as the two states from `first` on.
fn add_waves(step: &mut LinearStep<MAX_STATES>, first: usize, waves: &NarrowBandProcess, h: f64) {
    let sea = waves.step(h);
    let (a, b) = (sea.advance([1.0, 0.0], [0.0; 2]), sea.advance([0.0, 1.0], [0.0; 2]));
    let (c, d) = (sea.advance([0.0; 2], [1.0, 0.0]), sea.advance([0.0; 2], [0.0, 1.0]));
    for i in 0..2 {
        (step.transition[first + i][first], step.transition[first + i][first + 1]) = (a[i], b[i]);
        for j in 0..2 {
            step.process_noise[first + i][first + j] = c[i] * c[j] + d[i] * d[j];
        }
    }
}

#[cfg(test)]
mod tests;
