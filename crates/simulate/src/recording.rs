//! Which part of the run becomes the record: where it starts, how long it is, how often it is sampled.

use rand::rngs::ChaCha8Rng;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use trial::DeclaredWeather;
use trial::degrees::Degrees;

use crate::error::{self, Check, Expected};
use crate::helm::{LONGEST_PERIOD, SHORTEST_PERIOD};
use crate::limits::{MOST_EXECUTES, MOST_ROWS};
use crate::sample::Sample;
use crate::sensor::Sensors;
use crate::stream::{Purpose, StreamKey, normal};

/// The record of a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Recording {
    /// Time between two rows.
    #[serde(rename = "sampling-s")]
    pub period: f64,
    // A manoeuvre that is over earlier ends the record.
    /// Time from the first to the last row; left out, the record lasts until the end of the manoeuvre.
    #[serde(rename = "duration-s")]
    pub duration: Option<f64>,
    /// Number of the execute, from 1, at which the record starts; left out, it starts with the run.
    pub after_execute: Option<usize>,
    /// Time from that execute to the first row; 0 when left out.
    #[serde(rename = "offset-s")]
    pub offset: Option<f64>,
    /// What stands in the rudder column: the feedback, or angles rebuilt from the orders.
    #[serde(default)]
    pub rudder: RudderSource,
    /// Rate at which angles are rebuilt from orders; inf for a rudder that jumps.
    #[serde(default, rename = "assumed-rudder-rate-deg-s", with = "Degrees::<Option<f64>>")]
    pub assumed_rudder_rate: Option<f64>,
    // It changes nothing else: a declaration may be wrong.
    /// Weather that the record declares; left out, none is declared.
    pub weather: Option<DeclaredWeather>,
}

/// What stands in the rudder column.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RudderSource {
    /// The rudder feedback.
    #[default]
    Feedback,
    /// Angles rebuilt from the orders.
    Orders,
}

impl Default for Recording {
    /// The whole run, once a second.
    fn default() -> Self {
        Self::every(1.0)
    }
}

impl Recording {
    /// The whole run with this time between rows, s.
    pub fn every(period: f64) -> Self {
        let (rudder, weather) = (RudderSource::Feedback, None);
        Self { period, duration: None, after_execute: None, offset: None, rudder, assumed_rudder_rate: None, weather }
    }

    /// Longest record that is taken for meant, s.
    pub(crate) fn longest(&self) -> f64 {
        (MOST_ROWS - 1) as f64 * self.period
    }

    /// Number of rows, where the duration says it.
    pub fn rows(&self) -> Option<usize> {
        // A duration of whole periods keeps its last row in spite of rounding.
        self.duration.map(|duration| (duration / self.period + 1e-9).floor() as usize + 1)
    }

    /// Checks every value; fails with the first one that makes no sense, or that lacks another.
    pub fn validate(&self) -> Check {
        error::positive("recording.sampling-s", self.period)?;
        error::between("recording.sampling-s", self.period, SHORTEST_PERIOD, LONGEST_PERIOD)?;
        if let Some(duration) = self.duration {
            error::positive("recording.duration-s", duration)?;
        }
        match (self.after_execute, self.offset) {
            (Some(number), offset) => {
                error::count("recording.after-execute", number, MOST_EXECUTES)?;
                error::time("recording.offset-s", offset.unwrap_or(0.0))?;
            }
            (None, Some(_)) => error::refused(
                "recording.offset-s",
                Expected::Other([
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
                error::positive_or_infinite("recording.assumed-rudder-rate-deg-s", rate)
            }
            (RudderSource::Orders, None) => error::refused(
                "recording.rudder",
                Expected::Other([
                    "`recording.rudder` is \"orders\", and nothing says how fast the rudder is taken to move",
                    "expected `assumed-rudder-rate-deg-s` as well",
                    "add `assumed-rudder-rate-deg-s = 2.5`, or inf for a rudder that jumps",
                ]),
            ),
            (RudderSource::Feedback, Some(_)) => error::refused(
                "recording.assumed-rudder-rate-deg-s",
                Expected::Other([
                    "`recording` has an assumed rate for a rudder that is recorded",
                    "a rate is assumed for `rudder = \"orders\"` only",
                    "add `rudder = \"orders\"`, or leave the rate out",
                ]),
            ),
        }
    }
}

/// Samples taken at growing instants of one run.
#[derive(Debug)]
pub(crate) struct Sampler {
    start: f64,
    period: f64,
    left: usize,
    deviation: Option<Jitter>,
    next: f64,
    /// What was taken so far.
    pub samples: Vec<Sample>,
    /// Deviation of each instant from its stamp, s; empty where none was asked for. One longer than `samples` at most.
    pub jitter: Vec<f64>,
}

/// What parts the instants of a [`Sampler`] from its stamps.
#[derive(Debug)]
struct Jitter {
    rng: ChaCha8Rng,
    sd: f64,
    delay: f64,
}

/// Jitter is cut at this share of the period: below a half, so that instants keep their order.
const LARGEST_JITTER: f64 = 0.45;

/// Most rows reserved at once: a manoeuvre may be over long before its record is full.
const RESERVED: usize = 4096;

impl Sampler {
    /// The stamps of the rows.
    pub fn rows(start: f64, recording: &Recording) -> Self {
        Self::new(start, recording, None)
    }

    /// The instants at which what moves is read; `None` when they are the stamps.
    pub fn instruments(start: f64, recording: &Recording, sensors: &Sensors, key: &StreamKey) -> Option<Self> {
        let deviates = sensors.jitter > 0.0 || sensors.heading_delay != 0.0;
        deviates.then(|| {
            let deviation = Jitter { rng: key.rng(Purpose::Jitter), sd: sensors.jitter, delay: sensors.heading_delay };
            Self::new(start, recording, Some(deviation))
        })
    }

    fn new(start: f64, recording: &Recording, deviation: Option<Jitter>) -> Self {
        let rows = recording.rows();
        // One more than there may be, so that a record without end is noticed.
        let left = rows.unwrap_or(MOST_ROWS + 1);
        let samples = Vec::with_capacity(rows.unwrap_or(0).min(RESERVED));
        let mut sampler =
            Self { start, period: recording.period, left, deviation, next: start, samples, jitter: Vec::new() };
        sampler.aim();
        sampler
    }

    /// Instant of the next sample, s; infinite when there is none.
    pub fn next(&self) -> f64 {
        self.next
    }

    /// Takes `sample` if its time has come.
    pub fn take(&mut self, sample: &Sample) {
        // More than one row can fall on the same instant: a delay cannot reach back before the run.
        while self.next <= sample.time {
            self.samples.push(*sample);
            self.left -= 1;
            self.aim();
        }
    }

    fn aim(&mut self) {
        if self.left == 0 {
            self.next = f64::INFINITY;
            return;
        }
        self.next = self.start + self.samples.len() as f64 * self.period;
        if let Some(deviation) = &mut self.deviation {
            let jitter = if deviation.sd > 0.0 {
                let limit = LARGEST_JITTER * self.period;
                (deviation.sd * normal(&mut deviation.rng)).clamp(-limit, limit)
            } else {
                0.0
            };
            self.jitter.push(jitter);
            self.next = (self.next + jitter - deviation.delay).max(0.0);
        }
    }
}
