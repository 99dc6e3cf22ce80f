//! Warnings on records, fits and predictions, with code, severity and source.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::names;

/// Severity of a warning, most severe first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// K, T or a prediction may be wrong.
    Doubt,
    /// The program made a choice that a key can change, or only a predicted track is affected.
    Choice,
    /// A fault was repaired without loss.
    Mended,
}

/// Subject of a warning.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WarningCode {
    /// The rudder of a record does not move.
    RudderAtRest,
    /// Angles may be in another unit than their column name.
    AngleUnit,
    /// The time may be in another unit than its column name.
    TimeUnit,
    /// Yaw rate and heading disagree.
    YawRate,
    /// Rudder and turn have opposite signs.
    RudderSign,
    /// The rudder may be in per cent, or its feedback on another scale than its order.
    RudderScale,
    /// The rudder order is used in place of the rudder angle.
    RudderOrder,
    /// Rudders or instruments disagree.
    RuddersApart,
    /// An implausible record is accepted because of its sidecar.
    Implausible,
    /// An instrument or a logger clips, freezes, rounds or holds its readings, or counts in a unit of its own.
    FaultyReadings,
    /// The record has a gap.
    Gap,
    /// The heading jumps faster than a ship can turn.
    HeadingJump,
    /// The heading is the integral of the yaw rate.
    HeadingFromYawRate,
    /// Several rows share a time stamp.
    SharedStamps,
    /// No zig-zag is recognised, so the whole record is used.
    WholeRecord,
    /// A record begins after the start of the trial.
    LateBegin,
    /// A record is given twice, or validates its own fit.
    Repetition,
    /// Length, speed, clock or rudder are unusual for a ship.
    UnusualShip,
    /// The rudder was logged late.
    LateRudder,
    /// The residual of a fit is not white.
    ColouredResidual,
    /// Errors of K and T are assumed independent.
    IndependentErrors,
    /// A parameter or a search ended at its bound.
    AtBound,
    /// Equations or a basis are ill-conditioned.
    IllConditioned,
    /// Noise biases an estimate.
    NoiseBias,
    /// 1/T is negative.
    CourseUnstable,
    /// Part of an estimate is physically impossible.
    NegativeIndex,
    /// Too many headings are outliers to remove them.
    OddHeadings,
    /// Earlier trials contradict the records, or have another speed.
    EarlierTrials,
    /// The records contradict the hull model required for another loading.
    NoLoading,
    /// The records of a model do not identify K and T.
    NotIdentified,
    /// A characteristic or a manoeuvre is missing from a prediction.
    Unpredicted,
    /// A correction to another loading is missing or uncertain.
    Correction,
    /// The models of a correction differ, or extrapolate their records.
    ModelsApart,
    /// One of several instruments is used, or their mean.
    Instrument,
    /// Columns are recognised by nonstandard names, or unused because two are the same quantity.
    Columns,
    /// A unit was inferred from the values.
    AssumedUnit,
    /// The time comes from the clock of one instrument.
    Clock,
    /// The sidecar shifts the rudder in time or angle.
    MovedRudder,
    /// Only part of a record is used.
    Part,
    /// Length, speed or scale come from the record.
    Scale,
    /// A method estimates from the record what a key can set.
    Method,
    /// The estimate of one method among several is used.
    Answer,
    /// Particulars that depend on the loading are kept as at the trials.
    KeptParticulars,
    /// Heading or speed has another reference than required for a track.
    OtherReference,
    /// No track can be predicted.
    NoTrack,
    /// Random moment or correlated noise in addition to the white compass noise.
    Noise,
    /// Rows, sentences or columns are skipped.
    LeftOut,
    /// Single readings are treated as missing.
    RejectedReadings,
    /// Repeated, frozen or absent values are treated as missing.
    MissingValues,
    /// A notation was recognised: decimal commas, lines before the header.
    Notation,
    /// Sentences have no checksum.
    NoChecksum,
    /// A sign was reversed.
    TurnedSign,
}

impl WarningCode {
    /// Severity of warnings of this kind.
    pub fn severity(self) -> Severity {
        match self {
            Self::Instrument
            | Self::Columns
            | Self::AssumedUnit
            | Self::Clock
            | Self::MovedRudder
            | Self::Part
            | Self::Scale
            | Self::Method
            | Self::Answer
            | Self::KeptParticulars
            | Self::OtherReference
            | Self::NoTrack
            | Self::Noise => Severity::Choice,
            Self::LeftOut
            | Self::RejectedReadings
            | Self::MissingValues
            | Self::Notation
            | Self::NoChecksum
            | Self::TurnedSign => Severity::Mended,
            _ => Severity::Doubt,
        }
    }

    /// Warning of this kind, with the source `Study` until a caller sets it.
    pub fn warning(self, text: impl Into<String>) -> Warning {
        Warning::new(self, WarningSource::Study, text)
    }
}

/// Source of a warning.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum WarningSource {
    /// Record, by its file.
    Record(String),
    /// Model or loading description, by its file.
    File(String),
    /// Method, by its identifier or label.
    Method(String),
    /// All records together, or the study.
    Study,
}

impl WarningSource {
    /// The same warnings with this source in place of theirs.
    pub fn attach_to(&self, warnings: impl IntoIterator<Item = Warning>) -> impl Iterator<Item = Warning> {
        warnings.into_iter().map(|warning| Warning { source: self.clone(), ..warning })
    }
}

/// Warning on a record, a fit or a prediction.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Warning {
    /// Subject.
    pub code: WarningCode,
    /// Severity.
    pub severity: Severity,
    /// Source.
    pub source: WarningSource,
    /// Text: one sentence, without the source.
    pub text: String,
}

impl Warning {
    /// Warning with the severity of the code.
    pub fn new(code: WarningCode, source: WarningSource, text: impl Into<String>) -> Self {
        Self { code, severity: code.severity(), source, text: text.into() }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match &self.source {
            WarningSource::Record(name) => write!(f, "{}: {}", names::record_name(name), self.text),
            WarningSource::File(name) | WarningSource::Method(name) => write!(f, "{name}: {}", self.text),
            WarningSource::Study => f.write_str(&self.text),
        }
    }
}

/// Warnings in the order in which they arise.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Warnings(Vec<Warning>);

impl Warnings {
    /// Adds a warning.
    pub fn push(&mut self, code: WarningCode, source: WarningSource, text: impl Into<String>) {
        self.0.push(Warning::new(code, source, text));
    }

    /// Warnings by severity, the most severe first; equally severe ones keep their order.
    pub fn ranked(&self) -> Vec<Warning> {
        let mut ranked = self.0.clone();
        ranked.sort_by_key(|warning| warning.severity);
        ranked
    }
}

impl Extend<Warning> for Warnings {
    fn extend<I: IntoIterator<Item = Warning>>(&mut self, warnings: I) {
        self.0.extend(warnings);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_comes_first_and_equals_keep_their_order() {
        let mut warnings = Warnings::default();
        for (code, text) in [
            (WarningCode::LeftOut, "mended"),
            (WarningCode::Part, "choice"),
            (WarningCode::Gap, "doubt"),
            (WarningCode::Clock, "another choice"),
            (WarningCode::YawRate, "another doubt"),
        ] {
            warnings.push(code, WarningSource::Study, text);
        }
        let order: Vec<String> = warnings.ranked().iter().map(Warning::to_string).collect();
        assert_eq!(order, ["doubt", "another doubt", "choice", "another choice", "mended"]);
    }

    #[test]
    fn json_has_code_severity_source_and_text() {
        let text =
            |source| serde_json::to_string(&Warning::new(WarningCode::HeadingJump, source, "it jumps")).expect("plain");
        let of_record = text(WarningSource::Record("run.csv".into()));
        let fields = r#""code":"heading-jump","severity":"doubt","source":"#;
        assert_eq!(of_record, format!(r#"{{{fields}{{"record":"run.csv"}},"text":"it jumps"}}"#));
        assert_eq!(text(WarningSource::Study), format!(r#"{{{fields}"study","text":"it jumps"}}"#));
        let again: Warning = serde_json::from_str(&of_record).expect("the same");
        assert_eq!(again.to_string(), "run.csv: it jumps");
    }
}
