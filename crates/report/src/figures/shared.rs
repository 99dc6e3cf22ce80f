//! What figures share: axis titles, axes that cover a set of curves, records and lines of reference.

use estimation::statistics::upper_median;
use serde::{Deserialize, Serialize};

use crate::axis::{self, Axis};
use crate::clip::Rect;
use crate::colour::Colour;
use crate::curve::Curve;
use crate::layout::Side;
use crate::legend::{Entry, Sample};
use crate::markup::symbol;
use crate::palette::{HEADING, INK, Origin, RECORD};
use crate::panel::Panel;
use crate::scene::{Layer, Scene, Stroke};
use crate::theme::Theme;
use crate::ticks::Steps;

/// Free space above and below the data, as a share of its range.
pub(super) const PAD: f64 = 0.08;

pub(super) fn heading_title() -> String {
    format!("heading {} [°]", symbol("ψ"))
}

pub(super) fn rudder_title() -> String {
    format!("rudder {} [°]", symbol("δ"))
}

/// The time axis of everything in `curves`, without free space at the ends.
pub(super) fn time_side<'a>(curves: impl IntoIterator<Item = &'a Curve>) -> Side {
    let axis = Axis::covering(curves.into_iter().flat_map(|c| c.finite().map(|(x, _)| x)), 0.0, Steps::Time);
    Side::new(axis, format!("time {} [s]", symbol("t")))
}

/// More points than this in a panel run into each other and are drawn as a line.
const DENSE: usize = 400;

/// A recorded heading: dots, or a wide line under the fits where the record is dense.
pub(super) fn record(panel: &Panel, scene: &mut Scene, theme: &Theme, heading: &Curve, size: f64) {
    if heading.finite().count() > DENSE {
        panel.line(scene, heading.pairs(), Stroke { opacity: 0.55, ..Stroke::solid(RECORD, 2.2 * theme.line) });
    } else {
        panel.dots(scene, heading.finite(), size, RECORD);
    }
}

/// How dense the area of a band is.
pub(super) const OPACITY: f64 = 0.2;

/// The area between two curves, as far as it lies in the frame.
pub(super) fn shaded(panel: &Panel, scene: &mut Scene, [lower, upper]: [&Curve; 2], colour: Colour, opacity: f64) {
    let Rect { x, y, .. } = panel.rect;
    let inside = |(across, up): (f64, f64)| (across.clamp(x, panel.rect.right()), up.clamp(y, panel.rect.bottom()));
    let edge = |curve: &Curve| -> Vec<(f64, f64)> {
        curve.finite().filter_map(|pair| panel.place(pair)).map(inside).collect()
    };
    let outline = edge(lower).into_iter().chain(edge(upper).into_iter().rev());
    scene.fill(Layer::Grid, outline.collect::<Vec<_>>(), colour, opacity);
}

/// How an area looks in a legend.
pub(super) fn area_entry(label: &str, colour: Colour, opacity: f64, theme: &Theme) -> Entry {
    let stroke = Stroke { opacity, ..Stroke::solid(colour, 0.8 * theme.small_font) };
    Entry::new(Sample::Line(stroke), label)
}

/// One of the ships that were drawn at random, pale because there are many.
pub(super) fn drawn_stroke(theme: &Theme) -> Stroke {
    Stroke { opacity: 0.35, ..Stroke::solid(HEADING, theme.thin) }
}

/// The range `lo..=hi`, widened for the `rest` by no more than `room` on either side; and whether some of the rest
/// lies beyond.
pub(super) fn widened((lo, hi): (f64, f64), rest: impl Iterator<Item = f64>, room: f64) -> ((f64, f64), bool) {
    let (least, most) = axis::range(rest).unwrap_or((lo, hi));
    let ends = (least.clamp(lo - room, lo), most.clamp(hi, hi + room));
    (ends, least < ends.0 || most > ends.1)
}

/// How [`record`] looks in a legend.
pub(super) fn record_entry(label: &str, theme: &Theme, heading: &Curve) -> Entry {
    let sample = if heading.finite().count() > DENSE {
        Sample::Line(Stroke { opacity: 0.55, ..Stroke::solid(RECORD, 2.2 * theme.line) })
    } else {
        Sample::Dots(RECORD)
    };
    Entry::new(sample, label)
}

/// Everyone who appears, in the order of appearance.
pub(super) fn distinct<'a>(origins: impl Iterator<Item = &'a Origin>) -> Vec<&'a Origin> {
    let mut found: Vec<&Origin> = Vec::new();
    for origin in origins {
        if !found.contains(&origin) {
            found.push(origin);
        }
    }
    found
}

/// The middle one of the finite values, the upper of two.
pub(super) fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    upper_median(&mut values.filter(|v| v.is_finite()).collect::<Vec<f64>>())
}

/// A value that results are held against, such as the 95 % an interval promises, with the band in which chance leaves
/// them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Reference95 {
    /// The value.
    pub value: f64,
    /// The band.
    pub band: [f64; 2],
}

impl Reference95 {
    fn stroke(theme: &Theme) -> Stroke {
        Stroke::solid(INK, 0.8 * theme.line)
    }

    /// Across a panel whose horizontal axis it belongs to.
    pub(super) fn vertical(&self, panel: &Panel, scene: &mut Scene, theme: &Theme) {
        let Rect { x, y, .. } = panel.rect;
        let inside = |value: f64| panel.across(value).map(|place| place.clamp(x, panel.rect.right()));
        if let (Some(left), Some(right)) = (inside(self.band[0]), inside(self.band[1])) {
            let bottom = panel.rect.bottom();
            scene.fill(Layer::Grid, [(left, y), (right, y), (right, bottom), (left, bottom)], RECORD, 0.22);
        }
        panel.vertical(scene, Layer::Grid, self.value, Self::stroke(theme));
    }

    /// Across a panel whose vertical axis it belongs to.
    pub(super) fn horizontal(&self, panel: &Panel, scene: &mut Scene, theme: &Theme) {
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
pub(super) fn zero_upright(panel: &Panel, scene: &mut Scene, theme: &Theme) {
    panel.vertical(scene, Layer::Grid, 0.0, Stroke { opacity: 0.55, ..Stroke::solid(INK, theme.thin) });
}

/// The line a residual scatters about.
pub(super) fn zero_line(panel: &Panel, scene: &mut Scene, theme: &Theme) {
    panel.horizontal(scene, Layer::Grid, 0.0, Stroke { opacity: 0.55, ..Stroke::solid(INK, theme.thin) });
}
