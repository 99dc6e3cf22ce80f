//! `trace.json`: the analysis for other programs.

use std::collections::BTreeMap;

use ::trace::analysis::{Fitted, Judged, OnRecord};
use ::trace::noise::Wander;
use ::trace::replay_errors::HORIZONS;
use predict::KnownShip;
use serde::Serialize;
use ship::Particulars;
use ship::angle::to_deg;
use trial::{Quantity, Trial};

use super::missing_moment::{self, MissingMomentEntry};
use super::scale_comparison::ScalesEntry;
use super::trace_entries::{
    CandidateEntry, EffectEntry, ParameterEntry, PriorEntry, StepEntry, StructureEntry, candidates, is_false,
};
use super::trace_page;
use super::trace_report::TraceReport;
use crate::records::file_of;
use campaign::answer::{Parameters, PrimeIndices};

/// K and T that follow the measured speed.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct SpeedScalingEntry {
    /// The speed of which K and T are told.
    pub speed_m_s: f64,
    /// Change of BIC against constant K and T.
    pub delta_bic: f64,
}

/// `trace.json`.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct TraceFile {
    /// `trace/2`.
    #[schemars(extend("const" = "trace/2"))]
    pub schema: &'static str,
    /// `clean`, `traced` or `unexplained`.
    pub verdict: &'static str,
    /// K, T and δ_r of the base fitted alone.
    pub base: Parameters,
    /// Whether the search began from K and T that follow the measured speed.
    pub speed_scaling: Option<SpeedScalingEntry>,
    /// What was found, in the order of discovery.
    pub effects: Vec<EffectEntry>,
    /// The way from the base to the model, term by term, with the error after each.
    pub steps: Vec<StepEntry>,
    /// Every effect of the list and what became of it.
    pub candidates: Vec<CandidateEntry>,
    /// The structures that the records cannot tell apart, the most probable first.
    pub models: Vec<StructureEntry>,
    /// What the probabilities rest on.
    pub prior: PriorEntry,
    /// What is left.
    pub unexplained: UnexplainedEntry,
    /// Errors before and after on every record.
    pub error: ErrorEntry,
    /// Whiteness of the residual before and after.
    pub residual: ResidualEntry,
    /// The yaw moment that the base lacks on every fitted record.
    pub missing_moment: Vec<MissingMomentEntry>,
    /// The noise of every record.
    pub noise: Vec<RecordNoiseEntry>,
    /// The trial that would tell most.
    pub next_trial: String,
    /// The augmented model.
    pub model: ModelEntry,
    /// Terms that explained the records but made the error elsewhere worse.
    pub refused: Vec<String>,
    /// Readings of the compass that belong to no ship, of records that have any.
    pub outliers: Vec<OutliersEntry>,
    /// What is known of the ship, for `study predict`; SI units and radians.
    pub ship: KnownShip,
    /// Where the fitted records are of several scales: which terms scale.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scales: Option<ScalesEntry>,
}

/// Readings of one record that were left out.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct OutliersEntry {
    file: String,
    times_s: Vec<f64>,
}

/// What is left.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct UnexplainedEntry {
    present: bool,
    signature: Option<String>,
    empirical: Option<EmpiricalEntry>,
}

/// A term without a name that would carry some of it.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct EmpiricalEntry {
    terms: Vec<&'static str>,
    equation: &'static str,
    parameters: Vec<NamedParameter>,
    delta_bic: f64,
    p_value: f64,
    heading_rmse_deg: f64,
}

/// Errors of both kinds of records.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct ErrorEntry {
    identification: Vec<BeforeAfter>,
    validation: Vec<BeforeAfter>,
    /// Every record left out in turn, where there are several and none was held out.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    leave_one_out: Vec<BeforeAfter>,
}

/// One record.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct BeforeAfter {
    file: String,
    before: ErrorsEntry,
    after: ErrorsEntry,
}

/// Errors of one model on one record.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct ErrorsEntry {
    heading_rmse_deg: f64,
    yaw_rate_rmse_deg_s: Option<f64>,
    overshoot_error_deg: Option<f64>,
    horizon_rmse_deg: BTreeMap<String, Option<f64>>,
    /// Share of the headings inside the 95 % band of the full replay; null where the records do not tell its parameters
    /// apart.
    band_coverage_95: Option<f64>,
    /// With a moment of the record's own, where it was held out and the fitted records have such moments.
    #[serde(skip_serializing_if = "Option::is_none")]
    with_own_moment: Option<Box<ErrorsEntry>>,
}

/// Residual before and after.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct ResidualEntry {
    before: WhitenessEntry,
    after: WhitenessEntry,
}

/// Whiteness of a residual.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct WhitenessEntry {
    lag1_autocorrelation: f64,
    whiteness_p: f64,
}

/// The augmented model.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct ModelEntry {
    equations: Vec<&'static str>,
    #[serde(flatten)]
    indices: Indices,
    parameters: Vec<NamedParameter>,
    noise: NoiseEntry,
}

/// K, T and δ_r of the augmented model.
#[derive(Debug, Serialize, schemars::JsonSchema)]
struct Indices {
    #[serde(rename = "K_per_s")]
    k_per_s: Index,
    #[serde(rename = "T_s")]
    t_s: Index,
    delta_r_deg: Index,
    /// K' and T', where length and speed of the ship are known.
    #[serde(skip_serializing_if = "Option::is_none")]
    prime: Option<PrimeIndices>,
}

/// An index, and whether it rests on a parameter at an end of its range.
#[derive(Debug, Serialize, schemars::JsonSchema)]
struct Index {
    #[serde(flatten)]
    quantity: Quantity,
    #[serde(skip_serializing_if = "is_false")]
    at_bound: bool,
}

/// A parameter with its symbol.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct NamedParameter {
    key: &'static str,
    symbol: &'static str,
    #[serde(flatten)]
    value: ParameterEntry,
}

impl NamedParameter {
    fn new(fitted: &Fitted, ship: Option<Particulars>) -> Self {
        let value = ParameterEntry::new(fitted, ship);
        Self { key: fitted.parameter.key, symbol: fitted.parameter.symbol, value }
    }
}

/// The noise of one record.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct RecordNoiseEntry {
    file: String,
    /// Standard deviation of the white part.
    heading_sd_deg: f64,
    /// Standard deviation of an error of the compass that wanders.
    heading_wander_sd_deg: Option<f64>,
    heading_correlation_s: Option<f64>,
    moment: &'static str,
    /// Standard deviation of gusts, of the mean of a white moment over one second, of what a walk adds in one second.
    moment_sd_rudder_deg: Option<f64>,
    moment_correlation_s: Option<f64>,
    /// Whether the innovations are white, of one variance, and without a surprise.
    describes_what_is_left: Option<bool>,
}

/// The random part.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct NoiseEntry {
    heading_sd_deg: f64,
    random_moment: Option<&'static str>,
    random_moment_heading_sd_deg: Option<f64>,
    waves_sd_deg: Option<f64>,
    waves_frequency_rad_s: Option<f64>,
}

impl From<&OnRecord> for ErrorsEntry {
    fn from(on: &OnRecord) -> Self {
        let errors = &on.errors;
        let horizon =
            HORIZONS.iter().zip(errors.horizon).map(|(length, error)| (format!("{length:.0}"), error.map(to_deg)));
        Self {
            heading_rmse_deg: to_deg(errors.heading),
            yaw_rate_rmse_deg_s: errors.yaw_rate.map(to_deg),
            overshoot_error_deg: errors.overshoot.map(to_deg),
            horizon_rmse_deg: horizon.collect(),
            band_coverage_95: on.coverage(),
            with_own_moment: None,
        }
    }
}

fn entries<'a>(trials: &[Trial], judged: impl IntoIterator<Item = Option<&'a Judged>>) -> Vec<BeforeAfter> {
    trials
        .iter()
        .zip(judged)
        .filter_map(|(trial, judged)| Some((trial, judged?)))
        .map(|(trial, judged)| BeforeAfter {
            file: file_of(trial).0.to_owned(),
            before: (&judged.before).into(),
            after: ErrorsEntry {
                with_own_moment: judged.own_moment.as_ref().map(|own| Box::new(own.into())),
                ..(&judged.after).into()
            },
        })
        .collect()
}

impl TraceFile {
    /// The file of one analysis.
    pub fn of(report: &TraceReport) -> Self {
        let analysis = &report.analysis;
        let degree = to_deg(1.0);
        let base = &analysis.base;
        let whiteness = |k: usize| WhitenessEntry {
            lag1_autocorrelation: analysis.whiteness[k].lag1,
            whiteness_p: analysis.whiteness[k].p_value,
        };
        let [k, t] = analysis.indices;
        let named = |fitted: &Fitted| NamedParameter::new(fitted, report.ship);
        let unknown = Quantity::bare(f64::NAN);
        let noise = &analysis.randomness;
        let compass = noise.wander.filter(|kind| kind.is_of_compass());
        let moment = noise.wander.filter(|kind| !kind.is_of_compass());
        Self {
            schema: "trace/2",
            verdict: analysis.verdict.as_str(),
            base: Parameters { k_per_s: base.K(), t_s: base.T(), delta_r_deg: base.rudder_bias().scaled(degree) },
            speed_scaling: analysis
                .speed_scaling()
                .map(|(speed, gain)| SpeedScalingEntry { speed_m_s: speed, delta_bic: -gain }),
            effects: analysis.effects.iter().map(|effect| EffectEntry::new(effect, report.ship)).collect(),
            steps: analysis.steps.iter().map(StepEntry::from).collect(),
            candidates: candidates(&analysis.candidates, &analysis.weights),
            models: analysis.weights.alike().iter().map(|one| StructureEntry::new(one, &report.names)).collect(),
            prior: PriorEntry::new(&analysis.weights),
            unexplained: UnexplainedEntry {
                present: analysis.unexplained.is_some(),
                signature: trace_page::signature(report),
                empirical: analysis.empirical.as_ref().map(|empirical| EmpiricalEntry {
                    terms: empirical.group.clone(),
                    equation: empirical.equation,
                    parameters: empirical.parameters.iter().map(named).collect(),
                    delta_bic: -empirical.evidence.gain,
                    p_value: empirical.evidence.p_value,
                    heading_rmse_deg: to_deg(empirical.error),
                }),
            },
            error: ErrorEntry {
                identification: entries(&report.trials, analysis.identification.iter().map(Some)),
                validation: entries(&report.others, analysis.validation.iter().map(Some)),
                leave_one_out: entries(&report.trials, analysis.left_out.iter().map(Option::as_ref)),
            },
            residual: ResidualEntry { before: whiteness(0), after: whiteness(1) },
            noise: report.names[..report.trials.len()]
                .iter()
                .map(|name| RecordNoiseEntry {
                    file: name.clone(),
                    heading_sd_deg: to_deg(noise.white),
                    heading_wander_sd_deg: compass.map(|_| to_deg(noise.heading)),
                    heading_correlation_s: compass.and(noise.correlation),
                    moment: match moment {
                        Some(Wander::White) => "white",
                        Some(Wander::OrnsteinUhlenbeck(_)) => "ornstein-uhlenbeck",
                        Some(Wander::Walk) => "walk",
                        None | Some(Wander::Compass(_)) => "none",
                    },
                    moment_sd_rudder_deg: moment.map(|_| to_deg(noise.rudder)),
                    moment_correlation_s: moment.and(noise.correlation),
                    describes_what_is_left: noise.wander.map(|_| noise.holds),
                })
                .collect(),
            missing_moment: missing_moment::entries(report),
            next_trial: trace_page::next_trial(report),
            model: ModelEntry {
                equations: match analysis.effects.is_empty() {
                    true => vec!["T r' + r = K (δ + δ_r)"],
                    false => analysis.effects.iter().map(|effect| effect.equation).collect(),
                },
                indices: {
                    let bias = analysis.rudder_bias.map_or(unknown, |bias| bias.scaled(degree));
                    let [k_ends, t_ends, bias_ends] = analysis.indices_at_bound();
                    let own = Parameters { k_per_s: k, t_s: t, delta_r_deg: bias };
                    Indices {
                        prime: report.ship.map(|ship| own.prime(ship)),
                        k_per_s: Index { quantity: k, at_bound: k_ends },
                        t_s: Index { quantity: t, at_bound: t_ends },
                        delta_r_deg: Index { quantity: bias, at_bound: bias_ends },
                    }
                },
                parameters: analysis.parameters.iter().map(named).collect(),
                noise: NoiseEntry {
                    heading_sd_deg: to_deg(noise.white),
                    random_moment: moment.map(trace_page::kind),
                    random_moment_heading_sd_deg: moment.map(|_| to_deg(noise.heading)),
                    waves_sd_deg: noise.waves.map(|waves| to_deg(waves.sd)),
                    waves_frequency_rad_s: noise.waves.map(|waves| waves.frequency),
                },
            },
            refused: analysis.refused.clone(),
            outliers: report
                .names
                .iter()
                .zip(&analysis.outliers)
                .filter(|(_, times)| !times.is_empty())
                .map(|(name, times)| OutliersEntry { file: name.clone(), times_s: times.clone() })
                .collect(),
            ship: report.known.clone(),
            scales: report.scales.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_is_written_where_it_was_reached_and_nowhere_else() {
        let quantity = Quantity::bare(0.1);
        let written = |at_bound| serde_json::to_value(Index { quantity, at_bound }).expect("plain data");
        assert_eq!(written(true)["at_bound"], true);
        assert_eq!(written(false).as_object().map(|object| object.len()), Some(3));
    }
}
