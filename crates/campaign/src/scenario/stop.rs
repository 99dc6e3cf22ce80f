//! Stopping rule of a scenario: `[stop]`, a standard error that ends a cell. [`crate::stopping`] evaluates it.

use serde::{Deserialize, Serialize};
use ship::ShortNumber;

use crate::scenario::method::Method;
use crate::scenario::problem::{KeyFault, KeyPath, choice_index};

/// Condition that ends a cell; `replicates` is then the maximum.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct StopRule {
    /// Statistic whose standard error is limited.
    pub figure: StopFigure,
    /// Label of a method; all of them if omitted.
    pub method: Option<String>,
    /// Standard error in per cent of K or T; in percentage points for a coverage.
    pub standard_error: f64,
}

/// Index of the first-order response (Nomoto): its gain or its time constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NomotoIndex {
    /// Gain K, 1/s.
    K,
    /// Time constant T, s.
    T,
}

/// Statistic of a rule: of the relative errors, per cent, or the coverage of the quoted intervals, per cent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, schemars::JsonSchema)]
pub enum StopFigure {
    /// Mean error of K.
    #[serde(rename = "mean-K")]
    MeanK,
    /// Mean error of T.
    #[serde(rename = "mean-T")]
    MeanT,
    /// Standard deviation of the errors of K.
    #[serde(rename = "sd-K")]
    SdK,
    /// Standard deviation of the errors of T.
    #[serde(rename = "sd-T")]
    SdT,
    /// Root mean square error of K.
    #[serde(rename = "rms-K")]
    RmsK,
    /// Root mean square error of T.
    #[serde(rename = "rms-T")]
    RmsT,
    /// Coverage of the intervals of K.
    #[serde(rename = "coverage-K")]
    CoverageK,
    /// Coverage of the intervals of T.
    #[serde(rename = "coverage-T")]
    CoverageT,
}

impl StopFigure {
    /// Nomoto index whose errors the statistic describes.
    pub fn index(self) -> NomotoIndex {
        match self {
            Self::MeanK | Self::SdK | Self::RmsK | Self::CoverageK => NomotoIndex::K,
            Self::MeanT | Self::SdT | Self::RmsT | Self::CoverageT => NomotoIndex::T,
        }
    }
}

impl StopRule {
    /// Checks that the standard error is finite and above 0, and that the method exists.
    pub(crate) fn check(&self, methods: &[Method]) -> Result<(), KeyFault> {
        let key = KeyPath::from_dotted("stop");
        if !(self.standard_error > 0.0 && self.standard_error.is_finite()) {
            let advice = "give the standard error, in per cent, at which a cell has enough trials";
            let expected = "expected a finite number above 0";
            return Err(KeyFault::new(key.child("standard-error"), ShortNumber(self.standard_error), expected, advice));
        }
        let labels: Vec<&str> = methods.iter().map(|method| method.label.as_str()).collect();
        let messages = ["`stop.method` is", "no such method in this scenario"];
        let place = self.method.as_ref().map(|label| choice_index(label, &labels, key.child("method"), messages));
        place.transpose().map(|_| ())
    }
}
