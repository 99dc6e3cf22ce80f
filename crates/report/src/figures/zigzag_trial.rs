//! A zig-zag trial with its characteristic quantities drawn in, as in the textbook figure: heading over rudder, the
//! executes, overshoot angles, initial turning time, times to check yaw and the period. All quantities are handed in;
//! nothing is searched for in the curves.

use serde::{Deserialize, Serialize};

use super::panels::Ruler;
use plotters::style::Color as _;

use crate::axis::{self, Axis, Division};
use crate::backend::Drawn;
use crate::canvas::{Anchor, Rect, Stroke, TextLine, at, marker};
use crate::chart::Chart;
use crate::curve::PlotCurve;
use crate::dimension::Dimensions;
use crate::figure::Drawing;
use crate::key::{KeyEntry, KeySample, stroke_of};
use crate::markup::symbol;
use crate::number;
use crate::palette::{CurveOrigin, DIMENSION, DOTTED, HEADING, INK, Look, Marker, RECORD, RUDDER, SOLID};
use crate::sheet::{AxisSide, Grid, Sheet};
use crate::theme::Theme;

/// A point of the heading curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ZigZagMark {
    /// Time, s.
    pub t_s: f64,
    /// Heading, degrees.
    pub heading_deg: f64,
}

/// A stretch of time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct TimeSpan {
    /// Begin, s.
    pub from_s: f64,
    /// End, s.
    pub to_s: f64,
}

impl TimeSpan {
    fn text(&self) -> String {
        format!("{} s", number::fixed(self.to_s - self.from_s, 1))
    }
}

/// How far the heading runs on after the rudder is reversed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct OvershootMark {
    /// Where the counter rudder is ordered.
    pub execute: ZigZagMark,
    /// Where the heading turns back.
    pub extremum: ZigZagMark,
    /// The overshoot angle, degrees, positive to either side.
    pub angle_deg: f64,
}

/// What [`super::Plot::ZigZag`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ZigzagTrial {
    /// Title above the figure.
    pub title: Option<String>,
    /// Heading, degrees over seconds.
    pub heading: PlotCurve,
    /// Whether the heading is drawn as separate points (noisy or widely spaced) and not as a line.
    pub heading_as_points: bool,
    /// Rudder angle, degrees over seconds.
    pub rudder: PlotCurve,
    /// Noise-free heading, degrees over seconds.
    pub truth: Option<PlotCurve>,
    /// The executes: every order that puts the rudder over.
    pub executes: Vec<ZigZagMark>,
    /// The overshoots in order.
    pub overshoots: Vec<OvershootMark>,
    /// Initial turning time: from the first execute to the second.
    pub initial_turning: Option<TimeSpan>,
    /// Times to check yaw: from an execute of counter rudder to the extremum that follows.
    pub check_yaw: Vec<TimeSpan>,
    /// A full period of the manoeuvre.
    pub period: Option<TimeSpan>,
}

/// Most executes that are marked: of more than that neither lines nor figures could be told apart.
const MOST_MARKED: usize = 60;

const EXECUTE: Look = Look { colour: INK, marker: Marker::Diamond, dash: SOLID, hollow: false };
const EXTREMUM: Look = Look { colour: DIMENSION, marker: Marker::Circle, dash: SOLID, hollow: true };

/// Draws a zig-zag trial: heading with its dimension lines above, rudder below. A trial of very many executes is drawn
/// without its characteristic quantities, and a note says so.
pub(super) fn zigzag_trial(data: &ZigzagTrial, theme: &Theme) -> Drawn<Drawing> {
    if data.executes.len() > MOST_MARKED {
        let curves = ZigzagTrial {
            title: data.title.clone(),
            heading: data.heading.clone(),
            heading_as_points: data.heading_as_points,
            rudder: data.rudder.clone(),
            truth: data.truth.clone(),
            ..ZigzagTrial::default()
        };
        return with_note(&curves, Some(format!("{} executes: too many to be marked.", data.executes.len())), theme);
    }
    with_note(data, None, theme)
}

fn with_note(data: &ZigzagTrial, note: Option<String>, theme: &Theme) -> Drawn<Drawing> {
    let mut sheet = Sheet::new(theme, data.title.as_deref())?;
    sheet.legend(&entries(data, theme))?;
    let height = theme.tall(0.36);
    let curves = [&data.heading, &data.rudder].into_iter().chain(&data.truth);
    let rudder = Axis::covering(data.rudder.finite().map(|(_, y)| y), 0.12, Division::Angle);
    let rows = vec![
        (heading_side(data, height, theme), height),
        (AxisSide::new(rudder, Ruler::rudder().title), theme.tall(0.13)),
    ];
    let times = curves.flat_map(|curve| curve.finite().map(|(t, _)| t));
    let time = AxisSide::new(Axis::covering(times, 0.0, Division::Time), Ruler::time().title);
    let charts = sheet.grid(Grid::new(vec![time], rows))?;
    let [upper, lower] = &charts[..] else { return Ok(sheet.finish()) };

    for chart in &charts {
        let stroke = Stroke::solid(RECORD, theme.thin).dashed(DOTTED);
        data.executes.iter().try_for_each(|execute| chart.vertical(None, execute.t_s, stroke))?;
    }
    let entries = entries(data, theme);
    let name = |number: usize| entries.get(number).map(|entry| entry.label.as_str());
    if data.heading_as_points {
        upper.dots(name(0), data.heading.finite(), theme.dot, RECORD.mix(1.0))?;
    } else {
        upper.line(name(0), data.heading.pairs(), Stroke::solid(HEADING, theme.line))?;
    }
    if let Some(truth) = &data.truth {
        upper.line(name(1), truth.pairs(), stroke_of(&CurveOrigin::Truth, theme))?;
    }
    let rudder = name(1 + usize::from(data.truth.is_some()));
    lower.line(rudder, data.rudder.pairs(), Stroke::solid(RUDDER, theme.line))?;
    upper.frame(theme)?;
    lower.frame(theme)?;
    let values = annotate(data, upper, theme)?;
    let executes: Vec<(f64, f64)> = data.executes.iter().map(|mark| (mark.t_s, mark.heading_deg)).collect();
    upper.markers(Some("execute"), &executes, theme.marker, &EXECUTE)?;
    if let Some(text) = note.or_else(|| explanation(data, values)) {
        sheet.note(&text)?;
    }
    Ok(sheet.finish())
}

fn entries(data: &ZigzagTrial, theme: &Theme) -> Vec<KeyEntry> {
    let mut entries = vec![if data.heading_as_points {
        KeyEntry::new(KeySample::Dots(RECORD), format!("recorded heading {}", symbol("ψ")))
    } else {
        KeyEntry::new(KeySample::Line(Stroke::solid(HEADING, theme.line)), format!("heading {}", symbol("ψ")))
    }];
    if data.truth.is_some() {
        entries.push(KeyEntry::line_of(&CurveOrigin::Truth, theme));
    }
    entries.push(KeyEntry::new(KeySample::Line(Stroke::solid(RUDDER, theme.line)), format!("rudder {}", symbol("δ"))));
    if !data.executes.is_empty() {
        entries.push(KeyEntry::new(KeySample::Marker(EXECUTE), "execute"));
    }
    if !data.overshoots.is_empty() {
        entries.push(KeyEntry::new(KeySample::Marker(EXTREMUM), "heading extremum"));
    }
    entries
}

/// Height of the strip that holds a row of dimension lines, points.
fn strip(theme: &Theme) -> f64 {
    2.3 * theme.small_font
}

fn has_times(data: &ZigzagTrial) -> bool {
    data.initial_turning.is_some() || !data.check_yaw.is_empty()
}

/// The heading axis, with room above and below the curve for overshoot angles and dimension lines.
fn heading_side(data: &ZigzagTrial, height: f64, theme: &Theme) -> AxisSide {
    let marks = data.overshoots.iter().flat_map(|o| [o.extremum.heading_deg, o.execute.heading_deg]);
    let curves = [&data.heading].into_iter().chain(&data.truth).flat_map(|c| c.finite().map(|(_, y)| y));
    let (lo, hi) = axis::range(curves.chain(marks)).unwrap_or((-1.0, 1.0));
    let (lo, hi) = if hi > lo { (lo, hi) } else { (lo - 1.0, hi + 1.0) };
    let label = if data.overshoots.is_empty() { 0.6 } else { 2.0 } * theme.small_font;
    let above = label + if data.period.is_some() { strip(theme) } else { 0.0 };
    let below = label + if has_times(data) { strip(theme) } else { 0.0 };
    let per_point = (hi - lo) / (height - above - below).max(0.3 * height);
    AxisSide::new(Axis::linear(lo - below * per_point, hi + above * per_point, Division::Angle), Ruler::heading().title)
}

/// Draws overshoots, times and period. Returns the times in words when they did not fit at their lines.
fn annotate(data: &ZigzagTrial, chart: &Chart, theme: &Theme) -> Drawn<Option<String>> {
    let size = theme.small_font;
    let draw = Dimensions { canvas: &chart.canvas, theme: *theme };
    for (i, overshoot) in data.overshoots.iter().enumerate() {
        overshoot_angle(&draw, chart, i + 1, overshoot)?;
    }
    if let Some(period) = &data.period {
        let y = chart.rect.y + 0.75 * strip(theme);
        if let Some((from, to)) = time_line(&draw, chart, data, period, y)? {
            let text = format!("period {}", period.text());
            draw.label(((from + to) / 2.0, y - 0.71 * size), &text)?;
        }
    }
    let y = chart.rect.bottom() - 0.45 * size;
    let mut labels = Vec::new();
    let initial = data.initial_turning.iter().map(|span| (symbol("tₐ"), span));
    let checks = data.check_yaw.iter().enumerate().map(|(i, span)| (symbol(&format!("tₛ{}", subscript(i + 1))), span));
    for (name, span) in initial.chain(checks) {
        if let Some((from, to)) = time_line(&draw, chart, data, span, y)? {
            labels.push(((from + to) / 2.0, name, span.text()));
        }
    }
    labels.sort_by(|a, b| a.0.total_cmp(&b.0));
    let base = y - 0.76 * size;
    let full = |(x, name, value): &(f64, String, String)| {
        TextLine::new(format!("{name} = {value}"), size).anchor(Anchor::Middle).bounds((*x, base))
    };
    let boxes: Vec<Rect> = labels.iter().map(full).collect();
    let fits = boxes.windows(2).all(|b| b[0].right() + 0.3 * size < b[1].x)
        && boxes.iter().all(|b| b.x > chart.rect.x && b.right() < chart.rect.right());
    for (x, name, value) in &labels {
        let text = if fits { format!("{name} = {value}") } else { name.clone() };
        draw.label((*x, base), &text)?;
    }
    let listed: Vec<String> = labels.iter().map(|(_, name, value)| format!("{name} = {value}")).collect();
    // No-break spaces, so that the note is never broken between a symbol and its value.
    let listed: Vec<String> = listed.iter().map(|text| text.replace(' ', "\u{a0}")).collect();
    Ok((!fits).then(|| listed.join(", ")))
}

/// Vertical dimension line from the heading of the execute to the extremum, with its angle beyond the curve.
fn overshoot_angle(draw: &Dimensions<'_>, chart: &Chart, number: usize, overshoot: &OvershootMark) -> Drawn {
    let (execute, extremum) = (overshoot.execute, overshoot.extremum);
    let Some(peak) = chart.inside((extremum.t_s, extremum.heading_deg)) else { return Ok(()) };
    let Some(start) = chart.inside((execute.t_s, execute.heading_deg)) else { return Ok(()) };
    let foot = (peak.0, start.1);
    draw.extension(start, (foot.0 + 0.4 * draw.theme.small_font, foot.1))?;
    draw.between(foot, peak)?;
    draw.canvas.elements(marker(at(peak), 0.85 * draw.theme.marker, &EXTREMUM))?;
    let name = format!("{}OS{}", symbol("ψ"), subscript(number));
    let text = format!("{name} = {}°", number::fixed(overshoot.angle_deg, 1));
    let size = draw.theme.small_font;
    let beyond = if peak.1 <= foot.1 { -1.01 * size } else { 1.04 * size };
    let half = TextLine::new(text.as_str(), size).width() / 2.0 + 0.3 * size;
    let x = peak.0.clamp(chart.rect.x + half, (chart.rect.right() - half).max(chart.rect.x + half));
    draw.label((x, peak.1 + beyond), &text)
}

/// Horizontal dimension line of a span, with lines to the curve where one of the marked points stands at its end.
fn time_line(
    draw: &Dimensions<'_>,
    chart: &Chart,
    data: &ZigzagTrial,
    span: &TimeSpan,
    y: f64,
) -> Drawn<Option<(f64, f64)>> {
    let inside = |t: f64| chart.across(t).filter(|x| chart.rect.contains((*x, y)));
    let (Some(from), Some(to)) = (inside(span.from_s), inside(span.to_s)) else { return Ok(None) };
    let marks = data.executes.iter().chain(data.overshoots.iter().flat_map(|o| [&o.execute, &o.extremum]));
    for (t, x) in [(span.from_s, from), (span.to_s, to)] {
        let at_mark = marks.clone().find(|m| (m.t_s - t).abs() < 1e-9 * t.abs().max(1.0));
        let foot = at_mark.and_then(|m| chart.up(m.heading_deg)).unwrap_or(y);
        draw.extension((x, foot), (x, y))?;
    }
    draw.between((from, y), (to, y))?;
    Ok(Some((from, to)))
}

fn explanation(data: &ZigzagTrial, values: Option<String>) -> Option<String> {
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
