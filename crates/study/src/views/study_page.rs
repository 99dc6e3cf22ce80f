//! Text of a finished study: `report.md`, and the lines on the screen.

use askama::Template;
use campaign::manifest::Manifest;
use campaign::scenario::{MethodName, Prose};
use campaign::showcase::{Showcase, ShowcaseAnswer};
use campaign::store::StoredStudy;
use campaign::summary::{Summary, blind_spots};
use document::names;
use report::markdown::escaped_text;
use report::{Page, PlacedFigures, Table, number};

use super::study_figures::{FigurePlace, StudyFigure};
use super::{blind_spots_table, coverage_table, outcomes, tables, tracing_table};

/// Maximum number of cells and failures on the screen; the files have all.
const MAX_SHOWN_CELLS: usize = 12;

/// Text on the screen: the first trial of every cell in detail, all trials in brief, failures with their reasons.
pub fn on_screen(stored: &StoredStudy, summary: &Summary) -> String {
    let StoredStudy { manifest, design, showcases, .. } = stored;
    let mut text = format!("{}: {}\n\n", manifest.name, design.prose.question.trim());
    for showcase in showcases {
        text += &format!("{}\n{}\n", title(showcase, "first trial"), tables::showcase_table(showcase).to_text());
    }
    if design.cells.len() <= MAX_SHOWN_CELLS {
        text += &tables::brief_summary_table(summary, design).to_text();
    } else {
        text += &format!("all {} cells together; report.md lists them one by one\n", design.cells.len());
        text += &tables::overall_table(summary, design).to_text();
    }
    if !summary.tracing.is_empty() {
        text += &format!(
            "\neffects named by the traces\n{}",
            tracing_table::ship_kind_table(&summary.tracing, design).to_text()
        );
    }
    if !summary.predictions.is_empty() {
        text += &format!(
            "\ncoverage of 90 % prediction intervals\n{}",
            coverage_table::pooled_coverage_table(&summary.predictions, design).to_text()
        );
    }
    let failures = tables::failure_lines(summary, design);
    failures.iter().take(MAX_SHOWN_CELLS).for_each(|failure| text += &format!("\n{failure}"));
    if failures.len() > MAX_SHOWN_CELLS {
        text += &format!("\n… and {} lines more in the report", failures.len() - MAX_SHOWN_CELLS);
    }
    text
}

fn title<'a>(showcase: &'a Showcase, otherwise: &'a str) -> &'a str {
    if showcase.title.is_empty() { otherwise } else { &showcase.title }
}

/// Template of `report.md`.
#[derive(Template)]
#[template(path = "study.md", escape = "none")]
struct StudyPage<'a> {
    manifest: &'a Manifest,
    prose: &'a Prose,
    trials: Vec<FirstTrial<'a>>,
    named: Option<NamedEffects>,
    coverage: Option<Table>,
    scaled: Option<Table>,
    criteria: Option<Table>,
    /// All cells together, if there are several.
    overall: Option<Table>,
    /// The cells one by one, if they are few enough to read.
    brief: Option<Table>,
    cells: usize,
    /// Reference of the errors of K and T.
    relative: &'static str,
    times: Vec<String>,
    failures: Vec<String>,
    figures: PlacedFigures<FigurePlace>,
}

/// First trial of a cell in detail.
struct FirstTrial<'a> {
    title: &'a str,
    table: Table,
    warnings: Vec<String>,
    figures: String,
}

/// Tables of the effects named by traces.
struct NamedEffects {
    kinds: Table,
    blind_spots: Option<Table>,
    outcomes: Option<Table>,
    cells: Table,
}

/// Content of `report.md`; `brief` holds the cells one by one, if they are few enough to read.
pub fn page(stored: &StoredStudy, summary: &Summary, brief: Option<Table>, figures: Vec<StudyFigure>) -> Page {
    let StoredStudy { manifest, design, showcases, timings, .. } = stored;
    let figures = PlacedFigures(figures);
    let trial = |(number, showcase)| first_trial(showcase, figures.marks_at(FigurePlace::Showcase(number)));
    let tracing = &summary.tracing;
    let named = || {
        let spots = blind_spots(tracing, design);
        NamedEffects {
            kinds: tracing_table::ship_kind_table(tracing, design),
            blind_spots: (!spots.is_empty())
                .then(|| blind_spots_table::blind_spots_table(&spots, design, names::effect_name)),
            outcomes: outcomes::outcome_table(design, summary),
            cells: tracing_table::naming_table(tracing, summary, design, false),
        }
    };
    let time = |(number, method): (usize, &MethodName)| {
        let (mean, error) = timings.mean_us(number)?;
        Some(format!("{} {}", method.label, number::with_uncertainty(mean, Some(error))))
    };
    let is_predicted = !summary.predictions.is_empty();
    let page = StudyPage {
        manifest,
        prose: &design.prose,
        trials: showcases.iter().enumerate().map(trial).collect(),
        named: (!tracing.is_empty()).then(named),
        coverage: is_predicted.then(|| coverage_table::pooled_coverage_table(&summary.predictions, design)),
        scaled: coverage_table::scaled_coverage_table(&summary.predictions, design),
        criteria: coverage_table::criterion_decision_table(&summary.predictions, design).filter(|_| is_predicted),
        overall: (design.cells.len() > 1).then(|| tables::overall_table(summary, design)),
        brief,
        cells: design.cells.len(),
        relative: tables::error_reference(design),
        times: design.methods.iter().enumerate().filter_map(time).collect(),
        failures: tables::failure_lines(summary, design),
        figures,
    };
    Page::new(page.render(), page.figures)
}

fn first_trial<'a>(showcase: &'a Showcase, figures: String) -> FirstTrial<'a> {
    let warning = |answer: &ShowcaseAnswer, warning| format!("{}: {warning}", answer.entry.method);
    FirstTrial {
        title: title(showcase, "The first trial"),
        table: tables::showcase_table(showcase),
        warnings: showcase
            .methods
            .iter()
            .flat_map(|answer| answer.warnings.iter().map(move |text| warning(answer, text)))
            .collect(),
        figures,
    }
}
