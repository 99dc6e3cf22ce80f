//! Yaw rate against heading: the phase plane of a zig-zag, in which a reversal of the rudder is a corner and an
//! overshoot the way from it to the axis.

use serde::{Deserialize, Serialize};

use super::shared::{PAD, drawn_stroke, heading_title, record, record_entry, widened, zero_line, zero_upright};
use crate::axis::{self, Axis};
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample, stroke_of};
use crate::markup::symbol;
use crate::palette::Origin;
use crate::scene::Stroke;
use crate::theme::Theme;
use crate::ticks::Steps;

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

/// Drawn ships may leave the range of everything else by this share of it before they are cut.
const ROOM: f64 = 0.25;

/// Draws all ways in one panel.
pub fn phase_plane(data: &PhasePlane, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
    let (across, beside) = side_axis(data, |pair| pair.0, Steps::Angle);
    let (up, above) = side_axis(data, |pair| pair.1, Steps::Decimal);
    let row = (Side::new(up, format!("yaw rate {} [°/s]", symbol("r"))), theme.tall(0.5));
    for panel in &sheet.grid(Grid::stack(Side::new(across, heading_title()), vec![row])) {
        zero_line(panel, &mut sheet.scene, theme);
        zero_upright(panel, &mut sheet.scene, theme);
        for ship in &data.drawn {
            panel.line(&mut sheet.scene, ship.pairs(), drawn_stroke(theme));
        }
        record(panel, &mut sheet.scene, theme, &data.record, 1.2 * theme.dot);
        for fit in &data.fits {
            panel.line(&mut sheet.scene, fit.curve.pairs(), stroke(fit, theme));
        }
    }
    if beside || above {
        sheet.note("Some drawn ships are cut at the frame.");
    }
    sheet.finish()
}

fn stroke(fit: &PhaseCurve, theme: &Theme) -> Stroke {
    stroke_of(&fit.origin, theme)
}

fn entries(data: &PhasePlane, theme: &Theme) -> Vec<Entry> {
    let mut entries = Vec::new();
    if data.record.finite().next().is_some() {
        let name = if data.smoothed { "record, slope of its smoothed heading" } else { "record" };
        entries.push(record_entry(name, theme, &data.record));
    }
    entries.extend(data.fits.iter().map(|fit| {
        let name = fit.name.as_deref().unwrap_or_else(|| fit.origin.label());
        Entry::new(Sample::Line(stroke(fit, theme)), name)
    }));
    if !data.drawn.is_empty() {
        entries.push(Entry::new(Sample::Line(drawn_stroke(theme)), "drawn ships"));
    }
    entries
}

/// The axis along which `part` of a pair lies, and whether drawn ships leave it.
fn side_axis(data: &PhasePlane, part: fn((f64, f64)) -> f64, steps: Steps) -> (Axis, bool) {
    let own = [&data.record].into_iter().chain(data.fits.iter().map(|fit| &fit.curve));
    let core = axis::range(own.flat_map(Curve::finite).map(part));
    let drawn = || data.drawn.iter().flat_map(Curve::finite).map(part);
    let (ends, cut) = match core {
        Some((lo, hi)) if hi > lo => widened((lo, hi), drawn(), ROOM * (hi - lo)),
        core => (axis::range(drawn()).or(core).unwrap_or((f64::NAN, f64::NAN)), false),
    };
    (Axis::covering([ends.0, ends.1], 0.5 * PAD, steps), cut)
}
