//! The planar equations stepped through a given yaw rate and rudder, in units of length and approach speed.

use super::coefficients::PlanarCoefficients;

/// Longest step in units of L/U₀; a ship loses its drift in about one.
pub(crate) const LARGEST_STEP: f64 = 0.05;

/// Most steps between two rows: a record may have a gap of days.
const MOST_STEPS: f64 = 1e4;

/// Speeds beyond this many approach speeds are no ship's; a bad trial step of a search stays finite.
const FASTEST: f64 = 10.0;

/// What turns a ship: yaw rate and rudder at given times.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drive<'a> {
    /// s, increasing.
    pub time: &'a [f64],
    /// rad/s.
    pub yaw_rate: &'a [f64],
    /// rad.
    pub rudder: &'a [f64],
}

/// Surge and sway, m/s, at all times of the drive, from those at the first.
///
/// Midpoint rule with yaw rate and rudder straight between the rows; steps end at the rows and are no longer than
/// [`LARGEST_STEP`].
pub(crate) fn velocities(
    coefficients: &PlanarCoefficients,
    [length, speed]: [f64; 2],
    drive: Drive,
    start: [f64; 2],
) -> Vec<[f64; 2]> {
    let second = length / speed;
    let [mut u, mut v] = start.map(|velocity| velocity / speed);
    let mut found = Vec::with_capacity(drive.time.len());
    let bounded = |value: f64| value.clamp(-FASTEST, FASTEST);
    for row in 0..drive.time.len() {
        if row > 0 {
            let span = (drive.time[row] - drive.time[row - 1]) / second;
            let pieces = (span / LARGEST_STEP).ceil().clamp(1.0, MOST_STEPS);
            let step = span / pieces;
            let (r, delta) = (drive.yaw_rate[row - 1] * second, drive.rudder[row - 1]);
            let rises = [drive.yaw_rate[row] * second - r, drive.rudder[row] - delta].map(|rise| rise / pieces);
            for piece in 0..pieces as usize {
                let at = |share: f64| {
                    let place = piece as f64 + share;
                    (r + place * rises[0], delta + place * rises[1])
                };
                let ((r0, d0), (r1, d1)) = (at(0.0), at(0.5));
                let [a, b] = coefficients.rates(u, v, r0, d0);
                let [a, b] = coefficients.rates(u + 0.5 * step * a, v + 0.5 * step * b, r1, d1);
                (u, v) = (bounded(u + step * a), bounded(v + step * b));
            }
        }
        found.push([u * speed, v * speed]);
    }
    found
}
