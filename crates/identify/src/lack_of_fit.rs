//! Lack of fit of a first-order response: the share of the residual explained by terms of a larger ship model, compared
//! with random moments.
//!
//! The residual ψ − ψ̂ of the replay is regressed on the contributions of the terms of a larger model. To first order a
//! term f in the yaw equation r' = −r/T + (K/T)(δ + δ_r) + c f adds c s to the heading, with s'' = −s'/T + f. The terms
//! are r³, r|r|, r², δ³, |δ|, r'' and δ' (second order, lag and dead time), and r and δ times a filtered r² (loss of
//! speed). K, T, δ_r and the initial states of all records are estimated with them. Terms of a ship recur with every
//! rudder movement, random moments do not: nine terms explain nearly all of a missing ship term and part of a random
//! moment.
//!
//! The test is of first order in small terms and does not identify a term;
//! [`unexplained_share`](LackOfFit::unexplained_share) is compared with a limit from simulated trials. It is a score
//! test by linearised regression, Ljung (1999), System Identification: Theory for the User, chapter 16 on model
//! validation.

use estimation::column::dot;
use ship::FirstOrder;
use ship::first_order::{FirstOrderTransition, YawState};
use trial::plausibility::count_reversals;
use trial::{Trial, zigzag};

use crate::replay::{Replay, replay};
use crate::robust;

/// Half-width of the local fits that estimate the heading noise, in T, shorter than the bends of the heading.
const HALF_WIDTH: f64 = 0.25;

/// Time constant of the loss of speed, in T.
const SPEED_LAG: f64 = 3.0;

/// Number of terms of K, T and δ_r; the terms after them belong to larger models, δ' first.
const BASE_TERMS: usize = 3;

/// Minimum share of a pure delay in the reduction by all terms.
const MIN_DELAY_SHARE: f64 = 0.7;

/// Minimum number of rudder reversals that identify a delay: the effect of a single reversal, or of the execute of a
/// circle, may be a loss of speed as well.
const MIN_REVERSALS: usize = 2;

/// Maximum delay that is reported, in T: a single term in δ' represents short delays only, and delays of clocks,
/// steering gears and compasses are short.
const MAX_DELAY_RATIO: f64 = 0.25;

/// Minimum relative length of a column that is linearly independent of the basis.
const MIN_INDEPENDENT_SHARE: f64 = 1e-6;

/// Residual of the replays of a response, and its residual with the terms of a larger ship model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LackOfFit {
    /// Root mean square of the residual of all records, rad.
    pub residual_rms: f64,
    /// Root mean square of the residual with nine fitted ship terms, rad, corrected for their number.
    pub rms_with_ship_terms: f64,
    /// Standard deviation of the white noise of the heading, rad.
    pub noise_sd: f64,
    /// `true` if the correlation of neighbouring residuals is within the range of white noise.
    pub is_white: bool,
    /// Delay from the recorded to the acting rudder, s, from the term in δ' alone; negative for a rudder recorded late.
    pub delay: f64,
    /// Root mean square of the residual with the term in δ', rad; `None` if the records do not identify a delay:
    /// fewer than two rudder reversals in each, or a delay above a quarter of T.
    pub rms_with_delay: Option<f64>,
}

impl LackOfFit {
    /// Lack of fit of a response to its records; `None` without a record, if a replay is not finite, or for too few
    /// headings to estimate their noise.
    pub fn from_response(trials: &[Trial], response: &FirstOrder) -> Option<Self> {
        let (mut residual, mut pieces) = (Vec::new(), Vec::new());
        let mut terms: Vec<Vec<f64>> = Vec::new();
        let (mut noise, mut initial) = (0.0, 0);
        for trial in trials {
            let replayed = replay(trial, response)?;
            let record = RecordTerms::new(trial, &replayed, response);
            terms.resize(record.terms.len(), Vec::new());
            let half_width = (HALF_WIDTH * response.T().abs()).max(3.0 * trial.sampling_period());
            let sd = zigzag::noise_sd(trial.time(), trial.heading(), half_width)?;
            noise += sd * sd * record.residual.len() as f64;
            initial += record.initial;
            terms.iter_mut().zip(&record.terms).for_each(|(all, column)| all.extend(column));
            residual.extend(&record.residual);
            pieces.push(record.residual);
        }
        let rows = residual.len() as f64;
        let rms = |values: &[f64], free: usize| (dot(values, values) / (rows - free as f64).max(1.0)).sqrt();
        let before = rms(&residual, 0);
        let mut basis = Vec::new();
        let mut terms = terms.into_iter();
        terms.by_ref().take(BASE_TERMS).for_each(|column| extend(&mut basis, column));
        remove(&basis, &mut residual);
        // δ(t − τ) is δ − τ δ', so the coefficient of the column of δ' is −τ K/T.
        let mut turning = terms.as_slice().first()?.clone();
        remove(&basis, &mut turning);
        let size = dot(&turning, &residual) / dot(&turning, &turning);
        let delayed: Vec<f64> = residual.iter().zip(&turning).map(|(error, column)| error - size * column).collect();
        let delayed = rms(&delayed, basis.len() + 1 + initial);
        terms.for_each(|column| extend(&mut basis, column));
        remove(&basis, &mut residual);
        let after = rms(&residual, basis.len() + initial);
        let lag1 = robust::lag1_autocorrelation(pieces.iter().map(Vec::as_slice));
        let is_white = !robust::is_coloured(lag1, residual.len());
        // The final residual includes all of the noise; the local fits underestimate the bends of a coarse heading.
        let (noise_sd, delay) = ((noise / rows).sqrt().min(after), -size / response.K_over_T);
        let is_reversed = trials.iter().any(|trial| count_reversals(trial.rudder()) >= MIN_REVERSALS);
        let is_identified = is_reversed && delay.abs() <= MAX_DELAY_RATIO * response.T().abs();
        let rms_with_delay = is_identified.then_some(delayed);
        let lack = Self { residual_rms: before, rms_with_ship_terms: after, noise_sd, is_white, delay, rms_with_delay };
        (before.is_finite() && after.is_finite() && noise_sd.is_finite()).then_some(lack)
    }

    /// Share, from 0 to 1, of the residual beyond the noise that the ship terms do not explain: small for a missing
    /// term, large for random moments. `None` for a residual that is white or not larger than the noise.
    pub fn unexplained_share(&self) -> Option<f64> {
        let beyond = |rms: f64| (rms * rms - self.noise_sd * self.noise_sd).max(0.0);
        let all = beyond(self.residual_rms);
        (!self.is_white && all > 0.0).then(|| (beyond(self.rms_with_ship_terms) / all).sqrt().min(1.0))
    }

    /// [`delay`](Self::delay), s, if its term gives most of the reduction by all terms. `None` for a white residual, or
    /// if the records do not identify a delay.
    pub fn rudder_delay(&self) -> Option<f64> {
        let reduction = |rms: f64| self.residual_rms * self.residual_rms - rms * rms;
        let rms_with_delay = self.rms_with_delay.filter(|_| !self.is_white)?;
        (reduction(rms_with_delay) > MIN_DELAY_SHARE * reduction(self.rms_with_ship_terms)).then_some(self.delay)
    }
}

/// Residual and terms of one record at the rows with a heading, both projected off its initial state.
struct RecordTerms {
    residual: Vec<f64>,
    terms: Vec<Vec<f64>>,
    initial: usize,
}

impl RecordTerms {
    fn new(trial: &Trial, replayed: &Replay, response: &FirstOrder) -> Self {
        let FirstOrder { inverse_T: a, K_over_T: b, rudder_bias } = *response;
        let (time, r) = (&replayed.time[..], &replayed.yaw_rate[..]);
        let first = trial.observed_rows().next().unwrap_or(0);
        let rudder = &trial.rudder()[first..first + time.len()];
        let turning = slopes(time, rudder);
        let acceleration = |row: usize| -a * r[row] + b * (rudder[row] + rudder_bias);
        let speed = filtered_square(time, r, SPEED_LAG / a.abs());
        let inputs: [&dyn Fn(usize) -> f64; 12] = [
            &|row| r[row],
            &|row| rudder[row],
            &|_| 1.0,
            &|row| turning[row],
            &|row| r[row].powi(3),
            &|row| r[row] * r[row].abs(),
            &|row| r[row].powi(2),
            &|row| rudder[row].powi(3),
            &|row| rudder[row].abs(),
            &|row| -a * acceleration(row) + b * turning[row],
            &|row| speed[row] * r[row],
            &|row| speed[row] * rudder[row],
        ];
        let observed: Vec<usize> = (0..time.len()).filter(|&row| replayed.residual[row].is_finite()).collect();
        let at_observed = |column: Vec<f64>| -> Vec<f64> { observed.iter().map(|&row| column[row]).collect() };
        let mut basis = Vec::new();
        extend(&mut basis, vec![1.0; observed.len()]);
        extend(&mut basis, at_observed(headings(time, a, 1.0, |_| 0.0)));
        let without_initial = |mut column: Vec<f64>| {
            remove(&basis, &mut column);
            column
        };
        Self {
            terms: inputs.iter().map(|input| without_initial(at_observed(headings(time, a, 0.0, input)))).collect(),
            residual: without_initial(at_observed(replayed.residual.clone())),
            initial: basis.len(),
        }
    }
}

/// Heading ψ, rad, of ψ'' = −a ψ' + f from ψ = 0 and ψ' = `rate`, f in rad/s² and linear between rows. For a < 0 it is
/// computed backwards from the last row, where these conditions then apply, so that it does not grow.
fn headings(time: &[f64], a: f64, rate: f64, input: impl Fn(usize) -> f64) -> Vec<f64> {
    let rows = time.len();
    let place = |k: usize| if a < 0.0 { rows - 1 - k } else { k };
    let sign = if a < 0.0 { -1.0 } else { 1.0 };
    let mut state = YawState { heading: 0.0, yaw_rate: rate };
    let mut headings = vec![0.0; rows];
    let mut step = FirstOrderTransition::new(a.abs(), 0.0);
    for k in 1..rows {
        let (from, to) = (place(k - 1), place(k));
        let h = (time[to] - time[from]).abs();
        if h != step.time_step {
            step = FirstOrderTransition::new(a.abs(), h);
        }
        let (start, end) = (sign * input(from), sign * input(to));
        state = step.advance(state, start, (end - start) / h);
        headings[to] = sign * state.heading;
    }
    headings
}

/// Slope of a signal in every row: that of the chord between the rows before and after, and at an end that of the last
/// interval.
fn slopes(time: &[f64], values: &[f64]) -> Vec<f64> {
    let last = time.len() - 1;
    let slope = |from: usize, to: usize| (values[to] - values[from]) / (time[to] - time[from]);
    (0..=last).map(|row| slope(row.saturating_sub(1), (row + 1).min(last))).collect()
}

/// r² over its mean through a first-order filter of time constant `lag` (s), from 0 at the first row.
fn filtered_square(time: &[f64], r: &[f64], lag: f64) -> Vec<f64> {
    let mean = dot(r, r) / r.len() as f64;
    let mut filtered = vec![0.0; r.len()];
    for row in 1..r.len() {
        let share = 1.0 - (-(time[row] - time[row - 1]) / lag).exp();
        filtered[row] = filtered[row - 1] + share * (r[row - 1].powi(2) / mean - filtered[row - 1]);
    }
    filtered
}

/// Extends an orthonormal basis by the independent part of a column (Gram and Schmidt, twice).
fn extend(basis: &mut Vec<Vec<f64>>, mut column: Vec<f64>) {
    let length = dot(&column, &column).sqrt();
    remove(basis, &mut column);
    remove(basis, &mut column);
    let remaining_length = dot(&column, &column).sqrt();
    if remaining_length > MIN_INDEPENDENT_SHARE * length {
        column.iter_mut().for_each(|value| *value /= remaining_length);
        basis.push(column);
    }
}

/// Projects a column off an orthonormal basis, in place.
fn remove(basis: &[Vec<f64>], column: &mut [f64]) {
    for direction in basis {
        let size = dot(direction, column);
        column.iter_mut().zip(direction).for_each(|(value, component)| *value -= size * component);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identifier::Identifier;
    use crate::output_error;
    use crate::testing::{Case, record};

    #[test]
    fn an_exact_ship_leaves_noise_on_either_side_of_neutral() {
        for time_constant in [16.3, -40.0] {
            let case = Case { T: time_constant, K: 0.1 * time_constant.signum(), noise_deg: 0.1, ..Case::default() };
            let lack = LackOfFit::from_response(&[case.trial()], &case.ship()).expect("a zig-zag");
            assert!(lack.is_white && lack.unexplained_share().is_none(), "{lack:?}");
            assert!((lack.residual_rms / lack.noise_sd - 1.0).abs() < 0.2, "{lack:?}");
        }
    }

    /// Delays above a quarter of T are not reported.
    #[test]
    fn a_rudder_at_another_time_is_seen() {
        for delay in [-3.0, -2.0, 2.0, 3.0, 14.0] {
            let case = Case { T: 40.0, K: 0.05, noise_deg: 0.1, ..Case::default() };
            let sound = case.trial();
            let (time, rudder) = (sound.time(), sound.rudder_signal());
            let moved = time.iter().map(|t| rudder.value_at(t + delay)).collect();
            let trials = [record("moved", time.to_vec(), sound.heading().to_vec(), moved)];
            let method = output_error::Settings::default().build().expect("default settings");
            let answer = method.identify(&trials).expect("an answer");
            let lack = LackOfFit::from_response(&trials, &answer.response).expect("a zig-zag");
            let reported_delay = lack.rudder_delay();
            let is_right = reported_delay.is_some_and(|reported| (reported / delay - 1.0).abs() < 0.2);
            assert!(is_right || reported_delay.is_none() && delay > 10.0, "{delay} s: {lack:?}");
        }
    }

    /// An error of 2 % in K is not explained by ship terms, because K is free.
    #[test]
    fn what_k_and_t_explain_is_no_lack() {
        let case = Case { noise_deg: 0.01, ..Case::default() };
        let off = FirstOrder { K_over_T: 1.02 * case.ship().K_over_T, ..case.ship() };
        let lack = LackOfFit::from_response(&[case.trial()], &off).expect("a zig-zag");
        assert!(lack.residual_rms > 10.0 * lack.noise_sd && lack.rms_with_ship_terms < 1.2 * lack.noise_sd, "{lack:?}");
    }
}
