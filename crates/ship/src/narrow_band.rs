//! Narrow-band random heading from first-order waves: a damped oscillator driven by white noise, discretised exactly.
//!
//! Source: the shaping filter for wave-induced yaw of Fossen (2011), Handbook of Marine Craft Hydrodynamics and Motion
//! Control; here with its exact discrete transition.

/// Stationary narrow-band process ξ'' + 2ζω₀ ξ' + ω₀² ξ = w with standard deviation σ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NarrowBandProcess {
    /// Standard deviation σ of ξ, rad.
    pub sd: f64,
    /// Encounter frequency ω₀, rad/s.
    pub frequency: f64,
    /// Relative damping ζ, between 0 and 1.
    pub damping: f64,
}

/// Exact transition of a [`NarrowBandProcess`] process over one step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NarrowBandStep {
    transition: [[f64; 2]; 2],
    /// Lower Cholesky factor of the covariance added in one step.
    factor: [[f64; 2]; 2],
}

impl NarrowBandProcess {
    /// Stationary standard deviations of ξ (rad) and ξ' (rad/s); the two are independent at one instant.
    pub fn stationary_sd(&self) -> [f64; 2] {
        [self.sd, self.sd * self.frequency]
    }

    /// Transition over `h` seconds.
    pub fn step(&self, h: f64) -> NarrowBandStep {
        let (w0, zeta) = (self.frequency, self.damping);
        let wd = w0 * (1.0 - zeta * zeta).sqrt();
        let e = (-zeta * w0 * h).exp();
        let (c, s) = ((wd * h).cos(), (wd * h).sin());
        let ratio = zeta * w0 / wd;
        let transition = [[e * (c + ratio * s), e * s / wd], [-e * w0 * w0 * s / wd, e * (c - ratio * s)]];
        // Stationary covariance P = diag(σ², σ²ω₀²); the covariance added in a step is P − Φ P Φᵀ.
        let [p0, p1] = self.stationary_sd().map(|sd| sd * sd);
        let [[f00, f01], [f10, f11]] = transition;
        let q00 = (p0 - f00 * f00 * p0 - f01 * f01 * p1).max(0.0);
        let q01 = -(f00 * f10 * p0 + f01 * f11 * p1);
        let q11 = (p1 - f10 * f10 * p0 - f11 * f11 * p1).max(0.0);
        let l00 = q00.sqrt();
        let l10 = if l00 > 0.0 { q01 / l00 } else { 0.0 };
        let l11 = (q11 - l10 * l10).max(0.0).sqrt();
        NarrowBandStep { transition, factor: [[l00, 0.0], [l10, l11]] }
    }
}

impl NarrowBandStep {
    /// (ξ, ξ') after the step, given two independent standard normal numbers.
    #[inline]
    pub fn advance(&self, state: [f64; 2], draw: [f64; 2]) -> [f64; 2] {
        let (f, l) = (&self.transition, &self.factor);
        [
            f[0][0] * state[0] + f[0][1] * state[1] + l[0][0] * draw[0],
            f[1][0] * state[0] + f[1][1] * state[1] + l[1][0] * draw[0] + l[1][1] * draw[1],
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn two_half_steps_are_one_step() {
        let waves = NarrowBandProcess { sd: 0.4, frequency: 0.6, damping: 0.1 };
        let (half, whole) = (waves.step(0.5), waves.step(1.0));
        let start = [0.3, -0.1];
        let twice = half.advance(half.advance(start, [0.0; 2]), [0.0; 2]);
        let once = whole.advance(start, [0.0; 2]);
        assert_relative_eq!(twice[0], once[0], max_relative = 1e-12);
        assert_relative_eq!(twice[1], once[1], max_relative = 1e-12);
    }
}
