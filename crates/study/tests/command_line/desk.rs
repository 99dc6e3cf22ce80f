//! Runs of the program as a user makes them: a temporary folder, the exit code and the output.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use bytes::Bytes;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use sha2::{Digest, Sha256};
use ship::Ship;
use ship::angle::{from_deg, to_deg};
use simulate::{Manoeuvre, Recording, SimulatedShip, Simulation, SteeringGear, StreamKey};

use crate::schemas;

/// Temporary folder in which the program runs.
pub struct Desk {
    folder: tempfile::TempDir,
}

/// Result of a run.
pub struct Run {
    /// Exit code.
    pub code: Option<i32>,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

impl Desk {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a temporary folder") }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file and returns its name.
    pub fn file<'a>(&self, name: &'a str, content: impl AsRef<[u8]>) -> &'a str {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("inside the folder")).expect("a folder");
        std::fs::write(path, content).expect("a file");
        name
    }

    /// Runs the program to its end. `fit`, `trace` and `predict` draw no figures without `--figures`: drawing takes
    /// most of their time.
    pub fn run(&self, arguments: &[&str]) -> Run {
        self.draw(&undrawn(arguments))
    }

    /// Runs the program to its end, with its default figures. After success it validates all documents in the folder by
    /// their schemas.
    pub fn draw(&self, arguments: &[&str]) -> Run {
        let run = Run::of(self.command(arguments).output().expect("the program starts"));
        if run.code == Some(0) {
            schemas::hold_below(self.folder.path());
        }
        run
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_study"));
        command.args(arguments).current_dir(self.folder.path());
        command
    }

    /// As [`Self::run`] with a text on standard input, without the validation of documents.
    pub fn run_with_input(&self, arguments: &[&str], input: impl AsRef<[u8]>) -> Run {
        let mut command = self.command(&undrawn(arguments));
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the program starts");
        // The program may end before it has read the whole input; the write then fails.
        let _ = child.stdin.take().expect("it is piped").write_all(input.as_ref());
        Run::of(child.wait_with_output().expect("it ends"))
    }

    /// Starts the program and does not wait for it.
    pub fn start(&self, arguments: &[&str]) -> Child {
        self.command(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program starts")
    }

    /// Starts the program and waits until `holds` returns `true`. Panics if the program ends earlier.
    pub fn start_until(&self, arguments: &[&str], mut holds: impl FnMut() -> bool) -> Child {
        let mut run = self.start(arguments);
        while !holds() {
            assert!(run.try_wait().expect("it can be asked").is_none(), "it ended too early: {arguments:?}");
            std::thread::sleep(Duration::from_millis(5));
        }
        run
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn text(&self, name: &str) -> String {
        String::from_utf8(self.bytes(name)).expect("UTF-8")
    }

    /// Rows of a Parquet file, their cells by column name.
    pub fn rows(&self, name: &str) -> Vec<BTreeMap<String, Field>> {
        let file = SerializedFileReader::new(Bytes::from(self.bytes(name))).expect("a Parquet file");
        let rows = file.get_row_iter(None).expect("rows").map(|row| row.expect("a row").into_columns());
        rows.map(|row| row.into_iter().collect()).collect()
    }

    pub fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_slice(&self.bytes(name)).expect("JSON")
    }
}

/// Number in a column of a Parquet row. Panics if it is no number.
pub fn number(row: &BTreeMap<String, Field>, name: &str) -> f64 {
    match row[name] {
        Field::Double(value) => value,
        ref other => panic!("{name}: {other:?}"),
    }
}

/// Arguments with `--figures none` added for `fit`, `trace` and `predict`, unless they have `--figures`.
fn undrawn<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    let can_be_told = ["fit", "trace", "predict"].iter().any(|command| arguments.first() == Some(command));
    let told: &[&str] = if can_be_told && !arguments.contains(&"--figures") { &["--figures", "none"] } else { &[] };
    [arguments, told].concat()
}

/// Interrupts a run as Ctrl-C does; returns its result, and the time until it ended.
pub fn interrupted(run: Child) -> (Run, Duration) {
    let asked = Instant::now();
    let sent = Command::new("kill").args(["-INT", &run.id().to_string()]).status().expect("a Unix system has kill");
    assert!(sent.success());
    (Run::of(run.wait_with_output().expect("it ends")), asked.elapsed())
}

impl Run {
    pub fn of(Output { status, stdout, stderr }: Output) -> Self {
        let [out, err] = [stdout, stderr].map(|text| String::from_utf8(text).expect("UTF-8"));
        Self { code: status.code(), out, err }
    }

    /// Asserts that the exit code is 0.
    pub fn is_done(&self) -> &Self {
        assert_eq!(self.code, Some(0), "{}\n{}", self.out, self.err);
        self
    }

    /// Asserts that the exit code is `code`, standard output is empty, and the only message contains all `parts`.
    pub fn is_refused(&self, code: i32, parts: &[&str]) {
        assert_eq!(self.code, Some(code), "{}\n{}", self.out, self.err);
        assert_eq!(self.out, "", "an error is no result");
        let messages = self.err.lines().filter(|line| line.starts_with("error")).count();
        assert!(self.err.starts_with("error: ") && messages == 1, "one message expected:\n{}", self.err);
        assert!(!self.err.contains("panicked") && !self.err.contains("RUST_BACKTRACE"), "{}", self.err);
        for part in parts {
            assert!(self.err.contains(part), "{part:?} is not in the message:\n{}", self.err);
        }
    }
}

/// A 10/10 zig-zag of YUKUN as a CSV record of time, heading and rudder: 300 s at 1 Hz, perfect instruments, rudder
/// rate 2.5 deg/s.
pub fn zig_zag_csv() -> String {
    zig_zag_csv_of(&ship::ships::find_ship("yukun").expect("it is in the registry"))
}

/// As [`zig_zag_csv`], of another ship.
pub fn zig_zag_csv_of(ship: &Ship) -> String {
    let manoeuvre = Manoeuvre::zig_zag(from_deg(10.0), from_deg(10.0));
    let simulation = Simulation {
        gear: SteeringGear::with_rate(from_deg(2.5)),
        recording: Recording { sampling_period: 1.0, duration: Some(300.0), ..Recording::default() },
        ..Simulation::new(SimulatedShip::from_ship(ship), manoeuvre)
    };
    let simulated = simulation.run(&StreamKey { seed: 1, cell: 0, replicate: 0 }).expect("a plain zig-zag");
    let trial = &simulated.trial;
    let rows = trial.time().iter().zip(trial.heading()).zip(trial.rudder());
    let rows = rows.map(|((t, psi), delta)| format!("{t},{},{}\n", to_deg(*psi), to_deg(*delta)));
    ["t_s,heading_deg,rudder_deg\n".to_owned()].into_iter().chain(rows).collect()
}

/// Record with a changed column; `change` gets the number of the row, from 0, and the value.
pub fn with_column(csv: &str, name: &str, change: impl Fn(usize, f64) -> String) -> String {
    let header = csv.lines().next().expect("a header");
    let place = header.split(',').position(|column| column == name).expect("the column is there");
    let rows = csv.lines().skip(1).enumerate().map(|(row, line)| {
        let cells = line.split(',').enumerate().map(|(column, cell)| match column == place {
            true => change(row, cell.parse().expect("a number")),
            false => cell.to_owned(),
        });
        cells.collect::<Vec<String>>().join(",")
    });
    [header.to_owned()].into_iter().chain(rows).map(|line| line + "\n").collect()
}

/// Folder of measured records, `KEMPF_DATA` or its default; `None` if it is missing, after a message that the test is
/// skipped.
pub fn measured() -> Option<PathBuf> {
    let folder = std::env::var_os("KEMPF_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    if folder.is_dir() {
        return folder.canonicalize().ok();
    }
    println!("skipped: no measured records at {}", folder.display());
    None
}

/// Copies a folder with all its content.
pub fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(from).expect("it is there").flatten() {
        let target = to.join(entry.file_name());
        match entry.path().is_dir() {
            true => copy(&entry.path(), &target),
            false => drop(std::fs::copy(entry.path(), target).expect("a copy")),
        }
    }
}

/// Path of a file or folder of the repository, from its path below the root.
pub fn of_repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// SHA-256 of bytes, hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    campaign::scenario::hex_digits(&Sha256::digest(bytes))
}
