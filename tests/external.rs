//! Outside estimators: a process that is asked trial by trial, and what happens when it does not answer as it should.
//! The estimator of these tests is `src/bin/estimator.rs`.

use std::fs;
use std::path::Path;
use std::sync::Mutex;

use campaign::collect::collect;
use campaign::folder::ResultFolder;
use campaign::rows::StudyRow;
use campaign::store::StoredStudy;
use campaign::task::Shard;
use campaign::{NoObserver, Observer};
use identify::external::{External, Settings, protocol};
use identify::{Identifier, IdentifyError};
use kempf_tests::outside::least_squares;
use kempf_tests::records::Case;
use scenario::Scenario;
use trial::Trial;

const ESTIMATOR: &str = env!("CARGO_BIN_EXE_estimator");

/// The estimator in one of its modes, with a short time to answer.
fn method(arguments: &[&str]) -> External {
    let settings = Settings { timeout_s: 5.0, ..Settings::new([&[ESTIMATOR], arguments].concat()) };
    settings.build(Path::new("")).expect("valid settings")
}

fn record(seed: u64) -> Trial {
    Case { noise_deg: 0.05, ..Case::default() }.trial(seed)
}

fn direct(trial: &Trial) -> [f64; 3] {
    let heading: Vec<Option<f64>> =
        trial.heading().iter().map(|psi| Some(*psi).filter(|psi| psi.is_finite())).collect();
    least_squares(trial.time(), &heading, trial.rudder()).expect("a zig-zag")
}

#[test]
fn an_answer_is_that_of_the_program_to_the_last_bit() {
    let honest = method(&[]);
    let [one, other] = [record(1), record(2)];
    for trial in [&one, &other] {
        let found = honest.identify(std::slice::from_ref(trial)).expect("an answer").response;
        let [k, t, bias] = direct(trial);
        let expected = ship::FirstOrder::from_indices(k, t, bias);
        assert_eq!(found, expected);
        assert!((k / 0.1 - 1.0).abs() < 0.1 && (t / 16.3 - 1.0).abs() < 0.15, "K = {k}, T = {t}");
    }
    // Further records of the same ship come with the first: the program takes the mean.
    let both = honest.identify(&[one.clone(), other.clone()]).expect("an answer").response;
    let mean = 0.5 * (direct(&one)[1] + direct(&other)[1]);
    assert!((both.T() - mean).abs() < 1e-12 * mean, "{} {mean}", both.T());
}

/// The example for users, without noise and with its own standard deviations.
#[test]
fn the_example_finds_the_ship() {
    let settings = Settings::new([env!("CARGO_BIN_EXE_least-squares")]);
    let method = settings.build(Path::new("")).expect("valid settings");
    let clean = method.identify(&[Case::default().trial(0)]).expect("an answer");
    assert!((clean.response.T() / 16.3 - 1.0).abs() < 0.01, "T = {}", clean.response.T());
    let noisy = method.identify(&[record(5)]).expect("an answer");
    let [low, high] = noisy.T().ci95.expect("it gives standard deviations");
    assert!(low < 16.3 && 16.3 < high && high - low < 4.0, "{low} to {high}");
}

#[test]
fn an_estimate_has_the_errors_that_were_given() {
    let found = method(&[]).identify(&[record(3)]).expect("an answer");
    let near = |value: Option<f64>, expected: f64| (value.expect("given") - expected).abs() < 1e-9;
    assert!(near(found.K().sd, 0.01) && near(found.T().sd, 1.5), "{:?} {:?}", found.K(), found.T());
    assert_eq!(found.rudder_bias().sd, None);
    assert_eq!(found.stop.as_str(), "outside");
}

fn refused(arguments: &[&str], timeout_s: f64) -> String {
    let settings = Settings { timeout_s, ..Settings::new([&[ESTIMATOR], arguments].concat()) };
    let method = settings.build(Path::new("")).expect("valid settings");
    let failure = |method: &dyn Identifier| match method.identify(&[record(4)]) {
        Err(IdentifyError::Outside(reason) | IdentifyError::NotStarted(reason)) => reason,
        other => panic!("{arguments:?}: {other:?}"),
    };
    let reason = failure(&method);
    // The next trial gets a new process, whatever became of the last.
    assert_eq!(failure(&method), reason);
    reason
}

#[test]
fn whatever_a_program_does_the_reason_is_told() {
    let silence = "no answer within 0.2 s; after 3 such silences in succession it is asked no more";
    assert_eq!(refused(&["silent"], 0.2), silence);
    assert_eq!(refused(&["deaf"], 0.2), silence);
    assert_eq!(refused(&["dies"], 5.0), "the process ended without an answer (exit status: 7)");
    assert_eq!(refused(&["cut"], 5.0), "the process ended without an answer (exit status: 0)");
    let (number, _) = protocol::question(4, &record(4), &[]);
    assert_eq!(refused(&["nonsense"], 5.0), format!("not JSON: Warning: \\u{{1b}}[31m{number}"));
    assert_eq!(refused(&["endless"], 30.0), "an answer of more than 4194304 bytes");
    let wrong = format!("an answer to trial {} where {number} was asked", number + 1);
    assert_eq!(refused(&["wrong-number"], 5.0), wrong);
    assert_eq!(refused(&["fails", &(number % 7).to_string()], 5.0), "no \\u{7}excitation at all");
    let missing = Settings::new(["no-such-program-here"]).build(Path::new("")).expect("nothing is started");
    let error = missing.identify(&[record(1)]).expect_err("there is no such program").to_string();
    assert!(error.starts_with("outside: not started: "), "{error}");
}

/// The fourth trial is not waited for, and its reason is that of those that were; a study that ends forgets it.
#[test]
fn a_program_that_hangs_is_given_up_after_three_silences() {
    let settings = Settings { timeout_s: 0.4, ..Settings::new([ESTIMATOR, "silent"]) };
    let silent = settings.build(Path::new("")).expect("valid settings");
    let outside = silent.outside().expect("it is another program");
    let ask = || {
        let start = std::time::Instant::now();
        let error = silent.identify(&[record(4)]).expect_err("it does not answer");
        (error.to_string(), start.elapsed().as_secs_f64())
    };
    let first: Vec<(String, f64)> = (0..3).map(|_| ask()).collect();
    assert!(first.iter().all(|(_, seconds)| *seconds >= 0.4), "{first:?}");
    let (reason, seconds) = ask();
    assert!(reason == first[0].0 && seconds < 0.2, "{reason} after {seconds} s");
    let notice = outside.notice().expect("it was given up");
    assert!(notice.contains("silent") && notice.contains("given up"), "{notice}");
    assert_eq!(outside.notice(), None, "it is told once");
    outside.end();
    assert!(ask().1 >= 0.4, "the next study asks again");
}

/// A script that waits for a program is ended with it.
#[cfg(unix)]
#[test]
fn a_time_out_ends_all_that_was_started() {
    let desk = tempfile::tempdir().expect("a folder");
    let pid = desk.path().join("pid");
    let script = format!("sleep 3600 & echo $! > '{}'; wait; true", pid.display());
    let settings = Settings { timeout_s: 1.0, ..Settings::new(["sh", "-c", &script]) };
    let method = settings.build(Path::new("")).expect("valid settings");
    assert!(method.identify(&[record(4)]).expect_err("it does not answer").to_string().contains("within 1 s"));
    let pid = fs::read_to_string(&pid).expect("it was started");
    let is_alive = || {
        // One that has ended may wait for somebody to look.
        let state = std::process::Command::new("ps").args(["-o", "stat=", "-p", pid.trim()]).output().expect("ps");
        !matches!(state.stdout.first(), None | Some(b'Z'))
    };
    let start = std::time::Instant::now();
    while is_alive() {
        assert!(start.elapsed().as_secs() < 10, "the process {pid} was left behind");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
}

/// A record that is longer than the pipe between the two does not make anybody wait for ever.
#[test]
fn a_long_record_is_no_trap() {
    let long = Case { duration_s: 6000.0, period_s: 0.25, ..Case::default() }.trial(0);
    let settings = Settings { timeout_s: 0.3, ..Settings::new([ESTIMATOR, "deaf"]) };
    let deaf = settings.build(Path::new("")).expect("valid settings");
    assert!(deaf.identify(std::slice::from_ref(&long)).expect_err("it does not read").to_string().contains("within"));
    let found = method(&[]).identify(std::slice::from_ref(&long)).expect("an answer").response;
    assert!((found.T() / 16.3 - 1.0).abs() < 0.1, "T = {}", found.T());
}

/// Whether a process that ends after every answer, or tires, or says everything twice, was asked before is not seen.
#[test]
fn what_a_process_did_before_does_not_show() {
    for mode in ["once", "tires", "twice"] {
        let method = method(&[mode]);
        for seed in 0..7 {
            let trial = record(seed);
            let found = method.identify(std::slice::from_ref(&trial)).expect("an answer").response;
            assert_eq!(found.T(), direct(&trial)[1], "{mode} {seed}");
        }
    }
}

fn scenario_of(commands: &[&[&str]], more: &str, path: &Path) -> Scenario {
    let methods: String = commands
        .iter()
        .enumerate()
        .map(|(number, arguments)| {
            let command: Vec<&str> = [&[ESTIMATOR], *arguments].concat();
            format!("[[identifier]]\nlabel = \"mine {number}\"\nmethod.external = {{ command = {command:?}, timeout-s = 2 }}\n")
        })
        .collect();
    let text = format!(
        "question = \"Does it answer?\"\nseed = 9\nreplicates = 12\n[ship.yukun]\n[manoeuvre.zig-zag]\nrudder-deg = 10.0\n\
         heading-deg = 10.0\n[steering-gear]\nrate-deg-s = 2.5\n[recording]\nsampling-s = 2.0\nduration-s = 200.0\n{more}\n\
         [[identifier]]\nmethod.integral-least-squares = {{}}\n{methods}[[sweep]]\nkey = \"sensor.heading-noise-deg\"\nvalues = [0.05, 0.2]\n"
    );
    Scenario::parse(path, "outside", text, None).unwrap_or_else(|failure| panic!("{failure}"))
}

/// Runs a study into a folder on so many threads; returns the bytes of its rows.
fn run(scenario: &Scenario, threads: usize, folder: &Path, observer: &dyn Observer) -> Vec<u8> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let held = ResultFolder::hold(folder).expect("a folder");
    let done = pool.install(|| collect(scenario, Shard::WHOLE, &held, false, observer));
    done.unwrap_or_else(|failure| panic!("{failure}"));
    fs::read(folder.join("rows.parquet")).expect("rows")
}

fn rows(folder: &Path) -> Vec<StudyRow> {
    let mut rows = Vec::new();
    let keep = |row| {
        rows.push(row);
        Ok(())
    };
    StoredStudy::read(folder).and_then(|stored| stored.rows(keep)).unwrap_or_else(|failure| panic!("{failure}"));
    rows
}

/// Stops a study after some trials.
struct Impatient(Mutex<u32>);

impl Observer for Impatient {
    fn advance(&self) {
        *self.0.lock().expect("nobody panics") += 1;
    }

    fn is_asked_to_stop(&self) -> bool {
        *self.0.lock().expect("nobody panics") > 5
    }
}

#[test]
fn rows_do_not_depend_on_threads_or_interruptions() {
    let desk = tempfile::tempdir().expect("a folder");
    let modes: [&[&str]; 5] = [&[], &["dies", "3"], &["nonsense", "4"], &["fails", "5"], &["tires"]];
    let study = scenario_of(&modes, "", &desk.path().join("outside.toml"));
    let one = run(&study, 1, &desk.path().join("one"), &NoObserver);
    let four = run(&study, 4, &desk.path().join("four"), &NoObserver);
    assert!(one == four, "one thread and four give other rows");
    let cut = desk.path().join("cut");
    let held = ResultFolder::hold(&cut).expect("a folder");
    let stopped = collect(&study, Shard::WHOLE, &held, false, &Impatient(Mutex::new(0))).err().expect("it stops");
    assert!(stopped.message.contains("goes on from there"), "{stopped}");
    drop(held);
    assert!(run(&study, 2, &cut, &NoObserver) == one, "an interrupted study gives other rows");
    // Once more, finished as it is: some trials are computed again and found to be the same.
    assert!(run(&study, 2, &cut, &NoObserver) == one);
    let failures: Vec<(u64, u64, usize, String)> = rows(&cut)
        .into_iter()
        .filter_map(|row| Some((row.cell, row.replicate, row.method, row.failure?.into())))
        .collect();
    let mut expected = Vec::new();
    for (cell, replicate) in (0..2).flat_map(|cell| (0_u64..12).map(move |replicate| (cell, replicate))) {
        let number = number(&study, cell, replicate);
        let (method, why) = match number % 7 {
            3 => (2, "the process ended without an answer (exit status: 7)".to_owned()),
            4 => (3, format!("not JSON: Warning: \\u{{1b}}[31m{number}")),
            5 => (4, "no \\u{7}excitation at all".to_owned()),
            _ => continue,
        };
        expected.push((cell as u64, replicate, method, format!("outside: {why}")));
    }
    assert!(expected.len() > 5);
    assert_eq!(failures, expected);
}

/// The number of the question about a trial of a study.
fn number(study: &Scenario, cell: usize, replicate: u64) -> u64 {
    let trials = campaign::engine::simulate(study, campaign::task::Task { cell, replicate }).expect("a record");
    protocol::question(replicate, &trials[0].trial, &[]).0
}

/// The cells of a sweep share processes: the line that an estimator says too often is not taken in the next cell.
#[test]
fn an_answer_to_one_cell_is_never_taken_in_another() {
    let desk = tempfile::tempdir().expect("a folder");
    let mut study = scenario_of(&[&["twice"], &["honest"]], "", &desk.path().join("outside.toml"));
    let text = study.text.replace("replicates = 12", "replicates = 1");
    study = Scenario::parse(&desk.path().join("outside.toml"), "outside", text, None).expect("a scenario");
    let one = run(&study, 1, &desk.path().join("one"), &NoObserver);
    assert!(run(&study, 2, &desk.path().join("two"), &NoObserver) == one, "one thread and two give other rows");
    let rows = rows(&desk.path().join("one"));
    let of = |method: usize| rows.iter().filter(move |row| row.method == method).map(|row| (row.cell, row.t_s));
    assert!(of(1).eq(of(2)), "{rows:?}");
    assert!(rows.iter().all(|row| row.t_s.is_some()), "{rows:?}");
}

/// Rows say what a method makes of a record, and nothing of the machine: a study goes on when the program starts again.
#[cfg(unix)]
#[test]
fn a_program_that_the_system_does_not_start_ends_the_study() {
    use std::os::unix::fs::PermissionsExt;
    let desk = tempfile::tempdir().expect("a folder");
    let program = desk.path().join("mine");
    fs::copy(ESTIMATOR, &program).expect("a program");
    let text = scenario_of(&[&["honest"]], "", &desk.path().join("outside.toml")).text.replace(ESTIMATOR, "./mine");
    let study = Scenario::parse(&desk.path().join("outside.toml"), "outside", text, None).expect("a scenario");
    let may = |mode| fs::set_permissions(&program, fs::Permissions::from_mode(mode)).expect("our own file");
    may(0o600);
    let held = ResultFolder::hold(&desk.path().join("out")).expect("a folder");
    let failure = collect(&study, Shard::WHOLE, &held, false, &NoObserver).err().expect("it does not start");
    assert!(
        failure.message.contains("mine honest` is not started") && failure.message.contains("0 of 24"),
        "{failure}"
    );
    drop(held);
    may(0o700);
    run(&study, 2, &desk.path().join("out"), &NoObserver);
    assert!(rows(&desk.path().join("out")).iter().all(|row| row.failure.is_none()));
}

#[test]
fn further_records_of_a_ship_are_asked_about_together() {
    let desk = tempfile::tempdir().expect("a folder");
    let also = "[[also]]\nmanoeuvre.zig-zag = { rudder-deg = 20.0, heading-deg = 20.0 }";
    let study = scenario_of(&[&[]], also, &desk.path().join("outside.toml"));
    run(&study, 2, &desk.path().join("out"), &NoObserver);
    let task = campaign::task::Task { cell: 1, replicate: 3 };
    let trials = campaign::engine::simulate(&study, task).expect("two records");
    let mean = trials.iter().map(|one| direct(&one.trial)[1]).sum::<f64>() / 2.0;
    let rows = rows(&desk.path().join("out"));
    let row = rows.iter().find(|row| (row.cell, row.replicate, row.method) == (1, 3, 1)).expect("a row");
    assert_eq!(row.t_s, Some(mean));
}

#[test]
fn what_a_program_says_beside_its_answers_is_kept_within_bounds() {
    let desk = tempfile::tempdir().expect("a folder");
    let study = scenario_of(&[&["says"], &["chatters"]], "", &desk.path().join("outside.toml"));
    let folder = desk.path().join("out");
    run(&study, 2, &folder, &NoObserver);
    let log = fs::read_to_string(folder.join("external-mine-0.log")).expect("a log");
    let named = log.matches(&format!("trial {} of 101 rows", number(&study, 1, 3))).count();
    assert_eq!((log.lines().count(), named), (24, 1), "{log}");
    let long = fs::metadata(folder.join("external-mine-1.log")).expect("a log").len();
    assert!((1 << 20..(1 << 20) + 100).contains(&long), "{long} bytes");
    // It is no part of the study, and grows with it.
    run(&study, 2, &folder, &NoObserver);
    assert!(fs::metadata(folder.join("external-mine-0.log")).expect("a log").len() > log.len() as u64);
    assert!(!fs::read_to_string(folder.join("manifest.toml")).expect("a manifest").contains(".log"));
}

/// The commands that were told.
#[derive(Default)]
struct CommandOutput(Mutex<Vec<String>>);

impl Observer for CommandOutput {
    fn note(&self, line: &str) {
        self.0.lock().expect("nobody panics").push(line.to_owned());
    }
}

#[test]
fn a_run_says_what_it_starts_and_starts_few_processes() {
    let desk = tempfile::tempdir().expect("a folder");
    let started = desk.path().join("started");
    let command: &[&str] = &["started", started.to_str().expect("UTF-8")];
    // Both cells and both methods have one command.
    let study = scenario_of(&[command, command], "", &desk.path().join("outside.toml"));
    assert!(!started.exists(), "a scenario that is read starts nothing");
    let told = CommandOutput::default();
    run(&study, 3, &desk.path().join("out"), &told);
    let told = told.0.into_inner().expect("nobody panics");
    assert!(told.len() == 1 && told[0].contains("estimator started") && told[0].contains("`mine 0`"), "{told:?}");
    let processes = fs::read_to_string(&started).expect("it was started").lines().count();
    assert!((1..=3).contains(&processes), "{processes} processes for three threads");
}
