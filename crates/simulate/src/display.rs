//! The heading display in front of the helmsman during one run: the measured heading at its own instants, and a log of
//! what was read, because a row of the record that falls on a reading holds the very same number.

use rand::rngs::ChaCha8Rng;

use crate::sensor::{Sensors, quantise};
use crate::stream::{Purpose, StreamKey, normal};
use crate::wander::{CompassReader, WanderPath, WanderPoint};
use crate::wave_path::SeaWaves;

/// A reading this far (rad) short of the heading asked for has reached it: a multiple of the quantum may lie a rounding
/// error below.
const READING_TOLERANCE: f64 = 1e-9;

/// One reading of the display.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DisplayReading {
    /// Time, s.
    pub time: f64,
    /// Heading read, rad.
    pub heading: f64,
    /// Coloured error in it, rad.
    pub wander: f64,
}

impl DisplayReading {
    /// What it tells of the coloured error.
    pub fn known(&self) -> WanderPoint {
        WanderPoint { time: self.time, error: self.wander }
    }
}

/// The display in one run.
#[derive(Debug)]
pub(crate) struct Display {
    period: f64,
    next: u64,
    base: f64,
    sensors: Sensors,
    waves: SeaWaves,
    wander: Option<WanderPath>,
    rng: ChaCha8Rng,
    log: Vec<DisplayReading>,
}

impl Display {
    /// A display that is renewed every `period` s; the base course is what it shows, without noise, at `heading`.
    pub fn new(period: f64, sensors: Sensors, waves: SeaWaves, key: &StreamKey, heading: f64) -> Self {
        let base = quantise(heading + sensors.heading_bias, sensors.heading_quantum);
        let wander = sensors.heading_wander.map(|process| WanderPath::new(process, CompassReader::Display, key));
        let (rng, log) = (key.rng(Purpose::Display), Vec::with_capacity(1024));
        Self { period, next: 0, base, sensors, waves, wander, rng, log }
    }

    /// Passes over the readings before `t` (s): nobody looked.
    pub fn skip_to(&mut self, t: f64) {
        // All but the last at once: after a long lead-in they are millions.
        self.next = self.next.max(((t / self.period) as u64).saturating_sub(1));
        while self.next_time() < t {
            self.next += 1;
        }
    }

    /// Time of the next reading, s.
    pub fn next_time(&self) -> f64 {
        self.next as f64 * self.period
    }

    /// Reads the display at its next time, when the compass stands at `gyro` (rad): whether `side` · deviation ≥
    /// `angle`.
    pub fn read(&mut self, gyro: f64, side: f64, angle: f64) -> bool {
        let time = self.next_time();
        self.next += 1;
        let [wave, _] = self.waves.at(time);
        let noise = self.sensors.heading_noise * normal(&mut self.rng);
        let wander = self.wander.as_mut().map_or(0.0, |wander| wander.at(time));
        let heading = quantise(gyro + wave + self.sensors.heading_bias + wander + noise, self.sensors.heading_quantum);
        self.log.push(DisplayReading { time, heading, wander });
        side * (heading - self.base) >= angle - READING_TOLERANCE
    }

    /// What was read, in the order of time.
    pub fn into_log(self) -> Vec<DisplayReading> {
        self.log
    }
}
