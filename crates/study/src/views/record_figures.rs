//! Figures of records shared by `study fit`, `study trace` and `study predict`: a record and its models over time, and
//! the diagram of steady turns.

use document::identified_ship::ValidityRange;
use predict::steady::SteadyCurve;
use report::figures::{AxisSpec, Layer, LayerKind, PanelGroup, PanelRow, Panels, Pen, TickRule};
use report::number::significant;
use report::palette::{BACKGROUND, HEADING, RECORD, RUDDER, SHORT_DASH};
use report::{CurveOrigin, PlotCurve};
use ship::angle::to_deg;

/// Model of a record over time: the heading and its residual in degrees, the root mean square of the residual, and its
/// 95 % band.
pub struct ModelOverTime {
    /// Origin of the model, which sets colour and dash.
    pub origin: CurveOrigin,
    /// Replayed heading.
    pub heading: PlotCurve,
    /// Recorded minus replayed heading.
    pub residual: PlotCurve,
    /// Root mean square of the residual, degrees; `None` if it is not shown.
    pub rms_deg: Option<f64>,
    /// Lower and upper ends of the band about the heading, and about zero residual; `None` without a band.
    pub band: Option<[[PlotCurve; 2]; 2]>,
}

/// Opacity of a band.
const OPACITY: f64 = 0.2;

/// Row and layers of a rudder panel; `height` is a share of the width of the figure.
pub fn rudder(name: &str, curve: PlotCurve, height: f64) -> (PanelRow, Vec<Layer>) {
    (PanelRow::zeroed(AxisSpec::rudder(), height), vec![Layer::line(name, curve, Pen::new(RUDDER))])
}

/// Layers of two panels: the heading of a record with its models, and their residuals.
pub fn heading_and_residual(heading: PlotCurve, models: Vec<ModelOverTime>) -> [Vec<Layer>; 2] {
    let mut upper = vec![Layer::new("recorded heading", heading, LayerKind::Record)];
    let mut middle = Vec::new();
    // A band wider than everything else is cut at the frame: it would flatten the record.
    let mut bands = Vec::new();
    for ModelOverTime { origin, heading, residual, rms_deg, band } in models {
        let (pen, colour) = (Pen::from_origin(&origin), origin.style().colour);
        let rms = rms_deg.map_or_else(String::new, |rms| format!(", rms {}°", significant(rms, 2)));
        upper.push(Layer::line(format!("{}{rms}", origin.label()), heading, pen));
        // Solid, because dashes would hide parts of a noisy residual.
        middle.push(Layer::line("", residual, Pen::new(colour).width(0.8)));
        bands.extend(band.map(|[heading, residual]| {
            [Layer::band("95 % band", heading, colour, OPACITY), Layer::band("", residual, colour, OPACITY)]
        }));
    }
    for [heading, residual] in bands {
        upper.push(heading.widening_at_most(0.0));
        middle.push(residual.widening_at_most(0.0));
    }
    [upper, middle]
}

/// Heading with models, residuals and rudder over one time axis.
pub fn over_time(heading: PlotCurve, rudder_deg: PlotCurve, models: Vec<ModelOverTime>) -> Panels {
    let [upper, middle] = heading_and_residual(heading, models);
    let residual = PanelRow::zeroed(AxisSpec::new("residual [°]", TickRule::Angle), 0.14);
    let rows = vec![
        (PanelRow::new(AxisSpec::heading(), 0.28), upper),
        (residual, middle),
        rudder("recorded rudder", rudder_deg, 0.13),
    ];
    Panels::over_time(rows)
}

/// Maximum number of drawn ships whose steady curves are plotted.
const MAX_CURVES: usize = 40;

/// Sentence on the straight-course stability of the most probable of some ships.
pub fn stability(curves: &[SteadyCurve]) -> String {
    match curves.first().and_then(SteadyCurve::instability) {
        Some(instability) => {
            let width = significant(to_deg(instability.width), 2);
            format!("Unstable on a straight course: a loop {width}° of rudder wide has two steady turns")
        }
        None => String::from("Stable on a straight course: one steady turn for every rudder"),
    }
}

/// Steady turns of some ships, the most probable one first, as in the diagram of a spiral test. The unstable branch is
/// dashed, other possible ships are pale, and the range of the records is shaded.
pub fn steady_turns(curves: &[SteadyCurve], seen: ValidityRange) -> Panels {
    let curve = |ship: &SteadyCurve, keep: &dyn Fn(usize) -> bool| {
        let place = |row: usize| match keep(row) {
            true => (to_deg(ship.rudder[row]), to_deg(ship.yaw_rate[row])),
            false => (f64::NAN, f64::NAN),
        };
        let (x, y): (Vec<f64>, Vec<f64>) = (0..ship.rudder.len()).map(place).unzip();
        PlotCurve::new(x, y)
    };
    let (rudder, rate) = (to_deg(seen.rudder_rad), to_deg(seen.yaw_rate_rad_s));
    let edge = |side: f64| PlotCurve::new([-rudder, rudder], [side * rate; 2]);
    let mut layers = vec![Layer::band("seen in the records", [edge(-1.0), edge(1.0)], RECORD, 0.2)];
    if let Some((first, others_drawn)) = curves.split_first() {
        let drawn = others_drawn.iter().take(MAX_CURVES).map(|ship| curve(ship, &|_| true));
        layers.extend(drawn.map(|ship| Layer::line("drawn ships", ship, Pen::pale()).widening_at_most(0.4)));
        // Rows at which the rudder decreases while the yaw rate grows.
        let falls = |row: usize| row + 1 < first.rudder.len() && first.rudder[row + 1] < first.rudder[row];
        let can_be_unstable = first.instability().is_some();
        let is_inside = |row: usize| can_be_unstable && falls(row) && row > 0 && falls(row - 1);
        let is_unstable = |row: usize| can_be_unstable && (falls(row) || (row > 0 && falls(row - 1)));
        let pen = Pen::new(HEADING).width(1.3);
        // A white edge separates the curve from those of the drawn ships.
        layers.push(Layer::line("", curve(first, &|_| true), Pen::new(BACKGROUND).width(2.4)));
        layers.push(Layer::line("most probable ship", curve(first, &|row| !is_inside(row)), pen));
        if can_be_unstable {
            let dashed = Pen { dash: SHORT_DASH, ..pen };
            layers.push(Layer::line("unstable branch", curve(first, &is_unstable), dashed));
        }
    }
    let note = Some(String::from("Outside the grey field the curves are extrapolated."));
    let clipping_note = Some(String::from("Some drawn ships are cut at the frame."));
    let group = PanelGroup::over(AxisSpec::rudder(), vec![(PanelRow::zeroed(AxisSpec::yaw_rate(), 0.42), layers)]);
    Panels { note, clipping_note, ..Panels::new(PanelGroup { has_zero_line: true, ..group }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_solid_line_is_broken_between_the_ends_of_an_unstable_branch() {
        let rates = (-4..=4).map(f64::from);
        let unstable_ship = SteadyCurve {
            yaw_rate: rates.clone().map(|rate| 0.01 * rate).collect(),
            rudder: rates.map(|rate| 0.02 * (0.25 * rate.powi(3) - rate)).collect(),
        };
        let data = steady_turns(&[unstable_ship], ValidityRange { rudder_rad: 0.2, yaw_rate_rad_s: 0.03 });
        let finite = |name: &str| -> Vec<usize> {
            let layers = &data.groups[0].panels[0].layers;
            let layer = layers.iter().find(|layer| layer.name.as_deref() == Some(name)).expect("it is drawn");
            (0..9).filter(|&row| layer.curve.x[row].is_finite()).collect()
        };
        assert_eq!(finite("most probable ship"), [0, 1, 2, 3, 5, 6, 7, 8]);
        assert_eq!(finite("unstable branch"), [3, 4, 5]);
    }
}
