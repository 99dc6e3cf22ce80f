//! First-order heading of one trial as a linear combination of four columns for a given 1/T.
//!
//! ψ = ψ₁ · 1 + r₁ · φ₁(t − t₁) + b · G(t; a) + b δ_r · H(t; a), with G the response to the recorded rudder and H the
//! response to a constant, both from rest at the anchor t₁. For a ≥ 0 the anchor is the first row; for a < 0 it is the
//! last row and the columns are stepped backwards in time, so that no column grows exponentially for either sign of T
//! and the columns stay as independent as the record allows. This module fills the columns and their derivatives with
//! respect to a; it does not choose parameters. Source of the model: Nomoto, Taguchi, Honda and Hirano (1957), On the
//! steering qualities of ships.

use ship::FirstOrder;
use ship::first_order::{FirstOrderTransition, TangentTransition, YawState};
use trial::Trial;

pub use super::columns::MotionColumns;
use super::columns::keep;

/// Relative tolerance of equal step durations: far below the resolution of a clock.
const STEP_TOLERANCE: f64 = 1e-9;

/// Rudder, heading and yaw rate of one trial, from the first to the last row with a heading.
#[derive(Debug, Clone)]
pub struct TrialSignals {
    /// Time of every row, s.
    pub time: Vec<f64>,
    /// Rudder of every row, rad.
    pub rudder: Vec<f64>,
    /// Intervals between successive rows.
    intervals: Vec<Interval>,
    /// Corners of the rudder between rows, in order.
    corners: Vec<CornerAfterRow>,
    /// Rows that have a heading, in order.
    pub heading_rows: Vec<usize>,
    /// Heading of these rows, rad.
    pub heading: Vec<f64>,
    /// Rows with a used yaw rate, in order.
    pub yaw_rate_rows: Vec<usize>,
    /// Yaw rate of these rows, rad/s.
    pub yaw_rates: Vec<f64>,
}

/// Interval between two rows.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Interval {
    /// Duration, s.
    duration: f64,
    /// Rudder rate at the beginning of the interval, rad/s.
    rudder_rate: f64,
}

/// Corner of the rudder between a row and the next.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CornerAfterRow {
    row: usize,
    /// Time from the row to the corner, s.
    after: f64,
    /// Rudder rate after the corner, rad/s.
    rudder_rate: f64,
}

/// Step from one row to the next, in either direction of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignalStep {
    /// Row before the step.
    pub from_row: usize,
    /// Row after the step.
    pub to_row: usize,
    /// Signed duration, s.
    pub duration: f64,
    /// Rudder rate at the beginning of the step, rad/s.
    pub rudder_rate: f64,
    /// Corner of the rudder within the step; `None` for a rudder that is linear over the step.
    pub corner: Option<RudderCorner>,
}

/// Change of the rudder rate between two rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RudderCorner {
    /// Signed time from the change to the end of the step, s.
    pub remaining: f64,
    /// Change of the rate, rad/s.
    pub change: f64,
}

impl RudderCorner {
    /// Contribution of the corner to heading and yaw rate at the end of the step, divided by b = K/T: [φ₃ Δ, φ₂ Δ] in
    /// rad s² and rad s, with the change Δ of the rudder rate and φₙ of [`FirstOrderTransition`]. `inverse_T` is 1/T,
    /// 1/s.
    #[inline]
    pub fn response(&self, inverse_T: f64) -> [f64; 2] {
        let step = FirstOrderTransition::new(inverse_T, self.remaining);
        [step.phi3 * self.change, step.phi2 * self.change]
    }
}

/// Coefficients of the columns of the response: the initial state, the rudder and the constant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionCoefficients {
    /// Heading (rad) and yaw rate (rad/s) at the anchor.
    pub anchor: YawState,
    /// b = K/T, 1/s².
    pub K_over_T: f64,
    /// b δ_r, rad/s².
    pub offset: f64,
}

impl MotionCoefficients {
    /// Coefficients with the steering of a response and an anchor at rest.
    pub fn from_response(response: &FirstOrder) -> Self {
        Self {
            anchor: YawState::default(),
            K_over_T: response.K_over_T,
            offset: response.K_over_T * response.rudder_bias,
        }
    }
}

/// `true` if the anchor of the columns is the last row.
pub fn is_backward(inverse_T: f64) -> bool {
    inverse_T < 0.0
}

impl TrialSignals {
    /// Signals of a trial from its first to its last row with a heading; excitation is not checked.
    pub fn new(trial: &Trial) -> Self {
        let first = trial.observed_rows().next().unwrap_or(0);
        let last = trial.observed_rows().last().unwrap_or(0);
        let heading = &trial.heading()[first..=last];
        let heading_rows: Vec<usize> = (0..heading.len()).filter(|&row| heading[row].is_finite()).collect();
        let heading = heading_rows.iter().map(|&row| heading[row]).collect();
        let time = trial.time();
        let [times, rudder] = [time, trial.rudder()].map(|column| column[first..=last].to_vec());
        let mut signals = Self::from_rows(times, rudder, heading_rows, heading);
        for corner in trial.rudder_corners().iter().filter(|corner| (first..last).contains(&corner.row_before)) {
            let row = corner.row_before - first;
            signals.intervals[row].rudder_rate = corner.rate_before;
            let (after, rudder_rate) = (corner.time - time[corner.row_before], corner.rate_after);
            signals.corners.push(CornerAfterRow { row, after, rudder_rate });
        }
        signals
    }

    fn from_rows(time: Vec<f64>, rudder: Vec<f64>, heading_rows: Vec<usize>, heading: Vec<f64>) -> Self {
        let interval = |(t, delta): (&[f64], &[f64])| {
            let duration = t[1] - t[0];
            Interval { duration, rudder_rate: (delta[1] - delta[0]) / duration }
        };
        let intervals = time.windows(2).zip(rudder.windows(2)).map(interval).collect();
        let (corners, yaw_rate_rows, yaw_rates) = (Vec::new(), Vec::new(), Vec::new());
        Self { time, rudder, intervals, corners, heading_rows, heading, yaw_rate_rows, yaw_rates }
    }

    /// Signals with the yaw rates of the trial; without `rates` they are left out.
    pub fn with_rates(mut self, rates: Option<&[f64]>, trial: &Trial) -> Self {
        let first = trial.observed_rows().next().unwrap_or(0);
        let rates = rates.map_or(&[][..], |rates| &rates[first..][..self.time.len()]);
        self.yaw_rate_rows = (0..rates.len()).filter(|&row| rates[row].is_finite()).collect();
        self.yaw_rates = self.yaw_rate_rows.iter().map(|&row| rates[row]).collect();
        self
    }

    /// Signals without the headings of the given rows.
    pub fn without_headings(&self, headings: &[usize]) -> Self {
        let mut less = self.clone();
        less.heading_rows.retain(|row| !headings.contains(row));
        less.heading = self
            .heading_rows
            .iter()
            .zip(&self.heading)
            .filter(|(row, _)| !headings.contains(row))
            .map(|(_, &psi)| psi)
            .collect();
        less
    }

    /// Signals thinned to about `rows` observed rows, evenly spread, the first included: enough to locate a minimum.
    /// The rudder between them is linear, so its corners are cut.
    pub fn thinned(&self, rows: usize) -> Self {
        let every = (self.len() / rows).max(1);
        let kept = || self.heading_rows.iter().step_by(every);
        let column = |values: &[f64]| kept().map(|&row| values[row]).collect::<Vec<f64>>();
        let heading: Vec<f64> = self.heading.iter().copied().step_by(every).collect();
        Self::from_rows(column(&self.time), column(&self.rudder), (0..heading.len()).collect(), heading)
    }

    /// Number of observed rows.
    pub fn len(&self) -> usize {
        self.heading.len()
    }

    /// `true` if no row has a heading.
    pub fn is_empty(&self) -> bool {
        self.heading.is_empty()
    }

    /// Duration of the record, s.
    pub fn duration(&self) -> f64 {
        self.time[self.time.len() - 1] - self.time[0]
    }

    /// Steps between successive rows, away from the anchor, which is the last row if `backward`.
    #[inline(always)]
    pub fn steps(&self, backward: bool) -> impl Iterator<Item = SignalStep> {
        let (rows, count) = (self.intervals.len(), self.corners.len());
        let corner_at = move |passed: usize| {
            (passed < count).then(|| self.corners[if backward { count - 1 - passed } else { passed }])
        };
        let (mut passed, mut next) = (0, corner_at(0));
        (0..rows).map(move |k| {
            let row = if backward { rows - 1 - k } else { k };
            let Interval { duration, rudder_rate } = self.intervals[row];
            let corner_after_row = next.filter(|corner| corner.row == row);
            if corner_after_row.is_some() {
                passed += 1;
                next = corner_at(passed);
            }
            if backward {
                let corner =
                    corner_after_row.map(|c| RudderCorner { remaining: -c.after, change: rudder_rate - c.rudder_rate });
                let rudder_rate = corner_after_row.map_or(rudder_rate, |corner| corner.rudder_rate);
                SignalStep { from_row: row + 1, to_row: row, duration: -duration, rudder_rate, corner }
            } else {
                let corner = corner_after_row
                    .map(|c| RudderCorner { remaining: duration - c.after, change: c.rudder_rate - rudder_rate });
                SignalStep { from_row: row, to_row: row + 1, duration, rudder_rate, corner }
            }
        })
    }

    pub(super) fn anchor_row(&self, backward: bool) -> usize {
        if backward { self.time.len() - 1 } else { 0 }
    }

    /// Fills the columns for a = `inverse_T`, 1/s.
    pub fn fill_columns(&self, inverse_T: f64, columns: &mut MotionColumns) {
        self.fill_from(is_backward(inverse_T), inverse_T, columns);
    }

    /// Fills the columns with the anchor at the last row, or at the first, for either sign of a.
    pub fn fill_from(&self, backward: bool, inverse_T: f64, columns: &mut MotionColumns) {
        let (rows, anchor) = (self.time.len(), self.anchor_row(backward));
        let MotionColumns { homogeneous, rudder, constant, rates } = columns;
        for column in [&mut *homogeneous, rudder, constant] {
            column.resize(rows, 0.0);
            column[anchor] = 0.0;
        }
        let (f, g, h) = (&mut homogeneous[..rows], &mut rudder[..rows], &mut constant[..rows]);
        if self.yaw_rate_rows.is_empty() {
            self.motions(inverse_T, backward, |row, heading, _| {
                [f[row], g[row], h[row], _] = heading;
            });
        } else {
            for (column, start) in [(&mut rates.homogeneous, 1.0), (&mut rates.rudder, 0.0), (&mut rates.constant, 0.0)]
            {
                column.resize(rows, 0.0);
                column[anchor] = start;
            }
            self.motions(inverse_T, backward, |row, heading, rate| {
                [f[row], g[row], h[row], _] = heading;
                [rates.homogeneous[row], rates.rudder[row], rates.constant[row], _] = rate;
            });
            for column in [&mut rates.homogeneous, &mut rates.rudder, &mut rates.constant] {
                keep(&self.yaw_rate_rows, column);
            }
        }
        for column in [homogeneous, rudder, constant] {
            keep(&self.heading_rows, column);
        }
    }

    /// Visits heading and yaw rate of the three motions φ₁, G, H (and a fourth at rest, for alignment) at every row but
    /// the anchor.
    #[inline(always)]
    fn motions(&self, inverse_T: f64, backward: bool, mut visit: impl FnMut(usize, [f64; 4], [f64; 4])) {
        let (mut heading, mut yaw_rate) = ([0.0; 4], [1.0, 0.0, 0.0, 0.0]);
        let mut step = FirstOrderTransition::new(inverse_T, 0.0);
        for SignalStep { from_row, to_row, duration, rudder_rate: rate, corner } in self.steps(backward) {
            if durations_differ(step.time_step, duration) {
                step = FirstOrderTransition::new(inverse_T, duration);
            }
            let delta = self.rudder[from_row];
            let of_heading = [0.0, step.phi2 * delta + step.phi3 * rate, step.phi2, 0.0];
            let of_rate = [0.0, step.phi1 * delta + step.phi2 * rate, step.phi1, 0.0];
            for motion in 0..4 {
                heading[motion] += step.phi1 * yaw_rate[motion] + of_heading[motion];
                yaw_rate[motion] = step.decay * yaw_rate[motion] + of_rate[motion];
            }
            if let Some(corner) = corner {
                let [more_heading, more_rate] = corner.response(inverse_T);
                heading[1] += more_heading;
                yaw_rate[1] += more_rate;
            }
            visit(to_row, heading, yaw_rate);
        }
    }

    /// ∂ψ/∂a at the observed rows for fixed coefficients, rad s.
    pub fn sensitivity(&self, inverse_T: f64, coefficients: &MotionCoefficients, out: &mut Vec<f64>) {
        out.resize(self.time.len(), 0.0);
        out[self.anchor_row(is_backward(inverse_T))] = 0.0;
        let column = &mut out[..self.time.len()];
        self.tangents(inverse_T, coefficients, |row, by_heading| column[row] = by_heading);
        keep(&self.heading_rows, out);
    }

    /// Visits ∂ψ/∂a at every row but the anchor.
    #[inline(always)]
    fn tangents(&self, inverse_T: f64, coefficients: &MotionCoefficients, mut visit: impl FnMut(usize, f64)) {
        let backward = is_backward(inverse_T);
        let anchor = coefficients.anchor;
        // Derivative of the motion, and the motion.
        let (mut heading, mut yaw_rate) = ([0.0, anchor.heading], [0.0, anchor.yaw_rate]);
        let mut step = TangentTransition::new(inverse_T, 0.0);
        for SignalStep { from_row, to_row, duration, rudder_rate: rate, corner } in self.steps(backward) {
            if durations_differ(step.value.time_step, duration) {
                step = TangentTransition::new(inverse_T, duration);
            }
            let (f, d) = (&step.value, &step.by_inverse_T);
            let u0 = coefficients.K_over_T * self.rudder[from_row] + coefficients.offset;
            let slope = coefficients.K_over_T * rate;
            let r = yaw_rate[1];
            let of_heading = [d.phi1 * r + (d.phi2 * u0 + d.phi3 * slope), f.phi2 * u0 + f.phi3 * slope];
            let of_rate = [d.decay * r + (d.phi1 * u0 + d.phi2 * slope), f.phi1 * u0 + f.phi2 * slope];
            for motion in 0..2 {
                heading[motion] += f.phi1 * yaw_rate[motion] + of_heading[motion];
                yaw_rate[motion] = f.decay * yaw_rate[motion] + of_rate[motion];
            }
            if let Some(RudderCorner { remaining, change }) = corner {
                let TangentTransition { value, by_inverse_T } = TangentTransition::new(inverse_T, remaining);
                let change = coefficients.K_over_T * change;
                for (motion, part) in [by_inverse_T.phi3, value.phi3].into_iter().enumerate() {
                    heading[motion] += part * change;
                }
                for (motion, part) in [by_inverse_T.phi2, value.phi2].into_iter().enumerate() {
                    yaw_rate[motion] += part * change;
                }
            }
            visit(to_row, heading[0]);
        }
    }

    /// Heading and yaw rate of every row (observed or not) for given coefficients.
    pub fn simulate(&self, inverse_T: f64, coefficients: &MotionCoefficients) -> Vec<YawState> {
        let mut states = vec![YawState::default(); self.time.len()];
        self.simulate_from(is_backward(inverse_T), inverse_T, coefficients, |row, state| states[row] = state);
        states
    }

    /// State at the last row for coefficients anchored at the first, stepping forward whatever the sign of a.
    pub fn last_state_from(&self, inverse_T: f64, coefficients: &MotionCoefficients) -> YawState {
        let mut last = coefficients.anchor;
        self.simulate_from(false, inverse_T, coefficients, |_, state| last = state);
        last
    }

    fn simulate_from(
        &self,
        backward: bool,
        inverse_T: f64,
        coefficients: &MotionCoefficients,
        mut visit: impl FnMut(usize, YawState),
    ) {
        let mut state = coefficients.anchor;
        visit(self.anchor_row(backward), state);
        let mut step = FirstOrderTransition::new(inverse_T, 0.0);
        for SignalStep { from_row, to_row, duration, rudder_rate, corner } in self.steps(backward) {
            if durations_differ(step.time_step, duration) {
                step = FirstOrderTransition::new(inverse_T, duration);
            }
            let u0 = coefficients.K_over_T * self.rudder[from_row] + coefficients.offset;
            state = step.advance(state, u0, coefficients.K_over_T * rudder_rate);
            if let Some(corner) = corner {
                let [heading, yaw_rate] = corner.response(inverse_T);
                state.heading += coefficients.K_over_T * heading;
                state.yaw_rate += coefficients.K_over_T * yaw_rate;
            }
            visit(to_row, state);
        }
    }
}

/// `true` if two durations, s, differ so much that the transition must be computed again.
#[inline(always)]
pub fn durations_differ(last: f64, h: f64) -> bool {
    (last - h).abs() > STEP_TOLERANCE * h.abs()
}
