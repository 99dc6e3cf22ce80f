//! Identity of the trial in the paper's Table 1: its six visible rows against zig-zags of every reading, with the best
//! ship of each.
//!
//! The rows are (t, ψ, δ): (0, 20.4, 7), (1, 21.6, −1), (3, 22.6, −3), (268, −17.0, 10), (269, −16.4, 10), (270, −16.0,
//! 10), in s and deg. The first six facts that are physically smooth are compared with a grid over K, T and rudder
//! rate.

use rayon::prelude::*;
use ship::FirstOrder;
use ship::angle::to_deg;
use simulate::StreamKey;

use super::{Check, Section, Tolerance};
use crate::records::Case;

/// Physically possible headings of Table 1: time, s, and heading, deg.
const HEADINGS: [(usize, f64); 4] = [(0, 20.4), (268, -17.0), (269, -16.4), (270, -16.0)];

/// Rudder angles of Table 1 while the rudder is held: time, s, and angle, deg.
const RUDDERS: [(usize, f64); 2] = [(268, 10.0), (270, 10.0)];

/// Rudder angle in the first row, deg.
const FIRST_RUDDER: f64 = 7.0;

/// Accuracy of a row, deg: the unit of misfits.
const ROW: f64 = 0.5;

/// Readings of the trial with the misfit of an independent grid search, in squares of [`ROW`].
const READINGS: [(f64, f64, f64); 4] =
    [(10.0, 20.0, 4.0), (15.0, 20.0, 212.0), (10.0, 10.0, 335.0), (20.0, 20.0, 835.0)];

/// Best ship of one reading.
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

/// Headings and rudder angles of one ship at the rows of [`HEADINGS`] and [`RUDDERS`], deg; `None` if its trial is too
/// short.
fn facts(rudder: f64, heading: f64, gain: f64, time: f64, rate: f64) -> Option<Vec<f64>> {
    let ship = FirstOrder::from_indices(gain, time, 0.0);
    let case =
        Case { ship, rudder_deg: rudder, heading_deg: heading, rate_deg_s: rate, duration_s: 480.0, ..Case::default() };
    let mut simulation = case.simulation();
    // The record begins while the rudder falls through 7°.
    (simulation.recording.after_execute, simulation.recording.first_row_offset) =
        (Some(2), Some((rudder - FIRST_RUDDER) / rate));
    simulation.recording.duration = Some(270.0);
    let trial = simulation.run(&StreamKey { seed: 0, cell: 0, replicate: 0 }).ok()?.trial;
    if trial.len() < 271 {
        return None;
    }
    let headings = HEADINGS.map(|(row, _)| to_deg(trial.heading()[row]));
    let rudders = RUDDERS.map(|(row, _)| to_deg(trial.rudder()[row]));
    Some(headings.into_iter().chain(rudders).collect())
}

/// Misfit of [`facts`], in squares of [`ROW`].
fn score(facts: &[f64]) -> f64 {
    let printed = HEADINGS.iter().chain(&RUDDERS);
    facts.iter().zip(printed).map(|(ours, (_, printed))| ((ours - printed) / ROW).powi(2)).sum()
}

fn best(rudder: f64, heading: f64) -> Option<Best> {
    let gains = (0..9).map(|k| 0.06 + 0.01 * f64::from(k));
    let ships: Vec<(f64, f64)> = gains.flat_map(|gain| (0..19).map(move |k| (gain, 8.0 + f64::from(k)))).collect();
    ships
        .into_par_iter()
        .flat_map_iter(|(gain, time)| [2.0, 2.32, 2.5, 2.8, 3.0, 3.5, 4.0, 5.0].map(|rate| (gain, time, rate)))
        .filter_map(|(gain, time, rate)| {
            Some(Best { score: score(&facts(rudder, heading, gain, time, rate)?), gain, time, rate })
        })
        .min_by(|one, other| one.score.total_cmp(&other.score))
}

/// Printed rows against the rows of the best 10/20.
fn printed_rows(best: Best) -> Vec<Check> {
    let ours = facts(10.0, 20.0, best.gain, best.time, best.rate).expect("the best has made the trial");
    let printed =
        HEADINGS.iter().map(|fact| ("heading", fact, 1)).chain(RUDDERS.iter().map(|fact| ("rudder", fact, 0)));
    let check = |((quantity, &(row, fact), decimals), ours): ((&str, &(usize, f64), usize), f64)| {
        let (id, what) = (format!("table-1/{quantity}/{row}"), format!("best 10/20, {quantity} at {row} s"));
        let tolerance = Tolerance::Absolute(2.0 * ROW);
        Check::new(id, what, (fact, decimals), ours, tolerance, "deg").from("Ge, Hu, Yin and Sun, Table 1")
    };
    printed.zip(ours).map(check).collect()
}

/// Section of the checks.
pub fn section() -> Section {
    let mut checks = Vec::new();
    for (rudder, heading, published) in READINGS {
        let Some(best) = best(rudder, heading) else { continue };
        let reading = format!("{rudder:.0}/{heading:.0}");
        if published < 10.0 {
            checks.extend(printed_rows(best));
        }
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
                 that it was a 10/20; our grid is finer, so the misfit of that reading is smaller. The rows themselves are met within \
                 1 deg, twice that unit.",
        checks,
    }
}
