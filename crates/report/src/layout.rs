//! Where things go on the page: title, legend, panels and notes from top to bottom, margins as wide as their labels.
//! Panels of one column share the horizontal axis, panels of one row the vertical one; their frames, ticks and titles
//! are drawn here, the data by the figures. Longer than most: every part of a page moves the parts below it.

use crate::axis::{PlotAxis, Ticks};
use crate::clip::Rect;
use crate::figure::Drawing;
use crate::fonts::text_width;
use crate::legend::{self, KeyEntry};
use crate::lines::{LEADING, wrap};
use crate::palette::{GRID, INK, PAPER};
use crate::panel::Panel;
use crate::scene::{Anchor, Canvas, Layer, Stroke, TextLine};
use crate::svg;
use crate::theme::Theme;

/// Largest share of the page for the names of rows; longer ones are broken into lines.
pub(crate) const NAMES: f64 = 0.42;

/// One side of a grid of panels: a column with its horizontal axis or a row with its vertical one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AxisSide {
    pub axis: PlotAxis,
    pub title: String,
}

impl AxisSide {
    pub(crate) fn new(axis: PlotAxis, title: impl Into<String>) -> Self {
        Self { axis, title: title.into() }
    }
}

/// Panels in rows and columns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Grid {
    pub columns: Vec<AxisSide>,
    /// Rows with their heights in points.
    pub rows: Vec<(AxisSide, f64)>,
    /// Line above each panel, row by row; empty when there is none.
    pub heads: Vec<Option<KeyEntry>>,
    /// Number of panels, when the last row is not full.
    pub panels: Option<usize>,
    /// Title of all vertical axes together, for rows too low to have one each.
    pub shared_title: Option<String>,
    /// Left margin, points, when it has to agree with another grid.
    pub left: Option<f64>,
}

impl Grid {
    /// Full rows without heads.
    pub(crate) fn new(columns: Vec<AxisSide>, rows: Vec<(AxisSide, f64)>) -> Self {
        Self { columns, rows, heads: Vec::new(), panels: None, shared_title: None, left: None }
    }

    /// Panels above each other over one horizontal axis.
    pub(crate) fn stack(x: AxisSide, rows: Vec<(AxisSide, f64)>) -> Self {
        Self::new(vec![x], rows)
    }

    /// So many panels with the same axes, in rows of `across`; the last row may not be full.
    pub(crate) fn alike(count: usize, across: usize, column: AxisSide, row: (AxisSide, f64)) -> Self {
        let rows = vec![row; count.div_ceil(across)];
        Self { panels: Some(count), ..Self::new(vec![column; across], rows) }
    }

    fn panel_count(&self) -> usize {
        let all = self.rows.len() * self.columns.len();
        self.panels.map_or(all, |n| n.min(all))
    }
}

/// A figure in the making, filled from top to bottom.
#[derive(Debug, Clone)]
pub(crate) struct Sheet {
    pub theme: Theme,
    pub scene: Canvas,
    y: f64,
    /// Left edge of the strip that is being filled, points.
    edge: f64,
}

impl Sheet {
    pub(crate) fn new(theme: &Theme, title: Option<&str>) -> Self {
        let mut sheet = Self { theme: *theme, scene: Canvas::default(), y: 0.5 * theme.small_font, edge: 0.0 };
        if let Some(title) = title {
            let size = theme.title_font;
            for line in wrap(title, size, true, theme.width - 2.0 * theme.small_font) {
                sheet.y += 1.2 * size;
                let text = TextLine { bold: true, ..TextLine::new(line, size).anchor(Anchor::Middle) };
                sheet.scene.text(Layer::Note, (theme.width / 2.0, sheet.y), text);
            }
            sheet.y += 0.7 * size;
        }
        sheet
    }

    /// The key, centred above what follows.
    pub(crate) fn legend(&mut self, entries: &[KeyEntry]) {
        if entries.is_empty() {
            return;
        }
        let theme = self.theme;
        let margin = theme.small_font;
        let starts = legend::columns(entries, theme.width - 2.0 * margin, &theme);
        let last = starts.len() - 1;
        let used =
            entries.chunks(starts.len()).filter_map(|row| row.get(last)).map(|e| e.width(&theme)).fold(0.0, f64::max)
                + starts[last];
        let left = ((theme.width - used) / 2.0).max(margin);
        let room = theme.width - left - margin;
        for row in entries.chunks(starts.len()) {
            self.y += LEADING * theme.small_font;
            let mut most = 1;
            for (entry, start) in row.iter().zip(&starts) {
                if let Some(ink) = entry.ink() {
                    self.scene.key(ink, &entry.label);
                }
                most = most.max(entry.draw(&mut self.scene, (left + start, self.y), room - start, &theme));
            }
            self.y += LEADING * theme.small_font * (most - 1) as f64;
        }
        self.y += 0.7 * theme.small_font;
    }

    /// A remark under what was drawn so far, wrapped to the width of the page.
    pub(crate) fn note(&mut self, text: &str) {
        let theme = self.theme;
        let margin = theme.small_font;
        for line in wrap(text, theme.small_font, false, theme.width - 2.0 * margin) {
            self.y += LEADING * theme.small_font;
            self.scene.text(Layer::Note, (margin, self.y), TextLine::new(line, theme.small_font));
        }
        self.y += 0.2 * theme.small_font;
    }

    /// Margin that the labels and titles of the rows need, points.
    pub(crate) fn left_margin(&self, grid: &Grid) -> f64 {
        let theme = &self.theme;
        let lines = |label: &str| wrap(label, theme.tick_font, false, NAMES * theme.width);
        let width =
            |label: &str| lines(label).iter().map(|line| text_width(line, theme.tick_font, false)).fold(0.0, f64::max);
        let ticks = grid.rows.iter().flat_map(|(side, height)| self.row_ticks(side, *height).major);
        let widths = ticks.map(|(_, label)| width(&label));
        let lines = grid.rows.iter().map(|(side, height)| self.row_title(side, *height).len()).max().unwrap_or(0);
        let lines = lines.max(usize::from(grid.shared_title.is_some()));
        let titles = if lines == 0 { 0.0 } else { (lines as f64 * 1.2 + 0.5) * theme.label_font };
        0.5 * theme.small_font + titles + widths.fold(0.0, f64::max) + self.tick_length() + 0.4 * theme.tick_font
    }

    fn row_ticks(&self, side: &AxisSide, height: f64) -> Ticks {
        side.axis.ticks(((height / (1.7 * self.theme.tick_font)) as usize).max(2))
    }

    fn row_title(&self, side: &AxisSide, height: f64) -> Vec<String> {
        wrap(&side.title, self.theme.label_font, false, height)
    }

    fn tick_length(&self) -> f64 {
        0.32 * self.theme.tick_font
    }

    /// Distance between panels side by side.
    pub(crate) fn gap(theme: &Theme) -> f64 {
        2.6 * theme.tick_font
    }

    /// Margin right of the panels, points.
    pub(crate) fn right_margin(theme: &Theme) -> f64 {
        1.6 * theme.tick_font
    }

    /// How far down the page the sheet is filled, points.
    pub(crate) fn height(&self) -> f64 {
        self.y
    }

    /// Goes on at another height, for what stands beside what was drawn.
    pub(crate) fn rewind(&mut self, y: f64) {
        self.y = y;
    }

    /// Draws a grid into a strip of the page: its left edge and its width, points. The left margin of the grid is the
    /// least one.
    pub(crate) fn grid_within(&mut self, grid: Grid, (left, width): (f64, f64)) -> Vec<Panel> {
        let page = self.theme;
        let margin = self.left_margin(&grid).max(grid.left.unwrap_or(0.0));
        // The strip is laid out like a page that ends where it ends.
        self.theme.width = left + width;
        self.edge = left;
        let panels = self.grid(Grid { left: Some(left + margin), ..grid });
        (self.theme, self.edge) = (page, 0.0);
        panels
    }

    /// Draws the frames and returns the panels, row by row.
    pub(crate) fn grid(&mut self, grid: Grid) -> Vec<Panel> {
        let theme = self.theme;
        let mut grid = grid;
        let sides = grid.columns.iter_mut().chain(grid.rows.iter_mut().map(|(side, _)| side));
        sides.for_each(|side| theme.changes.limit(&mut side.axis, &side.title));
        let count = grid.columns.len().max(1);
        let left = grid.left.unwrap_or_else(|| self.left_margin(&grid));
        let right = Self::right_margin(&theme);
        let gap = Self::gap(&theme);
        let width = ((theme.width - left - right - gap * (count - 1) as f64) / count as f64).max(theme.tick_font);
        let total = grid.panel_count();
        let mut panels = Vec::with_capacity(total);
        let mut lowest = self.y;
        for (row, (side, height)) in grid.rows.iter().enumerate() {
            let room = width + gap - theme.small_font;
            let heads = grid.heads.iter().skip(row * count).take(count).flatten();
            let lines = heads.map(|head| head.lines(room, &theme).len()).max().unwrap_or(0) as f64;
            if lines > 0.0 {
                self.y += (0.15 + LEADING * lines) * theme.small_font;
            }
            let ticks = self.row_ticks(side, *height);
            for (column, across) in grid.columns.iter().enumerate() {
                let index = row * count + column;
                if index >= total {
                    break;
                }
                let rect = Rect { x: left + column as f64 * (width + gap), y: self.y, w: width, h: *height };
                if let Some(head) = grid.heads.get(index).and_then(Option::as_ref) {
                    let above = 0.45 + LEADING * (lines - 1.0);
                    head.draw(&mut self.scene, (rect.x, rect.y - above * theme.small_font), room, &theme);
                }
                let marks = fitting_ticks(&across.axis, width, &theme);
                self.frame(&rect, &marks, &ticks, !across.axis.is_columns());
                self.axis_breaks(&rect, across, side);
                if column == 0 {
                    self.vertical_labels(&rect, &ticks, side);
                }
                if index + count >= total {
                    lowest = lowest.max(self.horizontal_labels(&rect, &marks, across));
                }
                let title = if side.title.is_empty() { grid.shared_title.as_ref() } else { Some(&side.title) };
                self.scene.panel(svg::panel(
                    &rect,
                    (&across.axis, &across.title),
                    (&side.axis, title.map_or("", String::as_str)),
                ));
                panels.push(Panel { rect, x: across.axis.clone(), y: side.axis.clone() });
            }
            self.y += height + 0.75 * theme.tick_font;
        }
        if let (Some(title), Some(first), Some(last)) = (&grid.shared_title, panels.first(), panels.last()) {
            self.vertical_title([title.clone()], (first.rect.y + last.rect.bottom()) / 2.0);
        }
        self.y = lowest;
        panels
    }

    /// The frame with its ticks, over grid lines unless the cells of a map have lines of their own.
    fn frame(&mut self, rect: &Rect, x: &Ticks, y: &Ticks, gridded: bool) {
        let stroke = Stroke::solid(INK, self.theme.thin);
        let grid = Stroke::solid(GRID, 0.8 * self.theme.thin);
        let (long, short) = (self.tick_length(), 0.55 * self.tick_length());
        let across = |f: f64| rect.x + f * rect.w;
        let up = |f: f64| rect.bottom() - f * rect.h;
        for (f, _) in x.major.iter().filter(|_| gridded) {
            self.scene.line(Layer::Grid, [(across(*f), rect.y), (across(*f), rect.bottom())], grid);
        }
        for (f, _) in y.major.iter().filter(|_| gridded) {
            self.scene.line(Layer::Grid, [(rect.x, up(*f)), (rect.right(), up(*f))], grid);
        }
        let ends = |ticks: &Ticks| -> Vec<(f64, f64)> {
            let minor = ticks.minor.iter().map(|f| (*f, short));
            ticks.major.iter().map(|(f, _)| (*f, long)).chain(minor).collect()
        };
        for (f, length) in ends(x) {
            self.scene.line(Layer::Frame, [(across(f), rect.bottom()), (across(f), rect.bottom() + length)], stroke);
        }
        for (f, length) in ends(y) {
            self.scene.line(Layer::Frame, [(rect.x - length, up(f)), (rect.x, up(f))], stroke);
        }
        let (l, t, r, b) = (rect.x, rect.y, rect.right(), rect.bottom());
        // The first corner is repeated and passed, so that it gets a join like the others.
        self.scene.line(Layer::Frame, [(l, t), (r, t), (r, b), (l, b), (l, t), (r, t)], stroke);
    }

    /// Two short slanted lines on the frame where a logarithmic axis jumps to zero.
    fn axis_breaks(&mut self, rect: &Rect, x: &AxisSide, y: &AxisSide) {
        let size = 0.45 * self.theme.tick_font;
        let mut mark = |centre: (f64, f64), along: (f64, f64)| {
            let side = |s: f64| (centre.0 + s * along.0, centre.1 + s * along.1);
            let slant = |(cx, cy): (f64, f64)| {
                // Perpendicular to the axis, leaning along it.
                let (dx, dy) = (along.1.abs() + 0.4 * along.0.abs(), along.0.abs() + 0.4 * along.1.abs());
                [(cx - size * dx, cy + size * dy), (cx + size * dx, cy - size * dy)]
            };
            let (a, b) = (side(-0.35 * size), side(0.35 * size));
            let (sa, sb) = (slant(a), slant(b));
            self.scene.fill(Layer::Frame, [sa[0], sa[1], sb[1], sb[0]], PAPER, 1.0);
            self.scene.line(Layer::Frame, sa, Stroke::solid(INK, self.theme.thin));
            self.scene.line(Layer::Frame, sb, Stroke::solid(INK, self.theme.thin));
        };
        if let Some(f) = x.axis.break_at() {
            mark((rect.x + f * rect.w, rect.bottom()), (1.0, 0.0));
        }
        if let Some(f) = y.axis.break_at() {
            mark((rect.x, rect.bottom() - f * rect.h), (0.0, 1.0));
        }
    }

    fn vertical_labels(&mut self, rect: &Rect, ticks: &Ticks, side: &AxisSide) {
        let theme = self.theme;
        let end = rect.x - self.tick_length() - 0.3 * theme.tick_font;
        for (f, label) in &ticks.major {
            let lines = wrap(label, theme.tick_font, false, NAMES * theme.width);
            for (index, line) in lines.iter().enumerate() {
                let text = TextLine::new(line.as_str(), theme.tick_font).anchor(Anchor::End);
                let down = (index as f64 - 0.5 * (lines.len() - 1) as f64) * 1.15 * theme.tick_font;
                self.scene.text(Layer::Frame, (end, rect.bottom() - f * rect.h + down + text.centring()), text);
            }
        }
        self.vertical_title(self.row_title(side, rect.h), rect.y + rect.h / 2.0);
    }

    fn vertical_title(&mut self, lines: impl IntoIterator<Item = String>, middle: f64) {
        let theme = self.theme;
        for (i, line) in lines.into_iter().enumerate() {
            let x = self.edge + 0.5 * theme.small_font + (0.85 + 1.2 * i as f64) * theme.label_font;
            let text = TextLine { turned: true, ..TextLine::new(line, theme.label_font).anchor(Anchor::Middle) };
            self.scene.text(Layer::Frame, (x, middle), text);
        }
    }

    /// Labels and title under a panel; returns where they end.
    fn horizontal_labels(&mut self, rect: &Rect, ticks: &Ticks, side: &AxisSide) -> f64 {
        let theme = self.theme;
        let mut base = rect.bottom() + self.tick_length() + 1.05 * theme.tick_font;
        let pitch = rect.w / ticks.major.len().max(1) as f64 - 0.4 * theme.tick_font;
        let has_room =
            |(_, label): &(f64, String)| label.split(' ').all(|word| text_width(word, theme.tick_font, false) <= pitch);
        let is_names = side.axis.is_columns();
        if is_names && !fits(ticks, rect.w, &theme) && !ticks.major.iter().all(has_room) {
            // Names with words too long to stand side by side are turned and end at their tick.
            let top = rect.bottom() + self.tick_length() + 0.3 * theme.tick_font;
            for (f, label) in &ticks.major {
                let text =
                    TextLine { turned: true, ..TextLine::new(label.as_str(), theme.tick_font).anchor(Anchor::End) };
                let x = rect.x + f * rect.w + text.centring();
                self.scene.text(Layer::Frame, (x, top), text);
            }
            base = top + label_width(ticks, &theme);
        } else {
            let mut lowest = base;
            for (f, label) in &ticks.major {
                let lines = wrap(label, theme.tick_font, false, if is_names { pitch } else { f64::INFINITY });
                for (index, line) in lines.into_iter().enumerate() {
                    let down = base + 1.15 * theme.tick_font * index as f64;
                    let text = TextLine::new(line, theme.tick_font).anchor(Anchor::Middle);
                    self.scene.text(Layer::Frame, (rect.x + f * rect.w, down), text);
                    lowest = lowest.max(down);
                }
            }
            base = lowest;
        }
        let mut y = base + 0.25 * theme.label_font;
        for line in wrap(&side.title, theme.label_font, false, rect.w + theme.label_font) {
            y += 1.2 * theme.label_font;
            let text = TextLine::new(line, theme.label_font).anchor(Anchor::Middle);
            self.scene.text(Layer::Frame, (rect.x + rect.w / 2.0, y), text);
        }
        y + 0.8 * theme.label_font
    }

    /// The finished figure.
    pub(crate) fn finish(self) -> Drawing {
        let height = self.y + 0.3 * self.theme.small_font;
        let svg = svg::render(&self.scene, self.theme.width, height, &self.theme.changes);
        Drawing::new(svg, self.theme.width, height, self.theme.dpi)
    }
}

/// As many ticks as their labels leave room for.
fn fitting_ticks(axis: &PlotAxis, width: f64, theme: &Theme) -> Ticks {
    (2..=10)
        .rev()
        .map(|count| axis.ticks(count))
        .find(|ticks| fits(ticks, width, theme))
        .unwrap_or_else(|| axis.ticks(1))
}

/// Distance of these ticks, in units of the axis.
pub(crate) fn fitting_step(axis: &PlotAxis, width: f64, theme: &Theme) -> Option<f64> {
    match &fitting_ticks(axis, width, theme).major[..] {
        [(first, _), (second, _), ..] => Some(axis.worth(second - first)),
        _ => None,
    }
}

/// Whether labels under an axis of this width stand clear of each other.
fn fits(ticks: &Ticks, width: f64, theme: &Theme) -> bool {
    let gap = 1.0 * theme.tick_font;
    ticks.major.windows(2).all(|pair| {
        let half = |label: &str| TextLine::new(label, theme.tick_font).width() / 2.0;
        (pair[1].0 - pair[0].0).abs() * width >= half(&pair[0].1) + half(&pair[1].1) + gap
    })
}

fn label_width(ticks: &Ticks, theme: &Theme) -> f64 {
    ticks.major.iter().map(|(_, label)| TextLine::new(label.as_str(), theme.tick_font).width()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ticks::TickSteps;

    #[test]
    fn panels_share_edges_and_stay_on_the_page() {
        let theme = Theme::paper(85.0, 300.0).unwrap();
        let mut sheet = Sheet::new(&theme, Some("title"));
        let side = |hi: f64| AxisSide::new(PlotAxis::linear(0.0, hi, TickSteps::Decimal), "quantity [unit]");
        let rows = vec![(side(1e5), 60.0), (side(0.001), 40.0)];
        let panels = sheet.grid(Grid { panels: Some(3), ..Grid::new(vec![side(1.0), side(2.0)], rows) });
        assert_eq!(panels.len(), 3);
        assert_eq!(panels[0].rect.x, panels[2].rect.x);
        assert_eq!(panels[0].rect.y, panels[1].rect.y);
        assert!(panels.iter().all(|p| p.rect.x > 0.0 && p.rect.right() < theme.width));
        let figure = sheet.finish();
        assert!(figure.size().1 > panels[2].rect.bottom());
        assert_eq!(
            figure.svg().matches(">\nquantity [unit]").count() + figure.svg().matches(">\nquantity\n").count(),
            4
        );
    }

    #[test]
    fn heads_and_keys_that_are_too_long_go_on_below() {
        let theme = Theme::paper(85.0, 300.0).unwrap();
        let side = || AxisSide::new(PlotAxis::linear(0.0, 1.0, TickSteps::Decimal), "x");
        let head = |text: &str| Some(KeyEntry::new(legend::KeySample::Nothing, text));
        let drawn = |text: &str| {
            let mut sheet = Sheet::new(&theme, None);
            sheet.legend(&[KeyEntry::new(legend::KeySample::Nothing, text.repeat(4))]);
            let heads = vec![head(text), head("b"), head("c")];
            let panels = sheet.grid(Grid { heads, ..Grid::new(vec![side(), side(), side()], vec![(side(), 40.0)]) });
            panels[0].rect.y
        };
        assert!(drawn("heading noise of the compass = 0.01 ") > drawn("a") + 3.0 * theme.small_font);
    }
}
