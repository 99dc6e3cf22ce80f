//! Tests of scenarios, `report`, `list`, `simulate`, fits of several records, and wrong usage.

use crate::desk::{Desk, of_repository, zig_zag_csv};
use crate::scenarios::GOOD;

#[test]
fn a_scenario_runs_and_its_report_is_made_again() {
    let desk = Desk::new();
    desk.file("small.toml", GOOD);
    let run = desk.run(&["small.toml"]);
    assert!(run.is_done().out.contains("output-error"), "{}", run.out);
    let page = std::fs::read(desk.path("results/small/report.md")).expect("the report is there");
    std::fs::remove_file(desk.path("results/small/report.md")).expect("it was there");
    desk.run(&["report", "results/small"]).is_done();
    assert_eq!(std::fs::read(desk.path("results/small/report.md")).expect("it is there again"), page);
    desk.run(&["report", "results/small", "--out", "elsewhere", "--quiet"]).is_done();
    assert_eq!(std::fs::read(desk.path("elsewhere/report.md")).expect("it is where it was asked for"), page);
    for file in ["rows/0000-0000.parquet", "summary.csv", "manifest.toml"] {
        assert!(desk.path("results/small").join(file).is_file(), "{file}");
    }
    let other = desk.run(&["small.toml", "--out", "one", "--threads", "1", "--quiet"]);
    assert_eq!(other.is_done().out, "");
    let rows = |folder: &str| std::fs::read(desk.path(folder).join("rows/0000-0000.parquet")).expect("rows");
    assert_eq!(rows("results/small"), rows("one"), "the same rows whatever the number of threads");
    desk.run(&["small.toml", "--out", "two", "--seed", "2", "--quiet"]).is_done();
    assert_ne!(rows("one"), rows("two"));
}

#[test]
fn a_folder_that_is_no_study_cannot_be_reported() {
    let desk = Desk::new();
    desk.file("folder/x", "");
    desk.run(&["report", "folder", "--open"]).is_refused(2, &["folder", "finished study"]);
    desk.file("old/fit.json", "{}");
    desk.run(&["report", "old", "--open"]).is_refused(2, &["fit.json", "study fit"]);
    desk.run(&["report", "missing"]).is_refused(2, &["missing", "no such folder"]);
}

#[test]
fn a_result_folder_that_cannot_be_made_is_a_failure_of_the_work() {
    let desk = Desk::new();
    desk.file("small.toml", GOOD);
    desk.file("in-the-way", "");
    desk.file("good.csv", zig_zag_csv());
    for command in [&["small.toml"][..], &["fit", "good.csv"]] {
        desk.run(&[command, &["--out", "in-the-way"]].concat()).is_refused(1, &["in-the-way", "--out"]);
    }
}

#[test]
fn lists_name_everything_in_every_format() {
    let desk = Desk::new();
    for (what, name) in [
        ("identifiers", "output-error"),
        ("effects", "backlash-deg"),
        ("ships", "kvlcc2"),
        ("manoeuvres", "zig-zag"),
        ("sensors", "heading-noise-deg"),
        ("keys", "disturbance.wind.gusting.correlation-s"),
    ] {
        for format in ["text", "markdown", "csv", "latex"] {
            let run = desk.run(&["list", what, "--format", format]);
            assert!(run.is_done().out.contains(name), "{what} {format}\n{}", run.out);
            assert_eq!(run.err, "");
        }
    }
}

#[test]
fn wrong_usage_is_exit_code_2() {
    let desk = Desk::new();
    desk.file("small.toml", GOOD);
    assert_eq!(desk.run(&[]).code, Some(2));
    for (arguments, part) in [
        (&["list", "fish"][..], "identifiers"),
        (&["small.toml", "--threads", "0"][..], "--threads"),
        (&["small.toml", "--seed", "-1"][..], "whole number from 0"),
        (&["small.toml", "--out", ""][..], "--out"),
        (&["small.toml", "--format", "pdf"][..], "latex"),
        (&["fit"][..], "TRIAL"),
    ] {
        desk.run(arguments).is_refused(2, &[part]);
    }
}

/// The message on a mistyped command lists the commands, whatever arguments follow.
#[test]
fn a_word_that_is_no_command_is_answered_with_those_there_are() {
    let desk = Desk::new();
    desk.file("x.csv", zig_zag_csv());
    desk.run(&["fitt", "x.csv"]).is_refused(2, &["`fitt`", "did you mean `fit`?", "`trace`"]);
    desk.run(&["simulat"]).is_refused(2, &["`simulat`", "`simulate`"]);
    desk.run(&["nothing.toml"]).is_refused(2, &["nothing.toml", "path of a scenario"]);
}

#[test]
fn simulated_trials_are_records_with_the_truth_beside_them() {
    let desk = Desk::new();
    let swept = format!("{GOOD}[[sweep]]\nkey = \"sensor.heading-noise-deg\"\nvalues = [0.05, 0.2]\n");
    desk.file("small.toml", &swept);
    let all = ["simulate", "small.toml", "--replicate", "all", "--out", "records"];
    assert!(desk.run(&all).is_done().out.contains("4 records"));
    let name = "records/small-1-0-2-1";
    let truth = desk.json(&format!("{name}.truth.json"));
    assert_eq!((truth["cell"].as_str(), truth["replicate"].as_u64()), (Some("0.2"), Some(1)));
    assert_eq!((truth["nearest"]["T_s"].as_f64(), truth["own"].is_null()), (Some(16.3), true));
    // `study fit` identifies the record of a trial with the T of its ship.
    let fit = desk.run(&["fit", &format!("{name}.csv"), "--method", "output-error", "--out", "fit"]);
    fit.is_done();
    let found = desk.json("fit/fit.json")["methods"][0]["parameters"]["T_s"]["value"].as_f64().expect("an answer");
    assert!((found / 16.3 - 1.0).abs() < 0.05, "{found}");
    // One cell and one trial become one file.
    let one = ["simulate", "small.toml", "--cell", "0.2", "--replicate", "1", "--out", "one.csv", "--quiet"];
    assert_eq!(desk.run(&one).is_done().out, "");
    assert_eq!(desk.bytes("one.csv"), desk.bytes(&format!("{name}.csv")));
    for (wrong, parts) in [
        (&["--out", "two.csv"][..], &["one file", "2 records", "--cell"][..]),
        (&[], &["--out FILE.csv"]),
        (&["--cell", "0.3", "--out", "x"], &["no such cell", "`0.05`"]),
        (&["--replicate", "2", "--out", "x"], &["2 trials in a cell"]),
        (&["--replicate", "some", "--out", "x"], &["`all`"]),
    ] {
        desk.run(&[&["simulate", "small.toml"], wrong].concat()).is_refused(2, parts);
    }
}

/// A trial with several records gives several files, which identified together have the T of its ship.
#[test]
fn further_records_of_a_trial_are_written_beside_the_first() {
    let desk = Desk::new();
    let both = format!("{GOOD}[[also]]\nmanoeuvre.zig-zag = {{ rudder-deg = 20.0, heading-deg = 20.0 }}\n");
    desk.file("both.toml", &both);
    let run = desk.run(&["simulate", "both.toml", "--replicate", "0", "--out", "records"]);
    assert!(run.is_done().out.contains("2 records"), "{}", run.out);
    let names = ["both-0", "both-0-also-1"].map(|name| format!("records/{name}.csv"));
    desk.run(&["fit", &names[0], &names[1], "--method", "output-error", "--out", "fit", "--quiet"]).is_done();
    let fit = desk.json("fit/fit.json");
    let rows = fit["trials"].as_array().map(Vec::len);
    let found = fit["methods"][0]["parameters"]["T_s"]["value"].as_f64().expect("an answer");
    assert!(rows == Some(2) && (found / 16.3 - 1.0).abs() < 0.03, "{found}");
    let wrong = both.replace("rudder-deg = 20.0, heading-deg", "rudder-deg = -20.0, heading-deg");
    desk.file("wrong.toml", wrong);
    desk.run(&["check", "wrong.toml"]).is_refused(2, &["further record 1", "-20"]);
}

/// The sample records of README and tutorial are those that the program simulates from their scenario.
#[test]
fn the_sample_records_are_those_of_their_scenario() {
    let desk = Desk::new();
    let folder = of_repository("scenarios/records");
    let scenario = folder.join("sample.toml");
    for cell in ["first-order", "undeclared-damping"] {
        let file = format!("{cell}.csv");
        desk.run(&["simulate", scenario.to_str().expect("UTF-8"), "--cell", cell, "--out", &file]).is_done();
        for end in ["csv", "trial.toml", "truth.json"] {
            let committed = std::fs::read(folder.join(format!("{cell}.{end}"))).expect("a sample");
            assert!(desk.bytes(&format!("{cell}.{end}")) == committed, "{cell}.{end}");
        }
    }
}

/// Every record has its zig-zag on the screen and in `fit.json`; the default folder is named after the first record and
/// the number of further records.
#[test]
fn several_records_have_a_zig_zag_each() {
    let desk = Desk::new();
    desk.file("a.csv", zig_zag_csv());
    desk.file("b.csv", zig_zag_csv().replace("\n300,", "\n300.5,"));
    let run = desk.draw(&["fit", "a.csv", "b.csv", "--method", "output-error"]);
    let out = &run.is_done().out;
    assert!(out.contains("a: zig-zag") && out.contains("b: zig-zag"), "{out}");
    let folder = "a-and-1-more-fit";
    let file = desk.json(&format!("{folder}/fit.json"));
    assert!(file["trials"].as_array().expect("two").iter().all(|trial| trial["zigzag"]["period_s"].is_number()));
    assert!(desk.path(folder).join("trial-b.png").is_file());
}
