//! Named rows below each other over one or several axes: marks with intervals, bars from zero, limits, distributions.

use plotters::style::text_anchor::HPos;
use plotters::style::{Color as _, RGBColor};

use super::panels::{Pen, Ruler};
use super::reach::{Extents, INTERVALS};
use super::shared::{Reference95, zero_stroke};
use crate::axis::{Axis, Division};
use crate::backend::Plotted;
use crate::canvas::{Stroke, TextLine};
use crate::chart::{Bar, Chart};
use crate::figure::Drawing;
use crate::fonts::LINE;
use crate::key::{KeyEntry, KeySample};
use crate::lines::wrap;
use crate::number::significant;
use crate::palette::{CurveOrigin, GRID, HEADING, INK, Look, RECORD};
use crate::sheet::{AxisSide, Grid, NAMES, Sheet};
use crate::theme::Theme;

/// Content of a row.
#[derive(Debug, Clone, PartialEq)]
pub enum RowKind {
    /// Mark at a value, and its interval as a bar with caps. An infinite value is an arrow at the edge.
    Mark(Look, f64, Option<[f64; 2]>),
    /// Thin interval.
    Thin([f64; 2]),
    /// Range in a pale colour.
    Range(RGBColor, [f64; 2]),
    /// Bar from zero.
    Bar(Look, f64),
    /// Line from the bottom to the top of the row.
    Limit(f64),
    /// No value: the name of the row is a heading of the rows below it.
    Heading,
    /// Distribution: value and density, ascending; its quantiles 2.5, 25, 50, 75 and 97.5 %.
    Violin(Look, Vec<(f64, f64)>, [f64; 5]),
}

/// Place of an item in its row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RowPlace {
    /// Distance below the middle, as a share of the pitch of the rows.
    Aside(f64),
    /// On a separate line below the items before it.
    Below,
    /// On the line of the item before it.
    Beside,
}

/// One item of a row.
#[derive(Debug, Clone, PartialEq)]
pub struct RowItem {
    /// Name in the key; items of one name are listed once.
    pub name: Option<String>,
    /// Kind of the item.
    pub kind: RowKind,
    /// Place of the item in its row.
    pub place: RowPlace,
    /// `true` if the item may be cut when it leaves the range of all other data by more than that range.
    pub soft: bool,
    /// Number written at the right end of the row.
    pub text: Option<String>,
    /// Number written next to a mark.
    pub number: Option<String>,
}

impl RowItem {
    /// Item in the middle of its row that sets the axis.
    pub fn new(name: impl Into<String>, kind: RowKind) -> Self {
        let name = Some(name.into()).filter(|name| !name.is_empty());
        Self { name, kind, place: RowPlace::Aside(0.0), soft: false, text: None, number: None }
    }

    /// Row that is a heading.
    pub fn heading() -> Vec<Self> {
        vec![Self::new("", RowKind::Heading)]
    }

    /// Mark on a line below the items before it in its row.
    pub fn below(name: impl Into<String>, look: Look, value: f64, interval: Option<[f64; 2]>) -> Self {
        Self { place: RowPlace::Below, ..Self::new(name, RowKind::Mark(look, value, interval)) }
    }

    /// The item, cut if it is far from all other data.
    pub fn softly(self) -> Self {
        Self { soft: true, ..self }
    }

    /// `true` if the item is a value, and not only an interval of one; a heading needs none.
    fn is_value(&self) -> bool {
        match self.kind {
            RowKind::Mark(_, value, _) | RowKind::Bar(_, value) => !value.is_nan(),
            RowKind::Limit(_) | RowKind::Thin(_) | RowKind::Range(..) => false,
            RowKind::Violin(..) | RowKind::Heading => true,
        }
    }

    fn sample(&self, theme: &Theme) -> KeySample {
        match &self.kind {
            RowKind::Mark(look, ..) | RowKind::Violin(look, ..) => KeySample::Marker(*look),
            RowKind::Bar(look, _) => KeySample::Line(bar_stroke(look, theme)),
            RowKind::Thin(_) => KeySample::Line(Stroke::solid(HEADING, theme.line)),
            RowKind::Range(colour, _) => KeySample::Line(range_stroke(*colour, theme)),
            RowKind::Limit(_) => KeySample::Upright(limit_stroke(theme)),
            RowKind::Heading => KeySample::Nothing,
        }
    }

    /// Adds the values of the item to the extents of an axis.
    fn enter(&self, data: &mut Extents) {
        let ends: Vec<f64> = match &self.kind {
            RowKind::Mark(_, value, interval) => {
                data.soft.extend(interval.iter().flatten().map(|end| (*end, INTERVALS)));
                vec![*value]
            }
            RowKind::Thin(ends) | RowKind::Range(_, ends) => ends.to_vec(),
            RowKind::Bar(_, value) => vec![0.0, *value],
            RowKind::Limit(value) => vec![*value],
            RowKind::Heading => Vec::new(),
            RowKind::Violin(_, _, quantiles) => {
                // The middle of a distribution has priority over its ends.
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

/// Maximum share of the range of usual distributions by which the median of another may widen an axis, and its
/// quartiles.
const MEDIANS: f64 = 4.0;
const BOXES: f64 = 4.0;

/// All rows over one axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RowsColumn {
    /// The axis.
    pub x: Ruler,
    /// Items of every row.
    pub rows: Vec<Vec<RowItem>>,
    /// `true` if the axis includes zero, with a line there.
    pub zero: bool,
    /// Share of the axis that is free at its right end, for numbers.
    pub room: f64,
    /// Reference value.
    pub reference: Option<Reference95>,
    /// Reference values of all rows, with their names in the key.
    pub lines: Vec<(String, Pen, f64)>,
    /// Values that the axis always includes.
    pub reached: Vec<f64>,
}

/// Data of [`super::Plot::Rows`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NamedRows {
    /// Title of the names; empty if the names need none.
    pub of: String,
    /// Names from top to bottom.
    pub names: Vec<String>,
    /// The columns, side by side.
    pub columns: Vec<RowsColumn>,
    /// Rows on a pale ground, and the meaning of that ground.
    pub shaded: Option<(String, Vec<usize>)>,
    /// Remark under the figure.
    pub note: Option<String>,
}

fn bar_stroke(look: &Look, theme: &Theme) -> Stroke {
    let opacity = if look.hollow || look.colour == RECORD { 0.45 } else { 1.0 };
    Stroke { opacity, ..Stroke::solid(look.colour, 0.9 * theme.tick_font) }
}

/// Stroke of a limit, thinner than a mark, which stays visible on it.
fn limit_stroke(theme: &Theme) -> Stroke {
    Stroke::solid(INK, theme.line)
}

/// Stroke of a range: pale, so that marks on it are visible, and higher than a mark, so that a narrow one is visible
/// too.
fn range_stroke(colour: RGBColor, theme: &Theme) -> Stroke {
    Stroke { opacity: 0.4, ..Stroke::solid(colour, 2.9 * theme.marker) }
}

/// Maximum number of rows for columns above each other in a narrow figure.
const FEW: usize = 8;

/// Opacity of the ground of rows.
const GROUND: f64 = 0.1;

/// Minimum and maximum height of all rows of a wide figure, as shares of its width, and maximum factor by which few
/// rows are spread.
const HEIGHT: [f64; 2] = [0.25, 0.6];
const SPREAD: f64 = 1.8;

/// Drawing of the columns side by side; in a narrow figure above each other, or in pairs if they have many rows. Data
/// beyond an axis are cut and marked.
pub(super) fn rows(data: &NamedRows, finding: &str, theme: &Theme) -> Plotted<Drawing> {
    let mut sheet = Sheet::new(theme, finding)?;
    sheet.legend(&entries(data, theme))?;
    let pitch = pitch(data, theme);
    let height = (data.names.len().max(1) as f64 + 0.2) * pitch;
    let row = (AxisSide::new(Axis::rows(&data.names, 0.6), data.of.as_str()), height);
    let across = match theme.is_narrow() {
        true if data.names.len() <= FEW => 1,
        true => 2,
        false => data.columns.len().max(1),
    };
    let mut beyond = false;
    for part in data.columns.chunks(across) {
        let columns = part.iter().map(|column| AxisSide::new(axis(column), column.x.title.as_str())).collect();
        let charts = sheet.grid(Grid { columns, rows: vec![row.clone()], ..Grid::default() })?;
        for (chart, column) in charts.iter().zip(part) {
            for row in data.shaded.iter().flat_map(|(_, rows)| rows).map(|&row| row as f64) {
                let (left, right) = chart.x.ends();
                chart.rectangle([left, right], [row - 0.5, row + 0.5], HEADING.mix(GROUND))?;
            }
            beyond |= draw(chart, theme, column, pitch)?;
        }
    }
    let is_said = data.note.as_ref().is_some_and(|note| note.contains("Arrows"));
    let arrows = (beyond && !is_said).then_some("Arrows: beyond the axis.");
    sheet.note(&data.note.as_deref().into_iter().chain(arrows).collect::<Vec<_>>())?;
    Ok(sheet.finish())
}

/// Distance of the rows, points.
fn pitch(data: &NamedRows, theme: &Theme) -> f64 {
    let items = || data.columns.iter().flat_map(|column| &column.rows);
    let lines = data.names.iter().map(|name| wrap(name, theme.tick_font, false, NAMES * theme.width).len());
    let lines = LINE * lines.max().unwrap_or(1).max(1) as f64;
    let stacked = 0.62 * items().map(|row| stacked(row)).max().unwrap_or(0) as f64 + 1.1;
    let is_high = items().flatten().any(|item| matches!(item.kind, RowKind::Violin(..)));
    let usual = (lines + 0.95).max(stacked).max(if is_high { 2.6 } else { 0.0 }) * theme.tick_font;
    let least = (lines + 0.35).max(stacked - 0.3) * theme.tick_font;
    let [lowest, highest] = HEIGHT.map(|share| share * theme.width / data.names.len().max(1) as f64);
    match theme.is_narrow() {
        true => usual,
        false => usual.min(highest).max(least.min(usual)).max(lowest.min(SPREAD * usual)),
    }
}

/// Number of items below each other.
fn stacked(items: &[RowItem]) -> usize {
    items.iter().filter(|item| item.place == RowPlace::Below).count()
}

fn entries(data: &NamedRows, theme: &Theme) -> Vec<KeyEntry> {
    let lines = data.columns.iter().flat_map(|column| &column.lines);
    let lines = lines.map(|(name, pen, _)| KeyEntry::new(KeySample::Line(pen.stroke(theme)), name));
    let items = data.columns.iter().flat_map(|column| &column.rows).flatten();
    let items = items.filter_map(|item| Some(KeyEntry::new(item.sample(theme), item.name.as_ref()?)));
    let mut entries: Vec<KeyEntry> = Vec::new();
    let ground = Stroke { opacity: GROUND, ..Stroke::solid(HEADING, theme.tick_font) };
    let shaded = data.shaded.iter().map(|(name, _)| KeyEntry::new(KeySample::Line(ground), name));
    for entry in lines.chain(items).chain(shaded) {
        match entries.iter_mut().find(|listed| listed.label == entry.label) {
            // A range belongs to the mark with the same name.
            Some(listed) if matches!(entry.sample, KeySample::Marker(_)) => *listed = entry,
            Some(_) => {}
            None => entries.push(entry),
        }
    }
    entries
}

fn axis(column: &RowsColumn) -> Axis {
    let mut data = Extents::default();
    column.rows.iter().flatten().for_each(|item| item.enter(&mut data));
    data.fixed.extend(column.lines.iter().map(|(.., value)| *value).chain(column.reached.iter().copied()));
    // Numbers are right of all data.
    let kept = if column.room > 0.0 { std::mem::take(&mut data.soft) } else { Vec::new() };
    data.fixed.extend(kept.iter().map(|(value, _)| *value));
    data.fixed.extend(column.reference.iter().flat_map(Reference95::values));
    if !column.zero {
        return column.x.axis(&data, 0.06).0;
    }
    // The axis ends at zero if all data are on one side of it.
    let (lo, hi) = data.ends(column.x.reach).0.map_or((0.0, 1.0), |(lo, hi)| (lo.min(0.0), hi.max(0.0)));
    let pad = 0.05 * (hi - lo);
    let (lo, hi) = (if lo < 0.0 { lo - pad } else { lo }, if hi > 0.0 { hi + pad } else { hi });
    let hi = if lo == hi { 1.0 } else { hi };
    Axis::linear(lo, hi + column.room * (hi - lo), Division::Decimal).labelled_until(hi)
}

/// Draws the rows of a column; returns whether data are beyond its axis.
fn draw(chart: &Chart, theme: &Theme, column: &RowsColumn, pitch: f64) -> Plotted<bool> {
    let (left, right) = chart.x.ends();
    // A ground under every second row groups the marks of a row.
    for (row, _) in column.rows.iter().enumerate().filter(|(row, items)| stacked(items) > 1 && row % 2 == 1) {
        chart.rectangle([left, right], [row as f64 - 0.5, row as f64 + 0.5], GRID.mix(0.45))?;
    }
    if let Some(reference) = &column.reference {
        reference.vertical(chart, theme)?;
    }
    if column.zero {
        chart.vertical(None, 0.0, zero_stroke(theme))?;
    }
    for (name, pen, value) in &column.lines {
        chart.vertical(Some(name), *value, pen.stroke(theme))?;
    }
    let (mut beyond, mut numbered) = (false, Vec::new());
    for (row, items) in column.rows.iter().enumerate() {
        let mut line = -0.5 * (stacked(items) + 1) as f64;
        for item in items {
            line += if item.place == RowPlace::Below { 1.0 } else { 0.0 };
            let aside = match item.place {
                RowPlace::Aside(share) => share,
                RowPlace::Below | RowPlace::Beside => line * 0.62 * theme.tick_font / pitch,
            };
            beyond |= draw_item(chart, theme, item, row as f64 + aside, stacked(items) < 2)?;
            numbered.push((item, row as f64 + aside));
        }
    }
    for (item, y) in numbered {
        number(chart, theme, item, y)?;
    }
    chart.frame(theme)?;
    let is_estimate = |item: &RowItem| matches!(item.kind, RowKind::Mark(..) | RowKind::Violin(..) | RowKind::Heading);
    let is_estimated = column.rows.iter().flatten().all(is_estimate);
    for (row, items) in column.rows.iter().enumerate() {
        let middle = chart.up(row as f64).unwrap_or(f64::NAN);
        for words in items.iter().filter_map(|item| item.text.as_ref()) {
            let place = (chart.rect.right() - 0.4 * theme.small_font, middle);
            chart.canvas.text_on_ground(place, &TextLine::new(words, theme.small_font, HPos::Right))?;
        }
        if is_estimated && !items.iter().any(RowItem::is_value) {
            let text = TextLine { colour: RECORD, ..TextLine::new("no estimate", theme.small_font, HPos::Center) };
            chart.canvas.text_on_ground((chart.rect.x + chart.rect.w / 2.0, middle), &text)?;
        }
    }
    Ok(beyond)
}

/// Draws an item at its height, in rows; returns whether it is beyond the axis.
fn draw_item(chart: &Chart, theme: &Theme, item: &RowItem, y: f64, is_alone: bool) -> Plotted<bool> {
    let name = item.name.as_deref();
    let bar =
        |ends: [f64; 2], is_capped: bool, stroke: Stroke| chart.bar(name, &Bar { y, ends, is_capped, stroke }, theme);
    match &item.kind {
        RowKind::Mark(look, value, interval) => {
            let of_interval = interval.map(|ends| bar(ends, is_alone, Stroke::solid(look.colour, theme.line)));
            let beyond = of_interval.transpose()?.unwrap_or(false);
            Ok(mark(chart, theme, item, *value, y, is_alone)? || beyond)
        }
        RowKind::Thin(ends) => bar(*ends, false, Stroke::solid(HEADING, theme.line)),
        RowKind::Range(colour, ends) => bar(*ends, false, range_stroke(*colour, theme)),
        RowKind::Bar(look, value) => bar([0.0, *value], false, bar_stroke(look, theme)),
        RowKind::Limit(value) => {
            chart.line(name, [(*value, y - HALF), (*value, y + HALF)], limit_stroke(theme)).map(|()| false)
        }
        RowKind::Heading => Ok(false),
        RowKind::Violin(look, density, quantiles) => {
            let beyond = bar([quantiles[0], quantiles[4]], false, Stroke::solid(look.colour, theme.line))?;
            violin(chart, theme, item, y, density, quantiles).map(|()| beyond)
        }
    }
}

/// Draws a mark, or an arrow with its number if it is beyond the axis; returns whether it is beyond.
fn mark(chart: &Chart, theme: &Theme, item: &RowItem, value: f64, y: f64, is_alone: bool) -> Plotted<bool> {
    let RowKind::Mark(look, ..) = &item.kind else { return Ok(false) };
    let place = chart.reach(value.clamp(-f64::MAX, f64::MAX), y);
    let Some((x, height)) = place.filter(|place| !chart.rect.contains(*place)) else {
        chart.marker(item.name.as_deref(), value, y, theme.marker, look)?;
        return Ok(false);
    };
    let (edge, side) = if x > chart.rect.x { (chart.rect.right(), 1.0) } else { (chart.rect.x, -1.0) };
    let size = 0.65 * theme.small_font;
    let tip = edge - side * 0.2 * theme.small_font;
    chart.canvas.head((tip, height), (side, 0.0), size, look.colour)?;
    if is_alone && !item.soft && value.abs() < f64::MAX {
        let anchor = if side > 0.0 { HPos::Right } else { HPos::Left };
        let label = TextLine::new(significant(value, 3), theme.small_font, anchor);
        chart.canvas.text_on_ground((tip - side * 1.3 * size, height), &label)?;
    }
    Ok(true)
}

/// Number of an item, to the right of its mark and of its interval, inside the frame.
fn number(chart: &Chart, theme: &Theme, item: &RowItem, y: f64) -> Plotted {
    let end = match &item.kind {
        RowKind::Mark(_, value, interval) => interval.map_or(*value, |[_, end]| end.max(*value)),
        RowKind::Violin(_, _, quantiles) => quantiles[4],
        _ => return Ok(()),
    };
    let Some((text, (x, height))) = item.number.as_ref().zip(chart.reach(end.min(f64::MAX), y)) else { return Ok(()) };
    let text = TextLine::new(text, theme.small_font, HPos::Left);
    let x = (x + 1.6 * theme.marker).min(chart.rect.right() - text.width() - theme.marker);
    chart.canvas.text_on_ground((x, height), &text)
}

/// Half height of a violin and of a limit, in rows.
const HALF: f64 = 0.42;

/// Draws density, box of the quartiles and median, with the ends of the 95 % interval as numbers next to a violin that
/// is too narrow to be seen.
fn violin(chart: &Chart, theme: &Theme, item: &RowItem, y: f64, density: &[(f64, f64)], q: &[f64; 5]) -> Plotted {
    let RowKind::Violin(look, ..) = &item.kind else { return Ok(()) };
    let name = item.name.as_deref();
    let highest = density.iter().map(|(_, height)| *height).fold(0.0, f64::max);
    let drawn = || density.iter().filter(|(value, height)| chart.x.has_place(*value) && height.is_finite());
    let edge = |side: f64| drawn().map(move |(value, height)| (*value, y + side * HALF * height / highest));
    if highest > 0.0 {
        let outline: Vec<(f64, f64)> = edge(-1.0).chain(edge(1.0).collect::<Vec<_>>().into_iter().rev()).collect();
        chart.area(name, outline, look.colour.mix(0.28))?;
    }
    chart.rectangle([q[1], q[3]], [y - 0.13, y + 0.13], look.colour.mix(0.85))?;
    let Some((middle, height)) = chart.inside(q[2], y) else { return Ok(()) };
    let apart = 1.6 * theme.marker;
    if chart.across(q[4]).zip(chart.across(q[0])).is_some_and(|(hi, lo)| hi - lo < 2.0 * theme.marker) {
        let ends = format!("{} to {}", significant(q[0], 2), significant(q[4], 2));
        let text = TextLine::new(ends, theme.small_font, HPos::Left);
        let [left, right] = [middle - apart - text.width(), middle + apart + text.width()];
        if right < chart.rect.right() {
            chart.canvas.text_on_ground((middle + apart, height), &text)?;
        } else if left > chart.rect.x {
            chart.canvas.text_on_ground((middle - apart, height), &TextLine { anchor: HPos::Right, ..text })?;
        }
    }
    let median = Look { hollow: true, ..CurveOrigin::Truth.look() };
    chart.marker(None, q[2], y, 0.6 * theme.marker, &median)
}
