//! The Kalman filter as a map that makes columns white, and how it changes with the law of the noise.
//!
//! With readings of one kind at even times the gain settles; from there on no covariance is computed.

use crate::law::{Law, Place};
use crate::number::{Dual, Variable};
use crate::schedule::{Of, Reading, Schedule};
use crate::transition::Step;

/// Most states: heading, rate, moment, rudder error, compass error.
const MOST: usize = 5;

/// Instruments, and so the longest pattern of readings that repeats itself.
const INSTRUMENTS: usize = 2;

/// A gain that changes by less than this share, and its derivatives by less than the other, has settled.
const SETTLED: f64 = 1e-10;
const SETTLED_SLOPE: f64 = 1e-7;

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
    /// One over √S of every gain.
    weights: Vec<f64>,
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
        if law.moment == crate::noise::Moment::OrnsteinUhlenbeck {
            covariance[2][2] = law.level * law.level;
        }
        for place in [law.rudder_state(), compass].into_iter().flatten() {
            covariance[place][place] = R::from(1.0);
        }
        let steps: Vec<Step<R, N>> = schedule.spans.iter().map(|span| Step::new(law, span)).collect();
        let mut filter = Self {
            transitions: steps.iter().map(|step| step.transition).collect(),
            gains: Vec::new(),
            weights: Vec::new(),
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
        filter.weights = filter.gains.iter().map(|gain| gain.variance.value().sqrt().recip()).collect();
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

    /// What states side by side make of a reading.
    #[inline(always)]
    fn read<const COLUMNS: usize>(&self, state: &[[f64; COLUMNS]; N], of: Of) -> [f64; COLUMNS] {
        match (of, self.compass) {
            (Of::Heading, Some(compass)) => std::array::from_fn(|k| state[0][k] + state[compass][k]),
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
pub struct Whitener {
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
            gains: filter.gains.iter().zip(&filter.weights).map(|(gain, &weight)| (wide(&gain.gain), weight)).collect(),
            readings: readings.map(|(reading, &of)| (reading.step, reading.of, of)).collect(),
            log_variance: filter.of.iter().map(|&of| logs[of as usize]).sum(),
        }
    }

    /// Σ log S in units of the variance of the compass.
    pub fn log_variance(&self) -> f64 {
        self.log_variance
    }

    /// One over the standard deviation of the innovation of a reading, in units of that of the compass.
    #[cfg(test)]
    pub fn weight(&self, reading: usize) -> f64 {
        self.gains[self.readings[reading].2 as usize].1
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

/// How innovations and their variances change with 1/T and the entries of a place, by lane.
#[derive(Debug, Clone)]
pub struct Slopes {
    /// ∂ν/∂θ over √S of every reading.
    pub innovation: Vec<Vec<f64>>,
    /// ∂ log S/∂θ of every reading.
    pub log_variance: Vec<Vec<f64>>,
}

/// Columns whose slopes are computed side by side.
pub const SIDE_BY_SIDE: usize = 6;

/// A filter that knows its derivatives.
pub trait Differentiated {
    /// How the innovations of a residual change, in the first `lanes`.
    fn slopes(&self, schedule: &Schedule, residual: &[f64], lanes: usize) -> Slopes;

    /// Σ over columns of q·∂ν/∂θ/√S, by lane, where ∂ν/∂θ is what the filter makes of a column that is not white yet
    /// and q one that is. A column that is not there is empty.
    fn turned(&self, schedule: &Schedule, raw: [&[f64]; SIDE_BY_SIDE], white: [&[f64]; SIDE_BY_SIDE]) -> Vec<f64>;
}

/// The filter of a place from a known initial state, and the same with its derivatives.
pub fn differentiated(schedule: &Schedule, place: &Place, inverse_time: f64, gyro: bool) -> Box<dyn Differentiated> {
    match place.entries(gyro).count() {
        0 | 1 => of_lanes::<2>(schedule, &place.law(inverse_time, gyro)),
        2 => of_lanes::<3>(schedule, &place.law(inverse_time, gyro)),
        3 => of_lanes::<4>(schedule, &place.law(inverse_time, gyro)),
        _ => of_lanes::<6>(schedule, &place.law(inverse_time, gyro)),
    }
}

fn of_lanes<const LANES: usize>(schedule: &Schedule, law: &Law<Dual<LANES>>) -> Box<dyn Differentiated> {
    with_states!(law.states(), N => Box::new(Filter::<Dual<LANES>, N>::new(schedule, law, [0.0; 2])))
}

impl<const LANES: usize, const N: usize> Differentiated for Filter<Dual<LANES>, N> {
    fn slopes(&self, schedule: &Schedule, residual: &[f64], lanes: usize) -> Slopes {
        let empty = || vec![Vec::with_capacity(residual.len()); lanes];
        let mut slopes = Slopes { innovation: empty(), log_variance: empty() };
        self.run(
            schedule,
            |row| [residual[row]],
            |_, place, by: [[f64; 1]; LANES]| {
                let variance = &self.gains[place].variance;
                let weight = self.weights[place];
                let columns = slopes.innovation.iter_mut().zip(&mut slopes.log_variance);
                for ((innovation, log_variance), (by, of_variance)) in columns.zip(by.iter().zip(variance.by)) {
                    innovation.push(by[0] * weight);
                    log_variance.push(of_variance / variance.value);
                }
            },
        );
        slopes
    }

    fn turned(&self, schedule: &Schedule, raw: [&[f64]; SIDE_BY_SIDE], white: [&[f64]; SIDE_BY_SIDE]) -> Vec<f64> {
        let mut sums = [[0.0; SIDE_BY_SIDE]; LANES];
        let at = |columns: &[&[f64]; SIDE_BY_SIDE], row: usize| -> [f64; SIDE_BY_SIDE] {
            std::array::from_fn(|k| columns[k].get(row).copied().unwrap_or(0.0))
        };
        self.run(
            schedule,
            |row| at(&raw, row),
            |row, place, by: [[f64; SIDE_BY_SIDE]; LANES]| {
                let q = at(&white, row);
                let weight = self.weights[place];
                for (sums, by) in sums.iter_mut().zip(&by) {
                    for k in 0..SIDE_BY_SIDE {
                        sums[k] += q[k] * by[k] * weight;
                    }
                }
            },
        );
        sums.iter().map(|sums| sums.iter().sum()).collect()
    }
}

impl<const LANES: usize, const N: usize> Filter<Dual<LANES>, N> {
    /// Runs columns through the filter and visits every reading with the number of its gain and the derivatives of the
    /// innovations.
    #[inline(always)]
    fn run<const COLUMNS: usize>(
        &self,
        schedule: &Schedule,
        column: impl Fn(usize) -> [f64; COLUMNS],
        mut visit: impl FnMut(usize, usize, [[f64; COLUMNS]; LANES]),
    ) {
        let mut x = [[0.0; COLUMNS]; N];
        let mut by = [[[0.0; COLUMNS]; N]; LANES];
        for (row, (&Reading { step, of }, &place)) in schedule.readings.iter().zip(&self.of).enumerate() {
            if let Some(step) = step {
                let f = &self.transitions[step];
                let mut next = [[0.0; COLUMNS]; N];
                let mut next_by = [[[0.0; COLUMNS]; N]; LANES];
                for i in 0..N {
                    for (j, f) in f[i].iter().enumerate() {
                        for k in 0..COLUMNS {
                            next[i][k] += f.value * x[j][k];
                        }
                        for (lane, (next_by, by)) in next_by.iter_mut().zip(&by).enumerate() {
                            for k in 0..COLUMNS {
                                next_by[i][k] += f.value * by[j][k] + f.by[lane] * x[j][k];
                            }
                        }
                    }
                }
                (x, by) = (next, next_by);
            }
            let place = place as usize;
            let gain = &self.gains[place].gain;
            let seen = self.read(&x, of);
            let reading = column(row);
            let innovation: [f64; COLUMNS] = std::array::from_fn(|k| reading[k] - seen[k]);
            let mut innovation_by = [[0.0; COLUMNS]; LANES];
            for (innovation_by, by) in innovation_by.iter_mut().zip(&by) {
                *innovation_by = self.read(by, of).map(|seen| -seen);
            }
            for (x, gain) in x.iter_mut().zip(gain) {
                for k in 0..COLUMNS {
                    x[k] += gain.value * innovation[k];
                }
            }
            for (lane, (by, innovation_by)) in by.iter_mut().zip(&innovation_by).enumerate() {
                for (by, gain) in by.iter_mut().zip(gain) {
                    for k in 0..COLUMNS {
                        by[k] += gain.value * innovation_by[k] + gain.by[lane] * innovation[k];
                    }
                }
            }
            visit(row, place, innovation_by);
        }
    }
}
