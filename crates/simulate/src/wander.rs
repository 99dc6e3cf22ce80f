//! The coloured error of a compass along one run, drawn exactly at whatever instants it is read, evenly spaced or not,
//! and between readings of the display, where it is known already. What the error is, is in `sensor`.

use rand::rngs::ChaCha8Rng;

use crate::disturbance::GaussMarkov;
use crate::stream::{Purpose, StreamKey, normal};

/// The error at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct WanderPoint {
    /// Time, s.
    pub time: f64,
    /// Error, rad.
    pub error: f64,
}

/// Who reads the compass: each draws from a stream of its own.
#[derive(Debug, Clone, Copy)]
pub(crate) enum CompassReader {
    /// The recorder.
    Record = 0,
    /// The display of the helmsman.
    Display = 1,
}

/// One realisation of a stationary first-order Gauss–Markov process w, read at non-decreasing times.
#[derive(Debug)]
pub(crate) struct WanderPath {
    process: GaussMarkov,
    rng: ChaCha8Rng,
    last: Option<WanderPoint>,
}

impl WanderPath {
    /// A path at its beginning, as `reader` sees it.
    pub fn new(process: GaussMarkov, reader: CompassReader, key: &StreamKey) -> Self {
        Self { process, rng: key.indexed(Purpose::HeadingWander, reader as u32), last: None }
    }

    /// The error at time `t` (s), rad.
    pub fn at(&mut self, t: f64) -> f64 {
        self.before(t, None)
    }

    /// The errors at `times` (s), rad, of the path that goes through what is `known`.
    pub fn through(&mut self, times: &[f64], known: &[WanderPoint]) -> Vec<f64> {
        let mut ahead = known.iter().copied().peekable();
        let mut at = |&t: &f64| {
            while let Some(passed) = ahead.next_if(|known| known.time <= t) {
                self.last = Some(passed);
            }
            self.before(t, ahead.peek().copied())
        };
        times.iter().map(&mut at).collect()
    }

    /// The error at time `t` (s), which lies between the last one read and `next`, where that is known.
    ///
    /// With a = exp(−(t − t₀)/τ) and b = exp(−(t₁ − t)/τ), each 0 where there is no neighbour, w is normal about
    /// (a(1 − b²) w₀ + b(1 − a²) w₁)/(1 − a²b²) with variance σ²(1 − a²)(1 − b²)/(1 − a²b²): w is Markov, so nothing
    /// but its neighbours matters.
    fn before(&mut self, t: f64, next: Option<WanderPoint>) -> f64 {
        let GaussMarkov { sd, correlation_time } = self.process;
        // Decay over a time, and one less its square without the loss of digits over a short one.
        let over = |time: f64| ((-time / correlation_time).exp(), -(-2.0 * time / correlation_time).exp_m1());
        let since = self.last.map_or(f64::INFINITY, |last| t - last.time);
        let until = next.map_or(f64::INFINITY, |next| next.time - t);
        let ((a, lost), (b, to_come), (_, both)) = (over(since), over(until), over(since + until));
        let of = |known: Option<WanderPoint>| known.map_or(0.0, |known| known.error);
        // Drawn in any case, so that an instant on a reading shifts no later draw.
        let draw = normal(&mut self.rng);
        let error = if both > 0.0 {
            let mean = (a * to_come * of(self.last) + b * lost * of(next)) / both;
            mean + sd * (lost * to_come / both).sqrt() * draw
        } else {
            of(self.last)
        };
        self.last = Some(WanderPoint { time: t, error });
        error
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const PROCESS: GaussMarkov = GaussMarkov { sd: 0.01, correlation_time: 5.0 };

    fn path(reader: CompassReader, replicate: u64) -> WanderPath {
        WanderPath::new(PROCESS, reader, &StreamKey { seed: 11, cell: 0, replicate })
    }

    /// Mean products of the errors at each two of the times, over σ², held against exp(−|h|/τ).
    fn assert_covariance(times: &[f64], runs: u64, errors: impl Fn(u64) -> Vec<f64>) {
        let all: Vec<Vec<f64>> = (0..runs).map(errors).collect();
        for (i, &t) in times.iter().enumerate() {
            for (j, &u) in times.iter().enumerate().take(i + 1) {
                let product = all.iter().map(|errors| errors[i] * errors[j]).sum::<f64>() / runs as f64;
                let expected = (-(t - u).abs() / PROCESS.correlation_time).exp();
                // The standard error of a product of unit normals of correlation ρ is √((1 + ρ²)/n); four of them.
                let tolerance = 4.0 * ((1.0 + expected * expected) / runs as f64).sqrt();
                assert_relative_eq!(product / PROCESS.sd.powi(2), expected, epsilon = tolerance);
            }
        }
    }

    #[test]
    fn it_is_stationary_from_the_first_instant_and_exact_over_uneven_ones() {
        let times = [3.0, 3.4, 5.0, 5.0, 11.0, 31.0];
        assert_covariance(&times, 20_000, |replicate| path(CompassReader::Record, replicate).through(&times, &[]));
        let same = path(CompassReader::Record, 0).through(&times, &[]);
        assert_eq!(same[2], same[3]);
    }

    /// Rows between readings of the display have the statistics of a path that nobody read before.
    #[test]
    fn a_path_through_what_is_known_is_one_path() {
        let (rows, readings) = ([0.0, 2.0, 4.0, 9.0], [1.0, 4.0, 4.5]);
        let times: Vec<f64> = rows.iter().chain(&readings).copied().collect();
        assert_covariance(&times, 20_000, |replicate| {
            let mut display = path(CompassReader::Display, replicate);
            let known = readings.map(|time| WanderPoint { time, error: display.at(time) });
            let errors = path(CompassReader::Record, replicate).through(&rows, &known);
            assert_relative_eq!(errors[2], known[1].error, max_relative = 1e-12);
            errors.into_iter().chain(known.map(|known| known.error)).collect()
        });
    }

    #[test]
    fn short_and_long_correlations_have_their_limits() {
        let key = StreamKey::default();
        let steps: Vec<f64> = (0..4000).map(f64::from).collect();
        let of = |correlation_time| {
            let process = GaussMarkov { correlation_time, ..PROCESS };
            WanderPath::new(process, CompassReader::Record, &key).through(&steps, &[])
        };
        let white = of(1e-300);
        let product = white.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / 4000.0;
        assert_relative_eq!(product / PROCESS.sd.powi(2), 0.0, epsilon = 4.0 / 4000.0_f64.sqrt());
        let constant = of(1e7);
        // σ√(2h/τ) is 1.8 % of σ over the whole record.
        assert!(constant.iter().all(|error| (error - constant[0]).abs() < 0.1 * PROCESS.sd));
    }
}
