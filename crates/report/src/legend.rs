//! The key of a figure: samples with their names in aligned columns, always outside the data.

use crate::clip::Place;
use crate::paint::Paint;
use crate::palette::{Look, Origin};
use crate::scene::{Ink, Layer, Scene, Stroke, Text};
use crate::theme::Theme;

/// What stands before a name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Sample {
    Nothing,
    Line(Stroke),
    Dots(Paint),
    Marker(Look),
    LineAndMarker(Stroke, Look),
    /// A short line from bottom to top.
    Upright(Stroke),
    /// A ship seen from above.
    Hull(Paint),
}

/// A sample and its name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    pub sample: Sample,
    pub label: String,
}

impl Entry {
    pub(crate) fn new(sample: Sample, label: impl Into<String>) -> Self {
        Self { sample, label: label.into() }
    }

    /// The line of an origin under its own name.
    pub(crate) fn line_of(origin: &Origin, theme: &Theme) -> Self {
        Self::new(Sample::Line(stroke_of(origin, theme)), origin.label())
    }

    /// What is drawn in the figure like the sample.
    pub(crate) fn ink(&self) -> Option<Ink> {
        match self.sample {
            Sample::Line(stroke) => Some(Ink { colour: stroke.colour, dash: Some(stroke.dash) }),
            Sample::LineAndMarker(stroke, look) => Some(Ink { colour: look.colour, dash: Some(stroke.dash) }),
            Sample::Dots(colour) => Some(Ink::of(colour)),
            Sample::Marker(look) => Some(Ink::of(look.colour)),
            Sample::Nothing | Sample::Upright(_) | Sample::Hull(_) => None,
        }
    }

    fn sample_width(&self, theme: &Theme) -> f64 {
        match self.sample {
            Sample::Nothing => 0.0,
            Sample::Dots(_) | Sample::Marker(_) | Sample::Upright(_) => 1.6 * theme.small_font,
            Sample::Line(_) | Sample::LineAndMarker(..) | Sample::Hull(_) => 2.9 * theme.small_font,
        }
    }

    /// Width of sample and name, points.
    pub(crate) fn width(&self, theme: &Theme) -> f64 {
        self.sample_width(theme) + Text::new(self.label.as_str(), theme.small_font).width()
    }

    /// Draws the entry with its base line at `place`.
    pub(crate) fn draw(&self, scene: &mut Scene, (x, y): Place, theme: &Theme) {
        let text = Text::new(self.label.as_str(), theme.small_font);
        let middle = y - text.centring();
        let width = self.sample_width(theme);
        let end = x + width - 0.5 * theme.small_font;
        let centre = ((x + end) / 2.0, middle);
        match self.sample {
            Sample::Nothing => {}
            Sample::Line(stroke) => scene.line(Layer::Note, [(x, middle), (end, middle)], stroke),
            Sample::Dots(colour) => scene.disc(Layer::Note, centre, theme.dot * 1.2, colour, 1.0),
            Sample::Marker(look) => scene.marker(Layer::Note, centre, theme.marker, &look),
            Sample::LineAndMarker(stroke, look) => {
                scene.line(Layer::Note, [(x, middle), (end, middle)], stroke);
                scene.marker(Layer::Note, centre, theme.marker, &look);
            }
            Sample::Upright(stroke) => {
                let half = 0.5 * theme.small_font;
                scene.line(Layer::Note, [(centre.0, middle - half), (centre.0, middle + half)], stroke);
            }
            Sample::Hull(colour) => scene.hull(Layer::Note, centre, (1.0, 0.0), 1.6 * theme.small_font, colour),
        }
        scene.text(Layer::Note, (x + width, y), text);
    }
}

/// The line an origin is drawn with.
pub(crate) fn stroke_of(origin: &Origin, theme: &Theme) -> Stroke {
    let look = origin.look();
    Stroke::solid(look.colour, theme.line).dashed(look.dash)
}

/// Where each entry goes in `width` points: column offsets, and the number of columns is their count.
pub(crate) fn columns(entries: &[Entry], width: f64, theme: &Theme) -> Vec<f64> {
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
        let entries: Vec<Entry> = (0..7).map(|i| Entry::new(Sample::Nothing, "m".repeat(4 + i))).collect();
        assert_eq!(columns(&entries, 1e4, &theme).len(), 7);
        assert_eq!(columns(&entries, 10.0, &theme), [0.0]);
        let starts = columns(&entries, 300.0, &theme);
        assert!(starts.len() > 1 && starts.len() < 7 && starts.windows(2).all(|w| w[1] > w[0]));
        assert_eq!(columns(&[], 10.0, &theme), [0.0]);
    }
}
