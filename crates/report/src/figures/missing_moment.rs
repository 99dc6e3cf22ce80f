//! The yaw moment that a model lacks, as the rudder angle with the same moment: over time with its band, and below over
//! what it may depend on, each with a smooth curve and the band that holds all of it. The smoothed rows scatter about a
//! curve by what it does not carry.

use serde::{Deserialize, Serialize};

use super::shared::{OPACITY, PAD, area, time_side, zero_line};
use crate::axis::Axis;
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::palette::{HEADING, RECORD, RUDDER, SHORT_DASH};
use crate::panel::Panel;
use crate::scene::Stroke;
use crate::theme::Theme;
use crate::ticks::Steps;

/// A curve between two others.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Banded {
    /// The curve.
    pub middle: Curve,
    /// Lower end of the band, at the same places.
    pub lower: Curve,
    /// Upper end.
    pub upper: Curve,
    /// What a known explanation makes of it, where there is one.
    pub known: Option<Curve>,
}

/// The moment over one channel.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MomentPanel {
    /// Horizontal axis, with its unit.
    pub x_title: String,
    /// A line above the panel.
    pub head: String,
    /// Smoothed moment of the rows, ° of rudder.
    pub rows: Curve,
    /// The smooth curve, ° of rudder.
    pub curve: Banded,
}

/// What [`missing_moment`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MissingMoment {
    /// Title above the figure.
    pub title: Option<String>,
    /// The moment over time, ° of rudder over seconds.
    pub time: Banded,
    /// Name of the known explanation.
    pub known: Option<String>,
    /// The moment over channels, in reading order.
    pub panels: Vec<MomentPanel>,
}

const TITLE: &str = "moment [° rudder]";

/// Draws time above and the channels below in two columns, in one where the figure is narrow.
pub fn missing_moment(data: &MissingMoment, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let mut entries = vec![Entry::new(Sample::Line(own(theme)), "missing moment"), band_entry(theme)];
    if !data.panels.is_empty() {
        entries.push(Entry::new(Sample::Dots(RECORD), "its smoothed rows"));
    }
    entries.extend(data.known.iter().map(|name| Entry::new(Sample::Line(known(theme)), name.clone())));
    sheet.legend(&entries);
    let whole = [&data.time.middle, &data.time.lower, &data.time.upper];
    let shown = whole.into_iter().chain(&data.time.known);
    let upper = Side::new(y_axis(shown), TITLE);
    for panel in &sheet.grid(Grid::stack(time_side([&data.time.middle]), vec![(upper, theme.tall(0.24))])) {
        draw(panel, &data.time, &mut sheet, theme);
    }
    let width = if theme.is_narrow() { 1 } else { 2 };
    let part = (theme.width - Sheet::gap(theme) * (width - 1) as f64) / width as f64;
    for row in data.panels.chunks(width) {
        let top = sheet.height();
        let mut lowest = top;
        for (column, content) in row.iter().enumerate() {
            sheet.rewind(top);
            let Banded { middle, lower, upper, known } = &content.curve;
            let curves = [&content.rows, middle, lower, upper].into_iter().chain(known);
            let across = Axis::covering(middle.finite().map(|(x, _)| x), 0.02, Steps::Decimal);
            let rows = vec![(Side::new(y_axis(curves), TITLE), theme.tall(0.2))];
            let heads = vec![Some(Entry::new(Sample::Nothing, content.head.clone()))];
            let grid = Grid { heads, ..Grid::stack(Side::new(across, content.x_title.clone()), rows) };
            let left = column as f64 * (part + Sheet::gap(theme));
            for panel in &sheet.grid_within(grid, (left, part)) {
                panel.dots(&mut sheet.scene, content.rows.finite(), 0.75 * theme.dot, RECORD);
                draw(panel, &content.curve, &mut sheet, theme);
            }
            lowest = f64::max(lowest, sheet.height());
        }
        sheet.rewind(lowest);
    }
    sheet.finish()
}

fn own(theme: &Theme) -> Stroke {
    Stroke::solid(HEADING, theme.line)
}

fn known(theme: &Theme) -> Stroke {
    Stroke::solid(RUDDER, theme.line).dashed(SHORT_DASH)
}

fn band_entry(theme: &Theme) -> Entry {
    let stroke = Stroke { opacity: OPACITY, ..Stroke::solid(HEADING, 0.8 * theme.small_font) };
    Entry::new(Sample::Line(stroke), "95 % band")
}

fn y_axis<'a>(curves: impl Iterator<Item = &'a Curve>) -> Axis {
    Axis::covering(curves.flat_map(|curve| curve.finite().map(|(_, y)| y)), PAD, Steps::Decimal)
}

fn draw(panel: &Panel, banded: &Banded, sheet: &mut Sheet, theme: &Theme) {
    zero_line(panel, &mut sheet.scene, theme);
    area(panel, &mut sheet.scene, [&banded.lower, &banded.upper], HEADING);
    panel.line(&mut sheet.scene, banded.middle.pairs(), own(theme));
    if let Some(curve) = &banded.known {
        panel.line(&mut sheet.scene, curve.pairs(), known(theme));
    }
}
