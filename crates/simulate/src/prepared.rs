//! Simulation prepared for many trials of one cell of a study.

use std::sync::Arc;

use trial::Trial;

use crate::error::SimulateError;
use crate::measure;
use crate::simulation::{SimulatedTrial, Simulation, TrueRun};
use crate::stream::StreamKey;
use crate::wave_path::SeaWaves;

/// Simulation prepared for many keys. If no random input acts on ship and helmsman, the run is computed once, and every
/// key determines only the instrument errors. The records are identical to the records of [`Simulation::run`].
#[derive(Debug, Clone)]
pub struct PreparedSimulation {
    simulation: Simulation,
    /// True run that all keys share; `None` if random inputs act on the run.
    true_run: Option<TrueRun>,
    /// Record whose times and rudder are equal in the records of all keys; `None` if these differ.
    first: Option<Trial>,
}

impl PreparedSimulation {
    /// Simulation prepared for many keys: checked, with the part computed that all keys share.
    ///
    /// Fails if [`Simulation::run`] fails.
    pub fn new(simulation: Simulation) -> Result<Self, SimulateError> {
        simulation.check()?;
        let true_run = simulation.is_repeatable().then(|| simulation.true_run(&StreamKey::default())).transpose()?;
        let shared = true_run.as_ref().filter(|run| run.perfect_readings.has_common_rudder(&simulation.sensors));
        let first = shared.and_then(|run| Some(simulation.record(run, &StreamKey::default()).ok()?.trial));
        Ok(Self { simulation, true_run, first })
    }

    /// Simulated trial of `key`: record and truth.
    ///
    /// Fails if [`Simulation::run`] fails.
    pub fn run(&self, key: &StreamKey) -> Result<SimulatedTrial, SimulateError> {
        let Self { simulation, true_run, first } = self;
        let Some(true_run) = true_run else { return simulation.record(&simulation.true_run(key)?, key) };
        let Some(first) = first else { return simulation.record(true_run, key) };
        let waves = SeaWaves::new(&simulation.disturbances, &simulation.ship, key);
        let (channels, _) = measure::channels_with_errors(&simulation.sensors, &true_run.perfect_readings, waves, key);
        let (name, origin) = simulation.name_and_origin(key);
        let trial = simulation.with_declarations(first.with_same_rudder(name, origin, channels)?);
        Ok(SimulatedTrial { trial, truth: Arc::clone(&true_run.truth) })
    }
}
