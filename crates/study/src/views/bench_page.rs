//! Pages of a benchmark: the whole, and one for every method.

use std::collections::BTreeMap;

use campaign::benchmark::BenchDocument;
use campaign::benchmark::cases::BenchCase;
use campaign::benchmark::results::StudyFacts;
use campaign::scenario::name::slug;
use campaign::statistics::FEWEST;
use report::Page;
use report::markdown::text;

use super::bench_figures::{capital, figures};
use super::bench_tables as tables;

/// How to read any of the tables.
const READING: &str = "*median*, *90 % within*: what the score of half and of nine in ten of the cases does not exceed, less \
     is better; an answer that failed counts as worse than any, and *failed* in place of a number says that one stands \
     there. *over*: the median of the score over that of the reference in the same case. *better*: share of the cases in \
     which the score is smaller, equal ones counted half. *mean rank*: among all methods of the table. Intervals are 95 %, by \
     drawing records with replacement, all cases of one simulated trial and all predictions of one measured record \
     together; with fewer than six there is none. They speak of records like these, not of other ships; trials of one hull differ in their noise alone.";

const NAMING: &str = "*right*: the effect that is missing and nothing else, or nothing where nothing is missing; *among \
     aliases*: a group that the record cannot tell apart and that holds it; *and more*: it or such a group, and another one; \
     *named*: right or among aliases, with Wilson's 95 % interval.";

const FILES: &str = "Made by `study bench`. `bench.json` has every answer and every number of this page, `answers.csv` a row for \
     every answer, `leaderboard.csv` the tables with all their intervals.";

/// `report.md`.
pub fn page(results: &BenchDocument) -> Page {
    let mut page = Page::titled("Benchmark");
    page.say(format!(
        "Every method fits the same records. It is asked to replay what it was fitted to, to find K and T, to predict the \
         other side, another amplitude and a turning circle, and to name an effect that a first-order response lacks. \
         Others are compared with `{}`. Program {}. Our bias is in METHODOLOGY.md: the methods, the simulator and the \
         choice of records are by the same hands.",
        results.reference, results.program
    ));
    page.say(format!("{READING} What each method is and reads is said [below](#methods)."));
    boards(&mut page, results);
    page.part("Set by set");
    page.say("Medians of the score.");
    page.table(tables::sets(results));
    page.part("Records");
    for StudyFacts { name, question, analysis, design_sha256, seed } in &results.studies {
        page.say(format!("**{name}**: {question} Design {}…, seed {seed}.", &design_sha256[..12]));
        page.say(analysis);
    }
    page.table(tables::present(results));
    if !results.skipped.is_empty() {
        page.say("Skipped:");
        page.list(results.skipped.iter().map(|own| text(&format!("{}, {}: {}", own.set, own.record, own.reason))));
    }
    page.part("Methods");
    let methods = results.methods.iter().zip(&results.summaries);
    page.list(methods.map(|(method, summary)| format!("[{method}](methods/{}.md): {summary}", slug(method))));
    page.say(FILES);
    page
}

/// The leaderboards with their figures.
fn boards(page: &mut Page, results: &BenchDocument) {
    let mut before = None;
    for board in &results.boards {
        if before != Some(board.task) {
            page.part(capital(board.task.title()));
            page.say(format!("Score: {}.", board.task.score().unwrap_or_default()));
            before = Some(board.task);
        }
        page.subpart(format!("{}: {}", capital(&board.field), counted(board.cases, board.clusters)));
        page.table(tables::board(results, board));
    }
    if !results.naming.is_empty() {
        page.part("Name the missing effect");
        page.table(tables::naming_totals(results));
        page.say(NAMING);
        page.table(tables::naming(results, None));
    }
    page.part("Beside the reference");
    page.figures(figures(results));
    if let Some(overall) = &results.overall {
        page.part("All predictions in one number");
        let boards: Vec<String> =
            overall.boards.iter().map(|(task, field)| format!("{} ({field})", task.id())).collect();
        page.say(format!(
            "The mean of the mean ranks over {}, each counting the same, with intervals by drawing sets and their records. It \
             hides how much better a method is, at what and on which ships, and it changes when a method joins. Replaying a \
             fitted record is left out: there more parameters are an advantage in themselves.",
            boards.join(", ")
        ));
        page.table(tables::overall(results));
    }
}

fn counted(cases: usize, clusters: usize) -> String {
    let few = if (clusters as u64) < FEWEST { ", too few for an interval" } else { "" };
    match cases == clusters {
        true => format!("{}{few}", report::number::counted(cases as u64, "record")),
        false => format!("{cases} cases on {clusters} records{few}"),
    }
}

/// `methods/ID.md`.
pub fn of_method(results: &BenchDocument, method: &str) -> Page {
    let mut page = Page::titled(method);
    page.say(format!("In [the benchmark](../report.md). {READING}"));
    page.part("Every task");
    page.table(tables::standings_of(results, method));
    page.part("Every set");
    page.table(tables::of_method(results, method));
    if results.naming.iter().any(|own| own.method == method) {
        page.part("Missing effects");
        page.table(tables::naming(results, Some(method)));
    }
    page.part("Failures");
    let failures = failures(results, method);
    if failures.is_empty() {
        page.say("None.");
    }
    let line = |((reason, task, set), (count, first)): ((&str, &str, &str), (usize, String))| {
        text(&format!("{set}, {task}: {count} × {reason}; the first: {first}"))
    };
    page.list(failures.into_iter().map(line));
    page
}

/// Failures of a method by reason, task and set: how many, and the first.
fn failures<'a>(results: &'a BenchDocument, method: &str) -> BTreeMap<(&'a str, &'a str, &'a str), (usize, String)> {
    let mut found = BTreeMap::new();
    for case in &results.cases {
        for answer in case.answers.iter().filter(|answer| answer.method == method) {
            let Some(reason) = &answer.failure else { continue };
            let place = (reason.as_str(), case.task.id(), case.set.as_str());
            found.entry(place).or_insert_with(|| (0, example(case))).0 += 1;
        }
    }
    found
}

fn example(case: &BenchCase) -> String {
    case.trial.map_or_else(|| case.fitted.join(" + "), |trial| format!("trial {trial}"))
}
