//! Which trial the paper's Table 1 was: its six visible rows against zig-zags of every reading, the best ship of each.
//!
//! The rows are (t, ψ, δ): (0, 20.4, 7), (1, 21.6, −1), (3, 22.6, −3), (268, −17.0, 10), (269, −16.4, 10), (270, −16.0,
//! 10), in s and deg. The first six facts that are physically smooth are held against a grid over K, T and rudder rate.

use rayon::prelude::*;
use ship::FirstOrder;
use ship::angle::to_deg;
use simulate::StreamKey;
use simulate::recording::Start;

use super::{Check, Section, Tolerance};
use crate::records::Case;

/// Headings of Table 1 that a ship can have: time, s, and heading, deg.
const HEADINGS: [(usize, f64); 4] = [(0, 20.4), (268, -17.0), (269, -16.4), (270, -16.0)];

/// Rudder angles of Table 1 while it is held: time, s, and angle, deg.
const RUDDERS: [(usize, f64); 2] = [(268, 10.0), (270, 10.0)];

/// Rudder angle in the first row, deg.
const FIRST_RUDDER: f64 = 7.0;

/// What a row is good to, deg: the unit of misfits.
const ROW: f64 = 0.5;

/// Readings of the trial with the misfit of an independent grid search, in squares of [`ROW`].
const READINGS: [(f64, f64, f64); 4] =
    [(10.0, 20.0, 4.0), (15.0, 20.0, 212.0), (10.0, 10.0, 335.0), (20.0, 20.0, 835.0)];

/// The best ship of one reading.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Best {
    /// Sum of squared misfits, in squares of [`ROW`].
    score: f64,
    /// K, 1/s.
    gain: f64,
    /// T, s.
    time: f64,
    /// Rudder rate, deg/s.
    rate: f64,
}

/// Misfit of one ship steered one way, in squares of [`ROW`]; `None` when it does not make so long a trial.
fn score(rudder: f64, heading: f64, gain: f64, time: f64, rate: f64) -> Option<f64> {
    let ship = FirstOrder::from_indices(gain, time, 0.0);
    let case =
        Case { ship, rudder_deg: rudder, heading_deg: heading, rate_deg_s: rate, duration_s: 480.0, ..Case::default() };
    let mut simulation = case.simulation();
    // The record begins while the rudder falls through 7°.
    simulation.recording.start = Start::Execute { number: 2, offset: (rudder - FIRST_RUDDER) / rate };
    simulation.recording.duration = Some(270.0);
    let trial = simulation.run(&StreamKey { seed: 0, cell: 0, replicate: 0 }).ok()?.trial;
    if trial.len() < 271 {
        return None;
    }
    let misfit = |measured: &[f64], facts: &[(usize, f64)]| -> f64 {
        facts.iter().map(|&(row, fact)| ((to_deg(measured[row]) - fact) / ROW).powi(2)).sum()
    };
    Some(misfit(trial.heading(), &HEADINGS) + misfit(trial.rudder(), &RUDDERS))
}

fn best(rudder: f64, heading: f64) -> Option<Best> {
    let gains = (0..9).map(|k| 0.06 + 0.01 * f64::from(k));
    let ships: Vec<(f64, f64)> = gains.flat_map(|gain| (0..19).map(move |k| (gain, 8.0 + f64::from(k)))).collect();
    ships
        .into_par_iter()
        .flat_map_iter(|(gain, time)| [2.0, 2.32, 2.5, 2.8, 3.0, 3.5, 4.0, 5.0].map(|rate| (gain, time, rate)))
        .filter_map(|(gain, time, rate)| {
            Some(Best { score: score(rudder, heading, gain, time, rate)?, gain, time, rate })
        })
        .min_by(|one, other| one.score.total_cmp(&other.score))
}

/// The section.
pub fn section() -> Section {
    let mut checks = Vec::new();
    for (rudder, heading, published) in READINGS {
        let Some(best) = best(rudder, heading) else { continue };
        let reading = format!("{rudder:.0}/{heading:.0}");
        checks.push(Check::new(
            format!("table-1/{reading}"),
            format!("misfit of the best {reading} (K {:.2} 1/s, T {:.0} s, {} deg/s)", best.gain, best.time, best.rate),
            (published, 0),
            best.score,
            if published < 10.0 { Tolerance::Absolute(4.0) } else { Tolerance::Relative(0.05) },
            "",
        ));
    }
    let of = |id: &str| checks.iter().find(|check| check.id == id).map_or(f64::NAN, |check| check.ours);
    let others = ["table-1/15/20", "table-1/10/10", "table-1/20/20"].map(of);
    let ratio = others.into_iter().fold(f64::INFINITY, f64::min) / of("table-1/10/20");
    checks.push(Check::new(
        "table-1/which",
        "next best reading over 10/20",
        (20.0, 0),
        ratio,
        Tolerance::AtLeast,
        "times",
    ));
    Section {
        title: "Which trial the paper's Table 1 was",
        method: "The visible rows of Table 1 (Ge, Hu, Yin and Sun) that are physically smooth: headings at 0, 268, 269 and 270 s, rudder at \
                 268 and 270 s, held against zig-zags of four readings of the trial, the best of a grid over K (0.06 to 0.14 1/s), T (8 to \
                 26 s) and rudder rate (2 to 5 deg/s) each. The misfit is a sum of squares in units of half a degree. What is left says \
                 that it was a 10/20; our grid is finer, so the misfit of that reading is smaller.",
        checks,
    }
}
