//! Who reads the compass and turns the wheel: the specification of the helmsman, and the [`Helm`], which is the state
//! of one manoeuvre in one run. It decides; it neither moves the rudder ([`crate::gear`]) nor the ship.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use trial::manoeuvre::{Manoeuvre, Trigger};

use crate::error::{self, Check};

/// Who reads the compass and turns the wheel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Helmsman {
    /// Time between readings of the heading display; left out, he knows the true heading at every instant.
    #[serde(rename = "reads-display-every-s")]
    pub reads_display_every: Option<f64>,
    /// Time from seeing the heading waited for to giving the order.
    #[serde(rename = "reaction-time-s")]
    pub reaction_time: f64,
}

/// Times between two readings of an instrument, s, that make sense: none is read more often, and a manoeuvre is over in
/// less.
pub(crate) const SHORTEST_PERIOD: f64 = 1e-3;
pub(crate) const LONGEST_PERIOD: f64 = 1e3;

impl Helmsman {
    /// Checks every value; fails with the first one that makes no sense.
    pub fn validate(&self) -> Check {
        if let Some(period) = self.reads_display_every {
            error::between("helmsman.reads-display-every-s", period, SHORTEST_PERIOD, LONGEST_PERIOD)?;
        }
        error::time("helmsman.reaction-time-s", self.reaction_time)
    }
}

/// An order of the helm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HelmOrder {
    /// Time the order is given, s.
    pub time: f64,
    /// True heading then, rad.
    pub heading: f64,
    /// True yaw rate then, rad/s.
    pub yaw_rate: f64,
    /// Rudder ordered, rad.
    pub order: f64,
}

/// The state of one manoeuvre in one run.
#[derive(Debug, Clone)]
pub struct Helm<'a> {
    manoeuvre: &'a Manoeuvre,
    reaction_time: f64,
    /// Orders given so far.
    orders: usize,
    /// Time of the last order, s; before the first one that at which it is due.
    last: f64,
    /// Time at which an order already decided is given, s.
    due: Option<f64>,
    end: f64,
    finished: bool,
}

impl<'a> Helm<'a> {
    /// The helm at the beginning of a run whose first execute is at `first_execute` s.
    pub fn new(manoeuvre: &'a Manoeuvre, helmsman: &Helmsman, first_execute: f64) -> Self {
        let Helmsman { reaction_time, .. } = *helmsman;
        let end = first_execute + manoeuvre.length();
        Self { manoeuvre, reaction_time, orders: 0, last: first_execute, due: None, end, finished: false }
    }

    /// Time at which the manoeuvre is over, s; infinite while it is not known.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// What the helm waits for now; a time is that of the run.
    pub fn trigger(&self) -> Trigger {
        let step = self.manoeuvre.step(self.orders);
        match (self.due, step.trigger) {
            (Some(due), _) => Trigger::Time(due),
            _ if self.finished => Trigger::Never,
            (None, Trigger::Time(_)) if step.order.is_none() => Trigger::Never,
            (None, Trigger::Time(time)) => Trigger::Time(self.last + time),
            (None, heading) => heading,
        }
    }

    /// What the helm does at time `t` (s) when its trigger has come: the rudder order, rad, if one is given now.
    pub fn act(&mut self, t: f64) -> Option<f64> {
        let sees_heading = matches!(self.trigger(), Trigger::Deviation { .. });
        let Some(order) = self.manoeuvre.step(self.orders).order else {
            (self.finished, self.end) = (true, t);
            return None;
        };
        if sees_heading && self.reaction_time > 0.0 {
            self.due = Some(t + self.reaction_time);
            return None;
        }
        (self.due, self.last) = (None, t);
        self.orders += 1;
        let next = self.manoeuvre.step(self.orders);
        if let (Trigger::Time(time), None) = (next.trigger, next.order) {
            self.end = self.end.min(t + time);
        }
        Some(order)
    }
}
