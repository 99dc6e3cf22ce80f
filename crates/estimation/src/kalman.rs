//! Kalman filter of a linear system with readings in a fixed order. Gains and variances do not depend on the values of
//! the readings, so the filter is a linear map that whitens columns of readings.
//!
//! x ← F x + w before a reading, cov w = Q; a sensor reads one state or the sum of two, with white noise. With one
//! sensor at even times, or two in turn, the gains become stationary; then no further covariance is computed.
//!
//! Sources: Kalman (1960), Journal of Basic Engineering 82:35-45; Harvey (1989), Forecasting, Structural Time Series
//! Models and the Kalman Filter, for the prediction error decomposition.

mod matrix;
pub mod smoother;
pub mod whitener;

use matrix::congruence_upper;
pub use matrix::{congruence, identity, product, sum};

/// Maximum number of states of a [`Whitener`](whitener::Whitener).
pub const MAX_STATES: usize = 5;

/// Maximum period of a repeating sequence of readings: two sensors in turn.
const MAX_PERIOD: usize = 2;

/// Relative change below which a gain is stationary.
const GAIN_TOLERANCE: f64 = 1e-10;

/// Time step of a linear system: transition matrix F and process-noise covariance Q.
#[derive(Debug, Clone, Copy)]
pub struct LinearStep<const N: usize> {
    /// Transition matrix F.
    pub transition: [[f64; N]; N],
    /// Process-noise covariance Q.
    pub process_noise: [[f64; N]; N],
}

impl<const N: usize> LinearStep<N> {
    /// Combined step: this step followed by `next`.
    pub fn followed_by(&self, next: &Self) -> Self {
        Self {
            transition: product(&next.transition, &self.transition),
            process_noise: next.propagate(&self.process_noise),
        }
    }

    /// Covariance after the step, F P Fᵀ + Q.
    pub fn propagate(&self, covariance: &[[f64; N]; N]) -> [[f64; N]; N] {
        sum(&self.process_noise, &congruence(&self.transition, covariance))
    }

    /// Covariance after a step with an upper triangular transition matrix.
    fn propagate_upper(&self, covariance: &[[f64; N]; N]) -> [[f64; N]; N] {
        sum(&self.process_noise, &congruence_upper(&self.transition, covariance))
    }

    /// `true` if the transition matrix is upper triangular.
    fn is_upper(&self) -> bool {
        (0..N).all(|i| self.transition[i][..i].iter().all(|&value| value == 0.0))
    }
}

/// Sensor of a state, or of the sum of two states, with white noise.
#[derive(Debug, Clone, Copy)]
pub struct StateSensor {
    /// Index of the state.
    pub state: usize,
    /// Index of a second state, which is added to the first; `None` for a sensor of one state.
    pub second_state: Option<usize>,
    /// Variance of the noise.
    pub variance: f64,
}

impl StateSensor {
    /// Reading without noise, for several state vectors at once.
    #[inline(always)]
    fn observe<const N: usize, const COLUMNS: usize>(&self, x: &[[f64; COLUMNS]; N]) -> [f64; COLUMNS] {
        match self.second_state {
            Some(second_state) => std::array::from_fn(|k| x[self.state % N.max(1)][k] + x[second_state % N.max(1)][k]),
            None if N == 0 => [0.0; COLUMNS],
            None => x[self.state % N.max(1)],
        }
    }
}

/// Reading: the time step before it, and its sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SensorReading {
    /// Index of the time step before the reading; [`NO_TIME`] if no time passes.
    step: u32,
    /// Index of the sensor.
    sensor: u32,
}

/// Step of a reading at the time of the reading before it.
const NO_TIME: u32 = u32::MAX;

impl SensorReading {
    /// Reading of a sensor after the time step of index `step`, which is `None` if no time passes.
    ///
    /// # Panics
    /// If an index is beyond 32 bits.
    pub fn new(step: Option<usize>, sensor: usize) -> Self {
        let narrow = |index: usize| u32::try_from(index).expect("fewer than 2³² steps and sensors");
        Self { step: step.map_or(NO_TIME, narrow), sensor: narrow(sensor) }
    }

    /// Index of the time step before the reading; `None` if no time passes.
    #[inline(always)]
    pub fn step(self) -> Option<usize> {
        (self.step != NO_TIME).then_some(self.step as usize)
    }

    /// Index of the sensor.
    #[inline(always)]
    pub fn sensor(self) -> usize {
        self.sensor as usize
    }
}

/// Linear system with the sequence of its readings.
#[derive(Debug, Clone)]
pub struct LinearSystem<const N: usize> {
    /// Distinct time steps.
    pub steps: Vec<LinearStep<N>>,
    /// Distinct sensors.
    pub sensors: Vec<StateSensor>,
    /// Readings in order of time.
    pub readings: Vec<SensorReading>,
    /// Covariance of the state before the first reading.
    pub initial_covariance: [[f64; N]; N],
}

impl<const N: usize> LinearSystem<N> {
    /// System with one reading per row: the first state, or its sum with `second_state`, with the noise variance of
    /// that row. `row_steps` has the index of the time step before every row; the first index is ignored.
    pub fn from_rows(
        steps: Vec<LinearStep<N>>,
        initial: [[f64; N]; N],
        row_steps: &[usize],
        variances: &[f64],
        second_state: Option<usize>,
    ) -> Self {
        let mut sensors: Vec<StateSensor> = Vec::new();
        let reading = |(row, (&step, &variance)): (usize, (&usize, &f64))| {
            let index = sensors.iter().position(|sensor| sensor.variance == variance);
            let sensor = index.unwrap_or_else(|| {
                sensors.push(StateSensor { state: 0, second_state, variance });
                sensors.len() - 1
            });
            SensorReading::new((row > 0).then_some(step), sensor)
        };
        let readings = row_steps.iter().zip(variances).enumerate().map(reading).collect();
        Self { steps, sensors, readings, initial_covariance: initial }
    }
}

/// Kalman gain of a reading, with the variance of its innovation.
#[derive(Debug, Clone, Copy)]
struct Gain<const N: usize> {
    gain: [f64; N],
    /// Variance S of the innovation.
    variance: f64,
}

/// Kalman filter: the gains of all readings, equal gains stored once.
#[derive(Debug, Clone)]
pub struct KalmanFilter<const N: usize> {
    system: LinearSystem<N>,
    gains: Vec<Gain<N>>,
    /// 1/√S of every gain.
    weights: Vec<f64>,
    /// log S of every gain.
    log_variances: Vec<f64>,
    /// Index of the gain of every reading.
    gain_of: Vec<u32>,
}

impl<const N: usize> KalmanFilter<N> {
    /// Filter of a system, with the default tolerance for stationary gains.
    pub fn new(system: LinearSystem<N>) -> Self {
        Self::with_tolerance(system, GAIN_TOLERANCE)
    }

    /// Filter whose gains are taken as stationary if their relative change is below `tolerance`.
    pub fn with_tolerance(system: LinearSystem<N>, tolerance: f64) -> Self {
        Self::visiting(system, tolerance, |_| ())
    }

    /// Filter that passes the predicted covariance of every new gain to `visit`.
    fn visiting(system: LinearSystem<N>, tolerance: f64, mut visit: impl FnMut(&[[f64; N]; N])) -> Self {
        let readings = &system.readings;
        let mut filter = (Vec::<Gain<N>>::new(), Vec::<u32>::with_capacity(readings.len()));
        let (gains, gain_of) = (&mut filter.0, &mut filter.1);
        // Covariances after the last readings, by their position in the period.
        let mut after = [system.initial_covariance; MAX_PERIOD];
        let mut stationary = 0;
        let is_upper = system.steps.iter().all(LinearStep::is_upper);
        let mut number = 0;
        while number < readings.len() {
            let reading = &readings[number];
            let repeats = number >= MAX_PERIOD && readings[number - MAX_PERIOD] == *reading;
            if repeats && stationary >= MAX_PERIOD {
                let period: [u32; MAX_PERIOD] = std::array::from_fn(|k| gain_of[number - MAX_PERIOD + k]);
                let again = readings[number..].iter().zip(&readings[number - MAX_PERIOD..]);
                let again = again.take_while(|(reading, before)| reading == before).count();
                gain_of.extend((0..again).map(|k| period[k % MAX_PERIOD]));
                number += again;
                continue;
            }
            let before = &after[(number + MAX_PERIOD - 1) % MAX_PERIOD];
            let mut covariance = match reading.step().map(|step| &system.steps[step]) {
                Some(step) if is_upper => step.propagate_upper(before),
                Some(step) => step.propagate(before),
                None => *before,
            };
            visit(&covariance);
            let gain = correct(&mut covariance, &system.sensors[reading.sensor()]);
            after[number % MAX_PERIOD] = covariance;
            let is_stationary = repeats && {
                let before = &gains[gain_of[number - MAX_PERIOD] as usize];
                gain.gain.iter().zip(&before.gain).all(|(now, before)| (now - before).abs() <= tolerance * now.abs())
            };
            stationary = if is_stationary { stationary + 1 } else { 0 };
            gain_of.push(gains.len() as u32);
            gains.push(gain);
            number += 1;
        }
        let (gains, gain_of) = filter;
        let weights = gains.iter().map(|gain| gain.variance.sqrt().recip()).collect();
        let log_variances = gains.iter().map(|gain| gain.variance.ln()).collect();
        Self { system, gains, weights, log_variances, gain_of }
    }

    /// Sum Σ log S over the readings, with the innovation variances S: log determinant of the covariance of the
    /// readings.
    pub fn log_determinant(&self) -> f64 {
        let mut counts = vec![0_u32; self.gains.len()];
        self.gain_of.iter().for_each(|&gain| counts[gain as usize] += 1);
        counts.iter().zip(&self.log_variances).map(|(&count, log)| f64::from(count) * log).sum()
    }
}

/// Kalman gain of a reading; corrects the covariance by the reading.
fn correct<const N: usize>(covariance: &mut [[f64; N]; N], sensor: &StateSensor) -> Gain<N> {
    let seen: [f64; N] = std::array::from_fn(|i| match sensor.second_state {
        Some(second_state) => covariance[i][sensor.state] + covariance[i][second_state],
        None => covariance[i][sensor.state],
    });
    let variance = match sensor.second_state {
        Some(second_state) => seen[sensor.state] + seen[second_state] + sensor.variance,
        None if N == 0 => sensor.variance,
        None => seen[sensor.state] + sensor.variance,
    };
    let gain = seen.map(|value| value / variance);
    for i in 0..N {
        for j in 0..=i {
            covariance[i][j] -= gain[i] * seen[j];
            covariance[j][i] = covariance[i][j];
        }
    }
    Gain { gain, variance }
}

/// Evaluates an expression with a number of states from 0 to 5, known at run time, as the constant `$N`; a larger
/// number counts as 5.
#[macro_export]
macro_rules! with_states {
    ($states:expr, $N:ident => $body:expr) => {
        match $states {
            0 => $crate::with_states!(@ 0, $N => $body),
            1 => $crate::with_states!(@ 1, $N => $body),
            2 => $crate::with_states!(@ 2, $N => $body),
            3 => $crate::with_states!(@ 3, $N => $body),
            4 => $crate::with_states!(@ 4, $N => $body),
            _ => $crate::with_states!(@ 5, $N => $body),
        }
    };
    (@ $number:literal, $N:ident => $body:expr) => {{
        const $N: usize = $number;
        $body
    }};
}
