//! Drawing of [`Panels`]: axes over their layers, the layers, and notes on data outside the axes.

use plotters::element::ErrorBar;
use plotters::style::text_anchor::HPos;
use plotters::style::{Color as _, RGBColor};

use super::extents::{Extents, MAX_INTERVAL_SHARE, robust_range};
use super::panels::{AxisSpec, Layer, LayerKind, LayeredPanel, Marks, PanelGroup, PanelRow, Panels};
use super::shared::{ACROSS_PAD, BEYOND_AXIS_REMARK, Bars, PAD_SHARE, draw_record, spread_overlapping, zero_stroke};
use super::{point_labels, side_labels};
use crate::axis::{Axis, TickRule};
use crate::backend::{PlotResult, SvgGroup, UNITS_PER_POINT, units};
use crate::canvas::{PagePoint, Stroke, TextLine, marker, page_units, ship_outline};
use crate::chart::Chart;
use crate::curve::PlotCurve;
use crate::drawing::Drawing;
use crate::legend::{LegendEntry, LegendSymbol};
use crate::palette::{DASHED, DOTTED, INK, RECORD, SHORT_DASH};
use crate::sheet::{Grid, Sheet, TitledAxis};
use crate::theme::Theme;

/// Data outside a figure, for its notes.
#[derive(Default)]
struct DataOutsideFrame {
    /// `true` if a layer is cut.
    is_cut: bool,
    /// Number of dots beyond the panels of a group: the maximum over the groups.
    dots: usize,
    /// `true` if a mark is beyond a panel.
    marks: bool,
    /// Bars of the marks.
    bars: Bars,
    /// `true` if marks are moved side by side.
    apart: bool,
    /// Names without a place in the frame, with their numbers.
    names: Vec<String>,
}

/// Maximum height of all panels of a wide figure, as a share of its width, and the minimum share of its height that a
/// panel keeps.
const WIDE: [f64; 2] = [0.52, 0.62];

/// Maximum share of the height of a panel that is free below and above its data.
const MAX_ROOM: f64 = 0.6;

/// Maximum number of panels side by side in a narrow figure; a longer row becomes small multiples.
const NARROW: usize = 3;

/// Figure adapted to its page: on a narrow page, many panels side by side become small multiples; on a wide page, the
/// rows of a tall figure are shortened.
fn fitted(data: &Panels, theme: &Theme) -> Panels {
    let mut data = data.clone();
    if theme.is_narrow() {
        data.names_aside = false;
        for group in data.groups.iter_mut().filter(|group| group.multiples_across.is_none() && group.rows.len() == 1) {
            group.multiples_across = (group.x.len() > NARROW).then_some(NARROW);
        }
        return data;
    }
    let height = |group: &PanelGroup| {
        let rows = group.multiples_across.map_or(1, |across| group.panels.len().div_ceil(across.max(1)));
        if group.has_equal_scales { 0.0 } else { group.rows.iter().map(|row| row.height).sum::<f64>() * rows as f64 }
    };
    let all: f64 = side_by_side(&data, theme).map(|groups| groups.iter().map(height).fold(0.0, f64::max)).sum();
    let share = (WIDE[0] / all).clamp(WIDE[1], 1.0);
    data.groups.iter_mut().flat_map(|group| &mut group.rows).for_each(|row| row.height *= share);
    data
}

/// The groups in rows: half-width ones in pairs, unless the figure is narrow.
fn side_by_side<'a>(data: &'a Panels, theme: &Theme) -> impl Iterator<Item = &'a [PanelGroup]> {
    let across = if theme.is_narrow() { 1 } else { 2 };
    let rows = data.groups.chunk_by(|left, right| left.is_half && right.is_half);
    rows.flat_map(move |row| row.chunks(if row[0].is_half { across } else { 1 }))
}

/// Drawing of the groups in reading order.
pub(super) fn panels(data: &Panels, finding: &str, theme: &Theme) -> PlotResult<Drawing> {
    annotated(data, finding, theme, &|_| Ok(None))
}

/// Drawing of the groups, with `annotate` drawn over the first panel and its remark below.
pub(super) fn annotated(
    data: &Panels,
    finding: &str,
    theme: &Theme,
    annotate: &dyn Fn(&Chart) -> PlotResult<Option<String>>,
) -> PlotResult<Drawing> {
    let data = &fitted(data, theme);
    let mut sheet = Sheet::new(theme, finding)?;
    sheet.legend(&entries(data, theme))?;
    let mut outside = DataOutsideFrame::default();
    let mut charts = Vec::new();
    // Panels of full width have a common left edge.
    let whole = data.groups.iter().filter(|group| !group.is_half);
    let left = whole.map(|group| sheet.left_margin(&grid(group, theme).0)).fold(0.0, f64::max);
    for groups in side_by_side(data, theme) {
        let width = if groups[0].is_half && !theme.is_narrow() { 2 } else { 1 };
        let gap = Sheet::panel_gap(theme);
        let part = (theme.width - side_labels::width(data, theme) - gap * (width - 1) as f64) / width as f64;
        let (top, mut lowest) = (sheet.y, sheet.y);
        for (column, group) in groups.iter().enumerate() {
            sheet.y = top;
            let (mut grid, mut is_cut) = grid(group, theme);
            grid.left = Some(if group.is_half { 0.0 } else { left });
            if group.has_equal_scales {
                // Longer labels of the vertical axis reduce the width, which changes the axis.
                let mut margin = left;
                for _ in 0..3 {
                    equalise(&mut grid, theme.width - margin - Sheet::right_margin(theme));
                    margin = margin.max(sheet.left_margin(&grid));
                }
                grid.left = Some(margin);
                is_cut = is_beyond(&grid, group);
            }
            outside.is_cut |= is_cut;
            let drawn = sheet.grid_within(grid, column as f64 * (part + gap), part)?;
            draw(&drawn, group, theme, &mut outside)?;
            if data.names_aside {
                outside.names.extend(side_labels::draw(&drawn, group, columns(group, theme), theme)?);
            }
            charts.extend(drawn);
            lowest = lowest.max(sheet.y);
        }
        sheet.y = lowest;
    }
    let remark = charts.first().map(annotate).transpose()?.flatten();
    sheet.note(&remark.into_iter().chain(remarks(data, &outside)).collect::<Vec<_>>())?;
    Ok(sheet.finish())
}

fn remarks(data: &Panels, outside: &DataOutsideFrame) -> Vec<String> {
    let dots = match outside.dots {
        0 => None,
        1 => Some(String::from("1 point lies beyond a panel, where an arrow is at its edge.")),
        count => Some(format!("{count} points lie beyond a panel, where an arrow is at its edge.")),
    };
    let apart = outside.apart.then(|| String::from("Records of one amplitude stand side by side."));
    let marks = outside.marks.then(|| data.overflow_note.clone().unwrap_or_else(|| BEYOND_AXIS_REMARK.to_owned()));
    let cut = data.clipping_note.clone().filter(|_| outside.is_cut);
    let names = (!outside.names.is_empty()).then(|| format!("Outside the axes: {}.", outside.names.join(", ")));
    [data.note.clone(), outside.bars.remark(), cut, dots, names, apart, marks].into_iter().flatten().collect()
}

fn entries(data: &Panels, theme: &Theme) -> Vec<LegendEntry> {
    let mut entries: Vec<LegendEntry> = Vec::new();
    for panel in data.groups.iter().flat_map(|group| &group.panels).filter(|_| !data.names_aside) {
        // If a band overlaps another one, its sample has the opacity of both.
        let mut light = 1.0;
        for layer in &panel.layers {
            if let LayerKind::Band(_, _, opacity) = layer.kind {
                light *= 1.0 - opacity;
            }
            let name = layer.name.as_ref().filter(|name| entries.iter().all(|entry| entry.label != **name));
            entries
                .extend(name.and_then(|name| Some(LegendEntry::new(layer.legend_symbol(theme, 1.0 - light)?, name))));
        }
    }
    let lines = data.groups.iter().flat_map(|group| &group.vertical_lines).filter(|line| !line.label.is_empty());
    entries.extend(
        lines.map(|line| LegendEntry::new(LegendSymbol::Upright(mark_stroke(&line.label, theme)), &line.label)),
    );
    entries.extend(data.legend_texts.iter().map(|text| LegendEntry::new(LegendSymbol::Nothing, text)));
    entries
}

/// Stroke of a marked value of an axis: dashed if it has a name in the legend, otherwise dotted.
fn mark_stroke(label: &str, theme: &Theme) -> Stroke {
    let (colour, dash) = if label.is_empty() { (RECORD, DOTTED) } else { (INK, SHORT_DASH) };
    Stroke { dash, ..Stroke::solid(colour, theme.thin) }
}

/// Number of panels of a group side by side; on a narrow page one fewer of small multiples, unless they are a unit.
fn columns(group: &PanelGroup, theme: &Theme) -> usize {
    let narrower = usize::from(theme.is_narrow() && !group.is_unbroken);
    group.multiples_across.map_or(group.x.len(), |across| across.saturating_sub(narrower)).max(1)
}

/// Extents of layers along one axis. If the axis is limited against outliers, every value of a line or band is a
/// separate extent.
fn extents<'a>(layers: impl Iterator<Item = &'a Layer>, ruler: &AxisSpec, is_vertical: bool) -> Extents {
    let mut extents = Extents::default();
    for layer in layers {
        let pairs = layer.curves().flat_map(PlotCurve::finite_pairs);
        let values: Vec<f64> = pairs.map(|(x, y)| if is_vertical { y } else { x }).collect();
        match (&layer.kind, layer.max_axis_widening) {
            (LayerKind::Cloud(_), _) => {}
            (_, Some(widening)) => extents.clippable_values.extend(values.into_iter().map(|value| (value, widening))),
            (LayerKind::Dots(_), None) if is_vertical => extents.add(robust_range(values)),
            (LayerKind::Marks(marks), None) => {
                values.into_iter().for_each(|value| extents.add([value]));
                let ends = marks.intervals.iter().flatten().flatten().filter(|_| is_vertical);
                extents.clippable_values.extend(ends.map(|end| (*end, MAX_INTERVAL_SHARE)));
            }
            (LayerKind::Line(_) | LayerKind::Band(..), None) if ruler.outlier_limit.is_some() => {
                values.into_iter().for_each(|value| extents.add([value]));
            }
            (_, None) => extents.add(values),
        }
    }
    extents
}

/// Grid of a group, and whether a layer is cut by its frame.
fn grid(group: &PanelGroup, theme: &Theme) -> (Grid, bool) {
    let count = columns(group, theme);
    let mut is_cut = false;
    let layers = |keep: &dyn Fn(usize) -> bool| -> Vec<&Layer> {
        let kept =
            group.panels.iter().enumerate().filter(|(index, _)| group.multiples_across.is_some() || keep(*index));
        kept.flat_map(|(_, panel)| &panel.layers).collect()
    };
    // Marks reach beyond their points by their radius, so they need free space at both sides.
    let has_marks = layers(&|_| true).iter().any(|layer| matches!(layer.kind, LayerKind::Marks(_)));
    let mut column = |number: usize| {
        let ruler = &group.x[if group.multiples_across.is_some() { 0 } else { number }];
        let mut data = extents(layers(&|index| index % count == number).into_iter(), ruler, false);
        data.fixed.extend(group.vertical_lines.iter().map(|line| line.value));
        let (axis, cut) = ruler.axis(&data, if has_marks { PAD_SHARE } else { ACROSS_PAD });
        is_cut |= cut;
        TitledAxis::new(axis, ruler.title.as_str())
    };
    let columns: Vec<TitledAxis> = (0..count.min(group.x.len() * count)).map(&mut column).collect();
    let mut row = |(number, row): (usize, &PanelRow)| {
        let mut data = extents(layers(&|index| index / count == number).into_iter(), &row.y, true);
        data.fixed.extend(
            row.dashed_levels.iter().copied().chain(row.reference.iter().flat_map(|reference| reference.values())),
        );
        let (axis, cut) = row.y.axis(&data, PAD_SHARE);
        is_cut |= cut;
        let (lo, hi) = axis.ends();
        // If the font is large relative to the panel, the data keep a part of it.
        let taken = row.free_shares[0] + row.free_shares[1];
        let scale = (MAX_ROOM / taken).min(1.0);
        let [below, above] = row.free_shares.map(|share| scale * share * (hi - lo) / (1.0 - scale * taken));
        let axis = if row.free_shares == [0.0; 2] { axis } else { axis.between(lo - below, hi + above) };
        (TitledAxis::new(axis, row.y.title.as_str()), theme.panel_height(row.height))
    };
    let rows: Vec<(TitledAxis, f64)> = group.rows.iter().enumerate().map(&mut row).collect();
    let head = |panel: &LayeredPanel| {
        // A layer with a name is in the legend.
        let is_nameless = |layer: &&Layer| layer.name.is_none() && !matches!(layer.kind, LayerKind::Marks(_));
        let is_sample = |layer: &&Layer| group.multiples_across.is_some() && is_nameless(layer);
        let sample = panel.layers.first().filter(is_sample).and_then(|layer| layer.legend_symbol(theme, 1.0));
        let head =
            [&panel.head, &panel.result].into_iter().flatten().map(String::as_str).collect::<Vec<_>>().join(": ");
        (!head.is_empty()).then(|| LegendEntry::new(sample.unwrap_or(LegendSymbol::Nothing), head))
    };
    let heads = group.panels.iter().map(head).collect();
    let grid = match (group.multiples_across, rows.first(), columns.first()) {
        (Some(_), Some((row, height)), Some(column)) => Grid {
            shared_title: Some(row.title.clone()),
            heads,
            ..Grid::alike(group.panels.len(), count, column.clone(), TitledAxis::new(row.axis.clone(), ""), *height)
        },
        _ => Grid { columns, rows, heads, ..Grid::default() },
    };
    (grid, is_cut)
}

/// Widens one axis of a panel `width` points wide until a unit has the same length on both axes.
fn equalise(grid: &mut Grid, width: f64) {
    let (Some(column), Some((row, height))) = (grid.columns.first_mut(), grid.rows.first_mut()) else { return };
    let sides = [(&mut column.axis, width), (&mut row.axis, *height)];
    let scale = sides.iter().map(|(axis, points)| (axis.ends().1 - axis.ends().0) / points).fold(0.0, f64::max);
    for (axis, points) in sides {
        let middle = 0.5 * (axis.ends().0 + axis.ends().1);
        let half = 0.5 * scale * points;
        *axis = Axis::linear(middle - half, middle + half, TickRule::Decimal);
    }
}

/// `true` if a layer goes beyond the axes of the only panel.
fn is_beyond(grid: &Grid, group: &PanelGroup) -> bool {
    let (Some(column), Some((row, _))) = (grid.columns.first(), grid.rows.first()) else { return false };
    let holds = |axis: &Axis, value: f64| value >= axis.ends().0 && value <= axis.ends().1;
    let curves = group.panels.iter().flat_map(|panel| &panel.layers).flat_map(Layer::curves);
    let mut pairs = curves.flat_map(PlotCurve::finite_pairs);
    pairs.any(|(x, y)| !holds(&column.axis, x) || !holds(&row.axis, y))
}

/// Draws the panels of a group.
fn draw(charts: &[Chart], group: &PanelGroup, theme: &Theme, outside: &mut DataOutsideFrame) -> PlotResult {
    let count = columns(group, theme);
    let mut dots = 0;
    for (index, (chart, panel)) in charts.iter().zip(&group.panels).enumerate() {
        background(chart, theme, group, &group.rows[if group.multiples_across.is_some() { 0 } else { index / count }])?;
        // Areas are drawn before lines.
        let is_band = |layer: &&Layer| matches!(layer.kind, LayerKind::Band(..));
        let (bands, layers): (Vec<&Layer>, Vec<&Layer>) = panel.layers.iter().partition(is_band);
        for layer in bands.into_iter().chain(layers) {
            dots += draw_layer(chart, layer, theme, outside)?;
        }
        chart.frame(theme)?;
        point_labels::draw(chart, &panel.layers, theme)?;
        if group.multiples_across.is_some() {
            corner(chart, theme, panel)?;
        }
    }
    outside.dots = outside.dots.max(dots);
    Ok(())
}

/// Draws what is behind the layers: lines at zero, levels, the reference and marked values of the horizontal axis.
fn background(chart: &Chart, theme: &Theme, group: &PanelGroup, row: &PanelRow) -> PlotResult {
    if row.has_zero_line {
        chart.horizontal(0.0, zero_stroke(theme))?;
    }
    if group.has_zero_line {
        chart.vertical(None, 0.0, zero_stroke(theme))?;
    }
    for level in &row.dashed_levels {
        chart.horizontal(*level, Stroke { dash: DASHED, ..Stroke::solid(INK, theme.thin) })?;
    }
    if let Some(reference) = &row.reference {
        reference.horizontal(chart, theme)?;
    }
    group.vertical_lines.iter().try_for_each(|line| chart.vertical(None, line.value, mark_stroke(&line.label, theme)))
}

/// Writes the number of dots outside a small multiple into its corner, or that it has no dots.
fn corner(chart: &Chart, theme: &Theme, panel: &LayeredPanel) -> PlotResult {
    let is_cloud = |layer: &&Layer| matches!(layer.kind, LayerKind::Cloud(_));
    let Some(layer) = panel.layers.first().filter(is_cloud) else { return Ok(()) };
    let outside = layer.curve.finite_pairs().filter(|&(x, y)| chart.inside(x, y).is_none()).count();
    let note = match (layer.curve.finite_pairs().count(), outside) {
        (0, _) => String::from("no estimate"),
        (_, 0) => return Ok(()),
        (_, count) => format!("{count} beyond the axes"),
    };
    let place = (chart.rect.right() - 0.4 * theme.small_font, chart.rect.bottom() - 0.9 * theme.small_font);
    chart.canvas.text_with_halo(place, &TextLine::new(note, theme.small_font, HPos::Right))
}

/// Draws a layer; returns the number of dots beyond the panel.
fn draw_layer(chart: &Chart, layer: &Layer, theme: &Theme, outside: &mut DataOutsideFrame) -> PlotResult<usize> {
    let name = layer.name.as_deref();
    match &layer.kind {
        LayerKind::Line(pen) => chart.line(name, layer.curve.pairs(), pen.stroke(theme))?,
        LayerKind::Band(other, colour, opacity) => chart.band(name, [&layer.curve, other], colour.mix(*opacity))?,
        LayerKind::Record => draw_record(chart, theme, name, &layer.curve)?,
        LayerKind::Dots(colour) => {
            chart.dots(name, layer.curve.finite_pairs(), 0.75 * theme.dot, colour.mix(1.0))?;
            return edges(chart, &layer.curve, 1.2 * theme.marker, *colour);
        }
        LayerKind::Cloud(colour) => chart.dots(name, layer.curve.finite_pairs(), 0.75 * theme.dot, colour.mix(0.45))?,
        LayerKind::Marks(marks) => draw_marks(chart, theme, layer, marks, outside)?,
        LayerKind::Ships(colour, headings) => {
            for ((x, y), heading) in layer.curve.pairs().zip(headings).filter(|(_, heading)| heading.is_finite()) {
                let (sine, cosine) = heading.to_radians().sin_cos();
                let ship = |place| ship_outline(page_units(place), (sine, -cosine), 1.6 * theme.small_font, *colour);
                chart.inside(x, y).map(ship).map_or(Ok(()), |ship| chart.canvas.draw_elements(ship))?;
            }
        }
        LayerKind::Labels(..) => {}
    }
    Ok(0)
}

/// Draws small arrows at the edge of a panel for the points above and below it; returns the number of these points.
fn edges(chart: &Chart, curve: &PlotCurve, size: f64, colour: RGBColor) -> PlotResult<usize> {
    let rect = chart.rect;
    let mut count = 0;
    for (x, y) in curve.finite_pairs().filter_map(|(x, y)| chart.page_point(x, y)) {
        let edge = y.clamp(rect.y, rect.bottom());
        if edge != y {
            let x = x.clamp(rect.x, rect.right());
            chart.canvas.arrow_head((x, edge), (0.0, (y - edge).signum()), size, colour)?;
            count += 1;
        }
    }
    Ok(count)
}

/// Draws marks with their intervals, and the line that joins them. A mark beyond the panel is an arrow at its edge.
fn draw_marks(
    chart: &Chart,
    theme: &Theme,
    layer: &Layer,
    marks: &Marks,
    outside: &mut DataOutsideFrame,
) -> PlotResult {
    let Marks { style, intervals, joining_line: joined, side_by_side } = marks;
    let (name, curve, rect) = (layer.name.as_deref(), &layer.curve, chart.rect);
    let middles: Vec<Option<f64>> = curve.x.iter().map(|x| chart.page_x(*x)).collect();
    let across = if *side_by_side { spread_overlapping(&middles, 2.0 * theme.marker) } else { middles.clone() };
    outside.apart |= middles != across;
    // An infinite value has a place far beyond.
    let up = |y: &f64| chart.page_y(y.clamp(-f64::MAX, f64::MAX));
    let places: Vec<Option<PagePoint>> = across.iter().zip(&curve.y).map(|(x, y)| (*x).zip(up(y))).collect();
    let is_inside = |place: &Option<PagePoint>| place.is_some_and(|place| rect.contains(place));
    if let Some(pen) = joined {
        // The line runs neither along the edge nor from zero to the first positive value of a broken axis.
        let mut line = Vec::new();
        for (row, pair) in curve.pairs().enumerate() {
            let is_along = row > 0 && !is_inside(&places[row - 1]) && !is_inside(&places[row]);
            line.extend(is_along.then_some((f64::NAN, f64::NAN)));
            // The line ends at the arrow of a mark beyond the panel.
            let (low, high) = chart.y.ends();
            line.push((pair.0, if is_inside(&places[row]) { pair.1 } else { pair.1.clamp(low, high) }));
            line.extend((pair.0 == 0.0 && chart.x.break_at().is_some()).then_some((f64::NAN, f64::NAN)));
        }
        chart.line(name, line, pen.stroke(theme))?;
    }
    let stroke = Stroke::solid(style.colour, joined.map_or(0.8, |pen| 0.7 * pen.width) * theme.line);
    chart.canvas.svg.begin(SvgGroup { is_interval: true, clip: Some(chart.bounds()), ..SvgGroup::named(name) });
    for (row, place) in places.iter().enumerate().filter(|(_, place)| is_inside(place) || *side_by_side) {
        let ends = intervals.get(row).copied().flatten().filter(|ends| ends.iter().all(|end| !end.is_nan()));
        if let (Some((x, _)), Some(ends)) = (place, ends) {
            let length = interval(chart, *x, ends, stroke, theme)?;
            outside.bars.add(length, theme);
        }
    }
    chart.canvas.svg.end();
    let size = theme.marker * if joined.is_some() { 0.9 } else { 1.0 };
    chart.canvas.svg.begin(SvgGroup::named(name));
    for place in places.iter().filter(|place| is_inside(place)).flatten() {
        chart.canvas.draw_elements(marker(page_units(*place), size, style))?;
    }
    chart.canvas.svg.end();
    for (x, y) in places.iter().filter(|place| !is_inside(place)).flatten() {
        let edge = (x.clamp(rect.x, rect.right()), y.clamp(rect.y, rect.bottom()));
        let direction = if edge.1 == *y { ((x - edge.0).signum(), 0.0) } else { (0.0, (y - edge.1).signum()) };
        chart.canvas.arrow_head(edge, direction, 0.7 * theme.small_font, style.colour)?;
        outside.marks = true;
    }
    Ok(())
}

/// Draws a vertical interval with caps at `x` points from the left of the page; an end beyond the frame is cut, without
/// cap. Returns its length in points.
fn interval(chart: &Chart, x: f64, ends: [f64; 2], stroke: Stroke, theme: &Theme) -> PlotResult<f64> {
    let [_, top, _, bottom] = chart.bounds();
    let far = bottom - top;
    let place = |value: f64, beyond: i32| {
        let y = chart.page_y(value.clamp(-f64::MAX, f64::MAX));
        y.map_or(beyond, |y| units(y).clamp(top - far, bottom + far))
    };
    let [low, high] = [place(ends[0].min(ends[1]), bottom + far), place(ends[0].max(ends[1]), top - far)];
    let cap = units(theme.marker).max(2) as u32;
    chart.canvas.area.draw(&ErrorBar::new_vertical(units(x), low, low, high, stroke.style(), cap))?;
    Ok(f64::from(low - high) / UNITS_PER_POINT)
}
