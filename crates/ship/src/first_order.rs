//! The first-order (Nomoto) response T r' + r = K (δ + δ_r) and its closed form under a ramping rudder.
//!
//! The model is parametrised as r' = −a r + b (δ + δ_r) with a = 1/T and b = K/T. A neutrally stable hull has a = 0 and
//! a course-unstable hull a < 0; both are regular points of these parameters, while K and T pass through infinity.
//!
//! Source of the model: Nomoto, Taguchi, Honda and Hirano (1957), On the steering qualities of ships.

/// First-order response, parametrised so that T → ∞ and negative T are regular.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstOrder {
    /// a = 1/T, 1/s; negative for a course-unstable ship.
    pub inverse_T: f64,
    /// b = K/T, 1/s²; positive if the ship turns to the side of the rudder.
    pub K_over_T: f64,
    /// Rudder bias δ_r, rad: at δ = −δ_r the ship keeps r = 0.
    pub rudder_bias: f64,
}

impl FirstOrder {
    /// First-order response from the indices K (1/s), T (s) and the rudder bias δ_r (rad). `T` must not be zero.
    pub fn from_indices(K: f64, T: f64, rudder_bias: f64) -> Self {
        Self { inverse_T: 1.0 / T, K_over_T: K / T, rudder_bias }
    }

    /// Turning ability index K = b/a, 1/s; infinite for a neutrally stable ship.
    pub fn K(&self) -> f64 {
        self.K_over_T / self.inverse_T
    }

    /// Time constant T = 1/a, s; infinite for a neutrally stable ship, negative for a course-unstable ship.
    pub fn T(&self) -> f64 {
        1.0 / self.inverse_T
    }

    /// `true` if a disturbance of a straight course grows: 1/T < 0.
    pub fn is_course_unstable(&self) -> bool {
        self.inverse_T < 0.0
    }
}

/// Heading and yaw rate of a first-order ship.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct YawState {
    /// Heading ψ, rad.
    pub heading: f64,
    /// Yaw rate r, rad/s.
    pub yaw_rate: f64,
}

/// Exact transition of ψ' = r, r' = −a r + u over one interval h, for an input u that is linear in time.
///
/// r(h) = e r₀ + φ₁ u₀ + φ₂ u', ψ(h) = ψ₀ + φ₁ r₀ + φ₂ u₀ + φ₃ u', where e = exp(−a h) and
/// φₙ(h) = ∫₀ʰ φₙ₋₁, φ₀ = exp(−a t). Regular at a = 0; h may be negative (a step back in time).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstOrderTransition {
    /// Duration of the interval, s.
    pub time_step: f64,
    /// exp(−a h).
    pub decay: f64,
    /// φ₁, s.
    pub phi1: f64,
    /// φ₂, s².
    pub phi2: f64,
    /// φ₃, s³.
    pub phi3: f64,
}

/// Decay exp(−x), and fₙ(x) = Σ (−x)^k / (k+n)! over k = 0, 1, … for n = 1 to 4, without cancellation near x = 0: the
/// remainder of the series of exp(−x) after n terms, over (−x)ⁿ.
fn tails(x: f64) -> (f64, [f64; 4]) {
    if x.abs() < 1.0 {
        // f₄(x) = Σ (−x)^k / (k+4)!, then down by fₙ = 1/n! − x fₙ₊₁.
        let mut term = 1.0 / 24.0;
        let mut f4 = term;
        for k in 1..=18 {
            term *= -x / (k as f64 + 4.0);
            f4 += term;
        }
        let f3 = 1.0 / 6.0 - x * f4;
        let f2 = 0.5 - x * f3;
        let f1 = 1.0 - x * f2;
        (1.0 - x * f1, [f1, f2, f3, f4])
    } else {
        let decay = (-x).exp();
        let f1 = (1.0 - decay) / x;
        let f2 = (1.0 - f1) / x;
        let f3 = (0.5 - f2) / x;
        let f4 = (1.0 / 6.0 - f3) / x;
        (decay, [f1, f2, f3, f4])
    }
}

impl FirstOrderTransition {
    /// Transition over `h` seconds for a = `inverse_T` (1/s).
    pub fn new(inverse_T: f64, h: f64) -> Self {
        let (decay, [f1, f2, f3, _]) = tails(inverse_T * h);
        Self { time_step: h, decay, phi1: h * f1, phi2: h * h * f2, phi3: h * h * h * f3 }
    }

    /// State after the interval, for the input u₀ + u' t (rad/s², rad/s³).
    #[inline]
    pub fn advance(&self, state: YawState, u0: f64, slope: f64) -> YawState {
        YawState {
            // The input terms are summed first: they are independent of the state, which shortens the chain of
            // operations.
            heading: state.heading + (self.phi1 * state.yaw_rate + (self.phi2 * u0 + self.phi3 * slope)),
            yaw_rate: self.decay * state.yaw_rate + (self.phi1 * u0 + self.phi2 * slope),
        }
    }
}

/// [`FirstOrderTransition`] with its derivative with respect to a, for exact sensitivities of the response to 1/T.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentTransition {
    /// Transition.
    pub value: FirstOrderTransition,
    /// Derivative with respect to a = 1/T (`h` holds no derivative and is zero).
    pub by_inverse_T: FirstOrderTransition,
}

impl TangentTransition {
    /// Transition and derivative over `h` seconds for a = `inverse_T` (1/s).
    pub fn new(inverse_T: f64, h: f64) -> Self {
        let (decay, [f1, f2, f3, f4]) = tails(inverse_T * h);
        // fₙ' = n fₙ₊₁ − fₙ, and ∂φₙ/∂a = h^(n+1) fₙ'.
        let h2 = h * h;
        Self {
            value: FirstOrderTransition { time_step: h, decay, phi1: h * f1, phi2: h2 * f2, phi3: h2 * h * f3 },
            by_inverse_T: FirstOrderTransition {
                time_step: 0.0,
                decay: -h * decay,
                phi1: h2 * (f2 - f1),
                phi2: h2 * h * (2.0 * f3 - f2),
                phi3: h2 * h2 * (3.0 * f4 - f3),
            },
        }
    }

    /// Sensitivity (∂ψ/∂a, ∂r/∂a) after the interval, from `state` and its sensitivity before the interval.
    #[inline]
    pub fn advance(&self, state: YawState, sensitivity: YawState, u0: f64, slope: f64) -> YawState {
        let (f, d) = (&self.value, &self.by_inverse_T);
        YawState {
            heading: sensitivity.heading
                + (f.phi1 * sensitivity.yaw_rate + (d.phi1 * state.yaw_rate + (d.phi2 * u0 + d.phi3 * slope))),
            yaw_rate: f.decay * sensitivity.yaw_rate + (d.decay * state.yaw_rate + (d.phi1 * u0 + d.phi2 * slope)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Closed forms for an instantaneous rudder, A = K δ (Nomoto 1957; re-derived).
    #[test]
    fn step_response_is_the_textbook_exponential() {
        let (K, T, delta) = (0.1, 16.3, 0.2);
        let ship = FirstOrder::from_indices(K, T, 0.0);
        let A = K * delta;
        for t in [0.1, 1.0, 16.3, 200.0] {
            let end =
                FirstOrderTransition::new(ship.inverse_T, t).advance(YawState::default(), ship.K_over_T * delta, 0.0);
            assert_relative_eq!(end.yaw_rate, A * (1.0 - (-t / T).exp()), max_relative = 1e-12);
            assert_relative_eq!(end.heading, A * (t - T * (1.0 - (-t / T).exp())), max_relative = 1e-11);
        }
    }

    #[test]
    fn one_step_equals_many_for_any_sign_of_T() {
        for a in [0.3, 0.061, 1e-9, 0.0, -1e-9, -0.02, -0.3] {
            let start = YawState { heading: 0.1, yaw_rate: -0.01 };
            let (u0, slope, t) = (2e-3, 3e-4, 7.0);
            let once = FirstOrderTransition::new(a, t).advance(start, u0, slope);
            let piece = FirstOrderTransition::new(a, t / 70.0);
            let mut many = start;
            for k in 0..70 {
                many = piece.advance(many, u0 + slope * k as f64 * piece.time_step, slope);
            }
            assert_relative_eq!(once.heading, many.heading, max_relative = 1e-12);
            assert_relative_eq!(once.yaw_rate, many.yaw_rate, max_relative = 1e-12);
            let back = FirstOrderTransition::new(a, -t).advance(once, u0 + slope * t, slope);
            assert_relative_eq!(back.heading, start.heading, max_relative = 1e-9);
        }
    }

    #[test]
    fn sensitivity_is_the_derivative() {
        for a in [0.3, 0.061, 0.0, -0.05] {
            let start = YawState { heading: 0.1, yaw_rate: -0.01 };
            let (u0, slope, h) = (2e-3, 3e-4, 3.0);
            let da = 1e-6;
            let hi = FirstOrderTransition::new(a + da, h).advance(start, u0, slope);
            let lo = FirstOrderTransition::new(a - da, h).advance(start, u0, slope);
            let exact = TangentTransition::new(a, h).advance(start, YawState::default(), u0, slope);
            assert_relative_eq!(exact.heading, (hi.heading - lo.heading) / (2.0 * da), max_relative = 1e-7);
            assert_relative_eq!(exact.yaw_rate, (hi.yaw_rate - lo.yaw_rate) / (2.0 * da), max_relative = 1e-7);
        }
    }

    #[test]
    fn an_unstable_ship_keeps_its_sign() {
        let tanker = FirstOrder::from_indices(-0.019, -124.1, 0.0);
        assert!(tanker.is_course_unstable() && tanker.K_over_T > 0.0);
        assert_relative_eq!(tanker.K(), -0.019, max_relative = 1e-12);
    }
}
