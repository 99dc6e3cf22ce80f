//! Objective of the fit of a hull: replays of the rudder over whole records and over windows, in which heading and yaw
//! rate at the start are fitted while speed and sway run on; and the speed, if it was recorded.

use estimation::levenberg_marquardt::{NormalEquations, Objective};
use estimation::number::{Dual, Real};
use nalgebra::{DMatrix, DVector};
use ship::angle::DEGREE;
use ship::vessel::prime::PrimeHull;

use super::form_prior::HullFormPrior;
use super::replayed::{ReplayedWindow, replay_rows, replay_rows_in_lanes};
use super::track::HullSignals;
use super::turn::HardTurn;

/// Number of derivatives: with respect to the 25 coefficients of the largest form, and to the yaw rate at the start.
const DIRECTIONS: usize = 26;

/// Maximum number of steps of the search for the initial yaw rate of a window.
const STEPS: usize = 3;

/// Shares of a step of that search that are tried in turn.
const STEP_SHARES: [f64; 4] = [1.0, 0.4, 0.16, 0.06];

/// Minimum relative gain of a step; below it that search ends.
const MIN_GAIN: f64 = 1e-6;

/// Standard deviations of the residuals of a hull, which weight the kinds of reading: even the best form leaves an
/// error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResidualDeviations {
    /// Standard deviation of the heading of a whole replay, rad.
    pub whole_heading: f64,
    /// Standard deviation of the heading in a window, rad.
    pub window_heading: f64,
    /// Standard deviation of the speed, in units of U₀.
    pub speed: f64,
}

/// Minimum deviations of a record.
const MIN_DEVIATIONS: ResidualDeviations =
    ResidualDeviations { whole_heading: 1.0 * DEGREE, window_heading: 0.2 * DEGREE, speed: 0.1 };

/// Deviations at the start of a search, so large that the hull stays near its prior.
const FIRST_DEVIATIONS: ResidualDeviations =
    ResidualDeviations { whole_heading: 3.0 * DEGREE, window_heading: 1.0 * DEGREE, speed: 0.3 };

/// Mean square residuals of a record (headings in rad², speed in units of U₀²), and the initial yaw rate of the whole
/// replay, U₀/L.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Misfit {
    pub whole_heading: f64,
    pub window_heading: f64,
    pub speed: f64,
    pub initial_yaw_rate: f64,
}

/// Yaw rates at the start of a record and of its windows, U₀/L, kept between evaluations.
#[derive(Debug, Clone)]
struct Starts {
    whole: [f64; 1],
    windows: Vec<f64>,
}

/// Objective of the fit of a form with its priors to records.
pub(super) struct HullObjective<'a> {
    prior: &'a HullFormPrior,
    hull_signals: &'a [HullSignals],
    deviations: Vec<ResidualDeviations>,
    starts: Vec<Starts>,
    /// `true` once the starts have been fitted.
    is_begun: bool,
    turn: HardTurn,
}

/// Replay of a window: sum of squares of the heading residuals, and the best step of the initial yaw rate.
struct WindowFit {
    square: f64,
    step: f64,
    /// (u, v, r) after the window.
    end: [f64; 3],
    /// (ψ, u, v) in every row.
    rows: Vec<[f64; 3]>,
    /// Number of headings.
    read: usize,
}

fn window(
    hull: &PrimeHull<Dual<1>>,
    signals: &HullSignals,
    ends: [usize; 2],
    [u, v]: [f64; 2],
    rate: f64,
) -> WindowFit {
    let start = [Dual::from(u), Dual::from(v), Dual::variable(rate, 0, 1.0)];
    let ReplayedWindow { rows, end } = replay_rows(hull, signals, ends, start);
    let pairs = || {
        let measured = &signals.heading[ends[0]..ends[1]];
        measured.iter().zip(&rows).filter(|(measured, _)| measured.is_finite())
    };
    let read = pairs().count();
    let mean = |term: fn((&f64, &[Dual<1>; 3])) -> f64| pairs().map(term).sum::<f64>() / read.max(1) as f64;
    let [offset, slope] = [mean(|(measured, row)| measured - row[0].value), mean(|(_, row)| row[0].derivatives[0])];
    let (mut square, mut cross, mut slope_square) = (0.0, 0.0, 0.0);
    for (measured, row) in pairs() {
        let (error, by) = (measured - row[0].value - offset, row[0].derivatives[0] - slope);
        square += error * error;
        cross += error * by;
        slope_square += by * by;
    }
    let values = |state: [Dual<1>; 3]| state.map(|component| component.value);
    let step = if slope_square > 0.0 { cross / slope_square } else { 0.0 };
    WindowFit { square, step, end: values(end), rows: rows.into_iter().map(values).collect(), read }
}

/// Replay of a window from the best initial yaw rate, which is returned in `rate`.
fn window_from_best_rate(
    hull: &PrimeHull<Dual<1>>,
    signals: &HullSignals,
    ends: [usize; 2],
    start: [f64; 2],
    rate: &mut f64,
) -> WindowFit {
    let mut now = window(hull, signals, ends, start, *rate);
    for _ in 0..STEPS {
        let tried = STEP_SHARES.iter().find_map(|share| {
            let ahead = *rate + share * now.step;
            let next = window(hull, signals, ends, start, ahead);
            (next.square < now.square).then_some((ahead, next))
        });
        let Some((ahead, next)) = tried else { break };
        let is_enough = now.square - next.square < MIN_GAIN * now.square;
        (*rate, now) = (ahead, next);
        if is_enough {
            break;
        }
    }
    now
}

/// Replays all windows of a record, each from its best yaw rate; calls `visit` with every window. Unless `is_begun`,
/// the search of a window starts at the yaw rate at the end of the window before.
fn replay_windows(
    hull: &PrimeHull<Dual<1>>,
    signals: &HullSignals,
    window_bounds: &[usize],
    rates: &mut [f64],
    is_begun: bool,
    mut visit: impl FnMut(&WindowFit),
) {
    let mut start = signals.initial_velocity;
    let mut before = rates[0];
    for (ends, rate) in window_bounds.windows(2).zip(rates) {
        if !is_begun {
            *rate = before;
        }
        let replay = window_from_best_rate(hull, signals, [ends[0], ends[1]], start, rate);
        start = [replay.end[0], replay.end[1]];
        before = replay.end[2];
        visit(&replay);
    }
}

/// Mean square heading residual of the windows of a record, rad², each from its best initial yaw rate. `rates` (U₀/L)
/// returns these yaw rates; if `is_begun`, the search starts at its values.
pub(super) fn window_mean_square(
    hull: &PrimeHull<Dual<1>>,
    signals: &HullSignals,
    rates: &mut [f64],
    is_begun: bool,
) -> f64 {
    let (mut square, mut read) = (0.0, 0);
    replay_windows(hull, signals, &signals.window_bounds, rates, is_begun, |replay| {
        (square, read) = (square + replay.square, read + replay.read);
    });
    square / read.max(1) as f64
}

impl<'a> HullObjective<'a> {
    pub fn new(prior: &'a HullFormPrior, hull_signals: &'a [HullSignals]) -> Self {
        assert!(prior.coefficients.len() < DIRECTIONS, "a form has fewer than {DIRECTIONS} coefficients");
        let starts =
            |signals: &HullSignals| Starts { whole: [0.0], windows: vec![0.0; signals.window_bounds.len() - 1] };
        let starts = hull_signals.iter().map(starts).collect();
        let deviations = vec![FIRST_DEVIATIONS; hull_signals.len()];
        Self { prior, hull_signals, deviations, starts, is_begun: false, turn: HardTurn::new() }
    }

    /// Mean square residuals of every record; `None` if the coefficients are not valid.
    pub fn misfits(&mut self, at: &[f64]) -> Option<Vec<Misfit>> {
        let values: Vec<Dual<1>> = at.iter().map(|&value| Dual::from(value)).collect();
        let hull = self.prior.form.with_coefficients(&values)?;
        let is_begun = std::mem::replace(&mut self.is_begun, true);
        let misfit = |(signals, starts): (&HullSignals, &mut Starts)| {
            let mut misfit = Misfit::default();
            replay_windows(&hull, signals, &signals.whole_record, &mut starts.whole, is_begun, |replay| {
                misfit.whole_heading = replay.square / replay.read.max(1) as f64;
                let pairs = signals.speed.iter().flatten().zip(&replay.rows);
                let squares = pairs.map(|(measured, row)| (measured - row[1].hypot(row[2])).powi(2));
                misfit.speed = squares.sum::<f64>() / replay.rows.len() as f64;
            });
            misfit.initial_yaw_rate = starts.whole[0];
            misfit.window_heading = window_mean_square(&hull, signals, &mut starts.windows, is_begun);
            misfit
        };
        Some(self.hull_signals.iter().zip(&mut self.starts).map(misfit).collect())
    }

    /// Sets the deviations of every record to its residuals, but not below [`MIN_DEVIATIONS`].
    pub fn reweigh(&mut self, at: &[f64]) {
        let misfits = self.misfits(at).unwrap_or_default();
        for (deviations, misfit) in self.deviations.iter_mut().zip(misfits) {
            *deviations = ResidualDeviations {
                whole_heading: MIN_DEVIATIONS.whole_heading.max(misfit.whole_heading.sqrt()),
                window_heading: MIN_DEVIATIONS.window_heading.max(misfit.window_heading.sqrt()),
                speed: MIN_DEVIATIONS.speed.max(misfit.speed.sqrt()),
            };
        }
    }

    /// Weight of a record: its length in L/U₀ over the number of records. The error of the form is independent from
    /// ship length to ship length, but common to records of similar manoeuvres.
    fn weight(&self, signals: &HullSignals) -> f64 {
        signals.duration() / self.hull_signals.len() as f64
    }

    /// Value (θ − μ)ᵀ Λ (θ − μ) of the prior, preceded by Λ (μ − θ), half its negative gradient.
    fn prior_terms(&self, at: &[f64]) -> (DVector<f64>, f64) {
        let departure = self.prior.mean() - DVector::from_column_slice(at);
        let pull = &self.prior.precision * &departure;
        let square = pull.dot(&departure);
        (pull, square)
    }
}

impl Objective for HullObjective<'_> {
    fn bounds(&self, unknown: usize) -> [f64; 2] {
        self.prior.coefficients[unknown].bounds
    }

    /// Σ over records of their weights times mean squares over variances, the priors, and the turn with the rudder hard
    /// over.
    fn value(&mut self, at: &[f64]) -> f64 {
        let (Some(misfits), Some(hull)) = (self.misfits(at), self.prior.form.with_coefficients(at)) else {
            return f64::INFINITY;
        };
        let record_term = |((signals, misfit), deviations): ((&HullSignals, Misfit), &ResidualDeviations)| {
            let ResidualDeviations { whole_heading: whole, window_heading: window, speed } = *deviations;
            let share = |square: f64, deviation: f64| square / (deviation * deviation);
            let headings = share(misfit.whole_heading, whole) + share(misfit.window_heading, window);
            self.weight(signals) * (headings + share(misfit.speed, speed))
        };
        self.prior_terms(at).1
            + self.turn.departures(&hull).iter().map(|departure| departure.powi(2)).sum::<f64>()
            + self.hull_signals.iter().zip(misfits).zip(&self.deviations).map(record_term).sum::<f64>()
    }

    fn linearise(&mut self, at: &[f64], normal: &mut NormalEquations) -> f64 {
        let value = self.value(at);
        *normal = NormalEquations { matrix: self.prior.precision.clone(), right_hand_side: self.prior_terms(at).0 };
        let values: Vec<Dual<DIRECTIONS>> =
            at.iter().enumerate().map(|(place, &value)| Dual::variable(value, place, 1.0)).collect();
        let Some(hull) = self.prior.form.with_coefficients(&values) else { return f64::INFINITY };
        for departure in self.turn.departures(&hull) {
            let by = DVector::from_column_slice(&departure.derivatives[..at.len()]);
            normal.matrix.ger(1.0, &by, &by, 1.0);
            normal.right_hand_side.axpy(-departure.value, &by, 1.0);
        }
        for ((signals, starts), deviations) in self.hull_signals.iter().zip(&self.starts).zip(&self.deviations) {
            let ResidualDeviations { whole_heading: whole, window_heading: window, speed } = *deviations;
            let lengths = self.weight(signals);
            let read = signals.heading.iter().filter(|heading| heading.is_finite()).count() as f64;
            let weight = |deviation: f64, rows: f64| lengths / (rows * deviation * deviation);
            let speed_weight = Some(weight(speed, signals.time.len() as f64));
            add(normal, &hull, signals, &signals.whole_record, &starts.whole, weight(whole, read), speed_weight);
            add(normal, &hull, signals, &signals.window_bounds, &starts.windows, weight(window, read), None);
        }
        value
    }
}

/// Adds the normal equations of the windows of a record; `weight` is the weight of a heading and `speed_weight` of a
/// speed, `None` without speeds.
fn add(
    normal: &mut NormalEquations,
    hull: &PrimeHull<Dual<DIRECTIONS>>,
    signals: &HullSignals,
    window_bounds: &[usize],
    rates: &[f64],
    weight: f64,
    speed_weight: Option<f64>,
) {
    let unknowns = normal.right_hand_side.len();
    let mut start = signals.initial_velocity.map(Dual::from);
    for (ends, &rate) in window_bounds.windows(2).zip(rates) {
        // Surge and sway at this start do not depend on its yaw rate.
        start.iter_mut().for_each(|velocity| velocity.derivatives[unknowns] = 0.0);
        let variable = Dual::variable(rate, unknowns, 1.0);
        let ReplayedWindow { rows, end } =
            replay_rows_in_lanes(hull, signals, [ends[0], ends[1]], [start[0], start[1], variable]);
        start = [end[0], end[1]];
        let (columns, shares) = heading_columns(&rows, &signals.heading[ends[0]..ends[1]], unknowns);
        add_squares(normal, &columns, unknowns + 1, weight);
        let Some((weight, measured)) = speed_weight.zip(signals.speed.as_ref()) else { continue };
        let mut columns = DMatrix::zeros(rows.len(), unknowns + 2);
        for (i, [_, u, v]) in rows.iter().enumerate() {
            let replayed_speed = u.hypot(*v);
            for (j, share) in shares[..unknowns].iter().enumerate() {
                columns[(i, j)] = replayed_speed.derivatives[j] - share * replayed_speed.derivatives[unknowns];
            }
            columns[(i, unknowns + 1)] = measured[ends[0] + i] - replayed_speed.value;
        }
        add_squares(normal, &columns, unknowns + 1, weight);
    }
}

/// Derivatives of the replayed headings, in the rows with a recorded heading, with respect to the coefficients, at the
/// best initial heading and yaw rate; the last column holds the residuals, the column before it the derivatives with
/// respect to the initial yaw rate. Also returns the derivatives of the best initial yaw rate.
fn heading_columns(rows: &[[Dual<DIRECTIONS>; 3]], measured: &[f64], unknowns: usize) -> (DMatrix<f64>, Vec<f64>) {
    let read: Vec<usize> = (0..rows.len()).filter(|&row| measured[row].is_finite()).collect();
    let heading = |i: usize, j: usize| {
        let replayed_heading = &rows[read[i]][0];
        if j > unknowns { measured[read[i]] - replayed_heading.value } else { replayed_heading.derivatives[j] }
    };
    let mut columns = DMatrix::from_fn(read.len(), unknowns + 2, heading);
    for mut column in columns.column_iter_mut() {
        let mean = column.mean();
        column.add_scalar_mut(-mean);
    }
    let by_rate = columns.column(unknowns).clone_owned();
    let square = by_rate.norm_squared();
    let shares: Vec<f64> =
        columns.column_iter().map(|column| if square > 0.0 { column.dot(&by_rate) / square } else { 0.0 }).collect();
    for (place, share) in shares.iter().enumerate().filter(|(place, _)| *place != unknowns) {
        columns.column_mut(place).axpy(-share, &by_rate, 1.0);
    }
    (columns, shares)
}

/// Times, in L/U₀, and heading variances, rad², of a whole replay in the rows with a heading, for a covariance of the
/// coefficients. `None` if the coefficients are not valid.
pub(super) fn heading_variances(
    prior: &HullFormPrior,
    signals: &HullSignals,
    values: &[f64],
    covariance: &DMatrix<f64>,
) -> Option<[Vec<f64>; 2]> {
    let rate = HullObjective::new(prior, std::slice::from_ref(signals)).misfits(values)?[0].initial_yaw_rate;
    let unknowns = values.len();
    let variables: Vec<Dual<DIRECTIONS>> =
        values.iter().enumerate().map(|(place, &value)| Dual::variable(value, place, 1.0)).collect();
    let [u, v] = signals.initial_velocity.map(Dual::from);
    let start = [u, v, Dual::variable(rate, unknowns, 1.0)];
    let ReplayedWindow { rows, .. } =
        replay_rows_in_lanes(&prior.form.with_coefficients(&variables)?, signals, signals.whole_record, start);
    let (columns, _) = heading_columns(&rows, &signals.heading, unknowns);
    let by = columns.columns(0, unknowns);
    let spread = by * covariance;
    let variance = (0..by.nrows()).map(|row| spread.row(row).dot(&by.row(row))).collect();
    let read = signals.time.iter().zip(&signals.heading).filter(|(_, heading)| heading.is_finite());
    Some([read.map(|(time, _)| *time).collect(), variance])
}

/// Adds `weight` XᵀX and `weight` Xᵀe, with the residuals e in the column `error` and the derivatives X in the columns
/// before it, without the column directly before it, which belongs to the initial yaw rate.
fn add_squares(normal: &mut NormalEquations, columns: &DMatrix<f64>, error: usize, weight: f64) {
    let regressors = columns.columns(0, error - 1);
    normal.matrix.gemm_tr(weight, &regressors, &regressors, 1.0);
    normal.right_hand_side.gemv_tr(weight, &regressors, &columns.column(error), 1.0);
}
