//! A drawing as a list of shapes in points on the page. Figures fill a scene; [`crate::svg`] writes it out. The list in
//! between is what lets a frame be drawn after the data it encloses, and what keeps undefined coordinates out.

use crate::clip::{PagePoint, Rect};
use crate::fonts;
use crate::paint::Paint;
use crate::palette::{Dash, INK, Look, Marker, PAPER, SOLID};

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    pub colour: Paint,
    pub opacity: f64,
    /// Points.
    pub width: f64,
    /// In widths of the line.
    pub dash: Dash,
}

impl Stroke {
    pub(crate) fn solid(colour: Paint, width: f64) -> Self {
        Self { colour, opacity: 1.0, width, dash: SOLID }
    }

    pub(crate) fn dashed(self, dash: Dash) -> Self {
        Self { dash, ..self }
    }
}

/// Which end of a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// A line of text; `place` is on the base line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TextLine {
    pub text: String,
    pub size: f64,
    pub colour: Paint,
    pub bold: bool,
    pub anchor: Anchor,
    /// Turned a quarter to the left, as the title of a vertical axis.
    pub turned: bool,
}

impl TextLine {
    pub(crate) fn new(text: impl Into<String>, size: f64) -> Self {
        Self { text: text.into(), size, colour: INK, bold: false, anchor: Anchor::Start, turned: false }
    }

    pub(crate) fn anchor(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }

    pub(crate) fn colour(self, colour: Paint) -> Self {
        Self { colour, ..self }
    }

    pub(crate) fn width(&self) -> f64 {
        fonts::text_width(&self.text, self.size, self.bold)
    }

    /// From the middle of a capital letter down to the base line.
    pub(crate) fn centring(&self) -> f64 {
        0.36 * self.size
    }

    /// The box around an unturned text at `place`.
    pub(crate) fn bounds(&self, (x, y): PagePoint) -> Rect {
        let w = self.width();
        let left = match self.anchor {
            Anchor::Start => x,
            Anchor::Middle => x - w / 2.0,
            Anchor::End => x - w,
        };
        Rect { x: left, y: y - 0.8 * self.size, w, h: 1.02 * self.size }
    }
}

/// What is drawn over what.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Layer {
    Grid,
    Data,
    Frame,
    Note,
}

/// One thing to draw.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum CanvasShape {
    Line { points: Vec<PagePoint>, stroke: Stroke },
    Fill { points: Vec<PagePoint>, colour: Paint, opacity: f64 },
    Disc { centre: PagePoint, radius: f64, colour: Paint, opacity: f64 },
    Text { place: PagePoint, text: TextLine },
}

/// What tells the shapes of one curve from those of another: the colour, and of a line its dash.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ink {
    pub colour: Paint,
    pub dash: Option<Dash>,
}

impl Ink {
    fn of_line(stroke: Stroke) -> Self {
        Self { colour: stroke.colour, dash: Some(stroke.dash) }
    }

    /// Of what is no line.
    pub(crate) fn of(colour: Paint) -> Self {
        Self { colour, dash: None }
    }
}

/// The shapes of one figure.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Canvas {
    shapes: Vec<(Layer, Ink, CanvasShape)>,
    /// Names of the key of the figure with what they are drawn with.
    keys: Vec<(Ink, String)>,
    /// A line about every panel, for a page in a browser.
    frames: Vec<String>,
}

/// Corners of a star.
const STAR: [(f64, f64); 10] = [
    (0.0, -1.25),
    (0.32, -0.44),
    (1.19, -0.39),
    (0.52, 0.17),
    (0.73, 1.01),
    (0.0, 0.55),
    (-0.73, 1.01),
    (-0.52, 0.17),
    (-1.19, -0.39),
    (-0.32, -0.44),
];

/// Corners of a ship seen from above: forward and to starboard, in half lengths.
const HULL: [(f64, f64); 7] =
    [(1.0, 0.0), (0.72, 0.19), (0.4, 0.3), (-1.0, 0.3), (-1.0, -0.3), (0.4, -0.3), (0.72, -0.19)];

impl Canvas {
    /// The shapes from the bottom layer to the top, each layer in the order of drawing.
    #[cfg(test)]
    pub(crate) fn shapes(&self) -> Vec<&CanvasShape> {
        self.shapes_by_series().into_iter().map(|(_, shape)| shape).collect()
    }

    /// The same with the name in the key of what is data; `None` where the key does not tell.
    pub(crate) fn shapes_by_series(&self) -> Vec<(Option<&str>, &CanvasShape)> {
        let mut order: Vec<&(Layer, Ink, CanvasShape)> = self.shapes.iter().collect();
        order.sort_by_key(|(layer, ..)| *layer);
        let name = |layer, ink| if layer == Layer::Data { self.name(ink) } else { None };
        order.into_iter().map(|(layer, ink, shape)| (name(*layer, *ink), shape)).collect()
    }

    /// The one name that what is drawn like this has in the key, as a reader finds it there.
    fn name(&self, ink: Ink) -> Option<&str> {
        let fits = |key: &Ink| key.colour == ink.colour && (key.dash == ink.dash || ink.dash.is_none());
        let mut names = self.keys.iter().filter(|(key, _)| fits(key)).map(|(_, name)| name.as_str());
        let first = names.next()?;
        names.all(|other| other == first).then_some(first)
    }

    /// Enters a name of the key.
    pub(crate) fn key(&mut self, ink: Ink, name: &str) {
        self.keys.push((ink, name.to_owned()));
    }

    /// Enters a line about a panel.
    pub(crate) fn panel(&mut self, line: String) {
        self.frames.push(line);
    }

    /// The lines about all panels.
    pub(crate) fn panels(&self) -> &[String] {
        &self.frames
    }

    pub(crate) fn line(&mut self, layer: Layer, points: impl Into<Vec<PagePoint>>, stroke: Stroke) {
        let points = points.into();
        if points.len() > 1 && finite(&points) {
            self.shapes.push((layer, Ink::of_line(stroke), CanvasShape::Line { points, stroke }));
        }
    }

    pub(crate) fn fill(&mut self, layer: Layer, points: impl Into<Vec<PagePoint>>, colour: Paint, opacity: f64) {
        let points = points.into();
        if points.len() > 2 && finite(&points) {
            self.shapes.push((layer, Ink::of(colour), CanvasShape::Fill { points, colour, opacity }));
        }
    }

    pub(crate) fn disc(&mut self, layer: Layer, centre: PagePoint, radius: f64, colour: Paint, opacity: f64) {
        if finite(&[centre]) {
            self.shapes.push((layer, Ink::of(colour), CanvasShape::Disc { centre, radius, colour, opacity }));
        }
    }

    pub(crate) fn text(&mut self, layer: Layer, place: PagePoint, text: TextLine) {
        if finite(&[place]) && !text.text.trim().is_empty() {
            self.shapes.push((layer, Ink::of(text.colour), CanvasShape::Text { place, text }));
        }
    }

    /// A text on a white ground, for places where lines run underneath.
    pub(crate) fn text_on_ground(&mut self, layer: Layer, place: PagePoint, text: TextLine) {
        let Rect { x, y, w, h } = text.bounds(place);
        let margin = 0.12 * text.size;
        let (left, right) = (x - margin, x + w + margin);
        self.fill(layer, [(left, y), (right, y), (right, y + h), (left, y + h)], PAPER, 0.85);
        self.text(layer, place, text);
    }

    /// A ship seen from above, `length` points long, its bow along the unit vector `(dx, dy)`.
    pub(crate) fn hull(&mut self, layer: Layer, (x, y): PagePoint, (dx, dy): PagePoint, length: f64, colour: Paint) {
        let outline = |half: f64, beam: f64| -> Vec<PagePoint> {
            let corner = |(forward, side): &(f64, f64)| {
                let (forward, side) = (half * forward, beam * half * side);
                (x + forward * dx - side * dy, y + forward * dy + side * dx)
            };
            HULL.iter().map(corner).collect()
        };
        // A white edge keeps it apart from the lines under it.
        self.fill(layer, outline(0.58 * length, 1.25), PAPER, 1.0);
        self.fill(layer, outline(0.5 * length, 1.0), colour, 1.0);
    }

    /// A marker of `radius` points, with a white edge that keeps it apart from lines and neighbours.
    pub(crate) fn marker(&mut self, layer: Layer, (x, y): PagePoint, radius: f64, look: &Look) {
        let first = self.shapes.len();
        let edge = 0.25 * radius;
        let at = |scale: f64, corners: &[(f64, f64)]| -> Vec<PagePoint> {
            corners.iter().map(|(dx, dy)| (x + dx * scale * radius, y + dy * scale * radius)).collect()
        };
        let strokes: &[[(f64, f64); 2]] = match look.marker {
            Marker::Plus => &[[(-1.1, 0.0), (1.1, 0.0)], [(0.0, -1.1), (0.0, 1.1)]],
            Marker::Cross => &[[(-0.9, -0.9), (0.9, 0.9)], [(-0.9, 0.9), (0.9, -0.9)]],
            _ => &[],
        };
        for ends in strokes {
            self.line(layer, at(1.15, ends), Stroke::solid(PAPER, 0.55 * radius + 2.0 * edge));
        }
        for ends in strokes {
            self.line(layer, at(1.0, ends), Stroke::solid(look.colour, 0.55 * radius));
        }
        let corners: &[(f64, f64)] = match look.marker {
            Marker::Square => &[(-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)],
            Marker::Up => &[(0.0, -1.15), (1.05, 0.75), (-1.05, 0.75)],
            Marker::Down => &[(0.0, 1.15), (1.05, -0.75), (-1.05, -0.75)],
            Marker::Diamond => &[(0.0, -1.2), (1.0, 0.0), (0.0, 1.2), (-1.0, 0.0)],
            Marker::Star => &STAR,
            Marker::Circle | Marker::Plus | Marker::Cross => &[],
        };
        if look.marker == Marker::Circle {
            self.disc(layer, (x, y), radius + edge, PAPER, 1.0);
            self.disc(layer, (x, y), radius, look.colour, 1.0);
            if look.hollow {
                self.disc(layer, (x, y), 0.55 * radius, PAPER, 1.0);
            }
        } else if !corners.is_empty() {
            self.fill(layer, at(1.0 + edge / radius, corners), PAPER, 1.0);
            self.fill(layer, at(1.0, corners), look.colour, 1.0);
            if look.hollow {
                self.fill(layer, at(0.5, corners), PAPER, 1.0);
            }
        }
        // Its edge and its strokes belong to it.
        self.shapes[first..].iter_mut().for_each(|(_, ink, _)| *ink = Ink::of(look.colour));
    }
}

fn finite(points: &[PagePoint]) -> bool {
    points.iter().all(|(x, y)| x.is_finite() && y.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn undefined_coordinates_never_enter() {
        let mut scene = Canvas::default();
        scene.line(Layer::Data, [(0.0, f64::NAN), (1.0, 1.0)], Stroke::solid(INK, 1.0));
        scene.disc(Layer::Data, (f64::INFINITY, 0.0), 1.0, INK, 1.0);
        scene.text(Layer::Data, (0.0, f64::NAN), TextLine::new("a", 8.0));
        assert!(scene.shapes().is_empty());
    }

    #[test]
    fn data_have_the_name_that_the_key_gives_them_alone() {
        let mut scene = Canvas::default();
        let (one, other) = (Stroke::solid(INK, 1.0), Stroke::solid(INK, 1.0).dashed(crate::palette::DASHED));
        scene.key(Ink::of_line(one), "one");
        scene.key(Ink::of_line(other), "other");
        scene.line(Layer::Data, [(0.0, 0.0), (1.0, 1.0)], other);
        scene.disc(Layer::Data, (0.0, 0.0), 1.0, INK, 1.0);
        scene.line(Layer::Frame, [(0.0, 0.0), (1.0, 1.0)], one);
        let names: Vec<Option<&str>> = scene.shapes_by_series().into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, [Some("other"), None, None]);
    }

    #[test]
    fn layers_are_sorted() {
        let mut scene = Canvas::default();
        scene.text(Layer::Note, (0.0, 0.0), TextLine::new("b", 8.0));
        scene.disc(Layer::Grid, (0.0, 0.0), 1.0, INK, 1.0);
        assert!(matches!(scene.shapes()[0], CanvasShape::Disc { .. }));
    }
}
