//! Rows of a study: one per trial and method, a failed fit included, stored as Parquet.
//!
//! Nothing that depends on the clock or the machine is in a row, so the file has the same bytes for the same scenario
//! and seed whatever the number of threads.

use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::Field;
use parquet::schema::types::Type;

use crate::failure::{Failure, OnPath};

/// The result of one method on one trial. Units are in the names; `None` is "not defined".
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Row {
    /// Index of the cell in the design.
    pub cell: u64,
    /// Index of the replicate in the cell.
    pub replicate: u64,
    /// Label of the method in the scenario.
    pub method: String,
    /// Why the method failed; `None` when it did not.
    pub reason: Option<String>,
    /// True K, 1/s, where the ship has one.
    pub true_k_per_s: Option<f64>,
    /// True T, s.
    pub true_t_s: Option<f64>,
    /// K, 1/s.
    pub k_per_s: Option<f64>,
    /// Lower and upper end of the 95 % interval of K, 1/s.
    pub k_ci95_per_s: Option<[f64; 2]>,
    /// T, s.
    pub t_s: Option<f64>,
    /// 95 % interval of T, s.
    pub t_ci95_s: Option<[f64; 2]>,
    /// δ_r, deg.
    pub rudder_bias_deg: Option<f64>,
    /// 95 % interval of δ_r, deg.
    pub rudder_bias_ci95_deg: Option<[f64; 2]>,
    /// Root mean square error of the replayed heading on the trial itself, deg.
    pub heading_rmse_deg: Option<f64>,
    /// Model evaluations of the method.
    pub evaluations: Option<u64>,
    /// Why the method stopped.
    pub stop: Option<String>,
}

/// One column of the file: its name and how it is taken out of a row.
enum Column {
    Count(&'static str, fn(&Row) -> u64),
    Number(&'static str, fn(&Row) -> Option<f64>),
    Text(&'static str, fn(&Row) -> Option<&str>),
}

const COLUMNS: [Column; 18] = [
    Column::Count("cell", |row| row.cell),
    Column::Count("replicate", |row| row.replicate),
    Column::Text("method", |row| Some(&row.method)),
    Column::Text("failure", |row| row.reason.as_deref()),
    Column::Number("true_K_per_s", |row| row.true_k_per_s),
    Column::Number("true_T_s", |row| row.true_t_s),
    Column::Number("K_per_s", |row| row.k_per_s),
    Column::Number("K_lower95_per_s", |row| row.k_ci95_per_s.map(|ends| ends[0])),
    Column::Number("K_upper95_per_s", |row| row.k_ci95_per_s.map(|ends| ends[1])),
    Column::Number("T_s", |row| row.t_s),
    Column::Number("T_lower95_s", |row| row.t_ci95_s.map(|ends| ends[0])),
    Column::Number("T_upper95_s", |row| row.t_ci95_s.map(|ends| ends[1])),
    Column::Number("delta_r_deg", |row| row.rudder_bias_deg),
    Column::Number("delta_r_lower95_deg", |row| row.rudder_bias_ci95_deg.map(|ends| ends[0])),
    Column::Number("delta_r_upper95_deg", |row| row.rudder_bias_ci95_deg.map(|ends| ends[1])),
    Column::Number("heading_rmse_deg", |row| row.heading_rmse_deg),
    Column::Number("evaluations", |row| row.evaluations.map(|count| count as f64)),
    Column::Text("stop", |row| row.stop.as_deref()),
];

impl Column {
    fn schema(&self) -> Type {
        let (name, physical, repetition, logical) = match self {
            Self::Count(name, _) => (name, Physical::INT64, Repetition::REQUIRED, None),
            Self::Number(name, _) => (name, Physical::DOUBLE, Repetition::OPTIONAL, None),
            Self::Text(name, _) => (name, Physical::BYTE_ARRAY, Repetition::OPTIONAL, Some(LogicalType::String)),
        };
        Type::primitive_type_builder(name, physical)
            .with_repetition(repetition)
            .with_logical_type(logical)
            .build()
            .expect("the columns are declared consistently")
    }
}

/// Writes all rows, in their order, to a new file; the file appears whole or not at all.
pub fn write(path: &Path, rows: &[Row]) -> Result<(), Failure> {
    let fields = COLUMNS.iter().map(|column| Arc::new(column.schema())).collect();
    let schema = Type::group_type_builder("rows").with_fields(fields).build().on("describe", path)?;
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let unfinished = path.with_extension("tmp");
    let file = File::create(&unfinished).on("create", &unfinished)?;
    let mut writer =
        SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties)).on("write", &unfinished)?;
    let mut group = writer.next_row_group().on("write", &unfinished)?;
    for column in &COLUMNS {
        let mut target =
            group.next_column().on("write", &unfinished)?.expect("the file has as many columns as its schema");
        match column {
            Column::Count(_, get) => {
                let values: Vec<i64> = rows.iter().map(|row| get(row) as i64).collect();
                target.typed::<Int64Type>().write_batch(&values, None, None).on("write", &unfinished)?;
            }
            Column::Number(_, get) => {
                let values: Vec<f64> = rows.iter().filter_map(get).collect();
                let present = presence(rows, |row| get(row).is_some());
                target.typed::<DoubleType>().write_batch(&values, Some(&present), None).on("write", &unfinished)?;
            }
            Column::Text(_, get) => {
                let values: Vec<ByteArray> = rows.iter().filter_map(|row| get(row).map(ByteArray::from)).collect();
                let present = presence(rows, |row| get(row).is_some());
                target.typed::<ByteArrayType>().write_batch(&values, Some(&present), None).on("write", &unfinished)?;
            }
        }
        target.close().on("write", &unfinished)?;
    }
    group.close().on("write", &unfinished)?;
    writer.close().on("finish", &unfinished)?;
    std::fs::rename(&unfinished, path).on("finish", path)
}

fn presence(rows: &[Row], present: impl Fn(&Row) -> bool) -> Vec<i16> {
    rows.iter().map(|row| i16::from(present(row))).collect()
}

/// Reads the rows of a finished study.
pub fn read(path: &Path) -> Result<Vec<Row>, Failure> {
    let file = File::open(path).map_err(|error| {
        Failure::input(format!("failed to open {}: {error}; give the folder of a finished study", path.display()))
    })?;
    let reader = SerializedFileReader::new(file).on("read", path)?;
    let mut rows = Vec::new();
    for record in reader.get_row_iter(None).on("read", path)? {
        let record = record.on("read", path)?;
        let mut row = Row::default();
        let mut ends: [[Option<f64>; 2]; 3] = Default::default();
        for (name, field) in record.get_column_iter() {
            let number = if let Field::Double(value) = field { Some(*value) } else { None };
            let text = if let Field::Str(value) = field { Some(value.clone()) } else { None };
            let count = if let Field::Long(value) = field { *value as u64 } else { 0 };
            match name.as_str() {
                "cell" => row.cell = count,
                "replicate" => row.replicate = count,
                "method" => row.method = text.unwrap_or_default(),
                "failure" => row.reason = text,
                "true_K_per_s" => row.true_k_per_s = number,
                "true_T_s" => row.true_t_s = number,
                "K_per_s" => row.k_per_s = number,
                "K_lower95_per_s" => ends[0][0] = number,
                "K_upper95_per_s" => ends[0][1] = number,
                "T_s" => row.t_s = number,
                "T_lower95_s" => ends[1][0] = number,
                "T_upper95_s" => ends[1][1] = number,
                "delta_r_deg" => row.rudder_bias_deg = number,
                "delta_r_lower95_deg" => ends[2][0] = number,
                "delta_r_upper95_deg" => ends[2][1] = number,
                "heading_rmse_deg" => row.heading_rmse_deg = number,
                "evaluations" => row.evaluations = number.map(|count| count as u64),
                "stop" => row.stop = text,
                _ => {}
            }
        }
        let interval = |ends: [Option<f64>; 2]| ends[0].zip(ends[1]).map(|(lo, hi)| [lo, hi]);
        (row.k_ci95_per_s, row.t_ci95_s, row.rudder_bias_ci95_deg) =
            (interval(ends[0]), interval(ends[1]), interval(ends[2]));
        rows.push(row);
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_back_as_they_went() {
        let good = Row {
            cell: 3,
            replicate: 7,
            method: "output-error".into(),
            true_k_per_s: Some(0.1),
            true_t_s: Some(16.3),
            k_per_s: Some(0.1001),
            k_ci95_per_s: Some([0.0999, 0.1003]),
            t_s: Some(16.31),
            rudder_bias_deg: Some(-0.2),
            heading_rmse_deg: Some(0.1),
            evaluations: Some(90),
            stop: Some("converged".into()),
            ..Row::default()
        };
        let failed =
            Row { cell: 3, replicate: 8, method: "srivc".into(), reason: Some("not excited".into()), ..Row::default() };
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("rows.parquet");
        let rows = vec![good, failed];
        write(&path, &rows).expect("written");
        assert_eq!(read(&path).expect("read"), rows);
        let bytes = std::fs::read(&path).expect("read");
        write(&path, &rows).expect("written");
        assert_eq!(bytes, std::fs::read(&path).expect("read"), "same rows, same bytes");
    }
}
