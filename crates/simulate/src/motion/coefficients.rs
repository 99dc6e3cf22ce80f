//! Equations of surge and sway, with their coefficients and the bounds of the coefficients.
//!
//! Sources: Abkowitz (1964); Norrbin (1971); Yasukawa and Yoshimura (2015) for the rudder behind a propeller.
#![expect(non_snake_case, reason = "X_vr and Y_v are written as in the literature")]

use serde::{Deserialize, Serialize};

/// Number of coefficients of the planar equations.
pub const COEFFICIENT_COUNT: usize = 8;

/// Symbols of the coefficients, in the order of [`PlanarCoefficients::to_array`].
pub const COEFFICIENT_SYMBOLS: [&str; COEFFICIENT_COUNT] = ["X_0", "X_vr", "X_dd", "X_dv", "Y_v", "Y_vv", "Y_r", "Y_d"];

/// Bounds of every coefficient. Bounds on signs ensure that rudder and hull reduce the speed in a turn and damp the
/// sway; the other bounds are far beyond any ship and keep a search finite.
pub(crate) const COEFFICIENT_BOUNDS: [[f64; 2]; COEFFICIENT_COUNT] =
    [[1e-3, 2.0], [0.0, 5.0], [0.0, 5.0], [0.0, 5.0], [1e-3, 20.0], [0.0, 100.0], [-3.0, 3.0], [-3.0, 3.0]];

/// Dimensionless coefficients of the planar equations.
///
/// u' = X_0 (U₀² − u|u|) / L + X_vr v r − max(0, U₀ sin δ (X_dd u sin δ + X_dv v)) / L,
///
/// v' = −(Y_v U₀ + Y_vv |v|) v / L − Y_r u r − Y_d U₀ u δ / L,
///
/// with surge u and sway v (m/s, body axes, at the reference point of the records), yaw rate r (rad/s), rudder δ (rad,
/// positive turns to starboard), length L (m) and the speed U₀ of the straight approach (m/s). Time in L/U₀ and speeds
/// in U₀ make the equations nondimensional, so the same coefficients hold for similar ships at the same Froude number.
///
/// The rudder is in the stream of a propeller at constant revolutions, so its forces are proportional to U₀ u, not to
/// u². Its drag depends on the angle of attack: drift reduces it in a turn and increases it when the rudder is put over
/// against the turn. The drag is never negative. In a turn v r < 0, so all terms but the first reduce the speed, and
/// the speed stays below U₀; without rudder a sway velocity decays.
///
/// The terms were selected from the usual expansions by cross-validation on zig-zags of a tanker model (KVLCC2, HSVA).
/// Root mean square error of surge and sway on the left-out zig-zags, in % of U₀: 1.0 and 1.0 with rudder forces in u²
/// and sway damping |u| v alone, 1.1 and 0.65 with v |v| as well, 0.62 and 0.45 with rudder forces in U₀ u, 0.48 and
/// 0.45 with X_dv as well, 0.46 and 0.34 with sway damping U₀ v. Terms v² and u U₀ in surge, |r| v and r|r| in sway
/// reduced the errors by at most 0.02.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlanarCoefficients {
    /// Surplus of thrust over resistance per U₀² − u|u|, at least 0.001.
    pub X_0: f64,
    /// Surge due to drift in a turn: 1 for the rotation of the axes alone, more with the added mass of sway; not
    /// negative.
    pub X_vr: f64,
    /// Drag of the rudder on a straight course; not negative.
    pub X_dd: f64,
    /// Change of the rudder drag due to drift; not negative.
    pub X_dv: f64,
    /// Damping of sway by the speed of the approach, at least 0.001.
    pub Y_v: f64,
    /// Damping of sway by cross-flow; not negative.
    pub Y_vv: f64,
    /// Sway due to turning: 1 for the rotation of the axes alone.
    pub Y_r: f64,
    /// Sway due to the rudder; a positive force points out of the turn.
    pub Y_d: f64,
}

impl PlanarCoefficients {
    /// Coefficients in the order of [`COEFFICIENT_SYMBOLS`].
    pub fn to_array(self) -> [f64; COEFFICIENT_COUNT] {
        let Self { X_0, X_vr, X_dd, X_dv, Y_v, Y_vv, Y_r, Y_d } = self;
        [X_0, X_vr, X_dd, X_dv, Y_v, Y_vv, Y_r, Y_d]
    }

    /// Coefficients from values in the order of [`COEFFICIENT_SYMBOLS`], clamped to their bounds.
    pub fn clamped_from_array(values: [f64; COEFFICIENT_COUNT]) -> Self {
        let [X_0, X_vr, X_dd, X_dv, Y_v, Y_vv, Y_r, Y_d] = clamped(values, COEFFICIENT_BOUNDS);
        Self { X_0, X_vr, X_dd, X_dv, Y_v, Y_vv, Y_r, Y_d }
    }

    /// First coefficient outside its bounds: symbol, value and bounds; `None` if all are within their bounds.
    pub fn first_out_of_bounds(self) -> Option<(&'static str, f64, [f64; 2])> {
        let all = COEFFICIENT_SYMBOLS.into_iter().zip(self.to_array()).zip(COEFFICIENT_BOUNDS);
        all.map(|((symbol, value), ends)| (symbol, value, ends))
            .find(|(_, value, [low, high])| !(*low..=*high).contains(value))
    }

    /// Rates (u', v') in U₀²/L, at speeds in U₀, yaw rate in U₀/L and rudder in rad.
    #[inline]
    pub(crate) fn rates(&self, u: f64, v: f64, r: f64, rudder: f64) -> [f64; 2] {
        let sin = rudder.sin();
        let drag = (sin * (self.X_dd * u * sin + self.X_dv * v)).max(0.0);
        [
            self.X_0 * (1.0 - u * u.abs()) + self.X_vr * v * r - drag,
            -(self.Y_v + self.Y_vv * v.abs()) * v - self.Y_r * u * r - self.Y_d * u * rudder,
        ]
    }
}

/// Values clamped to their bounds.
pub(crate) fn clamped<const N: usize>(values: [f64; N], bounds: [[f64; 2]; N]) -> [f64; N] {
    std::array::from_fn(|i| values[i].clamp(bounds[i][0], bounds[i][1]))
}
