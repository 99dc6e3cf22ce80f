//! A course-unstable oil tanker, known by its linear indices only; not among [`super::all`].
//!
//! With K and T1 negative the linear response grows without bound from any disturbance, and the source has no nonlinear
//! term to stop it. A simulation needs one, so [`with_loop`] asks for the yaw rate the ship keeps with the rudder
//! amidships; that number is the user's, not the source's.

use std::sync::Arc;

use super::user::{ShipError, second_order_response};
use super::{Model, Ship};
use crate::effects::NonlinearDamping;
use crate::linear::SecondOrderIndices;

/// K = −0.019 1/s, T1 = −124.1 s, T2 = 16.4 s, T3 = 46.0 s.
///
/// Source: example of the Nomoto models in the Marine Systems Simulator (Fossen); the ship's name is not given.
pub const INDICES: SecondOrderIndices = SecondOrderIndices { K: -0.019, T1: -124.1, T2: 16.4, T3: 46.0 };

/// The tanker with a cubic damping that lets it turn at ±`yaw_rate` (rad/s) with the rudder amidships.
///
/// The loop of the steady turning curve at δ = 0 obeys r/T1 + p r³ = 0, so p = −1/(T1 r²). Fails for a yaw rate that is
/// not positive.
pub fn with_loop(yaw_rate: f64) -> Result<Ship, ShipError> {
    if !(yaw_rate > 0.0 && yaw_rate.is_finite()) {
        let reason = "the yaw rate with the rudder amidships has to be positive";
        return Err(ShipError::Value { symbol: "r(0)", value: yaw_rate, reason });
    }
    let cubic = -1.0 / (INDICES.T1 * yaw_rate * yaw_rate);
    Ok(Ship {
        id: "oil-tanker".into(),
        name: "course-unstable oil tanker, nonlinear term assumed".into(),
        source: "Marine Systems Simulator (Fossen), linear part only".into(),
        particulars: None,
        rudder_rate: None,
        largest_rudder: None,
        model: Model::Response(second_order_response(INDICES, 0.0, vec![Arc::new(NonlinearDamping::Cubic)], &[cubic])),
    })
}
