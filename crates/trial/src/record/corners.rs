//! Corners of a rudder between its rows. A steering gear holds its angle or moves at one rate, so the rudder is a chain
//! of straight pieces; where two pieces are seen in the rows, they meet at an instant between them.

use ship::Polyline;

/// Rates that differ by less than this share of the rate of the gear are the same.
const SAME_RATE: f64 = 0.002;

/// Share of the intervals in which the rudder has to rest or to move at the rate of the gear.
const PLAIN: f64 = 2.0 / 3.0;

/// Largest share of the bent intervals that may hold no corner which can be found.
const UNKNOWN: f64 = 0.25;

/// A corner this near to a row, as a share of the interval, is the row.
const AT_ROW: f64 = 1e-6;

/// An instant between two rows at which the rudder changes its rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// The row before it.
    pub row: usize,
    /// When, s.
    pub time: f64,
    /// Rudder rate from the row to the corner, rad/s.
    pub before: f64,
    /// Rudder rate from the corner to the next row, rad/s.
    pub after: f64,
}

/// A recorded rudder: its rows, and what lies between them.
#[derive(Debug, Clone)]
pub(super) struct RecordedRudder {
    /// The rows.
    pub rows: Polyline,
    /// The corners between them.
    pub corners: Vec<Corner>,
    /// Rows and corners together, where there are corners.
    path: Option<Polyline>,
}

impl RecordedRudder {
    /// Looks for corners between rows.
    pub fn new(rows: Polyline) -> Self {
        let corners = corners(&rows);
        let path = (!corners.is_empty()).then(|| through(&rows, &corners)).flatten();
        Self { rows, corners, path }
    }

    /// The rudder as a signal, through rows and corners.
    pub fn path(&self) -> &Polyline {
        self.path.as_ref().unwrap_or(&self.rows)
    }
}

/// Rows with the corners between them.
fn through(rows: &Polyline, corners: &[Corner]) -> Option<Polyline> {
    let points = rows.times().len() + corners.len();
    let (mut time, mut angle) = (Vec::with_capacity(points), Vec::with_capacity(points));
    let mut corners = corners.iter().peekable();
    for (row, (&t, &delta)) in rows.times().iter().zip(rows.values()).enumerate() {
        time.push(t);
        angle.push(delta);
        if let Some(corner) = corners.next_if(|corner| corner.row == row) {
            time.push(corner.time);
            angle.push(delta + corner.before * (corner.time - t));
        }
    }
    Polyline::new(time, angle).ok()
}

/// What the rudder does in an interval between two rows.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Piece {
    /// It moves at one of the rates −r, 0, +r of the gear: this one, rad/s.
    Plain(f64),
    /// There is a corner in it.
    Bent,
}

/// The corners of a rudder that rests or moves at one rate, in the order of time.
///
/// δ(t) = δ_i + ṙ₁ (t − t_i) before the corner and δ_(i+1) − ṙ₂ (t_(i+1) − t) after it, where ṙ₁ and ṙ₂ are those of
/// the intervals beside it; where one of these is bent itself, the rudder moves there at the rate of the gear. Empty
/// where the rudder has no one rate: noise, whole degrees, a helm of its own kind. A stroke that begins and ends
/// between the same two rows is not found.
fn corners(rudder: &Polyline) -> Vec<Corner> {
    let (time, angle) = (rudder.times(), rudder.values());
    let slopes: Vec<f64> =
        time.windows(2).zip(angle.windows(2)).map(|(t, delta)| (delta[1] - delta[0]) / (t[1] - t[0])).collect();
    let Some(rate) = rate(&slopes) else { return Vec::new() };
    let near = SAME_RATE * rate;
    let piece = |slope: f64| match slope.abs() {
        size if size <= near => Some(Piece::Plain(slope)),
        size if (size - rate).abs() <= near => Some(Piece::Plain(slope)),
        size if size < rate => Some(Piece::Bent),
        // No gear with this rate moves so fast.
        _ => None,
    };
    let Some(pieces) = slopes.iter().map(|&slope| piece(slope)).collect::<Option<Vec<Piece>>>() else {
        return Vec::new();
    };
    let plain = pieces.iter().filter(|piece| **piece != Piece::Bent).count();
    if (plain as f64) < PLAIN * pieces.len() as f64 {
        return Vec::new();
    }
    let bent: Vec<usize> = (1..pieces.len().saturating_sub(1)).filter(|&row| pieces[row] == Piece::Bent).collect();
    let found: Vec<Corner> = (bent.iter())
        .filter_map(|&row| {
            let (length, step) = (time[row + 1] - time[row], angle[row + 1] - angle[row]);
            let moving = rate.copysign(step);
            let (before, after) = match (pieces[row - 1], pieces[row + 1]) {
                (Piece::Plain(before), Piece::Plain(after)) => (before, after),
                // A stroke with one row in it: it leaves a rest, or comes to one.
                (Piece::Plain(before), Piece::Bent) if before.abs() <= near => (before, moving),
                (Piece::Bent, Piece::Plain(after)) if after.abs() <= near => (moving, after),
                _ => return None,
            };
            if (before - after).abs() <= near {
                return None;
            }
            let elapsed = (step - after * length) / (before - after);
            let inside = AT_ROW * length..=(1.0 - AT_ROW) * length;
            inside.contains(&elapsed).then(|| Corner { row, time: time[row] + elapsed, before, after })
        })
        .collect();
    // A rudder that bends in many other places is moved by another law.
    if (bent.len() - found.len()) as f64 <= UNKNOWN * bent.len() as f64 { found } else { Vec::new() }
}

/// The rate of the gear, rad/s: that of all intervals in a row which the rudder crosses at one rate. `None` where there
/// are none, or where they differ.
fn rate(slopes: &[f64]) -> Option<f64> {
    let steady = slopes.windows(2).filter(|pair| {
        let size = pair[0].abs().max(pair[1].abs());
        size > 0.0 && (pair[0] - pair[1]).abs() <= SAME_RATE * size
    });
    let (lowest, highest) = steady
        .map(|pair| pair[0].abs())
        .fold((f64::INFINITY, 0.0_f64), |(low, high), size| (low.min(size), high.max(size)));
    (highest > 0.0 && highest - lowest <= SAME_RATE * highest).then_some(0.5 * (lowest + highest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    /// A rudder through the given corners, read every `period` seconds.
    fn read(path: &[(f64, f64)], period: f64, of: impl Fn(f64) -> f64) -> Polyline {
        let (time, angle) = path.iter().copied().unzip();
        let path = Polyline::new(time, angle).expect("a path");
        let rows = (path.times()[path.times().len() - 1] / period) as usize;
        let time: Vec<f64> = (0..=rows).map(|row| row as f64 * period).collect();
        let angle = time.iter().map(|&t| of(path.at(t))).collect();
        Polyline::new(time, angle).expect("rows")
    }

    /// Strokes of 2.5 a second between ±10.
    const STROKES: [(f64, f64); 8] =
        [(0.0, 0.0), (3.3, 0.0), (7.3, 10.0), (30.8, 10.0), (38.8, -10.0), (70.1, -10.0), (78.1, 10.0), (120.0, 10.0)];

    #[test]
    fn corners_of_a_gear_are_found_where_they_are() {
        for period in [0.5, 1.0, 2.0] {
            let found = corners(&read(&STROKES, period, |angle| angle));
            let expected = STROKES[1..7].iter().filter(|(t, _)| (t / period).fract() > 1e-6);
            assert_eq!(found.len(), expected.clone().count(), "{period}: {found:?}");
            for (corner, (t, _)) in found.iter().zip(expected) {
                assert_abs_diff_eq!(corner.time, *t, epsilon = 1e-9);
                assert_eq!(corner.row, (t / period) as usize);
            }
        }
    }

    #[test]
    fn a_stroke_with_one_row_in_it_has_the_rate_of_the_others() {
        let path = [(0.0, 0.0), (3.3, 0.0), (13.3, 25.0), (30.3, 25.0), (31.6, 21.75), (60.0, 21.75)];
        let found = corners(&read(&path, 1.0, |angle| angle));
        assert_eq!(found.len(), 4, "{found:?}");
        assert_abs_diff_eq!(found[2].time, 30.3, epsilon = 1e-9);
        assert_abs_diff_eq!(found[3].time, 31.6, epsilon = 1e-9);
    }

    #[test]
    fn a_rudder_without_one_rate_keeps_its_rows() {
        let whole_degrees = read(&STROKES, 1.0, f64::round);
        // A helm that is never at rest, and one that jumps.
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
