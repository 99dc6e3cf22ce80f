//! Named rows below each other over one or several axes: marks with intervals, bars from zero, limits, distributions.

use super::panels::{Pen, Ruler};
use super::reach::{Extents, INTERVALS};
use super::shared::{Reference95, zero_upright};
use crate::axis::PlotAxis;
use crate::clip::{PagePoint, Rect};
use crate::dimension::Dimensions;
use crate::figure::Drawing;
use crate::layout::{AxisSide, Grid, NAMES, Sheet};
use crate::legend::{KeyEntry, KeySample};
use crate::lines::wrap;
use crate::number::significant;
use crate::palette::{GRID, HEADING, INK, Look, PAPER, RECORD};
use crate::panel::Panel;
use crate::scene::{Anchor, Canvas, Layer, Stroke, TextLine};
use crate::theme::Theme;

/// What stands in a row.
#[derive(Debug, Clone, PartialEq)]
pub enum RowKind {
    /// A mark at a value, and its interval as a bar with caps. A value without bound is an arrow at the edge.
    Mark(Look, f64, Option<[f64; 2]>),
    /// A thin interval.
    Thin([f64; 2]),
    /// A thick interval.
    Thick([f64; 2]),
    /// A bar from zero.
    Bar(Look, f64),
    /// A line from the bottom to the top of the row.
    Limit(f64),
    /// No value: the name of the row is a heading of those below it.
    Heading,
    /// A distribution: value and density, ascending; its quantiles 2.5, 25, 50, 75 and 97.5 %.
    Violin(Look, Vec<(f64, f64)>, [f64; 5]),
}

/// Where something stands in its row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RowPlace {
    /// So far below the middle, as a share of the pitch of the rows.
    Aside(f64),
    /// On a line of its own below those before it.
    Below,
    /// On the line of what stands before it.
    Beside,
}

/// One thing in a row.
#[derive(Debug, Clone, PartialEq)]
pub struct RowItem {
    /// Its name in the key; items of one name are told once.
    pub name: Option<String>,
    /// What it is.
    pub kind: RowKind,
    /// Where it stands in its row.
    pub place: RowPlace,
    /// Whether it may be cut where it leaves the range of everything else by more than that range.
    pub soft: bool,
    /// A number written at the right end of the row.
    pub text: Option<String>,
}

impl RowItem {
    /// Something in the middle of its row that sets the axis.
    pub fn new(name: impl Into<String>, kind: RowKind) -> Self {
        let name = Some(name.into()).filter(|name| !name.is_empty());
        Self { name, kind, place: RowPlace::Aside(0.0), soft: false, text: None }
    }

    /// A row that is a heading.
    pub fn heading() -> Vec<Self> {
        vec![Self::new("", RowKind::Heading)]
    }

    /// A mark that stands below those before it in its row.
    pub fn below(name: impl Into<String>, look: Look, value: f64, interval: Option<[f64; 2]>) -> Self {
        Self { place: RowPlace::Below, ..Self::new(name, RowKind::Mark(look, value, interval)) }
    }

    /// The same, cut where it runs far off.
    pub fn softly(self) -> Self {
        Self { soft: true, ..self }
    }

    /// Whether it stands for a value, and not only for an interval of one; a heading needs none.
    fn is_value(&self) -> bool {
        match self.kind {
            RowKind::Mark(_, value, _) | RowKind::Bar(_, value) => !value.is_nan(),
            RowKind::Limit(_) | RowKind::Thin(_) | RowKind::Thick(_) => false,
            RowKind::Violin(..) | RowKind::Heading => true,
        }
    }

    fn is_stacked(&self) -> bool {
        self.place == RowPlace::Below
    }

    fn sample(&self, theme: &Theme) -> KeySample {
        match &self.kind {
            RowKind::Mark(look, ..) | RowKind::Violin(look, ..) => KeySample::Marker(*look),
            RowKind::Bar(look, _) => KeySample::Area(bar_stroke(look, theme)),
            RowKind::Thin(_) => KeySample::Line(Stroke::solid(HEADING, theme.line)),
            RowKind::Thick(_) => KeySample::Line(thick_stroke(theme)),
            RowKind::Limit(_) => KeySample::Upright(limit_stroke(theme)),
            RowKind::Heading => KeySample::Nothing,
        }
    }

    /// Enters its values into the extents of an axis.
    fn enter(&self, data: &mut Extents) {
        let ends: Vec<f64> = match &self.kind {
            RowKind::Mark(_, value, interval) => {
                data.soft.extend(interval.iter().flatten().map(|end| (*end, INTERVALS)));
                vec![*value]
            }
            RowKind::Thin(ends) | RowKind::Thick(ends) => ends.to_vec(),
            RowKind::Bar(_, value) => vec![0.0, *value],
            RowKind::Limit(value) => vec![*value],
            RowKind::Heading => Vec::new(),
            RowKind::Violin(_, _, quantiles) => {
                // The middle of a distribution is seen before its ends are.
                let rooms = [(1, BOXES), (2, MEDIANS), (3, BOXES)];
                data.soft.extend(rooms.map(|(place, room)| (quantiles[place], room)));
                vec![quantiles[0], quantiles[4]]
            }
        };
        match self.soft {
            true => data.soft.extend(ends.into_iter().map(|end| (end, INTERVALS))),
            false => data.add(ends),
        }
    }
}

/// Share of the range of usual distributions by which the median of another may widen an axis, and its quartiles.
const MEDIANS: f64 = 4.0;
const BOXES: f64 = 4.0;

/// All rows over one axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RowsColumn {
    /// The axis.
    pub x: Ruler,
    /// What stands in every row.
    pub rows: Vec<Vec<RowItem>>,
    /// Whether the axis holds zero, with a line there.
    pub zero: bool,
    /// Share of the axis that is left free at its right end, for numbers.
    pub room: f64,
    /// A value to compare with.
    pub reference: Option<Reference95>,
    /// Values that all rows are held against, with their names in the key.
    pub lines: Vec<(String, Pen, f64)>,
    /// Values that the axis reaches whatever else there is.
    pub reached: Vec<f64>,
}

/// What [`super::Plot::Rows`] draws.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NamedRows {
    /// Title above the figure.
    pub title: Option<String>,
    /// What the names are, beside them; nothing where they say it themselves.
    pub of: String,
    /// Names from top to bottom.
    pub names: Vec<String>,
    /// The columns, side by side.
    pub columns: Vec<RowsColumn>,
    /// A remark under the figure.
    pub note: Option<String>,
}

fn bar_stroke(look: &Look, theme: &Theme) -> Stroke {
    let opacity = if look.hollow || look.colour == RECORD { 0.45 } else { 1.0 };
    Stroke { opacity, ..Stroke::solid(look.colour, 0.9 * theme.tick_font) }
}

/// Thinner than a mark, which is seen on it.
fn limit_stroke(theme: &Theme) -> Stroke {
    Stroke::solid(INK, theme.line)
}

/// Pale, so that the marks on it can be seen, and higher than a mark, so that a narrow one is seen too.
fn thick_stroke(theme: &Theme) -> Stroke {
    Stroke { opacity: 0.55, ..Stroke::solid(HEADING, 2.9 * theme.marker) }
}

/// Rows that may stand twice below each other.
const FEW: usize = 8;

/// Draws the columns side by side, in a narrow figure above each other, or two by two where they have many rows. What
/// reaches beyond an axis is cut and marked.
pub(super) fn rows(data: &NamedRows, theme: &Theme) -> Drawing {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
    let items = || data.columns.iter().flat_map(|column| &column.rows);
    let lines = data.names.iter().map(|name| wrap(name, theme.tick_font, false, NAMES * theme.width).len());
    let stacked = items().map(|row| row.iter().filter(|item| item.is_stacked()).count()).max().unwrap_or(0);
    let is_wide = items().flatten().any(|item| matches!(item.kind, RowKind::Violin(..)));
    let heights = [0.95 + 1.15 * lines.max().unwrap_or(1).max(1) as f64, 0.62 * stacked as f64 + 1.1];
    let pitch = heights[0].max(heights[1]).max(if is_wide { 2.6 } else { 0.0 }) * theme.tick_font;
    let height = (data.names.len().max(1) as f64 + 0.2) * pitch;
    let row = (AxisSide::new(PlotAxis::names(data.names.clone()), data.of.clone()), height);
    let sides: Vec<AxisSide> =
        data.columns.iter().map(|column| AxisSide::new(axis(column), column.x.title.clone())).collect();
    let across = match theme.is_narrow() {
        true if data.names.len() <= FEW => 1,
        true => 2,
        false => sides.len().max(1),
    };
    let panels: Vec<Panel> =
        sides.chunks(across).flat_map(|part| sheet.grid(Grid::new(part.to_vec(), vec![row.clone()]))).collect();
    let mut beyond = false;
    for (panel, column) in panels.iter().zip(&data.columns) {
        beyond |= draw(panel, &mut sheet.scene, theme, (column, pitch));
    }
    let is_said = data.note.as_ref().is_some_and(|note| note.contains("Arrows"));
    let arrows = (beyond && !is_said).then_some("Arrows: beyond the axis.");
    let note: Vec<&str> = data.note.as_deref().into_iter().chain(arrows).collect();
    if !note.is_empty() {
        sheet.note(&note.join(" "));
    }
    sheet.finish()
}

fn entries(data: &NamedRows, theme: &Theme) -> Vec<KeyEntry> {
    let lines = data.columns.iter().flat_map(|column| &column.lines);
    let lines = lines.map(|(name, pen, _)| KeyEntry::new(KeySample::Line(pen.stroke(theme)), name.clone()));
    let items = data.columns.iter().flat_map(|column| &column.rows).flatten();
    let items = items.filter_map(|item| Some(KeyEntry::new(item.sample(theme), item.name.clone()?)));
    let mut entries: Vec<KeyEntry> = Vec::new();
    for entry in lines.chain(items) {
        if entries.iter().all(|known| known.label != entry.label) {
            entries.push(entry);
        }
    }
    entries
}

fn axis(column: &RowsColumn) -> PlotAxis {
    let mut data = Extents::default();
    column.rows.iter().flatten().for_each(|item| item.enter(&mut data));
    data.fixed.extend(column.lines.iter().map(|(.., value)| *value).chain(column.reached.iter().copied()));
    // Numbers stand beyond all that is drawn.
    let kept = if column.room > 0.0 { std::mem::take(&mut data.soft) } else { Vec::new() };
    data.fixed.extend(kept.iter().map(|(value, _)| *value));
    data.fixed.extend(column.reference.iter().flat_map(|own| [own.value, own.band[0], own.band[1]]));
    let (axis, _) = column.x.axis(&data, 0.06);
    if !column.zero {
        return axis;
    }
    // The axis ends at zero where everything lies on one side of it.
    let (lo, hi) = data.ends(column.x.reach).0.map_or((0.0, 1.0), |(lo, hi)| (lo.min(0.0), hi.max(0.0)));
    let pad = 0.05 * (hi - lo);
    let (lo, hi) = (if lo < 0.0 { lo - pad } else { lo }, if hi > 0.0 { hi + pad } else { hi });
    let steps = crate::ticks::TickSteps::Decimal;
    if lo == hi {
        return PlotAxis::linear(lo, 1.0, steps);
    }
    PlotAxis::linear(lo, hi + column.room * (hi - lo), steps).told_until(hi)
}

/// Draws the rows of a column; tells whether something lies beyond its axis.
fn draw(panel: &Panel, scene: &mut Canvas, theme: &Theme, (column, pitch): (&RowsColumn, f64)) -> bool {
    if column.zero {
        zero_upright(panel, scene, theme);
    }
    for (_, pen, value) in &column.lines {
        panel.vertical(scene, Layer::Data, *value, pen.stroke(theme));
    }
    let mut beyond = false;
    let is_estimate = |item: &RowItem| matches!(item.kind, RowKind::Mark(..) | RowKind::Violin(..) | RowKind::Heading);
    let is_estimated = column.rows.iter().flatten().all(is_estimate);
    for (row, items) in column.rows.iter().enumerate() {
        let Some(middle) = panel.up(row as f64) else { continue };
        let stacked = items.iter().filter(|item| item.is_stacked()).count();
        // A ground under every other row keeps several marks of a row together.
        if stacked > 1 && !row.is_multiple_of(2) {
            let ([left, right], [top, bottom]) =
                ([panel.rect.x, panel.rect.right()], [-0.5, 0.5].map(|s| middle + s * pitch));
            scene.fill(Layer::Grid, [(left, top), (right, top), (right, bottom), (left, bottom)], GRID, 0.45);
        }
        let mut line = -0.5 * (stacked + 1) as f64;
        for item in items {
            line += if item.is_stacked() { 1.0 } else { 0.0 };
            let aside = match item.place {
                RowPlace::Aside(share) => share * pitch,
                RowPlace::Below | RowPlace::Beside => line * 0.62 * theme.tick_font,
            };
            beyond |= draw_item(panel, scene, theme, (item, middle + aside, pitch), stacked < 2);
        }
        if is_estimated && !items.iter().any(RowItem::is_value) {
            let text = TextLine::new("no estimate", theme.small_font).anchor(Anchor::Middle).colour(RECORD);
            let place = (panel.rect.x + panel.rect.w / 2.0, middle + text.centring());
            scene.text_on_ground(Layer::Note, place, text);
        }
    }
    // Over the ground of the rows.
    if let Some(reference) = &column.reference {
        reference.vertical(panel, scene, theme);
    }
    beyond
}

/// Draws an item at its height; tells whether it lies beyond the axis.
fn draw_item(
    panel: &Panel,
    scene: &mut Canvas,
    theme: &Theme,
    (item, y, pitch): (&RowItem, f64, f64),
    is_alone: bool,
) -> bool {
    let head = 0.6 * theme.small_font;
    if let Some(words) = &item.text {
        let text = TextLine::new(words.as_str(), theme.small_font).anchor(Anchor::End);
        let place = (panel.rect.right() - 0.4 * theme.small_font, y + text.centring());
        scene.text_on_ground(Layer::Note, place, text);
    }
    match &item.kind {
        RowKind::Mark(look, value, interval) => {
            let stroke = Stroke::solid(look.colour, theme.line);
            let mut beyond = false;
            if let Some(ends) = interval {
                let cap = 0.9 * theme.marker;
                // Ends behind the mark itself would give it another shape.
                let middle = panel.across(*value);
                let is_apart = |x: &f64| middle.is_none_or(|middle| (x - middle).abs() > 1.1 * theme.marker);
                let inside = |x: &f64| panel.rect.contains((*x, y)) && is_apart(x);
                for x in ends.iter().filter_map(|end| panel.across(*end)).filter(inside).filter(|_| is_alone) {
                    scene.line(Layer::Data, [(x, y - cap), (x, y + cap)], stroke);
                }
                beyond = panel.bar(scene, y, *ends, stroke, head);
            }
            mark(panel, scene, theme, (look, *value, y), is_alone) || beyond
        }
        RowKind::Thin(ends) => panel.bar(scene, y, *ends, Stroke::solid(HEADING, theme.line), head),
        RowKind::Thick(ends) => panel.bar(scene, y, *ends, thick_stroke(theme), head),
        RowKind::Bar(look, value) => panel.bar(scene, y, [0.0, *value], bar_stroke(look, theme), head),
        RowKind::Limit(value) => {
            if let Some(x) = panel.across(*value).filter(|x| panel.rect.contains((*x, y))) {
                let half = 0.42 * pitch;
                scene.line(Layer::Data, [(x, y - half), (x, y + half)], limit_stroke(theme));
            }
            false
        }
        RowKind::Heading => false,
        RowKind::Violin(look, density, quantiles) => {
            violin(panel, scene, theme, (look, density, quantiles), (y, pitch))
        }
    }
}

/// A mark, or an arrow with its number where it lies beyond the axis; tells whether it does.
fn mark(panel: &Panel, scene: &mut Canvas, theme: &Theme, (look, value, y): (&Look, f64, f64), is_alone: bool) -> bool {
    let Rect { x: left, .. } = panel.rect;
    let x = panel.across(value.clamp(-f64::MAX, f64::MAX)).filter(|x| !x.is_nan());
    let Some(x) = x else { return false };
    if panel.rect.contains((x, y)) {
        scene.marker(Layer::Data, (x, y), theme.marker, look);
        return false;
    }
    let (edge, direction) = if x > left { (panel.rect.right(), 1.0) } else { (left, -1.0) };
    let size = 0.65 * theme.small_font;
    let tip = edge - direction * 0.2 * theme.small_font;
    Dimensions::head(scene, (tip, y), (direction, 0.0), size, look.colour);
    if is_alone && value.abs() < f64::MAX {
        let label = TextLine::new(significant(value, 3), theme.small_font);
        let place = (tip - direction * 1.3 * size, y + label.centring());
        let anchor = if direction > 0.0 { Anchor::End } else { Anchor::Start };
        scene.text_on_ground(Layer::Note, place, label.anchor(anchor));
    }
    true
}

/// Half the height of a violin, as a share of its row.
const HALF: f64 = 0.42;

/// Density, box of the quartiles, whiskers and median, the ends of the whiskers as numbers beside what is too narrow to
/// be seen; tells whether it reaches beyond the axis.
fn violin(
    panel: &Panel,
    scene: &mut Canvas,
    theme: &Theme,
    (look, density, q): (&Look, &[(f64, f64)], &[f64; 5]),
    (y, pitch): (f64, f64),
) -> bool {
    let rect = panel.rect;
    let places: Option<Vec<f64>> = q.iter().map(|value| panel.across(*value)).collect();
    let Some(places) = places else { return false };
    let inside = |x: f64| x.clamp(rect.x, rect.right());
    let highest = density.iter().map(|(_, height)| *height).fold(0.0, f64::max);
    let edge = |side: f64| -> Vec<PagePoint> {
        let place = |&(value, height): &(f64, f64)| {
            let x = panel.across(value).filter(|x| *x >= rect.x && *x <= rect.right())?;
            Some((x, y + side * HALF * pitch * height / highest))
        };
        density.iter().filter_map(place).collect()
    };
    if highest > 0.0 {
        let outline = [edge(-1.0), edge(1.0).into_iter().rev().collect()].concat();
        scene.fill(Layer::Data, outline, look.colour, 0.28);
    }
    let beyond = panel.bar(scene, y, [q[0], q[4]], Stroke::solid(look.colour, theme.line), 0.6 * theme.small_font);
    let (left, right, half) = (inside(places[1]), inside(places[3]), 0.13 * pitch);
    let corners = [(left, y - half), (right, y - half), (right, y + half), (left, y + half)];
    scene.fill(Layer::Data, corners, look.colour, 0.85);
    if rect.contains((places[2], y)) {
        if places[4] - places[0] < 2.0 * theme.marker {
            let ends = format!("{} to {}", significant(q[0], 2), significant(q[4], 2));
            let text = TextLine::new(ends, theme.small_font);
            let apart = 1.6 * theme.marker;
            let (anchor, x) = match places[2] + apart + text.width() < rect.right() {
                true => (Anchor::Start, places[2] + apart),
                false => (Anchor::End, places[2] - apart),
            };
            let place = (x, y + text.centring());
            scene.text_on_ground(Layer::Note, place, text.anchor(anchor));
        }
        scene.disc(Layer::Data, (places[2], y), 0.55 * theme.marker + 0.4 * theme.thin, INK, 1.0);
        scene.disc(Layer::Data, (places[2], y), 0.55 * theme.marker, PAPER, 1.0);
    }
    beyond
}
