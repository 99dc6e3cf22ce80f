//! Parts shared by kinds of figure: records, remarks on error bars, reference lines, marks side by side.

use serde::{Deserialize, Serialize};

use plotters::style::Color as _;

use crate::backend::PlotResult;
use crate::canvas::Stroke;
use crate::chart::Chart;
use crate::curve::PlotCurve;
use crate::legend::LegendSymbol;
use crate::palette::{INK, RECORD};
use crate::theme::Theme;

/// Free space above and below the data, as a share of their range.
pub(super) const PAD_SHARE: f64 = 0.08;

/// Free space left and right of lines, as a share of the range of the data.
pub(super) const ACROSS_PAD: f64 = 0.02;

/// Maximum number of points of a panel that are drawn as dots; more are drawn as a line.
const DENSE: usize = 400;

/// Maximum number of dots of full size; more are smaller, so that they stay separate.
const MANY: usize = 150;

/// Default remark on marks beyond an axis.
pub(super) const BEYOND_AXIS_REMARK: &str = "Arrows: beyond the axis.";

/// Bars of the marks of a figure: always 95 % intervals.
#[derive(Debug, Default)]
pub(super) struct Bars {
    /// `true` if some are longer than their marks.
    are_seen: bool,
    /// `true` if some are hidden by their marks.
    are_hidden: bool,
}

impl Bars {
    /// Adds a bar with its length in points.
    pub(super) fn add(&mut self, length: f64, theme: &Theme) {
        *(if length.abs() > 2.0 * theme.marker { &mut self.are_seen } else { &mut self.are_hidden }) = true;
    }

    /// Remark on the bars; `None` without bars.
    pub(super) fn remark(&self) -> Option<String> {
        let remark = match (self.are_seen, self.are_hidden) {
            (false, false) => return None,
            (true, false) => "Error bars: 95 % intervals.",
            (true, true) => "Error bars: 95 % intervals; hidden where smaller than the mark.",
            (false, true) => "95 % intervals are smaller than the marks.",
        };
        Some(remark.to_owned())
    }
}

/// Stroke of a recorded heading with too many points for dots; `None` for fewer points.
fn dense(heading: &PlotCurve, theme: &Theme) -> Option<Stroke> {
    let stroke = Stroke { opacity: 0.55, ..Stroke::solid(RECORD, 2.2 * theme.line) };
    (heading.finite_pairs().count() > DENSE).then_some(stroke)
}

/// Draws a recorded heading: dots, or a wide line under the fits if there are too many points for dots.
pub(super) fn draw_record(chart: &Chart, theme: &Theme, name: Option<&str>, heading: &PlotCurve) -> PlotResult {
    match dense(heading, theme) {
        Some(stroke) => chart.line(name, heading.pairs(), stroke),
        None => {
            let size = if heading.finite_pairs().count() > MANY { 1.0 } else { 1.4 };
            chart.dots(name, heading.finite_pairs(), size * theme.dot, RECORD.mix(1.0))
        }
    }
}

/// Symbol of [`draw_record`] in a legend.
pub(super) fn record_symbol(theme: &Theme, heading: &PlotCurve) -> LegendSymbol {
    dense(heading, theme).map_or(LegendSymbol::Dots(RECORD), LegendSymbol::Line)
}

/// Positions of marks, points, where marks nearer than `gap` are spread about their mean: zig-zags of one rudder angle
/// would otherwise overlap. `None` for a mark that is not on the axis.
pub(super) fn spread_overlapping(places: &[Option<f64>], gap: f64) -> Vec<Option<f64>> {
    let mut order: Vec<(usize, f64)> = places.iter().enumerate().filter_map(|(k, at)| Some((k, (*at)?))).collect();
    order.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut moved = places.to_vec();
    for group in order.chunk_by(|a, b| b.1 - a.1 < gap) {
        let middle = group.iter().map(|(_, place)| place).sum::<f64>() / group.len() as f64;
        for (rank, (k, _)) in group.iter().enumerate().filter(|_| group.len() > 1) {
            moved[*k] = Some(middle + (rank as f64 - 0.5 * (group.len() - 1) as f64) * gap);
        }
    }
    moved
}

/// Reference value of results, such as the nominal 95 % of an interval, with its 95 % band.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ReferenceBand95 {
    /// Reference value.
    pub value: f64,
    /// Ends of the band.
    pub band: [f64; 2],
}

impl ReferenceBand95 {
    /// Reference value without a band.
    pub fn line_at(value: f64) -> Self {
        Self { value, band: [value; 2] }
    }

    /// Reference value and the ends of the band.
    pub(super) fn values(&self) -> [f64; 3] {
        [self.value, self.band[0], self.band[1]]
    }

    /// Draws the reference as a vertical line with its band, at values of the horizontal axis.
    pub(super) fn vertical(&self, chart: &Chart, theme: &Theme) -> PlotResult {
        let (low, high) = chart.y.ends();
        chart.rectangle(self.band, [low, high], RECORD.mix(BAND))?;
        chart.vertical(None, self.value, Stroke::solid(INK, 0.8 * theme.line))
    }

    /// Draws the reference as a horizontal line with its band, at values of the vertical axis.
    pub(super) fn horizontal(&self, chart: &Chart, theme: &Theme) -> PlotResult {
        let (left, right) = chart.x.ends();
        chart.rectangle([left, right], self.band, RECORD.mix(BAND))?;
        chart.horizontal(self.value, Stroke::solid(INK, 0.8 * theme.line))
    }
}

/// Opacity of the band of a reference.
const BAND: f64 = 0.22;

/// Stroke of the line at zero, about which errors and residuals scatter.
pub(super) fn zero_stroke(theme: &Theme) -> Stroke {
    Stroke { opacity: 0.55, ..Stroke::solid(INK, theme.thin) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_one_rudder_stand_side_by_side() {
        let of = |places: &[f64]| spread_overlapping(&places.iter().map(|x| Some(*x)).collect::<Vec<_>>(), 4.0);
        assert_eq!(of(&[10.0, 50.0, 10.2]), [Some(8.1), Some(50.0), Some(12.1)]);
        assert_eq!(of(&[1.0, 9.0]), [Some(1.0), Some(9.0)]);
        assert_eq!(spread_overlapping(&[None], 4.0), [None]);
    }
}
