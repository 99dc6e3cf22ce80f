//! The figures of a finished study: which there are, what they say, and where they stand.

use campaign::scenario::name::slug;
use campaign::stored_figures::{
    CurveFit, DerivativeCurves, Intervals, MethodEstimate, MotionCurves, ReplayCurves, Replays,
};
use report::figures::Plot;
use report::number::significant;
use report::{PageFigure, PlotCurve};

use super::bench_figures::capital;
use super::charts::{self, ErrorMeasure};
use super::findings;
use super::key_figure;
use super::outcomes;
use super::page_files::KEY_FIGURE;
use super::pooled_charts;
use super::trace_charts as traces;
use super::tracing_table::has_several;
use campaign::design::Design;
use campaign::showcase::Showcase;
use campaign::store::StoredStudy;
use campaign::summary::{Summary, TraceSummary};

use crate::options::FigureChoice;
use crate::records::names;
use crate::screen;

/// Where a figure stands in the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigurePlace {
    /// Before everything else: the one that stands for the study.
    Key,
    /// With the first trial of a cell.
    Showcase(usize),
    /// With what traces named.
    Traces,
    /// With all trials.
    AllTrials,
    /// The same, of errors over the axes.
    Chart,
}

/// A figure and its place.
pub type StudyFigure = (FigurePlace, PageFigure);

/// The figures of a study, in the order of the report: first the one that stands for it, where the scenario names one.
/// A name of a figure that there is not is warned of.
pub fn of(stored: &StoredStudy, summary: &Summary, choice: FigureChoice) -> Vec<StudyFigure> {
    chosen(|| all(stored, summary), &stored.design, choice)
}

/// Of all figures of a study those that are made: first the one that stands for it.
pub fn chosen(all: impl FnOnce() -> Vec<StudyFigure>, design: &Design, choice: FigureChoice) -> Vec<StudyFigure> {
    if choice == FigureChoice::None {
        return Vec::new();
    }
    let (words, mut figures) = (&design.words.output, all());
    // Two titles may make one slug.
    let known = names(figures.iter().map(|(_, figure)| &figure.stem));
    figures.iter_mut().zip(&known).for_each(|((_, figure), stem)| figure.stem.clone_from(stem));
    let warn = |key: &str, name: &str| {
        let there =
            if known.is_empty() { String::from("there is none") } else { format!("there are: {}", known.join(", ")) };
        screen::warn(&format!("warning: `output.{key}`: there is no figure {name:?}; {there}"));
    };
    let key = words.figure.as_ref().and_then(|stem| {
        let found = figures.iter().find(|(_, figure)| figure.stem == *stem);
        if found.is_none() {
            warn("figure", stem);
        }
        found.map(|(place, figure)| {
            let mut plot = figure.plot.clone();
            if matches!(place, FigurePlace::Chart | FigurePlace::AllTrials | FigurePlace::Traces) {
                plot = key_figure::of_chart(plot, &words.highlight);
            }
            let finding = words.title.clone().unwrap_or_else(|| figure.finding.clone());
            (FigurePlace::Key, PageFigure::new(KEY_FIGURE, finding, figure.caption.clone(), plot))
        })
    });
    let named = words.figures.as_deref().filter(|_| choice == FigureChoice::Named);
    for name in named.into_iter().flatten().filter(|name| !known.contains(name)) {
        warn("figures", name);
    }
    figures.retain(|(_, figure)| match choice {
        FigureChoice::All => true,
        FigureChoice::Hero | FigureChoice::None => false,
        FigureChoice::Named => named.is_none_or(|named| named.contains(&figure.stem)),
    });
    key.into_iter().chain(figures).collect()
}

/// All figures there are.
fn all(stored: &StoredStudy, summary: &Summary) -> Vec<StudyFigure> {
    let mut figures = Vec::new();
    for (index, showcase) in stored.showcases.iter().enumerate() {
        figures.extend(of_showcase(&slug(&showcase.title), showcase).map(|own| (FigurePlace::Showcase(index), own)));
    }
    figures.extend(of_traces(stored, summary).into_iter().map(|own| (FigurePlace::Traces, own)));
    figures.extend(of_errors(stored, summary).into_iter().map(|own| (FigurePlace::Chart, own)));
    figures.extend(of_all_trials(stored, summary).into_iter().map(|own| (FigurePlace::AllTrials, own)));
    figures
}

/// Cells of a study with traces beyond which errors of K and T are not drawn one by one.
const MOST_TRACED: usize = 24;

/// What one of several traces said: the first that the scenario calls what its figures are about, else the first.
pub fn one_trace(design: &Design, summary: &Summary) -> Vec<TraceSummary> {
    let about = &design.words.output.highlight.series;
    let is_about = |line: &&TraceSummary| about.contains(&design.methods[line.method].label);
    let one = summary.tracing.iter().find(is_about).or(summary.tracing.first()).map_or(0, |line| line.method);
    summary.tracing.iter().filter(|line| line.method == one).cloned().collect()
}

/// A figure under what its data show.
fn told(stem: impl Into<String>, caption: impl Into<String>, plot: impl Into<Plot>) -> PageFigure {
    let plot = plot.into();
    PageFigure::new(stem, capital(&findings::of_chart(&plot)), caption, plot)
}

/// The words that say of which of several things a figure is.
fn here(of: &str) -> String {
    if of.is_empty() { String::new() } else { format!(" Here: {of}.") }
}

/// A stem of one of several figures.
fn stem_of(stem: &str, of: &str) -> String {
    if of.is_empty() { stem.to_owned() } else { format!("{stem}-{}", slug(of)) }
}

/// Figures about what traces named.
fn of_traces(stored: &StoredStudy, summary: &Summary) -> Vec<PageFigure> {
    let design = &stored.design;
    // Of several traces one is drawn: the others are in the tables.
    let lines = one_trace(design, summary);
    let one = lines.first().map_or(0, |line| line.method);
    let whose = if has_several(design) { here(&design.methods[one].label) } else { String::new() };
    let are_hulls = !lines.is_empty() && lines.iter().all(TraceSummary::is_hull);
    let confusion = |(number, (group, map)): (usize, (String, _))| {
        let rows = match are_hulls {
            true => {
                "A row is a hull in a calm: effects of weather (wind, waves, drift, a moment for a while) are wrong names; \
                 of the others nobody knows."
            }
            false => "A row is what the trials lack; an alias counts for its own name only.",
        };
        let stem = if number == 0 { String::from("confusion") } else { format!("confusion-{}", slug(&group)) };
        let of = match design.axes.get(1..).unwrap_or_default() {
            axes if group.contains(|own: char| own.is_ascii_digit()) => here(&format!("{} {group}", axes.join(", "))),
            _ => here(&group),
        };
        let caption = format!(
            "How often each effect was named, in per cent of the trials, with 95 % intervals. {rows}{of}{whose}"
        );
        told(stem, caption, Plot::Cells(map))
    };
    let power = traces::power(&lines).map(|data| {
        let caption = "Share of trials in which the one missing effect was named (itself or its group), over the likelihood-ratio \
                       statistic 2 ln Λ against the best first-order response that it has on average, with 95 % intervals; of many kinds of trial those in a \
                       third of a decade together. Curves: power of a test by 2 ln Λ with one to three parameters at the \
                       threshold of the usual rule, a probability of 0.95, under white noise.";
        let [named, trials] = traces::single(&lines);
        let finding = format!("The one missing effect is named in {named} of {trials} trials");
        PageFigure::new("power", finding, format!("{caption}{whose}"), data)
    });
    let reliability = traces::reliability(&lines).map(|data| {
        let caption = "How often an effect was there, over the probability that the trace gave it, with 95 % intervals: every \
                       effect on the list counts once in every trial of a ship whose effects are known.";
        PageFigure::new("reliability", traces::kept(&lines), format!("{caption}{whose}"), data)
    });
    let rules = traces::rules(design, &summary.tracing).map(|plot| {
        let caption = "Rules against each other: trials with a false name, of all trials, and trials that name what is missing \
                       and nothing else, of those whose ship lacks something, with Wilson's 95 % intervals.";
        told("rules", caption, plot)
    });
    let false_names = traces::false_names(design, &summary.tracing).map(|plot| {
        let caption = "Trials with a false name where nothing is missing, with Wilson's 95 % intervals: how often every rule \
                       invents an effect at most.";
        told("false-names", caption, plot)
    });
    let outcomes = outcomes::figure(design, &lines).map(|(finding, map)| {
        let caption =
            "What was said of every ship, in per cent of its trials, with 95 % intervals (Wilson). Outlined: right.";
        PageFigure::new("outcomes", finding, format!("{caption}{whose}"), Plot::Cells(map))
    });
    let confusions = traces::confusions(design, &lines).into_iter().enumerate().map(confusion);
    rules.into_iter().chain(false_names).chain(outcomes).chain(confusions).chain(power).chain(reliability).collect()
}

/// Errors over the axes. What a trace finds has its own figures; of many cells the errors would be a figure each.
fn of_errors(stored: &StoredStudy, summary: &Summary) -> Vec<PageFigure> {
    let design = &stored.design;
    let mut figures = Vec::new();
    for measure in ErrorMeasure::ALL {
        if !summary.tracing.is_empty() && design.cells.len() > MOST_TRACED {
            break;
        }
        for (group, reading, plot) in charts::over_axes(design, summary, measure) {
            let stem = group.as_ref().map_or_else(|| measure.stem().to_owned(), |own| stem_of(measure.stem(), own));
            let place = group.map_or_else(String::new, |group| format!(" Here: {group}."));
            figures.push(told(stem, format!("{reading}{place}"), plot));
        }
    }
    figures
}

/// Whether intervals of predictions hold.
pub fn predictions(design: &Design, summary: &Summary) -> Option<PageFigure> {
    let caption = "Share of trials in which the 90 % interval of a manoeuvre that was not made holds what the ship does, and \
                   how wide it is. Left of the line a method is too sure; a wide interval holds more and says less.";
    pooled_charts::predictions(design, summary).map(|data| told("predictions", caption, data))
}

fn of_all_trials(stored: &StoredStudy, summary: &Summary) -> Vec<PageFigure> {
    let design = &stored.design;
    let mut figures = Vec::new();
    figures.extend(predictions(design, summary));
    figures.extend(pooled_charts::indices(design, summary).map(|(data, method)| {
        let caption = format!(
            "Mean K and T that {method} finds, over those of the first row: where they change from row to row, K and T belong \
             to the trial and not to the ship."
        );
        told("indices", caption, data)
    }));
    for (stem, title, data) in pooled_charts::heat_maps(design, summary) {
        figures.push(told(stem, format!("{title} of every method over both axes: dark is good."), data));
    }
    // A single cell needs no name.
    let name = |cell: usize| if design.cells.len() > 1 { design.cells[cell].labels.join(", ") } else { String::new() };
    for (cell, data) in pooled_charts::violins(design, summary) {
        let caption = "Distribution of the errors. A violin beside zero is bias, a long one is scatter.";
        let (stem, place) = (stem_of("violins", &name(cell)), here(&name(cell)));
        figures.push(told(stem, format!("{caption}{place}"), data));
    }
    for (cell, is_bounded, data) in pooled_charts::scatters(design, summary) {
        let caption = "Errors of K and T together: the cloud of each method and its 95 % ellipse (answers beyond four robust \
                       standard deviations drawn in)";
        // Trials with a bound each have none in common.
        let bound = if is_bounded { " beside that of the Cramér–Rao bound" } else { "" };
        let (stem, place) = (stem_of("scatter", &name(cell)), here(&name(cell)));
        figures.push(told(stem, format!("{caption}{bound}.{place}"), data));
    }
    figures
}

/// What a figure shows, and what is drawn.
type Shown = (String, Plot);

fn of_showcase<'a>(prefix: &'a str, showcase: &'a Showcase) -> impl Iterator<Item = PageFigure> + use<'a> {
    let fourier = |data: &CurveFit| format!("The series leaves {} of the heading", rms(&data.residual));
    let figures: [(&str, &str, Option<Shown>); 5] = [
        (
            "trial",
            "The trial with its characteristic points (ITTC): executes, overshoots, times to check yaw, period.",
            showcase.trial.clone().map(|data| (findings::of_trial(&data), data.into())),
        ),
        (
            "fourier-fit",
            "The Fourier series fitted to the heading, and what it leaves.",
            showcase.fourier_fit.as_ref().map(|data| (fourier(data), data.panels().into())),
        ),
        (
            "derivatives",
            "Heading, yaw rate and yaw acceleration of the fitted series against the truth: a good heading does not make a \
             good acceleration.",
            showcase.derivatives.as_ref().map(|data| (accelerations(data), data.panels().into())),
        ),
        (
            "replays",
            "The recorded rudder replayed through every method's K, T and δ_r; only the initial state is fitted.",
            Some((left(&showcase.replays), showcase.replays.panels().into())),
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
    let (square, rows) = curve.finite().fold((0.0, 0.0), |(square, rows), (_, y)| (square + y * y, rows + 1.0));
    format!("{}° (rms)", significant(f64::sqrt(square / rows), 2))
}

/// How large yaw accelerations are.
fn accelerations(data: &DerivativeCurves) -> String {
    let largest = |own: &MotionCurves| {
        let name = own.name.clone().unwrap_or_else(|| own.origin.label().to_owned());
        Some((name, own.yaw_acceleration.finite().map(|(_, y)| y.abs()).reduce(f64::max)?))
    };
    capital(&findings::range("largest yaw acceleration [°/s²]", data.curves.iter().filter_map(largest)))
}

/// What replays leave of the heading.
pub fn left(data: &Replays) -> String {
    let of = |own: &ReplayCurves| Some((own.origin.label().to_owned(), own.rms_deg?));
    capital(&findings::range("rms of what replays leave [°]", data.replays.iter().filter_map(of)))
}

/// What methods find of T.
fn time_constants(data: &Intervals) -> String {
    let of = |own: &MethodEstimate| Some((own.origin.label().to_owned(), own.t_s?.value));
    let truth =
        data.truth.as_ref().map_or_else(String::new, |truth| format!("; the truth is {} s", significant(truth.t_s, 3)));
    format!("{}{truth}", findings::range("T [s]", data.estimates.iter().filter_map(of)))
}
