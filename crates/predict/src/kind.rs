//! The manoeuvres that are predicted, as they are asked for and as they are steered.

use std::fmt;
use std::str::FromStr;

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

/// A manoeuvre, angles in rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// Zig-zag with this rudder and heading.
    ZigZag {
        /// Rudder angle, positive.
        rudder: f64,
        /// Deviation of the heading at which the rudder is reversed, positive.
        heading: f64,
        /// Side of the first execute.
        first: Side,
    },
    /// A turn until the heading has changed by 10°, MSC.137(76).
    InitialTurning {
        /// Rudder angle, positive.
        rudder: f64,
        /// Side.
        side: Side,
    },
    /// Turning circle over one and a half rounds.
    TurningCircle {
        /// Rudder angle, positive.
        rudder: f64,
        /// Side.
        side: Side,
    },
    /// Pull-out.
    PullOut {
        /// Rudder angle, positive.
        rudder: f64,
        /// Side.
        side: Side,
    },
    /// Steady turns up to this rudder to either side, their unstable branch included.
    Spiral {
        /// Largest rudder angle, positive.
        rudder: f64,
    },
    /// Williamson turn.
    Williamson {
        /// Rudder angle, positive.
        rudder: f64,
        /// Side of the first turn.
        side: Side,
    },
}

/// Rudder of a Williamson turn whose rudder is not given.
const HARD_OVER_DEG: f64 = 35.0;

/// Change of heading of the initial turning test, rad.
pub(crate) const INITIAL_TURN: f64 = 10.0 * ship::angle::DEGREE;

impl Kind {
    /// The manoeuvres of the IMO criteria.
    pub fn of_imo() -> Vec<Self> {
        let zig_zag = |angle_deg: f64| {
            let angle = from_deg(angle_deg);
            Self::ZigZag { rudder: angle, heading: angle, first: Side::Starboard }
        };
        vec![
            zig_zag(10.0),
            zig_zag(20.0),
            Self::TurningCircle { rudder: from_deg(HARD_OVER_DEG), side: Side::Starboard },
        ]
    }

    /// The same manoeuvre to port; a spiral goes to either side.
    pub fn to_port(mut self) -> Self {
        match &mut self {
            Self::ZigZag { first: side, .. }
            | Self::InitialTurning { side, .. }
            | Self::TurningCircle { side, .. }
            | Self::PullOut { side, .. }
            | Self::Williamson { side, .. } => *side = Side::Port,
            Self::Spiral { .. } => {}
        }
        self
    }

    /// Largest rudder angle, rad.
    pub fn rudder(&self) -> f64 {
        match *self {
            Self::ZigZag { rudder, .. }
            | Self::InitialTurning { rudder, .. }
            | Self::TurningCircle { rudder, .. }
            | Self::PullOut { rudder, .. }
            | Self::Spiral { rudder }
            | Self::Williamson { rudder, .. } => rudder,
        }
    }

    /// What the helm does, for a ship with this time, s; `None` for a spiral, which is a curve of steady turns.
    pub fn manoeuvre(&self, timescale: f64) -> Option<Manoeuvre> {
        Some(match *self {
            Self::ZigZag { rudder, heading, first } => {
                Manoeuvre::ZigZag(ZigZag { rudder, heading, first, end: ZigZagEnd::Executes(EXECUTES) })
            }
            Self::InitialTurning { rudder, side } => {
                Manoeuvre::TurningCircle(TurningCircle { rudder, side, end: TurnEnd::HeadingChange(INITIAL_TURN) })
            }
            Self::TurningCircle { rudder, side } => {
                Manoeuvre::TurningCircle(TurningCircle { rudder, side, end: TurnEnd::HeadingChange(TURN) })
            }
            Self::PullOut { rudder, side } => {
                let hold = PULL_OUT * timescale;
                Manoeuvre::PullOut(PullOut { rudder, side, hold, duration: hold })
            }
            Self::Williamson { rudder, side } => {
                Manoeuvre::Williamson(Williamson { rudder, side, duration: AFTER_WILLIAMSON * timescale })
            }
            Self::Spiral { .. } => return None,
        })
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let signed = |angle: f64, side: Side| to_deg(angle * side.sign());
        match *self {
            Self::ZigZag { rudder, heading, first } => {
                write!(f, "zig-zag {}/{}", Tidy(signed(rudder, first)), Tidy(to_deg(heading)))
            }
            Self::InitialTurning { rudder, side } => write!(f, "initial-turning {}", Tidy(signed(rudder, side))),
            Self::TurningCircle { rudder, side } => write!(f, "turning-circle {}", Tidy(signed(rudder, side))),
            Self::PullOut { rudder, side } => write!(f, "pull-out {}", Tidy(signed(rudder, side))),
            Self::Spiral { rudder } => write!(f, "spiral {}", Tidy(to_deg(rudder))),
            Self::Williamson { rudder, side } => write!(f, "williamson {}", Tidy(signed(rudder, side))),
        }
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
        match name {
            "zig-zag" => {
                let (rudder, heading) = rest.split_once('/').ok_or_else(refused)?;
                let ((rudder, first), (heading, _)) = (angle(rudder)?, angle(heading)?);
                Ok(Self::ZigZag { rudder, heading, first })
            }
            "initial-turning" => angle(rest).map(|(rudder, side)| Self::InitialTurning { rudder, side }),
            "turning-circle" => angle(rest).map(|(rudder, side)| Self::TurningCircle { rudder, side }),
            "pull-out" => angle(rest).map(|(rudder, side)| Self::PullOut { rudder, side }),
            "spiral" => angle(rest).map(|(rudder, _)| Self::Spiral { rudder }),
            "williamson" if rest.is_empty() => {
                Ok(Self::Williamson { rudder: from_deg(HARD_OVER_DEG), side: Side::Starboard })
            }
            "williamson" => angle(rest).map(|(rudder, side)| Self::Williamson { rudder, side }),
            _ => Err(refused()),
        }
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
