//! Manoeuvres as specifications: what is ordered when. A specification does not change; what happens during one run is
//! kept by the [`crate::helm::Helm`] made from it. Angles in rad, times in s, counted from the first execute.
//!
//! Source of the manoeuvres and their words: ITTC 7.5-04-02-01 Full Scale Manoeuvring Trials.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};
use ship::Polyline;

use crate::error::{self, Checked};
use crate::limits::MOST_EXECUTES;

/// A side of the ship.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Right, seen forward: positive rudder, growing heading.
    #[default]
    Starboard,
    /// Left, seen forward.
    Port,
}

impl Side {
    /// +1 for starboard, −1 for port.
    pub fn sign(self) -> f64 {
        match self {
            Self::Starboard => 1.0,
            Self::Port => -1.0,
        }
    }
}

/// What ends a zig-zag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ZigZagEnd {
    /// The moment of the n-th execute, counted from 1; n executes show n − 2 whole overshoots.
    Executes(usize),
    /// A time after the first execute, s.
    Duration(f64),
    /// The last row of the record, which then needs a duration of its own.
    Record,
}

/// What ends a turning circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TurnEnd {
    /// A time after the execute, s.
    Duration(f64),
    /// A change of heading in the direction of the turn, rad.
    HeadingChange(f64),
}

/// A zig-zag: the rudder is reversed whenever the heading deviates by `heading` from the base course.
///
/// The base course is the heading at the beginning of the run. A 10/20 zig-zag has rudder 10° and heading 20°.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZigZag {
    /// Rudder angle δ, rad, positive whatever the side.
    pub rudder: f64,
    /// Heading deviation ψ at which the rudder is reversed, rad, positive.
    pub heading: f64,
    /// Side of the first execute.
    pub first: Side,
    /// What ends the manoeuvre.
    pub end: ZigZagEnd,
}

/// A turning circle: one order, held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurningCircle {
    /// Rudder angle, rad, positive whatever the side.
    pub rudder: f64,
    /// Side of the turn.
    pub side: Side,
    /// What ends the manoeuvre.
    pub end: TurnEnd,
}

/// A pull-out: a turn, then rudder amidships, to see whether the yaw rate dies out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PullOut {
    /// Rudder angle, rad, positive whatever the side.
    pub rudder: f64,
    /// Side of the turn.
    pub side: Side,
    /// Time the rudder is held, s.
    pub hold: f64,
    /// Time from the order amidships to the end, s.
    pub duration: f64,
}

/// A Williamson turn, which brings a ship back to her own track on the opposite course: hard over until the heading has
/// changed by 60°, hard over to the other side until it is 20° short of the opposite course, then amidships.
///
/// Source: IAMSAR Manual, volume III (man overboard).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Williamson {
    /// Rudder angle, rad, positive whatever the side.
    pub rudder: f64,
    /// Side of the first turn.
    pub side: Side,
    /// Time from the order amidships to the end, s.
    pub duration: f64,
}

impl Williamson {
    /// Change of heading at which the rudder is put over to the other side, rad.
    pub const FIRST_TURN: f64 = PI / 3.0;

    /// Change of heading to the other side at which the rudder is put amidships, rad.
    pub const SECOND_TURN: f64 = PI - PI / 9.0;
}

/// What the ship is asked to do.
#[derive(Debug, Clone, PartialEq)]
pub enum Manoeuvre {
    /// Zig-zag.
    ZigZag(ZigZag),
    /// Turning circle.
    TurningCircle(TurningCircle),
    /// Pull-out.
    PullOut(PullOut),
    /// Williamson turn.
    Williamson(Williamson),
    /// A recorded rudder, followed as it is: no helmsman, no steering gear. Its first point is put at the first
    /// execute.
    Replay(Polyline),
}

/// Time from the first to the last point of a recorded rudder, s.
pub(crate) fn length(signal: &Polyline) -> f64 {
    let times = signal.times();
    times[times.len() - 1] - times[0]
}

impl Manoeuvre {
    /// A zig-zag with starboard first.
    pub fn zig_zag(rudder: f64, heading: f64, end: ZigZagEnd) -> Self {
        Self::ZigZag(ZigZag { rudder, heading, first: Side::Starboard, end })
    }

    /// Largest rudder angle asked for, rad.
    pub fn largest_rudder(&self) -> f64 {
        match self {
            Self::ZigZag(ZigZag { rudder, .. })
            | Self::TurningCircle(TurningCircle { rudder, .. })
            | Self::PullOut(PullOut { rudder, .. })
            | Self::Williamson(Williamson { rudder, .. }) => *rudder,
            Self::Replay(signal) => signal.values().iter().fold(0.0, |largest, delta| largest.max(delta.abs())),
        }
    }

    /// Keys of its rudder angle and of its length in a scenario.
    pub(crate) fn keys(&self) -> [&'static str; 2] {
        match self {
            Self::ZigZag(_) => ["manoeuvre.zig-zag.rudder-deg", "manoeuvre.zig-zag.duration-s"],
            Self::TurningCircle(_) => ["manoeuvre.turning-circle.rudder-deg", "manoeuvre.turning-circle.duration-s"],
            Self::PullOut(_) => ["manoeuvre.pull-out.rudder-deg", "manoeuvre.pull-out.duration-s"],
            Self::Williamson(_) => ["manoeuvre.williamson.rudder-deg", "manoeuvre.williamson.duration-s"],
            Self::Replay(_) => ["manoeuvre.replay.file"; 2],
        }
    }

    /// Checks every value; fails with the first one that makes no sense.
    pub fn validate(&self) -> Checked {
        match self {
            Self::ZigZag(zig_zag) => {
                error::positive("manoeuvre.zig-zag.rudder-deg", zig_zag.rudder)?;
                error::positive("manoeuvre.zig-zag.heading-deg", zig_zag.heading)?;
                match zig_zag.end {
                    ZigZagEnd::Executes(count) => error::count("manoeuvre.zig-zag.executes", count, MOST_EXECUTES),
                    ZigZagEnd::Duration(duration) => error::positive_time("manoeuvre.zig-zag.duration-s", duration),
                    ZigZagEnd::Record => Ok(()),
                }
            }
            Self::TurningCircle(turn) => {
                error::positive("manoeuvre.turning-circle.rudder-deg", turn.rudder)?;
                match turn.end {
                    TurnEnd::Duration(duration) => {
                        error::positive_time("manoeuvre.turning-circle.duration-s", duration)
                    }
                    TurnEnd::HeadingChange(angle) => {
                        error::positive("manoeuvre.turning-circle.heading-change-deg", angle)
                    }
                }
            }
            Self::PullOut(pull_out) => {
                error::positive("manoeuvre.pull-out.rudder-deg", pull_out.rudder)?;
                error::positive_time("manoeuvre.pull-out.hold-s", pull_out.hold)?;
                error::positive_time("manoeuvre.pull-out.duration-s", pull_out.duration)
            }
            Self::Williamson(turn) => {
                error::positive("manoeuvre.williamson.rudder-deg", turn.rudder)?;
                error::positive_time("manoeuvre.williamson.duration-s", turn.duration)
            }
            Self::Replay(signal) => error::positive_time("manoeuvre.replay.file", length(signal)),
        }
    }
}
