//! Course-unstable tanker of 304.8 m in deep water: the equations of van Berlekom and Goddard (1972).
//!
//! The source uses the bis system (forces over mass, lengths over L), so accelerations are in m/s². The rudder works in
//! the propeller stream of speed c, c² = c_un u n + c_nn n². The thrust causes a small sway force and yaw moment (Y_T,
//! N_T). The rudder of the source is positive to port; its sign is changed here. The shallow-water terms are zero.

use std::sync::Arc;

use super::{Ship, ShipModel};
use crate::dynamics::ShipInput;
use crate::particulars::Particulars;
use crate::vessel::Hull;

/// Length and approach speed, at which the propeller turns at 80 rpm.
const PARTICULARS: Particulars = Particulars { length: 304.8, speed: 8.23 };

/// Coefficients 1 − X_u̇, 1 − Y_v̇ and k_z² − N_ṙ of the accelerations, dimensionless in the bis system.
const INERTIA: [f64; 3] = [1.050, 2.020, 0.1232];
/// Coefficients 1 + X_vr, Y_ur − 1 and N_ur − x_G of the yaw rate, dimensionless in the bis system.
const TURNING: [f64; 3] = [2.020, -0.752, -0.231];

/// Coefficients of thrust over mass uu u²/L + un u n + nn L n² (m/s²), dimensionless in the bis system.
const THRUST: [f64; 3] = [-0.00695, -0.00063, 0.000_035_4];
/// Thrust deduction t.
const DEDUCTION: f64 = 0.22;
/// Coefficients un (m) and nn (m²) of the squared speed of the propeller stream, c² = un u n + nn n².
const STREAM: [f64; 2] = [0.605, 38.2];

/// uu, vv, ccδδ and ccβδ of X.
const X: [f64; 4] = [-0.0377, 0.3, -0.093, 0.152];
/// uv, v|v|, ccδ and ccβ|β||δ| of Y.
const Y: [f64; 4] = [-1.205, -2.400, 0.208, -2.16];
/// uv, |v|r, ccδ and ccβ|β||δ| of N.
const N: [f64; 4] = [-0.451, -0.300, -0.098, 0.688];

/// Tanker hull at the propeller revolutions of its steady approach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TankerHull {
    /// Propeller revolutions n, 1/s.
    revolutions: f64,
    /// Y_T and N_T: the asymmetry of a single propeller.
    by_thrust: [f64; 2],
}

impl TankerHull {
    /// Tanker hull without the asymmetry of the thrust.
    pub fn without_thrust_asymmetry(self) -> Self {
        Self { by_thrust: [0.0; 2], ..self }
    }

    /// Thrust over mass, m/s², and squared speed of the propeller stream c², m²/s².
    fn thrust_and_stream(&self, u: f64) -> [f64; 2] {
        let (L, n) = (PARTICULARS.length, self.revolutions);
        let thrust = THRUST[0] * u * u / L + THRUST[1] * u * n + L * THRUST[2] * n * n;
        [thrust, (STREAM[0] * u * n + STREAM[1] * n * n).max(0.0)]
    }
}

impl Hull for TankerHull {
    fn particulars(&self) -> Particulars {
        PARTICULARS
    }

    /// Accelerations by the equations of the source; the disturbance adds the yaw moment N_ccδ c² δ at approach speed.
    fn acceleration(&self, [u, v, r]: [f64; 3], input: &ShipInput) -> [f64; 3] {
        let L = PARTICULARS.length;
        let [thrust, cc] = self.thrust_and_stream(u);
        let delta = -input.rudder;
        let beta = v.atan2(u);
        let stalled = cc * beta * beta.abs() * delta.abs();

        let [uu, vv, ccdd, ccbd] = X;
        let ahead = uu * u * u
            + L * TURNING[0] * v * r
            + vv * v * v
            + cc * delta * (ccdd * delta + ccbd * beta)
            + L * (1.0 - DEDUCTION) * thrust;
        let [uv, vav, ccd, ccbbd] = Y;
        let across = uv * u * v
            + vav * v * v.abs()
            + ccd * cc * delta
            + L * TURNING[1] * u * r
            + ccbbd * stalled
            + self.by_thrust[0] * L * thrust;
        let [uv, avr, ccd, ccbbd] = N;
        let disturbed = -self.thrust_and_stream(PARTICULARS.speed)[1] * input.disturbance_rudder;
        let moment = uv * u * v
            + L * avr * v.abs() * r
            + ccd * (cc * delta + disturbed)
            + L * TURNING[2] * u * r
            + ccbbd * stalled
            + self.by_thrust[1] * L * thrust;
        [ahead / (L * INERTIA[0]), across / (L * INERTIA[1]), moment / (L * L * INERTIA[2])]
    }
}

/// Equations of [`ship`]. Thrust balances the resistance: X_uu U²/L + (1 − t) T = 0.
pub fn hull_model() -> TankerHull {
    let Particulars { length: L, speed: U } = PARTICULARS;
    let [uu, un, nn] = THRUST;
    let constant = (uu + X[0] / (1.0 - DEDUCTION)) * U * U / L;
    let half = 0.5 * un * U / (L * nn);
    TankerHull { revolutions: (half * half - constant / (L * nn)).sqrt() - half, by_thrust: [0.04, -0.02] }
}

/// Tanker at 8.23 m/s; rudder rate 2.33 deg/s, as in the source of the table.
///
/// Source: van Berlekom and Goddard (1972), as tabulated in the Marine Systems Simulator (Lauvdal 1994, Fossen 2005).
pub fn ship() -> Ship {
    Ship {
        id: "tanker".into(),
        name: "tanker of 304.8 m, course-unstable, 16 kn".into(),
        source: "Van Berlekom and Goddard (1972), in the Marine Systems Simulator".into(),
        particulars: Some(PARTICULARS),
        rudder_rate: Some(2.33f64.to_radians()),
        largest_rudder: None,
        model: ShipModel::Hull(Arc::new(hull_model())),
    }
}
