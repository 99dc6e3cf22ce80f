//! Indices K, T1, T2, T3 of the second-order response, from the linear sway-yaw equations of a hull.
//!
//! The equations M ν' + N ν = b δ, ν = (v, r), are in a prime system (length L, speed U, time L/U); the indices follow
//! by elimination of the sway velocity v. They hold for infinitesimal motion at approach speed; a zig-zag trial of
//! finite amplitude does not reproduce them.
//!
//! Source: Nomoto, Taguchi, Honda and Hirano (1957), On the steering qualities of ships; the elimination is re-derived.

use thiserror::Error;

use crate::particulars::Particulars;

/// Error of linear equations that have no indices K, T1, T2, T3.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum LinearError {
    /// Determinant of the damping matrix that is zero or not finite; at zero the hull is neutrally stable, and K and T1
    /// are infinite.
    #[error("the hull is neutrally stable (det N = {0}): K and T1 are infinite")]
    NeutrallyStable(f64),
    /// Mass matrix that is not positive definite or not finite, given by its determinant.
    #[error("the mass matrix needs positive inertia and a positive determinant, found det M = {0}")]
    Mass(f64),
    /// Sway and yaw oscillate: T1 and T2 are complex.
    #[error("T1 and T2 are complex: their sum is {sum} and their product {product}")]
    Oscillatory {
        /// T1' + T2'.
        sum: f64,
        /// T1' T2'.
        product: f64,
    },
    /// No steering: a steady rudder does not turn the ship, so K is zero and T3 undefined. Also for
    /// coefficients that are not finite.
    #[error("a steady rudder causes no yaw rate: K = 0 and T3 is undefined")]
    NoSteering,
}

/// Linear equations of sway and yaw in a prime system: M ν' + N ν = b δ, ν = (v', r').
///
/// N holds the centrifugal terms (m' + m_x', x_G' m'). The rudder is positive to starboard, so b₂ > 0 and b₁ < 0 for a
/// stern rudder. A common factor of a row, such as ½ρL² or ½ρLd, cancels in the indices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrimeSwayYawMatrices {
    /// Mass and added mass.
    pub M: [[f64; 2]; 2],
    /// Damping.
    pub N: [[f64; 2]; 2],
    /// Rudder force and moment per radian.
    pub b: [f64; 2],
}

/// Nondimensional indices K' = K L/U and T' = T U/L.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrimeNomotoIndices {
    /// Turning ability K'.
    pub K: f64,
    /// T1', the time constant of course stability (negative for a course-unstable ship).
    pub T1: f64,
    /// T2', the second time constant.
    pub T2: f64,
    /// T3', the time constant of the rudder rate.
    pub T3: f64,
}

/// Indices of T1 T2 r'' + (T1 + T2) r' + r = K δ + K T3 δ'.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecondOrderNomotoIndices {
    /// Turning ability K, 1/s.
    pub K: f64,
    /// T1, s; negative for a course-unstable ship.
    pub T1: f64,
    /// T2, s.
    pub T2: f64,
    /// T3, s.
    pub T3: f64,
}

fn det(m: &[[f64; 2]; 2]) -> f64 {
    m[0][0] * m[1][1] - m[0][1] * m[1][0]
}

impl PrimeSwayYawMatrices {
    /// Indices K', T1', T2', T3' of these equations.
    ///
    /// T1 T2 = det M / det N, T1 + T2 = (n11 m22 + n22 m11 − n12 m21 − n21 m12) / det N,
    /// K = (n11 b2 − n21 b1) / det N, T3 = (m11 b2 − m21 b1) / (n11 b2 − n21 b1).
    ///
    /// T1 is the time constant of larger magnitude if both have one sign, and the negative time constant if the signs
    /// differ (det N < 0: the ship is course-unstable, K and T1 are negative). Fails for a neutrally stable hull, a
    /// mass matrix that is not positive definite, an oscillating hull and a hull that a steady rudder does not turn.
    pub fn indices(&self) -> Result<PrimeNomotoIndices, LinearError> {
        let Self { M, N, b } = self;
        let (det_M, det_N) = (det(M), det(N));
        if !(det_M > 0.0 && M[0][0] > 0.0 && det_M.is_finite()) {
            return Err(LinearError::Mass(det_M));
        }
        if det_N == 0.0 || !det_N.is_finite() {
            return Err(LinearError::NeutrallyStable(det_N));
        }
        let product = det_M / det_N;
        let sum = (N[0][0] * M[1][1] + N[1][1] * M[0][0] - N[0][1] * M[1][0] - N[1][0] * M[0][1]) / det_N;
        let quarter = 0.25 * sum * sum - product;
        if quarter.is_nan() || quarter < 0.0 {
            return Err(LinearError::Oscillatory { sum, product });
        }
        // The root of larger size first; the second root from the product, without cancellation.
        let large = 0.5 * sum + quarter.sqrt().copysign(sum);
        let small = product / large;
        let (T1, T2) = if product < 0.0 { (large.min(small), large.max(small)) } else { (large, small) };
        let steering = N[0][0] * b[1] - N[1][0] * b[0];
        if steering == 0.0 || !steering.is_finite() {
            return Err(LinearError::NoSteering);
        }
        Ok(PrimeNomotoIndices { K: steering / det_N, T1, T2, T3: (M[0][0] * b[1] - M[1][0] * b[0]) / steering })
    }
}

impl PrimeNomotoIndices {
    /// Dimensional indices of a ship of this length at this speed: K = K' U/L (1/s), T = T' L/U (s).
    pub fn to_dimensional(&self, particulars: Particulars) -> SecondOrderNomotoIndices {
        let unit = particulars.length / particulars.speed;
        SecondOrderNomotoIndices { K: self.K / unit, T1: self.T1 * unit, T2: self.T2 * unit, T3: self.T3 * unit }
    }
}

impl SecondOrderNomotoIndices {
    /// T1 + T2 − T3, s: the time constant of the first-order response at low frequency.
    ///
    /// It is the limit of slow steering only. A first-order response fitted to a 10/10 zig-zag has neither this T nor
    /// this K: for (T1, T2, T3) = (20, 2.5, 6.2) s the best fit is 12 % low in K and 18 % low in T, for
    /// (25, 4, 12.7) s 18 % and 35 %. The ratio K/T is 7 % and 26 % high.
    pub fn first_order_T(&self) -> f64 {
        self.T1 + self.T2 - self.T3
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sway-yaw part of the S175 container ship (Son and Nomoto 1982).
    const S175: PrimeSwayYawMatrices = PrimeSwayYawMatrices {
        M: [[0.01497, 0.000_352_5], [0.000_352_5, 0.000_875]],
        N: [[0.012_035, 0.005_22], [0.003_843_6, 0.002_43]],
        b: [-0.002_578, 0.001_26],
    };

    /// Free motion of M ν' + N ν = 0: it must decay or grow as exp(−t/T1) and exp(−t/T2), for either sign.
    #[test]
    fn time_constants_are_roots_of_the_free_motion_for_stable_and_unstable_hulls() {
        for n12 in [0.005_22, 0.0070, 0.0078, 0.012] {
            let mut hull = S175;
            hull.N[0][1] = n12;
            let unstable = det(&hull.N) < 0.0;
            let prime = hull.indices().expect("regular");
            assert_eq!(prime.T1 < 0.0, unstable, "T1 = {}", prime.T1);
            assert_eq!(prime.K < 0.0, unstable);
            assert!(prime.T2 > 0.0);
            for T in [prime.T1, prime.T2] {
                let mut free = hull.N;
                for (row, mass) in free.iter_mut().zip(&hull.M) {
                    for (n, m) in row.iter_mut().zip(mass) {
                        *n -= m / T;
                    }
                }
                let size = (free[0][0] * free[1][1]).abs();
                assert!(det(&free).abs() < 1e-9 * size, "T = {T}: {} of {size}", det(&free));
            }
        }
    }

    #[test]
    fn refuses_equations_without_indices() {
        let neutral = PrimeSwayYawMatrices { N: [[2.0, 1.0], [4.0, 2.0]], ..S175 };
        assert_eq!(neutral.indices(), Err(LinearError::NeutrallyStable(0.0)));
        let massless = PrimeSwayYawMatrices { M: [[0.0, 0.0], [0.0, 0.0]], ..S175 };
        assert_eq!(massless.indices(), Err(LinearError::Mass(0.0)));
        let swinging =
            PrimeSwayYawMatrices { M: [[1.0, 0.0], [0.0, 1.0]], N: [[0.1, 1.0], [-1.0, 0.1]], b: [0.0, 1.0] };
        assert!(matches!(swinging.indices(), Err(LinearError::Oscillatory { .. })));
        let adrift = PrimeSwayYawMatrices { b: [0.0, 0.0], ..S175 };
        assert_eq!(adrift.indices(), Err(LinearError::NoSteering));
    }
}
