//! The benchmark: `study bench`.

use crate::desk::{Desk, sha256, zig_zag_csv};
use crate::scenarios::GOOD;

/// A definition of a measured record and a simulated set beside it, on a desk.
fn lay_out(desk: &Desk) {
    desk.file("records/far/away.csv", zig_zag_csv());
    let sha256 = sha256(&desk.bytes("records/far/away.csv"));
    // Enough trials for an interval.
    desk.file("small.toml", GOOD.replace("replicates = 2", "replicates = 6"));
    let definition = format!(
        r#"
name = "small-bench"
reference = "output-error"
[[measured]]
name = "ship"
title = "A ship"
download = "nowhere"
licence = "none"
cite = "nobody"
tasks.identify = ["here", "lost"]
[[measured.record]]
name = "here"
manoeuvre = {{ zig-zag = {{ rudder-deg = 10.0, heading-deg = 10.0, first = "starboard" }} }}
copies = [{{ file = "away.csv", sha256 = "{sha256}" }}]
[[measured.record]]
name = "lost"
manoeuvre = {{ zig-zag = {{ rudder-deg = 10.0, heading-deg = 10.0, first = "port" }} }}
copies = [{{ file = "lost.csv", sha256 = "{sha256}" }}]
[[simulated]]
name = "made"
title = "Trials that are made"
scenario = "small.toml"
records = ["zigzag"]
tasks.identify = ["zigzag"]
tasks.indices = ["zigzag"]
"#
    );
    desk.file("own.toml", definition);
}

fn medians(desk: &Desk, file: &str) -> Vec<(String, String, f64)> {
    let json = desk.json(file);
    let boards = json["boards"].as_array().expect("a list").clone();
    let of_board = |board: &serde_json::Value| {
        let name = format!("{}, {}", board["task"].as_str().expect("text"), board["field"].as_str().expect("text"));
        let standings = board["standings"].as_array().expect("a list").clone();
        standings.into_iter().map(move |standing| {
            let median = standing["median"]["value"].as_f64().unwrap_or(f64::INFINITY);
            (name.clone(), standing["method"].as_str().expect("text").to_owned(), median)
        })
    };
    boards.iter().flat_map(of_board).collect()
}

/// It is the same with any number of threads, and nothing stale is left.
#[test]
fn a_benchmark_of_ones_own_runs_and_skips_what_is_not_there() {
    let desk = Desk::new();
    lay_out(&desk);
    let own = ["bench", "own.toml", "--data", "records", "--paper", "80", "--dpi", "72"];
    let run = desk.run(&own);
    run.is_done();
    assert!(run.out.contains("skipped: ship, lost: no file lost.csv"), "{}", run.out);
    let json = desk.json("results/small-bench/bench.json");
    assert_eq!((&json["schema"], &json["reference"]), (&"bench/1".into(), &"output-error".into()));
    assert_eq!(json["skipped"][0]["record"], "lost");
    let medians = medians(&desk, "results/small-bench/bench.json");
    let of = |board: &str, method: &str| {
        let found = medians.iter().find(|(own, label, _)| own == board && label == method);
        found.unwrap_or_else(|| panic!("{board}: {method}: {medians:?}")).2
    };
    // Perfectly recorded, read from a table: what output error leaves is the rounding of the table.
    assert!(of("identify, measured", "output-error") < 1e-3, "{medians:?}");
    for board in ["identify, measured", "identify, made"] {
        assert!(of(board, "straight-on") > 10.0 * of(board, "output-error"), "{medians:?}");
    }
    assert!(of("indices, made", "output-error") < 2.0, "{medians:?}");
    for file in ["report.md", "rows.csv", "leaderboard.csv", "ratios-made.png", "methods/trace.md"] {
        assert!(desk.path("results/small-bench").join(file).is_file(), "{file}");
    }
    let page = desk.text("results/small-bench/report.md");
    assert!(page.contains("- ship, lost: no file lost.csv"), "{page}");
    let here = desk.path("").to_string_lossy().trim_end_matches('/').to_owned();
    for file in ["bench.json", "rows.csv", "report.md", "leaderboard.csv"] {
        let text = desk.text(&format!("results/small-bench/{file}"));
        assert!(!text.contains(&here), "{file} says where the records lie");
    }

    let again = |more: &[&str]| assert_eq!(desk.run(&[&own[..], more].concat()).is_done().out, "");
    again(&["--quiet", "--threads", "1", "--out", "one"]);
    for file in ["bench.json", "rows.csv", "report.md", "leaderboard.csv", "ratios-made.svg", "methods/srivc.md"] {
        let bytes = desk.bytes(&format!("results/small-bench/{file}"));
        assert_eq!(bytes, desk.bytes(&format!("one/{file}")), "{file}");
    }
    let one_task = ["--task", "identify", "--set", "made", "--method", "output-error", "--method", "straight-on"];
    again(&[&["--quiet", "--out", "one"], &one_task[..]].concat());
    assert!(!desk.path("one/ratios-measured.svg").exists() && !desk.path("one/methods/srivc.md").exists());
    let json = desk.json("one/bench.json");
    assert_eq!(json["methods"], serde_json::json!(["output-error", "straight-on"]));
    assert_eq!(json["boards"].as_array().map(Vec::len), Some(1));
}

#[test]
fn what_cannot_be_run_is_refused_in_one_message() {
    let desk = Desk::new();
    lay_out(&desk);
    desk.run(&["bench", "own.toml", "--data", "nowhere"]).is_refused(2, &["nowhere", "--data", "KEMPF_DATA"]);
    desk.run(&["bench", "none.toml"]).is_refused(2, &["none.toml", "no such file"]);
    desk.run(&["bench", "--task", "circel"]).is_refused(2, &["circel", "did you mean `circle`"]);
    desk.run(&["bench", "--method", "srivk"]).is_refused(2, &["--method srivk", "did you mean `srivc`"]);
    desk.run(&["bench", "--set", "hull"]).is_refused(2, &["--set hull", "did you mean `hulls`"]);
    let wrong = desk.text("own.toml").replace("licence =", "license =");
    desk.file("wrong.toml", wrong);
    desk.run(&["bench", "wrong.toml"]).is_refused(2, &["wrong.toml:8:1", "unknown field `license`", "`licence`"]);
    // Without any folder the measured set of the benchmark is not there, and nothing else was asked for.
    let lone = desk.run(&["bench", "own.toml", "--set", "ship"]);
    lone.is_refused(2, &["no question to ask", "ship, here: no file away.csv", "--data names the folder"]);
    assert!(!desk.path("results").exists(), "nothing is written before there is something to write");
}

/// The program holds its benchmark: it runs where no file of the project is.
#[test]
fn the_benchmark_of_the_project_runs_from_anywhere() {
    let desk = Desk::new();
    let run = desk.run(&["bench", "--task", "circle", "--method", "output-error", "--format", "csv", "--out", "o"]);
    assert!(run.is_done().out.starts_with("task,records,n,method,median"), "{}", run.out);
    assert!(run.err.contains("skipped: kvlcc2-marin, circle-35: no file turning_35.csv"), "{}", run.err);
}

/// Hours of work are not begun for a folder that cannot be written.
#[cfg(unix)]
#[test]
fn the_folder_of_results_is_held_before_the_work() {
    let desk = Desk::new();
    lay_out(&desk);
    desk.file("taken", "");
    let asked = ["bench", "own.toml", "--data", "records", "--method", "straight-on", "--out", "taken/x"];
    desk.run(&asked).is_refused(1, &["taken/x", "--out"]);
}
