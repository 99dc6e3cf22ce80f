//! Tests of `study fit` on a usable record: methods, verdict, warnings, output with and without figures.

use identify::registry::{self, DEFAULT_METHODS};
use serde_json::Value;

use crate::desk::{Desk, of_repository, with_column, zig_zag_csv};

/// Without `--method` only the usual methods run: not `srivc`, which equals `output-error`, and not
/// `fourier-published`, whose T is biased. `--method all` runs every method and gives the same verdict.
#[test]
fn fit_asks_the_usual_methods_and_all_on_request() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv());
    let fitted = |options: &[&str], folder: &str| {
        let own = ["fit", "run.csv", "--figures", "none", "--quiet", "--out", folder];
        desk.run(&[&own, options].concat()).is_done();
        let fit = desk.json(&format!("{folder}/fit.json"));
        let ids = fit["methods"].as_array().into_iter().flatten().filter_map(|own| own["method"].as_str());
        (ids.map(str::to_owned).collect::<Vec<String>>(), fit["verdict"].clone())
    };
    let (usual, verdict) = fitted(&[], "usual");
    let (all, with_all) = fitted(&["--method", "all"], "all");
    assert_eq!(usual, DEFAULT_METHODS);
    assert!(all.starts_with(&usual) && all.len() == registry::default_settings().len(), "{all:?}");
    assert!(["method", "reason", "residual", "residual_deg"].iter().all(|key| verdict[*key] == with_all[*key]));
    let fit = desk.json("all/fit.json");
    let taken = fit["methods"].as_array().into_iter().flatten().find(|own| own["method"] == verdict["method"]);
    let parameters = &taken.expect("the method of the verdict")["parameters"];
    assert!(["K_per_s", "T_s"].iter().all(|key| verdict[*key] == parameters[*key] && verdict[*key]["ci95"].is_array()));
    let (asked, _) = fitted(&["--method", "srivc", "--method", "output-error"], "asked");
    assert_eq!(asked, ["output-error", "srivc"]);
    desk.run(&["fit", "run.csv", "--method", "al"]).is_refused(2, &["--method al", "use all, or one of output-error"]);
}

#[test]
fn what_can_be_drawn_can_be_told_without_figures() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv());
    let fast = ["--figures", "none", "--quiet"];
    for (command, document) in [
        (&["fit", "run.csv", "--method", "output-error", "--out", "fit"][..], "fit/fit.json"),
        (&["trace", "run.csv", "--only", "second_order", "--out", "trace"], "trace/trace.json"),
        (
            &["predict", "fit/fit.json", "--manoeuvre", "zig-zag:10/10", "--draws", "50", "--out", "predict"],
            "predict/predict.json",
        ),
    ] {
        desk.run(&[command, &fast].concat()).is_done();
        let folder = document.split('/').next().expect("a folder");
        let files = std::fs::read_dir(desk.path(folder)).expect("a folder").map(|entry| entry.expect("a file").path());
        let drawn: Vec<_> =
            files.filter(|file| file.extension().is_some_and(|own| own == "png" || own == "svg")).collect();
        assert!(drawn.is_empty() && desk.path(document).is_file(), "{drawn:?}");
        let report = desk.text(&format!("{folder}/report.md"));
        assert!(desk.path(&format!("{folder}/report.html")).is_file() && !report.contains("!["), "{report}");
        assert!(!report.contains("igures\n"), "a headline over nothing\n{report}");
    }
    let bytes = desk.bytes("fit/fit.json");
    desk.draw(&["fit", "run.csv", "--method", "output-error", "--out", "fit", "--quiet"]).is_done();
    assert!(desk.path("fit/fit.png").is_file() && desk.bytes("fit/fit.json") == bytes);
}

/// Warnings of the reader about corrected or doubtful readings are in `fit.json` and in `report.md`.
#[test]
fn what_the_reader_noticed_is_in_the_document() {
    let desk = Desk::new();
    for (log, said, code, severity) in [
        ("frozen.csv", "the heading is frozen from", "missing-values", "mended"),
        ("checksums.nmea", "checksum", "left-out", "mended"),
        ("spike.csv", "1 row with an impossible rudder angle", "rejected-readings", "mended"),
        ("gaps.csv", "gaps longer than ten sampling periods", "gap", "doubt"),
    ] {
        let path = of_repository("tests/logs").join(log).display().to_string();
        let own = ["fit", &path, "--method", "least-squares", "--figures", "none", "--quiet", "--out", log];
        desk.run(&own).is_done();
        let warnings = desk.json(&format!("{log}/fit.json"))["warnings"].clone();
        let told = |own: &Value| own["text"].as_str().is_some_and(|text| text.contains(said));
        let own =
            warnings.as_array().into_iter().flatten().find(|own| told(own)).unwrap_or_else(|| panic!("{warnings}"));
        assert_eq!((&own["code"], &own["severity"]), (&Value::from(code), &Value::from(severity)), "{log}");
        assert_eq!(own["source"]["record"], path.as_str());
        assert!(desk.text(&format!("{log}/report.md")).contains(said), "{log}");
    }
}

/// The most severe warnings come first; the screen has three of them, the page all. Warnings of methods other than that
/// of the verdict are notes.
#[test]
fn warnings_are_few_and_the_dearest_first() {
    let desk = Desk::new();
    let jumped = with_column(&zig_zag_csv(), "heading_deg", |row, psi| match row {
        100 => "-999".into(),
        250.. => (psi + 40.0).to_string(),
        _ => psi.to_string(),
    });
    let wild =
        with_column(&jumped, "rudder_deg", |row, delta| if row == 150 { "-327".into() } else { delta.to_string() });
    desk.file("run.csv", format!("Motor vessel\nTrial 1\n{}", wild.replacen("heading_deg", "Heading [deg]", 1)));
    let run = desk.run(&["fit", "run.csv", "--figures", "none"]);
    let lines: Vec<&str> = run.is_done().err.lines().filter(|line| line.starts_with("warning: ")).collect();
    let (report, fit) = (desk.text("run-fit/report.md"), desk.json("run-fit/fit.json"));
    let all: Vec<&Value> = fit["warnings"].as_array().into_iter().flatten().collect();
    let places: Vec<_> =
        all.iter().map(|own| ["doubt", "choice", "mended"].iter().position(|it| own["severity"] == *it)).collect();
    assert!(places.is_sorted() && places.iter().all(Option::is_some), "{all:?}");
    let of_other = |own: &&&Value| own["source"]["method"].as_str().is_some_and(|id| fit["verdict"]["method"] != id);
    let noticed = all.len() - all.iter().filter(of_other).count();
    assert!(noticed > 3 && lines.len() == 4 && lines[0].contains("the heading jumps"), "{lines:?}");
    let more = lines[3].strip_prefix("warning: ").and_then(|line| line.strip_suffix(" more in report.md"));
    assert!(more.and_then(|more| more.parse::<usize>().ok()).is_some_and(|more| more + 3 == noticed), "{lines:?}");
    let part = |title: &str| report.split("\n## ").find(|part| part.starts_with(title)).unwrap_or_default();
    for said in
        ["the heading jumps", "-999", "lines before the header", "impossible rudder angle", "recognised by their names"]
    {
        assert!(part("Warnings").contains(said), "{said}\n{report}");
    }
    assert!(!run.err.contains("least-squares: ") && part("Notes").contains("least-squares: "), "{report}");
}
