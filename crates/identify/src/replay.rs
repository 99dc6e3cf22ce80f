//! The recorded rudder replayed through a given first-order response: how far is the heading from the record?
//!
//! Only the initial state is fitted (linear least squares, exact): K, T and δ_r stay as they are, so the error judges
//! them and not the luck of a start. Works for any sign of T.

use lanes::column::{dot, sum};
use ship::FirstOrder;
use ship::angle::to_deg;
use ship::first_order::State;
use trial::Trial;

use crate::track::{Coefficients, Columns, Track};

/// Condition number above which no initial yaw rate is fitted: it is taken to be zero.
const CONDITION_LIMIT: f64 = 1e9;

/// A replay of a record.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// Time of every row between the first and last observed heading, s.
    pub time: Vec<f64>,
    /// Heading of these rows, rad.
    pub heading: Vec<f64>,
    /// Yaw rate of these rows, rad/s.
    pub yaw_rate: Vec<f64>,
    /// Measured less replayed heading at the observed rows, rad.
    pub residual: Vec<f64>,
    /// Times of the observed rows, s.
    pub residual_time: Vec<f64>,
    /// Root mean square of the residual, deg.
    pub heading_rmse_deg: f64,
}

/// Replays the rudder of `trial` through `response` with the best initial state.
///
/// `None` when the replay is not finite, as for a response with infinite or undefined parameters.
pub fn replay(trial: &Trial, response: &FirstOrder) -> Option<Replay> {
    let a = response.inverse_T;
    let track = Track::unchecked(trial);
    let mut columns = Columns::default();
    track.fill(a, &mut columns);
    let mut coefficients = Coefficients::of(response);
    let forced = columns.rudder.iter().zip(&columns.constant);
    let rest: Vec<f64> = track
        .heading
        .iter()
        .zip(forced)
        .map(|(psi, (g, h))| psi - coefficients.gain * g - coefficients.offset * h)
        .collect();
    if rest.iter().any(|value| !value.is_finite()) {
        return None;
    }
    coefficients.anchor = best_start(&rest, &columns.homogeneous);
    let states = track.simulate(a, &coefficients);
    let residual: Vec<f64> =
        track.observed().iter().zip(&track.heading).map(|(&row, &measured)| measured - states[row].heading).collect();
    let mean_square = residual.iter().map(|e| e * e).sum::<f64>() / residual.len() as f64;
    let residual_time = track.observed().iter().map(|&row| track.time()[row]).collect();
    mean_square.is_finite().then(|| Replay {
        time: track.time().to_vec(),
        heading: states.iter().map(|state| state.heading).collect(),
        yaw_rate: states.iter().map(|state| state.yaw_rate).collect(),
        residual,
        residual_time,
        heading_rmse_deg: to_deg(mean_square.sqrt()),
    })
}

/// Heading and yaw rate at the anchor whose own motion, 1 and φ₁, comes nearest to `rest`.
fn best_start(rest: &[f64], homogeneous: &[f64]) -> State {
    let rows = rest.len() as f64;
    let (level, mean) = (sum(rest) / rows, sum(homogeneous) / rows);
    let square = dot(homogeneous, homogeneous);
    let centred: Vec<f64> = homogeneous.iter().map(|x| x - mean).collect();
    let spread = dot(&centred, &centred);
    // With the angle θ between 1 and φ₁ the condition number of the two is 2/θ, and θ² = spread / square.
    let told_apart = spread.is_finite() && spread * CONDITION_LIMIT.powi(2) > 4.0 * square;
    if !told_apart {
        // The transient of the initial yaw rate dies within a sample: only the heading can be fitted.
        return State { heading: level, yaw_rate: 0.0 };
    }
    let yaw_rate = dot(&centred, rest) / spread;
    State { heading: level - yaw_rate * mean, yaw_rate }
}
