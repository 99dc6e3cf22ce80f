//! Missing yaw moment of the base: smoothed over the time of a record, and as a function of candidate channels.
//!
//! The missing term is modelled as a random-walk state (Kristensen, Madsen and Jørgensen 2004) in addition to heading
//! and yaw rate of the fitted base, given as the rudder angle with the same moment. Its curve over yaw rate, rudder,
//! heading, speed, wind or sway shows its shape; an effect whose curve lies inside the band everywhere is consistent
//! with it. The parameters of the base are fixed: the bands do not include their uncertainty.

mod curve;
mod smoother;
#[cfg(test)]
mod tests;

use ship::{FirstOrder, Polyline};

use crate::record::PreparedRecord;
use curve::{MIN_ROWS, deviance, maximum_likelihood_level, variance};
use smoother::{HeadingRows, MomentFilter, MomentRows};

pub use curve::MomentCurve;

/// Channel over which a missing moment is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MomentChannel {
    /// Smoothed yaw rate, rad/s.
    YawRate,
    /// Recorded rudder, rad.
    Rudder,
    /// Smoothed heading, rad.
    Heading,
    /// Speed through the water, m/s.
    Speed,
    /// Direction of the relative wind from the bow, rad.
    WindFrom,
    /// Sway velocity, m/s.
    Sway,
}

impl MomentChannel {
    /// All channels.
    pub const ALL: [Self; 6] = [Self::YawRate, Self::Rudder, Self::Heading, Self::Speed, Self::WindFrom, Self::Sway];

    /// Name in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::YawRate => "yaw rate",
            Self::Rudder => "rudder",
            Self::Heading => "heading",
            Self::Speed => "speed",
            Self::WindFrom => "relative wind angle",
            Self::Sway => "sway",
        }
    }
}

/// Explanation of a missing moment: another model, by its replayed heading relative to the base.
#[derive(Debug, Clone, PartialEq)]
pub struct RelativeResponse {
    /// Effects of the model with their forms.
    pub effects: Vec<(&'static str, &'static str)>,
    /// Replayed headings, model minus base, at the observed rows, rad.
    pub heading: Vec<f64>,
}

/// Missing moment as a function of one channel.
#[derive(Debug, Clone, PartialEq)]
pub struct MomentOverChannel {
    /// Channel.
    pub channel: MomentChannel,
    /// Curve with its band.
    pub curve: MomentCurve,
    /// Share, 0 to 1, of the variance per second of the walk that the curve explains; `None` if the moment is constant.
    pub explained_share: Option<f64>,
    /// Indices of the explanations inside the band everywhere; empty if zero is inside as well.
    pub explanations_inside: Vec<usize>,
}

/// Missing moment of one record.
#[derive(Debug, Clone, PartialEq)]
pub struct MissingMoment {
    /// Times of the rows with a heading, s.
    pub time: Vec<f64>,
    /// Smoothed moment, rad of rudder.
    pub moment: Vec<f64>,
    /// Standard deviation of the smoothed moment, rad of rudder.
    pub moment_sd: Vec<f64>,
    /// Values of the available channels at the rows with a heading, SI units and rad.
    pub channels: Vec<(MomentChannel, Vec<f64>)>,
    /// Candidate explanations.
    pub explanations: Vec<RelativeResponse>,
    /// Moment of every explanation after the same smoother, rad of rudder.
    pub explanation_moments: Vec<Vec<f64>>,
    /// Curves over the channels that vary: first those whose band excludes zero, by increasing deviance.
    pub channel_moments: Vec<MomentOverChannel>,
}

fn at_rows(signal: &Polyline, time: &[f64]) -> Vec<f64> {
    time.iter().map(|&t| signal.value_at(t)).collect()
}

/// Sum of squared deviations from the mean.
fn spread(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| (value - mean).powi(2)).sum()
}

/// Minimum variance of a varying moment, rad² of rudder.
const MIN_VARIANCE: f64 = 1e-12;

impl MissingMoment {
    /// Missing moment of the base on a record with heading noise of about `sd` (rad); `None` for a record with too few
    /// headings, and for a rudder without effect.
    pub fn new(
        record: &PreparedRecord,
        base: &FirstOrder,
        sd: f64,
        explanations: Vec<RelativeResponse>,
    ) -> Option<Self> {
        let time: Vec<f64> = record.observed_rows.iter().map(|&row| record.time[row]).collect();
        let count = time.len();
        if count < MIN_ROWS || !base.K_over_T.is_normal() {
            return None;
        }
        let noise = |&row: &usize| record.full_readings as f64 / record.row_readings[row] as f64;
        let variances = record.observed_rows.iter().map(noise).collect();
        let rows = MomentRows::new(*base, time.clone(), variances, sd);
        let first = record.heading[record.observed_rows[0]];
        let heading = record.observed_rows.iter().map(|&row| record.heading[row] - first).collect();
        let column = HeadingRows { heading, forced: rows.rudder_response(&record.rudder) };
        let square = |filter: &MomentFilter| filter.whitened(&column).iter().map(|nu| nu * nu).sum::<f64>();
        let gain = base.K_over_T;
        let intensity =
            maximum_likelihood_level(&rows, gain, |filter| Some(deviance(square(filter), filter, count))).exp();
        let filter = rows.filter(intensity);
        let unit = variance(square(&filter), count, 0);
        let states = filter.smoothed(&column);
        let moment: Vec<f64> = states.iter().map(|state| state[2]).collect();

        let mut channels = vec![
            (MomentChannel::YawRate, states.iter().map(|state| state[1]).collect()),
            (MomentChannel::Rudder, at_rows(&record.rudder, &time)),
            (MomentChannel::Heading, states.iter().map(|state| first + state[0]).collect::<Vec<f64>>()),
        ];
        let signals = [
            (MomentChannel::Speed, &record.speed),
            (MomentChannel::WindFrom, &record.wind_from),
            (MomentChannel::Sway, &record.sway_velocity),
        ];
        channels.extend(
            signals.into_iter().filter_map(|(channel, signal)| Some((channel, at_rows(signal.as_ref()?, &time)))),
        );

        let still = vec![[0.0; 2]; count];
        let responses: Vec<HeadingRows> = explanations
            .iter()
            .map(|model| HeadingRows { heading: model.heading.clone(), forced: still.clone() })
            .collect();
        let varies = spread(&moment) > MIN_VARIANCE * count as f64;
        let mut channel_moments: Vec<MomentOverChannel> = channels
            .iter()
            .filter_map(|(channel, x)| {
                let curve = MomentCurve::new(&rows, gain, &column, x, &responses)?;
                let explained_share = varies.then(|| (1.0 - curve.walk_intensity / (intensity * unit)).max(0.0));
                let explanations_inside = match curve.contains_zero() {
                    true => Vec::new(),
                    false => (0..responses.len()).filter(|&k| curve.contains(&curve.explanations[k])).collect(),
                };
                Some(MomentOverChannel { channel: *channel, curve, explained_share, explanations_inside })
            })
            .collect();
        let rank = |moment: &MomentOverChannel| (moment.curve.contains_zero(), moment.curve.deviance);
        channel_moments.sort_by(|a, b| {
            let ((a, first), (b, second)) = (rank(a), rank(b));
            a.cmp(&b).then(first.total_cmp(&second))
        });
        Some(Self {
            moment_sd: filter.moment_variance().iter().map(|variance| (variance * unit).sqrt()).collect(),
            explanation_moments: responses
                .iter()
                .map(|response| filter.smoothed(response).iter().map(|state| state[2]).collect())
                .collect(),
            time,
            moment,
            channels,
            explanations,
            channel_moments,
        })
    }

    /// Ends of the 95 % interval of the moment at a row, rad of rudder.
    pub fn interval(&self, row: usize) -> [f64; 2] {
        let half = 1.96 * self.moment_sd[row];
        [self.moment[row] - half, self.moment[row] + half]
    }
}
