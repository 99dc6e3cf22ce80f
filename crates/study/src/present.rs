//! Tables of what was found, for the screen, `report.md` and other programs.

use report::figures::Reference;
use report::number::{self, MISSING};
use report::{Column, Table};

use crate::cli::Format;
use crate::engine::CellFacts;
use crate::json::{MethodEntry, Status, Value};
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

/// One row per method: K, T and δ_r with intervals, and the error of the replay.
pub fn methods(entries: &[MethodEntry]) -> Table {
    let validated: Vec<String> =
        entries.first().map(|entry| entry.validation.iter().map(|v| v.file.clone()).collect()).unwrap_or_default();
    let mut columns = vec![
        Column::left("method"),
        Column::decimal("K").unit("1/s"),
        Column::left("95 % interval"),
        Column::decimal("T").unit("s"),
        Column::left("95 % interval"),
        Column::decimal("δ_r").unit("deg"),
        Column::left("95 % interval"),
        Column::decimal("heading error").unit("deg"),
    ];
    columns.extend(validated.iter().map(|file| Column::decimal(format!("error on {}", stem(file))).unit("deg")));
    columns.push(Column::left("remark"));
    let mut table = Table::new(columns);
    for entry in entries {
        let mut cells = vec![entry.method.clone()];
        match &entry.parameters {
            Some(parameters) => {
                for value in [&parameters.k_per_s, &parameters.t_s, &parameters.delta_r_deg] {
                    cells.extend([estimate(value), number::interval(value.ci95)]);
                }
            }
            None => cells.extend((0..6).map(|_| MISSING.to_owned())),
        }
        cells.push(number::optional(entry.heading_rmse_deg, 3));
        cells.extend(entry.validation.iter().map(|validation| number::optional(validation.heading_rmse_deg, 3)));
        cells.push(remark(entry));
        table.push(cells);
    }
    table
}

/// A value with as many digits as its error deserves, five significant ones where it has none.
fn estimate(value: &Value) -> String {
    match (value.value, value.ci95) {
        (Some(number), Some([low, high])) if high > low => {
            let decimals = (1.0 - (0.5 * (high - low)).log10().floor()).clamp(0.0, 9.0) as usize;
            number::fixed(number, decimals)
        }
        (Some(number), _) => number::significant(number, 4),
        (None, _) => MISSING.to_owned(),
    }
}

fn remark(entry: &MethodEntry) -> String {
    match (&entry.status, &entry.reason, entry.course_unstable) {
        (Status::Failed, Some(reason), _) => format!("failed: {reason}"),
        (_, _, true) => "course-unstable".to_owned(),
        _ => String::new(),
    }
}

/// The table of a showcase: the methods, and below them the truth and the published values.
pub fn showcase(showcase: &Showcase) -> Table {
    let mut table = methods(&showcase.methods);
    let references = [("truth", showcase.intervals.truth), ("published", showcase.intervals.published)];
    for (name, reference) in references {
        if let Some(Reference { k_per_s, t_s }) = reference {
            let (k, t) = (number::significant(k_per_s, 4), number::significant(t_s, 4));
            table.push([name, &k, MISSING, &t]);
        }
    }
    table
}

fn stem(file: &str) -> String {
    std::path::Path::new(file).file_stem().map_or_else(|| file.to_owned(), |stem| stem.to_string_lossy().into_owned())
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
        figure.and_then(|figure| figure.ci95).map_or_else(|| MISSING.to_owned(), |[low, high]| {
            format!("[{}, {}]", number::fixed(low, 2), number::fixed(high, 2))
        })
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
            format!("{place}{}: {} of {} failed ({})", summary.method, summary.failed(), summary.trials, reasons.join(", "))
        })
        .collect()
}
