//! Zig-zags of these ships: fed back on the compass, with a rudder of limited rate, integrated in plain code.

use rand_distr::{Distribution, StandardNormal};
use ship::angle::from_deg;
use simulate::StreamKey;
use simulate::stream::Purpose;
use trial::{Channel, Columns, Origin, Trial};

use super::truths::{Motion, Truth};

/// Rows of a record, one a second.
pub const ROWS: usize = 300;

/// Steps of integration in a second.
const STEPS: usize = 50;

/// Row of the first order.
const FIRST: usize = 5;

/// Rate of the rudder, deg/s. The angles of all zig-zags are multiples of it: the rudder starts and stops at rows, and
/// a straight line between rows is what it did.
const RUDDER_RATE_DEG: f64 = 2.5;

/// The records of one trial, with white heading noise of this standard deviation, deg.
pub fn of(truth: &Truth, noise_deg: f64, key: StreamKey) -> Vec<Trial> {
    (0..)
        .zip(truth.zig_zags_deg)
        .map(|(number, &angle_deg)| zig_zag(truth, angle_deg, noise_deg, key, number))
        .collect()
}

/// One zig-zag, starboard first. The helmsman reads the compass, noise and all, once a second.
fn zig_zag(truth: &Truth, angle_deg: f64, noise_deg: f64, key: StreamKey, number: u32) -> Trial {
    let (angle, travel, noise) = (from_deg(angle_deg), from_deg(RUDDER_RATE_DEG), from_deg(noise_deg));
    let mut generator = key.indexed(Purpose::Heading, number);
    let mut motion = Motion { rate: 0.0, heading: 0.0, own: truth.approach };
    let (mut heading, mut rudder, mut order) = (Vec::with_capacity(ROWS), vec![0.0], 0.0);
    for row in 0..ROWS {
        let draw: f64 = StandardNormal.sample(&mut generator);
        let read = (truth.shown)(motion) + noise * draw;
        heading.push(read);
        if row == FIRST {
            order = angle;
        } else if row > FIRST && read * order > 0.0 && read.abs() >= angle {
            order = -order;
        }
        rudder.push(rudder[row] + (order - rudder[row]).clamp(-travel, travel));
        for step in 0..STEPS {
            motion = advanced(truth, row as f64 + step as f64 / STEPS as f64, motion, &rudder);
        }
    }
    rudder.truncate(ROWS);
    let time = (0..ROWS).map(|row| row as f64).collect();
    let channels = [(Channel::Heading, heading), (Channel::Rudder, rudder)].into();
    let origin = Origin::Simulated { scenario: "unlisted".into(), cell: key.cell, replicate: key.replicate };
    let name = format!("{angle_deg}/{angle_deg}");
    Trial::new(&name, origin, Columns { time, channels, unknown: Vec::new() }).expect("a zig-zag is a record")
}

/// The motion one step later, by the classical method of Runge and Kutta.
fn advanced(truth: &Truth, t: f64, motion: Motion, rudder: &[f64]) -> Motion {
    let h = 1.0 / STEPS as f64;
    let rates = |after: f64, x: Motion| (truth.rates)(t + after, x, at(rudder, t + after - truth.dead_time));
    let moved = |by: f64, rates: Motion| Motion {
        rate: motion.rate + by * rates.rate,
        heading: motion.heading + by * rates.heading,
        own: motion.own + by * rates.own,
    };
    let k1 = rates(0.0, motion);
    let k2 = rates(0.5 * h, moved(0.5 * h, k1));
    let k3 = rates(0.5 * h, moved(0.5 * h, k2));
    let k4 = rates(h, moved(h, k3));
    let mean = |of: fn(Motion) -> f64| (of(k1) + 2.0 * of(k2) + 2.0 * of(k3) + of(k4)) / 6.0;
    moved(h, Motion { rate: mean(|x| x.rate), heading: mean(|x| x.heading), own: mean(|x| x.own) })
}

/// The rudder at a time, s, from its values at rows; amidships before the first.
fn at(rudder: &[f64], t: f64) -> f64 {
    let row = (t.max(0.0) as usize).min(rudder.len() - 2);
    rudder[row] + (t.max(0.0) - row as f64) * (rudder[row + 1] - rudder[row])
}
