//! Monte-Carlo studies as a user runs them: interrupted, continued, split and joined, always with the same rows.

use std::time::Duration;

use campaign::rows::StudyRow;

use crate::desk::{Desk, interrupted, killed};
use crate::outside::rows;

/// A study of some seconds in two cells.
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

const ROWS: &str = "whole/rows.parquet";

/// The rows of an uninterrupted run.
fn uninterrupted(desk: &Desk) -> Vec<u8> {
    desk.run(&["study.toml", "--out", "whole", "--quiet"]).is_done();
    desk.bytes(ROWS)
}

/// Number of parts stored so far.
pub fn parts(desk: &Desk, folder: &str) -> usize {
    let parts = std::fs::read_dir(desk.path(folder).join("unfinished")).into_iter().flatten().flatten();
    parts.filter(|entry| entry.path().extension().is_some_and(|extension| extension == "parquet")).count()
}

#[test]
fn a_killed_run_goes_on_and_ends_with_the_same_bytes() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(12_000));
    let whole = uninterrupted(&desk);
    // Killed before the first part, and then some time after one more part is stored, wherever that falls.
    let mut stored = vec![0];
    for (round, wait) in [15, 40, 0, 90, 5].into_iter().enumerate() {
        let threads = ["1", "2", "3"][round % 3];
        let mut run = desk.start(&["study.toml", "--out", "killed", "--quiet", "--threads", threads]);
        let is_over = |run: &mut std::process::Child| run.try_wait().expect("it can be asked").is_some();
        while round > 0 && parts(&desk, "killed") <= stored[round] && !is_over(&mut run) {
            std::thread::sleep(Duration::from_millis(2));
        }
        std::thread::sleep(Duration::from_millis(wait));
        if is_over(&mut run) {
            break;
        }
        run.kill().expect("it is ours to kill");
        run.wait().expect("it ends");
        if desk.path("killed/rows.parquet").exists() {
            break;
        }
        stored.push(parts(&desk, "killed"));
    }
    assert!(stored.is_sorted(), "nothing that was stored is lost: {stored:?}");
    assert!(stored.len() > 3, "the study was over before it was killed three times: {stored:?}");
    desk.run(&["study.toml", "--out", "killed", "--quiet", "--threads", "2"]).is_done();
    assert!(whole == desk.bytes("killed/rows.parquet"), "the rows differ from those of an uninterrupted run");
    assert!(!desk.path("killed/unfinished").exists());
}

#[test]
fn a_damaged_part_is_run_again() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(6000));
    let whole = uninterrupted(&desk);
    let run = ["study.toml", "--out", "damaged", "--quiet", "--threads", "2"];
    killed(desk.start_until(&run, || parts(&desk, "damaged") >= 2));
    let part = "damaged/unfinished/00000001.parquet";
    let bytes = desk.bytes(part);
    desk.file(part, &bytes[..bytes.len() / 2]);
    let run = desk.run(&["study.toml", "--out", "damaged"]);
    run.is_done();
    assert!(run.err.contains("00000001.parquet") && run.err.contains("run again"), "{}", run.err);
    assert!(whole == desk.bytes("damaged/rows.parquet"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_stops_within_a_second_and_keeps_the_rows() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(100_000));
    let run = ["study.toml", "--out", "stopped", "--quiet", "--threads", "2"];
    let (run, waited) = interrupted(desk.start_until(&run, || parts(&desk, "stopped") >= 1));
    assert!(waited < Duration::from_secs(1), "{waited:?}");
    run.is_refused(1, &["error: stopped after ", "the same command goes on"]);
    desk.run(&["report", "stopped"]).is_refused(2, &["stopped", "not finished", "run it again"]);
}

#[test]
fn shards_in_any_order_are_the_whole() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(50));
    let whole = uninterrupted(&desk);
    for shard in ["2/3", "1/3", "3/3"] {
        desk.run(&["study.toml", "--quiet", "--shard", shard]).is_done();
    }
    let folders = ["results/study/shards/3-of-3", "results/study/shards/1-of-3", "results/study/shards/2-of-3"];
    let merge = |folders: &[&str], out: &str| desk.run(&[&["merge"], folders, &["--out", out, "--quiet"]].concat());
    merge(&folders, "joined").is_done();
    assert!(whole == desk.bytes("joined/rows.parquet"));
    for file in ["summary.csv", "cells.json", "errors.png"] {
        assert!(desk.bytes(&format!("whole/{file}")) == desk.bytes(&format!("joined/{file}")), "{file}");
    }
    merge(&folders[..2], "x").is_refused(2, &["1 of 3 shards are missing", "2/3"]);
    merge(&[folders[0], folders[0]], "x").is_refused(2, &["both shard 3/3"]);
    merge(&["whole", folders[0]], "x").is_refused(2, &["not shards of one study", "shard"]);
    merge(&["nowhere"], "x").is_refused(2, &["nowhere", "no finished shard"]);
    desk.file("other.toml", scenario(50).replace("0.5]", "0.7]"));
    desk.run(&["other.toml", "--quiet", "--shard", "2/3", "--out", "foreign"]).is_done();
    merge(&[folders[0], folders[1], "foreign"], "x").is_refused(2, &["not shards of one study", "sweep.0.values"]);
    desk.run(&["study.toml", "--shard", "4/3"]).is_refused(2, &["4/3", "expected I/N"]);
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
    assert!(rows == desk.bytes(ROWS), "a refusal changes nothing");

    // Prose and layout are not part of a study; the report follows them, the rows stay.
    let told = scenario(20).replace("seed = 3", "# why three\nseed = 3\nanalysis = \"It is precise.\"");
    desk.file("told.toml", told);
    again("told.toml", &[]).is_done();
    assert!(rows == desk.bytes(ROWS));
    assert!(String::from_utf8_lossy(&desk.bytes("whole/report.md")).contains("It is precise."));

    again("other.toml", &["--restart"]).is_done();
    assert!(rows != desk.bytes(ROWS));
}

/// What a kill in the last moment leaves: a folder `unfinished` with its mark and without its manifest.
#[test]
fn what_is_left_of_an_ended_study_does_no_harm() {
    let desk = Desk::new();
    desk.file("long.toml", scenario(100_000));
    killed(desk.start_until(&["long.toml", "--out", "cut", "--quiet"], || parts(&desk, "cut") >= 1));
    let leave = || {
        desk.file("whole/unfinished/README", desk.bytes("cut/unfinished/README"));
        desk.file("whole/unfinished/00000000.parquet", "half a part");
    };
    desk.file("study.toml", scenario(10));
    let rows = uninterrupted(&desk);
    leave();
    desk.run(&["report", "whole", "--quiet"]).is_done();
    desk.run(&["study.toml", "--out", "whole", "--quiet"]).is_done();
    assert!(rows == desk.bytes(ROWS) && !desk.path("whole/unfinished").exists());
    leave();
    std::fs::remove_file(desk.path(ROWS)).expect("it was there");
    // Without finished rows the part may be all that there is of a study, and nobody knows of which one.
    let again = ["study.toml", "--out", "whole", "--quiet", "--restart"];
    let parts = ["whole/unfinished", "00000000.parquet", "without manifest.toml", "--restart"];
    desk.run(&again[..4]).is_refused(2, &parts);
    assert_eq!(desk.bytes("whole/unfinished/00000000.parquet"), b"half a part");
    desk.run(&again).is_done();
    assert!(rows == desk.bytes(ROWS) && !desk.path("whole/unfinished").exists());
}

#[test]
fn a_manifest_repeats_its_study() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(10));
    desk.run(&["study.toml", "--out", "whole", "--quiet", "--seed", "12"]).is_done();
    desk.run(&["whole/manifest.toml", "--out", "again", "--quiet"]).is_done();
    assert!(desk.bytes(ROWS) == desk.bytes("again/rows.parquet"));
}

#[test]
fn two_runs_do_not_share_a_folder() {
    let desk = Desk::new();
    desk.file("study.toml", scenario(100_000));
    let first = ["study.toml", "--out", "shared", "--quiet", "--threads", "1"];
    let first = desk.start_until(&first, || parts(&desk, "shared") >= 1);
    for options in [&[][..], &["--restart"]] {
        let run = desk.run(&[&["study.toml", "--out", "shared", "--quiet"], options].concat());
        run.is_refused(1, &["another study is running", "shared"]);
    }
    assert!(parts(&desk, "shared") > 0, "nothing was discarded");
    killed(first);
}

/// Trials of every cell and method of a summary, in its order.
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
    let rule = "[stop]\nfigure = \"sd-T\"\nmethod = \"output-error\"\nstandard-error = 0.015\nevery = 50\n";
    desk.file("study.toml", scenario(3000) + rule);
    let whole = uninterrupted(&desk);
    let counts = trials(&desk, "whole");
    // The standard error of a standard deviation is about sd/√(2n), so five times the noise needs 25 times the trials.
    assert!(counts[0] == counts[1] && counts[2] == counts[3], "{counts:?}");
    assert!(
        counts[0].is_multiple_of(50) && counts[0] >= 50 && counts[2] > 5 * counts[0] && counts[2] < 3000,
        "{counts:?}"
    );
    for threads in ["1", "3"] {
        desk.run(&["study.toml", "--out", threads, "--threads", threads, "--quiet"]).is_done();
        assert!(whole == desk.bytes(&format!("{threads}/rows.parquet")), "{threads} threads");
    }
    for shard in ["1/2", "2/2"] {
        desk.run(&["study.toml", "--quiet", "--shard", shard]).is_done();
    }
    let (one, two) = ("results/study/shards/1-of-2", "results/study/shards/2-of-2");
    desk.run(&["merge", one, two, "--out", "joined", "--quiet"]).is_done();
    assert!(whole == desk.bytes("joined/rows.parquet"));
    // A rule that is never met runs every trial there is.
    desk.file("never.toml", scenario(100) + &rule.replace("0.015", "1e-9"));
    desk.run(&["never.toml", "--out", "never", "--quiet"]).is_done();
    assert_eq!(trials(&desk, "never"), [100; 4]);
}

#[test]
fn drawn_ships_are_the_same_in_every_cell_and_every_part() {
    let desk = Desk::new();
    let ship = "ship.first-order = { K-per-s = 0.1, T-s = 16.3 }";
    let draws = "[[draw]]\nkey = \"ship.first-order.T-s\"\nlog-uniform = { from = 5.0, to = 50.0 }\n\
                 [[draw]]\nkey = \"steering-gear.rate-deg-s\"\nuniform = { from = 2.3, to = 7.0 }\n";
    desk.file("study.toml", scenario(40).replace("ship.yukun = {}", ship) + draws);
    let whole = uninterrupted(&desk);
    for shard in ["1/3", "2/3", "3/3"] {
        desk.run(&["study.toml", "--quiet", "--shard", shard, "--threads", "2"]).is_done();
    }
    let shards = ["1", "2", "3"].map(|shard| format!("results/study/shards/{shard}-of-3"));
    let merge = ["merge", &shards[0], &shards[1], &shards[2], "--out", "joined", "--quiet"];
    desk.run(&merge).is_done();
    assert!(whole == desk.bytes("joined/rows.parquet"));

    let rows = rows(&desk, "whole");
    let ships: Vec<&[f64]> = rows.iter().map(|row| row.drawn.as_deref().expect("a ship of its own")).collect();
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
        .is_refused(2, &["nowhere", "run a scenario first"]);
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
    // Width and physical resolution of a PNG: in IHDR and pHYs.
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
