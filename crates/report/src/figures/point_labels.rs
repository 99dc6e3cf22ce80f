//! Labels beside points: each on the side of its point where it covers least of the lines, marks and other labels.

use plotters::style::text_anchor::HPos;

use super::panels::{Layer, LayerKind};
use crate::backend::PlotResult;
use crate::canvas::{PagePoint, Rect, TextLine};
use crate::chart::Chart;
use crate::theme::Theme;

/// Places of a label about its point in order of preference: right or left, then above (−1, farther −2) or below.
const SIDES: [(f64, f64); 12] = [
    (1.0, -1.0),
    (-1.0, -1.0),
    (1.0, 1.0),
    (-1.0, 1.0),
    (0.0, -1.0),
    (0.0, 1.0),
    (1.0, -2.0),
    (-1.0, -2.0),
    (1.0, 2.0),
    (-1.0, 2.0),
    (1.0, 0.0),
    (-1.0, 0.0),
];

/// Distance that a label keeps from lines, in font sizes.
const CLEARANCE: f64 = 0.25;

/// Minimum cost of covering a line, that of pale lines; an opaque line costs 1.
const PALE: f64 = 0.3;

/// Cost of covering another label.
const LABEL: f64 = 5.0;

/// Cost of a place farther from its point.
const FAR: f64 = 1.5;

/// Cost of a place beyond the frame.
const BEYOND: f64 = 100.0;

/// Lines on the page that labels should not cover, each with its cost.
struct Obstacles(Vec<([PagePoint; 2], f64)>);

impl Obstacles {
    fn new(chart: &Chart, layers: &[Layer]) -> Self {
        let mut segments = Vec::new();
        for layer in layers {
            let cost = match &layer.kind {
                LayerKind::Line(pen) => pen.opacity.max(PALE),
                LayerKind::Marks(_) => 1.0,
                _ => continue,
            };
            let points: Vec<Option<PagePoint>> =
                layer.curve.pairs().map(|(x, y)| chart.page_point(x, y.min(f64::MAX))).collect();
            let joined = points.windows(2).filter_map(|ends| Some([ends[0]?, ends[1]?]));
            segments.extend(joined.map(|ends| (ends, cost)));
            let LayerKind::Marks(marks) = &layer.kind else { continue };
            // A mark is a line without length.
            segments.extend(points.iter().flatten().map(|point| ([*point; 2], cost)));
            let bars = layer.curve.x.iter().zip(&marks.intervals).filter_map(|(x, ends)| Some((*x, (*ends)?)));
            let bar = |(x, [low, high]): (f64, [f64; 2])| {
                Some([chart.page_point(x, low)?, chart.page_point(x, high.min(f64::MAX))?])
            };
            segments.extend(bars.filter_map(bar).map(|ends| (ends, cost)));
        }
        Self(segments)
    }

    /// Cost of a label that fills the rectangle `place`.
    fn cost(&self, place: Rect) -> f64 {
        self.0.iter().filter(|(ends, _)| crosses(place, *ends)).map(|(_, cost)| cost).sum()
    }
}

/// `true` if a segment has a point in a rectangle (Liang and Barsky 1984).
fn crosses(place: Rect, [from, to]: [PagePoint; 2]) -> bool {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let sides =
        [(-dx, from.0 - place.x), (dx, place.right() - from.0), (-dy, from.1 - place.y), (dy, place.bottom() - from.1)];
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for (step, room) in sides {
        match step {
            0.0 if room < 0.0 => return false,
            0.0 => {}
            step if step < 0.0 => enters = enters.max(room / step),
            step => leaves = leaves.min(room / step),
        }
    }
    enters <= leaves
}

/// Writes the labels of all layers of a panel.
pub(super) fn draw(chart: &Chart, layers: &[Layer], theme: &Theme) -> PlotResult {
    let mut obstacles = Obstacles::new(chart, layers);
    let frame = chart.rect;
    for layer in layers {
        let LayerKind::Labels(labels) = &layer.kind else { continue };
        for ((x, y), label) in layer.curve.pairs().zip(labels) {
            let Some((x, y)) = chart.inside(x, y) else { continue };
            let text = TextLine::new(label, theme.small_font, HPos::Center);
            let (width, height) = (text.width(), theme.small_font);
            let at = |(right, down): (f64, f64)| {
                let gap = if down == 0.0 { 1.8 } else { 1.2 } * theme.marker;
                let side = if down == 0.0 { 0.0 } else { down.signum() };
                let shift = side * (theme.marker + 0.4 * height) + 0.7 * (down - side) * height;
                (x + right * (gap + 0.5 * width), y + shift)
            };
            let place =
                |(x, y): PagePoint| Rect { x: x - 0.5 * width, y: y - 0.45 * height, w: width, h: 0.9 * height };
            let cost = |side: (f64, f64)| {
                let place = place(at(side));
                let corners = [(place.x, place.y), (place.right(), place.bottom())];
                let is_within = corners.into_iter().all(|corner| frame.contains(corner));
                let clear = CLEARANCE * height;
                let Rect { x, y, w, h } = place;
                let near = Rect { x: x - clear, y: y - clear, w: w + 2.0 * clear, h: h + 2.0 * clear };
                let far = if side.1.abs() > 1.0 { FAR } else { 0.0 };
                obstacles.cost(near) + far + if is_within { 0.0 } else { BEYOND }
            };
            let sides = SIDES.into_iter();
            let middle = sides.min_by(|a, b| cost(*a).total_cmp(&cost(*b))).map_or((x, y), at);
            chart.canvas.text_with_halo(middle, &text)?;
            let Rect { x, y, w, h } = place(middle);
            obstacles.0.push(([(x, y + 0.5 * h), (x + w, y + 0.5 * h)], LABEL));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_crosses_a_rectangle_that_it_touches() {
        let place = Rect { x: 0.0, y: 0.0, w: 4.0, h: 2.0 };
        let is_crossed = |from, to| crosses(place, [from, to]);
        assert!(is_crossed((-1.0, 1.0), (5.0, 1.0)) && is_crossed((1.0, -9.0), (1.0, 9.0)));
        assert!(is_crossed((1.0, 1.0), (1.0, 1.0)) && is_crossed((-1.0, 0.0), (2.0, 3.0)));
        assert!(!is_crossed((-1.0, 1.5), (0.5, 3.0)) && !is_crossed((5.0, 1.0), (6.0, 1.0)));
        assert!(!is_crossed((-1.0, 2.5), (5.0, 2.5)) && !is_crossed((-2.0, 1.0), (-1.0, 1.0)));
    }
}
