//! Where measured records are looked for. They are not part of the project, because their licences do not allow it; a
//! test that needs one says in one line that it was skipped.

use std::path::PathBuf;

use trial::Trial;

/// The measured record `relative` ("kvlcc2_hsva/zigzag_20_10_s.csv"), from the folder named by the environment variable
/// `TRIAL_DATA` or else from the shared folder beside the project; `None`, and one line on standard error, when it is
/// not there.
///
/// # Panics
/// When the record is there and cannot be read: that is a failure of the reader, not a missing file.
pub fn record(relative: &str) -> Option<Trial> {
    let path = folder().join(relative);
    if !path.is_file() {
        eprintln!("skipped: no measured record {relative}; set TRIAL_DATA to the folder that holds it");
        return None;
    }
    let reading = trial::read(&path).unwrap_or_else(|error| panic!("{relative} is there but cannot be read: {error}"));
    Some(reading.trial)
}

/// The folder that holds the measured records, whether it is there or not.
pub fn folder() -> PathBuf {
    std::env::var_os("TRIAL_DATA")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/data"), PathBuf::from)
}
