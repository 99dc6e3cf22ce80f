//! What may be missing: every effect in every form the records allow, as it proposes itself for their manoeuvres.

use ship::Polyline;
use ship::effects::{self, Effect, Manoeuvres, Proposal};

use crate::index::RecordNumber;
use crate::record::Record;
use crate::structure::Term;

/// An effect in one form that these records may lack.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// The term.
    pub term: Term,
    /// Where a fit starts; the best end counts. Empty where the start has to be looked for in the residual.
    pub starts: Vec<Vec<f64>>,
    /// Parameters of an effect as large as it can be expected: what a record cannot see of this size, it cannot see.
    pub large: Vec<f64>,
}

/// Sizes of the manoeuvres, from which bounds and scales follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sizes {
    /// Time constant of the base, s, positive and shorter than a tenth of the longest record.
    pub time: f64,
    /// Root mean square yaw rate, rad/s.
    pub rate: f64,
    /// Largest rudder angle, rad.
    pub rudder: f64,
    /// Longest record, s.
    pub duration: f64,
    /// Usual time between rows, s.
    pub spacing: f64,
}

impl Sizes {
    /// Sizes of records whose base response has 1/T and leaves these replayed headings (rad, observed rows).
    pub fn of(records: &[Record], inverse_time: f64, headings: &[Vec<f64>]) -> Self {
        let duration = records.iter().map(Record::duration).fold(0.0, f64::max);
        let spacing = records.iter().map(|record| record.spacing).fold(0.0, f64::max);
        let rudder = records.iter().flat_map(Record::rudder).fold(0.0_f64, |most, delta| most.max(delta.abs()));
        let (mut square, mut time) = (0.0, 0.0);
        for (record, headings) in records.iter().zip(headings) {
            for (rows, pair) in record.observed.windows(2).zip(headings.windows(2)) {
                let h = record.time[rows[1]] - record.time[rows[0]];
                square += (pair[1] - pair[0]).powi(2) / h;
                time += h;
            }
        }
        let rate = (square / time).sqrt().max(1e-6);
        let time = inverse_time.abs().recip().min(0.1 * duration).max(spacing);
        Self { time, rate, rudder: rudder.max(1e-3), duration, spacing }
    }
}

impl Sizes {
    /// The manoeuvres of these records, with the span of one of them.
    pub fn manoeuvres(&self, records: &[Record], of: &Record) -> Manoeuvres {
        let propeller = || {
            let mean = mean_square(records, Record::propeller)?.sqrt();
            let values = records.iter().filter_map(Record::propeller).flat_map(|rate| rate.values());
            let (lowest, highest) = values.fold((f64::MAX, f64::MIN), |(lo, hi), &n| (lo.min(n), hi.max(n)));
            Some([mean, lowest, highest])
        };
        Manoeuvres {
            time: self.time,
            rate: self.rate,
            rudder: self.rudder,
            duration: self.duration,
            spacing: self.spacing,
            speed_square: mean_square(records, Record::speed),
            sway_square: mean_square(records, Record::sway),
            wind_square: mean_square(records, Record::wind_speed),
            propeller: propeller(),
            span: [of.time[0], of.time[of.time.len() - 1]],
        }
    }
}

impl Candidate {
    /// What an effect proposes for all records, or for one of them `only`.
    pub fn new(proposal: Proposal, only: Option<RecordNumber>) -> Self {
        let Proposal { effect, held, lowest, highest, scale, starts, large } = proposal;
        Self { term: Term { effect, only, held, lowest, highest, scale }, starts, large }
    }
}

/// Every candidate these records allow, waves excepted, which are a kind of noise and no response. A moment that
/// depends on time alone is one of every record.
pub fn all(records: &[Record], sizes: &Sizes) -> Vec<Candidate> {
    let effects = effects::all();
    let of = |effect: &dyn Effect, only: Option<RecordNumber>| {
        let about = sizes.manoeuvres(records, &records[only.map_or(0, |only| only.0)]);
        Some(Candidate::new(effect.proposal(&about)?, only))
    };
    effects
        .iter()
        .flat_map(|effect| {
            let places = if effect.is_of_time() && records.len() > 1 {
                (0..records.len()).map(|number| Some(RecordNumber(number))).collect()
            } else {
                vec![None]
            };
            places.into_iter().filter_map(|only| of(effect.as_ref(), only))
        })
        .collect()
}

/// Mean square of a channel over all records; `None` when one of them lacks it, or when it is zero throughout.
pub fn mean_square(records: &[Record], signal: impl Fn(&Record) -> Option<&Polyline>) -> Option<f64> {
    let mut sum = 0.0;
    let mut count = 0usize;
    for record in records {
        let values = signal(record)?.values();
        sum += values.iter().map(|x| x * x).sum::<f64>();
        count += values.len();
    }
    (sum > 0.0).then(|| sum / count as f64)
}
