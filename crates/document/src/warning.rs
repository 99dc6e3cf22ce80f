//! Warnings: what a reader should know beside the numbers.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::names;

/// How much a warning costs; the worst first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// K, T or a prediction may be wrong.
    Doubt,
    /// A choice was made that a key can change, or only a track suffers.
    Choice,
    /// A fault was mended, and costs nothing.
    Mended,
}

/// What a warning is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Code {
    /// The rudder of a record stays where it is.
    RudderAtRest,
    /// Angles may be in another unit than their name says.
    AngleUnit,
    /// The time may be in another unit than its name says.
    TimeUnit,
    /// Yaw rate and heading disagree.
    YawRate,
    /// Ship and rudder turn to opposite sides.
    RudderSign,
    /// The rudder may be in per cent, or its feedback on another scale than its order.
    RudderScale,
    /// The order stands for the angle of the rudder.
    RudderOrder,
    /// Rudders or instruments that should agree do not.
    RuddersApart,
    /// A record that contradicts itself is believed because its sidecar says so.
    Implausible,
    /// An instrument or a logger clips, freezes, rounds or holds what it reads, or counts in a unit of its own.
    FaultyReadings,
    /// Nothing was recorded for a while.
    Gap,
    /// The heading jumps as no ship turns.
    HeadingJump,
    /// The heading is the integral of the yaw rate.
    HeadingFromYawRate,
    /// Several rows have one stamp.
    SharedStamps,
    /// No zig-zag is recognised, and all of a record is used.
    WholeRecord,
    /// A record begins within the trial.
    LateBegin,
    /// A record is given twice, or is held against what was fitted to it.
    Repetition,
    /// Length, speed, clock or rudder make a ship that hardly exists.
    UnusualShip,
    /// The rudder was logged late.
    LateRudder,
    /// The residual of a fit is no white noise.
    ColouredResidual,
    /// Errors of K and T are taken as independent.
    IndependentErrors,
    /// A parameter or a search ended at its bound.
    AtBound,
    /// Equations or a basis hardly determine what is asked of them.
    IllConditioned,
    /// Noise biases an estimate.
    NoiseBias,
    /// 1/T is negative.
    CourseUnstable,
    /// Part of an answer is that of no ship.
    NegativeIndex,
    /// More of the headings are odd than can be left out.
    OddHeadings,
    /// Earlier trials contradict the records, or are of another speed.
    EarlierTrials,
    /// The records speak against the hull that another loading needs.
    NoLoading,
    /// No K and T can be taken from the records of a model.
    NotIdentified,
    /// A figure or a manoeuvre is missing from a prediction.
    Unpredicted,
    /// A correction to another loading is missing, or says little.
    Correction,
    /// The models of a correction differ, or go beyond their records.
    ModelsApart,
    /// One of several instruments is used, or their mean.
    Instrument,
    /// Columns are understood by names that are no contract, or not used because two claim the same.
    Columns,
    /// A unit that no name says was read off the values.
    AssumedUnit,
    /// The time comes from the clock of one instrument.
    Clock,
    /// The sidecar moves the rudder.
    MovedRudder,
    /// Part of a record is used.
    Part,
    /// Length, speed or scale come from the record.
    Scale,
    /// A method takes something from the record that a key can give.
    Method,
    /// The answer of one method among several is used.
    Answer,
    /// What depends on the loading is taken as at the trials.
    KeptParticulars,
    /// A heading or a speed is of another kind than a track needs.
    OtherReference,
    /// No track can be predicted.
    NoTrack,
    /// What is random beside the white noise of the compass.
    Noise,
    /// Rows, sentences or columns are left out.
    LeftOut,
    /// Single readings are taken as missing.
    RejectedReadings,
    /// Values that are repeated, frozen or absent are taken as missing.
    MissingValues,
    /// A way of writing was understood: decimal commas, lines before the header.
    Notation,
    /// Sentences have no checksum.
    NoChecksum,
    /// A sign was turned.
    TurnedSign,
}

impl Code {
    /// How much a warning of this kind costs.
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

    /// A warning of this kind whose source is whoever holds it, until that has a name.
    pub fn warning(self, text: impl Into<String>) -> Warning {
        Warning::new(self, Source::Study, text)
    }
}

/// Where a warning comes from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Source {
    /// A record, by its file.
    Record(String),
    /// A model or the description of a loading, by its file.
    File(String),
    /// A method, by its identifier or label.
    Method(String),
    /// The records together, or the study.
    Study,
}

impl Source {
    /// Warnings with this source.
    pub fn of(&self, warnings: impl IntoIterator<Item = Warning>) -> impl Iterator<Item = Warning> {
        warnings.into_iter().map(|warning| Warning { source: self.clone(), ..warning })
    }
}

/// A warning.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Warning {
    /// What it is about.
    pub code: Code,
    /// How much it costs.
    pub severity: Severity,
    /// Where it comes from.
    pub source: Source,
    /// What it says, in one sentence without its source.
    pub text: String,
}

impl Warning {
    /// A warning, as severe as its kind.
    pub fn new(code: Code, source: Source, text: impl Into<String>) -> Self {
        Self { code, severity: code.severity(), source, text: text.into() }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match &self.source {
            Source::Record(name) => write!(f, "{}: {}", names::record(name), self.text),
            Source::File(name) | Source::Method(name) => write!(f, "{name}: {}", self.text),
            Source::Study => f.write_str(&self.text),
        }
    }
}

/// The warnings of one piece of work, in the order in which they arise.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Warnings(Vec<Warning>);

impl Warnings {
    /// Adds a warning.
    pub fn push(&mut self, code: Code, source: Source, text: impl Into<String>) {
        self.0.push(Warning::new(code, source, text));
    }

    /// The warnings, the worst first; equally severe ones stay in their order.
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
            (Code::LeftOut, "mended"),
            (Code::Part, "choice"),
            (Code::Gap, "doubt"),
            (Code::Clock, "another choice"),
            (Code::YawRate, "another doubt"),
        ] {
            warnings.push(code, Source::Study, text);
        }
        let order: Vec<String> = warnings.ranked().iter().map(Warning::to_string).collect();
        assert_eq!(order, ["doubt", "another doubt", "choice", "another choice", "mended"]);
    }

    #[test]
    fn json_has_code_severity_source_and_text() {
        let text = |source| serde_json::to_string(&Warning::new(Code::HeadingJump, source, "it jumps")).expect("plain");
        let of_record = text(Source::Record("run.csv".into()));
        let rest = r#""code":"heading-jump","severity":"doubt","source":"#;
        assert_eq!(of_record, format!(r#"{{{rest}{{"record":"run.csv"}},"text":"it jumps"}}"#));
        assert_eq!(text(Source::Study), format!(r#"{{{rest}"study","text":"it jumps"}}"#));
        let again: Warning = serde_json::from_str(&of_record).expect("the same");
        assert_eq!(again.to_string(), "run.csv: it jumps");
    }
}
