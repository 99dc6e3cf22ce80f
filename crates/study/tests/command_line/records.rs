//! Tests of `study fit` on valid and invalid records.

use std::fmt::Write as _;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use identify::registry::DEFAULT_METHODS;

use crate::desk::{Desk, measured, of_repository, with_column, zig_zag_csv, zig_zag_csv_of};

fn refused(content: impl AsRef<[u8]>, parts: &[&str]) {
    let desk = Desk::new();
    desk.file("run.csv", content);
    desk.run(&["fit", "run.csv"]).is_refused(2, &[&["run.csv"], parts].concat());
    assert!(!desk.path("run-fit").exists(), "nothing is written for a record that is refused");
}

#[test]
fn a_broken_table_is_refused_with_line_and_column() {
    let good = zig_zag_csv();
    let word = with_column(&good, "heading_deg", |row, psi| if row == 40 { "abc".into() } else { psi.to_string() });
    refused(word, &["line 42", "`heading_deg`", "`abc`", "expected a number", "correct the cell"]);
    refused(good.lines().take(4).collect::<Vec<_>>().join("\n"), &["3 of 3 rows", "at least 8"]);
}

#[test]
fn a_record_that_contradicts_itself_is_refused_with_the_cure() {
    let good = zig_zag_csv();
    let radians = |_: usize, angle: f64| angle.to_radians().to_string();
    refused(
        with_column(&good, "heading_deg", |_, _| "45".into()),
        &["heading stays", "check that the heading sensor was recorded"],
    );
    refused(with_column(&good, "heading_deg", radians), &["radians", "heading_rad"]);
    refused(with_column(&good, "rudder_deg", radians), &["radians", "rudder_rad"]);
    refused(good.replace("heading_deg", "heading_rad"), &["degrees", "heading_deg"]);
    refused(with_column(&good, "rudder_deg", |_, delta| (1e300 * delta).to_string()), &["`rudder_deg` reaches 1e301"]);
}

/// A result is replaced only by the result of a record with the same file name or the same content.
#[test]
fn the_result_of_another_record_is_kept() {
    let desk = Desk::new();
    let (own, other) = (zig_zag_csv(), with_column(&zig_zag_csv(), "heading_deg", |_, psi| (psi + 0.1).to_string()));
    desk.file("a/trial.csv", &own);
    desk.file("b/trial.csv", &other);
    let fit = |record: &str| desk.run(&["fit", record, "--method", "output-error", "--figures", "none", "--out", "f"]);
    fit("a/trial.csv").is_done();
    fit("b/trial.csv").is_refused(2, &["f/fit.json is the result of a/trial.csv, not of b/trial.csv", "--out"]);
    desk.file("b/trial.csv", &own);
    fit("b/trial.csv").is_done();
    desk.file("b/trial.csv", &other);
    fit("b/trial.csv").is_done();
}

/// If the rudder does not explain the heading, the verdict has no K and T, and a prediction has a warning.
#[test]
fn no_answer_is_taken_from_a_heading_that_the_rudder_does_not_explain() {
    let desk = Desk::new();
    let swung = |row: usize, psi: f64| (psi + 9.0 * (row as f64 / 5.0).sin()).to_string();
    desk.file("run.csv", with_column(&zig_zag_csv(), "heading_deg", swung));
    let run = desk.run(&["fit", "run.csv", "--method", "output-error", "--figures", "none"]);
    assert!(run.is_done().out.starts_with("No K and T can be taken from this "), "{}", run.out);
    let verdict = &desk.json("run-fit/fit.json")["verdict"];
    assert!(verdict["believe"] == "no" && verdict["because"].is_string(), "{verdict}");
    assert!(verdict.get("K_per_s").is_none() && verdict.get("T_s").is_none(), "{verdict}");
    let because = verdict["because"].as_str().expect("a reason");
    let run = desk.run(&["predict", "run-fit/fit.json", "--draws", "60", "--figures", "none"]);
    assert!(run.is_done().err.contains("no K and T can be taken from its records"), "{}", run.err);
    let warning = &desk.json("run-fit-predict/predict.json")["warnings"][0];
    assert_eq!((&warning["code"], &warning["severity"]), (&"not-identified".into(), &"doubt".into()));
    assert!(warning["text"].as_str().is_some_and(|text| text.ends_with(because)), "{warning}");
}

#[test]
fn a_ship_that_was_not_steered_cannot_be_identified() {
    let good = zig_zag_csv();
    let still = with_column(&good, "rudder_deg", |_, _| "0".into());
    refused(
        with_column(&still, "heading_deg", |row, _| (0.1 * (row as f64 * 1.7).sin()).to_string()),
        &["no method can identify this record", "not excited", "rudder is put to both sides"],
    );
    refused(with_column(&still, "heading_deg", |_, _| "12".into()), &["nothing moves"]);
    // A turning circle without its beginning: the rudder never moves.
    let hard_over = with_column(&good, "rudder_deg", |_, _| "35".into());
    refused(
        with_column(&hard_over, "heading_deg", |row, _| (0.7 * row as f64).to_string()),
        &["not excited", "stays at 35"],
    );
}

#[test]
fn a_turning_circle_gives_what_it_can() {
    let desk = Desk::new();
    let (mut rate, mut heading, mut rudder) = (0.0, 0.0, 0.0);
    let mut table = String::from("t_s,heading_deg,rudder_deg\n");
    for t in 0..600 {
        writeln!(table, "{t},{heading:.4},{rudder}").expect("memory can be written");
        rate += (0.02 * rudder - rate) / 16.0;
        heading += rate;
        rudder = if t < 20 { 0.0_f64 } else { 35.0_f64.min(rudder + 2.5) };
    }
    desk.file("turn.csv", table);
    let run = desk.run(&["fit", "turn.csv"]);
    assert!(run.is_done().out.contains("failed: "), "{}", run.out);
    assert!(run.out.contains("characteristic-points failed: needs at least"), "{}", run.out);
    assert!(run.out.contains("a turning circle to starboard with 35.0° of rudder: without positions"), "{}", run.out);
    let fit = desk.json("turn-fit/fit.json");
    let status = |id: &str| {
        fit["methods"].as_array().expect("methods").iter().find(|m| m["method"] == id).expect(id)["status"].clone()
    };
    assert_eq!((status("output-error"), status("characteristic-points")), ("ok".into(), "failed".into()));
    assert!(fit["zigzag"].is_null());
    let only = desk.run(&["fit", "turn.csv", "--method", "characteristic-points"]);
    only.is_refused(2, &["turn.csv: characteristic-points cannot identify this record", "help: "]);
}

#[test]
fn a_path_that_is_no_record_is_refused() {
    let desk = Desk::new();
    desk.file("good.csv", zig_zag_csv());
    desk.file("folder/x", "");
    desk.file("scenario.toml", "question = \"?\"");
    desk.file("other.trial.toml", "[ship]\nlength-m = 100\nspeed-kn = 10\n");
    let refused = |arguments: &[&str], parts: &[&str]| desk.run(&[&["fit"], arguments].concat()).is_refused(2, parts);
    refused(&["missing.csv"], &["missing.csv: there is no such file"]);
    refused(&["folder"], &["folder: this folder holds no record", ".csv"]);
    refused(&["scenario.toml"], &["scenario.toml: this is a TOML file, not a record", "study scenario.toml"]);
    refused(&["other.trial.toml"], &["other.trial.toml", "name the table"]);
    refused(&["good.csv", "--method", "magic"], &["--method magic", "output-error"]);
    refused(&["good.csv", "--validate", "missing.csv"], &["missing.csv: there is no such file"]);
    refused(&["good.csv", "missing.csv"], &["missing.csv: there is no such file"]);
    refused(
        &["good.csv", "--from", "500"],
        &["good.csv: no row lies from 500 s; the rows", "between 0 s and 300 s", "--until"],
    );
    refused(&["good.csv", "--columns", "missing.toml"], &["missing.toml", "no such file"]);
}

/// Devices are refused; files and pipes are read up to their maximum size only.
#[cfg(target_os = "linux")]
#[test]
fn only_files_and_pipes_are_read_and_only_so_far() {
    let desk = Desk::new();
    desk.file("good.csv", zig_zag_csv());
    desk.file("long.toml", "# a long note\n".repeat(100_000));
    let device = "this is neither a file nor a pipe";
    desk.run(&["/dev/zero"]).is_refused(2, &[device]);
    desk.run(&["check", "/dev/zero"]).is_refused(2, &[device]);
    desk.run(&["fit", "/dev/zero"]).is_refused(2, &[device]);
    desk.run(&["fit", "good.csv", "--columns", "/dev/zero"]).is_refused(2, &[device]);
    desk.run(&["check", "long.toml"]).is_refused(2, &["1400000 bytes", "at most 1048576", "study fit"]);
    let columns = ["fit", "good.csv", "--columns", "long.toml"];
    desk.run(&columns).is_refused(2, &["long.toml", "1400000 bytes", "a sidecar has at most 1048576"]);

    desk.run_with_input(&["fit", "/dev/stdin", "--method", "srivc", "--out", "piped"], zig_zag_csv()).is_done();
    let long = desk.run_with_input(&["check", "/dev/stdin"], "# a long note\n".repeat(100_000));
    long.is_refused(2, &["more bytes, a scenario has at most 1048576"]);
}

/// A message on a replayed record shows none of its content: a scenario from a stranger may name any file of the user.
#[test]
fn the_message_about_a_replayed_record_does_not_show_it() {
    let desk = Desk::new();
    let scenario = std::fs::read_to_string(of_repository("scenarios/yukun.toml")).expect("it is there");
    let (before, rest) = scenario.split_once("[manoeuvre.zig-zag]").expect("it steers a zig-zag");
    let (_, after) = rest.split_once("\n[").expect("another table follows");
    desk.file("case.toml", format!("{before}[manoeuvre.replay]\nfile = \"other\"\n[{after}"));
    for content in ["secret:1:2\n", "1,2,secret\n", "t_s,heading_deg,rudder_deg\n0,0,secret\n", "t_s,secret\n0,1\n"] {
        desk.file("other", content);
        let run = desk.run(&["check", "case.toml"]);
        run.is_refused(2, &["other: this file is not a usable record", "study fit"]);
        assert!(!run.err.contains("secret"), "{}", run.err);
    }
    desk.file("other", zig_zag_csv());
    desk.file("other.trial.toml", "secret = 1\n");
    let run = desk.run(&["check", "case.toml"]);
    run.is_refused(2, &["other.trial.toml: this sidecar"]);
    assert!(!run.err.contains("secret"), "{}", run.err);
}

#[test]
fn a_broken_sidecar_is_refused_with_its_line() {
    let desk = Desk::new();
    desk.file("good.csv", zig_zag_csv());
    let refused = |arguments: &[&str], file: &str| {
        desk.file(file, "[tabel]\n");
        desk.run(arguments).is_refused(2, &[file, "line 1", "`tabel`", "`table`"]);
    };
    refused(&["fit", "good.csv", "--columns", "odd.toml"], "odd.toml");
    refused(&["fit", "good.csv"], "good.trial.toml");
}

#[test]
fn a_good_record_gives_a_table_figures_and_json() {
    let desk = Desk::new();
    desk.file("run 1.csv", zig_zag_csv());
    let run = desk.draw(&["fit", "run 1.csv"]);
    for method in DEFAULT_METHODS {
        assert!(run.is_done().out.contains(method), "{method}\n{}", run.out);
    }
    assert!(run.out.contains("overshoots") && run.out.contains("run 1-fit"), "{}", run.out);
    for figure in ["trial", "fit", "replays"] {
        for kind in ["png", "svg"] {
            assert!(desk.path("run 1-fit").join(figure).with_extension(kind).is_file(), "{figure}.{kind}");
        }
    }
    let fit = desk.json("run 1-fit/fit.json");
    assert_eq!(fit["schema"], "fit/2");
    let trial = &fit["trials"][0];
    assert_eq!(
        (&trial["file"], &trial["samples"], &trial["duration_s"]),
        (&"run 1.csv".into(), &301.into(), &300.0.into())
    );
    assert_eq!(trial["sha256"].as_str().map(str::len), Some(64));
    let methods = fit["methods"].as_array().expect("a list");
    let ids: Vec<&str> = methods.iter().filter_map(|method| method["method"].as_str()).collect();
    assert_eq!(ids, DEFAULT_METHODS);
    let exact = methods.iter().find(|method| method["method"] == "output-error").expect("it is there");
    assert_eq!(
        (&exact["status"], &exact["reason"], &exact["course_unstable"]),
        (&"ok".into(), &().into(), &false.into())
    );
    // The record is noise-free and of first order: K = 0.1 1/s, T = 16.3 s (ship::ships::yukun); its rows are 1 s
    // apart, so the corners of the rudder between them are lost.
    for (name, truth, tolerance) in [("K_per_s", 0.1, 1e-3), ("T_s", 16.3, 0.2), ("delta_r_deg", 0.0, 0.05)] {
        let quantity = &exact["parameters"][name];
        let value = quantity["value"].as_f64().expect("a number");
        assert!((value - truth).abs() < tolerance, "{name} = {value}");
        assert!(
            quantity["sd"].is_number() && quantity["ci95"].as_array().is_some_and(|ends| ends.len() == 2),
            "{quantity}"
        );
    }
    assert!(exact["heading_rmse_deg"].as_f64().is_some_and(|rmse| rmse < 0.1), "{}", exact["heading_rmse_deg"]);
    assert!(exact["validation"].as_array().is_some_and(Vec::is_empty));
    let zigzag = &fit["zigzag"];
    assert!(["initial_turning_time_s", "period_s"].iter().all(|key| zigzag[*key].is_number()), "{zigzag}");
    assert!(zigzag["overshoots_deg"].as_array().is_some_and(|overshoots| overshoots.len() > 3), "{zigzag}");
}

#[test]
fn a_course_unstable_ship_is_called_so() {
    let desk = Desk::new();
    let ship = ship::ships::user::first_order(-0.1, -40.0, 0.0, None).expect("K and T have the same sign");
    desk.file("unstable.csv", zig_zag_csv_of(&ship));
    let run = desk.run(&["fit", "unstable.csv", "--method", "output-error"]);
    assert!(run.is_done().out.contains("course-unstable"), "{}", run.out);
    let method = &desk.json("unstable-fit/fit.json")["methods"][0];
    assert_eq!(method["course_unstable"], true);
    let t = method["parameters"]["T_s"]["value"].as_f64().expect("a number");
    assert!((t + 40.0).abs() < 1.0, "T = {t} s, simulated with -40 s");
}

#[test]
fn options_of_fit_do_what_they_say() {
    let desk = Desk::new();
    let good = zig_zag_csv();
    desk.file("a/run.csv", &good);
    desk.file(
        "b/run.csv",
        with_column(&good, "heading_deg", |row, psi| (psi + 0.01 * (row as f64 * 2.3).sin()).to_string()),
    );
    desk.file("run.trial.toml", "[ship]\nlength-m = 105.0\nspeed-kn = 16.7\n");
    let methods = ["--method", "srivc", "--method", "output-error", "--columns", "run.trial.toml"];
    let records = ["fit", "a/run.csv", "b/run.csv", "--validate", "b/run.csv", "--out", "both", "--threads", "1"];
    let run = desk.draw(&[&records[..], &methods].concat());
    let fit = desk.json("both/fit.json");
    assert_eq!(fit["trials"].as_array().map(Vec::len), Some(2));
    assert_eq!(fit["methods"].as_array().map(Vec::len), Some(2));
    let validation = &fit["methods"][0]["validation"][0];
    assert_eq!(validation["file"], "b/run.csv");
    assert!(validation["heading_rmse_deg"].is_number());
    assert!(
        fit["zigzag"]["imo"].as_array().is_some_and(|imo| imo.iter().any(|criterion| criterion["verdict"] == "pass"))
    );
    // Records of the same name have numbered figures, and a note gives the file of each.
    for name in ["fit.png", "fit-run-2.png", "fit-run-3.png", "replays-run-3.svg"] {
        assert!(desk.path("both").join(name).is_file(), "{name}");
    }
    assert!(run.is_done().out.contains("run-3 is b/run.csv") && run.out.contains("on run-3"), "{}", run.out);
    assert!(run.err.contains("validates nothing"), "{}", run.err);

    let quiet = desk.run(&["fit", "a/run.csv", "--quiet", "--out", "quiet"]);
    assert_eq!(quiet.is_done().out, "");
    let bytes = |folder: &str| std::fs::read(desk.path(folder).join("fit.json")).expect("fit.json");
    desk.run(&["fit", "a/run.csv", "--quiet", "--out", "one", "--threads", "1"]).is_done();
    assert_eq!(bytes("quiet"), bytes("one"), "the same numbers whatever the number of threads");

    let csv = desk.run(&["fit", "a/run.csv", "--format", "csv", "--out", "csv"]);
    let lines: Vec<&str> = csv.is_done().out.lines().collect();
    assert!(lines[0].starts_with("method,K [1/s],") && lines.len() == 1 + DEFAULT_METHODS.len(), "{}", csv.out);
    let latex = desk.run(&["fit", "a/run.csv", "--format", "latex", "--out", "latex"]);
    assert!(
        latex.is_done().out.starts_with("% Needs \\usepackage{booktabs,siunitx")
            && latex.out.ends_with("\\end{table}\n"),
        "{}",
        latex.out
    );
    let markdown = desk.run(&["fit", "a/run.csv", "--format", "markdown", "--out", "markdown"]);
    assert!(markdown.is_done().out.starts_with("| method"), "{}", markdown.out);
}

/// A closed pipe (`study list effects | head -1`) ends the output without an error.
#[test]
fn a_closed_pipe_ends_the_output_quietly() {
    let desk = Desk::new();
    desk.file("good.csv", zig_zag_csv());
    for arguments in [&["list", "effects"][..], &["fit", "good.csv", "--method", "srivc"][..]] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_study"))
            .args(arguments)
            .current_dir(desk.path(""))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        drop(child.stdout.take());
        let errors = BufReader::new(child.stderr.take().expect("piped"));
        let errors: Vec<String> = errors.lines().map(|line| line.expect("UTF-8")).collect();
        assert!(child.wait().expect("it ends").success(), "{errors:?}");
        assert!(!errors.iter().any(|line| line.contains("panicked") || line.starts_with("error")), "{errors:?}");
    }
}

#[test]
fn every_measured_record_can_be_identified() {
    let Some(data) = measured() else { return };
    let desk = Desk::new();
    for (set, record, words) in [
        // Here the random moment of maximum likelihood explains the whole manoeuvre: δ_r = 75°, replay error 38°.
        ("esso_osaka", "zigzag_13_57_45", "Not used: maximum-likelihood, because it explains part of the manoeuvre"),
        // Here maximum likelihood has no interval and a replay error of 66°.
        ("esso_osaka", "zigzag_13_04_24", "° from output-error, because its replay is closest"),
        (
            "esso_osaka",
            "turning_sep14_13_51_45",
            "No K and T can be taken from this record, because the best replay (least-squares) misses",
        ),
        ("kvlcc2_hsva", "zigzag_20_10_s", "from output-error"),
        ("kvlcc2_hsva", "zigzag_10_10_s", "from output-error"),
        ("kvlcc2_marin", "zigzag_20", "from output-error"),
        ("kvlcc2_marin", "turning_35", "from output-error"),
    ] {
        let path = data.join(set).join(record).with_extension("csv").display().to_string();
        let sidecars = of_repository("scenarios/measured").display().to_string();
        let run = desk.run(&["fit", &path, "--columns", &sidecars]);
        assert!(run.is_done().out.contains(words), "{record}\n{}", run.out);
        assert!(desk.path(&format!("{record}-fit")).join("fit.json").is_file(), "{record}");
    }
}
