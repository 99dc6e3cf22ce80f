//! Check of predictions: characteristics of manoeuvres, predicted from an estimate and true.

use document::IdentifiedShip;
use predict::simulated_manoeuvre::SimulatedManoeuvre;
use predict::{ShipMixture, figures, standard};
use simulate::{Manoeuvre, Sensors, Simulation, StreamKey};
use trial::Trial;

use crate::identified_ship::RecordFacts;
use crate::rows::PredictedCharacteristic;
use crate::scenario::PredictionSettings;

/// Check of predictions: true characteristics of manoeuvres of the ship of a trial, and the facts of its records.
pub struct PredictionCheck<'a> {
    asked: &'a PredictionSettings,
    /// True characteristics by name, per manoeuvre; `None` if the ship does not complete it.
    true_manoeuvres: Vec<Option<figures::Characteristics>>,
    facts: RecordFacts<'a>,
}

/// Time scale of a ship without particulars or closed form, in sampling periods of its record.
const TIMESCALE_PERIODS: f64 = 10.0;

/// `true` if a length in metres is also given in ship lengths, so that it counts once.
pub fn is_repeated_in_lengths(name: &str, is_there: impl Fn(&str) -> bool) -> bool {
    name.strip_suffix("_m").is_some_and(|name| is_there(&format!("{name}_lengths")))
}

impl<'a> PredictionCheck<'a> {
    /// Simulates the manoeuvres with the ship, gear and weather of a trial, without measurement errors, and with random
    /// numbers independent of its records.
    pub fn new(asked: &'a PredictionSettings, simulation: &Simulation, key: &StreamKey, records: &'a [Trial]) -> Self {
        let closed = simulation.ship.closed_form().map(|ship| ship.K_over_T.sqrt().recip());
        let of_hull = simulation.ship.particulars().map(|particulars| particulars.length / particulars.speed);
        let timescale = closed.or(of_hull).unwrap_or(TIMESCALE_PERIODS * simulation.recording.sampling_period);
        let other = StreamKey { seed: !key.seed, ..*key };
        let true_figures = |kind: &Manoeuvre| {
            let calm = Simulation {
                manoeuvre: standard::with_predicted_end(kind, timescale)?,
                sensors: Sensors::default(),
                ..simulation.clone()
            };
            let passage = SimulatedManoeuvre::from_simulation(calm, &other, timescale).ok()?;
            let all = figures::characteristics(kind, &passage, None);
            let is_counted = |name: &str| !is_repeated_in_lengths(name, |lengths| all.contains_key(lengths));
            Some(all.iter().filter(|(name, _)| is_counted(name)).map(|(name, value)| (*name, *value)).collect())
        };
        Self {
            asked,
            true_manoeuvres: asked.manoeuvres.iter().map(true_figures).collect(),
            facts: RecordFacts::from_trials(records),
        }
    }

    /// Predicted and true characteristics of the manoeuvres; those missing on either side are omitted. Empty without an
    /// identified ship.
    pub fn characteristics(
        &self,
        identified: impl FnOnce(&RecordFacts) -> Option<IdentifiedShip>,
    ) -> Box<[PredictedCharacteristic]> {
        let mixture = identified(&self.facts).and_then(|ship| ShipMixture::new(vec![(ship, 1.0)]).ok());
        let Some(mixture) = mixture else { return Box::default() };
        let mut all = Vec::new();
        for (kind, truths) in self.asked.manoeuvres.iter().zip(&self.true_manoeuvres) {
            let Some(truths) = truths else { continue };
            let Ok(prediction) = mixture.predict(kind, self.asked.draws, false) else { continue };
            for (name, figure) in prediction.figures {
                let Some(truth) = truths.get(name.as_str()).copied().flatten() else { continue };
                let (median, ci90) = (figure.interval.median, figure.interval.ci90);
                all.push(PredictedCharacteristic { name: format!("{kind} {name}").into(), truth, median, ci90 });
            }
        }
        all.into()
    }
}
