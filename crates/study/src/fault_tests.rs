//! Fault injection: every file operation of a study, a report and a rerun fails once. The repeated command then ends
//! with the same bytes as one without a fault.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::commands::report::{self, ReportRequest};
use crate::options::{CommonOptions, FigureChoice, FigureOptions, Format, StudyFigureOptions};
use campaign::NoObserver;
use campaign::collect::{collect, collect_shard};
use campaign::disk::faults;
use campaign::failure::Failure;
use campaign::files::{MANIFEST_FILE, ROWS_FOLDER, TIMINGS_FILE, TIMINGS_FOLDER};
use campaign::folder::ResultFolder;
use campaign::scenario::Scenario;
use campaign::shard::Shard;

const TEXT: &str = r#"
question = "Is anything lost?"
seed = 5
replicates = 3
ship.yukun = {}
manoeuvre.zig-zag = { rudder-deg = 10.0, heading-deg = 10.0 }
recording = { sampling-s = 4.0, duration-s = 120.0 }
output.figure = "errors"
[[identifier]]
method.integral-least-squares = {}
[[sweep]]
key = "sensor.heading-noise-deg"
values = [0.1, 0.5]
"#;

fn scenario(more: &str) -> Scenario {
    Scenario::parse(Path::new("s.toml"), "s", format!("{more}{TEXT}"), None)
        .unwrap_or_else(|failure| panic!("{failure}"))
}

fn quiet(out: Option<&Path>) -> CommonOptions {
    CommonOptions { out: out.map(Path::to_owned), threads: None, seed: None, quiet: true, format: Format::Text }
}

/// One small figure, which takes little time.
const STYLE: StudyFigureOptions = StudyFigureOptions {
    style: FigureOptions { paper: Some(60.0), dpi: 72.0, style: None },
    figures: FigureChoice::Key,
};

fn report_of(folder: &Path) -> ReportRequest {
    ReportRequest { folders: vec![folder.to_owned()], open: false, style: STYLE }
}

/// Runs a scenario into a folder.
fn run(scenario: &Scenario, folder: &Path) -> Result<(), Failure> {
    collect(scenario, &ResultFolder::make(folder)?, false, &NoObserver).map(drop)
}

/// All files below a folder with their bytes, except run times, which differ from run to run.
fn content(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        match path.is_dir() {
            true if name == TIMINGS_FOLDER => {}
            true => files.extend(content(&path)),
            false if [TIMINGS_FILE, MANIFEST_FILE].contains(&name.as_str()) => {}
            false => files.push((PathBuf::from(name), fs::read(path).expect("a file"))),
        }
    }
    files.sort();
    files
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder").flatten() {
        match entry.path().is_dir() {
            true => copy(&entry.path(), &to.join(entry.file_name())),
            false => drop(fs::copy(entry.path(), to.join(entry.file_name())).expect("copied")),
        }
    }
}

/// Number of threads that inject faults.
const THREADS: u64 = 4;

/// Lets every operation of `work` fail once alone and once with all later ones, each time in a copy of `before`, or in
/// an empty folder if that is `None`. A repetition has to end with the same bytes as the work without a fault. Returns
/// the number of operations.
fn fail_each(before: Option<&Path>, work: impl Fn(&Path) -> Result<(), Failure> + Sync) -> u64 {
    let desk = tempfile::tempdir().expect("a temporary folder");
    let place = |name: &str| -> PathBuf {
        let folder = desk.path().join(name).join("out");
        match before {
            Some(before) => copy(before, &folder),
            None => fs::create_dir_all(&folder).expect("a folder"),
        }
        folder
    };
    let whole = place("whole");
    let counted = faults::arm(whole.parent().expect("a folder"), 0..0);
    work(&whole).unwrap_or_else(|failure| panic!("without a fault: {failure}"));
    let operations = counted.seen();
    drop(counted);
    let expected = content(&whole);
    let fail = |number: u64, name: &str, failing: Range<u64>| {
        let folder = place(&format!("{name}-{number}"));
        let armed = faults::arm(folder.parent().expect("a folder"), failing);
        let outcome = work(&folder);
        drop(armed);
        if let Err(failure) = &outcome {
            assert!(failure.message.contains("fault "), "{name} {number}: {failure}");
        }
        if let Err(failure) = work(&folder) {
            panic!("{name} {number}, which ended with {outcome:?}: {failure}");
        }
        assert!(content(&folder) == expected, "{name} {number}, which ended with {outcome:?}");
        fs::remove_dir_all(folder).expect("it was there");
    };
    // On separate threads: the threads that run the trials would deadlock if they ran this work.
    std::thread::scope(|scope| {
        for first in 0..THREADS {
            let fail = &fail;
            scope.spawn(move || {
                for number in (first..operations).step_by(THREADS as usize) {
                    fail(number, "once", number..number + 1);
                    fail(number, "gone", number..u64::MAX);
                }
            });
        }
    });
    operations
}

#[test]
fn no_fault_of_the_disk_loses_anything_of_a_study() {
    let desk = tempfile::tempdir().expect("a temporary folder");
    let (study, with_finding) = (scenario(""), scenario("finding = \"No.\"\n"));
    assert!(fail_each(None, |folder| run(&study, folder)) > 50);
    // A rerun with changed texts.
    let whole = desk.path().join("whole");
    run(&study, &whole).unwrap_or_else(|failure| panic!("{failure}"));
    assert!(fail_each(Some(&whole), |folder| run(&with_finding, folder)) > 20);
}

#[test]
fn no_fault_of_the_disk_loses_anything_of_a_report() {
    let desk = tempfile::tempdir().expect("a temporary folder");
    let whole = desk.path().join("whole");
    run(&scenario(""), &whole).unwrap_or_else(|failure| panic!("{failure}"));
    assert!(fail_each(Some(&whole), |folder| report::run(&report_of(folder), &quiet(None))) > 50);
}

/// Every file operation fails once while the blocks of shards are merged into a study.
#[test]
fn no_fault_of_the_disk_loses_anything_of_shards() {
    let desk = tempfile::tempdir().expect("a temporary folder");
    let (study, shards) = (scenario(""), desk.path().join("shards"));
    for number in 1..=2 {
        ResultFolder::make(&shards)
            .and_then(|folder| collect_shard(&study, Shard { number, count: 2 }, &folder, false, &NoObserver))
            .unwrap_or_else(|failure| panic!("{failure}"));
    }
    assert!(fail_each(Some(&shards), |folder| report::run(&report_of(folder), &quiet(None))) > 50);
}

/// A complete block survives any failure while its study continues.
#[test]
fn no_fault_of_the_disk_loses_a_block() {
    let desk = tempfile::tempdir().expect("a temporary folder");
    let (study, begun) = (scenario(""), desk.path().join("begun"));
    ResultFolder::make(&begun)
        .and_then(|folder| collect_shard(&study, Shard { number: 1, count: 2 }, &folder, false, &NoObserver))
        .unwrap_or_else(|failure| panic!("{failure}"));
    let first = |folder: &Path| fs::read(folder.join(ROWS_FOLDER).join("0000-0000.parquet")).ok();
    let bytes = first(&begun);
    assert!(bytes.is_some());
    let go_on = |folder: &Path| {
        let outcome = run(&study, folder);
        assert!(first(folder) == bytes, "a block is gone: {outcome:?}");
        outcome
    };
    assert!(fail_each(Some(&begun), go_on) > 20);
}
