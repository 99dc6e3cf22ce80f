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
    let mut motion = Motion { rate: 0.0, heading: 0.0, state: truth.approach };
    let (mut heading, mut rudder, mut order) = (Vec::with_capacity(ROWS), vec![0.0], 0.0);
    let walk = walk(truth, key, number);
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
            motion = advanced(truth, row as f64 + step as f64 / STEPS as f64, motion, [&rudder, &walk]);
        }
    }
    let mut generator = key.indexed(Purpose::Rudder, number);
    let mut shown = |(row, rudder): (usize, f64)| {
        let draw: f64 = StandardNormal.sample(&mut generator);
        (truth.rudder_gain)(row as f64) * rudder + from_deg(truth.rudder_noise_deg) * draw
    };
    let rudder = rudder.into_iter().take(ROWS).enumerate().map(&mut shown).collect();
    let time = (0..ROWS).map(|row| row as f64).collect();
    let channels = [(Channel::Heading, heading), (Channel::Rudder, rudder)].into();
    let origin = Origin::Simulated { scenario: "unlisted".into(), cell: key.cell, replicate: key.replicate };
    let name = format!("{angle_deg}/{angle_deg}");
    Trial::new(&name, origin, Columns { time, channels, unknown: Vec::new() }).expect("a zig-zag is a record")
}

/// The random walk of the moment as a rudder angle at every row and one more, rad.
fn walk(truth: &Truth, key: StreamKey, number: u32) -> Vec<f64> {
    let mut generator = key.indexed(Purpose::RandomWalk, number);
    let mut moment = 0.0;
    let next = |_| {
        let draw: f64 = StandardNormal.sample(&mut generator);
        moment += from_deg(truth.walk_deg) * draw;
        moment
    };
    (0..=ROWS).map(next).collect()
}

/// The motion one step later, by the classical method of Runge and Kutta, under a rudder and a moment at rows.
fn advanced(truth: &Truth, t: f64, motion: Motion, [rudder, moment]: [&[f64]; 2]) -> Motion {
    let h = 1.0 / STEPS as f64;
    let felt = |t: f64| at(rudder, t) + at(moment, t);
    let rates = |after: f64, x: Motion| (truth.rates)(t + after, x, &felt);
    let moved = |by: f64, rates: Motion| Motion {
        rate: motion.rate + by * rates.rate,
        heading: motion.heading + by * rates.heading,
        state: motion.state + by * rates.state,
    };
    let k1 = rates(0.0, motion);
    let k2 = rates(0.5 * h, moved(0.5 * h, k1));
    let k3 = rates(0.5 * h, moved(0.5 * h, k2));
    let k4 = rates(h, moved(h, k3));
    let mean = |of: fn(Motion) -> f64| (of(k1) + 2.0 * of(k2) + 2.0 * of(k3) + of(k4)) / 6.0;
    moved(h, Motion { rate: mean(|x| x.rate), heading: mean(|x| x.heading), state: mean(|x| x.state) })
}

/// A value at a time, s, from those at rows; that of the first row before it.
fn at(rows: &[f64], t: f64) -> f64 {
    let row = (t.max(0.0) as usize).min(rows.len() - 2);
    rows[row] + (t.max(0.0) - row as f64) * (rows[row + 1] - rows[row])
}
