//! Dimension lines as on a technical drawing: a line with an arrow at either end and the quantity beside it.

use crate::backend::Drawn;
use crate::canvas::{Anchor, Canvas, PagePoint, Stroke, TextLine};
use crate::palette::DIMENSION;
use crate::theme::Theme;

/// Length of an arrow head, in small-font sizes.
const HEAD: f64 = 0.5;

/// Draws dimension lines on a page.
pub(crate) struct Dimensions<'a> {
    pub canvas: &'a Canvas,
    pub theme: Theme,
}

impl Dimensions<'_> {
    fn stroke(&self) -> Stroke {
        Stroke::solid(DIMENSION, self.theme.thin)
    }

    /// The line between two places; when they are too close for two heads, the heads point at them from outside.
    pub(crate) fn between(&self, from: PagePoint, to: PagePoint) -> Drawn {
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        if length == 0.0 || !length.is_finite() {
            return Ok(());
        }
        let along = ((to.0 - from.0) / length, (to.1 - from.1) / length);
        let size = HEAD * self.theme.small_font;
        let stroke = self.stroke();
        if length > 2.6 * size {
            self.canvas.line(&[from, to], stroke)?;
            self.canvas.head(from, (-along.0, -along.1), size, DIMENSION)?;
            self.canvas.head(to, along, size, DIMENSION)
        } else {
            let beyond = |(x, y): PagePoint, s: f64| (x + s * along.0 * 2.2 * size, y + s * along.1 * 2.2 * size);
            self.canvas.line(&[beyond(from, -1.0), beyond(to, 1.0)], stroke)?;
            self.canvas.head(from, along, size, DIMENSION)?;
            self.canvas.head(to, (-along.0, -along.1), size, DIMENSION)
        }
    }

    /// A thin line from a point of the data to its dimension line.
    pub(crate) fn extension(&self, from: PagePoint, to: PagePoint) -> Drawn {
        let stroke = Stroke { opacity: 0.75, width: 0.8 * self.theme.thin, ..self.stroke() };
        self.canvas.line(&[from, to], stroke)
    }

    /// The quantity at a dimension line.
    pub(crate) fn label(&self, place: PagePoint, text: &str) -> Drawn {
        let text = TextLine::new(text, self.theme.small_font).anchor(Anchor::Middle).colour(DIMENSION);
        self.canvas.text_on_ground(place, &text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::Sheet;

    fn shapes(from: PagePoint, to: PagePoint) -> usize {
        let sheet = Sheet::new(&Theme::screen(), None).unwrap();
        Dimensions { canvas: &sheet.canvas, theme: Theme::screen() }.between(from, to).unwrap();
        let svg = sheet.finish().svg().to_owned();
        svg.matches("<path").count() + svg.matches("<polygon").count() - 1
    }

    #[test]
    fn heads_are_drawn_inside_or_outside_and_never_for_nothing() {
        assert_eq!(shapes((0.0, 0.0), (100.0, 0.0)), 3);
        assert_eq!(shapes((0.0, 0.0), (2.0, 0.0)), 3);
        assert_eq!(shapes((1.0, 1.0), (1.0, 1.0)), 0);
        assert_eq!(shapes((1.0, f64::NAN), (1.0, 1.0)), 0);
    }
}
