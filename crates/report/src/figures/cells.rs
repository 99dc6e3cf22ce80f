//! Maps of cells: values over two lists of names, one panel each, as colours and as numbers in the cells. Many-coloured
//! maps have the colours of viridis (Smith and van der Walt 2015): even steps look even, also in grey and with any
//! common colour blindness.

use super::panels::Division;
use plotters::element::{IntoDynElement as _, Rectangle};
use plotters::style::{Color as _, RGBColor};

use crate::axis::Axis;
use crate::backend::{Drawn, Group};
use crate::canvas::{Anchor, Rect, Stroke, TextLine};
use crate::chart::Chart;
use crate::figure::Drawing;
use crate::key::{KeyEntry, KeySample, outline_stroke};
use crate::lines::wrap;
use crate::number::{self, MISSING, significant};
use crate::palette::{DOTTED, GRID, HEADING, INK, PAPER, SOLID};
use crate::sheet::{AxisSide, Grid, NAMES, Sheet};
use crate::theme::Theme;

/// What stands in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MapCell {
    /// The value; `None` is "not defined".
    pub value: Option<f64>,
    /// Its 95 % interval, written where there is room.
    pub interval: Option<[f64; 2]>,
    /// How the cell is outlined, where it is.
    pub outline: Option<Outline>,
}

/// Why a cell is outlined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outline {
    /// A number belongs here: a solid line.
    Right,
    /// A number may stand here too: a dotted line.
    Alias,
}

/// How values become colours.
#[derive(Debug, Clone, PartialEq)]
pub enum Shades {
    /// Colours from the lowest to the highest value over an axis that is divided so; a bar under the panels says what
    /// they are, with unit.
    Range(Division, String),
    /// Per cent from white to blue; what is never is empty.
    Shares,
}

/// What [`super::Plot::Cells`] draws.
#[derive(Debug, Clone, PartialEq)]
pub struct CellMap {
    /// Title above the figure.
    pub title: Option<String>,
    /// Titles of the horizontal and of the vertical axis.
    pub titles: [String; 2],
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Names of the rows from the top.
    pub rows: Vec<String>,
    /// How values become colours.
    pub shades: Shades,
    /// Panels with their heads: cells, one list a row.
    pub panels: Vec<(Option<String>, Vec<Vec<MapCell>>)>,
    /// A remark under the figure.
    pub note: Option<String>,
}

/// Smallest type that can be read, points.
const SMALLEST: f64 = 6.5;

/// Height that the rows of a wide figure take, as a share of its width, by being higher, up to so many times as high.
const LOWEST: f64 = 0.28;
const SPREAD: f64 = 1.6;

/// Colours of viridis at equal distances.
const VIRIDIS: [RGBColor; 9] = [
    RGBColor(68, 1, 84),
    RGBColor(71, 44, 122),
    RGBColor(59, 81, 139),
    RGBColor(44, 113, 142),
    RGBColor(33, 144, 141),
    RGBColor(39, 173, 129),
    RGBColor(92, 200, 99),
    RGBColor(170, 220, 50),
    RGBColor(253, 231, 37),
];

impl CellMap {
    fn all(&self) -> impl Iterator<Item = &MapCell> {
        self.panels.iter().flat_map(|(_, rows)| rows).flatten()
    }

    fn is_shares(&self) -> bool {
        self.shades == Shades::Shares
    }
}

/// Draws the panels in rows of as many as fit.
pub(super) fn cells(data: &CellMap, theme: &Theme) -> Drawn<Drawing> {
    let mut sheet = Sheet::new(theme, data.title.as_deref())?;
    let outlines = [(Outline::Right, SOLID, "right"), (Outline::Alias, DOTTED, "mostly cannot be told from it")];
    let shown = outlines.iter().filter(|(own, ..)| data.all().any(|cell| cell.outline == Some(*own)));
    sheet.legend(&shown.map(|(_, dash, name)| KeyEntry::new(KeySample::Outline(dash), *name)).collect::<Vec<_>>())?;
    let count = data.panels.len().max(1);
    let two_lines = data.is_shares() && !theme.is_narrow() && data.all().any(|cell| bracket(cell).is_some());
    let pitch = match (data.is_shares(), theme.is_narrow()) {
        (true, _) => (if two_lines { 2.8 } else { 1.65 }) * theme.small_font,
        (false, true) => 1.75 * theme.tick_font,
        (false, false) => 2.0 * theme.tick_font,
    };
    let lines = data.rows.iter().map(|name| wrap(name, theme.tick_font, false, NAMES * theme.width).len()).max();
    let pitch = pitch.max((0.3 + 1.15 * lines.unwrap_or(1) as f64) * theme.tick_font);
    let count_of_rows = data.rows.len().max(1) as f64;
    // Few rows are higher, where there is room.
    let pitch =
        if theme.is_narrow() { pitch } else { pitch.max((SPREAD * pitch).min(LOWEST * theme.width / count_of_rows)) };
    // The frame stands at the edges of the cells.
    let rows = Axis::rows(data.rows.clone(), 0.5);
    let column = AxisSide::new(Axis::columns(data.columns.clone()), data.titles[0].clone());
    let row = (AxisSide::new(rows, data.titles[1].clone()), count_of_rows * pitch);
    let heads = data.panels.iter().map(|(head, _)| Some(KeyEntry::new(KeySample::Nothing, head.clone()?)));
    let heads = heads.collect();
    let range = Range::of(data);
    let charts = sheet.grid(Grid { heads, ..Grid::alike(count, across(data, theme).min(count), column, row) })?;
    for (chart, (_, rows)) in charts.iter().zip(&data.panels) {
        let cells =
            || rows.iter().enumerate().flat_map(|(y, row)| row.iter().enumerate().map(move |(x, own)| ((x, y), own)));
        cells().try_for_each(|(place, cell)| shade(chart, theme, place, (cell, &range)))?;
        chart.frame(theme)?;
        cells().try_for_each(|(place, cell)| label(chart, theme, place, (cell, &range)))?;
    }
    if let Shades::Range(division, title) = &data.shades {
        bar(&mut sheet, (*division, title), theme, &range)?;
    }
    let undefined = data.all().any(|cell| cell.value.is_none()).then_some("– is not defined.");
    let small = two_lines.then_some("Small: 95 % intervals, where there is room.");
    let note: Vec<&str> = data.note.as_deref().into_iter().chain(small).chain(undefined).collect();
    if !note.is_empty() {
        sheet.note(&note.join(" "))?;
    }
    Ok(sheet.finish())
}

/// Pieces of the bar of colours.
const PIECES: usize = 64;

/// The colours with their values, under the panels.
fn bar(sheet: &mut Sheet, (division, title): (Division, &str), theme: &Theme, range: &Range) -> Drawn {
    // Also where there is no value at all.
    if range.high <= range.low {
        return Ok(());
    }
    let value = |along: f64| if range.is_log { 10f64.powf(along) } else { along };
    let (low, high) = (value(range.low), value(range.high));
    let axis = match division {
        Division::Factors => Axis::log_covering([low, high]).between(low, high),
        _ => Axis::linear(low, high, Division::Decimal),
    };
    let strip = (0.25 * theme.width, 0.5 * theme.width);
    let row = (AxisSide::new(Axis::rows(Vec::new(), 0.5), ""), 0.9 * theme.small_font);
    let charts = sheet.grid_within(Grid::new(vec![AxisSide::new(axis, title)], vec![row]), strip)?;
    let piece = |number: usize| {
        let at = |share: f64| value(range.low + share / PIECES as f64 * (range.high - range.low));
        // Each lies over the end of the one before: edges side by side would let the paper through.
        let corners = [(at(number as f64), -0.5), (high, 0.5)];
        Rectangle::new(corners, range.colour(at(number as f64 + 0.5)).0.filled()).into_dyn()
    };
    for chart in charts {
        chart.draw(Group::default(), (0..PIECES).map(piece))?;
        chart.frame(theme)?;
    }
    Ok(())
}

/// Panels side by side: three, or as many as leave room for the numbers in the cells.
fn across(data: &CellMap, theme: &Theme) -> usize {
    let widest = |labels: &[String], font: f64| {
        labels.iter().map(|label| TextLine::new(label.as_str(), font).width()).fold(0.0, f64::max)
    };
    let values: Vec<String> = data.all().map(written).collect();
    let cell = widest(&values, theme.small_font).max(widest(&data.columns, theme.tick_font)) + 0.5 * theme.tick_font;
    let room = theme.width - widest(&data.rows, theme.tick_font) - 2.0 * theme.label_font;
    let fits = |across: usize| {
        let gaps = Sheet::gap(theme) * (across - 1) as f64;
        room - gaps >= cell * (across * data.columns.len()) as f64
    };
    let most = if data.panels.len() == 4 { 2 } else { 3 };
    (2..=most).rev().find(|&across| fits(across)).unwrap_or(1)
}

/// A value as it stands in a cell.
fn written(cell: &MapCell) -> String {
    cell.value.map_or_else(|| MISSING.to_owned(), |value| significant(value, 2))
}

/// From values to colours.
struct Range {
    low: f64,
    high: f64,
    is_log: bool,
    is_shares: bool,
}

impl Range {
    fn of(data: &CellMap) -> Self {
        let is_log = matches!(data.shades, Shades::Range(Division::Factors, _));
        let is_shares = data.is_shares();
        let range = Self { low: 0.0, high: 100.0, is_log, is_shares };
        let ends = crate::axis::range(data.all().filter_map(|cell| range.along(cell.value?)));
        let (low, high) = ends.filter(|_| !is_shares).unwrap_or((range.low, if is_shares { 100.0 } else { 0.0 }));
        Self { low, high, ..range }
    }

    fn along(&self, value: f64) -> Option<f64> {
        let along = if self.is_log { value.log10() } else { value };
        along.is_finite().then_some(along)
    }

    /// Colour of a value and how dense it is; the lowest for a zero on an axis of equal factors.
    fn colour(&self, value: f64) -> (RGBColor, f64) {
        if self.is_shares {
            let share = (value / 100.0).clamp(0.0, 1.0);
            return (HEADING, if share > 0.0 { 0.1 + 0.5 * share } else { 0.0 });
        }
        let (along, range) = (self.along(value).unwrap_or(self.low), self.high - self.low);
        let share = if range > 0.0 { ((along - self.low) / range).clamp(0.0, 1.0) } else { 0.5 };
        let place = share * (VIRIDIS.len() - 1) as f64;
        let below = (place.floor() as usize).min(VIRIDIS.len() - 2);
        let (one, other) = (VIRIDIS[below], VIRIDIS[below + 1]);
        let mix = |a: u8, b: u8| (f64::from(a) + (place - below as f64) * (f64::from(b) - f64::from(a))).round() as u8;
        (RGBColor(mix(one.0, other.0), mix(one.1, other.1), mix(one.2, other.2)), 1.0)
    }
}

/// The interval of a share of the trials that is not none.
fn bracket(cell: &MapCell) -> Option<String> {
    let [low, high] = cell.interval.filter(|_| cell.value.is_some_and(|own| own > 0.0))?;
    Some(format!("{low:.0}–{high:.0}"))
}

/// Colour and outline of a cell.
fn shade(chart: &Chart, theme: &Theme, (x, y): (usize, usize), (cell, range): (&MapCell, &Range)) -> Drawn {
    let (x, y) = (x as f64, y as f64);
    let (colour, opacity) = cell.value.map_or((GRID, 1.0), |value| range.colour(value));
    if opacity > 0.0 {
        let corners = [(x - 0.5, y - 0.5), (x + 0.5, y + 0.5)];
        chart.draw(Group::default(), [Rectangle::new(corners, colour.mix(opacity).filled()).into_dyn()])?;
    }
    if range.is_shares {
        let hair = Stroke::solid(GRID, theme.thin);
        chart.line(None, [(x - 0.5, y + 0.5), (x + 0.5, y + 0.5), (x + 0.5, y - 0.5)], hair)?;
    }
    Ok(())
}

/// The numbers in a cell, and its outline over the hairs of its neighbours.
fn label(chart: &Chart, theme: &Theme, (x, y): (usize, usize), (cell, range): (&MapCell, &Range)) -> Drawn {
    let corner = |side: f64| chart.place((x as f64 + side, y as f64 + side));
    let (Some((left, top)), Some((right, bottom))) = (corner(-0.5), corner(0.5)) else { return Ok(()) };
    if let Some(outline) = cell.outline {
        let stroke = outline_stroke(if outline == Outline::Right { SOLID } else { DOTTED }, theme);
        let inset = 0.5 * stroke.width;
        let [w, h] = [right - left, bottom - top].map(|side| side - stroke.width);
        chart.canvas.outline(Rect { x: left + inset, y: top + inset, w, h }, stroke)?;
    }
    let (RGBColor(r, g, b), opacity) = cell.value.map_or((GRID, 1.0), |value| range.colour(value));
    if range.is_shares && opacity == 0.0 {
        return Ok(());
    }
    // Relative luminance (ITU-R BT.709) over white paper decides whether black or white can be read.
    let luminance = (0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)) / 255.0;
    let ink = if 1.0 - opacity * (1.0 - luminance) > 0.5 { INK } else { PAPER };
    let number = |text: String, size: f64| TextLine::new(text, size).colour(ink).anchor(Anchor::Middle);
    let value = match cell.value {
        // A rare one is not none.
        Some(share) if range.is_shares && share < 0.5 => String::from("<1"),
        Some(share) if range.is_shares => number::fixed(share, 0),
        _ => written(cell),
    };
    let value = number(value, theme.small_font);
    let middle = (0.5 * (left + right), 0.5 * (top + bottom));
    if value.width() > (right - left).abs() - if range.is_shares { 2.8 * theme.line } else { 0.0 } {
        return Ok(());
    }
    let interval = bracket(cell).map(|text| number(text, (0.8 * theme.small_font).max(SMALLEST)));
    match interval.filter(|text| text.width() < 0.96 * (right - left) && !theme.is_narrow()) {
        Some(interval) => {
            chart.canvas.text((middle.0, middle.1 - 0.46 * theme.small_font), &value)?;
            chart.canvas.text((middle.0, middle.1 + 0.6 * theme.small_font), &interval)
        }
        None => chart.canvas.text(middle, &value),
    }
}
