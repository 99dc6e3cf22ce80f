//! Trials in ballast corrected to full load: table, words and entries of `predict.json`.

use std::collections::BTreeMap;

use predict::correction::{Corrected, Correction};
use predict::interval::Interval;
use report::markdown::text;
use report::number::{fixed, with_uncertainty};
use report::{Column, Table};
use serde::Serialize;

use super::predict_report::Predicted;
use super::predict_tables::{bracket, digits, words};
use crate::records::file_of;

/// A record that was corrected to full load.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct CorrectedEntry {
    file: String,
    /// Models at full load.
    full: Vec<String>,
    /// Models in the condition of the trial.
    ballast: Vec<String>,
    figures: BTreeMap<&'static str, FigureEntry>,
    /// What is to be said of all of them.
    warnings: Vec<String>,
}

#[derive(Debug, Serialize, schemars::JsonSchema)]
struct FigureEntry {
    /// T.
    measured: f64,
    sd: Option<f64>,
    /// R = T F/B.
    median: f64,
    ci50: [f64; 2],
    ci90: [f64; 2],
    /// F/B.
    factor: RangeEntry,
    /// F.
    full: RangeEntry,
    /// B.
    ballast: RangeEntry,
    warnings: Vec<String>,
}

#[derive(Debug, Serialize, schemars::JsonSchema)]
struct RangeEntry {
    median: f64,
    ci50: [f64; 2],
    ci90: [f64; 2],
}

impl From<Interval> for RangeEntry {
    fn from(Interval { median, ci50, ci90 }: Interval) -> Self {
        Self { median, ci50, ci90 }
    }
}

/// Every record that was corrected, with its name.
fn corrected(predicted: &Predicted) -> impl Iterator<Item = (&trial::Trial, &Correction)> {
    let pairs = predicted.replays.iter().zip(&predicted.corrections);
    pairs.filter_map(|((trial, _), correction)| Some((trial, correction.as_ref()?)))
}

/// The entries of the file.
pub fn entries(predicted: &Predicted) -> Vec<CorrectedEntry> {
    let said = |doubts: &[predict::correction::Doubt]| doubts.iter().map(ToString::to_string).collect();
    let figure = |figure: &Corrected| {
        let Interval { median, ci50, ci90 } = figure.result;
        let entry = FigureEntry {
            measured: figure.measured,
            sd: figure.sd,
            median,
            ci50,
            ci90,
            factor: figure.factor.into(),
            full: figure.full.into(),
            ballast: figure.trial.into(),
            warnings: said(&figure.doubts),
        };
        (figure.name, entry)
    };
    corrected(predicted)
        .map(|(trial, correction)| CorrectedEntry {
            file: file_of(trial).0.to_owned(),
            full: predicted.models.iter().map(|(file, _)| file.clone()).collect(),
            ballast: predicted.ballast.clone(),
            figures: correction.figures.iter().map(figure).collect(),
            warnings: said(&correction.doubts),
        })
        .collect()
}

/// Every corrected figure.
pub fn table(predicted: &Predicted) -> Table {
    let mut table = Table::new([
        Column::left("record"),
        Column::left("figure"),
        Column::left("unit"),
        Column::left("T measured"),
        Column::decimal("F/B"),
        Column::left("F/B 90 %"),
        Column::decimal("R"),
        Column::left("R 50 %"),
        Column::left("R 90 %"),
        Column::left("remark"),
    ]);
    for (trial, correction) in corrected(predicted) {
        for figure in &correction.figures {
            let (name, unit) = words(figure.name);
            let decimals = digits(&figure.result);
            let measured = match figure.sd {
                Some(_) => with_uncertainty(figure.measured, figure.sd),
                None => fixed(figure.measured, decimals),
            };
            let of_factor = digits(&figure.factor);
            let remarks: Vec<String> = figure.doubts.iter().map(ToString::to_string).collect();
            table.push([
                trial.name().to_owned(),
                name,
                unit.to_owned(),
                measured,
                fixed(figure.factor.median, of_factor),
                bracket(figure.factor.ci90, of_factor),
                fixed(figure.result.median, decimals),
                bracket(figure.result.ci50, decimals),
                bracket(figure.result.ci90, decimals),
                remarks.join("; "),
            ]);
        }
    }
    table
}

/// What is to be said of whole records, a line each.
fn doubts(predicted: &Predicted) -> Vec<String> {
    corrected(predicted)
        .flat_map(|(trial, correction)| correction.doubts.iter().map(move |doubt| format!("{}: {doubt}", trial.name())))
        .collect()
}

/// Heading, models, table and doubts for the screen; empty where nothing was corrected.
pub fn on_screen(predicted: &Predicted) -> String {
    if corrected(predicted).next().is_none() {
        return String::new();
    }
    let mut words = format!("\nCorrected to full load, R = T F/B (MSC/Circ.1053, 3.4.1.2)\n{}", models(predicted));
    words += &table(predicted).to_text();
    for doubt in doubts(predicted) {
        words += &format!("{doubt}\n");
    }
    words
}

fn models(predicted: &Predicted) -> String {
    let full: Vec<&str> = predicted.models.iter().map(|(file, _)| file.as_str()).collect();
    format!("F from {}, B from {}\n", full.join(", "), predicted.ballast.join(", "))
}

/// The section of the page; empty where nothing was corrected.
pub fn section(predicted: &Predicted) -> String {
    if corrected(predicted).next().is_none() {
        return String::new();
    }
    let mut page = format!(
        "\n## Corrected to full load\n\nR = T F/B (MSC/Circ.1053, 3.4.1.2): T is measured, B is what the model of the condition \
         of the trial does in the same manoeuvre, F what the model at full load does. {}\n\n",
        text(models(predicted).trim_end())
    );
    page += &table(predicted).to_markdown();
    page += "\nThe intervals hold the errors of both models, drawn apart, the random moment of a trial in each, and the \
             reading of T.\n";
    for doubt in doubts(predicted) {
        page += &format!("\n- {}\n", text(&doubt));
    }
    page
}
