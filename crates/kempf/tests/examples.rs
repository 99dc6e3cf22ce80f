//! Every example runs from the root of the workspace and prints its result.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Standard output of an example.
fn output(name: &str) -> String {
    let here = std::env::current_exe().expect("a test is a program");
    let built = here.ancestors().nth(2).expect("tests are two folders down").join("examples").join(name);
    let program = PathBuf::from(format!("{}{}", built.display(), std::env::consts::EXE_SUFFIX));
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let run = Command::new(&program).current_dir(root).output();
    let output = run.unwrap_or_else(|error| panic!("{} is built by `cargo test`: {error}", program.display()));
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn a_csv_is_fitted() {
    let text = output("fit_csv");
    assert!(text.lines().any(|line| line.starts_with("output-error") && line.contains("T = 16.")), "{text}");
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
