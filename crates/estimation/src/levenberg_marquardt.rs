//! Nonlinear least squares between bounds by damped Gauss–Newton steps.
//!
//! J(θ) = Σ e², plus prior terms in θ, if any. The caller computes e and its exact derivatives; this module makes the
//! steps. Unknowns are scaled so that the second derivatives are 1; an unknown at its bound is held if J decreases
//! beyond the bound. Work space is allocated once per search.
//!
//! Sources: Levenberg (1944), Quarterly of Applied Mathematics 2:164-168; Marquardt (1963), Journal of the Society for
//! Industrial and Applied Mathematics 11:431-441; Moré (1978).

use nalgebra::{Cholesky, DMatrix, DVector};

/// Objective function J(θ) with its bounds and normal equations.
pub trait Objective {
    /// Lower and upper bound of an unknown.
    fn bounds(&self, unknown: usize) -> [f64; 2];

    /// Value of J at a point; not finite if the model fails.
    fn value(&mut self, at: &[f64]) -> f64;

    /// Value of J at a point; writes the normal equations. Called at the start and at every accepted point, there
    /// immediately after [`value`](Self::value), so that intermediate results of that call can be reused.
    fn linearise(&mut self, at: &[f64], normal: &mut NormalEquations) -> f64;
}

/// Normal equations at a point.
#[derive(Debug, Clone)]
pub struct NormalEquations {
    /// Matrix XᵀX with X = −∂e/∂θ: second derivatives of J/2 (Gauss–Newton).
    pub matrix: DMatrix<f64>,
    /// Right-hand side Xᵀe: first derivatives of −J/2.
    pub right_hand_side: DVector<f64>,
}

/// Settings of a search: damping schedule and stopping rules.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchSettings {
    /// Maximum number of accepted steps.
    pub max_steps: usize,
    /// Initial damping λ, relative to the second derivatives.
    pub initial_damping: f64,
    /// Factor on the damping after a step whose decrease of J is at least `trust_ratio` times the predicted decrease.
    pub damping_shrink: f64,
    /// Minimum ratio of actual to predicted decrease at which the damping is reduced.
    pub trust_ratio: f64,
    /// Factor on the damping after a step that does not reduce J.
    pub damping_growth: f64,
    /// Lower bound of the damping after an accepted step, and after a rejected step.
    pub min_damping: [f64; 2],
    /// Number of rejected steps in a row that ends a search.
    pub max_rejections: usize,
    /// Predicted decrease of J below which a search has converged.
    pub min_decrease: f64,
    /// Absolute tolerance a and relative tolerance r: a decrease of J is small if it is at most a + r J.
    pub decrease_tolerance: [f64; 2],
    /// Number of steps in a row with a small decrease at which a search has converged.
    pub max_small_steps: usize,
}

/// Reason why a search stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchEnd {
    /// Convergence: steps no longer reduce J.
    Converged,
    /// No step, however short, reduces J: a minimum to within rounding, or a kink near a minimum.
    Stalled,
    /// Maximum number of steps reached.
    StepLimit,
    /// J or its derivatives were not finite.
    NotFinite,
}

/// Result of a search: the point at which it stopped.
#[derive(Debug, Clone)]
pub struct SearchResult {
    /// Estimate θ.
    pub estimate: DVector<f64>,
    /// Value of J.
    pub objective_value: f64,
    /// Normal equations at θ.
    pub normal_equations: NormalEquations,
    /// Number of accepted steps.
    pub steps: usize,
    /// Stopping reason.
    pub end: SearchEnd,
}

/// Ridge, relative to the second derivatives, that keeps a step finite without damping.
const RIDGE: f64 = 1e-11;

impl NormalEquations {
    /// Normal equations with this number of unknowns, all zero.
    pub fn zeros(unknowns: usize) -> Self {
        Self { matrix: DMatrix::zeros(unknowns, unknowns), right_hand_side: DVector::zeros(unknowns) }
    }

    /// `true` if an unknown with this value lies at a bound, beyond which J decreases.
    pub fn is_bound_active(&self, unknown: usize, value: f64, [low, high]: [f64; 2]) -> bool {
        (value <= low && self.right_hand_side[unknown] < 0.0) || (value >= high && self.right_hand_side[unknown] > 0.0)
    }
}

/// Work space of a search.
struct StepWorkspace {
    /// Inverse square roots of the second derivatives; 1 if J does not depend on the unknown.
    scale: DVector<f64>,
    held: Vec<bool>,
    right: DVector<f64>,
    damped: DMatrix<f64>,
    step: DVector<f64>,
}

impl StepWorkspace {
    fn new(unknowns: usize) -> Self {
        let zeros = || DVector::zeros(unknowns);
        let (held, damped) = (vec![false; unknowns], DMatrix::zeros(unknowns, unknowns));
        Self { scale: zeros(), held, right: zeros(), damped, step: zeros() }
    }

    /// Scales the normal equations at a point.
    fn prepare(&mut self, problem: &impl Objective, at: &DVector<f64>, normal: &NormalEquations) {
        for k in 0..at.len() {
            let curvature = normal.matrix[(k, k)];
            self.scale[k] = if curvature > 0.0 { curvature.sqrt().recip() } else { 1.0 };
            self.held[k] = normal.is_bound_active(k, at[k], problem.bounds(k));
            self.right[k] =
                if self.held[k] || curvature <= 0.0 { 0.0 } else { normal.right_hand_side[k] * self.scale[k] };
        }
    }

    /// Computes a damped step and returns the predicted decrease of J; `None` if the damped matrix is not positive
    /// definite or the step is not finite.
    fn damped_step(&mut self, normal: &NormalEquations, damping: f64) -> Option<f64> {
        let unknowns = self.right.len();
        for j in 0..unknowns {
            for i in 0..unknowns {
                self.damped[(i, j)] = match (i == j, self.held[i] || self.held[j]) {
                    (true, _) => 1.0 + damping + RIDGE,
                    (false, true) => 0.0,
                    (false, false) => normal.matrix[(i, j)] * self.scale[i] * self.scale[j],
                };
            }
        }
        let factor = Cholesky::new(std::mem::replace(&mut self.damped, DMatrix::zeros(0, 0)));
        let Some(factor) = factor else {
            self.damped = DMatrix::zeros(unknowns, unknowns);
            return None;
        };
        self.step.copy_from(&self.right);
        factor.solve_mut(&mut self.step);
        let promise = self.step.dot(&self.right) + damping * self.step.norm_squared();
        self.step.component_mul_assign(&self.scale);
        self.damped = factor.unpack_dirty();
        self.step.iter().all(|x| x.is_finite()).then_some(promise)
    }
}

/// Local minimum of J between the bounds, searched from `start`; the search may stop before it, see [`SearchEnd`].
pub fn minimise(problem: &mut impl Objective, start: DVector<f64>, rules: &SearchSettings) -> SearchResult {
    let unknowns = start.len();
    let (mut at, mut next) = (start, DVector::zeros(unknowns));
    let mut normal = NormalEquations::zeros(unknowns);
    let mut value = problem.linearise(at.as_slice(), &mut normal);
    let mut work = StepWorkspace::new(unknowns);
    let (mut damping, mut small_steps) = (rules.initial_damping, 0);
    let mut end = if value.is_finite() { SearchEnd::StepLimit } else { SearchEnd::NotFinite };
    let mut steps = 0;
    'search: while steps < rules.max_steps && end == SearchEnd::StepLimit {
        work.prepare(problem, &at, &normal);
        let mut tries = 0;
        let lower = loop {
            if tries == rules.max_rejections {
                end = SearchEnd::Stalled;
                break 'search;
            }
            tries += 1;
            if let Some(promise) = work.damped_step(&normal, damping) {
                if promise < rules.min_decrease {
                    end = SearchEnd::Converged;
                    break 'search;
                }
                for k in 0..unknowns {
                    let [low, high] = problem.bounds(k);
                    next[k] = if work.held[k] { at[k] } else { (at[k] + work.step[k]).clamp(low, high) };
                }
                let trial = problem.value(next.as_slice());
                if trial <= value {
                    if value - trial >= rules.trust_ratio * promise {
                        damping = (damping * rules.damping_shrink).max(rules.min_damping[0]);
                    }
                    break trial;
                }
            }
            damping = (damping * rules.damping_growth).max(rules.min_damping[1]);
        };
        std::mem::swap(&mut at, &mut next);
        small_steps = if value - lower <= rules.decrease_tolerance[0] + rules.decrease_tolerance[1] * value {
            small_steps + 1
        } else {
            0
        };
        value = problem.linearise(at.as_slice(), &mut normal);
        steps += 1;
        if !value.is_finite() {
            end = SearchEnd::NotFinite;
        } else if small_steps == rules.max_small_steps {
            end = SearchEnd::Converged;
        }
    }
    SearchResult { estimate: at, objective_value: value, normal_equations: normal, steps, end }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const RULES: SearchSettings = SearchSettings {
        max_steps: 50,
        initial_damping: 1e-3,
        damping_shrink: 0.2,
        trust_ratio: 0.0,
        damping_growth: 4.0,
        min_damping: [1e-9, 0.0],
        max_rejections: 30,
        min_decrease: 1e-25,
        decrease_tolerance: [0.0, 1e-14],
        max_small_steps: 2,
    };

    /// Rosenbrock's valley as the sum of squares of 10 (y − x²) and 1 − x, with a bound on x.
    struct Valley {
        max_x: f64,
    }

    impl Objective for Valley {
        fn bounds(&self, unknown: usize) -> [f64; 2] {
            [[-2.0, self.max_x], [f64::NEG_INFINITY, f64::INFINITY]][unknown]
        }

        fn value(&mut self, at: &[f64]) -> f64 {
            (10.0 * (at[1] - at[0] * at[0])).powi(2) + (1.0 - at[0]).powi(2)
        }

        fn linearise(&mut self, at: &[f64], normal: &mut NormalEquations) -> f64 {
            let e = DVector::from_vec(vec![10.0 * (at[1] - at[0] * at[0]), 1.0 - at[0]]);
            let x = DMatrix::from_row_slice(2, 2, &[20.0 * at[0], -10.0, 1.0, 0.0]);
            normal.matrix = x.tr_mul(&x);
            normal.right_hand_side = x.tr_mul(&e);
            self.value(at)
        }
    }

    #[test]
    fn a_curved_valley_is_followed_to_its_end_and_to_a_bound() {
        let start = || DVector::from_vec(vec![-1.2, 1.0]);
        let minimum = minimise(&mut Valley { max_x: 5.0 }, start(), &RULES);
        assert_relative_eq!(minimum.estimate, DVector::from_vec(vec![1.0, 1.0]), epsilon = 1e-8);
        let minimum = minimise(&mut Valley { max_x: 0.5 }, start(), &RULES);
        assert_relative_eq!(minimum.estimate, DVector::from_vec(vec![0.5, 0.25]), epsilon = 1e-8);
        assert!(minimum.normal_equations.is_bound_active(0, minimum.estimate[0], [-2.0, 0.5]));
    }

    #[test]
    fn a_search_says_why_it_ended() {
        let start = DVector::from_vec(vec![-1.2, 1.0]);
        assert_eq!(
            minimise(&mut Valley { max_x: 5.0 }, start.clone(), &SearchSettings { max_steps: 3, ..RULES }).end,
            SearchEnd::StepLimit
        );
        let eager = SearchSettings { min_decrease: 1e9, ..RULES };
        assert_eq!(minimise(&mut Valley { max_x: 5.0 }, start, &eager).end, SearchEnd::Converged);
        let nowhere = DVector::from_vec(vec![f64::NAN, 1.0]);
        assert_eq!(minimise(&mut Valley { max_x: 5.0 }, nowhere, &RULES).end, SearchEnd::NotFinite);
    }
}
