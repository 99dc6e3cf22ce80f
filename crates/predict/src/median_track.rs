//! Median turning circle of drawn ships: at every change of heading the median position of the ships that reach it.
//! Its advance, transfer and tactical diameter are the medians of the samples; no single ship has all three.

use std::f64::consts::PI;

use crate::interval::quantiles;

/// Change of heading from one point to the next, rad; 90° and 180° are points.
const STEP: f64 = PI / 60.0;

/// Change of heading at which a track ends, rad: one and a half circles.
pub(crate) const MAX_TRACK_RAD: f64 = 3.0 * PI;

/// Track of a turn from its execute on, a position for every heading.
pub(crate) struct TurnTrack<'a> {
    /// Heading, rad.
    pub heading: &'a [f64],
    /// Positions north and east, in one unit of length.
    pub track: &'a [[f64; 2]],
}

impl TurnTrack<'_> {
    /// Position at which the heading has changed by an angle (rad), linear between rows; `None` if the turn ends before
    /// this angle.
    fn at(&self, side: f64, angle: f64) -> Option<[f64; 2]> {
        let change = |row: usize| side * (self.heading[row] - self.heading[0]);
        let rows = self.heading.len().min(self.track.len());
        let row = (0..rows).find(|&row| change(row) >= angle)?;
        let Some(before) = row.checked_sub(1) else { return Some(self.track[0]) };
        let share = (angle - change(before)) / (change(row) - change(before));
        Some([0, 1].map(|axis| self.track[before][axis] + share * (self.track[row][axis] - self.track[before][axis])))
    }
}

/// Median track (north, east; unit of the tracks) of turns to one side (±1), up to the change of heading that half of
/// them reach, and at most [`MAX_TRACK_RAD`]; empty without a turn.
pub(crate) fn median_track(turns: &[TurnTrack], side: f64) -> Vec<[f64; 2]> {
    let place = |point: usize| {
        let places: Vec<[f64; 2]> = turns.iter().filter_map(|turn| turn.at(side, point as f64 * STEP)).collect();
        let is_enough = !places.is_empty() && 2 * places.len() >= turns.len();
        is_enough
            .then(|| [0, 1].map(|axis| quantiles(&mut places.iter().map(|place| place[axis]).collect::<Vec<f64>>())[2]))
    };
    (0..=(MAX_TRACK_RAD / STEP).round() as usize).map_while(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half circles to port, of radii 1, 2 and 4: the median has an advance at 90° of 2 and a diameter of 4.
    #[test]
    fn the_median_circle_has_the_median_figures() {
        let rows = 181;
        let heading: Vec<f64> = (0..rows).map(|row| -f64::from(row).to_radians()).collect();
        let track = |radius: f64| -> Vec<[f64; 2]> {
            heading.iter().map(|psi| [radius * -psi.sin(), radius * (psi.cos() - 1.0)]).collect()
        };
        let tracks = [1.0, 2.0, 4.0].map(track);
        let turns: Vec<TurnTrack> = tracks.iter().map(|track| TurnTrack { heading: &heading, track }).collect();
        let median = median_track(&turns, -1.0);
        assert_eq!(median.len(), 61);
        let is_near = |[north, east]: [f64; 2], expected: [f64; 2]| {
            (north - expected[0]).abs() < 1e-9 && (east - expected[1]).abs() < 1e-9
        };
        assert!(is_near(median[30], [2.0, -2.0]) && is_near(median[60], [0.0, -4.0]), "{:?}", median[30]);
        assert!(median_track(&[], 1.0).is_empty());
        // Two circles are shown as far as a recorded track is.
        let heading: Vec<f64> = (0..=720).map(|row| f64::from(row).to_radians()).collect();
        let turn = TurnTrack { heading: &heading, track: &vec![[0.0; 2]; 721] };
        assert_eq!((median_track(&[turn], 1.0).len() - 1) as f64 * STEP, MAX_TRACK_RAD);
    }
}
