//! Targets, one function per format: checks of the results for given bytes. Each returns `true` if the file was
//! accepted.

use std::cell::OnceCell;
use std::path::{Component, Path};
use std::sync::LazyLock;

use campaign::design::Design;
use campaign::failure::Failure;
use campaign::files;
use campaign::manifest::Manifest;
use campaign::rows::{BlockFileError, BlockLabel, RowLayout, decode};
use campaign::scenario::Scenario;
use campaign::summary::Tally;
use identify::{Identifier, registry};
use ship::effects::{self, Effect, Formula, OperatingPoint};
use ship::{EffectReal, MeasuredChannels, Tangent};
use study::screen;
use study::views::tables;
use tempfile::TempDir;
use trial::clock::{StampConverter, TimeStamp};
use trial::reader::{self, ReadRecord};
use trial::sidecar::Sidecar;
use trial::{Channel, Trial};

use super::seeds;

/// Maximum length of a message, bytes: a few lines of a file and the advice.
const LONGEST_MESSAGE: usize = 8192;

/// Maximum number of rows of a record for the methods; more rows only take more time.
const IDENTIFIED_ROWS: usize = 300;

/// Maximum number of cells and of trials of an accepted scenario.
const MOST: u64 = 1_000_000_000;

/// Line between a sidecar and its table.
const TABLE: &str = "\n# table\n";

/// Table for sidecars without one: names of the contract and other names.
const PLAIN_TABLE: &str = include_str!("../../fuzz/corpus/record/plain.csv");

static METHODS: LazyLock<Vec<Box<dyn Identifier>>> = LazyLock::new(|| {
    registry::default_settings().iter().map(|settings| settings.build().expect("default settings are valid")).collect()
});

/// Target of a measured record, read by its header alone and passed to every method.
pub fn record(data: &[u8]) -> bool {
    let name = Path::new("case.csv");
    match reader::read_from_reader(name, data, Some(data.len() as u64), None) {
        Ok(reading) => {
            is_a_reading(&reading);
            identified(&reading.trial);
            true
        }
        Err(error) => is_one_message(&error.to_string()),
    }
}

fn read(name: &str, data: &[u8]) -> Result<ReadRecord, reader::ReadError> {
    reader::read_from_reader(Path::new(name), data, None, None)
}

/// Target of a log of sentences.
pub fn nmea(data: &[u8]) -> bool {
    match read("case.nmea", data) {
        Ok(reading) => {
            is_a_reading(&reading);
            true
        }
        Err(error) => is_one_message(&error.to_string()),
    }
}

/// Target of a packed record; other bytes are packed first, and must give the reading of the unpacked bytes.
pub fn gzip(data: &[u8]) -> bool {
    if data.starts_with(&[0x1f, 0x8b]) {
        return nmea(data);
    }
    match (read("case", data), read("case", &crate::logs::tables::packed(data))) {
        (Ok(plain), Ok(packed)) => {
            is_a_reading(&packed);
            assert_eq!(plain.trial.time(), packed.trial.time(), "time of a packed record");
            assert_eq!(plain.trial.rudder(), packed.trial.rudder(), "rudder of a packed record");
            assert_eq!(plain.warnings, packed.warnings, "warnings of a packed record");
            true
        }
        (Err(plain), Err(packed)) => {
            assert_eq!(plain.to_string(), packed.to_string(), "the message about a packed record");
            is_one_message(&packed.to_string())
        }
        (plain, _) => {
            panic!("a record is {} as it is, and packed it is not", if plain.is_ok() { "read" } else { "refused" })
        }
    }
}

/// Target of time stamps, one a line, on one clock.
pub fn stamp(data: &[u8]) -> bool {
    let text = String::from_utf8_lossy(data);
    let mut stamps = StampConverter::default();
    let mut read = false;
    for line in text.lines() {
        let Some(stamp) = TimeStamp::parse(line) else { continue };
        assert!(stamp.has_time() || stamp.has_date(), "a stamp of nothing");
        let Ok(seconds) = stamps.seconds(stamp) else { continue };
        assert!(seconds.is_finite(), "a time that is not finite");
        assert_eq!(stamps.seconds(stamp), Ok(seconds), "one stamp at two times");
        let clock = stamps.clock().expect("a stamp was read");
        assert_eq!(clock.time_of_day_at(seconds).len(), 8, "a time of day");
        assert!(clock.date_at(seconds).is_none_or(|date| date.len() <= 32), "a date");
        assert!(clock.record_time(&stamp).is_none_or(f64::is_finite), "a time that is not finite");
        read = true;
    }
    read
}

/// Target of the search for manoeuvres in a record.
pub fn find(data: &[u8]) -> bool {
    let Ok(ReadRecord { trial, .. }) = read("case.csv", data) else { return false };
    let found = trial::find::detect_manoeuvres(&trial::find::LogSignals {
        time: trial.time(),
        rudder: trial.rudder(),
        heading: trial.heading(),
        speed: trial.channel(Channel::Speed),
        propeller_rate: trial.channel(Channel::PropellerRate),
    });
    let (first, last) = (trial.time()[0], trial.time()[trial.len() - 1]);
    for manoeuvre in &found {
        assert!(
            first <= manoeuvre.start_time && manoeuvre.start_time < manoeuvre.end_time && manoeuvre.end_time <= last,
            "{manoeuvre:?}"
        );
        assert!((manoeuvre.start_time..=manoeuvre.end_time).contains(&manoeuvre.first_execute_time), "{manoeuvre:?}");
    }
    assert!(found.is_sorted_by(|one, next| one.start_time < next.start_time), "manoeuvres out of order");
    !found.is_empty()
}

/// Target of a sidecar, followed by the line `# table` and its table; without one, a plain table is used.
pub fn sidecar(data: &[u8]) -> bool {
    let text = String::from_utf8_lossy(data);
    let (text, table) = text.split_once(TABLE).unwrap_or((&text, PLAIN_TABLE));
    let sidecar = match Sidecar::parse(text, Path::new("case.trial.toml")) {
        Ok(sidecar) => sidecar,
        Err(error) => return is_one_message(&error.to_string()),
    };
    match reader::read_from_reader(Path::new("case.dat"), table.as_bytes(), None, Some(&sidecar)) {
        Ok(reading) => {
            is_a_reading(&reading);
            true
        }
        Err(error) => is_one_message(&error.to_string()),
    }
}

/// Target of a scenario, resolved in every cell; no trial is run.
pub fn scenario(data: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(data) else { return false };
    // Records that a scenario replays are searched for in its folder, which does not exist.
    let path = Path::new("no-such-folder/case.toml");
    match Scenario::parse(path, "case", text.to_owned(), None) {
        Ok(scenario) => {
            is_a_scenario(&scenario);
            true
        }
        Err(failure) => is_a_failure(&failure),
    }
}

/// Target of the first block of rows of the small study, summarised.
pub fn rows(data: &[u8]) -> bool {
    summarised(data, &seeds::study().design)
}

/// Target of the stored design, with the rows of the small study.
pub fn cells(data: &[u8]) -> bool {
    static ROWS: LazyLock<Vec<u8>> = LazyLock::new(|| seeds::rows().swap_remove(0));
    match Design::from_json(data) {
        Ok(design) => {
            for cell in &design.cells {
                assert_eq!(cell.labels.len(), design.axes.len(), "labels of a cell and axes");
                assert_eq!(cell.values.len(), design.axes.len(), "values of a cell and axes");
            }
            summarised(&ROWS, &design)
        }
        Err(problem) => is_one_message(&problem),
    }
}

fn summarised(rows: &[u8], design: &Design) -> bool {
    let layout = RowLayout::from_design(design);
    let mut tally = Tally::new(design);
    let manifest = &seeds::study().manifest;
    let (design_sha256, program) = (manifest.design_sha256.clone(), manifest.program_label());
    let label = BlockLabel { design: design_sha256, seed: manifest.seed, program, cell: 0, block: 0 };
    match decode(rows.to_vec(), &label, &layout) {
        Ok(rows) => {
            assert!(rows.iter().all(|row| row.cell == 0 && row.method < design.methods.len()), "rows of the block");
            rows.iter().for_each(|row| tally.add(row));
            let summary = tally.finish();
            drop(tables::brief_summary_table(&summary, design).to_markdown());
            !tables::method_summary_table(&summary.methods, design).to_csv().is_empty()
        }
        Err(BlockFileError::Changed(problem)) => is_one_message(&problem),
        Err(BlockFileError::OtherBlock(other)) => other != label,
    }
}

/// Target of a manifest, compared with another manifest and resolved as the scenario that it contains.
pub fn manifest(data: &[u8]) -> bool {
    scratch(|folder| {
        let path = folder.join(files::MANIFEST_FILE);
        std::fs::write(&path, data).expect("the scratch folder is writable");
        let manifest = match Manifest::read(&path) {
            Ok(manifest) => manifest.expect("it was just written"),
            Err(failure) => return is_a_failure(&failure),
        };
        let own = &seeds::study().manifest;
        for difference in own.differences(&manifest) {
            is_one_message(&difference);
        }
        match Scenario::read(&path, None) {
            Ok(scenario) => {
                is_a_scenario(&scenario);
                true
            }
            Err(failure) => is_a_failure(&failure),
        }
    })
}

fn is_a_failure(failure: &Failure) -> bool {
    is_one_message(&failure.message)
}

/// Assertion of a readable message: not empty, not too long, and without control characters for a terminal.
fn is_one_message(message: &str) -> bool {
    assert!(!message.trim().is_empty(), "an empty message");
    assert!(message.len() <= LONGEST_MESSAGE, "a message of {} bytes", message.len());
    let shown = screen::escaped_lines(message);
    let control = shown.chars().find(|&character| character.is_control() && character != '\n');
    assert!(control.is_none(), "a message with the control character {control:?}");
    false
}

fn is_a_reading(ReadRecord { trial, warnings }: &ReadRecord) {
    for warning in warnings {
        is_one_message(&warning.text);
    }
    assert!(trial.len() >= Trial::MIN_ROWS);
    assert!(trial.time().iter().all(|time| time.is_finite()), "a time that is not finite");
    assert!(trial.time().is_sorted_by(|a, b| a < b), "time does not increase");
    assert!(trial.rudder().iter().all(|rudder| rudder.is_finite()), "a rudder that is not finite");
    let mut present = trial.channels().flat_map(|(_, values)| values);
    assert!(present.all(|value| !value.is_infinite()), "a value that is infinite");
    assert!(trial.heading().iter().filter(|heading| heading.is_finite()).count() >= Trial::MIN_ROWS);
}

/// Target of an effect as a line of text; a valid formula is evaluated at various instants.
pub fn formula(data: &[u8]) -> bool {
    let text = String::from_utf8_lossy(data);
    match effects::parse_formula(&text) {
        Ok(formula) => {
            worked_out(&formula);
            true
        }
        Err(error) => {
            assert!(error.position <= error.text.chars().count(), "a mark beyond the text");
            is_one_message(&error.to_string())
        }
    }
}

/// Assertion that a formula has equal values in plain and in dual numbers, finite or not.
fn worked_out(formula: &Formula) {
    for size in [0.0, -0.3, 1e-12, 7.0, 1e300, f64::NAN] {
        let some = Some(size);
        let measured =
            MeasuredChannels { speed: some, sway: some, wind_speed: some, wind_from: some, propeller_rate: some };
        for measured in [measured, MeasuredChannels::default()] {
            let values = vec![size; formula.parameters().len()];
            let plain = acceleration::<f64>(formula, &values, size, &measured);
            let Tangent { value, .. } = acceleration::<Tangent>(formula, &values, size, &measured);
            assert!(plain == value || plain.is_nan() && value.is_nan(), "{plain} and {value} of one formula");
        }
    }
}

fn acceleration<R: EffectReal>(formula: &Formula, values: &[f64], size: f64, measured: &MeasuredChannels) -> R {
    let (heading, rudder, yaw_rate, one) = (R::from(size), R::from(-size), R::from(size), R::from(1.0));
    let now = OperatingPoint { t: size, heading, yaw_rate, rudder, inverse_T: one, K_over_T: one, measured };
    let values: Vec<R> = values.iter().map(|&value| R::from(value)).collect();
    R::effect_equations(formula).yaw_acceleration(&values, &[], &now)
}

/// Assertion that every method gives an estimate or a reason.
fn identified(trial: &Trial) {
    if trial.len() > IDENTIFIED_ROWS {
        return;
    }
    for method in METHODS.iter() {
        match method.identify(std::slice::from_ref(trial)) {
            Ok(estimate) => {
                // Neutral stability is a regular estimate, with K and T infinite.
                assert!(!estimate.K().value.is_nan() && !estimate.T().value.is_nan(), "no number from {}", method.id());
            }
            Err(error) => {
                is_one_message(&error.to_string());
            }
        }
    }
}

fn is_a_scenario(scenario: &Scenario) {
    let mut name = Path::new(&scenario.name).components();
    assert!(
        matches!((name.next(), name.next()), (Some(Component::Normal(_)), None)),
        "a name that leads out of results/"
    );
    assert!(!scenario.cells.is_empty() && scenario.replicates > 0);
    assert!(scenario.replicates.saturating_mul(scenario.cells.len() as u64) <= MOST);
    for cell in &scenario.cells {
        assert_eq!(cell.labels.len(), scenario.axes.len());
        assert_eq!(cell.values.len(), scenario.axes.len());
        assert!(!cell.methods.is_empty());
        let mut labels = cell.labels.iter().chain(cell.methods.iter().map(|method| &method.label));
        assert!(!labels.any(|label| label.contains(char::is_control)), "a label that no table can carry");
    }
}

/// Result of `work` in a folder of this thread, which is created once.
fn scratch<T>(work: impl FnOnce(&Path) -> T) -> T {
    thread_local! {
        static FOLDER: OnceCell<TempDir> = const { OnceCell::new() };
    }
    FOLDER.with(|folder| {
        let folder: &TempDir = folder.get_or_init(|| tempfile::tempdir().expect("a folder can be made"));
        work(folder.path())
    })
}
