//! Inspection of a log, channel by channel, without a fit: source, interval and resolution of the readings, sign, and
//! scale and lag against a reference channel.

use ship::Polyline;

use super::source::{ChannelReadings, InstrumentLog};
use crate::channel::Channel;
use crate::plausibility::range;
use crate::plausibility::regression::{first_order_gain, partial_slope, steady_turn_gain, thinned};
use crate::record::{RecordOrigin, Trial, integrate};

/// Minimum share of a channel explained by its reference.
const MIN_SHARE: f64 = 0.5;

/// Maximum lag, s, and as a share of the log.
const MAX_LAG: (f64, f64) = (10.0, 0.1);

/// Number of lags tried on either side of zero.
const LAGS: i32 = 40;

/// Maximum range of a heading outside a turning circle, rad.
const MAX_SWING: f64 = std::f64::consts::TAU;

/// Relation of a channel to a reference channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelRelation {
    /// Reference channel.
    pub reference: Channel,
    /// Factor from the channel to the reference; negative for opposite signs.
    pub factor_to_reference: f64,
    /// Lag behind the reference, s; `None` if the best lag is at the end of the range.
    pub lag_behind_reference: Option<f64>,
}

/// Inspection of a channel of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelInspection {
    /// Statistics of the readings.
    pub readings: ChannelReadings,
    /// `true` if positive values turn the ship to starboard; `None` if the log does not determine it.
    pub to_starboard: Option<bool>,
    /// Relation of the yaw rate to the heading, or of the rudder to its order; `None` for other channels, and if the
    /// reference explains too little.
    pub relation: Option<ChannelRelation>,
}

impl InstrumentLog {
    /// Inspection of every channel that was read; signs and scales come from linear regressions on integrals.
    pub fn inspect(&self) -> Vec<ChannelInspection> {
        let steered = self.turns_with_rudder();
        let yaw_rate = self.relation([Channel::YawRate, Channel::Heading], integrate);
        let rudder = self.relation([Channel::Rudder, Channel::RudderOrder], |_, values| values.to_vec());
        let inspection = |readings: ChannelReadings| {
            let (to_starboard, relation) = match readings.channel {
                Channel::Rudder => (steered, rudder),
                Channel::RudderOrder => {
                    (steered.zip(rudder).map(|(side, relation)| side == (relation.factor_to_reference > 0.0)), None)
                }
                Channel::YawRate => (yaw_rate.map(|relation| relation.factor_to_reference > 0.0), yaw_rate),
                _ => (None, None),
            };
            ChannelInspection { readings, to_starboard, relation }
        };
        self.readings().into_iter().map(inspection).collect()
    }

    /// `true` if positive rudder turns the ship to starboard; `None` if the log does not determine it.
    fn turns_with_rudder(&self) -> Option<bool> {
        let origin = RecordOrigin::Measured { file: String::new(), sha256: String::new() };
        let trial = Trial::new("", origin, self.columns.clone()).ok()?;
        let is_circle = range(trial.heading()) > MAX_SWING;
        let slope = if is_circle { steady_turn_gain(&trial) } else { first_order_gain(&trial) };
        slope.filter(|slope| slope.share >= MIN_SHARE).map(|slope| slope.value > 0.0)
    }

    /// Relation of a transformed channel x to a reference y: y = c₀ + c₁ t + s x(t + lag), with the lag that gives the
    /// maximum explained share. `None` if either channel is absent, and if that share is below [`MIN_SHARE`].
    fn relation(
        &self,
        [channel, reference]: [Channel; 2],
        transform: impl Fn(&[f64], &[f64]) -> Vec<f64>,
    ) -> Option<ChannelRelation> {
        let time = self.time();
        let (x, y) = (transform(time, self.channel(channel)?), self.channel(reference)?);
        let read = |values: &[f64]| (0..time.len()).filter(|&row| values[row].is_finite()).collect::<Vec<usize>>();
        let rows = read(&x);
        let path = Polyline::new(rows.iter().map(|&row| time[row]).collect(), rows.iter().map(|&row| x[row]).collect());
        let (path, ends) = (path.ok()?, [time[*rows.first()?], time[*rows.last()?]]);
        let reach = MAX_LAG.0.min(MAX_LAG.1 * (ends[1] - ends[0]));
        let inner = read(y).into_iter().filter(|&row| time[row] > ends[0] + reach && time[row] < ends[1] - reach);
        let inner: Vec<usize> = thinned(inner).collect();
        let slope = |lag: f64| {
            let row = |&row: &usize| [1.0, time[row] - ends[0], path.value_at(time[row] + lag), y[row]];
            partial_slope(inner.iter().map(row).collect())
        };
        let step = reach / f64::from(LAGS);
        let share = |number: i32| slope(step * f64::from(number)).map_or(0.0, |slope| slope.share);
        let shares: Vec<f64> = (-LAGS..=LAGS).map(share).collect();
        let best = (0..shares.len()).max_by(|&first, &second| shares[first].total_cmp(&shares[second]))?;
        let peak = |index: usize| {
            let [before, at, after] = [shares[index - 1], shares[index], shares[index + 1]];
            let bend = before - 2.0 * at + after;
            step * (index as f64 - f64::from(LAGS) + if bend < 0.0 { 0.5 * (before - after) / bend } else { 0.0 })
        };
        let lag = (1..shares.len() - 1).contains(&best).then(|| peak(best));
        let slope = slope(lag.unwrap_or(0.0)).filter(|slope| slope.share >= MIN_SHARE)?;
        Some(ChannelRelation { reference, factor_to_reference: slope.value, lag_behind_reference: lag })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write;

    /// A ship of K = 0.1 1/s and T = 15 s, whose rudder follows its order 2 s later, recorded with a yaw rate of `sign`
    /// in deg/min, 3 s late.
    fn log(sign: f64, row: impl Fn(usize) -> bool) -> InstrumentLog {
        let mut text = String::from("t_s,heading_deg,rudder_deg,rudder_order_deg,yaw_rate_deg_min,speed_kn\n");
        let order = |t: f64| if (t % 80.0) < 40.0 { 10.0 } else { -10.0 };
        let (mut psi, mut rates) = (355.0, vec![0.0; 1]);
        for number in 0..400_usize {
            let t = number as f64;
            let delta: f64 = order((t - 2.0).max(0.0));
            let late = rates[number.saturating_sub(3)];
            if row(number) {
                let angle: f64 = (10.0 * f64::rem_euclid(psi, 360.0)).round() / 10.0;
                writeln!(text, "{t},{angle},{delta},{},{},7", order(t), sign * 60.0 * late).expect("memory");
            }
            let rate = rates[number] + (0.1 * delta - rates[number]) / 15.0;
            psi += 0.5 * (rate + rates[number]);
            rates.push(rate);
        }
        InstrumentLog::from_reader("run.csv".as_ref(), text.as_bytes(), None, None).expect("a log")
    }

    fn inspected(all: &[ChannelInspection], channel: Channel) -> &ChannelInspection {
        all.iter().find(|inspected| inspected.readings.channel == channel).expect("it was read")
    }

    #[test]
    fn a_log_is_told_channel_by_channel() {
        let all = log(1.0, |row| !(100..109).contains(&row)).inspect();
        let heading = &inspected(&all, Channel::Heading).readings;
        assert_eq!(
            (heading.source.as_deref(), heading.reading_count, heading.median_interval),
            (Some("heading_deg"), 391, Some(1.0))
        );
        assert_eq!(heading.longest_gap, Some([99.0, 10.0]));
        assert!(heading.smallest_change.is_some_and(|change| (change.to_degrees() - 0.1).abs() < 1e-9), "{heading:?}");
        assert!(
            heading.north_crossings.is_some_and(|wraps| wraps > 0)
                && inspected(&all, Channel::Speed).readings.north_crossings.is_none()
        );
        let rate = inspected(&all, Channel::YawRate);
        assert_eq!(rate.to_starboard, Some(true));
        let relation = rate.relation.expect("it is that of the heading");
        assert!((relation.factor_to_reference - 1.0).abs() < 0.02, "{relation:?}");
        assert!(relation.lag_behind_reference.is_some_and(|lag| (lag - 3.0).abs() < 0.3), "{relation:?}");
        let rudder = inspected(&all, Channel::Rudder);
        assert_eq!((rudder.to_starboard, inspected(&all, Channel::RudderOrder).to_starboard), (Some(true), Some(true)));
        let relation = rudder.relation.expect("it has an order");
        assert!((relation.factor_to_reference - 1.0).abs() < 0.05, "{relation:?}");
        assert!(relation.lag_behind_reference.is_some_and(|lag| (lag - 2.0).abs() < 0.3), "{relation:?}");
        assert_eq!(inspected(&all, Channel::Speed).readings.smallest_change, None);
    }

    /// Contradictory signs are reported and not refused.
    #[test]
    fn a_turned_sign_is_seen() {
        let all = log(-1.0, |_| true).inspect();
        let rate = inspected(&all, Channel::YawRate);
        assert_eq!((rate.to_starboard, inspected(&all, Channel::Rudder).to_starboard), (Some(false), Some(true)));
        assert!(rate.relation.is_some_and(|relation| (relation.factor_to_reference + 1.0).abs() < 0.02), "{rate:?}");
    }
}
