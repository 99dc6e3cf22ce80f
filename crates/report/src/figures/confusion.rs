//! What was named beside what was missing: rows are what the ships lack, columns what a trace named, and a cell is
//! the share of the trials. What is right is outlined, what cannot be told from it is dotted, so a reader sees at once
//! where numbers stand that should not.

use serde::{Deserialize, Serialize};

use crate::axis::Axis;
use crate::colour::Colour;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::palette::{DOTTED, GRID, INK, PAPER, SOLID};
use crate::panel::Panel;
use crate::scene::{Anchor, Layer, Scene, Stroke, Text};
use crate::theme::Theme;

/// What stands in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct ConfusionCell {
    /// Share of the trials of the row in which it was named, per cent.
    pub share: f64,
    /// 95 % interval of the share.
    pub interval: Option<[f64; 2]>,
    /// Whether it is what is missing.
    pub is_right: bool,
    /// Whether it is named for what is missing because records like these cannot tell the two apart.
    pub is_alias: bool,
}

/// One row.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ConfusionRow {
    /// What the ships lack.
    pub name: String,
    /// Number of trials.
    pub trials: u64,
    /// One cell a column.
    pub cells: Vec<ConfusionCell>,
}

/// What [`confusion`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Confusion {
    /// Title above the figure.
    pub title: Option<String>,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// The rows from the top.
    pub rows: Vec<ConfusionRow>,
}

/// Smallest type that can be read, points.
const SMALLEST: f64 = 6.5;

/// Shade of a cell with 100 %.
const FULL: Colour = Colour(0x00, 0x72, 0xB2);

/// Draws the matrix; shares in per cent, an empty cell is never.
pub fn confusion(data: &Confusion, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let box_of = |dash| Sample::Line(Stroke::solid(INK, 1.4 * theme.line).dashed(dash));
    let aliases = data.rows.iter().flat_map(|row| &row.cells).any(|cell| cell.is_alias);
    let is_known = data.rows.iter().flat_map(|row| &row.cells).any(|cell| cell.is_right);
    let mut entries = Vec::new();
    entries.extend(is_known.then(|| Entry::new(box_of(SOLID), "what is missing")));
    entries.extend(aliases.then(|| Entry::new(box_of(DOTTED), "cannot be told from it")));
    sheet.legend(&entries);
    // In a narrow figure there is no room for intervals.
    let lines = if !theme.is_narrow() && data.rows.iter().flat_map(|row| &row.cells).any(|cell| bracket(cell).is_some())
    {
        2.0
    } else {
        1.0
    };
    let height = (data.rows.len().max(1) as f64 + 0.2) * (lines * 1.15 + 0.5) * theme.small_font;
    let name = |row: &ConfusionRow| match theme.is_narrow() {
        true => format!("{}, {}", row.name, row.trials),
        false => format!("{} (n = {})", row.name, row.trials),
    };
    let rows = (Side::new(Axis::names(data.rows.iter().map(name).collect()), ""), height);
    let columns = Side::new(Axis::columns(data.columns.clone()), "named by the trace");
    let panels = sheet.grid(Grid::new(vec![columns], vec![rows]));
    if let Some(panel) = panels.first() {
        for (y, row) in data.rows.iter().enumerate() {
            for (x, cell) in row.cells.iter().enumerate() {
                draw(panel, &mut sheet.scene, theme, (x, y), cell);
            }
        }
    }
    sheet.note(match theme.is_narrow() {
        true => "Shares of the trials in per cent; white: never named, full without a number: 100. Behind the names: trials.",
        false => "Shares of the trials in per cent, with 95 % intervals where there is room; empty: never named.",
    });
    sheet.finish()
}

/// The interval of a share that is neither none nor all of the trials.
fn bracket(cell: &ConfusionCell) -> Option<String> {
    let [low, high] = cell.interval.filter(|_| cell.share > 0.0 && cell.share < 100.0)?;
    Some(format!("{low:.0}–{high:.0}"))
}

fn draw(panel: &Panel, scene: &mut Scene, theme: &Theme, (x, y): (usize, usize), cell: &ConfusionCell) {
    let corner = |dx: f64, dy: f64| panel.place((x as f64 + dx, y as f64 + dy));
    let (Some((left, top)), Some((right, bottom))) = (corner(-0.5, -0.5), corner(0.5, 0.5)) else { return };
    let corners =
        |by: f64| [(left + by, top + by), (right - by, top + by), (right - by, bottom - by), (left + by, bottom - by)];
    let share = (cell.share / 100.0).clamp(0.0, 1.0);
    if share > 0.0 {
        scene.fill(Layer::Grid, corners(0.0), FULL, 0.12 + 0.88 * share);
    }
    let hair = Stroke::solid(GRID, theme.thin);
    scene.line(Layer::Data, [(left, bottom), (right, bottom)], hair);
    scene.line(Layer::Data, [(right, top), (right, bottom)], hair);
    if cell.is_right || cell.is_alias {
        let width = 1.4 * theme.line;
        let [a, b, c, d] = corners(0.5 * width);
        let stroke = Stroke::solid(INK, width);
        let stroke = if cell.is_right { stroke } else { stroke.dashed(DOTTED) };
        scene.line(Layer::Frame, [a, b, c, d, a, b], stroke);
    }
    if share <= 0.0 {
        return;
    }
    let ink = if share > 0.55 { PAPER } else { INK };
    let middle = (0.5 * (left + right), 0.5 * (top + bottom));
    let number = |text: String, size: f64| Text::new(text, size).colour(ink).anchor(Anchor::Middle);
    // A rare one is not none.
    let value = if cell.share < 0.5 { "<1".to_owned() } else { crate::number::fixed(cell.share, 0) };
    let value = number(value, theme.small_font);
    // Three digits in a narrow cell would be cut by its outline.
    if theme.is_narrow() && cell.share >= 99.5 && value.width() > right - left - 2.8 * theme.line {
        return;
    }
    let interval = bracket(cell).map(|text| number(text, (0.8 * theme.small_font).max(SMALLEST)));
    match interval.filter(|text| text.width() < 0.96 * (right - left)) {
        Some(interval) => {
            scene.text(Layer::Note, (middle.0, middle.1 - 0.1 * theme.small_font), value);
            scene.text(Layer::Note, (middle.0, middle.1 + 0.9 * theme.small_font), interval);
        }
        None => {
            let place = (middle.0, middle.1 + value.centring());
            scene.text(Layer::Note, place, value);
        }
    }
}
