//! Pages of a benchmark: the report, and one page for every method.

use std::collections::BTreeMap;

use askama::Template;
use campaign::benchmark::board::Leaderboard;
use campaign::benchmark::cases::BenchCase;
use campaign::benchmark::{BenchDocument, BenchTask};

use campaign::scenario::name::slug;
use campaign::statistics::{MIN_INTERVAL_VALUES, grouped};
use report::markdown::escaped_text;
use report::{Page, PlacedFigures};

use super::bench_figures::{capital, figures};
use super::bench_tables as tables;

/// Template of `report.md`.
#[derive(Template)]
#[template(path = "bench.md", escape = "none")]
struct BenchPage<'a> {
    results: &'a BenchDocument,
    /// Leaderboards by task.
    tasks: Vec<(BenchTask, Vec<&'a Leaderboard>)>,
    /// Leaderboards that enter the mean rank over all predictions, as text.
    overall_boards: String,
    methods: Vec<(&'a String, &'a String)>,
    figures: PlacedFigures<&'static str>,
}

/// Template of `methods/ID.md`.
#[derive(Template)]
#[template(path = "bench-method.md", escape = "none")]
struct MethodPage<'a> {
    results: &'a BenchDocument,
    method: &'a str,
    is_naming: bool,
    failures: Vec<String>,
}

/// Content of `report.md` with its figures.
pub fn page(results: &BenchDocument) -> Page {
    let mut placed = PlacedFigures::default();
    placed.put("all", figures(results));
    let boards = results.overall.iter().flat_map(|overall| &overall.boards);
    let boards: Vec<String> = boards.map(|(task, study)| format!("{} ({study})", task.id())).collect();
    let page = BenchPage {
        results,
        tasks: grouped(&results.boards, |board| board.task),
        overall_boards: boards.join(", "),
        methods: results.methods.iter().zip(&results.summaries).collect(),
        figures: placed,
    };
    Page::new(page.render(), page.figures)
}

/// Number of cases and records of a leaderboard.
fn counted(board: &Leaderboard) -> String {
    let Leaderboard { cases, clusters, .. } = *board;
    let few = if (clusters as u64) < MIN_INTERVAL_VALUES { ", too few for an interval" } else { "" };
    match cases == clusters {
        true => format!("{}{few}", report::number::counted(cases as u64, "record")),
        false => format!("{cases} cases on {clusters} records{few}"),
    }
}

/// Content of `methods/ID.md`.
pub fn method_page(results: &BenchDocument, method: &str) -> Page {
    let line = |((reason, task, set), (count, first)): ((&str, &str, &str), (usize, String))| {
        format!("{set}, {task}: {count} × {reason}; the first: {first}")
    };
    let page = MethodPage {
        results,
        method,
        is_naming: results.naming.iter().any(|line| line.method == method),
        failures: failures(results, method).into_iter().map(line).collect(),
    };
    Page::new(page.render(), PlacedFigures::<()>::default())
}

/// Failures of a method by reason, task and set: their number, and the first of them.
fn failures<'a>(results: &'a BenchDocument, method: &str) -> BTreeMap<(&'a str, &'a str, &'a str), (usize, String)> {
    let mut failures = BTreeMap::new();
    for case in &results.cases {
        for answer in case.answers.iter().filter(|answer| answer.method == method) {
            let Some(reason) = &answer.failure else { continue };
            let place = (reason.as_str(), case.task.id(), case.set.as_str());
            failures.entry(place).or_insert_with(|| (0, example(case))).0 += 1;
        }
    }
    failures
}

fn example(case: &BenchCase) -> String {
    case.trial.map_or_else(|| case.fitted.join(" + "), |trial| format!("trial {trial}"))
}
