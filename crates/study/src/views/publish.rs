//! Published output of a finished study: tables, figures, the page, and the text on the screen.

use std::io::Write as _;

use campaign::design::Design;
use campaign::disk;
use campaign::failure::{Failure, OnPath};
use campaign::folder::ResultFolder;
use campaign::store::StoredStudy;
use campaign::summary::{Summary, Tally, blind_spots};
use rayon::prelude::*;
use report::{Table, Theme};

use super::page_files::{KEY_FIGURE_STEM, MARKDOWN_REPORT_FILE, write_page};
use super::record_study;
use super::study_figures::{self, FigurePlace};
use super::study_page::{on_screen, page};
use super::{blind_spots_table, coverage_table, curve_tables, outcomes, tables, tracing_table};
use crate::documents::{self, answers::StudyAnswer};
use crate::options::{CommonOptions, FigureChoice, Format};
use crate::screen;

/// Writes the tables, the figures, `report.md` and `report.html` to a folder, and prints the tables.
///
/// Fails if a row cannot be read or a file cannot be written.
pub fn write_results(
    stored: &StoredStudy,
    folder: &ResultFolder,
    theme: &Theme,
    figures: FigureChoice,
    common: &CommonOptions,
) -> Result<(), Failure> {
    let design = &stored.design;
    let summary = write_files(stored, folder, theme, figures)?;
    match common.format {
        _ if common.is_silent() => Ok(()),
        Format::Text => {
            let text = match design.is_measured() {
                true => record_study::on_screen(stored, &summary),
                false => on_screen(stored, &summary),
            };
            screen::print_lines(&format!("{text}\nreport: {}", folder.path().join(MARKDOWN_REPORT_FILE).display()))
        }
        // Another program reads the table: standard output has no other text.
        Format::Csv => screen::print_lines(table(&summary, design).to_csv().trim_end()),
        Format::Json => screen::print_unescaped(&document(stored, &summary, folder)?),
        format => {
            let brief = match design.is_measured() {
                true => record_study::brief_record_table(&summary.records, design),
                false => tables::brief_summary_table(&summary, design),
            };
            screen::print_lines(format.render(&brief).trim_end())
        }
    }
}

/// One row for every cell and method, for other programs: `summary.csv`.
fn table(summary: &Summary, design: &Design) -> Table {
    match design.is_measured() {
        true => record_study::record_summary_table(&summary.records, design),
        false => tables::method_summary_table(&summary.methods, design),
    }
}

/// JSON document of a published study. Fails if it cannot be written as JSON.
pub fn document(stored: &StoredStudy, summary: &Summary, folder: &ResultFolder) -> Result<String, Failure> {
    documents::answer_text(&StudyAnswer {
        folder: folder.path().display().to_string(),
        manifest: &stored.manifest,
        summary: table(summary, &stored.design).to_records(),
        failures: tables::failure_lines(summary, &stored.design),
    })
}

/// Writes the tables, the figures, `report.md` and `report.html` to a folder; returns the summary of the rows.
///
/// Fails if a row cannot be read or a file cannot be written.
pub fn write_files(
    stored: &StoredStudy,
    folder: &ResultFolder,
    theme: &Theme,
    figures: FigureChoice,
) -> Result<Summary, Failure> {
    let design = &stored.design;
    if design.is_measured() {
        return record_study::write_files(stored, folder, theme, figures);
    }
    let mut tally = Tally::new(design);
    stored.for_each_row(|row| {
        tally.add(&row);
        Ok(())
    })?;
    let summary = tally.finish();
    write_csv(folder, SUMMARY, &summary.methods, |lines| tables::method_summary_table(lines, design))?;
    if design.methods.len() > 1 {
        let reference = &design.methods[summary.reference];
        write_csv(folder, "pairs.csv", &summary.comparisons, |lines| {
            tables::comparison_table(lines, reference, design)
        })?;
    }
    write_trace_tables(&summary, design, folder)?;
    if !summary.predictions.is_empty() {
        write_csv(folder, "predictions.csv", &summary.predictions, |lines| {
            coverage_table::coverage_table(lines, design)
        })?;
        write_table(folder, "criteria.csv", coverage_table::criterion_decision_table(&summary.predictions, design))?;
        let factors = coverage_table::scaled_coverage_table(&summary.predictions, design);
        write_table(folder, "interval-factors.csv", factors)?;
    }
    let brief = (design.cells.len() <= MAX_LISTED_CELLS).then(|| tables::brief_summary_table(&summary, design));
    if let Some(brief) = &brief {
        folder.write("summary.md", brief.to_markdown())?;
    }
    folder.write("summary.tex", for_paper(&summary, stored))?;
    let figures = study_figures::figures(stored, &summary, figures);
    // The key figure of an earlier scenario is removed, so that it is not taken for a figure of this scenario.
    if figures.iter().all(|(place, _)| *place != FigurePlace::Key) {
        for kind in ["svg", "png"] {
            let path = folder.path().join(format!("{KEY_FIGURE_STEM}.{kind}"));
            disk::remove_if_there(&path).on("remove", &path)?;
        }
    }
    curve_tables::write_showcases(stored, &figures, folder)?;
    write_page(folder, page(stored, &summary, brief, figures), Some(theme))?;
    Ok(summary)
}

/// Writes the tables of the effects that traces named.
fn write_trace_tables(summary: &Summary, design: &Design, folder: &ResultFolder) -> Result<(), Failure> {
    let tracing = &summary.tracing;
    if tracing.is_empty() {
        return Ok(());
    }
    write_csv(folder, "tracing.csv", tracing, |lines| tracing_table::naming_table(lines, summary, design, true))?;
    let reliability = tracing_table::reliability_table(&study_figures::highlighted_trace(design, summary));
    write_table(folder, "reliability.csv", Some(reliability))?;
    write_table(folder, "outcomes.csv", outcomes::outcome_table(design, summary))?;
    let spots = blind_spots(tracing, design);
    let spots = (!spots.is_empty()).then(|| blind_spots_table::blind_spots_table(&spots, design, str::to_owned));
    write_table(folder, "blind-spots.csv", spots)
}

/// Writes a table as CSV, if there is one.
fn write_table(folder: &ResultFolder, name: &str, table: Option<Table>) -> Result<(), Failure> {
    table.map_or(Ok(()), |table| folder.write(name, table.to_csv()))
}

/// `summary.tex`: the methods over all cells, and each against the reference method on the same trials.
fn for_paper(summary: &Summary, stored: &StoredStudy) -> String {
    let overall = tables::overall_paper_table(summary, stored).to_latex();
    match summary.comparisons.is_empty() || stored.design.cells.len() > MAX_LISTED_CELLS {
        true => overall,
        false => format!("{overall}\n{}", tables::comparison_paper_table(summary, stored).to_latex()),
    }
}

const SUMMARY: &str = "summary.csv";

/// Maximum number of cells that are listed one by one for a person; more are in `summary.csv`.
const MAX_LISTED_CELLS: usize = 500;

/// Number of rows that are converted to text at a time.
const CHUNK_LINES: usize = 250;

/// Number of chunks that are converted in parallel.
const PARALLEL_CHUNKS: usize = 16;

/// Writes a long table as CSV, some chunks at a time.
fn write_csv<T: Sync>(
    folder: &ResultFolder,
    name: &str,
    lines: &[T],
    table: impl Fn(&[T]) -> Table + Sync,
) -> Result<(), Failure> {
    let mut file = folder.create_temporary(name)?;
    let path = folder.path().join(name);
    let head = table(&[]).to_csv();
    file.write_all(head.as_bytes()).on("write", &path)?;
    for pieces in lines.chunks(CHUNK_LINES * PARALLEL_CHUNKS) {
        let texts: Vec<String> = pieces.par_chunks(CHUNK_LINES).map(|piece| table(piece).to_csv()).collect();
        texts.iter().try_for_each(|text| file.write_all(&text.as_bytes()[head.len()..])).on("write", &path)?;
    }
    file.persist()
}
