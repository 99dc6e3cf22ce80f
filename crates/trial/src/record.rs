//! Record of a trial: columns that belong together, checked when the record is made.

mod changed;
mod corners;
pub(crate) mod wind;

use std::collections::BTreeMap;
use std::sync::Arc;

use ship::signal::SignalError;
use ship::vessel::prior::HullParticulars;
use ship::{Particulars, Polyline};
use thiserror::Error;

use crate::channel::Channel;
use crate::conditions::{ConditionShortcoming, DeclaredConditions, DeclaredWeather, MAX_READING_INTERVAL_S};
use corners::RecordedRudder;
use estimation::statistics::upper_median;

pub use corners::RudderCorner;

/// Origin of a record.
#[derive(Debug, Clone, PartialEq)]
pub enum RecordOrigin {
    /// Simulated: the scenario and the position of the trial in it.
    Simulated {
        /// Name of the scenario.
        scenario: String,
        /// Number of the cell in the design of the scenario.
        cell: u64,
        /// Number of the replicate in the cell.
        replicate: u64,
    },
    /// Measured: the file and its content.
    Measured {
        /// File as named by the user.
        file: String,
        /// SHA-256 of the bytes, hexadecimal.
        sha256: String,
    },
}

/// Declared standard deviations of the sensors; `None` if undeclared.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SensorNoise {
    /// Standard deviation of the heading, rad.
    pub heading_sd: Option<f64>,
    /// Standard deviation of the yaw rate, rad/s.
    pub yaw_rate_sd: Option<f64>,
    /// Standard deviation of the rudder angle, rad.
    pub rudder_sd: Option<f64>,
}

/// Columns of a record, in SI units and radians; NaN for missing.
#[derive(Debug, Clone, Default)]
pub struct Columns {
    /// Time, s. Rows with a missing time or rudder must be omitted before a record is made.
    pub time: Vec<f64>,
    /// Other channels, each as long as `time`.
    pub channels: BTreeMap<Channel, Vec<f64>>,
    /// Name and values of each column with an unknown name, unchanged.
    pub unknown_columns: Vec<(String, Vec<f64>)>,
}

impl Columns {
    /// Omits the rows whose flag in `keep` is `false`.
    pub(crate) fn retain(&mut self, keep: &[bool]) {
        let retain_rows = |values: &mut Vec<f64>| {
            let mut keep = keep.iter();
            values.retain(|_| keep.next().is_none_or(|keep| *keep));
        };
        retain_rows(&mut self.time);
        self.channels.values_mut().for_each(retain_rows);
        self.unknown_columns.iter_mut().for_each(|(_, values)| retain_rows(values));
    }
}

/// Reading set to missing by the cleaning, or reported as doubtful.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RejectedReading {
    /// Channel of the reading.
    pub channel: Channel,
    /// Time, s.
    pub time: f64,
    /// Reading, in SI units and radians; a heading unwrapped.
    pub value: f64,
}

/// Reason why columns do not form a record.
#[derive(Debug, Clone, PartialEq, Error)]
#[expect(missing_docs, reason = "the message of a variant says what its fields are")]
pub enum TrialError {
    /// Absent required quantity.
    #[error("the record has no {0}")]
    Missing(&'static str),
    /// Columns of different length.
    #[error("{channel:?} has {rows} values, time has {expected}")]
    Length { channel: Channel, rows: usize, expected: usize },
    /// Fewer rows than the minimum.
    #[error("a record needs at least {needed} rows with heading and rudder; this record has {rows}")]
    TooShort { needed: usize, rows: usize },
    /// Time that does not increase or is not finite.
    #[error("time must increase: row {row} has {time} s after {before} s")]
    Time { row: usize, before: f64, time: f64 },
    /// Rudder angle that is not finite.
    #[error("row {row} has no rudder angle")]
    Rudder { row: usize },
}

/// One manoeuvring trial as a time series; immutable, in SI units and radians.
///
/// Time increases strictly; the rudder is finite in every row; heading and other channels may be missing in single
/// rows, as NaN. A record without a heading column has the integral of its yaw rate, and a flag for it.
///
/// ```
/// use kempf_trial::{Channel, Columns, RecordOrigin, Trial};
///
/// let time: Vec<f64> = (0..60).map(f64::from).collect();
/// let rudder = time.iter().map(|t| if *t < 30.0 { 0.17 } else { -0.17 }).collect();
/// let heading = time.iter().map(|t| 0.3 * (t / 15.0).sin()).collect();
/// let channels = [(Channel::Rudder, rudder), (Channel::Heading, heading)].into();
/// let origin = RecordOrigin::Measured { file: "run.csv".into(), sha256: String::new() };
/// let trial = Trial::new("run", origin, Columns { time, channels, unknown_columns: Vec::new() })?;
/// assert_eq!((trial.len(), trial.duration(), trial.sampling_period()), (60, 59.0, 1.0));
/// # Ok::<(), kempf_trial::TrialError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Trial {
    name: String,
    origin: RecordOrigin,
    /// Times and rudder, shared by the records of all trials with the same rudder.
    rudder: Arc<RecordedRudder>,
    channels: BTreeMap<Channel, Vec<f64>>,
    unknown: Vec<(String, Vec<f64>)>,
    is_heading_integrated: bool,
    noise: SensorNoise,
    particulars: Option<Particulars>,
    conditions: DeclaredConditions,
    rejected: Vec<RejectedReading>,
}

/// Rudder angle (rad) over time (s) through every row. Fails if time does not increase or an angle is not finite.
fn signal(time: Vec<f64>, rudder: Vec<f64>) -> Result<Polyline, TrialError> {
    let rows = time.len();
    Polyline::new(time, rudder).map_err(|error| match error {
        SignalError::Point { index: row, before, time, .. } if time.is_finite() && time > before => {
            TrialError::Rudder { row }
        }
        SignalError::Point { index: row, before, time, .. } => TrialError::Time { row, before, time },
        SignalError::Empty | SignalError::Lengths { .. } => TrialError::TooShort { needed: Trial::MIN_ROWS, rows },
    })
}

impl Trial {
    /// Minimum number of rows with a heading.
    pub const MIN_ROWS: usize = 8;

    /// Record of checked columns.
    ///
    /// Fails if the rudder, or both heading and yaw rate, are absent; if columns differ in length; if time does
    /// not increase; or if fewer than [`MIN_ROWS`](Self::MIN_ROWS) rows contain a heading.
    pub fn new(name: impl Into<String>, origin: RecordOrigin, columns: Columns) -> Result<Self, TrialError> {
        let Columns { time, mut channels, unknown_columns: unknown } = columns;
        for (&channel, values) in &channels {
            if values.len() != time.len() {
                return Err(TrialError::Length { channel, rows: values.len(), expected: time.len() });
            }
        }
        let rudder = channels.remove(&Channel::Rudder).ok_or(TrialError::Missing("rudder angle"))?;
        let rudder = Arc::new(RecordedRudder::new(signal(time, rudder)?));
        Self::from_rudder(rudder, name.into(), origin, channels, unknown)
    }

    fn from_rudder(
        rudder: Arc<RecordedRudder>,
        name: String,
        origin: RecordOrigin,
        mut channels: BTreeMap<Channel, Vec<f64>>,
        unknown: Vec<(String, Vec<f64>)>,
    ) -> Result<Self, TrialError> {
        let is_heading_integrated = !channels.contains_key(&Channel::Heading);
        if is_heading_integrated {
            let rate = channels.get(&Channel::YawRate).ok_or(TrialError::Missing("heading and no yaw rate"))?;
            channels.insert(Channel::Heading, integrate(rudder.rows.times(), rate));
        }
        let headings = channels[&Channel::Heading].iter().filter(|psi| psi.is_finite()).count();
        if headings < Self::MIN_ROWS {
            return Err(TrialError::TooShort { needed: Self::MIN_ROWS, rows: headings });
        }
        Ok(Self {
            name,
            origin,
            rudder,
            channels,
            unknown,
            is_heading_integrated,
            noise: SensorNoise::default(),
            particulars: None,
            conditions: DeclaredConditions::default(),
            rejected: Vec::new(),
        })
    }

    /// The same record with declared sensor noise.
    pub fn with_noise(self, noise: SensorNoise) -> Self {
        Self { noise, ..self }
    }

    /// The same record with length and speed of the ship.
    pub fn with_particulars(self, particulars: Particulars) -> Self {
        Self { particulars: Some(particulars), ..self }
    }

    /// The same record with the declared conditions of the trial (form of MSC/Circ.1053).
    pub fn with_conditions(self, conditions: DeclaredConditions) -> Self {
        Self { conditions, ..self }
    }

    /// The same record with its rejected readings: those set to missing or reported as doubtful.
    pub fn with_rejected(self, rejected: Vec<RejectedReading>) -> Self {
        Self { rejected, ..self }
    }

    /// Name of the record: the stem of its file, or the cell of its scenario.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Name of the record for display.
    pub fn title(&self) -> String {
        document::names::record_name(&self.name)
    }

    /// Origin of the record.
    pub fn origin(&self) -> &RecordOrigin {
        &self.origin
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.time().len()
    }

    /// Always `false`: a record has at least [`MIN_ROWS`](Self::MIN_ROWS) rows.
    pub fn is_empty(&self) -> bool {
        self.time().is_empty()
    }

    /// Time of every row, s, strictly increasing; the clock of the record, not necessarily from 0.
    pub fn time(&self) -> &[f64] {
        self.rudder.rows.times()
    }

    /// Duration of the record, s.
    pub fn duration(&self) -> f64 {
        self.time()[self.len() - 1] - self.time()[0]
    }

    /// Median time between rows, s; in a long record the median of at most a hundred thousand evenly chosen intervals.
    pub fn sampling_period(&self) -> f64 {
        const MAX_INTERVALS: usize = 100_000;
        let pairs = self.time().windows(2).step_by(self.len() / MAX_INTERVALS + 1);
        upper_median(pairs.map(|pair| pair[1] - pair[0])).expect("a record has rows")
    }

    /// Heading of every row, rad, unwrapped; NaN if missing.
    pub fn heading(&self) -> &[f64] {
        &self.channels[&Channel::Heading]
    }

    /// `true` if the heading is the integral of the yaw rate, because none was recorded.
    pub fn is_heading_integrated(&self) -> bool {
        self.is_heading_integrated
    }

    /// Rudder angle of every row, rad.
    pub fn rudder(&self) -> &[f64] {
        self.rudder.rows.values()
    }

    /// Maximum magnitude of the rudder angle, rad.
    pub fn largest_rudder(&self) -> f64 {
        self.rudder().iter().fold(0.0, |largest, angle| largest.max(angle.abs()))
    }

    /// Rudder as a signal: linear between rows and the [corners](Self::rudder_corners) between them.
    pub fn rudder_signal(&self) -> &Polyline {
        self.rudder.path()
    }

    /// Instants between rows at which the rudder begins or ends a stroke, in the order of time; empty unless it rests
    /// or moves at a constant rate.
    pub fn rudder_corners(&self) -> &[RudderCorner] {
        &self.rudder.corners
    }

    /// Yaw rate of every row, rad/s, NaN if missing in a row; `None` if it was not recorded.
    pub fn yaw_rate(&self) -> Option<&[f64]> {
        self.channel(Channel::YawRate)
    }

    /// Any channel, row by row, in SI units and radians; `None` if it was not recorded.
    pub fn channel(&self, channel: Channel) -> Option<&[f64]> {
        match channel {
            Channel::Rudder => Some(self.rudder()),
            channel => self.channels.get(&channel).map(Vec::as_slice),
        }
    }

    /// Channels of the record, except the rudder.
    pub fn channels(&self) -> impl Iterator<Item = (Channel, &[f64])> {
        self.channels.iter().map(|(&channel, values)| (channel, values.as_slice()))
    }

    /// Columns with an unknown name, as read.
    pub fn unknown_columns(&self) -> &[(String, Vec<f64>)] {
        &self.unknown
    }

    /// Declared sensor noise.
    pub fn noise(&self) -> SensorNoise {
        self.noise
    }

    /// Readings set to missing by the cleaning, or reported as doubtful.
    pub fn rejected(&self) -> &[RejectedReading] {
        &self.rejected
    }

    /// Length and approach speed of the ship; `None` if undeclared.
    pub fn particulars(&self) -> Option<Particulars> {
        self.particulars
    }

    /// Declared particulars of the hull; `None` if length and speed are not declared.
    pub fn hull(&self) -> Option<HullParticulars> {
        self.particulars.map(|Particulars { length, speed }| HullParticulars { length, speed, ..self.conditions.hull })
    }

    /// Declared conditions of the trial (form of MSC/Circ.1053).
    pub fn conditions(&self) -> &DeclaredConditions {
        &self.conditions
    }

    /// `true` if the sidecar declares calm weather.
    pub fn is_calm(&self) -> bool {
        self.conditions.weather == Some(DeclaredWeather::Calm)
    }

    /// Deviations from the trial conditions of MSC/Circ.1053 (2002), 2.2, and conditions that are not declared.
    pub fn shortcomings(&self) -> Vec<ConditionShortcoming> {
        let mut shortcomings = self.conditions.shortcomings();
        let seconds = self.sampling_period();
        shortcomings.extend((seconds > MAX_READING_INTERVAL_S).then_some(ConditionShortcoming::Interval { seconds }));
        shortcomings
    }

    /// Rows with a recorded heading.
    pub fn observed_rows(&self) -> impl Iterator<Item = usize> {
        self.heading().iter().enumerate().filter(|(_, psi)| psi.is_finite()).map(|(row, _)| row)
    }
}

/// Trapezoid integral of a rate (unit/s) over time (s), from 0. NaN in rows without a rate, which the integral bridges.
pub(crate) fn integrate(time: &[f64], rate: &[f64]) -> Vec<f64> {
    let mut total = 0.0;
    let mut last: Option<(f64, f64)> = None;
    time.iter()
        .zip(rate)
        .map(|(&t, &r)| {
            if !r.is_finite() {
                return f64::NAN;
            }
            if let Some((before, rate)) = last {
                total += 0.5 * (r + rate) * (t - before);
            }
            last = Some((t, r));
            total
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Dimensionless quantities are invariant, scaling back is the identity, and an unknown scale gives no record.
    #[test]
    fn another_scale_keeps_what_has_no_dimension() {
        let time: Vec<f64> = (0..60).map(|row| 3.0 + 0.5 * f64::from(row)).collect();
        let values_of = |value: fn(f64) -> f64| time.iter().map(|t| value(*t)).collect::<Vec<f64>>();
        let channels = [
            (Channel::Rudder, values_of(|t| 0.1 * (0.3 * t).sin())),
            (Channel::Heading, values_of(|t| 0.2 * (0.3 * t).cos())),
            (Channel::YawRate, values_of(|t| -0.06 * (0.3 * t).sin())),
            (Channel::Speed, values_of(|_| 1.2)),
            (Channel::North, values_of(|t| 1.2 * t)),
        ];
        let origin = RecordOrigin::Measured { file: "run.csv".into(), sha256: String::new() };
        let columns = Columns { time: time.clone(), channels: channels.into(), unknown_columns: Vec::new() };
        let trial = Trial::new("run", origin, columns).expect("a record");
        let (model, ship) = (Particulars { length: 7.0, speed: 1.2 }, Particulars { length: 320.0, speed: 8.0 });
        assert!(trial.scaled_to(ship).is_none());
        let trial =
            trial.with_particulars(model).with_noise(SensorNoise { yaw_rate_sd: Some(0.01), ..SensorNoise::default() });
        let large = trial.scaled_to(ship).expect("a known scale");
        let prime = |trial: &Trial, channel: Channel| {
            let factor = trial.particulars().expect("declared").prime_factor(channel.dimension());
            trial.channel(channel).expect("a channel")[20] * factor
        };
        for channel in [Channel::Heading, Channel::Rudder, Channel::YawRate, Channel::Speed, Channel::North] {
            assert!((prime(&trial, channel) - prime(&large, channel)).abs() < 1e-12, "{channel:?}");
        }
        assert!((large.duration() / trial.duration() - 40.0 / (7.0 / 1.2)).abs() < 1e-12);
        // The yaw rate is still the slope of the heading.
        let slope = |trial: &Trial| (trial.heading()[21] - trial.heading()[19]) / (trial.time()[21] - trial.time()[19]);
        let ratio = |trial: &Trial| slope(trial) / trial.yaw_rate().expect("a channel")[20];
        assert!((ratio(&large) / ratio(&trial) - 1.0).abs() < 1e-12);
        let back = large.scaled_to(model).expect("a known scale");
        assert!(back.time().iter().zip(&time).all(|(one, other)| (one - other).abs() < 1e-12));
        assert!((back.noise().yaw_rate_sd.expect("declared") - 0.01).abs() < 1e-15);
        assert!(trial.scaled_to(Particulars { length: 0.0, speed: 1.0 }).is_none());
    }
}
