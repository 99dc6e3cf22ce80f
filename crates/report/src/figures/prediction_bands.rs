//! A predicted manoeuvre: heading of the most probable ship with the bands that hold half and nine tenths of the drawn
//! ships, and its rudder below.

use serde::{Deserialize, Serialize};

use super::shared::{
    PAD, angle_side, area_entry, heading_title, record, record_entry, rudder_title, shaded, time_side, widened,
    zero_line,
};
use crate::axis::{self, Axis};
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::palette::{HEADING, RUDDER};
use crate::scene::Stroke;
use crate::theme::Theme;
use crate::ticks::Steps;

/// What [`prediction_bands`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PredictionBands {
    /// Title above the figure.
    pub title: Option<String>,
    /// Heading of the most probable ship, degrees over seconds.
    pub heading: Curve,
    /// Lower and upper end of the band that holds half of the drawn ships, degrees over seconds.
    pub band50: [Curve; 2],
    /// Lower and upper end of the band that holds nine tenths of them.
    pub band90: [Curve; 2],
    /// Measured heading, where a record is replayed.
    pub recorded: Option<Curve>,
    /// Rudder angle of the most probable ship, degrees over seconds.
    pub rudder: Curve,
}

/// How dense the outer band is.
const OUTER: f64 = 0.2;
/// How dense the inner band is, which lies on the outer one.
const INNER: f64 = 0.38;
/// The outer band may leave the range of everything else by this share of it before it is cut.
const ROOM: f64 = 1.0;

/// Draws heading with bands and rudder over one time axis.
pub fn prediction_bands(data: &PredictionBands, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
    let [low, high] = &data.band90;
    let (axis, cut) = heading_axis(data);
    let rows = vec![
        (Side::new(axis, heading_title()), theme.tall(0.32)),
        (angle_side([&data.rudder], rudder_title()), theme.tall(0.13)),
    ];
    let everything = core(data).chain([low, high, &data.rudder]);
    let panels = sheet.grid(Grid::stack(time_side(everything), rows));
    let [upper, lower] = &panels[..] else { return sheet.finish() };
    shaded(upper, &mut sheet.scene, data.band90.each_ref(), HEADING, OUTER);
    shaded(upper, &mut sheet.scene, data.band50.each_ref(), HEADING, INNER);
    if let Some(recorded) = &data.recorded {
        record(upper, &mut sheet.scene, theme, recorded, 1.3 * theme.dot);
    }
    upper.line(&mut sheet.scene, data.heading.pairs(), heading_stroke(theme));
    zero_line(lower, &mut sheet.scene, theme);
    lower.line(&mut sheet.scene, data.rudder.pairs(), Stroke::solid(RUDDER, theme.line));
    if cut {
        sheet.note("The band of 90 % is cut at the frame.");
    }
    sheet.finish()
}

fn heading_stroke(theme: &Theme) -> Stroke {
    Stroke::solid(HEADING, 1.2 * theme.line)
}

fn entries(data: &PredictionBands, theme: &Theme) -> Vec<Entry> {
    // Where the inner band lies, the outer one shines through.
    let both = 1.0 - (1.0 - OUTER) * (1.0 - INNER);
    let mut entries = vec![
        area_entry("90 % of the drawn ships", HEADING, OUTER, theme),
        area_entry("50 %", HEADING, both, theme),
        Entry::new(Sample::Line(heading_stroke(theme)), "most probable ship"),
    ];
    entries.extend(data.recorded.iter().map(|recorded| record_entry("recorded heading", theme, recorded)));
    entries.push(Entry::new(Sample::Line(Stroke::solid(RUDDER, theme.line)), "rudder"));
    entries
}

/// What is never cut.
fn core(data: &PredictionBands) -> impl Iterator<Item = &Curve> {
    data.band50.iter().chain([&data.heading]).chain(&data.recorded)
}

/// The axis of the heading, and whether the outer band leaves it.
fn heading_axis(data: &PredictionBands) -> (Axis, bool) {
    let values = |curve: &Curve| curve.finite().map(|(_, heading)| heading).collect::<Vec<f64>>();
    let outer = || data.band90.iter().flat_map(values);
    let (ends, cut) = match axis::range(core(data).flat_map(values)) {
        Some((lo, hi)) if hi > lo => widened((lo, hi), outer(), ROOM * (hi - lo)),
        range => (axis::range(outer()).or(range).unwrap_or((f64::NAN, f64::NAN)), false),
    };
    (Axis::covering([ends.0, ends.1], PAD, Steps::Angle), cut)
}
