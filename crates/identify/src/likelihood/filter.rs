//! The Kalman filter of a noise on a schedule, and how it changes with the parameters of the noise.

use estimation::kalman::{Filter, Reading, Sensor, Step, System, Whitener};
use estimation::lanes::Kernel;
use estimation::number::{Dual, Real};
use estimation::with_states;
use trial::noise_model::Moment;

use super::parameters::{NoiseParameters, NoiseVector};
use super::schedule::{ReadingKind, Schedule};
use super::transition::step;

/// The system of some noise on a schedule, with variances of the initial heading and yaw rate in units of that of the
/// compass.
fn system<R: Real, const N: usize>(
    schedule: &Schedule,
    parameters: &NoiseParameters<R>,
    initial: [f64; 2],
) -> System<R, N> {
    let compass = parameters.compass_state();
    let mut covariance = [[R::from(0.0); N]; N];
    for (place, variance) in initial.into_iter().enumerate() {
        covariance[place][place] = R::from(variance);
    }
    if parameters.moment == Moment::OrnsteinUhlenbeck {
        covariance[2][2] = parameters.level * parameters.level;
    }
    for place in [parameters.rudder_state(), compass].into_iter().flatten() {
        covariance[place][place] = R::from(1.0);
    }
    // A compass error that lasts is a state of its own.
    let white = if compass.is_some() { 0.0 } else { 1.0 };
    let sensors = vec![
        Sensor { state: 0, beside: compass, variance: R::from(white) },
        Sensor { state: 1, beside: None, variance: parameters.gyro * parameters.gyro },
    ];
    let steps: Vec<Step<R, N>> = schedule.spans.iter().map(|span| step(parameters, span)).collect();
    let reading = |reading: &super::schedule::ScheduledReading| Reading {
        step: reading.step,
        sensor: match reading.of {
            ReadingKind::Heading => 0,
            ReadingKind::YawRate => 1,
        },
    };
    System { steps, sensors, readings: schedule.readings.iter().map(reading).collect(), initial: covariance }
}

/// The filter that makes columns of one record white, in units of the compass error, with variances of the initial
/// heading and yaw rate in units of that of the compass.
pub fn whitener(schedule: &Schedule, parameters: &NoiseParameters<f64>, initial: [f64; 2]) -> Whitener {
    with_states!(parameters.states(), N => with_ship::<N>(schedule, parameters, initial))
}

fn with_ship<const N: usize>(schedule: &Schedule, parameters: &NoiseParameters<f64>, initial: [f64; 2]) -> Whitener {
    Filter::<f64, N>::new(system(schedule, parameters, initial)).whitener()
}

/// How innovations and their variances change with 1/T and the entries of a noise vector, by lane.
#[derive(Debug, Clone)]
pub struct Slopes {
    /// ∂ν/∂θ over √S of every reading.
    pub innovation: Vec<Vec<f64>>,
    /// ∂ log S/∂θ of every reading.
    pub log_variance: Vec<Vec<f64>>,
}

/// Columns whose slopes are computed side by side.
pub const SIDE_BY_SIDE: usize = 8;

/// A filter that knows its derivatives.
pub trait Differentiated {
    /// How the innovations of a residual change, in the first `lanes`.
    fn slopes(&self, residual: &[f64], lanes: usize) -> Slopes;

    /// Σ over columns of q·∂ν/∂θ/√S, by lane, where ∂ν/∂θ is what the filter makes of a column that is not white yet
    /// and q one that is. A column that is not there is empty.
    fn sensitivity_products(&self, raw: [&[f64]; SIDE_BY_SIDE], white: [&[f64]; SIDE_BY_SIDE]) -> Vec<f64>;
}

/// The filter of a noise vector from a known initial state, with its derivatives.
pub fn differentiated(
    schedule: &Schedule,
    noise: &NoiseVector,
    inverse_time: f64,
    gyro: bool,
) -> Box<dyn Differentiated> {
    match noise.entries(gyro).count() {
        0 | 1 => of_lanes::<2>(schedule, &noise.parameters(inverse_time, gyro)),
        2 => of_lanes::<3>(schedule, &noise.parameters(inverse_time, gyro)),
        3 => of_lanes::<4>(schedule, &noise.parameters(inverse_time, gyro)),
        _ => of_lanes::<6>(schedule, &noise.parameters(inverse_time, gyro)),
    }
}

fn of_lanes<const LANES: usize>(
    schedule: &Schedule,
    parameters: &NoiseParameters<Dual<LANES>>,
) -> Box<dyn Differentiated> {
    with_states!(parameters.states(), N => {
        Box::new(Filter::<Dual<LANES>, N>::new(system(schedule, parameters, [0.0; 2])))
    })
}

impl<const LANES: usize, const N: usize> Differentiated for Filter<Dual<LANES>, N> {
    fn slopes(&self, residual: &[f64], lanes: usize) -> Slopes {
        let empty = || vec![Vec::with_capacity(residual.len()); lanes];
        let mut slopes = Slopes { innovation: empty(), log_variance: empty() };
        self.run(
            |row| [residual[row]],
            |_, gain, by: [[f64; 1]; LANES]| {
                let (weight, variance) = self.variance(gain);
                let columns = slopes.innovation.iter_mut().zip(&mut slopes.log_variance);
                for ((innovation, log_variance), (by, of_variance)) in columns.zip(by.iter().zip(variance.by)) {
                    innovation.push(by[0] * weight);
                    log_variance.push(of_variance / variance.value);
                }
            },
        );
        slopes
    }

    fn sensitivity_products(&self, raw: [&[f64]; SIDE_BY_SIDE], white: [&[f64]; SIDE_BY_SIDE]) -> Vec<f64> {
        let sums = estimation::lanes::run(Products { filter: self, raw, white });
        sums.iter().map(|sums| sums.iter().sum()).collect()
    }
}

/// Σ q·∂ν/∂θ/√S of every column, by lane.
struct Products<'a, const LANES: usize, const N: usize> {
    filter: &'a Filter<Dual<LANES>, N>,
    raw: [&'a [f64]; SIDE_BY_SIDE],
    white: [&'a [f64]; SIDE_BY_SIDE],
}

impl<const LANES: usize, const N: usize> Kernel for Products<'_, LANES, N> {
    type Output = [[f64; SIDE_BY_SIDE]; LANES];

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Self { filter, raw, white } = self;
        let mut sums = [[0.0; SIDE_BY_SIDE]; LANES];
        let at = |columns: &[&[f64]; SIDE_BY_SIDE], row: usize| -> [f64; SIDE_BY_SIDE] {
            std::array::from_fn(|k| columns[k].get(row).copied().unwrap_or(0.0))
        };
        filter.run(
            |row| at(&raw, row),
            |row, gain, by: [[f64; SIDE_BY_SIDE]; LANES]| {
                let q = at(&white, row);
                let (weight, _) = filter.variance(gain);
                for (sums, by) in sums.iter_mut().zip(&by) {
                    for k in 0..SIDE_BY_SIDE {
                        sums[k] += q[k] * by[k] * weight;
                    }
                }
            },
        );
        sums
    }
}
