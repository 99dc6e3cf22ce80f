//! Detection size: the size of an effect that is detected in a given share of trials, by logistic regression on the
//! logarithm of the size with a ridge on the slope (le Cessie and van Houwelingen 1992). The interval is from the
//! profile likelihood (Venzon and Moolgavkar 1988).

use super::statistic::Statistic;

/// Number of trials, and of detections among them, at one size of the effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DetectionCount {
    /// Size, above zero.
    pub effect_size: f64,
    /// Number of trials.
    pub trials: u64,
    /// Number of trials with a detection.
    pub detections: u64,
}

/// Prior standard deviation of the slope per unit of the logarithm: the ridge, which keeps the slope finite if sizes
/// separate detections from misses. A likelihood-ratio test near its threshold has a slope of 5 to 8.
const SLOPE_SD: f64 = 10.0;

/// Drop of the log likelihood at the ends of the interval: half the 95 % quantile of χ² with one degree of freedom.
const LIKELIHOOD_DROP: f64 = 1.920_729_410_347_062;

/// Maximum distance of the logarithm of the detection size from those of the tried sizes.
const SEARCH_RANGE: f64 = 7.0;

/// Number of bisections of a range.
const HALVINGS: usize = 60;

/// Size at which `share` of the trials have a detection, with its 95 % interval by profile likelihood.
///
/// logit p = slope (ln size − ln size₀) + logit share, slope ≥ 0
///
/// The likelihood is maximised with a ridge on the slope. Values beyond the tried sizes are extrapolated. `None` for
/// fewer than two sizes.
pub fn detection_size(tried: &[DetectionCount], share: f64) -> Option<Statistic> {
    let logs = || tried.iter().filter(|level| level.trials > 0).map(|level| level.effect_size.ln());
    let ends = [logs().fold(f64::INFINITY, f64::min), logs().fold(f64::NEG_INFINITY, f64::max)];
    if ends[0] >= ends[1] {
        return None;
    }
    let line = ShareLine { tried, logit: (share / (1.0 - share)).ln() };
    let [low, high] = [ends[0] - SEARCH_RANGE, ends[1] + SEARCH_RANGE];
    let best = crossing(low, high, |place| line.surplus(place, line.slope(place)) >= 0.0);
    let least = line.height(best) - LIKELIHOOD_DROP;
    let lower = crossing(low, best, |place| line.height(place) >= least);
    let upper = crossing(best, high, |place| line.height(place) < least);
    Some(Statistic { value: best.exp(), ci95: Some([lower, upper].map(f64::exp)) })
}

/// Point between two ends at which a monotone condition becomes true, by bisection.
fn crossing(low: f64, high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let halved = |[low, high]: [f64; 2], _| {
        let middle = 0.5 * (low + high);
        if holds(middle) { [low, middle] } else { [middle, high] }
    };
    let [low, high] = (0..HALVINGS).fold([low, high], halved);
    0.5 * (low + high)
}

/// Line of the logit against the logarithm of the size, through the logit of the requested share.
struct ShareLine<'a> {
    tried: &'a [DetectionCount],
    logit: f64,
}

impl ShareLine<'_> {
    /// Per size: log size minus `place`, trials, detections, and logit of the detection probability.
    fn points(&self, place: f64, slope: f64) -> impl Iterator<Item = [f64; 4]> {
        self.tried.iter().map(move |level| {
            let after = level.effect_size.ln() - place;
            [after, level.trials as f64, level.detections as f64, self.logit + slope * after]
        })
    }

    /// Slope of a line that reaches the share at log size `place`: the zero of the derivative of the log likelihood
    /// with its ridge penalty.
    fn slope(&self, place: f64) -> f64 {
        let falls = |slope: f64| {
            let derivative = |[after, trials, seen, logit]: [f64; 4]| after * (seen - trials * chance(logit));
            self.points(place, slope).map(derivative).sum::<f64>() < slope / (SLOPE_SD * SLOPE_SD)
        };
        crossing(0.0, 1000.0, falls)
    }

    /// Number of detections minus its expectation: above zero if the share is reached at a smaller size.
    fn surplus(&self, place: f64, slope: f64) -> f64 {
        self.points(place, slope).map(|[_, trials, seen, logit]| seen - trials * chance(logit)).sum()
    }

    /// Log likelihood, maximised over the slope with its ridge penalty, if the share is reached at log size `place`.
    fn height(&self, place: f64) -> f64 {
        let slope = self.slope(place);
        // ln p = −ln(1 + e^−logit), without overflow.
        let log_chance = |logit: f64| logit.min(0.0) - (-logit.abs()).exp().ln_1p();
        let height = |[_, trials, seen, logit]: [f64; 4]| {
            let [seen_by, unseen_by] = [log_chance(logit), log_chance(-logit)];
            seen * seen_by + (trials - seen) * unseen_by
        };
        self.points(place, slope).map(height).sum::<f64>() - 0.5 * (slope / SLOPE_SD).powi(2)
    }
}

/// Logistic function: the probability of a logit.
fn chance(logit: f64) -> f64 {
    1.0 / (1.0 + (-logit).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tried(seen: [u64; 5], trials: u64) -> Vec<DetectionCount> {
        seen.iter()
            .zip([0.25, 0.5, 1.0, 2.0, 4.0])
            .map(|(&seen, size)| DetectionCount { effect_size: size, trials, detections: seen })
            .collect()
    }

    fn sizes(seen: [u64; 5], trials: u64) -> [f64; 3] {
        let size = detection_size(&tried(seen, trials), 0.9).expect("five sizes");
        let [low, high] = size.ci95.expect("an interval");
        [low, size.value, high]
    }

    /// Shares with logit 2 + 3 ln size, which is ln 9 at e^((ln 9 − 2)/3). With many trials the interval is from the
    /// information matrix.
    #[test]
    fn shares_of_a_line_give_its_size() {
        let trials = 1_000_000;
        let share = |size: f64| chance(2.0 + 3.0 * size.ln());
        let seen = [0.25, 0.5, 1.0, 2.0, 4.0].map(|size: f64| (share(size) * trials as f64).round() as u64);
        let [low, size, high] = sizes(seen, trials);
        let expected = ((9f64.ln() - 2.0) / 3.0).exp();
        assert!((size / expected - 1.0).abs() < 1e-4, "{size}, {expected} expected");
        let [mut whole, mut first, mut second] = [0.0; 3];
        for size in [0.25, 0.5, 1.0, 2.0, 4.0] {
            let weight = trials as f64 * share(size) * (1.0 - share(size));
            let after = size.ln() - expected.ln();
            (whole, first, second) = (whole + weight, first + weight * after, second + weight * after * after);
        }
        let sd = (second / (whole * second - first * first)).sqrt() / 3.0;
        let half = 1.96 * sd;
        assert!(((high / size).ln() / half - 1.0).abs() < 0.02 && ((size / low).ln() / half - 1.0).abs() < 0.02);
    }

    /// If sizes separate detections from misses, the detection size lies between them, in a slightly wider interval.
    #[test]
    fn parted_sizes_have_a_finite_answer() {
        let [low, size, high] = sizes([0, 0, 0, 20, 20], 20);
        assert!((1.0..2.0).contains(&size), "{size}");
        assert!((0.9..size).contains(&low) && (size..2.5).contains(&high), "{low} to {high}");
        // More trials narrow the interval.
        let [lower, _, higher] = sizes([0, 0, 0, 200, 200], 200);
        assert!(lower > low && higher < high);
    }

    /// Without detections the size is above the maximum tried, with all detections below the minimum, with half of them
    /// undetermined.
    #[test]
    fn beyond_the_sizes_there_is_a_bound() {
        let [low, size, _] = sizes([0, 0, 0, 0, 0], 10);
        assert!(low > 4.0 && size > 4.0, "{low}, {size}");
        let [_, size, high] = sizes([10; 5], 10);
        assert!(high < 0.5 && size < 0.25, "{size}, {high}");
        let [low, size, high] = sizes([5; 5], 10);
        assert!(low > 4.0 && size > 4.0 && high > 100.0, "{low}, {size}, {high}");
        // A decreasing share does not indicate a small size.
        assert!(sizes([8, 8, 3, 0, 0], 10)[0] > 4.0);
        assert_eq!(detection_size(&tried([0; 5], 10)[..1], 0.9), None);
        assert_eq!(detection_size(&[], 0.9), None);
    }
}
