//! The published benchmark: its scenarios are those of the program, and its leaderboards follow from its answers.

use std::path::{Path, PathBuf};

use campaign::benchmark::board::leaderboards;
use campaign::benchmark::cases::BenchCase;
use campaign::benchmark::overall::overall_ranking;
use campaign::benchmark::{BenchDocument, BenchTask, naming};
use campaign::scenario::{STRAIGHT_ON_ID, Scenario};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn published() -> BenchDocument {
    let path = root().join("results/published/bench/bench.json");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn the_published_benchmark_has_all_records_and_the_questions_of_its_scenarios() {
    let results = published();
    let names: Vec<&str> = results.studies.iter().map(|study| study.name.as_str()).collect();
    assert_eq!(names, ["measured", "first-order", "hulls", "missing"]);
    assert_eq!(results.skipped, [], "a published result has all records");
    for study in results.studies.iter().filter(|study| study.name != "measured") {
        let path = root().join(format!("scenarios/bench/{}.toml", study.name));
        let scenario = Scenario::read(&path, None).unwrap_or_else(|failure| panic!("{failure}"));
        assert_eq!(study.design_sha256, scenario.design_sha256, "run `study bench` again");
    }
}

#[test]
fn the_published_leaderboards_follow_from_the_stored_answers() {
    let results = published();
    assert_eq!(results.boards, leaderboards(&results.cases, &results.methods, &results.reference));
    assert_eq!(results.naming, naming::naming_lines(&results.cases, &results.methods));
    assert_eq!(results.overall, overall_ranking(&results.cases, &results.methods));
    // The figures themselves, by another way: half of the scores are not larger, half are not smaller.
    for board in &results.boards {
        let cases: Vec<&BenchCase> =
            results.cases.iter().filter(|case| case.task == board.task && case.study == board.study).collect();
        for standing in &board.standings {
            let scores: Vec<f64> = cases.iter().filter_map(|case| case.method_score(&standing.method)).collect();
            let median = standing.median.value.unwrap_or(f64::INFINITY);
            let half = scores.len().div_ceil(2);
            assert_eq!(scores.len(), board.cases);
            assert!(scores.iter().filter(|score| **score <= median).count() >= half, "{}", standing.method);
            assert!(scores.iter().filter(|score| **score >= median).count() >= half, "{}", standing.method);
        }
    }
}

/// Nobody predicts worse than a ship that goes straight on without its being said.
#[test]
fn the_floor_is_on_every_board_of_headings() {
    let results = published();
    for board in results.boards.iter().filter(|board| board.task != BenchTask::Indices) {
        let labels: Vec<&str> = board.standings.iter().map(|standing| standing.method.as_str()).collect();
        assert_eq!(labels.len(), results.methods.len(), "{labels:?}");
        assert!(labels.contains(&STRAIGHT_ON_ID), "{labels:?}");
    }
}
