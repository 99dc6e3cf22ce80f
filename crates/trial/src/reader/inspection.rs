//! What a log holds, channel by channel, before anything is fitted: from where, how often, in which steps, and how it
//! stands to the channel that it can be held against.

use ship::Polyline;

use super::source::{ChannelReadings, Log};
use crate::channel::Channel;
use crate::plausibility::range;
use crate::plausibility::regression::{partial_slope, rudder_on_heading, thinned, turn_with_rudder};
use crate::record::{Origin, Trial, integrate};

/// Share of one channel that another has to explain before anything is said of the two.
const EXPLAINED: f64 = 0.5;

/// Farthest that one channel may be behind another, s, and as a share of the log.
const FARTHEST: (f64, f64) = (10.0, 0.1);

/// Lags that are tried on either side of zero.
const LAGS: i32 = 40;

/// A heading that moves further is that of a turning circle, rad.
const TURNED: f64 = std::f64::consts::TAU;

/// How a channel stands to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChannelRelation {
    /// The other.
    pub reference: Channel,
    /// What it has to be multiplied with to be the other; below zero where its sign is turned.
    pub scale: f64,
    /// How far it is behind the other, s; `None` where no lag within reach is the best.
    pub lag: Option<f64>,
}

/// A channel of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelInspection {
    /// What was read.
    pub readings: ChannelReadings,
    /// Whether its positive values turn the ship to starboard; `None` where it does not turn her, or nobody can tell.
    pub to_starboard: Option<bool>,
    /// How it stands to the channel that it can be held against: the yaw rate to the heading, the rudder to its order.
    pub relation: Option<ChannelRelation>,
}

impl Log {
    /// Every channel that was read, without a fit: signs and scales come from linear regressions on integrals.
    pub fn inspect(&self) -> Vec<ChannelInspection> {
        let steered = self.steers();
        let yaw_rate = self.related([Channel::YawRate, Channel::Heading], integrate);
        let rudder = self.related([Channel::Rudder, Channel::RudderOrder], |_, values| values.to_vec());
        let of = |readings: &ChannelReadings| {
            let (to_starboard, relation) = match readings.channel {
                Channel::Rudder => (steered, rudder),
                Channel::RudderOrder => {
                    (steered.zip(rudder).map(|(side, relation)| side == (relation.scale > 0.0)), None)
                }
                Channel::YawRate => (yaw_rate.map(|relation| relation.scale > 0.0), yaw_rate),
                _ => (None, None),
            };
            ChannelInspection { readings: readings.clone(), to_starboard, relation }
        };
        self.readings.iter().map(of).collect()
    }

    /// Whether positive rudder turns the ship to starboard.
    fn steers(&self) -> Option<bool> {
        let origin = Origin::Measured { file: String::new(), sha256: String::new() };
        let trial = Trial::new("", origin, self.columns.clone()).ok()?;
        let is_circle = range(trial.heading()) > TURNED;
        let slope = if is_circle { turn_with_rudder(&trial) } else { rudder_on_heading(&trial) };
        slope.filter(|slope| slope.share >= EXPLAINED).map(|slope| slope.value > 0.0)
    }

    /// A channel, or what is `made` of it over time, against another: y = c₀ + c₁ t + s x(t + lag), with the lag that
    /// explains most.
    fn related(
        &self,
        [channel, reference]: [Channel; 2],
        made: impl Fn(&[f64], &[f64]) -> Vec<f64>,
    ) -> Option<ChannelRelation> {
        let time = self.time();
        let (x, y) = (made(time, self.channel(channel)?), self.channel(reference)?);
        let read = |values: &[f64]| (0..time.len()).filter(|&row| values[row].is_finite()).collect::<Vec<usize>>();
        let rows = read(&x);
        let path = Polyline::new(rows.iter().map(|&row| time[row]).collect(), rows.iter().map(|&row| x[row]).collect());
        let (path, ends) = (path.ok()?, [time[*rows.first()?], time[*rows.last()?]]);
        let reach = FARTHEST.0.min(FARTHEST.1 * (ends[1] - ends[0]));
        let inner = read(y).into_iter().filter(|&row| time[row] > ends[0] + reach && time[row] < ends[1] - reach);
        let inner: Vec<usize> = thinned(inner).collect();
        let slope = |lag: f64| {
            let row = |&row: &usize| [1.0, time[row] - ends[0], path.at(time[row] + lag), y[row]];
            partial_slope(inner.iter().map(row).collect())
        };
        let step = reach / f64::from(LAGS);
        let share = |number: i32| slope(step * f64::from(number)).map_or(0.0, |slope| slope.share);
        let shares: Vec<f64> = (-LAGS..=LAGS).map(share).collect();
        let best = (0..shares.len()).max_by(|&first, &second| shares[first].total_cmp(&shares[second]))?;
        let peak = |place: usize| {
            let [before, at, after] = [shares[place - 1], shares[place], shares[place + 1]];
            let bend = before - 2.0 * at + after;
            step * (place as f64 - f64::from(LAGS) + if bend < 0.0 { 0.5 * (before - after) / bend } else { 0.0 })
        };
        let lag = (1..shares.len() - 1).contains(&best).then(|| peak(best));
        let slope = slope(lag.unwrap_or(0.0)).filter(|slope| slope.share >= EXPLAINED)?;
        Some(ChannelRelation { reference, scale: slope.value, lag })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write;

    /// A ship of K = 0.1 1/s and T = 15 s, whose rudder follows its order 2 s later, seen by a yaw rate with `sign`
    /// in deg/min and 3 s late.
    fn log(sign: f64, row: impl Fn(usize) -> bool) -> Log {
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
        Log::of_bytes("run.csv".as_ref(), text.as_bytes(), None, None).expect("a log")
    }

    fn of(all: &[ChannelInspection], channel: Channel) -> &ChannelInspection {
        all.iter().find(|inspected| inspected.readings.channel == channel).expect("it was read")
    }

    #[test]
    fn a_log_is_told_channel_by_channel() {
        let all = log(1.0, |row| !(100..109).contains(&row)).inspect();
        let heading = &of(&all, Channel::Heading).readings;
        assert_eq!((heading.source.as_deref(), heading.count, heading.interval), (Some("heading_deg"), 391, Some(1.0)));
        assert_eq!(heading.longest, Some([99.0, 10.0]));
        assert!(heading.step.is_some_and(|step| (step.to_degrees() - 0.1).abs() < 1e-9), "{heading:?}");
        assert!(heading.wraps.is_some_and(|wraps| wraps > 0) && of(&all, Channel::Speed).readings.wraps.is_none());
        let rate = of(&all, Channel::YawRate);
        assert_eq!(rate.to_starboard, Some(true));
        let relation = rate.relation.expect("it is that of the heading");
        assert!((relation.scale - 1.0).abs() < 0.02, "{relation:?}");
        assert!(relation.lag.is_some_and(|lag| (lag - 3.0).abs() < 0.3), "{relation:?}");
        let rudder = of(&all, Channel::Rudder);
        assert_eq!((rudder.to_starboard, of(&all, Channel::RudderOrder).to_starboard), (Some(true), Some(true)));
        let relation = rudder.relation.expect("it has an order");
        assert!((relation.scale - 1.0).abs() < 0.05, "{relation:?}");
        assert!(relation.lag.is_some_and(|lag| (lag - 2.0).abs() < 0.3), "{relation:?}");
        assert_eq!(of(&all, Channel::Speed).readings.step, None);
    }

    /// Signs that contradict each other are told and not refused.
    #[test]
    fn a_turned_sign_is_seen() {
        let all = log(-1.0, |_| true).inspect();
        let rate = of(&all, Channel::YawRate);
        assert_eq!((rate.to_starboard, of(&all, Channel::Rudder).to_starboard), (Some(false), Some(true)));
        assert!(rate.relation.is_some_and(|relation| (relation.scale + 1.0).abs() < 0.02), "{rate:?}");
    }
}
