//! Quantities that are averages over models: each model has a normal law, and a weight.

use statrs::distribution::{ContinuousCDF, Normal};

/// Halvings of an interval in which a quantile lies.
const HALVINGS: usize = 100;

/// A number, and where it is known its standard deviation with the interval between its 2.5 % and 97.5 % quantiles.
pub type MixtureSummary = (f64, Option<(f64, [f64; 2])>);

/// Normal laws with their weights, which sum to one.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalMixture {
    /// Weight, mean and standard deviation.
    pub parts: Vec<(f64, f64, f64)>,
}

impl NormalMixture {
    /// Mean and standard deviation of the mixture with its interval. Without an error where one of the parts has none.
    pub fn summary(&self) -> MixtureSummary {
        let total: f64 = self.parts.iter().map(|(weight, ..)| weight).sum();
        let mean = self.parts.iter().map(|(weight, mean, _)| weight * mean).sum::<f64>() / total;
        let square = |(weight, own, sd): &(f64, f64, f64)| weight * (sd * sd + (own - mean).powi(2));
        let sd = (self.parts.iter().map(square).sum::<f64>() / total).sqrt();
        (mean, sd.is_finite().then(|| (sd, [0.025, 0.975].map(|probability| self.quantile(probability)))))
    }

    /// Value below which the mixture lies with a probability.
    pub fn quantile(&self, probability: f64) -> f64 {
        let reach = |sign: f64| move |(_, mean, sd): &(f64, f64, f64)| mean + sign * 10.0 * sd;
        let low = self.parts.iter().map(reach(-1.0)).fold(f64::INFINITY, f64::min);
        let high = self.parts.iter().map(reach(1.0)).fold(f64::NEG_INFINITY, f64::max);
        bisect(low, high, |x| self.below(x) < probability)
    }

    /// Probability of less than `x`.
    pub fn below(&self, x: f64) -> f64 {
        let law = Normal::standard();
        let total: f64 = self.parts.iter().map(|(weight, ..)| weight).sum();
        let part = |(weight, mean, sd): &(f64, f64, f64)| match *sd > 0.0 {
            true => weight * law.cdf((x - mean) / sd),
            false if x > *mean => *weight,
            false => 0.0,
        };
        self.parts.iter().map(part).sum::<f64>() / total
    }
}

/// The place at which `is_below` ends.
fn bisect(mut low: f64, mut high: f64, is_below: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if is_below(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// A pair (denominator, numerator) in one model: weight, values, variances and covariance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalPair {
    /// Weight.
    pub weight: f64,
    /// Denominator and its variance.
    pub denominator: (f64, f64),
    /// Numerator and its variance.
    pub numerator: (f64, f64),
    /// Their covariance.
    pub covariance: f64,
}

impl NormalPair {
    /// Variance of numerator − k denominator.
    fn variance_at(&self, k: f64) -> f64 {
        (self.numerator.1 - 2.0 * k * self.covariance + k * k * self.denominator.1).max(0.0)
    }
}

/// The ratio numerator over denominator of the most probable model, with the interval over all of them.
///
/// P(b/a < k) is that of b − k a < 0, which is normal in every model (Fieller 1954). There is no interval where the
/// denominator may be zero: where its own 95 % interval holds zero.
pub fn ratio(pairs: &[NormalPair]) -> MixtureSummary {
    let best = pairs.iter().max_by(|one, other| one.weight.total_cmp(&other.weight));
    let Some(best) = best else { return (f64::NAN, None) };
    let value = best.numerator.0 / best.denominator.0;
    let of = |part: &dyn Fn(&NormalPair) -> (f64, f64)| NormalMixture {
        parts: pairs.iter().map(|pair| (pair.weight, part(pair).0, part(pair).1)).collect(),
    };
    let below = of(&|pair| (pair.denominator.0, pair.denominator.1.max(0.0).sqrt())).below(0.0);
    if (0.025..=0.975).contains(&below) || pairs.iter().any(|pair| !pair.denominator.1.is_finite()) {
        return (value, None);
    }
    let sign = if below < 0.5 { 1.0 } else { -1.0 };
    let is_below = |k: f64| {
        of(&|pair| (sign * (pair.numerator.0 - k * pair.denominator.0), pair.variance_at(k).sqrt())).below(0.0)
    };
    let spread = |pair: &NormalPair| {
        let own = pair.numerator.0 / pair.denominator.0;
        (own, pair.variance_at(own).sqrt() / pair.denominator.0.abs())
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
        let (_, error) = NormalMixture { parts: vec![(1.0, 2.0, 0.5)] }.summary();
        let (sd, [low, high]) = error.expect("a law");
        assert!((low - 1.02).abs() < 1e-3 && (high - 2.98).abs() < 1e-3 && sd == 0.5);
        let (mean, error) = NormalMixture { parts: vec![(0.5, 0.0, 0.1), (0.5, 1.0, 0.1)] }.summary();
        let (_, [low, high]) = error.expect("a law");
        assert!(low < -0.1 && high > 1.1 && (mean - 0.5).abs() < 1e-12);
    }

    /// Far from zero the interval of a ratio is that of the delta method; near zero there is none.
    #[test]
    fn a_ratio_has_an_interval_away_from_zero() {
        let pair = |a: f64| NormalPair { weight: 1.0, denominator: (a, 1e-6), numerator: (0.5, 4e-6), covariance: 0.0 };
        let (value, error) = ratio(&[pair(1.0)]);
        let sd = (4e-6 + 0.25e-6_f64).sqrt();
        let (_, [low, high]) = error.expect("a = 1 ± 0.001");
        assert!((value - 0.5).abs() < 1e-12 && ((high - low) / (2.0 * 1.96 * sd) - 1.0).abs() < 1e-2);
        assert_eq!(ratio(&[pair(0.001)]).1, None);
        let (_, negative) = ratio(&[pair(-1.0)]).1.expect("a = −1 ± 0.001");
        assert!((negative[0] + high).abs() < 1e-6 && (negative[1] + low).abs() < 1e-6);
    }
}
