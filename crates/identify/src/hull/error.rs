//! Reasons why no hull is fitted.

use thiserror::Error;

/// Minimum number of headings of a record.
pub(super) const MIN_HEADINGS: usize = 20;

/// Maximum interval between rows, L/U₀: within two ship lengths a ship can turn and return.
pub(super) const MAX_INTERVAL_LENGTHS: f64 = 2.0;

/// Maximum duration of a record, L/U₀: eleven hours of a ship of 320 m at 8 m/s. Trials last less than a tenth of this,
/// and the computing time of a fit grows with it.
pub(super) const MAX_DURATION_LENGTHS: f64 = 1000.0;

/// Reason why no hull is fitted.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum HullFitError {
    /// Length or approach speed of the ship is not declared.
    #[error("length and approach speed of the ship are missing; declare both in the sidecar of the record")]
    MissingParticulars,
    /// Too few headings in the record of this name.
    #[error("{0} has fewer than {MIN_HEADINGS} headings")]
    TooFewHeadings(String),
    /// Rows too far apart, or a record too long, for a trial of a ship: the clock, length or speed is wrong.
    #[error(
        "{trial} has a row every {row_interval:.3} L/U over {whole:.0} L/U; expected at most {MAX_INTERVAL_LENGTHS} L/U and \
         {MAX_DURATION_LENGTHS} L/U; check the clock, length and speed"
    )]
    ImplausibleTimes {
        /// Name of the record.
        trial: String,
        /// Median time between rows, L/U₀.
        row_interval: f64,
        /// Duration of the record, L/U₀.
        whole: f64,
    },
    /// A record begins near rest, where the priors of a hull do not apply.
    #[error("{trial} begins at {speed_ratio:.2} of the approach speed; begin it in steady approach")]
    StartsNearRest {
        /// Name of the record.
        trial: String,
        /// Surge velocity in the first row, relative to the approach speed.
        speed_ratio: f64,
    },
    /// No coefficients near the prior can be replayed.
    #[error("no hull near its prior can be replayed; check length, speed and rudder sign")]
    NoReplay,
}
