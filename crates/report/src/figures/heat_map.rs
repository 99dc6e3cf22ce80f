//! A value over two axes: one panel a method, cells coloured by the value and the value written in them. The colours
//! are those of viridis (Smith and van der Walt 2015): even steps look even, also in grey and with any common colour
//! blindness.

use serde::{Deserialize, Serialize};

use super::error_curves::Scale;
use crate::axis::Axis;
use crate::colour::Colour;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::number;
use crate::palette::{GRID, INK, PAPER};
use crate::panel::Panel;
use crate::scene::{Anchor, Layer, Scene, Text};
use crate::theme::Theme;
use crate::ticks::Steps;

/// One panel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HeatPanel {
    /// Head of the panel: the method.
    pub title: String,
    /// Values, one list a row from the top; `None` is "not defined".
    pub values: Vec<Vec<Option<f64>>>,
}

/// What [`heat_map`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct HeatMap {
    /// Title above the figure.
    pub title: Option<String>,
    /// Title of the horizontal axis.
    pub x_title: String,
    /// Title of the vertical axis.
    pub y_title: String,
    /// Labels of the columns.
    pub x_labels: Vec<String>,
    /// Labels of the rows, from the top.
    pub y_labels: Vec<String>,
    /// What the values are, with unit.
    pub value_title: String,
    /// How values become colours.
    pub scale: Scale,
    /// The panels.
    pub panels: Vec<HeatPanel>,
}

/// Colours of viridis at equal distances.
const VIRIDIS: [(u8, u8, u8); 9] = [
    (68, 1, 84),
    (71, 44, 122),
    (59, 81, 139),
    (44, 113, 142),
    (33, 144, 141),
    (39, 173, 129),
    (92, 200, 99),
    (170, 220, 50),
    (253, 231, 37),
];

/// Draws the panels in rows of as many as fit.
pub fn heat_map(data: &HeatMap, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let count = data.panels.len().max(1);
    let across = across(data, theme).min(count);
    let row_height = if theme.is_narrow() { 1.75 } else { 2.0 } * theme.tick_font;
    let height = (data.y_labels.len().max(1) as f64 + 0.2) * row_height;
    let column = Side::new(Axis::columns(data.x_labels.clone()), data.x_title.clone());
    let row = (Side::new(Axis::names(data.y_labels.clone()), data.y_title.clone()), height);
    let range = Colours::of(data);
    let heads = data.panels.iter().map(|panel| Some(Entry::new(Sample::Nothing, panel.title.clone())));
    let panels = sheet.grid(Grid { heads: heads.collect(), ..Grid::alike(count, across, column, row) });
    for (panel, content) in panels.iter().zip(&data.panels) {
        for (y, values) in content.values.iter().enumerate() {
            for (x, value) in values.iter().enumerate() {
                cell(panel, &mut sheet.scene, theme, (x, y), *value, &range);
            }
        }
    }
    bar(&mut sheet, data, theme, &range);
    if data.panels.iter().flat_map(|panel| &panel.values).flatten().any(Option::is_none) {
        sheet.note("– is not defined.");
    }
    sheet.finish()
}

/// Pieces of the bar of colours.
const PIECES: usize = 64;

/// The colours with their values, under the panels.
fn bar(sheet: &mut Sheet, data: &HeatMap, theme: &Theme, colours: &Colours) {
    // Also where there is no value at all.
    if colours.high <= colours.low {
        return;
    }
    let value = |along: f64| if data.scale == Scale::Log { 10f64.powf(along) } else { along };
    let ends = [value(colours.low), value(colours.high)];
    let axis = match data.scale {
        Scale::Log => Axis::log_between(ends[0], ends[1]),
        Scale::Linear => Axis::linear(ends[0], ends[1], Steps::Decimal),
    };
    let strip = (0.5 * theme.width, 0.4 * theme.width);
    let row = (Side::new(Axis::names(Vec::new()), ""), 0.9 * theme.small_font);
    let panels = sheet.grid_within(Grid::new(vec![Side::new(axis, data.value_title.clone())], vec![row]), strip);
    let Some(panel) = panels.first() else { return };
    let (top, bottom) = (panel.rect.y, panel.rect.bottom());
    for piece in 0..PIECES {
        let at = |share: f64| panel.rect.x + share * panel.rect.w;
        let (left, right) = (at(piece as f64 / PIECES as f64), at((piece + 1) as f64 / PIECES as f64));
        let along = colours.low + (piece as f64 + 0.5) / PIECES as f64 * (colours.high - colours.low);
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        sheet.scene.fill(Layer::Data, corners, colours.colour(value(along)), 1.0);
    }
}

/// Panels side by side: three, or as many as leave room for the numbers in the cells.
fn across(data: &HeatMap, theme: &Theme) -> usize {
    let width = |text: &str, font: f64| Text::new(text, font).width();
    let widest = |labels: &[String], font: f64| labels.iter().map(|label| width(label, font)).fold(0.0, f64::max);
    let values: Vec<String> =
        data.panels.iter().flat_map(|panel| panel.values.iter().flatten()).map(|value| written(*value)).collect();
    let cell = widest(&values, theme.small_font).max(widest(&data.x_labels, theme.tick_font)) + 0.5 * theme.tick_font;
    let room = theme.width - widest(&data.y_labels, theme.tick_font) - 2.0 * theme.label_font;
    let fits = |across: usize| {
        let gaps = Sheet::gap(theme) * (across - 1) as f64;
        room - gaps >= cell * (across * data.x_labels.len()) as f64
    };
    let most = if data.panels.len() == 4 { 2 } else { 3 };
    (2..=most).rev().find(|&across| fits(across)).unwrap_or(1)
}

/// A value as it stands in a cell.
fn written(value: Option<f64>) -> String {
    value.map_or_else(|| number::MISSING.to_owned(), |value| number::significant(value, 2))
}

/// From values to colours.
struct Colours {
    low: f64,
    high: f64,
    scale: Scale,
}

impl Colours {
    fn of(data: &HeatMap) -> Self {
        let mut colours = Self { low: f64::INFINITY, high: f64::NEG_INFINITY, scale: data.scale };
        for value in data.panels.iter().flat_map(|panel| &panel.values).flatten().flatten() {
            if let Some(along) = colours.along(*value) {
                colours.low = colours.low.min(along);
                colours.high = colours.high.max(along);
            }
        }
        colours
    }

    fn along(&self, value: f64) -> Option<f64> {
        let along = if self.scale == Scale::Log { value.log10() } else { value };
        along.is_finite().then_some(along)
    }

    /// Colour of a value; the lowest for a zero on a logarithmic scale.
    fn colour(&self, value: f64) -> Colour {
        let along = self.along(value).unwrap_or(self.low);
        let range = self.high - self.low;
        let share = if range > 0.0 { ((along - self.low) / range).clamp(0.0, 1.0) } else { 0.5 };
        let place = share * (VIRIDIS.len() - 1) as f64;
        let below = (place.floor() as usize).min(VIRIDIS.len() - 2);
        let (one, other) = (VIRIDIS[below], VIRIDIS[below + 1]);
        let mix = |a: u8, b: u8| (f64::from(a) + (place - below as f64) * (f64::from(b) - f64::from(a))).round() as u8;
        Colour(mix(one.0, other.0), mix(one.1, other.1), mix(one.2, other.2))
    }
}

fn cell(
    panel: &Panel,
    scene: &mut Scene,
    theme: &Theme,
    (x, y): (usize, usize),
    value: Option<f64>,
    colours: &Colours,
) {
    let corner = |dx: f64, dy: f64| panel.place((x as f64 + dx, y as f64 + dy));
    let (Some((left, top)), Some((right, bottom))) = (corner(-0.5, -0.5), corner(0.5, 0.5)) else { return };
    let colour = value.map_or(GRID, |value| colours.colour(value));
    scene.fill(Layer::Grid, [(left, top), (right, top), (right, bottom), (left, bottom)], colour, 1.0);
    let Colour(r, g, b) = colour;
    // Relative luminance (ITU-R BT.709) decides whether black or white can be read.
    let luminance = (0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)) / 255.0;
    let ink = if luminance > 0.5 { INK } else { PAPER };
    let text = Text::new(written(value), theme.small_font).colour(ink).anchor(Anchor::Middle);
    if text.width() < (right - left).abs() {
        let place = (0.5 * (left + right), 0.5 * (top + bottom) + text.centring());
        scene.text(Layer::Note, place, text);
    }
}
