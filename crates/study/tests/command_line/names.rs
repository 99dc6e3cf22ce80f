//! Tests of names, labels and options: those that no folder, figure or page can hold are refused before any trial runs,
//! and control characters of the input do not reach the terminal.

use crate::desk::{Desk, of_repository, zig_zag_csv};

fn yukun() -> String {
    std::fs::read_to_string(of_repository("scenarios/yukun.toml")).expect("it is there")
}

#[test]
fn a_study_is_called_by_a_name_and_not_by_a_path() {
    let desk = Desk::new();
    for name in ["...toml", ".hidden.toml", "a?.toml", &format!("{}.toml", "x".repeat(200))] {
        desk.file(name, yukun());
        desk.run(&[name]).is_refused(2, &["its results cannot be called", "rename the file"]);
    }
    let manifest =
        std::fs::read_to_string(of_repository("results/published/noise/manifest.toml")).expect("it is there");
    let absolute = desk.path("absolute").display().to_string();
    for name in ["../../escaped", absolute.as_str(), "..", ""] {
        desk.file("a/b/manifest.toml", manifest.replace("name = \"noise\"", &format!("name = \"{name}\"")));
        let parts = ["manifest.toml:2", &format!("`name` is \"{}", &name[..name.len().min(40)]), "expected"];
        desk.run(&["a/b/manifest.toml"]).is_refused(2, &parts);
    }
    desk.file("figure.toml", yukun().replace("figure = \"", "figure = \"../"));
    desk.run(&["check", "figure.toml"]).is_refused(2, &["`output.figure` is \"../violins-10-20-mid-trial\"", "no `/`"]);
    desk.file("...csv", zig_zag_csv());
    desk.run(&["fit", "...csv"]).is_refused(2, &["its results cannot be called \"..\""]);
    desk.run(&["trace", "...csv"]).is_refused(2, &["its results cannot be called \"..\""]);
    let mut found: Vec<_> =
        std::fs::read_dir(desk.path("")).expect("readable").flatten().map(|e| e.file_name()).collect();
    found.retain(|name| !name.to_string_lossy().contains(".toml") && name != "...csv" && name != "a");
    assert!(found.is_empty(), "nothing is written: {found:?}");
}

#[test]
fn a_label_that_no_figure_can_carry_is_refused_before_the_trials() {
    let refused = |added: &str, parts: &[&str]| {
        let desk = Desk::new();
        desk.file("case.toml", yukun() + added);
        desk.run(&["case.toml"]).is_refused(2, &[&["case.toml:"], parts].concat());
        assert!(!desk.path("results").exists(), "{added}");
    };
    let long = "x".repeat(81);
    for (label, unfit) in [
        ("\\uFFFE", "holds \\u{fffe}"),
        ("\\u001b[31mred", "holds \\u{1b}"),
        ("\\u0000", "holds \\u{0}"),
        ("\\u202Eabc", "holds \\u{202e}"),
        ("a\\nb", "holds \\u{a}"),
        (" ", "not blank"),
        (&long, "at most 80 characters, this text has 81"),
    ] {
        let sweep = |points: &str| format!("\n[[sweep]]\nname = \"x\"\npoints = [{points}]\n");
        let set = "set = { \"sensor.heading-noise-deg\" = 0.2 }";
        refused(&sweep(&format!("{{ label = \"{label}\", {set} }}")), &["`sweep.1.points.0.label` is", unfit]);
        refused(
            &format!("\n[[sweep]]\nname = \"{label}\"\nkey = \"sensor.heading-noise-deg\"\nvalues = [0.1]\n"),
            &["`sweep.1.name` is", unfit],
        );
        let method = format!("\n[[identifier]]\nlabel = \"{label}\"\nmethod.srivc = {{}}\n");
        refused(&method, &[".label` is", unfit]);
    }
    refused(
        &format!("\n[[sweep]]\nkey = \"manoeuvre.replay.file\"\nvalues = [\"{long}\"]\n"),
        &["`sweep.1.values.0` is", "`label` under `points`"],
    );
    let axis = |key: &str| {
        let label = "y".repeat(80);
        format!("\n[[sweep]]\nname = \"{key}\"\npoints = [{{ label = \"{label}\", set = {{ \"{key}\" = 0.1 }} }}]\n")
    };
    let axes = ["sensor.heading-noise-deg", "sensor.rudder-noise-deg", "sensor.jitter-s"].map(axis).concat();
    refused(&axes, &["characters together", "at most 180"]);
}

#[test]
fn nothing_in_the_input_acts_on_the_terminal() {
    let desk = Desk::new();
    let escape = "\u{1b}]0;x\u{7}\u{202e}";
    desk.file("question.toml", yukun().replacen("question = \"", "question = \"\\u001b[31m", 1));
    desk.run(&["check", "question.toml"]).is_refused(2, &["`question` is", "\\u{1b}"]);
    desk.file("comment.toml", yukun().replacen("question = ", &format!("\"{escape}\" = 1\nquestion = "), 1));
    let rows = zig_zag_csv();
    desk.file("header.csv", rows.replacen("rudder_deg", &format!("rud{escape}"), 1));
    desk.file("cell.csv", rows.replacen("0,0,0", &format!("0,{escape},0"), 1));
    let odd = format!("a{escape}.csv");
    desk.file(&odd, &rows);
    for arguments in [
        &["check", "comment.toml"][..],
        &["check", &odd],
        &["fit", "header.csv"],
        &["fit", "cell.csv"],
        &["fit", &odd],
        &["fit", "header.csv", "--method", escape],
        &["list", escape],
    ] {
        let run = desk.run(arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}: {}", run.err);
        let acts = |c: char| c != '\n' && (c.is_control() || c == '\u{202e}');
        assert!(!run.err.contains(acts) && !run.out.contains(acts), "{arguments:?}: {:?}", run.err);
    }
}

#[test]
fn a_page_that_cannot_be_printed_is_refused_before_the_trials() {
    let desk = Desk::new();
    desk.file("small.toml", yukun());
    for (option, value, expected) in [
        ("--paper", "10", "from 60 to 400"),
        ("--paper", "-5", "from 60 to 400"),
        ("--paper", "nan", "from 60 to 400"),
        ("--paper", "A4", "from 60 to 400"),
        ("--dpi", "5", "from 72 to 1200"),
    ] {
        let page: &[&str] = if option == "--dpi" { &["--paper", "85"] } else { &[] };
        for command in [&["small.toml"][..], &["report", "missing"], &["trace", "missing.csv"]] {
            desk.run(&[command, page, &[option, value]].concat()).is_refused(2, &[option, value, expected]);
        }
    }
    assert!(!desk.path("results").exists());
}

/// Records have separate figures even if their names differ only in letters that file names of figures leave out.
#[test]
fn records_in_any_script_have_figures_of_their_own() {
    let desk = Desk::new();
    for name in ["a.csv", "船.csv", "鄱.csv"] {
        desk.file(name, zig_zag_csv());
    }
    desk.draw(&["trace", "a.csv", "船.csv", "鄱.csv", "--out", "t", "--quiet"]).is_done();
    let files = std::fs::read_dir(desk.path("t")).expect("readable").flatten();
    let records = files.filter(|file| {
        let name = file.file_name().to_string_lossy().into_owned();
        name.starts_with("record") && name.ends_with(".svg")
    });
    assert_eq!(records.count(), 3);
}
