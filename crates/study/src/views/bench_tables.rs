//! Tables of a benchmark: leaderboards, sets, and single answers.

use campaign::benchmark::board::{Leaderboard, LeaderboardRow, ScoreFigure, SetLine, WilsonShare, set_lines};
use campaign::benchmark::cases::{BenchCase, Naming};
use campaign::benchmark::naming::{NamingLine, naming_total};
use campaign::benchmark::{BenchDocument, BenchTask};
use report::number::{MISSING, fixed, significant};
use report::{Table, TableHead};

/// Text in place of a score that is decided by a failed estimate.
const FAILED: &str = "failed";

/// Significant digits of scores: no interval is so narrow that more digits carry information.
const DIGITS: usize = 3;

fn score(value: Option<f64>) -> String {
    value.map_or_else(|| FAILED.to_owned(), |value| significant(value, DIGITS))
}

fn value(figure: ScoreFigure) -> String {
    score(figure.value)
}

fn ends(figure: ScoreFigure) -> String {
    figure.ci95.map_or_else(|| MISSING.to_owned(), |[low, high]| format!("[{}, {}]", score(low), score(high)))
}

fn percent(figure: ScoreFigure) -> ScoreFigure {
    let times = |value: f64| 100.0 * value;
    ScoreFigure { value: figure.value.map(times), ci95: figure.ci95.map(|ends| ends.map(|end| end.map(times))) }
}

fn share(share: WilsonShare) -> String {
    let [low, high] = share.ci95.map(|end| fixed(100.0 * end, 0));
    format!("{} [{low}, {high}]", fixed(100.0 * share.count as f64 / share.cases as f64, 0))
}

/// A count as text; empty for zero.
fn count(count: usize) -> String {
    if count == 0 { String::new() } else { count.to_string() }
}

/// Head of a leaderboard: the columns of `first`, then median, quantile, failures, ratio to reference, share better and
/// rank; with indices also the coverage of K and T.
fn columns(first: TableHead, reference: &str, indices: bool) -> TableHead {
    let head = first.numbers(["median"]).texts(["95 %"]).numbers(["90 % within"]).counts(["failed"]);
    let head = head.numbers([format!("over {reference}")]).texts(["95 %"]).numbers(["better"]).unit("%");
    let held = ["intervals hold K", "hold T"].into_iter().filter(|_| indices);
    head.numbers(["mean rank"]).numbers(held).unit("%")
}

fn cells(standing: &LeaderboardRow, indices: bool) -> Vec<String> {
    let paired =
        |figure: Option<ScoreFigure>, text: fn(ScoreFigure) -> String| figure.map_or_else(|| MISSING.to_owned(), text);
    let mut cells = vec![
        standing.method.clone(),
        value(standing.median),
        ends(standing.median),
        value(standing.quantile_90),
        count(standing.failed),
        paired(standing.ratio, value),
        paired(standing.ratio, ends),
        paired(standing.share_better.map(percent), |share| share.value.map_or_else(String::new, |x| fixed(x, 0))),
        fixed(standing.rank, 1),
    ];
    if indices {
        match standing.coverage {
            Some(coverage) => cells.extend(coverage.map(share)),
            None => cells.extend([MISSING, MISSING].map(str::to_owned)),
        }
    }
    cells
}

/// Table of one leaderboard.
pub fn leaderboard_table(results: &BenchDocument, board: &Leaderboard) -> Table {
    let indices = board.task == BenchTask::Indices;
    let mut table = Table::new(columns(TableHead::default().texts(["method"]), &results.reference, indices));
    board.standings.iter().for_each(|standing| table.push(cells(standing, indices)));
    table
}

/// All leaderboards in one table, for a person.
pub fn joint_leaderboard_table(results: &BenchDocument) -> Table {
    let first = TableHead::default().texts(["task", "records"]).counts(["n"]).texts(["method"]);
    let mut table = Table::new(columns(first, &results.reference, true));
    for board in &results.boards {
        for standing in &board.standings {
            let mut line = vec![board.task.id().to_owned(), board.study.clone(), board.cases.to_string()];
            line.extend(cells(standing, board.task == BenchTask::Indices));
            table.push(line);
        }
    }
    table
}

/// All leaderboards with all their numbers, for a program.
pub fn leaderboard_numbers(results: &BenchDocument) -> Table {
    let with_ends = |name: &str| ["", " lower 95", " upper 95"].map(|end| format!("{name}{end}"));
    let head = TableHead::default().texts(["task", "records", "cases", "clusters", "method", "failed"]);
    let head = head.texts(["median", "90 % within", "over reference"].iter().flat_map(|name| with_ends(name)));
    let head = head.texts(with_ends("better")).unit("%").texts(["mean rank"]);
    let mut table = Table::new(head.texts(["intervals hold K", "intervals hold T"]).unit("%"));
    let text = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let all = |figure: Option<ScoreFigure>| match figure {
        None => vec![String::new(); 3],
        Some(ScoreFigure { value, ci95 }) => {
            let [low, high] = ci95.unwrap_or([None; 2]);
            [value, low, high].map(text).to_vec()
        }
    };
    for (board, row) in results.boards.iter().flat_map(|board| board.standings.iter().map(move |row| (board, row))) {
        let held = |place: usize| row.coverage.map(|of| 100.0 * of[place].count as f64 / of[place].cases as f64);
        let head = [board.task.id(), &board.study, &board.cases.to_string(), &board.clusters.to_string(), &row.method];
        let figures = [Some(row.median), Some(row.quantile_90), row.ratio, row.share_better.map(percent)];
        let line = head.map(str::to_owned).into_iter().chain([row.failed.to_string()]);
        table.push(line.chain(figures.into_iter().flat_map(all)).chain([Some(row.rank), held(0), held(1)].map(text)));
    }
    table
}

/// Median of a set as text: `failed` if it is not finite, the mark of a missing value without a case.
fn median(set_median: Option<(f64, usize)>) -> String {
    set_median.map_or_else(|| MISSING.to_owned(), |(median, _)| score(Some(median).filter(|median| median.is_finite())))
}

/// Medians of every set, methods side by side.
pub fn set_median_table(results: &BenchDocument) -> Table {
    let mut table = Table::new(TableHead::default().texts(["task", "set"]).counts(["n"]).numbers(&results.methods));
    for SetLine { task, set, cases, methods } in set_lines(&results.cases, &results.methods) {
        let head = [task.id().to_owned(), set, cases.to_string()];
        table.push(head.into_iter().chain(methods.into_iter().map(median)));
    }
    table
}

/// Medians of one method on every set, next to those of the reference.
pub fn method_medians(results: &BenchDocument, method: &str) -> Table {
    let head = TableHead::default().texts(["task", "set"]).counts(["n"]).numbers(["median"]).counts(["failed"]);
    let place = |label: &str| results.methods.iter().position(|name| name == label);
    let reference = place(&results.reference).filter(|_| method != results.reference);
    let mut table = Table::new(head.numbers(reference.map(|_| format!("median of {}", results.reference))));
    let Some(column) = place(method) else { return table };
    for SetLine { task, set, cases, methods } in set_lines(&results.cases, &results.methods) {
        let Some((_, failed)) = methods[column] else { continue };
        let line = [task.id().to_owned(), set, cases.to_string(), median(methods[column]), count(failed)];
        table.push(line.into_iter().chain(reference.map(|place| median(methods[place]))));
    }
    table
}

/// Rows of one method on every leaderboard.
pub fn standings_table(results: &BenchDocument, method: &str) -> Table {
    let mut table = Table::new(columns(TableHead::default().texts(["task"]).counts(["n"]), &results.reference, true));
    for board in &results.boards {
        for (place, standing) in board.standings.iter().enumerate().filter(|(_, standing)| standing.method == method) {
            let mut line = cells(standing, board.task == BenchTask::Indices);
            let (task, study, methods) = (board.task.title(), &board.study, board.standings.len());
            line[0] = format!("{task}, {study} ({} of {methods})", place + 1);
            line.insert(1, board.cases.to_string());
            table.push(line);
        }
    }
    table
}

fn naming_table<'a>(first: &str, lines: impl Iterator<Item = (&'a str, NamingLine)>) -> Table {
    let head = TableHead::default().texts(["method", first]).counts(["n"]).counts(Naming::ALL.map(Naming::label));
    let mut table = Table::new(head.counts(["failed"]).numbers(["named"]).unit("%"));
    for (ships, line) in lines {
        let head = [line.method.clone(), ships.to_owned(), line.named.cases.to_string()];
        table.push(head.into_iter().chain(line.counts.map(count)).chain([count(line.failed), share(line.named)]));
    }
    table
}

/// Outcomes of naming the missing effect, all ships together.
pub fn naming_totals(results: &BenchDocument) -> Table {
    let kinds = [(true, "that lack one effect"), (false, "that lack nothing")];
    let all = results.methods.iter().flat_map(|method| kinds.map(|(is_missing, ships)| (method, is_missing, ships)));
    let line = |(method, is_missing, ships): (&String, bool, _)| {
        Some((ships, naming_total(&results.naming, method, is_missing)?))
    };
    naming_table("ships", all.filter_map(line))
}

/// Outcomes of naming the missing effect, set by set, for one method or all.
pub fn naming_table_by_set(results: &BenchDocument, method: Option<&str>) -> Table {
    let lines = results.naming.iter().filter(|line| method.is_none_or(|method| line.method == method));
    naming_table("set", lines.map(|line| (line.set.as_str(), line.clone())))
}

/// Ranking over all predictions.
pub fn overall_ranking_table(results: &BenchDocument) -> Table {
    let mut table = Table::new(TableHead::default().texts(["method"]).numbers(["mean rank"]).texts(["95 %"]));
    for (method, rank) in results.overall.iter().flat_map(|overall| &overall.standings) {
        table.push([method.clone(), value(*rank), ends(*rank)]);
    }
    table
}

/// Table of the sets of a benchmark: number of trials, and every record with its manoeuvre and SHA-256.
pub fn record_sets(results: &BenchDocument) -> Table {
    let mut table =
        Table::new(TableHead::default().texts(["set"]).counts(["trials"]).texts(["record", "manoeuvre", "SHA-256"]));
    for set in &results.sets {
        for (place, record) in set.records.iter().enumerate() {
            let first = |text: String| if place == 0 { text } else { String::new() };
            let hash = record.sha256.as_ref().map_or(MISSING.to_owned(), |sha256| format!("{}…", &sha256[..12]));
            let trials = set.trials.to_string();
            table.push([first(set.name.clone()), first(trials), record.name.clone(), record.manoeuvre.clone(), hash]);
        }
    }
    table
}

/// Table with one row for every answer.
pub fn answer_rows(results: &BenchDocument) -> Table {
    let head = TableHead::default();
    let head = head.texts(["task", "records", "set", "trial", "fitted", "scored", "method", "score"]);
    let head = head.texts(["K error", "T error"]).unit("%");
    let mut table = Table::new(head.texts(["K held", "T held", "missing", "judgement", "named", "failure"]));
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let truth = |value: Option<bool>| value.map_or_else(String::new, |value| value.to_string());
    for case in &results.cases {
        let BenchCase { task, study, set, trial, fitted, scored, missing, answers } = case;
        for answer in answers {
            let errors = answer.errors_percent;
            let named: Vec<String> = answer.named.iter().map(|group| group.join("|")).collect();
            let judgement = answer.naming.map_or_else(String::new, |naming| naming.label().to_owned());
            table.push([
                task.id().to_owned(),
                study.clone(),
                set.clone(),
                trial.map_or_else(String::new, |trial| trial.to_string()),
                fitted.join(" + "),
                scored.clone().unwrap_or_default(),
                answer.method.clone(),
                number(answer.score),
                number(errors.map(|errors| errors[0])),
                number(errors.map(|errors| errors[1])),
                truth(answer.contains_truth.map(|contained| contained[0])),
                truth(answer.contains_truth.map(|contained| contained[1])),
                missing.clone().unwrap_or_default(),
                judgement,
                named.join(" + "),
                answer.failure.clone().unwrap_or_default(),
            ]);
        }
    }
    table
}
