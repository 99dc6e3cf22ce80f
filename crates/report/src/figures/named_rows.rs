//! Rows below each other with their names left of the frame, broken where they are long, over one axis.

use crate::axis::Axis;
use crate::colour::Colour;
use crate::layout::{Grid, Sheet, Side, wrap};
use crate::palette::INK;
use crate::panel::Panel;
use crate::scene::{Anchor, Layer, Scene, Stroke, Text};
use crate::theme::Theme;

/// The frame of named rows.
pub(super) struct NamedRows {
    pub panel: Panel,
    /// Height of a row.
    pub pitch: f64,
    names: Vec<Vec<String>>,
}

impl NamedRows {
    /// A frame for rows of these names, which take `share` of the page at most.
    pub fn new<'a>(
        sheet: &mut Sheet,
        theme: &Theme,
        names: impl Iterator<Item = &'a str>,
        share: f64,
        across: Side,
    ) -> Option<Self> {
        let names: Vec<Vec<String>> =
            names.map(|name| wrap(name, theme.tick_font, false, share * theme.width)).collect();
        let lines = names.iter().map(Vec::len).max().unwrap_or(1).max(1);
        let pitch = (0.95 + 1.15 * lines as f64) * theme.tick_font;
        let widest = names.iter().flatten().map(|name| Text::new(name.as_str(), theme.tick_font).width());
        let rows = Axis::names(vec![String::new(); names.len()]);
        let row = (Side::new(rows, ""), (names.len().max(1) as f64 + 0.2) * pitch);
        let mut grid = Grid::stack(across, vec![row]);
        grid.left = Some(sheet.left_margin(&grid) + widest.fold(0.0, f64::max));
        Some(Self { panel: sheet.grid(grid).pop()?, pitch, names })
    }

    /// Writes the name of a row left of the frame; returns the height of its middle, where it is in the frame.
    pub fn label(&self, scene: &mut Scene, theme: &Theme, row: usize, colour: Colour) -> Option<f64> {
        let y = self.panel.up(row as f64)?;
        let right = self.panel.rect.x - 0.62 * theme.tick_font;
        let leading = 1.15 * theme.tick_font;
        let lines = &self.names[row];
        for (index, line) in lines.iter().enumerate() {
            let text = Text::new(line.as_str(), theme.tick_font).anchor(Anchor::End).colour(colour);
            let down = (index as f64 - (lines.len() - 1) as f64 / 2.0) * leading;
            scene.text(Layer::Frame, (right, y + down + text.centring()), text);
        }
        Some(y)
    }

    /// Draws what a row is limited to, where that is in the frame.
    pub fn limit(&self, scene: &mut Scene, theme: &Theme, y: f64, limit: Option<f64>) {
        let x = limit.and_then(|limit| self.panel.across(limit));
        if let Some(x) = x.filter(|x| self.panel.rect.contains((*x, y))) {
            let half = 0.42 * self.pitch;
            scene.line(Layer::Data, [(x, y - half), (x, y + half)], limit_stroke(theme));
        }
    }
}

/// The stroke of a limit.
pub(super) fn limit_stroke(theme: &Theme) -> Stroke {
    Stroke::solid(INK, 1.6 * theme.line)
}
