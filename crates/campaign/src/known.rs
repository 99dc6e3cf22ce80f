//! What an estimate or an analysis knows of a ship, as a prediction takes it. Longer than most: it reads all that fits,
//! traces and hulls leave.

use document::stored_hull::{by_keys, rows_of};
use document::{
    HeadingNoise, IdentifiedShip, KnownGear, RandomYawMoment, StoredCoefficient, StoredEffect, StoredHull,
    ValidityRange, WeightedStructure,
};
use identify::estimate::{Estimate, Uncertainty};
use identify::hull::{self, EarlierHull, ExpectationCheck, HullEstimate, HullFitError, HullReference, HullResidual};
use identify::replay::{Replay, pooled_rms, replay};
use identify::{Identifier, maximum_likelihood};
use ship::Particulars;
use ship::angle::to_deg;
use ship::vessel::prime::HullCoefficient;
use trace::Analysis;
use trace::analysis::Plausible;
use trial::zigzag::STRAIGHT_APPROACH;
use trial::{Channel, Trial, ZigZag};

/// What is not predicted where nothing is known of speed and drift.
const NO_MOTION: &str = "speed loss and drift are not told by these records, and no track can be predicted";

/// What records show of a ship, whatever model is fitted to them: read once for all of its answers.
#[derive(Debug, Clone)]
pub struct RecordFacts<'a> {
    trials: &'a [Trial],
    gear: Option<KnownGear>,
    /// Noise of the readings of the heading, rad.
    reading_noise: Option<f64>,
    /// The zig-zag of every record that is one.
    zigzags: Vec<Option<ZigZag>>,
    length: Option<f64>,
    speed: Option<f64>,
    /// The hulls of the ship, the nearest first.
    pub hulls: Vec<StoredHull>,
    /// The records against what earlier trials told of the ship, for every form of hull that they left, whether it is
    /// near enough to take part or not; the nearest first.
    pub checks: Vec<(&'static str, ExpectationCheck)>,
    /// Why no track can be predicted from records that have a speed or positions; `None` where one can, and for records
    /// without.
    pub no_track: Option<String>,
}

impl<'a> RecordFacts<'a> {
    /// What some records of one ship show, but for speed and drift.
    pub fn of(trials: &'a [Trial]) -> Self {
        let zigzags: Vec<Option<ZigZag>> = trials.iter().map(|trial| ZigZag::of(trial).ok()).collect();
        let particular = |of: fn(Particulars) -> f64| trials.iter().find_map(|trial| trial.particulars().map(of));
        Self {
            trials,
            gear: gear(trials, &zigzags),
            reading_noise: reading_noise(&zigzags),
            zigzags,
            length: particular(|own| own.length),
            speed: particular(|own| own.speed),
            hulls: Vec::new(),
            checks: Vec::new(),
            no_track: None,
        }
    }

    /// The same with speed and drift: the hulls that these records speak for, where length and speed are known, all of
    /// them begin away from rest, and they have a speed or positions, or an analysis or earlier trials told her hull.
    pub fn with_motion(mut self, analysis: Option<&Analysis>, earlier: &[EarlierHull]) -> Self {
        let has_all = |trial: &Trial, all: &[Channel]| all.iter().all(|own| trial.channel(*own).is_some());
        let told = [&[Channel::Speed][..], &[Channel::Surge, Channel::Sway], &[Channel::North, Channel::East]];
        let has_speed = |trial: &Trial| told.iter().any(|channels| has_all(trial, channels));
        let was_told = !earlier.is_empty() || analysis.is_some_and(|analysis| !analysis.hulls.is_empty());
        let tells_hull = was_told || self.trials.iter().all(has_speed);
        // Structures may replay the records nearer, and know no speed of a manoeuvre that was not made.
        let mut fitted = if tells_hull { hull::fit_all(self.trials, earlier) } else { Vec::new() };
        fitted.sort_by(|one, other| one.mean_square().total_cmp(&other.mean_square()));
        let after_trials = fitted.iter().filter(|hull| hull.expected.has_trials);
        self.checks = after_trials.filter_map(|hull| Some((hull.expected.form.as_str(), hull.check()?))).collect();
        let hulls = hull::members(fitted, f64::INFINITY);
        self.hulls = hulls.iter().map(|hull| self.stored(hull, hulls.len())).collect();
        if self.hulls.is_empty() && tells_hull && self.length.is_some() {
            let reason = hull::refusal(self.trials).unwrap_or(HullFitError::NoReplay);
            self.no_track = Some(format!("{NO_MOTION}: {reason}"));
        }
        self
    }

    /// What is known of the ship, when a model says the rest of it.
    ///
    /// `rates` are the yaw rates of its replays of the records, rad/s.
    fn with<'b>(
        &self,
        members: Vec<WeightedStructure>,
        noise: HeadingNoise,
        rates: impl Iterator<Item = &'b [f64]>,
    ) -> IdentifiedShip {
        let rates: Vec<&[f64]> = rates.collect();
        // A hull leaves no residual that would tell the noise of a reading.
        let of_readings = self.reading_noise.filter(|_| !self.hulls.is_empty());
        IdentifiedShip {
            members,
            noise: HeadingNoise { heading_sd_rad: of_readings.unwrap_or(noise.heading_sd_rad), ..noise },
            gear: self.gear,
            approach_yaw_rate_rad_s: self.approach_yaw_rate(&rates),
            seen: ValidityRange {
                rudder_rad: largest(self.trials.iter().flat_map(|trial| trial.rudder())),
                yaw_rate_rad_s: largest(rates.into_iter().flatten()),
            },
            length_m: self.length,
            speed_m_s: self.speed,
            hulls: self.hulls.clone(),
        }
    }

    /// A fitted hull as a file holds it, one of so many.
    fn stored(&self, hull: &HullEstimate, of: usize) -> StoredHull {
        let expected = &hull.expected;
        let coefficient = |(own, value): (&HullCoefficient, &f64)| StoredCoefficient {
            key: own.key.to_owned(),
            symbol: own.symbol.to_owned(),
            value: *value,
            expected: own.mean,
            expected_sd: own.sd,
        };
        let HullReference { length, speed, propeller } = hull.reference;
        StoredHull {
            form: expected.form.as_str().to_owned(),
            weight: 1.0 / of as f64,
            length_m: length,
            speed_m_s: speed,
            propeller_per_s: propeller,
            particulars: by_keys(&expected.particulars.unwrap_or_default()),
            coefficients: expected.coefficients.iter().zip(hull.values.iter()).map(coefficient).collect(),
            covariance: rows_of(&hull.covariance),
            moment: RandomYawMoment {
                deviation_rudder_rad: hull.moment.deviation,
                correlation_s: hull.moment.correlation_time,
            },
            beginning_yaw_rate_rad_s: self.beginning(hull),
            from: None,
        }
    }

    /// Root mean square of what replays of a hull begin with beyond the yaw rate of a straight approach, rad/s.
    fn beginning(&self, hull: &HullEstimate) -> f64 {
        let beyond = |(zigzag, record): (&Option<ZigZag>, &HullResidual)| {
            Some((record.begins_with - zigzag.as_ref()?.straight_yaw_rate()?.value).powi(2))
        };
        let squares: Vec<f64> = self.zigzags.iter().zip(&hull.records).filter_map(beyond).collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    }

    /// Root mean square of the yaw rates at the ends of straight approaches, rad/s: of a zig-zag that at its first
    /// execute, without what its reading errors make of it, of another record the first of its replay. Records that
    /// begin in a turn have no part in it; 0 without any other.
    fn approach_yaw_rate(&self, replays: &[&[f64]]) -> f64 {
        let square = |(zigzag, rates): (&Option<ZigZag>, &&[f64])| match zigzag {
            Some(zigzag) => {
                let rate = zigzag.approach_yaw_rate()?;
                Some(rate.value.powi(2) - rate.sd.unwrap_or(0.0).powi(2))
            }
            None => {
                let first = *rates.first()?;
                (first.abs() <= STRAIGHT_APPROACH * largest(*rates)).then_some(first * first)
            }
        };
        let squares: Vec<f64> = self.zigzags.iter().zip(replays).filter_map(square).collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).max(0.0).sqrt()
    }
}

/// Largest size of some values.
fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values.into_iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// What a method knows of the ship of some records; `None` for a method without a covariance.
///
/// The random moment is that of `maximum-likelihood`, which alone looks for one; of any other method the heading noise
/// is that of the readings, or what its replay leaves where the records are no zig-zags.
pub fn of_estimate(estimate: &Estimate, facts: &RecordFacts) -> Option<IdentifiedShip> {
    let Uncertainty::Covariance(covariance) = &estimate.uncertainty else { return None };
    let response = &estimate.response;
    let replays: Vec<Replay> = facts.trials.iter().map(|trial| replay(trial, response)).collect::<Option<_>>()?;
    let member = WeightedStructure {
        weight: 1.0,
        effects: Vec::new(),
        parameters: vec![response.inverse_T, response.K_over_T, response.rudder_bias],
        fitted: vec![0, 1, 2],
        covariance: (0..3).map(|i| (0..3).map(|j| covariance.matrix[(i, j)]).collect()).collect(),
        degrees_of_freedom: covariance.degrees_of_freedom,
    };
    let readings = estimate.noise.map(|noise| noise.heading_sd_rad).or(facts.reading_noise);
    let noise = HeadingNoise {
        heading_sd_rad: readings.unwrap_or_else(|| pooled_rms(&replays)),
        moment: estimate.noise.unwrap_or_default().moment,
    };
    Some(facts.with(vec![member], noise, replays.iter().map(|replay| replay.yaw_rate.as_slice())))
}

/// What an analysis knows of the ship of its fitted records.
///
/// Where nothing is missing and a random moment is there, the ship is the one that `maximum-likelihood` is made for:
/// its covariance holds the doubt about the noise, which that of a trace does not.
pub fn of_analysis(analysis: &Analysis, facts: &RecordFacts) -> IdentifiedShip {
    let members = analysis.plausible().iter().map(member).collect();
    let rates = analysis.identification.iter().map(|compared| compared.after.replay.yaw_rate.as_slice());
    let noise = analysis.noise;
    let known = facts.with(members, noise, rates);
    match known.members.first() {
        Some(first) if first.effects.is_empty() && !noise.moment.is_none() => with_likelihood(known, facts),
        _ => known,
    }
}

/// The same with the first-order member and the noise of `maximum-likelihood`, where that finds a random moment, too.
fn with_likelihood(mut known: IdentifiedShip, facts: &RecordFacts) -> IdentifiedShip {
    let method = maximum_likelihood::Settings::default().build().expect("default settings are valid");
    let Some(likelihood) = method.identify(facts.trials).ok().and_then(|estimate| of_estimate(&estimate, facts)) else {
        return known;
    };
    if let [member] = &likelihood.members[..]
        && !likelihood.noise.moment.is_none()
    {
        known.members[0] = WeightedStructure { weight: known.members[0].weight, ..member.clone() };
        known.noise = likelihood.noise;
    }
    known
}

/// Root mean square noise of the readings of the heading, rad, whatever a model makes of them; `None` where a
/// record does not show it.
fn reading_noise(zigzags: &[Option<ZigZag>]) -> Option<f64> {
    let square = |zigzag: &Option<ZigZag>| zigzag.as_ref()?.heading_noise.map(|noise| noise * noise);
    let sum: Option<f64> = zigzags.iter().map(square).sum();
    sum.map(|sum| (sum / zigzags.len() as f64).sqrt())
}

fn member(plausible: &Plausible) -> WeightedStructure {
    let Plausible { weight, response, fitted, covariance } = plausible;
    let stored = |effect: &std::sync::Arc<dyn ship::effects::Effect>| StoredEffect {
        id: effect.id().to_owned(),
        form: effect.form().to_owned(),
        constants: effect.constants().into_iter().map(|(constant, _)| constant).collect(),
    };
    let sound = covariance.as_ref().filter(|all| all.iter().all(|entry| entry.is_finite()));
    WeightedStructure {
        weight: *weight,
        effects: response.model().effects().iter().map(stored).collect(),
        parameters: response.parameters().to_vec(),
        fitted: if sound.is_some() { fitted.clone() } else { Vec::new() },
        covariance: sound.map(rows_of).unwrap_or_default(),
        degrees_of_freedom: None,
    }
}

/// Rates a steering gear can have, rad/s; outside, a recorded rudder is an order or says nothing about its gear.
const RATES_DEG_S: [f64; 2] = [0.5, 40.0];

/// Part of a sampling interval by which an end of a movement between two rows is not known (a uniform law).
const BETWEEN_ROWS: f64 = 0.29;

/// Steps of a movement whose neighbours are at least this share of them are made at the full rate.
const FULL: f64 = 0.7;

/// Fewest such steps that say what the rate is.
const FEWEST_STEPS: usize = 4;

/// The steering gear, from the reversals of zig-zags; `None` where no record resolves them.
///
/// The rate is the mean of the steps inside movements, its error what these steps differ by. Where movements are about
/// as long as a sampling interval both ends of a reversal lie somewhere between two rows, which is the error of its
/// duration.
fn gear(trials: &[Trial], zigzags: &[Option<ZigZag>]) -> Option<KnownGear> {
    let records = trials.iter().zip(zigzags).filter_map(|(trial, zigzag)| rudder_rate(trial, zigzag.as_ref()?));
    let (rates, variances): (Vec<f64>, Vec<f64>) = records.unzip();
    let count = rates.len() as f64;
    let mean = rates.iter().sum::<f64>() / count;
    let spread = rates.iter().map(|rate| (rate - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    let read = variances.iter().sum::<f64>() / count;
    (count > 0.0).then(|| KnownGear { rate_rad_s: mean, sd_rad_s: (spread.max(read) / count).sqrt() })
}

/// Rate of the rudder on a record, rad/s, and its variance.
fn rudder_rate(trial: &Trial, zigzag: &ZigZag) -> Option<(f64, f64)> {
    let is_sound = |rate: &f64| (RATES_DEG_S[0]..=RATES_DEG_S[1]).contains(&to_deg(*rate));
    let rate = zigzag.rudder_rate.filter(is_sound)?;
    let inside = inside_movements(trial, rate);
    if inside.len() >= FEWEST_STEPS {
        let count = inside.len() as f64;
        let mean = inside.iter().sum::<f64>() / count;
        let square: f64 = inside.iter().map(|rate| (rate - mean).powi(2)).sum();
        return Some((mean, square / (count - 1.0) / count));
    }
    let reversals = zigzag.executes.len().max(1) as f64;
    let throw = zigzag.executes.iter().map(|execute| (execute.rudder_after - execute.rudder_before).abs());
    let duration = throw.fold(0.0, f64::max) / rate;
    let doubt = BETWEEN_ROWS * std::f64::consts::SQRT_2 * trial.sampling_period() / duration;
    Some((rate, (rate * doubt).powi(2) / reversals))
}

/// Rates (rad/s) of the steps of a rudder that lie inside movements of about `rate` rad/s.
fn inside_movements(trial: &Trial, rate: f64) -> Vec<f64> {
    let (time, rudder) = (trial.time(), trial.rudder());
    let steps: Vec<f64> =
        (1..trial.len()).map(|row| (rudder[row] - rudder[row - 1]) / (time[row] - time[row - 1])).collect();
    let is_inside = |three: &&[f64]| {
        let side = three[1].signum();
        three.iter().all(|step| side * step >= FULL * three[1].abs()) && three[1].abs() > FULL * rate
    };
    steps.windows(3).filter(is_inside).map(|three| three[1].abs()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Predictions;
    use identify::output_error;
    use predict::ShipMixture;
    use ship::FirstOrder;
    use ship::angle::from_deg;
    use ship::vessel::prior::HullParticulars;
    use simulate::{Manoeuvre, Simulation, SteeringGear, StreamKey, Vessel};

    use crate::prediction_check::PredictionCheck;

    fn record(walk_deg: f64) -> Trial {
        let ship = Vessel::first_order(FirstOrder::from_indices(0.1, 16.3, 0.0));
        let zig_zag = Manoeuvre::zig_zag(from_deg(10.0), from_deg(10.0)).until_execute(6);
        let mut simulation = Simulation::new(ship, zig_zag);
        simulation.gear = SteeringGear::with_rate(from_deg(2.32));
        simulation.sensors.heading_noise = from_deg(0.1);
        simulation.disturbances.random_walk = from_deg(walk_deg);
        simulation.run(&StreamKey { seed: 1, cell: 0, replicate: 0 }).expect("a trial").trial
    }

    /// From a record to the overshoot of a trial that was not made: 19.71 deg for YUKUN (20/20, 2.32 deg/s).
    #[test]
    fn a_ten_ten_tells_the_twenty_twenty() {
        let trials = [record(0.0)];
        let estimate = output_error::Settings::default().build().expect("defaults").identify(&trials).expect("a fit");
        let known = of_estimate(&estimate, &RecordFacts::of(&trials)).expect("a covariance");
        let gear = known.gear.expect("a zig-zag");
        assert!((to_deg(gear.rate_rad_s) - 2.32).abs() < 0.1, "{gear:?}");
        assert!((to_deg(known.noise.heading_sd_rad) - 0.1).abs() < 0.02 && known.noise.moment.is_none());
        let kind: Manoeuvre = "zig-zag:20/20".parse().expect("known");
        let prediction =
            ShipMixture::new(vec![(known, 1.0)]).expect("sound").predict(&kind, 200, true).expect("a trial");
        let first = &prediction.figures["first_overshoot_deg"];
        assert!((first.interval.median - 19.71).abs() < 0.5, "{:?}", first.interval);
        assert!(first.interval.ci90[1] - first.interval.ci90[0] < 1.5, "{:?}", first.interval);
        assert!(prediction.is_extrapolated(), "20 deg of rudder after 10");
    }

    /// A record cut within a turn says nothing of how straight an approach is: 1.97 L of the initial turning to the
    /// limit of 2.5 are certain.
    #[test]
    fn a_record_that_begins_in_a_turn_says_nothing_of_the_approach() {
        let whole = record(0.0);
        let turning = whole.time().partition_point(|time| *time < 45.0);
        let columns = trial::Columns {
            time: whole.time()[turning..].to_vec(),
            channels: [(Channel::Heading, whole.heading()), (Channel::Rudder, whole.rudder())]
                .map(|(channel, values)| (channel, values[turning..].to_vec()))
                .into(),
            unknown: Vec::new(),
        };
        let ship = Particulars { length: 105.0, speed: 8.59 };
        let cut = Trial::new("cut", whole.origin().clone(), columns).expect("a record").with_particulars(ship);
        assert!(ZigZag::of(&cut).is_ok(), "the rest is a zig-zag");
        let trials = [cut];
        let estimate = output_error::Settings::default().build().expect("defaults").identify(&trials).expect("a fit");
        let known = of_estimate(&estimate, &RecordFacts::of(&trials)).expect("a covariance");
        assert_eq!(known.approach_yaw_rate_rad_s, 0.0);
        let kind: Manoeuvre = "initial-turning:10".parse().expect("known");
        let prediction =
            ShipMixture::new(vec![(known, 1.0)]).expect("sound").predict(&kind, 200, false).expect("a turn");
        let lengths = &prediction.figures["initial_turning_lengths"];
        assert_eq!(lengths.share_within(2.5), 1.0, "{:?}", lengths.interval);
    }

    #[test]
    fn the_moment_of_the_likelihood_is_handed_on() {
        let trials = [record(0.1)];
        let method = maximum_likelihood::Settings::default().build().expect("defaults");
        let known =
            of_estimate(&method.identify(&trials).expect("a fit"), &RecordFacts::of(&trials)).expect("a covariance");
        assert!(!known.noise.moment.is_none());
        assert!(known.noise.moment.size() > 0.0);
    }

    #[test]
    fn an_analysis_knows_its_effects() {
        let trials = [record(0.0)];
        let analysis = trace::trace(&trials, &[], &trace::Settings::default()).expect("a base");
        let known = of_analysis(&analysis, &RecordFacts::of(&trials));
        assert!((known.members.iter().map(|member| member.weight).sum::<f64>() - 1.0).abs() < 1e-9);
        let first = &known.members[0];
        assert!(first.effects.is_empty() && first.fitted == [0, 1, 2] && first.covariance.len() == 3);
        assert!((first.parameters[1] / first.parameters[0] - 0.1).abs() < 0.003);
        ShipMixture::new(vec![(known, 1.0)]).expect("what is known can be drawn from");
    }

    /// Time of the ship KVLCC2, L/U, s.
    const KVLCC2: f64 = 320.0 / 7.97;

    /// KVLCC2 in a manoeuvre, by a gear of 2.34°/s.
    fn tanker(kind: &str) -> Simulation {
        let manoeuvre = predict::standard::steered(&kind.parse().expect("known"), KVLCC2).expect("steered");
        let mut simulation = Simulation::new(Vessel::ship(&ship::ships::kvlcc2::full_scale()), manoeuvre);
        simulation.gear = SteeringGear::with_rate(from_deg(2.34));
        simulation.recording.period = 2.0;
        simulation
    }

    /// Her record, with her particulars.
    fn described(simulation: &Simulation) -> Trial {
        let trial = simulation.run(&StreamKey::default()).expect("a trial").trial;
        let hull = HullParticulars {
            beam: Some(58.0),
            draught: Some(20.8),
            block_coefficient: Some(0.81),
            rudder_area: Some(112.5),
            rudder_height: Some(15.8),
            propeller_diameter: Some(9.86),
            ..HullParticulars::default()
        };
        trial.with_conditions(trial::Conditions { hull, ..trial::Conditions::default() })
    }

    /// Two zig-zags and her particulars tell her circle: advance and tactical diameter to 3 %. Without beam and draught
    /// it is 4 % in the advance, within the interval.
    #[test]
    fn zig_zags_of_a_tanker_tell_her_circle() {
        let zig_zags = ["zig-zag:10/10", "zig-zag:-20/20"].map(|kind| described(&tanker(kind)));
        let estimate = output_error::Settings::default().build().expect("defaults").identify(&zig_zags).expect("a fit");
        let facts = RecordFacts::of(&zig_zags).with_motion(None, &[]);
        let known = of_estimate(&estimate, &facts).expect("a covariance");
        assert!(facts.no_track.is_none() && !known.hulls.is_empty());
        // She begins straight: the yaw rate of replays is an error, less than a twentieth of her rate in the circle.
        assert!(
            facts.hulls.iter().all(|own| (1e-6..1e-3).contains(&own.beginning_yaw_rate_rad_s)),
            "{:?}",
            facts.hulls
        );
        let asked = Predictions { kinds: vec!["turning-circle:35".parse().expect("known")], draws: 300 };
        let check = PredictionCheck::new(&asked, &tanker("zig-zag:10/10"), &StreamKey::default(), &zig_zags);
        let figures = check.figures(|_| Some(known));
        for name in ["advance_lengths", "tactical_diameter_lengths"] {
            let figure = figures.iter().find(|own| own.name.ends_with(name)).expect("a hull has a track");
            assert!((figure.median / figure.truth - 1.0).abs() < 0.03, "{figure:?}");
        }
        assert!(figures.iter().all(|own| !own.name.ends_with("advance_m")), "a length counts once: {figures:?}");
    }
}
