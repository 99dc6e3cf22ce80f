//! Mixtures of normal distributions: averages over models, each with a weight (Bayesian model averaging).
//!
//! Sources: Hoeting, Madigan, Raftery and Volinsky (1999), Statistical Science 14:382-417, for the average over models;
//! Fieller (1954) for the ratio.

use statrs::distribution::{ContinuousCDF, Normal};

/// Number of bisections for a quantile.
const BISECTIONS: usize = 100;

/// Estimate, with its standard deviation and its interval from the 2.5 % to the 97.5 % quantile; `None` if these do not
/// exist.
pub type MixtureSummary = (f64, Option<(f64, [f64; 2])>);

/// Mixture of normal distributions; weights need not sum to one.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalMixture {
    /// Weight, mean and standard deviation of every component.
    pub components: Vec<(f64, f64, f64)>,
}

impl NormalMixture {
    /// Mean, standard deviation and 95 % interval of the mixture; the mean alone if a component has no finite standard
    /// deviation.
    pub fn summary(&self) -> MixtureSummary {
        let total: f64 = self.components.iter().map(|(weight, ..)| weight).sum();
        let mean = self.components.iter().map(|(weight, mean, _)| weight * mean).sum::<f64>() / total;
        let square = |(weight, component, sd): &(f64, f64, f64)| weight * (sd * sd + (component - mean).powi(2));
        let sd = (self.components.iter().map(square).sum::<f64>() / total).sqrt();
        (mean, sd.is_finite().then(|| (sd, [0.025, 0.975].map(|probability| self.quantile(probability)))))
    }

    /// Quantile of the mixture at a probability.
    pub fn quantile(&self, probability: f64) -> f64 {
        let reach = |sign: f64| move |(_, mean, sd): &(f64, f64, f64)| mean + sign * 10.0 * sd;
        let low = self.components.iter().map(reach(-1.0)).fold(f64::INFINITY, f64::min);
        let high = self.components.iter().map(reach(1.0)).fold(f64::NEG_INFINITY, f64::max);
        bisect(low, high, |x| self.cdf(x) < probability)
    }

    /// Distribution function of the mixture, P(X < x).
    pub fn cdf(&self, x: f64) -> f64 {
        let law = Normal::standard();
        let total: f64 = self.components.iter().map(|(weight, ..)| weight).sum();
        let part = |(weight, mean, sd): &(f64, f64, f64)| match *sd > 0.0 {
            true => weight * law.cdf((x - mean) / sd),
            false if x > *mean => *weight,
            false => 0.0,
        };
        self.components.iter().map(part).sum::<f64>() / total
    }
}

/// Argument at which `is_below` becomes false, by bisection.
fn bisect(mut low: f64, mut high: f64, is_below: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if is_below(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Normal pair (denominator, numerator) of one model, with the weight of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalPair {
    /// Weight of the model.
    pub weight: f64,
    /// Mean and variance of the denominator.
    pub denominator: (f64, f64),
    /// Mean and variance of the numerator.
    pub numerator: (f64, f64),
    /// Covariance of denominator and numerator.
    pub covariance: f64,
}

impl NormalPair {
    /// Variance of numerator − k denominator.
    fn variance_at(&self, k: f64) -> f64 {
        (self.numerator.1 - 2.0 * k * self.covariance + k * k * self.denominator.1).max(0.0)
    }
}

/// Ratio of numerator to denominator in the most probable model, with standard deviation and 95 % interval over all
/// models.
///
/// P(b/a < k) = P(b − k a < 0) for a denominator a > 0, and b − k a is normal in every model (Fieller 1954); for a < 0
/// the signs are reversed. No interval is given if the 95 % interval of the denominator contains zero, or if a variance
/// of the denominator is not finite. Without a model the ratio is NaN.
pub fn ratio_summary(pairs: &[NormalPair]) -> MixtureSummary {
    let best = pairs.iter().max_by(|left, right| left.weight.total_cmp(&right.weight));
    let Some(best) = best else { return (f64::NAN, None) };
    let value = best.numerator.0 / best.denominator.0;
    let mixture = |part: &dyn Fn(&NormalPair) -> (f64, f64)| NormalMixture {
        components: pairs.iter().map(|pair| (pair.weight, part(pair).0, part(pair).1)).collect(),
    };
    let below = mixture(&|pair| (pair.denominator.0, pair.denominator.1.max(0.0).sqrt())).cdf(0.0);
    if (0.025..=0.975).contains(&below) || pairs.iter().any(|pair| !pair.denominator.1.is_finite()) {
        return (value, None);
    }
    let sign = if below < 0.5 { 1.0 } else { -1.0 };
    let is_below = |k: f64| {
        mixture(&|pair| (sign * (pair.numerator.0 - k * pair.denominator.0), pair.variance_at(k).sqrt())).cdf(0.0)
    };
    let spread = |pair: &NormalPair| {
        let ratio = pair.numerator.0 / pair.denominator.0;
        (ratio, pair.variance_at(ratio).sqrt() / pair.denominator.0.abs())
    };
    let total: f64 = pairs.iter().map(|pair| pair.weight).sum();
    let mean = pairs.iter().map(|pair| pair.weight * spread(pair).0).sum::<f64>() / total;
    let square = pairs.iter().map(|pair| pair.weight * (spread(pair).1.powi(2) + (spread(pair).0 - mean).powi(2)));
    let sd = (square.sum::<f64>() / total).sqrt();
    let reach = 40.0 * sd + 1e-12;
    let interval = [0.025, 0.975].map(|probability| bisect(mean - reach, mean + reach, |k| is_below(k) < probability));
    (value, Some((sd, interval)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mixture_of_one_is_normal() {
        let (_, error) = NormalMixture { components: vec![(1.0, 2.0, 0.5)] }.summary();
        let (sd, [low, high]) = error.expect("a law");
        assert!((low - 1.02).abs() < 1e-3 && (high - 2.98).abs() < 1e-3 && sd == 0.5);
        let (mean, error) = NormalMixture { components: vec![(0.5, 0.0, 0.1), (0.5, 1.0, 0.1)] }.summary();
        let (_, [low, high]) = error.expect("a law");
        assert!(low < -0.1 && high > 1.1 && (mean - 0.5).abs() < 1e-12);
    }

    /// Interval of a ratio by the delta method; none near zero.
    #[test]
    fn a_ratio_has_an_interval_away_from_zero() {
        let pair = |a: f64| NormalPair { weight: 1.0, denominator: (a, 1e-6), numerator: (0.5, 4e-6), covariance: 0.0 };
        let (value, error) = ratio_summary(&[pair(1.0)]);
        let sd = (4e-6 + 0.25e-6_f64).sqrt();
        let (_, [low, high]) = error.expect("a = 1 ± 0.001");
        assert!((value - 0.5).abs() < 1e-12 && ((high - low) / (2.0 * 1.96 * sd) - 1.0).abs() < 1e-2);
        assert_eq!(ratio_summary(&[pair(0.001)]).1, None);
        let (_, negative) = ratio_summary(&[pair(-1.0)]).1.expect("a = −1 ± 0.001");
        assert!((negative[0] + high).abs() < 1e-6 && (negative[1] + low).abs() < 1e-6);
    }
}
