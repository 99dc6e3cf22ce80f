//! What two models leave of a record, seen from several sides: against time, heading, yaw rate and rudder, as spectrum
//! and as autocorrelation. One panel per side; before and after lie on top of each other.

use serde::{Deserialize, Serialize};

use super::shared::{PAD, distinct, zero_line};
use crate::axis::Axis;
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::palette::{INK, Origin};
use crate::scene::{Layer, Stroke};
use crate::theme::Theme;
use crate::ticks::Steps;

/// One panel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ResidualPanel {
    /// Horizontal axis, with its unit.
    pub x_title: String,
    /// Vertical axis, with its unit.
    pub y_title: String,
    /// Whether the vertical axis is logarithmic.
    pub logarithmic: bool,
    /// Whether points are joined.
    pub joined: bool,
    /// Every model with its points.
    pub curves: Vec<(Origin, Curve)>,
    /// Values between which chance leaves the points.
    pub band: Option<[f64; 2]>,
}

/// What [`residual_panels`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ResidualPanels {
    /// Title above the figure.
    pub title: Option<String>,
    /// The panels, in reading order.
    pub panels: Vec<ResidualPanel>,
}

/// Draws all panels in two columns, in one where the figure is narrow.
pub fn residual_panels(data: &ResidualPanels, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let origins = distinct(data.panels.iter().flat_map(|panel| &panel.curves).map(|(origin, _)| origin));
    let entry =
        |origin: &&Origin| Entry::new(Sample::Line(Stroke::solid(origin.look().colour, theme.line)), origin.label());
    sheet.legend(&origins.iter().map(entry).collect::<Vec<_>>());
    // Two columns side by side have vertical axes of their own.
    let width = if theme.is_narrow() { 1 } else { 2 };
    for row in data.panels.chunks(width) {
        let half = (theme.width - Sheet::gap(theme)) / width as f64;
        let top = sheet.height();
        let mut lowest = top;
        for (column, panel) in row.iter().enumerate() {
            sheet.rewind(top);
            let side = |title: &str, axis: Axis| Side::new(axis, title);
            let grid = Grid::stack(
                side(&panel.x_title, x_axis(panel)),
                vec![(side(&panel.y_title, y_axis(panel)), theme.tall(0.17))],
            );
            let drawn = sheet.grid_within(grid, (column as f64 * half, half));
            lowest = f64::max(lowest, sheet.height());
            for place in &drawn {
                draw(place, panel, &mut sheet, theme);
            }
        }
        sheet.rewind(lowest);
    }
    sheet.finish()
}

fn x_axis(panel: &ResidualPanel) -> Axis {
    Axis::covering(panel.curves.iter().flat_map(|(_, curve)| curve.finite().map(|(x, _)| x)), 0.02, Steps::Decimal)
}

fn y_axis(panel: &ResidualPanel) -> Axis {
    let values: Vec<f64> = panel
        .curves
        .iter()
        .flat_map(|(_, curve)| curve.finite().map(|(_, y)| y))
        .chain(panel.band.into_iter().flatten())
        .collect();
    if panel.logarithmic {
        Axis::log_covering(values.into_iter().filter(|y| *y > 0.0).collect::<Vec<_>>())
    } else {
        Axis::covering(values, PAD, Steps::Decimal)
    }
}

fn draw(place: &crate::panel::Panel, panel: &ResidualPanel, sheet: &mut Sheet, theme: &Theme) {
    if !panel.logarithmic {
        zero_line(place, &mut sheet.scene, theme);
    }
    for edge in panel.band.into_iter().flatten() {
        let stroke = Stroke::solid(INK, theme.thin).dashed(crate::palette::DASHED);
        place.horizontal(&mut sheet.scene, Layer::Grid, edge, stroke);
    }
    for (origin, curve) in &panel.curves {
        let colour = origin.look().colour;
        if panel.joined {
            place.line(&mut sheet.scene, curve.pairs(), Stroke::solid(colour, 0.9 * theme.line));
        } else {
            place.dots(&mut sheet.scene, curve.finite(), 0.75 * theme.dot, colour);
        }
    }
}
