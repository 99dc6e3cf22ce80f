//! From a scene to SVG, through the SVG backend of plotters. That backend works in whole pixels, so the drawing is made
//! on a canvas with many units to the point; it knows neither dashes nor mixed type, so those are added here. Text stays
//! text (it can be searched and edited), with a list of fall-back families for viewers without DejaVu Sans.

use plotters::prelude::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontDesc, FontFamily, FontStyle, FontTransform, IntoTextStyle, RGBColor, ShapeStyle};

use crate::clip;
use crate::fonts::FAMILY_WITH_FALLBACK;
use crate::palette::PAPER;
use crate::printable::is_printable;
use crate::scene::{self, Anchor, Scene, Shape, Stroke, Text};

/// Canvas units to one point on the page: 2.4 to a dot at 600 dpi, so rounding to whole units is never seen.
pub(crate) const UNITS: f64 = 20.0;
/// The SVG backend divides every font size by this.
const BACKEND_FONT_FACTOR: f64 = 1.24;
/// The SVG backend shifts the base line by this; removed, because viewers disagree on the size of an ex.
const BACKEND_SHIFT: &str = " dy=\"-0.5ex\"";
/// The SVG backend writes the opacity of a whole element, which a rasteriser answers with a layer of its own, slow for a
/// cloud of points.
const BACKEND_OPACITY: &str = " opacity=\"";
const INFALLIBLE: &str = "writing into a string cannot fail";

/// The scene as an SVG document of `width` x `height` points.
pub(crate) fn render(scene: &Scene, width: f64, height: f64) -> String {
    let canvas = (units(width).max(1) as u32, units(height).max(1) as u32);
    let mut svg = String::new();
    {
        let mut backend = SVGBackend::with_string(&mut svg, canvas);
        let (right, bottom) = (canvas.0 as i32, canvas.1 as i32);
        let page = [(0, 0), (right, 0), (right, bottom), (0, bottom)];
        backend.fill_polygon(page, &PAPER.filled()).expect(INFALLIBLE);
        for shape in scene.shapes() {
            draw(&mut backend, shape);
        }
        backend.present().expect(INFALLIBLE);
    }
    finish(&svg, canvas, width, height)
}

fn units(points: f64) -> i32 {
    (points * UNITS).round() as i32
}

fn draw(backend: &mut SVGBackend<'_>, shape: &Shape) {
    let place = |(x, y): clip::Place| (units(x), units(y));
    match shape {
        Shape::Line { points, stroke } => {
            let pattern: Vec<f64> = stroke.dash.iter().map(|l| l * stroke.width).collect();
            for part in clip::dashes(points, &pattern) {
                backend.draw_path(part.into_iter().map(place), &line_style(stroke)).expect(INFALLIBLE);
            }
        }
        Shape::Fill { points, colour, opacity } => {
            let style = colour.mix(*opacity).filled();
            backend.fill_polygon(points.iter().copied().map(place), &style).expect(INFALLIBLE);
        }
        Shape::Disc { centre, radius, colour, opacity } => {
            let style = colour.mix(*opacity).filled();
            backend.draw_circle(place(*centre), units(*radius).max(1) as u32, &style, true).expect(INFALLIBLE);
        }
        Shape::Text { place: at, text } => draw_text(backend, place(*at), text),
    }
}

fn line_style(stroke: &Stroke) -> ShapeStyle {
    ShapeStyle {
        color: stroke.colour.mix(stroke.opacity),
        filled: false,
        stroke_width: units(stroke.width).max(1) as u32,
    }
}

fn draw_text(backend: &mut SVGBackend<'_>, at: (i32, i32), text: &Text) {
    let style = if text.bold { FontStyle::Bold } else { FontStyle::Normal };
    let transform = if text.turned { FontTransform::Rotate270 } else { FontTransform::None };
    let size = text.size * UNITS * BACKEND_FONT_FACTOR;
    let font = FontDesc::new(FontFamily::Name(FAMILY_WITH_FALLBACK), size, style).transform(transform);
    let anchor = match text.anchor {
        Anchor::Start => HPos::Left,
        Anchor::Middle => HPos::Center,
        Anchor::End => HPos::Right,
    };
    let RGBColor(r, g, b) = text.colour;
    let style = font.color(&RGBColor(r, g, b)).into_text_style(&(0, 0)).pos(Pos::new(anchor, VPos::Bottom));
    // XML allows neither control characters nor some others, not even escaped.
    let clean: String = text.text.chars().filter(|&c| scene::is_markup(c) || is_printable(c)).collect();
    backend.draw_text(&clean, &style, at).expect(INFALLIBLE);
}

/// Gives the document its size on the page and round joins, makes the opacity that of the ink, and turns the marks around
/// italic type into markup.
fn finish(drawn: &str, canvas: (u32, u32), width: f64, height: f64) -> String {
    let body = drawn.split_once('>').map_or("", |(_, body)| body).replace(BACKEND_SHIFT, "");
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.3}pt\" height=\"{height:.3}pt\" \
         viewBox=\"0 0 {} {}\" stroke-linejoin=\"round\">",
        canvas.0, canvas.1
    );
    for line in body.split_inclusive('\n') {
        if line.chars().any(scene::is_markup) {
            for (italic, run) in scene::runs(line.trim_end_matches('\n')) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::{DASHED, INK};
    use crate::scene::{Layer, symbol};

    fn sample() -> String {
        let mut scene = Scene::default();
        scene.line(Layer::Data, [(10.0, 10.0), (90.0, 10.0)], Stroke::solid(INK, 0.5).dashed(DASHED));
        scene.text(Layer::Note, (10.0, 20.0), Text::new(format!("a < b & {}\u{7}\u{fffe}", symbol("ψ")), 8.0));
        render(&scene, 100.0, 30.0)
    }

    #[test]
    fn document_has_size_on_the_page_and_scaled_strokes() {
        let svg = sample();
        assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100.000pt\""));
        assert!(svg.contains("viewBox=\"0 0 2000 600\""));
        assert!(svg.contains("stroke-width=\"10\""), "0.5 points at 20 units");
        assert!(svg.matches("<polyline").count() > 15, "dashes");
        assert!(svg.trim_end().ends_with("</svg>"));
    }

    #[test]
    fn opacity_is_that_of_the_ink() {
        let mut scene = Scene::default();
        scene.disc(Layer::Data, (5.0, 5.0), 1.0, INK, 0.45);
        scene.fill(Layer::Data, [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)], INK, 0.85);
        scene.line(Layer::Data, [(0.0, 0.0), (9.0, 9.0)], Stroke { opacity: 0.55, ..Stroke::solid(INK, 0.5) });
        scene.text(Layer::Note, (0.0, 9.0), Text::new("a opacity=\"0.3\" b", 8.0));
        let svg = render(&scene, 10.0, 10.0);
        let line = |tag: &str| svg.lines().rfind(|line| line.starts_with(tag)).unwrap_or_default();
        assert!(line("<circle").contains(" fill-opacity=\"0.45\" fill=\"#"), "{svg}");
        assert!(line("<polygon").contains(" fill-opacity=\"0.85\" fill=\"#"), "{svg}");
        assert!(line("<polyline").contains(" stroke-opacity=\"0.55\" stroke=\"#"), "{svg}");
        assert!(!svg.contains(" opacity=\""), "opaque by default, and never that of an element: {svg}");
        assert!(svg.contains("a opacity=&quot;0.3&quot; b\n"), "text is left alone: {svg}");
    }

    #[test]
    fn text_is_escaped_and_italic_is_markup() {
        let svg = sample();
        assert!(svg.contains("a &lt; b &amp; <tspan font-style=\"italic\">ψ</tspan>\n"));
        assert!(!svg.contains("dy=") && !svg.contains(['\u{7}', '\u{fffe}']) && !svg.contains('\u{e000}'));
        assert!(svg.contains("font-size=\"160\""));
    }
}
