//! What kinds of figure share: records, areas, lines of reference, marks that stand side by side.

use serde::{Deserialize, Serialize};

use crate::clip::Rect;
use crate::curve::PlotCurve;
use crate::legend::KeySample;
use crate::paint::Paint;
use crate::palette::{INK, RECORD};
use crate::panel::Panel;
use crate::scene::{Canvas, Layer, Stroke};
use crate::theme::Theme;

/// Free space above and below the data, as a share of its range.
pub(super) const PAD: f64 = 0.08;

/// Free space left and right of lines.
pub(super) const ACROSS_PAD: f64 = 0.02;

/// More points than this in a panel run into each other and are drawn as a line.
const DENSE: usize = 400;

/// The line of a dense record.
fn dense(heading: &PlotCurve, theme: &Theme) -> Option<Stroke> {
    let stroke = Stroke { opacity: 0.55, ..Stroke::solid(RECORD, 2.2 * theme.line) };
    (heading.finite().count() > DENSE).then_some(stroke)
}

/// A recorded heading: dots, or a wide line under the fits where the record is dense.
pub(super) fn record(panel: &Panel, scene: &mut Canvas, theme: &Theme, heading: &PlotCurve, size: f64) {
    match dense(heading, theme) {
        Some(stroke) => panel.line(scene, heading.pairs(), stroke),
        None => panel.dots(scene, heading.finite(), size, RECORD),
    }
}

/// How [`record`] looks in a legend.
pub(super) fn record_sample(theme: &Theme, heading: &PlotCurve) -> KeySample {
    dense(heading, theme).map_or(KeySample::Dots(RECORD), KeySample::Line)
}

/// The area between two curves, as far as it lies in the frame.
pub(super) fn shaded(panel: &Panel, scene: &mut Canvas, [lower, upper]: [&PlotCurve; 2], colour: Paint, opacity: f64) {
    let Rect { x, y, .. } = panel.rect;
    let inside = |(across, up): (f64, f64)| (across.clamp(x, panel.rect.right()), up.clamp(y, panel.rect.bottom()));
    let edge = |curve: &PlotCurve| -> Vec<(f64, f64)> {
        curve.finite().filter_map(|pair| panel.place(pair)).map(inside).collect()
    };
    let outline = edge(lower).into_iter().chain(edge(upper).into_iter().rev());
    scene.fill(Layer::Grid, outline.collect::<Vec<_>>(), colour, opacity);
}

/// Places with those that are nearer to each other than `gap` moved aside, as far as they need about their middle:
/// zig-zags of one rudder angle would hide each other.
pub(super) fn asides(places: &[Option<f64>], gap: f64) -> Vec<Option<f64>> {
    let mut order: Vec<(usize, f64)> =
        places.iter().enumerate().filter_map(|(k, place)| Some((k, (*place)?))).collect();
    order.sort_by(|one, other| one.1.total_cmp(&other.1));
    let mut moved = places.to_vec();
    for group in order.chunk_by(|one, other| other.1 - one.1 < gap) {
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

    fn stroke(theme: &Theme) -> Stroke {
        Stroke::solid(INK, 0.8 * theme.line)
    }

    /// Across a panel whose horizontal axis it belongs to.
    pub(super) fn vertical(&self, panel: &Panel, scene: &mut Canvas, theme: &Theme) {
        let Rect { x, y, .. } = panel.rect;
        let inside = |value: f64| panel.across(value).map(|place| place.clamp(x, panel.rect.right()));
        if let (Some(left), Some(right)) = (inside(self.band[0]), inside(self.band[1])) {
            let bottom = panel.rect.bottom();
            scene.fill(Layer::Grid, [(left, y), (right, y), (right, bottom), (left, bottom)], RECORD, 0.22);
        }
        panel.vertical(scene, Layer::Grid, self.value, Self::stroke(theme));
    }

    /// Across a panel whose vertical axis it belongs to.
    pub(super) fn horizontal(&self, panel: &Panel, scene: &mut Canvas, theme: &Theme) {
        let Rect { x, y, .. } = panel.rect;
        let inside = |value: f64| panel.up(value).map(|place| place.clamp(y, panel.rect.bottom()));
        if let (Some(low), Some(high)) = (inside(self.band[0]), inside(self.band[1])) {
            let right = panel.rect.right();
            scene.fill(Layer::Grid, [(x, low), (right, low), (right, high), (x, high)], RECORD, 0.22);
        }
        panel.horizontal(scene, Layer::Grid, self.value, Self::stroke(theme));
    }
}

/// The line errors scatter about where they run across.
pub(super) fn zero_upright(panel: &Panel, scene: &mut Canvas, theme: &Theme) {
    panel.vertical(scene, Layer::Grid, 0.0, Stroke { opacity: 0.55, ..Stroke::solid(INK, theme.thin) });
}

/// The line a residual scatters about.
pub(super) fn zero_line(panel: &Panel, scene: &mut Canvas, theme: &Theme) {
    panel.horizontal(scene, Layer::Grid, 0.0, Stroke { opacity: 0.55, ..Stroke::solid(INK, theme.thin) });
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
