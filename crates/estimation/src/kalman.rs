//! Kalman filter of a linear system with readings in a fixed order. Gains and variances do not depend on the values of
//! the readings, so the filter is a linear map that whitens columns of readings.
//!
//! x ← F x + w before a reading, cov w = Q; a sensor reads one state or the sum of two, with white noise. With one kind
//! of reading at even times the gain becomes stationary; then no further covariance is computed.
//!
//! Sources: Kalman (1960), Journal of Basic Engineering 82:35-45; Harvey (1989), Forecasting, Structural Time Series
//! Models and the Kalman Filter, for the prediction error decomposition.

mod matrix;
pub mod smoother;

pub use matrix::{congruence, identity, product, sum};

use crate::lanes::{Kernel, run};

/// Maximum number of states of a [`Whitener`].
pub const MAX_STATES: usize = 5;

/// Maximum period of a repeating sequence of readings: two sensors in turn.
const MAX_PERIOD: usize = 2;

/// Relative change below which a gain is stationary.
const GAIN_TOLERANCE: f64 = 1e-10;

/// Time step of a linear system: transition matrix F and process-noise covariance Q.
#[derive(Debug, Clone, Copy)]
pub struct Step<const N: usize> {
    /// Transition matrix F.
    pub transition: [[f64; N]; N],
    /// Process-noise covariance Q.
    pub process_noise: [[f64; N]; N],
}

impl<const N: usize> Step<N> {
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
}

/// Sensor of a state, or of the sum of two states, with white noise.
#[derive(Debug, Clone, Copy)]
pub struct Sensor {
    /// Index of the state.
    pub state: usize,
    /// Index of a second state that is added.
    pub second_state: Option<usize>,
    /// Variance of the noise.
    pub variance: f64,
}

impl Sensor {
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
pub struct Reading {
    /// Index of the time step before the reading; [`NO_TIME`] if no time passes.
    step: u32,
    /// Index of the sensor.
    sensor: u32,
}

/// Step of a reading at the time of the reading before it.
const NO_TIME: u32 = u32::MAX;

impl Reading {
    /// Reading of a sensor after a time step; `None` if no time passes.
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
pub struct System<const N: usize> {
    /// Distinct time steps.
    pub steps: Vec<Step<N>>,
    /// Distinct sensors.
    pub sensors: Vec<Sensor>,
    /// Readings in order of time.
    pub readings: Vec<Reading>,
    /// Covariance of the state before the first reading.
    pub initial: [[f64; N]; N],
}

impl<const N: usize> System<N> {
    /// System with one reading per row: the first state, or its sum with `second_state`, with the noise variance of
    /// that row. `row_steps` has the index of the time step before every row; the first index is ignored.
    pub fn from_rows(
        steps: Vec<Step<N>>,
        initial: [[f64; N]; N],
        row_steps: &[usize],
        variances: &[f64],
        second_state: Option<usize>,
    ) -> Self {
        let mut sensors: Vec<Sensor> = Vec::new();
        let reading = |(row, (&step, &variance)): (usize, (&usize, &f64))| {
            let index = sensors.iter().position(|sensor| sensor.variance == variance);
            let sensor = index.unwrap_or_else(|| {
                sensors.push(Sensor { state: 0, second_state, variance });
                sensors.len() - 1
            });
            Reading::new((row > 0).then_some(step), sensor)
        };
        let readings = row_steps.iter().zip(variances).enumerate().map(reading).collect();
        Self { steps, sensors, readings, initial }
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
pub struct Filter<const N: usize> {
    system: System<N>,
    gains: Vec<Gain<N>>,
    /// 1/√S of every gain.
    weights: Vec<f64>,
    /// Index of the gain of every reading.
    gain_of: Vec<u32>,
}

impl<const N: usize> Filter<N> {
    /// Filter of a system, with the default tolerance for stationary gains.
    pub fn new(system: System<N>) -> Self {
        Self::with_tolerance(system, GAIN_TOLERANCE)
    }

    /// Filter whose gains are taken as stationary if their relative change is below `tolerance`.
    pub fn with_tolerance(system: System<N>, tolerance: f64) -> Self {
        Self::visiting(system, tolerance, |_| ())
    }

    /// Filter that passes the predicted covariance of every new gain to `visit`.
    fn visiting(system: System<N>, tolerance: f64, mut visit: impl FnMut(&[[f64; N]; N])) -> Self {
        let readings = &system.readings;
        let mut filter = (Vec::<Gain<N>>::new(), Vec::<u32>::with_capacity(readings.len()));
        let (gains, gain_of) = (&mut filter.0, &mut filter.1);
        // Covariances after the last readings, by their position in the period.
        let mut after = [system.initial; MAX_PERIOD];
        let mut stationary = 0;
        for (number, reading) in readings.iter().enumerate() {
            let repeats = number >= MAX_PERIOD && readings[number - MAX_PERIOD] == *reading;
            if repeats && stationary >= MAX_PERIOD {
                gain_of.push(gain_of[number - MAX_PERIOD]);
                continue;
            }
            let before = &after[(number + MAX_PERIOD - 1) % MAX_PERIOD];
            let mut covariance = reading.step().map_or(*before, |step| system.steps[step].propagate(before));
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
        }
        let (gains, gain_of) = filter;
        let weights = gains.iter().map(|gain| gain.variance.sqrt().recip()).collect();
        Self { system, gains, weights, gain_of }
    }

    /// Sum Σ log S over the readings.
    pub fn log_determinant(&self) -> f64 {
        let logs: Vec<f64> = self.gains.iter().map(|gain| gain.variance.ln()).collect();
        self.gain_of.iter().map(|&gain| logs[gain as usize]).sum()
    }

    /// Whitener of the filter, independent of the number of states at compile time.
    pub fn whitener(&self) -> Whitener {
        let wide =
            |row: &[f64; N]| -> [f64; MAX_STATES] { std::array::from_fn(|k| row.get(k).copied().unwrap_or(0.0)) };
        let matrix = |f: &[[f64; N]; N]| -> [[f64; MAX_STATES]; MAX_STATES] {
            std::array::from_fn(|k| f.get(k).map_or([0.0; MAX_STATES], wide))
        };
        Whitener {
            states: N,
            transitions: self.system.steps.iter().map(|step| matrix(&step.transition)).collect(),
            sensors: self.system.sensors.clone(),
            gains: self.gains.iter().zip(&self.weights).map(|(gain, &weight)| (wide(&gain.gain), weight)).collect(),
            readings: self.system.readings.iter().copied().zip(self.gain_of.iter().copied()).collect(),
            log_variance: self.log_determinant(),
        }
    }
}

/// Kalman gain of a reading; corrects the covariance by the reading.
fn correct<const N: usize>(covariance: &mut [[f64; N]; N], sensor: &Sensor) -> Gain<N> {
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

/// Evaluation of an expression with the number of states as a constant, chosen at run time.
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

/// Whitening filter: turns columns of readings into innovations in units of their standard deviation.
#[derive(Debug, Clone)]
pub struct Whitener {
    states: usize,
    transitions: Vec<[[f64; MAX_STATES]; MAX_STATES]>,
    sensors: Vec<Sensor>,
    /// Gains, each with 1/√S.
    gains: Vec<([f64; MAX_STATES], f64)>,
    /// Every reading with the index of its gain.
    readings: Vec<(Reading, u32)>,
    /// Sum Σ log S over the readings.
    pub log_variance: f64,
}

impl Whitener {
    /// Log variance log S of every innovation.
    pub fn log_variances(&self) -> Vec<f64> {
        let logs: Vec<f64> = self.gains.iter().map(|(_, weight)| -2.0 * weight.ln()).collect();
        self.readings.iter().map(|&(_, gain)| logs[gain as usize]).collect()
    }

    /// Whitens columns in place, several at once: the recursion within a column is serial, the columns are independent.
    pub fn apply(&self, columns: &mut [&mut Vec<f64>]) {
        with_states!(self.states, N => {
            for columns in columns.chunks_mut(COLUMNS) {
                match columns.len() {
                    1 => run(Whitening::<N, 1> { whitener: self, columns }),
                    _ => run(Whitening::<N, COLUMNS> { whitener: self, columns }),
                }
            }
        });
    }

    /// Predicted states before every reading of a column, given the earlier readings.
    pub fn predicted_states(&self, column: &[f64]) -> Vec<[f64; MAX_STATES]> {
        let mut x = [[0.0]; MAX_STATES];
        let predict = |(&value, &(reading, gain)): (&f64, &(Reading, u32))| {
            if let Some(step) = reading.step() {
                x = advanced(&self.transitions[step], &x);
            }
            let before = x.map(|[state]| state);
            let [seen] = if self.states == 0 { [0.0] } else { self.sensors[reading.sensor()].observe(&x) };
            let (gain, _) = &self.gains[gain as usize];
            x.iter_mut().zip(gain).for_each(|(state, gain)| state[0] += gain * (value - seen));
            before
        };
        column.iter().zip(&self.readings).map(predict).collect()
    }

    /// Applies the transpose Wᵀ of the whitening W to a column in place; WᵀW = Σ⁻¹, the inverse noise covariance.
    pub fn apply_transposed(&self, column: &mut [f64]) {
        let mut later = [0.0; MAX_STATES];
        for (value, &(reading, gain)) in column.iter_mut().zip(&self.readings).rev() {
            let (gain, weight) = &self.gains[gain as usize];
            *value = *value * weight + (0..self.states).map(|i| gain[i] * later[i]).sum::<f64>();
            let Sensor { state, second_state, .. } = self.sensors[reading.sensor()];
            [Some(state), second_state].into_iter().flatten().for_each(|state| later[state] -= *value);
            if let Some(step) = reading.step() {
                let f = &self.transitions[step];
                later = std::array::from_fn(|j| (0..self.states).map(|i| f[i][j] * later[i]).sum());
            }
        }
    }
}

/// Number of columns whitened at once, and number of rows copied at a time for them.
const COLUMNS: usize = 8;
const ROWS: usize = 64;

/// Whitening of up to `COLUMNS` columns.
struct Whitening<'a, 'b, const N: usize, const COLUMNS: usize> {
    whitener: &'a Whitener,
    columns: &'a mut [&'b mut Vec<f64>],
}

impl<const N: usize, const COLUMNS: usize> Kernel for Whitening<'_, '_, N, COLUMNS> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Whitener { transitions, sensors, gains, readings, .. } = self.whitener;
        let mut x = [[0.0; COLUMNS]; N];
        // A missing column contains zeros.
        let mut block = [[0.0; COLUMNS]; ROWS];
        for (number, readings) in readings.chunks(ROWS).enumerate() {
            let rows = number * ROWS..number * ROWS + readings.len();
            for (k, column) in self.columns.iter().enumerate() {
                block.iter_mut().zip(&column[rows.clone()]).for_each(|(values, value)| values[k] = *value);
            }
            for (values, &(reading, gain)) in block.iter_mut().zip(readings) {
                if let Some(step) = reading.step() {
                    x = advanced(&transitions[step], &x);
                }
                let (gain, weight) = &gains[gain as usize];
                let seen = sensors[reading.sensor()].observe(&x);
                let mut innovation = [0.0; COLUMNS];
                for k in 0..COLUMNS {
                    innovation[k] = values[k] - seen[k];
                    values[k] = innovation[k] * weight;
                }
                for (x, gain) in x.iter_mut().zip(gain) {
                    for k in 0..COLUMNS {
                        x[k] += gain * innovation[k];
                    }
                }
            }
            for (k, column) in self.columns.iter_mut().enumerate() {
                column[rows.clone()].iter_mut().zip(&block).for_each(|(value, values)| *value = values[k]);
            }
        }
    }
}

/// Product F x for several state vectors at once.
#[inline(always)]
fn advanced<const N: usize, const COLUMNS: usize>(
    f: &[[f64; MAX_STATES]; MAX_STATES],
    x: &[[f64; COLUMNS]; N],
) -> [[f64; COLUMNS]; N] {
    let mut next = [[0.0; COLUMNS]; N];
    for (next, f) in next.iter_mut().zip(f) {
        for (x, f) in x.iter().zip(f) {
            for k in 0..COLUMNS {
                next[k] += f * x[k];
            }
        }
    }
    next
}
