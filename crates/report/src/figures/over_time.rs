//! Records, fits, bands and derivatives over time: what they hold, and the [`Panels`] they make.

use serde::{Deserialize, Serialize};

use super::panels::{Drawn, Layer, Layers, Panels, Pen, Ruler, Stack, panels};
use super::shared::OPACITY;
use crate::curve::Curve;
use crate::figure::Figure;
use crate::markup::symbol;
use crate::number;
use crate::palette::{HEADING, INK, Origin, RECORD, RUDDER};
use crate::theme::Theme;

/// Panels above each other over time.
fn over_time(title: Option<&String>, rows: Vec<Layers>) -> Panels {
    let stack = Stack { x: Ruler::time(), panels: rows, ..Stack::default() };
    Panels { title: title.cloned(), stacks: vec![stack], ..Panels::default() }
}

/// A panel of the residual of a heading.
fn residual(layers: Vec<Layer>) -> Layers {
    Layers {
        y: Ruler::new("residual [°]", super::panels::Division::Angle),
        height: 0.14,
        zero: true,
        layers,
        ..Layers::default()
    }
}

/// The panel of a rudder.
fn rudder(name: &str, curve: &Curve) -> Layers {
    let layers = vec![Layer::new(name, curve.clone(), Drawn::Line(Pen::new(RUDDER)))];
    Layers { y: Ruler::rudder(), height: 0.13, zero: true, layers, ..Layers::default() }
}

/// One fit to a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Who fitted; decides how the fit looks.
    pub origin: Origin,
    /// Heading of the fit, degrees over seconds.
    pub heading: Curve,
    /// Recorded minus fitted heading, degrees over seconds.
    pub residual: Curve,
    /// Root mean square of the residual, degrees.
    pub rms_deg: Option<f64>,
    /// The 95 % band of a record of this fit, drawn as a light area.
    pub band: Option<FitBand>,
}

/// The lower and upper ends of a band.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FitBand {
    /// About the heading, degrees over seconds.
    pub heading: [Curve; 2],
    /// About no residual.
    pub residual: [Curve; 2],
}

/// What [`record_fit`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RecordFit {
    /// Title above the figure.
    pub title: Option<String>,
    /// Recorded heading, degrees over seconds.
    pub heading: Curve,
    /// Recorded rudder angle, degrees over seconds.
    pub rudder: Curve,
    /// The fits, drawn in this order.
    pub fits: Vec<Fit>,
}

/// Draws heading with fits, residuals and rudder over one time axis.
pub fn record_fit(data: &RecordFit, theme: &Theme) -> Figure {
    let mut upper = vec![Layer::new("recorded heading", data.heading.clone(), Drawn::Record)];
    let mut middle = Vec::new();
    for fit in &data.fits {
        let pen = Pen::of(&fit.origin);
        let rms = fit.rms_deg.map_or_else(String::new, |rms| format!(", rms {}°", number::significant(rms, 2)));
        upper.push(Layer::new(format!("{}{rms}", fit.origin.label()), fit.heading.clone(), Drawn::Line(pen)));
        // Solid, because dashes would hide parts of a noisy residual.
        let solid = Pen { width: 0.8, ..Pen::new(pen.colour) };
        middle.push(Layer::new("", fit.residual.clone(), Drawn::Line(solid)));
    }
    // A band that is wider than everything else is cut at the frame: it would flatten the record.
    let band = |name: &str, [lower, upper]: &[Curve; 2], colour| {
        Layer::new(name, lower.clone(), Drawn::Band(upper.clone(), colour, OPACITY)).within(0.0)
    };
    for (own, colour) in data.fits.iter().filter_map(|fit| Some((fit.band.as_ref()?, fit.origin.look().colour))) {
        upper.push(band("95 % band", &own.heading, colour));
        middle.push(band("", &own.residual, colour));
    }
    let heading = Layers { y: Ruler::heading(), height: 0.28, layers: upper, ..Layers::default() };
    let rows = vec![heading, residual(middle), rudder("recorded rudder", &data.rudder)];
    panels(&over_time(data.title.as_ref(), rows), theme)
}

/// What [`curve_fit`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CurveFit {
    /// Title above the figure.
    pub title: Option<String>,
    /// Measured heading, degrees over seconds.
    pub measured: Curve,
    /// Fitted heading, degrees over seconds, dense enough to look smooth.
    pub fitted: Curve,
    /// Name of the fitted curve, such as "Fourier series, 5 harmonics".
    pub fitted_name: String,
    /// Measured minus fitted heading, degrees over seconds.
    pub residual: Curve,
    /// Coefficient of determination of the heading.
    pub r_squared: Option<f64>,
    /// Fundamental of the series, rad/s.
    pub fundamental_rad_s: Option<f64>,
}

/// Draws measured points and fitted curve above, the residual on its own scale below: how well a Fourier series (or any
/// other curve) carries the record.
pub fn curve_fit(data: &CurveFit, theme: &Theme) -> Figure {
    let name = if data.fitted_name.is_empty() { "fitted curve" } else { &data.fitted_name };
    let upper = vec![
        Layer::new("measured", data.measured.clone(), Drawn::Record),
        Layer::new(name, data.fitted.clone(), Drawn::Line(Pen::new(HEADING))),
    ];
    let lower = vec![
        Layer::new("", data.residual.clone(), Drawn::Line(Pen { width: 0.6, ..Pen::new(RECORD) })),
        Layer::new("", data.residual.clone(), Drawn::Dots(INK)),
    ];
    let heading = Layers { y: Ruler::heading(), height: 0.32, layers: upper, ..Layers::default() };
    let mut said = Vec::new();
    // Five decimals, because the fit of a smooth record differs from 1 in the fourth.
    said.extend(
        data.r_squared.filter(|own| own.is_finite()).map(|own| format!("{} = {}", symbol("R²"), number::fixed(own, 5))),
    );
    said.extend(
        data.fundamental_rad_s
            .filter(|own| own.is_finite())
            .map(|own| format!("fundamental {} = {} rad/s", symbol("ω"), number::significant(own, 4))),
    );
    panels(&Panels { said, ..over_time(data.title.as_ref(), vec![heading, residual(lower)]) }, theme)
}

/// One source of heading, yaw rate and yaw acceleration; an empty curve is not drawn.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MotionCurves {
    /// Where the curves come from; decides how they look.
    pub origin: Origin,
    /// Name in the legend, when it is not that of the origin.
    pub name: Option<String>,
    /// Heading, degrees over seconds.
    pub heading: Curve,
    /// Yaw rate, degrees per second over seconds.
    pub yaw_rate: Curve,
    /// Yaw acceleration, degrees per second squared over seconds.
    pub yaw_acceleration: Curve,
}

/// What [`derivatives`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Derivatives {
    /// Title above the figure.
    pub title: Option<String>,
    /// The sources, drawn in this order.
    pub curves: Vec<MotionCurves>,
}

/// Draws heading, yaw rate and yaw acceleration above each other: what differentiation makes of a small error in the
/// heading.
pub fn derivatives(data: &Derivatives, theme: &Theme) -> Figure {
    let row = |y: Ruler, of: fn(&MotionCurves) -> &Curve| {
        let layer = |own: &MotionCurves| {
            let name = own.name.as_deref().unwrap_or_else(|| own.origin.label());
            Layer::new(name, of(own).clone(), Drawn::Line(Pen::of(&own.origin)))
        };
        Layers { y, height: 0.2, layers: data.curves.iter().map(layer).collect(), ..Layers::default() }
    };
    let acceleration = Ruler::new(format!("yaw accel. {} [°/s²]", symbol("ṙ")), super::panels::Division::Decimal);
    let rows = vec![
        row(Ruler::heading(), |own| &own.heading),
        row(Ruler::yaw_rate(), |own| &own.yaw_rate),
        row(acceleration, |own| &own.yaw_acceleration),
    ];
    panels(&over_time(data.title.as_ref(), rows), theme)
}

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

/// How dense the outer band is, and the inner one, which lies on it.
const BANDS: [f64; 2] = [0.2, 0.38];

/// Draws heading with bands and rudder over one time axis; the outer band as far as there is room.
pub fn prediction_bands(data: &PredictionBands, theme: &Theme) -> Figure {
    let band = |name: &str, [lower, upper]: &[Curve; 2], opacity| {
        Layer::new(name, lower.clone(), Drawn::Band(upper.clone(), HEADING, opacity))
    };
    let mut layers =
        vec![band("90 % of the drawn ships", &data.band90, BANDS[0]).within(1.0), band("50 %", &data.band50, BANDS[1])];
    layers.extend(data.recorded.iter().map(|own| Layer::new("recorded heading", own.clone(), Drawn::Record)));
    let pen = Pen { width: 1.2, ..Pen::new(HEADING) };
    layers.push(Layer::new("most probable ship", data.heading.clone(), Drawn::Line(pen)));
    let heading = Layers { y: Ruler::heading(), height: 0.32, layers, ..Layers::default() };
    let rows = vec![heading, rudder("rudder", &data.rudder)];
    let cut = Some(String::from("The band of 90 % is cut at the frame."));
    panels(&Panels { cut, ..over_time(data.title.as_ref(), rows) }, theme)
}
