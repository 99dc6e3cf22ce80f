//! The steady turns of a traced model, as the diagram of a spiral test shows them.

use ::trace::Analysis;
use campaign::known::{self, Shown};
use predict::known::Seen;
use predict::steady::SteadyCurve;
use predict::{Kind, Mixture};
use ship::angle::from_deg;
use trial::Trial;

/// Ships that are drawn.
const DRAWS: usize = 40;

/// The rudder goes to so many times the largest one of the records, within these angles, deg.
const BEYOND: f64 = 1.3;
const RUDDER_DEG: [f64; 2] = [10.0, 35.0];

/// Steady turns of the structures of an analysis in a calm, the most probable one first, and the range in which the
/// records show the ship; `None` where no steady turn is found.
pub fn of_analysis(analysis: &Analysis, trials: &[Trial]) -> Option<(Vec<SteadyCurve>, Seen)> {
    let ship = known::of_analysis(analysis, &Shown::of(trials)).in_calm().ok()?;
    let seen = ship.seen;
    let [least, most] = RUDDER_DEG.map(from_deg);
    let kind = Kind::Spiral { rudder: (BEYOND * seen.rudder_rad).clamp(least, most) };
    let curves = Mixture::new(vec![(ship, 1.0)]).ok()?.predict(&kind, DRAWS, false).ok()?.curves;
    let has_turns = curves.first().is_some_and(|curve| curve.rudder.len() > 2);
    has_turns.then_some((curves, seen))
}
