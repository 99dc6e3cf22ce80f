//! The ships that a prediction draws, for other programs: `draws.parquet`, a row a ship.

use std::collections::BTreeMap;

use campaign::failure::{Failure, OnPath};
use campaign::folder::ResultFolder;
use campaign::parquet_table::{self, Values};
use predict::{DrawnParameters, PredictDocument};

/// Name of the file.
pub const DRAWS: &str = "draws.parquet";

/// The columns: which ship it is, its parameters, and its figures in every manoeuvre. What a structure or a ship does
/// not have is missing.
fn columns(predicted: &PredictDocument) -> Vec<(String, Values)> {
    let drawn = &predicted.drawn;
    let numbers = |of: fn(&DrawnParameters) -> Option<f64>| Values::Numbers(drawn.iter().map(of).collect());
    let texts = |of: &dyn Fn(&DrawnParameters) -> Option<String>| Values::Texts(drawn.iter().map(of).collect());
    let file = |own: &DrawnParameters| predicted.models.get(own.file).map(|model| model.file.clone());
    let mut parameters: BTreeMap<&str, Vec<Option<f64>>> = BTreeMap::new();
    for (row, own) in drawn.iter().enumerate() {
        for (key, value) in &own.parameters {
            parameters.entry(key).or_insert_with(|| vec![None; drawn.len()])[row] = Some(*value);
        }
    }
    let parameters = parameters.into_iter().map(|(key, values)| (format!("parameter.{key}"), Values::Numbers(values)));
    let figures = predicted.manoeuvres.iter().flat_map(|manoeuvre| {
        let name = move |figure: &String| format!("figure.{}.{figure}", manoeuvre.kind);
        manoeuvre.figures.iter().map(move |(figure, own)| (name(figure), Values::Numbers(own.draws.clone())))
    });
    [
        ("draw", Values::Counts((0..drawn.len() as i64).map(Some).collect())),
        ("model", texts(&file)),
        ("structure", texts(&|own| Some(own.structure.clone()))),
        ("weight", numbers(|own| Some(own.weight))),
        ("gear_rate_rad_s", numbers(|own| own.gear_rate_rad_s)),
        ("initial_yaw_rate_rad_s", numbers(|own| Some(own.yaw_rate_rad_s))),
    ]
    .map(|(name, values)| (name.to_owned(), values))
    .into_iter()
    .chain(parameters)
    .chain(figures)
    .collect()
}

/// Writes the ships of a prediction. Fails when the file cannot be written.
pub fn keep(folder: &ResultFolder, predicted: &PredictDocument) -> Result<(), Failure> {
    let bytes = parquet_table::encode(columns(predicted)).on("describe", &folder.path().join(DRAWS))?;
    folder.write(DRAWS, bytes)
}
