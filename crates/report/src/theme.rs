//! Sizes of a figure, all in points (1/72 inch) on the finished page, so that one theme determines the legibility of a
//! figure. Colours are in [`crate::palette`]; the module `sheet` determines the layout.

use std::sync::Arc;

use crate::changes::StyleChanges;
use crate::error::ReportError;

const POINTS_PER_MM: f64 = 72.0 / 25.4;
/// Width of a journal column, mm: the narrowest usual printed width of a figure.
const COLUMN_MM: f64 = 85.0;
/// Width of a full page of text, mm.
const PAGE_MM: f64 = 180.0;
/// Minimum and maximum width of a printed figure, mm.
pub const WIDTH_RANGE_MM: [f64; 2] = [60.0, 400.0];
/// Minimum and maximum resolution of a printed figure, dots per inch.
pub const DPI_RANGE: [f64; 2] = [72.0, 1200.0];

/// Sizes of a figure, in points on the finished page.
#[derive(Debug, Clone, PartialEq)]
pub struct Theme {
    /// Width of the figure.
    pub(crate) width: f64,
    /// Resolution, dots per inch.
    pub(crate) dpi: f64,
    /// Font size of the numbers at the ticks.
    pub(crate) tick_font: f64,
    /// Font size of axis titles.
    pub(crate) label_font: f64,
    /// Font size of legends, annotations and notes.
    pub(crate) small_font: f64,
    /// Font size of the title above the figure.
    pub(crate) title_font: f64,
    /// Width of curves.
    pub(crate) line: f64,
    /// Width of frames, ticks and dimension lines.
    pub(crate) thin: f64,
    /// Radius of a marker.
    pub(crate) marker: f64,
    /// Radius of a measured point.
    pub(crate) dot: f64,
    /// Changes of a style in addition to sizes.
    pub(crate) changes: Arc<StyleChanges>,
}

impl Theme {
    /// Theme for a screen or a report page: 675 points (900 CSS pixels) wide, 192 dpi, so 1800 pixels across.
    pub fn screen() -> Self {
        Self {
            width: 675.0,
            dpi: 192.0,
            tick_font: 10.5,
            label_font: 12.0,
            small_font: 10.5,
            title_font: 13.0,
            line: 1.35,
            thin: 0.75,
            marker: 3.0,
            dot: 1.4,
            changes: Arc::default(),
        }
    }

    /// Theme for print at `width_mm` and `dpi`: type of 6.6 to 9.5 points, slightly larger in a wider figure.
    ///
    /// Fails outside 60–400 mm and 72–1200 dpi.
    pub fn paper(width_mm: f64, dpi: f64) -> Result<Self, ReportError> {
        let inside = |v: f64, [lo, hi]: [f64; 2]| v >= lo && v <= hi;
        if !inside(width_mm, WIDTH_RANGE_MM) {
            return Err(ReportError::Width { width_mm, min_mm: WIDTH_RANGE_MM[0], max_mm: WIDTH_RANGE_MM[1] });
        }
        if !inside(dpi, DPI_RANGE) {
            return Err(ReportError::Resolution { dpi, min: DPI_RANGE[0], max: DPI_RANGE[1] });
        }
        Ok(Self::printed(width_mm, dpi))
    }

    fn printed(width_mm: f64, dpi: f64) -> Self {
        let share = ((width_mm - COLUMN_MM) / (PAGE_MM - COLUMN_MM)).clamp(0.0, 1.0);
        Self {
            width: width_mm * POINTS_PER_MM,
            dpi,
            tick_font: 6.6 + share * 0.9,
            label_font: 7.4 + share * 1.1,
            small_font: 6.6 + share * 0.9,
            title_font: 8.0 + share * 1.5,
            line: 0.9 + share * 0.2,
            thin: 0.5 + share * 0.1,
            marker: 1.9 + share * 0.4,
            dot: 0.9 + share * 0.2,
            changes: Arc::default(),
        }
    }

    /// Axis titles that have limits in the style of this theme and are not among `titles`.
    pub fn limits_without_axis(&self, titles: &[String]) -> Vec<&str> {
        let wanted = self.changes.limits.keys().map(String::as_str);
        wanted.filter(|wanted| !titles.iter().any(|title| title == wanted)).collect()
    }

    /// Height of a panel, points: `share` of the width, more in a narrow figure, whose type is large relative to its
    /// width.
    pub(crate) fn panel_height(&self, share: f64) -> f64 {
        share * self.width * if self.is_narrow() { 1.45 } else { 1.0 }
    }

    /// `true` if the figure is so narrow that side-by-side arrangements have to be stacked.
    pub(crate) fn is_narrow(&self) -> bool {
        self.width / self.tick_font < 45.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn type_can_be_read_in_a_journal_column() {
        let theme = Theme::paper(85.0, 600.0).unwrap();
        assert!(theme.tick_font >= 6.5 && theme.small_font >= 6.5);
        assert!((theme.width - 240.94).abs() < 0.01);
        assert!(theme.is_narrow() && !Theme::screen().is_narrow());
    }

    #[test]
    fn refuses_what_no_page_carries() {
        assert!(matches!(Theme::paper(10.0, 300.0), Err(ReportError::Width { .. })));
        assert!(matches!(Theme::paper(f64::NAN, 300.0), Err(ReportError::Width { .. })));
        assert!(matches!(Theme::paper(85.0, 1e6), Err(ReportError::Resolution { .. })));
    }
}
