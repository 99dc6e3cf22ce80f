//! Empirical distributions of the size of an error: which share of all trials is within how much, per method. A method
//! that fails levels off below one.

use serde::{Deserialize, Serialize};

use super::shared::distinct;
use crate::axis::Axis;
use crate::figure::Figure;
use crate::layout::{Sheet, Side};
use crate::legend::{Entry, stroke_of};
use crate::palette::{INK, Origin};
use crate::panel::Panel;
use crate::scene::{Layer, Stroke};
use crate::theme::Theme;
use crate::ticks::Steps;

/// Steps of one method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EcdfCurve {
    /// Whose errors; decides how the line looks.
    pub origin: Origin,
    /// Size of the error and share of trials within it, both ascending.
    pub points: Vec<(f64, f64)>,
}

/// One panel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EcdfPanel {
    /// Title of its horizontal axis, such as "size of the error of K [%]".
    pub x_title: String,
    /// The lines.
    pub curves: Vec<EcdfCurve>,
}

/// What [`ecdf`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Ecdf {
    /// Title above the figure.
    pub title: Option<String>,
    /// The panels, side by side.
    pub panels: Vec<EcdfPanel>,
}

/// Decades shown below the largest error.
const DECADES: f64 = 5.0;

/// Draws the panels side by side, or above each other when the figure is narrow.
pub fn ecdf(data: &Ecdf, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let origins = distinct(data.panels.iter().flat_map(|panel| &panel.curves).map(|curve| &curve.origin));
    sheet.legend(&origins.iter().map(|origin| Entry::line_of(origin, theme)).collect::<Vec<_>>());
    let columns = data.panels.iter().map(|panel| Side::new(axis(panel), panel.x_title.clone()));
    let row = (Side::new(Axis::linear(0.0, 1.02, Steps::Decimal), "share of trials"), theme.tall(0.36));
    let panels = sheet.side_by_side(columns, row);
    for (panel, content) in panels.iter().zip(&data.panels) {
        for share in [0.5, 0.95] {
            let stroke = Stroke { opacity: 0.45, ..Stroke::solid(INK, theme.thin) };
            panel.horizontal(&mut sheet.scene, Layer::Grid, share, stroke);
        }
        for curve in &content.curves {
            panel.line(&mut sheet.scene, steps(panel, &curve.points), stroke_of(&curve.origin, theme));
        }
    }
    sheet.finish()
}

fn axis(panel: &EcdfPanel) -> Axis {
    let sizes = || panel.curves.iter().flat_map(|curve| &curve.points).map(|point| point.0);
    // The last step of each curve may be a single wild answer: the axis ends where 99.5 % of the best method and the
    // bulk of the others are.
    let bulk = |curve: &EcdfCurve| {
        let last = curve.points.last().map_or(0.0, |point| point.1);
        curve.points.iter().find(|point| point.1 >= 0.98 * last).map(|point| point.0)
    };
    let high = panel.curves.iter().filter_map(bulk).fold(0.0, f64::max);
    let low = sizes().filter(|size| *size > 0.0).fold(f64::INFINITY, f64::min).max(high * 10f64.powf(-DECADES));
    Axis::log_covering([low, high].into_iter().filter(|value| value.is_finite()))
}

/// Corners of the steps; what lies left of the axis comes in at its left end.
fn steps(panel: &Panel, points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let inside = |x: f64| panel.across(x).is_some_and(|place| place >= panel.rect.x);
    let mut corners = Vec::with_capacity(2 * points.len() + 1);
    let mut before = 0.0;
    for &(x, share) in points {
        if inside(x) {
            corners.push((x, before));
            corners.push((x, share));
        }
        before = share;
    }
    if let Some(&(first, share)) = corners.first() {
        // From the frame to the first step, far enough to the left to be cut there.
        corners.insert(0, (first * 1e-9, share));
    }
    if let Some(&(last, share)) = corners.last() {
        corners.push((last * 1e9, share));
    }
    corners
}
