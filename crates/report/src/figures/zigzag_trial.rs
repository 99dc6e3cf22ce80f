//! Zig-zag trial with its characteristic quantities, as in the textbook figure: heading over rudder, the executes,
//! overshoot angles, initial turning time, times to check yaw and the period. All quantities are given; none is
//! computed from the curves.

use plotters::style::text_anchor::HPos;
use serde::{Deserialize, Serialize};

use super::layers;
use super::panels::{AxisLine, AxisSpec, Layer, LayerKind, PanelGroup, PanelRow, Panels, Pen};
use crate::backend::PlotResult;
use crate::canvas::{PagePoint, Stroke, TextLine};
use crate::chart::Chart;
use crate::curve::PlotCurve;
use crate::drawing::Drawing;
use crate::markup::symbol;
use crate::number;
use crate::palette::{CurveOrigin, CurveStyle, DIMENSION_LINE, HEADING, INK, Marker, RUDDER, SOLID};
use crate::theme::Theme;

/// Point of the heading curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ZigZagMark {
    /// Time, s.
    pub t_s: f64,
    /// Heading, degrees.
    pub heading_deg: f64,
}

/// Interval of time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct TimeSpan {
    /// Beginning, s.
    pub from_s: f64,
    /// End, s.
    pub to_s: f64,
}

impl TimeSpan {
    fn text(&self) -> String {
        format!("{} s", number::fixed(self.to_s - self.from_s, 1))
    }
}

/// Overshoot: heading beyond that at the execute.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct OvershootMark {
    /// Execute of the counter rudder.
    pub execute: ZigZagMark,
    /// Extremum of the heading after the execute.
    pub extremum: ZigZagMark,
    /// Overshoot angle, degrees, positive to either side.
    pub angle_deg: f64,
}

/// Data of [`super::Plot::ZigZag`].
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(rename = "ZigzagTrial")]
pub struct ZigZagPlot {
    /// Heading, degrees, against time, s.
    pub heading: PlotCurve,
    /// `true` if the heading is drawn as separate points (noisy or widely spaced) and not as a line.
    pub heading_as_points: bool,
    /// Rudder angle, degrees, against time, s.
    pub rudder: PlotCurve,
    /// Noise-free heading, degrees, against time, s.
    pub truth: Option<PlotCurve>,
    /// Executes: all orders that put the rudder over.
    pub executes: Vec<ZigZagMark>,
    /// The overshoots in order.
    pub overshoots: Vec<OvershootMark>,
    /// Initial turning time: from the first execute to the second.
    pub initial_turning: Option<TimeSpan>,
    /// Times to check yaw: from an execute of counter rudder to the next extremum of the heading.
    pub check_yaw: Vec<TimeSpan>,
    /// One full period of the manoeuvre.
    pub period: Option<TimeSpan>,
}

/// Maximum number of marked executes: with more, neither lines nor numbers could be distinguished.
const MAX_MARKED: usize = 60;

const EXECUTE: CurveStyle = CurveStyle { colour: INK, marker: Marker::Diamond, dash: SOLID, is_hollow: false };
const EXTREMUM: CurveStyle =
    CurveStyle { colour: DIMENSION_LINE, marker: Marker::Circle, dash: SOLID, is_hollow: true };

/// Height of the heading panel, as a share of the width.
const HEIGHT: f64 = 0.36;

/// Drawing of a zig-zag trial: heading with its dimension lines above, rudder below. A trial with too many executes is
/// drawn without its characteristic quantities, and a note states it.
pub(super) fn zigzag_trial(data: &ZigZagPlot, finding: &str, theme: &Theme) -> PlotResult<Drawing> {
    let count = data.executes.len();
    if count <= MAX_MARKED {
        return layers::annotated(&data.panels(theme), finding, theme, &|chart| data.annotate(chart, theme));
    }
    let curves = ZigZagPlot {
        executes: Vec::new(),
        overshoots: Vec::new(),
        initial_turning: None,
        check_yaw: Vec::new(),
        period: None,
        ..data.clone()
    };
    let note = Some(format!("{count} executes: too many to be marked."));
    layers::panels(&Panels { note, ..curves.panels(theme) }, finding, theme)
}

impl ZigZagPlot {
    /// Curves and marked points, with room above and below the heading for overshoot angles and times.
    fn panels(&self, theme: &Theme) -> Panels {
        let name = format!("heading {}", symbol("ψ"));
        let heading = match self.heading_as_points {
            true => Layer::new(format!("recorded {name}"), self.heading.clone(), LayerKind::Record),
            false => Layer::line(name, self.heading.clone(), Pen::new(HEADING)),
        };
        let truth = |curve: &PlotCurve| Layer::line("truth", curve.clone(), Pen::from_origin(&CurveOrigin::Truth));
        let marks = |name: &str, style: CurveStyle, marks: Vec<&ZigZagMark>| {
            let points = marks.iter().map(|mark| (mark.t_s, mark.heading_deg, None)).collect();
            Some(Layer::marks(name, style, points)).filter(|_| !marks.is_empty())
        };
        let extrema = self.overshoots.iter().map(|overshoot| &overshoot.extremum).collect();
        let extrema = marks("heading extremum", EXTREMUM, extrema);
        let executes = marks("execute", EXECUTE, self.executes.iter().collect());
        let heading =
            [Some(heading), self.truth.as_ref().map(truth), executes, extrema].into_iter().flatten().collect();
        let rudder = Layer::line(format!("rudder {}", symbol("δ")), self.rudder.clone(), Pen::new(RUDDER));
        let label = if self.overshoots.is_empty() { 0.0 } else { 1.4 };
        let strip = |is_drawn: bool| (label + if is_drawn { STRIP } else { 0.0 }) * theme.small_font;
        let has_times = self.initial_turning.is_some() || !self.check_yaw.is_empty();
        let room = [strip(has_times), strip(self.period.is_some())].map(|points| points / theme.panel_height(HEIGHT));
        let rows = vec![
            (PanelRow { free_shares: room, ..PanelRow::new(AxisSpec::heading(), HEIGHT) }, heading),
            (PanelRow::new(AxisSpec::rudder(), 0.13), vec![rudder]),
        ];
        let at = |mark: &ZigZagMark| AxisLine { value: mark.t_s, label: String::new() };
        let vertical_lines = self.executes.iter().filter(|mark| mark.t_s.is_finite()).map(at).collect();
        Panels::new(PanelGroup { vertical_lines, ..PanelGroup::over(AxisSpec::time(), rows) })
    }

    /// Draws overshoots, times and period. Returns the meaning of overshoots and times, with the times if they do not
    /// fit at their lines; `None` without overshoots and times.
    fn annotate(&self, chart: &Chart, theme: &Theme) -> PlotResult<Option<String>> {
        let size = theme.small_font;
        let draw = Dimensions { chart, theme };
        for (i, overshoot) in self.overshoots.iter().enumerate() {
            draw.overshoot(i + 1, overshoot)?;
        }
        if let Some(period) = &self.period {
            let y = chart.rect.y + 0.75 * STRIP * size;
            if let Some(middle) = draw.span(self, period, y)? {
                draw.label((middle, y - 0.71 * size), &format!("period {}", period.text()))?;
            }
        }
        let y = chart.rect.bottom() - 0.45 * size;
        let mut labels = Vec::new();
        let initial = self.initial_turning.iter().map(|span| (symbol("tₐ"), span));
        let check = |(i, span)| (symbol(&format!("tₛ{}", subscript(i + 1))), span);
        for (name, span) in initial.chain(self.check_yaw.iter().enumerate().map(check)) {
            let middle = draw.span(self, span, y)?;
            labels.extend(middle.map(|x| (x, name.clone(), format!("{name} = {}", span.text()))));
        }
        labels.sort_by(|a, b| a.0.total_cmp(&b.0));
        let ends = |(x, _, text): &(f64, String, String)| TextLine::new(text, size, HPos::Center).ends(*x);
        let boxes: Vec<[f64; 2]> = labels.iter().map(ends).collect();
        let fits = boxes.windows(2).all(|pair| pair[0][1] + 0.3 * size < pair[1][0])
            && boxes.iter().all(|[left, right]| *left > chart.rect.x && *right < chart.rect.right());
        for (x, name, text) in &labels {
            draw.label((*x, y - 0.76 * size), if fits { text } else { name })?;
        }
        // No-break spaces, so that the note is never broken between a symbol and its value.
        let listed: Vec<String> = labels.iter().map(|(.., text)| text.replace(' ', "\u{a0}")).collect();
        Ok(explanation(self, (!fits).then(|| listed.join(", "))))
    }
}

/// Height of the strip that holds a row of dimension lines, in small-font sizes.
const STRIP: f64 = 2.3;
/// Length of an arrow head, in small-font sizes.
const HEAD: f64 = 0.5;

/// Dimension lines as on a technical drawing: a line with an arrow at either end and the quantity next to it.
struct Dimensions<'a> {
    chart: &'a Chart,
    theme: &'a Theme,
}

impl Dimensions<'_> {
    /// Draws the line between two places; if they are too close for two heads, the heads point at them from outside.
    fn between(&self, from: PagePoint, to: PagePoint) -> PlotResult {
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        if length == 0.0 || !length.is_finite() {
            return Ok(());
        }
        let along = ((to.0 - from.0) / length, (to.1 - from.1) / length);
        let size = HEAD * self.theme.small_font;
        let (beyond, side) = if length > 2.6 * size { (0.0, 1.0) } else { (2.2 * size, -1.0) };
        let end = |(x, y): PagePoint, by: f64| (x + by * along.0, y + by * along.1);
        let canvas = &self.chart.canvas;
        canvas.line(&[end(from, -beyond), end(to, beyond)], Stroke::solid(DIMENSION_LINE, self.theme.thin))?;
        canvas.arrow_head(from, (-side * along.0, -side * along.1), size, DIMENSION_LINE)?;
        canvas.arrow_head(to, (side * along.0, side * along.1), size, DIMENSION_LINE)
    }

    /// Draws a thin line from a point of the data to its dimension line.
    fn extension(&self, from: PagePoint, to: PagePoint) -> PlotResult {
        let stroke = Stroke { opacity: 0.75, ..Stroke::solid(DIMENSION_LINE, 0.8 * self.theme.thin) };
        self.chart.canvas.line(&[from, to], stroke)
    }

    /// Writes the quantity at a dimension line.
    fn label(&self, place: PagePoint, text: &str) -> PlotResult {
        let text = TextLine { colour: DIMENSION_LINE, ..TextLine::new(text, self.theme.small_font, HPos::Center) };
        self.chart.canvas.text_with_halo(place, &text)
    }

    /// Draws the vertical dimension line from the heading of the execute to the extremum, with its angle beyond the
    /// curve.
    fn overshoot(&self, number: usize, overshoot: &OvershootMark) -> PlotResult {
        let place = |mark: &ZigZagMark| self.chart.inside(mark.t_s, mark.heading_deg);
        let (Some(peak), Some(start)) = (place(&overshoot.extremum), place(&overshoot.execute)) else { return Ok(()) };
        let size = self.theme.small_font;
        let foot = (peak.0, start.1);
        self.extension(start, (foot.0 + 0.4 * size, foot.1))?;
        self.between(foot, peak)?;
        let angle = number::fixed(overshoot.angle_deg, 1);
        let text = format!("{}OS{} = {angle}°", symbol("ψ"), subscript(number));
        let half = TextLine::new(&*text, size, HPos::Center).width() / 2.0 + 0.3 * size;
        let rect = self.chart.rect;
        let x = peak.0.clamp(rect.x + half, (rect.right() - half).max(rect.x + half));
        let beyond = if peak.1 <= foot.1 { -1.1 * size } else { 1.1 * size };
        self.label((x, peak.1 + beyond), &text)
    }

    /// Draws the horizontal dimension line of a span at `y`, with lines to the curve if a marked point is at its end.
    /// Returns the horizontal place of its middle, points; `None` if an end is outside the frame and nothing is drawn.
    fn span(&self, data: &ZigZagPlot, span: &TimeSpan, y: f64) -> PlotResult<Option<f64>> {
        let inside = |t: f64| self.chart.page_x(t).filter(|x| self.chart.rect.contains((*x, y)));
        let (Some(from), Some(to)) = (inside(span.from_s), inside(span.to_s)) else { return Ok(None) };
        let marks = data.executes.iter().chain(data.overshoots.iter().flat_map(|o| [&o.execute, &o.extremum]));
        for (t, x) in [(span.from_s, from), (span.to_s, to)] {
            let at_mark = marks.clone().find(|mark| (mark.t_s - t).abs() < 1e-9 * t.abs().max(1.0));
            self.extension((x, at_mark.and_then(|mark| self.chart.page_y(mark.heading_deg)).unwrap_or(y)), (x, y))?;
        }
        self.between((from, y), (to, y))?;
        Ok(Some(0.5 * (from + to)))
    }
}

fn explanation(data: &ZigZagPlot, values: Option<String>) -> Option<String> {
    let mut parts = Vec::new();
    if !data.overshoots.is_empty() {
        parts.push(format!("{}OS{}… overshoot angles, beyond the heading of the execute", symbol("ψ"), subscript(1)));
    }
    if data.initial_turning.is_some() {
        parts.push(format!("{} initial turning time", symbol("tₐ")));
    }
    if !data.check_yaw.is_empty() {
        parts.push(format!("{} times to check yaw", symbol("tₛ")));
    }
    if parts.is_empty() {
        return None;
    }
    let meaning = format!("{}.", parts.join(", "));
    Some(values.map_or(meaning.clone(), |values| format!("{meaning} {values}.")))
}

fn subscript(number: usize) -> String {
    let digit = |c: char| char::from_u32('₀' as u32 + c as u32 - '0' as u32).expect("₀ to ₉ are consecutive");
    number.to_string().chars().map(digit).collect()
}
