//! One pair of axes on the page: where a value lies, and the things every figure draws there. Everything is cut at the
//! frame; undefined values are left out.

use crate::axis::PlotAxis;
use crate::clip::{self, PagePoint, Rect};
use crate::dimension::Dimensions;
use crate::paint::Paint;
use crate::palette::Look;
use crate::scene::{Canvas, Layer, Stroke};

/// Finest detail along a line, points: a dense record is thinned to this.
const FINEST: f64 = 0.2;

/// A rectangle with two axes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Panel {
    pub rect: Rect,
    pub x: PlotAxis,
    pub y: PlotAxis,
}

impl Panel {
    /// Horizontal place of a value.
    pub(crate) fn across(&self, x: f64) -> Option<f64> {
        Some(self.rect.x + self.x.fraction(x)? * self.rect.w)
    }

    /// Vertical place of a value.
    pub(crate) fn up(&self, y: f64) -> Option<f64> {
        Some(self.rect.bottom() - self.y.fraction(y)? * self.rect.h)
    }

    /// Place of a pair of values, also outside the frame.
    pub(crate) fn place(&self, (x, y): (f64, f64)) -> Option<PagePoint> {
        Some((self.across(x)?, self.up(y)?))
    }

    /// Place of a pair of values inside the frame.
    pub(crate) fn inside(&self, pair: (f64, f64)) -> Option<PagePoint> {
        self.place(pair).filter(|place| self.rect.contains(*place))
    }

    /// A line through `pairs`, broken at gaps.
    pub(crate) fn line(&self, scene: &mut Canvas, pairs: impl IntoIterator<Item = (f64, f64)>, stroke: Stroke) {
        for part in clip::clip(pairs.into_iter().map(|pair| self.place(pair)), &self.rect) {
            scene.line(Layer::Data, clip::thin(part, FINEST), stroke);
        }
    }

    /// Dots; points that would land on the same spot are drawn once.
    pub(crate) fn dots(
        &self,
        scene: &mut Canvas,
        pairs: impl IntoIterator<Item = (f64, f64)>,
        radius: f64,
        colour: Paint,
    ) {
        let mut last: Option<PagePoint> = None;
        for place in pairs.into_iter().filter_map(|pair| self.inside(pair)) {
            let is_new = last.is_none_or(|(x, y)| (place.0 - x).hypot(place.1 - y) > FINEST);
            if is_new {
                scene.disc(Layer::Data, place, radius, colour, 1.0);
                last = Some(place);
            }
        }
    }

    /// A marker at one pair.
    pub(crate) fn marker(&self, scene: &mut Canvas, pair: (f64, f64), radius: f64, look: &Look) {
        if let Some(place) = self.inside(pair) {
            scene.marker(Layer::Data, place, radius, look);
        }
    }

    /// An interval from left to right at height `y`, with an arrow head at an end that lies beyond the frame; tells
    /// whether one does. An end without bound lies beyond every frame.
    pub(crate) fn bar(&self, scene: &mut Canvas, y: f64, [a, b]: [f64; 2], stroke: Stroke, head: f64) -> bool {
        let place = |value: f64| self.across(value.clamp(-f64::MAX, f64::MAX)).filter(|place| !place.is_nan());
        let (Some(a), Some(b)) = (place(a), place(b)) else { return false };
        let (x, right) = (self.rect.x, self.rect.right());
        let (lo, hi) = (a.min(b), a.max(b));
        let (from, to) = (lo.clamp(x, right), hi.clamp(x, right));
        if from < to {
            scene.line(Layer::Data, [(from, y), (to, y)], stroke);
        }
        let slack = 1e-6;
        let ends = [(lo < x - slack, x, -1.0), (hi > right + slack, right, 1.0)];
        for (_, edge, direction) in ends.into_iter().filter(|end| end.0) {
            Dimensions::head(scene, (edge, y), (direction, 0.0), head, stroke.colour);
        }
        ends.iter().any(|end| end.0)
    }

    /// A line from bottom to top.
    pub(crate) fn vertical(&self, scene: &mut Canvas, layer: Layer, x: f64, stroke: Stroke) {
        if let Some(x) = self.across(x).filter(|x| self.rect.contains((*x, self.rect.y))) {
            scene.line(layer, [(x, self.rect.y), (x, self.rect.bottom())], stroke);
        }
    }

    /// A line from left to right.
    pub(crate) fn horizontal(&self, scene: &mut Canvas, layer: Layer, y: f64, stroke: Stroke) {
        if let Some(y) = self.up(y).filter(|y| self.rect.contains((self.rect.x, *y))) {
            scene.line(layer, [(self.rect.x, y), (self.rect.right(), y)], stroke);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::INK;
    use crate::ticks::TickSteps;

    fn panel() -> Panel {
        Panel {
            rect: Rect { x: 10.0, y: 20.0, w: 100.0, h: 50.0 },
            x: PlotAxis::linear(0.0, 10.0, TickSteps::Decimal),
            y: PlotAxis::linear(-1.0, 1.0, TickSteps::Decimal),
        }
    }

    #[test]
    fn places_and_cuts() {
        let panel = panel();
        assert_eq!(panel.place((5.0, 0.0)), Some((60.0, 45.0)));
        assert_eq!(panel.inside((5.0, 1.5)), None);
        assert_eq!(panel.place((f64::NAN, 0.0)), None);
    }

    #[test]
    fn dense_points_are_drawn_once() {
        let mut scene = Canvas::default();
        panel().dots(&mut scene, (0..1000).map(|i| (5.0 + 1e-6 * f64::from(i), 0.0)), 1.0, INK);
        assert_eq!(scene.shapes().len(), 1);
    }
}
