//! Recommended estimate: output error or maximum likelihood, by a rule on the record alone.
//!
//! Output error is recommended, because its first-order response is the nearest to the headings, with three exceptions.
//! If the recorded rudder has declared noise, maximum likelihood is recommended, which includes it. If the heading
//! jumps and stays off, without a random moment, maximum likelihood is recommended, which estimates the jumps. If
//! maximum likelihood finds a random yaw moment that the terms of a ship cannot explain ([`LackOfFit`]), it is
//! recommended as well: output error attributes the effect of gusts to the rudder. Records that declare a calm have no
//! such moment. If terms of a ship explain the residual, the model lacks a term. A random moment then substitutes for
//! it, and K, T of maximum likelihood describe small and fast motions. An estimate of maximum likelihood without an
//! interval of K is never recommended: its random moment explains the manoeuvre. Its replay error may exceed the error
//! of output error, as for the true ship under strong random moments, by a factor of at most 30. Without an estimate of
//! output error, that of maximum likelihood is recommended. The rule is not from the literature; METHODOLOGY documents
//! its limits.
//!
//! As a method it fits both models and returns the recommended estimate, so that a study can test the rule.

use document::WarningCode;
use document::fit::{ResidualKind, VerdictReason};
use serde::{Deserialize, Serialize};
use trial::Trial;

use crate::error::IdentifyError;
use crate::estimate::Estimate;
use crate::identifier::Identifier;
use crate::lack_of_fit::LackOfFit;
use crate::replay::pooled_response_rms;
use crate::settings::SettingsError;
use crate::{maximum_likelihood, output_error};

/// Minimum share of the residual, unexplained by ship terms, that counts as a random moment. The scenario `recommended`
/// shows the loss by the rule; METHODOLOGY documents the limit.
const MIN_RANDOM: f64 = 0.33;

/// Maximum replay error of maximum likelihood, relative to output error, of a ship in a random moment: above it
/// the moment would have to cancel the steering. In gusts the ratio is at most about five.
const MAX_REPLAY_RATIO: f64 = 30.0;

/// Reason for a recommendation, and the values from which it follows; [`Self::method`] is the method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recommendation {
    /// Reason for the recommendation.
    pub reason: VerdictReason,
    /// Lack of fit of output error; `None` without an estimate or without a noise level.
    pub lack_of_fit: Option<LackOfFit>,
    /// `true` if all records declare a calm, which excludes random moments.
    pub is_calm: bool,
}

impl Recommendation {
    /// Recommendation from the estimates of output error and maximum likelihood on these records.
    pub fn from_estimates(
        trials: &[Trial],
        output_error: Option<&Estimate>,
        maximum_likelihood: Option<&Estimate>,
    ) -> Self {
        let lack_of_fit = output_error.and_then(|estimate| LackOfFit::from_response(trials, &estimate.response));
        let is_calm = trials.iter().all(Trial::is_calm);
        let is_random =
            !is_calm && lack_of_fit.and_then(|lack| lack.unexplained_share()).is_some_and(|x| x >= MIN_RANDOM);
        let has_moment = |fit: &Estimate| fit.noise.is_some_and(|noise| !noise.moment.is_none());
        let rms = |fit: &Estimate| pooled_response_rms(trials, &fit.response).unwrap_or(f64::INFINITY);
        let is_far = |fit: &Estimate| output_error.is_some_and(|nearest| rms(fit) > MAX_REPLAY_RATIO * rms(nearest));
        let has_jumps = |fit: &Estimate| fit.warnings.iter().any(|warning| warning.code == WarningCode::HeadingJump);
        let has_noise = trials.iter().any(|trial| trial.noise().rudder_sd.is_some_and(|sd| sd > 0.0));
        let reason = match maximum_likelihood.filter(|estimate| estimate.K().ci95.is_some()) {
            Some(_) if has_noise => VerdictReason::RudderNoise,
            Some(fit) if !has_moment(fit) && has_jumps(fit) => VerdictReason::HeadingJumps,
            Some(fit) if output_error.is_none() || (is_random && has_moment(fit) && !is_far(fit)) => {
                VerdictReason::RandomMoment
            }
            _ => VerdictReason::NearestReplay,
        };
        Self { reason, lack_of_fit, is_calm }
    }

    /// Id of the recommended method.
    pub fn method(&self) -> &'static str {
        match self.reason {
            VerdictReason::NearestReplay => "output-error",
            VerdictReason::RandomMoment | VerdictReason::RudderNoise | VerdictReason::HeadingJumps => {
                "maximum-likelihood"
            }
        }
    }

    /// Kind of the residual of output error; `None` without a lack of fit.
    pub fn residual_kind(&self) -> Option<ResidualKind> {
        let share = self.lack_of_fit?.unexplained_share();
        Some(share.map_or(ResidualKind::Noise, |share| {
            if share < MIN_RANDOM || self.is_calm { ResidualKind::LacksEffect } else { ResidualKind::Random }
        }))
    }
}

/// Settings of the rule as a method; there are none.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Settings {}

impl Settings {
    /// Method with these settings.
    pub fn build(self) -> Result<Recommended, SettingsError> {
        Ok(Recommended {
            output_error: output_error::Settings::default().build()?,
            maximum_likelihood: maximum_likelihood::Settings::default().build()?,
        })
    }
}

/// Method of output error or maximum likelihood, selected by the record.
pub struct Recommended {
    output_error: output_error::OutputError,
    maximum_likelihood: maximum_likelihood::MaximumLikelihood,
}

impl Identifier for Recommended {
    fn id(&self) -> &'static str {
        "recommended"
    }

    fn summary(&self) -> &'static str {
        "output error, or maximum likelihood where the record shows a random moment or has a noisy rudder"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        let nearest = self.output_error.identify(trials);
        let likely = self.maximum_likelihood.identify(trials);
        match Recommendation::from_estimates(trials, nearest.as_ref().ok(), likely.as_ref().ok()).reason {
            VerdictReason::NearestReplay => nearest,
            VerdictReason::RandomMoment | VerdictReason::RudderNoise | VerdictReason::HeadingJumps => likely,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::Uncertainty;
    use crate::testing::{Case, record};
    use document::{HeadingNoise, RandomMoment};
    use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
    use ship::FirstOrder;
    use trial::{DeclaredConditions, DeclaredWeather, SensorNoise};

    fn nearest(trials: &[Trial]) -> Estimate {
        output_error::Settings::default().build().expect("defaults").identify(trials).expect("a fit")
    }

    /// Estimate with a random moment.
    fn in_gusts(base: &Estimate) -> Estimate {
        let moment = RandomMoment::White { rudder_rad_root_s: 0.05 };
        Estimate { noise: Some(HeadingNoise { heading_sd_rad: 0.001, moment }), ..base.clone() }
    }

    /// Record of a zig-zag under a white moment, which no term of a ship explains.
    fn windy() -> Trial {
        let case = Case { noise_deg: 0.05, ..Case::default() };
        let calm = case.trial();
        let mut generator = ChaCha8Rng::seed_from_u64(3);
        let [mut off, mut rate, step] = [0.0, 0.0, 0.1];
        let heading = calm.heading().iter().map(|psi| {
            let heading = psi + off;
            for _ in 0..10 {
                let moment = 0.3 * (generator.random::<f64>() - 0.5);
                rate += step * (case.K * moment - rate) / case.T;
                off += step * rate;
            }
            heading
        });
        record("windy", calm.time().to_vec(), heading.collect(), calm.rudder().to_vec())
    }

    /// Lasting jumps are estimated by maximum likelihood alone; together with a random moment they are no reason.
    #[test]
    fn jumps_of_the_heading_are_a_reason_without_a_random_moment() {
        let trials = [Case { noise_deg: 0.1, ..Case::default() }.trial()];
        let base = nearest(&trials);
        let reason = |other: &Estimate| Recommendation::from_estimates(&trials, Some(&base), Some(other)).reason;
        let jumping = Estimate { warnings: vec![WarningCode::HeadingJump.warning("it jumps")], ..base.clone() };
        assert_eq!(reason(&base), VerdictReason::NearestReplay);
        assert_eq!(reason(&jumping), VerdictReason::HeadingJumps);
        assert_eq!(
            Recommendation { reason: reason(&jumping), lack_of_fit: None, is_calm: false }.method(),
            "maximum-likelihood"
        );
        assert_eq!(reason(&in_gusts(&jumping)), VerdictReason::NearestReplay);
        let bare = Uncertainty::None { reason: "none" };
        assert_eq!(reason(&Estimate { uncertainty: bare, ..jumping }), VerdictReason::NearestReplay);
    }

    /// Under a random moment a replay error of 29 times the smallest is accepted, and 31 times is not.
    #[test]
    fn a_replay_thirty_times_farther_is_of_no_ship() {
        let trials = [windy()];
        let base = nearest(&trials);
        let distance = |response: &FirstOrder| pooled_response_rms(&trials, response).expect("a replay");
        let biased = |by: f64| FirstOrder { rudder_bias: base.response.rudder_bias + by, ..base.response };
        let ratio = |response: &FirstOrder| distance(response) / distance(&base.response);
        // The heading is linear in the bias, and the nearest replay has the least sum of squares.
        let unit = (ratio(&biased(1.0)).powi(2) - 1.0).sqrt();
        let reason = |times: f64| {
            let response = biased((times * times - 1.0).sqrt() / unit);
            assert!((ratio(&response) / times - 1.0).abs() < 0.02, "{} is not {times}", ratio(&response));
            Recommendation::from_estimates(&trials, Some(&base), Some(&Estimate { response, ..in_gusts(&base) })).reason
        };
        assert_eq!(
            [5.0, 29.0, 31.0].map(reason),
            [VerdictReason::RandomMoment, VerdictReason::RandomMoment, VerdictReason::NearestReplay]
        );
    }

    /// A moment that no term of a ship explains is random, unless the record declares a calm.
    #[test]
    fn a_declared_calm_excludes_a_random_moment() {
        let calm = DeclaredConditions { weather: Some(DeclaredWeather::Calm), ..DeclaredConditions::default() };
        let outcome = |trial: Trial| {
            let trials = [trial];
            let base = nearest(&trials);
            let outcome = Recommendation::from_estimates(&trials, Some(&base), Some(&in_gusts(&base)));
            (outcome.reason, outcome.residual_kind())
        };
        assert_eq!(outcome(windy()), (VerdictReason::RandomMoment, Some(ResidualKind::Random)));
        assert_eq!(
            outcome(windy().with_conditions(calm)),
            (VerdictReason::NearestReplay, Some(ResidualKind::LacksEffect))
        );
    }

    #[test]
    fn an_answer_without_intervals_is_not_taken() {
        let noise = SensorNoise { rudder_sd: Some(0.01), ..SensorNoise::default() };
        let trials = [Case { noise_deg: 0.1, ..Case::default() }.trial().with_noise(noise)];
        let base = output_error::Settings::default().build().expect("defaults").identify(&trials).expect("a fit");
        let reason = |other: &Estimate| Recommendation::from_estimates(&trials, Some(&base), Some(other)).reason;
        assert_eq!(reason(&base), VerdictReason::RudderNoise);
        let bare = Uncertainty::None { reason: "none" };
        assert_eq!(reason(&Estimate { uncertainty: bare, ..base.clone() }), VerdictReason::NearestReplay);
    }
}
