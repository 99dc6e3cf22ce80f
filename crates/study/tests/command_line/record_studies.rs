//! Tests of studies of measured records: `[records]` in place of a simulated ship.

use crate::desk::{Desk, zig_zag_csv};

const STUDY: &str = r#"
question = "Does one record foretell the others?"

[records]
files = ["logs/zz_*.csv"]

[[identifier]]
method.output-error = {}

[[identifier]]
method.least-squares = {}
"#;

/// Folder with three logs of a ship, a table that is no record, and the scenario of the logs, `fleet.toml`.
fn desk() -> Desk {
    let desk = Desk::new();
    desk.file("zz.toml", crate::scenarios::GOOD.replace("replicates = 2", "replicates = 3"));
    desk.run(&["simulate", "zz.toml", "--replicate", "all", "--out", "made", "--quiet"]).is_done();
    for number in 0..3 {
        desk.file(&format!("logs/zz_{number}.csv"), desk.bytes(&format!("made/zz-{number}.csv")));
    }
    desk.file("logs/other.csv", "no,record\n");
    desk.file("fleet.toml", STUDY);
    desk
}

#[test]
fn every_record_is_fitted_and_judged_by_the_others() {
    let desk = desk();
    let run = desk.run(&["fleet.toml", "--out", "out"]);
    assert!(run.is_done().out.contains("judged error [deg]"), "{}", run.out);
    let records = desk.text("out/records.csv");
    assert_eq!(records.lines().count(), 1 + 6 * 2, "{records}");
    let pair = |fitted: &str, judge: &str| records.contains(&format!("output-error,{fitted},{judge},"));
    assert!(pair("zz_0", "zz_1") && pair("zz_2", "zz_1") && !pair("zz_1", "zz_1"), "{records}");
    let summary = desk.text("out/summary.csv");
    let least_squares: Vec<&str> = summary.lines().last().expect("two methods").split(',').collect();
    assert!(summary.contains("output-error,3,0,") && [3, 6, 9, 12].iter().all(|place| least_squares[*place] > "0"));
    assert!(desk.text("out/report.md").contains("judged.png") && desk.path("out/judged.png").exists());
    // The rows are the same with any number of threads and as a shard.
    let rows = |folder: &str| desk.bytes(&format!("{folder}/rows/0000-0000.parquet"));
    desk.run(&["fleet.toml", "--out", "one", "--threads", "1", "--quiet"]).is_done();
    desk.run(&["fleet.toml", "--out", "shard", "--shard", "1/1", "--quiet"]).is_done();
    assert!(rows("out") == rows("one") && rows("out") == rows("shard"));
    // A study with a changed record is another study.
    desk.file("logs/zz_1.csv", zig_zag_csv());
    desk.run(&["fleet.toml", "--out", "out"]).is_refused(2, &["another study", "record"]);
}

/// A sidecar next to a record applies to it; a warning about the record is printed once.
#[test]
fn a_record_has_a_sidecar_beside_it() {
    let desk = desk();
    let run = |sidecar: &str| {
        desk.file("logs/zz_1.trial.toml", sidecar);
        let said = desk.run(&["fleet.toml", "--out", "out", "--restart"]).is_done().err.clone();
        (desk.text("out/records.csv"), said.matches("warning: logs/zz_1.csv").count())
    };
    let whole = run("");
    assert_eq!(whole.1, 0);
    assert_ne!(whole.0, run("[part]\nuntil-s = 90.0\n").0);
    desk.file("logs/zz_1.trial.toml", "");
    desk.run(&["fleet.toml", "--out", "out"]).is_refused(2, &["another study", "record"]);
    // A reversed rudder is implausible; the sidecar switches the check off.
    assert_eq!(run("[check]\nplausibility = false\n[[column]]\nname = \"rudder_deg\"\nflip = true\n").1, 1);
}

#[test]
fn records_are_left_out_listed_or_fitted_alone() {
    let desk = desk();
    let with = |judge: &str| {
        desk.file(
            "own.toml",
            STUDY.replace("[[identifier]]\nmethod.o", &format!("judge = {judge}\n[[identifier]]\nmethod.o")),
        );
        desk.run(&["own.toml", "--out", "out", "--restart", "--quiet"]).is_done();
        desk.text("out/records.csv")
    };
    let left_out = with("\"left-out\"");
    assert!(left_out.contains("output-error,\"zz_1, zz_2\",zz_0,") && left_out.lines().count() == 7, "{left_out}");
    let listed = with("{ fit = [\"zz_2\"], judge = [\"zz_0\", \"zz_1\"] }");
    assert!(listed.contains("output-error,zz_2,zz_0,") && listed.lines().count() == 5, "{listed}");
    let each = with("{ fit = [\"zz_2\", \"zz_0\"], judge = [\"zz_0\", \"zz_1\"], each = true }");
    assert!(each.contains("output-error,zz_0,zz_1,") && each.lines().count() == 7, "{each}");
    let alone = with("\"none\"");
    assert!(alone.contains("output-error,zz_0,,") && alone.lines().count() == 7, "{alone}");
    assert!(!desk.path("out/judged.png").exists());
}

/// Sidecars from a folder, or from one folder for each entry of `files`, declare the ship of each record. A record of a
/// ship of another length is not replayed; its figures are predicted at its scale. At twice the length and speed they
/// are the same.
#[test]
fn a_record_of_another_scale_is_predicted_at_its_scale() {
    let desk = desk();
    for (number, size) in [(0, 1.0), (1, 1.0), (2, 2.0)] {
        let sidecar = format!("[ship]\nlength-m = {}\nspeed-m-s = {}\n", 50.0 * size, 5.0 * size);
        desk.file(&format!("ships/zz_{number}.trial.toml"), sidecar);
    }
    let with = |sidecar: &str| {
        let keys = format!("sidecar = {sidecar}\n[predict]\ndraws = 50\n[[identifier]]\nmethod.o");
        desk.file("scales.toml", STUDY.replace("[[identifier]]\nmethod.o", &keys));
        desk.run(&["scales.toml", "--out", "out", "--restart", "--quiet"]).is_done();
        [desk.text("out/records.csv"), desk.text("out/predictions.csv")]
    };
    let [records, predictions] = with("\"ships\"");
    let judged = |fitted: &str, judge: &str| {
        let (_, rest) = records.split_once(&format!("output-error,{fitted},{judge},")).expect("a trial");
        rest.split(',').nth(3).is_some_and(|error| !error.is_empty())
    };
    assert!(judged("zz_0", "zz_1") && !judged("zz_0", "zz_2") && !judged("zz_2", "zz_0"), "{records}");
    assert!(predictions.contains("output-error,first overshoot,deg,6,"), "{predictions}");
    assert_eq!(with("[\"ships\"]")[1], predictions);
    desk.file("wrong.toml", desk.text("scales.toml").replace("[\"ships\"]", "[\"ships\", \"ships\"]"));
    desk.run(&["check", "wrong.toml"]).is_refused(2, &["2 sidecars", "expected one for each entry of `files`"]);
}

/// Answers of another program to measured records are scored as a further method.
#[test]
fn answers_to_measured_records_are_scored() {
    let desk = desk();
    desk.file("mine.csv", "record,K_per_s,T_s\nzz_0,0.1,16.3\nzz_1,0.1,16.3\n");
    let run = desk.run(&["score", "mine.csv", "--scenario", "fleet.toml", "--out", "out"]);
    assert!(run.is_done().err.contains("2 of 6 trials have no answer"), "{}", run.err);
    let records = desk.text("out/records.csv");
    let own: Vec<&str> = records.lines().filter(|line| line.starts_with("mine,")).collect();
    assert!(own.len() == 6 && own[5].ends_with("outside: no answer"), "{own:?}");
    assert!(own[0].starts_with("mine,zz_0,zz_1,0.100000,16.3000,"), "{own:?}");
}

#[test]
fn what_is_wrong_with_records_is_said_where_it_stands() {
    let desk = desk();
    let refused = |from: &str, to: &str, line: u32, parts: &[&str]| {
        desk.file("wrong.toml", STUDY.replace(from, to));
        let run = desk.run(&["check", "wrong.toml"]);
        run.is_refused(2, parts);
        assert!(run.err.contains(&format!("--> wrong.toml:{line}:")), "{}", run.err);
    };
    refused("zz_*", "none_*", 5, &["\"logs/none_*.csv\"", "no such file", "KEMPF_DATA"]);
    refused("zz_*", "other", 5, &["other.csv", "study fit"]);
    refused("zz_*", "zz_0", 4, &["1 record, which leaves none to judge another", "judge = \"none\""]);
    refused("[records]", "ship.yukun = {}\n[records]", 4, &["`ship`", "no such key"]);
    refused("files =", "judge = \"all\"\nfiles =", 5, &["\"others\", \"left-out\", \"none\""]);
    refused("files =", "judge = { fit = [\"x\"], judge = [] }\nfiles =", 5, &["no record is called \"x\"", "zz_0"]);
    refused("[\"logs/zz_*.csv\"]", "[\"logs/zz_*.csv\", \"logs/zz_0.csv\"]", 5, &["zz_0 is listed twice"]);
    desk.run(&["simulate", "fleet.toml", "--out", "x.csv"])
        .is_refused(2, &["measured records", "nothing is simulated"]);
}
