//! Tests of logs: manoeuvres found and selected, inspection, fits of single logs, joined files, sidecars.

use serde_json::Value;

use crate::desk::{Desk, with_column, zig_zag_csv};
use crate::schemas;

/// CSV log of time, heading and rudder: twice a straight leg and a zig-zag, then a straight leg.
fn long_log() -> String {
    let rows: Vec<Vec<f64>> = zig_zag_csv()
        .lines()
        .skip(1)
        .map(|line| line.split(',').take(3).map(|cell| cell.parse().expect("a number")).collect())
        .collect();
    let (mut time, mut heading) = (0.0, 0.0);
    let mut text = String::from("t_s,heading_deg,rudder_deg\n");
    let mut add = |psi: f64, delta: f64| {
        text.push_str(&format!("{time},{psi},{delta}\n"));
        time += 1.0;
    };
    for _ in 0..2 {
        (0..400).for_each(|_| add(heading, 0.0));
        rows.iter().for_each(|row| add(heading + row[1] - rows[0][1], row[2]));
        heading += rows[rows.len() - 1][1] - rows[0][1];
    }
    (0..400).for_each(|_| add(heading, 0.0));
    text
}

#[test]
fn the_zig_zag_of_a_log_is_found_and_asked_for_where_there_are_two() {
    let desk = Desk::new();
    desk.file("day.csv", long_log());
    let found = desk.run(&["find", "day.csv"]);
    assert_eq!(found.is_done().out.matches("zig-zag 10/10").count(), 2, "{}", found.out);
    desk.run(&["fit", "day.csv"]).is_refused(2, &["2 zig-zags", "--trial 2", "zig-zag 10/10"]);
    let number = |line: &str| line.trim_start().chars().next().expect("a number").to_string();
    let line = found.out.lines().rfind(|line| line.contains("zig-zag")).expect("the second one");
    let run = desk.run(&["fit", "day.csv", "--trial", &number(line), "--method", "output-error"]);
    assert!(run.is_done().err.contains("the rest is left out"), "{}", run.err);
    desk.run(&["fit", "day.csv", "--trial", "99"]).is_refused(2, &["no manoeuvre 99", "study find"]);
    desk.run(&["fit", "day.csv", "--from", "300", "--until", "700", "--method", "output-error"]).is_done();
    desk.run(&["fit", "day.csv", "--from", "14:00"]).is_refused(2, &["`14:00` is a time of day", "give seconds"]);
    desk.run(&["fit", "day.csv", "--from", "soon"]).is_refused(2, &["soon", "expected seconds"]);
    desk.run(&["fit", "day.csv", "day.csv", "--trial", "1"]).is_refused(2, &["--trial is for one record"]);
}

/// `study inspect` lists every channel with its source, and warns of a reversed rudder, which a fit refuses.
#[test]
fn a_log_is_inspected_before_anything_is_fitted() {
    let desk = Desk::new();
    let row = |line: &str| match line.split(',').collect::<Vec<&str>>()[..3] {
        [t, psi, "rudder_deg"] => format!("{t},{psi},Ruder (Grad)\n"),
        [t, psi, delta] => format!("{t},{psi},{}\n", -delta.parse::<f64>().expect("a number")),
        _ => panic!("three columns"),
    };
    desk.file("run.csv", zig_zag_csv().lines().map(row).collect::<String>());
    desk.run(&["fit", "run.csv"]).is_refused(2, &["sign looks flipped"]);
    let run = desk.run(&["inspect", "run.csv"]);
    assert!(run.is_done().err.contains("not usable as one record: the rudder sign looks flipped"), "{}", run.err);
    let rudder = run.out.lines().find(|line| line.starts_with("rudder angle")).expect("a row");
    assert!(rudder.contains("Ruder (Grad)") && rudder.contains("  port"), "{rudder}");
    let table = desk.run(&["inspect", "run.csv", "--format", "csv", "--quiet"]);
    assert!(table.is_done().out.starts_with("channel,source,readings,every [s]"), "{}", table.out);
    desk.run(&["inspect", "none.csv"]).is_refused(2, &["none.csv"]);
}

#[test]
fn a_log_without_a_zig_zag_is_said_to_have_none() {
    let desk = Desk::new();
    let mut text = String::from("t_s,heading_deg,rudder_deg\n");
    let (mut psi, mut r) = (0.0, 0.0);
    for time in 0..900 {
        let delta = if (600..700).contains(&time) { 20.0 } else { 0.0 };
        text.push_str(&format!("{time},{psi:.3},{delta}\n"));
        r += (0.06 * delta - r) / 25.0;
        psi += r;
    }
    desk.file("turn.csv", text);
    let run = desk.run(&["fit", "turn.csv", "--method", "output-error"]);
    assert!(run.is_done().err.contains("no zig-zag is recognised"), "{}", run.err);
}

/// With `--each` every log has a row or a line of JSON, in the order of the command line, also without an estimate.
#[test]
fn every_log_is_fitted_alone_and_is_a_row() {
    let desk = Desk::new();
    desk.file("logs/good.csv", zig_zag_csv());
    let swung = |row: usize, psi: f64| (psi + 9.0 * (row as f64 / 5.0).sin()).to_string();
    desk.file("logs/swung.csv", with_column(&zig_zag_csv(), "heading_deg", swung));
    desk.file("logs/bad.csv", "t_s,heading_deg\n0,1\n");
    desk.file("logs/notes.md", "no log");
    let run = |logs: &[&str], options: &[&str]| {
        desk.run(&[&["fit", "--each", "--method", "output-error"], logs, options].concat())
    };
    let all = ["missing.csv", "logs"];
    let lines = run(&all, &["--format", "json", "--quiet"]);
    let entries: Vec<Value> =
        lines.is_done().out.lines().map(|line| serde_json::from_str(line).expect("a document a line")).collect();
    entries.iter().for_each(|entry| schemas::hold("fit-each", &desk.path("lines"), entry));
    let files: Vec<&str> = entries.iter().filter_map(|entry| entry["file"].as_str()).collect();
    assert_eq!(files, ["missing.csv", "logs/bad.csv", "logs/good.csv", "logs/swung.csv"]);
    assert_eq!([0, 1].map(|row| &entries[row]["error"]["code"]), ["not-found", "missing-channel"]);
    assert!(entries[1]["verdict"].is_null() && entries[2]["error"].is_null(), "{}", lines.out);
    let (good, swung) = (&entries[2]["verdict"], &entries[3]["verdict"]);
    assert!(swung["believe"] == "no" && swung.get("K_per_s").is_none(), "{swung}");
    desk.run(&["fit", "logs/good.csv", "--method", "output-error", "--out", "alone"]).is_done();
    assert_eq!(*good, desk.json("alone/fit.json")["verdict"]);

    let table = run(&all, &["--format", "csv", "--threads", "1"]);
    let rows: Vec<&str> = table.is_done().out.lines().collect();
    assert!(rows[0].starts_with("file,method,K [1/s],K lower 95 [1/s],K upper 95 [1/s],T [s]"), "{}", rows[0]);
    assert!(rows[0].ends_with("believe,residual,warnings,codes,reason") && rows.len() == 5, "{}", table.out);
    assert!(rows[1].contains("not-found: there is no such file") && rows[4].contains("output-error"), "{}", table.out);
    assert_eq!(table.out, run(&all, &["--format", "csv", "--threads", "2"]).out);
    assert!(run(&all, &[]).is_done().out.contains("logs/swung.csv"));
    assert!(!desk.path("good-fit").exists(), "rows are all there is");
    let none = run(&["logs/bad.csv", "missing.csv"], &[]);
    assert!(none.code == Some(2) && none.err.contains("none of 2 logs could be read"), "{}", none.err);
    run(&["logs"], &["--out", "folder"]).is_refused(2, &["--out"]);
}

#[test]
fn files_of_one_trial_are_joined_by_time() {
    let desk = Desk::new();
    let whole = zig_zag_csv();
    let columns = |places: [usize; 2]| -> String {
        let pick = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            format!("{},{}\n", cells[places[0]], cells[places[1]])
        };
        whole.lines().map(pick).collect()
    };
    desk.file("heading.csv", columns([0, 1]));
    desk.file("rudder.csv", columns([0, 2]));
    desk.file("whole.csv", &whole);
    let answer = |arguments: &[&str], folder: &str| {
        desk.run(&[&["fit", "--method", "output-error"], arguments].concat()).is_done();
        desk.json(&format!("{folder}/fit.json"))["methods"][0]["parameters"]["K_per_s"]["value"].as_f64()
    };
    let joined = answer(&["heading.csv", "--with-columns", "rudder.csv"], "heading-fit");
    assert_eq!(joined, answer(&["whole.csv"], "whole-fit"));
    desk.run(&["fit", "heading.csv"]).is_refused(2, &["rudder angle"]);
    desk.run(&["fit", "heading.csv", "--with-columns", "heading.csv"])
        .is_refused(2, &["no rudder angle", "--with-columns"]);
    let ship = ["--length-m", "105", "--speed-kn", "16.7"];
    let run = desk.run(&[&["fit", "whole.csv"], &ship[..]].concat());
    assert!(run.is_done().out.contains("IMO 10/10 first overshoot"), "{}", run.out);
    let run = desk.run(&["fit", "whole.csv"]);
    assert!(run.is_done().out.contains("IMO: not compared"), "{}", run.out);
    desk.run(&["fit", "whole.csv", "--length-m", "105"]).is_refused(2, &["no speed", "--speed-kn"]);
}

#[test]
fn a_first_description_is_written_for_a_person_to_check() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv().replace("rudder_deg", "helm"));
    desk.run(&["fit", "run.csv"]).is_refused(2, &["rudder angle", "`helm`"]);
    desk.run(&["sidecar", "run.csv"]).is_done();
    desk.run(&["sidecar", "run.csv"]).is_refused(2, &["run.trial.toml", "there already"]);
    let path = desk.path("run.trial.toml");
    let text = std::fs::read_to_string(&path).expect("it was written");
    let wanted = "# [[column]]\n# name = \"helm\"\n# is = \"rudder_deg\"";
    assert!(text.contains(wanted), "{text}");
    std::fs::write(&path, text.replace(wanted, &wanted.replace("# ", ""))).expect("written");
    desk.run(&["fit", "run.csv", "--method", "output-error"]).is_done();
}

/// A sidecar is written completely or not at all; a symbolic link in its place is not followed.
#[cfg(unix)]
#[test]
fn a_sidecar_is_written_whole_and_beside_its_table() {
    let desk = Desk::new();
    desk.file("in/log.csv", crate::desk::zig_zag_csv());
    std::os::unix::fs::symlink("../escaped.toml", desk.path("in/log.trial.toml")).expect("a link");
    desk.run(&["sidecar", "in/log.csv"]).is_refused(2, &["log.trial.toml", "there already"]);
    assert!(!desk.path("escaped.toml").exists());
    std::fs::remove_file(desk.path("in/log.trial.toml")).expect("it is there");
    // No file may grow, as on a full disk.
    let full = "trap '' XFSZ; ulimit -f 0; exec \"$0\" sidecar in/log.csv";
    let program = env!("CARGO_BIN_EXE_study");
    let mut shell = std::process::Command::new("sh");
    let run = shell.args(["-c", full, program]).current_dir(desk.path("")).output().expect("a shell");
    assert_eq!(run.status.code(), Some(1), "{}", String::from_utf8_lossy(&run.stderr));
    let left = std::fs::read_dir(desk.path("in")).expect("a folder").count();
    assert_eq!(left, 1, "the table alone is left");
}
