//! The model that is fitted: a first-order base, shared by all records, and terms added to it, every parameter with its
//! prior.
//!
//! θ = (1/T, K/T, δ_r, deviation of δ_r in every one of several records, parameters of the terms …), SI and rad.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::DMatrix;
use ship::dynamics::Dynamics;
use ship::effects::{Effect, Parameter, Prior};
use ship::replay::replay_states;
use ship::response::{BASE, BASE_PARAMETERS};
use ship::{EffectReal, Real, Replayable, Response, ResponseModel};

use crate::record::PreparedRecord;

/// Most steps of the solver between two rows, which bounds the work for a trial point with an absurd time constant.
const MOST_STEPS: f64 = 8.0;

/// Standard deviation of the rudder bias, and of what it is in one record beside that, rad.
const BIAS_SD: f64 = 0.06;
const OWN_BIAS_SD: f64 = 0.01;

/// Standard deviations of 1/T and K/T in units of U/L and U²/L²: any hull is well within.
const BASE_SD: [f64; 2] = [3.0, 6.0];

/// An effect in one form, with what is expected of its parameters in these records.
#[derive(Debug, Clone)]
pub struct Term {
    /// The effect.
    pub effect: Arc<dyn Effect>,
    /// Number of the one record in which it acts; `None` for all.
    pub only: Option<usize>,
    /// What is expected of its parameters.
    pub priors: Vec<Prior>,
    /// Log of the prior odds that it is there.
    pub log_odds: f64,
}

/// Identifier, form and record of a term.
pub type TermName = (&'static str, &'static str, Option<usize>);

impl Term {
    /// Identifier, form and record.
    pub fn name(&self) -> TermName {
        (self.effect.id(), self.effect.form(), self.only)
    }

    /// Values at which the effect is absent: those that only shape it as expected.
    pub fn neutral(&self) -> Vec<f64> {
        let value = |(prior, parameter): (&Prior, &Parameter)| match (prior.is_shape, prior.beside) {
            (true, _) => prior.mean,
            (false, Some(_)) => 0.0,
            (false, None) => parameter.neutral,
        };
        self.priors.iter().zip(self.effect.parameters()).map(value).collect()
    }
}

/// What is said of one entry of θ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelParameter {
    /// What it is called and measured in.
    pub parameter: &'static Parameter,
    /// What is expected of it.
    pub prior: Prior,
    /// The record it belongs to; `None` for all.
    pub only: Option<usize>,
}

/// A value counts as the end of a range within this share of its size: a step that ends there adds a rounding.
const AT_END: f64 = 1e-9;

impl ModelParameter {
    /// Whether a value was fitted and lies at an end of the range.
    pub fn ends_at(&self, value: f64) -> bool {
        let near = |end: f64| (value - end).abs() <= AT_END * end.abs().max(1e-6);
        self.prior.is_fitted() && (near(self.prior.lowest) || near(self.prior.highest))
    }
}

/// Base and terms over a number of records.
#[derive(Debug, Clone)]
pub struct Structure {
    /// Number of records.
    pub records: usize,
    /// Time of the ship L/U, s.
    pub time: f64,
    /// The terms, in the order in which the rudder passes through them.
    pub terms: Vec<Arc<Term>>,
}

impl Structure {
    /// The base alone on some records of a ship that sails its length in `time` seconds.
    pub fn base(records: usize, time: f64) -> Self {
        Self { records, time, terms: Vec::new() }
    }

    /// The same base with other terms.
    #[must_use]
    pub fn of(&self, terms: Vec<Arc<Term>>) -> Self {
        Self { terms, ..*self }
    }

    /// Deviations of the rudder bias: one a record where there are several.
    fn deviations(&self) -> usize {
        if self.records > 1 { self.records } else { 0 }
    }

    /// Number of parameters of the base.
    pub fn base_count(&self) -> usize {
        BASE_PARAMETERS + self.deviations()
    }

    /// Number of entries of θ.
    pub fn count(&self) -> usize {
        self.base_count() + self.terms.iter().map(|term| term.priors.len()).sum::<usize>()
    }

    /// Where in θ the parameters of every term are.
    pub fn ranges(&self) -> Vec<Range<usize>> {
        let mut start = self.base_count();
        let range = |term: &Arc<Term>| {
            let range = start..start + term.priors.len();
            start = range.end;
            range
        };
        self.terms.iter().map(range).collect()
    }

    /// Every entry of θ.
    pub fn entries(&self) -> Vec<ModelParameter> {
        let base = |k: usize, sd: f64, only| ModelParameter {
            parameter: &BASE[k],
            prior: Prior::normal(&BASE[k], 0.0, sd),
            only,
        };
        let scale = [BASE_SD[0] / self.time, BASE_SD[1] / (self.time * self.time), BIAS_SD];
        let mut entries: Vec<ModelParameter> = (0..BASE_PARAMETERS).map(|k| base(k, scale[k], None)).collect();
        entries.extend((0..self.deviations()).map(|record| base(2, OWN_BIAS_SD, Some(record))));
        for term in &self.terms {
            let own = term.effect.parameters().iter().zip(&term.priors);
            entries.extend(own.map(|(parameter, &prior)| ModelParameter { parameter, prior, only: term.only }));
        }
        entries
    }

    /// What is expected of the fitted entries, and where they are.
    pub fn fitted_priors(&self, theta: &[f64]) -> Vec<(Prior, f64)> {
        let fitted = self.entries().into_iter().zip(theta).filter(|(entry, _)| entry.prior.is_fitted());
        fitted.map(|(entry, &value)| (entry.prior, value)).collect()
    }

    /// Places in θ of the fitted entries: unknown k of a fit is the entry at place k of these.
    pub fn fitted(&self) -> Vec<usize> {
        let entries = self.entries();
        (0..entries.len()).filter(|&place| entries[place].prior.is_fitted()).collect()
    }

    /// The unknown of a fit that every entry of θ is; `None` for one that is not fitted.
    pub fn unknowns(&self) -> Vec<Option<usize>> {
        let mut unknowns = vec![None; self.count()];
        self.fitted().into_iter().enumerate().for_each(|(unknown, place)| unknowns[place] = Some(unknown));
        unknowns
    }

    /// Covariance of all entries of θ from that of the fitted ones; zero for the others.
    pub fn spread(&self, fitted: &DMatrix<f64>) -> DMatrix<f64> {
        let places = self.fitted();
        let mut all = DMatrix::zeros(self.count(), self.count());
        for (i, &one) in places.iter().enumerate() {
            for (j, &other) in places.iter().enumerate() {
                all[(one, other)] = fitted[(i, j)];
            }
        }
        all
    }

    /// Whether the response depends on the direction in which the record begins.
    pub fn sees_heading(&self) -> bool {
        self.terms.iter().any(|term| term.effect.sees_heading())
    }

    /// Whether an entry of θ moves the heading of a record.
    pub fn acts(entry: &ModelParameter, record: usize) -> bool {
        entry.only.is_none_or(|only| only == record)
    }

    /// Places in θ that are counted from another one, with that one.
    fn counted(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.terms.iter().zip(self.ranges()).flat_map(|(term, range)| {
            let beside = |(place, prior): (usize, &Prior)| Some((place, range.start + prior.beside?));
            range.clone().zip(&term.priors).filter_map(beside).collect::<Vec<_>>()
        })
    }

    /// Values as the effects take them: what is counted from another parameter is added to it.
    pub fn physical<R: EffectReal>(&self, theta: &[R]) -> Vec<R> {
        let mut values = theta.to_vec();
        self.counted().for_each(|(place, other)| values[place] = theta[place] + theta[other]);
        values
    }

    /// Covariance of the values as the effects take them from that of θ.
    pub fn physical_covariance(&self, covariance: &DMatrix<f64>) -> DMatrix<f64> {
        let mut map = DMatrix::identity(covariance.nrows(), covariance.ncols());
        self.counted().for_each(|(place, other)| map[(place, other)] = 1.0);
        &map * covariance * map.transpose()
    }

    /// Places in θ of what [`response`](Self::response) of a record takes, base first; `None` for no record in
    /// particular, which leaves out what belongs to one.
    pub fn places(&self, record: Option<usize>) -> Vec<usize> {
        let mut places: Vec<usize> = (0..BASE_PARAMETERS).collect();
        for (term, range) in self.terms.iter().zip(self.ranges()) {
            if self.holds(term, record) {
                places.extend(range);
            }
        }
        places
    }

    /// The structure of one record alone with its parameters; with `None` that of the ship on another record.
    pub fn alone(&self, record: Option<usize>, theta: &[f64]) -> (Self, Vec<f64>) {
        let kept = self.terms.iter().filter(|term| self.holds(term, record));
        let terms = kept.map(|term| Arc::new(Term { only: None, ..term.as_ref().clone() })).collect();
        let mut values: Vec<f64> = self.places(record).into_iter().map(|place| theta[place]).collect();
        if let Some(record) = record.filter(|_| self.deviations() > 0) {
            values[2] += theta[BASE_PARAMETERS + record];
        }
        (Self { records: 1, time: self.time, terms }, values)
    }

    fn holds(&self, term: &Term, record: Option<usize>) -> bool {
        match record {
            Some(record) => term.only.is_none_or(|only| only == record),
            None => !term.effect.is_of_time(),
        }
    }

    /// The response of one record with these parameters; with `None` that of the ship, without what belongs to the
    /// weather of one record.
    pub fn response<R: EffectReal>(&self, record: Option<usize>, theta: &[R]) -> Response<R> {
        let values = self.physical(theta);
        let mut own: Vec<R> = self.places(record).into_iter().map(|place| values[place]).collect();
        if let Some(record) = record.filter(|_| self.deviations() > 0) {
            own[2] = own[2] + values[BASE_PARAMETERS + record];
        }
        let effects = self.terms.iter().filter(|term| self.holds(term, record));
        ResponseModel::new(effects.map(|term| Arc::clone(&term.effect)).collect()).with(own)
    }
}

/// Step of the solver for a ship on rows `spacing` seconds apart, between two times: `steps` per shortest time
/// constant.
pub fn step<R: Real, S: Replayable<R> + ?Sized>(
    ship: &S,
    spacing: f64,
    steps: f64,
) -> impl Fn(f64, f64) -> f64 + use<R, S> {
    let pace = ship.pace();
    move |from, to| (pace.shortest(from, to) / steps).max(spacing / MOST_STEPS)
}

/// Steps per shortest time constant of a fit: the heading is then exact to 10⁻⁴ of the response.
const STEPS: f64 = 2.0;

/// Replays a response along a record, from its first row, and visits the heading at every observed row.
pub fn headings<R: EffectReal>(
    response: &Response<R>,
    record: &PreparedRecord,
    initial: [R; 2],
    mut visit: impl FnMut(usize, R),
) {
    let recorded = record.recorded(response);
    let mut state = vec![R::from(0.0); response.dimension()];
    let start = recorded.input(record.time[0], response.dead_time());
    response.enter(initial[0], initial[1], &start, &mut state);
    let mut number = 0;
    let step = step(response, record.spacing, STEPS);
    replay_states(response, &recorded, &record.time, step, &mut state, |row, state, _| {
        if record.observed.get(number) == Some(&row) {
            visit(number, state[0]);
            number += 1;
        }
    });
}

#[cfg(test)]
mod tests {
    use ship::effects::{all, listed};

    use super::*;

    /// Of what was fitted, another record sees the base and the effects of the ship: no moment of time, whether it is
    /// of one of several records or of the only one, and no deviation of the rudder bias.
    #[test]
    fn nothing_of_one_record_is_replayed_on_another() {
        let damping = listed("nonlinear_damping", "r³");
        let of_time: Vec<_> = all().into_iter().filter(|effect| effect.is_of_time()).collect();
        assert!(["moment_drift", "transient_disturbance"].iter().all(|id| of_time.iter().any(|own| own.id() == *id)));
        for (records, only) in [(1, None), (2, Some(0)), (2, Some(1))] {
            let term = |effect: &Arc<dyn Effect>| {
                let priors = effect.parameters().iter().map(|own| Prior::normal(own, 0.0, 1.0)).collect();
                let only = only.filter(|_| effect.is_of_time());
                Arc::new(Term { effect: Arc::clone(effect), only, priors, log_odds: 0.0 })
            };
            let terms: Vec<_> = of_time.iter().chain([&damping]).map(term).collect();
            let structure = Structure::base(records, 13.0).of(terms);
            let theta: Vec<f64> = (0..structure.count()).map(|place| 0.01 * (1 + place) as f64).collect();
            let last = theta[theta.len() - 1];
            let (alone, values) = structure.alone(None, &theta);
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
