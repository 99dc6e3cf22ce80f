//! The figures of a finished study: which there are, what they say, and their files.

use std::collections::HashSet;
use std::sync::Arc;

use rayon::prelude::*;
use report::figures;
use report::{Figure, Origin, Theme};

use super::charts::{self, Quantity};
use super::picture::{first_failure, slug, write_figure};
use super::pooled_charts;
use super::trace_charts as traces;
use super::tracing_table::has_several;
use campaign::folder::ResultFolder;
use campaign::showcase::Showcase;
use campaign::store::StoredStudy;
use campaign::summary::{Summary, TraceSummary};
use scenario::failure::Failure;

use crate::options::FigureChoice;
use crate::screen;

/// A figure that can be drawn.
pub struct Drawing<'a> {
    /// Stem of its files.
    pub stem: String,
    /// What is to be seen.
    pub caption: String,
    /// The showcase it belongs to; `None` when it is about all trials.
    pub showcase: Option<usize>,
    /// Whether it is about what traces named.
    pub of_traces: bool,
    draw: Arc<Draw<'a>>,
}

/// Draws a figure, plainly or as the one that stands for its study.
type Draw<'a> = dyn Fn(&Theme, Option<&Hero>) -> Figure + Sync + Send + 'a;

/// How the figure that stands for a study differs from others.
#[derive(Debug, Clone)]
struct Hero {
    /// What it shows, in a sentence.
    title: Option<String>,
    /// The methods it is about; empty: all.
    about: Vec<Origin>,
}

/// Stem of the figure that stands for a study.
pub const HERO: &str = "hero";

/// The title of a figure: that of a hero.
fn title(hero: Option<&Hero>) -> Option<String> {
    hero.and_then(|hero| hero.title.clone())
}

impl<'a> Drawing<'a> {
    fn new(
        stem: impl Into<String>,
        caption: impl Into<String>,
        draw: impl Fn(&Theme, Option<&Hero>) -> Figure + Sync + Send + 'a,
    ) -> Self {
        Self { stem: stem.into(), caption: caption.into(), showcase: None, of_traces: false, draw: Arc::new(draw) }
    }
}

/// The figures of a study, in the order of the report: first the one that stands for it, where the scenario names one.
/// A name of a figure that there is not is warned of.
pub fn of<'a>(stored: &'a StoredStudy, summary: &'a Summary, choice: FigureChoice) -> Vec<Drawing<'a>> {
    let words = &stored.design.words;
    let drawings = all(stored, summary);
    let warn = |key: &str, name: &str| {
        let known: Vec<&str> = drawings.iter().map(|drawing| drawing.stem.as_str()).collect();
        screen::warn(&format!("warning: `output.{key}`: there is no figure {name:?}; there are: {}", known.join(", ")));
    };
    let hero = words.output.figure.as_ref().and_then(|stem| {
        let found = drawings.iter().position(|drawing| drawing.stem == *stem);
        if found.is_none() {
            warn("figure", stem);
        }
        found
    });
    let named = words.output.figures.as_deref().filter(|_| choice == FigureChoice::Named);
    for name in named.into_iter().flatten().filter(|name| drawings.iter().all(|drawing| drawing.stem != **name)) {
        warn("figures", name);
    }
    let is_kept = |drawing: &Drawing| match choice {
        FigureChoice::All => true,
        FigureChoice::Hero => false,
        FigureChoice::Named => named.is_none_or(|named| named.contains(&drawing.stem)),
    };
    let kept: Vec<bool> = drawings.iter().map(is_kept).collect();
    let mut chosen = Vec::new();
    if let Some(place) = hero {
        let labels = &words.output.methods;
        let about = |label: &String| campaign::curves::origin(&stored.design.methods, label);
        let look = Hero { title: words.output.title.clone(), about: labels.iter().map(about).collect() };
        let draw = Arc::clone(&drawings[place].draw);
        let caption = drawings[place].caption.clone();
        chosen.push(Drawing::new(HERO, caption, move |theme, _| draw(theme, Some(&look))));
    }
    chosen.extend(drawings.into_iter().zip(kept).filter(|(_, kept)| *kept).map(|(drawing, _)| drawing));
    chosen
}

/// All figures there are.
fn all<'a>(stored: &'a StoredStudy, summary: &'a Summary) -> Vec<Drawing<'a>> {
    let mut drawings = Vec::new();
    for (index, showcase) in stored.showcases.iter().enumerate() {
        drawings.extend(of_showcase(index, &slug(&showcase.title), showcase));
    }
    drawings.extend(of_summary(stored, summary));
    tell_apart(&mut drawings);
    drawings
}

/// Numbers stems that are the same: two titles may make one slug.
fn tell_apart(drawings: &mut [Drawing]) {
    let mut taken = HashSet::new();
    for drawing in drawings {
        let stem = drawing.stem.clone();
        let mut number = 2;
        while !taken.insert(drawing.stem.clone()) {
            drawing.stem = format!("{stem}-{number}");
            number += 1;
        }
    }
}

/// What a person should see in the charts of one quantity.
fn reading(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Rms => {
            "Root mean square error of K and T with 95 % bootstrap intervals, over the Cramér–Rao bound where all cells have \
             one. Over the bound, a line that rises where there is less noise is bias. A difference from the nearest \
             first-order response is no error: the ship has no K and T of its own."
        }
        Quantity::Coverage => {
            "Share of quoted 95 % intervals that hold the truth, with Wilson's intervals. Inside the grey band a method is as \
             honest as this number of trials can tell; below it, it is too sure. Methods that quote an interval in fewer than \
             half of the trials are missing."
        }
        Quantity::Failures => {
            "Share of trials without an answer, with Wilson's intervals; methods that always answer are left out. The reasons are \
             listed below."
        }
        Quantity::Validation => {
            "Median error of the heading on the validation manoeuvre, its rudder replayed through the answer: what K and T are \
             worth for prediction. Where all methods agree, the error is that of the model."
        }
    }
}

/// Cells of a study with traces beyond which errors of K and T are not drawn one by one.
const MOST_TRACED: usize = 24;

/// What the first of several traces said.
pub fn first_trace(summary: &Summary) -> Vec<TraceSummary> {
    let first = summary.tracing.first().map_or(0, |line| line.method);
    summary.tracing.iter().filter(|line| line.method == first).cloned().collect()
}

/// Figures about what traces named.
fn of_traces<'a>(stored: &'a StoredStudy, summary: &'a Summary) -> Vec<Drawing<'a>> {
    let design = &stored.design;
    let mut drawings = Vec::new();
    // Of several traces the first is drawn: the others are in the tables.
    let lines = first_trace(summary);
    let first = lines.first().map_or(0, |line| line.method);
    let whose = match has_several(design) {
        true => format!(" Here: {}.", design.methods[first].label),
        false => String::new(),
    };
    for (number, (group, data)) in traces::confusions(design, &lines).into_iter().enumerate() {
        let stem = if number == 0 { "confusion".to_owned() } else { format!("confusion-{}", slug(&group)) };
        let caption = "How often each effect was named, in per cent of the trials, with 95 % intervals. A row is what the \
                       trials lack, a column what was named; aliases count for their own name only.";
        let place = if group.is_empty() { String::new() } else { format!(" Here: {group}.") };
        let draw = move |theme: &Theme, hero: Option<&Hero>| {
            figures::confusion(&figures::Confusion { title: title(hero), ..data.clone() }, theme)
        };
        drawings.push(Drawing::new(stem, format!("{caption}{place}{whose}"), draw));
    }
    if let Some(data) = traces::power(&lines) {
        let caption = "Share of trials in which the one missing effect was named (itself or its group), over the likelihood \
                       ratio it has on average against the best first-order response, with 95 % intervals. Curves: power of a \
                       likelihood-ratio test with one to three parameters at the threshold that a trace has under white noise.";
        let draw = move |theme: &Theme, hero: Option<&Hero>| {
            figures::panels(&figures::Panels { title: title(hero), ..data.clone() }, theme)
        };
        drawings.push(Drawing::new("power", format!("{caption}{whose}"), draw));
    }
    if let Some(data) = traces::reliability(&lines) {
        let caption = "How often an effect was there, over the probability that the trace gave it: every effect on the list \
                       counts once in every trial of a ship whose effects are known, with 95 % intervals.";
        drawings.push(Drawing::new("reliability", format!("{caption}{whose}"), move |theme, _| {
            figures::panels(&data, theme)
        }));
    }
    drawings.iter_mut().for_each(|drawing| drawing.of_traces = true);
    drawings
}

fn of_summary<'a>(stored: &'a StoredStudy, summary: &'a Summary) -> Vec<Drawing<'a>> {
    let design = &stored.design;
    let mut drawings = of_traces(stored, summary);
    // What a trace finds is told by its own figures; of many cells the errors would be a figure each.
    let told = !summary.tracing.is_empty() && design.cells.len() > MOST_TRACED;
    for quantity in Quantity::ALL.into_iter().filter(|_| !told) {
        for chart in charts::over_axes(design, summary, quantity) {
            let place = chart.group.as_ref().map_or_else(String::new, |group| format!(" Here: {group}."));
            let stem = match &chart.group {
                Some(group) => format!("{}-{}", quantity.stem(), slug(group)),
                None => quantity.stem().to_owned(),
            };
            let caption = format!("{}{place}", reading(quantity));
            let draw = move |theme: &Theme, hero: Option<&Hero>| match hero {
                Some(Hero { title, about }) => chart.hero(title.as_deref(), about).draw(theme),
                None => chart.draw(theme),
            };
            drawings.push(Drawing::new(stem, caption, draw));
        }
    }
    if let Some(data) = pooled_charts::predictions(design, summary) {
        let caption = "Share of trials in which the 90 % interval of a manoeuvre that was not made holds what the ship does. Left \
                       of the line a method is too sure.";
        let draw = move |theme: &Theme, hero: Option<&Hero>| {
            figures::dots(&figures::DotPlot { title: title(hero), ..data.clone() }, theme)
        };
        drawings.push(Drawing::new("predictions", caption, draw));
    }
    if let Some((data, method)) = pooled_charts::indices(design, summary) {
        let caption = format!(
            "Mean K and T that {method} finds, over those of the first row: where they change from row to row, K and T belong \
             to the trial and not to the ship."
        );
        let draw = move |theme: &Theme, hero: Option<&Hero>| {
            figures::dots(&figures::DotPlot { title: title(hero), ..data.clone() }, theme)
        };
        drawings.push(Drawing::new("indices", caption, draw));
    }
    for (stem, data) in pooled_charts::heat_maps(design, summary) {
        let caption = format!("{} of every method over both axes: dark is good.", data.value_title);
        drawings.push(Drawing::new(stem, caption, move |theme, hero| {
            figures::heat_map(&figures::HeatMap { title: title(hero), ..data.clone() }, theme)
        }));
    }
    let of_cell = |name: &str, cell: usize| {
        let title = design.cells[cell].labels.join(", ");
        match design.cells.len() {
            1 => (name.to_owned(), String::new()),
            _ => (format!("{name}-{}", slug(&title)), format!(" Here: {title}.")),
        }
    };
    for (cell, data) in pooled_charts::violins(design, summary) {
        let (stem, place) = of_cell("violins", cell);
        let caption = "Distribution of the errors. A violin beside zero is bias, a long one is scatter.";
        drawings.push(Drawing::new(stem, format!("{caption}{place}"), move |theme, hero| {
            figures::violins(&figures::Violins { title: title(hero), ..data.clone() }, theme)
        }));
    }
    for (cell, data) in pooled_charts::scatters(design, summary) {
        let (stem, place) = of_cell("scatter", cell);
        let caption = "Errors of K and T together: the cloud of each method and its 95 % ellipse (answers beyond four robust \
                       standard deviations drawn in)";
        // Trials with a bound each have none in common.
        let is_bounded = data.panels.iter().any(|panel| panel.bound.is_some());
        let bound = if is_bounded { " beside that of the Cramér–Rao bound" } else { "" };
        let caption = format!("{caption}{bound}.{place}");
        drawings.push(Drawing::new(stem, caption, move |theme, hero| {
            figures::scatter(&figures::KtScatter { title: title(hero), ..data.clone() }, theme)
        }));
    }
    drawings
}

fn of_showcase<'a>(index: usize, prefix: &str, showcase: &'a Showcase) -> Vec<Drawing<'a>> {
    let mut drawings = Vec::new();
    let mut add = |name: &str, caption: &str, draw: Arc<Draw<'a>>| {
        drawings.push(Drawing {
            stem: if prefix.is_empty() { name.to_owned() } else { format!("{prefix}-{name}") },
            caption: caption.to_owned(),
            of_traces: false,
            showcase: Some(index),
            draw,
        });
    };
    if let Some(data) = &showcase.trial {
        add(
            "trial",
            "The trial with its characteristic points (ITTC): executes, overshoots, times to check yaw, period.",
            Arc::new(|theme, _| figures::zigzag_trial(data, theme)),
        );
    }
    if let Some(data) = &showcase.fourier_fit {
        add(
            "fourier-fit",
            "The Fourier series fitted to the heading, and what it leaves.",
            Arc::new(|theme, _| figures::curve_fit(data, theme)),
        );
    }
    if let Some(data) = &showcase.derivatives {
        add(
            "derivatives",
            "Heading, yaw rate and yaw acceleration of the fitted series against the truth: a good heading does not make a \
             good acceleration.",
            Arc::new(|theme, _| figures::derivatives(data, theme)),
        );
    }
    add(
        "replays",
        "The recorded rudder replayed through every method's K, T and δ_r; only the initial state is fitted.",
        Arc::new(|theme, _| figures::replays(&showcase.replays, theme)),
    );
    add(
        "intervals",
        "K and T of every method with 95 % intervals, beside the truth and the published values.",
        Arc::new(|theme, _| figures::intervals(&showcase.intervals, theme)),
    );
    drawings
}

/// Draws and writes all of them, in parallel. Fails with the first in their order that cannot be written.
pub fn write_all(drawings: &[Drawing], theme: &Theme, folder: &ResultFolder) -> Result<(), Failure> {
    first_failure(drawings.par_iter().map(|drawing| write_figure(&(drawing.draw)(theme, None), folder, &drawing.stem)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_figure_overwrites_another() {
        let stems = ["errors", "errors-2", "errors", "errors"];
        let mut drawings: Vec<Drawing> = stems
            .iter()
            .map(|stem| Drawing::new(*stem, "", |theme, _| figures::dots(&figures::DotPlot::default(), theme)))
            .collect();
        tell_apart(&mut drawings);
        let found: Vec<&str> = drawings.iter().map(|drawing| drawing.stem.as_str()).collect();
        assert_eq!(found, ["errors", "errors-2", "errors-3", "errors-4"]);
    }
}
