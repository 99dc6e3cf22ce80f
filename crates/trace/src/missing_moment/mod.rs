//! The yaw moment that the base lacks, seen: smoothed over the time of a record, and as a function of what it may
//! depend on.
//!
//! The suspect term is a random state (Kristensen, Madsen and Jørgensen 2004): a moment that walks, beside the heading
//! and the yaw rate of the fitted base. Smoothed, it is what the base lacks, as the rudder angle with the same moment.
//! As a function of yaw rate, rudder, heading, speed, wind or sway it shows its shape, and a known effect whose curve
//! lies inside the band everywhere is one that looks like it. The parameters of the base are taken as known: their
//! uncertainty is not in the bands.

mod curve;
mod smoother;
#[cfg(test)]
mod tests;

use ship::{FirstOrder, Polyline};

use crate::record::PreparedRecord;
use curve::{FEWEST, deviance, likeliest, variance};
use smoother::{HeadingColumn, MomentFilter, MomentRows};

pub use curve::MomentCurve;

/// A channel that a missing moment may depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
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

impl Over {
    /// Every channel.
    pub const ALL: [Self; 6] = [Self::YawRate, Self::Rudder, Self::Heading, Self::Speed, Self::WindFrom, Self::Sway];

    /// The words used in files.
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

/// What another model of a record does to its heading beside the base.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// Effects and forms of the model.
    pub effects: Vec<(&'static str, &'static str)>,
    /// Replayed heading of the model less that of the base, rad, at the observed rows.
    pub heading: Vec<f64>,
}

/// The missing moment as a function of one channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The channel.
    pub over: Over,
    /// The curve with its band; the others are those of the explanations.
    pub curve: MomentCurve,
    /// Share of the variance with which the moment wanders (that of its walk per second) that the curve takes away;
    /// `None` where the moment does not wander.
    pub share: Option<f64>,
    /// Places of the explanations that lie inside the band everywhere; none where no moment at all does, too.
    pub inside: Vec<usize>,
}

/// The missing moment of one record.
#[derive(Debug, Clone, PartialEq)]
pub struct MissingMoment {
    /// Times of the rows with a heading, s.
    pub time: Vec<f64>,
    /// Smoothed moment, rad of rudder.
    pub moment: Vec<f64>,
    /// Its standard deviation, rad of rudder.
    pub sd: Vec<f64>,
    /// Every channel at the rows that the record has.
    pub channels: Vec<(Over, Vec<f64>)>,
    /// Models that may explain it.
    pub explanations: Vec<Explanation>,
    /// The moment of every explanation as the same smoother sees it, rad of rudder.
    pub explained: Vec<Vec<f64>>,
    /// Curves over the channels that vary: first those whose band leaves zero, the most likely of them first.
    pub panels: Vec<Panel>,
}

fn at_rows(signal: &Polyline, time: &[f64]) -> Vec<f64> {
    time.iter().map(|&t| signal.at(t)).collect()
}

/// Sum of the squared distances from the mean.
fn spread(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|value| (value - mean).powi(2)).sum()
}

/// A moment whose mean square distance from its mean, rad² of rudder, is below this one does not wander.
const STILL: f64 = 1e-12;

impl MissingMoment {
    /// The moment that a base with these parameters lacks on a record whose heading noise is about `sd`, rad; `None`
    /// for a record of too few headings, and for a rudder without effect.
    pub fn new(record: &PreparedRecord, base: &FirstOrder, sd: f64, explanations: Vec<Explanation>) -> Option<Self> {
        let time: Vec<f64> = record.observed.iter().map(|&row| record.time[row]).collect();
        let count = time.len();
        if count < FEWEST || !base.K_over_T.is_normal() {
            return None;
        }
        let noise = |&row: &usize| record.full_readings as f64 / record.readings[row] as f64;
        let variances = record.observed.iter().map(noise).collect();
        let rows = MomentRows::new(*base, time.clone(), variances, sd);
        let first = record.heading[record.observed[0]];
        let heading = record.observed.iter().map(|&row| record.heading[row] - first).collect();
        let own = HeadingColumn { heading, forced: rows.steered(&record.rudder) };
        let square = |filter: &MomentFilter| filter.whitened(&own).iter().map(|nu| nu * nu).sum::<f64>();
        let gain = base.K_over_T;
        let intensity = likeliest(&rows, gain, |filter| Some(deviance(square(filter), filter, count))).exp();
        let filter = rows.filter(intensity);
        let unit = variance(square(&filter), count, 0);
        let states = filter.smoothed(&own);
        let moment: Vec<f64> = states.iter().map(|state| state[2]).collect();

        let mut channels = vec![
            (Over::YawRate, states.iter().map(|state| state[1]).collect()),
            (Over::Rudder, at_rows(&record.rudder, &time)),
            (Over::Heading, states.iter().map(|state| first + state[0]).collect::<Vec<f64>>()),
        ];
        let signals = [(Over::Speed, &record.speed), (Over::WindFrom, &record.wind_from), (Over::Sway, &record.sway)];
        channels
            .extend(signals.into_iter().filter_map(|(over, signal)| Some((over, at_rows(signal.as_ref()?, &time)))));

        let still = vec![[0.0; 2]; count];
        let others: Vec<HeadingColumn> = explanations
            .iter()
            .map(|one| HeadingColumn { heading: one.heading.clone(), forced: still.clone() })
            .collect();
        let wanders = spread(&moment) > STILL * count as f64;
        let mut panels: Vec<Panel> = channels
            .iter()
            .filter_map(|(over, x)| {
                let curve = MomentCurve::new(&rows, gain, &own, x, &others)?;
                let share = wanders.then(|| (1.0 - curve.left / (intensity * unit)).max(0.0));
                let inside = match curve.holds_nothing() {
                    true => Vec::new(),
                    false => (0..others.len()).filter(|&k| curve.holds(&curve.others[k])).collect(),
                };
                Some(Panel { over: *over, curve, share, inside })
            })
            .collect();
        let rank = |panel: &Panel| (panel.curve.holds_nothing(), panel.curve.deviance);
        panels.sort_by(|one, other| {
            let ((one, first), (other, second)) = (rank(one), rank(other));
            one.cmp(&other).then(first.total_cmp(&second))
        });
        Some(Self {
            sd: filter.moment_variance().iter().map(|variance| (variance * unit).sqrt()).collect(),
            explained: others
                .iter()
                .map(|other| filter.smoothed(other).iter().map(|state| state[2]).collect())
                .collect(),
            time,
            moment,
            channels,
            explanations,
            panels,
        })
    }

    /// Ends of the 95 % interval of a row, rad of rudder.
    pub fn interval(&self, row: usize) -> [f64; 2] {
        let half = 1.96 * self.sd[row];
        [self.moment[row] - half, self.moment[row] + half]
    }
}
