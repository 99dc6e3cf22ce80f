//! Manoeuvres: the rudder orders of each, its keys in a file and its name in a list. Helm and steering gear are in the
//! simulator, detection in a log in [`crate::find`], predicted characteristics in `predict`.
//!
//! In a file angles are in degrees, in the program in rad; times are in s.
//!
//! Sources: ITTC 7.5-04-02-01 Full Scale Manoeuvring Trials; MSC.137(76) for the initial turning test; IAMSAR Manual,
//! volume III, for the Williamson turn.

use std::f64::consts::PI;
use std::fmt;
use std::str::FromStr;

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use ship::Polyline;
use ship::angle::{DEGREE, from_deg, to_deg};

use crate::degrees::Degrees;
use crate::zigzag::Side;

/// Manoeuvre; in a file it has one key, its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Manoeuvre {
    /// Zig-zag: the rudder is reversed at each deviation of the heading by ψ from the base course.
    ZigZag {
        /// Rudder angle δ to either side.
        #[serde(rename = "rudder-deg", with = "Degrees::<f64>")]
        rudder: f64,
        /// Deviation of the heading ψ from the base course at which the rudder is reversed.
        #[serde(rename = "heading-deg", with = "Degrees::<f64>")]
        heading: f64,
        /// Side of the first execute.
        #[serde(default)]
        first: Side,
        /// Number of the execute that ends the manoeuvre, or `duration-s`; left out, the end of the record is its end.
        executes: Option<usize>,
        /// Time from the first execute to the end, or `executes`.
        #[serde(rename = "duration-s")]
        duration: Option<f64>,
    },
    /// Turning circle: one rudder order, held.
    TurningCircle {
        /// Rudder angle δ.
        #[serde(rename = "rudder-deg", with = "Degrees::<f64>")]
        rudder: f64,
        /// Side of the turn.
        #[serde(default)]
        side: Side,
        /// Time from the execute to the end, or `heading-change-deg`.
        #[serde(rename = "duration-s")]
        duration: Option<f64>,
        /// Change of heading that ends the turn, or `duration-s`.
        #[serde(default, rename = "heading-change-deg", with = "Degrees::<Option<f64>>")]
        heading_change: Option<f64>,
    },
    /// Pull-out: a turn, then rudder amidships.
    PullOut {
        /// Rudder angle δ of the turn.
        #[serde(rename = "rudder-deg", with = "Degrees::<f64>")]
        rudder: f64,
        /// Side of the turn.
        #[serde(default)]
        side: Side,
        /// Duration of the held rudder.
        #[serde(rename = "hold-s")]
        hold: f64,
        /// Time from the order amidships to the end.
        #[serde(rename = "duration-s")]
        duration: f64,
    },
    /// Rudder of a record, replayed without helmsman and steering gear.
    Replay {
        /// Record with a rudder, relative to the scenario.
        file: String,
        /// Recorded rudder, rad; its first point is put at the first execute.
        #[serde(skip)]
        rudder: Option<Polyline>,
    },
    /// A turn until the heading has changed by 10°, MSC.137(76).
    #[serde(skip)]
    InitialTurning {
        /// Rudder angle, rad.
        rudder: f64,
        /// Side of the turn.
        side: Side,
    },
    /// Williamson turn, which returns a ship to her own track on the opposite course: hard over until the heading
    /// has changed by 60°, hard over to the opposite side until it is 20° short of the opposite course, then amidships.
    #[serde(skip)]
    Williamson {
        /// Rudder angle, rad.
        rudder: f64,
        /// Side of the first turn.
        side: Side,
        /// Time from the order amidships to the end, s.
        duration: f64,
    },
    /// Spiral curve: steady turns at rudder angles up to `rudder` on either side, unstable branch included; computed,
    /// not steered.
    #[serde(skip)]
    Spiral {
        /// Maximum rudder angle, rad.
        rudder: f64,
    },
}

/// Condition that triggers the next order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trigger {
    /// Time, s: from the previous order in an [`OrderStep`], on the clock of the run in the trigger of a helmsman.
    Time(f64),
    /// `side` · (ψ − base course) ≥ `angle`, with side ±1 and angle in rad.
    Deviation {
        /// Direction of the deviation, +1 to starboard.
        side: f64,
        /// Size of the deviation, rad.
        angle: f64,
    },
    /// No condition; no order follows.
    Never,
}

/// Step of a manoeuvre: a rudder order, or the end, with the condition that triggers it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrderStep {
    /// Condition that triggers the order or the end.
    pub trigger: Trigger,
    /// Ordered rudder, rad; `None` for the end of the manoeuvre.
    pub ordered_rudder: Option<f64>,
    /// Scenario key of the trigger.
    pub key: &'static str,
}

/// Change of heading of the initial turning test, rad.
pub const INITIAL_TURNING_CHANGE_RAD: f64 = 10.0 * DEGREE;

/// Changes of heading in a Williamson turn, rad: to the first side until the rudder is reversed, then to the opposite
/// side until it is put amidships.
const WILLIAMSON: [f64; 2] = [PI / 3.0, PI - PI / 9.0];

/// Default rudder of a Williamson turn, degrees.
const HARD_OVER_DEG: f64 = 35.0;

impl Manoeuvre {
    /// Zig-zag with starboard first, until the end of the record; angles in rad.
    pub fn zig_zag(rudder: f64, heading: f64) -> Self {
        Self::ZigZag { rudder, heading, first: Side::Starboard, executes: None, duration: None }
    }

    /// Turning circle to starboard with a rudder (rad), without an end.
    pub fn turning_circle(rudder: f64) -> Self {
        Self::TurningCircle { rudder, side: Side::Starboard, duration: None, heading_change: None }
    }

    /// Replay of a recorded rudder, rad.
    pub fn replay(rudder: Polyline) -> Self {
        Self::Replay { file: String::new(), rudder: Some(rudder) }
    }

    /// Zig-zag that ends at an execute, counted from 1; n executes give n − 2 complete overshoots. Other manoeuvres are
    /// unchanged.
    pub fn until_execute(mut self, number: usize) -> Self {
        if let Self::ZigZag { executes, .. } = &mut self {
            *executes = Some(number);
        }
        self
    }

    /// Zig-zag or turning circle that ends a time (s) after its first execute; other manoeuvres are unchanged.
    pub fn lasting(mut self, time: f64) -> Self {
        if let Self::ZigZag { duration, .. } | Self::TurningCircle { duration, .. } = &mut self {
            *duration = Some(time);
        }
        self
    }

    /// Step that follows a number of orders, 0 for the first step, which is given at once.
    pub fn order_step(&self, orders: usize) -> OrderStep {
        use Trigger::{Deviation, Never, Time};
        let (trigger, order, key) = match (self, orders) {
            (Self::ZigZag { executes: Some(executes), .. }, _) if orders >= *executes => {
                (Time(0.0), None, "manoeuvre.zig-zag.executes")
            }
            (Self::ZigZag { rudder, heading, first, .. }, _) => {
                let side = if orders.is_multiple_of(2) { first.sign() } else { -first.sign() };
                // The rudder is on the side opposite to the next execute, and so is the deviation it causes.
                let deviation = Deviation { side: -side, angle: *heading };
                (if orders == 0 { Time(0.0) } else { deviation }, Some(side * rudder), "manoeuvre.zig-zag.executes")
            }
            (
                Self::TurningCircle { rudder, side, .. }
                | Self::InitialTurning { rudder, side }
                | Self::PullOut { rudder, side, .. }
                | Self::Williamson { rudder, side, .. },
                0,
            ) => (Time(0.0), Some(side.sign() * rudder), "approach.lead-in-s"),
            (Self::TurningCircle { duration: Some(duration), .. }, _) => {
                (Time(*duration), None, "manoeuvre.turning-circle.duration-s")
            }
            (Self::TurningCircle { side, heading_change: Some(angle), .. }, _) => {
                let trigger = Deviation { side: side.sign(), angle: *angle };
                (trigger, None, "manoeuvre.turning-circle.heading-change-deg")
            }
            (Self::TurningCircle { .. }, _) => (Never, None, "recording.duration-s"),
            (Self::InitialTurning { side, .. }, _) => {
                (Deviation { side: side.sign(), angle: INITIAL_TURNING_CHANGE_RAD }, None, "manoeuvre")
            }
            (Self::PullOut { hold, .. }, 1) => (Time(*hold), Some(0.0), "manoeuvre.pull-out.hold-s"),
            (Self::PullOut { duration, .. }, _) => (Time(*duration), None, "manoeuvre.pull-out.duration-s"),
            (Self::Williamson { rudder, side, .. }, 1) => {
                (Deviation { side: side.sign(), angle: WILLIAMSON[0] }, Some(-side.sign() * rudder), "manoeuvre")
            }
            (Self::Williamson { side, .. }, 2) => {
                (Deviation { side: -side.sign(), angle: WILLIAMSON[1] }, Some(0.0), "manoeuvre")
            }
            (Self::Williamson { duration, .. }, _) => (Time(*duration), None, "manoeuvre"),
            (Self::Replay { .. }, _) => (Time(self.length_of_record()), None, "manoeuvre.replay.file"),
            (Self::Spiral { .. }, _) => (Never, None, "manoeuvre"),
        };
        OrderStep { trigger, ordered_rudder: order, key }
    }

    /// Steps in order, up to the end of the manoeuvre; endless for a zig-zag without a number of executes.
    pub fn order_steps(&self) -> impl Iterator<Item = OrderStep> {
        let mut ended = false;
        (0..)
            .map(|orders| self.order_step(orders))
            .take_while(move |step| !std::mem::replace(&mut ended, step.ordered_rudder.is_none()))
    }

    /// Time from the first execute to the end, s; infinite if a heading or the end of the recording determines it.
    pub fn duration(&self) -> f64 {
        if let Self::ZigZag { duration: Some(duration), .. } = self {
            return *duration;
        }
        let mut total = 0.0;
        for step in self.order_steps() {
            match step.trigger {
                Trigger::Time(time) => total += time,
                Trigger::Deviation { .. } | Trigger::Never => return f64::INFINITY,
            }
        }
        total
    }

    /// Maximum number of rudder orders; [`usize::MAX`] for a zig-zag without a number of executes.
    pub fn max_executes(&self) -> usize {
        match self {
            Self::ZigZag { executes, .. } => executes.unwrap_or(usize::MAX),
            _ => self.order_steps().filter(|step| step.ordered_rudder.is_some()).count(),
        }
    }

    /// Maximum ordered rudder angle, rad.
    pub fn max_rudder(&self) -> f64 {
        match self {
            Self::ZigZag { rudder, .. }
            | Self::TurningCircle { rudder, .. }
            | Self::PullOut { rudder, .. }
            | Self::InitialTurning { rudder, .. }
            | Self::Williamson { rudder, .. }
            | Self::Spiral { rudder } => *rudder,
            Self::Replay { rudder, .. } => {
                let values = rudder.iter().flat_map(Polyline::values);
                values.fold(0.0, |largest: f64, delta| largest.max(delta.abs()))
            }
        }
    }

    /// Side of the first execute; starboard for a replay and a spiral.
    pub fn first_side(&self) -> Side {
        match self {
            Self::ZigZag { first: side, .. }
            | Self::TurningCircle { side, .. }
            | Self::PullOut { side, .. }
            | Self::InitialTurning { side, .. }
            | Self::Williamson { side, .. } => *side,
            Self::Replay { .. } | Self::Spiral { .. } => Side::Starboard,
        }
    }

    /// Manoeuvre with its first execute to the given side; a replay and a spiral are unchanged.
    pub fn with_first_side(mut self, first_side: Side) -> Self {
        match &mut self {
            Self::ZigZag { first: side, .. }
            | Self::TurningCircle { side, .. }
            | Self::PullOut { side, .. }
            | Self::InitialTurning { side, .. }
            | Self::Williamson { side, .. } => *side = first_side,
            Self::Replay { .. } | Self::Spiral { .. } => {}
        }
        self
    }

    /// Name of the manoeuvre: its key in a scenario and on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Self::ZigZag { .. } => "zig-zag",
            Self::TurningCircle { .. } => "turning-circle",
            Self::PullOut { .. } => "pull-out",
            Self::Replay { .. } => "replay",
            Self::InitialTurning { .. } => "initial-turning",
            Self::Williamson { .. } => "williamson",
            Self::Spiral { .. } => "spiral",
        }
    }

    /// Time from the first to the last point of a recorded rudder, s.
    fn length_of_record(&self) -> f64 {
        let Self::Replay { rudder: Some(rudder), .. } = self else { return 0.0 };
        let times = rudder.times();
        times[times.len() - 1] - times[0]
    }
}

/// Writes the notation of the command line with a blank for the colon: "zig-zag 20/10", "pull-out -20" to port.
impl fmt::Display for Manoeuvre {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.name(), rounded_deg(self.max_rudder() * self.first_side().sign()))?;
        match self {
            Self::ZigZag { heading, .. } => write!(f, "/{}", rounded_deg(*heading)),
            _ => Ok(()),
        }
    }
}

/// Angle (rad) in degrees, rounded to a millionth.
pub fn rounded_deg(angle: f64) -> f64 {
    (to_deg(angle) * 1e6).round() / 1e6
}

/// Error of a text that is not a manoeuvre; contains the text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{0}` is not a manoeuvre; expected zig-zag:RUDDER/HEADING, initial-turning:RUDDER, turning-circle:RUDDER, \
     pull-out:RUDDER, spiral:RUDDER or williamson, angles in degrees, negative for port"
)]
pub struct ManoeuvreParseError(pub String);

/// Reads the notation of the command line. The manoeuvre has no end, and its times are 0.
impl FromStr for Manoeuvre {
    type Err = ManoeuvreParseError;

    fn from_str(text: &str) -> Result<Self, ManoeuvreParseError> {
        let refused = || ManoeuvreParseError(text.to_owned());
        let (name, angles) = text.trim().split_once([':', ' ']).unwrap_or((text.trim(), ""));
        let (rudder, heading) = match angles.split_once('/') {
            Some((rudder, heading)) if name == "zig-zag" => (rudder, Some(heading)),
            _ => (angles, None),
        };
        let angle = |text: &str| -> Result<(f64, Side), ManoeuvreParseError> {
            let value: f64 = text.trim().parse().map_err(|_| refused())?;
            if !(value != 0.0 && value.abs() <= 60.0) {
                return Err(refused());
            }
            Ok((from_deg(value.abs()), if value < 0.0 { Side::Port } else { Side::Starboard }))
        };
        if (name, angles) == ("williamson", "") {
            return Ok(Self::Williamson { rudder: from_deg(HARD_OVER_DEG), side: Side::Starboard, duration: 0.0 });
        }
        let (rudder, side) = angle(rudder)?;
        Ok(match name {
            "zig-zag" => {
                // The sign of the rudder says which side comes first; the heading is a change to either side.
                let (heading, Side::Starboard) = angle(heading.ok_or_else(refused)?)? else { return Err(refused()) };
                Self::ZigZag { rudder, heading, first: side, executes: None, duration: None }
            }
            "initial-turning" => Self::InitialTurning { rudder, side },
            "turning-circle" => Self::TurningCircle { rudder, side, duration: None, heading_change: None },
            "pull-out" => Self::PullOut { rudder, side, hold: 0.0, duration: 0.0 },
            "williamson" => Self::Williamson { rudder, side, duration: 0.0 },
            "spiral" => Self::Spiral { rudder },
            _ => return Err(refused()),
        })
    }
}

/// Writes a manoeuvre as its [`Display`](fmt::Display) text: for `serialize_with`.
pub fn serialize_text<S: Serializer>(manoeuvre: &Manoeuvre, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(manoeuvre)
}

/// Reads a manoeuvre from its [`Display`](fmt::Display) text: for `deserialize_with`.
pub fn deserialize_text<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Manoeuvre, D::Error> {
    String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_and_written() {
        for (text, name) in [
            ("zig-zag:10/10", "zig-zag 10/10"),
            ("zig-zag:-20/10", "zig-zag -20/10"),
            ("turning-circle:35", "turning-circle 35"),
            ("pull-out:-20", "pull-out -20"),
            ("spiral:15", "spiral 15"),
            ("initial-turning:10", "initial-turning 10"),
            ("williamson", "williamson 35"),
        ] {
            let manoeuvre: Manoeuvre = text.parse().expect("known");
            assert_eq!(manoeuvre.to_string(), name);
            assert_eq!(name.parse::<Manoeuvre>(), Ok(manoeuvre));
        }
        for wrong in
            ["", "zig-zag", "zig-zag:10", "zig-zag:0/10", "zig-zag:10/-10", "circle:35", "spiral:x", "pull-out:90"]
        {
            let message = wrong.parse::<Manoeuvre>().expect_err("refused").to_string();
            assert!(message.contains("zig-zag:RUDDER/HEADING"), "{message}");
        }
    }
}
