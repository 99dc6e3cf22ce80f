//! Manoeuvres predicted from an answer, and the same ship making them: whether intervals hold.

use predict::passage::SimulatedManoeuvre;
use predict::{IdentifiedShip, Kind, ShipMixture, figures};
use scenario::Predictions;
use simulate::{Sensors, Simulation, StreamKey};

use crate::rows::Foretold;

/// What the ship of a trial does in the manoeuvres that are predicted: figures by name, `None` where it does not come
/// to the end of one.
pub struct Deeds(Vec<Option<figures::Figures>>);

/// The key of the trials that were not made: their chance is not that of the record.
fn other(key: &StreamKey) -> StreamKey {
    StreamKey { seed: !key.seed, ..*key }
}

/// A time of a ship that is known by its simulation alone, s: rows of a record are closer than it.
const ROWS: f64 = 10.0;

/// Steers the ship of a trial through the manoeuvres, with her gear and in her weather.
pub fn deeds(predictions: &Predictions, simulation: &Simulation, key: &StreamKey) -> Deeds {
    let closed = simulation.vessel.closed_form().map(|ship| ship.K_over_T.sqrt().recip());
    let of_hull = simulation.vessel.particulars().map(|particulars| particulars.length / particulars.speed);
    let timescale = closed.or(of_hull).unwrap_or(ROWS * simulation.recording.period);
    let one = |kind: &Kind| {
        let calm =
            Simulation { manoeuvre: kind.manoeuvre(timescale)?, sensors: Sensors::default(), ..simulation.clone() };
        let passage = SimulatedManoeuvre::of(calm, &other(key), timescale, None).ok()?;
        Some(figures::of(kind, &passage, None))
    };
    Deeds(predictions.kinds.iter().map(one).collect())
}

/// What is predicted of the manoeuvres, beside the deeds; figures that the ship or the prediction does not have are
/// left out.
pub fn foretold(predictions: &Predictions, known: IdentifiedShip, deeds: &Deeds) -> Box<[Foretold]> {
    let Ok(mixture) = ShipMixture::new(vec![(known, 1.0)]) else { return Box::default() };
    let mut all = Vec::new();
    for (kind, deeds) in predictions.kinds.iter().zip(&deeds.0) {
        let Some(deeds) = deeds else { continue };
        let Ok(prediction) = mixture.predict(kind, predictions.draws, false) else { continue };
        for (name, figure) in prediction.figures {
            let truth = deeds.get(name.as_str()).copied().flatten();
            let Some(truth) = truth else { continue };
            all.push(Foretold {
                name: format!("{kind} {name}").into(),
                truth,
                median: figure.interval.median,
                ci90: figure.interval.ci90,
            });
        }
    }
    all.into()
}
