//! Wind on a hull: one coefficient Y_w scales the forces and the moment.
//!
//! A relative wind W (in U₀) from γ, clockwise from the bow, adds
//!
//! (u', v', r') = Y_w W² (−0.4 cos γ, −sin γ, −18 · 0.18 (π/2 − |γ|) sin γ).
//!
//! The centre of the side force is 0.18 (π/2 − |γ|) L ahead of midship (Blendermann 1994), for an above-water profile
//! of equal height fore and aft. 18 is (m' + m_y')/(I_z' + J_z') with a radius of gyration of L/4; 0.4 is the ratio of
//! frontal to lateral area, 0.3, times 1.35 for the smaller effective mass in surge. Both differ little among ships.
//!
//! Y_w = (ρ_air/ρ) C_Y A_L/(L d)/(m' + m_y')
//!
//! with C_Y = 0.8 and a lateral area A_L = (0.8 ± 0.4) L d: 0.5 for a loaded tanker, 1.3 for a tanker in ballast, up to
//! 2 for a container ship.
//!
//! Source: Blendermann (1994), Journal of Wind Engineering and Industrial Aerodynamics 51:339-351.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::equations::{PolynomialTerm, bounded};
use crate::vessel::mmg::MmgParameters;

/// Wind coefficient Y_w, a coefficient of every form.
pub(super) const WIND_COEFFICIENT: PolynomialTerm = bounded("Yw", "Y_w", [0.0, 0.1]);

/// Density ratio ρ_air/ρ.
const DENSITY: f64 = 1.2e-3;

/// Side-force coefficient C_Y.
const SIDE_FORCE: f64 = 0.8;

/// Lateral area ratio A_L/(L d), mean and standard deviation.
const LATERAL_AREA: [f64; 2] = [0.8, 0.4];

/// Surge acceleration over sway acceleration.
const AHEAD: f64 = 0.4;

/// Yaw acceleration over sway acceleration, per radian from abeam.
const YAW: f64 = 18.0 * 0.18;

/// Prior mean and standard deviation of Y_w for a hull.
pub(super) fn wind_coefficient_prior(hull: &MmgParameters) -> [f64; 2] {
    let mass = 2.0 * hull.volume / (hull.Lpp * hull.Lpp * hull.d);
    LATERAL_AREA.map(|area| DENSITY * SIDE_FORCE * area / (mass + hull.hull.my))
}

/// Accelerations (u', v', r') per unit of Y_w in a relative wind (in U₀) from an angle off the bow (rad).
#[inline]
pub fn wind_accelerations(speed: f64, from: f64) -> [f64; 3] {
    let off_bow = (from + PI).rem_euclid(TAU) - PI;
    let (sin, cos) = off_bow.sin_cos();
    [-AHEAD * cos, -sin, -YAW * (FRAC_PI_2 - off_bow.abs()) * sin].map(|share| speed * speed * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ships::kvlcc2;

    /// Effect of the wind: from the starboard bow it pushes a ship astern and to port and turns the bow to port; from
    /// the starboard quarter it pushes the ship ahead and to port and turns the bow to starboard. The mirror image has
    /// opposite signs.
    #[test]
    fn wind_pushes_and_turns() {
        for (from, ahead, turning) in [(0.8, -1.0, -1.0), (2.4, 1.0, 1.0)] {
            let [u, v, r] = wind_accelerations(2.0, from);
            assert!(u * ahead > 0.0 && v < 0.0 && r * turning > 0.0, "{from}: {u} {v} {r}");
            let near = |other: [f64; 3]| other.iter().zip([u, v, r]).all(|(x, y)| (x - y).abs() < 1e-12);
            let [ahead, side, yaw] = wind_accelerations(2.0, -from);
            assert!(near([ahead, -side, -yaw]) && near(wind_accelerations(2.0, from + TAU)));
        }
        assert!(wind_accelerations(1.0, FRAC_PI_2)[2].abs() < 1e-12);
    }

    /// KVLCC2 with the lateral area of a loaded tanker, half of L d, lies within the expected range.
    #[test]
    fn a_loaded_tanker_is_expected() {
        let [mean, sd] = wind_coefficient_prior(&kvlcc2::FULL_SCALE);
        let loaded = mean * 0.5 / LATERAL_AREA[0];
        assert!((mean - loaded).abs() < sd && (0.8e-3..1.2e-3).contains(&loaded), "{mean} {sd} {loaded}");
    }
}
