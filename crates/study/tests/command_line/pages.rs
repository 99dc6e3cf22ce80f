//! Tests of `report.html`: a single file next to every `report.md`, with all its figures and without external
//! resources.

use report::number::MISSING;

use crate::desk::{Desk, zig_zag_csv, zig_zag_csv_of};
use crate::scenarios::GOOD;
use crate::traces::second_order;

/// Text of the `report.html` of a folder. Panics if it lacks a figure of `report.md`, is too large or loads a resource.
fn page(desk: &Desk, folder: &str) -> String {
    let read = |name: &str| desk.text(&format!("{folder}/{name}"));
    let (markdown, page) = (read("report.md"), read("report.html"));
    assert!(page.len() < 2_000_000, "{folder}: {} bytes", page.len());
    assert_eq!(page.matches("<figure>").count(), markdown.matches("![").count(), "{folder}");
    for resource in ["src=\"http", "src=\"/", "@import", "<link", "<iframe", "xlink"] {
        assert!(!page.contains(resource), "{folder}: {resource}");
    }
    // References in a figure begin with the number of its caption, so those of two figures differ.
    assert_eq!(page.matches("url(").count(), page.matches("url(#caption-").count(), "{folder}");
    page
}

#[test]
fn every_report_has_a_page_for_a_browser() {
    let desk = Desk::new();
    desk.file("small.toml", GOOD);
    desk.file("run.csv", zig_zag_csv());
    desk.run(&["small.toml", "--out", "s", "--quiet"]).is_done();
    desk.draw(&["fit", "run.csv", "--out", "f", "--quiet"]).is_done();
    desk.draw(&["trace", "run.csv", "--out", "t", "--quiet"]).is_done();
    desk.draw(&["predict", "t/trace.json", "--out", "p", "--quiet"]).is_done();
    for folder in ["s", "f", "t", "p"] {
        page(&desk, folder);
    }
    let fit = page(&desk, "f");
    assert!(fit.contains("data-series=\"output-error, rms") && fit.contains("<th scope=\"row\">output-error</th>"));
    let traced = page(&desk, "t");
    assert!(traced.contains("data-series=\"before") && traced.contains("data-series=\"after"));
    desk.file("other.csv", zig_zag_csv());
    desk.draw(&["fit", "run.csv", "--validate", "other.csv", "--out", "f", "--quiet"]).is_done();
    let of_other = ["fit-other.png", "fit-other.svg", "replay-other.csv"].map(|name| desk.path("f").join(name));
    assert!(of_other.iter().all(|path| path.is_file()));
    desk.draw(&["fit", "run.csv", "--out", "f", "--quiet"]).is_done();
    assert_eq!(page(&desk, "f"), fit, "the same bytes");
    assert!(!of_other.iter().any(|path| path.exists()), "what an earlier fit left");
    desk.run(&["trace", "run.csv", "--out", "f"]).is_refused(2, &["f/fit.json", "another command", "--out"]);
    desk.run(&["small.toml", "--out", "f"]).is_refused(2, &["f/fit.json", "another command", "--out"]);
}

#[test]
fn limits_of_an_axis_that_no_figure_has_are_refused() {
    let desk = Desk::new();
    desk.file("run.csv", zig_zag_csv());
    desk.file("style.toml", "[limits]\n\"residual [°]\" = [-1.0, 1.0]\n");
    desk.draw(&["fit", "run.csv", "--style", "style.toml"]).is_done();
    desk.file("style.toml", "[limits]\n\"residual\" = [-1.0, 1.0]\n");
    desk.draw(&["fit", "run.csv", "--style", "style.toml"])
        .is_refused(2, &["[limits] \"residual\"", "no figure of this page has an axis", "\"residual [°]\""]);
}

/// Identifiers in a text: words with `_`, which pages and figures must not show.
fn identifiers(text: &str) -> Vec<&str> {
    let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
    // A single letter before `_` is a symbol with its index.
    words
        .filter(|word| word.split_once('_').is_some_and(|(head, tail)| head.chars().count() > 1 && !tail.is_empty()))
        .collect()
}

/// Parts of a text outside the pairs of the marks `open` and `close`.
fn outside<'a>(text: &'a str, [open, close]: [&str; 2]) -> impl Iterator<Item = &'a str> {
    text.split(open).enumerate().map(move |(number, part)| match number {
        0 => part,
        _ => part.split_once(close).map_or("", |(_, rest)| rest),
    })
}

#[test]
fn no_page_and_no_figure_holds_an_identifier() {
    let desk = Desk::new();
    desk.file("zigzag_20_10_s.csv", zig_zag_csv_of(&second_order()));
    desk.file("zigzag_10_10_p.csv", zig_zag_csv());
    let traced = "[[effect]]\nsecond_order = { T2-s = 2.5, T3-s = 6.2 }\n\n[[identifier]]\ntrace = {}\n\n[[identifier]]\nmethod.output-error";
    desk.file("small.toml", GOOD.replace("[[identifier]]\nmethod.output-error", traced));
    let records = ["zigzag_20_10_s.csv", "--validate", "zigzag_10_10_p.csv", "--quiet", "--out"];
    desk.draw(&[["fit"].as_slice(), &records, &["f"]].concat()).is_done();
    desk.draw(&[["trace"].as_slice(), &records, &["t"]].concat()).is_done();
    desk.draw(&["predict", "t/trace.json", "--out", "p", "--quiet"]).is_done();
    desk.run(&["small.toml", "--out", "s", "--quiet"]).is_done();
    for folder in ["f", "t", "p", "s"] {
        let markdown = desk.text(&format!("{folder}/report.md")).replace('\\', "");
        let prose: String = outside(&markdown, ["](", ")"]).collect();
        // Every caption begins with the finding of its figure, which has a number or says that there is none.
        for caption in markdown.lines().filter(|line| line.starts_with("*Figure ")) {
            let finding = caption.split_once(". ").expect("its number").1;
            let is_found = |word: &str| finding.starts_with(word);
            let is_said = ["No", "None", "Stable"].into_iter().any(is_found) || finding.contains(char::is_numeric);
            assert!(
                is_said
                    && finding.split_whitespace().all(|word| !word.starts_with(MISSING))
                    && !finding.contains("NaN"),
                "{folder}: {caption}"
            );
        }
        // Names of files may hold `_`.
        let prose = prose.replace("zigzag_20_10_s.csv", "").replace("zigzag_10_10_p.csv", "");
        // Every second part is code, between backquotes.
        let prose: Vec<&str> = prose.split('`').step_by(2).collect();
        assert_eq!(identifiers(&prose.concat()), Vec::<&str>::new(), "{folder}/report.md");
        for file in std::fs::read_dir(desk.path(folder)).expect("a folder").flatten().map(|file| file.path()) {
            if file.extension().is_some_and(|extension| extension == "svg") {
                let figure = std::fs::read_to_string(&file).expect("text");
                assert_eq!(
                    identifiers(&outside(&figure, ["<", ">"]).collect::<Vec<_>>().join(" ")),
                    Vec::<&str>::new(),
                    "{}",
                    file.display()
                );
            }
        }
    }
    let fit = desk.text("f/report.md");
    assert!(fit.contains("20/10, first to starboard") && fit.contains("10/10, first to port"), "{fit}");
}
