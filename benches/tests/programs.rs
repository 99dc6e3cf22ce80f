//! The programs that measure, with small sizes: they end, and what they write is whole.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn performance(arguments: &[&Path]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_performance")).args(arguments).output().expect("the program starts")
}

#[test]
fn measures_everything_and_writes_a_report() {
    let folder = tempfile::tempdir().expect("a folder");
    let results = folder.path().join("performance");
    let output = performance(&["--quick".as_ref(), &results]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report = fs::read_to_string(results.join("report.md")).expect("a report");
    assert!(report.contains("These are no results"));
    for group in kempf_benches::works::all() {
        for row in &group.rows {
            assert!(report.contains(&row.work.name), "{}", row.work.name);
        }
    }
    for figure in ["identification", "growth-samples", "growth-trials"] {
        assert!(report.contains(&format!("({figure}.png)")));
        for kind in ["png", "svg"] {
            assert!(fs::metadata(results.join(figure).with_extension(kind)).expect(figure).len() > 2000);
        }
    }
    let rows = fs::read_to_string(results.join("performance.csv")).expect("rows");
    let works: usize = kempf_benches::works::all().iter().map(|group| group.rows.len()).sum();
    assert_eq!(rows.lines().count(), works + 1);
    assert!(fs::read_to_string(results.join("trials.csv")).expect("studies").lines().count() > 3);
    assert!(fs::read_to_string(results.join("machine.toml")).expect("a machine").contains("quick = true"));
    if cfg!(target_os = "linux") {
        assert!(report.contains("peak memory of a study"));
    }
}

#[test]
fn says_how_it_is_used() {
    let output = performance(&[]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).starts_with("usage: performance"));
}

/// Made-up rows are joined as real ones are.
#[test]
fn shards_are_joined() {
    let output =
        Command::new(env!("CARGO_BIN_EXE_shards")).args(["3", "40", "7", "1"]).output().expect("the program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = String::from_utf8_lossy(&output.stdout);
    let cells = |line: &str| line.split('|').map(|cell| cell.trim().to_owned()).skip(1).take(4).collect::<Vec<_>>();
    let lines: Vec<Vec<String>> = table.lines().skip(2).map(cells).collect();
    assert_eq!(lines, [["3", "120", "840", "18"], ["7", "7", "49", "42"]]);
    let refused = Command::new(env!("CARGO_BIN_EXE_shards")).args(["3"]).output().expect("the program starts");
    assert_eq!(refused.status.code(), Some(2));
}
