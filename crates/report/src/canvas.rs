//! The canvas that plotters draws on, and the repairs of its SVG: nothing else knows plotters.
//!
//! Its SVG backend works in whole pixels, so a canvas has many units to the point; it knows no mixed type, so that is
//! added here. Text stays text (it can be searched and edited), with a list of fall-back families for viewers without
//! DejaVu Sans.

use std::sync::OnceLock;

use plotters::prelude::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color, FontDesc, FontFamily, FontStyle, FontTransform, IntoTextStyle, RGBAColor, RGBColor, ShapeStyle,
    register_font,
};

use crate::clip::Place;
use crate::colour::Colour;
use crate::fonts::{BOLD, FAMILY, FAMILY_WITH_FALLBACK, REGULAR};
use crate::markup::{is_markup, runs};
use crate::printable::is_printable;

/// Canvas units to one point on the page: 2.4 to a dot at 600 dpi, so rounding to whole units is never seen.
pub(crate) const UNITS: f64 = 20.0;
/// The SVG backend divides every font size by this.
const BACKEND_FONT_FACTOR: f64 = 1.24;
/// The SVG backend shifts the base line by this; removed, because viewers disagree on the size of an ex.
const BACKEND_SHIFT: &str = " dy=\"-0.5ex\"";
/// The SVG backend writes the opacity of a whole element, which a rasteriser answers with a layer of its own, slow for
/// a cloud of points.
const BACKEND_OPACITY: &str = " opacity=\"";
const INFALLIBLE: &str = "writing into a string cannot fail";

/// plotters scales a font by its line height, which for DejaVu Sans is (1901 + 483) / 2048 of the em.
const LINE_HEIGHT_EM: f64 = 2384.0 / 2048.0;

/// Which end of a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a line of text is set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Type {
    /// Points.
    pub size: f64,
    pub colour: Colour,
    pub bold: bool,
    pub anchor: Anchor,
    /// Turned a quarter to the left, as the title of a vertical axis.
    pub turned: bool,
}

/// What `draw` draws on a page of `width` x `height` points, as elements of an SVG document.
pub(crate) fn elements(width: f64, height: f64, draw: impl FnOnce(&mut Canvas)) -> String {
    let mut svg = String::new();
    {
        let mut canvas = Canvas { backend: SVGBackend::with_string(&mut svg, size(width, height)) };
        draw(&mut canvas);
        canvas.backend.present().expect(INFALLIBLE);
    }
    let body = svg.split_once('>').map_or("", |(_, body)| body);
    finish(body.rsplit_once("</svg>").map_or(body, |(body, _)| body).trim_start_matches('\n'))
}

/// An SVG document of these elements on `paper`.
pub(crate) fn document(width: f64, height: f64, paper: Colour, elements: &str) -> String {
    let (across, down) = size(width, height);
    let (right, bottom) = (across as i32, down as i32);
    let page = self::elements(width, height, |canvas| {
        let page = [(0, 0), (right, 0), (right, bottom), (0, bottom)];
        canvas.backend.fill_polygon(page, &rgb(paper).filled()).expect(INFALLIBLE);
    });
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.3}pt\" height=\"{height:.3}pt\" \
         viewBox=\"0 0 {across} {down}\" stroke-linejoin=\"round\">\n{page}{elements}</svg>\n"
    )
}

/// Width and height in units of the canvas.
fn size(width: f64, height: f64) -> (u32, u32) {
    (units(width).max(1) as u32, units(height).max(1) as u32)
}

fn units(points: f64) -> i32 {
    (points * UNITS).round() as i32
}

fn place((x, y): Place) -> (i32, i32) {
    (units(x), units(y))
}

fn rgb(Colour(red, green, blue): Colour) -> RGBColor {
    RGBColor(red, green, blue)
}

fn ink(colour: Colour, opacity: f64) -> RGBAColor {
    rgb(colour).mix(opacity)
}

/// A page that is drawn on, in points.
pub(crate) struct Canvas<'a> {
    backend: SVGBackend<'a>,
}

impl Canvas<'_> {
    /// A line through `points`, `width` points wide.
    pub(crate) fn line(&mut self, points: Vec<Place>, width: f64, colour: Colour, opacity: f64) {
        let stroke_width = units(width).max(1) as u32;
        let style = ShapeStyle { color: ink(colour, opacity), filled: false, stroke_width };
        self.backend.draw_path(points.into_iter().map(place), &style).expect(INFALLIBLE);
    }

    /// The inside of a polygon.
    pub(crate) fn fill(&mut self, points: &[Place], colour: Colour, opacity: f64) {
        let style = ink(colour, opacity).filled();
        self.backend.fill_polygon(points.iter().copied().map(place), &style).expect(INFALLIBLE);
    }

    /// A disc.
    pub(crate) fn disc(&mut self, centre: Place, radius: f64, colour: Colour, opacity: f64) {
        let style = ink(colour, opacity).filled();
        let radius = units(radius).max(1) as u32;
        self.backend.draw_circle(place(centre), radius, &style, true).expect(INFALLIBLE);
    }

    /// A line of text with its base line at a place.
    pub(crate) fn text(&mut self, at: Place, text: &str, set: &Type) {
        let style = if set.bold { FontStyle::Bold } else { FontStyle::Normal };
        let transform = if set.turned { FontTransform::Rotate270 } else { FontTransform::None };
        let size = set.size * UNITS * BACKEND_FONT_FACTOR;
        let font = FontDesc::new(FontFamily::Name(FAMILY_WITH_FALLBACK), size, style).transform(transform);
        let anchor = match set.anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        let style = font.color(&rgb(set.colour)).into_text_style(&(0, 0)).pos(Pos::new(anchor, VPos::Bottom));
        // XML allows neither control characters nor some others, not even escaped.
        let clean: String = text.chars().filter(|&c| is_markup(c) || is_printable(c)).collect();
        self.backend.draw_text(&clean, &style, place(at)).expect(INFALLIBLE);
    }
}

/// Makes the opacity that of the ink, and turns the marks around italic type into markup.
fn finish(drawn: &str) -> String {
    let body = drawn.replace(BACKEND_SHIFT, "");
    let mut svg = String::with_capacity(body.len());
    for line in body.split_inclusive('\n') {
        if line.chars().any(is_markup) {
            for (italic, run) in runs(line.trim_end_matches('\n')) {
                if italic {
                    svg.push_str("<tspan font-style=\"italic\">");
                    svg.push_str(run);
                    svg.push_str("</tspan>");
                } else {
                    svg.push_str(run);
                }
            }
            svg.push('\n');
        } else {
            push_element(&mut svg, line);
        }
    }
    svg
}

/// Adds the line of an element, or of a text; an element has either a fill or a stroke.
fn push_element(svg: &mut String, line: &str) {
    let split = line.starts_with('<').then(|| line.split_once(BACKEND_OPACITY)).flatten();
    let Some((before, (opacity, after))) = split.and_then(|(before, rest)| Some((before, rest.split_once('"')?)))
    else {
        return svg.push_str(line);
    };
    svg.push_str(before);
    if opacity != "1" {
        let ink = if line.starts_with("<polyline") { "stroke" } else { "fill" };
        svg.extend([" ", ink, "-opacity=\"", opacity, "\""]);
    }
    svg.push_str(after);
}

fn register() {
    static ONCE: OnceLock<()> = OnceLock::new();
    ONCE.get_or_init(|| {
        for (style, bytes) in [(FontStyle::Normal, REGULAR), (FontStyle::Bold, BOLD)] {
            assert!(register_font(FAMILY, style, bytes).is_ok(), "the embedded font is a valid TrueType file");
        }
    });
}

/// Width of `text` in points at `size` points. Italic is as wide as upright in this family.
pub(crate) fn text_width(text: &str, size: f64, bold: bool) -> f64 {
    /// Widths come in whole pixels, so they are taken at a size where a pixel does not matter.
    const MEASURED_AT: f64 = 1000.0;
    register();
    let style = if bold { FontStyle::Bold } else { FontStyle::Normal };
    let font = FontDesc::new(FontFamily::Name(FAMILY), MEASURED_AT * LINE_HEIGHT_EM, style);
    let visible: String = text.chars().filter(|c| !is_markup(*c) && !is_combining(*c)).collect();
    let ((left, _), (right, _)) = font.layout_box(&visible).expect("the embedded font is registered above");
    f64::from(right - left) / MEASURED_AT * size
}

fn is_combining(c: char) -> bool {
    matches!(c, '\u{300}'..='\u{36f}')
}

#[cfg(test)]
mod tests {
    use super::*;

    // Advance widths of DejaVu Sans 2.37 in units of 1/2048 em: "A" 1401, "0" 1303.
    #[test]
    fn widths_are_those_of_the_font() {
        assert!((text_width("A", 2048.0, false) - 1401.0).abs() < 4.0, "{}", text_width("A", 2048.0, false));
        assert!((text_width("0000", 10.0, false) - 4.0 * 1303.0 / 204.8).abs() < 0.05);
        assert_eq!(text_width("K\u{302}", 10.0, false), text_width("K", 10.0, false));
        assert_eq!(text_width("", 10.0, false), 0.0);
    }
}
