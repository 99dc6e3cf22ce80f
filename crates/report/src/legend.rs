//! The key of a figure: samples with their names in aligned columns, always outside the data.

use crate::clip::PagePoint;
use crate::lines::{self, LEADING};
use crate::paint::Paint;
use crate::palette::{CurveOrigin, Dash, INK, Look};
use crate::scene::{Canvas, Ink, Layer, Stroke, TextLine};
use crate::theme::Theme;

/// What stands before a name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum KeySample {
    Nothing,
    Line(Stroke),
    /// An area, as a piece of it.
    Area(Stroke),
    Dots(Paint),
    Marker(Look),
    LineAndMarker(Stroke, Look),
    /// A short line from bottom to top.
    Upright(Stroke),
    /// An outlined cell.
    Outline(Dash),
    /// A ship seen from above.
    Hull(Paint),
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

    /// What is drawn in the figure like the sample.
    pub(crate) fn ink(&self) -> Option<Ink> {
        match self.sample {
            KeySample::Line(stroke) => Some(Ink { colour: stroke.colour, dash: Some(stroke.dash) }),
            KeySample::LineAndMarker(stroke, look) => Some(Ink { colour: look.colour, dash: Some(stroke.dash) }),
            KeySample::Area(stroke) => Some(Ink::of(stroke.colour)),
            KeySample::Dots(colour) => Some(Ink::of(colour)),
            KeySample::Marker(look) => Some(Ink::of(look.colour)),
            KeySample::Nothing | KeySample::Upright(_) | KeySample::Outline(_) | KeySample::Hull(_) => None,
        }
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
        lines::wrap(&self.label, theme.small_font, false, room - self.sample_width(theme))
    }

    /// Draws the entry in a place this wide, with the base line of its first line at `place`; returns how many lines
    /// its name takes.
    pub(crate) fn draw(&self, scene: &mut Canvas, (x, y): PagePoint, room: f64, theme: &Theme) -> usize {
        let text = TextLine::new(self.label.as_str(), theme.small_font);
        let middle = y - text.centring();
        let width = self.sample_width(theme);
        let end = x + width - 0.5 * theme.small_font;
        let centre = ((x + end) / 2.0, middle);
        match self.sample {
            KeySample::Nothing => {}
            KeySample::Line(stroke) | KeySample::Area(stroke) => {
                scene.line(Layer::Note, [(x, middle), (end, middle)], stroke);
            }
            KeySample::Dots(colour) => scene.disc(Layer::Note, centre, theme.dot * 1.2, colour, 1.0),
            KeySample::Marker(look) => scene.marker(Layer::Note, centre, theme.marker, &look),
            KeySample::LineAndMarker(stroke, look) => {
                scene.line(Layer::Note, [(x, middle), (end, middle)], stroke);
                scene.marker(Layer::Note, centre, theme.marker, &look);
            }
            KeySample::Upright(stroke) => {
                let half = 0.5 * theme.small_font;
                scene.line(Layer::Note, [(centre.0, middle - half), (centre.0, middle + half)], stroke);
            }
            KeySample::Outline(dash) => {
                let half = 0.45 * theme.small_font;
                let [left, right] = [centre.0 - half, centre.0 + half];
                let [top, bottom] = [middle - half, middle + half];
                let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
                scene.line(Layer::Note, corners, outline_stroke(dash, theme));
            }
            KeySample::Hull(colour) => scene.hull(Layer::Note, centre, (1.0, 0.0), 1.6 * theme.small_font, colour),
        }
        let lines = self.lines(room, theme);
        let count = lines.len();
        for (index, line) in lines.into_iter().enumerate() {
            let down = LEADING * theme.small_font * index as f64;
            scene.text(Layer::Note, (x + width, y + down), TextLine::new(line, theme.small_font));
        }
        count
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
