//! Uniform current from a turning circle of two rounds.
//!
//! Sources: IMO MSC/Circ.1053 (2002); ITTC 7.5-04-02-01.

use std::f64::consts::{PI, TAU};

use serde::{Deserialize, Serialize};
use ship::angle::to_deg;

use super::circle::first_crossing;

/// Heading change after which a turn is taken as steady, rad.
const STEADY: f64 = PI;

/// Minimum heading change of a turn, rad: it contains pairs one round apart over 180°.
const MIN_CHANGE: f64 = 2.0 * TAU;

/// Heading difference between successive pairs, rad (10°).
const PAIR_SPACING: f64 = PI / 18.0;

/// Current over ground, including the drift of the ship due to wind, which a turn cannot separate from it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Current {
    /// Speed.
    pub speed_m_s: f64,
    /// Direction towards which it sets, clockwise from north, 0 to 360.
    pub set_deg: f64,
    /// Component towards north.
    pub north_m_s: f64,
    /// Component towards east.
    pub east_m_s: f64,
    /// Standard deviation of the component towards north, from the scatter of the pairs.
    pub north_sd_m_s: f64,
    /// Standard deviation of the component towards east.
    pub east_sd_m_s: f64,
}

/// Current from a turn: mean of the displacement over ground between two instants with equal heading, one round apart,
/// divided by the time between them,
///
/// V = [x(ψ + 2π) − x(ψ)] / [t(ψ + 2π) − t(ψ)], for ψ from a heading change of 180° on.
///
/// Heading in rad, not wrapped; track north and east in m; time in s; columns of equal length, from the execute on.
/// `None` for columns of different length, a turn of less than 720° or fewer than three valid pairs. The pairs overlap,
/// so their scatter is not divided by their number. A current that changes within a round, and wind, are included in
/// the result.
pub fn estimate_current(time: &[f64], heading: &[f64], track: &[[f64; 2]]) -> Option<Current> {
    let rows = time.len();
    if rows < 2 || heading.len() != rows || track.len() != rows {
        return None;
    }
    let side = (heading[rows - 1] - heading[0]).signum();
    let change = |row: usize| side * (heading[row] - heading[0]);
    let whole = change(rows - 1);
    // First instant with this heading change: time, north and east.
    let instant = |angle: f64| {
        let (row, share) = first_crossing(change, 0, rows, angle)?;
        let at = |row: usize| [time[row], track[row][0], track[row][1]];
        let (before, after) = (at(row), at(row + 1));
        let crossing: [f64; 3] = std::array::from_fn(|k| before[k] + share * (after[k] - before[k]));
        crossing.iter().all(|value| value.is_finite()).then_some(crossing)
    };
    if whole.is_nan() || whole < MIN_CHANGE {
        return None;
    }
    let pairs = ((whole - TAU - STEADY) / PAIR_SPACING) as usize;
    let drifts: Vec<[f64; 2]> = (0..=pairs)
        .filter_map(|pair| {
            let angle = STEADY + pair as f64 * PAIR_SPACING;
            let (first, next) = (instant(angle)?, instant(angle + TAU)?);
            let elapsed = next[0] - first[0];
            (elapsed > 0.0).then(|| [(next[1] - first[1]) / elapsed, (next[2] - first[2]) / elapsed])
        })
        .collect();
    let count = drifts.len() as f64;
    let mean = [0, 1].map(|axis| drifts.iter().map(|drift| drift[axis]).sum::<f64>() / count);
    let [north_m_s, east_m_s] = mean;
    let spread = |axis: usize| drifts.iter().map(|drift| (drift[axis] - mean[axis]).powi(2)).sum::<f64>();
    let [north_sd_m_s, east_sd_m_s] = [0, 1].map(|axis| (spread(axis) / (count - 1.0)).sqrt());
    let (speed_m_s, set_deg) = (north_m_s.hypot(east_m_s), to_deg(east_m_s.atan2(north_m_s).rem_euclid(TAU)));
    let mean_current = Current { speed_m_s, set_deg, north_m_s, east_m_s, north_sd_m_s, east_sd_m_s };
    (drifts.len() > 2).then_some(mean_current)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Turn of some rounds to one side (±1) at a constant rate, in a uniform current north and east, m/s.
    fn turn(rounds: f64, side: f64, [north, east]: [f64; 2]) -> (Vec<f64>, Vec<f64>, Vec<[f64; 2]>) {
        let time: Vec<f64> = (0..=2000).map(|row| f64::from(row) * 0.5).collect();
        let rate = side * rounds * TAU / 1000.0;
        let heading: Vec<f64> = time.iter().map(|t| 0.3 + rate * t).collect();
        let radius = 400.0;
        let place = |(t, psi): (&f64, &f64)| {
            [
                radius * side * (psi.sin() - 0.3f64.sin()) + north * t,
                radius * side * (0.3f64.cos() - psi.cos()) + east * t,
            ]
        };
        let track = time.iter().zip(&heading).map(place).collect();
        (time, heading, track)
    }

    #[test]
    fn a_uniform_current_is_found() {
        for side in [-1.0, 1.0] {
            let (time, heading, track) = turn(2.2, side, [0.4, -0.3]);
            let estimate = estimate_current(&time, &heading, &track).expect("two rounds");
            assert!((estimate.north_m_s - 0.4).abs() < 1e-3 && (estimate.east_m_s + 0.3).abs() < 1e-3, "{estimate:?}");
            assert!((estimate.speed_m_s - 0.5).abs() < 1e-3 && estimate.north_sd_m_s.max(estimate.east_sd_m_s) < 1e-3);
            assert!((estimate.set_deg - 323.13).abs() < 0.2, "{estimate:?}");
        }
    }

    #[test]
    fn less_than_two_rounds_tell_no_current() {
        let (time, heading, track) = turn(1.9, 1.0, [0.4, -0.3]);
        assert_eq!(estimate_current(&time, &heading, &track), None);
        assert_eq!(estimate_current(&time[..1], &heading[..1], &track[..1]), None);
        assert_eq!(estimate_current(&time, &heading[1..], &track), None);
    }
}
