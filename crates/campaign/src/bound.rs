//! Cramér–Rao bound of a simulated trial under its true noise (Cramér 1946, Rao 1945).

mod coloured;

use identify::maximum_likelihood;
use nalgebra::{Matrix2x3, Matrix3};
use ship::FirstOrder;
use ship::first_order::YawState;
use simulate::disturbance::GaussMarkov;
use simulate::recording::RudderSource;
use simulate::{SimulatedTrial, Simulation};
use trial::noise_model::{MomentKind, NoiseModel};

use coloured::CompassError;

/// Cramér–Rao bound of one trial: minimum scatter of unbiased estimates of K and T.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CramerRaoBound {
    /// Standard deviations of K (1/s), T (s) and K/T (1/s²).
    pub sd: [f64; 3],
    /// Covariance of the relative errors of K and T, %².
    pub relative_covariance_percent2: [[f64; 2]; 2],
}

/// Cramér–Rao bound of all records of one trial together.
///
/// The noise law includes compass, recorded rudder, a rate gyro without bias and scale error, and one random moment: a
/// random walk or gusts. Wind, waves and drift are model errors and excluded; spikes, which only remove information,
/// are ignored. `None` without heading noise, for two random moments at once, for a compass with white and coloured
/// error combined with another noise, and for a record that does not determine the ship.
///
/// The information of the records adds up; each record has a separate initial state.
pub fn cramer_rao_bound<'a>(
    simulations: impl Iterator<Item = &'a Simulation>,
    simulated: &[SimulatedTrial],
    truth: &FirstOrder,
) -> Option<CramerRaoBound> {
    let mut records = simulations.zip(simulated).map(|(simulation, record)| of_record(simulation, record, truth));
    let first = records.next()??;
    let covariance = records.try_fold(first, |so_far, next| {
        let information = so_far.cholesky()?.inverse() + next?.cholesky()?.inverse();
        Some(information.cholesky()?.inverse())
    })?;
    let (a, b) = (truth.inverse_T, truth.K_over_T);
    // Gradients of ln K = ln b − ln a and ln T = −ln a.
    let gradient = Matrix2x3::new(-1.0 / a, 1.0 / b, 0.0, -1.0 / a, 0.0, 0.0);
    let relative = gradient * covariance * gradient.transpose();
    let sd = [
        relative[(0, 0)].sqrt() * truth.K().abs(),
        relative[(1, 1)].sqrt() * truth.T().abs(),
        covariance[(1, 1)].sqrt(),
    ];
    let relative_covariance_percent2 = [0, 1].map(|i| [0, 1].map(|j| 1e4 * relative[(i, j)]));
    sd.iter().all(|sd| sd.is_finite()).then_some(CramerRaoBound { sd, relative_covariance_percent2 })
}

/// Cramér–Rao bound on the covariance of 1/T (1/s), K/T (1/s²) and K δ_r/T (rad/s²) for one record with unknown
/// initial state; `None` as in [`cramer_rao_bound`].
fn of_record(simulation: &Simulation, simulated: &SimulatedTrial, truth: &FirstOrder) -> Option<Matrix3<f64>> {
    let white = simulation.sensors.declared_noise().heading_sd;
    let wander = simulation.sensors.heading_wander.filter(|wander| wander.sd > 0.0);
    let compass = match (white, wander) {
        (white, None) => NoiseModel::compass(white?),
        (_, Some(GaussMarkov { sd, correlation_time })) => {
            NoiseModel { heading_correlation_time: Some(correlation_time), ..NoiseModel::compass(sd) }
        }
    };
    let noise = noise(simulation, truth, compass)?;
    let initial = YawState { heading: *simulated.truth.heading.first()?, yaw_rate: *simulated.truth.yaw_rate.first()? };
    let trial = &simulated.trial;
    Some(match (white, wander) {
        (Some(white), Some(coloured)) if noise == compass => {
            coloured::cramer_rao(trial, truth, initial, &CompassError { white, coloured })?
        }
        (Some(_), Some(_)) => return None,
        _ => maximum_likelihood::cramer_rao(trial, truth, initial, &noise)?.matrix,
    })
}

/// Noise law of a simulation for the first-order likelihood: the `compass` errors and all other noise; `None` for a
/// random walk and gusts at once.
fn noise(simulation: &Simulation, truth: &FirstOrder, compass: NoiseModel) -> Option<NoiseModel> {
    let Simulation { sensors, disturbances, recording, .. } = simulation;
    let is_right = [sensors.yaw_rate_bias, sensors.yaw_rate_scale_error].iter().all(|size| size.unwrap_or(0.0) == 0.0);
    let read = recording.rudder == RudderSource::Feedback;
    // The simulation states a moment as the rudder angle of equal moment, the likelihood as a yaw acceleration.
    let b = truth.K_over_T;
    let (moment, moment_level, moment_correlation_time) = match (disturbances.moment_random_walk, disturbances.gusts) {
        (0.0, None) => (MomentKind::None, 0.0, f64::INFINITY),
        (walk, None) => (MomentKind::Walk, b * walk, f64::INFINITY),
        (0.0, Some(gusts)) => (MomentKind::OrnsteinUhlenbeck, b * gusts.sd, gusts.correlation_time),
        (_, Some(_)) => return None,
    };
    Some(NoiseModel {
        yaw_rate_sd: sensors.yaw_rate_noise.filter(|noise| is_right && *noise > 0.0),
        moment,
        moment_level,
        moment_correlation_time,
        rudder_sd: if read { sensors.rudder_noise } else { 0.0 },
        ..compass
    })
}
