//! The classical fourth-order Runge–Kutta step, with its work space allocated once.

use crate::dynamics::{Dynamics, Input};

/// Classical Runge–Kutta of order four with a fixed step.
///
/// The right-hand sides of hulls have kinks (flow straightening by side of the rudder), for which a fixed small
/// step is more predictable than an adaptive one.
#[derive(Debug, Clone)]
pub struct RungeKutta4 {
    stage: [Vec<f64>; 4],
    probe: Vec<f64>,
}

impl RungeKutta4 {
    /// Work space for a system with `dimension` states.
    pub fn new(dimension: usize) -> Self {
        Self { stage: std::array::from_fn(|_| vec![0.0; dimension]), probe: vec![0.0; dimension] }
    }

    /// Advances `state` from `t` by `h` seconds; `input` gives what acts at a time within the step.
    ///
    /// Does not call [`Dynamics::settle`]: a driver that only probes a step must not change memory.
    pub fn step<D, F>(&mut self, dynamics: &D, t: f64, h: f64, state: &mut [f64], mut input: F)
    where
        D: Dynamics + ?Sized,
        F: FnMut(f64) -> Input,
    {
        let [k1, k2, k3, k4] = &mut self.stage;
        let half = 0.5 * h;
        let (start, middle, end) = (input(t), input(t + half), input(t + h));
        dynamics.rates(t, state, &start, k1);
        for ((probe, x), k) in self.probe.iter_mut().zip(state.iter()).zip(k1.iter()) {
            *probe = x + half * k;
        }
        dynamics.rates(t + half, &self.probe, &middle, k2);
        for ((probe, x), k) in self.probe.iter_mut().zip(state.iter()).zip(k2.iter()) {
            *probe = x + half * k;
        }
        dynamics.rates(t + half, &self.probe, &middle, k3);
        for ((probe, x), k) in self.probe.iter_mut().zip(state.iter()).zip(k3.iter()) {
            *probe = x + h * k;
        }
        dynamics.rates(t + h, &self.probe, &end, k4);
        for (i, x) in state.iter_mut().enumerate() {
            *x += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
    }
}
