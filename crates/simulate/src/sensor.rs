//! Instruments as a specification: what the record gets wrong. The default is perfect in everything. How a
//! specification turns truth into a record is in `measure`; what the helmsman sees is in `display`.
//!
//! Order of events in the heading channel: lag of the gyrocompass, waves, bias, coloured error, white noise,
//! quantisation; in the record alone, spikes, and rows without a heading. Clocks: row k carries the nominal stamp t_k;
//! the rudder is read at t_k + j_k with jitter j_k, and the heading (with everything else that moves) at t_k + j_k −
//! `heading_delay`. Stamps themselves are never disturbed: a jittered stamp on an exact instant differs only in the
//! sign of j.

use ship::angle::from_deg;
use trial::Noise;

use crate::disturbance::GaussMarkov;
use crate::error::{self, Checked};
use crate::limits::{LONGEST_TIME, MOST_ROWS};

/// Rows whose recorded heading is off: faults on the way from the compass to the record, which no helmsman sees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spikes {
    /// Probability per row, independently of the others.
    pub probability: f64,
    /// Size of every spike, rad; to either side with the same probability.
    pub size: f64,
}

/// The gyrocompass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadingSensor {
    /// Standard deviation of white noise, rad.
    pub noise: f64,
    /// Quantum of the reading, rad; 0 for none.
    pub quantum: f64,
    /// Follow-up lag τ: τ ψ_g' + ψ_g = ψ, s; 0 for none.
    pub lag: f64,
    /// Constant error, rad.
    pub bias: f64,
    /// Coloured error, rad: w' = −w/τ + white noise, stationary from the beginning of the run.
    pub wander: Option<GaussMarkov>,
    /// Rows whose recorded heading is off.
    pub spikes: Option<Spikes>,
    /// A heading stands in the first row and in every n-th after it, counted before any row is lost; 1 for in all. Only
    /// the heading is recorded so rarely.
    pub every_rows: usize,
}

impl Default for HeadingSensor {
    fn default() -> Self {
        Self { noise: 0.0, quantum: 0.0, lag: 0.0, bias: 0.0, wander: None, spikes: None, every_rows: 1 }
    }
}

/// The rate-of-turn indicator.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct YawRateSensor {
    /// Standard deviation of white noise, rad/s.
    pub noise: f64,
    /// Constant error, rad/s.
    pub bias: f64,
    /// Scale error e: the sensor reads (1 + e) r.
    pub scale_error: f64,
}

/// The rudder feedback.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RudderSensor {
    /// Standard deviation of white noise, rad.
    pub noise: f64,
    /// Quantum of the reading, rad; 0 for none.
    pub quantum: f64,
}

/// The clock of the recorder.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Clock {
    /// Standard deviation of the true sampling instant about its stamp, s; cut at 0.45 periods, so rows keep their
    /// order.
    pub jitter: f64,
    /// Time by which the heading (and yaw rate, speed, wind) in a row is older than the rudder in it, s; negative when
    /// it is the rudder that is late.
    pub heading_delay: f64,
}

/// What a lost row loses.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Loses {
    /// The heading (NaN in the record); the other channels stay.
    #[default]
    Heading,
    /// The whole row.
    Row,
}

/// Losses that come in runs of rows: a two-state Markov chain.
///
/// Source: Gilbert (1960), Bell System Technical Journal 39:1253-1265.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bursts {
    /// Probability per good row that a burst begins with the next one.
    pub probability: f64,
    /// Mean length of a burst, rows, at least 1.
    pub mean_rows: f64,
}

/// Rows that are lost.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DropOut {
    /// Probability that a single row is lost, independently of the others.
    pub probability: f64,
    /// Losses in runs of rows.
    pub bursts: Option<Bursts>,
    /// What a lost row loses.
    pub loses: Loses,
}

/// All instruments of a trial; the default is perfect and has no rate-of-turn indicator.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sensors {
    /// The gyrocompass.
    pub heading: HeadingSensor,
    /// The rate-of-turn indicator, where there is one.
    pub yaw_rate: Option<YawRateSensor>,
    /// The rudder feedback.
    pub rudder: RudderSensor,
    /// The clock of the recorder.
    pub clock: Clock,
    /// Rows that are lost.
    pub drop_out: DropOut,
}

/// The multiple of `quantum` that is nearest to `value`; the value itself without a quantum.
pub(crate) fn quantise(value: f64, quantum: f64) -> f64 {
    if quantum > 0.0 { (value / quantum).round() * quantum } else { value }
}

/// Lags of a gyrocompass, s, other than none; a shorter one would only shorten the step of the solver.
const SHORTEST_LAG: f64 = 0.01;
const LONGEST_LAG: f64 = 100.0;

/// Largest spike, deg: no heading is further from another one.
const LARGEST_SPIKE_DEG: f64 = 180.0;

impl Sensors {
    /// Checks every value; fails with the first one that makes no sense.
    pub fn validate(&self) -> Checked {
        error::not_negative("sensor.heading-noise-deg", self.heading.noise)?;
        error::not_negative("sensor.heading-quantum-deg", self.heading.quantum)?;
        if self.heading.lag != 0.0 {
            error::between("sensor.heading-lag-s", self.heading.lag, SHORTEST_LAG, LONGEST_LAG)?;
        }
        error::finite("sensor.heading-bias-deg", self.heading.bias)?;
        if let Some(wander) = &self.heading.wander {
            error::not_negative("sensor.heading-wander.sd-deg", wander.sd)?;
            error::positive_time("sensor.heading-wander.correlation-s", wander.correlation_time)?;
        }
        if let Some(spikes) = &self.heading.spikes {
            error::between("sensor.heading-spikes.probability", spikes.probability, 0.0, 1.0)?;
            error::positive("sensor.heading-spikes.size-deg", spikes.size)?;
            error::at_most("sensor.heading-spikes.size-deg", spikes.size, from_deg(LARGEST_SPIKE_DEG))?;
        }
        error::count("sensor.heading-every-rows", self.heading.every_rows, MOST_ROWS)?;
        if let Some(yaw_rate) = &self.yaw_rate {
            error::not_negative("sensor.yaw-rate-noise-deg-s", yaw_rate.noise)?;
            error::finite("sensor.yaw-rate-bias-deg-s", yaw_rate.bias)?;
            error::finite("sensor.yaw-rate-scale-error", yaw_rate.scale_error)?;
        }
        error::not_negative("sensor.rudder-noise-deg", self.rudder.noise)?;
        error::not_negative("sensor.rudder-quantum-deg", self.rudder.quantum)?;
        error::time("sensor.jitter-s", self.clock.jitter)?;
        error::between("sensor.heading-delay-s", self.clock.heading_delay, -LONGEST_TIME, LONGEST_TIME)?;
        error::between("sensor.drop-out.probability", self.drop_out.probability, 0.0, 1.0)?;
        if let Some(bursts) = &self.drop_out.bursts {
            error::between("sensor.drop-out.burst-probability", bursts.probability, 0.0, 1.0)?;
            error::between("sensor.drop-out.burst-mean-rows", bursts.mean_rows, 1.0, 1e9)?;
        }
        Ok(())
    }

    /// The noise such instruments declare, which is independent from reading to reading: white noise and quantisation
    /// (q/√12) together; `None` where there is neither. Nobody declares waves, lag, bias, a coloured error or spikes:
    /// one standard deviation cannot say them.
    pub fn declared_noise(&self) -> Noise {
        let total = |noise: f64, quantum: f64| {
            let sd = noise.hypot(quantum / 12.0_f64.sqrt());
            (sd > 0.0).then_some(sd)
        };
        Noise {
            heading: total(self.heading.noise, self.heading.quantum),
            yaw_rate: self.yaw_rate.and_then(|sensor| total(sensor.noise, 0.0)),
            rudder: total(self.rudder.noise, self.rudder.quantum),
        }
    }
}
