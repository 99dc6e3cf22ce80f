//! Drawing backend of plotters that writes SVG: coordinates in twentieths of a point, text measured with the embedded
//! font. No other module writes SVG elements. Successive lines of one stroke are one path, and so are filled circles of
//! one size: a browser is slow with many elements. Text stays text, so that it can be searched.

use std::cell::RefCell;
use std::convert::Infallible;
use std::fmt::Write as _;
use std::rc::Rc;
use std::sync::Arc;

use plotters::drawing::DrawingAreaErrorKind;
use plotters::style::{Color as _, RGBColor};
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontStyle,
    FontTransform,
};

use crate::changes::StyleChanges;
use crate::fonts::{FAMILY_WITH_FALLBACK, LINE_SPACING, text_width};
use crate::markup::{is_markup, runs};
use crate::palette::BACKGROUND;
use crate::printable::is_printable;
pub(crate) use crate::svg_group::{Bounds, SvgGroup};

/// Units per point on the page: 2.4 per dot at 600 dpi, so rounding to whole units is invisible.
pub(crate) const UNITS_PER_POINT: f64 = 20.0;

/// Height of the drawing sheet, units; the page ends where the figure ends.
const TALLEST: u32 = 2_000_000;

/// Maximum number of repetitions of a dash pattern. A longer line oscillates so densely that it is a band without
/// visible dashes.
const MAX_REPEATS: f64 = 5000.0;

/// Result of drawing; writing to memory does not fail.
pub(crate) type PlotResult<T = ()> = Result<T, DrawingAreaErrorKind<Infallible>>;

type BackendResult = Result<(), DrawingErrorKind<Infallible>>;

/// Length in units of the SVG, rounded, from a length in points.
pub(crate) fn units(points: f64) -> i32 {
    (points * UNITS_PER_POINT).round() as i32
}

/// Group that is being filled.
struct OpenGroup {
    group: SvgGroup,
    /// Offset of its first element in the document.
    start: usize,
    /// `true` if an element reaches beyond the clip rectangle.
    is_beyond: bool,
}

/// Document that is being written.
struct SvgDocument {
    elements: String,
    /// Style and data of the open path.
    path: Option<(String, String)>,
    group: Option<OpenGroup>,
    changes: Arc<StyleChanges>,
}

/// SVG backend. Clones write into the same document.
#[derive(Clone)]
pub(crate) struct Svg {
    width: u32,
    document: Rc<RefCell<SvgDocument>>,
}

impl Svg {
    /// An empty sheet of this width in points.
    pub(crate) fn new(width: f64, changes: Arc<StyleChanges>) -> Self {
        let document = SvgDocument { elements: String::new(), path: None, group: None, changes };
        Self { width: units(width).max(1) as u32, document: Rc::new(RefCell::new(document)) }
    }

    /// Begins a group, which ends with [`Self::end`]; groups do not nest.
    pub(crate) fn begin(&self, group: SvgGroup) {
        let mut document = self.document.borrow_mut();
        document.close_path();
        let start = document.elements.len();
        document.group = Some(OpenGroup { group, start, is_beyond: false });
    }

    /// Ends the group and writes it, unless it is empty.
    pub(crate) fn end(&self) {
        self.document.borrow_mut().close_group();
    }

    /// Writes an empty group with the place of a panel and its axes: kind, ends and title of either axis.
    pub(crate) fn panel(&self, [left, top, right, bottom]: Bounds, axes: [(String, &str); 2]) {
        let [(x, x_title), (y, y_title)] = axes.map(|(axis, title)| (escaped(&axis), escaped(title)));
        let (width, height) = (right - left, bottom - top);
        self.document.borrow_mut().put(&format!(
            "<g data-panel=\"{left} {top} {width} {height}\" data-x=\"{x}\" data-y=\"{y}\" \
             data-x-title=\"{x_title}\" data-y-title=\"{y_title}\"/>\n"
        ));
    }

    /// The SVG document, `height` points high.
    pub(crate) fn finish(&self, height: f64) -> String {
        let mut document = self.document.borrow_mut();
        document.close_group();
        let (across, down) = (self.width, units(height).max(1));
        let paper = document.colour(BACKGROUND.to_backend_color());
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.3}pt\" height=\"{height:.3}pt\" \
             viewBox=\"0 0 {across} {down}\">\n<g font-family=\"{FAMILY_WITH_FALLBACK}\" stroke-linejoin=\"bevel\">\n\
             <polygon fill=\"{paper}\" points=\"0,0 {across},0 {across},{down} 0,{down}\"/>\n{}</g>\n</svg>\n",
            f64::from(across) / UNITS_PER_POINT,
            document.elements
        )
    }
}

impl SvgDocument {
    fn close_path(&mut self) {
        if let Some((style, data)) = self.path.take() {
            let _ = writeln!(self.elements, "<path {style} d=\"{data}\"/>");
        }
    }

    /// Writes an element, after closing the open path.
    fn put(&mut self, element: &str) {
        self.close_path();
        self.elements.push_str(element);
    }

    /// Extends the open path, or begins another. If the style is translucent (`alone`), lines stay separate.
    fn lengthen(&mut self, style: String, data: &str, alone: bool) {
        match &mut self.path {
            Some((open, longer)) if *open == style && !alone => longer.push_str(data),
            _ => {
                self.close_path();
                self.path = Some((style, data.to_owned()));
            }
        }
    }

    fn close_group(&mut self) {
        self.close_path();
        let Some(OpenGroup { group, start, is_beyond }) = self.group.take() else { return };
        let elements = self.elements.split_off(start);
        if elements.is_empty() {
            return;
        }
        let mut attributes = String::new();
        if let Some(name) = &group.series {
            let _ = write!(attributes, " data-series=\"{}\"", escaped(name));
            attributes += if group.is_interval { " data-interval=\"\"" } else { "" };
        }
        if let Some((dash, width)) = group.dash.filter(|(dash, _)| !dash.is_empty()) {
            let parts: Vec<String> = dash.iter().map(|part| units(part * width).to_string()).collect();
            let _ = write!(attributes, " stroke-dasharray=\"{}\"", parts.join(" "));
        }
        if let Some(width) = group.halo {
            let (paper, width) = (self.colour(BACKGROUND.to_backend_color()), units(2.0 * width));
            let _ = write!(
                attributes,
                " stroke=\"{paper}\" stroke-width=\"{width}\" stroke-linejoin=\"round\" paint-order=\"stroke\""
            );
        }
        // Clipping costs the rasteriser a layer, so only groups that reach beyond the rectangle are clipped.
        if let Some([left, top, right, bottom]) = group.clip.filter(|_| is_beyond) {
            let (width, height) = (right - left, bottom - top);
            // Groups of one name have the same clip rectangle.
            let name = format!("clip-{left}-{top}-{width}-{height}");
            let _ = write!(attributes, " clip-path=\"url(#{name})\"");
            let path = format!(
                "<clipPath id=\"{name}\"><rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"/></clipPath>\n"
            );
            if !self.elements.contains(&path) {
                self.elements.push_str(&path);
            }
        }
        let _ = match attributes.is_empty() {
            true => write!(self.elements, "{elements}"),
            false => write!(self.elements, "<g{attributes}>\n{elements}</g>\n"),
        };
    }

    fn colour(&self, colour: BackendColor) -> String {
        let (red, green, blue) = colour.rgb;
        let RGBColor(red, green, blue) = self.changes.replacement(RGBColor(red, green, blue));
        format!("#{red:02X}{green:02X}{blue:02X}")
    }

    /// Records whether an element reaches beyond the clip rectangle of its group.
    fn reach(&mut self, (x, y): BackendCoord, radius: i32) {
        if let Some(OpenGroup { group: SvgGroup { clip: Some(clip), .. }, is_beyond, .. }) = &mut self.group {
            let [left, top, right, bottom] = *clip;
            *is_beyond |= x - radius < left || y - radius < top || x + radius > right || y + radius > bottom;
        }
    }

    fn line(&mut self, points: &[BackendCoord], style: &impl BackendStyle) {
        let (ink, width) = (style.color(), style.stroke_width());
        if points.len() < 2 {
            return;
        }
        points.iter().for_each(|point| self.reach(*point, 0));
        let steps = || points.windows(2).map(|ends| (ends[1].0 - ends[0].0, ends[1].1 - ends[0].1));
        let length: f64 = steps().map(|(dx, dy)| f64::from(dx).hypot(f64::from(dy))).sum();
        let dash = self.group.as_ref().and_then(|open| open.group.dash);
        let pattern = dash.map_or(0.0, |(dash, width)| dash.iter().sum::<f64>() * width * UNITS_PER_POINT);
        let solid = pattern > 0.0 && length > MAX_REPEATS * pattern;
        let (colour, faint) = (self.colour(ink), opacity("stroke", ink.alpha));
        let solid = if solid { " stroke-dasharray=\"none\"" } else { "" };
        let attributes = format!("fill=\"none\" stroke=\"{colour}\"{faint} stroke-width=\"{width}\"{solid}");
        let steps: Vec<String> = steps().map(|(dx, dy)| format!("{dx} {dy}")).collect();
        self.lengthen(attributes, &format!("M{} {}l{}", points[0].0, points[0].1, steps.join(" ")), ink.alpha < 1.0);
    }
}

impl DrawingBackend for Svg {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.width, TALLEST)
    }

    fn ensure_prepared(&mut self) -> BackendResult {
        Ok(())
    }

    fn present(&mut self) -> BackendResult {
        Ok(())
    }

    fn draw_pixel(&mut self, at: BackendCoord, colour: BackendColor) -> BackendResult {
        self.draw_circle(at, 1, &colour, true)
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> BackendResult {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
        fill: bool,
    ) -> BackendResult {
        let corners = [from, (to.0, from.1), to, (from.0, to.1)];
        match fill {
            true => self.fill_polygon(corners, style),
            // The first corner is repeated and passed, so that it gets a join like the others.
            false => self.draw_path(corners.into_iter().chain([from, corners[1]]), style),
        }
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> BackendResult {
        let mut points: Vec<BackendCoord> = path.into_iter().collect();
        points.dedup();
        self.document.borrow_mut().line(&points, style);
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> BackendResult {
        let ink = style.color();
        let points: Vec<BackendCoord> = path.into_iter().collect();
        if ink.alpha == 0.0 || points.len() < 3 {
            return Ok(());
        }
        let mut document = self.document.borrow_mut();
        points.iter().for_each(|point| document.reach(*point, 0));
        let corners: Vec<String> = points.iter().map(|(x, y)| format!("{x},{y}")).collect();
        let (colour, faint) = (document.colour(ink), opacity("fill", ink.alpha));
        document.put(&format!("<polygon fill=\"{colour}\"{faint} points=\"{}\"/>\n", corners.join(" ")));
        Ok(())
    }

    /// Draws a disc. A ring, which plotters draws at the value of an error bar, would be below its mark and is omitted.
    fn draw_circle<S: BackendStyle>(&mut self, at: BackendCoord, radius: u32, style: &S, fill: bool) -> BackendResult {
        let ink = style.color();
        let mut document = self.document.borrow_mut();
        if fill {
            document.reach(at, radius as i32);
            let (colour, faint, width) = (document.colour(ink), opacity("stroke", ink.alpha), 2 * radius.max(1));
            let attributes = format!("stroke=\"{colour}\"{faint} stroke-width=\"{width}\" stroke-linecap=\"round\"");
            document.lengthen(attributes, &format!("M{} {}h0", at.0, at.1), ink.alpha < 1.0);
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, (x, y): BackendCoord) -> BackendResult {
        let mut document = self.document.borrow_mut();
        let (size, count) = (style.size(), text.split('\n').count());
        let below = LINE_SPACING * size * (count - 1) as f64;
        // From the anchor to the base line of the first line.
        let first = match style.anchor().v_pos {
            VPos::Top => 0.8 * size,
            VPos::Center => 0.36 * size - 0.5 * below,
            VPos::Bottom => -0.22 * size - below,
        };
        let anchor = match style.anchor().h_pos {
            HPos::Left => "",
            HPos::Center => " text-anchor=\"middle\"",
            HPos::Right => " text-anchor=\"end\"",
        };
        let bold = if matches!(style.style(), FontStyle::Bold) { " font-weight=\"bold\"" } else { "" };
        let turned = |degrees: u32| format!(" transform=\"rotate({degrees}, {x}, {y})\"");
        let turn = match style.transform() {
            FontTransform::None => String::new(),
            FontTransform::Rotate90 => turned(90),
            FontTransform::Rotate180 => turned(180),
            FontTransform::Rotate270 => turned(270),
        };
        let (fill, font) = (document.colour(style.color()), (10.0 * size).round() / 10.0);
        for (number, line) in text.split('\n').enumerate().filter(|(_, line)| !line.trim().is_empty()) {
            let base = (f64::from(y) + first + LINE_SPACING * size * number as f64).round();
            let run = |(is_italic, run): (bool, &str)| match is_italic {
                true => format!("<tspan font-style=\"italic\">{}</tspan>", escaped(run)),
                false => escaped(run),
            };
            let spans: String = runs(line).into_iter().map(run).collect();
            let attributes = format!("x=\"{x}\" y=\"{base}\" font-size=\"{font}\" fill=\"{fill}\"{anchor}{bold}{turn}");
            document.put(&format!("<text {attributes}>\n{spans}\n</text>\n"));
        }
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let (size, bold) = (style.size(), matches!(style.style(), FontStyle::Bold));
        let widest = text.split('\n').map(|line| text_width(line, size, bold)).fold(0.0, f64::max);
        Ok((widest.ceil() as u32, (LINE_SPACING * size * text.split('\n').count() as f64).ceil() as u32))
    }
}

/// Opacity attribute of translucent ink; empty for opaque ink. An attribute of the whole element would need a separate
/// layer, slow to draw.
fn opacity(ink: &str, alpha: f64) -> String {
    if alpha < 1.0 { format!(" {ink}-opacity=\"{alpha}\"") } else { String::new() }
}

/// Text escaped for an element or the value of an attribute, without the characters that XML does not allow even if
/// escaped, such as control characters.
fn escaped(text: &str) -> String {
    let clean: String = text.chars().filter(|&c| !is_markup(c) && is_printable(c)).collect();
    crate::html::escaped(&clean)
}

#[cfg(test)]
mod tests {
    use plotters::coord::Shift;
    use plotters::drawing::{DrawingArea, IntoDrawingArea as _};
    use plotters::element::{Circle, PathElement, Polygon};
    use plotters::style::text_anchor::HPos;

    use super::*;
    use crate::canvas::{Stroke, TextLine};
    use crate::markup::symbol;
    use crate::palette::{DASHED, INK};

    fn drawn(fill: impl FnOnce(&DrawingArea<Svg, Shift>, &Svg) -> PlotResult) -> String {
        let svg = Svg::new(100.0, Arc::default());
        fill(&svg.clone().into_drawing_area(), &svg).unwrap();
        svg.finish(30.0)
    }

    fn line(points: &[BackendCoord]) -> PathElement<BackendCoord> {
        PathElement::new(points.to_vec(), Stroke::solid(INK, 0.5).style())
    }

    #[test]
    fn what_follows_each_other_in_one_style_is_one_path() {
        let svg = drawn(|area, _| {
            area.draw(&line(&[(20, 40), (80, 120), (80, 120), (60, 120)]))?;
            area.draw(&line(&[(180, 180), (180, 0)]))?;
            let faint = Stroke { opacity: 0.55, ..Stroke::solid(INK, 1.0) }.style();
            area.draw(&PathElement::new(vec![(0, 0), (9, 9)], faint))?;
            area.draw(&PathElement::new(vec![(0, 0), (9, 9)], faint))?;
            area.draw(&Circle::new((60, 80), 5, INK.filled()))?;
            area.draw(&Circle::new((60, 100), 5, INK.filled()))?;
            area.draw(&Polygon::new(vec![(0, 0), (1, 0), (1, 1)], INK.mix(0.85)))
        });
        assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100.000pt\" height=\"30.000pt\""));
        assert!(svg.contains("viewBox=\"0 0 2000 600\"") && svg.ends_with("</g>\n</svg>\n"));
        assert!(svg.contains("stroke-width=\"10\" d=\"M20 40l60 80 -20 0M180 180l0 -180\"/>"), "{svg}");
        assert_eq!(svg.matches(" stroke-opacity=\"0.55\"").count(), 2, "where ink adds up, lines stay apart: {svg}");
        assert!(svg.contains("stroke-width=\"10\" stroke-linecap=\"round\" d=\"M60 80h0M60 100h0\"/>"), "{svg}");
        assert!(svg.contains("<polygon fill=\"#111111\" fill-opacity=\"0.85\" points=\"0,0 1,0 1,1\""), "{svg}");
    }

    #[test]
    fn a_group_has_its_name_its_dashes_and_is_cut_where_it_reaches_beyond() {
        let grouped = |points: &[BackendCoord]| {
            let group =
                SvgGroup { dash: Some((DASHED, 0.5)), clip: Some([0, 0, 100, 50]), ..SvgGroup::named(Some("a < b")) };
            drawn(|area, svg| {
                svg.begin(group);
                area.draw(&line(points))?;
                svg.end();
                svg.begin(SvgGroup::named(Some("empty")));
                svg.end();
                Ok(())
            })
        };
        let (inside, beyond) = (grouped(&[(0, 0), (100, 50)]), grouped(&[(0, 0), (101, 50)]));
        assert!(inside.contains("<g data-series=\"a &lt; b\" stroke-dasharray=\"50 25\">\n<path"), "{inside}");
        assert!(!inside.contains("clip") && !inside.contains("empty"));
        assert!(
            beyond.contains("<clipPath id=\"clip-0-0-100-50\"><rect x=\"0\" y=\"0\" width=\"100\" height=\"50\"/>")
        );
        assert!(beyond.contains(" clip-path=\"url(#clip-0-0-100-50)\">"), "{beyond}");
        let haloed = drawn(|area, svg| {
            svg.begin(SvgGroup { halo: Some(0.5), ..SvgGroup::default() });
            area.draw(&line(&[(0, 0), (1, 1)]))?;
            svg.end();
            Ok(())
        });
        assert!(haloed.contains("<g stroke=\"#FFFFFF\" stroke-width=\"20\" stroke-linejoin=\"round\" paint-order"));
        // A dashed line that fills an area is solid.
        let band: Vec<BackendCoord> = (0..4000).map(|i| (i / 4, i % 2 * 500)).collect();
        assert!(grouped(&band).contains("stroke-dasharray=\"none\""));
    }

    #[test]
    fn text_is_escaped_and_stands_where_its_anchor_is() {
        let text = TextLine::new(format!("a < b & {}\u{7}\u{fffe}\nsecond", symbol("ψ")), 8.0, HPos::Left);
        let svg =
            drawn(|area, _| area.draw(&plotters::element::Text::new(text.text.clone(), (200, 400), text.style())));
        assert!(svg.contains("\na &lt; b &amp; <tspan font-style=\"italic\">ψ</tspan>\n"), "{svg}");
        assert!(!svg.contains(['\u{7}', '\u{fffe}', '\u{e000}']) && svg.contains("font-size=\"160\""));
        // Centred on the middle of its two lines, which are 1.15 font sizes apart.
        assert!(svg.contains("x=\"200\" y=\"366\"") && svg.contains("x=\"200\" y=\"550\""), "{svg}");
    }
}
