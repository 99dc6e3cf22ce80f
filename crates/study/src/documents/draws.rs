//! Drawn ships of a prediction, for other programs: `draws.parquet`, one row per ship.

use std::collections::BTreeMap;

use campaign::failure::{Failure, OnPath};
use campaign::folder::ResultFolder;
use campaign::parquet_table::{self, Values};
use predict::{DrawnParameters, PredictDocument};

/// Name of the file.
pub const DRAWS: &str = "draws.parquet";

/// Columns: number of the ship, its parameters, and its figures in every manoeuvre; missing where a structure or a ship
/// lacks them.
fn columns(predicted: &PredictDocument) -> Vec<(String, Values)> {
    let drawn = &predicted.drawn;
    let numbers = |pick: fn(&DrawnParameters) -> Option<f64>| Values::Numbers(drawn.iter().map(pick).collect());
    let texts = |pick: &dyn Fn(&DrawnParameters) -> Option<String>| Values::Texts(drawn.iter().map(pick).collect());
    let file = |draw: &DrawnParameters| predicted.models.get(draw.file).map(|model| model.file.clone());
    let mut parameters: BTreeMap<&str, Vec<Option<f64>>> = BTreeMap::new();
    for (row, draw) in drawn.iter().enumerate() {
        for (key, value) in &draw.parameters {
            parameters.entry(key).or_insert_with(|| vec![None; drawn.len()])[row] = Some(*value);
        }
    }
    let parameters = parameters.into_iter().map(|(key, values)| (format!("parameter.{key}"), Values::Numbers(values)));
    let figures = predicted.manoeuvres.iter().flat_map(|manoeuvre| {
        let name = move |figure: &String| format!("figure.{}.{figure}", manoeuvre.kind);
        manoeuvre.figures.iter().map(move |(figure, values)| (name(figure), Values::Numbers(values.draws.clone())))
    });
    [
        ("draw", Values::Counts((0..drawn.len() as i64).map(Some).collect())),
        ("model", texts(&file)),
        ("structure", texts(&|draw| Some(draw.structure.clone()))),
        ("weight", numbers(|draw| Some(draw.weight))),
        ("gear_rate_rad_s", numbers(|draw| draw.gear_rate_rad_s)),
        ("initial_yaw_rate_rad_s", numbers(|draw| Some(draw.yaw_rate_rad_s))),
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
