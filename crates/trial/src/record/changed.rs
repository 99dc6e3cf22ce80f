//! Derived records: without some channels, readings or a current, with another rudder, at another scale.

use std::collections::BTreeMap;
use std::sync::Arc;

use ship::Particulars;

use super::{RecordOrigin, RecordedRudder, RejectedReading, Trial, TrialError, signal};
use crate::channel::Channel;

impl Trial {
    /// The same record without some channels; heading and rudder are always kept.
    pub fn without_channels(mut self, channels: &[Channel]) -> Self {
        self.channels.retain(|channel, _| *channel == Channel::Heading || !channels.contains(channel));
        self
    }

    /// The same record with the drift of a uniform current (north and east, m/s) removed from its positions; the
    /// position of the first row is unchanged.
    pub fn without_current(mut self, velocity: [f64; 2]) -> Self {
        let since: Vec<f64> = self.time().iter().map(|time| time - self.time()[0]).collect();
        for (channel, speed) in [Channel::North, Channel::East].into_iter().zip(velocity) {
            let values = self.channels.get_mut(&channel).into_iter().flatten();
            values.zip(&since).for_each(|(value, time)| *value -= speed * time);
        }
        self
    }

    /// The same record without the headings at given times, s.
    pub fn without_headings(mut self, times: &[f64]) -> Self {
        let rows: Vec<usize> = (0..self.len()).filter(|&row| times.contains(&self.time()[row])).collect();
        if let Some(heading) = self.channels.get_mut(&Channel::Heading) {
            rows.into_iter().for_each(|row| heading[row] = f64::NAN);
        }
        self
    }

    /// Record of another trial with the same rudder at the same times, and no declarations; `channels` are all but time
    /// and rudder. Fails as [`new`](Self::new) does.
    pub fn with_same_rudder(
        &self,
        name: String,
        origin: RecordOrigin,
        channels: BTreeMap<Channel, Vec<f64>>,
    ) -> Result<Self, TrialError> {
        if let Some((&channel, values)) = channels.iter().find(|(_, values)| values.len() != self.len()) {
            return Err(TrialError::Length { channel, rows: values.len(), expected: self.len() });
        }
        Self::from_rudder(Arc::clone(&self.rudder), name, origin, channels, Vec::new())
    }

    /// The same record with other rudder angles, rad; `None` unless there is a finite angle for every row.
    pub fn with_rudder(mut self, angles: Vec<f64>) -> Option<Self> {
        self.rudder = Arc::new(RecordedRudder::new(signal(self.time().to_vec(), angles).ok()?));
        Some(self)
    }

    /// Record of a similar ship of another length and approach speed: times are multiplied by
    /// (L₂/V₂)/(L₁/V₁), yaw rate and propeller rate divided by it, speeds multiplied by V₂/V₁ and lengths by L₂/L₁.
    /// Angles, unknown columns and declared conditions are unchanged.
    ///
    /// Dimensionless quantities (K', T') are invariant. `None` if length and speed of this ship are not declared
    /// or a factor is not a positive number. Source: Froude (1868) for V ~ √L; the prime system for any speed.
    pub fn scaled_to(&self, particulars: Particulars) -> Option<Self> {
        let ship = self.particulars?;
        let second = ship.similarity_factor_to(particulars, [1, 0]);
        let metre = ship.similarity_factor_to(particulars, [0, 1]);
        if ![second, metre].iter().all(|factor| factor.is_finite() && *factor > 0.0) {
            return None;
        }
        let factor = |channel: Channel| ship.similarity_factor_to(particulars, channel.dimension());
        let times = self.time().iter().map(|time| time * second).collect();
        let mut scaled = self.clone();
        scaled.rudder = Arc::new(RecordedRudder::new(signal(times, self.rudder().to_vec()).ok()?));
        for (channel, values) in &mut scaled.channels {
            values.iter_mut().for_each(|value| *value *= factor(*channel));
        }
        for reading in &mut scaled.rejected {
            *reading = RejectedReading {
                time: reading.time * second,
                value: reading.value * factor(reading.channel),
                ..*reading
            };
        }
        scaled.noise.yaw_rate_sd = self.noise.yaw_rate_sd.map(|sd| sd * factor(Channel::YawRate));
        scaled.particulars = Some(particulars);
        Some(scaled)
    }
}
