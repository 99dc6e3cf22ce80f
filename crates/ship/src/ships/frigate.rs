//! A frigate of 100 m, a Norrbin response with a cubic term.
//!
//! As for [`super::zeefakkel`], n₃ belongs to yaw rates in deg/s and is converted. The source gives a lag of 1 s in the
//! steering gear as well, which belongs to the gear and is not part of this ship.

use super::zeefakkel::n3_from_degrees;
use super::{Model, Ship};
use crate::effects::listed;
use crate::particulars::Particulars;
use crate::response::ResponseModel;

/// The frigate at 9 m/s: T r' + r + n₃ r³ = K δ with K = 0.18 1/s, T = 27 s; rudder to 30° at 10 deg/s.
///
/// Source: van Amerongen (1982), Adaptive Steering of Ships, thesis Delft, as tabulated in the Marine Systems Simulator
/// (Fossen 2020).
pub fn ship() -> Ship {
    let (gain, time, n3) = (0.18, 27.0, n3_from_degrees(0.6));
    Ship {
        id: "frigate".into(),
        name: "frigate, 100 m, 9 m/s".into(),
        source: "van Amerongen (1982), in the Marine Systems Simulator".into(),
        particulars: Some(Particulars { length: 100.0, speed: 9.0 }),
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
