//! A measured record with the fits to it: heading, residual, rudder. For the record itself with its characteristic
//! quantities see [`zigzag_trial`](super::zigzag_trial()).

use serde::{Deserialize, Serialize};

use super::shared::{
    OPACITY, angle_side, area, heading_title, record, record_entry, rudder_title, time_side, zero_line,
};
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet};
use crate::legend::{Entry, Sample, stroke_of};
use crate::number;
use crate::palette::{Origin, RUDDER};
use crate::scene::Stroke;
use crate::theme::Theme;

/// One fit to the record.
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
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let mut entries = vec![record_entry("recorded heading", theme, &data.heading)];
    entries.extend(data.fits.iter().map(|fit| {
        let rms = fit.rms_deg.map_or_else(String::new, |rms| format!(", rms {}°", number::significant(rms, 2)));
        Entry { label: format!("{}{rms}", fit.origin.label()), ..Entry::line_of(&fit.origin, theme) }
    }));
    let bands = || data.fits.iter().filter_map(|fit| Some((fit.origin.look().colour, fit.band.as_ref()?)));
    entries.extend(bands().map(|(colour, _)| {
        let stroke = Stroke { opacity: OPACITY, ..Stroke::solid(colour, 0.8 * theme.small_font) };
        Entry::new(Sample::Line(stroke), "95 % band")
    }));
    entries.push(Entry::new(Sample::Line(Stroke::solid(RUDDER, theme.line)), "recorded rudder"));
    sheet.legend(&entries);
    // A band that is wider than everything else is cut at the frame: it would flatten the record.
    let headings = || data.fits.iter().map(|f| &f.heading).chain([&data.heading]);
    let residuals = || data.fits.iter().map(|f| &f.residual);
    let rows = vec![
        (angle_side(headings(), heading_title()), theme.tall(0.28)),
        (angle_side(residuals(), "residual [°]".into()), theme.tall(0.14)),
        (angle_side([&data.rudder], rudder_title()), theme.tall(0.12)),
    ];
    let panels = sheet.grid(Grid::stack(time_side(headings().chain(residuals()).chain([&data.rudder])), rows));
    let [upper, middle, lower] = &panels[..] else { return sheet.finish() };

    for (colour, band) in bands() {
        area(upper, &mut sheet.scene, band.heading.each_ref(), colour);
        area(middle, &mut sheet.scene, band.residual.each_ref(), colour);
    }
    record(upper, &mut sheet.scene, theme, &data.heading, 1.5 * theme.dot);
    zero_line(middle, &mut sheet.scene, theme);
    for fit in &data.fits {
        let stroke = stroke_of(&fit.origin, theme);
        upper.line(&mut sheet.scene, fit.heading.pairs(), stroke);
        // Solid, because dashes would hide parts of a noisy residual.
        middle.line(&mut sheet.scene, fit.residual.pairs(), Stroke::solid(stroke.colour, 0.8 * stroke.width));
    }
    zero_line(lower, &mut sheet.scene, theme);
    lower.line(&mut sheet.scene, data.rudder.pairs(), Stroke::solid(RUDDER, theme.line));
    sheet.finish()
}
