//! A record as it was read, with marks at the readings that were taken as missing or are doubtful: heading above,
//! rudder below.

use serde::{Deserialize, Serialize};

use super::shared::{angle_side, heading_title, record, record_entry, rudder_title, time_side, zero_line};
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet};
use crate::legend::{Entry, Sample};
use crate::palette::{BEFORE, Look, Marker, RUDDER, SOLID};
use crate::scene::Stroke;
use crate::theme::Theme;

/// What [`raw_record`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RawRecord {
    /// Title above the figure.
    pub title: Option<String>,
    /// Heading, degrees over seconds.
    pub heading: Curve,
    /// Rudder angle, degrees over seconds.
    pub rudder: Curve,
    /// Headings that are marked, degrees over seconds.
    pub marked_headings: Curve,
    /// Rudder angles that are marked, degrees over seconds.
    pub marked_rudder: Curve,
}

/// Draws heading and rudder with their marks over one time axis.
pub fn raw_record(data: &RawRecord, theme: &Theme) -> Figure {
    let look = Look { colour: BEFORE, marker: Marker::Diamond, dash: SOLID, hollow: true };
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&[
        record_entry("recorded heading", theme, &data.heading),
        Entry::new(Sample::Line(Stroke::solid(RUDDER, theme.line)), "recorded rudder"),
        Entry::new(Sample::Marker(look), "left out or doubtful"),
    ]);
    let headings = [&data.heading, &data.marked_headings];
    let rudders = [&data.rudder, &data.marked_rudder];
    let rows = vec![
        (angle_side(headings, heading_title()), theme.tall(0.3)),
        (angle_side(rudders, rudder_title()), theme.tall(0.16)),
    ];
    let panels = sheet.grid(Grid::stack(time_side(headings.into_iter().chain(rudders)), rows));
    let [upper, lower] = &panels[..] else { return sheet.finish() };
    record(upper, &mut sheet.scene, theme, &data.heading, 1.5 * theme.dot);
    zero_line(lower, &mut sheet.scene, theme);
    lower.line(&mut sheet.scene, data.rudder.pairs(), Stroke::solid(RUDDER, theme.line));
    for (panel, marks) in [(upper, &data.marked_headings), (lower, &data.marked_rudder)] {
        for place in marks.pairs() {
            panel.marker(&mut sheet.scene, place, theme.marker, &look);
        }
    }
    sheet.finish()
}
