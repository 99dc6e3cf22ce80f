//! Recorded part of a run: start, duration, sampling and source of the rudder.

use rand::rngs::ChaCha8Rng;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use trial::DeclaredWeather;
use trial::degrees::Degrees;

use crate::error::{self, Check, Requirement};
use crate::helm::{MAX_PERIOD_S, MIN_PERIOD_S};
use crate::limits::{MAX_EXECUTES, MAX_ROWS};
use crate::sample::Sample;
use crate::sensor::Sensors;
use crate::stream::{RngPurpose, StreamKey, normal};

/// Record of a run: start, duration, sampling and rudder source.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Recording {
    /// Time between two rows.
    #[serde(rename = "sampling-s")]
    pub sampling_period: f64,
    // A manoeuvre that ends earlier ends the record.
    /// Time from the first to the last row; if left out, the record lasts until the end of the manoeuvre.
    #[serde(rename = "duration-s")]
    pub duration: Option<f64>,
    /// Number of the execute, from 1, at which the record starts; if left out, the record starts with the run.
    pub after_execute: Option<usize>,
    /// Time from the execute in `after-execute` to the first row; 0 if left out.
    #[serde(rename = "offset-s")]
    pub first_row_offset: Option<f64>,
    /// Source of the rudder column: the feedback, or angles reconstructed from the orders.
    #[serde(default)]
    pub rudder: RudderSource,
    /// Rudder rate assumed in the reconstruction from orders, rad/s (deg/s in files); inf for an instantaneous rudder.
    /// Required if `rudder` is `orders`, otherwise left out.
    #[serde(default, rename = "assumed-rudder-rate-deg-s", with = "Degrees::<Option<f64>>")]
    pub assumed_rudder_rate: Option<f64>,
    // It has no effect on the simulation: a declaration may be wrong.
    /// Weather that the record declares; if left out, none is declared.
    pub weather: Option<DeclaredWeather>,
}

/// Source of the rudder column.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RudderSource {
    /// Rudder feedback.
    #[default]
    Feedback,
    /// Angles reconstructed from the orders.
    Orders,
}

impl Default for Recording {
    /// Record of the whole run, one row a second.
    fn default() -> Self {
        Self::every(1.0)
    }
}

impl Recording {
    /// Record of the whole run with this time between rows, s.
    pub fn every(period: f64) -> Self {
        let (rudder, weather) = (RudderSource::Feedback, None);
        Self {
            sampling_period: period,
            duration: None,
            after_execute: None,
            first_row_offset: None,
            rudder,
            assumed_rudder_rate: None,
            weather,
        }
    }

    /// Maximum permitted duration at this sampling period, s; it gives `MAX_ROWS` rows.
    pub(crate) fn max_duration(&self) -> f64 {
        (MAX_ROWS - 1) as f64 * self.sampling_period
    }

    /// Number of rows; `None` without a duration.
    pub fn rows(&self) -> Option<usize> {
        // A duration of whole periods includes its last row despite rounding.
        self.duration.map(|duration| (duration / self.sampling_period + 1e-9).floor() as usize + 1)
    }

    /// Check of every value; fails with the first value that is invalid or requires another key.
    pub fn check(&self) -> Check {
        error::check_positive("recording.sampling-s", self.sampling_period)?;
        error::check_between("recording.sampling-s", self.sampling_period, MIN_PERIOD_S, MAX_PERIOD_S)?;
        if let Some(duration) = self.duration {
            error::check_positive("recording.duration-s", duration)?;
        }
        match (self.after_execute, self.first_row_offset) {
            (Some(number), offset) => {
                error::check_count("recording.after-execute", number, MAX_EXECUTES)?;
                error::check_time("recording.offset-s", offset.unwrap_or(0.0))?;
            }
            (None, Some(_)) => error::refuse(
                "recording.offset-s",
                Requirement::OtherKey([
                    "`recording.offset-s` counts from an execute, and `after-execute` is missing",
                    "expected `after-execute` as well",
                    "add `after-execute = 1` for the first execute, or leave `offset-s` out",
                ]),
            )?,
            (None, None) => {}
        }
        match (self.rudder, self.assumed_rudder_rate) {
            (RudderSource::Feedback, None) => Ok(()),
            (RudderSource::Orders, Some(rate)) => {
                error::check_positive_or_infinite("recording.assumed-rudder-rate-deg-s", rate)
            }
            (RudderSource::Orders, None) => error::refuse(
                "recording.rudder",
                Requirement::OtherKey([
                    "`recording.rudder` is \"orders\", and the assumed rudder rate is missing",
                    "expected `assumed-rudder-rate-deg-s` as well",
                    "add `assumed-rudder-rate-deg-s = 2.5`, or inf for a rudder that jumps",
                ]),
            ),
            (RudderSource::Feedback, Some(_)) => error::refuse(
                "recording.assumed-rudder-rate-deg-s",
                Requirement::OtherKey([
                    "`recording` has an assumed rate, but the rudder is recorded",
                    "expected a rate with `rudder = \"orders\"` only",
                    "add `rudder = \"orders\"`, or leave the rate out",
                ]),
            ),
        }
    }
}

/// Sampler of one run: samples at increasing instants.
#[derive(Debug)]
pub(crate) struct Sampler {
    start: f64,
    period: f64,
    remaining: usize,
    deviation: Option<Jitter>,
    next: f64,
    /// Samples so far.
    pub samples: Vec<Sample>,
    /// Deviation of each instant from its stamp, s; empty without jitter. At most one longer than `samples`.
    pub jitter: Vec<f64>,
}

/// Deviation of the instants of a [`Sampler`] from its stamps.
#[derive(Debug)]
struct Jitter {
    rng: ChaCha8Rng,
    sd: f64,
    delay: f64,
}

/// Maximum jitter as a share of the period; below a half, so that instants keep their order.
const MAX_JITTER_SHARE: f64 = 0.45;

/// Maximum number of rows for which memory is reserved at once; a manoeuvre can end long before its record is full.
const MAX_RESERVED_ROWS: usize = 4096;

impl Sampler {
    /// Sampler at the stamps of the rows.
    pub fn at_row_times(start: f64, recording: &Recording) -> Self {
        Self::new(start, recording, None)
    }

    /// Sampler at the instants of the instruments; `None` if these instants are the stamps.
    pub fn at_instrument_times(start: f64, recording: &Recording, sensors: &Sensors, key: &StreamKey) -> Option<Self> {
        let deviates = sensors.sampling_jitter > 0.0 || sensors.heading_delay != 0.0;
        deviates.then(|| {
            let jitter =
                Jitter { rng: key.rng(RngPurpose::Jitter), sd: sensors.sampling_jitter, delay: sensors.heading_delay };
            Self::new(start, recording, Some(jitter))
        })
    }

    fn new(start: f64, recording: &Recording, deviation: Option<Jitter>) -> Self {
        let rows = recording.rows();
        // One more than the limit, so that an endless record is detected.
        let remaining = rows.unwrap_or(MAX_ROWS + 1);
        let samples = Vec::with_capacity(rows.unwrap_or(0).min(MAX_RESERVED_ROWS));
        let mut sampler = Self {
            start,
            period: recording.sampling_period,
            remaining,
            deviation,
            next: start,
            samples,
            jitter: Vec::new(),
        };
        sampler.aim();
        sampler
    }

    /// Instant of the next sample, s; infinite after the last one.
    pub fn next_time(&self) -> f64 {
        self.next
    }

    /// Stores `sample` if its time is due.
    pub fn take(&mut self, sample: &Sample) {
        // Several rows can fall on one instant, because a delayed reading cannot precede the run.
        while self.next <= sample.time {
            self.samples.push(*sample);
            self.remaining -= 1;
            self.aim();
        }
    }

    fn aim(&mut self) {
        if self.remaining == 0 {
            self.next = f64::INFINITY;
            return;
        }
        self.next = self.start + self.samples.len() as f64 * self.period;
        if let Some(deviation) = &mut self.deviation {
            let jitter = if deviation.sd > 0.0 {
                let limit = MAX_JITTER_SHARE * self.period;
                (deviation.sd * normal(&mut deviation.rng)).clamp(-limit, limit)
            } else {
                0.0
            };
            self.jitter.push(jitter);
            self.next = (self.next + jitter - deviation.delay).max(0.0);
        }
    }
}
