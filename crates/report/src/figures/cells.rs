//! Maps of cells: values over two lists of names, one panel each, as colours and as numbers in the cells. Many-coloured
//! maps have the colours of viridis (Smith and van der Walt 2015): even steps look even, also in grey and with any
//! common colour blindness.

use super::panels::Division;
use crate::axis::PlotAxis;
use crate::figure::Drawing;
use crate::layout::{AxisSide, Grid, NAMES, Sheet};
use crate::legend::{KeyEntry, KeySample, outline_stroke};
use crate::lines::wrap;
use crate::number::{self, MISSING, significant};
use crate::paint::Paint;
use crate::palette::{DOTTED, GRID, HEADING, INK, PAPER, SOLID};
use crate::panel::Panel;
use crate::scene::{Anchor, Canvas, Layer, Stroke, TextLine};
use crate::theme::Theme;
use crate::ticks::TickSteps;

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

/// Colours of viridis at equal distances.
const VIRIDIS: [Paint; 9] = [
    Paint(68, 1, 84),
    Paint(71, 44, 122),
    Paint(59, 81, 139),
    Paint(44, 113, 142),
    Paint(33, 144, 141),
    Paint(39, 173, 129),
    Paint(92, 200, 99),
    Paint(170, 220, 50),
    Paint(253, 231, 37),
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
pub(super) fn cells(data: &CellMap, theme: &Theme) -> Drawing {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let outlines = [(Outline::Right, SOLID, "right"), (Outline::Alias, DOTTED, "mostly cannot be told from it")];
    let shown = outlines.iter().filter(|(own, ..)| data.all().any(|cell| cell.outline == Some(*own)));
    sheet.legend(&shown.map(|(_, dash, name)| KeyEntry::new(KeySample::Outline(dash), *name)).collect::<Vec<_>>());
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
    // The frame stands at the edges of the cells.
    let rows = PlotAxis::names(data.rows.clone()).between(-0.5, count_of_rows - 0.5);
    let column = AxisSide::new(PlotAxis::columns(data.columns.clone()), data.titles[0].clone());
    let row = (AxisSide::new(rows, data.titles[1].clone()), count_of_rows * pitch);
    let heads = data.panels.iter().map(|(head, _)| Some(KeyEntry::new(KeySample::Nothing, head.clone()?)));
    let heads = heads.collect();
    let range = Range::of(data);
    let panels = sheet.grid(Grid { heads, ..Grid::alike(count, across(data, theme).min(count), column, row) });
    for (panel, (_, rows)) in panels.iter().zip(&data.panels) {
        for (y, cells) in rows.iter().enumerate() {
            for (x, cell) in cells.iter().enumerate() {
                draw(panel, &mut sheet.scene, theme, (x, y), (cell, &range));
            }
        }
    }
    if let Shades::Range(division, title) = &data.shades {
        bar(&mut sheet, (*division, title), theme, &range);
    }
    let undefined = data.all().any(|cell| cell.value.is_none()).then_some("– is not defined.");
    let small = two_lines.then_some("Small: 95 % intervals, where there is room.");
    let note: Vec<&str> = data.note.as_deref().into_iter().chain(small).chain(undefined).collect();
    if !note.is_empty() {
        sheet.note(&note.join(" "));
    }
    sheet.finish()
}

/// Pieces of the bar of colours.
const PIECES: usize = 64;

/// The colours with their values, under the panels.
fn bar(sheet: &mut Sheet, (division, title): (Division, &str), theme: &Theme, range: &Range) {
    // Also where there is no value at all.
    if range.high <= range.low {
        return;
    }
    let value = |along: f64| if range.is_log { 10f64.powf(along) } else { along };
    let axis = match division {
        Division::Factors => PlotAxis::log_between(value(range.low), value(range.high)),
        _ => PlotAxis::linear(range.low, range.high, TickSteps::Decimal),
    };
    let strip = (0.25 * theme.width, 0.5 * theme.width);
    let row = (AxisSide::new(PlotAxis::names(Vec::new()), ""), 0.9 * theme.small_font);
    let panels = sheet.grid_within(Grid::new(vec![AxisSide::new(axis, title)], vec![row]), strip);
    let Some(panel) = panels.first() else { return };
    let (top, bottom) = (panel.rect.y, panel.rect.bottom());
    for piece in 0..PIECES {
        let at = |share: f64| panel.rect.x + share * panel.rect.w;
        // Each lies over the end of the one before: edges side by side would let the paper through.
        let (left, right) = (at(piece as f64 / PIECES as f64), panel.rect.right());
        let along = range.low + (piece as f64 + 0.5) / PIECES as f64 * (range.high - range.low);
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        sheet.scene.fill(Layer::Data, corners, range.colour(value(along)).0, 1.0);
    }
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
    fn colour(&self, value: f64) -> (Paint, f64) {
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
        (Paint(mix(one.0, other.0), mix(one.1, other.1), mix(one.2, other.2)), 1.0)
    }
}

/// The interval of a share of the trials that is not none.
fn bracket(cell: &MapCell) -> Option<String> {
    let [low, high] = cell.interval.filter(|_| cell.value.is_some_and(|own| own > 0.0))?;
    Some(format!("{low:.0}–{high:.0}"))
}

fn draw(panel: &Panel, scene: &mut Canvas, theme: &Theme, (x, y): (usize, usize), (cell, range): (&MapCell, &Range)) {
    let corner = |dx: f64, dy: f64| panel.place((x as f64 + dx, y as f64 + dy));
    let (Some((left, top)), Some((right, bottom))) = (corner(-0.5, -0.5), corner(0.5, 0.5)) else { return };
    let corners =
        |by: f64| [(left + by, top + by), (right - by, top + by), (right - by, bottom - by), (left + by, bottom - by)];
    let (colour, opacity) = cell.value.map_or((GRID, 1.0), |value| range.colour(value));
    if opacity > 0.0 {
        scene.fill(Layer::Grid, corners(0.0), colour, opacity);
    }
    if range.is_shares {
        let hair = Stroke::solid(GRID, theme.thin);
        scene.line(Layer::Data, [(left, bottom), (right, bottom)], hair);
        scene.line(Layer::Data, [(right, top), (right, bottom)], hair);
    }
    if let Some(outline) = cell.outline {
        let stroke = outline_stroke(if outline == Outline::Right { SOLID } else { DOTTED }, theme);
        let [a, b, c, d] = corners(0.5 * stroke.width);
        scene.line(Layer::Frame, [a, b, c, d, a, b], stroke);
    }
    if range.is_shares && opacity == 0.0 {
        return;
    }
    let Paint(r, g, b) = colour;
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
        return;
    }
    let interval = bracket(cell).map(|text| number(text, (0.8 * theme.small_font).max(SMALLEST)));
    let up = match interval.filter(|text| text.width() < 0.96 * (right - left) && !theme.is_narrow()) {
        Some(interval) => {
            scene.text(Layer::Note, (middle.0, middle.1 + 0.9 * theme.small_font), interval);
            -0.1 * theme.small_font
        }
        None => value.centring(),
    };
    scene.text(Layer::Note, (middle.0, middle.1 + up), value);
}
