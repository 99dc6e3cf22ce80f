//! What kinds of figure share: records, areas, lines of reference, marks that stand side by side.

use serde::{Deserialize, Serialize};

use plotters::style::Color as _;

use crate::backend::Plotted;
use crate::canvas::Stroke;
use crate::chart::Chart;
use crate::curve::PlotCurve;
use crate::key::KeySample;
use crate::palette::{INK, RECORD};
use crate::theme::Theme;

/// Free space above and below the data, as a share of its range.
pub(super) const PAD: f64 = 0.08;

/// Free space left and right of lines.
pub(super) const ACROSS_PAD: f64 = 0.02;

/// More points than this in a panel run into each other and are drawn as a line.
const DENSE: usize = 400;

/// More points than this are smaller, so that they stay apart.
const MANY: usize = 150;

/// The line of a dense record.
fn dense(heading: &PlotCurve, theme: &Theme) -> Option<Stroke> {
    let stroke = Stroke { opacity: 0.55, ..Stroke::solid(RECORD, 2.2 * theme.line) };
    (heading.finite().count() > DENSE).then_some(stroke)
}

/// A recorded heading: dots, or a wide line under the fits where the record is dense.
pub(super) fn record(chart: &Chart, theme: &Theme, name: Option<&str>, heading: &PlotCurve) -> Plotted {
    match dense(heading, theme) {
        Some(stroke) => chart.line(name, heading.pairs(), stroke),
        None => {
            let size = if heading.finite().count() > MANY { 1.0 } else { 1.4 };
            chart.dots(name, heading.finite(), size * theme.dot, RECORD.mix(1.0))
        }
    }
}

/// How [`record`] looks in a legend.
pub(super) fn record_sample(theme: &Theme, heading: &PlotCurve) -> KeySample {
    dense(heading, theme).map_or(KeySample::Dots(RECORD), KeySample::Line)
}

/// Places with those that are nearer to each other than `gap` moved aside, as far as they need about their middle:
/// zig-zags of one rudder angle would hide each other.
pub(super) fn asides(places: &[Option<f64>], gap: f64) -> Vec<Option<f64>> {
    let mut order: Vec<(usize, f64)> =
        places.iter().enumerate().filter_map(|(k, place)| Some((k, (*place)?))).collect();
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

/// A value that results are held against, such as the 95 % an interval promises, with the band in which chance leaves
/// them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Reference95 {
    /// The value.
    pub value: f64,
    /// The band.
    pub band: [f64; 2],
}

impl Reference95 {
    /// A value without a band.
    pub fn line(value: f64) -> Self {
        Self { value, band: [value; 2] }
    }

    /// The value and the ends of the band.
    pub(super) fn values(&self) -> [f64; 3] {
        [self.value, self.band[0], self.band[1]]
    }

    /// Across a panel whose horizontal axis it belongs to.
    pub(super) fn vertical(&self, chart: &Chart, theme: &Theme) -> Plotted {
        let (low, high) = chart.y.ends();
        chart.rectangle(self.band, [low, high], RECORD.mix(BAND))?;
        chart.vertical(None, self.value, Stroke::solid(INK, 0.8 * theme.line))
    }

    /// Across a panel whose vertical axis it belongs to.
    pub(super) fn horizontal(&self, chart: &Chart, theme: &Theme) -> Plotted {
        let (left, right) = chart.x.ends();
        chart.rectangle([left, right], self.band, RECORD.mix(BAND))?;
        chart.horizontal(self.value, Stroke::solid(INK, 0.8 * theme.line))
    }
}

/// How dense the band of a reference is.
const BAND: f64 = 0.22;

/// The line of zero, about which errors and residuals scatter.
pub(super) fn zero_stroke(theme: &Theme) -> Stroke {
    Stroke { opacity: 0.55, ..Stroke::solid(INK, theme.thin) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_one_rudder_stand_side_by_side() {
        let of = |places: &[f64]| asides(&places.iter().map(|x| Some(*x)).collect::<Vec<_>>(), 4.0);
        assert_eq!(of(&[10.0, 50.0, 10.2]), [Some(8.1), Some(50.0), Some(12.1)]);
        assert_eq!(of(&[1.0, 9.0]), [Some(1.0), Some(9.0)]);
        assert_eq!(asides(&[None], 4.0), [None]);
    }
}
