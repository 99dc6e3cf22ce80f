//! Specification of a trial: everything but its random numbers.

use ship::FirstOrder;
use simulate::{Simulation, StreamKey};

use crate::scenario::physics::MissingPhysics;

/// Specification of a trial: everything but its random numbers.
#[derive(Debug, Clone)]
pub struct Specification {
    /// Simulation of the record.
    pub simulation: Simulation,
    /// Further records of the same ship, identified together with the first.
    pub further_simulations: Vec<Simulation>,
    /// Validation manoeuvre of the same ship, undisturbed and without measurement noise; `None` without validation.
    pub validation: Option<Simulation>,
    /// True response of a first-order ship; `None` for any other ship.
    pub true_response: Option<FirstOrder>,
    /// First-order base of a response ship, with or without effects; `None` for a hull.
    pub base_response: Option<FirstOrder>,
    /// Identifiers of the effects missing from a first-order base in a trial; [`HULL_ID`] for a hull.
    pub missing_effects: Vec<String>,
    /// Missing physics as stated with a formula; `None` without such a statement.
    pub stated_physics: Option<MissingPhysics>,
}

/// Identifier for the unlisted physics of a hull.
pub const HULL_ID: &str = "hull";

impl Specification {
    /// Simulation of every record of a trial, each with its random key.
    pub fn records(&self, key: &StreamKey) -> impl Iterator<Item = (&Simulation, StreamKey)> {
        /// Seed increment from one record of a trial to the next: 2⁶⁴ over the golden ratio (SplitMix64; Steele, Lea
        /// and Flood 2014). It is odd, so no two of 2⁶⁴ records share a seed.
        const NEXT: u64 = 0x9E37_79B9_7F4A_7C15;
        let key = |number: usize| StreamKey { seed: key.seed.wrapping_add(NEXT.wrapping_mul(number as u64)), ..*key };
        std::iter::once(&self.simulation)
            .chain(&self.further_simulations)
            .enumerate()
            .map(move |(number, run)| (run, key(number)))
    }
}
