//! Estimate of a method: the response, its uncertainty, and the reason for stopping.

use std::cell::Cell;

use document::{HeadingNoise, Warning};
use nalgebra::{Matrix3, Vector3};
use ship::FirstOrder;
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};
use trial::Quantity;

/// Reason why a method stopped, from best to worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum StopReason {
    /// The estimate comes from a closed formula.
    Direct,
    /// An iteration converged within its tolerance.
    Converged,
    /// The maximum number of iterations was reached; the best point is returned.
    IterationLimit,
    /// The best point lies at the end of the searched range.
    RangeLimit,
    /// Outside estimator, which reports no reason.
    Outside,
}

impl StopReason {
    /// All reasons.
    pub const ALL: [Self; 5] = [Self::Direct, Self::Converged, Self::IterationLimit, Self::RangeLimit, Self::Outside];

    /// Name used in tables and JSON.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Direct => "direct",
            Self::Converged => "converged",
            Self::IterationLimit => "iteration-limit",
            Self::RangeLimit => "range-limit",
            Self::Outside => "outside",
        }
    }
}

/// Covariance of (1/T, K/T, δ_r), units 1/s, 1/s², rad, with degrees of freedom.
#[derive(Debug, Clone, PartialEq)]
pub struct Covariance {
    /// Covariance matrix, 3 × 3.
    pub matrix: Matrix3<f64>,
    /// Degrees of freedom of the noise variance; `None` for a given variance.
    pub degrees_of_freedom: Option<f64>,
}

/// Uncertainty of an estimate.
#[derive(Debug, Clone, PartialEq)]
pub enum Uncertainty {
    /// Covariance of the parameters.
    Covariance(Covariance),
    /// Intervals that do not come from a covariance.
    Intervals {
        /// 95 % interval of K, 1/s.
        K: [f64; 2],
        /// 95 % interval of T, s.
        T: [f64; 2],
        /// 95 % interval of δ_r, rad.
        rudder_bias: [f64; 2],
        /// Meaning of the intervals, as text.
        meaning: &'static str,
    },
    /// No uncertainty is estimated.
    None {
        /// Reason, as text.
        reason: &'static str,
    },
}

/// Estimate of the first-order response T r' + r = K (δ + δ_r) from one or several trials of a ship, with uncertainty.
///
/// Parameters: 1/T (1/s), K/T (1/s²), δ_r (rad). [`K`](Self::K) and [`T`](Self::T) are infinite for a neutrally stable
/// ship and negative for a course-unstable ship.
///
/// ```
/// use kempf_identify::{Identifier, output_error};
/// # let mut table = String::from("t_s,heading_deg,rudder_deg\n");
/// # let (mut psi, mut r, mut delta) = (0.0_f64, 0.0_f64, 10.0_f64);
/// # for t in 0..300 {
/// #     table += &format!("{t},{psi},{delta}\n");
/// #     for _ in 0..100 {
/// #         r += 0.01 * (0.1 * delta - r) / 16.0;
/// #         psi += 0.01 * r;
/// #     }
/// #     delta = if psi * delta.signum() > 10.0 { -delta } else { delta };
/// # }
/// # let read = trial::reader::read_from_reader("run.csv".as_ref(), table.as_bytes(), None, None)?;
/// let estimate = output_error::Settings::default().build()?.identify(&[read.trial])?;
/// let [low, high] = estimate.T().ci95.expect("output error has an interval");
/// assert!(low < estimate.T().value && estimate.T().value < high);
/// assert!((estimate.K().value - 0.1).abs() < 0.005, "the rudder that jumps is read as one that moves for a second");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Estimated 1/T, K/T and δ_r.
    pub response: FirstOrder,
    /// Uncertainty of the response, valid if the residual is white.
    pub uncertainty: Uncertainty,
    /// Covariance valid for a coloured residual as well (Newey and West 1987); `None` if the method has none.
    pub robust_covariance: Option<Covariance>,
    /// Reason why the method stopped.
    pub stop: StopReason,
    /// Number of model evaluations (simulations or solved systems).
    pub evaluations: usize,
    /// Heading noise of the first record; `None` if the method estimates no random moment.
    pub noise: Option<HeadingNoise>,
    /// Named diagnostics: fit R², condition numbers, counts; the unit is in the name.
    pub diagnostics: Vec<(&'static str, f64)>,
    /// Warnings shown next to the estimate; they do not name the method.
    pub warnings: Vec<Warning>,
}

impl Estimate {
    /// Diagnostic of this name; `None` if the method has none.
    pub fn diagnostic(&self, name: &str) -> Option<f64> {
        self.diagnostics.iter().find(|(label, _)| *label == name).map(|(_, value)| *value)
    }

    /// Turning ability index K, 1/s, with standard deviation and 95 % interval; each is `None` if it is not estimated
    /// or not bounded.
    pub fn K(&self) -> Quantity {
        match &self.uncertainty {
            Uncertainty::Covariance(covariance) => index_K(&self.response, covariance),
            Uncertainty::Intervals { K, .. } => with_error(self.response.K(), None, Some(*K)),
            Uncertainty::None { .. } => Quantity::without_uncertainty(self.response.K()),
        }
    }

    /// Time constant T, s, with standard deviation and 95 % interval; each is `None` if it is not estimated or not
    /// bounded.
    pub fn T(&self) -> Quantity {
        match &self.uncertainty {
            Uncertainty::Covariance(covariance) => index_T(&self.response, covariance),
            Uncertainty::Intervals { T, .. } => with_error(self.response.T(), None, Some(*T)),
            Uncertainty::None { .. } => Quantity::without_uncertainty(self.response.T()),
        }
    }

    /// Rudder bias δ_r, rad, with standard deviation and 95 % interval; each is `None` if it is not estimated or not
    /// bounded.
    pub fn rudder_bias(&self) -> Quantity {
        let value = self.response.rudder_bias;
        match &self.uncertainty {
            Uncertainty::Covariance(covariance) => bias(&self.response, covariance),
            Uncertainty::Intervals { rudder_bias, .. } => with_error(value, None, Some(*rudder_bias)),
            Uncertainty::None { .. } => Quantity::without_uncertainty(value),
        }
    }
}

impl Covariance {
    /// K (1/s) and T (s) of a response, with standard deviations and 95 % intervals from this covariance.
    pub fn indices(&self, response: &FirstOrder) -> (Quantity, Quantity) {
        (index_K(response, self), index_T(response, self))
    }

    /// Two-sided 95 % quantile: Student's t for an estimated noise variance, normal for a given variance.
    pub fn quantile95(&self) -> f64 {
        // All quantities of an estimate share this quantile.
        thread_local!(static LAST: Cell<Option<(Option<f64>, f64)>> = const { Cell::new(None) });
        match LAST.get() {
            Some((freedom, quantile)) if freedom == self.degrees_of_freedom => quantile,
            _ => {
                let quantile = quantile95(self.degrees_of_freedom);
                LAST.set(Some((self.degrees_of_freedom, quantile)));
                quantile
            }
        }
    }

    /// Outline of the joint 95 % region of K (1/s) and T (s), closed: the image of the ellipse of 1/T and K/T, which is
    /// curved if the uncertainty is large.
    ///
    /// (a, b)ᵀ = (1/T, K/T)ᵀ + √q L u with the Cholesky factor L of their covariance, u on the unit circle and q = ν
    /// (0.05^(−2/ν) − 1), which is 2 F₀.₉₅(2, ν), −2 ln 0.05 for a given variance. `None` if the region of 1/T contains
    /// zero, so that T is unbounded, or if the variance of 1/T is zero or not finite.
    pub fn joint_region_outline(&self, response: &FirstOrder) -> Option<Vec<[f64; 2]>> {
        const CORNERS: usize = 120;
        let exceedance: f64 = 0.05;
        let q = match self.degrees_of_freedom {
            Some(freedom) => freedom * (exceedance.powf(-2.0 / freedom) - 1.0),
            None => -2.0 * exceedance.ln(),
        };
        let m = &self.matrix;
        let l11 = m[(0, 0)].sqrt();
        let l21 = m[(1, 0)] / l11;
        let l22 = (m[(1, 1)] - l21 * l21).max(0.0).sqrt();
        let reach = q.sqrt() * l11;
        if !(l11 > 0.0 && l21.is_finite() && l22.is_finite() && reach < response.inverse_T.abs()) {
            return None;
        }
        let corner = |k: usize| {
            let (sine, cosine) = (2.0 * std::f64::consts::PI * k as f64 / CORNERS as f64).sin_cos();
            let a = response.inverse_T + q.sqrt() * l11 * cosine;
            let b = response.K_over_T + q.sqrt() * (l21 * cosine + l22 * sine);
            [b / a, a.recip()]
        };
        Some((0..=CORNERS).map(corner).collect())
    }
}

/// Two-sided 95 % quantile of Student's t, or of the normal distribution without degrees of freedom.
fn quantile95(degrees_of_freedom: Option<f64>) -> f64 {
    let normal = || Normal::standard().inverse_cdf(0.975);
    match degrees_of_freedom {
        Some(freedom) => StudentsT::new(0.0, 1.0, freedom).map_or_else(|_| normal(), |t| t.inverse_cdf(0.975)),
        None => normal(),
    }
}

/// Quantity with its standard deviation and interval; either is `None` if it is not finite.
fn with_error(value: f64, sd: Option<f64>, ci95: Option<[f64; 2]>) -> Quantity {
    let ci95 = ci95.filter(|ends| ends.iter().all(|end| end.is_finite()));
    Quantity { value, sd: sd.filter(|sd| sd.is_finite()), ci95 }
}

/// K = b/a with the delta-method standard deviation and Fieller's interval (Fieller 1954), unbounded if the interval of
/// a = 1/T contains zero.
fn index_K(response: &FirstOrder, covariance: &Covariance) -> Quantity {
    let (a, b) = (response.inverse_T, response.K_over_T);
    let value = response.K();
    let gradient = Vector3::new(-b / (a * a), 1.0 / a, 0.0);
    let sd = gradient.dot(&(covariance.matrix * gradient)).max(0.0).sqrt();
    let m = &covariance.matrix;
    let z2 = covariance.quantile95().powi(2);
    // (b − K a)² = z² (s_bb − 2 K s_ab + K² s_aa), a quadratic in K.
    let (p, q, c) = (a * a - z2 * m[(0, 0)], a * b - z2 * m[(0, 1)], b * b - z2 * m[(1, 1)]);
    let root = (q * q - p * c).max(0.0).sqrt();
    let ci95 = (p > 0.0 && value.is_finite()).then(|| [(q - root) / p, (q + root) / p]);
    with_error(value, Some(sd), ci95)
}

/// T = 1/a with the delta-method standard deviation and the reciprocal of the interval of a.
fn index_T(response: &FirstOrder, covariance: &Covariance) -> Quantity {
    let a = response.inverse_T;
    let sd_a = covariance.matrix[(0, 0)].max(0.0).sqrt();
    let reach = covariance.quantile95() * sd_a;
    let ci95 = (reach < a.abs()).then(|| [1.0 / (a + reach), 1.0 / (a - reach)]);
    let sd = sd_a / (a * a);
    with_error(response.T(), Some(sd), ci95)
}

/// δ_r = (b δ_r)/b with the delta-method standard deviation and Fieller's interval, unbounded if the interval of b =
/// K/T contains zero: a rudder without effect has no bias. A variance of zero gives a value without error.
fn bias(response: &FirstOrder, covariance: &Covariance) -> Quantity {
    let (b, value) = (response.K_over_T, response.rudder_bias);
    let m = &covariance.matrix;
    if m[(2, 2)] == 0.0 {
        return Quantity::without_uncertainty(value);
    }
    let z2 = covariance.quantile95().powi(2);
    // (x b)² = z² (b² s_δδ − 2 x b s_bδ + x² s_bb), a quadratic in the distance x from the estimate.
    let (p, q, c) = (b * b - z2 * m[(1, 1)], -z2 * b * m[(1, 2)], -z2 * b * b * m[(2, 2)]);
    let root = (q * q - p * c).max(0.0).sqrt();
    let ci95 = (p > 0.0 && value.is_finite()).then(|| [value + (q - root) / p, value + (q + root) / p]);
    let sd = m[(2, 2)].max(0.0).sqrt();
    with_error(value, Some(sd), ci95)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn covariance(sd_a: f64, sd_b: f64) -> Covariance {
        Covariance {
            matrix: Matrix3::from_diagonal(&Vector3::new(sd_a * sd_a, sd_b * sd_b, 1e-8)),
            degrees_of_freedom: None,
        }
    }

    #[test]
    fn small_errors_give_symmetric_intervals() {
        let response = FirstOrder::from_indices(0.1, 16.3, 0.0);
        let covariance = covariance(1e-6, 1e-9);
        let T = index_T(&response, &covariance);
        let sd = T.sd.expect("a covariance gives a standard deviation");
        let [lo, hi] = T.ci95.expect("bounded");
        assert_relative_eq!(hi - lo, 2.0 * 1.959964 * sd, max_relative = 1e-3);
        let K = index_K(&response, &covariance);
        let [lo, hi] = K.ci95.expect("bounded");
        assert_relative_eq!(0.5 * (lo + hi), 0.1, max_relative = 1e-6);
    }

    /// A precise estimate has the ellipse of the delta method; an estimate that may be neutrally stable has no outline.
    #[test]
    fn the_outline_is_an_ellipse_where_errors_are_small() {
        let response = FirstOrder::from_indices(0.1, 16.3, 0.0);
        let small = covariance(1e-5, 1e-6);
        let outline = small.joint_region_outline(&response).expect("bounded");
        let half = |part: usize| {
            let coordinates = || outline.iter().map(|place| place[part]);
            0.5 * (coordinates().fold(f64::MIN, f64::max) - coordinates().fold(f64::MAX, f64::min))
        };
        let sd = [index_K(&response, &small), index_T(&response, &small)].map(|index| index.sd.expect("a covariance"));
        for (part, sd) in sd.into_iter().enumerate() {
            assert_relative_eq!(half(part), 5.991465f64.sqrt() * sd, max_relative = 2e-3);
        }
        assert_eq!(outline[0], outline[outline.len() - 1]);
        assert_eq!(covariance(0.04, 1e-6).joint_region_outline(&response), None);
        let few = Covariance { degrees_of_freedom: Some(10.0), ..small };
        let wider = few.joint_region_outline(&response).expect("bounded")[0][1] - response.T();
        // 2 F₀.₉₅(2, 10) = 8.2056.
        assert_relative_eq!(wider / (outline[0][1] - response.T()), (8.2056f64 / 5.9915).sqrt(), max_relative = 2e-3);
    }

    /// Both ends of the interval of δ_r solve the equation of Fieller (1954) for the ratio of b δ_r to b, and there are
    /// none if b may be zero.
    #[test]
    fn the_bias_of_a_rudder_that_hardly_acts_is_unbounded() {
        let response = FirstOrder { inverse_T: 0.06, K_over_T: 6e-3, rudder_bias: 0.02 };
        let with_rudder_sd = |sd_b: f64| {
            let mut covariance = covariance(1e-3, sd_b);
            let cross = -0.3 * sd_b * covariance.matrix[(2, 2)].sqrt();
            (covariance.matrix[(1, 2)], covariance.matrix[(2, 1)]) = (cross, cross);
            covariance
        };
        let hardly = with_rudder_sd(2e-3);
        let b = response.K_over_T;
        let Quantity { value, ci95, .. } = bias(&response, &hardly);
        let m = &hardly.matrix;
        for end in ci95.expect("b is three standard deviations from zero") {
            let x = end - value;
            let variance = b * b * m[(2, 2)] - 2.0 * x * b * m[(1, 2)] + x * x * m[(1, 1)];
            assert_relative_eq!((x * b).powi(2), 1.959964f64.powi(2) * variance, max_relative = 1e-5);
        }
        assert_eq!(bias(&response, &with_rudder_sd(4e-3)).ci95, None);
        let [lo, hi] = bias(&response, &with_rudder_sd(1e-6)).ci95.expect("bounded");
        assert_relative_eq!(hi - lo, 2.0 * 1.959964 * 1e-4, max_relative = 1e-3);
    }

    #[test]
    fn a_neutrally_stable_ship_has_no_bounded_interval_of_T() {
        let response = FirstOrder { inverse_T: 1e-6, K_over_T: 3e-4, rudder_bias: 0.0 };
        assert_eq!(index_T(&response, &covariance(1e-4, 1e-6)).ci95, None);
        assert_eq!(index_K(&response, &covariance(1e-4, 1e-6)).ci95, None);
    }
}
