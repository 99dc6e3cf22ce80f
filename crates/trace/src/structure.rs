//! The structure that is fitted: the first-order base, shared by all records, and terms added to it, each with the
//! bounds inside which a search may move its parameters.
//!
//! θ = (1/T, K/T, δ_r of all or of every record, parameters of the terms …), SI and rad.

use std::sync::Arc;

use ship::dynamics::Dynamics;
use ship::effects::{Effect, Parameter, SpeedLoss};
use ship::replay::replay_states;
use ship::response::BASE;
use ship::{EffectReal, Response, ResponseModel};

use crate::index::{RecordNumber, TermPlace, ThetaPlace};
use crate::record::Record;

/// Steps of the solver per shortest time constant: the classical Runge–Kutta step is then exact to 10⁻⁵ of the
/// response, far below any heading that is measured.
const STEPS: f64 = 4.0;

/// Most steps between two rows, which bounds the work for a trial point with an absurd time constant.
const MOST_STEPS: f64 = 16.0;

/// An effect in one form, with the range and the scale of its parameters in these records.
#[derive(Debug, Clone)]
pub struct Term {
    /// The effect.
    pub effect: Arc<dyn Effect>,
    /// The one record in which it acts; `None` for all.
    pub only: Option<RecordNumber>,
    /// Parameters that are not fitted but kept at their start.
    pub held: &'static [usize],
    /// Smallest values.
    pub lowest: Vec<f64>,
    /// Largest values.
    pub highest: Vec<f64>,
    /// Sizes against which steps are measured.
    pub scale: Vec<f64>,
}

/// Identifier, form and record of a term.
pub type TermName = (&'static str, &'static str, Option<RecordNumber>);

impl Term {
    /// Number of fitted parameters.
    pub fn freedom(&self) -> usize {
        self.effect.parameters().len() - self.held.len()
    }

    /// Whether two terms are the same effect in the same form on the same records.
    pub fn is(&self, other: &Term) -> bool {
        self.name() == other.name()
    }

    /// Identifier, form and record.
    pub fn name(&self) -> TermName {
        (self.effect.id(), self.effect.form(), self.only)
    }
}

/// A base whose K and T follow the measured speed: K ~ U and T ~ 1/U. It costs no parameter.
#[derive(Debug, Clone)]
pub struct SpeedScaling {
    /// The speed of which K and T are told, m/s.
    pub approach_speed: f64,
    effect: Arc<dyn Effect>,
}

impl SpeedScaling {
    /// Scaling about an approach speed, m/s.
    pub fn about(approach_speed: f64) -> Self {
        Self { approach_speed, effect: Arc::new(SpeedLoss::Measured { approach_speed }) }
    }

    /// Identifier, form and record of the effect whose exponents are those of the free stream here.
    pub fn name(&self) -> TermName {
        (self.effect.id(), self.effect.form(), None)
    }
}

/// Base and terms over a number of records.
#[derive(Debug, Clone)]
pub struct Structure {
    /// Number of records.
    pub records: usize,
    /// Whether every record has a rudder bias of its own.
    pub own_bias: bool,
    /// Whether K and T of the base follow the measured speed. A term with exponents of its own takes the place of it.
    pub scaling: Option<SpeedScaling>,
    /// Whether the ship is known: nothing is fitted but what depends on time alone, and initial states.
    pub ship_known: bool,
    /// The terms, in the order in which the rudder passes through them.
    pub terms: Vec<Term>,
}

/// What one entry of θ is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entry {
    /// What it is called and measured in.
    pub parameter: &'static Parameter,
    /// Whether it is fitted.
    pub fitted: bool,
    /// Smallest value.
    pub lowest: f64,
    /// Largest value.
    pub highest: f64,
    /// Size against which steps are measured.
    pub scale: f64,
    /// The record it belongs to; `None` for all.
    pub only: Option<RecordNumber>,
}

/// A value counts as the end of a range within this share of its size: a step that ends there adds a rounding.
const AT_END: f64 = 1e-9;

impl Entry {
    /// Whether a value was fitted and lies at an end of the range.
    pub fn ends_at(&self, value: f64) -> bool {
        let near = |end: f64| (value - end).abs() <= AT_END * end.abs().max(self.scale);
        self.fitted && (near(self.lowest) || near(self.highest))
    }
}

/// Where in θ the parameters are that are fitted.
pub fn fitted(entries: &[Entry]) -> Vec<ThetaPlace> {
    (0..entries.len()).filter(|&k| entries[k].fitted).map(ThetaPlace).collect()
}

impl Structure {
    /// The base alone.
    pub fn base(records: usize, own_bias: bool) -> Self {
        Self { records, own_bias, scaling: None, ship_known: false, terms: Vec::new() }
    }

    /// Number of rudder biases.
    fn biases(&self) -> usize {
        if self.own_bias { self.records } else { 1 }
    }

    /// Number of base parameters.
    pub fn base_count(&self) -> usize {
        2 + self.biases()
    }

    /// Number of fitted parameters.
    pub fn free_count(&self) -> usize {
        let base = if self.ship_known { 0 } else { self.base_count() };
        base + self.terms.iter().filter(|term| self.fits(term)).map(Term::freedom).sum::<usize>()
    }

    /// The scaling of the base, unless a term has taken its place.
    pub fn scaled(&self) -> Option<&SpeedScaling> {
        self.scaling.as_ref().filter(|scaling| self.terms.iter().all(|term| term.name() != scaling.name()))
    }

    /// Whether it is a first-order response with constant K and T.
    pub fn is_constant(&self) -> bool {
        self.terms.is_empty() && self.scaling.is_none()
    }

    /// Whether it is one with one rudder bias, too.
    pub fn is_first_order(&self) -> bool {
        self.is_constant() && !self.own_bias
    }

    /// Whether the parameters of a term are fitted.
    fn fits(&self, term: &Term) -> bool {
        !self.ship_known || term.effect.is_of_time()
    }

    /// The same with one more term.
    pub fn with(&self, term: Term) -> Self {
        let mut more = self.clone();
        more.terms.push(term);
        more
    }

    /// Places of the terms.
    pub fn places(&self) -> impl DoubleEndedIterator<Item = TermPlace> + ExactSizeIterator + use<> {
        (0..self.terms.len()).map(TermPlace)
    }

    /// The term at `place`.
    pub fn term(&self, place: TermPlace) -> &Term {
        &self.terms[place.0]
    }

    /// The same without the term at `place`.
    pub fn without(&self, place: TermPlace) -> Self {
        let mut less = self.clone();
        less.terms.remove(place.0);
        less
    }

    /// θ without the parameters of the term at `place`.
    pub fn drop_from(&self, theta: &[f64], place: TermPlace) -> Vec<f64> {
        let range = self.range(place);
        [&theta[..range.start], &theta[range.end..]].concat()
    }

    /// Where in θ the parameters of the term at `place` are.
    pub fn range(&self, place: TermPlace) -> std::ops::Range<usize> {
        let before: usize = self.terms[..place.0].iter().map(|term| term.effect.parameters().len()).sum();
        let start = self.base_count() + before;
        start..start + self.term(place).effect.parameters().len()
    }

    /// Every entry of θ.
    pub fn entries(&self, inverse_time_scale: f64, gain_scale: f64) -> Vec<Entry> {
        let base = |k: usize, scale: f64, only| Entry {
            parameter: &BASE[k],
            fitted: !self.ship_known,
            lowest: BASE[k].lowest,
            highest: BASE[k].highest,
            scale,
            only,
        };
        let mut entries = vec![base(0, inverse_time_scale, None), base(1, gain_scale, None)];
        for record in 0..self.biases() {
            entries.push(base(2, BASE[2].typical, self.own_bias.then_some(RecordNumber(record))));
        }
        for term in &self.terms {
            for (k, parameter) in term.effect.parameters().iter().enumerate() {
                entries.push(Entry {
                    parameter,
                    fitted: self.fits(term) && !term.held.contains(&k),
                    lowest: term.lowest[k],
                    highest: term.highest[k],
                    scale: term.scale[k],
                    only: term.only,
                });
            }
        }
        entries
    }

    /// Whether the response depends on the direction in which the record begins.
    pub fn sees_heading(&self) -> bool {
        self.terms.iter().any(|term| term.effect.sees_heading())
    }

    /// The response of one record, with these parameters.
    pub fn response<R: EffectReal>(&self, record: RecordNumber, theta: &[R]) -> Response<R> {
        let (mut effects, mut own) = (Vec::with_capacity(self.terms.len()), Vec::with_capacity(theta.len()));
        own.extend_from_slice(&theta[..2]);
        own.push(theta[2 + if self.own_bias { record.0 } else { 0 }]);
        if let Some(SpeedScaling { effect, .. }) = self.scaled() {
            effects.push(Arc::clone(effect));
            own.extend(SpeedLoss::FREE_STREAM.map(R::from));
        }
        let mut from = self.base_count();
        for term in &self.terms {
            let to = from + term.effect.parameters().len();
            if term.only.is_none_or(|only| only == record) {
                effects.push(Arc::clone(&term.effect));
                own.extend_from_slice(&theta[from..to]);
            }
            from = to;
        }
        ResponseModel::new(effects).with(own)
    }
}

/// Step of the solver for a response on rows `spacing` seconds apart, between two times.
pub fn step<R: EffectReal>(response: &Response<R>, spacing: f64) -> impl Fn(f64, f64) -> f64 {
    let pace = response.pace();
    move |from, to| (pace.shortest(from, to) / STEPS).max(spacing / MOST_STEPS)
}

/// Replays a response along a record, from its first row, and visits the heading at every observed row.
pub fn headings<R: EffectReal>(
    response: &Response<R>,
    record: &Record,
    initial: [R; 2],
    mut visit: impl FnMut(usize, R),
) {
    let recorded = record.recorded(response);
    let mut state = vec![R::from(0.0); response.dimension()];
    let start = recorded.input(record.time[0], response.dead_time());
    response.enter(initial[0], initial[1], &start, &mut state);
    let mut number = 0;
    let step = step(response, record.spacing);
    replay_states(response, &recorded, &record.time, step, &mut state, |row, state, _| {
        if record.observed.get(number) == Some(&row) {
            visit(number, state[0]);
            number += 1;
        }
    });
}
