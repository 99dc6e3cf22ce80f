//! Heading display of the helmsman during one run: the measured heading at the instants of the display, and a log of
//! the readings, because a row of the record at the same instant has the same value.

use rand::rngs::ChaCha8Rng;

use crate::compass_error::{CompassErrorPath, CompassErrorPoint, CompassReader};
use crate::sensor::{Sensors, quantise};
use crate::stream::{RngPurpose, StreamKey, normal};
use crate::wave_path::SeaWaves;

/// Tolerance at the heading of the next execute, rad: a multiple of the quantum can be below it by a rounding error.
const READING_TOLERANCE: f64 = 1e-9;

/// Reading of the heading display by the helmsman.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DisplayReading {
    /// Time, s.
    pub time: f64,
    /// Heading read, rad.
    pub heading: f64,
    /// Coloured error in the reading, rad.
    pub wander: f64,
}

impl DisplayReading {
    /// Coloured error at the time of the reading.
    pub fn compass_error_point(&self) -> CompassErrorPoint {
        CompassErrorPoint { time: self.time, error: self.wander }
    }
}

/// Heading display in one run.
#[derive(Debug)]
pub(crate) struct HeadingDisplay {
    period: f64,
    next: u64,
    base: f64,
    sensors: Sensors,
    waves: SeaWaves,
    wander: Option<CompassErrorPath>,
    rng: ChaCha8Rng,
    log: Vec<DisplayReading>,
}

impl HeadingDisplay {
    /// Display with a reading every `period` s; the base course is the noise-free reading at `heading`.
    pub fn new(period: f64, sensors: Sensors, waves: SeaWaves, key: &StreamKey, heading: f64) -> Self {
        let base = quantise(heading + sensors.heading_bias, sensors.heading_quantum);
        let wander = sensors.heading_wander.map(|process| CompassErrorPath::new(process, CompassReader::Display, key));
        let (rng, log) = (key.rng(RngPurpose::Display), Vec::with_capacity(1024));
        Self { period, next: 0, base, sensors, waves, wander, rng, log }
    }

    /// Skips the readings before `t` (s), which are not used.
    pub fn skip_to(&mut self, t: f64) {
        // All readings but the last at once: a long lead-in has millions of readings.
        self.next = self.next.max(((t / self.period) as u64).saturating_sub(1));
        while self.next_time() < t {
            self.next += 1;
        }
    }

    /// Time of the next reading, s.
    pub fn next_time(&self) -> f64 {
        self.next as f64 * self.period
    }

    /// Reads the display at its next time, with the heading of the compass `psi` (rad); `true` if `side` (±1) times the
    /// deviation from the base course is at least `angle` (rad).
    pub fn read(&mut self, psi: f64, side: f64, angle: f64) -> bool {
        let time = self.next_time();
        self.next += 1;
        let [wave, _] = self.waves.heading_and_rate_at(time);
        let noise = self.sensors.heading_noise * normal(&mut self.rng);
        let wander = self.wander.as_mut().map_or(0.0, |wander| wander.error_at(time));
        let heading = quantise(psi + wave + self.sensors.heading_bias + wander + noise, self.sensors.heading_quantum);
        self.log.push(DisplayReading { time, heading, wander });
        side * (heading - self.base) >= angle - READING_TOLERANCE
    }

    /// Log of the readings, in order of time.
    pub fn into_log(self) -> Vec<DisplayReading> {
        self.log
    }
}
