//! Tests of stored studies: every reader checks the files, only files of the program are replaced or removed, and a
//! loss is reported.

use std::fs;
use std::time::Duration;

use serde_json::Value;

use crate::desk::{Desk, copy, interrupted, sha256};

const STUDY: &str = r#"
question = "Is it still the same?"
seed = 3
replicates = 4
ship.yukun = {}
manoeuvre.zig-zag = { rudder-deg = 10.0, heading-deg = 10.0 }
recording = { sampling-s = 2.0, duration-s = 120.0 }
[[identifier]]
method.integral-least-squares = {}
[[identifier]]
method.least-squares = {}
[[sweep]]
key = "sensor.heading-noise-deg"
values = [0.1, 0.5]
"#;

/// Folder with a finished study in `whole`.
fn desk() -> Desk {
    let desk = Desk::new();
    desk.file("study.toml", STUDY);
    desk.run(&["study.toml", "--out", "whole", "--quiet"]).is_done();
    desk
}

/// A report refuses a damaged file, and a rerun of the study writes it again.
#[test]
fn a_flipped_bit_is_noticed_by_every_reader() {
    let desk = desk();
    for name in ["rows/0001-0000.parquet", "cells.json", "showcase.json", "timings.csv"] {
        let bytes = desk.bytes(&format!("whole/{name}"));
        for place in [0, bytes.len() / 3, bytes.len() / 2, bytes.len() - 2] {
            copy(&desk.path("whole"), &desk.path("flipped"));
            let mut damaged = bytes.clone();
            damaged[place] ^= 0x10;
            desk.file(&format!("flipped/{name}"), &damaged);
            if desk.run(&["report", "flipped", "--quiet"]).code == Some(0) {
                // Some bytes of a block hold no data.
                assert!(name.starts_with("rows"), "{name} at {place}");
                continue;
            }
            desk.run(&["report", "flipped"]).is_refused(2, &[name, "run the study again"]);
            assert!(desk.bytes(&format!("flipped/{name}")) == damaged, "a refusal changes nothing");
            desk.run(&["study.toml", "--out", "flipped", "--quiet"]).is_done();
            assert!(name == "timings.csv" || desk.bytes(&format!("flipped/{name}")) == bytes, "{name} at {place}");
        }
    }
}

#[test]
fn a_block_that_cannot_be_read_is_not_computed_again() {
    let desk = desk();
    let block = desk.path("whole/rows/0000-0000.parquet");
    let bytes = fs::read(&block).expect("a block");
    // A folder in place of the file cannot be read by any user.
    fs::remove_file(&block).expect("it was there");
    fs::create_dir(&block).expect("a folder");
    desk.run(&["study.toml", "--out", "whole", "--quiet"]).is_refused(1, &["0000-0000.parquet", "failed to read"]);
    fs::remove_dir(&block).expect("it is empty");
    desk.run(&["study.toml", "--out", "whole", "--quiet"]).is_done();
    assert!(fs::read(&block).expect("it is computed again") == bytes);
}

#[test]
fn files_of_somebody_else_are_left_alone() {
    let desk = Desk::new();
    desk.file("study.toml", STUDY);
    desk.file("out/rows/notes.txt", "precious");
    desk.run(&["study.toml", "--out", "out", "--quiet"]).is_done();
    desk.run(&["study.toml", "--out", "out", "--quiet", "--restart"]).is_done();
    assert_eq!(desk.bytes("out/rows/notes.txt"), b"precious");

    let both = ["report", "one", "two", "--quiet"];
    both[1..3].iter().for_each(|out| _ = desk.run(&["study.toml", "--out", out, "--quiet"]).is_done());
    desk.file("README.md", "mine");
    desk.run(&both).is_refused(2, &["README.md", "was not made by"]);
    assert_eq!(desk.bytes("README.md"), b"mine");
    fs::remove_file(desk.path("README.md")).expect("it was there");
    desk.run(&both).is_done();
    desk.run(&both).is_done();
}

#[cfg(unix)]
#[test]
fn links_in_the_result_folder_are_not_followed() {
    let desk = Desk::new();
    desk.file("study.toml", STUDY);
    let names = ["report.md", "manifest.toml", "cells.json", "errors.png", "summary.csv"];
    for name in names {
        desk.file(&format!("victims/{name}"), "precious");
        desk.file("out/.keep", "");
        std::os::unix::fs::symlink(format!("../victims/{name}"), desk.path(&format!("out/{name}"))).expect("a link");
    }
    desk.run(&["study.toml", "--out", "out", "--quiet"]).is_done();
    for name in names {
        assert_eq!(desk.bytes(&format!("victims/{name}")), b"precious", "{name}");
    }
    // A folder behind a link is not written to, either.
    desk.file("elsewhere/precious", "");
    desk.file("linked/.keep", "");
    std::os::unix::fs::symlink("../elsewhere", desk.path("linked/rows")).expect("a link");
    desk.run(&["study.toml", "--out", "linked", "--quiet"]).is_refused(2, &["linked/rows", "link"]);
    assert_eq!(fs::read_dir(desk.path("elsewhere")).expect("a folder").count(), 1);
}

/// Ctrl-C ends the program although a trial takes minutes: a trace of very many rows.
#[cfg(unix)]
#[test]
fn ctrl_c_does_not_wait_for_a_trial() {
    let desk = Desk::new();
    let slow =
        STUDY.replace("sampling-s = 2.0", "sampling-s = 0.001").replace("0.5]", "0.5]\n[[identifier]]\ntrace = {}");
    desk.file("slow.toml", slow);
    let begun = desk.path("slow/manifest.toml");
    let run = desk.start_until(&["slow.toml", "--out", "slow", "--quiet", "--threads", "2"], || begun.exists());
    std::thread::sleep(Duration::from_millis(100));
    let (run, waited) = interrupted(run);
    run.is_refused(130, &["error: stopped after 0 of 8 trials"]);
    // It takes half a second on an idle machine.
    assert!(waited < Duration::from_secs(2), "{waited:?}");
    desk.run(&["report", "slow"]).is_refused(2, &["slow", "no rows"]);
}

#[test]
fn two_reruns_and_a_report_at_once_leave_a_whole_study() {
    let desk = desk();
    for round in 0..4 {
        desk.file("told.toml", format!("finding = \"{round}\"\n{STUDY}"));
        let runs = [
            desk.start(&["told.toml", "--out", "whole", "--quiet"]),
            desk.start(&["told.toml", "--out", "whole", "--quiet"]),
            desk.start(&["report", "whole", "--quiet"]),
        ];
        let codes = runs.map(|mut run| run.wait().expect("it ends").code());
        assert_eq!(codes, [Some(0); 3]);
        desk.run(&["report", "whole", "--quiet"]).is_done();
    }
}

/// `output.figures` selects the figures that are made, `output.figure` the key figure; `--figures` overrides the
/// selection.
#[test]
fn figures_are_chosen() {
    let desk = Desk::new();
    let output = "[output]\nfigure = \"errors\"\ntitle = \"It does\"\nhighlight = { series = [\"least-squares\"] }\nfigures = [\"coverage\", \"eror\"]\n";
    desk.file("study.toml", format!("{STUDY}{output}"));
    let figures = |folder: &str| -> Vec<String> {
        let entries = fs::read_dir(desk.path(folder)).expect("a folder").flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        let mut names: Vec<String> = names.filter(|name| name.ends_with(".png")).collect();
        names.sort();
        names
    };
    let run = desk.run(&["study.toml", "--out", "named", "--quiet"]);
    assert!(run.is_done().err.contains("there is no figure \"eror\"; there are: errors"), "{}", run.err);
    assert_eq!(figures("named"), ["coverage.png", "hero.png"]);
    let (head, _) = STUDY.split_once("[[sweep]]").expect("a sweep");
    desk.file("single.toml", format!("{head}{output}"));
    let run = desk.run(&["single.toml", "--out", "single", "--quiet"]);
    assert!(run.is_done().err.contains("there is no figure \"errors\"; there is none"), "{}", run.err);
    let page = desk.text("named/report.md");
    assert!(
        page.contains("](hero.png)") && page.contains("](coverage.png)") && !page.contains("](errors.png)"),
        "{page}"
    );
    let hero = desk.text("named/hero.svg");
    assert!(hero.contains("It does") && hero.contains("rms error of T"), "{hero}");
    assert!(hero.contains("simulated trials each.") && desk.text("named/coverage.svg").contains("Simulated trials."));
    desk.run(&["report", "named", "--figures", "hero", "--out", "one", "--quiet"]).is_done();
    assert_eq!(figures("one"), ["hero.png"]);
    desk.run(&["report", "named", "--figures", "none", "--out", "bare", "--quiet"]).is_done();
    assert!(figures("bare").is_empty() && desk.path("bare/report.md").exists());
    desk.run(&["report", "named", "--figures", "all", "--out", "all", "--quiet"]).is_done();
    assert_eq!(figures("all"), ["coverage.png", "errors-over-bound.png", "errors.png", "hero.png"]);
}

/// For a ship that is not first order, estimates are compared with the nearest first-order response and figures and
/// tables say so; there is no figure of coverage, and a figure shows how K and T change with the manoeuvre.
#[test]
fn figures_of_ships_that_are_not_first_order_say_so() {
    let sweeps = r#"
[[sweep]]
name = "ship"
points = [
  { label = "first order", set = {} },
  { label = "cubic", set = { effect = [{ nonlinear_damping = { n3-s2-per-deg2 = 0.4 } }] } },
]
[[sweep]]
name = "angles"
points = [
  { label = "5/5", set = { "manoeuvre.zig-zag.rudder-deg" = 5.0, "manoeuvre.zig-zag.heading-deg" = 5.0 } },
  { label = "10/10", set = {} },
]
"#;
    let desk = Desk::new();
    let (head, _) = STUDY.split_once("[[sweep]]").expect("a sweep");
    let noisy = head.replace("recording =", "sensor = { heading-noise-deg = 0.1 }\nrecording =");
    desk.file("study.toml", format!("{noisy}{sweeps}"));
    desk.run(&["study.toml", "--out", "out", "--quiet"]).is_done();
    let drawn = |stem: &str| desk.text(&format!("out/{stem}.svg"));
    assert!(drawn("errors-cubic").contains("rms difference of K"));
    let first_order = drawn("errors-first-order");
    assert!(first_order.contains("rms error of K [%]") && first_order.contains("Cramér–Rao bound"));
    assert!(drawn("errors-over-bound-first-order").contains("rms error of K / Cramér–Rao bound"));
    assert!(!desk.path("out/errors-over-bound-cubic.png").exists());
    assert!(desk.text("out/report.md").contains("error of K and T over the Cramér–Rao"));
    assert!(desk.path("out/coverage-first-order.png").exists() && !desk.path("out/coverage-cubic.png").exists());
    assert!(drawn("indices").contains(" of the 5/5") && !desk.path("out/ranking.png").exists());
    // Titles of tables name the reference, as the axes do.
    let some = "relative to the truth, and of ships that are not first order to the nearest first-order response";
    let page = desk.text("out/report.md");
    assert_eq!(page.matches(some).count(), 3, "two tables and the sentence below them\n{page}");
    assert!(desk.text("out/summary.md").contains(some) && desk.text("out/summary.tex").contains(some));
    let cubic = noisy.replacen("seed", "effect = [{ nonlinear_damping = { n3-s2-per-deg2 = 0.4 } }]\nseed", 1);
    desk.file("cubic.toml", cubic);
    let run = desk.run(&["cubic.toml", "--out", "cubic"]);
    let all = "Errors of K and T relative to the nearest first-order response";
    assert!(run.is_done().out.contains(all) && desk.text("cubic/summary.md").contains(all), "{}", run.out);
}

/// With several methods `summary.tex` has a second table, which compares them on the same trials.
#[test]
fn the_table_for_a_paper_has_the_paired_comparison() {
    let desk = desk();
    let paper = desk.text("whole/summary.tex");
    let (all, paired) =
        paper.split_once("% Needs").and_then(|(_, rest)| rest.split_once("% Needs")).expect("two tables");
    assert!(all.contains("relative to the truth:") && paired.contains("\\label{tab:study-pairs}"), "{paper}");
    assert!(
        paired.contains("against integral-least-squares on the same trials") && paired.contains("closer"),
        "{paired}"
    );
    let (one, _) = STUDY.rsplit_once("[[identifier]]").expect("a second method");
    desk.file("one.toml", one);
    desk.run(&["one.toml", "--out", "one", "--quiet"]).is_done();
    assert_eq!(desk.text("one/summary.tex").matches("% Needs").count(), 1);
}

/// With two numeric axes of five and two points, the five are the axis and the two are panels, in either order of the
/// sweeps.
#[test]
fn an_axis_of_two_numbers_is_two_panels() {
    let desk = Desk::new();
    let (head, _) = STUDY.split_once("[[sweep]]").expect("a sweep");
    let noise =
        "[[sweep]]\nname = \"noise\"\nkey = \"sensor.heading-noise-deg\"\nvalues = [0.05, 0.1, 0.2, 0.3, 0.5]\n";
    let step = "[[sweep]]\nname = \"step\"\nkey = \"recording.sampling-s\"\nvalues = [1.0, 2.0]\n";
    for (name, sweeps) in [("five-by-two", [noise, step]), ("two-by-five", [step, noise])] {
        desk.file("study.toml", format!("{head}{}", sweeps.concat()));
        desk.run(&["study.toml", "--out", name, "--quiet"]).is_done();
        let errors = desk.text(&format!("{name}/errors.svg"));
        assert!(["step = 1", "step = 2", "noise"].iter().all(|part| errors.contains(part)), "{name}");
        assert!(!errors.contains("noise = "), "{name}: the five points are the axis");
    }
}

/// A study of predictions has a table and a figure of the coverage of the intervals.
#[test]
fn coverage_of_predictions_is_drawn() {
    let desk = Desk::new();
    let predict = "[predict]\nmanoeuvres = [\"zig-zag:20/20\"]\ndraws = 50\n";
    let study =
        STUDY.replace("method.least-squares", "method.output-error").replace("replicates = 4", "replicates = 2");
    desk.file("study.toml", format!("{study}{predict}"));
    desk.run(&["study.toml", "--out", "out", "--quiet"]).is_done();
    let drawn = desk.text("out/predictions.svg");
    assert!(
        drawn.contains("90 % intervals that contain")
            && drawn.contains("width [% of value]")
            && drawn.contains("output-error"),
        "{drawn}"
    );
    let table = desk.text("out/predictions.csv");
    assert!(table.lines().count() > 4, "{table}");
    // A rerun adds the facts on cells that an earlier version did not store.
    let told = |text: &str| text.contains("length_over_speed_s");
    let criteria = desk.text("out/criteria.csv");
    let (cells, before) = (desk.text("out/cells.json"), sha256(&desk.bytes("out/cells.json")));
    assert!(told(&cells) && criteria.contains("20/20 first overshoot,output-error,4,"), "{criteria}");
    let [mut earlier, whole] = [(); 2].map(|()| serde_json::from_str::<Value>(&cells).expect("it is JSON"));
    for cell in earlier["cells"].as_array_mut().expect("cells") {
        cell.as_object_mut().expect("a cell").remove("length_over_speed_s");
    }
    desk.file("out/cells.json", earlier.to_string());
    let after = sha256(&desk.bytes("out/cells.json"));
    desk.file("out/manifest.toml", desk.text("out/manifest.toml").replace(&before, &after));
    fs::remove_file(desk.path("out/criteria.csv")).expect("it is there");
    desk.run(&["study.toml", "--out", "out", "--quiet"]).is_done();
    assert_eq!(desk.text("out/criteria.csv"), criteria);
    assert_eq!(serde_json::from_str::<Value>(&desk.text("out/cells.json")).expect("it is JSON"), whole);
}

/// The intervals of every ship are scaled by the factor that the other ships need.
#[test]
fn intervals_are_scaled_by_other_ships() {
    let desk = Desk::new();
    let sweep = "[[sweep]]\nname = \"ship\"\nkey = \"ship.first-order.T-s\"\nvalues = [10.0, 16.3, 25.0]\n";
    let predict = "[predict]\nmanoeuvres = [\"zig-zag:20/20\"]\ndraws = 50\n";
    let (head, _) = STUDY.split_once("[[sweep]]").expect("a sweep");
    let head = head.replace("integral-least-squares", "output-error").replace("replicates = 4", "replicates = 2");
    let head = head.replace("ship.yukun = {}", "ship.first-order = { K-per-s = 0.1, T-s = 16.3 }");
    desk.file("study.toml", format!("{head}[sensor]\nheading-noise-deg = 0.1\n{sweep}{predict}"));
    desk.run(&["study.toml", "--out", "out", "--quiet"]).is_done();
    let table = desk.text("out/interval-factors.csv");
    assert_eq!(table.lines().count(), 1 + 3 * 2, "{table}");
    assert!(table.starts_with("ship,method,factor of the others,"), "{table}");
    let number = |cell: &str| cell.parse::<f64>().expect("a number");
    for line in table.lines().filter(|line| line.contains("output-error")) {
        let cells: Vec<f64> = line.split(',').skip(2).map(number).collect();
        // A factor above 1 does not lower the coverage, a factor below 1 does not raise it.
        assert!((cells[2] - cells[1]) * (cells[0] - 1.0) >= 0.0 && cells[3] > 0.0, "{line}");
    }
    let (two, _) = sweep.split_once(", 25.0").expect("three ships");
    desk.file("two.toml", format!("{head}[sensor]\nheading-noise-deg = 0.1\n{two}]\n{predict}"));
    desk.run(&["two.toml", "--out", "two", "--quiet"]).is_done();
    assert!(!desk.path("two/interval-factors.csv").exists());
}

/// A sweep over sizes of an effect gives a table of the sizes from which on the effect is named.
#[test]
fn sizes_of_effects_make_a_table_of_blind_spots() {
    let desk = Desk::new();
    let wind = |size: f64| {
        let set = format!("effect = [{{ wind_moment = {{ rudder-deg = {size:?}, from-deg = 60.0 }} }}]");
        format!("{{ label = \"wind {size}°\", value = {size:?}, set = {{ {set} }} }}")
    };
    let points = [0.01, 2.0].map(wind).join(", ");
    let study = format!(
        r#"question = "How large must a wind be?"
seed = 5
replicates = 2
ship.yukun = {{}}
manoeuvre.zig-zag = {{ rudder-deg = 10.0, heading-deg = 10.0 }}
steering-gear = {{ rate-deg-s = 2.5 }}
recording = {{ sampling-s = 1.0, duration-s = 300.0 }}
[[sweep]]
name = "missing"
points = [{{ label = "nothing", set = {{}} }}, {points}]
[[sweep]]
key = "sensor.heading-noise-deg"
values = [0.1, 0.2]
[[identifier]]
trace.menu = ["wind_moment"]
"#
    );
    desk.file("study.toml", &study);
    desk.run(&["study.toml", "--out", "out", "--quiet"]).is_done();
    let table = desk.text("out/blind-spots.csv");
    let lines: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let [head, fine, coarse] = lines.as_slice() else { panic!("an effect at two noises: {table}") };
    assert!(head[0] == "effect" && head[1].contains("noise") && head[2] == "unit", "{table}");
    assert!(fine[..7] == ["wind", "0.1", "°", "0.01", "2", "4", "100"] && coarse[1] == "0.2", "{table}");
    let size: f64 = fine[7].parse().expect("between the sizes");
    assert!((0.01..2.0).contains(&size), "{table}");
    assert!(desk.text("out/report.md").contains("named in 90 % from"));
    // Labels that do not contain the value of their point have no sizes.
    desk.file("study.toml", study.replace("wind 2°", "much wind").replace("wind 0.01°", "little wind"));
    desk.run(&["study.toml", "--out", "none", "--quiet"]).is_done();
    assert!(desk.path("none/tracing.csv").exists() && !desk.path("none/blind-spots.csv").exists());
}
