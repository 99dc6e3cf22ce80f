//! Why the settings of a method are refused; shared by every method, found before any record is read.

use ship::Shown;
use thiserror::Error;

/// A setting out of its range.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{key} = {found}: expected {expected}")]
pub struct SettingsError {
    /// The key as it is written in a scenario.
    pub key: &'static str,
    /// The value found.
    pub found: String,
    /// What would be accepted, in words.
    pub expected: &'static str,
}

impl SettingsError {
    /// A refusal that names the key, the value found and what would be accepted.
    pub fn new(key: &'static str, found: impl ToString, expected: &'static str) -> Self {
        Self { key, found: found.to_string(), expected }
    }
}

/// Most steps of an iteration: what has not settled in a thousand never does.
pub(crate) const MOST_ITERATIONS: usize = 1000;

/// Refuses a number of iterations that is none, or has no end.
pub(crate) fn check_iterations(key: &'static str, iterations: usize) -> Result<(), SettingsError> {
    let holds = (1..=MOST_ITERATIONS).contains(&iterations);
    if holds { Ok(()) } else { Err(SettingsError::new(key, iterations, "1 to 1000")) }
}

/// Refuses a `condition-limit` that no equations can keep.
pub(crate) fn check_condition_limit(limit: f64) -> Result<(), SettingsError> {
    // Written so that NaN is refused too.
    if limit > 1.0 { Ok(()) } else { Err(SettingsError::new("condition-limit", Shown(limit), "a number above 1")) }
}

/// Refuses a `longest-gap-s` that is no time.
pub(crate) fn check_longest_gap(gap_s: Option<f64>) -> Result<(), SettingsError> {
    match gap_s {
        Some(gap) if gap.is_nan() || gap <= 0.0 => {
            Err(SettingsError::new("longest-gap-s", Shown(gap), "a positive time"))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use crate::fourier::Fundamental;
    use crate::fourier::fundamental::StartPoint::FftPeak;
    use crate::savitzky_golay::SavitzkyGolay;
    use crate::{IdentifierSettings as Of, fourier_published, least_squares, output_error, srivc};

    /// Counts that would take all memory or all time, and numbers whose size has to be seen.
    #[test]
    fn settings_that_cannot_end_are_refused() {
        let published = |settings: fourier_published::Settings| Of::FourierPublished(settings);
        let series = |fundamental| published(fourier_published::Settings { fundamental, ..Default::default() });
        let triples = |triples| published(fourier_published::Settings { triples, ..Default::default() });
        let error = |settings| Of::OutputError(settings);
        let default = output_error::Settings::default;
        let smoothing = Some(SavitzkyGolay { window_samples: 1_000_000_001, order: 3 });
        for (settings, key, found) in [
            (triples(usize::MAX), "triples", "18446744073709551615"),
            (triples(10_001), "triples", "10001"),
            (series(Fundamental::FixedRadS(1e300)), "fundamental.fixed-rad-s", "1e300"),
            (series(Fundamental::Starts(vec![FftPeak; 4])), "fundamental.starts", "a list of 4 starts"),
            (
                Of::LeastSquares(least_squares::Settings { smoothing, ..Default::default() }),
                "window-samples",
                "1000000001",
            ),
            (error(output_error::Settings { iterations: 1001, ..default() }), "iterations", "1001"),
            (error(output_error::Settings { grid_per_decade: 1001, ..default() }), "grid-per-decade", "1001"),
            (
                error(output_error::Settings { smallest_time_constant_s: Some(1e-300), ..default() }),
                "smallest-time-constant-s",
                "1e-300",
            ),
            (Of::Srivc(srivc::Settings { max_iterations: 1001, ..Default::default() }), "max-iterations", "1001"),
        ] {
            let error = settings.build().err().expect("it cannot end");
            assert_eq!((error.key, error.found.as_str()), (key, found), "{error}");
        }
    }
}
