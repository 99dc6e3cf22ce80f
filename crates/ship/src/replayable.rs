//! Interface of a ship whose record can be replayed from any row.

use std::fmt;

use estimation::number::Real;

use crate::dynamics::{Dynamics, RegressorChannel, ShipInput};
use crate::number::Tangent;

/// Time constants that steps must resolve: a global time constant, and time constants of time spans.
#[derive(Debug, Clone, PartialEq)]
pub struct ResolvedTimeConstants {
    always: f64,
    spans: Vec<([f64; 2], f64)>,
}

impl ResolvedTimeConstants {
    /// Time constant, s, at all times.
    pub fn at_all_times(time: f64) -> Self {
        Self { always: time, spans: Vec::new() }
    }

    /// Adds a time constant, s, within a time span, s.
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

/// Ship model that can be started at any row of a record with a given heading and yaw rate.
pub trait Replayable<R: Real = f64>: Dynamics<R> {
    /// Initial state of a record that begins with this heading (rad), yaw rate (rad/s) and input.
    fn initialise(&self, heading: R, yaw_rate: R, input: &ShipInput<R>, state: &mut [R]);

    /// Sets heading (rad) and yaw rate (rad/s) of a state and keeps the memory.
    fn reset_motion(&self, heading: R, yaw_rate: R, state: &mut [R]);

    /// `true` if the ship uses this measured channel, in its equations or for its initial state.
    fn needs(&self, channel: RegressorChannel) -> bool;

    /// Time constants that steps must resolve.
    fn time_constants(&self) -> ResolvedTimeConstants;
}

/// Ship that can be replayed in real and in dual numbers; the dual numbers give sensitivities to the initial state.
pub trait ReplayedShip: Replayable + fmt::Debug {
    /// Ship in dual numbers.
    fn tangent(&self) -> Box<dyn Replayable<Tangent>>;
}
