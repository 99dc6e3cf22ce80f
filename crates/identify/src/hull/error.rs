//! Why there is no hull.

use thiserror::Error;

/// Fewest headings that a record has to hold.
pub(super) const FEWEST: usize = 20;

/// Farthest that rows may be apart, L/U₀: in two lengths a ship turns and comes back.
pub(super) const COARSEST: f64 = 2.0;

/// Longest record, L/U₀: eleven hours of a ship of 320 m at 8 m/s. Trials take less than a tenth of it, and the time of
/// a fit grows with it.
pub(super) const LONGEST: f64 = 1000.0;

/// Why no hull is fitted.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum HullFitError {
    /// Length or speed are not declared.
    #[error("length and approach speed of the ship are not known")]
    Particulars,
    /// The record of this name is too short.
    #[error("{0} has fewer than {FEWEST} headings")]
    Short(String),
    /// Rows, or the ends of a record, that are farther apart than in any trial of a ship.
    #[error(
        "{trial} has a row every {row:.3} L/U over {whole:.0} L/U; expected at most {COARSEST} L/U and {LONGEST} L/U; check the \
         clock, length and speed"
    )]
    Clock {
        /// Name of the record.
        trial: String,
        /// Median time between rows, L/U₀.
        row: f64,
        /// Its length, L/U₀.
        whole: f64,
    },
    /// A record begins near rest, which no prior of a hull is about.
    #[error("{trial} begins at {share:.2} of the approach speed; begin it in steady approach")]
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
