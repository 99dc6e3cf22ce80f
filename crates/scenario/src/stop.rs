//! The stopping rule of a scenario: `[stop]`. What it sees, and when it is met, is for those who run the study.

use serde::{Deserialize, Serialize};
use ship::ShortNumber;

use crate::method::Method;
use crate::problem::{KeyFault, KeyPath, suggestion};

/// When a cell has had enough trials; `replicates` is then the most.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct StopWire {
    /// What has to be known well enough.
    pub figure: StopFigure,
    /// Label of a method; all of them when left out.
    pub method: Option<String>,
    /// Per cent of K or T; points of per cent for a coverage.
    pub standard_error: f64,
    /// Trials of a cell between two looks.
    #[serde(default = "hundred")]
    pub every: u64,
}

fn hundred() -> u64 {
    100
}

/// An index of the response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Index {
    /// Gain K.
    K,
    /// Time constant T.
    T,
}

/// The figure a rule looks at: of the relative errors, per cent, or the coverage of the quoted intervals, per cent.
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

/// A rule that has been checked.
#[derive(Debug, Clone, PartialEq)]
pub struct StopRule {
    /// The figure.
    pub figure: StopFigure,
    /// Index of the method it is about; all have to meet it when there is none.
    pub method: Option<usize>,
    /// The standard error at which a cell has enough trials, per cent.
    pub standard_error_percent: f64,
    /// Trials between two looks.
    pub every: u64,
}

/// Fewest trials between two looks: a standard error of fewer is chance itself.
const FEWEST: u64 = 20;

impl StopFigure {
    /// The index it is about.
    pub fn index(self) -> Index {
        match self {
            Self::MeanK | Self::SdK | Self::RmsK | Self::CoverageK => Index::K,
            Self::MeanT | Self::SdT | Self::RmsT | Self::CoverageT => Index::T,
        }
    }
}

impl StopWire {
    /// Checks the rule against the methods there are.
    pub(crate) fn resolve(&self, methods: &[Method]) -> Result<StopRule, KeyFault> {
        let key = KeyPath::dotted("stop");
        if !(self.standard_error > 0.0 && self.standard_error.is_finite()) {
            let found = format!("`stop.standard-error` is {}", ShortNumber(self.standard_error));
            let advice = "give the standard error, in per cent, at which a cell has enough trials";
            return Err(KeyFault::value(
                key.child("standard-error"),
                found,
                "expected a finite number above 0",
                advice,
            ));
        }
        if self.every < FEWEST {
            return Err(KeyFault::value(
                key.child("every"),
                format!("`stop.every` is {}", self.every),
                format!("expected at least {FEWEST}"),
                "look less often, or leave the key out for 100",
            ));
        }
        let labels: Vec<&str> = methods.iter().map(|method| method.label.as_str()).collect();
        let method = self.method.as_ref().map(|label| {
            labels.iter().position(|known| known == label).ok_or_else(|| {
                let found = format!("`stop.method` is {label:?}");
                KeyFault::value(
                    key.child("method"),
                    found,
                    "no such method in this scenario",
                    suggestion(label, &labels),
                )
            })
        });
        Ok(StopRule {
            figure: self.figure,
            method: method.transpose()?,
            standard_error_percent: self.standard_error,
            every: self.every,
        })
    }
}
