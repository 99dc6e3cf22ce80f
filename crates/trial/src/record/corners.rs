//! Corners of the rudder between rows. A steering gear rests or moves at a constant rate, so the rudder is a polyline;
//! two neighbouring straight pieces meet at an instant between two rows.

use ship::Polyline;

/// Tolerance of a rudder rate, as a share of the rate of the gear.
const RATE_TOLERANCE: f64 = 0.002;

/// Minimum share of the intervals in which the rudder rests or moves at the rate of the gear.
const MIN_STRAIGHT_SHARE: f64 = 2.0 / 3.0;

/// Maximum share of bent intervals with a corner that cannot be located.
const MAX_UNRESOLVED_SHARE: f64 = 0.25;

/// Distance from a row, as a share of the interval, within which a corner coincides with the row.
const ROW_TOLERANCE: f64 = 1e-6;

/// Instant between two rows at which the rudder changes its rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RudderCorner {
    /// Row before the corner.
    pub row_before: usize,
    /// Time, s.
    pub time: f64,
    /// Rudder rate from the row to the corner, rad/s.
    pub rate_before: f64,
    /// Rudder rate from the corner to the next row, rad/s.
    pub rate_after: f64,
}

/// Recorded rudder: its rows and the corners between them.
#[derive(Debug, Clone)]
pub(super) struct RecordedRudder {
    /// Rudder angle at the rows.
    pub rows: Polyline,
    /// Corners between the rows.
    pub corners: Vec<RudderCorner>,
    /// Rows and corners together; `None` without corners.
    path: Option<Polyline>,
}

impl RecordedRudder {
    /// Recorded rudder with the corners implied by its rows.
    pub fn new(rows: Polyline) -> Self {
        let corners = corners(&rows);
        let path = (!corners.is_empty()).then(|| through(&rows, &corners)).flatten();
        Self { rows, corners, path }
    }

    /// Rudder as a signal, through rows and corners.
    pub fn path(&self) -> &Polyline {
        self.path.as_ref().unwrap_or(&self.rows)
    }
}

/// Rows with the corners between them; `None` if a corner is not between its rows.
fn through(rows: &Polyline, corners: &[RudderCorner]) -> Option<Polyline> {
    let points = rows.times().len() + corners.len();
    let (mut time, mut angle) = (Vec::with_capacity(points), Vec::with_capacity(points));
    let mut corners = corners.iter().peekable();
    for (row, (&t, &delta)) in rows.times().iter().zip(rows.values()).enumerate() {
        time.push(t);
        angle.push(delta);
        if let Some(corner) = corners.next_if(|corner| corner.row_before == row) {
            time.push(corner.time);
            angle.push(delta + corner.rate_before * (corner.time - t));
        }
    }
    Polyline::new(time, angle).ok()
}

/// Movement of the rudder in an interval between two rows.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Piece {
    /// Constant rate, rad/s: 0, or that of the gear to either side.
    Straight(f64),
    /// A corner lies in the interval.
    Bent,
}

/// Corners of a rudder that rests or moves at the rate of the gear, in the order of time.
///
/// δ(t) = δ_i + δ̇₁ (t − t_i) before the corner and δ_(i+1) − δ̇₂ (t_(i+1) − t) after it, where δ̇₁ and δ̇₂ are the
/// rates of the neighbouring intervals; if a neighbour is bent itself, the rudder moves in it at the rate of the gear.
/// Empty if the rudder has no constant rate: noise, whole degrees, another kind of steering. A stroke that begins
/// and ends between the same two rows is not detected.
fn corners(rudder: &Polyline) -> Vec<RudderCorner> {
    let (time, angle) = (rudder.times(), rudder.values());
    let slopes: Vec<f64> =
        time.windows(2).zip(angle.windows(2)).map(|(t, delta)| (delta[1] - delta[0]) / (t[1] - t[0])).collect();
    let Some(rate) = rate(&slopes) else { return Vec::new() };
    let tolerance = RATE_TOLERANCE * rate;
    let piece = |slope: f64| match slope.abs() {
        size if size <= tolerance => Some(Piece::Straight(slope)),
        size if (size - rate).abs() <= tolerance => Some(Piece::Straight(slope)),
        size if size < rate => Some(Piece::Bent),
        // No gear with this rate moves so fast.
        _ => None,
    };
    let Some(pieces) = slopes.iter().map(|&slope| piece(slope)).collect::<Option<Vec<Piece>>>() else {
        return Vec::new();
    };
    let straight = pieces.iter().filter(|piece| **piece != Piece::Bent).count();
    if (straight as f64) < MIN_STRAIGHT_SHARE * pieces.len() as f64 {
        return Vec::new();
    }
    let bent: Vec<usize> = (1..pieces.len().saturating_sub(1)).filter(|&row| pieces[row] == Piece::Bent).collect();
    let corners: Vec<RudderCorner> = (bent.iter())
        .filter_map(|&row| {
            let (duration, step) = (time[row + 1] - time[row], angle[row + 1] - angle[row]);
            let moving = rate.copysign(step);
            let (before, after) = match (pieces[row - 1], pieces[row + 1]) {
                (Piece::Straight(before), Piece::Straight(after)) => (before, after),
                // A stroke with one row in it: it begins or ends at rest.
                (Piece::Straight(before), Piece::Bent) if before.abs() <= tolerance => (before, moving),
                (Piece::Bent, Piece::Straight(after)) if after.abs() <= tolerance => (moving, after),
                _ => return None,
            };
            if (before - after).abs() <= tolerance {
                return None;
            }
            let elapsed = (step - after * duration) / (before - after);
            let inside = ROW_TOLERANCE * duration..=(1.0 - ROW_TOLERANCE) * duration;
            inside.contains(&elapsed).then(|| RudderCorner {
                row_before: row,
                time: time[row] + elapsed,
                rate_before: before,
                rate_after: after,
            })
        })
        .collect();
    // A rudder with many other bends does not move at a constant rate.
    if (bent.len() - corners.len()) as f64 <= MAX_UNRESOLVED_SHARE * bent.len() as f64 { corners } else { Vec::new() }
}

/// Rate of the gear, rad/s: the common rate of successive intervals of equal slope. `None` if there are no such
/// intervals or their rates differ.
fn rate(slopes: &[f64]) -> Option<f64> {
    let steady = slopes.windows(2).filter(|pair| {
        let size = pair[0].abs().max(pair[1].abs());
        size > 0.0 && (pair[0] - pair[1]).abs() <= RATE_TOLERANCE * size
    });
    let (lowest, highest) = steady
        .map(|pair| pair[0].abs())
        .fold((f64::INFINITY, 0.0_f64), |(low, high), size| (low.min(size), high.max(size)));
    (highest > 0.0 && highest - lowest <= RATE_TOLERANCE * highest).then_some(0.5 * (lowest + highest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    /// A rudder through the given corners, read every `period` seconds.
    fn read(path: &[(f64, f64)], period: f64, reading: impl Fn(f64) -> f64) -> Polyline {
        let (time, angle) = path.iter().copied().unzip();
        let path = Polyline::new(time, angle).expect("a path");
        let rows = (path.times()[path.times().len() - 1] / period) as usize;
        let time: Vec<f64> = (0..=rows).map(|row| row as f64 * period).collect();
        let angle = time.iter().map(|&t| reading(path.value_at(t))).collect();
        Polyline::new(time, angle).expect("rows")
    }

    /// Strokes of 2.5 per second between ±10.
    const STROKES: [(f64, f64); 8] =
        [(0.0, 0.0), (3.3, 0.0), (7.3, 10.0), (30.8, 10.0), (38.8, -10.0), (70.1, -10.0), (78.1, 10.0), (120.0, 10.0)];

    #[test]
    fn corners_of_a_gear_are_found_where_they_are() {
        for period in [0.5, 1.0, 2.0] {
            let located = corners(&read(&STROKES, period, |angle| angle));
            let expected = STROKES[1..7].iter().filter(|(t, _)| (t / period).fract() > 1e-6);
            assert_eq!(located.len(), expected.clone().count(), "{period}: {located:?}");
            for (corner, (t, _)) in located.iter().zip(expected) {
                assert_abs_diff_eq!(corner.time, *t, epsilon = 1e-9);
                assert_eq!(corner.row_before, (t / period) as usize);
            }
        }
    }

    #[test]
    fn a_stroke_with_one_row_in_it_has_the_rate_of_the_others() {
        let path = [(0.0, 0.0), (3.3, 0.0), (13.3, 25.0), (30.3, 25.0), (31.6, 21.75), (60.0, 21.75)];
        let located = corners(&read(&path, 1.0, |angle| angle));
        assert_eq!(located.len(), 4, "{located:?}");
        assert_abs_diff_eq!(located[2].time, 30.3, epsilon = 1e-9);
        assert_abs_diff_eq!(located[3].time, 31.6, epsilon = 1e-9);
    }

    #[test]
    fn a_rudder_without_one_rate_keeps_its_rows() {
        let whole_degrees = read(&STROKES, 1.0, f64::round);
        // A rudder that never rests, and one that jumps.
        let clipped = (0..200).map(|t| (3.0 * (f64::from(t) / 6.0).sin()).clamp(-1.0, 1.0)).collect();
        let clipped = Polyline::new((0..200).map(f64::from).collect(), clipped).expect("rows");
        let smooth = Polyline::new((0..200).map(f64::from).collect(), (0..200).map(|t| f64::from(t).sin()).collect());
        let jumps = (0..60).map(|t| if t % 20 < 10 { 10.0 } else { -10.0 }).collect();
        let jumps = Polyline::new((0..60).map(f64::from).collect(), jumps);
        let still = Polyline::new((0..9).map(f64::from).collect(), vec![1.0; 9]);
        for rudder in [whole_degrees, clipped, smooth.expect("rows"), jumps.expect("rows"), still.expect("rows")] {
            assert_eq!(corners(&rudder), []);
        }
        let noisy = read(&STROKES, 1.0, |angle| angle + 0.1 * (angle * 7919.0 + 3.0).sin());
        assert_eq!(corners(&noisy).len(), 0);
    }
}
