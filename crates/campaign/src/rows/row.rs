//! The result of one method on one trial.

use std::sync::Arc;

use ::trace::Verdict;
use document::trace::{Dependence, EffectEntry, ParameterEntry};

/// An effect that a trace named.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NamedEffect {
    /// Identifier of the effect.
    pub id: Box<str>,
    /// Identifiers of those that the trial cannot tell it from.
    pub aliases: Vec<Box<str>>,
    /// When an effect of time acts, s: the middle of a passing moment, the beginning of a lasting one.
    pub time_s: Option<f64>,
    /// Its parameters, in a study of measured records.
    pub sizes: Vec<EffectSize>,
}

/// A parameter of an effect, without dimension where the length and the speed of the ship are known.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectSize {
    /// Symbol, with a prime where it is without dimension.
    pub symbol: Box<str>,
    /// Value; SI units and radians where it has a dimension.
    pub value: f64,
    /// Standard deviation; `None` of a parameter that is not fitted.
    pub sd: Option<f64>,
}

impl EffectSize {
    /// That of a parameter of a trace.
    pub fn of(parameter: &ParameterEntry) -> Self {
        let prime = parameter.prime.as_ref().map(|prime| (format!("{}′", parameter.symbol), prime.quantity));
        let (symbol, quantity) = prime.unwrap_or((parameter.symbol.clone(), parameter.quantity));
        Self { symbol: symbol.into(), value: quantity.value, sd: quantity.sd }
    }
}

impl NamedEffect {
    /// That of a trace.
    pub fn of(effect: &EffectEntry) -> Self {
        let aliases = effect.aliases.iter().filter(|alias| **alias != effect.id);
        let time = effect.parameters.values().find(|parameter| ["t_c", "t_0"].contains(&parameter.key.as_str()));
        Self {
            id: effect.id.as_str().into(),
            aliases: aliases.map(|id| id.as_str().into()).collect(),
            time_s: time.map(|parameter| parameter.quantity.value),
            sizes: effect.parameters.values().map(EffectSize::of).collect(),
        }
    }

    /// Whether an effect is this one, or one that cannot be told from it.
    pub fn holds(&self, id: &str) -> bool {
        *self.id == *id || self.aliases.iter().any(|alias| **alias == *id)
    }
}

/// A moment that a trace located.
#[derive(Debug, Clone, PartialEq)]
pub struct LocatedMoment {
    /// What it depends on.
    pub depends_on: Dependence,
    /// The moment in words.
    pub form: Box<str>,
    /// Since when, s, where it is a matter of instants.
    pub from_s: Option<f64>,
    /// Until when, s; `None` for one that lasts to the end of the record.
    pub until_s: Option<f64>,
    /// Identifiers of the effects of the list that the trial cannot tell from it.
    pub alternatives: Vec<Box<str>>,
}

/// A figure of a manoeuvre that was predicted from an answer, beside what the same ship does.
#[derive(Debug, Clone, PartialEq)]
pub struct PredictedFigure {
    /// Manoeuvre and figure, with the unit: `zig-zag 20/20 first_overshoot_deg`.
    pub name: Box<str>,
    /// What the ship does.
    pub truth: f64,
    /// Median of the prediction.
    pub median: f64,
    /// Its 90 % interval.
    pub ci90: [f64; 2],
}

impl PredictedFigure {
    /// Whether the interval holds the truth.
    pub fn holds(&self) -> bool {
        (self.ci90[0]..=self.ci90[1]).contains(&self.truth)
    }
}

/// What a trace said of one trial.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TraceAnswer {
    /// Whether anything is missing, and whether it has a name.
    pub verdict: Verdict,
    /// The effects named, in the order of discovery.
    pub named: Vec<NamedEffect>,
    /// Moments that are no effects of the list, the clearest first.
    pub located: Vec<LocatedMoment>,
    /// Probability of every effect that is not next to nothing, given the trial.
    pub probabilities: Vec<(Box<str>, f64)>,
    /// Gain in BIC of the one missing effect over the best other one.
    pub margin: Option<f64>,
    /// Likelihood ratio of the truth against the nearest first-order response, on average.
    pub expected: Option<f64>,
    /// Share of the headings of the trial inside the 95 % band of the traced model.
    pub band_fitted: Option<f64>,
    /// The same on the validation manoeuvre.
    pub band_held_out: Option<f64>,
}

/// The result of one method on one trial. Units are in the names; `None` is "not defined".
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StudyRow {
    /// Index of the cell in the design.
    pub cell: u64,
    /// Index of the replicate in the cell.
    pub replicate: u64,
    /// Index of the method in the scenario.
    pub method: usize,
    /// Why the method failed; `None` when it did not.
    pub failure: Option<Box<str>>,
    /// K of the first-order response that comes nearest to the undisturbed trial of the ship, 1/s: its own where it is
    /// exactly first order. A method that fits such a response should find it.
    pub true_k_per_s: Option<f64>,
    /// T of that response, s.
    pub true_t_s: Option<f64>,
    /// K of the ship's own base, 1/s, where it has effects beside it. A trace should find it.
    pub own_k_per_s: Option<f64>,
    /// T of that base, s.
    pub own_t_s: Option<f64>,
    /// Best standard deviations of K (1/s), T (s) and K/T (1/s²) that an unbiased method can have on this trial, for
    /// its own noise and true K and T (Cramér–Rao).
    pub bound: Option<[f64; 3]>,
    /// K, 1/s.
    pub k_per_s: Option<f64>,
    /// Lower and upper end of the 95 % interval of K, 1/s.
    pub k_ci95_per_s: Option<[f64; 2]>,
    /// T, s.
    pub t_s: Option<f64>,
    /// 95 % interval of T, s.
    pub t_ci95_s: Option<[f64; 2]>,
    /// δ_r, deg.
    pub rudder_bias_deg: Option<f64>,
    /// 95 % interval of δ_r, deg.
    pub rudder_bias_ci95_deg: Option<[f64; 2]>,
    /// Root mean square error of the replayed heading on the trial itself, deg.
    pub heading_rmse_deg: Option<f64>,
    /// The same on the validation manoeuvre, which the method has not seen, deg.
    pub validation_rmse_deg: Option<f64>,
    /// The same restarted every 60 s, deg; in a study of measured records.
    pub validation_windows_deg: Option<f64>,
    /// Model evaluations of the method.
    pub evaluations: Option<f64>,
    /// Why the method stopped.
    pub stop: Option<&'static str>,
    /// What a trace said.
    pub traced: Option<Box<TraceAnswer>>,
    /// Figures of manoeuvres that were predicted from the answer, empty where it has no covariance; `None` where
    /// nothing is predicted.
    pub predicted: Option<Box<[PredictedFigure]>>,
    /// Drawn values of the trial, in the order and units of the scenario's draws; shared by the rows of a trial.
    pub drawn: Option<Arc<[f64]>>,
}

impl StudyRow {
    /// K and T that this answer is held against, 1/s and s: the ship's own for a trace, which models its effects, else
    /// those of the first-order response nearest to it.
    pub fn truth(&self) -> [Option<f64>; 2] {
        match (&self.traced, self.own_k_per_s, self.own_t_s) {
            (Some(_), k @ Some(_), t @ Some(_)) => [k, t],
            _ => [self.true_k_per_s, self.true_t_s],
        }
    }

    /// Relative errors of K, (K̂ − K)/K, of T, and of K/T, the slope of the response to the rudder at its beginning.
    pub fn errors(&self) -> [Option<f64>; 3] {
        let ([k, t], [true_k, true_t]) = ([self.k_per_s, self.t_s], self.truth());
        let over = |k: Option<f64>, t: Option<f64>| Some(k? / t?);
        [(k, true_k), (t, true_t), (over(k, t), over(true_k, true_t))]
            .map(|(found, truth)| Some(found? / truth? - 1.0).filter(|error| error.is_finite()))
    }
}
