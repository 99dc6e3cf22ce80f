//! K and T found in every record alone, over the amplitudes of its zig-zag: a ship whose indices change with the
//! amplitude is no first-order ship.

use serde::{Deserialize, Serialize};

use super::shared::{PAD, Reference95, median};
use crate::axis::{self, Axis};
use crate::dimension::Dimensions;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::palette::{INK, Look, Origin};
use crate::panel::Panel;
use crate::scene::{Layer, Scene, Stroke};
use crate::theme::Theme;
use crate::ticks::Steps;

/// Horizontal axes: a zig-zag has an amplitude of the rudder and one of the heading.
pub const COLUMNS: usize = 2;

/// One record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AmplitudePoint {
    /// Its amplitude on every horizontal axis, degrees.
    pub amplitudes_deg: [f64; COLUMNS],
    /// Value of the index.
    pub value: f64,
    /// Its 95 % interval.
    pub interval: Option<[f64; 2]>,
}

/// One index.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AmplitudePanel {
    /// Title of the vertical axis with unit.
    pub title: String,
    /// Every record alone.
    pub points: Vec<AmplitudePoint>,
    /// From all records together, with its 95 % interval.
    pub joint: Option<Reference95>,
}

/// What [`amplitude`] draws.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Amplitude {
    /// Title above the figure.
    pub title: Option<String>,
    /// Titles of the horizontal axes with unit: rudder and heading.
    pub x_titles: [String; COLUMNS],
    /// The method that was used on every record, which gives the colour.
    pub origin: Origin,
    /// Name of the joint line.
    pub joint_name: String,
    /// The panels, one above another.
    pub panels: Vec<AmplitudePanel>,
}

/// A value farther from zero than so many times the middle one is shown by an arrow.
const FAR: f64 = 3.0;

/// Free space left and right of the data, as a share of their range: records of one amplitude stand side by side.
const BESIDE: f64 = 0.14;

/// Draws the panels.
pub fn amplitude(data: &Amplitude, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
    let all = || data.panels.iter();
    let column = |place: usize| {
        let points = all().flat_map(|panel| panel.points.iter().map(|point| point.amplitudes_deg[place]));
        Side::new(Axis::covering(points, BESIDE, Steps::Angle), data.x_titles[place].clone())
    };
    let rows = all().map(|panel| (Side::new(up(panel), panel.title.clone()), theme.tall(0.3)));
    let panels = sheet.grid(Grid::new((0..COLUMNS).map(column).collect(), rows.collect()));
    let contents = all().flat_map(|content| (0..COLUMNS).map(move |place| (place, content)));
    let (mut beyond, mut aside) = (false, false);
    for (panel, (place, content)) in panels.iter().zip(contents) {
        if let Some(joint) = &content.joint {
            joint.horizontal(panel, &mut sheet.scene, theme);
        }
        let across = |point: &AmplitudePoint| panel.across(point.amplitudes_deg[place]).unwrap_or(f64::NAN);
        let own: Vec<f64> = content.points.iter().map(across).collect();
        let places = asides(&own, 2.0 * theme.marker);
        aside |= own.iter().zip(&places).any(|(own, moved)| (own - moved).abs() > theme.marker);
        for (point, x) in content.points.iter().zip(places) {
            beyond |= draw(panel, &mut sheet.scene, theme, (x, point), &look(data));
        }
    }
    let remarks = [(aside, "Records of one amplitude stand side by side."), (beyond, "Arrows: beyond the axis.")];
    let remarks: Vec<&str> = remarks.into_iter().filter(|(holds, _)| *holds).map(|(_, remark)| remark).collect();
    if !remarks.is_empty() {
        sheet.note(&remarks.join(" "));
    }
    sheet.finish()
}

/// Points are not joined: a cross or a star would hide its bar.
fn look(data: &Amplitude) -> Look {
    let own = data.origin.look();
    Look { marker: crate::palette::Marker::Circle, ..own }
}

fn entries(data: &Amplitude, theme: &Theme) -> Vec<Entry> {
    let own = format!("{}, every record alone, 95 %", data.origin.label());
    let mut entries = vec![Entry::new(Sample::Marker(look(data)), own)];
    if data.panels.iter().any(|panel| panel.joint.is_some()) {
        entries.push(Entry::new(Sample::Line(Stroke::solid(INK, 0.8 * theme.line)), data.joint_name.clone()));
    }
    entries
}

/// Covers what is of the size of the middle point; intervals as far as there is room.
fn up(panel: &AmplitudePanel) -> Axis {
    let points = || panel.points.iter().map(|point| point.value);
    let limit = FAR * median(points().map(f64::abs)).unwrap_or(f64::INFINITY);
    let joint = panel.joint.iter().map(|joint| joint.value);
    let core: Vec<f64> = points().chain(joint).filter(|value| value.abs() <= limit).collect();
    let room = axis::range(core.iter().copied()).map_or(0.0, |(lo, hi)| (hi - lo).max(0.2 * limit.min(hi.abs())));
    let (lo, hi) = axis::range(core.iter().copied()).unwrap_or((0.0, 1.0));
    let ends = panel.points.iter().filter_map(|point| point.interval).flatten().filter(|end| end.is_finite());
    let ends = ends.map(|end| end.clamp(lo - room, hi + room));
    Axis::covering(core.iter().copied().chain(ends), PAD, Steps::Decimal)
}

/// Places with those that are nearer to each other than `gap` moved aside, as far as they need about their middle:
/// zig-zags of one rudder angle would hide each other.
fn asides(places: &[f64], gap: f64) -> Vec<f64> {
    let mut order: Vec<usize> = (0..places.len()).filter(|&k| places[k].is_finite()).collect();
    order.sort_by(|&one, &other| places[one].total_cmp(&places[other]));
    let mut moved = places.to_vec();
    for group in order.chunk_by(|&one, &other| places[other] - places[one] < gap) {
        let middle = group.iter().map(|&k| places[k]).sum::<f64>() / group.len() as f64;
        for (rank, &k) in group.iter().enumerate().filter(|_| group.len() > 1) {
            moved[k] = middle + (rank as f64 - 0.5 * (group.len() - 1) as f64) * gap;
        }
    }
    moved
}

/// Draws one record; tells whether something lies beyond the axis.
fn draw(panel: &Panel, scene: &mut Scene, theme: &Theme, (x, point): (f64, &AmplitudePoint), look: &Look) -> bool {
    if !x.is_finite() {
        return false;
    }
    let x = x.clamp(panel.rect.x, panel.rect.right());
    let (top, bottom) = (panel.rect.y, panel.rect.bottom());
    let place = |value: f64| panel.up(value.clamp(-f64::MAX, f64::MAX)).filter(|y| !y.is_nan());
    let Some(y) = place(point.value) else { return false };
    let slack = 1e-6;
    let mut beyond = false;
    if let Some([a, b]) = point.interval.map(|ends| ends.map(place)).and_then(|[a, b]| Some([a?, b?])) {
        let (from, to) = (a.min(b).clamp(top, bottom), a.max(b).clamp(top, bottom));
        if from < to {
            scene.line(Layer::Data, [(x, from), (x, to)], Stroke::solid(look.colour, theme.line));
        }
    }
    let ends = point.interval.map_or([y, y], |ends| {
        let [a, b] = ends.map(|end| place(end).unwrap_or(y));
        [a.min(b).min(y), a.max(b).max(y)]
    });
    for (is_beyond, edge, direction) in [(ends[0] < top - slack, top, -1.0), (ends[1] > bottom + slack, bottom, 1.0)] {
        if is_beyond {
            Dimensions::head(scene, (x, edge), (0.0, direction), 0.6 * theme.small_font, look.colour);
            beyond = true;
        }
    }
    if (top..=bottom).contains(&y) {
        scene.marker(Layer::Data, (x, y), theme.marker, look);
    }
    beyond
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_one_rudder_stand_side_by_side() {
        assert_eq!(asides(&[10.0, 50.0, 10.2, f64::NAN], 4.0)[..3], [8.1, 50.0, 12.1]);
        assert_eq!(asides(&[1.0, 9.0], 4.0), [1.0, 9.0]);
        assert!(asides(&[], 4.0).is_empty());
    }
}
