//! `fit.json`: records and answers for other programs.

use std::collections::BTreeMap;

use campaign::answer::MethodEntry;
use predict::IdentifiedShip;
use serde::{Deserialize, Serialize};
use ship::angle::to_deg;
use trial::{Trial, ZigZag, imo};

use super::scales::ScalesEntry;
use crate::records::file_of;

/// One record of `fit.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct TrialEntry {
    /// The file as it was named.
    pub file: String,
    /// SHA-256 of its bytes.
    pub sha256: String,
    /// Rows with a rudder.
    pub samples: usize,
    /// Length, s.
    pub duration_s: f64,
    /// Characteristics of this record; `null` when it is not a zig-zag.
    pub zigzag: Option<ZigZagEntry>,
}

/// One IMO criterion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct CriterionEntry {
    /// What is limited.
    pub criterion: String,
    /// Measured value.
    pub measured: Option<f64>,
    /// Largest value allowed.
    pub limit: f64,
    /// Unit of both.
    pub unit: String,
    /// `pass`, `fail` or `not measured`.
    pub verdict: String,
}

/// Zig-zag characteristics of a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ZigZagEntry {
    /// Initial turning time, s.
    pub initial_turning_time_s: Option<f64>,
    /// Overshoot angles in order, deg; of a peak that was not seen there is none.
    pub overshoots_deg: Vec<Option<f64>>,
    /// Standard deviations of the overshoot angles, deg.
    pub overshoots_sd_deg: Vec<Option<f64>>,
    /// Period, s.
    pub period_s: Option<f64>,
    /// IMO MSC.137(76), where length and speed are declared.
    pub imo: Vec<CriterionEntry>,
}

/// `fit.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct FitDocument {
    /// `fit/1`.
    #[schemars(extend("const" = "fit/1"))]
    pub schema: String,
    /// The records.
    pub trials: Vec<TrialEntry>,
    /// The answers.
    pub methods: Vec<MethodEntry>,
    /// Those of the first record, which stand in its entry too.
    pub zigzag: Option<ZigZagEntry>,
    /// What every method with a covariance knows of the ship, for `study predict`; SI units and radians.
    #[serde(default)]
    pub ships: BTreeMap<String, IdentifiedShip>,
    /// Where the records are of several scales: which terms scale.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scales: Option<ScalesEntry>,
}

/// The entry of a record.
pub fn trial_entry(trial: &Trial, zigzag: Option<&ZigZag>) -> TrialEntry {
    let (file, sha256) = file_of(trial);
    TrialEntry {
        file: file.into(),
        sha256: sha256.into(),
        samples: trial.len(),
        duration_s: trial.duration(),
        zigzag: zigzag.map(|zigzag| zigzag_entry(zigzag, trial)),
    }
}

/// The entry of a zig-zag; criteria where length and speed are declared.
fn zigzag_entry(zigzag: &ZigZag, trial: &Trial) -> ZigZagEntry {
    let criteria = trial.particulars().map(|particulars| imo::criteria(zigzag, particulars)).unwrap_or_default();
    ZigZagEntry {
        initial_turning_time_s: zigzag.initial_turning_time.map(|time| time.value),
        overshoots_deg: zigzag.swings().map(|swing| Some(to_deg(swing?.angle.value))).collect(),
        overshoots_sd_deg: zigzag.swings().map(|swing| swing?.angle.sd.map(to_deg)).collect(),
        period_s: zigzag.period.map(|period| period.value),
        imo: criteria
            .iter()
            .map(|criterion| CriterionEntry {
                criterion: criterion.name.into(),
                measured: criterion.measured.map(|measured| measured.value),
                limit: criterion.limit,
                unit: criterion.unit.symbol().into(),
                verdict: match criterion.verdict {
                    imo::Verdict::Pass => "pass",
                    imo::Verdict::Fail => "fail",
                    imo::Verdict::NotMeasured => "not measured",
                }
                .into(),
            })
            .collect(),
    }
}
