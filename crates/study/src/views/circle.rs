//! Recorded turning circles: their figures of merit in a sentence, and their tracks to scale.

use document::fit::{CircleEntry, FitDocument, TrialEntry};
use document::names;
use report::figures::{Layer, PanelRow, Panels, Pen, Ruler, Stack};
use report::number::fixed;
use report::{CurveOrigin, PageFigure};

use crate::documents::fit_curves::{FitCurves, FitRecord};

/// The circles among the fitted records, with their names.
fn all<'a>(
    document: &'a FitDocument,
    curves: &'a FitCurves,
) -> impl Iterator<Item = (String, &'a CircleEntry, &'a FitRecord)> {
    let named = |(entry, record): (&'a TrialEntry, &'a FitRecord)| {
        Some((names::record(&record.name), entry.circle.as_ref()?, record))
    };
    document.trials.iter().zip(&curves.records).filter_map(named)
}

/// The figures of merit of a circle.
pub fn sentence(name: &str, circle: &CircleEntry) -> String {
    let CircleEntry { side, rudder_deg, advance_lengths, transfer_lengths, tactical_diameter_lengths } = circle;
    let figures = [
        ("advance", advance_lengths),
        ("transfer", transfer_lengths),
        ("tactical diameter", tactical_diameter_lengths),
    ];
    let figure = |(quantity, lengths): (&str, &Option<f64>)| Some(format!("{quantity} {} L", fixed((*lengths)?, 2)));
    let figures: Vec<String> = figures.into_iter().filter_map(figure).collect();
    let figures = match figures.is_empty() {
        true => String::from("without positions and a ship length, advance and diameter are unknown"),
        false => figures.join(", "),
    };
    format!("{name}, a turning circle to {side} with {}° of rudder: {figures}", fixed(rudder_deg.abs(), 1))
}

/// Figures of merit of every circle, a sentence each.
pub fn sentences(document: &FitDocument, curves: &FitCurves) -> Vec<String> {
    all(document, curves).map(|(name, circle, _)| sentence(&name, circle)).collect()
}

/// The tracks of all circles, to scale; `None` without positions.
pub fn figure(document: &FitDocument, curves: &FitCurves) -> Option<PageFigure> {
    let shown = all(document, curves).filter_map(|(name, circle, record)| Some((name, circle, record.circle.clone()?)));
    let (mut layers, mut findings) = (Vec::new(), Vec::new());
    for (name, circle, track) in shown {
        findings.push(sentence(&name, circle));
        let look = CurveOrigin::Series { label: name.clone(), number: layers.len() }.look();
        layers.push(Layer::line(name, track, Pen::new(look.colour)));
    }
    let row = PanelRow::new(Ruler::decimal("along the approach [L]"), 0.62);
    let stack = Stack { equal: true, ..Stack::over(Ruler::decimal("across, to starboard [L]"), vec![(row, layers)]) };
    let caption = "Tracks from the execute on, in ship lengths, without the current that they show.";
    Some(PageFigure::new("circle", findings.into_iter().next()?, caption, Panels::of(stack)))
}
