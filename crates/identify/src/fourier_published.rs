//! Fourier method as published: eight harmonics with a free fundamental, triples of instants, a mean.
//!
//! The heading is fitted by [`crate::fourier`]; T r' + r = K (δ + δ_r) is written at three instants with the recorded
//! rudder and solved for T, K and δ_r; the estimates of n triples are averaged. The paper does not specify the number
//! of triples, the instants, or the start of w: every choice is a setting here, and the defaults favour the paper (ten
//! triples, all well conditioned). The algebra is exact; the limit of the method is r', which eight harmonics give with
//! an error of a quarter even without noise, so that K and T are too low. A form without that error is
//! [`crate::fourier_projected`].
//!
//! Source: Ge, Hu, Yin and Sun, Identification of Ship Maneuverability Indexes by Fourier Method, eqs. (9) to (11).

use document::{Warning, WarningCode};
use estimation::column::extremes;
use estimation::statistics::quantile;
use serde::{Deserialize, Serialize};
use ship::FirstOrder;
use ship::angle::from_deg;
use ship::signal::Polyline;
use statrs::distribution::{Binomial, DiscreteCDF};
use trial::Trial;

use crate::error::IdentifyError;
use crate::estimate::{Estimate, StopReason, Uncertainty};
use crate::fourier::triples::{self, MAX_TRIPLES, RegressionPoint, SampledTriples, Selection, TripleEstimate};
use crate::fourier::{self, FittedSeries, Fundamental, MAX_HARMONICS};
use crate::identifier::Identifier;
use crate::samples::Samples;
use crate::settings::{SettingsError, require};

/// Central share of the record for well-conditioned triples.
const INTERIOR_SHARE: f64 = 0.9;

/// Maximum movement of a rudder at rest, deg.
const RUDDER_REST_DEG: f64 = 0.5;

/// Time before and after an instant in which the movement of the rudder is measured, s.
const RUDDER_REST_S: f64 = 2.0;

/// Combination of the estimates of the triples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Aggregation {
    /// Means of K and of T, eq. (11).
    #[default]
    Mean,
    /// Medians of K and of T.
    Median,
}

/// Settings of the method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Settings {
    /// Number of harmonics N.
    pub harmonics: usize,
    /// Rule for the choice of w.
    pub fundamental: Fundamental,
    /// Number of triples n, at most 10 000; some 200 with the median make the estimate independent of the seed.
    pub triples: usize,
    /// Selection of the triples.
    pub selection: Selection,
    /// Combination of their estimates.
    pub aggregation: Aggregation,
    /// Seed of the random triples.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            harmonics: 8,
            fundamental: Fundamental::Starts,
            triples: 10,
            selection: Selection::default(),
            aggregation: Aggregation::Mean,
            seed: 0,
        }
    }
}

impl Settings {
    /// Method with these settings, which are checked.
    ///
    /// Fails if the number of harmonics is outside 1 to 64 or of triples outside 1 to 10 000, or if the rule for w is
    /// not valid.
    pub fn build(self) -> Result<FourierPublished, SettingsError> {
        require((1..=MAX_HARMONICS).contains(&self.harmonics), "harmonics", self.harmonics, "1 to 64")?;
        require((1..=MAX_TRIPLES).contains(&self.triples), "triples", self.triples, "1 to 10000")?;
        self.fundamental.check()?;
        Ok(FourierPublished { settings: self })
    }
}

/// Published Fourier method.
///
/// Fails with [`IdentifyError::TooFewPoints`] if too few triples are usable, and with [`IdentifyError::NotAShip`] if
/// K/T is not positive.
#[derive(Debug, Clone, PartialEq)]
pub struct FourierPublished {
    settings: Settings,
}

impl FourierPublished {
    /// Fitted heading of one trial, for a plot; time runs from the first observed row.
    ///
    /// Fails as [`Identifier::identify`] does for a record that cannot be fitted.
    pub fn curve(&self, trial: &Trial) -> Result<FittedSeries, IdentifyError> {
        self.fit(&Samples::new(trial, 2 * self.settings.harmonics + 2)?)
    }

    fn fit(&self, samples: &Samples) -> Result<FittedSeries, IdentifyError> {
        fourier::fit(&samples.time, &samples.heading, self.settings.harmonics, &self.settings.fundamental)
    }

    /// Rudder, yaw rate and yaw acceleration of the fitted series at the instants of a trial from which triples are
    /// sampled; [`Selection::WellConditioned`] omits the ends of the record and a moving rudder.
    fn instants(&self, trial: &Trial, samples: &Samples, fitted: &FittedSeries) -> Vec<RegressionPoint> {
        let first = trial.observed_rows().next().expect("samples hold at least one observed row");
        let start = trial.time()[first];
        let duration = samples.time[samples.len() - 1];
        let rate = fitted.basis.derivative(&fitted.projection.coefficients);
        let yaw_rate = fitted.basis.values(&rate);
        let yaw_acceleration = fitted.basis.values(&fitted.basis.derivative(&rate));
        (0..samples.len())
            .filter(|&row| match self.settings.selection {
                Selection::Uniform => true,
                Selection::WellConditioned => {
                    let t = samples.time[row];
                    (t - 0.5 * duration).abs() <= 0.5 * INTERIOR_SHARE * duration
                        && range_about(trial.rudder_signal(), start + t, RUDDER_REST_S) < from_deg(RUDDER_REST_DEG)
                }
            })
            .map(|row| RegressionPoint {
                rudder: samples.rudder[row],
                yaw_rate: yaw_rate[row],
                yaw_acceleration: yaw_acceleration[row],
            })
            .collect()
    }

    fn aggregate(&self, estimates: &[TripleEstimate], index: impl Fn(&TripleEstimate) -> f64) -> f64 {
        match self.settings.aggregation {
            Aggregation::Mean => estimates.iter().map(index).sum::<f64>() / estimates.len() as f64,
            Aggregation::Median => quantile(&sorted(estimates, index), 0.5),
        }
    }

    fn uncertainty(&self, estimates: &[TripleEstimate]) -> Uncertainty {
        if self.settings.aggregation == Aggregation::Mean {
            let reason = "a mean over triples of one fitted curve: every estimate is a ratio without a finite variance, \
                          and all share the noise and the truncation of the curve";
            return Uncertainty::None { reason };
        }
        let Some((low, high)) = median_ranks(estimates.len()) else {
            return Uncertainty::None { reason: "a 95 % interval of a median needs at least 6 triples" };
        };
        let interval = |index: fn(&TripleEstimate) -> f64| {
            let values = sorted(estimates, index);
            [values[low], values[high]]
        };
        Uncertainty::Intervals {
            K: interval(|answer| answer.K),
            T: interval(|answer| answer.T),
            rudder_bias: interval(|answer| answer.rudder_bias),
            meaning: "95 % interval, by order statistics, of the median over all admissible triples of this fitted \
                      curve; it excludes the noise and the truncation of the curve",
        }
    }
}

impl Identifier for FourierPublished {
    fn id(&self) -> &'static str {
        "fourier-published"
    }

    fn summary(&self) -> &'static str {
        "Fourier series with a free fundamental, triples of instants, their mean (Ge, Hu, Yin and Sun)"
    }

    fn with_seed(&self, seed: u64) -> Option<Box<dyn Identifier>> {
        Some(Box::new(Self { settings: Settings { seed, ..self.settings.clone() } }))
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        let samples = Samples::from_trials(trials, 2 * self.settings.harmonics + 2)?;
        let mut fits = Vec::with_capacity(trials.len());
        let mut instants = Vec::new();
        for (trial, samples) in trials.iter().zip(&samples) {
            let fitted = self.fit(samples)?;
            instants.extend(self.instants(trial, samples, &fitted));
            fits.push(fitted);
        }
        let settings = &self.settings;
        let drawn = triples::sample_triples(&instants, settings.selection, settings.triples, settings.seed)?;
        let estimates = &drawn.estimates;
        let (gain, time_constant) = (self.aggregate(estimates, |a| a.K), self.aggregate(estimates, |a| a.T));
        let response = FirstOrder::from_indices(gain, time_constant, self.aggregate(estimates, |a| a.rudder_bias));
        // The condition also refuses NaN.
        if !(response.K_over_T > 0.0 && response.K_over_T.is_finite() && response.inverse_T.is_finite()) {
            return Err(IdentifyError::NotAShip { inverse_T: response.inverse_T, K_over_T: response.K_over_T });
        }
        Ok(Estimate {
            response,
            uncertainty: self.uncertainty(estimates),
            robust_covariance: None,
            stop: fits.iter().map(|fit| fit.stop).max().unwrap_or(StopReason::Direct),
            evaluations: fits.iter().map(|fit| fit.evaluations).sum::<usize>() + drawn.sampled,
            noise: None,
            diagnostics: diagnostics(&fits, instants.len(), &drawn),
            warnings: warnings(&fits, &drawn),
        })
    }
}

/// Diagnostics of the fits (of the first trial, or the worst of several) and of the triples.
fn diagnostics(fits: &[FittedSeries], instants: usize, drawn: &SampledTriples) -> Vec<(&'static str, f64)> {
    let mut all = fourier::diagnostics(fits);
    let spread = |index: fn(&TripleEstimate) -> f64| {
        let values = sorted(&drawn.estimates, index);
        quantile(&values, 0.75) - quantile(&values, 0.25)
    };
    all.extend([
        ("instants", instants as f64),
        ("triples_tried", drawn.sampled as f64),
        ("triples_accepted", drawn.estimates.len() as f64),
        ("triples_singular", drawn.singular as f64),
        ("triples_ill_conditioned", drawn.ill_conditioned as f64),
        ("triples_negative_index", drawn.negative as f64),
        ("triples_K_interquartile_range_per_s", spread(|answer| answer.K)),
        ("triples_T_interquartile_range_s", spread(|answer| answer.T)),
    ]);
    all
}

fn warnings(fits: &[FittedSeries], drawn: &SampledTriples) -> Vec<Warning> {
    let mut warnings = fourier::warnings(fits);
    if drawn.negative > 0 {
        let kept = drawn.estimates.len();
        let text = format!("{} of {kept} triples give a negative K or T and are part of the estimate", drawn.negative);
        warnings.push(WarningCode::NegativeIndex.warning(text));
    }
    warnings
}

/// Range of a signal from `reach` seconds before to `reach` after `t`, rad.
fn range_about(signal: &Polyline, t: f64, reach: f64) -> f64 {
    let place = |t: f64| signal.times().partition_point(|instant| *instant < t);
    let (from, to) = (place(t - reach), place(t + reach));
    let (lo, hi) = extremes(&signal.values()[from..to]);
    let ends = [signal.value_at(t - reach), signal.value_at(t + reach)];
    ends.into_iter().fold(hi, f64::max) - ends.into_iter().fold(lo, f64::min)
}

fn sorted(estimates: &[TripleEstimate], index: impl Fn(&TripleEstimate) -> f64) -> Vec<f64> {
    let mut values: Vec<f64> = estimates.iter().map(index).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Ranks, from 0, of the order statistics that bound a 95 % interval of the median; `None` below six values.
fn median_ranks(count: usize) -> Option<(usize, usize)> {
    let below = Binomial::new(0.5, count as u64).ok()?;
    let low = (0..count / 2).take_while(|&rank| below.cdf(rank as u64) <= 0.025).last()?;
    Some((low, count - 1 - low))
}

#[cfg(test)]
mod tests;
