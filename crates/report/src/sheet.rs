//! Layout of a page: title, legend, panels and notes from top to bottom, margins as wide as their labels. Panels of one
//! column share the horizontal axis, panels of one row the vertical one. The page is split into drawing areas of
//! plotters, whose charts draw mesh, axes, ticks and labels; the figures draw the data.

use std::sync::Arc;

use plotters::chart::{ChartBuilder, LabelAreaPosition};
use plotters::drawing::IntoDrawingArea as _;
use plotters::style::text_anchor::HPos;

use crate::axis::{Axis, MAX_TICK_INTERVALS};
use crate::backend::{PlotResult, Svg, units};
use crate::canvas::{Canvas, Stroke, TextLine};
use crate::chart::Chart;
use crate::drawing::Drawing;
use crate::fonts::LINE_SPACING;
use crate::legend::{self, LegendEntry};
use crate::lines::{LEADING, balanced, wrap};
use crate::palette::{GRID, INK};
use crate::theme::Theme;

/// Maximum share of the page for the names of rows; longer ones are broken into lines.
pub(crate) const MAX_NAMES_SHARE: f64 = 0.42;

/// Opacity of the grid lines between the ticks of a logarithmic axis.
const LIGHT: f64 = 0.45;

/// Distance from the middle of a line of text to its base line, in font sizes.
const MIDDLE: f64 = 0.36;

/// Axis of a column or of a row of a grid of panels, with its title.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TitledAxis {
    pub axis: Axis,
    pub title: String,
}

impl TitledAxis {
    pub(crate) fn new(axis: Axis, title: impl Into<String>) -> Self {
        Self { axis, title: title.into() }
    }
}

/// Panels in rows and columns.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Grid {
    pub columns: Vec<TitledAxis>,
    /// Rows with their heights in points.
    pub rows: Vec<(TitledAxis, f64)>,
    /// Text above each panel, row by row; `None` for a panel without text, empty without texts.
    pub heads: Vec<Option<LegendEntry>>,
    /// Number of panels, if the last row may not be full; `None` for full rows.
    pub panels: Option<usize>,
    /// Common title of all vertical axes, for rows too low for separate titles; `None` without a common title.
    pub shared_title: Option<String>,
    /// Left margin, points, if it has to agree with another grid; `None` for the width of the labels and titles.
    pub left: Option<f64>,
}

impl Grid {
    /// Grid of `count` panels with the same axes, in rows of `across`, each `height` points high; the last row may not
    /// be full.
    pub(crate) fn alike(count: usize, across: usize, column: TitledAxis, row: TitledAxis, height: f64) -> Self {
        let rows = vec![(row, height); count.div_ceil(across)];
        Self { panels: Some(count), columns: vec![column; across], rows, ..Self::default() }
    }
}

/// Column of panels.
struct GridColumn {
    side: TitledAxis,
    /// Left edge of the panels, points.
    left: f64,
    /// Width of the panels, points.
    width: f64,
    /// `true` if its names are turned, because their words are too long to fit side by side.
    is_turned: bool,
    /// Room below the last panel for labels and title, points.
    below: f64,
}

/// Figure that is being drawn, from top to bottom.
pub(crate) struct Sheet {
    pub theme: Theme,
    pub canvas: Canvas,
    /// Filled height of the sheet, points.
    pub y: f64,
    /// Left edge of the strip that is being filled, points.
    edge: f64,
}

impl Sheet {
    pub(crate) fn new(theme: &Theme, finding: &str) -> PlotResult<Self> {
        let svg = Svg::new(theme.width, Arc::clone(&theme.changes));
        let canvas = Canvas { area: svg.clone().into_drawing_area(), svg };
        let mut sheet = Self { theme: theme.clone(), canvas, y: 0.5 * theme.small_font, edge: 0.0 };
        if !finding.is_empty() {
            let text = TextLine { is_bold: true, ..TextLine::new("", theme.title_font, HPos::Center) };
            let lines = balanced(finding, theme.title_font, true, theme.width - 2.0 * theme.small_font);
            sheet.lines(lines, theme.width / 2.0, text, 1.2)?;
            sheet.y += 0.7 * theme.title_font;
        }
        Ok(sheet)
    }

    /// Writes lines of a text at `x`, with a spacing of `leading` font sizes.
    fn lines(&mut self, lines: Vec<String>, x: f64, text: TextLine, leading: f64) -> PlotResult {
        for line in lines {
            self.y += leading * text.size;
            self.canvas.text((x, self.y - MIDDLE * text.size), &TextLine { text: line, ..text.clone() })?;
        }
        Ok(())
    }

    /// Draws the legend, centred above the content that follows.
    pub(crate) fn legend(&mut self, entries: &[LegendEntry]) -> PlotResult {
        let theme = self.theme.clone();
        let room = theme.width - 2.0 * theme.small_font;
        let fewest = legend::rows(entries, room, &theme).len();
        // Rows of equal length look better than full rows and a short last one.
        let narrower = (8..=20).map(|share| legend::rows(entries, 0.05 * f64::from(share) * room, &theme));
        let rows = narrower.into_iter().find(|rows| rows.len() == fewest).unwrap_or_default();
        let widest = rows.iter().map(|row| legend::row_width(row, &theme)).fold(0.0, f64::max);
        for row in &rows {
            // With one entry in every row, all begin at the same left edge.
            let width = if rows.len() == entries.len() { widest } else { legend::row_width(row, &theme) };
            let mut x = ((theme.width - width) / 2.0).max(theme.small_font);
            self.y += LEADING * theme.small_font;
            let mut most = 1;
            for entry in *row {
                let place = (x, self.y - MIDDLE * theme.small_font);
                most = most.max(entry.draw(&self.canvas, place, room + theme.small_font - x, &theme)?);
                x += entry.width(&theme) + legend::entry_gap(&theme);
            }
            self.y += LINE_SPACING * theme.small_font * (most - 1) as f64;
        }
        self.y += if entries.is_empty() { 0.0 } else { 0.7 * theme.small_font };
        Ok(())
    }

    /// Writes remarks under the content so far, wrapped to the width of the page.
    pub(crate) fn note(&mut self, remarks: &[impl AsRef<str>]) -> PlotResult {
        let (margin, width) = (self.theme.small_font, self.theme.width);
        let text = remarks.iter().map(AsRef::as_ref).collect::<Vec<_>>().join(" ");
        let lines = wrap(&text, margin, false, width - 2.0 * margin);
        self.y += if lines.is_empty() { 0.0 } else { 0.2 * margin };
        self.lines(lines, margin, TextLine::new("", margin, HPos::Left), LEADING)
    }

    /// Margin that the labels and titles of the rows need, points.
    pub(crate) fn left_margin(&self, grid: &Grid) -> f64 {
        let theme = &self.theme;
        let labels = grid.rows.iter().map(|(side, height)| self.row(side, *height).axis.widest(theme.tick_font));
        let titles = grid.rows.iter().map(|(side, height)| self.row(side, *height).title.lines().count());
        let lines = titles.max().unwrap_or(0).max(usize::from(grid.shared_title.is_some())) as f64;
        let titles = if lines == 0.0 { 0.0 } else { (lines * LINE_SPACING + 0.5) * theme.label_font };
        0.5 * theme.small_font + titles + labels.fold(0.0, f64::max) + 2.0 * self.tick_length()
    }

    /// Row with its ticks, and with labels and title wrapped.
    fn row(&self, side: &TitledAxis, height: f64) -> TitledAxis {
        let theme = &self.theme;
        let count = ((height / (1.7 * theme.tick_font)) as usize).clamp(2, MAX_TICK_INTERVALS);
        let axis = theme
            .changes
            .limited(side.axis.clone(), &side.title)
            .ticked(count)
            .wrapped(theme.tick_font, MAX_NAMES_SHARE * theme.width);
        TitledAxis::new(axis, balanced(&side.title, theme.label_font, false, height).join("\n"))
    }

    /// Column with its ticks, and with labels and title wrapped.
    fn column(&self, side: &TitledAxis, left: f64, width: f64) -> GridColumn {
        let theme = &self.theme;
        let axis = theme.changes.limited(side.axis.clone(), &side.title).with_fitting_ticks(width, theme.tick_font);
        let title = wrap(&side.title, theme.label_font, false, width + theme.label_font);
        let is_turned = axis.is_names() && !axis.fits(width, theme.tick_font);
        let lines = axis.labels().map(|label| label.lines().count()).max().unwrap_or(0);
        let labels =
            if is_turned { axis.widest(theme.tick_font) } else { LINE_SPACING * theme.tick_font * lines as f64 };
        let titles = if title.is_empty() { 0.0 } else { (0.45 + LINE_SPACING * title.len() as f64) * theme.label_font };
        let below = 2.0 * self.tick_length() + labels + titles;
        GridColumn { side: TitledAxis::new(axis, title.join("\n")), left, width, is_turned, below }
    }

    fn tick_length(&self) -> f64 {
        0.32 * self.theme.tick_font
    }

    /// Distance between panels side by side, points.
    pub(crate) fn panel_gap(theme: &Theme) -> f64 {
        2.6 * theme.tick_font
    }

    /// Margin right of the panels, points.
    pub(crate) fn right_margin(theme: &Theme) -> f64 {
        1.6 * theme.tick_font
    }

    /// Draws a grid into a strip of the page, given by its left edge and its width, points. The left margin of the grid
    /// is a minimum.
    pub(crate) fn grid_within(&mut self, grid: Grid, left: f64, width: f64) -> PlotResult<Vec<Chart>> {
        let page = self.theme.width;
        let margin = self.left_margin(&grid).max(grid.left.unwrap_or(0.0));
        // The strip is laid out like a page that ends at its right edge.
        (self.theme.width, self.edge) = (left + width, left);
        let charts = self.grid(Grid { left: Some(left + margin), ..grid });
        (self.theme.width, self.edge) = (page, 0.0);
        charts
    }

    /// Draws mesh, axes and labels of the panels and returns their charts, row by row.
    pub(crate) fn grid(&mut self, grid: Grid) -> PlotResult<Vec<Chart>> {
        let theme = self.theme.clone();
        let (count, gap) = (grid.columns.len().max(1), Self::panel_gap(&theme));
        let left = grid.left.unwrap_or_else(|| self.left_margin(&grid));
        let inner = theme.width - left - Self::right_margin(&theme) - gap * (count - 1) as f64;
        let width = (inner / count as f64).max(theme.tick_font);
        let placed = |number: usize| left + number as f64 * (width + gap);
        let columns: Vec<GridColumn> =
            grid.columns.iter().enumerate().map(|(number, side)| self.column(side, placed(number), width)).collect();
        let total = grid.panels.unwrap_or(usize::MAX).min(grid.rows.len() * grid.columns.len());
        let (mut charts, mut lowest) = (Vec::with_capacity(total), self.y);
        for (row, (side, height)) in grid.rows.iter().enumerate() {
            let room = width + gap - theme.small_font;
            let heads: Vec<Option<&LegendEntry>> =
                (0..count).map(|column| grid.heads.get(row * count + column)?.as_ref()).collect();
            let lines = heads.iter().flatten().map(|head| head.lines(room, &theme).len()).max().unwrap_or(0) as f64;
            let further = LINE_SPACING * (lines - 1.0);
            self.y += if lines > 0.0 { (0.15 + LEADING + further) * theme.small_font } else { 0.0 };
            let up = self.row(side, *height);
            let title = if side.title.is_empty() { grid.shared_title.as_deref().unwrap_or("") } else { &side.title };
            for (number, column) in columns.iter().enumerate().take(total - (row * count).min(total)) {
                if let Some(head) = heads[number] {
                    let above = 0.45 + further + MIDDLE;
                    head.draw(&self.canvas, (column.left, self.y - above * theme.small_font), room, &theme)?;
                }
                let is_last = row * count + number + count >= total;
                let chart = self.chart(column, &up, *height, [number == 0, is_last])?;
                let axes =
                    [(column.side.axis.scale_text(), &*grid.columns[number].title), (up.axis.scale_text(), title)];
                self.canvas.svg.panel(chart.bounds(), axes);
                lowest = lowest.max(if is_last { self.y + height + column.below } else { 0.0 });
                charts.push(chart);
            }
            self.y += height + 0.75 * theme.tick_font;
        }
        if let (Some(title), Some(first), Some(last)) = (&grid.shared_title, charts.first(), charts.last()) {
            let text = TextLine::new(title.as_str(), theme.label_font, HPos::Center);
            let x = self.edge + 0.5 * (theme.small_font + theme.label_font);
            let middle = (first.rect.y + last.rect.bottom()) / 2.0;
            self.canvas.text((x, middle), &TextLine { is_turned: true, ..text })?;
        }
        self.y = lowest + 0.55 * theme.label_font;
        Ok(charts)
    }

    /// Chart of plotters with its mesh, axes and ticks, and with labels and titles if requested: at the left, and
    /// below.
    fn chart(&self, x: &GridColumn, y: &TitledAxis, height: f64, labelled: [bool; 2]) -> PlotResult<Chart> {
        let theme = &self.theme;
        let tick = self.tick_length();
        let beside = if labelled[0] { x.left - self.edge - 0.5 * theme.small_font } else { tick };
        let below = if labelled[1] { x.below } else { tick };
        let (_, page) = self.canvas.area.split_vertically(units(self.y));
        let (strip, _) = page.split_vertically(units(height + below));
        let (_, strip) = strip.split_horizontally(units(x.left - beside));
        let (area, _) = strip.split_horizontally(units(beside + x.width));
        let mut context = ChartBuilder::on(&area)
            .y_label_area_size(units(beside))
            .x_label_area_size(units(below))
            .build_cartesian_2d(x.side.axis.clone(), y.axis.clone())?;
        let text = |size: f64| TextLine::new("", size, HPos::Left).style();
        let grid = Stroke::solid(GRID, 0.8 * theme.thin);
        let is_named = labelled[1] && !x.is_turned;
        let across = |value: &f64| if is_named { x.side.axis.label(*value) } else { String::new() };
        let up = |value: &f64| if labelled[0] { y.axis.label(*value) } else { String::new() };
        let mut mesh = context.configure_mesh();
        mesh.bold_line_style(grid.style())
            .light_line_style(Stroke { opacity: LIGHT, ..grid }.style())
            .axis_style(Stroke::solid(INK, theme.thin).style())
            .label_style(text(theme.tick_font))
            .axis_desc_style(text(theme.label_font))
            .set_tick_mark_size(LabelAreaPosition::Left, units(tick))
            .set_tick_mark_size(LabelAreaPosition::Bottom, units(tick))
            .x_label_formatter(&across)
            .y_label_formatter(&up)
            .x_desc(if labelled[1] { &x.side.title } else { "" })
            .y_desc(if labelled[0] { &y.title } else { "" });
        if x.side.axis.is_names() && y.axis.is_names() {
            // The cells of a map have their own lines.
            mesh.disable_mesh();
        }
        mesh.draw()?;
        let chart = Chart::new(&context, self.canvas.clone(), [x.side.axis.clone(), y.axis.clone()]);
        for (value, label) in x.side.axis.ticks.iter().filter(|_| labelled[1] && x.is_turned) {
            let text = TextLine { is_turned: true, ..TextLine::new(label.as_str(), theme.tick_font, HPos::Right) };
            self.canvas.text((chart.page_x(*value).unwrap_or(f64::NAN), chart.rect.bottom() + 2.0 * tick), &text)?;
        }
        Ok(chart)
    }

    /// The finished figure.
    pub(crate) fn finish(self) -> Drawing {
        let height = self.y + 0.5 * self.theme.small_font;
        Drawing::new(self.canvas.svg.finish(height), self.theme.width, height, self.theme.dpi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::TickRule;
    use crate::legend::LegendSymbol;

    #[test]
    fn panels_share_edges_and_stay_on_the_page() {
        let theme = Theme::paper(85.0, 300.0).unwrap();
        let mut sheet = Sheet::new(&theme, "title").unwrap();
        let side = |hi: f64| TitledAxis::new(Axis::linear(0.0, hi, TickRule::Decimal), "quantity [unit]");
        let rows = vec![(side(1e5), 60.0), (side(0.001), 40.0)];
        let charts =
            sheet.grid(Grid { panels: Some(3), columns: vec![side(1.0), side(2.0)], rows, ..Grid::default() }).unwrap();
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
        let side = TitledAxis::new(Axis::linear(0.0, 1.0, TickRule::Decimal), "x");
        let head = |text: &str| Some(LegendEntry::new(LegendSymbol::Nothing, text));
        let drawn = |text: &str| {
            let mut sheet = Sheet::new(&theme, "").unwrap();
            sheet.legend(&[LegendEntry::new(LegendSymbol::Nothing, text.repeat(4))]).unwrap();
            let heads = vec![head(text), head("b"), head("c")];
            let grid =
                Grid { heads, columns: vec![side.clone(); 3], rows: vec![(side.clone(), 40.0)], ..Grid::default() };
            sheet.grid(grid).unwrap()[0].rect.y
        };
        assert!(drawn("heading noise of the compass = 0.01 ") > drawn("a") + 3.0 * theme.small_font);
    }
}
