//! `trace.json`: what the analysis says, and beside it the files of curves and what is known of the ship.

use document::IdentifiedShip;
use document::earlier_trials::EarlierTrials;
use document::trace::BeforeAfter;
use document::trace::Document;
use scenario::name::slug;
use serde::{Deserialize, Serialize};
use ship::Particulars;

use super::missing_moment::MissingMomentEntry;
use crate::records::names;

/// Name of the file.
pub const TRACE: &str = "trace.json";

/// Records whose names are a title; one more stands there, too.
const TITLED: usize = 2;

/// `trace.json`: words, tables and figures are made from it and from the curves that it names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct TraceDocument {
    /// What the analysis says.
    #[serde(flatten)]
    pub trace: Document,
    /// The trial that would tell most.
    pub next_trial: String,
    /// The records, first the fitted ones, and the files of their curves.
    pub records: Vec<RecordEntry>,
    /// The yaw moment that the base lacks on every fitted record.
    pub missing_moment: Vec<MissingMomentEntry>,
    /// What is known of the ship, for `study predict`; SI units and radians.
    pub ship: IdentifiedShip,
    /// What earlier trials of `--prior` say of the hull, and whether the records contradict them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub earlier_trials: Option<EarlierTrials>,
    /// How records of several scales were brought to one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scales: Option<String>,
}

/// A record of a trace.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct RecordEntry {
    /// A name that no other record has.
    pub name: String,
    /// Its file.
    pub file: String,
    /// SHA-256 of its bytes.
    #[serde(default)]
    pub sha256: String,
    /// Whether it was held out.
    pub held_out: bool,
    /// The table of the record and its replays.
    pub curves: String,
    /// The table of its innovations, where it was fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub innovations: Option<String>,
    /// Length of its ship, where it is known, m.
    pub length_m: Option<f64>,
    /// Approach speed of its ship, where it is known, m/s.
    pub speed_m_s: Option<f64>,
}

impl RecordEntry {
    /// Length and speed of its ship.
    pub fn particulars(&self) -> Option<Particulars> {
        Some(Particulars { length: self.length_m?, speed: self.speed_m_s? })
    }
}

/// Names as parts of names of files: two names may make one slug.
pub fn slugs(own: &[String]) -> Vec<String> {
    names(own.iter().map(|name| slug(name)))
}

/// What the files of a record end with: nothing for the first.
pub fn suffix(names: &[String], number: usize) -> String {
    if number == 0 { String::new() } else { format!("-{}", slugs(names)[number]) }
}

/// Errors on one record, and how it was used.
#[derive(Clone, Copy)]
pub struct RecordErrors<'a> {
    /// Name of the record.
    pub name: &'a str,
    /// `fitted`, `held out` or `left out`.
    pub used: &'static str,
    /// The errors.
    pub errors: &'a BeforeAfter,
}

impl TraceDocument {
    /// Length and speed at which numbers with a dimension are told, where they are known.
    pub fn particulars(&self) -> Option<Particulars> {
        self.records.iter().find_map(RecordEntry::particulars)
    }

    /// Names of all records.
    pub fn names(&self) -> Vec<String> {
        self.records.iter().map(|record| record.name.clone()).collect()
    }

    /// Names of the fitted records, of many the first.
    pub fn title(&self) -> String {
        let fitted = self.records.iter().filter(|record| !record.held_out);
        let names: Vec<&str> = fitted.map(|record| record.name.as_str()).collect();
        match names.len().saturating_sub(TITLED) {
            0 | 1 => names.join(", "),
            more => format!("{} and {more} more", names[..TITLED].join(", ")),
        }
    }

    /// Errors on all records, `(fitted, judged)`: a judged record was held out, or left out in turn.
    pub fn errors(&self) -> (Vec<RecordErrors<'_>>, Vec<RecordErrors<'_>>) {
        let error = &self.trace.error;
        let (mut fitted, mut judged) = (Vec::new(), Vec::new());
        let names = |held_out: bool| self.records.iter().filter(move |one| one.held_out == held_out);
        for (record, errors) in names(false).zip(&error.identification) {
            fitted.push(RecordErrors { name: &record.name, used: "fitted", errors });
        }
        for (record, errors) in names(true).zip(&error.validation) {
            judged.push(RecordErrors { name: &record.name, used: "held out", errors });
        }
        for errors in &error.leave_one_out {
            let record = names(false).find(|record| record.file == errors.file);
            judged.push(RecordErrors { name: record.map_or(&errors.file, |own| &own.name), used: "left out", errors });
        }
        (fitted, judged)
    }
}
