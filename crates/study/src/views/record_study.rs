//! Output of a finished study of measured records: its tables, its figure and its page.

use std::collections::HashSet;

use askama::Template;
use campaign::design::Design;
use campaign::failure::Failure;
use campaign::folder::ResultFolder;
use campaign::manifest::Manifest;
use campaign::rows::StudyRow;
use campaign::scenario::Prose;
use campaign::statistics::{MIN_SUMMARISED_VALUES, Statistic, distinct};
use campaign::store::StoredStudy;
use campaign::summary::{RecordSummary, Summary, Tally, record_summaries};
use document::names;
use report::figures::{AxisSpec, NamedRows, Plot, RowItem, RowKind, RowPlace, RowsColumn, TickRule};
use report::markdown::escaped_text;
use report::number::{self, MISSING, counted, significant};
use report::palette::CurveStyle;
use report::{CurveOrigin, Page, PageFigure, PlacedFigures, Table, Theme};

use super::key_rows::tint;
use super::page_files::write_page;
use super::remarks::{joined_remarks, trace_remark};
use super::study_figures::{self, FigurePlace, StudyFigure};
use super::{coverage_table, tables};
use crate::options::FigureChoice;

/// Name of the table of all fits.
const RECORDS: &str = "records.csv";

/// Name of the table of the parameters of named effects.
const EFFECTS: &str = "effects.csv";

/// Stem of the figure of errors on held-out records.
const JUDGED: &str = "judged";

/// One row for every cell and method, for a person.
pub fn brief_record_table(lines: &[RecordSummary], design: &Design) -> Table {
    let mut head = tables::cell_and_method_head(design).counts(["failed"]);
    for name in ["own error", "judged error"] {
        head = head.numbers([name]).unit("deg").interval95();
    }
    let first = &design.methods[0].label;
    let head = head.numbers([format!("over {first}")]).interval95().numbers(["over it in 60 s"]).interval95();
    let head = head.texts(["named"]);
    let mut table = Table::new(head);
    for line in lines {
        let mut cells = tables::row_labels(design, line.cell, line.method);
        cells.push(format!("{}/{}", line.failed, line.fits));
        for figure in [line.fitted_deg, line.validation_deg, line.ratio, line.window_ratio] {
            cells.push(
                figure
                    .map_or_else(|| MISSING.into(), |figure| number::with_supported_digits(figure.value, figure.ci95)),
            );
            cells.push(number::interval(figure.and_then(|figure| figure.ci95)));
        }
        let named = line.named.iter().map(|(id, count)| format!("{} ({count})", names::effect_name(id)));
        cells.push(named.collect::<Vec<_>>().join(", "));
        table.push(cells);
    }
    table
}

/// `summary.csv`: one row for every cell and method, for other programs.
pub fn record_summary_table(lines: &[RecordSummary], design: &Design) -> Table {
    let mut head = tables::cell_and_method_head(design).counts(["fits", "failed"]);
    for name in ["own error [deg]", "judged error [deg]", "ratio to the first method", "ratio in 60 s"] {
        head = head.numbers(["", " lower 95", " upper 95"].map(|end| format!("{name}{end}")));
    }
    let mut table = Table::new(head.texts(["named"]));
    for line in lines {
        let mut cells = tables::row_labels(design, line.cell, line.method);
        cells.extend([line.fits.to_string(), line.failed.to_string()]);
        for figure in [line.fitted_deg, line.validation_deg, line.ratio, line.window_ratio] {
            let ends = Statistic::value_and_ends(figure);
            cells.extend(ends.map(|value| value.map_or_else(String::new, |value| significant(value, 6))));
        }
        cells.push(line.named.iter().map(|(id, count)| format!("{id}={count}")).collect::<Vec<_>>().join("+"));
        table.push(cells);
    }
    table
}

/// Table of every fit and the record that validates it: K, T, heading errors, verdict, named effects and failure.
fn trials(rows: &[StudyRow], design: &Design) -> Table {
    let head = tables::cell_and_method_head(design).texts(["fitted", "judge"]);
    let head = head.numbers(["K_per_s", "T_s", "own_error_deg", "judged_error_deg"]);
    let mut table = Table::new(head.texts(["verdict", "named", "failure"]));
    let number = |value: Option<f64>| value.map_or_else(String::new, |number| significant(number, 6));
    for row in rows {
        let cell = &design.cells[row.cell as usize];
        let Some(record) = cell.records.get(row.replicate as usize) else { continue };
        let mut cells = tables::row_labels(design, row.cell as usize, row.method);
        cells.extend([record.fitted.clone(), record.validation.clone().unwrap_or_default()]);
        cells.extend([row.k_per_s, row.t_s, row.heading_rmse_deg, row.validation_rmse_deg].map(number));
        let traced = row.traced.as_ref();
        cells.push(traced.map_or_else(String::new, |trace| trace.verdict.to_string()));
        let named =
            traced.map(|trace| trace.named_effects.iter().map(|effect| effect.id.to_string()).collect::<Vec<_>>());
        cells.push(named.unwrap_or_default().join("+"));
        cells.push(row.failure.as_deref().unwrap_or_default().to_owned());
        table.push(cells);
    }
    table
}

/// Table of the parameters of the effects that every fit named, one row each.
fn effects(rows: &[StudyRow], design: &Design) -> Table {
    let head = tables::cell_and_method_head(design).texts(["fitted", "effect", "parameter"]).numbers(["value", "sd"]);
    let mut table = Table::new(head);
    // A fit has a row for each record on which it is validated.
    let mut fits = HashSet::new();
    for row in rows {
        let cell = &design.cells[row.cell as usize];
        let Some(record) = cell.records.get(row.replicate as usize) else { continue };
        let named = row.traced.iter().flat_map(|traced| &traced.named_effects);
        if row.traced.is_none() || !fits.insert((row.cell, row.method, &record.fitted)) {
            continue;
        }
        for effect in named {
            for size in &effect.parameters {
                let mut cells = tables::row_labels(design, row.cell as usize, row.method);
                cells.extend([record.fitted.clone(), effect.id.to_string(), size.symbol.to_string()]);
                cells
                    .extend([Some(size.value), size.sd].map(|end| end.map_or_else(String::new, |x| significant(x, 6))));
                table.push(cells);
            }
        }
    }
    table
}

/// Figure of the heading error of every method on every held-out record, one row per cell and method.
fn judged(rows: &[StudyRow], lines: &[RecordSummary], design: &Design) -> PageFigure {
    let marks = |line: &RecordSummary| {
        let method = &design.methods[line.method];
        let style = CurveOrigin::Method(method.id.clone()).style();
        let pale = CurveStyle { colour: tint(style.colour), ..style };
        let trials = rows.iter().filter(|row| (row.cell as usize, row.method) == (line.cell, line.method));
        let mut items: Vec<RowItem> = trials
            .filter_map(|row| row.validation_rmse_deg)
            .map(|error| RowItem {
                place: RowPlace::SameLine,
                ..RowItem::new("", RowKind::Mark(pale, error, None)).clipped_if_far()
            })
            .collect();
        let median = line.validation_deg.filter(|_| items.len() >= MIN_SUMMARISED_VALUES);
        items.extend(median.map(|median| RowItem {
            number: Some(degrees_text(median.value)),
            place: RowPlace::Below,
            ..RowItem::new(&method.label, RowKind::Mark(style, median.value, median.ci95))
        }));
        items.iter_mut().take(1).for_each(|item| item.place = RowPlace::Below);
        items
    };
    let cells: Vec<usize> = distinct(lines.iter().map(|line| line.cell));
    let count = |cell: usize| {
        let is_judged = |row: &&StudyRow| (row.cell as usize, row.method) == (cell, lines[0].method);
        rows.iter().filter(is_judged).filter(|row| row.validation_rmse_deg.is_some()).count()
    };
    let fits = |cell: usize| lines.iter().find(|line| line.cell == cell).map_or(0, |line| line.fits as u64);
    let name = |&cell: &usize| {
        let labels = design.cells[cell].labels.join(", ");
        format!("{labels} ({}, n = {})", counted(fits(cell), "fit"), count(cell))
    };
    let names: Vec<String> = cells.iter().map(name).collect();
    let row = |&cell: &usize| lines.iter().filter(|line| line.cell == cell).flat_map(marks).collect();
    let column = RowsColumn {
        x: AxisSpec::new("rms heading error on records that were not fitted [°]", TickRule::Logarithmic),
        rows: cells.iter().map(row).collect(),
        ..RowsColumn::default()
    };
    let caption = "Heading error of every method on held-out records: the recorded rudder is replayed; only the initial state is fitted. \
                   Pale marks: trials; dark marks: medians, with 95 % intervals over fits for six or more.";
    let plot = NamedRows {
        names,
        columns: vec![column],
        note: Some(joined_remarks([
            Some("n: predicted records. Pale: each of them. Dark: their median, with an interval from six fits on."),
            trace_remark(design),
        ])),
        ..NamedRows::default()
    };
    PageFigure::new(JUDGED, finding(lines, design), caption, Plot::from(plot))
}

/// Angle, deg, with two significant digits and the sign of a degree.
pub fn degrees_text(value: f64) -> String {
    format!("{}°", significant(value, 2))
}

/// Maximum number of cells that a finding names one by one.
const MAX_NAMED_CELLS: usize = 3;

/// Finding: error ratio of the method with the smallest error over all cells.
fn finding(lines: &[RecordSummary], design: &Design) -> String {
    let first = &design.methods[0].label;
    let ratios = |method: usize| -> Vec<(usize, f64)> {
        let method_lines = lines.iter().filter(|line| line.method == method);
        method_lines.filter_map(|line| Some((line.cell, line.ratio?.value))).collect()
    };
    let mean = |method: &usize| {
        let all = ratios(*method);
        all.iter().map(|(_, ratio)| ratio.ln()).sum::<f64>() / all.len() as f64
    };
    let methods = (1..design.methods.len()).filter(|method| ratios(*method).len() == design.cells.len());
    let Some(best) = methods.min_by(|a, b| mean(a).total_cmp(&mean(b))) else {
        return format!("Heading error of {first} on records that were not fitted");
    };
    let method = &design.methods[best].label;
    let median = |cell: usize, method: usize| {
        let line = lines.iter().find(|line| (line.cell, line.method) == (cell, method));
        line.and_then(|line| line.validation_deg).map_or(f64::NAN, |median| median.value)
    };
    let ratios = ratios(best);
    if ratios.len() > MAX_NAMED_CELLS {
        let end = |pick: fn(f64, f64) -> f64| ratios.iter().map(|(_, ratio)| *ratio).reduce(pick).unwrap_or(f64::NAN);
        let [least, most] = [f64::min, f64::max].map(|pick| significant(end(pick), 2));
        return format!("On records not fitted the error of {method} is {least} to {most} of that of {first}");
    }
    let errors = ratios.iter().map(|(cell, _)| {
        let labels = design.cells[*cell].labels.join(", ");
        let place = if labels.is_empty() { String::new() } else { format!(" ({labels})") };
        format!("{} → {}{place}", degrees_text(median(*cell, 0)), degrees_text(median(*cell, best)))
    });
    format!("On records not fitted {first} → {method}: {}", errors.collect::<Vec<_>>().join(", "))
}

/// Text on the screen: question, table, coverage of predictions.
pub fn on_screen(stored: &StoredStudy, summary: &Summary) -> String {
    let design = &stored.design;
    let mut text = format!("{}: {}\n\n", stored.manifest.name, design.prose.question.trim());
    text += &brief_record_table(&summary.records, design).to_text();
    if !summary.predictions.is_empty() {
        text += "\ncoverage of 90 % prediction intervals\n";
        text += &coverage_table::pooled_coverage_table(&summary.predictions, design).to_text();
    }
    text
}

/// Template of `report.md`.
#[derive(Template)]
#[template(path = "records.md", escape = "none")]
struct RecordsPage<'a> {
    manifest: &'a Manifest,
    prose: &'a Prose,
    brief: Table,
    coverage: Option<Table>,
    figures: PlacedFigures<FigurePlace>,
}

fn page(stored: &StoredStudy, summary: &Summary, figures: Vec<StudyFigure>) -> Page {
    let StoredStudy { manifest, design, .. } = stored;
    let predictions = &summary.predictions;
    let page = RecordsPage {
        manifest,
        prose: &design.prose,
        brief: brief_record_table(&summary.records, design),
        coverage: (!predictions.is_empty()).then(|| coverage_table::pooled_coverage_table(predictions, design)),
        figures: PlacedFigures(figures),
    };
    Page::new(page.render(), page.figures)
}

/// Writes the tables, the figure and the page to a folder; returns the summary of the rows.
///
/// Fails if rows are missing, or if a file cannot be written.
pub fn write_files(
    stored: &StoredStudy,
    folder: &ResultFolder,
    theme: &Theme,
    choice: FigureChoice,
) -> Result<Summary, Failure> {
    let design = &stored.design;
    let (mut rows, mut tally) = (Vec::new(), Tally::new(design));
    stored.for_each_row(|row| {
        tally.add(&row);
        rows.push(row);
        Ok(())
    })?;
    let made = Summary { records: record_summaries(&rows, design), ..tally.finish() };
    folder.write("summary.csv", record_summary_table(&made.records, design).to_csv())?;
    folder.write(RECORDS, trials(&rows, design).to_csv())?;
    if rows.iter().any(|row| row.traced.is_some()) {
        folder.write(EFFECTS, effects(&rows, design).to_csv())?;
    }
    if !made.predictions.is_empty() {
        folder.write("predictions.csv", coverage_table::coverage_table(&made.predictions, design).to_csv())?;
    }
    let judges = rows.iter().any(|row| row.validation_rmse_deg.is_some());
    let all = || {
        let judged = judges.then(|| (FigurePlace::Traces, judged(&rows, &made.records, design)));
        let held = study_figures::prediction_coverage(design, &made).map(|figure| (FigurePlace::AllTrials, figure));
        judged.into_iter().chain(held).collect()
    };
    let figures = study_figures::chosen_figures(all, design, choice);
    write_page(folder, page(stored, &made, figures), Some(theme))?;
    Ok(made)
}
