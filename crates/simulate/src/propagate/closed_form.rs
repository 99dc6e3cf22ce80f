//! Closed-form motion of a first-order ship: with rudder and moment linear in time, every step is exact.

use ship::first_order::{FirstOrderTransition, YawState};
use ship::{FirstOrder, Motion};

use crate::gear::{RudderMotion, RudderPath, RudderSegment};
use crate::propagate::propagator::{Propagator, RowLimits, acting_segment, has_diverged};
use crate::recording::Sampler;
use crate::sample::Sample;
use crate::weather::Weather;

/// Maximum step, s.
const MAX_STEP_S: f64 = 60.0;

/// Maximum step in units of |T|, so that a course-unstable ship is stopped before its state overflows.
const MAX_STEP_OVER_T: f64 = 30.0;

/// Tolerance, s, for equal steps: rows at k·period differ by rounding only, and 1e-12 s of yaw rate changes only the
/// last bits of a heading.
const STEP_TOLERANCE_S: f64 = 1e-12;

/// Closed-form motion of a first-order ship.
#[derive(Debug)]
pub(crate) struct ClosedForm {
    ship: FirstOrder,
    weather: Weather,
    time: f64,
    state: YawState,
    candidate: YawState,
    cursor: usize,
    longest: f64,
    /// Transitions over the two most frequent steps: a row and a cell of the weather.
    usual: [FirstOrderTransition; 2],
}

impl ClosedForm {
    /// Ship at time 0; `period` is the most frequent step, s.
    pub fn new(ship: FirstOrder, weather: Weather, state: YawState, period: f64) -> Self {
        let longest = Self::longest_step(&ship);
        let usual = [period, weather.cell().width].map(|h| FirstOrderTransition::new(ship.inverse_T, h));
        Self { ship, weather, time: 0.0, state, candidate: state, cursor: 0, longest, usual }
    }

    /// Maximum step, s.
    pub fn longest_step(ship: &FirstOrder) -> f64 {
        MAX_STEP_S.min(MAX_STEP_OVER_T / ship.inverse_T.abs())
    }

    fn transition(&self, h: f64) -> FirstOrderTransition {
        for usual in self.usual {
            if (usual.time_step - h).abs() < STEP_TOLERANCE_S {
                return usual;
            }
        }
        FirstOrderTransition::new(self.ship.inverse_T, h)
    }

    /// Steering term b (δ + δ_r + disturbance) at the current time (rad/s²), and its slope (rad/s³).
    fn steering(&self, segment: &RudderSegment) -> (f64, f64) {
        let slope = match segment.motion {
            RudderMotion::Ramp { rate } => rate,
            // Exponentials do not occur: a gear with a lag is integrated.
            RudderMotion::Hold | RudderMotion::Exponential { .. } => 0.0,
        };
        let cell = self.weather.cell();
        let rudder = segment.angle_at(self.time) + self.ship.rudder_bias + cell.moment(self.time);
        (self.ship.K_over_T * rudder, self.ship.K_over_T * (slope + cell.moment_slope()))
    }

    /// Sample at the current time, under the steering term `u0`, rad/s².
    fn sample_under(&self, u0: f64) -> Sample {
        let YawState { heading, yaw_rate } = self.state;
        let yaw_acceleration = u0 - self.ship.inverse_T * yaw_rate;
        let cell = self.weather.cell();
        Sample {
            time: self.time,
            motion: Motion { heading, yaw_rate, yaw_acceleration, speed: None, sway: None },
            gyro: heading,
            disturbance_rudder: cell.moment(self.time),
            gust_factor: cell.gust_factor(self.time),
        }
    }
}

impl Propagator for ClosedForm {
    fn time(&self) -> f64 {
        self.time
    }

    fn state(&self) -> YawState {
        self.state
    }

    fn stride(&mut self, path: &RudderPath, until: f64) -> f64 {
        while self.weather.cell().end <= self.time {
            self.weather.enter_next();
        }
        let segment = acting_segment(path, &mut self.cursor, self.time, 0.0);
        let to = until.min(segment.end).min(self.weather.cell().end).min(self.time + self.longest);
        let (u0, slope) = self.steering(segment);
        if slope == 0.0 {
            return to;
        }
        // r' = e^(−at) r'₀ + slope φ₁(t) vanishes at most once; the step ends at this zero, so that r is monotone
        // within the step.
        let a = self.ship.inverse_T;
        let ratio = -(u0 - a * self.state.yaw_rate) / slope;
        let turn = if (a * ratio).abs() < 1e-8 { ratio } else { (a * ratio).ln_1p() / a };
        // A step that has just ended at this zero leaves a rounding error.
        if turn > 1e-9 && self.time + turn < to { self.time + turn } else { to }
    }

    fn probe(&mut self, path: &RudderPath, h: f64) -> YawState {
        let (u0, slope) = self.steering(&path.segments()[self.cursor]);
        self.candidate = self.transition(h).advance(self.state, u0, slope);
        self.candidate
    }

    fn commit(&mut self, _path: &RudderPath, to: f64) {
        self.state = self.candidate;
        self.time = to;
    }

    fn sample(&mut self, path: &RudderPath) -> Sample {
        let segment = acting_segment(path, &mut self.cursor, self.time, 0.0);
        let (u0, _) = self.steering(segment);
        self.sample_under(u0)
    }

    fn record_rows(&mut self, path: &RudderPath, limits: &RowLimits, rows: &mut Sampler) {
        let segment = acting_segment(path, &mut self.cursor, self.time, 0.0);
        let still = segment.motion == RudderMotion::Hold && self.weather.cell().end == f64::INFINITY;
        if !still {
            return;
        }
        let (u0, _) = self.steering(segment);
        let [step, _] = self.usual;
        let before = limits.before.min(segment.end);
        loop {
            let next = rows.next_time();
            let usual =
                (next - self.time - step.time_step).abs() < STEP_TOLERANCE_S && next <= self.time + self.longest;
            if !usual || next >= before {
                return;
            }
            let from = self.state;
            let to = step.advance(from, u0, 0.0);
            // The yaw rate is monotone: a heading crossed twice within the step has an extremum between the crossings.
            let crossed = limits.watch.is_some_and(|watch| {
                let turns = watch.side * from.yaw_rate > 0.0 && watch.side * to.yaw_rate < 0.0;
                turns || watch.excess(from.heading) >= 0.0 || watch.excess(to.heading) >= 0.0
            });
            if crossed || has_diverged(to, limits.base) {
                return;
            }
            (self.state, self.time) = (to, next);
            rows.take(&self.sample_under(u0));
        }
    }
}
