//! What wind does to a hull: one coefficient, Y_w, by which its forces and its moment go.
//!
//! With the relative wind W (in U₀) from γ, clockwise from the bow, it adds
//!
//! (u', v', r') = Y_w W² (−0.4 cos γ, −sin γ, −18 · 0.18 (π/2 − |γ|) sin γ).
//!
//! The centre of the side force is ahead of midship by 0.18 (π/2 − |γ|) L (Blendermann 1994), for an above-water ship
//! that is as high ahead as aft. 18 is (m' + m_y')/(I_z' + J_z') with a radius of gyration of L/4, and 0.4 the frontal
//! over the lateral area, 0.3, times 1.35 for a mass that is smaller ahead; both differ little among ships. Y_w is
//!
//! Y_w = (ρ_air/ρ) C_Y A_L/(L d)/(m' + m_y')
//!
//! with C_Y = 0.8 and a lateral area A_L of 0.8 ± 0.4 L d: 0.5 for a loaded tanker, 1.3 for one in ballast, up to 2 for
//! a container ship.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::equations::{PolynomialTerm, within};
use crate::vessel::mmg::Parameters;

/// Y_w, which every form has.
pub(super) const WINDAGE: PolynomialTerm = within("Yw", "Y_w", [0.0, 0.1]);

/// ρ_air/ρ.
const DENSITY: f64 = 1.2e-3;

/// C_Y.
const SIDE_FORCE: f64 = 0.8;

/// A_L/(L d) and its standard deviation.
const LATERAL_AREA: [f64; 2] = [0.8, 0.4];

/// Surge over sway.
const AHEAD: f64 = 0.4;

/// Yaw over sway, per radian from abeam.
const YAW: f64 = 18.0 * 0.18;

/// What is expected of Y_w for a hull, and its standard deviation.
pub(super) fn windage(hull: &Parameters) -> [f64; 2] {
    let mass = 2.0 * hull.volume / (hull.Lpp * hull.Lpp * hull.d);
    LATERAL_AREA.map(|area| DENSITY * SIDE_FORCE * area / (mass + hull.hull.my))
}

/// (u', v', r') over Y_w in a relative wind, in U₀, from an angle off the bow, rad.
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

    /// A wind from the starboard bow drives a ship astern and to port and her bow to port; one from the starboard
    /// quarter ahead and to port, with her bow to starboard. In the mirror it is the same with the other sign.
    #[test]
    fn wind_pushes_and_turns() {
        for (from, ahead, turning) in [(0.8, -1.0, -1.0), (2.4, 1.0, 1.0)] {
            let [u, v, r] = wind_accelerations(2.0, from);
            assert!(u * ahead > 0.0 && v < 0.0 && r * turning > 0.0, "{from}: {u} {v} {r}");
            let near = |other: [f64; 3]| other.iter().zip([u, v, r]).all(|(one, other)| (one - other).abs() < 1e-12);
            let [ahead, side, yaw] = wind_accelerations(2.0, -from);
            assert!(near([ahead, -side, -yaw]) && near(wind_accelerations(2.0, from + TAU)));
        }
        assert!(wind_accelerations(1.0, FRAC_PI_2)[2].abs() < 1e-12);
    }

    /// KVLCC2 with the lateral area of a loaded tanker, a half of L d, lies within what is expected.
    #[test]
    fn a_loaded_tanker_is_expected() {
        let [mean, sd] = windage(&kvlcc2::FULL_SCALE);
        let loaded = mean * 0.5 / LATERAL_AREA[0];
        assert!((mean - loaded).abs() < sd && (0.8e-3..1.2e-3).contains(&loaded), "{mean} {sd} {loaded}");
    }
}
