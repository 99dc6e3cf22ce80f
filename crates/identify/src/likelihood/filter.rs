//! The Kalman filter as a map that makes columns white, and how it changes with the law of the noise.
//!
//! With readings of one kind at even times the gain settles; from there on no covariance is computed.

use ship::{DIRECTIONS, Tangent};

use super::law::{Law, Variable};
use super::schedule::{Of, Reading, Schedule};
use super::transition::Step;

/// Most states: heading, rate, moment, rudder error, compass error.
const MOST: usize = 5;

/// Instruments, and so the longest pattern of readings that repeats itself.
const INSTRUMENTS: usize = 2;

/// A gain that changes by less than this share, and its derivatives by less than the other, has settled.
const SETTLED: f64 = 1e-11;
const SETTLED_SLOPE: f64 = 1e-8;

/// What the filter does with a reading.
#[derive(Debug, Clone, Copy)]
struct Gain<R, const N: usize> {
    gain: [R; N],
    /// Predicted variance S of the reading, in units of that of the compass.
    variance: R,
}

/// Gains of all readings, each kind once.
#[derive(Debug, Clone)]
struct Filter<R, const N: usize> {
    transitions: Vec<[[R; N]; N]>,
    gains: Vec<Gain<R, N>>,
    /// Gain of every reading.
    of: Vec<u32>,
    compass: Option<usize>,
}

impl<R: Variable, const N: usize> Filter<R, N> {
    fn new(schedule: &Schedule, law: &Law<R>, initial: [f64; 2]) -> Self {
        let zero = R::from(0.0);
        let compass = law.compass_state();
        let mut covariance = [[zero; N]; N];
        for (place, variance) in initial.into_iter().enumerate() {
            covariance[place][place] = R::from(variance);
        }
        if law.moment == super::Moment::OrnsteinUhlenbeck {
            covariance[2][2] = law.level * law.level;
        }
        for place in [law.rudder_state(), compass].into_iter().flatten() {
            covariance[place][place] = R::from(1.0);
        }
        let steps: Vec<Step<R, N>> = schedule.spans.iter().map(|span| Step::new(law, span)).collect();
        let mut filter = Self {
            transitions: steps.iter().map(|step| step.transition).collect(),
            gains: Vec::new(),
            of: Vec::with_capacity(schedule.readings.len()),
            compass,
        };
        // Covariances after the last readings, by their place in a pattern of as many as there are instruments.
        let mut after = [covariance; INSTRUMENTS];
        let mut alike = 0;
        for (number, reading) in schedule.readings.iter().enumerate() {
            let repeats = number >= INSTRUMENTS && schedule.readings[number - INSTRUMENTS] == *reading;
            if repeats && alike >= INSTRUMENTS {
                filter.of.push(filter.of[number - INSTRUMENTS]);
                continue;
            }
            if let Some(step) = reading.step {
                covariance = steps[step].propagate(&after[(number + INSTRUMENTS - 1) % INSTRUMENTS]);
            } else if number > 0 {
                covariance = after[(number + INSTRUMENTS - 1) % INSTRUMENTS];
            }
            let gain = filter.correct(&mut covariance, law, reading.of);
            after[number % INSTRUMENTS] = covariance;
            let settled = repeats && {
                let before = &filter.gains[filter.of[number - INSTRUMENTS] as usize];
                gain.gain.iter().zip(&before.gain).all(|(one, other)| has_settled(*one, *other))
            };
            alike = if settled { alike + 1 } else { 0 };
            filter.of.push(filter.gains.len() as u32);
            filter.gains.push(gain);
        }
        filter
    }

    /// Takes a reading into account.
    fn correct(&self, covariance: &mut [[R; N]; N], law: &Law<R>, of: Of) -> Gain<R, N> {
        let seen: [R; N] = match of {
            Of::Heading => std::array::from_fn(|i| match self.compass {
                Some(compass) => covariance[i][0] + covariance[i][compass],
                None => covariance[i][0],
            }),
            Of::YawRate => std::array::from_fn(|i| covariance[i][1]),
        };
        let variance = match (of, self.compass) {
            (Of::Heading, Some(compass)) => seen[0] + seen[compass],
            (Of::Heading, None) => seen[0] + 1.0,
            (Of::YawRate, _) => seen[1] + law.gyro * law.gyro,
        };
        let gain = seen.map(|value| value / variance);
        for i in 0..N {
            for j in 0..=i {
                covariance[i][j] = covariance[i][j] - gain[i] * seen[j];
                covariance[j][i] = covariance[i][j];
            }
        }
        Gain { gain, variance }
    }

    /// What a state makes a reading.
    fn read<T: Copy + std::ops::Add<Output = T>>(&self, state: &[T; N], of: Of) -> T {
        match (of, self.compass) {
            (Of::Heading, Some(compass)) => state[0] + state[compass],
            (Of::Heading, None) => state[0],
            (Of::YawRate, _) => state[1],
        }
    }
}

/// Whether a number hardly changed, nor its derivatives.
fn has_settled<R: Variable>(now: R, before: R) -> bool {
    let size = now.value().abs();
    let near = |(now, before): (&f64, &f64)| (now - before).abs() <= SETTLED_SLOPE * now.abs().max(1e-3 * size);
    (now.value() - before.value()).abs() <= SETTLED * size && now.slopes().iter().zip(before.slopes()).all(near)
}

/// Picks the number of states of a law when the program runs.
macro_rules! with_states {
    ($states:expr, $N:ident => $body:expr) => {
        match $states {
            2 => {
                const $N: usize = 2;
                $body
            }
            3 => {
                const $N: usize = 3;
                $body
            }
            4 => {
                const $N: usize = 4;
                $body
            }
            _ => {
                const $N: usize = 5;
                $body
            }
        }
    };
}

/// A filter that makes columns of one record white: innovations in units of their standard deviation over σ.
#[derive(Debug, Clone)]
pub(crate) struct Whitener {
    states: usize,
    compass: Option<usize>,
    transitions: Vec<[[f64; MOST]; MOST]>,
    /// Gain and one over the predicted standard deviation.
    gains: Vec<([f64; MOST], f64)>,
    /// Step and instrument of every reading, and its gain.
    readings: Vec<(Option<usize>, Of, u32)>,
    log_variance: f64,
}

impl Whitener {
    /// The filter of a law, with variances of the initial heading and yaw rate in units of that of the compass.
    pub fn new(schedule: &Schedule, law: &Law<f64>, initial: [f64; 2]) -> Self {
        with_states!(law.states(), N => Self::of(schedule, &Filter::<f64, N>::new(schedule, law, initial)))
    }

    fn of<R: Variable, const N: usize>(schedule: &Schedule, filter: &Filter<R, N>) -> Self {
        let wide = |row: &[R; N]| -> [f64; MOST] { std::array::from_fn(|k| row.get(k).map_or(0.0, |x| x.value())) };
        let matrix =
            |f: &[[R; N]; N]| -> [[f64; MOST]; MOST] { std::array::from_fn(|k| f.get(k).map_or([0.0; MOST], wide)) };
        let logs: Vec<f64> = filter.gains.iter().map(|gain| gain.variance.value().ln()).collect();
        let readings = schedule.readings.iter().zip(&filter.of);
        Self {
            states: N,
            compass: filter.compass,
            transitions: filter.transitions.iter().map(matrix).collect(),
            gains: filter.gains.iter().map(|gain| (wide(&gain.gain), gain.variance.value().sqrt().recip())).collect(),
            readings: readings.map(|(reading, &of)| (reading.step, reading.of, of)).collect(),
            log_variance: filter.of.iter().map(|&of| logs[of as usize]).sum(),
        }
    }

    /// Σ log S in units of the variance of the compass.
    pub fn log_variance(&self) -> f64 {
        self.log_variance
    }

    /// Standard deviation of the innovation of a reading in units of that of the compass.
    pub fn spread(&self, reading: usize) -> f64 {
        self.gains[self.readings[reading].2 as usize].1.recip()
    }

    /// Makes columns white in place.
    pub fn apply<const COLUMNS: usize>(&self, columns: [&mut Vec<f64>; COLUMNS]) {
        with_states!(self.states, N => self.run::<N, COLUMNS>(columns));
    }

    fn run<const N: usize, const COLUMNS: usize>(&self, columns: [&mut Vec<f64>; COLUMNS]) {
        let columns = columns.map(|column| &mut column[..self.readings.len()]);
        let mut x = [[0.0; COLUMNS]; N];
        for (row, &(step, of, gain)) in self.readings.iter().enumerate() {
            if let Some(step) = step {
                let f = &self.transitions[step];
                let mut next = [[0.0; COLUMNS]; N];
                for i in 0..N {
                    for j in 0..N {
                        for k in 0..COLUMNS {
                            next[i][k] += f[i][j] * x[j][k];
                        }
                    }
                }
                x = next;
            }
            let (gain, weight) = &self.gains[gain as usize];
            let mut innovation = [0.0; COLUMNS];
            for k in 0..COLUMNS {
                let seen = match (of, self.compass) {
                    (Of::Heading, Some(compass)) => x[0][k] + x[compass % N][k],
                    (Of::Heading, None) => x[0][k],
                    (Of::YawRate, _) => x[1][k],
                };
                innovation[k] = columns[k][row] - seen;
                columns[k][row] = innovation[k] * weight;
            }
            for i in 0..N {
                for k in 0..COLUMNS {
                    x[i][k] += gain[i] * innovation[k];
                }
            }
        }
    }
}

/// How innovations and their variances change with 1/T and the entries of a place.
#[derive(Debug, Clone)]
pub(crate) struct Slopes {
    /// ∂ν/∂θ over √S of every reading, by direction.
    pub innovation: [Vec<f64>; DIRECTIONS],
    /// ∂ log S/∂θ of every reading, by direction.
    pub log_variance: [Vec<f64>; DIRECTIONS],
}

/// A filter that knows its derivatives.
pub(crate) trait Differentiated {
    /// How the innovations of a residual change, in the directions that are `wanted`.
    fn slopes(&self, schedule: &Schedule, residual: &[f64], wanted: &[usize]) -> Slopes;
}

impl Slopes {
    /// ½ ∂ log det(JᵀJ)/∂θ in a direction, where this is what the filter makes of a column, not white yet, that becomes
    /// one of an orthonormal basis of the whitened columns J: its share of the sum.
    pub fn of_determinant(&self, unit: &[f64], direction: usize) -> f64 {
        let logs = &self.log_variance[direction];
        let turned: f64 = unit.iter().zip(&self.innovation[direction]).map(|(q, by)| q * by).sum();
        let shrunk: f64 = unit.iter().zip(logs).map(|(q, by)| q * q * by).sum();
        turned - 0.5 * shrunk
    }
}

/// The filter of a law from a known initial state, and the same with its derivatives.
pub(crate) fn differentiated(schedule: &Schedule, law: &Law<Tangent>) -> (Whitener, Box<dyn Differentiated>) {
    with_states!(law.states(), N => {
        let filter = Filter::<Tangent, N>::new(schedule, law, [0.0; 2]);
        (Whitener::of(schedule, &filter), Box::new(filter))
    })
}

impl<const N: usize> Differentiated for Filter<Tangent, N> {
    fn slopes(&self, schedule: &Schedule, residual: &[f64], wanted: &[usize]) -> Slopes {
        let mut slopes = Slopes { innovation: Default::default(), log_variance: Default::default() };
        for &direction in wanted {
            slopes.innovation[direction].reserve_exact(residual.len());
            slopes.log_variance[direction].reserve_exact(residual.len());
        }
        let mut x = [0.0; N];
        let mut by = [[0.0; DIRECTIONS]; N];
        for ((&Reading { step, of }, &place), &reading) in schedule.readings.iter().zip(&self.of).zip(residual) {
            if let Some(step) = step {
                let f = &self.transitions[step];
                let (mut next, mut next_by) = ([0.0; N], [[0.0; DIRECTIONS]; N]);
                for i in 0..N {
                    for j in 0..N {
                        next[i] += f[i][j].value * x[j];
                        for d in 0..DIRECTIONS {
                            next_by[i][d] += f[i][j].value * by[j][d] + f[i][j].by[d] * x[j];
                        }
                    }
                }
                (x, by) = (next, next_by);
            }
            let Gain { gain, variance } = &self.gains[place as usize];
            let innovation = reading - self.read(&x, of);
            let innovation_by: [f64; DIRECTIONS] = std::array::from_fn(|d| -self.read(&by.map(|row| row[d]), of));
            for i in 0..N {
                x[i] += gain[i].value * innovation;
                for d in 0..DIRECTIONS {
                    by[i][d] += gain[i].value * innovation_by[d] + gain[i].by[d] * innovation;
                }
            }
            let weight = variance.value.sqrt().recip();
            for &direction in wanted {
                slopes.innovation[direction].push(innovation_by[direction] * weight);
                slopes.log_variance[direction].push(variance.by[direction] / variance.value);
            }
        }
        slopes
    }
}
