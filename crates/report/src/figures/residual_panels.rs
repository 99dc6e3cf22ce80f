//! What two models leave of a record, seen from several sides: against time, heading, yaw rate and rudder, as spectrum
//! and as autocorrelation. One panel per side; before and after lie on top of each other.

use serde::{Deserialize, Serialize};

use super::shared::{PAD, distinct, widened, zero_line};
use crate::axis::{self, Axis};
use crate::colour::Colour;
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::palette::{DOTTED, INK, Origin};
use crate::panel::Panel;
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
    /// Whether points are joined. Where they are not, single points far from all others are marked at the edge.
    pub joined: bool,
    /// Whether the horizontal axis is logarithmic.
    pub of_frequency: bool,
    /// Place on the horizontal axis of what repeats: the period of the manoeuvre, or its frequency.
    pub mark: Option<f64>,
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
    let mut entries: Vec<Entry> = origins.iter().map(entry).collect();
    if data.panels.iter().any(|panel| panel.mark.is_some()) {
        entries.push(Entry::new(Sample::Line(mark_stroke(theme)), "period of the manoeuvre"));
    }
    sheet.legend(&entries);
    let mut beyond = 0;
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
                beyond = usize::max(beyond, draw(place, panel, &mut sheet, theme));
            }
        }
        sheet.rewind(lowest);
    }
    if beyond > 0 {
        let points = if beyond == 1 { "1 point lies".to_owned() } else { format!("{beyond} points lie") };
        sheet.note(&format!("{points} beyond a panel, where an arrow is at its edge."));
    }
    sheet.finish()
}

fn mark_stroke(theme: &Theme) -> Stroke {
    Stroke::solid(INK, theme.thin).dashed(DOTTED)
}

fn x_axis(panel: &ResidualPanel) -> Axis {
    let values = panel.curves.iter().flat_map(|(_, curve)| curve.finite().map(|(x, _)| x));
    if panel.of_frequency {
        Axis::log_covering(values.filter(|x| *x > 0.0).collect::<Vec<_>>())
    } else {
        Axis::covering(values, 0.02, Steps::Decimal)
    }
}

/// Share of the points on either side that may be far from all others.
const FAR: f64 = 0.005;

/// Times the range of the other points that an axis reaches beyond them for these.
const REACH: f64 = 0.5;

/// The range of values without those that are few and far from all others.
fn robust(mut values: Vec<f64>) -> Option<(f64, f64)> {
    values.sort_by(f64::total_cmp);
    let skipped = (FAR * values.len() as f64).ceil() as usize;
    let inner = values.get(skipped..values.len().saturating_sub(skipped)).filter(|inner| inner.len() > 10);
    let (lo, hi) = axis::range(inner.unwrap_or(&values).iter().copied())?;
    Some(widened((lo, hi), values.into_iter(), REACH * (hi - lo)).0)
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
    } else if let Some((lo, hi)) = robust(values.clone()).filter(|_| !panel.joined) {
        Axis::covering([lo, hi], PAD, Steps::Decimal)
    } else {
        Axis::covering(values, PAD, Steps::Decimal)
    }
}

/// Draws a panel and returns how many points lie beyond it.
fn draw(place: &Panel, panel: &ResidualPanel, sheet: &mut Sheet, theme: &Theme) -> usize {
    if !panel.logarithmic {
        zero_line(place, &mut sheet.scene, theme);
    }
    if let Some(mark) = panel.mark {
        place.vertical(&mut sheet.scene, Layer::Grid, mark, mark_stroke(theme));
    }
    let mut beyond = 0;
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
            beyond += edges(place, curve, sheet, 1.2 * theme.marker, origin.look().colour);
        }
    }
    beyond
}

/// Marks points above and below a panel by small arrows at its edge, and counts them.
fn edges(place: &Panel, curve: &Curve, sheet: &mut Sheet, size: f64, colour: Colour) -> usize {
    let (top, bottom) = (place.rect.y, place.rect.bottom());
    let mut count = 0;
    for (x, y) in curve.finite().filter_map(|pair| place.place(pair)) {
        let (tip, back) = match y {
            y if y < top => (top, top + size),
            y if y > bottom => (bottom, bottom - size),
            _ => continue,
        };
        let x = x.clamp(place.rect.x, place.rect.right());
        sheet.scene.fill(Layer::Data, [(x, tip), (x - 0.5 * size, back), (x + 0.5 * size, back)], colour, 1.0);
        count += 1;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_wild_point_does_not_squeeze_a_panel() {
        let x: Vec<f64> = (0..400).map(f64::from).collect();
        let mut y: Vec<f64> = x.iter().map(|x| x.sin()).collect();
        let of = |y: &[f64]| ResidualPanels {
            panels: vec![ResidualPanel {
                x_title: "time [s]".into(),
                y_title: "residual [°]".into(),
                logarithmic: false,
                joined: false,
                of_frequency: false,
                mark: None,
                curves: vec![(Origin::Before, Curve::new(x.clone(), y.to_vec()))],
                band: None,
            }],
            ..ResidualPanels::default()
        };
        assert!(!residual_panels(&of(&y), &Theme::screen()).svg().contains("beyond a panel"));
        y[200] = 500.0;
        let drawn = of(&y);
        assert!(
            y_axis(&drawn.panels[0]).fraction(2.5).is_some_and(|place| place > 1.0),
            "the axis is that of the rest"
        );
        assert!(residual_panels(&drawn, &Theme::screen()).svg().contains("1 point lies beyond a panel"));
    }
}
