//! An error against a swept quantity, such as the rms error of K against the noise in the heading: one line per method,
//! the Cramér–Rao bound for comparison, panels for several parameters (rows) and manoeuvres (columns).

use serde::{Deserialize, Serialize};

use super::shared::{PAD, Reference95};
use crate::axis::Axis;
use crate::clip::{self, Place};
use crate::dimension::Dimensions;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample, stroke_of};
use crate::palette::{INK, Look, Origin, QUIET, RECORD, SHORT_DASH};
use crate::panel::Panel;
use crate::scene::{Anchor, Layer, Scene, Stroke, Text};
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
    /// Too large to set the axis: an arrow at the upper edge stands for it.
    #[serde(default)]
    pub beyond: bool,
}

impl ErrorPoint {
    /// An error that sets the axis.
    pub fn new(x: f64, y: f64, interval: Option<[f64; 2]>) -> Self {
        Self { x, y, interval, beyond: false }
    }
}

/// A value of the swept quantity with a name of its own, such as a limit of a rule.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AxisMark {
    /// The value.
    pub at: f64,
    /// Its name.
    pub label: String,
}

/// The errors of one method, or the bound.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorCurve {
    /// Whose errors; decides how the line looks.
    pub origin: Origin,
    /// In the order of the swept quantity.
    pub points: Vec<ErrorPoint>,
    /// Name in place of that of the origin: several methods with one line, each on a line of its own.
    #[serde(default)]
    pub label: Option<String>,
    /// Grey and thin, behind what the figure is about.
    #[serde(default)]
    pub is_quiet: bool,
}

impl ErrorCurve {
    /// The errors of one method, or the bound.
    pub fn new(origin: Origin, points: Vec<ErrorPoint>) -> Self {
        Self { origin, points, label: None, is_quiet: false }
    }

    fn name(&self) -> &str {
        self.label.as_deref().unwrap_or(self.origin.label())
    }

    fn look(&self) -> Look {
        let look = self.origin.look();
        if self.is_quiet { Look { colour: QUIET, ..look } } else { look }
    }

    fn stroke(&self, theme: &Theme) -> Stroke {
        let width = match (&self.origin, self.is_quiet) {
            (Origin::Bound, _) => 1.3 * theme.line,
            (_, true) => 0.7 * theme.line,
            _ => theme.line,
        };
        Stroke { width, colour: self.look().colour, ..stroke_of(&self.origin, theme) }
    }
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
    /// Values of the swept quantity that are marked in every panel.
    #[serde(default)]
    pub marks: Vec<AxisMark>,
    /// Whether names stand at the right ends of the lines, in place of a key.
    #[serde(default)]
    pub names_at_lines: bool,
    /// A remark under the figure.
    #[serde(default)]
    pub note: Option<String>,
}

/// Draws the panels: rows share the vertical, columns the horizontal axis.
pub fn error_curves(data: &ErrorCurves, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    if !data.names_at_lines {
        let known = known(data);
        sheet.legend(&known.iter().map(|curve| entry(curve, theme)).collect::<Vec<_>>());
    }
    let count = data.columns.len().max(1);
    let height = theme.tall(if count == 1 || data.names_at_lines { 0.3 } else { 0.24 });
    let rows = data.rows.iter().enumerate().map(|(i, title)| (Side::new(y_axis(data, i), title.clone()), height));
    let columns = (0..count).map(|i| Side::new(x_axis(data, i), data.x_title.clone()));
    let heads = data.columns.iter().map(|head| Some(Entry::new(Sample::Nothing, head.clone())));
    let grid = Grid { heads: heads.collect(), ..Grid::new(columns.collect(), rows.collect()) };
    let panels = match data.names_at_lines {
        true => sheet.grid_within(grid, (0.0, theme.width - room_for_names(data, theme))),
        false => sheet.grid(grid),
    };
    for cell in data.cells.iter().filter(|cell| cell.column < count) {
        let Some(panel) = panels.get(cell.row * count + cell.column) else { continue };
        if let Some(reference) = &data.reference {
            reference.horizontal(panel, &mut sheet.scene, theme);
        }
        data.marks.iter().for_each(|mark| draw_mark(panel, &mut sheet.scene, theme, mark));
        // What the figure is about stands over the rest.
        let (quiet, loud): (Vec<_>, Vec<_>) = cell.curves.iter().partition(|curve| curve.is_quiet);
        quiet.into_iter().chain(loud).for_each(|curve| draw(panel, &mut sheet.scene, theme, curve));
        if data.names_at_lines && cell.column + 1 == count {
            names(panel, &mut sheet.scene, theme, &cell.curves);
        }
    }
    if let Some(note) = &data.note {
        sheet.note(note);
    }
    sheet.finish()
}

/// Everyone who appears, in the order of appearance, the bound last.
fn known(data: &ErrorCurves) -> Vec<&ErrorCurve> {
    let mut found: Vec<&ErrorCurve> = Vec::new();
    for curve in data.cells.iter().flat_map(|cell| &cell.curves) {
        if !found.iter().any(|one| one.origin == curve.origin) {
            found.push(curve);
        }
    }
    found.sort_by_key(|curve| curve.origin == Origin::Bound);
    found
}

fn entry(curve: &ErrorCurve, theme: &Theme) -> Entry {
    let sample = match curve.origin {
        Origin::Bound => Sample::Line(curve.stroke(theme)),
        _ => Sample::LineAndMarker(curve.stroke(theme), curve.look()),
    };
    Entry::new(sample, curve.name())
}

/// A line across the frame, its name beside its upper end.
fn draw_mark(panel: &Panel, scene: &mut Scene, theme: &Theme, mark: &AxisMark) {
    panel.vertical(scene, Layer::Grid, mark.at, Stroke::solid(INK, theme.thin).dashed(SHORT_DASH));
    let text = Text::new(mark.label.as_str(), theme.small_font);
    let Some(x) = panel.across(mark.at).filter(|x| panel.rect.contains((*x, panel.rect.y))) else { return };
    let gap = 0.4 * theme.small_font;
    let is_right = x + gap + text.width() < panel.rect.right();
    let (place, anchor) = if is_right { (x + gap, Anchor::Start) } else { (x - gap, Anchor::End) };
    scene.text_on_ground(Layer::Note, (place, panel.rect.y + 1.2 * theme.small_font), text.anchor(anchor));
}

/// Width of the names at the lines with what keeps them clear of the frame, points.
fn room_for_names(data: &ErrorCurves, theme: &Theme) -> f64 {
    let widths = known(data).into_iter().flat_map(|curve| lines_of(curve.name()));
    let bold = |line: String| Text { bold: true, ..Text::new(line, theme.small_font) };
    widths.map(|line| bold(line).width()).fold(0.0, f64::max)
}

/// The lines of a name: methods that share a line stand below each other.
fn lines_of(name: &str) -> Vec<String> {
    name.split('\n').map(str::to_owned).collect()
}

/// Names right of the frame, as near to the ends of their lines as they can stand without touching each other.
fn names(panel: &Panel, scene: &mut Scene, theme: &Theme, curves: &[ErrorCurve]) {
    let line = 1.15 * theme.small_font;
    let mut ends: Vec<(f64, &ErrorCurve)> = Vec::new();
    for curve in curves {
        let Some(last) = curve.points.last() else { continue };
        let edge = if last.beyond { Some(panel.rect.y) } else { panel.up(last.y) };
        ends.extend(edge.map(|y| (y.clamp(panel.rect.y, panel.rect.bottom()), curve)));
    }
    ends.sort_by(|one, other| one.0.total_cmp(&other.0));
    let tall = |curve: &ErrorCurve| lines_of(curve.name()).len() as f64 * line;
    // Down the frame each name begins below the one before; then all move up as far as the last has left the frame.
    let mut tops: Vec<f64> = Vec::with_capacity(ends.len());
    let mut free = panel.rect.y - 0.5 * line;
    for (y, curve) in &ends {
        let top = (y - 0.5 * tall(curve)).max(free);
        tops.push(top);
        free = top + tall(curve);
    }
    let mut limit = panel.rect.bottom() + 0.5 * line;
    for ((_, curve), top) in ends.iter().zip(&mut tops).rev() {
        *top = top.min(limit - tall(curve));
        limit = *top;
    }
    let left = panel.rect.right() + 0.6 * theme.small_font;
    for ((_, curve), top) in ends.iter().zip(tops) {
        for (number, text) in lines_of(curve.name()).into_iter().enumerate() {
            let colour = if curve.is_quiet { RECORD } else { curve.look().colour };
            let text = Text { bold: !curve.is_quiet, ..Text::new(text, theme.small_font).colour(colour) };
            let y = top + (number as f64 + 0.5) * line + text.centring();
            scene.text(Layer::Note, (left, y), text);
        }
    }
}

fn points(data: &ErrorCurves, wanted: impl Fn(&ErrorCell) -> bool) -> Vec<ErrorPoint> {
    let cells = data.cells.iter().filter(|cell| wanted(cell));
    cells.flat_map(|cell| &cell.curves).flat_map(|curve| &curve.points).copied().collect()
}

fn x_axis(data: &ErrorCurves, column: usize) -> Axis {
    let marks = data.marks.iter().map(|mark| mark.at);
    data.x_scale.covering(points(data, |cell| cell.column == column).iter().map(|p| p.x).chain(marks).collect())
}

fn y_axis(data: &ErrorCurves, row: usize) -> Axis {
    let mut points = points(data, |cell| cell.row == row);
    points.retain(|point| !point.beyond);
    data.y_scale.around(points.iter().map(|p| p.y), points.iter().filter_map(|p| p.interval), data.reference)
}

fn draw(panel: &Panel, scene: &mut Scene, theme: &Theme, curve: &ErrorCurve) {
    let stroke = curve.stroke(theme);
    if curve.origin == Origin::Bound {
        panel.line(scene, curve.points.iter().map(|p| (p.x, p.y)), stroke);
        return;
    }
    let look = curve.look();
    let bar = Stroke::solid(look.colour, 0.7 * stroke.width);
    let mut line: Vec<Option<Place>> = Vec::with_capacity(curve.points.len());
    let mut was_beyond = false;
    for point in &curve.points {
        let place = match point.beyond {
            true => panel.across(point.x).map(|x| (x, panel.rect.y)),
            false => panel.place((point.x, point.y)),
        };
        // Between zero and the first positive value the axis is broken, and so is the line.
        let after_zero = point.x == 0.0 && panel.x.break_at().is_some();
        // Nor does it run along the upper edge.
        if point.beyond && was_beyond {
            line.push(None);
        }
        was_beyond = point.beyond;
        line.push(place);
        if after_zero {
            line.push(None);
        }
        if let (Some(place), Some([lo, hi]), false) = (place, point.interval, point.beyond) {
            error_bar(panel, scene, place.0, [lo, hi], 0.7 * theme.marker, bar);
        }
    }
    for part in clip::clip(line.iter().copied(), &panel.rect) {
        scene.line(Layer::Data, part, stroke);
    }
    let size = if curve.is_quiet { 0.65 } else { 0.9 } * theme.marker;
    for point in &curve.points {
        match panel.place((point.x, point.y)) {
            Some((x, _)) if point.beyond => {
                Dimensions::head(scene, (x, panel.rect.y), (0.0, -1.0), 0.7 * theme.small_font, look.colour);
            }
            Some(place) if panel.rect.contains(place) => scene.marker(Layer::Data, place, size, &look),
            _ => {}
        }
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
