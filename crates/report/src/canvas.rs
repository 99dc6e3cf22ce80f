//! Page in points, for elements outside charts: legends, notes, markers, dimension lines, arrow heads. All are made of
//! plotters' elements; elements with an undefined coordinate are omitted.

use plotters::coord::Shift;
use plotters::drawing::DrawingArea;
use plotters::element::{Circle, DynElement, EmptyElement, IntoDynElement as _, PathElement, Polygon, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontDesc, FontFamily, FontStyle, FontTransform, RGBColor, ShapeStyle, TextStyle};

use crate::backend::{PlotResult, Svg, SvgGroup, UNITS_PER_POINT, units};
use crate::fonts::{FAMILY, text_width};
use crate::palette::{BACKGROUND, CurveStyle, Dash, INK, Marker, SOLID};

/// Place on the page, points from the upper left corner.
pub(crate) type PagePoint = (f64, f64);

/// Element of plotters at a place in the coordinates `C`.
pub(crate) type Element<C> = DynElement<'static, Svg, C>;

/// Rectangle on the page: left, top, width and height, points.
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

    /// `true` if a place is inside the rectangle or on its edge, with a tolerance of 0.1 points.
    pub(crate) fn contains(&self, (x, y): PagePoint) -> bool {
        let slack = 0.1;
        x >= self.x - slack && x <= self.right() + slack && y >= self.y - slack && y <= self.bottom() + slack
    }
}

/// Style of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    pub colour: RGBColor,
    pub opacity: f64,
    /// Width, points.
    pub width: f64,
    /// Dash pattern, in line widths.
    pub dash: Dash,
}

impl Stroke {
    pub(crate) fn solid(colour: RGBColor, width: f64) -> Self {
        Self { colour, opacity: 1.0, width, dash: SOLID }
    }

    /// Colour, opacity and width for plotters; dashes are an attribute of the SVG group.
    pub(crate) fn style(&self) -> ShapeStyle {
        ShapeStyle {
            color: self.colour.mix(self.opacity),
            filled: false,
            stroke_width: units(self.width).max(1) as u32,
        }
    }
}

/// Text with its style; lines are separated by line breaks. Its place is its left end, middle or right end, as the
/// anchor states, at half its height.
#[derive(Clone)]
pub(crate) struct TextLine {
    pub text: String,
    /// Font size, points.
    pub size: f64,
    pub colour: RGBColor,
    pub is_bold: bool,
    pub anchor: HPos,
    /// `true` if turned a quarter to the left, as the title of a vertical axis.
    pub is_turned: bool,
}

impl TextLine {
    pub(crate) fn new(text: impl Into<String>, size: f64, anchor: HPos) -> Self {
        Self { text: text.into(), size, colour: INK, is_bold: false, anchor, is_turned: false }
    }

    pub(crate) fn width(&self) -> f64 {
        text_width(&self.text, self.size, self.is_bold)
    }

    /// Left and right end of an unturned text at `x`, points.
    pub(crate) fn ends(&self, x: f64) -> [f64; 2] {
        let left = match self.anchor {
            HPos::Left => x,
            HPos::Center => x - self.width() / 2.0,
            HPos::Right => x - self.width(),
        };
        [left, left + self.width()]
    }

    /// Font, colour and anchor for plotters.
    pub(crate) fn style(&self) -> TextStyle<'static> {
        let weight = if self.is_bold { FontStyle::Bold } else { FontStyle::Normal };
        let turn = if self.is_turned { FontTransform::Rotate270 } else { FontTransform::None };
        let font = FontDesc::new(FontFamily::Name(FAMILY), self.size * UNITS_PER_POINT, weight).transform(turn);
        font.color(&self.colour).pos(Pos::new(self.anchor, VPos::Center))
    }
}

/// Width of the white edge about the letters of a text, in font sizes.
const HALO: f64 = 0.12;

/// Page to draw on, with coordinates in points.
#[derive(Clone)]
pub(crate) struct Canvas {
    pub area: DrawingArea<Svg, Shift>,
    pub svg: Svg,
}

impl Canvas {
    pub(crate) fn line(&self, points: &[PagePoint], stroke: Stroke) -> PlotResult {
        let Some(points) = placed(points) else { return Ok(()) };
        self.svg.begin(SvgGroup { dash: Some((stroke.dash, stroke.width)), ..SvgGroup::default() });
        self.area.draw(&PathElement::new(points, stroke.style()))?;
        self.svg.end();
        Ok(())
    }

    pub(crate) fn fill(&self, points: &[PagePoint], colour: RGBColor, opacity: f64) -> PlotResult {
        let Some(points) = placed(points) else { return Ok(()) };
        self.area.draw(&Polygon::new(points, colour.mix(opacity).filled()))
    }

    /// Draws the outline of a rectangle.
    pub(crate) fn outline(&self, rect: Rect, stroke: Stroke) -> PlotResult {
        let corners = [page_units((rect.x, rect.y)), page_units((rect.right(), rect.bottom()))];
        self.svg.begin(SvgGroup { dash: Some((stroke.dash, stroke.width)), ..SvgGroup::default() });
        self.area.draw(&Rectangle::new(corners, stroke.style()))?;
        self.svg.end();
        Ok(())
    }

    pub(crate) fn text(&self, place: PagePoint, text: &TextLine) -> PlotResult {
        let Some(places) = placed(&[place]) else { return Ok(()) };
        self.area.draw(&Text::new(text.text.clone(), places[0], text.style()))
    }

    /// Draws a text with a white edge about its letters, for places with lines underneath.
    pub(crate) fn text_with_halo(&self, place: PagePoint, text: &TextLine) -> PlotResult {
        self.svg.begin(SvgGroup { halo: Some(HALO * text.size), ..SvgGroup::default() });
        self.text(place, text)?;
        self.svg.end();
        Ok(())
    }

    /// Draws elements at places in backend units, such as a marker or a ship outline.
    pub(crate) fn draw_elements(&self, elements: Vec<Element<(i32, i32)>>) -> PlotResult {
        elements.iter().try_for_each(|element| self.area.draw(element))
    }

    /// Draws an arrow head of `size` points with its tip at `(x, y)`, pointing along the unit vector `(dx, dy)`.
    pub(crate) fn arrow_head(&self, (x, y): PagePoint, (dx, dy): PagePoint, size: f64, colour: RGBColor) -> PlotResult {
        let (bx, by) = (x - size * dx, y - size * dy);
        let half = 0.36 * size;
        self.fill(&[(x, y), (bx - half * dy, by + half * dx), (bx + half * dy, by - half * dx)], colour, 1.0)
    }
}

/// Point of the page converted to the units of the SVG backend.
pub(crate) fn page_units((x, y): PagePoint) -> (i32, i32) {
    (units(x), units(y))
}

/// Points in the units of the SVG backend; `None` if a coordinate is not finite.
fn placed(points: &[PagePoint]) -> Option<Vec<(i32, i32)>> {
    let is_finite = points.iter().all(|(x, y)| x.is_finite() && y.is_finite());
    is_finite.then(|| points.iter().copied().map(page_units).collect())
}

/// Corners of a star, to the right and down, in radii of a marker.
#[rustfmt::skip]
const STAR: [(f64, f64); 10] = [
    (0.0, -1.25), (0.32, -0.44), (1.19, -0.39), (0.52, 0.17), (0.73, 1.01),
    (0.0, 0.55), (-0.73, 1.01), (-0.52, 0.17), (-1.19, -0.39), (-0.32, -0.44),
];

/// Corners of a ship seen from above: forward and to starboard, in half lengths.
const HULL: [(f64, f64); 7] =
    [(1.0, 0.0), (0.72, 0.19), (0.4, 0.3), (-1.0, 0.3), (-1.0, -0.3), (0.4, -0.3), (0.72, -0.19)];

/// Polygon about a place, its corners in points from that place.
fn polygon<C: Clone + 'static>(at: &C, corners: impl Iterator<Item = PagePoint>, colour: RGBColor) -> Element<C> {
    let corners: Vec<(i32, i32)> = corners.map(self::page_units).collect();
    (EmptyElement::at(at.clone()) + Polygon::new(corners, colour.filled())).into_dyn()
}

/// Elements of a marker of `radius` points; a white edge separates it from lines and neighbours.
pub(crate) fn marker<C: Clone + 'static>(at: C, radius: f64, style: &CurveStyle) -> Vec<Element<C>> {
    let circle = |scale: f64, colour: RGBColor| {
        let size = units(scale * radius).max(1) as u32;
        (EmptyElement::at(at.clone()) + Circle::new((0, 0), size, colour.filled())).into_dyn()
    };
    let shape = |scale: f64, colour: RGBColor, corners: &[(f64, f64)]| match corners {
        [] => circle(scale, colour),
        _ => polygon(&at, corners.iter().map(|(x, y)| (scale * radius * x, scale * radius * y)), colour),
    };
    let stroke = |[from, to]: [(f64, f64); 2]| {
        let ends = [from, to].map(|(x, y)| self::page_units((radius * x, radius * y)));
        let shape_style = Stroke::solid(style.colour, 0.55 * radius).style();
        (EmptyElement::at(at.clone()) + PathElement::new(ends.to_vec(), shape_style)).into_dyn()
    };
    let strokes =
        |lines: [[(f64, f64); 2]; 2]| [circle(1.1, BACKGROUND)].into_iter().chain(lines.map(stroke)).collect();
    let corners: &[(f64, f64)] = match style.marker {
        Marker::Plus => return strokes([[(-1.1, 0.0), (1.1, 0.0)], [(0.0, -1.1), (0.0, 1.1)]]),
        Marker::Cross => return strokes([[(-0.9, -0.9), (0.9, 0.9)], [(-0.9, 0.9), (0.9, -0.9)]]),
        Marker::Circle => &[],
        Marker::Square => &[(-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)],
        Marker::Up => &[(0.0, -1.15), (1.05, 0.75), (-1.05, 0.75)],
        Marker::Down => &[(0.0, 1.15), (1.05, -0.75), (-1.05, -0.75)],
        Marker::Diamond => &[(0.0, -1.2), (1.0, 0.0), (0.0, 1.2), (-1.0, 0.0)],
        Marker::Star => &STAR,
    };
    let hole = style.is_hollow.then(|| shape(0.52, BACKGROUND, corners));
    [shape(1.25, BACKGROUND, corners), shape(1.0, style.colour, corners)].into_iter().chain(hole).collect()
}

/// Elements of a ship seen from above, `length` points long, with her bow along the unit vector `(dx, dy)`; a white
/// edge separates her from the lines underneath.
pub(crate) fn ship_outline<C: Clone + 'static>(
    at: C,
    (dx, dy): PagePoint,
    length: f64,
    colour: RGBColor,
) -> Vec<Element<C>> {
    let outline = |half: f64, beam: f64, colour: RGBColor| {
        let turned = HULL.iter().map(move |(forward, side)| {
            let (forward, side) = (half * forward, beam * half * side);
            (forward * dx - side * dy, forward * dy + side * dx)
        });
        polygon(&at, turned, colour)
    };
    vec![outline(0.58 * length, 1.25, BACKGROUND), outline(0.5 * length, 1.0, colour)]
}
