//! Which answer to take: one rule, made from the record alone.
//!
//! Output error is the answer, because no other first-order response is nearer to the headings, with three exceptions.
//! Where the recorded rudder has declared noise, maximum likelihood counts it. Where the heading jumps and stays off,
//! and no random moment is needed beside that, it estimates the jumps. Where maximum likelihood finds a random
//! yaw moment that the terms of a ship cannot explain ([`LackOfFit`]), it is the answer, too: output error takes the
//! work of gusts for that of the rudder. Records that declare a calm have no such moment. Where terms of a ship explain
//! the residual, the model lacks one of them. A random moment then stands for it, and K, T of maximum likelihood are
//! those of small and fast motions. An answer of maximum likelihood without an interval of K is never taken: its random
//! moment explains the manoeuvre itself. A replay far worse than that of output error is no such sign: under strong
//! random moments the true ship has one, too.
//!
//! As a method of its own it makes both fits and returns the one that the rule names, so that a study can hold the
//! rule.

use document::Code;
use document::fit::{Reason, ResidualKind};
use serde::{Deserialize, Serialize};
use trial::Trial;

use crate::error::IdentifyError;
use crate::estimate::Estimate;
use crate::identifier::Identifier;
use crate::lack_of_fit::LackOfFit;
use crate::replay::pooled;
use crate::settings::SettingsError;
use crate::{maximum_likelihood, output_error};

/// Share of the residual that the terms of a ship leave where a random moment is believed. The scenario `recommended`
/// shows what the rule costs; METHODOLOGY says how the limit was set.
const RANDOM: f64 = 0.33;

/// A replay of maximum likelihood so many times farther from the headings than that of output error is no ship in a
/// random moment: the moment would have to take all of it away again. In gusts it is at most some five times as far.
const CANCELLED: f64 = 30.0;

/// Which answer to take and what to think of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recommendation {
    /// Why.
    pub reason: Reason,
    /// What output error leaves of the records; `None` where it has no answer or the noise is not known.
    pub lack: Option<LackOfFit>,
    /// Whether all records declare a calm, in which nothing turns the ship at random.
    pub is_calm: bool,
}

impl Recommendation {
    /// From the answers of output error and maximum likelihood on these records.
    pub fn of(trials: &[Trial], output_error: Option<&Estimate>, maximum_likelihood: Option<&Estimate>) -> Self {
        let lack = output_error.and_then(|estimate| LackOfFit::of(trials, &estimate.response));
        let is_calm = trials.iter().all(Trial::is_calm);
        let is_random = !is_calm && lack.and_then(|lack| lack.unexplained()).is_some_and(|share| share >= RANDOM);
        let has_moment = |own: &Estimate| own.noise.is_some_and(|noise| !noise.moment.is_none());
        let rms = |own: &Estimate| pooled(trials, &own.response).unwrap_or(f64::INFINITY);
        let is_cancelled = |own: &Estimate| output_error.is_some_and(|nearest| rms(own) > CANCELLED * rms(nearest));
        let has_jumps = |own: &Estimate| own.warnings.iter().any(|warning| warning.code == Code::HeadingJump);
        let has_noise = trials.iter().any(|trial| trial.noise().rudder.is_some_and(|sd| sd > 0.0));
        let reason = match maximum_likelihood.filter(|own| own.K().ci95.is_some()) {
            Some(_) if has_noise => Reason::RudderNoise,
            Some(own) if !has_moment(own) && has_jumps(own) => Reason::HeadingJumps,
            Some(own) if output_error.is_none() || (is_random && has_moment(own) && !is_cancelled(own)) => {
                Reason::RandomMoment
            }
            _ => Reason::NearestReplay,
        };
        Self { reason, lack, is_calm }
    }

    /// The method whose answer is to be taken.
    pub fn method(&self) -> &'static str {
        match self.reason {
            Reason::NearestReplay => "output-error",
            Reason::RandomMoment | Reason::RudderNoise | Reason::HeadingJumps => "maximum-likelihood",
        }
    }

    /// What the residual of output error looks like.
    pub fn residual(&self) -> Option<ResidualKind> {
        let share = self.lack?.unexplained();
        Some(share.map_or(ResidualKind::Noise, |share| {
            if share < RANDOM || self.is_calm { ResidualKind::LacksEffect } else { ResidualKind::Random }
        }))
    }
}

/// The rule as a method; it has no settings.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Settings {}

impl Settings {
    /// Makes the method; no file is looked for.
    pub fn build(self) -> Result<Recommended, SettingsError> {
        Ok(Recommended {
            output_error: output_error::Settings::default().build()?,
            maximum_likelihood: maximum_likelihood::Settings::default().build()?,
        })
    }
}

/// Output error or maximum likelihood, as the record says.
pub struct Recommended {
    output_error: output_error::OutputError,
    maximum_likelihood: maximum_likelihood::MaximumLikelihood,
}

impl Identifier for Recommended {
    fn id(&self) -> &'static str {
        "recommended"
    }

    fn summary(&self) -> &'static str {
        "output error, or maximum likelihood where a random moment or a noisy rudder asks for it"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        let nearest = self.output_error.identify(trials);
        let likely = self.maximum_likelihood.identify(trials);
        match Recommendation::of(trials, nearest.as_ref().ok(), likely.as_ref().ok()).reason {
            Reason::NearestReplay => nearest,
            Reason::RandomMoment | Reason::RudderNoise | Reason::HeadingJumps => likely,
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
    use trial::{Conditions, DeclaredWeather, Noise};

    fn nearest(trials: &[Trial]) -> Estimate {
        output_error::Settings::default().build().expect("defaults").identify(trials).expect("a fit")
    }

    /// The same answer with a random moment beside it.
    fn in_gusts(own: &Estimate) -> Estimate {
        let moment = RandomMoment::White { rudder_rad_root_s: 0.05 };
        Estimate { noise: Some(HeadingNoise { heading_sd_rad: 0.001, moment }), ..own.clone() }
    }

    /// A zig-zag in a white moment, which no term of a ship explains.
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

    /// Jumps that stay are counted by maximum likelihood alone; beside a random moment they are no reason.
    #[test]
    fn jumps_of_the_heading_are_a_reason_without_a_random_moment() {
        let trials = [Case { noise_deg: 0.1, ..Case::default() }.trial()];
        let own = nearest(&trials);
        let reason = |other: &Estimate| Recommendation::of(&trials, Some(&own), Some(other)).reason;
        let jumping = Estimate { warnings: vec![Code::HeadingJump.warning("it jumps")], ..own.clone() };
        assert_eq!(reason(&own), Reason::NearestReplay);
        assert_eq!(reason(&jumping), Reason::HeadingJumps);
        assert_eq!(
            Recommendation { reason: reason(&jumping), lack: None, is_calm: false }.method(),
            "maximum-likelihood"
        );
        assert_eq!(reason(&in_gusts(&jumping)), Reason::NearestReplay);
        let bare = Uncertainty::None { reason: "none" };
        assert_eq!(reason(&Estimate { uncertainty: bare, ..jumping }), Reason::NearestReplay);
    }

    /// A replay may be 29 times as far as the nearest where the moment is random, and not 31 times.
    #[test]
    fn a_replay_thirty_times_farther_is_of_no_ship() {
        let trials = [windy()];
        let own = nearest(&trials);
        let distance = |response: &FirstOrder| pooled(&trials, response).expect("a replay");
        let biased = |by: f64| FirstOrder { rudder_bias: own.response.rudder_bias + by, ..own.response };
        let ratio = |response: &FirstOrder| distance(response) / distance(&own.response);
        // The heading is linear in the bias, and the nearest replay has the least square.
        let unit = (ratio(&biased(1.0)).powi(2) - 1.0).sqrt();
        let reason = |times: f64| {
            let response = biased((times * times - 1.0).sqrt() / unit);
            assert!((ratio(&response) / times - 1.0).abs() < 0.02, "{} is not {times}", ratio(&response));
            Recommendation::of(&trials, Some(&own), Some(&Estimate { response, ..in_gusts(&own) })).reason
        };
        assert_eq!([5.0, 29.0, 31.0].map(reason), [Reason::RandomMoment, Reason::RandomMoment, Reason::NearestReplay]);
    }

    /// A moment that no term of a ship explains is random, unless the record declares a calm.
    #[test]
    fn in_a_declared_calm_no_random_moment_is_believed() {
        let calm = Conditions { weather: Some(DeclaredWeather::Calm), ..Conditions::default() };
        let said = |trial: Trial| {
            let trials = [trial];
            let own = nearest(&trials);
            let said = Recommendation::of(&trials, Some(&own), Some(&in_gusts(&own)));
            (said.reason, said.residual())
        };
        assert_eq!(said(windy()), (Reason::RandomMoment, Some(ResidualKind::Random)));
        assert_eq!(said(windy().with_conditions(calm)), (Reason::NearestReplay, Some(ResidualKind::LacksEffect)));
    }

    #[test]
    fn an_answer_without_intervals_is_not_taken() {
        let noise = Noise { rudder: Some(0.01), ..Noise::default() };
        let trials = [Case { noise_deg: 0.1, ..Case::default() }.trial().with_noise(noise)];
        let own = output_error::Settings::default().build().expect("defaults").identify(&trials).expect("a fit");
        let reason = |other: &Estimate| Recommendation::of(&trials, Some(&own), Some(other)).reason;
        assert_eq!(reason(&own), Reason::RudderNoise);
        let bare = Uncertainty::None { reason: "none" };
        assert_eq!(reason(&Estimate { uncertainty: bare, ..own.clone() }), Reason::NearestReplay);
    }
}
