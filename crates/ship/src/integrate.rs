//! Classical fourth-order Runge–Kutta step, with its work space allocated once.
//!
//! Source: Kutta (1901), Zeitschrift für Mathematik und Physik 46:435-453.

use crate::dynamics::{Dynamics, ShipInput};
use estimation::number::Real;

/// Classical Runge–Kutta method of order four with a fixed step.
///
/// The right-hand sides of hulls have kinks (flow straightening differs by side), for which a fixed small step is more
/// predictable than an adaptive step.
#[derive(Debug, Clone)]
pub struct RungeKutta4<R = f64> {
    stage: [Vec<R>; 4],
    probe: Vec<R>,
}

impl<R: Real> RungeKutta4<R> {
    /// Work space for a system with `dimension` states.
    pub fn new(dimension: usize) -> Self {
        let zeros = || vec![R::from(0.0); dimension];
        Self { stage: std::array::from_fn(|_| zeros()), probe: zeros() }
    }

    /// Advances `state` from `t` by `h` seconds; `input` returns the input at a time within the step.
    ///
    /// [`Dynamics::update_memory`] is not called, so that a trial step changes no memory.
    pub fn step<D, F>(&mut self, dynamics: &D, t: f64, h: f64, state: &mut [R], mut input: F)
    where
        D: Dynamics<R> + ?Sized,
        F: FnMut(f64) -> ShipInput<R>,
    {
        let inputs = [input(t), input(t + 0.5 * h), input(t + h)];
        self.step_with(dynamics, t, h, state, &inputs);
    }

    /// [`step`](Self::step) with the inputs at the beginning, in the middle and at the end of the step.
    pub fn step_with<D>(&mut self, dynamics: &D, t: f64, h: f64, state: &mut [R], inputs: &[ShipInput<R>; 3])
    where
        D: Dynamics<R> + ?Sized,
    {
        let [k1, k2, k3, k4] = &mut self.stage;
        let half = 0.5 * h;
        let [start, middle, end] = inputs;
        dynamics.rates(t, state, start, k1);
        probe(&mut self.probe, state, k1, half);
        dynamics.rates(t + half, &self.probe, middle, k2);
        probe(&mut self.probe, state, k2, half);
        dynamics.rates(t + half, &self.probe, middle, k3);
        probe(&mut self.probe, state, k3, h);
        dynamics.rates(t + h, &self.probe, end, k4);
        for ((((x, &k1), &k2), &k3), &k4) in state.iter_mut().zip(&*k1).zip(&*k2).zip(&*k3).zip(&*k4) {
            *x = *x + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
        }
    }
}

/// Writes the state of the next stage into `probe`: `state` plus `h` seconds of `rate`.
#[inline]
fn probe<R: Real>(probe: &mut [R], state: &[R], rate: &[R], h: f64) {
    for ((probe, &x), &k) in probe.iter_mut().zip(state).zip(rate) {
        *probe = x + k * h;
    }
}
