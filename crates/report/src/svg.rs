//! From a scene to SVG. Coordinates are whole numbers, many to the point. Lines of one stroke that follow each other
//! are one path, and so are dots of one size and colour: a browser is slow with many elements, and a page carries more
//! figures. Text stays text, which can be searched and edited.

use std::fmt::Write as _;

use crate::axis::PlotAxis;
use crate::changes::Changes;
use crate::clip::{PagePoint, Rect};
use crate::fonts::FAMILY_WITH_FALLBACK;
use crate::markup::{is_markup, runs};
use crate::paint::Paint;
use crate::palette::PAPER;
use crate::printable::is_printable;
use crate::scene::{Anchor, Canvas, CanvasShape, Stroke, TextLine};

/// Units to one point on the page: 2.4 to a dot at 600 dpi, so rounding to whole units is never seen.
pub(crate) const UNITS: f64 = 20.0;

/// Most times the pattern of a dashed line is repeated. A line as long as that goes to and fro until it is a band, in
/// which nobody sees dashes.
const MOST_REPEATS: f64 = 5000.0;

/// The scene as an SVG document of `width` x `height` points. What the key names stands in groups of that name, and
/// empty groups say where the panels are, for a page in a browser.
pub(crate) fn render(scene: &Canvas, width: f64, height: f64, changes: &Changes) -> String {
    let [across, down] = [width, height].map(|points| units(points).max(1));
    let mut page = Elements { out: String::new(), open: None, changes };
    page.polygon(&[(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)], PAPER, 1.0);
    for run in scene.shapes_by_series().chunk_by(|one, other| one.0 == other.0) {
        if let Some(name) = run[0].0 {
            page.put(&format!("<g data-series=\"{}\">\n", escaped(name)));
        }
        run.iter().for_each(|(_, shape)| page.shape(shape));
        page.put(if run[0].0.is_some() { "</g>\n" } else { "" });
    }
    scene.panels().iter().for_each(|panel| page.put(panel));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.3}pt\" height=\"{height:.3}pt\" \
         viewBox=\"0 0 {across} {down}\">\n<g font-family=\"{FAMILY_WITH_FALLBACK}\" \
         stroke-linejoin=\"bevel\">\n{}</g>\n</svg>\n",
        page.out
    )
}

fn units(points: f64) -> i64 {
    (points * UNITS).round() as i64
}

/// A document in the making.
struct Elements<'a> {
    out: String,
    /// Style and data of the path that is being lengthened.
    open: Option<(String, String)>,
    changes: &'a Changes,
}

impl Elements<'_> {
    /// Writes an element, after the path that was open.
    fn put(&mut self, element: &str) {
        if let Some((style, data)) = self.open.take() {
            let _ = writeln!(self.out, "<path {style} d=\"{data}\"/>");
        }
        self.out.push_str(element);
    }

    /// Lengthens the open path, or begins one. Where ink adds up (`alone`), lines stay apart.
    fn path(&mut self, style: String, data: &str, alone: bool) {
        match &mut self.open {
            Some((known, longer)) if *known == style && !alone => longer.push_str(data),
            _ => {
                self.put("");
                self.open = Some((style, data.to_owned()));
            }
        }
    }

    fn colour(&self, colour: Paint) -> String {
        let Paint(red, green, blue) = self.changes.of(colour);
        format!("#{red:02X}{green:02X}{blue:02X}")
    }

    fn shape(&mut self, shape: &CanvasShape) {
        match shape {
            CanvasShape::Line { points, stroke } => self.line(points, stroke),
            CanvasShape::Fill { points, colour, opacity } => self.polygon(points, *colour, *opacity),
            CanvasShape::Disc { centre: (x, y), radius, colour, opacity } => {
                let (colour, width) = (self.colour(*colour), 2 * units(*radius).max(1));
                let faint = opacity_of("stroke", *opacity);
                let style = format!("stroke=\"{colour}\"{faint} stroke-width=\"{width}\" stroke-linecap=\"round\"");
                self.path(style, &format!("M{} {}h0", units(*x), units(*y)), *opacity < 1.0);
            }
            CanvasShape::Text { place, text } => self.text(*place, text),
        }
    }

    fn line(&mut self, points: &[PagePoint], stroke: &Stroke) {
        let colour = self.colour(stroke.colour);
        let width = units(stroke.width).max(1);
        let mut style = format!("fill=\"none\" stroke=\"{colour}\"{}", opacity_of("stroke", stroke.opacity));
        let _ = write!(style, " stroke-width=\"{width}\"");
        let length: f64 = points.windows(2).map(|ends| (ends[1].0 - ends[0].0).hypot(ends[1].1 - ends[0].1)).sum();
        let pattern: f64 = stroke.dash.iter().sum::<f64>() * stroke.width;
        if pattern > 0.0 && length < MOST_REPEATS * pattern {
            let dashes: Vec<String> = stroke.dash.iter().map(|part| units(part * stroke.width).to_string()).collect();
            let _ = write!(style, " stroke-dasharray=\"{}\"", dashes.join(" "));
        }
        let mut data = String::new();
        let mut last = (0, 0);
        for (number, &(x, y)) in points.iter().enumerate() {
            let place = (units(x), units(y));
            let _ = match number {
                0 => write!(data, "M{} {}l", place.0, place.1),
                1 => write!(data, "{} {}", place.0 - last.0, place.1 - last.1),
                _ => write!(data, " {} {}", place.0 - last.0, place.1 - last.1),
            };
            last = place;
        }
        self.path(style, &data, stroke.opacity < 1.0);
    }

    fn polygon(&mut self, points: &[PagePoint], colour: Paint, opacity: f64) {
        let corners: Vec<String> = points.iter().map(|(x, y)| format!("{},{}", units(*x), units(*y))).collect();
        let (colour, faint) = (self.colour(colour), opacity_of("fill", opacity));
        self.put(&format!("<polygon fill=\"{colour}\"{faint} points=\"{}\"/>\n", corners.join(" ")));
    }

    /// A line of text with its base line at a place.
    fn text(&mut self, (x, y): PagePoint, text: &TextLine) {
        let (x, y) = (units(x), units(y));
        let size = (10.0 * text.size * UNITS).round() / 10.0;
        let mut element =
            format!("<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"{}\"", self.colour(text.colour));
        element += match text.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        element += if text.bold { " font-weight=\"bold\"" } else { "" };
        if text.turned {
            let _ = write!(element, " transform=\"rotate(270, {x}, {y})\"");
        }
        element += ">\n";
        for (italic, run) in runs(&text.text) {
            let run = escaped(run);
            let _ = match italic {
                true => write!(element, "<tspan font-style=\"italic\">{run}</tspan>"),
                false => write!(element, "{run}"),
            };
        }
        self.put(&(element + "\n</text>\n"));
    }
}

/// An attribute for ink that is not opaque: that of an element would be a layer of its own, slow to draw.
fn opacity_of(ink: &str, opacity: f64) -> String {
    if opacity < 1.0 { format!(" {ink}-opacity=\"{opacity}\"") } else { String::new() }
}

/// An empty group that says where a panel is, in units of the view box, and what its axes are: kind, ends, title.
pub(crate) fn panel(rect: &Rect, x: (&PlotAxis, &str), y: (&PlotAxis, &str)) -> String {
    let [left, top, width, height] = [rect.x, rect.y, rect.w, rect.h].map(units);
    let [x_axis, y_axis] = [x.0, y.0].map(|axis| escaped(&axis.described()));
    let [x_title, y_title] = [x.1, y.1].map(escaped);
    format!(
        "<g data-panel=\"{left} {top} {width} {height}\" data-x=\"{x_axis}\" data-y=\"{y_axis}\" \
         data-x-title=\"{x_title}\" data-y-title=\"{y_title}\"/>\n"
    )
}

/// Words as text or as the value of an attribute. XML allows neither control characters nor some others, not even
/// escaped.
fn escaped(text: &str) -> String {
    let clean: String = text.chars().filter(|&c| !is_markup(c) && is_printable(c)).collect();
    crate::html::escaped(&clean)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::markup::symbol;
    use crate::palette::{DASHED, INK};
    use crate::scene::{Layer, Stroke};

    fn drawn(fill: impl FnOnce(&mut Canvas)) -> String {
        let mut scene = Canvas::default();
        fill(&mut scene);
        render(&scene, 100.0, 30.0, &Changes::default())
    }

    #[test]
    fn a_document_has_its_size_on_the_page_and_scaled_strokes() {
        let svg = drawn(|scene| {
            scene.line(Layer::Data, [(10.0, 10.0), (90.0, 10.0)], Stroke::solid(INK, 0.5).dashed(DASHED));
        });
        assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100.000pt\""));
        assert!(svg.contains("viewBox=\"0 0 2000 600\""));
        assert!(svg.contains("stroke-width=\"10\" stroke-dasharray=\"50 25\" d=\"M200 200l1600 0\"/>"), "{svg}");
        assert!(svg.trim_end().ends_with("</svg>"));
    }

    #[test]
    fn what_follows_each_other_in_one_style_is_one_path() {
        let svg = drawn(|scene| {
            let stroke = Stroke::solid(INK, 1.0);
            scene.line(Layer::Data, [(1.0, 2.0), (4.0, 6.0), (3.0, 6.0)], stroke);
            scene.line(Layer::Data, [(9.0, 9.0), (9.0, 0.0)], stroke);
            scene.line(Layer::Data, [(0.0, 0.0), (9.0, 9.0)], Stroke { opacity: 0.55, ..stroke });
            scene.line(Layer::Data, [(0.0, 0.0), (9.0, 9.0)], Stroke { opacity: 0.55, ..stroke });
            scene.disc(Layer::Data, (3.0, 4.0), 5.0, INK, 1.0);
            scene.disc(Layer::Data, (3.0, 5.0), 5.0, INK, 1.0);
            scene.fill(Layer::Data, [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)], INK, 0.85);
        });
        assert!(svg.contains("d=\"M20 40l60 80 -20 0M180 180l0 -180\"/>"), "{svg}");
        assert_eq!(svg.matches(" stroke-opacity=\"0.55\"").count(), 2, "where ink adds up, lines stay apart: {svg}");
        assert!(svg.contains("stroke-width=\"200\" stroke-linecap=\"round\" d=\"M60 80h0M60 100h0\"/>"), "{svg}");
        assert!(svg.contains("<polygon fill=\"#111111\" fill-opacity=\"0.85\""), "{svg}");
    }

    #[test]
    fn a_dashed_line_that_fills_an_area_is_solid() {
        let band: Vec<PagePoint> = (0..4000).map(|i| (0.02 * f64::from(i), f64::from(i % 2) * 29.0)).collect();
        let svg = drawn(|scene| scene.line(Layer::Data, band, Stroke::solid(INK, 1.0).dashed(DASHED)));
        assert!(!svg.contains("dasharray"));
    }

    #[test]
    fn text_is_escaped_and_italic_is_markup() {
        let text = TextLine::new(format!("a < b & {}\u{7}\u{fffe}", symbol("ψ")), 8.0);
        let svg = drawn(|scene| scene.text(Layer::Note, (10.0, 20.0), text));
        assert!(svg.contains("\na &lt; b &amp; <tspan font-style=\"italic\">ψ</tspan>\n"), "{svg}");
        assert!(!svg.contains(['\u{7}', '\u{fffe}', '\u{e000}']) && svg.contains("font-size=\"160\""));
    }
}
