//! What a trace says, as `trace.json` holds it.
//!
//! Angles are in degrees where a name says so; parameters of effects are in SI units and radians.

use std::collections::BTreeMap;

use estimation::residuals::Whiteness;
use serde::{Deserialize, Serialize};
use ship::Particulars;

use crate::earlier_trials::EarlierTrials;
use crate::identified_ship::IdentifiedShip;
use crate::names;
use crate::noise::Moment;
use crate::single_records::{Amplitude, SingleRecords};
use crate::warning::Warning;

mod entries;
mod errors;

pub use entries::{
    Dependence, DisturbanceEntry, Indices, LocatedEntry, MissingMomentEntry, PanelEntry, ParameterEntry, PrimeEntry,
    PrimeIndices, RecordEntry, RecordErrors, StairEntry, UnexplainedEntry,
};
pub use errors::{BeforeAfter, ErrorEntry, ErrorsEntry, HorizonEntry};

/// Name of the schema.
pub const SCHEMA: &str = "trace/4";

/// Records whose names are a title; one more stands there, too.
const TITLED: usize = 2;

/// What the analysis says.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The noise of the instruments alone explains the records.
    #[default]
    Clean,
    /// A random moment is needed, and no effect is named: weather does this, and so does an effect of a shape that was
    /// not looked for.
    Disturbed,
    /// What is missing has a name, and what is left is clean or disturbed.
    Traced,
    /// What is left has a shape that no effect of the list is.
    Located,
    /// What is left is neither chance nor of a shape that was looked for.
    Unexplained,
}

impl Verdict {
    /// All verdicts.
    pub const ALL: [Self; 5] = [Self::Clean, Self::Disturbed, Self::Traced, Self::Located, Self::Unexplained];
}

/// What became of a candidate, the best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// It is named.
    Added,
    /// It is one of a group that is named together.
    Alias,
    /// The records speak against it, or do not need it.
    Rejected,
    /// The records could not show it.
    NotObservable,
}

impl Outcome {
    /// The words on a page.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Added => "added",
            Self::Alias => "alias",
            Self::Rejected => "rejected",
            Self::NotObservable => "not observable",
        }
    }
}

/// An effect in a form, in all records or in one.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct TermEntry {
    /// Identifier.
    pub id: String,
    /// Form.
    pub form: String,
    /// The one record in which it acts.
    pub only: Option<String>,
}

/// An effect that is named.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct EffectEntry {
    /// Identifier.
    pub id: String,
    /// Most probable form.
    pub form: String,
    /// Equation.
    pub equation: String,
    /// The one record in which it acts.
    pub only: Option<String>,
    /// Whether it is in the model on request; left out where it was found.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub asked: bool,
    /// Effects that the records cannot tell from it: one of the group is there.
    pub aliases: Vec<String>,
    /// Forms that the records cannot tell from it, of its group and of itself.
    pub alias_forms: Vec<TermEntry>,
    /// Its parameters by their symbols.
    pub parameters: BTreeMap<String, ParameterEntry>,
    /// Probability that it, or one of its group, is there.
    pub probability: f64,
    /// The same with the prior odds of all effects times each of `prior.odds_factors`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub probability_by_prior_odds: Vec<f64>,
    /// −2 log of the ratio of the evidence with it to that without: negative where it is better.
    pub delta_bic: f64,
    /// Probability of sizes as far from neutral by chance, beside all other candidates (χ²).
    pub p_value: f64,
    /// One sentence on it.
    pub evidence: String,
}

/// An effect of the list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct CandidateEntry {
    /// Identifier.
    pub id: String,
    /// What became of its best form.
    pub outcome: Outcome,
    /// Probability that it is there in any form and record.
    pub probability: f64,
    /// The same with the prior odds of all effects times each of `prior.odds_factors`; nothing where no structure has
    /// it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub probability_by_prior_odds: Vec<f64>,
    /// As that of an effect, for the best form.
    pub delta_bic: Option<f64>,
    /// As that of an effect, for the best form.
    pub p_value: Option<f64>,
    /// Why it is no candidate.
    pub reason: Option<String>,
    /// Of a formula: what becomes of its moment where port and starboard are exchanged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sides: Option<String>,
    /// Its forms.
    pub forms: Vec<FormEntry>,
}

/// An effect in one form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct FormEntry {
    /// Form.
    pub form: String,
    /// The one record in which it would act.
    pub only: Option<String>,
    /// What became of it.
    pub outcome: Outcome,
    /// Probability that it is there.
    pub probability: f64,
    /// As that of an effect.
    pub delta_bic: Option<f64>,
    /// As that of an effect.
    pub p_value: Option<f64>,
    /// Expected square of its size over its error beside all other candidates.
    pub visibility: Option<f64>,
}

/// A structure with its probability.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct StructureEntry {
    /// Its terms.
    pub effects: Vec<TermEntry>,
    /// Probability.
    pub weight: f64,
    /// Its parameters, base first.
    pub parameters: Vec<ParameterEntry>,
    /// Whether it is a member of the average.
    pub member: bool,
}

/// What the probabilities rest on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PriorEntry {
    /// Forms among the candidates, those of every record counted.
    pub candidates: usize,
    /// Prior probability of an effect.
    pub probability: f64,
    /// Prior probability of a moment that depends on time, in one record.
    pub probability_of_time: f64,
    /// Probability from which an effect is named.
    pub named_from: f64,
    /// Factors of the prior odds of all effects together, from small to large; one of them is 1.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub odds_factors: Vec<f64>,
    /// How structures were weighed.
    pub rule: String,
}

/// Residual before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ResidualEntry {
    /// Of the base.
    pub before: WhitenessEntry,
    /// Of the average.
    pub after: WhitenessEntry,
}

/// Whiteness of a residual.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct WhitenessEntry {
    /// Lag-1 autocorrelation.
    pub lag1_autocorrelation: f64,
    /// Probability of autocorrelations as large in a white residual (Ljung and Box 1978).
    pub whiteness_p: f64,
}

/// What a heading error that lasts is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum HeadingWander {
    /// One of the compass, of first order.
    Compass,
    /// A smooth one of a model that is not quite the ship.
    Model,
}

/// The noise of one record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct RecordNoiseEntry {
    /// Its file.
    pub file: String,
    /// Standard deviation of the white noise of a reading.
    pub heading_sd_deg: f64,
    /// Standard deviation of a heading error that lasts.
    pub heading_wander_sd_deg: Option<f64>,
    /// How long it lasts.
    pub heading_correlation_s: Option<f64>,
    /// What a heading error that lasts is: `compass` (first order) or `model` (smooth, of a model that is not quite the
    /// ship).
    #[schemars(with = "Option<String>")]
    pub heading_wander: Option<HeadingWander>,
    /// Kind of the random moment.
    pub moment: Moment,
    /// Standard deviation of gusts, of the mean of a white moment over one second, of what a walk adds in one second.
    pub moment_sd_rudder_deg: Option<f64>,
    /// Correlation time of gusts.
    pub moment_correlation_s: Option<f64>,
    /// Standard deviation of waves.
    pub waves_sd_deg: Option<f64>,
    /// Frequency of waves.
    pub waves_frequency_rad_s: Option<f64>,
    /// Whether the innovations are white, of one variance, and without a surprise.
    pub describes_what_is_left: bool,
    /// Standard deviation of the error of a reading of the rudder, where it is noise of the instrument.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rudder_sd_deg: Option<f64>,
    /// Times of readings of the compass that belong to no ship and were left out.
    pub outliers_s: Vec<f64>,
}

/// The augmented model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ModelEntry {
    /// Equations of the named effects.
    pub equations: Vec<String>,
    /// K, T and δ_r, averaged over the structures.
    #[serde(flatten)]
    pub indices: Indices,
    /// All parameters of the most probable structure.
    pub parameters: Vec<ParameterEntry>,
}

/// The analysis of a trace, without the files and the ship beside it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Document {
    /// `trace/4`.
    #[schemars(extend("const" = "trace/4"))]
    pub schema: String,
    /// The result in one sentence.
    pub headline: String,
    /// `clean`, `disturbed`, `traced`, `located` or `unexplained`.
    pub verdict: Verdict,
    /// K, T and δ_r of the base fitted alone.
    pub base: Indices,
    /// What is named, the most probable first.
    pub effects: Vec<EffectEntry>,
    /// The random moment that is needed beside them.
    pub disturbance: Option<DisturbanceEntry>,
    /// Moments that are no effects of the list, the clearest first.
    pub located: Vec<LocatedEntry>,
    /// Every effect of the list and what became of it.
    pub candidates: Vec<CandidateEntry>,
    /// The structures, the most probable first.
    pub structures: Vec<StructureEntry>,
    /// What the probabilities rest on.
    pub prior: PriorEntry,
    /// What is left.
    pub unexplained: UnexplainedEntry,
    /// Errors before and after on every record.
    pub error: ErrorEntry,
    /// Whiteness of the residual before and after.
    pub residual: ResidualEntry,
    /// The noise of every fitted record.
    pub noise: Vec<RecordNoiseEntry>,
    /// The augmented model.
    pub model: ModelEntry,
}

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
    /// The base, and behind it the effects of the most probable structure one by one; nothing where it has none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub staircase: Vec<StairEntry>,
    /// The amplitude of the fitted zig-zags: K and T of `base` belong to it, those of `model` to small motions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<Amplitude>,
    /// K and T of every fitted zig-zag alone, where there are several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub single_records: Option<SingleRecords>,
    /// What is known of the ship, for `study predict`; SI units and radians.
    pub ship: IdentifiedShip,
    /// What earlier trials of `--prior` say of the hull, and whether the records contradict them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub earlier_trials: Option<EarlierTrials>,
    /// How records of several scales were brought to one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scales: Option<String>,
    /// Warnings of records and analysis, the worst first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<Warning>,
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
        let names: Vec<String> = fitted.map(|record| names::record(&record.name)).collect();
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

impl From<Whiteness> for WhitenessEntry {
    fn from(own: Whiteness) -> Self {
        Self { lag1_autocorrelation: own.lag1, whiteness_p: own.p_value }
    }
}
