//! The manoeuvres that are predicted, as they are asked for and as they are steered.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use ship::angle::{from_deg, to_deg};
use simulate::manoeuvre::{PullOut, TurnEnd, TurningCircle, Williamson, ZigZag, ZigZagEnd};
use simulate::{Manoeuvre, Side};

use crate::error::PredictError;

/// Executes of a predicted zig-zag; four overshoots are whole.
pub(crate) const EXECUTES: usize = 6;

/// Change of heading of a predicted turning circle, rad: a little more than the 540° after which speed, drift and pivot
/// of a steady turn can be read.
const TURN: f64 = 3.05 * std::f64::consts::PI;

/// Times of the ship that a turn of a pull-out is held, and that is waited after it.
const PULL_OUT: f64 = 40.0;

/// Times of the ship after the last order of a Williamson turn.
const AFTER_WILLIAMSON: f64 = 20.0;

/// What is done with the rudder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pattern {
    /// The rudder is reversed when the heading deviates by this angle, rad, positive.
    ZigZag {
        /// Deviation of the heading.
        heading: f64,
    },
    /// A turn until the heading has changed by 10°, MSC.137(76).
    InitialTurning,
    /// Turning circle over one and a half rounds.
    TurningCircle,
    /// Pull-out.
    PullOut,
    /// Steady turns up to a rudder to either side, their unstable branch included.
    Spiral,
    /// Williamson turn.
    Williamson,
}

/// A manoeuvre; in files the words of its [`Display`](fmt::Display), which are also read.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(into = "String", try_from = "String")]
#[schemars(with = "String")]
pub struct Kind {
    /// What is done with the rudder.
    pub pattern: Pattern,
    /// Largest rudder angle, rad, positive.
    pub rudder: f64,
    /// Side of the first execute; starboard for a spiral, which goes to either side.
    pub side: Side,
}

/// Rudder of a Williamson turn whose rudder is not given.
const HARD_OVER_DEG: f64 = 35.0;

/// Change of heading of the initial turning test, rad.
pub(crate) const INITIAL_TURN: f64 = 10.0 * ship::angle::DEGREE;

impl Kind {
    /// The manoeuvres of the IMO criteria.
    pub fn of_imo() -> Vec<Self> {
        let to_starboard = |pattern, rudder_deg| Self { pattern, rudder: from_deg(rudder_deg), side: Side::Starboard };
        let zig_zag = |angle_deg| to_starboard(Pattern::ZigZag { heading: from_deg(angle_deg) }, angle_deg);
        vec![zig_zag(10.0), zig_zag(20.0), to_starboard(Pattern::TurningCircle, HARD_OVER_DEG)]
    }

    /// The same manoeuvre to port; a spiral goes to either side.
    pub fn to_port(self) -> Self {
        let side = if self.pattern == Pattern::Spiral { self.side } else { Side::Port };
        Self { side, ..self }
    }

    /// What the helm does, for a ship with this time, s; `None` for a spiral, which is a curve of steady turns.
    pub fn manoeuvre(&self, timescale: f64) -> Option<Manoeuvre> {
        let Self { pattern, rudder, side } = *self;
        let turn =
            |angle: f64| Manoeuvre::TurningCircle(TurningCircle { rudder, side, end: TurnEnd::HeadingChange(angle) });
        Some(match pattern {
            Pattern::ZigZag { heading } => {
                Manoeuvre::ZigZag(ZigZag { rudder, heading, first: side, end: ZigZagEnd::Executes(EXECUTES) })
            }
            Pattern::InitialTurning => turn(INITIAL_TURN),
            Pattern::TurningCircle => turn(TURN),
            Pattern::PullOut => {
                let hold = PULL_OUT * timescale;
                Manoeuvre::PullOut(PullOut { rudder, side, hold, duration: hold })
            }
            Pattern::Williamson => {
                Manoeuvre::Williamson(Williamson { rudder, side, duration: AFTER_WILLIAMSON * timescale })
            }
            Pattern::Spiral => return None,
        })
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self.pattern {
            Pattern::ZigZag { .. } => "zig-zag",
            Pattern::InitialTurning => "initial-turning",
            Pattern::TurningCircle => "turning-circle",
            Pattern::PullOut => "pull-out",
            Pattern::Spiral => "spiral",
            Pattern::Williamson => "williamson",
        };
        write!(f, "{name} {}", Tidy(to_deg(self.rudder * self.side.sign())))?;
        match self.pattern {
            Pattern::ZigZag { heading } => write!(f, "/{}", Tidy(to_deg(heading))),
            _ => Ok(()),
        }
    }
}

impl From<Kind> for String {
    fn from(kind: Kind) -> Self {
        kind.to_string()
    }
}

impl TryFrom<String> for Kind {
    type Error = PredictError;

    fn try_from(text: String) -> Result<Self, PredictError> {
        text.parse()
    }
}

/// An angle in degrees without the rounding of its conversion.
struct Tidy(f64);

impl fmt::Display for Tidy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", (self.0 * 1e6).round() / 1e6)
    }
}

impl FromStr for Kind {
    type Err = PredictError;

    fn from_str(text: &str) -> Result<Self, PredictError> {
        let refused = || PredictError::Manoeuvre { found: text.to_owned() };
        let (name, rest) = text.trim().split_once([':', ' ']).unwrap_or((text.trim(), ""));
        let angle = |text: &str| -> Result<(f64, Side), PredictError> {
            let value: f64 = text.trim().parse().map_err(|_| refused())?;
            if !(value != 0.0 && value.abs() <= 60.0) {
                return Err(refused());
            }
            Ok((from_deg(value.abs()), if value < 0.0 { Side::Port } else { Side::Starboard }))
        };
        let pattern = match name {
            "zig-zag" => Pattern::ZigZag { heading: angle(rest.split_once('/').ok_or_else(refused)?.1)?.0 },
            "initial-turning" => Pattern::InitialTurning,
            "turning-circle" => Pattern::TurningCircle,
            "pull-out" => Pattern::PullOut,
            "spiral" => Pattern::Spiral,
            "williamson" => Pattern::Williamson,
            _ => return Err(refused()),
        };
        let (rudder, side) = match (pattern, rest) {
            (Pattern::Williamson, "") => (from_deg(HARD_OVER_DEG), Side::Starboard),
            (Pattern::Spiral, rudder) => (angle(rudder)?.0, Side::Starboard),
            (Pattern::ZigZag { .. }, angles) => angle(angles.split('/').next().unwrap_or_default())?,
            (_, rudder) => angle(rudder)?,
        };
        Ok(Self { pattern, rudder, side })
    }
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
            let kind: Kind = text.parse().expect("known");
            assert_eq!(kind.to_string(), name);
            assert_eq!(name.parse::<Kind>(), Ok(kind));
        }
        for wrong in ["", "zig-zag", "zig-zag:10", "zig-zag:0/10", "circle:35", "spiral:x", "pull-out:90"] {
            let said = wrong.parse::<Kind>().expect_err("refused").to_string();
            assert!(said.contains("zig-zag:RUDDER/HEADING"), "{said}");
        }
    }
}
