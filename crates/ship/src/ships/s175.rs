//! Container ship S175 of 175 m as a hull with three degrees of freedom: the published equations without heel.
//!
//! The source has a fourth degree of freedom, roll. Roll angle and roll rate are zero here, and their terms are left
//! out; the real ship heels in a turn, so this hull approximates S175. Forces are prime, by ½ρL²U² with the
//! instantaneous speed U; the rudder is positive to starboard.
//!
//! Source: Son and Nomoto (1982), as tabulated in the Marine Systems Simulator (Lauvdal 1994, Fossen 2022).

use std::f64::consts::PI;
use std::sync::Arc;

use super::{Ship, ShipModel};
use crate::dynamics::ShipInput;
use crate::particulars::Particulars;
use crate::vessel::{Hull, MIN_SPEED_SHARE};

/// Length and speed; the speed is taken from the linear equations in the Marine Systems Simulator.
const PARTICULARS: Particulars = Particulars { length: 175.0, speed: 7.0 };

/// Mass m'.
const M: f64 = 0.00792;

/// Added mass in surge m_x'.
const MX: f64 = 0.000_238;

/// Added mass in sway m_y'.
const MY: f64 = 0.007_049;

/// Moment of inertia and added moment of inertia, I_z' + J_z'.
const INERTIA: f64 = 0.000_456 + 0.000_419;

/// Coupling of sway and yaw, m_y' α_y', by the centre α_y' = 0.05 of m_y'.
const COUPLING: f64 = MY * 0.05;

/// X'uu, X'vr, X'rr and X'vv.
const X: [f64; 4] = [-0.000_422_6, -0.00311, 0.00020, -0.00386];
/// Coefficients v, r, vvv, rrr, vvr and vrr of Y'.
const Y: [f64; 6] = [-0.0116, 0.00242, -0.109, 0.00177, 0.0214, -0.0405];
/// Coefficients v, r, vvv, rrr, vvr and vrr of N'.
const N: [f64; 6] = [-0.003_854_5, -0.00222, 0.001_492, -0.00229, -0.0424, 0.00156];

/// Diameter of the propeller, m.
const DIAMETER: f64 = 6.533;
/// Wake fraction w of the propeller on a straight course.
const WAKE: f64 = 0.184;
/// Decrease of the wake fraction with the square of v' + x_P' r', the inflow across the propeller.
const TAU: f64 = 1.09;
/// Position x_P' of the propeller.
const XP: f64 = -0.526;
/// Thrust deduction t.
const DEDUCTION: f64 = 0.175;
/// Coefficients k0 and k1 of K_T = k0 + k1 J.
const THRUST: [f64; 2] = [0.527, -0.455];

/// Rudder area, m².
const AREA: f64 = 33.0376;
/// Aspect ratio of the rudder.
const ASPECT: f64 = 1.8219;
/// κ of the inflow to the rudder: influence of the propeller stream.
const KAPPA: f64 = 0.631;
/// ε of the inflow to the rudder, relative to the inflow to the propeller.
const EPSILON: f64 = 0.921;
/// Flow straightening of v', r', r'³ and r'² v'.
const STRAIGHTENING: [f64; 4] = [0.088, -0.156, -0.275, 1.96];
/// Share of F_N sin δ that is resistance.
const RESISTANCE: f64 = 0.71;
/// Share a_H of the rudder force that acts on the hull in addition.
const AH: f64 = 0.237;
/// Position x_R' of the rudder.
const XR: f64 = -0.5;
/// Position x_H' of the additional force on the hull.
const XH: f64 = -0.48;

/// S175 hull at the propeller revolutions of its steady approach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContainerHull {
    /// Revolutions times diameter of the propeller, n D, m/s.
    tip: f64,
    /// Slope dN'/dδ on the straight approach.
    rudder_slope: f64,
}

impl ContainerHull {
    /// Hull whose thrust balances the resistance: (1 − t) 2 (D/L)² (k0 q² + k1 (1 − w) q) = −X'uu with q = n D/U.
    fn new() -> Self {
        let Particulars { length: L, speed: U } = PARTICULARS;
        let [k0, k1] = THRUST;
        let thrust = -X[0] / ((1.0 - DEDUCTION) * 2.0 * (DIAMETER / L).powi(2));
        let half = -0.5 * k1 * (1.0 - WAKE);
        let tip = U * (half + (half * half + k0 * thrust).sqrt()) / k0;
        let (hull, step) = (Self { tip, rudder_slope: 0.0 }, 1e-6);
        let rudder_slope = (XR + AH * XH) * hull.rudder_force([1.0, 0.0, 0.0], step, U) / step;
        Self { rudder_slope, ..hull }
    }

    /// Normal force of the rudder over ½ρL²U², at prime velocities.
    fn rudder_force(&self, [u, v, r]: [f64; 3], rudder: f64, U: f64) -> f64 {
        let [by_v, by_r, by_rrr, by_rrv] = STRAIGHTENING;
        let vR = by_v * v + by_r * r + by_rrr * r * r * r + by_rrv * r * r * v;
        let uP = inflow(u, v, r);
        let q = self.tip / U;
        // ε u_P √(1 + 8 κ K_T/(π J²)), regular at J = 0.
        let uR = EPSILON * (uP * uP + 8.0 * KAPPA * thrust_coefficient(uP, q) * q * q / PI).max(0.0).sqrt();
        let lift = 6.13 * ASPECT / (ASPECT + 2.25) * AREA / PARTICULARS.length.powi(2);
        -lift * (uR * uR + vR * vR) * (rudder + vR.atan2(uR)).sin()
    }
}

/// Inflow to the propeller, u_P/U.
fn inflow(u: f64, v: f64, r: f64) -> f64 {
    u * (1.0 - WAKE + TAU * (v + XP * r).powi(2))
}

/// Thrust coefficient K_T at the inflow `uP` and q = n D/U, with J = u_P/q.
fn thrust_coefficient(uP: f64, q: f64) -> f64 {
    THRUST[0] + THRUST[1] * uP / q
}

fn lateral([by_v, by_r, vvv, rrr, vvr, vrr]: [f64; 6], v: f64, r: f64) -> f64 {
    by_v * v + by_r * r + vvv * v * v * v + rrr * r * r * r + vvr * v * v * r + vrr * v * r * r
}

impl Hull for ContainerHull {
    fn particulars(&self) -> Particulars {
        PARTICULARS
    }

    /// Accelerations from m' a' = F', a = a' U²/L (r' by U²/L²); the disturbance adds the yaw moment N'δ δ at approach
    /// speed.
    fn acceleration(&self, [surge, sway, yaw]: [f64; 3], input: &ShipInput) -> [f64; 3] {
        let Particulars { length: L, speed: U0 } = PARTICULARS;
        let U = surge.hypot(sway).max(MIN_SPEED_SHARE * U0);
        let (u, v, r) = (surge / U, sway / U, yaw * L / U);
        let q = self.tip / U;
        let thrust = 2.0 * (DIAMETER / L).powi(2) * q * q * thrust_coefficient(inflow(u, v, r), q);
        let force = self.rudder_force([u, v, r], input.rudder, U);
        let (sin, cos) = input.rudder.sin_cos();

        let [uu, vr, rr, vv] = X;
        let ahead = uu * u * u
            + vr * v * r
            + rr * r * r
            + vv * v * v
            + (1.0 - DEDUCTION) * thrust
            + RESISTANCE * force * sin
            + (M + MY) * v * r;
        let across = lateral(Y, v, r) + (1.0 + AH) * force * cos - (M + MX) * u * r;
        let moment = lateral(N, v, r)
            + (XR + AH * XH) * force * cos
            + self.rudder_slope * input.disturbance_rudder * (U0 / U).powi(2);
        let det = (M + MY) * INERTIA - COUPLING * COUPLING;
        let unit = U * U / L;
        [
            ahead / (M + MX) * unit,
            (INERTIA * across - COUPLING * moment) / det * unit,
            ((M + MY) * moment - COUPLING * across) / det * unit / L,
        ]
    }
}

/// S175 at 7 m/s; rudder rate 5 deg/s, as in the source of the table.
///
/// Source: Son and Nomoto (1982), as tabulated in the Marine Systems Simulator (Lauvdal 1994, Fossen 2022).
pub fn ship() -> Ship {
    Ship {
        id: "s175".into(),
        name: "container ship S175, 7 m/s, without heel".into(),
        source: "Son and Nomoto (1982), in the Marine Systems Simulator".into(),
        particulars: Some(PARTICULARS),
        rudder_rate: Some(5f64.to_radians()),
        largest_rudder: None,
        model: ShipModel::Hull(Arc::new(ContainerHull::new())),
    }
}
