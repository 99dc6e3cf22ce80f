//! Tests of `study bench`.

use crate::desk::{Desk, sha256, zig_zag_csv};
use crate::scenarios::GOOD;

/// Writes a scenario of two measured records, of which the second is missing, and a simulated scenario.
fn lay_out(desk: &Desk) {
    desk.file("far/away.csv", zig_zag_csv());
    let sha256 = sha256(&desk.bytes("far/away.csv"));
    let methods = "{ method.output-error = {} }, { method.srivc = {} }, { trace = {} }, { straight-on = {} }";
    // Enough trials for an interval.
    let made = GOOD.replace("replicates = 2", &format!("replicates = 6\nidentifier = [{methods}]"));
    desk.file("made.toml", made.split("[[identifier]]").next().expect("a text"));
    let measured = format!(
        "question = \"?\"\nidentifier = [{methods}]\n[records]\njudge = \"none\"\n\
         [records.files]\n\"far/away.csv\" = \"{sha256}\"\n\"far/lost.csv\" = \"{sha256}\"\n"
    );
    desk.file("found.toml", measured);
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

/// The results do not depend on the number of threads. Another request in the same folder needs `--restart`, which also
/// removes files of the earlier run.
#[test]
fn a_benchmark_of_ones_own_runs_and_skips_what_is_not_there() {
    let desk = Desk::new();
    lay_out(&desk);
    let own = ["bench", "found.toml", "made.toml", "--paper", "80", "--dpi", "72"];
    let run = desk.run(&own);
    run.is_done();
    assert!(run.out.contains("skipped: found, far/lost.csv: there is no such file"), "{}", run.out);
    let json = desk.json("results/bench/bench.json");
    assert_eq!((&json["schema"], &json["reference"]), (&"bench/2".into(), &"output-error".into()));
    assert_eq!(json["skipped"][0]["record"], "far/lost.csv");
    let medians = medians(&desk, "results/bench/bench.json");
    let of = |board: &str, method: &str| {
        let found = medians.iter().find(|(own, label, _)| own == board && label == method);
        found.unwrap_or_else(|| panic!("{board}: {method}: {medians:?}")).2
    };
    // The record has no noise, so the error of output error is the rounding of the table.
    assert!(of("identify, found", "output-error") < 1e-3, "{medians:?}");
    for board in ["identify, found", "identify, made"] {
        assert!(of(board, "straight-on") > 10.0 * of(board, "output-error"), "{medians:?}");
    }
    assert!(of("indices, made", "output-error") < 2.0, "{medians:?}");
    for file in ["report.md", "answers.csv", "leaderboard.csv", "ratios-made.png", "methods/trace.md"] {
        assert!(desk.path("results/bench").join(file).is_file(), "{file}");
    }
    let page = desk.text("results/bench/report.md");
    assert!(page.contains("- found, far/lost.csv: there is no such file"), "{page}");
    let here = desk.path("").to_string_lossy().trim_end_matches('/').to_owned();
    for file in ["bench.json", "answers.csv", "report.md", "leaderboard.csv"] {
        let text = desk.text(&format!("results/bench/{file}"));
        assert!(!text.contains(&here), "{file} says where the records lie");
    }

    let again = |more: &[&str]| assert_eq!(desk.run(&[&own[..], more].concat()).is_done().out, "");
    again(&["--quiet", "--threads", "1", "--out", "one"]);
    for file in ["bench.json", "answers.csv", "report.md", "leaderboard.csv", "ratios-made.svg", "methods/srivc.md"] {
        let bytes = desk.bytes(&format!("results/bench/{file}"));
        assert_eq!(bytes, desk.bytes(&format!("one/{file}")), "{file}");
    }
    let one_task = ["--task", "identify", "--set", "made", "--method", "output-error", "--method", "straight-on"];
    let other = [&own[..], &["--out", "one"], &one_task].concat();
    desk.run(&other).is_refused(2, &["rows of another study", "--restart"]);
    again(&[&["--quiet", "--out", "one", "--restart"], &one_task[..]].concat());
    assert!(!desk.path("one/ratios-found.svg").exists() && !desk.path("one/methods/srivc.md").exists());
    let json = desk.json("one/bench.json");
    assert_eq!(json["methods"], serde_json::json!(["output-error", "straight-on"]));
    assert_eq!(json["boards"].as_array().map(Vec::len), Some(1));
}

#[test]
fn what_cannot_be_run_is_refused_in_one_message() {
    let desk = Desk::new();
    lay_out(&desk);
    desk.run(&["bench", "none.toml"]).is_refused(2, &["none.toml", "no such file"]);
    desk.run(&["bench", "--task", "circel"]).is_refused(2, &["circel", "did you mean `circle`"]);
    desk.run(&["bench", "--method", "srivk"]).is_refused(2, &["--method srivk", "did you mean `srivc`"]);
    desk.run(&["bench", "--set", "hull"]).is_refused(2, &["--set hull", "did you mean `hulls`"]);
    let changed = desk.text("found.toml").replace("far/lost.csv", "far/gone.csv");
    desk.file("short.toml", changed.replacen(char::is_numeric, "x", 1));
    desk.run(&["check", "short.toml"])
        .is_refused(2, &["short.toml:", "far/away.csv", "expected 64 hexadecimal digits"]);
    // The first record has another content and the second is missing, so there is no case to score.
    desk.file("far/away.csv", format!("{}\n", zig_zag_csv()));
    let said = ["far/away.csv: it is another file: its SHA-256 begins with ", "far/lost.csv: there is no such file"];
    desk.run(&["bench", "found.toml", "--out", "o"])
        .is_refused(2, &[&["there is nothing to score", "KEMPF_DATA"], &said[..]].concat());
    desk.run(&["found.toml"]).is_refused(2, &[&["none of its records can be used", "KEMPF_DATA"], &said[..]].concat());
}

/// The scenarios of the benchmark are part of the program, so it runs in any folder.
#[test]
fn the_benchmark_of_the_project_runs_from_anywhere() {
    let desk = Desk::new();
    let run = desk.run(&["bench", "--task", "circle", "--method", "output-error", "--format", "csv", "--out", "o"]);
    assert!(run.is_done().out.starts_with("task,records,n,method,median"), "{}", run.out);
    let skipped =
        "skipped: measured, KVLCC2 at full scale, circle from all, kvlcc2_marin/turning_35.csv: there is no such file";
    assert!(run.err.contains(skipped), "{}", run.err);
}

/// A folder that cannot be written is refused before any trial runs.
#[cfg(unix)]
#[test]
fn the_folder_of_results_is_held_before_the_work() {
    let desk = Desk::new();
    lay_out(&desk);
    desk.file("taken", "");
    let asked = ["bench", "found.toml", "--method", "straight-on", "--out", "taken/x"];
    desk.run(&asked).is_refused(1, &["taken/x", "--out"]);
}
