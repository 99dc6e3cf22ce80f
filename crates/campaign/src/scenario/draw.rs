//! Random values of every trial: `[[draw]]`. Each draw has its own random stream, keyed by the replicate and its index
//! in the list but not by the cell. So a replicate has the same drawn ship in every cell, and further draws do not
//! change it.

use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution as _, Normal, Uniform};
use serde::{Deserialize, Serialize};
use ship::ShortNumber;
use simulate::{RngPurpose, StreamKey};
use statrs::distribution::ContinuousCDF as _;

use crate::scenario::limits;
use crate::scenario::part::ScenarioPart;
use crate::scenario::problem::{FaultMark, KeyFault, KeyPath};

/// Draw as written in the file.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DrawWire {
    /// Dotted key of the random value.
    key: String,
    /// Normal distribution.
    normal: Option<NormalWire>,
    /// Log-normal distribution.
    log_normal: Option<LogNormalWire>,
    /// Uniform distribution.
    uniform: Option<RangeWire>,
    /// Distribution whose logarithm is uniform.
    log_uniform: Option<RangeWire>,
    /// Range; values outside are sampled again.
    between: Option<[f64; 2]>,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct NormalWire {
    /// Mean.
    mean: f64,
    /// Standard deviation.
    sd: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct LogNormalWire {
    /// Median.
    median: f64,
    /// Standard deviation of the natural logarithm.
    sigma: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct RangeWire {
    /// Lower end.
    from: f64,
    /// Upper end.
    to: f64,
}

/// Scenario key that is sampled for every trial, with its distribution.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledKey {
    /// Key of the scenario that is sampled.
    pub key: KeyPath,
    index: u32,
    shape: DrawnDistribution,
    between: [f64; 2],
}

/// Distribution of a value or its natural logarithm.
#[derive(Debug, Clone, Copy, PartialEq)]
struct DrawnDistribution {
    /// Key in the file.
    name: &'static str,
    of_logarithm: bool,
    law: Distribution,
}

/// Distribution with checked parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Distribution {
    Normal {
        mean: f64,
        sd: f64,
    },
    /// `ends` are the bounds of the value itself.
    Uniform {
        from: f64,
        to: f64,
        ends: [f64; 2],
    },
}

/// Minimum probability of the range `between`; below it, rejection sampling takes too long.
const MIN_PROBABILITY: f64 = 1e-3;

impl DrawWire {
    /// Dotted key of the random value.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Key to be sampled, checked; `index` is the index of the draw in `[[draw]]`, which selects its random numbers.
    pub fn resolve(&self, index: usize) -> Result<SampledKey, KeyFault> {
        let place = KeyPath::from_dotted("draw").child(index);
        let key = KeyPath::from_dotted(&self.key);
        limits::check_depth(&key, &place.child("key"))?;
        let is_of_trial = |first: &String| {
            ScenarioPart::from_key(first) == ScenarioPart::Trial && !["validation", "also"].contains(&first.as_str())
        };
        if !key.names().first().is_some_and(is_of_trial) {
            return Err(KeyFault::value(
                place.child("key"),
                format!("the draw changes `{key}`"),
                "expected a key of the trial",
                "for instance `ship.first-order.T-s` or `sensor.heading-noise-deg`",
            ));
        }
        let shape = self.shape(&place)?;
        let between = self.between.unwrap_or_else(|| shape.support());
        let [low, high] = between;
        let draw = SampledKey { key, index: index as u32, shape, between };
        if !(low < high && draw.probability() >= MIN_PROBABILITY) {
            return Err(KeyFault::value(
                place.child("between"),
                format!("the draw of `{}` is held between {} and {}", draw.key, ShortNumber(low), ShortNumber(high)),
                format!("expected a range that holds at least {} % of the draws", 100.0 * MIN_PROBABILITY),
                "widen the range, or change the distribution",
            ));
        }
        Ok(draw)
    }

    /// Distribution of the draw. Fails unless exactly one is given, with numbers in their ranges.
    fn shape(&self, place: &KeyPath) -> Result<DrawnDistribution, KeyFault> {
        let (name, numbers) = match (self.normal, self.log_normal, self.uniform, self.log_uniform) {
            (Some(wire), None, None, None) => ("normal", [("mean", wire.mean), ("sd", wire.sd)]),
            (None, Some(wire), None, None) => ("log-normal", [("median", wire.median), ("sigma", wire.sigma)]),
            (None, None, Some(wire), None) => ("uniform", [("from", wire.from), ("to", wire.to)]),
            (None, None, None, Some(wire)) => ("log-uniform", [("from", wire.from), ("to", wire.to)]),
            _ => {
                return Err(KeyFault::name(
                    place.clone(),
                    format!("the draw of `{}` has no distribution, or several", self.key),
                    "expected one of `normal`, `log-normal`, `uniform`, `log-uniform`",
                    "for instance `uniform = { from = 0.5, to = 3.0 }`",
                ));
            }
        };
        let (of_logarithm, is_uniform) = (name.starts_with("log-"), name.ends_with("uniform"));
        let [first, second] = numbers.map(|(_, value)| value);
        let least = [if of_logarithm { 0.0 } else { f64::NEG_INFINITY }, if is_uniform { first } else { 0.0 }];
        for ((number, value), least) in numbers.into_iter().zip(least) {
            let is_within_reach = least == f64::NEG_INFINITY || (value - least).is_finite();
            if !(value.is_finite() && value > least && is_within_reach) {
                let problem =
                    format!("`{number}` of the `{name}` distribution of `{}` is {}", self.key, ShortNumber(value));
                let expected = match least {
                    f64::NEG_INFINITY => "expected a finite number".to_owned(),
                    _ => format!("expected a finite number above {}", ShortNumber(least)),
                };
                return Err(KeyFault::value(place.child(name).child(number), problem, expected, "change the number"));
            }
        }
        let of_value = |value: f64| if of_logarithm { value.ln() } else { value };
        let law = match is_uniform {
            true => Distribution::Uniform { from: of_value(first), to: of_value(second), ends: [first, second] },
            false => Distribution::Normal { mean: of_value(first), sd: second },
        };
        Ok(DrawnDistribution { name, of_logarithm, law })
    }
}

impl SampledKey {
    /// Sampled value of the key for the trial of `key`, in the unit of the key.
    pub fn sample(&self, key: &StreamKey) -> f64 {
        let mut rng = StreamKey { cell: 0, ..*key }.indexed_rng(RngPurpose::Specification, self.index);
        let [low, high] = self.between;
        loop {
            let value = self.shape.sample(&mut rng);
            if (low..=high).contains(&value) {
                return value;
            }
        }
    }

    /// Median of the distribution, clamped to the range of the draw.
    pub fn median_value(&self) -> f64 {
        let [low, high] = self.between;
        self.shape.middle().clamp(low, high)
    }

    /// Finite ends of the range, without an end at or below 0 if the logarithm is drawn.
    pub fn range_ends(&self) -> impl Iterator<Item = f64> {
        self.between.into_iter().filter(|end| end.is_finite() && self.shape.of_value(*end).is_finite())
    }

    /// Fault of a sampled trial, attributed to the key of the draw or to its distribution; `cell` names the cell if
    /// there are several.
    pub fn attributed(&self, fault: KeyFault, cell: Option<&str>) -> KeyFault {
        let cell = cell.map_or_else(String::new, |cell| format!(" (cell {cell})"));
        let (key, mark, what) = match fault.mark {
            FaultMark::Name => (self.place().child("key"), FaultMark::Value, "changes a key that cannot be drawn"),
            FaultMark::Value | FaultMark::Within(_) => {
                (self.place().child(self.shape.name), FaultMark::Name, "reaches a value for which no trial can be made")
            }
        };
        let problem = format!("the draw of `{}` {what}{cell}: {}", self.key, fault.problem);
        KeyFault { key, mark, problem, ..fault }
    }

    /// Path of the draw in the file: its index in the list `draw`.
    fn place(&self) -> KeyPath {
        KeyPath::from_dotted("draw").child(self.index)
    }

    /// Probability of a value of the distribution within the range of the draw.
    fn probability(&self) -> f64 {
        let [below, above] = self.between.map(|end| self.shape.probability_below(end));
        above - below
    }
}

impl DrawnDistribution {
    fn sample(&self, rng: &mut ChaCha8Rng) -> f64 {
        const CHECKED: &str = "its numbers have been checked";
        self.to_value(match self.law {
            Distribution::Normal { mean, sd } => Normal::new(mean, sd).expect(CHECKED).sample(rng),
            Distribution::Uniform { from, to, .. } => Uniform::new_inclusive(from, to).expect(CHECKED).sample(rng),
        })
    }

    /// Argument of the distribution: the value or its logarithm.
    fn of_value(&self, value: f64) -> f64 {
        if self.of_logarithm { value.ln() } else { value }
    }

    fn to_value(self, drawn: f64) -> f64 {
        if self.of_logarithm { drawn.exp() } else { drawn }
    }

    fn middle(&self) -> f64 {
        self.to_value(match self.law {
            Distribution::Normal { mean, .. } => mean,
            Distribution::Uniform { from, to, .. } => 0.5 * (from + to),
        })
    }

    /// Least and largest value of the distribution: infinite for a normal one, 0 and infinite for a log-normal one.
    fn support(&self) -> [f64; 2] {
        match self.law {
            Distribution::Normal { .. } => [f64::NEG_INFINITY, f64::INFINITY].map(|end| self.to_value(end)),
            Distribution::Uniform { ends, .. } => ends,
        }
    }

    fn probability_below(&self, value: f64) -> f64 {
        let x = self.of_value(value);
        match self.law {
            Distribution::Normal { mean, sd } => {
                statrs::distribution::Normal::new(mean, sd).map_or(f64::NAN, |law| law.cdf(x))
            }
            Distribution::Uniform { from, to, .. } => ((x - from) / (to - from)).clamp(0.0, 1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draw(text: &str) -> Result<SampledKey, KeyFault> {
        toml::from_str::<DrawWire>(&format!("key = \"ship.first-order.T-s\"\n{text}")).expect("well formed").resolve(0)
    }

    fn values(draw: &SampledKey) -> Vec<f64> {
        (0..20_000).map(|replicate| draw.sample(&StreamKey { seed: 4, cell: 9, replicate })).collect()
    }

    /// Compares 20,000 samples with closed forms: the mean within four standard errors, the standard deviation to 3 %.
    fn moments(values: &[f64], mean: f64, sd: f64) {
        let n = values.len() as f64;
        let sample_mean = values.iter().sum::<f64>() / n;
        let spread = (values.iter().map(|x| (x - sample_mean).powi(2)).sum::<f64>() / n).sqrt();
        assert!((sample_mean - mean).abs() < 4.0 * sd / n.sqrt(), "mean {sample_mean}, {mean} expected");
        assert!((spread / sd - 1.0).abs() < 0.03, "sd {spread}, {sd} expected");
    }

    #[test]
    fn draws_have_the_moments_of_their_distribution() {
        let of = |text: &str| values(&draw(text).expect("valid"));
        moments(&of("normal = { mean = 15.0, sd = 3.0 }"), 15.0, 3.0);
        moments(&of("uniform = { from = 0.5, to = 3.0 }"), 1.75, 2.5 / 12.0_f64.sqrt());
        // Mean: median · exp(σ²/2); standard deviation: mean · √(exp(σ²) − 1), with σ = 0.3.
        moments(
            &of("log-normal = { median = 2.0, sigma = 0.3 }"),
            2.0 * 0.045_f64.exp(),
            2.0 * 0.045_f64.exp() * (0.09_f64.exp() - 1.0).sqrt(),
        );
        // A normal cut at one sd on either side: variance 1 − 2φ(1)/(2Φ(1) − 1).
        moments(
            &of("normal = { mean = 0.0, sd = 1.0 }\nbetween = [-1.0, 1.0]"),
            0.0,
            (1.0 - 2.0 * 0.241_970_724_5 / 0.682_689_492_1_f64).sqrt(),
        );
        let log: Vec<f64> = of("log-uniform = { from = 0.3, to = 5.0 }").iter().map(|x| x.ln()).collect();
        moments(&log, 0.5 * (0.3_f64.ln() + 5.0_f64.ln()), (5.0_f64 / 0.3).ln() / 12.0_f64.sqrt());
    }

    #[test]
    fn a_replicate_has_the_same_ship_in_every_cell() {
        let draw = draw("uniform = { from = 0.5, to = 3.0 }").expect("valid");
        let at = |cell: u64, replicate: u64| draw.sample(&StreamKey { seed: 1, cell, replicate });
        assert_eq!(at(0, 5), at(7, 5));
        assert_ne!(at(0, 5), at(0, 6));
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        for wrong in [
            "",
            "normal = { mean = 1.0, sd = 0.0 }",
            "normal = { mean = nan, sd = 1.0 }",
            "log-normal = { median = -1.0, sigma = 0.3 }",
            "uniform = { from = 3.0, to = 0.5 }",
            "uniform = { from = 0.0, to = inf }",
            "uniform = { from = -1e308, to = 1e308 }",
            "log-uniform = { from = 0.0, to = 5.0 }",
            "normal = { mean = 0.0, sd = 1.0 }\nuniform = { from = 0.0, to = 1.0 }",
            "normal = { mean = 0.0, sd = 1.0 }\nbetween = [8.0, 9.0]",
            "uniform = { from = 0.0, to = 1.0 }\nbetween = [1.0, 0.0]",
        ] {
            assert!(draw(wrong).is_err(), "{wrong}");
        }
    }
}
