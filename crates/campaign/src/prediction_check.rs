//! Manoeuvres predicted from an answer, and the same ship making them: whether intervals hold.

use document::IdentifiedShip;
use predict::simulated_manoeuvre::SimulatedManoeuvre;
use predict::{ShipMixture, figures, standard};
use simulate::{Manoeuvre, Sensors, Simulation, StreamKey};
use trial::Trial;

use crate::known::RecordFacts;
use crate::rows::PredictedFigure;
use crate::scenario::Predictions;

/// What the ship of a trial does in the manoeuvres that are predicted from answers to it.
pub struct PredictionCheck<'a> {
    asked: &'a Predictions,
    /// Figures by name, `None` where the ship does not come to the end of a manoeuvre.
    true_manoeuvres: Vec<Option<figures::Figures>>,
    facts: RecordFacts<'a>,
}

/// A time of a ship that is known by its simulation alone, s: rows of a record are closer than it.
const ROWS: f64 = 10.0;

/// Whether a figure is a length in metres that stands there in lengths of the ship, too: it counts once.
pub fn is_in_lengths(name: &str, is_there: impl Fn(&str) -> bool) -> bool {
    name.strip_suffix("_m").is_some_and(|name| is_there(&format!("{name}_lengths")))
}

impl<'a> PredictionCheck<'a> {
    /// Steers the ship of a trial through the manoeuvres, with her gear and in her weather; the chance is not that of
    /// the records.
    pub fn new(asked: &'a Predictions, simulation: &Simulation, key: &StreamKey, records: &'a [Trial]) -> Self {
        let closed = simulation.vessel.closed_form().map(|ship| ship.K_over_T.sqrt().recip());
        let of_hull = simulation.vessel.particulars().map(|particulars| particulars.length / particulars.speed);
        let timescale = closed.or(of_hull).unwrap_or(ROWS * simulation.recording.period);
        let other = StreamKey { seed: !key.seed, ..*key };
        let one = |kind: &Manoeuvre| {
            let calm = Simulation {
                manoeuvre: standard::steered(kind, timescale)?,
                sensors: Sensors::default(),
                ..simulation.clone()
            };
            let passage = SimulatedManoeuvre::of(calm, &other, timescale).ok()?;
            let all = figures::of(kind, &passage, None);
            let is_counted = |name: &str| !is_in_lengths(name, |lengths| all.contains_key(lengths));
            Some(all.iter().filter(|(name, _)| is_counted(name)).map(|(name, value)| (*name, *value)).collect())
        };
        Self { asked, true_manoeuvres: asked.kinds.iter().map(one).collect(), facts: RecordFacts::of(records) }
    }

    /// What is predicted of the manoeuvres from an answer, beside what the ship does; figures that the ship or the
    /// prediction does not have are left out.
    pub fn figures(&self, known: impl FnOnce(&RecordFacts) -> Option<IdentifiedShip>) -> Box<[PredictedFigure]> {
        let mixture = known(&self.facts).and_then(|known| ShipMixture::new(vec![(known, 1.0)]).ok());
        let Some(mixture) = mixture else { return Box::default() };
        let mut all = Vec::new();
        for (kind, truths) in self.asked.kinds.iter().zip(&self.true_manoeuvres) {
            let Some(truths) = truths else { continue };
            let Ok(prediction) = mixture.predict(kind, self.asked.draws, false) else { continue };
            for (name, figure) in prediction.figures {
                let Some(truth) = truths.get(name.as_str()).copied().flatten() else { continue };
                let (median, ci90) = (figure.interval.median, figure.interval.ci90);
                all.push(PredictedFigure { name: format!("{kind} {name}").into(), truth, median, ci90 });
            }
        }
        all.into()
    }
}
