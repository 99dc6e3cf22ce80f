//! What programs see: one JSON document on standard output, a record on standard input, tables of numbers.

use serde_json::Value;

use crate::desk::{Desk, of_repository, zig_zag_csv};

/// The one document on standard output.
fn document(desk: &Desk, arguments: &[&str]) -> Value {
    let run = desk.run(&[arguments, &["--format", "json"]].concat());
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
        (&["small.toml", "--shard", "1/2", "--out", "a"], "shard/1"),
        (&["small.toml", "--shard", "2/2", "--out", "b"], "shard/1"),
        (&["merge", "a", "b", "--out", "m"], "study/1"),
        (&["overview", "s"], "overview/1"),
        (&["check", &scenario, "--resolved"], "check/1"),
        (&["find", "run.csv"], "find/1"),
        (&["sidecar", "other.csv"], "sidecar/1"),
        (&["simulate", "small.toml", "--replicate", "all", "--out", "r"], "simulate/1"),
        (&["list", "effects"], "list/1"),
        (&["list", "keys"], "list/1"),
        (&["doctor"], "doctor/1"),
        (&["completions", "bash"], "completions/1"),
        (&["man", "pages"], "man/1"),
    ] {
        assert_eq!(document(&desk, arguments)["schema"], schema, "{arguments:?}");
    }
    assert!(document(&desk, &["schema", "fit"])["properties"].is_object());
    let study = document(&desk, &["report", "s/small"]);
    assert_eq!(study["manifest"]["name"], "small");
    let [line] = &study["summary"].as_array().expect("a list")[..] else { panic!("one method: {study}") };
    assert!(line["method"] == "integral-least-squares" && line["trials"] == 2, "{line}");
    assert!(line["K rms error [%]"].as_f64().is_some_and(|error| error > 0.0), "{line}");
    let found = document(&desk, &["find", "run.csv"]);
    assert_eq!(found["logs"][0]["manoeuvres"][0]["kind"], "zig-zag 10/10");
    let checked = document(&desk, &["check", &scenario, "--resolved"]);
    assert!(checked["scenarios"][0]["resolved"]["steering-gear"]["rate-deg-s"].is_number(), "{checked}");
    assert_eq!(
        std::fs::read_dir(desk.path("pages")).expect("pages").count(),
        document(&desk, &["man", "pages"])["files"].as_array().expect("files").len()
    );
}

/// What is wrong is said as always: nothing on standard output, one message, the exit code.
#[test]
fn an_error_is_no_document() {
    let desk = Desk::new();
    desk.run(&["fit", "none.csv", "--format", "json"]).is_refused(2, &["none.csv"]);
    desk.run(&["check", desk.file("bad.toml", "seed = 1\n"), "--format", "text"]).is_refused(2, &["question"]);
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

/// Colours are for terminals: what is piped has none, whatever the environment asks for.
#[test]
fn what_is_piped_has_no_colours() {
    let desk = Desk::new();
    let run = desk.run(&["fit", "none.csv"]);
    assert!(!run.err.contains('\u{1b}'), "{}", run.err);
}
