//! Tests of input and output for programs: a JSON document on standard output, a record on standard input, tables of
//! numbers, exit codes.

use std::io::Write;
use std::process::Stdio;

use serde_json::Value;

use crate::desk::{Desk, interrupted, of_repository, with_column, zig_zag_csv};
use crate::schemas;

/// JSON document on standard output, printed also with `--quiet`. Panics if there is any other output.
fn document(desk: &Desk, arguments: &[&str]) -> Value {
    let run = desk.run(&[arguments, &["--format", "json", "--quiet"]].concat());
    assert_eq!(run.is_done().err, "", "{arguments:?}");
    serde_json::from_str(&run.is_done().out).unwrap_or_else(|error| panic!("{arguments:?}: {error}\n{}", run.out))
}

#[test]
fn an_analysis_says_on_standard_output_what_is_in_its_file() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv());
    for (arguments, file) in [
        (&["fit", "run.csv", "--method", "output-error", "--out", "f"][..], "f/fit.json"),
        (&["trace", "run.csv", "--out", "t"], "t/trace.json"),
        (&["predict", "f/fit.json", "--draws", "50", "--manoeuvre", "zig-zag:10/10", "--out", "p"], "p/predict.json"),
    ] {
        let run = desk.run(&[arguments, &["--format", "json"]].concat());
        assert!(run.is_done().out.as_bytes() == desk.bytes(file), "{arguments:?}");
    }
}

#[test]
fn every_command_has_a_document() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv());
    desk.file("other.csv", zig_zag_csv().replace("heading_deg", "Heading"));
    let scenario = of_repository("scenarios/records/sample.toml").display().to_string();
    let small = "
question = \"Is there a document?\"
seed = 1
replicates = 2
ship.yukun = {}
manoeuvre.zig-zag = { rudder-deg = 10.0, heading-deg = 10.0 }
recording = { sampling-s = 2.0, duration-s = 200.0 }
sensor.heading-noise-deg = 0.1
[[identifier]]
method.integral-least-squares = {}
";
    desk.file("small.toml", small);
    for (arguments, schema) in [
        (&["small.toml", "--out", "s/small"][..], "study/1"),
        (&["report", "s/small"], "study/1"),
        (&["small.toml", "--shard", "1/1", "--out", "a"], "shard/1"),
        (&["report", "a"], "study/1"),
        (&["check", &scenario, "--resolved"], "check/1"),
        (&["find", "run.csv"], "find/1"),
        (&["inspect", "run.csv"], "inspect/1"),
        (&["sidecar", "other.csv"], "sidecar/1"),
        (&["simulate", "small.toml", "--replicate", "all", "--out", "r"], "simulate/1"),
        (&["list", "effects"], "list/1"),
        (&["list", "keys"], "list/1"),
    ] {
        let document = document(&desk, arguments);
        assert_eq!(document["schema"], schema, "{arguments:?}");
        let (name, _) = schema.split_once('/').expect("a version");
        schemas::hold(if name == "sidecar" { "sidecar-answer" } else { name }, &desk.path(name), &document);
    }
    for (arguments, schema) in
        [(&["doctor"][..], "doctor/1"), (&["completions", "bash"], "completions/1"), (&["man", "pages"], "man/1")]
    {
        assert_eq!(document(&desk, arguments)["schema"], schema);
    }
    assert!(document(&desk, &["schema", "fit"])["properties"].is_object());
    let study = document(&desk, &["report", "s/small"]);
    assert_eq!(study["manifest"]["name"], "small");
    let [line] = &study["summary"].as_array().expect("a list")[..] else { panic!("one method: {study}") };
    assert!(line["method"] == "integral-least-squares" && line["trials"] == 2, "{line}");
    assert!(line["K rms error [%]"].as_f64().is_some_and(|error| error > 0.0), "{line}");
    let found = document(&desk, &["find", "run.csv"]);
    assert_eq!(found["logs"][0]["manoeuvres"][0]["kind"], "zig-zag 10/10");
    let faulty = of_repository("tests/logs/frozen.csv").display().to_string();
    assert_eq!(document(&desk, &["find", &faulty])["warnings"][0]["severity"], "mended");
    let checked = document(&desk, &["check", &scenario, "--resolved"]);
    assert!(checked["scenarios"][0]["resolved"]["steering-gear"]["rate-deg-s"].is_number(), "{checked}");
    assert_eq!(
        std::fs::read_dir(desk.path("pages")).expect("pages").count(),
        document(&desk, &["man", "pages"])["files"].as_array().expect("files").len()
    );
}

/// Entry `error` of the JSON document on standard error. Panics if the document violates its schema or has another exit
/// code.
fn error(desk: &Desk, arguments: &[&str]) -> Value {
    let run = desk.run(&[arguments, &["--format", "json", "--quiet"]].concat());
    let document: Value = serde_json::from_str(&run.err).unwrap_or_else(|fault| panic!("{fault}: {}", run.err));
    schemas::hold("error", &desk.path("error"), &document);
    assert_eq!(document["exit_code"].as_i64(), run.code.map(i64::from), "{document}");
    assert_eq!(document["error"]["severity"], "error", "{document}");
    document["error"].clone()
}

#[test]
fn what_goes_wrong_is_an_object_for_programs() {
    let desk = Desk::new();
    desk.file("bad.csv", "t_s,heading_deg\n0,1\n");
    desk.file("bad.toml", "question = \"Why?\"\nseed = -1\n");
    let missing = error(&desk, &["fit", "none.csv"]);
    assert!(missing["file"] == "none.csv" && missing["blame"] == "input", "{missing}");
    assert_eq!(missing["code"], "not-found");
    assert!(!missing["problem"].as_str().expect("words").contains("none.csv"), "{missing}");
    let short = error(&desk, &["fit", "bad.csv"]);
    assert_eq!((&short["file"], &short["code"]), (&"bad.csv".into(), &"missing-channel".into()));
    for (file, scale, code) in [("per-cent.csv", 12.0, "angle-scale"), ("flipped.csv", -1.0, "rudder-sign")] {
        desk.file(file, with_column(&zig_zag_csv(), "rudder_deg", |_, delta| (scale * delta).to_string()));
        assert_eq!(error(&desk, &["fit", file])["code"], code);
    }
    let place = error(&desk, &["bad.toml"]);
    assert_eq!((&place["file"], &place["line"], &place["column"]), (&"bad.toml".into(), &2.into(), &8.into()));
    assert!(place["expected"].is_string() && place["help"].is_string(), "{place}");
    assert_eq!(place["code"], "scenario");
    desk.file("bad.trial.toml", "[table]\nheadr = false\n");
    let sidecar = error(&desk, &["fit", "bad.csv"]);
    assert_eq!((&sidecar["file"], &sidecar["line"]), (&"bad.trial.toml".into(), &2.into()), "{sidecar}");
    assert_eq!(sidecar["code"], "sidecar");
    let full = error(&desk, &["doctor", "--out", "bad.csv"]);
    assert!(full["message"].as_str().expect("words").contains("bad.csv") && full["code"] == "work", "{full}");
    // The message on a wrong option has no usage text.
    let option = error(&desk, &["fit", "bad.csv", "--draws", "1"]);
    assert!(option["problem"].as_str().expect("words").contains("--draws"), "{option}");
    assert_eq!(option["code"], "usage");
    assert!(!option["message"].as_str().expect("words").contains("Usage"), "{option}");
    let command = error(&desk, &["fti"]);
    assert!(command["problem"].as_str().expect("words").contains("no command `fti`"), "{command}");
    // Without --format json a failure is text.
    desk.run(&["fit", "none.csv"]).is_refused(2, &["none.csv"]);
    desk.run(&["check", "bad.toml", "--format", "text"]).is_refused(2, &["seed"]);
    desk.run(&["fit", "bad.csv", "--replicates", "1"]).is_refused(2, &["--replicates", "Usage: study fit"]);
}

/// A command that waits for more input ends on Ctrl-C with the exit code 130, as in shells.
#[cfg(unix)]
#[test]
fn ctrl_c_is_exit_code_130_in_every_command() {
    let desk = Desk::new();
    let rows: String = (0..50_000).map(|row| format!("{row},0,0\n")).collect();
    let table = format!("t_s,heading_deg,rudder_deg\n{rows}");
    for command in ["fit", "trace", "find", "predict"] {
        let mut child = desk.command(&[command, "-"]);
        let mut run = child.stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
        let mut input = run.stdin.take().expect("it is piped");
        // The input is larger than a pipe: when all is written, the program has read some of it.
        input.write_all(table.as_bytes()).expect("it reads");
        let (run, _) = interrupted(run);
        assert_eq!((run.code, run.err.as_str()), (Some(130), ""), "{command}");
    }
}

/// `--quiet` silences notes, warnings and the table, but not the output that `--format` requests.
#[test]
fn quiet_silences_all_but_what_was_asked_for() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv());
    let fit = ["fit", "run.csv", "--validate", "run.csv", "--method", "output-error", "--quiet"];
    let said = |format: &str| {
        let run = desk.run(&[&fit[..], &["--format", format]].concat());
        assert_eq!(run.is_done().err, "", "{format}: the record validates nothing, and nobody is told");
        run.out
    };
    assert_eq!(said("text"), "");
    assert!(said("csv").starts_with("method,K [1/s]") && said("markdown").starts_with("| method"));
    let stored = desk.text("run-fit/fit.json");
    assert_eq!(said("json"), stored);
    let piped = desk.run_with_input(&["fit", "-", "--format", "json", "--quiet"], zig_zag_csv());
    assert_eq!(piped.is_done().out, desk.text("stdin-fit/fit.json"));
    assert!(desk.run(&fit[..6]).err.contains("validates nothing"), "without it all are told");
    assert_eq!(desk.run(&["find", "run.csv", "--quiet"]).is_done().out, "");
}

#[test]
fn a_model_on_standard_input_is_predicted_into_a_folder_of_that_name() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv());
    desk.run(&["fit", "run.csv", "--method", "output-error", "--out", "f", "--quiet"]).is_done();
    let predict = ["predict", "-", "--draws", "50", "--manoeuvre", "zig-zag:10/10", "--format", "json"];
    let run = desk.run_with_input(&predict, desk.bytes("f/fit.json"));
    assert_eq!(run.is_done().out, desk.text("stdin-predict/predict.json"));
    assert!(run.out.contains("\"file\": \"stdin\""), "{}", run.out);
    desk.run_with_input(&["predict", "-"], "{").is_refused(2, &["stdin: this is no JSON"]);
}

#[test]
fn a_record_comes_from_standard_input() {
    let desk = Desk::new();
    let csv = zig_zag_csv();
    desk.file("run.csv", &csv);
    let arguments = ["--method", "output-error", "--format", "json"];
    let of_file = desk.run(&[&["fit", "run.csv"][..], &arguments].concat());
    let of_input = desk.run_with_input(&[&["fit", "-"][..], &arguments].concat(), &csv);
    let parameters = |text: &str| {
        let document: Value = serde_json::from_str(text).expect("JSON");
        (document["methods"][0]["parameters"].clone(), document["trials"][0]["sha256"].clone())
    };
    assert_eq!(parameters(&of_input.is_done().out), parameters(&of_file.is_done().out));
    assert!(desk.path("stdin-fit/fit.json").is_file(), "it is called stdin");
    assert!(desk.run_with_input(&["find", "-"], &csv).is_done().out.contains("zig-zag 10/10"));
    let described = desk.run_with_input(&["sidecar", "-"], "time;Ruder\n0;1\n1;2\n");
    assert!(described.is_done().out.contains("[[column]]"), "{}", described.out);
    desk.run_with_input(&["fit", "-", "-"], &csv).is_refused(2, &["standard input holds one record"]);
    desk.run_with_input(&["fit", "-"], "").is_refused(2, &["stdin"]);
}

#[test]
fn a_table_of_a_fit_has_numbers_alone() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv());
    let run = desk.run(&["fit", "run.csv", "--method", "output-error", "--method", "srivc", "--format", "csv"]);
    let mut lines = run.is_done().out.lines();
    let head: Vec<&str> = lines.next().expect("a header").split(',').collect();
    assert_eq!(head[..4], ["method", "K [1/s]", "K lower 95 [1/s]", "K upper 95 [1/s]"]);
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), head.len(), "{line}");
        assert!(cells[1..].iter().all(|cell| cell.parse::<f64>().is_ok()), "{line}");
    }
}

#[test]
fn shells_and_manuals_know_every_command() {
    let desk = Desk::new();
    let help = desk.run(&["--help"]).is_done().out.clone();
    let commands: Vec<&str> = help
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' '))?.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect();
    assert!(commands.len() > 14, "{commands:?}");
    desk.run(&["man", "pages"]).is_done();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = desk.run(&["completions", shell]).is_done().out.clone();
        commands.iter().for_each(|name| assert!(script.contains(name), "{shell}: {name}"));
        // Values of options that name a method, an effect, a task.
        let values = ["maximum-likelihood", "nonlinear_damping", "other-amplitude", "straight-on", "posterior"];
        let wanted = values.iter().filter(|_| ["bash", "zsh", "fish"].contains(&shell));
        wanted.for_each(|value| assert!(script.contains(value), "{shell}: {value}"));
    }
    for name in &commands {
        let page = desk.text(&format!("pages/study-{name}.1"));
        assert!(page.contains(".SH SYNOPSIS") && page.contains(".SH OPTIONS"), "{name}");
    }
}

#[test]
fn a_doctor_who_cannot_write_says_so() {
    let desk = Desk::new();
    desk.file("file", "");
    let run = desk.run(&["doctor", "--out", "file"]);
    assert!(run.code != Some(0) && run.err.starts_with("error: "), "{}", run.err);
    assert!(desk.run(&["doctor"]).is_done().out.contains("instruction set"));
    assert!(desk.run(&["--version"]).is_done().out.starts_with(concat!("study ", env!("CARGO_PKG_VERSION"))));
}

/// Output to a pipe has no colours, which are for terminals.
#[test]
fn what_is_piped_has_no_colours() {
    let desk = Desk::new();
    let run = desk.run(&["fit", "none.csv"]);
    assert!(!run.err.contains('\u{1b}'), "{}", run.err);
}
