//! The Kalman filter of a linear system that is read in a known order: gains and variances do not depend on what is
//! read, so the filter is a linear map that makes columns of readings white.
//!
//! x ← F x + w before a reading, cov w = Q; a sensor sees the sum of one or two states and white noise. With one kind
//! of reading at even times the gain settles; from there on no covariance is computed.
//!
//! Source: Harvey (1989) for the prediction error decomposition.

mod matrix;
pub mod smoother;

pub use matrix::{identity, product, sandwich, sum};

use crate::lanes::{Kernel, run};

/// Most states of a [`Whitener`].
pub const MOST: usize = 5;

/// Longest pattern of readings that repeats itself: that of two sensors in turn.
const PATTERN: usize = 2;

/// A gain that changes by less than this share has settled.
const SETTLED: f64 = 1e-10;

/// Transition F and added covariance Q over a step of time.
#[derive(Debug, Clone, Copy)]
pub struct Step<const N: usize> {
    /// F.
    pub transition: [[f64; N]; N],
    /// Q.
    pub added: [[f64; N]; N],
}

impl<const N: usize> Step<N> {
    /// This step and then another one.
    pub fn then(&self, next: &Self) -> Self {
        Self { transition: product(&next.transition, &self.transition), added: next.propagate(&self.added) }
    }

    /// The covariance after the step: F P Fᵀ + Q.
    pub fn propagate(&self, covariance: &[[f64; N]; N]) -> [[f64; N]; N] {
        sum(&self.added, &sandwich(&self.transition, covariance))
    }
}

/// What a sensor reads: a state, or the sum of two, and white noise of this variance.
#[derive(Debug, Clone, Copy)]
pub struct Sensor {
    /// Place of the state.
    pub state: usize,
    /// Place of the state that is added.
    pub beside: Option<usize>,
    /// Variance of the noise.
    pub variance: f64,
}

impl Sensor {
    /// What it makes of states, or of states side by side.
    #[inline(always)]
    fn of<const N: usize, const COLUMNS: usize>(&self, x: &[[f64; COLUMNS]; N]) -> [f64; COLUMNS] {
        match self.beside {
            Some(beside) => std::array::from_fn(|k| x[self.state % N.max(1)][k] + x[beside % N.max(1)][k]),
            None if N == 0 => [0.0; COLUMNS],
            None => x[self.state % N.max(1)],
        }
    }
}

/// A reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reading {
    /// The kind of step that leads to it; `None` when no time passes.
    pub step: Option<usize>,
    /// The sensor.
    pub sensor: usize,
}

/// A system and the order in which it is read.
#[derive(Debug, Clone)]
pub struct System<const N: usize> {
    /// Kinds of steps.
    pub steps: Vec<Step<N>>,
    /// Sensors.
    pub sensors: Vec<Sensor>,
    /// Readings in their order.
    pub readings: Vec<Reading>,
    /// Covariance of the state before the first reading.
    pub initial: [[f64; N]; N],
}

impl<const N: usize> System<N> {
    /// A system of which every row is read once: its first state, or the sum of it and the one `beside`, with noise of
    /// a variance of its own; `of_row` has the step before every row, which counts from the second on.
    pub fn of_rows(
        steps: Vec<Step<N>>,
        initial: [[f64; N]; N],
        of_row: &[usize],
        variances: &[f64],
        beside: Option<usize>,
    ) -> Self {
        let mut sensors: Vec<Sensor> = Vec::new();
        let reading = |(row, (&step, &variance)): (usize, (&usize, &f64))| {
            let known = sensors.iter().position(|sensor| sensor.variance == variance);
            let sensor = known.unwrap_or_else(|| {
                sensors.push(Sensor { state: 0, beside, variance });
                sensors.len() - 1
            });
            Reading { step: (row > 0).then_some(step), sensor }
        };
        let readings = of_row.iter().zip(variances).enumerate().map(reading).collect();
        Self { steps, sensors, readings, initial }
    }
}

/// What the filter does with a reading.
#[derive(Debug, Clone, Copy)]
struct Gain<const N: usize> {
    gain: [f64; N],
    /// Predicted variance S of the reading.
    variance: f64,
}

/// Gains of all readings, each kind once.
#[derive(Debug, Clone)]
pub struct Filter<const N: usize> {
    system: System<N>,
    gains: Vec<Gain<N>>,
    /// One over √S of every gain.
    weights: Vec<f64>,
    /// Gain of every reading.
    of: Vec<u32>,
}

impl<const N: usize> Filter<N> {
    /// The filter of a system.
    pub fn new(system: System<N>) -> Self {
        Self::settling(system, SETTLED)
    }

    /// The same, whose gains count as settled when they change by less than this share.
    pub fn settling(system: System<N>, share: f64) -> Self {
        Self::visiting(system, share, |_| ())
    }

    /// The same, visiting the predicted covariance of every new gain.
    fn visiting(system: System<N>, share: f64, mut visit: impl FnMut(&[[f64; N]; N])) -> Self {
        let readings = &system.readings;
        let mut filter = (Vec::<Gain<N>>::new(), Vec::<u32>::with_capacity(readings.len()));
        let (gains, of) = (&mut filter.0, &mut filter.1);
        // Covariances after the last readings, by their place in a pattern.
        let mut after = [system.initial; PATTERN];
        let mut alike = 0;
        for (number, reading) in readings.iter().enumerate() {
            let repeats = number >= PATTERN && readings[number - PATTERN] == *reading;
            if repeats && alike >= PATTERN {
                of.push(of[number - PATTERN]);
                continue;
            }
            let before = &after[(number + PATTERN - 1) % PATTERN];
            let mut covariance = reading.step.map_or(*before, |step| system.steps[step].propagate(before));
            visit(&covariance);
            let gain = correct(&mut covariance, &system.sensors[reading.sensor]);
            after[number % PATTERN] = covariance;
            let settled = repeats && {
                let before = &gains[of[number - PATTERN] as usize];
                gain.gain.iter().zip(&before.gain).all(|(now, before)| (now - before).abs() <= share * now.abs())
            };
            alike = if settled { alike + 1 } else { 0 };
            of.push(gains.len() as u32);
            gains.push(gain);
        }
        let (gains, of) = filter;
        let weights = gains.iter().map(|gain| gain.variance.sqrt().recip()).collect();
        Self { system, gains, weights, of }
    }

    /// Σ log S.
    pub fn log_variance(&self) -> f64 {
        let logs: Vec<f64> = self.gains.iter().map(|gain| gain.variance.ln()).collect();
        self.of.iter().map(|&of| logs[of as usize]).sum()
    }

    /// The filter for any number of states.
    pub fn whitener(&self) -> Whitener {
        let wide = |row: &[f64; N]| -> [f64; MOST] { std::array::from_fn(|k| row.get(k).copied().unwrap_or(0.0)) };
        let matrix =
            |f: &[[f64; N]; N]| -> [[f64; MOST]; MOST] { std::array::from_fn(|k| f.get(k).map_or([0.0; MOST], wide)) };
        Whitener {
            states: N,
            transitions: self.system.steps.iter().map(|step| matrix(&step.transition)).collect(),
            sensors: self.system.sensors.clone(),
            gains: self.gains.iter().zip(&self.weights).map(|(gain, &weight)| (wide(&gain.gain), weight)).collect(),
            readings: self.system.readings.iter().copied().zip(self.of.iter().copied()).collect(),
            log_variance: self.log_variance(),
        }
    }
}

/// Takes a reading into account.
fn correct<const N: usize>(covariance: &mut [[f64; N]; N], sensor: &Sensor) -> Gain<N> {
    let seen: [f64; N] = std::array::from_fn(|i| match sensor.beside {
        Some(beside) => covariance[i][sensor.state] + covariance[i][beside],
        None => covariance[i][sensor.state],
    });
    let variance = match sensor.beside {
        Some(beside) => seen[sensor.state] + seen[beside] + sensor.variance,
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

/// Picks the number of states when the program runs.
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

/// A filter that makes columns of readings white: innovations in units of their standard deviation.
#[derive(Debug, Clone)]
pub struct Whitener {
    states: usize,
    transitions: Vec<[[f64; MOST]; MOST]>,
    sensors: Vec<Sensor>,
    /// Gain and one over the predicted standard deviation.
    gains: Vec<([f64; MOST], f64)>,
    /// Every reading with its gain.
    readings: Vec<(Reading, u32)>,
    /// Σ log S.
    pub log_variance: f64,
}

impl Whitener {
    /// log S of every reading.
    pub fn log_variances(&self) -> Vec<f64> {
        let logs: Vec<f64> = self.gains.iter().map(|(_, weight)| -2.0 * weight.ln()).collect();
        self.readings.iter().map(|&(_, gain)| logs[gain as usize]).collect()
    }

    /// Makes columns white in place, several at once: the filter waits for the last reading of each, but not for the
    /// other columns.
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

    /// The states that are predicted before every reading of a column, from the readings before it.
    pub fn predicted(&self, column: &[f64]) -> Vec<[f64; MOST]> {
        let mut x = [[0.0]; MOST];
        let predict = |(&value, &(Reading { step, sensor }, gain)): (&f64, &(Reading, u32))| {
            if let Some(step) = step {
                x = advanced(&self.transitions[step], &x);
            }
            let before = x.map(|[state]| state);
            let [seen] = if self.states == 0 { [0.0] } else { self.sensors[sensor].of(&x) };
            let (gain, _) = &self.gains[gain as usize];
            x.iter_mut().zip(gain).for_each(|(state, gain)| state[0] += gain * (value - seen));
            before
        };
        column.iter().zip(&self.readings).map(predict).collect()
    }

    /// Applies the transpose of what makes a column white, so that both together are Σ⁻¹ of the noise.
    pub fn apply_transposed(&self, column: &mut [f64]) {
        let mut later = [0.0; MOST];
        for (value, &(Reading { step, sensor }, gain)) in column.iter_mut().zip(&self.readings).rev() {
            let (gain, weight) = &self.gains[gain as usize];
            *value = *value * weight + (0..self.states).map(|i| gain[i] * later[i]).sum::<f64>();
            let Sensor { state, beside, .. } = self.sensors[sensor];
            [Some(state), beside].into_iter().flatten().for_each(|state| later[state] -= *value);
            if let Some(step) = step {
                let f = &self.transitions[step];
                later = std::array::from_fn(|j| (0..self.states).map(|i| f[i][j] * later[i]).sum());
            }
        }
    }
}

/// Columns that are made white side by side, and rows that are laid side by side for it at a time.
const COLUMNS: usize = 8;
const ROWS: usize = 64;

/// Makes up to so many columns white.
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
        // A column that is not there holds zeros.
        let mut block = [[0.0; COLUMNS]; ROWS];
        for (number, readings) in readings.chunks(ROWS).enumerate() {
            let rows = number * ROWS..number * ROWS + readings.len();
            for (k, column) in self.columns.iter().enumerate() {
                block.iter_mut().zip(&column[rows.clone()]).for_each(|(values, value)| values[k] = *value);
            }
            for (values, &(Reading { step, sensor }, gain)) in block.iter_mut().zip(readings) {
                if let Some(step) = step {
                    x = advanced(&transitions[step], &x);
                }
                let (gain, weight) = &gains[gain as usize];
                let seen = sensors[sensor].of(&x);
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

/// F x of states side by side.
#[inline(always)]
fn advanced<const N: usize, const COLUMNS: usize>(
    f: &[[f64; MOST]; MOST],
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
