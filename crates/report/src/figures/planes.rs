//! Yaw rate against heading, and steady yaw rate against rudder: what they hold, and the [`Panels`] they make.

use serde::{Deserialize, Serialize};

use super::panels::{Drawn, Layer, Layers, Panels, Pen, Ruler, Stack, panels};
use crate::axis;
use crate::curve::Curve;
use crate::figure::Figure;
use crate::palette::{HEADING, Origin, PAPER, RECORD, SHORT_DASH};
use crate::theme::Theme;

/// One panel with lines through zero.
fn plane(title: Option<&String>, x: Ruler, height: f64, layers: Vec<Layer>) -> Panels {
    let panel = Layers { y: Ruler::yaw_rate(), height, zero: true, layers, ..Layers::default() };
    let stack = Stack { x, zero: true, panels: vec![panel], ..Stack::default() };
    let cut = Some(String::from("Some drawn ships are cut at the frame."));
    Panels { title: title.cloned(), stacks: vec![stack], cut, ..Panels::default() }
}

/// Ships that were drawn at random, pale because there are many; cut where they leave the range of everything else by
/// more than a share of it.
fn drawn_ships(ships: &[Curve], room: f64) -> impl Iterator<Item = Layer> + '_ {
    let pen = Pen { width: 0.6, opacity: 0.35, ..Pen::new(HEADING) };
    ships.iter().map(move |ship| Layer::new("drawn ships", ship.clone(), Drawn::Line(pen)).within(room))
}

/// The way of one model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PhaseCurve {
    /// Whose way; decides how the line looks.
    pub origin: Origin,
    /// Name in the legend; that of the origin where there is none.
    pub name: Option<String>,
    /// Yaw rate, degrees a second, over heading, degrees, in the order of time.
    pub curve: Curve,
}

/// What [`phase_plane`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PhasePlane {
    /// Title above the figure.
    pub title: Option<String>,
    /// The record: yaw rate, degrees a second, over heading, degrees; may be empty.
    pub record: Curve,
    /// Whether its yaw rate is the slope of its smoothed heading, because none was recorded.
    pub smoothed: bool,
    /// The models.
    pub fits: Vec<PhaseCurve>,
    /// Ships drawn at random, pale.
    pub drawn: Vec<Curve>,
}

/// Draws all ways in one panel.
pub fn phase_plane(data: &PhasePlane, theme: &Theme) -> Figure {
    let name = if data.smoothed { "record, slope of its smoothed heading" } else { "record" };
    let mut layers: Vec<Layer> = drawn_ships(&data.drawn, 0.25).collect();
    layers.push(Layer::new(name, data.record.clone(), Drawn::Record));
    layers.extend(data.fits.iter().map(|fit| {
        let name = fit.name.as_deref().unwrap_or_else(|| fit.origin.label());
        Layer::new(name, fit.curve.clone(), Drawn::Line(Pen::of(&fit.origin)))
    }));
    panels(&plane(data.title.as_ref(), Ruler::heading(), 0.5, layers), theme)
}

/// What [`steady_curves`] draws: the steady turns of a ship as in the diagram of a spiral test, with the branch on which
/// a ship that is unstable on a straight course cannot stay, and the ships that may be meant just as well.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SteadyCurves {
    /// Title above the figure.
    pub title: Option<String>,
    /// Steady yaw rate of the most probable ship, degrees a second over degrees of rudder, in the order of the rate.
    pub most_probable: Curve,
    /// The part of it that is unstable, drawn dashed; may be empty.
    pub unstable: Curve,
    /// The same of drawn ships, unstable parts included.
    pub drawn: Vec<Curve>,
    /// Largest rudder angle in the records, degrees.
    pub seen_rudder_deg: Option<f64>,
    /// Largest yaw rate in the records, degrees a second.
    pub seen_rate_deg_s: Option<f64>,
}

/// Draws the curves in one panel, over the field in which there are records where both its sides are known.
pub fn steady_curves(data: &SteadyCurves, theme: &Theme) -> Figure {
    let largest = |own: Option<f64>| own.map(f64::abs).filter(|own| own.is_finite() && *own > 0.0);
    let seen = largest(data.seen_rudder_deg).zip(largest(data.seen_rate_deg_s));
    let mut layers: Vec<Layer> = Vec::new();
    layers.extend(seen.map(|(rudder, rate)| {
        let edge = |side: f64| Curve::new([-rudder, rudder], [side * rate; 2]);
        Layer::new("seen in the records", edge(-1.0), Drawn::Band(edge(1.0), RECORD, 0.2))
    }));
    layers.extend(drawn_ships(&data.drawn, 0.4));
    let own = Pen { width: 1.3, ..Pen::new(HEADING) };
    // A white edge keeps the curve apart from the drawn ones, and its dashes from each other.
    for curve in [&data.most_probable, &data.unstable] {
        layers.push(Layer::new("", curve.clone(), Drawn::Line(Pen { width: 2.4, ..Pen::new(PAPER) })));
    }
    let (x, y): (Vec<f64>, Vec<f64>) = stable(data).into_iter().unzip();
    layers.push(Layer::new("most probable ship", Curve { x, y }, Drawn::Line(own)));
    if data.unstable.finite().nth(1).is_some() {
        let dashed = Pen { dash: SHORT_DASH, ..own };
        layers.push(Layer::new("unstable branch", data.unstable.clone(), Drawn::Line(dashed)));
    }
    let note = seen.map(|_| String::from("Outside the grey field the curves are extrapolated."));
    panels(&Panels { note, ..plane(data.title.as_ref(), Ruler::rudder(), 0.42, layers) }, theme)
}

/// The curve of the most probable ship with gaps where it is unstable, so that the dashes there can be seen. The rate
/// tells where: a curve has one rudder angle for every rate.
fn stable(data: &SteadyCurves) -> Vec<(f64, f64)> {
    let pairs: Vec<(f64, f64)> = data.unstable.pairs().collect();
    let runs = pairs.split(|(rudder, rate)| !(rudder.is_finite() && rate.is_finite()));
    let spans: Vec<(f64, f64)> = runs.filter_map(|run| axis::range(run.iter().map(|(_, rate)| *rate))).collect();
    let gap = |rate: f64| spans.iter().any(|(lo, hi)| *lo < rate && rate < *hi);
    data.most_probable.pairs().map(|(rudder, rate)| (if gap(rate) { f64::NAN } else { rudder }, rate)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solid_line_is_broken_between_the_ends_of_every_unstable_part() {
        let rates: Vec<f64> = (-4..=4).map(f64::from).collect();
        let data = SteadyCurves {
            most_probable: Curve::new(vec![1.0; 9], rates),
            unstable: Curve::new([1.0, 1.0, 1.0, f64::NAN, 1.0, 1.0], [-3.0, -2.0, -1.0, 0.0, 1.0, 3.0]),
            ..SteadyCurves::default()
        };
        let kept: Vec<f64> = stable(&data).iter().filter(|pair| pair.0.is_finite()).map(|pair| pair.1).collect();
        assert_eq!(kept, [-4.0, -3.0, -1.0, 0.0, 1.0, 3.0, 4.0]);
    }
}
