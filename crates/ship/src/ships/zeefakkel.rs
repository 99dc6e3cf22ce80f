//! Recreational craft Zeefakkel, a Norrbin response with a cubic term.
//!
//! Trap: in the source n₃ = 0.4 belongs to yaw rates in deg/s. At 5 m/s and 30° of rudder that gives 3.1 deg/s; read in
//! radians the term would vanish beside r and the craft would turn at 15 deg/s. Here n₃ = 0.4 (180/π)² s²/rad².
//!
//! Copies of the set give the length as 45 m and as 13.7 m (45 ft), so the craft has no particulars here.

use super::{Model, Ship};
use crate::effects::listed;
use crate::response::ResponseModel;

/// n₃ of a source that counts yaw rate in deg/s, in s²/rad².
pub(super) fn n3_from_degrees(n3: f64) -> f64 {
    n3 * 1f64.to_degrees().powi(2)
}

/// Zeefakkel at 5 m/s: T r' + r + n₃ r³ = K δ with K = 0.5 1/s, T = 31 s; rudder to 30° at 10 deg/s.
///
/// Source: van Amerongen (1982), Adaptive Steering of Ships, thesis Delft, as tabulated in the Marine Systems Simulator
/// (Fossen 2020).
pub fn ship() -> Ship {
    let (gain, time, n3) = (0.5, 31.0, n3_from_degrees(0.4));
    Ship {
        id: "zeefakkel".into(),
        name: "recreational craft Zeefakkel, 5 m/s".into(),
        source: "van Amerongen (1982), in the Marine Systems Simulator".into(),
        particulars: None,
        rudder_rate: Some(10f64.to_radians()),
        largest_rudder: Some(30f64.to_radians()),
        model: Model::Response(ResponseModel::new(vec![listed("nonlinear_damping", "r³")]).with(vec![
            1.0 / time,
            gain / time,
            0.0,
            n3 / time,
        ])),
    }
}
