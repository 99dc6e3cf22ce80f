//! Document of a fit (`fit.json`): records, results of the methods, verdict.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use ship::Particulars;

use crate::earlier_trials::EarlierTrials;
use crate::identified_ship::IdentifiedShip;
use crate::imo_form::ImoFormEntry;
use crate::method::MethodEntry;
use crate::quantity::Quantity;
use crate::scales::ScalesEntry;
use crate::single_records::{SingleRecords, ZigZagAmplitude};
use crate::trial_particulars::TrialParticularsEntry;
use crate::warning::{Warning, WarningCode, WarningSource};

/// Name and version of the schema of `fit.json`.
pub const SCHEMA: &str = "fit/2";

/// Method shown in the plots, if it gives an estimate.
const PLOTTED_METHOD: &str = "output-error";

/// Record of `fit.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct TrialEntry {
    /// File as given by the user.
    pub file: String,
    /// SHA-256 of the file.
    pub sha256: String,
    /// Number of rows with a rudder angle.
    pub samples: usize,
    /// Duration, s.
    pub duration_s: f64,
    /// Ship, date and draughts, if declared.
    #[serde(default, skip_serializing_if = "TrialParticularsEntry::is_empty")]
    pub trial_particulars: TrialParticularsEntry,
    /// Zig-zag characteristics; `null` if it is no zig-zag.
    pub zigzag: Option<ZigZagEntry>,
    /// Reason why it is no zig-zag.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_zigzag: Option<String>,
    /// Turning-circle characteristics, if it is a turning circle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub circle: Option<CircleEntry>,
}

/// Characteristics of a recorded turning circle, corrected for the current determined from its positions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct CircleEntry {
    /// `port` or `starboard`.
    pub side: String,
    /// Rudder angle of the turn, deg.
    pub rudder_deg: f64,
    /// Advance at 90° change of heading, ship lengths; `null` without positions or length.
    pub advance_lengths: Option<f64>,
    /// Transfer at 90° change of heading, ship lengths.
    pub transfer_lengths: Option<f64>,
    /// Tactical diameter at 180° change of heading, ship lengths.
    pub tactical_diameter_lengths: Option<f64>,
}

/// Turning circle predicted from the recommended estimate, if the records have speed and drift.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PredictedCircleEntry {
    /// Method of the estimate.
    pub method: String,
    /// `port` or `starboard`.
    pub side: String,
    /// Held rudder angle, deg.
    pub rudder_deg: f64,
    /// `true` if rudder or yaw rate are beyond those of the records.
    pub extrapolated: bool,
    /// Number of drawn ships.
    pub draws: usize,
    /// Advance at 90° change of heading, ship lengths.
    pub advance_lengths: MedianEntry,
    /// Transfer at 90° change of heading, ship lengths.
    pub transfer_lengths: MedianEntry,
    /// Tactical diameter at 180° change of heading, ship lengths.
    pub tactical_diameter_lengths: MedianEntry,
}

/// Median and 90 % interval of a characteristic over ships drawn from the estimate and its covariance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct MedianEntry {
    /// Median.
    pub median: f64,
    /// Quantiles of 5 and 95 %.
    pub ci90: [f64; 2],
}

/// IMO criterion with its measured value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct CriterionEntry {
    /// Name of the criterion.
    pub criterion: String,
    /// Measured value.
    pub measured: Option<f64>,
    /// Maximum allowed value.
    pub limit: f64,
    /// Unit of value and limit.
    pub unit: String,
    /// `pass`, `fail` or `not measured`.
    pub verdict: CriterionVerdict,
}

/// Outcome of a criterion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum CriterionVerdict {
    /// Met.
    Pass,
    /// Not met.
    Fail,
    /// Not measured by the record.
    #[serde(rename = "not measured")]
    NotMeasured,
}

/// Zig-zag characteristics of a record (IMO MSC.137(76)).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ZigZagEntry {
    /// Initial turning time, s.
    pub initial_turning_time_s: Option<f64>,
    /// Overshoot angles in order, deg; `null` for a peak that was not recorded.
    pub overshoots_deg: Vec<Option<f64>>,
    /// Standard deviations of the overshoot angles, deg.
    pub overshoots_sd_deg: Vec<Option<f64>>,
    /// Period, s.
    pub period_s: Option<f64>,
    /// Criteria of IMO MSC.137(76), if length and speed are declared.
    pub imo: Vec<CriterionEntry>,
    /// Caution for a ship of less than 100 m, such as a model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub imo_caution: Option<String>,
}

/// `fit.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct FitDocument {
    /// Version of the schema: `fit/2`.
    #[schemars(extend("const" = "fit/2"))]
    pub schema: String,
    /// Records.
    pub trials: Vec<TrialEntry>,
    /// Recommended estimate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub verdict: Option<VerdictEntry>,
    /// Results of the methods.
    pub methods: Vec<MethodEntry>,
    /// Zig-zag characteristics of the first record, repeated from its entry.
    pub zigzag: Option<ZigZagEntry>,
    /// Identified ship of every method with a covariance, for `study predict`; SI units and radians.
    #[serde(default)]
    pub ships: BTreeMap<String, IdentifiedShip>,
    /// Earlier trials given by `--prior`, and whether the records contradict them; absent without `--prior`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub earlier_trials: Option<EarlierTrials>,
    /// Comparison of terms between scales, if the records have several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scales: Option<ScalesEntry>,
    /// Description of the scaling of records of several scales to one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scaling: Option<String>,
    /// Length to which dimensional numbers refer, if known, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length_m: Option<f64>,
    /// Approach speed, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// Amplitude of the zig-zags, to which K and T belong.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<ZigZagAmplitude>,
    /// Form of MSC/Circ.1053 with the measured entries, if there are any.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub form: Vec<ImoFormEntry>,
    /// Remarks of the form.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub form_remarks: Vec<String>,
    /// Turning circle predicted from the recommended estimate, with the rudder of a recorded circle, else with 35°.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub predicted_circle: Option<PredictedCircleEntry>,
    /// Every zig-zag identified alone, if there are several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub single_records: Option<SingleRecords>,
    /// Warnings on records and estimates, the most severe first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
}

impl FitDocument {
    /// Length and approach speed to which dimensional numbers refer; `None` if one of them is unknown.
    pub fn particulars(&self) -> Option<Particulars> {
        Some(Particulars { length: self.length_m?, speed: self.speed_m_s? })
    }

    /// Method shown in the plots: output error, or the first method with an estimate if output error has none; `None`
    /// if no method has an estimate.
    pub fn plotted_method(&self) -> Option<&str> {
        let answered = || self.methods.iter().filter(|entry| entry.parameters.is_some()).map(|entry| &entry.method);
        answered().find(|method| *method == PLOTTED_METHOD).or_else(|| answered().next()).map(String::as_str)
    }

    /// `true` if a channel has faulty readings, or contains orders in place of angles.
    pub fn has_faulty_readings(&self) -> bool {
        self.warnings
            .iter()
            .any(|warning| matches!(warning.code, WarningCode::FaultyReadings | WarningCode::RudderOrder))
    }

    /// Warnings on the records, the fit and the recommended estimate, the most severe first.
    pub fn verdict_warnings(&self) -> impl Iterator<Item = &Warning> {
        self.warnings.iter().filter(|warning| !self.is_note(warning))
    }

    /// Warnings on the estimates of the other methods, which are frequent and less relevant.
    pub fn other_warnings(&self) -> impl Iterator<Item = &Warning> {
        self.warnings.iter().filter(|warning| self.is_note(warning))
    }

    fn is_note(&self, warning: &Warning) -> bool {
        let taken = self.verdict.as_ref().map(|verdict| &verdict.method);
        matches!(&warning.source, WarningSource::Method(method) if Some(method) != taken)
    }
}

impl VerdictEntry {
    /// `true` if additional terms of a hull reduce the residual of output error to less than two thirds, or if one of
    /// the residuals is unknown.
    pub fn improves_with_ship_terms(&self) -> bool {
        self.residual_deg.zip(self.with_ship_terms_deg).is_none_or(|(before, after)| after < before * 2.0 / 3.0)
    }
}

/// Reason for the recommended estimate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum VerdictReason {
    /// Minimum heading error of all first-order responses.
    NearestReplay,
    /// A random yaw moment acts, which maximum likelihood models.
    RandomMoment,
    /// The recorded rudder is noisy, which maximum likelihood models.
    RudderNoise,
    /// The heading has lasting jumps, which maximum likelihood estimates.
    HeadingJumps,
}

/// Kind of the residual of output error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ResidualKind {
    /// White: heading noise.
    Noise,
    /// Mostly explained by additional terms of a hull: the model lacks an effect.
    LacksEffect,
    /// Not explained by such terms: random moments, waves or compass errors.
    Random,
}

/// Usability of K and T of the records.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum KtUsability {
    /// Usable.
    #[default]
    Yes,
    /// Not usable; `because` is the reason.
    No,
}

/// Recommended estimate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct VerdictEntry {
    /// `yes` if K and T can be used.
    #[serde(default)]
    pub believe: KtUsability,
    /// Reason if they cannot be used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub because: Option<String>,
    /// Recommended method; if it gives no estimate or no replay is better than straight lines, the method with the
    /// minimum heading error.
    pub method: String,
    /// K of that method, 1/s; absent if `believe` is `no`.
    #[serde(rename = "K_per_s", default, skip_serializing_if = "Option::is_none")]
    pub k_per_s: Option<Quantity>,
    /// T of that method, s; absent if `believe` is `no`.
    #[serde(rename = "T_s", default, skip_serializing_if = "Option::is_none")]
    pub t_s: Option<Quantity>,
    /// Reason for the recommendation.
    pub reason: VerdictReason,
    /// Kind of the residual of output error, if it gives an estimate.
    pub residual: Option<ResidualKind>,
    /// Root mean square of that residual, deg.
    pub residual_deg: Option<f64>,
    /// Root mean square after a fit of nine additional terms of a hull, deg.
    pub with_ship_terms_deg: Option<f64>,
    /// Standard deviation of the heading noise, deg.
    pub noise_deg: Option<f64>,
    /// Delay of the acting rudder behind the recorded one, s, if it alone explains most of the residual; negative
    /// for a rudder that was recorded late.
    pub rudder_delay_s: Option<f64>,
    /// Methods whose heading error is more than ten times the minimum.
    #[serde(rename = "set_apart")]
    pub far_off_methods: Vec<String>,
    /// Root mean square of the headings about straight lines, deg, if no replay is better than these; then K and T
    /// cannot be used.
    #[serde(rename = "straight_lines_deg", default, skip_serializing_if = "Option::is_none")]
    pub straight_lines_rms_deg: Option<f64>,
    /// Output error or maximum likelihood, if its 95 % interval of K or T does not overlap that of the recommended
    /// method, or its replay is in `set_apart`.
    pub contradicted_by: Option<String>,
}
