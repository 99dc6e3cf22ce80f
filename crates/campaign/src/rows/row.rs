//! Row of a study: the result of one method on one trial.

use std::sync::Arc;

use ::trace::TraceVerdict;
use document::trace::{Dependence, EffectEntry, ParameterEntry};

/// Effect named by a trace.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NamedEffect {
    /// Identifier of the effect.
    pub id: Box<str>,
    /// Identifiers of the aliases, which the trial cannot distinguish from the effect.
    pub aliases: Vec<Box<str>>,
    /// Time of a time-dependent effect, s: the centre of a transient, the onset of a lasting moment; `None` for any
    /// other.
    pub time_s: Option<f64>,
    /// Parameters of the effect, which only a study of measured records stores.
    pub parameters: Vec<EffectParameterValue>,
}

/// Parameter of an effect, nondimensional if length and speed of the ship are known.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectParameterValue {
    /// Symbol, with a prime if nondimensional.
    pub symbol: Box<str>,
    /// Value; in SI units and radians if it is dimensional.
    pub value: f64,
    /// Standard deviation; `None` for a parameter that is not fitted.
    pub sd: Option<f64>,
}

impl EffectParameterValue {
    /// Value of a parameter of a trace.
    pub fn from_parameter(parameter: &ParameterEntry) -> Self {
        let prime = parameter.prime.as_ref().map(|prime| (format!("{}′", parameter.symbol), prime.quantity));
        let (symbol, quantity) = prime.unwrap_or((parameter.symbol.clone(), parameter.quantity));
        Self { symbol: symbol.into(), value: quantity.value, sd: quantity.sd }
    }
}

impl NamedEffect {
    /// Named effect from the entry of a trace.
    pub fn from_entry(effect: &EffectEntry) -> Self {
        let aliases = effect.aliases.iter().filter(|alias| **alias != effect.id);
        let time = effect.parameters.values().find(|parameter| ["t_c", "t_0"].contains(&parameter.key.as_str()));
        Self {
            id: effect.id.as_str().into(),
            aliases: aliases.map(|id| id.as_str().into()).collect(),
            time_s: time.map(|parameter| parameter.quantity.value),
            parameters: effect.parameters.values().map(EffectParameterValue::from_parameter).collect(),
        }
    }

    /// `true` if an effect is this one or one of its aliases.
    pub fn includes(&self, id: &str) -> bool {
        *self.id == *id || self.aliases.iter().any(|alias| **alias == *id)
    }
}

/// Moment located by a trace.
#[derive(Debug, Clone, PartialEq)]
pub struct LocatedMoment {
    /// Variable that determines the moment.
    pub depends_on: Dependence,
    /// Description of the moment.
    pub form: Box<str>,
    /// Onset of a time-dependent moment, s; `None` for any other.
    pub from_s: Option<f64>,
    /// End of a time-dependent moment, s; `None` for one that lasts to the end of the record, and for any other.
    pub until_s: Option<f64>,
    /// Identifiers of listed effects that the trial cannot distinguish from the moment.
    pub alternatives: Vec<Box<str>>,
}

/// Characteristic of a manoeuvre: true value, and predicted median with its 90 % interval.
#[derive(Debug, Clone, PartialEq)]
pub struct PredictedCharacteristic {
    /// Manoeuvre and characteristic, with the unit: `zig-zag 20/20 first_overshoot_deg`.
    pub name: Box<str>,
    /// True value of the characteristic, in its unit.
    pub truth: f64,
    /// Median of the prediction.
    pub median: f64,
    /// 90 % interval.
    pub ci90: [f64; 2],
}

/// Result of a trace on one trial.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TraceRow {
    /// Verdict.
    pub verdict: TraceVerdict,
    /// Named effects, in the order of discovery.
    pub named_effects: Vec<NamedEffect>,
    /// Located moments outside the list of effects, clearest first.
    pub located_moments: Vec<LocatedMoment>,
    /// Identifiers of effects with a probability of at least 0.005, and this probability.
    pub probabilities: Vec<(Box<str>, f64)>,
    /// Log evidence of the missing effect less that of the best other effect; `None` unless exactly one effect is
    /// missing.
    pub evidence_margin: Option<f64>,
    /// Expected 2 ln Λ, with the likelihood ratio Λ of the truth to the nearest first-order response; `None` unless the
    /// heading noise is white.
    pub expected_2_ln_lambda: Option<f64>,
    /// Share of the headings of the trial inside the 95 % band of the traced model; `None` without a band.
    pub fitted_band_coverage: Option<f64>,
    /// Share of the headings of the validation manoeuvre inside the 95 % band of the traced model; `None` without a
    /// band.
    pub validation_band_coverage: Option<f64>,
}

/// Result of one method on one trial. Units are in the names; `None` is an undefined value.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StudyRow {
    /// Index of the cell in the design.
    pub cell: u64,
    /// Index of the replicate in the cell.
    pub replicate: u64,
    /// Index of the method in the scenario.
    pub method: usize,
    /// Reason of a failure; `None` if the method did not fail.
    pub failure: Option<Box<str>>,
    /// K of the first-order response nearest to the ship in the undisturbed trial, or of a first-order ship, 1/s: the
    /// true value for methods that fit such a response.
    pub true_k_per_s: Option<f64>,
    /// T of the nearest first-order response, s.
    pub true_t_s: Option<f64>,
    /// K of the first-order base of a ship with effects, 1/s: the true value for a trace.
    pub base_k_per_s: Option<f64>,
    /// T of the first-order base, s.
    pub base_t_s: Option<f64>,
    /// Cramér–Rao bounds on the standard deviations of K (1/s), T (s) and K/T (1/s²) of this trial.
    pub cramer_rao_sd: Option<[f64; 3]>,
    /// Estimate of K, 1/s.
    pub k_per_s: Option<f64>,
    /// Lower and upper end of the 95 % interval of K, 1/s.
    pub k_ci95_per_s: Option<[f64; 2]>,
    /// Estimate of T, s.
    pub t_s: Option<f64>,
    /// 95 % interval of T, s.
    pub t_ci95_s: Option<[f64; 2]>,
    /// Estimate of δ_r, deg.
    pub rudder_bias_deg: Option<f64>,
    /// 95 % interval of δ_r, deg.
    pub rudder_bias_ci95_deg: Option<[f64; 2]>,
    /// Root mean square error of the replayed heading on the trial itself, deg.
    pub heading_rmse_deg: Option<f64>,
    /// Root mean square error of the replayed heading on the validation manoeuvre, which is not fitted, deg.
    pub validation_rmse_deg: Option<f64>,
    /// Root mean square error on the validation manoeuvre with restarts every 60 s, deg; in a study of measured
    /// records.
    pub validation_60_s_rmse_deg: Option<f64>,
    /// Number of model evaluations.
    pub evaluations: Option<f64>,
    /// Reason why the method stopped.
    pub stop_reason: Option<&'static str>,
    /// Result of a trace.
    pub traced: Option<Box<TraceRow>>,
    /// Predicted characteristics of manoeuvres, empty without a covariance; `None` for a study without predictions.
    pub predictions: Option<Box<[PredictedCharacteristic]>>,
    /// Sampled values of the trial, in the order and units of the scenario's draws; shared by the rows of a trial.
    pub drawn_values: Option<Arc<[f64]>>,
}

impl StudyRow {
    /// True K (1/s) and T (s) for this method: of the base for a trace, which models the effects, otherwise of the
    /// nearest first-order response.
    pub fn true_indices(&self) -> [Option<f64>; 2] {
        match (&self.traced, self.base_k_per_s, self.base_t_s) {
            (Some(_), k @ Some(_), t @ Some(_)) => [k, t],
            _ => [self.true_k_per_s, self.true_t_s],
        }
    }

    /// Relative errors of K, (K̂ − K)/K, of T, and of K/T, the initial yaw acceleration per rudder angle, as fractions;
    /// `None` without an estimate or a truth, and for an infinite error.
    pub fn errors(&self) -> [Option<f64>; 3] {
        let ([k, t], [true_k, true_t]) = ([self.k_per_s, self.t_s], self.true_indices());
        let over = |k: Option<f64>, t: Option<f64>| Some(k? / t?);
        [(k, true_k), (t, true_t), (over(k, t), over(true_k, true_t))]
            .map(|(estimate, truth)| Some(estimate? / truth? - 1.0).filter(|error| error.is_finite()))
    }
}
