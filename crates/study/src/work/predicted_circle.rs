//! Turning circle predicted from the recommended estimate of a fit: characteristics and median track of drawn ships.

use document::fit::{FitDocument, KtUsability, MedianEntry, PredictedCircleEntry};
use predict::{Prediction, ShipMixture};
use ship::angle::from_deg;
use trial::{Manoeuvre, Side};

/// Number of drawn ships.
const DRAWS: usize = 300;

/// Rudder of the turning circle of IMO MSC.137(76), deg.
const RUDDER_DEG: f64 = 35.0;

/// Predicted turning circle.
pub struct PredictedCircle {
    /// Characteristics of the circle.
    pub entry: PredictedCircleEntry,
    /// Median track of the circle, north and east in ship lengths.
    pub track: Vec<[f64; 2]>,
}

impl PredictedCircle {
    /// Turning circle of the recommended estimate, with the rudder of the first recorded circle, else with 35° to
    /// starboard. `None` if no K and T are accepted, if no hull was fitted to the records, or if the drawn ships do not
    /// determine its size.
    pub fn from_document(document: &FitDocument) -> Option<Self> {
        let verdict = document.verdict.as_ref().filter(|verdict| verdict.believe == KtUsability::Yes)?;
        let ship = document.ships.get(&verdict.method).filter(|ship| !ship.hulls.is_empty())?;
        let recorded = document.trials.iter().find_map(|trial| trial.circle.as_ref());
        let is_to_port = recorded.is_some_and(|circle| circle.side == Side::Port.to_string());
        let side = if is_to_port { Side::Port } else { Side::Starboard };
        let rudder_deg = recorded.map_or(RUDDER_DEG, |circle| circle.rudder_deg.abs());
        let kind =
            Manoeuvre::TurningCircle { rudder: from_deg(rudder_deg), side, duration: None, heading_change: None };
        let ships = ShipMixture::new(vec![(ship.clone(), 1.0)]).ok()?;
        let prediction = ships.predict(&kind, DRAWS, false).ok()?;
        let length = ships.particulars()?.length;
        let track = prediction.curves.median_track.iter().map(|place| place.map(|metres| metres / length)).collect();
        let entry = PredictedCircleEntry {
            method: verdict.method.clone(),
            side: side.to_string(),
            rudder_deg,
            extrapolated: prediction.is_extrapolated(),
            draws: DRAWS,
            advance_lengths: lengths(&prediction, "advance_m", length)?,
            transfer_lengths: lengths(&prediction, "transfer_m", length)?,
            tactical_diameter_lengths: lengths(&prediction, "tactical_diameter_m", length)?,
        };
        Some(Self { entry, track })
    }
}

/// Characteristic in metres, converted to ship lengths.
fn lengths(prediction: &Prediction, figure: &str, length: f64) -> Option<MedianEntry> {
    let interval = prediction.figures.get(figure)?.interval;
    Some(MedianEntry { median: interval.median / length, ci90: interval.ci90.map(|end| end / length) })
}
