//! Names right of the frame, in place of a key: as near to what they name as they can stand without touching.

use super::panels::{Layer, Panels};
use crate::clip::PagePoint;
use crate::palette::RECORD;
use crate::panel::Panel;
use crate::scene::{Canvas, Layer as Height, Stroke, TextLine};
use crate::theme::Theme;

/// Free space between the frame and a name, in small-font sizes.
const GAP: f64 = 0.8;

fn text(layer: &Layer, line: &str, theme: &Theme) -> TextLine {
    let colour = if layer.is_quiet() { RECORD } else { layer.colour() };
    TextLine { bold: !layer.is_quiet(), ..TextLine::new(line, theme.small_font).colour(colour) }
}

/// Width of the names with what keeps them clear of the frame, points.
pub(super) fn room(data: &Panels, theme: &Theme) -> f64 {
    let layers = data.stacks.iter().flat_map(|stack| &stack.panels).flat_map(|panel| &panel.layers);
    let named = layers.filter(|_| data.names_aside).filter_map(|layer| Some((layer, layer.name.as_ref()?)));
    let widths = named.flat_map(|(layer, name)| name.split('\n').map(|line| text(layer, line, theme).width()));
    widths.reduce(f64::max).map_or(0.0, |width| width + GAP * theme.small_font)
}

/// Where a name points: the rightmost point of its layer in the frame; one without bound is at the edge.
fn anchor(panel: &Panel, layer: &Layer) -> Option<PagePoint> {
    let place = |pair: (f64, f64)| match pair.1.is_infinite() {
        true => Some((panel.across(pair.0)?, panel.rect.y)),
        false => panel.inside(pair),
    };
    layer.curve.pairs().filter_map(place).max_by(|one, other| one.0.total_cmp(&other.0))
}

/// Writes the names; returns the layers that have no point in the frame.
pub(super) fn names<'a>(panel: &Panel, scene: &mut Canvas, theme: &Theme, layers: &'a [Layer]) -> Vec<&'a Layer> {
    let (named, outside): (Vec<_>, Vec<_>) = layers
        .iter()
        .filter(|layer| layer.name.is_some())
        .map(|layer| (layer, anchor(panel, layer)))
        .partition(|(_, anchor)| anchor.is_some());
    let mut labels: Vec<(PagePoint, &Layer, Vec<&str>)> = (named.into_iter())
        .filter_map(|(layer, anchor)| Some((anchor?, layer, layer.name.as_deref()?.split('\n').collect())))
        .collect();
    labels.sort_by(|one, other| one.0.1.total_cmp(&other.0.1));
    let line = 1.2 * theme.small_font;
    let wanted: Vec<(f64, f64)> = labels.iter().map(|(at, _, lines)| (at.1, lines.len() as f64 * line)).collect();
    let middles = spread(&wanted, [panel.rect.y - 0.5 * line, panel.rect.bottom() + 0.5 * line]);
    let right = panel.rect.right();
    for ((from, layer, lines), middle) in labels.iter().zip(middles) {
        let knee = right + 0.4 * theme.small_font;
        let thin = Stroke { opacity: 0.6, ..Stroke::solid(layer.colour(), theme.thin) };
        scene.line(Height::Grid, [*from, (right, middle), (knee, middle)], thin);
        for (number, words) in lines.iter().enumerate() {
            let text = text(layer, words, theme);
            let y = middle + (number as f64 - 0.5 * (lines.len() - 1) as f64) * line + text.centring();
            scene.text(Height::Note, (knee + 0.3 * theme.small_font, y), text);
        }
    }
    outside.into_iter().map(|(layer, _)| layer).collect()
}

/// Middles of labels of some heights, clear of each other and as near as may be to the wanted ones, which are in order.
fn spread(wanted: &[(f64, f64)], [top, bottom]: [f64; 2]) -> Vec<f64> {
    let mut free = top;
    let mut tops: Vec<f64> = Vec::with_capacity(wanted.len());
    for (middle, height) in wanted {
        tops.push((middle - 0.5 * height).max(free));
        free = tops[tops.len() - 1] + height;
    }
    let mut limit = bottom;
    for (top, (_, height)) in tops.iter_mut().zip(wanted).rev() {
        *top = top.min(limit - height);
        limit = *top;
    }
    tops.iter().zip(wanted).map(|(top, (_, height))| top + 0.5 * height).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_keep_their_order_and_their_distance() {
        let of = |wanted: &[f64]| spread(&wanted.iter().map(|y| (*y, 5.0)).collect::<Vec<_>>(), [-2.5, 102.5]);
        assert_eq!(of(&[10.0, 11.0, 50.0]), [10.0, 15.0, 50.0]);
        assert_eq!(of(&[97.0, 98.0, 99.0]), [90.0, 95.0, 100.0]);
        assert_eq!(of(&[-5.0]), [0.0]);
    }
}
