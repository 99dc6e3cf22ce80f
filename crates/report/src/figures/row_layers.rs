//! Drawing of [`NamedRows`]: rows over their axes, with their numbers at the right end.

use plotters::style::text_anchor::HPos;
use plotters::style::{Color as _, RGBColor};

use super::extents::{Extents, MAX_INTERVAL_SHARE};
use super::piles::{PlacedItem, is_single, spread};
use super::rows::{NamedRows, RowItem, RowKind, RowPlace, RowsColumn};
use super::shared::{BEYOND_AXIS_REMARK, Bars, ReferenceBand95, zero_stroke};
use crate::axis::{Axis, TickRule};
use crate::backend::PlotResult;
use crate::canvas::{PagePoint, Stroke, TextLine, marker, page_units};
use crate::chart::{Bar, Chart};
use crate::drawing::Drawing;
use crate::fonts::{LINE_SPACING, text_width};
use crate::legend::{LegendEntry, LegendSymbol};
use crate::lines::wrap;
use crate::number::significant;
use crate::palette::{BACKGROUND, CurveOrigin, CurveStyle, GRID, HEADING, INK, RECORD};
use crate::sheet::{Grid, MAX_NAMES_SHARE, Sheet, TitledAxis};
use crate::theme::Theme;

impl RowItem {
    fn sample(&self, theme: &Theme) -> LegendSymbol {
        match &self.kind {
            RowKind::Mark(style, ..) | RowKind::Violin(style, ..) => LegendSymbol::Marker(*style),
            RowKind::Bar(style, _) => LegendSymbol::Line(bar_stroke(style, theme)),
            RowKind::ThinInterval(_) => LegendSymbol::Line(Stroke::solid(HEADING, theme.line)),
            RowKind::WideInterval(colour, _) => LegendSymbol::Line(range_stroke(*colour, theme)),
            RowKind::Limit(_) => LegendSymbol::Upright(limit_stroke(theme)),
            RowKind::Heading => LegendSymbol::Nothing,
        }
    }

    /// Adds the values of the item to the extents of an axis.
    fn enter(&self, data: &mut Extents) {
        let ends: Vec<f64> = match &self.kind {
            RowKind::Mark(_, value, interval) => {
                data.clippable_values.extend(interval.iter().flatten().map(|end| (*end, MAX_INTERVAL_SHARE)));
                vec![*value]
            }
            RowKind::ThinInterval(ends) | RowKind::WideInterval(_, ends) => ends.to_vec(),
            RowKind::Bar(_, value) => vec![0.0, *value],
            RowKind::Limit(value) => vec![*value],
            RowKind::Heading => Vec::new(),
            RowKind::Violin(_, _, quantiles) => {
                // The middle of a distribution has priority over its ends.
                data.clippable_values.extend([1, 2, 3].map(|place| (quantiles[place], BOXES)));
                vec![quantiles[0], quantiles[4]]
            }
        };
        match self.may_be_clipped {
            true => data.clippable_values.extend(ends.into_iter().map(|end| (end, MAX_INTERVAL_SHARE))),
            false => data.add(ends),
        }
    }
}

/// Maximum multiple of the range of all other data by which the quartiles of a distribution may widen an axis.
const BOXES: f64 = 4.0;

fn bar_stroke(style: &CurveStyle, theme: &Theme) -> Stroke {
    let opacity = if style.is_hollow || style.colour == RECORD { 0.45 } else { 1.0 };
    Stroke { opacity, ..Stroke::solid(style.colour, 0.9 * theme.tick_font) }
}

/// Stroke of a limit, thinner than a mark, which stays visible on it.
fn limit_stroke(theme: &Theme) -> Stroke {
    Stroke::solid(INK, theme.line)
}

/// Stroke of a range: pale, so that marks on it are visible, and higher than a mark, so that a narrow one is visible
/// too.
fn range_stroke(colour: RGBColor, theme: &Theme) -> Stroke {
    Stroke { opacity: 0.25, ..Stroke::solid(colour, RANGE_HEIGHT * theme.marker) }
}

/// Height of a range, in sizes of a mark.
const RANGE_HEIGHT: f64 = 2.9;

/// Maximum number of rows for columns above each other in a narrow figure.
const FEW: usize = 8;

/// Margins about a panel, in font sizes of axis titles.
const MARGINS: f64 = 2.0;

/// Maximum share of an axis that is left free for numbers.
const MAX_ROOM: f64 = 0.5;

/// Opacity of the background of shaded rows.
const GROUND: f64 = 0.1;

/// Minimum and maximum height of all rows of a wide figure, as shares of its width.
const HEIGHT: [f64; 2] = [0.25, 0.6];

/// Maximum factor by which few rows are spread.
const SPREAD: f64 = 1.8;

/// Drawing of the columns side by side; in a narrow figure above each other, or in pairs if they have many rows. Data
/// beyond an axis are cut and marked.
pub(super) fn rows(data: &NamedRows, finding: &str, theme: &Theme) -> PlotResult<Drawing> {
    let mut sheet = Sheet::new(theme, finding)?;
    sheet.legend(&entries(data, theme))?;
    let line_distance = line_distance(data, theme);
    let pitch = pitch(data, theme, line_distance);
    let height = (data.names.len().max(1) as f64 + 0.2) * pitch;
    let row = (TitledAxis::new(Axis::rows(&data.names, 0.6), data.names_title.as_str()), height);
    let across = match theme.is_narrow() {
        true if data.names.len() <= FEW => 1,
        true => 2,
        false => data.columns.len().max(1),
    };
    let widths = data.names.iter().map(|name| text_width(name, theme.tick_font, false));
    let margin = widths.fold(0.0, f64::max).min(MAX_NAMES_SHARE * theme.width) + MARGINS * theme.label_font;
    let panel = (theme.width - margin) / across as f64 - MARGINS * theme.label_font;
    let (mut beyond, mut bars) = (false, Bars::default());
    for part in data.columns.chunks(across) {
        let side = |column| TitledAxis::new(axis(column, theme, panel), column.x.title.as_str());
        let columns = part.iter().map(side).collect();
        let charts = sheet.grid(Grid { columns, rows: vec![row.clone()], ..Grid::default() })?;
        for (chart, column) in charts.iter().zip(part) {
            for row in data.shaded_rows.iter().flat_map(|(_, rows)| rows).map(|&row| row as f64) {
                let (left, right) = chart.x.ends();
                chart.rectangle([left, right], [row - 0.5, row + 0.5], HEADING.mix(GROUND))?;
            }
            beyond |= draw(chart, theme, column, pitch, line_distance)?;
            let lengths = column.rows.iter().flatten().filter_map(|item| bar_length(chart, item));
            lengths.for_each(|length| bars.add(length, theme));
        }
    }
    let arrows = beyond.then(|| data.overflow_note.clone().unwrap_or_else(|| BEYOND_AXIS_REMARK.to_owned()));
    sheet.note(&[data.note.clone(), bars.remark(), arrows].into_iter().flatten().collect::<Vec<_>>())?;
    Ok(sheet.finish())
}

/// Length in points of the interval of a mark; `None` without an interval on the scale.
fn bar_length(chart: &Chart, item: &RowItem) -> Option<f64> {
    let RowKind::Mark(_, _, Some(ends)) = item.kind else { return None };
    let [left, right] = ends.map(|end| chart.page_x(end.clamp(-f64::MAX, f64::MAX)));
    Some(right? - left?)
}

/// Distance of the rows, points, whose lines are `line_distance` points apart.
fn pitch(data: &NamedRows, theme: &Theme, line_distance: f64) -> f64 {
    let items = || data.columns.iter().flat_map(|column| &column.rows);
    let lines = data.names.iter().map(|name| wrap(name, theme.tick_font, false, MAX_NAMES_SHARE * theme.width).len());
    let lines = LINE_SPACING * lines.max().unwrap_or(1).max(1) as f64;
    let line = line_distance / theme.tick_font;
    let stacked = line * items().map(|row| stacked(row)).max().unwrap_or(0) as f64 + 1.1;
    let is_high = items().flatten().any(|item| matches!(item.kind, RowKind::Violin(..)));
    let usual = (lines + 0.95).max(stacked).max(if is_high { 2.6 } else { 0.0 }) * theme.tick_font;
    let least = (lines + 0.35).max(stacked - 0.3) * theme.tick_font;
    let [lowest, highest] = HEIGHT.map(|share| share * theme.width / data.names.len().max(1) as f64);
    match theme.is_narrow() {
        true => usual,
        false => usual.min(highest).max(least.min(usual)).max(lowest.min(SPREAD * usual)),
    }
}

/// Distance of two lines of a row, points; larger if single marks have to be spread, or if ranges would overlap.
fn line_distance(data: &NamedRows, theme: &Theme) -> f64 {
    let is_spread = |item: &RowItem| item.place == RowPlace::SameLine && is_single(item);
    let is_range = |item: &RowItem| item.place == RowPlace::Below && matches!(item.kind, RowKind::WideInterval(..));
    let rows = || data.columns.iter().flat_map(|column| &column.rows);
    let has_singles = rows().any(|row| row.windows(2).any(|pair| pair.iter().all(is_spread)));
    let has_ranges = rows().any(|row| row.iter().filter(|item| is_range(item)).count() > 1);
    let usual = theme.tick_font * if has_singles { 1.3 } else { 0.62 };
    usual.max(if has_ranges { 1.1 * RANGE_HEIGHT * theme.marker } else { 0.0 })
}

/// Number of items of a row that are on separate lines below each other.
fn stacked(items: &[RowItem]) -> usize {
    items.iter().filter(|item| item.place == RowPlace::Below).count()
}

fn entries(data: &NamedRows, theme: &Theme) -> Vec<LegendEntry> {
    let lines = data.columns.iter().flat_map(|column| &column.vertical_lines);
    let lines = lines.map(|(name, pen, _)| LegendEntry::new(LegendSymbol::Line(pen.stroke(theme)), name));
    let items = data.columns.iter().flat_map(|column| &column.rows).flatten();
    let items = items.filter_map(|item| Some(LegendEntry::new(item.sample(theme), item.name.as_ref()?)));
    let mut entries: Vec<LegendEntry> = Vec::new();
    let ground = Stroke { opacity: GROUND, ..Stroke::solid(HEADING, theme.tick_font) };
    let shaded = data.shaded_rows.iter().map(|(name, _)| LegendEntry::new(LegendSymbol::Line(ground), name));
    for entry in lines.chain(items).chain(shaded) {
        match entries.iter_mut().find(|listed| listed.label == entry.label) {
            // A range belongs to the mark with the same name.
            Some(listed) if matches!(entry.sample, LegendSymbol::Marker(_)) => *listed = entry,
            Some(_) => {}
            None => entries.push(entry),
        }
    }
    entries
}

/// Axis of a column that is about `panel` points wide.
fn axis(column: &RowsColumn, theme: &Theme, panel: f64) -> Axis {
    let mut data = Extents::default();
    column.rows.iter().flatten().for_each(|item| item.enter(&mut data));
    data.fixed
        .extend(column.vertical_lines.iter().map(|(.., value)| *value).chain(column.included_values.iter().copied()));
    // Numbers are right of all data.
    let widest: f64 = number_widths(column, theme).iter().sum();
    let room = (widest / panel).min(MAX_ROOM);
    let kept = if room > 0.0 { std::mem::take(&mut data.clippable_values) } else { Vec::new() };
    data.fixed.extend(kept.iter().map(|(value, _)| *value));
    data.fixed.extend(column.reference.iter().flat_map(ReferenceBand95::values));
    if !column.has_zero_line {
        return column.x.axis(&data, 0.06).0.with_room(room);
    }
    // The axis ends at zero if all data are on one side of it.
    let (lo, hi) = data.ends(column.x.outlier_limit).0.map_or((0.0, 1.0), |(lo, hi)| (lo.min(0.0), hi.max(0.0)));
    let pad = 0.05 * (hi - lo);
    let (lo, hi) = (if lo < 0.0 { lo - pad } else { lo }, if hi > 0.0 { hi + pad } else { hi });
    let hi = if lo == hi { 1.0 } else { hi };
    Axis::linear(lo, hi, TickRule::Decimal).with_room(room)
}

/// Draws the rows of a column, whose lines are `line_distance` points apart; returns whether data are beyond its axis.
fn draw(chart: &Chart, theme: &Theme, column: &RowsColumn, pitch: f64, line_distance: f64) -> PlotResult<bool> {
    let (left, right) = chart.x.ends();
    // A background under every second row groups the marks of a row.
    for (row, _) in column.rows.iter().enumerate().filter(|(row, items)| stacked(items) > 1 && row % 2 == 1) {
        chart.rectangle([left, right], [row as f64 - 0.5, row as f64 + 0.5], GRID.mix(0.45))?;
    }
    if let Some(reference) = &column.reference {
        reference.vertical(chart, theme)?;
    }
    if column.has_zero_line {
        chart.vertical(None, 0.0, zero_stroke(theme))?;
    }
    for (name, pen, value) in &column.vertical_lines {
        chart.vertical(Some(name), *value, pen.stroke(theme))?;
    }
    let mut beyond = false;
    for (row, items) in column.rows.iter().enumerate() {
        let placed = placed_items(chart, theme, items, row as f64, [pitch, line_distance]);
        for item in &placed {
            beyond |= draw_item(chart, theme, item, stacked(items) < 2)?;
        }
    }
    let widths = number_widths(column, theme);
    let has_markers = has_several_markers(column);
    let (left, right, bottom) = (chart.data_right(), chart.rect.right(), chart.rect.bottom());
    if left < right {
        let corners = [(left, chart.rect.y), (right, chart.rect.y), (right, bottom), (left, bottom)];
        chart.canvas.fill(&corners, BACKGROUND, 1.0)?;
        chart.canvas.line(&[corners[0], corners[3]], Stroke::solid(GRID, theme.thin))?;
    }
    for (row, items) in column.rows.iter().enumerate() {
        let mut right = chart.rect.right() - 0.4 * theme.small_font;
        let y = chart.page_y(row as f64).unwrap_or(f64::NAN);
        for ((number, style), width) in numbers(items, theme).iter().rev().zip(widths.iter().rev()) {
            chart.canvas.text_with_halo((right, y), number)?;
            right -= width;
            if let Some(style) = style.filter(|_| has_markers) {
                let place = page_units((right + theme.small_font, y));
                chart.canvas.draw_elements(marker(place, 0.8 * theme.marker, style))?;
            }
        }
    }
    chart.frame(theme)?;
    let is_estimate = |item: &RowItem| matches!(item.kind, RowKind::Mark(..) | RowKind::Violin(..) | RowKind::Heading);
    let is_estimated = column.rows.iter().flatten().all(is_estimate);
    for (row, items) in column.rows.iter().enumerate() {
        let middle = chart.page_y(row as f64).unwrap_or(f64::NAN);
        if is_estimated && !items.iter().any(RowItem::is_value) {
            let text = TextLine { colour: RECORD, ..TextLine::new("no estimate", theme.small_font, HPos::Center) };
            chart.canvas.text_with_halo((chart.rect.x + chart.rect.w / 2.0, middle), &text)?;
        }
    }
    Ok(beyond)
}

/// Items of a row at their vertical places; rows are `pitch` and lines `line_distance` points apart.
fn placed_items<'a>(
    chart: &Chart,
    theme: &Theme,
    items: &'a [RowItem],
    row: f64,
    [pitch, line_distance]: [f64; 2],
) -> Vec<PlacedItem<'a>> {
    let mut line = -0.5 * (stacked(items) + 1) as f64;
    let mut placed: Vec<PlacedItem> = Vec::with_capacity(items.len());
    for item in items {
        line += if item.place == RowPlace::Below { 1.0 } else { 0.0 };
        let shift = match item.place {
            RowPlace::Shifted(share) => share,
            RowPlace::Below | RowPlace::SameLine => line * line_distance / pitch,
        };
        placed.push(PlacedItem { item, y: row + shift, radius: theme.marker });
    }
    let room = if stacked(items) > 1 { 0.5 * line_distance } else { HALF * pitch };
    spread(&mut placed, chart, theme, room, pitch);
    placed
}

/// Draws an item; returns whether it is beyond the axis.
fn draw_item(chart: &Chart, theme: &Theme, placed: &PlacedItem, is_alone: bool) -> PlotResult<bool> {
    let &PlacedItem { item, y, .. } = placed;
    let name = item.name.as_deref();
    let bar =
        |ends: [f64; 2], is_capped: bool, stroke: Stroke| chart.bar(name, &Bar { y, ends, is_capped, stroke }, theme);
    match &item.kind {
        RowKind::Mark(style, value, interval) => {
            let of_interval = interval.map(|ends| bar(ends, is_alone, Stroke::solid(style.colour, theme.line)));
            let beyond = of_interval.transpose()?.unwrap_or(false);
            Ok(mark(chart, theme, placed, *value, is_alone)? || beyond)
        }
        RowKind::ThinInterval(ends) => bar(*ends, false, Stroke::solid(HEADING, theme.line)),
        RowKind::WideInterval(colour, ends) => bar(*ends, false, range_stroke(*colour, theme)),
        RowKind::Bar(style, value) => bar([0.0, *value], false, bar_stroke(style, theme)),
        RowKind::Limit(value) => {
            chart.line(name, [(*value, y - HALF), (*value, y + HALF)], limit_stroke(theme)).map(|()| false)
        }
        RowKind::Heading => Ok(false),
        RowKind::Violin(style, density, quantiles) => {
            let beyond = bar([quantiles[0], quantiles[4]], false, Stroke::solid(style.colour, theme.line))?;
            violin(chart, theme, item, y, density, quantiles).map(|()| beyond)
        }
    }
}

/// Draws a mark; if it is beyond the axis, an arrow instead, with its value if no other item needs the room. Returns
/// whether it is beyond.
fn mark(chart: &Chart, theme: &Theme, placed: &PlacedItem, value: f64, is_alone: bool) -> PlotResult<bool> {
    let &PlacedItem { item, y, radius } = placed;
    let RowKind::Mark(style, ..) = &item.kind else { return Ok(false) };
    let place = chart.unclipped_page_point(value.clamp(-f64::MAX, f64::MAX), y);
    let is_inside = |place: &PagePoint| chart.rect.contains(*place) && place.0 <= chart.data_right() + 0.1;
    let Some((x, height)) = place.filter(|place| !is_inside(place)) else {
        chart.marker(item.name.as_deref(), value, y, radius, style)?;
        return Ok(false);
    };
    let (edge, side) = if x > chart.rect.x { (chart.data_right(), 1.0) } else { (chart.rect.x, -1.0) };
    let size = 0.65 * theme.small_font;
    let tip = edge - side * 0.2 * theme.small_font;
    chart.canvas.arrow_head((tip, height), (side, 0.0), size, style.colour)?;
    if is_alone && !item.may_be_clipped && value.abs() < f64::MAX {
        let anchor = if side > 0.0 { HPos::Right } else { HPos::Left };
        let label = TextLine::new(significant(value, 3), theme.small_font, anchor);
        chart.canvas.text_with_halo((tip - side * 1.3 * size, height), &label)?;
    }
    Ok(true)
}

/// Numbers of a row, each with the style of its mark.
fn numbers<'a>(items: &'a [RowItem], theme: &Theme) -> Vec<(TextLine, Option<&'a CurveStyle>)> {
    let number = |item: &'a RowItem| {
        let style = if let RowKind::Mark(style, ..) = &item.kind { Some(style) } else { None };
        Some((TextLine::new(item.number.as_ref()?, theme.small_font, HPos::Right), style))
    };
    items.iter().filter_map(number).collect()
}

/// `true` if marks of a row differ in shape, so that a number needs its mark.
fn has_several_markers(column: &RowsColumn) -> bool {
    let marker = |item: &RowItem| if let RowKind::Mark(style, ..) = &item.kind { Some(style.marker) } else { None };
    column.rows.iter().any(|row| {
        let mut markers = row.iter().filter_map(marker);
        let first = markers.next();
        markers.any(|other| Some(other) != first)
    })
}

/// Widths of the columns of numbers at the right end of the rows, points; the last number of every row is in the last
/// column. If the marks differ in shape, each number has room for its mark.
fn number_widths(column: &RowsColumn, theme: &Theme) -> Vec<f64> {
    let mut widths: Vec<f64> = Vec::new();
    for items in &column.rows {
        for (place, (number, _)) in numbers(items, theme).iter().rev().enumerate() {
            widths.resize(widths.len().max(place + 1), 0.0);
            widths[place] = widths[place].max(number.width() + theme.small_font);
        }
    }
    widths.reverse();
    let marked = if has_several_markers(column) { theme.small_font } else { 0.0 };
    widths.iter().map(|width| width + marked).collect()
}

/// Writes a text to the right of two ends, or to the left if the frame is too near.
fn beside(chart: &Chart, [left, right]: [f64; 2], height: f64, text: &TextLine) -> PlotResult {
    let last = chart.rect.right() - text.width();
    let to_left = left - text.width();
    let x = if right > last && to_left > chart.rect.x { to_left } else { right.min(last) };
    chart.canvas.text_with_halo((x, height), text)
}

/// Half height of a violin and of a limit, in rows.
const HALF: f64 = 0.42;

/// Draws density, box of the quartiles and median, with the ends of the 95 % interval as numbers next to a violin that
/// is too narrow to be seen.
fn violin(chart: &Chart, theme: &Theme, item: &RowItem, y: f64, density: &[(f64, f64)], q: &[f64; 5]) -> PlotResult {
    let RowKind::Violin(style, ..) = &item.kind else { return Ok(()) };
    let name = item.name.as_deref();
    let highest = density.iter().map(|(_, height)| *height).fold(0.0, f64::max);
    let drawn = || density.iter().filter(|(value, height)| chart.x.is_plottable(*value) && height.is_finite());
    let edge = |side: f64| drawn().map(move |(value, height)| (*value, y + side * HALF * height / highest));
    if highest > 0.0 {
        let outline: Vec<(f64, f64)> = edge(-1.0).chain(edge(1.0).collect::<Vec<_>>().into_iter().rev()).collect();
        chart.area(name, outline, style.colour.mix(0.28))?;
    }
    chart.rectangle([q[1], q[3]], [y - 0.13, y + 0.13], style.colour.mix(0.85))?;
    let Some((middle, height)) = chart.inside(q[2], y) else { return Ok(()) };
    let apart = 1.6 * theme.marker;
    let is_narrow = chart.page_x(q[4]).zip(chart.page_x(q[0])).is_some_and(|(hi, lo)| hi - lo < 2.0 * theme.marker);
    if is_narrow && item.number.is_none() {
        let ends = format!("{} to {}", significant(q[0], 2), significant(q[4], 2));
        let text = TextLine::new(ends, theme.small_font, HPos::Left);
        beside(chart, [middle - apart, middle + apart], height, &text)?;
    }
    let median = CurveStyle { is_hollow: true, ..CurveOrigin::Truth.style() };
    chart.marker(None, q[2], y, 0.6 * theme.marker, &median)
}

#[cfg(test)]
mod tests;
