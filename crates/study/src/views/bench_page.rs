//! Pages of a benchmark: the whole, and one for every method.

use std::collections::BTreeMap;

use campaign::benchmark::BenchDocument;
use campaign::benchmark::cases::{BenchCase, CaseAnswer};
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

const FILES: &str = "Made by `study bench`. `bench.json` has every answer and every number of this page, `rows.csv` a row for \
     every answer, `leaderboard.csv` the tables with all their intervals.";

/// `report.md`.
pub fn page(results: &BenchDocument) -> Page {
    let definition = &results.definition;
    let mut page = Page::titled(definition.name.as_str());
    page.say(&definition.about);
    let seed = definition.seed.map_or_else(String::new, |seed| format!(", with seed {seed}"));
    page.say(format!(
        "Definition {}…{seed}, program {}. Others are compared with `{}`. Our bias is in METHODOLOGY.md: the methods, the \
         simulator and the choice of records are by the same hands.",
        &definition.sha256[..12],
        results.program,
        results.reference
    ));
    page.say(format!("{READING} What each method is and reads is said [below](#methods)."));
    boards(&mut page, results);
    page.part("Set by set");
    page.say("Medians of the score.");
    page.table(tables::sets(results));
    page.part("Records");
    page.list(results.sets.iter().filter_map(|set| {
        let [download, licence, cite] = set.source.as_ref()?;
        Some(format!("**{}**: {}. From {download}. Licence: {licence}. Cite: {cite}.", set.name, set.title))
    }));
    page.table(tables::present(results));
    if !results.skipped.is_empty() {
        page.say("Skipped:");
        page.list(results.skipped.iter().map(|own| text(&format!("{}, {}: {}", own.set, own.record, own.reason))));
    }
    page.part("Methods");
    let methods = results.methods.iter().zip(&results.summaries);
    page.list(methods.map(|(method, summary)| format!("[{method}](methods/{method}.md): {summary}")));
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
    page.say(format!("In [{}](../report.md). {READING}", results.definition.name));
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
    let line = |((kind, task, set), (count, first)): ((&str, &str, &str), (usize, String))| {
        text(&format!("{set}, {task}: {count} × {kind}; the first: {first}"))
    };
    page.list(failures.into_iter().map(line));
    page
}

/// Failures of a method by kind, task and set: how many, and the first reason.
fn failures<'a>(results: &'a BenchDocument, method: &str) -> BTreeMap<(&'a str, &'a str, &'a str), (usize, String)> {
    let mut found = BTreeMap::new();
    for case in &results.cases {
        for answer in case.answers.iter().filter(|answer| answer.method == method) {
            let Some(kind) = &answer.failure else { continue };
            let place = (kind.as_str(), case.task.id(), case.set.as_str());
            found.entry(place).or_insert_with(|| (0, example(case, answer))).0 += 1;
        }
    }
    found
}

fn example(case: &BenchCase, answer: &CaseAnswer) -> String {
    let on = case.trial.map_or_else(|| case.fitted.join(" + "), |trial| format!("trial {trial}"));
    format!("{on}, {}", answer.reason.as_deref().unwrap_or("no reason was given"))
}
