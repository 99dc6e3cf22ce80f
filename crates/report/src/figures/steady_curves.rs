//! The steady turns of a ship as in the diagram of a spiral test: yaw rate against rudder angle, with the branch on
//! which a ship that is unstable on a straight course cannot stay, and the ships that may be meant just as well.

use serde::{Deserialize, Serialize};

use super::shared::{PAD, area_entry, drawn_stroke, widened, zero_line, zero_upright};
use crate::axis::{self, Axis};
use crate::clip::Rect;
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::markup::symbol;
use crate::palette::{HEADING, PAPER, RECORD, SHORT_DASH};
use crate::panel::Panel;
use crate::scene::{Layer, Scene, Stroke};
use crate::theme::Theme;
use crate::ticks::Steps;

/// What [`steady_curves`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SteadyCurves {
    /// Title above the figure.
    pub title: Option<String>,
    /// Steady yaw rate of the most probable ship, degrees a second over degrees of rudder, in the order of the rate.
    pub most_probable: Curve,
    /// The part of it that is unstable, drawn dashed; may be empty.
    pub unstable: Curve,
    /// The same of drawn ships, unstable parts included.
    pub drawn: Vec<Curve>,
    /// Largest rudder angle in the records, degrees.
    pub seen_rudder_deg: Option<f64>,
    /// Largest yaw rate in the records, degrees a second.
    pub seen_rate_deg_s: Option<f64>,
}

/// Drawn ships may leave the range of everything else by this share of it before they are cut.
const ROOM: f64 = 0.4;
/// How dense the field is in which there are records.
const FIELD: f64 = 0.16;

/// Draws the curves in one panel.
pub fn steady_curves(data: &SteadyCurves, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
    let seen = [seen(data.seen_rudder_deg), seen(data.seen_rate_deg_s)];
    let (across, beside) = side_axis(data, seen[0], |pair| pair.0, Steps::Angle);
    let (up, above) = side_axis(data, seen[1], |pair| pair.1, Steps::Decimal);
    let row = (Side::new(up, format!("yaw rate {} [°/s]", symbol("r"))), theme.tall(0.42));
    let panels = sheet.grid(Grid::stack(Side::new(across, format!("rudder {} [°]", symbol("δ"))), vec![row]));
    let [panel] = &panels[..] else { return sheet.finish() };
    field(panel, &mut sheet.scene, theme, seen);
    zero_line(panel, &mut sheet.scene, theme);
    zero_upright(panel, &mut sheet.scene, theme);
    for ship in &data.drawn {
        panel.line(&mut sheet.scene, ship.pairs(), drawn_stroke(theme));
    }
    // A white edge keeps the curve apart from the drawn ones, and its dashes from each other.
    let edge = Stroke::solid(PAPER, own(theme).width + 2.0 * theme.thin);
    panel.line(&mut sheet.scene, data.most_probable.pairs(), edge);
    panel.line(&mut sheet.scene, data.unstable.pairs(), edge);
    panel.line(&mut sheet.scene, stable(data), own(theme));
    panel.line(&mut sheet.scene, data.unstable.pairs(), own(theme).dashed(SHORT_DASH));
    let mut remarks = Vec::new();
    if seen != [None, None] {
        remarks.push("Outside the grey field the curves are extrapolated.");
    }
    if beside || above {
        remarks.push("Some drawn ships are cut at the frame.");
    }
    if !remarks.is_empty() {
        sheet.note(&remarks.join(" "));
    }
    sheet.finish()
}

fn own(theme: &Theme) -> Stroke {
    Stroke::solid(HEADING, 1.3 * theme.line)
}

fn seen(largest: Option<f64>) -> Option<f64> {
    largest.map(f64::abs).filter(|largest| largest.is_finite() && *largest > 0.0)
}

fn entries(data: &SteadyCurves, theme: &Theme) -> Vec<Entry> {
    let mut entries = vec![Entry::new(Sample::Line(own(theme)), "most probable ship")];
    if data.unstable.finite().nth(1).is_some() {
        entries.push(Entry::new(Sample::Line(own(theme).dashed(SHORT_DASH)), "unstable branch"));
    }
    if !data.drawn.is_empty() {
        entries.push(Entry::new(Sample::Line(drawn_stroke(theme)), "drawn ships"));
    }
    if seen(data.seen_rudder_deg).or(seen(data.seen_rate_deg_s)).is_some() {
        entries.push(area_entry("seen in the records", RECORD, 1.5 * FIELD, theme));
    }
    entries
}

/// The axis along which `part` of a pair lies, and whether drawn ships leave it.
fn side_axis(data: &SteadyCurves, seen: Option<f64>, part: fn((f64, f64)) -> f64, steps: Steps) -> (Axis, bool) {
    let own = data.most_probable.finite().chain(data.unstable.finite()).map(part);
    let core = axis::range(own.chain(seen.into_iter().flat_map(|largest| [-largest, largest])));
    let drawn = || data.drawn.iter().flat_map(Curve::finite).map(part);
    let (ends, cut) = match core {
        Some((lo, hi)) if hi > lo => widened((lo, hi), drawn(), ROOM * (hi - lo)),
        core => (axis::range(drawn()).or(core).unwrap_or((f64::NAN, f64::NAN)), false),
    };
    (Axis::covering([ends.0, ends.1], 0.5 * PAD, steps), cut)
}

/// The field in which there are records; a strip where only one of the two limits is known.
fn field(panel: &Panel, scene: &mut Scene, theme: &Theme, [rudder, rate]: [Option<f64>; 2]) {
    if rudder.is_none() && rate.is_none() {
        return;
    }
    let Rect { x, y, .. } = panel.rect;
    let (right, bottom) = (panel.rect.right(), panel.rect.bottom());
    let end = |value: Option<f64>, place: &dyn Fn(f64) -> Option<f64>, lo: f64, hi: f64, otherwise: f64| {
        value.and_then(place).map_or(otherwise, |found| found.clamp(lo, hi))
    };
    let across = |value: Option<f64>, otherwise| end(value, &|value| panel.across(value), x, right, otherwise);
    let up = |value: Option<f64>, otherwise| end(value, &|value| panel.up(value), y, bottom, otherwise);
    let (l, r) = (across(rudder.map(|largest| -largest), x), across(rudder, right));
    let (t, b) = (up(rate, y), up(rate.map(|largest| -largest), bottom));
    scene.fill(Layer::Grid, [(l, t), (r, t), (r, b), (l, b)], RECORD, FIELD);
    let edge = Stroke { opacity: 0.6, ..Stroke::solid(RECORD, theme.thin) };
    if rudder.is_some() {
        scene.line(Layer::Grid, [(l, t), (l, b)], edge);
        scene.line(Layer::Grid, [(r, t), (r, b)], edge);
    }
    if rate.is_some() {
        scene.line(Layer::Grid, [(l, t), (r, t)], edge);
        scene.line(Layer::Grid, [(l, b), (r, b)], edge);
    }
}

/// The curve of the most probable ship with gaps where it is unstable, so that the dashes there can be seen. The rate
/// tells where: a curve has one rudder angle for every rate.
fn stable(data: &SteadyCurves) -> Vec<(f64, f64)> {
    let pairs: Vec<(f64, f64)> = data.unstable.pairs().collect();
    let runs = pairs.split(|(rudder, rate)| !(rudder.is_finite() && rate.is_finite()));
    let spans: Vec<(f64, f64)> = runs.filter_map(|run| axis::range(run.iter().map(|(_, rate)| *rate))).collect();
    let gap = |rate: f64| spans.iter().any(|(lo, hi)| *lo < rate && rate < *hi);
    data.most_probable.pairs().map(|(rudder, rate)| (if gap(rate) { f64::NAN } else { rudder }, rate)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solid_line_is_broken_between_the_ends_of_every_unstable_part() {
        let rates: Vec<f64> = (-4..=4).map(f64::from).collect();
        let data = SteadyCurves {
            most_probable: Curve::new(vec![1.0; 9], rates),
            unstable: Curve::new([1.0, 1.0, 1.0, f64::NAN, 1.0, 1.0], [-3.0, -2.0, -1.0, 0.0, 1.0, 3.0]),
            ..SteadyCurves::default()
        };
        let kept: Vec<f64> = stable(&data).iter().filter(|pair| pair.0.is_finite()).map(|pair| pair.1).collect();
        assert_eq!(kept, [-4.0, -3.0, -1.0, 0.0, 1.0, 3.0, 4.0]);
    }
}
