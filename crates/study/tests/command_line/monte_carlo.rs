//! Tests of Monte-Carlo studies: interrupted, continued, or split into shards, they have the same rows.

use std::collections::BTreeMap;
use std::time::Duration;

use campaign::rows::StudyRow;

use crate::desk::{Desk, copy, interrupted};
use crate::scored::rows;

/// Scenario of two cells with `replicates` trials each.
fn scenario(replicates: u32) -> String {
    format!(
        r#"question = "How precise is the output error?"
seed = 3
replicates = {replicates}
ship.yukun = {{}}
manoeuvre.zig-zag = {{ rudder-deg = 10.0, heading-deg = 10.0 }}
steering-gear = {{ rate-deg-s = 2.5 }}
recording = {{ sampling-s = 1.0, duration-s = 200.0 }}
sensor = {{ heading-noise-deg = 0.1 }}
[[sweep]]
key = "sensor.heading-noise-deg"
values = [0.1, 0.5]
[[identifier]]
method.output-error = {{}}
[[identifier]]
method.integral-least-squares = {{}}
"#
    )
}

/// Bytes of every block in a folder, by file name.
pub fn blocks(desk: &Desk, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let files = std::fs::read_dir(desk.path(folder).join("rows")).into_iter().flatten().flatten();
    // Unfinished files of a killed program have names that begin with a dot.
    let blocks = files.filter(|entry| !entry.file_name().to_string_lossy().starts_with('.'));
    let file =
        |entry: std::fs::DirEntry| (entry.file_name().to_string_lossy().into_owned(), std::fs::read(entry.path()));
    blocks.map(file).filter_map(|(name, bytes)| Some((name, bytes.ok()?))).collect()
}

/// The blocks of an uninterrupted run.
fn uninterrupted(desk: &Desk) -> BTreeMap<String, Vec<u8>> {
    desk.run(&["study.toml", "--out", "whole", "--quiet"]).is_done();
    blocks(desk, "whole")
}

#[test]
fn a_run_that_is_killed_again_and_again_ends_with_the_same_bytes() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(12_000));
    let whole = uninterrupted(&desk);
    assert_eq!(whole.len(), 2 * 47);
    let mut stored = vec![0];
    for round in 0..20_u64 {
        let threads = ["1", "2", "3"][round as usize % 3];
        let mut run = desk.start(&["study.toml", "--out", "killed", "--quiet", "--threads", threads]);
        // The kill may fall before the first block, within a block or into its writing.
        std::thread::sleep(Duration::from_millis(10 + 37 * round % 150));
        run.kill().expect("it is ours to kill");
        run.wait().expect("it ends");
        stored.push(blocks(&desk, "killed").len());
    }
    assert!(stored.is_sorted(), "nothing that was stored is lost: {stored:?}");
    desk.run(&["study.toml", "--out", "killed", "--quiet", "--threads", "2"]).is_done();
    assert!(whole == blocks(&desk, "killed"), "the rows differ from those of an uninterrupted run");
}

/// Three hundred blocks, each cut short, with a flipped bit, or filled with zeros from some byte on, are computed
/// again.
#[test]
fn damaged_blocks_are_computed_again() {
    let desk = Desk::new();
    let many = "linear = { from = 0.1, to = 0.5, points = 300 }";
    desk.file("study.toml", scenario(1).replace("values = [0.1, 0.5]", many));
    let (whole, expected) = (uninterrupted(&desk), rows(&desk, "whole"));
    for (number, (name, bytes)) in whole.iter().enumerate() {
        let mut damaged = bytes.clone();
        let place = number * 7919 % bytes.len();
        match number % 3 {
            0 => damaged.truncate(place),
            1 => damaged[place] ^= 1 << (number % 8),
            _ => damaged[place..].fill(0),
        }
        desk.file(&format!("whole/rows/{name}"), damaged);
    }
    let report = desk.run(&["report", "whole", "--quiet"]);
    report.is_refused(2, &["rows/", ".parquet", "run the study again"]);
    let run = desk.run(&["study.toml", "--out", "whole"]);
    assert!(run.is_done().err.matches("its trials are run again").count() > 200, "{}", run.err);
    assert!(expected == rows(&desk, "whole"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_stops_within_a_second_and_keeps_the_rows() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(100_000));
    let run = ["study.toml", "--out", "stopped", "--quiet", "--threads", "2"];
    let (run, waited) = interrupted(desk.start_until(&run, || !blocks(&desk, "stopped").is_empty()));
    assert!(waited < Duration::from_secs(1), "{waited:?}");
    run.is_refused(130, &["error: stopped after ", "to resume, repeat the command"]);
    desk.run(&["report", "stopped"]).is_refused(2, &["of cell", "is not stored", "again"]);
    let (again, _) =
        interrupted(desk.start_until(&["study.toml", "--out", "stopped"], || blocks(&desk, "stopped").len() > 10));
    assert!(again.err.contains("resuming after "), "{}", again.err);
}

#[test]
fn shards_in_any_order_and_folder_are_the_whole() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(600));
    let whole = uninterrupted(&desk);
    // Eight shards in one folder, two at a time.
    for pair in [[8, 1], [2, 7], [3, 6], [5, 4]] {
        let runs = pair.map(|shard: u32| {
            desk.start(&["study.toml", "--quiet", "--out", "shared", "--shard", &format!("{shard}/8")])
        });
        desk.run(&["report", "shared"]).is_refused(2, &["shared"]);
        runs.into_iter().for_each(|mut run| assert!(run.wait().expect("it ends").success()));
    }
    desk.run(&["report", "shared", "--quiet"]).is_done();
    // Three shards in separate folders, copied into a common folder.
    for (shard, out) in [("2/3", "b"), ("1/3", "a"), ("3/3", "c")] {
        desk.run(&["study.toml", "--quiet", "--shard", shard, "--out", out]).is_done();
    }
    copy(&desk.path("a"), &desk.path("copied"));
    copy(&desk.path("c"), &desk.path("copied"));
    desk.run(&["report", "copied"])
        .is_refused(2, &["rows/0000-0002.parquet", "of cell 0 is not stored", "copy the file"]);
    copy(&desk.path("b"), &desk.path("copied"));
    desk.run(&["report", "copied", "--quiet"]).is_done();
    for folder in ["shared", "copied"] {
        assert!(whole == blocks(&desk, folder), "{folder}");
        for file in ["summary.csv", "cells.json", "errors.png"] {
            assert!(desk.bytes(&format!("whole/{file}")) == desk.bytes(&format!("{folder}/{file}")), "{file}");
        }
    }
    desk.file("other.toml", scenario(600).replace("0.5]", "0.7]"));
    desk.run(&["other.toml", "--quiet", "--shard", "2/3", "--out", "foreign"]).is_done();
    desk.file("copied/rows/0001-0000.parquet", desk.bytes("foreign/rows/0001-0000.parquet"));
    let refused = ["rows/0001-0000.parquet", "it is a block of another study", "--restart"];
    desk.run(&["report", "copied"]).is_refused(2, &refused);
    desk.run(&["study.toml", "--out", "copied"]).is_refused(2, &refused);
    desk.run(&["study.toml", "--shard", "4/3"]).is_refused(2, &["4/3", "expected I/N"]);
}

#[test]
fn two_runs_in_one_folder_do_no_harm() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(3000));
    let whole = uninterrupted(&desk);
    let runs =
        ["1", "2"].map(|threads| desk.start(&["study.toml", "--out", "shared", "--quiet", "--threads", threads]));
    runs.into_iter().for_each(|mut run| assert!(run.wait().expect("it ends").success()));
    assert!(whole == blocks(&desk, "shared"));
    desk.run(&["report", "shared", "--quiet"]).is_done();
}

#[test]
fn a_folder_belongs_to_one_study() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(20));
    let rows = uninterrupted(&desk);
    let again = |name: &str, options: &[&str]| desk.run(&[&[name, "--out", "whole", "--quiet"], options].concat());

    desk.file("other.toml", scenario(20).replace("duration-s = 200.0", "duration-s = 250.0"));
    again("other.toml", &[]).is_refused(2, &["whole", "recording.duration-s", "200", "250", "--out", "--restart"]);
    again("study.toml", &["--seed", "4"]).is_refused(2, &["seed: 3 there, 4 here"]);
    assert!(rows == blocks(&desk, "whole"), "a refusal changes nothing");

    // A change of prose or layout changes the report and keeps the rows.
    let told = scenario(20).replace("seed = 3", "# why three\nseed = 3\nanalysis = \"It is precise.\"");
    desk.file("told.toml", told);
    again("told.toml", &[]).is_done();
    assert!(rows == blocks(&desk, "whole"));
    assert!(String::from_utf8_lossy(&desk.bytes("whole/report.md")).contains("It is precise."));

    again("other.toml", &["--restart"]).is_done();
    assert!(rows != blocks(&desk, "whole"));
}

/// Rows are refused if they are of another version of the program, have no manifest, or are in the format of earlier
/// versions.
#[test]
fn a_folder_belongs_to_one_program() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(20));
    let rows = uninterrupted(&desk);
    let own = format!("version = \"{}\"", env!("CARGO_PKG_VERSION"));
    let manifest = desk.text("whole/manifest.toml");
    assert!(manifest.contains(&own));
    desk.file("whole/manifest.toml", manifest.replace(&own, "version = \"0.0.1\""));
    let refused = ["rows/", "it was computed by kempf", "expected kempf 0.0.1"];
    desk.run(&["study.toml", "--out", "whole"]).is_refused(2, &refused);
    std::fs::remove_file(desk.path("whole/manifest.toml")).expect("it was there");
    desk.run(&["study.toml", "--out", "whole"]).is_refused(2, &["unknown study", "without manifest.toml", "--restart"]);
    desk.run(&["study.toml", "--out", "whole", "--restart", "--quiet"]).is_done();
    assert!(rows == blocks(&desk, "whole"));
    // Earlier versions stored all rows in a single file.
    desk.file("old/rows.parquet", "rows");
    desk.file("old/manifest.toml", manifest);
    let old = ["old/rows.parquet", "by an earlier version", "remove the folder"];
    desk.run(&["study.toml", "--out", "old"]).is_refused(2, &old);
    desk.run(&["report", "old"]).is_refused(2, &old);
}

#[test]
fn a_manifest_repeats_its_study() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(10));
    desk.run(&["study.toml", "--out", "whole", "--quiet", "--seed", "12"]).is_done();
    desk.run(&["whole/manifest.toml", "--out", "again", "--quiet"]).is_done();
    assert!(blocks(&desk, "whole") == blocks(&desk, "again"));
}

/// Number of trials of every cell and method, in the order of `summary.csv`.
fn trials(desk: &Desk, folder: &str) -> Vec<u64> {
    let file = desk.path(folder).join("summary.csv");
    let mut summary = csv::Reader::from_path(file).expect("there is a summary");
    let column = summary.headers().expect("it has headings").iter().position(|name| name == "trials").expect("trials");
    let lines = summary.records().map(|line| line.expect("it is well formed"));
    lines.map(|line| line[column].parse().expect("a count")).collect()
}

#[test]
fn a_stopping_rule_ends_a_cell_wherever_it_runs() {
    let desk = Desk::new();
    let rule = "[stop]\nfigure = \"sd-T\"\nmethod = \"output-error\"\nstandard-error = 0.015\n";
    desk.file("study.toml", scenario(6000) + rule);
    let whole = uninterrupted(&desk);
    let counts = trials(&desk, "whole");
    // The standard error of a standard deviation is about sd/√(2n), so five times the noise needs 25 times the trials.
    assert!(counts[0] == counts[1] && counts[2] == counts[3], "{counts:?}");
    assert!(counts[0] == 256 && counts[2].is_multiple_of(256) && counts[2] > 512 && counts[2] < 6000, "{counts:?}");
    for threads in ["1", "3"] {
        desk.run(&["study.toml", "--out", threads, "--threads", threads, "--quiet"]).is_done();
        assert!(whole == blocks(&desk, threads), "{threads} threads");
    }
    for shard in ["1/2", "2/2"] {
        desk.run(&["study.toml", "--quiet", "--shard", shard]).is_done();
    }
    desk.run(&["report", "results/study", "--quiet"]).is_done();
    assert!(whole == blocks(&desk, "results/study"));
    // If the rule is never met, every trial runs.
    desk.file("never.toml", scenario(100) + &rule.replace("0.015", "1e-9"));
    desk.run(&["never.toml", "--out", "never", "--quiet"]).is_done();
    assert_eq!(trials(&desk, "never"), [100; 4]);
}

#[test]
fn drawn_ships_are_the_same_in_every_cell_and_every_shard() {
    let desk = Desk::new();
    let ship = "ship.first-order = { K-per-s = 0.1, T-s = 16.3 }";
    let draws = "[[draw]]\nkey = \"ship.first-order.T-s\"\nlog-uniform = { from = 5.0, to = 50.0 }\n\
                 [[draw]]\nkey = \"steering-gear.rate-deg-s\"\nuniform = { from = 2.3, to = 7.0 }\n";
    desk.file("study.toml", scenario(40).replace("ship.yukun = {}", ship) + draws);
    let whole = uninterrupted(&desk);
    for shard in ["1/3", "2/3", "3/3"] {
        desk.run(&["study.toml", "--quiet", "--shard", shard, "--threads", "2"]).is_done();
    }
    assert!(whole == blocks(&desk, "results/study"));

    let rows = rows(&desk, "whole");
    let ships: Vec<&[f64]> = rows.iter().map(|row| row.drawn_values.as_deref().expect("a ship of its own")).collect();
    assert_eq!(ships[..80], ships[80..], "paired over the cells");
    let is_truth = |row: &StudyRow, ship: &[f64]| row.true_t_s.is_some_and(|t| (t / ship[0] - 1.0).abs() < 1e-14);
    assert!(rows.iter().zip(&ships).all(|(row, ship)| is_truth(row, ship)), "the truth is what was drawn");
    assert!(ships.iter().all(|ship| (5.0..=50.0).contains(&ship[0]) && (2.3..=7.0).contains(&ship[1])));
    assert!(ships[0] != ships[2], "one ship per trial");
}

#[test]
fn studies_are_gathered_on_one_page() {
    let desk = Desk::new();
    let told = |finding: &str, figure: &str| {
        scenario(5).replace("seed = 3", &format!("seed = 3\nfinding = \"{finding}\"\noutput.figure = \"{figure}\""))
    };
    desk.file("one.toml", told("Precise to 0.1 %.", "errors"));
    desk.file("two.toml", told("So is this.", "coverage"));
    for name in ["one.toml", "two.toml"] {
        desk.run(&[name, "--quiet"]).is_done();
    }
    let both = ["report", "results/one", "results/two/"];
    assert!(desk.run(&both).is_done().out.ends_with("\npage over 2 studies: results/README.md\n"));
    let page = desk.text("results/README.md");
    for part in ["## [one](one/report.md)", "Precise to 0.1 %.", "](one/hero.png)", "So is this.", "](two/hero.png)"] {
        assert!(page.contains(part), "{part} is missing in\n{page}");
    }
    desk.file("two.toml", told("So is this.", "nothing"));
    desk.run(&["two.toml", "--quiet"]).is_done();
    let run = desk.run(&[&both[..], &["--quiet"]].concat());
    assert!(run.code == Some(2) && run.err.contains("no nothing.png; figures there: coverage, errors"), "{}", run.err);
    desk.run(&["report", "results/one", "results"]).is_refused(2, &["beside each other", "--out"]);
    desk.run(&["report", "results/one", "nowhere", "--out", "page"])
        .is_refused(2, &["nowhere", "give folders of studies"]);
    desk.run(&[&both[..], &["--format", "csv"]].concat()).is_refused(2, &["--format", "give one folder"]);
    std::fs::remove_dir_all(desk.path("results/two")).expect("it was there");
    desk.run(&["results/one/manifest.toml", "--out", "two", "--quiet"]).is_done();
    desk.run(&["report", "results/one", "two", "--out", "page", "--quiet"]).is_done();
    let page = desk.text("page/README.md");
    assert!(page.contains("## [one](../results/one/report.md)") && page.contains("](../two/hero.png)"), "{page}");
}

#[test]
fn figures_for_print_have_the_size_that_was_asked_for() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(5));
    desk.run(&["study.toml", "--out", "whole", "--quiet", "--paper", "85", "--dpi", "300"]).is_done();
    // Width of a PNG, pixels, in its chunk IHDR.
    let pixels = |name: &str| {
        let png = desk.bytes(name);
        u32::from_be_bytes(png[16..20].try_into().expect("four bytes"))
    };
    assert_eq!(pixels("whole/errors.png"), (85.0_f64 / 25.4 * 300.0).round() as u32);
    desk.run(&["report", "whole", "--quiet"]).is_done();
    assert_ne!(pixels("whole/errors.png"), (85.0_f64 / 25.4 * 300.0).round() as u32);
    let table = desk.text("whole/summary.tex");
    assert!(table.contains("\\toprule") && table.contains("output-error"), "{table}");
    desk.run(&["report", "whole", "--paper", "3"]).is_refused(2, &["3"]);
    desk.run(&["report", "whole", "--paper", "85", "--dpi", "0"]).is_refused(2, &["dpi"]);
}
