//! Tables of predictions in a study: whether intervals hold, figure by figure.

use report::number::{fixed, optional, significant};
use report::{Table, TableColumn};

use super::predict_tables::words;
use super::tables::{head, place};
use campaign::design::Design;
use campaign::statistics::Statistic;
use campaign::summary::PredictionSummary;

/// Every figure of every cell and method.
pub fn table(lines: &[PredictionSummary], design: &Design) -> Table {
    let mut columns = head(design);
    columns.extend(TableColumn::all(
        "figure | unit | >trials | .inside 90 % [%] | .lower 95 [%] | .upper 95 [%] | .of the ship | .bias | .rms error | \
         .width",
    ));
    let mut table = Table::new(columns);
    for line in lines {
        let mut cells = place(design, line.cell, line.method);
        let (name, unit) = words(&line.name);
        cells.extend([name, unit.to_owned(), line.trials.to_string()]);
        cells.extend(percent(line));
        cells.extend([line.truth(), line.bias(), line.rms(), line.width()].map(|value| significant(value, 3)));
        table.push(cells);
    }
    table
}

/// All figures of a cell and a method together: the mean of their shares, and the lowest and the highest of them.
pub fn pooled(lines: &[PredictionSummary], design: &Design) -> Table {
    let mut columns = head(design);
    let heads = ">figures | >trials | .inside 90 % [%] | .lowest [%] | .highest [%] | lowest of | highest of";
    columns.extend(TableColumn::all(heads));
    let mut table = Table::new(columns);
    for group in lines.chunk_by(|one, other| (one.cell, one.method) == (other.cell, other.method)) {
        let [first, ..] = group else { continue };
        let mut cells = place(design, first.cell, first.method);
        cells.push(group.len().to_string());
        cells.push(group.iter().map(|line| line.trials).max().unwrap_or(0).to_string());
        let of = |line: &PredictionSummary| 100.0 * line.inside as f64 / line.trials as f64;
        let mut sorted: Vec<&PredictionSummary> = group.iter().collect();
        sorted.sort_by(|one, other| of(one).total_cmp(&of(other)));
        let ends = [sorted[0], sorted[sorted.len() - 1]];
        let mean = group.iter().map(of).sum::<f64>() / group.len() as f64;
        cells.extend([mean, of(ends[0]), of(ends[1])].map(|value| fixed(value, 1)));
        cells.extend(ends.map(|line| words(&line.name).0));
        table.push(cells);
    }
    table
}

/// The share of trials whose interval holds, with its own 95 % interval.
fn percent(line: &PredictionSummary) -> [String; 3] {
    Statistic::flat(line.coverage()).map(|value| optional(value.map(|value| 100.0 * value), 1))
}
