//! Document of a trace (`trace.json`).
//!
//! Angles are in degrees if a name states so; parameters of effects are in SI units and radians.

use std::collections::BTreeMap;

use estimation::residuals::WhitenessTest;
use serde::{Deserialize, Serialize};
use ship::Particulars;

use crate::earlier_trials::EarlierTrials;
use crate::identified_ship::IdentifiedShip;
use crate::names;
use crate::noise::MomentKind;
use crate::single_records::{SingleRecords, ZigZagAmplitude};
use crate::warning::Warning;

mod entries;
mod errors;

pub use entries::{
    ChannelCurveEntry, Dependence, DisturbanceEntry, InclusionStepEntry, Indices, LocatedMomentEntry,
    MissingMomentEntry, NondimensionalValue, ParameterEntry, PrimeIndices, RecordEntry, RecordErrors, UnexplainedEntry,
};
pub use errors::{HorizonEntry, ModelReplayErrors, RecordReplayErrors, ReplayErrorLists};

/// Name and version of the schema of `trace.json`.
pub const SCHEMA: &str = "trace/4";

/// Number of names in the title of more than three records; up to three records are all named.
const MAX_TITLE_NAMES: usize = 2;

/// Verdict of a trace.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "Verdict")]
pub enum TraceVerdict {
    /// Instrument noise alone explains the records.
    #[default]
    Clean,
    /// A random moment acts, and no effect is named: the cause is weather, or an effect with a shape that was not
    /// searched for.
    Disturbed,
    /// Effects are named, and no further shape is found in the residual; a random law describes it, which may be noise,
    /// weather or an error of the model.
    Traced,
    /// The residual has a shape that belongs to no listed effect.
    Located,
    /// The residual is neither random nor of a shape that was searched for.
    Unexplained,
}

impl TraceVerdict {
    /// All verdicts.
    pub const ALL: [Self; 5] = [Self::Clean, Self::Disturbed, Self::Traced, Self::Located, Self::Unexplained];
}

/// Outcome of a candidate, best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Outcome")]
pub enum CandidateOutcome {
    /// Named.
    Added,
    /// Member of a named group, or alternative form of a named effect.
    Alias,
    /// Not supported by the records.
    Rejected,
    /// Not observable in the records.
    NotObservable,
}

impl CandidateOutcome {
    /// Text of the outcome in reports, such as `not named`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Added => "added",
            Self::Alias => "alias",
            Self::Rejected => "not named",
            Self::NotObservable => "not observable",
        }
    }
}

/// Effect in one form, in all records or in one.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct TermEntry {
    /// Identifier.
    pub id: String,
    /// Form.
    pub form: String,
    /// Record in which it acts; `null` for all.
    pub only: Option<String>,
}

/// Named effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct EffectEntry {
    /// Identifier.
    pub id: String,
    /// Most probable form.
    pub form: String,
    /// Equation.
    pub equation: String,
    /// Record in which it acts; `null` for all.
    pub only: Option<String>,
    /// `true` if the effect is included on request; otherwise omitted.
    #[serde(rename = "asked", default, skip_serializing_if = "std::ops::Not::not")]
    pub required: bool,
    /// Other effects of the group, of which one is present.
    pub aliases: Vec<String>,
    /// Alternative forms of the effect and its group.
    pub alias_forms: Vec<TermEntry>,
    /// Parameters by their symbols.
    pub parameters: BTreeMap<String, ParameterEntry>,
    /// Probability that the effect, or one of its group, is present.
    pub probability: f64,
    /// Probability with the prior odds of all effects multiplied by each of `prior.odds_factors`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub probability_by_prior_odds: Vec<f64>,
    /// −2 log of the evidence ratio with and without it; negative if it improves the model.
    pub delta_bic: f64,
    /// p value (χ²) of the coefficients in a fit with all other candidates.
    pub p_value: f64,
    /// Evidence in a sentence.
    pub evidence: String,
}

/// Candidate effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct CandidateEntry {
    /// Identifier.
    pub id: String,
    /// Outcome of the best form.
    pub outcome: CandidateOutcome,
    /// Probability that the effect is present in any form and record.
    pub probability: f64,
    /// Probability with the prior odds of all effects multiplied by each of `prior.odds_factors`; empty if no
    /// structure has it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub probability_by_prior_odds: Vec<f64>,
    /// −2 log evidence ratio of the best form.
    pub delta_bic: Option<f64>,
    /// p value (χ²) of the best form.
    pub p_value: Option<f64>,
    /// Reason if the effect was not tried.
    pub reason: Option<String>,
    /// Symmetry of the moment of a formula under exchange of port and starboard.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sides: Option<String>,
    /// Forms.
    pub forms: Vec<FormEntry>,
}

/// Candidate effect in one form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct FormEntry {
    /// Form.
    pub form: String,
    /// Record in which it would act; `null` for all.
    pub only: Option<String>,
    /// Outcome.
    pub outcome: CandidateOutcome,
    /// Probability that it is present.
    pub probability: f64,
    /// −2 log evidence ratio.
    pub delta_bic: Option<f64>,
    /// p value (χ²).
    pub p_value: Option<f64>,
    /// Expected squared coefficient over its variance in a fit with all other candidates.
    pub visibility: Option<f64>,
}

/// Structure with its probability.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct StructureEntry {
    /// Terms.
    pub effects: Vec<TermEntry>,
    /// Probability.
    pub weight: f64,
    /// Parameters, base first.
    pub parameters: Vec<ParameterEntry>,
    /// `true` if it is a member of the average.
    pub member: bool,
}

/// Priors and thresholds of the probabilities.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PriorEntry {
    /// Number of candidate terms, counted per form and record.
    pub candidates: usize,
    /// Prior probability of an effect.
    pub probability: f64,
    /// Prior probability of a moment that depends on time, in one record.
    #[serde(rename = "probability_of_time")]
    pub time_moment_probability: f64,
    /// Minimum probability of a named effect.
    #[serde(rename = "named_from")]
    pub min_named_probability: f64,
    /// Factors of the prior odds of all effects together, ascending; one of them is 1.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub odds_factors: Vec<f64>,
    /// Weighting rule of the structures.
    pub rule: String,
}

/// Whiteness of the residuals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(rename = "ResidualEntry")]
pub struct ResidualWhitenessEntry {
    /// Whiteness of the residual of the base.
    pub before: WhitenessEntry,
    /// Whiteness of the residual of the structure average.
    pub after: WhitenessEntry,
}

/// Whiteness of a residual.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct WhitenessEntry {
    /// Lag-1 autocorrelation.
    pub lag1_autocorrelation: f64,
    /// p value of the whiteness test (Ljung and Box 1978).
    pub whiteness_p: f64,
}

/// Kind of a correlated heading error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum HeadingErrorKind {
    /// Compass error, of first order.
    Compass,
    /// Smooth error of the model.
    Model,
}

/// Noise of one record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct RecordNoiseEntry {
    /// File of the record.
    pub file: String,
    /// Standard deviation of the white noise of a heading reading.
    pub heading_sd_deg: f64,
    /// Standard deviation of a correlated heading error.
    pub heading_wander_sd_deg: Option<f64>,
    /// Correlation time of that error.
    pub heading_correlation_s: Option<f64>,
    /// Kind of that error: `compass` (first order) or `model` (smooth).
    #[schemars(with = "Option<String>")]
    pub heading_wander: Option<HeadingErrorKind>,
    /// Kind of the random moment.
    pub moment: MomentKind,
    /// Standard deviation of gusts, of the mean of a white moment over one second, or of the change of a walk in one
    /// second.
    pub moment_sd_rudder_deg: Option<f64>,
    /// Correlation time of gusts.
    pub moment_correlation_s: Option<f64>,
    /// Standard deviation of waves.
    pub waves_sd_deg: Option<f64>,
    /// Frequency of waves.
    pub waves_frequency_rad_s: Option<f64>,
    /// `true` if the noise law describes the residual: innovations white, of constant variance, without outliers.
    #[serde(rename = "describes_what_is_left")]
    pub is_adequate: bool,
    /// Standard deviation of the measurement noise of the rudder, if there is any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rudder_sd_deg: Option<f64>,
    /// Times of removed compass outliers.
    pub outliers_s: Vec<f64>,
}

/// Augmented model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ModelEntry {
    /// Equations of the named effects.
    pub equations: Vec<String>,
    /// K, T and δ_r, averaged over the structures.
    #[serde(flatten)]
    pub indices: Indices,
    /// Parameters of the most probable structure.
    pub parameters: Vec<ParameterEntry>,
}

/// Result of the analysis of a trace, without files and identified ship.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(rename = "Document")]
pub struct AnalysisDocument {
    /// Version of the schema: `trace/4`.
    #[schemars(extend("const" = "trace/4"))]
    pub schema: String,
    /// Result in a few sentences.
    pub headline: String,
    /// `clean`, `disturbed`, `traced`, `located` or `unexplained`.
    pub verdict: TraceVerdict,
    /// K, T and δ_r of the base.
    pub base: Indices,
    /// Named effects, the most probable first.
    pub effects: Vec<EffectEntry>,
    /// Random moment in addition to the named effects.
    pub disturbance: Option<DisturbanceEntry>,
    /// Located shapes that belong to no listed effect, clearest first.
    pub located: Vec<LocatedMomentEntry>,
    /// All candidate effects with their outcomes.
    pub candidates: Vec<CandidateEntry>,
    /// Structures, the most probable first.
    pub structures: Vec<StructureEntry>,
    /// Priors and thresholds of the probabilities.
    pub prior: PriorEntry,
    /// Unexplained residual.
    pub unexplained: UnexplainedEntry,
    /// Replay errors before and after on every record.
    pub error: ReplayErrorLists,
    /// Whiteness of the residual before and after.
    pub residual: ResidualWhitenessEntry,
    /// Noise of every fitted record.
    pub noise: Vec<RecordNoiseEntry>,
    /// Augmented model.
    pub model: ModelEntry,
}

/// `trace.json`: together with its files of curves, the source of text, tables and plots.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct TraceDocument {
    /// Result of the analysis.
    #[serde(flatten)]
    pub trace: AnalysisDocument,
    /// Most informative next trial.
    pub next_trial: String,
    /// Records with the files of their curves, the fitted ones first.
    pub records: Vec<RecordEntry>,
    /// Missing yaw moment of the base on every fitted record.
    pub missing_moment: Vec<MissingMomentEntry>,
    /// Replay errors of the base and after each added effect of the most probable structure; empty if it has none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub staircase: Vec<InclusionStepEntry>,
    /// Amplitude of the fitted zig-zags, to which K and T of `base` belong; those of `model` belong to small motions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<ZigZagAmplitude>,
    /// K and T of every fitted zig-zag alone, if there are several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub single_records: Option<SingleRecords>,
    /// Identified ship for `study predict`; SI units and radians.
    pub ship: IdentifiedShip,
    /// Earlier trials given by `--prior`, and whether the records contradict them; absent without `--prior`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub earlier_trials: Option<EarlierTrials>,
    /// Description of the scaling of records of several scales to one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scales: Option<String>,
    /// Warnings on records and analysis, the most severe first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
}

impl TraceDocument {
    /// Length and approach speed to which dimensional numbers refer; `None` if no record has both.
    pub fn particulars(&self) -> Option<Particulars> {
        self.records.iter().find_map(RecordEntry::particulars)
    }

    /// Names of all records.
    pub fn names(&self) -> Vec<String> {
        self.records.iter().map(|record| record.name.clone()).collect()
    }

    /// Title: display names of the fitted records; of more than three records the first two, and the number of others.
    pub fn title(&self) -> String {
        let fitted = self.records.iter().filter(|record| !record.held_out);
        let names: Vec<String> = fitted.map(|record| names::record_name(&record.name)).collect();
        match names.len().saturating_sub(MAX_TITLE_NAMES) {
            0 | 1 => names.join(", "),
            more => format!("{} and {more} more", names[..MAX_TITLE_NAMES].join(", ")),
        }
    }

    /// Replay errors in two lists: on fitted records, and on records that were held out or left out in turn.
    pub fn errors(&self) -> (Vec<RecordErrors<'_>>, Vec<RecordErrors<'_>>) {
        let error = &self.trace.error;
        let (mut fitted, mut unfitted) = (Vec::new(), Vec::new());
        let names = |held_out: bool| self.records.iter().filter(move |record| record.held_out == held_out);
        for (record, errors) in names(false).zip(&error.identification) {
            fitted.push(RecordErrors { name: &record.name, used: "fitted", errors });
        }
        for (record, errors) in names(true).zip(&error.validation) {
            unfitted.push(RecordErrors { name: &record.name, used: "held out", errors });
        }
        for errors in &error.leave_one_out {
            let record = names(false).find(|record| record.file == errors.file);
            let name = record.map_or(&errors.file, |record| &record.name);
            unfitted.push(RecordErrors { name, used: "left out", errors });
        }
        (fitted, unfitted)
    }
}

impl From<WhitenessTest> for WhitenessEntry {
    fn from(test: WhitenessTest) -> Self {
        Self { lag1_autocorrelation: test.lag1_autocorrelation, whiteness_p: test.p_value }
    }
}
