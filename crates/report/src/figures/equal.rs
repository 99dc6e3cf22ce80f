//! A panel in which a metre is as long on one axis as on the other: tracks seen from above.

use super::panels::{Layer, Stack};
use crate::axis::{self, Axis, Division};
use crate::sheet::{AxisSide, Grid, Sheet, column_axis};

/// Free space around the tracks, as a share of the longer side.
const MARGIN: f64 = 0.05;
/// A coordinate beyond this is no place of a ship.
const FARTHEST: f64 = 1e12;

/// Across or up of a pair.
type AxisPart = fn(&(f64, f64)) -> f64;

/// The ends of both axes as the layers want them, and whether one is cut. A layer may leave the range of those that are
/// not cut by its share of the longer side.
fn ranges(layers: &[Layer]) -> ([(f64, f64); 2], bool) {
    let near = |pair: &(f64, f64)| pair.0.abs() < FARTHEST && pair.1.abs() < FARTHEST;
    let of = |layer: &Layer| layer.curve.finite().filter(near).collect::<Vec<_>>();
    let core: Vec<(f64, f64)> = layers.iter().filter(|layer| layer.room.is_none()).flat_map(of).collect();
    let all: Vec<(f64, f64)> = layers.iter().flat_map(of).collect();
    let parts: [AxisPart; 2] = [|pair| pair.0, |pair| pair.1];
    let wanted = if core.is_empty() { &all } else { &core };
    let [Some(east), Some(north)] = parts.map(|part| axis::range(wanted.iter().map(part))) else {
        return ([(0.0, 1.0); 2], false);
    };
    let (mut found, mut cut) = ([east, north], false);
    let longer = |ranges: &[(f64, f64); 2]| ranges.iter().map(|(lo, hi)| hi - lo).fold(0.0, f64::max);
    let side = longer(&found);
    for layer in layers {
        let room = if side > 0.0 { layer.room.unwrap_or(0.0) * side } else { f64::INFINITY };
        for ((range, part), (lo, hi)) in found.iter_mut().zip(parts).zip([east, north]) {
            let Some((least, most)) = axis::range(of(layer).iter().map(part)) else { continue };
            *range = (range.0.min(least.max(lo - room)), range.1.max(most.min(hi + room)));
            cut |= least < range.0 || most > range.1;
        }
    }
    // A ship that stays where it is, and one so far off that numbers have no digits left for its way.
    let farthest = found.iter().flat_map(|(lo, hi)| [lo.abs(), hi.abs()]).fold(0.0, f64::max);
    let side = longer(&found).max(1e-6 * farthest);
    let side = if side > 0.0 { side } else { 1.0 };
    (found.map(|(lo, hi)| (lo - MARGIN * side, hi + MARGIN * side)), cut)
}

/// The panel with equal scales that shows all layers, its width in points, and whether a layer is cut.
pub(super) fn fitted(sheet: &Sheet, stack: &Stack) -> (Grid, f64, bool) {
    let theme = &sheet.theme;
    let layers = stack.panels.first().map_or(&[][..], |panel| &panel.layers);
    let ([east, north], cut) = ranges(layers);
    let around = |(lo, hi): (f64, f64), length: f64| {
        let (middle, half) = ((lo + hi) / 2.0, length / 2.0);
        Axis::linear(middle - half, middle + half, Division::Decimal)
    };
    let title = |ruler: Option<&super::Ruler>| ruler.map_or_else(String::new, |own| own.title.clone());
    let titles = [title(stack.x.first()), title(stack.rows.first().map(|row| &row.y))];
    let (wide, high) = (east.1 - east.0, north.1 - north.0);
    let with_margin = |left: f64| {
        let whole = (theme.width - left - Sheet::right_margin(theme)).max(theme.tick_font);
        let most = theme.tall(0.72);
        let height = (whole * high / wide).clamp(theme.tall(0.25), most);
        // A track that is much longer than wide has a narrow panel.
        let width = if whole * high > most * wide { (most * wide / high).max(0.5 * whole) } else { whole };
        // What a point on the page is worth, the same on both axes.
        let scale = (wide / width).max(high / height);
        let (across, up) = (around(east, scale * width), around(north, scale * height));
        // The grid is of squares.
        let (across, up) = match column_axis(&across, width, theme).pitch() {
            Some(step) => (across.stepped(step), up.stepped(step)),
            None => (across, up),
        };
        let row = (AxisSide::new(up, titles[1].clone()), height);
        (Grid::new(vec![AxisSide::new(across, titles[0].clone())], vec![row]), width)
    };
    // Longer labels of the vertical axis take from the width, which changes the axis and may change the labels.
    let mut left = 0.0;
    for _ in 0..4 {
        left = sheet.left_margin(&with_margin(left).0).max(left);
    }
    let (grid, width) = with_margin(left);
    (grid, width, cut)
}
