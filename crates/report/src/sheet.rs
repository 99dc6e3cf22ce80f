//! Where things go on the page: title, key, panels and notes from top to bottom, margins as wide as their labels.
//! Panels of one column share the horizontal axis, panels of one row the vertical one. The page is split into drawing
//! areas of plotters, whose charts draw mesh, axes, ticks and labels; the figures draw the data.

use plotters::chart::{ChartBuilder, LabelAreaPosition};
use plotters::drawing::IntoDrawingArea as _;

use crate::axis::Axis;
use crate::backend::{Drawn, Svg, units};
use crate::canvas::{Anchor, Area, Canvas, Stroke, TextLine};
use crate::chart::Chart;
use crate::figure::Drawing;
use crate::fonts::{LINE, text_width};
use crate::key::{self, KeyEntry};
use crate::lines::{LEADING, balanced, wrap};
use crate::palette::{GRID, INK};
use crate::theme::Theme;

/// Largest share of the page for the names of rows; longer ones are broken into lines.
pub(crate) const NAMES: f64 = 0.42;

/// Density of the lines between ticks on a logarithmic axis.
const LIGHT: f64 = 0.45;

/// One side of a grid of panels: a column with its horizontal axis or a row with its vertical one.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AxisSide {
    pub axis: Axis,
    pub title: String,
}

impl AxisSide {
    pub(crate) fn new(axis: Axis, title: impl Into<String>) -> Self {
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

/// What of a panel is labelled, and where it stands in its area.
struct PanelPlan {
    /// Room left and right of the frame, and above and below it, points.
    margins: [f64; 4],
    /// Whether labels and title stand at the left, and below.
    labelled: [bool; 2],
    /// Whether the names below are turned.
    is_turned: bool,
}

/// A figure in the making, filled from top to bottom.
pub(crate) struct Sheet {
    pub theme: Theme,
    pub canvas: Canvas,
    y: f64,
    /// Left edge of the strip that is being filled, points.
    edge: f64,
}

impl Sheet {
    pub(crate) fn new(theme: &Theme, title: Option<&str>) -> Drawn<Self> {
        let svg = Svg::new(theme.width, theme.changes);
        let canvas = Canvas { area: svg.clone().into_drawing_area(), svg };
        let mut sheet = Self { theme: *theme, canvas, y: 0.5 * theme.small_font, edge: 0.0 };
        if let Some(title) = title {
            let size = theme.title_font;
            for line in balanced(title, size, true, theme.width - 2.0 * theme.small_font) {
                sheet.y += 1.2 * size;
                let text = TextLine { bold: true, ..TextLine::new(line, size).anchor(Anchor::Middle) };
                sheet.canvas.text((theme.width / 2.0, sheet.y - 0.36 * size), &text)?;
            }
            sheet.y += 0.7 * size;
        }
        Ok(sheet)
    }

    /// The key, centred above what follows.
    pub(crate) fn legend(&mut self, entries: &[KeyEntry]) -> Drawn {
        if entries.is_empty() {
            return Ok(());
        }
        let theme = self.theme;
        let margin = theme.small_font;
        let starts = key::columns(entries, theme.width - 2.0 * margin, &theme);
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
                let place = (left + start, self.y - 0.36 * theme.small_font);
                most = most.max(entry.draw(&self.canvas, place, room - start, &theme)?);
            }
            self.y += LEADING * theme.small_font * (most - 1) as f64;
        }
        self.y += 0.7 * theme.small_font;
        Ok(())
    }

    /// A remark under what was drawn so far, wrapped to the width of the page.
    pub(crate) fn note(&mut self, text: &str) -> Drawn {
        let theme = self.theme;
        let margin = theme.small_font;
        for line in wrap(text, theme.small_font, false, theme.width - 2.0 * margin) {
            self.y += LEADING * theme.small_font;
            let text = TextLine::new(line, theme.small_font);
            self.canvas.text((margin, self.y - 0.36 * theme.small_font), &text)?;
        }
        self.y += 0.2 * theme.small_font;
        Ok(())
    }

    /// Margin that the labels and titles of the rows need, points.
    pub(crate) fn left_margin(&self, grid: &Grid) -> f64 {
        let theme = &self.theme;
        let sides = grid.rows.iter().map(|(side, height)| self.row_axis(side, *height));
        let widths = sides.map(|axis| widest(&axis, theme)).fold(0.0, f64::max);
        let lines = grid.rows.iter().map(|(side, height)| self.row_title(side, *height).len()).max().unwrap_or(0);
        let lines = lines.max(usize::from(grid.shared_title.is_some()));
        let titles = if lines == 0 { 0.0 } else { (lines as f64 * LINE + 0.5) * theme.label_font };
        0.5 * theme.small_font + titles + widths + 2.0 * self.tick_length()
    }

    /// The axis of a row with its ticks and labels.
    fn row_axis(&self, side: &AxisSide, height: f64) -> Axis {
        let theme = &self.theme;
        let count = ((height / (1.7 * theme.tick_font)) as usize).max(2);
        side.axis.clone().ticked(count).wrapped(theme.tick_font, NAMES * theme.width)
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
    pub(crate) fn grid_within(&mut self, grid: Grid, (left, width): (f64, f64)) -> Drawn<Vec<Chart>> {
        let page = self.theme;
        let margin = self.left_margin(&grid).max(grid.left.unwrap_or(0.0));
        // The strip is laid out like a page that ends where it ends.
        self.theme.width = left + width;
        self.edge = left;
        let charts = self.grid(Grid { left: Some(left + margin), ..grid });
        (self.theme, self.edge) = (page, 0.0);
        charts
    }

    /// Draws mesh, axes and labels of the panels and returns their charts, row by row.
    pub(crate) fn grid(&mut self, mut grid: Grid) -> Drawn<Vec<Chart>> {
        let theme = self.theme;
        let sides = grid.columns.iter_mut().chain(grid.rows.iter_mut().map(|(side, _)| side));
        sides.for_each(|side| theme.changes.limit(&mut side.axis, &side.title));
        let count = grid.columns.len().max(1);
        let left = grid.left.unwrap_or_else(|| self.left_margin(&grid));
        let gap = Self::gap(&theme);
        let inner = theme.width - left - Self::right_margin(&theme) - gap * (count - 1) as f64;
        let width = (inner / count as f64).max(theme.tick_font);
        let columns: Vec<AxisSide> = grid
            .columns
            .iter()
            .map(|side| AxisSide::new(column_axis(&side.axis, width, &theme), &*side.title))
            .collect();
        let total = grid.panel_count();
        let mut charts = Vec::with_capacity(total);
        let mut lowest = self.y;
        for (row, (side, height)) in grid.rows.iter().enumerate() {
            let room = width + gap - theme.small_font;
            let heads: Vec<Option<&KeyEntry>> =
                (0..count).map(|column| grid.heads.get(row * count + column)?.as_ref()).collect();
            let lines = heads.iter().flatten().map(|head| head.lines(room, &theme).len()).max().unwrap_or(0) as f64;
            if lines > 0.0 {
                self.y += (0.15 + LEADING * lines) * theme.small_font;
            }
            let up = AxisSide::new(self.row_axis(side, *height), &*side.title);
            let below: Vec<f64> = columns.iter().map(|column| self.room_below(column, width)).collect();
            let deepest = below.iter().copied().fold(0.0, f64::max);
            let areas = self.areas(count, (left, width + gap), height + deepest);
            for (column, area) in areas.iter().enumerate().take(total - (row * count).min(total)) {
                let start = left + column as f64 * (width + gap);
                if let Some(head) = heads[column] {
                    let above = 0.45 + LEADING * (lines - 1.0) + 0.36;
                    head.draw(&self.canvas, (start, self.y - above * theme.small_font), room, &theme)?;
                }
                let is_last = row * count + column + count >= total;
                let beside = if column == 0 { left - self.edge } else { self.tick_length() };
                let under = if is_last { below[column] } else { self.tick_length() };
                let across = &columns[column];
                let plan = PanelPlan {
                    margins: [beside, width, *height, under],
                    labelled: [column == 0, is_last],
                    is_turned: across.axis.is_names() && !across.axis.fits(width, theme.tick_font),
                };
                let chart = self.chart(area, (across, &up), &plan)?;
                let title = if side.title.is_empty() { grid.shared_title.as_deref() } else { Some(&*side.title) };
                let axes =
                    [(across.axis.described(), &*across.title), (up.axis.described(), title.unwrap_or_default())];
                self.canvas.svg.panel(chart.bounds(), axes);
                if is_last {
                    lowest = lowest.max(self.y + height + below[column]);
                }
                charts.push(chart);
            }
            self.y += height + 0.75 * theme.tick_font;
        }
        if let (Some(title), Some(first), Some(last)) = (&grid.shared_title, charts.first(), charts.last()) {
            let text = TextLine::new(title.as_str(), theme.label_font).anchor(Anchor::Middle);
            let x = self.edge + 0.5 * (theme.small_font + theme.label_font);
            let middle = (first.rect.y + last.rect.bottom()) / 2.0;
            self.canvas.text((x, middle), &TextLine { turned: true, ..text })?;
        }
        self.y = lowest + 0.55 * theme.label_font;
        Ok(charts)
    }

    /// The drawing areas of a row of panels, each with what stands beside and below it.
    fn areas(&self, count: usize, (left, pitch): (f64, f64), height: f64) -> Vec<Area> {
        let (_, below) = self.canvas.area.split_vertically(units(self.y));
        let (strip, _) = below.split_vertically(units(height));
        let (_, strip) = strip.split_horizontally(units(self.edge));
        let start = |column: usize| left + column as f64 * pitch - self.tick_length() - self.edge;
        let breaks: Vec<i32> = (1..count).map(|column| units(start(column))).collect();
        strip.split_by_breakpoints(&breaks, &[] as &[i32])
    }

    /// A chart of plotters with its mesh, axes, ticks, labels and titles.
    fn chart(&self, area: &Area, (x, y): (&AxisSide, &AxisSide), plan: &PanelPlan) -> Drawn<Chart> {
        let theme = &self.theme;
        let [beside, width, height, under] = plan.margins.map(units);
        let (whole, tall) = area.dim_in_pixel();
        let pad = if plan.labelled[0] { units(0.5 * theme.small_font) } else { 0 };
        let mut context = ChartBuilder::on(area)
            .margin_left(pad)
            .margin_right((whole as i32 - beside - width).max(0))
            .margin_bottom((tall as i32 - height - under).max(0))
            .y_label_area_size(beside - pad)
            .x_label_area_size(under)
            .build_cartesian_2d(x.axis.clone(), y.axis.clone())?;
        let text = |size: f64| TextLine::new("", size).style();
        let grid = Stroke::solid(GRID, 0.8 * theme.thin);
        let [left_labels, lower_labels] = plan.labelled;
        let across = |value: &f64| if lower_labels && !plan.is_turned { x.axis.label(*value) } else { String::new() };
        let up = |value: &f64| if left_labels { y.axis.label(*value) } else { String::new() };
        let mut mesh = context.configure_mesh();
        mesh.bold_line_style(grid.style())
            .light_line_style(Stroke { opacity: LIGHT, ..grid }.style())
            .axis_style(Stroke::solid(INK, theme.thin).style())
            .label_style(text(theme.tick_font))
            .axis_desc_style(text(theme.label_font))
            .set_tick_mark_size(LabelAreaPosition::Left, units(self.tick_length()))
            .set_tick_mark_size(LabelAreaPosition::Bottom, units(self.tick_length()))
            .x_label_formatter(&across)
            .y_label_formatter(&up);
        if x.axis.is_names() {
            // The cells of a map have lines of their own.
            mesh.disable_mesh();
        }
        if left_labels {
            mesh.y_desc(self.row_title(y, plan.margins[2]).join("\n"));
        }
        if lower_labels {
            mesh.x_desc(self.column_title(x, plan.margins[1]).join("\n"));
        }
        mesh.draw()?;
        let chart = Chart::new(&context, self.canvas.clone(), [x.axis.clone(), y.axis.clone()]);
        if lower_labels && plan.is_turned {
            // Names with words too long to stand side by side are turned and end at their tick.
            let top = chart.rect.bottom() + 2.0 * self.tick_length();
            for (value, label) in x.axis.ticks() {
                let text = TextLine::new(label.as_str(), theme.tick_font).anchor(Anchor::End);
                let place = (chart.across(*value).unwrap_or(f64::NAN), top);
                self.canvas.text(place, &TextLine { turned: true, ..text })?;
            }
        }
        Ok(chart)
    }

    fn column_title(&self, side: &AxisSide, width: f64) -> Vec<String> {
        wrap(&side.title, self.theme.label_font, false, width + self.theme.label_font)
    }

    /// Room that labels and title below a panel need, points.
    fn room_below(&self, side: &AxisSide, width: f64) -> f64 {
        let theme = &self.theme;
        let labels = match side.axis.is_names() && !side.axis.fits(width, theme.tick_font) {
            true => widest(&side.axis, theme),
            false => {
                let lines = side.axis.labels().map(|label| label.split('\n').count()).max().unwrap_or(0);
                LINE * theme.tick_font * lines as f64
            }
        };
        let title = self.column_title(side, width).len() as f64;
        let title = if title > 0.0 { (0.45 + LINE * title) * theme.label_font } else { 0.0 };
        2.0 * self.tick_length() + labels + title
    }

    /// The finished figure.
    pub(crate) fn finish(self) -> Drawing {
        let height = self.y + 0.3 * self.theme.small_font;
        Drawing::new(self.canvas.svg.finish(height), self.theme.width, height, self.theme.dpi)
    }
}

/// The axis under a panel with as many ticks as fit, its names broken into lines where their words leave room for that.
pub(crate) fn column_axis(axis: &Axis, width: f64, theme: &Theme) -> Axis {
    let fitted = axis.clone().fitted(width, theme.tick_font);
    if !fitted.is_names() || fitted.fits(width, theme.tick_font) {
        return fitted;
    }
    let pitch = width / fitted.labels().count().max(1) as f64 - 0.4 * theme.tick_font;
    let has_room = |label: &str| label.split(' ').all(|word| text_width(word, theme.tick_font, false) <= pitch);
    let is_wrapped = fitted.labels().all(has_room);
    if is_wrapped { fitted.wrapped(theme.tick_font, pitch) } else { fitted }
}

/// Width of the widest label, points.
fn widest(axis: &Axis, theme: &Theme) -> f64 {
    axis.labels().map(|label| text_width(label, theme.tick_font, false)).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Division;
    use crate::key::KeySample;

    #[test]
    fn panels_share_edges_and_stay_on_the_page() {
        let theme = Theme::paper(85.0, 300.0).unwrap();
        let mut sheet = Sheet::new(&theme, Some("title")).unwrap();
        let side = |hi: f64| AxisSide::new(Axis::linear(0.0, hi, Division::Decimal), "quantity [unit]");
        let rows = vec![(side(1e5), 60.0), (side(0.001), 40.0)];
        let charts = sheet.grid(Grid { panels: Some(3), ..Grid::new(vec![side(1.0), side(2.0)], rows) }).unwrap();
        let rects: Vec<_> = charts.iter().map(|chart| chart.rect).collect();
        assert_eq!(rects.len(), 3);
        assert_eq!((rects[0].x, rects[0].y), (rects[2].x, rects[1].y));
        assert!((rects[0].h - 60.0).abs() < 0.2 && (rects[2].h - 40.0).abs() < 0.2 && rects[0].w == rects[2].w);
        assert!(rects.iter().all(|rect| rect.x > 0.0 && rect.right() < theme.width));
        let figure = sheet.finish();
        assert!(figure.size().1 > rects[2].bottom());
        assert_eq!(
            figure.svg().matches(">\nquantity [unit]").count() + figure.svg().matches(">\nquantity\n").count(),
            4
        );
    }

    #[test]
    fn heads_and_keys_that_are_too_long_go_on_below() {
        let theme = Theme::paper(85.0, 300.0).unwrap();
        let side = || AxisSide::new(Axis::linear(0.0, 1.0, Division::Decimal), "x");
        let head = |text: &str| Some(KeyEntry::new(KeySample::Nothing, text));
        let drawn = |text: &str| {
            let mut sheet = Sheet::new(&theme, None).unwrap();
            sheet.legend(&[KeyEntry::new(KeySample::Nothing, text.repeat(4))]).unwrap();
            let heads = vec![head(text), head("b"), head("c")];
            let grid = Grid { heads, ..Grid::new(vec![side(), side(), side()], vec![(side(), 40.0)]) };
            sheet.grid(grid).unwrap()[0].rect.y
        };
        assert!(drawn("heading noise of the compass = 0.01 ") > drawn("a") + 3.0 * theme.small_font);
    }
}
