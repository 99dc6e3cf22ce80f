//! What a benchmark asks.

use serde::{Deserialize, Serialize};

/// A task.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Task {
    /// Fit a record and replay its rudder on it.
    Identify,
    /// Find K and T of a ship that is first order.
    Indices,
    /// Fit a zig-zag to one side first, replay one to the other.
    OtherSide,
    /// Fit a zig-zag, replay one of another rudder or heading angle.
    OtherAmplitude,
    /// Fit zig-zags, replay a turning circle.
    Circle,
    /// Name the effect that a first-order ship lacks.
    Name,
}

impl Task {
    /// All tasks, in the order of reports.
    pub const ALL: [Self; 6] =
        [Self::Identify, Self::Indices, Self::OtherSide, Self::OtherAmplitude, Self::Circle, Self::Name];

    /// The word used in files and on the command line.
    pub fn id(self) -> &'static str {
        match self {
            Self::Identify => "identify",
            Self::Indices => "indices",
            Self::OtherSide => "other-side",
            Self::OtherAmplitude => "other-amplitude",
            Self::Circle => "circle",
            Self::Name => "name",
        }
    }

    /// What it is, in a few words.
    pub fn title(self) -> &'static str {
        match self {
            Self::Identify => "replay the fitted record",
            Self::Indices => "find K and T",
            Self::OtherSide => "predict the other side",
            Self::OtherAmplitude => "predict another amplitude",
            Self::Circle => "predict the turning circle",
            Self::Name => "name the missing effect",
        }
    }

    /// What the score is; `None` where an answer is right or wrong.
    pub fn score(self) -> Option<&'static str> {
        match self {
            Self::Indices => Some("larger error of K and T [%]"),
            Self::Name => None,
            _ => Some("rms error of the heading [°]"),
        }
    }

    /// Whether a record is predicted that was not fitted.
    pub fn is_prediction(self) -> bool {
        matches!(self, Self::OtherSide | Self::OtherAmplitude | Self::Circle)
    }
}
