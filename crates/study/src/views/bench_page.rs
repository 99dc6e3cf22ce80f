//! Pages of a benchmark: the whole, and one for every method.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use campaign::benchmark::BenchDocument;
use campaign::benchmark::board::FEWEST;
use campaign::benchmark::cases::{BenchCase, CaseAnswer};
use report::markdown;

use super::bench_figures::{capital, of_field};
use super::bench_tables as tables;

/// How to read any of the tables.
const READING: &str = "*median*, *90 % within*: what the score of half and of nine in ten of the cases does not exceed, less \
     is better; an answer that failed counts as worse than any, and *failed* in place of a number says that one stands \
     there. *over*: the median of the score over that of the reference in the same case. *better*: share of the cases in \
     which the score is smaller, equal ones counted half. *mean rank*: among all methods of the table. Intervals are 95 %, by \
     drawing records with replacement, all cases of one simulated trial and all predictions of one measured record \
     together; with fewer than six there is none. They speak of records like these, not of other ships; trials of one hull differ in their noise alone.";

/// `report.md`.
pub fn page(results: &BenchDocument, drawn: &[(String, String)]) -> String {
    let mut page = String::new();
    let mut line = |line: &str| writeln!(page, "{line}").expect("writing to a string does not fail");
    let definition = &results.definition;
    line(&format!("# {}\n\n{}\n", definition.name, definition.about.trim()));
    let seed = definition.seed.map_or_else(String::new, |seed| format!(", with seed {seed}"));
    line(&format!(
        "Definition {}…{seed}, program {}. Others are compared with `{}`. Our bias is in METHODOLOGY.md: the methods, the \
         simulator and the choice of records are by the same hands.\n",
        &definition.sha256[..12],
        results.program,
        results.reference
    ));
    line(&format!("{READING} What each method is and reads is said [below](#methods).\n"));
    let figure = |stem: &str| {
        drawn
            .iter()
            .find(|(own, _)| own == stem)
            .map(|(_, caption)| format!("![{caption}]({stem}.png)\n\n*{caption}*\n"))
    };
    let mut before = None;
    for board in &results.boards {
        if before != Some(board.task) {
            line(&format!("## {}\n", capital(board.task.title())));
            line(&format!("Score: {}.\n", board.task.score().unwrap_or_default()));
            before = Some(board.task);
        }
        line(&format!("### {}: {}\n", capital(&board.field), counted(board.cases, board.clusters)));
        line(&tables::board(results, board).to_markdown());
    }
    if !results.naming.is_empty() {
        line("## Name the missing effect\n");
        line(&tables::naming_totals(results).to_markdown());
        line(
            "*right*: the effect that is missing and nothing else, or nothing where nothing is missing; *among aliases*: a group \
             that the record cannot tell apart and that holds it; *and more*: it or such a group, and another one; *named*: \
             right or among aliases, with Wilson's 95 % interval.\n",
        );
        line(&tables::naming(results, None).to_markdown());
    }
    line("## Beside the reference\n");
    results.fields().into_iter().filter_map(|field| figure(&of_field(field))).for_each(|figure| line(&figure));
    if let Some(overall) = &results.overall {
        line("## All predictions in one number\n");
        let boards: Vec<String> =
            overall.boards.iter().map(|(task, field)| format!("{} ({field})", task.id())).collect();
        line(&format!(
            "The mean of the mean ranks over {}, each counting the same, with intervals by drawing sets and their records. It \
             hides how much better a method is, at what and on which ships, and it changes when a method joins. Replaying a \
             fitted record is left out: there more parameters are an advantage in themselves.\n",
            boards.join(", ")
        ));
        line(&tables::overall(results).to_markdown());
    }
    line("## Set by set\n\nMedians of the score.\n");
    line(&tables::sets(results).to_markdown());
    line("## Records\n");
    for set in &results.sets {
        if let Some([download, licence, cite]) = &set.source {
            line(&format!("- **{}**: {}. From {download}. Licence: {licence}. Cite: {cite}.", set.name, set.title));
        }
    }
    line(&format!("\n{}", tables::present(results).to_markdown()));
    if !results.skipped.is_empty() {
        line("Skipped:\n");
        results.skipped.iter().for_each(|own| line(&format!("- {}, {}: {}", own.set, own.record, own.reason)));
        line("");
    }
    line("## Methods\n");
    for (method, summary) in results.methods.iter().zip(&results.summaries) {
        line(&format!("- [{method}](methods/{method}.md): {summary}"));
    }
    line(
        "\nMade by `study bench`. `bench.json` has every answer and every number of this page, `rows.csv` a row for every \
         answer, `leaderboard.csv` the tables with all their intervals.",
    );
    markdown::prose(&page)
}

fn counted(cases: usize, clusters: usize) -> String {
    let few = if clusters < FEWEST { ", too few for an interval" } else { "" };
    match cases == clusters {
        true => format!("{cases} records{few}"),
        false => format!("{cases} cases on {clusters} records{few}"),
    }
}

/// `methods/ID.md`.
pub fn of_method(results: &BenchDocument, method: &str) -> String {
    let mut page = String::new();
    let mut line = |line: &str| writeln!(page, "{line}").expect("writing to a string does not fail");
    line(&format!("# {method}\n\nIn [{}](../report.md). {READING}\n", results.definition.name));
    line(&format!("## Every task\n\n{}", tables::standings_of(results, method).to_markdown()));
    line(&format!("## Every set\n\n{}", tables::of_method(results, method).to_markdown()));
    if results.naming.iter().any(|own| own.method == method) {
        line(&format!("## Missing effects\n\n{}", tables::naming(results, Some(method)).to_markdown()));
    }
    line("## Failures\n");
    let failures = failures(results, method);
    if failures.is_empty() {
        line("None.");
    }
    for ((kind, task, set), (count, first)) in failures {
        line(&format!("- {set}, {task}: {count} × {kind}; the first: {first}"));
    }
    markdown::prose(&page)
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
