//! The yaw equation, its coefficients and what signs these may have.
#![expect(non_snake_case, reason = "N_r and N_v are written as in the literature")]

use serde::{Deserialize, Serialize};

use super::coefficients::within;

/// Number of coefficients.
pub const YAW_COEFFICIENTS: usize = 6;

/// Symbols of the coefficients, in the order of [`Yaw::to_array`].
pub const YAW_SYMBOLS: [&str; YAW_COEFFICIENTS] = ["N_r", "N_v", "N_vrr", "N_d", "N_ud", "N_0"];

/// Least and largest value of every coefficient: turning is damped, the rudder turns the ship to its own side, and a
/// quick turn takes from the moment of drift. The other ends are far beyond any ship and keep a search finite.
pub(crate) const YAW_BOUNDS: [[f64; 2]; YAW_COEFFICIENTS] =
    [[1e-3, 30.0], [-10.0, 30.0], [-50.0, 0.0], [1e-3, 10.0], [0.0, 10.0], [-1.0, 1.0]];

/// A full ship, from which searches begin.
pub(crate) const TYPICAL_YAW: Yaw = Yaw { N_r: 1.5, N_v: 1.0, N_vrr: -2.0, N_d: 0.4, N_ud: 0.4, N_0: 0.0 };

/// Dimensionless coefficients of the yaw equation.
///
/// r' = −N_r U₀ r / L − N_v u v / L² − N_vrr v r² + U₀ (N_d U₀ + N_ud u) δ / L² + N_0 U₀² / L²,
///
/// with surge u and sway v (m/s, body axes, at the point the records report), yaw rate r (rad/s), rudder δ (rad,
/// positive turns to starboard), length L (m) and the speed U₀ of the straight approach (m/s). Accelerations are those
/// of the hull with its added inertia, so N_r is about damping over inertia. As in
/// PlanarCoefficients the same values hold for ships that are alike at the
/// same Froude number.
///
/// In a turn v r < 0: drift turns the ship further into the turn (N_v > 0, the Munk moment), more slowly than in
/// proportion when it turns quickly (N_vrr ≤ 0). A ship may be unstable on a straight course; what limits its turn is
/// then the sway that damps itself, and N_vrr. The rudder lies in the stream of a propeller of constant revolutions,
/// and loses less than the ship does when that slows down. N_0 is what a single propeller does to one side; the rudder
/// bias is N_0 / (N_d + N_ud) at approach speed.
///
/// The terms were chosen by how well zig-zags of a tanker model (KVLCC2, HSVA; eight records) are told by a fit to the
/// others, for a hull that is steered on from measured states over windows of 10 L/U₀ (heading error in degrees,
/// geometric mean over records) and in the whole zig-zag (error of the first four extremes of the heading in degrees,
/// root mean square): 3.9 and 1.9 with U₀ r, u v, u δ and the constant alone; 2.9 and 1.5 with U₀ δ as well; 2.8 and
/// 1.2 with v r² as well. Damping by u or by √(u² + v²) gives 2.9 to 3.1 and 2.3 to 2.5, U₀ v for u v 3.0 and 2.2, U₀ δ
/// without u δ 3.8 and 1.4. r|r|, r³, v|v|, v³, v² r, |v| r, v|r|, u δ³, u δ |v|, |r| and |v| gained 0.2 or nothing in
/// the one and nothing in the other. Fitted with surge and sway of the model in place of the measured ones the same
/// equation came to 4.3 and 2.2.
///
/// It fails where the ship goes astern or drifts broadside, at rudders and yaw rates far beyond those of the records,
/// and with v and r of the same sign and both large, where N_vrr drives the turn.
///
/// Sources: Abkowitz (1964); Norrbin (1971); Yasukawa & Yoshimura (2015) for the rudder behind a propeller.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Yaw {
    /// Damping of turning by the speed of the approach, at least 0.001.
    pub N_r: f64,
    /// Turning by drift: positive turns the ship further into its turn.
    pub N_v: f64,
    /// Change of that by turning; not positive.
    pub N_vrr: f64,
    /// Rudder in the stream of the propeller, at least 0.001.
    pub N_d: f64,
    /// Rudder by the way through the water; not negative.
    pub N_ud: f64,
    /// Moment of a single propeller, positive to starboard.
    pub N_0: f64,
}

impl Yaw {
    /// The coefficients in the order of [`YAW_SYMBOLS`].
    pub fn to_array(self) -> [f64; YAW_COEFFICIENTS] {
        let Self { N_r, N_v, N_vrr, N_d, N_ud, N_0 } = self;
        [N_r, N_v, N_vrr, N_d, N_ud, N_0]
    }

    /// Coefficients in the order of [`YAW_SYMBOLS`]; a value of the wrong sign is put to the nearest of the right
    /// one.
    pub fn from_array(values: [f64; YAW_COEFFICIENTS]) -> Self {
        let [N_r, N_v, N_vrr, N_d, N_ud, N_0] = within(values, YAW_BOUNDS);
        Self { N_r, N_v, N_vrr, N_d, N_ud, N_0 }
    }

    /// r' in units of (U₀/L)², of speeds in U₀, the yaw rate in U₀/L, rudder and disturbance in rad.
    #[inline]
    pub(crate) fn rate(&self, u: f64, v: f64, r: f64, rudder: f64, disturbance: f64) -> f64 {
        (self.N_d + self.N_ud * u) * (rudder + disturbance) + self.N_0
            - self.N_r * r
            - self.N_v * u * v
            - self.N_vrr * v * r * r
    }
}
