//! What is said of a finished study: `report.md`, and the lines on the screen.

use askama::Template;
use campaign::manifest::Manifest;
use campaign::scenario::{MethodName, Words};
use campaign::showcase::{Showcase, ShownAnswer};
use campaign::store::StoredStudy;
use campaign::summary::{Summary, blind_spots};
use document::names;
use report::markdown::text;
use report::{Page, PlacedFigures, Table, number};

use super::study_figures::{FigurePlace, StudyFigure};
use super::{blind_spots_table, coverage_table, outcomes, tables, tracing_table};

/// Cells whose lines go on the screen; more are in the files.
const SHOWN_CELLS: usize = 12;

/// What a person sees: the first trial of every cell in detail, all trials in brief, failures with their reasons.
pub fn on_screen(stored: &StoredStudy, summary: &Summary) -> String {
    let StoredStudy { manifest, design, showcases, .. } = stored;
    let mut text = format!("{}: {}\n\n", manifest.name, design.words.question.trim());
    for showcase in showcases {
        text += &format!("{}\n{}\n", title(showcase, "first trial"), tables::showcase(showcase).to_text());
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

fn title<'a>(showcase: &'a Showcase, otherwise: &'a str) -> &'a str {
    if showcase.title.is_empty() { otherwise } else { &showcase.title }
}

/// `report.md`.
#[derive(Template)]
#[template(path = "study.md", escape = "none")]
struct StudyPage<'a> {
    manifest: &'a Manifest,
    words: &'a Words,
    trials: Vec<FirstTrial<'a>>,
    named: Option<NamedEffects>,
    coverage: Option<Table>,
    criteria: Option<Table>,
    /// All cells together, where there are several.
    overall: Option<Table>,
    /// The cells one by one, where a person may read them all.
    brief: Option<Table>,
    cells: usize,
    /// What errors of K and T are relative to.
    relative: &'static str,
    times: Vec<String>,
    failures: Vec<String>,
    figures: PlacedFigures<FigurePlace>,
}

/// The first trial of a cell in detail.
struct FirstTrial<'a> {
    title: &'a str,
    table: Table,
    warnings: Vec<String>,
    figures: String,
}

/// What traces named.
struct NamedEffects {
    kinds: Table,
    blind_spots: Option<Table>,
    outcomes: Option<Table>,
    cells: Table,
}

/// `report.md`; `brief` holds the cells one by one, where a person may read them all.
pub fn page(stored: &StoredStudy, summary: &Summary, brief: Option<Table>, figures: Vec<StudyFigure>) -> Page {
    let StoredStudy { manifest, design, showcases, timings, .. } = stored;
    let figures = PlacedFigures(figures);
    let trial = |(number, showcase)| first_trial(showcase, figures.at(FigurePlace::Showcase(number)));
    let tracing = &summary.tracing;
    let named = || {
        let spots = blind_spots(tracing, design);
        NamedEffects {
            kinds: tracing_table::kinds(tracing, design),
            blind_spots: (!spots.is_empty()).then(|| blind_spots_table::table(&spots, design, names::effect)),
            outcomes: outcomes::table(design, summary),
            cells: tracing_table::table(tracing, summary, design, false),
        }
    };
    let time = |(number, method): (usize, &MethodName)| {
        let (mean, error) = timings.mean_us(number)?;
        Some(format!("{} {}", method.label, number::with_uncertainty(mean, Some(error))))
    };
    let is_predicted = !summary.predictions.is_empty();
    let page = StudyPage {
        manifest,
        words: &design.words,
        trials: showcases.iter().enumerate().map(trial).collect(),
        named: (!tracing.is_empty()).then(named),
        coverage: is_predicted.then(|| coverage_table::pooled(&summary.predictions, design)),
        criteria: coverage_table::criteria(&summary.predictions, design).filter(|_| is_predicted),
        overall: (design.cells.len() > 1).then(|| tables::overall(summary, design)),
        brief,
        cells: design.cells.len(),
        relative: tables::relative_to(design),
        times: design.methods.iter().enumerate().filter_map(time).collect(),
        failures: tables::failures(summary, design),
        figures,
    };
    Page::new(page.render(), page.figures)
}

fn first_trial<'a>(showcase: &'a Showcase, figures: String) -> FirstTrial<'a> {
    let warning = |own: &ShownAnswer, warning| format!("{}: {warning}", own.entry.method);
    FirstTrial {
        title: title(showcase, "The first trial"),
        table: tables::showcase(showcase),
        warnings: showcase
            .methods
            .iter()
            .flat_map(|own| own.warnings.iter().map(move |said| warning(own, said)))
            .collect(),
        figures,
    }
}
