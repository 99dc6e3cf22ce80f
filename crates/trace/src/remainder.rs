//! What the structures leave of the fitted records.

use estimation::residuals::{GappedSeries, evenness, whiteness};
use trial::Trial;

use crate::comparison::{RecordComparison, ReplayResult};
use crate::fit::FittedRecords;
use crate::full::Full;
use crate::location::Location;
use crate::record::PreparedRecord;
use crate::replay_errors::ReplayErrors;
use crate::rudder::RudderError;
use crate::signature::{Signature, signature};
use crate::structures::Structures;
use crate::weights::NoiseLaw;

/// Errors of all records together, squared, before and after.
pub fn squares(all: &[RecordComparison]) -> [f64; 2] {
    let square = |errors: &ReplayErrors| errors.heading.powi(2) * errors.rows as f64;
    let before = all.iter().map(|one| square(&one.before.errors)).sum();
    [before, all.iter().map(|one| square(&one.after.errors)).sum()]
}

/// What is new in every heading of a record, given those before it and the noise, over its standard deviation: numbers
/// that are normal, white and of unit variance where model and noise describe the record.
#[derive(Debug, Clone, PartialEq)]
pub struct Innovations {
    /// Time, s.
    pub time: Vec<f64>,
    /// Usual time between them, s.
    pub spacing: f64,
    /// Innovations, in standard deviations.
    pub values: Vec<f64>,
}

impl Innovations {
    /// On an even clock.
    pub fn series(&self) -> GappedSeries {
        GappedSeries::new(&self.time, &self.values, self.spacing)
    }
}

/// What the structures leave.
#[derive(Debug, Clone)]
pub struct Remainder {
    /// Whether the law describes it, and the bands that are made from the law hold.
    pub holds: bool,
    /// Whether it does, or the structures replay the records nearer than the base: probabilities under a noise that
    /// does not describe the rest are worth nothing where no replay bears them out.
    pub is_founded: bool,
    /// Whether it is neither chance nor of a shape that was looked for.
    pub is_unexplained: bool,
    /// Where it is, where it is more than noise.
    pub signature: Option<Signature>,
}

/// Share of the error of the base from which a rest that is not white noise is looked at.
const UNEXPLAINED: f64 = 0.3;

/// Standard deviations of the white noise below which a rest is too small to be looked at.
const SMALL: f64 = 1.5;

impl Remainder {
    /// Looks at what is left.
    pub fn new(
        problem: &FittedRecords,
        full: &Full,
        structures: &Structures,
        identification: &[RecordComparison],
        trials: &[Trial],
        location: &Location,
        rudder_errors: &[Option<RudderError>],
    ) -> Self {
        let Some(best) = structures.all.first() else {
            return Self { holds: true, is_founded: true, is_unexplained: false, signature: None };
        };
        let is_held = |one: &RecordComparison| one.after.coverage().is_none_or(|own| own.is_held());
        let innovations = innovations(problem, &best.fit.residual, &full.law);
        let holds = are_noise(&innovations) && identification.iter().all(is_held);
        let [before, after] = squares(identification);
        let is_founded = holds || after < before;
        let rows: f64 = identification.iter().map(|one| one.after.errors.rows as f64).sum();
        let white =
            full.law.variance.iter().zip(&problem.records).map(|(own, record)| own * record.full_readings as f64);
        let is_small = after / rows < SMALL * SMALL * white.fold(0.0, f64::max);
        let shapes = location.shapes.as_ref();
        let is_chance = match shapes {
            Some(own) if own.is_located() || !holds => are_noise(&with_values(innovations, &own.innovations)),
            _ => holds,
        };
        let is_smooth = shapes.is_some_and(|own| own.is_smooth);
        let is_large = !is_small && (after / before).sqrt() >= UNEXPLAINED;
        // In a calm nothing turns the ship at random.
        let is_calm = location.moment(rudder_errors).is_some() && trials.iter().all(Trial::is_calm);
        let is_unexplained = is_large && (is_smooth || !is_chance) || is_calm;
        let is_left = is_unexplained || location.is_located() || is_large && !holds;
        let signature = is_left.then(|| worst(identification, trials)).flatten();
        Self { holds, is_founded, is_unexplained, signature }
    }
}

/// Where the rest of the record with the largest error lives.
fn worst(identification: &[RecordComparison], trials: &[Trial]) -> Option<Signature> {
    let error = |number: usize| identification[number].after.errors.heading;
    let number = (0..identification.len()).max_by(|&one, &other| error(one).total_cmp(&error(other)))?;
    let (ReplayResult { replay, .. }, trial) = (&identification[number].after, &trials[number]);
    let first = trial.observed_rows().next().unwrap_or(0);
    let rows = first..first + replay.time.len();
    let (heading, rudder) = (&trial.heading()[rows.clone()], &trial.rudder()[rows]);
    Some(signature(number, &replay.time, &replay.residual, heading, rudder, trial.sampling_period()))
}

/// Innovations of the same records with other values.
fn with_values(all: Vec<Innovations>, values: &[Vec<f64>]) -> Vec<Innovations> {
    all.into_iter().zip(values).map(|(own, values)| Innovations { values: values.clone(), ..own }).collect()
}

/// Probability below which innovations are not those of the law.
pub const IMPROBABLE: f64 = 1e-4;

/// The residuals (rad) of all records, made white by a law.
pub fn innovations(problem: &FittedRecords, residual: &[Vec<f64>], law: &NoiseLaw) -> Vec<Innovations> {
    let weights = problem.weights(law);
    let of = |(number, (record, residual)): (usize, (&PreparedRecord, &Vec<f64>))| {
        let mut values = residual.clone();
        weights.apply(number, &mut [&mut values]);
        let time = record.observed.iter().map(|&row| record.time[row]).collect();
        Innovations { time, spacing: record.spacing, values }
    };
    problem.records.iter().zip(residual).enumerate().map(of).collect()
}

/// Whether innovations are those of their law: white (Ljung and Box 1978), of one variance, and without a single
/// surprise.
fn are_noise(all: &[Innovations]) -> bool {
    let even = all.iter().map(|own| evenness(&own.values)).fold(1.0, f64::min);
    let series: Vec<GappedSeries> = all.iter().map(Innovations::series).collect();
    whiteness(&series).p_value.min(even * series.len() as f64) > IMPROBABLE
}
