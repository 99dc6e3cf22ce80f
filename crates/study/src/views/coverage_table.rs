//! Tables of predictions in a study: coverage of the intervals, by characteristic.

use std::collections::BTreeSet;

use document::names;
use estimation::statistics::median;
use report::number::{MISSING, fixed, optional, significant};
use report::{Table, TableHead};

use super::tables::{cell_and_method_head, row_labels};
use campaign::design::Design;
use campaign::statistics::{Statistic, grouped, wilson_share};
use campaign::summary::{ConformalScaling, ImoDecisionTally, PredictionSummary};

/// Coverage of every characteristic of every cell and method.
pub fn coverage_table(lines: &[PredictionSummary], design: &Design) -> Table {
    let head = cell_and_method_head(design).texts(["figure", "unit"]).counts(["trials"]);
    let head = head.numbers(["inside 90 %", "lower 95", "upper 95"]).unit("%");
    let mut table = Table::new(head.numbers(["of the ship", "bias", "rms error", "width", "interval score"]));
    for line in lines {
        let mut cells = row_labels(design, line.cell, line.method);
        let (name, unit) = names::figure_of_merit(&line.characteristic);
        cells.extend([name, unit.to_owned(), line.trials.to_string()]);
        cells.extend(percent(line.coverage()));
        let values = [
            line.mean_truth(),
            line.median_bias(),
            line.rms_error(),
            line.mean_interval_width(),
            line.mean_interval_score(),
        ];
        cells.extend(values.map(|value| significant(value, 3)));
        table.push(cells);
    }
    table
}

/// Table by cell and method over all characteristics: mean, minimum and maximum share inside the 90 % interval, median
/// relative width and interval score.
pub fn pooled_coverage_table(lines: &[PredictionSummary], design: &Design) -> Table {
    let columns = ["inside 90 %", "lowest", "highest", "width of the value", "interval score of the value"];
    let head = cell_and_method_head(design).counts(["figures", "trials"]).numbers(columns).unit("%");
    let mut table = Table::new(head.texts(["lowest of", "highest of"]));
    for group in lines.chunk_by(|a, b| (a.cell, a.method) == (b.cell, b.method)) {
        let [first, ..] = group else { continue };
        let mut cells = row_labels(design, first.cell, first.method);
        cells.push(group.len().to_string());
        cells.push(group.iter().map(|line| line.trials).max().unwrap_or(0).to_string());
        let inside_percent = |line: &PredictionSummary| 100.0 * line.inside_share();
        let mut sorted: Vec<&PredictionSummary> = group.iter().collect();
        sorted.sort_by(|a, b| inside_percent(a).total_cmp(&inside_percent(b)));
        let ends = [sorted[0], sorted[sorted.len() - 1]];
        let mean = group.iter().map(inside_percent).sum::<f64>() / group.len() as f64;
        cells.extend([mean, inside_percent(ends[0]), inside_percent(ends[1])].map(|value| fixed(value, 1)));
        for value in [PredictionSummary::mean_interval_width, PredictionSummary::mean_interval_score] {
            let mut relative: Vec<f64> = group.iter().map(|line| 100.0 * line.relative_to_truth(value(line))).collect();
            cells.push(optional(median(&mut relative), 1));
        }
        cells.extend(ends.map(|line| names::figure_of_merit(&line.characteristic).0));
        table.push(cells);
    }
    table
}

/// Intervals of every ship scaled by the factor that those of all other ships need; `None` without an axis `ship` of
/// three points or more.
pub fn scaled_coverage_table(lines: &[PredictionSummary], design: &Design) -> Option<Table> {
    let axis = design.axes.iter().position(|name| name == "ship")?;
    let ship = |line: &PredictionSummary| &design.cells[line.cell].labels[axis];
    let by_ship = grouped(lines.iter(), |line| (line.method, ship(line).clone()));
    if by_ship.iter().map(|((_, ship), _)| ship).collect::<BTreeSet<_>>().len() < 3 {
        return None;
    }
    let head = TableHead::default().texts(["ship", "method"]).numbers(["factor of the others"]);
    let columns = ["inside 90 %", "inside scaled", "interval score of the value", "score scaled"];
    let mut table = Table::new(head.numbers(columns).unit("%"));
    for ((method, name), judged) in &by_ship {
        let other_ships: Vec<_> = lines.iter().filter(|line| line.method == *method && ship(line) != name).collect();
        let mut cells = vec![name.clone(), design.methods[*method].label.clone()];
        match ConformalScaling::from_calibration(judged, &other_ships) {
            Some(scaling) => {
                cells.push(fixed(scaling.factor, 2));
                cells.extend(scaling.coverage.map(|share| fixed(100.0 * share, 1)));
                cells.extend(scaling.score.map(|score| significant(100.0 * score, 3)));
            }
            None => cells.extend([MISSING; 5].map(str::to_owned)),
        }
        table.push(cells);
    }
    Some(table)
}

/// Decisions on every IMO criterion, over all cells; `None` if no characteristic has a limit.
pub fn criterion_decision_table(lines: &[PredictionSummary], design: &Design) -> Option<Table> {
    let limited = lines.iter().filter_map(|line| Some((line, line.criterion.as_ref()?)));
    let limited = grouped(limited, |(line, criterion)| (criterion.name.clone(), line.method));
    if limited.is_empty() {
        return None;
    }
    let head = TableHead::default().texts(["criterion", "method"]).counts(["trials", "ships within it"]);
    let columns = ["decided rightly", "lower 95", "upper 95", "decided wrongly", "lower 95", "upper 95"];
    let mut table = Table::new(head.numbers(columns).unit("%"));
    for ((name, method), lines) in limited {
        let trials: u64 = lines.iter().map(|(line, _)| line.trials).sum();
        let count = |pick: fn(&ImoDecisionTally) -> u64| lines.iter().map(|(_, tally)| pick(tally)).sum::<u64>();
        let mut cells = vec![name.to_string(), design.methods[method].label.clone(), trials.to_string()];
        cells.push(count(|tally| tally.meeting_trials).to_string());
        cells.extend(percent(wilson_share(count(|tally| tally.right), trials)));
        cells.extend(percent(wilson_share(count(|tally| tally.wrong), trials)));
        table.push(cells);
    }
    Some(table)
}

/// Share and the ends of its 95 % interval, %, as texts.
fn percent(share: Option<Statistic>) -> [String; 3] {
    Statistic::value_and_ends(share).map(|value| optional(value.map(|value| 100.0 * value), 1))
}
