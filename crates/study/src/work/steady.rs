//! Steady turns of a traced model, as in the diagram of a spiral test.

use document::IdentifiedShip;
use document::identified_ship::ValidityRange;
use predict::ShipMixture;
use predict::steady::SteadyCurve;
use ship::angle::from_deg;
use trial::Manoeuvre;

/// Number of drawn ships.
const DRAWS: usize = 40;

/// Maximum rudder angle as a multiple of the largest rudder angle in the records.
const RUDDER_RATIO: f64 = 1.3;

/// Range of the maximum rudder angle, deg.
const RUDDER_RANGE_DEG: [f64; 2] = [10.0, 35.0];

/// Steady turns of the possible responses of a ship in a calm, the most probable one first, and the range of motion
/// covered by the records; `None` if no steady turn is found.
pub fn steady_turns(identified: &IdentifiedShip) -> Option<(Vec<SteadyCurve>, ValidityRange)> {
    // Steady turns of the traced response, not of a hull.
    let ship = IdentifiedShip { hulls: Vec::new(), ..identified.in_calm().ok()? };
    let seen = ship.validity_range;
    let [least, most] = RUDDER_RANGE_DEG.map(from_deg);
    let kind = Manoeuvre::Spiral { rudder: (RUDDER_RATIO * seen.rudder_rad).clamp(least, most) };
    let curves = ShipMixture::new(vec![(ship, 1.0)]).ok()?.predict(&kind, DRAWS, false).ok()?.curves.steady;
    let has_turns = curves.first().is_some_and(|curve| curve.rudder.len() > 2);
    has_turns.then_some((curves, seen))
}
