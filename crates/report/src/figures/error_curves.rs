//! An error against a swept quantity, such as the rms error of K against the noise in the heading: one line per method,
//! the Cramér–Rao bound for comparison, panels for several parameters (rows) and manoeuvres (columns).

use serde::{Deserialize, Serialize};

use super::shared::{PAD, Reference95, distinct};
use crate::axis::Axis;
use crate::clip::{self, Place};
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample, stroke_of};
use crate::palette::Origin;
use crate::panel::Panel;
use crate::scene::{Layer, Scene, Stroke};
use crate::theme::Theme;
use crate::ticks::Steps;

/// How an axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scale {
    /// Equal steps; negative values are allowed.
    Linear,
    /// Equal factors; a zero has a place of its own beyond a break, negative values are left out.
    #[default]
    Log,
}

impl Scale {
    /// An axis over values.
    fn covering(self, values: Vec<f64>) -> Axis {
        match self {
            Self::Linear => Axis::covering(values, PAD, Steps::Decimal),
            Self::Log => Axis::log_covering(values),
        }
    }

    /// An axis over values, their intervals and what they are held against.
    pub(super) fn around(
        self,
        values: impl Iterator<Item = f64>,
        intervals: impl Iterator<Item = [f64; 2]>,
        reference: Option<Reference95>,
    ) -> Axis {
        let mut values: Vec<f64> = values.collect();
        values.extend(reference.iter().flat_map(|reference| [reference.value, reference.band[0], reference.band[1]]));
        // The lower end of an interval of an error can come close to zero and would stretch a logarithmic axis by
        // decades; such a bar is cut at the frame.
        let lowest = values.iter().copied().filter(|value| *value > 0.0).fold(f64::INFINITY, f64::min);
        values.extend(intervals.flatten().filter(|end| self == Self::Linear || *end > 0.5 * lowest));
        self.covering(values)
    }
}

/// An error at one value of the swept quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ErrorPoint {
    /// The swept quantity.
    pub x: f64,
    /// The error.
    pub y: f64,
    /// 95 % interval of the error.
    pub interval: Option<[f64; 2]>,
}

/// The errors of one method, or the bound.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorCurve {
    /// Whose errors; decides how the line looks.
    pub origin: Origin,
    /// In the order of the swept quantity.
    pub points: Vec<ErrorPoint>,
}

/// The content of one panel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorCell {
    /// Index into [`ErrorCurves::rows`].
    pub row: usize,
    /// Index into [`ErrorCurves::columns`].
    pub column: usize,
    /// The lines.
    pub curves: Vec<ErrorCurve>,
}

/// What [`error_curves`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ErrorCurves {
    /// Title above the figure.
    pub title: Option<String>,
    /// The swept quantity with its unit, such as "heading noise [°]".
    pub x_title: String,
    /// Division of the horizontal axes.
    pub x_scale: Scale,
    /// Division of the vertical axes.
    pub y_scale: Scale,
    /// Title with unit of each row, such as "rms error of K [%]".
    pub rows: Vec<String>,
    /// Head of each column, such as "20°/20° zig-zag".
    pub columns: Vec<String>,
    /// The panels; one outside `rows` and `columns` is not drawn.
    pub cells: Vec<ErrorCell>,
    /// A value to compare with, in every panel.
    #[serde(default)]
    pub reference: Option<Reference95>,
}

/// Draws the panels: rows share the vertical, columns the horizontal axis.
pub fn error_curves(data: &ErrorCurves, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let origins = origins(data);
    sheet.legend(&origins.iter().map(|o| entry(o, theme)).collect::<Vec<_>>());
    let count = data.columns.len().max(1);
    let height = theme.tall(if count == 1 { 0.3 } else { 0.24 });
    let rows = data.rows.iter().enumerate().map(|(i, title)| (Side::new(y_axis(data, i), title.clone()), height));
    let columns = (0..count).map(|i| Side::new(x_axis(data, i), data.x_title.clone()));
    let heads = data.columns.iter().map(|head| Some(Entry::new(Sample::Nothing, head.clone())));
    let panels = sheet.grid(Grid { heads: heads.collect(), ..Grid::new(columns.collect(), rows.collect()) });
    for cell in data.cells.iter().filter(|cell| cell.column < count) {
        let Some(panel) = panels.get(cell.row * count + cell.column) else { continue };
        if let Some(reference) = &data.reference {
            reference.horizontal(panel, &mut sheet.scene, theme);
        }
        for curve in &cell.curves {
            let index = origins.iter().position(|o| **o == curve.origin).unwrap_or(0);
            // Methods of equal error would hide each other's bars, so each stands a little aside.
            let aside = (index as f64 - (origins.len() - 1) as f64 / 2.0) * 0.35 * theme.marker;
            draw(panel, &mut sheet.scene, theme, curve, aside);
        }
    }
    sheet.finish()
}

/// Everyone who appears, in the order of appearance, the bound last.
fn origins(data: &ErrorCurves) -> Vec<&Origin> {
    let mut found = distinct(data.cells.iter().flat_map(|cell| &cell.curves).map(|curve| &curve.origin));
    found.sort_by_key(|origin| **origin == Origin::Bound);
    found
}

fn entry(origin: &Origin, theme: &Theme) -> Entry {
    let sample = match origin {
        Origin::Bound => Sample::Line(bound_stroke(theme)),
        _ => Sample::LineAndMarker(stroke_of(origin, theme), origin.look()),
    };
    Entry::new(sample, origin.label())
}

fn bound_stroke(theme: &Theme) -> Stroke {
    Stroke { width: 1.3 * theme.line, ..stroke_of(&Origin::Bound, theme) }
}

fn points(data: &ErrorCurves, wanted: impl Fn(&ErrorCell) -> bool) -> Vec<ErrorPoint> {
    let cells = data.cells.iter().filter(|cell| wanted(cell));
    cells.flat_map(|cell| &cell.curves).flat_map(|curve| &curve.points).copied().collect()
}

fn x_axis(data: &ErrorCurves, column: usize) -> Axis {
    data.x_scale.covering(points(data, |cell| cell.column == column).iter().map(|p| p.x).collect())
}

fn y_axis(data: &ErrorCurves, row: usize) -> Axis {
    let points = points(data, |cell| cell.row == row);
    data.y_scale.around(points.iter().map(|p| p.y), points.iter().filter_map(|p| p.interval), data.reference)
}

fn draw(panel: &Panel, scene: &mut Scene, theme: &Theme, curve: &ErrorCurve, aside: f64) {
    if curve.origin == Origin::Bound {
        panel.line(scene, curve.points.iter().map(|p| (p.x, p.y)), bound_stroke(theme));
        return;
    }
    let look = curve.origin.look();
    let stroke = stroke_of(&curve.origin, theme);
    let bar = Stroke::solid(look.colour, 0.7 * theme.line);
    let mut line: Vec<Option<Place>> = Vec::with_capacity(curve.points.len());
    for point in &curve.points {
        let place = panel.place((point.x, point.y)).map(|(x, y)| (x + aside, y));
        // Between zero and the first positive value the axis is broken, and so is the line.
        let after_zero = point.x == 0.0 && panel.x.break_at().is_some();
        line.push(place);
        if after_zero {
            line.push(None);
        }
        if let (Some(place), Some([lo, hi])) = (place, point.interval) {
            error_bar(panel, scene, place.0, [lo, hi], 0.7 * theme.marker, bar);
        }
    }
    for part in clip::clip(line.iter().copied(), &panel.rect) {
        scene.line(Layer::Data, part, stroke);
    }
    for place in line.into_iter().flatten().filter(|place| panel.rect.contains(*place)) {
        scene.marker(Layer::Data, place, 0.9 * theme.marker, &look);
    }
}

/// A vertical bar with caps at `across`; an end beyond the frame (or at zero on a logarithmic axis) is cut, without
/// cap.
fn error_bar(panel: &Panel, scene: &mut Scene, across: f64, [lo, hi]: [f64; 2], cap: f64, stroke: Stroke) {
    let rect = panel.rect;
    let Some(high) = panel.up(lo.max(hi)) else { return };
    let low = panel.up(lo.min(hi)).unwrap_or(f64::INFINITY);
    let (top, bottom) = (high.max(rect.y), low.min(rect.bottom()));
    if top > bottom || !rect.contains((across, top)) {
        return;
    }
    scene.line(Layer::Data, [(across, top), (across, bottom)], stroke);
    for y in [low, high].into_iter().filter(|y| rect.contains((across, *y))) {
        scene.line(Layer::Data, [(across - cap, y), (across + cap, y)], stroke);
    }
}
