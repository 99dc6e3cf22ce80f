//! Traces of effects that a first-order response lacks.

use std::path::{Path, PathBuf};

use trace::{Settings, trace};
use trial::Trial;

use crate::records::{first_order_zig_zag, record};
use crate::work::{Reach, Work, WorkGroup};

/// Zig-zags of KVLCC2, HSVA: first the records that are fitted together, then the held-out records.
const HSVA: [&str; 8] = [
    "zigzag_20_10_s",
    "zigzag_10_10_s",
    "zigzag_15_05",
    "zigzag_35_05",
    "zigzag_30_05",
    "zigzag_20_05",
    "zigzag_10_05",
    "zigzag_05_01",
];

/// Maximum time for all eight records, each left out in turn, relative to a single record.
const MAX_TIME_OF_EIGHT: f64 = 13.0;

/// Number of records of [`HSVA`] that are fitted together while the remaining records are held out.
const TOGETHER: usize = 3;

/// Measured records of a folder, which are not part of the project; `None`, and one line on standard error, if a record
/// is missing. They are read from the folder named by the environment variable `KEMPF_DATA`, or else from the shared
/// folder next to the project.
///
/// # Panics
/// If a record exists and cannot be read.
fn measured(folder: &str, names: &[&str]) -> Option<Vec<Trial>> {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let data = std::env::var_os("KEMPF_DATA").map_or_else(|| project.join("../../shared/data"), PathBuf::from);
    let sidecar = project.join(format!("../scenarios/measured/{folder}.trial.toml"));
    let read = |name: &&str| {
        let path = data.join(folder).join(format!("{name}.csv"));
        if !path.is_file() {
            eprintln!("skipped: no measured record {folder}/{name}.csv; set KEMPF_DATA to the folder that holds it");
            return None;
        }
        let reading = trial::read_with_sidecar(&path, Some(&sidecar));
        Some(reading.unwrap_or_else(|error| panic!("{}: {error}", path.display())).trial)
    };
    names.iter().map(read).collect()
}

/// Benchmarks of complete traces of a simulated record and of measured records.
pub fn tracing() -> WorkGroup {
    let mut group = WorkGroup::new(
        "trace",
        "Tracing",
        "Whole traces with bands and the errors of restarted replays, on one core: a simulated record that lacks nothing, and \
         measured zig-zags of KVLCC2 where they are at hand; and of the first the search for moments of a shape alone.",
    );
    let whole = |name: &str, trials: Vec<Trial>, held_out: Vec<Trial>| {
        let settings = Settings::default();
        Work::new(name, move || trace(&trials, &held_out, &settings).is_ok()).slow()
    };
    let clean = record(&first_order_zig_zag(400));
    let shapes = trace(std::slice::from_ref(&clean), &[], &Settings::default()).expect("a base");
    let stage = Work::new("moments of a shape alone, 400 rows", move || shapes.shapes().is_some()).slow();
    let clean = group.alone(whole("one record, nothing missing, 400 rows", vec![clean], Vec::new()), None);
    group.beside(stage, &clean, None);
    if let Some(marin) = measured("kvlcc2_marin", &["zigzag_10"]) {
        group.alone(whole("one record, MARIN, 961 rows", marin, Vec::new()), None);
    }
    if let Some(all) = measured("kvlcc2_hsva", &HSVA) {
        let (fitted, others) = all.split_at(TOGETHER);
        let single = vec![fitted[0].clone()];
        let single = group.alone(whole("one record, HSVA, 1901 rows", single, Vec::new()), None);
        let three = whole("three records, HSVA, five held out", fitted.to_vec(), others.to_vec());
        group.beside(three, &single, None);
        let eight = whole("eight records, HSVA, each left out in turn", all, Vec::new());
        group.beside(eight, &single, Some(Reach::Ratio(MAX_TIME_OF_EIGHT)));
    }
    group
}
