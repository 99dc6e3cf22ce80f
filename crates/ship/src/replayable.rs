//! What a ship has to offer so that its record can be replayed from any of its rows.

use std::fmt;

use estimation::number::Real;

use crate::dynamics::{Dynamics, Input, Regressor};
use crate::number::Tangent;

/// Time constants that steps have to resolve: one at all times, others within a span.
#[derive(Debug, Clone, PartialEq)]
pub struct Pace {
    always: f64,
    spans: Vec<([f64; 2], f64)>,
}

impl Pace {
    /// One time constant, s, at all times.
    pub fn always(time: f64) -> Self {
        Self { always: time, spans: Vec::new() }
    }

    /// With one more, s, within a span of time, s.
    pub(crate) fn add(&mut self, span: [f64; 2], time: f64) {
        if span == [f64::NEG_INFINITY, f64::INFINITY] {
            self.always = self.always.min(time);
        } else {
            self.spans.push((span, time));
        }
    }

    /// Shortest time constant, s, between two times, s.
    pub fn shortest(&self, from: f64, to: f64) -> f64 {
        let meets = |span: &[f64; 2]| span[0] < to && from < span[1];
        self.spans.iter().filter(|(span, _)| meets(span)).fold(self.always, |least, (_, time)| least.min(*time))
    }
}

/// A ship whose record can be replayed from any of its rows.
pub trait Replayable<R: Real = f64>: Dynamics<R> {
    /// State of a record that begins with the given heading (rad), yaw rate (rad/s) and input.
    fn enter(&self, heading: R, yaw_rate: R, input: &Input<R>, state: &mut [R]);

    /// Puts heading (rad) and yaw rate (rad/s) of a state to other values and keeps all else.
    fn restart(&self, heading: R, yaw_rate: R, state: &mut [R]);

    /// Whether a measured channel acts on it.
    fn needs(&self, channel: Regressor) -> bool;

    /// The time constants that steps have to resolve.
    fn pace(&self) -> Pace;
}

/// The same with how its replay changes with heading and yaw rate at the start.
pub trait ReplayedShip: Replayable + fmt::Debug {
    /// The ship in numbers with derivatives.
    fn tangent(&self) -> Box<dyn Replayable<Tangent>>;
}
