//! Yaw rate over heading of a record, measured or from the slope of its heading.

use super::findings::ZigZag;
use super::heading::Heading;
use crate::record::Trial;

/// Heading (rad) and yaw rate (rad/s) of a record in the order of time, and whether the rate is the slope of the
/// smoothed heading because the record has no yaw rate.
#[derive(Debug, Clone, PartialEq)]
pub struct PhasePlane {
    /// Heading ψ, rad.
    pub heading: Vec<f64>,
    /// Yaw rate r, rad/s; NaN where it is not known.
    pub yaw_rate: Vec<f64>,
    /// Whether the rate comes from the heading.
    pub smoothed: bool,
}

/// Most rows whose slope is looked for.
const MOST_SLOPES: usize = 1500;

impl PhasePlane {
    /// The way of a record in the phase plane. The slope is that of the local cubic from which the characteristics of a
    /// zig-zag are read (about its period, or a third of the record where it is none); the rows nearer to an end than
    /// half of its width have none. `None` where there are fewer than 8 headings.
    pub fn of(trial: &Trial) -> Option<Self> {
        if let Some(rate) = trial.yaw_rate() {
            return Some(Self { heading: trial.heading().to_vec(), yaw_rate: rate.to_vec(), smoothed: false });
        }
        let period = ZigZag::of(trial).ok().and_then(|zigzag| zigzag.period).map(|period| period.value);
        let period = period.unwrap_or(trial.duration() / 3.0);
        let observed = Heading::new(trial.time(), trial.heading(), period, trial.noise().heading)?;
        let reach = observed.slope_half_width();
        let (first, last) = (observed.time[0] + reach, observed.time[observed.time.len() - 1] - reach);
        let every = observed.time.len().div_ceil(MOST_SLOPES);
        let rows = (0..observed.time.len()).step_by(every);
        let (heading, yaw_rate) = rows
            .map(|row| {
                let time = observed.time[row];
                let inside = (first..=last).contains(&time);
                let rate = inside.then(|| observed.rate_at(time)).flatten().map_or(f64::NAN, |rate| rate.value);
                (observed.relative[row] + observed.origin, rate)
            })
            .unzip();
        Some(Self { heading, yaw_rate, smoothed: true })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Plant;
    use crate::{Channel, Columns, Origin};

    fn record(with_rate: bool) -> (Trial, Vec<f64>) {
        let (time, heading, rudder) = Plant::default().record(200.0, 0.5);
        let row = |k: usize| (k.saturating_sub(1), (k + 1).min(time.len() - 1));
        let slope = |(a, b): (usize, usize)| (heading[b] - heading[a]) / (time[b] - time[a]);
        let rate: Vec<f64> = (0..time.len()).map(|k| slope(row(k))).collect();
        let mut channels = [(Channel::Heading, heading), (Channel::Rudder, rudder)].to_vec();
        channels.extend(with_rate.then(|| (Channel::YawRate, rate.clone())));
        let origin = Origin::Measured { file: "run.csv".into(), sha256: String::new() };
        let columns = Columns { time, channels: channels.into_iter().collect(), unknown: Vec::new() };
        (Trial::new("run", origin, columns).expect("a record"), rate)
    }

    #[test]
    fn the_slope_of_the_heading_is_its_rate() {
        let (trial, rate) = record(false);
        let plane = PhasePlane::of(&trial).expect("enough headings");
        assert!(plane.smoothed && plane.heading.len() == rate.len());
        let pairs = plane.yaw_rate.iter().zip(&rate).filter(|(own, _)| own.is_finite());
        let largest = rate.iter().fold(0.0, |largest: f64, rate| largest.max(rate.abs()));
        let (mut count, mut square) = (0, 0.0);
        for (own, truth) in pairs {
            count += 1;
            square += (own - truth).powi(2);
        }
        assert!(count > 350 && (square / f64::from(count)).sqrt() < 0.02 * largest, "{count}, {square}");
        // A cubic beyond the last heading would be a guess.
        assert!(plane.yaw_rate[0].is_nan() && plane.yaw_rate[rate.len() - 1].is_nan());
    }

    #[test]
    fn a_measured_rate_is_taken_as_it_is() {
        let (trial, rate) = record(true);
        let plane = PhasePlane::of(&trial).expect("a rate");
        assert!(!plane.smoothed && plane.yaw_rate == rate);
    }
}
