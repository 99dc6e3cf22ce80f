//! Heading points and the curve fitted through them, with the residual on its own scale below: how well a Fourier
//! series (or any other curve) carries the record.

use serde::{Deserialize, Serialize};

use super::shared::{angle_side, heading_title, time_side, zero_line};
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet};
use crate::legend::{Entry, Sample};
use crate::markup::symbol;
use crate::number;
use crate::palette::{HEADING, INK, RECORD};
use crate::scene::Stroke;
use crate::theme::Theme;

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

/// Draws measured points and fitted curve above, the residual below.
pub fn curve_fit(data: &CurveFit, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
    let rows = vec![
        (angle_side([&data.measured, &data.fitted], heading_title()), theme.tall(0.32)),
        (angle_side([&data.residual], "residual [°]".into()), theme.tall(0.14)),
    ];
    let panels = sheet.grid(Grid::stack(time_side([&data.measured, &data.fitted, &data.residual]), rows));
    let [upper, lower] = &panels[..] else { return sheet.finish() };

    upper.line(&mut sheet.scene, data.fitted.pairs(), Stroke::solid(HEADING, theme.line));
    upper.dots(&mut sheet.scene, data.measured.finite(), 1.25 * theme.dot, INK);
    zero_line(lower, &mut sheet.scene, theme);
    lower.line(&mut sheet.scene, data.residual.pairs(), Stroke::solid(RECORD, theme.thin));
    lower.dots(&mut sheet.scene, data.residual.finite(), theme.dot, INK);
    sheet.finish()
}

fn entries(data: &CurveFit, theme: &Theme) -> Vec<Entry> {
    let name = if data.fitted_name.is_empty() { "fitted curve" } else { &data.fitted_name };
    let mut entries = vec![
        Entry::new(Sample::Dots(INK), "measured"),
        Entry::new(Sample::Line(Stroke::solid(HEADING, theme.line)), name),
    ];
    // Five decimals, because the fit of a smooth record differs from 1 in the fourth.
    if let Some(r_squared) = data.r_squared.filter(|v| v.is_finite()) {
        entries.push(Entry::new(Sample::Nothing, format!("{} = {}", symbol("R²"), number::fixed(r_squared, 5))));
    }
    if let Some(omega) = data.fundamental_rad_s.filter(|v| v.is_finite()) {
        let text = format!("fundamental {} = {} rad/s", symbol("ω"), number::significant(omega, 4));
        entries.push(Entry::new(Sample::Nothing, text));
    }
    entries
}
