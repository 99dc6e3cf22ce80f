//! Movements of the rudder between its holds: start time, angle before and rate. Works on ramps, on orders that jump
//! within a sample, and on quantised, drifting and noisy rudders. Whether the first movement of a record is the first
//! execute of the trial depends on the heading; see `characteristics`.

use super::holds::{Hold, MIN_HOLD_ANGLE_SHARE};
use document::Quantity;
use estimation::statistics::median;

/// Minimum change between two rows of a moving rudder, in standard deviations of its noise and as a share of the
/// movement.
const MIN_MOVING: (f64, f64) = (4.0, 0.01);

/// Movement of the rudder into a hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RudderMovement {
    /// Time at which the rudder starts to move, s.
    pub start_time: Quantity,
    /// Rudder angle before, rad: median of the rows just before the start.
    pub rudder_before: f64,
    /// Rudder angle after, rad: median of the hold.
    pub rudder_after: f64,
    /// Last row at the level before.
    pub last_row_before: usize,
    /// Rate of the rudder, rad/s, signed; `None` with fewer than two rows on its ramp, or if their line runs backwards.
    pub rate: Option<f64>,
    /// Lower bound of the rate of a movement with a single row on its ramp, rad/s; otherwise `None`.
    least_rate: Option<f64>,
}

/// Angle of a rudder at rest: a median of rows.
#[derive(Clone, Copy)]
struct Level {
    angle: f64,
    /// Standard deviation per unit standard deviation of the rudder noise.
    gain: f64,
}

impl Level {
    fn from_rows(rows: &mut [f64]) -> Option<Self> {
        let n = rows.len() as f64;
        // A median of many rows has π/2 the variance of their mean.
        let gain = if n < 3.0 { 1.0 / n.sqrt() } else { (0.5 * std::f64::consts::PI / n).sqrt() };
        median(rows).map(|angle| Self { angle, gain })
    }
}

/// Rudder channel with its holds, noise and rate.
pub struct RudderMovements<'a> {
    time: &'a [f64],
    angle: &'a [f64],
    holds: &'a [Hold],
    /// Standard deviation of the rudder noise, rad; at least the rounding error of the channel.
    noise_sd: f64,
    /// Rate of the rudder, rad/s: median over the reversals that the sampling resolves, a lower bound if a ramp is
    /// about as long as a sampling interval, `None` if it is shorter.
    pub rate: Option<f64>,
    /// `true` if the rate is a lower bound.
    rate_is_bound: bool,
}

impl<'a> RudderMovements<'a> {
    /// Movements of a rudder (rad) over time (s) between its holds. The standard deviation of its noise is
    /// `declared_noise` (rad), else estimated from row to row within the holds.
    pub fn new(time: &'a [f64], angle: &'a [f64], holds: &'a [Hold], declared_noise: Option<f64>) -> Self {
        let noise = declared_noise.unwrap_or_else(|| {
            let mut steps: Vec<f64> = holds
                .iter()
                .flat_map(|hold| angle[hold.first_row..=hold.last_row].windows(2))
                .map(|pair| (pair[1] - pair[0]).abs())
                .collect();
            // A step between rows contains the noise of both.
            median(&mut steps).map_or(0.0, |step| 1.4826 * step / std::f64::consts::SQRT_2)
        });
        let noise = noise.max(quantum(angle) / 12.0_f64.sqrt());
        let mut rudder = Self { time, angle, holds, noise_sd: noise, rate: None, rate_is_bound: false };
        let reversals: Vec<RudderMovement> = (1..holds.len()).map(|index| rudder.reversal(index)).collect();
        let mut rates: Vec<f64> = reversals.iter().filter_map(|reversal| reversal.rate).map(f64::abs).collect();
        // If most reversals have a single row on the ramp, a ramp is about as long as a sampling interval, and the
        // tightest bound is near the rate. If few have, ramps are much shorter and the rate remains unknown.
        let bounds: Vec<f64> = reversals.iter().filter_map(|reversal| reversal.least_rate).collect();
        let tightest = bounds.iter().copied().max_by(f64::total_cmp).filter(|_| 2 * bounds.len() >= reversals.len());
        rudder.rate = median(&mut rates).or(tightest);
        rudder.rate_is_bound = rates.is_empty() && tightest.is_some();
        rudder
    }

    /// Movement into hold `index` from the previous hold; `index` is 1 or more.
    pub fn reversal(&self, index: usize) -> RudderMovement {
        let (from, to) = (&self.holds[index - 1], &self.holds[index]);
        let foot = self.foot(from.median_angle, to);
        let window = 0.25 * (self.time[from.last_row] - self.time[from.first_row]);
        // The foot may already be moving: in a short hold such rows would distort the level.
        let way = to.median_angle - from.median_angle;
        let is_under_way = |row: usize| {
            let step = (self.angle[row] - self.angle[row - 1]) * way.signum();
            step > (MIN_MOVING.0 * self.noise_sd).max(MIN_MOVING.1 * way.abs())
        };
        let mut row = foot.min(from.last_row);
        while row > from.first_row && is_under_way(row) {
            row -= 1;
        }
        let first = self.time.partition_point(|&t| t < self.time[row] - window).min(row);
        let before = Level::from_rows(&mut self.angle[first..=row].to_vec()).expect("the row itself is in the window");
        self.movement(before, to)
    }

    /// Movement into the first hold from the steering before it; `None` if the record starts in the hold.
    pub fn first_movement(&self) -> Option<RudderMovement> {
        let to = &self.holds[0];
        if to.first_row == 0 {
            return None;
        }
        // The search goes back along the steep part: manual steering may already have moved the rudder to the same
        // side.
        let steps = (self.time[to.first_row] - self.time[0]) / to.first_row as f64;
        let rate = self.rate.unwrap_or(2.0 * to.median_angle.abs() / steps);
        // Minimum length at which a ramp exceeds the noise.
        let look_back = (0.2 * to.median_angle.abs()).max(8.0 * self.noise_sd) / rate;
        let mut row = to.first_row;
        while row > 0 {
            let earlier = row_before(self.time, row, look_back).min(row - 1);
            let gain = to.side * (self.angle[row] - self.angle[earlier]);
            let steep = (0.3 * rate * (self.time[row] - self.time[earlier])).min(0.15 * to.median_angle.abs());
            if gain < steep {
                break;
            }
            row -= 1;
        }
        // The lookback ends a little after the true foot. The angle just before it is used, not the mean of the
        // steering before.
        let clear = row_before(self.time, row, 0.3 * look_back);
        let tolerance = (0.1 * to.median_angle.abs()).max(5.0 * self.noise_sd);
        let near = |&earlier: &usize| (self.angle[earlier] - self.angle[clear]).abs() <= tolerance;
        let mut steady: Vec<f64> = (0..=clear).rev().take_while(near).map(|row| self.angle[row]).collect();
        Some(self.movement(Level::from_rows(&mut steady)?, to))
    }

    /// Last row before a hold at which the rudder has moved at most a tenth of the way from `before`.
    fn foot(&self, before: f64, to: &Hold) -> usize {
        (0..to.first_row).rev().find(|&row| progress(self.angle[row], before, to.median_angle) <= 0.1).unwrap_or(0)
    }

    /// Movement from a level into a hold. It starts at the intersection of the line through its ramp with the level, as
    /// far as the sampling resolves the ramp.
    fn movement(&self, level: Level, to: &Hold) -> RudderMovement {
        let before = level.angle;
        let foot = self.foot(before, to);
        let (earliest, latest) = (self.time[foot], self.time[to.first_row]);
        let ramp: Vec<usize> = (foot + 1..=to.first_row)
            .filter(|&row| (0.1..0.9).contains(&progress(self.angle[row], before, to.median_angle)))
            .collect();
        let travel = to.median_angle - before;
        let mut least_rate = None;
        let (start, rate) = match (ramp.as_slice(), self.rate) {
            ([_, _, ..], _) => match self.line_start(&ramp, level, travel.signum()) {
                Some((start, rate)) => (start, Some(rate)),
                None => (uniform(earliest, latest), None),
            },
            (&[row], common) => {
                let way = (self.angle[row] - before).abs();
                match common {
                    Some(rate) => {
                        let noise = 1.0_f64.hypot(level.gain) * self.noise_sd / rate;
                        let speed = if self.rate_is_bound { way / rate / 12.0_f64.sqrt() } else { 0.0 };
                        (Quantity::new(self.time[row] - way / rate, Some(noise.hypot(speed))), None)
                    }
                    None => {
                        let next = (row + 1).min(self.time.len() - 1);
                        let slowest = (way / (self.time[row] - earliest)).max(
                            (travel.abs() - way).max(0.0) / (self.time[next] - self.time[row]).max(f64::MIN_POSITIVE),
                        );
                        least_rate = Some(slowest);
                        (uniform(self.time[row] - way / slowest, self.time[row]), None)
                    }
                }
            }
            ([], rate) => {
                // A faster rudder may have started later: a lower bound of the rate leaves the whole interval.
                let under_way =
                    rate.filter(|_| !self.rate_is_bound).map_or(0.0, |rate| MIN_HOLD_ANGLE_SHARE * travel.abs() / rate);
                (uniform(earliest, (latest - under_way).max(earliest)), None)
            }
        };
        // Noise can shift the foot of a line far; the rudder did not move before the record or after it was laid.
        let start = Quantity { value: start.value.clamp(self.time[0], latest), ..start };
        RudderMovement {
            start_time: start,
            rudder_before: before,
            rudder_after: to.median_angle,
            last_row_before: foot,
            rate,
            least_rate,
        }
    }

    /// Least-squares line through the rows of a ramp: the time at which it leaves `level`, and its rate (rad/s,
    /// signed). `None` if the line runs against `direction`.
    ///
    /// A steering gear has a constant rate. A ramp whose rate agrees with the common rate within its uncertainty takes
    /// the common rate: a short ramp in whole degrees is then timed far better.
    fn line_start(&self, ramp: &[usize], level: Level, direction: f64) -> Option<(Quantity, f64)> {
        let n = ramp.len() as f64;
        let mean_time = ramp.iter().map(|&row| self.time[row]).sum::<f64>() / n;
        let mean_angle = ramp.iter().map(|&row| self.angle[row]).sum::<f64>() / n;
        let off = |&row: &usize| (self.time[row] - mean_time, self.angle[row] - mean_angle);
        let (tt, ta) = ramp.iter().map(off).fold((0.0, 0.0), |(tt, ta), (t, angle)| (tt + t * t, ta + t * angle));
        let ramp_rate = ta / tt;
        if direction * ramp_rate <= 0.0 {
            return None;
        }
        let squares: f64 = ramp.iter().map(off).map(|(t, angle)| (angle - ramp_rate * t).powi(2)).sum();
        let scatter = if ramp.len() > 2 { (squares / (n - 2.0)).sqrt() } else { 0.0 };
        let noise = self.noise_sd.max(scatter);
        let common =
            self.rate.map(|rate| direction * rate).filter(|rate| (rate - ramp_rate).abs() <= 3.0 * noise / tt.sqrt());
        let rate = common.unwrap_or(ramp_rate);
        let start = mean_time + (level.angle - mean_angle) / rate;
        let lever = if common.is_some() { 0.0 } else { (start - mean_time).powi(2) / tt };
        let gain = (1.0 / n + lever + level.gain * level.gain).sqrt();
        Some((Quantity::new(start, Some(noise / rate.abs() * gain)), ramp_rate))
    }
}

/// Last row at least `by` seconds before another row, or the first row.
pub(crate) fn row_before(time: &[f64], row: usize, by: f64) -> usize {
    time.partition_point(|&t| t <= time[row] - by).saturating_sub(1).min(row)
}

/// Resolution of a rounded channel, in its unit: the minimum distance between two of its values. Close to zero for a
/// channel that is not rounded, 0 for a constant channel.
pub(crate) fn quantum(angle: &[f64]) -> f64 {
    let mut values = angle.to_vec();
    values.sort_unstable_by(f64::total_cmp);
    // Values that differ by rounding of the arithmetic count as equal.
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]).filter(|&step| step > 1e-9);
    steps.min_by(f64::total_cmp).unwrap_or(0.0)
}

/// Completed share of the movement of the rudder from `before` to `after`.
fn progress(angle: f64, before: f64, after: f64) -> f64 {
    (angle - before) / (after - before)
}

/// Midpoint of the interval of an event, with the standard deviation of a uniform distribution.
fn uniform(from: f64, to: f64) -> Quantity {
    Quantity::new(0.5 * (from + to), Some((to - from).max(0.0) / 12.0_f64.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::zigzag::holds::holds;
    use approx::assert_relative_eq;
    use ship::angle::{from_deg, to_deg};

    /// A rudder that leaves 0 at 10 s, +δ at 40 s and −δ at 80 s, at `rate` (rad/s).
    fn rudder_at(t: f64, delta: f64, rate: f64) -> f64 {
        let first = (rate * (t - 10.0)).clamp(0.0, delta);
        let second = (rate * (t - 40.0)).clamp(0.0, 2.0 * delta);
        let third = (rate * (t - 80.0)).clamp(0.0, 2.0 * delta);
        first - second + third
    }

    fn starts(time: &[f64], rudder: &[f64]) -> Vec<Quantity> {
        let holds = holds(rudder).expect("two reversals");
        let rudder = RudderMovements::new(time, rudder, &holds, None);
        let first = rudder.first_movement().expect("starts before the hold").start_time;
        std::iter::once(first).chain((1..holds.len()).map(|index| rudder.reversal(index).start_time)).collect()
    }

    #[test]
    fn a_ramp_is_timed_where_it_leaves_its_level() {
        let rate = from_deg(2.5);
        for (step, delta_deg) in [(1.0, 10.0), (1.0, 5.0), (0.7, 20.0), (0.1, 3.0), (2.0, 20.0)] {
            let time: Vec<f64> = (0..(110.0 / step) as usize).map(|k| k as f64 * step).collect();
            let angle: Vec<f64> = time.iter().map(|&t| rudder_at(t, from_deg(delta_deg), rate)).collect();
            for (start, expected) in starts(&time, &angle).iter().zip([10.0, 40.0, 80.0]) {
                assert_relative_eq!(start.value, expected, epsilon = 1e-9);
            }
        }
    }

    #[test]
    fn a_jump_is_timed_to_the_middle_of_its_interval() {
        let time: Vec<f64> = (0..110).map(f64::from).collect();
        let angle: Vec<f64> = time.iter().map(|&t| rudder_at(t - 0.3, 0.2, 1e6)).collect();
        for (start, expected) in starts(&time, &angle).iter().zip([10.5, 40.5, 80.5]) {
            assert_relative_eq!(start.value, expected, epsilon = 1e-9);
            assert_relative_eq!(start.sd.expect("known from the step"), 1.0 / 12.0_f64.sqrt(), epsilon = 1e-9);
        }
    }

    /// Whole degrees at 2.5 deg/s: a line through the steps misses the start by less than their length in time.
    #[test]
    fn quantised_ramps_and_drifting_offsets_are_timed_within_half_a_second() {
        let time: Vec<f64> = (0..220).map(|k| 0.5 * f64::from(k)).collect();
        let angle: Vec<f64> = time
            .iter()
            .map(|&t| from_deg(to_deg(rudder_at(t, from_deg(10.0), from_deg(2.5)) + 0.01 * (t / 60.0).sin()).round()))
            .collect();
        for (start, expected) in starts(&time, &angle).iter().zip([10.0, 40.0, 80.0]) {
            assert!((start.value - expected).abs() < 0.5, "{} for {expected}", start.value);
        }
    }

    /// A ship that turns fast reverses the rudder soon after it rests.
    #[test]
    fn a_movement_after_a_short_hold_starts_at_its_corner() {
        let rate = from_deg(2.5);
        for rest in [3.0, 5.0, 9.0] {
            let time: Vec<f64> = (0..120).map(f64::from).collect();
            // To 20° from 10.4 s on, back after a rest, and over again.
            let (there, back) = (18.4, 18.4 + rest);
            let of = |t: f64| {
                let first = (rate * (t - 10.4)).clamp(0.0, from_deg(20.0));
                let second = (rate * (t - back)).clamp(0.0, from_deg(40.0));
                first - second + (rate * (t - 70.0)).clamp(0.0, from_deg(40.0))
            };
            assert!(there < back);
            let angle: Vec<f64> = time.iter().map(|&t| of(t)).collect();
            assert_relative_eq!(starts(&time, &angle)[1].value, back, epsilon = 1e-6);
        }
    }

    /// The rudder is at 60 % of the angle to the same side at the time of the order.
    #[test]
    fn manual_steering_before_the_first_execute_does_not_move_it() {
        let time: Vec<f64> = (0..1100).map(|k| 0.1 * f64::from(k)).collect();
        let angle: Vec<f64> = time
            .iter()
            .map(|&t| if t < 10.0 { 0.02 * (6.0 * (t / 10.0).powi(3)).round() } else { rudder_at(t, 0.2, 1e6) })
            .collect();
        let starts = starts(&time, &angle);
        assert!((starts[0].value - 10.0).abs() < 0.11, "{}", starts[0].value);
    }
}
