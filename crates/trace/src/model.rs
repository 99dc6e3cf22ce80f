//! Structure of the fitted model: a first-order base, shared by all records, plus terms, every parameter with its
//! prior.
//!
//! θ = (1/T, K/T, δ_r, deviation of δ_r in every one of several records, parameters of the terms …), SI and rad.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::DMatrix;
use ship::dynamics::Dynamics;
use ship::effects::{Effect, Parameter, ParameterPrior};
use ship::replay::replay_states;
use ship::response::{BASE_PARAMETER_COUNT, BASE_PARAMETERS};
use ship::{EffectReal, Real, Replayable, Response, ResponseModel};

use crate::record::PreparedRecord;

/// Maximum number of solver steps between two rows: a bound on the computation at a trial point with an extreme time
/// constant.
const MAX_STEPS_PER_ROW: f64 = 8.0;

/// Prior standard deviation of the rudder bias, rad.
const BIAS_SD: f64 = 0.06;

/// Prior standard deviation of the deviation of the rudder bias in one record, rad.
const RECORD_BIAS_SD: f64 = 0.01;

/// Prior standard deviations of 1/T and K/T in units of U/L and U²/L²; usual values of ships are smaller.
const BASE_SD: [f64; 2] = [3.0, 6.0];

/// Candidate term: an effect in one form with priors for these records.
#[derive(Debug, Clone)]
pub struct Term {
    /// Effect.
    pub effect: Arc<dyn Effect>,
    /// Index of the record in which the effect acts; `None` for all records.
    pub record_index: Option<usize>,
    /// Priors of the parameters.
    pub priors: Vec<ParameterPrior>,
    /// Log prior odds of the term.
    pub log_odds: f64,
}

/// Identifier, form and record of a term.
pub type TermName = (&'static str, &'static str, Option<usize>);

impl Term {
    /// Identifier, form and record.
    pub fn name(&self) -> TermName {
        (self.effect.id(), self.effect.form(), self.record_index)
    }

    /// Parameter values at which the effect is absent; shape parameters at their prior means.
    pub fn neutral(&self) -> Vec<f64> {
        let value =
            |(prior, parameter): (&ParameterPrior, &Parameter)| match (prior.is_shape, prior.reference_parameter) {
                (true, _) => prior.mean,
                (false, Some(_)) => 0.0,
                (false, None) => parameter.neutral,
            };
        self.priors.iter().zip(self.effect.parameters()).map(value).collect()
    }
}

/// Entry of θ with its prior.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelParameter {
    /// Name and unit.
    pub parameter: &'static Parameter,
    /// Prior distribution, in the unit of the parameter.
    pub prior: ParameterPrior,
    /// Index of the record to which the parameter belongs; `None` for all records.
    pub record_index: Option<usize>,
}

/// Relative tolerance for "at its bound": a step that ends there adds a rounding error.
const BOUND_TOLERANCE: f64 = 1e-9;

impl ModelParameter {
    /// `true` if a value is fitted and lies at a bound of its prior.
    pub fn is_at_bound(&self, value: f64) -> bool {
        let near = |end: f64| (value - end).abs() <= BOUND_TOLERANCE * end.abs().max(1e-6);
        self.prior.is_fitted() && (near(self.prior.lowest) || near(self.prior.highest))
    }
}

/// Model structure: base and terms over a number of records.
#[derive(Debug, Clone)]
pub struct Structure {
    /// Number of records.
    pub record_count: usize,
    /// Ship time L/U, s.
    pub ship_length_time: f64,
    /// Terms, in the order in which the rudder passes through them.
    pub terms: Vec<Arc<Term>>,
}

impl Structure {
    /// Base alone, for a number of records and L/U = `ship_length_time` (s).
    pub fn base(record_count: usize, ship_length_time: f64) -> Self {
        Self { record_count, ship_length_time, terms: Vec::new() }
    }

    /// Structure of the same base with other terms.
    #[must_use]
    pub fn with_terms(&self, terms: Vec<Arc<Term>>) -> Self {
        Self { terms, ..*self }
    }

    /// Number of deviations of the rudder bias: one per record if there are several.
    fn deviations(&self) -> usize {
        if self.record_count > 1 { self.record_count } else { 0 }
    }

    /// Number of parameters of the base.
    pub fn base_parameter_count(&self) -> usize {
        BASE_PARAMETER_COUNT + self.deviations()
    }

    /// Number of entries of θ.
    pub fn parameter_count(&self) -> usize {
        self.base_parameter_count() + self.terms.iter().map(|term| term.priors.len()).sum::<usize>()
    }

    /// Ranges of the parameters of the terms in θ.
    pub fn term_ranges(&self) -> Vec<Range<usize>> {
        let mut start = self.base_parameter_count();
        let range = |term: &Arc<Term>| {
            let range = start..start + term.priors.len();
            start = range.end;
            range
        };
        self.terms.iter().map(range).collect()
    }

    /// Entries of θ.
    pub fn entries(&self) -> Vec<ModelParameter> {
        let base = |k: usize, sd: f64, record_index| ModelParameter {
            parameter: &BASE_PARAMETERS[k],
            prior: ParameterPrior::normal(&BASE_PARAMETERS[k], 0.0, sd),
            record_index,
        };
        let scale =
            [BASE_SD[0] / self.ship_length_time, BASE_SD[1] / (self.ship_length_time * self.ship_length_time), BIAS_SD];
        let mut entries: Vec<ModelParameter> = (0..BASE_PARAMETER_COUNT).map(|k| base(k, scale[k], None)).collect();
        entries.extend((0..self.deviations()).map(|record| base(2, RECORD_BIAS_SD, Some(record))));
        for term in &self.terms {
            let parameters = term.effect.parameters().iter().zip(&term.priors);
            let record_index = term.record_index;
            entries.extend(parameters.map(|(parameter, &prior)| ModelParameter { parameter, prior, record_index }));
        }
        entries
    }

    /// Priors of the fitted entries, with their values.
    pub fn fitted_priors(&self, theta: &[f64]) -> Vec<(ParameterPrior, f64)> {
        let fitted = self.entries().into_iter().zip(theta).filter(|(entry, _)| entry.prior.is_fitted());
        fitted.map(|(entry, &value)| (entry.prior, value)).collect()
    }

    /// Indices in θ of the fitted entries: unknown k of a fit is entry `fitted_indices()[k]`.
    pub fn fitted_indices(&self) -> Vec<usize> {
        let entries = self.entries();
        (0..entries.len()).filter(|&place| entries[place].prior.is_fitted()).collect()
    }

    /// Index of the unknown of every entry of θ; `None` for a fixed entry.
    pub fn unknown_indices(&self) -> Vec<Option<usize>> {
        let mut unknowns = vec![None; self.parameter_count()];
        self.fitted_indices().into_iter().enumerate().for_each(|(unknown, place)| unknowns[place] = Some(unknown));
        unknowns
    }

    /// Covariance of all entries of θ from the covariance of the fitted entries; zero for fixed entries.
    pub fn expanded_covariance(&self, fitted: &DMatrix<f64>) -> DMatrix<f64> {
        let places = self.fitted_indices();
        let mut all = DMatrix::zeros(self.parameter_count(), self.parameter_count());
        for (i, &row) in places.iter().enumerate() {
            for (j, &column) in places.iter().enumerate() {
                all[(row, column)] = fitted[(i, j)];
            }
        }
        all
    }

    /// `true` if the response depends on the heading, and so on its initial value.
    pub fn is_heading_dependent(&self) -> bool {
        self.terms.iter().any(|term| term.effect.is_heading_dependent())
    }

    /// `true` if an entry of θ acts in a record.
    pub fn acts_in(entry: &ModelParameter, record: usize) -> bool {
        entry.record_index.is_none_or(|number| number == record)
    }

    /// Entries of θ that are given relative to another entry: index, index of the reference.
    fn relative(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.terms.iter().zip(self.term_ranges()).flat_map(|(term, range)| {
            let reference =
                |(place, prior): (usize, &ParameterPrior)| Some((place, range.start + prior.reference_parameter?));
            range.clone().zip(&term.priors).filter_map(reference).collect::<Vec<_>>()
        })
    }

    /// Physical values of the parameters: the reference of a relative entry is added to the entry.
    pub fn physical<R: EffectReal>(&self, theta: &[R]) -> Vec<R> {
        let mut values = theta.to_vec();
        self.relative().for_each(|(place, other)| values[place] = theta[place] + theta[other]);
        values
    }

    /// Covariance of the physical values from the covariance of θ.
    pub fn physical_covariance(&self, covariance: &DMatrix<f64>) -> DMatrix<f64> {
        let mut map = DMatrix::identity(covariance.nrows(), covariance.ncols());
        self.relative().for_each(|(place, other)| map[(place, other)] = 1.0);
        &map * covariance * map.transpose()
    }

    /// Indices in θ of the parameters of [`response`](Self::response), base first: those that act in the fitted record
    /// `record`. `None` means any other record of the ship, in which no time-dependent term acts.
    pub fn response_indices(&self, record: Option<usize>) -> Vec<usize> {
        let mut places: Vec<usize> = (0..BASE_PARAMETER_COUNT).collect();
        for (term, range) in self.terms.iter().zip(self.term_ranges()) {
            if Self::applies(term, record) {
                places.extend(range);
            }
        }
        places
    }

    /// Structure and parameters for one fitted record; with `None` for any other record of the ship.
    pub fn for_record(&self, record: Option<usize>, theta: &[f64]) -> (Self, Vec<f64>) {
        let kept = self.terms.iter().filter(|term| Self::applies(term, record));
        let terms = kept.map(|term| Arc::new(Term { record_index: None, ..term.as_ref().clone() })).collect();
        let mut values: Vec<f64> = self.response_indices(record).into_iter().map(|place| theta[place]).collect();
        if let Some(record) = record.filter(|_| self.deviations() > 0) {
            values[2] += theta[BASE_PARAMETER_COUNT + record];
        }
        (Self { record_count: 1, ship_length_time: self.ship_length_time, terms }, values)
    }

    /// `true` if a term applies to a fitted record, or to any other record (`None`).
    fn applies(term: &Term, record: Option<usize>) -> bool {
        match record {
            Some(record) => term.record_index.is_none_or(|number| number == record),
            None => !term.effect.is_time_dependent(),
        }
    }

    /// Response for one fitted record; with `None` for any other record, without the terms of single records.
    pub fn response<R: EffectReal>(&self, record: Option<usize>, theta: &[R]) -> Response<R> {
        let values = self.physical(theta);
        let mut parameters: Vec<R> = self.response_indices(record).into_iter().map(|place| values[place]).collect();
        if let Some(record) = record.filter(|_| self.deviations() > 0) {
            parameters[2] = parameters[2] + values[BASE_PARAMETER_COUNT + record];
        }
        let effects = self.terms.iter().filter(|term| Self::applies(term, record));
        ResponseModel::new(effects.map(|term| Arc::clone(&term.effect)).collect()).with_parameters(parameters)
    }
}

/// Maximum solver step (s) as a function of the two times (s) between which it applies, for rows `spacing` seconds
/// apart and `steps` steps per minimum time constant.
pub fn solver_step<R: Real, S: Replayable<R> + ?Sized>(
    ship: &S,
    spacing: f64,
    steps: f64,
) -> impl Fn(f64, f64) -> f64 + use<R, S> {
    let pace = ship.time_constants();
    move |from, to| (pace.shortest(from, to) / steps).max(spacing / MAX_STEPS_PER_ROW)
}

/// Solver steps per minimum time constant in a fit: the heading is then exact to 10⁻⁴ of the response.
const STEPS: f64 = 2.0;

/// Replays a response along a record from its first row. Calls `visit` with the index of every observed row among the
/// observed rows, and with its heading, rad.
pub fn replay_headings<R: EffectReal>(
    response: &Response<R>,
    record: &PreparedRecord,
    initial: [R; 2],
    mut visit: impl FnMut(usize, R),
) {
    let recorded = record.replay_signals(response);
    let mut state = vec![R::from(0.0); response.dimension()];
    let start = recorded.input(record.time[0], response.dead_time());
    response.initialise(initial[0], initial[1], &start, &mut state);
    let mut number = 0;
    let step = solver_step(response, record.spacing, STEPS);
    replay_states(response, &recorded, &record.time, step, &mut state, |row, state, _| {
        if record.observed_rows.get(number) == Some(&row) {
            visit(number, state[0]);
            number += 1;
        }
    });
}

#[cfg(test)]
mod tests {
    use ship::effects::{all_effects, listed_effect};

    use super::*;

    /// The replay of another record has the base and the effects of the ship, but no moment of time, whether one or
    /// several records were fitted, and no deviation of the rudder bias.
    #[test]
    fn terms_of_one_record_are_not_replayed_on_another() {
        let damping = listed_effect("nonlinear_damping", "r³");
        let of_time: Vec<_> = all_effects().into_iter().filter(|effect| effect.is_time_dependent()).collect();
        let has = |id: &&str| of_time.iter().any(|effect| effect.id() == *id);
        assert!(["moment_drift", "transient_disturbance"].iter().all(has));
        for (records, only) in [(1, None), (2, Some(0)), (2, Some(1))] {
            let term = |effect: &Arc<dyn Effect>| {
                let priors =
                    effect.parameters().iter().map(|parameter| ParameterPrior::normal(parameter, 0.0, 1.0)).collect();
                let only = only.filter(|_| effect.is_time_dependent());
                Arc::new(Term { effect: Arc::clone(effect), record_index: only, priors, log_odds: 0.0 })
            };
            let terms: Vec<_> = of_time.iter().chain([&damping]).map(term).collect();
            let structure = Structure::base(records, 13.0).with_terms(terms);
            let theta: Vec<f64> = (0..structure.parameter_count()).map(|place| 0.01 * (1 + place) as f64).collect();
            let last = theta[theta.len() - 1];
            let (alone, values) = structure.for_record(None, &theta);
            for ship in [structure.response(None, &theta), alone.response(None, &values)] {
                assert_eq!(ship.parameters(), [theta[0], theta[1], theta[2], last]);
            }
            let seen = structure.response(Some(only.unwrap_or(0)), &theta);
            assert_eq!(
                (seen.model().effects().len(), seen.parameters()[2] > theta[2]),
                (of_time.len() + 1, records > 1)
            );
        }
    }
}
