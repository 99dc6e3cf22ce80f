//! `study SCENARIO.toml` and `study report DIR`: the first runs and stores, the second makes tables and figures from what
//! is stored. Running ends with reporting, so both show the same.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use rayon::prelude::*;
use report::figures::{self, ErrorCell, ErrorCurve, ErrorCurves, ErrorPoint, Scale};
use report::{Figure, Origin, Theme};
use serde::{Deserialize, Serialize};

use crate::cli::{Common, Format};
use crate::engine::{self, CellFacts};
use crate::failure::{Failure, OnPath};
use crate::manifest::Manifest;
use crate::present;
use crate::rows;
use crate::scenario::sweep::Axis;
use crate::scenario::{MethodName, Scenario};
use crate::screen;
use crate::showcase::{self, Showcase};
use crate::summary::{self, MethodSummary};

/// Names of the files of a result folder.
const ROWS: &str = "rows.parquet";
const CELLS: &str = "cells.json";
const SHOWCASE: &str = "showcase.json";
const MANIFEST: &str = "manifest.toml";

/// What is stored beside the rows: all that tables and figures need of the design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Design {
    question: String,
    analysis: String,
    axes: Vec<String>,
    methods: Vec<MethodName>,
    cells: Vec<CellFacts>,
}

/// Runs a scenario, stores what it gives and reports it.
pub fn run(path: &Path, common: &Common) -> Result<(), Failure> {
    let scenario = Scenario::read(path, common.seed)?;
    let folder = common.out.clone().unwrap_or_else(|| Path::new("results").join(&scenario.name));
    fs::create_dir_all(&folder).on("create", &folder)?;
    let start = Instant::now();
    let rows = engine::run(&scenario, common.quiet);
    rows::write(&folder.join(ROWS), &rows)?;
    let design = Design {
        question: scenario.question.clone(),
        analysis: scenario.analysis.clone(),
        axes: scenario.axes.iter().map(|axis: &Axis| axis.name.clone()).collect(),
        methods: scenario.method_names(),
        cells: engine::facts(&scenario),
    };
    write_json(&folder.join(CELLS), &design)?;
    let showcases: Vec<Showcase> = if scenario.showcase {
        (0..scenario.cells.len()).into_par_iter().filter_map(|cell| showcase::of_cell(&scenario, cell)).collect()
    } else {
        Vec::new()
    };
    write_json(&folder.join(SHOWCASE), &showcases)?;
    Manifest::new(&scenario, start.elapsed()).write(&folder.join(MANIFEST))?;
    report(&folder, common)
}

/// Makes tables and figures of a finished study from its stored rows.
pub fn report(folder: &Path, common: &Common) -> Result<(), Failure> {
    let manifest = Manifest::read(&folder.join(MANIFEST))?;
    let rows = rows::read(&folder.join(ROWS))?;
    let design: Design = read_json(&folder.join(CELLS))?;
    let showcases: Vec<Showcase> = read_json(&folder.join(SHOWCASE))?;
    let summaries = summary::summarise(&rows, &design.cells);
    let summary_table = present::summary(&summaries, &design.cells, &design.axes);
    let csv = folder.join("summary.csv");
    fs::write(&csv, summary_table.to_csv()).on("write", &csv)?;

    let plan = Plan::of(&design, &summaries, &showcases);
    plan.draw(folder)?;
    let page = folder.join("report.md");
    fs::write(&page, markdown(&manifest, &design, &summaries, &showcases, &plan)).on("write", &page)?;

    match common.format {
        _ if common.quiet => Ok(()),
        Format::Text => {
            let lines = on_screen(&manifest, &design, &summaries, &showcases);
            screen::say(&format!("{lines}\nreport: {}", page.display()))
        }
        // Another program reads the table: nothing else may stand beside it.
        format => screen::say(present::render(&summary_table, format).trim_end()),
    }
}

/// What a person sees: the first trial of every cell in detail, all trials in brief, failures with their reasons.
fn on_screen(manifest: &Manifest, design: &Design, summaries: &[MethodSummary], showcases: &[Showcase]) -> String {
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

fn write_json<T: Serialize>(path: &Path, value: &T) -> Result<(), Failure> {
    let text = serde_json::to_string(value).on("describe", path)?;
    fs::write(path, text + "\n").on("write", path)
}

fn read_json<T: for<'de> Deserialize<'de>>(path: &Path) -> Result<T, Failure> {
    let refuse = |problem: String| {
        Failure::input(format!("{}: {problem}; expected the folder of a finished study", path.display()))
    };
    let text = fs::read_to_string(path).map_err(|error| refuse(error.to_string()))?;
    serde_json::from_str(&text).map_err(|error| refuse(error.to_string()))
}

/// The figures of a report: file stem, caption, and how each is drawn.
struct Plan<'a> {
    showcases: Vec<(String, &'a Showcase)>,
    errors: Option<ErrorCurves>,
}

/// A figure that can be drawn.
type Drawing<'a> = Box<dyn Fn(&Theme) -> Figure + Sync + Send + 'a>;

impl<'a> Plan<'a> {
    fn of(design: &Design, summaries: &[MethodSummary], showcases: &'a [Showcase]) -> Self {
        Self {
            showcases: showcases.iter().map(|showcase| (slug(&showcase.title), showcase)).collect(),
            errors: error_curves(design, summaries),
        }
    }

    /// Stem, caption and drawing of every figure, in the order of the report.
    fn figures(&self) -> Vec<(String, &'static str, Drawing<'_>)> {
        let mut all: Vec<(String, &'static str, Drawing<'_>)> = Vec::new();
        for (prefix, showcase) in &self.showcases {
            let stem = |name: &str| if prefix.is_empty() { name.to_owned() } else { format!("{prefix}-{name}") };
            if let Some(data) = &showcase.trial {
                all.push((stem("trial"), "The trial with its characteristic points (ITTC): executes, overshoots, times to check yaw, period.", Box::new(|theme| figures::zigzag_trial(data, theme))));
            }
            if let Some(data) = &showcase.fourier_fit {
                all.push((
                    stem("fourier-fit"),
                    "The Fourier series fitted to the heading, and what it leaves.",
                    Box::new(|theme| figures::curve_fit(data, theme)),
                ));
            }
            if let Some(data) = &showcase.derivatives {
                all.push((stem("derivatives"), "Heading, yaw rate and yaw acceleration of the fitted series against the truth: a good heading does not make a good acceleration.", Box::new(|theme| figures::derivatives(data, theme))));
            }
            all.push((
                stem("replays"),
                "The recorded rudder replayed through every method's K, T and δ_r; only the initial state is fitted.",
                Box::new(|theme| figures::replays(&showcase.replays, theme)),
            ));
            all.push((
                stem("intervals"),
                "K and T of every method with 95 % intervals, beside the truth and the published values.",
                Box::new(|theme| figures::intervals(&showcase.intervals, theme)),
            ));
        }
        if let Some(data) = &self.errors {
            all.push(("errors".to_owned(), "Root mean square error of K and T against the swept quantity, with 95 % bootstrap intervals and the Cramér–Rao bound. A curve that is flat to the left is bias, one that follows the bound is noise.", Box::new(|theme| figures::error_curves(data, theme))));
        }
        all
    }

    fn draw(&self, folder: &Path) -> Result<(), Failure> {
        let theme = Theme::screen();
        self.figures().par_iter().try_for_each(|(stem, _, draw)| write_figure(&draw(&theme), folder, stem))
    }
}

/// Writes SVG and PNG of a figure.
pub fn write_figure(figure: &Figure, folder: &Path, stem: &str) -> Result<(), Failure> {
    figure.write(folder, stem).map(drop).on("write the figure", &folder.join(stem))
}

/// A title as part of a file name: lower case, words joined by hyphens.
pub fn slug(title: &str) -> String {
    let mut slug = String::new();
    for letter in title.chars() {
        match letter {
            letter if letter.is_ascii_alphanumeric() => slug.push(letter.to_ascii_lowercase()),
            _ if slug.ends_with('-') || slug.is_empty() => {}
            _ => slug.push('-'),
        }
    }
    slug.trim_end_matches('-').to_owned()
}

/// Error against the last axis that is a number; another axis makes the columns. `None` when there is no such axis, or more than one other.
fn error_curves(design: &Design, summaries: &[MethodSummary]) -> Option<ErrorCurves> {
    let is_number = |axis: usize| design.cells.iter().all(|cell| cell.values[axis].is_some());
    let x = (0..design.axes.len()).rev().find(|&axis| is_number(axis))?;
    let others: Vec<usize> = (0..design.axes.len()).filter(|&axis| axis != x).collect();
    if others.len() > 1 {
        return None;
    }
    let head = |cell: &CellFacts| others.first().map_or_else(String::new, |&axis| cell.labels[axis].clone());
    let mut columns: Vec<String> = Vec::new();
    for cell in &design.cells {
        if !columns.contains(&head(cell)) {
            columns.push(head(cell));
        }
    }
    let mut cells = Vec::new();
    for (column, name) in columns.iter().enumerate() {
        let own: Vec<usize> = (0..design.cells.len()).filter(|&cell| head(&design.cells[cell]) == *name).collect();
        for row in 0..2 {
            let errors = |summary: &MethodSummary| if row == 0 { summary.k } else { summary.t };
            let mut curves: Vec<ErrorCurve> = design
                .methods
                .iter()
                .map(|method| ErrorCurve {
                    origin: showcase::origin(&design.methods, &method.label),
                    points: own
                        .iter()
                        .filter_map(|&cell| {
                            let summary = summaries.iter().find(|s| s.cell == cell && s.method == method.label)?;
                            let rms = errors(summary).rms_percent?;
                            Some(ErrorPoint { x: design.cells[cell].values[x]?, y: rms.value, interval: rms.ci95 })
                        })
                        .collect(),
                })
                .collect();
            let bound = |cell: &CellFacts| if row == 0 { cell.bound_k_percent } else { cell.bound_t_percent };
            curves.push(ErrorCurve {
                origin: Origin::Bound,
                points: own
                    .iter()
                    .filter_map(|&cell| {
                        let facts = &design.cells[cell];
                        Some(ErrorPoint { x: facts.values[x]?, y: bound(facts)?, interval: None })
                    })
                    .collect(),
            });
            cells.push(ErrorCell { row, column, curves });
        }
    }
    Some(ErrorCurves {
        title: None,
        x_title: design.axes[x].clone(),
        x_scale: Scale::Log,
        y_scale: Scale::Log,
        rows: vec!["rms error of K [%]".into(), "rms error of T [%]".into()],
        columns,
        cells,
    })
}

fn markdown(
    manifest: &Manifest,
    design: &Design,
    summaries: &[MethodSummary],
    showcases: &[Showcase],
    plan: &Plan,
) -> String {
    let mut page = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(page, "# {}\n\n**{}**\n", manifest.name, design.question.trim());
    if !design.analysis.trim().is_empty() {
        let _ = writeln!(page, "{}\n", design.analysis.trim());
    }
    let drawings = plan.figures();
    for showcase in showcases {
        let title = if showcase.title.is_empty() { "The first trial" } else { &showcase.title };
        let _ = writeln!(page, "## {title}\n\n{}", present::showcase(showcase).to_markdown());
        for entry in &showcase.methods {
            for warning in &entry.warnings {
                let _ = writeln!(page, "- {}: {warning}", entry.method);
            }
        }
        let prefix = slug(&showcase.title);
        for (stem, caption, _) in drawings.iter().filter(|(stem, ..)| stem.starts_with(&prefix) && stem != "errors") {
            let _ = writeln!(page, "\n![{caption}]({stem}.png)\n\n*{caption}*");
        }
        page.push('\n');
    }
    let _ = writeln!(page, "## Over all trials\n");
    for (stem, caption, _) in drawings.iter().filter(|(stem, ..)| stem == "errors") {
        let _ = writeln!(page, "![{caption}]({stem}.png)\n\n*{caption}*\n");
    }
    let _ = writeln!(page, "{}", present::summary(summaries, &design.cells, &design.axes).to_markdown());
    let _ = writeln!(
        page,
        "Median error with the distribution-free interval, rms error with a bootstrap interval, share of quoted 95 % \
         intervals that hold the truth, and standard deviation over the Cramér–Rao bound.\n"
    );
    for failure in present::failures(summaries, &design.cells) {
        let _ = writeln!(page, "- {failure}");
    }
    let _ = writeln!(
        page,
        "\nMade by `study` {} from the scenario in `manifest.toml` with seed {}; `study report` rebuilds this page from the \
         stored rows.",
        manifest.version, manifest.seed
    );
    page
}

/// The default result folder of a command on records: `./<trial name>-<command>`.
pub fn folder_of(common: &Common, trial: &str, command: &str) -> PathBuf {
    common.out.clone().unwrap_or_else(|| PathBuf::from(format!("{trial}-{command}")))
}

#[cfg(test)]
mod tests {
    use super::slug;

    #[test]
    fn slugs_are_file_names() {
        assert_eq!(slug("10/20 (published reading)"), "10-20-published-reading");
        assert_eq!(slug(""), "");
    }
}
