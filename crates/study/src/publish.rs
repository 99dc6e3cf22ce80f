//! `study report DIR`: tables and figures of a finished study, from what is stored and nothing else.

mod charts;
pub mod drawings;
mod traces;

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use rayon::prelude::*;
use report::{Table, Theme, markdown, number};

use crate::cli::{Common, Format, Style};
use crate::failure::{Failure, OnPath};
use crate::folder::ResultFolder;
use crate::present;
use crate::screen;
use crate::store::{self, Design, Stored};
use crate::summary::{Summary, Tally};
use drawings::{Drawing, write_all};

/// Makes tables, figures and `report.md` of a finished study where its rows are, or in `--out`.
pub fn report(rows: &Path, style: &Style, common: &Common) -> Result<(), Failure> {
    let theme = style.theme()?;
    let is_same =
        |out: &Path| out.canonicalize().ok().zip(rows.canonicalize().ok()).is_some_and(|(out, rows)| out == rows);
    match common.out.as_deref().filter(|out| !is_same(out)) {
        Some(out) => {
            let stored = Stored::read(rows)?;
            publish(&stored, &ResultFolder::hold(out)?, &theme, common)
        }
        None => {
            store::is_finished(rows)?;
            let folder = ResultFolder::hold(rows)?;
            publish(&Stored::held(&folder)?, &folder, &theme, common)
        }
    }
}

/// Makes the tables, the figures and `report.md` in a folder, and prints the tables.
pub fn publish(stored: &Stored, folder: &ResultFolder, theme: &Theme, common: &Common) -> Result<(), Failure> {
    let design = &stored.design;
    let mut tally = Tally::new(design);
    stored.rows(|row| {
        tally.add(&row);
        Ok(())
    })?;
    let summary = tally.finish();
    write_csv(folder, SUMMARY, &summary.methods, |lines| present::summary(lines, design))?;
    if design.methods.len() > 1 {
        let reference = &design.methods[summary.reference];
        write_csv(folder, "pairs.csv", &summary.pairs, |lines| present::pairs(lines, reference, design))?;
    }
    if !summary.tracing.is_empty() {
        write_csv(folder, "tracing.csv", &summary.tracing, |lines| {
            present::tracing::table(lines, &summary, design, true)
        })?;
    }
    let brief = is_readable(design).then(|| present::summary_in_brief(&summary, design));
    if let Some(brief) = &brief {
        folder.write("summary.md", brief.to_markdown())?;
        folder.write("summary.tex", brief.to_latex())?;
    }
    let drawings = drawings::of(stored, &summary);
    write_all(&drawings, theme, folder)?;
    // Whatever a scenario or a label holds: no HTML.
    folder.write(REPORT, markdown::prose(&page(stored, &summary, brief.as_ref(), &drawings)))?;

    match common.format {
        _ if common.quiet => Ok(()),
        Format::Text => {
            let page = folder.path().join(REPORT);
            screen::say(&format!("{}\nreport: {}", on_screen(stored, &summary), page.display()))
        }
        // Another program reads the table: nothing else may stand beside it.
        Format::Csv => screen::say(present::summary(&summary.methods, design).to_csv().trim_end()),
        format => {
            let brief = brief.unwrap_or_else(|| present::summary_in_brief(&summary, design));
            screen::say(present::render(&brief, format).trim_end())
        }
    }
}

const SUMMARY: &str = "summary.csv";
const REPORT: &str = "report.md";

/// Cells that are listed one by one for a person to read; more are in `summary.csv`.
const LISTED_CELLS: usize = 500;

fn is_readable(design: &Design) -> bool {
    design.cells.len() <= LISTED_CELLS
}

/// Lines that are turned into text at a time.
const PIECE: usize = 250;

/// Pieces that are made in parallel.
const PIECES: usize = 16;

/// Writes a long table as CSV, some pieces at a time.
fn write_csv<T: Sync>(
    folder: &ResultFolder,
    name: &str,
    lines: &[T],
    table: impl Fn(&[T]) -> Table + Sync,
) -> Result<(), Failure> {
    let mut file = folder.create(name)?;
    let path = folder.path().join(name);
    let head = table(&[]).to_csv();
    file.write_all(head.as_bytes()).on("write", &path)?;
    for pieces in lines.chunks(PIECE * PIECES) {
        let texts: Vec<String> = pieces.par_chunks(PIECE).map(|piece| table(piece).to_csv()).collect();
        texts.iter().try_for_each(|text| file.write_all(&text.as_bytes()[head.len()..])).on("write", &path)?;
    }
    file.put()
}

/// Cells whose lines go on the screen; more are in the files.
const SHOWN_CELLS: usize = 12;

/// What a person sees: the first trial of every cell in detail, all trials in brief, failures with their reasons.
fn on_screen(stored: &Stored, summary: &Summary) -> String {
    let Stored { manifest, design, showcases, .. } = stored;
    let mut text = format!("{}: {}\n\n", manifest.name, design.words.question.trim());
    for showcase in showcases {
        let title = if showcase.title.is_empty() { "first trial" } else { &showcase.title };
        text += &format!("{title}\n{}\n", present::showcase(showcase).to_text());
    }
    if design.cells.len() <= SHOWN_CELLS {
        text += &present::summary_in_brief(summary, design).to_text();
    } else {
        text += &format!("over all {} cells, which are in the report one by one\n", design.cells.len());
        text += &present::overall(summary, design).to_text();
    }
    if !summary.tracing.is_empty() {
        text += &format!("\nwhat traces named\n{}", present::tracing::kinds(&summary.tracing).to_text());
    }
    let failures = present::failures(summary, design);
    failures.iter().take(SHOWN_CELLS).for_each(|failure| text += &format!("\n{failure}"));
    if failures.len() > SHOWN_CELLS {
        text += &format!("\n… and {} lines more in the report", failures.len() - SHOWN_CELLS);
    }
    text
}

/// `report.md`.
///
/// `brief` holds the cells one by one, where a person may read them all.
fn page(stored: &Stored, summary: &Summary, brief: Option<&Table>, drawings: &[Drawing]) -> String {
    let Stored { manifest, design, showcases, timings, .. } = stored;
    let mut page = String::new();
    let mut line = |line: &str| writeln!(page, "{line}").expect("writing to a string does not fail");
    let figure = |drawing: &Drawing| format!("![{0}]({1}.png)\n\n*{0}*\n", drawing.caption, drawing.stem);
    line(&format!("# {}\n\n**{}**\n", manifest.name, design.words.question.trim()));
    for prose in [&design.words.finding, &design.words.analysis] {
        if !prose.trim().is_empty() {
            line(&format!("{}\n", prose.trim()));
        }
    }
    for (index, showcase) in showcases.iter().enumerate() {
        let title = if showcase.title.is_empty() { "The first trial" } else { &showcase.title };
        line(&format!("## {title}\n\n{}", present::showcase(showcase).to_markdown()));
        for entry in &showcase.methods {
            entry.warnings.iter().for_each(|warning| line(&format!("- {}: {warning}", entry.method)));
        }
        line("");
        drawings.iter().filter(|drawing| drawing.showcase == Some(index)).for_each(|drawing| line(&figure(drawing)));
    }
    if !summary.tracing.is_empty() {
        line(&format!("## What traces named\n\n{}", present::tracing::kinds(&summary.tracing).to_markdown()));
        line(&format!(
            "*all named*: every missing effect is in one of the groups named; *wrong named*: a group was named that holds no \
             missing effect; *clear*: the one missing effect alone gains {} more in BIC than any other alone. Intervals are \
             Wilson's, 95 %.\n",
            crate::summary::CLEAR
        ));
        drawings.iter().filter(|drawing| drawing.of_traces).for_each(|drawing| line(&figure(drawing)));
        line(&present::tracing::table(&summary.tracing, summary, design, false).to_markdown());
    }
    line("## Over all trials\n");
    drawings
        .iter()
        .filter(|drawing| drawing.showcase.is_none() && !drawing.of_traces)
        .for_each(|drawing| line(&figure(drawing)));
    if design.cells.len() > 1 {
        line("### All cells together\n");
        line(&present::overall(summary, design).to_markdown());
        line("### Cell by cell\n");
    }
    match brief {
        Some(brief) => line(&brief.to_markdown()),
        None => line(&format!("The {} cells are in `summary.csv`.\n", design.cells.len())),
    }
    line(
        "Errors of K and T are relative to the truth. *median*, *rms*: median and root mean square error, with a bootstrap \
         interval; *coverage*: share of quoted 95 % intervals that hold the truth; *sd/bound*: standard deviation over the \
         Cramér–Rao bound; *validation*: median error of the heading on a manoeuvre no method has seen. All figures with all \
         intervals are in `summary.csv`, comparisons on the same trials in `pairs.csv`, times in `timings.csv`.\n",
    );
    let times: Vec<String> = design
        .methods
        .iter()
        .enumerate()
        .filter_map(|(index, method)| Some((method, timings.mean_us(index)?)))
        .map(|(method, (mean, error))| format!("{} {}", method.label, number::with_uncertainty(mean, Some(error))))
        .collect();
    if !times.is_empty() {
        line(&format!(
            "Mean time of an identification on this run's machine with its standard error, µs: {}.\n",
            times.join(", ")
        ));
    }
    for failure in present::failures(summary, design) {
        line(&format!("- {failure}"));
    }
    line(&format!(
        "\nMade by `study` {} from the scenario in `manifest.toml` with seed {}; `study report` rebuilds this page from the \
         stored rows, `study manifest.toml --out DIR` runs it again.",
        manifest.version, manifest.seed
    ));
    page
}
