//! `predict.json`: predictions for other programs, and the curves behind the figures as tables.

use std::collections::BTreeMap;
use std::fmt::Write;

use predict::interval::Interval;
use predict::prediction::Bands;
use predict::turn::Current;
use predict::{Kind, Prediction};
use serde::Serialize;
use ship::angle::to_deg;

use super::picture::slug;
use super::predict_correction::{self, CorrectedEntry};
use super::predict_form::{self, FormEntry};
use super::predict_report::Predicted;
use crate::records::{file_of, names};

/// `predict.json`.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct PredictFile {
    /// `predict/1`.
    #[schemars(extend("const" = "predict/1"))]
    schema: &'static str,
    models: Vec<ModelEntry>,
    draws: usize,
    calm: bool,
    length_m: Option<f64>,
    speed_m_s: Option<f64>,
    manoeuvres: Vec<ManoeuvreEntry>,
    replays: Vec<ReplayEntry>,
    imo: Vec<CriterionEntry>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    corrected: Vec<CorrectedEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    form: Option<Vec<FormEntry>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    form_remarks: Option<Vec<String>>,
}

#[derive(Debug, Serialize, schemars::JsonSchema)]
struct ModelEntry {
    file: String,
    weight: f64,
}

#[derive(Debug, Serialize, schemars::JsonSchema)]
struct ManoeuvreEntry {
    kind: String,
    figures: BTreeMap<&'static str, FigureEntry>,
    /// Draws that did not come to the end.
    lost: usize,
}

#[derive(Debug, Serialize, schemars::JsonSchema)]
struct FigureEntry {
    median: f64,
    ci50: [f64; 2],
    ci90: [f64; 2],
    extrapolated: bool,
    /// Share of the draws that have the figure.
    defined: f64,
    /// Share of every source of doubt in the spread.
    shares: BTreeMap<&'static str, f64>,
}

#[derive(Debug, Serialize, schemars::JsonSchema)]
struct ReplayEntry {
    file: String,
    band_coverage_90: f64,
    heading_rmse_deg: f64,
    /// What was taken out of the track.
    current: Option<CurrentEntry>,
    figures: BTreeMap<&'static str, ComparedEntry>,
}

#[derive(Debug, Serialize, schemars::JsonSchema)]
struct CurrentEntry {
    speed_m_s: f64,
    /// Direction it sets to.
    set_deg: f64,
    north_m_s: f64,
    east_m_s: f64,
    north_sd_m_s: f64,
    east_sd_m_s: f64,
}

impl From<Current> for CurrentEntry {
    fn from(current: Current) -> Self {
        let ([north_m_s, east_m_s], [north_sd_m_s, east_sd_m_s]) = (current.velocity, current.deviation);
        let (speed_m_s, set_deg) = (current.speed(), to_deg(current.set()));
        Self { speed_m_s, set_deg, north_m_s, east_m_s, north_sd_m_s, east_sd_m_s }
    }
}

#[derive(Debug, Serialize, schemars::JsonSchema)]
struct ComparedEntry {
    measured: f64,
    median: f64,
    ci50: [f64; 2],
    ci90: [f64; 2],
    inside90: bool,
}

#[derive(Debug, Serialize, schemars::JsonSchema)]
struct CriterionEntry {
    criterion: &'static str,
    manoeuvre: String,
    limit: f64,
    unit: &'static str,
    median: f64,
    ci90: [f64; 2],
    probability_of_passing: f64,
    extrapolated: bool,
}

impl PredictFile {
    /// The file of one prediction.
    pub fn of(predicted: &Predicted) -> Self {
        Self {
            schema: "predict/1",
            models: (predicted.models.iter())
                .map(|(file, weight)| ModelEntry { file: file.clone(), weight: *weight })
                .collect(),
            draws: predicted.draws,
            calm: predicted.calm,
            length_m: predicted.particulars.map(|particulars| particulars.length),
            speed_m_s: predicted.particulars.map(|particulars| particulars.speed),
            manoeuvres: predicted.manoeuvres.iter().map(manoeuvre).collect(),
            replays: (predicted.replays.iter())
                .map(|(trial, replayed)| ReplayEntry {
                    file: file_of(trial).0.to_owned(),
                    band_coverage_90: replayed.band_coverage_90,
                    heading_rmse_deg: to_deg(replayed.rms),
                    current: replayed.current.map(CurrentEntry::from),
                    figures: (replayed.figures.iter())
                        .map(|figure| {
                            let Interval { median, ci50, ci90 } = figure.interval;
                            let measured = figure.measured;
                            let inside90 = figure.interval.holds90(measured);
                            (figure.name, ComparedEntry { measured, median, ci50, ci90, inside90 })
                        })
                        .collect(),
                })
                .collect(),
            corrected: predict_correction::entries(predicted),
            form: predicted.form.as_ref().map(|form| predict_form::entries(form, predicted)),
            form_remarks: predicted.form.as_ref().map(|form| form.remarks.clone()),
            imo: (predicted.criteria.iter())
                .map(|criterion| CriterionEntry {
                    criterion: criterion.name,
                    manoeuvre: criterion.manoeuvre.clone(),
                    limit: criterion.limit,
                    unit: criterion.unit.symbol(),
                    median: criterion.interval.median,
                    ci90: criterion.interval.ci90,
                    probability_of_passing: criterion.probability,
                    extrapolated: criterion.extrapolated,
                })
                .collect(),
        }
    }
}

fn manoeuvre(prediction: &Prediction) -> ManoeuvreEntry {
    let figure = |figure: &predict::prediction::Predicted| {
        let Interval { median, ci50, ci90 } = figure.interval;
        let shares = figure.shares.iter().map(|(source, share)| (source.as_str(), *share)).collect();
        let entry =
            FigureEntry { median, ci50, ci90, extrapolated: prediction.extrapolated, defined: figure.defined, shares };
        (figure.name, entry)
    };
    ManoeuvreEntry {
        kind: prediction.kind.to_string(),
        figures: prediction.figures.iter().map(figure).collect(),
        lost: prediction.lost,
    }
}

/// A stem of its own for every manoeuvre and record.
pub fn stems(predicted: &Predicted) -> Vec<String> {
    let own = predicted.manoeuvres.iter().map(|prediction| {
        let kind = prediction.kind.to_string();
        // A minus is no part of a slug.
        slug(&kind.replace(" -", " port "))
    });
    names(own.chain(predicted.replays.iter().map(|(trial, _)| format!("replay-{}", slug(trial.name())))))
}

/// The curves of every manoeuvre and replay: stem and table, angles in degrees.
pub fn curves(predicted: &Predicted) -> Vec<(String, String)> {
    let mut tables = Vec::new();
    let mut stems = stems(predicted).into_iter();
    for (prediction, stem) in predicted.manoeuvres.iter().zip(stems.by_ref()) {
        let table = match prediction.kind {
            Kind::Spiral { .. } => {
                let mut table = String::from("ship,rudder_deg,yaw_rate_deg_s\n");
                for (ship, curve) in prediction.curves.iter().enumerate() {
                    for (rudder, rate) in curve.rudder.iter().zip(&curve.yaw_rate) {
                        let _ = writeln!(table, "{ship},{:.5},{:.6}", to_deg(*rudder), to_deg(*rate));
                    }
                }
                table
            }
            _ => bands(&prediction.heading, None),
        };
        tables.push((stem, table));
    }
    for ((_, replayed), stem) in predicted.replays.iter().zip(stems) {
        tables.push((stem, bands(&replayed.heading, Some(&replayed.measured))));
    }
    tables
}

fn bands(bands: &Bands, measured: Option<&[f64]>) -> String {
    let mut table = String::from("t_s,heading_deg,q05_deg,q25_deg,q50_deg,q75_deg,q95_deg");
    table += if measured.is_some() { ",measured_deg\n" } else { "\n" };
    for (row, time) in bands.time.iter().enumerate() {
        let cell = |value: f64| if value.is_finite() { format!("{:.5}", to_deg(value)) } else { String::new() };
        let _ = write!(table, "{time:.4},{}", cell(bands.most_probable[row]));
        for quantile in bands.quantiles[row] {
            table += ",";
            table += &cell(quantile);
        }
        if let Some(measured) = measured {
            table += ",";
            table += &cell(measured[row]);
        }
        table.push('\n');
    }
    table
}
