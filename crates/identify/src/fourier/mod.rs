//! Fourier series of a heading record with a free fundamental: ψ(t) = a₀ + Σ (aₙ cos n w t + bₙ sin n w t), n = 1..N.
//! Source of the form: Ge, Hu, Yin and Sun, Identification of Ship Maneuverability Indexes by Fourier Method, equation
//! (9).
//!
//! Shared by `fourier-published` and `fourier-projected`, and by plots of a fit. Because w is free this is a nonlinear
//! regression, not a Fourier analysis: RSS(w) has many local minima, and the lowest minimum often has a period longer
//! than the record, large cancelling coefficients and poor derivatives. [`Fundamental`] lists the rules to choose w.
//!
//! | to learn about | read |
//! |---|---|
//! | choosing w | `fundamental` |
//! | the series on the instants of a record | `basis` |
//! | RSS as a function of w | `profile` |
//! | a record folded about its middle | `folded_rows` |
//! | triples of instants, eq. (10) of the paper | `triples` |
//! | regression on a pair of projected signals | [`regression`] |

pub(crate) mod basis;
mod curve;
mod folded_rows;
pub(crate) mod fundamental;
mod profile;
pub mod regression;
pub(crate) mod triples;

pub use basis::{Basis, Projection};
pub use curve::FourierSeries;
pub use fundamental::Fundamental;
pub use profile::MAX_HARMONICS;

use document::{Warning, WarningCode};

use crate::error::IdentifyError;
use crate::estimate::StopReason;

/// Maximum condition number of the basis for the use of derivatives of the curve.
pub const MAX_TRUSTED_CONDITION: f64 = 1e4;

/// Fourier fit of a heading: the curve with its basis and projection.
#[derive(Debug, Clone)]
pub struct FittedSeries {
    /// Fitted curve.
    pub curve: FourierSeries,
    /// Basis, for the projection of other signals of the record.
    pub basis: Basis,
    /// Coefficients and residual of the heading on the basis.
    pub projection: Projection,
    /// Reason why the search for w stopped.
    pub stop: StopReason,
    /// Number of fundamentals tried.
    pub evaluations: usize,
}

/// Fits a heading (rad) given at `time` (s, increasing, from 0) by a series of `harmonics` harmonics.
///
/// Fails with [`IdentifyError::TooFewPoints`] if there are not more headings than coefficients or if a rule that needs
/// a period finds none. Settings are expected to be valid ([`Fundamental::check`], 1 ≤ N ≤ [`MAX_HARMONICS`]).
pub fn fit(
    time: &[f64],
    heading: &[f64],
    harmonics: usize,
    fundamental: &Fundamental,
) -> Result<FittedSeries, IdentifyError> {
    let (needed, count) = (2 * harmonics + 2, time.len());
    if count < needed {
        return Err(IdentifyError::TooFewPoints { kind: "headings for the Fourier series", needed, count });
    }
    let choice = fundamental.choose(time, heading, harmonics)?;
    let basis = Basis::new(time, choice.fundamental, harmonics)?;
    let projection = basis.project(heading);
    let curve = basis.fourier_series(&projection);
    Ok(FittedSeries { curve, basis, projection, stop: choice.stop, evaluations: choice.evaluations })
}

/// Diagnostics of the fits: w and N of the first trial, minimum R² and maximum condition number of all trials.
pub(crate) fn diagnostics(fits: &[FittedSeries]) -> Vec<(&'static str, f64)> {
    let first = fits.first().map(|fit| &fit.curve);
    let r_squared = fits.iter().fold(1.0f64, |least, fit| least.min(fit.curve.r_squared));
    let condition = fits.iter().fold(1.0f64, |most, fit| most.max(fit.curve.condition));
    let mut all = vec![("fit_r_squared", r_squared), ("basis_condition", condition)];
    if let Some(curve) = first {
        all.push(("fundamental_rad_s", curve.fundamental));
        all.push(("harmonics", curve.cosine.len() as f64));
    }
    all
}

/// Warnings on a fundamental at the edge of the search and on ill-conditioned bases.
pub(crate) fn warnings(fits: &[FittedSeries]) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for FittedSeries { curve, stop, .. } in fits {
        if *stop == StopReason::RangeLimit {
            warnings.push(WarningCode::AtBound.warning(format!(
                "the best fundamental, {:.5} rad/s, lies at the edge of the search range",
                curve.fundamental
            )));
        }
        if curve.condition > MAX_TRUSTED_CONDITION {
            warnings.push(WarningCode::IllConditioned.warning(format!(
                "the Fourier basis is ill-conditioned (condition number {:.1e}, period of the series {:.0} s): its \
                 coefficients cancel each other and its derivatives are poor near the ends",
                curve.condition,
                std::f64::consts::TAU / curve.fundamental
            )));
        }
    }
    warnings
}
