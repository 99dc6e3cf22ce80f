//! Who reads the compass and turns the wheel: the specification of the helmsman, and the [`Helm`], which is the state
//! of one manoeuvre in one run. It decides; it neither moves the rudder ([`crate::gear`]) nor the ship.

use crate::error::{self, Checked};
use crate::manoeuvre::{Manoeuvre, TurnEnd, Williamson, ZigZag, ZigZagEnd, length};

/// What the helmsman looks at.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Watches {
    /// The true heading, at every instant: an execute falls exactly on the heading asked for.
    #[default]
    TrueHeading,
    /// The heading display: the measured heading with its noise and quantisation, renewed every `period` s from the
    /// beginning of the run. An execute can then only fall on a reading.
    Display {
        /// Time between two readings, s.
        period: f64,
    },
}

/// The helmsman.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Helmsman {
    /// What he looks at.
    pub watches: Watches,
    /// Time from seeing the heading asked for to giving the order, s.
    pub reaction_time: f64,
}

/// Times between two readings of an instrument, s, that make sense: none is read more often, and a manoeuvre is over in
/// less.
pub(crate) const SHORTEST_PERIOD: f64 = 1e-3;
pub(crate) const LONGEST_PERIOD: f64 = 1e3;

impl Helmsman {
    /// Checks every value; fails with the first one that makes no sense.
    pub fn validate(&self) -> Checked {
        if let Watches::Display { period } = self.watches {
            error::between("helmsman.reads-display-every-s", period, SHORTEST_PERIOD, LONGEST_PERIOD)?;
        }
        error::time("helmsman.reaction-time-s", self.reaction_time)
    }
}

/// What the helm waits for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cue {
    /// A time, s.
    At(f64),
    /// `side` · (ψ − base course) ≥ `angle`, with side ±1 and angle in rad.
    Deviation {
        /// Direction of the deviation, +1 to starboard.
        side: f64,
        /// Size of the deviation, rad.
        angle: f64,
    },
    /// Nothing more.
    Nothing,
}

/// An order of the helm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Execute {
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
    first_execute: f64,
    made: usize,
    /// Time at which an order already decided is given, s.
    due: Option<f64>,
    /// Whether the event that ends the manoeuvre has happened.
    finished: bool,
    end: f64,
}

impl<'a> Helm<'a> {
    /// The helm at the beginning of a run whose first execute is at `first_execute` s.
    pub fn new(manoeuvre: &'a Manoeuvre, helmsman: &Helmsman, first_execute: f64) -> Self {
        let length = match manoeuvre {
            Manoeuvre::ZigZag(zig_zag) => match zig_zag.end {
                ZigZagEnd::Duration(duration) => duration,
                ZigZagEnd::Executes(_) | ZigZagEnd::Record => f64::INFINITY,
            },
            Manoeuvre::TurningCircle(turn) => match turn.end {
                TurnEnd::Duration(duration) => duration,
                TurnEnd::HeadingChange(_) => f64::INFINITY,
            },
            Manoeuvre::PullOut(pull_out) => pull_out.hold + pull_out.duration,
            Manoeuvre::Williamson(_) => f64::INFINITY,
            Manoeuvre::Replay(signal) => length(signal),
        };
        Self {
            manoeuvre,
            reaction_time: helmsman.reaction_time,
            first_execute,
            made: 0,
            due: None,
            finished: false,
            end: first_execute + length,
        }
    }

    /// Time at which the manoeuvre is over, s; infinite while it is not known.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// What the helm waits for now.
    pub fn cue(&self) -> Cue {
        if let Some(due) = self.due {
            return Cue::At(due);
        }
        match (self.manoeuvre, self.made) {
            _ if self.finished => Cue::Nothing,
            (Manoeuvre::Replay(_), _) => Cue::Nothing,
            (_, 0) => Cue::At(self.first_execute),
            // The rudder lies to the side opposite to the next execute, and so does the deviation it causes.
            (Manoeuvre::ZigZag(zig_zag), _) => {
                Cue::Deviation { side: -self.zig_zag_side(zig_zag), angle: zig_zag.heading }
            }
            (Manoeuvre::TurningCircle(turn), _) => match turn.end {
                TurnEnd::HeadingChange(angle) => Cue::Deviation { side: turn.side.sign(), angle },
                TurnEnd::Duration(_) => Cue::Nothing,
            },
            (Manoeuvre::PullOut(pull_out), 1) => Cue::At(self.first_execute + pull_out.hold),
            (Manoeuvre::PullOut(_), _) => Cue::Nothing,
            (Manoeuvre::Williamson(turn), 1) => {
                Cue::Deviation { side: turn.side.sign(), angle: Williamson::FIRST_TURN }
            }
            (Manoeuvre::Williamson(turn), 2) => {
                Cue::Deviation { side: -turn.side.sign(), angle: Williamson::SECOND_TURN }
            }
            (Manoeuvre::Williamson(_), _) => Cue::Nothing,
        }
    }

    /// Side of the next zig-zag execute.
    fn zig_zag_side(&self, zig_zag: &ZigZag) -> f64 {
        if self.made.is_multiple_of(2) { zig_zag.first.sign() } else { -zig_zag.first.sign() }
    }

    /// What the helm does at time `t` (s) when its cue has come: the rudder order, rad, if one is given now.
    pub fn act(&mut self, t: f64) -> Option<f64> {
        if let Cue::Deviation { .. } = self.cue() {
            if let Manoeuvre::TurningCircle(_) = self.manoeuvre {
                self.finish(t);
                return None;
            }
            if self.reaction_time > 0.0 {
                self.due = Some(t + self.reaction_time);
                return None;
            }
        }
        self.due = None;
        let order = match self.manoeuvre {
            Manoeuvre::ZigZag(zig_zag) => self.zig_zag_side(zig_zag) * zig_zag.rudder,
            Manoeuvre::TurningCircle(turn) => turn.side.sign() * turn.rudder,
            Manoeuvre::PullOut(pull_out) if self.made == 0 => pull_out.side.sign() * pull_out.rudder,
            Manoeuvre::Williamson(turn) if self.made < 2 => {
                if self.made == 0 {
                    turn.side.sign() * turn.rudder
                } else {
                    -turn.side.sign() * turn.rudder
                }
            }
            Manoeuvre::PullOut(_) | Manoeuvre::Williamson(_) | Manoeuvre::Replay(_) => 0.0,
        };
        self.made += 1;
        if let Manoeuvre::Williamson(turn) = self.manoeuvre
            && self.made == 3
        {
            self.end = t + turn.duration;
        }
        if let Manoeuvre::ZigZag(zig_zag) = self.manoeuvre
            && zig_zag.end == ZigZagEnd::Executes(self.made)
        {
            self.finish(t);
        }
        Some(order)
    }

    fn finish(&mut self, t: f64) {
        self.finished = true;
        self.end = t;
    }
}
