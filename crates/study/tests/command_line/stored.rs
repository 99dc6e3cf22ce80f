//! What is stored is checked by everyone who reads it, only our own files are replaced or removed, and nothing is lost
//! in silence.

use std::fs;
use std::time::Duration;

use campaign::folder::sha256_of;
use serde_json::Value;

use crate::desk::{Desk, copy, interrupted, killed};
use crate::monte_carlo::parts;

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

/// A finished study in `whole`.
fn desk() -> Desk {
    let desk = Desk::new();
    desk.file("study.toml", STUDY);
    desk.run(&["study.toml", "--out", "whole", "--quiet"]).is_done();
    desk
}

#[test]
fn a_flipped_bit_is_noticed_by_every_reader() {
    let desk = desk();
    for name in ["rows.parquet", "cells.json", "showcase.json", "timings.csv"] {
        let bytes = desk.bytes(&format!("whole/{name}"));
        for place in [0, bytes.len() / 3, bytes.len() / 2, bytes.len() - 2] {
            copy(&desk.path("whole"), &desk.path("flipped"));
            let mut damaged = bytes.clone();
            damaged[place] ^= 0x10;
            desk.file(&format!("flipped/{name}"), &damaged);
            let expected = [name, "SHA-256", "--restart"];
            desk.run(&["report", "flipped", "--quiet"]).is_refused(2, &expected);
            desk.run(&["study.toml", "--out", "flipped", "--quiet"]).is_refused(2, &expected);
            desk.run(&["merge", "flipped", "--out", "joined", "--quiet"]).is_refused(2, &expected);
            assert!(desk.bytes(&format!("flipped/{name}")) == damaged, "a refusal changes nothing");
        }
    }
    desk.run(&["study.toml", "--out", "flipped", "--quiet", "--restart"]).is_done();
    assert!(desk.bytes("flipped/rows.parquet") == desk.bytes("whole/rows.parquet"));
}

#[test]
fn rows_of_another_design_are_refused() {
    let desk = desk();
    desk.file("more.toml", STUDY.replace("[0.1, 0.5]", "[0.1, 0.2, 0.5, 0.7]"));
    desk.run(&["more.toml", "--out", "more", "--quiet"]).is_done();
    for (rows, folder, scenario) in [("whole", "more", "more.toml"), ("more", "whole", "study.toml")] {
        let own = desk.bytes(&format!("{folder}/rows.parquet"));
        desk.file(&format!("{folder}/rows.parquet"), desk.bytes(&format!("{rows}/rows.parquet")));
        desk.run(&["report", folder]).is_refused(2, &["rows.parquet", "changed"]);
        desk.run(&[scenario, "--out", folder]).is_refused(2, &["rows.parquet", "changed"]);
        desk.file(&format!("{folder}/rows.parquet"), own);
    }
    // The same with a manifest that was made to fit.
    let manifest = desk.text("more/manifest.toml");
    let sha256 = |text: &str| {
        let line = text.lines().find(|line| line.starts_with("\"rows.parquet\"")).expect("it is in the manifest");
        line.to_owned()
    };
    let whole = desk.text("whole/manifest.toml");
    desk.file("more/manifest.toml", manifest.replace(&sha256(&manifest), &sha256(&whole)));
    desk.file("more/rows.parquet", desk.bytes("whole/rows.parquet"));
    desk.run(&["report", "more"]).is_refused(2, &["rows.parquet", "axis", "another point"]);
}

#[test]
fn a_shard_that_lacks_trials_is_not_merged() {
    let desk = desk();
    for shard in ["1/2", "2/2", "1/4"] {
        let out = shard.replace('/', "-");
        desk.run(&["study.toml", "--shard", shard, "--out", &out, "--quiet"]).is_done();
    }
    // A quarter that says it is a half.
    let quarter = desk.text("1-4/manifest.toml");
    desk.file("1-4/manifest.toml", quarter.replace("shard = \"1/4\"", "shard = \"1/2\""));
    let merge = ["merge", "1-4", "2-2", "--out", "joined", "--quiet"];
    desk.run(&merge).is_refused(2, &["of cell 0 the shards hold 2 of 4 trials"]);
    assert!(!desk.path("joined/rows.parquet").exists());
    desk.run(&["merge", "1-2", "2-2", "--out", "joined", "--quiet"]).is_done();
    assert!(desk.bytes("joined/rows.parquet") == desk.bytes("whole/rows.parquet"));
}

/// A study that was stopped after some parts.
fn stopped(desk: &Desk) -> usize {
    desk.file("long.toml", STUDY.replace("replicates = 4", "replicates = 60000"));
    let third = desk.path("cut/unfinished/00000002.parquet");
    killed(desk.start_until(&["long.toml", "--out", "cut", "--quiet", "--threads", "2"], || third.exists()));
    parts(desk, "cut")
}

#[test]
fn a_part_that_cannot_be_read_costs_no_other() {
    let desk = Desk::new();
    let stored = stopped(&desk);
    let part = desk.path("cut/unfinished/00000000.parquet");
    let bytes = fs::read(&part).expect("a part");
    // A folder in its place cannot be read, whoever runs this.
    fs::remove_file(&part).expect("it was there");
    fs::create_dir(&part).expect("a folder");
    let run = desk.run(&["long.toml", "--out", "cut", "--quiet"]);
    run.is_refused(1, &["00000000.parquet", "failed to read", "nothing is removed"]);
    fs::remove_dir(&part).expect("it is empty");
    fs::write(&part, bytes).expect("it was read");
    assert_eq!(parts(&desk, "cut"), stored);

    // A part that is gone takes those after it along, and that is said.
    fs::remove_file(&part).expect("it was there");
    let message = killed(desk.start_until(&["long.toml", "--out", "cut"], || part.exists()));
    assert!(message.contains("00000000.parquet is missing") && message.contains("run again"), "{message}");
}

#[test]
fn files_of_somebody_else_are_left_alone() {
    let desk = Desk::new();
    desk.file("study.toml", STUDY);
    desk.file("out/unfinished/notes.txt", "precious");
    desk.run(&["study.toml", "--out", "out", "--quiet"]).is_refused(2, &["out/unfinished", "notes.txt", "--out"]);
    desk.run(&["study.toml", "--out", "out", "--quiet", "--restart"]).is_refused(2, &["notes.txt"]);
    assert_eq!(desk.bytes("out/unfinished/notes.txt"), b"precious");

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
    let names = ["report.md", "rows.parquet.tmp", "manifest.toml.tmp", "errors.png", "summary.csv"];
    for name in names {
        desk.file(&format!("victims/{name}"), "precious");
        desk.file("out/.keep", "");
        std::os::unix::fs::symlink(format!("../victims/{name}"), desk.path(&format!("out/{name}"))).expect("a link");
    }
    desk.run(&["study.toml", "--out", "out", "--quiet"]).is_done();
    for name in names {
        assert_eq!(desk.bytes(&format!("victims/{name}")), b"precious", "{name}");
    }
    // A folder behind a link is somebody else's too.
    desk.file("elsewhere/precious", "");
    desk.file("linked/.keep", "");
    std::os::unix::fs::symlink("../elsewhere", desk.path("linked/unfinished")).expect("a link");
    desk.run(&["study.toml", "--out", "linked", "--quiet"]).is_refused(2, &["linked/unfinished", "link"]);
    assert_eq!(fs::read_dir(desk.path("elsewhere")).expect("a folder").count(), 1);
}

/// A trial of minutes: many dense rows to trace.
#[cfg(unix)]
#[test]
fn ctrl_c_does_not_wait_for_a_trial() {
    let desk = Desk::new();
    let slow =
        STUDY.replace("sampling-s = 2.0", "sampling-s = 0.001").replace("0.5]", "0.5]\n[[identifier]]\ntrace = {}");
    desk.file("slow.toml", slow);
    let begun = desk.path("slow/unfinished/manifest.toml");
    let run = desk.start_until(&["slow.toml", "--out", "slow", "--quiet", "--threads", "2"], || begun.exists());
    std::thread::sleep(Duration::from_millis(100));
    let (run, waited) = interrupted(run);
    run.is_refused(1, &["error: stopped after 0 of 8 trials"]);
    // Half a second on a machine with nothing else to do.
    assert!(waited < Duration::from_secs(2), "{waited:?}");
    desk.run(&["report", "slow"]).is_refused(2, &["not finished"]);
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
        assert!(codes.iter().all(|code| matches!(code, Some(0 | 1))) && codes.contains(&Some(0)), "{codes:?}");
        desk.run(&["report", "whole", "--quiet"]).is_done();
    }
}

/// A scenario says which of its figures are made, and which stands for it; all there are can be asked for.
#[test]
fn figures_are_chosen() {
    let desk = Desk::new();
    let output = "[output]\nfigure = \"errors\"\ntitle = \"It does\"\nmethods = [\"least-squares\"]\nfigures = [\"coverage\", \"eror\"]\n";
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
    let page = desk.text("named/report.md");
    assert!(
        page.contains("](hero.png)") && page.contains("](coverage.png)") && !page.contains("](errors.png)"),
        "{page}"
    );
    let hero = desk.text("named/hero.svg");
    assert!(hero.contains("It does") && hero.contains("rms error of T"), "{hero}");
    desk.run(&["report", "named", "--figures", "hero", "--out", "one", "--quiet"]).is_done();
    assert_eq!(figures("one"), ["hero.png"]);
    desk.run(&["report", "named", "--figures", "none", "--out", "bare", "--quiet"]).is_done();
    assert!(figures("bare").is_empty() && desk.path("bare/report.md").exists());
    desk.run(&["report", "named", "--figures", "all", "--out", "all", "--quiet"]).is_done();
    assert_eq!(figures("all"), ["coverage.png", "errors.png", "hero.png"]);
}

/// A ship that is not first order has no K and T: what is found is held against the nearest response and called so,
/// intervals hold no truth, and K and T from trial to trial show why.
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
    assert!(drawn("errors-first-order").contains("rms error of K / Cramér–Rao bound"));
    assert!(desk.text("out/report.md").contains("error of K and T over the Cramér–Rao"));
    assert!(desk.path("out/coverage-first-order.png").exists() && !desk.path("out/coverage-cubic.png").exists());
    assert!(drawn("indices").contains(" of the 5/5") && !desk.path("out/ranking.png").exists());
}

/// Where manoeuvres are predicted, how often the intervals hold is a table and a figure.
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
        drawn.contains("90 % intervals that hold")
            && drawn.contains("width [% of value]")
            && drawn.contains("output-error"),
        "{drawn}"
    );
    let table = desk.text("out/predictions.csv");
    assert!(table.lines().count() > 4, "{table}");
    // What an earlier version did not tell of the cells is told when the study is drawn again.
    let told = |text: &str| text.contains("length_over_speed_s");
    let criteria = desk.text("out/criteria.csv");
    let (cells, before) = (desk.text("out/cells.json"), sha256_of(&desk.path("out/cells.json")).expect("a file"));
    assert!(told(&cells) && criteria.contains("20/20 first overshoot,output-error,4,"), "{criteria}");
    let [mut earlier, whole] = [(); 2].map(|()| serde_json::from_str::<Value>(&cells).expect("it is JSON"));
    for cell in earlier["cells"].as_array_mut().expect("cells") {
        cell.as_object_mut().expect("a cell").remove("length_over_speed_s");
    }
    desk.file("out/cells.json", earlier.to_string());
    let sha256 = sha256_of(&desk.path("out/cells.json")).expect("a file");
    desk.file("out/manifest.toml", desk.text("out/manifest.toml").replace(&before, &sha256));
    fs::remove_file(desk.path("out/criteria.csv")).expect("it is there");
    desk.run(&["study.toml", "--out", "out", "--quiet"]).is_done();
    assert_eq!(desk.text("out/criteria.csv"), criteria);
    assert_eq!(serde_json::from_str::<Value>(&desk.text("out/cells.json")).expect("it is JSON"), whole);
}

/// Where a sweep has sizes of an effect, the size from which on it is named is a table of its own.
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
    // Labels without their values name no sizes.
    desk.file("study.toml", study.replace("wind 2°", "much wind").replace("wind 0.01°", "little wind"));
    desk.run(&["study.toml", "--out", "none", "--quiet"]).is_done();
    assert!(desk.path("none/tracing.csv").exists() && !desk.path("none/blind-spots.csv").exists());
}
