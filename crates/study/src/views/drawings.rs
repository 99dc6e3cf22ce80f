//! The figures of a finished study: which there are, what they say, and their files.

use std::collections::HashSet;

use rayon::prelude::*;
use report::figures;
use report::{Figure, Theme};

use super::charts::{self, Quantity};
use super::picture::{first_failure, slug, write_figure};
use super::trace_charts as traces;
use super::tracing_table::has_several;
use campaign::folder::ResultFolder;
use campaign::showcase::Showcase;
use campaign::store::Stored;
use campaign::summary::{Summary, TraceSummary};
use scenario::failure::Failure;

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
    draw: Box<dyn Fn(&Theme) -> Figure + Sync + Send + 'a>,
}

impl<'a> Drawing<'a> {
    fn new(
        stem: impl Into<String>,
        caption: impl Into<String>,
        draw: impl Fn(&Theme) -> Figure + Sync + Send + 'a,
    ) -> Self {
        Self { stem: stem.into(), caption: caption.into(), showcase: None, of_traces: false, draw: Box::new(draw) }
    }
}

/// All figures, in the order of the report.
pub fn of<'a>(stored: &'a Stored, summary: &'a Summary) -> Vec<Drawing<'a>> {
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
            "Root mean square error of K and T with 95 % bootstrap intervals, and the Cramér–Rao bound. A curve that is flat to \
             the left is bias, one that follows the bound is noise."
        }
        Quantity::Coverage => {
            "Share of quoted 95 % intervals that hold the truth, with Wilson's intervals. Inside the grey band a method is as \
             honest as this number of trials can tell; below it, it is too sure. Methods that quote no interval are missing."
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
fn of_traces<'a>(stored: &'a Stored, summary: &'a Summary) -> Vec<Drawing<'a>> {
    let design = &stored.design;
    let mut drawings = Vec::new();
    // Of several traces the first is drawn: the others are in the tables.
    let lines = first_trace(summary);
    let first = lines.first().map_or(0, |line| line.method);
    let whose = match has_several(design) {
        true => format!(" Here: {}.", design.methods[first].label),
        false => String::new(),
    };
    for (number, (group, data)) in traces::confusion(design, &lines).into_iter().enumerate() {
        let stem = if number == 0 { "confusion".to_owned() } else { format!("confusion-{}", slug(&group)) };
        let caption = "How often each effect was named, in per cent of the trials. A row is what the trials lack, a column what \
                       was named, a dash is never; aliases count for their own name only.";
        drawings.push(Drawing::new(stem, format!("{caption}{whose}"), move |theme| figures::heat_map(&data, theme)));
    }
    if let Some(data) = traces::power(&lines) {
        let caption = "Share of trials in which the one missing effect was named (itself or its group), over the likelihood \
                       ratio it has on average against the best first-order response, with 95 % intervals. Curves: power of a \
                       likelihood-ratio test with one to three parameters at the threshold that a trace has under white noise.";
        drawings.push(Drawing::new("power", format!("{caption}{whose}"), move |theme| figures::power(&data, theme)));
    }
    if let Some(data) = traces::reliability(&lines) {
        let caption = "How often an effect was there, over the probability that the trace gave it: every effect on the list \
                       counts once in every trial of a ship whose effects are known, with 95 % intervals.";
        drawings
            .push(Drawing::new("reliability", format!("{caption}{whose}"), move |theme| figures::power(&data, theme)));
    }
    drawings.iter_mut().for_each(|drawing| drawing.of_traces = true);
    drawings
}

fn of_summary<'a>(stored: &'a Stored, summary: &'a Summary) -> Vec<Drawing<'a>> {
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
            drawings.push(Drawing::new(stem, caption, move |theme| chart.draw(theme)));
        }
    }
    for (stem, data) in charts::heat_maps(design, summary) {
        let caption = format!("{} of every method over both axes: dark is good.", data.value_title);
        drawings.push(Drawing::new(stem, caption, move |theme| figures::heat_map(&data, theme)));
    }
    // A trace is held against the ship's own K and T, another method against the nearest first-order response: in one
    // pool their errors say nothing.
    let is_one_pool = summary.tracing.is_empty();
    if let Some((data, first)) = charts::ranking(design, summary).filter(|_| is_one_pool) {
        let caption = format!(
            "Methods by the size of their error of T over all trials: median (filled) and the size that 90 % of the answers do \
             not exceed (hollow), with 95 % intervals. Trials without an answer do not count here. First: {first}."
        );
        drawings.push(Drawing::new("ranking", caption, move |theme| figures::dots(&data, theme)));
    }
    if let Some(data) = charts::ecdf(design, summary).filter(|_| is_one_pool) {
        let caption = "Share of all trials whose error is within a size. Further left is better; a line that levels off below one \
                       belongs to a method that fails.";
        drawings.push(Drawing::new("ecdf", caption, move |theme| figures::ecdf(&data, theme)));
    }
    let of_cell = |name: &str, cell: usize| {
        let title = design.cells[cell].labels.join(", ");
        match design.cells.len() {
            1 => (name.to_owned(), String::new()),
            _ => (format!("{name}-{}", slug(&title)), format!(" Here: {title}.")),
        }
    };
    for (cell, data) in charts::violins(design, summary) {
        let (stem, place) = of_cell("violins", cell);
        let caption = "Distribution of the errors. A violin beside zero is bias, a long one is scatter.";
        drawings.push(Drawing::new(stem, format!("{caption}{place}"), move |theme| figures::violins(&data, theme)));
    }
    for (cell, data) in charts::scatters(design, summary) {
        let (stem, place) = of_cell("scatter", cell);
        let caption = "Errors of K and T together: the cloud of each method and its 95 % ellipse (answers beyond four robust \
                       standard deviations drawn in)";
        // Trials with a bound each have none in common.
        let is_bounded = data.panels.iter().any(|panel| panel.bound.is_some());
        let bound = if is_bounded { " beside that of the Cramér–Rao bound" } else { "" };
        let caption = format!("{caption}{bound}.{place}");
        drawings.push(Drawing::new(stem, caption, move |theme| figures::scatter(&data, theme)));
    }
    drawings
}

fn of_showcase<'a>(index: usize, prefix: &str, showcase: &'a Showcase) -> Vec<Drawing<'a>> {
    let mut drawings = Vec::new();
    let mut add = |name: &str, caption: &str, draw: Box<dyn Fn(&Theme) -> Figure + Sync + Send + 'a>| {
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
            Box::new(|theme| figures::zigzag_trial(data, theme)),
        );
    }
    if let Some(data) = &showcase.fourier_fit {
        add(
            "fourier-fit",
            "The Fourier series fitted to the heading, and what it leaves.",
            Box::new(|theme| figures::curve_fit(data, theme)),
        );
    }
    if let Some(data) = &showcase.derivatives {
        add(
            "derivatives",
            "Heading, yaw rate and yaw acceleration of the fitted series against the truth: a good heading does not make a \
             good acceleration.",
            Box::new(|theme| figures::derivatives(data, theme)),
        );
    }
    add(
        "replays",
        "The recorded rudder replayed through every method's K, T and δ_r; only the initial state is fitted.",
        Box::new(|theme| figures::replays(&showcase.replays, theme)),
    );
    add(
        "intervals",
        "K and T of every method with 95 % intervals, beside the truth and the published values.",
        Box::new(|theme| figures::intervals(&showcase.intervals, theme)),
    );
    drawings
}

/// Draws and writes all of them, in parallel. Fails with the first in their order that cannot be written.
pub fn write_all(drawings: &[Drawing], theme: &Theme, folder: &ResultFolder) -> Result<(), Failure> {
    first_failure(drawings.par_iter().map(|drawing| write_figure(&(drawing.draw)(theme), folder, &drawing.stem)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_figure_overwrites_another() {
        let stems = ["errors", "errors-2", "errors", "errors"];
        let mut drawings: Vec<Drawing> = stems
            .iter()
            .map(|stem| Drawing::new(*stem, "", |theme| figures::ecdf(&figures::Ecdf::default(), theme)))
            .collect();
        tell_apart(&mut drawings);
        let found: Vec<&str> = drawings.iter().map(|drawing| drawing.stem.as_str()).collect();
        assert_eq!(found, ["errors", "errors-2", "errors-3", "errors-4"]);
    }
}
