//! Legend of a figure: symbols with their names, always outside the data.

use plotters::style::RGBColor;
use plotters::style::text_anchor::HPos;

use crate::backend::PlotResult;
use crate::canvas::{Canvas, PagePoint, Rect, Stroke, TextLine, marker, page_units, ship_outline};
use crate::fonts::{LINE_SPACING, text_width};
use crate::lines::wrap;
use crate::palette::{CurveOrigin, CurveStyle, Dash, INK};
use crate::theme::Theme;

/// Symbol of a legend entry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum LegendSymbol {
    Nothing,
    /// Line; a wide line for an area.
    Line(Stroke),
    Dots(RGBColor),
    Marker(CurveStyle),
    LineAndMarker(Stroke, CurveStyle),
    /// Short line from bottom to top.
    Upright(Stroke),
    /// Outlined cell.
    Outline(Dash),
    /// Ship seen from above.
    Hull(RGBColor),
}

/// Stroke of the outline of a cell.
pub(crate) fn outline_stroke(dash: Dash, theme: &Theme) -> Stroke {
    Stroke { dash, ..Stroke::solid(INK, 1.4 * theme.line) }
}

/// Entry of a legend: symbol and name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LegendEntry {
    pub sample: LegendSymbol,
    pub label: String,
}

impl LegendEntry {
    pub(crate) fn new(sample: LegendSymbol, label: impl Into<String>) -> Self {
        Self { sample, label: label.into() }
    }

    fn sample_width(&self, theme: &Theme) -> f64 {
        theme.small_font
            * match self.sample {
                LegendSymbol::Nothing => 0.0,
                LegendSymbol::Dots(_)
                | LegendSymbol::Marker(_)
                | LegendSymbol::Upright(_)
                | LegendSymbol::Outline(_) => 1.6,
                LegendSymbol::Line(_) | LegendSymbol::LineAndMarker(..) | LegendSymbol::Hull(_) => 2.9,
            }
    }

    /// Width of symbol and name, points.
    pub(crate) fn width(&self, theme: &Theme) -> f64 {
        self.sample_width(theme) + text_width(&self.label, theme.small_font, false)
    }

    /// Lines of the name, if symbol and name together have `room` points of width.
    pub(crate) fn lines(&self, room: f64, theme: &Theme) -> Vec<String> {
        wrap(&self.label, theme.small_font, false, room - self.sample_width(theme))
    }

    /// Draws the entry in a given width, with the middle of its first line at `place`; returns the number of lines of
    /// its name.
    pub(crate) fn draw(&self, canvas: &Canvas, (x, y): PagePoint, room: f64, theme: &Theme) -> PlotResult<usize> {
        let width = self.sample_width(theme);
        let end = x + width - 0.5 * theme.small_font;
        let centre = ((x + end) / 2.0, y);
        let half = 0.5 * theme.small_font;
        if let LegendSymbol::Line(stroke) | LegendSymbol::LineAndMarker(stroke, _) = self.sample {
            canvas.line(&[(x, y), (end, y)], stroke)?;
        }
        match self.sample {
            LegendSymbol::Nothing | LegendSymbol::Line(_) => {}
            LegendSymbol::Dots(colour) => {
                let dot = CurveStyle { colour, ..CurveOrigin::Record.style() };
                canvas.draw_elements(marker(page_units(centre), 1.2 * theme.dot, &dot))?;
            }
            LegendSymbol::Marker(style) | LegendSymbol::LineAndMarker(_, style) => {
                canvas.draw_elements(marker(page_units(centre), theme.marker, &style))?;
            }
            LegendSymbol::Upright(stroke) => canvas.line(&[(centre.0, y - half), (centre.0, y + half)], stroke)?,
            LegendSymbol::Outline(dash) => {
                let cell = Rect { x: centre.0 - half, y: y - half, w: 2.0 * half, h: 2.0 * half };
                canvas.outline(cell, outline_stroke(dash, theme))?;
            }
            LegendSymbol::Hull(colour) => {
                canvas.draw_elements(ship_outline(page_units(centre), (1.0, 0.0), 1.6 * theme.small_font, colour))?;
            }
        }
        let lines = self.lines(room, theme);
        let name = TextLine::new(lines.join("\n"), theme.small_font, HPos::Left);
        // The place of a text of several lines is its middle.
        let down = 0.5 * LINE_SPACING * theme.small_font * (lines.len().max(1) - 1) as f64;
        canvas.text((x + width, y + down), &name)?;
        Ok(lines.len())
    }
}

/// Entries in rows at most `width` points wide, as many in each as fit; a wider entry has a separate row.
pub(crate) fn rows<'a>(entries: &'a [LegendEntry], width: f64, theme: &Theme) -> Vec<&'a [LegendEntry]> {
    let mut rows: Vec<&[LegendEntry]> = Vec::new();
    let mut start = 0;
    for end in 1..=entries.len() {
        if end - start > 1 && row_width(&entries[start..end], theme) > width {
            rows.push(&entries[start..end - 1]);
            start = end - 1;
        }
    }
    rows.extend((start < entries.len()).then(|| &entries[start..]));
    rows
}

/// Width of a row of entries with the gaps between them, points.
pub(crate) fn row_width(row: &[LegendEntry], theme: &Theme) -> f64 {
    row.iter().map(|entry| entry.width(theme) + entry_gap(theme)).sum::<f64>() - entry_gap(theme)
}

/// Free space between entries, points.
pub(crate) fn entry_gap(theme: &Theme) -> f64 {
    1.6 * theme.small_font
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_fit_the_width() {
        let theme = Theme::screen();
        let entries: Vec<LegendEntry> =
            (0..7).map(|i| LegendEntry::new(LegendSymbol::Nothing, "m".repeat(4 + i))).collect();
        assert_eq!(rows(&entries, 1e4, &theme).len(), 1);
        assert_eq!(rows(&entries, 10.0, &theme).len(), 7);
        let fitted = rows(&entries, 300.0, &theme);
        assert!(fitted.len() > 1 && fitted.len() < 7 && fitted.concat() == entries);
        assert!(fitted.iter().all(|row| row_width(row, &theme) <= 300.0));
        assert!(rows(&[], 10.0, &theme).is_empty());
    }
}
