//! Steering gear: the rudder angle that results from the orders. For a constant order the rudder path has a closed
//! form, so the path is a list of segments with exact ends and is not integrated. Orders are given in [`crate::helm`].

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::angle::from_deg;
use ship::{Polyline, Ship};
use trial::degrees::Degrees;

use crate::error::{self, Check};

/// Steering gear with optional rate limit, lag, dead time, dead band and stops.
///
/// δ' = ±min(rate, |δ_c − δ| / lag) while |δ_c − δ| > dead band, with δ_c the order one dead time ago, clamped to the
/// stops; the pump stops as soon as the error is inside the dead band.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SteeringGear {
    /// Rudder rate; the default is the rate of the ship, or an instantaneous rudder if the source of the ship gives
    /// none.
    #[serde(rename = "rate-deg-s", with = "Degrees::<Option<f64>>")]
    pub rudder_rate: Option<f64>,
    /// Time constant of the exponential approach to the order.
    #[serde(rename = "lag-s")]
    pub lag: f64,
    /// Time from order to first movement.
    #[serde(rename = "dead-time-s")]
    pub dead_time: f64,
    /// Error at which the pump stops, and below which it does not start.
    #[serde(rename = "dead-band-deg", with = "Degrees::<f64>")]
    pub dead_band: f64,
    /// Maximum rudder angle to either side; the default is that of the ship, or 90° if the source of the ship gives
    /// none.
    #[serde(rename = "maximum-deg", with = "Degrees::<Option<f64>>")]
    pub max_rudder: Option<f64>,
}

/// Motion of the rudder within one [`RudderSegment`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RudderMotion {
    /// Constant angle.
    Hold,
    /// Constant rate, rad/s.
    Ramp {
        /// Rate with its sign, rad/s.
        rate: f64,
    },
    /// Exponential approach to `target`: target + (angle − target) exp(−(t − start)/lag).
    Exponential {
        /// Angle approached, rad.
        target: f64,
        /// Time constant, s.
        lag: f64,
    },
}

/// Piece of a rudder path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RudderSegment {
    /// Beginning, s; −∞ for the first segment.
    pub start: f64,
    /// End, s; +∞ for the last segment.
    pub end: f64,
    /// Rudder angle at the beginning, rad.
    pub angle: f64,
    /// Motion from the beginning.
    pub motion: RudderMotion,
}

impl RudderSegment {
    /// Rudder angle, rad, at time `t`, s; also valid just outside the segment, as its smooth continuation.
    #[inline]
    pub fn angle_at(&self, t: f64) -> f64 {
        match self.motion {
            RudderMotion::Hold => self.angle,
            RudderMotion::Ramp { rate } => self.angle + rate * (t - self.start),
            RudderMotion::Exponential { target, lag } => {
                target + (self.angle - target) * (-(t - self.start) / lag).exp()
            }
        }
    }
}

impl SteeringGear {
    /// Maximum angle of any rudder, deg.
    const MAX_DEG: f64 = 90.0;

    /// Gear with a rate limit, rad/s, only.
    pub fn with_rate(rate: f64) -> Self {
        Self { rudder_rate: Some(rate), ..Self::default() }
    }

    /// Gear with missing settings taken from a ship, if its source gives them; the maximum angle is otherwise 90°.
    pub fn with_ship_defaults(self, ship: &Ship) -> Self {
        Self {
            rudder_rate: self.rudder_rate.or(ship.rudder_rate),
            max_rudder: self.max_rudder.or(ship.largest_rudder).or(Some(from_deg(Self::MAX_DEG))),
            ..self
        }
    }

    /// Maximum rudder rate, rad/s; infinite without a rate limit.
    pub fn largest_rate(&self) -> f64 {
        self.rudder_rate.unwrap_or(f64::INFINITY)
    }

    /// Maximum rudder angle to either side, rad; infinite without stops.
    pub fn largest_rudder(&self) -> f64 {
        self.max_rudder.unwrap_or(f64::INFINITY)
    }

    /// Check of every value; fails with the first invalid value.
    pub fn check(&self) -> Check {
        error::check_positive_or_infinite("steering-gear.rate-deg-s", self.largest_rate())?;
        error::check_time("steering-gear.lag-s", self.lag)?;
        error::check_time("steering-gear.dead-time-s", self.dead_time)?;
        error::check_not_negative("steering-gear.dead-band-deg", self.dead_band)?;
        error::check_positive_or_infinite("steering-gear.maximum-deg", self.largest_rudder())
    }

    /// Appends the response to an order (rad) that arrives at `start` (s) with the rudder at `from` (rad): segments,
    /// the last without end.
    fn respond(&self, start: f64, from: f64, order: f64, path: &mut Vec<RudderSegment>) {
        let (rate, maximum) = (self.largest_rate(), self.largest_rudder());
        let target = order.clamp(-maximum, maximum);
        let side = (target - from).signum();
        let mut t = start;
        let mut angle = from;
        // Remaining error: the rate limits the motion first, then the lag, then the pump stops.
        let mut error = (target - from).abs();
        if error > self.dead_band {
            // An infinite rate without lag would give ∞·0.
            let knee = if self.lag > 0.0 { rate * self.lag } else { 0.0 };
            let until = knee.max(self.dead_band);
            if error > until {
                if rate.is_finite() {
                    let end = t + (error - until) / rate;
                    path.push(RudderSegment { start: t, end, angle, motion: RudderMotion::Ramp { rate: side * rate } });
                    t = end;
                }
                (error, angle) = (until, target - side * until);
            }
            if self.lag > 0.0 && error > self.dead_band {
                let end =
                    if self.dead_band > 0.0 { t + self.lag * (error / self.dead_band).ln() } else { f64::INFINITY };
                path.push(RudderSegment {
                    start: t,
                    end,
                    angle,
                    motion: RudderMotion::Exponential { target, lag: self.lag },
                });
                (t, angle) = (end, target - side * self.dead_band);
            }
        }
        if t.is_finite() {
            path.push(RudderSegment { start: t, end: f64::INFINITY, angle, motion: RudderMotion::Hold });
        }
    }
}

/// Rudder path: segments without gaps from −∞ to +∞.
#[derive(Debug, Clone, PartialEq)]
pub struct RudderPath {
    segments: Vec<RudderSegment>,
}

impl RudderPath {
    /// Rudder that rests at `angle` (rad) until the first order.
    pub fn constant(angle: f64) -> Self {
        let mut segments = Vec::with_capacity(64);
        segments.push(RudderSegment {
            start: f64::NEG_INFINITY,
            end: f64::INFINITY,
            angle,
            motion: RudderMotion::Hold,
        });
        Self { segments }
    }

    /// Rudder that rests at `angle` (rad) until `start` (s) and then follows `signal`, shifted so that its first point
    /// is at `start`.
    pub fn from_signal(angle: f64, start: f64, signal: &Polyline) -> Self {
        let (times, values) = (signal.times(), signal.values());
        let shift = start - times[0];
        let mut path = Self { segments: Vec::with_capacity(times.len() + 1) };
        path.segments.push(RudderSegment { start: f64::NEG_INFINITY, end: start, angle, motion: RudderMotion::Hold });
        for (t, delta) in times.windows(2).zip(values.windows(2)) {
            let motion = RudderMotion::Ramp { rate: (delta[1] - delta[0]) / (t[1] - t[0]) };
            path.segments.push(RudderSegment { start: t[0] + shift, end: t[1] + shift, angle: delta[0], motion });
        }
        let last = times.len() - 1;
        let (start, angle) = (times[last] + shift, values[last]);
        path.segments.push(RudderSegment { start, end: f64::INFINITY, angle, motion: RudderMotion::Hold });
        path
    }

    /// Adds an order (rad) at time `t` (s), which changes the path after one dead time.
    ///
    /// Orders must come in order of time.
    pub fn order(&mut self, t: f64, order: f64, gear: &SteeringGear) {
        let arrival = t + gear.dead_time;
        let from = self.angle_at(arrival);
        while self.segments.len() > 1 && self.segments[self.segments.len() - 1].start >= arrival {
            self.segments.pop();
        }
        if let Some(last) = self.segments.last_mut() {
            last.end = arrival;
        }
        gear.respond(arrival, from, order, &mut self.segments);
    }

    /// Segments in order of time.
    pub fn segments(&self) -> &[RudderSegment] {
        &self.segments
    }

    /// Rudder angles, rad, at times that do not decrease, s.
    pub fn angles_at(&self, times: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut now = 0;
        let angle = |t| {
            while self.segments.get(now + 1).is_some_and(|next| next.start <= t) {
                now += 1;
            }
            self.segments[now].angle_at(t)
        };
        times.map(angle).collect()
    }

    /// Rudder angle at time `t`, rad; at a jump, the angle after the jump.
    pub fn angle_at(&self, t: f64) -> f64 {
        let after = self.segments.partition_point(|segment| segment.start <= t);
        self.segments[after.saturating_sub(1)].angle_at(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    const DEGREE: f64 = ship::angle::DEGREE;

    fn answer(gear: &SteeringGear, from: f64, order: f64) -> RudderPath {
        let mut path = RudderPath::constant(from);
        path.order(10.0, order, gear);
        path
    }

    #[test]
    fn without_limits_the_rudder_jumps() {
        let path = answer(&SteeringGear::default(), 0.1, -0.2);
        assert_eq!((path.angle_at(9.999), path.angle_at(10.0), path.angle_at(50.0)), (0.1, -0.2, -0.2));
    }

    #[test]
    fn a_rate_limit_ramps_and_then_holds_exactly() {
        let path = answer(&SteeringGear::with_rate(2.5 * DEGREE), 10.0 * DEGREE, -10.0 * DEGREE);
        let motions: Vec<RudderMotion> = path.segments().iter().map(|segment| segment.motion).collect();
        assert_eq!(motions, [RudderMotion::Hold, RudderMotion::Ramp { rate: -2.5 * DEGREE }, RudderMotion::Hold]);
        assert_eq!(path.segments()[2].start, 18.0);
        assert_relative_eq!(path.angle_at(12.0), 5.0 * DEGREE, max_relative = 1e-12);
        assert_eq!(path.angle_at(30.0), -10.0 * DEGREE);
    }

    #[test]
    fn rate_lag_dead_time_and_dead_band_follow_one_another() {
        let gear =
            SteeringGear { rudder_rate: Some(0.05), lag: 2.0, dead_time: 1.5, dead_band: 0.01, max_rudder: None };
        let path = answer(&gear, 0.0, 0.4);
        let starts: Vec<f64> = path.segments()[1..].iter().map(|segment| segment.start).collect();
        // Ramp until the error is rate·lag = 0.1 (6 s), then lag·ln(0.1/0.01) until it is the dead band.
        assert_abs_diff_eq!(starts[0], 11.5);
        assert_abs_diff_eq!(starts[1], 17.5, epsilon = 1e-12);
        assert_abs_diff_eq!(starts[2], 17.5 + 2.0 * 10.0_f64.ln(), epsilon = 1e-12);
        assert_abs_diff_eq!(path.angle_at(100.0), 0.39, epsilon = 1e-15);
        // The path has no jumps, and no corner between ramp and exponential.
        for pair in path.segments().windows(2) {
            assert_abs_diff_eq!(pair[0].angle_at(pair[0].end), pair[1].angle, epsilon = 1e-15);
        }
        let h = 1e-6;
        let slopes = [17.5 - h, 17.5 + h].map(|t| (path.angle_at(t + 0.5 * h) - path.angle_at(t - 0.5 * h)) / h);
        assert_relative_eq!(slopes[0], slopes[1], max_relative = 1e-5);
    }

    /// Solution of δ' = clamp((δ_c − δ)/lag, ±rate), in small steps.
    #[test]
    fn segments_are_the_solution_of_the_equation() {
        let gear = SteeringGear { rudder_rate: Some(0.08), lag: 1.0, ..SteeringGear::default() };
        let path = answer(&gear, 0.3, -0.1);
        let (mut delta, h) = (0.3, 1e-4);
        for step in 0..100_000 {
            let t = 10.0 + f64::from(step) * h;
            assert_abs_diff_eq!(path.angle_at(t), delta, epsilon = 2e-5);
            delta += h * ((-0.1 - delta) / gear.lag).clamp(-0.08, 0.08);
        }
    }

    #[test]
    fn a_new_order_takes_over_where_the_rudder_is() {
        let gear = SteeringGear { rudder_rate: Some(0.1), dead_time: 1.0, ..SteeringGear::default() };
        let mut path = answer(&gear, 0.0, 0.5);
        path.order(12.0, -0.5, &gear);
        assert_abs_diff_eq!(path.angle_at(13.0), 0.2, epsilon = 1e-15);
        assert_abs_diff_eq!(path.angle_at(14.0), 0.1, epsilon = 1e-15);
        // A later order does not overtake an earlier order within its dead time.
        path.order(12.5, 0.5, &gear);
        assert_abs_diff_eq!(path.angle_at(13.5), 0.15, epsilon = 1e-15);
        assert_abs_diff_eq!(path.angle_at(17.0), 0.5, epsilon = 1e-15);
    }

    #[test]
    fn stops_and_dead_band_hold_the_rudder() {
        let gear =
            SteeringGear { rudder_rate: Some(0.1), dead_band: 0.02, max_rudder: Some(0.6), ..SteeringGear::default() };
        assert_abs_diff_eq!(answer(&gear, 0.0, 0.9).angle_at(100.0), 0.58, epsilon = 1e-15);
        assert_eq!(answer(&gear, 0.3, 0.31).angle_at(100.0), 0.3);
    }
}
