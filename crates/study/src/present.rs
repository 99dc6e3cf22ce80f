//! Tables of what was found, for the screen, `report.md` and other programs.

pub mod methods;

use report::figures::Reference;
use report::number::{self, MISSING};
use report::{Column, Table};

use crate::cli::Format;
use crate::engine::CellFacts;
use crate::showcase::Showcase;
use crate::statistics::Figure;
use crate::summary::{Errors, MethodSummary};

/// Renders a table in the format the user asked for.
pub fn render(table: &Table, format: Format) -> String {
    match format {
        Format::Text => table.to_text(),
        Format::Markdown => table.to_markdown(),
        Format::Csv => table.to_csv(),
        Format::Latex => table.to_latex(),
    }
}

/// The table of a showcase: the methods, and below them the truth and the published values.
pub fn showcase(showcase: &Showcase) -> Table {
    let mut table = methods::table(&showcase.methods, &[]);
    let references = [("truth", showcase.intervals.truth), ("published", showcase.intervals.published)];
    for (name, reference) in references {
        if let Some(Reference { k_per_s, t_s }) = reference {
            let (k, t) = (number::significant(k_per_s, 4), number::significant(t_s, 4));
            table.push([name, &k, MISSING, &t]);
        }
    }
    table
}

/// One row per cell and method: errors over the replicates.
pub fn summary(summaries: &[MethodSummary], facts: &[CellFacts], axes: &[String]) -> Table {
    let mut columns: Vec<Column> = axes.iter().map(|axis| Column::left(axis.clone())).collect();
    columns.push(Column::left("method"));
    columns.push(Column::right("trials"));
    columns.push(Column::right("failed"));
    for index in ["K", "T"] {
        columns.push(Column::decimal(format!("{index} median error")).unit("%"));
        columns.push(Column::left("95 %"));
        columns.push(Column::decimal(format!("{index} rms error")).unit("%"));
        columns.push(Column::left("95 %"));
        columns.push(Column::decimal(format!("{index} coverage")).unit("%"));
        columns.push(Column::decimal(format!("{index} sd/bound")));
    }
    columns.push(Column::decimal("heading error").unit("deg"));
    let mut table = Table::new(columns);
    for summary in summaries {
        let mut cells: Vec<String> = facts[summary.cell].labels.clone();
        cells.extend([summary.method.clone(), summary.trials.to_string(), summary.failed().to_string()]);
        for errors in [&summary.k, &summary.t] {
            cells.extend(error_cells(errors));
        }
        cells.push(figure(summary.heading_rmse_deg, 3));
        table.push(cells);
    }
    table
}

/// The same in the width of a screen: failures, median and rms errors, coverage.
pub fn summary_in_brief(summaries: &[MethodSummary], facts: &[CellFacts], axes: &[String]) -> Table {
    let mut columns: Vec<Column> = axes.iter().map(|axis| Column::left(axis.clone())).collect();
    columns.extend([Column::left("method"), Column::right("failed")]);
    for index in ["K", "T"] {
        columns.push(Column::decimal(format!("{index} median")).unit("%"));
        columns.push(Column::decimal(format!("{index} rms")).unit("%"));
        columns.push(Column::left("95 %"));
        columns.push(Column::right("coverage").unit("%"));
    }
    let mut table = Table::new(columns);
    for summary in summaries {
        let mut cells: Vec<String> = facts[summary.cell].labels.clone();
        cells.extend([summary.method.clone(), format!("{}/{}", summary.failed(), summary.trials)]);
        for errors in [&summary.k, &summary.t] {
            let [median, _, rms, interval, coverage, _] = error_cells(errors);
            cells.extend([median, rms, interval, coverage]);
        }
        table.push(cells);
    }
    table
}

fn error_cells(errors: &Errors) -> [String; 6] {
    let interval = |figure: Option<Figure>| {
        figure.and_then(|figure| figure.ci95).map_or_else(
            || MISSING.to_owned(),
            |[low, high]| format!("[{}, {}]", number::fixed(low, 2), number::fixed(high, 2)),
        )
    };
    let percent = |figure: Option<Figure>| number::optional(figure.map(|figure| 100.0 * figure.value), 1);
    [
        figure(errors.median_percent, 2),
        interval(errors.median_percent),
        figure(errors.rms_percent, 2),
        interval(errors.rms_percent),
        percent(errors.coverage),
        figure(errors.sd_over_bound, 3),
    ]
}

fn figure(figure: Option<Figure>, decimals: usize) -> String {
    number::optional(figure.map(|figure| figure.value), decimals)
}

/// Reasons of failed trials with their counts, one line a cell and method.
pub fn failures(summaries: &[MethodSummary], facts: &[CellFacts]) -> Vec<String> {
    summaries
        .iter()
        .filter(|summary| !summary.failures.is_empty())
        .map(|summary| {
            let reasons: Vec<String> =
                summary.failures.iter().map(|(reason, count)| format!("{count} × {reason}")).collect();
            let place = facts[summary.cell].labels.join(", ");
            let place = if place.is_empty() { String::new() } else { format!("{place}: ") };
            format!(
                "{place}{}: {} of {} failed ({})",
                summary.method,
                summary.failed(),
                summary.trials,
                reasons.join(", ")
            )
        })
        .collect()
}
