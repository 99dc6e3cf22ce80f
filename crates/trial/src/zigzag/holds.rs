//! Holds of the rudder to either side, and the conventional angles of a trial. Works on drifting, quantised and noisy
//! rudders; the movements between holds are timed in `executes`.

use ship::angle::to_deg;

use super::findings::ZigZagError;
use estimation::statistics::median;

/// Minimum rudder angle of a hold, as a share of the median angle held on that side. It is high because manual
/// steering before a first execute can use more than half the rudder of the trial.
pub const MIN_HOLD_ANGLE_SHARE: f64 = 0.85;

/// Minimum rudder angle of a zig-zag, degrees.
const MIN_RUDDER_DEG: f64 = 0.5;

/// Minimum share of rows between first and last execute with the rudder held. A first-order 35/5 trial has 0.5, noise
/// 0.15.
const MIN_HELD_SHARE: f64 = 0.3;

/// Interval of rows over which the rudder is held at an angle to one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// +1 starboard, −1 port.
    pub side: f64,
    /// First row beyond [`MIN_HOLD_ANGLE_SHARE`] of the level.
    pub first_row: usize,
    /// Last row beyond [`MIN_HOLD_ANGLE_SHARE`] of the level.
    pub last_row: usize,
    /// Median rudder angle, rad, signed.
    pub median_angle: f64,
}

/// Holds of a record, alternating between the sides.
///
/// Fails if the rudder hardly moves, is not laid to both sides at least twice (two reversals), or is not held there.
pub(super) fn holds(rudder: &[f64]) -> Result<Vec<Hold>, ZigZagError> {
    let starboard = level(rudder, 1.0);
    let port = level(rudder, -1.0);
    let largest = starboard.max(port);
    if to_deg(largest) < MIN_RUDDER_DEG {
        return Err(ZigZagError::NoRudder { largest_deg: to_deg(largest), needed_deg: MIN_RUDDER_DEG });
    }
    // A neutral rudder of a degree or two in a turning circle is not a second side of a zig-zag.
    let side_of = |delta: f64| {
        [(1.0, starboard), (-1.0, port)]
            .into_iter()
            .find(|&(side, level)| level > 0.5 * largest && side * delta >= MIN_HOLD_ANGLE_SHARE * level)
            .map(|(side, _)| side)
    };
    let mut holds: Vec<Hold> = Vec::new();
    for (row, &delta) in rudder.iter().enumerate() {
        let Some(side) = side_of(delta) else { continue };
        match holds.last_mut() {
            Some(hold) if hold.side == side => hold.last_row = row,
            _ => holds.push(Hold { side, first_row: row, last_row: row, median_angle: 0.0 }),
        }
    }
    let reversals = holds.len().saturating_sub(1);
    if reversals < 2 {
        return Err(ZigZagError::TooFewReversals { reversals, needed: 2 });
    }
    for hold in &mut holds {
        hold.median_angle = median(&mut rudder[hold.first_row..=hold.last_row].to_vec())
            .expect("a hold has at least the row it began with");
    }
    let span = &rudder[holds[0].first_row..=holds[reversals].last_row];
    let held = span
        .iter()
        .filter(|&&delta| {
            let level = if delta > 0.0 { starboard } else { port };
            (delta.abs() - level).abs() <= 0.2 * level
        })
        .count();
    let share = held as f64 / span.len() as f64;
    if share < MIN_HELD_SHARE {
        return Err(ZigZagError::NotHeld { share, needed: MIN_HELD_SHARE });
    }
    Ok(holds)
}

/// Angle to which the rudder is laid on a side, rad; 0 if it is never on that side.
///
/// Median of the angles above 0.6 of the 98 % quantile: robust against spikes and the small angles of an approach.
fn level(rudder: &[f64], side: f64) -> f64 {
    let mut angles: Vec<f64> = rudder.iter().map(|delta| side * delta).filter(|&delta| delta > 0.0).collect();
    if angles.is_empty() {
        return 0.0;
    }
    angles.sort_unstable_by(f64::total_cmp);
    let top = angles[((angles.len() - 1) as f64 * 0.98).round() as usize];
    let first = angles.partition_point(|&delta| delta <= 0.6 * top);
    median(&mut angles[first..]).unwrap_or(0.0)
}

/// Conventional trial angle near a measured angle, degrees: 1, 2, 3 or a multiple of 5 within the tolerance, else a
/// whole degree.
///
/// `below` and `above` are tolerances of the measured angle as shares of the conventional angle; `slack_deg` is added
/// for the noise of the measurement. `None` for an angle that rounds to zero.
pub fn conventional_deg(measured_deg: f64, below: f64, above: f64, slack_deg: f64) -> Option<f64> {
    const CONVENTIONAL_DEG: [f64; 10] = [1.0, 2.0, 3.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0];
    // Small angles have an absolute error (a rudder offset, a late helm), hence a minimum tolerance.
    let near = |&nominal: &f64| {
        measured_deg >= nominal - (below * nominal).max(0.3) - slack_deg
            && measured_deg <= nominal + (above * nominal).max(0.5) + slack_deg
    };
    CONVENTIONAL_DEG
        .into_iter()
        .filter(near)
        .min_by(|a, b| (a - measured_deg).abs().total_cmp(&(b - measured_deg).abs()))
        .or_else(|| (measured_deg.round() >= 1.0).then(|| measured_deg.round()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conventional_angles() {
        let late_helm = |deg| conventional_deg(deg, 0.05, 0.25, 0.0);
        assert_eq!(late_helm(1.22), Some(1.0));
        assert_eq!(late_helm(5.7), Some(5.0));
        assert_eq!(late_helm(10.9), Some(10.0));
        assert_eq!(late_helm(22.4), Some(20.0));
        assert_eq!(late_helm(7.2), Some(7.0));
        assert_eq!(late_helm(0.2), None);
    }

    #[test]
    fn holds_alternate_whatever_the_spikes_and_the_return_amidships() {
        let mut rudder = [vec![0.0; 30], vec![0.2; 40], vec![-0.21; 50], vec![0.2; 40], vec![0.0; 30]].concat();
        rudder[10] = 0.15;
        rudder[80] = 0.05;
        rudder[100] = -0.6;
        let all = holds(&rudder).expect("two reversals");
        let rows: Vec<(f64, usize, usize)> =
            all.iter().map(|hold| (hold.side, hold.first_row, hold.last_row)).collect();
        assert_eq!(rows, [(1.0, 30, 69), (-1.0, 70, 119), (1.0, 120, 159)]);
        assert_eq!(all[1].median_angle, -0.21);
    }
}
