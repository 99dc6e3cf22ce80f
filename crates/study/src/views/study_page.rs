//! What is said of a finished study: `report.md`, and the lines on the screen.

use campaign::manifest::Manifest;
use campaign::showcase::Showcase;
use campaign::store::StoredStudy;
use campaign::summary::{Summary, blind_spots};
use document::names;
use report::markdown::text;
use report::{Page, Table, number};

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

const PREDICTED: &str = "Manoeuvres are predicted from every answer, and the same ship makes them in weather of the same \
                         kind. *inside 90 %*: the mean over the figures of the share of trials whose 90 % interval holds what \
                         the ship does, beside the lowest and the highest of these shares. Figures that ship or prediction do \
                         not have are left out. `predictions.csv` has every figure with its interval (Wilson, 95 %), bias, rms \
                         error and width.";

const TOLD: &str = "Criteria of IMO MSC.137(76), over all cells. *told*: the 90 % interval lies on one side of the limit, so \
                    that a prediction gives a probability of 95 % or more that the ship is there; *rightly*: she is; \
                    *wrongly*: she is not. What is left of the trials was left open.";

const READING: &str = "*median*, *rms*: median and root mean square error, with a bootstrap interval; *coverage*: share of \
                       quoted 95 % intervals that hold the truth; *sd/bound*: standard deviation over the Cramér–Rao bound; \
                       *validation*: median error of the heading on a manoeuvre no method has seen. All figures with all \
                       intervals are in `summary.csv`, comparisons on the same trials in `pairs.csv`, times in `timings.csv`.";

/// `report.md`.
///
/// `brief` holds the cells one by one, where a person may read them all.
pub fn page(stored: &StoredStudy, summary: &Summary, brief: Option<Table>, figures: Vec<StudyFigure>) -> Page {
    let StoredStudy { manifest, design, showcases, .. } = stored;
    let words = &design.words;
    let at = |wanted: &dyn Fn(FigurePlace) -> bool| -> Vec<_> {
        figures.iter().filter(|(place, _)| wanted(*place)).map(|(_, figure)| figure.clone()).collect()
    };
    let mut page = Page::titled(manifest.name.as_str());
    page.say(format!("**{}**", words.question.trim()));
    page.say(&words.finding);
    page.figures(at(&|place| place == FigurePlace::Key));
    page.say(&words.analysis);
    for (index, showcase) in showcases.iter().enumerate() {
        page.part(title(showcase, "The first trial"));
        page.table(tables::showcase(showcase));
        let warnings = showcase
            .methods
            .iter()
            .flat_map(|own| own.warnings.iter().map(|warning| text(&format!("{}: {warning}", own.entry.method))));
        page.list(warnings);
        page.figures(at(&|place| place == FigurePlace::Showcase(index)));
    }
    if !summary.tracing.is_empty() {
        page.part("What traces named");
        page.table(tracing_table::kinds(&summary.tracing, design));
        page.say(format!(
            "*all named*: every missing effect is in one of the groups named; *exact*: that and nothing else; *false names*: \
             a group was named that holds no missing effect; *clear*: the one missing effect alone gains {} more in BIC than \
             any other alone. Intervals are Wilson's, 95 %.",
            campaign::summary::CLEAR
        ));
        let spots = blind_spots(&summary.tracing, design);
        if !spots.is_empty() {
            page.say(blind_spots_table::READING);
            page.table(blind_spots_table::table(&spots, design, names::effect));
        }
        page.figures(at(&|place| place == FigurePlace::Traces));
        if let Some(table) = outcomes::table(design, summary) {
            page.say(outcomes::reading());
            page.table(table);
        }
        page.table(tracing_table::table(&summary.tracing, summary, design, false));
    }
    if !summary.predictions.is_empty() {
        page.part("What intervals of predictions hold");
        page.table(coverage_table::pooled(&summary.predictions, design));
        page.say(PREDICTED);
        if let Some(criteria) = coverage_table::criteria(&summary.predictions, design) {
            page.say(TOLD);
            page.table(criteria);
        }
    }
    page.part("Over all trials");
    page.figures(at(&|place| matches!(place, FigurePlace::Chart | FigurePlace::AllTrials)));
    over_all_trials(&mut page, stored, summary, brief);
    how_it_was_made(&mut page, manifest);
    page
}

/// The tables of all trials, and what is said of their columns.
fn over_all_trials(page: &mut Page, stored: &StoredStudy, summary: &Summary, brief: Option<Table>) {
    let StoredStudy { design, timings, .. } = stored;
    if design.cells.len() > 1 {
        page.subpart("All cells together");
        page.table(tables::overall(summary, design));
        page.subpart("Cell by cell");
    }
    match brief {
        Some(brief) => page.table(brief),
        None => page.say(format!("The {} cells are in `summary.csv`.", design.cells.len())),
    }
    let of_traces = match summary.tracing.is_empty() {
        true => "",
        false => {
            ": for a trace the ship's own K and T where it has any, for another method those of the first-order response \
             nearest to the ship, so the two are not to be compared"
        }
    };
    page.say(format!("Errors of K and T are relative to the truth{of_traces}. {READING}"));
    let times = design.methods.iter().enumerate().filter_map(|(index, method)| {
        let (mean, error) = timings.mean_us(index)?;
        Some(format!("{} {}", method.label, number::with_uncertainty(mean, Some(error))))
    });
    let times: Vec<String> = times.collect();
    if !times.is_empty() {
        page.say(format!(
            "Mean time of an identification on this run's machine with its standard error, µs: {}.",
            times.join(", ")
        ));
    }
    page.list(tables::failures(summary, design).iter().map(|line| text(line)));
}

/// What the study was made by.
pub fn how_it_was_made(page: &mut Page, manifest: &Manifest) {
    if !manifest.assumptions.is_empty() {
        page.say("The scenario does not say, and the trials take for granted:");
        page.list(manifest.assumptions.iter().map(ToString::to_string));
    }
    page.say(format!(
        "Made by `study` {} from the scenario in `manifest.toml` with seed {}; `study report` rebuilds this page from the \
         stored rows, `study manifest.toml --out DIR` runs it again.",
        manifest.version, manifest.seed
    ));
}
