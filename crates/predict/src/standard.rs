//! Predicted manoeuvres: the manoeuvres of the IMO criteria, and the end of every predicted manoeuvre.

use ship::angle::from_deg;
use simulate::Manoeuvre;

/// Number of executes of a predicted zig-zag, which gives four complete overshoots.
pub(crate) const ZIG_ZAG_EXECUTES: usize = 6;

/// Change of heading of a predicted turning circle, rad: a little more than the 540° after which speed, drift and pivot
/// of a steady turn can be read.
const TURN: f64 = 3.05 * std::f64::consts::PI;

/// Duration of the turn of a pull-out, and of the motion after it, in timescales of the ship.
const PULL_OUT: f64 = 40.0;

/// Duration after the last order of a Williamson turn, in timescales of the ship.
const AFTER_WILLIAMSON: f64 = 20.0;

/// Manoeuvres of the criteria of IMO MSC.137(76), first to starboard: zig-zags 10/10 and 20/20, and a turning circle at
/// 35°.
pub fn imo_manoeuvres() -> Vec<Manoeuvre> {
    let zig_zag = |angle_deg| Manoeuvre::zig_zag(from_deg(angle_deg), from_deg(angle_deg));
    vec![zig_zag(10.0), zig_zag(20.0), Manoeuvre::turning_circle(from_deg(35.0))]
}

/// Requested manoeuvre with the end that a prediction has: a number of executes, a change of heading, or a multiple of
/// the timescale (s) of the ship; `None` for a spiral, which is predicted as a steady curve.
pub fn with_predicted_end(requested: &Manoeuvre, timescale: f64) -> Option<Manoeuvre> {
    let mut manoeuvre = requested.clone();
    match &mut manoeuvre {
        Manoeuvre::ZigZag { executes, .. } => *executes = Some(ZIG_ZAG_EXECUTES),
        Manoeuvre::TurningCircle { heading_change, .. } => *heading_change = Some(TURN),
        Manoeuvre::PullOut { hold, duration, .. } => [*hold, *duration] = [PULL_OUT * timescale; 2],
        Manoeuvre::Williamson { duration, .. } => *duration = AFTER_WILLIAMSON * timescale,
        Manoeuvre::Spiral { .. } => return None,
        Manoeuvre::InitialTurning { .. } | Manoeuvre::Replay { .. } => {}
    }
    Some(manoeuvre)
}
