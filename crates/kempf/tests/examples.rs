//! Every example runs from the root of the workspace and prints its result.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Output of an example run from the root of the workspace.
fn run(name: &str, arguments: &[&Path]) -> Output {
    let here = std::env::current_exe().expect("a test is a program");
    let built = here.ancestors().nth(2).expect("tests are two folders down").join("examples").join(name);
    let program = PathBuf::from(format!("{}{}", built.display(), std::env::consts::EXE_SUFFIX));
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let run = Command::new(&program).args(arguments).current_dir(root).output();
    run.unwrap_or_else(|error| panic!("{} is built by `cargo test`: {error}", program.display()))
}

/// Standard output of an example.
fn output(name: &str) -> String {
    let output = run(name, &[]);
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn a_csv_is_fitted() {
    let text = output("fit_csv");
    assert!(text.lines().any(|line| line.starts_with("output-error") && line.contains("T = 16.")), "{text}");
    assert!(text.lines().any(|line| line.starts_with("take K = ") && line.contains("T = 16.")), "{text}");
}

/// The log holds the same zig-zag twice, with straight legs before, between and after.
#[test]
fn a_log_with_two_zig_zags_is_refused() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/records/first-order.csv");
    let text = std::fs::read_to_string(path).expect("a record of the scenarios");
    let (header, rows) = text.split_once('\n').expect("a header");
    let rows: Vec<Vec<f64>> =
        rows.lines().map(|row| row.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()).collect();
    let mut log = header.split(',').take(3).collect::<Vec<_>>().join(",");
    let (mut time, mut course) = (0.0, 0.0);
    let mut add = |heading: f64, rudder: f64| {
        log += &format!("\n{time},{heading},{rudder}");
        time += 1.0;
    };
    for _ in 0..2 {
        (0..400).for_each(|_| add(course, 0.0));
        rows.iter().for_each(|row| add(course + row[1] - rows[0][1], row[2]));
        course += rows[rows.len() - 1][1] - rows[0][1];
    }
    (0..400).for_each(|_| add(course, 0.0));
    let path = std::env::temp_dir().join(format!("kempf-two-zig-zags-{}.csv", std::process::id()));
    std::fs::write(&path, log).expect("a file");
    let refused = run("fit_csv", &[&path]);
    std::fs::remove_file(&path).expect("it was written");
    let message = String::from_utf8_lossy(&refused.stderr);
    assert!(!refused.status.success() && message.contains("there are 2 zig-zags in this log"), "{message}");
}

#[test]
fn estimates_are_compared_with_the_truth() {
    let text = output("simulate_and_identify");
    assert!(text.contains("integral-least-squares") && text.contains("95 % interval of T"), "{text}");
}

#[test]
fn a_record_is_traced() {
    let text = output("trace_record");
    assert!(text.contains("lacks") && text.contains("nonlinear_damping") && text.contains("before"), "{text}");
}

#[test]
fn a_users_method_runs_in_a_study() {
    let text = output("own_identifier");
    let row = text.lines().find(|line| line.starts_with("differences")).expect("the method is in the table");
    assert!(row.split_whitespace().last().is_some_and(|size| size.parse::<f64>().is_ok()), "{text}");
}
