//! Coloured compass error of one run: a Gauss–Markov process sampled exactly at any instants, evenly spaced or not, and
//! conditional on the readings of the display.
//!
//! Source: Gillespie (1996), Physical Review E 54:2084-2091, for the exact update of the process.

use rand::rngs::ChaCha8Rng;

use crate::disturbance::GaussMarkov;
use crate::stream::{RngPurpose, StreamKey, normal};

/// Coloured error at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CompassErrorPoint {
    /// Time, s.
    pub time: f64,
    /// Error, rad.
    pub error: f64,
}

/// Reader of the compass, with a separate random stream.
#[derive(Debug, Clone, Copy)]
pub(crate) enum CompassReader {
    /// Recorder.
    Record = 0,
    /// Display of the helmsman.
    Display = 1,
}

/// Realisation of a stationary first-order Gauss–Markov process w, at non-decreasing times.
#[derive(Debug)]
pub(crate) struct CompassErrorPath {
    process: GaussMarkov,
    rng: ChaCha8Rng,
    last: Option<CompassErrorPoint>,
}

impl CompassErrorPath {
    /// Path at its beginning, for one reader.
    pub fn new(process: GaussMarkov, reader: CompassReader, key: &StreamKey) -> Self {
        Self { process, rng: key.indexed_rng(RngPurpose::HeadingWander, reader as u32), last: None }
    }

    /// Error at time `t` (s), rad.
    pub fn error_at(&mut self, t: f64) -> f64 {
        self.before(t, None)
    }

    /// Errors at `times` (s), rad, for a path through given points.
    pub fn errors_at(&mut self, times: &[f64], points: &[CompassErrorPoint]) -> Vec<f64> {
        let mut ahead = points.iter().copied().peekable();
        let mut at = |&t: &f64| {
            while let Some(passed) = ahead.next_if(|point| point.time <= t) {
                self.last = Some(passed);
            }
            self.before(t, ahead.peek().copied())
        };
        times.iter().map(&mut at).collect()
    }

    /// Error at time `t` (s), between the last instant t₀ and the given point `next` at t₁.
    ///
    /// With a = exp(−(t − t₀)/τ) and b = exp(−(t₁ − t)/τ), each zero if there is no neighbour, w is normal about (a(1 −
    /// b²) w₀ + b(1 − a²) w₁)/(1 − a²b²) with variance σ²(1 − a²)(1 − b²)/(1 − a²b²): w is Markov, so it depends on its
    /// neighbours only.
    fn before(&mut self, t: f64, next: Option<CompassErrorPoint>) -> f64 {
        let GaussMarkov { sd, correlation_time } = self.process;
        // Decay over a time, and 1 minus the squared decay without cancellation for short times.
        let over = |time: f64| ((-time / correlation_time).exp(), -(-2.0 * time / correlation_time).exp_m1());
        let since = self.last.map_or(f64::INFINITY, |last| t - last.time);
        let until = next.map_or(f64::INFINITY, |next| next.time - t);
        let ((a, variance_since), (b, variance_until), (_, variance_both)) =
            (over(since), over(until), over(since + until));
        let error_at = |point: Option<CompassErrorPoint>| point.map_or(0.0, |point| point.error);
        // Always sampled, so that an instant at a reading does not change later random numbers.
        let draw = normal(&mut self.rng);
        let error = if variance_both > 0.0 {
            let mean = (a * variance_until * error_at(self.last) + b * variance_since * error_at(next)) / variance_both;
            mean + sd * (variance_since * variance_until / variance_both).sqrt() * draw
        } else {
            error_at(self.last)
        };
        self.last = Some(CompassErrorPoint { time: t, error });
        error
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const PROCESS: GaussMarkov = GaussMarkov { sd: 0.01, correlation_time: 5.0 };

    fn path(reader: CompassReader, replicate: u64) -> CompassErrorPath {
        CompassErrorPath::new(PROCESS, reader, &StreamKey { seed: 11, cell: 0, replicate })
    }

    /// Mean products of the errors at all pairs of times, over σ², compared with exp(−|h|/τ).
    fn assert_covariance(times: &[f64], runs: u64, errors: impl Fn(u64) -> Vec<f64>) {
        let all: Vec<Vec<f64>> = (0..runs).map(errors).collect();
        for (i, &t) in times.iter().enumerate() {
            for (j, &u) in times.iter().enumerate().take(i + 1) {
                let product = all.iter().map(|errors| errors[i] * errors[j]).sum::<f64>() / runs as f64;
                let expected = (-(t - u).abs() / PROCESS.correlation_time).exp();
                // Standard error of a product of unit normals of correlation ρ is √((1 + ρ²)/n); four of them.
                let tolerance = 4.0 * ((1.0 + expected * expected) / runs as f64).sqrt();
                assert_relative_eq!(product / PROCESS.sd.powi(2), expected, epsilon = tolerance);
            }
        }
    }

    #[test]
    fn it_is_stationary_from_the_first_instant_and_exact_over_uneven_ones() {
        let times = [3.0, 3.4, 5.0, 5.0, 11.0, 31.0];
        assert_covariance(&times, 20_000, |replicate| path(CompassReader::Record, replicate).errors_at(&times, &[]));
        let same = path(CompassReader::Record, 0).errors_at(&times, &[]);
        assert_eq!(same[2], same[3]);
    }

    /// Rows between readings of the display have the statistics of a path without earlier readings.
    #[test]
    fn a_path_through_what_is_known_is_one_path() {
        let (rows, readings) = ([0.0, 2.0, 4.0, 9.0], [1.0, 4.0, 4.5]);
        let times: Vec<f64> = rows.iter().chain(&readings).copied().collect();
        assert_covariance(&times, 20_000, |replicate| {
            let mut display = path(CompassReader::Display, replicate);
            let points = readings.map(|time| CompassErrorPoint { time, error: display.error_at(time) });
            let errors = path(CompassReader::Record, replicate).errors_at(&rows, &points);
            assert_relative_eq!(errors[2], points[1].error, max_relative = 1e-12);
            errors.into_iter().chain(points.map(|point| point.error)).collect()
        });
    }

    #[test]
    fn short_and_long_correlations_have_their_limits() {
        let key = StreamKey::default();
        let steps: Vec<f64> = (0..4000).map(f64::from).collect();
        let path_with = |correlation_time| {
            let process = GaussMarkov { correlation_time, ..PROCESS };
            CompassErrorPath::new(process, CompassReader::Record, &key).errors_at(&steps, &[])
        };
        let white = path_with(1e-300);
        let product = white.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / 4000.0;
        assert_relative_eq!(product / PROCESS.sd.powi(2), 0.0, epsilon = 4.0 / 4000.0_f64.sqrt());
        let constant = path_with(1e7);
        // σ√(2h/τ) is 2.8 % of σ over the complete record.
        assert!(constant.iter().all(|error| (error - constant[0]).abs() < 0.1 * PROCESS.sd));
    }
}
