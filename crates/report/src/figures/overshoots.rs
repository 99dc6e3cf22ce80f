//! Predicted quantities of manoeuvres as intervals, one row each, against what was measured and what is allowed.

use serde::{Deserialize, Serialize};

use super::named_rows::{NamedRows, limit_stroke};
use super::shared::widened;
use crate::axis::{self, Axis};
use crate::dimension::Dimensions;
use crate::figure::Figure;
use crate::layout::{Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::palette::{BEFORE, HEADING, INK, Look, Marker, RECORD, SOLID};
use crate::panel::Panel;
use crate::scene::{Anchor, Layer, Scene, Stroke, Text};
use crate::theme::Theme;
use crate::ticks::Steps;

/// One predicted quantity; all numbers in the unit of the figure.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct OvershootRow {
    /// Name of the quantity, such as "20/20 first overshoot".
    pub label: String,
    /// Median of the drawn ships.
    pub median: f64,
    /// The interval that holds half of them.
    pub ci50: [f64; 2],
    /// The interval that holds nine tenths of them.
    pub ci90: [f64; 2],
    /// What was measured.
    pub measured: Option<f64>,
    /// The largest value that the IMO standard allows.
    pub limit: Option<f64>,
    /// Whether the manoeuvre goes beyond what the records hold.
    pub extrapolated: bool,
}

/// What [`overshoots`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Overshoots {
    /// Title above the figure.
    pub title: Option<String>,
    /// Unit of every number, such as "°" or "L".
    pub unit: String,
    /// The rows from top to bottom.
    pub rows: Vec<OvershootRow>,
}

/// An outer interval may leave the range of everything else by this share of it before it is cut.
const ROOM: f64 = 1.0;
/// Largest share of the page for the names of the rows.
const NAMES: f64 = 0.42;

/// Draws the intervals below each other.
pub fn overshoots(data: &Overshoots, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
    let unit = if data.unit.is_empty() { String::new() } else { format!(" [{}]", data.unit) };
    let names = data.rows.iter().map(|row| row.label.as_str());
    let across = Side::new(axis(data), format!("predicted value{unit}"));
    let Some(rows) = NamedRows::new(&mut sheet, theme, names, NAMES, across) else { return sheet.finish() };
    let mut beyond = false;
    for (index, row) in data.rows.iter().enumerate() {
        let colour = if row.extrapolated { RECORD } else { INK };
        if let Some(y) = rows.label(&mut sheet.scene, theme, index, colour) {
            beyond |= draw(&rows, &mut sheet.scene, theme, y, row);
        }
    }
    if beyond {
        sheet.note("Arrows: beyond the axis.");
    }
    sheet.finish()
}

/// Covers zero, medians, inner intervals, measured values and limits, and the outer intervals as far as there is room.
fn axis(data: &Overshoots) -> Axis {
    let marks = data.rows.iter().flat_map(|row| [Some(row.median), row.measured, row.limit]).flatten();
    let inner = data.rows.iter().flat_map(|row| row.ci50);
    let outer = data.rows.iter().flat_map(|row| row.ci90).filter(|end| end.is_finite());
    let (lo, hi) = axis::range(marks.chain(inner).chain([0.0])).unwrap_or((0.0, 0.0));
    let room = if hi > lo { ROOM * (hi - lo) } else { f64::INFINITY };
    let ((lo, hi), _) = widened((lo, hi), outer, room);
    if lo == hi {
        return Axis::linear(0.0, 1.0, Steps::Decimal);
    }
    // The axis ends at zero where everything lies on one side of it.
    let pad = 0.05 * (hi - lo);
    Axis::linear(if lo < 0.0 { lo - pad } else { lo }, if hi > 0.0 { hi + pad } else { hi }, Steps::Decimal)
}

fn median_look(extrapolated: bool) -> Look {
    Look { colour: HEADING, marker: Marker::Circle, dash: SOLID, hollow: extrapolated }
}

const MEASURED: Look = Look { colour: BEFORE, marker: Marker::Diamond, dash: SOLID, hollow: true };

fn stroke90(theme: &Theme) -> Stroke {
    Stroke::solid(HEADING, theme.line)
}

/// Pale, so that the marks on it can be seen, and higher than the dot, so that a narrow one is seen too.
fn stroke50(theme: &Theme) -> Stroke {
    Stroke { opacity: 0.55, ..Stroke::solid(HEADING, 2.9 * theme.marker) }
}

fn entries(data: &Overshoots, theme: &Theme) -> Vec<Entry> {
    let any = |wanted: fn(&OvershootRow) -> bool| data.rows.iter().any(wanted);
    let mut entries = vec![
        Entry::new(Sample::Marker(median_look(false)), "median"),
        Entry::new(Sample::Line(stroke50(theme)), "50 % of the drawn ships"),
        Entry::new(Sample::Line(stroke90(theme)), "90 %"),
    ];
    if any(|row| row.measured.is_some()) {
        entries.push(Entry::new(Sample::Marker(MEASURED), "measured"));
    }
    if any(|row| row.limit.is_some()) {
        entries.push(Entry::new(Sample::Upright(limit_stroke(theme)), "IMO limit"));
    }
    if any(|row| row.extrapolated) {
        entries.push(Entry::new(Sample::Marker(median_look(true)), "extrapolated (name in grey)"));
    }
    entries
}

/// Draws one row about its place; tells whether something lies beyond the axis.
fn draw(rows: &NamedRows, scene: &mut Scene, theme: &Theme, y: f64, row: &OvershootRow) -> bool {
    let panel = &rows.panel;
    let mut beyond = bar(panel, scene, theme, y, row.ci90, stroke90(theme));
    beyond |= bar(panel, scene, theme, y, row.ci50, stroke50(theme));
    let rect = panel.rect;
    rows.limit(scene, theme, y, row.limit);
    let mut mark = |value: f64, y: f64, size: f64, look: &Look| {
        if let Some(place) = panel.across(value).map(|x| (x, y)).filter(|place| rect.contains(*place)) {
            scene.marker(Layer::Data, place, size * theme.marker, look);
        }
    };
    mark(row.median, y, 0.95, &median_look(row.extrapolated));
    if let Some(measured) = row.measured {
        // Under the bar, so that it does not hide a median nearby.
        mark(measured, y + 0.34 * rows.pitch, 1.1, &MEASURED);
    }
    if !row.median.is_finite() && row.measured.is_none() && row.limit.is_none() {
        let text = Text::new("no prediction", theme.small_font).anchor(Anchor::Middle).colour(RECORD);
        let place = (rect.x + rect.w / 2.0, y + text.centring());
        scene.text_on_ground(Layer::Note, place, text);
    }
    beyond
}

/// An interval, with an arrow head at an end that lies beyond the axis; tells whether one does.
fn bar(panel: &Panel, scene: &mut Scene, theme: &Theme, y: f64, [a, b]: [f64; 2], stroke: Stroke) -> bool {
    // An end without bound lies beyond every axis.
    let place = |value: f64| panel.across(value.clamp(-f64::MAX, f64::MAX)).filter(|place| !place.is_nan());
    let (Some(a), Some(b)) = (place(a), place(b)) else { return false };
    let (x, right) = (panel.rect.x, panel.rect.right());
    let (lo, hi) = (a.min(b), a.max(b));
    let (from, to) = (lo.clamp(x, right), hi.clamp(x, right));
    if from < to {
        scene.line(Layer::Data, [(from, y), (to, y)], stroke);
    }
    let slack = 1e-6;
    let ends = [(lo < x - slack, x, -1.0), (hi > right + slack, right, 1.0)];
    for (_, edge, direction) in ends.into_iter().filter(|end| end.0) {
        Dimensions::head(scene, (edge, y), (direction, 0.0), 0.6 * theme.small_font, stroke.colour);
    }
    ends.iter().any(|end| end.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(median: f64, half: f64) -> OvershootRow {
        OvershootRow {
            median,
            ci50: [median - 0.4 * half, median + 0.4 * half],
            ci90: [median - half, median + half],
            ..OvershootRow::default()
        }
    }

    #[test]
    fn the_axis_begins_at_zero_where_nothing_is_negative() {
        let of = |rows: Vec<OvershootRow>| axis(&Overshoots { rows, ..Overshoots::default() });
        assert_eq!(of(vec![row(10.0, 2.0), row(20.0, 3.0)]).fraction(0.0), Some(0.0));
        assert!(of(vec![row(10.0, 12.0)]).fraction(-2.0).is_some_and(|f| f > 0.0));
        // An interval that runs far off is cut.
        let wide = of(vec![row(10.0, 5.0), OvershootRow { ci90: [8.0, 1e6], ..row(20.0, 3.0) }]);
        assert!(wide.fraction(20.0).is_some_and(|f| f > 0.4));
    }
}
