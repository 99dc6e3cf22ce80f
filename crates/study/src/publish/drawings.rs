//! The figures of a finished study: which there are, what they say, and their files.

use std::path::Path;

use rayon::prelude::*;
use report::figures::{self, ErrorCell, ErrorCurve, ErrorCurves, ErrorPoint, Scale};
use report::{Figure, Origin, Theme};

use crate::engine::CellFacts;
use crate::failure::{Failure, OnPath};
use crate::showcase::{self, Showcase};
use crate::store::{Design, Stored};
use crate::summary::MethodSummary;

/// A figure that can be drawn.
pub struct Drawing<'a> {
    /// Stem of its files.
    pub stem: String,
    /// What is to be seen.
    pub caption: &'static str,
    /// The showcase it belongs to; `None` when it is about all trials.
    pub showcase: Option<usize>,
    draw: Box<dyn Fn(&Theme) -> Figure + Sync + Send + 'a>,
}

/// All figures, in the order of the report.
pub fn of<'a>(stored: &'a Stored, summaries: &[MethodSummary]) -> Vec<Drawing<'a>> {
    let mut drawings = Vec::new();
    let mut prefixes: Vec<String> = Vec::new();
    for (index, showcase) in stored.showcases.iter().enumerate() {
        let mut prefix = slug(&showcase.title);
        // Two titles may make one slug.
        if prefixes.contains(&prefix) {
            prefix = format!("{prefix}-{}", index + 1);
        }
        drawings.extend(of_showcase(index, &prefix, showcase));
        prefixes.push(prefix);
    }
    drawings.extend(error_curves(&stored.design, summaries).map(|data| Drawing {
        stem: "errors".into(),
        caption: "Root mean square error of K and T against the swept quantity, with 95 % bootstrap intervals and the \
                  Cramér–Rao bound. A curve that is flat to the left is bias, one that follows the bound is noise.",
        showcase: None,
        draw: Box::new(move |theme| figures::error_curves(&data, theme)),
    }));
    drawings
}

fn of_showcase<'a>(index: usize, prefix: &str, showcase: &'a Showcase) -> Vec<Drawing<'a>> {
    let drawing = |name: &str, caption, draw: Box<dyn Fn(&Theme) -> Figure + Sync + Send + 'a>| Drawing {
        stem: if prefix.is_empty() { name.to_owned() } else { format!("{prefix}-{name}") },
        caption,
        showcase: Some(index),
        draw,
    };
    let mut drawings = Vec::new();
    if let Some(data) = &showcase.trial {
        drawings.push(drawing(
            "trial",
            "The trial with its characteristic points (ITTC): executes, overshoots, times to check yaw, period.",
            Box::new(|theme| figures::zigzag_trial(data, theme)),
        ));
    }
    if let Some(data) = &showcase.fourier_fit {
        drawings.push(drawing(
            "fourier-fit",
            "The Fourier series fitted to the heading, and what it leaves.",
            Box::new(|theme| figures::curve_fit(data, theme)),
        ));
    }
    if let Some(data) = &showcase.derivatives {
        drawings.push(drawing(
            "derivatives",
            "Heading, yaw rate and yaw acceleration of the fitted series against the truth: a good heading does not make a \
             good acceleration.",
            Box::new(|theme| figures::derivatives(data, theme)),
        ));
    }
    drawings.push(drawing(
        "replays",
        "The recorded rudder replayed through every method's K, T and δ_r; only the initial state is fitted.",
        Box::new(|theme| figures::replays(&showcase.replays, theme)),
    ));
    drawings.push(drawing(
        "intervals",
        "K and T of every method with 95 % intervals, beside the truth and the published values.",
        Box::new(|theme| figures::intervals(&showcase.intervals, theme)),
    ));
    drawings
}

/// Draws and writes all of them, in parallel.
pub fn write_all(drawings: &[Drawing], theme: &Theme, folder: &Path) -> Result<(), Failure> {
    drawings.par_iter().try_for_each(|drawing| write_figure(&(drawing.draw)(theme), folder, &drawing.stem))
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

#[cfg(test)]
mod tests {
    use super::slug;

    #[test]
    fn slugs_are_file_names() {
        assert_eq!(slug("10/20 (published reading)"), "10-20-published-reading");
        assert_eq!(slug(""), "");
    }
}
