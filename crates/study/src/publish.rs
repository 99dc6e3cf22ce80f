//! `study report DIR`: tables and figures of a finished study, from what is stored and nothing else.

pub mod drawings;

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use report::Theme;

use crate::cli::{Common, Format};
use crate::failure::{Failure, OnPath, result_folder};
use crate::present;
use crate::screen;
use crate::store::Stored;
use crate::summary::{self, MethodSummary};
use drawings::{Drawing, write_all};

/// Makes `summary.csv`, the figures and `report.md`, and prints the tables.
///
/// They go where the rows are, or to `--out`.
pub fn report(rows: &Path, common: &Common) -> Result<(), Failure> {
    let stored = Stored::read(rows)?;
    let folder = common.out.as_deref().unwrap_or(rows);
    result_folder(folder)?;
    let design = &stored.design;
    let summaries = summary::summarise(&stored.rows, &design.cells);
    let summary_table = present::summary(&summaries, &design.cells, &design.axes);
    let csv = folder.join("summary.csv");
    fs::write(&csv, summary_table.to_csv()).on("write", &csv)?;

    let drawings = drawings::of(&stored, &summaries);
    write_all(&drawings, &Theme::screen(), folder)?;
    let path = folder.join("report.md");
    fs::write(&path, page(&stored, &summaries, &drawings)).on("write", &path)?;

    match common.format {
        _ if common.quiet => Ok(()),
        Format::Text => screen::say(&format!("{}\nreport: {}", on_screen(&stored, &summaries), path.display())),
        // Another program reads the table: nothing else may stand beside it.
        format => screen::say(present::render(&summary_table, format).trim_end()),
    }
}

/// What a person sees: the first trial of every cell in detail, all trials in brief, failures with their reasons.
fn on_screen(stored: &Stored, summaries: &[MethodSummary]) -> String {
    let Stored { manifest, design, showcases, .. } = stored;
    let mut text = format!("{}: {}\n\n", manifest.name, design.question);
    for showcase in showcases {
        let title = if showcase.title.is_empty() { "first trial" } else { &showcase.title };
        text += &format!("{title}\n{}\n", present::showcase(showcase).to_text());
    }
    text += &present::summary_in_brief(summaries, &design.cells, &design.axes).to_text();
    for failure in present::failures(summaries, &design.cells) {
        text += &format!("\n{failure}");
    }
    text
}

/// `report.md`.
fn page(stored: &Stored, summaries: &[MethodSummary], drawings: &[Drawing]) -> String {
    let Stored { manifest, design, showcases, .. } = stored;
    let mut page = String::new();
    let mut line = |line: &str| writeln!(page, "{line}").expect("writing to a string does not fail");
    let figure = |drawing: &Drawing| format!("![{0}]({1}.png)\n\n*{0}*\n", drawing.caption, drawing.stem);
    line(&format!("# {}\n\n**{}**\n", manifest.name, design.question.trim()));
    if !design.analysis.trim().is_empty() {
        line(&format!("{}\n", design.analysis.trim()));
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
    line("## Over all trials\n");
    drawings.iter().filter(|drawing| drawing.showcase.is_none()).for_each(|drawing| line(&figure(drawing)));
    line(&present::summary(summaries, &design.cells, &design.axes).to_markdown());
    line(
        "Median error with the distribution-free interval, rms error with a bootstrap interval, share of quoted 95 % intervals \
         that hold the truth, and standard deviation over the Cramér–Rao bound.\n",
    );
    for failure in present::failures(summaries, &design.cells) {
        line(&format!("- {failure}"));
    }
    line(&format!(
        "\nMade by `study` {} from the scenario in `manifest.toml` with seed {}; `study report` rebuilds this page from the \
         stored rows.",
        manifest.version, manifest.seed
    ));
    page
}
