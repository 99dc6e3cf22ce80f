//! Location of measured records. They are not part of the project, because their licences do not allow it; a test that
//! requires a missing record reports in one line that it was skipped.

use std::path::PathBuf;

use trial::channel::parse_column_name;
use trial::{Columns, Trial};

/// Measured record `relative` ("kvlcc2_hsva/zigzag_20_10_s.csv"), from the folder named by the environment variable
/// `KEMPF_DATA` or else from the shared folder next to the project; `None`, and one line on standard error, if it is
/// missing.
///
/// # Panics
/// If the record exists and cannot be read: a failure of the reader, not a missing file.
pub fn record(relative: &str) -> Option<Trial> {
    let path = place(relative)?;
    let reading = trial::read(&path).unwrap_or_else(|error| panic!("{relative} is there but cannot be read: {error}"));
    Some(reading.trial)
}

/// Path of a measured record; `None` (and one line) if it is missing.
pub fn place(relative: &str) -> Option<PathBuf> {
    let path = folder().join(relative);
    if !path.is_file() {
        eprintln!("skipped: no measured record {relative}; set KEMPF_DATA to the folder that holds it");
        return None;
    }
    Some(path)
}

/// Columns of a measured record as in its file, uncleaned; `None` (and one line) if it is missing.
///
/// # Panics
/// If the file is not a table of numbers.
pub fn columns(file: &str) -> Option<Columns> {
    let path = place(file)?;
    let mut table = csv::Reader::from_path(path).expect("a readable file");
    let names = table.headers().expect("a header").clone();
    let rows: Vec<csv::StringRecord> = table.records().map(|row| row.expect("a row")).collect();
    let values = |place: usize| rows.iter().map(move |row| row[place].parse::<f64>().unwrap_or(f64::NAN));
    let mut columns = Columns::default();
    for (place, name) in names.iter().enumerate() {
        match parse_column_name(name) {
            _ if name == "t_s" => columns.time = values(place).collect(),
            Some((channel, unit)) => {
                columns.channels.insert(channel, values(place).map(|value| value * unit.si_factor()).collect());
            }
            None => {}
        }
    }
    Some(columns)
}

/// Folder of the measured records, existing or not.
pub fn folder() -> PathBuf {
    std::env::var_os("KEMPF_DATA")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data"), PathBuf::from)
}
