//! Draws for other programs, `draws.parquet`: ships of a prediction, or estimates of a fit or a trace, one row each.

use std::collections::BTreeMap;

use campaign::failure::{Failure, OnPath};
use campaign::folder::ResultFolder;
use campaign::parquet_table::{self, ColumnValues};
use document::IdentifiedShip;
use predict::{DrawnEstimate, DrawnParameters, EstimateSampler, PredictDocument};

/// Name of the file with the drawn ships or estimates.
pub const DRAWS_FILE: &str = "draws.parquet";

/// Columns of a prediction: number of the ship, its parameters, and its characteristics in every manoeuvre. A cell is
/// missing if the structure lacks the parameter or the ship the characteristic.
fn columns(predicted: &PredictDocument) -> Vec<(String, ColumnValues)> {
    let drawn = &predicted.drawn;
    let numbers = |pick: fn(&DrawnParameters) -> Option<f64>| ColumnValues::Numbers(drawn.iter().map(pick).collect());
    let texts =
        |pick: &dyn Fn(&DrawnParameters) -> Option<String>| ColumnValues::Texts(drawn.iter().map(pick).collect());
    let file = |draw: &DrawnParameters| predicted.models.get(draw.file_index).map(|model| model.file.clone());
    let parameters = parameter_columns(drawn.iter().map(|ship| &ship.parameters[..]).collect());
    let figures = predicted.manoeuvres.iter().flat_map(|manoeuvre| {
        let name = move |figure: &String| format!("figure.{}.{figure}", manoeuvre.kind);
        manoeuvre
            .figures
            .iter()
            .map(move |(figure, values)| (name(figure), ColumnValues::Numbers(values.drawn_values.clone())))
    });
    [
        ("draw", ColumnValues::Counts((0..drawn.len() as i64).map(Some).collect())),
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

/// Column of every parameter of the rows; a cell is missing if its row lacks the parameter.
fn parameter_columns(rows: Vec<&[(String, f64)]>) -> impl Iterator<Item = (String, ColumnValues)> {
    let mut columns: BTreeMap<String, Vec<Option<f64>>> = BTreeMap::new();
    for (row, parameters) in rows.iter().enumerate() {
        for (key, value) in *parameters {
            let column = columns.entry(format!("parameter.{key}")).or_insert_with(|| vec![None; rows.len()]);
            column[row] = Some(*value);
        }
    }
    columns.into_iter().map(|(name, values)| (name, ColumnValues::Numbers(values)))
}

/// Sample of an estimate: its number from 0, its method, and its parameters.
struct EstimateRow<'a> {
    number: u32,
    method: &'a str,
    drawn: DrawnEstimate,
}

impl EstimateRow<'_> {
    /// Value of a function of the first three parameters, 1/T, K/T and δ_r; `None` if it is not finite.
    fn number(&self, of: fn([f64; 3]) -> f64) -> Option<f64> {
        let base = std::array::from_fn(|place| self.drawn.parameters[place].1);
        Some(of(base)).filter(|value| value.is_finite())
    }
}

/// Columns of estimates: number of the sample, method, structure, weight, K (1/s), T (s), δ_r (rad), and every
/// parameter.
fn estimate_columns(rows: &[EstimateRow]) -> Vec<(String, ColumnValues)> {
    let texts = |of: fn(&EstimateRow) -> String| ColumnValues::Texts(rows.iter().map(|row| Some(of(row))).collect());
    let numbers = |of: fn([f64; 3]) -> f64| ColumnValues::Numbers(rows.iter().map(|row| row.number(of)).collect());
    [
        ("draw", ColumnValues::Counts(rows.iter().map(|row| Some(row.number.into())).collect())),
        ("method", texts(|row| row.method.to_owned())),
        ("structure", texts(|row| row.drawn.structure.clone())),
        ("weight", ColumnValues::Numbers(rows.iter().map(|row| Some(row.drawn.weight)).collect())),
        ("K_per_s", numbers(|[inverse_t, k_over_t, _]| k_over_t / inverse_t)),
        ("T_s", numbers(|[inverse_t, ..]| 1.0 / inverse_t)),
        ("delta_r_rad", numbers(|[.., bias]| bias)),
    ]
    .map(|(name, values)| (name.to_owned(), values))
    .into_iter()
    .chain(parameter_columns(rows.iter().map(|row| &row.drawn.parameters[..]).collect()))
    .collect()
}

/// Writes the given number of draws from every estimate, each row with the name of its method; `seed` is that of the
/// draws.
///
/// Fails if an estimate cannot be sampled, or if the file cannot be written.
pub fn write_estimates<'a>(
    folder: &ResultFolder,
    answers: impl Iterator<Item = (&'a str, &'a IdentifiedShip)>,
    draws: u32,
    seed: u64,
) -> Result<(), Failure> {
    let mut rows = Vec::new();
    for (method, answer) in answers {
        let of_answer = EstimateSampler::new(answer, seed).map_err(|error| Failure::in_file(method, error))?;
        rows.extend((0..draws).map(|number| EstimateRow { number, method, drawn: of_answer.sample(number.into()) }));
    }
    keep_columns(folder, estimate_columns(&rows))
}

/// Writes the drawn ships of a prediction. Fails if the file cannot be written.
pub fn write_ships(folder: &ResultFolder, predicted: &PredictDocument) -> Result<(), Failure> {
    keep_columns(folder, columns(predicted))
}

fn keep_columns(folder: &ResultFolder, columns: Vec<(String, ColumnValues)>) -> Result<(), Failure> {
    let bytes = parquet_table::encode(columns).on("describe", &folder.path().join(DRAWS_FILE))?;
    folder.write(DRAWS_FILE, bytes)
}
