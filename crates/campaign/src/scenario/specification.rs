//! What the engine accepts: everything about a trial but its chance.

use ship::FirstOrder;
use simulate::{Simulation, StreamKey};

use crate::scenario::physics::MissingPhysics;

/// Everything about a trial but its chance.
#[derive(Debug, Clone)]
pub struct Specification {
    /// How a trial is made.
    pub simulation: Simulation,
    /// Further records of the same ship, which methods identify together with that of the trial.
    pub also: Vec<Simulation>,
    /// A second manoeuvre of the same ship, in a calm and perfectly recorded.
    pub validation: Option<Simulation>,
    /// The truth, where the ship is exactly first order.
    pub truth: Option<FirstOrder>,
    /// The base of a response ship, whatever effects it has.
    pub base: Option<FirstOrder>,
    /// Identifiers of the effects that a first-order base lacks in a trial; [`HULL`] for a ship with equations of its
    /// own.
    pub missing: Vec<String>,
    /// What its formula states to be right to say of it.
    pub stated: Option<MissingPhysics>,
}

/// What a hull has that no list of effects names.
pub const HULL: &str = "hull";

impl Specification {
    /// How every record of a trial is made, with the key of its own chance.
    pub fn records(&self, key: &StreamKey) -> impl Iterator<Item = (&Simulation, StreamKey)> {
        /// Odd, so that no two of 2⁶⁴ records share a seed.
        const NEXT: u64 = 0x9E37_79B9_7F4A_7C15;
        let own = |number: usize| StreamKey { seed: key.seed.wrapping_add(NEXT.wrapping_mul(number as u64)), ..*key };
        std::iter::once(&self.simulation).chain(&self.also).enumerate().map(move |(number, one)| (one, own(number)))
    }
}
