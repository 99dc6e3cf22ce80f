//! Tables of predictions in a study: coverage of the intervals, by characteristic.

use document::names;
use report::number::{fixed, optional, significant};
use report::{Table, TableHead};

use super::tables::{head, row_labels};
use campaign::design::Design;
use campaign::statistics::{Statistic, grouped, wilson_share};
use campaign::summary::{ImoDecisionTally, PredictionSummary};

/// Coverage of every characteristic of every cell and method.
pub fn table(lines: &[PredictionSummary], design: &Design) -> Table {
    let head = head(design).texts(["figure", "unit"]).counts(["trials"]);
    let head = head.numbers(["inside 90 %", "lower 95", "upper 95"]).unit("%");
    let mut table = Table::new(head.numbers(["of the ship", "bias", "rms error", "width"]));
    for line in lines {
        let mut cells = row_labels(design, line.cell, line.method);
        let (name, unit) = names::figure_of_merit(&line.name);
        cells.extend([name, unit.to_owned(), line.trials.to_string()]);
        cells.extend(percent(line.coverage()));
        cells.extend([line.truth(), line.bias(), line.rms(), line.width()].map(|value| significant(value, 3)));
        table.push(cells);
    }
    table
}

/// Coverage of all characteristics of a cell and a method: mean, minimum and maximum of their shares.
pub fn pooled(lines: &[PredictionSummary], design: &Design) -> Table {
    let head = head(design).counts(["figures", "trials"]).numbers(["inside 90 %", "lowest", "highest"]).unit("%");
    let mut table = Table::new(head.texts(["lowest of", "highest of"]));
    for group in lines.chunk_by(|a, b| (a.cell, a.method) == (b.cell, b.method)) {
        let [first, ..] = group else { continue };
        let mut cells = row_labels(design, first.cell, first.method);
        cells.push(group.len().to_string());
        cells.push(group.iter().map(|line| line.trials).max().unwrap_or(0).to_string());
        let inside_percent = |line: &PredictionSummary| 100.0 * line.inside as f64 / line.trials as f64;
        let mut sorted: Vec<&PredictionSummary> = group.iter().collect();
        sorted.sort_by(|a, b| inside_percent(a).total_cmp(&inside_percent(b)));
        let ends = [sorted[0], sorted[sorted.len() - 1]];
        let mean = group.iter().map(inside_percent).sum::<f64>() / group.len() as f64;
        cells.extend([mean, inside_percent(ends[0]), inside_percent(ends[1])].map(|value| fixed(value, 1)));
        cells.extend(ends.map(|line| names::figure_of_merit(&line.name).0));
        table.push(cells);
    }
    table
}

/// Decisions on every IMO criterion, over all cells; `None` if no characteristic has a limit.
pub fn criteria(lines: &[PredictionSummary], design: &Design) -> Option<Table> {
    let limited = lines.iter().filter_map(|line| Some((line, line.criterion.as_ref()?)));
    let limited = grouped(limited, |(line, criterion)| (criterion.name.clone(), line.method));
    if limited.is_empty() {
        return None;
    }
    let head = TableHead::default().texts(["criterion", "method"]).counts(["trials", "ships within it"]);
    let columns = ["told rightly", "lower 95", "upper 95", "told wrongly", "lower 95", "upper 95"];
    let mut table = Table::new(head.numbers(columns).unit("%"));
    for ((name, method), lines) in limited {
        let trials: u64 = lines.iter().map(|(line, _)| line.trials).sum();
        let count = |pick: fn(&ImoDecisionTally) -> u64| lines.iter().map(|(_, tally)| pick(tally)).sum::<u64>();
        let mut cells = vec![name.to_string(), design.methods[method].label.clone(), trials.to_string()];
        cells.push(count(|tally| tally.kept).to_string());
        cells.extend(percent(wilson_share(count(|tally| tally.right), trials)));
        cells.extend(percent(wilson_share(count(|tally| tally.wrong), trials)));
        table.push(cells);
    }
    Some(table)
}

/// Share of trials with its 95 % interval.
fn percent(share: Option<Statistic>) -> [String; 3] {
    Statistic::value_and_ends(share).map(|value| optional(value.map(|value| 100.0 * value), 1))
}
