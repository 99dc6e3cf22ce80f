//! Pages for a browser: beside every report.md, in one file that needs no other, with all of its figures.

use crate::desk::{Desk, zig_zag_csv};
use crate::scenarios::GOOD;

/// The page of a folder, which has every figure of the Markdown beside it.
fn page(desk: &Desk, folder: &str) -> String {
    let read = |name: &str| desk.text(&format!("{folder}/{name}"));
    let (markdown, page) = (read("report.md"), read("report.html"));
    assert!(page.len() < 2_000_000, "{folder}: {} bytes", page.len());
    assert_eq!(page.matches("<figure>").count(), markdown.matches("![").count(), "{folder}");
    for resource in ["src=\"http", "src=\"/", "@import", "<link", "<iframe", "xlink"] {
        assert!(!page.contains(resource), "{folder}: {resource}");
    }
    // A figure names parts of its own.
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
