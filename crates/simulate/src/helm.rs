//! Helmsman: the specification, and the [`Helm`], which is the state of one manoeuvre in one run and gives the orders.
//! The motion of the rudder is in [`crate::gear`].

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use trial::manoeuvre::{Manoeuvre, Trigger};

use crate::error::{self, Check};

/// Helmsman, who reads the compass and gives the orders.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Helmsman {
    /// Time between readings of the heading display; if left out, the helmsman knows the true heading at every instant.
    #[serde(rename = "reads-display-every-s")]
    pub reads_display_every: Option<f64>,
    /// Time from the reading of the awaited heading to the order.
    #[serde(rename = "reaction-time-s")]
    pub reaction_time: f64,
}

/// Minimum time between two readings of an instrument, s.
pub(crate) const MIN_PERIOD_S: f64 = 1e-3;

/// Maximum time between two readings of an instrument, s.
pub(crate) const MAX_PERIOD_S: f64 = 1e3;

impl Helmsman {
    /// Check of every value; fails with the first invalid value.
    pub fn check(&self) -> Check {
        if let Some(period) = self.reads_display_every {
            error::check_between("helmsman.reads-display-every-s", period, MIN_PERIOD_S, MAX_PERIOD_S)?;
        }
        error::check_time("helmsman.reaction-time-s", self.reaction_time)
    }
}

/// Order of the helm (execute).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HelmOrder {
    /// Time of the order, s.
    pub time: f64,
    /// True heading at that time, rad.
    pub heading: f64,
    /// True yaw rate at that time, rad/s.
    pub yaw_rate: f64,
    /// Ordered rudder angle, rad.
    pub ordered_rudder: f64,
}

/// State of one manoeuvre in one run: orders given, next trigger and end.
#[derive(Debug, Clone)]
pub struct Helm<'a> {
    manoeuvre: &'a Manoeuvre,
    reaction_time: f64,
    /// Number of orders given so far.
    orders: usize,
    /// Time of the last order, s; before the first order, the time at which it is due.
    last: f64,
    /// Time of an order that is decided but not yet given, s; `None` without such an order.
    due: Option<f64>,
    end: f64,
    finished: bool,
}

impl<'a> Helm<'a> {
    /// Helm at the beginning of a run with the first execute at `first_execute` s.
    pub fn new(manoeuvre: &'a Manoeuvre, helmsman: &Helmsman, first_execute: f64) -> Self {
        let Helmsman { reaction_time, .. } = *helmsman;
        let end = first_execute + manoeuvre.duration();
        Self { manoeuvre, reaction_time, orders: 0, last: first_execute, due: None, end, finished: false }
    }

    /// End of the manoeuvre, s; infinite while it is unknown.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Trigger of the next order; times are on the clock of the run.
    pub fn trigger(&self) -> Trigger {
        let step = self.manoeuvre.order_step(self.orders);
        match (self.due, step.trigger) {
            (Some(due), _) => Trigger::Time(due),
            _ if self.finished => Trigger::Never,
            (None, Trigger::Time(_)) if step.ordered_rudder.is_none() => Trigger::Never,
            (None, Trigger::Time(time)) => Trigger::Time(self.last + time),
            (None, heading) => heading,
        }
    }

    /// Processes the trigger that occurs at time `t` (s) and returns the rudder order, rad; `None` if no order is given
    /// at this time, because of the reaction time or at the end of the manoeuvre.
    pub fn act(&mut self, t: f64) -> Option<f64> {
        let is_heading_dependent = matches!(self.trigger(), Trigger::Deviation { .. });
        let Some(order) = self.manoeuvre.order_step(self.orders).ordered_rudder else {
            (self.finished, self.end) = (true, t);
            return None;
        };
        if is_heading_dependent && self.reaction_time > 0.0 {
            self.due = Some(t + self.reaction_time);
            return None;
        }
        (self.due, self.last) = (None, t);
        self.orders += 1;
        let next = self.manoeuvre.order_step(self.orders);
        if let (Trigger::Time(time), None) = (next.trigger, next.ordered_rudder) {
            self.end = self.end.min(t + time);
        }
        Some(order)
    }
}
