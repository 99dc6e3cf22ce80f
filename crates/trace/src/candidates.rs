//! What may be missing: every effect in every form the records allow, with bounds, scales and starts in their units.

use std::sync::Arc;

use ship::Polyline;
use ship::effects::{
    Effect, MomentDrift, NonlinearDamping, PortStarboardAsymmetry, RudderDeadband, RudderSaturation, SecondOrder,
    SpeedLoss, SteeringLag, SwayCouplingMeasured, TransientDisturbance, WindMoment,
};

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

/// Longest squall as a share of its record.
const LONGEST_SQUALL: f64 = 0.2;

/// Largest T₂ and T₃ of a second-order response in time constants of the base. Beyond, zero and pole are so slow that they
/// imitate a trend.
const SLOWEST_POLE: f64 = 1.0;
const SLOWEST_ZERO: f64 = 2.0;

/// Smallest change of the propeller revolutions, as a share, that makes them worth a look.
const PROPELLER_CHANGE: f64 = 0.05;

fn term(effect: impl Effect + 'static, scale: Vec<f64>) -> Term {
    let parameters = effect.parameters();
    Term {
        lowest: parameters.iter().map(|p| p.lowest).collect(),
        highest: parameters.iter().map(|p| p.highest).collect(),
        only: None,
        held: &[],
        scale,
        effect: Arc::new(effect),
    }
}

/// Every candidate these records allow, waves excepted, which are a kind of noise and no response.
pub fn all(records: &[Record], sizes: &Sizes) -> Vec<Candidate> {
    let Sizes { time, rate, rudder, duration, spacing } = *sizes;
    let mut list = vec![
        second_order(sizes),
        simple(term(NonlinearDamping::Cubic, vec![1.0 / (time * rate * rate)]), 0.05, 1.0),
        simple(term(NonlinearDamping::Quadratic, vec![1.0 / (time * rate)]), 0.05, 1.0),
        simple(term(NonlinearDamping::Square, vec![1.0 / (time * rate)]), 0.0, 0.5),
    ];
    if let Some(square) = mean_square(records, Record::wind_speed) {
        list.push(simple(term(WindMoment::Measured, vec![0.02 / square]), 0.0, 2.0));
    }
    let steady = term(WindMoment::Steady, vec![0.02, 0.02]);
    list.push(Candidate { term: steady, starts: vec![vec![0.0, 0.0]], large: vec![0.03, 0.03] });
    match mean_square(records, Record::speed) {
        Some(square) => {
            let measured = term(SpeedLoss::Measured { approach_speed: square.sqrt() }, vec![1.0, 1.0]);
            list.push(Candidate { term: measured, starts: vec![vec![0.0, 0.0]], large: vec![1.0, 2.0] });
        }
        None => list.push(modelled_speed(sizes)),
    }
    list.extend(propeller(records));
    let mut dead_time = term(SteeringLag::DeadTime, vec![0.1 * time]);
    let longest = (0.5 * time).max(2.0 * spacing);
    (dead_time.lowest[0], dead_time.highest[0]) = (-longest.min(20.0), longest.min(20.0));
    list.push(Candidate { starts: vec![vec![0.0]], large: vec![0.3 * time], term: dead_time });
    let mut lag = term(SteeringLag::FirstOrder, vec![0.1 * time]);
    (lag.lowest[0], lag.highest[0]) = (0.02_f64.max(0.1 * spacing), (2.0 * time).clamp(0.1, 30.0));
    list.push(Candidate { starts: vec![vec![0.1 * time]], large: vec![0.3 * time], term: lag });
    list.push(Candidate {
        large: vec![(0.2 / (rudder * rudder)).min(0.9)],
        starts: vec![vec![0.0]],
        term: term(RudderSaturation, vec![0.2 / (rudder * rudder)]),
    });
    for form in [RudderDeadband::Backlash, RudderDeadband::DeadBand] {
        let mut play = term(form, vec![0.1 * rudder]);
        play.highest[0] = (0.5 * rudder).min(0.15);
        list.push(Candidate { starts: vec![vec![0.07 * rudder]], large: vec![0.15 * rudder], term: play });
    }
    list.push(simple(term(PortStarboardAsymmetry, vec![1.0]), 0.0, 0.2));
    let several = records.len() > 1;
    for (number, record) in records.iter().enumerate() {
        let only = several.then_some(number);
        let mut drift = term(MomentDrift { reference_time: record.time[0] }, vec![0.02 / duration]);
        drift.only = only;
        list.push(simple(drift, 0.0, 2.0));
        let (start, end) = (record.time[0], record.time[record.time.len() - 1]);
        let mut squall = term(TransientDisturbance, vec![0.02, 0.05 * duration, 0.05 * duration]);
        squall.only = only;
        // A squall comes and goes within the record; what lasts longer is a trend or a change of the ship.
        let margin = LONGEST_SQUALL * 0.25 * record.duration();
        (squall.lowest[1], squall.highest[1]) = (start + margin, end - margin);
        (squall.lowest[2], squall.highest[2]) = ((3.0 * spacing).max(0.5), LONGEST_SQUALL * record.duration());
        let large = vec![0.05, 0.5 * (start + end), 0.1 * record.duration()];
        list.push(Candidate { term: squall, starts: Vec::new(), large });
    }
    if let Some(square) = mean_square(records, Record::sway) {
        list.push(simple(term(SwayCouplingMeasured, vec![0.5 * rudder / square.sqrt()]), 0.0, 1.0));
    }
    list
}

/// A term of one parameter, its start and its large value as shares of its scale.
fn simple(term: Term, start: f64, large: f64) -> Candidate {
    let size = term.scale[0];
    let bounded = |share: f64| vec![(share * size).clamp(term.lowest[0], term.highest[0])];
    Candidate { starts: vec![bounded(start)], large: bounded(large), term }
}

fn second_order(sizes: &Sizes) -> Candidate {
    let time = sizes.time;
    let mut term = term(SecondOrder, vec![0.2 * time, 0.5 * time]);
    (term.lowest[0], term.highest[0]) = (0.02_f64.max(0.1 * sizes.spacing), SLOWEST_POLE * time);
    (term.lowest[1], term.highest[1]) = (-0.5 * time, SLOWEST_ZERO * time);
    let starts = [[0.15, 0.4], [0.2, 0.02], [0.4, 1.2]].map(|[t2, t3]| vec![t2 * time, t3 * time]);
    Candidate { starts: starts.into(), large: vec![0.15 * time, 0.5 * time], term }
}

fn modelled_speed(sizes: &Sizes) -> Candidate {
    let Sizes { time, rate, duration, .. } = *sizes;
    let loss = |recovery: f64| 0.2 / (recovery * rate * rate);
    let mut term = term(SpeedLoss::Modelled, vec![loss(4.0 * time), 4.0 * time, 1.0]);
    // The exponent of the rudder force cannot be told from one manoeuvre without a speed: the law of the free stream.
    term.held = &[2];
    term.highest[0] = loss(0.5 * time);
    (term.lowest[1], term.highest[1]) = (0.5 * time, 2.0 * duration);
    let starts = [2.0, 8.0].map(|times| vec![loss(times * time), times * time, 2.0]);
    Candidate { starts: starts.into(), large: vec![loss(4.0 * time), 4.0 * time, 2.0], term }
}

fn propeller(records: &[Record]) -> Option<Candidate> {
    let mean = mean_square(records, Record::propeller)?.sqrt();
    let values = || records.iter().filter_map(Record::propeller).flat_map(|rate| rate.values());
    let (lowest, highest) = values().fold((f64::MAX, f64::MIN), |(lo, hi), &n| (lo.min(n), hi.max(n)));
    let changes = highest - lowest > PROPELLER_CHANGE * mean;
    changes.then(|| simple(term(SpeedLoss::Propeller { approach_rate: mean }, vec![1.0]), 0.0, 2.0))
}

/// Mean square of a channel over all records; `None` when one of them lacks it, or when it is zero throughout.
fn mean_square(records: &[Record], signal: impl Fn(&Record) -> Option<&Polyline>) -> Option<f64> {
    let mut sum = 0.0;
    let mut count = 0usize;
    for record in records {
        let values = signal(record)?.values();
        sum += values.iter().map(|x| x * x).sum::<f64>();
        count += values.len();
    }
    (sum > 0.0).then(|| sum / count as f64)
}
