//! The steady turns of a traced model, as the diagram of a spiral test shows them.

use document::IdentifiedShip;
use document::identified_ship::ValidityRange;
use predict::ShipMixture;
use predict::steady::SteadyCurve;
use ship::angle::from_deg;
use trial::Manoeuvre;

/// Ships that are drawn.
const DRAWS: usize = 40;

/// The rudder goes to so many times the largest one of the records, within these angles, deg.
const BEYOND: f64 = 1.3;
const RUDDER_DEG: [f64; 2] = [10.0, 35.0];

/// Steady turns of the responses that are known of a ship, in a calm, the most probable one first, and the range in
/// which the records show her; `None` where no steady turn is found.
pub fn of_ship(known: &IdentifiedShip) -> Option<(Vec<SteadyCurve>, ValidityRange)> {
    // Those of the traced response, whatever a hull beside it would do.
    let ship = IdentifiedShip { hulls: Vec::new(), ..known.in_calm().ok()? };
    let seen = ship.seen;
    let [least, most] = RUDDER_DEG.map(from_deg);
    let kind = Manoeuvre::Spiral { rudder: (BEYOND * seen.rudder_rad).clamp(least, most) };
    let curves = ShipMixture::new(vec![(ship, 1.0)]).ok()?.predict(&kind, DRAWS, false).ok()?.curves.steady;
    let has_turns = curves.first().is_some_and(|curve| curve.rudder.len() > 2);
    has_turns.then_some((curves, seen))
}
