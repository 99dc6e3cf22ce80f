//! The first-order heading of one trial as a linear combination of four columns, once 1/T is given.
//!
//! ψ = ψ₁ · 1 + r₁ · φ₁(t − t₁) + b · G(t; a) + b δ_r · H(t; a), where G is the response to the recorded rudder and H the one
//! to a constant, both from rest at the anchor t₁. For a ≥ 0 the anchor is the first row; for a < 0 it is the last one and
//! the columns are stepped backwards in time, so that nothing grows exponentially for either sign of T and the
//! columns stay as independent as the record allows. This module knows how to fill the columns and how the heading
//! changes with a; it does not choose parameters.

use ship::FirstOrder;
use ship::first_order::{State, TangentTransition, Transition};
use trial::Trial;

use crate::error::IdentifyError;
use crate::samples::Samples;

/// Steps whose lengths differ by less than this share use the same transition: far below any clock.
const SAME_STEP: f64 = 1e-9;

/// One trial, from its first to its last row with a heading.
#[derive(Debug, Clone)]
pub(crate) struct Track {
    time: Vec<f64>,
    rudder: Vec<f64>,
    /// Index into `heading` for every row that has one.
    seat: Vec<Option<usize>>,
    /// Heading of the observed rows, rad.
    pub heading: Vec<f64>,
}

/// The columns beside the constant one, at the observed rows.
#[derive(Debug, Clone, Default)]
pub(crate) struct Columns {
    /// φ₁(t − t₁), s.
    pub homogeneous: Vec<f64>,
    /// G, rad s².
    pub rudder: Vec<f64>,
    /// H, s².
    pub constant: Vec<f64>,
}

impl Columns {
    fn resize(&mut self, rows: usize) {
        for column in [&mut self.homogeneous, &mut self.rudder, &mut self.constant] {
            column.resize(rows, 0.0);
        }
    }
}

/// Coefficients of the four columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Coefficients {
    /// Heading (rad) and yaw rate (rad/s) at the anchor.
    pub anchor: State,
    /// b = K/T, 1/s².
    pub gain: f64,
    /// b δ_r, rad/s².
    pub offset: f64,
}

impl Coefficients {
    /// With the steering of a known response, and the anchor still to be found.
    pub fn of(response: &FirstOrder) -> Self {
        Self { anchor: State::default(), gain: response.K_over_T, offset: response.K_over_T * response.rudder_bias }
    }
}

/// Whether the anchor of the columns is the last row.
pub(crate) fn is_backward(inverse_time: f64) -> bool {
    inverse_time < 0.0
}

impl Track {
    /// Takes the part of a trial that has headings; the record must be excited and hold `needed` of them.
    pub fn new(trial: &Trial, needed: usize) -> Result<Self, IdentifyError> {
        // The checks are those of every method.
        Samples::new(trial, needed)?;
        Ok(Self::unchecked(trial))
    }

    /// Takes the part of a trial that has headings, without asking whether the ship was steered.
    pub fn unchecked(trial: &Trial) -> Self {
        let first = trial.observed_rows().next().unwrap_or(0);
        let last = trial.observed_rows().last().unwrap_or(0);
        let mut heading = Vec::with_capacity(last + 1 - first);
        let seat = trial.heading()[first..=last]
            .iter()
            .map(|&psi| {
                psi.is_finite().then(|| {
                    heading.push(psi);
                    heading.len() - 1
                })
            })
            .collect();
        Self { time: trial.time()[first..=last].to_vec(), rudder: trial.rudder()[first..=last].to_vec(), seat, heading }
    }

    /// About `rows` of the observed rows, evenly spread, the first included: enough to see where a minimum lies. The
    /// rudder between them is taken as linear, so its corners are cut.
    pub fn thinned(&self, rows: usize) -> Self {
        let every = (self.len() / rows).max(1);
        let kept: Vec<usize> = self.observed().step_by(every).collect();
        Self {
            time: kept.iter().map(|&row| self.time[row]).collect(),
            rudder: kept.iter().map(|&row| self.rudder[row]).collect(),
            seat: (0..kept.len()).map(Some).collect(),
            heading: self.heading.iter().copied().step_by(every).collect(),
        }
    }

    /// Number of observed rows.
    pub fn len(&self) -> usize {
        self.heading.len()
    }

    /// Time of every row, s.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// Length in time, s.
    pub fn duration(&self) -> f64 {
        self.time[self.time.len() - 1] - self.time[0]
    }

    /// Visits the rows from the anchor away: (row before, row, step).
    fn steps(&self, backward: bool) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let rows = self.time.len();
        (1..rows).map(move |k| {
            let (from, to) = if backward { (rows - k, rows - 1 - k) } else { (k - 1, k) };
            (from, to, self.time[to] - self.time[from])
        })
    }

    fn anchor_row(&self, backward: bool) -> usize {
        if backward { self.time.len() - 1 } else { 0 }
    }

    /// Fills the columns for a = `inverse_time`, 1/s.
    pub fn fill(&self, inverse_time: f64, columns: &mut Columns) {
        columns.resize(self.len());
        let backward = is_backward(inverse_time);
        let mut put = |row: usize, free: State, rudder: State, constant: State| {
            if let Some(seat) = self.seat[row] {
                columns.homogeneous[seat] = free.heading;
                columns.rudder[seat] = rudder.heading;
                columns.constant[seat] = constant.heading;
            }
        };
        let mut free = State { heading: 0.0, yaw_rate: 1.0 };
        let (mut rudder, mut constant) = (State::default(), State::default());
        put(self.anchor_row(backward), free, rudder, constant);
        let mut step = Transition::new(inverse_time, 0.0);
        for (from, to, h) in self.steps(backward) {
            if differs(step.h, h) {
                step = Transition::new(inverse_time, h);
            }
            free = step.advance(free, 0.0, 0.0);
            rudder = step.advance(rudder, self.rudder[from], (self.rudder[to] - self.rudder[from]) / h);
            constant = step.advance(constant, 1.0, 0.0);
            put(to, free, rudder, constant);
        }
    }

    /// ∂ψ/∂a at the observed rows for fixed coefficients, rad s.
    pub fn sensitivity(&self, inverse_time: f64, coefficients: &Coefficients, out: &mut Vec<f64>) {
        out.resize(self.len(), 0.0);
        let backward = is_backward(inverse_time);
        let (mut state, mut change) = (coefficients.anchor, State::default());
        if let Some(seat) = self.seat[self.anchor_row(backward)] {
            out[seat] = 0.0;
        }
        let mut step = TangentTransition::new(inverse_time, 0.0);
        for (from, to, h) in self.steps(backward) {
            if differs(step.value.h, h) {
                step = TangentTransition::new(inverse_time, h);
            }
            let u0 = coefficients.gain * self.rudder[from] + coefficients.offset;
            let slope = coefficients.gain * (self.rudder[to] - self.rudder[from]) / h;
            change = step.advance(state, change, u0, slope);
            state = step.value.advance(state, u0, slope);
            if let Some(seat) = self.seat[to] {
                out[seat] = change.heading;
            }
        }
    }

    /// Heading and yaw rate of every row (observed or not) for given coefficients.
    pub fn simulate(&self, inverse_time: f64, coefficients: &Coefficients) -> Vec<State> {
        let backward = is_backward(inverse_time);
        let mut states = vec![State::default(); self.time.len()];
        let mut state = coefficients.anchor;
        states[self.anchor_row(backward)] = state;
        let mut step = Transition::new(inverse_time, 0.0);
        for (from, to, h) in self.steps(backward) {
            if differs(step.h, h) {
                step = Transition::new(inverse_time, h);
            }
            let u0 = coefficients.gain * self.rudder[from] + coefficients.offset;
            let slope = coefficients.gain * (self.rudder[to] - self.rudder[from]) / h;
            state = step.advance(state, u0, slope);
            states[to] = state;
        }
        states
    }

    /// State at the last row for coefficients anchored at the first, stepping forward whatever the sign of a.
    pub fn last_state_from(&self, inverse_time: f64, coefficients: &Coefficients) -> State {
        self.steps(false).fold(coefficients.anchor, |state, (from, to, h)| {
            let u0 = coefficients.gain * self.rudder[from] + coefficients.offset;
            let slope = coefficients.gain * (self.rudder[to] - self.rudder[from]) / h;
            Transition::new(inverse_time, h).advance(state, u0, slope)
        })
    }

    /// Row of the track for every observed heading.
    pub fn observed(&self) -> impl Iterator<Item = usize> + '_ {
        self.seat.iter().enumerate().filter_map(|(row, seat)| seat.map(|_| row))
    }
}

fn differs(last: f64, h: f64) -> bool {
    (last - h).abs() > SAME_STEP * h.abs()
}
