//! The form for reporting manoeuvring data to IMO (MSC/Circ.1053, appendix 6): as a page and as entries of
//! `predict.json`.

use predict::form::{Basis, Entry, Form, TRACK_REACH_LENGTHS, Value};
use report::markdown::text;
use report::number::{fixed, significant};
use report::{Column, Table};
use serde::Serialize;

use super::predict_report::Predicted;
use super::predict_tables::{bracket, digits};

/// What stands for an entry that nobody can fill in.
const EMPTY: &str = "–";

/// Most decimals of a result: no trial tells a hundredth of a degree or of a ship length.
const DECIMALS: usize = 2;

/// Decimals of a measured result: as many as its standard deviation supports.
fn decimals_of(sd: Option<f64>) -> usize {
    sd.filter(|sd| *sd > 0.0).map_or(DECIMALS, |sd| ((-sd.log10()).ceil().max(0.0) as usize).min(DECIMALS))
}

/// An entry of the form for other programs.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct FormEntry {
    section: &'static str,
    field: &'static str,
    side: Option<&'static str>,
    /// A declared word, or a declared or measured number.
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<serde_json::Value>,
    /// Standard deviation of a measured number.
    #[serde(skip_serializing_if = "Option::is_none")]
    sd: Option<f64>,
    /// Median of a predicted or corrected number.
    #[serde(skip_serializing_if = "Option::is_none")]
    median: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    ci90: Option<[f64; 2]>,
    unit: &'static str,
    limit: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    extrapolated: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    probability_of_passing: Option<f64>,
    source: String,
}

/// The entries in the order of the form.
pub fn entries(form: &Form, predicted: &Predicted) -> Vec<FormEntry> {
    form.entries.iter().map(|entry| of(entry, predicted)).collect()
}

fn of(entry: &Entry, predicted: &Predicted) -> FormEntry {
    let (value, sd, interval) = match &entry.value {
        None => (None, None, None),
        Some(Value::Text(words)) => (Some(words.as_str().into()), None, None),
        Some(Value::Number(number)) => (Some((*number).into()), None, None),
        Some(Value::Measured { value, sd }) => (Some((*value).into()), *sd, None),
        Some(Value::Interval(interval)) => (None, None, Some(interval)),
    };
    let (extrapolated, probability_of_passing) = match entry.basis {
        Basis::Predicted { extrapolated, passing } => (Some(extrapolated), passing),
        _ => (None, None),
    };
    FormEntry {
        section: entry.section,
        field: entry.name,
        side: entry.side,
        value,
        sd,
        median: interval.map(|interval| interval.median),
        ci90: interval.map(|interval| interval.ci90),
        unit: entry.unit,
        limit: entry.limit,
        extrapolated,
        probability_of_passing,
        source: source(entry, predicted),
    }
}

/// A value as it is filled in, without its unit.
fn filled(entry: &Entry) -> String {
    match &entry.value {
        None => EMPTY.to_owned(),
        Some(Value::Text(words)) => words.clone(),
        Some(Value::Number(number)) => significant(*number, if number.fract() == 0.0 { 1 } else { 3 }),
        Some(Value::Measured { value, sd }) => fixed(*value, decimals_of(*sd)),
        Some(Value::Interval(told)) => fixed(told.median, digits(told).min(DECIMALS)),
    }
}

/// Where an entry comes from, in words.
fn source(entry: &Entry, predicted: &Predicted) -> String {
    let range = match &entry.value {
        Some(Value::Interval(told)) => bracket(told.ci90, digits(told).min(DECIMALS)),
        _ => String::new(),
    };
    match &entry.basis {
        Basis::Declared { file } => format!("declared with {file}"),
        Basis::Scale => String::from("scale of the prediction"),
        Basis::Loading => String::from("from the records given"),
        Basis::NotInRecords => String::from("not in the records"),
        Basis::NotTold { why } => (*why).to_owned(),
        Basis::Measured { file, partial } => {
            let sd = match &entry.value {
                Some(Value::Measured { sd: Some(sd), .. }) => format!(" ± {}", significant(*sd, 1)),
                _ => String::new(),
            };
            let load = if *partial { ", at partial load, not corrected" } else { "" };
            format!("measured, {file}{sd}{load}")
        }
        Basis::Corrected { file, factor, doubtful } => {
            let doubt = if *doubtful { "; see the remarks" } else { "" };
            format!(
                "measured at partial load, {file}, and corrected by F/B = {} {}, 90 % {range}{doubt}",
                fixed(factor.median, digits(factor).min(DECIMALS)),
                bracket(factor.ci90, digits(factor).min(DECIMALS))
            )
        }
        Basis::Predicted { extrapolated, passing } => {
            let files: Vec<&str> = predicted.models.iter().map(|(file, _)| file.as_str()).collect();
            let beyond = if *extrapolated { ", extrapolated" } else { "" };
            let passing = passing.map_or_else(String::new, |share| format!("; {} % pass", fixed(100.0 * share, 0)));
            format!("predicted from {}, 90 % {range}{beyond}{passing}", files.join(", "))
        }
    }
}

/// The page of the form.
pub fn page(form: &Form, predicted: &Predicted) -> String {
    let mut page = String::from(
        "# Form for reporting manoeuvring data to IMO\n\nMSC/Circ.1053 (2002), appendix 6; criteria of resolution \
         MSC.137(76). Every entry names its source; what is predicted is no trial.\n",
    );
    let mut sections: Vec<&str> = Vec::new();
    for entry in &form.entries {
        if !sections.contains(&entry.section) {
            sections.push(entry.section);
        }
    }
    let (declared, tested): (Vec<&str>, Vec<&str>) = sections.into_iter().partition(|section| {
        form.entries.iter().filter(|entry| entry.section == *section).all(|entry| entry.side.is_none())
            && *section != "stopping"
    });
    for section in declared {
        if !section.is_empty() {
            page += &format!("\n## {}\n\n", text(&capital(section)));
        } else {
            page += "\n";
        }
        let mut table =
            Table::new([Column::left("entry"), Column::left("value"), Column::left("unit"), Column::left("source")]);
        for entry in form.entries.iter().filter(|entry| entry.section == section) {
            let source = source(entry, predicted);
            table.push([entry.name.to_owned(), filled(entry), unit(entry).to_owned(), source]);
        }
        page += &table.to_markdown();
    }
    page += "\n## Test results\n\n";
    let mut table = Table::new([
        Column::left("test"),
        Column::left("result"),
        Column::left("side"),
        Column::left("value"),
        Column::left("unit"),
        Column::left("IMO criterion"),
        Column::left("source"),
    ]);
    for entry in form.entries.iter().filter(|entry| tested.contains(&entry.section)) {
        table.push([
            entry.section.to_owned(),
            entry.name.to_owned(),
            entry.side.unwrap_or_default().to_owned(),
            filled(entry),
            unit(entry).to_owned(),
            criterion(entry),
            source(entry, predicted),
        ]);
    }
    page += &table.to_markdown();
    page += "\n## Remarks\n\n";
    for remark in &form.remarks {
        page += &format!("- {}\n", text(remark));
    }
    if form.remarks.is_empty() {
        page += "None.\n";
    }
    page
}

fn criterion(entry: &Entry) -> String {
    match entry.limit {
        Some(limit) if limit == TRACK_REACH_LENGTHS && entry.section == "stopping" => {
            String::from("≤ 15, up to 20 where the Administration allows")
        }
        Some(limit) => format!("≤ {}", fixed(limit, 1)),
        None => String::from("depends on L/V, which is not known"),
    }
}

fn unit(entry: &Entry) -> &'static str {
    if entry.unit == "1" { "" } else { entry.unit }
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
