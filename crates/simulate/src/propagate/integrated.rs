//! Integrated motion of any ship, by Runge–Kutta steps that end at every corner of the acting rudder and of the
//! weather.

use ship::first_order::YawState;
use ship::integrate::RungeKutta4;
use ship::{Dynamics, ShipInput};

use super::ship_in_weather::ShipInWeather;
use crate::gear::{RudderPath, RudderSegment};
use crate::propagate::propagator::{Propagator, acting_segment};
use crate::sample::Sample;

/// Integrated motion of any ship.
pub(crate) struct Integrated<'a, D: ?Sized> {
    ship: ShipInWeather<'a, D>,
    solver: RungeKutta4,
    time: f64,
    state: Vec<f64>,
    candidate: Vec<f64>,
    cursor: usize,
    step: f64,
}

/// Input at `t` within `segment`, with its smooth continuation at both ends.
fn input(segment: &RudderSegment, dead_time: f64, t: f64) -> ShipInput {
    ShipInput { rudder: segment.angle_at(t - dead_time), ..ShipInput::default() }
}

impl<'a, D: Dynamics + ?Sized> Integrated<'a, D> {
    /// Ship at time 0 on its approach; `step` is the maximum step, s; `None` for the maximum step of the ship.
    pub fn new(ship: ShipInWeather<'a, D>, approach: YawState, step: Option<f64>) -> Self {
        let dimension = ship.dimension();
        let mut state = vec![0.0; dimension];
        ship.approach(approach.heading, approach.yaw_rate, &mut state);
        let step = step.unwrap_or_else(|| ship.largest_step());
        let candidate = state.clone();
        Self { ship, solver: RungeKutta4::new(dimension), time: 0.0, state, candidate, cursor: 0, step }
    }
}

impl<D: Dynamics + ?Sized> Propagator for Integrated<'_, D> {
    fn time(&self) -> f64 {
        self.time
    }

    fn state(&self) -> YawState {
        YawState { heading: self.state[0], yaw_rate: self.state[1] }
    }

    fn stride(&mut self, path: &RudderPath, until: f64) -> f64 {
        while self.ship.weather.cell().end <= self.time {
            self.ship.weather.enter_next();
        }
        let dead_time = self.ship.dead_time();
        let segment = acting_segment(path, &mut self.cursor, self.time, dead_time);
        until.min(segment.end + dead_time).min(self.ship.weather.cell().end).min(self.time + self.step)
    }

    fn probe(&mut self, path: &RudderPath, h: f64) -> YawState {
        let segment = &path.segments()[self.cursor];
        let dead_time = self.ship.dead_time();
        self.candidate.copy_from_slice(&self.state);
        self.solver.step(&self.ship, self.time, h, &mut self.candidate, |t| input(segment, dead_time, t));
        YawState { heading: self.candidate[0], yaw_rate: self.candidate[1] }
    }

    fn commit(&mut self, path: &RudderPath, to: f64) {
        std::mem::swap(&mut self.state, &mut self.candidate);
        self.time = to;
        let segment = &path.segments()[self.cursor];
        self.ship.update_memory(to, &mut self.state, &input(segment, self.ship.dead_time(), to));
    }

    fn sample(&mut self, path: &RudderPath) -> Sample {
        let dead_time = self.ship.dead_time();
        let segment = acting_segment(path, &mut self.cursor, self.time, dead_time);
        Sample {
            time: self.time,
            motion: self.ship.motion(self.time, &self.state, &input(segment, dead_time, self.time)),
            gyro: self.ship.gyro(&self.state),
            disturbance_rudder: self.ship.disturbance_rudder(self.time, self.state[0]),
            gust_factor: self.ship.weather.cell().gust_factor(self.time),
        }
    }
}
