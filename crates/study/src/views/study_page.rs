//! What is said of a finished study: `report.md`, and the lines on the screen.

use std::fmt::Write as _;

use campaign::store::StoredStudy;
use campaign::summary::Summary;
use report::{Table, number};

use super::drawings::{Drawing, HERO};
use super::{coverage_table, tables, tracing_table};

/// Cells whose lines go on the screen; more are in the files.
const SHOWN_CELLS: usize = 12;

/// What a person sees: the first trial of every cell in detail, all trials in brief, failures with their reasons.
pub fn on_screen(stored: &StoredStudy, summary: &Summary) -> String {
    let StoredStudy { manifest, design, showcases, .. } = stored;
    let mut text = format!("{}: {}\n\n", manifest.name, design.words.question.trim());
    for showcase in showcases {
        let title = if showcase.title.is_empty() { "first trial" } else { &showcase.title };
        text += &format!("{title}\n{}\n", tables::showcase(showcase).to_text());
    }
    if design.cells.len() <= SHOWN_CELLS {
        text += &tables::summary_in_brief(summary, design).to_text();
    } else {
        text += &format!("over all {} cells, which are in the report one by one\n", design.cells.len());
        text += &tables::overall(summary, design).to_text();
    }
    if !summary.tracing.is_empty() {
        text += &format!("\nwhat traces named\n{}", tracing_table::kinds(&summary.tracing, design).to_text());
    }
    if !summary.predictions.is_empty() {
        text += &format!(
            "\nwhat 90 % intervals of predictions hold\n{}",
            coverage_table::pooled(&summary.predictions, design).to_text()
        );
    }
    let failures = tables::failures(summary, design);
    failures.iter().take(SHOWN_CELLS).for_each(|failure| text += &format!("\n{failure}"));
    if failures.len() > SHOWN_CELLS {
        text += &format!("\n… and {} lines more in the report", failures.len() - SHOWN_CELLS);
    }
    text
}

/// `report.md`.
///
/// `brief` holds the cells one by one, where a person may read them all.
pub fn page(stored: &StoredStudy, summary: &Summary, brief: Option<&Table>, drawings: &[Drawing]) -> String {
    let StoredStudy { manifest, design, showcases, timings, .. } = stored;
    let mut page = String::new();
    let mut line = |line: &str| writeln!(page, "{line}").expect("writing to a string does not fail");
    let figure = |drawing: &Drawing| format!("![{0}]({1}.png)\n\n*{0}*\n", drawing.caption, drawing.stem);
    line(&format!("# {}\n\n**{}**\n", manifest.name, design.words.question.trim()));
    let mut say = |prose: &str| {
        if !prose.trim().is_empty() {
            line(&format!("{}\n", prose.trim()));
        }
    };
    say(&design.words.finding);
    drawings.iter().filter(|drawing| drawing.stem == HERO).for_each(|drawing| say(&figure(drawing)));
    say(&design.words.analysis);
    for (index, showcase) in showcases.iter().enumerate() {
        let title = if showcase.title.is_empty() { "The first trial" } else { &showcase.title };
        line(&format!("## {title}\n\n{}", tables::showcase(showcase).to_markdown()));
        for entry in &showcase.methods {
            entry.warnings.iter().for_each(|warning| line(&format!("- {}: {warning}", entry.method)));
        }
        line("");
        drawings.iter().filter(|drawing| drawing.showcase == Some(index)).for_each(|drawing| line(&figure(drawing)));
    }
    if !summary.tracing.is_empty() {
        line(&format!("## What traces named\n\n{}", tracing_table::kinds(&summary.tracing, design).to_markdown()));
        line(&format!(
            "*all named*: every missing effect is in one of the groups named; *exact*: that and nothing else; \
             *false names*: a group was named that holds no missing effect; *clear*: the one missing effect alone gains {} more in BIC than any other alone. Intervals are \
             Wilson's, 95 %.\n",
            campaign::summary::CLEAR
        ));
        drawings.iter().filter(|drawing| drawing.of_traces).for_each(|drawing| line(&figure(drawing)));
        line(&tracing_table::table(&summary.tracing, summary, design, false).to_markdown());
    }
    if !summary.predictions.is_empty() {
        line(&format!(
            "## What intervals of predictions hold\n\n{}",
            coverage_table::pooled(&summary.predictions, design).to_markdown()
        ));
        line(
            "Manoeuvres are predicted from every answer, and the same ship makes them in weather of the same kind. *inside \
             90 %*: the mean over the figures of the share of trials whose 90 % interval holds what the ship does, beside \
             the lowest and the highest of these shares. Figures that ship or prediction do not have are left out. \
             `predictions.csv` has every figure with its interval (Wilson, 95 %), bias, rms error and width.\n",
        );
    }
    line("## Over all trials\n");
    drawings
        .iter()
        .filter(|drawing| drawing.showcase.is_none() && !drawing.of_traces && drawing.stem != HERO)
        .for_each(|drawing| line(&figure(drawing)));
    if design.cells.len() > 1 {
        line("### All cells together\n");
        line(&tables::overall(summary, design).to_markdown());
        line("### Cell by cell\n");
    }
    match brief {
        Some(brief) => line(&brief.to_markdown()),
        None => line(&format!("The {} cells are in `summary.csv`.\n", design.cells.len())),
    }
    let truth = match summary.tracing.is_empty() {
        true => "the truth",
        false => {
            "the truth: for a trace the ship's own K and T where it has any, for another method those of the first-order \
             response nearest to the ship, so the two are not to be compared"
        }
    };
    line(&format!(
        "Errors of K and T are relative to {truth}. *median*, *rms*: median and root mean square error, with a bootstrap \
         interval; *coverage*: share of quoted 95 % intervals that hold the truth; *sd/bound*: standard deviation over the \
         Cramér–Rao bound; *validation*: median error of the heading on a manoeuvre no method has seen. All figures with all \
         intervals are in `summary.csv`, comparisons on the same trials in `pairs.csv`, times in `timings.csv`.\n",
    ));
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
    for failure in tables::failures(summary, design) {
        line(&format!("- {failure}"));
    }
    if !manifest.assumptions.is_empty() {
        line("\nThe scenario does not say, and the trials take for granted:\n");
        manifest.assumptions.iter().for_each(|assumption| line(&format!("- {assumption}")));
    }
    line(&format!(
        "\nMade by `study` {} from the scenario in `manifest.toml` with seed {}; `study report` rebuilds this page from the \
         stored rows, `study manifest.toml --out DIR` runs it again.",
        manifest.version, manifest.seed
    ));
    page
}
