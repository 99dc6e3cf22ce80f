//! Two Norrbin responses with a cubic term: the recreational craft Zeefakkel and a frigate of 100 m.
//!
//! In the source n₃ belongs to yaw rates in deg/s. At 5 m/s and 30° of rudder that gives the Zeefakkel 3.1 deg/s; read
//! in radians the term would be negligible against r and the craft would turn at 15 deg/s. Here n₃ = 0.4 (180/π)²
//! s²/rad².
//!
//! Copies of the set give the length of the Zeefakkel as 45 m and as 13.7 m (45 ft), so the ship has no particulars
//! here. The source also gives the frigate a lag of 1 s of the steering gear, which is not part of the ship.

use super::{Ship, ShipModel};
use crate::effects::listed_effect;
use crate::particulars::Particulars;
use crate::response::ResponseModel;

/// Zeefakkel at 5 m/s: T r' + r + n₃ r³ = K δ with K = 0.5 1/s, T = 31 s; rudder to 30° at 10 deg/s.
///
/// Source: van Amerongen (1982), Adaptive Steering of Ships, thesis Delft, as tabulated in the Marine Systems Simulator
/// (Fossen 2020).
pub fn zeefakkel() -> Ship {
    norrbin(["zeefakkel", "recreational craft Zeefakkel, 5 m/s"], None, [0.5, 31.0, 0.4])
}

/// Frigate at 9 m/s: T r' + r + n₃ r³ = K δ with K = 0.18 1/s, T = 27 s; rudder to 30° at 10 deg/s.
///
/// Source: as for [`zeefakkel`].
pub fn frigate() -> Ship {
    let particulars = Particulars { length: 100.0, speed: 9.0 };
    norrbin(["frigate", "frigate, 100 m, 9 m/s"], Some(particulars), [0.18, 27.0, 0.6])
}

/// Norrbin response from K (1/s), T (s) and n₃ for yaw rates in deg/s.
fn norrbin([id, name]: [&'static str; 2], particulars: Option<Particulars>, [K, T, n3]: [f64; 3]) -> Ship {
    let parameters = vec![1.0 / T, K / T, 0.0, n3 * 1f64.to_degrees().powi(2) / T];
    Ship {
        id: id.into(),
        name: name.into(),
        source: "van Amerongen (1982), in the Marine Systems Simulator".into(),
        particulars,
        rudder_rate: Some(10f64.to_radians()),
        largest_rudder: Some(30f64.to_radians()),
        model: ShipModel::Response(
            ResponseModel::new(vec![listed_effect("nonlinear_damping", "r³")]).with_parameters(parameters),
        ),
    }
}
