//! Draws [`Panels`]: axes over their layers, the layers, and what has to be said of what lies outside.

use super::panels::{Layer, LayerKind, LayeredPanel, Marks, PanelRow, Panels, Ruler, Stack};
use super::reach::{Extents, INTERVALS, robust};
use super::shared::{ACROSS_PAD, PAD, asides, record, shaded, zero_line, zero_upright};
use super::{aside, equal};
use crate::clip::{self, PagePoint};
use crate::curve::PlotCurve;
use crate::dimension::Dimensions;
use crate::figure::Drawing;
use crate::layout::{AxisSide, Grid, Sheet};
use crate::legend::{KeyEntry, KeySample};
use crate::number::significant;
use crate::paint::Paint;
use crate::palette::{DASHED, INK, Look, SHORT_DASH};
use crate::panel::Panel;
use crate::scene::{Anchor, Canvas, Layer as Height, Stroke, TextLine};
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

/// Draws the stacks below each other, half ones in two columns unless the figure is narrow.
pub(super) fn panels(data: &Panels, theme: &Theme) -> Drawing {
    if theme.is_narrow() { drawn(&narrowed(data), theme) } else { drawn(data, theme) }
}

fn drawn(data: &Panels, theme: &Theme) -> Drawing {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
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
                draw(&mut sheet, data, stack, (column as f64 * (part + gap), part, margin), &mut outside);
                lowest = lowest.max(sheet.height());
            }
            sheet.rewind(lowest);
        }
    }
    let remarks = remarks(data, &outside);
    if !remarks.is_empty() {
        sheet.note(&remarks.join(" "));
    }
    sheet.finish()
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
fn draw(sheet: &mut Sheet, data: &Panels, stack: &Stack, strip: (f64, f64, f64), outside: &mut Unshown) {
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
    for (index, (place, panel)) in sheet.grid_within(grid, (from, width)).iter().zip(&stack.panels).enumerate() {
        let row = &stack.rows[if stack.across.is_some() { 0 } else { index / count }];
        background(place, &mut sheet.scene, &theme, stack, row);
        stack
            .marks
            .iter()
            .for_each(|mark| place.vertical(&mut sheet.scene, Height::Grid, mark.at, mark_stroke(&theme)));
        for layer in &panel.layers {
            dots += draw_layer(sheet, place, layer, &theme, outside);
        }
        if stack.across.is_some() {
            corner(place, &mut sheet.scene, &theme, panel);
        }
        if data.names_aside && (index + 1).is_multiple_of(count) {
            let names = aside::names(place, &mut sheet.scene, &theme, &panel.layers);
            outside.names.extend(names.into_iter().map(|layer| named(layer, stack, row)));
        }
    }
    outside.dots = outside.dots.max(dots);
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
fn background(place: &Panel, scene: &mut Canvas, theme: &Theme, stack: &Stack, row: &PanelRow) {
    if row.zero {
        zero_line(place, scene, theme);
    }
    if stack.zero {
        zero_upright(place, scene, theme);
    }
    for level in &row.levels {
        place.horizontal(scene, Height::Grid, *level, Stroke::solid(INK, theme.thin).dashed(DASHED));
    }
    if let Some(reference) = &row.reference {
        reference.horizontal(place, scene, theme);
    }
}

/// What a small multiple says of what it does not show: how many of its dots lie outside.
fn corner(place: &Panel, scene: &mut Canvas, theme: &Theme, panel: &LayeredPanel) {
    let Some(layer) = panel.layers.first() else { return };
    let rect = place.rect;
    let outside = || layer.curve.finite().filter(|pair| place.inside(*pair).is_none());
    if matches!(layer.kind, LayerKind::Cloud(_)) {
        let note = match (layer.curve.finite().count(), outside().count()) {
            (0, _) => String::from("no estimate"),
            (_, 0) => return,
            (_, count) => format!("{count} beyond the axes"),
        };
        let text = TextLine::new(note, theme.small_font).anchor(Anchor::End);
        let at = (rect.right() - 0.4 * theme.small_font, rect.bottom() - 0.5 * theme.small_font);
        scene.text_on_ground(Height::Note, at, text);
    }
}

/// Draws a layer; tells how many dots lie beyond the panel.
fn draw_layer(sheet: &mut Sheet, place: &Panel, layer: &Layer, theme: &Theme, outside: &mut Unshown) -> usize {
    let scene = &mut sheet.scene;
    match &layer.kind {
        LayerKind::Line(pen) => place.line(scene, layer.curve.pairs(), pen.stroke(theme)),
        LayerKind::Band(other, colour, opacity) => shaded(place, scene, [&layer.curve, other], *colour, *opacity),
        LayerKind::Record => record(place, scene, theme, &layer.curve, 1.4 * theme.dot),
        LayerKind::Dots(colour) => {
            place.dots(scene, layer.curve.finite(), 0.75 * theme.dot, *colour);
            return edges(place, &layer.curve, scene, 1.2 * theme.marker, *colour);
        }
        LayerKind::Cloud(colour) => {
            for at in layer.curve.finite().filter_map(|pair| place.inside(pair)) {
                scene.disc(Height::Data, at, 0.75 * theme.dot, *colour, 0.45);
            }
        }
        LayerKind::Marks(marks) => draw_marks(place, scene, theme, (&layer.curve, marks), outside),
        LayerKind::Words(colour, is_above, words) => {
            let right = 1.2 * theme.marker;
            let (right, down, anchor) = match is_above {
                true => (right, -theme.marker, Anchor::Start),
                false => (-right, theme.marker + 0.7 * theme.small_font, Anchor::End),
            };
            for (pair, words) in layer.curve.pairs().zip(words) {
                let Some((x, y)) = place.inside(pair) else { continue };
                let text = TextLine::new(words.as_str(), theme.small_font).colour(*colour).anchor(anchor);
                scene.text_on_ground(Height::Note, (x + right, y + down), text);
            }
        }
        LayerKind::Ships(colour, headings) => {
            for (pair, heading) in layer.curve.pairs().zip(headings) {
                let (sine, cosine) = heading.to_radians().sin_cos();
                if let Some(at) = place.inside(pair) {
                    scene.hull(Height::Data, at, (sine, -cosine), 1.6 * theme.small_font, *colour);
                }
            }
        }
    }
    0
}

/// Marks points above and below a panel by small arrows at its edge, and counts them.
fn edges(place: &Panel, curve: &PlotCurve, scene: &mut Canvas, size: f64, colour: Paint) -> usize {
    let (top, bottom) = (place.rect.y, place.rect.bottom());
    let mut count = 0;
    for (x, y) in curve.finite().filter_map(|pair| place.place(pair)) {
        let (tip, back) = match y {
            y if y < top => (top, top + size),
            y if y > bottom => (bottom, bottom - size),
            _ => continue,
        };
        let x = x.clamp(place.rect.x, place.rect.right());
        scene.fill(Height::Data, [(x, tip), (x - 0.5 * size, back), (x + 0.5 * size, back)], colour, 1.0);
        count += 1;
    }
    count
}

/// Marks with their intervals, and the line that joins them.
fn draw_marks(place: &Panel, scene: &mut Canvas, theme: &Theme, own: (&PlotCurve, &Marks), outside: &mut Unshown) {
    let (curve, Marks { look, intervals, joined, apart }) = own;
    let mut across: Vec<Option<f64>> = curve.x.iter().map(|x| place.across(*x)).collect();
    if *apart {
        let moved = asides(&across, 2.0 * theme.marker);
        let is_far = |(own, moved): (&Option<f64>, &Option<f64>)| own.zip(*moved).is_some_and(|(a, b)| a != b);
        outside.apart |= across.iter().zip(&moved).any(is_far);
        across = moved;
    }
    let (top, bottom) = (place.rect.y, place.rect.bottom());
    let stroke = Stroke::solid(look.colour, joined.map_or(0.8, |pen| 0.7 * pen.width) * theme.line);
    let size = if joined.is_some() { 0.9 } else { 1.0 };
    let mut line: Vec<Option<PagePoint>> = Vec::new();
    let mut marks: Vec<(PagePoint, bool)> = Vec::new();
    for (row, (x, &y)) in across.iter().zip(&curve.y).enumerate() {
        // A value without bound, or none at all.
        let up = if y.is_infinite() { Some(y * -1e9) } else { place.up(y) };
        let Some((x, up)) = x.zip(up).filter(|(x, _)| *x >= place.rect.x && *x <= place.rect.right()) else {
            line.push(None);
            continue;
        };
        let is_beyond = up < top || up > bottom;
        let at = (x, up.clamp(top, bottom));
        // The line does not run along the edge, nor from zero to the first positive value of a broken axis.
        let was_beyond = marks.last().is_some_and(|(_, beyond)| *beyond);
        line.extend((is_beyond && was_beyond).then_some(None));
        line.push(Some(at));
        line.extend((curve.x[row] == 0.0 && place.x.break_at().is_some()).then_some(None));
        if let Some([low, high]) = intervals.get(row).copied().flatten().filter(|_| !is_beyond || *apart) {
            interval(place, scene, x, [low, high], (0.7 * theme.marker, stroke));
        }
        marks.push((at, is_beyond));
    }
    if let Some(pen) = joined {
        clip::clip(line, &place.rect).into_iter().for_each(|part| scene.line(Height::Data, part, pen.stroke(theme)));
    }
    for (at, is_beyond) in marks {
        if is_beyond {
            let direction = if at.1 <= top { -1.0 } else { 1.0 };
            Dimensions::head(scene, at, (0.0, direction), 0.7 * theme.small_font, look.colour);
            outside.marks |= joined.is_none();
        } else {
            scene.marker(Height::Data, at, size * theme.marker, &Look { ..*look });
        }
    }
}

/// A vertical bar with caps; an end beyond the frame (or at zero on a logarithmic axis) is cut, without cap.
fn interval(panel: &Panel, scene: &mut Canvas, across: f64, [lo, hi]: [f64; 2], (cap, stroke): (f64, Stroke)) {
    let rect = panel.rect;
    let high = panel.up(lo.max(hi)).unwrap_or(f64::NEG_INFINITY);
    let low = panel.up(lo.min(hi)).unwrap_or(f64::INFINITY);
    let (top, bottom) = (high.max(rect.y), low.min(rect.bottom()));
    if top > bottom {
        return;
    }
    scene.line(Height::Data, [(across, top), (across, bottom)], stroke);
    for y in [low, high].into_iter().filter(|y| rect.contains((across, *y))) {
        scene.line(Height::Data, [(across - cap, y), (across + cap, y)], stroke);
    }
}
