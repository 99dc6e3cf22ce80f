//! Dimension lines as on a technical drawing: a line with an arrow at either end and the quantity beside it.

use crate::clip::PagePoint;
use crate::paint::Paint;
use crate::palette::DIMENSION;
use crate::scene::{Anchor, Canvas, Layer, Stroke, TextLine};
use crate::theme::Theme;

/// Length of an arrow head, in small-font sizes.
const HEAD: f64 = 0.5;

/// Draws dimension lines into a scene.
pub(crate) struct Dimensions<'a> {
    pub scene: &'a mut Canvas,
    pub theme: Theme,
}

impl Dimensions<'_> {
    fn stroke(&self) -> Stroke {
        Stroke::solid(DIMENSION, self.theme.thin)
    }

    /// An arrow head with its tip at `tip`, pointing along the unit vector `(dx, dy)`.
    pub(crate) fn head(scene: &mut Canvas, (x, y): PagePoint, (dx, dy): PagePoint, size: f64, colour: Paint) {
        let (bx, by) = (x - size * dx, y - size * dy);
        let half = 0.36 * size;
        scene.fill(
            Layer::Note,
            [(x, y), (bx - half * dy, by + half * dx), (bx + half * dy, by - half * dx)],
            colour,
            1.0,
        );
    }

    /// The line between two places; when they are too close for two heads, the heads point at them from outside.
    pub(crate) fn between(&mut self, from: PagePoint, to: PagePoint) {
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        if length == 0.0 || !length.is_finite() {
            return;
        }
        let along = ((to.0 - from.0) / length, (to.1 - from.1) / length);
        let size = HEAD * self.theme.small_font;
        let stroke = self.stroke();
        if length > 2.6 * size {
            self.scene.line(Layer::Note, [from, to], stroke);
            Self::head(self.scene, from, (-along.0, -along.1), size, DIMENSION);
            Self::head(self.scene, to, along, size, DIMENSION);
        } else {
            let beyond = |(x, y): PagePoint, s: f64| (x + s * along.0 * 2.2 * size, y + s * along.1 * 2.2 * size);
            self.scene.line(Layer::Note, [beyond(from, -1.0), beyond(to, 1.0)], stroke);
            Self::head(self.scene, from, along, size, DIMENSION);
            Self::head(self.scene, to, (-along.0, -along.1), size, DIMENSION);
        }
    }

    /// A thin line from a point of the data to its dimension line.
    pub(crate) fn extension(&mut self, from: PagePoint, to: PagePoint) {
        let stroke = Stroke { opacity: 0.75, width: 0.8 * self.theme.thin, ..self.stroke() };
        self.scene.line(Layer::Data, [from, to], stroke);
    }

    /// The quantity at a dimension line.
    pub(crate) fn label(&mut self, place: PagePoint, anchor: Anchor, text: &str) {
        let text = TextLine::new(text, self.theme.small_font).anchor(anchor).colour(DIMENSION);
        self.scene.text_on_ground(Layer::Note, place, text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(from: PagePoint, to: PagePoint) -> usize {
        let mut scene = Canvas::default();
        Dimensions { scene: &mut scene, theme: Theme::screen() }.between(from, to);
        scene.shapes().len()
    }

    #[test]
    fn heads_are_drawn_inside_or_outside_and_never_for_nothing() {
        assert_eq!(lines((0.0, 0.0), (100.0, 0.0)), 3);
        assert_eq!(lines((0.0, 0.0), (2.0, 0.0)), 3);
        assert_eq!(lines((1.0, 1.0), (1.0, 1.0)), 0);
        assert_eq!(lines((1.0, f64::NAN), (1.0, 1.0)), 0);
    }
}
