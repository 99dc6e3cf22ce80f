//! The page in points, for what stands on it and in no chart: keys, notes, markers, dimension lines, arrow heads. All
//! of it is made of plotters' elements; what has an undefined coordinate is left out.

use plotters::coord::Shift;
use plotters::drawing::DrawingArea;
use plotters::element::{Circle, DynElement, EmptyElement, IntoDynElement as _, PathElement, Polygon, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color as _, FontDesc, FontFamily, FontStyle, FontTransform, IntoFont as _, RGBColor, ShapeStyle, TextStyle,
};

use crate::backend::{Drawn, Group, Svg, units};
use crate::fonts::{FAMILY, text_width};
use crate::palette::{Dash, INK, Look, Marker, PAPER, SOLID};

/// A place on the page, points from the upper left corner.
pub(crate) type PagePoint = (f64, f64);

/// A drawing area of plotters in the units of the backend.
pub(crate) type Area = DrawingArea<Svg, Shift>;

/// A rectangle on the page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rect {
    pub x: f64,
    pub y: f64,
    pub w: f64,
    pub h: f64,
}

impl Rect {
    pub(crate) fn right(&self) -> f64 {
        self.x + self.w
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.y + self.h
    }

    /// Whether a place lies in it or on its edge, to the width of a hair: places are rounded.
    pub(crate) fn contains(&self, (x, y): PagePoint) -> bool {
        let slack = 0.1;
        x >= self.x - slack && x <= self.right() + slack && y >= self.y - slack && y <= self.bottom() + slack
    }

    fn corners(&self) -> [PagePoint; 4] {
        [(self.x, self.y), (self.right(), self.y), (self.right(), self.bottom()), (self.x, self.bottom())]
    }
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    pub colour: RGBColor,
    pub opacity: f64,
    /// Points.
    pub width: f64,
    /// In widths of the line.
    pub dash: Dash,
}

impl Stroke {
    pub(crate) fn solid(colour: RGBColor, width: f64) -> Self {
        Self { colour, opacity: 1.0, width, dash: SOLID }
    }

    pub(crate) fn dashed(self, dash: Dash) -> Self {
        Self { dash, ..self }
    }

    /// As plotters wants it.
    pub(crate) fn style(&self) -> ShapeStyle {
        ShapeStyle {
            color: self.colour.mix(self.opacity),
            filled: false,
            stroke_width: units(self.width).max(1) as u32,
        }
    }

    /// The group of lines with its pattern.
    pub(crate) fn group(&self) -> Group {
        Group { dash: Some((self.dash, self.width)), ..Group::default() }
    }
}

/// A text with its looks; lines are parted by line breaks.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TextLine {
    pub text: String,
    pub size: f64,
    pub colour: RGBColor,
    pub bold: bool,
    pub anchor: Anchor,
    /// Turned a quarter to the left, as the title of a vertical axis.
    pub turned: bool,
}

/// Which end of a text stands at its place, which is on the middle of its height.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

impl TextLine {
    pub(crate) fn new(text: impl Into<String>, size: f64) -> Self {
        Self { text: text.into(), size, colour: INK, bold: false, anchor: Anchor::Start, turned: false }
    }

    pub(crate) fn anchor(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }

    pub(crate) fn colour(self, colour: RGBColor) -> Self {
        Self { colour, ..self }
    }

    pub(crate) fn width(&self) -> f64 {
        text_width(&self.text, self.size, self.bold)
    }

    /// The box around an unturned text at `place`.
    pub(crate) fn bounds(&self, (x, y): PagePoint) -> Rect {
        let w = self.width();
        let left = match self.anchor {
            Anchor::Start => x,
            Anchor::Middle => x - w / 2.0,
            Anchor::End => x - w,
        };
        Rect { x: left, y: y - 0.5 * self.size, w, h: self.size }
    }

    /// As plotters wants it.
    pub(crate) fn style(&self) -> TextStyle<'static> {
        let weight = if self.bold { FontStyle::Bold } else { FontStyle::Normal };
        let font = FontDesc::new(FontFamily::Name(FAMILY), self.size * crate::backend::UNITS, weight);
        let across = match self.anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        let turn = if self.turned { FontTransform::Rotate270 } else { FontTransform::None };
        font.into_font().color(&self.colour).transform(turn).pos(Pos::new(across, VPos::Center))
    }
}

/// The page.
#[derive(Clone)]
pub(crate) struct Canvas {
    pub area: Area,
    pub svg: Svg,
}

impl Canvas {
    pub(crate) fn line(&self, points: &[PagePoint], stroke: Stroke) -> Drawn {
        let Some(points) = placed(points) else { return Ok(()) };
        self.svg_group(stroke, || self.area.draw(&PathElement::new(points, stroke.style())))
    }

    fn svg_group(&self, stroke: Stroke, draw: impl FnOnce() -> Drawn) -> Drawn {
        if stroke.dash.is_empty() {
            return draw();
        }
        self.svg.begin(stroke.group());
        draw()?;
        self.svg.end();
        Ok(())
    }

    pub(crate) fn fill(&self, points: &[PagePoint], colour: RGBColor, opacity: f64) -> Drawn {
        let Some(points) = placed(points) else { return Ok(()) };
        self.area.draw(&Polygon::new(points, colour.mix(opacity).filled()))
    }

    /// The outline of a rectangle.
    pub(crate) fn outline(&self, rect: Rect, stroke: Stroke) -> Drawn {
        let [from, _, to, _] = rect.corners().map(place);
        self.svg_group(stroke, || self.area.draw(&Rectangle::new([from, to], stroke.style())))
    }

    pub(crate) fn text(&self, at: PagePoint, text: &TextLine) -> Drawn {
        match placed(&[at]) {
            Some(at) => self.area.draw(&Text::new(text.text.clone(), at[0], text.style())),
            None => Ok(()),
        }
    }

    /// A text on a white ground, for places where lines run underneath.
    pub(crate) fn text_on_ground(&self, at: PagePoint, text: &TextLine) -> Drawn {
        let Rect { x, y, w, h } = text.bounds(at);
        let margin = 0.12 * text.size;
        self.fill(&Rect { x: x - margin, y, w: w + 2.0 * margin, h }.corners(), PAPER, 0.85)?;
        self.text(at, text)
    }

    /// Elements about a place.
    pub(crate) fn elements(&self, elements: Vec<Element<(i32, i32)>>) -> Drawn {
        elements.iter().try_for_each(|element| self.area.draw(element))
    }

    /// An arrow head with its tip at `tip`, pointing along the unit vector `(dx, dy)`.
    pub(crate) fn head(&self, (x, y): PagePoint, (dx, dy): PagePoint, size: f64, colour: RGBColor) -> Drawn {
        let (bx, by) = (x - size * dx, y - size * dy);
        let half = 0.36 * size;
        self.fill(&[(x, y), (bx - half * dy, by + half * dx), (bx + half * dy, by - half * dx)], colour, 1.0)
    }
}

fn place((x, y): PagePoint) -> (i32, i32) {
    (units(x), units(y))
}

fn placed(points: &[PagePoint]) -> Option<Vec<(i32, i32)>> {
    let is_finite = points.iter().all(|(x, y)| x.is_finite() && y.is_finite());
    is_finite.then(|| points.iter().copied().map(place).collect())
}

/// An element of plotters at a place of any coordinates.
pub(crate) type Element<C> = DynElement<'static, Svg, C>;

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

/// A marker of `radius` points, with a white edge that keeps it apart from lines and neighbours.
pub(crate) fn marker<C: Clone + 'static>(at: C, radius: f64, look: &Look) -> Vec<Element<C>> {
    let circle = |scale: f64, colour: RGBColor| {
        let size = units(scale * radius).max(1) as u32;
        (EmptyElement::at(at.clone()) + Circle::new((0, 0), size, colour.filled())).into_dyn()
    };
    let polygon = |scale: f64, colour: RGBColor, corners: &[(f64, f64)]| {
        let corner = |(x, y): &(f64, f64)| (units(scale * radius * x), units(scale * radius * y));
        let corners: Vec<(i32, i32)> = corners.iter().map(corner).collect();
        (EmptyElement::at(at.clone()) + Polygon::new(corners, colour.filled())).into_dyn()
    };
    let stroke = |[from, to]: [(f64, f64); 2]| {
        let ends = [from, to].map(|(x, y)| (units(radius * x), units(radius * y)));
        let style = Stroke::solid(look.colour, 0.55 * radius).style();
        (EmptyElement::at(at.clone()) + PathElement::new(ends.to_vec(), style)).into_dyn()
    };
    let corners: &[(f64, f64)] = match look.marker {
        Marker::Circle => {
            let hole = look.hollow.then(|| circle(0.55, PAPER));
            return [circle(1.25, PAPER), circle(1.0, look.colour)].into_iter().chain(hole).collect();
        }
        Marker::Plus => {
            let lines = [[(-1.1, 0.0), (1.1, 0.0)], [(0.0, -1.1), (0.0, 1.1)]];
            return [circle(1.1, PAPER)].into_iter().chain(lines.map(stroke)).collect();
        }
        Marker::Cross => {
            let lines = [[(-0.9, -0.9), (0.9, 0.9)], [(-0.9, 0.9), (0.9, -0.9)]];
            return [circle(1.1, PAPER)].into_iter().chain(lines.map(stroke)).collect();
        }
        Marker::Square => &[(-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)],
        Marker::Up => &[(0.0, -1.15), (1.05, 0.75), (-1.05, 0.75)],
        Marker::Down => &[(0.0, 1.15), (1.05, -0.75), (-1.05, -0.75)],
        Marker::Diamond => &[(0.0, -1.2), (1.0, 0.0), (0.0, 1.2), (-1.0, 0.0)],
        Marker::Star => &STAR,
    };
    let hole = look.hollow.then(|| polygon(0.5, PAPER, corners));
    [polygon(1.25, PAPER, corners), polygon(1.0, look.colour, corners)].into_iter().chain(hole).collect()
}

/// A ship seen from above, `length` points long, its bow along the unit vector `(dx, dy)`. A white edge keeps it apart
/// from the lines under it.
pub(crate) fn hull<C: Clone + 'static>(at: C, (dx, dy): PagePoint, length: f64, colour: RGBColor) -> Vec<Element<C>> {
    let outline = |half: f64, beam: f64, colour: RGBColor| {
        let corner = |(forward, side): &(f64, f64)| {
            let (forward, side) = (half * forward, beam * half * side);
            (units(forward * dx - side * dy), units(forward * dy + side * dx))
        };
        let corners: Vec<(i32, i32)> = HULL.iter().map(corner).collect();
        (EmptyElement::at(at.clone()) + Polygon::new(corners, colour.filled())).into_dyn()
    };
    vec![outline(0.58 * length, 1.25, PAPER), outline(0.5 * length, 1.0, colour)]
}

/// A place of the page in the units of the backend.
pub(crate) fn at(point: PagePoint) -> (i32, i32) {
    place(point)
}
