//! From a scene to SVG: shape by shape onto a [`canvas`], which knows no dashes, so a dashed line is cut here.

use crate::axis::Axis;
use crate::canvas::{self, Canvas, Type, UNITS};
use crate::clip::{self, Rect};
use crate::markup::is_markup;
use crate::palette::PAPER;
use crate::printable::is_printable;
use crate::scene::{Scene, Shape, Text};

/// The scene as an SVG document of `width` x `height` points. What the key names stands in groups of that name, and
/// empty groups say where the panels are, for a page in a browser.
pub(crate) fn render(scene: &Scene, width: f64, height: f64) -> String {
    let mut body = String::new();
    for run in scene.told().chunk_by(|one, other| one.0 == other.0) {
        let drawn = canvas::elements(width, height, |canvas| run.iter().for_each(|(_, shape)| draw(canvas, shape)));
        match run[0].0 {
            Some(name) => body.extend(["<g data-series=\"", &attribute(name), "\">\n", &drawn, "</g>\n"]),
            None => body.push_str(&drawn),
        }
    }
    body.extend(scene.panels().iter().map(String::as_str));
    canvas::document(width, height, PAPER, &body)
}

fn draw(canvas: &mut Canvas, shape: &Shape) {
    match shape {
        Shape::Line { points, stroke } => {
            let pattern: Vec<f64> = stroke.dash.iter().map(|l| l * stroke.width).collect();
            for part in clip::dashes(points, &pattern) {
                canvas.line(part, stroke.width, stroke.colour, stroke.opacity);
            }
        }
        Shape::Fill { points, colour, opacity } => canvas.fill(points, *colour, *opacity),
        Shape::Disc { centre, radius, colour, opacity } => canvas.disc(*centre, *radius, *colour, *opacity),
        Shape::Text { place, text } => canvas.text(*place, &text.text, &type_of(text)),
    }
}

/// An empty group that says where a panel is, in units of the view box, and what its axes are: kind, ends, title.
pub(crate) fn panel(rect: &Rect, x: (&Axis, &str), y: (&Axis, &str)) -> String {
    let [left, top, width, height] = [rect.x, rect.y, rect.w, rect.h].map(|points| (points * UNITS).round());
    let [x_axis, y_axis] = [x.0, y.0].map(|axis| attribute(&axis.told()));
    let [x_title, y_title] = [x.1, y.1].map(attribute);
    format!(
        "<g data-panel=\"{left} {top} {width} {height}\" data-x=\"{x_axis}\" data-y=\"{y_axis}\" \
         data-x-title=\"{x_title}\" data-y-title=\"{y_title}\"/>\n"
    )
}

/// Words as the value of an attribute.
fn attribute(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars().filter(|&c| !is_markup(c) && is_printable(c)) {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c => out.push(c),
        }
    }
    out
}

fn type_of(text: &Text) -> Type {
    let Text { size, colour, bold, anchor, turned, .. } = *text;
    Type { size, colour, bold, anchor, turned }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::markup::symbol;
    use crate::palette::{DASHED, INK};
    use crate::scene::{Layer, Stroke};

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
