//! Least squares between bounds by damped Gauss–Newton steps (Levenberg 1944; Marquardt 1963; Moré 1978).
//!
//! J(θ) = Σ e², with terms of what is expected of θ where there are any. The caller knows e and its exact derivatives;
//! here are the steps. Every unknown is measured in units in which its second derivative is one; an unknown at its
//! bound whose gradient points beyond stays there. Work space is allocated once a search.

use nalgebra::{Cholesky, DMatrix, DVector};

/// What is minimised.
pub trait Objective {
    /// Least and largest value of an unknown.
    fn bounds(&self, unknown: usize) -> [f64; 2];

    /// J at a point; anything but a finite number where the model has no answer.
    fn value(&mut self, at: &[f64]) -> f64;

    /// Fills in the normal equations, and returns J. It is asked for at the start and at every accepted point, then
    /// straight after [`value`](Self::value), so that what was computed there can be used.
    fn linearise(&mut self, at: &[f64], normal: &mut Normal) -> f64;
}

/// Normal equations at a point.
#[derive(Debug, Clone)]
pub struct Normal {
    /// XᵀX with X = −∂e/∂θ: second derivatives of J/2.
    pub matrix: DMatrix<f64>,
    /// Xᵀe: first derivatives of −J/2.
    pub gradient: DVector<f64>,
}

/// How damping follows the success of steps, and when a search ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rules {
    /// Most accepted steps.
    pub steps: usize,
    /// First damping, as a share of the second derivatives.
    pub damping: f64,
    /// Factor of the damping after a step that lowers J by more than `trusted` of what it promised.
    pub shrink: f64,
    /// See [`Self::shrink`].
    pub trusted: f64,
    /// Factor of the damping after a step that does not lower J.
    pub grow: f64,
    /// Least damping after success, and after failure.
    pub least: [f64; 2],
    /// Dampings in a row without a lower J that end a search.
    pub tries: usize,
    /// Promised decrease of J that is not worth a step.
    pub promise: f64,
    /// Decrease of J that is too little to go on for: this much, and this share of J.
    pub enough: [f64; 2],
    /// Steps in a row of so little use that end a search.
    pub in_a_row: usize,
}

/// Why a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Steps had become of no use.
    Settled,
    /// However short a step, J did not become lower: a minimum to rounding, or a kink near one.
    Stalled,
    /// The steps were used up.
    StepLimit,
    /// J or its derivatives were no numbers.
    NotFinite,
}

/// Where a search ended.
#[derive(Debug, Clone)]
pub struct Minimum {
    /// θ.
    pub at: DVector<f64>,
    /// J.
    pub value: f64,
    /// The normal equations there.
    pub normal: Normal,
    /// Accepted steps.
    pub steps: usize,
    /// Why it ended.
    pub end: End,
}

/// Share of the second derivatives that keeps a step finite without damping.
const RIDGE: f64 = 1e-11;

impl Normal {
    /// Normal equations of some unknowns, all zero.
    pub fn zeros(unknowns: usize) -> Self {
        Self { matrix: DMatrix::zeros(unknowns, unknowns), gradient: DVector::zeros(unknowns) }
    }

    /// Whether an unknown lies at an end of its range and would leave it.
    pub fn is_held(&self, unknown: usize, value: f64, [low, high]: [f64; 2]) -> bool {
        (value <= low && self.gradient[unknown] < 0.0) || (value >= high && self.gradient[unknown] > 0.0)
    }
}

/// Work space of a search.
struct Steps {
    /// One over the roots of the second derivatives; one where nothing depends on an unknown.
    scale: DVector<f64>,
    held: Vec<bool>,
    right: DVector<f64>,
    damped: DMatrix<f64>,
    step: DVector<f64>,
}

impl Steps {
    fn new(unknowns: usize) -> Self {
        let zeros = || DVector::zeros(unknowns);
        let (held, damped) = (vec![false; unknowns], DMatrix::zeros(unknowns, unknowns));
        Self { scale: zeros(), held, right: zeros(), damped, step: zeros() }
    }

    /// Takes the normal equations at a point.
    fn prepare(&mut self, problem: &impl Objective, at: &DVector<f64>, normal: &Normal) {
        for k in 0..at.len() {
            let curvature = normal.matrix[(k, k)];
            self.scale[k] = if curvature > 0.0 { curvature.sqrt().recip() } else { 1.0 };
            self.held[k] = normal.is_held(k, at[k], problem.bounds(k));
            self.right[k] = if self.held[k] || curvature <= 0.0 { 0.0 } else { normal.gradient[k] * self.scale[k] };
        }
    }

    /// Computes a damped step and returns the decrease of J that it promises.
    fn damp(&mut self, normal: &Normal, damping: f64) -> Option<f64> {
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

/// Searches the least J between the bounds, from a start.
pub fn minimise(problem: &mut impl Objective, start: DVector<f64>, rules: &Rules) -> Minimum {
    let unknowns = start.len();
    let (mut at, mut next) = (start, DVector::zeros(unknowns));
    let mut normal = Normal::zeros(unknowns);
    let mut value = problem.linearise(at.as_slice(), &mut normal);
    let mut work = Steps::new(unknowns);
    let (mut damping, mut useless) = (rules.damping, 0);
    let mut end = if value.is_finite() { End::StepLimit } else { End::NotFinite };
    let mut steps = 0;
    'search: while steps < rules.steps && end == End::StepLimit {
        work.prepare(problem, &at, &normal);
        let mut tries = 0;
        let lower = loop {
            if tries == rules.tries {
                end = End::Stalled;
                break 'search;
            }
            tries += 1;
            if let Some(promise) = work.damp(&normal, damping) {
                if promise < rules.promise {
                    end = End::Settled;
                    break 'search;
                }
                for k in 0..unknowns {
                    let [low, high] = problem.bounds(k);
                    next[k] = if work.held[k] { at[k] } else { (at[k] + work.step[k]).clamp(low, high) };
                }
                let found = problem.value(next.as_slice());
                if found <= value {
                    if value - found >= rules.trusted * promise {
                        damping = (damping * rules.shrink).max(rules.least[0]);
                    }
                    break found;
                }
            }
            damping = (damping * rules.grow).max(rules.least[1]);
        };
        std::mem::swap(&mut at, &mut next);
        useless = if value - lower <= rules.enough[0] + rules.enough[1] * value { useless + 1 } else { 0 };
        value = problem.linearise(at.as_slice(), &mut normal);
        steps += 1;
        if !value.is_finite() {
            end = End::NotFinite;
        } else if useless == rules.in_a_row {
            end = End::Settled;
        }
    }
    Minimum { at, value, normal, steps, end }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const RULES: Rules = Rules {
        steps: 50,
        damping: 1e-3,
        shrink: 0.2,
        trusted: 0.0,
        grow: 4.0,
        least: [1e-9, 0.0],
        tries: 30,
        promise: 1e-25,
        enough: [0.0, 1e-14],
        in_a_row: 2,
    };

    /// Rosenbrock's valley as the squares of 10 (y − x²) and 1 − x, with a bound on x.
    struct Valley {
        most: f64,
    }

    impl Objective for Valley {
        fn bounds(&self, unknown: usize) -> [f64; 2] {
            [[-2.0, self.most], [f64::NEG_INFINITY, f64::INFINITY]][unknown]
        }

        fn value(&mut self, at: &[f64]) -> f64 {
            (10.0 * (at[1] - at[0] * at[0])).powi(2) + (1.0 - at[0]).powi(2)
        }

        fn linearise(&mut self, at: &[f64], normal: &mut Normal) -> f64 {
            let e = DVector::from_vec(vec![10.0 * (at[1] - at[0] * at[0]), 1.0 - at[0]]);
            let x = DMatrix::from_row_slice(2, 2, &[20.0 * at[0], -10.0, 1.0, 0.0]);
            normal.matrix = x.tr_mul(&x);
            normal.gradient = x.tr_mul(&e);
            self.value(at)
        }
    }

    #[test]
    fn a_curved_valley_is_followed_to_its_end_and_to_a_bound() {
        let start = || DVector::from_vec(vec![-1.2, 1.0]);
        let found = minimise(&mut Valley { most: 5.0 }, start(), &RULES);
        assert_relative_eq!(found.at, DVector::from_vec(vec![1.0, 1.0]), epsilon = 1e-8);
        let found = minimise(&mut Valley { most: 0.5 }, start(), &RULES);
        assert_relative_eq!(found.at, DVector::from_vec(vec![0.5, 0.25]), epsilon = 1e-8);
        assert!(found.normal.is_held(0, found.at[0], [-2.0, 0.5]));
    }

    #[test]
    fn a_search_says_why_it_ended() {
        let start = DVector::from_vec(vec![-1.2, 1.0]);
        assert_eq!(
            minimise(&mut Valley { most: 5.0 }, start.clone(), &Rules { steps: 3, ..RULES }).end,
            End::StepLimit
        );
        let eager = Rules { promise: 1e9, ..RULES };
        assert_eq!(minimise(&mut Valley { most: 5.0 }, start, &eager).end, End::Settled);
        let nowhere = DVector::from_vec(vec![f64::NAN, 1.0]);
        assert_eq!(minimise(&mut Valley { most: 5.0 }, nowhere, &RULES).end, End::NotFinite);
    }
}
