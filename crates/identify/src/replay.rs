//! Replay of the recorded rudder through a given first-order response, and the heading residual.
//!
//! Only the initial state is fitted (linear least squares, exact): K, T and δ_r stay fixed, so the residual measures
//! their error and not the error of the initial state. Valid for either sign of T. The comparison of a simulated with a
//! measured output is model validation as in Ljung (1999), chapter 16.

use estimation::column::{dot, sum};
use ship::FirstOrder;
use ship::first_order::YawState;
use trial::Trial;

use crate::likelihood::track::{MotionCoefficients, MotionColumns, TrialSignals};

/// Maximum condition number for the fit of an initial yaw rate; above it the yaw rate is zero.
const MAX_CONDITION: f64 = 1e9;

/// Replay of a record.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// Time of every row between the first and last observed heading, s.
    pub time: Vec<f64>,
    /// Replayed heading in these rows, rad.
    pub heading: Vec<f64>,
    /// Replayed yaw rate in these rows, rad/s.
    pub yaw_rate: Vec<f64>,
    /// Measured minus replayed heading in these rows, rad; NaN where none was measured.
    pub residual: Vec<f64>,
}

impl Replay {
    /// Heading (rad) and yaw rate (rad/s) at the first row.
    pub fn initial_state(&self) -> [f64; 2] {
        [self.heading[0], self.yaw_rate[0]]
    }

    /// Time (s) and residual (rad) of every row whose heading was measured.
    pub fn observed_residuals(&self) -> impl Iterator<Item = (f64, f64)> {
        self.time.iter().copied().zip(self.residual.iter().copied()).filter(|(_, residual)| residual.is_finite())
    }

    /// Root mean square of the residual, rad; NaN if no heading was measured.
    pub fn rms(&self) -> f64 {
        pooled_rms(std::slice::from_ref(self))
    }
}

/// Replays the rudder of `trial` through `response` with the best initial state.
///
/// `None` if the replay is not finite, as for a response with infinite or undefined parameters.
pub fn replay(trial: &Trial, response: &FirstOrder) -> Option<Replay> {
    let a = response.inverse_T;
    let signals = TrialSignals::new(trial);
    let mut columns = MotionColumns::default();
    signals.fill_columns(a, &mut columns);
    let mut coefficients = MotionCoefficients::from_response(response);
    let forced = columns.rudder.iter().zip(&columns.constant);
    let free: Vec<f64> = signals
        .heading
        .iter()
        .zip(forced)
        .map(|(psi, (g, h))| psi - coefficients.K_over_T * g - coefficients.offset * h)
        .collect();
    if free.iter().any(|value| !value.is_finite()) {
        return None;
    }
    coefficients.anchor = best_initial_state(&free, &columns.homogeneous);
    let states = signals.simulate(a, &coefficients);
    let mut residual = vec![f64::NAN; states.len()];
    for (&row, &measured) in signals.heading_rows.iter().zip(&signals.heading) {
        residual[row] = measured - states[row].heading;
        if !residual[row].is_finite() {
            return None;
        }
    }
    let replay = Replay {
        time: signals.time.clone(),
        heading: states.iter().map(|state| state.heading).collect(),
        yaw_rate: states.iter().map(|state| state.yaw_rate).collect(),
        residual,
    };
    // Finite residuals may have squares that are not.
    replay.rms().is_finite().then_some(replay)
}

/// Root mean square heading residual of a response on several records, rad; `None` if a replay is not finite.
pub fn pooled_response_rms(trials: &[Trial], response: &FirstOrder) -> Option<f64> {
    let replays = trials.iter().map(|trial| replay(trial, response));
    Some(pooled_rms(&replays.collect::<Option<Vec<Replay>>>()?))
}

/// Root mean square heading residual of several replays over all rows, rad; NaN without any.
pub fn pooled_rms(replays: &[Replay]) -> f64 {
    let (mut square, mut rows) = (0.0, 0usize);
    for (_, residual) in replays.iter().flat_map(Replay::observed_residuals) {
        square += residual * residual;
        rows += 1;
    }
    (square / rows as f64).sqrt()
}

/// Heading (rad) and yaw rate (rad/s) at the anchor whose free motion, along 1 and φ₁, is nearest to `free`, the
/// heading minus the response to rudder and bias.
pub(crate) fn best_initial_state(free: &[f64], homogeneous: &[f64]) -> YawState {
    let rows = free.len() as f64;
    let (level, mean) = (sum(free) / rows, sum(homogeneous) / rows);
    let square = dot(homogeneous, homogeneous);
    let centred: Vec<f64> = homogeneous.iter().map(|x| x - mean).collect();
    let spread = dot(&centred, &centred);
    // With the angle θ between 1 and φ₁ the condition number of the two is 2/θ, and θ² = spread / square.
    let is_independent = spread.is_finite() && spread * MAX_CONDITION.powi(2) > 4.0 * square;
    if !is_independent {
        // The transient of the initial yaw rate decays within a sample: only the heading can be fitted.
        return YawState { heading: level, yaw_rate: 0.0 };
    }
    let yaw_rate = dot(&centred, free) / spread;
    YawState { heading: level - yaw_rate * mean, yaw_rate }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::record;

    #[test]
    fn a_replay_whose_error_overflows_is_none() {
        let time: Vec<f64> = (0..100).map(f64::from).collect();
        let heading = time.iter().map(|t| 0.1 * (0.1 * t).sin()).collect();
        let rudder = time.iter().map(|t| 0.2 * (0.1 * t).cos()).collect();
        let trial = record("one", time, heading, rudder);
        let replayed = |K_over_T| replay(&trial, &FirstOrder { inverse_T: 0.1, K_over_T, rudder_bias: 0.0 });
        assert!(replayed(0.01).is_some_and(|replay| replay.rms() > 0.0 && replay.observed_residuals().count() == 100));
        assert_eq!(replayed(1e170), None);
    }
}
