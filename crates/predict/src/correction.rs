//! Correction of a trial in ballast to full load, or to another loading, by two models of the ship.
//!
//! R = T F / B of every characteristic: T is measured in the condition of the trial, B is the prediction of the same
//! manoeuvre by a model of the ship in that condition, F by a model of the ship at the other loading. Errors common to
//! both models cancel; other errors do not, so both models must be of the same method.
//!
//! F and B are sampled independently, with the errors of the parameters and the random moment of one trial, T with the
//! standard deviation of the reading. The moment in B represents that in T. If F is the hull of B at another loading, F
//! and B share the errors of the trial ([`document::identified_hull`]). This module reads no file and fits no model.
//!
//! Source: MSC/Circ.1053 (2002), 3.4.1.2 and 3.4.1.3.

use document::identified_ship::{IdentifiedShip, is_same_length};
use document::{Warning, WarningCode};
use indexmap::IndexMap;
use rand::RngExt;
use rand_distr::StandardNormal;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use simulate::{Manoeuvre, RngPurpose, StreamKey};
use trial::{Quantity, Trial, ZigZag as Measured};

use crate::error::PredictError;
use crate::helm_replay::{SampleResult, SteeredZigZag};
use crate::interval::PredictionInterval;
use crate::mixture::{ShipMixture, UncertaintySource};
use crate::prediction::{check_completed, parallel_draws};
use crate::replay::{record_file, simplified};
use crate::simulated_manoeuvre::SimulatedManoeuvre;
use crate::turn::{self, HeldTurn};

/// Half width of the 90 % interval of F/B, relative to its median, above which a warning is given.
const MAX_HALF_WIDTH: f64 = 0.2;

/// Lower end of the 90 % interval of B, relative to its median, below which the ratio is ill-defined.
const MIN_LOWER_END: f64 = 0.2;

/// Relative tolerance of equal approach speeds.
const SPEED_TOLERANCE: f64 = 0.05;

/// Characteristics read at the end of a turn.
const AT_THE_END: [&str; 4] = ["steady_rate_deg_s", "speed_loss_share", "drift_angle_deg", "pivot_ahead_lengths"];

/// Seed of the readings of T; the seeds of ships are 0 and 1.
const READING: u64 = 2;

/// Name of the loading of the criteria in messages and pages; another loading is named by its file.
pub const FULL_LOAD: &str = "full load";

/// Figure of merit corrected to another loading; the unit is in the name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Corrected")]
pub struct CorrectedFigure {
    /// T: measured in the condition of the trial.
    pub measured: f64,
    /// Standard deviation of T; `None` if the record gives none: T is then treated as exact.
    pub sd: Option<f64>,
    /// R = T F/B.
    #[serde(flatten)]
    pub corrected: PredictionInterval,
    /// Factor F/B on the measured figure.
    pub factor: PredictionInterval,
    /// F: predicted by the model at the target loading.
    #[serde(rename = "full")]
    pub target_prediction: PredictionInterval,
    /// B: predicted by the model in the condition of the trial.
    #[serde(rename = "ballast")]
    pub trial_prediction: PredictionInterval,
    /// Warnings on this figure of merit.
    pub warnings: Vec<Warning>,
}

/// Correction of a record to another loading.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Correction {
    /// File, as the user named it.
    pub file: String,
    /// Name of the record.
    #[serde(default)]
    pub name: String,
    /// Files of the models at the other loading.
    #[serde(rename = "full")]
    pub target_models: Vec<String>,
    /// Files of the models in the condition of the trial.
    #[serde(rename = "ballast")]
    pub trial_models: Vec<String>,
    /// Corrected figures of merit by name; empty if the record is neither a zig-zag nor a turn.
    pub figures: IndexMap<String, CorrectedFigure>,
    /// Warnings on all figures of merit.
    pub warnings: Vec<Warning>,
}

/// Warnings on differences between two models before they are scaled to a record; `loading` is the loading of the
/// first.
///
/// The structures of the most probable members are compared. Source: MSC/Circ.1053 (2002), 3.4.1.3: B and F by one
/// method.
pub fn difference_warnings(full: &IdentifiedShip, trial: &IdentifiedShip, loading: &str) -> Vec<Warning> {
    let structure = |ship: &IdentifiedShip| {
        if !ship.hulls.is_empty() {
            return String::from("a hull");
        }
        let members = ship.members.first().into_iter();
        let mut ids: Vec<&str> = members.flat_map(|member| &member.effects).map(|effect| effect.id.as_str()).collect();
        ids.sort_unstable();
        let effects = if ids.is_empty() { String::new() } else { format!(" with {}", ids.join(", ")) };
        format!("a response{effects}")
    };
    let [of_full, of_trial] = [full, trial].map(structure);
    let mut warnings = Vec::new();
    if of_full != of_trial {
        warnings.push(difference_warning("structure", &of_full, &of_trial, loading));
    }
    let is_same = match (full.length_m, trial.length_m) {
        (Some(a), Some(b)) => is_same_length(a, b),
        (a, b) => a == b,
    };
    if !is_same {
        let [of_full, of_trial] = [full, trial]
            .map(|ship| ship.length_m.map_or_else(|| String::from("unknown"), |length| format!("{length} m")));
        warnings.push(difference_warning("scale", &format!("length {of_full}"), &of_trial, loading));
    }
    warnings
}

/// Warning on a difference of a `quantity` between two models, the first at `loading`.
pub fn difference_warning(quantity: &str, full: &str, trial: &str, loading: &str) -> Warning {
    let text = format!("different {quantity}: {full} at {loading}, {trial} in the condition of the trial");
    WarningCode::ModelsApart.warning(text)
}

/// Results of the drawn ships in order; `None` for a ship that does not complete the manoeuvre.
type Draws = Vec<Option<SampleResult>>;

/// Manoeuvre of a record, simulated with both models.
struct PairedManoeuvre {
    /// Maximum rudder, rad.
    rudder: f64,
    /// Results of the model at the target loading.
    full: Draws,
    /// Results of the model in the condition of the trial.
    trial: Draws,
    /// Characteristics of the record.
    shown: Vec<(&'static str, Quantity)>,
}

/// Corrects the characteristics of a record to a loading, [`FULL_LOAD`] or the name of another; both ships must be at
/// the scale of the record.
///
/// R = T F/B, draw by draw; the 50 and 90 % intervals include the errors of both models, the random moment of one trial
/// each and the reading of T. Two mixtures of the same files share their draws, so that F/B is 1. A zig-zag is steered
/// as in the record, with the recorded rudder rate and initial yaw rate; a turn has the recorded rudder, held longer
/// for a slower ship. Characteristics at the end of a turn are read at the end of the record. Characteristics that the
/// record does not show are left out; a record that is neither a zig-zag nor a turn has none. The lists of model files
/// are left empty.
///
/// Fails if less than half of the drawn ships complete the manoeuvre. Source: MSC/Circ.1053 (2002), 3.4.1.2.
pub fn correct_to_loading(
    full: &ShipMixture,
    ballast: &ShipMixture,
    record: &Trial,
    loading: &str,
    draws: usize,
) -> Result<Correction, PredictError> {
    let full = &if full.ships() == ballast.ships() { full.clone() } else { full.clone().independent_of(ballast) };
    let mut warnings = Vec::new();
    let speed = |mixture: &ShipMixture| mixture.first_ship().speed_m_s;
    if let (Some(of_full), Some(of_trial)) = (speed(full), speed(ballast))
        && (of_full / of_trial - 1.0).abs() > SPEED_TOLERANCE
    {
        let [of_full, of_trial] = [of_full, of_trial].map(|speed| format!("{speed:.2} m/s"));
        let Warning { code, text, .. } = difference_warning("approach speeds", &of_full, &of_trial, loading);
        warnings.push(code.warning(text + "; the ratio F/B includes this difference"));
    }
    let zigzag = Measured::from_trial(record).ok().filter(|zigzag| zigzag.executes.len() > 1);
    let paired = match &zigzag {
        Some(zigzag) => zig_zag(full, ballast, record, zigzag, draws),
        None => turned(full, ballast, record, draws)?,
    };
    let Some(paired) = paired else { return Ok(Correction::default()) };
    for (ship, results, condition) in [
        (full, &paired.full, format!("at {loading}")),
        (ballast, &paired.trial, String::from("in the condition of the trial")),
    ] {
        check_completed(format!("{} ({condition})", record.name()), results.iter().flatten().count(), draws)?;
        if ship.is_extrapolated(paired.rudder, results.iter().flatten().map(|result| result.max_yaw_rate)) {
            let text = format!("the model {condition} is extrapolated beyond its records");
            warnings.push(WarningCode::ModelsApart.warning(text));
        }
    }
    let readings: Vec<f64> = parallel_draws(draws, |replicate| {
        StreamKey { seed: READING, cell: 0, replicate }.rng(RngPurpose::Heading).sample(StandardNormal)
    });
    let corrected = |&(name, measured): &(&str, Quantity)| {
        Some((name.to_owned(), ratio(name, measured, [&paired.full, &paired.trial], &readings)?))
    };
    let figures = paired.shown.iter().filter_map(corrected).collect();
    let (file, name) = (record_file(record).to_owned(), record.name().to_owned());
    Ok(Correction { file, name, figures, warnings, ..Correction::default() })
}

/// Zig-zag of a record, steered with both models; `None` if the record begins within the trial.
fn zig_zag(
    full: &ShipMixture,
    ballast: &ShipMixture,
    record: &Trial,
    zigzag: &Measured,
    draws: usize,
) -> Option<PairedManoeuvre> {
    let steered = SteeredZigZag::from_measured(zigzag, ballast.first_ship().approach_yaw_rate_rad_s)?;
    let [full, trial] = [full, ballast].map(|ship| steered.draws(ship, draws));
    let names = trial.iter().flatten().next().into_iter().flat_map(|result| result.figures.keys());
    let shown =
        names.filter_map(|name| Some((*name, ballast.measured_characteristic(record, zigzag, name)?))).collect();
    Some(PairedManoeuvre { rudder: steered.manoeuvre.max_rudder(), full, trial, shown })
}

/// Turn of a record, simulated with both models; `None` for a record without a turn or an initial motion, or too short.
fn turned(
    full: &ShipMixture,
    ballast: &ShipMixture,
    record: &Trial,
    draws: usize,
) -> Result<Option<PairedManoeuvre>, PredictError> {
    let length = record.particulars().or(ballast.particulars()).map(|particulars| particulars.length);
    let turn = HeldTurn::from_trial(record).zip(turn::resampled_record(record, ballast.timescale(), length));
    let Some((turn, passage)) = turn.filter(|_| record.duration() > ballast.timescale()) else { return Ok(None) };
    let measured = turn.characteristics_within_record(&passage).into_iter();
    let shown: Vec<_> = measured.filter_map(|(key, mean)| Some((key, Quantity::without_uncertainty(mean?)))).collect();
    let Some(rudder) = turn.extended_rudder(record.rudder_signal()).filter(|_| !shown.is_empty()) else {
        return Ok(None);
    };
    let Some([_, rate]) = ballast.initial_motion(record)? else { return Ok(None) };
    let manoeuvre = Manoeuvre::replay(simplified(&rudder));
    let sail = |mixture: &ShipMixture, number| {
        let mut ship = mixture.draw_ship(number, &UncertaintySource::ALL);
        // Both ships start with the yaw rate of the record.
        let key = StreamKey { seed: READING, cell: 1, replicate: number };
        let standard_normal: f64 = key.rng(RngPurpose::Heading).sample(StandardNormal);
        ship.initial_yaw_rate = rate.0 + rate.1 * standard_normal;
        let passage = SimulatedManoeuvre::simulate(&ship, &manoeuvre, mixture.timescale()).ok()?;
        let mut figures = turn.characteristics_to_end(&passage);
        // Characteristics at the end are read after the duration of the record for both ships.
        figures.extend(
            turn.characteristics_within_record(&passage).into_iter().filter(|(name, _)| AT_THE_END.contains(name)),
        );
        Some(SampleResult { figures, max_yaw_rate: passage.max_yaw_rate() })
    };
    let [full, trial] = [full, ballast].map(|mixture| parallel_draws(draws, |number| sail(mixture, number)));
    Ok(Some(PairedManoeuvre { rudder: turn.max_rudder.abs(), full, trial, shown }))
}

/// Number with four significant digits and at most six decimals.
fn short(value: f64) -> String {
    let decimals = if value == 0.0 { 1.0 } else { (3.0 - value.abs().log10().floor()).clamp(0.0, 6.0) };
    format!("{value:.*}", decimals as usize)
}

/// R = T F/B of one characteristic; `None` if less than half of the pairs of ships have it.
fn ratio(name: &str, measured: Quantity, [full, trial]: [&Draws; 2], readings: &[f64]) -> Option<CorrectedFigure> {
    let value = |draw: &Option<SampleResult>| draw.as_ref()?.figures.get(name).copied()?;
    let Quantity { value: measured, sd, .. } = measured;
    let mut columns: [Vec<f64>; 4] = Default::default();
    for ((of_full, of_trial), reading) in full.iter().zip(trial).zip(readings) {
        let (Some(f), Some(b)) = (value(of_full), value(of_trial)) else { continue };
        let factor = f / b;
        if factor.is_finite() {
            let row = [f, b, factor, (measured + sd.unwrap_or(0.0) * reading) * factor];
            columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
        }
    }
    let share = Some(columns[0].len() as f64 / readings.len() as f64).filter(|share| *share >= 0.5)?;
    let [target, trial, factor, corrected] = columns.map(|mut column| PredictionInterval::from_samples(&mut column));
    let (target_prediction, trial_prediction) = (target?, trial?);
    let (factor, corrected) = (factor?, corrected?);
    let [low, high] = trial_prediction.ci90.map(short);
    let (mut messages, median) = (Vec::new(), trial_prediction.median);
    if trial_prediction.ci90.iter().any(|end| end * median.signum() < MIN_LOWER_END * median.abs()) {
        messages.push(format!("B is near zero (90 % [{low}, {high}]), so the ratio F/B is ill-defined"));
    }
    let half = 0.5 * (factor.ci90[1] - factor.ci90[0]) / factor.median.abs();
    if half > MAX_HALF_WIDTH {
        messages.push(format!("F/B is uncertain by ±{:.0} %", 100.0 * half));
    }
    let reach = 1.645 * sd.unwrap_or(0.0);
    if measured + reach < trial_prediction.ci90[0] || measured - reach > trial_prediction.ci90[1] {
        let measured = short(measured);
        messages.push(format!(
            "the model of the trial does not reproduce the measured {measured}, outside its 90 % \
            interval [{low}, {high}]"
        ));
    }
    if share < 1.0 {
        messages.push(format!("only {:.0} % of the pairs of drawn ships get this far", 100.0 * share));
    }
    let warnings = messages.into_iter().map(|text| WarningCode::Correction.warning(text)).collect();
    Some(CorrectedFigure { measured, sd, corrected, factor, target_prediction, trial_prediction, warnings })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{self, mixture};
    use ship::angle::from_deg;

    /// Synthetic ship, and the same ship at full load: heavier, and less stable on course.
    fn ships() -> [IdentifiedShip; 2] {
        let ballast = testing::identified_ship();
        let mut full = testing::identified_ship();
        let parameters = &mut full.members[0].parameters;
        (parameters[0], parameters[1]) = (0.3 * parameters[0], 0.75 * parameters[1]);
        for row in &mut full.members[0].covariance {
            row.iter_mut().for_each(|entry| *entry *= 0.1);
        }
        [full, ballast]
    }

    fn record(mixture: &ShipMixture, kind: &str, number: u64, noise: f64) -> Trial {
        testing::record(mixture, kind, number, noise, 0.5)
    }

    /// The 90 % interval of a corrected record contains the value of the ship at full load in nine of ten cases.
    #[test]
    fn the_truth_at_full_load_is_in_the_interval() {
        let [full, ballast] = ships().map(mixture);
        let kind: Manoeuvre = "zig-zag:20/20".parse().expect("known");
        let names = ["first_overshoot_deg", "second_overshoot_deg", "third_execute_s"];
        let (mut held, mut all) = (0, 0);
        for number in 0..30_u64 {
            let trial = record(&ballast, "zig-zag:20/20", 1000 + number, from_deg(0.1));
            let correction = correct_to_loading(&full, &ballast, &trial, FULL_LOAD, 150).expect("both sail");
            let manoeuvre = crate::standard::with_predicted_end(&kind, full.timescale()).expect("steered");
            // R is the manoeuvre of the record, with its rudder and its straight approach.
            let mut ship = full.draw_ship(2000 + number, &UncertaintySource::ALL);
            (ship.initial_yaw_rate, ship.gear) = (0.0, ballast.draw_ship(1000 + number, &UncertaintySource::ALL).gear);
            let passage = SimulatedManoeuvre::simulate(&ship, &manoeuvre, full.timescale()).expect("sails");
            let truth = crate::figures::characteristics(&kind, &passage, full.particulars());
            for name in names {
                let Some(figure) = correction.figures.get(name) else { continue };
                let truth = truth[name].expect("whole");
                held += usize::from(figure.corrected.contains_90(truth));
                all += 1;
            }
        }
        let share = held as f64 / all as f64;
        assert!(all >= 80 && (0.80..=1.0).contains(&share), "{held} of {all}");
    }

    /// Without uncertainty R is the characteristic of the ship at full load, within the reading error of T.
    #[test]
    fn without_doubt_the_answer_is_the_truth() {
        let [full, ballast] = ships().map(|mut identified| {
            (identified.members[0].covariance, identified.members[0].fitted) = (Vec::new(), Vec::new());
            identified.noise.moment = document::RandomMoment::None;
            if let Some(gear) = &mut identified.gear {
                gear.sd_rad_s = 0.0;
            }
            identified.approach_yaw_rate_rad_s = 0.0;
            mixture(identified)
        });
        let truth = full.predict(&"zig-zag:20/20".parse().expect("known"), 4, false).expect("sails");
        let trial = record(&ballast, "zig-zag:20/20", 0, from_deg(0.02));
        let correction = correct_to_loading(&full, &ballast, &trial, FULL_LOAD, 40).expect("both sail");
        for name in ["first_overshoot_deg", "second_overshoot_deg", "initial_turning_time_s"] {
            let expected = truth.figures[name].interval.median;
            let figure = &correction.figures[name];
            assert!((figure.corrected.median / expected - 1.0).abs() < 0.03, "{name}: {figure:?} {expected}");
            let is_other = !name.contains("overshoot") || figure.factor.median > 1.3;
            assert!(is_other, "{name}: the ship at full load is less stable, {figure:?}");
            assert!(figure.factor.ci90[1] - figure.factor.ci90[0] < 1e-9, "nothing is drawn");
        }
    }

    /// For one file given twice F = B in every draw; for one ship in two files F = B within the interval.
    #[test]
    fn the_same_ship_corrects_nothing() {
        let [_, ballast] = ships();
        let mut copy = ballast.clone();
        copy.members[0].weight = 0.5;
        let [ballast, copy] = [ballast, copy].map(mixture);
        let trial = record(&ballast, "zig-zag:20/20", 7, from_deg(0.1));
        let same = correct_to_loading(&ballast, &ballast, &trial, FULL_LOAD, 60).expect("sails");
        for figure in same.figures.values() {
            assert_eq!(figure.factor.ci90, [1.0, 1.0], "{figure:?}");
        }
        let other = correct_to_loading(&copy, &ballast, &trial, FULL_LOAD, 200).expect("sails");
        assert!(other.figures.len() > 5);
        for figure in other.figures.values() {
            assert!(figure.corrected.contains_90(figure.measured) && figure.factor.contains_90(1.0), "{figure:?}");
            assert!(figure.factor.ci90[1] > figure.factor.ci90[0], "drawn apart");
        }
    }

    /// A hull converted from the hull of the trial has the same errors, so that the correction in a calm is 1.
    #[test]
    fn a_hull_taken_from_that_of_the_trial_has_its_errors() {
        let hulls = vec![testing::hull("quadratic")];
        let ballast = IdentifiedShip { hulls, gear: None, ..testing::identified_ship() }.in_calm().expect("known");
        let taken = vec![testing::at_same_loading(&ballast.hulls[0], 1.0)];
        let full = mixture(IdentifiedShip { hulls: taken, ..ballast.clone() });
        let trial = record(&mixture(testing::identified_ship()), "zig-zag:20/20", 7, from_deg(0.1));
        let correction = correct_to_loading(&full, &mixture(ballast), &trial, FULL_LOAD, 200).expect("sails");
        assert_eq!(correction.figures["first_overshoot_deg"].factor.ci90, [1.0, 1.0]);
    }

    /// A ship at full load turns for longer than the record: her rudder is held longer.
    #[test]
    fn a_turn_is_corrected_too() {
        let [mut full, ballast] = ships();
        full.speed_m_s = Some(5.0);
        full.members[0].parameters[1] *= 0.5;
        let [full, ballast] = [full, ballast].map(mixture);
        let trial = record(&ballast, "turning-circle:15", 3, from_deg(0.1));
        let correction = correct_to_loading(&full, &ballast, &trial, FULL_LOAD, 60).expect("both sail");
        let names: Vec<&String> = correction.figures.keys().collect();
        assert_eq!(names, ["time_to_90_s", "time_to_180_s", "steady_rate_deg_s"]);
        let time = &correction.figures[1];
        assert!(time.factor.median > 1.1, "slower at full load: {time:?}");
        assert!(correction.warnings[0].text.starts_with("different approach speeds"), "{:?}", correction.warnings);
    }

    #[test]
    fn different_models_are_reported() {
        let [mut full, ballast] = ships();
        assert!(difference_warnings(&full, &ballast, FULL_LOAD).is_empty());
        full.members[0].effects.clear();
        full.length_m = Some(300.0);
        let warnings = difference_warnings(&full, &ballast, FULL_LOAD);
        assert!(warnings[0].text.contains("nonlinear_damping") && warnings[1].text.contains("300 m"), "{warnings:?}");
    }

    /// A vague model of the trial and a reading far from its prediction give warnings.
    #[test]
    fn a_vague_model_is_reported() {
        let [full, mut ballast] = ships();
        for row in &mut ballast.members[0].covariance {
            row.iter_mut().for_each(|entry| *entry *= 200.0);
        }
        let [full, vague, exact] = [full, ballast, testing::identified_ship()].map(mixture);
        let trial = record(&exact, "zig-zag:20/20", 0, from_deg(0.1));
        let correction = correct_to_loading(&full, &vague, &trial, FULL_LOAD, 200).expect("most sail");
        let first = &correction.figures["first_overshoot_deg"];
        assert!(first.warnings.iter().any(|warning| warning.text.starts_with("F/B is uncertain by ±")), "{first:?}");
        let strange = correct_to_loading(&full, &full, &trial, FULL_LOAD, 100).expect("sails");
        let outside = |figure: &CorrectedFigure| {
            figure.warnings.iter().any(|warning| warning.text.contains("outside its 90 % interval ["))
        };
        assert!(strange.figures.values().any(outside), "{:?}", strange.figures);
    }
}
