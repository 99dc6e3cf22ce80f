//! What the engine accepts: everything about a trial but its chance.

use ship::FirstOrder;
use simulate::Simulation;
use simulate::settings::Assumption;

/// Everything about a trial but its chance.
#[derive(Debug, Clone)]
pub struct Specification {
    /// How a trial is made.
    pub simulation: Simulation,
    /// A second manoeuvre of the same ship, in a calm and perfectly recorded.
    pub validation: Option<Simulation>,
    /// The truth, where the ship is exactly first order.
    pub truth: Option<FirstOrder>,
    /// The base of a response ship, whatever effects it has.
    pub base: Option<FirstOrder>,
    /// Identifiers of the effects that a first-order base lacks in a trial; [`HULL`] for a ship with equations of its
    /// own.
    pub missing: Vec<String>,
    /// Which of [`Assumption::ALL`] the settings leave to be made.
    pub assumed: [bool; Assumption::ALL.len()],
}

/// What a hull has that no list of effects names.
pub const HULL: &str = "hull";

impl Specification {
    /// Trials carry the name of their scenario.
    pub fn name(&mut self, scenario: &str) {
        for simulation in [Some(&mut self.simulation), self.validation.as_mut()].into_iter().flatten() {
            simulation.scenario = scenario.to_owned();
        }
    }
}
