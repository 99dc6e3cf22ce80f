//! The turning circle that the answer of a fit predicts: figures and median track of drawn ships.

use document::fit::{Belief, FitDocument, MedianEntry, PredictedCircleEntry};
use predict::{Prediction, ShipMixture};
use ship::angle::from_deg;
use trial::{Manoeuvre, Side};

/// Ships that are drawn.
const DRAWS: usize = 300;

/// Rudder of the circle of IMO MSC.137(76), deg.
const RUDDER_DEG: f64 = 35.0;

/// A predicted circle.
pub struct PredictedCircle {
    /// Its figures.
    pub entry: PredictedCircleEntry,
    /// Its median track, north and east in ship lengths.
    pub track: Vec<[f64; 2]>,
}

impl PredictedCircle {
    /// The circle of the answer to take, with the rudder of the first recorded circle, else with 35° to starboard.
    /// `None` if no K and T can be taken, where the records tell neither speed nor drift, and where the draws do not
    /// tell its size.
    pub fn of(document: &FitDocument) -> Option<Self> {
        let verdict = document.verdict.as_ref().filter(|verdict| verdict.believe == Belief::Yes)?;
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

/// A figure in metres as lengths of the ship.
fn lengths(prediction: &Prediction, figure: &str, length: f64) -> Option<MedianEntry> {
    let interval = prediction.figures.get(figure)?.interval;
    Some(MedianEntry { median: interval.median / length, ci90: interval.ci90.map(|end| end / length) })
}
