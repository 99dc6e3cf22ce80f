//! Candidate terms: every effect in every form the records allow, with its priors for their manoeuvres.

use std::sync::Arc;

use ship::effects::{Backlash, CandidateEffect, Effect, RecordScales, SecondOrder, SteeringLag, WaveHeading};
use ship::{Polyline, RegressorChannel};
use trial::Trial;

use crate::model::Term;
use crate::record::PreparedRecord;
use crate::selection::Selection;

/// Range of the propeller revolutions, relative to their root mean square, above which they are an input.
const MIN_PROPELLER_CHANGE: f64 = 0.05;

/// Prior probability of an effect, shared equally by its forms.
pub const PRIOR_PROBABILITY: f64 = 0.1;

/// Prior probability of an effect of the measured speed or sway, which occurs for every hull.
pub const PRIOR_PROBABILITY_MOTION_EFFECT: f64 = 0.5;

/// Prior probability of a moment that depends on time, in one record: such a moment resembles noise.
pub const PRIOR_PROBABILITY_TIME_MOMENT: f64 = 0.001;

/// Ship time L/U, s: from the particulars, otherwise approximated by (K/T)^(−1/2); `gain` is K/T, 1/s².
pub fn ship_length_time(trials: &[Trial], gain: f64) -> f64 {
    let mut times = trials.iter().filter_map(Trial::particulars).map(|ship| ship.ship_length_time());
    times.find(|time| time.is_normal()).unwrap_or_else(|| gain.abs().max(1e-9).sqrt().recip())
}

/// Scales of the manoeuvres in some records of a ship with L/U = `ship_length_time` (s); the span is that of `record`.
pub fn record_scales(
    records: &[PreparedRecord],
    trials: &[Trial],
    ship_length_time: f64,
    record: &PreparedRecord,
) -> RecordScales {
    let approach = trials.iter().find_map(|trial| trial.particulars().map(|ship| ship.speed));
    let mean_speed = mean_square(records, |record| record.speed.as_ref());
    // Approach speed: declared, otherwise the root mean square of the recorded speed, otherwise that of the sway.
    let speed = |square: f64| approach.unwrap_or(mean_speed.unwrap_or(square).sqrt());
    let propeller = || {
        let mean = mean_square(records, |record| record.propeller_rate.as_ref())?.sqrt();
        let values = records.iter().filter_map(|record| record.propeller_rate.as_ref()).flat_map(|rate| rate.values());
        let (lowest, highest) = values.fold((f64::MAX, f64::MIN), |(low, high), &n| (low.min(n), high.max(n)));
        (highest - lowest > MIN_PROPELLER_CHANGE * mean).then_some(mean)
    };
    let angles = records.iter().flat_map(|record| record.rudder.values());
    RecordScales {
        ship_length_time,
        max_rudder: angles.fold(1e-3_f64, |largest, delta| largest.max(delta.abs())),
        duration: records.iter().map(PreparedRecord::duration).fold(0.0, f64::max),
        row_interval: records.iter().map(|record| record.spacing).fold(0.0, f64::max),
        approach_speed: mean_speed.map(speed),
        approach_speed_for_sway: mean_square(records, |record| record.sway_velocity.as_ref()).map(speed),
        mean_square_wind_speed: mean_square(records, |record| record.wind_speed.as_ref()),
        rms_propeller_rate: propeller(),
        time_span: [record.time[0], record.time[record.time.len() - 1]],
    }
}

/// `true` if a declared calm excludes an effect of the weather that is not required: a calm of the record in which it
/// would act, or of all records for an effect that acts in all of them.
pub fn is_barred_by_calm(effect: &dyn Effect, record: Option<usize>, trials: &[Trial], selection: &Selection) -> bool {
    let is_calm = || record.map_or_else(|| trials.iter().all(Trial::is_calm), |number| trials[number].is_calm());
    effect.is_environmental() && !selection.requires(effect.id()) && is_calm()
}

/// `true` if waves are candidates for the noise law.
pub fn has_waves(trials: &[Trial], selection: &Selection) -> bool {
    selection.allows(WaveHeading.id()) && !is_barred_by_calm(&WaveHeading, None, trials, selection)
}

/// Candidate terms of the selected effects for these records. Waves are a noise law and no candidate. A moment that
/// depends on time alone is a separate candidate for every record.
pub fn candidate_terms(
    records: &[PreparedRecord],
    trials: &[Trial],
    ship_length_time: f64,
    selection: &Selection,
) -> Vec<Arc<Term>> {
    let mut candidates = Vec::new();
    for effect in selection.effects().iter().filter(|effect| selection.allows(effect.id())) {
        let places: Vec<Option<usize>> = match effect.is_time_dependent() && records.len() > 1 {
            true => (0..records.len()).map(Some).collect(),
            false => vec![None],
        };
        let is_open = |record: &Option<usize>| !is_barred_by_calm(effect.as_ref(), *record, trials, selection);
        for record in places.into_iter().filter(is_open) {
            let about = record_scales(records, trials, ship_length_time, &records[record.unwrap_or(0)]);
            let Some(CandidateEffect { effect, priors }) = effect.candidate(&about) else { continue };
            candidates.push(Term { effect, record_index: record, priors, log_odds: 0.0 });
        }
    }
    let forms = |id: &str, record: Option<usize>| {
        candidates.iter().filter(|term| term.effect.id() == id && term.record_index == record).count() as f64
    };
    let weighted = |term: &Term| {
        let prior = match (term.effect.is_time_dependent(), term.effect.needs()) {
            (true, _) => PRIOR_PROBABILITY_TIME_MOMENT,
            (false, Some(RegressorChannel::Speed | RegressorChannel::Sway)) => PRIOR_PROBABILITY_MOTION_EFFECT,
            (false, _) => PRIOR_PROBABILITY,
        };
        let probability = prior / forms(term.effect.id(), term.record_index);
        Arc::new(Term { log_odds: (probability / (1.0 - probability)).ln(), ..term.clone() })
    };
    candidates.iter().map(weighted).collect()
}

/// `true` for a form that replaces another form of its effect and is not in the full model: a short
/// first-order lag and a short dead time are nearly collinear.
pub fn is_alternative(effect: &dyn Effect) -> bool {
    (effect.id(), effect.form()) == (SteeringLag::FirstOrder.id(), SteeringLag::FirstOrder.form())
}

/// `true` if an effect mainly shifts the response to the rudder in time.
pub fn is_delay(effect: &dyn Effect) -> bool {
    let id = effect.id();
    id == SteeringLag::DeadTime.id()
        || id == SecondOrder.id()
        || (id, effect.form()) == (Backlash.id(), Backlash.form())
}

/// Mean square of a channel over all records; `None` if a record lacks it, or if it is zero throughout.
pub fn mean_square<'a>(
    records: &'a [PreparedRecord],
    signal: impl Fn(&'a PreparedRecord) -> Option<&'a Polyline>,
) -> Option<f64> {
    let mut sum = 0.0;
    let mut count = 0usize;
    for record in records {
        let values = signal(record)?.values();
        sum += values.iter().map(|x| x * x).sum::<f64>();
        count += values.len();
    }
    (sum > 0.0).then(|| sum / count as f64)
}

#[cfg(test)]
mod tests {
    use trial::{DeclaredConditions, DeclaredWeather};

    use super::*;
    use crate::testing::{TrialPlan, record, ship};
    use crate::{EffectId, Settings, trace};
    use document::trace::CandidateOutcome;

    fn trials() -> [Trial; 2] {
        let trial = record(&ship(Vec::new()), TrialPlan::default());
        let calm = DeclaredConditions { weather: Some(DeclaredWeather::Calm), ..DeclaredConditions::default() };
        [trial.clone().with_conditions(calm), trial]
    }

    /// Effects of the weather among the candidates, with the record in which they act.
    fn weather(trials: &[Trial], selection: &Selection) -> Vec<(&'static str, Option<usize>)> {
        let records: Vec<PreparedRecord> = trials.iter().map(PreparedRecord::unaveraged).collect();
        let all = candidate_terms(&records, trials, 13.0, selection);
        assert!(all.iter().any(|term| term.effect.id() == "nonlinear_damping"));
        let mut named: Vec<_> =
            all.iter().filter(|term| term.effect.is_environmental()).map(|term| term.name()).collect();
        named.dedup_by_key(|(id, _, only)| (*id, *only));
        named.into_iter().map(|(id, _, only)| (id, only)).collect()
    }

    #[test]
    fn in_a_calm_no_weather_is_looked_for_that_nobody_asked_for() {
        let both = trials();
        let (calm, other) = both.split_at(1);
        let usual = Selection::default();
        let [wind, drift, transient] = ["wind_moment", "moment_drift", "transient_disturbance"];
        assert_eq!(weather(other, &usual), [wind, drift, transient].map(|id| (id, None)));
        assert_eq!(weather(calm, &usual), []);
        assert_eq!(weather(&both, &usual), [(wind, None), (drift, Some(1)), (transient, Some(1))]);
        let asked = Selection { required: vec![EffectId::find(drift).expect("on the list")], ..usual };
        assert_eq!(weather(calm, &asked), [(drift, None)]);
    }

    #[test]
    fn a_trace_says_that_a_calm_is_declared() {
        let [calm, _] = trials();
        let settings = Settings { is_thorough: false, ..Settings::default() };
        let analysis = trace(&[calm], &[], &settings).expect("a base");
        for id in ["wind_moment", "moment_drift", "transient_disturbance", WaveHeading.id()] {
            let entry = analysis.document.candidates.iter().find(|entry| entry.id == id).expect("on the list");
            assert_eq!((entry.outcome, entry.forms.len()), (CandidateOutcome::NotObservable, 0), "{id}");
            assert_eq!(entry.reason.as_deref(), Some("the record declares a calm (weather = \"none\")"), "{id}");
        }
    }
}
