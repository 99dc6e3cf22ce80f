//! What a fit says, as `fit.json` holds it: records and answers.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use ship::Particulars;

use crate::earlier_trials::EarlierTrials;
use crate::form::ImoFormEntry;
use crate::identified_ship::IdentifiedShip;
use crate::method::MethodEntry;
use crate::quantity::Quantity;
use crate::scales::ScalesEntry;
use crate::single_records::{Amplitude, SingleRecords};
use crate::trial_particulars::TrialParticularsEntry;
use crate::warning::{Code, Source, Warning};

/// Name of the schema.
pub const SCHEMA: &str = "fit/2";

/// The method whose fit is drawn on its own where it has one.
const SHOWN: &str = "output-error";

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
    /// Ship, day and draughts, where something is known of them.
    #[serde(default, skip_serializing_if = "TrialParticularsEntry::is_empty")]
    pub trial_particulars: TrialParticularsEntry,
    /// Characteristics of this record; `null` when it is not a zig-zag.
    pub zigzag: Option<ZigZagEntry>,
    /// Why it has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_zigzag: Option<String>,
    /// The turning circle that it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub circle: Option<CircleEntry>,
}

/// A recorded turning circle; a current that its positions show is taken out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct CircleEntry {
    /// `port` or `starboard`.
    pub side: String,
    /// Rudder angle that was held, deg.
    pub rudder_deg: f64,
    /// Advance at 90° of heading, ship lengths; none without positions or an unknown length.
    pub advance_lengths: Option<f64>,
    /// Transfer at 90° of heading, ship lengths.
    pub transfer_lengths: Option<f64>,
    /// Tactical diameter at 180° of heading, ship lengths.
    pub tactical_diameter_lengths: Option<f64>,
}

/// The turning circle that an answer predicts, where the records tell speed and drift.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PredictedCircleEntry {
    /// The method whose answer it is.
    pub method: String,
    /// `port` or `starboard`.
    pub side: String,
    /// Rudder angle that is held, deg.
    pub rudder_deg: f64,
    /// Whether rudder or yaw rate are beyond those of the records.
    pub extrapolated: bool,
    /// Ships that are drawn.
    pub draws: usize,
    /// Advance at 90° of heading, ship lengths.
    pub advance_lengths: MedianEntry,
    /// Transfer at 90° of heading, ship lengths.
    pub transfer_lengths: MedianEntry,
    /// Tactical diameter at 180° of heading, ship lengths.
    pub tactical_diameter_lengths: MedianEntry,
}

/// Median of drawn ships.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct MedianEntry {
    /// Half of them are below.
    pub median: f64,
    /// Quantiles of 5 and 95 %.
    pub ci90: [f64; 2],
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
    pub verdict: CriterionVerdict,
}

/// Whether a criterion is met.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum CriterionVerdict {
    /// It is.
    Pass,
    /// It is not.
    Fail,
    /// The record does not show it.
    #[serde(rename = "not measured")]
    NotMeasured,
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
    /// What they mean for a ship of less than 100 m, such as a model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub imo_caution: Option<String>,
}

/// `fit.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct FitDocument {
    /// `fit/2`.
    #[schemars(extend("const" = "fit/2"))]
    pub schema: String,
    /// The records.
    pub trials: Vec<TrialEntry>,
    /// Which answer is to be taken.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub verdict: Option<VerdictEntry>,
    /// The answers.
    pub methods: Vec<MethodEntry>,
    /// Those of the first record, which stand in its entry too.
    pub zigzag: Option<ZigZagEntry>,
    /// What every method with a covariance knows of the ship, for `study predict`; SI units and radians.
    #[serde(default)]
    pub ships: BTreeMap<String, IdentifiedShip>,
    /// What earlier trials of `--prior` say of the hull, and whether the records contradict them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub earlier_trials: Option<EarlierTrials>,
    /// Where the records are of several scales: which terms scale.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scales: Option<ScalesEntry>,
    /// How records of several scales were brought to one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scaling: Option<String>,
    /// Length at which numbers with a dimension are given, where it is known, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length_m: Option<f64>,
    /// Approach speed, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// The amplitude of the zig-zags, to which K and T belong.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<Amplitude>,
    /// The form of MSC/Circ.1053 with what the records measure, where they measure something of it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub form: Vec<ImoFormEntry>,
    /// What the form says beside its entries.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub form_remarks: Vec<String>,
    /// The turning circle that the answer to take predicts, with the rudder of a recorded circle, else with 35°.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub predicted_circle: Option<PredictedCircleEntry>,
    /// Every zig-zag identified alone, where there are several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub single_records: Option<SingleRecords>,
    /// What a reader should know of records and answers, the worst first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
}

impl FitDocument {
    /// Length and speed at which numbers with a dimension are given, where they are known.
    pub fn particulars(&self) -> Option<Particulars> {
        Some(Particulars { length: self.length_m?, speed: self.speed_m_s? })
    }

    /// The method whose fit is drawn on its own.
    pub fn shown_method(&self) -> Option<&str> {
        let answered = || self.methods.iter().filter(|entry| entry.parameters.is_some()).map(|entry| &entry.method);
        answered().find(|method| *method == SHOWN).or_else(|| answered().next()).map(String::as_str)
    }

    /// Whether a channel of a record is not what its instrument read, or not what its name says.
    pub fn has_faulty_readings(&self) -> bool {
        self.warnings.iter().any(|warning| matches!(warning.code, Code::FaultyReadings | Code::RudderOrder))
    }

    /// Everything that a reader should know of the answer to take, what costs most first.
    pub fn of_answer(&self) -> impl Iterator<Item = &Warning> {
        self.warnings.iter().filter(|own| !self.is_note(own))
    }

    /// What methods say of answers that are not to be taken: some say it of nearly every record.
    pub fn notes(&self) -> impl Iterator<Item = &Warning> {
        self.warnings.iter().filter(|own| self.is_note(own))
    }

    fn is_note(&self, warning: &Warning) -> bool {
        let taken = self.verdict.as_ref().map(|verdict| &verdict.method);
        matches!(&warning.source, Source::Method(method) if Some(method) != taken)
    }
}

impl VerdictEntry {
    /// Whether more terms of a hull leave less than two thirds of the residual of output error.
    pub fn falls_with_ship_terms(&self) -> bool {
        self.residual_deg.zip(self.with_ship_terms_deg).is_none_or(|(all, left)| left < all * 2.0 / 3.0)
    }
}

/// Why an answer is to be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// No first-order response replays the headings nearer.
    NearestReplay,
    /// A random yaw moment acts, and maximum likelihood counts it.
    RandomMoment,
    /// The recorded rudder is noisy, and maximum likelihood counts it.
    RudderNoise,
    /// The heading jumps and stays off, and maximum likelihood estimates that.
    HeadingJumps,
}

/// What the residual of the answer looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ResidualKind {
    /// White, and so the noise of the heading.
    Noise,
    /// Terms of a ship explain most of it: the model lacks an effect.
    LacksEffect,
    /// Terms of a ship do not explain it: random moments, waves or an error of the compass.
    Random,
}

/// Whether K and T can be taken from the records.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Belief {
    /// They can.
    #[default]
    Yes,
    /// They cannot: `because` says why.
    No,
}

/// The answer to take.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct VerdictEntry {
    /// Whether K and T can be taken at all.
    #[serde(default)]
    pub believe: Belief,
    /// Why they cannot.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub because: Option<String>,
    /// The method whose answer is to be taken; where none is, the nearest one.
    pub method: String,
    /// K of that answer, 1/s; absent where `believe` is `no`.
    #[serde(rename = "K_per_s", default, skip_serializing_if = "Option::is_none")]
    pub k_per_s: Option<Quantity>,
    /// T of that answer, s; absent where `believe` is `no`.
    #[serde(rename = "T_s", default, skip_serializing_if = "Option::is_none")]
    pub t_s: Option<Quantity>,
    /// Why.
    pub reason: Reason,
    /// What the residual of output error looks like, where that has an answer.
    pub residual: Option<ResidualKind>,
    /// Root mean square of that residual, deg.
    pub residual_deg: Option<f64>,
    /// The same with nine more terms of a hull fitted to it, deg.
    pub with_ship_terms_deg: Option<f64>,
    /// Standard deviation of the noise of the heading, deg.
    pub noise_deg: Option<f64>,
    /// Time by which the rudder acts later than it was recorded, s, where that alone explains most of the residual;
    /// negative for a rudder that was recorded late.
    pub rudder_delay_s: Option<f64>,
    /// Methods whose replays are more than ten times worse than the best.
    pub set_apart: Vec<String>,
    /// Where no replay is nearer to the headings than straight lines are: the root mean square about these, deg. No
    /// method has an answer then, and `method` is the nearest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub straight_lines_deg: Option<f64>,
    /// Output error or maximum likelihood, where its 95 % interval of K or T lies wholly outside that of the answer to
    /// take, or its replay is set apart.
    pub contradicted_by: Option<String>,
}
