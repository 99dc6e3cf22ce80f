//! Which part of the run becomes the record: where it starts, how long it is, how often it is sampled.

use rand::rngs::ChaCha8Rng;

use crate::error::{self, Checked};
use crate::helm::{LONGEST_PERIOD, SHORTEST_PERIOD};
use crate::limits::{MOST_EXECUTES, MOST_ROWS};
use crate::sample::Sample;
use crate::sensor::Clock;
use crate::stream::{Purpose, StreamKey, normal};

/// Where the record starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Start {
    /// At the beginning of the run, lead-in included.
    Run,
    /// `offset` s after an execute, counted from 1 (the first execute begins the manoeuvre).
    Execute {
        /// Number of the execute.
        number: usize,
        /// Time from it to the first row, s.
        offset: f64,
    },
}

/// Where the rudder column of the record comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum RudderColumn {
    /// The rudder feedback.
    #[default]
    Feedback,
    /// Nobody recorded the rudder: its angles are rebuilt from the orders of the helm and a rate somebody assumes.
    Orders {
        /// Rate assumed, rad/s; infinite for a rudder that jumps.
        assumed_rate: f64,
    },
}

/// The specification of the record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recording {
    /// Where it starts.
    pub start: Start,
    /// Time between rows, s.
    pub period: f64,
    /// Time from first to last row, s; `None` for until the end of the manoeuvre. A manoeuvre that is over earlier ends
    /// the record.
    pub duration: Option<f64>,
    /// Where its rudder column comes from.
    pub rudder: RudderColumn,
}

impl Default for Recording {
    /// The whole run, once a second.
    fn default() -> Self {
        Self { start: Start::Run, period: 1.0, duration: None, rudder: RudderColumn::Feedback }
    }
}

impl Recording {
    /// Longest record that is taken for meant, s.
    pub(crate) fn longest(&self) -> f64 {
        (MOST_ROWS - 1) as f64 * self.period
    }

    /// Number of rows, where the duration says it.
    pub fn rows(&self) -> Option<usize> {
        // A duration of whole periods keeps its last row in spite of rounding.
        self.duration.map(|duration| (duration / self.period + 1e-9).floor() as usize + 1)
    }

    /// Checks every value; fails with the first one that makes no sense.
    pub fn validate(&self) -> Checked {
        error::positive("recording.sampling-s", self.period)?;
        error::between("recording.sampling-s", self.period, SHORTEST_PERIOD, LONGEST_PERIOD)?;
        if let Some(duration) = self.duration {
            error::positive("recording.duration-s", duration)?;
        }
        if let Start::Execute { number, offset } = self.start {
            error::count("recording.after-execute", number, MOST_EXECUTES)?;
            error::time("recording.offset-s", offset)?;
        }
        if let RudderColumn::Orders { assumed_rate } = self.rudder {
            error::positive_or_infinite("recording.assumed-rudder-rate-deg-s", assumed_rate)?;
        }
        Ok(())
    }
}

/// Samples taken at growing instants of one run.
#[derive(Debug)]
pub(crate) struct Tap {
    start: f64,
    period: f64,
    left: usize,
    shaking: Option<Shaking>,
    next: f64,
    /// What was taken so far.
    pub samples: Vec<Sample>,
    /// Deviation of each instant from its stamp, s; empty where none was asked for. One longer than `samples` at most.
    pub jitter: Vec<f64>,
}

/// What parts the instants of a [`Tap`] from its stamps.
#[derive(Debug)]
struct Shaking {
    rng: ChaCha8Rng,
    sd: f64,
    delay: f64,
}

/// Jitter is cut at this share of the period: below a half, so that instants keep their order.
const LARGEST_JITTER: f64 = 0.45;

/// Most rows reserved at once: a manoeuvre may be over long before its record is full.
const RESERVED: usize = 4096;

impl Tap {
    /// The stamps of the rows.
    pub fn rows(start: f64, recording: &Recording) -> Self {
        Self::new(start, recording, None)
    }

    /// The instants at which what moves is read; `None` when they are the stamps.
    pub fn instruments(start: f64, recording: &Recording, clock: &Clock, key: &StreamKey) -> Option<Self> {
        let shaken = clock.jitter > 0.0 || clock.heading_delay != 0.0;
        shaken.then(|| {
            let shaking = Shaking { rng: key.rng(Purpose::Jitter), sd: clock.jitter, delay: clock.heading_delay };
            Self::new(start, recording, Some(shaking))
        })
    }

    fn new(start: f64, recording: &Recording, shaking: Option<Shaking>) -> Self {
        let rows = recording.rows();
        // One more than there may be, so that a record without end is noticed.
        let left = rows.unwrap_or(MOST_ROWS + 1);
        let samples = Vec::with_capacity(rows.unwrap_or(0).min(RESERVED));
        let mut tap = Self { start, period: recording.period, left, shaking, next: start, samples, jitter: Vec::new() };
        tap.aim();
        tap
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
        if let Some(shaking) = &mut self.shaking {
            let jitter = if shaking.sd > 0.0 {
                let limit = LARGEST_JITTER * self.period;
                (shaking.sd * normal(&mut shaking.rng)).clamp(-limit, limit)
            } else {
                0.0
            };
            self.jitter.push(jitter);
            self.next = (self.next + jitter - shaking.delay).max(0.0);
        }
    }
}
