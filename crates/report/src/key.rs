//! The key of a figure: samples with their names in aligned columns, always outside the data.

use plotters::style::RGBColor;

use crate::backend::Drawn;
use crate::canvas::{Anchor, Canvas, PagePoint, Rect, Stroke, TextLine, at, hull, marker};
use crate::lines::{LEADING, wrap};
use crate::palette::{CurveOrigin, Dash, INK, Look};
use crate::theme::Theme;

/// What stands before a name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum KeySample {
    Nothing,
    Line(Stroke),
    /// An area, as a piece of it.
    Area(Stroke),
    Dots(RGBColor),
    Marker(Look),
    LineAndMarker(Stroke, Look),
    /// A short line from bottom to top.
    Upright(Stroke),
    /// An outlined cell.
    Outline(Dash),
    /// A ship seen from above.
    Hull(RGBColor),
}

/// How cells are outlined.
pub(crate) fn outline_stroke(dash: Dash, theme: &Theme) -> Stroke {
    Stroke::solid(INK, 1.4 * theme.line).dashed(dash)
}

/// A sample and its name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct KeyEntry {
    pub sample: KeySample,
    pub label: String,
}

impl KeyEntry {
    pub(crate) fn new(sample: KeySample, label: impl Into<String>) -> Self {
        Self { sample, label: label.into() }
    }

    /// The line of an origin under its own name.
    pub(crate) fn line_of(origin: &CurveOrigin, theme: &Theme) -> Self {
        Self::new(KeySample::Line(stroke_of(origin, theme)), origin.label())
    }

    fn sample_width(&self, theme: &Theme) -> f64 {
        match self.sample {
            KeySample::Nothing => 0.0,
            KeySample::Dots(_) | KeySample::Marker(_) | KeySample::Upright(_) | KeySample::Outline(_) => {
                1.6 * theme.small_font
            }
            KeySample::Line(_) | KeySample::Area(_) | KeySample::LineAndMarker(..) | KeySample::Hull(_) => {
                2.9 * theme.small_font
            }
        }
    }

    /// Width of sample and name, points.
    pub(crate) fn width(&self, theme: &Theme) -> f64 {
        self.sample_width(theme) + TextLine::new(self.label.as_str(), theme.small_font).width()
    }

    /// The lines of its name in a place this wide, sample and all.
    pub(crate) fn lines(&self, room: f64, theme: &Theme) -> Vec<String> {
        wrap(&self.label, theme.small_font, false, room - self.sample_width(theme))
    }

    /// Draws the entry in a place this wide, with the middle of its first line at `place`; returns how many lines its
    /// name takes.
    pub(crate) fn draw(&self, canvas: &Canvas, (x, y): PagePoint, room: f64, theme: &Theme) -> Drawn<usize> {
        let width = self.sample_width(theme);
        let end = x + width - 0.5 * theme.small_font;
        let centre = ((x + end) / 2.0, y);
        let half = 0.5 * theme.small_font;
        match self.sample {
            KeySample::Nothing => {}
            KeySample::Line(stroke) | KeySample::Area(stroke) => canvas.line(&[(x, y), (end, y)], stroke)?,
            KeySample::Dots(colour) => {
                let dot = Look { colour, ..CurveOrigin::Record.look() };
                canvas.elements(marker(at(centre), 1.2 * theme.dot, &dot))?;
            }
            KeySample::Marker(look) => canvas.elements(marker(at(centre), theme.marker, &look))?,
            KeySample::LineAndMarker(stroke, look) => {
                canvas.line(&[(x, y), (end, y)], stroke)?;
                canvas.elements(marker(at(centre), theme.marker, &look))?;
            }
            KeySample::Upright(stroke) => canvas.line(&[(centre.0, y - half), (centre.0, y + half)], stroke)?,
            KeySample::Outline(dash) => {
                let cell = Rect { x: centre.0 - half, y: y - half, w: 2.0 * half, h: 2.0 * half };
                canvas.outline(cell, outline_stroke(dash, theme))?;
            }
            KeySample::Hull(colour) => {
                canvas.elements(hull(at(centre), (1.0, 0.0), 1.6 * theme.small_font, colour))?;
            }
        }
        let lines = self.lines(room, theme);
        for (index, line) in lines.iter().enumerate() {
            let down = LEADING * theme.small_font * index as f64;
            let text = TextLine::new(line.as_str(), theme.small_font).anchor(Anchor::Start);
            canvas.text((x + width, y + down), &text)?;
        }
        Ok(lines.len())
    }
}

/// The line an origin is drawn with.
pub(crate) fn stroke_of(origin: &CurveOrigin, theme: &Theme) -> Stroke {
    let look = origin.look();
    Stroke::solid(look.colour, theme.line).dashed(look.dash)
}

/// Where each entry goes in `width` points: column offsets, and the number of columns is their count.
pub(crate) fn columns(entries: &[KeyEntry], width: f64, theme: &Theme) -> Vec<f64> {
    let gap = 1.6 * theme.small_font;
    let offsets = |count: usize| {
        let mut x = 0.0;
        let mut starts = Vec::with_capacity(count);
        for column in 0..count {
            starts.push(x);
            let widest = entries.iter().skip(column).step_by(count).map(|e| e.width(theme)).fold(0.0, f64::max);
            x += widest + gap;
        }
        (starts, x - gap)
    };
    let fitting = |count: usize| Some(offsets(count)).filter(|(_, used)| *used <= width).map(|(starts, _)| starts);
    let Some(most) = (1..=entries.len()).rev().find(|count| fitting(*count).is_some()) else { return vec![0.0] };
    // Rows of equal length look better than a full row and a rest.
    let even = entries.len().div_ceil(entries.len().div_ceil(most));
    fitting(even).or_else(|| fitting(most)).unwrap_or_else(|| vec![0.0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_fit_the_width() {
        let theme = Theme::screen();
        let entries: Vec<KeyEntry> = (0..7).map(|i| KeyEntry::new(KeySample::Nothing, "m".repeat(4 + i))).collect();
        assert_eq!(columns(&entries, 1e4, &theme).len(), 7);
        assert_eq!(columns(&entries, 10.0, &theme), [0.0]);
        let starts = columns(&entries, 300.0, &theme);
        assert!(starts.len() > 1 && starts.len() < 7 && starts.windows(2).all(|w| w[1] > w[0]));
        assert_eq!(columns(&[], 10.0, &theme), [0.0]);
    }
}
