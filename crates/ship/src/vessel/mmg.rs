//! MMG standard model: hull, propeller and rudder as separate parts (Yasukawa and Yoshimura 2015).
//!
//! Every equation is divided by ½ρLd, and the moment by a further L. Forces then read as X' U², the moment as N' U²
//! (m²/s²), and the density of the water drops out. In the velocities (u, v, rL):
//!
//! (m' + m_x') L u' = X + (m' + m_y') v (rL) + x_G' m' (rL)²
//!
//! (m' + m_y') L v' + x_G' m' L² r' = Y − (m' + m_x') u (rL)
//!
//! (I_z' + x_G'² m' + J_z') L² r' + x_G' m' L v' = N − x_G' m' u (rL)
//!
//! β = atan(−v/u) and v are taken at midship. The rudder is positive to starboard. Wake and flow straightening change
//! with the sign of an inflow angle: accelerations are continuous, their slopes are not.
//!
//! Source of the model: H. Yasukawa and Y. Yoshimura (2015), Introduction of MMG standard method for ship maneuvering
//! predictions, Journal of Marine Science and Technology 20, 37–52.

mod parameters;

use std::f64::consts::PI;

use estimation::number::Real;
use thiserror::Error;

pub use self::parameters::{BySign, HullDerivatives, MmgParameters, Propeller, Rudder, Wake};
use super::{Hull, MIN_SPEED_SHARE};
use crate::dynamics::ShipInput;
use crate::linear::PrimeSwayYawMatrices;
use crate::particulars::Particulars;

/// Error of parameters from which no hull can be made.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum MmgError {
    /// Quantity that must be positive and finite.
    #[error("{symbol} must be positive, found {value}")]
    NotPositive {
        /// Symbol.
        symbol: &'static str,
        /// Rejected value.
        value: f64,
    },
    /// Inertia in surge, sway or yaw that is not positive; the value is the determinant of the prime mass matrix of
    /// sway and yaw.
    #[error("mass and added mass leave no positive inertia in sway and yaw (determinant {0})")]
    Inertia(f64),
    /// Thrust that balances the resistance at no advance ratio.
    #[error("thrust balances the resistance at no advance ratio: k0 = {k0}, R0' = {R0}")]
    NoBalance {
        /// Thrust coefficient at J = 0.
        k0: f64,
        /// Resistance coefficient.
        R0: f64,
    },
}

/// MMG hull at constant propeller revolutions, with its steady straight approach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mmg<R = f64> {
    parameters: MmgParameters<R>,
    /// Prime mass m' = ∇/(½L²d).
    mass: R,
    /// Moment of mass x_G' m'.
    moment_of_mass: R,
    /// Prime mass matrix of sway and yaw: m11, m12 = m21, m22.
    inertia: [R; 3],
    /// Rudder area ratio A_R/(Ld).
    rudder_area: R,
    /// Thrust factor 2 D_P⁴/(Ld), m²: thrust over ½ρLd is this times n² K_T.
    thrust: R,
    revolutions: R,
    approach_speed: f64,
    /// Rudder moment slope dN/dδ amidships at approach speed over ½ρL²d, m²/s².
    rudder_moment: R,
}

impl<R: Real> Mmg<R> {
    /// Hull whose straight approach at `speed` (m/s) is steady; the revolutions follow from the balance of thrust.
    ///
    /// Fails for parameters that are not positive where required, that leave no positive inertia, or whose thrust
    /// cannot balance the resistance.
    pub fn at_speed(parameters: MmgParameters<R>, speed: f64) -> Result<Self, MmgError> {
        positive("approach speed", speed)?;
        let speed_per_revolution = speed_per_revolution(&parameters)?;
        Self::new(parameters, speed, R::from(speed) / speed_per_revolution)
    }

    fn new(parameters: MmgParameters<R>, approach_speed: f64, revolutions: R) -> Result<Self, MmgError> {
        let p = &parameters;
        let (L, d) = (p.Lpp, p.d);
        for (symbol, value) in
            [("displaced volume", p.volume), ("kzz", p.kzz), ("AR", p.rudder.AR), ("f_alpha", p.rudder.f_alpha)]
        {
            positive(symbol, value.value())?;
        }
        let mass = p.volume / (L * 0.5 * L * d);
        let xG = p.xG / L;
        let inertia = [mass + p.hull.my, xG * mass, (p.kzz * p.kzz + xG * xG) * mass + p.hull.Jz];
        let det = (inertia[0] * inertia[2] - inertia[1] * inertia[1]).value();
        if !(det > 0.0 && inertia[0].value() > 0.0 && (mass + p.hull.mx).value() > 0.0) {
            return Err(MmgError::Inertia(det));
        }
        let mut hull = Self {
            parameters,
            mass,
            moment_of_mass: xG * mass,
            inertia,
            rudder_area: p.rudder.AR / (L * d),
            thrust: p.propeller.DP.powi(4) * 2.0 / (L * d),
            revolutions,
            approach_speed,
            rudder_moment: R::from(0.0),
        };
        hull.rudder_moment = hull.rudder_slopes()[1] * approach_speed * approach_speed;
        Ok(hull)
    }

    /// Parameters.
    pub fn parameters(&self) -> &MmgParameters<R> {
        &self.parameters
    }

    /// Propeller revolutions n, 1/s.
    pub fn revolutions(&self) -> R {
        self.revolutions
    }

    /// Longitudinal inflow to the rudder on the straight approach, over U.
    fn approach_inflow(&self) -> R {
        let uP = (-self.parameters.propeller.wP0 + 1.0) * self.approach_speed;
        self.rudder_inflow(uP, self.revolutions) / self.approach_speed
    }

    /// Rudder slopes dY'/dδ and dN'/dδ at δ = 0 on the straight approach.
    fn rudder_slopes(&self) -> [R; 2] {
        let rudder = &self.parameters.rudder;
        let slope = self.rudder_area * self.approach_inflow().powi(2) * rudder.f_alpha;
        [-(rudder.aH + 1.0) * slope, -(rudder.xR + rudder.aH * rudder.xH) * slope]
    }

    /// Thrust coefficient K_T at the advance speed `uP` (m/s) and `revolutions` (1/s).
    #[inline(always)]
    fn thrust_coefficient(&self, uP: R, revolutions: R) -> R {
        let propeller = &self.parameters.propeller;
        let J = uP / (revolutions * propeller.DP);
        let [k0, k1, k2] = propeller.k;
        k0 + J * (k1 + J * k2)
    }

    /// Longitudinal rudder inflow u_R = ε u_P √(η {1 + κ [√(1 + 8 K_T/(π J²)) − 1]}² + 1 − η), m/s, written so that J
    /// = 0 is regular.
    #[inline(always)]
    fn rudder_inflow(&self, uP: R, revolutions: R) -> R {
        let rudder = &self.parameters.rudder;
        let nD = revolutions * self.parameters.propeller.DP;
        // A windmilling propeller (K_T < 0) can stop the stream, but not reverse it.
        let thrust = self.thrust_coefficient(uP, revolutions) * 8.0 * nD * nD / PI;
        let stream = (uP * uP + thrust).at_least(f64::MIN_POSITIVE).sqrt();
        let behind = uP + rudder.kappa * (stream - uP);
        rudder.epsilon * (rudder.eta * behind * behind + (-rudder.eta + 1.0) * uP * uP).sqrt()
    }

    /// Wake fraction w_P at the inflow angle β_P.
    #[inline(always)]
    fn wake(&self, betaP: R) -> R {
        let propeller = &self.parameters.propeller;
        match propeller.wake {
            Wake::Exponential { C1, C2 } => {
                let fading = -(-C1 * betaP.abs()).exp() + 1.0;
                let gain = fading * (C2.value_at(betaP) - 1.0) + 1.0;
                -(-propeller.wP0 + 1.0) * gain + 1.0
            }
            Wake::Gaussian => propeller.wP0 * (betaP * -4.0 * betaP).exp(),
        }
    }

    /// Accelerations (u', v', r') in m/s² and rad/s² at surge u and sway v (m/s), yaw rate (rad/s) and rudder (rad);
    /// `n_ratio` is the propeller rate relative to the approach, and the disturbance (rad) adds the yaw moment (dN/dδ)
    /// δ of the straight approach.
    #[inline(always)]
    pub fn accelerations(&self, [u, v, r]: [R; 3], rudder_angle: R, n_ratio: f64, disturbance: f64) -> [R; 3] {
        let MmgParameters { Lpp, hull, propeller, rudder, .. } = &self.parameters;
        let L = *Lpp;
        let revolutions = self.revolutions * n_ratio;
        let rL = r * L;
        let U = u.hypot(v).at_least(MIN_SPEED_SHARE * self.approach_speed);
        let (v_, r_) = (v / U, rL / U);
        let beta = (-v).atan2(u);
        let U2 = U * U;

        let (vv, vr, rr) = (v_ * v_, v_ * r_, r_ * r_);
        let XH = U2 * (-hull.R0 + hull.Xvv * vv + hull.Xvr * vr + hull.Xrr * rr + hull.Xvvvv * vv * vv);
        let YH =
            U2 * (v_ * (hull.Yv + hull.Yvvv * vv + hull.Yvvr * vr + hull.Yvrr * rr) + r_ * (hull.Yr + hull.Yrrr * rr));
        let NH =
            U2 * (v_ * (hull.Nv + hull.Nvvv * vv + hull.Nvvr * vr + hull.Nvrr * rr) + r_ * (hull.Nr + hull.Nrrr * rr));

        let uP = u * (-self.wake(beta - propeller.xP * r_) + 1.0);
        let KT = self.thrust_coefficient(uP, revolutions);
        let XP = (-propeller.tP + 1.0) * self.thrust * revolutions * revolutions * KT;

        let betaR = beta - rudder.lR * r_;
        let uR = self.rudder_inflow(uP, revolutions);
        let vR = U * rudder.gammaR.value_at(betaR) * betaR;
        let alphaR = rudder_angle - vR.atan2(uR);
        let FN = self.rudder_area * (uR * uR + vR * vR) * rudder.f_alpha * alphaR.sin_cos().0;
        let (sin, cos) = rudder_angle.sin_cos();
        let XR = -(-rudder.tR + 1.0) * FN * sin;
        let YR = -(rudder.aH + 1.0) * FN * cos;
        let NR = -(rudder.xR + rudder.aH * rudder.xH) * FN * cos;

        let X = XH + XP + XR + (self.mass + hull.my) * v * rL + self.moment_of_mass * rL * rL;
        let Y = YH + YR - (self.mass + hull.mx) * u * rL;
        let N = NH + NR + self.rudder_moment * disturbance - self.moment_of_mass * u * rL;
        let [m11, m12, m22] = self.inertia;
        let det = m11 * m22 - m12 * m12;
        [X / ((self.mass + hull.mx) * L), (m22 * Y - m12 * N) / (det * L), (m11 * N - m12 * Y) / (det * L * L)]
    }
}

impl Mmg {
    /// Linear equations of sway and yaw about the straight approach.
    ///
    /// Flow straightening has two slopes at zero angle; their mean is used, so the result describes neither side
    /// exactly.
    pub fn linearised(&self) -> PrimeSwayYawMatrices {
        let (hull, rudder) = (&self.parameters.hull, &self.parameters.rudder);
        let b = self.rudder_slopes();
        // α_R = δ + γ_R (v' + ℓ_R' r') U/u_R for small motion.
        let straightening = rudder.gammaR.mean() / self.approach_inflow();
        let by_v = b.map(|slope| slope * straightening);
        let by_r = by_v.map(|slope| slope * rudder.lR);
        let [m11, m12, m22] = self.inertia;
        PrimeSwayYawMatrices {
            M: [[m11, m12], [m12, m22]],
            N: [
                [-(hull.Yv + by_v[0]), self.mass + hull.mx - (hull.Yr + by_r[0])],
                [-(hull.Nv + by_v[1]), self.moment_of_mass - (hull.Nr + by_r[1])],
            ],
            b,
        }
    }
}

fn positive(symbol: &'static str, value: f64) -> Result<(), MmgError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(MmgError::NotPositive { symbol, value }) }
}

/// Ratio of steady speed to revolutions, m; the advance ratio at which thrust balances resistance does not depend on n.
///
/// R0' (J D/(1 − w))² = (1 − t_P) 2 D⁴/(Ld) (k0 + k1 J + k2 J²), a quadratic in J. The left side increases from zero,
/// so for decreasing thrust there is one positive root. Fails if there is none, or if a parameter is not positive.
fn speed_per_revolution<R: Real>(p: &MmgParameters<R>) -> Result<R, MmgError> {
    let propeller = &p.propeller;
    let [past_wake, past_hull] = [-propeller.wP0 + 1.0, -propeller.tP + 1.0];
    for (symbol, value) in [
        ("Lpp", p.Lpp),
        ("d", p.d),
        ("DP", propeller.DP),
        ("R0'", p.hull.R0),
        ("1 - wP0", past_wake),
        ("1 - tP", past_hull),
    ] {
        positive(symbol, value.value())?;
    }
    let [k0, k1, k2] = propeller.k;
    let pitch = propeller.DP / past_wake;
    let resistance = p.hull.R0 * pitch * pitch * p.Lpp * p.d / (past_hull * 2.0 * propeller.DP.powi(4));
    // (resistance − k2) J² − k1 J − k0 = 0 in the form that does not cancel for k1 < 0.
    let quarter = k1 * k1 + (resistance - k2) * 4.0 * k0;
    let J = k0 * 2.0 / (quarter.sqrt() - k1);
    let balances = J.value() > 0.0 && J.value().is_finite();
    if balances { Ok(J * pitch) } else { Err(MmgError::NoBalance { k0: k0.value(), R0: p.hull.R0.value() }) }
}

impl Hull for Mmg {
    fn particulars(&self) -> Particulars {
        Particulars { length: self.parameters.Lpp, speed: self.approach_speed }
    }

    /// Accelerations by the equations of the module; the disturbance adds the yaw moment (dN/dδ) δ of the straight
    /// approach.
    fn acceleration(&self, velocity: [f64; 3], input: &ShipInput) -> [f64; 3] {
        self.accelerations(velocity, input.rudder, 1.0, input.disturbance_rudder)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ships::kvlcc2::FULL_SCALE;
    use approx::assert_relative_eq;

    /// Textbook form of u_R, which divides by J, in a state with J ≠ 0.
    #[test]
    fn rudder_inflow_is_the_published_formula() {
        let hull = Mmg::at_speed(FULL_SCALE, 8.0).expect("balances");
        let (propeller, rudder) = (&FULL_SCALE.propeller, &FULL_SCALE.rudder);
        for uP in [1.0, 3.0, 5.2] {
            let J = uP / (hull.revolutions() * propeller.DP);
            let KT = hull.thrust_coefficient(uP, hull.revolutions());
            assert_relative_eq!(KT, 0.2931 - 0.2753 * J - 0.1385 * J * J, max_relative = 1e-14);
            let gain = 1.0 + rudder.kappa * ((1.0 + 8.0 * KT / (PI * J * J)).sqrt() - 1.0);
            let textbook = rudder.epsilon * uP * (rudder.eta * gain * gain + 1.0 - rudder.eta).sqrt();
            assert_relative_eq!(hull.rudder_inflow(uP, hull.revolutions()), textbook, max_relative = 1e-12);
        }
    }

    #[test]
    fn wake_is_that_of_the_straight_approach_at_zero_angle_and_fades() {
        let exponential = Mmg::at_speed(FULL_SCALE, 8.0).expect("balances");
        let mut parameters = FULL_SCALE;
        parameters.propeller.wake = Wake::Gaussian;
        let gaussian = Mmg::at_speed(parameters, 8.0).expect("balances");
        for hull in [exponential, gaussian] {
            assert_relative_eq!(hull.wake(0.0), 0.35, max_relative = 1e-12);
            assert!(hull.wake(0.3) < 0.3 && hull.wake(-0.3) < 0.35);
        }
        // C2 = 1.6 and 1.1 at large angles: 1 - wP → 1.04 and 0.715.
        assert_relative_eq!(exponential.wake(50.0), -0.04, epsilon = 1e-12);
        assert_relative_eq!(exponential.wake(-50.0), 0.285, epsilon = 1e-12);
    }

    #[test]
    fn refuses_parameters_that_make_no_ship() {
        assert_eq!(Mmg::at_speed(FULL_SCALE, 0.0), Err(MmgError::NotPositive { symbol: "approach speed", value: 0.0 }));
        let mut draughtless = FULL_SCALE;
        draughtless.d = -1.0;
        assert_eq!(Mmg::at_speed(draughtless, 8.0), Err(MmgError::NotPositive { symbol: "d", value: -1.0 }));
        let mut thrustless = FULL_SCALE;
        thrustless.propeller.k = [-0.1, -0.2, -0.1];
        assert_eq!(Mmg::at_speed(thrustless, 8.0), Err(MmgError::NoBalance { k0: -0.1, R0: 0.022 }));
        let mut light = FULL_SCALE;
        light.hull.my = -5.0;
        assert!(matches!(Mmg::at_speed(light, 8.0), Err(MmgError::Inertia(_))));
    }
}
