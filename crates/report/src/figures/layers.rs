//! Draws [`Panels`]: axes over their layers, the layers, and what has to be said of what lies outside.

use super::panels::{Layer, LayerKind, LayeredPanel, Marks, PanelRow, Panels, Ruler, Stack};
use super::reach::{Extents, INTERVALS, robust};
use super::shared::{ACROSS_PAD, PAD, asides, record, zero_stroke};
use super::{aside, equal};
use plotters::element::ErrorBar;
use plotters::style::{Color as _, RGBColor};

use crate::backend::{Drawn, Group, units};
use crate::canvas::{Anchor, Stroke, TextLine, at, hull, marker};
use crate::chart::Chart;
use crate::curve::PlotCurve;
use crate::figure::Drawing;
use crate::key::{KeyEntry, KeySample};
use crate::number::significant;
use crate::palette::{DASHED, INK, SHORT_DASH};
use crate::sheet::{AxisSide, Grid, Sheet};
use crate::theme::Theme;

/// What is said under a figure of what it does not show.
#[derive(Default)]
struct Unshown {
    /// Whether a layer is cut.
    is_cut: bool,
    /// Dots beyond a panel, at most.
    dots: usize,
    /// Whether a mark lies beyond a panel.
    marks: bool,
    /// Whether marks stand side by side.
    apart: bool,
    /// Names without a place in the frame.
    names: Vec<String>,
}

/// The figure as it fits a narrow page: names in a key, and more than three panels side by side as small multiples.
fn narrowed(data: &Panels) -> Panels {
    let mut data = Panels { names_aside: false, ..data.clone() };
    for stack in data.stacks.iter_mut().filter(|own| own.across.is_none() && own.rows.len() == 1 && own.x.len() > 3) {
        stack.across = Some(3);
        stack.x.truncate(1);
    }
    data
}

/// Largest height of all panels of a wide figure, as a share of its width, and the least share of its height that a
/// panel keeps.
const WIDE: [f64; 2] = [0.52, 0.62];

/// The figure as it fits a screen: wider than high.
fn lowered(data: &Panels) -> Panels {
    let height = |stack: &Stack| {
        let rows = stack.across.map_or(1, |across| stack.panels.len().div_ceil(across.max(1)));
        stack.rows.iter().map(|row| row.height).sum::<f64>() * rows as f64
    };
    let rows = data.stacks.chunk_by(|one, other| one.is_half && other.is_half);
    let all: f64 = rows
        .flat_map(|row| row.chunks(if row[0].is_half { 2 } else { 1 }))
        .map(|side_by_side| side_by_side.iter().filter(|stack| !stack.equal).map(height).fold(0.0, f64::max))
        .sum();
    let mut data = data.clone();
    let share = (WIDE[0] / all).clamp(WIDE[1], 1.0);
    data.stacks.iter_mut().flat_map(|stack| &mut stack.rows).for_each(|row| row.height *= share);
    data
}

/// Draws the stacks below each other, half ones in two columns unless the figure is narrow.
pub(super) fn panels(data: &Panels, theme: &Theme) -> Drawn<Drawing> {
    if theme.is_narrow() { drawn(&narrowed(data), theme) } else { drawn(&lowered(data), theme) }
}

fn drawn(data: &Panels, theme: &Theme) -> Drawn<Drawing> {
    let mut sheet = Sheet::new(theme, data.title.as_deref())?;
    sheet.legend(&entries(data, theme))?;
    let mut outside = Unshown::default();
    // Panels of the whole width stand below each other to the point.
    let whole = data.stacks.iter().filter(|stack| !stack.is_half && !stack.equal);
    let left = whole.map(|stack| sheet.left_margin(&grid(stack, theme).0)).fold(0.0, f64::max);
    for row in data.stacks.chunk_by(|one, other| one.is_half && other.is_half) {
        let width = if row[0].is_half && !theme.is_narrow() { 2 } else { 1 };
        let gap = Sheet::gap(theme);
        let part = (theme.width - aside::room(data, theme) - gap * (width - 1) as f64) / width as f64;
        for side_by_side in row.chunks(width) {
            let top = sheet.height();
            let mut lowest = top;
            for (column, stack) in side_by_side.iter().enumerate() {
                sheet.rewind(top);
                let margin = if stack.is_half { 0.0 } else { left };
                draw(&mut sheet, data, stack, (column as f64 * (part + gap), part, margin), &mut outside)?;
                lowest = lowest.max(sheet.height());
            }
            sheet.rewind(lowest);
        }
    }
    let remarks = remarks(data, &outside);
    if !remarks.is_empty() {
        sheet.note(&remarks.join(" "))?;
    }
    Ok(sheet.finish())
}

fn remarks(data: &Panels, outside: &Unshown) -> Vec<String> {
    let dots = match outside.dots {
        0 => None,
        1 => Some(String::from("1 point lies beyond a panel, where an arrow is at its edge.")),
        count => Some(format!("{count} points lie beyond a panel, where an arrow is at its edge.")),
    };
    let names = (!outside.names.is_empty()).then(|| format!("Outside the axes: {}.", outside.names.join(", ")));
    let apart = outside.apart.then(|| String::from("Records of one amplitude stand side by side."));
    let marks = outside.marks.then(|| String::from("Arrows: beyond the axis."));
    let cut = data.cut.clone().filter(|_| outside.is_cut);
    [data.note.clone(), cut, dots, names, apart, marks].into_iter().flatten().collect()
}

fn entries(data: &Panels, theme: &Theme) -> Vec<KeyEntry> {
    let mut entries: Vec<KeyEntry> = Vec::new();
    for panel in data.stacks.iter().flat_map(|stack| &stack.panels).filter(|_| !data.names_aside) {
        // Where a band lies on another one, that shines through.
        let mut light = 1.0;
        for layer in &panel.layers {
            if let LayerKind::Band(_, _, opacity) = layer.kind {
                light *= 1.0 - opacity;
            }
            let Some(name) = layer.name.as_ref().filter(|name| entries.iter().all(|known| known.label != **name))
            else {
                continue;
            };
            entries.extend(layer.sample(theme, 1.0 - light).map(|sample| KeyEntry::new(sample, name.clone())));
        }
    }
    let marks = data.stacks.iter().flat_map(|stack| &stack.marks);
    entries.extend(marks.map(|mark| KeyEntry::new(KeySample::Upright(mark_stroke(theme)), mark.label.clone())));
    entries.extend(data.said.iter().map(|text| KeyEntry::new(KeySample::Nothing, text.clone())));
    entries
}

/// How a value with a name of its own is marked.
fn mark_stroke(theme: &Theme) -> Stroke {
    Stroke::solid(INK, theme.thin).dashed(SHORT_DASH)
}

/// Panels of a stack side by side.
fn columns(stack: &Stack, theme: &Theme) -> usize {
    match stack.across {
        Some(across) if theme.is_narrow() => across.saturating_sub(1).max(1),
        Some(across) => across.max(1),
        None => stack.x.len().max(1),
    }
}

/// The ends of some layers along one axis; where the axis is cut if the data are wild, every value is a thing of its
/// own.
fn extents<'a>(
    layers: impl Iterator<Item = &'a Layer>,
    of: fn((f64, f64)) -> f64,
    (vertical, ruler): (bool, &Ruler),
) -> Extents {
    let mut found = Extents::default();
    for layer in layers {
        let values: Vec<f64> = layer.curves().flat_map(PlotCurve::finite).map(of).collect();
        match (&layer.kind, layer.room) {
            (LayerKind::Cloud(_), _) => {}
            (_, Some(room)) => found.soft.extend(values.into_iter().map(|value| (value, room))),
            (LayerKind::Dots(_), None) if vertical => found.add(robust(values)),
            (LayerKind::Marks(marks), None) => {
                values.into_iter().for_each(|value| found.add([value]));
                let ends = marks.intervals.iter().flatten().flatten().filter(|_| vertical);
                found.soft.extend(ends.map(|end| (*end, INTERVALS)));
            }
            (LayerKind::Line(_) | LayerKind::Band(..), None) if ruler.reach.is_some() => {
                values.into_iter().for_each(|value| found.add([value]));
            }
            (_, None) => found.add(values),
        }
    }
    found
}

/// Free space beside the data: marks have a width.
fn across_pad(stack: &Stack) -> f64 {
    let mut layers = stack.panels.iter().flat_map(|panel| &panel.layers);
    if layers.any(|layer| matches!(layer.kind, LayerKind::Marks(_))) { PAD } else { ACROSS_PAD }
}

/// The frame of a stack, and whether something is cut by it.
fn grid(stack: &Stack, theme: &Theme) -> (Grid, bool) {
    let count = columns(stack, theme);
    let mut is_cut = false;
    let layers = |keep: &dyn Fn(usize) -> bool| -> Vec<&Layer> {
        let own = stack.panels.iter().enumerate().filter(|(index, _)| stack.across.is_some() || keep(*index));
        own.flat_map(|(_, panel)| &panel.layers).collect()
    };
    let mut side = |column: usize| {
        let own = layers(&|index| index % count == column);
        let ruler = &stack.x[if stack.across.is_some() { 0 } else { column }];
        let mut data = extents(own.into_iter(), |pair| pair.0, (false, ruler));
        data.fixed.extend(stack.marks.iter().map(|mark| mark.at));
        let (axis, cut) = ruler.axis(&data, across_pad(stack));
        is_cut |= cut;
        AxisSide::new(axis, ruler.title.clone())
    };
    let columns: Vec<AxisSide> = if stack.x.is_empty() { Vec::new() } else { (0..count).map(&mut side).collect() };
    let rows: Vec<(AxisSide, f64)> = (stack.rows.iter().enumerate())
        .map(|(number, row)| {
            let own = layers(&|index| index / count == number);
            let mut data = extents(own.into_iter(), |pair| pair.1, (true, &row.y));
            data.fixed.extend(row.levels.iter().copied());
            data.fixed.extend(row.reference.iter().flat_map(|own| [own.value, own.band[0], own.band[1]]));
            let (axis, cut) = row.y.axis(&data, PAD);
            is_cut |= cut;
            (AxisSide::new(axis, row.y.title.clone()), theme.tall(row.height))
        })
        .collect();
    let grid = match (stack.across, rows.first(), columns.first()) {
        (Some(_), Some((row, height)), Some(column)) => Grid {
            shared_title: Some(row.title.clone()),
            ..Grid::alike(stack.panels.len(), count, column.clone(), (AxisSide::new(row.axis.clone(), ""), *height))
        },
        _ => Grid::new(columns, rows),
    };
    (grid, is_cut)
}

/// Draws a stack into a strip of the page: its left edge, its width and its least left margin.
fn draw(sheet: &mut Sheet, data: &Panels, stack: &Stack, strip: (f64, f64, f64), outside: &mut Unshown) -> Drawn {
    let theme = sheet.theme;
    let (mut grid, mut cut) = grid(stack, &theme);
    let (mut from, mut width, margin) = strip;
    if stack.equal {
        let fitted;
        (grid, fitted, cut) = equal::fitted(sheet, stack);
        width = sheet.left_margin(&grid) + fitted + Sheet::right_margin(&theme);
        from = (theme.width - width) / 2.0;
    }
    outside.is_cut |= cut;
    let head = |panel: &LayeredPanel| {
        let is_one = |own: &&Layer| stack.across.is_some() && !matches!(own.kind, LayerKind::Marks(_));
        let sample = panel.layers.first().filter(is_one).and_then(|own| own.sample(&theme, 1.0));
        panel.head.as_ref().map(|head| KeyEntry::new(sample.unwrap_or(KeySample::Nothing), head.clone()))
    };
    grid.heads = stack.panels.iter().map(head).collect();
    grid.left = Some(margin);
    let count = columns(stack, &theme);
    let mut dots = 0;
    let charts = sheet.grid_within(grid, (from, width))?;
    for (index, (chart, panel)) in charts.iter().zip(&stack.panels).enumerate() {
        let row = &stack.rows[if stack.across.is_some() { 0 } else { index / count }];
        background(chart, &theme, stack, row)?;
        // What is an area lies under what is a line.
        let is_band = |layer: &&Layer| matches!(layer.kind, LayerKind::Band(..));
        let (bands, others): (Vec<&Layer>, Vec<&Layer>) = panel.layers.iter().partition(is_band);
        for layer in bands.into_iter().chain(others) {
            dots += draw_layer(chart, layer, &theme, outside)?;
        }
        chart.frame(&theme)?;
        panel.layers.iter().try_for_each(|layer| draw_words(chart, layer, &theme))?;
        if stack.across.is_some() {
            corner(chart, &theme, panel)?;
        }
        if data.names_aside && (index + 1).is_multiple_of(count) {
            let names = aside::names(chart, &theme, &panel.layers)?;
            outside.names.extend(names.into_iter().map(|layer| named(layer, stack, row)));
        }
    }
    outside.dots = outside.dots.max(dots);
    Ok(())
}

/// A name with the numbers of its point.
fn named(layer: &Layer, stack: &Stack, row: &PanelRow) -> String {
    let (x, y) = layer.curve.pairs().next().unwrap_or((f64::NAN, f64::NAN));
    let symbol = |title: &str| -> String {
        title.split(" [").next().unwrap_or_default().chars().filter(|c| !crate::markup::is_markup(*c)).collect()
    };
    let across = stack.x.first().map_or_else(String::new, |ruler| symbol(&ruler.title));
    let name = layer.name.as_deref().unwrap_or_default();
    format!("{name} ({across} = {}, {} = {})", significant(x, 3), symbol(&row.y.title), significant(y, 3))
}

/// What lies under the layers.
fn background(chart: &Chart, theme: &Theme, stack: &Stack, row: &PanelRow) -> Drawn {
    if row.zero {
        chart.horizontal(0.0, zero_stroke(theme))?;
    }
    if stack.zero {
        chart.vertical(None, 0.0, zero_stroke(theme))?;
    }
    for level in &row.levels {
        chart.horizontal(*level, Stroke::solid(INK, theme.thin).dashed(DASHED))?;
    }
    if let Some(reference) = &row.reference {
        reference.horizontal(chart, theme)?;
    }
    stack.marks.iter().try_for_each(|mark| chart.vertical(None, mark.at, mark_stroke(theme)))
}

/// What a small multiple says of what it does not show: how many of its dots lie outside.
fn corner(chart: &Chart, theme: &Theme, panel: &LayeredPanel) -> Drawn {
    let Some(layer) = panel.layers.first().filter(|layer| matches!(layer.kind, LayerKind::Cloud(_))) else {
        return Ok(());
    };
    let outside = layer.curve.finite().filter(|pair| chart.inside(*pair).is_none()).count();
    let note = match (layer.curve.finite().count(), outside) {
        (0, _) => String::from("no estimate"),
        (_, 0) => return Ok(()),
        (_, count) => format!("{count} beyond the axes"),
    };
    let text = TextLine::new(note, theme.small_font).anchor(Anchor::End);
    let place = (chart.rect.right() - 0.4 * theme.small_font, chart.rect.bottom() - 0.9 * theme.small_font);
    chart.canvas.text_on_ground(place, &text)
}

/// Draws a layer; returns how many dots lie beyond the panel.
fn draw_layer(chart: &Chart, layer: &Layer, theme: &Theme, outside: &mut Unshown) -> Drawn<usize> {
    let name = layer.name.as_deref();
    match &layer.kind {
        LayerKind::Line(pen) => chart.line(name, layer.curve.pairs(), pen.stroke(theme))?,
        LayerKind::Band(other, colour, opacity) => chart.band(name, [&layer.curve, other], *colour, *opacity)?,
        LayerKind::Record => record(chart, theme, name, &layer.curve)?,
        LayerKind::Dots(colour) => {
            chart.dots(name, layer.curve.finite(), 0.75 * theme.dot, colour.mix(1.0))?;
            return edges(chart, &layer.curve, 1.2 * theme.marker, *colour);
        }
        LayerKind::Cloud(colour) => chart.dots(name, layer.curve.finite(), 0.75 * theme.dot, colour.mix(0.45))?,
        LayerKind::Marks(marks) => draw_marks(chart, theme, layer, marks, outside)?,
        LayerKind::Ships(colour, headings) => {
            for (pair, heading) in layer.curve.pairs().zip(headings) {
                let (sine, cosine) = heading.to_radians().sin_cos();
                if let Some(place) = chart.inside(pair).filter(|_| heading.is_finite()) {
                    let ship = hull(at(place), (sine, -cosine), 1.6 * theme.small_font, *colour);
                    chart.canvas.elements(ship)?;
                }
            }
        }
        LayerKind::Words(..) => {}
    }
    Ok(0)
}

/// Writes the words of a layer beside its points.
fn draw_words(chart: &Chart, layer: &Layer, theme: &Theme) -> Drawn {
    let LayerKind::Words(colour, is_above, words) = &layer.kind else { return Ok(()) };
    let right = 1.2 * theme.marker;
    let (right, down, anchor) = match is_above {
        true => (right, -theme.marker - 0.36 * theme.small_font, Anchor::Start),
        false => (-right, theme.marker + 0.34 * theme.small_font, Anchor::End),
    };
    for (pair, words) in layer.curve.pairs().zip(words) {
        let Some((x, y)) = chart.inside(pair) else { continue };
        let text = TextLine::new(words.as_str(), theme.small_font).colour(*colour).anchor(anchor);
        chart.canvas.text_on_ground((x + right, y + down), &text)?;
    }
    Ok(())
}

/// Marks points above and below a panel by small arrows at its edge, and counts them.
fn edges(chart: &Chart, curve: &PlotCurve, size: f64, colour: RGBColor) -> Drawn<usize> {
    let rect = chart.rect;
    let mut count = 0;
    for (x, y) in curve.finite().filter_map(|pair| chart.place(pair)) {
        let (tip, back) = match y {
            y if y < rect.y => (rect.y, rect.y + size),
            y if y > rect.bottom() => (rect.bottom(), rect.bottom() - size),
            _ => continue,
        };
        let x = x.clamp(rect.x, rect.right());
        chart.canvas.fill(&[(x, tip), (x - 0.5 * size, back), (x + 0.5 * size, back)], colour, 1.0)?;
        count += 1;
    }
    Ok(count)
}

/// A mark of a layer.
struct Mark {
    /// Place across the page, which may stand beside that of its value.
    x: f64,
    /// Height on the page, at the edge where the value lies beyond.
    y: f64,
    is_beyond: bool,
}

/// The interval of a mark.
struct Bar {
    /// Place across the page.
    x: f64,
    ends: [f64; 2],
    marked: f64,
}

/// Marks with their intervals, and the line that joins them.
fn draw_marks(chart: &Chart, theme: &Theme, layer: &Layer, marks: &Marks, outside: &mut Unshown) -> Drawn {
    let (name, curve) = (layer.name.as_deref(), &layer.curve);
    let Marks { look, intervals, joined, apart } = marks;
    let mut across: Vec<Option<f64>> = curve.x.iter().map(|x| chart.across(*x)).collect();
    if *apart {
        let moved = asides(&across, 2.0 * theme.marker);
        let is_far = |(own, moved): (&Option<f64>, &Option<f64>)| own.zip(*moved).is_some_and(|(a, b)| a != b);
        outside.apart |= across.iter().zip(&moved).any(is_far);
        across = moved;
    }
    let rect = chart.rect;
    let stroke = Stroke::solid(look.colour, joined.map_or(0.8, |pen| 0.7 * pen.width) * theme.line);
    let size = if joined.is_some() { 0.9 } else { 1.0 };
    let mut line: Vec<(f64, f64)> = Vec::new();
    let mut drawn: Vec<Mark> = Vec::new();
    let mut bars = Vec::new();
    let gap = (f64::NAN, f64::NAN);
    for (row, (x, &value)) in across.iter().zip(&curve.y).enumerate() {
        // A value without bound, or none at all.
        let up = if value.is_infinite() { Some(value * -1e9) } else { chart.up(value) };
        let Some((x, up)) = x.zip(up).filter(|(x, _)| *x >= rect.x - 0.1 && *x <= rect.right() + 0.1) else {
            line.push(gap);
            continue;
        };
        let is_beyond = up < rect.y - 0.1 || up > rect.bottom() + 0.1;
        // The line does not run along the edge, nor from zero to the first positive value of a broken axis.
        let was_beyond = drawn.last().is_some_and(|mark| mark.is_beyond);
        line.extend((is_beyond && was_beyond).then_some(gap));
        line.push((curve.x[row], value.clamp(-f64::MAX, f64::MAX)));
        line.extend((curve.x[row] == 0.0 && chart.x.break_at().is_some()).then_some(gap));
        if let Some(ends) = intervals.get(row).copied().flatten().filter(|_| !is_beyond || *apart) {
            bars.push(Bar { x, ends: [ends[0].min(ends[1]), ends[0].max(ends[1])], marked: value });
        }
        drawn.push(Mark { x, y: up.clamp(rect.y, rect.bottom()), is_beyond });
    }
    if let Some(pen) = joined {
        chart.line(name, line, pen.stroke(theme))?;
    }
    draw_bars(chart, name, &bars, stroke, theme)?;
    chart.canvas.svg.begin(Group::named(name));
    for Mark { x, y, .. } in drawn.iter().filter(|mark| !mark.is_beyond) {
        chart.canvas.elements(marker(at((*x, *y)), size * theme.marker, look))?;
    }
    chart.canvas.svg.end();
    for Mark { x, y, .. } in drawn.iter().filter(|mark| mark.is_beyond) {
        let direction = if *y <= rect.y { -1.0 } else { 1.0 };
        chart.canvas.head((*x, *y), (0.0, direction), 0.7 * theme.small_font, look.colour)?;
        outside.marks |= joined.is_none();
    }
    Ok(())
}

/// Vertical intervals with caps at places across the page; an end beyond the frame is cut, without cap.
fn draw_bars(chart: &Chart, name: Option<&str>, bars: &[Bar], stroke: Stroke, theme: &Theme) -> Drawn {
    let cap = units(theme.marker).max(2) as u32;
    let [_, top, _, bottom] = chart.bounds();
    let far = bottom - top;
    let place = |value: f64, beyond: i32| {
        chart.up(value.clamp(-f64::MAX, f64::MAX)).map_or(beyond, |y| units(y).clamp(top - far, bottom + far))
    };
    let bar = |Bar { x, ends: [low, high], marked }: &Bar| {
        let [low, marked, high] = [place(*low, bottom + far), place(*marked, top - far), place(*high, top - far)];
        ErrorBar::new_vertical(units(*x), low, marked, high, stroke.style(), cap)
    };
    let bars: Vec<_> = bars.iter().filter(|bar| bar.ends.iter().all(|end| !end.is_nan())).map(bar).collect();
    chart.canvas.svg.begin(Group { is_interval: true, clip: Some(chart.bounds()), ..Group::named(name) });
    bars.iter().try_for_each(|bar| chart.canvas.area.draw(bar))?;
    chart.canvas.svg.end();
    Ok(())
}
