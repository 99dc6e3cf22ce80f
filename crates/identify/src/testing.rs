//! Zig-zag records of an exact first-order ship, for tests of this crate only: there is no integration error, so that a
//! test measures only the method. The rudder rests or moves at one rate, with corners between the rows, and is recorded
//! at the rows.

use std::collections::BTreeMap;

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use ship::angle::from_deg;
use ship::first_order::{FirstOrder, FirstOrderTransition, YawState};
use statrs::distribution::{ContinuousCDF, Normal};
use trial::{Channel, Columns, RecordOrigin, Trial};

/// Beginning of the record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start {
    /// At the first execute, ship at rest.
    Rest,
    /// 1.2 s after the first reversal of the rudder was ordered.
    Mid,
    /// Time after the first execute, s.
    At(f64),
}

/// Zig-zag trial and its record; the default is 10/10, K = 0.1 1/s, T = 16.3 s, 271 rows at 1 s, no noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Case {
    /// K, 1/s.
    pub K: f64,
    /// T, s.
    pub T: f64,
    /// Ordered rudder angle, deg; negative for a first execute to port.
    pub rudder_deg: f64,
    /// Heading at which the rudder is reversed, deg, positive.
    pub heading_deg: f64,
    /// Rudder rate, deg/s.
    pub rate_deg_s: f64,
    /// Rudder bias δ_r, deg.
    pub bias_deg: f64,
    /// Beginning of the record.
    pub start: Start,
    /// Number of rows.
    pub samples: usize,
    /// Time between rows, s.
    pub period_s: f64,
    /// Standard deviation of white heading noise, deg.
    pub noise_deg: f64,
    /// Seed of the noise.
    pub seed: u64,
}

impl Default for Case {
    fn default() -> Self {
        Self {
            K: 0.1,
            T: 16.3,
            rudder_deg: 10.0,
            heading_deg: 10.0,
            rate_deg_s: 2.5,
            bias_deg: 0.0,
            start: Start::Mid,
            samples: 271,
            period_s: 1.0,
            noise_deg: 0.0,
            seed: 0,
        }
    }
}

/// Noise-free motion at the rows of a record.
#[derive(Debug, Clone, Default)]
pub struct Truth {
    /// Time since the first row, s.
    pub time: Vec<f64>,
    /// Heading, rad.
    pub heading: Vec<f64>,
    /// Yaw rate, rad/s.
    pub yaw_rate: Vec<f64>,
    /// Yaw acceleration, rad/s².
    pub yaw_acceleration: Vec<f64>,
    /// Rudder, rad.
    pub rudder: Vec<f64>,
}

/// Piece of the run with a rudder that is linear in time.
#[derive(Debug, Clone, Copy)]
struct Piece {
    t: f64,
    state: YawState,
    rudder: f64,
    slope: f64,
}

impl Piece {
    fn rudder(&self, h: f64) -> f64 {
        self.rudder + self.slope * h
    }

    fn state(&self, ship: &FirstOrder, h: f64) -> YawState {
        let b = ship.K_over_T;
        FirstOrderTransition::new(ship.inverse_T, h).advance(
            self.state,
            b * (self.rudder + ship.rudder_bias),
            b * self.slope,
        )
    }
}

impl Case {
    /// First-order ship.
    pub fn ship(&self) -> FirstOrder {
        FirstOrder::from_indices(self.K, self.T, from_deg(self.bias_deg))
    }

    /// Noise-free motion at the rows.
    pub fn truth(&self) -> Truth {
        let ship = self.ship();
        let duration = (self.samples - 1) as f64 * self.period_s;
        let (pieces, executes) = self.run(&ship, duration);
        let start = match self.start {
            Start::Rest => 0.0,
            Start::Mid => executes[1] + 1.2,
            Start::At(t) => t,
        };
        let mut truth = Truth::default();
        for row in 0..self.samples {
            let t = row as f64 * self.period_s;
            let piece = &pieces[pieces.partition_point(|piece| piece.t <= start + t).saturating_sub(1)];
            let h = start + t - piece.t;
            let (state, rudder) = (piece.state(&ship, h), piece.rudder(h));
            truth.time.push(t);
            truth.heading.push(state.heading);
            truth.yaw_rate.push(state.yaw_rate);
            truth.yaw_acceleration.push(ship.K_over_T * (rudder + ship.rudder_bias) - ship.inverse_T * state.yaw_rate);
            truth.rudder.push(rudder);
        }
        truth
    }

    /// Record with noise on the heading.
    pub fn trial(&self) -> Trial {
        let truth = self.truth();
        let normal = Normal::standard();
        let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
        let sd = from_deg(self.noise_deg);
        let heading = truth
            .heading
            .iter()
            // Half a step of the generator away from 0 and 1, where the quantile is infinite.
            .map(|psi| psi + sd * normal.inverse_cdf((f64::from(generator.random::<u32>()) + 0.5) / 4294967296.0))
            .collect();
        record("zigzag", truth.time, heading, truth.rudder)
    }

    /// Times of the first `count` executes, s after the first.
    pub fn executes(&self, count: usize) -> Vec<f64> {
        let mut duration = 100.0;
        loop {
            let (_, executes) = self.run(&self.ship(), duration);
            if executes.len() >= count {
                return executes[..count].to_vec();
            }
            duration *= 2.0;
        }
    }

    /// Pieces and executes from the first execute until `duration` seconds after the second (or after [`Start::At`]).
    fn run(&self, ship: &FirstOrder, duration: f64) -> (Vec<Piece>, Vec<f64>) {
        let (angle, rate, limit) = (from_deg(self.rudder_deg), from_deg(self.rate_deg_s), from_deg(self.heading_deg));
        let mut side = angle.signum();
        let mut executes = vec![0.0];
        let mut pieces: Vec<Piece> = Vec::new();
        let mut now = Piece { t: 0.0, state: YawState::default(), rudder: 0.0, slope: side * rate };
        let last = |executes: &[f64]| match self.start {
            Start::At(t) => t + duration,
            Start::Rest | Start::Mid => executes.get(1).map_or(f64::INFINITY, |t| t + 1.2 + duration),
        };
        while now.t <= last(&executes) {
            assert!(now.t < 1e5, "the ship of this case never reaches its heading");
            pieces.push(now);
            let target = side * angle.abs();
            let stop = if now.slope == 0.0 { f64::INFINITY } else { (target - now.rudder) / now.slope };
            // Steps until the heading is past its limit or the rudder has reached its order.
            let beyond = |h: f64| side * now.state(ship, h).heading >= limit;
            let mut h = 0.0;
            while h < stop && !beyond(h) && now.t + h <= last(&executes) {
                h += 0.25;
            }
            let mut end = h.min(stop);
            if beyond(end) {
                let (mut lo, mut hi) = ((h - 0.25).max(0.0), end);
                for _ in 0..60 {
                    let middle = 0.5 * (lo + hi);
                    if beyond(middle) { hi = middle } else { lo = middle }
                }
                end = hi;
                side = -side;
                executes.push(now.t + end);
                now =
                    Piece { t: now.t + end, state: now.state(ship, end), rudder: now.rudder(end), slope: side * rate };
            } else {
                now = Piece { t: now.t + end, state: now.state(ship, end), rudder: target, slope: 0.0 };
            }
        }
        (pieces, executes)
    }
}

/// Record of these columns, s and rad.
pub fn record(name: &str, time: Vec<f64>, heading: Vec<f64>, rudder: Vec<f64>) -> Trial {
    from_channels(name, time, [(Channel::Heading, heading), (Channel::Rudder, rudder)].into())
}

/// Record of these columns with a rate gyro, whose yaw rate is in rad/s.
pub fn record_with_gyro(time: Vec<f64>, heading: Vec<f64>, rudder: Vec<f64>, yaw_rate: Vec<f64>) -> Trial {
    let channels = [(Channel::Heading, heading), (Channel::Rudder, rudder), (Channel::YawRate, yaw_rate)];
    from_channels("gyro", time, channels.into())
}

fn from_channels(name: &str, time: Vec<f64>, channels: BTreeMap<Channel, Vec<f64>>) -> Trial {
    let origin = RecordOrigin::Simulated { scenario: name.into(), cell: 0, replicate: 0 };
    Trial::new(name, origin, Columns { time, channels, unknown_columns: Vec::new() })
        .expect("a test builds valid records")
}

/// Heading, rad, at every time of `time` (s), of `ship` steered by `rudder` (rad) from the state `start`. It is exact
/// if the rudder is linear between the rows and the detected corners of the rudder signal.
pub fn steered(ship: &FirstOrder, start: YawState, time: &[f64], rudder: &[f64]) -> Vec<f64> {
    let blank = record("steering", time.to_vec(), vec![0.0; time.len()], rudder.to_vec());
    let path = blank.rudder_signal();
    let b = ship.K_over_T;
    let (mut state, mut heading, mut at) = (start, vec![start.heading], 1);
    for (t, delta) in path.times().windows(2).zip(path.values().windows(2)) {
        let (h, slope) = (t[1] - t[0], (delta[1] - delta[0]) / (t[1] - t[0]));
        state =
            FirstOrderTransition::new(ship.inverse_T, h).advance(state, b * (delta[0] + ship.rudder_bias), b * slope);
        if t[1] == time[at] {
            heading.push(state.heading);
            at += 1;
        }
    }
    heading
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use ship::angle::to_deg;

    /// Executes of K = 0.1, T = 16.3 at 2.5 deg/s, from an independent RK4 simulation with a step of 0.01 s, whose
    /// executes are each late by up to a step; the delays add up: tolerance 0.05 s.
    #[test]
    fn executes_are_those_of_an_independent_simulation() {
        let case = Case::default();
        for (found, expected) in case.executes(5).into_iter().zip([0.0, 24.09, 79.20, 137.37, 195.68]) {
            assert_abs_diff_eq!(found, expected, epsilon = 0.05);
        }
        let case = Case { heading_deg: 20.0, ..case };
        for (found, expected) in case.executes(5).into_iter().zip([0.0, 36.31, 114.60, 194.58, 274.58]) {
            assert_abs_diff_eq!(found, expected, epsilon = 0.05);
        }
    }

    #[test]
    fn the_record_starts_where_it_says() {
        let rest = Case { start: Start::Rest, ..Case::default() }.truth();
        assert_eq!((rest.heading[0], rest.yaw_rate[0], rest.rudder[0]), (0.0, 0.0, 0.0));
        let mid = Case::default().truth();
        assert_abs_diff_eq!(to_deg(mid.rudder[0]), 10.0 - 1.2 * 2.5, epsilon = 1e-9);
        let reversal = Case::default().executes(2)[1];
        let at = Case { start: Start::At(reversal + 1.2), ..Case::default() }.truth();
        assert_abs_diff_eq!(at.heading[270], mid.heading[270], epsilon = 1e-12);
    }
}
