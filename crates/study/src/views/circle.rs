//! Turning circles, recorded and predicted: their characteristics in a sentence, and their tracks to scale.

use document::fit::{CircleEntry, FitDocument, PredictedCircleEntry, TrialEntry};
use document::names;
use report::figures::{AxisSpec, Layer, PanelGroup, PanelRow, Panels, Pen};
use report::number::{fixed, significant};
use report::palette::{DASHED, DOTTED, HEADING, INK};
use report::{CurveOrigin, PageFigure, PlotCurve};

use crate::documents::fit_curves::{FitCurves, FitRecord};

/// Turning circles among the fitted records, with their names.
fn all<'a>(
    document: &'a FitDocument,
    curves: &'a FitCurves,
) -> impl Iterator<Item = (String, &'a CircleEntry, &'a FitRecord)> {
    let named = |(entry, record): (&'a TrialEntry, &'a FitRecord)| {
        Some((names::record_name(&record.name), entry.circle.as_ref()?, record))
    };
    document.trials.iter().zip(&curves.records).filter_map(named)
}

/// Sentence on a recorded circle: advance, transfer and tactical diameter in ship lengths.
pub fn circle_sentence(name: &str, circle: &CircleEntry) -> String {
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

/// Sentence on a predicted circle: advance, transfer and tactical diameter in ship lengths, with 90 % intervals.
fn predicted_sentence(circle: &PredictedCircleEntry) -> String {
    let figures = [
        ("advance", circle.advance_lengths),
        ("transfer", circle.transfer_lengths),
        ("tactical diameter", circle.tactical_diameter_lengths),
    ];
    let figures = figures.map(|(name, lengths)| {
        let [low, high] = lengths.ci90.map(|end| significant(end, 3));
        format!("{name} {} L [{low}, {high}]", significant(lengths.median, 3))
    });
    let beyond = if circle.extrapolated { ", extrapolated beyond the rudder or yaw rate of the records" } else { "" };
    format!(
        "Predicted with the hulls fitted to the records, a turning circle to {} with {}° of rudder: {}, median and 90 % of {} drawn ships{beyond}",
        circle.side,
        fixed(circle.rudder_deg, 1),
        figures.join(", "),
        circle.draws
    )
}

/// Sentence on every circle, the recorded ones first.
pub fn circle_sentences(document: &FitDocument, curves: &FitCurves) -> Vec<String> {
    let recorded = all(document, curves).map(|(name, circle, _)| circle_sentence(&name, circle));
    recorded.chain(document.predicted_circle.iter().map(predicted_sentence)).collect()
}

/// Circle to scale with its dimension lines.
pub struct CircleTrack {
    /// Name of the circle.
    pub name: String,
    /// Track, east and north in ship lengths from the execute; north is the approach course.
    pub track: PlotCurve,
    /// Advance, transfer and tactical diameter, ship lengths.
    pub lengths: [Option<f64>; 3],
    /// Pen of the track.
    pub pen: Pen,
}

impl CircleTrack {
    /// Layers of the circle, and of lines at its advance, its transfer and its tactical diameter.
    pub fn layers(&self) -> Vec<Layer> {
        let Self { name, track, lengths, pen } = self;
        let mut layers = vec![Layer::line(name.as_str(), track.clone(), *pen)];
        let side = track.finite_pairs().map(|(east, _)| east).max_by(|one, other| one.abs().total_cmp(&other.abs()));
        let side = side.unwrap_or_default().signum();
        let measures = Pen { dash: DOTTED, ..*pen }.width(0.8);
        let mut line = |from: [f64; 2], to: [f64; 2]| {
            let curve = PlotCurve::new([from[0], to[0]], [from[1], to[1]]);
            layers.push(Layer::line("", curve, measures));
        };
        let [advance, transfer, diameter] = *lengths;
        if let Some(advance) = advance {
            line([0.0, 0.0], [0.0, advance]);
            line([0.0, advance], [side * transfer.unwrap_or_default(), advance]);
        }
        let opposite = diameter.and_then(|diameter| {
            let north = track.finite_pairs().find(|(east, _)| side * east >= diameter * NEARLY)?.1;
            Some((side * diameter, north))
        });
        if let Some((east, north)) = opposite {
            line([0.0, north], [east, north]);
        }
        layers
    }
}

/// Share of the tactical diameter at which a point of a track is taken as its end, since the points are discrete.
const NEARLY: f64 = 0.999;

/// Circles from above, to scale, each with its dimension lines, over the `further` layers.
pub fn plan_view(circles: &[CircleTrack], further: Vec<Layer>) -> PanelGroup {
    let layers = further.into_iter().chain(circles.iter().flat_map(CircleTrack::layers)).collect();
    let row = PanelRow::new(AxisSpec::decimal("along the approach [L]"), 0.62);
    PanelGroup {
        has_equal_scales: true,
        ..PanelGroup::over(AxisSpec::decimal("across, to starboard [L]"), vec![(row, layers)])
    }
}

/// Note on the dimension lines of a circle.
pub const DIMENSION_LINES_NOTE: &str = "Dotted: advance and transfer at 90° of heading, tactical diameter at 180°.";

/// Pen of a predicted circle.
pub fn predicted_pen() -> Pen {
    Pen { dash: DASHED, ..Pen::new(HEADING).width(1.4) }
}

/// Tracks of all circles, to scale; `None` if no record has positions and no circle is predicted.
pub fn circle_figure(document: &FitDocument, curves: &FitCurves) -> Option<PageFigure> {
    let recorded = all(document, curves).filter_map(|(name, circle, record)| {
        let lengths = [circle.advance_lengths, circle.transfer_lengths, circle.tactical_diameter_lengths];
        Some((
            circle_sentence(&name, circle),
            CircleTrack { name, track: record.circle_track.clone()?, lengths, pen: Pen::new(INK) },
        ))
    });
    let (mut findings, mut circles): (Vec<String>, Vec<CircleTrack>) = recorded.unzip();
    for (number, circle) in circles.iter_mut().enumerate() {
        let style = CurveOrigin::Series { label: circle.name.clone(), number }.style();
        circle.pen = Pen::new(style.colour);
    }
    if let Some((entry, track)) = document.predicted_circle.as_ref().zip(curves.predicted_circle.clone()) {
        let lengths = [entry.advance_lengths, entry.transfer_lengths, entry.tactical_diameter_lengths];
        let name = format!("predicted median, {}° of rudder", fixed(entry.rudder_deg, 1));
        let lengths = lengths.map(|length| Some(length.median));
        circles.push(CircleTrack { name, track, lengths, pen: predicted_pen() });
        let [advance, diameter] =
            [entry.advance_lengths, entry.tactical_diameter_lengths].map(|lengths| significant(lengths.median, 3));
        let rudder = fixed(entry.rudder_deg, 1);
        findings
            .push(format!("Predicted with {rudder}° of rudder: advance {advance} L, tactical diameter {diameter} L"));
    }
    let caption = format!(
        "Tracks from the execute on, in ship lengths, a recorded one without the current that it shows. {DIMENSION_LINES_NOTE}"
    );
    Some(PageFigure::new("circle", findings.into_iter().next()?, caption, Panels::new(plan_view(&circles, Vec::new()))))
}
