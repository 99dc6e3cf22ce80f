//! Replay error after fitting a moment of the record in addition to its initial state: a constant moment (rudder bias)
//! or a slow moment. Weather or trim of that record can explain the decrease of the error.
//!
//! A moment is an equivalent rudder angle, added to the rudder. The base is linear in it, so one least-squares solution
//! is exact. For an average, Gauss–Newton steps use the responses of the base.

use identify::replay::Replay;
use nalgebra::{DMatrix, DVector};
use ship::first_order::{FirstOrderTransition, YawState};
use ship::{FirstOrder, Polyline};

use crate::average::ModelAverage;
use crate::record::PreparedRecord;
use crate::replay_errors::{MomentErrors, ReplayDepth};

/// Number of evenly spaced knots of a slow moment, which is linear between them.
const KNOTS: usize = 5;

/// Maximum number of replays of an average for a rudder bias, and for a slow moment.
const MAX_REPLAYS: [usize; 2] = [2, 4];

/// Predicted relative decrease of the error below which the search ends.
const MIN_DECREASE: f64 = 0.01;

/// Reduction factor of a step that does not reduce the error.
const STEP_FACTOR: f64 = 0.4;

/// Minimum singular value of an observable combination of responses, each normalised to unit length.
const MIN_SINGULAR_VALUE: f64 = 1e-10;

/// Least squares of a residual on the heading responses of the base to initial state and moment.
#[derive(Debug, Clone)]
struct MomentRegression {
    /// Heading at the observed rows for a unit initial heading, a unit initial yaw rate, and unit moments.
    columns: DMatrix<f64>,
    inverse: DMatrix<f64>,
}

impl MomentRegression {
    /// Regression on these columns; `None` unless there are more rows than columns, all finite and nonzero.
    fn new(columns: DMatrix<f64>) -> Option<Self> {
        let scale = DVector::from_iterator(columns.ncols(), columns.column_iter().map(|column| column.norm()));
        let is_sound = columns.nrows() > columns.ncols() && scale.iter().all(|size| size.is_normal());
        let mut unit = is_sound.then(|| columns.clone())?;
        unit.column_iter_mut().zip(&scale).for_each(|(mut column, size)| column /= *size);
        let mut inverse = unit.pseudo_inverse(MIN_SINGULAR_VALUE).ok()?;
        inverse.row_iter_mut().zip(&scale).for_each(|(mut row, size)| row /= *size);
        Some(Self { columns, inverse })
    }

    /// Least-squares moment (rad of rudder at the knots) for a residual (rad), and the remaining root mean square, rad.
    fn solve(&self, residual: &DVector<f64>) -> ([f64; KNOTS], f64) {
        let estimate = &self.inverse * residual;
        let rms = (residual - &self.columns * &estimate).norm() / (residual.len() as f64).sqrt();
        // A bias is the same at all knots.
        let last = estimate.len() - 1;
        (std::array::from_fn(|k| estimate[last.min(2 + k)]), rms)
    }
}

/// Regressions of one record on a rudder bias, and on a slow moment.
#[derive(Debug, Clone)]
pub struct RecordMoment<'a> {
    record: &'a PreparedRecord,
    regressions: [MomentRegression; 2],
}

impl<'a> RecordMoment<'a> {
    /// Prepares a record; `None` if it cannot determine a moment.
    pub fn new(record: &'a PreparedRecord, base: &FirstOrder) -> Option<Self> {
        let slow = headings(record, base);
        let mut bias = slow.columns(0, 3).into_owned();
        bias.set_column(2, &slow.columns(2, KNOTS).column_sum());
        Some(Self { record, regressions: [MomentRegression::new(bias)?, MomentRegression::new(slow)?] })
    }

    /// Errors of the base with a moment; `plain` is its replay without one.
    pub fn base_errors(&self, plain: &Replay) -> MomentErrors {
        let residual = self.residual(plain);
        let [bias, slow] = self.regressions.each_ref().map(|regression| regression.solve(&residual).1);
        let bias = bias.min(plain.rms());
        MomentErrors { with_bias: bias, with_slow_moment: slow.min(bias) }
    }

    /// Errors of an average with a moment. `plain` is its replay without one, which is kept if the replays of the
    /// members with a moment diverge.
    pub fn average_errors(&self, average: &ModelAverage, plain: &Replay) -> MomentErrors {
        let mut record = self.record.clone();
        let (mut best, mut error, mut moment) = (plain.clone(), plain.rms(), [0.0; KNOTS]);
        let mut search = |regression: &MomentRegression, replays: usize| {
            let mut share = 1.0;
            for _ in 0..replays {
                let (step, predicted) = regression.solve(&self.residual(&best));
                if predicted > (1.0 - MIN_DECREASE) * error {
                    break;
                }
                let next = std::array::from_fn(|k| moment[k] + share * step[k]);
                let Some(rudder) = self.rudder(next) else { break };
                record.rudder = rudder;
                let replayed = average.replay(&record, &[best.initial_state()], ReplayDepth::Heading);
                let Some(replay) = replayed.filter(|all| !all.is_divergent()).map(|all| all.replay) else { break };
                if replay.rms() < error {
                    (error, best, moment) = (replay.rms(), replay, next);
                } else {
                    share *= STEP_FACTOR;
                }
            }
            error
        };
        let [bias, slow] = &self.regressions;
        MomentErrors { with_bias: search(bias, MAX_REPLAYS[0]), with_slow_moment: search(slow, MAX_REPLAYS[1]) }
    }

    /// Recorded minus replayed heading at the observed rows, rad.
    fn residual(&self, replay: &Replay) -> DVector<f64> {
        let observed = &self.record.observed_rows;
        DVector::from_iterator(observed.len(), observed.iter().map(|&row| replay.residual[row]))
    }

    /// Rudder of the record plus a moment with these values at the knots, linear between them, rad.
    fn rudder(&self, moment: [f64; KNOTS]) -> Option<Polyline> {
        let (start, interval) = (self.record.time[0], interval(self.record));
        let times = (0..KNOTS).map(|k| start + interval * k as f64).collect();
        let moment = Polyline::new(times, moment.to_vec()).ok()?;
        let rudder = &self.record.rudder;
        let values = rudder.times().iter().zip(rudder.values()).map(|(&t, angle)| angle + moment.value_at(t)).collect();
        Polyline::new(rudder.times().to_vec(), values).ok()
    }
}

/// Time between two of the [`KNOTS`] knots, which span the record, s.
fn interval(record: &PreparedRecord) -> f64 {
    record.duration() / (KNOTS - 1) as f64
}

/// Heading responses of the base at the observed rows to a unit initial heading, a unit initial yaw rate, and a unit
/// rudder angle at every knot.
fn headings(record: &PreparedRecord, base: &FirstOrder) -> DMatrix<f64> {
    let mut columns = DMatrix::from_element(record.observed_rows.len(), 2 + KNOTS, 1.0);
    let mut states = [YawState::default(); 1 + KNOTS];
    states[0].yaw_rate = 1.0;
    let interval = interval(record);
    let moment = |row: usize, number: usize| {
        let place = (record.time[row] - record.time[0]) / interval;
        // State 0 is the response to the initial yaw rate.
        if number == 0 { 0.0 } else { base.K_over_T * (1.0 - (place - (number - 1) as f64).abs()).max(0.0) }
    };
    let mut row = 0;
    for (place, &observed) in record.observed_rows.iter().enumerate() {
        while row < observed {
            let transition = FirstOrderTransition::new(base.inverse_T, record.time[row + 1] - record.time[row]);
            for (number, state) in states.iter_mut().enumerate() {
                let [from, to] = [row, row + 1].map(|row| moment(row, number));
                *state = transition.advance(*state, from, (to - from) / transition.time_step);
            }
            row += 1;
        }
        states.iter().enumerate().for_each(|(number, state)| columns[(place, 1 + number)] = state.heading);
    }
    columns
}

#[cfg(test)]
mod tests {
    use ship::Response;

    use super::*;
    use crate::comparison::replay_base;
    use crate::testing::{BASE, TrialPlan, moved, record, ship};
    use crate::{Settings, trace};

    fn plain(seed: u64, rudder_deg: f64) -> trial::Trial {
        record(&ship(Vec::new()), TrialPlan { seed, rudder_deg, ..TrialPlan::default() })
    }

    fn deg(errors: MomentErrors) -> [f64; 2] {
        [errors.with_bias, errors.with_slow_moment].map(f64::to_degrees)
    }

    /// The base is linear: iterated replays agree with one least-squares solution, for either sign of T.
    #[test]
    fn replays_of_the_base_find_its_least_squares() {
        let trial = moved(&plain(1, 10.0), |t| 0.01 * (t / 80.0).sin());
        let record = PreparedRecord::unaveraged(&trial);
        for inverse_time in [BASE[0], -0.01] {
            let base = FirstOrder { inverse_T: inverse_time, K_over_T: BASE[1], rudder_bias: BASE[2] };
            let moment = RecordMoment::new(&record, &base).expect("enough headings");
            let replay = replay_base(&trial, &record, &base, ReplayDepth::Heading).expect("finite").replay;
            let average = ModelAverage { members: vec![(1.0, Box::new(Response::first_order_ship(base)))] };
            let [exact, replayed] = [moment.base_errors(&replay), moment.average_errors(&average, &replay)].map(deg);
            for (exact, replayed) in exact.into_iter().zip(replayed) {
                assert!((exact - replayed).abs() < 0.02 * exact, "{exact} and {replayed} deg, 1/T = {inverse_time}");
            }
            let plain = replay.rms().to_degrees();
            assert!(plain > exact[0] && exact[0] > exact[1], "{plain} and {exact:?} deg");
            assert!(inverse_time < 0.0 || exact[1] < 0.07, "the residual is noise: {exact:?} deg");
        }
    }

    /// An identified drift stays in its record; bias and slow moment of another record are recognised as such.
    #[test]
    fn a_moment_of_the_record_is_no_error_of_the_ship() {
        let drifting = [moved(&plain(1, 10.0), |t| 1e-4 * t)];
        let errors = |moment: fn(f64) -> f64, thorough: bool| {
            let settings = Settings { is_thorough: thorough, ..Settings::default() };
            let analysis = trace(&drifting, &[moved(&plain(2, 15.0), moment)], &settings).expect("a base");
            let effects = &analysis.document.effects;
            assert!(effects.iter().any(|effect| effect.id == "moment_drift"), "{effects:?}");
            [&analysis.validation[0].base_replay, &analysis.validation[0].average_replay].map(|on| on.errors.clone())
        };
        let [base, average] = errors(|_| 0.01, true);
        let [bias, slow] = deg(average.fitted_moment_errors.expect("a thorough analysis"));
        assert!(average.heading_rmse.to_degrees() > 2.0 && bias < 0.12 && slow < 0.06, "{average:?}");
        assert!(base.fitted_moment_errors.is_some_and(|with| with.with_bias < 0.5 * base.heading_rmse), "{base:?}");
        let hurried = errors(|_| 0.01, false);
        assert!(hurried.iter().all(|on| on.fitted_moment_errors.is_none()));
        assert_eq!(
            hurried.map(|on| on.heading_rmse),
            [base.heading_rmse, average.heading_rmse],
            "the plain errors stay"
        );
        let [_, average] = errors(|t| 0.01 * (t / 80.0).sin(), true);
        let [bias, slow] = deg(average.fitted_moment_errors.expect("a thorough analysis"));
        assert!(bias > 0.4 && slow < 0.07, "{bias} and {slow} deg");
    }
}
