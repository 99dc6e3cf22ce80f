//! Ships drawn from the models of one or several files: a structure by its probability, parameters by their
//! covariance, and the random disturbances of one trial. Every source can be switched off, so that its share of an
//! interval can be computed. Source: Hoeting, Madigan, Raftery and Volinsky (1999), Bayesian model averaging: a
//! tutorial, Statistical Science 14, 382–417.

use document::{IdentifiedShip, IdentifiedShipError, RandomMoment, RandomYawMoment, WeightedStructure};
use nalgebra::{DMatrix, DVector};
use rand::RngExt;
use rand_distr::{ChiSquared, Distribution, StandardNormal};
use ship::vessel::scaled::ScaledHull;
use ship::{RegressorChannel, Response, ResponseModel};
use simulate::disturbance::{GaussMarkov, Wind};
use simulate::{Disturbances, RngPurpose, SteeringGear, StreamKey};

use crate::drawable_hull::HullSampler;
use crate::error::PredictError;
use crate::root::covariance_root;

/// Source of the uncertainty of a prediction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum UncertaintySource {
    /// Errors of the parameters.
    Parameters,
    /// Structures that the records do not distinguish.
    Structure,
    /// Random yaw moment, and the error of the initial yaw rate of a hull.
    ProcessNoise,
    /// Rudder rate.
    SteeringGear,
    /// Yaw rate at the first execute.
    InitialState,
}

impl UncertaintySource {
    /// All sources.
    pub const ALL: [Self; 5] =
        [Self::Parameters, Self::Structure, Self::ProcessNoise, Self::SteeringGear, Self::InitialState];

    /// Name used in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Parameters => "parameters",
            Self::Structure => "structure",
            Self::ProcessNoise => "process-noise",
            Self::SteeringGear => "steering-gear",
            Self::InitialState => "initial-state",
        }
    }
}

/// Maximum number of draws outside the range of a parameter; then it is set to its bound.
const MAX_TRIES: usize = 100;

/// Correlation time of the process that approximates a white moment, in timescales of the ship.
const WHITE_CORRELATION_TIME: f64 = 0.05;

/// Structure prepared for sampling: model and square root of its parameter covariance. A hull, if there is one,
/// replaces the model.
#[derive(Debug, Clone)]
pub(crate) struct StructureSampler {
    /// Probability among all structures.
    pub weight: f64,
    pub model: ResponseModel,
    stored: WeightedStructure,
    root: DMatrix<f64>,
    /// Indices of dead times among the parameters.
    dead_times: Vec<usize>,
    /// Hull that replaces the response of the structure; `None` for the response itself.
    pub hull: Option<HullSampler>,
    /// Index of the file.
    pub file_index: usize,
}

/// Mixture of the models of a ship from one or several files.
#[derive(Debug, Clone)]
pub struct ShipMixture {
    parts: Vec<StructureSampler>,
    /// Ships, one of every file.
    ships: Vec<IdentifiedShip>,
    /// Probabilities of the files.
    shares: Vec<f64>,
    timescale: f64,
    /// `true` if the random numbers are independent of another mixture.
    is_independent: bool,
    /// `true` if the hulls nevertheless follow the hulls of the other mixture, each at another loading.
    shares_trial_errors: bool,
    /// Wind on the hulls, from a direction relative to the approach heading; `None` without wind.
    pub(crate) wind: Option<Wind>,
}

/// Ship drawn from a mixture, to be steered through one manoeuvre.
#[derive(Debug, Clone)]
pub struct DrawnShip {
    /// Yaw response.
    pub response: Response,
    /// Hull, which replaces the response; `None` if none was fitted.
    pub hull: Option<ScaledHull>,
    /// Coefficients of the hull; empty without a hull.
    pub hull_coefficients: Vec<f64>,
    /// Steering gear.
    pub gear: SteeringGear,
    /// Disturbances.
    pub disturbances: Disturbances,
    /// Initial yaw rate, rad/s: of the approach, plus the error of a hull.
    pub initial_yaw_rate: f64,
    /// Key of the random numbers of the yaw moment.
    pub moment_key: StreamKey,
}

impl ShipMixture {
    /// Mixture of the models of several files of one ship, each with its weight; fails for invalid models.
    pub fn new(files: Vec<(IdentifiedShip, f64)>) -> Result<Self, PredictError> {
        let total: f64 = files.iter().map(|(_, weight)| weight).sum();
        let shares: Vec<f64> = files.iter().map(|(_, weight)| weight / total).collect();
        let mut parts = Vec::new();
        for (file, ((stored, _), share)) in files.iter().zip(&shares).enumerate() {
            let of_structures: f64 = stored.members.iter().map(|member| member.weight).sum();
            let structures = stored.members.iter().map(|member| {
                StructureSampler::new(member, share * member.weight / of_structures, file)?.sailing(stored)
            });
            let structures = structures.collect::<Result<Vec<_>, PredictError>>()?;
            if stored.hulls.is_empty() {
                parts.extend(structures);
                continue;
            }
            let beside = likeliest(structures.iter()).ok_or(PredictError::Empty)?;
            let of_hulls: f64 = stored.hulls.iter().map(|hull| hull.weight).sum();
            for fit in &stored.hulls {
                let (hull, weight) = (HullSampler::new(fit)?, checked(share * fit.weight / of_hulls, fit.weight)?);
                parts.push(StructureSampler { hull: Some(hull), weight, ..beside.clone() });
            }
        }
        let timescale = files.first().and_then(|(stored, _)| stored.timescale()).ok_or(PredictError::Empty)?;
        let ships = files.into_iter().map(|(stored, _)| stored).collect();
        Ok(Self { parts, ships, shares, timescale, is_independent: false, shares_trial_errors: false, wind: None })
    }

    /// The same ships, drawn with random numbers independent of `other`. If each ship has one hull, converted from
    /// the hull of `other`, the estimation errors of that hull stay common to both.
    pub fn independent_of(self, other: &Self) -> Self {
        let shares_trial_errors =
            |(ship, other): (&IdentifiedShip, &IdentifiedShip)| match (&ship.hulls[..], &other.hulls[..]) {
                ([hull], [source]) => hull.is_derived_from(source),
                _ => false,
            };
        let shares_trial_errors =
            self.ships.len() == other.ships.len() && self.ships.iter().zip(&other.ships).all(shares_trial_errors);
        Self { is_independent: true, shares_trial_errors, ..self }
    }

    /// Timescale of the ship of the first file, s: about L/U.
    pub fn timescale(&self) -> f64 {
        self.timescale
    }

    /// Ship of the first file.
    pub fn first_ship(&self) -> &IdentifiedShip {
        &self.ships[0]
    }

    /// Ships of the mixture, one of every file.
    pub fn ships(&self) -> &[IdentifiedShip] {
        &self.ships
    }

    /// Most probable ship of the most probable file, without disturbances.
    pub fn most_probable(&self) -> DrawnShip {
        self.draw_ship(0, &[])
    }

    /// Ship number `number`, drawn from the given sources of uncertainty and otherwise the most probable ship.
    pub fn draw_ship(&self, number: u64, sources: &[UncertaintySource]) -> DrawnShip {
        let has = |source: UncertaintySource| sources.contains(&source);
        let key = StreamKey { seed: u64::from(self.is_independent), cell: 0, replicate: number };
        let part = if has(UncertaintySource::Structure) { self.drawn_structure(number) } else { self.likeliest() };
        let stored = &self.ships[part.file_index];
        let mut rng = key.rng(RngPurpose::Specification);
        let mut values = match has(UncertaintySource::Parameters) {
            true => part.sample(&mut rng),
            false => part.stored.parameters.clone(),
        };
        // A negative dead time is an error of the clock; a ship does not respond before its rudder moves.
        part.dead_times.iter().for_each(|place| values[*place] = values[*place].max(0.0));
        let mut normals = key.indexed_rng(RngPurpose::Specification, 1);
        let [gear_normal, approach_normal, start_normal]: [f64; 3] =
            std::array::from_fn(|_| normals.sample(StandardNormal));
        let random_part = |source, value: f64| if has(source) { value } else { 0.0 };
        let gear = stored.gear.map_or_else(SteeringGear::default, |gear| {
            let rate = gear.rate_rad_s + random_part(UncertaintySource::SteeringGear, gear_normal * gear.sd_rad_s);
            SteeringGear::with_rate(rate.max(0.1 * gear.rate_rad_s))
        });
        // A hull converted to another loading shares the sampled errors of the trial hull (stream 2) and adds
        // independent conversion errors (stream 3).
        let of_trial = StreamKey { seed: u64::from(self.is_independent && !self.shares_trial_errors), ..key };
        let mut rng = of_trial.indexed_rng(RngPurpose::Specification, 2);
        let coefficients = part.hull.as_ref().map(|hull| match has(UncertaintySource::Parameters) {
            true => hull.sample(&mut rng, &mut key.indexed_rng(RngPurpose::Specification, 3)),
            false => hull.stored.values(),
        });
        let hull = part.hull.as_ref().zip(coefficients.as_ref()).map(|(hull, drawn)| hull.hull_or_most_probable(drawn));
        let approach = random_part(UncertaintySource::InitialState, approach_normal * stored.approach_yaw_rate_rad_s);
        let of_hull = part.hull.as_ref().map_or(0.0, |hull| hull.stored.beginning_yaw_rate_rad_s);
        let error = random_part(UncertaintySource::ProcessNoise, start_normal * of_hull);
        let is_random = has(UncertaintySource::ProcessNoise);
        let moment = if is_random { part.moment(stored) } else { RandomMoment::None };
        DrawnShip {
            response: part.model.clone().with_parameters(values),
            hull,
            hull_coefficients: coefficients.unwrap_or_default(),
            gear,
            disturbances: self.disturbances(moment, part.hull.is_some()),
            initial_yaw_rate: approach + error,
            moment_key: key,
        }
    }

    fn disturbances(&self, moment: RandomMoment, has_hull: bool) -> Disturbances {
        let mut disturbances = Disturbances { wind: self.wind.filter(|_| has_hull), ..Disturbances::default() };
        match moment {
            RandomMoment::None => {}
            RandomMoment::White { rudder_rad_root_s } => {
                let correlation_time = WHITE_CORRELATION_TIME * self.timescale;
                let sd = rudder_rad_root_s / (2.0 * correlation_time).sqrt();
                disturbances.gusts = Some(GaussMarkov { sd, correlation_time });
            }
            RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad, correlation_s } => {
                disturbances.gusts = Some(GaussMarkov { sd: sd_rudder_rad, correlation_time: correlation_s });
            }
            RandomMoment::Walk { rudder_rad_per_root_s } => disturbances.moment_random_walk = rudder_rad_per_root_s,
        }
        disturbances
    }

    /// Most probable structure of the most probable file, the first of equals; several hulls do not lower the rank of a
    /// file.
    fn likeliest(&self) -> &StructureSampler {
        let file = (0..self.ships.len()).rev().max_by(|a, b| self.shares[*a].total_cmp(&self.shares[*b]));
        likeliest(self.parts.iter().filter(|part| Some(part.file_index) == file)).expect("there is a structure")
    }

    /// Structure of a drawn ship, by a low-discrepancy sequence of the golden ratio, so that shares match probabilities
    /// for any number of draws. A mixture that is independent in all errors uses the incommensurable step √2 − 1.
    pub(crate) fn drawn_structure(&self, number: u64) -> &StructureSampler {
        let step =
            if self.is_independent && !self.shares_trial_errors { std::f64::consts::SQRT_2 - 1.0 } else { GOLDEN_STEP };
        structure_at_probability(&self.parts, (0.5 + number as f64 * step).fract()).unwrap_or_else(|| self.likeliest())
    }
}

/// Golden ratio minus one, the step of a low-discrepancy sequence.
pub(crate) const GOLDEN_STEP: f64 = 0.618_033_988_749_894_9;

/// Structure at a cumulative probability; `None` if rounding leaves a remainder.
pub(crate) fn structure_at_probability(parts: &[StructureSampler], mut share: f64) -> Option<&StructureSampler> {
    parts.iter().find(|part| {
        share -= part.weight;
        share < 0.0
    })
}

/// Most probable structure, the first of equals.
fn likeliest<'a>(parts: impl DoubleEndedIterator<Item = &'a StructureSampler>) -> Option<&'a StructureSampler> {
    parts.rev().max_by(|a, b| a.weight.total_cmp(&b.weight))
}

/// Weight, if it is finite and not negative; otherwise the error with the value `stored` in the file.
fn checked(weight: f64, stored: f64) -> Result<f64, PredictError> {
    let is_weight = weight.is_finite() && weight >= 0.0;
    if is_weight { Ok(weight) } else { Err(IdentifiedShipError::Value { key: "weight", value: stored }.into()) }
}

impl StructureSampler {
    pub(crate) fn new(stored: &WeightedStructure, weight: f64, file: usize) -> Result<Self, PredictError> {
        let (weight, model) = (checked(weight, stored.weight)?, stored.model()?);
        let (root, dead_times) = (covariance_root(&stored.covariance)?, stored.dead_time_indices(&model));
        Ok(Self { weight, model, stored: stored.clone(), root, dead_times, hull: None, file_index: file })
    }

    /// Same structure, checked to have all channels that its effects need in a manoeuvre.
    fn sailing(self, ship: &IdentifiedShip) -> Result<Self, PredictError> {
        for (regressor, channel, option) in
            [(RegressorChannel::Sway, "sway velocity", "sway"), (RegressorChannel::Speed, "speed", "speed")]
        {
            let needs = self.model.effects().iter().any(|effect| effect.needs() == Some(regressor));
            if needs && ship.hulls.is_empty() {
                return Err(PredictError::MissingChannel { channel, option });
            }
        }
        Ok(self)
    }

    /// Random yaw moment: the model error of the hull, or else the moment of the noise law of the ship.
    fn moment(&self, ship: &IdentifiedShip) -> RandomMoment {
        let Some(hull) = &self.hull else { return ship.noise.moment };
        let RandomYawMoment { sd_rudder_rad, correlation_s } = hull.stored.model_error_moment;
        match sd_rudder_rad > 0.0 {
            true => RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad, correlation_s },
            false => RandomMoment::None,
        }
    }

    /// Draw of the parameters, by their covariance and within the ranges of the effects: normal, or Student's t.
    pub(crate) fn sample(&self, rng: &mut impl rand::Rng) -> Vec<f64> {
        let WeightedStructure { parameters: stored, fitted, degrees_of_freedom, .. } = &self.stored;
        let mut values = stored.clone();
        if self.root.is_empty() {
            return values;
        }
        let described: Vec<_> = self.model.parameters().collect();
        for attempt in 0..=MAX_TRIES {
            let normal = DVector::from_fn(fitted.len(), |_, _| rng.sample::<f64, _>(StandardNormal));
            let freedom = degrees_of_freedom.and_then(|freedom| Some((freedom, ChiSquared::new(freedom).ok()?)));
            let wide = freedom.map_or(1.0, |(freedom, law)| (freedom / law.sample(rng)).sqrt());
            let step = &self.root * normal * wide;
            for (&place, step) in fitted.iter().zip(step.iter()) {
                values[place] = stored[place] + step;
                if attempt == MAX_TRIES {
                    values[place] = values[place].clamp(described[place].lowest, described[place].highest);
                }
            }
            if values.iter().zip(&described).all(|(value, parameter)| parameter.is_in_range(*value)) {
                break;
            }
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;
    use document::identified_hull::IdentifiedHull;

    /// Mean and covariance of the draws agree with the stored law.
    #[test]
    fn draws_have_the_stored_law() {
        let mixture = testing::mixture(testing::identified_ship());
        let stored = &mixture.first_ship().members[0];
        let count = 4000;
        let draws: Vec<Vec<f64>> = (0..count)
            .map(|k| mixture.draw_ship(k, &[UncertaintySource::Parameters]).response.parameters().to_vec())
            .collect();
        let mean = |place: usize| draws.iter().map(|draw| draw[place]).sum::<f64>() / count as f64;
        for (row, &first) in stored.fitted.iter().enumerate() {
            for (column, &second) in stored.fitted.iter().enumerate() {
                let product = |draw: &Vec<f64>| (draw[first] - mean(first)) * (draw[second] - mean(second));
                let covariance = draws.iter().map(product).sum::<f64>() / count as f64;
                let scale = (stored.covariance[row][row] * stored.covariance[column][column]).sqrt();
                assert!((covariance - stored.covariance[row][column]).abs() < 0.08 * scale, "{first} {second}");
            }
        }
    }

    #[test]
    fn structures_are_drawn_by_their_probability() {
        let mut stored = testing::identified_ship();
        let mut simple = stored.members[0].clone();
        simple.effects.clear();
        simple.parameters.truncate(3);
        simple.fitted.truncate(3);
        simple.covariance.truncate(3);
        simple.covariance.iter_mut().for_each(|row| row.truncate(3));
        (simple.weight, stored.members[0].weight) = (0.2, 0.6);
        stored.members.push(simple);
        let mixture = ShipMixture::new(vec![(stored, 2.0)]).expect("made up");
        let is_simple = |k| mixture.draw_ship(k, &[UncertaintySource::Structure]).response.parameters().len() == 3;
        let simple = (0..1000).filter(|&k| is_simple(k)).count();
        assert!((240..=260).contains(&simple), "{simple}");
        assert!((0..100).all(|k| mixture.draw_ship(k, &[]).response.parameters().len() == 4));
    }

    /// Of two equally probable files the first is chosen, although its two hulls share the weight.
    #[test]
    fn the_most_probable_ship_is_of_the_most_probable_file() {
        let hull = |weight| IdentifiedHull { weight, ..testing::hull("quadratic") };
        let [several, mut alone] = [vec![hull(0.4), hull(0.6)], vec![hull(1.0)]]
            .map(|hulls| IdentifiedShip { hulls, ..testing::identified_ship() });
        alone.members[0].parameters[0] *= 1.1;
        let of_several = several.members[0].parameters.clone();
        let mixture = ShipMixture::new(vec![(several, 1.0), (alone, 1.0)]).expect("made up");
        assert_eq!(mixture.most_probable().response.parameters(), of_several);
        assert_eq!(mixture.likeliest().weight, 0.3);
    }

    /// Ships drawn from a hull begin with the initial error of its replays; ships in a calm do not.
    #[test]
    fn hulls_begin_with_the_error_of_their_replays() {
        let rate = 1e-3;
        let hulls = vec![IdentifiedHull { beginning_yaw_rate_rad_s: rate, ..testing::hull("quadratic") }];
        let stored = IdentifiedShip { hulls, approach_yaw_rate_rad_s: 0.0, ..testing::identified_ship() };
        let of = |stored: IdentifiedShip, sources: &[UncertaintySource]| {
            let mixture = testing::mixture(stored);
            let squares = (0..1000).map(|number| mixture.draw_ship(number, sources).initial_yaw_rate.powi(2));
            (squares.sum::<f64>() / 1000.0).sqrt()
        };
        let found = of(stored.clone(), &UncertaintySource::ALL);
        assert!((found / rate - 1.0).abs() < 0.07, "{found}");
        assert_eq!(of(stored.clone(), &[UncertaintySource::InitialState]), 0.0);
        assert_eq!(of(stored.in_calm().expect("known"), &UncertaintySource::ALL), 0.0);
    }

    /// A rudder that was logged late gives a negative dead time; drawn ships have none.
    #[test]
    fn a_rudder_logged_late_is_told_and_steered_on_time() {
        let mut stored = testing::identified_ship();
        let late = ship::effects::SteeringLag::DeadTime;
        stored.members[0].effects.push(document::identified_ship::IdentifiedEffect {
            id: ship::effects::Effect::id(&late).into(),
            form: ship::effects::Effect::form(&late).into(),
            constants: Vec::new(),
        });
        stored.members[0].parameters.push(-3.1);
        assert_eq!(stored.logged_rudder_delay(), Some(3.1));
        assert_eq!(testing::identified_ship().logged_rudder_delay(), None);
        let kind = "zig-zag:10/10".parse().expect("known");
        let [own, late] = [testing::identified_ship(), stored].map(|stored| {
            testing::mixture(stored).predict(&kind, 40, false).expect("ships that come to the end of it").figures
        });
        assert_eq!(own["first_overshoot_deg"].interval, late["first_overshoot_deg"].interval);
    }

    #[test]
    fn one_number_is_one_ship() {
        let mixture = testing::mixture(testing::identified_ship());
        let [one, again, other] = [7, 7, 8].map(|k| mixture.draw_ship(k, &UncertaintySource::ALL));
        assert_eq!(one.response.parameters(), again.response.parameters());
        assert_ne!(one.response.parameters(), other.response.parameters());
        assert_eq!(mixture.most_probable().response.parameters(), mixture.first_ship().members[0].parameters);
    }

    /// A term in the measured sway needs a record with sway.
    #[test]
    fn a_model_that_needs_what_is_not_there_is_refused() {
        let mut stored = testing::identified_ship();
        let (id, form) = ("sway_coupling_measured".into(), "measured sway".into());
        stored.members[0].effects[0] = document::identified_ship::IdentifiedEffect { id, form, constants: vec![1.0] };
        let error = ShipMixture::new(vec![(stored, 1.0)]).expect_err("refused").to_string();
        assert!(error.contains("sway") && error.contains("--without sway"), "{error}");
    }

    #[test]
    fn what_is_no_covariance_is_refused() {
        let mut stored = testing::identified_ship();
        stored.members[0].covariance[0][1] = 10.0;
        stored.members[0].covariance[1][0] = 10.0;
        assert_eq!(ShipMixture::new(vec![(stored, 1.0)]).err(), Some(PredictError::Covariance));
        assert!(ShipMixture::new(Vec::new()).is_err());
    }
}
