//! Figures of a finished study, their findings and their places in the page.

use campaign::scenario::name::slug;
use campaign::stored_figures::{
    ConfidenceIntervals, DerivativeCurves, FourierFitCurves, MethodEstimate, MotionCurves, ReplayCurves, Replays,
};
use report::figures::Plot;
use report::number::significant;
use report::{PageFigure, PlotCurve};

use super::bench_figures::capital;
use super::charts::{self, ErrorMeasure};
use super::findings;
use super::key_figure;
use super::outcomes;
use super::page_files::KEY_FIGURE_STEM;
use super::pooled_charts;
use super::power_charts;
use super::remarks;
use super::trace_charts as traces;
use super::tracing_table::has_several_traces;
use campaign::design::Design;
use campaign::showcase::Showcase;
use campaign::store::StoredStudy;
use campaign::summary::{Summary, TraceSummary};

use crate::options::FigureChoice;
use crate::records::unique_names;
use crate::screen;

/// Place of a figure in the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigurePlace {
    /// Top of the page, for the key figure of the study.
    Key,
    /// Section of the first trial of a cell, by the index of its showcase.
    Showcase(usize),
    /// Section of the effects named by traces.
    Traces,
    /// Section of all trials.
    AllTrials,
    /// Charts of errors over the axes, in the section of all trials.
    Chart,
}

/// A figure and its place.
pub type StudyFigure = (FigurePlace, PageFigure);

/// Figures of a study in the order of the report, the key figure first if the scenario names one. Warns of a name that
/// no figure has.
pub fn figures(stored: &StoredStudy, summary: &Summary, choice: FigureChoice) -> Vec<StudyFigure> {
    chosen_figures(|| all(stored, summary), &stored.design, choice)
}

/// Figures of a study that are made, the key figure first.
pub fn chosen_figures(
    all: impl FnOnce() -> Vec<StudyFigure>,
    design: &Design,
    choice: FigureChoice,
) -> Vec<StudyFigure> {
    if choice == FigureChoice::None {
        return Vec::new();
    }
    let (output, mut figures) = (&design.prose.output, all());
    // Two titles may give the same slug.
    let stems = unique_names(figures.iter().map(|(_, figure)| &figure.stem));
    figures.iter_mut().zip(&stems).for_each(|((_, figure), stem)| figure.stem.clone_from(stem));
    let warn = |key: &str, name: &str| {
        let there =
            if stems.is_empty() { String::from("there is none") } else { format!("there are: {}", stems.join(", ")) };
        screen::print_to_stderr(&format!("warning: `output.{key}`: there is no figure {name:?}; {there}"));
    };
    let key = output.figure.as_ref().and_then(|stem| {
        let figure = figures.iter().find(|(_, figure)| figure.stem == *stem);
        if figure.is_none() {
            warn("figure", stem);
        }
        figure.map(|(place, figure)| {
            let mut plot = figure.plot.clone();
            if matches!(place, FigurePlace::Chart | FigurePlace::AllTrials | FigurePlace::Traces) {
                plot = key_figure::highlighted_chart(plot, &output.highlight, design.min_trial_count());
            }
            let finding = output.title.clone().unwrap_or_else(|| figure.finding.clone());
            let mut key = PageFigure::new(KEY_FIGURE_STEM, finding, figure.caption.clone(), plot);
            match place {
                FigurePlace::Chart | FigurePlace::AllTrials => {
                    let remark = remarks::trials_remark(design, &key.plot);
                    remarks::add_trials_remark(&mut key, &remark);
                }
                _ if design.is_measured() => {}
                FigurePlace::Traces => remarks::add_trials_remark(
                    &mut key,
                    &format!("{} {}", remarks::SIMULATED_REMARK, remarks::TRACE_REMARK),
                ),
                _ => remarks::add_trials_remark(&mut key, remarks::SIMULATED_REMARK),
            }
            (FigurePlace::Key, key)
        })
    });
    for (_, figure) in figures.iter_mut().filter(|_| !design.is_measured()) {
        remarks::add_trials_remark(figure, remarks::SIMULATED_REMARK);
    }
    let named = output.figures.as_deref().filter(|_| choice == FigureChoice::Named);
    for name in named.into_iter().flatten().filter(|name| !stems.contains(name)) {
        warn("figures", name);
    }
    figures.retain(|(_, figure)| match choice {
        FigureChoice::All => true,
        FigureChoice::Key | FigureChoice::None => false,
        FigureChoice::Named => named.is_none_or(|named| named.contains(&figure.stem)),
    });
    key.into_iter().chain(figures).collect()
}

/// Every figure that the rows of the study allow, with its place on the page.
fn all(stored: &StoredStudy, summary: &Summary) -> Vec<StudyFigure> {
    let mut figures = Vec::new();
    for (index, showcase) in stored.showcases.iter().enumerate() {
        figures.extend(of_showcase(&slug(&showcase.title), showcase).map(|plot| (FigurePlace::Showcase(index), plot)));
    }
    figures.extend(of_traces(stored, summary).into_iter().map(|figure| (FigurePlace::Traces, figure)));
    figures.extend(of_errors(stored, summary).into_iter().map(|figure| (FigurePlace::Chart, figure)));
    figures.extend(of_all_trials(stored, summary).into_iter().map(|figure| (FigurePlace::AllTrials, figure)));
    figures
}

/// Maximum number of cells of a study with traces for which errors of K and T are plotted.
const MAX_TRACED_CELLS: usize = 24;

/// Summaries of one of several traces: the first that the scenario highlights, else the first.
pub fn highlighted_trace(design: &Design, summary: &Summary) -> Vec<TraceSummary> {
    let about = &design.prose.output.highlight.series;
    let is_about = |line: &&TraceSummary| about.contains(&design.methods[line.method].label);
    let method = summary.tracing.iter().find(is_about).or(summary.tracing.first()).map_or(0, |line| line.method);
    summary.tracing.iter().filter(|line| line.method == method).cloned().collect()
}

/// Figure titled with the finding from its data.
fn under_its_finding(stem: impl Into<String>, caption: impl Into<String>, plot: impl Into<Plot>) -> PageFigure {
    let plot = plot.into();
    PageFigure::new(stem, capital(&findings::chart_finding(&plot)), caption, plot)
}

/// Caption suffix naming the part of the study that a figure shows.
fn here(part: &str) -> String {
    if part.is_empty() { String::new() } else { format!(" Here: {part}.") }
}

/// Stem of a figure, followed by the slug of its part if the study has several.
fn stem_of(stem: &str, part: &str) -> String {
    if part.is_empty() { stem.to_owned() } else { format!("{stem}-{}", slug(part)) }
}

/// Figures of the effects named in a study: confusion, power, reliability, rules.
fn of_traces(stored: &StoredStudy, summary: &Summary) -> Vec<PageFigure> {
    let design = &stored.design;
    // Of several traces only one is plotted; the others are in the tables.
    let lines = highlighted_trace(design, summary);
    let method = lines.first().map_or(0, |line| line.method);
    let whose = if has_several_traces(design) { here(&design.methods[method].label) } else { String::new() };
    let are_hulls = !lines.is_empty() && lines.iter().all(TraceSummary::is_hull);
    let confusion = |(number, (group, map)): (usize, (String, _))| {
        let rows = match are_hulls {
            true => {
                "A row is a hull in a calm: effects of weather (wind, waves, drift, a transient moment) are wrong names; whether other \
                 names are right is unknown."
            }
            false => "A row is the missing effect; an alias counts only for its own name.",
        };
        let stem = if number == 0 { String::from("confusion") } else { format!("confusion-{}", slug(&group)) };
        let place = match design.axes.get(1..).unwrap_or_default() {
            axes if group.contains(|sign: char| sign.is_ascii_digit()) => here(&format!("{} {group}", axes.join(", "))),
            _ => here(&group),
        };
        let caption = format!(
            "How often each effect was named, in per cent of the trials, with 95 % intervals. {rows}{place}{whose}"
        );
        under_its_finding(stem, caption, Plot::Cells(map))
    };
    let power = power_charts::detection_power_curves(&lines).map(|data| {
        let caption = "Share of trials in which the one missing effect was named (itself or its group), over the likelihood-ratio \
                       statistic 2 ln Λ against the best first-order response that it has on average, with 95 % \
                       intervals; of many kinds of trial those in a \
                       third of a decade together. Curves: power of a test by 2 ln Λ with one to three parameters at the \
                       threshold of the usual rule, a probability of 0.95, under white noise.";
        let [named, trials] = power_charts::single_effect_counts(&lines);
        let finding = format!("The one missing effect is named in {named} of {trials} trials");
        PageFigure::new("power", finding, format!("{caption}{whose}"), data)
    });
    let reliability = power_charts::reliability_diagram(&lines).map(|data| {
        let caption = "How often an effect was there, over the probability that the trace gave it, with 95 % intervals: every \
                       effect on the list counts once in every trial of a ship whose effects are known.";
        PageFigure::new("reliability", power_charts::present_effects_finding(&lines), format!("{caption}{whose}"), data)
    });
    let rules = traces::trace_comparison_rows(design, &summary.tracing).map(|plot| {
        let caption = "Rules against each other: trials with a false name, of all trials, and trials that name what is missing \
                       and nothing else, of those whose ship lacks something, with Wilson's 95 % intervals.";
        under_its_finding("rules", caption, plot)
    });
    let false_names = traces::false_positive_rows(design, &summary.tracing).map(|plot| {
        let caption = "Trials with a false name where nothing is missing, with Wilson's 95 % intervals: the upper end \
            bounds how often a rule \
                       invents an effect.";
        under_its_finding("false-names", caption, plot)
    });
    let outcomes = outcomes::outcome_map(design, &lines).map(|(finding, map)| {
        let caption =
            "Outcomes for every ship, in per cent of its trials, with 95 % intervals (Wilson). Outlined: right.";
        PageFigure::new("outcomes", finding, format!("{caption}{whose}"), Plot::Cells(map))
    });
    let confusions = traces::confusion_matrices(design, &lines).into_iter().enumerate().map(confusion);
    rules.into_iter().chain(false_names).chain(outcomes).chain(confusions).chain(power).chain(reliability).collect()
}

/// Figures of errors over the axes; none for a study with traces in many cells, which would need one figure each.
fn of_errors(stored: &StoredStudy, summary: &Summary) -> Vec<PageFigure> {
    let design = &stored.design;
    let mut figures = Vec::new();
    for measure in ErrorMeasure::ALL {
        if !summary.tracing.is_empty() && design.cells.len() > MAX_TRACED_CELLS {
            break;
        }
        for (group, reading, plot) in charts::error_charts_over_axes(design, summary, measure) {
            let stem = group.as_ref().map_or_else(|| measure.stem().to_owned(), |group| stem_of(measure.stem(), group));
            let place = group.map_or_else(String::new, |group| format!(" Here: {group}."));
            figures.push(under_its_finding(stem, format!("{reading}{place}"), plot));
        }
    }
    figures
}

/// Figure of the coverage of prediction intervals.
pub fn prediction_coverage(design: &Design, summary: &Summary) -> Option<PageFigure> {
    let caption = "Share of trials in which the 90 % interval of an unseen manoeuvre contains the true value, and the \
        width of the interval. \
                   Left of the line a method is overconfident; a wide interval covers more but says less.";
    pooled_charts::prediction_coverage(design, summary).map(|data| under_its_finding("predictions", caption, data))
}

fn of_all_trials(stored: &StoredStudy, summary: &Summary) -> Vec<PageFigure> {
    let design = &stored.design;
    let mut figures = Vec::new();
    figures.extend(prediction_coverage(design, summary));
    figures.extend(pooled_charts::ratios_to_first_point(design, summary).map(|(data, method)| {
        let caption = format!(
            "Mean K and T of {method}, over those of the first row: where they change from row to row, K and T depend on the trial, \
             not on the ship alone."
        );
        under_its_finding("indices", caption, data)
    }));
    for (stem, title, data) in pooled_charts::error_heat_maps(design, summary) {
        figures.push(under_its_finding(stem, format!("{title} of every method over both axes: dark is good."), data));
    }
    // A single cell needs no name.
    let name = |cell: usize| if design.cells.len() > 1 { design.cells[cell].labels.join(", ") } else { String::new() };
    for (cell, data) in pooled_charts::error_violins(design, summary) {
        let caption = "Distribution of the errors. A violin beside zero is bias, a long one is scatter.";
        let (stem, place) = (stem_of("violins", &name(cell)), here(&name(cell)));
        figures.push(under_its_finding(stem, format!("{caption}{place}"), data));
    }
    for (cell, is_bounded, data) in pooled_charts::error_clouds(design, summary) {
        let caption = "Errors of K and T together: the cloud of each method and its 95 % ellipse (answers beyond four \
            robust standard deviations are drawn at that distance)";
        // If trials have separate bounds, there is no common one.
        let bound = if is_bounded { " beside that of the Cramér–Rao bound" } else { "" };
        let (stem, place) = (stem_of("scatter", &name(cell)), here(&name(cell)));
        figures.push(under_its_finding(stem, format!("{caption}{bound}.{place}"), data));
    }
    figures
}

/// Finding and plot of a figure.
type Shown = (String, Plot);

fn of_showcase<'a>(prefix: &'a str, showcase: &'a Showcase) -> impl Iterator<Item = PageFigure> + use<'a> {
    let fourier = |data: &FourierFitCurves| format!("Heading error of the series: {}", rms(&data.residual));
    let figures: [(&str, &str, Option<Shown>); 5] = [
        (
            "trial",
            "The trial with its characteristic points (ITTC): executes, overshoots, times to check yaw, period.",
            showcase.trial.clone().map(|data| (findings::zigzag_finding(&data), data.into())),
        ),
        (
            "fourier-fit",
            "The Fourier series fitted to the heading, and its residual.",
            showcase.fourier_fit.as_ref().map(|data| (fourier(data), data.panels().into())),
        ),
        (
            "derivatives",
            "Heading, yaw rate and yaw acceleration of the fitted series against the truth: an accurate heading does not imply an \
             accurate acceleration.",
            showcase.derivatives.as_ref().map(|data| (accelerations(data), data.panels().into())),
        ),
        (
            "replays",
            "The recorded rudder replayed through every method's K, T and δ_r; only the initial state is fitted.",
            Some((replay_error_finding(&showcase.replays), showcase.replays.panels().into())),
        ),
        (
            "intervals",
            "K and T of every method with 95 % intervals, beside the truth and the published values.",
            Some((time_constants(&showcase.intervals), showcase.intervals.rows().into())),
        ),
    ];
    let stem = move |name: &str| if prefix.is_empty() { name.to_owned() } else { format!("{prefix}-{name}") };
    figures.into_iter().filter_map(move |(name, caption, shown)| {
        let (finding, plot) = shown?;
        Some(PageFigure::new(stem(name), finding, caption, plot))
    })
}

/// Root mean square of a curve of angles, degrees.
fn rms(curve: &PlotCurve) -> String {
    let (square, rows) = curve.finite_pairs().fold((0.0, 0.0), |(square, rows), (_, y)| (square + y * y, rows + 1.0));
    format!("{}° (rms)", significant(f64::sqrt(square / rows), 2))
}

/// Finding: range of the maximum yaw accelerations.
fn accelerations(data: &DerivativeCurves) -> String {
    let largest = |curve: &MotionCurves| {
        let name = curve.name.clone().unwrap_or_else(|| curve.origin.label().to_owned());
        Some((name, curve.yaw_acceleration.finite_pairs().map(|(_, y)| y.abs()).reduce(f64::max)?))
    };
    capital(&findings::range_phrase("largest yaw acceleration [°/s²]", data.curves.iter().filter_map(largest)))
}

/// Finding: range of the replay errors.
pub fn replay_error_finding(data: &Replays) -> String {
    let named_rms = |replay: &ReplayCurves| Some((replay.origin.label().to_owned(), replay.rms_deg?));
    capital(&findings::range_phrase("replay error, rms [°]", data.replays.iter().filter_map(named_rms)))
}

/// Finding of a showcase: range of the estimated T over the methods, and the true T.
fn time_constants(data: &ConfidenceIntervals) -> String {
    let named_time = |estimate: &MethodEstimate| Some((estimate.origin.label().to_owned(), estimate.t_s?.value));
    let truth =
        data.truth.as_ref().map_or_else(String::new, |truth| format!("; the truth is {} s", significant(truth.t_s, 3)));
    format!("{}{truth}", findings::range_phrase("T [s]", data.estimates.iter().filter_map(named_time)))
}
