//! A trial that was made in ballast, corrected to full load by two models of the ship.
//!
//! R = T F / B of every figure of merit: T is measured in the condition of the trial, B is told of the same manoeuvre
//! by a model of the ship in that condition, F by a model of the ship at full load. What both models have wrong alike
//! cancels; what they have wrong differently does not, so both have to be of one method.
//!
//! F and B are drawn apart, each with the errors of its parameters and the random moment of one trial, T with the
//! standard deviation of its reading. The moment in B stands for that in T. It reads no file and fits nothing.
//!
//! Source: MSC/Circ.1053 (2002), 3.4.1.2 and 3.4.1.3.

use rand::RngExt;
use rand_distr::StandardNormal;
use rayon::prelude::*;
use simulate::{Manoeuvre, Purpose, StreamKey};
use trial::{Quantity, Trial, ZigZag as Measured};

pub use crate::doubt::Doubt;
use crate::error::PredictError;
use crate::interval::{Interval, quantile};
use crate::known::{KnownShip, is_same_length};
use crate::mixture::{Mixture, Source};
use crate::passage::Passage;
use crate::prediction::enough;
use crate::replay::thinned;
use crate::steered::{Sailed, Steered};
use crate::turn::{self, Turn};

/// Half width of the 90 % interval of F/B, as a share of its median, above which R says little more than F.
const WIDE: f64 = 0.2;

/// Lower end of the 90 % interval of B, as a share of its median, below which the ratio is ill-defined.
const NEAR_ZERO: f64 = 0.2;

/// Difference of two approach speeds, as a share, above which it is said.
const SAME_SPEED: f64 = 0.05;

/// Figures that are read at the end of a turn.
const AT_THE_END: [&str; 4] = ["steady_rate_deg_s", "speed_loss_share", "drift_angle_deg", "pivot_ahead_lengths"];

/// Seed of the readings of T; those of ships are 0 and 1.
const READING: u64 = 2;

/// A figure of merit corrected to full load, in the unit of its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Corrected {
    /// Its name, with the unit.
    pub name: &'static str,
    /// T, measured in the condition of the trial.
    pub measured: f64,
    /// Standard deviation of T, where the record tells it; else T is taken as exact.
    pub sd: Option<f64>,
    /// F, told of the ship at full load.
    pub full: Interval,
    /// B, told of the ship in the condition of the trial.
    pub trial: Interval,
    /// F/B.
    pub factor: Interval,
    /// R = T F/B.
    pub result: Interval,
    /// Why it says little; empty where nothing speaks against it.
    pub doubts: Vec<Doubt>,
}

/// All figures of a record corrected to full load.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Correction {
    /// The figures; empty where the record is neither a zig-zag nor a turn.
    pub figures: Vec<Corrected>,
    /// What is to be said of all of them.
    pub doubts: Vec<Doubt>,
}

impl Correction {
    /// A figure by its name.
    pub fn figure(&self, name: &str) -> Option<&Corrected> {
        self.figures.iter().find(|figure| figure.name == name)
    }
}

/// Where two models differ that are to be held against each other, before they are scaled to a record.
///
/// Structures are those of the most probable member. Source: MSC/Circ.1053 (2002), 3.4.1.3: B and F by one method.
pub fn differences(full: &KnownShip, trial: &KnownShip) -> Vec<Doubt> {
    let structure = |known: &KnownShip| {
        if known.hull.is_some() {
            return String::from("a hull");
        }
        let mut ids: Vec<&str> = known.members.first().into_iter().flat_map(|member| &member.effects).map(id).collect();
        ids.sort_unstable();
        let effects = if ids.is_empty() { String::new() } else { format!(" with {}", ids.join(", ")) };
        let motion = if known.motion.is_some() { ", speed and drift" } else { "" };
        format!("a response{effects}{motion}")
    };
    let mut doubts = Vec::new();
    let [of_full, of_trial] = [full, trial].map(structure);
    if of_full != of_trial {
        doubts.push(Doubt::Structure { full: of_full, trial: of_trial });
    }
    let is_same = match (full.length_m, trial.length_m) {
        (Some(one), Some(other)) => is_same_length(one, other),
        (one, other) => one == other,
    };
    if !is_same {
        doubts.push(Doubt::Scale { full: full.length_m, trial: trial.length_m });
    }
    doubts
}

fn id(effect: &crate::known::WrittenEffect) -> &str {
    &effect.id
}

/// Draws of one ship after the other; `None` for one that does not come to the end.
type Draws = Vec<Option<Sailed>>;

/// Corrects what a record shows to full load; both ships have to be of its scale.
///
/// R = T F/B, draw by draw; the 50 and 90 % intervals hold the errors of both models, the random moment of one trial
/// each and the reading of T. Two mixtures of the same files are drawn alike, so that F/B is 1. A zig-zag is steered as
/// the record was, with its rate of the rudder and its first yaw rate; a turn has its rudder, held on for the slower of
/// the two; what is read at its end is read when the record ends. Figures that the record does not show are left out;
/// a record that is neither has none.
///
/// Fails where less than half of the drawn ships come to the end of the manoeuvre.
/// Source: MSC/Circ.1053 (2002), 3.4.1.2.
pub fn correct(full: &Mixture, ballast: &Mixture, record: &Trial, draws: usize) -> Result<Correction, PredictError> {
    let full = match full.files() == ballast.files() {
        true => full.clone(),
        false => full.clone().apart(),
    };
    let mut doubts = Vec::new();
    let speed = |mixture: &Mixture| mixture.first().speed_m_s;
    if let (Some(own), Some(other)) = (speed(&full), speed(ballast))
        && (own / other - 1.0).abs() > SAME_SPEED
    {
        doubts.push(Doubt::Speed { full: own, trial: other });
    }
    let zigzag = Measured::of(record).ok().filter(|zigzag| zigzag.executes.len() > 1);
    let (rudder, [of_full, of_trial], shown): (f64, [Draws; 2], Vec<(&'static str, Quantity)>) = match &zigzag {
        Some(zigzag) => {
            let approach = ballast.first().approach_yaw_rate_rad_s;
            let Some(steered) = Steered::of(zigzag, approach) else { return Ok(Correction::default()) };
            let both = [&full, ballast].map(|ship| steered.draws(ship, draws));
            let shown = |name| Some((name, ballast.shown(record, zigzag, name)?));
            let names = both[1].iter().flatten().next().into_iter().flat_map(|sailed| &sailed.figures);
            let shown = names.filter_map(|(name, _)| shown(*name)).collect();
            (steered.kind.rudder(), both, shown)
        }
        None => match turned(&full, ballast, record, draws)? {
            Some(turned) => turned,
            None => return Ok(Correction::default()),
        },
    };
    for (own, what) in [(&of_full, "full load"), (&of_trial, "the condition of the trial")] {
        enough(format!("{} ({what})", record.name()), own.iter().flatten().count(), draws)?;
    }
    for (ship, own, condition) in
        [(&full, &of_full, "at full load"), (ballast, &of_trial, "in the condition of the trial")]
    {
        let mut rates: Vec<f64> = own.iter().flatten().map(|sailed| sailed.largest_rate).collect();
        rates.sort_by(f64::total_cmp);
        if ship.is_unseen(rudder, quantile(&rates, 0.5)) {
            doubts.push(Doubt::Extrapolated { condition });
        }
    }
    let readings: Vec<f64> = (0..draws as u64)
        .map(|replicate| StreamKey { seed: READING, cell: 0, replicate }.rng(Purpose::Heading).sample(StandardNormal))
        .collect();
    let figures = shown
        .into_iter()
        .filter_map(|(name, measured)| ratio(name, measured, [&of_full, &of_trial], &readings))
        .collect();
    Ok(Correction { figures, doubts })
}

/// Draws of a turn with the figures that the record shows of it, and its largest rudder, rad.
#[expect(clippy::type_complexity, reason = "it is taken apart where it is made")]
fn turned(
    full: &Mixture,
    ballast: &Mixture,
    record: &Trial,
    draws: usize,
) -> Result<Option<(f64, [Draws; 2], Vec<(&'static str, Quantity)>)>, PredictError> {
    let signal = record.rudder_signal();
    let length = record.particulars().or(ballast.particulars()).map(|own| own.length);
    let Some(turn) = Turn::of(signal) else { return Ok(None) };
    let Some(passage) = turn::recorded(record, ballast.timescale(), length) else { return Ok(None) };
    let Some(rudder) = turn.held_on(signal) else { return Ok(None) };
    let Some([_, rate]) = ballast.beginning(record)? else { return Ok(None) };
    let start = record.time()[0];
    let measured = turn.figures(&passage.until(turn.until - start), start);
    let shown: Vec<(&'static str, Quantity)> =
        measured.into_iter().filter_map(|(name, value)| Some((name, Quantity::bare(value?)))).collect();
    if record.duration() <= ballast.timescale() || shown.is_empty() {
        return Ok(None);
    }
    let manoeuvre = Manoeuvre::Replay(thinned(&rudder));
    let drawn = |mixture: &Mixture| -> Draws {
        (0..draws as u64)
            .into_par_iter()
            .map(|number| {
                let mut ship = mixture.draw(number, &Source::ALL);
                // Both ships begin as that of the record did.
                let key = StreamKey { seed: READING, cell: 1, replicate: number };
                let of_rate: f64 = key.rng(Purpose::Heading).sample(StandardNormal);
                ship.yaw_rate = rate.0 + rate.1 * of_rate;
                let passage = Passage::sail(&ship, &manoeuvre, mixture.timescale()).ok()?;
                let mut figures = turn.figures(&passage, start);
                // Of what is read at the end both ships have had as much time as that of the record.
                let cut = turn.figures(&passage.until(turn.until - start), start);
                for (figure, (name, value)) in figures.iter_mut().zip(cut) {
                    if AT_THE_END.contains(&name) {
                        figure.1 = value;
                    }
                }
                Some(Sailed::new(figures, &passage))
            })
            .collect()
    };
    Ok(Some((turn.rudder.abs(), [full, ballast].map(drawn), shown)))
}

/// R = T F/B of one figure; `None` where hardly a pair of ships has it.
fn ratio(name: &'static str, measured: Quantity, [full, trial]: [&Draws; 2], readings: &[f64]) -> Option<Corrected> {
    let value = |draw: &Option<Sailed>| {
        let figures = &draw.as_ref()?.figures;
        figures.iter().find(|(own, _)| *own == name).and_then(|(_, value)| *value)
    };
    let sd = measured.sd.unwrap_or(0.0);
    let mut columns: [Vec<f64>; 4] = Default::default();
    for ((of_full, of_trial), reading) in full.iter().zip(trial).zip(readings) {
        let (Some(f), Some(b)) = (value(of_full), value(of_trial)) else { continue };
        let factor = f / b;
        if factor.is_finite() {
            let row = [f, b, factor, (measured.value + sd * reading) * factor];
            columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
        }
    }
    let share = columns[0].len() as f64 / readings.len() as f64;
    if share < 0.5 {
        return None;
    }
    let [full, trial, factor, result] = columns.map(|mut column| Interval::of(&mut column));
    let (full, trial, factor, result) = (full?, trial?, factor?, result?);
    let mut doubts = Vec::new();
    let near_zero = trial.ci90.iter().any(|end| end * trial.median.signum() < NEAR_ZERO * trial.median.abs());
    if near_zero {
        doubts.push(Doubt::NearZero { ci90: trial.ci90 });
    }
    let half = 0.5 * (factor.ci90[1] - factor.ci90[0]) / factor.median.abs();
    if half > WIDE {
        doubts.push(Doubt::Wide { share: half });
    }
    let reach = 1.645 * sd;
    if measured.value + reach < trial.ci90[0] || measured.value - reach > trial.ci90[1] {
        doubts.push(Doubt::Outside { measured: measured.value, ci90: trial.ci90 });
    }
    if share < 1.0 {
        doubts.push(Doubt::Undefined { share });
    }
    Some(Corrected { name, measured: measured.value, sd: measured.sd, full, trial, factor, result, doubts })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kind::Kind;
    use crate::made_up;
    use ship::angle::from_deg;
    use simulate::{Simulation, Vessel};

    /// The made-up ship, and the same at full load: heavier, and less stable on her course.
    fn ships() -> [KnownShip; 2] {
        let ballast = made_up::known();
        let mut full = made_up::known();
        let parameters = &mut full.members[0].parameters;
        (parameters[0], parameters[1]) = (0.3 * parameters[0], 0.75 * parameters[1]);
        for row in &mut full.members[0].covariance {
            row.iter_mut().for_each(|entry| *entry *= 0.1);
        }
        [full, ballast]
    }

    fn mixture(known: KnownShip) -> Mixture {
        Mixture::new(vec![(known, 1.0)]).expect("made up")
    }

    /// A record of a drawn ship; with number 0 of the most probable one in a calm.
    fn record(mixture: &Mixture, kind: &str, number: u64, noise: f64) -> Trial {
        let ship = if number == 0 { mixture.most_probable() } else { mixture.draw(number, &Source::ALL) };
        let kind: Kind = kind.parse().expect("known");
        let manoeuvre = kind.manoeuvre(mixture.timescale()).expect("steered");
        let mut simulation = Simulation::new(Vessel::response(ship.response), manoeuvre);
        simulation.gear = ship.gear;
        simulation.disturbances = ship.disturbances;
        simulation.sensors.heading.noise = noise;
        simulation.recording.period = 0.5;
        simulation.run(&StreamKey { seed: 5, cell: 0, replicate: number }).expect("a trial").trial
    }

    /// Records of ballast ships are corrected to what ships at full load do, in nine of ten cases.
    #[test]
    fn the_truth_at_full_load_is_in_the_interval() {
        let [full, ballast] = ships().map(mixture);
        let kind: Kind = "zig-zag:20/20".parse().expect("known");
        let names = ["first_overshoot_deg", "second_overshoot_deg", "third_execute_s"];
        let (mut held, mut all) = (0, 0);
        for number in 0..30_u64 {
            let trial = record(&ballast, "zig-zag:20/20", 1000 + number, from_deg(0.1));
            let found = correct(&full, &ballast, &trial, 150).expect("both sail");
            let manoeuvre = kind.manoeuvre(full.timescale()).expect("steered");
            // R is the manoeuvre of the record, with its rudder and its straight approach.
            let mut ship = full.draw(2000 + number, &Source::ALL);
            (ship.yaw_rate, ship.gear) = (0.0, ballast.draw(1000 + number, &Source::ALL).gear);
            let passage = Passage::sail(&ship, &manoeuvre, full.timescale()).expect("sails");
            let truth = crate::figures::of(&kind, &passage, full.particulars());
            for name in names {
                let Some(figure) = found.figure(name) else { continue };
                let truth = truth.iter().find(|(own, _)| *own == name).and_then(|(_, value)| *value).expect("whole");
                held += usize::from(figure.result.holds90(truth));
                all += 1;
            }
        }
        let share = held as f64 / all as f64;
        assert!(all >= 80 && (0.80..=1.0).contains(&share), "{held} of {all}");
    }

    /// Two ships without doubt: R is what the ship at full load does, to what a record tells of T.
    #[test]
    fn without_doubt_the_answer_is_the_truth() {
        let [full, ballast] = ships().map(|mut known| {
            (known.members[0].covariance, known.members[0].fitted) = (Vec::new(), Vec::new());
            known.noise.moment = crate::known::Moment::None;
            if let Some(gear) = &mut known.gear {
                gear.sd_rad_s = 0.0;
            }
            known.approach_yaw_rate_rad_s = 0.0;
            mixture(known)
        });
        let truth = full.predict(&"zig-zag:20/20".parse().expect("known"), 4, false).expect("sails");
        let trial = record(&ballast, "zig-zag:20/20", 0, from_deg(0.02));
        let found = correct(&full, &ballast, &trial, 40).expect("both sail");
        for name in ["first_overshoot_deg", "second_overshoot_deg", "initial_turning_time_s"] {
            let own = truth.figures.iter().find(|figure| figure.name == name).expect("told").interval.median;
            let figure = found.figure(name).expect("measured");
            assert!((figure.result.median / own - 1.0).abs() < 0.03, "{name}: {figure:?} {own}");
            let is_other = !name.contains("overshoot") || figure.factor.median > 1.3;
            assert!(is_other, "{name}: the ship at full load is less stable, {figure:?}");
            assert!(figure.factor.ci90[1] - figure.factor.ci90[0] < 1e-9, "nothing is drawn");
        }
    }

    /// The same file twice is F = B draw by draw; the same ship in two files is so within its interval.
    #[test]
    fn the_same_ship_corrects_nothing() {
        let [_, ballast] = ships();
        let mut copy = ballast.clone();
        copy.members[0].weight = 0.5;
        let [ballast, copy] = [ballast, copy].map(mixture);
        let trial = record(&ballast, "zig-zag:20/20", 7, from_deg(0.1));
        let same = correct(&ballast, &ballast, &trial, 60).expect("sails");
        for figure in &same.figures {
            assert_eq!(figure.factor.ci90, [1.0, 1.0], "{figure:?}");
        }
        let other = correct(&copy, &ballast, &trial, 200).expect("sails");
        assert!(other.figures.len() > 5);
        for figure in &other.figures {
            assert!(figure.result.holds90(figure.measured) && figure.factor.holds90(1.0), "{figure:?}");
            assert!(figure.factor.ci90[1] > figure.factor.ci90[0], "drawn apart");
        }
    }

    /// A ship at full load turns more slowly than the record lasts: the rudder is held on for her.
    #[test]
    fn a_turn_is_corrected_too() {
        let [mut full, ballast] = ships();
        full.speed_m_s = Some(5.0);
        full.members[0].parameters[1] *= 0.5;
        let [full, ballast] = [full, ballast].map(mixture);
        let trial = record(&ballast, "turning-circle:15", 3, from_deg(0.1));
        let found = correct(&full, &ballast, &trial, 60).expect("both sail");
        let names: Vec<&str> = found.figures.iter().map(|figure| figure.name).collect();
        assert_eq!(names, ["time_to_90_s", "time_to_180_s", "steady_rate_deg_s"]);
        let time = &found.figures[1];
        assert!(time.factor.median > 1.1, "slower at full load: {time:?}");
        assert!(found.doubts.iter().any(|doubt| matches!(doubt, Doubt::Speed { .. })), "{:?}", found.doubts);
    }

    #[test]
    fn models_that_do_not_pair_up_are_told() {
        let [mut full, ballast] = ships();
        assert_eq!(differences(&full, &ballast), []);
        full.members[0].effects.clear();
        full.length_m = Some(300.0);
        let said: Vec<String> = differences(&full, &ballast).iter().map(Doubt::to_string).collect();
        assert!(said[0].contains("nonlinear_damping") && said[1].contains("300 m"), "{said:?}");
    }

    /// A model that says nothing of the trial says so, and a reading far off it is told.
    #[test]
    fn what_says_little_is_told() {
        let [full, mut ballast] = ships();
        for row in &mut ballast.members[0].covariance {
            row.iter_mut().for_each(|entry| *entry *= 200.0);
        }
        let [full, vague, exact] = [full, ballast, made_up::known()].map(mixture);
        let trial = record(&exact, "zig-zag:20/20", 0, from_deg(0.1));
        let found = correct(&full, &vague, &trial, 200).expect("most sail");
        let first = found.figure("first_overshoot_deg").expect("measured");
        assert!(first.doubts.iter().any(|doubt| matches!(doubt, Doubt::Wide { .. })), "{first:?}");
        let strange = correct(&full, &full, &trial, 100).expect("sails");
        let outside = |figure: &Corrected| figure.doubts.iter().any(|doubt| matches!(doubt, Doubt::Outside { .. }));
        assert!(strange.figures.iter().any(outside), "{:?}", strange.figures);
    }
}
