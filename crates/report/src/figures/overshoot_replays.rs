//! Overshoot angles of zig-zags as bars, with those of the replays of a model before and after something was added to
//! it, against what the IMO standard allows.

use serde::{Deserialize, Serialize};

use super::named_rows::{NamedRows, limit_stroke};
use crate::axis::{self, Axis};
use crate::figure::Figure;
use crate::layout::{Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::palette::{INK, Origin, RECORD};
use crate::scene::{Layer, Scene, Stroke};
use crate::theme::Theme;
use crate::ticks::Steps;

/// One overshoot; degrees.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ReplayedOvershoot {
    /// Record and number of the overshoot.
    pub label: String,
    /// What was measured.
    pub measured: Option<f64>,
    /// What the model before makes of it.
    pub before: Option<f64>,
    /// What the model after makes of it.
    pub after: Option<f64>,
    /// The largest value that the IMO standard allows, where it has one for this zig-zag.
    pub limit: Option<f64>,
}

/// What [`overshoot_replays`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct OvershootReplays {
    /// Title above the figure.
    pub title: Option<String>,
    /// The overshoots from top to bottom.
    pub rows: Vec<ReplayedOvershoot>,
}

/// Largest share of the page for the names of the rows.
const NAMES: f64 = 0.4;

/// Draws the bars below each other.
pub fn overshoot_replays(data: &OvershootReplays, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
    let names = data.rows.iter().map(|row| row.label.as_str());
    let Some(rows) = NamedRows::new(&mut sheet, theme, names, NAMES, Side::new(across(data), "overshoot [°]")) else {
        return sheet.finish();
    };
    for (index, row) in data.rows.iter().enumerate() {
        if let Some(y) = rows.label(&mut sheet.scene, theme, index, INK) {
            draw(&rows, &mut sheet.scene, theme, y, row);
        }
    }
    sheet.finish()
}

/// From zero to the largest of everything.
fn across(data: &OvershootReplays) -> Axis {
    let values = data.rows.iter().flat_map(|row| [row.measured, row.before, row.after, row.limit]).flatten();
    let (lo, hi) = axis::range(values.filter(|value| value.abs() < 1e6).chain([0.0])).unwrap_or((0.0, 1.0));
    let pad = 0.05 * (hi - lo);
    match hi > lo {
        true => Axis::linear(if lo < 0.0 { lo - pad } else { lo }, hi + pad, Steps::Decimal),
        false => Axis::linear(0.0, 1.0, Steps::Decimal),
    }
}

/// Pale, so that the marks on it can be seen.
fn bar(theme: &Theme) -> Stroke {
    Stroke { opacity: 0.45, ..Stroke::solid(RECORD, 0.75 * theme.tick_font) }
}

/// One of the angles of a row.
type Part = fn(&ReplayedOvershoot) -> Option<f64>;

fn entries(data: &OvershootReplays, theme: &Theme) -> Vec<Entry> {
    let any = |wanted: Part| data.rows.iter().any(|row| wanted(row).is_some());
    let mut entries = vec![Entry::new(Sample::Line(bar(theme)), "measured")];
    let marks: [(Origin, Part); 2] = [(Origin::Before, |row| row.before), (Origin::After, |row| row.after)];
    for (origin, wanted) in marks {
        if any(wanted) {
            entries.push(Entry::new(Sample::Marker(origin.look()), origin.label()));
        }
    }
    if any(|row| row.limit) {
        entries.push(Entry::new(Sample::Upright(limit_stroke(theme)), "IMO limit"));
    }
    entries
}

fn draw(rows: &NamedRows, scene: &mut Scene, theme: &Theme, y: f64, row: &ReplayedOvershoot) {
    let panel = &rows.panel;
    let place = |value: f64| panel.across(value).map(|x| (x, y)).filter(|place| panel.rect.contains(*place));
    if let (Some(from), Some(to)) = (place(0.0), row.measured.and_then(place)) {
        scene.line(Layer::Data, [from, to], bar(theme));
    }
    rows.limit(scene, theme, y, row.limit);
    // One above the other, so that neither hides the other.
    for (origin, value, aside) in [(Origin::Before, row.before, -0.16), (Origin::After, row.after, 0.16)] {
        if let Some((x, y)) = value.and_then(place) {
            scene.marker(Layer::Data, (x, y + aside * rows.pitch), 0.85 * theme.marker, &origin.look());
        }
    }
}
