//! Why there is no hull.

use thiserror::Error;

/// Fewest headings that a record has to hold.
pub(super) const FEWEST: usize = 20;

/// Why no hull is fitted.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum HullFitError {
    /// Length or speed are not declared.
    #[error("length and approach speed of the ship are not known")]
    Particulars,
    /// A record is too short.
    #[error("{trial} has fewer than {FEWEST} headings")]
    Short {
        /// Name of the record.
        trial: String,
    },
    /// A record begins near rest, which no prior of a hull is about.
    #[error("{trial} begins at {share:.2} of the approach speed")]
    GathersWay {
        /// Name of the record.
        trial: String,
        /// Speed in its first row over that of the approach.
        share: f64,
    },
    /// No values near the expected ones can be replayed.
    #[error("no hull near the expected one can be replayed")]
    NoReplay,
}
