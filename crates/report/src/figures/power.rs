//! How often something is found over how large it is, or how likely it was called: measured shares with their intervals
//! beside curves of theory.

use serde::{Deserialize, Serialize};

use crate::axis::Axis;
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::palette::{DASH_DOT, DASHED, DOTTED, INK, Look, Marker, Origin, SOLID};
use crate::scene::{Layer, Stroke};
use crate::theme::Theme;
use crate::ticks::Steps;

/// Shares of one kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PowerSeries {
    /// Name in the legend.
    pub name: String,
    /// Size, share in per cent, and its 95 % interval.
    pub points: Vec<(f64, f64, Option<[f64; 2]>)>,
}

/// What [`power`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Power {
    /// Title above the figure.
    pub title: Option<String>,
    /// Horizontal axis.
    pub x_title: String,
    /// Whether it is a share in per cent; otherwise it is logarithmic.
    pub of_shares: bool,
    /// Vertical axis, per cent.
    pub y_title: String,
    /// Measured shares.
    pub series: Vec<PowerSeries>,
    /// Theory: name and curve.
    pub theory: Vec<(String, Curve)>,
}

const DASHES: [crate::palette::Dash; 4] = [SOLID, DASHED, DOTTED, DASH_DOT];
const MARKERS: [Marker; 3] = [Marker::Circle, Marker::Square, Marker::Up];

/// Draws shares and curves.
pub fn power(data: &Power, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let stroke = |number: usize| Stroke::solid(INK, 0.9 * theme.line).dashed(DASHES[number % DASHES.len()]);
    let colours = [Origin::After, Origin::Before, Origin::Published].map(|origin| origin.look().colour);
    let look = |number: usize| Look {
        colour: colours[number % colours.len()],
        marker: MARKERS[number % MARKERS.len()],
        dash: SOLID,
        hollow: false,
    };
    let measured = data
        .series
        .iter()
        .enumerate()
        .map(|(number, series)| Entry::new(Sample::Marker(look(number)), series.name.clone()));
    let theory = data
        .theory
        .iter()
        .enumerate()
        .map(|(number, (name, _))| Entry::new(Sample::Line(stroke(number)), name.clone()));
    sheet.legend(&measured.chain(theory).collect::<Vec<_>>());
    let sizes = data.series.iter().flat_map(|series| series.points.iter().map(|point| point.0));
    let drawn = data.theory.iter().flat_map(|(_, curve)| curve.finite().map(|(x, _)| x));
    let shares = Axis::linear(-3.0, 103.0, Steps::Decimal);
    let x = match data.of_shares {
        true => shares.clone(),
        false => Axis::log_covering(sizes.chain(drawn).filter(|x| *x > 0.0).collect::<Vec<_>>()),
    };
    let y = shares;
    let grid =
        Grid::stack(Side::new(x, data.x_title.clone()), vec![(Side::new(y, data.y_title.clone()), theme.tall(0.42))]);
    for panel in &sheet.grid(grid) {
        for (number, (_, curve)) in data.theory.iter().enumerate() {
            panel.line(&mut sheet.scene, curve.pairs(), stroke(number));
        }
        for (number, series) in data.series.iter().enumerate() {
            for (x, y, interval) in &series.points {
                if let (Some([low, high]), Some(x)) = (interval, panel.across(*x))
                    && let (Some(low), Some(high)) = (panel.up(*low), panel.up(*high))
                {
                    let bar = Stroke::solid(look(number).colour, 0.8 * theme.line);
                    sheet.scene.line(Layer::Data, [(x, low), (x, high)], bar);
                }
                panel.marker(&mut sheet.scene, (*x, *y), theme.marker, &look(number));
            }
        }
    }
    sheet.finish()
}
