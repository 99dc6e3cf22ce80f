//! Distributions of a signed error, one violin a method: density, box of the quartiles, whiskers from 2.5 to 97.5 %,
//! median.

use serde::{Deserialize, Serialize};

use super::shared::{median, zero_upright};
use crate::axis::Axis;
use crate::figure::Figure;
use crate::layout::{Sheet, Side};
use crate::palette::{INK, Origin, PAPER};
use crate::panel::Panel;
use crate::scene::{Layer, Scene, Stroke};
use crate::theme::Theme;
use crate::ticks::Steps;

/// One method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Violin {
    /// Whose errors.
    pub origin: Origin,
    /// Error and density, ascending; empty where there is none.
    pub density: Vec<(f64, f64)>,
    /// Quantiles 2.5, 25, 50, 75 and 97.5 %; `None` where there is no error.
    pub quantiles: Option<[f64; 5]>,
}

/// One panel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ViolinPanel {
    /// Title with unit.
    pub x_title: String,
    /// The violins, from the top.
    pub violins: Vec<Violin>,
}

/// What [`violins`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Violins {
    /// Title above the figure.
    pub title: Option<String>,
    /// The panels, side by side.
    pub panels: Vec<ViolinPanel>,
}

/// Half the height of a violin, as a share of its row.
const HALF: f64 = 0.42;

/// Draws the panels side by side, or above each other when the figure is narrow.
///
/// The axis holds the whiskers of the methods of usual spread; one that reaches beyond is cut and marked.
pub fn violins(data: &Violins, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let names: Vec<String> = data
        .panels
        .first()
        .map(|panel| panel.violins.iter().map(|violin| violin.origin.label().to_owned()).collect())
        .unwrap_or_default();
    let height = (names.len().max(1) as f64 + 0.2) * 2.6 * theme.tick_font;
    let columns = data.panels.iter().map(|panel| Side::new(axis(panel), panel.x_title.clone()));
    let panels = sheet.side_by_side(columns, (Side::new(Axis::names(names), ""), height));
    let mut beyond = false;
    for (panel, content) in panels.iter().zip(&data.panels) {
        zero_upright(panel, &mut sheet.scene, theme);
        for (row, violin) in content.violins.iter().enumerate() {
            beyond |= draw(panel, &mut sheet.scene, theme, row, violin);
        }
    }
    let arrows = if beyond { " Arrows: beyond the axis." } else { "" };
    sheet.note(&format!("Box: quartiles and median. Line: 2.5 to 97.5 %.{arrows}"));
    sheet.finish()
}

/// Whiskers further out than this many times the middle one are cut.
const SPREADS: f64 = 4.0;

fn axis(panel: &ViolinPanel) -> Axis {
    let quantiles = || panel.violins.iter().filter_map(|violin| violin.quantiles);
    let limit = SPREADS * median(quantiles().map(|q| q[0].abs().max(q[4].abs()))).unwrap_or(1.0);
    let ends = quantiles().flat_map(|q| [q[0], q[4]]).map(|end| end.clamp(-limit, limit));
    Axis::covering(ends.chain([0.0]), 0.06, Steps::Decimal)
}

/// Draws one violin; tells whether it reaches beyond the axis.
fn draw(panel: &Panel, scene: &mut Scene, theme: &Theme, row: usize, violin: &Violin) -> bool {
    let (Some(q), Some(y)) = (violin.quantiles, panel.up(row as f64)) else { return false };
    let look = violin.origin.look();
    let rect = panel.rect;
    let Some(places) = q.iter().map(|value| panel.across(*value)).collect::<Option<Vec<f64>>>() else { return false };
    let inside = |x: f64| x.clamp(rect.x, rect.right());
    let row_height = rect.h / (panel.y.fraction(0.0).zip(panel.y.fraction(1.0)).map_or(1.0, |(a, b)| 1.0 / (a - b)));
    let highest = violin.density.iter().map(|(_, height)| *height).fold(0.0, f64::max);
    if highest > 0.0 {
        let edge = |side: f64| {
            violin.density.iter().filter_map(move |&(value, height)| {
                let x = panel.across(value)?;
                (x >= rect.x && x <= rect.right()).then_some((x, y + side * HALF * row_height * height / highest))
            })
        };
        let mut outline: Vec<(f64, f64)> = edge(-1.0).collect();
        let lower: Vec<(f64, f64)> = edge(1.0).collect();
        outline.extend(lower.into_iter().rev());
        scene.fill(Layer::Data, outline, look.colour, 0.28);
    }
    let beyond = panel.bar(scene, y, [q[0], q[4]], Stroke::solid(look.colour, theme.line), 0.6 * theme.small_font);
    let (left, right) = (inside(places[1]), inside(places[3]));
    let half = 0.13 * row_height;
    scene.fill(
        Layer::Data,
        [(left, y - half), (right, y - half), (right, y + half), (left, y + half)],
        look.colour,
        0.85,
    );
    if rect.contains((places[2], y)) {
        scene.disc(Layer::Data, (places[2], y), 0.55 * theme.marker + 0.4 * theme.thin, INK, 1.0);
        scene.disc(Layer::Data, (places[2], y), 0.55 * theme.marker, PAPER, 1.0);
    }
    beyond
}
