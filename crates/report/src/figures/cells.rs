//! Maps of cells: values over two lists of names, as colours and as numbers in the cells, in one or more panels. Values
//! other than shares have the colours of viridis (Smith and van der Walt 2015): equal steps look equal, also in grey
//! and with any common colour blindness.

use plotters::element::{IntoDynElement as _, Rectangle};
use plotters::style::colors::colormaps::ViridisRGB;
use plotters::style::text_anchor::HPos;
use plotters::style::{Color as _, RGBColor};

use crate::axis::{self, Axis, TickRule};
use crate::backend::{PlotResult, SvgGroup};
use crate::canvas::{Rect, Stroke, TextLine};
use crate::chart::Chart;
use crate::drawing::Drawing;
use crate::fonts::{LINE_SPACING, text_width};
use crate::legend::{LegendEntry, LegendSymbol, outline_stroke};
use crate::lines::wrap;
use crate::number::{self, MISSING, significant};
use crate::palette::{BACKGROUND, DOTTED, GRID, HEADING, INK, SOLID};
use crate::sheet::{Grid, MAX_NAMES_SHARE, Sheet, TitledAxis};
use crate::theme::Theme;

/// Content of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MapCell {
    /// Value in the unit of the map; `None` if it is not defined.
    pub value: Option<f64>,
    /// 95 % interval of the value, written if there is room; `None` without an interval.
    pub interval: Option<[f64; 2]>,
    /// Outline of the cell; `None` without an outline.
    pub outline: Option<Outline>,
    /// Number of trials behind the value; 0 if it is not known.
    pub trial_count: u64,
}

/// Reason for the outline of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outline {
    /// Correct cell: a solid line.
    Correct,
    /// Cell that is also acceptable: a dotted line.
    Alias,
    /// Cell that the finding in the title is about: a solid line.
    Finding,
}

/// Mapping from values to colours.
#[derive(Debug, Clone, PartialEq)]
pub enum Shades {
    /// Colours from the lowest to the highest value, in equal factors for [`TickRule::Logarithmic`], otherwise in equal
    /// steps. A bar under the panels shows the values, with this title and unit.
    Range(TickRule, String),
    /// Per cent from white to blue; zero is empty.
    Shares,
}

/// Data of [`super::Plot::Cells`].
#[derive(Debug, Clone, PartialEq)]
pub struct CellMap {
    /// Titles of the horizontal and of the vertical axis.
    pub axis_titles: [String; 2],
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Names of the rows from the top.
    pub rows: Vec<String>,
    /// Mapping from values to colours.
    pub shades: Shades,
    /// Panels with the text above them, `None` without one, and their cells, one list per row.
    pub panels: Vec<(Option<String>, Vec<Vec<MapCell>>)>,
    /// Remark under the figure; `None` without a remark.
    pub note: Option<String>,
}

/// Minimum legible font size, points.
const MIN_FONT_PT: f64 = 6.5;

/// Height to which the rows of a wide figure grow together, as a share of its width.
const HEIGHT: f64 = 0.28;

/// Maximum factor by which rows grow to reach `HEIGHT`.
const SPREAD: f64 = 1.6;

impl CellMap {
    fn all(&self) -> impl Iterator<Item = &MapCell> {
        self.panels.iter().flat_map(|(_, rows)| rows).flatten()
    }

    fn is_shares(&self) -> bool {
        self.shades == Shades::Shares
    }

    /// `true` if intervals are written below the values.
    fn has_intervals(&self, theme: &Theme) -> bool {
        self.is_shares() && !theme.is_narrow() && self.all().any(|cell| bracket(cell).is_some())
    }

    /// Height of a row, points.
    fn pitch(&self, theme: &Theme) -> f64 {
        let usual = match (self.is_shares(), self.has_intervals(theme), theme.is_narrow()) {
            (true, true, _) => 2.8 * theme.small_font,
            (true, false, _) => 1.65 * theme.small_font,
            (false, _, true) => 1.75 * theme.tick_font,
            (false, _, false) => 2.0 * theme.tick_font,
        };
        let lines =
            self.rows.iter().map(|name| wrap(name, theme.tick_font, false, MAX_NAMES_SHARE * theme.width).len()).max();
        let usual = usual.max((0.3 + LINE_SPACING * lines.unwrap_or(1) as f64) * theme.tick_font);
        let higher = (SPREAD * usual).min(HEIGHT * theme.width / self.rows.len().max(1) as f64);
        if theme.is_narrow() { usual } else { usual.max(higher) }
    }

    /// Number of panels side by side: as many as leave every cell the width of its number, at least one and at most
    /// three, at most two of four panels.
    fn panels_side_by_side(&self, theme: &Theme) -> usize {
        let widest = |labels: &[String], font: f64| {
            labels.iter().map(|label| text_width(label, font, false)).fold(0.0, f64::max)
        };
        let values: Vec<String> = self.all().map(written).collect();
        let cell =
            widest(&values, theme.small_font).max(widest(&self.columns, theme.tick_font)) + 0.5 * theme.tick_font;
        let room = theme.width - widest(&self.rows, theme.tick_font) - 2.0 * theme.label_font;
        let fits = |across: &usize| {
            let gaps = Sheet::panel_gap(theme) * (across - 1) as f64;
            room - gaps >= cell * (across * self.columns.len()) as f64
        };
        let most = if self.panels.len() == 4 { 2 } else { 3 };
        (2..=most).rev().find(fits).unwrap_or(1).min(self.panels.len().max(1))
    }
}

/// Drawing of the panels, in rows of as many as fit.
pub(super) fn cells(data: &CellMap, finding: &str, theme: &Theme) -> PlotResult<Drawing> {
    let mut sheet = Sheet::new(theme, finding)?;
    let outlines = [
        (Outline::Correct, SOLID, "right"),
        (Outline::Alias, DOTTED, "mostly indistinguishable from it"),
        (Outline::Finding, SOLID, "in the title"),
    ];
    let shown = outlines.iter().filter(|(outline, ..)| data.all().any(|cell| cell.outline == Some(*outline)));
    sheet.legend(
        &shown.map(|(_, dash, name)| LegendEntry::new(LegendSymbol::Outline(dash), *name)).collect::<Vec<_>>(),
    )?;
    // The frame is at the edges of the cells.
    let column = TitledAxis::new(Axis::columns(&data.columns), data.axis_titles[0].as_str());
    let row = TitledAxis::new(Axis::rows(&data.rows, 0.5), data.axis_titles[1].as_str());
    let height = data.rows.len().max(1) as f64 * data.pitch(theme);
    let heads =
        data.panels.iter().map(|(head, _)| Some(LegendEntry::new(LegendSymbol::Nothing, head.as_ref()?))).collect();
    let shading = Shading::from_map(data);
    let grid =
        Grid { heads, ..Grid::alike(data.panels.len().max(1), data.panels_side_by_side(theme), column, row, height) };
    for (chart, (_, rows)) in sheet.grid(grid)?.iter().zip(&data.panels) {
        let places = rows.iter().enumerate().flat_map(|(y, row)| (0..row.len()).map(move |x| (x, y)));
        let cells: Vec<PlacedCell> = places
            .map(|(x, y)| PlacedCell { cell: rows[y][x], x: x as f64, y: y as f64, shading: &shading, theme })
            .collect();
        cells.iter().try_for_each(|cell| cell.shade(chart))?;
        chart.frame(theme)?;
        cells.iter().try_for_each(|cell| cell.label(chart))?;
    }
    if let Shades::Range(tick_rule, title) = &data.shades {
        bar(&mut sheet, *tick_rule, title, &shading)?;
    }
    let undefined = data.all().any(|cell| cell.value.is_none()).then_some("– is not defined.");
    let small = data.has_intervals(theme).then_some("Small: 95 % intervals, where there is room.");
    sheet.note(&data.note.as_deref().into_iter().chain(small).chain(undefined).collect::<Vec<_>>())?;
    Ok(sheet.finish())
}

/// Number of pieces of the colour bar.
const PIECES: usize = 64;

/// Draws the colour bar with its values under the panels, unless there are fewer than two different values.
fn bar(sheet: &mut Sheet, tick_rule: TickRule, title: &str, shading: &Shading) -> PlotResult {
    if shading.high <= shading.low {
        return Ok(());
    }
    let theme = sheet.theme.clone();
    let value = |along: f64| if shading.is_log { 10f64.powf(along) } else { along };
    let (low, high) = (value(shading.low), value(shading.high));
    let axis = match tick_rule {
        TickRule::Logarithmic => Axis::log_covering(&[low, high]).between(low, high),
        _ => Axis::linear(low, high, TickRule::Decimal),
    };
    let rows = vec![(TitledAxis::new(Axis::rows(&[], 0.5), ""), 0.9 * theme.small_font)];
    let grid = Grid { columns: vec![TitledAxis::new(axis, title)], rows, ..Grid::default() };
    let piece = |number: usize| {
        let at = |share: f64| value(shading.low + share / PIECES as f64 * (shading.high - shading.low));
        // Each piece reaches to the end, under all later pieces: the paper would show between pieces side by side.
        let corners = [(at(number as f64), -0.5), (high, 0.5)];
        Rectangle::new(corners, shading.colour(at(number as f64 + 0.5)).0.filled()).into_dyn()
    };
    for chart in sheet.grid_within(grid, 0.25 * theme.width, 0.5 * theme.width)? {
        chart.draw(SvgGroup::default(), (0..PIECES).map(piece))?;
        chart.frame(&theme)?;
    }
    Ok(())
}

/// Text of a value in a cell.
fn written(cell: &MapCell) -> String {
    cell.value.map_or_else(|| MISSING.to_owned(), |value| significant(value, 2))
}

/// Mapping from values to colours.
struct Shading {
    /// Minimum of the values, or of their decadic logarithms if `is_log`.
    low: f64,
    /// Maximum of the values, or of their decadic logarithms if `is_log`.
    high: f64,
    is_log: bool,
    is_shares: bool,
}

impl Shading {
    fn from_map(data: &CellMap) -> Self {
        let is_log = matches!(data.shades, Shades::Range(TickRule::Logarithmic, _));
        let is_shares = data.is_shares();
        let along = |value: f64| if is_log { value.log10() } else { value };
        let (low, high) = axis::range(data.all().filter_map(|cell| Some(along(cell.value?)))).unwrap_or_default();
        Self { low, high, is_log, is_shares }
    }

    /// Colour of a value and its opacity. Zero on a logarithmic scale has the lowest colour.
    fn colour(&self, value: f64) -> (RGBColor, f64) {
        if self.is_shares {
            let share = (value / 100.0).clamp(0.0, 1.0);
            return (HEADING, if share > 0.0 { 0.1 + 0.5 * share } else { 0.0 });
        }
        let along = if self.is_log { value.log10() } else { value };
        let range = self.high - self.low;
        let share = if range > 0.0 && !along.is_nan() { ((along - self.low) / range).clamp(0.0, 1.0) } else { 0.5 };
        (ViridisRGB::get_color(share), 1.0)
    }
}

/// Interval of a positive value as text, in whole numbers; `None` for any other cell.
fn bracket(cell: &MapCell) -> Option<String> {
    let [low, high] = cell.interval.filter(|_| cell.value.is_some_and(|value| value > 0.0))?;
    Some(format!("{low:.0}–{high:.0}"))
}

/// Cell at its column and row.
struct PlacedCell<'a> {
    cell: MapCell,
    x: f64,
    y: f64,
    shading: &'a Shading,
    theme: &'a Theme,
}

impl PlacedCell<'_> {
    fn colour(&self) -> (RGBColor, f64) {
        self.cell.value.map_or((GRID, 1.0), |value| self.shading.colour(value))
    }

    /// Fills the cell, with thin lines to its neighbours in a map of shares, most of whose cells are white.
    fn shade(&self, chart: &Chart) -> PlotResult {
        let (colour, opacity) = self.colour();
        let [left, right, top, bottom] = [self.x - 0.5, self.x + 0.5, self.y - 0.5, self.y + 0.5];
        let cell = Rectangle::new([(left, top), (right, bottom)], colour.mix(opacity).filled());
        chart.draw(SvgGroup::default(), [cell.into_dyn()])?;
        let hair = Stroke::solid(GRID, self.theme.thin);
        let hairs = [(left, bottom), (right, bottom), (right, top)];
        if self.shading.is_shares { chart.line(None, hairs, hair) } else { Ok(()) }
    }

    /// Writes the numbers of the cell, and its outline over the thin lines of its neighbours.
    fn label(&self, chart: &Chart) -> PlotResult {
        let (theme, is_shares) = (self.theme, self.shading.is_shares);
        let corner = |side: f64| chart.page_point(self.x + side, self.y + side);
        let (Some((left, top)), Some((right, bottom))) = (corner(-0.5), corner(0.5)) else { return Ok(()) };
        if let Some(outline) = self.cell.outline {
            let stroke = outline_stroke(if outline == Outline::Alias { DOTTED } else { SOLID }, theme);
            let inset = 0.5 * stroke.width;
            let [w, h] = [right - left, bottom - top].map(|side| side - stroke.width);
            chart.canvas.outline(Rect { x: left + inset, y: top + inset, w, h }, stroke)?;
        }
        let (RGBColor(r, g, b), opacity) = self.colour();
        // Relative luminance (ITU-R BT.709) over white paper decides between black and white text.
        let luminance = (0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)) / 255.0;
        let colour = if 1.0 - opacity * (1.0 - luminance) > 0.5 { INK } else { BACKGROUND };
        let number = |text: String, size: f64| TextLine { colour, ..TextLine::new(text, size, HPos::Center) };
        let value = match self.cell.value {
            Some(share) if is_shares && share <= 0.0 => return Ok(()),
            // A small share is not zero.
            Some(share) if is_shares && share < 0.5 => String::from("<1"),
            Some(share) if is_shares => number::fixed(share, 0),
            _ => written(&self.cell),
        };
        let value = number(value, theme.small_font);
        let (x, y, width) = (0.5 * (left + right), 0.5 * (top + bottom), right - left);
        if value.width() > width - if is_shares { 2.8 * theme.line } else { 0.0 } {
            return Ok(());
        }
        let interval = bracket(&self.cell).map(|text| number(text, (0.8 * theme.small_font).max(MIN_FONT_PT)));
        match interval.filter(|text| text.width() < 0.96 * width && !theme.is_narrow()) {
            Some(interval) => {
                chart.canvas.text((x, y - 0.46 * theme.small_font), &value)?;
                chart.canvas.text((x, y + 0.6 * theme.small_font), &interval)
            }
            None => chart.canvas.text((x, y), &value),
        }
    }
}
