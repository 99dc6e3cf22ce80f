//! What a ship can do, and what it is called in lists.

use ship::angle::to_deg;

use crate::zigzag::holds::conventional_deg;

/// What a ship did.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Kind {
    /// A zig-zag; angles as executed.
    ZigZag {
        /// Rudder laid, rad: median over the holds to each side, and the mean of both sides.
        rudder: f64,
        /// Change of heading from the base course at which the rudder was reversed, rad: median over the executes.
        heading: f64,
    },
    /// A turn of half a circle or more with the rudder held.
    TurningCircle {
        /// Rudder held, rad, positive to starboard.
        rudder: f64,
        /// Change of heading under that rudder, rad, positive to starboard.
        turned: f64,
    },
    /// Rudder amidships after a turn.
    PullOut {
        /// Rudder of the turn before, rad, positive to starboard.
        rudder: f64,
    },
    /// A Dieudonné spiral: the rudder goes from side to side in steps and is held at each until the turn is steady.
    Spiral {
        /// Largest rudder angle, rad.
        largest: f64,
        /// Number of holds.
        steps: usize,
    },
    /// The ship keeps her course, by herself or under an autopilot.
    Straight,
}

impl Kind {
    /// A name for lists, with conventional angles: "zig-zag 10/10", "turning circle 35 to starboard", "pull-out",
    /// "spiral", "straight".
    pub fn name(&self) -> String {
        match *self {
            Self::ZigZag { rudder, heading } => {
                format!("zig-zag {}/{}", conventional(rudder, 0.08, 0.08), conventional(heading, 0.05, 0.25))
            }
            Self::TurningCircle { rudder, .. } => {
                let side = if rudder < 0.0 { "port" } else { "starboard" };
                format!("turning circle {} to {side}", conventional(rudder, 0.08, 0.08))
            }
            Self::PullOut { .. } => String::from("pull-out"),
            Self::Spiral { .. } => String::from("spiral"),
            Self::Straight => String::from("straight"),
        }
    }
}

/// The conventional angle near a measured one, for a name; see [`conventional_deg`].
fn conventional(angle: f64, below: f64, above: f64) -> String {
    let degrees = to_deg(angle.abs());
    conventional_deg(degrees, below, above, 0.0).map_or_else(|| format!("{degrees:.1}"), |angle| format!("{angle:.0}"))
}
