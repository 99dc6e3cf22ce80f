//! What is left of a replay where a moment of the record is fitted beside its initial state: a constant one, which is a
//! rudder bias, or a slow one. What is gone then can be of the weather or the trim of that record.
//!
//! A moment is an equivalent rudder angle and is added to the rudder. The base is linear in it: one solution of least
//! squares is exact. An average is replayed with the moment that the answers of the base ask for, a few times over.

use identify::replay::Replay;
use nalgebra::{DMatrix, DVector};
use ship::first_order::{State, Transition};
use ship::{FirstOrder, Polyline};

use crate::average::Average;
use crate::record::PreparedRecord;
use crate::replay_errors::{MomentErrors, ReplayDepth};

/// Evenly spaced instants between which a slow moment runs straight.
const INSTANTS: usize = 5;

/// Most replays of an average for a rudder bias, and for a slow moment beside it.
const REPLAYS: [usize; 2] = [2, 4];

/// A moment that promises to lower the error by less than this share is not replayed.
const NEGLIGIBLE: f64 = 0.01;

/// A step that brings no replay nearer is shortened to this share.
const SHORTENED: f64 = 0.4;

/// Combinations of answers whose size is less than this share of that of each of them cannot be seen.
const SINGULAR: f64 = 1e-10;

/// Least squares of a residual on what initial state and moment do to the heading of the base.
#[derive(Debug, Clone)]
struct MomentAnswers {
    /// Heading at the observed rows for a unit initial heading, a unit initial yaw rate, and unit moments.
    columns: DMatrix<f64>,
    inverse: DMatrix<f64>,
}

impl MomentAnswers {
    /// `None` where the rows are no more than the columns, or one of these is not finite.
    fn new(columns: DMatrix<f64>) -> Option<Self> {
        let scale = DVector::from_iterator(columns.ncols(), columns.column_iter().map(|column| column.norm()));
        let is_sound = columns.nrows() > columns.ncols() && scale.iter().all(|size| size.is_normal());
        let mut unit = is_sound.then(|| columns.clone())?;
        unit.column_iter_mut().zip(&scale).for_each(|(mut column, size)| column /= *size);
        let mut inverse = unit.pseudo_inverse(SINGULAR).ok()?;
        inverse.row_iter_mut().zip(&scale).for_each(|(mut row, size)| row /= *size);
        Some(Self { columns, inverse })
    }

    /// The moment (rad of rudder at the instants) that comes nearest to a residual (rad), and the root mean square that
    /// it would leave.
    fn of(&self, residual: &DVector<f64>) -> ([f64; INSTANTS], f64) {
        let found = &self.inverse * residual;
        let left = (residual - &self.columns * &found).norm() / (residual.len() as f64).sqrt();
        // A bias is the same at all instants.
        let last = found.len() - 1;
        (std::array::from_fn(|k| found[last.min(2 + k)]), left)
    }
}

/// Answers of the base on one record: to a rudder bias, and to a slow moment.
#[derive(Debug, Clone)]
pub struct RecordMoment<'a> {
    record: &'a PreparedRecord,
    answers: [MomentAnswers; 2],
}

impl<'a> RecordMoment<'a> {
    /// `None` where the record cannot show a moment.
    pub fn new(record: &'a PreparedRecord, base: &FirstOrder) -> Option<Self> {
        let slow = headings(record, base);
        let mut bias = slow.columns(0, 3).into_owned();
        bias.set_column(2, &slow.columns(2, INSTANTS).column_sum());
        Some(Self { record, answers: [MomentAnswers::new(bias)?, MomentAnswers::new(slow)?] })
    }

    /// Errors of the base beside its replay without a moment.
    pub fn of_base(&self, plain: &Replay) -> MomentErrors {
        let residual = self.residual(plain);
        let [bias, slow] = self.answers.each_ref().map(|answers| answers.of(&residual).1);
        let bias = bias.min(plain.rms());
        MomentErrors { bias, slow: slow.min(bias) }
    }

    /// Errors of an average beside its replay without a moment, which stands where its ships run away.
    pub fn of_average(&self, average: &Average, plain: &Replay) -> MomentErrors {
        let mut record = self.record.clone();
        let (mut best, mut error, mut moment) = (plain.clone(), plain.rms(), [0.0; INSTANTS]);
        let mut search = |answers: &MomentAnswers, replays: usize| {
            let mut share = 1.0;
            for _ in 0..replays {
                let (step, left) = answers.of(&self.residual(&best));
                if left > (1.0 - NEGLIGIBLE) * error {
                    break;
                }
                let next = std::array::from_fn(|k| moment[k] + share * step[k]);
                let Some(rudder) = self.rudder(next) else { break };
                record.rudder = rudder;
                let replayed = average.replay(&record, &[best.initial()], ReplayDepth::Heading);
                let Some(found) = replayed.filter(|all| !all.runs_away()).map(|all| all.replay) else { break };
                if found.rms() < error {
                    (error, best, moment) = (found.rms(), found, next);
                } else {
                    share *= SHORTENED;
                }
            }
            error
        };
        let [bias, slow] = &self.answers;
        MomentErrors { bias: search(bias, REPLAYS[0]), slow: search(slow, REPLAYS[1]) }
    }

    fn residual(&self, replay: &Replay) -> DVector<f64> {
        let observed = &self.record.observed;
        DVector::from_iterator(observed.len(), observed.iter().map(|&row| replay.residual[row]))
    }

    /// The rudder of the record and a moment.
    fn rudder(&self, moment: [f64; INSTANTS]) -> Option<Polyline> {
        let (start, interval) = (self.record.time[0], interval(self.record));
        let times = (0..INSTANTS).map(|k| start + interval * k as f64).collect();
        let moment = Polyline::new(times, moment.to_vec()).ok()?;
        let rudder = &self.record.rudder;
        let values = rudder.times().iter().zip(rudder.values()).map(|(&t, angle)| angle + moment.at(t)).collect();
        Polyline::new(rudder.times().to_vec(), values).ok()
    }
}

/// Time between two instants, s.
fn interval(record: &PreparedRecord) -> f64 {
    record.duration() / (INSTANTS - 1) as f64
}

/// Heading of the base at the observed rows for a unit initial heading, a unit initial yaw rate, and a unit rudder
/// angle at every instant.
fn headings(record: &PreparedRecord, base: &FirstOrder) -> DMatrix<f64> {
    let mut columns = DMatrix::from_element(record.observed.len(), 2 + INSTANTS, 1.0);
    let mut states = [State::default(); 1 + INSTANTS];
    states[0].yaw_rate = 1.0;
    let interval = interval(record);
    let moment = |row: usize, number: usize| {
        let place = (record.time[row] - record.time[0]) / interval;
        // The first state is of the initial yaw rate.
        if number == 0 { 0.0 } else { base.K_over_T * (1.0 - (place - (number - 1) as f64).abs()).max(0.0) }
    };
    let mut row = 0;
    for (place, &observed) in record.observed.iter().enumerate() {
        while row < observed {
            let transition = Transition::new(base.inverse_T, record.time[row + 1] - record.time[row]);
            for (number, state) in states.iter_mut().enumerate() {
                let [from, to] = [row, row + 1].map(|row| moment(row, number));
                *state = transition.advance(*state, from, (to - from) / transition.h);
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
    use crate::comparison::before;
    use crate::testing::{BASE, TrialPlan, moved, record, ship};
    use crate::{Settings, trace};

    fn plain(seed: u64, rudder_deg: f64) -> trial::Trial {
        record(&ship(Vec::new()), TrialPlan { seed, rudder_deg, ..TrialPlan::default() })
    }

    fn deg(errors: MomentErrors) -> [f64; 2] {
        [errors.bias, errors.slow].map(f64::to_degrees)
    }

    /// The base is linear: its replays find what least squares says at once, stable or not.
    #[test]
    fn replays_of_the_base_find_its_least_squares() {
        let trial = moved(&plain(1, 10.0), |t| 0.01 * (t / 80.0).sin());
        let record = PreparedRecord::whole(&trial);
        for inverse_time in [BASE[0], -0.01] {
            let base = FirstOrder { inverse_T: inverse_time, K_over_T: BASE[1], rudder_bias: BASE[2] };
            let moment = RecordMoment::new(&record, &base).expect("enough headings");
            let replay = before(&trial, &record, &base, ReplayDepth::Heading).expect("finite").replay;
            let average = Average { members: vec![(1.0, Box::new(Response::first_order_ship(base)))] };
            let [exact, replayed] = [moment.of_base(&replay), moment.of_average(&average, &replay)].map(deg);
            for (exact, replayed) in exact.into_iter().zip(replayed) {
                assert!((exact - replayed).abs() < 0.02 * exact, "{exact} and {replayed} deg, 1/T = {inverse_time}");
            }
            let plain = replay.rms().to_degrees();
            assert!(plain > exact[0] && exact[0] > exact[1], "{plain} and {exact:?} deg");
            assert!(inverse_time < 0.0 || exact[1] < 0.07, "what is left is noise: {exact:?} deg");
        }
    }

    /// A drift that is traced stays in its record, and bias or slow moment of another one are seen for what they are.
    #[test]
    fn a_moment_of_the_record_is_no_error_of_the_ship() {
        let drifting = [moved(&plain(1, 10.0), |t| 1e-4 * t)];
        let errors = |moment: fn(f64) -> f64, thorough: bool| {
            let settings = Settings { thorough, ..Settings::default() };
            let analysis = trace(&drifting, &[moved(&plain(2, 15.0), moment)], &settings).expect("a base");
            let effects = &analysis.document.effects;
            assert!(effects.iter().any(|effect| effect.id == "moment_drift"), "{effects:?}");
            [&analysis.validation[0].before, &analysis.validation[0].after].map(|on| on.errors.clone())
        };
        let [base, average] = errors(|_| 0.01, true);
        let [bias, slow] = deg(average.with_moment.expect("a thorough analysis"));
        assert!(average.heading.to_degrees() > 2.0 && bias < 0.12 && slow < 0.06, "{average:?}");
        assert!(base.with_moment.is_some_and(|with| with.bias < 0.5 * base.heading), "{base:?}");
        let hurried = errors(|_| 0.01, false);
        assert!(hurried.iter().all(|on| on.with_moment.is_none()));
        assert_eq!(hurried.map(|on| on.heading), [base.heading, average.heading], "the plain errors stay");
        let [_, average] = errors(|t| 0.01 * (t / 80.0).sin(), true);
        let [bias, slow] = deg(average.with_moment.expect("a thorough analysis"));
        assert!(bias > 0.4 && slow < 0.07, "{bias} and {slow} deg");
    }
}
