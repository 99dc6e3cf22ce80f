//! Where measured records are looked for. They are not part of the project, because their licences do not allow it; a
//! test that needs one says in one line that it was skipped. [`sets`] says which records belong together, [`tracing`]
//! traces them, [`analysis`] sums up what was found, [`charts`] draws it.

pub mod analysis;
pub mod charts;
pub mod sets;
pub mod tracing;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use trial::channel::column;
use trial::{Columns, Trial};

/// The measured record `relative` ("kvlcc2_hsva/zigzag_20_10_s.csv"), from the folder named by the environment variable
/// `TRIAL_DATA` or else from the shared folder beside the project; `None`, and one line on standard error, when it is
/// not there.
///
/// # Panics
/// When the record is there and cannot be read: that is a failure of the reader, not a missing file.
pub fn record(relative: &str) -> Option<Trial> {
    let path = place(relative)?;
    let reading = trial::read(&path).unwrap_or_else(|error| panic!("{relative} is there but cannot be read: {error}"));
    Some(reading.trial)
}

/// Where a measured record is; `None` (and one line) where it is not there.
fn place(relative: &str) -> Option<PathBuf> {
    let path = folder().join(relative);
    if !path.is_file() {
        eprintln!("skipped: no measured record {relative}; set TRIAL_DATA to the folder that holds it");
        return None;
    }
    Some(path)
}

/// The columns of a measured record as they stand in its file, uncleaned; `None` (and one line) where it is not there.
///
/// # Panics
/// When the file is no table of numbers.
pub fn columns(file: &str) -> Option<Columns> {
    let path = place(file)?;
    let mut table = csv::Reader::from_path(path).expect("a readable file");
    let names = table.headers().expect("a header").clone();
    let rows: Vec<csv::StringRecord> = table.records().map(|row| row.expect("a row")).collect();
    let values = |place: usize| rows.iter().map(move |row| row[place].parse::<f64>().unwrap_or(f64::NAN));
    let mut columns = Columns::default();
    for (place, name) in names.iter().enumerate() {
        match column(name) {
            _ if name == "t_s" => columns.time = values(place).collect(),
            Some((channel, unit)) => {
                columns.channels.insert(channel, values(place).map(|value| value * unit.to_si()).collect());
            }
            None => {}
        }
    }
    Some(columns)
}

/// The folder that holds the measured records, whether it is there or not.
pub fn folder() -> PathBuf {
    std::env::var_os("TRIAL_DATA")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data"), PathBuf::from)
}

/// Runs a program that works on the measured records and writes into the folder that is its only argument.
pub fn into_results(usual: &str, run: fn(&Path) -> sets::Outcome<()>) -> ExitCode {
    let Some(results) = std::env::args_os().nth(1).filter(|own| own != "--help").map(PathBuf::from) else {
        eprintln!("give the folder of the results, for instance {usual}");
        return ExitCode::from(2);
    };
    if !folder().is_dir() {
        eprintln!("there are no measured records in {}; set TRIAL_DATA to their folder", folder().display());
        return ExitCode::from(2);
    }
    match run(&results) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
