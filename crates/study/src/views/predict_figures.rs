//! Figures of a prediction: headings with bands, tracks, the diagram of steady turns, and characteristics against the
//! limits of IMO.

use std::f64::consts::TAU;

use campaign::curves::degrees;
use document::names;
use predict::imo::PredictedCriterion;
use predict::interval::PredictionInterval;
use predict::prediction::{BandedCurve, PredictedFigure};
use predict::replay::{ComparedFigure, RecordReplay};
use predict::turn::TurnTracks;
use predict::{PredictDocument, Prediction};
use report::figures::{
    AxisSpec, Layer, LayerKind, NamedRows, PanelGroup, PanelRow, Panels, Pen, RowItem, RowKind, RowPlace, RowsColumn,
};
use report::number::{counted, fixed, significant};
use report::palette::{CurveStyle, HEADING, INK, MODEL_BEFORE, Marker, SOLID};
use report::{PageFigure, PlotCurve};
use ship::angle::to_deg;
use trial::Manoeuvre;
use trial::imo::CriterionUnit;

use super::circle::{self, CircleTrack, DIMENSION_LINES_NOTE, predicted_pen};
use super::predict_curves::manoeuvre_stems;
use super::record_figures::{rudder, stability, steady_turns};

/// Approximate number of ship symbols along a track.
const DRAWN_HEADINGS: usize = 12;

/// All figures, in the order of the page.
pub fn figures(document: &PredictDocument) -> Vec<PageFigure> {
    let stems = manoeuvre_stems(document);
    let mut figures = Vec::new();
    for (prediction, stem) in document.manoeuvres.iter().zip(&stems) {
        figures.extend(of_manoeuvre(document, prediction, stem));
    }
    for (replayed, stem) in document.replays.iter().zip(&stems[document.manoeuvres.len()..]) {
        let caption =
            format!("{}: the record and the replay of its rudder, without a fit.", names::record_name(&replayed.name));
        figures.push(PageFigure::new(stem.as_str(), inside(replayed), caption, replay(replayed)));
        figures.extend(replayed.tracks.as_ref().map(|tracks| {
            let caption = format!(
                "{}: recorded and predicted track of the turn from the execute on; nothing is fitted to it, and its current is removed. \
                 {DIMENSION_LINES_NOTE} Thin: {} drawn ships.",
                names::record_name(&replayed.name),
                tracks.drawn.len()
            );
            PageFigure::new(format!("{stem}-track"), diameter(replayed), caption, turn(replayed, tracks))
        }));
    }
    for (unit, stem) in [(CriterionUnit::Degrees, "imo-overshoots"), (CriterionUnit::ShipLengths, "imo-lengths")] {
        let criteria = document.imo.iter().filter(|criterion| criterion.unit == unit.symbol());
        let criteria: Vec<&PredictedCriterion> = criteria.collect();
        let rows: Vec<_> = criteria.iter().map(|criterion| limit(criterion)).collect();
        if !rows.is_empty() {
            let kept = criteria.iter().filter(|criterion| criterion.probability_of_passing >= MIN_PROBABILITY).count();
            let finding = format!(
                "{kept} of {} are met with a probability of {:.0} % or more",
                counted(rows.len() as u64, "criterion"),
                100.0 * MIN_PROBABILITY
            );
            let caption = "Criteria of IMO MSC.137(76): predicted values and limits.";
            let unit = if unit == CriterionUnit::Degrees { "°" } else { unit.symbol() };
            figures.push(PageFigure::new(stem, finding, caption, intervals(unit, rows)));
        }
    }
    let measured = measured(document);
    if !measured.is_empty() {
        let caption = "Measured and predicted overshoots of the records.";
        let shown =
            || document.replays.iter().flat_map(|replay| &replay.figures).filter(|(name, _)| is_overshoot(name));
        let inside =
            shown().filter(|(_, swing)| (swing.interval.ci90[0]..=swing.interval.ci90[1]).contains(&swing.measured));
        let finding =
            format!("{} of {} measured overshoots lie inside their 90 % interval", inside.count(), shown().count());
        figures.push(PageFigure::new("overshoots", finding, caption, intervals("°", measured)));
    }
    figures
}

fn of_manoeuvre(document: &PredictDocument, prediction: &Prediction, stem: &str) -> Vec<PageFigure> {
    let kind = prediction.kind.to_string();
    if matches!(prediction.kind, Manoeuvre::Spiral { .. }) {
        let caption = format!("{kind}: steady yaw rate against rudder, the unstable branch dashed; thin: drawn ships.");
        let steady = &prediction.curves.steady;
        return vec![PageFigure::new(stem, stability(steady), caption, steady_turns(steady, document.validity_range))];
    }
    let passage = prediction.curves.most_probable.as_ref();
    let steered = passage.map_or_else(PlotCurve::default, |passage| {
        let time: Vec<f64> = (0..passage.rudder.len()).map(|row| passage.time(row)).collect();
        PlotCurve::new(time, degrees(&passage.rudder))
    });
    let caption = format!("{kind}: heading of the most probable ship with the bands of {} draws.", document.draws);
    let mut figures = vec![PageFigure::new(
        stem,
        first_characteristics_finding(prediction),
        caption,
        bands(&prediction.curves.heading, None, steered),
    )];
    if passage.is_some_and(|passage| passage.track().is_some()) {
        let caption =
            format!("{kind}: track of the most probable ship; thin: {} drawn ships.", prediction.curves.tracks.len());
        figures.push(PageFigure::new(
            format!("{stem}-track"),
            first_characteristics_finding(prediction),
            caption,
            track(prediction),
        ));
    }
    figures
}

/// Minimum probability at which a criterion counts as met.
const MIN_PROBABILITY: f64 = 0.95;

/// Maximum number of characteristics in a finding.
const MAX_NAMED_FIGURES: usize = 2;

/// Finding of the figure of a manoeuvre: its first [`MAX_NAMED_FIGURES`] characteristics, median and 90 % interval over
/// the drawn ships; without characteristics, that no drawn ship completes it.
fn first_characteristics_finding(prediction: &Prediction) -> String {
    let figure_words = |(name, figure): (&String, &PredictedFigure)| {
        let [low, high] = figure.interval.ci90.map(|end| significant(end, 3));
        let (quantity, unit) = names::figure_of_merit(name);
        format!("{quantity} {}{unit} [{low}, {high}]", significant(figure.interval.median, 3))
    };
    let shown: Vec<String> = prediction.figures.iter().take(MAX_NAMED_FIGURES).map(figure_words).collect();
    match shown.is_empty() {
        true => format!("{}: no drawn ship completes it", prediction.kind),
        false => format!("{}: {}", prediction.kind, shown.join(", ")),
    }
}

/// Heading error of a replay; of more than one round also the error of the mean yaw rate, which adds up to it.
pub fn heading_error_phrase(replayed: &RecordReplay) -> String {
    let error = format!("heading error {}° (rms)", significant(replayed.heading_rmse_deg, 3));
    let turned = |all: &[f64]| all.last().zip(all.first()).map_or(0.0, |(last, first)| last - first);
    let [measured, predicted] = [turned(&replayed.measured_heading), turned(&replayed.heading_band.most_probable)];
    if measured.abs() < TAU {
        return error;
    }
    let (rounds, off) = (fixed(measured.abs() / TAU, 1), 100.0 * (predicted / measured - 1.0));
    let side = if off < 0.0 { "low" } else { "high" };
    format!(
        "{error}, which adds up over {rounds} rounds: the mean yaw rate is {} % too {side}",
        significant(off.abs(), 2)
    )
}

/// Finding: coverage of the band and heading error of a replayed record.
fn inside(replayed: &RecordReplay) -> String {
    let share = fixed(100.0 * replayed.band_coverage_90, 0);
    format!("The 90 % band holds {share} % of the headings; most probable ship: {}", heading_error_phrase(replayed))
}

/// Tactical diameter of a recorded turn and of its prediction; without it, the heading error.
fn diameter(replayed: &RecordReplay) -> String {
    let Some(diameter) = replayed.figures.get("tactical_diameter_lengths") else { return inside(replayed) };
    let [low, high] = diameter.interval.ci90.map(|end| significant(end, 3));
    let [measured, median] = [diameter.measured, diameter.interval.median].map(|value| significant(value, 3));
    format!("Tactical diameter {median} L [{low}, {high}] predicted, {measured} L measured")
}

/// Opacity of the 90 % band, and of the 50 % band over it.
const BANDS: [f64; 2] = [0.2, 0.38];

/// Heading with bands and rudder over one time axis; the outer band is cut if it needs too much room.
fn bands(heading: &BandedCurve, recorded: Option<PlotCurve>, rudder_deg: PlotCurve) -> Panels {
    let curve = |values: Vec<f64>| PlotCurve::new(heading.time.as_slice(), values);
    let quantile = |place: usize| curve(heading.quantiles.iter().map(|row| to_deg(row[place])).collect());
    let band = |name: &str, ends: [usize; 2], opacity| Layer::band(name, ends.map(quantile), HEADING, opacity);
    let mut layers =
        vec![band("90 % of the drawn ships", [0, 4], BANDS[0]).widening_at_most(1.0), band("50 %", [1, 3], BANDS[1])];
    layers.extend(recorded.map(|heading| Layer::new("recorded heading", heading, LayerKind::Record)));
    let pen = Pen::new(HEADING).width(1.2);
    layers.push(Layer::line("most probable ship", curve(degrees(&heading.most_probable)), pen));
    let rows = vec![(PanelRow::new(AxisSpec::heading(), 0.32), layers), rudder("rudder", rudder_deg, 0.13)];
    let clipping_note = Some(String::from("The band of 90 % is cut at the frame."));
    Panels { clipping_note, ..Panels::over_time(rows) }
}

fn replay(replayed: &RecordReplay) -> Panels {
    let recorded = PlotCurve::new(replayed.heading_band.time.as_slice(), degrees(&replayed.measured_heading));
    let rudder =
        PlotCurve::new(replayed.rudder_times_and_angles[0].as_slice(), degrees(&replayed.rudder_times_and_angles[1]));
    bands(&replayed.heading_band, Some(recorded), rudder)
}

/// Curve of a track, north over east, from points of north and east.
fn from_above(track: &[[f64; 2]]) -> PlotCurve {
    let (east, north): (Vec<f64>, Vec<f64>) = track.iter().map(|place| (place[1], place[0])).unzip();
    PlotCurve::new(east, north)
}

/// Recorded turn and the median of its prediction.
fn turn(replayed: &RecordReplay, tracks: &TurnTracks) -> Panels {
    let drawn =
        |track: &Vec<[f64; 2]>| Layer::line("drawn ships", from_above(track), Pen::pale()).widening_at_most(0.15);
    let figures = |of: fn(&ComparedFigure) -> f64| {
        let length = replayed.figures.get("advance_m").zip(replayed.figures.get("advance_lengths"));
        let length = length.map(|(metres, lengths)| metres.measured / lengths.measured);
        let of_name = |name| replayed.figures.get(name).map(of).zip(length).map(|(metres, length)| metres / length);
        ["advance_m", "transfer_m", "tactical_diameter_m"].map(of_name)
    };
    let circle = |name: &str, track: &[[f64; 2]], lengths, pen| {
        let (name, track) = (name.to_owned(), from_above(track));
        CircleTrack { name, track, lengths, pen }
    };
    let circles = [
        circle("measured", &tracks.measured, figures(|figure| figure.measured), Pen::new(INK).width(1.8)),
        circle("median of the drawn ships", &tracks.median, figures(|figure| figure.interval.median), predicted_pen()),
    ];
    let clipping_note = Some(String::from("Some drawn ships are cut at the frame."));
    Panels { clipping_note, ..Panels::new(circle::plan_view(&circles, tracks.drawn.iter().map(drawn).collect())) }
}

fn track(prediction: &Prediction) -> Panels {
    let passage = prediction.curves.most_probable.as_ref();
    let places_m = passage.and_then(|passage| passage.track()).unwrap_or_default();
    let step = (places_m.len() / DRAWN_HEADINGS).max(1);
    let (mut places, mut headings) = (PlotCurve::default(), Vec::new());
    for row in (0..places_m.len()).step_by(step) {
        places.x.push(places_m[row][1]);
        places.y.push(places_m[row][0]);
        headings.extend(passage.map(|passage| to_deg(passage.heading[row])));
    }
    let drawn = prediction
        .curves
        .tracks
        .iter()
        .map(|track| Layer::line("drawn ships", from_above(track), Pen::pale()).widening_at_most(0.35));
    let layers = drawn.chain([
        Layer::line("most probable ship", from_above(places_m), Pen::new(HEADING).width(1.2)),
        Layer::new("its heading (not to scale)", places, LayerKind::Ships(HEADING, headings)),
    ]);
    let row = PanelRow::new(AxisSpec::decimal("north [m]"), 0.7);
    let group = PanelGroup::over(AxisSpec::decimal("east [m]"), vec![(row, layers.collect())]);
    let clipping_note = Some(String::from("Some drawn ships are cut at the frame."));
    Panels { clipping_note, ..Panels::new(PanelGroup { has_equal_scales: true, ..group }) }
}

/// Prediction intervals of characteristics, with measured values and limits.
fn intervals(unit: &str, rows: Vec<(String, Vec<RowItem>)>) -> NamedRows {
    let (names, rows) = rows.into_iter().unzip();
    let x = AxisSpec::decimal(format!("predicted value [{unit}]"));
    NamedRows {
        names,
        columns: vec![RowsColumn { x, rows, has_zero_line: true, ..RowsColumn::default() }],
        ..NamedRows::default()
    }
}

fn interval(predicted: &PredictionInterval, extrapolated: bool) -> Vec<RowItem> {
    let style = CurveStyle { colour: HEADING, marker: Marker::Circle, dash: SOLID, is_hollow: extrapolated };
    let name = if extrapolated { "median, extrapolated" } else { "median" };
    vec![
        RowItem::new("90 %", RowKind::ThinInterval(predicted.ci90)).clipped_if_far(),
        RowItem::new("50 % of the drawn ships", RowKind::WideInterval(HEADING, predicted.ci50)),
        RowItem::new(name, RowKind::Mark(style, predicted.median, None)),
    ]
}

fn limit(criterion: &PredictedCriterion) -> (String, Vec<RowItem>) {
    let mut items = interval(&criterion.interval, criterion.extrapolated);
    items.insert(2, RowItem::new("IMO limit", RowKind::Limit(criterion.limit)));
    (criterion.criterion.clone(), items)
}

fn is_overshoot(name: &str) -> bool {
    name.ends_with("overshoot_deg")
}

/// Row for every overshoot of a replayed record: the predicted interval, and below it the measured angle.
fn measured(document: &PredictDocument) -> Vec<(String, Vec<RowItem>)> {
    let style = CurveStyle { colour: MODEL_BEFORE, marker: Marker::Diamond, dash: SOLID, is_hollow: true };
    let mut rows = Vec::new();
    for replayed in &document.replays {
        for (name, figure) in replayed.figures.iter().filter(|(name, _)| is_overshoot(name)) {
            let mut items = interval(&figure.interval, replayed.extrapolated);
            // Below the bar, so that a nearby median stays visible.
            let item = RowItem::new("measured", RowKind::Mark(style, figure.measured, None));
            items.push(RowItem { place: RowPlace::Shifted(0.34), ..item });
            rows.push((format!("{} {}", names::record_name(&replayed.name), names::figure_of_merit(name).0), items));
        }
    }
    rows
}
